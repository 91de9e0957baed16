//! Variants that go side by side, with their rows and their results. What is in doubt goes alone from the beginning.

use super::each::{Each, LANES};
use super::survey::Survey;
use super::table::{Room, Table};
use super::together::Together;
use super::walk::{Solving, Walk};
use mechc_ir::tolerances::solving::variants::FEWEST_STEPS;
use mechc_text::cancel::Cancel;
use std::sync::Arc;

/// Variants that go side by side.
pub struct Team {
    together: Arc<Together>,
    walk: Walk,
    table: Option<Table>,
    survey: Option<Survey>,
}

impl Team {
    /// Of a mechanism.
    #[must_use]
    pub fn new(together: &Arc<Together>) -> Team {
        Team {
            walk: Walk::new(together),
            table: together.rows.as_ref().map(|rows| Table::new(together, rows)),
            survey: together.asked.as_ref().map(|asked| Survey::new(together, asked)),
            together: Arc::clone(together),
        }
    }

    /// Follows some of as many variants as there are lanes, by the values of all their parameters (SI), and writes their rows, if any are wanted;
    /// says which have all of them, or all their results where no rows are wanted.
    pub fn follow(
        &mut self,
        params: &[Each],
        those: [bool; LANES],
        mut room: Room<'_>,
        cancel: &Cancel,
    ) -> [bool; LANES] {
        let mut done = those;
        if let (Some(rows), Some(table)) = (&self.together.rows, &mut self.table) {
            let (of, walk) = (&*self.together, &mut self.walk);
            table.turn_to(0);
            let longest = rows.times.span() / FEWEST_STEPS;
            walk.begin(of, (params, those), longest, &mut Solving::of_rows(rows, table));
            table.put_known(&mut room);
            for number in 0..rows.times.len() {
                table.turn_to(number);
                walk.go_to(of, rows.times.at(number), (&mut Solving::of_rows(rows, table), false), |_, _| {});
                // where nobody gets to there is no row
                if !walk.goes.contains(&true) || cancel.is_cancelled() {
                    return [false; LANES];
                }
                table.learn(rows, number, &mut room);
                table.put(number, &mut room);
            }
            done = walk.goes;
        }
        if let (Some(asked), Some(survey)) = (&self.together.asked, &mut self.survey) {
            survey.answer((&self.together, asked), &mut self.walk, (params, done), cancel);
            if self.table.is_none() {
                done = survey.answered;
            }
        }
        done
    }

    /// The results of a variant; nothing where they are not known.
    #[must_use]
    pub fn results(&self, variant: usize) -> Option<&[f64]> {
        self.survey.as_ref()?.results(variant)
    }
}
