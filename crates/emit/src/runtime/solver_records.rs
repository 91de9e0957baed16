//! Records of a solution in the making. Each inner module is emitted by itself, where a mechanism needs it.

use super::{lane_solutions, solution};

pub mod running_max {
    //! Maximum of a sequence.

    /// Returns the maximum so far with a single comparison, for inner loops: NaN wins, but only until the next value. The
    /// results that a NaN comes from are NaN as well and are checked for that.
    pub fn running_max(largest: f64, value: f64) -> f64 {
        if value <= largest { largest } else { value }
    }
}

pub mod pivots {
    //! Record of pivots.

    use super::running_max::running_max;
    use super::solution::{Solution, Solved};

    impl<M: Solved> Solution<M> {
        /// Records the reciprocal of a pivot; `weight` makes it dimensionless.
        pub fn pivot(&mut self, turn: usize, inverse: f64, weight: f64) {
            if let Some(is_negative) = self.is_negative.as_mut().get_mut(turn) {
                *is_negative ^= inverse < 0.0;
            }
            self.steepest = running_max(self.steepest, inverse.abs() * weight);
        }
    }
}

pub mod lane_pivots {
    //! Record of pivots in a lane.

    use super::lane_solutions::{Laned, Solutions};
    use super::running_max::running_max;

    impl<M: Laned<L>, const L: usize> Solutions<M, L> {
        /// Records the reciprocal of a pivot; `weight` makes it dimensionless.
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
    //! Record of bounded quantities in a lane.

    use super::lane_solutions::{Laned, Solutions};
    use super::running_max::running_max;

    impl<M: Laned<L>, const L: usize> Solutions<M, L> {
        /// Records a value that times `factor` must not exceed 1.
        #[inline]
        pub fn watch(&mut self, lane: usize, value: f64, factor: f64) {
            if let Some(strain) = self.strain.get_mut(lane) {
                *strain = running_max(*strain, value.abs() * factor);
            }
        }
    }
}
