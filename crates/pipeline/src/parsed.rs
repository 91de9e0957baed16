//! The first stage: a text with its tree.

use mechc_syntax::{self as syntax, ParsedText, Trivia, ast, format};
use mechc_text::diag::{Diagnostics, Edit};
use mechc_text::source::{FileId, Source, Sources, Span};
use mechc_text::world::{self, World};
use std::path::Path;
use std::sync::Arc;

/// A file that was read, whatever its faults.
///
/// ```
/// let parsed = mechc::Parsed::of("two.mech", "mechanism arm { } mechanism leg { body foot { } } // to come");
/// assert!(parsed.faults().is_empty());
/// assert_eq!(parsed.mechanisms().collect::<Vec<_>>(), ["arm", "leg"]);
/// ```
#[derive(Clone, Debug)]
pub struct Parsed {
    sources: Sources,
    file: FileId,
    /// Beside which the files are that it names.
    path: Arc<Path>,
    read: Arc<syntax::ParsedText>,
}

impl Parsed {
    /// Reads a text under the name that messages are to have for it; the files that it names are beside that.
    #[must_use]
    pub fn of(name: &str, text: &str) -> Parsed {
        let mut sources = Sources::default();
        let file = sources.add(name, text);
        Parsed::of_source(sources, file, Path::new(name))
    }

    /// Reads a file.
    ///
    /// # Errors
    /// It is not there, or no text; with the sources that the diagnostics speak of.
    pub fn read(path: &Path, world: &dyn World) -> Result<Parsed, (Sources, Diagnostics)> {
        let mut sources = Sources::default();
        match world::text_of(world, path, &mut sources) {
            Ok(file) => Ok(Parsed::of_source(sources, file, path)),
            Err(why) => Err((sources, (*why).into())),
        }
    }

    /// Reads one of some texts; the files that it names are beside a path.
    #[must_use]
    pub fn of_source(sources: Sources, file: FileId, path: &Path) -> Parsed {
        let read = Arc::new(unless_too_large(&sources, file, || syntax::parse(&sources, file)));
        Parsed { sources, file, path: path.into(), read }
    }

    /// The same file with another text. Of what the edit does not touch nothing is read again; what comes out is what
    /// [`Parsed::of`] makes of the text.
    #[must_use]
    pub fn edited(&self, text: &str) -> Parsed {
        let own = self.sources.get(self.file);
        let mut sources = Sources::default();
        let file = sources.add(&own.name, text);
        let reread = || syntax::reread(&self.read, &own.text, &sources, file);
        let read = Arc::new(unless_too_large(&sources, file, reread));
        Parsed { sources, file, path: Arc::clone(&self.path), read }
    }

    /// The texts that its diagnostics speak of.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// Its own text among them.
    #[must_use]
    pub fn file(&self) -> FileId {
        self.file
    }

    /// What of it does not follow the grammar.
    #[must_use]
    pub fn faults(&self) -> &Diagnostics {
        &self.read.faults
    }

    /// Its comments and blank lines.
    #[must_use]
    pub fn trivia(&self) -> &Trivia {
        &self.read.trivia
    }

    /// The names of its mechanisms, in order.
    #[must_use]
    pub fn mechanisms(&self) -> impl ExactSizeIterator<Item = &str> {
        self.read.tree.mechanisms.iter().map(|mechanism| mechanism.name.text.as_str())
    }

    /// The text as it would be written; nothing where a part of it cannot be read, which would be lost.
    #[must_use]
    pub fn formatted(&self) -> Option<String> {
        let text = &self.sources.get(self.file).text;
        let is_whole = self.read.faults.is_empty();
        is_whole.then(|| syntax::formatted(&self.read, text))
    }

    /// What to change in the text so that it is formatted; where it does not follow the grammar, in what is whole of it. Only spaces,
    /// line ends and commas behind the last item of a list change. The edits are in order and do not overlap.
    #[must_use]
    pub fn formatting(&self) -> Vec<Edit> {
        format::edits(&self.read, &self.sources.get(self.file).text, self.file)
    }

    /// The same, in the lines that have a part in a span; their columns are those that the whole text would have.
    #[must_use]
    pub fn formatting_in(&self, span: Span) -> Vec<Edit> {
        format::edits_in(&self.read, &self.sources.get(self.file).text, span)
    }

    /// The same, in the block that is closed by the brace which ends at a byte, as when somebody has just typed it; nothing if there is
    /// none.
    #[must_use]
    pub fn formatting_at_brace(&self, end: u32) -> Vec<Edit> {
        format::edits_at_brace(&self.read, &self.sources.get(self.file).text, self.file, end)
    }

    /// What was read.
    pub(super) fn shared(&self) -> Arc<syntax::ParsedText> {
        Arc::clone(&self.read)
    }

    /// Beside which the files are that it names.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// What was written.
    #[must_use]
    pub fn tree(&self) -> &ast::File {
        &self.read.tree
    }

    /// The same, with more declarations behind those of one of its mechanisms, by its number.
    pub(super) fn with_items(&self, number: usize, items: Vec<ast::Item>) -> Parsed {
        if items.is_empty() {
            return self.clone();
        }
        let mut read = (*self.read).clone();
        read.tree.mechanisms[number].items.extend(items);
        Parsed { read: Arc::new(read), ..self.clone() }
    }

    /// The same, without some declarations of one of its mechanisms, by its number.
    pub(super) fn without_items(&self, number: usize, is_one: impl Fn(&ast::Item) -> bool) -> Parsed {
        let mut read = (*self.read).clone();
        read.tree.mechanisms[number].items.retain(|item| !is_one(item));
        Parsed { read: Arc::new(read), ..self.clone() }
    }

    /// The same, with more texts beside it.
    pub(super) fn with_sources(&self, sources: Sources) -> Parsed {
        Parsed { sources, ..self.clone() }
    }
}

/// What is read of a text, unless places in it could not be told.
fn unless_too_large(sources: &Sources, file: FileId, read: impl FnOnce() -> ParsedText) -> ParsedText {
    let Source { name, text, .. } = sources.get(file);
    if text.len() <= world::LARGEST {
        return read();
    }
    let fault = world::cannot_read(name, &world::too_large());
    let tree = ast::File { uses: Vec::new(), mechanisms: Vec::new() };
    ParsedText { tree, trivia: Trivia::default(), faults: fault.into() }
}
