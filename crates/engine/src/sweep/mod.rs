//! Sweeps: many variants of one mechanism, which differ only in the values of its parameters. The mechanism is lowered, proven and compiled
//! once, with the parameters as symbols; each variant is continued from the nominal values, those of the text, to its own.

mod batch;
mod block;
mod column_buffer;
mod continuation;
mod points;
mod sobol;

pub use batch::{LANES, Team, Together, WantedOfEach};
pub use block::{OneVariant, Status, Swept, SweptColumn};
pub use column_buffer::{Numbers, Spare};
pub use continuation::Arrived;
pub use points::{Levels, MOST_OF_SOBOL, Method, Points, Sampling, Varying};

// the names by which other crates use these
pub use batch::{CHUNK as PART, PerLane as Each, RowBuffer as Room};
pub use continuation::{CompiledSystem as Whole, ContinuationBase as Base, ContinuationError as Lost};
pub use points::{linspace_value as evenly, round_to_15_digits as rounded};
