//! A motion stays on the branch that its start chose.

#![allow(clippy::expect_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking, and compares exactly

mod support;

use std::f64::consts::TAU;
use std::fs;
use support::{Span, run};

fn crank_rocker(every: f64, to: f64) -> support::Outcome {
    let text = fs::read_to_string("tests/cases/four_bar.mech").expect("a text");
    run("four_bar", &text, Span { every: Some(every), to: Some(to) }).expect_success()
}

#[test]
fn a_crank_rocker_sampled_once_a_turn_counts_its_turns() {
    // its crank turns at 2 rad/s
    let turn = TAU / 2.0;
    let rows = crank_rocker(turn, 10.5 * turn);
    assert_eq!(rows.rows.len(), 11);
    let start = &rows.rows[0];
    for (k, row) in rows.rows.iter().enumerate() {
        for (at, column) in rows.columns.iter().enumerate().skip(1) {
            let turns = if column == "crank.phi" { TAU * k as f64 } else { 0.0 };
            let error = (row[at] - start[at] - turns).abs();
            assert!(error < 1e-9, "{column} after {k} turns is off by {error:e}");
        }
    }
}

#[test]
fn no_sampling_changes_the_branch() {
    let turn = TAU / 2.0;
    let fine = crank_rocker(turn / 64.0, 3.0 * turn);
    for part in [1.0, 2.0, 4.0, 8.0] {
        let coarse = crank_rocker(turn / part, 3.0 * turn);
        for (k, row) in coarse.rows.iter().enumerate() {
            let same = &fine.rows[k * (64.0 / part) as usize];
            for (a, b) in row.iter().zip(same) {
                assert!((a - b).abs() < 1e-9, "{part} rows a turn, row {k}");
            }
        }
    }
}

#[test]
fn elbow_up_and_elbow_down_are_told_apart_by_the_estimates() {
    let arm = |elbow: f64| {
        let text = format!(
            "mechanism arm {{
                ground {{ point A = (0, 0) }}
                body upper at (0, 0, {elbow} deg) {{ point A = (0, 0) point B = (1 m, 0) }}
                body lower at (1 m, 0, {} deg) {{ point B = (0, 0) point tip = (1 m, 0) }}
                joint A: revolute(ground.A, upper.A)
                joint B: revolute(upper.B, lower.B)
                driver px: x(lower.tip) = 1.2 m + 0.3 m * sin(2 rad/s * t)
                driver py: y(lower.tip) = 0.2 m * t / 1 s
                analysis from 0 s to 3 s every 0.5 s
            }}",
            -elbow
        );
        run("arm", &text, Span::default()).expect_success().column("upper.phi")
    };
    let (up, down) = (arm(50.0), arm(-50.0));
    // the elbow lies to the left of the line from the shoulder to the tip, or to its right, all the way
    assert!(up.iter().zip(&down).all(|(up, down)| up > down && up - down > 0.5));
}
