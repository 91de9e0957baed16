//! What an editor asks about texts, as pure functions over a snapshot of them.
//!
//! No protocol, no input or output, no clock and no thread is known here. A [`Snapshot`] holds the open texts, and gives the stages of
//! each file, made when first asked for and kept. A place is a byte of a file ([`FilePosition`], [`FileRange`]); whoever speaks a protocol turns
//! it into lines and columns. What gives nothing was cancelled, or there is nothing to say.
//!
//! # How a feature is added
//!
//! - A file in `crates/ide/src` with one public function, `pub fn hover(snapshot: &Snapshot, position: &FilePosition) -> Option<Hover>`, plain data as its
//!   answer, and its tests: a text with a cursor (`$0`, see `testing.rs`) and the answer as the user sees it, in one snapshot of `insta`.
//! - Its module and its public names here.
//! - In `lsp/answers.rs` a function that reads the request's params, calls the feature and turns the answer into the protocol's words,
//!   and a line in `TABLE`.
//! - In `lsp/capabilities.rs` that the server has it.

mod actions;
mod buffers;
mod completion;
mod diagnostics;
mod trial_edits;
mod declaration_info;
mod formatting;
mod hints;
mod hover;
mod memo;
mod lenses;
#[cfg(feature = "lsp")]
pub mod lsp;
mod occurrences;
mod navigate;
mod numbers;
mod outline;
mod location;
mod rename;
mod signature;
mod snapshot;
mod structure;
#[cfg(test)]
mod testing;
mod tokens;
mod word_docs;
mod workspace;
mod lexical;

pub use actions::{Action, ActionKind, actions};
pub use buffers::Buffers;
pub use completion::{CompletionItem, CompletionItemKind, Completions, Template, completions};
pub use diagnostics::{DiagnosticStage, ProposedFix, Related, EditorDiagnostic, Severity, diagnostics};
pub use formatting::{FormatScope, formatting};
pub use hints::{Hint, hints};
pub use hover::{Hover, hover};
pub use lenses::{Lens, LensKind, lenses};
pub use navigate::{FileLink, Highlight, Link, definition, file_links, highlights, references};
pub use outline::{OutlineEntry, outline};
pub use location::{Change, FilePosition, FileRange};
pub use rename::{prepare_rename, rename};
pub use signature::{Signature, Signatures, signatures};
pub use snapshot::{CheckedFile, MotionOutcome, Proof, Snapshot, index_names};
pub use structure::{Fold, FoldKind, around, folds};
pub use tokens::{SemanticToken, TokenKind, tokens};
pub use workspace::{WorkspaceName, files_in, is_mech, workspace_names};
