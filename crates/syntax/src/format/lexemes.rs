//! All that a text is made of besides white space, to the last character: what the formatter puts in its place.

use std::str::Chars;

/// Kinds of lexemes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Shape {
    /// A name, a unit, a keyword.
    Word,
    /// A number with its exponent, without its unit.
    Number,
    /// A string with its quotes.
    Quoted,
    /// A comment from its slashes to the end of the line, without trailing white space.
    Comment,
    /// Anything else.
    Sign,
}

/// A word, number, string, comment or sign of a text.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Lexeme<'a> {
    pub start: usize,
    pub text: &'a str,
    pub shape: Shape,
    /// Number of line ends before it.
    pub lines_before: usize,
}

impl Lexeme<'_> {
    pub fn end(&self) -> usize {
        self.start + self.text.len()
    }

    pub fn is_comment(&self) -> bool {
        self.shape == Shape::Comment
    }
}

/// Signs of more than one character, the longer ones first.
const LONG_SIGNS: [&str; 6] = ["..=", "..", "==", "<=", ">=", "!="];

/// Returns all lexemes of a text, in order. Words and numbers end as in the grammar; invalid texts have lexemes too.
pub(super) fn lexemes(text: &str) -> Vec<Lexeme<'_>> {
    let (mut found, mut end) = (Vec::new(), 0);
    loop {
        let start = text.len() - text[end..].trim_start().len();
        let Some((shape, length)) = first(&text[start..]) else { return found };
        let lines_before = text[end..start].matches('\n').count();
        found.push(Lexeme { start, text: &text[start..start + length], shape, lines_before });
        end = start + length;
    }
}

/// Returns the shape and the length of the first lexeme of a text.
fn first(text: &str) -> Option<(Shape, usize)> {
    let first = text.chars().next()?;
    if text.starts_with("//") {
        let line = text.split_once('\n').map_or(text, |(line, _)| line);
        return Some((Shape::Comment, line.trim_end().len()));
    }
    if let Some(sign) = LONG_SIGNS.iter().find(|sign| text.starts_with(**sign)) {
        return Some((Shape::Sign, sign.len()));
    }
    if let Some(length) = number(text) {
        return Some((Shape::Number, length));
    }
    if first == '"' {
        // a string ends on its line, or is no string
        return Some(match text[1..].find(['"', '\n']) {
            Some(end) if text[1 + end..].starts_with('"') => (Shape::Quoted, end + 2),
            _ => (Shape::Sign, 1),
        });
    }
    if is_of_a_word(first) {
        return Some((Shape::Word, text.find(|c| !is_of_a_word(c)).unwrap_or(text.len())));
    }
    Some((Shape::Sign, first.len_utf8()))
}

/// Returns whether a character can be part of a name: beyond ASCII nothing else occurs outside of strings and comments.
fn is_of_a_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || !c.is_ascii() && !c.is_whitespace()
}

/// Returns the length of the number that a text begins with: `12`, `1.5`, `.5e-3`. In `0..3` the number is `0`.
fn number(text: &str) -> Option<usize> {
    let digits = |from: &str| from.len() - skip_digits(from.chars()).as_str().len();
    let whole = digits(text);
    let point = text[whole..].strip_prefix('.').map_or(0, digits);
    let mantissa = if point > 0 { whole + 1 + point } else { whole };
    if mantissa == 0 {
        return None;
    }
    let behind = text[mantissa..].strip_prefix(['e', 'E']);
    let signed = behind.map(|exponent| exponent.strip_prefix(['+', '-']).unwrap_or(exponent));
    let exponent = signed.filter(|signed| digits(signed) > 0);
    Some(exponent.map_or(mantissa, |signed| text.len() - signed.len() + digits(signed)))
}

fn skip_digits(mut chars: Chars<'_>) -> Chars<'_> {
    loop {
        let behind = chars.clone();
        match chars.next() {
            Some(c) if c.is_ascii_digit() => {}
            _ => return behind,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Shape, lexemes};

    #[test]
    fn lexemes_match_the_grammar() {
        let texts = |text| lexemes(text).iter().map(|lexeme| lexeme.text).collect::<Vec<_>>().join("|");
        assert_eq!(texts("p[k in 0..n]=.5e-3 mm^-2 // c \n"), "p|[|k|in|0|..|n|]|=|.5e-3|mm|^|-|2|// c");
        assert_eq!(texts("0..=3 2e 1.5E+3x \"a//b\" \"c"), "0|..=|3|2|e|1.5E+3|x|\"a//b\"|\"|c");
        assert_eq!(texts("größe<=é==-滑"), "größe|<=|é|==|-|滑");
        let lines = lexemes("a\r\n\r\n/// b\nc");
        assert_eq!(lines.iter().map(|lexeme| lexeme.lines_before).collect::<Vec<_>>(), [0, 2, 1]);
        assert_eq!(lines[1].shape, Shape::Comment);
    }
}
