//! The pipeline as tests use it: a text in, diagnostics and rows out.

#![allow(dead_code)] // each test file uses its part

pub mod reading;
pub mod shape;
pub mod tex;

use mechc::analysis::{self, Times};
use mechc::check::Surroundings;
use mechc::diag::{Color, Diagnostic, Diagnostics, Format, Severity, render};
use mechc::program::Program;
use mechc::source::Sources;
use mechc::structure::Determined;
use mechc::syntax::ast::{ItemKind, Mechanism, TableRows};
use mechc::{check, syntax};
use std::path::{Path, PathBuf};

/// What became of a text.
pub struct Outcome {
    pub sources: Sources,
    pub diagnostics: Diagnostics,
    pub columns: Vec<String>,
    pub rows: Vec<Vec<f64>>,
}

/// Which times to compute; those of the file where nothing is said.
#[derive(Clone, Copy, Default)]
pub struct Span {
    pub to: Option<f64>,
    pub every: Option<f64>,
}

impl Outcome {
    /// Whether nothing went wrong.
    pub fn succeeded(&self) -> bool {
        !self.diagnostics.has_errors()
    }

    /// The diagnostics as a user reads them.
    pub fn text(&self) -> String {
        self.diagnostics.iter().map(|d| render(d, &self.sources, Format::Human, Color::Never)).collect()
    }

    /// Fails with the diagnostics unless nothing went wrong.
    pub fn expect_success(self) -> Outcome {
        assert!(self.succeeded(), "{}", self.text());
        self
    }

    /// The codes, in order.
    pub fn codes(&self) -> Vec<&'static str> {
        self.diagnostics.iter().map(|d| d.code.as_str()).collect()
    }

    /// A column by its name.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let at = self.columns.iter().position(|column| column == name);
        let at = at.unwrap_or_else(|| panic!("no column {name} in {:?}", self.columns));
        self.rows.iter().map(|row| row[at]).collect()
    }
}

/// Checks and proves the first mechanism of a text.
pub fn compile(sources: &mut Sources, name: &str, text: &str) -> (Option<Determined>, Diagnostics) {
    compile_at(sources, name, text, Path::new(name), 0)
}

/// Checks and proves a mechanism of a text that is in a file, by its number.
pub fn compile_at(
    sources: &mut Sources,
    name: &str,
    text: &str,
    path: &Path,
    number: usize,
) -> (Option<Determined>, Diagnostics) {
    let file = sources.add(name, text);
    let parsed = syntax::parse(sources, file);
    if !parsed.faults.is_empty() {
        return (None, parsed.faults);
    }
    let tree = parsed.tree;
    let diagnostics = check::check_file(&tree);
    if diagnostics.has_errors() {
        return (None, diagnostics);
    }
    let surroundings = surroundings(&tree.mechanisms[number], path, sources);
    mechc::compile(&tree.mechanisms[number], &surroundings, sources)
}

/// The files that a mechanism's tables name, beside the file it is in.
pub fn surroundings(mechanism: &Mechanism, beside: &Path, sources: &mut Sources) -> Surroundings {
    let mut surroundings = Surroundings::default();
    for item in &mechanism.items {
        if let ItemKind::Table { rows: TableRows::File { path, .. }, .. } = &item.kind {
            let at = beside.parent().unwrap_or(Path::new("")).join(&path.text);
            if let Ok(text) = std::fs::read_to_string(at) {
                surroundings.files.insert(path.text.clone(), Ok(sources.add(path.text.clone(), text)));
            }
        }
    }
    surroundings
}

/// Runs the first mechanism of a text over its analysis; its tables' files are beside the file that it is named after.
pub fn run(name: &str, text: &str, span: Span) -> Outcome {
    let mut sources = Sources::default();
    let compiled = compile(&mut sources, name, text);
    analyse(sources, compiled, span)
}

/// Runs one of the mechanisms of a file.
pub fn run_number(path: &Path, text: &str, number: usize, span: Span) -> Outcome {
    let mut sources = Sources::default();
    let compiled = compile_at(&mut sources, &path.display().to_string(), text, path, number);
    analyse(sources, compiled, span)
}

/// The names of the mechanisms in a text.
pub fn mechanisms(text: &str) -> Vec<String> {
    let mut sources = Sources::default();
    let file = sources.add("text", text);
    let tree = syntax::parse(&sources, file).tree;
    tree.mechanisms.iter().map(|mechanism| mechanism.name.text.clone()).collect()
}

/// As [`run`], the tables' files being in a folder.
pub fn run_in(folder: &Path, name: &str, text: &str, span: Span) -> Outcome {
    let mut sources = Sources::default();
    let compiled = compile_at(&mut sources, name, text, &folder.join(name), 0);
    analyse(sources, compiled, span)
}

/// Runs what was compiled over its analysis.
pub fn analyse(sources: Sources, compiled: (Option<Determined>, Diagnostics), span: Span) -> Outcome {
    let (determined, mut diagnostics) = compiled;
    let (mut columns, mut rows) = (Vec::new(), Vec::new());
    if let Some(determined) = determined
        && let Some([from, to, every]) = determined.system().analysis
    {
        let times = Times::grid(from, span.to.unwrap_or(to), span.every.unwrap_or(every)).expect("a grid");
        if let Err(diagnostic) = follow(&determined, &times, &mut diagnostics, &mut columns, &mut rows) {
            diagnostics.push(*diagnostic);
        }
    }
    Outcome { sources, diagnostics, columns, rows }
}

fn follow(
    determined: &Determined,
    times: &Times,
    diagnostics: &mut Diagnostics,
    columns: &mut Vec<String>,
    rows: &mut Vec<Vec<f64>>,
) -> Result<(), Box<Diagnostic>> {
    let program = Program::new(determined.system());
    let mut started = analysis::start(determined, &program, times.from(), analysis::TOLERANCE)?;
    diagnostics.extend(started.remarks());
    *columns = started.columns();
    let mut motion = started.motion(times);
    let mut result = Ok(());
    while let Some(row) = motion.next_row() {
        match row {
            Ok(row) => rows.push(row.to_vec()),
            Err(why) => result = Err(why),
        }
    }
    diagnostics.extend(motion.take_remarks());
    result
}

/// A run that goes on beyond bifurcations, with another output step if one is given; and the times of those it has passed (s).
pub fn passing(text: &str, every: Option<f64>) -> (Outcome, Vec<f64>) {
    let mut sources = Sources::default();
    let (determined, _) = compile(&mut sources, "text", text);
    let determined = determined.expect("determined");
    let [from, to, step] = determined.system().analysis.expect("an analysis");
    let times = Times::grid(from, to, every.unwrap_or(step)).expect("a grid");
    let program = Program::new(determined.system());
    let mut started = analysis::start(&determined, &program, from, analysis::TOLERANCE).expect("it assembles");
    let columns = started.columns();
    let mut motion = started.motion(&times);
    motion.pass_bifurcations();
    let mut rows = Vec::new();
    while let Some(row) = motion.next_row() {
        rows.push(row.expect("it goes on").to_vec());
    }
    let remarks = motion.take_remarks();
    assert!(remarks.iter().all(|remark| remark.code.as_str() == "W0602"));
    let passed = remarks.iter().map(|remark| remark.data["t"].as_f64().expect("a time")).collect();
    (Outcome { sources, diagnostics: remarks, columns, rows }, passed)
}

/// All files below a folder with an ending, in order.
pub fn files(folder: &str, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).expect("the folder is there") {
            let path = entry.expect("it can be read").path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == ending) {
                found.push(path);
            }
        }
    }
    found.sort();
    assert!(!found.is_empty(), "no .{ending} below {folder}");
    found
}

/// `name` of `folder/name.mech`.
pub fn stem(path: &Path) -> String {
    path.file_stem().expect("a file").to_string_lossy().into_owned()
}

/// Worse than a remark.
pub fn is_error(diagnostic: &Diagnostic) -> bool {
    diagnostic.severity() == Severity::Error
}
