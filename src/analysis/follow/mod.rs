//! From the first time on: steps along the branch that the start chose, and what they go over.

mod bridge;
mod doubt;
mod edges;
mod finer;
mod lead;
mod limits;
mod march;
mod reach;
mod rims;
mod rows;
mod signals;
mod stretches;
mod touch;

pub use lead::{LeadOptions, Way, lead};
pub use march::{Motion, along, quintic};
pub use rows::state_of_row;
pub use stretches::Stretch;
