//! Every limit of the mathematics: what it means, in what unit, how large it is. Emitted code has the same ones.
//!
//! `docs/limits.md` is generated from these files. "Scaled" means: lengths in sizes of their body, angles in radians, rows of `Φ` divided by their norm. A "span" is the
//! time from the first to the last output time.
//!
//! A file for each part of the mathematics; in it a module for each file that has limits of its own.

pub mod assembly;
pub mod determinacy;
pub mod emitted;
pub mod results;
pub mod scales;
pub mod singular;
pub mod solving;
pub mod steps;

/// Bounds each row of Φ unless told otherwise, scaled.
pub const TOLERANCE: f64 = 1e-12;

/// For how long a mechanism is looked at where nobody says it (s); and what steps and speeds are measured by where all happens in no time.
pub const UNTOLD_SPAN: f64 = 1.0;

/// What jumps, where both sides of a time differ.
pub mod jumps {
    /// A position that changes by more than this, scaled, jumps.
    pub const POSITION_JUMP: f64 = 1e-9;
    /// A velocity that changes by more than this part of the fastest, scaled, jumps.
    pub const VELOCITY_JUMP: f64 = 1e-7;
    /// An acceleration likewise.
    pub const ACCELERATION_JUMP: f64 = 1e-6;
    /// A speed below this part of one per span, scaled, is rest.
    pub const REST: f64 = 1e-3;
    /// What a load's condition is off by no more than it changes in this part of the span, it is not off by: it jumps here.
    pub const LATER_AT_ONCE: f64 = 1e-12;
    /// Likewise where it comes to rest there, by what its rate changes by in this part of the span.
    pub const LATER_AT_REST: f64 = 1e-8;
    /// What is below this part of what coordinates and their rates would make of it, if each were as fast as everything, is rounding.
    pub const LATER_ROUNDING: f64 = 1e-12;
}

/// Contacts, and what they press with.
pub mod contacts {
    /// A profile is closed where the square of the way between its ends is no more than this part of twice its area.
    pub const CLOSED: f64 = 1e-12;
    /// Places on a profile that tell which way round it goes.
    pub const PLACES: u32 = 90;
    /// A contact pulls where it does so with more than this part of the largest force of the row: less is rounding.
    pub const PULLS: f64 = 1e-9;
    /// Between rows a step is looked at in parts no wider than this one of it,
    pub const WIDEST_BETWEEN: f64 = 0.125;
    /// and in smaller ones where a load may leave the values at both ends of a part by more than this part of the largest that was met,
    pub const STRIKES: f64 = 0.05;
    /// but none smaller than this,
    pub const FINEST_BETWEEN: f64 = 1.0 / 256.0;
    /// and in so many at most.
    pub const MOST_BETWEEN: usize = 128;
    /// Corrections of a place on the curve of a step.
    pub const CORRECTIONS: usize = 2;
}

/// Loads.
pub mod loads {
    /// A distance between two bodies that is no longer than this part of the larger of them has no direction: rounding would choose it.
    pub const AIMLESS: f64 = 1e-6;
}

/// Equations that were left out, as they follow from the others.
pub mod checks {
    /// One may be open by so many times its scale: lengths are written with so many digits.
    pub const LARGEST_OPENING: f64 = 1e-9;
    /// One may miss by this beside how much everything changes with an input or a parameter, scaled: rounding.
    pub const MISSES: f64 = 1e-8;
}
