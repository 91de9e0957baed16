//! Files as they were when they were first read, so that all results of one version of the texts use the same bytes.

use mechc_text::world::{Contents, World};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// A world in which a file keeps the contents that it had when it was first read.
pub(super) struct FileSnapshot {
    world: Arc<dyn World>,
    read: Mutex<Vec<(PathBuf, Result<Contents, ReadFailure>)>>,
}

/// The reason why a file cannot be read.
#[derive(Clone)]
struct ReadFailure {
    kind: io::ErrorKind,
    text: String,
}

impl FileSnapshot {
    pub fn new(world: Arc<dyn World>) -> FileSnapshot {
        FileSnapshot { world, read: Mutex::default() }
    }

    /// Returns whether any file that was read differs in `world`.
    pub fn is_outdated(&self, world: &dyn World) -> bool {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner).clone();
        read.into_iter().any(|(path, before)| match (before, world.read(&path)) {
            (Ok(before), Ok(now)) => before.bytes != now.bytes,
            (Err(before), Err(now)) => before.kind != now.kind(),
            _ => true,
        })
    }

    /// Returns whether a file that was read differs in `world`.
    pub fn differs(&self, path: &Path, world: &dyn World) -> bool {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        let before = read.iter().find(|(other, _)| other == path).and_then(|(_, before)| before.as_ref().ok());
        before.is_none_or(|before| world.read(path).map_or(true, |now| now.bytes != before.bytes))
    }

    /// Returns the files that were read.
    pub fn files(&self) -> Vec<PathBuf> {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.iter().map(|(path, _)| path.clone()).collect()
    }

    fn read_once(&self, path: &Path, read: impl FnOnce() -> io::Result<Contents>) -> io::Result<Contents> {
        let mut cache = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        let contents = if let Some((_, contents)) = cache.iter().find(|(other, _)| other == path) {
            contents.clone()
        } else {
            let contents = read().map_err(|error| ReadFailure { kind: error.kind(), text: error.to_string() });
            cache.push((path.to_owned(), contents.clone()));
            contents
        };
        contents.map_err(|ReadFailure { kind, text }| io::Error::new(kind, text))
    }
}

impl World for FileSnapshot {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        self.read_once(path, || self.world.read(path))
    }

    fn given(&self, path: &Path) -> io::Result<Contents> {
        self.read_once(path, || self.world.given(path))
    }

    fn shown(&self, path: &Path) -> String {
        self.world.shown(path)
    }

    fn names_in(&self, folder: &Path) -> Vec<String> {
        self.world.names_in(folder)
    }

    fn folders_in(&self, folder: &Path) -> Vec<String> {
        self.world.folders_in(folder)
    }

    fn identity(&self, path: &Path) -> PathBuf {
        self.world.identity(path)
    }
}

#[cfg(test)]
mod tests {
    use super::FileSnapshot;
    use mechc_text::world::{Contents, Memory, World};
    use std::io;
    use std::path::Path;
    use std::sync::{Arc, Mutex};

    /// Files that a test changes.
    struct TestFiles(Mutex<Memory>);

    impl World for TestFiles {
        fn read(&self, path: &Path) -> io::Result<Contents> {
            self.0.lock().expect("a lock").read(path)
        }
    }

    #[test]
    fn a_file_that_was_read_stays_the_same() {
        let files = Arc::new(TestFiles(Mutex::new(Memory::default().with("a", "1"))));
        let snapshot = FileSnapshot::new(Arc::clone(&files) as Arc<dyn World>);
        assert!(!snapshot.is_outdated(&*files), "no file was read");
        assert_eq!(&*snapshot.read(Path::new("a")).expect("it is there").bytes, b"1");
        assert!(snapshot.read(Path::new("b")).is_err());
        assert!(!snapshot.is_outdated(&*files));
        *files.0.lock().expect("a lock") = Memory::default().with("a", "1").with("b", "2");
        assert!(snapshot.is_outdated(&*files), "a file that was missing is there");
        assert!(!snapshot.differs(Path::new("a"), &*files), "it is the same");
        assert!(snapshot.read(Path::new("b")).is_err(), "a version changed while it was in use");
        assert_eq!(snapshot.files().len(), 2);
        *files.0.lock().expect("a lock") = Memory::default().with("a", "3");
        assert!(snapshot.differs(Path::new("a"), &*files));
    }
}
