//! What `ARCHITECTURE.md` names is there: files, tests, constants.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn page() -> String {
    fs::read_to_string(root().join("ARCHITECTURE.md")).expect("the page")
}

/// What stands between backticks.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// Where a path of the page leads, if anywhere.
fn place(path: &str) -> Option<PathBuf> {
    [root().join("src"), root()].into_iter().map(|base| base.join(path)).find(|path| path.exists())
}

fn is_word(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

#[test]
fn every_path_leads_somewhere() {
    let page = page();
    let mut looked_at = 0;
    for path in quoted(&page) {
        let is_path = path.contains('/') && path.chars().all(|c| c.is_ascii_alphanumeric() || "_-./".contains(c));
        // of a kind, or in a path that is only described
        let is_pattern = ["NAME", "AREA", "CODE", "FILE"].iter().any(|part| path.contains(part));
        if is_path && !is_pattern {
            looked_at += 1;
            assert!(place(path).is_some(), "`{path}` is not there");
        }
    }
    assert!(looked_at > 100, "only {looked_at} paths were looked at");
}

#[test]
fn every_test_is_there() {
    let page = page();
    let mut looked_at = 0;
    let words = page.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == ':'));
    for (file, name) in words.filter_map(|word| word.split_once("::")).filter(|(_, name)| is_word(name)) {
        let Ok(text) = fs::read_to_string(root().join(format!("tests/{file}.rs"))) else {
            continue;
        };
        // a module of the library may have the name of a test
        if name.len() < 12 && place(&format!("{file}/mod.rs")).is_some() {
            continue;
        }
        looked_at += 1;
        let is_there = text.contains(&format!("fn {name}(")) || text.contains(&format!("\"{name}\""));
        assert!(is_there, "tests/{file}.rs has no `{name}`");
    }
    assert!(looked_at > 30, "only {looked_at} tests were looked at");
}

/// The limits that a file takes from `tolerances`.
fn limits_of(text: &str) -> impl Iterator<Item = &str> {
    let lists = text.split("use crate::tolerances::").skip(1).filter_map(|tree| tree.split(';').next());
    lists.flat_map(|tree| tree.split(|c: char| !c.is_ascii_alphanumeric() && c != '_')).filter(|word| is_limit(word))
}

fn is_limit(word: &str) -> bool {
    is_word(word) && word.chars().all(|c| c.is_ascii_uppercase() || c == '_')
}

/// The constants of a row of "Numbers" are used in one of its files: declared there, or taken from `tolerances`.
#[test]
fn every_constant_of_a_table_is_in_its_file() {
    let page = page();
    let mut looked_at = 0;
    for line in page.lines().filter(|line| line.starts_with("| ")) {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let ([_, _, files, constants, _] | [constants, files, _]) = cells.as_slice() else { continue };
        let texts: Vec<String> = quoted(files)
            .filter(|path| Path::new(path).extension().is_some_and(|ending| ending == "rs"))
            .filter_map(|path| fs::read_to_string(place(path)?).ok())
            .collect();
        if texts.is_empty() {
            continue;
        }
        for constant in quoted(constants).filter(|word| is_limit(word)) {
            looked_at += 1;
            let is_in = |text: &String| {
                text.contains(&format!("const {constant}:")) || limits_of(text).any(|limit| limit == constant)
            };
            assert!(texts.iter().any(is_in), "`{constant}` is not used in {files}");
        }
    }
    assert!(looked_at > 200, "only {looked_at} constants were looked at");
}

/// A limit of `tolerances`: its module, with the places that this is said to be for, and its name.
struct Declared {
    module: String,
    places: Vec<String>,
    name: String,
}

fn declared() -> Vec<Declared> {
    let mut all = Vec::new();
    for chapter in sources(&root().join("src/tolerances")) {
        let file = chapter.file_stem().and_then(|stem| stem.to_str()).expect("a name").to_owned();
        let outer = if file == "mod" { String::new() } else { format!("{file}::") };
        let (mut module, mut places, mut docs) = (outer.clone(), Vec::new(), "");
        let text = fs::read_to_string(&chapter).expect("text");
        let mut before = "";
        for line in text.lines() {
            if line.starts_with("///") {
                docs = line;
            } else if let Some(name) = line.strip_prefix("pub mod ").and_then(|rest| rest.strip_suffix(" {")) {
                module = format!("{outer}{name}::");
                places = quoted(docs).map(str::to_owned).collect();
            } else if line == "}" {
                (module, places) = (outer.clone(), Vec::new());
            } else if let Some((_, rest)) = line.split_once("pub const ") {
                let name = rest.split(':').next().expect("a name").to_owned();
                // in that of results a line may speak of two
                let is_said = before.trim_start().starts_with(['/', '#']) || file == "results";
                assert!(is_said, "{}: `{name}` has no line of its own", chapter.display());
                all.push(Declared { module: module.clone(), places: places.clone(), name });
            }
            before = line;
        }
    }
    all
}

/// The other way round: each limit of `tolerances` is in a row of "Numbers", beside a file that takes it from there, or with the place that
/// its module is for.
#[test]
fn every_limit_is_in_a_row() {
    let page = page();
    let (_, numbers) = page.split_once("\n## Numbers").expect("the numbers");
    let rows: Vec<&str> = numbers.lines().filter(|line| line.starts_with("| ")).collect();
    let all = declared();
    assert!(all.len() > 200, "only {} limits were looked at", all.len());
    for Declared { module, places, name } in all {
        let takes = |path: &str| {
            let Some(text) = place(path).and_then(|path| fs::read_to_string(path).ok()) else { return false };
            let head = format!("use crate::tolerances::{module}");
            let mut trees = text.split(&head).skip(1).filter_map(|rest| rest.split(';').next().map(str::to_owned));
            let is_declared = || text.contains(&format!("const {name}:"));
            is_declared()
                || trees
                    .any(|tree| tree.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').any(|word| word == name))
        };
        let is_told = |row: &&&str| {
            let mut words = quoted(row);
            let paths: Vec<&str> = quoted(row).filter(|word| word.contains('/') || word.contains(".rs")).collect();
            let is_for_it = |path: &&str| places.iter().any(|place| path.starts_with(place.as_str())) || takes(path);
            words.any(|word| word == name) && paths.iter().any(is_for_it)
        };
        assert!(rows.iter().find(is_told).is_some(), "`{module}{name}` is in no row");
    }
}

/// Each module of `tolerances` says for which file or folder it is.
#[test]
fn every_module_of_limits_names_its_place() {
    let mut looked_at = 0;
    let chapters = sources(&root().join("src/tolerances")).into_iter();
    for chapter in chapters.filter(|path| !path.ends_with("mod.rs")) {
        let text = fs::read_to_string(&chapter).expect("text");
        for (before, _) in text.match_indices("\npub mod ").map(|(at, _)| text.split_at(at)) {
            looked_at += 1;
            let said = before.rsplit("\n\n").next().unwrap_or_default();
            let named = quoted(said).find(|path| place(path).is_some());
            assert!(named.is_some(), "{}: {said}", chapter.display());
        }
    }
    assert!(looked_at > 40, "only {looked_at} modules were looked at");
}

/// Numbers of mathematics, which limit nothing.
const NO_LIMITS: [&str; 10] =
    ["GOLDEN", "SLOPE", "CURVATURE", "WITHIN", "ENDS", "MIDDLE", "UNIT", "UNITS", "NODES", "NOTHING"];

#[test]
fn limits_of_the_mathematics_stand_in_their_room() {
    let mut looked_at = 0;
    for room in ["analysis", "ir", "lower", "program", "solver", "structure"] {
        for file in sources(&root().join("src").join(room)) {
            looked_at += 1;
            let text = fs::read_to_string(&file).expect("text");
            for line in text.lines() {
                let Some((name, kind)) = line.split_once("const ").and_then(|(_, rest)| rest.split_once(": ")) else {
                    continue;
                };
                if !["f64", "[f64;", "[[f64;"].iter().any(|number| kind.starts_with(number)) {
                    continue;
                }
                let is_constant = is_limit(name);
                assert!(
                    !is_constant || NO_LIMITS.contains(&name),
                    "{}: `{name}` belongs to `tolerances`",
                    file.display()
                );
            }
        }
    }
    assert!(looked_at > 80, "only {looked_at} files were looked at");
}

/// Numbers with an exponent that limit nothing: units, and what a number is written in.
const NO_LIMITS_INLINE: [(&str, &str); 4] = [
    ("analysis/assemble/errors.rs", "1e3"),
    ("analysis/explain/errors/mod.rs", "1e3"),
    ("analysis/explain/errors/mod.rs", "1e-4"),
    ("analysis/explain/errors/mod.rs", "1e6"),
];

/// A limit has a name: nothing like `1e-9` stands in the middle of a formula.
#[test]
fn no_limit_of_the_mathematics_stands_inline() {
    let mut unused = NO_LIMITS_INLINE.to_vec();
    for room in ["analysis", "ir", "lower", "program", "solver", "structure"] {
        for file in sources(&root().join("src").join(room)) {
            let text = fs::read_to_string(&file).expect("text");
            let inside = file.strip_prefix(root().join("src")).expect("below src").display().to_string();
            let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
            for line in code.lines().map(|line| line.split("//").next().unwrap_or_default()) {
                let words = line.split(|c: char| !c.is_ascii_alphanumeric() && !"_.-".contains(c));
                let is_number = |word: &&str| {
                    let (head, power) = word.split_once('e').unwrap_or_default();
                    let is_of = |text: &str, others: &str| {
                        !text.is_empty() && text.chars().all(|c| c.is_ascii_digit() || others.contains(c))
                    };
                    is_of(head, "._") && is_of(power, "-")
                };
                for number in words.filter(is_number) {
                    let known = unused.iter().position(|(place, known)| *place == inside && *known == number);
                    let is_known = NO_LIMITS_INLINE.contains(&(inside.as_str(), number));
                    assert!(is_known, "{inside}: `{number}` in `{}` belongs to `tolerances`", line.trim());
                    known.map(|at| unused.remove(at));
                }
            }
        }
    }
    assert!(unused.is_empty(), "{unused:?} are there no more, and go from the list");
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] }).collect()
}
