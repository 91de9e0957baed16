//! `mechc lsp`: the language server, for an editor at the other end of standard input and output.

use super::arguments::LspArguments;
use super::failure::Failure;
use super::files::{Disk, cannot_write};
use crate::lsp::{self, Log};
use std::fs::File;
use std::io::BufWriter;
use std::sync::Arc;

/// Serves until the client says that it is enough, or is gone; whether it ended as the protocol says.
pub(super) fn lsp(arguments: &LspArguments) -> Result<bool, Failure> {
    let log = match &arguments.log {
        None => Log::none(),
        Some(path) => {
            let file = File::create(path).map_err(|error| cannot_write(&path.to_string_lossy(), &error))?;
            Log::to(BufWriter::new(file))
        }
    };
    Ok(lsp::serve_pipe(Arc::new(Disk), log))
}
