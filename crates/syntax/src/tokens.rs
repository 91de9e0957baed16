//! Words and characters of a text, as far as they determine where declarations begin and end.
//!
//! Tokens are coarser than the grammar and never fail: they serve for texts with faults, and before parsing.

use mechc_text::vocabulary::{Keyword, Role, is_declaration};

/// A word or character.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Token<'a> {
    /// First byte.
    pub start: usize,
    /// Text.
    pub text: &'a str,
}

impl Token<'_> {
    /// Returns the byte behind it.
    #[must_use]
    pub fn end(self) -> usize {
        self.start + self.text.len()
    }
}

/// Returns all tokens of a text.
#[must_use]
pub fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(token) = next_token(&mut rest) {
        tokens.push(Token { start: text.len() - rest.len() - token.len(), text: token });
    }
    tokens
}

/// Returns the next word or character that is neither comment, string nor white space.
pub(super) fn next_token<'a>(rest: &mut &'a str) -> Option<&'a str> {
    loop {
        let text = rest.trim_start();
        let first = text.chars().next()?;
        let length = if text.starts_with("//") {
            *rest = text.split_once('\n').map_or("", |(_, after)| after);
            continue;
        } else if first == '"' {
            // a string ends on its line, or is no string
            match text[1..].find(['"', '\n']) {
                Some(end) => end + 2,
                None => text.len(),
            }
        } else if first.is_ascii_digit() {
            text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len())
        } else if first.is_alphanumeric() || first == '_' {
            text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len())
        } else if text.starts_with("==") || text.starts_with("<=") || text.starts_with(">=") || text.starts_with("!=") {
            2
        } else {
            first.len_utf8()
        };
        let (token, after) = text.split_at(length);
        *rest = after;
        return Some(token);
    }
}

/// Returns whether a token is a keyword that begins a declaration: `ground.O` is a point, and `ground` as an operand denotes the body.
#[must_use]
pub fn begins_declaration(text: &str, token: Token<'_>) -> bool {
    let behind = text[token.end()..].trim_start();
    if !is_declaration(token.text) || behind.starts_with('.') {
        return false;
    }
    let before = text[..token.start].trim_end();
    let is_first = text[before.len()..token.start].contains('\n') || before.is_empty() || before.ends_with(['{', '}']);
    let is_operand = before.ends_with(['(', '[', ',', '=', '+', '-', '*', '/', '^', '<', '>']);
    token.text != "ground" || behind.starts_with('{') || is_first && !is_operand
}

/// Returns the words of a text that are keywords in their positions, judging by adjacent tokens, each with its first byte.
pub fn keywords_in(text: &str) -> impl Iterator<Item = (usize, &'static Keyword)> {
    let tokens = tokens(text);
    let keyword = |at: usize| {
        let keyword = Keyword::named(tokens[at].text)?;
        let text_at = |at: Option<usize>| at.and_then(|at| tokens.get(at)).map_or("", |token| token.text);
        let begins_window = || {
            let is_apart = tokens.get(at + 1).is_some_and(|behind| behind.start > tokens[at].end());
            let is_behind_comma = text_at(at.checked_sub(1)) == ",";
            is_behind_comma
                && matches!(tokens[at].text, "from" | "to")
                && may_begin_a_bound(text_at(Some(at + 1)), is_apart)
        };
        let is_one = keyword.is_reserved()
            || !is_name(keyword.role, text_at(at.checked_sub(1)), text_at(Some(at + 1)))
            || begins_window();
        is_one.then_some((tokens[at].start, keyword))
    };
    (0..tokens.len()).filter_map(keyword).collect::<Vec<_>>().into_iter()
}

/// Returns whether a token can begin a time behind `from` or `to` in a call; before other tokens these are names, and an adjacent bracket
/// is that of a call.
pub fn may_begin_a_bound(token: &str, is_apart: bool) -> bool {
    let begins_operand = |c: char| c.is_alphanumeric() || c == '_';
    match token {
        "(" => is_apart,
        "and" | "or" => false,
        _ => token.trim_start_matches('.').starts_with(begins_operand),
    }
}

/// Returns whether a word that may be a name is one between two tokens: a connecting word stands behind an operand, and a keyword not next to a dot.
fn is_name(role: Role, before: &str, behind: &str) -> bool {
    let is_declared = is_declaration(before) && !matches!(before, "analysis" | "ground");
    let is_operand = matches!(before, "(" | "+" | "-" | "*" | "/" | "^" | "<" | ">" | ",") && role != Role::Side;
    before == "." || behind == "." || is_declared || is_operand
}
