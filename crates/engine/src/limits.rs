//! Limits of the numerics that several files use, each with its meaning, unit and value. A limit of a single file stands there. Emitted code
//! uses the same limits.
//!
//! "Scaled" means lengths in sizes of their body, angles in radians, rows of `Φ` divided by their norm. A "span" is the time from the first
//! to the last output time. `docs/limits.md` lists all limits.

/// Default bound of each row of Φ, scaled.
pub const TOLERANCE: f64 = 1e-12;

/// Assembly.
pub mod assembly {
    /// Drawn poses satisfy an equation, and a loop is closed, if the residual, scaled, is at most this.
    pub(crate) const AGREES: f64 = 1e-6;
    /// Maximum number of steps of an iteration from the drawn poses.
    pub(crate) const MOST_STEPS: usize = 300;
    /// Times at which equations that depend on each other at a start are examined again, before and after it, as parts of the span.
    pub(crate) const NEARBY: [f64; 3] = [1.3e-3, 3.1e-3, 7.7e-3];
    /// Positions that differ by less than this, scaled, are equal.
    pub(crate) const SAME: f64 = 1e-4;
    /// Distance of trial positions from a position in which equations may be degenerate, scaled.
    pub(crate) const NUDGE: f64 = 0.02;
    /// Largest number of equations that are solved together by least squares, or searched for other solutions.
    pub(crate) const LARGEST_DENSE: usize = 300;
    /// Largest step, scaled: small enough to stay on the branch of the estimates.
    pub(crate) const LARGEST_STEP: f64 = 0.3;
}

/// Redundant equations, which are left out.
pub mod redundancy {
    /// Largest residual, in scales of the equation: lengths are written with so many digits.
    pub const LARGEST_OPENING: f64 = 1e-9;
    /// Smaller shares, and what is left of an equation without those that it depends on, are zero: an assembled position is accurate to the square
    /// root of rounding.
    pub(crate) const NO_SHARE: f64 = 1e-6;
    /// A row with a larger weight in a dependent row takes its place: without it the others are far from dependent.
    pub(crate) const HEAVY: f64 = 5.0;
    /// Maximum number of row exchanges at one position.
    pub(crate) const MOST_EXCHANGES: usize = 100;
}

/// Explanations.
pub mod explain {
    /// Maximum number of equations that are examined together: they form a dense matrix.
    pub(crate) const LARGEST: usize = 600;
    /// Smallest part in a dependency or a motion that is reported, relative to the largest.
    pub(crate) const SEEN: f64 = 1e-3;
    /// Smallest part of the largest share with which an equation, a force or a coordinate is named as a cause.
    pub(crate) const NAMED: f64 = 0.1;
    /// Weight reduction of the equations that stay open where others cannot hold with them; the residual of the others is smaller by the square of
    /// this.
    pub(crate) const YIELDING: f64 = 1e4;
    /// Maximum number of bodies, motions or joints that one message names.
    pub(crate) const MOST_NAMED: usize = 3;
}

/// Jumps: differences between both sides of a time.
pub mod jumps {
    /// A position jumps if it changes by more than this, scaled.
    pub const POSITION_JUMP: f64 = 1e-9;
    /// A velocity jumps if it changes by more than this part of the fastest, scaled.
    pub const VELOCITY_JUMP: f64 = 1e-7;
    /// An acceleration jumps if it changes by more than this part of the largest, scaled.
    pub(crate) const ACCELERATION_JUMP: f64 = 1e-6;
    /// A speed below this, per span and scaled, is rest.
    pub const REST: f64 = 1e-3;
}

/// Step control.
pub mod step_control {
    /// Largest first correction of a step, scaled. Like all sizes that steps are judged by, it does not bound positions that follow from
    /// other coordinates: the upper end of a tall lift moves far.
    pub const LARGEST_CORRECTION: f64 = 0.05;
    /// Largest correction between the ends of a step, on the curve through both, scaled.
    pub(crate) const LARGEST_BETWEEN: f64 = 1e-3;
    /// Largest predicted motion of a step, scaled: displacement in sizes of the body, or rotation in radians.
    pub const LARGEST_MOTION: f64 = 0.5;
    /// A step can be longer if its first correction is this many times below the largest one: the error of the predictor grows with h³.
    pub const CALM_CORRECTION: f64 = 12.0;
    /// A step can be longer if its correction between the ends is this many times below the largest one: the error of the curve grows with h⁶.
    pub const CALM_BETWEEN: f64 = 100.0;
    /// A step that covers this part of the rest is extended to the whole rest.
    pub const CRUMB: f64 = 0.999;
    /// Minimum number of steps over the span, so that events are found.
    pub const FEWEST_STEPS: f64 = 32.0;
    /// Minimum number of steps where a singular position may be as close as a step is large.
    pub(crate) const FEWEST_STEPS_NEAR: f64 = 64.0;
    /// Smallest step, as a part of the span.
    pub const SMALLEST_STEP: f64 = 1e-12;
    /// Maximum number of steps between two output times.
    pub(crate) const MOST_STEPS: u64 = 1_000_000;
}

/// Edges of formulas.
pub mod edges {
    /// Distance within which an output time is taken for an edge, in units in the last place.
    pub const SLACK: f64 = 4.0;
    /// Lookahead in time that determines on which side of an edge the motion continues, as a part of the span.
    pub const AHEAD: f64 = 1e-9;
    /// Longest lookahead (s): motions of seconds may occur in an analysis of years.
    pub const LONGEST_AHEAD: f64 = 1e-9;
    /// Largest motion in the lookahead, scaled.
    pub const FARTHEST_AHEAD: f64 = 1e-7;
}

/// Domain boundaries of formulas.
pub mod domain_boundaries {
    /// Largest distance from a boundary at which both sides are examined, as a part of the span.
    pub const FARTHEST: f64 = 1e-3;
    /// An event function is zero if it is at most this many units in the last place of its terms.
    pub const ROUNDING: f64 = 64.0;
    /// An event function is zero if a change of the time by this many units in its last place exceeds its value.
    pub const MOMENT: f64 = 1024.0;
    /// Number of halvings until two times are adjacent.
    pub const MOST_HALVINGS: usize = 100;
    /// A value is unbounded if it grows by at least this factor with each quarter of the distance, several times in a row.
    pub const GROWTH: f64 = 1.03;
}

/// Singular positions.
pub mod singular {
    /// A position is farther from a singular one than a limit if all its pivots are this many times the limit.
    pub(crate) const CLEAR_PIVOT: f64 = 10.0;
    /// Largest distance of a fold, as a part of the span.
    pub const NEAR_FOLD: f64 = 1e-5;
}

/// Rows that may be inaccurate.
pub mod error_bound {
    /// Largest rounding of a printed row: the promised accuracy.
    pub const ACCURACY: f64 = 1e-9;
    /// Slow motions count as at least this part of the fastest one, with which rounding grows.
    pub(crate) const SLOW: f64 = 1.0 / 64.0;
}

/// Solution for one row of results.
pub mod solver {
    /// Replacement for a pivot that vanishes.
    pub(crate) const LEAST_PIVOT: f64 = 1e-18;
    /// Largest scaled multiplier of an elimination; larger ones lose digits.
    pub const LARGEST_MULTIPLIER: f64 = 16.0;
    /// Largest block that is solved densely, with partial pivoting.
    pub(crate) const LARGEST_BLOCK: usize = 100;
    /// Cell of the grid, as a part of the scale of a coordinate. Half of its square is below rounding.
    pub(crate) const CELL: f64 = 1.0 / 134_217_728.0;
}

/// Newton's method in lanes.
pub mod lanes {
    /// Maximum number of iterations on a grid, two of which may be at a border of two cells.
    pub const ITERATIONS: usize = 8;
    /// A correction within this distance of half a cell, in cells, leads to a border of two cells. The rounding of corrections is smaller.
    pub const BORDER: f64 = 1.0 / 4_096.0;
}

/// Cells, into which a motion is divided to find extrema and integrals.
pub mod interval_search {
    /// Shortest cell, as a part of the span.
    pub(crate) const SHORTEST: f64 = 4.0 * f64::EPSILON;
    /// Ratio of successive distances from a time at which the growth of a formula is examined; the first distance is where the values are
    /// reliable.
    pub(crate) const FACTOR: f64 = 16.0;
    /// A formula grows without bound if its gain between successive distances from a time, which shrink by equal factors, does not shrink by this
    /// factor; it converges if its distance from the limit does. A pole has at least this growth when the distance is halved.
    pub(crate) const LEAST_GROWTH: f64 = 1.03;
    /// Rounding of a value, as a part of it.
    pub(crate) const ROUNDING: f64 = 32.0 * f64::EPSILON;
}

/// Extrema.
pub mod extremum {
    /// Largest error of the time of an extremum, as a part of the span, for a formula with a known slope.
    pub(crate) const TIMES: f64 = 1e-11;
    /// Values on two sides of a time differ, rather than by rounding, if they do so by more than this part of the range.
    pub(crate) const APART: f64 = 1e-6;
}

/// Integrals.
pub mod quadrature {
    /// Largest error of an integral, as a part of range times time.
    pub(crate) const ACCURACY: f64 = 1e-11;
    /// Rounding of a value, as a part of it.
    pub(crate) const ROUNDING: f64 = 4.0 * f64::EPSILON;
}

/// Guards.
pub mod guards {
    /// An argument crosses its threshold continuously, rather than jumps, if it comes closer to it than this part of its usual size.
    pub(crate) const NEAR: f64 = 1e-6;
}

/// Printed numbers.
pub mod printed {
    /// A smaller length (m) or angle (rad) is printed as 0: it is less than an atom.
    pub(crate) const NOTHING: f64 = 1e-12;
}

/// Values of formulas between states, and their rounding.
pub mod curve {
    /// Smaller numbers count as zero.
    pub(crate) const NOTHING: f64 = 1e-290;
    /// A value between two adjacent points is resolved if its interval is at most this part of it, or at most `NOTHING`.
    pub(crate) const KNOWN: f64 = 1e-12;
    /// Rounding of a moving quantity, as a part of the largest value so far.
    pub(crate) const ROUNDING: f64 = 8.0 * f64::EPSILON;
    /// Relative perturbation of moving quantities that shows how a formula amplifies their rounding.
    pub(crate) const MOVED: f64 = 1.0 / 1_048_576.0;
}
