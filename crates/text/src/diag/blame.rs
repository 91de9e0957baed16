//! Who is to mend something: whoever wrote the text, whoever called the program, nobody but the mechanism.

use super::{Code, Diagnostics};
use crate::source::Sources;

/// What kind of thing went wrong.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Blame {
    /// The text has errors.
    Input,
    /// Something was asked for that cannot be.
    Usage,
    /// The analysis could not be completed.
    Analysis,
    /// A file that was named from outside could not be read or written.
    Files,
}

impl Blame {
    /// By the first error of what is said; nothing where there is none.
    #[must_use]
    pub fn of(diagnostics: &Diagnostics, sources: &Sources) -> Option<Blame> {
        let first = diagnostics.iter().find(|d| d.is_error())?;
        // what is wrong with an option is wrong usage, whatever it is, unless it is only wrong at some time
        let on_the_way = (Code::E0601..=Code::E0612).contains(&first.code);
        if !on_the_way && first.labels.first().is_some_and(|label| sources.get(label.span.file).is_option) {
            return Some(Blame::Usage);
        }
        Some(match first.code {
            _ if on_the_way => Blame::Analysis,
            // a file that a text names is a part of the text
            Code::E0701 if !first.labels.is_empty() => Blame::Input,
            Code::E0701 | Code::E0702 => Blame::Files,
            Code::E0703 | Code::E0704 | Code::E0705 | Code::E0706 | Code::E0708 => Blame::Usage,
            _ => Blame::Input,
        })
    }
}
