//! Removal of faulty outputs: measures, traces and results with errors do not affect the motion, which editors can still show.

use crate::{Checked, Choice};
use mechc_syntax::ast::{Item, ItemKind};
use mechc_text::diag::Diagnostic;
use mechc_text::source::Span;
use mechc_text::world::World;
use std::collections::BTreeSet;

/// Outputs may name outputs; so many rounds remove what depends on those that were removed.
const MAX_ROUNDS: usize = 4;

impl Checked {
    /// Returns whether all errors in its text, in any mechanism, are in measures, traces, results and the analysis.
    #[must_use]
    pub fn has_only_output_errors(&self) -> bool {
        self.faulty_outputs().is_some()
    }

    /// Returns the mechanism without faulty outputs and those that depend on them; all spans stay as they are. `None` if there are other errors, or
    /// none.
    #[must_use]
    pub fn without_faulty_outputs(&self, world: &dyn World) -> Option<Checked> {
        let index = self.index?;
        let (mut checked, mut faulty) = (self.clone(), self.faulty_outputs()?);
        for _ in 0..MAX_ROUNDS {
            let text = &checked.sources().get(checked.file()).text;
            let parsed = checked.parsed.edited(&blanked(text, &faulty));
            // if a brace was blanked, the rest of the text reads differently
            if parsed.mechanisms().len() != checked.parsed.mechanisms().len() {
                return None;
            }
            checked =
                Checked::from_index(&parsed, &crate::imports::read(&parsed, world), index, &Choice::default(), world);
            if checked.is_sound() {
                return Some(checked);
            }
            faulty = checked.faulty_outputs()?;
        }
        None
    }

    /// Returns the spans of the faulty outputs; `None` if there are other errors, or none.
    fn faulty_outputs(&self) -> Option<BTreeSet<Span>> {
        let errors = self.diagnostics().iter().filter(|diagnostic| diagnostic.is_error());
        let spans: Option<BTreeSet<Span>> = errors.map(|error| self.output_of(error)).collect();
        spans.filter(|spans| !spans.is_empty())
    }

    /// Returns the span of the output that an error is in.
    fn output_of(&self, error: &Diagnostic) -> Option<Span> {
        let span = error.labels.first().map(|label| label.span).filter(|span| span.file == self.file())?;
        let mut items = self.parsed.tree().mechanisms.iter().flat_map(|mechanism| &mechanism.items);
        let is_broken = |item: &&Item| matches!(item.kind, ItemKind::Broken { .. }) && item.span.start <= span.start;
        let holds = |item: &&Item| item.span.start <= span.start && span.end <= item.span.end;
        // the parser reports what is missing at the end of a declaration where the next one begins
        let is_of_syntax = self.parsed.faults().iter().any(|fault| fault == error);
        let item = if is_of_syntax { items.rfind(is_broken) } else { items.find(holds) }?;
        self.is_output(item).then_some(item.span)
    }

    fn is_output(&self, item: &Item) -> bool {
        match &item.kind {
            ItemKind::Measure { .. }
            | ItemKind::Trace { .. }
            | ItemKind::Result { .. }
            | ItemKind::Requirement(_)
            | ItemKind::Analysis { .. } => true,
            // a broken declaration is classified by its first word
            ItemKind::Broken { .. } => {
                let text = self.sources().text(item.span);
                let is =
                    |word: &&str| text.strip_prefix(*word).is_some_and(|rest| rest.starts_with(char::is_whitespace));
                // a brace may belong to another declaration
                ["measure", "trace", "result", "require", "analysis"].iter().any(is) && !text.contains(['{', '}'])
            }
            _ => false,
        }
    }
}

/// Replaces spans of a text by spaces, byte for byte.
fn blanked(text: &str, spans: &BTreeSet<Span>) -> String {
    let (mut blanked, mut end) = (String::with_capacity(text.len()), 0);
    for span in spans {
        let range = span.start as usize..span.end as usize;
        blanked += &text[end..range.start];
        blanked.extend(text[range.clone()].bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' }));
        end = range.end;
    }
    blanked + &text[end..]
}

#[cfg(test)]
mod tests {
    use crate::{Choice, Parsed};
    use mechc_text::world::Memory;

    const DISC: &str = "mechanism disc {
    ground { point O = (0, 0) }
    body wheel { point O = (0, 0) }
    joint axle: revolute(ground.O, wheel.O)
    MORE
}";

    /// Returns the text that remains after the part that all cases share.
    fn remainder(more: &str) -> Option<String> {
        let text = DISC.replace("MORE", more);
        let world = Memory::default();
        let checked = Parsed::new("disc.mech", &text).check(&Choice::default(), &world);
        let remainder = checked.without_faulty_outputs(&world);
        assert!(remainder.is_none() || checked.has_only_output_errors());
        remainder.map(|remainder| {
            remainder
                .sources()
                .get(remainder.file())
                .text
                .trim_start_matches(DISC.split("MORE").next().unwrap())
                .to_owned()
        })
    }

    #[test]
    fn outputs_that_are_wrong_are_left_out() {
        assert_eq!(remainder("measure half = 2 *").as_deref().map(str::trim), Some("}"));
        assert_eq!(remainder("measure a = 2 *\n    measure b = t").as_deref().map(str::trim), Some("measure b = t\n}"));
        assert_eq!(remainder("trace p = wheel.Q").as_deref().map(str::trim), Some("}"));
        // a result whose measure was removed
        assert_eq!(remainder("measure a = 1 mm + 1 s\n    result b = max(a)").as_deref().map(str::trim), Some("}"));
    }

    #[test]
    fn what_moves_is_not_left_out() {
        assert_eq!(remainder("joint b: revolute(ground.O, wheel.)"), None);
        assert_eq!(remainder("measure a = 2 *\n    driver d: rotation(axl) = t"), None);
        assert_eq!(remainder("measure a = t"), None, "nothing is wrong");
    }
}
