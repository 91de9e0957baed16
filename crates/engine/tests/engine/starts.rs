//! Where mechanisms start: as they are drawn, driven to where their drivers begin, whatever the first time that is asked for.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking
#![allow(clippy::disallowed_methods)] // closed forms of its own are what makes it independent

use crate::support::random::Random;
use mechc::{Cancel, Choice, Compiled, Diagnostics, Memory, Parsed, Redundant, RunOptions, Times};
use std::f64::consts::{PI, TAU};

fn compiled(text: &str) -> Compiled {
    let checked = Parsed::new("drawn.mech", text).check(&Choice::default(), &Memory::default());
    assert!(checked.is_sound(), "{:?}\n{text}", checked.diagnostics());
    let (compiled, messages) = checked.compile(Redundant::Refused, &Cancel::default());
    compiled.unwrap_or_else(|| panic!("{messages:?}\n{text}"))
}

/// A column by its name, at some times, as far as the motion gets; with what is said of the start.
fn values(compiled: &Compiled, name: &str, times: &Times) -> (Vec<f64>, Diagnostics) {
    let column = compiled.columns().iter().position(|column| column == name).expect("the column");
    let (run, messages) = compiled.run(times, &RunOptions::default());
    let rows = run.into_iter().flatten().map_while(Result::ok).map(|row| row[column]).collect();
    (rows, messages)
}

/// A cam as a closed profile in its own frame (mm), and what touches it.
struct Cam {
    /// Base radius, and three waves of it: amplitude, phase.
    base: f64,
    waves: [(f64, f64); 3],
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Kind {
    /// A roller of a radius on a rod beside the centre by an offset.
    Roller { radius: f64, offset: f64 },
    /// A point on such a rod.
    Point { offset: f64 },
    /// A flat face that goes up and down.
    Flat,
    /// A roller on an arm: its radius, the arm's length, and its pivot on the x axis.
    Swinging { radius: f64, arm: f64, pivot: f64 },
    /// A flat face that turns about a pivot on the x axis.
    SwingingFlat { pivot: f64 },
}

impl Cam {
    fn random(random: &mut Random) -> Cam {
        let base = random.between(20.0, 60.0);
        // mild enough to be convex: r + r'' > 0, and there is one first touch
        let waves = [1.0_f64, 2.0, 3.0].map(|n| {
            let most = 0.2 * base / (1.0 + n * n);
            (random.between(0.3, 1.0) * most, random.between(0.0, TAU))
        });
        let kind = match random.below(5) {
            0 => Kind::Roller { radius: random.between(4.0, 15.0), offset: random.between(-0.3, 0.3) * base },
            1 => Kind::Point { offset: random.between(-0.3, 0.3) * base },
            2 => Kind::Flat,
            3 => {
                let pivot = random.between(2.5, 4.0) * base;
                Kind::Swinging { radius: random.between(4.0, 15.0), arm: random.between(0.8, 1.0) * pivot, pivot }
            }
            _ => Kind::SwingingFlat { pivot: random.between(2.5, 4.0) * base },
        };
        Cam { base, waves, kind }
    }

    /// Returns whether the follower turns; else it slides.
    fn turns(&self) -> bool {
        matches!(self.kind, Kind::Swinging { .. } | Kind::SwingingFlat { .. })
    }

    /// Returns the follower's angle (rad) or height (m) with the cam turned by an angle.
    fn follower(&self, turned: f64) -> f64 {
        self.touch(turned) * if self.turns() { 1.0 } else { 1e-3 }
    }

    fn radius(&self, u: f64) -> f64 {
        let wave = |(k, (size, phase)): (usize, &(f64, f64))| size * ((k + 1) as f64 * u + phase).cos();
        self.base + self.waves.iter().enumerate().map(wave).sum::<f64>()
    }

    fn point(&self, u: f64, turned: f64) -> [f64; 2] {
        let (r, angle) = (self.radius(u), u + turned);
        [r * angle.cos(), r * angle.sin()]
    }

    /// Where the follower first touches the cam turned by an angle, coming from outside: a height (mm), or an angle (rad) that falls
    /// towards the cam.
    fn touch(&self, turned: f64) -> f64 {
        match self.kind {
            Kind::Roller { radius, offset } => largest(|u| {
                let [x, y] = self.point(u, turned);
                let across = radius * radius - (offset - x) * (offset - x);
                if across < 0.0 { -1e9 + across } else { y + across.sqrt() }
            }),
            Kind::Point { offset } => {
                // the profile is a star: its upper point above the offset is the one whose x is the offset
                let (mut low, mut high) = (PI / 2.0 - 1.2, PI / 2.0 + 1.2);
                for _ in 0..200 {
                    let middle = f64::midpoint(low, high);
                    if self.point(middle - turned, turned)[0] > offset { low = middle } else { high = middle }
                }
                self.point(f64::midpoint(low, high) - turned, turned)[1]
            }
            Kind::Flat => largest(|u| self.point(u, turned)[1]),
            Kind::Swinging { radius, arm, pivot } => {
                // measured from the pivot, the arm's angle at which its end is a radius away from a point of the profile
                -largest(|u| {
                    let [x, y] = self.point(u, turned);
                    let (dx, dy) = (x - pivot, y);
                    let distance = dx.hypot(dy);
                    let cosine = (arm * arm + distance * distance - radius * radius) / (2.0 * arm * distance);
                    if cosine.abs() > 1.0 {
                        return -1e9 - cosine.abs();
                    }
                    let toward = dy.atan2(dx).rem_euclid(TAU);
                    -(toward - cosine.acos())
                })
            }
            Kind::SwingingFlat { pivot } => -largest(|u| {
                let [x, y] = self.point(u, turned);
                -y.atan2(x - pivot).rem_euclid(TAU)
            }),
        }
    }

    /// The mechanism, drawn with its cam at an angle (rad) and started at another; through a pair of gears, if there is a ratio.
    fn text(&self, drawn: f64, start: f64, ratio: Option<f64>) -> String {
        let at = self.touch(drawn);
        let ([(a, p), (b, q), (c, r)], base) = (self.waves, self.base);
        let radius =
            format!("({base} mm + {a} mm * cos(u + {p}) + {b} mm * cos(2 * u + {q}) + {c} mm * cos(3 * u + {r}))");
        let profile = format!("curve edge(u) = ({radius} * cos(u), {radius} * sin(u))");
        // as one draws: to a tenth of a millimetre, or of a degree
        let (height, angle) = ((at * 10.0).round() / 10.0, (at.to_degrees() * 10.0).round() / 10.0);
        let rod = |x: f64, inside: &str| {
            format!("body follower at ({x} mm, {height} mm, 0) {{ axis way = (0, 0) along (0, 1)  {inside} }}")
        };
        let (pivot, follower, guide, touch) = match self.kind {
            Kind::Roller { radius, offset } => (
                offset,
                rod(offset, &format!("circle wheel = (0, 0) radius {radius} mm")),
                "translational(ground.way, follower.way)",
                "cam(disc.edge, follower.wheel)",
            ),
            Kind::Point { offset } => (
                offset,
                rod(offset, "point tip = (0, 0)"),
                "translational(ground.way, follower.way)",
                "point_follower(follower.tip, disc.edge)",
            ),
            Kind::Flat => (
                0.0,
                rod(0.0, "axis face = (0, 0) along (1, 0)"),
                "translational(ground.way, follower.way)",
                "flat_follower(disc.edge, follower.face)",
            ),
            Kind::Swinging { radius, arm, pivot } => (
                pivot,
                format!(
                    "body follower at ({pivot} mm, 0, {angle} deg) {{ point P = (0, 0)  circle wheel = ({arm} mm, 0) radius {radius} mm }}"
                ),
                "revolute(ground.P, follower.P)",
                "cam(disc.edge, follower.wheel)",
            ),
            Kind::SwingingFlat { pivot } => (
                pivot,
                format!(
                    "body follower at ({pivot} mm, 0, {angle} deg) {{ point P = (0, 0)  axis face = P along (1, 0) }}"
                ),
                "revolute(ground.P, follower.P)",
                "flat_follower(disc.edge, follower.face)",
            ),
        };
        let (more, motor) = match ratio {
            None => (String::new(), format!("rotation(axle) = {start} + 1 rev/s * t")),
            Some(ratio) => (
                format!(
                    "body pinion at (-200 mm, 0, 0.3) {{ point O = (0, 0)  circle pitch = O radius {} mm }}
                     joint shaft: revolute(ground.M, pinion.O)
                     joint mesh: gear(pinion.pitch, disc.pitch)",
                    200.0 / (1.0 + ratio)
                ),
                format!("rotation(shaft) = {} - {ratio} rev/s * t", 0.3 - ratio * (start - drawn)),
            ),
        };
        let pitch = ratio
            .map_or(String::new(), |ratio| format!("circle pitch = O radius {} mm", 200.0 * ratio / (1.0 + ratio)));
        let measure = if self.turns() { "angle(follower)" } else { "displacement(guide)" };
        format!(
            "mechanism cam {{
                ground {{ point O = (0, 0)  point M = (-200 mm, 0)  point P = ({pivot} mm, 0)  axis way = ({pivot} mm, 0) along (0, 1) }}
                body disc at (0, 0, {drawn}) {{ point O = (0, 0)  {profile}  {pitch} }}
                {follower}
                joint axle: revolute(ground.O, disc.O)
                joint guide: {guide}
                joint touch: {touch}
                {more}
                driver motor: {motor}
                measure out = {measure}
                analysis from 0 s to 1 s every 0.1 s
            }}"
        )
    }
}

/// The largest value of a function over one turn, refined.
fn largest(value: impl Fn(f64) -> f64) -> f64 {
    const PLACES: usize = 2000;
    let at = |k: usize| k as f64 * TAU / PLACES as f64;
    let best = (0..PLACES).max_by(|&a, &b| value(at(a)).total_cmp(&value(at(b)))).expect("some");
    let (mut low, mut high) = (at(best) - TAU / PLACES as f64, at(best) + TAU / PLACES as f64);
    for _ in 0..100 {
        let thirds = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if value(thirds[0]) < value(thirds[1]) { low = thirds[0] } else { high = thirds[1] }
    }
    value(f64::midpoint(low, high))
}

#[test]
fn cams_start_as_drawn() {
    let mut random = Random::new(7);
    let (mut noted, mut done) = (0, 0);
    while done < 120 {
        let cam = Cam::random(&mut random);
        let drawn = random.between(-PI, PI);
        let start = drawn + random.between(-1.5, 1.5) * TAU;
        let ratio = (random.below(4) == 0).then(|| random.between(0.5, 2.0));
        let text = cam.text(drawn, start, ratio);
        let compiled = compiled(&text);
        let (found, messages) = values(&compiled, "out", &Times::listed(0.0, vec![0.0]));
        done += 1;
        if messages.iter().any(|message| message.code.as_str() == "N0601") {
            noted += 1;
            continue;
        }
        let wanted = cam.follower(start);

        let found = *found.first().unwrap_or_else(|| panic!("{messages:?}\n{text}"));
        assert!((found - wanted).abs() < 1e-6, "{:?}: {found} for {wanted}\n{text}", cam.kind);
    }
    assert!(noted * 50 <= done, "{noted} of {done} are in doubt");
}

/// A four-bar that turns all around, drawn at an angle of its crank (rad), as it is on one of its branches or the other; with the angle of its
/// rocker at any angle of its crank.
struct FourBar {
    /// Crank, coupler, rocker, ground (mm).
    lengths: [f64; 4],
    side: f64,
}

impl FourBar {
    fn random(random: &mut Random) -> FourBar {
        loop {
            let lengths = [20.0, 60.0, 60.0, 60.0].map(|least| random.between(least, 100.0));
            let [crank, coupler, rocker, ground] = lengths;
            let shortest = crank.min(ground);
            let longest = lengths.iter().copied().fold(0.0, f64::max);
            let turns = 2.0 * (shortest + longest) < 0.93 * lengths.iter().sum::<f64>();
            // whose crank, or ground, is shortest by Grashof's rule
            if turns && shortest < 0.9 * coupler.min(rocker) {
                return FourBar { lengths, side: if random.below(2) == 0 { 1.0 } else { -1.0 } };
            }
        }
    }

    /// Angles of coupler and rocker (rad).
    fn angles(&self, crank_angle: f64) -> [f64; 2] {
        let [crank, coupler, rocker, ground] = self.lengths;
        let (x, y) = (crank * crank_angle.cos(), crank * crank_angle.sin());
        let (dx, dy) = (ground - x, -y);
        let distance = dx.hypot(dy);
        let cosine = (coupler * coupler + distance * distance - rocker * rocker) / (2.0 * coupler * distance);
        let angle = dy.atan2(dx) + self.side * cosine.acos();
        let (px, py) = (x + coupler * angle.cos(), y + coupler * angle.sin());
        [angle, py.atan2(px - ground)]
    }

    fn text(&self, drawn: f64, crank_as_drawn: &str, driver: &str) -> String {
        let ([crank, coupler, rocker, ground], [angle, out]) = (self.lengths, self.angles(drawn).map(f64::to_degrees));
        let (x, y) = (crank * drawn.cos(), crank * drawn.sin());
        format!(
            "mechanism four_bar {{
                ground {{ point A = (0, 0)  point D = ({ground} mm, 0) }}
                body crank {crank_as_drawn} {{ point A = (0, 0)  point B = ({crank} mm, 0) }}
                body coupler at ({x:.1} mm, {y:.1} mm, {angle:.1} deg) {{ point B = (0, 0)  point C = ({coupler} mm, 0) }}
                body rocker at ({ground} mm, 0, {out:.1} deg) {{ point D = (0, 0)  point C = ({rocker} mm, 0) }}
                joint a: revolute(ground.A, crank.A)
                joint b: revolute(crank.B, coupler.B)
                joint c: revolute(coupler.C, rocker.C)
                joint d: revolute(ground.D, rocker.D)
                driver motor: rotation(a) = {driver}
                measure out = angle(rocker)
                measure cx = x(coupler.C)
            }}"
        )
    }
}

fn is_whole_turns(angle: f64) -> bool {
    (angle / TAU - (angle / TAU).round()).abs() * TAU < 1e-9
}

#[test]
fn linkages_start_as_drawn() {
    let mut random = Random::new(11);
    let mut noted = 0;
    for number in 0..100 {
        let four_bar = FourBar::random(&mut random);
        let drawn = random.between(-PI, PI);
        // drawn where its driver begins but for the crank, or anywhere with the crank
        let (crank, start) = match number % 2 {
            0 => (String::new(), drawn),
            _ => (format!("at (0, 0, {drawn})"), drawn + random.between(-2.0, 2.0) * TAU),
        };
        let text = four_bar.text(drawn, &crank, &format!("{start} + 1 rev/s * t"));
        let (found, messages) = values(&compiled(&text), "out", &Times::listed(0.0, vec![0.0]));
        if messages.iter().any(|message| message.code.as_str() == "N0601") {
            noted += 1;
            continue;
        }
        let wanted = four_bar.angles(start)[1];
        assert!(is_whole_turns(found[0] - wanted), "{}: {} for {wanted}\n{text}", number, found[0]);
    }
    assert!(noted <= 10, "{noted} of 100 are in doubt");
}

#[test]
fn the_first_requested_time_selects_no_branch() {
    let mut random = Random::new(5);
    for number in 0..200 {
        let from = random.between(-2.0, 3.0);
        let (start, speed, swing) = (random.between(-3.0, 3.0), random.between(-9.0, 9.0), random.between(0.0, 2.0));
        let law = |t: f64| start + speed * t + swing * (3.0 * t).sin();
        let driver = format!("{start} + {speed} rad/s * t + {swing} * sin(3 rad/s * t)");
        let (text, wanted, name) = if number % 2 == 0 {
            let four_bar = FourBar::random(&mut random);
            (four_bar.text(start, &format!("at (0, 0, {start})"), &driver), four_bar.angles(law(from))[1], "out")
        } else {
            let cam = Cam::random(&mut random);
            let text = cam.text(start, start, None);
            let (head, rest) = text.split_once("driver motor: ").expect("a driver");
            let (_, tail) = rest.split_once('\n').expect("a line");
            let text = format!("{head}driver motor: rotation(axle) = {driver}\n{tail}");
            (text, cam.follower(law(from)), "out")
        };
        let compiled = compiled(&text);
        let grid = Times::grid(from, from + 0.5, 0.1).expect("a grid");
        let (found, messages) = values(&compiled, name, &grid);
        assert!(found.len() == 6, "{messages:?}\n{text}");
        let is_it = if number % 2 == 0 { is_whole_turns(found[0] - wanted) } else { (found[0] - wanted).abs() < 1e-6 };
        assert!(is_it, "at {from} s: {} for {wanted}\n{text}", found[0]);
        if from > 0.0 {
            let whole = Times::listed(0.0, grid.iter().collect());
            let rows = |times: &Times| -> Vec<Vec<f64>> {
                let (run, messages) = compiled.run(times, &RunOptions::default());
                run.unwrap_or_else(|| panic!("{messages:?}")).map(|row| row.expect("it moves")).collect()
            };
            for (a, b) in rows(&grid).iter().zip(rows(&whole)) {
                for (column, (a, b)) in a.iter().zip(b).enumerate() {
                    let near = (a - b).abs() <= 1e-12 * f64::max(1.0, speed.abs().powi(2)) * f64::max(1.0, a.abs());
                    assert!(near, "{}: {a} for {b}\n{text}", compiled.columns()[column]);
                }
            }
        }
    }
}

#[test]
fn planets_keep_the_phase_that_they_are_drawn_in() {
    let mut random = Random::new(3);
    for number in 0..60 {
        let is_internal = number % 3 == 0;
        let (small, large) = (random.between(10.0, 30.0), random.between(35.0, 80.0));
        let centre = if is_internal { large - small } else { small + large };
        let [arm, planet, sun] = [(); 3].map(|()| random.between(-PI, PI));
        let [arm_start, sun_start] = [arm, sun].map(|drawn| drawn + random.between(-3.0, 3.0) * TAU);
        let (mesh, planet_radius, sun_radius) = if is_internal {
            ("internal_gear(planet.pitch, sun.pitch)", small, large)
        } else {
            ("gear(sun.pitch, planet.pitch)", large, small)
        };
        let (x, y) = (centre * arm.cos(), centre * arm.sin());
        let text = format!(
            "mechanism planet {{
                ground {{ point O = (0, 0) }}
                body arm at (0, 0, {arm}) {{ point O = (0, 0)  point P = ({centre} mm, 0) }}
                body planet at ({x} mm, {y} mm, {planet}) {{ point O = (0, 0)  circle pitch = O radius {planet_radius} mm }}
                body sun at (0, 0, {sun}) {{ point O = (0, 0)  circle pitch = O radius {sun_radius} mm }}
                joint carrier: revolute(ground.O, arm.O)
                joint pin: revolute(arm.P, planet.O)
                joint shaft: revolute(ground.O, sun.O)
                joint mesh: {mesh}
                driver d: rotation(carrier) = {arm_start} + 1 rad/s * t
                driver e: rotation(shaft) = {sun_start} + 2 rad/s * t
            }}"
        );
        let from = if number % 2 == 0 { 0.0 } else { random.between(-2.0, 2.0) };
        let (found, messages) = values(&compiled(&text), "planet.phi", &Times::listed(from, vec![from]));
        let (arm_turned, sun_turned) = (arm_start + from - arm, sun_start + 2.0 * from - sun);
        let ratio = if is_internal { large / small } else { -small / large };
        let wanted = planet + arm_turned + ratio * (sun_turned - arm_turned);
        assert!(
            messages.is_empty() && (found[0] - wanted).abs() < 1e-8,
            "{found:?} for {wanted}: {messages:?}\n{text}"
        );
    }
}
