//! Interface of a mechanism with its parameters: equations, their branches, and conditions beside them.

use super::numbers::{Flags, Numbers};
use core::fmt::Debug;

/// The equations `phi = 0` and their derivatives.
pub trait Equations: Copy + Debug {
    /// A number for each coordinate, or each equation.
    type Q: Numbers;
    /// A number for each entry of `phi_q` that does not vanish.
    type Entries: Numbers;
    /// Branches of formulas: the result of each comparison, the number of each piece.
    type Sides: Numbers + PartialEq;

    /// Returns row and column of each entry of `phi_q`.
    fn pattern() -> &'static [(usize, usize)];

    /// Returns the scale of each coordinate.
    fn scales() -> &'static Self::Q;

    /// Returns the residuals of the equations.
    fn phi(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;

    /// Returns the entries of the Jacobian.
    fn phi_q(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Entries;

    /// Returns the right side of the velocity equation.
    fn nu(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;

    /// Returns the right side of the acceleration equation.
    fn gamma(&self, q: &Self::Q, qd: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;
}

/// Conditions that select the branches of formulas. By default formulas have none.
pub trait Branches: Equations {
    /// True if some branches depend on time alone.
    const OF_TIME: bool = false;

    /// True if some branches depend on the motion.
    const OF_MOTION: bool = false;

    /// Last time of the file's analysis (s), at which formulas of time take their earlier branches.
    const END: Option<f64> = None;

    /// Returns for each branch whether it depends on time alone.
    fn is_of_time() -> &'static [bool] {
        &[]
    }

    /// Returns the branches that depend on time alone, and 0 for the others.
    fn sides_of_time(&self, _t: f64) -> Self::Sides {
        Self::Sides::ZERO
    }

    /// Returns all branches at a position, with those of time given in `sides`.
    fn sides_of_motion(&self, _q: &Self::Q, _t: f64, sides: &Self::Sides) -> Self::Sides {
        *sides
    }
}

/// Conditions beside the equations; most mechanisms have none.
pub trait Checks: Equations {
    /// A flag for each quantity that keeps its sign along a branch: whether it is positive.
    type Monitors: Flags;

    /// True if equations were left out as redundant.
    const HAS_REDUNDANT_ROWS: bool = false;

    /// Returns whether distances are positive, and positions lie within their intervals and tables.
    fn conditions_hold(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> bool {
        true
    }

    /// Returns whether the redundant equations hold.
    fn redundant_rows_hold(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> bool {
        true
    }

    /// Returns the signs of quantities that keep them along a branch of the motion.
    fn monitors(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> Self::Monitors {
        Self::Monitors::NONE
    }
}
