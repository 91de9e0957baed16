//! Results over windows, parts of the analysis: against closed forms.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::compiled;
use crate::support::sweeps::{bits, subject, vary};
use mechc::{Answers, Choice, Memory, RunOptions, Status, SweepOptions, Times};
use mechc_expr::math::{cos, sin};
use std::f64::consts::{FRAC_1_PI, FRAC_1_SQRT_2, PI};
use std::fmt::Write;

/// An arm of 1 m that turns once a second, with results and params beside it.
fn arm(declarations: &str) -> String {
    format!(
        "mechanism m {{
    ground {{ point O = (0, 0) }}
    body arm {{ point O = (0, 0) point tip = (1 m, 0) }}
    joint main: revolute(ground.O, arm.O)
    driver motor: rotation(main) = 1 rev/s * t
    measure x = x(arm.tip)
    measure y = y(arm.tip)
    {declarations}
    analysis from 0 s to 1 s every 0.1 s
}}"
    )
}

fn with_results(results: &[&str]) -> String {
    let mut declarations = String::new();
    for (k, formula) in results.iter().enumerate() {
        let _ = writeln!(declarations, "result r{k} = {formula}");
    }
    arm(&declarations)
}

/// The results of a text over an analysis from 0 s to 1 s with rows that are so far apart (s).
fn answers_every(text: &str, every: f64) -> Answers {
    let compiled = compiled("m", text);
    let times = Times::grid(0.0, 1.0, every).expect("a grid");
    let mut run = compiled.run(&times, &RunOptions::default()).0.expect("it assembles");
    while run.next_row().is_some_and(|row| row.is_ok()) {}
    run.results().expect("results of a grid")
}

fn answers(results: &[&str]) -> Answers {
    answers_every(&with_results(results), 0.1)
}

/// Compares results with what they are, to nine digits.
#[track_caller]
fn check(cases: &[(&str, f64)]) {
    let formulas: Vec<&str> = cases.iter().map(|(formula, _)| *formula).collect();
    let found = answers(&formulas);
    for ((formula, wanted), value) in cases.iter().zip(&found.values) {
        let value = value.unwrap_or_else(|| panic!("{formula}: {:?}", found.notes));
        let off = (value - wanted).abs();
        // the time of an extremum within the window is found less exactly
        let tolerance = if formula.starts_with("arg") { 1e-8 } else { 2e-9 };
        assert!(off <= tolerance, "{formula} is {value:?} instead of {wanted:?}, off by {off:e}");
    }
}

#[test]
fn a_window_is_a_part_of_the_analysis() {
    check(&[
        ("max(t, from 0.2 s to 0.5 s)", 0.5),
        ("min(t, from 0.2 s to 0.5 s)", 0.2),
        ("argmax(t, from 0.2 s to 0.5 s)", 0.5),
        ("argmin(t, from 0.2 s to 0.5 s)", 0.2),
        ("mean(t, from 0.2 s to 0.5 s)", 0.35),
        ("rms(t, from 0.2 s to 0.5 s)", 0.13_f64.sqrt()),
        ("integral(t, from 0.2 s to 0.5 s)", 0.105),
        ("first(t, from 0.2 s to 0.5 s)", 0.2),
        ("last(t, from 0.2 s to 0.5 s)", 0.5),
    ]);
}

#[test]
fn a_bound_that_is_not_given_is_the_end_of_the_analysis() {
    check(&[
        ("max(t, to 0.5 s)", 0.5),
        ("min(t, to 0.5 s)", 0.0),
        ("max(t, from 0.5 s)", 1.0),
        ("min(t, from 0.5 s)", 0.5),
        ("mean(t, to 0.5 s)", 0.25),
        ("integral(t, from 0.5 s)", 0.375),
        ("first(t, from 0.3 s)", 0.3),
        ("first(t, to 0.3 s)", 0.0),
        ("last(t, to 0.3 s)", 0.3),
        ("last(t, from 0.3 s)", 1.0),
        ("mean(t)", 0.5),
    ]);
}

#[test]
fn a_motion_is_looked_at_within_the_window() {
    check(&[
        ("max(y, from 0 s to 0.5 s)", 1.0),
        ("argmax(y, from 0 s to 0.5 s)", 0.25),
        ("max(y, from 0.3 s to 0.7 s)", sin(0.6 * PI)),
        ("argmax(y, from 0.3 s to 0.7 s)", 0.3),
        ("min(y, from 0.3 s to 0.7 s)", sin(1.4 * PI)),
        ("argmin(y, from 0.5 s to 1 s)", 0.75),
        ("mean(y, from 0 s to 0.5 s)", 2.0 * FRAC_1_PI),
        ("integral(y, from 0 s to 0.5 s)", FRAC_1_PI),
        ("rms(y, to 0.25 s)", FRAC_1_SQRT_2),
        ("first(y, from 0.05 s)", sin(0.1 * PI)),
        ("last(y, to 0.123 s)", sin(0.246 * PI)),
        // between two rows
        ("max(y, from 0.123 s to 0.1234 s)", sin(0.2468 * PI)),
        ("mean(y, from 0.123 s to 0.1234 s)", (cos(0.246 * PI) - cos(0.2468 * PI)) / (0.0008 * PI)),
        // and over all of it
        ("max(y, from 0 s to 1 s) - max(y)", 0.0),
        ("rms(y, from 0 s to 1 s) - rms(y)", 0.0),
    ]);
}

#[test]
fn edges_within_a_window_count() {
    check(&[
        ("mean(if t < 0.4 s then 1 else 3, from 0.3 s to 0.5 s)", 2.0),
        ("integral(if t < 0.4 s then 1 else 3, from 0.3 s to 0.6 s)", 0.7),
        ("max(if t < 0.4 s then 1 else 3, from 0.1 s to 0.3 s)", 1.0),
        ("min(if t < 0.4 s then 1 else 3, from 0.5 s to 0.7 s)", 3.0),
        ("min(abs(t - 0.4 s), from 0.1 s to 0.45 s)", 0.0),
        ("argmin(abs(t - 0.4 s), from 0.1 s to 0.45 s)", 0.4),
        ("max(abs(t - 0.4 s), from 0.1 s to 0.45 s)", 0.3),
    ]);
}

#[test]
fn windows_may_be_single_times() {
    let at = sin(0.2 * PI);
    check(&[
        ("mean(y, from 0.1 s to 0.1 s)", at),
        ("rms(y, from 0.1 s to 0.1 s)", at),
        ("integral(y, from 0.1 s to 0.1 s)", 0.0),
        ("max(y, from 0.1 s to 0.1 s)", at),
        ("argmin(y, from 0.1 s to 0.1 s)", 0.1),
        ("first(y, from 0.1 s to 0.1 s)", at),
    ]);
}

#[test]
fn windows_depend_on_other_results() {
    check(&[
        ("argmin(x)", 0.5),
        ("min(y, from r0 to 0.6 s)", sin(1.2 * PI)),
        ("max(y, from argmin(x) to 0.6 s)", 0.0),
        ("integral(y, to argmin(x))", FRAC_1_PI),
        ("last(y, to argmax(y))", 1.0),
        ("argmax(y, from argmax(y, to 0.2 s) + 0.3 s)", 0.5),
        ("mean(x - mean(x, to argmax(y)), to argmax(y))", 0.0),
    ]);
}

#[test]
fn the_time_of_a_value_is_that_of_another_result() {
    check(&[("at(x, argmin(y))", 0.0), ("at(y, r2 / 2)", 1.0), ("argmin(x)", 0.5)]);
}

#[test]
fn outside_times_leave_no_value() {
    let found = answers(&["at(x, argmin(y) + 1 s)", "at(x, argmin(y))"]);
    assert!(found.values[0].is_none() && found.values[1].is_some(), "{found:?}");
    assert_eq!(found.notes.len(), 1, "{found:?}");
}

#[test]
fn outside_windows_have_no_value() {
    let formulas = [
        "max(y, from argmax(y) + 2 s)",
        "mean(y, to argmax(y) - 2 s)",
        "max(y, from argmin(y) to argmax(y))",
        "first(y, from argmin(y) + 1 s)",
        "max(y, from argmax(y) to argmin(y))",
    ];
    let found = answers(&formulas);
    let has_value: Vec<bool> = found.values.iter().map(Option::is_some).collect();
    assert_eq!(has_value, [false, false, false, false, true], "{found:?}");
    assert_eq!(found.notes.len(), 4, "{found:?}");
}

#[test]
fn windows_do_not_depend_on_the_output_step() {
    let formulas = ["max(y, from 0.123 s to 0.3 s)", "rms(x, from 0.04 s)", "argmin(x * y, to 0.777 s)"];
    let text = with_results(&formulas);
    let [coarse, fine] = [0.25, 0.01].map(|every| answers_every(&text, every).values);
    assert!(coarse.iter().all(Option::is_some) && coarse == fine, "{coarse:?} {fine:?}");
}

/// What variants of a sweep have is what they have alone, to the bit; where a window ends before it begins, that is an error.
#[test]
fn sweeps_match_single_runs() {
    let declarations = "param late = 0.5 s
    result most = max(y, from 0.3 s to late)
    result level = mean(x, from argmin(y, to late) / 2 to late)
    result when = argmax(x * y, from late)";
    let subject = subject(&arm(declarations), Choice::default());
    let variants = subject.variants(&vary(&["late=0.25s..1s:16"]));
    let block = subject.sweep(&variants, &SweepOptions::default());
    let mut complete = 0;
    for k in 0..block.len() {
        let (status, results, _) = subject.run_single(variants.settings(k as u64));
        let swept: Vec<f64> = block.results.iter().map(|column| column[k]).collect();
        assert_eq!(block.statuses[k], status);
        assert_eq!(bits(&swept), bits(&results), "{swept:?} instead of {results:?}");
        complete += usize::from(status == Status::Ok);
    }
    assert_eq!((block.len(), complete), (16, 15));
}

/// The derivatives of results by a param `p`, or nothing where they have none that is known.
#[track_caller]
fn by_p(p: f64, cases: &[(&str, Option<f64>)]) {
    let mut declarations = format!("param p = {p}\n");
    for (k, (formula, _)) in cases.iter().enumerate() {
        let _ = writeln!(declarations, "result r{k} = {formula}");
    }
    let subject = subject(&arm(&declarations), Choice::default());
    let (requested, world) = (["p=0.01".to_owned()], Memory::default());
    let of = subject.checked.tolerancing(&requested, &subject.choice, &world);
    let of = of.unwrap_or_else(|why| panic!("{why}"));
    let affected = of.sensitivities(&subject.compiled, &SweepOptions::default());
    let affected = affected.unwrap_or_else(|why| panic!("{why}"));
    let of_results = affected.iter().filter(|of| of.at.is_none());
    for (of, (formula, wanted)) in of_results.zip(cases) {
        match (of.slopes[0], wanted) {
            (None, None) => {}
            (Some(found), Some(wanted)) => {
                assert!((found - wanted).abs() <= 1e-6, "{formula}: {found} instead of {wanted}");
            }
            (found, wanted) => panic!("{formula}: {found:?} instead of {wanted:?}"),
        }
    }
}

#[test]
fn fixed_windows_are_differentiated() {
    by_p(
        0.4,
        &[
            ("integral(p * t, from 0.2 to 0.5)", Some(0.105)),
            ("mean(p * t, from 0.2 to 0.5)", Some(0.35)),
            ("rms(p * t, from 0.2 to 0.5)", Some(0.13_f64.sqrt())),
            ("max(p * t, from 0.2 to 0.6)", Some(0.6)),
            ("max(p * sin(pi * t), from 0.2 to 0.9)", Some(1.0)),
            ("argmax(p * sin(pi * t), from 0.2 to 0.9)", Some(0.0)),
            ("argmax(-(t - p)^2, from 0.2 to 0.9)", Some(1.0)),
            ("first(p * t, from 0.3)", Some(0.3)),
            ("last(p * t, to 0.7)", Some(0.7)),
            // the peak that goes with p is not in the window
            ("max(if t < 0.5 then p * sin(tau * t) else 0.4 * (1 - t), from 0.6)", Some(0.0)),
            // two peaks that are alike are one in the window
            ("max(if t < 0.5 then p * sin(tau * t)^2 else 0.4 * sin(tau * t)^2, to 0.45)", Some(1.0)),
            ("max(if t < 0.5 then p * sin(tau * t)^2 else 0.4 * sin(tau * t)^2)", None),
        ],
    );
}

#[test]
fn moving_bounds_are_differentiated() {
    by_p(
        0.4,
        &[
            ("integral(t, from 0.2 to p)", Some(0.4)),
            ("integral(t, from p to 0.9)", Some(-0.4)),
            ("integral(p * t, from p)", Some(0.42 - 0.16)),
            ("mean(t, from p)", Some(0.5)),
            ("rms(t, to p)", Some(1.0 / 3.0_f64.sqrt())),
            ("first(t * t, from p)", Some(0.8)),
            ("last(t, to 2 * p)", Some(2.0)),
            ("max(t * t, to p)", Some(0.8)),
            ("argmax(t, to p)", Some(1.0)),
            ("min(t, to p)", Some(0.0)),
            ("max(sin(pi * t), to p + 0.5)", Some(0.0)),
            // through another result
            ("integral(t, to argmax(-(t - p)^2))", Some(0.4)),
            // at an edge that stays there is another derivative to either side
            ("integral(if t < 0.4 then 0 else 1, from p)", None),
            ("integral(abs(t - 0.4), from p)", Some(0.0)),
            ("last(abs(t - 0.4), to p)", None),
        ],
    );
}

#[test]
fn the_time_of_a_value_is_differentiated() {
    by_p(
        0.4,
        &[
            ("at(t * t, p)", Some(0.8)),
            ("at(t * t, argmax(-(t - p)^2))", Some(0.8)),
            ("at(p * t, argmax(-(t - 0.3)^2))", Some(0.3)),
            ("at(abs(t - 0.4), p)", None),
            ("at(abs(t - 0.3), p)", Some(1.0)),
        ],
    );
}
