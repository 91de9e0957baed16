//! Trivia: comments and blank lines.

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

/// Collects the trivia of a text.
pub(super) fn of(text: &str, file: FileId) -> Trivia {
    let span = |start: usize, end: usize| Span { file, start: start as u32, end: end as u32 };
    let mut trivia = Trivia::default();
    let mut start = 0;
    let mut blank_from = None;
    for line in text.split_inclusive('\n') {
        if line.trim().is_empty() {
            blank_from.get_or_insert(start);
        } else {
            if let Some(from) = blank_from.take() {
                trivia.blank_lines.push(span(from, start));
            }
            if let Some(at) = comment_in(line) {
                let comment = line[at..].trim_end();
                trivia.comments.push(Comment {
                    span: span(start + at, start + at + comment.len()),
                    is_doc: comment.starts_with("///"),
                    is_trailing: !line[..at].trim().is_empty(),
                });
            }
        }
        start += line.len();
    }
    trivia
}

/// Returns where the comment of a line begins: at two slashes outside of strings. A string must end on its line.
fn comment_in(line: &str) -> Option<usize> {
    let mut from = 0;
    loop {
        let slashes = from + line[from..].find("//")?;
        match line[from..slashes].find('"') {
            None => return Some(slashes),
            Some(quote) => {
                let inside = from + quote + 1;
                match line[inside..].find('"') {
                    Some(end) => from = inside + end + 1,
                    None => return Some(slashes),
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::of;
    use mechc_text::source::Sources;

    #[test]
    fn comments_and_blank_lines_are_kept() {
        let text = "// a\n\n  \n/// b\nparam p = 1 // c  \ntable t = spline \"x//y\" // d\n\n";
        let mut sources = Sources::default();
        let file = sources.add("text", text);
        let trivia = of(text, file);
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
