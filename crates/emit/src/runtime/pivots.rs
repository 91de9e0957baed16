//! What pivots tell of a position.

use super::so_far::larger_so_far;
use super::solution::{Solution, Solved};

impl<M: Solved> Solution<M> {
    /// Takes note of one over a pivot, and of what makes that a pure number.
    pub fn pivot(&mut self, turn: usize, inverse: f64, weight: f64) {
        if let Some(is_negative) = self.is_negative.as_mut().get_mut(turn) {
            *is_negative ^= inverse < 0.0;
        }
        self.steepest = larger_so_far(self.steepest, inverse.abs() * weight);
    }
}
