//! Responsibility for an error: the author of the text, the caller of the program, or the mechanism.

use super::{Code, Diagnostics};
use crate::source::Sources;

/// Category of the first error, which decides the exit status.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Responsibility {
    /// The text has errors.
    Input,
    /// The request is impossible.
    Usage,
    /// The analysis failed.
    Analysis,
    /// A file from the command line could not be read or written.
    Files,
}

impl Responsibility {
    /// Returns the category of the first error, or `None` without errors.
    #[must_use]
    pub fn of(diagnostics: &Diagnostics, sources: &Sources) -> Option<Responsibility> {
        let first = diagnostics.iter().find(|d| d.is_error())?;
        // any fault in an option is a usage error, unless it shows only at some time of the motion
        let is_at_some_time = (Code::E0601..=Code::E0612).contains(&first.code);
        if !is_at_some_time && first.labels.first().is_some_and(|label| sources.get(label.span.file).is_option) {
            return Some(Responsibility::Usage);
        }
        Some(match first.code {
            _ if is_at_some_time => Responsibility::Analysis,
            // a file that a text names is part of the text
            Code::E0701 if !first.labels.is_empty() => Responsibility::Input,
            Code::E0701 | Code::E0702 => Responsibility::Files,
            Code::E0703 | Code::E0704 | Code::E0705 | Code::E0706 | Code::E0708 => Responsibility::Usage,
            _ => Responsibility::Input,
        })
    }
}
