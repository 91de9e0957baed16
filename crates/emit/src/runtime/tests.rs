//! Tests of the runtime on a mechanism written by hand: a point on a circle, whose height grows with time.

use super::assemble::assemble;
use super::domain_boundaries::{BoundedDomain, first_boundary};
use super::equations::{Branches, Checks, Equations};
use super::error::Error;
use super::grid::on_grid;
use super::limits::ITERATIONS;
use super::newton::Newton;
use super::numbers::{larger, largest};
use super::solution::{Solution, Solved};
use super::state::{Parameters, State, Time, Timed};
use super::step::{step, step_within};
use super::work::{Progress, Work};

/// The cells of the grid, a power of two.
const CELL: f64 = 1.0 / 134_217_728.0;

/// Rate of the height (1/s).
#[derive(Clone, Copy, Debug)]
struct Speed(f64);

impl Default for Speed {
    fn default() -> Self {
        Self(1.0)
    }
}

impl Parameters for Speed {
    fn towards(&self, other: &Self, part: f64) -> Self {
        Self(self.0 + part * (other.0 - self.0))
    }

    fn is_finite(&self) -> bool {
        self.0.is_finite()
    }
}

/// The point: `x² + y² = 1`, and `y = speed t`.
#[derive(Clone, Copy, Debug)]
struct Circle {
    speed: Speed,
}

impl Equations for Circle {
    type Q = [f64; 2];
    type Entries = [f64; 3];
    type Sides = [f64; 0];

    fn pattern() -> &'static [(usize, usize)] {
        &[(0, 0), (0, 1), (1, 1)]
    }

    fn scales() -> &'static Self::Q {
        &[1.0, 1.0]
    }

    fn phi(&self, [x, y]: &Self::Q, t: f64, _: &Self::Sides) -> Self::Q {
        [x * x + y * y - 1.0, y - self.speed.0 * t]
    }

    fn phi_q(&self, [x, y]: &Self::Q, _: f64, _: &Self::Sides) -> Self::Entries {
        [2.0 * x, 2.0 * y, 1.0]
    }

    fn nu(&self, _: &Self::Q, _: f64, _: &Self::Sides) -> Self::Q {
        [0.0, self.speed.0]
    }

    fn gamma(&self, _: &Self::Q, [v, w]: &Self::Q, _: f64, _: &Self::Sides) -> Self::Q {
        [-2.0 * (v * v + w * w), 0.0]
    }
}

impl Branches for Circle {}

impl Checks for Circle {
    type Monitors = [bool; 0];
}

impl Solved for Circle {
    type Tears = [f64; 1];
    type Turns = [bool; 1];
    type Measures = ();
    type Joined = [f64; 0];
    type Along = Time;

    fn tear_scales() -> &'static Self::Tears {
        &[1.0]
    }

    fn turned() -> &'static Self::Turns {
        &[false]
    }

    fn tears(q: &Self::Q) -> Self::Tears {
        [q[0]]
    }

    fn solve(&self, guess: &Self::Tears, t: f64, _: &Self::Sides, at: &mut Solution<Self>) {
        at.begin(t);
        let (cell, mut x, w) = (CELL, guess[0], self.speed.0);
        let y = w * t;
        let mut delta = 0.0;
        x = on_grid(x, cell);
        let mut newton = Newton::new();
        for _ in 0..ITERATIONS {
            delta = (1.0 - x * x - y * y) / (2.0 * x);
            newton.record(delta, cell, 1.0);
            if newton.is_done() {
                break;
            }
            x = newton.next(x, delta, cell);
        }
        at.note(&newton);
        x += delta;
        at.pivot(0, 0.5 / x, 1.0);
        let v = -y * w / x;
        (at.q, at.qd, at.qdd) = ([x, y], [v, w], [-(v * v + w * w) / x, 0.0]);
    }
}

impl Timed for Circle {
    type Params = Speed;
    type Continuation = ();
    type Passed = [f64; 1];
    type Row = [f64; 7];

    const START_TIME: f64 = 0.0;
    const SPAN: f64 = 2.0;
    const LONGEST_STEP: f64 = 0.1;
    const SMALLEST_STEP: f64 = 1e-12;

    fn new(params: &Speed) -> Self {
        Self { speed: *params }
    }

    fn params(&self) -> &Speed {
        &self.speed
    }

    fn start() -> &'static Self::Q {
        &[1.0, 0.0]
    }

    fn drawn(&self) -> Self::Q {
        [1.0, 0.0]
    }
}

impl BoundedDomain for Circle {
    type Gauges = [f64; 2];

    fn gauges(&self, t: f64) -> Self::Gauges {
        [t - 0.25, 1.0]
    }
}

fn started(speed: f64) -> Result<State<Circle>, Error> {
    assemble(&Speed(speed), &mut Work::default())
}

fn is_near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-12
}

#[test]
fn a_motion_is_followed_forwards_and_back() {
    let mut state = started(1.0).unwrap();
    for t in [0.5_f64, 0.8, 0.3, 0.0] {
        assert_eq!(step(t, &mut state, 100, &mut Work::default()), Ok(()), "{t}");
        let [x, y] = *state.q();
        assert!(is_near(x, (1.0 - t * t).sqrt()) && is_near(y, t), "({x}, {y}) at {t}");
        assert!(is_near(state.qd()[0], -t / x), "at {t}");
        assert_eq!(state.row()[..3], [t, x, y]);
    }
}

#[test]
fn bits_do_not_depend_on_the_path() {
    let (mut one, mut other) = (started(1.0).unwrap(), started(1.0).unwrap());
    step(0.7, &mut one, 100, &mut Work::default()).unwrap();
    for t in [0.2, 0.9, 0.65, 0.7] {
        step(t, &mut other, 100, &mut Work::default()).unwrap();
    }
    assert_eq!(one.row().map(f64::to_bits), other.row().map(f64::to_bits));
}

/// All of a state, to the last bit.
fn all_of(state: &State<Circle>) -> String {
    format!("{state:?}")
}

#[test]
fn lock_up_keeps_the_state() {
    let mut state = started(1.0).unwrap();
    step(0.5, &mut state, 100, &mut Work::default()).unwrap();
    let before = all_of(&state);
    let mut work = Work::default();
    assert_eq!(step(1.5, &mut state, 1000, &mut work), Err(Error::LockUp));
    assert_eq!(all_of(&state), before);
    assert!(work.evaluations <= super::step::most_work::<Circle>(1000), "{work:?}");
    assert_eq!(step_within(1.5, &mut state, 1000, &mut work), Err(Error::LockUp));
    assert_eq!(all_of(&state), before);
}

#[test]
fn invalid_times_and_step_limits_are_reported() {
    assert_eq!(started(f64::NAN).err(), Some(Error::NotANumber));
    let mut state = started(0.5).unwrap();
    let (before, mut work) = (all_of(&state), Work::default());
    for most in [0, 9] {
        assert_eq!(step(f64::NAN, &mut state, most, &mut work), Err(Error::NotANumber));
        assert_eq!(step_within(f64::INFINITY, &mut state, most, &mut work), Err(Error::NotANumber));
    }
    assert_eq!(step(1.0, &mut state, 2, &mut work), Err(Error::TooFar));
    assert_eq!(step(1e300, &mut state, 1000, &mut work), Err(Error::TooFar));
    assert_eq!((all_of(&state), work.evaluations), (before, 0), "what cannot be reached is not tried");
    let Progress { fraction } = step_within(1.0, &mut state, 2, &mut work).unwrap();
    assert!(fraction > 0.0 && fraction < 1.0 && is_near(fraction, state.t()), "{fraction}");
    assert_eq!(step_within(1.0, &mut state, 100, &mut work), Ok(Progress::REACHED));
    assert_eq!(state.t(), 1.0);
}

#[test]
fn boundaries_are_met_once() {
    let (model, work) = (Circle::new(&Speed(1.0)), &mut Work::default());
    let never = [f64::NEG_INFINITY];
    let (boundary, t) = first_boundary(&model, 0.0, 0.5, &never, work).unwrap();
    assert!(boundary == 0 && is_near(t, 0.25), "{t}");
    assert_eq!(first_boundary(&model, 0.0, 0.5, &[t], work), None, "it was looked at");
    assert_eq!(first_boundary(&model, 0.3, 0.5, &never, work), None);
}

#[test]
fn sizes_are_relative_to_scales() {
    assert!(larger(1.0, f64::NAN).is_nan() && larger(f64::NAN, 1.0).is_nan());
    for place in 0..3 {
        let mut values = [1.0, -6.0, 2.0];
        values[place] = f64::NAN;
        assert!(largest(&values, &[1.0; 3]).is_nan(), "what is no number counts at any place, {place} too");
    }
    assert!(is_near(largest(&[1.0, -6.0], &[1.0, 2.0]), 3.0));
}
