//! Explanations why a mechanism is not determined, cannot be assembled, or does not go on: found from values, and put into words.

mod determine;
pub mod errors;
mod evaluator;
mod free_motion;
mod freedom;
pub mod open_loop;
mod orthonormal;
mod proposals;
mod redundancy;
mod sharing;
pub mod singular;
mod stop;

pub use determine::{determine, free_motions};
pub use freedom::FreeMotion;
pub use open_loop::{FaultyLink, FaultyLinkKind, OpenLoop};
pub use stop::{SingularPosition, Stop, StopCause, Warning, WarningCause};
