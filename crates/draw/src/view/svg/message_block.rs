//! Messages in lines below a picture.

use super::style::{COLUMN_WIDTH, letter_size, text_columns};
use crate::view::text::{decimal, escape};
use std::fmt::Write;

/// Distance of lines, and space above and below them, in sizes of letters.
const LINE_HEIGHT: f64 = 1.35;
const PADDING: f64 = 0.6;
/// Greatest part of the height of a picture with a given size.
const MOST_OF_HEIGHT: f64 = 0.4;
/// Least width of a line in columns.
const NARROWEST: f64 = 8.0;

/// Decimals of pixels.
const DECIMALS: usize = 2;

/// Messages broken into lines.
#[derive(Default)]
pub(super) struct MessageBlock {
    rows: Vec<String>,
    /// Size of letters (px).
    letters: f64,
    /// Height of all lines with the space around them (px).
    pub height: f64,
}

impl MessageBlock {
    /// Breaks messages into lines below a picture of a size (px) with margins. With `within` only as many remain as the picture has room
    /// for.
    pub fn new(messages: &[String], size: [f64; 2], margin: f64, within: bool) -> MessageBlock {
        let letters = letter_size(size);
        let width = ((size[0] - 2.0 * margin) / (COLUMN_WIDTH * letters)).max(NARROWEST);
        let mut lines: Vec<String> = messages.iter().flat_map(|message| wrap(message, width)).collect();
        let height =
            |count: usize| if count == 0 { 0.0 } else { letters * (LINE_HEIGHT * count as f64 + 2.0 * PADDING) };
        let all = lines.len();
        while within && height(lines.len()) > MOST_OF_HEIGHT * size[1] {
            lines.pop();
        }
        if lines.len() < all
            && let Some(last) = lines.last_mut()
        {
            last.push_str(" …");
        }
        let height = height(lines.len());
        MessageBlock { rows: lines, letters, height }
    }

    /// Writes the lines at the bottom of a picture of a size (px) with margins.
    pub fn svg(&self, size: [f64; 2], margin: f64) -> String {
        let top = size[1] - self.height + PADDING * self.letters;
        let mut text = String::new();
        for (row, line) in self.rows.iter().enumerate() {
            let y = decimal(top + self.letters * (LINE_HEIGHT * row as f64 + 1.0), DECIMALS);
            let _ = writeln!(text, "<text class=\"said\" x=\"{margin}\" y=\"{y}\">{}</text>", escape(line));
        }
        text
    }

    /// Returns the size of letters (px), or `None` without messages.
    pub fn letters(&self) -> Option<f64> {
        (!self.rows.is_empty()).then_some(self.letters)
    }
}

/// Breaks a text into lines of at most `width` columns; longer words stay whole.
fn wrap(text: &str, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in unbreakable_words(text) {
        match lines.last_mut() {
            Some(line) if (text_columns(line) + 1 + text_columns(&word)) as f64 <= width => {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    lines
}

/// Splits a text into words. A number and its unit are one word, and so are the two sides of `=`.
fn unbreakable_words(text: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match words.last_mut() {
            Some(last) if word == "=" || last.ends_with(" =") || is_unit_of(last, word) => {
                last.push(' ');
                last.push_str(word);
            }
            _ => words.push(word.to_owned()),
        }
    }
    words
}

/// Returns whether a word is the unit of the number before it.
fn is_unit_of(number: &str, word: &str) -> bool {
    let number = number.rsplit([' ', '(']).next().unwrap_or(number);
    let is_number = number.parse::<f64>().is_ok() && number.ends_with(|c: char| c.is_ascii_digit());
    is_number && word.starts_with(|c: char| c.is_alphabetic() || c == '°')
}

#[cfg(test)]
mod tests {
    use super::{MessageBlock, wrap};

    #[test]
    fn lines_are_no_wider_than_there_is_room() {
        assert_eq!(wrap("a bb ccc dddd", 6.0), ["a bb", "ccc", "dddd"]);
        assert_eq!(wrap("incomprehensibilities are", 6.0), ["incomprehensibilities", "are"]);
        assert!(wrap(" ", 6.0).is_empty());
    }

    #[test]
    fn numbers_keep_their_units() {
        assert_eq!(wrap("at t = 0 s: off by 60 mm", 8.0), ["at", "t = 0 s:", "off by", "60 mm"]);
        assert_eq!(wrap("`rod` (30 mm from `A`)", 9.0), ["`rod`", "(30 mm", "from `A`)"]);
        assert_eq!(wrap("joint 2, nan mm", 8.0), ["joint 2,", "nan mm"]);
    }

    #[test]
    fn a_given_size_keeps_most_of_its_room() {
        let messages = ["word ".repeat(400)];
        let within = MessageBlock::new(&messages, [400.0, 300.0], 14.0, true);
        assert!(within.height <= 120.0 && within.rows.last().is_some_and(|line| line.ends_with('…')));
        let below = MessageBlock::new(&messages, [400.0, 300.0], 14.0, false);
        assert!(below.height > 300.0 && below.rows.len() > within.rows.len());
        assert!(MessageBlock::new(&[], [400.0, 300.0], 14.0, true).height <= 0.0);
    }
}
