//! Positions and ranges in files, and changes of texts.

use mechc_text::source::{Sources, Span};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A byte of a file.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct FilePosition {
    /// The file, by its path in [`super::Snapshot`].
    pub path: Arc<Path>,
    /// The offset in bytes.
    pub offset: u32,
}

/// A range of a file, in bytes.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct FileRange {
    /// The file.
    pub path: Arc<Path>,
    /// The first byte.
    pub start: u32,
    /// The end: one past the last byte.
    pub end: u32,
}

impl FileRange {
    /// Converts a span to the range of its file.
    #[must_use]
    pub fn from_span(span: Span, sources: &Sources) -> FileRange {
        let path = PathBuf::from(&sources.get(span.file).name);
        FileRange { path: path.into(), start: span.start, end: span.end }
    }

    /// Returns the range without its file.
    #[must_use]
    pub fn range(&self) -> Range<u32> {
        self.start..self.end
    }
}

/// A replacement of a range of a file.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Change {
    /// The range to replace; empty for an insertion.
    pub location: FileRange,
    /// The new text.
    pub text: String,
}
