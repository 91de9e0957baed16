//! Small inputs, each with its diagnostics: the marker `//~ CODE` stands on every line that a primary label begins on (or,
//! where that is in another file, the first label in this one), and the whole text is in the snapshot beside the input.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod support;

use mechc::Span;
use std::fs;
use std::path::Path;
use support::{Outcome, Span as Times, files, run_in, stem};

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

fn check_file(path: &Path) {
    let text = fs::read_to_string(path).expect("a text");
    let name = path.file_name().expect("a name").to_string_lossy().into_owned();
    let folder = path.parent().expect("a folder");
    let outcome = run_in(folder, &name, &text, Times::default());
    let wanted = markers(&text);
    let where_ = path.display();
    if folder.ends_with("ok") {
        assert!(outcome.diagnostics.is_empty(), "{where_} is valid:\n{}", outcome.text());
        return;
    }
    assert!(!outcome.diagnostics.is_empty(), "{where_} has a mistake, and nothing was said");
    if wanted.is_empty() {
        assert_eq!(outcome.codes(), ["E0104"], "{where_} has no marker, though it is not empty");
    } else {
        assert_eq!(places(&outcome), wanted, "{where_}:\n{}", outcome.text());
    }
    insta::with_settings!({ snapshot_path => folder, prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!(stem(path), outcome.text());
    });
}

#[test]
fn every_input_gets_its_diagnostics() {
    let failed: Vec<String> = files("tests/ui", "mech")
        .iter()
        .filter_map(|path| {
            let result = std::panic::catch_unwind(|| check_file(path));
            result.err().map(|error| {
                let text = error.downcast_ref::<String>().cloned().unwrap_or_else(|| "failed".to_owned());
                format!("{}: {text}", path.display())
            })
        })
        .collect();
    assert!(failed.is_empty(), "{} inputs:\n{}", failed.len(), failed.join("\n"));
}
