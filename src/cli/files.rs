//! Reading the input, and writing results whole or not at all.

use super::failure::Failure;
use super::interrupts;
use super::spared::{STANDARD_INPUT, Spared, behind_links, refuse_links};
use mechc_text::diag::{Code, Diagnostic};
use mechc_text::source::{FileId, Sources};
use mechc_text::world::{self, Contents, World};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The text of a file, or of standard input for `-`.
pub(super) fn read(name: &str, sources: &mut Sources) -> Result<FileId, Failure> {
    read_with_mark(name, sources).map(|(file, _)| file)
}

/// As [`read`], and whether the text begins with a byte-order mark.
pub(super) fn read_with_mark(name: &str, sources: &mut Sources) -> Result<(FileId, bool), Failure> {
    take_in_with_mark(name, given(Path::new(name)), sources)
}

/// The same of what can be written again in its place: of standard input for `-`, or of a file.
pub(super) fn read_to_replace(name: &str, sources: &mut Sources) -> Result<(FileId, bool), Failure> {
    let path = Path::new(name);
    take_in_with_mark(name, if name == "-" { given(path) } else { named(path) }, sources)
}

fn take_in_with_mark(name: &str, bytes: io::Result<Vec<u8>>, sources: &mut Sources) -> Result<(FileId, bool), Failure> {
    let shown = Disk.shown(Path::new(name));
    let bytes = bytes.map_err(|error| world::cannot_read(&shown, &error))?;
    let has_mark = bytes.starts_with("\u{feff}".as_bytes());
    world::take_in(&shown, &bytes, sources).map(|file| (file, has_mark)).map_err(Failure::from)
}

/// The bytes of what the user named: of standard input for `-`, of a file, a pipe or a device.
fn given(path: &Path) -> io::Result<Vec<u8>> {
    if path == Path::new("-") { up_to_the_largest(io::stdin().lock()) } else { up_to_the_largest(File::open(path)?) }
}

/// The bytes of what a text names: of a file, for what is none may have no end, or wait for somebody to write.
fn named(path: &Path) -> io::Result<Vec<u8>> {
    let found = fs::metadata(path)?;
    if found.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if !found.is_file() {
        return Err(io::Error::other("it is a pipe or a device, no file"));
    }
    up_to_the_largest(File::open(path)?)
}

/// All bytes that come, unless they are more than any text has.
fn up_to_the_largest(from: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(world::LARGEST as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > world::LARGEST { Err(world::too_large()) } else { Ok(bytes) }
}

/// The files of this machine.
pub(super) struct Disk;

impl World for Disk {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        Ok(Contents { bytes: named(path)?.into(), version: 0 })
    }

    fn given(&self, path: &Path) -> io::Result<Contents> {
        Ok(Contents { bytes: given(path)?.into(), version: 0 })
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
        path.canonicalize().unwrap_or_else(|_| world::normalised(path))
    }
}

/// A disk that is asked several times for what options name: standard input and pipes give what they hold only once.
#[derive(Default)]
pub(super) struct AskedOnce(Mutex<Vec<(PathBuf, Contents)>>);

impl World for AskedOnce {
    fn read(&self, path: &Path) -> io::Result<Contents> {
        Disk.read(path)
    }

    fn given(&self, path: &Path) -> io::Result<Contents> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, contents)) = known.iter().find(|(other, _)| other == path) {
            return Ok(contents.clone());
        }
        let contents = Disk.given(path)?;
        known.push((path.to_owned(), contents.clone()));
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

/// Where results go: standard output, or a file that is replaced whole at the end.
pub(super) enum Destination {
    Standard(io::Stdout),
    /// A device or a pipe, `/dev/null` say: written as it comes.
    Device(File),
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
    Output::write("-", text, &Spared::default())
}

impl Output {
    /// Opens it, unless it is one of the files that are to stay; a file's place is tried at once, so that no work is done for
    /// nothing.
    pub fn open(name: &str, spared: &Spared<'_>) -> Result<Output, Failure> {
        spared.refuse(name)?;
        let destination = Destination::of(name).map_err(|error| cannot_write(name, &error))?;
        let name = if name == "-" { "standard output" } else { name };
        Ok(Output { name: name.to_owned(), writer: BufWriter::with_capacity(1 << 16, destination) })
    }

    /// Writes a whole text.
    pub fn write(name: &str, text: &str, spared: &Spared<'_>) -> Result<(), Failure> {
        Output::open(name, spared)?.close_with_text(text)
    }

    /// Writes a whole text in the place of the one that was read there.
    pub fn replace(name: &str, text: &str) -> Result<(), Failure> {
        Output::replace_if(name, text, &|| true).map(|_| ())
    }

    /// The same if that is due when nothing is left but to put the file in its place; says whether it was.
    pub fn replace_if(name: &str, text: &str, is_due: &dyn Fn() -> bool) -> Result<bool, Failure> {
        let mut output = Output::open(name, &Spared::default())?;
        output.writer.write_all(text.as_bytes()).map_err(|error| output.failure(&error))?;
        let written = output.written()?;
        let is_due = is_due();
        if is_due {
            put_in_place(written)?;
        }
        Ok(is_due)
    }

    /// Whether it is standard output, and that a terminal.
    pub fn is_terminal(&self) -> bool {
        matches!(self.writer.get_ref(), Destination::Standard(out) if out.is_terminal())
    }

    /// Whether it is standard output.
    pub fn is_standard(&self) -> bool {
        matches!(self.writer.get_ref(), Destination::Standard(_))
    }

    pub fn writer(&mut self) -> &mut (impl Write + Send + use<>) {
        &mut self.writer
    }

    /// Why writing failed.
    pub fn failure(&self, error: &io::Error) -> Failure {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return Failure::ReaderGone;
        }
        cannot_write(&self.name, error).into()
    }

    /// Writes a whole text, and puts the file in its place.
    pub fn close_with_text(mut self, text: &str) -> Result<(), Failure> {
        self.writer.write_all(text.as_bytes()).map_err(|error| self.failure(&error))?;
        self.close()
    }

    /// Puts a file in its place.
    pub fn close(self) -> Result<(), Failure> {
        put_in_place(self.written()?)
    }

    /// Puts this one and another in their places, both or none.
    pub fn close_with(self, other: Option<Output>) -> Result<(), Failure> {
        let other = other.map(Output::written).transpose()?.flatten();
        put_in_place(self.written()?.into_iter().chain(other))
    }

    /// The file, if it is one, with all that was written.
    fn written(mut self) -> Result<Option<Written>, Failure> {
        if let Err(error) = self.writer.flush() {
            return Err(self.failure(&error));
        }
        let name = self.name.clone();
        match self.writer.into_inner() {
            Ok(Destination::File { temporary, path }) => Ok(Some(Written { name, temporary, path })),
            Ok(Destination::Standard(_) | Destination::Device(_)) => Ok(None),
            Err(error) => Err(cannot_write(&name, error.error()).into()),
        }
    }
}

/// A file that is whole, but not in its place yet.
struct Written {
    name: String,
    temporary: tempfile::NamedTempFile,
    path: PathBuf,
}

/// Puts all that a command writes in its place. No interruption comes between.
fn put_in_place(files: impl IntoIterator<Item = Written>) -> Result<(), Failure> {
    let mut unfinished = interrupts::unfinished();
    for Written { name, temporary, path } in files {
        temporary.persist(path).map_err(|error| cannot_write(&name, &error.error))?;
    }
    unfinished.clear();
    Ok(())
}

/// Writes files into a folder, which is made if it is not there: all of them or none. A file that is there already is replaced only
/// if it holds the mark.
pub(super) fn write_all<'f>(
    folder: &str,
    files: impl Iterator<Item = (&'f str, &'f str)>,
    mark: &str,
    spared: &Spared<'_>,
) -> Result<(), Failure> {
    let files: Vec<(PathBuf, &str)> = files.map(|(path, text)| (Path::new(folder).join(path), text)).collect();
    for (path, _) in &files {
        if path.symlink_metadata().is_ok() && !holds(path, mark) {
            let shown = path.to_string_lossy();
            return Err(Diagnostic::new(
                Code::E0702,
                format!("cannot write `{shown}`: a file is there that mechc did not write"),
            )
            .help("name a new folder, or one that this command wrote")
            .into());
        }
    }
    let result = written_beside(folder, &files, spared).and_then(put_in_place);
    if result.is_err() {
        interrupts::take_away(&mut interrupts::unfinished());
    }
    result
}

/// Writes files of a folder, which is made if it is not there, beside their places.
fn written_beside(folder: &str, files: &[(PathBuf, &str)], spared: &Spared<'_>) -> Result<Vec<Written>, Failure> {
    make_folder(Path::new(folder)).map_err(|error| cannot_write(folder, &error))?;
    let mut outputs: Vec<Written> = Vec::new();
    for (path, text) in files {
        let name = path.to_string_lossy();
        path.parent().map_or(Ok(()), make_folder).map_err(|error| cannot_write(&name, &error))?;
        let mut output = Output::open(&name, spared)?;
        output.writer.write_all(text.as_bytes()).map_err(|error| output.failure(&error))?;
        outputs.extend(output.written()?);
    }
    refuse_links(outputs.iter().map(|output| output.name.as_str().into()))?;
    Ok(outputs)
}

/// Removes what an earlier crate has left in a folder where this one was written: files in the given folders, with the given endings, that
/// hold the mark and are not among those written. What somebody wrote stays. Says what is gone.
pub(super) fn remove_left(
    folder: &str,
    places: &[(&str, &str)],
    written: &[&str],
    mark: &str,
) -> Result<Vec<String>, Failure> {
    let mut removed = Vec::new();
    for (inner, ending) in places {
        let place = Path::new(folder).join(inner);
        let is_left = |name: &String| name.ends_with(ending) && !written.contains(&format!("{inner}/{name}").as_str());
        for name in Disk.names_in(&place).into_iter().filter(is_left) {
            let path = place.join(name);
            // a link leads to what may be somebody's
            let is_file = path.symlink_metadata().is_ok_and(|found| found.is_file());
            if is_file && holds(&path, mark) {
                let shown = path.to_string_lossy().into_owned();
                fs::remove_file(&path).map_err(|error| cannot_remove(&shown, &error))?;
                removed.push(shown);
            }
        }
        // where nothing else is in it, it was made for them
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

/// Whether one of the first lines of a file holds the mark.
fn holds(path: &Path, mark: &str) -> bool {
    fs::read(path).is_ok_and(|bytes| String::from_utf8_lossy(&bytes).lines().take(HEAD).any(|line| line.contains(mark)))
}

/// Lines of a file that may hold the mark.
const HEAD: usize = 6;

/// Makes a folder, unless it is there.
pub(super) fn make_folder(path: &Path) -> io::Result<()> {
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

/// Whether a name means standard output.
pub(super) fn is_standard_output(name: &str) -> bool {
    ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"].contains(&name)
}

/// Whether a path means what the process has open, whatever that is: it is no place in a folder, where a file could be replaced.
fn is_open_already(path: &Path) -> bool {
    path == Path::new("/dev/stderr") || ["/dev/fd", "/proc/self/fd"].iter().any(|folder| path.starts_with(folder))
}

impl Destination {
    fn of(name: &str) -> io::Result<Destination> {
        let path = Path::new(name);
        if is_standard_output(name) {
            return Ok(Destination::Standard(io::stdout()));
        }
        // asked of the path itself: the links of what is open already lead nowhere
        let is_special = fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
        if is_special || is_open_already(path) {
            return OpenOptions::new().append(true).open(path).map(Destination::Device);
        }
        Destination::beside(path)
    }

    fn beside(path: &Path) -> io::Result<Destination> {
        let path = behind_links(path)?;
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
            // a new one is as files are made, and both less what the user's mask takes away: never open to more than the old one is
            let mode = fs::metadata(&path).map_or(0o666, |found| found.permissions().mode() & 0o777);
            builder.permissions(fs::Permissions::from_mode(mode));
        }
        let mut unfinished = interrupts::unfinished();
        let temporary = builder.tempfile_in(folder)?;
        unfinished.push(temporary.path().to_owned());
        #[cfg(unix)]
        keep_rights(&path, temporary.as_file())?;
        Ok(Destination::File { temporary, path })
    }
}

/// Gives a file that will be in the place of another one the owner and the group of that one, where this process may, and its mode.
#[cfg(unix)]
fn keep_rights(of: &Path, to: &File) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let (Ok(old), new) = (fs::metadata(of), to.metadata()?) else { return Ok(()) };
    let has_group = old.gid() == new.gid() || fchown(to, None, Some(old.gid())).is_ok();
    let has_owner = old.uid() == new.uid() || fchown(to, Some(old.uid()), None).is_ok();
    // who runs it as its owner or in its group is somebody else, where those are others
    let kept = if has_owner && has_group { 0o7777 } else { 0o777 };
    let [mode, made] = [old.permissions().mode() & kept, to.metadata()?.permissions().mode() & 0o7777];
    // what the user's mask took is given back; a disk that has one mode for all files has nothing to give
    if mode == made { Ok(()) } else { to.set_permissions(fs::Permissions::from_mode(mode)) }
}
