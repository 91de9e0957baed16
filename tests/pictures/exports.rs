//! What is cut is what the mechanism does, whatever its output times are: random mechanisms whose traces are known in closed form, drawn as
//! DXF and read back.

use super::{Polyline, read_dxf, seen_to_cut};
use crate::support::random::Random;
use mechc::rooms::scene::{Vector, distance, minus, plus, polar, times};
use mechc::rooms::view::dxf;
use std::f64::consts::TAU;

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
        if (2..=turns).all(|k| teeth % k != 0 || turns % k != 0) {
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
fn traces_are_cut_as_the_motion_goes_whatever_the_output_times() {
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
        for [from, to] in sides.iter().step_by(1 + sides.len() / 300) {
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
