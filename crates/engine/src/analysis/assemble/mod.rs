//! Assembly: the position at the first time, found from estimates and proven not to be singular, with doubts where it may not be the intended one.

mod assembly;
mod branches;
mod errors;
mod parts;
mod search;
mod started;

pub use assembly::{Moved, close_without_drivers, driver_residuals};
pub use branches::Doubt;
pub use parts::{Request, with_parts};
pub use started::{Solving, Started, Unassembled};
