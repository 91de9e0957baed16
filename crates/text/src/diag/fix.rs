//! Fixes: edits of the text with a message that proposes them.

use crate::source::{FileId, Sources, Span};

/// Confidence of a fix.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Applicability {
    /// Correct in every case; tools may apply it without asking.
    Always,
    /// Probably what was intended; the author decides.
    Probably,
}

impl Applicability {
    /// Returns the word for JSON.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Applicability::Always => "always",
            Applicability::Probably => "probably",
        }
    }
}

/// Replacement of a span.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Edit {
    /// Span to replace; empty for an insertion.
    pub span: Span,
    /// New text.
    pub text: String,
}

/// A set of edits that resolves a diagnostic.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Fix {
    /// Message that proposes the fix.
    pub message: String,
    /// Edits, which do not overlap.
    pub edits: Vec<Edit>,
    /// Confidence.
    pub applies: Applicability,
}

impl Fix {
    /// Creates a fix that replaces a span.
    #[must_use]
    pub fn replace(span: Span, text: impl Into<String>, message: impl Into<String>, applies: Applicability) -> Fix {
        Fix { message: message.into(), edits: vec![Edit { span, text: text.into() }], applies }
    }

    /// Creates a fix that inserts text before a span.
    #[must_use]
    pub fn insert(before: Span, text: impl Into<String>, message: impl Into<String>, applies: Applicability) -> Fix {
        Fix::replace(Span { end: before.start, ..before }, text, message, applies)
    }

    /// Creates a fix that inserts text after a span.
    #[must_use]
    pub fn append(after: Span, text: impl Into<String>, message: impl Into<String>, applies: Applicability) -> Fix {
        Fix::replace(Span { start: after.end, ..after }, text, message, applies)
    }

    /// Creates a fix that replaces a span and is probably what was intended.
    #[must_use]
    pub fn probably(span: Span, text: impl Into<String>, message: impl Into<String>) -> Fix {
        Fix::replace(span, text, message, Applicability::Probably)
    }

    /// Creates the fix "was `NAME` meant?", which replaces a span.
    #[must_use]
    pub fn suggest(span: Span, name: &str) -> Fix {
        Fix::probably(span, name, format!("was `{name}` meant?"))
    }
}

/// Applies fixes to the text of a file. Returns the text and the applied fixes; of overlapping fixes only the first one is applied.
#[must_use]
pub fn fixed<'f>(sources: &Sources, file: FileId, fixes: impl IntoIterator<Item = &'f Fix>) -> (String, Vec<&'f Fix>) {
    let (mut applied, mut edits): (Vec<&Fix>, Vec<&Edit>) = (Vec::new(), Vec::new());
    for fix in fixes {
        let is_here = fix.edits.iter().all(|edit| edit.span.file == file);
        let is_free = fix.edits.iter().all(|edit| edits.iter().all(|other| !overlap(edit.span, other.span)));
        if is_here && is_free {
            applied.push(fix);
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
    (out + &text[at..], applied)
}

/// Returns whether two spans share text or a start.
fn overlap(a: Span, b: Span) -> bool {
    a.start < b.end && b.start < a.end || a.start == b.start
}

#[cfg(test)]
mod tests {
    use super::{Applicability, Fix, fixed};
    use crate::source::{Sources, Span};

    #[test]
    fn of_fixes_that_overlap_the_first_applies() {
        let mut sources = Sources::default();
        let file = sources.add("a.mech", "a == b; c");
        let span = |start, end| Span { file, start, end };
        let equals = Fix::replace(span(2, 4), "=", "one `=`", Applicability::Always);
        let other = Fix::replace(span(3, 6), "", "drop", Applicability::Always);
        let end = Fix::replace(span(6, 7), "", "no `;`", Applicability::Always);
        let (text, applied) = fixed(&sources, file, [&equals, &other, &end]);
        assert_eq!((text.as_str(), applied.len()), ("a = b c", 2));
    }
}
