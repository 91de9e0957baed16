//! What pivots tell of a position in a lane.

use super::lane_solutions::{Laned, Solutions};
use super::so_far::larger_so_far;

impl<M: Laned<L>, const L: usize> Solutions<M, L> {
    /// Takes note of one over a pivot, and of what makes that a pure number.
    #[inline]
    pub fn pivot(&mut self, lane: usize, turn: usize, inverse: f64, weight: f64) {
        let signs = self.signs.as_mut().get_mut(turn).and_then(|signs| signs.get_mut(lane));
        if let (Some(sign), Some(steepest)) = (signs, self.steepest.get_mut(lane)) {
            *sign ^= inverse.to_bits();
            *steepest = larger_so_far(*steepest, inverse.abs() * weight);
        }
    }
}
