//! Rows on the way over singular positions and up to them: against closed forms, against the same run without passing, and
//! measures against the columns of the bodies.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::change_points::{equal_rods, parallelogram};
use crate::support::random::Random;
use crate::support::{compile_number, files, follow};
use mechc::{Diagnostic, Diagnostics, RunOptions, Times};
use mechc_expr::math;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// A run with what stopped it, and when bifurcations were passed (s).
struct Run {
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
    stop: Option<Diagnostic>,
    passed: Vec<f64>,
}

impl Run {
    fn at(&self, row: &[f64], name: &str) -> f64 {
        let at = self.columns.iter().position(|column| column == name);
        row[at.unwrap_or_else(|| panic!("no column {name}"))]
    }

    fn code(&self) -> &'static str {
        self.stop.as_ref().map_or("", |why| why.code.as_str())
    }

    fn stopped_at(&self) -> f64 {
        self.stop.as_ref().and_then(|why| why.data["t"].as_f64()).expect("it stopped at a time")
    }
}

/// Runs the first mechanism of a text, over its own times unless some are given; none where it does not compile or begin.
fn try_run(text: &str, path: &Path, times: Option<Times>, passing: bool) -> Option<Run> {
    let (compiled, mut outcome) = compile_number(path, text, 0);
    let compiled = compiled?;
    let own = compiled.times()?;
    outcome.diagnostics = Diagnostics::default();
    let options = RunOptions { pass_bifurcations: passing, ..RunOptions::default() };
    let has_begun = follow(&compiled, &times.unwrap_or(own), &options, &mut outcome);
    let (stop, passed) = (outcome.stop().cloned(), outcome.passed());
    has_begun.then_some(Run { columns: outcome.columns, rows: outcome.rows, stop, passed })
}

fn run(text: &str, times: Option<Times>, passing: bool) -> Run {
    try_run(text, Path::new("text"), times, passing).expect("it compiles and assembles")
}

/// A slider that pushes its crank of 1 m, with a rod of some length, to `over` beyond the dead point and back.
fn pushed(rod: f64, stroke: f64, over: f64) -> String {
    let reach = 1.0 + rod;
    let x = reach - stroke;
    let phi = math::acos((1.0 + x * x - rod * rod) / (2.0 * x));
    let (sin, cos) = math::sin_cos(phi);
    format!(
        "mechanism pushed {{
            ground {{ point O = (0, 0) axis way = O along (1, 0) }}
            body crank at (0, 0, {phi}) {{ point O = (0, 0) point P = (1, 0) }}
            body rod at ({cos}, {sin}, {}) {{ point P = (0, 0) point W = ({rod}, 0) }}
            body slider at ({x}, 0, 0) {{ point W = (0, 0) axis way = W along (1, 0) }}
            joint A: revolute(ground.O, crank.O)
            joint B: revolute(crank.P, rod.P)
            joint C: revolute(rod.W, slider.W)
            joint D: translational(ground.way, slider.way)
            driver push: x(slider.W) = 1 + {rod} + {over} - {stroke} * (1 - sin(pi * t))
            analysis from 0 to 1 every 0.01
        }}",
        -math::asin(sin / rod)
    )
}

/// Adds measures of every angle and every point of every body to the first mechanism of a text.
fn with_measures(text: &str, with_rates: bool) -> (String, Vec<(String, Vec<String>)>) {
    let end = text.rfind('}').expect("a mechanism");
    let (mut measured, mut bodies) = (text[..end].to_owned(), Vec::new());
    let mut rest = text;
    while let Some(at) = rest.find("body ") {
        let begins_a_word = rest[..at].ends_with(|c: char| c.is_whitespace() || c == '{' || c == '}');
        rest = &rest[at + 5..];
        let (Some(open), true) = (rest.find('{'), begins_a_word) else { continue };
        let Some(name) = rest[..open].split_whitespace().next().filter(|_| rest[..open].contains(" at ")) else {
            continue;
        };
        let inside = &rest[open..open + rest[open..].find('}').expect("it is closed")];
        let words: Vec<&str> = inside.split_whitespace().collect();
        let points = words.windows(2).filter(|pair| pair[0] == "point").map(|pair| pair[1].to_owned());
        let points: Vec<String> = points.filter(|name| name.chars().all(|c| c.is_ascii_alphanumeric())).collect();
        let _ = write!(measured, " measure zz_{name} = angle({name}) measure zs_{name} = sin(angle({name}))");
        if with_rates {
            let _ = write!(measured, " measure zr_{name} = der(angle({name}))");
        }
        for point in &points {
            let _ = write!(measured, " measure zx_{name}_{point} = x({name}.{point})");
            let _ = write!(measured, " measure zy_{name}_{point} = y({name}.{point})");
        }
        bodies.push((name.to_owned(), points));
    }
    (measured + "}", bodies)
}

/// Holds every measure to the columns of its body, on every row.
fn hold_measures(name: &str, run: &Run, bodies: &[(String, Vec<String>)], with_rates: bool) {
    let first = run.rows.first().unwrap_or_else(|| panic!("{name}: no row"));
    let turned =
        |row: &[f64], body: &str, order: &str| ["x", "y", "phi"].map(|c| run.at(row, &format!("{body}.{c}{order}")));
    for row in &run.rows {
        let expect = |column: &str, wanted: f64, size: f64| {
            let got = run.at(row, column);
            let off = (got - wanted).abs();
            assert!(off <= 1e-12 * (1.0 + size), "{name}: {column} at t = {}: {got} instead of {wanted}", row[0]);
        };
        for (body, points) in bodies {
            let [[x, y, phi], [xd, yd, w], [xdd, ydd, a]] = ["", ".d", ".dd"].map(|order| turned(row, body, order));
            let (sin, cos) = math::sin_cos(phi);
            expect(&format!("zz_{body}"), phi, phi.abs());
            expect(&format!("zz_{body}.d"), w, w.abs());
            expect(&format!("zz_{body}.dd"), a, a.abs());
            expect(&format!("zs_{body}.d"), cos * w, w.abs());
            expect(&format!("zs_{body}.dd"), cos * a - sin * w * w, a.abs() + w * w);
            if with_rates {
                expect(&format!("zr_{body}"), w, w.abs());
                expect(&format!("zr_{body}.d"), a, a.abs());
            }
            for point in points {
                // where it is on its body the first row tells
                let [x0, y0, phi0] = turned(first, body, "");
                let (sin0, cos0) = math::sin_cos(phi0);
                let dx = run.at(first, &format!("zx_{body}_{point}")) - x0;
                let dy = run.at(first, &format!("zy_{body}_{point}")) - y0;
                let (u, v) = (cos0 * dx + sin0 * dy, cos0 * dy - sin0 * dx);
                let (rx, ry) = (cos * u - sin * v, sin * u + cos * v);
                let far = x.abs() + y.abs() + rx.abs() + ry.abs();
                let rest = 1e2 * (x0.abs() + y0.abs()) * (a.abs() + w * w);
                let (fast, hard) = (far * (1.0 + w.abs()) + xd.abs() + yd.abs(), xdd.abs() + ydd.abs());
                let hard = hard + (far + rest) * (1.0 + a.abs() + w * w);
                for (axis, value, first, second) in [
                    ("x", x + rx, xd - ry * w, xdd - ry * a - rx * w * w),
                    ("y", y + ry, yd + rx * w, ydd + rx * a - ry * w * w),
                ] {
                    expect(&format!("z{axis}_{body}_{point}"), value, far);
                    expect(&format!("z{axis}_{body}_{point}.d"), first, fast + rest);
                    expect(&format!("z{axis}_{body}_{point}.dd"), second, hard);
                }
            }
        }
    }
}

#[test]
fn measures_agree_with_the_bodies_on_every_row_of_all_cases() {
    let (mut rows, mut points) = (0, 0);
    let all = ["tests/cases", "examples", "tests/ui/run"].map(|folder| files(folder, "mech"));
    for path in all.iter().flatten() {
        let text = fs::read_to_string(path).expect("a text");
        if text.matches("mechanism ").count() != 1 {
            continue;
        }
        let (measured, bodies) = with_measures(&text, false);
        for passing in [false, true] {
            let Some(run) = try_run(&measured, path, None, passing) else { continue };
            if !run.rows.is_empty() {
                hold_measures(&path.display().to_string(), &run, &bodies, false);
                rows += run.rows.len();
                points += bodies.iter().map(|(_, points)| points.len()).sum::<usize>();
            }
        }
    }
    assert!(rows > 10_000 && points > 200, "{rows} rows, {points} points");
}

#[test]
fn rows_across_change_points_match_closed_forms() {
    let mut random = Random::new(7);
    for number in 0..24 {
        let (length, start) = (random.between(0.3, 3.0), random.between(1.2, 1.45));
        let (rate, bend) = (random.between(0.2, 1.5), random.between(0.3, 6.0));
        let angle = format!("{start} + {rate} * t + {bend} * t^2");
        let analysis = "analysis from 0 to 0.6 every 0.0017";
        let is_slider = number % 2 == 0;
        let text = if is_slider {
            equal_rods(length, &angle, start, analysis)
        } else {
            parallelogram(length, random.between(0.5, 3.0), &angle, start + FRAC_PI_2, analysis)
                .replace(&format!("= {start} "), &format!("= {start} + pi / 2 "))
        };
        let (text, bodies) = with_measures(&text, true);
        let run = run(&text, None, true);
        assert_eq!(run.code(), "", "{text}");
        hold_measures(&text, &run, &bodies, true);
        for row in &run.rows {
            let t = row[0];
            let phi = start + rate * t + bend * t * t + if is_slider { 0.0 } else { FRAC_PI_2 };
            let (w, a) = (rate + 2.0 * bend * t, 2.0 * bend);
            let (body, sign) = if is_slider { ("rod", -1.0) } else { ("rocker", 1.0) };
            for (column, wanted) in [("phi", phi), ("phi.d", w), ("phi.dd", a)] {
                let got = run.at(row, &format!("{body}.{column}"));
                let off = (got - sign * wanted).abs();
                assert!(off < 2e-9 * (1.0 + wanted.abs()), "{body}.{column} at t = {t}: off by {off:e} in {text}");
            }
            // the jerk is one of the measures
            let jerk = run.at(row, &format!("zr_{body}.dd"));
            assert!(jerk.abs() < 1e-5 * (1.0 + a), "the jerk at t = {t}: {jerk:e} in {text}");
        }
        let level = if is_slider { FRAC_PI_2 } else { PI };
        let begin = if is_slider { start } else { start + FRAC_PI_2 };
        let at = (-rate + (rate * rate + 4.0 * bend * (level - begin)).sqrt()) / (2.0 * bend);
        assert!((run.passed[0] - at).abs() < 1e-7, "told at {} instead of {at}", run.passed[0]);
    }
}

#[test]
fn overshoots_of_a_dead_point_lock_up() {
    let mut random = Random::new(11);
    for _ in 0..12 {
        let (rod, stroke) = (random.between(1.3, 4.0), random.between(0.1, 0.5));
        for over in [1e-4, 1e-6, 1e-8, 1e-9] {
            let over = over * random.between(1.0, 3.0);
            let text = pushed(rod, stroke, over);
            // 1 − sin πt is 2 sin² of half the angle from the middle
            let at = 0.5 - 2.0 / PI * math::asin((0.5 * over / stroke).sqrt());
            for passing in [false, true] {
                let run = run(&text, None, passing);
                assert_eq!(run.code(), "E0602", "{over:e} beyond with a rod of {rod}");
                let headline = &run.stop.as_ref().expect("it stops").message;
                assert!(headline.contains("locks up"), "{over:e} beyond: {headline}");
                assert!((run.stopped_at() - at).abs() < 1e-9, "{over:e}: {} instead of {at}", run.stopped_at());
                let rows = run.rows.iter().filter(|row| row[0] < at).count();
                assert!(run.passed.is_empty() && rows == run.rows.len() && run.rows[rows - 1][0] > at - 0.01);
            }
        }
        // exactly at it two motions go on
        let run = run(&pushed(rod, stroke, 0.0), None, false);
        assert!(run.stop.expect("it stops").message.contains("rests in a dead point"));
    }
}

#[test]
fn slightly_short_rods_lock_up() {
    let mut random = Random::new(19);
    for short in [1e-4, 1e-6, 1e-8, 1e-9, 1e-10] {
        let (length, short) = (random.between(0.5, 2.0), short * random.between(1.0, 3.0));
        let analysis = "analysis from 0 to 1 every 0.01";
        let text = equal_rods(length, "1.2 + t", 1.2, analysis).replace(
            &format!("point W = ({length}, 0) point side"),
            &format!("point W = ({length} * (1 - {short}), 0) point side"),
        );
        for passing in [false, true] {
            let run = run(&text, None, passing);
            assert_eq!((run.code(), run.passed.len()), ("E0602", 0), "{short:e} shorter");
            // where the crank's height is the rod's length: 1 − sin φ is 2 sin² of half the angle from the top
            let at = FRAC_PI_2 - 2.0 * math::asin((0.5 * short).sqrt()) - 1.2;
            assert!((run.stopped_at() - at).abs() < 1e-9, "{short:e} shorter: {} instead of {at}", run.stopped_at());
        }
        let longer = text.replace(&format!("(1 - {short})"), &format!("(1 + {short})"));
        assert_eq!(run(&longer, None, false).code(), "", "{short:e} longer");
    }
}

#[test]
fn later_events_keep_no_row_back() {
    let mut random = Random::new(13);
    for _ in 0..10 {
        let (rod, stroke) = (random.between(1.3, 4.0), random.between(0.2, 0.6));
        let text = pushed(rod, stroke, 0.0);
        for before in [0.02, 0.004, 0.0005, 0.0001] {
            let t = 0.5 - before;
            let run = run(&text, Some(Times::listed(0.0, vec![t])), false);
            assert_eq!((run.rows.len(), run.code()), (1, ""), "{before} before the dead point in {text}");
            // without cancellation: what is left of the way to the dead point
            let sin = math::sin(0.5 * PI * before);
            let short = 2.0 * stroke * sin * sin;
            let x = 1.0 + rod - short;
            let half = (short * (2.0 * rod - short) / (4.0 * x)).sqrt();
            let wanted = 2.0 * math::asin(half);
            let got = run.at(&run.rows[0], "crank.phi");
            assert!((got - wanted).abs() < 1e-10, "{before} before: {got} instead of {wanted}");
        }
    }
}

#[test]
fn passing_bifurcations_keeps_all_rows() {
    let mut random = Random::new(17);
    for number in 0..30 {
        let (length, start) = (random.between(0.5, 2.0), random.between(1.2, 1.5));
        let (over, rate) = (random.between(0.003, 0.3), random.between(1.0, 4.0));
        let angle = format!("{start} + (pi / 2 - {start} + {over}) * sin({rate} * t)^2");
        let every = random.between(0.0007, 0.02);
        let analysis = format!("analysis from 0 to 1 every {every}");
        let text = if number % 2 == 0 {
            equal_rods(length, &angle, start, &analysis)
        } else {
            parallelogram(length, 2.0, &format!("pi / 2 + {angle}"), start + FRAC_PI_2, &analysis)
        };
        compare_with_passing(&text, Path::new("text"));
    }
}

#[test]
fn the_cases_have_the_same_rows_with_passing() {
    for path in ["tests/cases", "examples", "tests/ui/run"].iter().flat_map(|folder| files(folder, "mech")) {
        let text = fs::read_to_string(&path).expect("a text");
        compare_with_passing(&text, &path);
    }
}

fn compare_with_passing(text: &str, path: &Path) {
    let (Some(plain), Some(passing)) = (try_run(text, path, None, false), try_run(text, path, None, true)) else {
        return;
    };
    let (n, m) = (plain.rows.len(), passing.rows.len());
    assert!(n <= m, "{n} rows, and {m} with passing: {text}");
    for (a, b) in plain.rows.iter().zip(&passing.rows) {
        for (k, (a_k, b_k)) in a.iter().zip(b).enumerate() {
            // accelerations beside a singular position have fewest digits
            let tolerance = if plain.columns[k].contains(".dd") { 1e-4 } else { 1e-7 };
            // a measure without a value has none on either way
            if a_k.is_nan() && b_k.is_nan() {
                continue;
            }
            let off = (a_k - b_k).abs();
            // a measure may have no value
            let is_near = off <= tolerance * (1.0 + a_k.abs()) || (a_k.is_nan() && b_k.is_nan());
            assert!(is_near, "{} at t = {}: {a_k} and {b_k}", plain.columns[k], a[0]);
        }
    }
}
