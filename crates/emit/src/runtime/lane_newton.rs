//! Newton's iteration in lanes.

// loops by lane number read best and vectorise best
#![allow(clippy::needless_range_loop)]

use super::grid::{bound_at_first, going_on, next_point};
use super::lane_solutions::{Laned, Solutions};
use super::limits::{BORDER, LARGEST_CORRECTION};
use super::running_max::running_max;

/// A Newton iteration in every lane, until each has settled or is lost. A lane that has settled stays where it is.
pub struct LaneNewton<const L: usize> {
    is_first: bool,
    first: [f64; L],
    /// Largest correction, scaled.
    far: [f64; L],
    /// Largest correction of this iteration, and the bound below which it ends, both in cells of the grid.
    largest: [f64; L],
    bound: [f64; L],
    /// Spacing, in cells, of the points to which coordinates next to a border continue; 0 in lanes that stay.
    cells: [f64; L],
}

impl<const L: usize> LaneNewton<L> {
    /// Creates an iteration before its first step.
    pub fn new() -> Self {
        let zero = [0.0; L];
        let bound = [bound_at_first(BORDER); L];
        Self { is_first: true, first: zero, far: zero, largest: zero, bound, cells: zero }
    }

    /// Records the correction of a coordinate, whose grid has cells of width `cell`, and whose scale is `scale`.
    #[inline]
    pub fn record(&mut self, lane: usize, delta: f64, cell: f64, scale: f64) {
        let size = delta.abs();
        if let (Some(far), Some(largest)) = (self.far.get_mut(lane), self.largest.get_mut(lane)) {
            *far = running_max(*far, size / scale);
            *largest = running_max(*largest, size / cell);
        }
    }

    /// Returns whether the iteration is done in every lane: it has settled or is lost.
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
            // the lane stays from now on
            self.bound[k] = if stays { f64::INFINITY } else { bound };
            self.cells[k] = if stays { 0.0 } else { cells };
            open += self.cells[k];
            self.largest[k] = 0.0;
        }
        open == 0.0
    }

    /// Returns the grid point to which a coordinate continues.
    #[inline]
    pub fn next(&self, lane: usize, x: f64, delta: f64, cell: f64) -> f64 {
        let cells = self.cells.get(lane).copied().unwrap_or(0.0);
        let next = next_point(x, delta, cell, cells, BORDER);
        if cells > 0.0 { next } else { x }
    }

    /// Records the outcome. Values that are NaN appear in the coordinates, too.
    pub fn note<M: Laned<L>>(&self, at: &mut Solutions<M, L>) {
        for k in 0..L {
            at.first[k] = running_max(at.first[k], self.first[k]);
            let lost = self.far[k] * (1.0 / LARGEST_CORRECTION);
            let strain = if self.cells[k] > 0.0 { f64::INFINITY } else { lost };
            at.strain[k] = running_max(at.strain[k], strain);
        }
    }
}
