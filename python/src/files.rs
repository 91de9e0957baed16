//! The files that a mechanism reads: those of this machine, and those that were handed over; each is remembered, so that a mechanism
//! can be packed with all that it was made of.

use mechc::{Contents, World};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::{fs, io};

/// No text is larger (bytes), as the command has it.
const LARGEST: u64 = 1 << 30;

/// What options list, under names that no file has.
const LISTED: &str = "<listed ";

/// The files of a mechanism.
pub struct Files {
    known: Mutex<BTreeMap<PathBuf, Arc<[u8]>>>,
    /// Whether what a text names may be read from the disk.
    from_disk: bool,
}

impl Files {
    /// Some that are known; others are read from the disk, if they may be.
    pub fn new(known: BTreeMap<PathBuf, Vec<u8>>, from_disk: bool) -> Files {
        let known = known.into_iter().map(|(path, bytes)| (path, Arc::from(bytes))).collect();
        Files { known: Mutex::new(known), from_disk }
    }

    /// All that are known by now.
    pub fn known(&self) -> BTreeMap<PathBuf, Arc<[u8]>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn find(&self, path: &Path) -> Option<Arc<[u8]>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner).get(path).cloned()
    }
}

impl World for Files {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        let bytes = match self.find(path) {
            Some(bytes) => bytes,
            None if self.from_disk => {
                let bytes: Arc<[u8]> = named(path)?.into();
                let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
                known.insert(path.to_owned(), Arc::clone(&bytes));
                bytes
            }
            None => return Err(io::ErrorKind::NotFound.into()),
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
    lists: Vec<Vec<u8>>,
}

impl<'f> WithLists<'f> {
    /// Tables, as the bytes of CSV files.
    pub fn new(files: &'f Files, lists: Vec<Vec<u8>>) -> WithLists<'f> {
        WithLists { files, lists }
    }

    /// What names a table to an option.
    pub fn name(number: usize) -> String {
        format!("{LISTED}{number}>")
    }
}

impl World for WithLists<'_> {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        self.files.read(path)
    }

    fn given(&self, path: &Path) -> io::Result<Contents> {
        let number = path.to_str().and_then(|path| path.strip_prefix(LISTED)?.strip_suffix('>')?.parse::<usize>().ok());
        match number.and_then(|number| self.lists.get(number)) {
            Some(bytes) => Ok(Contents { bytes: bytes.as_slice().into(), version: 0 }),
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
