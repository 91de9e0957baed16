//! Scales, and the distance to a singular position.

/// Sizes of bodies (`crates/lang/src/lower/size.rs`).
pub mod size {
    /// Frames with more points than this are measured by their bounding box, to stay linear.
    pub const MANY_POINTS: usize = 500;
    /// A size that features say which no equation uses counts if it is that of the others to such a factor.
    pub const IN_PROPORTION: f64 = 10.0;
    /// A frame is far from a body that is so many of the body's sizes away.
    pub const FAR_FRAME: f64 = 10.0;
    /// What is no longer than this (m) has no size.
    pub const SMALLEST: f64 = 1e-12;
    /// So many places stand for a whole curve.
    pub const PLACES_ON_CURVE: u32 = 16;
}

/// Nearness to a singular position, and orders of elimination (`crates/engine/src/analysis/state/linear`).
pub mod linear {
    /// A block whose smallest pivot is so many times a limit has no singular value below it: pivots of rows of unit norm
    /// overestimate it by little.
    pub const PIVOT_MARGIN: f64 = 100.0;
    /// A position whose pivots are all so many times a limit is farther from a singular one than that.
    pub const CLEAR_PIVOT: f64 = 10.0;
    /// A block with a pivot below this, scaled, is singular.
    pub const SMALLEST_PIVOT: f64 = 1e-14;
    /// What the scales that are solved with say of nearness holds as far as it is to such a factor what the yardstick says.
    pub const ALIKE: f64 = 10.0;
    /// Coordinates of a block that is no chain yet.
    pub const A_FEW: f64 = 24.0;
    /// Larger blocks are never factored densely.
    pub const LARGEST_DENSE: usize = 100;
    /// Orders of elimination to choose from, so that there is one for most of a motion.
    pub const PLANS: u32 = 4;
}

/// The second set of scales (`crates/engine/src/analysis/state/yardstick.rs`).
pub mod yardstick {
    /// Sweeps over rows and columns: what is left after them is a factor that does not matter.
    pub const SWEEPS: usize = 12;
    /// The norm that rows come to: that of a joint's equation in the coordinates of one of its bodies, the other being given.
    pub const ROW_NORM: f64 = 0.5;
    /// A centroid counts where it is so many times as far from the origin of the frame as features are from it.
    pub const FAR_FRAME: f64 = 4.0;
    /// The least lever of an axis, along which another body may come as near to this one's features as it likes, in sizes of the
    /// smaller of both.
    pub const LEAST_LEVER: f64 = 0.1;
    /// A moment about a centroid that is less than this part of its terms is what rounding leaves.
    pub const ROUNDING: f64 = 1e-10;
}

/// Residuals, and rows that are bent (`crates/engine/src/analysis/state/kinematics`).
pub mod kinematics {
    /// What rounding makes of a term.
    pub const ROUNDING: f64 = 8.0 * f64::EPSILON;
    /// What a row's slope changes it by, over the size of a coordinate, is rounding where it is no more than this part of its largest term: a
    /// slope's own terms may be larger than those.
    pub const NO_SLOPE: f64 = 256.0 * f64::EPSILON;
    /// Nearer to a singular position than this, derivatives by inputs and parameters are not computed: they grow there, and each order makes
    /// more of the rounding.
    pub const TRUSTED: f64 = 1e-3;
    /// How far beside a position the slope of a row that is bent is looked at, scaled.
    pub const BESIDE: f64 = 0.1;
}
