//! Results: numbers for the whole analysis, against closed forms and reference answers.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support;

use crate::support::compiled;
use mechc::{Answers, RunOptions, Times};
use mechc_expr::math::{hypot, sin_cos};
use std::f64::consts::{PI, TAU};

/// An arm of 1 m that turns by a formula of time, with declarations beside it.
fn arm(turn: &str, declarations: &str) -> String {
    format!(
        "mechanism m {{
    ground {{ point O = (0, 0) }}
    body arm {{ point O = (0, 0) point tip = (1 m, 0) }}
    joint main: revolute(ground.O, arm.O)
    driver motor: rotation(main) = {turn}
    {declarations}
}}"
    )
}

/// A crank-rocker that turns once a second.
fn four_bar(declarations: &str) -> String {
    format!(
        "mechanism m {{
    ground {{ point A = (0, 0) point D = (80 mm, 0) }}
    body crank at (0, 0, 40 deg) {{ point A = (0, 0) point B = (30 mm, 0) }}
    body coupler at (23 mm, 19 mm, 33 deg) {{ point B = (0, 0) point C = (70 mm, 0) point P = (40 mm, 25 mm) }}
    body rocker at (80 mm, 0, 88 deg) {{ point D = (0, 0) point C = (60 mm, 0) }}
    joint main: revolute(ground.A, crank.A)
    joint pin: revolute(crank.B, coupler.B)
    joint knee: revolute(coupler.C, rocker.C)
    joint pivot: revolute(ground.D, rocker.D)
    driver motor: rotation(main) = 40 deg + 1 rev/s * t
    {declarations}
}}"
    )
}

/// The results of a text over an analysis from 0 s on, with steps of a length, and its rows.
fn answers(text: &str, [to, every]: [f64; 2]) -> (Answers, Vec<Vec<f64>>) {
    let compiled = compiled("m", text);
    let times = Times::grid(0.0, to, every).expect("a grid");
    let mut run = compiled.run(&times, &RunOptions::default()).0.expect("it assembles");
    let mut rows = Vec::new();
    while let Some(row) = run.next_row() {
        match row {
            Ok(row) => rows.push(row.to_vec()),
            Err(_) => break,
        }
    }
    (run.results().expect("results of a grid"), rows)
}

fn values(text: &str, to: f64) -> Vec<f64> {
    let (answers, _) = answers(text, [to, 0.1 * to]);
    answers.values.iter().map(|value| value.unwrap_or_else(|| panic!("{:?}", answers.notes))).collect()
}

#[track_caller]
fn check(text: &str, to: f64, wanted: &[(f64, f64)]) {
    let found = values(text, to);
    assert_eq!(found.len(), wanted.len());
    for (k, (found, (wanted, tolerance))) in found.iter().zip(wanted).enumerate() {
        assert!(
            (found - wanted).abs() <= *tolerance,
            "result {k}: {found:?} instead of {wanted:?}, off by {:e}",
            found - wanted
        );
    }
}

fn sin(x: f64) -> f64 {
    sin_cos(x).0
}

fn cos(x: f64) -> f64 {
    sin_cos(x).1
}

#[test]
fn reductions_of_a_turning_arm_match_closed_forms() {
    let text = arm(
        "1 rad/s * t + 1",
        "result a = max(x(arm.tip)) result b = min(x(arm.tip)) result c = argmax(x(arm.tip)) result d = argmin(x(arm.tip))
         result e = mean(x(arm.tip)) result f = rms(x(arm.tip)) result g = integral(x(arm.tip))
         result h = first(x(arm.tip)) result i = last(x(arm.tip)) result j = at(x(arm.tip), 2.5)
         result k = max(y(arm.tip)) - min(y(arm.tip)) result l = sqrt(mean(x(arm.tip)^2)) - rms(x(arm.tip))",
    );
    let to = 7.25;
    let integral = sin(to + 1.0) - sin(1.0);
    let square = 0.5 * to + 0.25 * (sin(2.0 * (to + 1.0)) - sin(2.0));
    check(
        &text,
        to,
        &[
            (1.0, 1e-15),
            (-1.0, 1e-15),
            (TAU - 1.0, 1e-11),
            (PI - 1.0, 1e-11),
            (integral / to, 1e-12),
            ((square / to).sqrt(), 1e-12),
            (integral, 1e-11),
            (cos(1.0), 1e-15),
            (cos(to + 1.0), 1e-14),
            (cos(3.5), 1e-15),
            (2.0, 1e-15),
            (0.0, 1e-15),
        ],
    );
}

#[test]
fn velocities_accelerations_and_jerks_are_reduced_too() {
    let text = arm(
        "2 rad/s * t",
        "measure v = der(x(arm.tip)) measure a = der(v) measure j = der(a)
         result v_max = max(v) result v_when = argmax(v) result v_mean = rms(v)
         result a_max = max(a) result a_when = argmax(a) result a_mean = rms(a)
         result j_min = min(j) result j_when = argmin(j) result j_mean = rms(j)",
    );
    // v = −2 sin 2t, a = −4 cos 2t, j = 8 sin 2t
    let half: f64 = 0.5_f64.sqrt();
    check(
        &text,
        PI,
        &[
            (2.0, 1e-11),
            (0.75 * PI, 1e-10),
            (2.0 * half, 1e-10),
            (4.0, 1e-11),
            (0.5 * PI, 1e-10),
            (4.0 * half, 1e-10),
            (-8.0, 1e-8),
            (0.75 * PI, 1e-4),
            (8.0 * half, 1e-8),
        ],
    );
}

#[test]
fn measures_with_a_literal_point_are_reduced() {
    let text = arm(
        "t",
        "measure far = distance(arm.tip, (3, 4))  measure twice = 2 * far  result r = max(far)  result s2 = max(twice)",
    );
    check(&text, 1.0, &[(hypot(2.0, 4.0), 0.0), (2.0 * hypot(2.0, 4.0), 0.0)]);
}

#[test]
fn results_do_not_depend_on_the_output_step() {
    let text = four_bar(
        "measure lean = rotation(pivot)
         result swing = max(lean) - min(lean) result when = argmax(lean) result level = mean(y(coupler.P))
         result fast = max(hypot(der(x(coupler.P)), der(y(coupler.P)))) result ripple = max(x(coupler.P) + 0.01 * sin(1000 * t))
         result size = rms(sin(1000 * t) * x(coupler.P)) result last = last(lean)",
    );
    let (first, _) = answers(&text, [1.0, 0.1]);
    assert!(first.values.iter().all(Option::is_some), "{:?}", first.notes);
    for (every, count) in [(0.033, 31), (0.01, 101), (1e-3, 1001), (1e-4, 10_001)] {
        let (other, rows) = answers(&text, [1.0, every]);
        assert_eq!(rows.len(), count);
        assert_eq!(first.values, other.values, "every {every} s");
    }
}

#[test]
fn asking_for_results_changes_no_bit_of_a_row() {
    let plain = four_bar("measure lean = rotation(pivot) measure far = x(coupler.P) * sin(lean)");
    let asking = four_bar(
        "measure lean = rotation(pivot) measure far = x(coupler.P) * sin(lean)
         result a = max(der(der(y(coupler.P)))) result b = mean(cos(lean) * x(coupler.P)) result c = argmin(der(lean))",
    );
    let bits = |text: &str| {
        let (_, rows) = answers(text, [1.0, 1e-3]);
        rows.iter().flatten().map(|value| value.to_bits()).collect::<Vec<u64>>()
    };
    let compiled = compiled("m", &plain);
    let times = Times::grid(0.0, 1.0, 1e-3).expect("a grid");
    let run = compiled.run(&times, &RunOptions::default()).0.expect("it assembles");
    let wanted: Vec<u64> = run.flat_map(|row| row.expect("it moves")).map(f64::to_bits).collect();
    assert!(bits(&asking) == wanted);
}

#[test]
fn peaks_that_no_step_shows_are_found() {
    let text = arm(
        "1 rad/s * t",
        "result a = max(sin(1000 * t)) result b = argmax(sin(1000 * t)) result c = min(sin(1e5 * t + 1))
         result d = argmax(x(arm.tip) + 0.001 * sin(1000 * t)) result e = max(sin(1000 * angle(arm)))
         result f = mean(sin(1000 * t)^2) result g = integral(exp(-(1e4 * (t - 0.3))^2))
         result h = argmax(exp(-(1e4 * (t - 0.3))^2)) result i = max(exp(-(1e4 * (t - 0.3))^2))",
    );
    // cos t + 0.001 sin 1000 t: the second term wins where its slope, 1, is far above sin t
    let d = newton(PI / 2000.0, |t| (-sin(t) + cos(1000.0 * t), -cos(t) - 1000.0 * sin(1000.0 * t)));
    check(
        &text,
        1.0,
        &[
            (1.0, 1e-15),
            (PI / 2000.0, 1e-11),
            (-1.0, 1e-15),
            (d, 1e-10),
            (1.0, 1e-12),
            (0.5 - sin(2000.0) / 4000.0, 1e-11),
            (PI.sqrt() / 1e4, 1e-13),
            (0.3, 1e-10),
            (1.0, 1e-13),
        ],
    );
}

/// A driven body is where it was after a whole turn, and so is all that hangs on it: steps of whole turns would see nothing move.
#[test]
fn many_turns_are_resolved() {
    for turns in [1.0, 42.63, 60.0, 64.0, 128.0] {
        let text = format!(
            "mechanism m {{
                ground {{ point O = (0, 0) }}
                body k {{ point O = (0, 0) point A = (20 mm, 0) }}
                body n {{ point A = (0, 0) point B = (50 mm, 0) }}
                joint one: revolute(ground.O, k.O)
                joint two: revolute(k.A, n.A)
                driver fast: angle(k) = {turns} rev/s * t
                driver slow: angle(n) = 0.25 rev/s * t
                result low = min(x(n.B))
                result high = max(y(n.B))
                result near = min(hypot(x(n.B) - 40 mm, y(n.B) - 1 mm))
                result mean_x = mean(x(n.B))
            }}"
        );
        let mut wanted = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY];
        for k in 0..=400_000 {
            let t = f64::from(k) / 400_000.0;
            let x = 0.02 * cos(TAU * turns * t) + 0.05 * cos(0.25 * TAU * t);
            let y = 0.02 * sin(TAU * turns * t) + 0.05 * sin(0.25 * TAU * t);
            let near = hypot(x - 0.04, y - 0.001);
            wanted = [wanted[0].min(x), wanted[1].max(y), wanted[2].min(near)];
        }
        let found = values(&text, 1.0);
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-4, "{turns} turns: {found} instead of {wanted}");
        }
        assert!(found[0] <= wanted[0] && found[1] >= wanted[1] && found[2] <= wanted[2], "{turns} turns: {found:?}");
        let mean = 0.02 * sin(TAU * turns) / (TAU * turns) + 0.05 / (0.25 * TAU);
        assert!((found[3] - mean).abs() < 1e-9, "{turns} turns: {} instead of {mean}", found[3]);
    }
}

fn newton(mut t: f64, slope: impl Fn(f64) -> (f64, f64)) -> f64 {
    for _ in 0..20 {
        let (value, rise) = slope(t);
        t -= value / rise;
    }
    t
}

#[test]
fn ties_resolve_to_the_first_time() {
    // rises in the first second, rests for one, and comes back
    let turn = "if t < 1 s then step5(t, 0 s, 0, 1 s, 1) else if t < 2 s then 1 else step5(t, 2 s, 1, 3 s, 0)";
    let text = arm(
        turn,
        "result a = argmax(angle(arm)) result b = max(angle(arm)) result c = argmin(angle(arm)) result d = argmax(sin(6 * t))
         result e = argmax(min(angle(arm), 0.5)) result f = argmin(abs(angle(arm) - 0.5)) result g = mean(angle(arm))",
    );
    check(
        &text,
        3.0,
        &[(1.0, 1e-9), (1.0, 1e-12), (0.0, 0.0), (PI / 12.0, 1e-10), (0.5, 1e-6), (0.5, 1e-6), (2.0 / 3.0, 1e-10)],
    );
}

#[test]
fn formulas_with_kinks_and_jumps_are_reduced() {
    let text = arm(
        "1 rad/s * t",
        "result a = max(abs(sin(3 * t))) result b = min(abs(sin(3 * t) - 0.5)) result c = argmin(abs(t - 0.3))
         result d = integral(abs(sin(10 * t))) result e = integral(if t < 0.37 then 1 else 3) result f = max(if t < 0.37 then t else -t)
         result g = argmax(if t < 0.37 then t else -t) result h = mean(10 * t - mod(10 * t, 1)) result i = max(mod(7 * t, 1))
         result j = integral(sqrt(abs(t - 0.5)))",
    );
    let d = 2.0 * 3.0 / 10.0 + (1.0 + cos(10.0)) / 10.0;
    check(
        &text,
        1.0,
        &[
            (1.0, 1e-15),
            (0.0, 1e-9),
            (0.3, 1e-6),
            (d, 1e-10),
            (0.37 + 3.0 * 0.63, 1e-10),
            (0.37, 1e-9),
            (0.37, 1e-9),
            (4.5, 1e-9),
            (1.0, 1e-9),
            (2.0 * 2.0 / 3.0 * 0.5 * 0.5_f64.sqrt(), 1e-9),
        ],
    );
}

#[test]
fn forces_of_loads_that_jump_and_their_powers_are_reduced() {
    let text = arm(
        "1 rad/s * t",
        "load brake: if sin(10 * rotation(main)) < 0 then -5 N*m else -4 N*m on rotation(main)
         result a = mean(effort(motor)) result b = max(effort(motor)) result c = min(effort(motor)) result d = last(effort(motor))",
    );
    // 5 N·m count from π/10 to 2π/10, and from 3π/10 on
    check(&text, 1.0, &[(5.0 - PI / 5.0, 1e-9), (5.0, 1e-12), (4.0, 1e-12), (5.0, 1e-12)]);
    // a power has no derivative, but is as smooth as what it is a product of
    let text = arm(
        "5 rad/s^2 * t^2",
        "load drag: -(2 N*m + 1 N*m * sin(rotation(main))) on rotation(main)
         result a = max(effort(motor) * der(rotation(main))) result b = argmax(effort(motor) * der(rotation(main)))",
    );
    let slope = |t: f64| {
        let (s, c) = (sin(5.0 * t * t), cos(5.0 * t * t));
        (2.0 + s + 10.0 * t * t * c, 30.0 * t * c - 100.0 * t * t * t * s)
    };
    let t = newton(0.72, slope);
    let most = 10.0 * t * (2.0 + sin(5.0 * t * t));
    check(&text, 0.9, &[(most, 1e-8), (t, 1e-9)]);
}

/// A ram that a driver pushes with 1 m/s, with what works on it and what is asked.
fn ram(loads: &str, requested: &str) -> String {
    format!(
        "mechanism m {{
    ground {{ axis way = (0, 0) along (1, 0) }}
    body ram {{ axis way = (0, 0) along (1, 0) mass 2 kg }}
    joint guide: translational(ground.way, ram.way)
    driver feed: displacement(guide) = 1 m/s * t
    {loads}
    {requested}
}}"
    )
}

#[test]
fn short_loads_are_found() {
    let requested = "result a = max(effort(feed)) result b = integral(effort(feed)) result c = argmax(effort(feed))";
    // in a millimetre of two metres
    let text = ram(
        "fn blow(y) = if y > 0.777 m and y < 0.778 m then 1 kN else 0
         load punch: -blow(displacement(guide)) on displacement(guide)",
        requested,
    );
    check(&text, 2.0, &[(1000.0, 1e-9), (1.0, 1e-9), (0.777, 1e-9)]);
    // a bell of a tenth of a millisecond, whose tails are nothing for long
    let text = ram("load bell: -1 N * exp(-((t - 0.77771 s) / 0.1 ms)^2) on displacement(guide)", requested);
    check(&text, 2.0, &[(1.0, 1e-9), (1e-4 * PI.sqrt(), 1e-10), (0.77771, 1e-9)]);
    // what steps of a motion function take back leaves rounding
    let text = ram(
        "load pulse: step5(t, 0.302 s, 0, 0.303 s, 3 N) - step5(t, 0.3 s, 0, 0.301 s, 3 N) on displacement(guide)",
        "result a = max(effort(feed)) result b = integral(effort(feed))",
    );
    check(&text, 2.0, &[(3.0, 1e-9), (3.0 * 0.002, 1e-9)]);
    // a hump in a table
    let text = ram(
        "table hump = spline [(0, 0 N), (0.7, 0 N), (0.7001, 10 N), (0.7002, 0 N), (2, 0 N)]
         load bump: -hump(t / 1 s) on displacement(guide)",
        "measure same = hump(t / 1 s) result a = max(effort(feed)) - max(same) result b = integral(effort(feed)) - integral(same)",
    );
    check(&text, 2.0, &[(0.0, 1e-8), (0.0, 1e-9)]);
}

/// What goes to infinity has an integral, or none, by how fast it does so; whatever is added to it.
#[test]
fn integrals_near_poles_converge_or_diverge() {
    let (a, b): (f64, f64) = (0.3, 1.7);
    let root = 2.0 * (a.sqrt() + b.sqrt());
    let text = arm(
        "0.4 rad/s * t",
        "result at_time = integral(1 / sqrt(abs(t - 0.3 s)) * (1 s)^0.5)
         result at_angle = integral(1 / sqrt(abs(rotation(main) - 0.12)) * sqrt(0.4) * 1 s)
         result power = integral(abs(t / 1 s - 0.3)^(-0.6))
         result at_end = integral(1 / sqrt(2 s - t) * (1 s)^0.5)
         result log = integral(ln(abs(t / 1 s - 0.3)))
         result beside = integral(1 / sqrt(abs(t / 1 s - 0.3)) + 100 * exp(-((t - 1 s) / 1 ms)^2))
         result jump = mean(sign(t - 2 s))",
    );
    // (0.3^0.4 + 1.7^0.4) / 0.4, and the sum of x (ln x - 1)
    let (power, log) = (4.635_648_547_926_127, -1.459_123_814_492_091);
    let wanted = [root, root, power, 2.0 * 2.0_f64.sqrt(), log, root + 0.1 * PI.sqrt(), -1.0];
    check(&text, 2.0, &wanted.map(|wanted| (wanted, 2e-9)));
    for formula in [
        "1 / (t / 1 s - 0.3)",
        "1e6 + 1e-3 / abs(t / 1 s - 0.3)",
        "t / 1 s + 1e-6 / (t / 1 s - 0.3)",
        "tan(rotation(main) * 5)",
        "1 / (1 + x(arm.tip) / 1 m)",
    ] {
        let text = arm("1.7 rad/s * t", &format!("result a = mean({formula})"));
        let (answers, _) = answers(&text, [2.0, 0.2]);
        assert_eq!(answers.values, [None], "{formula}");
        assert!(answers.notes[0].message.contains("grows without bound"), "{formula}: {}", answers.notes[0].message);
    }
}

/// The tip of a cusp is where the argument is zero, of forces too, of which no slopes are known.
#[test]
fn cusps_of_forces_have_their_tips() {
    let text = arm(
        "1 rad/s * t",
        "load weight: -10 N * cos(rotation(main)) * 1 m on rotation(main)
         result root = min(ln(sqrt(abs(effort(motor) / (1 N * m))) + 0.001))
         result spike = max(1 / (sqrt(abs(effort(motor) / (1 N * m) - 3)) + 1e-4))
         result power = min(abs(effort(motor) / (1 N * m) - 3)^0.25)",
    );
    check(&text, 3.0, &[(-6.907_755_278_982_137, 1e-12), (1e4, 1e-8), (0.0, 1e-12)]);
}

/// Many turns need many cells.
#[test]
fn integrals_over_many_turns_are_found() {
    let text = four_bar("result a = mean(der(der(x(coupler.C)))^2)");
    let [once, often] = [1.0, 60.0].map(|to| values(&text, to)[0]);
    assert!((once - often).abs() <= 1e-9 * once, "{once} {often}");
}

/// What touches a threshold, or a pole, without a change of sign.
#[test]
fn touched_values_are_found() {
    let text = arm(
        "2 rad/s * t",
        "result cusp = min(sqrt(x(arm.tip) / 1 m + 1) + 1)
         result power = min((x(arm.tip) / 1 m + 1)^0.4)
         result at = argmin(abs(1 + x(arm.tip) / 1 m)^0.3)",
    );
    check(&text, 3.0, &[(1.0, 1e-15), (0.0, 1e-15), (0.5 * PI, 1e-7)]);
    for formula in ["max(1 / (1 + x(arm.tip) / 1 m))", "max(tan(rotation(main)))", "min(tan(3 * rotation(main) + 1))"] {
        let text = arm("2 rad/s * t", &format!("result a = {formula}"));
        let (answers, _) = answers(&text, [3.0, 0.3]);
        assert_eq!(answers.values, [None], "{formula}");
        assert!(answers.notes[0].message.contains("grows without bound"), "{formula}: {}", answers.notes[0].message);
    }
}

/// Values that rounding makes very large, or hides for a moment, are what they are: sin(w)/w has one where both are zero, and a ratio of two
/// velocities where the arm turns round.
#[test]
fn rounding_differs_from_poles() {
    let text = arm(
        "0.5 rad * sin(2 * t / 1 s) + 0.4",
        "result high = max(1 / ((x(arm.tip) / 1 m - 0.7)^2 + 1e-18)) / 1e18
         result ratio = min(abs(der(y(arm.tip)) / der(rotation(main))) / 1 m)
         measure w = cos(2 * t / 1 s + 0.3) - 1
         result wave = max(sin(w) / w)",
    );
    let wanted = [(1.0, 1e-9), (cos(0.9), 1e-6), (1.0, 1e-9)];
    check(&text, 3.0, &wanted);
    // the pole is at the end
    let text = arm("0.3 rad/s * t - 0.5", "result a = min(1 / (rotation(main) - 0.4))");
    assert_eq!(answers(&text, [3.0, 0.3]).0.values, [None]);
}

/// Of two zeros that are close the first counts, and beyond where it ends a formula counts nowhere. The mean is by quadrature of the closed form.
#[test]
fn adjacent_kinks_and_ends_are_reported() {
    let text = arm(
        "0.09 rad/s * t",
        "measure peak = abs(1 - exp(-((t - 0.67 s) / 0.14 ms)^2) - 0.01 * t / 1 s)
         result a = argmin(peak)
         result b = mean(abs(acos(1.1 * sin(2.35 * t / 1 s + 0.148))), from 1 s to 2 s)",
    );
    let first = 0.67 - 0.14e-3 * (-mechc_expr::math::ln(1.0 - 0.01 * 0.669_988_5)).sqrt();
    check(&text, 3.0, &[(first, 1e-9), (1.863_120_923_071_08, 1e-9)]);
}

#[test]
fn extremes_of_forces_have_their_times() {
    let text = arm(
        "0.3 + 2 rad/s * t",
        "load weight: -9.81 N * cos(rotation(main)) * 1 m on rotation(main)
         result a = argmin(effort(motor)) result b = argmax(effort(motor)) result c = argmax(0 * effort(motor) * t)",
    );
    check(&text, 3.0, &[(0.5 * (PI - 0.3), 1e-9), (0.5 * (TAU - 0.3), 1e-9), (0.0, 0.0)]);
    // friction that turns round with the motion
    let text = ram("load turn: 1 N * sign(t - 1 s) on displacement(guide)", "result a = argmin(effort(feed))");
    check(&text, 2.0, &[(1.0, 1e-9)]);
}

#[test]
fn at_a_jump_of_a_load_the_later_side_counts() {
    let text = ram(
        "load step: if t <= 1 s then 1 N else 2 N on displacement(guide)
         load other: if 1 s < t then 10 N else 20 N on displacement(guide)
         load side: 100 N * sign(t - 1 s) on displacement(guide)
         load saw: 1 kN * mod(2 - t / 1 s, 1) on displacement(guide)",
        "measure e = effort(feed) result most = max(e)",
    );
    let (_, rows) = answers(&text, [2.0, 0.5]);
    let compiled = compiled("m", &text);
    let column = compiled.columns().iter().position(|name| name == "e").expect("a column");
    let found: Vec<f64> = rows.iter().map(|row| row[column]).collect();
    assert_eq!(found, [-921.0, -421.0, -1112.0, -612.0, -1112.0]);
}

/// Whatever the last digits of a state are.
#[test]
fn rounding_decides_no_side() {
    let effort_at = |driver: &str, load: &str, times: &[f64]| -> Vec<f64> {
        let text = format!(
            "mechanism m {{
                ground {{ point O = (0, 0) axis way = O along (1, 0) }}
                body crank at (0, 0, 0) {{ point O = (0, 0) point A = (50 mm, 0) point top = (0, 100 mm) }}
                body rod at (50 mm, 0, 0) {{ point A = (0, 0) point B = (150 mm, 0) }}
                body ram at (200 mm, 0, 0) {{ point B = (0, 0) axis way = B along (1, 0) }}
                joint main: revolute(ground.O, crank.O)
                joint big: revolute(crank.A, rod.A)
                joint small: revolute(rod.B, ram.B)
                joint guide: translational(ground.way, ram.way)
                driver motor: rotation(main) = {driver}
                load of_it: {load}
                measure pull = force_x(small) measure e = effort(motor)
                analysis from 0 s to 6 s every 1 s
            }}"
        );
        let compiled = compiled("m", &text);
        let column = |name: &str| compiled.columns().iter().position(|of| of == name).expect("a column");
        let (pull, e) = (column("pull"), column("e"));
        let times = mechc::Times::listed(times[0], times.to_vec());
        let mut run = compiled.run(&times, &mechc::RunOptions::default()).0.expect("it assembles");
        let mut found = Vec::new();
        while let Some(row) = run.next_row() {
            let row = row.expect("a row");
            found.push(if load.contains("guide") { row[pull] } else { row[e] });
        }
        found
    };
    // Coulomb's friction where a slider turns round: half a turn a row
    let friction = "-10 N * sign(der(displacement(guide))) on displacement(guide)";
    let times: Vec<f64> = (0..7).map(f64::from).collect();
    let pulls: Vec<f64> = (0..7).map(|k| if k % 2 == 0 { 10.0 } else { -10.0 }).collect();
    let found = effort_at("0.5 rev/s * t", friction, &times);
    for (found, wanted) in found.iter().zip(&pulls) {
        assert!((found + wanted).abs() < 1e-9, "{found} beside {wanted}");
    }
    // where a dwell ends
    let friction = "-1 N*m * sign(der(rotation(main))) on rotation(main)";
    let found = effort_at("step5(t, 0.25 s, 0, 0.5 s, 1)", friction, &[0.0, 0.125, 0.25, 0.375, 0.5, 1.0]);
    assert_eq!(found, [0.0, 0.0, 1.0, 1.0, 0.0, 0.0]);
    // of time alone
    let found = effort_at("0.1 * t / 1 s", "1 N*m * sign(cos(pi * t / 1 s)) on rotation(main)", &[0.0, 0.5, 1.0, 1.5]);
    assert_eq!(found, [-1.0, 1.0, 1.0, -1.0]);
    let found = effort_at("0.1 * t / 1 s", "1 N*m * mod(3 * sin(pi * t / 1 s), 1) on rotation(main)", &[0.0, 0.5, 1.0]);
    assert_eq!(found, [0.0, -1.0, -1.0]);
    // a value that holds at one time alone
    let found = effort_at(
        "1 rad/s * (t - pi / 2 * 1 s)",
        "if y(crank.top) >= 100 mm then 1 N*m else 2 N*m on rotation(main)",
        &[0.0, PI / 2.0],
    );
    assert_eq!(found, [-2.0, -2.0]);
}

/// What rests while all else moves has no friction, whatever rounding leaves of its rate.
#[test]
fn a_dwell_has_no_friction() {
    let text = "mechanism dwell {
        param R = 30 mm
        ground { point O = (0, 0) axis way = O along (0, 1) }
        body disc { point O = (0, 0) curve rim(u) = (R * cos(u), R * sin(u)) at 90 deg }
        body tappet at (0, 30 mm, 0) { axis face = (0, 0) along (1, 0) axis way = (0, 0) along (0, 1) mass 1 kg }
        joint main: revolute(ground.O, disc.O)
        joint guide: translational(ground.way, tappet.way)
        joint contact: flat_follower(disc.rim, tappet.face)
        driver motor: rotation(main) = 5 rad/s * t
        gravity (0, -9.81 m/s^2)
        load friction: -3 N * sign(der(displacement(guide))) on displacement(guide)
        load brake: (if der(displacement(guide)) > 0 m/s then 1 N else 0 N) on displacement(guide)
        measure press = force_y(contact)
        measure rate = der(displacement(guide))
        analysis from 0 s to 1 s every 0.01 s
    }";
    let compiled = compiled("dwell", text);
    let column = |name: &str| compiled.columns().iter().position(|of| of == name).expect("a column");
    let (press, rate) = (column("press"), column("rate"));
    let mut run = compiled.run(&mechc::Times::grid(0.0, 1.0, 0.01).expect("a grid"), &mechc::RunOptions::default());
    let run = run.0.as_mut().expect("it assembles");
    let mut is_rounded = false;
    while let Some(row) = run.next_row() {
        let row = row.expect("a row");
        assert!((row[press] - 9.81).abs() < 1e-9, "{} N at {} s", row[press], row[0]);
        is_rounded |= row[rate] != 0.0;
    }
    assert!(is_rounded, "there is rounding that could have decided");
}

/// `der` goes as deep in loads as in measures, whatever else is asked for.
#[test]
fn a_load_holds_a_jerk() {
    let text = |more: &str| {
        format!(
            "mechanism m {{
                ground {{ point O = (0, 0) }}
                body b {{ point O = (0, 0) }}
                joint g: revolute(ground.O, b.O)
                driver d: rotation(g) = sin(2 rad/s * t)
                load f: 1 N*m*s^3 * der(der(der(rotation(g)))) on rotation(g)
                measure e = effort(d) {more}
                analysis from 0 s to 1 s every 250 ms
            }}"
        )
    };
    for more in ["", "measure j = der(der(der(rotation(g))))", "result most = max(e)"] {
        let rows = support::run("m", &text(more), support::Span::default()).expect_success();
        let column = rows.columns.iter().position(|name| name == "e").expect("a column");
        for row in &rows.rows {
            let wanted = 8.0 * sin_cos(2.0 * row[0]).1;
            assert!((row[column] - wanted).abs() < 1e-12, "{more}: {} beside {wanted}", row[column]);
        }
    }
}

#[test]
fn zero_forces_have_no_rates() {
    let text = ram("", "measure side = force_x(guide) measure other = force_y(guide)");
    assert!(
        !support::compiled("m", &text).columns().iter().any(|name| name.contains("side.") || name.contains("other."))
    );
}

#[test]
fn forces_of_loads_by_a_table_are_reduced_piece_by_piece() {
    let text = arm(
        "1 rad/s * t",
        "table cam = periodic spline [(0, 1 N*m), (1, 2 N*m), (2, 4 N*m), (3, 2.5 N*m), (4, 1 N*m)]
         load cam_torque: -cam(rotation(main)) on rotation(main)
         result a = at(effort(motor), 1 s) result b = at(effort(motor), 3 s) result c = at(effort(motor), 6 s)
         result d = mean(effort(motor)) result e = max(effort(motor)) - max(cam(rotation(main)))",
    );
    // with equal steps the mean of a periodic spline is that of its values
    check(&text, 8.0, &[(2.0, 1e-12), (2.5, 1e-12), (4.0, 1e-12), (9.5 / 4.0, 1e-9), (0.0, 1e-9)]);
}

/// A table whose pieces differ so much that their coefficients together say nothing of a quotient. The figures are those of `scipy`'s
/// `CubicSpline(…, bc_type="periodic")`, integrated with four million steps.
const UNEVEN: &str = "table lift = periodic spline [(0, 40 mm), (2, 45 mm), (4, 50 mm), (360 deg, 40 mm)]";

#[test]
fn tables_are_looked_at_piece_by_piece() {
    let declared = format!(
        "{UNEVEN}
        result a = mean(1/(lift(t/1 s) - 30 mm)) result b = mean(lift(40 * t/1 s)) result c = max(lift(40 * t/1 s))
        result d = max(der(der(lift(4 * t/1 s)))) result e = mean(lift(t/1 s) / (lift(2 * t/1 s) - 35 mm))"
    );
    let wanted =
        [71.815_749_610_989, 0.044_966_863_925_603, 0.050_283_384_955_376, 0.105_116_303_633_047, 5.877_481_438_451_28];
    check(&arm("t", &declared), 4.0, &wanted.map(|value| (value, 1e-9 * value)));
}

/// What is put together of the argument before a jump and behind it is none of what the function is asked for.
#[test]
fn branches_are_looked_at_one_by_one() {
    // of 0.55
    const ASIN: f64 = 0.582_364_237_868_743;
    let requested = "result a = max(asin(step5(mod(t/1 s, 1), 0, 0.2, 2, 0.9))) result b = max(sqrt(step7(if t < 0.5 s then 0 else 1, 0, 0.2, 2, 0.9)))
        result c = max(asin(step5(if t < 0.5 s then 0 else 1, 0, 0.2, 2, 0.9)))";
    check(&arm("t", requested), 2.0, &[(ASIN, 1e-9), (0.55_f64.sqrt(), 1e-9), (ASIN, 1e-9)]);
}

/// At a kink the derivatives are those of one side, and cells may begin or end just there.
#[test]
fn a_kink_where_cells_meet_is_integrated_on_both_sides() {
    let requested = "result a = integral(max(0, t - 0.25)) result b = integral(max(t - 0.25, 0)) result c = integral(min(0.25, t))
        result d = integral(max(0, 0.25 - t)) result e = integral(min(max(0, t - 0.25), 0.5)) result f = integral(max(0, t^2 - 0.0625))";
    let wanted = [0.28125, 0.28125, 0.21875, 0.03125, 0.25, 1.0 / 3.0 - 0.0625 + 1.0 / 96.0];
    check(&arm("t", requested), 1.0, &wanted.map(|value| (value, 1e-11)));
    let turning = "result a = mean(max(y(arm.tip), 0 m)) result b = mean(max(0 m, x(arm.tip))) result c = rms(max(y(arm.tip), 0 m))";
    check(&arm("360 deg * t", turning), 1.0, &[(1.0 / PI, 1e-10), (1.0 / PI, 1e-10), (0.5, 1e-10)]);
}

/// The third derivative of a spline jumps at its knots, also where nothing moves by it.
#[test]
fn jumps_of_third_derivatives_have_their_times() {
    let requested = "table q = spline [(0, 0), (0.25, 1), (1, 0)]
        result a = argmax(der(der(der(q(t/1 s))))) result b = max(der(der(der(q(t/1 s))))) result c = integral(der(der(der(q(t/1 s)))))
        table p = periodic spline [(0, 0), (0.5, 1), (1.2, -1), (2, 0)]
        result d = argmax(der(der(der(p(7 * t/1 s)))))";
    // a natural spline with one knot inside: c₃ is −64/6 before it, and 64/18 behind it
    check(&arm("7 * t", requested), 1.0, &[(0.25, 1e-9), (64.0 / 3.0, 1e-9), (0.0, 1e-8), (0.5 / 7.0, 1e-9)]);
}

/// Its slope is nothing just there, and cells may begin or end there.
#[test]
fn a_turn_where_cells_meet_is_found() {
    let requested = "result a = argmax(x(arm.tip)) result b = max(x(arm.tip)) result c = argmin(-x(arm.tip)) result d = argmin((y(arm.tip)/1 m)^2)";
    for (turn, t, to) in [("30 rpm", 0.75, 1.4), ("1 rad/s", 0.25, 1.0), ("1 rad/s", 0.5, 1.0), ("1 rad/s", 0.3, 1.0)] {
        let text = arm(&format!("{turn} * (t - {t} s)"), requested);
        check(&text, to, &[(t, 1e-9), (1.0, 1e-12), (t, 1e-9), (t, 1e-9)]);
    }
}

/// A number that rests is that number, and no little more or less.
#[test]
fn rests_at_switches_have_a_side() {
    let requested = "result a = integral(mod(min(3 * t/1 s, 2), 1)) result b = integral(mod(max(t/1 s, 10), 1))
        result c = integral(sign(min(3 * t/1 s, 2) - 2)) result d = integral(mod(min(3 * rotation(main), 2), 1))";
    check(&arm("t", requested), 2.0, &[(1.0 / 3.0, 1e-9), (0.0, 1e-12), (-2.0 / 3.0, 1e-9), (1.0 / 3.0, 1e-9)]);
}

#[test]
fn the_seam_of_a_table_is_no_edge() {
    let resting = format!("{UNEVEN} result a = max(lift(rotation(main))) result b = mean(lift(rotation(main)))");
    check(&arm("360 deg + 0 * t", &resting), 4.0, &[(0.04, 1e-15), (0.04, 1e-15)]);
    // the plate of a cam goes over the seam of its own outline at t = 2 pi - 1
    let cam = format!(
        "mechanism m {{
    {UNEVEN}
    ground {{ point O = (0, 0) axis way = (0, 0) along (0, 1) }}
    body plate {{ point O = (0, 0) curve pitch(u) = (-lift(u) * sin(u), lift(u) * cos(u)) at 1 }}
    body follower at (0, 43 mm, 0) {{ point centre = (0, 0) axis stem = centre along (0, 1) }}
    joint shaft: revolute(ground.O, plate.O)
    joint guide: translational(ground.way, follower.stem)
    joint contact: point_follower(follower.centre, plate.pitch)
    driver motor: rotation(shaft) = -1 - t
    result a = mean(slip(contact)) result b = mean(der(slip(contact))) * 5.5 s - (last(slip(contact)) - first(slip(contact)))
}}"
    );
    check(&cam, 5.5, &[(0.045_873_075_35, 1e-9), (0.0, 1e-12)]);
}

#[test]
fn results_speak_of_each_other_and_are_repeated() {
    let text = arm(
        "1 rad/s * t",
        "param n = 3
         result spread = rms(x(arm.tip) - level) result level = mean(x(arm.tip)) result twice = 2 * spread + level
         result nested = max(x(arm.tip) - mean(x(arm.tip))) result part[k in 0..n] = at(x(arm.tip), k * 0.5 s)",
    );
    let compiled = compiled("m", &text);
    let names: Vec<String> = compiled.results().into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["spread", "level", "twice", "nested", "part[0]", "part[1]", "part[2]"]);
    let to = 2.0;
    let level = sin(to) / to;
    let spread = (0.5 + sin(2.0 * to) / (4.0 * to) - level * level).sqrt();
    check(
        &text,
        to,
        &[
            (spread, 1e-11),
            (level, 1e-12),
            (2.0 * spread + level, 1e-10),
            (1.0 - level, 1e-11),
            (1.0, 1e-15),
            (cos(0.5), 1e-15),
            (cos(1.0), 1e-15),
        ],
    );
}

#[test]
fn a_formula_without_a_bound_has_no_result_and_moments_without_a_value_are_left_out() {
    // between all rows
    let text = arm(
        "1 rad/s * t",
        "result a = max(1 / (t - 0.123)) result b = mean(1 / (t - 0.123)^2) result c = last(1 / (t - 0.123)) result d = max(x(arm.tip))
         result e = a + d result f = min(sqrt(t - 0.5))",
    );
    let (answers, rows) = answers(&text, [1.0, 0.1]);
    assert_eq!(rows.len(), 11);
    let is_there: Vec<bool> = answers.values.iter().map(Option::is_some).collect();
    assert_eq!(is_there, [false, false, true, true, false, true]);
    assert_eq!(answers.values[5], Some(0.0));
    let at: Vec<f64> = answers.notes.iter().map(|note| note.data["t"].as_f64().expect("a time")).collect();
    for (at, wanted) in at.iter().zip([0.123, 0.123, 0.123, 0.0]) {
        assert!((at - wanted).abs() < 1e-6, "{at}");
    }
    let codes: Vec<&str> = answers.notes.iter().map(|note| note.code.as_str()).collect();
    assert_eq!(codes, ["N0604", "N0604", "N0604", "N0605"]);
}

#[test]
fn after_a_stop_all_are_null() {
    // the slider is pulled beyond the reach of its rod
    let text = "mechanism m {
    ground { point O = (0, 0) axis way = O along (1, 0) }
    body rod at (0, 0, 80 deg) { point O = (0, 0) point eye = (1 m, 0) }
    body slider at (0.2 m, 1 m, 0) { axis slot = (0, 0) along (0, 1) axis way = (0, -1 m) along (1, 0) }
    joint main: revolute(ground.O, rod.O)
    joint touch: revolute_translational(rod.eye, slider.slot)
    joint guide: translational(ground.way, slider.way)
    driver pull: displacement(guide) = 0.2 m + 1 m/s * t
    result a = max(angle(rod)) result b = first(angle(rod))
}";
    let (stopped, rows) = answers(text, [1.0, 0.1]);
    assert!(rows.len() < 11);
    assert_eq!(stopped.values, [None, None]);
    // the last row is before the stop, the end of the analysis behind it
    let (behind, rows) = answers(text, [0.95, 0.5]);
    assert_eq!((rows.len(), behind.values.as_slice(), behind.notes.len()), (2, [None, None].as_slice(), 1));
}

#[test]
fn single_times_have_results() {
    let text = arm(
        "1 rad/s * t + 1",
        "result a = max(x(arm.tip)) result b = argmin(x(arm.tip)) result c = mean(x(arm.tip)) result d = integral(x(arm.tip))
         result e = rms(y(arm.tip)) result f = last(x(arm.tip))",
    );
    let compiled = compiled("m", &text);
    let mut run = compiled.run(&Times::listed(0.0, vec![0.5]), &RunOptions::default()).0.expect("it assembles");
    while run.next_row().is_some() {}
    assert_eq!(run.results(), None);
    let (answers, _) = answers(&text, [0.0, 0.1]);
    assert_eq!(answers.values, [cos(1.0), 0.0, cos(1.0), 0.0, sin(1.0), cos(1.0)].map(Some));
}

#[test]
fn a_time_outside_the_analysis_is_refused() {
    let text = arm("1 rad/s * t", "result a = at(x(arm.tip), 2 s)");
    let compiled = compiled("m", &text);
    let codes = |to: f64| {
        let (run, messages) = compiled.run(&Times::grid(0.0, to, 0.1).expect("a grid"), &RunOptions::default());
        assert_eq!(run.is_none(), messages.has_errors());
        messages.iter().map(|fault| fault.code.as_str()).collect::<Vec<_>>()
    };
    assert_eq!(codes(1.0), ["E0422"]);
    assert_eq!(codes(2.0), Vec::<&str>::new());
}

#[test]
fn words_of_reductions_are_names_elsewhere_and_give_way_to_functions() {
    let text = arm(
        "1 rad/s * t",
        "param result = 2 param at = 3 param first = 4 fn mean(u) = u + 100
         measure last = result * at * x(arm.tip) measure argmax = first
         result mean_of = mean(max(last)) result rms = rms(argmax) result trace = result",
    );
    check(&text, 1.0, &[(106.0, 1e-12), (4.0, 1e-12), (2.0, 0.0)]);
}

#[test]
fn angles_at_a_point_are_reduced_in_all_quadrants() {
    let text = arm(
        "2 * t",
        "measure corner = angle(ground.R, ground.O, arm.tip) measure turned = atan2(y(arm.tip), x(arm.tip))
         result a = max(corner) result b = argmax(corner) result c = mean(corner) result d = mean(turned) result e = min(turned)",
    )
    .replace("point O = (0, 0) }\n    body", "point O = (0, 0) point R = (1 m, 0) }\n    body");
    // 0 to 3 rad, and no farther
    check(&text, 1.5, &[(3.0, 1e-12), (1.5, 1e-11), (1.5, 1e-11), (1.5, 1e-11), (0.0, 1e-12)]);
}

#[test]
fn quick_ripples_are_resolved() {
    // what follows without iteration is stepped over in large steps
    let text = arm(
        "0.3 * sin(800 * t) + t",
        "result a = max(angle(arm)) result b = argmax(angle(arm)) result c = mean(angle(arm)) result d = max(der(angle(arm)))",
    );
    // the last ripple but the end: 240 cos 800 t = −1
    let first = (mechc_expr::math::acos(-1.0 / 240.0)) / 800.0;
    let period = TAU / 800.0;
    let last = (0..200).map(|k| first + f64::from(k) * period).rfind(|t| *t <= 1.0).expect("a ripple");
    check(
        &text,
        1.0,
        &[
            (0.3 * sin(800.0 * last) + last, 1e-10),
            (last, 1e-9),
            (0.5 + 0.3 * (1.0 - cos(800.0)) / 800.0, 1e-10),
            (241.0, 1e-8),
        ],
    );
}

#[test]
fn speeds_that_come_to_rest_have_mean_and_minimum() {
    // a point of a wheel that rolls on the ground: its speed is 2 |sin(t/2)|
    let text = "mechanism m {
    ground { point O = (0, 0) axis way = (0, 1 m) along (1, 0) }
    body frame { axis way = (0, 0) along (1, 0) point hub = (0, 0) }
    body wheel at (0, 1 m, 0) { point hub = (0, 0) point foot = (0, -1 m) }
    joint guide: translational(ground.way, frame.way)
    joint hub: revolute(frame.hub, wheel.hub)
    driver roll: rotation(hub) = -1 rad/s * t
    driver go: displacement(guide) = 1 m/s * t
    result a = min(speed(wheel.foot)) result b = mean(speed(wheel.foot)) result c = integral(speed(wheel.foot))
    result d = max(speed(wheel.foot)) result e = argmax(speed(wheel.foot)) result f = max(curvature(wheel.foot))
}";
    let (found, _) = answers(text, [10.0, 0.7]);
    let way = 8.0 + 4.0 * (1.0 + cos(5.0)) - 0.0;
    let wanted = [0.0, way / 10.0, way, 2.0, PI];
    for (found, wanted) in found.values.iter().zip(wanted) {
        let found = found.expect("a number");
        assert!((found - wanted).abs() < 1e-8, "{found} instead of {wanted}");
    }
    // at rest there is no curvature; elsewhere it is −1 / (4 |sin(t/2)|)
    assert_eq!(found.values[5], Some(-0.25));
}

#[test]
fn lengths_that_rest_have_values() {
    let results = "result a = max(speed(crank.B)) result b = min(speed(crank.B)) result c = max(distance(crank.B, ground.A))
    result d = min(speed(crank.A)) result e = max(distance(crank.A, ground.A)) result f = max(distance(crank.B, coupler.B))
    result g = max(hypot(x(crank.B), y(crank.B))) result h = argmax(speed(crank.B)) result i = mean(speed(crank.B))
    result j = max(distance(coupler.B, rocker.C))";
    let speed = 0.03 * TAU;
    let wanted = [speed, speed, 0.03, 0.0, 0.0, 0.0, 0.03, 0.0, speed, 0.07];
    for (found, wanted) in values(&four_bar(results), 1.0).into_iter().zip(wanted) {
        assert!((found - wanted).abs() < 1e-12, "{found} instead of {wanted}");
    }
}

#[test]
fn a_long_analysis_is_as_good_as_a_short_one() {
    let text = four_bar(
        "result a = max(rotation(pivot)) - min(rotation(pivot)) result b = argmax(y(coupler.P)) result c = mean(y(coupler.P))",
    );
    let (one, _) = answers(&text, [1.0, 0.5]);
    let (many, _) = answers(&text, [150.0, 50.0]);
    for (k, (one, many)) in one.values.iter().zip(&many.values).enumerate() {
        let (one, many) = (one.expect("a number"), many.expect("a number"));
        assert!((one - many).abs() < 1e-9, "result {k}: {one} once, {many} in many turns");
    }
}

#[test]
fn results_span_passed_bifurcations() {
    let text = "mechanism m {
    ground { point A = (0, 0) point D = (1 m, 0) }
    body crank at (0, 0, 60 deg) { point A = (0, 0) point B = (0.4 m, 0) }
    body rod at (0.2 m, 0.346 m, 0) { point B = (0, 0) point C = (1 m, 0) point P = (0.5 m, 0) }
    body rocker at (1 m, 0, 60 deg) { point D = (0, 0) point C = (0.4 m, 0) }
    joint main: revolute(ground.A, crank.A)
    joint pin: revolute(crank.B, rod.B)
    joint knee: revolute(rod.C, rocker.C)
    joint pivot: revolute(ground.D, rocker.D)
    driver motor: rotation(main) = 60 deg + 1 rad/s * t
    result a = max(x(rod.P)) result b = min(x(rod.P)) result c = mean(y(rod.P)) result d = argmin(x(rod.P))
}";
    let compiled = compiled("m", text);
    let options = RunOptions { pass_bifurcations: true, ..RunOptions::default() };
    let mut run = compiled.run(&Times::grid(0.0, TAU, 0.1).expect("a grid"), &options).0.expect("it assembles");
    while run.next_row().is_some_and(|row| row.is_ok()) {}
    let answers = run.results().expect("results");
    for (found, wanted) in answers.values.iter().zip([0.9, 0.1, 0.0, PI - PI / 3.0]) {
        let found = found.unwrap_or_else(|| panic!("{:?}", answers.notes));
        assert!((found - wanted).abs() < 1e-8, "{found} instead of {wanted}");
    }
}

/// A rod that a slider draws nearly straight and lets back again, up to so much before its dead point.
fn nearly_straight(short: f64) -> String {
    format!(
        "mechanism m {{
    ground {{ point O = (0, 0) axis way = O along (1, 0) }}
    body rod at (0, 0, 45 deg) {{ point O = (0, 0) point eye = (1 m, 0) }}
    body slider at (0.7 m, 0, 0) {{ axis slot = (0, 0) along (0, 1) axis way = (0, 0) along (1, 0) }}
    joint main: revolute(ground.O, rod.O)
    joint touch: revolute_translational(rod.eye, slider.slot)
    joint guide: translational(ground.way, slider.way)
    driver pull: displacement(guide) = 1 m - {short:?} m - 1 m/s^2 * (t - 0.5 s)^2
    result a = max(der(der(angle(rod)))) result b = argmax(der(der(angle(rod)))) result c = min(angle(rod))
    result d = at(angle(rod), 0.5 s) result e = rms(der(angle(rod))) result f = a / 2
    result g = max(angle(rod)) result h = first(der(der(angle(rod)))) result i = mean(angle(rod)) result j = max(x(rod.eye)^0 * t)
}}"
    )
}

#[test]
fn values_at_refused_rows_are_null() {
    // at the turn the acceleration is 2 / sin of the angle, whose cosine is 1 − short
    for (short, is_refused) in [(1e-4, false), (1e-6, false), (1e-8, true), (1e-10, true), (1e-12, true)] {
        let text = nearly_straight(short);
        let compiled = compiled("m", &text);
        let mut run = compiled.run(&Times::listed(0.0, vec![0.5]), &RunOptions::default()).0.expect("it assembles");
        assert_eq!(run.next_row().expect("a row").is_err(), is_refused, "{short}");
        let (answers, _) = answers(&text, [1.0, 0.3]);
        let value = |name: &str| answers.values["abcdefghij".find(name).expect("a result")];
        for name in ["a", "b", "c", "d", "f"] {
            assert_eq!(value(name).is_none(), is_refused, "{name} at {short}: {:?}", answers.notes);
        }
        assert!(["g", "h", "i", "j"].into_iter().all(|name| value(name).is_some()), "{short}: {:?}", answers.notes);
        for note in &answers.notes {
            assert!(note.code.as_str() == "N0604" && note.message.contains("too near to a singular one"));
            assert!((note.data["t"].as_f64().expect("a time") - 0.5).abs() < 1e-3);
        }
        if let Some(found) = value("a") {
            let wanted = 2.0 / (short * (2.0 - short)).sqrt();
            assert!((found - wanted).abs() <= 1e-8 * wanted, "{found} instead of {wanted}");
        }
    }
    // of velocities an integral is as uncertain
    let (answers, _) = answers(&nearly_straight(1e-12), [1.0, 0.3]);
    assert_eq!(answers.values[4], None);
}

#[test]
fn names_in_results_have_their_meanings() {
    use mechc::{Category, Choice, Meaning, Memory, Parsed};
    let text = arm("1 rad/s * t", "param mean = 2 measure high = y(arm.tip) result r = mean(high) + max(high) * mean");
    let checked = Parsed::new("m.mech", &text).check(&Choice::default(), &Memory::default());
    assert!(checked.is_sound(), "{:?}", checked.diagnostics());
    let line = text.find("result r").expect("a result");
    let symbols = checked.symbols();
    let of = |word: &str, after: &str| {
        let at = line + text[line..].find(after).expect("it is there") + after.find(word).unwrap_or(0);
        let found = symbols.uses().find(|found| found.span.start as usize == at).expect("a use");
        match found.meaning {
            Meaning::Word(word) => Some(word.category),
            Meaning::Declared(_) => None,
        }
    };
    assert_eq!(of("mean", "mean(high)"), Some(Category::Reduction));
    assert_eq!(of("max", "max(high)"), Some(Category::Reduction));
    assert_eq!(of("mean", "* mean"), None);
}

/// The reference results of a case, to 1e-9 of the numbers.
fn reference(name: &str) {
    let read = |ending: &str| support::text_of(format!("tests/cases_composed/{name}.{ending}"));
    let compiled = compiled(name, &read("mech"));
    let wanted: serde_json::Value = serde_json::from_str(&read("results.json")).expect("JSON");
    let mut run =
        compiled.run(&compiled.times().expect("an analysis"), &RunOptions::default()).0.expect("it assembles");
    while run.next_row().is_some() {}
    let answers = run.results().expect("results");
    let names = compiled.results();
    assert_eq!(wanted.as_object().map(serde_json::Map::len), Some(names.len()));
    for ((name, _), value) in names.iter().zip(&answers.values) {
        let (value, wanted) = (value.expect("a number"), wanted[name].as_f64().expect("a number"));
        assert!((value - wanted).abs() <= 1e-12 * wanted.abs().max(1.0), "{name}: {value} instead of {wanted}");
    }
}

#[test]
fn crank_rocker() {
    reference("crank_rocker");
}

#[test]
fn drawn_four_bar() {
    reference("drawn_four_bar");
}

#[test]
fn leg() {
    reference("leg");
}

/// What is left of `to` behind `from`, added to it again, may be a rounding more than `to`.
#[test]
fn the_end_is_reached_despite_rounding() {
    let text =
        arm("t", "result at_end = last(x(arm.tip)) result least = min(x(arm.tip)) result area = integral(y(arm.tip))");
    let compiled = compiled("m", &text);
    let mut beyond = 0;
    for k in 0..60 {
        let (from, to) = (0.12, 1.0 + f64::from(k) * 0.0061);
        beyond += usize::from(from + (to - from) > to);
        let times = Times::grid(from, to, 0.1).expect("a grid");
        let mut run = compiled.run(&times, &RunOptions::default()).0.expect("it assembles");
        while let Some(row) = run.next_row() {
            row.expect("it moves");
        }
        let answers = run.results().expect("results of a grid");
        let values: Vec<f64> = answers.values.iter().map(|value| value.unwrap_or(f64::NAN)).collect();
        let [start, end] = [from, to].map(|angle| sin_cos(angle).1);
        for (found, wanted) in values.iter().zip([end, end, start - end]) {
            assert!((found - wanted).abs() < 1e-12, "to {to}: {values:?} {:?}", answers.notes);
        }
    }
    assert!(beyond > 20, "{beyond}");
}

/// What compares a number that is not there is not there either; unless the other side decides.
#[test]
fn conditions_of_missing_values_are_missing() {
    let text = arm(
        "t",
        "result gone = sqrt(max(x(arm.tip)) / 1 m - 2)
        result ra = if gone > 0 then 1 else 2
        result rb = if not (gone > 0) then 1 else 2
        result rc = if gone > 0 and max(x(arm.tip)) > 5 m then 1 else 2
        result rd = if gone > 0 or max(x(arm.tip)) > 0.5 m then 1 else 2
        result re = if gone > 0 or max(x(arm.tip)) > 5 m then 1 else 2
        result rf = if max(x(arm.tip)) > 0.5 m then 3 else gone
        result rg = min(1 + 0 * gone, 2)",
    );
    let (answers, _) = answers(&text, [1.0, 0.1]);
    let wanted = [None, None, None, Some(2.0), Some(1.0), None, Some(3.0)];
    assert_eq!(answers.values[..7], wanted, "{:?}", answers.notes);
}

/// A driver that comes and goes between two steps, a window about a dead point, a peak of a high power: nothing of that shows at the ends of steps.
#[test]
fn short_events_within_a_step_are_found() {
    let pulse = "if t < 0.2 s then 0 else if t < 0.21 s then 32 * ((t - 0.2 s) / (10 ms))^3 * (1 - (t - 0.2 s) / (10 ms))^3 else 0";
    let text = arm(
        pulse,
        "result a = max(rotation(main)) result b = integral(rotation(main)) result c = max(sqrt(1 + rotation(main)))",
    );
    check(&text, 1.0, &[(0.5, 1e-12), (32.0 * 0.01 / 140.0, 1e-12), (1.5_f64.sqrt(), 1e-12)]);
    let text = arm(
        "2 * pi * (t / 1 s - 0.5)",
        "result a = max(x(arm.tip), from 0.49 s to 0.51 s) result b = argmax(x(arm.tip), from 0.49 s to 0.51 s)
         result c = max((1 - (t / 1 s - 0.3)^2)^100000000) result d = integral((1 - (t / 1 s - 0.3)^2)^100000000)
         result e = integral((x(arm.tip) / 1 m)^100000)
         result f = integral(exp(-((y(arm.tip) / 1 m - 0.3) / 1e-5)^2))",
    );
    // ∫ (1 − x²)ⁿ dx is √π Γ(n + 1)/Γ(n + 3/2), that of cosⁿ over a turn is 2 √(π/(2n)) (1 − 1/(4n)) but for more; and a Gaussian is met twice
    let (n, power): (f64, f64) = (1e8, 1e5);
    let wave = 2.0 * (PI / (2.0 * power)).sqrt() * (1.0 - 0.25 / power) / PI;
    let gauss = 2.0 * 1e-5 * PI.sqrt() / (TAU * (1.0_f64 - 0.09).sqrt());
    let wanted = [(1.0, 1e-13), (0.5, 1e-9), (1.0, 1e-12), ((PI / n).sqrt(), 1e-11), (wave, 1e-11), (gauss, 1e-12)];
    check(&text, 1.0, &wanted);
}

/// Of what exists in a short time alone, the largest value is there; and what exists nowhere has no integral.
#[test]
fn short_lived_values_are_found() {
    let text = arm(
        "t * 1 rad/s",
        "result a = max(sqrt(1 - ((t / 1 s - 0.12345) / 0.003)^2)) result b = argmax(sqrt(1 - ((t / 1 s - 0.12345) / 0.003)^2))
         result c = max(acos(((t / 1 s - 0.27123) / 0.004)^2)) result d = integral(sqrt(1 - ((y(arm.tip) / 1 m - 0.1) / 3e-5)^2))",
    );
    check(&text, 1.0, &[(1.0, 1e-12), (0.12345, 1e-9), (0.5 * PI, 1e-9), (0.5 * PI * 3e-5 / 0.99_f64.sqrt(), 1e-11)]);
    let text = arm("t * 1 rad/s", "result a = integral(sqrt(-1 - t / 1 s)) result b = mean(asin(2 + t / 1 s))");
    assert_eq!(answers(&text, [1.0, 0.1]).0.values, [None, None]);
}

/// What rounding makes of a quotient near a zero of both is neither its extremum nor a pole; and a pole at an end of the window counts in its own
/// direction alone.
#[test]
fn rounding_near_zeros_is_no_extremum() {
    let text = arm(
        "2 * pi * t / 1 s",
        "result a = max(atan2(sin(t / 1 s - 0.5), 1 - cos(t / 1 s - 0.5))) result b = max(acos(1 - (t / 1 s - 0.3)^2) / abs(t / 1 s - 0.3))
         result c = min(acos(cos(t / 1 s - 0.3)) / abs(t / 1 s - 0.3))
         result d = min(sqrt(1 - x(arm.tip) / 1 m) / abs(y(arm.tip) / 1 m), to 0.1 s)
         result e = max(1 / (t / 1 s - 0.5), to 0.5 s) result f = min(tan(pi * t / 1 s), to 0.5 s)
         result g = max((exp(t / 1 s - 0.3) - 1) / (t / 1 s - 0.3)) result h = max(if t < 0.5 s then 1 else 2, to 0.5 s)
         result i = max((t / 1 s - 0.3) / abs(t / 1 s - 0.3)^0.9)",
    );
    let wanted = [
        (0.5 * PI, 2e-6),
        (1.479_445_052_170_385, 1e-9),
        (1.0, 1e-6),
        (0.5_f64.sqrt(), 1e-6),
        (-2.0, 1e-12),
        (0.0, 1e-12),
        (1.448_218_153_529_252, 1e-12),
        (1.0, 0.0),
        (0.964_961_095_119_817_6, 1e-12),
    ];
    check(&text, 1.0, &wanted);
    let text =
        arm("t * 1 rad/s", "result a = max(exp(1 / (t / 1 s - 0.3))) result b = min(ln(1 - cos(t / 1 s - 0.3)))");
    assert_eq!(answers(&text, [1.0, 0.1]).0.values, [None, None]);
}

/// Where a driver turns round, the curvature of a track is a quotient of roundings: it counts in no extremum, nor in the time of one, and is no value.
#[test]
fn noise_at_reversals_is_no_value() {
    let text = arm(
        "1 rad + 0.8 rad * cos(2 rad/s * t)",
        "result a = argmax(curvature(arm.tip) * t, from 1 s to 1.9 s) result b = max(curvature(arm.tip) * t, from 1 s to 1.9 s)
         result c = at(curvature(arm.tip), 1.2 s)",
    );
    check(&text, 2.0, &[(1.9, 1e-9), (1.9, 1e-9), (-1.0, 1e-9)]);
    let text = arm("1 rad + 0.8 rad * cos(2 rad/s * t)", "result a = at(curvature(arm.tip), 1.57079632 s)");
    assert_eq!(answers(&text, [2.0, 0.1]).0.values, [None]);
}

/// A coupler that only shifts: its angle and what becomes of it are nothing but rounding of what moves.
#[test]
fn rests_have_no_spurious_digits() {
    let text = "mechanism parallelogram {
        ground { point A = (0, 0) point D = (100 mm, 0) }
        body crank at (0, 0, 90 deg) { point A = (0, 0) point B = (70 mm, 0) }
        body coupler at (0, 70 mm, 0) { point B = (0, 0) point C = (100 mm, 0) }
        body rocker at (100 mm, 0, 90 deg) { point D = (0, 0) point C = (70 mm, 0) }
        joint a: revolute(ground.A, crank.A)
        joint b: revolute(crank.B, coupler.B)
        joint c: revolute(coupler.C, rocker.C)
        joint d: revolute(ground.D, rocker.D)
        driver motor: rotation(a) = 90 deg + 0.4 rad * sin(3 rad/s * t)
        result turned = max(angle(coupler))
        result rate = max(der(angle(coupler)))
        result mean_rate = mean(der(angle(coupler)))
        result change = max(abs(der(der(angle(coupler)))))
        result crank_rate = max(der(angle(crank)))
        analysis from 0 s to 2 s every 100 ms
    }";
    let (answers, _) = answers(text, [2.0, 0.1]);
    assert_eq!(answers.digits[..4], [0; 4], "{:?}", answers.values);
    assert!(answers.values.iter().all(Option::is_some) && answers.digits[4] >= 12, "{answers:?}");
}
