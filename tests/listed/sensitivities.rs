//! Derivatives by inputs and parameters against differences: numbers in the texts of `tests/cases` are made parameters, and what `--by`
//! gives for them is held against motions that were solved for with other values; likewise in those of `tests/sensitivities`, which hold
//! what the others lack. `cargo test --test listed four_bar` does so
//! for one text.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::named_tests::Tests;
use crate::support::{Disk, all_rows, files, mechanisms, stem};
use mechc::{Cancel, Choice, Compiled, Parsed, Redundant, Times};
use mechc_engine::analysis::{self, Horizon};
use mechc_ir::{BodyId, ConstraintSystem, Param};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// Numbers of a text that are made parameters, at most.
const MOST: usize = 6;
/// Rows that are looked at, more or less.
const ROWS: f64 = 12.0;
const MOST_ROWS: u64 = 30;
/// A number is changed by this part of it, a half and a quarter of that.
const CHANGE: f64 = 2e-3;
/// A derivative may differ from the difference by this, beside its largest value or 1.
const NEAR: f64 = 1e-6;
/// Bodies whose places are differentiated twice, at most.
const BODIES: usize = 2;
/// What differences do not agree on among themselves, as beside an edge, is not looked at; but so much of all is.
const LOOKED_AT: f64 = 0.8;

const UNITS: [&str; 16] =
    ["mm", "cm", "m", "km", "in", "ft", "um", "µm", "deg", "rad", "rev", "rpm", "s", "ms", "us", "µs"];

type Rows = Vec<Vec<f64>>;

/// A literal in a text: its bytes.
struct Literal {
    start: usize,
    end: usize,
}

/// The numbers of a line that can be parameters: those with a unit, and in features and poses the others.
fn literals(line: &str, at: usize, found: &mut Vec<Literal>) {
    let code = line.split("//").next().unwrap_or(line);
    let word = code.trim_start().split(' ').next().unwrap_or("");
    if matches!(word, "param" | "analysis" | "mechanism" | "use") || code.contains("..") {
        return;
    }
    let is_place = matches!(word, "point" | "body" | "circle" | "axis" | "driver");
    let bytes = code.as_bytes();
    let is_word = |b: u8| b.is_ascii_alphanumeric() || b == b'_' || b >= 128;
    let mut k = 0;
    while k < bytes.len() {
        if is_word(bytes[k]) && !bytes[k].is_ascii_digit() {
            while k < bytes.len() && is_word(bytes[k]) {
                k += 1;
            }
            continue;
        }
        if !bytes[k].is_ascii_digit() {
            k += 1;
            continue;
        }
        let start = k;
        while k < bytes.len() && (bytes[k].is_ascii_digit() || bytes[k] == b'.') {
            k += 1;
        }
        if k + 1 < bytes.len() && bytes[k] == b'e' && (bytes[k + 1] == b'-' || bytes[k + 1].is_ascii_digit()) {
            k += 2;
            while k < bytes.len() && bytes[k].is_ascii_digit() {
                k += 1;
            }
        }
        let number: f64 = code[start..k].parse().unwrap_or(0.0);
        let mut end = k;
        let unit: String = code[k..].trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        let has_unit = UNITS.contains(&unit.as_str());
        if has_unit {
            end = k + code[k..].find(&unit).unwrap_or(0) + unit.len();
        }
        let is_power = code[end..].trim_start().starts_with('^') || code[..start].trim_end().ends_with(['^', '.']);
        let belongs = !unit.is_empty() && !has_unit;
        if number != 0.0 && !is_power && !belongs && (has_unit || is_place) {
            found.push(Literal { start: at + start, end: at + end });
        }
        k = end;
    }
}

/// The text in which some numbers of one of its mechanisms are parameters `zz0`, `zz1` …; where that is none, as of numbers that have to
/// be alike, the texts with one of them each that are.
fn with_params(path: &Path, text: &str, (number, mechanism): (usize, &str)) -> Vec<String> {
    let choice = Choice { mechanism: Some(mechanism.to_owned()), ..Choice::default() };
    let is_sound = |text: &String| compile(path, text, &choice).is_some();
    let whole = with_some_params(text, number, |_| true);
    if is_sound(&whole) {
        return vec![whole];
    }
    (0..MOST).map(|only| with_some_params(text, number, |k| k == only)).filter(is_sound).collect()
}

fn with_some_params(text: &str, mechanism: usize, is_taken: impl Fn(usize) -> bool) -> String {
    let (mut found, mut at, mut number, mut head) = (Vec::new(), 0, 0, 0);
    for line in text.split_inclusive('\n') {
        if line.starts_with("mechanism ") {
            number += 1;
            if number == mechanism + 1 {
                head = at + line.find('{').expect("a brace") + 1;
            }
        } else if number == mechanism + 1 {
            literals(line, at, &mut found);
        }
        at += line.len();
    }
    let step = found.len().div_ceil(MOST).max(1);
    let taken: Vec<&Literal> = found.iter().step_by(step).collect();
    let (mut made, mut params, mut last) = (String::new(), String::new(), head);
    for (k, literal) in taken.iter().enumerate().filter(|(k, _)| is_taken(*k)) {
        let _ = writeln!(params, " param zz{k} = {}", &text[literal.start..literal.end]);
        made += &text[last..literal.start];
        let _ = write!(made, "zz{k}");
        last = literal.end;
    }
    format!("{}{params}{made}{}", &text[..head], &text[last..])
}

fn compile(path: &Path, text: &str, choice: &Choice) -> Option<Compiled> {
    let mut sources = mechc::Sources::default();
    let file = sources.add(path.display().to_string(), text);
    let checked = Parsed::from_source(sources, file, path).check(choice, &Disk::default());
    checked.compile(Redundant::Refused, &Cancel::default()).0
}

/// The rows at a few times, if the motion gets to the last of them.
fn rows(compiled: &Compiled, times: &Times) -> Option<Rows> {
    let (rows, stop) = all_rows(compiled, times);
    stop.is_none().then_some(rows)
}

fn few_times(compiled: &Compiled) -> Times {
    let [from, to, every] = compiled.analysis().expect("an analysis");
    let step = every * ((to - from) / every / ROWS).floor().max(1.0);
    // rather between edges than on them, where the later side counts, and differences show both
    let behind = |k: u64| from + (k as f64 + 0.37) * step;
    Times::listed(from, (0..MOST_ROWS).map(behind).take_while(|t| *t < to).collect())
}

/// What a parameter is set to: `zz0=0.08 * (1 m)`.
fn setting(name: &str, value: f64, unit: &str) -> String {
    let one = unit.strip_prefix('1').map_or_else(|| format!("1 {unit}"), |rest| format!("1{rest}"));
    if unit == "1" { format!("{name}={value:?}") } else { format!("{name}={value:?} * ({one})") }
}

/// A text with a parameter, or an input, to vary.
struct SliderRange<'t> {
    path: &'t Path,
    text: &'t str,
    mechanism: &'t str,
    name: &'t str,
    value: f64,
    unit: String,
    is_input: bool,
}

impl SliderRange<'_> {
    fn choice(&self, by: &[&str]) -> Choice {
        let by = by.iter().map(|&name| name.to_owned()).collect();
        Choice { mechanism: Some(self.mechanism.to_owned()), by, ..Choice::default() }
    }

    /// Central differences of rows, and how far those of different steps are from each other (L. F. Richardson, 1911).
    fn differences(&self, times: &Times) -> Option<(Rows, Rows)> {
        let size = if self.unit == "1" { self.value.abs().max(0.1) } else { self.value.abs().max(1e-3) };
        let difference = |h: f64| {
            let side = |value: f64| {
                let reported = vec![setting(self.name, value, &self.unit)];
                let (inputs, set) = if self.is_input { (reported, Vec::new()) } else { (Vec::new(), reported) };
                let choice = Choice { inputs, set, ..self.choice(&[]) };
                rows(&compile(self.path, self.text, &choice)?, times)
            };
            let (above, below) = (side(self.value + h)?, side(self.value - h)?);
            Some(with(&above, &below, |a, b| (a - b) / (2.0 * h)))
        };
        let h = CHANGE * size;
        let [one, half, quarter] = [difference(h)?, difference(h / 2.0)?, difference(h / 4.0)?];
        let better = with(&half, &one, |fine, coarse| fine + (fine - coarse) / 3.0);
        let best = with(&quarter, &half, |fine, coarse| fine + (fine - coarse) / 3.0);
        let doubt = with(&best, &better, |a, b| (a - b).abs());
        Some((with(&best, &better, |fine, coarse| fine + (fine - coarse) / 15.0), doubt))
    }

    /// Holds the columns `c.by.NAME` against the differences of the columns `c`; gives how many cells there were, and how many of them
    /// were looked at.
    fn check(&self) -> Option<(usize, usize)> {
        let compiled = compile(self.path, self.text, &self.choice(&[self.name])).expect("it is determined");
        let times = few_times(&compiled);
        let found = rows(&compiled, &times)?;
        let (wanted, doubt) = self.differences(&times)?;
        let (columns, ending) = (compiled.columns(), format!(".by.{}", self.name));
        let (mut cells, mut looked_at) = (0, 0);
        for (k, column) in columns.iter().enumerate() {
            let Some(of) = column.strip_suffix(&ending) else { continue };
            let own = columns.iter().position(|other| other == of).expect("what it is a derivative of");
            let size = found.iter().map(|row| row[k].abs()).filter(|x| x.is_finite()).fold(0.0, f64::max);
            let limit = NEAR * (1.0 + size);
            for (row, (wanted, doubt)) in found.iter().zip(wanted.iter().zip(&doubt)) {
                cells += 1;
                if doubt[own] < limit && row[k].is_finite() {
                    looked_at += 1;
                    let off = (row[k] - wanted[own]).abs();
                    assert!(
                        off < 3.0 * limit,
                        "{column} at t = {}: {} instead of {} (±{:e}), off by {off:e} of {size}",
                        row[0],
                        row[k],
                        wanted[own],
                        doubt[own]
                    );
                }
            }
        }
        Some((cells, looked_at))
    }
}

fn with(a: &[Vec<f64>], b: &[Vec<f64>], f: impl Fn(f64, f64) -> f64) -> Rows {
    a.iter().zip(b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| f(*a, *b)).collect()).collect()
}

/// How much has been held against differences.
#[derive(Default)]
struct Seen {
    variables: usize,
    cells: usize,
    looked_at: usize,
}

impl Seen {
    fn take(&mut self, varied: &SliderRange<'_>) {
        if let Some((cells, looked_at)) = varied.check() {
            (self.variables, self.cells, self.looked_at) =
                (self.variables + 1, self.cells + cells, self.looked_at + looked_at);
        }
    }

    /// It was not too little.
    fn is_enough(&self) {
        assert!(self.variables > 0, "nothing of it can be varied");
        let part = self.looked_at as f64 / self.cells as f64;
        assert!(part > LOOKED_AT, "only {part} of {} cells can be looked at", self.cells);
    }
}

/// All parameters of a text, and numbers of it, against differences.
fn first_order(path: &Path) {
    let text = fs::read_to_string(path).expect("a text");
    let mut seen = Seen::default();
    for (number, mechanism) in mechanisms(&text).iter().enumerate() {
        for text in with_params(path, &text, (number, mechanism)) {
            let choice = Choice { mechanism: Some(mechanism.clone()), ..Choice::default() };
            let compiled = compile(path, &text, &choice).expect("it is determined");
            let (determined, _) = compiled.inside();
            for param in determined.system().params() {
                seen.take(&varied_param(path, (&text, mechanism), param));
            }
        }
    }
    seen.is_enough();
}

fn varied_param<'t>(path: &'t Path, (text, mechanism): (&'t str, &'t str), param: &'t Param) -> SliderRange<'t> {
    let Param { name, value, .. } = param;
    SliderRange { path, text, mechanism, name, value: *value, unit: param.unit(), is_input: false }
}

/// The text with measures that are places and angles of its bodies, differentiated by a name.
fn with_measures(text: &str, mechanism: &str, system: &ConstraintSystem, by: &str) -> String {
    let mut measures = String::new();
    let mut known: Vec<BodyId> = Vec::new();
    for point in system.points() {
        let (Some(name), Some(body)) = (&point.name, point.body.filter(|body| !known.contains(body))) else { continue };
        let owner = &system.bodies()[body].name;
        for (k, quantity) in [format!("x({owner}.{name})"), format!("y({owner}.{name})"), format!("angle({owner})")]
            .into_iter()
            .enumerate()
        {
            let _ = writeln!(measures, " measure zz_{}_{k} = der({quantity}, {by})", body.index());
        }
        known.push(body);
        if known.len() == BODIES {
            break;
        }
    }
    let head = format!("mechanism {mechanism} {{");
    assert!(text.contains(&head));
    text.replace(&head, &(head.clone() + &measures))
}

/// Second derivatives by two parameters, or by one of them twice, against differences of first ones.
fn second_order(path: &Path) {
    let text = fs::read_to_string(path).expect("a text");
    let mut seen = Seen::default();
    for (number, mechanism) in mechanisms(&text).iter().enumerate() {
        for text in with_params(path, &text, (number, mechanism)) {
            let choice = Choice { mechanism: Some(mechanism.clone()), ..Choice::default() };
            let (determined, _) = compile(path, &text, &choice).expect("it is determined").inside();
            let system = determined.system();
            let Some(first) = system.params().first() else { continue };
            let text = with_measures(&text, mechanism, system, &first.name);
            let other = &system.params()[system.params().len() / 2];
            seen.take(&varied_param(path, (&text, mechanism), first));
            seen.take(&varied_param(path, (&text, mechanism), other));
        }
    }
    seen.is_enough();
}

/// The text in which something is added to what a driver prescribes.
fn with_input(text: &str, driver: usize, input: &str) -> Option<String> {
    let mut drivers = text.match_indices("\n    driver ").map(|(at, _)| at);
    let at = drivers.nth(driver)?;
    let behind = &text[at + 1..];
    // its lines are indented further than it
    let (line_ends, more) = (behind.match_indices('\n').map(|(at, _)| at), "\n        ");
    let declaration = &behind[..line_ends.into_iter().find(|&end| !behind[end..].starts_with(more))?];
    let comment = declaration.rfind("//").filter(|&at| !declaration[at..].contains('\n'));
    let code = declaration[..comment.unwrap_or(declaration.len())].trim_end();
    let end = at + 1 + code.len();
    let equals = at + 1 + code.rfind(" = ")? + 3;
    Some(format!("{}\n    {input}{}({}) + zin{}", &text[..at], &text[at..equals], &text[equals..end], &text[end..]))
}

/// A shift of every driver, as an input, against differences.
fn inputs(path: &Path) {
    let text = fs::read_to_string(path).expect("a text");
    let mut seen = Seen::default();
    for driver in 0..MOST {
        for (input, unit) in [("input zin = 0", "1"), ("input zin = 0 mm", "m")] {
            let Some(text) = with_input(&text, driver, input) else { continue };
            for mechanism in mechanisms(&text) {
                let choice = Choice { mechanism: Some(mechanism.clone()), ..Choice::default() };
                let is_there = text.split("mechanism ").any(|one| one.starts_with(&mechanism) && one.contains(input));
                if is_there && compile(path, &text, &choice).is_some() {
                    let (mechanism, name) = (&mechanism, "zin");
                    seen.take(&SliderRange {
                        path,
                        text: &text,
                        mechanism,
                        name,
                        value: 0.0,
                        unit: unit.to_owned(),
                        is_input: true,
                    });
                }
            }
        }
    }
    seen.is_enough();
}

/// How many operations it takes to solve for a row.
fn operations(path: &Path, text: &str, choice: &Choice) -> usize {
    let (determined, program) = compile(path, text, choice).expect("it is determined").inside();
    let started =
        analysis::start(determined, program, Horizon::of_analysis(None), mechc::TOLERANCE, &Cancel::default());
    started.unwrap_or_else(|stop| panic!("{stop:?}")).solver().expect("operations").instructions().len()
}

/// One name costs at most as much as a row without it: it is solved for with the factors that there are.
fn costs_no_more_than_a_row(path: &Path) {
    let text = fs::read_to_string(path).expect("a text");
    let mechanism = mechanisms(&text).remove(0);
    let choice = |by: Vec<String>| Choice { mechanism: Some(mechanism.clone()), by, ..Choice::default() };
    let plain = operations(path, &text, &choice(Vec::new()));
    let (determined, _) = compile(path, &text, &choice(Vec::new())).expect("it is determined").inside();
    for param in determined.system().params() {
        let varied = operations(path, &text, &choice(vec![param.name.clone()]));
        assert!(varied <= 2 * plain, "{varied} operations by {}, {plain} without", param.name);
    }
}

/// Lists the tests of this file.
pub fn list(tests: &mut Tests) {
    let all = || {
        let paths = ["tests/cases", "tests/sensitivities"].into_iter().flat_map(|folder| files(folder, "mech"));
        paths.map(|path| (stem(&path), path)).collect::<Vec<_>>()
    };
    tests.each("first", all(), 58, |path: PathBuf| first_order(&path));
    tests.each("second", all(), 58, |path: PathBuf| second_order(&path));
    tests.each("input", all(), 58, |path: PathBuf| inputs(&path));
    let texts = ["andrews", "cam_roller", "drawn_four_bar", "gear_train", "jansen", "slider_crank"];
    let texts = texts.map(|name| (name.to_owned(), PathBuf::from(format!("tests/cases/{name}.mech"))));
    tests.each("cost", texts, 6, |path: PathBuf| costs_no_more_than_a_row(&path));
}
