//! Access to the files that a text names: on a disk, in open buffers of an editor, in a browser, or in a test.
//!
//! Library crates reach files only through this module.

use crate::diag::{Code, Diagnostic};
use crate::source::{FileId, Sources, Span};
use rustc_hash::FxHashMap;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// Size limit of a text (bytes): offsets have 32 bits, and endless files such as `/dev/zero` must fail.
pub const LARGEST: usize = 1 << 30;

/// Returns the error for a text larger than [`LARGEST`].
#[must_use]
pub fn too_large() -> io::Error {
    io::Error::other(format!("it is larger than {} GiB", LARGEST >> 30))
}

/// Contents of a file in one version.
#[derive(Clone, Debug)]
pub struct Contents {
    /// Bytes as stored.
    pub bytes: Arc<[u8]>,
    /// Number that changes whenever the bytes do; always 0 in a world that does not count.
    pub version: u64,
}

/// Source of files by path.
pub trait World: Send + Sync {
    /// Returns the contents of a file.
    ///
    /// # Errors
    /// If the file does not exist or cannot be read.
    fn read(&self, path: &Path) -> io::Result<Contents>;

    /// Returns the contents of what an option names, which may be more than a file: standard input or a pipe.
    ///
    /// # Errors
    /// If it does not exist or cannot be read.
    fn given(&self, path: &Path) -> io::Result<Contents> {
        self.read(path)
    }

    /// Returns the name that messages use for what an option names.
    fn shown(&self, path: &Path) -> String {
        path.to_string_lossy().into_owned()
    }

    /// Returns the names of the files in a folder, for suggestions; empty if they are not available.
    fn names_in(&self, folder: &Path) -> Vec<String> {
        let _ = folder;
        Vec::new()
    }

    /// Returns the names of the folders in a folder; empty if they are not available.
    fn folders_in(&self, folder: &Path) -> Vec<String> {
        let _ = folder;
        Vec::new()
    }

    /// Returns the identity of a file: two paths with equal identities are one file, which is read once.
    fn identity(&self, path: &Path) -> PathBuf {
        normalize_path(path)
    }
}

/// Returns whether a file name is that of a mechanism file.
#[must_use]
pub fn is_mech(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mech"))
}

/// Returns whether an entry of a folder belongs to the user, by its name: it is neither hidden nor a folder of build results.
#[must_use]
pub fn is_source_entry(name: &str) -> bool {
    !name.starts_with('.') && name != "target" && name != "node_modules"
}

/// World in memory, empty unless files are added.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    files: FxHashMap<PathBuf, Contents>,
}

impl Memory {
    /// Adds a file, or replaces the one at its path.
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

/// Reads a file into the sources.
///
/// # Errors
/// If it cannot be read or is not UTF-8.
pub fn text_of(world: &dyn World, path: &Path, sources: &mut Sources) -> Result<FileId, Box<Diagnostic>> {
    let shown = path.to_string_lossy().into_owned();
    let contents = world.read(path).map_err(|error| Box::new(cannot_read(&shown, &error)))?;
    take_in(&shown, &contents.bytes, sources)
}

/// Reads what an option names into the sources, as rows of a table.
///
/// # Errors
/// If it cannot be read or is not UTF-8.
pub fn read_rows(world: &dyn World, path: &Path, sources: &mut Sources) -> Result<FileId, Box<Diagnostic>> {
    let shown = world.shown(path);
    let contents = world.given(path).map_err(|error| Box::new(cannot_read(&shown, &error)))?;
    take_in(&shown, &with_line_feeds(&contents.bytes), sources)
}

/// Replaces carriage returns that end lines alone, as some loggers and spreadsheets write them, by line feeds. Offsets stay the same.
fn with_line_feeds(bytes: &[u8]) -> Vec<u8> {
    let is_lone = |at: usize| bytes[at] == b'\r' && bytes.get(at + 1) != Some(&b'\n');
    (0..bytes.len()).map(|at| if is_lone(at) { b'\n' } else { bytes[at] }).collect()
}

/// Adds bytes to the sources as a text with a name.
///
/// # Errors
/// If the text is too large or not UTF-8.
pub fn take_in(shown: &str, bytes: &[u8], sources: &mut Sources) -> Result<FileId, Box<Diagnostic>> {
    if bytes.len() > LARGEST {
        return Err(Box::new(cannot_read(shown, &too_large())));
    }
    match std::str::from_utf8(bytes) {
        Ok(text) => Ok(sources.add(shown, text)),
        Err(error) => Err(Box::new(not_utf8(shown, bytes, error.valid_up_to(), sources))),
    }
}

/// Returns the path of a named file relative to the file that names it.
#[must_use]
pub fn beside(path: &str, named: &str) -> PathBuf {
    match Path::new(path).parent() {
        Some(folder) => folder.join(named),
        None => PathBuf::from(named),
    }
}

/// Removes `.` from a path, and `..` together with the folder before it.
#[must_use]
pub fn normalize_path(path: &Path) -> PathBuf {
    let mut normalize_path = PathBuf::new();
    for part in path.components() {
        match (part, normalize_path.components().next_back()) {
            (Component::CurDir, _) | (Component::ParentDir, Some(Component::RootDir | Component::Prefix(_))) => {}
            (Component::ParentDir, Some(Component::Normal(_))) => drop(normalize_path.pop()),
            _ => normalize_path.push(part),
        }
    }
    normalize_path
}

/// Returns the error for a file that cannot be read; an empty name is one that is missing.
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

/// Returns the system's message without its number.
#[must_use]
pub fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    let text = text.split(" (os error").next().unwrap_or(&text);
    let mut chars = text.chars();
    chars.next().map_or(String::new(), |first| first.to_lowercase().chain(chars).collect())
}

/// Returns the error for a file that is not UTF-8, which shows the text up to the invalid byte.
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
