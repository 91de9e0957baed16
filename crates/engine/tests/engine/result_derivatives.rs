//! Results over derivatives by inputs and parameters, against closed forms and against rows.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::all_rows;
use crate::support::change_points::parallelogram_of_names;
use mechc::{Answers, Cancel, Choice, Compiled, Memory, Parsed, Redundant, RunOptions, RustOptions, Times};
use mechc_expr::math::{cos, sin};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn compile(text: &str, redundant: Redundant) -> Compiled {
    let checked = Parsed::new("m.mech", text).check(&Choice::default(), &Memory::default());
    let reported: Vec<&str> = checked.diagnostics().iter().map(|message| message.message.as_str()).collect();
    assert!(checked.is_sound(), "{reported:?}");
    let (compiled, messages) = checked.compile(redundant, &Cancel::default());
    compiled.unwrap_or_else(|| panic!("{:?}", messages.iter().map(|message| &message.message).collect::<Vec<_>>()))
}

fn answers_of(compiled: &Compiled, [to, every]: [f64; 2], options: &RunOptions) -> Answers {
    let times = Times::grid(0.0, to, every).expect("a grid");
    let mut run = compiled.run(&times, options).0.expect("it assembles");
    while run.next_row().is_some_and(|row| row.is_ok()) {}
    run.results().expect("results of a grid")
}

fn answers(text: &str, grid: [f64; 2]) -> Answers {
    answers_of(&compile(text, Redundant::LeftOut), grid, &RunOptions::default())
}

#[track_caller]
fn check(text: &str, to: f64, wanted: &[(f64, f64)]) {
    let found = answers(text, [to, 0.1 * to]);
    assert_eq!(found.values.len(), wanted.len());
    for (k, (value, (wanted, tolerance))) in found.values.iter().zip(wanted).enumerate() {
        let value = value.unwrap_or_else(|| panic!("result {k}: {:?}", found.notes));
        let off = value - wanted;
        assert!(off.abs() <= *tolerance, "result {k}: {value:?} instead of {wanted:?}, off by {off:e}");
    }
}

/// An arm that a driver turns, with what is declared beside it.
fn arm(declarations: &str) -> String {
    format!(
        "mechanism m {{
    param reach = 2 m
    input turn = 0.3 + 1.5 * t
    ground {{ point O = (0, 0) }}
    body arm {{ point O = (0, 0) point tip = (reach, 0) }}
    joint main: revolute(ground.O, arm.O)
    driver motor: rotation(main) = turn
    {declarations}
}}"
    )
}

/// A crank-rocker that turns once a second.
fn four_bar(declarations: &str) -> String {
    format!(
        "mechanism m {{
    param crank_length = 30 mm
    param far = 80 mm
    input turn = 40 deg + 1 rev/s * t
    ground {{ point A = (0, 0) point D = (far, 0) }}
    body crank at (0, 0, 40 deg) {{ point A = (0, 0) point B = (crank_length, 0) }}
    body coupler at (23 mm, 19 mm, 33 deg) {{ point B = (0, 0) point C = (70 mm, 0) point P = (40 mm, 25 mm) }}
    body rocker at (80 mm, 0, 88 deg) {{ point D = (0, 0) point C = (60 mm, 0) }}
    joint main: revolute(ground.A, crank.A)
    joint pin: revolute(crank.B, coupler.B)
    joint knee: revolute(coupler.C, rocker.C)
    joint pivot: revolute(ground.D, rocker.D)
    driver motor: rotation(main) = turn
    {declarations}
}}"
    )
}

#[test]
fn reductions_match_closed_forms() {
    // x = r cos u, so x_u = −r sin u, x_r = cos u
    let text = arm(
        "measure width = x(arm.tip)
         result a = max(der(width, turn)) result b = argmax(der(width, turn)) result c = min(der(width, turn))
         result d = argmin(der(width, turn)) result e = mean(der(width, reach)) result f = rms(der(width, turn))
         result g = integral(der(width, reach)) result h = first(der(width, reach)) result i = last(der(width, turn))
         result j = at(der(width, turn), 1.25) result k = max(der(width, turn) + width) / 1 m - min(der(width, reach))",
    );
    let to = 4.0;
    let end = 0.3 + 1.5 * to;
    let integral = (sin(end) - sin(0.3)) / 1.5;
    let square = 4.0 * (0.5 * to - (sin(2.0 * end) - sin(0.6)) / 6.0);
    check(
        &text,
        to,
        &[
            (2.0, 1e-12),
            ((1.5 * PI - 0.3) / 1.5, 4e-9),
            (-2.0, 1e-12),
            ((0.5 * PI - 0.3) / 1.5, 4e-9),
            (integral / to, 1e-11),
            ((square / to).sqrt(), 1e-11),
            (integral, 1e-10),
            (cos(0.3), 1e-14),
            (-2.0 * sin(end), 1e-14),
            (-2.0 * sin(0.3 + 1.5 * 1.25), 1e-14),
            (8.0_f64.sqrt() + 1.0, 1e-11),
        ],
    );
}

#[test]
fn nested_derivatives_and_rates_are_reduced() {
    let text = arm("result a = max(der(der(x(arm.tip)), reach)) result b = argmax(der(der(x(arm.tip)), reach))
         result c = min(der(der(der(x(arm.tip)), turn))) result d = mean(der(der(der(x(arm.tip))), reach))
         result e = max(der(der(x(arm.tip), turn), reach)) result f = argmin(der(der(x(arm.tip), turn), turn))
         result g = max(der(der(der(x(arm.tip), reach))))");
    let to = 4.0;
    let end = 0.3 + 1.5 * to;
    check(
        &text,
        to,
        &[
            (1.5, 1e-11),
            ((1.5 * PI - 0.3) / 1.5, 4e-9),
            // x_u = −2 sin u, by time twice
            (-4.5, 1e-8),
            (-1.5 * (sin(end) - sin(0.3)) / to, 1e-10),
            (1.0, 1e-12),
            ((2.0 * PI - 0.3) / 1.5, 4e-9),
            (2.25, 4e-9),
        ],
    );
    // what has no derivative of its own takes many looks: over a short time. The second derivative by time of x_ur = −sin u
    let to = 0.5;
    let square = 5.0625 * (0.5 * to - (sin(0.6 + 3.0 * to) - sin(0.6)) / 6.0);
    let text = arm("result a = rms(der(der(der(der(x(arm.tip))), turn), reach))");
    check(&text, to, &[((square / to).sqrt(), 1e-9)]);
}

/// Over what each of these is, for the largest and least value, their times, and the mean.
const MEASURED: [&str; 6] = [
    "der(rotation(pivot), turn)",
    "der(x(coupler.P), crank_length)",
    "der(der(y(coupler.P)), far)",
    "der(der(angle(rocker), crank_length), turn)",
    "der(der(der(x(coupler.P), turn)), far)",
    "der(lean, far) * y(coupler.P) + 1 s * der(lean)",
];

#[test]
fn rows_stay_within_extrema_and_attain_them() {
    let mut declarations = "measure lean = rotation(pivot)\n".to_owned();
    for (k, formula) in MEASURED.iter().enumerate() {
        declarations += &format!(
            "measure m{k} = {formula} result a{k} = max(m{k}) result b{k} = argmax(m{k}) result c{k} = min(m{k})
             result d{k} = argmin(m{k}) result e{k} = mean(m{k}) result f{k} = rms(m{k})\n"
        );
    }
    let compiled = compile(&four_bar(&declarations), Redundant::Refused);
    let columns = compiled.columns();
    let first = answers_of(&compiled, [1.0, 0.1], &RunOptions::default());
    let found: Vec<f64> =
        first.values.iter().map(|value| value.unwrap_or_else(|| panic!("{:?}", first.notes))).collect();
    for every in [0.033, 1e-3, 1e-4] {
        assert_eq!(first.values, answers_of(&compiled, [1.0, every], &RunOptions::default()).values, "every {every} s");
    }
    let (rows, _) = all_rows(&compiled, &Times::grid(0.0, 1.0, 1e-3).expect("a grid"));
    for (k, formula) in MEASURED.iter().enumerate() {
        let at = columns.iter().position(|column| *column == format!("m{k}")).expect("a column");
        let values: Vec<f64> = rows.iter().map(|row| row[at]).collect();
        let [most, most_at, least, least_at, mean, rms] = [0, 1, 2, 3, 4, 5].map(|part| found[6 * k + part]);
        let range = most - least;
        assert!(values.iter().all(|value| (least - 1e-9 * range..=most + 1e-9 * range).contains(value)), "{formula}");
        for (t, wanted) in [(most_at, most), (least_at, least)] {
            let (rows, _) = all_rows(&compiled, &Times::listed(0.0, vec![t]));
            assert!((rows[0][at] - wanted).abs() <= 1e-9 * range, "{formula} at {t}: {} not {wanted}", rows[0][at]);
        }
        // over a period the sum of rows is the mean to rounding
        let sum: f64 = values[1..].iter().sum::<f64>() / 1000.0;
        let squares: f64 = values[1..].iter().map(|value| value * value).sum::<f64>() / 1000.0;
        assert!((sum - mean).abs() <= 1e-9 * range && (squares.sqrt() - rms).abs() <= 1e-9 * range, "{formula}");
    }
}

#[test]
fn constants_reduce_to_themselves() {
    let text = four_bar("result a = max(der(angle(crank), turn)) result b = min(der(angle(crank), turn)) result c = argmax(der(turn, turn))")
        .replace("far = 80 mm", "far = 70 mm").replace("60 mm", "crank_length").replace("88 deg", "40 deg").replace("33 deg", "0 deg");
    let more = "result d = max(der(angle(rocker), turn)) result e = mean(der(rotation(pivot), turn)) result f = max(der(angle(coupler), turn))\n}";
    let text = format!("{}{more}", text.strip_suffix('}').expect("an end"));
    let compiled = compile(&text, Redundant::Refused);
    // up to before it folds
    let found = answers_of(&compiled, [0.35, 0.01], &RunOptions::default());
    for (k, (value, wanted)) in found.values.iter().zip([1.0, 1.0, 0.0, 1.0, 1.0, 0.0]).enumerate() {
        let value = value.unwrap_or_else(|| panic!("result {k}: {:?}", found.notes));
        assert!((value - wanted).abs() < 1e-11, "result {k}: {value:?}");
    }
}

#[test]
fn requested_derivatives_change_no_bit_of_a_row() {
    let asking = "result a = max(der(x(coupler.P), far)) result b = mean(der(der(rotation(pivot)), turn))";
    let bits = |more: &str| {
        let text = four_bar(&format!("measure lean = rotation(pivot) measure slope = der(lean, crank_length) {more}"));
        let compiled = compile(&text, Redundant::Refused);
        let (rows, _) = all_rows(&compiled, &Times::grid(0.0, 1.0, 1e-3).expect("a grid"));
        rows.into_iter().flatten().map(f64::to_bits).collect::<Vec<u64>>()
    };
    assert!(bits("") == bits(asking));
}

#[test]
fn measures_of_parts_are_reduced_with_the_derivatives_of_the_part() {
    let text = "mechanism leg {
    param reach = 1 m
    input turn = 1 rad/s * t
    ground { point O = (0, 0) }
    body arm { point O = (0, 0) point tip = (reach, 0) }
    joint main: revolute(ground.O, arm.O)
    driver motor: rotation(main) = turn
    measure gain = der(x(arm.tip), turn)
    result most = max(gain)
    result by_reach = integral(der(y(arm.tip), reach))
}
mechanism m {
    input drive = 2 rad/s * t
    part left: leg(turn = drive) at (1 m, 2 m, 30 deg) mirrored
    part right: leg(reach = 3 m) at (5 m, 0, 0)
    result left_gain = min(left.gain)
    result right_when = argmin(right.gain)
    result whole = max(der(x(left.arm.tip), drive))
    result free = rms(der(y(right.arm.tip), right.turn))
}";
    let to = 2.0;
    let checked = Parsed::new("m.mech", text)
        .check(&Choice { mechanism: Some("m".to_owned()), ..Choice::default() }, &Memory::default());
    let compiled = checked.compile(Redundant::Refused, &Cancel::default()).0.expect("it is determined");
    let names: Vec<String> = compiled.results().into_iter().map(|(name, _)| name).collect();
    assert_eq!(
        names,
        ["left.most", "left.by_reach", "right.most", "right.by_reach", "left_gain", "right_when", "whole", "free"]
    );
    let found = answers_of(&compiled, [to, 0.1], &RunOptions::default());
    let square = 9.0 * (0.5 * to + 0.25 * sin(2.0 * to));
    let wanted = [
        // −sin 2t, from 0 to 2 s
        -sin(4.0),
        0.5 * (1.0 - cos(4.0)),
        0.0,
        1.0 - cos(2.0),
        -1.0,
        FRAC_PI_2,
        // x = 1 + cos(30° − 2t), with the slope sin(30° − 2t)
        0.5,
        (square / to).sqrt(),
    ];
    for ((name, value), wanted) in names.iter().zip(&found.values).zip(wanted) {
        let value = value.unwrap_or_else(|| panic!("{name}: {:?}", found.notes));
        assert!((value - wanted).abs() < 1e-9, "{name}: {value} instead of {wanted}");
    }
}

#[test]
fn edges_count_on_both_sides() {
    // the slope of the driver by its input jumps at 1 s
    let text = arm("fn kink(u) = if u < 1.8 then u else u + 2 * (u - 1.8)^2 + (u - 1.8)^3
         measure gain = der(der(angle(arm), turn), turn)
         result a = max(gain) result b = min(gain) result c = at(gain, 1) result d = argmin(gain) result e = argmax(gain)
         result f = integral(gain) result g = argmax(-gain)")
    .replace("= turn\n", "= kink(turn)\n");
    // 4 + 6 (u − 1.8) behind
    let last = 4.0 + 6.0 * 1.5;
    check(
        &text,
        2.0,
        &[(last, 1e-10), (0.0, 0.0), (4.0, 1e-9), (0.0, 0.0), (2.0, 1e-9), (0.5 * (4.0 + last), 1e-9), (0.0, 0.0)],
    );
}

/// Where a parallelogram folds, the derivative by its crank has a pole.
const ASKED_OF_PARALLELOGRAM: &str = "result pole = max(der(angle(rocker), crank_length))
    result mean_of_pole = mean(der(angle(rocker), crank_length))
    result before = first(der(angle(rocker), crank_length))
    result beyond = last(der(angle(rocker), crank_length))
    result place = max(y(coupler.C))";

#[test]
fn poles_leave_no_value() {
    let options = RunOptions { pass_bifurcations: true, ..RunOptions::default() };
    let compiled = compile(&parallelogram_of_names(ASKED_OF_PARALLELOGRAM), Redundant::Refused);
    let found = answers_of(&compiled, [2.0, 0.1], &options);
    assert_eq!(found.values[..2], [None, None], "{:?}", found.notes);
    assert!(found.notes.iter().all(|note| note.code.as_str() == "N0604"));
    for note in &found.notes {
        let t = note.data["t"].as_f64().expect("a time");
        assert!((t - 1.5).abs() < 2e-3, "{:?}", found.notes);
    }
    let cot = |x: f64| cos(x) / sin(x);
    let wanted = [-cot(-1.5 * FRAC_PI_2), -cot(0.5 * FRAC_PI_2), 1.0];
    for (value, wanted) in found.values[2..].iter().zip(wanted) {
        assert!((value.expect("a number") - wanted).abs() < 1e-9, "{value:?} instead of {wanted}");
    }
    // in a part it is told whose it is
    let whole = parallelogram_of_names(ASKED_OF_PARALLELOGRAM) + "mechanism whole {\n    part p: m() at (0, 0, 0)\n}\n";
    let choice = Choice { mechanism: Some("whole".to_owned()), ..Choice::default() };
    let checked = Parsed::new("m.mech", &whole).check(&choice, &Memory::default());
    let in_part = checked.compile(Redundant::Refused, &Cancel::default()).0.expect("it is determined");
    let notes = answers_of(&in_part, [2.0, 0.1], &options).notes;
    assert_eq!(notes.len(), 2);
    let used = |note: &mechc::Diagnostic| note.labels.iter().any(|label| label.text == "in part `p`, used here");
    assert!(notes.iter().all(used), "{notes:?}");
    // short of it there is one
    let short = answers_of(&compiled, [1.4, 0.1], &options);
    assert!((short.values[0].expect("a number") - cot(0.1 * FRAC_PI_2)).abs() < 1e-8, "{:?}", short.values);
}

#[test]
fn breaking_a_left_out_equation_leaves_no_value() {
    let text = parallelogram_of_names(ASKED_OF_PARALLELOGRAM)
        .replace("point B = (2 m, 0) }\n    body crank", "point B = (2 m, 0)  point E = (1 m, 0) }\n    body crank")
        .replace("point D = (2 m, 0) }", "point D = (2 m, 0)  point F = (1 m, 0) }")
        .replace("    driver", "    constraint mid: distance(ground.E, coupler.F) = 1 m\n    driver")
        .replace("    result place", "    result along = max(der(x(coupler.F), turn))\n    result place");
    let found = answers(&text, [0.9, 0.1]);
    assert_eq!(found.values[..4], [None; 4]);
    // −sin of the crank's angle, at its beginning
    assert!((found.values[4].expect("a number") + sin(TAU / 8.0)).abs() < 1e-9, "{:?}", found.values);
    assert!(found.values[5].is_some());
}

#[test]
fn single_times_have_values() {
    let found =
        answers(&arm("result a = max(der(x(arm.tip), turn)) result b = mean(der(x(arm.tip), reach))"), [0.0, 0.1]);
    assert_eq!(found.values, [Some(-2.0 * sin(0.3)), Some(cos(0.3))]);
}

#[test]
fn emitted_code_omits_result_derivatives() {
    let compiled = compile(&arm("result a = max(der(x(arm.tip), reach))"), Redundant::Refused);
    let plain = compile(&arm("result a = max(x(arm.tip))"), Redundant::Refused);
    let rust = |compiled: &Compiled| compiled.rust(&RustOptions::new("m.mech")).0;
    assert!(rust(&compiled).is_some() && rust(&compiled) == rust(&plain));
}
