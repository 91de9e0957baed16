//! Characters that other languages, keyboards and calculators use, and this one does not.

use super::{Fault, Mend};
use crate::diag::{Applies, Edit, Fix};
use crate::syntax::grammar::Rule;
use crate::syntax::tokens::tokens;
use std::ops::Range;

/// Characters that can only mean another one: what to write instead, and what to say.
const WRITTEN: &[(&str, &str, &str)] = &[
    ("×", "*", "a product is written with `*`"),
    ("·", "*", "a product is written with `*`"),
    ("÷", "/", "a quotient is written with `/`"),
    ("−", "-", "a minus sign is written `-`"),
    ("–", "-", "a minus sign is written `-`"),
];

/// Where one of these is expected an operand begins.
const OPERAND: [Rule; 5] = [Rule::expr, Rule::prefix, Rule::literal, Rule::number, Rule::call];

impl Fault<'_> {
    pub(super) fn of_a_character(&self) -> Option<Mend> {
        if let Some((_, text, words)) = WRITTEN.iter().find(|(written, ..)| *written == self.found) {
            return Some(Mend::Fix(self.everywhere_on_the_line(text, words)));
        }
        let (before, behind) = (self.before(), self.behind());
        let around = self.opened().last().map_or("", |(_, token)| *token);
        Some(match self.found {
            "=" if self.text[..self.at].ends_with('=') => {
                self.replaced(self.at - 1..self.at + 1, "=", "an equation is written with one `=`", Applies::Always)
            }
            "==" if self.expects(Rule::equals) => {
                self.replaced(self.here(), "=", "an equation is written with one `=`", Applies::Always)
            }
            "=" if self.expects(Rule::kw_then) => {
                self.replaced(self.here(), "==", "a comparison is written `==`", Applies::Always)
            }
            "+" if OPERAND.iter().any(|rule| self.expects(*rule)) => self.left_out("a positive number needs no sign"),
            ";" => self.of_a_semicolon(around),
            "*" if self.text[..self.at].ends_with('*') => {
                self.replaced(self.at - 1..self.at + 1, "^", "a power is written with `^`", Applies::Always)
            }
            "*" if self.text[..self.at].ends_with('/') => self.of_a_comment(self.at - 1),
            "/" if behind.starts_with('*') => self.of_a_comment(self.at),
            "#" => {
                let marks = 1 + behind.len() - behind.trim_start_matches('#').len();
                let range = self.at..self.at + marks;
                self.replaced(range, "//", "a comment begins with `//`", Applies::Always)
            }
            "°" => self.of_degrees(),
            "²" => self.replaced(self.here(), "^2", "a square is written `^2`", Applies::Always),
            "³" => self.replaced(self.here(), "^3", "a cube is written `^3`", Applies::Always),
            "\"" if behind.lines().next().is_some_and(|line| line.contains('"')) => {
                Mend::words("text in quotes is the file of a `table`, and stands nowhere else")
            }
            "\"" => Mend::words("a string ends on the line where it begins"),
            "," if self.is_head_of_fn() => Mend::words("a `fn` has one argument: what else it needs can be a `param`"),
            "," | "." => return self.of_a_decimal(),
            "(" if around == "[" && before.ends_with(')') => {
                let end = before.len();
                self.replaced(end..end, ",", "rows are separated by commas: `(1, 2), (3, 4)`", Applies::Always)
            }
            _ => return None,
        })
    }

    /// The same character wherever it stands from here to the end of the line.
    fn everywhere_on_the_line(&self, by: &str, words: &str) -> Fix {
        let line = self.text[self.at..].lines().next().unwrap_or_default();
        let same = tokens(line).into_iter().filter(|token| token.text == self.found);
        let edits = same
            .map(|token| Edit { span: self.span(self.at + token.start..self.at + token.end()), text: by.to_owned() })
            .collect();
        Fix { message: words.to_owned(), edits, applies: Applies::Always }
    }

    fn left_out(&self, words: &str) -> Mend {
        let Range { start, end } = self.here();
        let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
        let joins = self.text[..start].ends_with(is_word) && self.text[end..].starts_with(is_word);
        self.replaced(start..end, if joins { " " } else { "" }, words, Applies::Always)
    }

    fn of_a_semicolon(&self, around: &str) -> Mend {
        let rows = "rows are separated by commas: `(1, 2), (3, 4)`";
        match around {
            "[" => self.replaced(self.here(), ",", rows, Applies::Always),
            // closed on its line, it goes on behind the semicolon
            "(" if self.expects(Rule::comma) && self.is_closed_on_the_line() => {
                self.replaced(self.here(), ",", "what stands in parentheses is separated by commas", Applies::Always)
            }
            "(" => Mend::words("declarations need no terminator; leave the `;` out"),
            _ => self.left_out("declarations need no terminator; leave the `;` out"),
        }
    }

    /// Whether the line closes more parentheses behind the fault than it opens.
    fn is_closed_on_the_line(&self) -> bool {
        let line = self.behind().lines().next().unwrap_or_default();
        let mut depth = 0;
        tokens(line).iter().any(|token| {
            depth += i32::from(token.text == "(") - i32::from(token.text == ")");
            depth < 0
        })
    }

    /// `/* … */`
    fn of_a_comment(&self, start: usize) -> Mend {
        let words = "a comment begins with `//` and ends with its line".to_owned();
        let inside = &self.text[start + 2..];
        let Some(length) = inside.find("*/") else { return Mend::Words(words) };
        let end = start + 2 + length + 2;
        if !self.text[end..].lines().next().unwrap_or_default().trim().is_empty() {
            return Mend::Words(words);
        }
        let mut text = String::new();
        for (k, line) in inside[..length].trim_end().split('\n').enumerate() {
            let content = line.trim_start();
            let indent = &line[..line.len() - content.len()];
            // `///` and what follows would be a doc comment
            let space = if content.starts_with('/') { " " } else { "" };
            match k {
                0 => text += &format!("//{space}{line}"),
                _ => text += &format!("\n{indent}// {}", content.trim_start_matches('*').trim_start_matches(' ')),
            }
        }
        Mend::Fix(Fix::replace(self.span(start..end), text, words, Applies::Always))
    }

    /// `30°`, and `alpha°`, which is a product.
    fn of_degrees(&self) -> Mend {
        let word = self.word_before();
        let words = format!("degrees are written `{word} deg`");
        if self.behind().starts_with(|c: char| c.is_alphanumeric() || c == '_') {
            return Mend::Words(words);
        }
        if word.parse::<f64>().is_ok() {
            return self.replaced(self.before().len()..self.here().end, " deg", &words, Applies::Always);
        }
        self.replaced(self.here(), " * deg", "degrees are written `deg`", Applies::Probably)
    }

    fn is_head_of_fn(&self) -> bool {
        let line = self.before().lines().last().unwrap_or_default().trim_start();
        line.starts_with("fn ") && !line.contains('=')
    }

    /// `0,5` and `2.`
    fn of_a_decimal(&self) -> Option<Mend> {
        let (whole, behind) = (self.word_before(), self.behind());
        let is_number = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
        let digits = &behind[..behind.find(|c: char| !c.is_ascii_digit()).unwrap_or(behind.len())];
        if !is_number(whole) || !self.expects(Rule::infix) {
            return None;
        }
        match (self.found, is_number(digits)) {
            (",", true) => {
                // `1,000` may be a thousand
                let is_group = digits.len() == 3 && whole != "0";
                let applies = if is_group { Applies::Probably } else { Applies::Always };
                let words = format!("decimals are written with a point: `{whole}.{digits}`");
                Some(self.replaced(self.before().len()..self.here().end, ".", &words, applies))
            }
            (".", false) => {
                let words = format!("a digit follows the point: `{whole}.0`");
                if behind.starts_with(|c: char| c.is_alphanumeric() || c == '_' || c == '.') {
                    return Some(Mend::Words(words));
                }
                Some(self.replaced(self.before().len()..self.here().end, ".0", &words, Applies::Always))
            }
            _ => None,
        }
    }
}
