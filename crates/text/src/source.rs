//! Texts and the places in them.
//!
//! Knows nobody: a span is a file and two byte offsets, and everything that speaks of the user's text holds one.

use std::sync::Arc;

/// What the columns of a line count.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Encoding {
    /// Bytes.
    Utf8,
    /// Units of UTF-16, as most editors do between each other.
    Utf16,
    /// Unicode characters, as messages do.
    Characters,
}

impl Encoding {
    /// How long a text is.
    #[must_use]
    pub fn length(self, text: &str) -> usize {
        match self {
            Encoding::Utf8 => text.len(),
            Encoding::Utf16 => text.encode_utf16().count(),
            Encoding::Characters => text.chars().count(),
        }
    }

    /// How long a character is.
    #[must_use]
    pub fn width(self, c: char) -> usize {
        match self {
            Encoding::Utf8 => c.len_utf8(),
            Encoding::Utf16 => c.len_utf16(),
            Encoding::Characters => 1,
        }
    }
}

/// Whether a terminal would do something else with a character than show it: control characters but for ends of lines and tabs, and those
/// that turn the direction of writing.
#[must_use]
pub fn is_control(c: char) -> bool {
    let turns = matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || c.is_control() && !matches!(c, '\n' | '\t')
}

/// Which of the [`Sources`] a span lies in.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct FileId(u32);

/// A stretch of text, in bytes; `end` is exclusive.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Span {
    /// The text that the offsets count in.
    pub file: FileId,
    /// The first byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The smallest span that holds both; both must lie in one file.
    #[must_use]
    pub fn to(self, other: Span) -> Span {
        Span { file: self.file, start: self.start.min(other.start), end: self.end.max(other.end) }
    }
}

/// One text with the name to print for it.
#[derive(Clone, Debug)]
pub struct Source {
    /// As the user named it: a path, `<stdin>`, `--set`.
    pub name: String,
    /// The text, without a byte-order mark.
    pub text: String,
    /// Whether it was typed on the command line, rather than read from a file.
    pub is_option: bool,
    /// Whether control characters are in it, but for ends of lines.
    pub has_controls: bool,
    line_starts: Vec<usize>,
}

impl Source {
    fn new(name: String, text: String, is_option: bool) -> Source {
        let line_starts = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        let goes_back = || text.match_indices('\r').any(|(at, _)| !text[at + 1..].starts_with('\n'));
        let has_controls = text.contains(|c: char| is_control(c) && c != '\r') || goes_back();
        Source { name, text, is_option, has_controls, line_starts }
    }

    /// Line and column of a byte offset, both from 1, the column in characters.
    #[must_use]
    pub fn position(&self, offset: u32) -> (usize, usize) {
        let (line, column) = self.position_in(offset, Encoding::Characters);
        (line + 1, column + 1)
    }

    /// Line and column of a byte offset, both from 0.
    #[must_use]
    pub fn position_in(&self, offset: u32, encoding: Encoding) -> (usize, usize) {
        let offset = (offset as usize).min(self.text.len());
        let line = self.line_index(offset);
        let before = self.text.get(self.line_starts[line]..offset).unwrap_or("");
        (line, encoding.length(before))
    }

    /// The byte offset of a line and column, both from 0; what lies beyond the end of a line is that end, and what lies within a
    /// character its beginning.
    #[must_use]
    pub fn offset_of(&self, line: usize, column: usize, encoding: Encoding) -> u32 {
        let Some(range) = self.line_range(line) else {
            return self.text.len() as u32;
        };
        let text = self.text[range.clone()].trim_end_matches(['\n', '\r']);
        let mut passed = 0;
        let inside = text.char_indices().find(|&(_, c)| {
            passed += encoding.width(c);
            passed > column
        });
        (range.start + inside.map_or(text.len(), |(at, _)| at)) as u32
    }

    /// Index of the line (from 0) that holds a byte offset.
    #[must_use]
    pub fn line_index(&self, offset: usize) -> usize {
        self.line_starts.partition_point(|&start| start <= offset) - 1
    }

    /// Byte range of a line (from 0), its line end included; `None` past the last line.
    #[must_use]
    pub fn line_range(&self, line: usize) -> Option<std::ops::Range<usize>> {
        let start = *self.line_starts.get(line)?;
        let end = self.line_starts.get(line + 1).copied().unwrap_or(self.text.len());
        Some(start..end)
    }
}

/// All texts of one compilation: the file, and what the command line adds to it. A clone shares them.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<Arc<Source>>,
}

impl Sources {
    /// Takes a text in; a byte-order mark at its start is passed over.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<String>) -> FileId {
        let mut text = text.into();
        if text.starts_with('\u{feff}') {
            text.drain(..'\u{feff}'.len_utf8());
        }
        self.push(Source::new(name.into(), text, false))
    }

    /// Takes the value of an option of the command line in.
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
        let renamed = |source: &Arc<Source>| match source.is_option {
            true => Arc::new(Source { name: name(&source.name), ..(**source).clone() }),
            false => Arc::clone(source),
        };
        Sources { files: self.files.iter().map(renamed).collect() }
    }

    /// The text behind an id that [`Sources::add`] gave.
    #[must_use]
    pub fn get(&self, file: FileId) -> &Source {
        &self.files[file.0 as usize]
    }

    /// All texts, in the order in which they came in.
    pub fn iter(&self) -> impl Iterator<Item = &Source> {
        self.files.iter().map(AsRef::as_ref)
    }

    /// The words that a span covers.
    #[must_use]
    pub fn text(&self, span: Span) -> &str {
        self.get(span.file).text.get(span.start as usize..span.end as usize).unwrap_or("")
    }

    /// A span of the whole of a file's last position: where something is missing.
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
