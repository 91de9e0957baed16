//! A motion stays on the branch that its start chose.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support;

use crate::support::random::Random;
use crate::support::{Outcome, Span, run};
use mechc::{RunOptions, Times};
use mechc_expr::math;
use std::f64::consts::TAU;

fn crank_rocker(every: f64, to: f64) -> support::Outcome {
    let text = support::text_of("tests/cases/four_bar.mech");
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
    for part in [1_u8, 2, 4, 8] {
        let coarse = crank_rocker(turn / f64::from(part), 3.0 * turn);
        for (k, row) in coarse.rows.iter().enumerate() {
            let same = &fine.rows[k * (64 / usize::from(part))];
            for (a, b) in row.iter().zip(same) {
                assert!((a - b).abs() < 1e-9, "{part} rows a turn, row {k}");
            }
        }
    }
}

#[test]
fn estimates_select_the_elbow_branch() {
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

/// A slider-crank of crank 1 m with a rod of some length, turned at 1 rad/s from 0.3 rad.
fn slider_crank(rod: f64, every: f64) -> support::Outcome {
    let text = format!(
        "mechanism slider_crank {{
            ground {{ point O = (0, 0) axis way = O along (1, 0) }}
            body crank at (0, 0, 0.3) {{ point O = (0, 0) point pin = (1, 0) }}
            body rod at (0.95, 0.3, -0.3) {{ point pin = (0, 0) point wrist = ({rod}, 0) }}
            body slider at (1.9, 0, 0) {{ point wrist = (0, 0) axis way = wrist along (1, 0) }}
            joint main: revolute(ground.O, crank.O)
            joint big: revolute(crank.pin, rod.pin)
            joint small: revolute(rod.wrist, slider.wrist)
            joint guide: translational(ground.way, slider.way)
            driver motor: rotation(main) = t + 0.3
            analysis from 0 to 3 every {every}
        }}"
    );
    run("slider_crank", &text, Span::default())
}

#[test]
fn near_dead_points_are_passed_at_any_output_step() {
    let rod = 1.000_001;
    for every in [0.1, 0.01, 0.001] {
        let rows = slider_crank(rod, every).expect_success();
        for (t, x) in rows.column("t").iter().zip(rows.column("slider.x")) {
            let phi = t + 0.3;
            let wanted = mechc_expr::math::cos(phi)
                + (rod * rod - mechc_expr::math::sin(phi) * mechc_expr::math::sin(phi)).sqrt();
            assert!((x - wanted).abs() < 1e-9, "every {every} at t = {t}: {x} instead of {wanted}");
        }
    }
}

#[test]
fn dead_points_are_found_at_any_output_step() {
    // the rod is in line with the guide's normal at sin φ = 0.8
    let dead_point = mechc_expr::math::asin(0.8) - 0.3;
    for every in [3.0, 0.1, 0.001] {
        let outcome = slider_crank(0.8, every);
        assert_eq!(outcome.codes(), ["E0602"], "{}", outcome.text());
        let found = outcome.diagnostics.iter().next().and_then(|d| d.data["t"].as_f64()).expect("a time");
        assert!((found - dead_point).abs() < 1e-9, "every {every}: {found}");
    }
}

#[test]
fn driven_coordinates_may_start_far_from_estimates() {
    let text = support::text_of("tests/cases/slider_crank.mech");
    let late = text.replace("from 0 s to 1 s", "from 100000 s to 100001 s");
    let early = run("slider_crank", &text, Span::default()).expect_success();
    let late = run("slider_crank", &late, Span::default()).expect_success();
    for (a, b) in early.column("slider.x").iter().zip(late.column("slider.x")) {
        // the angle has 6e5 rad there
        assert!((a - b).abs() < 1e-9, "{a} and {b}");
    }
}

#[test]
fn drivers_in_step_with_the_output_are_resolved() {
    // it swings into the dead point and back between any two of these times
    let text = support::text_of("tests/ui/run/four_bar_into_lock_up.mech");
    let text = text.replace("60 deg + 90 deg/s * t", "60 deg + 60 deg * sin(360 deg * t / 1 s)^4");
    for every in [0.5, 1.0, 0.1] {
        let outcome = run("four_bar", &text, Span { every: Some(every), to: Some(4.0) });
        assert_eq!(outcome.codes(), ["E0602"], "every {every}: {}", outcome.text());
    }
}

/// A parallelogram whose crank turns all the way round, with the rows of a run that goes on beyond bifurcations.
fn passing(analysis: &str) -> (Vec<String>, Vec<Vec<f64>>, Vec<f64>) {
    let text = format!(
        "mechanism parallelogram {{
            ground {{ point A = (0, 0) point B = (2 m, 0) }}
            body crank   at (0, 0, 60 deg)     {{ point A = (0, 0) point C = (1 m, 0) }}
            body coupler at (0.5 m, 0.87 m, 0) {{ point C = (0, 0) point D = (2 m, 0) }}
            body rocker  at (2 m, 0, 60 deg)   {{ point B = (0, 0) point D = (1 m, 0) }}
            joint A: revolute(ground.A, crank.A)
            joint C: revolute(crank.C, coupler.C)
            joint D: revolute(coupler.D, rocker.D)
            joint B: revolute(ground.B, rocker.B)
            driver motor: rotation(A) = 60 deg + 90 deg/s * t + 10 deg * sin(2 rad/s * t)
            {analysis}
        }}"
    );
    let (outcome, passed) = support::passing(&text, None);
    (outcome.columns, outcome.rows, passed)
}

#[test]
fn parallelograms_pass_change_points() {
    for analysis in ["analysis from 0 s to 20 s every 10 ms", "analysis from 0 s to 20 s every 1 s"] {
        let (columns, rows, passed) = passing(analysis);
        let at = |name: &str| columns.iter().position(|column| column == name).expect("a column");
        for row in &rows {
            for end in ["", ".d", ".dd"] {
                let (crank, rocker) = (row[at(&format!("crank.phi{end}"))], row[at(&format!("rocker.phi{end}"))]);
                assert!((crank - rocker).abs() < 1e-9, "rocker.phi{end} at t = {}: {crank} and {rocker}", row[0]);
                assert!(row[at(&format!("coupler.phi{end}"))].abs() < 1e-9, "coupler.phi{end} at t = {}", row[0]);
            }
        }
        // the crank is in line with the ground at every half turn
        let crank = |t: f64| 60.0 + 90.0 * t + 10.0 * mechc_expr::math::sin(2.0 * t);
        assert_eq!(passed.len(), 10, "{passed:?}");
        for (k, t) in passed.into_iter().enumerate() {
            let wanted = 180.0 * (k + 1) as f64;
            assert!((crank(t) - wanted).abs() < 1e-7, "the change point {} is told at {t}", k + 1);
        }
    }
}

#[test]
fn steep_quotients_are_followed_at_any_output_step() {
    let text = "mechanism pointer {
        ground { point O = (0, 0) }
        body b at (0, 0, 45 deg) { point O = (0, 0) point P = (1, 0) }
        joint pivot: revolute(ground.O, b.O)
        driver d: x(b.P) / y(b.P) = 1 + 20 * t
        analysis from 0 to 2 every 0.1
    }";
    for every in [0.1, 0.05, 0.03, 0.013] {
        let rows = run("pointer", text, Span { every: Some(every), to: None }).expect_success();
        for (t, phi) in rows.column("t").into_iter().zip(rows.column("b.phi")) {
            assert!(
                (phi - mechc_expr::math::atan2(1.0, 1.0 + 20.0 * t)).abs() < 1e-9,
                "every {every} at t = {t}: {phi}"
            );
        }
    }
}

#[test]
fn lazy_tongs_driven_at_their_far_end_are_one_block_and_no_lock_up() {
    const STAGES: usize = 110;
    let (sin, cos) = mechc_expr::math::sin_cos(0.5);
    let mut text = String::from("mechanism tongs { ground { point O = (0, 0) axis floor = O along (1, 0) }\n");
    for k in 0..STAGES {
        let y = (k as f64 + 0.5) * sin;
        for (name, phi) in [("a", 0.5), ("b", -0.5)] {
            text += &format!(
                "body {name}{k} at ({}, {y}, {phi}) {{ point L = (-0.5, 0) point M = (0, 0) point R = (0.5, 0) }}\n",
                0.5 * cos
            );
        }
        text += &format!("joint m{k}: revolute(a{k}.M, b{k}.M)\n");
        if k > 0 {
            let below = k - 1;
            text += &format!("joint l{k}: revolute(b{below}.L, a{k}.L) joint r{k}: revolute(a{below}.R, b{k}.R)\n");
        }
    }
    text += "joint base: revolute(ground.O, a0.L) joint roll: revolute_translational(b0.R, ground.floor)\n";
    text += &format!("driver lift: angle(a{}) = 0.5 + 0.3 * sin(2 * t) analysis from 0 to 3 every 0.5 }}", STAGES - 1);
    let rows = run("tongs", &text, Span::default()).expect_success();
    for (t, phi) in rows.column("t").into_iter().zip(rows.column("a0.phi")) {
        assert!((phi - 0.5 - 0.3 * mechc_expr::math::sin_cos(2.0 * t).0).abs() < 1e-9, "at t = {t}: {phi}");
    }
}

/// A parallelogram of lengths [mm] that goes round once, with a rocker and a coupler that are too long by some (mm).
fn near_parallelogram([crank, coupler]: [f64; 2], [rocker_off, coupler_off]: [f64; 2]) -> Outcome {
    let text = format!(
        "mechanism p {{
            ground {{ point A = (0, 0) point B = ({coupler} mm, 0) }}
            body crank at (0, 0, 60 deg) {{ point A = (0, 0) point C = ({crank} mm, 0) }}
            body coupler at ({} mm, {} mm, 0) {{ point C = (0, 0) point D = ({} mm, 0) }}
            body rocker at ({coupler} mm, 0, 60 deg) {{ point B = (0, 0) point D = ({} mm, 0) }}
            joint A: revolute(ground.A, crank.A)
            joint C: revolute(crank.C, coupler.C)
            joint D: revolute(coupler.D, rocker.D)
            joint B: revolute(ground.B, rocker.B)
            driver motor: rotation(A) = 60 deg + 1 rad/s * t
            analysis from 0 s to 3 s every 0.1 s
        }}",
        0.5 * crank,
        0.866 * crank,
        coupler + coupler_off,
        crank + rocker_off,
    );
    run("p", &text, Span::default())
}

#[test]
fn a_change_point_that_rounded_lengths_miss_is_reported() {
    let mut random = Random::new(3);
    for _ in 0..12 {
        let crank = random.between(40.0, 120.0);
        let coupler = crank * random.between(1.2, 3.0);
        let found = near_parallelogram([crank, coupler], [0.01, 0.0]);
        assert_eq!(found.codes(), ["W0605"], "{crank}, {coupler}: {}", found.text());
        let data =
            |name: &str| found.diagnostics.iter().next().and_then(|report| report.data[name].as_f64()).expect("data");
        // two thirds of a half turn after the start the links lie in line
        assert!((data("t") - TAU / 3.0).abs() < 1e-3, "{}", data("t"));
        let part = 0.01 / crank;
        assert!((0.2..5.0).contains(&(data("within") / part)), "{} of {part}", data("within"));
    }
}

#[test]
fn no_reports_away_from_change_points() {
    let mut random = Random::new(4);
    for _ in 0..12 {
        let crank = random.between(40.0, 120.0);
        let coupler = crank * random.between(1.2, 3.0);
        let off = crank * random.between(0.01, 0.2);
        let found = near_parallelogram([crank, coupler], [off, 0.0]);
        assert!(found.codes().is_empty(), "{crank}, {coupler}, {off}: {}", found.text());
    }
}

/// A flat follower on a curve whose radius of curvature is `base + 4 + 32 cos(3 u)` [mm].
fn wavy_cam(base: f64) -> String {
    format!(
        "mechanism cam {{
            ground {{ point O = (0, 0) axis way = O along (0, 1) }}
            body cam {{
                point O = (0, 0)
                curve flank(u) = (-({base} mm + 4 mm * (1 - cos(3 * u))) * sin(u) - 12 mm * sin(3 * u) * cos(u),
                    ({base} mm + 4 mm * (1 - cos(3 * u))) * cos(u) - 12 mm * sin(3 * u) * sin(u)) at 0 deg
            }}
            body tappet at (0, {base} mm, 0) {{ axis face = (0, 0) along (1, 0) axis way = (0, 0) along (0, 1) }}
            joint axle: revolute(ground.O, cam.O)
            joint guide: translational(ground.way, tappet.way)
            joint touch: flat_follower(cam.flank, tappet.face)
            driver motor: rotation(axle) = 1 rev/s * t
            analysis from 0 s to 1 s every 0.1 s
        }}"
    )
}

#[test]
fn undercut_cams_are_reported() {
    let mut random = Random::new(5);
    for _ in 0..6 {
        let base = random.between(15.0, 27.9);
        let cusp = math::atan2(math::sqrt(32.0 * 32.0 - (base + 4.0) * (base + 4.0)), -(base + 4.0)) / (3.0 * TAU);
        let outcomes = [false, true].map(|pass_bifurcations| {
            let (compiled, mut outcome) = support::compile("cam", &wavy_cam(base));
            let options = RunOptions { pass_bifurcations, ..RunOptions::default() };
            let times = Times::grid(0.0, 1.0, 0.1).expect("a grid");
            support::follow(&compiled.expect("determined"), &times, &options, &mut outcome);
            outcome
        });
        for found in outcomes {
            let why = found.stop().expect("undercut");
            assert!(why.code.as_str() == "E0607" && why.message.contains("undercut"), "{base}: {}", found.text());
            let t = why.data["t"].as_f64().expect("a time");
            assert!((t - cusp).abs() < 1e-4, "{base}: {t}, not {cusp}");
        }
        let base = random.between(28.5, 60.0);
        assert!(run("cam", &wavy_cam(base), Span::default()).succeeded(), "{base}");
    }
}
