//! Mechanisms with more equations than they need: which forces are determined, against the rank of all equations at times of the motion; and
//! motions whose dead centres the equations that are left out decide.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking
#![allow(clippy::disallowed_methods)] // sines of its own are what makes it independent
#![allow(clippy::single_match_else)] // a kind of joint beside all others reads as such

use crate::support;

use crate::support::{Outcome, Span, analyse, compile_without_redundant, follow};
use mechc::{RunOptions, Times};
use nalgebra::{DMatrix, DVector};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fmt::Write as _;

/// Mechanisms that are drawn.
const MECHANISMS: u64 = 16;
/// Forces of each that are asked for on their own, which have to be refused.
const ASKED: usize = 2;
/// What is less than this, scaled, is nothing.
const NOTHING: f64 = 1e-7;
const GRAVITY: f64 = 9.81;

struct Random(ChaCha8Rng);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        (self.0.next_u64() % n as u64) as usize
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn shuffle<T>(&mut self, list: &mut [T]) {
        for k in (1..list.len()).rev() {
            list.swap(k, self.below(k + 1));
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Pin,
    /// Points and angles.
    Weld,
    /// Along an axis of the first body; its angle on both bodies.
    Slide([f64; 2]),
}

/// A joint of two bodies, `None` being the ground, with a point of each.
struct Joint {
    kind: Kind,
    bodies: [Option<usize>; 2],
    points: [[f64; 2]; 2],
}

impl Joint {
    fn rows(&self) -> usize {
        if self.kind == Kind::Weld { 3 } else { 2 }
    }
}

struct Body {
    pose: [f64; 3],
    mass: f64,
    centre: [f64; 2],
    inertia: f64,
}

/// A force by its name, over the multipliers of the rows: row and factor at a position.
type Force<'m> = (String, Box<dyn Fn(&[f64]) -> Vec<(usize, f64)> + 'm>);

struct Mechanism {
    random: Random,
    bodies: Vec<Body>,
    joints: Vec<Joint>,
    /// The joint that each drives, and how fast.
    drivers: Vec<(usize, f64)>,
}

impl Mechanism {
    fn drawn(seed: u64) -> Mechanism {
        let random = Random(ChaCha8Rng::seed_from_u64(seed));
        let mut own = Mechanism { random, bodies: Vec::new(), joints: Vec::new(), drivers: Vec::new() };
        let angle = [own.random.within(0.0, TAU), FRAC_PI_2, PI][own.random.below(3)];
        match seed % 4 {
            0 => own.cranks(angle),
            1 => own.wheels(angle),
            2 => own.rails(),
            _ => own.doubled(angle),
        }
        own
    }

    fn body(&mut self, x: f64, y: f64, phi: f64) -> usize {
        let random = &mut self.random;
        let (mass, inertia) = (random.within(0.5, 3.0), random.within(0.01, 0.2));
        let centre = [random.within(-0.2, 0.2), random.within(-0.2, 0.2)];
        self.bodies.push(Body { pose: [x, y, phi], mass, centre, inertia });
        self.bodies.len() - 1
    }

    fn local(&self, body: Option<usize>, [x, y]: [f64; 2]) -> [f64; 2] {
        let [bx, by, phi] = body.map_or([0.0; 3], |body| self.bodies[body].pose);
        let (sin, cos, dx, dy) = (phi.sin(), phi.cos(), x - bx, y - by);
        [cos * dx + sin * dy, cos * dy - sin * dx]
    }

    fn joint(&mut self, kind: Kind, mut bodies: [Option<usize>; 2], at: [f64; 2]) -> usize {
        if kind == Kind::Pin && self.random.below(2) == 0 {
            bodies.swap(0, 1);
        }
        let points = bodies.map(|body| self.local(body, at));
        self.joints.push(Joint { kind, bodies, points });
        self.joints.len() - 1
    }

    fn pin(&mut self, a: Option<usize>, b: usize, at: [f64; 2]) -> usize {
        self.joint(Kind::Pin, [a, Some(b)], at)
    }

    fn slide(&mut self, body: usize, at: [f64; 2], angle: f64) -> usize {
        let own = angle - self.bodies[body].pose[2];
        self.joint(Kind::Slide([angle, own]), [None, Some(body)], at)
    }

    /// A rod from a body to a slider, which are determined.
    fn tail(&mut self, body: usize, [x, y]: [f64; 2]) {
        let angle = self.random.within(-0.4, 0.4);
        let length = self.random.within(1.5, 2.5);
        let end = [x + length * angle.cos(), y + length * angle.sin()];
        let (rod, slider) = (self.body(x, y, angle), self.body(end[0], end[1], 0.2));
        self.pin(Some(body), rod, [x, y]);
        self.pin(Some(rod), slider, end);
        let along = self.random.within(-0.3, 0.3) + 0.35;
        self.slide(slider, end, along);
    }

    fn drive(&mut self, joint: usize, most: f64) {
        let rate = self.random.within(0.4, 1.0) * most;
        self.drivers.push((joint, if self.random.below(2) == 0 { rate } else { -rate }));
    }

    /// Three or more parallel cranks on one bar.
    fn cranks(&mut self, angle: f64) {
        let (count, length) = (3 + self.random.below(3), self.random.within(0.3, 0.6));
        let arm = [length * angle.cos(), length * angle.sin()];
        let at: Vec<[f64; 2]> =
            (0..count).map(|k| [k as f64 + self.random.within(-0.2, 0.2), self.random.within(-0.3, 0.3)]).collect();
        let bar = self.body(at[0][0] + arm[0], at[0][1] + arm[1], 0.3);
        for [x, y] in at {
            let crank = self.body(x, y, angle + 0.5);
            let axle = self.pin(None, crank, [x, y]);
            self.pin(Some(crank), bar, [x + arm[0], y + arm[1]]);
            if self.drivers.is_empty() {
                self.drive(axle, 2.0);
                self.tail(crank, [x + 0.2, y + 0.1]);
            }
        }
    }

    /// Wheels that rods couple at several angles.
    fn wheels(&mut self, angle: f64) {
        let rods = [[0.0, 1.3, f64::NAN], [0.0, TAU / 3.0, -TAU / 3.0]][self.random.below(2)];
        let wheels: Vec<usize> =
            (0..2 + self.random.below(2)).map(|k| self.body(1.5 * k as f64, 0.1 * k as f64, angle)).collect();
        for &wheel in &wheels {
            let [x, y, _] = self.bodies[wheel].pose;
            let axle = self.pin(None, wheel, [x, y]);
            if self.drivers.is_empty() {
                self.drive(axle, 3.0);
            }
        }
        for rod in rods.into_iter().filter(|rod| rod.is_finite()) {
            let arm = [0.3 * (angle + rod).cos(), 0.3 * (angle + rod).sin()];
            let body = self.body(arm[0], arm[1], 0.1);
            for &wheel in &wheels {
                let [x, y, _] = self.bodies[wheel].pose;
                self.pin(Some(wheel), body, [x + arm[0], y + arm[1]]);
            }
        }
        let [x, y, _] = self.bodies[wheels[1]].pose;
        self.tail(wheels[1], [x + 0.2, y + 0.1]);
    }

    /// A body on two or three parallel rails, which carries another one.
    fn rails(&mut self) {
        let angle = self.random.within(0.2, 1.2);
        let body = self.body(0.0, 1.0, 0.4);
        let first = self.slide(body, [0.0, 1.0], angle);
        self.slide(body, [0.5, 1.3], angle);
        if self.random.below(2) == 0 {
            self.slide(body, [0.8, 0.3], angle);
        }
        self.drive(first, 0.4);
        let arm = self.body(0.2, 1.4, 0.3);
        let elbow = self.pin(Some(body), arm, [0.2, 1.4]);
        self.drive(elbow, 1.5);
    }

    /// A crank on one or two pins, with a body that is fixed to it twice.
    fn doubled(&mut self, angle: f64) {
        let crank = self.body(0.0, 0.0, angle);
        let axle = self.pin(None, crank, [0.0, 0.0]);
        self.drive(axle, 1.5);
        let at = [0.5 * angle.cos(), 0.5 * angle.sin()];
        let plate = self.body(at[0], at[1], angle);
        let kinds = [[Kind::Weld, Kind::Weld], [Kind::Weld, Kind::Pin], [Kind::Pin, Kind::Pin]];
        let [one, other] = kinds[self.random.below(3)];
        self.joint(one, [Some(crank), Some(plate)], at);
        self.joint(other, [Some(crank), Some(plate)], [at[0] + 0.1, at[1] + 0.2]);
        if self.random.below(2) == 0 {
            self.pin(None, crank, [0.0, 0.0]);
        }
        let [x, y, _] = self.bodies[crank].pose;
        self.tail(crank, [x + 0.1 * angle.cos(), y + 0.1 * angle.sin()]);
    }

    /// Its text with the joints in an order.
    fn text(&self, order: &[usize], measures: &[String]) -> String {
        let name = |body: Option<usize>| body.map_or("ground".to_owned(), |body| format!("b{body}"));
        let mut points = vec![String::new(); self.bodies.len() + 1];
        let mut joints = vec![String::new(); self.joints.len()];
        for (k, joint) in self.joints.iter().enumerate() {
            let [a, b] = joint.bodies.map(name);
            joints[k] = match joint.kind {
                Kind::Pin => format!("joint j{k}: revolute({a}.p{k}, {b}.p{k})\n"),
                Kind::Weld => format!("joint j{k}: weld({a}.p{k}, {b}.p{k})\n"),
                Kind::Slide(_) => format!("joint j{k}: translational({a}.p{k}, {b}.p{k})\n"),
            };
            for (side, [x, y]) in joint.points.iter().enumerate() {
                let place = &mut points[joint.bodies[side].map_or(0, |body| body + 1)];
                match joint.kind {
                    Kind::Slide(angles) => {
                        let (sin, cos) = angles[side].sin_cos();
                        writeln!(place, "axis p{k} = ({x:?}, {y:?}) along ({cos:?}, {sin:?})").unwrap();
                    }
                    _ => writeln!(place, "point p{k} = ({x:?}, {y:?})").unwrap(),
                }
            }
        }
        let mut text = format!("mechanism drawn {{\nground {{\n{}}}\ngravity (0, -{GRAVITY} m/s^2)\n", points[0]);
        for (k, Body { pose: [x, y, phi], mass, centre: [cx, cy], inertia }) in self.bodies.iter().enumerate() {
            writeln!(
                text,
                "body b{k} at ({x:?}, {y:?}, {phi:?}) {{\nmass {mass:?} kg at ({cx:?}, {cy:?}) inertia {inertia:?} kg*m^2\n{}}}",
                points[k + 1]
            )
            .unwrap();
        }
        text.extend(order.iter().map(|&k| joints[k].as_str()));
        for (k, &(joint, rate)) in self.drivers.iter().enumerate() {
            let [a, b] = self.joints[joint].bodies.map(|body| body.map_or(0.0, |body| self.bodies[body].pose[2]));
            let (what, start) = match self.joints[joint].kind {
                Kind::Slide(_) => ("displacement", 0.0),
                _ => ("rotation", b - a),
            };
            writeln!(text, "driver d{k}: {what}(j{joint}) = {start:?} + {rate:?} * t").unwrap();
        }
        for (k, measure) in measures.iter().enumerate() {
            writeln!(text, "measure m{k} = {measure}").unwrap();
        }
        text + "analysis from 0 s to 1.2 s every 0.37 s\n}\n"
    }

    /// `Φ_q` of all joints and drivers, in order.
    fn jacobian(&self, q: &[f64]) -> DMatrix<f64> {
        let count = self.joints.iter().map(Joint::rows).sum::<usize>() + self.drivers.len();
        let mut matrix = DMatrix::zeros(count, q.len());
        let mut row = 0;
        for joint in &self.joints {
            let arms: Vec<[f64; 2]> = (0..2).map(|side| self.arm(joint, side, q)).collect();
            match joint.kind {
                Kind::Slide(_) => {
                    let direction = self.direction(joint, q);
                    self.fill_slide(&mut matrix, row, joint, [-direction[1], direction[0]], q);
                    self.fill_angle(&mut matrix, row + 1, joint);
                }
                _ => {
                    for (side, body) in joint.bodies.iter().enumerate() {
                        let Some(body) = body else { continue };
                        let sign = if side == 0 { 1.0 } else { -1.0 };
                        let [x, y] = arms[side];
                        (matrix[(row, 3 * body)], matrix[(row, 3 * body + 2)]) = (sign, -sign * y);
                        (matrix[(row + 1, 3 * body + 1)], matrix[(row + 1, 3 * body + 2)]) = (sign, sign * x);
                    }
                    if joint.kind == Kind::Weld {
                        self.fill_angle(&mut matrix, row + 2, joint);
                    }
                }
            }
            row += joint.rows();
        }
        for &(joint, _) in &self.drivers {
            let joint = &self.joints[joint];
            match joint.kind {
                Kind::Slide(_) => self.fill_slide(&mut matrix, row, joint, self.direction(joint, q), q),
                _ => self.fill_angle(&mut matrix, row, joint),
            }
            row += 1;
        }
        matrix
    }

    /// From a body's origin to the point of a joint.
    #[allow(clippy::unused_self)]
    fn arm(&self, joint: &Joint, side: usize, q: &[f64]) -> [f64; 2] {
        let (sin, cos) = joint.bodies[side].map_or(0.0, |body| q[3 * body + 2]).sin_cos();
        let [x, y] = joint.points[side];
        [cos * x - sin * y, sin * x + cos * y]
    }

    /// Of a guide on the ground.
    #[allow(clippy::unused_self)]
    fn direction(&self, joint: &Joint, _: &[f64]) -> [f64; 2] {
        let Kind::Slide([angle, _]) = joint.kind else { panic!("a guide") };
        [angle.cos(), angle.sin()]
    }

    /// How far the second body's point is along a direction of the ground.
    fn fill_slide(&self, matrix: &mut DMatrix<f64>, row: usize, joint: &Joint, [nx, ny]: [f64; 2], q: &[f64]) {
        let body = joint.bodies[1].expect("what slides");
        let [x, y] = self.arm(joint, 1, q);
        (matrix[(row, 3 * body)], matrix[(row, 3 * body + 1)]) = (nx, ny);
        matrix[(row, 3 * body + 2)] = ny * x - nx * y;
    }

    #[allow(clippy::unused_self)]
    fn fill_angle(&self, matrix: &mut DMatrix<f64>, row: usize, joint: &Joint) {
        for (body, sign) in joint.bodies.iter().zip([-1.0, 1.0]) {
            if let Some(body) = body {
                matrix[(row, 3 * body + 2)] = sign;
            }
        }
    }

    fn forces(&self) -> Vec<Force<'_>> {
        let mut forces: Vec<Force> = Vec::new();
        let one = |row: usize, factor: f64| Box::new(move |_: &[f64]| vec![(row, factor)]);
        let mut row = 0;
        for (k, joint) in self.joints.iter().enumerate() {
            if matches!(joint.kind, Kind::Slide(_)) {
                let [dx, dy] = self.direction(joint, &[]);
                forces.push((format!("force_x(j{k})"), one(row, -dy)));
                forces.push((format!("force_y(j{k})"), one(row, dx)));
                forces.push((format!("torque(j{k})"), one(row + 1, 1.0)));
            } else {
                forces.push((format!("force_x(j{k})"), one(row, -1.0)));
                forces.push((format!("force_y(j{k})"), one(row + 1, -1.0)));
            }
            if joint.kind == Kind::Weld {
                forces.push((format!("torque(j{k})"), one(row + 2, 1.0)));
            }
            row += joint.rows();
        }
        for k in 0..self.drivers.len() {
            forces.push((format!("effort(d{k})"), one(row + k, 1.0)));
        }
        forces
    }

    /// What the inertia of the bodies asks for, less their weights.
    fn needed(&self, [q, qd, qdd]: [&[f64]; 3]) -> DVector<f64> {
        let mut needed = DVector::zeros(q.len());
        for (k, Body { mass, centre: [x, y], inertia, .. }) in self.bodies.iter().enumerate() {
            let (sin, cos) = q[3 * k + 2].sin_cos();
            let (rx, ry) = (cos * x - sin * y, sin * x + cos * y);
            let (speed, turn) = (qd[3 * k + 2], qdd[3 * k + 2]);
            let ax = qdd[3 * k] - turn * ry - speed * speed * rx;
            let ay = qdd[3 * k + 1] + turn * rx - speed * speed * ry + GRAVITY;
            needed[3 * k] = mass * ax;
            needed[3 * k + 1] = mass * ay;
            needed[3 * k + 2] = inertia * turn + mass * (rx * ay - ry * ax);
        }
        needed
    }
}

fn run(text: &str) -> Outcome {
    analyse(compile_without_redundant("drawn.mech", text), Span::default())
}

fn codes(outcome: &Outcome) -> Vec<&'static str> {
    outcome
        .diagnostics
        .iter()
        .filter(|message| support::is_error(message))
        .map(|message| message.code.as_str())
        .collect()
}

#[test]
fn forces_need_full_rank_of_all_equations() {
    let (mut reported, mut refused) = (0, 0);
    for seed in 0..MECHANISMS {
        let mut drawn = Mechanism::drawn(seed);
        let mut order: Vec<usize> = (0..drawn.joints.len()).collect();
        drawn.random.shuffle(&mut order);
        let motion = run(&drawn.text(&order, &[]));
        let n = 3 * drawn.bodies.len();
        if !codes(&motion).is_empty() {
            // a tail may be too short
            assert!(codes(&motion).iter().all(|code| *code == "E0602"), "{seed}: {}", motion.text());
            continue;
        }
        let parts = |row: &[f64]| [0, 1, 2].map(|order| row[1 + order * n..][..n].to_vec());
        let states: Vec<[Vec<f64>; 3]> = motion.rows[1..].iter().map(|row| parts(row)).collect();
        assert_eq!(states.len(), 3);
        // by state: the left null vectors, and the multipliers of least squares
        let solved: Vec<(Vec<DVector<f64>>, DVector<f64>)> = states
            .iter()
            .map(|[q, qd, qdd]| {
                let transposed = drawn.jacobian(q).transpose();
                let square = transposed.tr_mul(&transposed).symmetric_eigen();
                let null = (0..square.eigenvalues.len()).filter(|&k| square.eigenvalues[k] < 1e-12);
                let null: Vec<DVector<f64>> = null.map(|k| square.eigenvectors.column(k).into_owned()).collect();
                assert_eq!(null.len(), transposed.ncols() - n, "{seed}");
                let needed = drawn.needed([q, qd, qdd]);
                let multipliers = transposed.svd(true, true).solve(&needed, 1e-9).expect("a solution");
                (null, multipliers)
            })
            .collect();
        let mut names: Vec<(usize, bool)> = Vec::new();
        for (k, (_, rows)) in drawn.forces().iter().enumerate() {
            let is_open = states.iter().zip(&solved).any(|([q, ..], (null, _))| {
                let change = |vector: &DVector<f64>| rows(q).iter().map(|&(row, by)| by * vector[row]).sum::<f64>();
                null.iter().any(|vector| change(vector).abs() > NOTHING)
            });
            names.push((k, is_open));
        }
        drawn.random.shuffle(&mut names);
        let forces = drawn.forces();
        let name = |k: usize| forces[k].0.clone();
        for &(k, _) in names.iter().filter(|(_, is_open)| *is_open).take(ASKED) {
            let (_, outcome) = compile_without_redundant("drawn.mech", &drawn.text(&order, &[name(k)]));
            assert_eq!(codes(&outcome), ["E0509"], "{seed}: {} is not determined\n{}", name(k), outcome.text());
            refused += 1;
        }
        let determined: Vec<usize> = names.iter().filter(|(_, is_open)| !is_open).map(|(k, _)| *k).collect();
        let measures: Vec<String> = determined.iter().map(|&k| name(k)).collect();
        let outcome = run(&drawn.text(&order, &measures));
        assert_eq!(codes(&outcome), [""; 0], "{seed}: {}", outcome.text());
        for (at, &k) in determined.iter().enumerate() {
            let column = outcome.column(&format!("m{at}"));
            for (([q, ..], (_, multipliers)), value) in states.iter().zip(&solved).zip(&column[1..]) {
                let right: f64 = forces[k].1(q).iter().map(|&(row, by)| by * multipliers[row]).sum();
                let largest = multipliers.amax();
                assert!((value - right).abs() < NOTHING * (1.0 + largest), "{seed}: {} {value} {right}", name(k));
            }
            reported += 1;
        }
    }
    assert!(reported > 50 && refused > 15, "{reported} {refused}");
}

/// Wheels with cranks at some angles (degrees), which as many rods couple; the first turns three times.
fn locomotive(wheels: usize, cranks: &[f64], start: f64, every: f64) -> String {
    let mut text = "mechanism coupled {\nground {\n".to_owned();
    (0..wheels).for_each(|k| writeln!(text, "point A{k} = ({} m, 0)", 2 * k).unwrap());
    text += "}\n";
    for k in 0..wheels {
        writeln!(text, "body w{k} at ({} m, 0, {start} deg) {{\npoint O = (0, 0)", 2 * k).unwrap();
        cranks
            .iter()
            .enumerate()
            .for_each(|(j, crank)| writeln!(text, "point p{j} = polar(0.3 m, {crank} deg)").unwrap());
        text += "}\n";
    }
    for (j, crank) in cranks.iter().enumerate() {
        let (sin, cos) = (crank + start).to_radians().sin_cos();
        writeln!(text, "body rod{j} at ({:?}, {:?}, 0) {{", 0.3 * cos, 0.3 * sin).unwrap();
        (0..wheels).for_each(|k| writeln!(text, "point q{k} = ({} m, 0)", 2 * k).unwrap());
        text += "}\n";
    }
    for k in 0..wheels {
        writeln!(text, "joint a{k}: revolute(ground.A{k}, w{k}.O)").unwrap();
        (0..cranks.len()).for_each(|j| writeln!(text, "joint c{j}_{k}: revolute(w{k}.p{j}, rod{j}.q{k})").unwrap());
    }
    writeln!(text, "driver engine: rotation(a0) = {start} deg + 60 rpm * t").unwrap();
    let last = wheels - 1;
    writeln!(text, "measure lag = angle(w0) - angle(w{last})").unwrap();
    writeln!(text, "result most = max(abs(lag))\nresult speed = min(der(angle(w{last})))").unwrap();
    writeln!(text, "analysis from 0 s to 3 s every {every} s\n}}").unwrap();
    text
}

#[test]
fn coupled_wheels_pass_dead_centres() {
    let quartered: &[f64] = &[0.0, 90.0];
    for (wheels, cranks) in [(2, quartered), (2, &[0.0, 120.0, 240.0]), (3, &[0.0, 73.0]), (3, &[0.0, 180.0, 90.0])] {
        for start in [0.0, 20.0, 0.1] {
            let text = locomotive(wheels, cranks, start, 0.1);
            let (compiled, outcome) = compile_without_redundant("coupled.mech", &text);
            let compiled = compiled.unwrap_or_else(|| panic!("{wheels} {start}: {}", outcome.text()));
            let outcome = analyse((Some(compiled), outcome), Span::default());
            assert_eq!(codes(&outcome), [""; 0], "{wheels} {start}: {}", outcome.text());
            assert_eq!(outcome.rows.len(), 31);
            for (column, most) in [("lag", 1e-12), ("lag.d", 1e-10), ("lag.dd", 1e-7)] {
                let widest = outcome.column(column).iter().fold(0.0, |widest: f64, lag| widest.max(lag.abs()));
                assert!(widest < most, "{wheels} {start} {column}: {widest}");
            }
        }
    }
}

#[test]
fn results_span_dead_centres() {
    let (compiled, outcome) = compile_without_redundant("coupled.mech", &locomotive(2, &[0.0, 90.0], 20.0, 0.1));
    let compiled = compiled.unwrap_or_else(|| panic!("{}", outcome.text()));
    let times = compiled.times().expect("times");
    let (run, _) = compiled.run(&times, &RunOptions::default());
    let answers = run.expect("it is assembled").results().expect("results");
    let values: Vec<f64> = answers.values.iter().map(|value| value.expect("a value")).collect();
    assert!(values[0] < 1e-11 && (values[1] - TAU).abs() < 1e-9, "{values:?}");
}

#[test]
fn redundant_rows_do_not_depend_on_other_rows() {
    let rows = |every: f64| {
        let text = locomotive(3, &[0.0, 90.0], 20.0, every);
        analyse(compile_without_redundant("coupled.mech", &text), Span::default())
    };
    let (coarse, fine) = (rows(0.5), rows(0.025));
    for (k, row) in coarse.rows.iter().enumerate() {
        for (a, b) in row.iter().zip(&fine.rows[20 * k]) {
            assert!((a - b).abs() <= 1e-9 * (1.0 + a.abs()), "{a} {b}");
        }
    }
}

/// Three equal cranks whose pivots are not in a line, coupled by a plate, and a wheel that the second one turns by gears: drawn at an angle
/// (rad), and driven from another one. All cranks turn alike, in any position.
fn coupled_cranks(random: &mut Random, drawn: f64, start: f64) -> (String, f64) {
    let crank = random.within(0.03, 0.08);
    let pivots = [
        [0.0; 2],
        [random.within(0.15, 0.3), random.within(-0.05, 0.05)],
        [random.within(0.05, 0.15), random.within(0.08, 0.2)],
    ];
    let [pinion, wheel] = [0, 1].map(|_| random.within(0.01, 0.04));
    let mut text = "mechanism coupled {\nground {\n".to_owned();
    let points = |of: &str| {
        let mut text = String::new();
        pivots.iter().enumerate().for_each(|(k, [x, y])| writeln!(text, "point {of}{k} = ({x:?}, {y:?})").unwrap());
        text
    };
    text += &points("A");
    let center = [pivots[1][0] + pinion + wheel, pivots[1][1]];
    writeln!(text, "point G = ({:?}, {:?})\n}}", center[0], center[1]).unwrap();
    for (k, [x, y]) in pivots.iter().enumerate() {
        writeln!(text, "body c{k} at ({x:?}, {y:?}, {drawn:?}) {{ point O = (0, 0)  point P = ({crank:?}, 0)").unwrap();
        if k == 1 {
            writeln!(text, "circle rim = O radius {pinion:?} m").unwrap();
        }
        text += "}\n";
        writeln!(text, "joint a{k}: revolute(ground.A{k}, c{k}.O)\njoint p{k}: revolute(c{k}.P, plate.Q{k})").unwrap();
    }
    let (sin, cos) = drawn.sin_cos();
    writeln!(text, "body plate at ({:?}, {:?}, 0) {{\n{}}}", crank * cos, crank * sin, points("Q")).unwrap();
    let [x, y] = center;
    writeln!(text, "body wheel at ({x:?}, {y:?}, 0) {{ point O = (0, 0)  circle rim = O radius {wheel:?} m }}")
        .unwrap();
    writeln!(text, "joint g: revolute(ground.G, wheel.O)\njoint mesh: gear(c1.rim, wheel.rim)").unwrap();
    writeln!(text, "driver engine: rotation(a0) = {start:?} + 4 rad/s * t").unwrap();
    writeln!(text, "analysis from 0 s to 1 s every 0.25 s\n}}").unwrap();
    (text, pinion / wheel)
}

#[test]
fn coupled_cranks_start_as_drawn() {
    let mut random = Random(ChaCha8Rng::seed_from_u64(8));
    for number in 0..24 {
        let [drawn, start] = [random.within(-PI, PI), random.within(-9.0, 9.0)];
        let from = if number % 3 == 0 { 0.0 } else { random.within(-3.0, 3.0) };
        let (text, ratio) = coupled_cranks(&mut random, drawn, start);
        let (compiled, mut outcome) = compile_without_redundant("coupled.mech", &text);
        let compiled = compiled.unwrap_or_else(|| panic!("{}\n{text}", outcome.text()));
        let times = Times::grid(from, from + 1.0, 0.25).expect("a grid");
        follow(&compiled, &times, &RunOptions::default(), &mut outcome);
        let is_expected = |code: &str| ["W0502", "W0401"].contains(&code);
        assert!(
            outcome.diagnostics.iter().all(|message| is_expected(message.code.as_str())),
            "{}\n{text}",
            outcome.text()
        );
        assert!(outcome.rows.len() >= 5);
        for (row, t) in outcome.column("t").iter().enumerate() {
            let turned = start + 4.0 * t;
            let wanted =
                [("c0.phi", turned), ("c1.phi", turned), ("c2.phi", turned), ("wheel.phi", -ratio * (turned - drawn))];
            for (name, wanted) in wanted {
                let found = outcome.column(name)[row];
                assert!((found - wanted).abs() < 1e-9, "{name} at {t} s: {found} for {wanted}\n{text}");
            }
        }
    }
}
