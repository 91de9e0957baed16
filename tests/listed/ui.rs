//! Small inputs, each with its diagnostics: the marker `//~ CODE` stands on every line that a primary label begins on (or,
//! where that is in another file, the first label in this one), and the whole text is in the snapshot beside the input, under the text
//! it speaks of. `cargo test --test listed gear` runs those with `gear` in their folder or name.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::named_tests::Tests;
use crate::support::{Outcome, Span as Times, files, run_in, stem};
use mechc::Span;
use std::fs;
use std::path::Path;

/// `(line, code)` of every marker.
fn markers(text: &str) -> Vec<(usize, String)> {
    text.lines()
        .enumerate()
        .filter_map(|(k, line)| line.split_once("//~ ").map(|(_, codes)| (k, codes)))
        .flat_map(|(k, codes)| codes.split_whitespace().map(move |code| (k + 1, code.to_owned())))
        .collect()
}

/// `(line, code)` of every diagnostic that has a place.
fn places(outcome: &Outcome) -> Vec<(usize, String)> {
    let mut places: Vec<(usize, String)> = outcome
        .diagnostics
        .iter()
        .filter(|diagnostic| diagnostic.severity() != mechc::Severity::Note)
        .filter_map(|diagnostic| {
            let here = |span: Span| outcome.sources.get(span.file).name.contains(".mech");
            let span = diagnostic.labels.iter().map(|label| label.span).find(|span| here(*span))?;
            let (line, _) = outcome.sources.get(span.file).position(span.start);
            Some((line, diagnostic.code.to_string()))
        })
        .collect();
    places.sort();
    places
}

fn gets_its_diagnostics(path: &Path) {
    let text = fs::read_to_string(path).expect("a text");
    let name = path.file_name().expect("a name").to_string_lossy().into_owned();
    let folder = path.parent().expect("a folder");
    let outcome = run_in(folder, &name, &text, Times::default());
    let wanted = markers(&text);
    if folder.ends_with("ok") {
        assert!(outcome.diagnostics.is_empty(), "it is valid:\n{}", outcome.text());
        return;
    }
    assert!(!outcome.diagnostics.is_empty(), "it has a mistake, and nothing was said");
    let notes_alone = outcome.diagnostics.iter().all(|diagnostic| diagnostic.severity() == mechc::Severity::Note);
    if wanted.is_empty() && !notes_alone {
        assert_eq!(outcome.codes(), ["E0104"], "it has no marker, though it is not empty");
    } else {
        assert_eq!(places(&outcome), wanted, "{}", outcome.text());
    }
    insta::with_settings!({ snapshot_path => folder, prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!(stem(path), both(&text, &outcome));
    });
}

/// The text with what is said of it: a reviewer opens one file.
fn both(text: &str, outcome: &Outcome) -> String {
    format!("{}\n{RULE}\n\n{}", text.trim_end(), outcome.text())
}

/// Between a text and what is said of it.
const RULE: &str = "────────────────────────────────────────────────────────────";

/// Lists the tests of this file.
pub fn list(tests: &mut Tests) {
    let list = files("tests/ui", "mech").into_iter();
    let group = |path: &Path| stem(path.parent().expect("a folder"));
    let list = list.map(|path| (format!("{}::{}", group(&path), stem(&path)), path));
    tests.each("ui", list, 340, |path| gets_its_diagnostics(&path));
}
