//! What each stage of the compiler sees of a mechanism: a folder per mechanism with its text and the snapshots.
//! `cargo test --test listed gears` runs one of them.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::named_tests::Tests;
use crate::support::{Span, files, run, stem};
use mechc::{Choice, Memory, Parsed};
use std::fmt::Write;
use std::fs;
use std::path::Path;

fn every_stage_is_as_in_its_snapshot(path: &Path) {
    let folder = path.parent().expect("a folder");
    let name = stem(folder);
    let text = fs::read_to_string(path).expect("a text");
    let parsed = Parsed::new(&name, &text);
    let checked = parsed.check(&Choice::default(), &Memory::default());
    assert!(checked.diagnostics().is_empty(), "{name}");
    let rows = run(&name, &text, Span::default()).expect_success();
    let mut first_rows = rows.columns.join(",") + "\n";
    for row in rows.rows.iter().take(3) {
        let cells: Vec<String> = row.iter().map(f64::to_string).collect();
        writeln!(first_rows, "{}", cells.join(",")).expect("a string takes everything");
    }
    insta::with_settings!({ snapshot_path => folder, prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!("ast", parsed.formatted().expect("a text without faults"));
        insta::assert_snapshot!("model", checked.model_text().expect("sound"));
        insta::assert_snapshot!("ir", checked.equations_text().expect("sound"));
        insta::assert_snapshot!("run", first_rows);
    });
}

/// Lists the tests of this file.
pub fn list(tests: &mut Tests) {
    let list = files("tests/stages", "mech").into_iter();
    let list = list.map(|path| (stem(path.parent().expect("a folder")), path));
    tests.each("stages", list, 7, |path| every_stage_is_as_in_its_snapshot(&path));
}
