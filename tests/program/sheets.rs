//! Tables of sweeps as files: each row is what `run --lead --set` prints, whatever a sweep is made with; whole or not there when it is
//! interrupted or killed; never over what was read.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking
#![cfg(unix)] // signals

use crate::support::random::Random;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

fn mechc(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
    command.current_dir(folder);
    command
}

fn output(folder: &Path, arguments: &[&str]) -> Output {
    let output = mechc(folder).args(arguments).output().expect("it runs");
    let diagnostics = String::from_utf8_lossy(&output.stderr);
    assert!(!diagnostics.contains("panicked"), "{arguments:?}: {diagnostics}");
    output
}

fn diagnostics(output: &Output) -> String {
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

/// The names and numbers of a flat object, as they are written: who reads numbers as JSON may lose the last bit.
fn object(text: &str) -> Vec<(String, String)> {
    let pairs = text.trim().trim_start_matches('{').trim_end_matches('}').split(',');
    let pair = |(name, value): (&str, &str)| (name.trim().trim_matches('"').to_owned(), value.trim().to_owned());
    pairs.filter_map(|of| of.split_once(':')).map(pair).collect()
}

/// The number of a name in such an object.
#[track_caller]
fn number_in(object: &[(String, String)], name: &str) -> Option<u64> {
    number(&object.iter().find(|(other, _)| other == name).unwrap_or_else(|| panic!("{name} in {object:?}")).1)
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
fn alone(folder: &Path, file: &str, set: &[String], more: &[&str]) -> (String, String, Cells, Vec<(String, String)>) {
    let mut arguments = vec!["run", file, "--lead", "--message-format", "json", "-o", "alone.csv"];
    let at_times = more.contains(&"--at");
    if !at_times {
        arguments.extend(["--results", "alone.json"]);
    }
    for set in set {
        arguments.extend(["--set", set]);
    }
    arguments.extend(more);
    for name in ["alone.csv", "alone.json"] {
        let _ = fs::remove_file(folder.join(name));
    }
    let ran = output(folder, &arguments);
    let lines = diagnostics(&ran);
    let diagnostics = lines.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    let errors: Vec<_> = diagnostics.filter(|diagnostic| diagnostic["severity"] == "error").collect();
    let is_led = |diagnostics: &&serde_json::Value| diagnostics["code"] != "E0612";
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
    (status, stopped, Cells::of(&table), object(&results))
}

/// Each row of a sweep of results is what `run` makes of it; gives the statuses in order.
#[track_caller]
fn results_are_those_of_runs(
    folder: &Path,
    file: &str,
    params: &[(&str, &str)],
    sweep: &[&str],
    more: &[&str],
) -> Vec<String> {
    let mut arguments = vec!["sweep", file, "-o", "sweep.csv"];
    arguments.extend(sweep);
    arguments.extend(more);
    let swept = output(folder, &arguments);
    assert!([Some(0), Some(3)].contains(&swept.status.code()), "{arguments:?}: {}", diagnostics(&swept));
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
                let wanted = if status.starts_with('E') { None } else { number_in(&results, name) };
                assert_eq!(number(&row[k]), wanted, "{name} with {set:?} {more:?}");
            }
        }
        statuses.push(status);
    }
    statuses
}

#[test]
fn broken_variants_match_single_runs() {
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

/// What may vary: its name, its unit in options and behind a number in SI, and its ends.
type Range = (&'static str, &'static str, &'static str, f64, f64);

const RANGES: [Range; 6] = [
    ("ground_length", "mm", " m", 60.0, 160.0),
    ("crank_length", "mm", " m", -10.0, 80.0),
    ("pen.x", "mm", " m", -50.0, 50.0),
    ("speed", "rpm", "/s", -60.0, 90.0),
    ("gap", "", "", -1.0, 2.0),
    ("span", "s", " s", -0.1, 1.0),
];

/// A random `--vary`: an even one, a list, a file; a range that is to be sampled if that is wanted.
fn random_vary(path: &Path, name: &str, of: &Range, is_sampled: Option<bool>, random: &mut Random) -> String {
    let (param, unit, _, low, high) = of;
    let mut value = || format!("{:.3}", random.between(*low, *high));
    let [a, b, c] = [value(), value(), value()];
    match random.below(3) {
        _ if is_sampled == Some(true) => format!("{param}={a}{unit}..{b}{unit}"),
        0 if is_sampled.is_none() => format!("{param}={a}{unit}..{b}{unit}:{}", 1 + random.below(4)),
        1 => {
            let head = if unit.is_empty() { (*param).to_owned() } else { format!("{param} [{unit}]") };
            fs::write(path.join(name), format!("{head}\n{a}\n{b}\n")).unwrap();
            format!("@{name}")
        }
        _ => format!("{param}={a}{unit},{b}{unit},{c}{unit}"),
    }
}

/// Random options together, against runs: rows and results, to the bit.
#[test]
fn random_sweeps_match_single_runs() {
    let folder = in_folder(&[("a.mech", FOUR_BAR)]);
    let path = folder.path();
    let mut random = Random::new(7);
    let mut statuses = Vec::new();
    for round in 0..12 {
        let mut rest = RANGES.to_vec();
        let taken: Vec<Range> = (0..=random.below(3)).map(|_| rest.swap_remove(random.below(rest.len()))).collect();
        let is_sample = random.below(3) == 0;
        let mut vary = Vec::new();
        for (k, of) in taken.iter().enumerate() {
            let file = format!("{round}{k}.csv");
            vary.push(random_vary(path, &file, of, is_sample.then_some(k == 0), &mut random));
        }
        let mut sweep: Vec<&str> = vary.iter().flat_map(|vary| ["--vary", vary]).collect();
        if is_sample {
            sweep.extend(["--sample", "4"]);
        }
        let others: [&[&str]; 4] = [
            &["--to", "0.4s"],
            &["--every", "0.03s"],
            &["--result", "peak = max(abs(der(der(height))))"],
            &["--pass-bifurcations"],
        ];
        let more: Vec<&str> = others.iter().filter(|_| random.below(3) == 0).flat_map(|words| words.to_vec()).collect();
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
        let is_there = !diagnostics(&made).contains("that this processor has");
        is_there.then(|| fs::read(path.join(name)).expect("a table"))
    };
    let whole = bytes("whole.csv", &["--jobs", "1"]).expect("a table");
    for with in
        [["--jobs", "2"], ["--jobs", "16"], ["--vectors", "base"], ["--vectors", "avx2"], ["--vectors", "avx512"]]
    {
        assert!(bytes("again.csv", &with).is_none_or(|again| again == whole), "{sweep:?} {more:?} {with:?}");
    }
    let count = String::from_utf8_lossy(&whole).lines().count() - 1;
    if count > 1 {
        let cut = (1 + random.below(count - 1)).to_string();
        let [mut first, second] =
            [["--take", &cut], ["--skip", &cut]].map(|with| bytes("share.csv", &with).expect("a table"));
        let header = second.iter().position(|byte| *byte == b'\n').expect("a header") + 1;
        first.extend(&second[header..]);
        assert!(first == whole, "{sweep:?} {more:?}, shares at {cut}");
    }
}

fn rows_are_those_of_runs(path: &Path, params: &[(&str, &str)], (sweep, more): (&[&str], &[&str])) {
    let more: Vec<&str> =
        more.iter().copied().filter(|word| *word != "--result" && !word.starts_with("peak")).collect();
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
    let mut lines = text.lines().map(object).peekable();
    let is_of = |line: &[(String, String)], variant: usize| line[0] == ("variant".to_owned(), variant.to_string());
    for (variant, row) in listed.rows.iter().enumerate() {
        let set = settings(&listed, row, params);
        let more: Vec<&str> = more.iter().copied().chain(columns).collect();
        let (_, _, rows, _) = alone(path, "a.mech", &set, &more);
        for row in &rows.rows {
            let line = lines.next_if(|line| is_of(line, variant)).unwrap_or_else(|| panic!("a row of {set:?}"));
            for (name, cell) in rows.names.iter().zip(row) {
                assert_eq!(number_in(&line, name), number(cell), "{name} with {set:?} {more:?}");
            }
        }
        assert!(lines.peek().is_none_or(|line| !is_of(line, variant)), "more rows than {set:?} has");
    }
    assert!(lines.next().is_none(), "rows of nobody");
}

#[test]
fn sweep_sensitivities_match_differences() {
    let folder = in_folder(&[("a.mech", FOUR_BAR)]);
    let columns = ["height", "height.d", "height.dd"];
    let derivatives = columns.map(|column| format!("{column}.by.crank_length"));
    let mut sweep = vec!["sweep", "a.mech", "--vary", "crank_length=29.999mm,30mm,30.001mm", "--rows"];
    sweep.extend(["--by", "crank_length"]);
    sweep
        .extend(columns.iter().copied().chain(derivatives.iter().map(String::as_str)).flat_map(|of| ["--columns", of]));
    let cells = Cells::of(&String::from_utf8(output(folder.path(), &sweep).stdout).expect("text"));
    let rows = cells.rows.len() / 3;
    assert_eq!(rows, 21);
    let value = |row: usize, name: &str| cells.rows[row][cells.column(name)].parse::<f64>().expect("a number");
    for (column, derivative) in columns.iter().zip(&derivatives) {
        let size = (0..rows).map(|row| value(rows + row, derivative).abs()).fold(0.0, f64::max);
        for row in 0..rows {
            let [less, more] = [row, 2 * rows + row].map(|row| value(row, column));
            let (wanted, found) = ((more - less) / 2e-6, value(rows + row, derivative));
            assert!(
                (found - wanted).abs() < 1e-6 * size,
                "{derivative} in row {row}: {found}, by differences {wanted}"
            );
        }
    }
}

// ---- interruptions

/// Starts a sweep, and lets it write so many bytes, or all that it has.
fn begun(folder: &Path, arguments: &[&str], size: u64) -> Child {
    let mut child = mechc(folder).args(arguments).stderr(Stdio::piped()).spawn().expect("it runs");
    let is_written = |entry: fs::DirEntry| {
        let is_hidden = entry.file_name().to_string_lossy().starts_with('.');
        is_hidden && entry.metadata().is_ok_and(|found| found.len() >= size)
    };
    while !fs::read_dir(folder).expect("a folder").flatten().any(is_written) {
        if child.try_wait().expect("a state").is_some() {
            break;
        }
        sleep(Duration::from_millis(1));
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
fn killed_sweeps_leave_no_file() {
    for out in ["new.csv", "old.json", "old.parquet"] {
        let folder = slider_crank();
        let path = folder.path();
        if out.starts_with("old") {
            fs::write(path.join(out), "precious").unwrap();
        }
        let sweep = ["sweep", "a.mech", "--vary", "rod_length=100mm..200mm:100000000", "--rows", "-o", out];
        // a part of a Parquet file comes late
        let mut child = begun(path, &sweep, u64::from(!out.ends_with("parquet")));
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

/// Interrupts a sweep of so many variants somewhere between, and gives the number that it tells to go on with.
fn interrupted_within(path: &Path, arguments: &[&str], count: usize) -> String {
    // it is told by what is written, whatever time that takes: some bytes may be less than a variant, or all
    let (mut early, mut late, mut size) = (0, None, 1);
    for _ in 0..100 {
        let mut child = begun(path, arguments, size);
        if child.try_wait().expect("a state").is_none() {
            signal(&child, "-2");
        }
        let ended = child.wait_with_output().expect("it ends");
        let reported = diagnostics(&ended);
        if ended.status.code() == Some(0) {
            late = Some(size);
        } else {
            assert_eq!(ended.status.code(), Some(130), "{reported}");
            let skip = reported.split("--skip ").nth(1).and_then(|rest| rest.split('`').next()).expect("how to go on");
            let done: usize = skip.parse().expect("a number");
            assert!(reported.contains(&format!("interrupted: {done} of {count} variants are written")), "{reported}");
            if done > 0 {
                assert!(done < count, "{reported}");
                return skip.to_owned();
            }
            early = size;
        }
        size = late.filter(|late| early + 1 < *late).map_or(2 * early.max(1), |late| u64::midpoint(early, late));
    }
    panic!("between {early} and {late:?} bytes there is no moment at which some is written");
}

#[test]
fn interrupted_sweeps_keep_whole_variants_and_resume() {
    const COUNT: usize = 2000;
    // rows enough to be interrupted among them
    const ROWS: usize = 401;
    // variants whose driver does not go straight on go one by one: there is time to interrupt them
    let text = fs::read_to_string("examples/slider_crank.mech").unwrap();
    let slow = text.replace("speed * t", "speed * t + 1 deg * sin(speed * t)");
    assert_ne!(slow, text);
    for out in ["part.csv", "part.json", "part.parquet"] {
        let folder = in_folder(&[("a.mech", slow.as_str())]);
        let path = folder.path();
        let range = format!("rod_length=100mm..200mm:{COUNT}");
        let sweep = ["sweep", "a.mech", "--vary", &range, "--rows", "--columns", "travel*", "--every", "0.1ms"];
        let with = |more: &[&'static str]| -> Vec<String> {
            sweep.iter().map(|word| (*word).to_owned()).chain(more.iter().map(|word| (*word).to_owned())).collect()
        };
        let arguments: Vec<&str> = sweep.into_iter().chain(["--jobs", "1", "-o", out]).collect();
        let skip = interrupted_within(path, &arguments, COUNT);
        let ending = out.split_once('.').expect("an ending").1;
        let [rest, whole] = ["rest", "whole"].map(|name| format!("{name}.{ending}"));
        let mut more: Vec<String> = with(&["--skip"]);
        more.extend([skip, "-o".to_owned(), rest.clone()]);
        assert!(mechc(path).args(&more).output().expect("it runs").status.success());
        let mut more = with(&["-o"]);
        more.push(whole.clone());
        assert!(mechc(path).args(&more).output().expect("it runs").status.success());
        let rows: Vec<String> = all_rows(&path.join(out)).into_iter().chain(all_rows(&path.join(rest))).collect();
        assert_eq!(rows.len(), COUNT * ROWS, "{out}");
        assert!(rows == all_rows(&path.join(whole)), "{out}: parts put together are the whole");
    }
}

// ---- what was read

#[test]
fn sweep_tables_do_not_overwrite_inputs() {
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
        assert_eq!(refused.status.code(), Some(2), "{command:?} {out}: {}", diagnostics(&refused));
        assert!(diagnostics(&refused).contains("would be written over"), "{}", diagnostics(&refused));
    }
    let behind: Vec<Vec<u8>> = ["a.mech", "v.csv"].map(|name| fs::read(path.join(name)).unwrap()).to_vec();
    assert!(before == behind);
}

// ---- what decides what is repeated

#[test]
fn copy_counts_are_separate_mechanisms() {
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
    let rows = output(
        path,
        &["sweep", "a.mech", "--vary", "cells=3,5", "--rows", "--columns", "rise", "--columns", "up[*].x", "--at", "1"],
    );
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
        // though the text has four
        assert_eq!(found[at("up[4].x")].is_empty(), count == "3", "five cells have a fifth");
    }
}

/// An arm, with a param that decides how fast it turns.
const ARM: &str = "mechanism m {
    param c = 1
    param w = 60 rpm
    param gap = 1 mm
    ground { point O = (0, 0) }
    body arm { point O = (0, 0) point E = (1 m, gap) }
    joint j: revolute(ground.O, arm.O)
    driver motor: rotation(j) = c * w * t
    result r = max(x(arm.E))
    analysis from 0 s to 1 s every 0.1 s
}";

/// What is looked for decides nothing of a variant, is found where it is the last, and is not fulfilled by what is not there.
#[test]
fn sweeps_end_at_the_first_match() {
    let folder = in_folder(&[("a.mech", ARM)]);
    let swept = |more: &[&str]| {
        let output = output(folder.path(), &[&["sweep", "a.mech"], more].concat());
        (String::from_utf8(output.stdout.clone()).unwrap().lines().count() - 1, diagnostics(&output))
    };
    for (more, rows, found) in [
        (vec!["--vary", "c=1,2,3", "--until", "c > 1.5"], 2, Some(1)),
        // the last one
        (vec!["--vary", "c=1,2,3", "--until", "c > 2.5"], 3, Some(2)),
        (vec!["--vary", "c=1,2,3", "--until", "c > 1.5", "--take", "2"], 2, Some(1)),
        (vec!["--vary", "c=1,2,3", "--until", "c > 5"], 3, None),
        // of what is not finite
        (vec!["--vary", "c=0,1,2", "--until", "1/c > 0.4"], 2, Some(1)),
        (vec!["--vary", "c=0,1,2", "--set", "w=0rpm", "--until", "1/(c - 1) > 0.4"], 3, Some(2)),
        (vec!["--vary", "c=0,1,2", "--result", "q=r/c", "--until", "q > 0.5 m"], 2, Some(1)),
        (vec!["--vary", "c=1,2,3", "--result", "q=sqrt(r / 1 m - 9)", "--until", "not (q > 0)"], 3, None),
        (vec!["--vary", "c=1,2,3", "--result", "q=sqrt(r / 1 m - 9)", "--until", "q != 0"], 3, None),
    ] {
        let (count, diagnostics) = swept(&more);
        assert_eq!(count, rows, "{more:?}: {diagnostics}");
        assert!(diagnostics.contains(&format!("{rows} ok")), "{more:?}: {diagnostics}");
        let reported = found.map(|variant| format!("variant {variant} is the first with"));
        assert!(
            diagnostics.contains(reported.as_deref().unwrap_or("no variant that ran to its end was found")),
            "{more:?}: {diagnostics}"
        );
    }
}

/// A zero fits anything, and a number without a unit what has none.
#[test]
fn zeros_need_no_unit() {
    for (table, ok) in
        [("w\n0\n-0.0\n", true), ("gap,w [rpm]\n0,30\n0,0\n", true), ("gap\n0\n1\n", false), ("c\n0\n1\n", true)]
    {
        let folder = in_folder(&[("a.mech", ARM), ("v.csv", table)]);
        let swept = output(folder.path(), &["sweep", "a.mech", "--vary", "@v.csv"]);
        assert_eq!(swept.status.code(), Some(i32::from(!ok)), "{table}: {}", diagnostics(&swept));
        assert!(
            diagnostics(&swept).contains(if ok { "2 ok" } else { "must be a length" }),
            "{table}: {}",
            diagnostics(&swept)
        );
    }
    let folder = in_folder(&[("a.mech", ARM)]);
    let swept = output(folder.path(), &["sweep", "a.mech", "--vary", "gap=0,0", "--vary", "w=0..0:2"]);
    assert!(diagnostics(&swept).contains("4 ok"), "{}", diagnostics(&swept));
}

#[test]
fn invalid_sweeps_are_refused_early() {
    let leg = "mechanism leg { param a = 1 m body b { point O = (0, 0) point P = (a, 0) }
        joint j: revolute(ground.O, b.O) ground { point O = (0, 0) } driver d: rotation(j) = t }
        mechanism all { part leg[k in 0..2]: leg() result r = max(x(leg[1].b.P)) analysis from 0 s to 1 s every 0.1 s }";
    let folder = in_folder(&[("a.mech", ARM), ("legs.mech", leg)]);
    let refused = |arguments: &[&str], why: &str| {
        let output = output(folder.path(), &[arguments, &["-o", "out.csv"]].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", diagnostics(&output));
        assert!(diagnostics(&output).contains(why), "{arguments:?}: {}", diagnostics(&output));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "{arguments:?} leaves nothing behind");
    };
    let rows = ["sweep", "a.mech", "--vary", "c=0..1:3", "--rows"];
    refused(&[&rows[..], &["--every", "1e-10"]].concat(), "a variant would have 10000000001 rows of");
    refused(
        &[&rows[..], &["--result", "q=max(y(arm.E))"]].concat(),
        "`--result` asks for a number of the whole analysis",
    );
    let legs = ["sweep", "legs.mech", "--mechanism", "all"];
    let copy_first = [&legs[..], &["--vary", "leg[1].a=1m,2m", "--vary", "leg.a=1m,3m"]].concat();
    refused(&copy_first, "`leg[1].a` would be what `leg.a` is");
    let all_first = [&legs[..], &["--vary", "leg.a=1m,3m", "--vary", "leg[1].a=1m,2m"]].concat();
    assert!(diagnostics(&output(folder.path(), &all_first)).contains("4 ok"));
    // at the end of as many variants as can be counted
    let last = ["--vary", "c=0..1:18446744073709551615", "--skip", "18446744073709551610", "--take", "100", "--yes"];
    let last = output(folder.path(), &[&["sweep", "a.mech"][..], &last].concat());
    assert!(diagnostics(&last).contains("5 ok"), "{}", diagnostics(&last));
    // between ends whose difference is no number
    let far = output(folder.path(), &["sweep", "a.mech", "--vary", "c=-1e308..1e308:5", "--set", "w=0rpm"]);
    let far = String::from_utf8(far.stdout).unwrap();
    let second: Vec<&str> = far.lines().map(|line| line.split(',').nth(1).unwrap()).collect();
    assert_eq!(second, ["c", "-1e+308", "-5e+307", "0.0", "5e+307", "1e+308"]);
}
