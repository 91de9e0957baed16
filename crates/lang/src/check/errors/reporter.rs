//! The owner of a check's diagnostics.

use mechc_text::diag::{Diagnostic, Diagnostics};
use mechc_text::source::{Sources, Span};

/// Largest number of diagnostics of a mechanism and its parts with which names are still suggested; beyond it the search takes long.
const MOST_SUGGESTIONS: usize = 100;

/// The diagnostics of a mechanism or part, and what each of them says of the way to its location.
pub struct Reporter<'a> {
    pub sources: &'a Sources,
    /// The diagnostics so far. A mechanism and its parts share them.
    pub diagnostics: Diagnostics,
    /// The call of the outermost formula that is being expanded.
    pub caller: Option<Span>,
    /// The names of the part and of those that enclose it, with their locations.
    pub used_at: Vec<(String, Span)>,
}

impl<'a> Reporter<'a> {
    pub fn new(sources: &'a Sources) -> Reporter<'a> {
        Reporter { sources, diagnostics: Diagnostics::default(), caller: None, used_at: Vec::new() }
    }

    /// Adds a diagnostic, with the locations of the call and of the parts through which it arises.
    pub fn report(&mut self, diagnostic: Diagnostic) {
        let diagnostic = match self.caller {
            // A formula is judged where it is called.
            Some(caller) => diagnostic.caused_by(caller, "brought in here"),
            None => diagnostic,
        };
        let parts = self.used_at.iter();
        self.diagnostics.push(parts.fold(diagnostic, |diagnostic, (part, span)| diagnostic.in_part(part, *span)));
    }

    /// Returns the text at a location.
    pub fn text(&self, span: Span) -> &'a str {
        self.sources.text(span)
    }

    /// Returns whether names are still suggested.
    pub fn suggests_names(&self) -> bool {
        self.diagnostics.len() <= MOST_SUGGESTIONS
    }
}
