//! Records of a solution in the making. Each inner module is emitted by itself, where a mechanism needs it.

use super::{lane_solutions, solution};

pub mod running_max {
    //! What is the largest, found one by one.

    /// What is the largest so far, in the loops that solve, which have time for one comparison: a value that is not a number wins, but only
    /// until the next. What it comes from is not a number either, and is asked for that.
    pub fn running_max(largest: f64, value: f64) -> f64 {
        if value <= largest { largest } else { value }
    }
}

pub mod pivots {
    //! What pivots tell of a position.

    use super::running_max::running_max;
    use super::solution::{Solution, Solved};

    impl<M: Solved> Solution<M> {
        /// Takes note of one over a pivot, and of what makes that a pure number.
        pub fn pivot(&mut self, turn: usize, inverse: f64, weight: f64) {
            if let Some(is_negative) = self.is_negative.as_mut().get_mut(turn) {
                *is_negative ^= inverse < 0.0;
            }
            self.steepest = running_max(self.steepest, inverse.abs() * weight);
        }
    }
}

pub mod lane_pivots {
    //! What pivots tell of a position in a lane.

    use super::lane_solutions::{Laned, Solutions};
    use super::running_max::running_max;

    impl<M: Laned<L>, const L: usize> Solutions<M, L> {
        /// Takes note of one over a pivot, and of what makes that a pure number.
        #[inline]
        pub fn pivot(&mut self, lane: usize, turn: usize, inverse: f64, weight: f64) {
            let signs = self.signs.as_mut().get_mut(turn).and_then(|signs| signs.get_mut(lane));
            if let (Some(sign), Some(steepest)) = (signs, self.steepest.get_mut(lane)) {
                *sign ^= inverse.to_bits();
                *steepest = running_max(*steepest, inverse.abs() * weight);
            }
        }
    }
}

pub mod lane_residuals {
    //! What must not be too large in a lane.

    use super::lane_solutions::{Laned, Solutions};
    use super::running_max::running_max;

    impl<M: Laned<L>, const L: usize> Solutions<M, L> {
        /// Takes note of a value that must not be above 1 when it is multiplied by a factor.
        #[inline]
        pub fn watch(&mut self, lane: usize, value: f64, factor: f64) {
            if let Some(strain) = self.strain.get_mut(lane) {
                *strain = running_max(*strain, value.abs() * factor);
            }
        }
    }
}
