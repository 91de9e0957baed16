//! Mathematics that emitted code includes verbatim: each file refers to nothing but the neighbouring files that it names.

#![no_std]

/// Sparse linear equations that fall apart into blocks.
pub mod blocks;
/// The grid on which Newton's iteration ends.
pub mod grid;
/// The quintic between two states.
pub mod hermite;
/// Searches that end at neighbouring doubles.
pub mod neighbours;
/// Sine and cosine with the same bits on every platform.
pub mod sine_and_cosine;
/// Sine and cosine for loops over many angles.
pub mod without_branches;

/// Texts of these files, for inclusion in emitted code.
pub mod sources {
    /// Sparse linear equations in blocks.
    pub const BLOCKS: &str = include_str!("blocks.rs");
    /// The grid of Newton's iterates.
    pub const GRID: &str = include_str!("grid.rs");
    /// The quintic between two states.
    pub const HERMITE: &str = include_str!("hermite.rs");
    /// Searches that end at neighbouring doubles.
    pub const NEIGHBOURS: &str = include_str!("neighbours.rs");
    /// Sine and cosine.
    pub const SINE_AND_COSINE: &str = include_str!("sine_and_cosine.rs");
    /// Sine and cosine without branches, for loops over many angles.
    pub const WITHOUT_BRANCHES: &str = include_str!("without_branches.rs");
}
