//! Protection of input files: no output may overwrite a file that was read or that a text names.

use super::failure::{Failure, unusable};
use mechc_text::source::Sources;
use std::borrow::Cow;
use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The name of standard input in messages.
pub(super) const STANDARD_INPUT: &str = "<stdin>";

/// The files that no output may overwrite.
#[derive(Default)]
pub(super) struct ProtectedPaths<'s> {
    /// The files that were read.
    pub read: Option<&'s Sources>,
    /// The files that texts and options name, even if the command did not read them.
    pub named: &'s [PathBuf],
}

impl ProtectedPaths<'_> {
    /// Refuses an output that is one of them, also through links and other paths.
    pub fn refuse(&self, name: &str) -> Result<(), Failure> {
        let path = Path::new(name);
        if name == "-" {
            return Ok(());
        }
        let (shown, why) = if let Some(read) = self.read_at(path) {
            (read, "and was read")
        } else if let Some(named) = self.named.iter().find(|named| is_same(named, path)) {
            (named.to_string_lossy().into_owned(), "and is named by the input")
        } else {
            return Ok(());
        };
        let same = if shown == name { String::new() } else { format!(": it is `{shown}`") };
        Err(unusable(format!("`{name}` would be written over, {why}{same}"))
            .help("name another output; nothing was touched")
            .into())
    }

    /// Returns the name in messages of the file at a path, if it was read.
    fn read_at(&self, path: &Path) -> Option<String> {
        let output = identity(path)?;
        let files = self.read?.iter().filter(|source| !source.is_option).map(|source| source.name.as_str());
        let path_of = |shown| if shown == STANDARD_INPUT { "/dev/stdin" } else { shown };
        let mut found = files.filter(|&shown| identity(Path::new(path_of(shown))).as_ref() == Some(&output));
        found.next().map(str::to_owned)
    }
}

/// Returns whether two paths lead to the same file, existing or not.
pub(super) fn is_same(named: &Path, output: &Path) -> bool {
    match (identity(named), identity(output)) {
        (Some(named), Some(output)) => named == output,
        (None, None) => location(named).is_some_and(|named| Some(named) == location(output)),
        _ => false,
    }
}

/// Refuses outputs of which two are the same file through a link.
pub(super) fn refuse_links<'n>(names: impl Iterator<Item = Cow<'n, str>>) -> Result<(), Failure> {
    let (mut files, mut locations) = (HashMap::new(), HashMap::new());
    for name in names {
        let path = Path::new(&*name);
        let other = match (identity(path), location(path)) {
            (Some(file), _) => files.insert(file, name.clone()),
            (None, Some(location)) => locations.insert(location, name.clone()),
            (None, None) => None,
        };
        if let Some(other) = other {
            let message = format!("`{other}` and `{name}` are one file by a link");
            return Err(unusable(message).help("remove the link; nothing was touched").into());
        }
    }
    Ok(())
}

/// Returns the location of a file, existing or not, with all links resolved; `None` for a folder.
fn location(path: &Path) -> Option<PathBuf> {
    let path = resolve_links(path).ok()?;
    if path.is_dir() {
        return None;
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(folder.canonicalize().ok()?.join(path.file_name()?))
}

/// Returns the identity of a file, the same through all links; `None` if it is not a regular file.
#[cfg(unix)]
fn identity(path: &Path) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    path.metadata().ok().filter(std::fs::Metadata::is_file).map(|found| (found.dev(), found.ino()))
}

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok().filter(|path| path.is_file())
}

/// Returns the end of a chain of links: an output replaces the target of a link and not the link.
pub(super) fn resolve_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..40 {
        match fs::read_link(&path) {
            Ok(target) => path = path.parent().unwrap_or(Path::new("")).join(target),
            // the path is no link
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("its links go in a circle"))
}
