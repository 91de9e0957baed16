//! Limit of the nesting depth, checked before anything recurses.
//!
//! The parser and every pass over the tree recurse once per level, so the text is measured first: open parentheses, and each `if` inside
//! another one. Prefix operators and chains of `^` need no stack in the parser; the tree builder counts them.

use super::errors;
use super::tokens::next_token;
use mechc_text::diag::Diagnostic;
use mechc_text::source::{FileId, Span};
use mechc_text::vocabulary::is_declaration;

/// Deepest nesting that is accepted.
pub const DEEPEST: usize = 200;

/// Stack that a text of this depth may need, in bytes.
pub(super) const STACK: usize = 16 << 20;

/// Rejects a piece of text, which begins at byte `base`, if it nests deeper than [`DEEPEST`].
pub fn measure(text: &str, file: FileId, base: usize) -> Result<(), Box<Diagnostic>> {
    // each level takes a character at least
    if text.len() <= DEEPEST {
        return Ok(());
    }
    // for each open parenthesis, the `if`s that stand open inside it: whether the last `else` has been read
    let mut levels: Vec<Vec<bool>> = vec![Vec::new()];
    let mut ifs = 0;
    let mut after_else = false;
    let mut rest = text;
    while let Some(token) = next_token(&mut rest) {
        let at = (base + text.len() - rest.len() - token.len()) as u32;
        let is_else_if = std::mem::replace(&mut after_else, token == "else") && token == "if";
        let parentheses = levels.len() - 1;
        let Some(level) = levels.last_mut() else { break };
        match token {
            "(" => levels.push(Vec::new()),
            ")" if parentheses > 0 => ifs -= levels.pop().map_or(0, |level| level.len()),
            // the `else` before was not the last
            "if" if is_else_if => set_last(level, false),
            "if" => {
                ifs += 1;
                level.push(false);
            }
            // these belong to an `if` that is not complete; the complete ones inside it end here
            "then" | "else" => {
                while level.pop_if(|complete| *complete).is_some() {
                    ifs -= 1;
                }
                set_last(level, token == "else");
            }
            "," | "=" | "}" => ifs -= std::mem::take(level).len(),
            // `ground.O` is a point
            word if is_declaration(word) && !rest.trim_start().starts_with('.') => {
                levels = vec![Vec::new()];
                ifs = 0;
            }
            _ => {}
        }
        if levels.len() - 1 + ifs > DEEPEST {
            let span = Span { file, start: at, end: at + token.len() as u32 };
            return Err(Box::new(errors::too_deep(span, DEEPEST)));
        }
    }
    Ok(())
}

fn set_last(level: &mut [bool], after_last_else: bool) {
    if let Some(last) = level.last_mut() {
        *last = after_last_else;
    }
}
