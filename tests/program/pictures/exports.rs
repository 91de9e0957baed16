//! What is cut is what the mechanism does, whatever its output times are: random mechanisms whose traces are known in closed form, drawn as
//! DXF and read back.

#![allow(clippy::disallowed_methods)] // closed forms of its own are what makes it independent

use super::{Polyline, attribute, boxes, numbers, one_row, read_dxf, refined, seen_text, seen_to_cut, seen_within};
use crate::support::random::Random;
use mechc::{Code, CurveTolerance, Diagnostic};
use mechc_draw::scene::{Vector, distance, minus, plus, polar, times};
use mechc_draw::view::dxf;
use mechc_draw::view::svg::{Options, Plot, plots, still};
use std::f64::consts::TAU;
use std::path::Path;

/// A mechanism, and where its trace is (m) at an angle of what drives it.
struct Known {
    text: String,
    place: Box<dyn Fn(f64) -> Vector>,
    /// After so many turns it is where it began.
    turns: f64,
}

/// The angle at which the drive begins (rad).
fn begins(random: &mut Random) -> f64 {
    random.between(0.2, 6.0)
}

fn four_bar(random: &mut Random, start: f64) -> Known {
    let [a, b, c, d] = [
        random.between(0.02, 0.04),
        random.between(0.08, 0.1),
        random.between(0.075, 0.095),
        random.between(0.08, 0.1),
    ];
    let pen = [random.between(-0.05, 0.1), random.between(-0.06, 0.06)];
    let poses = move |theta: f64| {
        let at = polar(a, theta);
        let way = minus([d, 0.0], at);
        let apart = distance(way, [0.0; 2]);
        let along = (apart * apart + b * b - c * c) / (2.0 * apart);
        let across = (b * b - along * along).sqrt();
        let to = times(1.0 / apart, way);
        let end = plus(at, plus(times(along, to), times(across, [-to[1], to[0]])));
        (at, end)
    };
    let place = move |theta: f64| {
        let (at, end) = poses(theta);
        let x = times(1.0 / b, minus(end, at));
        plus(at, plus(times(pen[0], x), times(pen[1], [-x[1], x[0]])))
    };
    let (at, end) = poses(start);
    let angle = |from: Vector, to: Vector| (to[1] - from[1]).atan2(to[0] - from[0]);
    let text = format!(
        "ground {{ point A = (0, 0) point D = ({d}, 0) }}
        body crank at (0, 0, {start}) {{ point A = (0, 0) point B = ({a}, 0) }}
        body coupler at ({}, {}, {}) {{ point B = (0, 0) point C = ({b}, 0) point P = ({}, {}) }}
        body rocker at ({d}, 0, {}) {{ point D = (0, 0) point C = ({c}, 0) }}
        joint main: revolute(ground.A, crank.A)
        joint front: revolute(crank.B, coupler.B)
        joint back: revolute(coupler.C, rocker.C)
        joint swing: revolute(ground.D, rocker.D)
        trace path = {}",
        at[0],
        at[1],
        angle(at, end),
        pen[0],
        pen[1],
        angle([d, 0.0], end),
        random.of(&["coupler.P", "(x(coupler.P), y(coupler.P))", "(x(coupler.P), y(coupler.P)) in mm"]),
    );
    Known { text, place: Box::new(place), turns: 1.0 }
}

fn slider_crank(random: &mut Random, start: f64) -> Known {
    let [a, b, e] = [random.between(0.02, 0.04), random.between(0.08, 0.12), random.between(-0.01, 0.01)];
    let pen = [random.between(0.01, 0.08), random.between(-0.03, 0.03)];
    let slide = move |theta: f64| {
        let at = polar(a, theta);
        (at, [at[0] + (b * b - (e - at[1]) * (e - at[1])).sqrt(), e])
    };
    let is_slider = random.below(3) == 0;
    let place = move |theta: f64| {
        let (at, end) = slide(theta);
        let x = times(1.0 / b, minus(end, at));
        if is_slider { end } else { plus(at, plus(times(pen[0], x), times(pen[1], [-x[1], x[0]]))) }
    };
    let (at, end) = slide(start);
    let angle = (end[1] - at[1]).atan2(end[0] - at[0]);
    let text = format!(
        "ground {{ point A = (0, 0) axis way = (0, {e}) along (1, 0) }}
        body crank at (0, 0, {start}) {{ point A = (0, 0) point B = ({a}, 0) }}
        body rod at ({}, {}, {angle}) {{ point B = (0, 0) point C = ({b}, 0) point P = ({}, {}) }}
        body slider at ({}, {e}, 0) {{ point C = (0, 0) axis way = C along (1, 0) }}
        joint main: revolute(ground.A, crank.A)
        joint front: revolute(crank.B, rod.B)
        joint back: revolute(rod.C, slider.C)
        joint guide: translational(ground.way, slider.way)
        trace path = {}",
        at[0],
        at[1],
        pen[0],
        pen[1],
        end[0],
        if is_slider { "slider.C" } else { "rod.P" },
    );
    Known { text, place: Box::new(place), turns: 1.0 }
}

/// A planet in a ring; its point may be on the pitch circle, where the path has cusps.
fn planet(random: &mut Random, start: f64) -> Known {
    let turns = 1 + random.below(3);
    let teeth = loop {
        let teeth = turns * 2 + 1 + random.below(5);
        if (2..=turns).all(|k| !teeth.is_multiple_of(k) || !turns.is_multiple_of(k)) {
            break teeth;
        }
    };
    let ring = 0.1;
    let radius = ring * turns as f64 / teeth as f64;
    let pen = radius * random.of(&[1.0, 0.6, 1.3]);
    let place = move |theta: f64| {
        let turned = -(theta - start) * (ring - radius) / radius;
        plus(polar(ring - radius, theta), polar(pen, start + turned))
    };
    let at = polar(ring - radius, start);
    let text = format!(
        "ground {{ point O = (0, 0) circle ring = O radius {ring} }}
        body crank at (0, 0, {start}) {{ point O = (0, 0) point P = ({}, 0) }}
        body planet at ({}, {}, {start}) {{ point P = (0, 0) circle pitch = P radius {radius} point T = ({pen}, 0) }}
        joint main: revolute(ground.O, crank.O)
        joint pin: revolute(crank.P, planet.P)
        joint mesh: internal_gear(planet.pitch, ground.ring)
        trace path = planet.T",
        ring - radius,
        at[0],
        at[1],
    );
    Known { text, place: Box::new(place), turns: turns as f64 }
}

/// A formula that goes to infinity twice a turn.
fn with_poles(random: &mut Random, start: f64) -> Known {
    let (a, k) = (random.between(0.05, 0.2), random.between(0.001, 0.01));
    let shift = random.between(-0.8, 0.8) * a;
    let place = move |theta: f64| {
        let [x, y] = polar(a, theta);
        [x, k * a / (y - shift)]
    };
    let text = format!(
        "ground {{ point O = (0, 0) }}
        body crank at (0, 0, {start}) {{ point O = (0, 0) point P = ({a}, 0) }}
        joint main: revolute(ground.O, crank.O)
        trace path = (x(crank.P), {k} * {a} / (y(crank.P) - {shift}))"
    );
    Known { text, place: Box::new(place), turns: 1.0 }
}

/// How far a place is from where a trace comes (m), between two angles.
fn off_trace(at: Vector, place: &dyn Fn(f64) -> Vector, angles: &[f64], known: &[Vector]) -> f64 {
    // a line may cross itself: what is near on each of its branches is looked at
    let away: Vec<f64> = known.iter().map(|place| distance(*place, at)).collect();
    let is_lowest =
        |k: &usize| (*k == 0 || away[*k] <= away[k - 1]) && away.get(k + 1).is_none_or(|next| away[*k] <= *next);
    let mut lowest: Vec<usize> = (0..known.len()).filter(is_lowest).collect();
    lowest.sort_by(|a, b| away[*a].total_cmp(&away[*b]));
    let refined = |k: &usize| {
        let [mut low, mut high] = [angles[k.saturating_sub(1)], angles[(k + 1).min(angles.len() - 1)]];
        for _ in 0..60 {
            let [a, b] = [low + 0.382 * (high - low), low + 0.618 * (high - low)];
            if distance(place(a), at) < distance(place(b), at) { high = b } else { low = a }
        }
        distance(place(low), at).min(away[*k])
    };
    lowest.iter().take(6).map(refined).fold(f64::INFINITY, f64::min)
}

fn sides((_, places, is_closed): &Polyline) -> Vec<[Vector; 2]> {
    let mut sides: Vec<[Vector; 2]> = places.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    if *is_closed {
        sides.push([places[places.len() - 1], places[0]]);
    }
    sides
}

fn from_side(at: Vector, [from, to]: [Vector; 2]) -> f64 {
    let (way, along) = (minus(to, from), minus(at, from));
    let square = way[0] * way[0] + way[1] * way[1];
    let part = if square > 0.0 { ((along[0] * way[0] + along[1] * way[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    distance(along, times(part, way))
}

#[test]
fn traces_do_not_depend_on_output_times() {
    let mut random = Random::new(50);
    let kinds: [fn(&mut Random, f64) -> Known; 4] = [four_bar, slider_crank, planet, with_poles];
    for number in 0..24 {
        let kind = number % kinds.len();
        let start = begins(&mut random);
        let Known { text, place, turns } = kinds[kind](&mut random, start);
        let runs_away = kind == 3;
        // the whole line once, more than once, or a part of it
        let part = [1.0, random.between(1.2, 2.4), random.between(0.3, 0.8)][number / kinds.len() % 3];
        let last = turns * part;
        let every = last * random.between(0.02, 0.7);
        let text = format!(
            "mechanism m {{ {text}
                driver motor: rotation(main) = {start} + 1 rev/s * t
                analysis from 0 s to {last} s every {every} s
            }}"
        );
        let seen = seen_to_cut(&text);
        let file = dxf::written(&seen.scene, &seen.motion, seen.motion.poses(0), &[], 1.0).expect("a trace");
        let lines: Vec<Polyline> = read_dxf(&file).0.into_iter().filter(|(layer, ..)| layer == "path").collect();
        // it is closed where the motion closes it, and broken where it goes to infinity
        if runs_away {
            assert!(lines.len() > 1 || part < 1.0, "{} lines of\n{text}", lines.len());
            assert!(lines.iter().all(|(_, _, is_closed)| !is_closed), "closed through infinity:\n{text}");
        } else {
            let closed: Vec<bool> = lines.iter().map(|(_, _, is_closed)| *is_closed).collect();
            assert_eq!(closed, [part >= 1.0], "\n{text}");
        }
        let angle = |k: usize| start + TAU * last * k as f64 / 6000.0;
        let angles: Vec<f64> = (0..=6000).map(angle).collect();
        let known: Vec<Vector> = angles.iter().map(|angle| place(*angle)).collect();
        let sides: Vec<[Vector; 2]> = lines.iter().flat_map(sides).collect();
        for [from, to] in sides.iter().step_by(1 + sides.len() / 150) {
            for part in [0.0, 0.5, 0.8] {
                let at = plus(*from, times(part, minus(*to, *from)));
                let off = off_trace(at, &*place, &angles, &known);
                // what is far away is known to fewer digits of a micrometre
                let most = 1e-6 + 1e-9 * distance(at, [0.0; 2]);
                assert!(off < most, "{off} m off at {at:?}:\n{text}");
            }
        }
        let near = known.iter().filter(|at| !runs_away || distance(**at, [0.0; 2]) < 10.0);
        for at in near.step_by(29) {
            let off = sides.iter().map(|side| from_side(*at, *side)).fold(f64::INFINITY, f64::min);
            assert!(off < 1e-6, "the line leaves out {at:?} by {off} m:\n{text}");
        }
    }
}

/// A crank and a formula that goes to infinity twice a turn, for so many turns.
fn turning(turns: u32) -> String {
    format!(
        "mechanism m {{
            ground {{ point O = (0, 0) }}
            body crank {{ point O = (0, 0) point P = (0.1, 0) }}
            joint main: revolute(ground.O, crank.O)
            driver motor: rotation(main) = 0.3 + 50 rev/s * t
            trace far = (x(crank.P), 0.01 * 0.1 / (y(crank.P) - 0.02))
            trace path = crank.P
            analysis from 0 s to {turns} * 20 ms every 1 s
        }}"
    )
}

/// The lines of a layer.
fn lines_of(seen: &mechc::Visualization, layer: &str) -> Vec<Polyline> {
    let file = dxf::written(&seen.scene, &seen.motion, seen.motion.poses(0), &[], 1.0).expect("a trace");
    read_dxf(&file).0.into_iter().filter(|(known, ..)| known == layer).collect()
}

#[test]
fn periodic_motions_are_traced_once() {
    let [one, many] = [1, 20_000].map(|turns| seen_to_cut(&turning(turns)));
    // so many rows as there are for some ten turns, and those of the table
    assert!(many.motion.len() < 30_000, "{} rows", many.motion.len());
    for seen in [&one, &many] {
        let [(_, circle, is_closed)] = &lines_of(seen, "path")[..] else { panic!("one line") };
        assert!(is_closed);
        for [from, to] in circle.windows(2).map(|pair| [pair[0], pair[1]]) {
            let middle = times(0.5, plus(from, to));
            assert!((distance(middle, [0.0; 2]) - 0.1).abs() < 1e-6, "{middle:?}");
        }
        // from one pole to the other, and on from there
        let far = lines_of(seen, "far");
        let closed = far.iter().filter(|(_, _, is_closed)| *is_closed).count();
        assert_eq!((far.len(), closed), (2, 0));
        for [x, y] in far.iter().flat_map(|(_, places, _)| places).filter(|place| place[1].abs() < 1.0) {
            let height = 0.02 + 0.001 / y;
            assert!((distance([*x, height], [0.0; 2]) - 0.1).abs() < 1e-5, "{x}, {y}");
        }
    }
}

#[test]
fn truncated_lines_are_reported() {
    let text = "mechanism m {
        ground { point O = (0, 0) }
        body crank { point O = (0, 0) point P = (0.1, 0) }
        joint main: revolute(ground.O, crank.O)
        driver motor: rotation(main) = 1 rev/s * t
        trace rosette = (x(crank.P) * (1 + 0.3 * sin(sqrt(2) * rotation(main))), y(crank.P))
        trace ring = crank.P
        analysis from 0 s to 900 s every 1 s
    }";
    let (seen, diagnostics) = refined(Path::new("m.mech"), text, |_| CurveTolerance {
        most_rows: 2000,
        ..CurveTolerance::to_cut(1.0, Vec::new())
    });
    let diagnostics: Vec<&Diagnostic> = diagnostics.iter().collect();
    let [warning] = diagnostics[..] else { panic!("{diagnostics:?}") };
    assert_eq!(warning.code, Code::W0701);
    assert!(warning.message.contains("`rosette`"), "{warning:?}");
    let end = warning.data["t"].as_f64().expect("a time");
    assert!(end > 5.0, "{end}");
    // the other line is closed before that, and goes on along itself
    assert!(matches!(lines_of(&seen, "ring")[..], [(_, _, true)]));
    let place = |theta: f64| {
        let [x, y] = polar(0.1, theta);
        [x * (1.0 + 0.3 * (2.0_f64.sqrt() * theta).sin()), y]
    };
    let angles: Vec<f64> = (0..=40_000).map(|k| TAU * end * f64::from(k) / 40_000.0).collect();
    let known: Vec<Vector> = angles.iter().map(|angle| place(*angle)).collect();
    let lines = lines_of(&seen, "rosette");
    let [(_, places, false)] = &lines[..] else { panic!("{} lines", lines.len()) };
    assert!(distance(places[places.len() - 1], place(TAU * end)) < 1e-6, "it ends where it says");
    let sides: Vec<[Vector; 2]> = places.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    for [from, to] in sides.iter().step_by(1 + sides.len() / 100) {
        let at = times(0.5, plus(*from, *to));
        let off = off_trace(at, &place, &angles, &known);
        assert!(off < 1e-6, "{off} m off at {at:?}");
    }
    for at in known.iter().step_by(397) {
        let off = sides.iter().map(|side| from_side(*at, *side)).fold(f64::INFINITY, f64::min);
        assert!(off < 1e-6, "the line leaves out {at:?} by {off} m");
    }
}

/// Two bars on a pin that is made of three places, each joint of which names them in its own order.
const BARS: &str = "mechanism bars {
    ground { point A = (0, 0) }
    body one { point A = (0, 0) point B = (50 mm, 0) }
    body two at (50 mm, 0, 0) { point B = (0, 0) point C = (50 mm, 0) }
    body three at (100 mm, 0, 0) { point C = (0, 0) point D = (20 mm, 0) }
    joint a: revolute(ground.A, one.A)
    joint b: revolute(one.B, two.B)
    joint c: revolute(three.C, two.C)
    driver m1: rotation(a) = 1 rad/s * t
    driver m2: rotation(b) = 1 rad/s * t
    driver m3: rotation(c) = 1 rad/s * t
    analysis from 0 s to 1 s every 0.1 s
}";

#[test]
fn single_bodies_have_all_holes() {
    let seen = seen_text(BARS);
    for (frame, wanted) in [(1, vec![0.0, 0.05]), (2, vec![0.0, 0.05]), (3, vec![0.0])] {
        let (scene, rest) = seen.scene.alone(frame);
        let file = still(&scene, &rest, &rest, &Options { scale: Some(1.0), ..Options::default() });
        assert_eq!(file.matches("class=\"pin\"").count(), wanted.len(), "{frame}: {file}");
        let text = dxf::written(&scene, &rest, rest.poses(0), &[], 1.0).expect("pins");
        let mut holes: Vec<f64> = read_dxf(&text).1.into_iter().map(|(_, [x, _])| x).collect();
        holes.sort_by(f64::total_cmp);
        assert_eq!(holes, wanted, "{frame}");
    }
}

/// A crank, whose instant centre with something that hardly turns runs to infinity twice a turn.
fn crank(every: f64) -> String {
    format!(
        "mechanism m {{
            ground {{ point O = (0, 0) }}
            body crank {{ point O = (0, 0) point P = (0.1, 0) }}
            joint main: revolute(ground.O, crank.O)
            driver motor: rotation(main) = 0.3 + 1 rev/s * t
            trace far = (x(crank.P), 0.01 * 0.1 / y(crank.P))
            trace path = crank.P
            measure pole = 0.1 / y(crank.P)
            analysis from 0 s to 1 s every {every} s
        }}"
    )
}

fn pictured(every: f64) -> String {
    let seen = seen_within(Path::new("m.mech"), &crank(every), |seen| CurveTolerance::of_picture(seen, Vec::new()));
    still(&seen.scene, &seen.motion, &seen.motion.moment(0), &Options::default())
}

#[test]
fn unbounded_traces_do_not_set_the_frame() {
    let file = pictured(0.01);
    let scale: f64 = attribute(&file, "data-scale").expect("a scale").parse().expect("a number");
    // the crank's circle is as large as the picture allows, and the other line is broken where it leaves
    assert!(scale * 0.2 > 250.0, "the circle has {} px", scale * 0.2);
    let line = file
        .split('<')
        .find(|tag| tag.starts_with("path class=\"trace") && tag.contains("data-name=\"far\""))
        .expect("a line");
    assert_eq!(attribute(line, "d").expect("its path").matches('M').count(), 2, "{line}");
}

#[test]
fn pictures_show_the_same_lines_however_few_rows_there_are() {
    for file in [pictured(0.01), pictured(0.7)] {
        let scale: f64 = attribute(&file, "data-scale").expect("a scale").parse().expect("a number");
        let origin = numbers(attribute(&file, "data-origin").expect("an origin"));
        let line = file
            .split('<')
            .find(|tag| tag.starts_with("path class=\"trace") && tag.contains("data-name=\"path\""))
            .expect("a line");
        let d = attribute(line, "d").expect("its path");
        assert!(d.ends_with('Z'), "{d}");
        let at: Vec<Vector> = numbers(d).chunks(2).map(|pair| [pair[0] - origin[0], pair[1] - origin[1]]).collect();
        let side = 0.2 * scale;
        for ends in at[..].windows(4).step_by(3) {
            for k in 0..=20 {
                let s = f64::from(k) / 20.0;
                let weights = [
                    (1.0 - s) * (1.0 - s) * (1.0 - s),
                    3.0 * s * (1.0 - s) * (1.0 - s),
                    3.0 * s * s * (1.0 - s),
                    s * s * s,
                ];
                let place =
                    ends.iter().zip(weights).fold([0.0; 2], |sum, (end, weight)| plus(sum, times(weight, *end)));
                let off = (distance(place, [0.0; 2]) - 0.1 * scale).abs();
                assert!(off < 1e-4 * side, "{off} px of {side} px");
            }
        }
    }
}

#[test]
fn poles_squash_no_plot() {
    let wanted = |seen: &mechc::Visualization| CurveTolerance {
        columns: vec!["pole".to_owned()],
        ..CurveTolerance::of_picture(seen, Vec::new())
    };
    let seen = seen_within(Path::new("m.mech"), &crank(0.01), wanted);
    let rows = seen.motion.times_between(6);
    let plot = Plot { name: "pole", unit: "1", values: seen.motion.column_at("pole", &rows) };
    let file = plots(&seen.scene, &rows, &[plot], &Options::default());
    let line = file.split('<').find(|tag| tag.starts_with("path class=\"curve")).expect("a curve");
    let d = attribute(line, "d").expect("its path");
    let stretches: Vec<Vec<f64>> = d.split('M').skip(1).map(|stretch| numbers(&stretch.replace('L', " "))).collect();
    assert_eq!(stretches.len(), 3, "two poles: {d}");
    let heights = || stretches.iter().flat_map(|stretch| stretch.iter().skip(1).step_by(2).copied());
    let [top, bottom] = heights().fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], y| [low.min(y), high.max(y)]);
    assert!(top >= 33.0 && bottom <= 185.0, "from {top} to {bottom} px");
    // the range that it is mostly in has its part of the plot: 1 is the least that it is on one side
    let marks: Vec<&str> = file.split("class=\"beside\"").skip(1).collect();
    assert!(
        marks.iter().any(|mark| mark.contains(">5<") || mark.contains(">2<") || mark.contains(">10<")),
        "{marks:?}"
    );
}

#[test]
fn labels_on_other_bodies_have_leader_lines() {
    // three long bars on each other, the names of which are longer than the room between them
    let text = "mechanism stack {
        ground { point O = (0, 0) }
        body the_first_of_all_of_them at (0, 0, 90 deg) { point O = (0, 0) point P = (60 mm, 0) }
        body the_second_of_all_of_them at (0, 0, 80 deg) { point O = (0, 0) point P = (60 mm, 0) }
        body the_third_of_all_of_them at (0, 0, 100 deg) { point O = (0, 0) point P = (60 mm, 0) }
        joint a: revolute(ground.O, the_first_of_all_of_them.O)
        joint b: revolute(ground.O, the_second_of_all_of_them.O)
        joint c: revolute(ground.O, the_third_of_all_of_them.O)
        driver m1: rotation(a) = 90 deg + 1 rad/s * t
        driver m2: rotation(b) = 80 deg + 1 rad/s * t
        driver m3: rotation(c) = 100 deg + 1 rad/s * t
        analysis from 0 s to 0.1 s every 0.05 s
    }";
    let seen = seen_text(text);
    let options = Options { labels: true, size: Some([320.0, 320.0]), ..Options::default() };
    let file = still(&seen.scene, &seen.motion, &one_row(&seen, 0), &options);
    let named = boxes(&file).into_iter().filter(|(name, _)| name.starts_with("the_")).count();
    let leaders = file.matches("class=\"leader\"").count();
    assert!(named >= 2 && leaders >= 1, "{named} names, {leaders} lines: {file}");
}
