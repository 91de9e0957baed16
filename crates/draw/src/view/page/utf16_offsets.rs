//! Offsets in texts in UTF-16 units, as scripts count them.

use mechc_text::source::{FileId, Source, Span};

/// Texts of a page.
pub(super) struct Texts {
    texts: Vec<(FileId, Offsets)>,
}

/// A span in UTF-16 units.
#[derive(Default)]
pub(super) struct TextRange {
    /// Index of the text.
    pub text: usize,
    pub start: u32,
    pub end: u32,
}

/// Conversion of byte offsets to UTF-16 offsets.
enum Offsets {
    /// The offsets are equal.
    Equal,
    /// UTF-16 offsets by byte.
    ByByte(Vec<u32>),
}

impl Texts {
    pub fn new(sources: &[(FileId, &Source)]) -> Texts {
        Texts { texts: sources.iter().map(|(id, source)| (*id, Offsets::new(&source.text))).collect() }
    }

    /// Returns a span as the page counts it, or `None` if its text is not in the page.
    pub fn locate(&self, span: Span) -> Option<TextRange> {
        let text = self.texts.iter().position(|(id, _)| *id == span.file)?;
        let offsets = &self.texts[text].1;
        Some(TextRange { text, start: offsets.at(span.start), end: offsets.at(span.end) })
    }
}

impl Offsets {
    fn new(text: &str) -> Offsets {
        if text.is_ascii() {
            return Offsets::Equal;
        }
        let mut offsets = Vec::with_capacity(text.len() + 1);
        let mut units = 0;
        for c in text.chars() {
            offsets.resize(offsets.len() + c.len_utf8(), units);
            units += c.len_utf16() as u32;
        }
        offsets.push(units);
        Offsets::ByByte(offsets)
    }

    fn at(&self, byte: u32) -> u32 {
        match self {
            Offsets::Equal => byte,
            Offsets::ByByte(offsets) => offsets.get(byte as usize).or(offsets.last()).copied().unwrap_or(0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Texts;
    use mechc_text::source::{Sources, Span};

    #[test]
    fn places_count_as_scripts_do() {
        let mut sources = Sources::default();
        let (plain, odd) = (sources.add("a", "abc"), sources.add("b", "aö😀z"));
        let texts = Texts::new(&[(plain, sources.get(plain)), (odd, sources.get(odd))]);
        let range = |file, start, end| {
            texts.locate(Span { file, start, end }).map(|range| (range.text, range.start, range.end))
        };
        assert_eq!(range(plain, 1, 3), Some((0, 1, 3)));
        assert_eq!(range(odd, 1, 3), Some((1, 1, 2)));
        assert_eq!(range(odd, 3, 8), Some((1, 2, 5)));
        let option = sources.add_option("--set", "x");
        assert_eq!(range(option, 0, 1), None);
    }
}
