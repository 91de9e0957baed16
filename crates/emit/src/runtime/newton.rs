//! Newton's iteration.

use super::grid::{bound_at_first, going_on, next_point};
use super::limits::{BORDER, LARGEST_CORRECTION};
use super::numbers::larger;
use super::running_max::running_max;
use super::solution::{Solution, Solved};

/// A Newton iteration from grid point to grid point, so that its result does not depend on its start.
pub struct Newton {
    is_first: bool,
    is_lost: bool,
    has_settled: bool,
    first: f64,
    /// Largest correction, and the bound below which the iteration ends, both in cells of the grid.
    largest: f64,
    bound: f64,
    /// Spacing, in cells, of the points to which coordinates next to a border continue.
    cells: f64,
}

impl Newton {
    /// Creates an iteration before its first step.
    pub fn new() -> Self {
        let bound = bound_at_first(BORDER);
        Self { is_first: true, is_lost: false, has_settled: false, first: 0.0, largest: 0.0, bound, cells: 1.0 }
    }

    /// Records the correction of a coordinate, whose grid has cells of width `cell`, and whose scale is `scale`.
    pub fn record(&mut self, delta: f64, cell: f64, scale: f64) {
        let size = delta.abs();
        if self.is_first {
            self.first = running_max(self.first, size / scale);
        }
        self.largest = running_max(self.largest, size / cell);
        self.is_lost |= size.is_nan() || size > LARGEST_CORRECTION * scale;
    }

    /// Returns whether the iteration is done: it has settled or is lost.
    pub fn is_done(&mut self) -> bool {
        self.has_settled = !self.is_lost && self.largest <= self.bound;
        let is_done = self.has_settled || self.is_lost;
        if !is_done {
            (self.bound, self.cells) = going_on(self.largest, self.bound, BORDER);
        }
        (self.is_first, self.largest) = (false, 0.0);
        is_done
    }

    /// Returns the grid point to which a coordinate continues.
    pub fn next(&self, x: f64, delta: f64, cell: f64) -> f64 {
        next_point(x, delta, cell, self.cells, BORDER)
    }
}

impl<M: Solved> Solution<M> {
    /// Records the outcome of an iteration.
    pub fn note(&mut self, newton: &Newton) {
        self.is_settled &= newton.has_settled;
        self.first = larger(self.first, newton.first);
    }
}
