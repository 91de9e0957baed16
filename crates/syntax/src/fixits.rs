//! Fix-its for a text that does not follow the grammar, as far as the words around the fault are unambiguous.

mod brackets;
mod characters;
mod mounts;
mod semicolons;
mod separators;
mod uses;
mod windows;

use super::grammar::{Rule, keyword_of};
use super::keywords::begins_declaration;
use super::lexer::{LexemeKind, Lexer, is_word_char, tokens};
use mechc_text::diag::{Applicability, Edit, Fix, nearest};
use mechc_text::source::{FileId, Span};
use mechc_text::vocabulary::{
    KEYWORDS, Keyword, Position, Role, Synonym, Unit, is_declaration, is_feature, is_one_argument_function,
};
use std::ops::Range;

/// A syntax error: its position, and the rules that were expected there.
pub(super) struct Fault<'a> {
    pub text: &'a str,
    pub file: FileId,
    /// Position of the word or character, in bytes.
    pub at: usize,
    pub found: &'a str,
    pub expected: &'a [Rule],
}

/// A suggestion.
pub(super) enum FixIt {
    /// A suggestion in words.
    Words(String),
    /// A suggestion as an edit.
    Fix(Fix),
}

impl FixIt {
    fn words(text: &str) -> FixIt {
        FixIt::Words(text.to_owned())
    }
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

    /// Returns the range of the word or character.
    fn here(&self) -> Range<usize> {
        self.at..self.at + self.found.len()
    }

    fn span(&self, range: Range<usize>) -> Span {
        Span { file: self.file, start: range.start as u32, end: range.end as u32 }
    }

    fn replaced(&self, range: Range<usize>, by: &str, words: &str, applies: Applicability) -> FixIt {
        FixIt::Fix(Fix::replace(self.span(range), by, words, applies))
    }

    /// Returns the word that ends before the fault.
    fn word_before(&self) -> &str {
        let before = self.before();
        let start = before.rfind(|c: char| !(is_word_char(c) || c == '.'));
        // a character may be longer than a byte
        let start = start.map_or(0, |at| at + before[at..].chars().next().map_or(0, char::len_utf8));
        &before[start..]
    }

    /// Returns whether a declaration begins at the fault.
    fn begins_declaration(&self) -> bool {
        begins_declaration(self.text, self.here())
    }

    fn is_on_new_line(&self) -> bool {
        self.text[self.before().len()..self.at].contains('\n')
    }

    /// Returns whether a declaration of the mechanism stands where a body's `}` is expected.
    fn ends_a_body(&self) -> bool {
        let in_a_body = self.expects(Rule::kw_point) || self.expects(Rule::point);
        in_a_body && is_declaration(self.found) && !is_feature(self.found)
    }

    /// Returns a suggestion for the fault.
    pub fn fix_it(&self, expected: &str) -> Option<FixIt> {
        let from_words = || self.misplaced_keyword().or_else(|| self.misspelled_word());
        let missing = || self.closing().or_else(|| self.separator(expected)).map(FixIt::Fix);
        self.file_use()
            .or_else(|| self.mount_order())
            .or_else(|| self.reduction_window())
            .or_else(|| self.foreign_character())
            .or_else(from_words)
            .or_else(missing)
    }

    fn misplaced_keyword(&self) -> Option<FixIt> {
        if !is_declaration(self.found) {
            return None;
        }
        if self.expects(Rule::name) {
            return Some(FixIt::Words(format!("`{}` is a keyword and cannot be a name", self.found)));
        }
        if !self.ends_a_body() {
            return None;
        }
        let words = "the `}` of the body or ground before it is missing";
        match self.brace_before() {
            Some(edit) => {
                Some(FixIt::Fix(Fix { message: words.to_owned(), edits: vec![edit], applies: Applicability::Always }))
            }
            None => Some(FixIt::words(words)),
        }
    }

    fn misspelled_word(&self) -> Option<FixIt> {
        if is_declaration(self.found) || self.found.is_empty() {
            return None;
        }
        if self.found == "if" && self.expects(Rule::number) {
            return Some(FixIt::words("inside an operator an `if` needs parentheses"));
        }
        let connecting = self.connecting_words();
        if connecting == ["every"] && self.found.starts_with(|c: char| c.is_ascii_digit()) {
            let words = "`every` is how far one time is from the next: of 100 steps each is `every (B - A) / 100`";
            return Some(FixIt::words(words));
        }
        // the author means the word that is written, though not in this position
        let is_a_keyword = Keyword::named(self.found).is_some();
        let declarations = KEYWORDS.iter().filter(|word| word.begins_declaration()).map(|word| word.word.name);
        // `1 evry 0.1`: the word before was taken for a unit
        let end = self.before().len();
        let word_before = end - self.word_before().len()..end;
        let suggestion = nearest(self.found, connecting.iter().copied())
            .map(|word| (self.here(), word))
            .or_else(|| nearest(self.word_before(), connecting.iter().copied()).map(|word| (word_before, word)))
            .or_else(|| nearest(self.found, declarations).filter(|_| !is_a_keyword).map(|word| (self.here(), word)));
        if let Some((place, word)) = suggestion {
            return Some(FixIt::Fix(Fix::suggest(self.span(place), word)));
        }
        let other = Synonym::of(Position::Declaration, self.found).filter(|synonym| self.begins(synonym.means));
        if let Some(synonym) = other {
            if let ([only], true) = (synonym.means, synonym.is_same) {
                return Some(FixIt::Fix(Fix::suggest(self.span(self.here()), only)));
            }
            return Some(FixIt::Words(synonym.message(&[])));
        }
        // a separator within a declaration is no factor
        let joins = Keyword::named(self.found).is_some_and(|keyword| keyword.role == Role::Separator);
        let starts_operand = !joins && self.found.starts_with(|c: char| c.is_alphanumeric() || c == '(' || c == '_');
        if !self.expects(Rule::infix) || !starts_operand || self.is_on_new_line() || !connecting.is_empty() {
            return None;
        }
        if let Some(factor) = self.number_before_call() {
            return Some(factor);
        }
        if is_one_argument_function(self.word_before()) {
            return Some(self.argument());
        }
        if let Some(synonym) = Synonym::of(Position::Call, self.word_before()) {
            return Some(FixIt::Words(synonym.message(&[self.found])));
        }
        // within parentheses it may as well be a comma
        let is_listed = self.expects(Rule::comma) && self.opened().last().is_some_and(|(_, token)| *token == "(");
        if is_listed {
            return Some(FixIt::words("a `,` is missing, or an operator: a product is written with `*`"));
        }
        Some(self.number_before_factor().unwrap_or_else(|| {
            self.replaced(self.at..self.at, "* ", "a product is written with `*`", Applicability::Probably)
        }))
    }

    /// Suggests `*` for `2 pi t`, whose `pi` was taken for a unit: corrects both products at once.
    fn number_before_factor(&self) -> Option<FixIt> {
        let (number, start) = self.number_before_the_word()?;
        let (factor, found) = (self.word_before(), self.found);
        let is_factor = factor.starts_with(char::is_alphabetic) && Unit::named(factor).is_none();
        is_factor.then(|| {
            let insert = |at| Edit { span: self.span(at..at), text: "* ".to_owned() };
            FixIt::Fix(Fix {
                message: format!("a product is written with `*`: `{number} * {factor} * {found}`"),
                edits: vec![insert(start), insert(self.at)],
                applies: Applicability::Probably,
            })
        })
    }

    /// Suggests `*` for `3 sin(t)`, whose function was taken for a unit.
    fn number_before_call(&self) -> Option<FixIt> {
        let (number, start) = self.number_before_the_word()?;
        let words = format!("a product is written with `*`: `{number} * {}(…)`", self.word_before());
        (self.found == "(").then(|| self.replaced(start..start, "* ", &words, Applicability::Probably))
    }

    /// Returns the number before the word that ends before the fault, and where that word begins.
    fn number_before_the_word(&self) -> Option<(&str, usize)> {
        let start = self.before().len() - self.word_before().len();
        let number = tokens(&self.text[..start]).pop().filter(|token| token.kind == LexemeKind::Number)?;
        Some((number.text, start))
    }

    /// Suggests parentheses for `sin x`.
    fn argument(&self) -> FixIt {
        let behind = self.behind();
        let unit = Lexer::new(behind, 0).next().filter(|token| Unit::named(token.text).is_some());
        let is_number = self.found.starts_with(|c: char| c.is_ascii_digit());
        let end = self.here().end + unit.filter(|_| is_number).map_or(0, |unit| unit.end());
        let argument = &self.text[self.at..end];
        let words = format!("what a function is of stands in parentheses: `{}({argument})`", self.word_before());
        // the argument goes on: a call, a member, the rest of a number
        if self.found == "(" || behind.trim_start().starts_with(['(', '.']) {
            return FixIt::Words(words);
        }
        let text = format!("({argument})");
        FixIt::Fix(Fix::replace(self.span(self.before().len()..end), text, words, Applicability::Probably))
    }

    /// Returns whether one of these keywords is expected.
    fn begins(&self, keywords: &[&str]) -> bool {
        let mut expected = self.expected.iter().filter_map(|rule| keyword_of(*rule));
        expected.any(|keyword| keywords.contains(&keyword.word.name))
    }

    /// Returns the words that could continue the declaration.
    fn connecting_words(&self) -> Vec<&'static str> {
        let expected = |word: &&Keyword| {
            let mut expected = self.expected.iter().filter_map(|rule| keyword_of(*rule));
            expected.any(|keyword| keyword.word.name == word.word.name)
        };
        // behind any formula of a measure an `in` may stand, but seldom is what is missing
        let joining = KEYWORDS.iter().filter(|word| word.is_joining() && word.word.name != "in");
        joining.filter(expected).map(|word| word.word.name).collect()
    }
}
