//! Sweeps: many variants of one mechanism, which differ only in the values of its parameters. The mechanism is lowered, proven and compiled
//! once, with the parameters as symbols; each variant is continued from the nominal values, those of the text, to its own.

mod batch;
mod block;
mod column_buffer;
mod continuation;
mod points;
mod sobol;

pub use batch::{BatchContext, BatchRequest, BatchRunner, LANES};
pub use block::{Status, Swept, SweptColumn, VariantOutcome};
pub use column_buffer::{BufferPool, Numbers};
pub use continuation::ContinuedVariant;
pub use points::{Levels, MAX_SOBOL_DIMENSIONS, Method, Points, Sampling, Varying};

// the names by which other crates use these
pub use batch::{CHUNK, PerLane, RowBuffer};
pub use continuation::{CompiledSystem, ContinuationBase, ContinuationError};
pub use points::{linspace_value, round_to_15_digits};
