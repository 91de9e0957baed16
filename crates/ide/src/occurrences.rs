//! Declarations and uses of names, across files and parts.
//!
//! The checker resolves the names within one mechanism. This module adds those that lead out of it: paths into parts, bound params,
//! mechanisms and files.

use super::location::{FilePosition, FileRange};
use super::snapshot::Snapshot;
use mechc_lang::check::{Library, LibraryMechanism, Meaning, name_of};
use mechc_pipeline::Checked;
use mechc_syntax::ast::{Expr, ExprKind, Item, ItemKind, Mechanism, MechanismName, Name, Part, TableRows};
use mechc_text::source::{FileId, Span};
use mechc_text::world::{World, beside};
use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// The declaration or file that a name refers to.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Target {
    /// A declaration, by the range of its name.
    Name(FileRange),
    /// A file.
    File(Arc<Path>),
}

/// The role of an occurrence.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Role {
    Uses,
    Declares,
}

/// An occurrence of a name.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Occurrence {
    pub range: Bytes,
    pub role: Role,
    pub target: Target,
}

/// A range of bytes that can be ordered.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Bytes {
    pub start: u32,
    pub end: u32,
}

impl Bytes {
    pub fn range(self) -> Range<u32> {
        self.start..self.end
    }
}

impl Occurrence {
    /// Returns its range in its file.
    pub fn location(&self, path: &Arc<Path>) -> FileRange {
        FileRange { path: Arc::clone(path), start: self.range.start, end: self.range.end }
    }
}

/// Returns the occurrences of names in a file, in order. If a name both uses and declares (`point A`), the declaration comes last.
pub(super) fn occurrences(snapshot: &Snapshot, path: &Path) -> Option<Vec<Occurrence>> {
    let file = snapshot.checked(path)?;
    let mut found = BTreeSet::new();
    for checked in &file.mechanisms {
        let mut walk = Walk { snapshot, checked, library: checked.library(), found: &mut found };
        walk.names();
        walk.files();
        if let Some(tree) = checked.tree() {
            walk.parts(tree);
        }
    }
    Some(found.into_iter().collect())
}

/// Returns the occurrence that contains an offset or ends there.
pub(super) fn occurrence_at(occurrences: &[Occurrence], offset: u32) -> Option<&Occurrence> {
    let touches = |one: &&Occurrence| one.range.start <= offset && offset <= one.range.end;
    occurrences.iter().filter(touches).max_by_key(|one| (one.range.start, one.role))
}

/// Finds the occurrence at a position.
pub(super) fn name_at(snapshot: &Snapshot, position: &FilePosition) -> Option<Occurrence> {
    let all = occurrences(snapshot, &position.path)?;
    occurrence_at(&all, position.offset).cloned()
}

/// Returns the files that contain one of some words, among the open ones, those of the workspace and those that a file uses.
pub(super) fn files_containing(snapshot: &Snapshot, near: &Path, words: &[&str]) -> Vec<Arc<Path>> {
    let buffers = snapshot.buffers();
    let mut files: BTreeSet<Arc<Path>> = snapshot.files().cloned().collect();
    files.insert(near.into());
    if let Some(checked) = snapshot.checked(near).as_ref().and_then(|file| file.mechanisms.first()) {
        files.extend(checked.library().files().iter().map(|file| Arc::from(buffers.identity(&file.path))));
    }
    // names are compared in NFC, so bytes decide only for ASCII
    let is_plain = words.iter().all(|word| word.is_ascii());
    let holds = |path: &Arc<Path>| {
        let text = buffers.read(path).map(|contents| contents.bytes);
        text.is_ok_and(|text| !is_plain || words.iter().any(|word| contains(&text, word.as_bytes())))
    };
    let is_text = |path: &Arc<Path>| buffers.open(path).is_some() || super::workspace::is_mech(&path.to_string_lossy());
    files.into_iter().filter(is_text).filter(holds).collect()
}

fn contains(text: &[u8], word: &[u8]) -> bool {
    !word.is_empty() && text.windows(word.len()).any(|window| window == word)
}

/// Collects the occurrences of a mechanism's text.
struct Walk<'s> {
    snapshot: &'s Snapshot,
    checked: &'s Checked,
    library: &'s Library,
    found: &'s mut BTreeSet<Occurrence>,
}

impl Walk<'_> {
    fn location(&self, span: Span) -> FileRange {
        FileRange { path: self.path_of(span.file), start: span.start, end: span.end }
    }

    fn path_of(&self, file: FileId) -> Arc<Path> {
        self.snapshot.buffers().identity(Path::new(&self.checked.sources().get(file).name)).into()
    }

    fn add(&mut self, span: Span, role: Role, target: Target) {
        if span.file == self.checked.file() {
            self.found.insert(Occurrence { range: Bytes { start: span.start, end: span.end }, role, target });
        }
    }

    fn uses(&mut self, name: &Name, declared: Span) {
        let target = Target::Name(self.location(declared));
        self.add(name.span, Role::Uses, target);
    }

    /// Adds the names that the checker has resolved.
    fn names(&mut self) {
        let symbols = self.checked.symbols();
        for used in symbols.uses() {
            if let Meaning::Declared(id) = used.meaning {
                let role = if used.declares { Role::Declares } else { Role::Uses };
                self.add(used.span, role, Target::Name(self.location(symbols.get(id).span)));
            }
        }
    }

    fn files(&mut self) {
        let Some(file) = self.library.files().first() else { return };
        let uses = file.read.tree.uses.iter().filter_map(|used| used.path.as_ref());
        let tables = file.read.tree.mechanisms.iter().flat_map(|mechanism| &mechanism.items).filter_map(table_file);
        for name in uses.chain(tables) {
            let named = beside(&file.path.to_string_lossy(), &name.text);
            let target = Target::File(self.snapshot.buffers().identity(&named).into());
            self.add(name.span, Role::Uses, target);
        }
    }

    fn parts(&mut self, tree: &Mechanism) {
        for item in &tree.items {
            if let ItemKind::Part(part) = &item.kind {
                self.part(part);
            }
            for formula in item.formulas() {
                formula.parts().for_each(|e| self.path(tree, e));
            }
        }
    }

    /// Adds the mechanism of a part and the params that it binds.
    fn part(&mut self, part: &Part) {
        let uses = self.library.files().first().map(|file| Arc::clone(&file.read));
        let prefixes = uses.iter().flat_map(|read| &read.tree.uses).filter_map(|used| used.prefix.as_ref());
        if let Some(prefix) = &part.mechanism.prefix
            && let Some(declared) = prefixes.clone().find(|declared| declared.text == prefix.text)
        {
            self.uses(prefix, declared.span);
        }
        let Some(inside) = find_mechanism(self.library, &part.mechanism, self.checked).map(|id| self.library.tree(id))
        else {
            return;
        };
        let inside = inside.clone();
        self.uses(&part.mechanism.name, inside.name.span);
        for binding in &part.bindings {
            let is_bound = |item: &&Item| matches!(item.kind, ItemKind::Param { .. } | ItemKind::Input { .. });
            let declared = inside.items.iter().filter(is_bound).filter_map(name_of);
            if let Some(name) = declared.into_iter().find(|name| name.text == binding.name.text) {
                self.uses(&binding.name, name.span);
            }
        }
    }

    /// Adds the names of a path that leads into a part.
    fn path(&mut self, tree: &Mechanism, e: &Expr) {
        let names: Vec<&Name> = match &e.kind {
            ExprKind::Member { owner, feature } => vec![owner, feature],
            ExprKind::Path(segments) => segments.iter().map(|segment| &segment.name).collect(),
            _ => return,
        };
        let Some((first, rest)) = names.split_first() else { return };
        let part = tree.items.iter().find_map(|item| match &item.kind {
            ItemKind::Part(part) if part.name.text == first.text => Some(&**part),
            _ => None,
        });
        let mut inside = part.and_then(|part| find_mechanism(self.library, &part.mechanism, self.checked));
        let mut rest = rest.iter();
        while let (Some(known_mechanism), Some(name)) = (inside.take(), rest.next()) {
            let library = self.library.clone();
            let Some(item) = item_named(library.tree(known_mechanism), &name.text) else { return };
            self.uses(name, name_span(item));
            match &item.kind {
                ItemKind::Part(part) => inside = find_mechanism(&library, &part.mechanism, self.checked),
                ItemKind::Body { features, .. } | ItemKind::Ground { features } => {
                    let Some(name) = rest.next() else { return };
                    if let Some(feature) = features.iter().find(|feature| feature.name.text == name.text) {
                        self.uses(name, feature.name.span);
                    }
                }
                _ => {}
            }
        }
    }
}

/// Finds the mechanism that a part names.
pub(super) fn find_mechanism(library: &Library, name: &MechanismName, checked: &Checked) -> Option<LibraryMechanism> {
    library.find(name.prefix.as_ref(), &name.name, checked.sources()).ok()
}

/// Finds a declaration of a mechanism by its name, which may be `ground`.
pub(super) fn item_named<'t>(tree: &'t Mechanism, name: &str) -> Option<&'t Item> {
    tree.items.iter().find(|item| match &item.kind {
        ItemKind::Ground { .. } => name == "ground",
        _ => name_of(item).is_some_and(|declared| declared.text == name),
    })
}

fn name_span(item: &Item) -> Span {
    let ground = Span { end: item.span.start + "ground".len() as u32, ..item.span };
    name_of(item).map_or(ground, |name| name.span)
}

fn table_file(item: &Item) -> Option<&Name> {
    match &item.kind {
        ItemKind::Table { rows: TableRows::File { path, .. }, .. } => Some(path),
        _ => None,
    }
}

/// Returns the text of a path such as `crank.B`; `None` if the expression is not a path or has indices.
pub(super) fn path_text(e: &Expr) -> Option<String> {
    match &e.bare().kind {
        ExprKind::Name(name) => Some(name.text.clone()),
        ExprKind::Member { owner, feature } => Some(format!("{}.{}", owner.text, feature.text)),
        ExprKind::Path(segments) if segments.iter().all(|segment| segment.indices.is_empty()) => {
            Some(segments.iter().map(|segment| segment.name.text.as_str()).collect::<Vec<_>>().join("."))
        }
        _ => None,
    }
}
