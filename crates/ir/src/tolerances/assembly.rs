//! Assembly, and continuation to a start.

/// Estimates of contacts (`crates/lang/src/estimates.rs`).
pub mod estimates {
    /// Samples of one argument over one turn.
    pub const PLACES: usize = 720;
    /// Samples of each of two arguments over one turn.
    pub const PLACES_OF_TWO: usize = 120;
    /// Number of the best samples that are refined.
    pub const CANDIDATES: usize = 8;
    /// Accuracy of a refined estimate.
    pub const REFINED: f64 = 1e-7;
    /// Maximum number of descent steps.
    pub const MOST_STEPS: usize = 1000;
    /// Mismatches that differ by less than this part of the largest are equal.
    pub const SAME: f64 = 1e-12;
}

/// Newton from the estimates, and singular starts (`crates/engine/src/analysis/assemble/assembly.rs`).
pub mod newton {
    /// Estimates agree with a driver if its residual, scaled, is at most this.
    pub const AGREES: f64 = 1e-6;
    /// Maximum number of passes over the explicit coordinates; each pass resolves those that depend on the previous one.
    pub const EXPLICIT_STEPS: usize = 50;
    /// Maximum number of Newton steps.
    pub const NEWTON_STEPS: usize = 200;
    /// Largest Newton step, scaled: small enough to stay on the branch of the estimates.
    pub const LARGEST_STEP: f64 = 0.3;
    /// Smallest damping of a Newton step before another method is tried.
    pub const SMALLEST_DAMPING: f64 = 1e-3;
    /// A smaller correction, scaled, needs no further step.
    pub const SETTLED: f64 = 1e-7;
    /// Systems up to this size are assembled as a whole by least squares, larger ones block by block.
    pub const LARGEST_DENSE: usize = 300;
    /// Sizes of the perturbations of estimates, scaled, one attempt after another.
    pub const PERTURBATIONS: [f64; 6] = [0.01, 0.05, 0.1, 0.2, 0.4, 0.8];
    /// A start closer to a singular position than this is singular: there q is accurate only to the square root of the tolerance.
    pub const SINGULAR_START: f64 = 1e-5;
    /// Times at which the neighborhood of a singular start is examined, as parts of the span.
    pub const NEARBY: [f64; 4] = [3e-3, -3e-3, 1e-2, -1e-2];
    /// Distance along a free motion at which the neighborhood of a singular start is examined, scaled.
    pub const BESIDE: f64 = 0.02;
    /// Positions that differ by less than this, scaled, are equal.
    pub const MOVED: f64 = 1e-4;
    /// Equations with smaller residuals are almost satisfied.
    pub const OPEN_NEARBY: f64 = 1e-9;
    /// A tangent shorter than this, in sizes of its body, vanishes.
    pub const VANISHING_TANGENT: f64 = 1e-7;
    /// An equation whose slope is below this part of the slope nearby fixes nothing.
    pub const WITHOUT_SLOPE: f64 = 1e-5;
}

/// Damped least squares (`crates/engine/src/analysis/state/least_squares.rs`).
pub mod least_squares {
    /// Maximum number of steps.
    pub const STEPS: usize = 300;
    /// Largest step, scaled: small enough to stay on the branch of the estimates.
    pub const LARGEST_STEP: f64 = 0.3;
    /// Initial damping.
    pub const DAMPING: f64 = 1e-3;
    /// Largest damping; beyond it no step helps.
    pub const MOST_DAMPING: f64 = 1e12;
    /// Smallest damping.
    pub const LEAST_DAMPING: f64 = 1e-12;
    /// Equations with smaller residuals, scaled, are satisfied.
    pub const CLOSED: f64 = 1e-15;
    /// The iteration ends when a step reduces the residual by less than this part.
    pub const LEAST_GAIN: f64 = 1e-10;
}

/// Equations examined one by one (`crates/engine/src/analysis/explain/evaluator.rs`).
pub mod evaluator {
    /// An equation whose residual over its slope exceeds this, scaled, has a vanishing slope.
    pub const HOPELESS: f64 = 30.0;
    /// Size of trial changes of coordinates, scaled.
    pub const NUDGE: f64 = 0.02;
}

/// Estimates far from the assembled position (`crates/engine/src/analysis/assemble/branches.rs`).
pub mod branches {
    /// A body of a loop that turns by more than this (rad) during assembly was drawn in the other orientation.
    pub const TURNED_OVER: f64 = std::f64::consts::FRAC_PI_2;
    /// Another position is an alternative if it is at most this many times as far from the estimates as the chosen one.
    pub const AS_NEAR: f64 = 2.0;
    /// Positions that differ by less than this, scaled, are equal.
    pub const SAME: f64 = 1e-3;
    /// Largest number of coordinates of a loop whose alternatives are searched for.
    pub const LARGEST_LOOP: usize = 60;
    /// Largest system in which alternatives are searched for: each search evaluates the whole system.
    pub const LARGEST_SYSTEM: usize = 300;
    /// Maximum number of loops in which alternatives are searched for.
    pub const MOST_LOOPS: usize = 8;
    /// Number of random starts of the search.
    pub const RANDOM_STARTS: usize = 8;
}

/// Separate assembly of parts (`crates/engine/src/analysis/assemble/parts.rs`).
pub mod parts {
    /// Largest block that is solved to start parts.
    pub const LARGEST: usize = 300;
}

/// Drivers that are continued from their drawn values to their initial values (`crates/engine/src/analysis/follow/start.rs`).
pub mod drive {
    /// A closure that moves nothing farther than this, scaled, agrees with the drawing.
    pub const AS_DRAWN: f64 = 0.01;
    /// A closure by another direction is taken if its motion is shorter by this factor.
    pub const CLEARLY: f64 = 0.5;
    /// Maximum number of whole turns.
    pub const MOST_TURNS: f64 = 100.0;
}

/// Continuation of inputs from nominal to given values (`crates/engine/src/analysis/follow/continuation.rs`).
pub mod lead {
    /// Distance before and behind a kink at which the mechanism is examined, as a part of the path.
    pub const KINK_OFFSET: f64 = 1e-9;
    /// Largest difference of the positions before and behind a kink, scaled.
    pub const KINK: f64 = 1e-6;
    /// Maximum number of kinks on one path.
    pub const MOST_KINKS: usize = 1000;
}
