//! Limit of the nesting depth, checked before anything recurses.
//!
//! The parser and every pass over the tree recurse once per level, so a piece of text is measured first: an `if` opens a level like a
//! bracket, and its last `else` closes it. Parentheses behind that `else` are one level here and two in the tree, whose builder counts them,
//! as it counts prefix operators and chains of `^`, for which the parser needs no stack.

use super::errors;
use super::lexer::Token;
use mechc_text::diag::Diagnostic;
use mechc_text::source::{FileId, Span};

/// Deepest nesting that is accepted.
pub const DEEPEST: usize = 200;

/// Stack that a text of this depth may need, in bytes.
pub(super) const STACK: usize = 16 << 20;

/// Rejects a piece of text, by its tokens, if it nests deeper than [`DEEPEST`].
pub fn measure(tokens: &[Token<'_>], file: FileId) -> Result<(), Box<Diagnostic>> {
    // each level takes a token at least
    if tokens.len() <= DEEPEST {
        return Ok(());
    }
    let mut depth = 0_usize;
    for token in tokens {
        match token.text {
            "(" | "[" | "if" => depth += 1,
            ")" | "]" | "else" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            let span = Span { file, start: token.start as u32, end: token.end() as u32 };
            return Err(Box::new(errors::too_deep(span, DEEPEST)));
        }
    }
    Ok(())
}
