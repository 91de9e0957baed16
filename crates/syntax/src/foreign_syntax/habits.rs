//! Habits from other languages: array sizes behind a name, types, several values for one name.

use super::heads::LONGEST_SHOWN;
use super::{Correction, Foreign, is_name};
use crate::grammar::Rule;
use crate::lexer::tokens;
use mechc_text::vocabulary::{Keyword, Unit};

impl Foreign<'_> {
    /// Corrects `body arm[3]`, `joint pin[n]: …`, `body cell[2, 3]`.
    pub(super) fn array_size(&self, keyword: &str) -> Option<Correction> {
        let [_, name, bracket, ..] = self.before.as_slice() else { return None };
        if !REPEATED.contains(&keyword) || bracket.text != "[" || !is_name(name.text) {
            return None;
        }
        let all = || self.before[3..].iter().chain(&self.rest);
        let inside: Vec<&str> = all().map(|token| token.text).take_while(|text| *text != "]").collect();
        let close = all().nth(inside.len())?;
        let sizes: Vec<&[&str]> = inside.split(|text| *text == ",").collect();
        let indices: Vec<&str> = INDICES.into_iter().filter(|index| !self.is_declared(index)).collect();
        if inside.contains(&"in") || sizes.len() > indices.len() {
            return None;
        }
        let ranges: Option<Vec<String>> = sizes
            .iter()
            .zip(indices)
            .map(|(size, index)| self.range_of(size).map(|range| format!("{index} in {range}")))
            .collect();
        let ranges = ranges?.join(", ");
        let message =
            format!("what is repeated has an index with its range, from 0 on: `{keyword} {}[{ranges}]`", name.text);
        Some(Foreign::change(message, vec![self.edit(bracket.end()..close.start, &ranges)]))
    }

    /// Returns the index range for a size: `3` and `n` count from 0; `1..4` is a range already.
    fn range_of(&self, size: &[&str]) -> Option<String> {
        let first = size.first()?;
        let is_known = first.starts_with(|c: char| c.is_ascii_digit()) || self.is_declared(first);
        let written = size.concat();
        match size {
            _ if is_known && written.contains("..") => Some(written),
            [_] if is_known && !written.contains('.') => Some(format!("0..{written}")),
            _ => None,
        }
    }

    /// Returns whether a declaration in the text defines this name.
    fn is_declared(&self, name: &str) -> bool {
        let declares = |word: &str| Keyword::named(word).is_some_and(|keyword| !keyword.is_joining());
        tokens(self.text).windows(2).any(|pair| pair[1].text == name && declares(pair[0].text))
    }

    /// Corrects `param a: length = 3 mm`, `param a: mm = 3`.
    pub(super) fn type_annotation(&self, keyword: &str) -> Option<Correction> {
        let ([_, name], [colon, kind, equals, value @ ..]) = (self.before.as_slice(), self.rest.as_slice()) else {
            return None;
        };
        let is_type = colon.text == ":" && is_name(kind.text) && equals.text == "=";
        let (true, true, [first, ..]) = (is_type, self.expects(Rule::equals), value) else { return None };
        let unit = Unit::named(kind.text).filter(|_| !value.iter().any(|token| is_name(token.text)));
        let value_text = &self.text[first.start..self.end()];
        let mut edits = vec![self.edit(name.end()..equals.start, " ")];
        let Some(unit) = unit else {
            let shown = if value_text.chars().count() <= LONGEST_SHOWN { value_text } else { "…" };
            let written = format!("{keyword} {} = {shown}", name.text);
            return Some(Foreign::change(format!("a type is not written, its value has one: `{written}`"), edits));
        };
        let unit = unit.word.name;
        let message = format!("a unit stands behind its number: `{keyword} {} = {} {unit}`", name.text, first.text);
        if value.len() > 1 {
            return Some(Correction::Words("a unit stands behind each number, and not behind the name".to_owned()));
        }
        edits.push(self.edit(first.end()..first.end(), &format!(" {unit}")));
        Some(Foreign::change(message, edits))
    }

    /// Corrects `trace path = crank.A, rod.B`, `measure h = x(rod.A), y(rod.A)`, `measure d = crank.A, rod.B`.
    pub(super) fn several_values(&self, keyword: &str) -> Option<Correction> {
        let [_, name, equals, ..] = self.before.as_slice() else { return None };
        let what = match keyword {
            "trace" => "a trace is the path of one point",
            "measure" => "a measure is one number",
            "result" => "a result is one number",
            _ => return None,
        };
        if self.found != "," || equals.text != "=" || !self.is_outside_of_brackets() {
            return None;
        }
        let (values, end) = self.values_in_a_row()?;
        if let ("measure", [from, to], true) = (keyword, &values[..], values.iter().all(|value| is_path(value))) {
            let edits =
                vec![self.edit(self.before[3].start..self.before[3].start, "distance("), self.edit(end..end, ")")];
            return Some(Foreign::change(format!("the distance of two points is `distance({from}, {to})`"), edits));
        }
        let names: Vec<String> = (2..=values.len()).map(|k| format!("{}_{k}", name.text)).collect();
        let apart = format!("{what}: each has its own `{keyword}`");
        if names.iter().any(|name| self.is_declared(name)) {
            return Some(Correction::Words(apart));
        }
        let others: Vec<String> =
            names.iter().zip(&values[1..]).map(|(name, value)| format!("{keyword} {name} = {value}")).collect();
        let each = format!("`{keyword} {} = {}`, `{}`", name.text, values[0], others.join("`, `"));
        let is_short = each.chars().count() <= 2 * LONGEST_SHOWN;
        let message = if is_short { format!("{what}: {each}") } else { apart };
        // a unit behind the last one applies to all
        let unit = &self.text[end..self.end()];
        let gap = format!("{unit}{}", self.gap_between_declarations());
        let rest = format!("{gap}{}{unit}", others.join(&gap));
        Some(Foreign::change(message, vec![self.edit(self.at..self.end(), &rest)]))
    }

    /// Returns the formulas between commas behind `=`, and where the last one ends.
    fn values_in_a_row(&self) -> Option<(Vec<&str>, usize)> {
        let tokens = self.before[3..].iter().chain(&self.rest).take_while(|token| token.text != "in");
        let (mut values, mut depth, mut start, mut end) = (Vec::new(), 0, None, 0);
        for token in tokens {
            match token.text {
                "(" | "[" => depth += 1,
                ")" | "]" => depth -= 1,
                "=" | ":" => return None,
                _ => {}
            }
            if token.text == "," && depth == 0 {
                values.push(&self.text[start.take()?..end]);
            } else {
                start = start.or(Some(token.start));
                end = token.end();
            }
        }
        values.push(&self.text[start?..end]);
        (depth == 0).then_some((values, end))
    }

    /// Returns a line end with the indentation of this declaration, if it begins a line.
    fn gap_between_declarations(&self) -> String {
        let start = self.before.first().map_or(self.at, |token| token.start);
        let before = &self.text[..start];
        let indentation = &before[before.rfind('\n').map_or(0, |at| at + 1)..];
        if !indentation.trim().is_empty() {
            return " ".to_owned();
        }
        let line_end = if self.text.contains("\r\n") { "\r\n" } else { "\n" };
        format!("{line_end}{indentation}")
    }
}

/// Returns whether a text names a feature of a body: `crank.A`.
fn is_path(text: &str) -> bool {
    text.contains('.') && is_name(text) && text.chars().all(|c| c.is_alphanumeric() || "._[]".contains(c))
}

/// Declarations that can have index ranges.
const REPEATED: [&str; 10] =
    ["body", "part", "input", "joint", "constraint", "driver", "load", "measure", "trace", "result"];

/// Usual names of indices.
const INDICES: [&str; 5] = ["k", "i", "j", "m", "n"];
