//! Solution for one row of results.

/// Orders of elimination (`crates/engine/src/solver/order.rs`).
pub mod order {
    /// Smallest pivot when it is chosen, as a part of the largest entry in its column.
    pub const THRESHOLD: f64 = 0.25;
    /// Replacement for a pivot that vanishes.
    pub const LEAST_PIVOT: f64 = 1e-18;
    /// Number of rows among which a pivot is chosen.
    pub const CANDIDATES: usize = 4;
}

/// Coordinates that Newton's method solves for (`crates/engine/src/solver/tear.rs`).
pub mod tear {
    /// Number of rows among which a tear is chosen.
    pub const CANDIDATES: usize = 64;
}

/// Grid of tears (`crates/engine/src/solver/build.rs`).
pub mod build {
    /// Cell of the grid, as a part of the scale of a coordinate. Half of its square is below rounding.
    pub const CELL: f64 = 1.0 / 134_217_728.0;
    /// Widest cell within which the sine is a parabola up to rounding.
    pub const WIDEST_CELL: f64 = 8.0 * CELL;
}

/// Multipliers, and the size of a solver (`solver`).
pub mod solver {
    /// Largest scaled multiplier of an elimination; larger ones lose digits.
    pub const LARGEST_MULTIPLIER: f64 = 16.0;
    /// Maximum number of operations of an elimination that is compiled.
    pub const MOST_OPERATIONS: usize = 30_000_000;
}

/// Newton's method in lanes (`crates/engine/src/solver/lanes.rs`).
pub mod lanes {
    /// Maximum number of iterations of a block, two of which may be at a border of two cells.
    pub const ITERATIONS: usize = 8;
    /// Largest first correction, scaled: the dense output of a step is closer than this.
    pub const LARGEST_CORRECTION: f64 = 0.05;
    /// A correction within this distance of half a cell, in cells, leads to a border of two cells. The rounding of corrections is smaller.
    pub const BORDER: f64 = 1.0 / 4_096.0;
    /// Largest number of values per row that is transposed from columns: more would not stay in the cache.
    pub const MOST_TURNED: usize = 2_048;
}

/// Batches of variants (`crates/engine/src/solver/variants.rs`, `sweep`).
pub mod variants {
    /// A multiplier up to this part of the largest one is accepted for any start of Newton's method.
    pub const CERTAIN_MULTIPLIER: f64 = 0.99;
    /// Largest residual, relative to that of a variant on its own: rounding leaves orders of magnitude less.
    pub const CERTAIN_RESIDUAL: f64 = 1e-3;
    /// Largest last correction between output times, in cells: the remaining error is its square, far below the error of guesses.
    pub const NEARLY: f64 = 8_192.0;
    /// Largest residual between output times, relative to that of a variant on its own.
    pub const RESIDUAL_OF_STEP: f64 = 1e4;
    /// A variant closer to a singular position than this leaves the batch: at this distance no row is in doubt, and no step is examined inside.
    pub const NEAREST: f64 = 0.04;
    /// Largest first correction, as a part of the distance to a singular position: other branches are farther away.
    pub const PART_OF_DISTANCE: f64 = 0.25;
    /// Largest motion in a step, scaled.
    pub const LARGEST_MOTION: f64 = 0.5;
    /// Largest deviation of velocities and accelerations at both ends of a step from the change of positions, scaled.
    pub const LARGEST_GAP: f64 = 1e-3;
    /// Largest factor by which a determinant changes in a step.
    pub const LARGEST_CHANGE: f64 = 2.0;
    /// Minimum number of steps over the span.
    pub const FEWEST_STEPS: f64 = 16.0;
    /// Largest distance of dense rows, as a part of the span; their velocities alone extrapolate and judge steps.
    pub const DENSE_PART_OF_SPAN: f64 = 1.0 / 64.0;
    /// Largest motion between dense rows at the start, scaled.
    pub const DENSE_MOTION: f64 = 0.04;
    /// Relative difference up to which steps have the same length.
    pub const ALIKE: f64 = 1e-9;
    /// Relative change of parameters for difference quotients of the mechanism's position.
    pub const BESIDE: f64 = 1e-6;
    /// Maximum number of times that one variant may shorten the steps of its batch.
    pub const PATIENCE: u32 = 16;
    /// Number of steps after a rejected one before longer ones are tried.
    pub const CALM_STEPS: u32 = 6;
    /// Numbers of continuation steps to a variant's parameters, tried in turn.
    pub const PARTS_OF_WAY: [u32; 6] = [1, 2, 4, 8, 16, 32];
}

/// Extrema and integrals of a formula for a variant (`crates/engine/src/analysis/results/course.rs`, `crates/engine/src/sweep/batch/step_history.rs`,
/// `crates/engine/src/sweep/batch/result_finder.rs`).
pub mod course {
    /// Factor by which a second derivative may deviate from the straight line between its ends, relative to the quintic in the middle of a
    /// cell: as much as results of a single variant allow for half a cell.
    pub const SAFETY: f64 = 6.0;
    /// The largest extremum is unambiguous if all others are below it by this part of the range.
    pub const MARGIN: f64 = 1e-5;
    /// An end is an extremum if the slope there would change the formula over the analysis by this part of its range.
    pub const STEEP: f64 = 1e-3;
    /// Smallest distance of an extremum from an end, as a part of the span.
    pub const AWAY: f64 = 1e-4;
    /// Largest terms of a sum, in multiples of its range or of what the second derivative causes over the span: beyond it rounding shifts
    /// the time of an extremum.
    pub const CERTAIN: f64 = 250.0;
    /// A formula is at rest if it deviates from its start by at most this part of the size of its terms: a quarter of the bound for a
    /// single variant (`results::probe::ROUNDING`).
    pub const RESTS: f64 = 0.25 * crate::tolerances::results::probe::ROUNDING;
    /// Number of corrections of a time on the curve between two steps.
    pub const ITERATIONS: usize = 3;
    /// A length is smooth along steps if at least this many of them, at its greatest speed, separate it from zero.
    pub const STEPS_TO_KINK: f64 = 2.0;
    /// Minimum number of steps over the span if formulas contain lengths.
    pub const FEWEST_STEPS_OF_LENGTHS: f64 = 64.0;
    /// Number of ways in which the size of terms is estimated.
    pub const WAYS: usize = 3;
    /// The size of terms is estimated at every this many steps.
    pub const EVERY: usize = 4;
    /// Largest difference of an integral from its estimate by the steps, as a part of it; far less than a single variant allows
    /// (`results::spectral::ALIKE`), so that a variant accepted here is accepted there.
    pub const ALIKE: f64 = 1e-4;
    /// Maximum number of steps.
    pub const MOST_STEPS: usize = 4_096;
}

/// Blocks with pivoting (`crates/engine/src/solver/pivoting.rs`).
pub mod pivoting {
    /// Largest block that is solved with pivoting.
    pub const LARGEST_BLOCK: usize = 100;
}

/// Output times that are solved together (`crates/engine/src/analysis/follow/rows/row_batch.rs`).
pub mod rows {
    /// Number of times in a batch.
    pub const LANES: usize = 16;
    /// Smallest number of operations of a solver that is worth a thread.
    #[cfg(feature = "threads")]
    pub const WORTH_A_THREAD: usize = 20_000;
    /// Maximum number of threads.
    #[cfg(feature = "threads")]
    pub const MOST_THREADS: usize = 8;
    /// A step below this part of the span is short.
    pub const SHORT: f64 = 1e-4;
    /// Times that differ by at most this part of the step are equal.
    pub const SAME_TIME: f64 = 1e-9;
    /// Number of rows within a step that show the accuracy of its dense output.
    pub const ENOUGH: u64 = 4;
    /// Largest change of a row that is solved again, relative to its size or 1.
    pub const REFINED: f64 = 1e-8;
    /// Number of steps behind a row that cannot be printed, to explain why.
    pub const STEPS_AHEAD: usize = 1_000;
}

/// Rows that may be inaccurate (`crates/engine/src/analysis/state/error_bound.rs`).
pub mod trust {
    /// Largest rounding of a printed row: the promised accuracy.
    pub const ACCURACY: f64 = 1e-9;
    /// A velocity is in doubt if its error may exceed this, relative to its size or 1.
    pub const VELOCITY: f64 = 1e-8;
    /// An acceleration is in doubt if its error may exceed this, relative to its size or 1.
    pub const ACCELERATION: f64 = 4e-7;
    /// Slow motions count as at least this part of the fastest one, with which rounding grows.
    pub const SLOW: f64 = 1.0 / 64.0;
    /// Distance from a singular position beyond which rounding stays small.
    pub const FAR: f64 = 1.5e-3;
}

/// Ill-conditioned rows that are solved again (`crates/engine/src/analysis/follow/follower/ill_conditioned_rows.rs`).
pub mod doubt {
    /// Largest deviation of a row from an exact one, relative to its size or 1: in position, velocity and acceleration.
    pub const RIGHT: [f64; 3] = [1e-9, 1e-8, 1e-6];
    /// Number of starts from which a row is solved again.
    pub const PLACES: usize = 16;
    /// Distance between these starts, scaled.
    pub const CELL: f64 = super::build::CELL;
    /// Largest correction of a position on a bridge, as a part of its distance from the singular position, scaled.
    pub const NEAREST_BRANCH: f64 = 0.05;
}
