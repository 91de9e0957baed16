//! Failures of commands, and their exit codes.

use mechc_text::diag::{Code, Diagnostic, Diagnostics, Error, ErrorKind};
use mechc_text::source::Sources;

/// The exit code if the input has errors or is not formatted.
pub(super) const INPUT: u8 = 1;
/// The exit code of wrong usage.
const USAGE: u8 = 2;
/// The exit code if the analysis could not be completed.
pub(super) const ANALYSIS: u8 = 3;
/// The exit code if a file could not be read or written.
const FILES: u8 = 4;

/// The reason why a command ends early.
#[derive(Debug)]
pub(super) enum Failure {
    /// Diagnostics to print, and the texts that they point into; `None` for those of the reporter.
    Reported(Diagnostics, Option<Sources>),
    /// The reader of the results has closed the pipe, which is not an error.
    ReaderClosed,
}

impl From<Diagnostics> for Failure {
    fn from(diagnostics: Diagnostics) -> Failure {
        Failure::Reported(diagnostics, None)
    }
}

impl Failure {
    /// Returns the diagnostics to print.
    pub fn into_diagnostics(self) -> Diagnostics {
        match self {
            Failure::Reported(diagnostics, _) => diagnostics,
            Failure::ReaderClosed => Diagnostics::default(),
        }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Failure {
        Failure::Reported(error.diagnostics, Some(error.sources))
    }
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Failure {
        Failure::Reported(diagnostic.into(), None)
    }
}

impl From<Box<Diagnostic>> for Failure {
    fn from(diagnostic: Box<Diagnostic>) -> Failure {
        Failure::Reported(diagnostic.into(), None)
    }
}

/// Creates an error about options that do not fit together or with the file.
pub(super) fn unusable(message: impl Into<String>) -> Diagnostic {
    Diagnostic::new(Code::E0706, message)
}

/// Returns whether there are errors and all of them concern the options of a command or files that these name.
pub(super) fn concerns_options(diagnostics: &Diagnostics, sources: &Sources) -> bool {
    let code = |error: &Diagnostic| exit_code(&error.clone().into(), sources);
    let mut errors = diagnostics.iter().filter(|diagnostic| diagnostic.is_error()).peekable();
    errors.peek().is_some() && errors.all(|error| [USAGE, FILES].contains(&code(error)))
}

/// Returns the exit code for some diagnostics.
pub(super) fn exit_code(diagnostics: &Diagnostics, sources: &Sources) -> u8 {
    match ErrorKind::of(diagnostics, sources) {
        None => 0,
        Some(ErrorKind::Input) => INPUT,
        Some(ErrorKind::Usage) => USAGE,
        Some(ErrorKind::Analysis | ErrorKind::Cancelled) => ANALYSIS,
        Some(ErrorKind::Files) => FILES,
    }
}
