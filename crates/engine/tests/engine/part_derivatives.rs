//! Derivatives by name inside a part: by its own equations, with its inputs held, whatever is around it.

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

/// A lever whose input follows a link that has to turn as the lever's tip is lifted.
fn lifted(mount: &str, more: &str) -> String {
    format!(
        "mechanism whole {{
    ground {{ point O = (0, 0) }}
    body link at (3 m, 0, 0.2) {{ point O = (0, 0) }}
    joint pin: revolute((3 m, 0), link.O)
    {mount}
    driver lift: y(p.arm.tip) = 0.4 m + 0.3 m/s * t
    {more}
}}\n{LEVER}"
    )
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
    let text = lifted(
        "part p: lever(turn = 2 * angle(link)) at (0, 0, 0)",
        "measure angle_of_arm = angle(p.arm)
    measure by_all = der(x(p.arm.tip), p.reach)
    measure of_gain = der(p.gain, p.reach)
    measure of_gain_by_half = der(p.by_turn, half)
    param half = 0.3 m/s
    result least = min(p.both)",
    )
    .replace("0.3 m/s * t", "half * t");
    let (table, compiled) = table(&text);
    is_as_alone(&table, "angle_of_arm");
    // by all equations the tip stays at its height: φ' = −tan φ / r
    let tan = |x: f64| sin(x) / cos(x);
    holds(&table, "by_all", &["angle_of_arm"], |x| cos(x[0]) + sin(x[0]) * tan(x[0]));
    holds(&table, "of_gain", &["angle_of_arm"], |x| sin(x[0]) * tan(x[0]));
    // φ' = t / (r cos φ)
    holds(&table, "of_gain_by_half", &["angle_of_arm", "t"], |x| -tan(x[0]) * x[1]);
    let mut run =
        compiled.run(&Times::grid(0.0, 1.0, 0.5).expect("a grid"), &RunOptions::default()).0.expect("it runs");
    while run.next_row().is_some() {}
    let answers = run.results().expect("results");
    // the tip goes from 0.4 m to 0.7 m
    let wanted = [0.84_f64.sqrt(), 0.0, -0.7];
    for (value, wanted) in answers.values.iter().zip(wanted) {
        let value = value.unwrap_or_else(|| panic!("{:?}", answers.notes));
        assert!((value - wanted).abs() < CLOSE, "{value} instead of {wanted}");
    }
}

#[test]
fn mounted_parts_use_their_own_ground() {
    // the mount slides as the tip asks, which stays at its height
    let text = format!(
        "mechanism whole {{
    ground {{ axis way = (0, 0) along (0, 1) }}
    body cart at (0, 0.1 m, 0) {{ axis way = (0, 0) along (0, 1) }}
    joint guide: translational(ground.way, cart.way)
    part p: lever(turn = 0.5 + 0.2 * t) on cart at (1 m, 0, 0) mirrored
    driver level: y(p.arm.tip) = 0.2 m
    measure angle_of_arm = -angle(p.arm)
}}\n{LEVER}"
    );
    let (table, _) = table(&text);
    is_as_alone(&table, "angle_of_arm");
}

#[test]
fn feedback_inputs_are_held() {
    let text = format!(
        "mechanism whole {{
    part p: lever(turn = 0.5 * angle(p.arm) + 0.3 + 0.1 * t) at (0, 0, 0)
    measure angle_of_arm = angle(p.arm)
    measure by_all = der(x(p.arm.tip), p.reach)
}}\n{LEVER}"
    );
    let (table, _) = table(&text);
    holds(&table, "angle_of_arm", &["t"], |x| 0.6 + 0.2 * x[0]);
    is_as_alone(&table, "angle_of_arm");
}

#[test]
fn nested_parts_have_separate_derivatives() {
    let text = format!(
        "mechanism whole {{
    ground {{ point O = (0, 0) }}
    body link at (3 m, 0, 0.2) {{ point O = (0, 0) }}
    joint pin: revolute((3 m, 0), link.O)
    part o: outer(swing = 2 * angle(link)) at (0, 0, 0)
    driver lift: y(o.p.arm.tip) = 0.4 m + 0.3 m/s * t
    measure angle_of_arm = angle(o.p.arm)
}}
mechanism outer {{
    input swing = 0.5
    param more = 1
    part p: lever(turn = more * swing) at (0, 0, 0)
    measure by_more = der(x(p.arm.tip), more)
    measure by_reach = der(y(p.arm.tip), p.reach)
    measure of_gain = der(p.gain, swing)
}}\n{LEVER}"
    );
    let (table, _) = table(&text);
    let angle = ["angle_of_arm"];
    holds(&table, "o.p.gain", &angle, |x| cos(x[0]));
    holds(&table, "o.p.both", &angle, |x| -sin(x[0]));
    holds(&table, "o.by_more", &angle, |x| -sin(x[0]) * x[0]);
    holds(&table, "o.by_reach", &angle, |x| sin(x[0]));
    holds(&table, "o.of_gain", &angle, |x| -sin(x[0]));
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

/// A rod that a slider's way turns, seen from the rod: with the way held there is a dead point where the rod lies along it.
#[test]
fn dead_points_of_parts_leave_no_value() {
    let text = "mechanism whole {
    ground { point O = (0, 0) axis way = (0, 3 m) along (1, 0) }
    body follower at (0.8 m, 3 m, 0) { axis way = (0, 0) along (1, 0)  point P = (0, 0) }
    joint guide: translational(ground.way, follower.way)
    part p: push(way = x(follower.P)) at (0, 0, 0)
    driver turn: angle(p.rod) = 0.5 - t
    measure angle_of_rod = angle(p.rod)
}
mechanism push {
    input way = 0.8 m
    param long = 1 m
    ground { point O = (0, 0) }
    body rod at (0, 0, 0.5) { point O = (0, 0)  point eye = (long, 0) }
    joint main: revolute(ground.O, rod.O)
    constraint pushed: x(rod.eye) = way
    measure gain = der(angle(rod), way)
}\n";
    let text = text.replace("constraint pushed", "driver pushed");
    let compiled = compile(&text).unwrap_or_else(|messages| panic!("{messages:?}"));
    let times = Times::listed(0.0, vec![0.0, 0.25, 0.4999, 0.5, 0.5001, 0.75]);
    let (rows, messages) = all_rows(&compiled, &times);
    let at = |name: &str| compiled.columns().iter().position(|column| column == name).expect("a column");
    let (gain, angle) = (at("p.gain"), at("angle_of_rod"));
    assert_eq!(rows.len(), 6, "{messages:?}");
    for (k, row) in rows.iter().enumerate() {
        if (2..5).contains(&k) {
            assert!(row[gain].is_nan(), "{row:?}");
        } else {
            assert!((row[gain] + 1.0 / sin(row[angle])).abs() < 1e-8, "{row:?}");
        }
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
