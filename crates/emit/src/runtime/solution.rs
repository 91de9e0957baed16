//! What solves the equations at a time, and what that is found by.

use super::equations::{Branches, Checks};
use super::error::Fault;
use super::measured::Measured;
use super::numbers::{Flags, Numbers, add_zeros};
use core::fmt::Debug;

/// Equations with the operations that solve them.
pub trait Solved: Branches + Checks {
    /// A number for each coordinate that Newton solves for; the others follow.
    type Tears: Numbers;
    /// An answer for each block of equations whose determinant changes with the position.
    type Turns: Flags;
    /// What is measured.
    type Measures: Measured;
    /// Values that only measures need.
    type Joined: Numbers;
    /// What the motion goes along: time, or signals.
    type Along: Along<Self>;

    /// What a change of each coordinate that Newton solves for is judged against.
    fn tear_scales() -> &'static Self::Tears;

    /// Whether determinants are negative where all pivots are positive.
    fn turned() -> &'static Self::Turns;

    /// Of all coordinates those that Newton solves for.
    fn tears(q: &Self::Q) -> Self::Tears;

    /// Position, velocity and acceleration at a time.
    fn solve(&self, guess: &Self::Tears, t: f64, sides: &Self::Sides, at: &mut Solution<Self>);

    /// The same by elimination with partial pivoting from a position nearby, where [`solve`](Solved::solve) has failed with `at`;
    /// a fault where blocks are too large for that.
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

/// What a motion goes along, with what a solution holds of that.
pub trait Along<M: Solved>: Copy + Debug {
    /// Nothing is known yet.
    const ZERO: Self;

    /// Coordinates at a distance `h` from a solution.
    fn predicted(m: &M, from: &Solution<M>, h: f64) -> M::Q;

    /// A place a little ahead, at which the branches of formulas tell those on which the motion goes on.
    fn ahead(m: &M, at: &Solution<M>) -> (M::Q, f64);

    /// Takes down what a solution has been found for.
    fn note(&mut self, _m: &M, _t: f64) {}

    /// The derivatives of the coordinates, by what the motion goes along.
    fn slopes(&self) -> &[M::Q] {
        &[]
    }

    /// The same, to be written.
    #[allow(dead_code)] // what is neither pivoted nor listed knows them by their names
    fn slopes_mut(&mut self) -> &mut [M::Q] {
        &mut []
    }
}

/// What solves the equations at a time.
#[derive(Debug)]
pub struct Solution<M: Solved> {
    /// The time (s), or the place on a way.
    pub t: f64,
    /// Coordinates.
    pub q: M::Q,
    /// Velocities.
    pub qd: M::Q,
    /// Accelerations.
    pub qdd: M::Q,
    /// Measures.
    pub measures: M::Measures,
    /// What only measures need.
    #[allow(dead_code)] // mostly they need nothing
    pub joined: M::Joined,
    /// What it holds of what the motion goes along.
    pub along: M::Along,
    /// The branches of formulas.
    pub sides: M::Sides,
    /// Which quantities that must keep their signs are positive.
    pub monitors: M::Monitors,
    /// By block of equations: whether its determinant is negative.
    pub is_negative: M::Turns,
    /// Whether Newton has arrived.
    pub is_settled: bool,
    /// Whether no digits were lost, and the equations hold.
    pub holds: bool,
    /// Newton's largest first correction, scaled.
    pub first: f64,
    /// One over the smallest pivot, scaled.
    pub steepest: f64,
}

impl<M: Solved> Clone for Solution<M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<M: Solved> Copy for Solution<M> {}

impl<M: Solved> Solution<M> {
    /// Nothing is solved yet.
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

    /// Nothing but a position and its time.
    pub fn near(q: &M::Q, t: f64) -> Self {
        let mut near = Self::ZERO;
        (near.t, near.q) = (t, *q);
        near
    }

    /// Makes ready for being solved for.
    pub fn begin(&mut self, t: f64) {
        self.t = t;
        self.is_negative = *M::turned();
        (self.is_settled, self.holds) = (true, true);
        (self.first, self.steepest) = (0.0, 0.0);
    }

    /// Why it cannot be used.
    pub fn fault(&self) -> Fault {
        if self.is_finite() { Fault::TooFar } else { Fault::NotANumber }
    }

    /// Whether all of it is numbers; measures may be none.
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
