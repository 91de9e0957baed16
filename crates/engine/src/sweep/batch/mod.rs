//! Batches: variants that are computed together, one in each lane. A batch takes only steps that are accepted beyond doubt; a variant with a
//! rejected step leaves the batch and is computed alone from its start, by the code that handles all cases.

mod acceptance;
mod context;
mod lane_program;
mod lane_signals;
mod path_signals;
mod result_finder;
mod result_queries;
mod row_collector;
mod runner;
mod step_history;
mod stepper;

pub use context::{BatchContext, BatchRequest};
pub use row_collector::RowBuffer;
pub use runner::BatchRunner;

use mechc_ir::program::LaneValues;

/// Largest last correction between output times, in cells of the grid of tears: the remaining error is its square, far below the error of guesses.
const NEARLY: f64 = 8_192.0;
/// A variant closer to a singular position than this leaves the batch: at this distance no row is in doubt, and no step is examined inside.
const NEAREST: f64 = 0.04;
/// Largest first correction, as a part of the distance to a singular position: other branches are farther away.
const PART_OF_DISTANCE: f64 = 0.25;
/// Minimum number of steps over the span.
const FEWEST_STEPS: f64 = 16.0;

/// The number of variants in a batch.
pub const LANES: usize = 32;

/// The number of lanes in a chunk; chunks without an active lane are skipped.
pub const CHUNK: usize = crate::solver::CHUNK;

/// A number for each variant of a batch.
pub type PerLane = LaneValues<LANES>;

/// Zero in each lane.
const ZERO: PerLane = LaneValues([0.0; LANES]);

/// Returns the number of leading chunks that hold all active lanes.
fn active_chunks(active: &[bool; LANES]) -> usize {
    active.iter().rposition(|&is_active| is_active).map_or(0, |last| last / CHUNK + 1)
}
