//! Scales, and the distance to a singular position.

/// Sizes of bodies (`crates/lang/src/lower/size.rs`).
pub mod size {
    /// Frames with more points are measured by their bounding box, so that the time stays linear.
    pub const MANY_POINTS: usize = 500;
    /// Largest ratio of the size from features without equations to that from the others for which the former counts.
    pub const IN_PROPORTION: f64 = 10.0;
    /// Distance of a frame from its body, in sizes of the body, from which the frame is far away.
    pub const FAR_FRAME: f64 = 10.0;
    /// Smaller sizes (m) are zero.
    pub const SMALLEST: f64 = 1e-12;
    /// Samples that represent a whole curve.
    pub const PLACES_ON_CURVE: u32 = 16;
}

/// Distance to a singular position, and orders of elimination (`crates/engine/src/analysis/state/linear`).
pub mod linear {
    /// A block has no singular value below a limit if its smallest pivot is this many times the limit: pivots of rows of unit norm
    /// overestimate it by little.
    pub const PIVOT_MARGIN: f64 = 100.0;
    /// A position is farther from a singular one than a limit if all its pivots are this many times the limit.
    pub const CLEAR_PIVOT: f64 = 10.0;
    /// A block with a smaller pivot, scaled, is singular.
    pub const SMALLEST_PIVOT: f64 = 1e-14;
    /// Largest ratio between the distances to a singular position in the scales of the solver and in those of the equilibration for which
    /// the former are used.
    pub const ALIKE: f64 = 10.0;
    /// Number of coordinates of a block that is no chain yet.
    pub const A_FEW: f64 = 24.0;
    /// Largest block that is factored densely.
    pub const LARGEST_DENSE: usize = 100;
    /// Number of stored orders of elimination, so that one suits most of a motion.
    pub const PLANS: u32 = 4;
}

/// Equilibration: the second set of scales (`crates/engine/src/analysis/state/equilibration.rs`).
pub mod yardstick {
    /// Number of sweeps over rows and columns; the remaining factor is irrelevant.
    pub const SWEEPS: usize = 12;
    /// Norm of equilibrated rows: that of a joint's equation in the coordinates of one of its bodies, with the other body fixed.
    pub const ROW_NORM: f64 = 0.5;
    /// A centroid counts if it is this many times as far from the origin of the frame as the features are from it.
    pub const FAR_FRAME: f64 = 4.0;
    /// Smallest lever of an axis along which another body can approach the features of this one, in sizes of the smaller body.
    pub const LEAST_LEVER: f64 = 0.1;
    /// A moment about a centroid below this part of its terms is rounding.
    pub const ROUNDING: f64 = 1e-10;
}

/// Residuals, and slopes of curved rows (`crates/engine/src/analysis/state/kinematics`).
pub mod kinematics {
    /// Rounding of a term, as a part of it.
    pub const ROUNDING: f64 = 8.0 * f64::EPSILON;
    /// The slope of a row, times the size of a coordinate, is rounding up to this part of the row's largest term: the terms of the slope
    /// may be larger than those.
    pub const NO_SLOPE: f64 = 256.0 * f64::EPSILON;
    /// Closest distance to a singular position at which derivatives with respect to inputs and parameters are computed: they grow there,
    /// and each order amplifies rounding.
    pub const TRUSTED: f64 = 1e-3;
    /// Distance from a position at which the slope of a curved row is evaluated, scaled.
    pub const BESIDE: f64 = 0.1;
}
