//! From the first time on: steps along the branch that the start chose, and what they go over.
//!
//! ```text
//!            ┌── Step       the state, the one that is tried, the way between
//! Motion ────┼── Edges      what may happen between the ends of a step
//!            ├── Crossing   the way over a singular position
//!            ├── Choice     which equations are solved, where there are more than are needed
//!            └── Rows       which row comes next, and what it is worth
//! ```
//!
//! Each owner's fields are its own; what it needs of others is an argument. `Follower` puts them in order.

mod bookmark;
mod choice;
mod crossing;
mod edges;
mod lead;
mod march;
mod misses;
mod remarks;
mod rows;
mod start;
mod step;

pub use choice::Chosen;
pub use lead::{LeadOptions, Way, before_ways, lead_again};
pub use march::{Follower, Stretch};
pub use rows::{Alone, state_of_row};
pub use start::{follow_to, lead, start, start_from};
pub use step::quintic_between;
