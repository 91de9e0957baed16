//! Trivia: comments and blank lines.

use super::lexer::Token;
use mechc_text::source::{FileId, Span};

/// The parts of a text that are not in its tree.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Trivia {
    /// Comments, in order.
    pub comments: Vec<Comment>,
    /// Runs of blank lines, in order, each from the start of its first line to the start of the next line with content.
    pub blank_lines: Vec<Span>,
}

/// A comment.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Comment {
    /// Span from its slashes to the end of its line, without trailing white space.
    pub span: Span,
    /// True if it begins with three slashes: it documents the declaration behind it.
    pub is_doc: bool,
    /// True if it stands behind something else on its line.
    pub is_trailing: bool,
}

/// Collects the trivia of a text from its tokens.
pub(super) fn of(text: &str, file: FileId, tokens: &[Token<'_>]) -> Trivia {
    let span = |start: usize, end: usize| Span { file, start: start as u32, end: end as u32 };
    let (mut trivia, mut end) = (Trivia::default(), 0);
    for token in tokens {
        if token.lines_before > 0 {
            let gap = &text[end..token.start];
            // the line of the token before does not count
            let first = if end == 0 { 0 } else { gap.find('\n').map_or(0, |at| at + 1) };
            let last = gap.rfind('\n').map_or(0, |at| at + 1);
            if first < last {
                trivia.blank_lines.push(span(end + first, end + last));
            }
        }
        if token.is_comment() {
            trivia.comments.push(Comment {
                span: span(token.start, token.end()),
                is_doc: token.text.starts_with("///"),
                is_trailing: token.lines_before == 0 && end > 0,
            });
        }
        end = token.end();
    }
    trivia
}

#[cfg(test)]
mod tests {
    use super::of;
    use crate::lexer::{Lexer, Token};
    use mechc_text::source::Sources;

    #[test]
    fn comments_and_blank_lines_are_kept() {
        let text = "// a\n\n  \n/// b\nparam p = 1 // c  \ntable t = spline \"x//y\" // d\n\n";
        let mut sources = Sources::default();
        let file = sources.add("text", text);
        let tokens: Vec<Token<'_>> = Lexer::new(text, 0).collect();
        let trivia = of(text, file, &tokens);
        let comments: Vec<(&str, bool, bool)> =
            trivia.comments.iter().map(|c| (sources.text(c.span), c.is_doc, c.is_trailing)).collect();
        assert_eq!(
            comments,
            [("// a", false, false), ("/// b", true, false), ("// c", false, true), ("// d", false, true)]
        );
        let blank: Vec<&str> = trivia.blank_lines.iter().map(|&span| sources.text(span)).collect();
        assert_eq!(blank, ["\n  \n"], "what ends the text separates nothing");
    }
}
