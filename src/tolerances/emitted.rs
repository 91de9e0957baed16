//! Emitted code, where it goes its own way: what chooses its steps is smaller than `analysis`.

/// Other parameters than those of the file (`emit/runtime/assemble.rs`).
pub mod assemble {
    /// Trials on the way to them at most.
    pub const MOST_PARTS: usize = 10_000;
    /// The smallest part of it.
    pub const SMALLEST_PART: f64 = 1e-6;
}

/// Steps (`emit/runtime/step.rs`).
pub mod step {
    /// The step before tells of one that is so many times as long at most.
    pub const FARTHEST_BEND: f64 = 4.0;
    /// How far velocities may lead elsewhere than positions, scaled: more is another branch.
    pub const LARGEST_GAP: f64 = 1e-3;
}

/// Branches of the motion and of formulas (`emit/runtime/reach.rs`).
pub mod reach {
    /// One over a pivot, scaled: beyond this the position is looked at more closely.
    pub const STEEP: f64 = 1e3;
    /// Beyond this it is too near to a singular one.
    pub const STEEPEST: f64 = 1e6;
    /// How often the branches of formulas are chosen anew at one time.
    pub const MOST_BRANCHES: usize = 8;
}

/// Why a motion cannot go on (`emit/runtime/explain.rs`).
pub mod explain {
    /// Where steps become too small, this is steep enough for a singular position to be the reason.
    pub const SINGULAR: f64 = 1e2;
}

/// Ends of formulas of time (`emit/runtime/rims.rs`).
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

/// The way of inputs (`emit/runtime/follow.rs`).
pub mod follow {
    /// The shortest step, as a part of the way; of a long one, as a change of a signal.
    pub const SHORTEST_STEP: f64 = 1e-12;
    /// Signals go straight on if the square of what leads aside is no larger part of that of the whole.
    pub const LARGEST_TURN: f64 = 0.01;
}
