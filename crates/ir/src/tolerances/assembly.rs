//! Assembly, and the way to a start.

/// Estimates of contacts (`crates/lang/src/estimates.rs`).
pub mod estimates {
    /// Places on one turn that are looked at for one argument.
    pub const PLACES: usize = 720;
    /// Places on one turn for each of two arguments.
    pub const PLACES_OF_TWO: usize = 120;
    /// So many of the best places are refined.
    pub const CANDIDATES: usize = 8;
    /// An estimate need not be nearer than this.
    pub const REFINED: f64 = 1e-7;
    /// Steps downhill at most.
    pub const MOST_STEPS: usize = 1000;
    /// Mismatches that differ by less than this part of the widest are the same.
    pub const SAME: f64 = 1e-12;
}

/// Newton from the estimates, and singular starts (`crates/engine/src/analysis/assemble/assembly.rs`).
pub mod newton {
    /// Estimates from which drivers are off by no more than this, scaled, agree with them.
    pub const AGREES: f64 = 1e-6;
    /// Passes over the explicit coordinates at most; each settles what depends on the one before.
    pub const EXPLICIT_STEPS: usize = 50;
    /// Newton steps at most.
    pub const NEWTON_STEPS: usize = 200;
    /// Largest Newton step, scaled: small enough to stay with the branch of the estimates.
    pub const LARGEST_STEP: f64 = 0.3;
    /// Smallest damping of a Newton step before another method is tried.
    pub const SMALLEST_DAMPING: f64 = 1e-3;
    /// A correction below this leaves nothing to the next one.
    pub const SETTLED: f64 = 1e-7;
    /// Systems up to this size are assembled as a whole by the least-squares method, larger ones block by block.
    pub const LARGEST_DENSE: usize = 300;
    /// How far estimates are perturbed, scaled, one attempt after another.
    pub const PERTURBATIONS: [f64; 6] = [0.01, 0.05, 0.1, 0.2, 0.4, 0.8];
    /// A start nearer to a singular position than this is one: q is known only to the root of the tolerance there.
    pub const SINGULAR_START: f64 = 1e-5;
    /// Times nearby at which a singular start is looked at, as parts of the span.
    pub const NEARBY: [f64; 4] = [3e-3, -3e-3, 1e-2, -1e-2];
    /// How far a free motion is followed to look beside a singular start, scaled.
    pub const BESIDE: f64 = 0.02;
    /// A position that differs by less than this, scaled, is the same.
    pub const MOVED: f64 = 1e-4;
    /// Equations that are open by less than this hold nearly.
    pub const OPEN_NEARBY: f64 = 1e-9;
    /// A tangent shorter than this, in sizes of its body, is none.
    pub const VANISHING_TANGENT: f64 = 1e-7;
    /// An equation with less than this part of the slope beside it fixes nothing.
    pub const WITHOUT_SLOPE: f64 = 1e-5;
}

/// Damped least squares (`crates/engine/src/analysis/state/least_squares.rs`).
pub mod least_squares {
    /// Steps at most.
    pub const STEPS: usize = 300;
    /// Largest step, scaled: small enough to stay with the branch of the estimates.
    pub const LARGEST_STEP: f64 = 0.3;
    /// Damping to begin with.
    pub const DAMPING: f64 = 1e-3;
    /// Beyond this damping no step helps any more.
    pub const MOST_DAMPING: f64 = 1e12;
    /// No step is damped less than this.
    pub const LEAST_DAMPING: f64 = 1e-12;
    /// Equations that are open by less than this, scaled, hold.
    pub const CLOSED: f64 = 1e-15;
    /// A step that gains less than this part of what is left is the last one.
    pub const LEAST_GAIN: f64 = 1e-10;
}

/// Equations looked at one by one (`crates/engine/src/analysis/explain/evaluator.rs`).
pub mod evaluator {
    /// An equation that is off by more than this, scaled, by its slope is one whose slope vanishes.
    pub const HOPELESS: f64 = 30.0;
    /// How far coordinates are nudged, scaled.
    pub const NUDGE: f64 = 0.02;
}

/// Estimates that are far off (`crates/engine/src/analysis/assemble/branches.rs`).
pub mod branches {
    /// A body of a loop that turned by more than this (rad) was drawn the other way round.
    pub const TURNED_OVER: f64 = std::f64::consts::FRAC_PI_2;
    /// Another position that is at most this many times as far from the estimates is as near as the one taken.
    pub const AS_NEAR: f64 = 2.0;
    /// Positions that differ by less than this, scaled, are the same.
    pub const SAME: f64 = 1e-3;
    /// No others are looked for in loops of more coordinates.
    pub const LARGEST_LOOP: usize = 60;
    /// Nor in larger systems than this: each search evaluates the whole.
    pub const LARGEST_SYSTEM: usize = 300;
    /// Loops in which others are looked for.
    pub const MOST_LOOPS: usize = 8;
    /// Positions from which others are looked for at random.
    pub const RANDOM_STARTS: usize = 8;
}

/// Starts of parts (`crates/engine/src/analysis/assemble/parts.rs`).
pub mod parts {
    /// Blocks up to this size are solved for the sake of parts.
    pub const LARGEST: usize = 300;
}

/// Drivers that are led from where the drawing has them to where they begin (`crates/engine/src/analysis/follow/start.rs`).
pub mod drive {
    /// Closing that moves nothing farther than this, scaled, closes what is drawn.
    pub const AS_DRAWN: f64 = 0.01;
    /// A drawing that closes another way by less than this part of the motion means that way.
    pub const CLEARLY: f64 = 0.5;
    /// Whole turns at most.
    pub const MOST_TURNS: f64 = 100.0;
}

/// The way of inputs from their own values to those that are told (`crates/engine/src/analysis/follow/lead.rs`).
pub mod lead {
    /// How far before and behind a kink, as a part of the way, the mechanism is looked at.
    pub const BESIDE_A_KINK: f64 = 1e-9;
    /// By so much, scaled, a position may differ before and behind a kink.
    pub const KINK: f64 = 1e-6;
    /// Kinks on one way at most.
    pub const MOST_KINKS: usize = 1000;
}
