//! Derivatives of the coordinates by operations that are written as numbers.

use super::listed::Settled;
use super::newton::Newton;
use super::solution::{Solution, Solved};
use super::tables::Results;

/// Results with the derivatives by parameters behind them.
pub struct WithSlopes<'a, M: Solved> {
    /// The results.
    pub at: &'a mut Solution<M>,
    /// The derivatives.
    pub by: &'a mut [M::Q],
    /// The column at which these begin.
    pub first: usize,
}

impl<M: Solved> WithSlopes<'_, M> {
    /// The place of a column among the derivatives.
    fn place(&mut self, column: usize) -> Option<&mut f64> {
        let (place, n) = (column.checked_sub(self.first)?, self.at.q.as_ref().len());
        self.by.get_mut(place.checked_div(n)?)?.as_mut().get_mut(place.checked_rem(n)?)
    }
}

impl<M: Solved> Results for WithSlopes<'_, M> {
    fn store(&mut self, column: usize, value: f64) {
        match self.place(column) {
            Some(by) => *by = value + 0.0,
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

impl<M: Solved> Settled for WithSlopes<'_, M> {
    fn settled(&mut self, newton: &Newton) {
        self.at.settled(newton);
    }
}
