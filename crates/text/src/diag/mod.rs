//! What the compiler says to its user.
//!
//! A diagnostic is data: a code of the catalogue, one sentence, places with a word each, and the mend. The words are
//! written beside the phase that finds the fault; this module only holds them and renders them. It knows nothing of
//! mechanisms.

mod blame;
mod codes;
mod fix;
mod nearest;
mod number;
mod options;
mod render;

pub use blame::Blame;
pub use codes::Code;
pub use fix::{Applies, Edit, Fix, fixed};
pub use nearest::nearest;
pub use number::readable;
pub use options::OptionText;
pub use render::{Color, Format, render, render_made, visible};

use crate::source::Span;
use rustc_hash::FxHashSet;
use serde_json::{Map, Value};

/// How grave a diagnostic is.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Severity {
    /// Worth knowing; nothing to mend.
    Note,
    /// Probably not what was meant.
    Warning,
    /// Nothing can be computed.
    Error,
}

/// A place in the text with what is to be said of it.
#[derive(Clone, PartialEq, Debug)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What is there; may be empty.
    pub text: String,
    /// Whether this is the place of the fault, rather than one that helps to see it.
    pub primary: bool,
}

/// One thing to tell the user.
#[derive(Clone, PartialEq, Debug)]
pub struct Diagnostic {
    /// Its entry in the catalogue.
    pub code: Code,
    /// The headline: one fact, lower case, no full stop.
    pub message: String,
    /// Places, the primary one first.
    pub labels: Vec<Label>,
    /// More facts.
    pub notes: Vec<String>,
    /// What to write instead.
    pub help: Vec<String>,
    /// The changes of the text that the help proposes.
    pub fixes: Vec<Fix>,
    /// What could be driven to mend it, each the left side of a driver's equation: `rotation(main)`.
    pub drives: Vec<String>,
    /// Names of the declarations that are redundant, which pictures mark; empty if the labels show all that is at fault.
    pub redundant: Vec<String>,
    /// The numbers of the message, for other programs.
    pub data: Map<String, Value>,
}

impl Diagnostic {
    /// A diagnostic without a place yet.
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

    /// The place of the fault, and what is there.
    #[must_use]
    pub fn at(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.labels.push(Label { span, text: text.into(), primary: true });
        self
    }

    /// A place that helps to understand the fault.
    #[must_use]
    pub fn also(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        self.labels.push(Label { span, text: text.into(), primary: false });
        self
    }

    /// Where a part is used whose text, or whose copy of it, is at fault.
    #[must_use]
    pub fn in_part(self, path: &str, used_at: Span) -> Diagnostic {
        self.also(used_at, format!("in part `{path}`, used here"))
    }

    /// Moves the blame to a place that brought the faulty one in.
    #[must_use]
    pub fn raised_by(mut self, span: Span, text: impl Into<String>) -> Diagnostic {
        for label in &mut self.labels {
            label.primary = false;
        }
        self.labels.insert(0, Label { span, text: text.into(), primary: true });
        self
    }

    /// A further fact.
    #[must_use]
    pub fn note(mut self, text: impl Into<String>) -> Diagnostic {
        self.notes.push(text.into());
        self
    }

    /// What to write instead.
    #[must_use]
    pub fn help(mut self, text: impl Into<String>) -> Diagnostic {
        self.help.push(text.into());
        self
    }

    /// What could be driven, which the help says in words.
    #[must_use]
    pub fn drives(mut self, quantities: Vec<String>) -> Diagnostic {
        self.drives = quantities;
        self
    }

    /// The help, where there is one.
    #[must_use]
    pub fn help_if(self, text: Option<String>) -> Diagnostic {
        match text {
            Some(text) => self.help(text),
            None => self,
        }
    }

    /// What to write instead, in words and as the change of the text that they propose.
    #[must_use]
    pub fn fix(mut self, fix: Fix) -> Diagnostic {
        self.help.push(fix.message.clone());
        self.fixes.push(fix);
        self
    }

    /// The change of the text for what the help says already.
    #[must_use]
    pub fn change(mut self, fix: Option<Fix>) -> Diagnostic {
        self.fixes.extend(fix);
        self
    }

    /// The fix, where there is one.
    #[must_use]
    pub fn fix_if(self, fix: Option<Fix>) -> Diagnostic {
        match fix {
            Some(fix) => self.fix(fix),
            None => self,
        }
    }

    /// The fix alone, whatever else was proposed.
    #[must_use]
    pub fn instead(mut self, fix: Fix) -> Diagnostic {
        self.help.clear();
        self.fixes.clear();
        self.fix(fix)
    }

    /// A number of the message, for other programs.
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

    /// How grave it is.
    #[must_use]
    pub fn severity(&self) -> Severity {
        self.code.severity()
    }

    /// Whether it is more than a remark.
    #[must_use]
    pub fn is_error(&self) -> bool {
        self.severity() == Severity::Error
    }
}

/// What a pass found, in the order of finding.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    said: FxHashSet<(Code, Option<Span>, String)>,
}

impl Diagnostics {
    /// Adds one; the same code at the same place is said once.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        let place = diagnostic.labels.first().map(|label| label.span);
        if self.said.insert((diagnostic.code, place, diagnostic.message.clone())) {
            self.list.push(diagnostic);
        }
    }

    /// Whether anything forbids to go on.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(Diagnostic::is_error)
    }

    /// How many.
    #[must_use]
    pub fn len(&self) -> usize {
        self.list.len()
    }

    /// Whether there is nothing to say.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// In the order of finding.
    pub fn iter(&self) -> impl Iterator<Item = &Diagnostic> {
        self.list.iter()
    }

    /// Leaves of each code at each place the first: what is wrong in every copy of a declaration.
    pub fn tell_once(&mut self) {
        let mut told: FxHashSet<(Code, Span)> = FxHashSet::default();
        self.list.retain(|d| d.labels.first().is_none_or(|label| told.insert((d.code, label.span))));
    }

    /// Forgets those behind a number of them.
    pub fn truncate(&mut self, len: usize) {
        self.list.truncate(len);
    }

    /// Where a part is used that brought in all but the first ones.
    pub fn in_part_from(&mut self, from: usize, path: &str, used_at: Span) {
        let told = self.list.split_off(from.min(self.list.len()));
        self.list.extend(told.into_iter().map(|diagnostic| diagnostic.in_part(path, used_at)));
    }

    /// By their place in the text, so that a reader meets them from top to bottom.
    pub fn sort_by_place(&mut self) {
        self.list.sort_by_key(|d| d.labels.first().map(|l| l.span));
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

impl IntoIterator for Diagnostics {
    type Item = Diagnostic;
    type IntoIter = std::vec::IntoIter<Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.list.into_iter()
    }
}
