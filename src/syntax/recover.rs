//! Going on after a fault: the declaration that holds it is blanked out, and the rest is read again.
//!
//! Blanks keep every byte's place, so that what is read later has its true place in the text. Braces are never torn
//! apart: a fault in the head of a block takes the whole block with it, and where braces do not match there is no going on,
//! since everything behind would look wrong.

use super::DECLARATIONS;
use super::depth::next_token;
use std::ops::Range;

/// A declaration as far as words and braces tell.
struct Declaration {
    /// From its keyword to the next declaration's, or to the brace that closes the block around it.
    extent: Range<usize>,
    /// Its own block, from brace to brace.
    block: Option<Range<usize>>,
}

/// Blanks out the declaration in which a fault at a byte offset lies; says whether there is something left to read.
///
/// `begins` is for a fault that stays where it was although the declaration before it is gone: then it is the one that
/// begins there.
pub(super) fn blank(text: &mut String, at: usize, begins: bool) -> bool {
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

fn beginning_at(declarations: &[Declaration], at: usize) -> Option<Range<usize>> {
    declarations.iter().find(|declaration| declaration.extent.start == at).map(|declaration| declaration.extent.clone())
}

/// What has to go for a fault: the innermost declaration around it or before it.
fn faulty(declarations: &[Declaration], at: usize) -> Option<Range<usize>> {
    let holds = |declaration: &&Declaration| declaration.extent.start < at && at <= declaration.extent.end;
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

/// All declarations; `None` where braces do not match.
fn declarations(text: &str) -> Option<Vec<Declaration>> {
    let mut done: Vec<Declaration> = Vec::new();
    // those that are not complete, outermost first, each with the depth of braces around it
    let mut open: Vec<(usize, Declaration)> = Vec::new();
    let (mut depth, mut rest) = (0, text);
    while let Some(token) = next_token(&mut rest) {
        let start = text.len() - rest.len() - token.len();
        match token {
            "{" => {
                if let Some((around, declaration)) = open.last_mut()
                    && *around == depth
                {
                    declaration.block = Some(start..text.len());
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
            // `ground.O` is a point
            word if DECLARATIONS.contains(&word) && !(word == "ground" && rest.trim_start().starts_with('.')) => {
                close(&mut open, &mut done, depth, start);
                open.push((depth, Declaration { extent: start..text.len(), block: None }));
            }
            _ => {}
        }
    }
    (depth == 0).then(|| {
        close(&mut open, &mut done, 0, text.len());
        done.sort_by_key(|declaration| declaration.extent.start);
        done
    })
}

/// Ends the declarations that stand in as many braces, or in more.
fn close(open: &mut Vec<(usize, Declaration)>, done: &mut Vec<Declaration>, depth: usize, end: usize) {
    while let Some((_, mut declaration)) = open.pop_if(|(around, _)| *around >= depth) {
        declaration.extent.end = end;
        done.push(declaration);
    }
}
