//! What a live page asks of the program that it is a part of: files, times, a place to write to.

use mechc_engine::analysis::Times;
use mechc_pipeline::Compiled;
use mechc_text::diag::Diagnostics;
use mechc_text::source::Sources;
use mechc_text::world::World;
use std::sync::Arc;

/// Whoever has a workshop: a command, an editor.
pub trait Host: Send + Sync {
    /// The files.
    fn world(&self) -> Arc<dyn World>;

    /// The times of a mechanism.
    ///
    /// # Errors
    /// They cannot be told.
    fn times(&self, compiled: &Compiled, sources: &mut Sources) -> Result<Times, Diagnostics>;

    /// Puts a text in the place of the one that the file has, if that is still due when nothing else is left to do; says whether it was.
    ///
    /// # Errors
    /// Why it cannot be written, in words.
    fn write(&self, text: &str, is_due: &dyn Fn() -> bool) -> Result<bool, String>;

    /// Shows a place of the file (UTF-16), where there is something to show it in.
    fn show(&self, at: u32) {
        let _ = at;
    }
}
