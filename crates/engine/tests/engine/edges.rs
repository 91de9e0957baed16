//! Edges: where a formula goes over to another branch, both sides are evaluated at that same time.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support;

use crate::support::random::Random;
use crate::support::{Outcome, Span, compile_without_redundant, follow, run};
use mechc::{Diagnostic, RunOptions, Times};
use mechc_expr::math;

/// A block on a slide that is driven, in metres, over two seconds in steps of a tenth.
fn slide(declarations: &str, formula: &str) -> Outcome {
    let text = format!(
        "mechanism slide {{
            ground {{ axis way = (0, 0) along (1, 0) }}
            body block {{ axis way = (0, 0) along (1, 0) }}
            joint guide: translational(ground.way, block.way)
            {declarations}
            driver push: displacement(guide) = {formula}
            analysis from 0 s to 2 s every 0.1 s
        }}"
    );
    run("slide", &text, Span::default())
}

/// The only diagnostic, of the given code.
fn only<'o>(outcome: &'o Outcome, code: &str) -> &'o Diagnostic {
    assert_eq!(outcome.codes(), [code], "{}", outcome.text());
    outcome.diagnostics.iter().next().expect("one")
}

fn time_of(diagnostic: &Diagnostic) -> f64 {
    diagnostic.data.get("t").and_then(serde_json::Value::as_f64).expect("a time")
}

fn at(outcome: &Outcome, column: &str, t: f64) -> f64 {
    let row = outcome.rows.iter().find(|row| (row[0] - t).abs() < 1e-9).expect("a row");
    row[outcome.columns.iter().position(|name| name == column).expect("a column")]
}

#[test]
fn position_jumps_are_reported_with_their_time() {
    for (formula, t) in [
        ("if t < 0.55 then 0 else 1", 0.55),
        ("if t <= 0.55 then 0 else 1", 0.55),
        ("if t > 0.55 then 0 else 1", 0.55),
        ("mod(t, 0.7)", 0.7),
        ("sign(t - 1.234)", 1.234),
        ("if sin(t) < 0.5 then 0 else 1e-6", math::asin(0.5)),
        ("if t < 1 then 0 else if t < 1.0000001 then 1e-6 else 0", 1.0),
    ] {
        let outcome = slide("", formula);
        let found = time_of(only(&outcome, "E0609"));
        assert!((found - t).abs() <= 2.0 * f64::EPSILON * t, "{formula}: {found}");
        let before = outcome.rows.last().expect("rows")[0];
        assert!(before < t && before > t - 0.1 - 1e-9, "{formula}: the rows end at {before}");
    }
}

#[test]
fn a_velocity_that_jumps_has_no_acceleration() {
    for (formula, t) in [
        ("abs(t - 0.55)", 0.55),
        ("max(0, t - 1.3)", 1.3),
        ("min(t, 2 * t^2)", 0.5),
        ("t + 1e-5 * max(0, t - 0.3)", 0.3),
        ("abs(sin(pi * t / 1.7))", 1.7),
    ] {
        let outcome = slide("", formula);
        let diagnostic = only(&outcome, "E0609");
        let found = time_of(diagnostic);
        assert!(diagnostic.message.contains("velocity"), "{}", diagnostic.message);
        assert!((found - t).abs() <= 2.0 * f64::EPSILON * t, "{formula}: {found}");
    }
}

#[test]
fn an_acceleration_that_jumps_is_a_warning_once() {
    let outcome = slide("", "step(mod(t, 0.5), 0.1, 0, 0.2, 1) - step(mod(t, 0.5), 0.3, 0, 0.4, 1)");
    let warning = only(&outcome, "W0601");
    assert!((time_of(warning) - 0.1).abs() < 1e-15);
    assert_eq!(warning.notes, ["columns that jump: `block.x.dd`"]);
    assert_eq!(outcome.rows.len(), 21);
}

#[test]
fn the_later_side_counts_and_at_the_last_time_the_earlier() {
    // the acceleration is 2 before 1 s, 6 up to 2 s, and 10 from there on
    for below in ["<", "<="] {
        let formula = format!(
            "if t {below} 1 then t^2 else if t {below} 2 then 1 + 2 * (t - 1) + 3 * (t - 1)^2 else 6 + 8 * (t - 2) + 5 * (t - 2)^2"
        );
        let outcome = slide("", &formula);
        only(&outcome, "W0601");
        for (t, acceleration) in [(0.0, 2.0), (0.9, 2.0), (1.0, 6.0), (1.1, 6.0), (1.9, 6.0), (2.0, 6.0)] {
            assert!((at(&outcome, "block.x.dd", t) - acceleration).abs() < 1e-12, "{formula} at {t}");
        }
    }
    // the first time is an edge too
    let outcome = slide("", "if t <= 0 then t else t + 3 * t^2");
    assert_eq!(at(&outcome, "block.x.dd", 0.0), 6.0);
    let outcome = slide("", "abs(t)^3 + abs(t) * t");
    assert_eq!(at(&outcome, "block.x.dd", 0.0), 2.0);
}

#[test]
fn a_pulse_between_output_times_is_met() {
    // a millionth of a second wide, in a run of two seconds
    let pulse = "step5(t, 1.2345, 0, 1.2345005, 1) - step5(t, 1.2345005, 0, 1.234501, 1)";
    let outcome = slide("", pulse);
    assert!(outcome.succeeded() && outcome.diagnostics.is_empty(), "{}", outcome.text());
    let outcome = slide("", "if t > 1.2345 and t < 1.2345001 then 1e-3 else 0");
    assert!((time_of(only(&outcome, "E0609")) - 1.2345).abs() < 1e-15);
    // a guard that dips twice within one step
    let outcome = slide("", "if sin(200 * t) > 0.9999 and t > 1 then 1e-3 else 0");
    let peak = (std::f64::consts::FRAC_PI_2 - math::acos(0.9999) + 32.0 * std::f64::consts::TAU) / 200.0;
    assert!((time_of(only(&outcome, "E0609")) - peak).abs() < 1e-14, "{}", outcome.text());
}

#[test]
fn single_times_are_no_edges() {
    let outcome = slide("", "if t == 1 then 5 else t").expect_success();
    assert!(outcome.diagnostics.is_empty());
    assert_eq!(at(&outcome, "block.x", 1.0), 1.0);
    let outcome = slide("", "t + 0.1 * sign(sin(t)^2 + 1e-3)").expect_success();
    assert!(outcome.diagnostics.is_empty());
}

#[test]
fn measures_take_the_current_branch() {
    let outcome = slide("measure late = if t <= 1 then 1 else 2 measure saw = mod(displacement(guide), 0.3)", "t");
    assert!(outcome.diagnostics.is_empty(), "{}", outcome.text());
    assert_eq!([at(&outcome, "late", 1.0), at(&outcome, "late", 1.1)], [1.0, 2.0]);
    assert!((at(&outcome, "saw", 0.5) - 0.2).abs() < 1e-15);
    assert!((at(&outcome, "saw.d", 0.5) - 1.0).abs() < 1e-15);
}

#[test]
fn an_edge_may_depend_on_the_motion() {
    // x' jumps where x reaches 0.5: sin(2 t) = 0.5
    let text = |beyond: &str| {
        format!(
            "mechanism pin {{
                body a {{ point P = (0, 0) }}
                driver x: x(a.P) = sin(2 * t)
                constraint y: y(a.P) = if x(a.P) < 0.5 then 0 else {beyond}
                constraint p: angle(a) = 0
                analysis from 0 s to 1 s every 50 ms
            }}"
        )
    };
    let t = math::asin(0.5) / 2.0;
    for (beyond, code, says) in [
        ("x(a.P)", "E0609", "constraint `y` jumps"),
        ("x(a.P) - 0.5", "E0609", "the velocity of constraint `y` jumps"),
        ("(x(a.P) - 0.5)^2", "W0601", "the acceleration of constraint `y` jumps"),
    ] {
        let outcome = run("pin", &text(beyond), Span::default());
        let diagnostic = only(&outcome, code);
        assert!(diagnostic.message.contains(says), "{}", diagnostic.message);
        assert!((time_of(diagnostic) - t).abs() < 1e-15, "{beyond}: {}", time_of(diagnostic));
    }
    let outcome = run("pin", &text("(x(a.P) - 0.5)^3"), Span::default()).expect_success();
    assert!(outcome.diagnostics.is_empty());
    for t in [0.25, 0.3, 0.8, 1.0] {
        let x = math::sin(2.0 * t);
        let y = if x < 0.5 { 0.0 } else { (x - 0.5) * (x - 0.5) * (x - 0.5) };
        assert!((at(&outcome, "a.y", t) - y).abs() < 1e-14, "at {t}");
    }
}

#[test]
fn output_times_do_not_move_edges() {
    let formula = "0.2 * step(mod(t, 0.7), 0.1, 0, 0.3, 1) + abs(sin(3 * t))^3 + table_of(t)";
    let table = "table table_of = spline [(0, 0), (0.35, 0.1), (0.9, -0.2), (1.1, 0.3), (2, 0)]";
    let fine = slide(table, formula);
    let text = |every: &str| {
        format!(
            "mechanism slide {{
                ground {{ axis way = (0, 0) along (1, 0) }}
                body block {{ axis way = (0, 0) along (1, 0) }}
                joint guide: translational(ground.way, block.way)
                {table}
                driver push: displacement(guide) = {formula}
                analysis from 0 s to 2 s every {every}
            }}"
        )
    };
    for every in ["0.5 s", "1 s", "0.01 s", "2 s"] {
        let other = run("slide", &text(every), Span::default());
        for row in &other.rows {
            let Some(same) = fine.rows.iter().find(|fine| (fine[0] - row[0]).abs() < 1e-12) else {
                continue;
            };
            for (a, b) in row.iter().zip(same) {
                assert!((a - b).abs() < 1e-11 * (1.0 + b.abs()), "every {every} at {}: {a} and {b}", row[0]);
            }
        }
    }
}

#[test]
fn edges_are_zeros_of_their_guards() {
    // guards whose last digits go back and forth around their zero
    for (formula, t) in [
        ("harmonic(5.49 * t - t, 0.96, 0, 1.96, 1)", 0.96 / 4.49),
        ("step(2.63 * t - 0.97 * t - 1.68, 0, 0, 100, 1)", 1.68 / 1.66),
        ("if 2.46 * t > 1.18 * t + 1.29 then t^2 else t^2 + (t - 1.29 / 1.28)^2 / 10", 1.29 / 1.28),
    ] {
        let outcome = slide("", formula);
        let found = time_of(only(&outcome, "W0601"));
        assert!((found - t).abs() < 1e-15, "{formula}: {found} instead of {t}");
    }
    let outcome = slide("", "max(5.16 * t, 3.48 * t + 0.1)");
    let diagnostic = only(&outcome, "E0609");
    assert!(diagnostic.message.contains("velocity"), "{}", diagnostic.message);
    assert!((time_of(diagnostic) - 0.1 / 1.68).abs() < 1e-15);
}

#[test]
fn edges_are_zeros_of_random_guards() {
    let mut numbers = Random::new(7);
    let mut random = || numbers.part();
    for _ in 0..60 {
        let (a, b, p, c) = (2.0 + 9.0 * random(), 2.0 + 9.0 * random(), 6.0 * random(), 0.8 * random() - 0.4);
        let guard = |t: f64| 0.3 * math::sin(a * t) + 0.2 * math::cos(b * t + p) - c;
        let formula = format!("if 0.3 * sin({a} * t) + 0.2 * cos({b} * t + {p}) > {c} then 1 else 0");
        // the first change of sign, by steps that are fine for these frequencies
        let root = (0..20_000).map(|k| f64::from(k) * 1e-4).find(|&t| (guard(t) > 0.0) != (guard(t + 1e-4) > 0.0));
        let outcome = slide("", &formula);
        match root {
            None => assert!(outcome.diagnostics.is_empty(), "{formula}: {}", outcome.text()),
            Some(t) => {
                let found = time_of(only(&outcome, "E0609"));
                assert!(found >= t - 1e-12 && found <= t + 1e-4 + 1e-12, "{formula}: {found}, not just behind {t}");
                assert!(guard(found).abs() < 1e-14, "{formula}: {} at {found}", guard(found));
            }
        }
    }
}

#[test]
fn an_edge_at_the_start_belongs_to_the_start() {
    for formula in
        ["if t^2 > 0 then t else 0", "min(0.87, 0.87 + t)", "if 1 + t > 1 then t else 0", "if exp(t) > 1 then t else 0"]
    {
        let outcome = slide("", formula);
        assert!(outcome.diagnostics.is_empty(), "{formula}: {}", outcome.text());
    }
    let outcome = slide("", "max(2 * t^2, t^2)");
    assert!(outcome.diagnostics.is_empty(), "{}", outcome.text());
    assert_eq!(at(&outcome, "block.x.dd", 0.0), 4.0);
}

#[test]
fn branches_that_agree_are_no_edges() {
    for formula in ["max(sin(2 * t), 2 * sin(t) * cos(t))", "abs(sin(t)^2 + cos(t)^2 - 1) + t"] {
        let outcome = slide("", formula);
        assert!(outcome.succeeded(), "{formula}: {}", outcome.text());
    }
}

#[test]
fn smooth_formulas_get_no_warning() {
    for formula in [
        "step7(t, 1.1, 0.47, 1.101, 0.48)",
        "step5(t, 1.1, 0, 1.1001, 0.01)",
        "cycloidal(t, 1.1, 0, 1.1001, 0.01)",
        "step7(t, 0.762, -0.24, 1.132, 0.4)",
        "step5(mod(t, 0.01), 0.002, 0, 0.005, 1e-3) - step5(mod(t, 0.01), 0.006, 0, 0.009, 1e-3)",
    ] {
        let outcome = slide("", formula);
        assert!(outcome.diagnostics.is_empty(), "{formula}: {}", outcome.text());
    }
}

#[test]
fn an_edge_of_the_motion_within_a_step_is_met() {
    let text = |every: &str| {
        format!(
            "mechanism crank {{
                ground {{ point O = (0, 0) }}
                body a {{ point O = (0, 0) }}
                body b {{ point O = (0, 0) }}
                joint main: revolute(ground.O, a.O)
                driver motor: rotation(main) = 60 rpm * t
                driver x: x(b.O) = if (mod(angle(a), 2 * pi) - 1.2)^2 < 0.0004 then 10 mm else 12 mm
                constraint y: y(b.O) = 0
                constraint p: angle(b) = 0
                analysis from 0 s to 10 s every {every}
            }}"
        )
    };
    for every in ["1 s", "1 ms"] {
        let outcome = run("crank", &text(every), Span::default());
        let found = time_of(only(&outcome, "E0609"));
        assert!((found - 1.18 / std::f64::consts::TAU).abs() < 1e-12, "every {every}: {found}");
    }
}

#[test]
fn a_table_that_is_left_between_output_times() {
    let table = "table way = spline [(0, 0), (1, 1), (2, 4)]";
    let outcome = slide(table, "way(1 + 1.0001 * sin(10 * t))");
    let found = time_of(only(&outcome, "E0608"));
    // sin reaches 1/1.0001
    assert!((found - math::asin(1.0 / 1.0001) / 10.0).abs() < 1e-9, "{found}");
}

#[test]
fn a_guard_may_hold_time_and_motion() {
    let outcome = slide("", "1 * t - max(0, displacement(guide) - 2 * t + 0.4)^3 * 0.01");
    assert!(outcome.succeeded(), "{}", outcome.text());
}

#[test]
fn a_long_way_in_a_straight_line_takes_few_steps() {
    for formula in ["1e5 * t", "1e6 * t^2"] {
        assert!(slide("", formula).diagnostics.is_empty(), "{formula}");
    }
}

/// At a switch the later side counts, but at the end of the analysis, whichever times are asked for.
#[test]
fn a_row_at_a_switch_does_not_depend_on_the_other_times() {
    let text = "mechanism q {
        ground { point O = (0, 0) }
        body b { point O = (0, 0) }
        joint J: revolute(ground.O, b.O)
        driver D: rotation(J) = if t <= 0.5 then t else t + 5 * (t - 0.5)^2
        analysis from 0 s to 1 s every 0.25 s
    }";
    let (compiled, outcome) = support::compile("text", text);
    let compiled = compiled.unwrap_or_else(|| panic!("{}", outcome.text()));
    for (at, to, wanted) in [
        (vec![0.5], None, 10.0),
        (vec![0.5, 0.6], None, 10.0),
        (Vec::new(), None, 10.0),
        (vec![0.5], Some(0.5), 0.0),
        (vec![0.5], Some(3.0), 10.0),
    ] {
        let requested = mechc::RequestedTimes { at, to, ..mechc::RequestedTimes::default() };
        let times = requested.over(compiled.analysis()).and_then(|times| times.times()).expect("times");
        let (run, _) = compiled.run(&times, &mechc::RunOptions::default());
        let rows: Vec<Vec<f64>> = run.expect("it runs").map(|row| row.expect("a row")).collect();
        let row = rows.iter().find(|row| row[0] == 0.5).expect("a row");
        assert_eq!(row[9], wanted, "{requested:?}");
    }
}

#[test]
fn dwells_that_end_at_output_times_are_followed() {
    let text = include_str!("conjugate_cams.mech");
    for (rpm, count, every) in [
        ("-60", 320_u32, 0.005),
        ("-60", 12_u32, 0.1),
        ("60", 32_u32, 0.05),
        ("-120", 40_u32, 0.025),
        ("-75", 8_u32, 0.2),
    ] {
        let text = text.replace("-60 rpm", &format!("{rpm} rpm"));
        let to = f64::from(count) * every;
        // the span decides where steps end
        for span in [to, 30.0] {
            let (compiled, mut outcome) = compile_without_redundant("cams", &text);
            let mut times: Vec<f64> = (0..=count).map(|k| f64::from(k) * every).collect();
            times.push(span);
            times.truncate(if span > to { times.len() } else { count as usize + 1 });
            let times = Times::listed(0.0, times);
            assert!(follow(&compiled.expect("determined"), &times, &RunOptions::default(), &mut outcome));
            assert!(outcome.stop().is_none(), "{rpm} rpm by {every} s: {}", outcome.text());
        }
    }
}
