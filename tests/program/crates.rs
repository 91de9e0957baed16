//! Emitted crates: what is in their files, and when a folder is left alone. `.ci/run` builds and tests some of them.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::{Span, compile_number, files, run_number};
use assert_cmd::Command;
use mechc::{CrateFile, MARK, RustOptions};
use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

const SLIDER_CRANK: &str = "examples/slider_crank.mech";

/// A crate by the paths of its files, and the rows that it is checked against.
struct Crate {
    files: BTreeMap<String, String>,
    rows: Vec<Vec<f64>>,
}

fn emitted(path: &Path, text: &str) -> Crate {
    let name = path.file_name().expect("a name").to_string_lossy();
    let compiled = compile_number(path, text, 0).0.expect("determined");
    let (files, _) = compiled.package("a_crate", &RustOptions::new(name));
    let files: BTreeMap<_, _> =
        files.expect("it assembles").into_iter().map(|CrateFile { path, text }| (path, text)).collect();
    let rows = table(&files["tests/reference.rs"]).chunks(compiled.columns().len()).map(<[f64]>::to_vec).collect();
    Crate { files, rows }
}

/// The numbers of the test's table.
fn table(test: &str) -> Vec<f64> {
    let (_, rows) = test.split_once("const ROWS").expect("a table");
    let (_, rows) = rows.split_once("= [").expect("rows");
    let numbers = rows.split([',', '[', ']', ';']).map(str::trim).filter(|text| !text.is_empty());
    numbers.map(|number| number.parse().expect("a number")).collect()
}

/// The names of the test's columns.
fn names(test: &str) -> Vec<String> {
    let (_, names) = test.split_once("const NAMES: [&str; COLUMNS] = [").expect("names");
    let (names, _) = names.split_once("];").expect("an end");
    names.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

/// How many steps the benchmark takes.
fn steps(benchmark: &str) -> usize {
    let (_, steps) = benchmark.split_once("const STEPS: u32 = ").expect("steps");
    steps.split_once(';').expect("an end").0.parse().expect("a number")
}

/// Examples, and mechanisms with what is rare: odd names, tables, jerk.
fn mechanisms() -> Vec<PathBuf> {
    [files("examples", "mech"), files("tests/stages", "mech"), files("tests/following", "mech")].concat()
}

#[test]
fn the_table_of_the_test_has_the_rows_of_the_interpreter() {
    for path in mechanisms() {
        let text = fs::read_to_string(&path).expect("a text");
        let Crate { files, rows } = emitted(&path, &text);
        let all = run_number(&path, &text, 0, Span::default()).expect_success();
        assert_eq!(names(&files["tests/reference.rs"]), all.columns);
        assert_eq!(rows.len(), all.rows.len().min(20), "{}", path.display());
        assert_eq!(steps(&files["benches/steps.rs"]) + 1, all.rows.len());
        assert!(rows.is_sorted_by(|a, b| a[0] < b[0]));
        let bits = |row: &Vec<f64>| row.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
        assert_eq!(rows.first().map(bits), all.rows.first().map(bits), "{}", path.display());
        assert_eq!(rows.last().map(bits), all.rows.last().map(bits), "{}", path.display());
        let known: HashSet<Vec<u64>> = all.rows.iter().map(bits).collect();
        assert!(rows.iter().all(|row| known.contains(&bits(row))), "{}", path.display());
    }
}

#[test]
fn files_are_marked_and_complete() {
    for path in mechanisms() {
        let Crate { files, .. } = emitted(&path, &fs::read_to_string(&path).expect("a text"));
        for (file, text) in &files {
            assert!(text.lines().take(6).any(|line| line.contains(MARK)), "{file}");
            assert!(!text.contains('$'), "{file}");
            assert!(text.ends_with('\n') && !text.ends_with("\n\n"), "{file}");
        }
        let manifest = &files["Cargo.toml"];
        let name = manifest.split('"').nth(1).expect("a name");
        assert!(name.starts_with(|c: char| c.is_ascii_lowercase()), "{name}");
        assert!(name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_'), "{name}");
        assert_eq!(manifest.contains("libm"), files["src/mechanism.rs"].contains("libm::"), "{name}");
        assert_eq!(files["README.md"].contains("libm"), manifest.contains("libm"), "{name}");
        assert!(files["README.md"].contains(&format!("use {name}::{{")), "{name}");
    }
}

#[test]
fn crates_are_formatted() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut paths = Vec::new();
    for (number, path) in mechanisms().into_iter().enumerate() {
        let Crate { files, .. } = emitted(&path, &fs::read_to_string(&path).expect("a text"));
        for (file, text) in files.iter().filter(|(file, _)| file.ends_with("s.rs") || file.ends_with("e.rs")) {
            let path = folder.path().join(format!("{number}_{}", file.replace('/', "_")));
            fs::write(&path, text).expect("written");
            paths.push(path);
        }
    }
    let mut rustfmt = std::process::Command::new("rustfmt");
    let output = rustfmt.args(["--check", "--edition", "2024"]).args(&paths).output().expect("rustfmt");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}

#[test]
fn without_an_analysis_the_first_second_is_taken() {
    let text = fs::read_to_string(SLIDER_CRANK).unwrap().replace("analysis", "// analysis");
    let Crate { rows, .. } = emitted(Path::new("slider_crank.mech"), &text);
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(times.len(), 10);
    assert_eq!((times[0], times[9]), (0.0, 0.9));
}

#[test]
fn an_analysis_of_one_time_has_one_row() {
    let text = fs::read_to_string(SLIDER_CRANK).unwrap().replace("to 40 ms every 0.5 ms", "to 0 s every 1 ms");
    let Crate { rows, files } = emitted(Path::new("slider_crank.mech"), &text);
    assert_eq!(rows.len(), 1);
    assert!(files["README.md"].contains("for t in [0.0] {"));
}

/// `mechc emit … --crate …` with an exit code, and what it said.
fn emit_crate(arguments: &[&str], code: i32) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_mechc")).arg("emit").args(arguments).output().expect("it runs");
    let text = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
    assert!(output.stdout.is_empty());
    text
}

/// The files below a folder, in order, with `/`.
fn inside(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(&next).expect("a folder") {
            let path = entry.expect("it can be read").path();
            if path.is_dir() {
                open.push(path);
            } else {
                found.push(path.strip_prefix(folder).expect("inside").to_string_lossy().replace('\\', "/"));
            }
        }
    }
    found.sort();
    found
}

#[test]
fn emitted_files_are_replaced() {
    let folder = tempfile::tempdir().expect("a folder");
    let target = folder.path().join("a_crate");
    let name = target.to_string_lossy();
    assert_eq!(emit_crate(&[SLIDER_CRANK, "--crate", &name], 0), "");
    let manifest = fs::read_to_string(target.join("Cargo.toml")).unwrap();
    let wanted = [
        "Cargo.toml",
        "README.md",
        "benches/steps.rs",
        "examples/work.rs",
        "src/lib.rs",
        "src/mechanism.rs",
        "tests/reference.rs",
    ];
    assert_eq!(inside(&target), wanted);
    fs::write(target.join("src/more.rs"), "mine").unwrap();
    emit_crate(&[SLIDER_CRANK, "--crate", &name, "--set", "rod_length=200mm"], 0);
    assert_eq!(fs::read_to_string(target.join("Cargo.toml")).unwrap(), manifest);
    assert!(
        fs::read_to_string(target.join("README.md")).unwrap().contains("| `rod_length` | `rod_length` | m | 0.2 |")
    );
    assert_eq!(fs::read_to_string(target.join("src/more.rs")).unwrap(), "mine");
}

#[test]
fn crates_are_named_after_their_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let manifest = |name: &str| fs::read_to_string(folder.path().join(name).join("Cargo.toml")).unwrap();
    for (name, wanted) in [("enc", "enc"), ("hand-wheel", "hand-wheel"), ("Enc2", "enc2"), ("3 rods", "n3_rods")] {
        emit_crate(&[SLIDER_CRANK, "--crate", &format!("{}/{name}/", folder.path().display())], 0);
        assert!(manifest(name).contains(&format!("\nname = \"{wanted}\"\n")), "{}", manifest(name));
        let test = fs::read_to_string(folder.path().join(name).join("tests/reference.rs")).unwrap();
        assert!(test.contains(&format!("\nuse {}::{{", wanted.replace('-', "_"))), "{test}");
    }
    // where one stands already
    let here = folder.path().join("here");
    fs::create_dir(&here).unwrap();
    let file = fs::canonicalize(SLIDER_CRANK).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_mechc"));
    assert!(command.arg("emit").arg(file).args(["--crate", "."]).current_dir(&here).output().unwrap().status.success());
    assert!(manifest("here").contains("\nname = \"here\"\n"));
}

#[test]
fn user_files_stay() {
    let folder = tempfile::tempdir().expect("a folder");
    let name = folder.path().to_string_lossy();
    fs::create_dir(folder.path().join("tests")).unwrap();
    fs::write(folder.path().join("tests/reference.rs"), "// mine\n").unwrap();
    let diagnostics = emit_crate(&[SLIDER_CRANK, "--crate", &name], 4);
    assert!(diagnostics.contains("E0702") && diagnostics.contains("reference.rs`: a file is there"), "{diagnostics}");
    assert_eq!(inside(folder.path()), ["tests/reference.rs"], "nothing is written beside it");
    let file = folder.path().join("tests/reference.rs");
    assert!(emit_crate(&[SLIDER_CRANK, "--crate", &file.to_string_lossy()], 4).contains("it is a file"));
    let far = folder.path().join("no/such");
    assert!(emit_crate(&[SLIDER_CRANK, "--crate", &far.to_string_lossy()], 4).contains("there is no folder"));
    assert!(emit_crate(&[SLIDER_CRANK, "--crate", ""], 4).contains("E0702"));
}

#[test]
fn obsolete_emitted_files_are_removed() {
    let folder = tempfile::tempdir().expect("a folder");
    let target = folder.path().join("a_crate");
    let name = target.to_string_lossy();
    emit_crate(&[SLIDER_CRANK, "--crate", &name, "--ffi"], 0);
    let header = target.join("include/a_crate.h");
    // the crate had another name once
    fs::copy(&header, target.join("include/before.h")).unwrap();
    fs::write(target.join("include/mine.h"), "/* mine */\n").unwrap();
    let diagnostics = emit_crate(&["examples/trammel.mech", "--crate", &name, "--ffi"], 0);
    assert_eq!(diagnostics, format!("removed `{name}/include/before.h`, which is no longer a part of the crate\n"));
    assert!(fs::read_to_string(&header).unwrap().contains("mechanism trammel"));
    let diagnostics = emit_crate(&["examples/trammel.mech", "--crate", &name], 0);
    assert!(diagnostics.contains("include/a_crate.h`") && diagnostics.contains("src/unsafe_c.rs`"), "{diagnostics}");
    let left = [
        "Cargo.toml",
        "README.md",
        "benches/steps.rs",
        "examples/work.rs",
        "include/mine.h",
        "src/lib.rs",
        "src/mechanism.rs",
    ];
    assert_eq!(inside(&target), [&left[..], &["tests/reference.rs"]].concat());
    fs::remove_file(target.join("include/mine.h")).unwrap();
    emit_crate(&[SLIDER_CRANK, "--crate", &name, "--ffi"], 0);
    emit_crate(&[SLIDER_CRANK, "--crate", &name], 0);
    assert!(!target.join("include").exists(), "nothing is left in it");
}

#[test]
fn stopped_motions_are_emitted_partially() {
    let folder = tempfile::tempdir().expect("a folder");
    let target = folder.path().join("four_bar");
    let diagnostics = emit_crate(&["tests/ui/run/four_bar_into_lock_up.mech", "--crate", &target.to_string_lossy()], 3);
    assert!(diagnostics.contains("E0602"), "{diagnostics}");
    let page = fs::read_to_string(target.join("README.md")).unwrap();
    assert!(page.contains("ends before the file's analysis does: the mechanism locks up at t = 0.3758"), "{page}");
    let numbers = table(&fs::read_to_string(target.join("tests/reference.rs")).unwrap());
    assert!(numbers.len() > 10, "{} numbers", numbers.len());
}
