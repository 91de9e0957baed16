//! The `.mech` files of folders, and search in their declarations.

use super::lexical::matches_letters;
use super::location::FileRange;
use super::outline::{OutlineEntry, outline};
use super::snapshot::Snapshot;
use mechc_lang::check::NameKind;
use mechc_text::cancel::Cancel;
use mechc_text::world::{World, is_source_entry};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use mechc_text::world::is_mech;

/// The maximum number of files to look for; names in further files are found only if these are open.
const MAX_FILES: usize = 1_000;

/// The maximum number of folders to read.
const MAX_FOLDERS: usize = 10_000;

/// The maximum depth of folders; links may form a cycle.
const MAX_DEPTH: usize = 16;

/// The maximum number of names in a result.
const MAX_NAMES: usize = 500;

/// A declaration of a file.
#[derive(Clone, PartialEq, Debug)]
pub struct WorkspaceName {
    /// The name.
    pub name: String,
    /// The kind of declaration.
    pub kind: NameKind,
    /// The range of its name.
    pub location: FileRange,
    /// The path of the declaration that holds it.
    pub within: Option<String>,
}

/// Returns the `.mech` files in folders and their subfolders, by identity. Hidden files and folders of build results are left out, as by
/// `mechc fmt`.
#[must_use]
pub fn files_in(folders: &[PathBuf], world: &dyn World, cancel: &Cancel) -> Vec<Arc<Path>> {
    let (mut found, mut visited) = (BTreeSet::new(), 0);
    let mut next: Vec<(PathBuf, usize)> = folders.iter().map(|folder| (folder.clone(), 0)).collect();
    while let Some((folder, depth)) = next.pop() {
        visited += 1;
        if visited > MAX_FOLDERS || found.len() >= MAX_FILES || cancel.is_cancelled() {
            break;
        }
        let files = world.names_in(&folder).into_iter().filter(|name| is_mech(name) && is_source_entry(name));
        found.extend(files.map(|name| Arc::<Path>::from(world.identity(&folder.join(name)))));
        if depth < MAX_DEPTH {
            let inner = world.folders_in(&folder).into_iter().filter(|name| is_source_entry(name));
            next.extend(inner.map(|name| (folder.join(name), depth + 1)));
        }
    }
    found.into_iter().take(MAX_FILES).collect()
}

/// Returns the declarations of all files of a snapshot whose names contain the letters of a query in their order.
#[must_use]
pub fn workspace_names(snapshot: &Snapshot, query: &str) -> Vec<WorkspaceName> {
    let query: String = query.chars().filter(|c| !c.is_whitespace()).collect();
    let mut found = Vec::new();
    let is_text = |path: &&Arc<Path>| snapshot.buffers().open(path).is_some() || is_mech(&path.to_string_lossy());
    for path in snapshot.files().filter(is_text) {
        if found.len() >= MAX_NAMES || snapshot.is_cancelled() {
            break;
        }
        for entry in outline(snapshot, path).unwrap_or_default() {
            collect_matches(&entry, None, path, &query, &mut found);
        }
    }
    found.truncate(MAX_NAMES);
    found
}

fn collect_matches(
    entry: &OutlineEntry,
    within: Option<&str>,
    path: &Arc<Path>,
    query: &str,
    found: &mut Vec<WorkspaceName>,
) {
    if matches_letters(&entry.name, query) && entry.kind != NameKind::Ground {
        let location = FileRange { path: Arc::clone(path), start: entry.name_range.start, end: entry.name_range.end };
        found.push(WorkspaceName {
            name: entry.name.clone(),
            kind: entry.kind,
            location,
            within: within.map(str::to_owned),
        });
    }
    let path_name = within.map_or(entry.name.clone(), |within| format!("{within}.{}", entry.name));
    entry.inside.iter().for_each(|inner| collect_matches(inner, Some(&path_name), path, query, found));
}

#[cfg(test)]
mod tests {
    use super::{files_in, workspace_names};
    use crate::testing::{TWO_FILES, at_cursor};
    use mechc_text::cancel::Cancel;
    use mechc_text::world::Memory;
    use std::path::PathBuf;

    #[test]
    fn files_of_folders_are_found() {
        let files = [
            "w/a.mech",
            "w/b.csv",
            "w/deep/er/C.MECH",
            "w/.git/d.mech",
            "w/target/e.mech",
            "w/.g.mech",
            "other/f.mech",
        ];
        let world = files.iter().fold(Memory::default(), |world, name| world.with(name, ""));
        let found = files_in(&[PathBuf::from("w")], &world, &Cancel::default());
        assert_eq!(
            found.iter().map(|path| path.display().to_string()).collect::<Vec<_>>(),
            ["w/a.mech", "w/deep/er/C.MECH"]
        );
    }

    #[test]
    fn declarations_are_found_by_some_of_their_letters() {
        let (snapshot, _) = at_cursor(&format!("{TWO_FILES}$0"));
        let of = |query: &str| {
            let line = |found: &super::WorkspaceName| {
                format!(
                    "{} {:?} {}",
                    found.location.path.display(),
                    found.kind,
                    found.within.clone().map_or(found.name.clone(), |within| format!("{within}.{}", found.name))
                )
            };
            workspace_names(&snapshot, query).iter().map(line).collect::<Vec<_>>().join("\n")
        };
        insta::assert_snapshot!(of("LEV"), @"lever.mech Mechanism lever");
        insta::assert_snapshot!(of("tip"), @"lever.mech Point lever.arm.tip");
    }
}
