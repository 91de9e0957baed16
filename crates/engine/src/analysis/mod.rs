//! The kinematic analysis: assembly at the start, then position, velocity and acceleration along the branch that the
//! start chose.
//!
//! ```text
//! Determined ──start──▶ Started ──follow──▶ a row per output time, or why it cannot go on
//! ```
//!
//! Its modules, each of which names only those before it:
//!
//! | module | what it is for |
//! | --- | --- |
//! | `state` | one state: residuals, factors, derivatives, nearness to a singular position |
//! | `explain` | diagnostics: why a mechanism is not determined, not assembled, or does not go on |
//! | `assemble` | the position at the first time |
//! | `follow` | from there on, in steps that the solver chooses by its own error: output times only decide what is printed |
//! | `results` | numbers for the whole analysis |
//!
//! A row is handed out only if the residual of the full `Φ`, scaled, is below the tolerance there; equations that were solved for
//! a coordinate hold by that.

#![allow(clippy::unnecessary_box_returns)] // a stop travels boxed, as the error of results

mod assemble;
mod explain;
mod follow;
mod results;
mod state;

pub use crate::limits::TOLERANCE;
pub use assemble::{Moved, Request, Solving, Started, Unassembled, with_parts};
pub use explain::errors::length as length_in_words;
pub use explain::{
    FaultyLink, FaultyLinkKind, FreeMotion, OpenLoop, SingularPosition, Stop, StopCause, Warning, WarningCause,
    determine, free_motions,
};
pub use follow::{
    ContinuationOptions, Follower, PathOutcome, continue_from, follow_to, lead, start, start_from, start_of_paths,
};
pub use results::course;
pub use results::{
    Answers, Computed, MOST_LOOKS, ResultQuery, Sampled, Settled, Settling, SmoothFormula, SmoothFormulas,
    SpectralIntegral, Turning, moved, refused_results,
};
pub use state::{Horizon, SignalBounds, Times};
