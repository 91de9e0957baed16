//! Sessions as a user types them, each file by its name: those of `tests/cli`, of the README, of `docs` and of the pages of codes. And
//! what else stands in a page between fences is what it says it is. `cargo test --test listed README` runs those of one.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::named_tests::Tests;
use crate::support::blocks::blocks;
use crate::support::{Span, files, run, stem};
use std::fs;
use std::path::{Path, PathBuf};

/// Pages beside `docs`.
const PAGES: [&str; 1] = ["README.md"];

/// Blocks of `text` that nobody can hold to anything: timings of one machine.
const TIMINGS: &str = "speed";

fn has_sessions(path: &Path) -> bool {
    let text = fs::read_to_string(path).expect("a text");
    path.extension().is_some_and(|ending| ending == "trycmd") || text.contains("```console\n")
}

fn prints_what_it_says(path: &Path) {
    trycmd::TestCases::new().case(path);
}

/// Every block is of a kind that is held to something.
fn has_blocks_that_hold(path: &Path) {
    let text = fs::read_to_string(path).expect("a page");
    for (language, block) in blocks(&text) {
        match language.as_str() {
            // sessions are run; commands of the shell and code for a crate of one's own have no output here
            // the tests of the Python package run those of the README and of the guide, but for what asks for more machines
            "console" | "sh" | "rust,ignore" | "c" | "python" | "pycon" | "python,no-run" => {}
            "mech" => is_a_mechanism(&block, stem(path) == LANGUAGE || block.starts_with(USES_AN_EXAMPLE)),
            "text" => assert!(stem(path) == TIMINGS && !block.contains('$'), "nobody runs this `text`:\n{block}"),
            _ => panic!("a block of `{language}`:\n{block}"),
        }
    }
}

/// The page of the language has mechanisms of its own, one for each construct.
const LANGUAGE: &str = "language";

/// So has who shows what can be made of an example.
const USES_AN_EXAMPLE: &str = "use \"examples/";

/// An example, to the letter, or at least without a fault.
fn is_a_mechanism(block: &str, may_be_its_own: bool) {
    let outcome = run("block.mech", block, Span::default()).expect_success();
    assert!(!outcome.rows.is_empty(), "no rows of:\n{block}");
    let is_example = files("examples", "mech").iter().any(|path| fs::read_to_string(path).expect("a text") == block);
    assert!(is_example || may_be_its_own, "this is no file of `examples`:\n{block}");
}

/// Lists the tests of this file.
pub fn list(tests: &mut Tests) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let pages: Vec<PathBuf> = PAGES.iter().map(|page| root.join(page)).chain(files("docs", "md")).collect();
    let named = |list: Vec<PathBuf>| list.into_iter().map(|path| (stem(&path), path)).collect::<Vec<_>>();
    let with_sessions = |list: Vec<PathBuf>| named(list.into_iter().filter(|path| has_sessions(path)).collect());
    tests.each("sessions", with_sessions(files("tests/cli", "trycmd")), 8, |path| prints_what_it_says(&path));
    tests.each("sessions", with_sessions(pages.clone()), 3, |path| prints_what_it_says(&path));
    tests.each("sessions", with_sessions(files("crates/text/src/diag/explain", "md")), 5, |path| {
        prints_what_it_says(&path);
    });
    tests.each("blocks", named(pages), 5, |path| has_blocks_that_hold(&path));
}
