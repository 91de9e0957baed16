//! Newton's iteration.

use super::limits::{HALF_A_CELL, LARGEST_CORRECTION};
use super::numbers::larger;
use super::so_far::larger_so_far;
use super::solution::{Solution, Solved};

/// An iteration of Newton from grid point to grid point, so that where it begins leaves no trace in where it ends.
#[allow(clippy::struct_excessive_bools)] // each is an answer of its own
pub struct Newton {
    is_first: bool,
    is_open: bool,
    is_lost: bool,
    has_settled: bool,
    first: f64,
}

impl Newton {
    /// It has not begun.
    pub fn new() -> Self {
        Self { is_first: true, is_open: false, is_lost: false, has_settled: false, first: 0.0 }
    }

    /// A coordinate with its correction; its grid has cells so wide, and it is judged against `scale`.
    pub fn corrected(&mut self, x: f64, delta: f64, cell: f64, scale: f64) -> f64 {
        let size = delta.abs();
        if self.is_first {
            self.first = larger_so_far(self.first, size / scale);
        }
        self.is_open |= size > HALF_A_CELL * cell;
        self.is_lost |= size.is_nan() || size > LARGEST_CORRECTION * scale;
        x + delta
    }

    /// Whether no further iteration is needed, or none helps.
    pub fn is_done(&mut self) -> bool {
        self.has_settled = !self.is_open && !self.is_lost;
        let is_done = self.has_settled || self.is_lost;
        (self.is_first, self.is_open) = (false, false);
        is_done
    }
}

impl<M: Solved> Solution<M> {
    /// Takes over how an iteration went.
    pub fn note(&mut self, newton: &Newton) {
        self.is_settled &= newton.has_settled;
        self.first = larger(self.first, newton.first);
    }
}
