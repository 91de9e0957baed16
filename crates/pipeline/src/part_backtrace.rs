//! Part backtraces: a message points into the text of a part's mechanism; they add where that part is used.

use mechc_lang::model::Mechanism;
use mechc_text::diag::{Code, Diagnostic, Diagnostics};
use mechc_text::source::Span;
use rustc_hash::FxHashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

/// A message shows at most this many parts.
const MAX_PARTS: usize = 3;

/// The parts of a mechanism at all levels, outermost first, with the spans of their declarations.
#[derive(Clone, Debug)]
pub(crate) struct PartBacktrace(Arc<[(String, Span)]>);

impl PartBacktrace {
    pub fn new(model: &Mechanism) -> PartBacktrace {
        PartBacktrace(model.parts.iter().map(|part| (part.declared.name.clone(), part.declared.span)).collect())
    }

    /// Adds the parts that messages name; messages that are equal for several copies are reported once.
    pub fn annotate_all(&self, diagnostics: Diagnostics) -> Diagnostics {
        if self.0.is_empty() {
            return diagnostics;
        }
        let mut annotated = Diagnostics::default();
        annotated.extend(dedup_copies(diagnostics.into_iter().map(|diagnostic| self.annotate(diagnostic))));
        annotated
    }

    /// Adds the parts that a message names in its headline, or else in its labels and notes.
    pub fn annotate(&self, mut diagnostic: Diagnostic) -> Diagnostic {
        let labels = diagnostic.labels.iter().map(|label| label.text.as_str());
        let details: Vec<&str> = labels.chain(diagnostic.notes.iter().map(String::as_str)).collect();
        let mut parts = self.parts_named_in(&[&diagnostic.message]);
        if parts.is_empty() {
            parts = self.parts_named_in(&details);
        }
        // from the inside out
        parts.sort_by_key(|(part, _)| std::cmp::Reverse(part.matches('.').count()));
        let mut shown = 0;
        for (part, span) in parts {
            // copies are declared at one place, which is shown once
            if shown < MAX_PARTS && diagnostic.labels.iter().all(|label| label.span != span) {
                diagnostic = diagnostic.in_part(&part, span);
                shown += 1;
            }
        }
        diagnostic
    }

    /// Returns the parts in which texts name something.
    fn parts_named_in(&self, texts: &[&str]) -> Vec<(String, Span)> {
        let is_named = |part: &str| {
            let inside = format!("`{part}.");
            texts.iter().any(|text| text.contains(&inside))
        };
        self.0.iter().filter(|(part, _)| is_named(part)).cloned().collect()
    }
}

/// Removes messages that repeat for a copy what was reported of another one; the first notes how many there are.
fn dedup_copies(diagnostics: impl Iterator<Item = Diagnostic>) -> Vec<Diagnostic> {
    let mut once: Vec<Diagnostic> = Vec::new();
    let mut first_of: FxHashMap<(Code, Option<Span>, String), (usize, usize)> = FxHashMap::default();
    for diagnostic in diagnostics {
        let message = without_copy_indices(&diagnostic.message);
        let is_of_copy = message != diagnostic.message;
        let span = diagnostic.labels.first().map(|label| label.span);
        match first_of.entry((diagnostic.code, span, message)) {
            Entry::Occupied(mut first) if is_of_copy => first.get_mut().1 += 1,
            Entry::Occupied(_) => once.push(diagnostic),
            Entry::Vacant(new) => {
                new.insert((once.len(), 0));
                once.push(diagnostic);
            }
        }
    }
    for (first, others) in first_of.into_values().filter(|(_, others)| *others > 0) {
        let copies = if others == 1 { "one other copy".to_owned() } else { format!("{others} other copies") };
        once[first].notes.push(format!("it is the same in {copies}"));
    }
    once
}

/// Returns `leg.foot` for `leg[2].foot`.
fn without_copy_indices(message: &str) -> String {
    let mut rest = message;
    let mut text = String::with_capacity(message.len());
    while let Some((before, behind)) = rest.split_once('[') {
        let inside = behind.split_once(']').map(|(inside, _)| inside);
        let is_number = |c: char| c.is_ascii_digit() || "-, ".contains(c);
        match inside.filter(|inside| inside.chars().all(is_number)) {
            Some(inside) => (text += before, rest = &behind[inside.len() + 1..]),
            None => (text = text + before + "[", rest = behind),
        };
    }
    text + rest
}
