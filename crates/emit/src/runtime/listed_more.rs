//! More than the motion by operations that are written as numbers.

use super::listed::Settled;
use super::newton::Newton;
use super::solution::{Solution, Solved};
use super::tables::Results;

/// Results with others behind them.
pub struct WithMore<'a, M: Solved> {
    /// The results.
    pub at: &'a mut Solution<M>,
    /// The others.
    pub more: &'a mut [f64],
    /// The column at which these begin.
    pub first: usize,
}

impl<M: Solved> Results for WithMore<'_, M> {
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

impl<M: Solved> Settled for WithMore<'_, M> {
    fn settled(&mut self, newton: &Newton) {
        self.at.settled(newton);
    }
}
