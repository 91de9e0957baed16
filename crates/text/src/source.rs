//! Texts and spans.
//!
//! This module depends on no other: a span is a file and two byte offsets, and everything about the user's text holds one.

use std::sync::Arc;

/// Unit of columns in a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Encoding {
    /// Bytes.
    Utf8,
    /// UTF-16 units, the default of editor protocols.
    Utf16,
    /// Unicode characters, as in messages.
    Characters,
}

impl Encoding {
    /// Returns the length of a text.
    #[must_use]
    pub fn length(self, text: &str) -> usize {
        match self {
            Encoding::Utf8 => text.len(),
            Encoding::Utf16 => text.encode_utf16().count(),
            Encoding::Characters => text.chars().count(),
        }
    }

    /// Returns the length of a character.
    #[must_use]
    pub fn width(self, c: char) -> usize {
        match self {
            Encoding::Utf8 => c.len_utf8(),
            Encoding::Utf16 => c.len_utf16(),
            Encoding::Characters => 1,
        }
    }
}

/// Returns whether a terminal would interpret a character instead of showing it: control characters except line feeds and tabs, and those
/// that change the direction of writing.
#[must_use]
pub fn is_control(c: char) -> bool {
    let turns = matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || c.is_control() && !matches!(c, '\n' | '\t')
}

/// Index of a text in [`Sources`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct FileId(u32);

/// Range of bytes in a text; `end` is exclusive.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Span {
    /// Text of the offsets.
    pub file: FileId,
    /// First byte.
    pub start: u32,
    /// Byte after the last one.
    pub end: u32,
}

impl Span {
    /// Returns the smallest span that contains both, which must be in one file.
    #[must_use]
    pub fn to(self, other: Span) -> Span {
        Span { file: self.file, start: self.start.min(other.start), end: self.end.max(other.end) }
    }
}

/// A text with its name.
#[derive(Clone, Debug)]
pub struct Source {
    /// Name as the user wrote it: a path, `<stdin>`, `--set`.
    pub name: String,
    /// Text without a byte-order mark.
    pub text: String,
    /// True if the text comes from the command line, not from a file.
    pub is_option: bool,
    /// True if the text contains control characters other than line ends and tabs.
    pub has_controls: bool,
    line_starts: Vec<usize>,
}

impl Source {
    fn new(name: String, text: String, is_option: bool) -> Source {
        let line_starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        let has_lone_returns = || text.match_indices('\r').any(|(at, _)| !text[at + 1..].starts_with('\n'));
        let has_controls = text.contains(|c: char| is_control(c) && c != '\r') || has_lone_returns();
        Source { name, text, is_option, has_controls, line_starts }
    }

    /// Returns line and column of a byte offset, both from 1, the column in characters.
    #[must_use]
    pub fn position(&self, offset: u32) -> (usize, usize) {
        let (line, column) = self.position_in(offset, Encoding::Characters);
        (line + 1, column + 1)
    }

    /// Returns line and column of a byte offset, both from 0.
    #[must_use]
    pub fn position_in(&self, offset: u32, encoding: Encoding) -> (usize, usize) {
        let offset = (offset as usize).min(self.text.len());
        let line = self.line_index(offset);
        let before = self.text.get(self.line_starts[line]..offset).unwrap_or("");
        (line, encoding.length(before))
    }

    /// Returns the byte offset of a line and column, both from 0. A column beyond the line becomes its end, one within a character the
    /// character's first byte.
    #[must_use]
    pub fn offset_of(&self, line: usize, column: usize, encoding: Encoding) -> u32 {
        let Some(range) = self.line_range(line) else {
            return self.text.len() as u32;
        };
        let text = self.text[range.clone()].trim_end_matches(['\n', '\r']);
        let mut width = 0;
        let inside = text.char_indices().find(|&(_, c)| {
            width += encoding.width(c);
            width > column
        });
        (range.start + inside.map_or(text.len(), |(at, _)| at)) as u32
    }

    /// Returns the line (from 0) of a byte offset.
    #[must_use]
    pub fn line_index(&self, offset: usize) -> usize {
        self.line_starts.partition_point(|&start| start <= offset) - 1
    }

    /// Returns the byte range of a line (from 0) with its line end, or `None` after the last line.
    #[must_use]
    pub fn line_range(&self, line: usize) -> Option<std::ops::Range<usize>> {
        let start = *self.line_starts.get(line)?;
        let end = self.line_starts.get(line + 1).copied().unwrap_or(self.text.len());
        Some(start..end)
    }
}

/// All texts of one compilation: files and options of the command line. Clones share the texts.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<Arc<Source>>,
}

impl Sources {
    /// Adds a text without its byte-order mark.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<String>) -> FileId {
        let mut text = text.into();
        if text.starts_with('\u{feff}') {
            text.drain(..'\u{feff}'.len_utf8());
        }
        self.push(Source::new(name.into(), text, false))
    }

    /// Adds the value of a command-line option.
    pub fn add_option(&mut self, option: impl Into<String>, value: impl Into<String>) -> FileId {
        self.push(Source::new(option.into(), value.into(), true))
    }

    fn push(&mut self, source: Source) -> FileId {
        self.files.push(Arc::new(source));
        FileId(self.files.len() as u32 - 1)
    }

    /// Returns the texts with other names for those of options, which `name` gives from the present ones.
    #[must_use]
    pub fn with_option_names(&self, name: impl Fn(&str) -> String) -> Sources {
        let renamed = |source: &Arc<Source>| {
            if !source.is_option {
                return Arc::clone(source);
            }
            Arc::new(Source { name: name(&source.name), ..(**source).clone() })
        };
        Sources { files: self.files.iter().map(renamed).collect() }
    }

    /// Returns the text of an id from [`Sources::add`].
    #[must_use]
    pub fn get(&self, file: FileId) -> &Source {
        &self.files[file.0 as usize]
    }

    /// Returns all texts in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = &Source> {
        self.files.iter().map(AsRef::as_ref)
    }

    /// Returns the text of a span.
    #[must_use]
    pub fn text(&self, span: Span) -> &str {
        self.get(span.file).text.get(span.start as usize..span.end as usize).unwrap_or("")
    }

    /// Returns the empty span at the end of a file, for something that is missing.
    #[must_use]
    pub fn end_of(&self, file: FileId) -> Span {
        let end = self.get(file).text.len() as u32;
        Span { file, start: end, end }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_count_characters_from_one() {
        let mut sources = Sources::default();
        let file = sources.add("a", "\u{feff}ab\nµx\n");
        let source = sources.get(file);
        assert_eq!(source.position(0), (1, 1));
        assert_eq!(source.position(3), (2, 1));
        assert_eq!(source.position(5), (2, 2), "µ is two bytes, one character");
        assert_eq!(source.position(7), (3, 1));
    }

    #[test]
    fn columns_count_what_an_editor_counts() {
        let mut sources = Sources::default();
        let file = sources.add("a", "a\nµ𝛼x\r\n");
        let source = sources.get(file);
        let x = 2 + "µ𝛼".len() as u32;
        for (encoding, column) in [(Encoding::Utf8, 6), (Encoding::Utf16, 3), (Encoding::Characters, 2)] {
            assert_eq!(source.position_in(x, encoding), (1, column));
            assert_eq!(source.offset_of(1, column, encoding), x);
            assert_eq!(source.offset_of(1, 99, encoding), x + 1, "the end of the line, before its line end");
            assert_eq!(source.offset_of(9, 0, encoding), source.text.len() as u32);
        }
        assert_eq!(source.offset_of(1, 2, Encoding::Utf16), 4, "within a character: its beginning");
    }
}
