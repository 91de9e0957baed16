//! Many variants of one mechanism: which there are, and what became of them.

mod block;
mod points;
mod sobol;

pub use block::{Block, Status, Variant};
pub use points::{Axis, MOST_OF_SOBOL, Method, Points, Sample, Values};
