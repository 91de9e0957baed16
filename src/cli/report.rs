//! Diagnostics to standard error.

use super::arguments::{MessageFormat, Messages, When};
use super::failure::{Failure, exit_code};
use super::spared::Spared;
use mechc_text::diag::{Color, Diagnostics, Fix, Format, render, render_made, visible};
use mechc_text::source::{FileId, Sources};
use std::cell::Cell;
use std::io::{IsTerminal, Write};
use std::path::PathBuf;

/// Prints diagnostics as the user wants them, and knows the texts that they speak of.
pub(super) struct Reporter {
    pub sources: Sources,
    /// The files that they, and the options of the command, name.
    pub named: Vec<PathBuf>,
    format: Format,
    color: Color,
    /// The exit code of a command that did its work, and had to say that not all is as it should be.
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
        Reporter { sources: Sources::default(), named: Vec::new(), format, color, exit: Cell::new(0) }
    }

    /// What no output may be.
    pub fn spared(&self) -> Spared<'_> {
        Spared { read: Some(&self.sources), named: &self.named }
    }

    /// Whether what is said is read by other programs.
    pub fn is_for_programs(&self) -> bool {
        self.format == Format::Json
    }

    pub fn print(&self, diagnostics: &Diagnostics) {
        let mut text = String::new();
        for diagnostic in diagnostics.iter() {
            text += &render(diagnostic, &self.sources, self.format, self.color);
        }
        let errors = diagnostics.iter().filter(|d| d.is_error()).count();
        if errors > 1 && self.format == Format::Human {
            text += &format!("error: {errors} errors\n");
        }
        // a reader of the diagnostics who has gone is no reason to fail
        let _ = std::io::stderr().lock().write_all(text.as_bytes());
    }

    /// What a stage gave, its remarks printed; or why it gave nothing.
    pub fn settle<T>(&self, made: Option<T>, said: Diagnostics) -> Result<T, Failure> {
        match made {
            None => Err(said.into()),
            Some(made) => {
                self.print(&said);
                // no path led to the values that are set, and the start was made from the estimates alone
                if said.has_errors() {
                    self.exit.set(exit_code(&said, &self.sources));
                }
                Ok(made)
            }
        }
    }

    /// Says which changes of a file were made, from its beginning to its end, and how many.
    pub fn made(&self, fixes: &[Fix], file: FileId) {
        // each round has a text of its own, where places may be shifted by a line at most
        let place =
            |fix: &Fix| fix.edits.first().map(|edit| self.sources.get(edit.span.file).position(edit.span.start));
        let mut fixes: Vec<&Fix> = fixes.iter().collect();
        fixes.sort_by_key(|fix| place(fix));
        let mut text: String = fixes.iter().map(|fix| render_made(fix, &self.sources, self.format)).collect();
        if self.format != Format::Json {
            let name = &self.sources.get(file).name;
            text += &match fixes.len() {
                0 => format!("nothing to fix in `{name}`\n"),
                count => format!("fixed {count} in `{name}`\n"),
            };
        }
        Reporter::say(&text);
    }

    /// Ends the command with an exit code, although it did its work.
    pub fn end_with(&self, code: u8) {
        self.exit.set(code);
    }

    /// Says something that is no diagnostic.
    pub fn say(text: &str) {
        let _ = std::io::stderr().lock().write_all(visible(text).as_bytes());
    }

    /// Says why a command ended, and gives its exit code.
    pub fn finish(&self, result: Result<(), Failure>) -> u8 {
        match result {
            Ok(()) | Err(Failure::ReaderGone) => self.exit.get(),
            Err(Failure::Said(diagnostics)) => {
                self.print(&diagnostics);
                exit_code(&diagnostics, &self.sources)
            }
        }
    }
}
