//! Reads inputs, and writes outputs whole or not at all.

use super::failure::Failure;
use super::interrupts;
use super::protected_paths::{ProtectedPaths, STANDARD_INPUT, refuse_links, resolve_links};
use mechc_text::diag::{Code, Diagnostic};
use mechc_text::source::{FileId, Sources};
use mechc_text::world::{self, Contents, World};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Reads the text of a file, or of standard input for `-`.
pub(super) fn read(name: &str, sources: &mut Sources) -> Result<FileId, Failure> {
    read_with_mark(name, sources).map(|(file, _)| file)
}

/// Reads a text like [`read`], and returns whether it begins with a byte-order mark.
pub(super) fn read_with_mark(name: &str, sources: &mut Sources) -> Result<(FileId, bool), Failure> {
    add_source(name, read_any(Path::new(name)), sources)
}

/// Reads a text that can be replaced: standard input for `-`, or a regular file.
pub(super) fn read_to_replace(name: &str, sources: &mut Sources) -> Result<(FileId, bool), Failure> {
    let path = Path::new(name);
    add_source(name, if name == "-" { read_any(path) } else { read_regular_file(path) }, sources)
}

fn add_source(name: &str, bytes: io::Result<Vec<u8>>, sources: &mut Sources) -> Result<(FileId, bool), Failure> {
    let shown = Disk.shown(Path::new(name));
    let bytes = bytes.map_err(|error| world::cannot_read(&shown, &error))?;
    let has_mark = bytes.starts_with("\u{feff}".as_bytes());
    world::take_in(&shown, &bytes, sources).map(|file| (file, has_mark)).map_err(Failure::from)
}

/// Reads the bytes of an argument of the user: standard input for `-`, a file, a pipe or a device.
fn read_any(path: &Path) -> io::Result<Vec<u8>> {
    if path == Path::new("-") { read_limited(io::stdin().lock()) } else { read_limited(File::open(path)?) }
}

/// Reads the bytes of a file that a text names. A pipe or device is refused, since reading it may never end.
fn read_regular_file(path: &Path) -> io::Result<Vec<u8>> {
    let found = fs::metadata(path)?;
    if found.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if !found.is_file() {
        return Err(io::Error::other("it is a pipe or a device, no file"));
    }
    read_limited(File::open(path)?)
}

/// Reads all bytes, up to the maximum size of a text.
fn read_limited(from: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(world::LARGEST as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > world::LARGEST { Err(world::too_large()) } else { Ok(bytes) }
}

/// The files of this machine.
pub(super) struct Disk;

impl World for Disk {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        Ok(Contents { bytes: read_regular_file(path)?.into(), version: 0 })
    }

    fn given(&self, path: &Path) -> io::Result<Contents> {
        Ok(Contents { bytes: read_any(path)?.into(), version: 0 })
    }

    fn shown(&self, path: &Path) -> String {
        if path == Path::new("-") { STANDARD_INPUT.to_owned() } else { path.to_string_lossy().into_owned() }
    }

    fn names_in(&self, folder: &Path) -> Vec<String> {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let files = entries.filter(|entry| !entry.path().is_dir());
        let mut names: Vec<String> = files.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    fn folders_in(&self, folder: &Path) -> Vec<String> {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let folders = entries.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()));
        let mut names: Vec<String> = folders.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    fn identity(&self, path: &Path) -> PathBuf {
        path.canonicalize().unwrap_or_else(|_| world::normalize_path(path))
    }
}

/// The files of this machine, with a cache for the files that options name: standard input and pipes can be read only once.
#[derive(Default)]
pub(super) struct CachedDisk(Mutex<Vec<(PathBuf, Contents)>>);

impl World for CachedDisk {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        Disk.read(path)
    }

    fn given(&self, path: &Path) -> io::Result<Contents> {
        let mut cache = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, contents)) = cache.iter().find(|(other, _)| other == path) {
            return Ok(contents.clone());
        }
        let contents = Disk.given(path)?;
        cache.push((path.to_owned(), contents.clone()));
        Ok(contents)
    }

    fn shown(&self, path: &Path) -> String {
        Disk.shown(path)
    }

    fn names_in(&self, folder: &Path) -> Vec<String> {
        Disk.names_in(folder)
    }

    fn folders_in(&self, folder: &Path) -> Vec<String> {
        Disk.folders_in(folder)
    }

    fn identity(&self, path: &Path) -> PathBuf {
        Disk.identity(path)
    }
}

pub(super) fn cannot_write(name: &str, error: &io::Error) -> Diagnostic {
    Diagnostic::new(Code::E0702, format!("cannot write `{name}`: {}", world::reason(error)))
}

/// The destination of an output.
pub(super) enum Destination {
    Standard(io::Stdout),
    /// A device or a pipe, such as `/dev/null`, written directly.
    Device(File),
    /// A file, written to a temporary one that replaces it at the end.
    File {
        temporary: tempfile::NamedTempFile,
        path: PathBuf,
    },
}

/// An open [`Destination`] with its name for messages.
pub(super) struct Output {
    name: String,
    writer: BufWriter<Destination>,
}

impl Write for Destination {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Destination::Standard(out) => out.write(bytes),
            Destination::Device(file) => file.write(bytes),
            Destination::File { temporary, .. } => temporary.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Destination::Standard(out) => out.flush(),
            Destination::Device(file) => file.flush(),
            Destination::File { temporary, .. } => temporary.flush(),
        }
    }
}

/// Prints a text to standard output.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    Output::write("-", text, &ProtectedPaths::default())
}

impl Output {
    /// Opens an output, unless it is a protected file. A file is created at once, so that errors appear before the work begins.
    pub fn open(name: &str, protected: &ProtectedPaths<'_>) -> Result<Output, Failure> {
        protected.refuse(name)?;
        let destination = Destination::open(name).map_err(|error| cannot_write(name, &error))?;
        let name = if name == "-" { "standard output" } else { name };
        Ok(Output { name: name.to_owned(), writer: BufWriter::with_capacity(1 << 16, destination) })
    }

    /// Writes a whole text.
    pub fn write(name: &str, text: &str, protected: &ProtectedPaths<'_>) -> Result<(), Failure> {
        Output::open(name, protected)?.close_with_text(text)
    }

    /// Replaces the text of a file that was read.
    pub fn replace(name: &str, text: &str) -> Result<(), Failure> {
        Output::replace_if(name, text, &|| true).map(|_| ())
    }

    /// Replaces the text of a file if `is_due` still holds immediately before; returns whether it did.
    pub fn replace_if(name: &str, text: &str, is_due: &dyn Fn() -> bool) -> Result<bool, Failure> {
        let mut output = Output::open(name, &ProtectedPaths::default())?;
        output.writer.write_all(text.as_bytes()).map_err(|error| output.failure(&error))?;
        let pending = output.into_pending()?;
        let is_due = is_due();
        if is_due {
            commit(pending)?;
        }
        Ok(is_due)
    }

    /// Returns whether it is a terminal.
    pub fn is_terminal(&self) -> bool {
        matches!(self.writer.get_ref(), Destination::Standard(out) if out.is_terminal())
    }

    /// Returns whether it is standard output.
    pub fn is_standard(&self) -> bool {
        matches!(self.writer.get_ref(), Destination::Standard(_))
    }

    pub fn writer(&mut self) -> &mut (impl Write + Send + use<>) {
        &mut self.writer
    }

    /// Converts an error of writing.
    pub fn failure(&self, error: &io::Error) -> Failure {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return Failure::ReaderClosed;
        }
        cannot_write(&self.name, error).into()
    }

    /// Writes a whole text and closes the output.
    pub fn close_with_text(mut self, text: &str) -> Result<(), Failure> {
        self.writer.write_all(text.as_bytes()).map_err(|error| self.failure(&error))?;
        self.close()
    }

    /// Moves the file to its path.
    pub fn close(self) -> Result<(), Failure> {
        commit(self.into_pending()?)
    }

    /// Moves this file and another one to their paths, after both are written completely.
    pub fn close_with(self, other: Option<Output>) -> Result<(), Failure> {
        let other = other.map(Output::into_pending).transpose()?.flatten();
        commit(self.into_pending()?.into_iter().chain(other))
    }

    /// Completes writing; returns the temporary file, if the output is a file.
    fn into_pending(mut self) -> Result<Option<PendingFile>, Failure> {
        if let Err(error) = self.writer.flush() {
            return Err(self.failure(&error));
        }
        let name = self.name.clone();
        match self.writer.into_inner() {
            Ok(Destination::File { temporary, path }) => Ok(Some(PendingFile { name, temporary, path })),
            Ok(Destination::Standard(_) | Destination::Device(_)) => Ok(None),
            Err(error) => Err(cannot_write(&name, error.error()).into()),
        }
    }
}

/// A completely written temporary file, and the path that it is for.
struct PendingFile {
    name: String,
    temporary: tempfile::NamedTempFile,
    path: PathBuf,
}

/// Moves temporary files to their paths. No interruption is handled meanwhile.
fn commit(files: impl IntoIterator<Item = PendingFile>) -> Result<(), Failure> {
    let mut unfinished = interrupts::unfinished();
    for PendingFile { name, temporary, path } in files {
        temporary.persist(path).map_err(|error| cannot_write(&name, &error.error))?;
    }
    unfinished.clear();
    Ok(())
}

/// Writes files into a folder, which is created if necessary: all of them or none. An existing file is replaced only if it has the mark.
pub(super) fn write_all<'f>(
    folder: &str,
    files: impl Iterator<Item = (&'f str, &'f str)>,
    mark: &str,
    protected: &ProtectedPaths<'_>,
) -> Result<(), Failure> {
    let files: Vec<(PathBuf, &str)> = files.map(|(path, text)| (Path::new(folder).join(path), text)).collect();
    for (path, _) in &files {
        if path.symlink_metadata().is_ok() && !has_mark(path, mark) {
            let shown = path.to_string_lossy();
            return Err(Diagnostic::new(
                Code::E0702,
                format!("cannot write `{shown}`: a file is there that mechc did not write"),
            )
            .help("name a new folder, or one that this command wrote")
            .into());
        }
    }
    let result = write_temporaries(folder, &files, protected).and_then(commit);
    if result.is_err() {
        interrupts::remove(&mut interrupts::unfinished());
    }
    result
}

/// Writes temporary files into a folder, which is created if necessary.
fn write_temporaries(
    folder: &str,
    files: &[(PathBuf, &str)],
    protected: &ProtectedPaths<'_>,
) -> Result<Vec<PendingFile>, Failure> {
    create_folder(Path::new(folder)).map_err(|error| cannot_write(folder, &error))?;
    let mut outputs: Vec<PendingFile> = Vec::new();
    for (path, text) in files {
        let name = path.to_string_lossy();
        path.parent().map_or(Ok(()), create_folder).map_err(|error| cannot_write(&name, &error))?;
        let mut output = Output::open(&name, protected)?;
        output.writer.write_all(text.as_bytes()).map_err(|error| output.failure(&error))?;
        outputs.extend(output.into_pending()?);
    }
    refuse_links(outputs.iter().map(|output| output.name.as_str().into()))?;
    Ok(outputs)
}

/// Removes files of an earlier emitted crate: those in given folders with given endings that have the mark and are not among the files
/// written. The user's files stay. Returns the removed files.
pub(super) fn remove_stale(
    folder: &str,
    places: &[(&str, &str)],
    written: &[&str],
    mark: &str,
) -> Result<Vec<String>, Failure> {
    let mut removed = Vec::new();
    for (inner, ending) in places {
        let place = Path::new(folder).join(inner);
        let is_stale = |name: &String| name.ends_with(ending) && !written.contains(&format!("{inner}/{name}").as_str());
        for name in Disk.names_in(&place).into_iter().filter(is_stale) {
            let path = place.join(name);
            // the target of a link may be a user's file
            let is_file = path.symlink_metadata().is_ok_and(|found| found.is_file());
            if is_file && has_mark(&path, mark) {
                let shown = path.to_string_lossy().into_owned();
                fs::remove_file(&path).map_err(|error| cannot_remove(&shown, &error))?;
                removed.push(shown);
            }
        }
        // this removes the folder only if it is empty
        if !removed.is_empty() {
            let _ = fs::remove_dir(&place);
        }
    }
    Ok(removed)
}

fn cannot_remove(name: &str, error: &io::Error) -> Diagnostic {
    Diagnostic::new(Code::E0702, format!("cannot remove `{name}`: {}", world::reason(error)))
        .help("an earlier crate has left it: remove it by hand")
}

/// Returns whether one of the first lines of a file contains the mark.
fn has_mark(path: &Path, mark: &str) -> bool {
    fs::read(path)
        .is_ok_and(|bytes| String::from_utf8_lossy(&bytes).lines().take(MARK_LINES).any(|line| line.contains(mark)))
}

/// The number of lines that may contain the mark.
const MARK_LINES: usize = 6;

/// Creates a folder unless it exists.
pub(super) fn create_folder(path: &Path) -> io::Result<()> {
    match path.metadata() {
        Ok(found) if found.is_dir() => return Ok(()),
        Ok(_) => return Err(io::Error::other("it is a file")),
        Err(_) => {}
    }
    let mut unfinished = interrupts::unfinished();
    fs::create_dir(path).map_err(|error| match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() && !parent.is_dir() => {
            io::Error::other(format!("there is no folder `{}`", parent.display()))
        }
        _ => error,
    })?;
    unfinished.push(path.to_owned());
    Ok(())
}

/// Returns whether a name stands for standard output.
pub(super) fn is_standard_output(name: &str) -> bool {
    ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"].contains(&name)
}

/// Returns whether a path stands for an open file of the process, which has no folder in which it could be replaced.
fn is_open_descriptor(path: &Path) -> bool {
    path == Path::new("/dev/stderr") || ["/dev/fd", "/proc/self/fd"].iter().any(|folder| path.starts_with(folder))
}

impl Destination {
    fn open(name: &str) -> io::Result<Destination> {
        let path = Path::new(name);
        if is_standard_output(name) {
            return Ok(Destination::Standard(io::stdout()));
        }
        // the links of open descriptors cannot be resolved, so the path itself is examined
        let is_special = fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
        if is_special || is_open_descriptor(path) {
            return OpenOptions::new().append(true).open(path).map(Destination::Device);
        }
        Destination::temporary_for(path)
    }

    fn temporary_for(path: &Path) -> io::Result<Destination> {
        let path = resolve_links(path)?;
        if let Ok(found) = fs::metadata(&path) {
            if found.is_dir() {
                return Err(io::Error::other("it is a folder"));
            }
            if found.permissions().readonly() {
                return Err(io::ErrorKind::PermissionDenied.into());
            }
        }
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        if !folder.is_dir() {
            return Err(io::Error::other(format!("there is no folder `{}`", folder.display())));
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(".mechc-");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // a temporary file never has more permissions than the file that it replaces, and the user's mask applies
            let mode = fs::metadata(&path).map_or(0o666, |found| found.permissions().mode() & 0o777);
            builder.permissions(fs::Permissions::from_mode(mode));
        }
        let mut unfinished = interrupts::unfinished();
        let temporary = builder.tempfile_in(folder)?;
        unfinished.push(temporary.path().to_owned());
        #[cfg(unix)]
        copy_permissions(&path, temporary.as_file())?;
        Ok(Destination::File { temporary, path })
    }
}

/// Gives a file the mode of the file that it replaces, and its owner and group if this process may.
#[cfg(unix)]
fn copy_permissions(of: &Path, to: &File) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let (Ok(old), new) = (fs::metadata(of), to.metadata()?) else { return Ok(()) };
    let has_group = old.gid() == new.gid() || fchown(to, None, Some(old.gid())).is_ok();
    let has_owner = old.uid() == new.uid() || fchown(to, Some(old.uid()), None).is_ok();
    // set-user-id and set-group-id bits must not apply to another owner or group
    let kept = if has_owner && has_group { 0o7777 } else { 0o777 };
    let [mode, made] = [old.permissions().mode() & kept, to.metadata()?.permissions().mode() & 0o7777];
    // the mask may have removed bits; on a file system with one mode for all files nothing changes
    if mode == made { Ok(()) } else { to.set_permissions(fs::Permissions::from_mode(mode)) }
}
