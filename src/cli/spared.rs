//! What no output may be: a file that was read, or that a text names.

use super::failure::{Failure, unusable};
use mechc_text::source::Sources;
use std::borrow::Cow;
use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// What standard input is called in messages.
pub(super) const STANDARD_INPUT: &str = "<stdin>";

/// The files that stay as they are.
#[derive(Default)]
pub(super) struct Spared<'s> {
    /// Those that were read.
    pub read: Option<&'s Sources>,
    /// Those that texts and options name, whether or not the command needed them.
    pub named: &'s [PathBuf],
}

impl Spared<'_> {
    /// Refuses to write over one of them, by whatever path or link.
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

    /// What messages call the file of a path, if it was read.
    fn read_at(&self, path: &Path) -> Option<String> {
        let own = identity(path)?;
        let files = self.read?.iter().filter(|source| !source.is_option).map(|source| source.name.as_str());
        let path_of = |shown| if shown == STANDARD_INPUT { "/dev/stdin" } else { shown };
        let mut found = files.filter(|&shown| identity(Path::new(path_of(shown))).as_ref() == Some(&own));
        found.next().map(str::to_owned)
    }
}

/// Whether two paths lead to one file, or would, if it were there.
pub(super) fn is_same(named: &Path, output: &Path) -> bool {
    match (identity(named), identity(output)) {
        (Some(named), Some(output)) => named == output,
        (None, None) => place(named).is_some_and(|named| Some(named) == place(output)),
        _ => false,
    }
}

/// Refuses outputs of which two are one file by a link.
pub(super) fn refuse_links<'n>(names: impl Iterator<Item = Cow<'n, str>>) -> Result<(), Failure> {
    let (mut files, mut places) = (HashMap::new(), HashMap::new());
    for name in names {
        let path = Path::new(&*name);
        let other = match (identity(path), place(path)) {
            (Some(file), _) => files.insert(file, name.clone()),
            (None, Some(place)) => places.insert(place, name.clone()),
            (None, None) => None,
        };
        if let Some(other) = other {
            let said = format!("`{other}` and `{name}` are one file by a link");
            return Err(unusable(said).help("remove the link; nothing was touched").into());
        }
    }
    Ok(())
}

/// Where a file is, or would be if it were there, behind all links; what is there and no file has no such place of its own.
fn place(path: &Path) -> Option<PathBuf> {
    let path = behind_links(path).ok()?;
    if path.is_dir() {
        return None;
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(folder.canonicalize().ok()?.join(path.file_name()?))
}

/// What tells a file from all others, whichever links lead to it; what is no file has none.
#[cfg(unix)]
fn identity(path: &Path) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    path.metadata().ok().filter(std::fs::Metadata::is_file).map(|found| (found.dev(), found.ino()))
}

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<PathBuf> {
    path.canonicalize().ok().filter(|path| path.is_file())
}

/// The file that a chain of links ends at: a link stays a link, what it points to is replaced.
pub(super) fn behind_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..40 {
        match fs::read_link(&path) {
            Ok(target) => path = path.parent().unwrap_or(Path::new("")).join(target),
            // no link
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("its links go in a circle"))
}
