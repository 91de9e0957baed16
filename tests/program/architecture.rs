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
    const HEAD: &str = "\n| limit | value | meaning |\n| --- | --- | --- |\n";
    let mut text = "# Limits\n\nTolerances and caps of the mathematics, in SI units where nothing else is said. A limit bounds what is accepted, or how long \
        something is tried; each stands in one place of the code. \"Scaled\" means lengths in sizes of their body, angles in radians, rows of Φ divided by \
        their norm. A \"span\" is the time from the first to the last output time.\n\nThe list is generated: `UPDATE_GOLDENS=1 cargo test --test program \
        architecture` writes it.\n"
        .to_owned();
    let mut unused = numbers_that_limit_nothing();
    for file in files_with_limits() {
        let name = inside(&file);
        let (mut docs, mut module, mut is_open, mut has_heading) = (Vec::new(), None, false, false);
        for line in fs::read_to_string(&file).expect("text").lines() {
            if let Some(doc) = line.trim().strip_prefix("///") {
                docs.push(doc.trim().to_owned());
                continue;
            }
            if let Some((name, _)) = line.strip_prefix("pub mod ").and_then(|rest| rest.split_once(" {")) {
                module = Some((name.to_owned(), docs.join(" ")));
                is_open = false;
            } else if let Some((constant, value)) = limit(line, module.is_some()) {
                let known = unused.iter().position(|known| *known == (name.as_str(), constant));
                if known.map(|at| unused.remove(at)).is_none() {
                    if !has_heading {
                        text += &format!("\n## `{name}`\n");
                        has_heading = true;
                    }
                    if !is_open {
                        let about = module.iter().map(|(name, about)| format!("\n`{name}`: {about}\n"));
                        text += &about.collect::<String>();
                        text += HEAD;
                        is_open = true;
                    }
                    let value = value.strip_suffix(';').expect("a limit is declared on one line");
                    assert!(!docs.is_empty(), "{name}: `{constant}` has no documentation");
                    text += &format!("| `{constant}` | `{value}` | {} |\n", docs.join(" ").replace('|', "\\|"));
                }
            } else if line == "}" {
                module = None;
            }
            if !line.trim().starts_with("#[") {
                docs.clear();
            }
        }
    }
    assert!(unused.is_empty(), "{unused:?} are there no more, and go from the list");
    text
}

/// The name and the value of a number that a line declares, at its margin or in a module.
fn limit(line: &str, is_in_module: bool) -> Option<(&str, &str)> {
    let line = if is_in_module { line.trim_start() } else { line };
    let line = ["pub(crate) ", "pub(super) ", "pub "].iter().find_map(|rank| line.strip_prefix(rank)).unwrap_or(line);
    let (name, rest) = line.strip_prefix("const ")?.split_once(": ")?;
    let (kind, value) = rest.split_once(" = ")?;
    let is_number = ["f64", "[f64;", "[[f64;", "usize", "u32", "u64", "[u32;"].iter().any(|of| kind.starts_with(of));
    (is_limit(name) && is_number).then_some((name, value))
}

/// The name of a file within the repository.
fn inside(file: &Path) -> String {
    file.strip_prefix(root()).expect("below the root").display().to_string()
}

/// Where limits stand: those of several files or crates in `limits.rs`, all others at the top of their file.
fn files_with_limits() -> Vec<PathBuf> {
    let crates = fs::read_dir(root().join("crates")).expect("the folder").map(|entry| entry.expect("an entry").path());
    let shared = crates.map(|folder| folder.join("src/limits.rs")).filter(|file| file.exists());
    let mut all: Vec<PathBuf> = mathematics().into_iter().chain(shared).collect();
    all.sort();
    all.dedup();
    all
}

#[test]
fn the_page_of_limits_is_that_of_the_constants() {
    golden::holds("docs/limits.md", &limits());
}

/// Where the mathematics stands that has limits.
const MATHEMATICS: [&str; 4] =
    ["crates/engine/src", "crates/ir/src", "crates/lang/src/estimates.rs", "crates/lang/src/lower"];

fn mathematics() -> Vec<PathBuf> {
    let all = MATHEMATICS.iter().map(|place| root().join(place));
    all.flat_map(|place| if place.is_dir() { sources(&place) } else { vec![place] }).collect()
}

/// Numbers of mathematics, which limit nothing: places and weights of rules, counts that follow from something else, and what stands for none.
const NO_LIMITS: [(&str, &[&str]); 15] = [
    ("crates/engine/src/analysis/follow/crossing/refined_bridge.rs", &["CONDITIONS"]),
    ("crates/engine/src/analysis/follow/crossing/singular_times.rs", &["SLOPE", "CURVATURE"]),
    ("crates/engine/src/analysis/follow/follower/ill_conditioned_rows.rs", &["NOTHING"]),
    ("crates/engine/src/analysis/results/curve.rs", &["VARIED_ORDERS"]),
    ("crates/engine/src/analysis/results/quadrature.rs", &["WITHIN", "ENDS", "MIDDLE"]),
    ("crates/engine/src/analysis/state/determinant.rs", &["UNIT", "UNITS"]),
    ("crates/engine/src/analysis/state/equilibration.rs", &["NONE"]),
    ("crates/engine/src/solver/lanes.rs", &["CHUNK"]),
    ("crates/engine/src/solver/optimize.rs", &["NONE"]),
    ("crates/engine/src/solver/variants.rs", &["NOT_KEPT"]),
    ("crates/engine/src/sweep/batch/mod.rs", &["CHUNK"]),
    ("crates/engine/src/sweep/batch/row_collector.rs", &["TILE"]),
    ("crates/engine/src/sweep/sobol.rs", &["MAX_DIMENSIONS", "BITS"]),
    ("crates/ir/src/program/mod.rs", &["ORDERS"]),
    ("crates/ir/src/structure/matching.rs", &["NONE"]),
];

/// `NO_LIMITS`, one by one.
fn numbers_that_limit_nothing() -> Vec<(&'static str, &'static str)> {
    NO_LIMITS.iter().flat_map(|(file, names)| names.iter().map(|name| (*file, *name))).collect()
}

/// Within functions, these are places at which a polynomial is taken.
const NO_LIMITS_WITHIN: [&str; 1] = ["NODES"];

/// What limits the mathematics stands at the margin, where the page of limits finds it, and not within a function.
#[test]
fn limits_of_the_mathematics_stand_in_their_place() {
    let mut looked_at = 0;
    for file in mathematics().into_iter().filter(|file| !file.ends_with("limits.rs")) {
        looked_at += 1;
        let text = fs::read_to_string(&file).expect("text");
        for line in text.lines().filter(|line| line.starts_with(' ')) {
            let Some((name, kind)) = line.split_once("const ").and_then(|(_, rest)| rest.split_once(": ")) else {
                continue;
            };
            if !["f64", "[f64;", "[[f64;"].iter().any(|number| kind.starts_with(number)) {
                continue;
            }
            let is_known = NO_LIMITS_WITHIN.contains(&name);
            assert!(!is_limit(name) || is_known, "{}: `{name}` belongs to the top of the file", file.display());
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
        let inside = inside(&file);
        let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
        let formulas = code.lines().filter(|line| limit(line, true).is_none());
        for line in formulas.map(|line| line.split("//").next().unwrap_or_default()) {
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
                assert!(is_known, "{inside}: `{number}` in `{}` needs a name at the top of the file", line.trim());
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
