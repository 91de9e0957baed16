//! The files that a mechanism reads: those of this machine, and those that were handed over; each is remembered, so that a mechanism
//! can be packed with all that it was made of.

use mechc::{Contents, World};
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::{fs, io};

/// No file is larger (bytes), as the command has it.
pub const LARGEST: u64 = 1 << 30;

/// So many files are named where one is missing.
const MOST_NAMED: usize = 8;

/// The files of a mechanism.
pub struct Files {
    known: Mutex<BTreeMap<PathBuf, Arc<[u8]>>>,
    /// Whether what a text names may be read from the disk.
    from_disk: bool,
}

impl Files {
    /// Some that are known; others are read from the disk, if they may be.
    pub fn new(known: BTreeMap<PathBuf, Vec<u8>>, from_disk: bool) -> Files {
        let known = known.into_iter().map(|(path, bytes)| (plain(&path), Arc::from(bytes))).collect();
        Files { known: Mutex::new(known), from_disk }
    }

    /// All that are known by now.
    pub fn known(&self) -> BTreeMap<PathBuf, Arc<[u8]>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn find(&self, path: &Path) -> Option<Arc<[u8]>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner).get(&plain(path)).cloned()
    }

    /// That a file is none of those that were handed over.
    fn missing(&self) -> io::Error {
        let known = self.known();
        let mut names: Vec<String> =
            known.keys().take(MOST_NAMED).map(|path| format!("`{}`", path.display())).collect();
        if known.len() > MOST_NAMED {
            names.push("…".to_owned());
        }
        let said = if names.is_empty() {
            "`files` has none: give its text there".to_owned()
        } else {
            format!("`files` has {} alone", names.join(", "))
        };
        io::Error::new(io::ErrorKind::NotFound, said)
    }
}

impl World for Files {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        let bytes = match self.find(path) {
            Some(bytes) => bytes,
            None if self.from_disk => {
                let bytes: Arc<[u8]> = named(path)?.into();
                let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
                known.insert(plain(path), Arc::clone(&bytes));
                bytes
            }
            None => return Err(self.missing()),
        };
        Ok(Contents { bytes, version: 0 })
    }

    /// What an option names is read anew each time.
    fn given(&self, path: &Path) -> io::Result<Contents> {
        let bytes = match self.find(path) {
            Some(bytes) => bytes,
            None => named(path)?.into(),
        };
        Ok(Contents { bytes, version: 0 })
    }

    fn names_in(&self, folder: &Path) -> Vec<String> {
        if self.from_disk { entries(folder, false) } else { Vec::new() }
    }

    fn folders_in(&self, folder: &Path) -> Vec<String> {
        if self.from_disk { entries(folder, true) } else { Vec::new() }
    }

    fn identity(&self, path: &Path) -> PathBuf {
        let on_disk = if self.from_disk { path.canonicalize().ok() } else { None };
        on_disk.unwrap_or_else(|| mechc::Memory::default().identity(path))
    }
}

/// The files of a mechanism, and tables that are listed by a caller beside them.
pub struct WithLists<'f> {
    files: &'f Files,
    lists: Vec<(PathBuf, Vec<u8>)>,
}

impl<'f> WithLists<'f> {
    /// Tables, as the bytes of CSV files, by what options name them.
    pub fn new(files: &'f Files, lists: Vec<(PathBuf, Vec<u8>)>) -> WithLists<'f> {
        WithLists { files, lists }
    }
}

impl World for WithLists<'_> {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        self.files.read(path)
    }

    fn given(&self, path: &Path) -> io::Result<Contents> {
        match self.lists.iter().find(|(name, _)| name == path) {
            Some((_, bytes)) => Ok(Contents { bytes: bytes.as_slice().into(), version: 0 }),
            None => self.files.given(path),
        }
    }

    fn names_in(&self, folder: &Path) -> Vec<String> {
        self.files.names_in(folder)
    }

    fn folders_in(&self, folder: &Path) -> Vec<String> {
        self.files.folders_in(folder)
    }

    fn identity(&self, path: &Path) -> PathBuf {
        self.files.identity(path)
    }
}

/// A path without steps to where it is already.
fn plain(path: &Path) -> PathBuf {
    path.components().filter(|part| !matches!(part, Component::CurDir)).collect()
}

/// The bytes of a file; what is none may have no end, or wait for somebody to write.
fn named(path: &Path) -> io::Result<Vec<u8>> {
    let found = fs::metadata(path)?;
    // of a folder the system says that it is one
    if !found.is_file() && !found.is_dir() {
        return Err(io::Error::other("it is a pipe or a device, no file"));
    }
    if found.len() > LARGEST {
        return Err(io::Error::other("it is larger than 1 GiB"));
    }
    fs::read(path)
}

fn entries(folder: &Path, are_folders: bool) -> Vec<String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let wanted = entries.filter(|entry| entry.path().is_dir() == are_folders);
    let mut names: Vec<String> = wanted.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
