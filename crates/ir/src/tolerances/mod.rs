//! Limits of the mathematics, each with its meaning, unit and value. Emitted code uses the same limits.
//!
//! `docs/limits.md` is generated from these files. "Scaled" means lengths in sizes of their body, angles in radians, rows of `Φ` divided by
//! their norm. A "span" is the time from the first to the last output time.
//!
//! There is one file for each part of the mathematics, and in it a module for each source file with limits of its own.

pub mod assembly;
pub mod determinacy;
pub mod emitted;
pub mod results;
pub mod scales;
pub mod singular;
pub mod solving;
pub mod steps;

/// Default bound of each row of Φ, scaled.
pub const TOLERANCE: f64 = 1e-12;

/// Default span (s): examined if no analysis is given, and the unit of steps and speeds if the span is 0.
pub const DEFAULT_SPAN: f64 = 1.0;

/// Jumps: differences between both sides of a time.
pub mod jumps {
    /// A position jumps if it changes by more than this, scaled.
    pub const POSITION_JUMP: f64 = 1e-9;
    /// A velocity jumps if it changes by more than this part of the fastest, scaled.
    pub const VELOCITY_JUMP: f64 = 1e-7;
    /// An acceleration jumps if it changes by more than this part of the largest, scaled.
    pub const ACCELERATION_JUMP: f64 = 1e-6;
    /// A speed below this, per span and scaled, is rest.
    pub const REST: f64 = 1e-3;
    /// The condition of a load is zero if its change over this part of the span exceeds its value: the load jumps here.
    pub const LATER_AT_ONCE: f64 = 1e-12;
    /// The condition of a load is zero where it comes to rest if the change of its rate over this part of the span exceeds the rate.
    pub const LATER_AT_REST: f64 = 1e-8;
    /// A value is rounding if it is below this part of what it would be with all coordinates and rates at their largest.
    pub const LATER_ROUNDING: f64 = 1e-12;
}

/// Contacts and their forces.
pub mod contacts {
    /// A profile is closed if the squared distance of its ends is at most this part of twice its area.
    pub const CLOSED: f64 = 1e-12;
    /// Samples of a profile that determine its orientation.
    pub const PLACES: u32 = 90;
    /// A contact pulls if its force exceeds this part of the largest force of the row; less is rounding.
    pub const PULLS: f64 = 1e-9;
    /// Widest part of a step that is examined for contact forces, as a part of the step.
    pub const WIDEST_BETWEEN: f64 = 0.125;
    /// Parts are halved where a load may exceed its values at both ends by more than this part of the largest value so far.
    pub const STRIKES: f64 = 0.05;
    /// Smallest part, as a part of the step.
    pub const FINEST_BETWEEN: f64 = 1.0 / 256.0;
    /// Maximum number of parts of a step.
    pub const MOST_BETWEEN: usize = 128;
    /// Corrections of a position on the curve of a step.
    pub const CORRECTIONS: usize = 2;
}

/// Loads.
pub mod loads {
    /// A distance between two bodies up to this part of the larger body has no direction: rounding would determine it.
    pub const AIMLESS: f64 = 1e-6;
}

/// Redundant equations that are left out.
pub mod checks {
    /// Largest residual, in scales of the equation: lengths are written with so many digits.
    pub const LARGEST_OPENING: f64 = 1e-9;
    /// Largest change of the residual, as a part of all changes with an input or a parameter, scaled: rounding.
    pub const MISSES: f64 = 1e-8;
}
