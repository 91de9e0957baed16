//! Work and progress of a call.

use super::equations::Branches;
use super::limits::{MOST_BRANCHES, MOST_HALVINGS};

/// Number of evaluations of a call. One is a solution of the equations at a position with all checks there: by the
/// specialized operations, or by elimination with partial pivoting where these lose digits. Evaluating the formulas of time
/// that decide a branch, or the ends of their domains, counts as one too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Number of evaluations.
    pub evaluations: usize,
}

impl Work {
    /// Counts more evaluations.
    pub fn add(&mut self, evaluations: usize) {
        self.evaluations = self.evaluations.wrapping_add(evaluations);
    }
}

/// Progress of a call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Fraction of the path that is done: 1 only at its end; 0 if the state has not moved along it yet.
    pub fraction: f64,
}

impl Progress {
    /// The end of the path.
    pub const REACHED: Self = Self { fraction: 1.0 };

    /// Creates the progress of an incomplete path.
    pub fn part(done: f64, all: f64) -> Self {
        Self { fraction: f64::min(done / all, 1.0 - f64::EPSILON) }
    }

    /// Returns whether the end is reached; if not, the same call continues from here.
    #[must_use]
    pub fn is_reached(self) -> bool {
        self.fraction >= 1.0
    }
}

/// Largest number of evaluations of a solution on given branches of formulas: by the operations, by pivoting, and by the
/// operations again.
pub const OF_FINDING: usize = 3;

/// Number of evaluations of the branches of formulas of time.
pub const fn of_sides<M: Branches>() -> usize {
    if M::OF_TIME { 1 } else { 0 }
}

/// Largest number of evaluations of a solution.
pub const fn of_reaching<M: Branches>() -> usize {
    let branches = if M::OF_MOTION { MOST_BRANCHES } else { 1 };
    of_sides::<M>() + branches * OF_FINDING
}

/// Largest number of evaluations in the search for the first edge of a step.
pub const fn of_edge<M: Branches>() -> usize {
    (2 + MOST_HALVINGS) * of_sides::<M>()
}

/// Largest number of evaluations of one step, from the search for its end to the check of both sides of an edge.
pub const fn of_step<M: Branches>() -> usize {
    let rounding = 1;
    of_edge::<M>() + of_reaching::<M>() + rounding + OF_FINDING * of_sides::<M>()
}
