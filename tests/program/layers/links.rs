//! Which file names what of which other: `use` lines and paths in the code, followed through re-exports to the file that declares it.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// A path of names from the crate's root.
pub type Names = Vec<String>;

/// One file of the crate.
pub struct File {
    /// Its code without comments and its own tests.
    pub code: String,
    /// What its `use` lines name, and whether they hand it on.
    uses: Vec<(Names, bool)>,
    /// Its code without `use` lines.
    body: String,
}

/// All files by their modules' names.
pub struct Crate {
    pub files: BTreeMap<Names, File>,
}

impl Crate {
    pub fn read(root: &Path, paths: &[impl AsRef<Path>]) -> Crate {
        let mut files = BTreeMap::new();
        for path in paths {
            let place = path.as_ref().strip_prefix(root).expect("below the root").to_string_lossy().replace('\\', "/");
            let text = fs::read_to_string(path).expect("a text");
            let code = without_tests(text.lines().filter(|line| !line.trim_start().starts_with("//")));
            let code = as_of_the_file(&code);
            files.insert(module_of(&place), File { code, uses: Vec::new(), body: String::new() });
        }
        let modules: BTreeSet<Names> = files.keys().cloned().collect();
        for (module, file) in &mut files {
            let (lines, body) = use_lines(&file.code);
            file.body = body;
            for (tree, hands_on) in lines {
                let named = expanded(&tree).into_iter().filter_map(|path| absolute(module, &path, &modules));
                file.uses.extend(named.map(|path| (path, hands_on)));
            }
        }
        Crate { files }
    }

    /// What a file names of the crate, each as a path from the root, as it is written.
    pub fn named(&self, module: &Names) -> BTreeSet<Names> {
        let file = &self.files[module];
        let modules: BTreeSet<Names> = self.files.keys().cloned().collect();
        let by_use = |path: &str| {
            let (first, rest) = path.split_once("::")?;
            let (used, _) = file.uses.iter().find(|(used, _)| used.last().is_some_and(|last| last == first))?;
            Some(used.iter().cloned().chain(rest.split("::").map(str::to_owned)).collect())
        };
        let in_code = paths(&file.body)
            .into_iter()
            .filter_map(|path| by_use(&path).or_else(|| absolute(module, &path, &modules)));
        // what is only handed on is a signpost
        let stands = |path: &Names| path.last().is_some_and(|last| words(&file.body).any(|word| word == last));
        let in_lines = file.uses.iter().filter(|(path, hands_on)| !hands_on || stands(path));
        in_lines.map(|(path, _)| path.clone()).chain(in_code).collect()
    }

    /// The files that a file names something of.
    pub fn links(&self, module: &Names) -> BTreeSet<Names> {
        let known = self.named(module).into_iter().map(|path| self.declaring(&path, 0));
        known.filter(|other| other != module).collect()
    }

    /// The types that a room shows at its door, each with the module of the file that declares it: declared there or in a module that is
    /// public, or handed on.
    pub fn shown(&self, room: &Names) -> BTreeSet<(String, Names)> {
        let file = &self.files[room];
        let mut shown: BTreeSet<(String, Names)> = self.types(room);
        for (path, _) in file.uses.iter().filter(|(_, hands_on)| *hands_on) {
            let declaring = self.declaring(path, 0);
            let is_wanted = |(name, _): &(String, Names)| path.last().is_some_and(|last| last == name || last == "*");
            shown.extend(
                self.files
                    .get(&declaring)
                    .map(|_| self.types(&declaring))
                    .unwrap_or_default()
                    .into_iter()
                    .filter(is_wanted),
            );
        }
        let is_public = |line: &str| line.trim().strip_prefix("pub mod ")?.strip_suffix(';').map(str::to_owned);
        for module in file.code.lines().filter_map(is_public).map(|name| [room.as_slice(), &[name]].concat()) {
            shown.extend(self.types(&module));
        }
        shown
    }

    /// The public types that a file declares.
    fn types(&self, module: &Names) -> BTreeSet<(String, Names)> {
        let name_of = |line: &str| {
            let declared = line.strip_prefix("pub ")?;
            let kinds = ["struct ", "enum ", "trait ", "type "];
            let name = kinds.iter().find_map(|kind| declared.strip_prefix(kind))?;
            words(name).next().map(str::to_owned)
        };
        let code = self.files.get(module).map(|file| file.code.as_str()).unwrap_or_default();
        code.lines().filter_map(name_of).map(|name| (name, module.clone())).collect()
    }

    /// The module of the file that declares what a path names.
    fn declaring(&self, path: &[String], depth: usize) -> Names {
        let length = (0..=path.len()).rev().find(|&n| self.files.contains_key(&path[..n])).unwrap_or(0);
        let (module, rest) = path.split_at(length);
        let (Some(file), Some(name)) = (self.files.get(module), rest.first()) else {
            return module.to_vec();
        };
        let by_name = file.uses.iter().map(|(used, _)| used).find(|used| used.last() == Some(name) && *used != path);
        let handed_on =
            || file.uses.iter().filter(|(used, hands_on)| *hands_on && used.last().is_some_and(|l| l == "*"));
        let by_star = || handed_on().map(|(used, _)| &used[..used.len() - 1]).find(|used| self.has(used, name));
        match by_name {
            _ if depth == 8 => module.to_vec(),
            Some(used) => self.declaring(&[used, &rest[1..]].concat(), depth + 1),
            None => by_star().map_or(module.to_vec(), |used| self.declaring(&[used, rest].concat(), depth + 1)),
        }
    }

    /// Whether a file declares something for others that has a name, or hands it on.
    fn has(&self, module: &[String], name: &str) -> bool {
        self.files.get(module).is_some_and(|file| {
            let is_declared = |line: &str| line.trim_start().starts_with("pub") && words(line).any(|word| word == name);
            file.body.lines().any(is_declared)
                || file.uses.iter().any(|(used, _)| used.last().is_some_and(|l| l == name))
        })
    }
}

/// `analysis/mod.rs` is `analysis`, `lib.rs` the root.
fn module_of(place: &str) -> Names {
    let mut names: Names = place.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
    if names.last().is_some_and(|last| last == "mod" || last == "lib") {
        names.pop();
    }
    names
}

/// Code, laid out as `cargo fmt` does it, without what only its own tests are made of: a line, or all up to the brace that closes it.
pub fn without_tests<'l>(mut lines: impl Iterator<Item = &'l str>) -> String {
    let mut code = Vec::new();
    while let Some(line) = lines.next() {
        let Some(indent) = line.strip_suffix("#[cfg(test)]").filter(|indent| indent.trim().is_empty()) else {
            code.push(line);
            continue;
        };
        let mut item = lines.by_ref().skip_while(|line| line.trim_start().starts_with("#["));
        if item.next().is_some_and(|head| !head.ends_with([';', '}'])) {
            lines.by_ref().find(|line| line.strip_prefix(indent).is_some_and(|rest| rest.starts_with('}')));
        }
    }
    code.join("\n")
}

/// Code in which `super`, within a module that is written in the file itself, no longer leads to the file.
fn as_of_the_file(code: &str) -> String {
    let mut open: Vec<&str> = Vec::new();
    let mut lines = Vec::new();
    for line in code.lines() {
        let trimmed = line.trim_start();
        let indent = &line[..line.len() - trimmed.len()];
        lines.push(open.iter().fold(line.to_owned(), |line, _| line.replacen("super::", "", 1)));
        if trimmed.ends_with('{') && words(trimmed).take(3).any(|word| word == "mod") {
            open.push(indent);
        }
        open.pop_if(|outer| trimmed == "}" && *outer == indent);
    }
    lines.join("\n")
}

/// The trees of all `use` lines, with whether they are `pub`; and what is left of the code.
fn use_lines(code: &str) -> (Vec<(String, bool)>, String) {
    let (mut trees, mut body) = (Vec::new(), String::new());
    let mut open: Option<(String, bool)> = None;
    for line in code.lines() {
        let trimmed = line.trim();
        let is_public = trimmed.starts_with("pub");
        let start =
            if is_public { trimmed.split_once("use ").filter(|(head, _)| !head.contains(['{', '='])) } else { None };
        let start = start.map_or_else(|| trimmed.strip_prefix("use "), |(_, tree)| Some(tree));
        match (&mut open, start) {
            (Some((tree, _)), _) => *tree += trimmed,
            (None, Some(tree)) => open = Some((tree.to_owned(), is_public)),
            (None, None) => {
                body += line;
                body.push('\n');
            }
        }
        if let Some((tree, _)) = &open
            && tree.ends_with(';')
        {
            trees.extend(open.take());
        }
    }
    (trees, body)
}

/// The paths of a tree: `a::{b, c::d}` is `a::b` and `a::c::d`.
fn expanded(tree: &str) -> Vec<String> {
    let tree = tree.trim().trim_end_matches(';');
    let Some((head, list)) = tree.split_once('{') else {
        return vec![tree.split(" as ").next().unwrap_or(tree).trim().to_owned()];
    };
    let list = list.strip_suffix('}').unwrap_or(list);
    let (mut parts, mut depth) = (vec![String::new()], 0);
    for c in list.chars() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        match parts.last_mut() {
            Some(part) if c != ',' || depth > 0 => part.push(c),
            _ => parts.push(String::new()),
        }
    }
    let parts = parts.into_iter().filter(|part| !part.trim().is_empty());
    parts.flat_map(|part| expanded(&part)).map(|part| format!("{head}{part}")).collect()
}

/// A path from the crate's root; none for one of another crate.
fn absolute(module: &[String], path: &str, modules: &BTreeSet<Names>) -> Option<Names> {
    let mut names: Vec<&str> = path.split("::").filter(|name| !name.is_empty()).collect();
    let first = *names.first()?;
    let mut base = module.to_vec();
    match first {
        "crate" => base.clear(),
        "self" | "super" => {}
        _ => {
            let child = [module, &[first.to_owned()]].concat();
            return modules
                .contains(&child)
                .then(|| [module, &names.iter().map(|&n| n.to_owned()).collect::<Names>()].concat());
        }
    }
    while names.first() == Some(&"super") {
        base.pop();
        names.remove(0);
    }
    let rest = names.into_iter().filter(|name| !matches!(*name, "crate" | "self"));
    base.extend(rest.map(str::to_owned));
    Some(base)
}

/// The paths of several names in code.
fn paths(code: &str) -> Vec<String> {
    let pieces = code.split(|c: char| !c.is_alphanumeric() && c != '_' && c != ':');
    pieces.filter(|piece| piece.contains("::")).map(str::to_owned).collect()
}

fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c: char| !c.is_alphanumeric() && c != '_')
}
