//! A singular position that lies strictly within a step, where no determinant changes its sign.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::{Span, compiled, passing, run};
use mechc_expr::math;
use std::f64::consts::{PI, TAU};

/// Output steps, coarse and fine (s).
const STEPS: [f64; 4] = [2.5, 0.5, 0.1, 0.01];

/// A crank of 1 m with a rod of 2 m, pushed by its slider, which turns back at `at` (s), `gap` (m) before the dead point. It
/// does so like t⁴, and the crank like t².
fn push(at: f64, gap: f64) -> String {
    format!(
        "mechanism dead_point {{
            ground {{ point O = (0, 0) axis way = O along (1, 0) }}
            body crank at (0, 0, 0.9) {{ point O = (0, 0) point pin = (1, 0) }}
            body rod at (0.6, 0.8, -0.4) {{ point pin = (0, 0) point wrist = (2, 0) }}
            body slider at (2.4, 0, 0) {{ point wrist = (0, 0) axis way = wrist along (1, 0) }}
            joint main: revolute(ground.O, crank.O)
            joint big: revolute(crank.pin, rod.pin)
            joint small: revolute(rod.wrist, slider.wrist)
            joint guide: translational(ground.way, slider.way)
            driver push: displacement(guide) = 3 - {gap} - 0.25 * (t - {at})^4
            analysis from 0 to 2.5 every 0.1
        }}"
    )
}

/// The crank's angle at a time, without cancellation near the dead point.
fn crank(t: f64, at: f64, gap: f64) -> f64 {
    let s = t - at;
    let short = gap + 0.25 * s * s * s * s;
    2.0 * math::asin((short * (4.0 - short) / (4.0 * (3.0 - short))).sqrt())
}

/// Two parallelograms with cranks of `share` m and 1.5 times that on one shaft; the driver turns a mean of all three levers,
/// so that they are one block.
fn coupled(share: f64, rate: f64) -> String {
    format!(
        "mechanism coupled {{
            ground {{ point A = (0, 0) point B = (2, 0) point F = (3, 0) }}
            body crank at (0, 0, 60 deg) {{ point A = (0, 0) point C = ({share}, 0) point G = (1.5 * {share}, 0) }}
            body first at (0.5, 0.87, 0) {{ point C = (0, 0) point D = (2, 0) }}
            body left at (2, 0, 60 deg) {{ point B = (0, 0) point D = (1, 0) }}
            body second at (0.75, 1.3, 0) {{ point G = (0, 0) point H = (3, 0) }}
            body right at (3, 0, 60 deg) {{ point F = (0, 0) point H = (1.5, 0) }}
            joint A: revolute(ground.A, crank.A)
            joint B: revolute(ground.B, left.B)
            joint C: revolute(crank.C, first.C)
            joint D: revolute(first.D, left.D)
            joint F: revolute(ground.F, right.F)
            joint G: revolute(crank.G, second.G)
            joint H: revolute(second.H, right.H)
            driver motor: 0.5 * angle(crank) + 0.3 * angle(left) + 0.2 * angle(right) = 60 deg + {rate} * t
            analysis from 0 to 2.5 every 0.1
        }}"
    )
}

fn expect_stop(text: &str, every: f64, code: &str, at: f64) {
    let outcome = run("text", text, Span { every: Some(every), to: None });
    assert_eq!(outcome.codes(), [code], "every {every}: {}", outcome.text());
    let found = outcome.diagnostics.iter().next().and_then(|d| d.data["t"].as_f64()).expect("a time");
    assert!((found - at).abs() < 1e-9, "every {every}: {found} instead of {at}");
    assert!(outcome.rows.iter().all(|row| row[0] < at), "every {every}: a row beyond {at}");
}

#[test]
fn gentle_reversals_in_dead_points_are_reported() {
    for at in [0.5, 0.7391, 1.0, 1.2, 1.2345, 1.3] {
        for every in STEPS {
            expect_stop(&push(at, 0.0), every, "E0602", at);
        }
    }
}

#[test]
fn even_dead_points_are_passed_on_request() {
    for at in [0.88, 1.12] {
        for every in [2.5, 0.5, 0.25] {
            let (outcome, passed) = passing(&push(at, 0.0), Some(every));
            assert!(passed.len() == 1 && (passed[0] - at).abs() < 1e-9, "every {every}: {passed:?}");
            for (t, phi) in outcome.column("t").into_iter().zip(outcome.column("crank.phi")) {
                assert!((phi - crank(t, at, 0.0)).abs() < 1e-9, "every {every} at t = {t}: {phi}");
            }
        }
    }
}

#[test]
fn near_even_dead_points_are_passed() {
    // the crank comes within 1e-3 of being in line, and within 1e-2
    for gap in [0.75e-6, 0.75e-4] {
        for every in STEPS {
            let at = 1.2345;
            let rows = run("text", &push(at, gap), Span { every: Some(every), to: None }).expect_success();
            for (t, phi) in rows.column("t").into_iter().zip(rows.column("crank.phi")) {
                let wanted = crank(t, at, gap);
                assert!((phi - wanted).abs() < 1e-9, "every {every} at t = {t}: {phi} instead of {wanted}");
            }
        }
    }
}

#[test]
fn coincident_change_points_of_a_block_are_reported() {
    for rate in [0.9, 1.0, 1.1, 1.234] {
        let text = coupled(1.0, rate);
        let (determined, _) = compiled("text", &text).inside();
        assert_eq!(determined.blocks().iter().filter(|block| !block.explicit).count(), 1);
        for every in STEPS {
            expect_stop(&text, every, "E0603", (PI - TAU / 6.0) / rate);
        }
    }
}

#[test]
fn coincident_change_points_are_passed_on_request() {
    for every in [2.5, 0.1, 0.01] {
        let (outcome, passed) = passing(&coupled(1.0, 1.1), Some(every));
        assert!(passed.len() == 1 && (passed[0] - (PI - TAU / 6.0) / 1.1).abs() < 1e-9, "every {every}: {passed:?}");
        for body in ["crank", "left", "right"] {
            for (t, phi) in outcome.column("t").into_iter().zip(outcome.column(&format!("{body}.phi"))) {
                assert!((phi - TAU / 6.0 - 1.1 * t).abs() < 1e-9, "every {every}, {body} at t = {t}: {phi}");
            }
        }
    }
}

#[test]
fn near_parallelograms_are_followed() {
    let rows = |every: f64| run("text", &coupled(0.999, 1.0), Span { every: Some(every), to: None }).expect_success();
    let (coarse, fine) = (rows(0.5), rows(0.01));
    for (k, row) in coarse.rows.iter().enumerate() {
        for (a, b) in row.iter().zip(&fine.rows[50 * k]) {
            assert!((a - b).abs() < 1e-8 * b.abs().max(1.0), "{a} and {b} at t = {}", row[0]);
        }
    }
}

#[test]
fn rows_near_misses_keep_their_times() {
    let (outcome, passed) = passing(&push(1.2345, 0.75e-4), Some(0.01));
    assert!(passed.is_empty(), "{passed:?}");
    for (k, (t, phi)) in outcome.column("t").into_iter().zip(outcome.column("crank.phi")).enumerate() {
        assert!((t - 0.01 * k as f64).abs() < 1e-12, "row {k} is at {t}");
        assert!((phi - crank(t, 1.2345, 0.75e-4)).abs() < 1e-9, "at t = {t}: {phi}");
    }
}
