//! Explanations of mechanisms that are not determined or cannot be assembled.

/// Explanations of the refused part (`crates/engine/src/analysis/explain/determine.rs`).
pub mod determine {
    /// Largest part that is examined with values: its equations form a dense matrix.
    pub const LARGEST: usize = 600;
    /// Largest part if redundant equations are allowed: that takes some seconds.
    pub const LARGEST_ALLOWED: usize = 1500;
}

/// Dependent equations (`crates/engine/src/analysis/explain/redundancy.rs`).
pub mod redundancy {
    /// Equations are dependent below this residual: an assembled position is accurate to the square root of rounding.
    pub const DEPENDENT: f64 = 1e-6;
    /// An equation takes part in a dependency if its share exceeds this.
    pub const TAKES_PART: f64 = 1e-6;
    /// Rows on which others depend with a larger weight are eliminated last: without them the others are far from dependent.
    pub const HEAVY: f64 = 5.0;
    /// Maximum number of row exchanges.
    pub const MOST_EXCHANGES: usize = 30;
    /// Weight reduction of the equations whose minimum residual is computed; the residual of the others is smaller by the square of this.
    pub const YIELDING: f64 = 100.0;
    /// Number of restarts of that least-squares method.
    pub const PASSES: usize = 4;
    /// Equations with larger residuals, scaled, do not hold; the same bound as along the motion.
    pub const OPEN: f64 = crate::tolerances::checks::LARGEST_OPENING;
    /// Times at which the equations are examined, as parts of the span after the first time.
    pub const NEARBY: [f64; 3] = [1.3e-3, 3.1e-3, 7.7e-3];
}

/// Forces that redundant equations share (`crates/engine/src/analysis/explain/sharing.rs`).
pub mod sharing {
    /// First step along the motion, as a part of the span.
    pub const FIRST_STEP: f64 = 1e-3;
    /// Longest step, as a part of the span: long enough to pass a rest.
    pub const LONGEST_STEP: f64 = 1.0 / 32.0;
    /// Largest motion of a coordinate in a step, scaled.
    pub const LARGEST_STEP: f64 = 0.3;
    /// Largest deviation of the end of a step from its prediction, scaled; beyond it the step is on another branch.
    pub const APART: f64 = 0.1;
    /// Distance between the examined positions, scaled.
    pub const FRESH: f64 = 0.03;
    /// Maximum number of steps: enough for the whole motion of something that turns once or twice.
    pub const MOST_STEPS: usize = 200;
    /// Maximum work of all steps, as rows times the square of coordinates: about a second.
    pub const MOST_WORK: usize = 1_000_000_000;
}

/// Free motions and suggestions to fix them (`crates/engine/src/analysis/explain/freedom.rs`, `crates/engine/src/analysis/explain/proposals.rs`).
pub mod freedom {
    /// Largest residual of an assembled position; free motions are only reported at one.
    pub const ASSEMBLED: f64 = 1e-8;
    /// A coordinate moves if its share of the free motions exceeds this.
    pub const MOVES: f64 = 1e-6;
    /// A coordinate with at least this share is not constrained at all.
    pub const LOOSE: f64 = 1.0 - 1e-9;
    /// Free motions are described by angles whose share is at least this part of the largest.
    pub const ANGLE_SHARE: f64 = 0.01;
    /// A driver fixes a freedom if its quantity changes at this rate along it.
    pub const TAKEN: f64 = 1e-3;
    /// Points that are drawn closer than this, in sizes of the mechanism, may be intended to coincide.
    pub const COINCIDE: f64 = 0.02;
    /// Distance within which two points that no joint uses may be intended to coincide, in sizes of the mechanism.
    pub const DANGLING: f64 = 0.15;
    /// Maximum number of reported motions.
    pub const TOLD: usize = 3;
    /// Maximum number of suggested joints.
    pub const SUGGESTED: usize = 3;
    /// Maximum number of points that are compared with each other.
    pub const MOST_POINTS: usize = 1000;
}

/// Loops that cannot be closed (`crates/engine/src/analysis/explain/open_loop.rs`).
pub mod open_loop {
    /// Maximum number of equations that are examined together.
    pub const LARGEST: usize = 600;
    /// A force takes part in the balance of a link if it exceeds this part of the largest force.
    pub const PULLS: f64 = 0.1;
    /// An equation is part of the loop if its share of the residual exceeds this part of the largest.
    pub const TAKES_PART: f64 = 0.01;
    /// Weight reduction of one joint, so that the loop opens there.
    pub const LIGHT: f64 = 1e4;
    /// A link is too short or too long if at least this part of the force acts along it.
    pub const ALONG: f64 = 0.3;
    /// Larger gaps, in sizes of the mechanism, are not shown.
    pub const FAR: f64 = 10.0;
    /// A loop is open in length if the gap exceeds this part of the gap in angles, scaled.
    pub const IN_LENGTH: f64 = 0.1;
    /// A joint may be reported as open if its gap is this part of the widest.
    pub const WIDE: f64 = 0.3;
    /// Smaller gaps, scaled, are closed.
    pub const CLOSED: f64 = 1e-6;
}

/// Printed numbers (`crates/engine/src/analysis/explain/errors/mod.rs`).
pub mod words {
    /// A smaller length (m) or angle (rad) is printed as 0: it is less than an atom.
    pub const NOTHING: f64 = 1e-12;
}

/// Bodies that do not move (`crates/lang/src/lower/velocities.rs`).
pub mod velocities {
    /// Distances below this part of the mechanism's size, and speeds below this part of it per duration of the analysis, are zero; the
    /// inverse is the largest distance of an instant centre, in sizes of the mechanism.
    pub const NOTHING: f64 = 1e-9;
    /// Relative rotations up to this many roundings of the fastest motion are zero.
    pub const ROUNDING: f64 = 64.0;
}

/// Gears that do not mesh, and suggested poses (`crates/engine/src/analysis/assemble/errors.rs`).
pub mod fits {
    /// A pose is suggested for a body that assembly has moved by more than this, scaled.
    pub const MOVED: f64 = 1e-6;
    /// Smaller values (m, rad) are written as 0.
    pub const NOTHING: f64 = 1e-12;
    /// Largest misfit of a gear pair, as a part of the larger radius.
    pub const LARGEST_MISFIT: f64 = 1e-6;
}
