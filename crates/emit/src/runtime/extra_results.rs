//! Results beyond the motion from bytecode.

use super::bytecode_interpreter::Results;
use super::bytecode_solver::Settled;
use super::newton::Newton;
use super::solution::{Solution, Solved};

/// Results followed by others.
pub struct ExtendedResults<'a, M: Solved> {
    /// The results.
    pub at: &'a mut Solution<M>,
    /// The others.
    pub more: &'a mut [f64],
    /// Column at which the others begin.
    pub first: usize,
}

impl<M: Solved> Results for ExtendedResults<'_, M> {
    fn store(&mut self, column: usize, value: f64) {
        match column.checked_sub(self.first).and_then(|place| self.more.get_mut(place)) {
            Some(place) => *place = value + 0.0,
            None => self.at.store(column, value),
        }
    }

    fn stored(&self, column: usize) -> f64 {
        self.at.stored(column)
    }

    fn bounded(&mut self, size: f64, bound: f64) {
        self.at.bounded(size, bound);
    }

    fn pivoted(&mut self, turn: usize, inverse: f64, weight: f64) {
        self.at.pivoted(turn, inverse, weight);
    }
}

impl<M: Solved> Settled for ExtendedResults<'_, M> {
    fn settled(&mut self, newton: &Newton) {
        self.at.settled(newton);
    }
}
