//! Sweeps: many variants of one mechanism, which differ only in the values of its parameters. The mechanism is lowered, proven and compiled
//! once, with the parameters as symbols; each variant is continued from the nominal values, those of the text, to its own.

mod batch;
mod block;
mod column_buffer;
mod continuation;
mod points;
mod sobol;

pub use batch::{CHUNK as PART, LANES, PerLane as Each, RowBuffer as Room, Team, Together, WantedOfEach};
pub use block::{OneVariant, Status, Swept, SweptColumn};
pub use column_buffer::{Numbers, Spare};
pub use continuation::{Arrived, Base, CompiledSystem as Whole, Lost};
pub use points::{Levels, MOST_OF_SOBOL, Method, Points, Sampling, Varying, evenly, rounded};
