//! Rows near change points, against closed forms: whatever is printed is right, and what else is asked for makes no difference.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::change_points::{equal_rods, parallelogram};
use crate::support::random::Random;
use crate::support::{Outcome, compile, follow};
use mechc::{Diagnostics, RunOptions, Times};
use mechc_expr::math;
use std::f64::consts::{FRAC_PI_2, PI};

/// Promised error of a row's position, velocity and acceleration, relative to its size or 1.
const RIGHT: [f64; 3] = [1e-9, 1e-8, 1e-6];
/// Angles of the crank before the change point (rad).
const DISTANCES: [f64; 13] = [1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 3e-4, 1e-4, 3e-5, 1e-5, 5e-6, 2e-6, 1e-6, 3e-7];

/// A linkage whose crank turns by a law; its change point is where the crank is at `level`.
struct Linkage {
    text: String,
    is_slider: bool,
    length: f64,
    law: Law,
    level: f64,
}

#[derive(Clone, Copy)]
enum Law {
    Uniform {
        start: f64,
        rate: f64,
    },
    /// To an angle and back within a second.
    Back {
        start: f64,
        way: f64,
    },
}

impl Law {
    fn formula(self) -> String {
        match self {
            Law::Uniform { start, rate } => format!("{start} + {rate} * t"),
            Law::Back { start, way } => format!("{start} + {way} * sin(pi * t)^2"),
        }
    }

    /// The crank's angle, speed and acceleration at a time.
    fn at(self, t: f64) -> [f64; 3] {
        match self {
            Law::Uniform { start, rate } => [start + rate * t, rate, 0.0],
            Law::Back { start, way } => {
                let (sin, cos) = math::sin_cos(PI * t);
                [start + way * sin * sin, 2.0 * way * PI * sin * cos, 2.0 * way * PI * PI * (cos * cos - sin * sin)]
            }
        }
    }
}

impl Linkage {
    fn new(is_slider: bool, length: f64, law: Law) -> Linkage {
        let (Law::Uniform { start, .. } | Law::Back { start, .. }) = law;
        let analysis = "analysis from 0 to 1 every 0.1";
        let (text, level) = if is_slider {
            (equal_rods(length, &law.formula(), start, analysis), FRAC_PI_2)
        } else {
            (parallelogram(length, 2.5 * length, &law.formula(), start, analysis), PI)
        };
        Linkage { text, is_slider, length, law, level }
    }

    /// Returns the exact columns at a time (s), each with its derivatives.
    fn truth(&self, t: f64) -> Vec<(&'static str, [f64; 3])> {
        let [angle, speed, bend] = self.law.at(t);
        let (sin, cos) = math::sin_cos(angle);
        let l = self.length;
        let right = [l * cos, -l * sin * speed, -l * (cos * speed * speed + sin * bend)];
        let up = [l * sin, l * cos * speed, l * (cos * bend - sin * speed * speed)];
        let turn = [angle, speed, bend];
        if self.is_slider {
            vec![("rod.phi", turn.map(|x| -x)), ("rod.x", right), ("rod.y", up), ("slider.x", right.map(|x| 2.0 * x))]
        } else {
            vec![("rocker.phi", turn), ("coupler.phi", [0.0; 3]), ("coupler.x", right), ("coupler.y", up)]
        }
    }

    fn run(&self, times: &Times, passing: bool) -> Outcome {
        let (compiled, mut outcome) = compile("text", &self.text);
        outcome.diagnostics = Diagnostics::default();
        let options = RunOptions { pass_bifurcations: passing, ..RunOptions::default() };
        assert!(follow(&compiled.expect("determined"), times, &options, &mut outcome), "{}", outcome.text());
        outcome
    }

    /// Runs, and holds all rows that are printed to the truth; gives how many there are, and the code that ended the run.
    fn hold(&self, times: &Times, passing: bool) -> (usize, &'static str) {
        let outcome = self.run(times, passing);
        for row in &outcome.rows {
            self.hold_row(&outcome.columns, row, passing);
        }
        (outcome.rows.len(), outcome.stop().map_or("", |why| why.code.as_str()))
    }

    fn hold_row(&self, columns: &[String], row: &[f64], passing: bool) {
        let t = row[0];
        for (name, wanted) in self.truth(t) {
            for ((order, wanted), right) in ["", ".d", ".dd"].into_iter().zip(wanted).zip(RIGHT) {
                let column = columns.iter().position(|column| *column == format!("{name}{order}")).expect("a column");
                let off = (row[column] - wanted).abs();
                let left = self.level - self.law.at(t)[0];
                assert!(
                    off <= right * (1.0 + wanted.abs()),
                    "{name}{order} is off by {off:e} at t = {t}, {left:e} before the change point, passing {passing}: {}",
                    self.text
                );
            }
        }
    }
}

/// Several sets of times that end with the same one.
fn sets(t: f64, random: &mut Random) -> Vec<Times> {
    let mut before: Vec<f64> = (0..5).map(|_| t * random.part()).collect();
    before.push(t);
    let lists = [vec![t], vec![0.999 * t, t], vec![t - 1e-5, t], vec![0.5 * t, t - 3e-4, t - 1e-6, t], before];
    let grid = Times::grid(0.0, t, t / 100.0).expect("a grid");
    lists.into_iter().map(|list| Times::listed(0.0, list)).chain([grid]).collect()
}

#[test]
fn rows_before_a_change_point_ignore_other_rows() {
    let mut random = Random::new(31);
    for distance in DISTANCES {
        for is_slider in [false, true] {
            let (length, rate) = (random.between(0.4, 2.5), random.between(0.5, 3.0));
            let start = if is_slider { random.between(1.1, 1.4) } else { random.between(0.8, 2.8) };
            let linkage = Linkage::new(is_slider, length, Law::Uniform { start, rate });
            let t = (linkage.level - random.between(0.9, 1.1) * distance - start) / rate;
            for (number, times) in sets(t, &mut random).iter().enumerate() {
                // where the motion goes on smoothly none is refused
                let (rows, code) = linkage.hold(times, (number % 2 == 0) == is_slider);
                assert_eq!((rows as u64, code), (times.len(), ""), "{distance:e} before, {}", linkage.text);
            }
        }
    }
}

#[test]
fn reversals_near_a_change_point_are_right_or_refused() {
    let mut random = Random::new(37);
    for over in [1e-2, 1e-3, 1e-4, 1e-5, -1e-5, -1e-4, -1e-3, -1e-2] {
        for is_slider in [false, true] {
            let start = if is_slider { 1.4 } else { 1.0 };
            let level = if is_slider { FRAC_PI_2 } else { PI };
            let linkage = Linkage::new(is_slider, 1.0, Law::Back { start, way: level - start + over });
            for t in [0.49, 0.4975, 0.4995, 0.5, 0.506] {
                for (number, times) in sets(t, &mut random).iter().enumerate() {
                    linkage.hold(times, number % 2 == 0);
                    linkage.hold(&Times::listed(0.0, vec![t]), number % 2 == 1);
                }
            }
            for passing in [false, true] {
                linkage.hold(&Times::grid(0.0, 1.0, 0.0017).expect("a grid"), passing);
            }
        }
    }
}

#[test]
fn reversals_beyond_a_change_point_are_reported() {
    for over in [3e-4, 1e-4, 1e-5, 1e-6, 1e-7] {
        for is_slider in [false, true] {
            let start = if is_slider { 1.4 } else { 1.0 };
            let level = if is_slider { FRAC_PI_2 } else { PI };
            let way = level - start + over;
            let linkage = Linkage::new(is_slider, 1.0, Law::Back { start, way });
            // sin² is less than 1 by the part of the way that is beyond
            let before = math::asin((over / way).sqrt()) / PI;
            let is_near =
                |reported: f64, at: f64| assert!((reported - at).abs() < 1e-8, "{reported} for {at}, {}", linkage.text);
            let stop = linkage.run(&Times::listed(0.0, vec![0.5]), false).stop().cloned().expect("it stops");
            assert_eq!(stop.code.as_str(), "E0603");
            is_near(stop.data["t"].as_f64().expect("a time"), 0.5 - before);
            let all = linkage.run(&Times::listed(0.0, vec![0.56]), true);
            assert_eq!(all.passed().len(), 2, "{over:e} beyond: {}", all.text());
            is_near(all.passed()[0], 0.5 - before);
            is_near(all.passed()[1], 0.5 + before);
            // what comes behind the last row is not told
            let first = linkage.run(&Times::listed(0.0, vec![0.5 - 0.5 * before]), true);
            assert_eq!(first.passed().len(), 1, "{over:e} beyond: {}", first.text());
        }
    }
    // one that just comes to it is told once
    for is_slider in [false, true] {
        let (start, way) = if is_slider { (1.4, FRAC_PI_2 - 1.4) } else { (1.0, PI - 1.0) };
        let outcome = Linkage::new(is_slider, 1.0, Law::Back { start, way }).run(&Times::listed(0.0, vec![0.56]), true);
        assert_eq!(outcome.passed().len(), 1, "{}", outcome.text());
    }
}

#[test]
fn change_points_near_the_start_are_passed() {
    for distance in [0.02, 0.01, 3e-3, 1e-3, 1e-4] {
        for is_slider in [false, true] {
            let level = if is_slider { FRAC_PI_2 } else { PI };
            let start = level - distance;
            let linkage = Linkage::new(is_slider, 1.0, Law::Uniform { start, rate: distance });
            let times = Times::grid(0.0, 2.0, 0.05).expect("a grid");
            let passed = linkage.run(&times, true).passed();
            assert!(passed.len() == 1 && (passed[0] - 1.0).abs() < 1e-7, "{passed:?}: {}", linkage.text);
            assert_eq!(linkage.hold(&times, true), (41, ""), "{}", linkage.text);
            let (rows, code) = linkage.hold(&times, false);
            assert!(rows >= 20 && code == "E0603", "{rows} rows, {code}: {}", linkage.text);
        }
    }
}
