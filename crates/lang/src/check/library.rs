//! The mechanisms that a text may name: its own, and those of the files that it uses.
//!
//! Plain data of files that have been read. `pipeline` reads the files, and reports those that cannot be read.

use super::errors::library as errors;
use mechc_syntax::ast::{Mechanism, Name, UsedFile};
use mechc_syntax::{self as syntax, is_name};
use mechc_text::diag::{Diagnostic, Diagnostics, nearest};
use mechc_text::source::{FileId, Sources, Span};
use rustc_hash::FxHashMap;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// A text with all files that it uses directly or indirectly, each once.
#[derive(Clone, Debug, Default)]
pub struct Library {
    files: Arc<[LibraryFile]>,
}

/// A file of a [`Library`].
#[derive(Clone, Debug)]
pub struct LibraryFile {
    /// The id of its text.
    pub id: FileId,
    /// Its path, to which the paths that it names are relative; empty for standard input.
    pub path: PathBuf,
    /// Its parsed text.
    pub read: Arc<syntax::ParsedText>,
    /// The file of each `use`, by its number in the library; `None` if it could not be read, which is reported.
    pub uses: Vec<Option<usize>>,
}

/// A mechanism of a [`Library`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct LibraryMechanism {
    /// The number of its file.
    pub file: usize,
    /// Its number in that file.
    pub number: usize,
}

/// The reason why a name stands for no mechanism.
#[derive(Clone, Debug)]
pub enum LookupError {
    /// The diagnostic of the name.
    Told(Box<Diagnostic>),
    /// The name may be one of a file that could not be read, which has been reported.
    Said,
}

impl Library {
    /// Returns a library of files, the first of which is the text. Numbers in `uses` must be valid, one for each `use` of the file's text.
    #[must_use]
    pub fn new(files: Vec<LibraryFile>) -> Library {
        Library { files: files.into() }
    }

    /// Returns all files; the first is the text itself.
    #[must_use]
    pub fn files(&self) -> &[LibraryFile] {
        &self.files
    }

    /// Returns the tree of a mechanism.
    #[must_use]
    pub fn tree(&self, mechanism: LibraryMechanism) -> &Mechanism {
        &self.files[mechanism.file].read.tree.mechanisms[mechanism.number]
    }

    /// Returns the mechanism whose name is at a location.
    #[must_use]
    pub fn mechanism_at(&self, name: Span) -> Option<&Mechanism> {
        let file = &self.files[self.number_of(name.file)?];
        file.read.tree.mechanisms.iter().find(|mechanism| mechanism.name.span == name)
    }

    /// Returns the path to which the paths in a text are relative; for an unknown text, that of the current folder.
    #[must_use]
    pub fn path_of(&self, file: FileId) -> &Path {
        self.number_of(file).map_or(Path::new(""), |number| &self.files[number].path)
    }

    /// Returns the mechanism that a name with an optional prefix stands for in the file in which it is written.
    ///
    /// # Errors
    /// The diagnostic of an unknown name, with a suggestion.
    pub fn find(&self, prefix: Option<&Name>, name: &Name, sources: &Sources) -> Result<LibraryMechanism, LookupError> {
        let Some(at) = self.number_of(name.span.file) else { return Err(LookupError::Said) };
        let file = &self.files[at];
        let local = if prefix.is_none() { mechanism_of(file, &name.text) } else { None };
        if let Some(number) = local {
            return Ok(LibraryMechanism { file: at, number });
        }
        let expected =
            |used: &UsedFile| used.prefix.as_ref().map(|prefix| &prefix.text) == prefix.map(|expected| &expected.text);
        let uses = || file.read.tree.uses.iter().zip(&file.uses).filter(|(used, _)| expected(used));
        for &number in uses().filter_map(|(_, number)| number.as_ref()) {
            if let Some(found) = mechanism_of(&self.files[number], &name.text) {
                return Ok(LibraryMechanism { file: number, number: found });
            }
        }
        let is_whole = |file: &LibraryFile| file.read.faults.is_empty();
        let all_are_read = uses().all(|(_, number)| number.is_some_and(|number| is_whole(&self.files[number])));
        if !is_whole(file) || !all_are_read {
            return Err(LookupError::Said);
        }
        let diagnostic = match prefix.filter(|_| uses().next().is_none()) {
            Some(prefix) => errors::no_prefix(prefix, &prefixes(file)),
            None => self.no_mechanism(at, prefix, name, sources),
        };
        Err(LookupError::Told(Box::new(diagnostic)))
    }

    /// Returns the first file with a mechanism of a name.
    #[must_use]
    pub fn file_of(&self, name: &str) -> Option<FileId> {
        self.files.iter().find(|file| mechanism_of(file, name).is_some()).map(|file| file.id)
    }

    /// Returns the diagnostics of files that use each other: duplicate names and cycles.
    #[must_use]
    pub fn faults(&self, sources: &Sources) -> Diagnostics {
        let mut faults = Diagnostics::default();
        for file in self.files.iter() {
            faults.extend(prefixes_that_stand_twice(file));
            faults.extend(self.duplicate_names(file, sources));
        }
        faults.extend(self.cycles(sources));
        faults
    }

    fn number_of(&self, file: FileId) -> Option<usize> {
        self.files.iter().position(|other| other.id == file)
    }

    fn shown<'s>(&self, number: usize, sources: &'s Sources) -> &'s str {
        &sources.get(self.files[number].id).name
    }

    fn no_mechanism(&self, at: usize, prefix: Option<&Name>, name: &Name, sources: &Sources) -> Diagnostic {
        let (mut candidates, mut elsewhere) = (Vec::new(), Vec::new());
        if prefix.is_none() {
            candidates.extend(names(&self.files[at]));
        }
        for (used, number) in self.uses_of(at) {
            if used.prefix.as_ref().map(|prefix| &prefix.text) == prefix.map(|prefix| &prefix.text) {
                candidates.extend(names(&self.files[number]));
            } else if mechanism_of(&self.files[number], &name.text).is_some() {
                let prefix = used.prefix.as_ref().map(|prefix| format!("{}.", prefix.text)).unwrap_or_default();
                elsewhere.push(format!("{prefix}{}", name.text));
            }
        }
        let suggestion = nearest(&name.text, candidates.iter().copied());
        let further = (0..self.files.len())
            .find(|&other| other != at && mechanism_of(&self.files[other], &name.text).is_some())
            .map(|other| (self.shown(other, sources), relative(&self.files[at].path, &self.files[other].path)));
        errors::no_mechanism(prefix, name, &candidates, suggestion, elsewhere.first().map(String::as_str), further)
    }

    /// Returns the files that a file uses, as far as they could be read.
    fn uses_of(&self, at: usize) -> impl Iterator<Item = (&UsedFile, usize)> {
        let file = &self.files[at];
        file.read.tree.uses.iter().zip(&file.uses).filter_map(|(used, number)| Some((used, (*number)?)))
    }

    /// Reports mechanisms of two files with one name and no prefix.
    fn duplicate_names(&self, file: &LibraryFile, sources: &Sources) -> Vec<Diagnostic> {
        let user = self.number_of(file.id).unwrap_or_default();
        let mut first: FxHashMap<&str, (usize, Span)> = FxHashMap::default();
        for mechanism in file.read.tree.mechanisms.iter().filter(|mechanism| !mechanism.name.text.is_empty()) {
            first.entry(&mechanism.name.text).or_insert((user, mechanism.name.span));
        }
        let mut faults = Vec::new();
        for (used, number) in self.uses_of(user).filter(|(used, _)| used.prefix.is_none() && !used.is_broken) {
            let mut twice: Vec<(&str, usize, Span)> = Vec::new();
            for name in names(&self.files[number]) {
                let &mut (from, span) = first.entry(name).or_insert((number, used.span));
                if from != number && !twice.iter().any(|(other, ..)| *other == name) {
                    twice.push((name, from, span));
                }
            }
            if let Some(&(_, from, span)) = twice.first() {
                let names: Vec<&str> = twice.iter().map(|(name, ..)| *name).collect();
                let files = [from, number].map(|number| self.shown(number, sources));
                let prefix = free_prefix(&self.files[number].path, file);
                faults.push(errors::names_twice(&names, files, [span, used.span], &prefix));
            }
        }
        faults
    }

    /// Reports cycles of files, each by one of its links.
    fn cycles(&self, sources: &Sources) -> Vec<Diagnostic> {
        let (mut is_done, mut faults) = (vec![false; self.files.len()], Vec::new());
        // A path from the text, which reaches all files, with the number of uses of each file on it that have been followed.
        let mut path: Vec<(usize, usize)> = if self.files.is_empty() { Vec::new() } else { vec![(0, 0)] };
        while let Some((at, next)) = path.last_mut() {
            let at = *at;
            let link = self.uses_of(at).nth(*next);
            *next += 1;
            let Some((_, other)) = link else {
                is_done[at] = true;
                path.pop();
                continue;
            };
            if let Some(begin) = path.iter().position(|(file, _)| *file == other) {
                let links = path[begin..].iter().filter_map(|&(file, next)| {
                    let (used, _) = self.uses_of(file).nth(next - 1)?;
                    Some((self.shown(file, sources), used.span))
                });
                faults.push(errors::cycle_of_files(&links.collect::<Vec<_>>()));
            } else if !is_done[other] {
                path.push((other, 0));
            }
        }
        faults
    }
}

fn names(file: &LibraryFile) -> impl Iterator<Item = &str> {
    let names = file.read.tree.mechanisms.iter().map(|mechanism| mechanism.name.text.as_str());
    names.filter(|name| !name.is_empty())
}

fn mechanism_of(file: &LibraryFile, name: &str) -> Option<usize> {
    file.read.tree.mechanisms.iter().position(|mechanism| mechanism.name.text == name && !name.is_empty())
}

fn prefixes(file: &LibraryFile) -> Vec<&Name> {
    file.read.tree.uses.iter().filter_map(|used| used.prefix.as_ref()).collect()
}

fn prefixes_that_stand_twice(file: &LibraryFile) -> Vec<Diagnostic> {
    let mut first: FxHashMap<&str, Span> = FxHashMap::default();
    let duplicate = |prefix: &Name, first: Span| (first != prefix.span).then(|| errors::second_prefix(prefix, first));
    let all = prefixes(file);
    all.into_iter().filter_map(|prefix| duplicate(prefix, *first.entry(&prefix.text).or_insert(prefix.span))).collect()
}

/// Returns a free prefix for the mechanisms of a file, made of its name.
fn free_prefix(path: &Path, user: &LibraryFile) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let mut name: String = stem.chars().map(|c| if c.is_alphanumeric() { c } else { '_' }).collect();
    let taken = prefixes(user);
    while !is_name(&name) || taken.iter().any(|prefix| prefix.text == name) {
        name = if is_name(&name) { name + "_2" } else { format!("f_{name}") };
    }
    name
}

/// Returns the path to a file relative to another one.
fn relative(from: &Path, to: &Path) -> String {
    let parts = |path| Path::components(path).filter(|part| *part != Component::CurDir).collect::<Vec<_>>();
    let (folder, to) = (from.parent().map(parts).unwrap_or_default(), parts(to));
    let shared = folder.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = folder[shared..].iter().map(|_| "..".to_owned());
    let down = to[shared..].iter().map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}
