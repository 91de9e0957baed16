//! Formatting of texts in one style, which `examples/` show.
//!
//! Formatting changes only the text between tokens, and the comma behind the last item of a list. The formatter returns small edits; a
//! text is formatted by all of them, a part of it by those of the part. Where a text does not follow the grammar, complete declarations are
//! formatted and the rest stays unchanged.
//!
//! ```text
//! text ──tokens──▶ rows ──words, columns──▶ groups ──layout──▶ gaps ──▶ edits tree ────────────▶
//! ```
//!
//! A tree without text is printed without regard to lines, and then formatted like any text ([`format()`]).
//!
//! This module knows the notation and not the meaning: texts that `check` rejects are formatted too.

mod columns;
mod expression;
mod gaps;
mod groups;
mod layout;
mod rows;
mod tree_printer;
mod words;

use super::ast::File;
use super::parse::{ParsedText, parse};
pub use expression::expression;
use gaps::Formatted;
use mechc_text::diag::Edit;
use mechc_text::source::{FileId, Sources, Span};
use unicode_width::UnicodeWidthStr;

/// Returns the display width of a text, in columns.
fn width(text: &str) -> usize {
    text.width()
}

/// Returns a tree as formatted text. It ends with a line end, and is empty for an empty tree.
#[must_use]
pub fn format(file: &File) -> String {
    let text = tree_printer::print(file);
    let mut sources = Sources::default();
    let written = sources.add("written", text);
    let parsed = parse(&sources, written);
    let text = &sources.get(written).text;
    Formatted::of(&parsed, text).text(text)
}

/// Returns a text formatted; declarations with syntax errors stay unchanged.
#[must_use]
pub fn formatted(parsed: &ParsedText, text: &str) -> String {
    Formatted::of(parsed, text).text(text)
}

/// Returns the edits that format a text: spaces, line ends, and commas behind the last items of lists. They are ordered and do not overlap.
#[must_use]
pub fn edits(parsed: &ParsedText, text: &str, file: FileId) -> Vec<Edit> {
    Formatted::of(parsed, text).edits(text, file, |_| true)
}

/// Returns the edits of the lines that a span touches; a line that begins at the end of the span does not count. Columns are aligned as in
/// the whole text.
#[must_use]
pub fn edits_in(parsed: &ParsedText, text: &str, span: Span) -> Vec<Edit> {
    let (start, end) = (span.start as usize, span.end as usize);
    // an empty span is a cursor, which may stand where a line begins
    Formatted::of(parsed, text)
        .edits(text, span.file, |row| start <= row.end && (row.start < end || start == end && row.start == end))
}

/// Returns the edits of the block whose closing brace ends at a byte; none if there is no such block.
#[must_use]
pub fn edits_at_brace(parsed: &ParsedText, text: &str, file: FileId, end: u32) -> Vec<Edit> {
    let mechanisms = parsed.tree.mechanisms.iter();
    let mut blocks = mechanisms
        .flat_map(|mechanism| std::iter::once(mechanism.span).chain(mechanism.items.iter().map(|item| item.span)));
    let is_brace = text.get(..end as usize).is_some_and(|before| before.ends_with('}'));
    match blocks.find(|span| is_brace && span.end == end) {
        Some(block) => edits_in(parsed, text, Span { file, ..block }),
        None => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::gaps::Formatted;
    use crate::parse;
    use mechc_text::source::Sources;

    fn steps(text: &str) -> usize {
        let mut sources = Sources::default();
        let file = sources.add("text", text);
        let parsed = parse(&sources, file);
        assert!(parsed.faults.is_empty(), "{:?}", parsed.faults.iter().next());
        Formatted::of(&parsed, text).steps
    }

    /// Returns a mechanism of many declarations, with formulas as deep as they may be.
    fn large(declarations: usize) -> String {
        let deep = format!("{}a + b{}", "max(c, (".repeat(90), ") * d)".repeat(90));
        let one = |k: usize| match k % 500 {
            0 => format!("param p{k} = {deep}\n"),
            1..20 => format!("// {k}\nbody b{k} {{ point A = (0, {k} mm) point B = A }}\n"),
            _ => format!("param q{k}=2*q // {k}\n"),
        };
        format!("mechanism m {{\n{}}}\n", (0..declarations).map(one).collect::<String>())
    }

    #[test]
    fn steps_are_linear_in_the_text() {
        let (small, big) = (large(1_000), large(100_000));
        let a_byte = |text: &str| steps(text) as f64 / text.len() as f64;
        let (few, many) = (a_byte(&small), a_byte(&big));
        assert!(many <= few * 1.02 && many < 10.0, "{few} and {many} steps a byte");
    }
}
