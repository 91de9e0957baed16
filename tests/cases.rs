//! Reference answers, computed elsewhere to 20 digits: `tests/cases/NAME.mech` with `NAME.csv`; where a file holds several
//! mechanisms, with `NAME.MECHANISM.csv`.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod support;

use std::fs;
use std::path::{Path, PathBuf};
use support::{Outcome, Span, files, mechanisms, run, run_number, stem};

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
    assert_eq!(got.columns, want.columns, "{name}: the columns");
}

fn nearest(got: &Outcome, t: f64) -> usize {
    let off = |row: &Vec<f64>| (row[0] - t).abs();
    let (at, row) = got.rows.iter().enumerate().min_by(|a, b| off(a.1).total_cmp(&off(b.1))).expect("rows");
    assert!(off(row) < 1e-9 * (1.0 + t.abs()), "no row for t = {t}");
    at
}

/// A mechanism with its reference.
struct Case {
    name: String,
    path: PathBuf,
    text: String,
    /// Its number in the file.
    number: usize,
    want: Table,
}

impl Case {
    fn run(&self, span: Span) -> Outcome {
        run_number(&self.path, &self.text, self.number, span).expect_success()
    }
}

fn cases() -> impl Iterator<Item = Case> {
    files("tests/cases", "mech").into_iter().flat_map(|path| {
        let text = fs::read_to_string(&path).expect("a text");
        let names = mechanisms(&text);
        let several = names.len() > 1;
        let case = move |(number, mechanism): (usize, String)| {
            let name = if several { format!("{}.{mechanism}", stem(&path)) } else { stem(&path) };
            let want = read(&path.with_file_name(format!("{name}.csv")));
            Case { name, path: path.clone(), text: text.clone(), number, want }
        };
        names.into_iter().enumerate().map(case).collect::<Vec<Case>>()
    })
}

#[test]
fn all_match_their_reference() {
    let mut count = 0;
    for case in cases() {
        let name = &case.name;
        let tolerance = COARSER.iter().find(|(coarse, _)| *coarse == name).map_or(1e-9, |(_, tolerance)| *tolerance);
        let got = case.run(Span::default());
        assert_eq!(got.rows.len(), case.want.rows.len() + usize::from(name == "functions"), "{name}: the rows");
        compare(name, &got, &case.want, tolerance);
        count += 1;
    }
    assert!(count >= 55, "only {count} cases");
}

#[test]
fn ten_times_larger_output_steps_give_the_same_numbers() {
    for case in cases() {
        let name = &case.name;
        let fine = case.run(Span::default());
        let times = fine.column("t");
        let step = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
        let coarse = case.run(Span { every: Some(10.0 * step), to: None });
        assert!(coarse.rows.len() >= fine.rows.len() / 10, "{name}");
        for row in &coarse.rows {
            let same = &fine.rows[nearest(&fine, row[0])];
            for ((a, b), column) in row.iter().zip(same).zip(&fine.columns) {
                let size = fine.column(column).iter().fold(0.0, |m: f64, v| m.max(v.abs()));
                let tolerance = if *name == "far_away" { 2e-8 } else { 1e-9 };
                assert!((a - b).abs() <= tolerance * (1.0 + size), "{name}: {column} at t = {}: {a} and {b}", row[0]);
            }
        }
    }
}

#[test]
fn examples_run_without_a_word() {
    let examples = files("examples", "mech");
    assert!(examples.len() >= 15);
    for path in examples {
        let text = fs::read_to_string(&path).expect("a text");
        assert!(text.starts_with("///"), "{} says what it is", path.display());
        let got = run(&path.display().to_string(), &text, Span::default());
        assert!(got.diagnostics.is_empty(), "{}: {}", path.display(), got.text());
        assert!(got.rows.len() > 20, "{}", path.display());
    }
}
