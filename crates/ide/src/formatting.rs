//! Formatting of a file, as a list of changes.

use super::location::{Change, FileRange};
use super::snapshot::Snapshot;
use mechc_text::source::Span;
use std::ops::Range;
use std::path::Path;

/// The part of a file to format.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum FormatScope {
    /// The whole file.
    Whole,
    /// The lines that touch a range.
    Lines(Range<u32>),
    /// The block whose closing brace ends at a byte, as when it has just been typed.
    AtBrace(u32),
}

/// Returns the minimal changes that format a file. Text that does not follow the grammar stays as it is.
#[must_use]
pub fn formatting(snapshot: &Snapshot, path: &Path, scope: &FormatScope) -> Option<Vec<Change>> {
    let parsed = snapshot.parsed(path)?;
    let edits = match scope {
        FormatScope::Whole => parsed.formatting(),
        FormatScope::Lines(range) => {
            parsed.formatting_in(Span { file: parsed.file(), start: range.start, end: range.end })
        }
        FormatScope::AtBrace(end) => parsed.formatting_at_brace(*end),
    };
    let change = |edit: mechc_text::diag::Edit| Change {
        location: FileRange::from_span(edit.span, parsed.sources()),
        text: edit.text,
    };
    Some(edits.into_iter().map(change).collect())
}

#[cfg(test)]
mod tests {
    use super::{FormatScope, formatting};
    use crate::testing::at_cursor;
    use crate::trial_edits::{apply, text_of};

    const TEXT: &str =
        "mechanism m {\nparam  a = 3 mm\n  param bcd=4 mm\n    body b {\npoint P=(a,0)\n}$0\n joint k revolute(\n}\n";

    fn formatted(scope: impl Fn(u32) -> FormatScope) -> String {
        let (snapshot, position) = at_cursor(TEXT);
        let changes = formatting(&snapshot, &position.path, &scope(position.offset)).expect("a file");
        let after = apply(&snapshot, &changes).expect("it can be made");
        text_of(&after, &position.path).expect("a text")
    }

    #[test]
    fn sound_text_is_formatted() {
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
        insta::assert_snapshot!(formatted(|_| FormatScope::Lines(20..30)), @r"
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
