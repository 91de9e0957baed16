//! Prints diagnostics to standard error.

use super::arguments::{MessageFormat, Messages, When};
use super::failure::{Failure, exit_code};
use super::protected_paths::ProtectedPaths;
use mechc_text::diag::{Color, Diagnostics, Error, Fix, Format, render, render_applied, visible};
use mechc_text::source::{FileId, Sources};
use std::cell::Cell;
use std::io::{IsTerminal, Write};
use std::path::PathBuf;

/// Prints diagnostics in the requested format, with the texts that they refer to.
pub(super) struct Reporter {
    pub sources: Sources,
    /// The files that the texts and the options of the command name.
    pub named_files: Vec<PathBuf>,
    format: Format,
    color: Color,
    /// The exit code of a command that succeeds, which may still signal a problem.
    exit: Cell<u8>,
}

impl Reporter {
    pub fn new(messages: &Messages) -> Reporter {
        let format = match messages.message_format {
            MessageFormat::Human => Format::Human,
            MessageFormat::Short => Format::Short,
            MessageFormat::Json => Format::Json,
        };
        let colored = match messages.color {
            When::Always => true,
            When::Never => false,
            When::Auto => {
                let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
                let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
                std::io::stderr().is_terminal() && !set("NO_COLOR") && !dumb
            }
        };
        let color = if colored { Color::Always } else { Color::Never };
        Reporter { sources: Sources::default(), named_files: Vec::new(), format, color, exit: Cell::new(0) }
    }

    /// Returns the files that no output may overwrite.
    pub fn protected(&self) -> ProtectedPaths<'_> {
        ProtectedPaths { read: Some(&self.sources), named: &self.named_files }
    }

    /// Returns whether diagnostics are written for other programs.
    pub fn is_machine_readable(&self) -> bool {
        self.format == Format::Json
    }

    /// Prints diagnostics that point into the reporter's texts.
    pub fn print(&self, diagnostics: &Diagnostics) {
        self.print_with(diagnostics, &self.sources);
    }

    /// Prints an error with the texts that it points into.
    pub fn print_error(&self, error: &Error) {
        self.print_with(&error.diagnostics, &error.sources);
    }

    fn print_with(&self, diagnostics: &Diagnostics, sources: &Sources) {
        let mut text = String::new();
        for diagnostic in diagnostics.iter() {
            text += &render(diagnostic, sources, self.format, self.color);
        }
        let errors = diagnostics.iter().filter(|d| d.is_error()).count();
        if errors > 1 && self.format == Format::Human {
            text += &format!("error: {errors} errors\n");
        }
        // a closed standard error is no reason to fail
        let _ = std::io::stderr().lock().write_all(text.as_bytes());
    }

    /// Prints the diagnostics of a stage and returns its result; fails with the diagnostics if there is none.
    pub fn require<T>(&self, result: Option<T>, diagnostics: Diagnostics) -> Result<T, Failure> {
        match result {
            None => Err(diagnostics.into()),
            Some(result) => {
                self.print(&diagnostics);
                // no path led to the values that are set: the start was assembled directly, and the exit code tells so
                if diagnostics.has_errors() {
                    self.exit.set(exit_code(&diagnostics, &self.sources));
                }
                Ok(result)
            }
        }
    }

    /// Prints the fixes that were applied to a file, in the order of the text, and their number.
    pub fn print_fixes(&self, fixes: &[Fix], file: FileId) {
        // each round has its own text, so positions are comparable up to a shift of a line
        let position =
            |fix: &Fix| fix.edits.first().map(|edit| self.sources.get(edit.span.file).position(edit.span.start));
        let mut fixes: Vec<&Fix> = fixes.iter().collect();
        fixes.sort_by_key(|fix| position(fix));
        let mut text: String = fixes.iter().map(|fix| render_applied(fix, &self.sources, self.format)).collect();
        if self.format != Format::Json {
            let name = &self.sources.get(file).name;
            text += &match fixes.len() {
                0 => format!("nothing to fix in `{name}`\n"),
                count => format!("fixed {count} in `{name}`\n"),
            };
        }
        Reporter::print_text(&text);
    }

    /// Sets the exit code of a command that succeeds.
    pub fn set_exit_code(&self, code: u8) {
        self.exit.set(code);
    }

    /// Prints text that is not a diagnostic.
    pub fn print_text(text: &str) {
        let _ = std::io::stderr().lock().write_all(visible(text).as_bytes());
    }

    /// Prints why a command failed, and returns the exit code.
    pub fn finish(&self, result: Result<(), Failure>) -> u8 {
        match result {
            Ok(()) | Err(Failure::ReaderClosed) => self.exit.get(),
            Err(Failure::Reported(diagnostics, sources)) => {
                let sources = sources.as_ref().unwrap_or(&self.sources);
                self.print_with(&diagnostics, sources);
                exit_code(&diagnostics, sources)
            }
        }
    }
}
