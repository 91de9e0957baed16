//! Diagnostics of the compiler.
//!
//! A diagnostic is data: a code of the catalogue, a message, labelled spans, and fixes. Each phase words its own faults; this module only
//! stores and renders them, and does not depend on the language.

mod codes;
mod error;
mod fix;
mod nearest;
mod number;
mod options;
mod render;

pub use codes::Code;
pub use error::{Error, ErrorKind};
pub use fix::{Applicability, Edit, Fix, fixed};
pub use nearest::nearest;
pub use number::readable;
pub use options::OptionText;
pub use render::{Color, Format, render, render_applied, visible};

use crate::source::Span;
use rustc_hash::FxHashSet;
use serde_json::{Map, Value};

/// Severity of a diagnostic.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Severity {
    /// Information that needs no change.
    Note,
    /// Probably not intended.
    Warning,
    /// Prevents a result.
    Error,
}

/// A span with a remark.
#[derive(Clone, PartialEq, Debug)]
pub struct Label {
    /// Span.
    pub span: Span,
    /// Remark; may be empty.
    pub text: String,
    /// True for the location of the fault, false for related locations.
    pub primary: bool,
}

/// A message to the user.
#[derive(Clone, PartialEq, Debug)]
pub struct Diagnostic {
    /// Entry of the catalogue.
    pub code: Code,
    /// Headline: one fact, lower case, no full stop.
    pub message: String,
    /// Labels, the primary one first.
    pub labels: Vec<Label>,
    /// Further facts.
    pub notes: Vec<String>,
    /// Suggestions as text.
    pub help: Vec<String>,
    /// Suggestions as edits.
    pub fixes: Vec<Fix>,
    /// Quantities that a new driver could prescribe to resolve the fault, each as the left side of an equation: `rotation(main)`.
    pub drives: Vec<String>,
    /// Names of the declarations that are redundant, which pictures mark; empty if the labels show all that is at fault.
    pub redundant: Vec<String>,
    /// Values of the message for other programs.
    pub data: Map<String, Value>,
}

impl Diagnostic {
    /// Creates a diagnostic without labels.
    #[must_use]
    pub fn new(code: Code, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            code,
            message: message.into(),
            labels: Vec::new(),
            notes: Vec::new(),
            help: Vec::new(),
            fixes: Vec::new(),
            drives: Vec::new(),
            redundant: Vec::new(),
            data: Map::new(),
        }
    }

    /// Adds the location of the fault.
    #[must_use]
    pub fn at(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.labels.push(Label { span, text: text.into(), primary: true });
        self
    }

    /// Adds a related location.
    #[must_use]
    pub fn also(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.labels.push(Label { span, text: text.into(), primary: false });
        self
    }

    /// Adds the location where the part at fault is used.
    #[must_use]
    pub fn in_part(self, path: &str, used_at: Span) -> Diagnostic {
        self.also(used_at, format!("in part `{path}`, used here"))
    }

    /// Adds a primary label for the cause of the fault; the other labels become related locations.
    #[must_use]
    pub fn caused_by(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        for label in &mut self.labels {
            label.primary = false;
        }
        self.labels.insert(0, Label { span, text: text.into(), primary: true });
        self
    }

    /// Adds a fact.
    #[must_use]
    pub fn note(mut self, text: impl Into<String>) -> Diagnostic {
        self.notes.push(text.into());
        self
    }

    /// Adds a suggestion.
    #[must_use]
    pub fn help(mut self, text: impl Into<String>) -> Diagnostic {
        self.help.push(text.into());
        self
    }

    /// Sets the quantities that a driver could prescribe, which the help names.
    #[must_use]
    pub fn drives(mut self, quantities: Vec<String>) -> Diagnostic {
        self.drives = quantities;
        self
    }

    /// Adds a suggestion if there is one.
    #[must_use]
    pub fn help_if(self, text: Option<String>) -> Diagnostic {
        match text {
            Some(text) => self.help(text),
            None => self,
        }
    }

    /// Adds a fix and its message as a suggestion.
    #[must_use]
    pub fn fix(mut self, fix: Fix) -> Diagnostic {
        self.help.push(fix.message.clone());
        self.fixes.push(fix);
        self
    }

    /// Adds the edits for a suggestion that is already in the help.
    #[must_use]
    pub fn change(mut self, fix: Option<Fix>) -> Diagnostic {
        self.fixes.extend(fix);
        self
    }

    /// Adds a fix if there is one.
    #[must_use]
    pub fn fix_if(self, fix: Option<Fix>) -> Diagnostic {
        match fix {
            Some(fix) => self.fix(fix),
            None => self,
        }
    }

    /// Replaces all suggestions and fixes by one fix.
    #[must_use]
    pub fn instead(mut self, fix: Fix) -> Diagnostic {
        self.help.clear();
        self.fixes.clear();
        self.fix(fix)
    }

    /// Replaces all suggestions and fixes by one fix if there is one.
    #[must_use]
    pub fn instead_if(self, fix: Option<Fix>) -> Diagnostic {
        match fix {
            Some(fix) => self.instead(fix),
            None => self,
        }
    }

    /// Adds a value for other programs.
    #[must_use]
    pub fn datum(mut self, name: &str, value: impl Into<Value>) -> Diagnostic {
        self.data.insert(name.to_owned(), value.into());
        self
    }

    /// Names the declarations that are redundant, also for other programs.
    #[must_use]
    pub fn redundant(mut self, names: Vec<String>) -> Diagnostic {
        self.redundant.clone_from(&names);
        self.datum("redundant", names)
    }

    /// Returns the severity of the code.
    #[must_use]
    pub fn severity(&self) -> Severity {
        self.code.severity()
    }

    /// Returns whether this is an error.
    #[must_use]
    pub fn is_error(&self) -> bool {
        self.severity() == Severity::Error
    }
}

/// Diagnostics of a pass, in the order in which it found them.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    keys: FxHashSet<(Code, Option<Span>, String)>,
}

impl Diagnostics {
    /// Adds a diagnostic, unless one with the same code, primary span and message exists.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        let span = diagnostic.labels.first().map(|label| label.span);
        if self.keys.insert((diagnostic.code, span, diagnostic.message.clone())) {
            self.list.push(diagnostic);
        }
    }

    /// Returns whether there is an error.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(Diagnostic::is_error)
    }

    /// Returns the number of diagnostics.
    #[must_use]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Returns whether there are no diagnostics.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Returns the diagnostics in order.
    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        self.list.iter()
    }

    /// Keeps only the first diagnostic of each code and primary span: copies of a declaration repeat its faults.
    pub fn dedup_by_span(&mut self) {
        let mut keys: FxHashSet<(Code, Span)> = FxHashSet::default();
        self.list.retain(|d| d.labels.first().is_none_or(|label| keys.insert((d.code, label.span))));
    }

    /// Keeps only the first `len` diagnostics.
    pub fn truncate(&mut self, len: usize) {
        self.list.truncate(len);
    }

    /// Adds the location where a part is used to all diagnostics from index `from` on.
    pub fn annotate_part(&mut self, from: usize, path: &str, used_at: Span) {
        let moved = self.list.split_off(from.min(self.list.len()));
        self.list.extend(moved.into_iter().map(|diagnostic| diagnostic.in_part(path, used_at)));
    }

    /// Sorts the diagnostics by their primary span.
    pub fn sort_by_span(&mut self) {
        self.list.sort_by_key(|d| d.labels.first().map(|label| label.span));
    }
}

impl From<Box<Diagnostic>> for Diagnostics {
    fn from(diagnostic: Box<Diagnostic>) -> Diagnostics {
        (*diagnostic).into()
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(diagnostic: Diagnostic) -> Diagnostics {
        let mut diagnostics = Diagnostics::default();
        diagnostics.push(diagnostic);
        diagnostics
    }
}

impl Extend<Diagnostic> for Diagnostics {
    fn extend<T: IntoIterator<Item = Diagnostic>>(&mut self, iter: T) {
        for diagnostic in iter {
            self.push(diagnostic);
        }
    }
}

impl FromIterator<Diagnostic> for Diagnostics {
    fn from_iter<T: IntoIterator<Item = Diagnostic>>(iter: T) -> Diagnostics {
        let mut diagnostics = Diagnostics::default();
        diagnostics.extend(iter);
        diagnostics
    }
}

impl IntoIterator for Diagnostics {
    type Item = Diagnostic;
    type IntoIter = std::vec::IntoIter<Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.into_iter()
    }
}
