//! `mechc lsp`: the language server, over standard input and output.

use super::arguments::LspArguments;
use super::failure::Failure;
use super::files::{Disk, cannot_write};
use super::report::Reporter;
use mechc_ide::lsp::{self, Log, SessionEnd};
use std::fs::File;
use std::io::{BufWriter, IsTerminal};
use std::sync::Arc;

/// Explanation for users who start the server without an editor.
const FOR_EDITORS: &str = "`mechc lsp` is the language server: an editor starts it and speaks the language server protocol with it, over\n\
    standard input and output. How editors are set up is in the folder `editors` of the project.\n";

/// Serves a client until the session ends; returns whether it ended as the protocol requires.
pub(super) fn lsp(arguments: &LspArguments) -> Result<bool, Failure> {
    let log = match &arguments.log {
        None => Log::none(),
        Some(path) => {
            let file = File::create(path).map_err(|error| cannot_write(&path.to_string_lossy(), &error))?;
            Log::to(BufWriter::new(file))
        }
    };
    let is_typed = std::io::stdin().is_terminal();
    if is_typed {
        Reporter::print_text(FOR_EDITORS);
    }
    let ended = lsp::serve_pipe(Arc::new(Disk), log);
    if ended == SessionEnd::Unbegun && !is_typed {
        Reporter::print_text(FOR_EDITORS);
    }
    Ok(ended == SessionEnd::Well)
}
