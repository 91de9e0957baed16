//! Solving for a row.

/// Orders of elimination (`crates/engine/src/solver/order.rs`).
pub mod order {
    /// A pivot is at least this part of the largest entry in its column, where it is chosen.
    pub const THRESHOLD: f64 = 0.25;
    /// What stands for a pivot that vanishes.
    pub const LEAST_PIVOT: f64 = 1e-18;
    /// Rows among which a pivot is looked for.
    pub const CANDIDATES: usize = 4;
}

/// Coordinates that Newton solves for (`crates/engine/src/solver/tear.rs`).
pub mod tear {
    /// Rows in which a tear is looked for.
    pub const CANDIDATES: usize = 64;
}

/// The grid of tears (`crates/engine/src/solver/build.rs`).
pub mod build {
    /// The cell of a grid is this part of what a coordinate is judged against. The half of its square is below rounding.
    pub const CELL: f64 = 1.0 / 134_217_728.0;
    /// Within a cell that is no wider the sine is a parabola, to rounding.
    pub const WIDEST_CELL: f64 = 8.0 * CELL;
}

/// Multipliers, and how large a solver may be (`solver`).
pub mod solver {
    /// A scaled multiplier of an elimination beyond this loses digits.
    pub const LARGEST_MULTIPLIER: f64 = 16.0;
    /// A system whose elimination takes more operations than this is not laid out.
    pub const MOST_OPERATIONS: usize = 30_000_000;
}

/// Newton in lanes (`crates/engine/src/solver/lanes.rs`).
pub mod lanes {
    /// Iterations of a block at most, two of which may be at a border of two cells.
    pub const ITERATIONS: usize = 8;
    /// Largest first correction, scaled: the curve of a step is nearer than this.
    pub const LARGEST_CORRECTION: f64 = 0.05;
    /// A correction that is no farther from half a cell than this, in cells, leads to the border of two. What rounding makes of corrections
    /// is less.
    pub const BORDER: f64 = 1.0 / 4_096.0;
    /// Rows of so many numbers at the most are turned from columns: more would not stay in the processor's memory until then.
    pub const MOST_TURNED: usize = 2_048;
}

/// Variants side by side (`crates/engine/src/solver/variants.rs`, `sweep`).
pub mod variants {
    /// A multiplier up to this part of the largest is small enough, wherever Newton begins.
    pub const CERTAIN_MULTIPLIER: f64 = 0.99;
    /// What may be left of an equation, beside what may be left of it where a variant goes alone: rounding leaves less by orders of magnitude.
    pub const CERTAIN_RESIDUAL: f64 = 1e-3;
    /// Between output times Newton ends with corrections of so many cells: what is left then is the square of that, far less than guesses are
    /// off.
    pub const NEARLY: f64 = 8_192.0;
    /// What may be left of an equation then, beside what may be left of it where a variant goes alone.
    pub const RESIDUAL_OF_STEP: f64 = 1e4;
    /// A variant nearer to a singular position than this goes alone: so far off no row is in doubt, and no step is looked into.
    pub const NEAREST: f64 = 0.04;
    /// A first correction is at most this part of the distance to a singular position: other branches are farther away.
    pub const PART_OF_DISTANCE: f64 = 0.25;
    /// Largest motion of a step, scaled.
    pub const LARGEST_MOTION: f64 = 0.5;
    /// How far velocities and accelerations at both ends of a step may lead elsewhere than positions, scaled.
    pub const LARGEST_GAP: f64 = 1e-3;
    /// A determinant grows or falls within a step by no more than this factor.
    pub const LARGEST_CHANGE: f64 = 2.0;
    /// Steps over the whole span at least.
    pub const FEWEST_STEPS: f64 = 16.0;
    /// Rows are dense, by whose velocities alone steps are led on and judged, that are no farther apart than this part of the span.
    pub const DENSE_PART_OF_SPAN: f64 = 1.0 / 64.0;
    /// Between them nothing moves by more than this at the start, scaled.
    pub const DENSE_MOTION: f64 = 0.04;
    /// Steps are of one length that differ by no more than this part.
    pub const ALIKE: f64 = 1e-9;
    /// How far parameters are changed, as a part of themselves, to learn how the mechanism moves with them.
    pub const BESIDE: f64 = 1e-6;
    /// How often one variant may ask all that go with it for shorter steps.
    pub const PATIENCE: u32 = 16;
    /// Behind a step that was refused so many are taken before longer ones are tried.
    pub const CALM_STEPS: u32 = 6;
    /// The way to a variant's parameters is tried in so many parts.
    pub const PARTS_OF_WAY: [u32; 6] = [1, 2, 4, 8, 16, 32];
}

/// The course of a formula of a variant (`crates/engine/src/analysis/results/course.rs`, `crates/engine/src/sweep/batch/step_history.rs`, `crates/engine/src/sweep/batch/result_finder.rs`).
pub mod course {
    /// How much farther than the quintic in the middle of a cell a second derivative may be from the straight line between its ends: so much as
    /// results of a variant alone allow of a half of a cell.
    pub const SAFETY: f64 = 6.0;
    /// An extremum is beyond doubt the largest one, if all others are below it by this part of the range.
    pub const MARGIN: f64 = 1e-5;
    /// An end is an extremum, if the slope there would change the formula over the analysis by this part of its range.
    pub const STEEP: f64 = 1e-3;
    /// A turn is no nearer to an end than this part of the span.
    pub const AWAY: f64 = 1e-4;
    /// The size of the numbers that a value is a sum of is no more than so many times the range, or what the second derivative makes of the span:
    /// else rounding moves the time of an extremum.
    pub const CERTAIN: f64 = 250.0;
    /// A formula rests, if all along its course it is no farther from where it begins than this part of the size of these numbers: a quarter of what
    /// is the same alone (`results::probe::ROUNDING`).
    pub const RESTS: f64 = 0.25 * crate::tolerances::results::probe::ROUNDING;
    /// Corrections of a time on the curve between two steps.
    pub const ITERATIONS: usize = 3;
    /// A length is smooth along steps of which so many at least are between it and zero, as fast as what it is the length of goes.
    pub const STEPS_TO_KINK: f64 = 2.0;
    /// Steps over the whole span at least, where lengths are asked for.
    pub const FEWEST_STEPS_OF_LENGTHS: f64 = 64.0;
    /// How the size of these numbers is looked at: in so many ways.
    pub const WAYS: usize = 3;
    /// At every one of so many steps.
    pub const EVERY: usize = 4;
    /// What the steps tell of an integral differs from it by no more than this part, far less than is allowed alone
    /// (`results::spectral::ALIKE`): a variant that is settled so is settled alone too.
    pub const ALIKE: f64 = 1e-4;
    /// Steps at the most.
    pub const MOST_STEPS: usize = 4_096;
}

/// Blocks that are pivoted (`crates/engine/src/solver/pivoting.rs`).
pub mod pivoting {
    /// Larger blocks are not solved this way.
    pub const LARGEST_BLOCK: usize = 100;
}

/// Output times, solved for together (`crates/engine/src/analysis/follow/rows/leap.rs`).
pub mod rows {
    /// Times that are solved at once.
    pub const LANES: usize = 16;
    /// A solver of fewer operations is not worth a thread of its own.
    #[cfg(feature = "threads")]
    pub const WORTH_A_THREAD: usize = 20_000;
    /// Threads at most.
    #[cfg(feature = "threads")]
    pub const MOST_THREADS: usize = 8;
    /// A step below this part of the span is short.
    pub const SHORT: f64 = 1e-4;
    /// Two times are the same that differ by no more than this part of the step.
    pub const SAME_TIME: f64 = 1e-9;
    /// So many rows within a step show what its curve is worth.
    pub const ENOUGH: u64 = 4;
    /// A row that is solved for once more may change by so much, beside its size or 1.
    pub const REFINED: f64 = 1e-8;
    /// Steps that are tried behind a row that cannot be printed, to tell why.
    pub const STEPS_AHEAD: usize = 1_000;
}

/// Rows that are in doubt (`crates/engine/src/analysis/state/trust.rs`).
pub mod trust {
    /// Where a row is printed, what rounding makes of it must stay below the accuracy promised.
    pub const ACCURACY: f64 = 1e-9;
    /// A velocity is in doubt if it may be off by more than this, beside its size or 1.
    pub const VELOCITY: f64 = 1e-8;
    /// An acceleration likewise.
    pub const ACCELERATION: f64 = 4e-7;
    /// What is slow counts for no less than this part of the motion's fastest: rounding grows with that.
    pub const SLOW: f64 = 1.0 / 64.0;
    /// Farther from a singular position than this rounding does not come so far.
    pub const FAR: f64 = 1.5e-3;
}

/// Rows solved for again, for they are in doubt (`crates/engine/src/analysis/follow/march/doubt.rs`).
pub mod doubt {
    /// A row is right if it differs from one that is exact by no more, beside its size or 1: in place, velocity and acceleration.
    pub const RIGHT: [f64; 3] = [1e-9, 1e-8, 1e-6];
    /// A row is solved for again from so many places.
    pub const PLACES: usize = 16;
    /// How far they are from each other, scaled.
    pub const CELL: f64 = super::build::CELL;
    /// A correction of a place on the way over a singular position is at most this part of the distance from that, scaled.
    pub const NEAREST_BRANCH: f64 = 0.05;
}
