//! Emitted code, where it differs from the engine: its step control is simpler than that of `analysis`.

/// Parameters other than those of the file (`crates/emit/src/runtime/assemble.rs`).
pub mod assemble {
    /// Number of trials along the path to them before the file's poses are tried.
    pub const FIRST_PARTS: usize = 4;
    /// Maximum number of trials along the path if the poses have not helped either.
    pub const MOST_PARTS: usize = 200;
    /// Smallest trial, as a part of the path.
    pub const SMALLEST_PART: f64 = 1e-6;
}

/// Closure from far away (`crates/emit/src/runtime/pivoting.rs`).
pub mod close {
    /// Maximum number of corrections.
    pub const MOST_TRIALS: usize = 30;
    /// Maximum number of halvings of a correction before it is accepted.
    pub const MOST_SHORTER: usize = 6;
    /// A correction of at most this size, scaled, is the last one.
    pub const NEAR: f64 = 0.02;
}

/// Steps (`crates/emit/src/runtime/step.rs`).
pub mod step {
    /// Maximum number of steps in one call of `step`: several analyses of the file.
    pub const MOST_STEPS: usize = 10_000;
    /// Largest ratio of a step to the previous one for which the latter predicts it.
    pub const FARTHEST_BEND: f64 = 4.0;
    /// Largest deviation of velocities from the change of positions, scaled: beyond it the step is on another branch.
    pub const LARGEST_GAP: f64 = 1e-3;
}

/// Branches of the motion and of formulas (`crates/emit/src/runtime/reach.rs`).
pub mod reach {
    /// Largest inverse of a pivot, scaled, without a closer examination of the position.
    pub const STEEP: f64 = 1e3;
    /// Largest inverse of a pivot, scaled: beyond it the position is too close to a singular one.
    pub const STEEPEST: f64 = 1e6;
    /// Maximum number of times that the branches of formulas are chosen at one time.
    pub const MOST_BRANCHES: usize = 8;
}

/// Explanations of a motion that ends (`crates/emit/src/runtime/explain.rs`).
pub mod explain {
    /// Inverse of a pivot above which vanishing steps are explained by a singular position.
    pub const SINGULAR: f64 = 1e2;
}

/// Domain boundaries of formulas of time (`crates/emit/src/runtime/domain_boundaries.rs`).
pub mod rims {
    /// Maximum number of examinations of both sides, each at a quarter of the previous distance.
    pub const MOST_LOOKS: usize = 6;
    /// Minimum number of these examinations.
    pub const FEWEST_LOOKS: usize = 3;
    /// A velocity jumps if it changes by more than this part of the fastest motion.
    pub const SPEED_JUMP: f64 = 1e-6;
    /// A speed below this, per span, is rest.
    pub const SLOW: f64 = 1e-3;
    /// Boundaries within this part of the span have been examined.
    pub const PASSED: f64 = 1e-9;
}

/// Paths of inputs (`crates/emit/src/runtime/follow.rs`).
pub mod follow {
    /// Maximum number of steps in one call of `follow`: enough for half a turn, and few enough for a control loop.
    pub const MOST_STEPS_TO_FOLLOW: usize = 64;
    /// Largest change of an angle in a call (rad): beyond half a turn the direction is ambiguous.
    pub const LARGEST_TURN_OF_INPUT: f64 = std::f64::consts::PI;
    /// Largest change of a length in a call, relative to the largest scale of a coordinate.
    pub const LARGEST_SHIFT_OF_INPUT: f64 = 2.0;
    /// A dead point at this change of a signal is not passed while longer steps are rejected.
    pub const NEAREST_TURN: f64 = 1e-6;
    /// Inverse of a pivot above which a rejected step starts a search for a dead point.
    pub const NEAR_TURN: f64 = 10.0;
    /// A position jumps if it moves this many times as far as the slopes predict.
    pub const JUMP: f64 = 100.0;
    /// Shortest step, as a part of the path; for long paths, as a change of a signal.
    pub const SHORTEST_STEP: f64 = 1e-12;
    /// Signals continue straight if the square of the sideways part is at most this part of the square of the whole.
    pub const LARGEST_TURN: f64 = 0.01;
}
