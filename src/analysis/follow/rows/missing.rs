//! Rows in which a measure has no value.

use crate::analysis::explain::errors;
use crate::analysis::follow::remarks::Remarks;
use crate::ir::ConstraintSystem;

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

/// By measure, then by variable that derivatives are taken by, and last of reactions and efforts.
pub(super) struct Missing(Vec<Gap>);

impl Missing {
    pub fn new(system: &ConstraintSystem) -> Missing {
        let variables = system.variations.as_ref().map_or(0, |variations| variations.variables.len());
        Missing(vec![Gap::NONE; system.measures.len() + variables + 1])
    }

    /// There is no number in a cell of a measure, or of a derivative by a variable, in the row of a time (s).
    pub fn take_note(&mut self, measure: usize, t: f64) {
        self.0[measure].take_note(t);
    }

    /// A warning for each, once.
    pub fn say(&mut self, system: &ConstraintSystem, remarks: &mut Remarks) {
        let variables = system.variations.as_ref().map_or(0, |variations| variations.variables.len());
        for (index, gap) in self.0.iter_mut().enumerate().filter(|(_, gap)| gap.rows > 0 && !gap.is_told) {
            gap.is_told = true;
            remarks.push(match index.checked_sub(system.measures.len()) {
                None => errors::measure_without_value(system, index, gap.first, gap.rows),
                Some(variable) if variable < variables => {
                    errors::derivatives_without_value(system, variable, gap.first, gap.rows)
                }
                Some(_) => errors::forces_without_value(system, gap.first, gap.rows),
            });
        }
    }
}
