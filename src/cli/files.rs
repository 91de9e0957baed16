//! Reading the input, and writing results whole or not at all.

use super::failure::Failure;
use crate::diag::{Code, Diagnostic};
use crate::source::{FileId, Sources, Span};
use std::fs::{self, File};
use std::io::{self, BufWriter, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};

/// The text of a file, or of standard input for `-`.
pub(super) fn read(name: &str, sources: &mut Sources) -> Result<FileId, Failure> {
    read_with_mark(name, sources).map(|(file, _)| file)
}

/// As [`read`], and whether the text begins with a byte-order mark.
pub(super) fn read_with_mark(name: &str, sources: &mut Sources) -> Result<(FileId, bool), Failure> {
    let (shown, bytes) = if name == "-" {
        let mut bytes = Vec::new();
        ("<stdin>", io::stdin().lock().read_to_end(&mut bytes).map(|_| bytes))
    } else {
        (name, fs::read(name))
    };
    let bytes = bytes.map_err(|error| cannot_read(shown, &error))?;
    let has_mark = bytes.starts_with("\u{feff}".as_bytes());
    text_of(shown, bytes, sources).map(|file| (file, has_mark)).map_err(Failure::from)
}

fn text_of(shown: &str, bytes: Vec<u8>, sources: &mut Sources) -> Result<FileId, Box<Diagnostic>> {
    if bytes.len() > u32::MAX as usize {
        return Err(Box::new(cannot_read(shown, &io::Error::other("it is larger than 4 GB"))));
    }
    String::from_utf8(bytes).map(|text| sources.add(shown, text)).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Box::new(not_utf8(shown, error.as_bytes(), at, sources))
    })
}

/// The text of a file that a table names, beside the file that names it or in the current folder.
pub(super) fn read_table(name: &str, beside: &str, sources: &mut Sources) -> Result<FileId, Box<Diagnostic>> {
    let path = match Path::new(beside).parent() {
        Some(folder) if beside != "-" => folder.join(name),
        _ => PathBuf::from(name),
    };
    let shown = path.to_string_lossy().into_owned();
    let bytes = fs::read(&path).map_err(|error| Box::new(cannot_read(&shown, &error)))?;
    text_of(&shown, bytes, sources)
}

fn cannot_read(name: &str, error: &io::Error) -> Diagnostic {
    Diagnostic::new(Code::E0701, format!("cannot read `{name}`: {}", reason(error)))
}

fn cannot_write(name: &str, error: &io::Error) -> Diagnostic {
    Diagnostic::new(Code::E0702, format!("cannot write `{name}`: {}", reason(error)))
}

/// The system's words, without its number.
fn reason(error: &io::Error) -> String {
    let text = error.to_string();
    let text = text.split(" (os error").next().unwrap_or(&text);
    let mut chars = text.chars();
    chars.next().map_or(String::new(), |first| first.to_lowercase().chain(chars).collect())
}

/// Shows the text up to the byte that is not UTF-8.
fn not_utf8(name: &str, bytes: &[u8], at: usize, sources: &mut Sources) -> Diagnostic {
    let valid = String::from_utf8_lossy(&bytes[..at]).into_owned();
    let file = sources.add(name, valid);
    let end = sources.get(file).text.len() as u32;
    let span = Span { file, start: end, end };
    let byte = bytes.get(at).copied().unwrap_or_default();
    Diagnostic::new(Code::E0102, format!("`{name}` is not UTF-8"))
        .at(span, format!("the byte {byte:#04x} follows here"))
        .help("save the file as UTF-8 in your editor")
}

/// Where results go: standard output, or a file that is replaced whole at the end.
pub(super) enum Destination {
    Standard(io::Stdout),
    /// Something that is no file, `/dev/null` say: written as it comes.
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

impl Output {
    /// Opens it; a file's place is tried at once, so that no work is done for nothing.
    pub fn open(name: &str) -> Result<Output, Failure> {
        let destination =
            if name == "-" { Ok(Destination::Standard(io::stdout())) } else { Destination::beside(Path::new(name)) };
        let destination = destination.map_err(|error| cannot_write(name, &error))?;
        let name = if name == "-" { "standard output" } else { name };
        Ok(Output { name: name.to_owned(), writer: BufWriter::with_capacity(1 << 16, destination) })
    }

    /// Writes a whole text.
    pub fn write(name: &str, text: &str) -> Result<(), Failure> {
        let mut output = Output::open(name)?;
        if let Err(error) = output.writer.write_all(text.as_bytes()) {
            return Err(output.failure(&error));
        }
        output.close()
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

    /// Puts a file in its place.
    pub fn close(mut self) -> Result<(), Failure> {
        if let Err(error) = self.writer.flush() {
            return Err(self.failure(&error));
        }
        let name = self.name.clone();
        match self.writer.into_inner() {
            Ok(Destination::File { temporary, path }) => {
                temporary.persist(path).map(|_| ()).map_err(|error| cannot_write(&name, &error.error).into())
            }
            Ok(Destination::Standard(_) | Destination::Device(_)) => Ok(()),
            Err(error) => Err(cannot_write(&name, error.error()).into()),
        }
    }
}

/// Writes files into a folder, which is made if it is not there: all of them or none. A file that is there already is replaced only
/// if it holds the mark.
pub(super) fn write_all<'f>(
    folder: &str,
    files: impl Iterator<Item = (&'f str, &'f str)>,
    mark: &str,
) -> Result<(), Failure> {
    let files: Vec<(PathBuf, &str)> = files.map(|(path, text)| (Path::new(folder).join(path), text)).collect();
    for (path, _) in &files {
        let is_ours =
            |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).lines().take(HEAD).any(|line| line.contains(mark));
        if path.symlink_metadata().is_ok() && !fs::read(path).is_ok_and(is_ours) {
            let shown = path.to_string_lossy();
            return Err(Diagnostic::new(
                Code::E0702,
                format!("cannot write `{shown}`: a file is there that mechc did not write"),
            )
            .help("name a new folder, or one that this command wrote")
            .into());
        }
    }
    make_folder(Path::new(folder)).map_err(|error| cannot_write(folder, &error))?;
    let mut outputs = Vec::new();
    for (path, text) in &files {
        let name = path.to_string_lossy();
        path.parent().map_or(Ok(()), make_folder).map_err(|error| cannot_write(&name, &error))?;
        let mut output = Output::open(&name)?;
        output.writer.write_all(text.as_bytes()).map_err(|error| output.failure(&error))?;
        outputs.push(output);
    }
    outputs.into_iter().try_for_each(Output::close)
}

/// Lines of a file that may hold the mark.
const HEAD: usize = 6;

/// Makes a folder, unless it is there.
fn make_folder(path: &Path) -> io::Result<()> {
    match path.metadata() {
        Ok(found) if found.is_dir() => return Ok(()),
        Ok(_) => return Err(io::Error::other("it is a file")),
        Err(_) => {}
    }
    fs::create_dir(path).map_err(|error| match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() && !parent.is_dir() => {
            io::Error::other(format!("there is no folder `{}`", parent.display()))
        }
        _ => error,
    })
}

impl Destination {
    fn beside(path: &Path) -> io::Result<Destination> {
        let path = behind_links(path)?;
        if let Ok(found) = fs::metadata(&path) {
            if found.is_dir() {
                return Err(io::Error::other("it is a folder"));
            }
            if !found.is_file() {
                return File::create(&path).map(Destination::Device);
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
        #[cfg(unix)]
        let mode = {
            use std::os::unix::fs::PermissionsExt;
            // as the file has it; a new one as files are made, less what the user's mask takes away
            fs::metadata(&path).map_or(0o666, |found| found.permissions().mode() & 0o777)
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".mechc-");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(fs::Permissions::from_mode(mode));
        }
        let temporary = builder.tempfile_in(folder)?;
        Ok(Destination::File { temporary, path })
    }
}

/// The file that a chain of links ends at: a link stays a link, what it points to is replaced.
fn behind_links(path: &Path) -> io::Result<PathBuf> {
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
