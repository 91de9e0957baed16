//! Contents of a declaration: arguments without parentheses, incomplete features, table rows that are not pairs.

use super::{Correction, Foreign, is_name};
use crate::grammar::Rule;
use crate::keywords::begins_declaration;
use crate::lexer::Token;
use mechc_text::diag::{Applicability, Fix};
use mechc_text::vocabulary::{JointSpec, Keyword, QuantityWord, Role};

impl Foreign<'_> {
    /// Corrects `joint j: revolute A, B`, `rotation j = …`, `x arm.tip`.
    pub(super) fn bare_arguments(&self, keyword: &str, last: &Token<'_>) -> Option<Correction> {
        let is_kind = keyword == "joint" && last.text == ":" && JointSpec::named(self.found).is_some();
        let (called, arguments) =
            if is_kind { (self.rest.first()?, self.rest.get(1..)?) } else { (last, self.rest.as_slice()) };
        let is_operand = arguments.first().is_some_and(|token| is_name(token.text));
        let is_quantity = is_operand && self.is_quantity_without_parentheses(last);
        if !is_kind && !is_quantity {
            return None;
        }
        let is_part = |token: &&Token<'_>| [".", ","].contains(&token.text) || token.text.chars().all(is_of_a_word);
        let parts: Vec<&Token<'_>> = arguments.iter().take_while(is_part).collect();
        let (Some(first), Some(end)) = (parts.first(), parts.last()) else {
            let form = JointSpec::named(called.text)?.word.written();
            return Some(Correction::Words(format!("what a joint is of stands in parentheses: {form}")));
        };
        let behind = self.text[end.end()..].trim_start();
        let written = format!("{}({})", called.text, &self.text[first.start..end.end()]);
        let message = format!("arguments stand in parentheses: `{written}`");
        if behind.starts_with(['(', '[', '{']) {
            return Some(Correction::Words(message));
        }
        let edit = self.edit(called.start..end.end(), &written);
        Some(Foreign::change(message, vec![edit]))
    }

    /// Returns whether a quantity lacks its parentheses; the argument of `x` and `y` must be a point, since these may be names.
    fn is_quantity_without_parentheses(&self, last: &Token<'_>) -> bool {
        let is_point = self.rest.get(1).is_some_and(|token| token.text == ".");
        let is_in_a_line = !self.text[last.end()..self.at].contains('\n');
        let is_quantity = QuantityWord::named(last.text).is_some() && (last.text.len() > 1 || is_point);
        is_quantity && is_in_a_line && self.expects(Rule::infix)
    }

    /// Corrects `axis way = top, (0, -1)`.
    pub(super) fn axis_with_comma(&self, keyword: &str) -> Option<Correction> {
        if keyword != "axis" || self.found != "," || !self.expects(Rule::along) {
            return None;
        }
        let next = self.rest.get(1)?;
        let word = if next.text == "(" { "along" } else { "to" };
        let message = format!("write `{word}` instead of the `,`");
        Some(Foreign::change(message, vec![self.edit(self.before.last()?.end()..next.start, &format!(" {word} "))]))
    }

    /// Corrects `circle c = (0, 0, 6 mm)`, `axis a = (0, 1)`, `load push: 20 N`, at the end of a declaration; reported at that end.
    pub(super) fn incomplete_declaration(&self, keyword: &str, last: &Token<'_>) -> Option<Correction> {
        let expected = match keyword {
            "circle" if self.expects(Rule::radius) => "`radius`",
            "axis" if self.expects(Rule::along) => "`along` or `to`",
            "load" if self.expects(Rule::kw_on) => "`on`",
            _ => return None,
        };
        let begins = begins_declaration(self.text, self.here());
        let is_opener = || Keyword::named(self.found).is_some_and(|keyword| keyword.role == Role::Opener);
        let begins = begins || self.text[last.end()..self.at].contains('\n') && is_opener();
        let is_at_end = begins || self.found == "}" || self.found.is_empty();
        if !is_at_end {
            return None;
        }
        let form = || {
            Correction::Words(format!(
                "it is written {}",
                Keyword::named(keyword).map_or(String::new(), |k| k.word.written())
            ))
        };
        let correction = if keyword == "circle" { self.radius_among_coordinates(last) } else { None };
        Some(Correction::Incomplete {
            what: format!("{keyword} `{}`", self.before.get(1)?.text),
            end: self.edit(last.start..last.end(), "").span,
            expected,
            correction: Box::new(correction.unwrap_or_else(form)),
        })
    }

    /// Corrects `circle c = (0, 0, 6 mm)`.
    fn radius_among_coordinates(&self, last: &Token<'_>) -> Option<Correction> {
        let place = self.before.get(3..)?;
        let commas: Vec<usize> = (0..place.len()).filter(|&k| place[k].text == ",").collect();
        let is_flat = place.iter().filter(|token| token.text == "(").count() == 1;
        let (&[_, comma], true) = (commas.as_slice(), is_flat && last.text == ")") else { return None };
        let start = place[0].start;
        let radius = self.text[place.get(comma + 1)?.start..last.start].trim_end();
        let written = format!("{}) radius {radius}", &self.text[start..place[comma - 1].end()]);
        let edit = self.edit(start..last.end(), &written);
        Some(Foreign::change(format!("the radius stands behind the center: `{written}`"), vec![edit]))
    }

    /// Corrects `body b (0, 0, 0) {`, `body b { at (0, 0, 0) …`.
    pub(super) fn pose_without_at(&self, keyword: &str, last: &Token<'_>) -> Option<Correction> {
        let [_, name, ..] = self.before.as_slice() else { return None };
        if keyword != "body" {
            return None;
        }
        if self.found == "(" && self.expects(Rule::at) {
            let edits = vec![self.edit(self.at..self.at, if last.end() < self.at { "at " } else { " at " })];
            let message = "write `at` before `(`".to_owned();
            return Some(Correction::Change(Fix { message, edits, applies: Applicability::Always }));
        }
        if self.found != "at" || last.text != "{" || self.before.len() != 3 {
            return None;
        }
        let close = self.rest.iter().find(|token| token.text == ")")?;
        let pose = &self.text[self.at..close.end()];
        let edit = self.edit(last.start..close.end(), &format!("{pose} {{"));
        Some(Foreign::change(format!("the pose stands before the `{{`: `body {} {pose} {{`", name.text), vec![edit]))
    }

    /// Corrects `circle c = P diameter 12 mm`.
    pub(super) fn diameter(&self) -> Option<Correction> {
        let is_one = ["diameter", "dia", "d", "Ø"].contains(&self.found) && self.expects(Rule::radius);
        let [_, first, ..] = self.rest.as_slice() else { return None };
        let value = is_one.then(|| &self.text[first.start..self.end()])?;
        let edits = vec![self.edit(self.here(), "radius"), self.edit(self.end()..self.end(), " / 2")];
        Some(Foreign::change(format!("a circle has a radius: `radius {value} / 2`"), edits))
    }

    /// Corrects `spline [0 0, 1 1]`.
    pub(super) fn rows_without_parentheses(&self, keyword: &str) -> Option<Correction> {
        let open = self.before.iter().rposition(|token| token.text == "[")?;
        let begins_operand = self.found.starts_with(|c: char| c.is_alphanumeric() || c == '-');
        let has_parentheses = self.before[open..].iter().any(|token| token.text == "(");
        if keyword != "table" || has_parentheses || !begins_operand || !self.expects(Rule::infix) {
            return None;
        }
        let message = "a row is a pair in parentheses: `(0, 0), (1, 2)`";
        let all = || self.before[open + 1..].iter().chain(&self.rest);
        let row: Vec<&str> = all().map(|token| token.text).take_while(|text| *text != "]").collect();
        let is_pair = |row: &[&str]| row.len() == 2 && row.iter().all(|number| number.parse::<f64>().is_ok());
        let close = all().nth(row.len()).filter(|_| row.split(|text| *text == ",").all(is_pair));
        let Some(close) = close else { return Some(Correction::Words(message.to_owned())) };
        let rows: Vec<String> =
            row.split(|text| *text == ",").map(|pair| format!("({}, {})", pair[0], pair[1])).collect();
        let edit = self.edit(self.before[open].end()..close.start, &rows.join(", "));
        Some(Foreign::change(message.to_owned(), vec![edit]))
    }
}

fn is_of_a_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}
