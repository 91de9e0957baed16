//! Steps, and events between their ends.

/// Choice of the solved equations (`crates/engine/src/analysis/follow/row_selection.rs`).
pub mod choice {
    /// Largest weight of a row in a left-out one at the end of a step, both scaled: it bounds the loss of digits.
    pub const LARGEST_WEIGHT: f64 = 10.0;
    /// At such an end and at a start, rows with a larger weight are left out instead.
    pub const HEAVY: f64 = 5.0;
    /// Maximum number of row exchanges at one position.
    pub const MOST_EXCHANGES: usize = 100;
}

/// Step control (`crates/engine/src/analysis/follow/step`).
pub mod march {
    /// Largest first correction of a step, scaled. Like all sizes that steps are judged by, it does not bound positions that follow from
    /// other coordinates: the upper end of a tall lift moves far.
    pub const LARGEST_CORRECTION: f64 = 0.05;
    /// Largest later correction, as a part of the largest first one.
    pub const LATER_CORRECTION: f64 = 0.25;
    /// Largest correction between the ends of a step, on the curve through both, scaled.
    pub const LARGEST_BETWEEN: f64 = 1e-3;
    /// Largest predicted motion of a step, scaled: displacement in sizes of the body, or rotation in radians.
    pub const LARGEST_MOTION: f64 = 0.5;
    /// A step can be longer if its first correction is this many times below the largest one: the error of the predictor grows with h³.
    pub const CALM_CORRECTION: f64 = 12.0;
    /// A step can be longer if its correction between the ends is this many times below the largest one: the error of the curve grows with h⁶.
    pub const CALM_BETWEEN: f64 = 100.0;
    /// A step that covers this part of the rest is extended to the whole rest.
    pub const CRUMB: f64 = 0.999;
    /// Maximum number of corrections of a step.
    pub const ITERATIONS: usize = 4;
    /// A smaller correction needs no further one, since convergence is quadratic.
    pub const SETTLED: f64 = 1e-7;
    /// Closer to a singular position than this, more digits are required.
    pub const ILL: f64 = 0.01;
    /// Minimum number of steps over the span, so that events are found.
    pub const FEWEST_STEPS: f64 = 32.0;
    /// Minimum number of steps where a singular position may be as close as a step is large.
    pub const FEWEST_STEPS_NEAR: f64 = 64.0;
    /// Smallest step, as a part of the span.
    pub const SMALLEST_STEP: f64 = 1e-12;
    /// Closest distance to a singular position at the end of a step.
    pub const NEAREST: f64 = 1e-6;
    /// Maximum number of steps between two output times.
    pub const MOST_STEPS: u64 = 1_000_000;
}

/// Output times (`crates/engine/src/analysis/state/output_times.rs`).
pub mod times {
    /// An output time within this part of a step from the last time is the last time.
    pub const AT_THE_LAST: f64 = 1e-9;
    /// Larger numbers of steps are not exact.
    pub const MOST: f64 = 9e15;
}

/// Enclosures of functions (`crates/ir/src/program/interval_eval.rs`).
pub mod interval_eval {
    /// Distance from a pole (rad) within which a tangent may be on either side of it.
    pub const POLE_MARGIN: f64 = 1e-9;
}

/// Signals: values that depend on time alone (`crates/engine/src/analysis/follow/edges/signals.rs`).
pub mod signals {
    /// Largest effect on the mechanism, scaled, by which a signal may leave its values at the ends of a part of a step.
    pub const NEGLIGIBLE_MOTION: f64 = 0.03;
    /// Smallest part that is examined, as a part of the step.
    pub const FINEST: f64 = 1e-6;
    /// Maximum number of parts.
    pub const MOST_PARTS: usize = 100;
    /// Relative change of a signal for its difference quotient.
    pub const NUDGE: f64 = 1e-6;
}

/// Time-dependent terms of an equation (`crates/ir/src/program/time_terms.rs`).
pub mod time_terms {
    /// Maximum number of these terms that are tracked per equation.
    pub const MOST_PER_ROW: usize = 8;
}

/// Determinants that touch zero (`crates/engine/src/analysis/follow/step/touch.rs`).
pub mod touch {
    /// A determinant that falls within a step to this part of the lesser value at the ends may touch zero there. Shorter steps distinguish:
    /// near a zero they find it, and over a mere minimum their ends approach it.
    pub const DEEP: f64 = 0.01;
    /// Largest part of the greater value at the ends to which a determinant falls if it may touch zero: a parabola falls to a fifth if
    /// golden section takes its zero for the minimum.
    pub const SHALLOW: f64 = 0.5;
    /// Maximum number of sections of a step.
    pub const SECTIONS: usize = 60;
}

/// Edges of formulas (`crates/engine/src/analysis/follow/edges`).
pub mod edges {
    /// Distance within which an output time is taken for an edge, in units in the last place.
    pub const SLACK: f64 = 4.0;
    /// Smallest part that is searched for edges in time, as a part of the span.
    pub const FINEST: f64 = 1e-8;
    /// Maximum number of parts in one step: a formula that stays on its edge is never decided.
    pub const MOST_PARTS: usize = 2000;
    /// Smallest part of a step that is examined, as a part of the step.
    pub const FINEST_BETWEEN: f64 = 2e-4;
    /// Maximum number of parts of a step.
    pub const MOST_PARTS_BETWEEN: usize = 500;
    /// Lookahead in time that determines on which side of an edge the motion continues, as a part of the span.
    pub const AHEAD: f64 = 1e-9;
    /// Longest lookahead (s): motions of seconds may occur in an analysis of years.
    pub const LONGEST_AHEAD: f64 = 1e-9;
    /// Largest motion in the lookahead, scaled.
    pub const FARTHEST_AHEAD: f64 = 1e-7;
    /// Values below this part of the largest velocity or acceleration so far are rounding.
    pub const LAST_DIGITS: f64 = 1e-9;
    /// Amplification of the rounding of an edge's time in computed values.
    pub const UNCERTAIN: f64 = 16.0;
    /// An equation takes part in a jump if its residual is at least this part of the largest.
    pub const TAKES_PART: f64 = 1e-2;
    /// Longest time for which a chattering switch is ignored, as a part of the span.
    pub const LONGEST_REST: f64 = 1e-2;
    /// A motion of at most this size, scaled, is rest.
    pub const AT_REST: f64 = 1e-12;
    /// A motion of at most this many units in the last place is rest.
    pub const ROUNDING: f64 = 64.0;
    /// Change of coordinates for the difference quotient of a switch, scaled.
    pub const NUDGE: f64 = 1e-6;
    /// Maximum number of corrections of a position at an edge.
    pub const ITERATIONS: usize = 4;
}

/// Domain boundaries (`crates/engine/src/analysis/follow/edges/domain_boundaries.rs`).
pub mod rims {
    /// Smallest part that is searched, as a part of the span.
    pub const FINEST: f64 = 1e-8;
    /// Maximum number of parts in one step.
    pub const MOST_PARTS: usize = 2000;
    /// Smallest part of a step that is searched, as a part of the step.
    pub const FINEST_BETWEEN: f64 = 1e-4;
    /// Maximum number of parts of a step.
    pub const MOST_PARTS_BETWEEN: usize = 500;
    /// Largest distance from a boundary at which both sides are examined, as a part of the span.
    pub const FARTHEST: f64 = 1e-3;
    /// Distance behind a boundary at which its event function is examined, as a part of the span.
    pub const BEHIND: f64 = 1e-9;
    /// An event function is zero if it is at most this many units in the last place of its terms.
    pub const ROUNDING: f64 = 64.0;
    /// An event function is zero if a change of the time by this many units in its last place exceeds its value.
    pub const MOMENT: f64 = 1024.0;
    /// Bound like `MOMENT` for an event function of the motion, as a part of the span: positions are accurate to their tolerance.
    pub const MOMENT_OF_MOTION: f64 = 1e-9;
    /// Distance of the last step from a boundary that ends the motion, in units in the last place of the time.
    pub const LAST_MOMENT: f64 = 16.0;
    /// An event function is resolved if rounding is below this part of it.
    pub const KNOWN: f64 = 1e-6;
    /// Maximum number of doublings of a part whose end cannot be distinguished from a zero.
    pub const MOST_WIDER: u32 = 12;
    /// Number of halvings until two times are adjacent.
    pub const MOST_HALVINGS: usize = 100;
}

/// One-sided limits at a domain boundary (`crates/engine/src/analysis/follow/edges/one_sided_limits.rs`).
pub mod limits {
    /// Number of distances that are examined.
    pub const MOST: usize = 16;
    /// Number of distances with resolved values that a decision requires.
    pub const FEWEST: usize = 3;
    /// Smallest distance, in units in the last place of the time.
    pub const NEAREST: f64 = 64.0;
    /// Error of the time of an edge that is hidden by rounding, as a part of the span.
    pub const MISPLACED: f64 = 1e-8;
    /// A value is unbounded if it grows by at least this factor with each quarter of the distance, several times in a row.
    pub const GROWTH: f64 = 1.03;
    /// Amplification of rounding in computed values.
    pub const UNCERTAIN: f64 = 64.0;
    /// A change of acceleration is significant if rounding is at most this part of it.
    pub const EXACT: f64 = 0.1;
}
