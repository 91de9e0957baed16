//! The files that a mechanism reads, from the disk or given by the caller. Their contents are kept, so that a pickled mechanism is complete.

use mechc::{Contents, World};
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::{fs, io};

/// Largest size of a file (bytes), as in the command.
pub const LARGEST: u64 = 1 << 30;

/// Largest number of files that the message of a missing one names.
const MOST_NAMED: usize = 8;

/// The files of a mechanism.
pub struct Files {
    contents: Mutex<BTreeMap<PathBuf, Arc<[u8]>>>,
    /// True if files that a text names may be read from the disk.
    from_disk: bool,
}

impl Files {
    /// Creates a set of files with given contents; others are read from the disk if `from_disk` is true.
    pub fn new(contents: BTreeMap<PathBuf, Vec<u8>>, from_disk: bool) -> Files {
        let contents = contents.into_iter().map(|(path, bytes)| (without_dots(&path), Arc::from(bytes))).collect();
        Files { contents: Mutex::new(contents), from_disk }
    }

    /// Returns all files that were given or read so far.
    pub fn contents(&self) -> BTreeMap<PathBuf, Arc<[u8]>> {
        self.contents.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn find(&self, path: &Path) -> Option<Arc<[u8]>> {
        self.contents.lock().unwrap_or_else(PoisonError::into_inner).get(&without_dots(path)).cloned()
    }

    /// Returns the error for a file that was not given.
    fn missing(&self) -> io::Error {
        let contents = self.contents();
        let mut names: Vec<String> =
            contents.keys().take(MOST_NAMED).map(|path| format!("`{}`", path.display())).collect();
        if contents.len() > MOST_NAMED {
            names.push("…".to_owned());
        }
        let message = if names.is_empty() {
            "`files` has none: give its text there".to_owned()
        } else {
            format!("`files` has {} alone", names.join(", "))
        };
        io::Error::new(io::ErrorKind::NotFound, message)
    }
}

impl World for Files {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        let bytes = match self.find(path) {
            Some(bytes) => bytes,
            None if self.from_disk => {
                let bytes: Arc<[u8]> = read_regular(path)?.into();
                let mut contents = self.contents.lock().unwrap_or_else(PoisonError::into_inner);
                contents.insert(without_dots(path), Arc::clone(&bytes));
                bytes
            }
            None => return Err(self.missing()),
        };
        Ok(Contents { bytes, version: 0 })
    }

    // the file of an option is read anew each time
    fn given(&self, path: &Path) -> io::Result<Contents> {
        let bytes = match self.find(path) {
            Some(bytes) => bytes,
            None => read_regular(path)?.into(),
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

/// The files of a mechanism, with tables that the caller of a sweep gives.
pub struct FilesWithTables<'f> {
    files: &'f Files,
    tables: Vec<(PathBuf, Vec<u8>)>,
}

impl<'f> FilesWithTables<'f> {
    /// Adds tables, as bytes of CSV files, by the names that options refer to.
    pub fn new(files: &'f Files, tables: Vec<(PathBuf, Vec<u8>)>) -> FilesWithTables<'f> {
        FilesWithTables { files, tables }
    }
}

impl World for FilesWithTables<'_> {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        self.files.read(path)
    }

    fn given(&self, path: &Path) -> io::Result<Contents> {
        match self.tables.iter().find(|(name, _)| name == path) {
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

/// Returns a path without `.` components.
fn without_dots(path: &Path) -> PathBuf {
    path.components().filter(|part| !matches!(part, Component::CurDir)).collect()
}

/// Reads a regular file; a pipe or device is refused, as reading it may not end.
fn read_regular(path: &Path) -> io::Result<Vec<u8>> {
    let found = fs::metadata(path)?;
    // reading a folder gives the system's own error
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
