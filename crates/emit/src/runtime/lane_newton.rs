//! Newton's iteration in lanes.

// what is done in every lane reads best, and vectorises best, with the lane's number
#![allow(clippy::needless_range_loop)]

use super::grid::{bound_at_first, going_on, next_point};
use super::lane_solutions::{Laned, Solutions};
use super::limits::{BORDER, LARGEST_CORRECTION};
use super::running_max::running_max;

/// An iteration of Newton in every lane, until all have settled or are lost. A lane that has settled stays where it is.
pub struct LaneNewton<const L: usize> {
    is_first: bool,
    first: [f64; L],
    /// The largest correction, scaled.
    far: [f64; L],
    /// The largest correction now, and with which one it ends, both in cells of the grid.
    largest: [f64; L],
    bound: [f64; L],
    /// The cells, in cells, among whose points coordinates next to a border go on; 0 where all stay.
    cells: [f64; L],
}

impl<const L: usize> LaneNewton<L> {
    /// It has not begun.
    pub fn new() -> Self {
        let zero = [0.0; L];
        let bound = [bound_at_first(BORDER); L];
        Self { is_first: true, first: zero, far: zero, largest: zero, bound, cells: zero }
    }

    /// The correction of a coordinate; its grid has cells so wide, and it is judged against `scale`.
    #[inline]
    pub fn record(&mut self, lane: usize, delta: f64, cell: f64, scale: f64) {
        let size = delta.abs();
        if let (Some(far), Some(largest)) = (self.far.get_mut(lane), self.largest.get_mut(lane)) {
            *far = running_max(*far, size / scale);
            *largest = running_max(*largest, size / cell);
        }
    }

    /// Whether no further iteration is needed, or none helps.
    pub fn is_done(&mut self) -> bool {
        if self.is_first {
            self.first = self.far;
            self.is_first = false;
        }
        let mut open = 0.0;
        for k in 0..L {
            let is_lost = self.far[k].is_nan() || self.far[k] > LARGEST_CORRECTION;
            let stays = is_lost || self.largest[k] <= self.bound[k];
            let (bound, cells) = going_on(self.largest[k], self.bound[k], BORDER);
            // from now on it stays
            self.bound[k] = if stays { f64::INFINITY } else { bound };
            self.cells[k] = if stays { 0.0 } else { cells };
            open += self.cells[k];
            self.largest[k] = 0.0;
        }
        open == 0.0
    }

    /// The grid point that a coordinate goes on to.
    #[inline]
    pub fn next(&self, lane: usize, x: f64, delta: f64, cell: f64) -> f64 {
        let cells = self.cells.get(lane).copied().unwrap_or(0.0);
        let next = next_point(x, delta, cell, cells, BORDER);
        if cells > 0.0 { next } else { x }
    }

    /// Leaves word of how it went. What is not a number is in the coordinates, too.
    pub fn note<M: Laned<L>>(&self, at: &mut Solutions<M, L>) {
        for k in 0..L {
            at.first[k] = running_max(at.first[k], self.first[k]);
            let lost = self.far[k] * (1.0 / LARGEST_CORRECTION);
            let strain = if self.cells[k] > 0.0 { f64::INFINITY } else { lost };
            at.strain[k] = running_max(at.strain[k], strain);
        }
    }
}
