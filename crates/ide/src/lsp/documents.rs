//! The texts that the client has open.

use super::lines::{Lines, Position};
use super::uri;
use mechc_text::source::Encoding;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// The byte-order mark.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// A text with its lines.
#[derive(Clone)]
pub(super) struct Document {
    /// The URI that the client uses.
    pub uri: String,
    /// The version number of the client.
    pub version: i32,
    /// The text without a byte-order mark.
    text: Arc<str>,
    lines: Lines,
    /// True if the client's text begins with a byte-order mark, which only its positions count.
    has_mark: bool,
}

/// An edit of a text in bytes: the replaced range, and the length of the new text.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Splice {
    pub range: Range<u32>,
    pub length: u32,
}

impl Document {
    pub fn new(uri: String, version: i32, text: &str) -> Document {
        let has_mark = text.starts_with(BYTE_ORDER_MARK);
        let text: Arc<str> = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text).into();
        let lines = Lines::new(&text);
        Document { uri, version, text, lines, has_mark }
    }

    /// Returns the text without a byte-order mark.
    pub fn text(&self) -> &Arc<str> {
        &self.text
    }

    /// Returns the byte at a position, which may lie outside the text.
    pub fn offset(&self, (line, column): Position, encoding: Encoding) -> u32 {
        let column = column.saturating_sub(self.mark_on(line, encoding));
        self.lines.offset(&self.text, (line, column), encoding)
    }

    /// Returns the position of a byte, which may lie outside the text.
    pub fn position(&self, offset: u32, encoding: Encoding) -> Position {
        let (line, column) = self.lines.position(&self.text, self.character_at(offset), encoding);
        (line, column + self.mark_on(line, encoding))
    }

    /// Returns the beginning of the character that contains a byte.
    fn character_at(&self, offset: u32) -> u32 {
        let text = &self.text;
        let offset = (offset as usize).min(text.len());
        (0..=offset).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0) as u32
    }

    fn mark_on(&self, line: u32, encoding: Encoding) -> u32 {
        if self.has_mark && line == 0 { encoding.width(BYTE_ORDER_MARK) as u32 } else { 0 }
    }

    fn replace_text(&mut self, text: &str) {
        *self = Document::new(std::mem::take(&mut self.uri), self.version, text);
    }

    /// Replaces a range of the text, or the whole text; returns the edit.
    pub fn edit(&mut self, range: Option<[Position; 2]>, new: &str, encoding: Encoding) -> Splice {
        let Some(ends) = range else {
            let splice = difference(&self.text, new.strip_prefix(BYTE_ORDER_MARK).unwrap_or(new));
            self.replace_text(new);
            return splice;
        };
        let [start, end] = ends.map(|position| self.offset(position, encoding));
        let range = start.min(end)..start.max(end);
        let takes_mark = ends[0] == (0, 0) && ends[1] != (0, 0);
        let mark = if self.has_mark && !takes_mark { BYTE_ORDER_MARK.len_utf8() } else { 0 };
        let mut text = String::with_capacity(mark + self.text.len() + new.len());
        text.extend((mark > 0).then_some(BYTE_ORDER_MARK));
        text += &self.text[..range.start as usize];
        text += new;
        text += &self.text[range.end as usize..];
        self.replace_text(&text);
        Splice { range, length: new.len() as u32 }
    }
}

/// Returns the edit that turns one text into another: the single range in which they differ.
fn difference(old: &str, new: &str) -> Splice {
    let same = |a: &mut dyn Iterator<Item = (u8, u8)>| a.take_while(|(a, b)| a == b).count();
    let before = same(&mut old.bytes().zip(new.bytes()));
    let shorter = old.len().min(new.len());
    let behind = same(&mut old.bytes().rev().zip(new.bytes().rev())).min(shorter - before);
    Splice { range: before as u32..(old.len() - behind) as u32, length: (new.len() - before - behind) as u32 }
}

impl Splice {
    /// Returns whether the edit changes or adjoins a range.
    pub fn touches(&self, range: &Range<u32>) -> bool {
        self.range.start <= range.end && range.start <= self.range.end
    }

    /// Returns a range after the edit.
    pub fn shift(&self, range: &Range<u32>) -> Range<u32> {
        let at = |offset: u32, is_end: bool| match offset {
            // text inserted at an end lies outside
            _ if offset < self.range.start || is_end && offset == self.range.start => offset,
            _ if offset >= self.range.end => offset - (self.range.end - self.range.start) + self.length,
            _ => self.range.start + if is_end { 0 } else { self.length },
        };
        let (start, end) = (at(range.start, range.is_empty()), at(range.end, true));
        start.min(end)..end
    }
}

/// The open texts by their files. A clone shares them.
#[derive(Clone, Default)]
pub(super) struct Documents {
    open: BTreeMap<Arc<Path>, Arc<Document>>,
    /// The files by the URIs that opened them. A file may have several URIs, and keeps its identity while links and files on disk change.
    files: BTreeMap<String, Arc<Path>>,
}

impl Documents {
    pub fn get(&self, path: &Path) -> Option<&Arc<Document>> {
        self.open.get(path)
    }

    /// Returns the file that was opened by a URI.
    pub fn file(&self, uri: &str) -> Option<&Arc<Path>> {
        self.files.get(uri)
    }

    pub fn set(&mut self, path: Arc<Path>, document: Document) {
        self.files.insert(document.uri.clone(), Arc::clone(&path));
        self.open.insert(path, Arc::new(document));
    }

    /// Closes a URI; returns its file if no other URI has it open.
    pub fn close(&mut self, uri: &str) -> Option<Arc<Path>> {
        let path = self.files.remove(uri)?;
        if let Some((other, _)) = self.files.iter().find(|(_, other)| **other == path) {
            let document = self.open.get_mut(&path)?;
            Arc::make_mut(document).uri.clone_from(other);
            return None;
        }
        self.open.remove(&path);
        Some(path)
    }

    pub fn paths(&self) -> impl Iterator<Item = &Arc<Path>> {
        self.open.keys()
    }

    /// Returns the URI of a file, that of the client if the file is open.
    pub fn uri(&self, path: &Path) -> String {
        self.get(path).map_or_else(
            || uri::uri_of(&std::path::absolute(path).unwrap_or_else(|_| path.to_owned())),
            |document| document.uri.clone(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::{Document, Documents, Splice, difference};
    use mechc_text::source::Encoding;
    use std::path::Path;

    fn document(text: &str) -> Document {
        Document::new("file:///a.mech".to_owned(), 1, text)
    }

    #[test]
    fn positions_round_trip_in_every_encoding() {
        let document = document("a𝛼µ\r\nx\n");
        for encoding in [Encoding::Utf8, Encoding::Utf16, Encoding::Characters] {
            for (offset, _) in document.text().char_indices().filter(|(_, c)| *c != '\n') {
                let position = document.position(offset as u32, encoding);
                assert_eq!(document.offset(position, encoding), offset as u32, "{encoding:?}");
            }
        }
        assert_eq!(document.position(5, Encoding::Utf16), (0, 3));
        assert_eq!(document.position(3, Encoding::Utf16), (0, 1), "within a character: its beginning");
        assert_eq!(document.position(99, Encoding::Utf16), (2, 0));
    }

    #[test]
    fn edits_change_the_text_and_return_a_splice() {
        let mut text = document("a𝛼µ\nx\n");
        let splice = text.edit(Some([(0, 1), (0, 3)]), "bc", Encoding::Utf16);
        assert_eq!((&**text.text(), splice), ("abcµ\nx\n", Splice { range: 1..5, length: 2 }));
        let splice = text.edit(Some([(9, 9), (9, 9)]), "end", Encoding::Utf16);
        assert_eq!((&**text.text(), splice), ("abcµ\nx\nend", Splice { range: 8..8, length: 3 }));
        let splice = text.edit(None, "abcµ\ny\nend", Encoding::Utf16);
        assert_eq!((&**text.text(), splice), ("abcµ\ny\nend", Splice { range: 6..7, length: 1 }));
    }

    #[test]
    fn a_byte_order_mark_is_counted_on_its_line_alone() {
        let mut text = document("\u{feff}ab\ncd");
        assert_eq!(&**text.text(), "ab\ncd");
        assert_eq!(text.offset((0, 1), Encoding::Utf16), 0);
        assert_eq!(text.position(1, Encoding::Utf16), (0, 2));
        assert_eq!(text.position(4, Encoding::Utf8), (1, 1));
        text.edit(Some([(0, 1), (0, 2)]), "x", Encoding::Utf16);
        assert_eq!((&**text.text(), text.position(0, Encoding::Utf16)), ("xb\ncd", (0, 1)));
        text.edit(Some([(0, 0), (0, 2)]), "y", Encoding::Utf16);
        assert_eq!((&**text.text(), text.position(0, Encoding::Utf16)), ("yb\ncd", (0, 0)));
    }

    #[test]
    fn a_file_with_two_names_is_open_until_both_are_closed() {
        let mut documents = Documents::default();
        let path = Path::new("/a.mech");
        for uri in ["file:///a.mech", "file:///link.mech"] {
            documents.set(path.into(), Document::new(uri.to_owned(), 1, "x"));
        }
        assert_eq!(documents.close("file:///link.mech"), None);
        assert_eq!(documents.uri(path), "file:///a.mech");
        assert_eq!(documents.close("file:///other.mech"), None);
        assert_eq!(documents.close("file:///a.mech").as_deref(), Some(path));
        assert!(documents.get(path).is_none());
    }

    #[test]
    fn the_difference_is_one_range() {
        assert_eq!(difference("abab", "abxab"), Splice { range: 2..2, length: 1 });
        assert_eq!(difference("aaa", "aa"), Splice { range: 2..3, length: 0 });
        assert_eq!(difference("", ""), Splice { range: 0..0, length: 0 });
    }

    #[test]
    fn ranges_shift_with_edits() {
        let insert = Splice { range: 5..5, length: 3 };
        assert_eq!(insert.shift(&(6..8)), 9..11);
        assert_eq!(insert.shift(&(5..8)), 8..11);
        assert_eq!(insert.shift(&(2..5)), 2..5);
        assert_eq!(insert.shift(&(2..6)), 2..9);
        let delete = Splice { range: 4..8, length: 0 };
        assert_eq!(delete.shift(&(2..6)), 2..4);
        assert_eq!(delete.shift(&(5..7)), 4..4);
        assert_eq!(delete.shift(&(6..10)), 4..6);
        assert_eq!(delete.shift(&(8..10)), 4..6);
    }
}
