//! Variants that go side by side, with their rows and their results. What is in doubt goes alone from the beginning.

use super::each::{Each, LANES};
use super::survey::Survey;
use super::table::Table;
use super::together::Together;
use super::walk::{Solving, Walk};
use crate::cancel::Cancel;
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

    /// Follows some of as many variants as there are lanes, by the values of all their parameters (SI); says which have all their rows, or all
    /// their results where no rows are wanted.
    pub fn follow(&mut self, params: &[Each], those: [bool; LANES], cancel: &Cancel) -> [bool; LANES] {
        let mut done = those;
        if let (Some(rows), Some(table)) = (&self.together.rows, &mut self.table) {
            let (of, walk) = (&*self.together, &mut self.walk);
            let mut solving = Solving { solver: &rows.solver, abreast: &mut table.abreast, is_exact: true };
            walk.begin(of, (params, those), rows.times.span(), &mut solving);
            for number in 0..rows.times.len() {
                if !walk.goes.contains(&true) || cancel.is_cancelled() {
                    return [false; LANES];
                }
                let mut solving = Solving { solver: &rows.solver, abreast: &mut table.abreast, is_exact: true };
                walk.go_to(of, rows.times.at(number), (&mut solving, false), |_, _| {});
                table.take(rows, number);
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

    /// How many rows each variant has.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.together.rows()
    }

    /// The rows of some variants, which stand next to each other, in a wanted column, by its place among these.
    #[must_use]
    pub fn column(&self, place: usize, variants: std::ops::Range<usize>) -> &[f64] {
        self.table.as_ref().map_or(&[], |table| table.column(place, variants))
    }

    /// The results of a variant; nothing where they are not known.
    #[must_use]
    pub fn results(&self, variant: usize) -> Option<&[f64]> {
        self.survey.as_ref()?.results(variant)
    }
}
