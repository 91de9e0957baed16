//! Newton's iteration in lanes.

// what is done in every lane reads best, and vectorises best, with the lane's number
#![allow(clippy::needless_range_loop)]

use super::lane_solutions::{Laned, Solutions};
use super::limits::{HALF_A_CELL, LARGEST_CORRECTION};
use super::so_far::larger_so_far;

/// An iteration of Newton in every lane, until all have settled or are lost.
pub struct Settling<const L: usize> {
    is_first: bool,
    first: [f64; L],
    far: [f64; L],
    open: [f64; L],
}

impl<const L: usize> Settling<L> {
    /// It has not begun.
    pub fn new() -> Self {
        let zero = [0.0; L];
        Self { is_first: true, first: zero, far: zero, open: zero }
    }

    /// Another round begins.
    pub fn begin(&mut self) {
        self.open = [0.0; L];
    }

    /// Corrects a coordinate whose grid has cells so wide, and which is judged against `scale`.
    #[inline]
    pub fn correct(&mut self, lane: usize, x: &mut f64, delta: f64, cell: f64, scale: f64) {
        let size = delta.abs();
        if let (Some(far), Some(open)) = (self.far.get_mut(lane), self.open.get_mut(lane)) {
            *far = larger_so_far(*far, size / scale);
            *open = larger_so_far(*open, size / cell);
        }
        *x += delta;
    }

    /// Whether no further iteration is needed, or none helps.
    pub fn is_done(&mut self) -> bool {
        if self.is_first {
            self.first = self.far;
            self.is_first = false;
        }
        let mut pairs = self.open.iter().zip(&self.far);
        let is_lost = |far: f64| far.is_nan() || far > LARGEST_CORRECTION;
        pairs.all(|(open, far)| *open <= HALF_A_CELL || is_lost(*far))
    }

    /// Leaves word of how it went. What is not a number is in the coordinates, too.
    pub fn note<M: Laned<L>>(&self, at: &mut Solutions<M, L>) {
        for k in 0..L {
            at.first[k] = larger_so_far(at.first[k], self.first[k]);
            at.open[k] = larger_so_far(at.open[k], self.open[k]);
            let lost = self.far[k] * (1.0 / LARGEST_CORRECTION);
            at.strain[k] = larger_so_far(at.strain[k], lost);
        }
    }
}
