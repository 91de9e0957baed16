//! Continuation (homotopy): a mechanism that is assembled with its nominal values is followed along a path to other values of its params
//! and inputs, so that it stays on its branch.
//!
//! Knows the model and its equations; the steps along a path are the engine's.

mod checked;
mod context;
mod messages;
mod nominal;
mod shared_paths;
mod starts;

pub(crate) use context::{ContinuedStart, Outcome, PathStop};
pub(crate) use nominal::Continuation;
pub(crate) use starts::{ContinuationOrigin, InitialGuess, StartSolver};
