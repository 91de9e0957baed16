//! The lines of a text as the protocol counts them: each ends in a line feed, a carriage return, or both.
//!
//! Messages on the terminal count line feeds only, in `mechc_text::source`.

use mechc_text::source::Encoding;
use std::ops::Range;

/// Line and column, from 0, as the client counts them.
pub(super) type Position = (u32, u32);

/// The starts of the lines of a text.
#[derive(Clone, Debug)]
pub(super) struct Lines {
    starts: Vec<u32>,
}

impl Lines {
    pub fn new(text: &str) -> Lines {
        let bytes = text.as_bytes();
        let is_end = |&(at, byte): &(usize, &u8)| *byte == b'\n' || *byte == b'\r' && bytes.get(at + 1) != Some(&b'\n');
        let ends = bytes.iter().enumerate().filter(is_end).map(|(at, _)| at as u32 + 1);
        Lines { starts: std::iter::once(0).chain(ends).collect() }
    }

    /// Returns the byte at a position: the end of the line if it is shorter, the end of the text if there is no such line, and the start of
    /// the character that contains it.
    pub fn offset(&self, text: &str, (line, column): Position, encoding: Encoding) -> u32 {
        let Some(range) = self.range(text, line as usize) else { return text.len() as u32 };
        let line = text[range.clone()].trim_end_matches(['\n', '\r']);
        let mut passed = 0;
        let inside = line.char_indices().find(|&(_, c)| {
            passed += encoding.width(c);
            passed > column as usize
        });
        (range.start + inside.map_or(line.len(), |(at, _)| at)) as u32
    }

    /// Returns the position of a byte, which must be the start of a character or the end of the text.
    pub fn position(&self, text: &str, offset: u32, encoding: Encoding) -> Position {
        let line = self.starts.partition_point(|&start| start <= offset) - 1;
        let before = text.get(self.starts[line] as usize..offset as usize).unwrap_or_default();
        (line as u32, encoding.length(before) as u32)
    }

    /// Returns the range of a line with its line break.
    fn range(&self, text: &str, line: usize) -> Option<Range<usize>> {
        let start = *self.starts.get(line)? as usize;
        Some(start..self.starts.get(line + 1).map_or(text.len(), |&end| end as usize))
    }
}

#[cfg(test)]
mod tests {
    use super::Lines;
    use mechc_text::source::Encoding;

    #[test]
    fn lines_end_in_three_ways() {
        let text = "a\rb\r\nc\n\r\rd";
        let lines = Lines::new(text);
        let at = |what: &str| lines.position(text, text.find(what).expect("it is there") as u32, Encoding::Utf16);
        assert_eq!(["a", "b", "c", "d"].map(at), [(0, 0), (1, 0), (2, 0), (5, 0)]);
        for (line, end) in [(0, 1), (1, 3), (2, 6), (3, 7), (4, 8), (5, 10), (6, 10)] {
            assert_eq!(lines.offset(text, (line, 9), Encoding::Utf16), end, "line {line}");
        }
    }
}
