//! Corrections for declarations as other programs and textbooks write them, where the words are unambiguous.

mod forces;
mod ground;
mod habits;
mod heads;
mod keywords;
mod parts;
mod separators;

use super::grammar::Rule;
use super::keywords::begins_declaration;
use super::lexer::{LexemeKind, Token, is_word_char, tokens, tokens_in};
use heads::is_dash;
use mechc_text::diag::{Applicability, Edit, Fix};
use mechc_text::source::{FileId, Span};
use mechc_text::vocabulary::{Dimension, Keyword, Position, QuantityWord, Role, Synonym, Unit};
use std::ops::Range;

/// A declaration with a fault, by its words before and after the fault.
pub(super) struct Foreign<'a> {
    text: &'a str,
    file: FileId,
    at: usize,
    found: &'a str,
    expected: &'a [Rule],
    /// Words from the keyword to the fault.
    before: Vec<Token<'a>>,
    /// Words from the fault to the end of the line or block, or to the next declaration.
    rest: Vec<Token<'a>>,
    bodies: Vec<&'a str>,
}

/// A suggestion in words or as an edit.
pub(super) enum Correction {
    Words(String),
    Change(Fix),
    /// A declaration that ends too early; reported at its end, and not at the next declaration.
    Incomplete {
        what: String,
        /// Span of the last word or character of the declaration.
        end: Span,
        expected: &'static str,
        correction: Box<Correction>,
    },
}

impl<'a> Foreign<'a> {
    /// Creates the declaration around a word or character at a byte, where other rules were expected.
    pub fn new(text: &'a str, file: FileId, at: usize, found: &'a str, expected: &'a [Rule]) -> Foreign<'a> {
        let all = tokens(&text[..at]);
        let opens = |word: &str| Keyword::named(word).is_some_and(|keyword| keyword.role == Role::Opener);
        let word = |k: usize| all.get(k).map_or("", |token| token.text);
        let is_opener = |k: usize| match all[k].text {
            "load" if k + 1 == all.len() => found == ":",
            "load" | "part" if [":", "["].contains(&word(k + 2)) => true,
            "gravity" | "mass" => {
                let is_named = || word(k + 2) == ":" && is_name(word(k + 1));
                // the next word is the fault itself
                let is_last = k + 1 == all.len() && ["=", ":"].contains(&found) || k + 2 == all.len() && found == ":";
                word(k + 1).starts_with(|c: char| ['(', '-', '.'].contains(&c) || c.is_ascii_digit())
                    || is_named()
                    || is_last
            }
            // a name behind a name begins something, whatever stands behind it
            other => {
                opens(other)
                    && (["=", "["].contains(&word(k + 2)) && is_name(word(k + 1))
                        || k + 2 == all.len() && is_name(word(k + 1)))
            }
        };
        let is_keyword = |k: usize| begins_declaration(text, all[k].range()) || is_opener(k);
        let start = (0..all.len()).rev().find(|&k| is_keyword(k)).unwrap_or(0);
        let bodies = all.windows(2).filter(|pair| pair[0].text == "body").map(|pair| pair[1].text).collect();
        let end = text[at..].find('\n').map_or(text.len(), |end| at + end);
        let is_here =
            |token: &Token<'_>| token.start == at || token.text != "}" && !begins_declaration(text, token.range());
        let rest = tokens_in(text, at..end).into_iter().take_while(is_here).collect();
        Foreign { text, file, at, found, expected, before: all[start.min(all.len())..].to_vec(), rest, bodies }
    }

    /// Returns the correction for the fault, if one is unambiguous.
    pub fn correction(&self) -> Option<Correction> {
        if let Some(correction) = self.missing_keyword() {
            return Some(correction);
        }
        let (keyword, last) = (self.before.first()?.text, self.before.last()?);
        if let Some(half) = self.incomplete_declaration(keyword, last) {
            return Some(half);
        }
        if self.text[last.end()..self.at].contains('\n') {
            return None;
        }
        self.force_declaration(keyword, last)
            .or_else(|| self.array_size(keyword))
            .or_else(|| self.type_annotation(keyword))
            .or_else(|| self.declaration_head(keyword, last))
            .or_else(|| self.bare_arguments(keyword, last))
            .or_else(|| self.ground_feature())
            .or_else(|| self.axis_with_comma(keyword))
            .or_else(|| self.rows_without_parentheses(keyword))
            .or_else(|| self.missing_joint_kind(keyword))
            .or_else(|| self.pose_without_at(keyword, last))
            .or_else(|| self.diameter())
            .or_else(|| self.declaration_list(keyword))
            .or_else(|| self.several_values(keyword))
            .or_else(|| self.point_coordinate(last))
            .or_else(|| self.arrow(last))
            .or_else(|| self.single_quotes())
            .or_else(|| self.unit_behind_pair(last))
            .or_else(|| self.unit_in_brackets(last))
            .or_else(|| self.pair_without_parentheses(keyword, last))
            .or_else(|| self.feature_without_dot(last))
            .or_else(|| self.trailing_unit(keyword, last))
            .or_else(|| self.equation(keyword))
    }

    /// Returns the form of the declaration in words, if nothing better is known.
    pub fn form_as_words(&self) -> Option<Correction> {
        self.form().map(Correction::Words)
    }

    fn expects(&self, rule: Rule) -> bool {
        self.expected.contains(&rule)
    }

    /// Returns whether all brackets of the declaration are closed before the fault.
    fn is_outside_of_brackets(&self) -> bool {
        let count = |bracket: [&str; 2]| self.before.iter().filter(|token| bracket.contains(&token.text)).count();
        count(["(", "["]) == count([")", "]"])
    }

    /// Returns the range of the word or character at the fault.
    fn here(&self) -> Range<usize> {
        self.at..self.at + self.found.len()
    }

    fn is_word(&self) -> bool {
        is_name(self.found)
    }

    fn edit(&self, range: Range<usize>, text: &str) -> Edit {
        let span = Span { file: self.file, start: range.start as u32, end: range.end as u32 };
        Edit { span, text: text.to_owned() }
    }

    fn change(message: String, edits: Vec<Edit>) -> Correction {
        Correction::Change(Fix { message, edits, applies: Applicability::Probably })
    }

    /// Returns the end of the words after the fault.
    fn end(&self) -> usize {
        self.rest.last().map_or(self.at, Token::end)
    }

    /// Corrects `50 [mm]`.
    fn unit_in_brackets(&self, last: &Token<'_>) -> Option<Correction> {
        let (unit, _) = self.text[self.at..].strip_prefix('[')?.split_once(']')?;
        let is_unit = unit.split(['/', '*', '^']).next().is_some_and(|unit| Unit::named(unit.trim()).is_some());
        let is_number = last.kind == LexemeKind::Number;
        (is_unit && is_number).then(|| {
            let unit_only = self.edit(self.at..self.at + unit.len() + 2, unit.trim());
            let message = format!("a unit follows its number without brackets: `{} {}`", last.text, unit.trim());
            Foreign::change(message, vec![unit_only])
        })
    }

    /// Corrects `point A = r, 0`, `at 0, 0, 0`, `along 30 deg`.
    fn pair_without_parentheses(&self, keyword: &str, last: &Token<'_>) -> Option<Correction> {
        let (what, opening) = match keyword {
            "point" => ("a point is a pair", "="),
            "body" => ("a pose is two lengths and an angle", "at"),
            "axis" => ("a direction is a pair", "along"),
            _ => return None,
        };
        let behind = self.before.iter().rposition(|token| token.text == opening)? + 1;
        let start = self.before.get(behind).map_or(self.at, |token| token.start);
        let is_inside = |token: &&Token<'_>| token.text != "{" && token.text != "=";
        let end = self.rest.iter().take_while(is_inside).last()?.end();
        let written = &self.text[start..end];
        let is_direction = self.expects(Rule::paren) && last.text == "along";
        let is_list = between_commas(written).len() > 1 && (is_direction || self.found == ",");
        if !is_list && !is_direction {
            return None;
        }
        Some(if is_list {
            let edits = vec![self.edit(start..start, "("), self.edit(end..end, ")")];
            Foreign::change(format!("{what} in parentheses: `({written})`"), edits)
        } else {
            // of polar coordinates only the angle counts
            let polar = written.strip_prefix("polar(").and_then(|rest| rest.strip_suffix(')'));
            let angle = polar.and_then(|rest| between_commas(rest).get(1).copied()).unwrap_or(written).trim();
            let pair = format!("(cos({angle}), sin({angle}))");
            Foreign::change(format!("{what}; that of an angle is `{pair}`"), vec![self.edit(start..end, &pair)])
        })
    }

    /// Corrects `crank A`.
    fn feature_without_dot(&self, last: &Token<'_>) -> Option<Correction> {
        let is_owner = last.text == "ground" || self.bodies.contains(&last.text);
        let is_in_formula = self.before.iter().any(|token| token.text == "(") && self.before.len() > 2;
        (self.is_word() && is_owner && is_in_formula).then(|| {
            let message = format!("what belongs to a body is written `{}.{}`", last.text, self.found);
            Foreign::change(message, vec![self.edit(last.end()..self.at, ".")])
        })
    }

    /// Corrects `angle(rod) as deg`, `displacement(guide) mm`.
    fn trailing_unit(&self, keyword: &str, last: &Token<'_>) -> Option<Correction> {
        let is_number = last.kind == LexemeKind::Number;
        // `2 pi t` is a product with the time
        if !self.expects(Rule::infix) || is_number && self.found != "in" || self.found == "t" {
            return None;
        }
        let named = |k: usize| {
            let word = self.rest.get(k)?.text;
            let synonym = || Synonym::of(Position::Unit, word).and_then(|synonym| synonym.means.first().copied());
            Unit::named(word).map(|unit| unit.word.name).or_else(synonym)
        };
        let is_joined = ["in", "as"].contains(&self.found) && named(1).is_some();
        if is_number {
            let unit = named(1)?;
            let message = format!("a unit follows its number without `in`: `{} {unit}`", last.text);
            return Some(Foreign::change(message, vec![self.edit(self.at..self.rest.get(1)?.start, "")]));
        }
        let from = usize::from(is_joined);
        let unit = named(from)?;
        if !is_joined && Unit::named(last.text).is_some() {
            return Some(self.adjacent_units(last).unwrap_or_else(|| Foreign::both_ways(unit)));
        }
        let behind: Vec<&str> = self.rest[from + 1..].iter().map(|token| token.text).collect();
        let is_power = |word: &str| word.parse::<u32>().is_ok() || ["/", "*", "^", "-"].contains(&word);
        let is_unit = behind.iter().all(|word| is_power(word) || Unit::named(word).is_some());
        let start = self.before.iter().position(|token| token.text == "=").map(|k| &self.before[k + 1..]);
        let is_printed =
            ["trace", "result"].contains(&keyword) || keyword == "measure" && start.is_some_and(holds_quantity);
        if is_printed && is_unit {
            let unit = unit.to_owned() + &behind.concat();
            let words = format!("the unit in which it is printed stands behind `in`: `in {unit}`");
            let end = if behind.is_empty() { self.rest[from].end() } else { self.end() };
            return Some(Foreign::change(words, vec![self.edit(self.at..end, &format!("in {unit}"))]));
        }
        let unit = match behind[..] {
            ["/", "s"] => format!("({unit}/s)"),
            _ => unit.to_owned(),
        };
        Some(Foreign::both_ways(&unit))
    }

    /// Corrects `3 N m`.
    fn adjacent_units(&self, last: &Token<'_>) -> Option<Correction> {
        let [.., number, _] = self.before.as_slice() else { return None };
        let is_number = number.kind == LexemeKind::Number;
        // an angle is no factor of a unit
        Unit::named(self.found).filter(|unit| is_number && !unit.dimension.is(Dimension::PURE))?;
        let power = match self.rest.get(1..).unwrap_or_default() {
            [sign, exponent, ..] if sign.text == "^" => format!("^{}", exponent.text),
            _ => String::new(),
        };
        let unit = format!("{}*{}{power}", last.text, self.found);
        let message = format!("a product of units is written with `*`: `{} {unit}`", number.text);
        Some(Foreign::change(message, vec![self.edit(last.end()..self.at, "*")]))
    }

    fn both_ways(unit: &str) -> Correction {
        Correction::Words(format!(
            "a unit follows a number only: `… * 1 {unit}` gives it to a pure number, `… / 1 {unit}` takes it away"
        ))
    }

    /// Corrects `rotation(main) speed 600 rpm`.
    fn equation(&self, keyword: &str) -> Option<Correction> {
        let is_equation = ["driver", "constraint"].contains(&keyword);
        if !is_equation || !self.is_word() || !self.expects(Rule::equals) {
            return None;
        }
        let left = self.before.iter().position(|token| token.text == ":").and_then(|k| self.before.get(k + 1))?;
        let left = &self.text[left.start..self.at].trim_end();
        let [first, last] = [self.rest.get(1), self.rest.last()];
        let value = first.zip(last).map(|(first, last)| &self.text[first.start..last.end()]).unwrap_or_default();
        Some(if keyword == "driver" && is_rate(self.rest.get(1..).unwrap_or_default()) {
            let edits = vec![self.edit(self.here(), "="), self.edit(self.end()..self.end(), " * t")];
            Foreign::change(format!("a driver is an equation: `{left} = {value} * t`"), edits)
        } else {
            Correction::Words(format!("a {keyword} is an equation: `{left} = …`"))
        })
    }
}

/// Returns the hyphenated name that begins at a byte.
pub(super) fn hyphenated_at(text: &str, start: usize) -> Option<&str> {
    let rest = &text[start..];
    let mut end = rest.find(|c| !is_word_char(c)).unwrap_or(rest.len());
    let first = end;
    while let Some(next) = rest[end..].strip_prefix(is_dash).filter(|next| next.starts_with(is_word_char)) {
        end = rest.len() - next.len() + next.find(|c| !is_word_char(c)).unwrap_or(next.len());
    }
    (is_name(rest) && end > first).then(|| &rest[..end])
}

fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

fn holds_quantity(formula: &[Token<'_>]) -> bool {
    let is_quantity = |word: &str| word == "der" || QuantityWord::named(word).is_some();
    formula.windows(2).any(|pair| is_quantity(pair[0].text) && pair[1].text == "(")
}

/// Returns whether words are a rate: `600 rpm`, `10 mm/s`.
fn is_rate(words: &[Token<'_>]) -> bool {
    let words: Vec<&str> = words.iter().map(|token| token.text).collect();
    match words[..] {
        [number, unit] => {
            number.parse::<f64>().is_ok() && Unit::named(unit).is_some_and(|u| u.dimension.is(Dimension::RATE))
        }
        [number, unit, "/", per] => number.parse::<f64>().is_ok() && Unit::named(unit).is_some() && per == "s",
        _ => false,
    }
}

/// Splits a list at its commas outside of parentheses.
fn between_commas(list: &str) -> Vec<&str> {
    let mut depth = 0_usize;
    let parted = list.split(|c| {
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        c == ',' && depth == 0
    });
    parted.collect()
}
