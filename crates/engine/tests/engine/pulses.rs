//! A pulse of a driver that is far shorter than a step, between output times: what it does to the mechanism is met there.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::{Span, run};
use mechc_expr::math;

/// Output steps, coarse and fine (s).
const STEPS: [f64; 4] = [10.0, 1.0, 0.1, 0.013];
/// The pulse's middle and width (s).
const MIDDLE: f64 = 5.05;
const WIDTH: f64 = 5e-4;

/// Returns the time (s) at which a pulse of height 1 first reaches `height`.
fn reaches(height: f64) -> f64 {
    MIDDLE - WIDTH * (-math::ln(height)).sqrt()
}

/// An arm of 0.8 m on a pivot, whose driver has a pulse of height 1 called `pulse(t)`.
fn arm(driver: &str) -> String {
    format!(
        "mechanism arm {{
            fn pulse(u) = exp(-((u - {MIDDLE} s) / {WIDTH} s)^2)
            ground {{ point A = (0, 0) point far = (0.5 m, 0) }}
            body arm at (0, 0, 50 deg) {{ point A = (0, 0) point tip = (0.8 m, 0) }}
            joint pivot: revolute(ground.A, arm.A)
            driver motor: {driver}
            analysis from 0 s to 10 s every 1 s
        }}"
    )
}

fn expect_stop(text: &str, code: &str, at: f64) {
    for every in STEPS {
        let outcome = run("pulse", text, Span { every: Some(every), to: None });
        assert_eq!(outcome.codes(), [code], "every {every}: {}", outcome.text());
        let found = outcome.diagnostics.iter().next().and_then(|d| d.data["t"].as_f64()).expect("a time");
        assert!((found - at).abs() < 1e-9, "every {every}: {found} instead of {at}");
        assert!(outcome.rows.iter().all(|row| row[0] < at), "every {every}: a row beyond {at}");
    }
}

#[test]
fn short_excursions_beyond_reach_lock_up() {
    expect_stop(&arm("x(arm.tip) = 0.5 m + 0.5 m * pulse(t)"), "E0602", reaches(0.6));
}

#[test]
fn a_cylinder_that_is_too_short_for_a_moment_locks_up() {
    expect_stop(&arm("distance(arm.tip, ground.far) = 0.9 m - 0.75 m * pulse(t)"), "E0602", reaches(0.6 / 0.75));
}

#[test]
fn a_formula_without_a_value_for_a_moment_is_reported() {
    expect_stop(&arm("rotation(pivot) = asin(0.5 + 0.6 * pulse(t))"), "E0605", reaches(0.5 / 0.6));
}

#[test]
fn short_passes_of_a_change_point_are_reported() {
    let text = format!(
        "mechanism parallelogram {{
            ground {{ point A = (0, 0) point B = (2 m, 0) }}
            body crank at (0, 0, 150 deg) {{ point A = (0, 0) point C = (1 m, 0) }}
            body coupler at (-0.87 m, 0.5 m, 0) {{ point C = (0, 0) point D = (2 m, 0) }}
            body rocker at (2 m, 0, 150 deg) {{ point B = (0, 0) point D = (1 m, 0) }}
            joint A: revolute(ground.A, crank.A)
            joint B: revolute(ground.B, rocker.B)
            joint C: revolute(crank.C, coupler.C)
            joint D: revolute(coupler.D, rocker.D)
            driver motor: rotation(A) = 150 deg + 60 deg * exp(-((t - {MIDDLE} s) / {WIDTH} s)^2)
            analysis from 0 s to 10 s every 1 s
        }}"
    );
    expect_stop(&text, "E0603", reaches(0.5));
}

#[test]
fn harmless_pulses_are_passed() {
    let text = arm("rotation(pivot) = 50 deg + 1 rad * pulse(t)");
    for every in [1.01, 0.13] {
        let rows = run("pulse", &text, Span { every: Some(every), to: None }).expect_success();
        for (t, phi) in rows.column("t").into_iter().zip(rows.column("arm.phi")) {
            let short = (t - MIDDLE) / WIDTH;
            let wanted = 50_f64.to_radians() + math::exp(-short * short);
            assert!((phi - wanted).abs() < 1e-9, "every {every} at t = {t}: {phi}");
        }
    }
}
