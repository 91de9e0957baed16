//! Responsibility for an error: the author of the text, the caller of the program, or the mechanism.

use super::{Code, Diagnostics};
use crate::source::Sources;

/// Category of the first error, which decides the exit status.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Blame {
    /// The text has errors.
    Input,
    /// The request is impossible.
    Usage,
    /// The analysis failed.
    Analysis,
    /// A file from the command line could not be read or written.
    Files,
}

impl Blame {
    /// Returns the category of the first error, or `None` without errors.
    #[must_use]
    pub fn of(diagnostics: &Diagnostics, sources: &Sources) -> Option<Blame> {
        let first = diagnostics.iter().find(|d| d.is_error())?;
        // any fault in an option is a usage error, unless it shows only at some time of the motion
        let is_at_some_time = (Code::E0601..=Code::E0612).contains(&first.code);
        if !is_at_some_time && first.labels.first().is_some_and(|label| sources.get(label.span.file).is_option) {
            return Some(Blame::Usage);
        }
        Some(match first.code {
            _ if is_at_some_time => Blame::Analysis,
            // a file that a text names is part of the text
            Code::E0701 if !first.labels.is_empty() => Blame::Input,
            Code::E0701 | Code::E0702 => Blame::Files,
            Code::E0703 | Code::E0704 | Code::E0705 | Code::E0706 | Code::E0708 => Blame::Usage,
            _ => Blame::Input,
        })
    }
}
