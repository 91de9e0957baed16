//! Derivatives by name inside a part: by its own equations, with its inputs held. They exist only if these equations determine the part.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::all_rows;
use crate::support::table::Table;
use mechc::{Cancel, Choice, Compiled, Diagnostics, Memory, Parsed, Redundant, RunOptions, Times};
use mechc_expr::math::{cos, sin};

const CLOSE: f64 = 1e-9;

/// An arm that an input turns.
const LEVER: &str = "mechanism lever {
    param reach = 1 m
    input turn = 0.4 + 0.1 * t
    ground { point O = (0, 0) }
    body arm at (0, 0, 0.4) { point O = (0, 0)  point tip = (reach, 0) }
    joint main: revolute(ground.O, arm.O)
    driver motor: rotation(main) = turn
    measure width = x(arm.tip)
    measure gain = der(width, reach)
    measure by_turn = der(y(arm.tip), turn)
    measure both = der(der(width, turn), reach)
    measure rate = der(der(width), reach)
    measure itself = der(turn * width, turn)
    result most = max(gain)
    result turned = argmax(by_turn)
}\n";

fn compile(text: &str) -> Result<Compiled, Diagnostics> {
    let choice = Choice { mechanism: Some("whole".to_owned()), ..Choice::default() };
    let checked = Parsed::new("m.mech", text).check(&choice, &Memory::default());
    if !checked.is_sound() {
        return Err(checked.diagnostics().clone());
    }
    let (compiled, messages) = checked.compile(Redundant::Refused, &Cancel::default());
    compiled.ok_or(messages)
}

/// Each row of a column is what a formula makes of some others.
#[track_caller]
fn holds(table: &Table, name: &str, of: &[&str], wanted: impl Fn(&[f64]) -> f64) {
    let given: Vec<Vec<f64>> = of.iter().map(|name| table.column(name)).collect();
    for (k, found) in table.column(name).into_iter().enumerate() {
        let values: Vec<f64> = given.iter().map(|column| column[k]).collect();
        let wanted = wanted(&values);
        assert!((found - wanted).abs() <= CLOSE * wanted.abs().max(1.0), "{name}: {found} instead of {wanted}");
    }
}

fn table(text: &str) -> (Table, Compiled) {
    let compiled = compile(text)
        .unwrap_or_else(|messages| panic!("{:?}", messages.iter().map(|s| &s.message).collect::<Vec<_>>()));
    let (rows, messages) = all_rows(&compiled, &Times::grid(0.0, 1.0, 0.1).expect("a grid"));
    assert!(rows.len() == 11, "{messages:?}");
    (Table { columns: compiled.columns(), rows }, compiled)
}

/// Checks the lever's own measures against its angle and the rate of that angle.
fn is_as_alone(table: &Table, angle: &str) {
    let rate = format!("{angle}.d");
    holds(table, "p.gain", &[angle], |x| cos(x[0]));
    holds(table, "p.gain.d", &[angle, &rate], |x| -sin(x[0]) * x[1]);
    holds(table, "p.by_turn", &[angle], |x| cos(x[0]));
    holds(table, "p.both", &[angle], |x| -sin(x[0]));
    holds(table, "p.both.d", &[angle, &rate], |x| -cos(x[0]) * x[1]);
    holds(table, "p.rate", &[angle, &rate], |x| -sin(x[0]) * x[1]);
    holds(table, "p.itself", &[angle], |x| cos(x[0]) - x[0] * sin(x[0]));
}

#[test]
fn bound_inputs_leave_part_derivatives_unchanged() {
    let text = format!(
        "mechanism whole {{
    ground {{ point O = (0, 0) }}
    body link at (3 m, 0, 0.2) {{ point O = (0, 0) }}
    joint pin: revolute((3 m, 0), link.O)
    driver swing: rotation(pin) = half + 0.1 * t
    part p: lever(turn = 2 * angle(link)) at (0, 0, 0)
    param half = 0.2
    measure angle_of_arm = angle(p.arm)
    measure of_gain_by_half = der(p.gain, half)
    result least = min(p.both)
}}\n{LEVER}"
    );
    let (table, compiled) = table(&text);
    is_as_alone(&table, "angle_of_arm");
    holds(&table, "of_gain_by_half", &["angle_of_arm"], |x| -2.0 * sin(x[0]));
    let mut run =
        compiled.run(&Times::grid(0.0, 1.0, 0.5).expect("a grid"), &RunOptions::default()).0.expect("it runs");
    while run.next_row().is_some() {}
    let answers = run.results().expect("results");
    // the arm turns from 0.4 to 0.6
    let wanted = [cos(0.4), 0.0, -sin(0.6)];
    for (value, wanted) in answers.values.iter().zip(wanted) {
        let value = value.unwrap_or_else(|| panic!("{:?}", answers.notes));
        assert!((value - wanted).abs() < CLOSE, "{value} instead of {wanted}");
    }
}

#[test]
fn uncoupled_parts_keep_their_bits() {
    let around = |requested: &str| {
        format!(
            "mechanism whole {{
    part p: lever(turn = 0.7 + t) at (1 m, 2 m, 0.3) mirrored
    {requested}
}}\n{LEVER}"
        )
    };
    let (inside, _) = table(&around(""));
    let (outside, _) = table(&around("measure width = der(p.width, p.reach)"));
    assert_eq!(inside.column("p.gain"), outside.column("width"));
}

/// Refuses the derivatives of a part, and takes what the message says instead: each is given as the mechanism around it and the derivative
/// that it may hold.
#[test]
fn coupled_parts_are_refused_with_a_substitute() {
    let link = "ground { point O = (0, 0) }
    body link at (3 m, 0, 0.2) { point O = (0, 0) }
    joint pin: revolute((3 m, 0), link.O)";
    let lift = "driver lift: y(p.arm.tip) = 0.4 m + 0.3 m/s * t";
    let cart = "ground { axis way = (0, 0) along (0, 1) }
    body cart at (0, 0.1 m, 0) { axis way = (0, 0) along (0, 1) }
    joint guide: translational(ground.way, cart.way)
    part p: lever(turn = 0.5 + 0.2 * t) on cart at (1 m, 0, 0) mirrored
    driver level: y(p.arm.tip) = 0.2 m";
    let coupled = [
        // the input follows a link that has to turn as the tip is lifted
        format!("{link}  part p: lever(turn = 2 * angle(link)) at (0, 0, 0)  {lift}"),
        // the mount slides as the tip asks
        cart.to_owned(),
        // the input follows the part itself
        "part p: lever(turn = 0.5 * angle(p.arm) + 0.3 + 0.1 * t) at (0, 0, 0)".to_owned(),
    ];
    for around in coupled {
        let text = |around: &str, lever: &str| format!("mechanism whole {{ {around} }}\n{lever}");
        let messages = compile(&text(&around, LEVER)).err().expect("it is refused");
        let faults: Vec<_> = messages.iter().filter(|message| message.code.as_str() == "E0508").collect();
        let [fault] = faults.as_slice() else { panic!("{messages:?}") };
        let help = fault.help.first().expect("a help");
        assert!(help.ends_with("`der(p.width, p.reach)`"), "{help}");
        let is_allowed = |line: &&str| !line.contains("der(") && !line.contains("result");
        let lever: Vec<&str> = LEVER.lines().filter(is_allowed).collect();
        let around = format!("{around}  measure gain = der(p.width, p.reach)");
        assert!(compile(&text(&around, &lever.join("\n"))).is_ok(), "{around}");
    }
}

#[test]
fn undetermined_parts_are_reported_at_both_places() {
    let text = format!(
        "mechanism whole {{
    part p: loose() at (0, 0, 0)
    driver motor: rotation(p.main) = t
}}\n{}",
        LEVER.replace("lever", "loose").replace("driver motor: rotation(main) = turn", "")
    );
    let messages = compile(&text).err().expect("it is refused");
    let faults: Vec<_> = messages.iter().filter(|message| message.code.as_str() == "E0508").collect();
    let [fault] = faults.as_slice() else { panic!("{messages:?}") };
    let place = |label: &mechc::Label| &text[label.span.start as usize..label.span.end as usize];
    let first = fault.labels.iter().find(|label| label.primary).expect("a place");
    assert_eq!(place(first), "der(width, reach)");
    let used = fault.labels.iter().find(|label| label.text == "in part `p`, used here").expect("its use");
    assert_eq!(place(used), "p");
    // from outside it may be asked for
    let requested = text.replace("driver motor", "measure seen = der(x(p.arm.tip), p.reach)\n    driver motor");
    let asks_inside = |line: &&str| line.contains("der(") && !line.contains("measure seen") || line.contains("result");
    let quiet: Vec<&str> = requested.lines().filter(|line| !asks_inside(line)).collect();
    assert!(compile(&quiet.join("\n")).is_ok());
}
