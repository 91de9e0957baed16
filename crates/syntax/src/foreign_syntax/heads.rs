//! Heads of declarations: missing, split or misplaced names, and missing arguments.

use super::{Correction, Foreign, hyphenated_at, is_name};
use crate::grammar::Rule;
use crate::lexer::{Token, is_word_char, tokens};
use mechc_text::diag::{Applicability, Fix};
use mechc_text::vocabulary::{JointSpec, Keyword, Position, Role, Synonym, is_called, is_declaration};

impl Foreign<'_> {
    /// Returns a correction of the head of a declaration.
    pub(super) fn declaration_head(&self, keyword: &str, last: &Token<'_>) -> Option<Correction> {
        self.hyphenated_name(last)
            .or_else(|| self.name_behind_kind(keyword, last))
            .or_else(|| self.missing_name(keyword, last))
            .or_else(|| self.quoted_name())
            .or_else(|| self.name_of_several_words(keyword))
            .or_else(|| self.missing_argument(keyword, last))
    }

    /// Corrects `small-end`, where a name is declared, with whatever dash.
    fn hyphenated_name(&self, last: &Token<'_>) -> Option<Correction> {
        let keyword = self.before.get(self.before.len().checked_sub(2)?)?.text;
        if !self.found.starts_with(is_dash) || !is_declaration(keyword) {
            return None;
        }
        let name = hyphenated_at(self.text, last.start)?;
        let written = name.replace(is_dash, "_");
        let uses = tokens(self.text).into_iter().filter(|token| hyphenated_at(self.text, token.start) == Some(name));
        let edits = uses.map(|token| self.edit(token.start..token.start + name.len(), &written)).collect();
        Some(Foreign::change(format!("a name has no `{}`: write `{written}`", self.found), edits))
    }

    /// Returns whether the name has been read and the separator behind it is missing.
    fn is_behind_the_name(&self) -> bool {
        let is_separator = [Rule::equals, Rule::colon, Rule::open, Rule::left].iter().any(|rule| self.expects(*rule));
        self.before.len() == 2 && is_separator
    }

    /// Corrects `joint revolute j2(…)`.
    fn name_behind_kind(&self, keyword: &str, last: &Token<'_>) -> Option<Correction> {
        let is_kind = |word: &str| JointSpec::named(word).is_some() || Synonym::of(Position::Joint, word).is_some();
        let is_called = self.rest.get(1).is_some_and(|token| token.text == "(");
        if keyword != "joint" || !self.is_behind_the_name() || JointSpec::named(last.text).is_none() {
            return None;
        }
        if !is_name(self.found) || is_kind(self.found) || !is_called {
            return None;
        }
        let written = format!("{}: {}", self.found, last.text);
        let edit = self.edit(last.start..self.at + self.found.len(), &written);
        let message = format!("the name of a joint stands before its kind: `{written}(…)`");
        Some(Correction::Change(Fix { message, edits: vec![edit], applies: Applicability::Always }))
    }

    /// Corrects `measure der(x(arm.tip))`, `joint: revolute(…)`, `measure (x(arm.tip))`.
    fn missing_name(&self, keyword: &str, last: &Token<'_>) -> Option<Correction> {
        let form = Keyword::named(keyword).filter(|keyword| keyword.role == Role::Declaration)?;
        let form = form.word.forms.first()?;
        if !form.contains("NAME") || keyword == "mechanism" {
            return None;
        }
        let is_named_by_a_call = || match keyword {
            "joint" => JointSpec::named(last.text).is_some(),
            "body" | "fn" | "table" => false,
            _ => is_called(last.text) || Synonym::of(Position::Call, last.text).is_some() || last.text == "der",
        };
        let start = if self.before.len() == 1 && self.expects(Rule::name) && [":", "=", "(", "{"].contains(&self.found)
        {
            self.rest.iter().find(|token| ![":", "="].contains(&token.text)).map(|token| token.start)
        } else if self.is_behind_the_name() && self.found == "(" && is_named_by_a_call() {
            Some(last.start)
        } else {
            return None;
        };
        let words = start.map(|start| self.text[start..self.end()].trim_end());
        let is_short = |words: &&str| !words.is_empty() && words.chars().count() <= LONGEST_SHOWN;
        let separator = form.split_whitespace().nth(1).is_some_and(|name| name.ends_with(':'));
        let head = if separator { format!("{keyword} NAME:") } else { format!("{keyword} NAME =") };
        let written = match words.filter(is_short) {
            Some(words) if keyword != "body" && keyword != "fn" => format!("{head} {words}"),
            _ => (*form).to_owned(),
        };
        Some(Correction::Words(format!("a {keyword} needs a name: `{written}`")))
    }

    /// Corrects `mechanism "crank rocker" {`.
    fn quoted_name(&self) -> Option<Correction> {
        let string = self.rest.first().filter(|token| token.text.len() > 2 && token.text.ends_with('"'))?;
        let words: Vec<&str> =
            string.text.trim_matches('"').split([' ', '-', '_']).filter(|word| !word.is_empty()).collect();
        let name = words.join("_");
        let is_one = is_name(&name) && name.chars().all(is_word_char);
        if self.before.len() != 1 || !self.expects(Rule::name) || !is_one {
            return None;
        }
        let edit = self.edit(string.start..string.end(), &name);
        Some(Foreign::change(format!("a name stands without quotes: `{name}`"), vec![edit]))
    }

    /// Corrects `mechanism crank rocker {`, `joint j 1: …`, `ground g {`.
    fn name_of_several_words(&self, keyword: &str) -> Option<Correction> {
        if keyword == "ground" && self.before.len() == 1 && self.expects(Rule::open) && is_name(self.found) {
            let edit = self.edit(self.before[0].end()..self.at + self.found.len(), "");
            return Some(Foreign::change("the ground has no name: `ground {`".to_owned(), vec![edit]));
        }
        let name = self.before.get(1).filter(|_| self.is_behind_the_name() && !self.expects(Rule::left))?;
        let separators: &[&str] = match keyword {
            "mechanism" | "body" => &["{", "at"],
            "joint" | "driver" | "constraint" => &[":"],
            _ => &["="],
        };
        let end = self.rest.iter().position(|token| separators.contains(&token.text))?;
        let is_part = |token: &Token<'_>| token.text.chars().all(|c| is_word_char(c) || c == '.');
        let parts = &self.rest[..end];
        let is_name_alone = !parts.is_empty() && parts.iter().all(is_part);
        let is_word = |token: &Token<'_>| {
            JointSpec::named(token.text).is_some() || Keyword::named(token.text).is_some_and(Keyword::is_joining)
        };
        if !is_name_alone || parts.iter().any(is_word) {
            return None;
        }
        let last = parts.last()?.end();
        // by its first word it is called elsewhere
        if self.is_used_by(name) {
            let message = format!("a name is one word: `{}`", name.text);
            return Some(Foreign::change(message, vec![self.edit(name.end()..last, "")]));
        }
        let words = std::iter::once(name.text).chain(parts.iter().flat_map(|token| token.text.split('.')));
        let words = words.filter(|word| !word.is_empty());
        let written = words.collect::<Vec<_>>().join("_");
        if !crate::is_name(&written) {
            return None;
        }
        let edit = self.edit(name.start..last, &written);
        Some(Foreign::change(format!("a name is one word: write `{written}`"), vec![edit]))
    }

    /// Returns whether a name that is declared here occurs elsewhere without a declaration.
    fn is_used_by(&self, name: &Token<'_>) -> bool {
        let all = tokens(self.text);
        let is_other = |k: &usize| all[*k].text == name.text && all[*k].start != name.start;
        let others: Vec<usize> = (0..all.len()).filter(is_other).collect();
        let is_declared = |k: &usize| *k > 0 && is_declaration(all[k - 1].text);
        !others.is_empty() && !others.iter().any(is_declared)
    }

    /// Corrects `fn f = 3 * u`, `curve profile u = (…)`, `param f(u) = …`.
    fn missing_argument(&self, keyword: &str, last: &Token<'_>) -> Option<Correction> {
        if !self.is_behind_the_name() {
            return None;
        }
        if keyword == "param" && self.found == "(" && !is_called(last.text) {
            let edit = self.edit(self.before[0].start..self.before[0].end(), "fn");
            return Some(Foreign::change("what has an argument is declared by `fn`".to_owned(), vec![edit]));
        }
        if !self.expects(Rule::left) {
            return None;
        }
        let is_given = is_name(self.found) && self.rest.get(1).is_some_and(|token| token.text == "=");
        let used = || ARGUMENTS.iter().find(|name| self.rest.iter().any(|token| token.text == **name));
        let argument = if is_given { self.found } else { used().copied().unwrap_or("u") };
        let end = if is_given { self.at + self.found.len() } else { last.end() };
        if !is_given && self.found != "=" {
            return None;
        }
        let edit = self.edit(last.end()..end, &format!("({argument})"));
        let message = format!("its argument stands behind the name: `{keyword} {}({argument}) = …`", last.text);
        Some(Foreign::change(message, vec![edit]))
    }
}

/// Longest text that a message repeats, in characters.
pub(super) const LONGEST_SHOWN: usize = 60;

/// Usual names of the argument of a function or curve.
const ARGUMENTS: [&str; 10] = ["u", "v", "w", "x", "phi", "theta", "φ", "θ", "s", "a"];

/// Returns whether a character is a hyphen or a dash that editors and keyboards write for it.
pub(super) fn is_dash(c: char) -> bool {
    ['-', '‐', '‑', '–', '—', '−'].contains(&c)
}
