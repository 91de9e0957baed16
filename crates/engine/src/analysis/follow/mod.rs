//! Following of a motion from the first time on: steps along the branch that the start chose, and what they cross.
//!
//! ```text
//!            ┌── Step       the state, the one that is tried, the way between
//! Motion ────┼── Edges      what may happen between the ends of a step
//!            ├── Crossing   the way over a singular position
//!            ├── RowSelection     which equations are solved, where there are more than are needed
//!            └── Rows       which row comes next, and its accuracy
//! ```
//!
//! Each owner's fields are its own; what it needs of others is an argument. `Follower` puts them in order.

mod checkpoint;
mod continuation;
mod crossing;
mod edges;
mod follower;
mod near_misses;
mod row_selection;
mod rows;
mod start;
mod step;
mod warnings;

pub use continuation::{ContinuationOptions, PathOutcome, continue_from, start_of_paths};
pub use follower::{Follower, SmoothSegment};
pub use row_selection::SelectedRows;
pub use rows::{SingleRow, state_of_row};
pub use start::{follow_to, lead, start, start_from};
pub use step::quintic_between;
