//! The error type of the library, and the categories of errors.

use super::{Code, Color, Diagnostic, Diagnostics, Format, render};
use crate::source::Sources;
use std::fmt;

/// Error of the library: the diagnostics that explain it, with the texts that they point into.
///
/// It displays as the command prints its diagnostics, without color.
#[derive(Clone)]
pub struct Error {
    /// The category of the first error.
    pub kind: ErrorKind,
    /// Errors, and the warnings and notes that were found with them; empty if the work was cancelled.
    pub diagnostics: Diagnostics,
    /// The texts that the diagnostics point into.
    pub sources: Sources,
}

impl Error {
    /// Creates an error of some diagnostics, and of the texts that they point into.
    #[must_use]
    pub fn new(diagnostics: impl Into<Diagnostics>, sources: &Sources) -> Error {
        let diagnostics = diagnostics.into();
        let kind = ErrorKind::of(&diagnostics, sources).unwrap_or(ErrorKind::Cancelled);
        Error { kind, diagnostics, sources: sources.clone() }
    }

    /// Returns the first error; `None` if the work was cancelled.
    #[must_use]
    pub fn first(&self) -> Option<&Diagnostic> {
        self.diagnostics.iter().find(|diagnostic| diagnostic.is_error())
    }
}

/// An error without a place in a text.
impl From<Diagnostic> for Error {
    fn from(diagnostic: Diagnostic) -> Error {
        Error::new(diagnostic, &Sources::default())
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.diagnostics.is_empty() {
            return f.write_str("cancelled");
        }
        let texts = self.diagnostics.iter().map(|of| render(of, &self.sources, Format::Human, Color::Never));
        f.write_str(texts.collect::<Vec<_>>().join("\n").trim_end())
    }
}

/// Equals the display, so that a `main` which returns the error prints it for people.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Error {}

/// Category of the first error, which decides the exit status.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ErrorKind {
    /// The text has errors.
    Input,
    /// The request is impossible.
    Usage,
    /// The analysis failed.
    Analysis,
    /// A file from the command line could not be read or written.
    Files,
    /// The caller cancelled the work.
    Cancelled,
}

impl ErrorKind {
    /// Returns the category of the first error, or `None` without errors.
    #[must_use]
    pub fn of(diagnostics: &Diagnostics, sources: &Sources) -> Option<ErrorKind> {
        let first = diagnostics.iter().find(|d| d.is_error())?;
        // any fault in an option is a usage error, unless it shows only at some time of the motion
        let is_at_some_time = (Code::E0601..=Code::E0612).contains(&first.code);
        if !is_at_some_time && first.labels.first().is_some_and(|label| sources.get(label.span.file).is_option) {
            return Some(ErrorKind::Usage);
        }
        Some(match first.code {
            _ if is_at_some_time => ErrorKind::Analysis,
            // a file that a text names is part of the text
            Code::E0701 if !first.labels.is_empty() => ErrorKind::Input,
            Code::E0701 | Code::E0702 => ErrorKind::Files,
            Code::E0703 | Code::E0704 | Code::E0705 | Code::E0706 | Code::E0708 => ErrorKind::Usage,
            _ => ErrorKind::Input,
        })
    }
}
