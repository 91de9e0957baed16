//! What `ARCHITECTURE.md` names is there: files, tests, constants.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

use crate::support::golden;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// What stands between backticks.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// Where a path of the page leads, if anywhere.
fn place(path: &str) -> Option<PathBuf> {
    Some(root().join(path)).filter(|path| path.exists())
}

fn is_word(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// The pages whose paths are checked.
fn pages_with_paths() -> Vec<PathBuf> {
    let dev = fs::read_dir(root().join("docs/dev")).expect("the folder").map(|entry| entry.expect("an entry").path());
    let others = ["ARCHITECTURE.md", "CONTRIBUTING.md", "docs/limits.md"].map(|page| root().join(page));
    dev.chain(others).collect()
}

#[test]
fn every_path_exists() {
    let mut visited = 0;
    for page in pages_with_paths() {
        for path in quoted(&fs::read_to_string(&page).expect("the page")) {
            let is_path = path.contains('/') && path.chars().all(|c| c.is_ascii_alphanumeric() || "_-./".contains(c));
            // a placeholder
            let is_pattern = ["NAME", "AREA", "CODE", "FILE"].iter().any(|part| path.contains(part));
            let is_of_repository = ["crates/", "src/", "tests/", "docs/", "editors/", "python/", ".ci/", "page/"]
                .iter()
                .any(|folder| path.starts_with(folder));
            if is_path && is_of_repository && !is_pattern {
                visited += 1;
                assert!(place(path).is_some(), "{}: `{path}` does not exist", page.display());
            }
        }
    }
    assert!(visited > 150, "only {visited} paths were visited");
}

fn is_limit(word: &str) -> bool {
    is_word(word) && word.chars().all(|c| c.is_ascii_uppercase() || c == '_')
}

#[test]
fn pages_for_newcomers_are_short() {
    for (page, most) in [("ARCHITECTURE.md", 12_000), ("README.md", 10_000), ("CONTRIBUTING.md", 8_000)] {
        let length = fs::read_to_string(root().join(page)).expect("the page").len();
        assert!(length <= most, "{page} has {length} bytes, more than {most}");
    }
}

/// All limits as a page of the documentation: by file and module, with their values and meanings.
fn limits() -> String {
    let mut text = "# Limits\n\nTolerances and caps of the mathematics, in SI units where nothing else is said. A limit bounds what is accepted, or how long \
        something is tried; each stands in one place of the code.\n\nThe list is generated: `UPDATE_GOLDENS=1 cargo test --test program architecture` writes it.\n"
        .to_owned();
    let mut files = sources(&root().join(LIMITS));
    files.sort();
    for file in files {
        let name = file.strip_prefix(root()).expect("below the root").display().to_string();
        text += &format!("\n## `{name}`\n");
        let (mut docs, mut is_open) = (Vec::new(), false);
        for line in fs::read_to_string(&file).expect("text").lines() {
            let line = line.trim();
            if let Some(doc) = line.strip_prefix("///") {
                docs.push(doc.trim().to_owned());
            } else if let Some(module) = line.strip_prefix("pub mod ").and_then(|rest| rest.strip_suffix(" {")) {
                text +=
                    &format!("\n`{module}`: {}\n\n| limit | value | meaning |\n| --- | --- | --- |\n", docs.join(" "));
                (docs, is_open) = (Vec::new(), true);
            } else if let Some((name, rest)) = line.strip_prefix("pub const ").and_then(|rest| rest.split_once(": ")) {
                if !is_open {
                    text += "\n| limit | value | meaning |\n| --- | --- | --- |\n";
                    is_open = true;
                }
                let value = rest.split_once(" = ").map_or(rest, |(_, value)| value.trim_end_matches(';'));
                assert!(!docs.is_empty(), "{}: `{name}` has no documentation", file.display());
                text += &format!("| `{name}` | `{value}` | {} |\n", docs.join(" ").replace('|', "\\|"));
                docs.clear();
            } else if !line.starts_with("#[") {
                docs.clear();
            }
        }
    }
    text
}

/// Where limits stand.
const LIMITS: &str = "crates/ir/src/tolerances";

#[test]
fn the_page_of_limits_is_that_of_the_constants() {
    golden::holds("docs/limits.md", &limits());
}

/// Where the mathematics stands that has limits.
const MATHEMATICS: [&str; 5] = [
    "crates/engine/src/analysis",
    "crates/ir/src",
    "crates/lang/src/lower",
    "crates/engine/src/solver",
    "crates/engine/src/sweep",
];

fn mathematics() -> Vec<PathBuf> {
    let all = MATHEMATICS.iter().flat_map(|folder| sources(&root().join(folder)));
    all.filter(|path| !path.starts_with(root().join(LIMITS))).collect()
}

/// Numbers of mathematics, which limit nothing.
const NO_LIMITS: [&str; 10] =
    ["GOLDEN", "SLOPE", "CURVATURE", "WITHIN", "ENDS", "MIDDLE", "UNIT", "UNITS", "NODES", "NOTHING"];

#[test]
fn limits_of_the_mathematics_stand_in_their_place() {
    let mut looked_at = 0;
    for file in mathematics() {
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
            assert!(!is_constant || NO_LIMITS.contains(&name), "{}: `{name}` belongs to `tolerances`", file.display());
        }
    }
    assert!(looked_at > 80, "only {looked_at} files were looked at");
}

/// Numbers with an exponent that limit nothing: units, and what a number is written in.
const NO_LIMITS_INLINE: [(&str, &str); 4] = [
    ("crates/engine/src/analysis/assemble/errors.rs", "1e3"),
    ("crates/engine/src/analysis/explain/errors/mod.rs", "1e3"),
    ("crates/engine/src/analysis/explain/errors/mod.rs", "1e-4"),
    ("crates/engine/src/analysis/explain/errors/mod.rs", "1e6"),
];

/// A limit has a name: nothing like `1e-9` stands in the middle of a formula.
#[test]
fn no_limit_of_the_mathematics_stands_inline() {
    let mut unused = NO_LIMITS_INLINE.to_vec();
    for file in mathematics() {
        let text = fs::read_to_string(&file).expect("text");
        let inside = file.strip_prefix(root()).expect("below the root").display().to_string();
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
    assert!(unused.is_empty(), "{unused:?} are there no more, and go from the list");
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    entries.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] }).collect()
}
