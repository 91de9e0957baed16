//! `influence` and `sensitivity` of emitted code: they have the bits of the columns `q.by.NAME` of `mechc run --by NAME`.
//! `cargo test --test program slopes chain` looks at the text of that name.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support;

use crate::compiling::{bits_of, printed};
use crate::support::{Disk, all_rows};
use mechc::{Cancel, Choice, Compiled, Parsed, Redundant, RustOptions, Times};
use mechc_expr::Symbol;
use std::fs;
use std::path::Path;

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

fn text_of(path: &str) -> String {
    fs::read_to_string(path).expect("a text")
}

fn compiled(path: &Path, text: &str, choice: &Choice) -> Compiled {
    let mut sources = mechc::Sources::default();
    let file = sources.add(path.display().to_string(), text);
    let checked = Parsed::from_source(sources, file, path).check(choice, &Disk::default());
    let (compiled, messages) = checked.compile(Redundant::LeftOut, &Cancel::default());
    compiled.unwrap_or_else(|| panic!("{}: {:?} {messages:?}", path.display(), checked.diagnostics()))
}

/// What a program with a module prints, line by line, as bits.
fn bits(module: &str, program: &str) -> Vec<Vec<u64>> {
    let number = |word: &str| word.parse().expect("bits");
    printed(module, program).iter().map(|line| line.split_whitespace().map(number).collect()).collect()
}

/// Holds the first mechanism of a file against its interpreter; gives how many derivatives were alike that are not 0.
fn holds(path: &str, text: &str) -> usize {
    let path = Path::new(path);
    let plain = compiled(path, text, &Choice::default());
    let (determined, _) = plain.inside();
    let system = determined.system();
    let inputs: Vec<&str> = system.inputs().iter().map(|input| input.name.as_str()).collect();
    let names: Vec<&str> =
        inputs.iter().copied().chain(system.params().iter().map(|param| param.name.as_str())).collect();
    assert!(!names.is_empty(), "{}: nothing to differentiate by", path.display());

    let by = names.iter().map(|&name| name.to_owned()).collect();
    let varied = compiled(path, text, &Choice { by, ..Choice::default() });
    let [from, to, _] = plain.analysis().expect("an analysis");
    // beside edges, on which the two sides differ
    let times: Vec<f64> = (0..ROWS).map(|k| from + (to - from) * (f64::from(k) + 0.37) / f64::from(ROWS)).collect();
    let (rows, stop) = all_rows(&varied, &Times::listed(from, times.clone()));
    assert!(stop.is_none(), "{}: {stop:?}", path.display());

    let options = RustOptions { with_sensitivities: true, ..RustOptions::new("machine.mech") };
    let (module, messages) = plain.rust(&options);
    let module = module.unwrap_or_else(|| panic!("{}: {messages:?}", path.display()));
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
    let found = bits(&module, &program);

    let param =
        |name: &str| system.params().iter().position(|param| param.name == name).map(|k| Symbol::Param(k as u32));
    let moves_an_input = |name: &str| {
        let formulas = system.inputs().iter().map(|input| input.formulas[0]);
        param(name).is_some_and(|param| formulas.into_iter().any(|id| system.graph().symbols(id).contains(&param)))
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
            let is_coordinate = system.coordinates().iter().any(|coordinate| coordinate.name == *column);
            if !is_led || is_coordinate {
                assert_eq!(bits_of(found), bits_of(wanted), "{column} at t = {}: {found}, not {wanted}", row[0]);
            } else if found.is_nan() {
                // what the third derivative of an input decides is left out
                assert!(column.contains(".d") || wanted.is_nan(), "{column}");
            } else {
                let is_same = (found - wanted).abs() <= 1e-9 * (1.0 + wanted.abs());
                assert!(is_same, "{column} at t = {}: {found}, not {wanted}", row[0]);
            }
        }
        for (number, (name, line)) in names.iter().zip(&lines[1..]).enumerate() {
            // where inputs have led they are held, whatever their formulas are made of
            let is_held = is_led && number >= inputs.len();
            for (coordinate, bits) in system.coordinates().iter().zip(line) {
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

/// Holds the first mechanism of a file; at least so many derivatives must be alike.
fn file_holds(path: &str, least: usize) {
    let alike = holds(path, &text_of(path));
    assert!(alike >= least, "{alike} numbers");
}

#[test]
fn four_bar() {
    file_holds("tests/following/four_bar.mech", 200);
}

#[test]
fn slider_crank() {
    file_holds("tests/following/slider_crank.mech", 300);
}

#[test]
fn platform() {
    file_holds("tests/following/platform.mech", 500);
}

#[test]
fn chain() {
    file_holds("tests/slopes/chain.mech", 800);
}

#[test]
fn parts() {
    file_holds("tests/slopes/drive.mech", 1000);
}

#[test]
fn tables() {
    file_holds("tests/sensitivities/tables.mech", 50);
}

#[test]
fn places() {
    file_holds("tests/sensitivities/places.mech", 300);
}

#[test]
fn quantities() {
    file_holds("tests/sensitivities/quantities.mech", 100);
}

#[test]
fn measures_that_are_derivatives() {
    file_holds("tests/slopes/asked.mech", 200);
}

#[test]
fn derivative_measures_survive_poor_pivots() {
    let path = "tests/slopes/asked.mech";
    let compiled = compiled(Path::new(path), &text_of(path), &Choice::default());
    let module = compiled.rust(&RustOptions::new("asked.mech")).0.expect("a module");
    // as if it did everywhere
    let asks = "if !at.is_settled || !at.holds {\n";
    assert_eq!(module.matches(asks).count(), 2, "once, and once more; by time and by inputs alike");
    let module = module.replace(asks, "if t.is_finite() {\n");
    let [from, to, _] = compiled.analysis().expect("an analysis");
    let times: Vec<f64> = (1..=ROWS).map(|k| from + (to - from) * f64::from(k) / f64::from(ROWS + 1)).collect();
    let (rows, _) = all_rows(&compiled, &Times::listed(from, times.clone()));
    let follow = "follow(&Inputs::at(t, &p), &mut state).unwrap()";
    let program = PROGRAM
        .replace("LED", "[false, true]")
        .replace("TIMES", &format!("{times:?}"))
        .replace("FOLLOW", follow)
        .replace("INFLUENCE", "")
        .lines()
        .filter(|line| !line.contains("sensitivity("))
        .fold(String::new(), |text, line| text + line + "\n");
    let found = bits(&module, &program);
    assert_eq!(found.len(), 2 * rows.len());
    let (mut alike, mut other_bits) = (0, 0);
    for (line, row) in found.iter().zip(rows.iter().chain(&rows)) {
        for ((column, bits), wanted) in compiled.columns().iter().zip(line).zip(row).skip(1) {
            let found = f64::from_bits(*bits);
            let is_same = (found - wanted).abs() <= 1e-9 * (1.0 + wanted.abs());
            assert!(is_same, "{column} at t = {}: {found}, not {wanted}", row[0]);
            alike += 1;
            other_bits += usize::from(bits_of(found) != bits_of(*wanted));
        }
    }
    assert!(alike > 1000 && other_bits > 0, "{alike} numbers, {other_bits} rounded otherwise");
}

/// A slider that leads its crank towards the dead point and does not quite get there.
const NEAR: &str = "
mechanism near {
    param crank_length = 50 mm
    param rod_length   = 150 mm
    ground { point O = (0, 0)  axis way = O along (1, 0) }
    body crank  at (0, 0, 40 deg)          { point O = (0, 0)    point pin = (crank_length, 0) }
    body rod    at (38 mm, 32 mm, -12 deg) { point pin = (0, 0)  point eye = (rod_length, 0) }
    body slide  at (185 mm, 0, 0)          { point eye = (0, 0)  axis way = eye along (1, 0) }
    joint main:  revolute(ground.O, crank.O)
    joint big:   revolute(crank.pin, rod.pin)
    joint small: revolute(rod.eye, slide.eye)
    joint guide: translational(ground.way, slide.way)
    driver push: x(slide.eye) = 200 mm - 15 mm * exp(-3 * t / 1 s)
    measure turned = der(angle(crank), rod_length)
    measure plain  = angle(crank)
    analysis from 0 s to 4 s every 50 ms
}
";

#[test]
fn close_to_a_dead_point_measures_that_are_derivatives_have_no_value() {
    let compiled = support::compiled("near.mech", NEAR);
    let module = compiled.rust(&RustOptions::new("near.mech")).0.expect("a module");
    let (rows, stop) = all_rows(&compiled, &compiled.times().expect("times"));
    assert!(stop.is_none(), "{stop:?}");
    let program = r#"
fn main() {
    let mut state = assemble(&Params::default()).unwrap();
    for k in 0..=80 {
        step(0.05 * f64::from(k), &mut state).unwrap();
        let values = state.measures().values;
        println!("{} {}", values[measure::TURNED].to_bits(), values[measure::PLAIN].to_bits());
    }
}
"#;
    let found = bits(&module, program);
    let columns = compiled.columns();
    let place = |name: &str| columns.iter().position(|column| column == name).expect("a column");
    let (mut alike, mut without) = (0, 0);
    for (line, row) in found.iter().zip(&rows) {
        let [turned, plain] = ["turned", "plain"].map(|name| row[place(name)]);
        assert_eq!(line[1], plain.to_bits());
        let found = f64::from_bits(line[0]);
        without += usize::from(found.is_nan() && turned.is_nan());
        if !found.is_nan() && !turned.is_nan() {
            assert_eq!(line[0], turned.to_bits(), "at t = {}", row[0]);
            alike += 1;
        }
    }
    // how near is too near is judged by other means
    assert!(alike > 20 && without > 10 && alike + without > 60, "{alike} alike, {without} without");
}

/// A parallelogram with a third bar, which follows from the others as long as all are as they are.
const THIRD_BAR: &str = "mechanism bars {
    param crank_length = 1 m
    param third        = 0 m
    param width        = 2 m
    param place        = 0.2 m
    input turn = 45 deg + 90 deg/s * t
    ground { point A = (0, 0)  point B = (width, 0)  point E = (1 m, 0) }
    body crank at (0, 0, 45 deg) { point A = (0, 0)  point C = (crank_length, 0) }
    body coupler at (0.7 m, 0.7 m, 0) { point C = (0, 0)  point D = (width, 0)  point F = (1 m, third) }
    body rocker at (2 m, 0, 45 deg) { point B = (0, 0)  point D = (1 m, 0) }
    body flag at (0, 0, 0) { point O = (place, 0) }
    joint A: revolute(ground.A, crank.A)
    joint C: revolute(crank.C, coupler.C)
    joint D: revolute(coupler.D, rocker.D)
    joint B: revolute(ground.B, rocker.B)
    joint F: weld(crank.C, flag.O)
    constraint mid: distance(ground.E, coupler.F) = 1 m
    driver motor: rotation(A) = turn
    measure both  = der(der(angle(rocker), crank_length), turn)
    measure ratio = der(angle(rocker), turn)
    analysis from 0 s to 1 s every 10 ms
}";

#[test]
fn breaking_a_left_out_equation_leaves_no_derivative() {
    assert!(holds("bars.mech", THIRD_BAR) > 300);
}
