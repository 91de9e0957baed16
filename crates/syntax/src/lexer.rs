//! The lexer: words, numbers, strings, comments and signs of a text, which end where they end in the grammar. It takes any text.
//!
//! It knows no keywords: which words are some in their position is decided in [`super::keywords`] and [`super::sync_points`].

use pest::unicode::{XID_CONTINUE, XID_START};
use std::ops::Range;

/// Kinds of tokens.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum LexemeKind {
    /// A name, unit or keyword.
    Word,
    /// A number with its exponent, without sign and unit.
    Number,
    /// A string with its quotes. Without a closing quote it ends with its line.
    String,
    /// A comment from its slashes to the end of its line, without trailing white space.
    Comment,
    /// Anything else: an operator, a bracket, a character that the language does not have.
    Sign,
}

/// A token of a text.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Token<'a> {
    /// First byte.
    pub start: usize,
    /// Text.
    pub text: &'a str,
    /// Kind.
    pub kind: LexemeKind,
    /// Number of line ends between this token and the one before.
    pub lines_before: u32,
}

impl Token<'_> {
    /// Returns the byte behind it.
    #[must_use]
    pub fn end(&self) -> usize {
        self.start + self.text.len()
    }

    /// Returns its bytes.
    #[must_use]
    pub fn range(&self) -> Range<usize> {
        self.start..self.end()
    }

    /// Returns whether it is a comment.
    #[must_use]
    pub fn is_comment(&self) -> bool {
        self.kind == LexemeKind::Comment
    }
}

/// Iterator over the tokens of a text, with its comments.
pub struct Lexer<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Lexer<'a> {
    /// Creates the iterator over the tokens of a text from a byte on.
    #[must_use]
    pub fn new(text: &'a str, at: usize) -> Lexer<'a> {
        Lexer { text, at }
    }

    /// Skips white space and returns the number of line ends in it.
    fn skip_white_space(&mut self) -> u32 {
        let mut lines = 0;
        let rest = &self.text[self.at..];
        let begins = |c: char| {
            lines += u32::from(c == '\n');
            !c.is_whitespace()
        };
        self.at += rest.find(begins).unwrap_or(rest.len());
        lines
    }
}

impl<'a> Iterator for Lexer<'a> {
    type Item = Token<'a>;

    fn next(&mut self) -> Option<Token<'a>> {
        let lines_before = self.skip_white_space();
        let start = self.at;
        let (kind, length) = first_token(&self.text[start..])?;
        self.at += length;
        Some(Token { start, text: &self.text[start..self.at], kind, lines_before })
    }
}

/// Returns the tokens of a text without comments.
#[must_use]
pub fn tokens(text: &str) -> Vec<Token<'_>> {
    tokens_in(text, 0..text.len())
}

/// Returns the tokens of a part of a text without comments, with their positions in the text.
#[must_use]
pub fn tokens_in(text: &str, range: Range<usize>) -> Vec<Token<'_>> {
    Lexer::new(&text[..range.end], range.start).filter(|token| !token.is_comment()).collect()
}

/// Returns whether a character can be part of a name behind its beginning.
#[must_use]
pub fn is_word_char(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || !c.is_ascii() && XID_CONTINUE(c)
}

/// Returns whether a character is a hyphen or a dash that editors and keyboards write for it.
pub(super) fn is_dash(c: char) -> bool {
    ['-', '‐', '‑', '–', '—', '−'].contains(&c)
}

/// Returns the hyphenated name that begins at a byte.
pub(super) fn hyphenated_at(text: &str, start: usize) -> Option<&str> {
    let rest = &text[start..];
    let mut end = rest.find(|c| !is_word_char(c)).unwrap_or(rest.len());
    let first = end;
    while let Some(next) = rest[end..].strip_prefix(is_dash).filter(|next| next.starts_with(is_word_char)) {
        end = rest.len() - next.len() + next.find(|c| !is_word_char(c)).unwrap_or(next.len());
    }
    (rest.starts_with(|c: char| c.is_alphabetic() || c == '_') && end > first).then(|| &rest[..end])
}

/// Returns the kind and length of the token that a text begins with.
fn first_token(text: &str) -> Option<(LexemeKind, usize)> {
    let first = text.chars().next()?;
    Some(match first {
        'a'..='z' | 'A'..='Z' | '_' => (LexemeKind::Word, word_length(text)),
        '0'..='9' => (LexemeKind::Number, number_length(text)),
        '.' if text[1..].starts_with(|c: char| c.is_ascii_digit()) => (LexemeKind::Number, number_length(text)),
        '"' => {
            let end = text[1..].find(['"', '\n']).map_or(text.len(), |end| 1 + end);
            let is_closed = text[end..].starts_with('"');
            (LexemeKind::String, if is_closed { end + 1 } else { text[..end].trim_end().len() })
        }
        '/' if text.starts_with("//") => {
            let line = text.find('\n').map_or(text, |end| &text[..end]);
            (LexemeKind::Comment, line.trim_end().len())
        }
        '.' if text.starts_with("..=") => (LexemeKind::Sign, 3),
        '.' if text.starts_with("..") => (LexemeKind::Sign, 2),
        '=' | '<' | '>' | '!' if text[1..].starts_with('=') => (LexemeKind::Sign, 2),
        _ if !first.is_ascii() && XID_START(first) => (LexemeKind::Word, word_length(text)),
        _ => (LexemeKind::Sign, first.len_utf8()),
    })
}

fn word_length(text: &str) -> usize {
    text.find(|c| !is_word_char(c)).unwrap_or(text.len())
}

/// Returns the length of the number that a text begins with: `12`, `1.5`, `.5e-3`. In `0..3` the number is `0`.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let whole = digits(0);
    let fraction = if text[whole..].starts_with('.') { digits(whole + 1) } else { 0 };
    let mantissa = if fraction > 0 { whole + 1 + fraction } else { whole };
    let Some(exponent) = text[mantissa..].strip_prefix(['e', 'E']) else { return mantissa };
    let sign = usize::from(exponent.starts_with(['+', '-']));
    match digits(mantissa + 1 + sign) {
        0 => mantissa,
        count => mantissa + 1 + sign + count,
    }
}

#[cfg(test)]
mod tests {
    use super::{LexemeKind, Lexer, tokens};
    use crate::grammar::{Grammar, Rule};
    use pest::Parser;

    #[test]
    fn every_text_has_tokens() {
        let texts = |text| Lexer::new(text, 0).map(|token| token.text).collect::<Vec<_>>().join("|");
        assert_eq!(texts("p[k in 0..n]=.5e-3 mm^-2 // c \n"), "p|[|k|in|0|..|n|]|=|.5e-3|mm|^|-|2|// c");
        assert_eq!(texts("0..=3 2e 1.5E+3x \"a//b\" \"c \n1.2.3"), "0|..=|3|2|e|1.5E+3|x|\"a//b\"|\"c|1.2|.3");
        assert_eq!(texts("größe<=e\u{301}==-滑 m²"), "größe|<=|e\u{301}|==|-|滑|m|²");
        let all: Vec<_> = Lexer::new("a\r\n\r\n/// b\nc", 0).collect();
        assert_eq!(all.iter().map(|token| token.lines_before).collect::<Vec<_>>(), [0, 2, 1]);
        assert_eq!(all[1].kind, LexemeKind::Comment);
    }

    #[test]
    fn words_numbers_and_strings_of_the_grammar_are_tokens() {
        let texts = [
            include_str!("../../../examples/table_driven.mech"),
            include_str!("../../../examples/cam_with_dwells.mech"),
            include_str!("../../../tests/stages/everything/input.mech"),
            include_str!("../../../tests/format/everything.mech"),
            "mechanism größe { param e\u{301} = .5e+3mm^-2/a//c\n+1e3-2e3 body b[k in 0..=3]{} ground{point 滑=(0,1)} }",
        ];
        for text in texts {
            let all = tokens(text);
            let pairs = Grammar::parse(Rule::file, text).expect("a text without faults").flatten();
            let is_terminal = |rule| {
                matches!(rule, Rule::name | Rule::word | Rule::number | Rule::string | Rule::infix | Rule::through)
                    || format!("{rule:?}").starts_with("kw_")
            };
            for pair in pairs.filter(|pair| is_terminal(pair.as_rule())) {
                let span = pair.as_span();
                let is_one = |token: &super::Token<'_>| token.start == span.start() && token.end() == span.end();
                assert!(all.iter().any(is_one), "{:?} in {text}", pair.as_str());
            }
        }
    }
}
