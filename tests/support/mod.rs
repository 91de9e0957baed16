//! The pipeline as tests use it, through the façade: text in, diagnostics and rows out.

#![allow(dead_code)] // each test file uses its part

pub mod blocks;
pub mod change_points;
pub mod formula_reader;
pub mod golden;
pub mod random;
pub mod shape;
pub mod sweeps;
pub mod table;
pub mod tex;

use mechc::{
    Cancel, Choice, Color, Compiled, Contents, Diagnostic, Diagnostics, Format, Parsed, Redundant, RunOptions,
    Severity, Sources, Times, World, render,
};
use std::path::{Path, PathBuf};

/// The folder of the project, in which its crates are.
pub fn root() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.ancestors().find(|folder| folder.join("tests/support").is_dir()).expect("the project").to_owned()
}

/// Returns the text of a file of the project.
pub fn text_of(path: impl AsRef<Path>) -> String {
    std::fs::read_to_string(root().join(path)).expect("a text")
}

/// Files of this machine, with paths relative to a folder: by default that of the project.
pub struct Disk(PathBuf);

impl Default for Disk {
    fn default() -> Disk {
        Disk(root())
    }
}

impl World for Disk {
    fn read(&self, path: &Path) -> std::io::Result<Contents> {
        Ok(Contents { bytes: std::fs::read(self.0.join(path))?.into(), version: 0 })
    }

    fn names_in(&self, folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.join(folder)).into_iter().flatten().flatten();
        let mut names: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    fn identity(&self, path: &Path) -> PathBuf {
        self.0.join(path).canonicalize().unwrap_or_else(|_| path.to_owned())
    }
}

/// Results for a text.
pub struct Outcome {
    pub sources: Sources,
    pub diagnostics: Diagnostics,
    pub columns: Vec<String>,
    pub rows: Vec<Vec<f64>>,
}

/// Times to compute; those of the file by default.
#[derive(Clone, Copy, Default)]
pub struct Span {
    pub to: Option<f64>,
    pub every: Option<f64>,
}

impl Outcome {
    fn of(sources: &Sources) -> Outcome {
        Outcome { sources: sources.clone(), diagnostics: Diagnostics::default(), columns: Vec::new(), rows: Vec::new() }
    }

    /// Returns whether there are no errors.
    pub fn succeeded(&self) -> bool {
        !self.diagnostics.has_errors()
    }

    /// Returns the diagnostics as a user reads them.
    pub fn text(&self) -> String {
        self.diagnostics.iter().map(|d| render(d, &self.sources, Format::Human, Color::Never)).collect()
    }

    /// Fails with the diagnostics if there are errors.
    pub fn expect_success(self) -> Outcome {
        assert!(self.succeeded(), "{}", self.text());
        self
    }

    /// Returns the codes in order.
    pub fn codes(&self) -> Vec<&'static str> {
        self.diagnostics.iter().map(|d| d.code.as_str()).collect()
    }

    /// Returns the error that stopped the motion, if any.
    pub fn stop(&self) -> Option<&Diagnostic> {
        self.diagnostics.iter().find(|diagnostic| is_error(diagnostic))
    }

    /// Returns the times of the bifurcations that were passed (s).
    pub fn passed(&self) -> Vec<f64> {
        let passed = self.diagnostics.iter().filter(|remark| remark.code.as_str() == "W0602");
        passed.map(|remark| remark.data["t"].as_f64().expect("a time")).collect()
    }

    /// Returns a column by its name.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let at = self.columns.iter().position(|column| column == name);
        let at = at.unwrap_or_else(|| panic!("no column {name} in {:?}", self.columns));
        self.rows.iter().map(|row| row[at]).collect()
    }
}

/// Checks and proves the first mechanism of a text, whose files are next to its name.
pub fn compile(name: &str, text: &str) -> (Option<Compiled>, Outcome) {
    compile_at(&Parsed::new(name, text), 0, Redundant::Refused, false, &Disk::default())
}

/// Checks and proves the first mechanism of a text, without its redundant equations.
pub fn compile_without_redundant(name: &str, text: &str) -> (Option<Compiled>, Outcome) {
    compile_at(&Parsed::new(name, text), 0, Redundant::LeftOut, false, &Disk::default())
}

/// Checks and proves a mechanism of a text in a file, by its number.
pub fn compile_number(path: &Path, text: &str, number: usize) -> (Option<Compiled>, Outcome) {
    compile_at(&parsed_in(path, text), number, Redundant::Refused, false, &Disk::default())
}

/// Checks and proves a mechanism with all reactions and efforts as columns, if the text has masses or loads.
pub fn compile_with_forces(path: &Path, text: &str, number: usize) -> Option<Compiled> {
    let has_forces = text.lines().map(str::trim).any(|line| line.starts_with("mass ") || line.starts_with("load "));
    let with_forces = || compile_at(&parsed_in(path, text), number, Redundant::Refused, true, &Disk::default()).0;
    if has_forces { with_forces() } else { None }
}

fn parsed_in(path: &Path, text: &str) -> Parsed {
    let mut sources = Sources::default();
    let file = sources.add(path.display().to_string(), text);
    Parsed::from_source(sources, file, path)
}

/// Compiles the mechanism of a correct text.
pub fn compiled(name: &str, text: &str) -> Compiled {
    let (compiled, outcome) = compile(name, text);
    compiled.unwrap_or_else(|| panic!("{name}:\n{}", outcome.text()))
}

fn compile_at(
    parsed: &Parsed,
    number: usize,
    redundant: Redundant,
    reactions: bool,
    disk: &Disk,
) -> (Option<Compiled>, Outcome) {
    // the faults of a text that cannot be parsed are all there is
    let mechanism = parsed.mechanisms().nth(number).map(str::to_owned);
    let checked = parsed.check(&Choice { mechanism, reactions, ..Choice::default() }, disk);
    let (compiled, said) = checked.compile(redundant, &Cancel::default());
    let mut outcome = Outcome::of(checked.sources());
    outcome.diagnostics.extend(checked.diagnostics().clone());
    outcome.diagnostics.extend(said);
    (compiled, outcome)
}

/// Runs the first mechanism of a text over its analysis; the files of its tables are next to the file that it is named after.
pub fn run(name: &str, text: &str, span: Span) -> Outcome {
    analyse(compile(name, text), span)
}

/// Runs a mechanism of a file, by its number.
pub fn run_number(path: &Path, text: &str, number: usize, span: Span) -> Outcome {
    analyse(compile_number(path, text, number), span)
}

/// Returns the names of the mechanisms in a text.
pub fn mechanisms(text: &str) -> Vec<String> {
    Parsed::new("text", text).mechanisms().map(str::to_owned).collect()
}

/// Runs the first mechanism of a text over its analysis; the files of its tables are in a folder.
pub fn run_in(folder: &Path, name: &str, text: &str, span: Span) -> Outcome {
    let disk = Disk(folder.to_owned());
    analyse(compile_at(&Parsed::new(name, text), 0, Redundant::Refused, false, &disk), span)
}

/// Runs a compiled mechanism over its analysis.
pub fn analyse((compiled, mut outcome): (Option<Compiled>, Outcome), span: Span) -> Outcome {
    if let Some(compiled) = compiled
        && let Some([from, to, every]) = compiled.analysis()
    {
        let times = Times::grid(from, span.to.unwrap_or(to), span.every.unwrap_or(every)).expect("a grid");
        follow(&compiled, &times, &RunOptions::default(), &mut outcome);
    }
    outcome
}

/// Returns all rows at some times, and the error that stopped the motion, if any.
pub fn all_rows(compiled: &Compiled, times: &Times) -> (Vec<Vec<f64>>, Option<Diagnostic>) {
    let mut outcome = Outcome::of(compiled.sources());
    follow(compiled, times, &RunOptions::default(), &mut outcome);
    let stop = outcome.stop().cloned();
    (outcome.rows, stop)
}

/// Follows a motion to its last row, or to where it stops. Returns whether it started.
pub fn follow(compiled: &Compiled, times: &Times, options: &RunOptions, outcome: &mut Outcome) -> bool {
    outcome.columns = compiled.columns();
    let (run, said) = compiled.run(times, options);
    outcome.diagnostics.extend(said);
    let Some(mut run) = run else { return false };
    let mut why = None;
    for row in run.by_ref() {
        match row {
            Ok(row) => outcome.rows.push(row),
            Err(error) => why = error.diagnostics.into_iter().next(),
        }
    }
    outcome.diagnostics.extend(run.take_warnings());
    outcome.diagnostics.extend(run.results().into_iter().flat_map(|answers| answers.notes));
    outcome.diagnostics.extend(why);
    true
}

/// Runs a text past bifurcations, with another output step if one is given. Returns the times of the bifurcations (s), too.
pub fn passing(text: &str, every: Option<f64>) -> (Outcome, Vec<f64>) {
    let (compiled, mut outcome) = compile("text", text);
    let compiled = compiled.expect("determined");
    let [from, to, step] = compiled.analysis().expect("an analysis");
    let times = Times::grid(from, to, every.unwrap_or(step)).expect("a grid");
    outcome.diagnostics = Diagnostics::default();
    follow(&compiled, &times, &RunOptions { pass_bifurcations: true, ..RunOptions::default() }, &mut outcome);
    assert!(outcome.diagnostics.iter().all(|remark| remark.code.as_str() == "W0602" || !is_error(remark)));
    let passed = outcome.passed();
    (outcome, passed)
}

/// Returns all files with an ending below a folder, in order.
pub fn files(folder: &str, ending: &str) -> Vec<PathBuf> {
    let found = any_files(folder, ending);
    assert!(!found.is_empty(), "no .{ending} below {folder}");
    found
}

fn any_files(folder: &str, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![root().join(folder)];
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
    found
}

/// Returns all source files of the compiler with an ending: of the command line and of each crate.
pub fn sources(ending: &str) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = ["src", "crates"].into_iter().flat_map(|folder| any_files(folder, ending)).collect();
    found.retain(|path| path.components().any(|part| part.as_os_str() == "src"));
    found
}

/// Returns `name` of `folder/name.mech`.
pub fn stem(path: &Path) -> String {
    path.file_stem().expect("a file").to_string_lossy().into_owned()
}

/// Returns whether a diagnostic is an error.
pub fn is_error(diagnostic: &Diagnostic) -> bool {
    diagnostic.severity() == Severity::Error
}
