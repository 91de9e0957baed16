//! The first stage: a text with its syntax tree. Knows no names and no units.

use mechc_syntax::{self as syntax, ParsedText, Trivia, ast, format};
use mechc_text::diag::{Diagnostics, Edit, Error};
use mechc_text::source::{FileId, Source, Sources, Span};
use mechc_text::world::{self, World};
use std::path::Path;
use std::sync::Arc;

/// A file that was read, with syntax errors or without.
///
/// ```
/// let parsed = mechc::Parsed::new("two.mech", "mechanism arm { } mechanism leg { body foot { } } // to come");
/// assert!(parsed.faults().is_empty());
/// assert_eq!(parsed.mechanisms().collect::<Vec<_>>(), ["arm", "leg"]);
/// ```
#[derive(Clone, Debug)]
pub struct Parsed {
    sources: Sources,
    file: FileId,
    /// Path of the file, to which paths in its text are relative.
    path: Arc<Path>,
    read: Arc<syntax::ParsedText>,
}

impl Parsed {
    /// Reads a text; `name` is its name in messages, and the path to which paths in it are relative.
    #[must_use]
    pub fn new(name: &str, text: &str) -> Parsed {
        let mut sources = Sources::default();
        let file = sources.add(name, text);
        Parsed::from_source(sources, file, Path::new(name))
    }

    /// Reads a file.
    ///
    /// # Errors
    /// The file does not exist, or is no text; with the sources that the diagnostics point into.
    pub fn read(path: &Path, world: &dyn World) -> Result<Parsed, Error> {
        let mut sources = Sources::default();
        match world::text_of(world, path, &mut sources) {
            Ok(file) => Ok(Parsed::from_source(sources, file, path)),
            Err(why) => Err(Error::new(why, &sources)),
        }
    }

    /// Reads one of several texts; paths in it are relative to `path`.
    #[must_use]
    pub fn from_source(sources: Sources, file: FileId, path: &Path) -> Parsed {
        let read = Arc::new(unless_too_large(&sources, file, || syntax::parse(&sources, file)));
        Parsed { sources, file, path: path.into(), read }
    }

    /// Reads an edited text of the same file, and only what the edit touches. The outcome equals that of [`Parsed::new`].
    #[must_use]
    pub fn edited(&self, text: &str) -> Parsed {
        let current = self.sources.get(self.file);
        let mut sources = Sources::default();
        let file = sources.add(&current.name, text);
        let reparse = || syntax::reparse(&self.read, &current.text, &sources, file);
        let read = Arc::new(unless_too_large(&sources, file, reparse));
        Parsed { sources, file, path: Arc::clone(&self.path), read }
    }

    /// Returns the texts that its diagnostics point into.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// Returns the id of its own text.
    #[must_use]
    pub fn file(&self) -> FileId {
        self.file
    }

    /// Returns the syntax errors.
    #[must_use]
    pub fn faults(&self) -> &Diagnostics {
        &self.read.faults
    }

    /// Returns its comments and blank lines.
    #[must_use]
    pub fn trivia(&self) -> &Trivia {
        &self.read.trivia
    }

    /// Returns the names of its mechanisms, in order.
    #[must_use]
    pub fn mechanisms(&self) -> impl ExactSizeIterator<Item = &str> {
        self.read.tree.mechanisms.iter().map(|mechanism| mechanism.name.text.as_str())
    }

    /// Returns the formatted text; `None` if the text has syntax errors.
    #[must_use]
    pub fn formatted(&self) -> Option<String> {
        let text = &self.sources.get(self.file).text;
        let is_whole = self.read.faults.is_empty();
        is_whole.then(|| syntax::formatted(&self.read, text))
    }

    /// Returns the edits that format the text; a part with syntax errors stays as it is. Only spaces, line ends and commas after the last items of
    /// lists change. The edits are in order and do not overlap.
    #[must_use]
    pub fn formatting(&self) -> Vec<Edit> {
        format::edits(&self.read, &self.sources.get(self.file).text, self.file)
    }

    /// Returns the edits that format the lines of a span, indented as in the whole text.
    #[must_use]
    pub fn formatting_in(&self, span: Span) -> Vec<Edit> {
        format::edits_in(&self.read, &self.sources.get(self.file).text, span)
    }

    /// Returns the edits that format the block whose closing brace ends at a byte, as when it was just typed; none if there is no such block.
    #[must_use]
    pub fn formatting_at_brace(&self, end: u32) -> Vec<Edit> {
        format::edits_at_brace(&self.read, &self.sources.get(self.file).text, self.file, end)
    }

    /// Returns the tree with all that was read.
    pub(crate) fn shared(&self) -> Arc<syntax::ParsedText> {
        Arc::clone(&self.read)
    }

    /// Returns the path to which paths in the text are relative.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the syntax tree.
    #[must_use]
    pub fn tree(&self) -> &ast::File {
        &self.read.tree
    }

    /// Returns the file with more declarations after those of the mechanism at an index.
    pub(crate) fn with_items(&self, index: usize, items: Vec<ast::Item>) -> Parsed {
        if items.is_empty() {
            return self.clone();
        }
        let mut read = (*self.read).clone();
        read.tree.mechanisms[index].items.extend(items);
        Parsed { read: Arc::new(read), ..self.clone() }
    }

    /// Returns the file without some declarations of the mechanism at an index.
    pub(crate) fn without_items(&self, index: usize, is_removed: impl Fn(&ast::Item) -> bool) -> Parsed {
        let mut read = (*self.read).clone();
        read.tree.mechanisms[index].items.retain(|item| !is_removed(item));
        Parsed { read: Arc::new(read), ..self.clone() }
    }

    /// Returns the file with other sources, to which texts were added.
    pub(crate) fn with_sources(&self, sources: Sources) -> Parsed {
        Parsed { sources, ..self.clone() }
    }
}

/// Reads a text unless it is too large for spans.
fn unless_too_large(sources: &Sources, file: FileId, read: impl FnOnce() -> ParsedText) -> ParsedText {
    let Source { name, text, .. } = sources.get(file);
    if text.len() <= world::LARGEST {
        return read();
    }
    ParsedText::unread(world::cannot_read(name, &world::too_large()).into())
}
