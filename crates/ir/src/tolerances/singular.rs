//! Singular positions on the way.

/// Why steps vanish (`crates/engine/src/analysis/explain/singular.rs`).
pub mod reasons {
    /// Below this the position is called singular, or as near to one as the steps could come.
    pub const NEAR: f64 = 1e-2;
    /// A relative curvature below this is taken for none, beside a position that is singular.
    pub const FLAT: f64 = 1e-3;
    /// A curve has a cusp where its radius of curvature is below this part of its body's size, and its tangent vanishes.
    pub const CUSP: f64 = 1e-2;
    /// A fold is no further off than this part of the span.
    pub const NEAR_FOLD: f64 = 1e-5;
    /// A formula has come to the end of what its function takes, or to a pole, if no more than this part of its terms is left.
    pub const AT_HAND: f64 = 1e-6;
    /// A part of the largest motion that is worth telling.
    pub const SEEN: f64 = 1e-3;
    /// A formula that ends explains most where it does so no more of the last steps ahead than these.
    pub const STEPS_AHEAD: f64 = 1000.0;
    /// A gauge goes down like a parabola where it is four times as large twice as far from zero, but for this.
    pub const PARABOLA: f64 = 0.25;
    /// An equation is told of a dependency, or a coordinate of a free motion, whose share is above this part of the largest.
    pub const TOLD: f64 = 0.1;
    /// Shares are told apart by so many parts of the largest: rounding does not order what weighs the same.
    pub const WEIGHTS: f64 = 1e6;
    /// A driver takes part in a dependency if its share is above this part of the largest.
    pub const TAKES_PART: f64 = 1e-3;
}

/// The way over a singular position (`crates/engine/src/analysis/follow/crossing`).
pub mod bridge {
    /// A state nearer than this to a singular position is not clear of it.
    ///
    /// Rounding in Φ is multiplied by 1/σ in q, and by 1/σ again in each derivative: 8e-3 leaves nine digits.
    pub const CLEAR: f64 = 8e-3;
    /// The first state beyond is clear enough if it is no nearer to a singular position than this part of the limit.
    pub const NEARLY_CLEAR: f64 = 0.3;
    /// A state nearer than this to a singular position cannot be solved for: rounding by 1/σ² is more than the accuracy promised.
    pub const SOLVABLE: f64 = 1e-3;
    /// Solving beside a singular position leaves more than eight digits of accelerations down to here.
    pub const EXACT: f64 = 4e-3;
    /// A curve's velocities and accelerations leave no more open of their equations, scaled, beside 1 or a part of the motion's
    /// fastest.
    pub const OPEN: [f64; 2] = [1e-8, 1e-6];
    /// Steps back from a start beside a singular position at most.
    pub const STEPS_BACK: usize = 64;
    /// How far each of them goes, scaled.
    pub const STEP_BACK: f64 = 2e-3;
    /// How far beyond the singular position the first state is looked for, as parts of the way up to it.
    pub const BEYOND: [f64; 4] = [0.7, 1.0, 2.0, 4.0];
    /// The correction of the prediction beyond, as a part of the way, is at most this: other branches are further off.
    pub const LARGEST_CORRECTION: f64 = 0.05;
    /// The curve over the bridge leaves corrections of at most this part of the way at some places between. One that joins two
    /// branches leaves more, be it that both touch each other.
    pub const LARGEST_BETWEEN: f64 = 1e-4;
    /// The time of a singular position is certain to this part of the bridge.
    pub const CERTAIN: f64 = 1e-6;
    /// Where on the way the curve over the bridge is held against the equations, as parts of it.
    pub const PLACES: [f64; 3] = [0.25, 0.5, 0.75];
    /// Places at which a bridge is looked at for a singular position that is come to twice.
    pub const PLACES_BETWEEN: usize = 24;
    /// A determinant below this part of what it is at the ends has another sign, and does not just touch zero.
    pub const BEYOND_ZERO: f64 = -1e-6;
    /// Below this a curve that is more exact decides.
    pub const NEARLY_ZERO: f64 = 1e-2;
    /// Times at which the minimum of an even contact is looked for.
    pub const LOOKS: usize = 80;
    /// Newton steps to the minimum's place.
    pub const NEWTON_STEPS: usize = 8;
    /// The distance of the places that its slope is taken from, as a part of the bridge.
    pub const SPREAD: f64 = 0.08;
}

/// The finer curve of a bridge (`crates/engine/src/analysis/follow/crossing/finer.rs`).
pub mod finer {
    /// The outer states are so far from the ends of the bridge, as a part of its length.
    pub const OUTWARD: f64 = 0.7;
    /// Steps to an outer state.
    pub const STEPS: usize = 8;
    /// The curve's accelerations are this exact where they can be solved for, beside their size or 1, scaled; and its velocities.
    pub const EXACT: f64 = 2e-9;
}

/// Whether there are positions all the way (`crates/engine/src/analysis/follow/crossing/reach.rs`).
pub mod reach {
    /// Corrections of a position beside the curve at most.
    pub const CORRECTIONS: usize = 60;
    /// Each must come down to this part of the one before.
    pub const CONTRACTS: f64 = 0.7;
    /// A correction below this, scaled, leaves nothing in λ.
    pub const SETTLED: f64 = 1e-13;
    /// Where corrections no longer come down, one below so many times that is rounding.
    pub const ROUNDING: f64 = 1e3;
    /// Times within the bridge at which the free motion's way is taken.
    pub const SAMPLES: usize = 9;
    /// An extremum in time, where it is near to the singular position's, is looked for by so many parabolas.
    pub const PARABOLAS_IN_TIME: usize = 2;
    /// One on the free motion's way by so many.
    pub const PARABOLAS: usize = 3;
    /// Each goes over this part of the way of the one before.
    pub const NARROWER: f64 = 0.05;
    /// Rows take part in a dependency from this part of the largest on.
    pub const TAKES_PART: f64 = 0.1;
    /// So many times what may be left of the equations is not told from nothing.
    pub const MARGIN: f64 = 4.0;
}

/// Change points that are just missed (`crates/engine/src/analysis/follow/misses.rs`).
pub mod misses {
    /// A motion that comes as near to a change point as this part of the lengths is told of: drawings are rounded so.
    pub const WITHIN: f64 = 5e-4;
    /// The part that lengths are off by, of the square of the driver's way in which the motion turns away.
    pub const OF_LENGTHS: f64 = 1.0 / 3.0;
    /// What is farther from a singular position than this is far from it.
    pub const FAR: f64 = 0.1;
    /// The least singular value is at most this part of the largest before it: some mechanisms are never far.
    pub const FALLS: f64 = 0.4;
    /// Meanwhile the speed of drivers changes by no more than this part.
    pub const EVEN: f64 = 0.3;
}
