//! Suggestions for a text that does not follow the grammar: what its author meant, as far as the words around the fault are unambiguous.
//!
//! Most of it is the table in [`rules`]. Code is here for what depends on more than one declaration.

mod brackets;
mod characters;
mod pattern;
mod rules;

use super::grammar::{Rule, keyword_of};
use super::keywords::begins_declaration;
use super::lexer::{LexemeKind, Token, hyphenated_at, is_dash, is_word_char, tokens, tokens_in};
use mechc_text::diag::{Applicability, Edit, Fix, nearest};
use mechc_text::source::{FileId, Span};
use mechc_text::vocabulary::{KEYWORDS, Keyword, Position, Role, Synonym, Unit, is_declaration, is_feature};
use pattern::Line;
use std::ops::Range;

/// Largest number of tokens before a fault, and behind it, that patterns look at.
const LONGEST_LINE: usize = 80;

/// A syntax error: its position, and the rules that were expected there.
pub(super) struct Fault<'a> {
    text: &'a str,
    file: FileId,
    /// Position of the word or character, in bytes.
    at: usize,
    pub found: &'a str,
    expected: &'a [Rule],
    /// All tokens before the fault.
    before: Vec<Token<'a>>,
    /// Index of the keyword of the declaration in [`Fault::before`].
    start: usize,
    /// Tokens from the fault to the end of the line or block, or to the next declaration.
    rest: Vec<Token<'a>>,
}

/// A suggestion.
pub(super) enum Suggestion {
    Words(String),
    Fix(Fix),
    /// A declaration that ends too early; reported at its end, and not at the next declaration.
    Incomplete {
        what: String,
        /// Span of the last word or character of the declaration.
        end: Span,
        expected: &'static str,
        suggestion: Box<Suggestion>,
    },
}

impl Suggestion {
    fn words(text: impl Into<String>) -> Suggestion {
        Suggestion::Words(text.into())
    }
}

impl<'a> Fault<'a> {
    /// Creates the fault at a word or character.
    pub fn new(text: &'a str, file: FileId, at: usize, found: &'a str, expected: &'a [Rule]) -> Fault<'a> {
        let before = tokens(&text[..at]);
        let start = (0..before.len()).rev().find(|&k| begins(text, &before, k)).unwrap_or(0);
        let end = text[at..].find('\n').map_or(text.len(), |end| at + end);
        let is_here =
            |token: &Token<'_>| token.start == at || token.text != "}" && !begins_declaration(text, token.range());
        let rest = tokens_in(text, at..end).into_iter().take_while(is_here).collect();
        Fault { text, file, at, found, expected, before, start, rest }
    }

    fn expects(&self, rule: Rule) -> bool {
        self.expected.contains(&rule)
    }

    /// Returns the tokens from the keyword of the declaration to the fault.
    fn declaration(&self) -> &[Token<'a>] {
        &self.before[self.start.min(self.before.len())..]
    }

    fn end_before(&self) -> usize {
        self.before.last().map_or(0, Token::end)
    }

    /// Returns the range of the word or character.
    fn here(&self) -> Range<usize> {
        self.at..self.at + self.found.len()
    }

    fn behind(&self) -> &'a str {
        &self.text[self.here().end..]
    }

    fn span(&self, range: Range<usize>) -> Span {
        Span { file: self.file, start: range.start as u32, end: range.end as u32 }
    }

    fn replaced(&self, range: Range<usize>, by: &str, words: &str, applies: Applicability) -> Suggestion {
        Suggestion::Fix(Fix::replace(self.span(range), by, words, applies))
    }

    /// Returns the text of a token before the fault, counted backwards from 1.
    fn word_before(&self, count: usize) -> &'a str {
        self.before.len().checked_sub(count).map_or("", |k| self.before[k].text)
    }

    fn begins_declaration(&self) -> bool {
        begins_declaration(self.text, self.here())
    }

    fn is_on_new_line(&self) -> bool {
        self.text[self.end_before()..self.at].contains('\n')
    }

    /// Returns whether a declaration of the mechanism stands where a body's `}` is expected.
    fn ends_a_body(&self) -> bool {
        let is_in_body = self.expects(Rule::kw_point) || self.expects(Rule::point);
        is_in_body && is_declaration(self.found) && !is_feature(self.found)
    }

    /// Returns a suggestion for the fault.
    pub fn suggestion(&self) -> Option<Suggestion> {
        self.missing_keyword()
            .or_else(|| self.incomplete_declaration())
            .or_else(|| self.hyphenated_name())
            .or_else(|| self.correction(rules::DECLARATIONS))
            .or_else(|| self.ground_alone())
            .or_else(|| self.character())
            .or_else(|| self.misplaced_keyword())
            .or_else(|| self.misspelled_word())
            .or_else(|| self.missing_operator())
            .or_else(|| self.closing().map(Suggestion::Fix))
            .or_else(|| self.form())
    }

    /// Returns the correction of a table that fits the tokens of the declaration around the fault.
    fn correction(&self, table: &[rules::Correction]) -> Option<Suggestion> {
        let declaration = self.declaration();
        let declaration = &declaration[declaration.len().saturating_sub(LONGEST_LINE)..];
        // a word at the beginning of a line is no part of the declaration, unless it joins its parts
        let is_part = !self.is_on_new_line()
            || Keyword::named(self.found).is_some_and(Keyword::is_joining)
            || !self.found.starts_with(|c: char| is_word_char(c) || "(){}\"".contains(c));
        let rest = &self.rest[..if is_part { self.rest.len().min(LONGEST_LINE) } else { 0 }];
        let tokens = [declaration, rest].concat();
        self.correction_of(table, &tokens, declaration.len())
    }

    fn correction_of(&self, table: &[rules::Correction], tokens: &[Token<'a>], fault: usize) -> Option<Suggestion> {
        let bodies = self.before.windows(2).filter(|pair| pair[0].text == "body").map(|pair| pair[1].text);
        let line = Line { text: self.text, tokens, fault, bodies: &bodies.collect::<Vec<_>>() };
        rules::first_of(table, &line, self)
    }

    /// Suggests the keyword of a declaration without one.
    fn missing_keyword(&self) -> Option<Suggestion> {
        if !self.is_on_new_line() && !["{", "}", ""].contains(&self.word_before(1)) {
            return None;
        }
        let of_units = || {
            let synonym = Synonym::of(Position::Declaration, self.found).filter(|_| self.rest.len() == 2)?;
            (synonym.means().count() == 0).then(|| Suggestion::words(synonym.message(&[])))
        };
        self.correction_of(rules::BEGINNINGS, &self.rest, 0).or_else(of_units)
    }

    /// Reports `circle c = (0, 0)`, `axis a = (0, 1)` and `load push: 20 N` at their ends.
    fn incomplete_declaration(&self) -> Option<Suggestion> {
        let [keyword, name, .., last] = self.declaration() else { return None };
        let (_, expected) = INCOMPLETE.into_iter().find(|(rule, _)| self.expects(*rule))?;
        let is_one = ["circle", "axis", "load"].contains(&keyword.text);
        let is_opener = Keyword::named(self.found).is_some_and(|keyword| keyword.role == Role::Opener);
        let is_next = self.begins_declaration() || self.is_on_new_line() && is_opener;
        if !is_one || !is_next && self.found != "}" && !self.found.is_empty() {
            return None;
        }
        let form = || Suggestion::Words(format!("it is written {}", forms(keyword.text)));
        Some(Suggestion::Incomplete {
            what: format!("{} `{}`", keyword.text, name.text),
            end: self.span(last.range()),
            expected,
            suggestion: Box::new(
                self.correction_of(rules::DECLARATIONS, self.declaration(), usize::MAX).unwrap_or_else(form),
            ),
        })
    }

    /// Corrects `small-end`, where a name is declared, with whatever dash.
    fn hyphenated_name(&self) -> Option<Suggestion> {
        let start = self.before.last()?.start;
        if !self.found.starts_with(is_dash) || !is_declaration(self.word_before(2)) {
            return None;
        }
        let name = hyphenated_at(self.text, start)?;
        let written = name.replace(is_dash, "_");
        let uses = tokens(self.text).into_iter().filter(|token| hyphenated_at(self.text, token.start) == Some(name));
        let edit =
            |token: Token<'_>| Edit { span: self.span(token.start..token.start + name.len()), text: written.clone() };
        Some(Suggestion::Fix(Fix {
            message: format!("a name has no `{}`: write `{written}`", self.found),
            edits: uses.map(edit).collect(),
            applies: Applicability::Probably,
        }))
    }

    /// Suggests the features of the ground for `x(ground)`.
    fn ground_alone(&self) -> Option<Suggestion> {
        if self.found != "ground" || self.begins_declaration() || self.is_on_new_line() {
            return None;
        }
        let all = tokens(self.text);
        let start = all.windows(2).position(|pair| pair[0].text == "ground" && pair[1].text == "{")?;
        let inside: Vec<&str> = all[start..].iter().map(|token| token.text).take_while(|word| *word != "}").collect();
        let declared = inside.windows(2).filter(|pair| is_feature(pair[0]) && is_name(pair[1]));
        let names: Vec<String> = declared.take(4).map(|pair| format!("ground.{}", pair[1])).collect();
        let message = format!("name one of its features: `{}`", names.join("`, `"));
        match names.as_slice() {
            [] => None,
            [only] => Some(self.replaced(self.here(), only, &message, Applicability::Probably)),
            _ => Some(Suggestion::Words(message)),
        }
    }

    fn misplaced_keyword(&self) -> Option<Suggestion> {
        if !is_declaration(self.found) {
            return None;
        }
        if self.expects(Rule::name) {
            return Some(Suggestion::Words(format!("`{}` is a keyword and cannot be a name", self.found)));
        }
        let message = "the `}` of the body or ground before it is missing".to_owned();
        self.ends_a_body().then(|| match self.brace_before() {
            Some(edit) => Suggestion::Fix(Fix { message, edits: vec![edit], applies: Applicability::Always }),
            None => Suggestion::Words(message),
        })
    }

    /// Suggests the word of the language for one that is misspelled or of another program.
    fn misspelled_word(&self) -> Option<Suggestion> {
        if is_declaration(self.found) || self.found.is_empty() {
            return None;
        }
        if self.found == "if" && self.expects(Rule::number) {
            return Some(Suggestion::words("inside an operator an `if` needs parentheses"));
        }
        let joining = self.joining_words();
        if joining == ["every"] && self.found.starts_with(|c: char| c.is_ascii_digit()) {
            let words = "`every` is how far one time is from the next: of 100 steps each is `every (B - A) / 100`";
            return Some(Suggestion::words(words));
        }
        // the author means the word that is written, though not in this position
        let is_a_keyword = Keyword::named(self.found).is_some();
        let declarations = KEYWORDS.iter().filter(|word| word.begins_declaration()).map(|word| word.word.name);
        // `1 evry 0.1`: the word before was taken for a unit
        let before = self.before.last().map_or(0..0, Token::range);
        let suggestion = nearest(self.found, joining.iter().copied())
            .map(|word| (self.here(), word))
            .or_else(|| nearest(self.word_before(1), joining.iter().copied()).map(|word| (before, word)))
            .or_else(|| nearest(self.found, declarations).filter(|_| !is_a_keyword).map(|word| (self.here(), word)));
        if let Some((place, word)) = suggestion {
            return Some(Suggestion::Fix(Fix::suggest(self.span(place), word)));
        }
        let synonym = Synonym::of(Position::Declaration, self.found)?;
        let mut expected = self.expected.iter().filter_map(|rule| keyword_of(*rule));
        if !expected.any(|keyword| synonym.means().any(|word| word == keyword.word.name)) {
            return None;
        }
        Some(match synonym.equivalent() {
            Some(word) => Suggestion::Fix(Fix::suggest(self.span(self.here()), word)),
            None => Suggestion::Words(synonym.message(&[])),
        })
    }

    /// Returns the words that could continue the declaration.
    fn joining_words(&self) -> Vec<&'static str> {
        let expected: Vec<&str> =
            self.expected.iter().filter_map(|rule| keyword_of(*rule)).map(|keyword| keyword.word.name).collect();
        // behind any formula of a measure an `in` may stand, but seldom is what is missing
        let joining = KEYWORDS.iter().filter(|word| word.is_joining() && word.word.name != "in");
        joining.map(|word| word.word.name).filter(|word| expected.contains(word)).collect()
    }

    /// Suggests `*` between two operands.
    fn missing_operator(&self) -> Option<Suggestion> {
        // a separator within a declaration is no factor
        let joins = Keyword::named(self.found).is_some_and(|keyword| keyword.role == Role::Separator);
        let starts_operand = !joins && self.found.starts_with(|c: char| c.is_alphanumeric() || c == '(' || c == '_');
        let is_one = self.expects(Rule::infix) && starts_operand && !self.begins_declaration();
        if !is_one || self.is_on_new_line() || !self.joining_words().is_empty() {
            return None;
        }
        if let Some(synonym) = Synonym::of(Position::Call, self.word_before(1)) {
            return Some(Suggestion::Words(synonym.message(&[self.found])));
        }
        // within parentheses it may as well be a comma
        if self.expects(Rule::comma) && self.opened().last().is_some_and(|(_, token)| *token == "(") {
            return Some(Suggestion::words("a `,` is missing, or an operator: a product is written with `*`"));
        }
        let insert = |at| Edit { span: self.span(at..at), text: "* ".to_owned() };
        let mut edits = vec![insert(self.at)];
        let mut message = "a product is written with `*`".to_owned();
        // `2 pi t`, whose `pi` was taken for a unit
        if let [.., number, factor] = self.declaration()
            && number.kind == LexemeKind::Number
            && factor.kind == LexemeKind::Word
            && Unit::named(factor.text).is_none()
        {
            edits.insert(0, insert(factor.start));
            message += &format!(": `{} * {} * {}`", number.text, factor.text, self.found);
        }
        Some(Suggestion::Fix(Fix { message, edits, applies: Applicability::Probably }))
    }

    /// Returns the form of the declaration if a word of it is expected outside of all brackets.
    fn form(&self) -> Option<Suggestion> {
        let [first, rest @ ..] = self.declaration() else { return None };
        let keyword = Keyword::named(first.text)?;
        let count = |brackets: [&str; 2]| rest.iter().filter(|token| brackets.contains(&token.text)).count();
        let is_block = keyword.role == Role::Declaration && rest.iter().any(|token| token.text == "{");
        let is_one = (keyword.begins_declaration() || keyword.role == Role::Opener)
            && self.expected.iter().any(|rule| FORM.contains(rule))
            && count(["(", "["]) == count([")", "]"])
            && (!rest.is_empty() || first.text == "analysis");
        (is_one && !is_block && !self.found.is_empty())
            .then(|| Suggestion::Words(format!("it is written {}", forms(first.text))))
    }
}

/// Rules that end a declaration, by what is missing before it.
const INCOMPLETE: [(Rule, &str); 3] =
    [(Rule::radius, "`radius`"), (Rule::along, "`along` or `to`"), (Rule::kw_on, "`on`")];

/// Rules that belong to the form of a declaration.
const FORM: [Rule; 12] = [
    Rule::equals,
    Rule::colon,
    Rule::open,
    Rule::left,
    Rule::at,
    Rule::along,
    Rule::to,
    Rule::radius,
    Rule::from,
    Rule::every,
    Rule::spline,
    Rule::periodic,
];

fn forms(keyword: &str) -> String {
    Keyword::named(keyword).map_or(String::new(), |keyword| keyword.word.written())
}

/// Returns whether a declaration begins at a token, judging by its neighbors.
fn begins(text: &str, tokens: &[Token<'_>], k: usize) -> bool {
    let token = tokens[k];
    if begins_declaration(text, token.range()) {
        return true;
    }
    let Some(before) = k.checked_sub(1).map(|k| tokens[k].text) else { return true };
    let is_opener = Keyword::named(token.text).is_some_and(|keyword| keyword.role.is_opener());
    let is_operand = Keyword::named(before).is_some_and(|keyword| keyword.word.name != "mirrored")
        || before.ends_with(['(', '[', ',', '=', '+', '-', '*', '/', '^', '<', '>', '.', ':']);
    let behind = tokens.get(k + 1).map_or("", |next| next.text);
    is_opener && !is_operand && !behind.starts_with(['+', '*', '/', '^', ')', ']', ',', '.', '<', '>'])
}

fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic() || c == '_')
}
