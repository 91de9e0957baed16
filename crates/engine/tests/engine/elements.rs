//! Elements and functions against closed forms, from text to table: ratios of gears, lifts of cams, peaks of motions, splines.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::{Outcome, Span, run};
use mechc_expr::math::{cos, sin, sqrt};
use std::f64::consts::{PI, TAU};

/// A value with its first and second derivative.
type Jet = [f64; 3];

/// Runs a mechanism of these declarations, about which nothing is to be said.
fn motion(declarations: &str) -> Outcome {
    motion_with(&[], declarations)
}

/// Runs a mechanism of these declarations, about which just this is to be said.
fn motion_with(codes: &[&str], declarations: &str) -> Outcome {
    let got = run("elements", &format!("mechanism m {{ {declarations} }}"), Span::default());
    assert_eq!(got.codes(), codes, "{}", got.text());
    assert!(got.rows.len() > 20, "only {} rows", got.rows.len());
    got
}

/// A column with the columns of its derivatives, row by row.
fn jets(got: &Outcome, column: &str) -> Vec<Jet> {
    let [values, firsts, seconds] = ["", ".d", ".dd"].map(|order| got.column(&format!("{column}{order}")));
    values.into_iter().zip(firsts).zip(seconds).map(|((value, first), second)| [value, first, second]).collect()
}

/// Two jets agree to `tolerance` times one plus the size of the value.
fn assert_same(what: &str, got: Jet, want: Jet, tolerance: f64) {
    for (order, (got, want)) in got.into_iter().zip(want).enumerate() {
        let error = (got - want).abs();
        assert!(
            error <= tolerance * (1.0 + want.abs()),
            "{what}, derivative {order}: {got} instead of {want}, off by {error:e}"
        );
    }
}

/// A column and its derivatives are this function of time, to rounding.
fn assert_is(got: &Outcome, column: &str, want: impl Fn(f64) -> Jet) {
    for (t, jet) in got.column("t").into_iter().zip(jets(got, column)) {
        assert_same(&format!("{column} at t = {t}"), jet, want(t), 1e-13);
    }
}

/// `a + b·j`, for a number in proportion to another.
fn line(a: f64, b: f64, j: Jet) -> Jet {
    [a + b * j[0], b * j[1], b * j[2]]
}

fn sum(j: Jet, k: Jet) -> Jet {
    [j[0] + k[0], j[1] + k[1], j[2] + k[2]]
}

fn product(j: Jet, k: Jet) -> Jet {
    [j[0] * k[0], j[1] * k[0] + j[0] * k[1], j[2] * k[0] + 2.0 * j[1] * k[1] + j[0] * k[2]]
}

fn sine(j: Jet) -> Jet {
    let (s, c) = (sin(j[0]), cos(j[0]));
    [s, c * j[1], c * j[2] - s * j[1] * j[1]]
}

fn cosine(j: Jet) -> Jet {
    sine(line(PI / 2.0, 1.0, j))
}

fn root(j: Jet) -> Jet {
    let r = sqrt(j[0]);
    let first = j[1] / (2.0 * r);
    [r, first, (j[2] / 2.0 - first * first) / r]
}

/// The motion of most drivers here: `2 t + sin 3t`, which turns back now and then.
fn to_and_fro(t: f64) -> Jet {
    [2.0 * t + sin(3.0 * t), 2.0 + 3.0 * cos(3.0 * t), -9.0 * sin(3.0 * t)]
}

#[test]
fn an_idler_turns_the_sense_and_keeps_the_ratio() {
    let got = motion(
        "ground { point A = (0, 0) point B = (50 mm, 0) point C = (50 mm, 80 mm) }
         body first at (0, 0, 0) { point M = (0, 0) circle c = M radius 20 mm }
         body idler at (50 mm, 0, 0) { point M = (0, 0) circle c = M radius 30 mm }
         body last at (50 mm, 80 mm, 0) { point M = (0, 0) circle c = M radius 50 mm }
         joint a: revolute(ground.A, first.M)
         joint b: revolute(ground.B, idler.M)
         joint c: revolute(ground.C, last.M)
         joint ab: gear(first.c, idler.c)
         joint bc: gear(idler.c, last.c)
         driver motor: rotation(a) = 2 * t + sin(3 * t)
         measure ratio = der(rotation(c)) / der(rotation(a))
         analysis from 0 s to 3 s every 0.1 s",
    );
    assert_is(&got, "idler.phi", |t| line(0.0, -20.0 / 30.0, to_and_fro(t)));
    assert_is(&got, "last.phi", |t| line(0.0, 20.0 / 50.0, to_and_fro(t)));
    assert!(got.column("ratio").iter().all(|ratio| (ratio - 0.4).abs() < 1e-12));
}

#[test]
fn a_ring_turns_with_the_pinion_inside_it() {
    for (first, second) in [("pinion.c", "ring.c"), ("ring.c", "pinion.c")] {
        let got = motion(&format!(
            "ground {{ point A = (0, 0) point B = (-60 mm, 0) }}
             body pinion at (0, 0, 0) {{ point M = (0, 0) circle c = M radius 20 mm }}
             body ring at (-60 mm, 0, 0) {{ point M = (0, 0) circle c = M radius 80 mm }}
             joint a: revolute(ground.A, pinion.M)
             joint b: revolute(ground.B, ring.M)
             joint mesh: internal_gear({first}, {second})
             driver motor: rotation(a) = 2 * t + sin(3 * t)
             analysis from 0 s to 3 s every 0.1 s"
        ));
        assert_is(&got, "ring.phi", |t| line(0.0, 0.25, to_and_fro(t)));
    }
}

#[test]
fn a_given_phase_shifts_the_gear() {
    // with the line of centres along x, R φ + S ψ = κ
    let got = motion(
        "ground { point A = (0, 0) point B = (50 mm, 0) }
         body first at (0, 0, 0) { point M = (0, 0) circle c = M radius 20 mm }
         body second at (50 mm, 0, 20 deg) { point M = (0, 0) circle c = M radius 30 mm }
         joint a: revolute(ground.A, first.M)
         joint b: revolute(ground.B, second.M)
         joint mesh: gear(first.c, second.c, 12 mm)
         driver motor: rotation(a) = 2 * t + sin(3 * t)
         analysis from 0 s to 3 s every 0.1 s",
    );
    assert_is(&got, "second.phi", |t| line(0.4, -20.0 / 30.0, to_and_fro(t)));
}

/// Sun 24, planet 18, ring 60; carrier and ring are driven, and so both of Willis' degrees of freedom are used.
#[test]
fn willis() {
    let got = motion(
        "ground { point O = (0, 0) }
         body sun at (0, 0, 0) { point M = (0, 0) circle c = M radius 24 mm }
         body ring at (0, 0, 0) { point M = (0, 0) circle c = M radius 60 mm }
         body carrier at (0, 0, 0) { point M = (0, 0) point pin = (42 mm, 0) }
         body planet at (42 mm, 0, 0) { point M = (0, 0) circle c = M radius 18 mm }
         joint rs: revolute(ground.O, sun.M)
         joint rr: revolute(ground.O, ring.M)
         joint rc: revolute(ground.O, carrier.M)
         joint rp: revolute(carrier.pin, planet.M)
         joint outside: gear(sun.c, planet.c)
         joint inside: internal_gear(planet.c, ring.c)
         driver carry: rotation(rc) = 2 * t + sin(3 * t)
         driver sway: rotation(rr) = t^2 / 2
         analysis from 0 s to 3 s every 0.1 s",
    );
    let ring = |t: f64| [t * t / 2.0, t, 1.0];
    // (sun - carrier) = -60/24 (ring - carrier)
    assert_is(&got, "sun.phi", |t| sum(line(0.0, 1.0 + 2.5, to_and_fro(t)), line(0.0, -2.5, ring(t))));
    // (planet - carrier) = 60/18 (ring - carrier)
    assert_is(&got, "planet.phi", |t| {
        sum(line(0.0, 1.0 - 60.0 / 18.0, to_and_fro(t)), line(0.0, 60.0 / 18.0, ring(t)))
    });
}

/// Pulleys of 20 mm and 50 mm on fixed shafts; the second of them is braked with 3 N·m.
fn belt(word: &str) -> Outcome {
    motion(&format!(
        "ground {{ point A = (0, 0) point B = (90 mm, 60 mm) }}
         body first at (0, 0, 15 deg) {{ point M = (0, 0) circle c = M radius 20 mm }}
         body second at (90 mm, 60 mm, -0.3 rad) {{ point M = (0, 0) circle c = M radius 50 mm }}
         joint a: revolute(ground.A, first.M)
         joint b: revolute(ground.B, second.M)
         joint drive: belt(first.c, second.c{word})
         driver motor: rotation(a) = 15 deg + 2 * t + sin(3 * t)
         load brake: -3 N*m on rotation(b)
         measure hold = torque(drive)
         measure supply = effort(motor)
         analysis from 0 s to 3 s every 0.1 s"
    ))
}

#[test]
fn a_belt_turns_its_pulleys_by_their_radii() {
    for (word, sense) in [("", 1.0), (", crossed", -1.0)] {
        let got = belt(word);
        assert_is(&got, "second.phi", |t| line(-0.3, sense * 0.4, to_and_fro(t)));
        for (hold, supply) in got.column("hold").into_iter().zip(got.column("supply")) {
            assert!((hold - 3.0).abs() < 1e-12 && (supply - sense * 1.2).abs() < 1e-12, "{hold} {supply}");
        }
    }
}

/// A pulley on an arm, with a belt from a pulley that stands still: seen from the arm, that one turns back.
#[test]
fn a_belt_on_an_arm_rolls_on_the_pulley_of_the_ground() {
    for (word, ratio) in [("", 0.4), (", crossed", -0.4)] {
        let got = motion(&format!(
            "ground {{ point A = (0, 0) circle c = A radius 20 mm }}
             body arm at (0, 0, 30 deg) {{ point A = (0, 0) point B = (110 mm, 0) }}
             body second at (95.262794416288244 mm, 55 mm, 0.7 rad) {{ point M = (0, 0) circle c = M radius 50 mm }}
             joint a: revolute(ground.A, arm.A)
             joint b: revolute(arm.B, second.M)
             joint drive: belt(ground.c, second.c{word})
             driver carry: rotation(a) = 30 deg + 2 * t + sin(3 * t)
             analysis from 0 s to 3 s every 0.1 s"
        ));
        assert_is(&got, "second.phi", |t| line(0.7, 1.0 - ratio, to_and_fro(t)));
    }
}

/// Two belts in a chain, in a part and in its mirror image: the ratios are those of the text.
#[test]
fn belts_in_parts_keep_their_ratios() {
    let part = "mechanism train {
         ground { point A = (0, 0) point B = (90 mm, 60 mm) point C = (200 mm, 10 mm) }
         body first at (0, 0, 15 deg) { point M = (0, 0) circle c = M radius 20 mm }
         body second at (90 mm, 60 mm, 1) { point M = (0, 0) circle c = M radius 50 mm circle d = M radius 30 mm }
         body third at (200 mm, 10 mm, -0.2) { point M = (0, 0) circle c = M radius 12 mm }
         joint a: revolute(ground.A, first.M)
         joint b: revolute(ground.B, second.M)
         joint c: revolute(ground.C, third.M)
         joint near: belt(first.c, second.c)
         joint far: belt(third.c, second.d, crossed)
         driver motor: rotation(a) = 15 deg + 2 * t + sin(3 * t)
         measure turn = angle(third)
     }";
    for (mirrored, sense) in [("", 1.0), (" mirrored", -1.0)] {
        let text = format!(
            "mechanism m {{ part one: train() at (20 mm, 30 mm, 40 deg){mirrored}
             measure turn = one.turn
             measure seen = angle(one.third)
             analysis from 0 s to 3 s every 0.1 s }} {part}"
        );
        let got = run("elements", &text, Span::default());
        assert!(got.codes().is_empty() && got.rows.len() > 20, "{}", got.text());
        assert_is(&got, "turn", |t| line(-0.2, -1.0, to_and_fro(t)));
        let start = 40.0 * PI / 180.0 - sense * 0.2;
        assert_is(&got, "seen", |t| line(start, -sense, to_and_fro(t)));
    }
}

#[test]
fn a_rack_runs_as_fast_as_the_rim_of_its_pinion() {
    // above the rack, that is to its left, and below
    for (side, sense) in [(40, 1.0), (-40, -1.0)] {
        let got = motion(&format!(
            "ground {{ point O = (0, {side} mm) axis way = (0, 0) along (1, 0) }}
             body pinion at (0, {side} mm, 0) {{ point M = (0, 0) circle c = M radius 40 mm }}
             body rack at (0, 0, 0) {{ axis line = (0, 0) along (1, 0) }}
             joint main: revolute(ground.O, pinion.M)
             joint guide: translational(ground.way, rack.line)
             joint teeth: rack_pinion(pinion.c, rack.line)
             driver motor: rotation(main) = 2 * t + sin(3 * t)
             measure travel = displacement(guide)
             analysis from 0 s to 3 s every 0.1 s"
        ));
        assert_is(&got, "travel", |t| line(0.0, sense * 0.04, to_and_fro(t)));
    }
}

#[test]
fn a_gear_that_rolls_on_a_rack_of_the_ground() {
    let got = motion(
        "ground { axis rack = (0, 0) along (1, 0) }
         body wheel at (0, 50 mm, 0) { point M = (0, 0) point mark = (0, -50 mm) circle c = M radius 50 mm }
         joint teeth: rack_pinion(wheel.c, ground.rack)
         constraint height: y(wheel.M) = 50 mm
         driver pull: x(wheel.M) = 1 mm * (2 * t / 1 s + sin(3 * t / 1 s))
         measure mark_x = x(wheel.mark)
         measure mark_y = y(wheel.mark)
         analysis from 0 s to 3 s every 0.1 s",
    );
    // the mark draws a cycloid
    let turn = |t: f64| line(0.0, 0.001 / 0.05, to_and_fro(t));
    assert_is(&got, "wheel.phi", |t| line(0.0, -1.0, turn(t)));
    assert_is(&got, "mark_x", |t| line(0.0, 0.05, sum(turn(t), line(0.0, -1.0, sine(turn(t))))));
    assert_is(&got, "mark_y", |t| line(0.05, -0.05, cosine(turn(t))));
}

/// An eccentric disc of radius 25 mm, 9 mm off its shaft, and what else there is.
fn eccentric(declarations: &str) -> Outcome {
    motion(&format!(
        "ground {{ point O = (0, 0) axis way = O along (0, 1) }}
         body disc at (0, 0, 0) {{ point O = (0, 0) circle c = (9 mm, 0) radius 25 mm }}
         joint main: revolute(ground.O, disc.O)
         driver motor: rotation(main) = 2 * t + sin(3 * t)
         analysis from 0 s to 3 s every 0.1 s
         {declarations}"
    ))
}

#[test]
fn an_eccentric_lifts_a_flat_face_by_its_sine() {
    let got = eccentric(
        "body tappet at (0, 25 mm, 0) { axis way = (0, 0) along (0, 1) axis face = (0, 0) along (1, 0) }
         joint guide: translational(ground.way, tappet.way)
         joint rub: flat_follower(disc.c, tappet.face)
         measure lift = displacement(guide)",
    );
    assert_is(&got, "lift", |t| line(0.025, 0.009, sine(to_and_fro(t))));
    // it touches straight above its centre, wherever that is
    assert_is(&got, "rub.u", |t| line(PI / 2.0, -1.0, to_and_fro(t)));
}

#[test]
fn an_eccentric_lifts_a_roller_as_a_connecting_rod_would() {
    let got = eccentric(
        "body rod at (0, 40 mm, 0) { axis way = (0, 0) along (0, 1) circle c = (0, 0) radius 16 mm }
         joint guide: translational(ground.way, rod.way)
         joint roll: cam(disc.c, rod.c)
         measure lift = displacement(guide)",
    );
    // e sin φ + sqrt(l² - e² cos² φ)
    assert_is(&got, "lift", |t| {
        let aside = line(0.0, 0.009, cosine(to_and_fro(t)));
        sum(line(0.0, 0.009, sine(to_and_fro(t))), root(line(0.041 * 0.041, -1.0, product(aside, aside))))
    });
}

#[test]
fn a_scotch_yoke_moves_as_the_cosine() {
    let got = motion(
        "ground { point O = (0, 0) axis way = O along (1, 0) }
         body crank at (0, 0, 0) { point O = (0, 0) point pin = (60 mm, 0) }
         body yoke at (60 mm, 0, 0) { axis rod = (0, 0) along (1, 0) axis slot = (0, 0) along (0, 1) }
         joint main: revolute(ground.O, crank.O)
         joint guide: translational(ground.way, yoke.rod)
         joint block: revolute_translational(crank.pin, yoke.slot)
         driver motor: rotation(main) = 2 * t + sin(3 * t)
         measure stroke = displacement(guide)
         analysis from 0 s to 3 s every 0.1 s",
    );
    assert_is(&got, "stroke", |t| line(0.0, 0.06, cosine(to_and_fro(t))));
}

#[test]
fn a_point_on_a_circle_is_a_crank_pin() {
    // a slotted arm, 30 deg behind its slot, leads the point round the circle
    let got = motion(
        "ground { point O = (10 mm, -20 mm) circle c = O radius 60 mm }
         body arm at (10 mm, -20 mm, -30 deg) { point O = (0, 0) axis slot = O along (cos(30 deg), sin(30 deg)) }
         body pen at (70 mm, -20 mm, 0) { point P = (0, 0) }
         joint main: revolute(ground.O, arm.O)
         joint block: revolute_translational(pen.P, arm.slot)
         joint run: point_follower(pen.P, ground.c)
         constraint level: angle(pen) = 0
         driver motor: angle(arm) = -30 deg + 2 * t + sin(3 * t)
         analysis from 0 s to 3 s every 0.1 s",
    );
    assert_is(&got, "pen.x", |t| line(0.01, 0.06, cosine(to_and_fro(t))));
    assert_is(&got, "pen.y", |t| line(-0.02, 0.06, sine(to_and_fro(t))));
    assert_is(&got, "run.u", to_and_fro);
}

#[test]
fn a_point_on_a_cam_is_lifted_by_its_law() {
    let got = motion(
        "fn radius(u) = 40 mm + 10 mm * sin(u)^2
         ground { point O = (0, 0) axis way = O along (0, 1) }
         body plate at (0, 0, 0) { point O = (0, 0) curve k(u) = (-radius(u) * sin(u), radius(u) * cos(u)) at 0 deg }
         body rod at (0, 40 mm, 0) { point tip = (0, 0) axis way = tip along (0, 1) }
         joint main: revolute(ground.O, plate.O)
         joint guide: translational(ground.way, rod.way)
         joint contact: point_follower(rod.tip, plate.k)
         driver motor: rotation(main) = -(2 * t + sin(3 * t))
         measure lift = displacement(guide)
         analysis from 0 s to 3 s every 0.1 s",
    );
    assert_is(&got, "lift", |t| {
        let s = sine(to_and_fro(t));
        line(0.04, 0.01, product(s, s))
    });
}

/// A body that moves along x by a formula.
fn along(declarations: &str, formula: &str, analysis: &str) -> Outcome {
    motion(&sliding(declarations, formula, analysis))
}

fn sliding(declarations: &str, formula: &str, analysis: &str) -> String {
    format!(
        "{declarations}
         body b at (0, 0, 0) {{ point P = (0, 0) }}
         constraint y: y(b.P) = 0
         constraint turn: angle(b) = 0
         driver x: x(b.P) = {formula}
         analysis {analysis}"
    )
}

/// The greatest derivative of a motion from 0 to 1 in unit time is `peak`, and it has that where it should, at `s`.
/// The acceleration of two of them jumps at the ends, which is to be said.
fn assert_peak(name: &str, order: usize, s: f64, peak: f64) {
    // `s` is reached at t = 1
    let formula = format!("{name}(t, 1 - {s}, 0, 2 - {s}, 1)");
    let diagnostics: &[&str] = if matches!(name, "step" | "harmonic") { &["W0601"] } else { &[] };
    let got = motion_with(diagnostics, &sliding("", &formula, "from 0 s to 2.5 s every 0.0078125 s"));
    let times = got.column("t");
    let column: Vec<f64> = jets(&got, "b.x").into_iter().map(|jet| jet[order]).collect();
    let there = column[times.iter().position(|&t| t == 1.0).expect("a row at t = 1")];
    assert!((there - peak).abs() < 2e-14 * peak, "{name}: {there} instead of {peak}");
    let greatest = column.iter().fold(0.0_f64, |greatest, value| greatest.max(value.abs()));
    assert!(greatest <= peak * (1.0 + 1e-13), "{name} has {greatest}, more than {peak}");
    let value = got.column("b.x");
    assert_eq!((value[0], value[value.len() - 1]), (0.0, 1.0), "{name}: where it begins and ends");
}

#[test]
fn greatest_velocities_of_the_motions() {
    // 6 s (1 - s), 30 s² (1 - s)², 140 s³ (1 - s)³, π/2 sin πs, 1 - cos 2πs, and k (π + 3π)
    assert_peak("step", 1, 0.5, 1.5);
    assert_peak("step5", 1, 0.5, 1.875);
    assert_peak("step7", 1, 0.5, 2.1875);
    assert_peak("harmonic", 1, 0.5, PI / 2.0);
    assert_peak("cycloidal", 1, 0.5, 2.0);
    assert_peak("modsine", 1, 0.5, 4.0 * PI / (4.0 + PI));
}

#[test]
fn greatest_accelerations_of_the_motions() {
    assert_peak("step", 2, 0.0, 6.0);
    // 60 s (1 - s)(1 - 2s), where 6 s (1 - s) = 1
    assert_peak("step5", 2, (3.0 - sqrt(3.0)) / 6.0, 10.0 / sqrt(3.0));
    // 420 s² (1 - s)² (1 - 2s), where 5 s (1 - s) = 1
    assert_peak("step7", 2, (5.0 - sqrt(5.0)) / 10.0, 84.0 * sqrt(5.0) / 25.0);
    assert_peak("harmonic", 2, 0.0, PI * PI / 2.0);
    assert_peak("cycloidal", 2, 0.25, TAU);
    assert_peak("modsine", 2, 0.125, 4.0 * PI * PI / (4.0 + PI));
}

#[test]
fn a_rise_takes_its_ends_and_its_interval() {
    // twice as long, 3 high: the velocity is 3/2, the acceleration 3/4 of that over a unit
    let got = along("", "cycloidal(t, 1, -1, 3, 2)", "from 1 s to 3 s every 0.0625 s");
    assert_is(&got, "b.x", |t| {
        let s = (t - 1.0) / 2.0;
        let rise = s - sin(TAU * s) / TAU;
        // at the last time the piece before it would do as well: all is zero there
        [-1.0 + 3.0 * rise, 1.5 * (1.0 - cos(TAU * s)), 0.75 * TAU * sin(TAU * s)]
    });
}

#[test]
fn a_polynomial_and_its_derivatives() {
    let got = along("", "poly(t, 0.5, 0.3, -1, 0.25, 2, -0.75)", "from 0 s to 2 s every 0.0625 s");
    assert_is(&got, "b.x", |t| {
        let u = t - 0.5;
        [
            0.3 - u + 0.25 * u * u + 2.0 * u * u * u - 0.75 * u * u * u * u,
            -1.0 + 0.5 * u + 6.0 * u * u - 3.0 * u * u * u,
            0.5 + 12.0 * u - 9.0 * u * u,
        ]
    });
}

#[test]
fn a_natural_spline_through_three_points() {
    // by hand: 2 (1 + 2) M = 6 ((0 - 2)/2 - (2 - 0)/1), so the second derivative in the middle is M = -3
    let got = along("table k = spline [(0, 0), (1, 2), (3, 0)]", "k(t)", "from 0 s to 3 s every 0.0625 s");
    assert_is(&got, "b.x", |t| {
        let u = 3.0 - t;
        if t < 1.0 {
            [(5.0 * t - t * t * t) / 2.0, (5.0 - 3.0 * t * t) / 2.0, -3.0 * t]
        } else {
            [2.0 * u - u * u * u / 4.0, 0.75 * u * u - 2.0, -1.5 * u]
        }
    });
}

#[test]
fn a_spline_through_two_points_is_their_line() {
    let got = along("table k = spline [(-1, 3), (4, -7)]", "k(t)", "from 0 s to 3 s every 0.0625 s");
    assert_is(&got, "b.x", |t| [1.0 - 2.0 * t, -2.0, 0.0]);
}

/// Through a sine at twelve points a turn, over three turns, the first backward. Shifts along the points change nothing,
/// so the second derivatives at the points are those of a sine too, lower by a factor; and so are the first.
#[test]
fn a_periodic_spline_through_a_sine() {
    let rows: Vec<String> = (0..=12).map(|k| format!("({} deg, sin({} deg))", 30 * k, 30 * k)).collect();
    let table = format!("table wave = periodic spline [{}]", rows.join(", "));
    // a row at every point, and one in the middle
    let got = along(&table, "wave(t)", "from -tau to 2 * tau every tau / 24");
    let h = PI / 6.0;
    let first = 3.0 * sin(h) / (h * (2.0 + cos(h)));
    let second = 6.0 * (1.0 - cos(h)) / (h * h * (2.0 + cos(h)));
    assert_eq!(got.rows.len(), 73);
    for (k, (t, jet)) in got.column("t").into_iter().zip(jets(&got, "b.x")).enumerate() {
        if k % 2 == 0 {
            assert_same(&format!("at t = {t}"), jet, [sin(t), first * cos(t), -second * sin(t)], 1e-13);
        } else {
            // half the sum of the neighbours, more by h²/8 of half the sum of their second derivatives
            let half = cos(h / 2.0) * sin(t);
            let value = half * (1.0 + second * h * h / 8.0);
            assert!((jet[0] - value).abs() < 1e-13, "at t = {t}");
            assert!((jet[2] + second * half).abs() < 1e-13, "at t = {t}");
        }
    }
}

#[test]
fn splines_are_smooth_to_the_acceleration_across_their_points() {
    for kind in ["spline", "periodic spline"] {
        let got = motion(&format!(
            "table k = {kind} [(-1, 0.5), (0, 0), (0.5, 0.3), (1.75, -0.2), (2.5, 0.4), (3, 0.1), (4, 0.5)]
             body b at (0, 0, 0) {{ point P = (0, 0) }}
             driver x: x(b.P) = t
             driver y: y(b.P) = k(t)
             driver turn: angle(b) = 0 * t
             measure before = k(t - 1e-9)
             measure after = k(t + 1e-9)
             measure jerk_before = der(der(der(k(t - 1e-9))))
             measure jerk_after = der(der(der(k(t + 1e-9))))
             analysis from -0.5 s to 3.5 s every 0.125 s"
        ));
        let jerks = got.column("jerk_before").into_iter().zip(got.column("jerk_after"));
        let mut jumps = 0;
        for ((before, after), jerk) in jets(&got, "before").into_iter().zip(jets(&got, "after")).zip(jerks) {
            jumps += u8::from((jerk.0 - jerk.1).abs() > 1.0);
            for order in 0..3 {
                // no more than 2e-9 of the next derivative
                let next = match order {
                    0 | 1 => before[order + 1].abs() + 1e-6,
                    _ => jerk.0.abs().max(jerk.1.abs()),
                };
                let change = (after[order] - before[order]).abs();
                assert!(change <= 2.001e-9 * next + 1e-14, "{kind}: derivative {order} changes by {change:e}");
            }
        }
        // and these are points: only the third derivative says so
        assert_eq!(jumps, 5, "{kind}");
    }
}

/// A gear pair on a carrier that swings, driven by one gear or by the other.
fn gear_pair(driver: &str) -> Outcome {
    motion(&format!(
        "ground {{ point O = (0, 0) }}
         body carrier at (0, 0, 0) {{ point O = (0, 0) point pin = (50 mm, 0) }}
         body first at (0, 0, 0) {{ point M = (0, 0) circle c = M radius 20 mm }}
         body second at (50 mm, 0, 0) {{ point M = (0, 0) circle c = M radius 30 mm }}
         joint hub: revolute(ground.O, carrier.O)
         joint a: revolute(ground.O, first.M)
         joint b: revolute(carrier.pin, second.M)
         joint mesh: gear(first.c, second.c)
         driver swing: rotation(hub) = sin(t)
         driver motor: {driver}
         analysis from 0 s to 3 s every 0.1 s"
    ))
}

/// All columns are the same but for rounding.
fn assert_equal(got: &Outcome, want: &Outcome) {
    assert_eq!(got.columns, want.columns);
    assert_eq!(got.rows.len(), want.rows.len());
    for (got_row, want_row) in got.rows.iter().zip(&want.rows) {
        for ((a, b), column) in got_row.iter().zip(want_row).zip(&got.columns) {
            assert!((a - b).abs() <= 1e-13 * (1.0 + b.abs()), "{column} at t = {}: {a} and {b}", got_row[0]);
        }
    }
}

#[test]
fn gears_driven_from_either_side() {
    let first = gear_pair("rotation(a) = 2 * t + sin(3 * t)");
    // seen from the carrier the second turns back by 20/30
    let second = gear_pair("angle(second) = sin(t) - (2 * t + sin(3 * t) - sin(t)) / 1.5");
    assert_equal(&second, &first);
    assert_is(&first, "second.phi", |t| {
        let swing = [sin(t), cos(t), -sin(t)];
        sum(line(0.0, 5.0 / 3.0, swing), line(0.0, -2.0 / 3.0, to_and_fro(t)))
    });
}

#[test]
fn the_curves_of_a_cam_pair_may_change_places() {
    let pair = |contact: &str| {
        motion(&format!(
            "ground {{ point O = (0, 0) point V = (90 mm, -40 mm) }}
             body disc at (0, 0, 0) {{ point O = (0, 0) curve k(u) = (10 mm + 30 mm * cos(u), 28 mm * sin(u)) at 0 deg }}
             body lever at (90 mm, -40 mm, 90 deg) {{
                 point V = (0, 0)
                 curve m(w) = (40 mm + 40 mm * cos(w), 15 mm + 25 mm * sin(w)) at 90 deg
             }}
             joint main: revolute(ground.O, disc.O)
             joint pivot: revolute(ground.V, lever.V)
             joint contact: cam({contact})
             driver motor: rotation(main) = 0.3 * (2 * t + sin(3 * t))
             analysis from 0 s to 3 s every 0.1 s"
        ))
    };
    let (here, there) = (pair("disc.k, lever.m"), pair("lever.m, disc.k"));
    for (here_column, there_column) in
        [("lever.phi", "lever.phi"), ("contact.u", "contact.w"), ("contact.w", "contact.u"), ("disc.phi", "disc.phi")]
    {
        for (a, b) in jets(&here, here_column).into_iter().zip(jets(&there, there_column)) {
            assert_same(here_column, a, b, 1e-13);
        }
    }
    let swing = here.column("lever.phi");
    let (least, most) = swing.iter().fold((f64::MAX, f64::MIN), |(a, b), &v| (a.min(v), b.max(v)));
    assert!(most - least > 0.2, "the lever hardly moves");
}

/// A pinion with an eccentric on it drives a rack, a gear, a flat tappet and a roller lever; shifted, and turned about the origin.
fn everywhere(x: f64, y: f64, angle: f64) -> Outcome {
    let (s, c) = (sin(angle), cos(angle));
    let point = |px: f64, py: f64| format!("({}, {})", x + c * px - s * py, y + s * px + c * py);
    let pose = |px: f64, py: f64| format!("({}, {}, {angle})", x + c * px - s * py, y + s * px + c * py);
    let direction = |dx: f64, dy: f64| format!("({}, {})", c * dx - s * dy, s * dx + c * dy);
    motion(&format!(
        "ground {{
             point O = {centre}
             point G = {wheel}
             point V = {pivot}
             axis way = {rack} along {across}
             axis stem = {centre} along {up}
         }}
         body pinion at {pinion_pose} {{ point O = (0, 0) circle pitch = O radius 0.02 circle rim = (0.009, 0) radius 0.025 }}
         body wheel at {wheel_pose} {{ point M = (0, 0) circle pitch = M radius 0.06 }}
         body rack at {rack_pose} {{ point tip = (0, 0) axis line = tip along (1, 0) }}
         body tappet at {tappet_pose} {{ axis stem = (0, 0) along (0, 1) axis face = (0, 0) along (1, 0.1) }}
         body lever at {lever_pose} {{ point V = (0, 0) circle roller = (0.08, 0) radius 0.012 }}
         joint a: revolute(ground.O, pinion.O)
         joint g: revolute(ground.G, wheel.M)
         joint v: revolute(ground.V, lever.V)
         joint guide: translational(ground.way, rack.line)
         joint stem: translational(ground.stem, tappet.stem)
         joint mesh: gear(pinion.pitch, wheel.pitch)
         joint teeth: rack_pinion(pinion.pitch, rack.line)
         joint rub: flat_follower(pinion.rim, tappet.face)
         joint roll: cam(pinion.rim, lever.roller)
         driver motor: rotation(a) = {angle} + 2 * t + sin(3 * t)
         measure gear_turn = rotation(g) - {angle}
         measure lever_turn = rotation(v) - {angle}
         measure travel = displacement(guide)
         measure lift = displacement(stem)
         measure apart = distance(ground.G, rack.tip)
         analysis from 0 s to 3 s every 0.1 s",
        centre = point(0.0, 0.0),
        wheel = point(0.0, 0.08),
        pivot = point(-0.08, 0.047),
        rack = point(0.0, -0.02),
        across = direction(1.0, 0.0),
        up = direction(0.0, 1.0),
        pinion_pose = pose(0.0, 0.0),
        wheel_pose = pose(0.0, 0.08),
        rack_pose = pose(0.0, -0.02),
        tappet_pose = pose(0.0, 0.025),
        lever_pose = pose(-0.08, 0.047),
    ))
}

#[test]
fn parts_do_not_depend_on_location() {
    let want = everywhere(0.0, 0.0, 0.0);
    for (x, y, angle) in [(0.3, -0.2, 0.0), (0.0, 0.0, 2.0), (-0.1, 0.4, -0.7), (0.2, 0.1, PI)] {
        let got = everywhere(x, y, angle);
        for column in ["gear_turn", "lever_turn", "travel", "lift", "apart", "rub.u", "roll.u", "roll.w"] {
            for (a, b) in jets(&got, column).into_iter().zip(jets(&want, column)) {
                assert_same(&format!("{column}, moved by ({x}, {y}) and turned by {angle}"), a, b, 1e-13);
            }
        }
    }
}
