//! Which words are keywords in their positions, judging by the tokens around them: for texts with faults, and without a tree.

use super::lexer::{is_word_char, tokens};
use mechc_text::vocabulary::{Keyword, Role, is_declaration};
use std::ops::Range;

/// Returns whether the token in a range is a keyword that begins a declaration: `ground.O` is a point, and `ground` as an operand denotes
/// the body.
#[must_use]
pub fn begins_declaration(text: &str, token: Range<usize>) -> bool {
    let (word, behind) = (&text[token.clone()], text[token.end..].trim_start());
    if !is_declaration(word) || behind.starts_with('.') {
        return false;
    }
    let before = text[..token.start].trim_end();
    let is_first = text[before.len()..token.start].contains('\n') || before.is_empty() || before.ends_with(['{', '}']);
    let is_operand = before.ends_with(['(', '[', ',', '=', '+', '-', '*', '/', '^', '<', '>']);
    word != "ground" || behind.starts_with('{') || is_first && !is_operand
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
    match token {
        "(" => is_apart,
        "and" | "or" => false,
        _ => token.trim_start_matches('.').starts_with(is_word_char),
    }
}

/// Returns whether a word that may be a name is one between two tokens: a connecting word stands behind an operand, and a keyword not next to a dot.
fn is_name(role: Role, before: &str, behind: &str) -> bool {
    let is_declared = is_declaration(before) && !matches!(before, "analysis" | "ground");
    let is_operand = matches!(before, "(" | "+" | "-" | "*" | "/" | "^" | "<" | ">" | ",") && role != Role::Side;
    before == "." || behind == "." || is_declared || is_operand
}
