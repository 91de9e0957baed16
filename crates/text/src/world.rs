//! Where the files are that a text names: on a disk, in an editor's open buffers, in a browser, in a test.
//!
//! The only way in which a library crate reaches a file.

use crate::diag::{Code, Diagnostic};
use crate::source::{FileId, Sources, Span};
use rustc_hash::FxHashMap;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// No text is larger (bytes): places are counted in 32 bits, and what has no end, as `/dev/zero`, must be seen to have none.
pub const LARGEST: usize = 1 << 30;

/// Why a text beyond [`LARGEST`] is not read.
#[must_use]
pub fn too_large() -> io::Error {
    io::Error::other(format!("it is larger than {} GiB", LARGEST >> 30))
}

/// What a file holds, as of a version.
#[derive(Clone, Debug)]
pub struct Contents {
    /// As stored.
    pub bytes: Arc<[u8]>,
    /// Another one whenever the bytes are; 0 where nobody counts.
    pub version: u64,
}

/// Gives files by their paths.
pub trait World: Send + Sync {
    /// The contents of a file.
    ///
    /// # Errors
    /// It is not there, or cannot be read.
    fn read(&self, path: &Path) -> io::Result<Contents>;

    /// The contents of what is named outside of texts, by an option say, where more than files may be meant: standard input, a pipe.
    ///
    /// # Errors
    /// It is not there, or cannot be read.
    fn given(&self, path: &Path) -> io::Result<Contents> {
        self.read(path)
    }

    /// What messages call that.
    fn shown(&self, path: &Path) -> String {
        path.to_string_lossy().into_owned()
    }

    /// The names of the files in a folder, for a message that says what was probably meant; nothing where nobody can tell.
    fn names_in(&self, folder: &Path) -> Vec<String> {
        let _ = folder;
        Vec::new()
    }

    /// The names of the folders in a folder; nothing where nobody can tell.
    fn folders_in(&self, folder: &Path) -> Vec<String> {
        let _ = folder;
        Vec::new()
    }

    /// What tells a file from all others: two paths with one identity are one file, which is read once.
    fn identity(&self, path: &Path) -> PathBuf {
        normalised(path)
    }
}

/// Whether a file holds mechanisms, by its name.
#[must_use]
pub fn is_mech(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mech"))
}

/// Whether what is in a folder is its user's own, by its name: it is not hidden, and no folder of build results.
#[must_use]
pub fn is_own(name: &str) -> bool {
    !name.starts_with('.') && name != "target" && name != "node_modules"
}

/// A world without files, or with those that were put into it.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    files: FxHashMap<PathBuf, Contents>,
}

impl Memory {
    /// Puts a file in its place, over one that is there.
    #[must_use]
    pub fn with(mut self, path: impl Into<PathBuf>, text: impl AsRef<[u8]>) -> Memory {
        let path = path.into();
        let version = self.files.get(&path).map_or(0, |old| old.version + 1);
        self.files.insert(path, Contents { bytes: text.as_ref().into(), version });
        self
    }
}

impl World for Memory {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        self.files.get(path).cloned().ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    fn names_in(&self, folder: &Path) -> Vec<String> {
        let here = self.files.keys().filter(|path| path.parent() == Some(folder));
        let mut names: Vec<String> =
            here.filter_map(|path| path.file_name()).map(|name| name.to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    fn folders_in(&self, folder: &Path) -> Vec<String> {
        let inside = self.files.keys().filter_map(|path| path.strip_prefix(folder).ok()?.parent()?.components().next());
        let mut names: Vec<String> = inside.map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
        names.sort();
        names.dedup();
        names
    }
}

/// Takes the text of a file in.
///
/// # Errors
/// It cannot be read, or is no text.
pub fn text_of(world: &dyn World, path: &Path, sources: &mut Sources) -> Result<FileId, Box<Diagnostic>> {
    let shown = path.to_string_lossy().into_owned();
    let contents = world.read(path).map_err(|error| Box::new(cannot_read(&shown, &error)))?;
    take_in(&shown, &contents.bytes, sources)
}

/// Takes the rows of what is named outside of texts in.
///
/// # Errors
/// It cannot be read, or is no text.
pub fn rows_given(world: &dyn World, path: &Path, sources: &mut Sources) -> Result<FileId, Box<Diagnostic>> {
    let shown = world.shown(path);
    let contents = world.given(path).map_err(|error| Box::new(cannot_read(&shown, &error)))?;
    take_in(&shown, &with_line_feeds(&contents.bytes), sources)
}

/// Lines that end in a carriage return alone, as some loggers and spreadsheets write them, end in a line feed then; no place is moved.
fn with_line_feeds(bytes: &[u8]) -> Vec<u8> {
    let is_alone = |at: usize| bytes[at] == b'\r' && bytes.get(at + 1) != Some(&b'\n');
    (0..bytes.len()).map(|at| if is_alone(at) { b'\n' } else { bytes[at] }).collect()
}

/// Takes bytes in as a text, under a name.
///
/// # Errors
/// They are too many, or not UTF-8.
pub fn take_in(shown: &str, bytes: &[u8], sources: &mut Sources) -> Result<FileId, Box<Diagnostic>> {
    if bytes.len() > LARGEST {
        return Err(Box::new(cannot_read(shown, &too_large())));
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(sources.add(shown, text)),
        Err(error) => Err(Box::new(not_utf8(shown, bytes, error.valid_up_to(), sources))),
    }
}

/// A file that is named, beside the file that names it.
#[must_use]
pub fn beside(path: &str, named: &str) -> PathBuf {
    match Path::new(path).parent() {
        Some(folder) => folder.join(named),
        None => PathBuf::from(named),
    }
}

/// A path without `.`, and without `..` behind a folder.
#[must_use]
pub fn normalised(path: &Path) -> PathBuf {
    let mut normalised = PathBuf::new();
    for part in path.components() {
        match (part, normalised.components().next_back()) {
            (Component::CurDir, _) | (Component::ParentDir, Some(Component::RootDir | Component::Prefix(_))) => {}
            (Component::ParentDir, Some(Component::Normal(_))) => drop(normalised.pop()),
            _ => normalised.push(part),
        }
    }
    normalised
}

/// The error for a file that cannot be read, by its name; an empty name is standard input.
#[must_use]
pub fn cannot_read(name: &str, error: &io::Error) -> Diagnostic {
    if name.is_empty() {
        return Diagnostic::new(Code::E0701, "cannot read a file without a name");
    }
    let diagnostic =
        Diagnostic::new(Code::E0701, format!("cannot read `{name}`: {}", reason(error))).datum("file", name);
    match error.raw_os_error() {
        Some(number) => diagnostic.datum("errno", number),
        None => diagnostic,
    }
}

/// The system's words, without its number.
#[must_use]
pub fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    let text = text.split(" (os error").next().unwrap_or(&text);
    let mut chars = text.chars();
    chars.next().map_or(String::new(), |first| first.to_lowercase().chain(chars).collect())
}

/// Shows the text up to the byte that is not UTF-8.
fn not_utf8(name: &str, bytes: &[u8], at: usize, sources: &mut Sources) -> Diagnostic {
    let valid = String::from_utf8_lossy(&bytes[..at]).into_owned();
    let file = sources.add(name, valid);
    let end = sources.get(file).text.len() as u32;
    let span = Span { file, start: end, end };
    let byte = bytes.get(at).copied().unwrap_or_default();
    Diagnostic::new(Code::E0102, format!("`{name}` is not UTF-8"))
        .at(span, format!("the byte {byte:#04x} follows here"))
        .help("save the file as UTF-8 in your editor")
}
