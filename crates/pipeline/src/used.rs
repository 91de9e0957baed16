//! The files that a text uses: each is read once, however many use it and by whichever path.

use super::Parsed;
use mechc_lang::check::{self, KnownFile, Library};
use mechc_syntax::{self as syntax, ast};
use mechc_text::diag::{Applies, Code, Diagnostic, Diagnostics, Fix, nearest};
use mechc_text::source::Sources;
use mechc_text::world::{self, World};
use rustc_hash::FxHashMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A text with the files that it uses.
pub(super) struct Used {
    /// With the texts of those files.
    pub sources: Sources,
    pub library: Library,
    /// What is wrong with those files, and with how they use each other.
    pub said: Diagnostics,
}

/// Reads all that a text uses, directly or by way of others.
pub(super) fn read(parsed: &Parsed, world: &dyn World) -> Used {
    let own = KnownFile { id: parsed.file(), path: parsed.path().to_owned(), read: parsed.shared(), uses: Vec::new() };
    let mut reading = Reading {
        world,
        sources: parsed.sources().clone(),
        numbers: FxHashMap::from_iter([(world.identity(&own.path), Ok(0))]),
        files: vec![own],
        said: Diagnostics::default(),
    };
    let mut at = 0;
    while at < reading.files.len() {
        reading.uses_of(at);
        at += 1;
    }
    let Reading { sources, files, mut said, .. } = reading;
    let library = Library::new(files);
    said.extend(library.faults(&sources));
    Used { sources, library, said }
}

impl Parsed {
    /// The files that its text names, and those that these name: texts that are used, and tables. Of a file that cannot be read its
    /// name is all there is.
    #[must_use]
    pub fn named_files(&self, world: &dyn World) -> Vec<PathBuf> {
        named_files(&read(self, world).library)
    }
}

/// The paths of all files that texts name: texts that they use, and tables of all their mechanisms.
pub(super) fn named_files(library: &Library) -> Vec<PathBuf> {
    let of = |file: &KnownFile| {
        let user = file.path.to_string_lossy().into_owned();
        names_of_files(&file.read.tree).map(|name| world::beside(&user, &name.text)).collect::<Vec<_>>()
    };
    library.files().iter().flat_map(of).collect()
}

/// The paths as a text writes them.
fn names_of_files(tree: &ast::File) -> impl Iterator<Item = &ast::Name> {
    let tables = tree.mechanisms.iter().flat_map(|mechanism| &mechanism.items).filter_map(|item| match &item.kind {
        ast::ItemKind::Table { rows: ast::TableRows::File { path, .. }, .. } => Some(path),
        _ => None,
    });
    tree.uses.iter().filter_map(|used| used.path.as_ref()).chain(tables)
}

struct Reading<'w> {
    world: &'w dyn World,
    sources: Sources,
    /// By what tells a file from all others: its number, or why it cannot be read.
    numbers: FxHashMap<PathBuf, Result<usize, Box<Diagnostic>>>,
    files: Vec<KnownFile>,
    said: Diagnostics,
}

impl Reading<'_> {
    fn uses_of(&mut self, at: usize) {
        let read = Arc::clone(&self.files[at].read);
        let beside = self.files[at].path.to_string_lossy().into_owned();
        let number = |used: &ast::UsedFile| used.path.as_ref().and_then(|path| self.number(&beside, path));
        self.files[at].uses = read.tree.uses.iter().map(number).collect::<Vec<_>>();
    }

    /// The number of the file that a text names, which is read if it is not here yet.
    fn number(&mut self, beside: &str, named: &ast::Name) -> Option<usize> {
        let path = world::normalised(&world::beside(beside, &named.text));
        // what leads back to the current folder has no parts left, and is it all the same
        let path = if path.as_os_str().is_empty() && !named.text.is_empty() { PathBuf::from(".") } else { path };
        let identity = self.world.identity(&path);
        if !self.numbers.contains_key(&identity) {
            let number = self.take_in(&path);
            self.numbers.insert(identity.clone(), number);
        }
        match self.numbers.get(&identity)? {
            Ok(number) => Some(*number),
            Err(why) => {
                self.said.push(used_here(why, named, &path, self.world));
                None
            }
        }
    }

    fn take_in(&mut self, path: &Path) -> Result<usize, Box<Diagnostic>> {
        let id = world::text_of(self.world, path, &mut self.sources)?;
        let read = Arc::new(syntax::parse(&self.sources, id));
        let holds_nothing = read.tree.mechanisms.is_empty() && read.tree.uses.is_empty();
        if holds_nothing && !read.faults.is_empty() {
            // it may be anything: what stands in it is nobody's business
            return Err(Box::new(no_mechanisms(&self.world.shown(path))));
        }
        self.said.extend(read.faults.clone());
        self.said.extend(check::check_file(&read.tree));
        self.files.push(KnownFile { id, path: path.to_owned(), read, uses: Vec::new() });
        Ok(self.files.len() - 1)
    }
}

/// A file that is read and holds neither mechanisms nor the names of others.
fn no_mechanisms(shown: &str) -> Diagnostic {
    Diagnostic::new(Code::E0101, format!("`{shown}` holds no mechanism")).help(format!(
        "a file that is used begins with `use` or `mechanism`: `mechc check {shown}` says where it does not"
    ))
}

/// Why a file cannot be read, with the place that names it.
pub(super) fn used_here(why: &Diagnostic, named: &ast::Name, path: &Path, world: &dyn World) -> Diagnostic {
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
            diagnostic.fix(Fix::replace(named.span, path, message, Applies::Probably))
        }
    }
}

/// The file that was probably meant by the path of one that is not there: one of its name or nearly so, and of its ending, if it has one.
fn nearest_file(path: &Path, world: &dyn World) -> Option<String> {
    let text = |part: Option<&OsStr>| part.map(|part| part.to_string_lossy().into_owned());
    let (wanted, ending) = (text(path.file_stem())?, text(path.extension()));
    let names = world.names_in(path.parent().unwrap_or(Path::new("")));
    if names.iter().any(|name| Some(OsStr::new(name)) == path.file_name()) {
        // it is there, and cannot be read for another reason
        return None;
    }
    let stems: Vec<(String, &String)> = names
        .iter()
        .filter(|name| ending.is_none() || text(Path::new(name).extension()) == ending)
        .filter_map(|name| Some((text(Path::new(name).file_stem())?, name)))
        .collect();
    let same = stems.iter().find(|(stem, _)| *stem == wanted);
    let near = || nearest(&wanted, stems.iter().map(|(stem, _)| stem.as_str()));
    let found = same.or_else(|| near().and_then(|near| stems.iter().find(|(stem, _)| stem == near)));
    found.map(|(_, name)| (*name).clone())
}
