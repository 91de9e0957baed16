//! Emitted code that follows inputs: what it makes of an encoder's samples is what `mechc run` makes of them, and what it refuses leaves
//! the state as it was.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod support;

#[path = "emitted/compiling.rs"]
mod compiling;

use compiling::{Emitted, compile};
use mechc::{Choice, Memory, Parsed};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;
use support::all_rows;

fn text_of(name: &str) -> String {
    fs::read_to_string(format!("tests/following/{name}.mech")).expect("a text")
}

fn emitted(text: &str) -> Emitted {
    Emitted::of("machine".to_owned(), text, Path::new("machine.mech"), 0).expect("determined")
}

/// What a program prints that has a module, which firmware could have, and that module's names.
fn printed(module: &str, program: &str) -> Vec<String> {
    let folder = tempfile::tempdir().expect("a folder");
    let [firmware, source, binary] = ["firmware.rs", "main.rs", "main"].map(|name| folder.path().join(name));
    fs::write(&firmware, format!("#![no_std]\n#![forbid(unsafe_code)]\n#![deny(warnings)]\n{module}"))
        .expect("written");
    let out = folder.path().join("firmware.rmeta");
    let arguments = ["--crate-type", "lib", "--emit", "metadata", "-o", &out.to_string_lossy()];
    compile("rustc", &arguments, &firmware).unwrap_or_else(|why| panic!("{why}"));
    fs::write(folder.path().join("machine.rs"), module).expect("written");
    fs::write(&source, format!("#![allow(dead_code)]\nmod machine;\nuse machine::*;\n{program}")).expect("written");
    compile("rustc", &["-o", &binary.to_string_lossy()], &source).unwrap_or_else(|why| panic!("{why}"));
    let output = Command::new(&binary).output().expect("it runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text").lines().map(str::to_owned).collect()
}

/// Numbers of a line.
fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace().map(|word| word.parse().unwrap_or_else(|_| panic!("{word} in {line}"))).collect()
}

/// What an encoder of 4096 counts a turn makes of a signal that goes forth and back, with a jitter of a count.
fn encoder(k: usize, signal: usize) -> f64 {
    let count = std::f64::consts::TAU / 4096.0;
    let t = 1e-3 * k as f64;
    let way = [0.52, 1.571, 3.665, 5.76][signal] + 0.12 * (1.3 * t + 2.0 * signal as f64).sin() * (t * 7.0).sin();
    let jitter = [0.0, 1.0, 0.0, -1.0, 1.0, 0.0, 0.0][(k * (3 + signal)) % 7];
    ((way / count).round() + jitter) * count
}

/// Holds a mechanism that follows an encoder's samples against `mechc run --samples`.
fn follows_samples(name: &str, inputs: &[(&str, usize)], fields: &[&str], has_time: bool) {
    const SAMPLES: usize = 400;
    let mut csv = format!("t,{}\n", inputs.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(","));
    for k in 0..SAMPLES {
        let values: Vec<String> = inputs.iter().map(|(_, signal)| format!("{:?}", encoder(k, *signal))).collect();
        writeln!(csv, "{:?},{}", 1e-3 * k as f64, values.join(",")).expect("a string takes everything");
    }
    let (choice, world) = (
        Choice { samples: Some("samples.csv".into()), ..Choice::default() },
        Memory::default().with("samples.csv", csv),
    );
    let text = text_of(name).replace("to 3 s", "to 0.399 s");
    let checked = Parsed::of("machine.mech", &*text).check(&choice, &world);
    let (compiled, said) = checked.compile(mechc::Redundant::Refused, &mechc::Cancel::default());
    let compiled = compiled.unwrap_or_else(|| panic!("{:?} {said:?}", checked.diagnostics()));
    let (rows, stop) = all_rows(&compiled, &compiled.times().expect("times"));
    assert!(stop.is_none() && rows.len() == SAMPLES, "{} rows", rows.len());
    let columns = compiled.columns();
    let at = |column: String| columns.iter().position(|name| *name == column).expect("a column");
    // what the splines through the samples say is what firmware would have to know
    let mut program = format!("const SAMPLES: [[f64; {}]; {SAMPLES}] = [\n", 1 + 3 * inputs.len());
    for row in &rows {
        let asked = |(k, _): (usize, _)| if inputs.len() == 1 { "asked".to_owned() } else { format!("asked_{k}") };
        let signal = |name: String| [name.clone(), format!("{name}.d"), format!("{name}.dd")].map(|name| row[at(name)]);
        let values: Vec<f64> = inputs.iter().enumerate().map(asked).flat_map(signal).collect();
        writeln!(program, "{:?},", [&row[..1], &values].concat()).expect("a string takes everything");
    }
    let mut given: String = fields
        .iter()
        .enumerate()
        .map(|(k, field)| {
            let [value, rate, acceleration] = [1, 2, 3].map(|order| format!("s[{}]", 3 * k + order));
            format!("{field}: Signal {{ value: {value}, rate: {rate}, acceleration: {acceleration} }}, ")
        })
        .collect();
    given += if has_time { "t: s[0]" } else { "" };
    write!(
        program,
        "];\nfn main() {{
    let mut state = assemble(&Params::default()).unwrap();
    for s in SAMPLES {{
        follow(&Inputs {{ {given} }}, &mut state).unwrap();
        let row: Vec<String> = state.row().iter().map(|x| format!(\"{{x:?}}\")).collect();
        println!(\"{{}}\", row.join(\" \"));
    }}
}}\n"
    )
    .expect("a string takes everything");
    // the module is that of the file: it knows nothing of samples
    let lines = printed(&emitted(&text_of(name)).text(None), &program);
    assert_eq!(lines.len(), SAMPLES);
    let mut held = 0;
    for (line, row) in lines.iter().zip(&rows) {
        let got = numbers(line);
        for (k, (got, wanted)) in got.iter().zip(row).enumerate().skip(1) {
            if got.is_nan() {
                assert!(columns[k].starts_with("push."), "{} at {}", columns[k], row[0]);
                continue;
            }
            assert!((got - wanted).abs() <= 1e-9 * (1.0 + wanted.abs()), "{}: {got} is not {wanted}", columns[k]);
            held += 1;
        }
    }
    assert!(held > 20 * SAMPLES, "{held} numbers");
}

#[test]
fn a_four_bar_follows_its_encoder() {
    follows_samples("four_bar", &[("turn", 0)], &["turn"], false);
}

#[test]
fn a_platform_follows_three_encoders() {
    let names = [("crank[0]", 1), ("crank[1]", 2), ("crank[2]", 3)];
    follows_samples("platform", &names, &["crank_0", "crank_1", "crank_2"], false);
}

#[test]
fn a_slider_crank_follows_its_encoder_and_the_time() {
    follows_samples("slider_crank", &[("turn", 0)], &["turn"], true);
}

/// A program that goes along the text's own formulas by `step` and by `follow`, forth and back.
const BOTH: &str = r#"
fn main() {
    let p = Params::default();
    let (mut a, mut b) = (assemble(&p).unwrap(), assemble(&p).unwrap());
    let forth_and_back = (1..=150).chain((0..150).rev());
    for k in forth_and_back {
        let t = START_TIME + 0.02 * f64::from(k);
        step(t, &mut a).unwrap();
        let inputs = Inputs::at(t, &p);
        follow(&inputs, &mut b).unwrap();
        assert_eq!(b.inputs(), inputs);
        let (x, y) = (a.row(), b.row());
        for i in 1..COLUMNS {
            println!("{i} {:?} {:?}", x[i], y[i]);
        }
        let (x, y) = (influence(&a).unwrap(), influence(&b).unwrap());
        assert_eq!(x, y);
        let shifted = |shift: f64| {
            let mut state = b.clone();
            let mut inputs = b.inputs();
            inputs.SIGNAL.value += shift;
            follow(&inputs, &mut state).unwrap();
            state
        };
        let (plus, minus, k) = (shifted(1e-4), shifted(-1e-4), input::INDEX);
        for i in 0..N {
            let slope = (plus.q()[i] - minus.q()[i]) / 2e-4;
            println!("0 {slope:?} {:?}", y[k][i]);
        }
    }
    // time takes up where it is
    let (mut c, t) = (b.clone(), b.t());
    step(t + 0.1, &mut c).unwrap();
    let mut d = assemble(&p).unwrap();
    step(t + 0.1, &mut d).unwrap();
    assert_eq!(c.row().map(f64::to_bits), d.row().map(f64::to_bits));
}
"#;

/// `follow` goes where `step` goes, and `influence` is what differences of `follow` say.
fn goes_where_step_goes(name: &str, signal: &str, index: &str, largest_straight: usize) {
    let text = emitted(&text_of(name)).text_of(None, largest_straight);
    let lines = printed(&text, &BOTH.replace("SIGNAL", signal).replace("INDEX", index));
    let mut count = [0; 2];
    for line in lines {
        let [what, a, b] = numbers(&line)[..] else { panic!("{line}") };
        let is_slope = what == 0.0;
        // what the third derivative of an input decides is left out
        let is_same =
            if is_slope { (a - b).abs() < 1e-6 * (1.0 + a.abs()) } else { (a - b).abs() < 1e-11 * (1.0 + a.abs()) };
        assert!(is_same || (b.is_nan() && !a.is_nan()), "{name}: {line}");
        count[usize::from(is_slope)] += 1;
    }
    assert!(count[0] > 5000 && count[1] > 2000, "{count:?}");
}

#[test]
fn to_follow_the_texts_inputs_is_to_step() {
    goes_where_step_goes("four_bar", "turn", "TURN", mechc::LARGEST_STRAIGHT);
    goes_where_step_goes("platform", "crank_1", "CRANK_1", mechc::LARGEST_STRAIGHT);
    goes_where_step_goes("slider_crank", "turn", "TURN", mechc::LARGEST_STRAIGHT);
}

#[test]
fn what_is_written_as_numbers_follows_as_well() {
    goes_where_step_goes("platform", "crank_1", "CRANK_1", 0);
    goes_where_step_goes("slider_crank", "turn", "TURN", 0);
}

/// A crank whose driver is a formula of an input, and a rocker that it moves.
fn driven(rod: &str, formula: &str) -> String {
    text_of("four_bar").replace("rotation(main) = turn", &format!("rotation(main) = {formula}")).replace("3.5 m", rod)
}

/// What becomes of a way to some inputs, and whether the state is then as it was.
const WAYS: &str = r#"
fn main() {
    let mut state = assemble(&Params::default()).unwrap();
    let to = |turn: f64| Inputs { turn: Signal { value: turn, rate: 0.5, acceleration: 0.1 } };
    follow(&to(FIRST), &mut state).unwrap();
    for turn in WAYS {
        let (row, inputs) = (state.row(), state.inputs());
        let mut twin = state.clone();
        let result = follow(&to(turn), &mut state);
        let is_as_before = state.row().map(f64::to_bits) == row.map(f64::to_bits) && state.inputs() == inputs;
        // and it goes on as if nothing had been
        let on = |state: &mut State| follow(&to(FIRST + 0.01), state).map(|()| state.row().map(f64::to_bits));
        let goes_on = if result.is_err() { on(&mut state) == on(&mut twin) } else { true };
        follow(&to(FIRST), &mut state).ok();
        println!("{result:?} {is_as_before} {goes_on}");
    }
}
"#;

fn ways(text: &str, first: &str, ways: &str) -> Vec<String> {
    let text = text.replace("input turn = 30 deg", &format!("input turn = {first}"));
    printed(&emitted(&text).text(None), &WAYS.replace("FIRST", first).replace("WAYS", ways))
}

#[test]
fn beyond_a_dead_point_it_locks_up_and_stays_where_it_was() {
    // a crank that cannot turn round: the rod and the rocker come into line
    let text = driven("1.5 m", "turn");
    let found = ways(&text, "0.6", "[2.5, -2.5, 0.7, 100.0, 0.6 + 1e-7]");
    let [lock, ok] = ["Err(LockUp) true true", "Ok(()) false true"];
    assert_eq!(found, [lock, lock, ok, lock, ok]);
}

#[test]
fn a_jump_is_told_and_a_kink_is_passed() {
    let [jump, ok] = ["Err(NotSmooth) true true", "Ok(()) false true"];
    let text = driven("3.5 m", "if turn < 1 then turn else turn + 0.3");
    assert_eq!(ways(&text, "0.6", "[0.9, 1.5, 0.999, 1.0, 3.0]"), [ok, jump, ok, jump, jump]);
    assert_eq!(ways(&text, "1.6", "[1.2, 0.9, 1.0, 0.0, 3.0]"), [ok, jump, ok, jump, ok]);
    let text = driven("3.5 m", "if turn < 1 then turn else 3 * turn - 2");
    assert_eq!(ways(&text, "0.6", "[0.9, 1.5, 1.0, 0.2, 2.0]"), [ok; 5]);
    // by the cut of an arc tangent, which no comparison tells of
    let text = driven("3.5 m", "0.2 * atan2(sin(turn), cos(turn))");
    assert_eq!(ways(&text, "3.0", "[3.1, 3.2, 2.0, 9.0]"), [ok, jump, ok, jump]);
    let text = driven("3.5 m", "sqrt(turn^2)");
    assert_eq!(ways(&text, "0.6", "[0.2, -0.5, 2.0]"), [ok; 3]);
}

#[test]
fn where_there_is_no_number_there_is_no_way() {
    let text = driven("3.5 m", "1.2 * sqrt(turn)");
    let [none, ok] = ["Err(NotANumber) true true", "Ok(()) false true"];
    assert_eq!(ways(&text, "0.6", "[0.2, -0.5, f64::NAN, f64::INFINITY, 1.0]"), [ok, none, none, none, ok]);
}

#[test]
fn so_many_steps_are_kept_and_the_same_call_goes_on() {
    let lines = printed(
        &emitted(&text_of("four_bar")).text(None),
        r#"
fn main() {
    let mut whole = assemble(&Params::default()).unwrap();
    let mut parts = whole.clone();
    let far = Inputs { turn: Signal { value: 20.0, rate: 1.0, acceleration: 2.0 } };
    follow(&far, &mut whole).unwrap();
    let mut before = parts.inputs().turn.value;
    for calls in 0.. {
        assert!(calls < 1000);
        match follow_within(&far, &mut parts, 4) {
            Ok(()) => break,
            Err(error) => assert_eq!(error, Error::TooFar),
        }
        let now = parts.inputs().turn.value;
        assert!(now >= before && now < 20.0);
        before = now;
        println!("{now}");
    }
    for (a, b) in whole.row().iter().zip(parts.row()).skip(1) {
        assert!(a.is_nan() || a.to_bits() == b.to_bits(), "{a} {b}");
    }
    // to stay is a way too: it takes the new rates
    let rest = Inputs { turn: Signal { rate: 0.0, acceleration: 0.0, ..far.turn } };
    follow(&rest, &mut whole).unwrap();
    assert!(whole.qd().iter().chain(whole.qdd()).all(|x| *x == 0.0) && whole.q() == parts.q());
}
"#,
    );
    assert!(lines.len() >= 5, "{lines:?}");
}

#[test]
fn lanes_follow_as_each_alone() {
    let lines = printed(
        &emitted(&text_of("slider_crank")).text(Some(3)),
        r#"
fn main() {
    let params: [Params; 3] =
        std::array::from_fn(|k| Params { crank_length: 0.05 - 0.002 * k as f64, ..Params::default() });
    let mut all = lanes::assemble(&params).unwrap().0;
    let mut each = params.map(|params| assemble(&params).unwrap());
    for row in 0..200 {
        let times: [f64; 3] = std::array::from_fn(|k| 0.01 * f64::from(row) * (1.0 + 0.1 * k as f64));
        // inputs, time, and what cannot be
        let lost = Inputs { t: f64::NAN, ..Inputs::default() };
        let done = match row % 5 {
            0 => lanes::step_each(&times, &mut all),
            1 => lanes::follow_each(&[lost; 3], &mut all),
            _ => lanes::follow_each(&std::array::from_fn(|k| Inputs::at(times[k], &params[k])), &mut all),
        };
        for (k, state) in each.iter_mut().enumerate() {
            let alone = match row % 5 {
                0 => step(times[k], state),
                1 => follow(&lost, state),
                _ => follow(&Inputs::at(times[k], &params[k]), state),
            };
            assert_eq!(alone, done[k], "{row}");
            let lane = all.get(k).unwrap();
            assert_eq!(lane.row().map(f64::to_bits), state.row().map(f64::to_bits), "lane {k} at {}", times[k]);
            assert_eq!(lane.inputs(), state.inputs());
        }
        println!("{}", all.t()[0]);
    }
}
"#,
    );
    assert_eq!(lines.len(), 200);
}

#[test]
fn without_inputs_there_is_nothing_to_follow() {
    let text = text_of("four_bar");
    let formula = "30 deg + 1.5 rad * sin(2 rad/s * t)";
    let plain = text.replace(&format!("    input turn = {formula}\n"), "").replace("= turn", &format!("= {formula}"));
    let (with, without) = (emitted(&text).text(Some(2)), emitted(&plain).text(Some(2)));
    for word in ["follow(", "Inputs", "influence(", "is_led", "Signal"] {
        assert!(with.contains(word) && !without.contains(word), "{word}");
    }
}
