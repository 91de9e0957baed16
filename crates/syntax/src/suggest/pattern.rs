//! Patterns over the tokens around a fault, and the corrections that fill in what they matched.
//!
//! A pattern is a list of items with spaces between them. It begins with the keyword of the declaration, unless its first item is `…`; that of
//! something which begins no declaration begins at the fault.
//!
//! | item | matches |
//! | --- | --- |
//! | `…` | any tokens, or none |
//! | `ANY` | one token or more, with all their brackets closed |
//! | `NAME`, `NUM` and others | a kind of tokens, see [`Line::length`] |
//! | `a\|NUM` | one of several |
//! | `!a\|b` | no token, if none of these is next |
//! | `@` | no token, if the fault is next |
//! | `~` | no token, if no white space is here |
//! | `$` | no token, if the line, the block or the declaration ends here |
//! | `«`, `»` | no token: the beginning and the end of what is replaced |
//! | other text | this token |
//!
//! Kinds of tokens, and items with several, are captured. `{1}` stands for the first in a message or a replacement, `{form 1}` for the form
//! of the word in the language, and `{=}` in a message for the replacement. `{free 1}` is the first letter for an index that the text does not
//! use, `{free 2}` the second.

use super::{Fault, is_name};
use crate::lexer::{LexemeKind, Lexer, Token, is_word_char, tokens};
use mechc_text::diag::{Applicability, Fix};
use mechc_text::vocabulary::{
    JointSpec, Keyword, Position, QuantityWord, ReductionWord, Synonym, Unit, is_called, is_declaration, is_feature,
    is_one_argument_function,
};
use std::ops::Range;

/// Longest text that a message repeats, in characters.
const LONGEST_SHOWN: usize = 60;

/// The tokens of a line that takes part in a match.
pub(super) struct Line<'a> {
    pub text: &'a str,
    pub tokens: &'a [Token<'a>],
    /// Index of the token at the fault; the number of tokens if the fault is behind them.
    pub fault: usize,
    /// Names of the bodies of the text.
    pub bodies: &'a [&'a str],
}

/// What a pattern matched.
#[derive(Default)]
pub(super) struct Match<'p> {
    captures: Vec<(&'p str, Range<usize>)>,
    /// Tokens to replace.
    region: [usize; 2],
}

impl Line<'_> {
    /// Matches a pattern with the line from its beginning.
    pub fn matched<'p>(&self, pattern: &'p str) -> Option<Match<'p>> {
        let items: Vec<&str> = pattern.split(' ').collect();
        let mut found = Match::default();
        self.matches(&items, 0, &mut found).then_some(found)
    }

    fn matches<'p>(&self, items: &[&'p str], k: usize, found: &mut Match<'p>) -> bool {
        let Some((&item, rest)) = items.split_first() else { return true };
        let is_here = match item {
            "«" | "»" => {
                found.region[usize::from(item == "»")] = k;
                true
            }
            "@" => k == self.fault,
            "$" => k == self.tokens.len(),
            "~" => k > 0 && self.tokens.get(k).is_some_and(|token| token.start == self.tokens[k - 1].end()),
            "…" => return (k..=self.tokens.len()).any(|end| self.matches(rest, end, found)),
            "ANY" => return self.balanced(k).any(|end| self.captured(item, k..end, rest, found)),
            _ => match item.strip_prefix('!').filter(|excluded| !excluded.is_empty()) {
                Some(excluded) => excluded.split('|').all(|item| self.length(item, k).is_none()),
                None => return self.one_of(item, k, rest, found),
            },
        };
        is_here && self.matches(rest, k, found)
    }

    fn one_of<'p>(&self, item: &'p str, k: usize, rest: &[&'p str], found: &mut Match<'p>) -> bool {
        let is_captured = item.contains('|') || is_kind(item);
        item.split('|').any(|item| match self.length(item, k) {
            Some(length) if is_captured => self.captured(item, k..k + length, rest, found),
            Some(length) => self.matches(rest, k + length, found),
            None => false,
        })
    }

    fn captured<'p>(&self, item: &'p str, range: Range<usize>, rest: &[&'p str], found: &mut Match<'p>) -> bool {
        let end = range.end;
        found.captures.push((item, range));
        let is_one = self.matches(rest, end, found);
        if !is_one {
            found.captures.pop();
        }
        is_one
    }

    /// Returns the ends of the tokens from one on in which all brackets are closed.
    fn balanced(&self, start: usize) -> impl Iterator<Item = usize> {
        let mut depth = 0_i32;
        let depths = self.tokens[start..].iter().map(move |token| {
            depth += i32::from(matches!(token.text, "(" | "[")) - i32::from(matches!(token.text, ")" | "]"));
            depth
        });
        let is_inside = |token: &Token<'_>| matches!(token.text, "{" | "}");
        let until = self.tokens[start..].iter().position(is_inside).unwrap_or(self.tokens.len() - start);
        depths
            .take(until)
            .take_while(|depth| *depth >= 0)
            .enumerate()
            .filter(|(_, depth)| *depth == 0)
            .map(move |(k, _)| start + k + 1)
    }

    /// Returns the number of tokens of a kind from one on.
    fn length(&self, kind: &str, k: usize) -> Option<usize> {
        let token = self.tokens.get(k)?;
        let word = token.text;
        let run =
            |is_part: &dyn Fn(&Token<'_>) -> bool| self.tokens[k..].iter().take_while(|token| is_part(token)).count();
        let length = match kind {
            "NAME" => usize::from(is_name(word)),
            // a word or number, as names of several words have them
            "WORD" => usize::from(
                word.chars().all(is_word_char)
                    && !Keyword::named(word).is_some_and(Keyword::is_joining)
                    && !is_joint(word),
            ),
            "NUM" => match self.tokens.get(k + 1) {
                _ if token.kind == LexemeKind::Number => 1,
                Some(next) if word == "-" && next.kind == LexemeKind::Number => 2,
                _ => 0,
            },
            "UNIT" => usize::from(unit(word).is_some()),
            "UNITS" if unit(word).is_none() => 0,
            "UNITS" => run(&|token| {
                unit(token.text).is_some()
                    || ["/", "*", "^", "-"].contains(&token.text)
                    || token.kind == LexemeKind::Number
            }),
            "JOINT" => usize::from(is_joint(word)),
            "KIND" => usize::from(JointSpec::named(word).is_some()),
            // single letters may be names
            "QUANTITY" => usize::from(word.len() > 1 && QuantityWord::named(word).is_some()),
            "REDUCTION" => usize::from(ReductionWord::named(word).is_some()),
            "FUNCTION" => usize::from(is_one_argument_function(word)),
            "CALLED" => usize::from(is_called(word) || Synonym::of(Position::Call, word).is_some()),
            "BODY" => usize::from(word == "ground" || self.bodies.contains(&word)),
            // a keyword with a name and `:`, and one with a name and `=`
            "COLON" => usize::from(["joint", "driver", "constraint", "load", "part"].contains(&word)),
            "EQUALS" => usize::from(
                ["param", "measure", "trace", "result", "input", "table", "point", "axis", "circle"].contains(&word),
            ),
            "DECLARATION" => usize::from(is_declaration(word) || is_feature(word)),
            "REPEATED" => usize::from(
                ["body", "part", "input", "joint", "constraint", "driver", "load", "measure", "trace", "result"]
                    .contains(&word),
            ),
            "ARGUMENT" => usize::from(["u", "v", "w", "x", "phi", "theta", "φ", "θ", "s", "a"].contains(&word)),
            "WHOLE" => usize::from(word.bytes().all(|byte| byte.is_ascii_digit())),
            // the name of something in the text
            "QUOTED" => {
                let name = string_as_name(word).filter(|_| token.kind == LexemeKind::String);
                let is_known =
                    |name: &str| tokens(self.text).iter().any(|token| name.split('.').next() == Some(token.text));
                usize::from(name.is_some_and(|name| is_known(&name)))
            }
            "FREE" => usize::from(is_name(word) && Keyword::named(word).is_none()),
            "REST" => self.tokens.len() - k,
            "TEXT" => usize::from(token.kind == LexemeKind::String),
            "STRING" => usize::from(token.kind == LexemeKind::String && string_as_name(word).is_some()),
            "QUOTE" => usize::from(["'", "‘", "’", "`", "“", "”"].contains(&word)),
            "BAR" => usize::from(word == "|"),
            // a name, with indices behind it
            "NAMED" => match self.tokens.get(k + 1) {
                _ if !is_name(word) => 0,
                Some(next) if next.text == "[" => self.balanced(k + 1).next()? - k,
                _ => 1,
            },
            "PATH" => {
                let mut length = usize::from(is_name(word));
                let is_dot = |k: usize| self.tokens.get(k).is_some_and(|token| token.text == ".");
                while length > 0
                    && is_dot(k + length)
                    && self.tokens.get(k + length + 1).is_some_and(|next| is_name(next.text))
                {
                    length += 2;
                }
                length
            }
            "PATHS" => {
                let length = run(&|token| is_name(token.text) || [".", ","].contains(&token.text));
                length - usize::from(length > 0 && self.tokens[k + length - 1].text == ",")
            }
            "GLUED" if token.kind == LexemeKind::String => 0,
            "GLUED" => 1 + self.tokens[k..].windows(2).take_while(|pair| pair[0].end() == pair[1].start).count(),
            _ => usize::from(word == kind),
        };
        (length > 0).then_some(length)
    }

    /// Returns the text of a capture, with words of the language for those of other programs.
    fn shown(&self, (kind, range): &(&str, Range<usize>)) -> String {
        let text = &self.text[self.tokens[range.start].start..self.tokens[range.end - 1].end()];
        match *kind {
            "JOINT" => joint(text).to_owned(),
            "UNIT" => unit(text).unwrap_or(text).to_owned(),
            "STRING" | "QUOTED" => string_as_name(text).unwrap_or_default(),
            "GLUED" => text.trim_matches(['\'', '<', '>', ';']).to_owned(),
            _ => text.to_owned(),
        }
    }

    /// Fills captures into a template.
    pub fn filled(&self, template: &str, found: &Match<'_>, is_message: bool) -> String {
        let mut text = String::new();
        let mut rest = template;
        while let Some((before, after)) = rest.split_once('{') {
            let Some((gap, after)) = after.split_once('}').filter(|(gap, _)| number_of(gap).is_some()) else {
                text = text + before + "{";
                rest = after;
                continue;
            };
            let number = number_of(gap).and_then(|k| k.checked_sub(1));
            let shown = number.and_then(|k| found.captures.get(k)).map(|capture| self.shown(capture));
            let shown = shown.unwrap_or_default();
            text += before;
            text += &match JointSpec::named(&shown) {
                _ if gap.starts_with("free") => {
                    number.and_then(|k| self.free_indices().nth(k)).unwrap_or("k").to_owned()
                }
                Some(joint) if gap.starts_with("form") => joint.word.written(),
                _ if is_message && shown.chars().count() > LONGEST_SHOWN => "…".to_owned(),
                _ => shown,
            };
            rest = after;
        }
        text + rest
    }

    /// Returns letters for indices that the text does not use.
    fn free_indices(&self) -> impl Iterator<Item = &'static str> {
        let used: Vec<&str> = tokens(self.text).iter().map(|token| token.text).collect();
        ["k", "i", "j", "n", "p", "q"].into_iter().filter(move |letter| !used.contains(letter))
    }

    /// Returns the bytes to replace. White space next to them belongs to them if the replacement brings its own.
    fn bytes(&self, [start, end]: [usize; 2], replacement: &str) -> Range<usize> {
        let end_before = start.checked_sub(1).map(|k| self.tokens[k].end());
        let start_behind = self.tokens.get(end).map(|token| token.start);
        let first = self.tokens.get(start).map_or(self.text.len(), |token| token.start);
        let is_gap = start == end;
        let last = end.checked_sub(1).map_or(first, |k| self.tokens[k].end());
        let is_apart = start_behind.is_none_or(|behind| behind > last);
        let from = match end_before {
            Some(before) if is_gap || replacement.starts_with([' ', '.', ':']) => before,
            Some(before) if replacement.is_empty() && is_apart => before,
            _ => first,
        };
        let to = match start_behind {
            Some(behind) if is_gap || replacement.ends_with([' ', '.']) => behind,
            _ if is_gap => from,
            _ => last,
        };
        from..to
    }

    /// Returns the fix that replaces what a pattern matched; `None` if a comment would be lost.
    pub fn fix(
        &self,
        found: &Match<'_>,
        replacement: &str,
        message: &str,
        applies: Applicability,
        fault: &Fault<'_>,
    ) -> Option<Fix> {
        let bytes = self.bytes(found.region, replacement);
        if Lexer::new(&self.text[..bytes.end], bytes.start).any(|token| token.is_comment()) {
            return None;
        }
        let text = self.filled(replacement, found, false);
        let message = self.filled(&message.replace("{=}", replacement.trim()), found, true);
        Some(Fix::replace(fault.span(bytes), text, message, applies))
    }
}

/// Returns the number in a gap of a template.
fn number_of(gap: &str) -> Option<usize> {
    gap.trim_start_matches("form ").trim_start_matches("free ").parse().ok()
}

/// Returns whether an item names a kind of tokens.
fn is_kind(item: &str) -> bool {
    item.len() > 2 && item.chars().all(|c| c.is_ascii_uppercase())
}

/// Returns the language's name of a kind of joint.
fn joint(word: &str) -> &str {
    Synonym::of(Position::Joint, word).and_then(|synonym| synonym.means().next()).unwrap_or(word)
}

pub(super) fn is_joint(word: &str) -> bool {
    JointSpec::named(joint(word)).is_some()
}

/// Returns the language's name of a unit; `t` is the time.
fn unit(word: &str) -> Option<&'static str> {
    let synonym = || Synonym::of(Position::Unit, word).filter(|synonym| synonym.is_same && is_name(word));
    Unit::named(word).map(|unit| unit.word.name).or_else(|| synonym()?.means().next())
}

/// Returns the name that a string holds, its words joined.
fn string_as_name(string: &str) -> Option<String> {
    let words = string.trim_matches('"').split([' ', '-', '_']).filter(|word| !word.is_empty());
    let name = words.collect::<Vec<_>>().join("_");
    let is_path = name.split('.').all(|part| is_name(part) && part.chars().all(is_word_char));
    (is_path && string.len() > 2 && string.ends_with('"')).then_some(name)
}
