//! What is asked of a mechanism with its parameters: its equations, their branches, and what must hold beside them.

use super::numbers::{Flags, Numbers};
use core::fmt::Debug;

/// The equations `phi = 0` and what follows from them.
pub trait Equations: Copy + Debug {
    /// A number for each coordinate, and for each equation.
    type Q: Numbers;
    /// One for each entry of `phi_q` that does not vanish.
    type Entries: Numbers;
    /// Which branch formulas take, by place: what a comparison gives, the number of a piece.
    type Sides: Numbers + PartialEq;

    /// Row and column of each entry of `phi_q`.
    fn pattern() -> &'static [(usize, usize)];

    /// What a change of each coordinate is judged against.
    fn scales() -> &'static Self::Q;

    /// What is left of the equations.
    fn phi(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;

    /// The entries of their Jacobian.
    fn phi_q(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Entries;

    /// The right side of the velocity equation.
    fn nu(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;

    /// The right side of the acceleration equation.
    fn gamma(&self, q: &Self::Q, qd: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;
}

/// What decides the branches of formulas. Where formulas have none, all of this is nothing.
pub trait Branches: Equations {
    /// Whether time alone decides some.
    const OF_TIME: bool = false;

    /// Whether the motion decides some.
    const OF_MOTION: bool = false;

    /// The last time of the file's analysis (s), at which formulas of time take their earlier branches.
    const END: Option<f64> = None;

    /// Which of them time alone decides.
    fn is_of_time() -> &'static [bool] {
        &[]
    }

    /// The branches that time alone decides, the others as 0.
    fn sides_of_time(&self, _t: f64) -> Self::Sides {
        Self::Sides::ZERO
    }

    /// The branches at a position, those of time being known.
    fn sides_of_motion(&self, _q: &Self::Q, _t: f64, sides: &Self::Sides) -> Self::Sides {
        *sides
    }
}

/// What must hold beside the equations; of most mechanisms nothing.
pub trait Checks: Equations {
    /// Which quantities that keep their signs along a branch are positive.
    type Monitors: Flags;

    /// Whether equations were left out as redundant.
    const HAS_REDUNDANT_ROWS: bool = false;

    /// Whether distances are positive, and places within their intervals and tables.
    fn conditions_hold(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> bool {
        true
    }

    /// Whether the equations that were left out hold.
    fn redundant_rows_hold(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> bool {
        true
    }

    /// What keeps its sign along a branch of the motion.
    fn monitors(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> Self::Monitors {
        Self::Monitors::NONE
    }
}
