//! Emitted code, where it goes its own way: what chooses its steps is smaller than `analysis`.

/// Other parameters than those of the file (`crates/emit/src/runtime/assemble.rs`).
pub mod assemble {
    /// Trials on the way to them before the file's poses are tried.
    pub const FIRST_PARTS: usize = 4;
    /// Trials on it at most where these have not helped either.
    pub const MOST_PARTS: usize = 200;
    /// The smallest part of it.
    pub const SMALLEST_PART: f64 = 1e-6;
}

/// Closing from far away (`crates/emit/src/runtime/pivoting.rs`).
pub mod close {
    /// Corrections at most.
    pub const MOST_TRIALS: usize = 30;
    /// How often one is made half as long before it is taken as it is.
    pub const MOST_SHORTER: usize = 6;
    /// A correction that is so small, scaled, is the last one.
    pub const NEAR: f64 = 0.02;
}

/// Steps (`crates/emit/src/runtime/step.rs`).
pub mod step {
    /// Steps that `step` takes at most: some analyses of the file.
    pub const MOST_STEPS: usize = 10_000;
    /// The step before tells of one that is so many times as long at most.
    pub const FARTHEST_BEND: f64 = 4.0;
    /// How far velocities may lead elsewhere than positions, scaled: more is another branch.
    pub const LARGEST_GAP: f64 = 1e-3;
}

/// Branches of the motion and of formulas (`crates/emit/src/runtime/reach.rs`).
pub mod reach {
    /// One over a pivot, scaled: beyond this the position is looked at more closely.
    pub const STEEP: f64 = 1e3;
    /// Beyond this it is too near to a singular one.
    pub const STEEPEST: f64 = 1e6;
    /// How often the branches of formulas are chosen anew at one time.
    pub const MOST_BRANCHES: usize = 8;
}

/// Why a motion cannot go on (`crates/emit/src/runtime/explain.rs`).
pub mod explain {
    /// Where steps become too small, this is steep enough for a singular position to be the reason.
    pub const SINGULAR: f64 = 1e2;
}

/// Ends of formulas of time (`crates/emit/src/runtime/rims.rs`).
pub mod rims {
    /// How often both sides are looked at, each time at a quarter of the distance.
    pub const MOST_LOOKS: usize = 6;
    /// How often at least.
    pub const FEWEST_LOOKS: usize = 3;
    /// Beside the fastest motion a velocity that changes by more than this jumps.
    pub const SPEED_JUMP: f64 = 1e-6;
    /// A speed below this part of one per span is rest.
    pub const SLOW: f64 = 1e-3;
    /// A rim within this part of the span is one that was looked at.
    pub const PASSED: f64 = 1e-9;
}

/// The way of inputs (`crates/emit/src/runtime/follow.rs`).
pub mod follow {
    /// Steps that `follow` takes at most: as many as a change by half a turn asks for, and few enough for a control loop.
    pub const MOST_STEPS_TO_FOLLOW: usize = 64;
    /// The largest change of an angle in a call (rad): beyond half a turn nobody can say which way it went.
    pub const LARGEST_TURN_OF_INPUT: f64 = std::f64::consts::PI;
    /// The largest change of a length, beside the largest scale of a coordinate.
    pub const LARGEST_SHIFT_OF_INPUT: f64 = 2.0;
    /// A dead point that is so near by a signal's change, while a longer step is refused, is not passed.
    pub const NEAREST_TURN: f64 = 1e-6;
    /// Where a step is refused, this is steep enough for a dead point to be looked for.
    pub const NEAR_TURN: f64 = 10.0;
    /// A position jumps that is so many times farther away than slopes lead.
    pub const JUMP: f64 = 100.0;
    /// The shortest step, as a part of the way; of a long one, as a change of a signal.
    pub const SHORTEST_STEP: f64 = 1e-12;
    /// Signals go straight on if the square of what leads aside is no larger part of that of the whole.
    pub const LARGEST_TURN: f64 = 0.01;
}
