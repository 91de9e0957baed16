//! Solutions of the equations at a time, and the interface of the solver.

use super::equations::{Branches, Checks};
use super::error::Fault;
use super::measured::Measured;
use super::numbers::{Flags, Numbers, add_zeros};
use core::fmt::Debug;

/// Equations with the operations that solve them.
pub trait Solved: Branches + Checks {
    /// A number for each coordinate that Newton solves for; the others follow from these.
    type Tears: Numbers;
    /// A flag for each block of equations whose determinant changes with the position.
    type Turns: Flags;
    /// Measures.
    type Measures: Measured;
    /// Values that only measures need.
    type Joined: Numbers;
    /// Variable of the motion: time, or signals.
    type Along: Along<Self>;

    /// Returns the scale of each coordinate that Newton solves for.
    fn tear_scales() -> &'static Self::Tears;

    /// Returns for each block whether its determinant is negative if all pivots are positive.
    fn turned() -> &'static Self::Turns;

    /// Selects the coordinates that Newton solves for.
    fn tears(q: &Self::Q) -> Self::Tears;

    /// Solves for position, velocity and acceleration at a time.
    fn solve(&self, guess: &Self::Tears, t: f64, sides: &Self::Sides, at: &mut Solution<Self>);

    /// Solves by elimination with partial pivoting from a position nearby, after [`solve`](Solved::solve) has failed with
    /// `at`. Returns a fault if blocks are too large for that.
    fn pivoted(
        &self,
        _q: &Self::Q,
        _t: f64,
        _sides: &Self::Sides,
        at: &Solution<Self>,
    ) -> Result<Solution<Self>, Fault> {
        Err(at.fault())
    }
}

/// The variable of a motion, with the part of a solution that belongs to it.
pub trait Along<M: Solved>: Copy + Debug {
    /// Value before the first solution.
    const ZERO: Self;

    /// Returns the predicted coordinates at a distance `h` from a solution.
    fn predicted(m: &M, from: &Solution<M>, h: f64) -> M::Q;

    /// Returns a position and time slightly ahead, where the branches of formulas are those on which the motion continues.
    fn ahead(m: &M, at: &Solution<M>) -> (M::Q, f64);

    /// Records the point that a solution belongs to.
    fn note(&mut self, _m: &M, _t: f64) {}

    /// Returns the derivatives of the coordinates by the variable of the motion.
    fn slopes(&self) -> &[M::Q] {
        &[]
    }

    /// Returns the derivatives of the coordinates by the variable of the motion, for modification.
    #[allow(dead_code)] // what is not pivoted knows them by their names
    fn slopes_mut(&mut self) -> &mut [M::Q] {
        &mut []
    }
}

/// Solution of the equations at a time.
#[derive(Debug)]
pub struct Solution<M: Solved> {
    /// Time (s), or position on a path.
    pub t: f64,
    /// Coordinates.
    pub q: M::Q,
    /// Velocities.
    pub qd: M::Q,
    /// Accelerations.
    pub qdd: M::Q,
    /// Measures.
    pub measures: M::Measures,
    /// Values that only measures need.
    #[allow(dead_code)] // mostly they need nothing
    pub joined: M::Joined,
    /// Part of the solution that belongs to the variable of the motion.
    pub along: M::Along,
    /// Branches of formulas.
    pub sides: M::Sides,
    /// Signs of quantities that keep them along a branch: true if positive.
    pub monitors: M::Monitors,
    /// Signs of the determinants of the blocks of equations.
    pub is_negative: M::Turns,
    /// True if Newton's iteration has converged.
    pub is_settled: bool,
    /// True if no digits were lost and the equations hold.
    pub holds: bool,
    /// Largest first correction of Newton's iteration, scaled.
    pub first: f64,
    /// Reciprocal of the smallest pivot, scaled.
    pub steepest: f64,
}

impl<M: Solved> Clone for Solution<M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<M: Solved> Copy for Solution<M> {}

impl<M: Solved> Solution<M> {
    /// Solution before the first solve.
    pub const ZERO: Self = Self {
        t: 0.0,
        q: M::Q::ZERO,
        qd: M::Q::ZERO,
        qdd: M::Q::ZERO,
        measures: M::Measures::ZERO,
        joined: M::Joined::ZERO,
        along: M::Along::ZERO,
        sides: M::Sides::ZERO,
        monitors: M::Monitors::NONE,
        is_negative: M::Turns::NONE,
        is_settled: true,
        holds: true,
        first: 0.0,
        steepest: 0.0,
    };

    /// Creates a solution that holds only a position and its time.
    pub fn near(q: &M::Q, t: f64) -> Self {
        let mut near = Self::ZERO;
        (near.t, near.q) = (t, *q);
        near
    }

    /// Resets the records before a solve.
    pub fn begin(&mut self, t: f64) {
        self.t = t;
        self.is_negative = *M::turned();
        (self.is_settled, self.holds) = (true, true);
        (self.first, self.steepest) = (0.0, 0.0);
    }

    /// Returns the reason why the solution cannot be used.
    pub fn fault(&self) -> Fault {
        if self.is_finite() { Fault::TooFar } else { Fault::NotANumber }
    }

    /// Returns whether coordinates and their derivatives are finite; measures may be NaN.
    pub fn is_finite(&self) -> bool {
        let mut sums = [0.0; 4];
        add_zeros(&self.q, &mut sums);
        add_zeros(&self.qd, &mut sums);
        add_zeros(&self.qdd, &mut sums);
        for slopes in self.along.slopes() {
            add_zeros(slopes, &mut sums);
        }
        sums == [0.0; 4]
    }
}
