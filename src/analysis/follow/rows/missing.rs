//! Rows in which a measure has no value.

use crate::analysis::explain::errors;
use crate::analysis::follow::remarks::Remarks;
use crate::ir::{ConstraintSystem, Measure};

/// The rows in which one measure has no value.
#[derive(Clone, Copy)]
struct Gap {
    /// Times of the first and the last of them (s).
    first: f64,
    last: f64,
    rows: u64,
    is_told: bool,
}

impl Gap {
    const NONE: Gap = Gap { first: 0.0, last: f64::NAN, rows: 0, is_told: false };

    /// A cell of a row at a time; several of one row count once.
    fn take_note(&mut self, t: f64) {
        if self.rows == 0 {
            self.first = t;
        }
        if self.last.total_cmp(&t).is_ne() {
            (self.last, self.rows) = (t, self.rows + 1);
        }
    }
}

/// By measure, and then by variable that derivatives are taken by.
pub(super) struct Missing(Vec<Gap>);

impl Missing {
    pub fn new(system: &ConstraintSystem) -> Missing {
        let variables = system.variations.as_ref().map_or(0, |variations| variations.variables.len());
        Missing(vec![Gap::NONE; system.measures.len() + variables])
    }

    /// There is no number in a column of the row of a time (s).
    pub fn take_note(&mut self, system: &ConstraintSystem, column: usize, t: f64) {
        self.0[measure_of_column(system, column)].take_note(t);
    }

    /// A warning for each, once.
    pub fn say(&mut self, system: &ConstraintSystem, remarks: &mut Remarks) {
        for (index, gap) in self.0.iter_mut().enumerate().filter(|(_, gap)| gap.rows > 0 && !gap.is_told) {
            gap.is_told = true;
            remarks.push(match index.checked_sub(system.measures.len()) {
                None => errors::measure_without_value(system, index, gap.first, gap.rows),
                Some(variable) => errors::derivatives_without_value(system, variable, gap.first, gap.rows),
            });
        }
    }
}

/// The measure behind a column of a result row, which must be one of a measure; behind the last one follow the variables, for the
/// columns of derivatives by them.
fn measure_of_column(system: &ConstraintSystem, column: usize) -> usize {
    let (n, measures) = (system.coordinates.len(), &system.measures);
    let mut column = column.saturating_sub(1);
    let orders: [fn(&Measure) -> bool; 3] = [|_| true, |of| of.first.is_some(), |of| of.second.is_some()];
    for has in orders {
        let having = measures.iter().enumerate().filter(|(_, of)| has(of)).map(|(measure, _)| measure);
        match column.checked_sub(n) {
            Some(place) if place < having.clone().count() => return having.clone().nth(place).unwrap_or(0),
            Some(place) => column = place - having.count(),
            None => return 0,
        }
    }
    system.appended().get(column).map_or(0, |of| measures.len() + of.variable as usize)
}
