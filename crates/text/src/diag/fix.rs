//! Mends as data: what to change in the text, beside the words that propose it.

use crate::source::{FileId, Sources, Span};

/// Whether a fix can be made without asking.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Applies {
    /// It says what the text can only have meant.
    Always,
    /// It is what was probably meant; whoever wrote the text decides.
    Probably,
}

impl Applies {
    /// As it stands in JSON.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Applies::Always => "always",
            Applies::Probably => "probably",
        }
    }
}

/// A stretch of a text with what is to stand there instead.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Edit {
    /// What goes; nothing, where something is put in.
    pub span: Span,
    /// What comes.
    pub text: String,
}

/// A change of the text that mends what a diagnostic speaks of.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Fix {
    /// What it proposes, as a reader is told.
    pub message: String,
    /// None of them overlaps another one.
    pub edits: Vec<Edit>,
    /// Whether it can be made without asking.
    pub applies: Applies,
}

impl Fix {
    /// Writes something in the place of a span.
    #[must_use]
    pub fn replace(span: Span, text: impl Into<String>, message: impl Into<String>, applies: Applies) -> Fix {
        Fix { message: message.into(), edits: vec![Edit { span, text: text.into() }], applies }
    }

    /// Writes something right before a span.
    #[must_use]
    pub fn insert(before: Span, text: impl Into<String>, message: impl Into<String>, applies: Applies) -> Fix {
        Fix::replace(Span { end: before.start, ..before }, text, message, applies)
    }

    /// Writes something right behind a span.
    #[must_use]
    pub fn append(behind: Span, text: impl Into<String>, message: impl Into<String>, applies: Applies) -> Fix {
        Fix::replace(Span { start: behind.end, ..behind }, text, message, applies)
    }

    /// "was `NAME` meant?"
    #[must_use]
    pub fn meant(span: Span, name: &str) -> Fix {
        Fix::replace(span, name, format!("was `{name}` meant?"), Applies::Probably)
    }
}

/// The text of a file with fixes made in it, and which of them were: of those that overlap, the first one.
#[must_use]
pub fn fixed<'f>(sources: &Sources, file: FileId, fixes: impl IntoIterator<Item = &'f Fix>) -> (String, Vec<&'f Fix>) {
    let (mut made, mut edits): (Vec<&Fix>, Vec<&Edit>) = (Vec::new(), Vec::new());
    for fix in fixes {
        let is_here = fix.edits.iter().all(|edit| edit.span.file == file);
        let is_free = fix.edits.iter().all(|edit| edits.iter().all(|other| !overlap(edit.span, other.span)));
        if is_here && is_free {
            made.push(fix);
            edits.extend(&fix.edits);
        }
    }
    edits.sort_by_key(|edit| edit.span);
    let text = &sources.get(file).text;
    let (mut out, mut at) = (String::with_capacity(text.len()), 0);
    for edit in edits {
        out += &text[at..edit.span.start as usize];
        out += &edit.text;
        at = edit.span.end as usize;
    }
    (out + &text[at..], made)
}

/// Whether two spans share text, or a place where something would be put in.
fn overlap(a: Span, b: Span) -> bool {
    a.start < b.end && b.start < a.end || a.start == b.start
}

#[cfg(test)]
mod tests {
    use super::{Applies, Fix, fixed};
    use crate::source::{Sources, Span};

    #[test]
    fn of_fixes_that_overlap_the_first_applies() {
        let mut sources = Sources::default();
        let file = sources.add("a.mech", "a == b; c");
        let span = |start, end| Span { file, start, end };
        let equals = Fix::replace(span(2, 4), "=", "one `=`", Applies::Always);
        let other = Fix::replace(span(3, 6), "", "drop", Applies::Always);
        let end = Fix::replace(span(6, 7), "", "no `;`", Applies::Always);
        let (text, made) = fixed(&sources, file, [&equals, &other, &end]);
        assert_eq!((text.as_str(), made.len()), ("a = b c", 2));
    }
}
