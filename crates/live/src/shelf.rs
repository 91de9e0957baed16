//! Files as they were when somebody first looked: all that is made of one version of the texts is made of the same bytes.

use mechc_text::world::{Contents, World};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// A world in which nothing changes any more.
pub(super) struct Shelf {
    world: Arc<dyn World>,
    read: Mutex<Vec<(PathBuf, Result<Contents, Missing>)>>,
}

/// Why a file is not there.
#[derive(Clone)]
struct Missing {
    kind: io::ErrorKind,
    text: String,
}

impl Shelf {
    pub fn new(world: Arc<dyn World>) -> Shelf {
        Shelf { world, read: Mutex::default() }
    }

    /// Whether some file that was looked at is another in a world.
    pub fn is_old(&self, world: &dyn World) -> bool {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner).clone();
        read.into_iter().any(|(path, known)| match (known, world.read(&path)) {
            (Ok(known), Ok(now)) => known.bytes != now.bytes,
            (Err(known), Err(now)) => known.kind != now.kind(),
            _ => true,
        })
    }

    /// Whether a file that was looked at is another in a world.
    pub fn is_other(&self, path: &Path, world: &dyn World) -> bool {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        let known = read.iter().find(|(other, _)| other == path).and_then(|(_, known)| known.as_ref().ok());
        known.is_none_or(|known| world.read(path).map_or(true, |now| now.bytes != known.bytes))
    }

    /// The files that were looked at.
    pub fn files(&self) -> Vec<PathBuf> {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.iter().map(|(path, _)| path.clone()).collect()
    }

    fn kept(&self, path: &Path, read: impl FnOnce() -> io::Result<Contents>) -> io::Result<Contents> {
        let mut known = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        let found = if let Some((_, found)) = known.iter().find(|(other, _)| other == path) {
            found.clone()
        } else {
            let found = read().map_err(|error| Missing { kind: error.kind(), text: error.to_string() });
            known.push((path.to_owned(), found.clone()));
            found
        };
        found.map_err(|Missing { kind, text }| io::Error::new(kind, text))
    }
}

impl World for Shelf {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        self.kept(path, || self.world.read(path))
    }

    fn given(&self, path: &Path) -> io::Result<Contents> {
        self.kept(path, || self.world.given(path))
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
    use super::Shelf;
    use mechc_text::world::{Contents, Memory, World};
    use std::io;
    use std::path::Path;
    use std::sync::{Arc, Mutex};

    /// Files that a test changes.
    struct Desk(Mutex<Memory>);

    impl World for Desk {
        fn read(&self, path: &Path) -> io::Result<Contents> {
            self.0.lock().expect("a lock").read(path)
        }
    }

    #[test]
    fn what_was_read_stays_until_somebody_asks_whether_it_is_old() {
        let desk = Arc::new(Desk(Mutex::new(Memory::default().with("a", "1"))));
        let shelf = Shelf::new(Arc::clone(&desk) as Arc<dyn World>);
        assert!(!shelf.is_old(&*desk), "nobody has looked at anything");
        assert_eq!(&*shelf.read(Path::new("a")).expect("it is there").bytes, b"1");
        assert!(shelf.read(Path::new("b")).is_err());
        assert!(!shelf.is_old(&*desk));
        *desk.0.lock().expect("a lock") = Memory::default().with("a", "1").with("b", "2");
        assert!(shelf.is_old(&*desk), "a file that was missing is there");
        assert!(!shelf.is_other(Path::new("a"), &*desk), "it is the same");
        assert!(shelf.read(Path::new("b")).is_err(), "a version changed while it was in use");
        assert_eq!(shelf.files().len(), 2);
        *desk.0.lock().expect("a lock") = Memory::default().with("a", "3");
        assert!(shelf.is_other(Path::new("a"), &*desk));
    }
}
