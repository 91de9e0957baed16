//! The files as an editor has them: open texts take precedence over the files on disk.

use mechc_text::world::{Contents, World};
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Open texts, with a world for all other files.
#[derive(Clone)]
pub struct Buffers {
    /// The open texts, by the identity of their files.
    open: BTreeMap<Arc<Path>, Arc<str>>,
    behind: Arc<dyn World>,
}

impl Buffers {
    /// Creates buffers without an open text.
    #[must_use]
    pub fn new(behind: Arc<dyn World>) -> Buffers {
        Buffers { open: BTreeMap::new(), behind }
    }

    /// Opens a text or changes an open one; `None` closes it.
    pub fn set(&mut self, path: &Arc<Path>, text: Option<Arc<str>>) {
        match text {
            Some(text) => drop(self.open.insert(Arc::clone(path), text)),
            None => drop(self.open.remove(path)),
        }
    }

    /// Returns the text of a file, if it is open.
    #[must_use]
    pub fn open(&self, path: &Path) -> Option<&Arc<str>> {
        self.open.get(path)
    }

    /// Returns the open files, by identity.
    pub fn paths(&self) -> impl Iterator<Item = &Arc<Path>> {
        self.open.keys()
    }

    /// Returns the open text of a path; the path may be any that leads to the file.
    fn text(&self, path: &Path) -> Option<&Arc<str>> {
        self.open.get(path).or_else(|| self.open.get(self.behind.identity(path).as_path()))
    }
}

impl World for Buffers {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        match self.text(path) {
            Some(text) => Ok(Contents { bytes: text.as_bytes().into(), version: 0 }),
            None => self.behind.read(path),
        }
    }

    fn shown(&self, path: &Path) -> String {
        self.behind.shown(path)
    }

    fn names_in(&self, folder: &Path) -> Vec<String> {
        let mut names = self.behind.names_in(folder);
        let open = self.open.keys().filter(|path| path.parent() == Some(folder));
        names.extend(open.filter_map(|path| path.file_name()).map(|name| name.to_string_lossy().into_owned()));
        names.sort();
        names.dedup();
        names
    }

    fn folders_in(&self, folder: &Path) -> Vec<String> {
        self.behind.folders_in(folder)
    }

    fn identity(&self, path: &Path) -> PathBuf {
        if self.open.contains_key(path) { path.to_owned() } else { self.behind.identity(path) }
    }
}

#[cfg(test)]
mod tests {
    use super::Buffers;
    use mechc_text::world::{Memory, World};
    use std::path::Path;
    use std::sync::Arc;

    #[test]
    fn an_open_text_comes_before_the_file_behind_it() {
        let behind = Memory::default().with("a/x.mech", "behind").with("a/y.mech", "behind");
        let mut buffers = Buffers::new(Arc::new(behind));
        let path: Arc<Path> = Path::new("a/x.mech").into();
        buffers.set(&path, Some("open".into()));
        buffers.set(&Path::new("a/new.mech").into(), Some("new".into()));
        let text = |buffers: &Buffers, path: &str| {
            String::from_utf8(buffers.read(Path::new(path)).expect("it is there").bytes.to_vec()).expect("a text")
        };
        assert_eq!(text(&buffers, "a/b/../x.mech"), "open");
        assert_eq!(text(&buffers, "a/y.mech"), "behind");
        assert_eq!(buffers.names_in(Path::new("a")), ["new.mech", "x.mech", "y.mech"]);
        buffers.set(&path, None);
        assert_eq!(text(&buffers, "a/x.mech"), "behind");
    }
}
