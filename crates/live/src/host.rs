//! The interface of a live page to the program that serves it: files, output times, and writing.

use mechc_engine::analysis::Times;
use mechc_pipeline::Compiled;
use mechc_text::diag::Diagnostics;
use mechc_text::source::Sources;
use mechc_text::world::World;
use std::sync::Arc;

/// The program that owns a live session: the command line or an editor's server.
pub trait Host: Send + Sync {
    /// Returns the files.
    fn world(&self) -> Arc<dyn World>;

    /// Returns the output times of a mechanism.
    ///
    /// # Errors
    /// The times are invalid or missing.
    fn times(&self, compiled: &Compiled, sources: &mut Sources) -> Result<Times, Diagnostics>;

    /// Replaces the text of the file if `is_due` still holds immediately before; returns whether it did.
    ///
    /// # Errors
    /// The reason why the file cannot be written, for the user.
    fn write(&self, text: &str, is_due: &dyn Fn() -> bool) -> Result<bool, String>;

    /// Shows a position of the file (UTF-16) in the editor, if the host has one.
    fn show(&self, at: u32) {
        let _ = at;
    }
}
