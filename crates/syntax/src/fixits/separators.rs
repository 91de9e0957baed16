//! A missing or wrong `:` or `=` behind a name.

use super::Fault;
use crate::lexer::tokens;
use mechc_text::diag::{Applicability, Fix};
use mechc_text::vocabulary::{JointSpec, Position, QuantityWord, Synonym, is_called};

/// Separators behind a name, by their description, with the wrong one.
const SEPARATORS: [(&str, &str, &str); 2] = [("`:`", ":", "="), ("`=`", "=", ":")];

impl Fault<'_> {
    /// Inserts the `:` or `=` behind a name, where nothing else is possible.
    pub(super) fn separator(&self, expected: &str) -> Option<Fix> {
        let (_, separator, other) = SEPARATORS.into_iter().find(|(name, ..)| *name == expected)?;
        if self.found == other {
            return Some(self.other_separator(separator));
        }
        let begins_operand = self.found.starts_with(|c: char| c.is_alphanumeric() || c == '_' || c == '(');
        if self.is_on_new_line() || !begins_operand || self.begins_declaration() {
            return None;
        }
        let applies = self.is_separated_by(separator)?;
        let words = format!("write `{separator}` before `{}`", self.found);
        let place = self.before().len();
        let (place, text) = match separator {
            ":" => (place, ":"),
            _ if place < self.at => (self.at, "= "),
            _ => (place, " = "),
        };
        Some(Fix::replace(self.span(place..place), text, words, applies))
    }

    /// Corrects `param a: 3`, `joint j = …`, `param a := 3`.
    fn other_separator(&self, separator: &str) -> Fix {
        let is_both = self.found == ":" && self.behind().starts_with('=');
        let end = self.here().end + usize::from(is_both);
        let written = if is_both { ":=" } else { self.found };
        let words = format!("write `{separator}` instead of `{written}`");
        let before = self.before().len();
        let (start, gap) = match separator {
            ":" => (before, ""),
            _ => (self.at, if before == self.at { " " } else { "" }),
        };
        let gap_behind = if self.text[end..].starts_with(char::is_whitespace) { "" } else { " " };
        Fix::replace(self.span(start..end), format!("{gap}{separator}{gap_behind}"), words, Applicability::Always)
    }

    /// Returns whether the name ends here and its value begins, and how certain that is; a superfluous word may precede it.
    fn is_separated_by(&self, separator: &str) -> Option<Applicability> {
        let before = tokens(self.before());
        let [.., keyword, _] = before.as_slice() else { return None };
        let line = self.behind().lines().next().unwrap_or_default();
        let is_equation = ["driver", "constraint"].contains(&keyword.text);
        if line.contains(':') || line.contains('=') != is_equation {
            return None;
        }
        let behind = self.behind().trim_start();
        let is_call = behind.starts_with(['(', '{', '[']);
        let is_gap = self.before().len() < self.at;
        let is_sure = match (separator, self.found) {
            (":", word) if is_equation => is_call && QuantityWord::named(word).is_some(),
            (":", word) => {
                is_call && (JointSpec::named(word).is_some() || Synonym::of(Position::Joint, word).is_some())
            }
            (_, "(") => is_gap || keyword.text == "point",
            (_, "spline" | "periodic") => true,
            (_, word) if word.starts_with(|c: char| c.is_ascii_digit()) => true,
            (_, word) => is_call && is_called(word) || ["axis", "circle"].contains(&keyword.text),
        };
        Some(if is_sure { Applicability::Always } else { Applicability::Probably })
    }
}
