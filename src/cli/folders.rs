//! The `.mech` files that a command's arguments name: files, and folders with their subfolders.

use super::failure::Failure;
use mechc_text::world;
use rustc_hash::FxHashSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Returns the files of some names, each once, in the order of the names and sorted within a folder; an error for a name without files.
pub(super) fn files_of(names: &[String]) -> Vec<Result<String, Failure>> {
    let (mut files, mut visited) = (Vec::new(), FxHashSet::default());
    for name in names {
        let found = if name != "-" && Path::new(name).is_dir() { in_folder(name) } else { Ok(vec![name.clone()]) };
        match found {
            // a file may be named by several paths or links
            Ok(found) => files.extend(found.into_iter().filter(|file| visited.insert(identity(file))).map(Ok)),
            Err(why) => files.push(Err(why)),
        }
    }
    files
}

fn identity(file: &str) -> PathBuf {
    let path = Path::new(file);
    if file == "-" { path.to_owned() } else { path.canonicalize().unwrap_or_else(|_| path.to_owned()) }
}

fn in_folder(name: &str) -> Result<Vec<String>, Failure> {
    let mut files = Vec::new();
    collect(Path::new(name), &mut files).map_err(|(path, error)| world::cannot_read(&shown(&path), &error))?;
    if files.is_empty() {
        return Err(world::cannot_read(name, &io::Error::other("no `.mech` file is in it")).into());
    }
    Ok(files.iter().map(|path| shown(path)).collect())
}

fn shown(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// Adds all files below a folder, by the rules of the language server. Links are skipped, since their targets have other paths.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), (PathBuf, io::Error)> {
    let failed = |error| (folder.to_owned(), error);
    let mut entries = fs::read_dir(folder).map_err(failed)?.collect::<Result<Vec<_>, _>>().map_err(failed)?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let path = entry.path();
        let kind = entry.file_type().map_err(failed)?;
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if !world::is_source_entry(&name) {
            continue;
        }
        if kind.is_dir() {
            collect(&path, files)?;
        } else if kind.is_file() && world::is_mech(&name) {
            files.push(path);
        }
    }
    Ok(())
}
