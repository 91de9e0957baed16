//! Singular positions along the motion.

/// Explanations of vanishing steps (`crates/engine/src/analysis/explain/singular.rs`).
pub mod reasons {
    /// A position closer to a singular one than this is called singular, or as close as steps could get.
    pub const NEAR: f64 = 1e-2;
    /// A relative curvature below this is called zero near a singular position.
    pub const FLAT: f64 = 1e-3;
    /// A curve has a cusp if its radius of curvature is below this part of its body's size, and its tangent vanishes.
    pub const CUSP: f64 = 1e-2;
    /// Largest distance of a fold, as a part of the span.
    pub const NEAR_FOLD: f64 = 1e-5;
    /// A formula has reached the end of a function's domain, or a pole, if at most this part of its terms is left.
    pub const VANISHED: f64 = 1e-6;
    /// Smallest motion that is reported, as a part of the largest.
    pub const SEEN: f64 = 1e-3;
    /// A formula that ends is the explanation if it does so within this many of the last steps.
    pub const STEPS_AHEAD: f64 = 1000.0;
    /// Largest deviation from a parabola, which is four times as large at twice the distance from zero, for an event function.
    pub const PARABOLA: f64 = 0.25;
    /// Smallest share that is reported of an equation in a dependency or a coordinate in a free motion, as a part of the largest.
    pub const TOLD: f64 = 0.1;
    /// Resolution of shares, in parts of the largest: rounding must not order equal shares.
    pub const WEIGHTS: f64 = 1e6;
    /// A driver takes part in a dependency if its share exceeds this part of the largest.
    pub const TAKES_PART: f64 = 1e-3;
}

/// Bridges across singular positions (`crates/engine/src/analysis/follow/crossing`).
pub mod bridge {
    /// A state closer than this to a singular position is not clear of it.
    ///
    /// Rounding in Φ is multiplied by 1/σ in q, and by 1/σ again in each derivative: 8e-3 leaves nine digits.
    pub const CLEAR: f64 = 8e-3;
    /// The first state beyond is accepted if it is no closer to a singular position than this part of the limit.
    pub const NEARLY_CLEAR: f64 = 0.3;
    /// A state closer than this to a singular position cannot be solved for: rounding by 1/σ² exceeds the promised accuracy.
    pub const SOLVABLE: f64 = 1e-3;
    /// Closest distance to a singular position at which solving leaves more than eight digits of accelerations.
    pub const EXACT: f64 = 4e-3;
    /// Largest residuals of velocities and accelerations on the curve, scaled, relative to 1 or a part of the fastest motion.
    pub const OPEN: [f64; 2] = [1e-8, 1e-6];
    /// Maximum number of steps back from a start near a singular position.
    pub const STEPS_BACK: usize = 64;
    /// Length of a step back, scaled.
    pub const STEP_BACK: f64 = 2e-3;
    /// Distances beyond the singular position at which the first state is searched for, as parts of the path up to it.
    pub const BEYOND: [f64; 4] = [0.7, 1.0, 2.0, 4.0];
    /// Largest correction of the prediction beyond, as a part of the path: other branches are farther away.
    pub const LARGEST_CORRECTION: f64 = 0.05;
    /// Largest correction of the curve over the bridge at positions between, as a part of the path. A curve that joins two branches has
    /// larger ones, even if the branches touch.
    pub const LARGEST_BETWEEN: f64 = 1e-4;
    /// Accuracy of the time of a singular position, as a part of the bridge.
    pub const CERTAIN: f64 = 1e-6;
    /// Positions at which the curve over the bridge is verified, as parts of the path.
    pub const PLACES: [f64; 3] = [0.25, 0.5, 0.75];
    /// Number of samples of a bridge to find a singular position that is reached twice.
    pub const PLACES_BETWEEN: usize = 24;
    /// A determinant changes its sign, rather than touches zero, if it is below this part of its values at the ends.
    pub const BEYOND_ZERO: f64 = -1e-6;
    /// A more accurate curve decides where the determinant is below this part.
    pub const NEARLY_ZERO: f64 = 1e-2;
    /// Number of samples of an even contact to find its minimum.
    pub const LOOKS: usize = 80;
    /// Number of Newton steps to the minimum.
    pub const NEWTON_STEPS: usize = 8;
    /// Distance of the two points of a difference quotient, as a part of the bridge.
    pub const SPREAD: f64 = 0.08;
}

/// Refined curve of a bridge (`crates/engine/src/analysis/follow/crossing/refined_bridge.rs`).
pub mod finer {
    /// Distance of the outer states from the ends of the bridge, as a part of its length.
    pub const OUTWARD: f64 = 0.7;
    /// Number of steps to an outer state.
    pub const STEPS: usize = 8;
    /// Accuracy of the velocities and accelerations of the curve where they can be solved for, relative to their size or 1, scaled.
    pub const EXACT: f64 = 2e-9;
}

/// Existence of positions all along a bridge (`crates/engine/src/analysis/follow/crossing/end_of_reach.rs`).
pub mod reach {
    /// Maximum number of corrections of a position near the curve.
    pub const CORRECTIONS: usize = 60;
    /// Largest ratio of a correction to the previous one.
    pub const CONTRACTS: f64 = 0.7;
    /// A smaller correction, scaled, does not affect λ.
    pub const SETTLED: f64 = 1e-13;
    /// A correction that no longer shrinks is rounding if it is below this many times the rounding.
    pub const ROUNDING: f64 = 1e3;
    /// Number of times within the bridge at which the direction of the free motion is evaluated.
    pub const SAMPLES: usize = 9;
    /// Number of parabolas that search for an extremum in time near the singular position.
    pub const PARABOLAS_IN_TIME: usize = 2;
    /// Number of parabolas that search for an extremum along the free motion.
    pub const PARABOLAS: usize = 3;
    /// Width of each parabola, as a part of the previous one.
    pub const NARROWER: f64 = 0.05;
    /// Rows take part in a dependency from this part of the largest share on.
    pub const TAKES_PART: f64 = 0.1;
    /// Values within this many times the residual tolerance are not distinguished from zero.
    pub const MARGIN: f64 = 4.0;
}

/// Change points that are just missed (`crates/engine/src/analysis/follow/near_misses.rs`).
pub mod misses {
    /// Distance from a change point, as a part of the lengths, within which it is reported: drawings are rounded so.
    pub const WITHIN: f64 = 5e-4;
    /// Error of the lengths, as a part of the square of the driver's motion in which the mechanism turns away.
    pub const OF_LENGTHS: f64 = 1.0 / 3.0;
    /// A position farther from a singular one than this is far away.
    pub const FAR: f64 = 0.1;
    /// Largest least singular value, as a part of the largest one before: some mechanisms are never far away.
    pub const FALLS: f64 = 0.4;
    /// Largest relative change of the speed of drivers meanwhile.
    pub const EVEN: f64 = 0.3;
}
