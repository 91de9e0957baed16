//! Offsets in texts in UTF-16 units, as scripts count them.

use mechc_text::source::{FileId, Source, Span};

/// Texts of a page.
pub(super) struct Texts {
    texts: Vec<(FileId, Offsets)>,
}

/// Conversion of byte offsets to UTF-16 offsets.
enum Offsets {
    /// The offsets are equal.
    Same,
    /// UTF-16 offsets by byte.
    Listed(Vec<u32>),
}

impl Texts {
    pub fn of(sources: &[(FileId, &Source)]) -> Texts {
        Texts { texts: sources.iter().map(|(id, source)| (*id, Offsets::of(&source.text))).collect() }
    }

    /// Returns the index of a span's text, and the span's start and end; `None` for any other text.
    pub fn place(&self, span: Span) -> Option<(usize, u32, u32)> {
        let text = self.texts.iter().position(|(id, _)| *id == span.file)?;
        let offsets = &self.texts[text].1;
        Some((text, offsets.at(span.start), offsets.at(span.end)))
    }
}

impl Offsets {
    fn of(text: &str) -> Offsets {
        if text.is_ascii() {
            return Offsets::Same;
        }
        let mut listed = Vec::with_capacity(text.len() + 1);
        let mut units = 0;
        for c in text.chars() {
            listed.resize(listed.len() + c.len_utf8(), units);
            units += c.len_utf16() as u32;
        }
        listed.push(units);
        Offsets::Listed(listed)
    }

    fn at(&self, byte: u32) -> u32 {
        match self {
            Offsets::Same => byte,
            Offsets::Listed(listed) => listed.get(byte as usize).or(listed.last()).copied().unwrap_or(0),
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
        let texts = Texts::of(&[(plain, sources.get(plain)), (odd, sources.get(odd))]);
        let place = |file, start, end| texts.place(Span { file, start, end });
        assert_eq!(place(plain, 1, 3), Some((0, 1, 3)));
        assert_eq!(place(odd, 1, 3), Some((1, 1, 2)));
        assert_eq!(place(odd, 3, 8), Some((1, 2, 5)));
        let option = sources.add_option("--set", "x");
        assert_eq!(place(option, 0, 1), None);
    }
}
