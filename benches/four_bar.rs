//! What a step of the four-bar of `tests/cases/four_bar.mech` costs: position, velocity and acceleration of its three
//! bodies, 27 numbers, at 1001 times over one turn of the crank.
//!
//! ```sh
//! cargo bench --bench four_bar
//! ```
//!
//! One iteration is the whole turn. The second line of each bench gives steps per second: 1 Mitem/s is 1000 ns a step,
//! 10 Mitem/s are 100 ns. The ratios between the benches hold from machine to machine, the figures do not.
//!
//! - `closed_form`, by hand, is the floor;
//! - `mechc` is the library: compiled, assembled, then followed by `next_row`;
//! - `dense_newton` is what one writes first: Φ, Φ_q, ν, γ by hand, 9×9, a dense LU per iteration, each Newton from the
//!   last position;
//! - `dense_newton_predicted` starts it from Taylor's predictor instead.
//!
//! Before anything is timed, all four must agree.

#![allow(clippy::expect_used, clippy::panic)] // a bench fails by panicking

use divan::Bencher;
use divan::counter::ItemsCount;
use mechc::analysis::{self, Started, TOLERANCE, Times};
use mechc::math;
use mechc::program::Program;
use mechc::source::Sources;
use mechc::structure::Determined;
use mechc::syntax;
use nalgebra::{SMatrix, SVector};
use std::f64::consts::PI;
use std::hint::black_box;

/// Times a turn, both ends counted: the crank turns at 2 rad/s.
const STEPS: u32 = 1001;
/// The crank at the start [rad].
const START: f64 = 0.5;
/// How fast the crank turns [rad/s].
const SPEED: f64 = 2.0;
// lengths [m]
const GROUND: f64 = 4.0;
const CRANK: f64 = 1.0;
const COUPLER: f64 = 3.5;
const ROCKER: f64 = 3.0;

/// q, q̇, q̈ of crank, coupler and rocker: the columns of a row but for the time.
type Row = [f64; 27];

fn main() {
    agree();
    divan::main();
}

fn times() -> impl Iterator<Item = f64> {
    (0..STEPS).map(|k| PI * f64::from(k) / f64::from(STEPS - 1))
}

/// Every number of every way is that of the closed form, to 1e-9.
fn agree() {
    let determined = compiled();
    let program = Program::new(determined.system());
    let mut started = started(&determined, &program);
    let every = Times::listed(0.0, times().collect());
    let mut motion = started.motion(&every);
    let (mut plain, mut predicted) = (Newton::new(false), Newton::new(true));
    for t in times() {
        let want = closed_form(t);
        let row = motion.next_row().expect("a row").expect("it moves");
        for (name, got) in [("mechc", &row[1..]), ("plain", &plain.step(t)), ("predicted", &predicted.step(t))] {
            assert_eq!(got.len(), want.len());
            for (k, (a, b)) in got.iter().zip(&want).enumerate() {
                assert!((a - b).abs() < 1e-9, "{name}, number {k} at t = {t}: {a} instead of {b}");
            }
        }
    }
}

/// The case without its measures, so that a row holds what the others compute.
fn compiled() -> Determined {
    let case = include_str!("../tests/cases/four_bar.mech");
    let text: Vec<&str> = case.lines().filter(|line| !line.trim_start().starts_with("measure")).collect();
    let mut sources = Sources::default();
    let file = sources.add("four_bar.mech", text.join("\n"));
    let tree = syntax::parse(&sources, file).expect("it follows the grammar");
    mechc::compile(&tree.mechanisms[0], &mechc::check::Surroundings::default(), &sources).0.expect("it is determined")
}

fn started<'d>(determined: &'d Determined, program: &'d Program) -> Started<'d> {
    analysis::start(determined, program, 0.0, TOLERANCE).expect("it assembles")
}

#[divan::bench(name = "mechc")]
fn library(bencher: Bencher) {
    let determined = compiled();
    let program = Program::new(determined.system());
    let every = Times::listed(0.0, times().collect());
    bencher.counter(ItemsCount::new(STEPS)).with_inputs(|| started(&determined, &program)).bench_local_refs(
        |started| {
            let mut motion = started.motion(&every);
            while let Some(row) = motion.next_row() {
                black_box(row.expect("it moves"));
            }
        },
    );
}

#[divan::bench]
fn dense_newton(bencher: Bencher) {
    newton(bencher, false);
}

#[divan::bench]
fn dense_newton_predicted(bencher: Bencher) {
    newton(bencher, true);
}

fn newton(bencher: Bencher, predict: bool) {
    bencher.counter(ItemsCount::new(STEPS)).with_inputs(|| Newton::new(predict)).bench_local_refs(|newton| {
        for t in times() {
            black_box(newton.step(black_box(t)));
        }
    });
}

#[divan::bench(name = "closed_form")]
fn by_hand(bencher: Bencher) {
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        for t in times() {
            black_box(closed_form(black_box(t)));
        }
    });
}

/// The two circles about the crank's pin and the rocker's pivot meet at the knee; the rates follow from two equations.
fn closed_form(t: f64) -> Row {
    let theta = START + SPEED * t;
    let (sin, cos) = math::sin_cos(theta);
    let [cx, cy] = [CRANK * cos, CRANK * sin];
    let [cxd, cyd] = [-SPEED * cy, SPEED * cx];
    let [cxdd, cydd] = [-SPEED * SPEED * cx, -SPEED * SPEED * cy];
    // from the pin to the pivot
    let [dx, dy] = [GROUND - cx, -cy];
    let square = dx * dx + dy * dy;
    let along = (COUPLER * COUPLER - ROCKER * ROCKER + square) / (2.0 * square);
    let aside = math::sqrt(COUPLER * COUPLER / square - along * along);
    // from the pin to the knee, and from the pivot to it
    let [ux, uy] = [along * dx - aside * dy, along * dy + aside * dx];
    let [wx, wy] = [ux - dx, uy - dy];
    let coupler = math::atan2(uy, ux);
    let rocker = math::atan2(wy, wx);
    let scale = 1.0 / (ux * wy - uy * wx);
    let coupler_d = -(cxd * wx + cyd * wy) * scale;
    let rocker_d = -(cxd * ux + cyd * uy) * scale;
    let ex = cxdd - coupler_d * coupler_d * ux + rocker_d * rocker_d * wx;
    let ey = cydd - coupler_d * coupler_d * uy + rocker_d * rocker_d * wy;
    let coupler_dd = -(ex * wx + ey * wy) * scale;
    let rocker_dd = -(ex * ux + ey * uy) * scale;
    // the rocker's frame is in the middle of the bar
    let [mx, my] = [0.5 * wx, 0.5 * wy];
    [
        [0.0, 0.0, theta, cx, cy, coupler, GROUND + mx, my, rocker],
        [0.0, 0.0, SPEED, cxd, cyd, coupler_d, -rocker_d * my, rocker_d * mx, rocker_d],
        [
            0.0,
            0.0,
            0.0,
            cxdd,
            cydd,
            coupler_dd,
            -rocker_dd * my - rocker_d * rocker_d * mx,
            rocker_dd * mx - rocker_d * rocker_d * my,
            rocker_dd,
        ],
    ]
    .as_flattened()
    .try_into()
    .expect("three times nine")
}

type Matrix = SMatrix<f64, 9, 9>;
type Vector = SVector<f64, 9>;

/// The textbook's way, with a dense LU and nothing known of the zeros.
struct Newton {
    predict: bool,
    t: f64,
    q: Vector,
    qd: Vector,
    qdd: Vector,
}

/// Sine and cosine of the three angles.
struct Turned {
    sin: [f64; 3],
    cos: [f64; 3],
}

impl Turned {
    fn new(q: &Vector) -> Turned {
        let pairs = [q[2], q[5], q[8]].map(math::sin_cos);
        Turned { sin: pairs.map(|(sin, _)| sin), cos: pairs.map(|(_, cos)| cos) }
    }
}

impl Newton {
    /// At the start, from the estimates of the file.
    fn new(predict: bool) -> Newton {
        let q = Vector::from([0.0, 0.0, 0.5, 0.88, 0.48, 0.78, 3.7, 1.5, 1.8]);
        let mut newton = Newton { predict, t: 0.0, q, qd: Vector::zeros(), qdd: Vector::zeros() };
        newton.step(0.0);
        newton
    }

    fn step(&mut self, t: f64) -> Row {
        if self.predict {
            let h = t - self.t;
            self.q += (self.qd + self.qdd * (0.5 * h)) * h;
        }
        self.t = t;
        for _ in 0..20 {
            let turned = Turned::new(&self.q);
            let phi = phi(&self.q, &turned, t);
            if phi.amax() <= TOLERANCE {
                let lu = phi_q(&turned).lu();
                self.qd = lu.solve(&nu()).expect("no singular position");
                self.qdd = lu.solve(&gamma(&self.qd, &turned)).expect("no singular position");
                return self.row();
            }
            self.q -= phi_q(&turned).lu().solve(&phi).expect("no singular position");
        }
        panic!("Newton does not arrive at t = {t}");
    }

    fn row(&self) -> Row {
        let mut row = [0.0; 27];
        for (part, vector) in row.chunks_exact_mut(9).zip([&self.q, &self.qd, &self.qdd]) {
            part.copy_from_slice(vector.as_slice());
        }
        row
    }
}

/// Four pins and the driver.
fn phi(q: &Vector, turned: &Turned, t: f64) -> Vector {
    let Turned { sin, cos } = turned;
    let half = 0.5 * ROCKER;
    Vector::from([
        -q[0],
        -q[1],
        q[0] + CRANK * cos[0] - q[3],
        q[1] + CRANK * sin[0] - q[4],
        q[3] + COUPLER * cos[1] - q[6] - half * cos[2],
        q[4] + COUPLER * sin[1] - q[7] - half * sin[2],
        GROUND - q[6] + half * cos[2],
        -q[7] + half * sin[2],
        q[2] - START - SPEED * t,
    ])
}

fn phi_q(turned: &Turned) -> Matrix {
    let Turned { sin, cos } = turned;
    let half = 0.5 * ROCKER;
    let mut m = Matrix::zeros();
    (m[(0, 0)], m[(1, 1)]) = (-1.0, -1.0);
    (m[(2, 0)], m[(2, 2)], m[(2, 3)]) = (1.0, -CRANK * sin[0], -1.0);
    (m[(3, 1)], m[(3, 2)], m[(3, 4)]) = (1.0, CRANK * cos[0], -1.0);
    (m[(4, 3)], m[(4, 5)], m[(4, 6)], m[(4, 8)]) = (1.0, -COUPLER * sin[1], -1.0, half * sin[2]);
    (m[(5, 4)], m[(5, 5)], m[(5, 7)], m[(5, 8)]) = (1.0, COUPLER * cos[1], -1.0, -half * cos[2]);
    (m[(6, 6)], m[(6, 8)]) = (-1.0, -half * sin[2]);
    (m[(7, 7)], m[(7, 8)]) = (-1.0, half * cos[2]);
    m[(8, 2)] = 1.0;
    m
}

fn nu() -> Vector {
    Vector::from([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, SPEED])
}

fn gamma(qd: &Vector, turned: &Turned) -> Vector {
    let Turned { sin, cos } = turned;
    let half = 0.5 * ROCKER;
    let [crank, coupler, rocker] = [qd[2] * qd[2], qd[5] * qd[5], qd[8] * qd[8]];
    Vector::from([
        0.0,
        0.0,
        crank * CRANK * cos[0],
        crank * CRANK * sin[0],
        coupler * COUPLER * cos[1] - rocker * half * cos[2],
        coupler * COUPLER * sin[1] - rocker * half * sin[2],
        rocker * half * cos[2],
        rocker * half * sin[2],
        0.0,
    ])
}
