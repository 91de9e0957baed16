//! Which parts a message speaks of, and where these are used: what it shows is the text of their mechanisms.

use crate::diag::{Diagnostic, Diagnostics};
use crate::ir::ConstraintSystem;
use crate::source::Span;
use std::sync::Arc;

/// Parts that one message tells of at most.
const MOST: usize = 3;

/// The parts of a mechanism, with the places where they are declared.
#[derive(Clone, Debug)]
pub(super) struct UsedAt(Arc<[(String, Span)]>);

impl UsedAt {
    pub fn of(system: &ConstraintSystem) -> UsedAt {
        UsedAt(system.parts.iter().map(|part| (part.name.clone(), part.span)).collect())
    }

    /// Messages, each with the places of the parts that it names.
    pub fn told(&self, said: Diagnostics) -> Diagnostics {
        if self.0.is_empty() {
            return said;
        }
        let mut told = Diagnostics::default();
        told.extend(said.into_iter().map(|diagnostic| self.tell(diagnostic)));
        told
    }

    /// A message with the places of the parts that it names.
    pub fn tell(&self, mut diagnostic: Diagnostic) -> Diagnostic {
        let mut told = 0;
        for (part, span) in self.0.iter() {
            // copies stand in one place, and the first one is enough
            if told < MOST && speaks_of(&diagnostic, part, *span) {
                diagnostic = diagnostic.also(*span, format!("in part `{part}`, used here"));
                told += 1;
            }
        }
        diagnostic
    }
}

/// Whether a message names something of a part, whose place it does not show yet.
fn speaks_of(diagnostic: &Diagnostic, part: &str, span: Span) -> bool {
    let inside = format!("`{part}.");
    let labels = diagnostic.labels.iter();
    !diagnostic.labels.iter().any(|label| label.span == span)
        && (diagnostic.message.contains(&inside)
            || labels.map(|label| &label.text).chain(&diagnostic.notes).any(|text| text.contains(&inside)))
}
