//! What must not be too large in a lane.

use super::lane_solutions::{Laned, Solutions};
use super::so_far::larger_so_far;

impl<M: Laned<L>, const L: usize> Solutions<M, L> {
    /// Takes note of a value that must not be above 1 when it is multiplied by a factor.
    #[inline]
    pub fn watch(&mut self, lane: usize, value: f64, factor: f64) {
        if let Some(strain) = self.strain.get_mut(lane) {
            *strain = larger_so_far(*strain, value.abs() * factor);
        }
    }
}
