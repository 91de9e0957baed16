//! How near a singular position is said to be must not depend on the unit, the place of the origin, where frames lie in their
//! bodies, what is drawn beside the equations, or the size of one body against the others.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking
#![allow(clippy::disallowed_methods)] // what is written into a text needs no bits of its own

use crate::support::{Outcome, Span, run};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use std::fmt::Write;

/// Changes to the text of a mechanism that keep its motion.
#[derive(Clone, Copy, Debug)]
struct Change {
    /// Factor of all lengths.
    unit: f64,
    /// New origin (in lengths of the mechanism).
    origin: [f64; 2],
    /// Distance by which frames move within their bodies.
    frame: f64,
    /// Distance from each body's first point to an unused one.
    unused: Option<f64>,
    /// Factor of the size of one body whose size is free.
    size: f64,
}

const NONE: Change = Change { unit: 1.0, origin: [0.0; 2], frame: 0.0, unused: None, size: 1.0 };

/// Changes that leave the motion as it is.
fn changes() -> Vec<Change> {
    let mut all = Vec::new();
    for factor in [1e-6, 1e-3, 1e3, 1e6] {
        all.push(Change { unit: factor, ..NONE });
        all.push(Change { unused: Some(factor), ..NONE });
        all.push(Change { unit: 1e-3, unused: Some(factor), ..NONE });
    }
    all.extend([1e3, 1e6].map(|way| Change { origin: [way, -0.3 * way], ..NONE }));
    all.extend([10.0, 100.0, 1e4].map(|frame| Change { frame, ..NONE }));
    all
}

/// A text that grows, of a mechanism whose bodies are placed as the change has it.
struct Text {
    change: Change,
    written: String,
    bodies: usize,
}

impl Text {
    fn new(change: Change, ground: &[(&str, [f64; 2])], axis: &str) -> Text {
        let mut text = Text { change, written: "mechanism m {\n ground {".to_owned(), bodies: 0 };
        for (name, at) in ground {
            let [x, y] = [0, 1].map(|k| (at[k] + change.origin[k]) * change.unit);
            write!(text.written, " point {name} = ({x:?}, {y:?})").unwrap();
        }
        writeln!(text.written, " {axis} }}").unwrap();
        text
    }

    fn body(&mut self, name: &str, [x, y, phi]: [f64; 3], points: &[(&str, [f64; 2])], more: &str) {
        let Change { unit, origin, frame, unused, .. } = self.change;
        self.bodies += 1;
        let way = self.bodies as f64;
        let moved = [frame * way.cos(), frame * way.sin()];
        let at = [
            x + origin[0] + moved[0] * phi.cos() - moved[1] * phi.sin(),
            y + origin[1] + moved[0] * phi.sin() + moved[1] * phi.cos(),
        ];
        let local = |at: [f64; 2]| [0, 1].map(|k| (at[k] - moved[k]) * unit);
        write!(self.written, " body {name} at ({:?}, {:?}, {phi:?}) {{", at[0] * unit, at[1] * unit).unwrap();
        for (name, at) in points {
            let [x, y] = local(*at);
            write!(self.written, " point {name} = ({x:?}, {y:?})").unwrap();
        }
        if let Some(way) = unused {
            let [x, y] = local([points[0].1[0] + way, points[0].1[1]]);
            write!(self.written, " point unused = ({x:?}, {y:?})").unwrap();
        }
        writeln!(self.written, " {more} }}").unwrap();
    }

    fn line(&mut self, line: &str) {
        writeln!(self.written, " {line}").unwrap();
    }

    fn length(&self, value: f64) -> f64 {
        value * self.change.unit
    }

    /// Drives the first joint from an angle on (rad).
    fn driven(mut self, from: f64) -> String {
        self.line(&format!("driver d: rotation(A) = {from:?} + 2 * t"));
        self.written + " analysis from 0 to 3 every 0.5\n}"
    }
}

/// A crank-rocker: its four lengths, and the angle of its crank; with a rod, or a distance for one.
fn four_bar(change: Change, [a, b, c, d]: [f64; 4], crank: f64, has_rod: bool) -> String {
    let pin = [a * crank.cos(), a * crank.sin()];
    let (way, towards) = ((d - pin[0]).hypot(pin[1]), (-pin[1]).atan2(d - pin[0]));
    let rod = towards + ((b * b + way * way - c * c) / (2.0 * b * way)).acos();
    let joint = [pin[0] + b * rod.cos(), pin[1] + b * rod.sin()];
    let rocker = joint[1].atan2(joint[0] - d);
    let mut text = Text::new(change, &[("O", [0.0; 2]), ("D", [d, 0.0])], "");
    text.body("crank", [0.0, 0.0, crank], &[("O", [0.0; 2]), ("P", [a, 0.0])], "");
    text.body("rocker", [d, 0.0, rocker], &[("D", [0.0; 2]), ("C", [c, 0.0])], "");
    text.line("joint A: revolute(ground.O, crank.O)");
    text.line("joint D: revolute(ground.D, rocker.D)");
    if has_rod {
        text.body("rod", [pin[0], pin[1], rod], &[("P", [0.0; 2]), ("C", [b, 0.0])], "");
        text.line("joint B: revolute(crank.P, rod.P)");
        text.line("joint C: revolute(rod.C, rocker.C)");
    } else {
        let length = text.length(b);
        text.line(&format!("joint B: revolute_revolute(crank.P, rocker.C, {length:?})"));
    }
    text.driven(crank)
}

/// A slider-crank whose way has a direction; the slider's axis begins beside its pin by a length that may be any.
fn slider_crank(change: Change, [a, b, offset]: [f64; 3], [crank, tilt]: [f64; 2]) -> String {
    let turned = |[x, y]: [f64; 2]| [x * tilt.cos() - y * tilt.sin(), x * tilt.sin() + y * tilt.cos()];
    let pin = [a * crank.cos(), a * crank.sin()];
    let rod = ((offset - pin[1]) / b).asin();
    let slider = turned([pin[0] + b * rod.cos(), offset]);
    let way = format!("axis x = E along ({:?}, {:?})", tilt.cos(), tilt.sin());
    let mut text = Text::new(change, &[("O", [0.0; 2]), ("E", turned([0.0, offset]))], &way);
    let pin = turned(pin);
    text.body("crank", [0.0, 0.0, crank + tilt], &[("O", [0.0; 2]), ("P", [a, 0.0])], "");
    text.body("rod", [pin[0], pin[1], rod + tilt], &[("P", [0.0; 2]), ("W", [b, 0.0])], "");
    let points = [("W", [0.0; 2]), ("X", [0.1 * change.size, 0.0])];
    text.body("slider", [slider[0], slider[1], tilt], &points, "axis x = X along (1, 0)");
    for line in ["A: revolute(ground.O, crank.O)", "B: revolute(crank.P, rod.P)", "C: revolute(rod.W, slider.W)"] {
        text.line(&format!("joint {line}"));
    }
    text.line("joint D: translational(ground.x, slider.x)");
    text.driven(crank + tilt)
}

/// An open chain, each joint driven; one of its links may be of any size.
fn chain(change: Change, links: &[[f64; 3]], any: usize) -> String {
    let mut text = Text::new(change, &[("O", [0.0; 2])], "");
    let (mut at, mut phi, mut before) = ([0.0; 2], 0.0_f64, "ground.O".to_owned());
    for (k, &[length, turn, speed]) in links.iter().enumerate() {
        let length = if k == any { length * change.size } else { length };
        phi += turn;
        text.body(&format!("b{k}"), [at[0], at[1], phi], &[("P", [0.0; 2]), ("Q", [length, 0.0])], "");
        text.line(&format!("joint j{k}: revolute({before}, b{k}.P)"));
        text.line(&format!("driver d{k}: rotation(j{k}) = {turn:?} + {speed:?} * t"));
        at = [at[0] + length * phi.cos(), at[1] + length * phi.sin()];
        before = format!("b{k}.Q");
    }
    text.written + " analysis from 0 to 3 every 0.5\n}"
}

/// A plate of any size that three links of given lengths hold.
fn plate(change: Change, pose: [f64; 3]) -> String {
    let size = 0.3 * change.size;
    let (ground, own) = ([[-1.0, -0.8], [1.2, -0.9], [0.1, 1.3]], [[0.0, 0.0], [size, 0.0], [0.4 * size, 0.8 * size]]);
    let names = ["P", "Q", "R"];
    let mut text = Text::new(change, &[0, 1, 2].map(|k| (names[k], ground[k])), "");
    text.body("plate", pose, &[0, 1, 2].map(|k| (names[k], own[k])), "");
    for (k, name) in names.iter().enumerate() {
        let [x, y] = own[k];
        let (sin, cos) = pose[2].sin_cos();
        let way = [pose[0] + x * cos - y * sin - ground[k][0], pose[1] + x * sin + y * cos - ground[k][1]];
        let length = text.length(way[0].hypot(way[1]));
        text.line(&format!("driver l{name}: distance(ground.{name}, plate.{name}) = {length:?}"));
    }
    text.written + " analysis from 0 to 1 every 0.5\n}"
}

/// Two gears, the first driven.
fn gears(change: Change, radii: [f64; 2]) -> String {
    let mut text = Text::new(change, &[("O", [0.0; 2]), ("D", [radii[0] + radii[1], 0.0])], "");
    for (name, at, radius) in [("first", 0.0, radii[0]), ("second", radii[0] + radii[1], radii[1])] {
        let circle = format!("circle c = O radius {:?}", text.length(radius));
        text.body(name, [at, 0.0, 0.0], &[("O", [0.0; 2])], &circle);
    }
    text.line("joint A: revolute(ground.O, first.O)");
    text.line("joint B: revolute(ground.D, second.O)");
    text.line("joint C: gear(first.c, second.c)");
    text.driven(0.0)
}

/// Runs it; the errors are told by their codes.
fn outcome(text: &str) -> (Outcome, Vec<&'static str>) {
    let outcome = run("text", text, Span::default());
    let codes = outcome.codes().into_iter().filter(|code| code.starts_with('E')).collect();
    (outcome, codes)
}

/// The angles of all rows.
fn angles(outcome: &Outcome) -> Vec<f64> {
    let is_angle = |name: &str| name.contains(".phi");
    let columns: Vec<usize> = (0..outcome.columns.len()).filter(|&k| is_angle(&outcome.columns[k])).collect();
    let mut names: Vec<(&str, usize)> = columns.iter().map(|&k| (outcome.columns[k].as_str(), k)).collect();
    names.sort_unstable();
    outcome.rows.iter().flat_map(|row| names.iter().map(|&(_, k)| row[k]).collect::<Vec<f64>>()).collect()
}

/// Checks that a mechanism has the same motion in every way of writing it.
fn goes_the_same_way(write: impl Fn(Change) -> String) -> Result<(), TestCaseError> {
    let (plain, codes) = outcome(&write(NONE));
    prop_assert!(codes.is_empty(), "{}\n{}", plain.text(), write(NONE));
    let expected = angles(&plain);
    for change in changes() {
        let (changed, codes) = outcome(&write(change));
        prop_assert!(codes.is_empty(), "{change:?}: {}\n{}", changed.text(), write(change));
        let found = angles(&changed);
        prop_assert_eq!(found.len(), expected.len());
        // coordinates hold what rounding leaves of them, and what turns about a far origin is met to a part of its lever
        let tolerance = f64::max(1e-9, f64::max(1e-12 * change.frame, 1e-13 * change.origin[0]));
        for (a, b) in found.iter().zip(&expected) {
            prop_assert!((a - b).abs() <= tolerance * (1.0 + b.abs()), "{change:?}: {a} and {b}\n{}", write(change));
        }
    }
    Ok(())
}

/// Checks that the motion continues for every size of one of its bodies.
fn goes_on_at_any_size(factors: &[f64], write: impl Fn(Change) -> String) -> Result<(), TestCaseError> {
    for &size in factors {
        let text = write(Change { size, ..NONE });
        let (outcome, codes) = outcome(&text);
        prop_assert!(codes.is_empty(), "{}\n{text}", outcome.text());
    }
    Ok(())
}

const ANY_SIZE: [f64; 6] = [1e-6, 1e-3, 1e-1, 1e1, 1e3, 1e6];

fn check<S: Strategy>(strategy: S, test: impl Fn(S::Value) -> Result<(), TestCaseError>) {
    let config = Config { cases: 6, failure_persistence: None, rng_seed: RngSeed::Fixed(7), ..Config::default() };
    TestRunner::new(config).run(&strategy, test).unwrap_or_else(|failure| panic!("{failure}"));
}

/// Lengths of a crank-rocker, well clear of a change point.
fn crank_rocker() -> impl Strategy<Value = [f64; 4]> {
    (0.2..0.5, 1.0..1.4, 1.0..1.4, 0.9..1.2).prop_map(|(a, b, c, d)| [a, b, c, d]).prop_filter("it turns", |l| {
        let mut sorted = *l;
        sorted.sort_by(f64::total_cmp);
        sorted[0] + sorted[3] + 0.05 < sorted[1] + sorted[2]
    })
}

#[test]
fn four_bar_branches_do_not_depend_on_notation() {
    check((crank_rocker(), 0.0..6.0, any::<bool>()), |(lengths, crank, has_rod)| {
        goes_the_same_way(|change| four_bar(change, lengths, crank, has_rod))
    });
}

#[test]
fn slider_crank_branches_do_not_depend_on_notation() {
    check(((0.2..0.6, 1.0..3.0, -0.2..0.2), (0.0..6.0, -1.0..1.0)), |((a, b, offset), (crank, tilt))| {
        let write = |change| slider_crank(change, [a, b, offset], [crank, tilt]);
        goes_the_same_way(write)?;
        goes_on_at_any_size(&ANY_SIZE, write)
    });
}

#[test]
fn open_chains_do_not_depend_on_notation() {
    let link = (0.3..1.5, -3.0..3.0, -2.0..2.0).prop_map(|(length, turn, speed)| [length, turn, speed]);
    check((prop::collection::vec(link, 2..5), 0..2_usize), |(links, any)| {
        let write = |change| chain(change, &links, any);
        goes_the_same_way(write)?;
        goes_on_at_any_size(&ANY_SIZE, write)
    });
}

#[test]
fn plates_on_three_links_stay_the_same_way_however_they_are_written() {
    check((-0.1..0.1, -0.1..0.1, 0.05..0.2), |(x, y, phi)| {
        let write = |change| plate(change, [x, y, phi]);
        goes_the_same_way(write)?;
        goes_on_at_any_size(&[1e-6, 1e-3, 1e-1], write)
    });
}

#[test]
fn gears_do_not_depend_on_notation() {
    check((0.2..0.6, 0.2..0.9), |(first, second)| goes_the_same_way(|change| gears(change, [first, second])));
}

#[test]
fn a_steep_constraint_is_not_near_a_singular_position() {
    for x in [1.0, 3000.0, 1e5, 1e6] {
        let text = format!(
            "mechanism m {{ body b at ({x}, {}, 0) {{ point P = (0, 0) }}
            driver d: x(b.P) = {x} + t constraint k: y(b.P) = x(b.P)^2 driver a: angle(b) = t
            analysis from 0 to 1 every 0.5 }}",
            x * x
        );
        outcome(&text).0.expect_success();
    }
}

#[test]
fn dead_points_do_not_depend_on_notation() {
    // the rod pushes its crank through the line of both
    for change in changes().into_iter().filter(|change| change.frame < 1e3 && change.origin[0] < 1e5) {
        let text = slider_crank(change, [0.5, 2.0, 0.0], [0.7, 0.3]);
        let slider = (4.0 - (0.5 * 0.7_f64.sin()) * (0.5 * 0.7_f64.sin())).sqrt() + 0.5 * 0.7_f64.cos();
        let driver = text.find(" driver").expect("its driver");
        let (start, speed) = (slider * change.unit, 0.5 * change.unit);
        let by_slider = format!(
            "{} driver d: distance(ground.O, slider.W) = {start:?} + {speed:?} * t\n analysis from 0 to 3 every 0.5\n}}",
            &text[..driver]
        );
        let (outcome, codes) = outcome(&by_slider);
        assert_eq!(codes, ["E0602"], "{change:?}: {}\n{by_slider}", outcome.text());
    }
}

#[test]
fn change_points_do_not_depend_on_notation() {
    for change in changes().into_iter().filter(|change| change.frame < 1e3 && change.origin[0] < 1e5) {
        for (crank, expected) in [(0.0, "E0504"), (2.0, "E0603")] {
            let text = four_bar(change, [0.5, 1.2, 0.5, 1.2], crank, true);
            let (outcome, codes) = outcome(&text);
            assert_eq!(codes, [expected], "{change:?}, {crank}: {}\n{text}", outcome.text());
        }
    }
}

#[test]
fn many_small_four_bars_far_apart_are_not_near_a_singular_position() {
    let mut text = "mechanism many {\n".to_owned();
    let (mut ground, mut rest) = (String::new(), String::new());
    for k in 0..60 {
        // a hand's breadth each, ten kilometres apart
        let (x, y) = (1e4 * f64::from(k % 8), 1e4 * f64::from(k / 8));
        let [a, b, c, d] = [0.02, 0.06, 0.05, 0.07];
        let pin = [a * 1.0_f64.cos(), a * 1.0_f64.sin()];
        write!(ground, " point O{k} = ({x:?}, {y:?}) point D{k} = ({:?}, {y:?})", x + d).unwrap();
        write!(
            rest,
            " body a{k} at ({x:?}, {y:?}, 1) {{ point O = (0, 0) point P = ({a}, 0) }}
            body b{k} at ({:?}, {:?}, 0.5) {{ point P = (0, 0) point C = ({b}, 0) }}
            body c{k} at ({:?}, {y:?}, 1.8) {{ point D = (0, 0) point C = ({c}, 0) }}
            joint A{k}: revolute(ground.O{k}, a{k}.O) joint B{k}: revolute(a{k}.P, b{k}.P)
            joint C{k}: revolute(b{k}.C, c{k}.C) joint D{k}: revolute(ground.D{k}, c{k}.D)
            driver d{k}: rotation(A{k}) = 1 + 2 * t\n",
            x + pin[0],
            y + pin[1],
            x + d
        )
        .unwrap();
    }
    write!(text, " ground {{{ground} }}\n{rest} analysis from 0 to 3 every 0.5\n}}").unwrap();
    let (outcome, codes) = outcome(&text);
    assert!(codes.is_empty(), "{}", outcome.text());
    assert_eq!(outcome.rows.len(), 7);
}

/// A slope that is only rounding counts as zero, wherever the body is.
#[test]
fn trivial_equations_fix_nothing() {
    const IDENTITIES: [&str; 6] = [
        "distance(k.A, k.B) = 40 mm",
        "x(k.A, k.B)^2 + y(k.A, k.B)^2 = (40 mm)^2",
        "tan(angle(k)) * cos(angle(k)) = sin(angle(k))",
        "0.1 * angle(k) + 0.2 * angle(k) = 0.3 * angle(k)",
        "part * angle(k) + 2 * part * angle(k) = 3 * part * angle(k)",
        // B' is where A is, but for rounding
        "x(k.C) = 0.3 m",
    ];
    for identity in IDENTITIES {
        for degrees in (0..180).step_by(7) {
            let text = format!(
                "mechanism held {{
                    param part = 0.1
                    ground {{ point A = (0.3 m, 0.1 m) }}
                    body k at (0.3 m, 0.1 m, {degrees} deg) {{
                        point A = (0, 0)
                        point B = (40 mm, 0)
                        point C = (0.1 m + 0.2 m - 0.3 m, 0)
                    }}
                    joint ja: revolute(ground.A, k.A)
                    constraint d: {identity}
                    analysis from 0 s to 1 s every 0.5 s
                }}"
            );
            let (outcome, codes) = outcome(&text);
            let is_refused = codes.iter().any(|code| ["E0503", "E0504"].contains(code));
            assert!(is_refused, "{identity}, {degrees}: {}", outcome.text());
        }
    }
}
