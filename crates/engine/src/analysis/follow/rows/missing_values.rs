//! Rows in which a measure, derivative or force has no value.

use crate::analysis::explain::{Warning, WarningCause};
use crate::analysis::follow::warnings::Warnings;
use crate::analysis::state::Unknown;
use mechc_ir::ConstraintSystem;

/// Rows in which one quantity has no value.
#[derive(Clone, Copy)]
struct Gap {
    /// Times of the first and the last of them (s).
    first: f64,
    last: f64,
    rows: u64,
    is_reported: bool,
}

impl Gap {
    const NONE: Gap = Gap { first: 0.0, last: f64::NAN, rows: 0, is_reported: false };

    /// Records a cell of a row at a time (s); several cells of one row count once.
    fn take_note(&mut self, t: f64) {
        if self.rows == 0 {
            self.first = t;
        }
        if self.last.total_cmp(&t).is_ne() {
            (self.last, self.rows) = (t, self.rows + 1);
        }
    }
}

/// The rows in which something has no value, by what has none.
pub(super) struct MissingValues {
    measures: Vec<Gap>,
    derivatives: Vec<Gap>,
    forces: Gap,
}

impl MissingValues {
    pub fn new(system: &ConstraintSystem) -> MissingValues {
        let gaps = |count: usize| vec![Gap::NONE; count];
        let (measures, derivatives) = (gaps(system.measures().len()), gaps(system.variables().len()));
        MissingValues { measures, derivatives, forces: Gap::NONE }
    }

    /// Records that a cell of the row of a time (s) has no number.
    pub fn take_note(&mut self, what: Unknown, t: f64) {
        let gap = match what {
            Unknown::Measure(index) => &mut self.measures[index],
            Unknown::Derivative(variable) => &mut self.derivatives[variable],
            Unknown::Forces => &mut self.forces,
        };
        gap.take_note(t);
    }

    /// Warns of each quantity that had no value, once.
    pub fn report(&mut self, warnings: &mut Warnings) {
        let measures = self.measures.iter_mut().enumerate().map(|(k, gap)| (Unknown::Measure(k), gap));
        let derivatives = self.derivatives.iter_mut().enumerate().map(|(k, gap)| (Unknown::Derivative(k), gap));
        let all = measures.chain(derivatives).chain([(Unknown::Forces, &mut self.forces)]);
        for (quantity, gap) in all.filter(|(_, gap)| gap.rows > 0 && !gap.is_reported) {
            gap.is_reported = true;
            warnings.push(Warning { t: gap.first, cause: WarningCause::WithoutValue { quantity, rows: gap.rows } });
        }
    }
}
