//! Places of files, and changes there.

use mechc_text::source::{Sources, Span};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A byte of a file.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct FilePosition {
    /// The file, by the path that [`super::Snapshot`] knows it by.
    pub path: Arc<Path>,
    /// The byte.
    pub offset: u32,
}

/// A stretch of a file, in bytes.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct FileRange {
    /// The file.
    pub path: Arc<Path>,
    /// The first byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl FileRange {
    /// The place of a span.
    #[must_use]
    pub fn of(span: Span, sources: &Sources) -> FileRange {
        let path = PathBuf::from(&sources.get(span.file).name);
        FileRange { path: path.into(), start: span.start, end: span.end }
    }

    /// Its bytes.
    #[must_use]
    pub fn range(&self) -> Range<u32> {
        self.start..self.end
    }
}

/// What is to stand in the place of a stretch.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Change {
    /// What goes; nothing, where something is put in.
    pub position: FileRange,
    /// What comes.
    pub text: String,
}
