//! Editor features as pure functions over a snapshot of texts.
//!
//! This crate knows no protocol, input, output, clock or thread, except in `lsp`. A [`Snapshot`] holds the open texts and computes the
//! stages of each file on first use. A position is a byte of a file ([`FilePosition`], [`FileRange`]); a protocol turns it into lines and
//! columns. `None` means that the snapshot was cancelled, or that there is no result.
//!
//! # How a feature is added
//!
//! - Add a file in `crates/ide/src` with one public function, `pub fn hover(snapshot: &Snapshot, position: &FilePosition) ->
//!   Option<Hover>`, that returns plain data, and its tests: a text with a cursor (`$0`, see `testing.rs`) and the result as the user sees
//!   it, in one snapshot of `insta`.
//! - Export its module and its public names here.
//! - Add to `lsp/handlers.rs` a function that converts the request's params, calls the feature and converts the result, and a line in
//!   `TABLE`.
//! - Announce it in `lsp/capabilities.rs`.

mod actions;
mod buffers;
mod completion;
mod declaration_info;
mod diagnostics;
mod formatting;
mod hints;
mod hover;
mod lenses;
mod lexical;
mod location;
#[cfg(feature = "lsp")]
pub mod lsp;
mod memo;
mod navigate;
mod numbers;
mod occurrences;
mod outline;
mod rename;
mod signature;
mod snapshot;
mod structure;
#[cfg(test)]
mod testing;
mod tokens;
mod trial_edits;
mod word_docs;
mod workspace;

pub use actions::{Action, ActionKind, actions};
pub use buffers::Buffers;
pub use completion::{CompletionItem, CompletionItemKind, Completions, Template, completions};
pub use diagnostics::{DiagnosticStage, EditorDiagnostic, ProposedFix, Related, Severity, diagnostics};
pub use formatting::{FormatScope, formatting};
pub use hints::{Hint, hints};
pub use hover::{Hover, hover};
pub use lenses::{Lens, LensKind, lenses};
pub use location::{Change, FilePosition, FileRange};
pub use navigate::{FileLink, Highlight, Link, definition, file_links, highlights, references};
pub use outline::{OutlineEntry, outline};
pub use rename::{prepare_rename, rename};
pub use signature::{Signature, Signatures, signatures};
pub use snapshot::{CheckedFile, MotionOutcome, Proof, ResultValue, Snapshot, index_names};
pub use structure::{Fold, FoldKind, folds, selection_ranges};
pub use tokens::{SemanticToken, TokenKind, tokens};
pub use workspace::{WorkspaceName, files_in, is_mech, workspace_names};
