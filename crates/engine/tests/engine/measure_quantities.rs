//! Quantities of measures alone, against closed forms: velocities, poles, curvatures, contacts, and where they do not exist.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::random::Random;
use crate::support::{Outcome, Span, run};
use mechc_expr::math::{atan2, hypot, sin_cos, sqrt};
use std::f64::consts::{PI, TAU};

/// Largest deviation from the closed form, as a part of the largest number of the column.
const EXACT: f64 = 1e-11;

fn outcome(text: &str) -> Outcome {
    run("m", text, Span::default()).expect_success()
}

/// Holds columns against functions of time.
fn holds(outcome: &Outcome, columns: &[(&str, &dyn Fn(f64) -> f64)]) {
    let times = outcome.column("t");
    for (name, wanted) in columns {
        let wanted: Vec<f64> = times.iter().map(|&t| wanted(t)).collect();
        let largest = wanted.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        for ((found, wanted), t) in outcome.column(name).iter().zip(&wanted).zip(&times) {
            let bound = EXACT * largest.max(1e-3);
            assert!((found - wanted).abs() <= bound, "{name} at {t}: {found}, not {wanted}");
        }
    }
}

/// The slope of a function of time.
fn slope(of: impl Fn(f64) -> f64, t: f64) -> f64 {
    const H: f64 = 1e-3;
    (8.0 * (of(t + H) - of(t - H)) - (of(t + 2.0 * H) - of(t - 2.0 * H))) / (12.0 * H)
}

#[test]
fn a_slider_crank() {
    let (r, l) = (0.05, 0.15);
    let text = "mechanism m {
    ground { point O = (0, 0) axis way = O along (1, 0) }
    body crank at (0, 0, 30 deg) { point O = (0, 0) point pin = (50 mm, 0) }
    body rod at (43 mm, 25 mm, -10 deg) { point pin = (0, 0) point wrist = (150 mm, 0) }
    body slider at (190 mm, 0, 0) { point wrist = (0, 0) axis way = wrist along (1, 0) }
    joint main: revolute(ground.O, crank.O)
    joint big: revolute(crank.pin, rod.pin)
    joint small: revolute(rod.wrist, slider.wrist)
    joint guide: translational(ground.way, slider.way)
    driver motor: rotation(main) = 1 rad/s * t + 0.5
    measure pin_speed = speed(crank.pin)
    measure round = curvature(crank.pin)
    measure other_way = curvature(rod.pin)
    measure straight = curvature(slider.wrist)
    measure x_pole = pole_x(rod)
    measure y_pole = pole_y(rod)
    measure x_of_pin = pole_x(crank, rod)
    measure y_of_pin = pole_y(rod, crank)
    measure at_pin = angle(ground.O, crank.pin, slider.wrist)
    measure back = angle(slider.wrist, crank.pin, ground.O)
    analysis from 0 s to 1 s every 0.05 s
}";
    let outcome = outcome(text);
    let place = |t: f64| {
        let (sin, cos) = sin_cos(t + 0.5);
        (sin, cos, r * cos + sqrt(l * l - r * r * sin * sin))
    };
    // on the crank's line, above the wrist
    let y_pole = |t: f64| place(t).2 * place(t).0 / place(t).1;
    let at_pin = |t: f64| {
        let (sin, cos, x) = place(t);
        let (ux, uy, vx, vy) = (-r * cos, -r * sin, x - r * cos, -r * sin);
        atan2(ux * vy - uy * vx, ux * vx + uy * vy)
    };
    holds(
        &outcome,
        &[
            ("pin_speed", &|_| r),
            ("pin_speed.d", &|_| 0.0),
            ("round", &|_| 1.0 / r),
            ("round.d", &|_| 0.0),
            ("other_way", &|_| 1.0 / r),
            ("straight", &|_| 0.0),
            ("x_pole", &|t| place(t).2),
            ("y_pole", &y_pole),
            ("x_of_pin", &|t| r * place(t).1),
            ("y_of_pin", &|t| r * place(t).0),
            ("y_of_pin.dd", &|t| -r * place(t).0),
            ("at_pin", &at_pin),
            ("back", &|t| -at_pin(t)),
        ],
    );
    for (name, of) in [("y_pole", &y_pole as &dyn Fn(f64) -> f64), ("at_pin", &at_pin)] {
        for (t, found) in outcome.column("t").into_iter().zip(outcome.column(&format!("{name}.d"))) {
            let wanted = slope(of, t);
            assert!((found - wanted).abs() < 1e-6 * wanted.abs().max(1.0), "{name}.d at {t}: {found}, not {wanted}");
        }
    }
}

#[test]
fn the_transmission_angle_of_a_four_bar() {
    let (a, b, c, d) = (0.03, 0.07, 0.06, 0.08);
    let text = "mechanism m {
    ground { point A = (0, 0) point D = (80 mm, 0) }
    body crank at (0, 0, 40 deg) { point A = (0, 0) point B = (30 mm, 0) }
    body coupler at (23 mm, 19 mm, 33 deg) { point B = (0, 0) point C = (70 mm, 0) }
    body rocker at (80 mm, 0, 88 deg) { point D = (0, 0) point C = (60 mm, 0) }
    joint main: revolute(ground.A, crank.A)
    joint pin: revolute(crank.B, coupler.B)
    joint knee: revolute(coupler.C, rocker.C)
    joint pivot: revolute(ground.D, rocker.D)
    driver motor: rotation(main) = 40 deg + 1 rev/s * t
    measure mu = angle(coupler.B, coupler.C, rocker.D)
    measure in_line = pole_y(rocker, crank)
    measure ratio = pole_x(rocker, crank) / (pole_x(rocker, crank) - 80 mm) * der(rotation(main)) - der(rotation(pivot))
    analysis from 0 s to 1 s every 0.04 s
}";
    let theta = |t: f64| PI * 40.0 / 180.0 + TAU * t;
    let cos_mu = |t: f64| (b * b + c * c - a * a - d * d + 2.0 * a * d * sin_cos(theta(t)).1) / (2.0 * b * c);
    let sin_mu = |t: f64| sqrt(1.0 - cos_mu(t) * cos_mu(t));
    holds(
        &outcome(text),
        &[
            ("mu", &|t| atan2(sin_mu(t), cos_mu(t))),
            ("mu.d", &|t| a * d * TAU * sin_cos(theta(t)).0 / (b * c * sin_mu(t))),
            // the three centres lie on one line, and divide it in the ratio of the speeds
            ("in_line", &|_| 0.0),
            ("ratio", &|_| 0.0),
        ],
    );
}

/// An eccentric disc, 10 mm off its centre and of a radius of 30 mm, under a tappet.
fn eccentric(start: &str, tappet: &str, joint: &str) -> String {
    format!(
        "mechanism m {{
    ground {{ point O = (0, 0) axis way = (0, 0) along (0, 1) }}
    body disc {{ point O = (0, 0) circle rim = (10 mm, 0) radius 30 mm }}
    body tappet at (0, 40 mm, 0) {{ point tip = (0, 0) axis way = (0, 0) along (0, 1) {tappet} }}
    joint axle: revolute(ground.O, disc.O)
    joint guide: translational(ground.way, tappet.way)
    joint touch: {joint}
    driver motor: rotation(axle) = 2 rad/s * t + {start}
    measure steep = pressure_angle(touch, tappet)
    measure rub = slip(touch)
    analysis from 0 s to 1 s every 0.05 s
}}"
    )
}

/// Returns the position and velocity of a tappet's point that keeps the distance `reach` (m) from the disc's centre.
fn lift(reach: f64, phi: f64) -> (f64, f64) {
    let (sin, cos) = sin_cos(phi);
    let root = sqrt(reach * reach - 1e-4 * cos * cos);
    (0.01 * sin + root, 2.0 * (0.01 * cos + 1e-4 * cos * sin / root))
}

#[test]
fn a_point_that_slides_on_an_eccentric() {
    let outcome = outcome(&eccentric("0.3", "", "point_follower(tappet.tip, disc.rim)"));
    let phi = |t: f64| 2.0 * t + 0.3;
    let steep = |t: f64| {
        let sin = (0.01 * sin_cos(phi(t)).1).abs() / 0.03;
        atan2(sin, sqrt(1.0 - sin * sin))
    };
    // the disc's point moves across, the tip up
    let rub = |t: f64| {
        let (height, speed) = lift(0.03, phi(t));
        hypot(2.0 * height, speed)
    };
    holds(&outcome, &[("steep", &steep), ("rub", &rub)]);
    for (name, of) in [("steep.d", &steep as &dyn Fn(f64) -> f64), ("rub.d", &rub)] {
        for (t, found) in outcome.column("t").into_iter().zip(outcome.column(name)) {
            // beside the dead point the absolute value has a kink
            if (phi(t) - PI / 2.0).abs() > 0.02 {
                assert!((found - slope(of, t)).abs() < 1e-7, "{name} at {t}: {found}, not {}", slope(of, t));
            }
        }
    }
}

#[test]
fn a_cam_with_a_roller() {
    let text = eccentric("0.3", "circle roller = (0, 0) radius 8 mm", "cam(disc.rim, tappet.roller)");
    let text = text.replace("(0, 40 mm, 0)", "(0, 45 mm, 0)");
    let phi = |t: f64| 2.0 * t + 0.3;
    let steep = |t: f64| {
        let sin = (0.01 * sin_cos(phi(t)).1).abs() / 0.038;
        atan2(sin, sqrt(1.0 - sin * sin))
    };
    let rub = |t: f64| {
        let ((sin, cos), (height, speed)) = (sin_cos(phi(t)), lift(0.038, phi(t)));
        let (nx, ny) = (-0.01 * cos / 0.038, (height - 0.01 * sin) / 0.038);
        let (x, y) = (0.01 * cos + 0.03 * nx, 0.01 * sin + 0.03 * ny);
        let (vx, vy) = (2.0 * y, speed - 2.0 * x);
        (vx * ny - vy * nx).abs()
    };
    holds(&outcome(&text), &[("steep", &steep), ("rub", &rub)]);
}

#[test]
fn a_flat_face_on_an_eccentric() {
    let text = eccentric("0.3", "axis face = (0, 0) along (1, 0)", "flat_follower(disc.rim, tappet.face)");
    let outcome = outcome(&text);
    let rub = |t: f64| 2.0 * (0.01 * sin_cos(2.0 * t + 0.3).0 + 0.03);
    holds(&outcome, &[("rub", &rub), ("rub.d", &|t| 0.04 * sin_cos(2.0 * t + 0.3).1), ("steep", &|_| 0.0)]);
}

#[test]
fn missing_values_are_empty_cells() {
    let text = "mechanism m {
    ground { point O = (0, 0) axis way = O along (1, 0) }
    body slide { point P = (20 mm, 0) point Q = (60 mm, 0) axis way = (0, 0) along (1, 0) }
    joint guide: translational(ground.way, slide.way)
    driver push: displacement(guide) = 10 mm * cos(pi / 1 s * t)
    measure far = pole_y(slide)
    measure bend = curvature(slide.P)
    measure bend_and_more = 1 + 2 * bend / 1 m^-1
    measure twice = der(bend)
    measure guarded = if t > 0.25 s and t < 0.75 s then curvature(slide.P) else 0
    measure corner = angle(slide.P, slide.P, slide.Q)
    measure fast = speed(slide.P)
    analysis from 0 s to 1 s every 0.5 s
}";
    let outcome = outcome(text);
    let is_there = |name: &str| outcome.column(name).iter().map(|value| value.is_finite()).collect::<Vec<bool>>();
    for name in ["far", "far.d", "far.dd", "corner", "corner.d"] {
        assert_eq!(is_there(name), [false; 3], "{name}");
    }
    // it rests at both ends
    for name in ["bend", "bend.d", "bend_and_more", "twice"] {
        assert_eq!(is_there(name), [false, true, false], "{name}");
    }
    for name in ["guarded", "guarded.d", "fast", "slide.x.dd"] {
        assert_eq!(is_there(name), [true; 3], "{name}");
    }
    assert!((outcome.column("fast")[1] - 0.01 * PI).abs() < 1e-12);
    let warnings: Vec<&str> = outcome.diagnostics.iter().map(|message| message.message.as_str()).collect();
    assert!(warnings.iter().any(|text| text.contains("`far`") && text.contains("t = 0 s")), "{warnings:?}");
}

#[test]
fn opposite_arms_are_at_pi_from_either_side() {
    let text = "mechanism m {
    ground { point O = (0, 0) }
    body arm { point O = (0, 0) point P = (20 mm, 0) point Q = (-30 mm, 0) point R = (0, -5 mm) }
    joint main: revolute(ground.O, arm.O)
    driver motor: rotation(main) = 0 * t
    measure a = angle(arm.P, arm.O, arm.Q)
    measure b = angle(arm.Q, arm.O, arm.P)
    measure c = angle(arm.P, arm.O, arm.R)
    measure d = angle((1 m, 0), (0, 0), (-1 m, 0))
    measure e = angle((-1 m, 0), (0, 0), (1 m, 0))
    measure zero = angle(arm.P, arm.O, arm.P)
    analysis from 0 s to 1 s every 1 s
}";
    let outcome = outcome(text);
    for (name, wanted) in [("a", PI), ("b", PI), ("c", -PI / 2.0), ("d", PI), ("e", PI), ("zero", 0.0)] {
        assert_eq!(outcome.column(name)[0], wanted, "{name}");
        assert_eq!(outcome.column(&format!("{name}.d"))[0], 0.0, "{name}.d");
    }
}

#[test]
fn a_function_or_table_of_that_name_hides_the_quantity() {
    let text = "mechanism m {
    param curvature = 3
    fn speed(u) = 2 * u
    table slip = spline [(0, 1), (4, 1)]
    fn pole_x(u) = u + 1
    ground { point O = (0, 0) }
    body pole_y { point O = (0, 0) point P = (50 mm, 0) }
    joint pressure_angle: revolute(ground.O, pole_y.O)
    driver motor: rotation(pressure_angle) = speed(t)
    measure a = speed(curvature) + slip(2) + pole_x(1)
    measure b = curvature(pole_y.P) / curvature
    measure pole = pole_y(pole_y)
    analysis from 0 s to 1 s every 0.5 s
}";
    let outcome = outcome(text);
    assert_eq!(outcome.column("a"), [9.0; 3]);
    holds(&outcome, &[("b", &|_| 20.0 / 3.0), ("pole", &|_| 0.0), ("pole_y.phi", &|t| 2.0 * t)]);
}

/// A body that turns, and another that rests relative to it, or turns against it, as a declaration says; with the pole of the second relative
/// to the first.
fn pair(random: &mut Random, declarations: &str) -> Outcome {
    let (amplitude, pace, start) = (random.between(0.2, 2.0), random.between(0.5, 5.0), random.between(-3.0, 3.0));
    let (x, y) = (random.between(-0.1, 0.1), random.between(-0.1, 0.1));
    outcome(&format!(
        "mechanism m {{
            ground {{ point O = (0, 0) }}
            body a {{ point O = (0, 0) point P = ({x}, {y}) axis w = P along ({y}, 1) }}
            body c at ({x}, {y}, 0) {{ point P = (0, 0) axis w = P along ({y}, 1) }}
            joint j: revolute(ground.O, a.O)
            driver d: rotation(j) = {start} + {amplitude} * sin({pace} * t)
            {declarations}
            measure px = pole_x(c, a)
            measure py = pole_y(c, a)
            analysis from 0 to 1 every 0.01
        }}"
    ))
}

#[test]
fn relative_rest_has_no_pole() {
    let mut random = Random::new(7);
    for _ in 0..12 {
        let far = random.between(0.0, 0.1);
        for declarations in [
            "joint g: weld(a.P, c.P)".to_owned(),
            format!("joint g: translational(a.w, c.w) driver e: displacement(g) = step5(t, 0.2, 0, 0.5, {far})"),
            format!("joint g: translational(a.w, c.w) driver e: displacement(g) = {far} * sin(9 * t)"),
            format!("joint g: revolute(a.P, c.P) driver e: rotation(g) = {far}"),
        ] {
            let found = pair(&mut random, &declarations);
            for name in ["px", "py"] {
                assert!(
                    found.column(name).iter().all(|value| value.is_nan()),
                    "{declarations}: {:?}",
                    found.column(name)
                );
            }
        }
    }
}

#[test]
fn slow_rotation_has_a_pole() {
    let mut random = Random::new(8);
    for pace in [1e-3, 1e-6, 1e-9] {
        for _ in 0..4 {
            let found = pair(&mut random, &format!("joint g: revolute(a.P, c.P) driver e: rotation(g) = {pace} * t"));
            let (x, y) = (found.column("c.x"), found.column("c.y"));
            for (name, place) in [("px", x), ("py", y)] {
                for (pole, place) in found.column(name).iter().zip(place) {
                    // the rounding of the turning shows as much as that is slower than the whole
                    assert!((pole - place).abs() <= 1e-14 / pace + 1e-12, "{pace}: {pole}, not {place}");
                }
            }
        }
    }
}
