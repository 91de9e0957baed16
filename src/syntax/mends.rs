//! What was probably meant by a text that does not follow the grammar, as far as the words around the fault tell.

use super::grammar::Rule;
use super::tokens::next_token;
use crate::diag::nearest;
use crate::vocabulary::{KEYWORDS, Keyword, Place, Synonym, is_declaration, is_feature, is_one_argument_function};

/// A fault: where it is, and what would have fitted there.
pub(super) struct Fault<'a> {
    pub text: &'a str,
    /// The place of the word or character.
    pub at: usize,
    pub found: &'a str,
    pub expected: &'a [Rule],
}

impl Fault<'_> {
    fn expects(&self, rule: Rule) -> bool {
        self.expected.contains(&rule)
    }

    fn before(&self) -> &str {
        self.text[..self.at].trim_end()
    }

    fn behind(&self) -> &str {
        &self.text[self.at + self.found.len()..]
    }

    /// The word that ends before the fault.
    fn word_before(&self) -> &str {
        let before = self.before();
        let start = before.rfind(|c: char| !(c.is_alphanumeric() || c == '_' || c == '.')).map_or(0, |at| at + 1);
        before.get(start..).unwrap_or_default()
    }

    fn is_on_new_line(&self) -> bool {
        self.text[self.before().len()..self.at].contains('\n')
    }

    /// What was opened before the fault and not closed, innermost last.
    fn opened(&self) -> Vec<(usize, &str)> {
        let mut opened: Vec<(usize, &str)> = Vec::new();
        let mut rest = &self.text[..self.at];
        while let Some(token) = next_token(&mut rest) {
            let start = self.at - rest.len() - token.len();
            match token {
                "(" | "[" | "{" => opened.push((start, token)),
                ")" | "]" | "}" => drop(opened.pop()),
                // no parenthesis reaches into the next declaration, and `ground.O` is a point
                word if is_declaration(word) && !rest.starts_with('.') => {
                    opened.retain(|(_, token)| *token == "{");
                }
                _ => {}
            }
        }
        opened
    }

    /// Another place that explains a fault which shows only behind it, and what to say there.
    pub fn reason(&self) -> Option<(usize, &'static str)> {
        let ends = self.found.is_empty() || self.found == "}" || self.found == "{" || is_declaration(self.found);
        let before = self.before();
        match self.opened().last() {
            _ if !ends => None,
            _ if before.ends_with('=') => Some((before.len() - 1, "nothing stands behind this")),
            None if before.ends_with('}') => Some((before.len() - 1, "this `}` ends the mechanism")),
            Some((start, "(")) => Some((*start, "this `(` is not closed")),
            Some((start, "[")) => Some((*start, "this `[` is not closed")),
            Some((start, "{")) if self.found.is_empty() || self.ends_a_body() => {
                Some((*start, "this `{` is not closed"))
            }
            _ => None,
        }
    }

    /// Whether a declaration of the mechanism stands where a body's `}` should.
    fn ends_a_body(&self) -> bool {
        let in_a_body = self.expects(Rule::kw_point) || self.expects(Rule::point);
        in_a_body && is_declaration(self.found) && !is_feature(self.found)
    }

    /// What to write instead.
    pub fn mend(&self) -> Option<String> {
        self.of_a_character().or_else(|| self.of_a_keyword()).or_else(|| self.of_a_word())
    }

    fn of_a_character(&self) -> Option<String> {
        let (before, behind) = (self.before(), self.behind());
        let in_rows = self.opened().last().is_some_and(|(_, token)| *token == "[");
        let text = match self.found {
            "=" if before.ends_with('=') => "an equation is written with one `=`",
            "=" if self.expects(Rule::kw_then) => "a comparison is written `==`",
            "+" if self.expects(Rule::prefix) => "a positive number needs no sign",
            ";" if in_rows => "rows are separated by commas: `(1, 2), (3, 4)`",
            ";" => "declarations need no terminator; leave the `;` out",
            "*" if before.ends_with('*') => "a power is written with `^`",
            "*" if before.ends_with('/') => "a comment begins with `//` and ends with its line",
            "#" => "a comment begins with `//`",
            "×" | "·" => "a product is written with `*`",
            "÷" => "a quotient is written with `/`",
            "−" | "–" => "a minus sign is written `-`",
            "°" => return Some(format!("degrees are written `{} deg`", self.word_before())),
            "²" => "a square is written `^2`",
            "³" => "a cube is written `^3`",
            "\"" if behind.lines().next().is_some_and(|line| line.contains('"')) => {
                "text in quotes is the file of a `table`, and stands nowhere else"
            }
            "\"" => "a string ends on the line where it begins",
            "," if self.is_head_of_fn() => "a `fn` has one argument: what else it needs can be a `param`",
            "," | "." => return self.of_a_decimal(),
            "(" if in_rows && before.ends_with(')') => "rows are separated by commas: `(1, 2), (3, 4)`",
            _ => return None,
        };
        Some(text.to_owned())
    }

    fn is_head_of_fn(&self) -> bool {
        let line = self.before().lines().last().unwrap_or_default().trim_start();
        line.starts_with("fn ") && !line.contains('=')
    }

    /// `0,5` and `2.`
    fn of_a_decimal(&self) -> Option<String> {
        let (whole, behind) = (self.word_before(), self.behind());
        let is_number = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
        let digits = &behind[..behind.find(|c: char| !c.is_ascii_digit()).unwrap_or(behind.len())];
        if !is_number(whole) || !self.expects(Rule::infix) {
            return None;
        }
        match (self.found, is_number(digits)) {
            (",", true) => Some(format!("decimals are written with a point: `{whole}.{digits}`")),
            (".", false) => Some(format!("a digit follows the point: `{whole}.0`")),
            _ => None,
        }
    }

    fn of_a_keyword(&self) -> Option<String> {
        if !is_declaration(self.found) {
            return None;
        }
        if self.expects(Rule::name) {
            return Some(format!("`{}` is a keyword and cannot be a name", self.found));
        }
        self.ends_a_body().then(|| "the `}` of the body or ground before it is missing".to_owned())
    }

    fn of_a_word(&self) -> Option<String> {
        if is_declaration(self.found) || self.found.is_empty() {
            return None;
        }
        if self.found == "if" && self.expects(Rule::number) {
            return Some("inside an operator an `if` needs parentheses".to_owned());
        }
        let connecting = self.connecting_words();
        let declarations = KEYWORDS.iter().filter(|word| word.begins_declaration()).map(|word| word.word.name);
        // `1 evry 0.1`: the word before was taken for a unit
        let meant = nearest(self.found, connecting.iter().copied())
            .or_else(|| nearest(self.word_before(), connecting.iter().copied()))
            .or_else(|| nearest(self.found, declarations));
        if let Some(word) = meant {
            return Some(format!("was `{word}` meant?"));
        }
        let other = Synonym::of(Place::Declaration, self.found).filter(|synonym| self.begins(synonym.means));
        if let Some(synonym) = other {
            return Some(synonym.say(&[]));
        }
        let starts_operand = self.found.starts_with(|c: char| c.is_alphanumeric() || c == '(' || c == '_');
        if !self.expects(Rule::infix) || !starts_operand || self.is_on_new_line() || !connecting.is_empty() {
            return None;
        }
        if is_one_argument_function(self.word_before()) {
            return Some(format!(
                "what a function is of stands in parentheses: `{}({})`",
                self.word_before(),
                self.found
            ));
        }
        // within parentheses it may as well be a comma
        let is_listed = self.expects(Rule::comma) && self.opened().last().is_some_and(|(_, token)| *token == "(");
        Some(
            if is_listed {
                "a `,` is missing, or an operator: a product is written with `*`"
            } else {
                "a product is written with `*`"
            }
            .to_owned(),
        )
    }

    /// Whether a declaration could begin here by one of these keywords.
    fn begins(&self, keywords: &[&str]) -> bool {
        let is_one = |rule: &Rule| {
            keywords.iter().any(|word| is_rule_of(*rule, word) || *word == "fn" && *rule == Rule::function)
        };
        self.expected.iter().any(is_one)
    }

    /// The words that would have gone on.
    fn connecting_words(&self) -> Vec<&'static str> {
        let expected = |word: &&Keyword| self.expected.iter().any(|rule| is_rule_of(*rule, word.word.name));
        KEYWORDS.iter().filter(|word| word.is_joining()).filter(expected).map(|word| word.word.name).collect()
    }
}

/// Whether a rule of the grammar is that of a word: `to`, or `kw_then`.
fn is_rule_of(rule: Rule, word: &str) -> bool {
    format!("{rule:?}").trim_start_matches("kw_") == word
}
