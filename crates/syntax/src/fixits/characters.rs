//! Characters of other languages, keyboards and calculators.

use super::{Fault, FixIt};
use crate::grammar::Rule;
use crate::lexer::tokens;
use mechc_text::diag::{Applicability, Edit, Fix};
use std::ops::Range;

/// Unambiguous characters: replacement and message.
const WRITTEN: &[(&str, &str, &str)] = &[
    ("×", "*", "a product is written with `*`"),
    ("·", "*", "a product is written with `*`"),
    ("÷", "/", "a quotient is written with `/`"),
    ("−", "-", "a minus sign is written `-`"),
    ("–", "-", "a minus sign is written `-`"),
];

/// Rules that begin an operand.
const OPERAND: [Rule; 5] = [Rule::expr, Rule::prefix, Rule::literal, Rule::number, Rule::call];

impl Fault<'_> {
    pub(super) fn foreign_character(&self) -> Option<FixIt> {
        // inside of a name the character is no operator
        let has_operator = self.expects(Rule::infix) || OPERAND.iter().any(|rule| self.expects(*rule));
        let written = WRITTEN.iter().find(|(written, ..)| *written == self.found);
        if let Some((_, text, words)) = written.filter(|_| has_operator) {
            return Some(FixIt::Fix(self.everywhere_on_the_line(text, words)));
        }
        if let Some(fix_it) = self.foreign_operator() {
            return Some(fix_it);
        }
        let (before, behind) = (self.before(), self.behind());
        let around = self.opened().last().map_or("", |(_, token)| *token);
        Some(match self.found {
            "=" if self.text[..self.at].ends_with('=') => self.replaced(
                self.at - 1..self.at + 1,
                "=",
                "an equation is written with one `=`",
                Applicability::Always,
            ),
            "==" if self.expects(Rule::equals) => {
                self.replaced(self.here(), "=", "an equation is written with one `=`", Applicability::Always)
            }
            "=" if self.text[..self.at].ends_with(':') => return self.colon_equals(),
            "=" if self.expects(Rule::kw_then) => {
                self.replaced(self.here(), "==", "a comparison is written `==`", Applicability::Always)
            }
            "+" if OPERAND.iter().any(|rule| self.expects(*rule)) => self.left_out("a positive number needs no sign"),
            ";" => self.semicolon(around),
            "*" if self.text[..self.at].ends_with('*') => {
                self.replaced(self.at - 1..self.at + 1, "^", "a power is written with `^`", Applicability::Always)
            }
            "*" if self.text[..self.at].ends_with('/') => self.block_comment(self.at - 1),
            "/" if behind.starts_with('*') => self.block_comment(self.at),
            "#" => self.number_sign(),
            "%" => FixIt::words("a comment begins with `//`; a remainder is `mod(a, b)`"),
            "√" => FixIt::words("a square root is written `sqrt(a)`"),
            "|" => FixIt::words("an absolute value is written `abs(a)`"),
            "°" => self.degree_sign(),
            "²" | "³" if self.expects(Rule::equals) && !self.expects(Rule::infix) => {
                FixIt::words("a name is made of letters, digits and `_`")
            }
            "²" if behind.trim_start().starts_with('(') => FixIt::words("the square of a function is `f(x)^2`"),
            "²" => self.replaced(self.here(), "^2", "a square is written `^2`", Applicability::Always),
            "³" => self.replaced(self.here(), "^3", "a cube is written `^3`", Applicability::Always),
            "\"" if behind.lines().next().is_some_and(|line| line.contains('"')) => {
                FixIt::words("text in quotes is the file of a `table` or a `use`, and stands nowhere else")
            }
            "\"" => FixIt::words("a string ends on the line where it begins"),
            "," if self.is_head_of_fn() => FixIt::words("a `fn` has one argument: what else it needs can be a `param`"),
            "," | "." => return self.decimal_separator(),
            "(" if around == "[" && before.ends_with(')') => {
                let end = before.len();
                self.replaced(end..end, ",", "rows are separated by commas: `(1, 2), (3, 4)`", Applicability::Always)
            }
            _ => return None,
        })
    }

    /// Suggests the language's form of operators for conditions, selection and derivatives.
    fn foreign_operator(&self) -> Option<FixIt> {
        let (has_operator, is_operand) = (self.expects(Rule::infix), OPERAND.iter().any(|rule| self.expects(*rule)));
        let behind = self.behind();
        let is_double = behind.starts_with(self.found);
        let joined = |by: &str, words: &str| {
            let range = self.at..self.here().end + 1;
            let gap = |text: Option<char>| if text.is_some_and(char::is_whitespace) { "" } else { " " };
            let [before, after] =
                [self.text[..range.start].chars().next_back(), self.text[range.end..].chars().next()].map(gap);
            self.replaced(range, &format!("{before}{by}{after}"), words, Applicability::Always)
        };
        Some(match self.found {
            "&" if has_operator && is_double => joined("and", "conditions are joined with `and`"),
            "&" if has_operator => FixIt::words("conditions are joined with `and`"),
            "|" if has_operator && is_double => joined("or", "conditions are joined with `or`"),
            "!" if is_operand => {
                self.replaced(self.here(), "not ", "a condition is denied with `not`", Applicability::Always)
            }
            "?" if has_operator => FixIt::words("a choice is written `if CONDITION then A else B`"),
            "." if has_operator && behind.starts_with('d') && self.before().ends_with(')') => {
                FixIt::words("a time derivative is written `der(…)`, in a measure; `der(der(…))` is the second")
            }
            _ => return None,
        })
    }

    /// Replaces this character wherever it stands in the rest of the line.
    fn everywhere_on_the_line(&self, by: &str, words: &str) -> Fix {
        let line = self.text[self.at..].lines().next().unwrap_or_default();
        let same = tokens(line).into_iter().filter(|token| token.text == self.found);
        let edits = same
            .map(|token| Edit { span: self.span(self.at + token.start..self.at + token.end()), text: by.to_owned() })
            .collect();
        Fix { message: words.to_owned(), edits, applies: Applicability::Always }
    }

    /// Removes what was found; leaves a space if words would join.
    pub(super) fn left_out(&self, words: &str) -> FixIt {
        let Range { start, end } = self.here();
        let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
        let joins = self.text[..start].ends_with(is_word) && self.text[end..].starts_with(is_word);
        self.replaced(start..end, if joins { " " } else { "" }, words, Applicability::Always)
    }

    /// Corrects `:=` to `:`: `driver d := …`.
    fn colon_equals(&self) -> Option<FixIt> {
        let line = self.behind().lines().next().unwrap_or_default();
        let is_sure = !self.expects(Rule::prefix) || line.contains('=');
        let words = "a `:` alone stands behind the name";
        let start = self.text[..self.at - 1].trim_end().len();
        is_sure.then(|| self.replaced(start..self.here().end, ":", words, Applicability::Always))
    }

    /// Corrects a comment that begins with `#`.
    fn number_sign(&self) -> FixIt {
        let words = "a comment begins with `//`";
        let marks = self.found.len() + self.behind().len() - self.behind().trim_start_matches('#').len();
        let range = self.at..self.at + marks;
        let is_at_line_start = self.text[..self.at].trim_end_matches([' ', '\t']).ends_with('\n');
        let is_apart = self.text[..self.at].ends_with(char::is_whitespace);
        // an incomplete declaration would continue in the comment
        let is_complete = self.expects(Rule::infix) || self.expects(Rule::close);
        // a block that was commented out needs a mark on each of its lines
        let opens_a_block = self.behind().lines().next().is_some_and(|line| line.contains(['{', '}']));
        match (is_at_line_start, is_apart, is_complete) {
            _ if opens_a_block && is_apart => self.replaced(range, "//", words, Applicability::Probably),
            (true, ..) | (_, true, true) => self.replaced(range, "//", words, Applicability::Always),
            (_, false, true) => self.replaced(range, " //", words, Applicability::Probably),
            _ => FixIt::words("a name is made of letters, digits and `_`; a comment begins with `//`"),
        }
    }

    /// Turns a comment `/* … */` into line comments.
    fn block_comment(&self, start: usize) -> FixIt {
        let words = "a comment begins with `//` and ends with its line".to_owned();
        let Some(length) = self.text[start + 2..].find("*/") else { return FixIt::Words(words) };
        let end = start + 2 + length + 2;
        if !self.text[end..].lines().next().unwrap_or_default().trim().is_empty() {
            return FixIt::Words(words);
        }
        let text = line_comments(&self.text[start..end - 2]);
        FixIt::Fix(Fix::replace(self.span(start..end), text, words, Applicability::Always))
    }

    /// Corrects a degree sign: `30°` to `30 deg`, `alpha°` to a product.
    fn degree_sign(&self) -> FixIt {
        let word = self.word_before();
        let words = format!("degrees are written `{word} deg`");
        if self.behind().starts_with(|c: char| c.is_alphanumeric() || c == '_') {
            return FixIt::Words(words);
        }
        if self.behind().trim_start().starts_with('^') {
            let words = format!("degrees are written `deg`; the power of an angle is `({word} deg)^…`");
            return FixIt::Words(words);
        }
        if word.parse::<f64>().is_ok() {
            return self.replaced(self.before().len()..self.here().end, " deg", &words, Applicability::Always);
        }
        self.replaced(self.here(), " * deg", "degrees are written `deg`", Applicability::Probably)
    }

    /// Returns whether the number before is all of a param so far.
    fn is_all_of_a_param(&self) -> bool {
        matches!(tokens(self.before()).as_slice(), [.., keyword, _, equals, _] if (keyword.text, equals.text) == ("param", "="))
    }

    fn is_head_of_fn(&self) -> bool {
        let line = self.before().lines().last().unwrap_or_default().trim_start();
        line.starts_with("fn ") && !line.contains('=')
    }

    /// Corrects a decimal comma, and a point without digits behind it: `0,5`, `2.`.
    fn decimal_separator(&self) -> Option<FixIt> {
        let (whole, behind) = (self.word_before(), self.behind());
        let is_number = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
        let digits = &behind[..behind.find(|c: char| !c.is_ascii_digit()).unwrap_or(behind.len())];
        if !is_number(whole) || !self.expects(Rule::infix) {
            return None;
        }
        match (self.found, is_number(digits)) {
            (",", true) => {
                // `1,000` may be a thousand, and a param may be a point
                let is_group = digits.len() == 3;
                let is_in_doubt = whole != "0" && (is_group || self.is_all_of_a_param());
                let applies = if is_in_doubt { Applicability::Probably } else { Applicability::Always };
                let words = format!("decimals are written with a point: `{whole}.{digits}`");
                Some(self.replaced(self.before().len()..self.here().end, ".", &words, applies))
            }
            (".", false) => {
                let words = format!("a digit follows the point: `{whole}.0`");
                if behind.starts_with(|c: char| c.is_alphanumeric() || c == '_' || c == '.') {
                    return Some(FixIt::Words(words));
                }
                Some(self.replaced(self.before().len()..self.here().end, ".0", &words, Applicability::Always))
            }
            _ => None,
        }
    }
}

/// Returns a comment from `/*` on as line comments; one from `/**` becomes documentation.
fn line_comments(text: &str) -> String {
    let is_doc = text.starts_with("/**") && !text.starts_with("/***");
    let mark = if is_doc { "///" } else { "//" };
    let inside = text.trim_start_matches('/').trim_start_matches('*').trim_end_matches('*').trim_end();
    let mut lines = inside.split('\n').enumerate().peekable();
    // the first line of a doc comment is mostly empty
    if is_doc && inside.contains('\n') {
        lines.next_if(|(_, line)| line.trim().is_empty());
    }
    let mut all = String::new();
    for (k, line) in lines {
        let content = line.trim_start();
        let indent = &line[..line.len() - content.len()];
        // the stars of the lines stand below that of the first
        let indent = if content.starts_with('*') { indent.strip_suffix(' ').unwrap_or(indent) } else { indent };
        let indent = if all.is_empty() { "" } else { indent };
        let end = if all.is_empty() { "" } else { "\n" };
        let content = if k == 0 { line } else { content.trim_start_matches('*').trim_start_matches(' ') };
        let gap = if k > 0 || content.starts_with('/') { " " } else { "" };
        all += &format!("{end}{indent}{mark}{gap}{content}");
    }
    all
}
