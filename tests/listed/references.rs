//! Reference answers, computed elsewhere to 20 digits: `tests/cases/NAME.mech` with `NAME.csv`; where a file holds several
//! mechanisms, with `NAME.MECHANISM.csv`. `cargo test --test listed four_bar` runs one of them. Those of `tests/cases_composed`, and of
//! `tests/cases_forces`, which have forces, are run by the command line, with the options of their first line, `// run: …`;
//! `NAME.results.json` has their results. Those of `tests/forces` have references of forces alone, by hand (`tests/forces/README.md`).

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::named_tests::Tests;
use crate::support::{Outcome, Span, files, mechanisms, run, run_number, stem};
use assert_cmd::Command;
use std::fs;
use std::path::{Path, PathBuf};

/// What the size of its coordinates leaves of a case's digits: 1e6 m is known to 1e-10 m.
const COARSER: &[(&str, f64)] = &[("far_away", 2e-8)];

struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

fn read(path: &Path) -> Table {
    let text = fs::read_to_string(path).expect("a table");
    let mut lines = text.lines();
    let columns = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    let rows = lines.map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect()).collect();
    Table { columns, rows }
}

/// Every column and time of `want` is in `got`, to `tolerance` times one plus the largest value of the column; and no other column, but for
/// the directions of lines of centres.
fn compare_all(name: &str, got: &Outcome, want: &Table, tolerance: f64) {
    compare(name, got, want, tolerance);
    let has_directions = want.columns.iter().any(|column| column.contains(".theta"));
    let columns = got.columns.iter().filter(|column| has_directions || !column.contains(".theta"));
    assert_eq!(columns.collect::<Vec<_>>(), want.columns.iter().collect::<Vec<_>>(), "{name}: the columns");
}

/// Every column and time of `want` is in `got`, to `tolerance` times one plus the largest value of the column.
fn compare(name: &str, got: &Outcome, want: &Table, tolerance: f64) {
    for (k, column) in want.columns.iter().enumerate() {
        let values = got.column(column);
        let size = want.rows.iter().map(|row| row[k].abs()).fold(0.0, f64::max);
        for row in &want.rows {
            let at = nearest(got, row[0]);
            let error = (values[at] - row[k]).abs();
            assert!(
                error <= tolerance * (1.0 + size),
                "{name}: {column} at t = {}: {} instead of {}, off by {error:e}",
                row[0],
                values[at],
                row[k]
            );
        }
    }
}

fn nearest(got: &Outcome, t: f64) -> usize {
    let off = |row: &Vec<f64>| (row[0] - t).abs();
    let (at, row) = got.rows.iter().enumerate().min_by(|a, b| off(a.1).total_cmp(&off(b.1))).expect("rows");
    assert!(off(row) < 1e-9 * (1.0 + t.abs()), "no row for t = {t}");
    at
}

/// A mechanism with a reference.
struct Case {
    name: String,
    path: PathBuf,
    /// Its number in the file.
    number: usize,
}

impl Case {
    fn run(&self, span: Span) -> Outcome {
        let text = fs::read_to_string(&self.path).expect("a text");
        run_number(&self.path, &text, self.number, span).expect_success()
    }

    /// What is left of its digits.
    fn tolerance(&self) -> f64 {
        COARSER.iter().find(|(coarse, _)| *coarse == self.name).map_or(1e-9, |(_, tolerance)| *tolerance)
    }
}

fn cases() -> impl Iterator<Item = (String, Case)> {
    files("tests/cases", "mech").into_iter().flat_map(|path| {
        let names = mechanisms(&fs::read_to_string(&path).expect("a text"));
        let several = names.len() > 1;
        let case = move |(number, mechanism): (usize, String)| {
            let name = if several { format!("{}.{mechanism}", stem(&path)) } else { stem(&path) };
            (name.clone(), Case { name, path: path.clone(), number })
        };
        names.into_iter().enumerate().map(case).collect::<Vec<_>>()
    })
}

fn matches_its_reference(case: &Case) {
    let want = read(&case.path.with_file_name(format!("{}.csv", case.name)));
    let got = case.run(Span::default());
    assert_eq!(got.rows.len(), want.rows.len() + usize::from(case.name == "functions"), "the rows");
    compare_all(&case.name, &got, &want, case.tolerance());
}

fn has_the_same_numbers_at_ten_times_larger_output_steps(case: &Case) {
    let fine = case.run(Span::default());
    let times = fine.column("t");
    let step = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let coarse = case.run(Span { every: Some(10.0 * step), to: None });
    assert!(coarse.rows.len() >= fine.rows.len() / 10);
    for row in &coarse.rows {
        let same = &fine.rows[nearest(&fine, row[0])];
        for ((a, b), column) in row.iter().zip(same).zip(&fine.columns) {
            let size = fine.column(column).iter().fold(0.0, |m: f64, v| m.max(v.abs()));
            let error = (a - b).abs();
            assert!(error <= case.tolerance() * (1.0 + size), "{column} at t = {}: {a} and {b}", row[0]);
        }
    }
}

fn runs_without_a_word(example: &Path) {
    let text = fs::read_to_string(example).expect("a text");
    let mut lines = text.lines().skip_while(|line| line.is_empty() || line.starts_with("use "));
    assert!(lines.next().is_some_and(|line| line.starts_with("///")), "it says what it is");
    let got = run(&example.display().to_string(), &text, Span::default());
    assert!(got.diagnostics.is_empty(), "{}", got.text());
    assert!(got.rows.len() > 20, "{} rows", got.rows.len());
}

/// What the command line prints for a mechanism with the options of its first line.
fn told_by_the_command_line(path: &Path) -> (Outcome, PathBuf, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    let outputs = ["table.csv", "results.json"].map(|name| folder.path().join(name));
    let text = fs::read_to_string(path).expect("a text");
    let options = text.lines().next().and_then(|line| line.strip_prefix("// run: ")).unwrap_or_default();
    let mut mechc = Command::new(env!("CARGO_BIN_EXE_mechc"));
    mechc.current_dir(path.parent().expect("a folder")).args(["run", &format!("{}.mech", stem(path))]);
    mechc.args(options.split_whitespace()).arg("-o").arg(&outputs[0]).arg("--results").arg(&outputs[1]);
    mechc.assert().success();
    let Table { columns, rows } = read(&outputs[0]);
    let (diagnostics, sources) = Default::default();
    let [_, results] = outputs;
    (Outcome { sources, diagnostics, columns, rows }, results, folder)
}

/// It has every number of its reference, to 1e-9, and of its results.
fn is_told_by_the_command_line(path: &Path) {
    let (got, results, _folder) = told_by_the_command_line(path);
    let want = read(&path.with_extension("csv"));
    assert_eq!(got.rows.len(), want.rows.len(), "the rows");
    compare_all(&stem(path), &got, &want, 1e-9);
    let text = fs::read_to_string(path).expect("a text");
    let wanted = path.with_extension("results.json");
    assert!(wanted.exists() || !text.contains("result "), "its results have no reference");
    if wanted.exists() {
        compare_results(&numbers(&results), &numbers(&wanted));
    }
}

/// It has the forces that were found by hand.
fn has_the_forces_of_newton_and_euler(path: &Path) {
    let (got, ..) = told_by_the_command_line(path);
    let want = read(&path.with_extension("csv"));
    assert_eq!(got.rows.len(), want.rows.len(), "the rows");
    compare(&stem(path), &got, &want, 1e-9);
}

fn numbers(path: &Path) -> serde_json::Map<String, serde_json::Value> {
    serde_json::from_str(&fs::read_to_string(path).expect("results")).expect("one flat object")
}

fn compare_results(
    got: &serde_json::Map<String, serde_json::Value>,
    want: &serde_json::Map<String, serde_json::Value>,
) {
    assert_eq!(got.keys().collect::<Vec<_>>(), want.keys().collect::<Vec<_>>(), "the results");
    for (name, value) in want {
        let [got, want] = [&got[name], value].map(|value| value.as_f64().expect("a number"));
        assert!((got - want).abs() <= 1e-9 * (1.0 + want.abs()), "{name}: {got} instead of {want}");
    }
}

/// Lists the tests of this file.
pub fn list(tests: &mut Tests) {
    let of = |folder: &str| files(folder, "mech").into_iter().map(|path| (stem(&path), path)).collect::<Vec<_>>();
    tests.each("reference", cases(), 55, |case| matches_its_reference(&case));
    tests.each("coarse_steps", cases(), 55, |case| has_the_same_numbers_at_ten_times_larger_output_steps(&case));
    tests.each("composed", of("tests/cases_composed"), 5, |path| is_told_by_the_command_line(&path));
    tests.each("forces", of("tests/cases_forces"), 4, |path| is_told_by_the_command_line(&path));
    tests.each("by_hand", of("tests/forces"), 24, |path| has_the_forces_of_newton_and_euler(&path));
    tests.each("example", of("examples"), 20, |path| runs_without_a_word(&path));
}
