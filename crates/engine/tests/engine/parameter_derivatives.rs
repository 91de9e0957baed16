//! Derivatives by inputs and parameters: closed forms, what is held and what varies, edges, singular positions, columns and their units.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::change_points::parallelogram_of_names;
use crate::support::{Disk, Outcome, all_rows, follow, text_of};
use mechc::{Cancel, Choice, Compiled, Memory, Parsed, Redundant, RunOptions, Times};
use mechc_expr::math;
use std::f64::consts::{FRAC_PI_2, PI};

/// A row that is right may be off by this part of a number.
const EXACT: f64 = 1e-9;

fn compile(text: &str, choice: &Choice, redundant: Redundant) -> (Compiled, Outcome) {
    let checked = Parsed::new("m.mech", text).check(choice, &Memory::default());
    let reported: Vec<&str> = checked.diagnostics().iter().map(|message| message.message.as_str()).collect();
    assert!(checked.is_sound(), "{reported:?}");
    let (compiled, messages) = checked.compile(redundant, &Cancel::default());
    let mut outcome = Outcome {
        sources: checked.sources().clone(),
        diagnostics: checked.diagnostics().clone(),
        columns: Vec::new(),
        rows: Vec::new(),
    };
    outcome.diagnostics.extend(messages);
    (compiled.unwrap_or_else(|| panic!("{}", outcome.text())), outcome)
}

fn by(names: &[&str]) -> Choice {
    Choice { by: names.iter().map(|&name| name.to_owned()).collect(), ..Choice::default() }
}

/// The rows of a text with columns by some names, at some times.
fn rows_at(text: &str, names: &[&str], times: &[f64], options: &RunOptions) -> Outcome {
    let (compiled, mut outcome) = compile(text, &by(names), Redundant::LeftOut);
    follow(&compiled, &Times::listed(0.0, times.to_vec()), options, &mut outcome);
    outcome.expect_success()
}

/// An arm that a driver turns, with what is declared beside it.
fn arm(declarations: &str, driver: &str) -> String {
    format!(
        "mechanism m {{
            {declarations}
            ground {{ point O = (0, 0) }}
            body arm {{ point O = (0, 0)  point tip = (reach, 0) }}
            joint main: revolute(ground.O, arm.O)
            driver motor: rotation(main) = {driver}
            analysis from 0 s to 2 s every 125 ms
        }}"
    )
}

fn arm_at(declarations: &str, driver: &str, names: &[&str], t: f64) -> Outcome {
    rows_at(&arm(declarations, driver), names, &[t], &RunOptions::default())
}

fn value(outcome: &Outcome, column: &str) -> f64 {
    outcome.column(column)[0]
}

fn is(outcome: &Outcome, column: &str, wanted: f64) {
    let found = value(outcome, column);
    assert!((found - wanted).abs() <= EXACT * wanted.abs().max(1.0), "{column}: {found}, not {wanted}");
}

/// Derivatives of forces beside a load with a third time derivative would take the derivative of that.
#[test]
fn forces_with_jerk_have_no_derivative_columns() {
    let text = |order: &str| {
        arm(
            &format!("param reach = 2 m load drag: 1 N*m * {order} on rotation(main) measure e = effort(motor)"),
            "reach / 1 m * sin(t / 1 s)",
        )
    };
    let columns = |order: &str| rows_at(&text(order), &["reach"], &[0.0, 0.5], &RunOptions::default()).columns;
    assert!(columns("der(der(rotation(main))) * 1 s^2").contains(&"e.by.reach".to_owned()));
    let beside = columns("der(der(der(rotation(main)))) * 1 s^3");
    assert!(beside.contains(&"e".to_owned()) && beside.contains(&"arm.phi.dd.by.reach".to_owned()));
    assert!(!beside.iter().any(|name| name == "e.by.reach"), "{beside:?}");
}

#[test]
fn input_derivatives_hold_rates() {
    let declarations = "param reach = 2 m
        input turn = 0.3 + 2 * t + t^2
        measure height = y(arm.tip)
        measure itself = der(turn, turn)
        measure its_rate = der(der(turn), turn)
        measure twice = der(der(turn * x(arm.tip), turn), turn)";
    let outcome = arm_at(declarations, "turn", &["turn"], 1.0);
    let (sin, cos, rate, growth) = (math::sin(3.3), math::cos(3.3), 4.0, 2.0);
    is(&outcome, "height.by.turn", 2.0 * cos);
    is(&outcome, "height.d.by.turn", -2.0 * sin * rate);
    is(&outcome, "height.dd.by.turn", -2.0 * (cos * rate * rate + sin * growth));
    is(&outcome, "arm.phi.by.turn", 1.0);
    is(&outcome, "arm.phi.d.by.turn", 0.0);
    is(&outcome, "itself", 1.0);
    is(&outcome, "its_rate", 0.0);
    is(&outcome, "twice", 2.0 * (-2.0 * sin - 3.3 * cos));
}

#[test]
fn param_derivatives_include_dependent_params() {
    let declarations = "param half = 1 m
        param reach = 2 * half
        param more = reach + half
        measure width = x(arm.tip) + more
        measure pure = der(half^2 * t, half)
        measure constant = der(3 * reach, half)";
    let outcome = arm_at(declarations, "t", &["half", "reach", "more"], 1.0);
    let cos = math::cos(1.0);
    is(&outcome, "width.by.half", 2.0 * cos + 3.0);
    is(&outcome, "width.by.reach", cos + 1.0);
    is(&outcome, "width.by.more", 1.0);
    is(&outcome, "pure", 2.0);
    is(&outcome, "constant", 6.0);
    // in the order given, behind all others, a block for each
    let firsts: Vec<&str> = outcome.columns.iter().map(String::as_str).filter(|c| c.starts_with("arm.x.by")).collect();
    assert_eq!(firsts, ["arm.x.by.half", "arm.x.by.reach", "arm.x.by.more"]);
    let behind = outcome.columns.iter().position(|column| column.contains(".by.")).expect("columns");
    assert!(outcome.columns[behind..].iter().all(|column| column.contains(".by.")));
}

#[test]
fn points_and_repeated_inputs_expand() {
    let text = "mechanism m {
        param A = (1 m, 0)
        input turn[k in 0..2] = (k + 1) * t
        ground { point O = (0, 0) }
        body arm[k in 0..2] { point O = (0, 0)  point tip = A }
        joint main[k in 0..2]: revolute(ground.O, arm[k].O)
        driver motor[k in 0..2]: rotation(main[k]) = turn[k]
        measure width = x(arm[1].tip)
        measure of_copy = der(width, turn[1])
        measure of_coordinate = der(width, A.y)
        analysis from 0 s to 1 s every 1 s
    }";
    let outcome = rows_at(text, &["A", "turn", "turn[1]"], &[0.5], &RunOptions::default());
    let (sin, cos) = math::sin_cos(1.0);
    is(&outcome, "width.by.A.x", cos);
    is(&outcome, "width.by.A.y", -sin);
    is(&outcome, "width.by.turn[0]", 0.0);
    is(&outcome, "width.by.turn[1]", -sin);
    is(&outcome, "of_copy", -sin);
    is(&outcome, "of_coordinate", -sin);
    assert_eq!(outcome.columns.iter().filter(|column| *column == "width.by.turn[1]").count(), 1);
}

#[test]
fn samples_and_formulas_from_outside_are_shifted_too() {
    let text = arm("param reach = 1 m  input turn = 0 * t  measure height = y(arm.tip)", "turn^2");
    let world = Memory::default().with("samples.csv", "t,turn [deg]\n0,10\n1,30\n2,90\n");
    let reported = [
        Choice { samples: Some("samples.csv".into()), ..by(&["turn"]) },
        Choice { inputs: vec!["turn=0.4 + t/3".to_owned()], ..by(&["turn"]) },
    ];
    for choice in reported {
        let checked = Parsed::new("m.mech", &text).check(&choice, &world);
        let compiled = checked.compile(Redundant::Refused, &Cancel::default()).0.expect("it is determined");
        let (rows, _) = all_rows(&compiled, &Times::listed(0.0, vec![0.7]));
        let at = |name: &str| rows[0][compiled.columns().iter().position(|column| column == name).expect("a column")];
        let (phi, turn) = (at("arm.phi"), math::sqrt(at("arm.phi")));
        assert!((at("height.by.turn") - math::cos(phi) * 2.0 * turn).abs() < EXACT);
    }
}

#[test]
fn shifts_of_switches_do_not_count() {
    let declarations = "param reach = 1 m
        param from = 1
        input turn = t
        fn kink(u) = if u < from then u else u + (u - from)^3
        measure slope = der(der(angle(arm), turn), turn)
        measure jolt = der(der(der(angle(arm), from), from))
        measure by_switch = der(if turn < from then 1 m else 3 m, from)";
    let text = arm(declarations, "kink(turn)");
    let outcome = rows_at(&text, &[], &[0.5, 1.0, 1.5], &RunOptions::default());
    let near = |found: Vec<f64>, wanted: [f64; 3]| {
        for (found, wanted) in found.into_iter().zip(wanted) {
            assert!((found - wanted).abs() < EXACT, "{found}, not {wanted}");
        }
    };
    near(outcome.column("slope"), [0.0, 0.0, 3.0]);
    near(outcome.column("by_switch"), [0.0, 0.0, 0.0]);
    // of the pieces the later one counts on their edge
    near(outcome.column("jolt"), [0.0, 6.0, 6.0]);
    let back =
        rows_at(&text.replace("input turn = t", "input turn = 2 - t"), &[], &[0.5, 1.0, 1.5], &RunOptions::default());
    near(back.column("jolt"), [-6.0, 0.0, 0.0]);
}

/// Where a parallelogram folds, the derivative by its crank has a pole.
const ASKED_OF_PARALLELOGRAM: &str = "measure both = der(der(angle(rocker), crank_length), turn)
    analysis from 0 s to 3 s every 10 ms";

#[test]
fn derivatives_near_change_points_are_right_or_missing() {
    let options = RunOptions { pass_bifurcations: true, ..RunOptions::default() };
    let away = [0.7, 0.2, 0.05, 0.01, 6e-3, 4e-3, 3e-3, 2e-3, 1.5e-3, 1e-3, 5e-4, 1e-4, 1e-5, 1e-6, 0.0];
    let mut times: Vec<f64> = away.iter().map(|away| 1.5 - away).collect();
    times.extend(away.iter().rev().skip(1).map(|away| 1.5 + away));
    let outcome = rows_at(&parallelogram_of_names(ASKED_OF_PARALLELOGRAM), &["crank_length"], &times, &options);
    let columns = ["", ".d", ".dd"].map(|end| {
        let first = outcome.column(&format!("rocker.phi{end}.by.crank_length"));
        let second = outcome.column(&format!("both{end}"));
        (first, second)
    });
    for (k, t) in times.iter().enumerate() {
        // −cot of the crank's angle
        let (turned, rate) = ((t - 1.5) * FRAC_PI_2, FRAC_PI_2);
        let (sin, cot) = (math::sin(turned), math::cos(turned) / math::sin(turned));
        let slope = 1.0 / (sin * sin);
        let bend = -2.0 * cot * slope;
        let wanted = [
            (-cot, slope),
            (slope * rate, bend * rate),
            (bend * rate * rate, (4.0 * cot * cot * slope + 2.0 * slope * slope) * rate * rate),
        ];
        let off = (t - 1.5).abs();
        for (order, ((first, second), (by_one, by_two))) in columns.iter().zip(wanted).enumerate() {
            for (found, wanted) in [(first[k], by_one), (second[k], by_two)] {
                let is_right = (found - wanted).abs() <= 1e-8 * wanted.abs();
                assert!(is_right || found.is_nan(), "order {order} at {t}: {found}, not {wanted}");
                assert!(found.is_nan() || off > 2e-4, "nobody can know that at {t}");
                assert!(!found.is_nan() || off < 2e-3, "missing at {t}");
            }
        }
    }
    // all else is there, and what is missing has been told once for each
    assert!(outcome.column("rocker.phi.dd").iter().all(|value| value.is_finite()));
    assert_eq!(outcome.codes().iter().filter(|code| **code == "W0603").count(), 2, "{}", outcome.text());
}

#[test]
fn breaking_a_left_out_equation_leaves_no_derivative() {
    let text = parallelogram_of_names(ASKED_OF_PARALLELOGRAM)
        .replace(
            "point A = (0, 0)  point B = (2 m, 0) }\n    body crank",
            "point A = (0, 0)  point B = (2 m, 0)  point E = (1 m, 0) }\n    body crank",
        )
        .replace("point D = (2 m, 0) }", "point D = (2 m, 0)  point F = (1 m, third) }")
        .replace("input turn", "param third = 0 m\n    input turn")
        .replace("    driver", "    constraint mid: distance(ground.E, coupler.F) = 1 m\n    driver");
    let outcome = rows_at(&text, &["turn", "crank_length", "third"], &[0.1, 0.2, 0.9], &RunOptions::default());
    assert!(outcome.codes().contains(&"W0502"), "{}", outcome.text());
    let present = |name: &str| outcome.column(name).iter().all(|value| value.is_finite());
    let missing = |name: &str| outcome.column(name).iter().all(|value| value.is_nan());
    assert!(present("rocker.phi.by.turn") && present("coupler.x.dd.by.turn"));
    assert!(missing("rocker.phi.by.crank_length") && missing("coupler.phi.d.by.third") && missing("both"));
    assert!(present("rocker.phi") && present("coupler.x.dd"));
}

/// The same rows, to the bit, but for the columns of derivatives.
#[test]
fn derivative_columns_change_no_other_bit() {
    for name in [
        "jansen",
        "gear_train",
        "slider_crank",
        "cam_roller",
        "drawn_four_bar",
        "quick_return",
        "table_list",
        "pf_ellipse",
    ] {
        let path = format!("tests/cases/{name}.mech");
        let text = text_of(&path);
        let rows = |names: &[String]| {
            let choice = Choice { by: names.to_vec(), ..Choice::default() };
            let checked = Parsed::new(&path, &text).check(&choice, &Disk::default());
            let compiled = checked.compile(Redundant::Refused, &Cancel::default()).0.expect("it is determined");
            let times = compiled.times().expect("times");
            let params: Vec<String> = compiled.inside().0.system().params().iter().map(|p| p.name.clone()).collect();
            (all_rows(&compiled, &times).0, params)
        };
        let (plain, params) = rows(&[]);
        let (varied, _) = rows(&params[..params.len().min(3)]);
        assert_eq!(plain.len(), varied.len());
        for (plain, varied) in plain.iter().zip(&varied) {
            assert!(varied.len() > plain.len());
            let same = plain.iter().zip(varied).all(|(a, b)| a.to_bits() == b.to_bits());
            assert!(same, "{name} at {}: {plain:?}\n{varied:?}", plain[0]);
        }
    }
}

/// What is shifted for a derivative is added nothing but 0: an input, also one that is constant, and a param that follows from others.
#[test]
fn shifts_change_no_bit() {
    let text = "mechanism q {
    param half = 15 mm
    param crank_length = 2 * half
    input turn = 40 deg + 5 rad/s * t + 2 rad/s^2 * t^2
    input gain = 2
    ground { point A = (0, 0)  point D = (80 mm, 0) }
    body crank at (0, 0, 40 deg) { point A = (0, 0)  point B = (crank_length, 0) }
    body coupler at (23 mm, 19 mm, 33 deg) { point B = (0, 0)  point C = (70 mm, 0) }
    body rocker at (80 mm, 0, 88 deg) { point D = (0, 0)  point C = (60 mm, 0) }
    body free { point F = (0, 0) }
    joint main:  revolute(ground.A, crank.A)
    joint pin:   revolute(crank.B, coupler.B)
    joint knee:  revolute(coupler.C, rocker.C)
    joint pivot: revolute(ground.D, rocker.D)
    driver motor: rotation(main) = turn
    driver fx: x(free.F) * gain = 1 m * sin(turn)
    driver fy: y(free.F) = 1 m * gain
    driver fa: angle(free) + gain * 0.1 * sin(angle(free)) = turn
    analysis from 0 s to 1 s every 5 ms
}";
    let rows = |names: &[&str]| {
        let (compiled, _) = compile(text, &by(names), Redundant::Refused);
        all_rows(&compiled, &compiled.times().expect("times")).0
    };
    let (plain, varied) = (rows(&[]), rows(&["turn", "crank_length", "gain"]));
    assert_eq!(plain.len(), varied.len());
    for (plain, varied) in plain.iter().zip(&varied) {
        assert!(plain.iter().zip(varied).all(|(a, b)| a.to_bits() == b.to_bits()), "at {}", plain[0]);
    }
}

#[test]
fn derivatives_do_not_depend_on_other_rows() {
    let text = text_of("tests/cases/sensitivities.mech");
    let (compiled, _) = compile(&text, &by(&["turn", "base"]), Redundant::Refused);
    let times = compiled.times().expect("times");
    let (rows, _) = all_rows(&compiled, &times);
    for row in rows.iter().step_by(7) {
        let (alone, _) = all_rows(&compiled, &Times::listed(0.0, vec![row[0]]));
        let bits = |row: &[f64]| row.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
        assert_eq!(bits(&alone[0]), bits(row), "at {}", row[0]);
    }
}

#[test]
fn derivatives_have_the_units_of_quotients() {
    let declarations = "param reach = 2 m
        param pace = 3 rad/s
        param span = 1 s
        input turn = 30 deg + pace * t + (t / span)^2
        measure high = y(arm.tip) in mm
        measure swept = rotation(main) * reach^2
        measure ratio = der(rotation(main), turn)
        measure by_reach = der(y(arm.tip), reach)
        measure by_pace = der(rotation(main), pace)
        measure in_own = der(y(arm.tip), pace) in mm*s
        trace path = arm.tip in mm";
    let (compiled, _) =
        compile(&arm(declarations, "turn"), &by(&["reach", "pace", "span", "turn"]), Redundant::Refused);
    let (columns, units) = (compiled.columns(), compiled.units());
    let unit = |name: &str| {
        let at = columns.iter().position(|column| column == name).unwrap_or_else(|| panic!("no {name}"));
        units[at].text.as_str()
    };
    for (column, wanted) in [
        ("arm.x.by.reach", "1"),
        ("arm.x.d.by.reach", "1/s"),
        ("arm.phi.by.reach", "rad/m"),
        ("arm.phi.dd.by.reach", "rad/s^2/m"),
        ("arm.phi.by.pace", "s"),
        ("arm.phi.d.by.pace", "1"),
        ("arm.x.by.pace", "m*s"),
        ("arm.x.by.span", "m/s"),
        ("arm.x.d.by.span", "m/s^2"),
        ("arm.x.by.turn", "m"),
        ("arm.phi.by.turn", "1"),
        ("high.by.reach", "mm/m"),
        ("high.dd.by.turn", "mm/s^2"),
        ("path.x.by.reach", "mm/m"),
        ("swept.by.reach", "m"),
        ("ratio", "1"),
        ("by_reach", "1"),
        ("by_pace", "s"),
        ("in_own", "mm*s"),
        ("in_own.by.reach", "mm*s/m"),
    ] {
        assert_eq!(unit(column), wanted, "{column}");
    }
    let at = columns.iter().position(|column| column == "high.by.reach").expect("a column");
    assert_eq!(units[at].printed(0.5), 500.0);
}

#[test]
fn columns_that_would_need_more_are_left_out() {
    let declarations = "param reach = 2 m
        input turn = PI * t
        measure one = der(x(arm.tip), reach)
        measure two = der(der(x(arm.tip), turn), turn)
        measure jerk = der(der(der(x(arm.tip))))
        measure rate = der(der(x(arm.tip), reach))";
    let text = arm(&declarations.replace("PI", &PI.to_string()), "turn");
    let (compiled, _) = compile(&text, &by(&["turn"]), Redundant::Refused);
    let columns = compiled.columns();
    let there = |name: &str| columns.iter().any(|column| column == name);
    for name in ["one.dd", "two.dd", "jerk", "rate.d", "one.by.turn", "one.dd.by.turn", "rate.d.by.turn"] {
        assert!(there(name), "{name} is missing");
    }
    for name in ["two.by.turn", "jerk.d", "jerk.by.turn", "rate.dd", "rate.dd.by.turn"] {
        assert!(!there(name), "{name} is there");
    }
}

/// An arm of length and mass that are varied, whose driver, pin and load are known by hand: with its mass at `2 reach`, an inertia, and a
/// force on its tip.
const HEAVY: &str = "mechanism m {
    param reach = 0.4 m
    param heavy = 3 kg
    param about = 0.05 kg * m^2
    param pushed = 7 N
    input turn = 0.3 + 2 rad/s * t + 1.5 rad/s^2 * t^2
    ground { point O = (0, 0) }
    body arm { point O = (0, 0)  point tip = (reach, 0)  mass heavy at (2 * reach, 0) inertia about }
    gravity (0, -9.81 m/s^2)
    joint main: revolute(ground.O, arm.O)
    driver motor: rotation(main) = turn
    load push: -pushed * sin(rotation(main)) on y(arm.tip)
    measure torque = effort(motor)
    measure by_mass = der(effort(motor), heavy)
    measure twice = der(der(force_x(main), heavy), reach)
    measure squared = der(der(effort(motor), reach), reach)
    result most = max(by_mass)
    result mean_squared = mean(der(der(effort(motor), reach), reach))
    analysis from 0 s to 1 s every 0.5 s
}";

#[test]
fn forces_have_their_derivatives_too() {
    let names = ["reach", "heavy", "about", "pushed", "turn"];
    let choice = Choice { reactions: true, ..by(&names) };
    let (compiled, mut outcome) = compile(HEAVY, &choice, Redundant::Refused);
    follow(&compiled, &Times::listed(0.0, vec![0.8]), &RunOptions::default(), &mut outcome);
    let outcome = outcome.expect_success();
    let (l, m, i, f, g) = (0.4, 3.0, 0.05, 7.0, 9.81);
    let (angle, rate, growth): (f64, f64, f64) = (0.3 + 1.6 + 0.96, 2.0 + 2.4, 3.0);
    let (sin, cos) = (math::sin(angle), math::cos(angle));
    // what the tip is pushed with, and what the mass asks for along x and y
    let (along, up) = (-cos * rate * rate - sin * growth, -sin * rate * rate + cos * growth);
    is(&outcome, "motor.effort", (4.0 * m * l * l + i) * growth + 2.0 * m * g * l * cos + f * sin * l * cos);
    is(&outcome, "motor.effort.by.reach", 8.0 * m * l * growth + 2.0 * m * g * cos + f * sin * cos);
    is(&outcome, "motor.effort.by.heavy", 4.0 * l * l * growth + 2.0 * g * l * cos);
    is(&outcome, "motor.effort.by.about", growth);
    is(&outcome, "motor.effort.by.pushed", sin * l * cos);
    is(&outcome, "motor.effort.by.turn", -2.0 * m * g * l * sin + f * l * (cos * cos - sin * sin));
    is(&outcome, "main.fx.by.heavy", 2.0 * l * along);
    is(&outcome, "main.fx.by.pushed", 0.0);
    is(&outcome, "main.fy.by.reach", 2.0 * m * up);
    is(&outcome, "main.fy.by.pushed", sin);
    // measures of forces, also those that are differentiated already
    is(&outcome, "torque.by.heavy", value(&outcome, "motor.effort.by.heavy"));
    is(&outcome, "by_mass", value(&outcome, "motor.effort.by.heavy"));
    is(&outcome, "by_mass.by.reach", 8.0 * l * growth + 2.0 * g * cos);
    is(&outcome, "by_mass.by.heavy", 0.0);
    is(&outcome, "twice", 2.0 * along);
    is(&outcome, "squared", 8.0 * m * growth);
    // every column but time has one for each name, those of what is differentiated twice but for
    let named = |column: &&String| column.contains(".by.");
    let (derivatives, plain): (Vec<&String>, Vec<&String>) = outcome.columns.iter().partition(named);
    let open = ["t", "twice", "squared"];
    let wanted = plain.iter().filter(|column| !open.contains(&column.as_str())).count();
    assert_eq!(derivatives.len(), wanted * names.len());
    let of_forces: Vec<&str> =
        derivatives.iter().map(|column| column.as_str()).filter(|column| column.contains("main.f")).collect();
    assert_eq!(of_forces[..2], ["main.fx.by.reach", "main.fy.by.reach"]);
}

#[test]
fn results_hold_derivatives_of_forces() {
    let (compiled, outcome) = compile(HEAVY, &Choice::default(), Redundant::Refused);
    assert!(!outcome.diagnostics.has_errors());
    let times = compiled.times().expect("an analysis");
    let (run, messages) = compiled.run(&times, &RunOptions::default());
    let mut run = run.unwrap_or_else(|| panic!("{messages:?}"));
    while run.next_row().is_some() {}
    let found = run.results().expect("results").values;
    // by hand: 4 l² growth + 2 g l cos(angle), most where the angle is least
    let most = 4.0 * 0.16 * 3.0 + 2.0 * 9.81 * 0.4 * math::cos(0.3);
    assert!((found[0].expect("a number") - most).abs() < 1e-9 * most, "{found:?}");
    assert!((found[1].expect("a number") - 72.0).abs() < 1e-7, "{found:?}");
}

#[test]
fn left_out_equations_keep_force_derivatives() {
    let text = |reach: &str| {
        format!(
            "mechanism m {{
    param reach = {reach}
    param heavy = 5 kg
    ground {{ point A = (0, 0)  point B = (0.15 m, 0)  point C = (0.3 m, 0) }}
    body one at (0, 0, 60 deg) {{ point O = (0, 0)  point P = (reach, 0)  mass 1 kg at (0.05 m, 0) }}
    body two at (0.15 m, 0, 60 deg) {{ point O = (0, 0)  point P = (reach, 0)  mass 1 kg }}
    body three at (0.3 m, 0, 60 deg) {{ point O = (0, 0)  point P = (reach, 0) }}
    body bar at (0.05 m, 0.0866 m, 0) {{
        point P = (0, 0)  point M = (0.15 m, 0)  point Q = (0.3 m, 0)
        mass 2 kg at (0.1 m, 0) inertia 0.1 kg * m^2
    }}
    body arm {{ point O = (0, 0)  point P = (2 * reach, 0)  mass heavy }}
    gravity (0, -9.81 m/s^2)
    joint a1: revolute(ground.A, one.O)
    joint a2: revolute(one.P, bar.P)
    joint b1: revolute(ground.B, two.O)
    joint b2: revolute(two.P, bar.M)
    joint c1: revolute(ground.C, three.O)
    joint c2: revolute(three.P, bar.Q)
    joint d: revolute(ground.A, arm.O)
    constraint follows: angle(arm) = 2 * angle(one)
    driver motor: rotation(a1) = 60 deg + 1 rad/s * t + 2 rad/s^2 * t^2
    load push: -3 N/m * reach on y(arm.P)
    measure torque = effort(motor)
    measure by_reach = der(effort(motor), reach)
    measure by_mass = der(force_y(d), heavy)
    analysis from 0 s to 0.5 s every 0.25 s
}}"
        )
    };
    let rows = |reach: &str| rows_at(&text(reach), &["reach"], &[0.25], &RunOptions::default());
    let (here, below, above) = (rows("0.1 m"), rows("0.0999 m"), rows("0.1001 m"));
    let slope = (value(&above, "torque") - value(&below, "torque")) / 2e-4;
    assert!((value(&here, "by_reach") - slope).abs() < 1e-6, "{} and {slope}", value(&here, "by_reach"));
    is(&here, "torque.by.reach", value(&here, "by_reach"));
    is(&here, "by_mass", 9.81);
}
