//! What an editor asks about texts, as pure functions over a snapshot of them.
//!
//! No protocol, no input or output, no clock and no thread is known here. A [`Snapshot`] holds the open texts, and gives the stages of
//! each file, made when first asked for and kept. A place is a byte of a file ([`Place`], [`Stretch`]); whoever speaks a protocol turns
//! it into lines and columns. What gives nothing was cancelled, or there is nothing to say.
//!
//! # How a feature is added
//!
//! - A file in `ide/` with one public function, `pub fn hover(snapshot: &Snapshot, place: &Place) -> Option<Hover>`, plain data as its
//!   answer, and its tests: a text with a cursor (`$0`, see `testing.rs`) and the answer as the user sees it, in one snapshot of `insta`.
//! - Its module and its public names here.
//! - In `lsp/answers.rs` a function that reads the request's params, calls the feature and turns the answer into the protocol's words,
//!   and a line in `TABLE`.
//! - In `lsp/capabilities.rs` that the server has it.

mod buffers;
mod diagnostics;
mod hover;
mod kept;
mod outline;
mod place;
mod snapshot;
#[cfg(test)]
mod testing;

pub use buffers::Buffers;
pub use diagnostics::{ProposedFix, Related, Said, Severity, Stage, diagnostics};
pub use hover::{Hover, hover};
pub use outline::{Entry, outline};
pub use place::{Change, Place, Stretch};
pub use snapshot::{Analysed, Proven, Snapshot};
