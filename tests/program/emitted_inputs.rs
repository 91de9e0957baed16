//! Emitted code that follows inputs: what it makes of an encoder's samples is what `mechc run` makes of them, and what it refuses leaves
//! the state as it was.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support;

use crate::compiling::{Emitted, printed};
use crate::support::all_rows;
use mechc::{Choice, Memory, Parsed, RustOptions};
use std::fmt::Write;
use std::fs;
use std::path::Path;

fn text_of(name: &str) -> String {
    fs::read_to_string(format!("tests/following/{name}.mech")).expect("a text")
}

fn emitted(text: &str) -> Emitted {
    Emitted::of("machine".to_owned(), text, Path::new("machine.mech"), 0).expect("determined")
}

/// Numbers of a line.
fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace().map(|word| word.parse().unwrap_or_else(|_| panic!("{word} in {line}"))).collect()
}

/// What an encoder of 4096 counts a turn makes of a signal that goes forth and back, with a jitter of a count.
fn encoder(k: usize, signal: usize) -> f64 {
    let count = std::f64::consts::TAU / 4096.0;
    let t = 1e-3 * k as f64;
    let sin = |x: f64| mechc_expr::math::sin_cos(x).0;
    let way = [0.52, 1.571, 3.665, 5.76][signal] + 0.12 * sin(1.3 * t + 2.0 * signal as f64) * sin(7.0 * t);
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
    let checked = Parsed::new("machine.mech", &text).check(&choice, &world);
    let (compiled, messages) = checked.compile(mechc::Redundant::Refused, &mechc::Cancel::default());
    let compiled = compiled.unwrap_or_else(|| panic!("{:?} {messages:?}", checked.diagnostics()));
    let (rows, stop) = all_rows(&compiled, &compiled.times().expect("times"));
    assert!(stop.is_none() && rows.len() == SAMPLES, "{} rows", rows.len());
    let columns = compiled.columns();
    let at = |column: String| columns.iter().position(|name| *name == column).expect("a column");
    // what the splines through the samples say is what firmware would have to know
    let mut program = format!("const SAMPLES: [[f64; {}]; {SAMPLES}] = [\n", 1 + 3 * inputs.len());
    for row in &rows {
        let requested = |(k, _): (usize, _)| if inputs.len() == 1 { "asked".to_owned() } else { format!("asked_{k}") };
        let signal = |name: String| [name.clone(), format!("{name}.d"), format!("{name}.dd")].map(|name| row[at(name)]);
        let values: Vec<f64> = inputs.iter().enumerate().map(requested).flat_map(signal).collect();
        writeln!(program, "{:?},", [&row[..1], &values].concat()).expect("a string takes everything");
    }
    let mut given = String::new();
    for (k, field) in fields.iter().enumerate() {
        let [value, rate, acceleration] = [1, 2, 3].map(|order| format!("s[{}]", 3 * k + order));
        write!(given, "{field}: Signal {{ value: {value}, rate: {rate}, acceleration: {acceleration} }}, ")
            .expect("a string takes everything");
    }
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
fn goes_where_step_goes(name: &str, signal: &str, index: &str) {
    let text = emitted(&text_of(name)).text(None);
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
    goes_where_step_goes("four_bar", "turn", "TURN");
    goes_where_step_goes("platform", "crank_1", "CRANK_1");
    goes_where_step_goes("slider_crank", "turn", "TURN");
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
        // to the last bit, what nobody sees of it too
        let is_as_before = format!("{state:?}") == format!("{twin:?}");
        assert!(result.is_ok() || (state.row().map(f64::to_bits) == row.map(f64::to_bits) && state.inputs() == inputs));
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
fn lock_ups_keep_the_state() {
    // a crank that cannot turn round: the rod and the rocker come into line
    let text = driven("1.5 m", "turn");
    let found = ways(&text, "0.6", "[2.5, -2.5, 0.7, 100.0, 0.6 + 1e-7, 1e12, -1e300]");
    let [lock, ok, far] = ["Err(LockUp) true true", "Ok(()) false true", "Err(TooFar) true true"];
    assert_eq!(found, [lock, lock, ok, far, ok, far, far]);
}

#[test]
fn jumps_are_reported_and_kinks_passed() {
    let [jump, ok, far] = ["Err(NotSmooth) true true", "Ok(()) false true", "Err(TooFar) true true"];
    let text = driven("3.5 m", "if turn < 1 then turn else turn + 0.3");
    assert_eq!(ways(&text, "0.6", "[0.9, 1.5, 0.999, 1.0, 3.0, 1e12]"), [ok, jump, ok, jump, jump, far]);
    assert_eq!(ways(&text, "1.6", "[1.2, 0.9, 1.0, 0.0, 3.0]"), [ok, jump, ok, jump, ok]);
    let text = driven("3.5 m", "if turn < 1 then turn else 3 * turn - 2");
    assert_eq!(ways(&text, "0.6", "[0.9, 1.5, 1.0, 0.2, 2.0]"), [ok; 5]);
    // by the cut of an arc tangent, which no comparison tells of
    let text = driven("3.5 m", "0.2 * atan2(sin(turn), cos(turn))");
    assert_eq!(ways(&text, "3.0", "[3.1, 3.2, 2.0, 6.0, 1e12]"), [ok, jump, ok, jump, far]);
    let text = driven("3.5 m", "sqrt(turn^2)");
    assert_eq!(ways(&text, "0.6", "[0.2, -0.5, 2.0]"), [ok; 3]);
}

#[test]
fn paths_without_values_are_refused() {
    let text = driven("3.5 m", "1.2 * sqrt(turn)");
    let [none, ok] = ["Err(NotANumber) true true", "Ok(()) false true"];
    assert_eq!(ways(&text, "0.6", "[0.2, -0.5, f64::NAN, f64::INFINITY, 1.0]"), [ok, none, none, none, ok]);
}

#[test]
fn step_limits_allow_resumption() {
    let lines = printed(
        &emitted(&text_of("four_bar")).text(None),
        r#"
fn main() {
    let mut whole = assemble(&Params::default()).unwrap();
    let mut parts = whole.clone();
    let far = Inputs { turn: Signal { value: 20.0, rate: 1.0, acceleration: 2.0 } };
    let before = format!("{whole:?}");
    assert_eq!(follow(&far, &mut whole), Err(Error::TooFar), "more than half a turn");
    assert_eq!(follow_within(&far, &mut whole, 1000), Err(Error::TooFar));
    assert_eq!(format!("{whole:?}"), before);
    assert!((whole.largest_change()[input::TURN] - core::f64::consts::PI).abs() < 1e-15);
    for state in [&mut whole, &mut parts] {
        state.set_largest_change([f64::INFINITY]);
    }
    assert_eq!(follow_within(&far, &mut whole, 1000), Ok(Progress::REACHED));
    let mut before = parts.inputs().turn.value;
    for calls in 0.. {
        assert!(calls < 1000);
        let progress = follow_within(&far, &mut parts, 4).unwrap();
        if progress.is_reached() {
            break;
        }
        let (now, inputs) = (parts.inputs().turn.value, parts.inputs());
        assert!(now >= before && now < 20.0);
        let part = (now - before) / (20.0 - before);
        assert!((progress.fraction - part).abs() < 1e-12, "{progress:?} is not {part}");
        // what is said of the place is what follows from it
        let mut there = parts.clone();
        follow(&inputs, &mut there).unwrap();
        for (a, b) in there.row().iter().zip(parts.row()).skip(1) {
            assert!(a.is_nan() || a.to_bits() == b.to_bits(), "{a} {b}");
        }
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
fn long_paths_are_too_far() {
    let lines = printed(
        &emitted(&text_of("four_bar")).text(None),
        r#"
fn main() {
    let state = assemble(&Params::default()).unwrap();
    let home = state.inputs();
    for value in [1e5, 1e9, 1e12, -1e12, 1e17, 1e40, -1e200, 1.7e308] {
        let (mut state, mut before) = (state.clone(), home.turn.value);
        state.set_largest_change([f64::INFINITY]);
        let far = Inputs { turn: Signal { value, ..home.turn } };
        for _ in 0..2 {
            // a step that has to be made shorter counts too, and at first every one has
            let progress = follow_within(&far, &mut state, 1500).unwrap();
            assert!(progress.fraction > 0.0 && !progress.is_reached(), "{value}: {progress:?}");
            let now = state.inputs().turn.value;
            assert!((now - before).abs() > 50.0 && (now > before) == (value > 0.0), "{value}: {before} to {now}");
            before = now;
        }
        assert_eq!(follow_within(&home, &mut state, 10_000), Ok(Progress::REACHED));
        // turns are whole ones
        for (a, b) in state.q().iter().zip(assemble(&Params::default()).unwrap().q()) {
            assert!((a - b).abs() < 1e-9, "{value}: {a} is not {b}");
        }
        println!("{value}");
    }
}
"#,
    );
    assert_eq!(lines.len(), 8);
}

/// What becomes of a four-bar with other parameters: most of all that can be assembled is, by a bounded amount of work, and says how.
const FAR: &str = r#"
mod random;
use random::Random;

fn main() {
    let mut random = Random::new(7);
    let (mut led, mut drawn, mut refused) = (0, 0, 0);
    for k in 0..300 {
        let mut length = || random.between(0.1, 0.6);
        let mut p = Params { r1: length(), r2: length(), r3: length(), r4: length(), start: random.between(-3.0, 3.0) };
        if k % 2 == 1 {
            let near = |random: &mut Random, value: f64| value * random.between(0.9, 1.1);
            let Params { r1, r2, r3, r4, start } = Params::default();
            p = Params { r1: near(&mut random, r1), r2: near(&mut random, r2), r3: near(&mut random, r3), r4, start };
        }
        if k == 0 {
            p = Params { r1: 0.1, r2: 0.3, r3: 0.4, r4: 0.5, start: -45_f64.to_radians() };
        }
        let mut work = Work::default();
        let state = counted::assemble(&p, &mut work);
        assert!(work.evaluations <= MOST_WORK_TO_ASSEMBLE, "{p:?}: {work:?}");
        // the distance that rod and rocker have to span
        let gap = (p.r1 * p.r1 + p.r2 * p.r2 - 2.0 * p.r1 * p.r2 * p.start.cos()).sqrt();
        let can_close = gap < 0.98 * (p.r3 + p.r4) && gap > 1.02 * (p.r3 - p.r4).abs() + 0.01;
        let Ok(state) = state else {
            refused += u32::from(can_close);
            continue;
        };
        assert!(phi(state.q(), START_TIME, &p).iter().all(|left| left.abs() < 1e-9), "{p:?}");
        match state.assembly() {
            Assembly::Led => led += 1,
            Assembly::Drawn => {
                assert!(work.evaluations < 80, "{p:?}: {work:?}");
                drawn += 1;
            }
        }
        if k == 0 {
            assert_eq!(state.assembly(), Assembly::Drawn);
            assert!(work.evaluations <= 40, "{work:?}");
            println!("{:?}", state.q());
        }
    }
    println!("{led} {drawn} {refused}");
}
"#;

#[test]
fn distant_parameters_are_assembled_as_drawn() {
    let text = fs::read_to_string("tests/emitted/four.mech").expect("a text");
    let lines = printed(&emitted(&text).text(None), &with_random(FAR));
    let [continued, drawn, refused] = numbers(&lines[1])[..] else { panic!("{lines:?}") };
    assert!(continued > 30.0 && drawn > 30.0, "{continued} and {drawn}");
    assert!(20.0 * refused < continued + drawn, "{refused} beside {continued} and {drawn}");
    // what is set in the text is assembled from there
    let set = [("0.5 m", "0.1 m"), ("0.25 m", "0.3 m"), ("r3 = 0.45 m", "r3 = 0.4 m"), ("r4 = 0.45 m", "r4 = 0.5 m")];
    let text = set.into_iter().fold(text, |text, (from, to)| text.replacen(from, to, 1)).replace("70 deg", "-45 deg");
    let compiled = emitted(&text).compiled;
    let (rows, _) = all_rows(&compiled, &compiled.times().expect("times"));
    let q = numbers(&lines[0].replace(['[', ']', ','], " "));
    for (k, (a, b)) in q.iter().zip(&rows[0][1..]).enumerate() {
        let turns = if k % 3 == 2 { ((a - b) / std::f64::consts::TAU).round() } else { 0.0 };
        assert!((a - b - turns * std::f64::consts::TAU).abs() < 1e-12, "{a} is not {b}");
    }
}

/// A program with random numbers of its own.
fn with_random(program: &str) -> String {
    let random = include_str!("../support/random.rs").replace("//!", "//");
    program.replace("mod random;", &format!("mod random {{\n{random}\n}}"))
}

/// A five-bar between two motors, of lengths in m, with the angles at which it is drawn.
fn five_bar([base, left, right, fore]: [f64; 4]) -> String {
    format!(
        "mechanism machine {{
    param base = {base} m  param left = {left} m  param right = {right} m  param fore = {fore} m
    input turn = 120 deg + 20 deg * sin(1 rev/s * t)
    input other = 60 deg + 20 deg * sin(1 rev/s * t)
    ground {{ point A = (-base / 2, 0)  point B = (base / 2, 0) }}
    body crank_l at (ground.A, 120 deg) {{ point A = (0, 0)  point C = (left, 0) }}
    body crank_r at (ground.B, 60 deg) {{ point B = (0, 0)  point D = (right, 0) }}
    body fore_l at (crank_l.C, 45 deg) {{ point C = (0, 0)  point tool = (fore, 0) }}
    body fore_r at (crank_r.D, 135 deg) {{ point D = (0, 0)  point tool = (fore, 0) }}
    joint motor_l: revolute(ground.A, crank_l.A)  joint motor_r: revolute(ground.B, crank_r.B)
    joint elbow_l: revolute(crank_l.C, fore_l.C)  joint elbow_r: revolute(crank_r.D, fore_r.D)
    joint tool: revolute(fore_l.tool, fore_r.tool)
    driver servo_l: rotation(motor_l) = turn
    driver servo_r: rotation(motor_r) = other
    measure x = x(fore_l.tool)
    analysis from 0 s to 1 s every 10 ms
}}
"
    )
}

/// Calls of all kinds, with whatever an encoder may say: none does more work than it says it does at most, none changes anything where it
/// is refused, and what it leaves on its way is the place that its inputs say.
const WORK: &str = r#"
mod random;
use random::Random;

fn main() {
    let mut random = Random::new(SEED);
    let p = Params::default();
    let mut work = Work::default();
    let home = counted::assemble(&p, &mut work).unwrap();
    assert!(work.evaluations > 0 && work.evaluations <= MOST_WORK_TO_ASSEMBLE && MOST_WORK_TO_ASSEMBLE <= MOST_WORK);
    assert_eq!(most_work(MOST_STEPS), MOST_WORK);
    assert!(MOST_WORK_TO_FOLLOW <= most_work(MOST_STEPS_TO_FOLLOW));
    let mut state = home.clone();
    let (mut refused, mut on_the_way, mut most_of_follow) = (0, 0, 0);
    for _ in 0..CALLS {
        let now = state.inputs();
        let near = |random: &mut Random, value: f64| match random.below(20) {
            0 => random.of(&[1e6, -1e15, f64::NAN, f64::INFINITY, 1e300, 1e-300]),
            1 => value,
            2..=5 => value + random.between(-3.0, 3.0),
            6..=9 => value + random.between(-0.5, 0.5),
            _ => value + random.between(-0.01, 0.01),
        };
        let mut wanted = now;
        let signal = |random: &mut Random, of: Signal| Signal {
            value: near(random, of.value),
            rate: random.between(-3.0, 3.0),
            acceleration: random.between(-30.0, 30.0),
        };
        SIGNALS
        let (before, mut work) = (state.clone(), Work::default());
        let t = near(&mut random, state.t());
        let most = random.below(6);
        let (result, bound) = match random.below(6) {
            0 | 1 => (counted::follow(&wanted, &mut state, &mut work).map(|()| Progress::REACHED), MOST_WORK_TO_FOLLOW),
            2 | 3 => (counted::follow_within(&wanted, &mut state, most, &mut work), most_work(most)),
            4 => (counted::step_within(t, &mut state, most, &mut work), most_work(most)),
            _ => (counted::step(t, &mut state, &mut work).map(|()| Progress::REACHED), MOST_WORK),
        };
        assert!(work.evaluations <= bound, "{} instead of {bound} at most", work.evaluations);
        if bound == MOST_WORK_TO_FOLLOW {
            most_of_follow = most_of_follow.max(work.evaluations);
        }
        match result {
            Err(_) => {
                assert_eq!(format!("{state:?}"), format!("{before:?}"), "{result:?}");
                refused += 1;
            }
            Ok(progress) if !progress.is_reached() => {
                assert!((0.0..1.0).contains(&progress.fraction));
                on_the_way += 1;
            }
            Ok(_) => {}
        }
        if result.is_ok() && state.inputs() != Inputs::at(state.t(), &p) {
            // what is said of the place is what follows from it
            let (mut there, inputs) = (state.clone(), state.inputs());
            if follow(&inputs, &mut there).is_ok() {
                // where a formula has a kink, at 0, accelerations are those of the side that the way came from
                let is_at_kink = FIELDS.iter().any(|value| value.abs() < 1e-9);
                let columns = if is_at_kink { COLUMNS - (COLUMNS - 1) / 3 } else { COLUMNS };
                for (a, b) in there.row().iter().zip(state.row()).take(columns).skip(1) {
                    assert!(a.is_nan() || b.is_nan() || (a - b).abs() <= 1e-9 * (1.0 + a.abs()), "{a} {b}");
                }
            }
        }
        if random.below(40) == 0 {
            state = home.clone();
        }
    }
    println!("{refused} {on_the_way} {most_of_follow} {MOST_WORK_TO_FOLLOW}");
}
"#;

#[test]
fn calls_keep_their_work_bounds() {
    let fields = |names: &[&str]| {
        let field = |name: &&str| format!("wanted.{name} = signal(&mut random, now.{name});");
        names.iter().map(field).collect::<Vec<String>>().join("\n")
    };
    let mut draw = support::random::Random::new(50);
    let mut bars =
        || [draw.between(0.05, 0.3), draw.between(0.15, 0.25), draw.between(0.15, 0.25), draw.between(0.24, 0.4)];
    let texts = [
        (five_bar([0.16, 0.2, 0.2, 0.26]), &["turn", "other"][..]),
        (five_bar(bars()), &["turn", "other"]),
        (text_of("platform"), &["crank_0", "crank_1", "crank_2"]),
        (text_of("slider_crank"), &["turn"]),
        (driven("1.5 m", "if turn < 1 then turn else turn + 0.3"), &["turn"]),
    ];
    for (number, (text, names)) in texts.into_iter().enumerate() {
        let values: Vec<String> = names.iter().map(|name| format!("inputs.{name}.value")).collect();
        let program = WORK.replace("SIGNALS", &fields(names)).replace("FIELDS", &format!("[{}]", values.join(", ")));
        let program = program.replace("SEED", &number.to_string());
        let program = with_random(&program.replace("CALLS", "1500"));
        let lines = printed(&emitted(&text).text(None), &program);
        let [refused, on_the_way, most, bound] = numbers(&lines[0])[..] else { panic!("{lines:?}") };
        assert!(refused > 50.0 && on_the_way > 50.0, "{text}: {refused} and {on_the_way}");
        assert!(most > 20.0 && most <= bound, "{most} of {bound}");
    }
}

#[test]
fn dead_points_are_reported_at_any_step_limit() {
    // a piston that leads its crank: dead points at 100 and 200 mm
    let text = "mechanism machine {
    ground { point O = (0, 0)  axis way = (0, 0) along (1, 0) }
    body crank at (0, 0, 30 deg) { point O = (0, 0)  point P = (50 mm, 0) }
    body rod at (45 mm, 25 mm, -10 deg) { point P = (0, 0)  point W = (150 mm, 0) }
    body piston at (190 mm, 0, 0) { point W = (0, 0)  axis s = (0, 0) along (1, 0) }
    joint a: revolute(ground.O, crank.O)  joint b: revolute(crank.P, rod.P)
    joint c: revolute(rod.W, piston.W)    joint g: translational(ground.way, piston.s)
    input place = 150 mm + 20 mm/s * t
    driver d: displacement(g) = place
    analysis from 0 s to 1 s every 0.5 s
}";
    let lines = printed(
        &emitted(text).text(None),
        r#"
fn main() {
    let home = assemble(&Params::default()).unwrap();
    let to = |value: f64| Inputs { place: Signal { value, rate: 0.0, acceleration: 0.0 } };
    for most in [1, 2, 3, 4, 5, 7, 10, 20, 64] {
        for (wanted, is_there) in [(0.19, true), (0.1999, true), (0.199999, true), (0.2001, false), (0.201, false), (0.25, false)] {
            let mut state = home.clone();
            let end = loop {
                match follow_within(&to(wanted), &mut state, most) {
                    Ok(progress) if progress.is_reached() => break Ok(()),
                    Ok(_) => {}
                    Err(error) => break Err(error),
                }
            };
            assert_eq!(end, if is_there { Ok(()) } else { Err(Error::LockUp) }, "{wanted} by {most}");
            // the law of cosines
            let place = state.inputs().place.value;
            let angle = ((0.05 * 0.05 + place * place - 0.15 * 0.15) / (2.0 * 0.05 * place)).acos();
            let found = state.pose(Body::Crank).phi;
            assert!((found - angle).abs() < 1e-7, "{wanted} by {most}: {found} for {angle}");
        }
    }
    println!("1");
}
"#,
    );
    assert_eq!(lines, ["1"]);
}

#[test]
fn modules_report_needed_left_out_equations() {
    // wheels whose rods on both sides are a quarter turn apart: at a dead centre of one side the other decides
    let text = "mechanism machine {
    ground { point A = (0, 0)  point B = (2 m, 0) }
    body front at (0, 0, 20 deg) { point O = (0, 0)  point left = (0.3 m, 0)  point right = (0, 0.3 m) }
    body rear at (2 m, 0, 20 deg) { point O = (0, 0)  point left = (0.3 m, 0)  point right = (0, 0.3 m) }
    body rod_l at (282 mm, 103 mm, 0) { point f = (0, 0)  point r = (2 m, 0) }
    body rod_r at (-103 mm, 282 mm, 0) { point f = (0, 0)  point r = (2 m, 0) }
    joint axle_f: revolute(ground.A, front.O)  joint axle_r: revolute(ground.B, rear.O)
    joint lf: revolute(front.left, rod_l.f)    joint lr: revolute(rod_l.r, rear.left)
    joint rf: revolute(front.right, rod_r.f)   joint rr: revolute(rod_r.r, rear.right)
    driver engine: rotation(axle_f) = 20 deg + 60 rpm * t
    analysis from 0 s to 3 s every 0.1 s
}";
    let module = Emitted::without_redundant("machine".to_owned(), text).text(None);
    let lines = printed(
        &module,
        r#"
fn main() {
    let mut state = assemble(&Params::default()).unwrap();
    loop {
        let (t, before) = (state.t(), format!("{state:?}"));
        if let Err(error) = step(t + 0.01, &mut state) {
            assert_eq!(format!("{state:?}"), before);
            println!("{error:?} {t}");
            break;
        }
        let [front, rear] = [Body::Front, Body::Rear].map(|body| state.pose(body).phi);
        assert!((front - rear).abs() < 1e-9, "{front} {rear}");
    }
}
"#,
    );
    // a whole or half turn of a side's cranks is never passed
    let (error, t) = lines[0].split_once(' ').expect("an error and a time");
    let turned = 20.0 + 360.0 * t.parse::<f64>().expect("a time");
    assert_eq!(error, "Inconsistent");
    assert!(turned > 60.0 && turned < 180.0, "{turned} deg");
}

#[test]
fn input_names_yield_to_time() {
    let text = "mechanism machine {
    input T   = 3 * t / 1 s
    input t_  = 5 * t / 1 s
    input _t  = 7 * t / 1 s
    input t_2 = 11 * t / 1 s
    ground { point O = (0, 0) }
    body shaft { point O = (0, 0) }
    joint main: revolute(ground.O, shaft.O)
    driver motor: rotation(main) = T + 10 * t_ + 100 * _t + 1000 * t_2MORE
}
";
    let program = r#"
fn main() {
    let signal = |value: f64| Signal { value, rate: 0.0, acceleration: 0.0 };
    let inputs = Inputs { t_2: signal(0.4), t_3: signal(0.1), t_4: signal(0.2), t_5: signal(0.3)TIME };
    let mut state = assemble(&Params::default()).unwrap();
    let by = influence(&state).unwrap();
    for k in [input::T_3, input::T_4, input::T_5, input::T_2] {
        println!("{:?}", by[k][2]);
    }
    follow(&inputs, &mut state).unwrap();
    println!("{:?}", state.q()[2]);
    println!("{:?}", state.qd()[2]);
}
"#;
    let close = |name: &str, [more, time]: [&str; 2], wanted: [f64; 6]| {
        let (text, program) = (text.replace("MORE", more), program.replace("TIME", time));
        let lines = printed(&emitted(&text).text(None), &program);
        let found: Vec<f64> = lines.iter().flat_map(|line| numbers(line)).collect();
        let mut pairs = found.iter().zip(&wanted);
        assert!(found.len() == 6 && pairs.all(|(a, b)| (a - b).abs() < 1e-9), "{name}: {found:?}");
    };
    close("with time", [" + 1e4 * t / 1 s", ", t: 0.5"], [1.0, 10.0, 100.0, 1000.0, 5432.1, 1e4]);
    // time, where a formula comes to hold it, changes no name of an input
    close("without", ["", ""], [1.0, 10.0, 100.0, 1000.0, 432.1, 0.0]);
}

/// Names that emitted code has itself, and some that Rust has.
const TAKEN: [&str; 82] = [
    "value",
    "rate",
    "acceleration",
    "q",
    "qd",
    "qdd",
    "qddd",
    "state",
    "inputs",
    "params",
    "signal",
    "follow",
    "step",
    "assemble",
    "influence",
    "sensitivity",
    "lanes",
    "measures",
    "row",
    "coordinate",
    "pose",
    "at",
    "lists",
    "way",
    "p",
    "n",
    "led",
    "core",
    "libm",
    "f64",
    "usize",
    "self",
    "super",
    "crate",
    "type",
    "known",
    "sides",
    "u",
    "u0",
    "p0",
    "v1",
    "x1",
    "w",
    "k",
    "v",
    "out",
    "guess",
    "newton",
    "sin_cos",
    "select",
    "either",
    "piece",
    "pick",
    "by_signal",
    "time",
    "lift_knots",
    "lift_c0",
    "lift_c1",
    "lift_c2",
    "lift_c3",
    "phi_q",
    "nu",
    "gamma",
    "varied",
    "solve",
    "signal_2",
    "entries",
    "each",
    "i",
    "std",
    "option",
    "ok",
    "shaft_x",
    "shaft_phi_d",
    "arrays",
    "on_grid",
    "lesser",
    "run",
    "is_led",
    "default",
    "towards",
    "all_measures",
];

#[test]
fn names_of_emitted_code_can_be_declared() {
    let (mut all, mut sums) = (String::new(), [String::from("0"), String::from("0")]);
    for (k, name) in TAKEN.iter().enumerate() {
        let input = name[..1].to_uppercase() + &name[1..];
        let body = name.to_uppercase() + "_";
        writeln!(
            all,
            "param {name} = {}
            input {input} = 0.01 * sin({k} * t / 100 s)
            body {body} {{ point O = (0, 0) }}
            joint J_{k}: revolute(ground.O, {body}.O)
            driver D_{k}: rotation(J_{k}) = {input} * {name}
            measure _{name} = {name} * {input} * angle({body})",
            1.0 + 0.01 * k as f64
        )
        .expect("a string takes everything");
        write!(sums[k % 2], " + {name} * {input}").expect("a string takes everything");
    }
    let text = format!(
        "mechanism machine {{
    {all}
    input T = 0.1 * t / 1 s
    table lift = spline [(-4, -lift_knots), (0, 0), (4, lift_c0), (8, 2 * lift_c1), (12, lift_c2 + lift_c3)]
    ground {{ point O = (0, 0) }}
    body shaft {{ point O = (0, 0) }}
    joint main: revolute(ground.O, shaft.O)
    driver motor: rotation(main) = {} + lift(T * lift_knots) + lift_c0 * lift_c1 * lift_c2 * lift_c3 + t / 1 s
    measure everything = angle(shaft) * ({}) + lift(T * lift_c0)
    part value_p: inner(t_ = angle(shaft))
    part q_p[copy in 0..2]: inner()
    analysis from 0 s to 1 s every 0.5 s
}}
mechanism inner {{
    param value  = 1 m
    param params = 1
    param q      = 1
    input t_ = t / 1 s
    input T_ = t / 1 s
    ground {{ point O = (0, 0) }}
    body self {{ point O = (0, 0)  point tip = (value, 0) }}
    joint pin: revolute(ground.O, self.O)
    driver d: rotation(pin) = t_ * params * q + T_
    measure state = y(self.tip)
}}
",
        sums[0], sums[1]
    );
    let emitted = emitted(&text);
    let program = "
fn main() {
    let p = Params::default();
    let (mut a, mut b) = (assemble(&p).unwrap(), assemble(&p).unwrap());
    step(0.5, &mut a).unwrap();
    follow(&Inputs::at(0.5, &p), &mut b).unwrap();
    for (a, b) in a.row().iter().zip(b.row()).skip(1) {
        println!(\"{a:?} {b:?}\");
    }
}
";
    let (rows, _) = emitted.rows();
    let lines = printed(&emitted.text(Some(2)), program);
    assert_eq!(lines.len(), rows[1].len() - 1);
    for (line, wanted) in lines.iter().zip(&rows[1][1..]) {
        let [stepped, followed] = numbers(line)[..] else { panic!("{line}") };
        assert_eq!(stepped.to_bits(), wanted.to_bits(), "{line}");
        assert!((stepped - followed).abs() < 1e-9 * (1.0 + stepped.abs()), "{line}");
    }
}

#[test]
fn lanes_follow_as_single_states() {
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

/// The largest difference of `sensitivity` and differences of assembled variants, led by time and then by inputs.
fn sensitivities(text: &str, fields: [&str; 2], is_led: bool) -> Vec<[f64; 2]> {
    let options = RustOptions { with_sensitivities: true, ..RustOptions::new("machine.mech") };
    let (module, messages) = emitted(text).compiled.rust(&options);
    let module = module.unwrap_or_else(|| panic!("{messages:?}"));
    let program = r#"
fn main() {
    let p = Params::default();
    for is_led in LED {
        let at = |p: Params| {
            let mut state = assemble(&p).unwrap();
            if is_led { LEAD } else { step(0.3, &mut state).unwrap() }
            state
        };
        let state = at(p);
        let by = sensitivity(&p, &state).unwrap();
        let h = 1e-5;
        let variants = [Params { FIRST: p.FIRST + h, ..p }, Params { FIRST: p.FIRST - h, ..p },
            Params { SECOND: p.SECOND + h, ..p }, Params { SECOND: p.SECOND - h, ..p }].map(at);
        for i in 0..N {
            for (k, [plus, minus]) in [(param::FIRST_INDEX, [0, 1]), (param::SECOND_INDEX, [2, 3])] {
                let slope = (variants[plus].q()[i] - variants[minus].q()[i]) / (2.0 * h);
                println!("{slope:?} {:?}", by[k][i]);
            }
        }
        // others than the state's own are those of a position beside it
        let beside = sensitivity(variants[0].params(), &state).unwrap();
        assert_ne!(beside, by);
        println!("{:?} {:?}", beside[0][3], sensitivity(variants[0].params(), &variants[0]).unwrap()[0][3]);
        assert_eq!(sensitivity(&Params { FIRST: f64::NAN, ..p }, &state), Err(Error::NotANumber));
    }
}
"#;
    let lead = if is_led { "follow(&Inputs::at(0.3, &Params::default()), &mut state).unwrap()" } else { "()" };
    let program = program
        .replace("LED", if is_led { "[false, true]" } else { "[false]" })
        .replace("LEAD", lead)
        .replace("FIRST_INDEX", &fields[0].to_uppercase())
        .replace("SECOND_INDEX", &fields[1].to_uppercase())
        .replace("FIRST", fields[0])
        .replace("SECOND", fields[1]);
    let lines = printed(&module, &program);
    let pair = |line: &String| <[f64; 2]>::try_from(numbers(line)).expect("two numbers");
    lines.iter().map(pair).collect()
}

#[test]
fn sensitivities_match_differences() {
    let by_speed = text_of("four_bar")
        .replace("param crank_length", "param sway = 1.5\n    param crank_length")
        .replace("1.5 rad", "sway * 1 rad");
    let formula = "30 deg + sway * 1 rad * sin(2 rad/s * t)";
    let by_time =
        by_speed.replace(&format!("    input turn = {formula}\n"), "").replace("= turn", &format!("= {formula}"));
    let found = [
        // the input's formula counts as long as nobody leads
        sensitivities(&by_speed, ["crank_length", "sway"], true),
        sensitivities(&text_of("slider_crank"), ["crank_length", "rod_length"], true),
        sensitivities(&by_time, ["crank_length", "sway"], false),
    ];
    for (found, count) in found.iter().zip([2 * 19, 2 * 25, 19]) {
        assert_eq!(found.len(), count);
        assert!(found.iter().any(|[slope, _]| slope.abs() > 0.1));
        for [slope, got] in found {
            assert!((slope - got).abs() < 1e-6 * (1.0 + slope.abs()), "{slope} {got}");
        }
    }
    // the same equations: the same numbers, however they are led
    assert_eq!(
        found[0][..19].iter().map(|[_, got]| *got).collect::<Vec<_>>(),
        found[2].iter().map(|[_, got]| *got).collect::<Vec<_>>()
    );
}

#[test]
fn no_parameters_no_sensitivities() {
    let text = text_of("slider_crank");
    let without = text.replace("    param crank_length = 50 mm\n    param rod_length   = 150 mm\n", "");
    let without = without.replace("crank_length", "50 mm").replace("rod_length", "150 mm");
    let options = RustOptions { with_sensitivities: true, ..RustOptions::new("machine.mech") };
    let (module, messages) = emitted(&without).compiled.rust(&options);
    let module = module.unwrap_or_else(|| panic!("{messages:?}"));
    let program = r#"
fn main() {
    let mut state = assemble(&Params).unwrap();
    println!("{PARAMS} {}", sensitivity(&Params, &state).unwrap().len());
    follow(&Inputs::at(0.3, &Params), &mut state).unwrap();
    println!("{PARAMS} {}", sensitivity(&Params, &state).unwrap().len());
}
"#;
    assert_eq!(printed(&module, program), ["0 0"; 2]);
}

/// Names of a kind in an emitted module, with what they are of: fields, constants, variants.
fn emitted_names(text: &str) -> Vec<[String; 2]> {
    let options = RustOptions { with_sensitivities: true, ..RustOptions::new("machine.mech") };
    let module = emitted(text).compiled.rust(&options).0.expect("a module");
    let lines: Vec<&str> = module.lines().map(str::trim).collect();
    let mut found = Vec::new();
    let mut group = "";
    for pair in lines.windows(2) {
        let is_group = ["pub struct ", "pub enum ", "pub mod "].iter().any(|word| pair[0].starts_with(word));
        group = if is_group { pair[0] } else { group };
        let Some((source, _)) = pair[0].strip_prefix("/// ").and_then(|docs| docs.split_once('`')?.1.split_once('`'))
        else {
            continue;
        };
        let declared = pair[1].trim_start_matches("pub ").trim_start_matches("const ");
        let name: String = declared.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
        // a function's page may begin with a formula
        let is_item = ["fn", "trait"].contains(&name.as_str());
        let is_public = ["pub const ", "pub "].iter().any(|word| pair[1].starts_with(word));
        if !is_item && (is_public || pair[1].ends_with(',')) {
            found.push([format!("{group} {source}"), name]);
        }
    }
    found
}

#[test]
fn a_new_declaration_changes_no_name_of_another() {
    let text = "mechanism machine {
            param leg_0_reach = 1 m
            param Reach = 1 m
            param A = (0, 0)
            input leg_0_turn = t / 1 s
            input swing[k in 0..2] = k + t / 1 s
            ground { point O = (0, 0) }
            body leg[k in 0..2] at (0, 0, 0) { point O = (0, 0)  point foot = (Reach + leg_0_reach + A.x, 0) }
            joint pivot[k in 0..2]: revolute(ground.O, leg[k].O)
            driver motor_0: rotation(pivot[0]) = leg_0_turn + swing[0]
            driver motor_1: rotation(pivot[1]) = swing[1]
            measure leg_0_x = x(leg[0].foot)
            //+
        }";
    let before = emitted_names(text);
    assert!(before.len() > 30, "{before:?}");
    let added = [
        "param reach = 2 m",
        "param a_x = 2 m",
        "param fn_ = 2",
        "input turn = 2",
        "input motor[k in 0..2] = k",
        "input swing_0_turn = 1",
        "measure leg_1_x = t / 1 s",
        "measure leg_0_X = t / 1 s",
        "measure leg_x[k in 0..2] = k * t",
        "body arm at (0, 0, 0) { point O = (0, 0) }  joint hinge: revolute(ground.O, arm.O)  driver d: rotation(hinge) = t",
        "body Leg_0 at (0, 0, 0) { point O = (0, 0) }  joint Pivot_0: revolute(ground.O, Leg_0.O)  driver Motor_0: rotation(Pivot_0) = t",
        "body wing[k in 0..2] at (0, 0, 0) { point O = (0, 0) }  joint motor_0_1[k in 0..2]: revolute(ground.O, wing[k].O)
         driver motor_2[k in 0..2]: rotation(motor_0_1[k]) = t",
    ];
    // a path gives way to what spells it, and of two that are alike the second
    let gives_way = |declaration: &str, is_first: bool, source: &str| {
        (declaration.contains("a_x") && source.ends_with(" A.x"))
            || (declaration.contains("Leg_0") && (source.contains("leg[0]") || source.contains("pivot[0]")))
            || (is_first && declaration.contains("Leg_0") && source.contains("motor_0"))
            || (is_first && declaration.contains("reach = ") && source.ends_with(" Reach"))
            || (is_first && declaration.contains("leg_0_X") && source.ends_with(" leg_0_x"))
    };
    for declaration in added {
        // in front of all others, and behind them
        for place in ["mechanism machine {", "//+"] {
            let after = emitted_names(&text.replacen(place, &format!("{place}\n{declaration}\n"), 1));
            assert!(after.len() > before.len(), "{declaration}");
            for [source, name] in &before {
                let now = after.iter().find(|[known, _]| known == source).unwrap_or_else(|| panic!("no {source}"));
                assert!(
                    now[1] == *name || gives_way(declaration, place != "//+", source),
                    "{declaration}: {source} was {name}, is {}",
                    now[1]
                );
            }
            // and what meets is told apart
            let mut all: Vec<(&str, &String)> =
                after.iter().map(|[source, name]| (source.rsplit_once(' ').expect("a group").0, name)).collect();
            let count = all.len();
            all.sort_unstable();
            all.dedup();
            assert_eq!(all.len(), count, "{declaration}: {after:?}");
        }
    }
    // a plain name keeps it, whichever comes first
    for declarations in ["param a_x = 2 m\n", ""] {
        let text = text.replace("            param Reach", &format!("            {declarations}param Reach"));
        let names = emitted_names(&text);
        let of = |source: &str| {
            names
                .iter()
                .find(|[known, _]| known.starts_with("pub struct Params") && known.ends_with(source))
                .map(|found| found[1].clone())
        };
        let has = !declarations.is_empty();
        assert_eq!(of(" A.x").as_deref(), Some(if has { "a_x_2" } else { "a_x" }));
        assert_eq!(of(" a_x").as_deref(), has.then_some("a_x"));
    }
}

#[test]
fn no_inputs_no_following() {
    let text = text_of("four_bar");
    let formula = "30 deg + 1.5 rad * sin(2 rad/s * t)";
    let plain = text.replace(&format!("    input turn = {formula}\n"), "").replace("= turn", &format!("= {formula}"));
    let (with, without) = (emitted(&text).text(Some(2)), emitted(&plain).text(Some(2)));
    for word in ["follow(", "Inputs", "influence(", "InputContinuation", "Signal"] {
        assert!(with.contains(word) && !without.contains(word), "{word}");
    }
}
