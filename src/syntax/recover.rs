//! Going on after a fault: the declaration that holds it is blanked out, and the rest is read again.
//!
//! Blanks keep every byte's place, so that what is read later has its true place in the text. A brace that is missing is
//! put where white space was. Braces are never torn apart: a fault in the head of a block takes the whole block with it.

use super::depth::next_token;
use crate::vocabulary::{Keyword, is_declaration, is_feature};
use std::ops::Range;

/// A declaration as far as words and braces tell.
struct Declaration {
    /// From its keyword to the next declaration's, or to the brace that closes the block around it.
    extent: Range<usize>,
    /// Its own block, from brace to brace.
    block: Option<Range<usize>>,
    /// Whether it begins with a keyword.
    is_known: bool,
}

/// Blanks out the declaration in which a fault at a byte offset lies; says whether there is something left to read.
///
/// `begins` is for a fault that stays where it was although the declaration before it is gone: then it is the one that
/// begins there.
pub(super) fn blank(text: &mut String, at: usize, begins: bool) -> bool {
    if put_missing_brace(text, at) {
        return true;
    }
    let Some(declarations) = declarations(text) else {
        return false;
    };
    let range = if begins { beginning_at(&declarations, at) } else { faulty(&declarations, at) };
    let Some(range) = range.filter(|range| !range.is_empty()) else {
        return false;
    };
    let blanks: String = text[range.clone()]
        .chars()
        .map(|c| if c == '\n' { "\n".to_owned() } else { " ".repeat(c.len_utf8()) })
        .collect();
    text.replace_range(range, &blanks);
    true
}

/// Puts a brace that is missing before a declaration, where the fault is just that: the one that closes a body or the
/// ground, or the one that opens the mechanism.
fn put_missing_brace(text: &mut String, at: usize) -> bool {
    let tokens = tokens(text);
    let Some(k) = tokens.iter().position(|&(start, _)| start == at) else {
        return false;
    };
    let braces = |tokens: &[(usize, &str)]| {
        tokens.iter().fold(0_isize, |depth, (_, token)| depth + isize::from(*token == "{") - isize::from(*token == "}"))
    };
    let word = tokens[k].1;
    let is_large = is_declaration(word) && !is_feature(word) && word != "mechanism";
    let has_head = k >= 2 && tokens[k - 2].1 == "mechanism";
    // what stands before it must be complete
    let begun = tokens[..k].iter().rposition(|(_, token)| is_declaration(token)).unwrap_or(0);
    let count = |wanted: &str| tokens[begun..k].iter().filter(|(_, token)| *token == wanted).count();
    let ends = k > 0 && tokens[k - 1].1.ends_with(|c: char| c.is_alphanumeric() || c == ')' || c == '}' || c == '{');
    let is_complete = ends && count("(") == count(")") && !is_name_of(&tokens, k);
    let (brace, depth_after) = match braces(&tokens[..k]) {
        _ if !is_complete => return false,
        _ if !is_large || !text[..at].ends_with(|c: char| c.is_ascii_whitespace()) => return false,
        2 => ("}", braces(&tokens) - 1),
        0 if has_head => ("{", braces(&tokens) + 1),
        _ => return false,
    };
    text.replace_range(at - 1..at, brace);
    // who writes blocks without braces leaves both out; a comment may end the text
    if brace == "{" && depth_after == 1 {
        text.push_str("\n}");
    }
    true
}

/// Whether a fault is at a word that was refused as a name before, and is used as one here.
pub(super) fn uses_bad_name(text: &str, at: usize, bad_names: &[String]) -> bool {
    let tokens = tokens(text);
    let Some(k) = tokens.iter().position(|&(start, _)| start == at) else {
        return false;
    };
    // the name itself, or what follows it
    [k, k.saturating_sub(1)].iter().any(|&k| bad_names.iter().any(|name| name == tokens[k].1))
}

/// The keyword that stands at a place where a name should.
pub(super) fn bad_name(text: &str, at: usize) -> Option<String> {
    let tokens = tokens(text);
    let k = tokens.iter().position(|&(start, _)| start == at)?;
    (is_declaration(tokens[k].1) && is_name_of(&tokens, k)).then(|| tokens[k].1.to_owned())
}

fn tokens(text: &str) -> Vec<(usize, &str)> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(token) = next_token(&mut rest) {
        tokens.push((text.len() - rest.len() - token.len(), token));
    }
    tokens
}

/// Whether a token stands where the name of the declaration before it does.
fn is_name_of(tokens: &[(usize, &str)], k: usize) -> bool {
    let takes_name = |word: &str| is_declaration(word) && !["ground", "analysis"].contains(&word);
    k > 0 && takes_name(tokens[k - 1].1) && !is_name_of(tokens, k - 1)
}

/// Whether a declaration begins at a token: by its keyword, or by a word in the place of one.
fn begins_declaration(tokens: &[(usize, &str)], k: usize) -> bool {
    let token = |k: usize| tokens.get(k).map_or("", |&(_, token)| token);
    // `ground.O` is a point, `joint joint: …` has a name that is none
    if token(k + 1) == "." || is_name_of(tokens, k) {
        return false;
    }
    if is_declaration(token(k)) {
        return true;
    }
    let is_word = |token: &str| token.starts_with(char::is_alphabetic) && !is_joining(token);
    // `30 mm` and `a.b` go on with a word
    let before = if k > 0 { token(k - 1) } else { "" };
    let is_after_operand = before == "." || before.starts_with(|c: char| c.is_ascii_digit()) || is_name_of(tokens, k);
    if !is_word(token(k)) || is_after_operand {
        return false;
    }
    let is_equation = token(k + 2) == "=" && token(k + 3) != "=";
    let is_block = token(k + 1) == "{" && ["{", "}"].contains(&before);
    is_block
        || (is_word(token(k + 1)) && (is_equation || [":", "{", "at"].contains(&token(k + 2))))
        || token(k + 1) == "from"
}

/// Whether a word of the language stands between the parts of a declaration or formula.
fn is_joining(word: &str) -> bool {
    Keyword::named(word).is_some_and(Keyword::is_joining)
}

fn beginning_at(declarations: &[Declaration], at: usize) -> Option<Range<usize>> {
    declarations.iter().find(|declaration| declaration.extent.start == at).map(|declaration| declaration.extent.clone())
}

/// What has to go for a fault: the innermost declaration around it or before it.
fn faulty(declarations: &[Declaration], at: usize) -> Option<Range<usize>> {
    let holds = |declaration: &&Declaration| declaration.extent.start < at && at <= declaration.extent.end;
    // a word that is no keyword begins what has to go
    let own = declarations.iter().find(|declaration| declaration.extent.start == at && !declaration.is_known);
    if let Some(own) = own {
        return Some(own.extent.clone());
    }
    let innermost = declarations.iter().filter(holds).max_by_key(|declaration| declaration.extent.start)?;
    match &innermost.block {
        // behind the block: what stands there belongs to nothing
        Some(block) if at >= block.end && at < innermost.extent.end => Some(at..innermost.extent.end),
        // right behind it stands the next declaration, or what closes the block around
        Some(block) if at >= block.end => beginning_at(declarations, at),
        // a mechanism is not blanked for what stands in it
        Some(block) if at > block.start && at < block.end => {
            let end = declarations.iter().map(|d| d.extent.start).find(|&start| start > at).unwrap_or(block.end - 1);
            Some(at..end.min(block.end - 1))
        }
        _ => Some(innermost.extent.clone()),
    }
}

/// All declarations; `None` where a brace closes nothing. A block that nothing closes ends with the text.
fn declarations(text: &str) -> Option<Vec<Declaration>> {
    let mut done: Vec<Declaration> = Vec::new();
    // those that are not complete, outermost first, each with the depth of braces around it
    let mut open: Vec<(usize, Declaration)> = Vec::new();
    let mut depth = 0;
    let tokens = tokens(text);
    for (k, &(start, token)) in tokens.iter().enumerate() {
        match token {
            "{" => {
                if let Some((around, declaration)) = open.last_mut()
                    && *around == depth
                {
                    // as if its brace stood behind the text
                    declaration.block = Some(start..text.len() + 1);
                }
                depth += 1;
            }
            "}" => {
                close(&mut open, &mut done, depth, start);
                depth = usize::checked_sub(depth, 1)?;
                if let Some((around, declaration)) = open.last_mut()
                    && *around == depth
                    && let Some(block) = &mut declaration.block
                {
                    block.end = start + 1;
                }
            }
            _ if begins_declaration(&tokens, k) => {
                close(&mut open, &mut done, depth, start);
                let is_known = is_declaration(token);
                open.push((depth, Declaration { extent: start..text.len(), block: None, is_known }));
            }
            _ => {}
        }
    }
    close(&mut open, &mut done, 0, text.len());
    done.sort_by_key(|declaration| declaration.extent.start);
    Some(done)
}

/// Ends the declarations that stand in as many braces, or in more.
fn close(open: &mut Vec<(usize, Declaration)>, done: &mut Vec<Declaration>, depth: usize, end: usize) {
    while let Some((_, mut declaration)) = open.pop_if(|(around, _)| *around >= depth) {
        declaration.extent.end = end;
        done.push(declaration);
    }
}
