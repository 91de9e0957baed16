//! Parts: a mechanism that is used in another one does what it does alone, seen from its own ground.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod support;

use mechc::{Cancel, Choice, Parsed, Redundant, RunOptions, Sources, Times};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use support::random::Random;
use support::{Disk, files};

/// How far a number of a part may be from what it is alone: of the larger of its range and the distance of the mount.
const SAME: f64 = 1e-10;

/// The name under which a part stands in the tests.
const PART: &str = "p";

/// A table of a run.
struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn column(&self, name: &str) -> Vec<f64> {
        let at = self.columns.iter().position(|column| column == name);
        let at = at.unwrap_or_else(|| panic!("no column `{name}` among {:?}", self.columns));
        self.rows.iter().map(|row| row[at]).collect()
    }
}

/// Runs a mechanism of a text; of one that is refused, or stops, the codes.
fn run(text: &str, file: &Path, mechanism: &str, times: Option<&Times>) -> Result<(Table, Times), String> {
    let choice = Choice { mechanism: Some(mechanism.to_owned()), ..Choice::default() };
    let mut sources = Sources::default();
    let id = sources.add("text", text);
    let parsed = Parsed::of_source(sources, id, file);
    let checked = parsed.check(&choice, &Disk::default());
    let (compiled, said) = checked.compile(Redundant::LeftOut, &Cancel::default());
    let told = || {
        let all = checked.diagnostics().iter().chain(said.iter());
        all.map(|d| format!("{} {}", d.code.as_str(), d.message)).collect::<Vec<_>>().join("; ")
    };
    let compiled = compiled.ok_or_else(told)?;
    let times = match (times, compiled.analysis()) {
        (Some(times), _) => times.clone(),
        (None, Some([from, to, every])) => Times::grid(from, to, every).ok_or("no grid")?,
        (None, None) => return Err("no analysis".to_owned()),
    };
    let (run, said) = compiled.run(&times, &RunOptions::default());
    let mut run = run.ok_or_else(|| said.iter().map(|d| d.code.as_str()).collect::<Vec<_>>().join(" "))?;
    let columns = run.columns().to_vec();
    let mut rows = Vec::new();
    while let Some(row) = run.next_row() {
        rows.push(row.map_err(|why| why.code.as_str().to_owned())?.to_vec());
    }
    Ok((Table { columns, rows }, times))
}

/// The names behind a keyword in a text, each with what stands behind it.
fn named<'t>(text: &'t str, keyword: &str) -> Vec<(&'t str, &'t str)> {
    let lines = text.lines().map(str::trim_start).filter_map(|line| line.strip_prefix(keyword)?.strip_prefix(' '));
    lines
        .map(str::trim_start)
        .filter_map(|line| {
            let end = line.find(|c: char| !(c.is_alphanumeric() || c == '_'))?;
            Some((&line[..end], &line[end..]))
        })
        .collect()
}

/// A mechanism with measures of all that can be asked of its bodies and joints.
fn measured(text: &str) -> String {
    let mut asked = String::new();
    for (body, rest) in named(text, "body") {
        if !rest.trim_start().starts_with('[') {
            let _ = write!(
                asked,
                "    measure of_x_{body} = x({body}.own_origin)\n    measure of_y_{body} = y({body}.own_origin)\n"
            );
            let _ = write!(
                asked,
                "    measure of_phi_{body} = angle({body})\n    measure of_v_{body} = speed({body}.own_origin)\n"
            );
        }
    }
    for (joint, rest) in named(text, "joint") {
        let kind = rest.trim_start_matches([':', ' ']);
        if kind.starts_with("revolute(") {
            let _ = writeln!(asked, "    measure of_turn_{joint} = rotation({joint})");
        } else if kind.starts_with("translational(") {
            let _ = writeln!(asked, "    measure of_way_{joint} = displacement({joint})");
        }
    }
    let mut changed = String::new();
    for line in text.lines() {
        let is_body = line.trim_start().starts_with("body ") && !line.contains('[');
        match line.find('{').filter(|_| is_body) {
            Some(brace) => {
                let (head, rest) = line.split_at(brace + 1);
                let _ = writeln!(changed, "{head} point own_origin = (0, 0) {rest}");
            }
            None => changed += &format!("{line}\n"),
        }
    }
    let end = changed.rfind('}').expect("a mechanism");
    changed.insert_str(end, &asked);
    changed
}

/// The examples and cases with one mechanism that is determined alone, each with its name.
fn mechanisms() -> Vec<(PathBuf, String, String)> {
    let mut found = Vec::new();
    for folder in ["examples", "tests/cases"] {
        for file in files(folder, "mech") {
            let text = std::fs::read_to_string(&file).expect("a text");
            if let [(name, _)] = named(&text, "mechanism")[..] {
                found.push((file, name.to_owned(), measured(&text)));
            }
        }
    }
    assert!(found.len() > 50, "only {}", found.len());
    found
}

/// What stands around a part.
fn around(name: &str, carrier: &str, place: [f64; 3], is_mirrored: bool) -> String {
    let [x, y, phi] = place;
    let on = if carrier.is_empty() { "" } else { " on carrier" };
    let mirrored = if is_mirrored { " mirrored" } else { "" };
    format!(
        "mechanism outer_one {{\n{carrier}\n    part {PART}: {name}(){on} at ({x:?}, {y:?}, {phi:?}){mirrored}\n}}\n"
    )
}

/// A body that goes up to so far and turns as it likes.
fn carrier(size: f64) -> String {
    format!(
        "    body carrier {{ point O = (0, 0) }}
    driver along:  x(carrier.O) = {size:?} * sin(1.3 * t)
    driver across: y(carrier.O) = {size:?} * cos(0.7 * t)
    driver spin:   angle(carrier) = 0.4 + 0.9 * t"
    )
}

/// The largest difference of a part's own numbers from those of the mechanism alone, as a part of what may be.
fn largest_difference(alone: &Table, part: &Table, distance: f64) -> (f64, String) {
    let mut largest = (0.0, String::new());
    let prefix = format!("{PART}.");
    for name in &part.columns {
        let Some(own) = name.strip_prefix(&prefix) else { continue };
        let is_of_a_body = [".x", ".y", ".phi"].iter().any(|end| own.split(".d").next().unwrap().ends_with(end));
        let is_a_derivative = own.ends_with(".d") || own.ends_with(".dd");
        if !alone.columns.iter().any(|column| column == own) || is_of_a_body || is_a_derivative {
            continue;
        }
        let (want, got) = (alone.column(own), part.column(name));
        let (low, high) = want.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
        let scale = (high - low).max(distance);
        for (want, got) in want.iter().zip(&got) {
            let is_same = want.to_bits() == got.to_bits() || want.is_nan() && got.is_nan();
            let difference = if is_same { 0.0 } else { (want - got).abs() / scale };
            if difference > largest.0 || difference.is_nan() {
                largest = (difference, name.clone());
            }
        }
    }
    largest
}

#[test]
fn a_part_is_what_it_is_alone_seen_from_its_own_ground() {
    let mut random = Random::new(20);
    let (mut compared, mut faults) = (0, Vec::new());
    for (file, name, text) in mechanisms() {
        let Ok((alone, times)) = run(&text, &file, &name, None) else { continue };
        let size = alone.columns.iter().filter(|column| column.ends_with(".x") || column.ends_with(".y"));
        let size = size.flat_map(|column| alone.column(column)).map(f64::abs).fold(1e-3, f64::max);
        for (carried, is_mirrored) in [(false, false), (false, true), (true, false), (true, true)] {
            let [x, y] = [0; 2].map(|_| random.between(-10.0 * size, 10.0 * size));
            let place = [x, y, random.between(-3.0, 3.0)];
            let carrier = if carried { carrier(size) } else { String::new() };
            let whole = format!("{text}\n{}", around(&name, &carrier, place, is_mirrored));
            compared += 1;
            match run(&whole, &file, "outer_one", Some(&times)) {
                Err(why) => faults.push(format!("{name} carried {carried} mirrored {is_mirrored}: {why}")),
                Ok((part, _)) => {
                    let distance = place[0].hypot(place[1]) + if carried { size } else { 0.0 };
                    let (difference, column) = largest_difference(&alone, &part, distance);
                    if difference > SAME || difference.is_nan() || part.rows.len() != alone.rows.len() {
                        faults
                            .push(format!("{name} carried {carried} mirrored {is_mirrored}: {column} {difference:e}"));
                    }
                }
            }
        }
    }
    assert!(compared > 150, "only {compared}");
    assert!(faults.is_empty(), "{} of {compared}:\n{}", faults.len(), faults.join("\n"));
}
