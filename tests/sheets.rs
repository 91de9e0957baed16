//! Tables of sweeps as files: each row is what `run --lead --set` prints, whatever a sweep is made with; whole or not there when it is
//! interrupted or killed; never over what was read.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking
#![cfg(unix)] // signals

mod support;

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;
use support::random::Random;

fn mechc(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
    command.current_dir(folder);
    command
}

fn output(folder: &Path, arguments: &[&str]) -> Output {
    let output = mechc(folder).args(arguments).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!said.contains("panicked"), "{arguments:?}: {said}");
    output
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A four-bar of which all kinds of variants go wrong: lengths that do not close, that lock, that are all in line once a turn, a length
/// that is negative, a division by zero, a root of what is negative, an end of the analysis before its begin.
const FOUR_BAR: &str = "mechanism four_bar {
    param ground_length  = 100 mm
    param crank_length   = 30 mm
    param coupler_length = 90 mm
    param rocker_length  = 70 mm
    param pen = (45 mm, 20 mm)
    param speed = 60 rpm
    param gap = 1
    param span = 1 s
    ground { point O = (0, 0)  point C = (ground_length, 0) }
    body crank at (0, 0, 30 deg) { point O = (0, 0)  point A = (crank_length, 0) }
    body coupler at (26 mm, 15 mm, 40 deg) { point A = (0, 0)  point B = (coupler_length, 0)  point P = pen }
    body wheel { point C = (0, 0) }
    joint main:  revolute(ground.O, crank.O)
    joint left:  revolute(crank.A, coupler.A)
    joint right: revolute_revolute(coupler.B, ground.C, rocker_length)
    joint back:  revolute(ground.C, wheel.C)
    driver motor: rotation(main) = 30 deg + speed * t
    driver slow:  rotation(back) = sqrt(gap - 0.5) * t
    measure height = y(coupler.P) in mm
    measure odd = 1 / gap
    result swing = max(height) - min(height) in mm
    result pause = ground_length / (rocker_length - 70 mm + 1 mm)
    analysis from 0 s to span every 50 ms
}";

fn in_folder(texts: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in texts {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// The cells of a table with a header, none of which holds a comma.
struct Cells {
    names: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Cells {
    fn of(text: &str) -> Cells {
        let split = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let mut lines = text.lines().map(split);
        Cells { names: lines.next().expect("a header"), rows: lines.collect() }
    }

    fn column(&self, name: &str) -> usize {
        self.names.iter().position(|column| column == name).unwrap_or_else(|| panic!("{name} in {:?}", self.names))
    }
}

fn number(cell: &str) -> Option<u64> {
    cell.parse::<f64>().ok().map(f64::to_bits)
}

/// What sets the params of a row, with their SI units.
fn settings(cells: &Cells, row: &[String], params: &[(&str, &str)]) -> Vec<String> {
    let set = |(name, unit): &(&str, &str)| format!("{name}={}{unit}", row[cells.column(name)]);
    params.iter().map(set).collect()
}

/// The status, the time at which it stopped, and the results or rows of what `run --lead --set` makes of a variant.
fn alone(folder: &Path, file: &str, set: &[String], more: &[&str]) -> (String, String, Cells, serde_json::Value) {
    let mut arguments = vec!["run", file, "--lead", "--message-format", "json", "-o", "alone.csv"];
    let at_times = more.contains(&"--at");
    if !at_times {
        arguments.extend(["--results", "alone.json"]);
    }
    set.iter().for_each(|set| arguments.extend(["--set", set]));
    arguments.extend(more);
    for name in ["alone.csv", "alone.json"] {
        let _ = fs::remove_file(folder.join(name));
    }
    let ran = output(folder, &arguments);
    let lines = said(&ran);
    let said = lines.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    let errors: Vec<_> = said.filter(|said| said["severity"] == "error").collect();
    let is_led = |said: &&serde_json::Value| said["code"] != "E0612";
    let (status, stopped) = match (errors.iter().find(is_led), errors.is_empty()) {
        (Some(why), _) => (
            why["code"].as_str().expect("a code").to_owned(),
            why["data"]["t"].as_f64().map(|t| format!("{t:?}")).unwrap_or_default(),
        ),
        (None, true) => ("ok".to_owned(), String::new()),
        (None, false) => ("reassembled".to_owned(), String::new()),
    };
    let table = fs::read_to_string(folder.join("alone.csv")).unwrap_or_else(|_| "t\n".to_owned());
    let results = fs::read_to_string(folder.join("alone.json")).unwrap_or_else(|_| "{}".to_owned());
    (status, stopped, Cells::of(&table), serde_json::from_str(&results).expect("results"))
}

/// Each row of a sweep of results is what `run` makes of it; gives the statuses in order.
#[track_caller]
fn results_are_those_of_runs(folder: &Path, file: &str, params: &[(&str, &str)], sweep: &[&str], more: &[&str]) -> Vec<String> {
    let mut arguments = vec!["sweep", file, "-o", "sweep.csv"];
    arguments.extend(sweep);
    arguments.extend(more);
    let swept = output(folder, &arguments);
    assert!([Some(0), Some(3)].contains(&swept.status.code()), "{arguments:?}: {}", said(&swept));
    let cells = Cells::of(&fs::read_to_string(folder.join("sweep.csv")).expect("a table"));
    let mut statuses = Vec::new();
    for row in &cells.rows {
        let set = settings(&cells, row, params);
        let (status, stopped, _, results) = alone(folder, file, &set, more);
        assert_eq!(row[cells.column("status")], status, "{set:?} {more:?}");
        assert_eq!(number(&row[cells.column("stopped")]), number(&stopped), "{set:?} {more:?}");
        for (k, name) in cells.names.iter().enumerate() {
            let is_result = !["variant", "status", "stopped"].contains(&name.as_str())
                && !params.iter().any(|(param, _)| param == name);
            if is_result {
                let wanted = results[name].as_f64().map(f64::to_bits);
                assert_eq!(number(&row[k]), wanted, "{name} with {set:?} {more:?}");
            }
        }
        statuses.push(status);
    }
    statuses
}

#[test]
fn variants_of_all_broken_kinds_are_what_runs_say_and_leave_the_others_alone() {
    let folder = in_folder(&[("a.mech", FOUR_BAR)]);
    let path = folder.path();
    // fine, does not close, locks, all in line once a turn, negative, nothing
    let cranks = "crank_length=30mm,400mm,75mm,60mm,-30mm,0mm";
    let params = [("crank_length", " m"), ("gap", ""), ("span", " s")];
    let sweep = ["--vary", cranks, "--vary", "gap=1,0,0.5", "--vary", "span=1s,-1s,0s"];
    let statuses = results_are_those_of_runs(path, "a.mech", &params, &sweep, &[]);
    let mut kinds = statuses.clone();
    kinds.sort();
    kinds.dedup();
    assert!(kinds.len() >= 4 && kinds.contains(&"ok".to_owned()), "{kinds:?}");
    // what is fine is the same without the others beside it
    let whole = fs::read_to_string(path.join("sweep.csv")).unwrap();
    let few = output(path, &["sweep", "a.mech", "--vary", "crank_length=30mm", "--vary", "gap=1", "--vary", "span=1s"]);
    let few = String::from_utf8(few.stdout).unwrap();
    assert_eq!(few.lines().nth(1), whole.lines().nth(1));
    // and all of them in any order
    let turned = "crank_length=0mm,-30mm,60mm,75mm,400mm,30mm";
    let sweep = ["--vary", turned, "--vary", "gap=0.5,0,1", "--vary", "span=0s,-1s,1s"];
    let mut back = results_are_those_of_runs(path, "a.mech", &params, &sweep, &[]);
    back.reverse();
    assert_eq!(back, statuses);
}

/// Random options together, against runs: rows and results, to the bit.
#[test]
fn random_sweeps_are_what_runs_say() {
    let folder = in_folder(&[("a.mech", FOUR_BAR)]);
    let path = folder.path();
    let mut random = Random::new(7);
    // names, units in options and in SI, ends
    let params = [
        ("ground_length", "mm", " m", 60.0, 160.0),
        ("crank_length", "mm", " m", -10.0, 80.0),
        ("pen.x", "mm", " m", -50.0, 50.0),
        ("speed", "rpm", "/s", -60.0, 90.0),
        ("gap", "", "", -1.0, 2.0),
        ("span", "s", " s", -0.1, 1.0),
    ];
    let mut statuses = Vec::new();
    for round in 0..12 {
        let mut rest = params.to_vec();
        let taken: Vec<_> = (0..1 + random.below(3)).map(|_| rest.swap_remove(random.below(rest.len()))).collect();
        let mut vary = Vec::new();
        let is_sample = random.below(3) == 0;
        for (k, (name, unit, _, low, high)) in taken.iter().enumerate() {
            let mut value = || format!("{:.3}{unit}", random.between(*low, *high));
            let [a, b, c] = [value(), value(), value()];
            vary.push(match random.below(3) {
                _ if is_sample && k == 0 => format!("{name}={a}..{b}"),
                0 if !is_sample => format!("{name}={a}..{b}:{}", 1 + random.below(4)),
                1 => {
                    let plain = |value: &str| value.trim_end_matches(|c: char| c.is_alphabetic()).to_owned();
                    let head = if unit.is_empty() { (*name).to_owned() } else { format!("{name} [{unit}]") };
                    let file = format!("{round}{k}.csv");
                    fs::write(path.join(&file), format!("{head}\n{}\n{}\n", plain(&a), plain(&b))).unwrap();
                    format!("@{file}")
                }
                _ => format!("{name}={a},{b},{c}"),
            });
        }
        let mut sweep: Vec<&str> = vary.iter().flat_map(|vary| ["--vary", vary]).collect();
        if is_sample {
            sweep.extend(["--sample", "4"]);
        }
        let mut more = Vec::new();
        if random.below(3) == 0 {
            more.extend(["--to", "0.4s"]);
        }
        if random.below(3) == 0 {
            more.extend(["--every", "0.03s"]);
        }
        if random.below(3) == 0 {
            more.extend(["--result", "peak = max(abs(der(der(height))))"]);
        }
        if random.below(4) == 0 {
            more.push("--pass-bifurcations");
        }
        let names: Vec<(&str, &str)> = taken.iter().map(|(name, _, si, ..)| (*name, *si)).collect();
        statuses.extend(results_are_those_of_runs(path, "a.mech", &names, &sweep, &more));
        threads_units_and_shares_change_nothing(path, &sweep, &more, &mut random);
        rows_are_those_of_runs(path, &names, (&sweep, &more));
    }
    assert!(statuses.iter().filter(|status| *status == "ok").count() > 20, "{statuses:?}");
    assert!(statuses.iter().filter(|status| status.starts_with('E')).count() > 20, "{statuses:?}");
}

fn threads_units_and_shares_change_nothing(path: &Path, sweep: &[&str], more: &[&str], random: &mut Random) {
    let bytes = |name: &str, with: &[&str]| {
        let arguments: Vec<&str> =
            [&["sweep", "a.mech", "-o", name], sweep, more, with].into_iter().flatten().copied().collect();
        let made = output(path, &arguments);
        // an instruction set that this processor does not have
        let is_there = !said(&made).contains("that this processor has");
        is_there.then(|| fs::read(path.join(name)).expect("a table"))
    };
    let whole = bytes("whole.csv", &["--jobs", "1"]).expect("a table");
    for with in [["--jobs", "2"], ["--jobs", "16"], ["--vectors", "base"], ["--vectors", "avx2"], ["--vectors", "avx512"]] {
        assert!(bytes("again.csv", &with).is_none_or(|again| again == whole), "{sweep:?} {more:?} {with:?}");
    }
    let count = whole.iter().filter(|byte| **byte == b'\n').count() - 1;
    if count > 1 {
        let cut = (1 + random.below(count - 1)).to_string();
        let [mut first, second] = [["--take", &cut], ["--skip", &cut]].map(|with| bytes("share.csv", &with).expect("a table"));
        let header = second.iter().position(|byte| *byte == b'\n').expect("a header") + 1;
        first.extend(&second[header..]);
        assert!(first == whole, "{sweep:?} {more:?}, shares at {cut}");
    }
}

fn rows_are_those_of_runs(path: &Path, params: &[(&str, &str)], (sweep, more): (&[&str], &[&str])) {
    let more: Vec<&str> = more.iter().copied().filter(|word| *word != "--result" && !word.starts_with("peak")).collect();
    let columns = ["--columns", "height*", "--columns", "coupler.*"];
    let arguments: Vec<&str> =
        [&["sweep", "a.mech", "--rows", "--format", "json", "-o", "rows.json"], sweep, &more, &columns]
            .into_iter()
            .flatten()
            .copied()
            .collect();
    output(path, &arguments);
    let listed = output(path, &[&["sweep", "a.mech"], sweep, &more].concat());
    let listed = Cells::of(&String::from_utf8(listed.stdout).expect("text"));
    let text = fs::read_to_string(path.join("rows.json")).expect("rows");
    let mut lines = text.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).expect("an object")).peekable();
    for (variant, row) in listed.rows.iter().enumerate() {
        let set = settings(&listed, row, params);
        let more: Vec<&str> = more.iter().copied().chain(columns).collect();
        let (_, _, rows, _) = alone(path, "a.mech", &set, &more);
        for row in &rows.rows {
            let line = lines.next_if(|line| line["variant"] == variant).unwrap_or_else(|| panic!("a row of {set:?}"));
            for (name, cell) in rows.names.iter().zip(row) {
                assert_eq!(line[name].as_f64().map(f64::to_bits), number(cell), "{name} with {set:?} {more:?}");
            }
        }
        assert!(lines.peek().is_none_or(|line| line["variant"] != variant), "more rows than {set:?} has");
    }
    assert!(lines.next().is_none(), "rows of nobody");
}

// ---- interruptions

/// Starts a sweep that takes a while, and waits until something of its table is there.
fn begun(folder: &Path, arguments: &[&str], least: u64) -> Child {
    let mut child = mechc(folder).args(arguments).stderr(Stdio::piped()).spawn().expect("it runs");
    let is_written = |entry: &fs::DirEntry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        name.starts_with('.') && entry.metadata().is_ok_and(|found| found.len() > least)
    };
    for _ in 0..3000 {
        let entries = fs::read_dir(folder).expect("a folder").flatten();
        if entries.filter(is_written).count() > 0 || child.try_wait().expect("a state").is_some() {
            break;
        }
        sleep(Duration::from_millis(10));
    }
    child
}

fn signal(child: &Child, signal: &str) {
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status().expect("it runs");
    assert!(sent.success());
}

fn slider_crank() -> tempfile::TempDir {
    in_folder(&[("a.mech", fs::read_to_string("examples/slider_crank.mech").unwrap().as_str())])
}

#[test]
fn what_is_killed_leaves_nothing_under_the_name() {
    for out in ["new.csv", "old.json", "old.parquet"] {
        let folder = slider_crank();
        let path = folder.path();
        if out.starts_with("old") {
            fs::write(path.join(out), "precious").unwrap();
        }
        let sweep = ["sweep", "a.mech", "--vary", "rod_length=100mm..200mm:100000000", "--rows", "-o", out];
        let mut child = begun(path, &sweep, 100_000);
        assert!(child.try_wait().expect("a state").is_none(), "it was to take a while");
        signal(&child, "-9");
        child.wait().expect("it ends");
        let found = fs::read(path.join(out)).ok();
        let wanted = out.starts_with("old").then(|| b"precious".to_vec());
        assert!(found == wanted, "{out}: {:?} bytes", found.map(|found| found.len()));
    }
}

/// The rows of a table as text, whatever its form.
fn all_rows(path: &Path) -> Vec<String> {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    if path.extension().is_some_and(|ending| ending == "parquet") {
        let reader = SerializedFileReader::new(fs::File::open(path).expect("a table")).expect("a whole table");
        return reader.get_row_iter(None).expect("rows").map(|row| row.expect("a row").to_string()).collect();
    }
    let text = fs::read_to_string(path).expect("a table");
    assert!(text.ends_with('\n'), "the last line is whole");
    let header = usize::from(path.extension().is_some_and(|ending| ending == "csv"));
    text.lines().skip(header).map(str::to_owned).collect()
}

#[test]
fn an_interrupted_sweep_has_whole_variants_and_the_rest_goes_on_behind_them() {
    const COUNT: usize = 6000;
    for out in ["part.csv", "part.json", "part.parquet"] {
        let folder = slider_crank();
        let path = folder.path();
        let range = format!("rod_length=100mm..200mm:{COUNT}");
        let sweep = ["sweep", "a.mech", "--vary", &range, "--rows", "--columns", "travel*", "--every", "1ms"];
        let with = |more: &[&'static str]| -> Vec<String> {
            sweep.iter().map(|word| (*word).to_owned()).chain(more.iter().map(|word| (*word).to_owned())).collect()
        };
        let arguments: Vec<&str> = sweep.into_iter().chain(["--jobs", "1", "-o", out]).collect();
        let child = begun(path, &arguments, 4);
        signal(&child, "-2");
        let ended = child.wait_with_output().expect("it ends");
        let told = said(&ended);
        assert_eq!(ended.status.code(), Some(130), "{told}");
        let skip = told.split("--skip ").nth(1).and_then(|rest| rest.split('`').next()).expect("how to go on").to_owned();
        let done: usize = skip.parse().expect("a number");
        assert!(done > 0 && done < COUNT, "{told}");
        assert!(told.contains(&format!("interrupted: {done} of {COUNT} variants are written")), "{told}");
        let ending = out.split_once('.').expect("an ending").1;
        let [rest, whole] = ["rest", "whole"].map(|name| format!("{name}.{ending}"));
        let mut more: Vec<String> = with(&["--skip"]);
        more.extend([skip, "-o".to_owned(), rest.clone()]);
        assert!(mechc(path).args(&more).output().expect("it runs").status.success());
        let mut more = with(&["-o"]);
        more.push(whole.clone());
        assert!(mechc(path).args(&more).output().expect("it runs").status.success());
        let rows: Vec<String> = all_rows(&path.join(out)).into_iter().chain(all_rows(&path.join(rest))).collect();
        assert_eq!(rows.len(), COUNT * 41, "{out}");
        assert!(rows == all_rows(&path.join(whole)), "{out}: parts put together are the whole");
    }
}

// ---- what was read

#[test]
fn a_table_is_never_written_over_what_was_read() {
    let folder = slider_crank();
    let path = folder.path();
    fs::write(path.join("v.csv"), "rod_length [mm]\n150\n").unwrap();
    std::os::unix::fs::symlink("v.csv", path.join("link.csv")).unwrap();
    fs::hard_link(path.join("a.mech"), path.join("hard.csv")).unwrap();
    let before: Vec<Vec<u8>> = ["a.mech", "v.csv"].map(|name| fs::read(path.join(name)).unwrap()).to_vec();
    for (command, out) in [
        (vec!["sweep", "a.mech", "--vary", "@v.csv"], "v.csv"),
        (vec!["sweep", "a.mech", "--vary", "@v.csv"], "./v.csv"),
        (vec!["sweep", "a.mech", "--vary", "@v.csv"], "link.csv"),
        (vec!["sweep", "a.mech", "--vary", "@v.csv"], "hard.csv"),
        (vec!["sweep", "a.mech", "--vary", "@v.csv", "--format", "csv"], "a.mech"),
        (vec!["tolerance", "a.mech", "--tol", "rod_length=1mm", "--format", "csv"], "a.mech"),
        (vec!["tolerance", "a.mech", "--tol", "rod_length=1mm"], "hard.csv"),
    ] {
        let refused = output(path, &[&command[..], &["-o", out]].concat());
        assert_eq!(refused.status.code(), Some(2), "{command:?} {out}: {}", said(&refused));
        assert!(said(&refused).contains("would be written over"), "{}", said(&refused));
    }
    let behind: Vec<Vec<u8>> = ["a.mech", "v.csv"].map(|name| fs::read(path.join(name)).unwrap()).to_vec();
    assert!(before == behind);
}

// ---- what decides what is repeated

#[test]
fn each_number_of_copies_is_a_mechanism_of_its_own() {
    let text = fs::read_to_string("examples/scissor_lift.mech").unwrap();
    let folder = in_folder(&[("a.mech", text.as_str())]);
    let path = folder.path();
    let more = ["--result", "top = max(rise)", "--result", "near = min(reach)"];
    let params = [("cells", ""), ("arm", " m")];
    let sweep = ["--vary", "cells=2..5:4", "--vary", "arm=500mm,600mm,700mm"];
    let statuses = results_are_those_of_runs(path, "a.mech", &params, &sweep, &more);
    assert_eq!(statuses, vec!["ok"; 12]);
    // what there is none of is refused, be it the first
    let sweep = ["--vary", "cells=0,2,2.5,-1,3", "--vary", "arm=600mm,-600mm"];
    let statuses = results_are_those_of_runs(path, "a.mech", &params, &sweep, &more);
    assert_eq!(statuses[2], "ok");
    assert!(statuses[4].starts_with('E') && statuses[8] == "ok", "{statuses:?}");
    // columns go by their names
    let rows = output(path, &["sweep", "a.mech", "--vary", "cells=3,5", "--rows", "--columns", "rise", "--columns", "up[3].x", "--at", "1"]);
    let rows = String::from_utf8(rows.stdout).unwrap();
    let run = |cells: &str| {
        let set = format!("cells={cells}");
        let ran = output(path, &["run", "a.mech", "--lead", "--set", &set, "--columns", "rise", "--at", "1"]);
        String::from_utf8(ran.stdout).unwrap().lines().nth(1).expect("a row").to_owned()
    };
    let lines: Vec<&str> = rows.lines().collect();
    let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
    let header = cells(lines[0]);
    let at = |name: &str| header.iter().position(|column| column == name).expect("a column");
    for (line, count) in lines[1..].iter().zip(["3", "5"]) {
        let (found, wanted) = (cells(line), cells(&run(count)));
        assert_eq!((&found[at("t")], &found[at("rise")]), (&wanted[0], &wanted[1]));
        assert_eq!(found[at("up[3].x")].is_empty(), count == "3", "three cells have no fourth");
    }
}
