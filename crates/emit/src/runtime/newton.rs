//! Newton's iteration.

use super::grid::{bound_at_first, going_on, next_point};
use super::limits::{BORDER, LARGEST_CORRECTION};
use super::numbers::larger;
use super::running_max::running_max;
use super::solution::{Solution, Solved};

/// An iteration of Newton from grid point to grid point, so that where it begins leaves no trace in where it ends.
pub struct Newton {
    is_first: bool,
    is_lost: bool,
    has_settled: bool,
    first: f64,
    /// The largest correction, and with which one it ends, both in cells of the grid.
    largest: f64,
    bound: f64,
    /// The cells, in cells, among whose points coordinates next to a border go on.
    cells: f64,
}

impl Newton {
    /// It has not begun.
    pub fn new() -> Self {
        let bound = bound_at_first(BORDER);
        Self { is_first: true, is_lost: false, has_settled: false, first: 0.0, largest: 0.0, bound, cells: 1.0 }
    }

    /// The correction of a coordinate; its grid has cells so wide, and it is judged against `scale`.
    pub fn record(&mut self, delta: f64, cell: f64, scale: f64) {
        let size = delta.abs();
        if self.is_first {
            self.first = running_max(self.first, size / scale);
        }
        self.largest = running_max(self.largest, size / cell);
        self.is_lost |= size.is_nan() || size > LARGEST_CORRECTION * scale;
    }

    /// Whether no further iteration is needed, or none helps.
    pub fn is_done(&mut self) -> bool {
        self.has_settled = !self.is_lost && self.largest <= self.bound;
        let is_done = self.has_settled || self.is_lost;
        if !is_done {
            (self.bound, self.cells) = going_on(self.largest, self.bound, BORDER);
        }
        (self.is_first, self.largest) = (false, 0.0);
        is_done
    }

    /// The grid point that a coordinate goes on to.
    pub fn next(&self, x: f64, delta: f64, cell: f64) -> f64 {
        next_point(x, delta, cell, self.cells, BORDER)
    }
}

impl<M: Solved> Solution<M> {
    /// Takes over how an iteration went.
    pub fn note(&mut self, newton: &Newton) {
        self.is_settled &= newton.has_settled;
        self.first = larger(self.first, newton.first);
    }
}
