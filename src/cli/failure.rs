//! What ends a command early, and the exit code that tells it.

use mechc_text::diag::{Blame, Code, Diagnostic, Diagnostics};
use mechc_text::source::Sources;

/// The input has errors, or is not as it should be.
pub(super) const INPUT: u8 = 1;
/// Wrong usage.
const USAGE: u8 = 2;
/// The analysis could not be completed.
pub(super) const ANALYSIS: u8 = 3;
/// A file could not be read or written.
const FILES: u8 = 4;

/// Why a command ends early.
#[derive(Debug)]
pub(super) enum Failure {
    /// With something to say.
    Said(Diagnostics),
    /// The reader of the results has gone; nothing is left to do, and nothing is wrong.
    ReaderGone,
}

impl From<Diagnostics> for Failure {
    fn from(diagnostics: Diagnostics) -> Failure {
        Failure::Said(diagnostics)
    }
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Failure {
        Failure::Said(diagnostic.into())
    }
}

impl From<Box<Diagnostic>> for Failure {
    fn from(diagnostic: Box<Diagnostic>) -> Failure {
        Failure::Said((*diagnostic).into())
    }
}

/// Options that do not go together, or with the file.
pub(super) fn unusable(message: impl Into<String>) -> Diagnostic {
    Diagnostic::new(Code::E0706, message)
}

/// Whether all errors among these are of the options of a command, and of files that these name.
pub(super) fn is_of_options(diagnostics: &Diagnostics, sources: &Sources) -> bool {
    let code = |error: &Diagnostic| exit_code(&error.clone().into(), sources);
    let mut errors = diagnostics.iter().filter(|said| said.is_error()).peekable();
    errors.peek().is_some() && errors.all(|error| [USAGE, FILES].contains(&code(error)))
}

/// The exit code of a command that ended with these.
pub(super) fn exit_code(diagnostics: &Diagnostics, sources: &Sources) -> u8 {
    match Blame::of(diagnostics, sources) {
        None => 0,
        Some(Blame::Input) => INPUT,
        Some(Blame::Usage) => USAGE,
        Some(Blame::Analysis) => ANALYSIS,
        Some(Blame::Files) => FILES,
    }
}
