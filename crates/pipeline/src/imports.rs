//! Files that a text imports by `use`: each is read once, however many files use it and by whichever path.

use crate::Parsed;
use mechc_lang::check::{self, Library, LibraryFile};
use mechc_syntax::{self as syntax, ast};
use mechc_text::diag::{Applicability, Code, Diagnostic, Diagnostics, Fix, nearest};
use mechc_text::source::Sources;
use mechc_text::world::{self, World};
use rustc_hash::FxHashMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A text with the files that it uses.
pub(crate) struct Imports {
    /// The texts of all files.
    pub sources: Sources,
    pub library: Library,
    /// Errors in these files, and in how they use each other.
    pub diagnostics: Diagnostics,
}

/// Reads all files that a text uses, directly or through others.
pub(crate) fn read(parsed: &Parsed, world: &dyn World) -> Imports {
    let root =
        LibraryFile { id: parsed.file(), path: parsed.path().to_owned(), read: parsed.shared(), uses: Vec::new() };
    let mut reading = ImportReader {
        world,
        sources: parsed.sources().clone(),
        indices: FxHashMap::from_iter([(world.identity(&root.path), Ok(0))]),
        files: vec![root],
        diagnostics: Diagnostics::default(),
    };
    let mut at = 0;
    while at < reading.files.len() {
        reading.read_uses(at);
        at += 1;
    }
    let ImportReader { sources, files, mut diagnostics, .. } = reading;
    let library = Library::new(files);
    diagnostics.extend(library.faults(&sources));
    Imports { sources, library, diagnostics }
}

impl Parsed {
    /// Returns the paths of all files that its text names, directly or through others: `use`d texts, and tables. A file that cannot be read is
    /// included.
    #[must_use]
    pub fn named_files(&self, world: &dyn World) -> Vec<PathBuf> {
        named_files(&read(self, world).library)
    }
}

/// Returns the paths of all files that the texts of a library name: `use`d texts, and tables of all mechanisms.
pub(crate) fn named_files(library: &Library) -> Vec<PathBuf> {
    let paths = |file: &LibraryFile| {
        let user = file.path.to_string_lossy().into_owned();
        names_of_files(&file.read.tree).map(|name| world::beside(&user, &name.text)).collect::<Vec<_>>()
    };
    library.files().iter().flat_map(paths).collect()
}

/// Returns the paths as a text writes them.
fn names_of_files(tree: &ast::File) -> impl Iterator<Item = &ast::Name> {
    let tables = tree.mechanisms.iter().flat_map(|mechanism| &mechanism.items).filter_map(|item| match &item.kind {
        ast::ItemKind::Table { rows: ast::TableRows::File { path, .. }, .. } => Some(path),
        _ => None,
    });
    tree.uses.iter().filter_map(|used| used.path.as_ref()).chain(tables)
}

struct ImportReader<'w> {
    world: &'w dyn World,
    sources: Sources,
    /// For the identity of each file, its index in `files`, or why it cannot be read.
    indices: FxHashMap<PathBuf, Result<usize, Box<Diagnostic>>>,
    files: Vec<LibraryFile>,
    diagnostics: Diagnostics,
}

impl ImportReader<'_> {
    fn read_uses(&mut self, at: usize) {
        let read = Arc::clone(&self.files[at].read);
        let user = self.files[at].path.to_string_lossy().into_owned();
        let index = |used: &ast::UsedFile| used.path.as_ref().and_then(|path| self.file_index(&user, path));
        self.files[at].uses = read.tree.uses.iter().map(index).collect::<Vec<_>>();
    }

    /// Returns the index of the file that a text names, and reads it if it is new; `None`, with a diagnostic, if it cannot be read.
    fn file_index(&mut self, user: &str, named: &ast::Name) -> Option<usize> {
        let path = world::normalize_path(&world::beside(user, &named.text));
        // a path back to the current folder normalises to nothing, and is valid
        let path = if path.as_os_str().is_empty() && !named.text.is_empty() { PathBuf::from(".") } else { path };
        let identity = self.world.identity(&path);
        if !self.indices.contains_key(&identity) {
            let index = self.read_file(&path);
            self.indices.insert(identity.clone(), index);
        }
        match self.indices.get(&identity)? {
            Ok(index) => Some(*index),
            Err(why) => {
                self.diagnostics.push(at_use(why, named, &path, self.world));
                None
            }
        }
    }

    fn read_file(&mut self, path: &Path) -> Result<usize, Box<Diagnostic>> {
        let id = world::text_of(self.world, path, &mut self.sources)?;
        let read = Arc::new(syntax::parse(&self.sources, id));
        let holds_nothing = read.tree.mechanisms.is_empty() && read.tree.uses.is_empty();
        if holds_nothing && !read.faults.is_empty() {
            // it may be a file of any kind, whose syntax errors would be noise
            return Err(Box::new(no_mechanisms(&self.world.shown(path))));
        }
        self.diagnostics.extend(read.faults.clone());
        self.diagnostics.extend(check::check_file(&read.tree));
        self.files.push(LibraryFile { id, path: path.to_owned(), read, uses: Vec::new() });
        Ok(self.files.len() - 1)
    }
}

/// Reports a file that can be read and has neither mechanisms nor `use` lines.
fn no_mechanisms(shown: &str) -> Diagnostic {
    Diagnostic::new(Code::E0101, format!("`{shown}` holds no mechanism")).help(format!(
        "a file that is used begins with `use` or `mechanism`: `mechc check {shown}` says where it does not"
    ))
}

/// Adds the place that names a file to the error why it cannot be read.
pub(crate) fn at_use(why: &Diagnostic, named: &ast::Name, path: &Path, world: &dyn World) -> Diagnostic {
    if !why.labels.is_empty() {
        return why.clone().also(named.span, "used here");
    }
    let diagnostic = why.clone().at(named.span, "used here");
    match nearest_file(path, world).filter(|_| why.code == Code::E0701) {
        None => diagnostic,
        Some(name) => {
            let folder = named.text.rfind('/').map_or("", |end| &named.text[..=end]);
            let path = format!("\"{folder}{name}\"");
            let message = format!("was `{folder}{name}` meant?");
            diagnostic.fix(Fix::replace(named.span, path, message, Applicability::Probably))
        }
    }
}

/// Returns the file that the path of a missing file probably means: one in the same folder with nearly its name, and its extension, if it has one.
fn nearest_file(path: &Path, world: &dyn World) -> Option<String> {
    let text = |part: Option<&OsStr>| part.map(|part| part.to_string_lossy().into_owned());
    let (stem_text, ending) = (text(path.file_stem())?, text(path.extension()));
    let names = world.names_in(path.parent().unwrap_or(Path::new("")));
    if names.iter().any(|name| Some(OsStr::new(name)) == path.file_name()) {
        // the file exists, and cannot be read for another reason
        return None;
    }
    let stems: Vec<(String, &String)> = names
        .iter()
        .filter(|name| ending.is_none() || text(Path::new(name).extension()) == ending)
        .filter_map(|name| Some((text(Path::new(name).file_stem())?, name)))
        .collect();
    let same = stems.iter().find(|(stem, _)| *stem == stem_text);
    let near = || nearest(&stem_text, stems.iter().map(|(stem, _)| stem.as_str()));
    let matched = same.or_else(|| near().and_then(|near| stems.iter().find(|(stem, _)| stem == near)));
    matched.map(|(_, name)| (*name).clone())
}
