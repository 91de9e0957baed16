//! The style of a text: what to change for it.

use super::location::{Change, FileRange};
use super::snapshot::Snapshot;
use mechc_text::source::Span;
use std::ops::Range;
use std::path::Path;

/// What of a file is formatted.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum FormatScope {
    /// All of it.
    Whole,
    /// The lines that have a part in a stretch.
    In(Range<u32>),
    /// The block that a brace closes which ends at a byte, as when it has just been typed.
    AtBrace(u32),
}

/// What to change so that a file is formatted: the least that does it. What does not follow the grammar stays as it is.
#[must_use]
pub fn formatting(snapshot: &Snapshot, path: &Path, what: &FormatScope) -> Option<Vec<Change>> {
    let parsed = snapshot.parsed(path)?;
    let edits = match what {
        FormatScope::Whole => parsed.formatting(),
        FormatScope::In(range) => parsed.formatting_in(Span { file: parsed.file(), start: range.start, end: range.end }),
        FormatScope::AtBrace(end) => parsed.formatting_at_brace(*end),
    };
    let change =
        |edit: mechc_text::diag::Edit| Change { location: FileRange::of(edit.span, parsed.sources()), text: edit.text };
    Some(edits.into_iter().map(change).collect())
}

#[cfg(test)]
mod tests {
    use super::{FormatScope, formatting};
    use crate::trial_edits::{applied, text_of};
    use crate::testing::at_cursor;

    const TEXT: &str =
        "mechanism m {\nparam  a = 3 mm\n  param bcd=4 mm\n    body b {\npoint P=(a,0)\n}$0\n joint k revolute(\n}\n";

    fn formatted(what: impl Fn(u32) -> FormatScope) -> String {
        let (snapshot, position) = at_cursor(TEXT);
        let changes = formatting(&snapshot, &position.path, &what(position.offset)).expect("a file");
        let after = applied(&snapshot, &changes).expect("it can be made");
        text_of(&after, &position.path).expect("a text")
    }

    #[test]
    fn what_is_whole_is_formatted() {
        insta::assert_snapshot!(formatted(|_| FormatScope::Whole), @r"
        mechanism m {
            param a   = 3 mm
            param bcd = 4 mm
            body b {
                point P = (a, 0)
            }
         joint k revolute(
        }
        ");
        insta::assert_snapshot!(formatted(|_| FormatScope::In(20..30)), @r"
        mechanism m {
            param a   = 3 mm
          param bcd=4 mm
            body b {
        point P=(a,0)
        }
         joint k revolute(
        }
        ");
        insta::assert_snapshot!(formatted(FormatScope::AtBrace), @r"
        mechanism m {
        param  a = 3 mm
          param bcd=4 mm
            body b {
                point P = (a, 0)
            }
         joint k revolute(
        }
        ");
    }
}
