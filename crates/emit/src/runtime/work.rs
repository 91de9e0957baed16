//! How much work a call does, and how far it comes.

use super::equations::Branches;
use super::limits::{MOST_BRANCHES, MOST_HALVINGS};

/// Evaluations that a call has done. One is a solution of the equations at a place, with all that is checked there: by the operations
/// that were written for that, or by elimination with partial pivoting where these lose digits. A look at formulas of time that decide a
/// branch, or at whether they end, is one too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// How many there were.
    pub evaluations: usize,
}

impl Work {
    /// Counts some more.
    pub fn add(&mut self, evaluations: usize) {
        self.evaluations = self.evaluations.wrapping_add(evaluations);
    }
}

/// How far a call has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The part of the way that is done: 1 at its end, and only there; 0 if the state has not moved along it yet.
    pub fraction: f64,
}

impl Progress {
    /// The end is reached.
    pub const REACHED: Self = Self { fraction: 1.0 };

    /// A part of the way, which is not all of it.
    pub fn part(done: f64, all: f64) -> Self {
        Self { fraction: f64::min(done / all, 1.0 - f64::EPSILON) }
    }

    /// Whether the end is reached; if not, the same call goes on from here.
    #[must_use]
    pub fn is_reached(self) -> bool {
        self.fraction >= 1.0
    }
}

/// Evaluations that a solution takes at most whose branches of formulas are known: by the operations, by pivoting, and by the operations
/// once more.
pub const OF_FINDING: usize = 3;

/// Evaluations that the branches of formulas of time take.
pub const fn of_sides<M: Branches>() -> usize {
    if M::OF_TIME { 1 } else { 0 }
}

/// Evaluations that a solution takes at most.
pub const fn of_reaching<M: Branches>() -> usize {
    let branches = if M::OF_MOTION { MOST_BRANCHES } else { 1 };
    of_sides::<M>() + branches * OF_FINDING
}

/// Evaluations that the search for the first edge of a step takes at most.
pub const fn of_edge<M: Branches>() -> usize {
    (2 + MOST_HALVINGS) * of_sides::<M>()
}

/// Evaluations that one step takes at most, from the search for its end to the look at both sides of an edge.
pub const fn of_step<M: Branches>() -> usize {
    let rounding = 1;
    of_edge::<M>() + of_reaching::<M>() + rounding + OF_FINDING * of_sides::<M>()
}
