//! `influence` and `sensitivity` of emitted code: they have the bits of the columns `q.by.NAME` of `mechc run --by NAME`.
//! `cargo test --test slopes chain` looks at the text of that name.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod support;

#[path = "emitted/compiling.rs"]
mod compiling;

use compiling::{bits_of, compile};
use mechc::rooms::expr::Symbol;
use mechc::{Cancel, Choice, Compiled, Parsed, Redundant, RustOptions, Times};
use std::fs;
use std::path::Path;
use std::process::Command;
use support::{Disk, all_rows};

/// Rows that are looked at.
const ROWS: u32 = 12;

/// Says where a module is at some times, led by time and then by its inputs: its row, then the derivatives of `q` by each input, then those
/// by each parameter.
const PROGRAM: &str = r#"
fn print(values: &[f64]) {
    let bits: Vec<String> = values.iter().map(|value| value.to_bits().to_string()).collect();
    println!("{}", bits.join(" "));
}
fn main() {
    let p = Params::default();
    for is_led in LED {
        let mut state = assemble(&p).unwrap();
        for t in TIMES {
            if is_led { FOLLOW } else { step(t, &mut state).unwrap() }
            print(&state.row());
            INFLUENCE
            sensitivity(&p, &state).unwrap().iter().for_each(|by| print(by));
        }
    }
}
"#;

fn compiled(path: &Path, choice: &Choice) -> Compiled {
    let text = fs::read_to_string(path).expect("a text");
    let mut sources = mechc::Sources::default();
    let file = sources.add(path.display().to_string(), &text);
    let checked = Parsed::of_source(sources, file, path).check(choice, &Disk::default());
    let (compiled, said) = checked.compile(Redundant::Refused, &Cancel::default());
    compiled.unwrap_or_else(|| panic!("{}: {:?} {said:?}", path.display(), checked.diagnostics()))
}

/// What a program with a module prints, line by line, as bits.
fn printed(module: &str, program: &str) -> Vec<Vec<u64>> {
    let folder = tempfile::tempdir().expect("a folder");
    let [source, binary] = ["main.rs", "main"].map(|name| folder.path().join(name));
    fs::write(folder.path().join("machine.rs"), module).expect("written");
    let head = "#![allow(dead_code, unused_imports)]\nmod machine;\nuse machine::*;\n";
    fs::write(&source, format!("{head}{program}")).expect("written");
    compile("rustc", &["-o", &binary.to_string_lossy()], &source).unwrap_or_else(|why| panic!("{why}"));
    let output = Command::new(&binary).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("text");
    let number = |word: &str| word.parse().expect("bits");
    text.lines().map(|line| line.split_whitespace().map(number).collect()).collect()
}

/// Holds the first mechanism of a file against its interpreter; gives how many derivatives were alike that are not 0.
fn holds(path: &str, largest_straight: usize) -> usize {
    let path = Path::new(path);
    let plain = compiled(path, &Choice::default());
    let (determined, _) = plain.inside();
    let system = determined.system();
    let inputs: Vec<&str> = system.inputs.iter().map(|input| input.name.as_str()).collect();
    let names: Vec<&str> =
        inputs.iter().copied().chain(system.params.iter().map(|param| param.name.as_str())).collect();
    assert!(!names.is_empty(), "{}: nothing to differentiate by", path.display());

    let by = names.iter().map(|&name| name.to_owned()).collect();
    let varied = compiled(path, &Choice { by, ..Choice::default() });
    let [from, to, _] = plain.analysis().expect("an analysis");
    // beside edges, on which the two sides differ
    let times: Vec<f64> = (0..ROWS).map(|k| from + (to - from) * (f64::from(k) + 0.37) / f64::from(ROWS)).collect();
    let (rows, stop) = all_rows(&varied, &Times::listed(from, times.clone()));
    assert!(stop.is_none(), "{}: {stop:?}", path.display());

    let options = RustOptions { with_sensitivities: true, largest_straight, ..RustOptions::of("machine.mech") };
    let (module, said) = plain.rust(&options);
    let module = module.unwrap_or_else(|| panic!("{}: {said:?}", path.display()));
    let is_led = !inputs.is_empty();
    let program = PROGRAM
        .replace("LED", if is_led { "[false, true]" } else { "[false]" })
        .replace("TIMES", &format!("{times:?}"))
        .replace("FOLLOW", if is_led { "follow(&Inputs::at(t, &p), &mut state).unwrap()" } else { "()" })
        .replace(
            "INFLUENCE",
            if is_led { "influence(&state).unwrap().iter().take(COUNT).for_each(|by| print(by));" } else { "" },
        )
        // time may be a signal behind them
        .replace("COUNT", &inputs.len().to_string());
    let found = printed(&module, &program);

    let param = |name: &str| system.params.iter().position(|param| param.name == name).map(|k| Symbol::Param(k as u32));
    let moves_an_input = |name: &str| {
        let formulas = system.inputs.iter().map(|input| input.formulas[0]);
        param(name).is_some_and(|param| formulas.into_iter().any(|id| system.graph.symbols(id).contains(&param)))
    };
    let columns = varied.columns();
    let place = |name: &str| columns.iter().position(|column| column == name).unwrap_or_else(|| panic!("no {name}"));
    let mut alike = 0;
    let lines = 1 + names.len();
    let ways = if is_led { 2 } else { 1 };
    assert_eq!(found.len(), ways * rows.len() * lines);
    for (k, lines) in found.chunks(lines).enumerate() {
        let (is_led, row) = (k >= rows.len(), &rows[k % rows.len()]);
        for (column, bits) in plain.columns().iter().zip(&lines[0]).skip(1) {
            let (found, wanted) = (f64::from_bits(*bits), row[place(column)]);
            // what the third derivative of an input decides is left out, and a rate by way of the slopes is rounded otherwise
            if !is_led || system.coordinates.iter().any(|coordinate| coordinate.name == *column) {
                assert_eq!(bits_of(found), bits_of(wanted), "{column} at t = {}: {found}, not {wanted}", row[0]);
            }
        }
        for (number, (name, line)) in names.iter().zip(&lines[1..]).enumerate() {
            // where inputs have led they are held, whatever their formulas are made of
            let is_held = is_led && number >= inputs.len();
            for (coordinate, bits) in system.coordinates.iter().zip(line) {
                let column = format!("{}.by.{name}", coordinate.name);
                let (wanted, found) = (row[place(&column)], f64::from_bits(*bits));
                if is_held && moves_an_input(name) {
                    continue;
                }
                assert_eq!(
                    bits_of(found),
                    bits_of(wanted),
                    "{}: {column} at t = {}, led: {is_led}: {found} instead of {wanted}",
                    path.display(),
                    row[0]
                );
                alike += usize::from(wanted != 0.0);
            }
        }
    }
    alike
}

/// As lines, and as numbers.
fn holds_both_ways(path: &str, least: usize) {
    for largest_straight in [mechc::LARGEST_STRAIGHT, 0] {
        let alike = holds(path, largest_straight);
        assert!(alike >= least, "{alike} numbers");
    }
}

#[test]
fn four_bar() {
    holds_both_ways("tests/following/four_bar.mech", 200);
}

#[test]
fn slider_crank() {
    holds_both_ways("tests/following/slider_crank.mech", 300);
}

#[test]
fn platform() {
    holds_both_ways("tests/following/platform.mech", 500);
}

#[test]
fn chain() {
    holds_both_ways("tests/slopes/chain.mech", 800);
}

#[test]
fn parts() {
    holds_both_ways("tests/slopes/drive.mech", 1000);
}

#[test]
fn tables() {
    holds_both_ways("tests/sensitivities/tables.mech", 50);
}

#[test]
fn places() {
    holds_both_ways("tests/sensitivities/places.mech", 300);
}

#[test]
fn quantities() {
    holds_both_ways("tests/sensitivities/quantities.mech", 100);
}
