//! A MATLAB formula as words and signs.

use super::{Built, functions};
use crate::import::errors;
use crate::import::value::Quoted;
use mechc_text::source::Span;

/// Kinds of tokens.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum TokenKind<'a> {
    Number(f64),
    Name(&'a str),
    Sign(&'static str),
}

/// A word or sign with its place in the model file.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Token<'a> {
    pub kind: TokenKind<'a>,
    pub span: Span,
    /// Words.
    pub text: &'a str,
}

/// All signs that are read, those before their beginnings.
const SIGNS: &[&str] = &[
    ".*", "./", ".\\", ".^", ".'", "<=", ">=", "==", "~=", "&&", "||", "+", "-", "*", "/", "\\", "^", "'", "<", ">",
    "&", "|", "~", "(", ")", ",",
];

/// Signs of MATLAB that have no place in a formula of real numbers, with the help they need.
const REFUSED: &[(&str, &str)] = &[
    ("[", "matrices cannot be translated; a formula is one number at every time"),
    ("{", "cells cannot be translated; a formula is one number at every time"),
    (":", "ranges cannot be translated; a formula is one number at every time"),
    ("@", "write the formula alone, without `@(t)`"),
    (";", "leave the `;` out"),
    ("=", "equality is compared with `==`"),
    ("\"", "text has no value here"),
    ("!", "\"not equal\" is `~=` in MATLAB"),
    ("%", "leave the comment out"),
];

/// Returns the tokens of a formula.
pub(super) fn tokens(text: &Quoted) -> Built<Vec<Token<'_>>> {
    let written = text.text.as_str();
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(rest) = written.get(at..).filter(|rest| !rest.is_empty()) {
        let white = rest.len() - rest.trim_start().len();
        if white > 0 {
            at += white;
            continue;
        }
        let (kind, length) = next(rest, text, at)?;
        let words = rest.get(..length).unwrap_or("");
        tokens.push(Token { kind, span: text.place(at, at + length), text: words });
        at += length;
    }
    Ok(tokens)
}

fn next<'a>(rest: &'a str, text: &Quoted, at: usize) -> Built<(TokenKind<'a>, usize)> {
    let digit = |byte: Option<&u8>| byte.is_some_and(u8::is_ascii_digit);
    let bytes = rest.as_bytes();
    if digit(bytes.first()) || bytes.first() == Some(&b'.') && digit(bytes.get(1)) {
        return number(rest, text, at);
    }
    let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    if rest.starts_with(|c: char| c.is_ascii_alphabetic()) {
        let length = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
        return Ok((TokenKind::Name(rest.get(..length).unwrap_or("")), length));
    }
    if let Some(sign) = SIGNS.iter().find(|sign| rest.starts_with(**sign)) {
        return Ok((TokenKind::Sign(sign), sign.len()));
    }
    let first = rest.chars().next().unwrap_or(' ');
    let span = text.place(at, at + first.len_utf8());
    let help = REFUSED.iter().find(|(sign, _)| rest.starts_with(sign)).map(|(_, help)| (*help).to_owned());
    let message = format!("`{first}` cannot stand in a formula");
    Err(Box::new(errors::fault(span, message, "not understood").help_if(help)))
}

/// Reads a number: `3`, `3.`, `.5`, `1e-3`, `1d3`; the point of `1.*t` belongs to the `*`.
fn number<'a>(rest: &'a str, text: &Quoted, at: usize) -> Built<(TokenKind<'a>, usize)> {
    let digits = |from: usize| {
        let tail = rest.get(from..).unwrap_or("");
        from + tail.find(|c: char| !c.is_ascii_digit()).unwrap_or(tail.len())
    };
    let byte = |at: usize| rest.as_bytes().get(at).copied().unwrap_or(b' ');
    let mut end = digits(0);
    if byte(end) == b'.' && !b"*/\\^'".contains(&byte(end + 1)) {
        end = digits(end + 1);
    }
    if b"eEdD".contains(&byte(end)) {
        let sign = usize::from(b"+-".contains(&byte(end + 1)));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    let tail = rest.get(end..).unwrap_or("");
    let stuck = tail.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(tail.len());
    if stuck > 0 {
        let word = tail.get(..stuck).unwrap_or("");
        let span = text.place(at, at + end + stuck);
        let number = rest.get(..end).unwrap_or("");
        let fault = if matches!(word, "i" | "j") {
            errors::fault(span, "formulas have real values only", "an imaginary number")
        } else {
            let message = format!("`{number}{word}` is no number");
            let is_factor = functions::is_known(word);
            let help = is_factor.then(|| format!("a product is written with `*`: `{number}*{word}`"));
            errors::fault(span, message, "no number").help_if(help)
        };
        return Err(Box::new(fault));
    }
    let written = rest.get(..end).unwrap_or("").replace(['d', 'D'], "e");
    let value: f64 = written.parse().unwrap_or(f64::NAN);
    if value.is_finite() {
        return Ok((TokenKind::Number(value), end));
    }
    Err(Box::new(errors::fault(text.place(at, at + end), "this number is not finite", "not finite")))
}
