//! Steps, and what happens between their ends.

/// Which equations are solved (`crates/engine/src/analysis/follow/choice.rs`).
pub mod choice {
    /// No step ends where a row has a larger weight than this in one that is left out, both scaled: digits are lost by no more than that.
    pub const LARGEST_WEIGHT: f64 = 10.0;
    /// There, and at a start, rows that have a larger weight than this are left out instead.
    pub const HEAVY: f64 = 5.0;
    /// Rows are exchanged so many times at most at one place.
    pub const MOST_EXCHANGES: usize = 100;
}

/// Steps (`crates/engine/src/analysis/follow/step`).
pub mod march {
    /// Largest first correction of a step, scaled. As all sizes that a step is judged by it is not that of a place which follows
    /// from other coordinates: the upper end of a tall lift goes far.
    pub const LARGEST_CORRECTION: f64 = 0.05;
    /// The later ones are at most this part of it.
    pub const LATER_CORRECTION: f64 = 0.25;
    /// Largest correction between the ends of a step, on the curve through both, scaled.
    pub const LARGEST_BETWEEN: f64 = 1e-3;
    /// Largest predicted motion of a step, scaled: a coordinate's way in sizes of its body, or its turn in radians.
    pub const LARGEST_MOTION: f64 = 0.5;
    /// A step is calm, so that a longer one would do as well, if its first correction is so many times less than the largest: the
    /// predictor's error grows with h³.
    pub const CALM_CORRECTION: f64 = 12.0;
    /// And if what is between its ends is so many times less: the curve's error grows with h⁶.
    pub const CALM_BETWEEN: f64 = 100.0;
    /// A step that makes this part of what is left makes all of it: no crumb is left behind it.
    pub const CRUMB: f64 = 0.999;
    /// Corrections of a step at most.
    pub const ITERATIONS: usize = 4;
    /// A correction below this leaves nothing to the next one, convergence being quadratic.
    pub const SETTLED: f64 = 1e-7;
    /// Nearer to a singular position than this more digits are needed.
    pub const ILL: f64 = 0.01;
    /// Steps over the whole span at least, so that what happens in it is met.
    pub const FEWEST_STEPS: f64 = 32.0;
    /// Where a singular position may be as near as the motion of such a step is large, there are more of them.
    pub const FEWEST_STEPS_NEAR: f64 = 64.0;
    /// Smallest step, as a part of the whole span.
    pub const SMALLEST_STEP: f64 = 1e-12;
    /// A position nearer to a singular one than this is not stepped to.
    pub const NEAREST: f64 = 1e-6;
    /// Steps from one output time to the next at most: what takes more is not meant.
    pub const MOST_STEPS: u64 = 1_000_000;
}

/// Output times (`crates/engine/src/analysis/state/times.rs`).
pub mod times {
    /// An output time that is no farther from the last time than this part of a step is that.
    pub const AT_THE_LAST: f64 = 1e-9;
    /// More steps than this are not told apart by their numbers.
    pub const MOST: f64 = 9e15;
}

/// What functions are between in an interval (`crates/ir/src/program/interval_eval.rs`).
pub mod enclosures {
    /// So near to a pole (rad) a tangent may be on either side of it.
    pub const BESIDE_A_POLE: f64 = 1e-9;
}

/// Values that time alone decides (`crates/engine/src/analysis/follow/edges/signals.rs`).
pub mod signals {
    /// A signal may leave the values at the ends of a part of a step by as much as moves the mechanism by this, scaled.
    pub const UNSEEN: f64 = 0.03;
    /// A step is looked through in parts no smaller than this one of it.
    pub const FINEST: f64 = 1e-6;
    /// In so many at most.
    pub const MOST_PARTS: usize = 100;
    /// How much a signal is changed to learn what it does to the equations, in parts of itself.
    pub const NUDGE: f64 = 1e-6;
}

/// Values that time alone decides, in a row (`crates/ir/src/program/time_terms.rs`).
pub mod signals_in_a_row {
    /// An equation that takes more signals is told of these only.
    pub const MOST_IN_A_ROW: usize = 8;
}

/// Determinants that come to zero and go back (`crates/engine/src/analysis/follow/step/touch.rs`).
pub mod touch {
    /// A determinant that falls within a step to this part of its lesser value at the ends may touch zero there. Shorter steps
    /// tell: beside a zero they meet it, over a mere minimum the ends come down to it.
    pub const DEEP: f64 = 0.01;
    /// Between its values at the ends of an interval a parabola that touches zero falls to a fifth of the greater one, if the
    /// golden section takes it for the place of the minimum.
    pub const SHALLOW: f64 = 0.5;
    /// Sections of a step at most.
    pub const SECTIONS: usize = 60;
}

/// Edges of formulas (`crates/engine/src/analysis/follow/edges`).
pub mod edges {
    /// So many units in the last place of an output time it may be off from the edge that it is meant to be.
    pub const SLACK: f64 = 4.0;
    /// The span is looked through for edges of time in parts no smaller than this one of it.
    pub const FINEST: f64 = 1e-8;
    /// Parts that are looked at in one step at most: where a formula stands on its edge all the time nothing is ever decided.
    pub const MOST_PARTS: usize = 2000;
    /// A step is looked through in parts no smaller than this one of it.
    pub const FINEST_BETWEEN: f64 = 2e-4;
    /// In so many at most.
    pub const MOST_PARTS_BETWEEN: usize = 500;
    /// How far, as a part of the span, the motion is looked ahead to tell on which side of an edge it goes on.
    pub const AHEAD: f64 = 1e-9;
    /// And at most (s): motions of a second may come at the start of an analysis of years.
    pub const LONGEST_AHEAD: f64 = 1e-9;
    /// Nothing may move farther than this meanwhile, scaled.
    pub const FARTHEST_AHEAD: f64 = 1e-7;
    /// What is smaller than this part of the largest velocity or acceleration so far is rounding.
    pub const LAST_DIGITS: f64 = 1e-9;
    /// The rounding of an edge's time may show so many times in what is computed there.
    pub const UNCERTAIN: f64 = 16.0;
    /// An equation takes part in a jump if it is left open by this part of the widest.
    pub const TAKES_PART: f64 = 1e-2;
    /// A restless switch is left alone for this part of the span at most.
    pub const LONGEST_REST: f64 = 1e-2;
    /// A motion is none if it is no more than this, scaled.
    pub const AT_REST: f64 = 1e-12;
    /// Or if it is no more than so many units in the last place.
    pub const ROUNDING: f64 = 64.0;
    /// How far the coordinates are moved to learn what a switch is decided by, scaled.
    pub const NUDGE: f64 = 1e-6;
    /// Corrections of a position at an edge at most.
    pub const ITERATIONS: usize = 4;
}

/// Ends of what a function takes (`crates/engine/src/analysis/follow/edges/rims.rs`).
pub mod rims {
    /// The span is looked through in parts no smaller than this one of it.
    pub const FINEST: f64 = 1e-8;
    /// In so many in one step at most.
    pub const MOST_PARTS: usize = 2000;
    /// A step is looked through in parts no smaller than this one of it.
    pub const FINEST_BETWEEN: f64 = 1e-4;
    /// In so many at most.
    pub const MOST_PARTS_BETWEEN: usize = 500;
    /// Both sides are looked at from so far on, as a part of the span.
    pub const FARTHEST: f64 = 1e-3;
    /// Behind a rim its gauge is looked at from this part of the span on.
    pub const BEHIND: f64 = 1e-9;
    /// A gauge is zero at a time if it is no more than so many units in the last place of its terms.
    pub const ROUNDING: f64 = 64.0;
    /// Or if the rounding of the time, so many units in its last place, changes it by more than itself.
    pub const MOMENT: f64 = 1024.0;
    /// The same for a gauge that the motion decides, as a part of the span: positions are known to their tolerance.
    pub const MOMENT_OF_MOTION: f64 = 1e-9;
    /// Before a rim at which the motion ends, the last step ends so many units in the last place of its time earlier.
    pub const LAST_MOMENT: f64 = 16.0;
    /// A gauge is known where rounding makes less than this part of it.
    pub const KNOWN: f64 = 1e-6;
    /// How often a part whose end cannot be told from a zero is made twice as wide.
    pub const MOST_WIDER: u32 = 12;
    /// Halvings until two times are neighbours.
    pub const MOST_HALVINGS: usize = 100;
}

/// Both sides of a rim (`crates/engine/src/analysis/follow/edges/limits.rs`).
pub mod limits {
    /// Distances that are looked at.
    pub const MOST: usize = 16;
    /// Of so many something must be known to be judged.
    pub const FEWEST: usize = 3;
    /// The nearest distance, in units in the last place of the time.
    pub const NEAREST: f64 = 64.0;
    /// The time of an edge may be off by this part of the span where rounding hides it.
    pub const MISPLACED: f64 = 1e-8;
    /// What grows by this factor or more with each quarter of the distance, the last times in a row, grows without bound.
    pub const GROWTH: f64 = 1.03;
    /// Rounding shows so many times in what is computed from it.
    pub const UNCERTAIN: f64 = 64.0;
    /// A change of acceleration of which rounding is no more than this part is one.
    pub const EXACT: f64 = 0.1;
}
