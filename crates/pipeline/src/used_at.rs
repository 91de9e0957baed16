//! Which parts a message speaks of, and where these are used: what it shows is the text of their mechanisms.

use mechc_lang::model::Mechanism;
use mechc_text::diag::{Code, Diagnostic, Diagnostics};
use mechc_text::source::Span;
use rustc_hash::FxHashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

/// Parts that one message tells of at most.
const MOST: usize = 3;

/// The parts of a mechanism, at all levels, the outermost first, with the places where they are declared.
#[derive(Clone, Debug)]
pub(super) struct UsedAt(Arc<[(String, Span)]>);

impl UsedAt {
    pub fn of(model: &Mechanism) -> UsedAt {
        UsedAt(model.parts.iter().map(|part| (part.declared.name.clone(), part.declared.span)).collect())
    }

    /// Messages, each with the places of the parts that it names; what is the same in several copies is told of the first.
    pub fn told(&self, said: Diagnostics) -> Diagnostics {
        if self.0.is_empty() {
            return said;
        }
        let mut told = Diagnostics::default();
        told.extend(of_copies_once(said.into_iter().map(|diagnostic| self.tell(diagnostic))));
        told
    }

    /// A message with the places of the parts that it names: those of its headline, or, where that names none, of its labels and notes.
    pub fn tell(&self, mut diagnostic: Diagnostic) -> Diagnostic {
        let labels = diagnostic.labels.iter().map(|label| label.text.as_str());
        let details: Vec<&str> = labels.chain(diagnostic.notes.iter().map(String::as_str)).collect();
        let mut named = self.named_in(&[&diagnostic.message]);
        if named.is_empty() {
            named = self.named_in(&details);
        }
        // from the inside out
        named.sort_by_key(|(part, _)| std::cmp::Reverse(part.matches('.').count()));
        let mut told = 0;
        for (part, span) in named {
            // copies stand in one place, and the first one is enough
            if told < MOST && diagnostic.labels.iter().all(|label| label.span != span) {
                diagnostic = diagnostic.in_part(&part, span);
                told += 1;
            }
        }
        diagnostic
    }

    /// The parts that texts name something of.
    fn named_in(&self, texts: &[&str]) -> Vec<(String, Span)> {
        let is_named = |part: &str| {
            let inside = format!("`{part}.");
            texts.iter().any(|text| text.contains(&inside))
        };
        self.0.iter().filter(|(part, _)| is_named(part)).cloned().collect()
    }
}

/// Messages without those that say of a copy what has been said of another one: the first says how many there are.
fn of_copies_once(said: impl Iterator<Item = Diagnostic>) -> Vec<Diagnostic> {
    let mut once: Vec<Diagnostic> = Vec::new();
    let mut known: FxHashMap<(Code, Option<Span>, String), (usize, usize)> = FxHashMap::default();
    for diagnostic in said {
        let message = without_numbers_of_copies(&diagnostic.message);
        let is_of_copy = message != diagnostic.message;
        let place = diagnostic.labels.first().map(|label| label.span);
        match known.entry((diagnostic.code, place, message)) {
            Entry::Occupied(mut first) if is_of_copy => first.get_mut().1 += 1,
            Entry::Occupied(_) => once.push(diagnostic),
            Entry::Vacant(new) => {
                new.insert((once.len(), 0));
                once.push(diagnostic);
            }
        }
    }
    for (first, others) in known.into_values().filter(|(_, others)| *others > 0) {
        let copies = if others == 1 { "one other copy".to_owned() } else { format!("{others} other copies") };
        once[first].notes.push(format!("it is the same in {copies}"));
    }
    once
}

/// `leg[2].foot` as `leg.foot`.
fn without_numbers_of_copies(message: &str) -> String {
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
