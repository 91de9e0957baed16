//! Kinematics of mechanism `slider_crank`, written by mechc 0.1.0 from `slider_crank.mech`.
//!
//! - coordinates `q`: 9 (m, rad), equations `phi = 0`: 9
//! - `phi_q`: 17 entries that do not vanish, see [`PHI_Q_PATTERN`]
//! - parameters: 3; those that follow from others are worked out
//! - the motion: [`assemble`], then [`step`] from time to time
//! - needs no other crate
//! - needs no heap and no standard library; nothing in it panics
//!
//! This code carries no licence of mechc's: use, change and pass it on as you like.

#![allow(clippy::approx_constant, clippy::eq_op, clippy::neg_multiply)]
#![allow(clippy::excessive_precision, clippy::large_const_arrays)]

use runtime::blocks::Blocks;
use runtime::blocks::work_of;
use runtime::equations::Branches;
use runtime::equations::Checks;
use runtime::equations::Equations;
use runtime::error::Fault;
use runtime::grid::on_grid;
use runtime::limits::ITERATIONS;
use runtime::measured::Measured;
use runtime::newton::Newton;
use runtime::pivoting::Pivoting;
use runtime::pivoting::close;
use runtime::pivoting::solve_with_pivoting;
use runtime::sine_and_cosine::sin_cos;
use runtime::solution::Solved;
use runtime::state::Parameters;
use runtime::state::Time;
use runtime::state::Timed;

/// The parameters, in SI; those of the file by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// `crank_length` (m), line 6
    pub crank_length: f64,
    /// `rod_length` (m), line 7
    pub rod_length: f64,
    /// `speed` (1/s), line 8
    pub speed: f64,
}

impl Default for Params {
    #[rustfmt::skip]
    fn default() -> Self {
        Self {
            crank_length: 0.05,
            rod_length: 0.15,
            speed: 157.07963267948966,
        }
    }
}

impl Parameters for Params {
    #[rustfmt::skip]
    fn towards(&self, other: &Self, part: f64) -> Self {
        Self {
            crank_length: self.crank_length + part * (other.crank_length - self.crank_length),
            rod_length: self.rod_length + part * (other.rod_length - self.rod_length),
            speed: self.speed + part * (other.speed - self.speed),
        }
    }

    #[rustfmt::skip]
    fn is_finite(&self) -> bool {
        let all = [
            self.crank_length, self.rod_length, self.speed,
        ];
        all.into_iter().all(f64::is_finite)
    }
}

/// Number of coordinates, and of equations.
pub const N: usize = 9;

/// Number of entries of `phi_q` that do not vanish.
pub const ENTRIES: usize = 17;

/// Coordinates (m, rad).
pub type Q = [f64; N];

/// Velocities (m/s, rad/s).
pub type Qd = [f64; N];

/// Accelerations (m/s^2, rad/s^2).
pub type Qdd = [f64; N];

/// Where each coordinate stands in `q`.
pub mod coordinate {
    /// `crank.x` (m), line 16
    pub const CRANK_X: usize = 0;
    /// `crank.y` (m), line 16
    pub const CRANK_Y: usize = 1;
    /// `crank.phi` (rad), line 16
    pub const CRANK_PHI: usize = 2;
    /// `rod.x` (m), line 20
    pub const ROD_X: usize = 3;
    /// `rod.y` (m), line 20
    pub const ROD_Y: usize = 4;
    /// `rod.phi` (rad), line 20
    pub const ROD_PHI: usize = 5;
    /// `piston.x` (m), line 24
    pub const PISTON_X: usize = 6;
    /// `piston.y` (m), line 24
    pub const PISTON_Y: usize = 7;
    /// `piston.phi` (rad), line 24
    pub const PISTON_PHI: usize = 8;
}

/// Which equation each joint, constraint or driver wrote, and its unit.
pub mod row {
    /// joint `main 1` (m), line 30
    pub const MAIN_1: usize = 0;
    /// joint `main 2` (m), line 30
    pub const MAIN_2: usize = 1;
    /// joint `big 1` (m), line 31
    pub const BIG_1: usize = 2;
    /// joint `big 2` (m), line 31
    pub const BIG_2: usize = 3;
    /// joint `small 1` (m), line 32
    pub const SMALL_1: usize = 4;
    /// joint `small 2` (m), line 32
    pub const SMALL_2: usize = 5;
    /// joint `barrel 1` (m), line 33
    pub const BARREL_1: usize = 6;
    /// joint `barrel 2` (a pure number), line 33
    pub const BARREL_2: usize = 7;
    /// driver `motor` (rad), line 36
    pub const MOTOR: usize = 8;
}

/// Row and column of each value that [`phi_q`] gives.
#[rustfmt::skip]
pub static PHI_Q_PATTERN: [(usize, usize); ENTRIES] = [
    (0, 0),
    (1, 1),
    (2, 0),
    (2, 2),
    (2, 3),
    (3, 1),
    (3, 2),
    (3, 4),
    (4, 3),
    (4, 5),
    (4, 6),
    (5, 4),
    (5, 5),
    (5, 7),
    (6, 7),
    (7, 8),
    (8, 2),
];

/// The bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// `crank`, line 16
    Crank,
    /// `rod`, line 20
    Rod,
    /// `piston`, line 24
    Piston,
}

/// Where a body is, or how its place changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// (m)
    pub x: f64,
    /// (m)
    pub y: f64,
    /// (rad)
    pub phi: f64,
}

impl Pose {
    /// That of a body, out of the coordinates or their derivatives.
    #[rustfmt::skip]
#[must_use]
    pub fn of(q: &[f64; N], body: Body) -> Self {
        match body {
            Body::Crank => Self { x: q[0], y: q[1], phi: q[2] },
            Body::Rod => Self { x: q[3], y: q[4], phi: q[5] },
            Body::Piston => Self { x: q[6], y: q[7], phi: q[8] },
        }
    }
}

/// Where each measure stands among the values, all in SI.
pub mod measure {
    /// `travel`, line 39
    pub const TRAVEL: usize = 0;
    /// `lean`, line 41
    pub const LEAN: usize = 1;
}

/// How many they are.
pub const MEASURES: usize = 2;

/// Where the first time derivative of each measure that has one stands among the rates.
pub mod measure_rate {
    /// `travel`, line 39
    pub const TRAVEL: usize = 0;
    /// `lean`, line 41
    pub const LEAN: usize = 1;
}

/// How many they are.
pub const RATES: usize = 2;

/// Where the second time derivative of each measure that has one stands among the accelerations.
pub mod measure_acceleration {
    /// `travel`, line 39
    pub const TRAVEL: usize = 0;
    /// `lean`, line 41
    pub const LEAN: usize = 1;
}

/// How many they are.
pub const ACCELERATIONS: usize = 2;

/// The measures with their time derivatives; `NAN` where one has no value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// By the indices in [`measure`].
    pub values: [f64; MEASURES],
    /// First time derivatives, by the indices in [`measure_rate`].
    pub rates: [f64; RATES],
    /// Second time derivatives, by the indices in [`measure_acceleration`].
    pub accelerations: [f64; ACCELERATIONS],
}

/// The residual of the equations, each in its unit: see [`row`].
///
/// 20 operations.
pub fn phi(q: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let speed = p.speed;
    let piston_phi = q[8];
    let crank_phi = q[2];
    let crank_x = q[0];
    let crank_y = q[1];
    let crank_length = p.crank_length;
    let rod_phi = q[5];
    let rod_x = q[3];
    let rod_y = q[4];
    let rod_length = p.rod_length;
    let piston_x = q[6];
    let piston_y = q[7];

    let v1 = t * speed;
    let v2 = 0.5235987755982988 + v1;
    let (s3, _) = sin_cos(piston_phi);
    let (s4, c4) = sin_cos(crank_phi);
    let v5 = -crank_x;
    let v6 = -crank_y;
    let v7 = c4 * crank_length;
    let v8 = s4 * crank_length;
    let v9 = crank_x + v7;
    let v10 = crank_y + v8;
    let (s11, c11) = sin_cos(rod_phi);
    let v12 = v9 - rod_x;
    let v13 = v10 - rod_y;
    let v14 = c11 * rod_length;
    let v15 = s11 * rod_length;
    let v16 = rod_x + v14;
    let v17 = rod_y + v15;
    let v18 = v16 - piston_x;
    let v19 = v17 - piston_y;
    let v20 = crank_phi - v2;

    out[0] = v5;
    out[1] = v6;
    out[2] = v12;
    out[3] = v13;
    out[4] = v18;
    out[5] = v19;
    out[6] = piston_y;
    out[7] = s3;
    out[8] = v20;
    out
}

/// The Jacobian: the values of its entries, in the order of [`PHI_Q_PATTERN`] (the equation's unit per m or
/// rad).
///
/// 9 operations.
pub fn phi_q(q: &[f64; N], _t: f64, p: &Params) -> [f64; ENTRIES] {
    let mut out = [0.0; ENTRIES];
    let piston_phi = q[8];
    let crank_phi = q[2];
    let crank_length = p.crank_length;
    let rod_phi = q[5];
    let rod_length = p.rod_length;

    let (_, c1) = sin_cos(piston_phi);
    let (s2, c2) = sin_cos(crank_phi);
    let v3 = c2 * crank_length;
    let v4 = s2 * crank_length;
    let (s5, c5) = sin_cos(rod_phi);
    let v6 = c5 * rod_length;
    let v7 = s5 * rod_length;
    let v8 = -v4;
    let v9 = -v7;

    out[0] = -1.0;
    out[1] = -1.0;
    out[2] = 1.0;
    out[3] = v8;
    out[4] = -1.0;
    out[5] = 1.0;
    out[6] = v3;
    out[7] = -1.0;
    out[8] = 1.0;
    out[9] = v9;
    out[10] = -1.0;
    out[11] = 1.0;
    out[12] = v6;
    out[13] = -1.0;
    out[14] = 1.0;
    out[15] = c1;
    out[16] = 1.0;
    out
}

/// The partial derivative of `phi` by time (the equation's unit per s).
///
/// 0 operations.
pub fn phi_t(_q: &[f64; N], _t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let speed = p.speed;

    out[8] = -speed;
    out
}

/// Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).
///
/// 0 operations.
pub fn nu(_q: &[f64; N], _t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let speed = p.speed;

    out[8] = speed;
    out
}

/// Right side of the acceleration equation `phi_q qdd = gamma` (the equation's unit per s^2).
///
/// 17 operations.
pub fn gamma(q: &[f64; N], qd: &[f64; N], _t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let piston_phi = q[8];
    let crank_phi = q[2];
    let rod_phi = q[5];
    let crank_phi_d = qd[2];
    let rod_phi_d = qd[5];
    let piston_phi_d = qd[8];
    let crank_length = p.crank_length;
    let rod_length = p.rod_length;

    let (s1, _) = sin_cos(piston_phi);
    let (s2, c2) = sin_cos(crank_phi);
    let (s3, c3) = sin_cos(rod_phi);
    let v4 = s2 * crank_phi_d;
    let v5 = c2 * crank_phi_d;
    let v6 = s3 * rod_phi_d;
    let v7 = c3 * rod_phi_d;
    let v8 = s1 * piston_phi_d;
    let v9 = piston_phi_d * v8;
    let v10 = crank_phi_d * v5;
    let v11 = crank_phi_d * v4;
    let v12 = crank_length * v10;
    let v13 = crank_length * v11;
    let v14 = rod_phi_d * v7;
    let v15 = rod_phi_d * v6;
    let v16 = rod_length * v14;
    let v17 = rod_length * v15;

    out[2] = v12;
    out[3] = v13;
    out[4] = v16;
    out[5] = v17;
    out[7] = v9;
    out
}

/// The Jacobian as a full matrix, row by row.
pub fn phi_q_dense(q: &[f64; N], t: f64, p: &Params) -> [[f64; N]; N] {
    let mut full = [[0.0; N]; N];
    for (&(row, column), value) in PHI_Q_PATTERN.iter().zip(phi_q(q, t, p)) {
        if let Some(entry) = full.get_mut(row).and_then(|line| line.get_mut(column)) {
            *entry = value;
        }
    }
    full
}

/// The measures with their time derivatives, from the coordinates, their velocities and
/// accelerations.
pub fn measures(q: &Q, qd: &Qd, qdd: &Qdd, t: f64, p: &Params) -> Measures {
    let mut all = all_measures(q, qd, qdd, t, p).into_iter();
    let mut next = || all.next().unwrap_or(f64::NAN) + 0.0;
    Measures {
        values: core::array::from_fn(|_| next()),
        rates: core::array::from_fn(|_| next()),
        accelerations: core::array::from_fn(|_| next()),
    }
}

/// The measures, their rates and their accelerations, one behind the other.
///
/// 3 operations.
fn all_measures(q: &[f64; N], qd: &[f64; N], qdd: &[f64; N], _t: f64, _p: &Params) -> [f64; 6] {
    let mut out = [0.0; 6];
    let rod_phi = q[5];
    let rod_phi_d = qd[5];
    let rod_phi_dd = qdd[5];
    let piston_x = q[6];
    let piston_x_d = qd[6];
    let piston_x_dd = qdd[6];

    let v1 = rod_phi / 0.017453292519943295;
    let v2 = rod_phi_d / 0.017453292519943295;
    let v3 = rod_phi_dd / 0.017453292519943295;

    out[0] = piston_x;
    out[1] = v1;
    out[2] = piston_x_d;
    out[3] = v2;
    out[4] = piston_x_dd;
    out[5] = v3;
    out
}

pub use runtime::error::Error;
pub use runtime::limits::MOST_STEPS;
pub use runtime::state::Assembly;
pub use runtime::work::{Progress, Work};

/// The mechanism at a time.
pub type State = runtime::state::State<Model>;

impl State {
    /// Where a body is (m, m, rad).
    #[must_use]
    pub fn pose(&self, body: Body) -> Pose {
        Pose::of(self.q(), body)
    }

    /// How fast a body moves (m/s, m/s, rad/s).
    #[must_use]
    pub fn velocity(&self, body: Body) -> Pose {
        Pose::of(self.qd(), body)
    }

    /// How a body's velocity changes (m/s^2, m/s^2, rad/s^2).
    #[must_use]
    pub fn acceleration(&self, body: Body) -> Pose {
        Pose::of(self.qdd(), body)
    }
}

/// Evaluations that any call takes at most that is not told how many steps it may take.
pub const MOST_WORK: usize = most_work(MOST_STEPS);

/// Evaluations that [`assemble`] takes at most.
pub const MOST_WORK_TO_ASSEMBLE: usize = runtime::assemble::most_work::<Model>();

/// Evaluations that a call takes at most that may take so many steps.
#[must_use]
pub const fn most_work(most: usize) -> usize {
    runtime::step::most_work::<Model>(most)
}

/// Brings the mechanism to its first time with some parameters: along the branch that the file's
/// parameters give, where a short way leads there; else from the poses that the file draws with these
/// parameters, as `mechc run --set` does. `State::assembly` says which way it went.
///
/// # Errors
/// It cannot be assembled with these.
pub fn assemble(params: &Params) -> Result<State, Error> {
    counted::assemble(params, &mut Work::default())
}

/// Moves a state to time `t` (s), in steps as short as the motion asks for: position, velocity
/// and acceleration are those of the branch that it is on, whichever way `t` lies.
///
/// It takes [`MOST_STEPS`] steps at most, and mostly one: [`MOST_WORK`] evaluations, whatever it is
/// given. What a driver does and undoes within a
/// step, by formulas without branches, is not seen: no step is longer than [`LONGEST_STEP`].
///
/// # Errors
/// Why it cannot get there; the state is then bit for bit as it was.
pub fn step(t: f64, state: &mut State) -> Result<(), Error> {
    counted::step(t, state, &mut Work::default())
}

/// As [`step`], in so many steps at most, for those who have a deadline: [`most_work`] says how many
/// evaluations that are. A step that has to be made shorter counts as well. What these steps do not
/// reach is on its way: the same call goes on from there.
///
/// # Errors
/// Why it cannot get there; the state is then bit for bit as it was.
pub fn step_within(t: f64, state: &mut State, most: usize) -> Result<Progress, Error> {
    counted::step_within(t, state, most, &mut Work::default())
}

/// The same functions, which add the evaluations that they do to those of a [`Work`]: for tests of a
/// deadline, and for tables of what calls cost.
#[rustfmt::skip]
pub mod counted {
    #![allow(clippy::missing_errors_doc)] // they are those of the functions outside

    use super::*;

    /// The same, counted.
    pub fn assemble(params: &Params, work: &mut Work) -> Result<State, Error> {
        runtime::assemble::assemble(params, work)
    }

    /// The same, counted.
    pub fn step(t: f64, state: &mut State, work: &mut Work) -> Result<(), Error> {
        runtime::step::step(t, state, MOST_STEPS, work)
    }

    /// The same, counted.
    pub fn step_within(
        t: f64,
        state: &mut State,
        most: usize,
        work: &mut Work,
    ) -> Result<Progress, Error> {
        runtime::step::step_within(t, state, most, work)
    }
}

/// Number of results at a time.
pub const COLUMNS: usize = 34;

/// The first time of the file's analysis (s), at which the mechanism is assembled.
pub const START_TIME: f64 = 0.0;

/// How long the file's analysis takes (s).
const SPAN: f64 = 0.04;

/// The longest step (s).
pub const LONGEST_STEP: f64 = 0.00125;

/// The shortest step (s).
const SMALLEST_STEP: f64 = 4e-14;

/// What a change of each coordinate is judged against.
#[rustfmt::skip]
static SCALES: [f64; N] = [
    0.05, 0.05, 1.0, 0.15,
    0.15, 1.0, 0.15, 0.15,
    1.0,
];

/// The assembled position (m, rad).
#[rustfmt::skip]
static START: [f64; N] = [
    0.0, 0.0, 0.5235987755982988, 0.04330127018922194,
    0.024999999999999998, -0.16744807921968932, 0.19120326476671234, 0.0,
    0.0,
];

impl Measured for Measures {
    const ZERO: Self = Self {
        values: [0.0; MEASURES],
        rates: [0.0; RATES],
        accelerations: [0.0; ACCELERATIONS],
    };

    fn lists(&self) -> [&[f64]; 3] {
        [&self.values, &self.rates, &self.accelerations]
    }

    fn lists_mut(&mut self) -> [&mut [f64]; 3] {
        [&mut self.values, &mut self.rates, &mut self.accelerations]
    }
}

/// The mechanism with its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    params: Params,
}

/// Number of coordinates that Newton solves for; the others follow.
const TEARS: usize = 2;

/// What a change of each of them is judged against (m, or 1 rad).
#[rustfmt::skip]
static TEAR_SCALES: [f64; TEARS] = [
    1.0, 1.0,
];

/// Number of blocks of equations whose determinants change with the position.
const TURNS: usize = 2;

/// Whether they are negative where all pivots are positive.
#[rustfmt::skip]
static TURNED: [bool; TURNS] = [
    false, false,
];

/// Number of places where formulas have branches.
const SIDES: usize = 0;

/// Which branch is taken at each: what a comparison gives, the number of a piece.
type Sides = [f64; SIDES];

/// What solves the equations at a time.
type Solution = runtime::solution::Solution<Model>;

/// Position, velocity and acceleration at a time. Newton begins with a guess of `rod.phi`,
/// `piston.phi`; all else follows.
///
/// 60 operations.
fn solve(guess: &[f64; TEARS], t: f64, m: &Model, at: &mut Solution) {
    at.begin(t);
    let crank_phi = t * m.params.speed + 0.5235987755982988;
    at.q[2] = crank_phi + 0.0;
    at.qd[2] = m.params.speed + 0.0;
    let v2 = m.params.crank_length;
    let (s3, c3) = sin_cos(crank_phi);
    let rod_x = c3 * v2;
    at.q[3] = rod_x + 0.0;
    let rod_y = s3 * v2;
    let v6 = rod_y * m.params.speed;
    let rod_x_d = -v6;
    at.qd[3] = rod_x_d + 0.0;
    let v8 = c3 * m.params.speed;
    let v9 = m.params.speed * v8;
    let v10 = v2 * v9;
    let rod_x_dd = -v10;
    at.qdd[3] = rod_x_dd + 0.0;
    at.q[4] = rod_y + 0.0;
    let rod_y_d = rod_x * m.params.speed;
    at.qd[4] = rod_y_d + 0.0;
    let v13 = s3 * m.params.speed;
    let v14 = m.params.speed * v13;
    let v15 = v2 * v14;
    let rod_y_dd = -v15;
    at.qdd[4] = rod_y_dd + 0.0;
    let mut x1 = guess[0];
    let mut s17 = 0.0;
    let mut c17 = 0.0;
    let mut v22 = 0.0;
    x1 = on_grid(x1, 7.450580596923828e-9);
    let mut newton = Newton::new();
    for _ in 0..ITERATIONS {
        (s17, c17) = sin_cos(x1);
        let v18 = c17 * m.params.rod_length;
        let v19 = 1.0 / v18;
        let v20 = s17 * m.params.rod_length + rod_y;
        let v21 = v20 * v19;
        v22 = -v21;
        newton.record(v22, 7.450580596923828e-9, 1.0);
        if newton.is_done() {
            break;
        }
        x1 = newton.next(x1, v22, 7.450580596923828e-9);
    }
    at.note(&newton);
    x1 += v22;
    let v23 = 0.5 * v22;
    let v24 = c17 - v23 * s17;
    let v25 = v22 * v24 + s17;
    let v26 = v23 * c17 + s17;
    let v27 = c17 - v22 * v26;
    let v28 = v25 * m.params.rod_length;
    let v29 = rod_y + v28;
    at.holds &= v29.abs() <= 2.586464197407e-13;
    let v30 = v27 * m.params.rod_length;
    let v31 = 1.0 / v30;
    at.q[5] = x1 + 0.0;
    at.pivot(0, v31, 0.258602010819715);
    let v32 = rod_y_d * v31;
    let rod_phi_d = -v32;
    at.qd[5] = rod_phi_d + 0.0;
    let v34 = v25 * v32;
    let v35 = v32 * v34;
    let v36 = m.params.rod_length * v35 + v15;
    let rod_phi_dd = v36 * v31;
    at.qdd[5] = rod_phi_dd + 0.0;
    let piston_x = rod_x + v30;
    at.q[6] = piston_x + 0.0;
    let v39 = v6 - v28 * v32;
    let piston_x_d = -v39;
    at.qd[6] = piston_x_d + 0.0;
    let v41 = v27 * v32;
    let v42 = v32 * v41;
    let v43 = m.params.rod_length * v42 + v10;
    let v44 = v28 * rod_phi_dd + v43;
    let piston_x_dd = -v44;
    at.qdd[6] = piston_x_dd + 0.0;
    at.measures.values[0] = piston_x + 0.0;
    let v46 = -v39;
    at.measures.rates[0] = v46 + 0.0;
    let v47 = -v44;
    at.measures.accelerations[0] = v47 + 0.0;
    let v48 = x1 / 0.017453292519943295;
    at.measures.values[1] = v48 + 0.0;
    let v49 = v32 / 0.017453292519943295;
    let v50 = -v49;
    at.measures.rates[1] = v50 + 0.0;
    let v51 = rod_phi_dd / 0.017453292519943295;
    at.measures.accelerations[1] = v51 + 0.0;
    let mut x2 = guess[1];
    let mut s52 = 0.0;
    let mut c52 = 0.0;
    let mut v55 = 0.0;
    x2 = on_grid(x2, 7.450580596923828e-9);
    let mut newton = Newton::new();
    for _ in 0..ITERATIONS {
        (s52, c52) = sin_cos(x2);
        let v53 = 1.0 / c52;
        let v54 = s52 * v53;
        v55 = -v54;
        newton.record(v55, 7.450580596923828e-9, 1.0);
        if newton.is_done() {
            break;
        }
        x2 = newton.next(x2, v55, 7.450580596923828e-9);
    }
    at.note(&newton);
    x2 += v55;
    let v56 = 0.5 * v55;
    let v57 = c52 - v56 * s52;
    let v58 = v55 * v57 + s52;
    let v59 = v56 * c52 + s52;
    let v60 = c52 - v55 * v59;
    at.holds &= v58.abs() <= 1e-12;
    let v61 = 1.0 / v60;
    at.q[8] = x2 + 0.0;
    at.pivot(1, v61, 1.0);
}

impl Equations for Model {
    type Q = Q;
    type Entries = [f64; ENTRIES];
    type Sides = Sides;

    fn pattern() -> &'static [(usize, usize)] {
        &PHI_Q_PATTERN
    }

    fn scales() -> &'static Q {
        &SCALES
    }

    fn phi(&self, q: &Q, t: f64, _sides: &Sides) -> Q {
        phi(q, t, &self.params)
    }

    fn phi_q(&self, q: &Q, t: f64, _sides: &Sides) -> Self::Entries {
        phi_q(q, t, &self.params)
    }

    fn nu(&self, q: &Q, t: f64, _sides: &Sides) -> Q {
        nu(q, t, &self.params)
    }

    fn gamma(&self, q: &Q, qd: &Qd, t: f64, _sides: &Sides) -> Qdd {
        gamma(q, qd, t, &self.params)
    }
}

impl Branches for Model {}

impl Checks for Model {
    type Monitors = [bool; 0];
}

impl Solved for Model {
    type Tears = [f64; TEARS];
    type Turns = [bool; TURNS];
    type Measures = Measures;
    type Joined = [f64; 0];
    type Along = Time;

    fn tear_scales() -> &'static Self::Tears {
        &TEAR_SCALES
    }

    fn turned() -> &'static Self::Turns {
        &TURNED
    }

    #[rustfmt::skip]
    fn tears(q: &Q) -> Self::Tears {
        [
            q[5], q[8],
        ]
    }

    fn solve(&self, guess: &Self::Tears, t: f64, _sides: &Sides, at: &mut Solution) {
        solve(guess, t, self, at);
    }

    fn pivoted(&self, q: &Q, t: f64, sides: &Sides, _at: &Solution) -> Result<Solution, Fault> {
        solve_with_pivoting(self, q, t, sides)
    }
}

/// The width of a cell of each coordinate's grid.
#[rustfmt::skip]
static CELLS: [f64; N] = [
    2.3283064365386963e-10, 2.3283064365386963e-10, 7.450580596923828e-9, 9.313225746154785e-10,
    9.313225746154785e-10, 7.450580596923828e-9, 9.313225746154785e-10, 9.313225746154785e-10,
    7.450580596923828e-9,
];

/// Number of blocks of equations that can be solved one after the other.
const BLOCKS: usize = 9;

/// The blocks whose determinants change.
#[rustfmt::skip]
static TURNING: [usize; TURNS] = [
    6, 8,
];

/// Numbers that the elimination of the largest block works on.
const WORK: usize = work_of(1);

/// How the equations fall apart into blocks.
#[rustfmt::skip]
static EQUATIONS: Blocks<'static> = Blocks {
    sizes: &[
        1, 1, 1, 1,
        1, 1, 1, 1,
        1,
    ],
    rows: &[
        0, 1, 8, 2,
        3, 6, 5, 4,
        7,
    ],
    columns: &[
        0, 1, 2, 3,
        4, 7, 5, 6,
        8,
    ],
    starts: &[
        0, 1, 2, 5,
        8, 11, 14, 15,
        16, 17,
    ],
    entries: &[
        0, 1, 0, 2,
        3, 1, 2, 4,
        3, 5, 6, 4,
        5, 7, 7, 8,
        2,
    ],
    places: &[
        0, 1, 2, 3,
        4, 6, 7, 5,
        8,
    ],
    units: &[
        0.03125, 0.03125, 1.0, 0.125,
        0.125, 1.0, 0.125, 0.125,
        1.0,
    ],
};

impl Pivoting for Model {
    type Work = [f64; WORK];
    type Blocks = [bool; BLOCKS];
    type Varied = [f64; 0];
    type Rights = [Q; 0];

    const TOLERANCE: f64 = 1e-12;

    fn blocks() -> &'static Blocks<'static> {
        &EQUATIONS
    }

    fn turning() -> &'static [usize] {
        &TURNING
    }

    fn cells() -> &'static Q {
        &CELLS
    }

    fn rights(&self, _q: &Q, _t: f64, _sides: &Sides) -> [Q; 0] {
        []
    }

    fn measured(
        &self,
        [q, qd, qdd, _]: [&Q; 4],
        _varied: &[f64; 0],
        _multipliers: &Q,
        t: f64,
    ) -> Measures {
        measures(q, qd, qdd, t, &self.params)
    }
}

/// Where the file's poses put the coordinates, roughly: what is not closed yet.
///
/// 0 operations.
fn drawn(_p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    out[2] = 0.5235987755982988;
    out[3] = 0.045;
    out[4] = 0.025;
    out[5] = -0.17453292519943295;
    out[6] = 0.19;
    out
}

impl Timed for Model {
    type Params = Params;
    type Continuation = ();
    type Passed = [f64; 0];
    type Row = [f64; COLUMNS];

    const START_TIME: f64 = START_TIME;
    const SPAN: f64 = SPAN;
    const LONGEST_STEP: f64 = LONGEST_STEP;
    const SMALLEST_STEP: f64 = SMALLEST_STEP;

    fn new(params: &Params) -> Self {
        Self { params: *params }
    }

    fn params(&self) -> &Params {
        &self.params
    }

    fn start() -> &'static Q {
        &START
    }

    fn drawn(&self) -> Q {
        drawn(&self.params)
    }

    fn closed(&self, q: &Q, t: f64, work: &mut Work) -> Option<Q> {
        close(self, q, t, work)
    }
}

/// The same for several variants of the mechanism, or several times, at once: in loops over the
/// lanes that a compiler turns into vector instructions. Each lane has the bits that it would have
/// alone.
pub mod lanes {
    // what is done in every lane reads best, and vectorises best, with the lane's number
    #![allow(clippy::needless_range_loop)]

    use super::*;

    use super::runtime::grid::on_grid;
    use super::runtime::lane_newton::LaneNewton;
    use super::runtime::lane_solutions::Laned;
    use super::runtime::limits::ITERATIONS;
    use super::runtime::without_branches::sin_cos_below_a_million;

    /// Lanes that are worked on together.
    pub const LANES: usize = 4;

    /// A number in each lane.
    pub type Each = [f64; LANES];

    /// As many mechanisms, each with its own parameters, at a time of its own.
    pub type States = super::runtime::lanes::States<Model, LANES>;

    /// What solves the equations in every lane.
    type Solutions = super::runtime::lane_solutions::Solutions<Model, LANES>;

    /// The width of a cell of the grid of each coordinate that Newton solves for.
    #[rustfmt::skip]
    static TEAR_CELLS: [f64; TEARS] = [
        7.450580596923828e-9, 7.450580596923828e-9,
    ];

    /// Brings the mechanisms to the first time, each with its own parameters; says of each lane why
    /// it cannot be assembled, if it cannot. Such a lane has the parameters of the file.
    ///
    /// # Errors
    /// Not even the file's own mechanism can be assembled.
    #[rustfmt::skip]
    pub fn assemble(
        params: &[Params; LANES],
    ) -> Result<(States, [Result<(), Error>; LANES]), Error> {
        super::runtime::lanes::assemble_each(params)
    }

    /// Moves every lane to a time of its own (s). A lane that asks for more than one step, as any
    /// does that has further to go than [`LONGEST_STEP`], goes its way alone.
    ///
    /// What comes back says of each lane whether it has got there, and if not, why; it stays at the
    /// last time that it could reach.
    pub fn step_each(t: &Each, states: &mut States) -> [Result<(), Error>; LANES] {
        super::runtime::lanes::step_each(t, states)
    }

    impl Laned<LANES> for Model {
        type Coordinates = [Each; N];
        type Guesses = [Each; TEARS];
        type Values = [Each; MEASURES];
        type Rates = [Each; RATES];
        type Accelerations = [Each; ACCELERATIONS];
        type OfJoined = [Each; 0];
        type Signs = [[u64; LANES]; TURNS];

        const HAS_CHECKS: bool = false;

        #[rustfmt::skip]
        fn tears_of(q: &[Each; N]) -> [Each; TEARS] {
            [
                q[5], q[8],
            ]
        }

        fn solve_each(
            guess: &[Each; TEARS],
            t: &Each,
            models: &[Model; LANES],
            _sides: &[Sides; LANES],
            at: &mut Solutions,
        ) {
            solve(guess, t, models, at);
        }
    }

    /// Position, velocity and acceleration in every lane. Newton begins with a guess of `rod.phi`,
    /// `piston.phi`; all else follows.
    ///
    /// 60 operations a lane.
    fn solve(guess: &[Each; TEARS], t: &Each, m: &[Model; LANES], at: &mut Solutions) {
        at.begin(t);
        let mut w = [[0.0; LANES]; 15];
        solve_1(guess, t, m, at, &mut w);
        solve_2(guess, t, m, at, &mut w);
        solve_3(guess, t, m, at, &mut w);
        solve_4(guess, t, m, at, &mut w);
        solve_5(guess, t, m, at, &mut w);
        solve_6(guess, t, m, at, &mut w);
    }

    /// Part 1 of [`solve`].
    #[inline(never)]
    fn solve_1(
        guess: &[Each; TEARS],
        t: &Each,
        m: &[Model; LANES],
        at: &mut Solutions,
        w: &mut [Each; 15],
    ) {
        for k in 0..LANES {
            let crank_phi = t[k] * m[k].params.speed + 0.5235987755982988;
            at.q[2][k] = crank_phi + 0.0;
            at.qd[2][k] = m[k].params.speed + 0.0;
            let v2 = m[k].params.crank_length;
            at.watch(k, crank_phi, 1.0000000000000002e-6);
            let (s3, c3) = sin_cos_below_a_million(crank_phi);
            w[8][k] = c3 * v2;
            at.q[3][k] = w[8][k] + 0.0;
            w[2][k] = s3 * v2;
            w[9][k] = w[2][k] * m[k].params.speed;
            let rod_x_d = -w[9][k];
            at.qd[3][k] = rod_x_d + 0.0;
            let v8 = c3 * m[k].params.speed;
            let v9 = m[k].params.speed * v8;
            w[10][k] = v2 * v9;
            let rod_x_dd = -w[10][k];
            at.qdd[3][k] = rod_x_dd + 0.0;
            at.q[4][k] = w[2][k] + 0.0;
            w[6][k] = w[8][k] * m[k].params.speed;
            at.qd[4][k] = w[6][k] + 0.0;
            let v13 = s3 * m[k].params.speed;
            let v14 = m[k].params.speed * v13;
            w[7][k] = v2 * v14;
            let rod_y_dd = -w[7][k];
            at.qdd[4][k] = rod_y_dd + 0.0;
            w[0][k] = guess[0][k];
            w[1][k] = m[k].params.rod_length;
        }
    }

    /// Part 2 of [`solve`].
    #[inline(never)]
    fn solve_2(
        _guess: &[Each; TEARS],
        _t: &Each,
        _m: &[Model; LANES],
        at: &mut Solutions,
        w: &mut [Each; 15],
    ) {
        for k in 0..LANES {
            w[0][k] = on_grid(w[0][k], 7.450580596923828e-9);
        }
        let mut newton = LaneNewton::new();
        for _ in 0..ITERATIONS {
            for k in 0..LANES {
                let x1 = w[0][k];
                at.watch(k, x1, 1.0000000000000002e-6);
                (w[4][k], w[5][k]) = sin_cos_below_a_million(x1);
                let v19 = w[5][k] * w[1][k];
                let v20 = 1.0 / v19;
                let v21 = w[4][k] * w[1][k] + w[2][k];
                let v22 = v21 * v20;
                w[3][k] = -v22;
                newton.record(k, w[3][k], TEAR_CELLS[0], TEAR_SCALES[0]);
            }
            if newton.is_done() {
                break;
            }
            for k in 0..LANES {
                w[0][k] = newton.next(k, w[0][k], w[3][k], TEAR_CELLS[0]);
            }
        }
        newton.note(at);
        for k in 0..LANES {
            w[0][k] += w[3][k];
        }
    }

    /// Part 3 of [`solve`].
    #[inline(never)]
    fn solve_3(
        _guess: &[Each; TEARS],
        _t: &Each,
        _m: &[Model; LANES],
        at: &mut Solutions,
        w: &mut [Each; 15],
    ) {
        for k in 0..LANES {
            let v24 = 0.5 * w[3][k];
            let v25 = w[5][k] - v24 * w[4][k];
            let v26 = w[3][k] * v25 + w[4][k];
            let v27 = v24 * w[5][k] + w[4][k];
            let v28 = w[5][k] - w[3][k] * v27;
            let v29 = v26 * w[1][k];
            let v30 = w[2][k] + v29;
            at.watch(k, v30, 3866282011568.252);
            let v31 = v28 * w[1][k];
            let v32 = 1.0 / v31;
            at.q[5][k] = w[0][k] + 0.0;
            at.pivot(k, 0, v32, 0.258602010819715);
            let v33 = w[6][k] * v32;
            let rod_phi_d = -v33;
            at.qd[5][k] = rod_phi_d + 0.0;
            let v35 = v26 * v33;
            let v36 = v33 * v35;
            let v37 = w[1][k] * v36 + w[7][k];
            let rod_phi_dd = v37 * v32;
            at.qdd[5][k] = rod_phi_dd + 0.0;
            let piston_x = w[8][k] + v31;
            at.q[6][k] = piston_x + 0.0;
            let v40 = w[9][k] - v29 * v33;
            let piston_x_d = -v40;
            at.qd[6][k] = piston_x_d + 0.0;
            let v42 = v28 * v33;
            let v43 = v33 * v42;
            let v44 = w[1][k] * v43 + w[10][k];
            let v45 = v29 * rod_phi_dd + v44;
            let piston_x_dd = -v45;
            at.qdd[6][k] = piston_x_dd + 0.0;
            at.values[0][k] = piston_x + 0.0;
            let v47 = -v40;
            at.rates[0][k] = v47 + 0.0;
            let v48 = -v45;
            at.accelerations[0][k] = v48 + 0.0;
            let v49 = w[0][k] / 0.017453292519943295;
            at.values[1][k] = v49 + 0.0;
            let v50 = v33 / 0.017453292519943295;
            let v51 = -v50;
            at.rates[1][k] = v51 + 0.0;
            let v52 = rod_phi_dd / 0.017453292519943295;
            at.accelerations[1][k] = v52 + 0.0;
        }
    }

    /// Part 4 of [`solve`].
    #[inline(never)]
    fn solve_4(
        guess: &[Each; TEARS],
        _t: &Each,
        _m: &[Model; LANES],
        _at: &mut Solutions,
        w: &mut [Each; 15],
    ) {
        for k in 0..LANES {
            w[11][k] = guess[1][k];
        }
    }

    /// Part 5 of [`solve`].
    #[inline(never)]
    fn solve_5(
        _guess: &[Each; TEARS],
        _t: &Each,
        _m: &[Model; LANES],
        at: &mut Solutions,
        w: &mut [Each; 15],
    ) {
        for k in 0..LANES {
            w[11][k] = on_grid(w[11][k], 7.450580596923828e-9);
        }
        let mut newton = LaneNewton::new();
        for _ in 0..ITERATIONS {
            for k in 0..LANES {
                let x1 = w[11][k];
                at.watch(k, x1, 1.0000000000000002e-6);
                (w[13][k], w[14][k]) = sin_cos_below_a_million(x1);
                let v54 = 1.0 / w[14][k];
                let v55 = w[13][k] * v54;
                w[12][k] = -v55;
                newton.record(k, w[12][k], TEAR_CELLS[1], TEAR_SCALES[1]);
            }
            if newton.is_done() {
                break;
            }
            for k in 0..LANES {
                w[11][k] = newton.next(k, w[11][k], w[12][k], TEAR_CELLS[1]);
            }
        }
        newton.note(at);
        for k in 0..LANES {
            w[11][k] += w[12][k];
        }
    }

    /// Part 6 of [`solve`].
    #[inline(never)]
    fn solve_6(
        _guess: &[Each; TEARS],
        _t: &Each,
        _m: &[Model; LANES],
        at: &mut Solutions,
        w: &mut [Each; 15],
    ) {
        for k in 0..LANES {
            let v57 = 0.5 * w[12][k];
            let v58 = w[14][k] - v57 * w[13][k];
            let v59 = w[12][k] * v58 + w[13][k];
            let v60 = v57 * w[14][k] + w[13][k];
            let v61 = w[14][k] - w[12][k] * v60;
            at.watch(k, v59, 1000000000000.0);
            let v62 = 1.0 / v61;
            at.q[8][k] = w[11][k] + 0.0;
            at.pivot(k, 1, v62, 1.0);
        }
    }
}

/// What solves the equations and follows the motion, the same for all mechanisms.
#[rustfmt::skip]
mod runtime {
pub mod numbers {
//! Lists of numbers and their norms.

use core::fmt::Debug;

/// A list of numbers.
pub trait Numbers: Copy + Debug + 'static + AsRef<[f64]> + AsMut<[f64]> {
    /// All numbers 0.
    const ZERO: Self;
}

impl<const K: usize> Numbers for [f64; K] {
    const ZERO: Self = [0.0; K];
}

/// A list of flags.
pub trait Flags: Copy + Debug + PartialEq + 'static + AsRef<[bool]> + AsMut<[bool]> {
    /// All flags false.
    const NONE: Self;
}

impl<const K: usize> Flags for [bool; K] {
    const NONE: Self = [false; K];
}

/// Returns the largest absolute value relative to its scale; NaN if any is NaN.
pub fn largest<N: Numbers>(values: &N, scales: &N) -> f64 {
    let pairs = values.as_ref().iter().zip(scales.as_ref());
    let sizes = pairs.map(|(value, scale)| value.abs() / scale);
    sizes.fold(0.0, larger)
}

/// Returns the larger number; NaN if either is NaN.
pub fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Adds 0 for each finite value and NaN for each other one, so that a single comparison checks all without branches.
#[inline(always)]
#[allow(clippy::inline_always)] // a call would cost more than it does
pub fn add_zeros<N: Numbers>(values: &N, sums: &mut [f64; 4]) {
    let chunks = values.as_ref().chunks_exact(4);
    for value in chunks.remainder() {
        sums[0] += 0.0 * value;
    }
    for chunk in chunks {
        if let [a, b, c, d] = chunk {
            sums[0] += 0.0 * a;
            sums[1] += 0.0 * b;
            sums[2] += 0.0 * c;
            sums[3] += 0.0 * d;
        }
    }
}

/// Returns the differences `to - from`.
pub fn difference<N: Numbers>(to: &N, from: &N) -> N {
    let mut difference = *to;
    difference.as_mut().iter_mut().zip(from.as_ref()).for_each(|(difference, from)| *difference -= from);
    difference
}

/// Returns the coordinates after a time `h` (s), from the present velocities and accelerations.
pub fn predicted<N: Numbers>(q: &N, qd: &N, qdd: &N, h: f64) -> N {
    let mut later = *q;
    let rates = qd.as_ref().iter().zip(qdd.as_ref());
    for (q, (qd, qdd)) in later.as_mut().iter_mut().zip(rates) {
        *q += h * (qd + 0.5 * h * qdd);
    }
    later
}
}

pub mod error {
//! Errors of emitted code.

/// The reason why a mechanism could not be moved to a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// The time, an input, a parameter or a formula is not a number.
    NotANumber,
    /// A driver has come to a position beyond which the mechanism cannot follow it: a dead point.
    LockUp,
    /// Two branches of the motion meet: which one goes on is not determined.
    Bifurcation,
    /// Newton's iteration does not arrive, however short the step.
    Divergence,
    /// The steps that are allowed do not lead so far, or an input changes by more than is allowed.
    TooFar,
    /// At a time where a formula of time goes over to another branch, a position or velocity jumps.
    NotSmooth,
    /// An equation that was left out as redundant does not hold beside the others, or is needed where these are singular.
    Inconsistent,
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Error::NotANumber => "the time, an input, a parameter or a formula is not a number",
            Error::LockUp => "the mechanism locks up: its driver cannot go on",
            Error::Bifurcation => "two branches of the motion meet",
            Error::Divergence => "the mechanism cannot be brought there",
            Error::TooFar => "it is too far away: for the steps that are allowed, or for one change of an input",
            Error::NotSmooth => "a position or velocity jumps",
            Error::Inconsistent => {
                "an equation that was left out as redundant does not hold, or is needed where the others are singular"
            }
        })
    }
}

impl core::error::Error for Error {}

/// The reason why a step is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Something is not a number.
    NotANumber,
    /// The step is too long for the motion.
    TooFar,
    /// The position is on another branch, or too near to one.
    Singular,
    /// A position or velocity jumps.
    NotSmooth,
    /// An equation that was left out does not hold.
    LeftOut,
}

impl Fault {
    /// Returns the error of a mechanism that cannot be assembled.
    pub fn at_start(self) -> Error {
        match self {
            Self::NotANumber => Error::NotANumber,
            Self::LeftOut => Error::Inconsistent,
            _ => Error::Divergence,
        }
    }
}
}

pub mod equations {
//! Interface of a mechanism with its parameters: equations, their branches, and conditions beside them.

use super::numbers::{Flags, Numbers};
use core::fmt::Debug;

/// The equations `phi = 0` and their derivatives.
pub trait Equations: Copy + Debug {
    /// A number for each coordinate, or each equation.
    type Q: Numbers;
    /// A number for each entry of `phi_q` that does not vanish.
    type Entries: Numbers;
    /// Branches of formulas: the result of each comparison, the number of each piece.
    type Sides: Numbers + PartialEq;

    /// Returns row and column of each entry of `phi_q`.
    fn pattern() -> &'static [(usize, usize)];

    /// Returns the scale of each coordinate.
    fn scales() -> &'static Self::Q;

    /// Returns the residuals of the equations.
    fn phi(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;

    /// Returns the entries of the Jacobian.
    fn phi_q(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Entries;

    /// Returns the right side of the velocity equation.
    fn nu(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;

    /// Returns the right side of the acceleration equation.
    fn gamma(&self, q: &Self::Q, qd: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;
}

/// Conditions that select the branches of formulas. By default formulas have none.
pub trait Branches: Equations {
    /// True if some branches depend on time alone.
    const OF_TIME: bool = false;

    /// True if some branches depend on the motion.
    const OF_MOTION: bool = false;

    /// Last time of the file's analysis (s), at which formulas of time take their earlier branches.
    const END: Option<f64> = None;

    /// Returns for each branch whether it depends on time alone.
    fn is_of_time() -> &'static [bool] {
        &[]
    }

    /// Returns the branches that depend on time alone, and 0 for the others.
    fn sides_of_time(&self, _t: f64) -> Self::Sides {
        Self::Sides::ZERO
    }

    /// Returns all branches at a position, with those of time given in `sides`.
    fn sides_of_motion(&self, _q: &Self::Q, _t: f64, sides: &Self::Sides) -> Self::Sides {
        *sides
    }
}

/// Conditions beside the equations; most mechanisms have none.
pub trait Checks: Equations {
    /// A flag for each quantity that keeps its sign along a branch: whether it is positive.
    type Monitors: Flags;

    /// True if equations were left out as redundant.
    const HAS_REDUNDANT_ROWS: bool = false;

    /// Returns whether distances are positive, and positions lie within their intervals and tables.
    fn conditions_hold(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> bool {
        true
    }

    /// Returns whether the redundant equations hold.
    fn redundant_rows_hold(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> bool {
        true
    }

    /// Returns the signs of quantities that keep them along a branch of the motion.
    fn monitors(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> Self::Monitors {
        Self::Monitors::NONE
    }
}
}

pub mod measured {
//! Measures.

use core::fmt::Debug;

/// Measures with their first and second time derivatives.
pub trait Measured: Copy + Debug {
    /// Measures before the first solution.
    const ZERO: Self;

    /// Flags in the order of [`lists`](Measured::lists): true for derivatives by inputs or parameters, and for forces.
    const IS_VARIED: &'static [bool] = &[];

    /// Returns values, rates and accelerations.
    fn lists(&self) -> [&[f64]; 3];

    /// Returns values, rates and accelerations for modification.
    fn lists_mut(&mut self) -> [&mut [f64]; 3];

    /// Replaces values that are not finite by NaN.
    fn leave_out(&mut self) {
        for list in self.lists_mut() {
            for value in list.iter_mut().filter(|value| !value.is_finite()) {
                *value = f64::NAN;
            }
        }
    }

    /// Replaces derivatives by inputs and parameters, and forces, by NaN, since they have no value close to a singular
    /// position.
    fn leave_varied_out(&mut self) {
        let mut rest = Self::IS_VARIED.iter();
        for list in self.lists_mut() {
            for (value, _) in list.iter_mut().zip(&mut rest).filter(|(_, is_varied)| **is_varied) {
                *value = f64::NAN;
            }
        }
    }
}

/// A mechanism without measures.
impl Measured for () {
    const ZERO: Self = ();

    fn lists(&self) -> [&[f64]; 3] {
        [&[]; 3]
    }

    fn lists_mut(&mut self) -> [&mut [f64]; 3] {
        [&mut [], &mut [], &mut []]
    }
}
}

pub mod work {
//! Work and progress of a call.

use super::equations::Branches;
use super::limits::{MOST_BRANCHES, MOST_HALVINGS};

/// Number of evaluations of a call. One is a solution of the equations at a position with all checks there: by the
/// specialized operations, or by elimination with partial pivoting where these lose digits. Evaluating the formulas of time
/// that decide a branch, or the ends of their domains, counts as one too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Number of evaluations.
    pub evaluations: usize,
}

impl Work {
    /// Counts more evaluations.
    pub fn add(&mut self, evaluations: usize) {
        self.evaluations = self.evaluations.wrapping_add(evaluations);
    }
}

/// Progress of a call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Fraction of the path that is done: 1 only at its end; 0 if the state has not moved along it yet.
    pub fraction: f64,
}

impl Progress {
    /// The end of the path.
    pub const REACHED: Self = Self { fraction: 1.0 };

    /// Creates the progress of an incomplete path.
    pub fn part(done: f64, all: f64) -> Self {
        Self { fraction: f64::min(done / all, 1.0 - f64::EPSILON) }
    }

    /// Returns whether the end is reached; if not, the same call continues from here.
    #[must_use]
    pub fn is_reached(self) -> bool {
        self.fraction >= 1.0
    }
}

/// Largest number of evaluations of a solution on given branches of formulas: by the operations, by pivoting, and by the
/// operations again.
pub const OF_FINDING: usize = 3;

/// Number of evaluations of the branches of formulas of time.
pub const fn of_sides<M: Branches>() -> usize {
    if M::OF_TIME { 1 } else { 0 }
}

/// Largest number of evaluations of a solution.
pub const fn of_reaching<M: Branches>() -> usize {
    let branches = if M::OF_MOTION { MOST_BRANCHES } else { 1 };
    of_sides::<M>() + branches * OF_FINDING
}

/// Largest number of evaluations in the search for the first edge of a step.
pub const fn of_edge<M: Branches>() -> usize {
    (2 + MOST_HALVINGS) * of_sides::<M>()
}

/// Largest number of evaluations of one step, from the search for its end to the check of both sides of an edge.
pub const fn of_step<M: Branches>() -> usize {
    let rounding = 1;
    of_edge::<M>() + of_reaching::<M>() + rounding + OF_FINDING * of_sides::<M>()
}
}

pub mod solution {
//! Solutions of the equations at a time, and the interface of the solver.

use super::equations::{Branches, Checks};
use super::error::Fault;
use super::measured::Measured;
use super::numbers::{Flags, Numbers, add_zeros};
use core::fmt::Debug;

/// Equations with the operations that solve them.
pub trait Solved: Branches + Checks {
    /// A number for each coordinate that Newton solves for; the others follow from these.
    type Tears: Numbers;
    /// A flag for each block of equations whose determinant changes with the position.
    type Turns: Flags;
    /// Measures.
    type Measures: Measured;
    /// Values that only measures need.
    type Joined: Numbers;
    /// Variable of the motion: time, or signals.
    type Along: Along<Self>;

    /// Returns the scale of each coordinate that Newton solves for.
    fn tear_scales() -> &'static Self::Tears;

    /// Returns for each block whether its determinant is negative if all pivots are positive.
    fn turned() -> &'static Self::Turns;

    /// Selects the coordinates that Newton solves for.
    fn tears(q: &Self::Q) -> Self::Tears;

    /// Solves for position, velocity and acceleration at a time.
    fn solve(&self, guess: &Self::Tears, t: f64, sides: &Self::Sides, at: &mut Solution<Self>);

    /// Solves by elimination with partial pivoting from a position nearby, after [`solve`](Solved::solve) has failed with
    /// `at`. Returns a fault if blocks are too large for that.
    fn pivoted(
        &self,
        _q: &Self::Q,
        _t: f64,
        _sides: &Self::Sides,
        at: &Solution<Self>,
    ) -> Result<Solution<Self>, Fault> {
        Err(at.fault())
    }
}

/// The variable of a motion, with the part of a solution that belongs to it.
pub trait Along<M: Solved>: Copy + Debug {
    /// Value before the first solution.
    const ZERO: Self;

    /// Returns the predicted coordinates at a distance `h` from a solution.
    fn predicted(m: &M, from: &Solution<M>, h: f64) -> M::Q;

    /// Returns a position and time slightly ahead, where the branches of formulas are those on which the motion continues.
    fn ahead(m: &M, at: &Solution<M>) -> (M::Q, f64);

    /// Records the point that a solution belongs to.
    fn note(&mut self, _m: &M, _t: f64) {}

    /// Returns the derivatives of the coordinates by the variable of the motion.
    fn slopes(&self) -> &[M::Q] {
        &[]
    }

    /// Returns the derivatives of the coordinates by the variable of the motion, for modification.
    #[allow(dead_code)] // what is not pivoted knows them by their names
    fn slopes_mut(&mut self) -> &mut [M::Q] {
        &mut []
    }
}

/// Solution of the equations at a time.
#[derive(Debug)]
pub struct Solution<M: Solved> {
    /// Time (s), or position on a path.
    pub t: f64,
    /// Coordinates.
    pub q: M::Q,
    /// Velocities.
    pub qd: M::Q,
    /// Accelerations.
    pub qdd: M::Q,
    /// Measures.
    pub measures: M::Measures,
    /// Values that only measures need.
    #[allow(dead_code)] // mostly they need nothing
    pub joined: M::Joined,
    /// Part of the solution that belongs to the variable of the motion.
    pub along: M::Along,
    /// Branches of formulas.
    pub sides: M::Sides,
    /// Signs of quantities that keep them along a branch: true if positive.
    pub monitors: M::Monitors,
    /// Signs of the determinants of the blocks of equations.
    pub is_negative: M::Turns,
    /// True if Newton's iteration has converged.
    pub is_settled: bool,
    /// True if no digits were lost and the equations hold.
    pub holds: bool,
    /// Largest first correction of Newton's iteration, scaled.
    pub first: f64,
    /// Reciprocal of the smallest pivot, scaled.
    pub steepest: f64,
}

impl<M: Solved> Clone for Solution<M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<M: Solved> Copy for Solution<M> {}

impl<M: Solved> Solution<M> {
    /// Solution before the first solve.
    pub const ZERO: Self = Self {
        t: 0.0,
        q: M::Q::ZERO,
        qd: M::Q::ZERO,
        qdd: M::Q::ZERO,
        measures: M::Measures::ZERO,
        joined: M::Joined::ZERO,
        along: M::Along::ZERO,
        sides: M::Sides::ZERO,
        monitors: M::Monitors::NONE,
        is_negative: M::Turns::NONE,
        is_settled: true,
        holds: true,
        first: 0.0,
        steepest: 0.0,
    };

    /// Creates a solution that holds only a position and its time.
    pub fn near(q: &M::Q, t: f64) -> Self {
        let mut near = Self::ZERO;
        (near.t, near.q) = (t, *q);
        near
    }

    /// Resets the records before a solve.
    pub fn begin(&mut self, t: f64) {
        self.t = t;
        self.is_negative = *M::turned();
        (self.is_settled, self.holds) = (true, true);
        (self.first, self.steepest) = (0.0, 0.0);
    }

    /// Returns the reason why the solution cannot be used.
    pub fn fault(&self) -> Fault {
        if self.is_finite() { Fault::TooFar } else { Fault::NotANumber }
    }

    /// Returns whether coordinates and their derivatives are finite; measures may be NaN.
    pub fn is_finite(&self) -> bool {
        let mut sums = [0.0; 4];
        add_zeros(&self.q, &mut sums);
        add_zeros(&self.qd, &mut sums);
        add_zeros(&self.qdd, &mut sums);
        for slopes in self.along.slopes() {
            add_zeros(slopes, &mut sums);
        }
        sums == [0.0; 4]
    }
}
}

pub mod track {
//! Present and previous solution of a continuation.

use super::solution::{Solution, Solved};

/// The present solution, and the previous one or the next one in progress.
#[derive(Clone, Copy, Debug)]
pub struct Track<M: Solved> {
    pub(super) solutions: [Solution<M>; 2],
    /// True if the present solution is the second.
    pub(super) is_second: bool,
    /// True if the previous solution lies on the same smooth motion.
    pub(super) is_smooth: bool,
    /// Step size that works well: a time (s), or a change of a signal.
    pub(super) stride: f64,
}

impl<M: Solved> Track<M> {
    /// Returns the present solution.
    #[inline]
    pub fn at(&self) -> &Solution<M> {
        let [first, second] = &self.solutions;
        if self.is_second { second } else { first }
    }

    /// Returns the present solution for modification.
    #[inline]
    pub fn at_mut(&mut self) -> &mut Solution<M> {
        let [first, second] = &mut self.solutions;
        if self.is_second { second } else { first }
    }

    /// Returns the previous solution, or the next one in progress.
    #[inline]
    pub fn other(&self) -> &Solution<M> {
        let [first, second] = &self.solutions;
        if self.is_second { first } else { second }
    }

    /// Returns the present solution, and the other one for modification.
    #[inline]
    pub fn both(&mut self) -> (&Solution<M>, &mut Solution<M>) {
        let [first, second] = &mut self.solutions;
        if self.is_second { (second, first) } else { (first, second) }
    }
}

/// Checkpoint of a track before a call, from which an error restores every bit.
pub struct Checkpoint<M: Solved> {
    /// Time or position of the solution at the checkpoint.
    t: f64,
    is_second: bool,
    is_smooth: bool,
    stride: f64,
    other: Solution<M>,
    /// The solution at the checkpoint, once a second step is about to overwrite it.
    now: Option<Solution<M>>,
}

impl<M: Solved> Checkpoint<M> {
    /// Creates a checkpoint of a track.
    #[inline]
    pub fn of(track: &Track<M>) -> Self {
        let Track { is_second, is_smooth, stride, .. } = *track;
        Self { t: track.at().t, is_second, is_smooth, stride, other: *track.other(), now: None }
    }

    /// Keeps the solution of the checkpoint, which is the other solution after the first step.
    #[inline]
    pub fn keep(&mut self, track: &Track<M>) {
        if self.now.is_none() {
            self.now = Some(*track.other());
        }
    }

    /// Restores the track.
    #[cold]
    pub fn restore(&self, track: &mut Track<M>) {
        (track.is_second, track.is_smooth, track.stride) = (self.is_second, self.is_smooth, self.stride);
        if let Some(now) = self.now {
            *track.at_mut() = now;
        }
        track.at_mut().t = self.t;
        *track.both().1 = self.other;
    }
}
}

pub mod running_max {
//! Maximum of a sequence.

/// Returns the maximum so far with a single comparison, for inner loops: NaN wins, but only until the next value. The
/// results that a NaN comes from are NaN as well and are checked for that.
pub fn running_max(largest: f64, value: f64) -> f64 {
    if value <= largest { largest } else { value }
}
}

pub mod pivots {
//! Record of pivots.

use super::running_max::running_max;
use super::solution::{Solution, Solved};

impl<M: Solved> Solution<M> {
    /// Records the reciprocal of a pivot; `weight` makes it dimensionless.
    pub fn pivot(&mut self, turn: usize, inverse: f64, weight: f64) {
        if let Some(is_negative) = self.is_negative.as_mut().get_mut(turn) {
            *is_negative ^= inverse < 0.0;
        }
        self.steepest = running_max(self.steepest, inverse.abs() * weight);
    }
}
}

pub mod grid {
// The grid on which Newton's iteration moves from point to point.
//
// The iteration ends at the point nearest to the solution, where all corrections stay within their cells, so its start leaves no
// trace. If a coordinate is on the border of two cells, rounding may make either point the nearer one, seen from itself or from the
// other. Therefore such a border is judged from one side alone: all coordinates whose corrections end next to a border go to the
// even one of the two points, the others stay; from there each goes where its correction leads, and stays there.

/// Returns the grid point nearest to a value.
#[must_use]
#[inline]
pub fn on_grid(x: f64, cell: f64) -> f64 {
    // adding and taking away 1.5 * 2^52 cells rounds to a whole number of them
    let rounding = 6_755_399_441_055_744.0 * cell;
    (x + rounding) - rounding
}

/// Returns the largest correction, in cells, with which an iteration that has met no border ends. A correction within `border` of half
/// a cell is at a border.
#[must_use]
#[inline]
pub fn bound_at_first(border: f64) -> f64 {
    0.5 - border
}

/// Returns, for an iteration whose largest correction exceeds `bound` (both in cells), its next bound; and the spacing, in cells, of the
/// points to which coordinates next to a border go.
#[must_use]
#[inline]
pub fn going_on(largest: f64, bound: f64, border: f64) -> (f64, f64) {
    let is_free = bound < 0.5;
    let is_at_border = is_free && largest <= 0.5 + border;
    // at the even points only what is beyond the border goes on; behind that nothing does that is no stray
    let next = if is_free { bound } else { 1.0 };
    (if is_at_border { 0.5 } else { next }, if is_at_border { 2.0 } else { 1.0 })
}

/// Returns the next grid point of a coordinate, from the current one and the correction there.
#[must_use]
#[inline]
pub fn next_point(x: f64, delta: f64, cell: f64, cells: f64, border: f64) -> f64 {
    // from an odd point the even one in the direction of the correction, from an even one none
    let is_at_border = delta.abs() > (0.5 - border) * cell;
    on_grid(x + delta, if is_at_border { cells * cell } else { cell })
}
}

pub mod hermite {
// The quintic through two states of which value, velocity and acceleration are known (Hermite).

/// Returns the coefficients of the third, fourth and fifth power of the quintic in the fraction of its step. The arguments are what the
/// initial parabola lacks at the end in value, slope and half the curvature, with respect to that fraction.
#[must_use]
#[inline]
pub fn higher_terms([value, slope, bend]: [f64; 3]) -> [f64; 3] {
    let cubic = 10.0 * value - 4.0 * slope + bend;
    let quartic = -15.0 * value + 7.0 * slope - 2.0 * bend;
    let quintic = 6.0 * value - 3.0 * slope + bend;
    [cubic, quartic, quintic]
}

/// Returns what the quintic through the current state and the one a time `back` before adds to the current parabola, a time `u * back`
/// ahead. A state is value, velocity and acceleration.
#[must_use]
#[inline]
pub fn bend_ahead([x, v, a]: [f64; 3], [y, w, b]: [f64; 3], back: f64, u: f64) -> f64 {
    // the curve leads back from now
    let value = y - x + back * (v - 0.5 * back * a);
    let slope = back * (v - back * a - w);
    let bend = 0.5 * back * back * (b - a);
    let [cubic, quartic, quintic] = higher_terms([value, slope, bend]);
    u * u * u * (u * (quartic - u * quintic) - cubic)
}
}

pub mod neighbours {
// Searches that end at neighbouring doubles.

/// Returns neighbouring doubles of which `holds` is true at the first and false at the second, as at the two given places; or
/// the interval that `most` halvings leave.
#[must_use]
pub fn bisect([mut near, mut far]: [f64; 2], most: usize, mut holds: impl FnMut(f64) -> bool) -> [f64; 2] {
    for _ in 0..most {
        let middle = 0.5 * (near + far);
        let is_between = f64::min(near, far) < middle && middle < f64::max(near, far);
        if !is_between {
            break;
        }
        if holds(middle) {
            near = middle;
        } else {
            far = middle;
        }
    }
    [near, far]
}

/// Returns a time (s) after any event that is meant to happen at `t`, later by about `slack` units in its last place.
#[must_use]
pub fn shortly_after(t: f64, slack: f64) -> f64 {
    t + slack * f64::EPSILON * t.abs() + f64::MIN_POSITIVE
}
}

pub mod newton {
//! Newton's iteration.

use super::grid::{bound_at_first, going_on, next_point};
use super::limits::{BORDER, LARGEST_CORRECTION};
use super::numbers::larger;
use super::running_max::running_max;
use super::solution::{Solution, Solved};

/// A Newton iteration from grid point to grid point, so that its result does not depend on its start.
pub struct Newton {
    is_first: bool,
    is_lost: bool,
    has_settled: bool,
    first: f64,
    /// Largest correction, and the bound below which the iteration ends, both in cells of the grid.
    largest: f64,
    bound: f64,
    /// Spacing, in cells, of the points to which coordinates next to a border continue.
    cells: f64,
}

impl Newton {
    /// Creates an iteration before its first step.
    pub fn new() -> Self {
        let bound = bound_at_first(BORDER);
        Self { is_first: true, is_lost: false, has_settled: false, first: 0.0, largest: 0.0, bound, cells: 1.0 }
    }

    /// Records the correction of a coordinate, whose grid has cells of width `cell`, and whose scale is `scale`.
    pub fn record(&mut self, delta: f64, cell: f64, scale: f64) {
        let size = delta.abs();
        if self.is_first {
            self.first = running_max(self.first, size / scale);
        }
        self.largest = running_max(self.largest, size / cell);
        self.is_lost |= size.is_nan() || size > LARGEST_CORRECTION * scale;
    }

    /// Returns whether the iteration is done: it has settled or is lost.
    pub fn is_done(&mut self) -> bool {
        self.has_settled = !self.is_lost && self.largest <= self.bound;
        let is_done = self.has_settled || self.is_lost;
        if !is_done {
            (self.bound, self.cells) = going_on(self.largest, self.bound, BORDER);
        }
        (self.is_first, self.largest) = (false, 0.0);
        is_done
    }

    /// Returns the grid point to which a coordinate continues.
    pub fn next(&self, x: f64, delta: f64, cell: f64) -> f64 {
        next_point(x, delta, cell, self.cells, BORDER)
    }
}

impl<M: Solved> Solution<M> {
    /// Records the outcome of an iteration.
    pub fn note(&mut self, newton: &Newton) {
        self.is_settled &= newton.has_settled;
        self.first = larger(self.first, newton.first);
    }
}
}

pub mod branches {
//! Branches of formulas along the motion.

use super::equations::Branches;
use super::limits::{MOST_HALVINGS, SLACK};
use super::neighbours::{bisect, shortly_after};
use super::solution::{Along, Solution, Solved};
use super::work::{Work, of_sides};

/// Returns the branches of formulas of time at a time: the later ones if they change at that time, but the earlier ones at
/// the end of the file's analysis.
pub fn sides_at<M: Branches>(t: f64, m: &M, work: &mut Work) -> M::Sides {
    work.add(of_sides::<M>());
    match M::END {
        Some(end) if is_end::<M>(t) => m.sides_of_time(end - 2.0 * (shortly_after(end, SLACK) - end)),
        _ => m.sides_of_time(shortly_after(t, SLACK)),
    }
}

/// Returns whether a time is the end of the file's analysis.
fn is_end<M: Branches>(t: f64) -> bool {
    M::END.is_some_and(|end| t <= end && shortly_after(t, SLACK) >= end)
}

/// Returns the first time in a step at which formulas of time change their branches; the end of the step if they do not.
pub fn first_edge<M: Branches>(from: f64, to: f64, m: &M, work: &mut Work) -> f64 {
    let here = sides_at(from, m, work);
    if sides_at(to, m, work) == here {
        return to;
    }
    let [_, edge] = bisect([from, to], MOST_HALVINGS, |t| sides_at(t, m, work) == here);
    edge
}

/// Returns the branches at a position next to the one that is solved for.
pub fn sides_near<M: Branches>(q: &M::Q, t: f64, m: &M, work: &mut Work) -> M::Sides {
    m.sides_of_motion(q, t, &sides_at(t, m, work))
}

/// Replaces the branches of time.
pub fn with_time<M: Branches>(sides: &M::Sides, of_time: &M::Sides) -> M::Sides {
    let mut all = *sides;
    let pairs = of_time.as_ref().iter().zip(M::is_of_time());
    for (side, (of_time, is_of_time)) in all.as_mut().iter_mut().zip(pairs) {
        if *is_of_time {
            *side = *of_time;
        }
    }
    all
}

/// Returns the branches of formulas of the motion just ahead of a position; at the end of the file's analysis those just
/// behind it.
pub fn sides_ahead<M: Solved>(at: &Solution<M>, m: &M) -> M::Sides {
    let (mut q, t) = M::Along::ahead(m, at);
    if !is_end::<M>(at.t) {
        return m.sides_of_motion(&q, t, &at.sides);
    }
    for (q, now) in q.as_mut().iter_mut().zip(at.q.as_ref()) {
        *q = now - (*q - now);
    }
    m.sides_of_motion(&q, at.t - (t - at.t), &at.sides)
}
}

pub mod reach {
//! Solves at a time, on the branches that hold there.

use super::branches::{sides_ahead, sides_at, with_time};
use super::error::Fault;
use super::limits::{ACCURACY, MOST_BRANCHES, STEEP, STEEPEST};
use super::measured::Measured;
use super::numbers::{larger, largest};
use super::solution::{Along, Solution, Solved};
use super::work::Work;

/// Solves at a time from a guess; `from` is the previous solution of the motion.
pub fn reach<M: Solved>(
    guess: &M::Tears,
    from: &Solution<M>,
    t: f64,
    m: &M,
    at: &mut Solution<M>,
    work: &mut Work,
) -> Result<(), Fault> {
    let of_time = sides_at(t, m, work);
    if !M::OF_MOTION {
        return find(guess, from, t, m, &of_time, at, work);
    }
    let mut sides = from.sides;
    for _ in 0..MOST_BRANCHES {
        sides = with_time::<M>(&sides, &of_time);
        find(guess, from, t, m, &sides, at, work)?;
        let now = sides_ahead(at, m);
        if now == sides {
            return Ok(());
        }
        sides = now;
    }
    Err(Fault::TooFar)
}

/// Solves on given branches of formulas.
pub fn find<M: Solved>(
    guess: &M::Tears,
    from: &Solution<M>,
    t: f64,
    m: &M,
    sides: &M::Sides,
    at: &mut Solution<M>,
    work: &mut Work,
) -> Result<(), Fault> {
    work.add(1);
    m.solve(guess, t, sides, at);
    if !at.is_settled || !at.holds {
        work.add(2);
        find_with_pivoting(from, t, m, sides, at)?;
    }
    if !m.conditions_hold(&at.q, t, sides) {
        return Err(Fault::NotANumber);
    }
    if !m.redundant_rows_hold(&at.q, t, sides) {
        return Err(Fault::LeftOut);
    }
    at.monitors = m.monitors(&at.q, t, sides);
    at.sides = *sides;
    at.along.note(m, t);
    at.measures.leave_out();
    if at.is_finite() { Ok(()) } else { Err(Fault::NotANumber) }
}

/// Solves by pivoting, then again by the operations from that position; keeps the result of pivoting if they fail again.
#[cold]
#[inline(never)]
fn find_with_pivoting<M: Solved>(
    from: &Solution<M>,
    t: f64,
    m: &M,
    sides: &M::Sides,
    at: &mut Solution<M>,
) -> Result<(), Fault> {
    let q = M::Along::predicted(m, from, t - from.t);
    let pivoted = m.pivoted(&q, t, sides, at)?;
    m.solve(&M::tears(&pivoted.q), t, sides, at);
    let first = pivoted.first;
    if !at.is_settled || !at.holds {
        *at = pivoted;
    }
    at.first = first;
    Ok(())
}

/// Returns the relative rounding error of velocities and accelerations per unit of steepness. The closer a position is to a
/// singular one, the more rounding is amplified.
pub fn rounding<M: Solved>(at: &Solution<M>, m: &M) -> f64 {
    let (t, sides, scales) = (at.t, &at.sides, M::scales());
    let slopes = m.phi_q(&at.q, t, sides);
    let mut norms = at.q;
    norms.as_mut().fill(f64::MIN_POSITIVE);
    for (&(row, column), slope) in M::pattern().iter().zip(slopes.as_ref()) {
        let norm = norms.as_mut().get_mut(row);
        if let (Some(norm), Some(scale)) = (norm, scales.as_ref().get(column)) {
            *norm = larger(*norm, slope.abs() * scale);
        }
    }
    let ratio = |left: f64, right: f64| if right > 0.0 { left / right } else { 1.0 };
    let nu = m.nu(&at.q, t, sides);
    let velocity = ratio(largest(&at.qd, scales), largest(&nu, &norms));
    let gamma = m.gamma(&at.q, &at.qd, t, sides);
    let acceleration = ratio(largest(&at.qdd, scales), largest(&gamma, &norms));
    let amplified = larger(larger(velocity, acceleration), 1.0);
    f64::EPSILON * amplified
}

/// Returns whether a solution lies on the branch of `from`; `steepness` is how much steeper the parameters make the
/// equations than those of the file.
pub fn stays_on_branch<M: Solved>(
    from: &Solution<M>,
    at: &mut Solution<M>,
    m: &M,
    is_wanted: bool,
    steepness: f64,
    work: &mut Work,
) -> bool {
    let steepest = at.steepest / steepness;
    if at.monitors != from.monitors || at.is_negative != from.is_negative || steepest > STEEPEST {
        return false;
    }
    if steepest > STEEP {
        at.measures.leave_varied_out();
    }
    if !is_wanted || steepest <= STEEP {
        return true;
    }
    work.add(1);
    let is_in_doubt = steepest * rounding(at, m) > ACCURACY;
    !is_in_doubt
}
}

pub mod state {
//! A mechanism that moves with time, and its state.

use super::error::Error;
use super::limits::{AHEAD, FARTHEST_AHEAD, LONGEST_AHEAD};
use super::measured::Measured;
use super::numbers::{Numbers, largest, predicted};
use super::solution::{Along, Solution, Solved};
use super::track::Track;
use super::work::Work;
use core::fmt::Debug;

/// Parameters of a mechanism.
pub trait Parameters: Copy + Debug + Default {
    /// Interpolates between these parameters and others.
    #[must_use]
    fn towards(&self, other: &Self, part: f64) -> Self;

    /// Returns whether all parameters are finite.
    fn is_finite(&self) -> bool;
}

/// A mechanism whose motion follows time.
pub trait Timed: Solved<Along = Time> {
    /// Parameters of the mechanism.
    type Params: Parameters;
    /// Continuation along inputs; `()` if the mechanism has none.
    type Continuation: Continuation<Self>;
    /// Time of the last check of each domain boundary of a formula of time (s).
    type Passed: Numbers;
    /// A number for each result.
    type Row: Numbers;

    /// First time of the file's analysis (s), at which the mechanism is assembled.
    const START_TIME: f64;
    /// Duration of the file's analysis (s).
    const SPAN: f64;
    /// Longest step (s).
    const LONGEST_STEP: f64;
    /// Shortest step (s).
    const SMALLEST_STEP: f64;
    /// Largest number of evaluations for the domain boundaries of a step.
    const WORK_OF_BOUNDARIES: usize = 0;

    /// Creates the mechanism with the given parameters.
    fn new(params: &Self::Params) -> Self;

    /// Parameters of the mechanism.
    fn params(&self) -> &Self::Params;

    /// Returns the assembled position with the parameters of the file.
    fn start() -> &'static Self::Q;

    /// Returns the coordinates by the poses of the file, with the present parameters; the loops are not closed yet.
    fn drawn(&self) -> Self::Q;

    /// Solves at a position from far away. Returns `None` if that does not converge, or if blocks are too large for it.
    fn closed(&self, _q: &Self::Q, _t: f64, _work: &mut Work) -> Option<Self::Q> {
        None
    }

    /// Returns the first unchecked domain boundary in a step, with its time.
    fn first_boundary(&self, _from: f64, _to: f64, _passed: &Self::Passed, _work: &mut Work) -> Option<(usize, f64)> {
        None
    }

    /// Checks both sides of a domain boundary near the state.
    fn check_boundary(_state: &mut State<Self>, _rim: usize, _t: f64, _work: &mut Work) -> Result<(), Error> {
        Ok(())
    }
}

/// Continuation of a mechanism along its inputs.
pub trait Continuation<M: Timed>: Copy + Debug {
    /// Largest number of evaluations for the return to time: without steps, and for each step.
    const WORK: [usize; 2];

    /// Creates an inactive continuation.
    fn new(params: &M::Params) -> Self;

    /// Returns whether inputs, rather than time, have moved the mechanism to its position.
    fn is_active(&self) -> bool;

    /// Moves a mechanism back to the inputs that its formulas give at its time, in at most `most` steps. Returns the number
    /// of steps that are left, or `None` if it has not arrived yet.
    fn resume_time(state: &mut State<M>, most: usize, work: &mut Work) -> Result<Option<usize>, Error>;
}

impl<M: Timed> Continuation<M> for () {
    const WORK: [usize; 2] = [0, 0];

    fn new(_: &M::Params) -> Self {}

    fn is_active(&self) -> bool {
        false
    }

    fn resume_time(_: &mut State<M>, most: usize, _: &mut Work) -> Result<Option<usize>, Error> {
        Ok(Some(most))
    }
}

/// Motion along time.
#[derive(Clone, Copy, Debug)]
pub struct Time;

impl<M: Timed> Along<M> for Time {
    const ZERO: Self = Self;

    fn predicted(_: &M, from: &Solution<M>, h: f64) -> M::Q {
        predicted(&from.q, &from.qd, &from.qdd, h)
    }

    fn ahead(_: &M, at: &Solution<M>) -> (M::Q, f64) {
        let (speed, acceleration) = (largest(&at.qd, M::scales()), largest(&at.qdd, M::scales()));
        let mut ahead = f64::min(f64::min(AHEAD * M::SPAN, LONGEST_AHEAD), FARTHEST_AHEAD / speed);
        ahead = f64::min(ahead, FARTHEST_AHEAD / (acceleration * ahead));
        (predicted(&at.q, &at.qd, &at.qdd, ahead), at.t + ahead)
    }
}

/// How a mechanism was assembled for its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Assembly {
    /// By continuation from the assembled position of the file's own parameters, along its branch.
    Led,
    /// From the poses that the file draws with these parameters, as `mechc run --set` does, because the continuation did
    /// not arrive. This may be another branch.
    Drawn,
}

/// A mechanism at a time.
#[derive(Clone, Debug)]
pub struct State<M: Timed> {
    pub(super) model: M,
    /// Position along time.
    pub(super) track: Track<M>,
    /// Steepness of the equations relative to that with the parameters of the file.
    pub(super) steepness: f64,
    /// The kind of assembly.
    pub(super) assembly: Assembly,
    /// Continuation along inputs.
    pub(super) continuation: M::Continuation,
    /// Time of the last check of each domain boundary (s).
    pub(super) passed: M::Passed,
}

impl<M: Timed> State<M> {
    /// Returns the present solution.
    pub(super) fn at(&self) -> &Solution<M> {
        self.track.at()
    }

    /// Returns how the mechanism was assembled for its parameters.
    #[must_use]
    pub fn assembly(&self) -> Assembly {
        self.assembly
    }

    /// Returns the time (s).
    #[must_use]
    pub fn t(&self) -> f64 {
        self.at().t
    }

    /// Returns the parameters.
    #[must_use]
    pub fn params(&self) -> &M::Params {
        self.model.params()
    }

    /// Returns the coordinates (m, rad), by their indices.
    #[must_use]
    pub fn q(&self) -> &M::Q {
        &self.at().q
    }

    /// Returns the velocities of the coordinates (m/s, rad/s).
    #[must_use]
    pub fn qd(&self) -> &M::Q {
        &self.at().qd
    }

    /// Returns the accelerations of the coordinates (m/s^2, rad/s^2).
    #[must_use]
    pub fn qdd(&self) -> &M::Q {
        &self.at().qdd
    }

    /// Returns the measures, by their indices, with their first and second time derivatives; `NAN` where a measure has no
    /// value, which fails no step.
    #[must_use]
    pub fn measures(&self) -> &M::Measures {
        &self.at().measures
    }

    /// Returns whether inputs, rather than time, have moved the mechanism here.
    pub(super) fn is_input_driven(&self) -> bool {
        self.continuation.is_active()
    }

    /// Returns all results in the order of the columns of `mechc run`: the time, coordinates and measures, then their first
    /// and second derivatives.
    #[must_use]
    pub fn row(&self) -> M::Row {
        let at = self.at();
        let [values, rates, accelerations] = at.measures.lists();
        let zeroth = at.q.as_ref().iter().chain(values);
        let first = at.qd.as_ref().iter().chain(rates);
        let second = at.qdd.as_ref().iter().chain(accelerations);
        let all = [at.t].into_iter().chain(zeroth.chain(first).chain(second).copied());
        let mut row = M::Row::ZERO;
        row.as_mut().iter_mut().zip(all).for_each(|(cell, value)| *cell = value);
        row
    }
}
}

pub mod assemble {
//! Assembly at the start of a motion.

use super::branches::sides_near;
use super::error::{Error, Fault};
use super::limits::{FIRST_PARTS, LARGEST_CORRECTION, MOST_PARTS, MOST_SHORTER, MOST_TRIALS, SMALLEST_PART};
use super::numbers::Numbers;
use super::reach::reach;
use super::solution::Solution;
use super::state::{Assembly, Continuation, Parameters, State, Timed};
use super::track::Track;
use super::work::{Work, of_reaching, of_sides};

/// Largest number of evaluations of an assembly.
pub const fn most_work<M: Timed>() -> usize {
    let of_start = of_sides::<M>() + of_reaching::<M>();
    (2 + FIRST_PARTS + MOST_PARTS) * (of_start + of_sides::<M>() + 1)
        + of_sides::<M>()
        + (1 + MOST_SHORTER) * MOST_TRIALS
}

/// Assembles the mechanism at its first time with the given parameters: along the branch of the file's parameters if a
/// short path leads there, else from the poses that the file draws with these parameters, and only then along a long path.
pub fn assemble<M: Timed>(params: &M::Params, work: &mut Work) -> Result<State<M>, Error> {
    if !params.is_finite() {
        return Err(Error::NotANumber);
    }
    let mut path = ParameterPath::<M>::new(work)?;
    let model = M::new(params);
    match path.advance(params, FIRST_PARTS, work) {
        Ok(at) => return Ok(path.state(model, at, Assembly::Led)),
        Err(Error::NotANumber) => return Err(Error::NotANumber),
        Err(_) => {}
    }
    let mut at = path.at;
    let drawn = model.closed(&model.drawn(), M::START_TIME, work);
    if drawn.is_some_and(|q| start(&q, &model, &mut at, work).is_ok()) {
        return Ok(path.state(model, at, Assembly::Drawn));
    }
    let at = path.advance(params, MOST_PARTS, work)?;
    Ok(path.state(model, at, Assembly::Led))
}

/// The path from the file's parameters to others.
struct ParameterPath<M: Timed> {
    /// Steepness of the equations with the file's parameters.
    usual: f64,
    /// Solution at the present position.
    at: Solution<M>,
    /// Fraction that is done, and the next increment to try.
    done: f64,
    part: f64,
}

impl<M: Timed> ParameterPath<M> {
    /// Creates the path at its beginning.
    fn new(work: &mut Work) -> Result<Self, Error> {
        let mut at = Solution::ZERO;
        start(M::start(), &M::new(&M::Params::default()), &mut at, work).map_err(Fault::at_start)?;
        Ok(Self { usual: at.steepest, at, done: 0.0, part: 1.0 })
    }

    /// Continues to the end in at most `most` trials.
    fn advance(&mut self, params: &M::Params, most: usize, work: &mut Work) -> Result<Solution<M>, Error> {
        let (file, mut found, mut why) = (M::Params::default(), self.at, Error::Divergence);
        for _ in 0..most {
            let next = f64::min(self.done + self.part, 1.0);
            let is_last = next >= 1.0;
            let params = if is_last { *params } else { file.towards(params, next) };
            let model = M::new(&params);
            let is_far = self.part < 1.0 && is_far(&self.at.q, &model, &mut found, work);
            let result = if is_far { Err(Fault::TooFar) } else { start(&self.at.q, &model, &mut found, work) };
            if result.is_ok() && found.is_negative == self.at.is_negative {
                if is_last {
                    return Ok(found);
                }
                (self.at, self.done, self.part) = (found, next, 2.0 * self.part);
            } else {
                why = result.err().map_or(Error::Divergence, Fault::at_start);
                self.part *= 0.5;
            }
            if self.part < SMALLEST_PART {
                break;
            }
        }
        Err(why)
    }

    /// Creates the state at a solution.
    fn state(&self, model: M, at: Solution<M>, assembly: Assembly) -> State<M> {
        let ratio = at.steepest / self.usual;
        let mut passed = M::Passed::ZERO;
        passed.as_mut().fill(f64::NEG_INFINITY);
        State {
            steepness: if ratio > 0.0 { ratio } else { 1.0 },
            continuation: M::Continuation::new(model.params()),
            model,
            track: Track { solutions: [at, self.at], is_second: false, is_smooth: false, stride: M::LONGEST_STEP },
            assembly,
            passed,
        }
    }
}

/// Returns whether a position is too far away to solve from by the operations alone; pivoting would cost many times as
/// much.
fn is_far<M: Timed>(q: &M::Q, m: &M, at: &mut Solution<M>, work: &mut Work) -> bool {
    let sides = sides_near(q, M::START_TIME, m, work);
    work.add(1);
    m.solve(&M::tears(q), M::START_TIME, &sides, at);
    !at.is_settled && at.first > LARGEST_CORRECTION
}

/// Solves at the first time from a position nearby.
fn start<M: Timed>(q: &M::Q, m: &M, at: &mut Solution<M>, work: &mut Work) -> Result<(), Fault> {
    let mut near = Solution::near(q, M::START_TIME);
    near.sides = sides_near(q, M::START_TIME, m, work);
    reach(&M::tears(q), &near, M::START_TIME, m, at, work)?;
    if at.first <= LARGEST_CORRECTION { Ok(()) } else { Err(Fault::TooFar) }
}
}

pub mod explain {
//! The reason why a motion cannot go on.

use super::branches::sides_at;
use super::equations::{Branches, Checks};
use super::error::{Error, Fault};
use super::limits::{NEAR_FOLD, SINGULAR};
use super::solution::{Solution, Solved};
use super::state::{State, Timed};
use super::work::{Work, of_sides};

/// Returns the reason why even the shortest step from a state towards a time is refused.
pub fn explain<M: Timed>(state: &State<M>, fault: Fault, t: f64, work: &mut Work) -> Error {
    let at = state.at();
    if let Some(error) = regular(at, fault, t, &state.model, work) {
        return error;
    }
    if at.steepest < SINGULAR * state.steepness {
        return if fault == Fault::LeftOut { Error::Inconsistent } else { Error::Divergence };
    }
    let left = until_turn(at);
    meeting::<M>(if t < at.t { -left } else { left }, M::SPAN)
}

/// Largest number of evaluations that [`regular`] takes.
pub const fn of_regular<M: Branches>() -> usize {
    1 + 2 * of_sides::<M>()
}

/// Returns the reason, if it does not depend on how near the position is to a singular one.
pub fn regular<M: Solved>(at: &Solution<M>, fault: Fault, t: f64, m: &M, work: &mut Work) -> Option<Error> {
    work.add(1);
    let values = m.phi(&at.q, t, &at.sides);
    if fault == Fault::NotANumber || values.as_ref().iter().any(|value| !value.is_finite()) {
        return Some(Error::NotANumber);
    }
    // a position that jumps far is not found on the other side
    let mut is_at_edge = || sides_at(at.t, m, work) != sides_at(t, m, work);
    let jumps = fault == Fault::NotSmooth || (fault == Fault::TooFar && is_at_edge());
    jumps.then_some(Error::NotSmooth)
}

/// Returns the time until a dead point, from the fastest coordinate: a time u before a dead point a motion behaves like the
/// root of u, whose slope over twice its curvature is u.
pub fn until_turn<M: Solved>(at: &Solution<M>) -> f64 {
    let rates = at.qd.as_ref().iter().zip(at.qdd.as_ref()).zip(M::scales().as_ref());
    let sooner = |(speed, left): (f64, f64), ((v, a), scale): ((&f64, &f64), &f64)| {
        if v.abs() / scale > speed { (v.abs() / scale, 0.5 * v / a) } else { (speed, left) }
    };
    rates.fold((0.0, 0.0), sooner).1
}

/// Returns what the motion meets at a singular position: a dead point if it is at most a small part of the span ahead.
/// Otherwise redundant equations may decide how the motion continues.
pub fn meeting<M: Checks>(left: f64, span: f64) -> Error {
    if left > 0.0 && left < NEAR_FOLD * span {
        Error::LockUp
    } else if M::HAS_REDUNDANT_ROWS {
        Error::Inconsistent
    } else {
        Error::Bifurcation
    }
}
}

pub mod step {
//! Steps along time.

use super::branches::first_edge;
use super::error::{Error, Fault};
use super::explain::{explain, of_regular};
use super::hermite::bend_ahead;
use super::limits::{
    CALM_BETWEEN, CALM_CORRECTION, CRUMB, FARTHEST_BEND, LARGEST_CORRECTION, LARGEST_GAP, LARGEST_MOTION, LEAD,
    POSITION_JUMP, REST, VELOCITY_JUMP,
};
use super::numbers::{Numbers, difference, largest};
use super::reach::{find, reach, stays_on_branch};
use super::solution::{Solution, Solved};
use super::state::{Continuation, State, Timed};
use super::track::Checkpoint;
use super::work::{Progress, Work, of_step};

/// Largest number of evaluations of a call with at most `most` steps.
pub const fn most_work<M: Timed>(most: usize) -> usize {
    let [of_return, of_return_step] = M::Continuation::WORK;
    let of_step = of_step::<M>() + M::WORK_OF_BOUNDARIES;
    let of_step = if of_return_step > of_step { of_return_step } else { of_step };
    most.saturating_mul(of_step).saturating_add(of_return + of_regular::<M>())
}

/// Moves a state to time `t` (s) in at most `most` steps, whose length is controlled by the motion. Position, velocity and
/// acceleration are those of the branch of the state, whichever direction `t` lies in. After an error the state is
/// unchanged; not arriving within the steps is an error.
pub fn step<M: Timed>(t: f64, state: &mut State<M>, most: usize, work: &mut Work) -> Result<(), Error> {
    let is_beyond = (t - state.at().t).abs() > M::LONGEST_STEP * most as f64;
    if is_beyond && t.is_finite() {
        return Err(Error::TooFar);
    }
    go(t, state, most, true, work).map(|_| ())
}

/// Moves a state towards time `t` (s) as [`step`] does, but returns the progress if the steps do not suffice.
pub fn step_within<M: Timed>(t: f64, state: &mut State<M>, most: usize, work: &mut Work) -> Result<Progress, Error> {
    go(t, state, most, false, work)
}

fn go<M: Timed>(t: f64, state: &mut State<M>, most: usize, is_whole: bool, work: &mut Work) -> Result<Progress, Error> {
    if !(t - state.at().t).is_finite() {
        return Err(Error::NotANumber);
    }
    if state.is_input_driven() { resume(t, state, most, is_whole, work) } else { march(t, state, most, is_whole, work) }
}

/// Returns to the inputs that the formulas give, then moves along time.
#[cold]
#[inline(never)]
fn resume<M: Timed>(
    t: f64,
    state: &mut State<M>,
    most: usize,
    is_whole: bool,
    work: &mut Work,
) -> Result<Progress, Error> {
    let (continuation, track) = (state.continuation, state.track);
    let result = match M::Continuation::resume_time(state, most, work) {
        Ok(Some(left)) => march(t, state, left, is_whole, work),
        Ok(None) if is_whole => Err(Error::TooFar),
        Ok(None) => Ok(Progress { fraction: 0.0 }),
        Err(error) => Err(error),
    };
    if result.is_err() {
        (state.continuation, state.track) = (continuation, track);
    }
    result
}

/// Steps along time.
fn march<M: Timed>(
    t: f64,
    state: &mut State<M>,
    most: usize,
    is_whole: bool,
    work: &mut Work,
) -> Result<Progress, Error> {
    let (mut before, passed, from) = (Checkpoint::of(&state.track), state.passed, state.at().t);
    let mut why = Error::TooFar;
    for _ in 0..most {
        let now = state.at().t;
        let left = t - now;
        if left == 0.0 {
            return Ok(Progress::REACHED);
        }
        let stride = state.track.stride;
        let wanted = if stride >= CRUMB * left.abs() { t } else { now + stride.copysign(left) };
        // a branch that holds only briefly may be over before the end of the step
        let edge = first_edge(now, wanted, &state.model, work);
        let next = match state.model.first_boundary(now, edge, &state.passed, work) {
            None => edge,
            Some((boundary, at)) => {
                let before = at - (LEAD * M::SPAN).copysign(left);
                if (before - now) * left <= 0.0 {
                    if let Err(error) = M::check_boundary(state, boundary, at, work) {
                        why = error;
                        break;
                    }
                    continue;
                }
                before
            }
        };
        let (is_last, size) = (next == t, (next - now).abs());
        match advance(state, next, is_last, work) {
            Ok(is_calm) => {
                let longest = if is_calm { stride.max(2.0 * size) } else { stride.min(size) };
                state.track.stride = longest.min(M::LONGEST_STEP);
                if is_last {
                    return Ok(Progress::REACHED);
                }
                before.keep(&state.track);
            }
            Err(fault) => {
                let half = 0.5 * size;
                (state.track.stride, state.track.is_smooth) = (half, false);
                if half < M::SMALLEST_STEP || now + half == now {
                    why = explain(state, fault, next, work);
                    break;
                }
            }
        }
    }
    let now = state.at().t;
    if now == t {
        return Ok(Progress::REACHED);
    }
    if why == Error::TooFar && !is_whole {
        return Ok(Progress::part(now - from, t - from));
    }
    before.restore(&mut state.track);
    state.passed = passed;
    Err(why)
}

/// Takes one step to a time. Returns whether a longer step would do as well.
fn advance<M: Timed>(state: &mut State<M>, t: f64, is_wanted: bool, work: &mut Work) -> Result<bool, Fault> {
    let is_smooth = state.track.is_smooth;
    let (from, at) = state.track.both();
    let m = &state.model;
    let h = t - from.t;
    let (v, a) = (M::tears(&from.qd), M::tears(&from.qdd));
    let mut motion = if is_smooth { bend(from, at, h) } else { M::Tears::ZERO };
    for (motion, (v, a)) in motion.as_mut().iter_mut().zip(v.as_ref().iter().zip(a.as_ref())) {
        // Taylor
        *motion += h * (v + 0.5 * h * a);
    }
    let is_calm = try_step(&motion, from, t, m, at, |at| gap(from, at, h), work)?;
    if !stays_on_branch(from, at, m, is_wanted, state.steepness, work) {
        return Err(Fault::Singular);
    }
    if M::OF_TIME && at.sides != from.sides && jumps(from, at, m, work) {
        return Err(Fault::NotSmooth);
    }
    let is_smooth = at.sides == from.sides;
    state.track.is_smooth = is_smooth;
    state.track.is_second = !state.track.is_second;
    Ok(is_calm)
}

/// Solves at a time, or at a position of a path, if the expected motion of the Newton coordinates and the gap are small
/// enough for a step. Returns whether a longer step would do as well. The gap is the distance of a solution from the
/// position that the slopes at both ends predict, scaled.
pub fn try_step<M: Solved>(
    motion: &M::Tears,
    from: &Solution<M>,
    t: f64,
    m: &M,
    at: &mut Solution<M>,
    gap: impl FnOnce(&Solution<M>) -> f64,
    work: &mut Work,
) -> Result<bool, Fault> {
    // NaN is not small either
    let is_short = largest(motion, M::tear_scales()) <= LARGEST_MOTION;
    if !is_short {
        return Err(Fault::TooFar);
    }
    let mut guess = M::tears(&from.q);
    for (guess, motion) in guess.as_mut().iter_mut().zip(motion.as_ref()) {
        *guess += *motion;
    }
    reach(&guess, from, t, m, at, work)?;
    let gap = gap(at);
    let is_near = at.first <= LARGEST_CORRECTION && gap <= LARGEST_GAP;
    if !is_near {
        return Err(Fault::TooFar);
    }
    Ok(at.first < LARGEST_CORRECTION / CALM_CORRECTION && gap < LARGEST_GAP / CALM_BETWEEN)
}

/// Returns the distance of positions from those that velocities and accelerations at both ends predict (Hermite), scaled.
fn gap<M: Solved>(from: &Solution<M>, at: &Solution<M>, h: f64) -> f64 {
    let (x, v, a) = (M::tears(&from.q), M::tears(&from.qd), M::tears(&from.qdd));
    let (y, w, b) = (M::tears(&at.q), M::tears(&at.qd), M::tears(&at.qdd));
    let mut gaps = M::Tears::ZERO;
    let positions = y.as_ref().iter().zip(x.as_ref());
    let rates = v.as_ref().iter().zip(w.as_ref());
    let bends = a.as_ref().iter().zip(b.as_ref());
    for ((gap, (y, x)), ((v, w), (a, b))) in gaps.as_mut().iter_mut().zip(positions).zip(rates.zip(bends)) {
        *gap = y - x - 0.5 * h * (v + w) - h * h * (1.0 / 12.0) * (a - b);
    }
    largest(&gaps, M::tear_scales())
}

/// Returns the correction of Taylor's prediction over a time `h` (s) by the previous solution.
fn bend<M: Solved>(now: &Solution<M>, before: &Solution<M>, h: f64) -> M::Tears {
    let back = now.t - before.t;
    let u = h / back;
    if u.is_nan() || u.abs() > FARTHEST_BEND {
        return M::Tears::ZERO;
    }
    let (x, v, a) = (M::tears(&now.q), M::tears(&now.qd), M::tears(&now.qdd));
    let (y, w, b) = (M::tears(&before.q), M::tears(&before.qd), M::tears(&before.qdd));
    let mut bend = M::Tears::ZERO;
    let positions = x.as_ref().iter().zip(y.as_ref());
    let rates = v.as_ref().iter().zip(w.as_ref());
    let bends = a.as_ref().iter().zip(b.as_ref());
    for ((bend, (x, y)), ((v, w), (a, b))) in bend.as_mut().iter_mut().zip(positions).zip(rates.zip(bends)) {
        *bend = bend_ahead([*x, *v, *a], [*y, *w, *b], back, u);
    }
    bend
}

/// Returns whether position or velocity differ on the two sides of a time at which formulas change their branches: `at` is
/// the later side, and `from` has the branches of the earlier one.
fn jumps<M: Timed>(from: &Solution<M>, at: &Solution<M>, m: &M, work: &mut Work) -> bool {
    let mut before = *at;
    if find(&M::tears(&at.q), at, at.t, m, &from.sides, &mut before, work).is_err() {
        return true;
    }
    let (motion, change) = (difference(&at.q, &before.q), difference(&at.qd, &before.qd));
    let scales = M::scales();
    let fastest = largest(&at.qd, scales) + largest(&before.qd, scales) + REST / M::SPAN;
    largest(&motion, scales) > POSITION_JUMP || largest(&change, scales) > VELOCITY_JUMP * fastest
}
}

pub mod blocks {
// Sparse linear equations that fall apart into blocks, each solved by elimination with partial pivoting.
//
// They serve positions at which an order of elimination that was fixed beforehand loses digits. All scaling is by powers of
// two, which round nothing.

/// The structure of a square system in block triangular form: a block's equations hold its own unknowns and those of earlier
/// blocks.
#[derive(Clone, Copy, Debug)]
pub struct Blocks<'b> {
    /// The number of equations of each block.
    pub sizes: &'b [usize],
    /// The equations, block by block.
    pub rows: &'b [usize],
    /// The unknowns, block by block.
    pub columns: &'b [usize],
    /// The index of the first entry of each equation, then the number of entries.
    pub starts: &'b [usize],
    /// The unknown of each entry.
    pub entries: &'b [usize],
    /// By unknown: its place in `columns`.
    pub places: &'b [usize],
    /// By unknown: its unit, a power of two.
    pub units: &'b [f64],
}

/// Solves `A x = right`, where `values` are the entries of `A` and `right` is given by equation.
///
/// `work` has at least [`work_of`] numbers for the largest block; with fewer, the solution stops there. Writes for each block
/// whether its determinant is negative. Returns the smallest pivot, of rows scaled so that their largest entry is in [1, 2); NaN
/// wins.
pub fn solve(
    blocks: &Blocks<'_>,
    values: &[f64],
    right: &[f64],
    x: &mut [f64],
    work: &mut [f64],
    is_negative: &mut [bool],
) -> f64 {
    let (mut smallest, mut at) = (f64::INFINITY, 0);
    for (&size, is_negative) in blocks.sizes.iter().zip(is_negative) {
        let places = at..at + size;
        at += size;
        let (Some(rows), Some(columns)) = (blocks.rows.get(places.clone()), blocks.columns.get(places.clone())) else {
            break;
        };
        let Some((matrix, solution)) = work.split_at_mut_checked(size * (size + 1)) else {
            break;
        };
        for (line, &row) in lines(matrix, size + 1).zip(rows) {
            fill(blocks, row, places.start, values, right, x, line);
        }
        let Some(solution) = solution.get_mut(..size) else {
            break;
        };
        let pivot;
        (pivot, *is_negative) = eliminate(matrix, solution);
        smallest = if pivot >= smallest { smallest } else { pivot };
        for (&column, &value) in columns.iter().zip(&*solution) {
            if let (Some(x), Some(unit)) = (x.get_mut(column), blocks.units.get(column)) {
                *x = value * unit;
            }
        }
    }
    smallest
}

/// Returns the number of `f64` that [`solve`] needs as `work` for a block of `size` equations.
#[must_use]
pub const fn work_of(size: usize) -> usize {
    size * (size + 2)
}

/// Returns the rows of a row-major matrix.
fn lines(matrix: &mut [f64], width: usize) -> impl Iterator<Item = &mut [f64]> {
    let mut left = matrix;
    core::iter::from_fn(move || {
        let (line, rest) = core::mem::take(&mut left).split_at_mut_checked(width)?;
        left = rest;
        Some(line)
    })
}

/// Writes an equation of the block whose unknowns begin at `first` into `line`, scaled, with known terms on the right side.
fn fill(blocks: &Blocks<'_>, row: usize, first: usize, values: &[f64], right: &[f64], x: &[f64], line: &mut [f64]) {
    line.fill(0.0);
    let (mut sum, mut largest) = (right.get(row).copied().unwrap_or(f64::NAN), 0.0);
    let ends = (blocks.starts.get(row), blocks.starts.get(row + 1));
    let (Some(&from), Some(&to)) = ends else {
        return;
    };
    let entries = blocks.entries.iter().zip(values).take(to).skip(from);
    let size = line.len() - 1;
    for (&column, &value) in entries {
        let place = blocks.places.get(column).map_or(usize::MAX, |place| place.wrapping_sub(first));
        let unit = blocks.units.get(column).copied().unwrap_or(1.0);
        match line.get_mut(place).filter(|_| place < size) {
            Some(entry) => {
                *entry = value * unit;
                largest = if entry.abs() > largest { entry.abs() } else { largest };
            }
            None => sum -= value * x.get(column).copied().unwrap_or(0.0),
        }
    }
    if let Some(last) = line.last_mut() {
        *last = sum;
    }
    if largest > 0.0 && largest.is_finite() {
        // the inverse of the largest power of two that is not above the largest entry
        let factor = 1.0 / f64::from_bits(largest.to_bits() & 0x7ff0_0000_0000_0000);
        for entry in line {
            *entry *= factor;
        }
    }
}

/// Solves rows that end with their right sides by elimination with partial pivoting. Returns the smallest pivot, and whether
/// the determinant is negative.
fn eliminate(matrix: &mut [f64], x: &mut [f64]) -> (f64, bool) {
    let width = x.len() + 1;
    let (mut smallest, mut is_negative) = (f64::INFINITY, false);
    let mut left = &mut *matrix;
    for k in 0..x.len() {
        let Some((first, below)) = core::mem::take(&mut left).split_at_mut_checked(width) else {
            break;
        };
        let entry = |line: &[f64]| line.get(k).copied().unwrap_or(0.0);
        for line in lines(below, width) {
            if entry(line).abs() > entry(first).abs() {
                is_negative = !is_negative;
                for (a, b) in first.iter_mut().zip(line) {
                    core::mem::swap(a, b);
                }
            }
        }
        let pivot = entry(first);
        is_negative ^= pivot < 0.0;
        smallest = if pivot.abs() >= smallest { smallest } else { pivot.abs() };
        for line in lines(below, width) {
            let factor = entry(line) / pivot;
            if factor != 0.0 {
                for (a, b) in line.iter_mut().zip(&*first).skip(k) {
                    *a -= factor * b;
                }
            }
        }
        left = below;
    }
    let mut rest = &*matrix;
    for k in (0..x.len()).rev() {
        let Some((before, line)) = rest.split_at_checked(k * width) else {
            break;
        };
        rest = before;
        let sum = line.get(width - 1).copied().unwrap_or(f64::NAN);
        let sum = line.iter().zip(&*x).skip(k + 1).fold(sum, |sum, (a, x)| sum - a * x);
        if let (Some(x), Some(pivot)) = (x.get_mut(k), line.get(k)) {
            *x = sum / pivot;
        }
    }
    (smallest, is_negative)
}
}

pub mod pivoting {
//! Elimination with partial pivoting, for positions where the fixed order of `solve` loses digits.

use super::blocks::{self, Blocks};
use super::branches::sides_near;
use super::error::Fault;
use super::grid::{bound_at_first, going_on, next_point, on_grid};
use super::limits::{BORDER, ITERATIONS, MOST_SHORTER, MOST_TRIALS, NEAR};
use super::numbers::{Flags, Numbers, larger, largest};
use super::solution::{Along, Solution, Solved};
use super::work::Work;

/// Equations that can be solved by elimination with partial pivoting.
pub trait Pivoting: Solved {
    /// Workspace for the elimination of the largest block.
    type Work: Numbers;
    /// A flag for each block of equations.
    type Blocks: Flags;
    /// Derivatives of coordinates, velocities and accelerations by inputs and parameters that measures hold.
    type Varied: Numbers;
    /// A right side for each derivative by the variable of the motion.
    type Rights: AsRef<[Self::Q]>;

    /// Largest residual of an equation, relative to the norm of its row.
    const TOLERANCE: f64;
    /// True if measures hold third derivatives of the coordinates.
    const HAS_JERK: bool = false;
    /// True for each derivative by inputs and parameters that is one by two of them.
    const IS_BY_TWO: &'static [bool] = &[];

    /// Returns the blocks of the equations.
    fn blocks() -> &'static Blocks<'static>;

    /// Returns the blocks whose determinants change.
    fn turning() -> &'static [usize];

    /// Returns the width of a cell of each coordinate's grid.
    fn cells() -> &'static Self::Q;

    /// Returns the right side of the jerk equation.
    fn jerk(&self, _orders: [&Self::Q; 3], _t: f64, _sides: &Self::Sides) -> Self::Q {
        Self::Q::ZERO
    }

    /// Returns the right sides for the derivatives by inputs and parameters, as far as the derivatives before them are
    /// solved.
    fn varied_right(
        &self,
        _orders: [&Self::Q; 3],
        _varied: &Self::Varied,
        _t: f64,
        _sides: &Self::Sides,
    ) -> Self::Varied {
        Self::Varied::ZERO
    }

    /// Returns the transposed matrix, if forces are needed.
    fn transposed() -> Option<&'static Transposed> {
        None
    }

    /// Returns the loads that the multipliers have to balance, by coordinate.
    fn needed(&self, _orders: [&Self::Q; 4], _t: f64, _sides: &Self::Sides) -> Self::Q {
        Self::Q::ZERO
    }

    /// Returns the right sides for the derivatives by the variable of the motion.
    fn rights(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Rights;

    /// Returns the measures, from the coordinates with their first three derivatives, their variations, and the
    /// multipliers.
    fn measured(&self, orders: [&Self::Q; 4], varied: &Self::Varied, multipliers: &Self::Q, t: f64) -> Self::Measures;
}

/// The transposed matrix, an equation for each coordinate.
pub struct Transposed {
    /// Blocks of its equations.
    pub blocks: &'static Blocks<'static>,
    /// Index of each of its entries among those of the matrix.
    pub places: &'static [usize],
}

/// Solves from a position nearby. All coordinates stay on a grid during Newton's iteration.
pub fn solve_with_pivoting<M: Pivoting>(m: &M, q: &M::Q, t: f64, sides: &M::Sides) -> Result<Solution<M>, Fault> {
    let mut at = Solution::near(q, t);
    let mut elimination = Elimination::<M>::new();
    if !settle(m, &mut at, sides, &mut elimination) {
        return Err(at.fault());
    }
    let slopes = m.phi_q(&at.q, t, sides);
    let (qd, pivot) = elimination.solve(&slopes, &m.nu(&at.q, t, sides));
    let (qdd, _) = elimination.solve(&slopes, &m.gamma(&at.q, &qd, t, sides));
    let orders = [&at.q, &qd, &qdd];
    let qddd = elimination.third_derivatives(m, &slopes, orders, t, sides);
    let rights = m.rights(&at.q, t, sides);
    for (slopes_by, right) in at.along.slopes_mut().iter_mut().zip(rights.as_ref()) {
        *slopes_by = without_signs_of_zero(elimination.solve(&slopes, right).0);
    }
    let varied = vary(m, &mut elimination, &slopes, orders, t, sides);
    let multipliers = elimination.multipliers(m, &slopes, [&at.q, &qd, &qdd, &qddd], t, sides);
    at.measures = m.measured([&at.q, &qd, &qdd, &qddd], &varied, &multipliers, t);
    (at.qd, at.qdd) = (without_signs_of_zero(qd), without_signs_of_zero(qdd));
    at.holds = is_next_to_nothing::<M>(&m.phi(&at.q, t, sides), &slopes, &at.q);
    at.q = without_signs_of_zero(at.q);
    at.steepest = 1.0 / pivot;
    let negative = elimination.is_negative.as_ref();
    for (turned, block) in at.is_negative.as_mut().iter_mut().zip(M::turning()) {
        *turned = negative.get(*block).copied().unwrap_or(false);
    }
    if at.holds { Ok(at) } else { Err(Fault::TooFar) }
}

/// Solves by Newton's iteration from far away, with equations scaled by the effect of their coordinates. Each correction is
/// so short that nothing moves by more than its scale, and that the residual decreases. Returns `None` if it does not
/// converge.
pub fn close<M: Pivoting>(m: &M, q: &M::Q, t: f64, work: &mut Work) -> Option<M::Q> {
    let (mut q, mut elimination) = (*q, Elimination::<M>::new());
    let mut sides = sides_near(&q, t, m, work);
    for _ in 0..MOST_TRIALS {
        let (slopes, residual) = (m.phi_q(&q, t, &sides), m.phi(&q, t, &sides));
        let norms = norms::<M>(&slopes);
        let mut right = residual;
        right.as_mut().iter_mut().for_each(|value| *value = -*value);
        let (x, _) = elimination.solve(&slopes, &right);
        work.add(1);
        let size = largest(&x, M::scales());
        if !size.is_finite() {
            return None;
        }
        let left = largest(&residual, &norms);
        let mut part = f64::min(1.0, 1.0 / size);
        let mut next = q;
        for _ in 0..MOST_SHORTER {
            next = q;
            next.as_mut().iter_mut().zip(x.as_ref()).for_each(|(q, x)| *q += part * x);
            if size <= NEAR {
                return Some(next);
            }
            work.add(1);
            sides = m.sides_of_motion(&next, t, &sides);
            if largest(&m.phi(&next, t, &sides), &norms) < (1.0 - 0.25 * part) * left {
                break;
            }
            part *= 0.5;
        }
        q = next;
    }
    None
}

/// Returns the largest change of each equation by a change of the coordinates by their scales.
fn norms<M: Pivoting>(slopes: &M::Entries) -> M::Q {
    let mut norms = M::Q::ZERO;
    norms.as_mut().fill(f64::MIN_POSITIVE);
    for (&(row, column), slope) in M::pattern().iter().zip(slopes.as_ref()) {
        if let (Some(norm), Some(scale)) = (norms.as_mut().get_mut(row), M::scales().as_ref().get(column)) {
            *norm = larger(*norm, slope.abs() * scale);
        }
    }
    norms
}

/// Runs Newton's iteration. Returns whether it has converged.
fn settle<M: Pivoting>(m: &M, at: &mut Solution<M>, sides: &M::Sides, elimination: &mut Elimination<M>) -> bool {
    let mut bound = bound_at_first(BORDER);
    for (q, cell) in at.q.as_mut().iter_mut().zip(M::cells().as_ref()) {
        *q = on_grid(*q, *cell);
    }
    for iteration in 0..ITERATIONS {
        let slopes = m.phi_q(&at.q, at.t, sides);
        let mut right = m.phi(&at.q, at.t, sides);
        right.as_mut().iter_mut().for_each(|value| *value = -*value);
        let (x, _) = elimination.solve(&slopes, &right);
        if iteration == 0 {
            at.first = largest(&x, M::scales());
        }
        let corrected = at.q.as_mut().iter_mut().zip(x.as_ref());
        let size = largest(&x, M::cells());
        if size <= bound {
            corrected.for_each(|(q, x)| *q += x);
            return true;
        }
        let (next, cells) = going_on(size, bound, BORDER);
        corrected.zip(M::cells().as_ref()).for_each(|((q, x), cell)| *q = next_point(*q, *x, *cell, cells, BORDER));
        bound = next;
    }
    false
}

/// Returns the derivatives of the coordinates, their velocities and accelerations by inputs and parameters: those by one
/// before those by two, each order from those before.
fn vary<M: Pivoting>(
    m: &M,
    elimination: &mut Elimination<M>,
    slopes: &M::Entries,
    orders: [&M::Q; 3],
    t: f64,
    sides: &M::Sides,
) -> M::Varied {
    let mut varied = M::Varied::ZERO;
    let n = M::scales().as_ref().len();
    for by_two in [false, true] {
        for order in 0..3 {
            let rights = m.varied_right(orders, &varied, t, sides);
            for (number, _) in M::IS_BY_TWO.iter().enumerate().filter(|(_, of)| **of == by_two) {
                let first = (3 * number + order) * n;
                let mut right = M::Q::ZERO;
                let given = rights.as_ref().iter().skip(first);
                right.as_mut().iter_mut().zip(given).for_each(|(to, from)| *to = *from);
                let (x, _) = elimination.solve(slopes, &right);
                let places = varied.as_mut().iter_mut().skip(first);
                places.zip(x.as_ref()).for_each(|(place, x)| *place = *x);
            }
        }
    }
    varied
}

/// Workspace for solving linear equations in blocks.
pub struct Elimination<M: Pivoting> {
    work: M::Work,
    is_negative: M::Blocks,
}

impl<M: Pivoting> Elimination<M> {
    /// Creates an empty workspace.
    pub fn new() -> Self {
        Self { work: M::Work::ZERO, is_negative: M::Blocks::NONE }
    }

    /// Returns the solution for a right side, and the smallest pivot.
    pub fn solve(&mut self, slopes: &M::Entries, right: &M::Q) -> (M::Q, f64) {
        let mut x = M::Q::ZERO;
        let (work, is_negative) = (self.work.as_mut(), self.is_negative.as_mut());
        let pivot = blocks::solve(M::blocks(), slopes.as_ref(), right.as_ref(), x.as_mut(), work, is_negative);
        (x, pivot)
    }

    /// Returns the third derivatives of the coordinates; 0 if measures do not need them.
    pub fn third_derivatives(
        &mut self,
        m: &M,
        slopes: &M::Entries,
        orders: [&M::Q; 3],
        t: f64,
        sides: &M::Sides,
    ) -> M::Q {
        if M::HAS_JERK { self.solve(slopes, &m.jerk(orders, t, sides)).0 } else { M::Q::ZERO }
    }

    /// Returns the multipliers of a state; 0 if forces are not needed.
    pub fn multipliers(&mut self, m: &M, slopes: &M::Entries, orders: [&M::Q; 4], t: f64, sides: &M::Sides) -> M::Q {
        let mut multipliers = M::Q::ZERO;
        let Some(Transposed { blocks, places }) = M::transposed() else { return multipliers };
        let mut across = *slopes;
        for (entry, place) in across.as_mut().iter_mut().zip(*places) {
            *entry = slopes.as_ref().get(*place).copied().unwrap_or(f64::NAN);
        }
        let (work, is_negative) = (self.work.as_mut(), self.is_negative.as_mut());
        let needed = m.needed(orders, t, sides);
        blocks::solve(blocks, across.as_ref(), needed.as_ref(), multipliers.as_mut(), work, is_negative);
        multipliers
    }
}

/// Returns whether the residuals are within the tolerance and the rounding error of the coordinates.
fn is_next_to_nothing<M: Pivoting>(values: &M::Q, slopes: &M::Entries, q: &M::Q) -> bool {
    let mut bounds = M::Q::ZERO;
    for (&(row, column), slope) in M::pattern().iter().zip(slopes.as_ref()) {
        let bound = bounds.as_mut().get_mut(row);
        let sizes = (M::scales().as_ref().get(column), q.as_ref().get(column), bound);
        if let (Some(scale), Some(q), Some(bound)) = sizes {
            *bound += M::TOLERANCE * (slope * scale).abs() + 8.0 * f64::EPSILON * (slope * q).abs();
        }
    }
    let mut pairs = values.as_ref().iter().zip(bounds.as_ref());
    pairs.all(|(value, bound)| value.abs() <= *bound)
}

/// Replaces -0 by 0.
pub fn without_signs_of_zero<N: Numbers>(mut values: N) -> N {
    values.as_mut().iter_mut().for_each(|value| *value += 0.0);
    values
}
}

pub mod lane_solutions {
//! Solutions of the equations in every lane.

// loops by lane number read best and vectorise best
#![allow(clippy::needless_range_loop)]

use super::measured::Measured;
use super::solution::Solution;
use super::state::Timed;
use core::fmt::Debug;

/// A list of numbers for every lane.
pub trait Lists<T, const L: usize>: Copy + Debug + AsRef<[[T; L]]> + AsMut<[[T; L]]> {
    /// All numbers 0.
    const ZERO: Self;
}

impl<const K: usize, const L: usize> Lists<f64, L> for [[f64; L]; K] {
    const ZERO: Self = [[0.0; L]; K];
}

impl<const K: usize, const L: usize> Lists<u64, L> for [[u64; L]; K] {
    const ZERO: Self = [[0; L]; K];
}

/// A mechanism that is solved in several lanes at once.
pub trait Laned<const L: usize>: Timed {
    /// A number for each coordinate.
    type Coordinates: Lists<f64, L>;
    /// A number for each coordinate that Newton solves for.
    type Guesses: Lists<f64, L>;
    /// A number for each measure.
    type Values: Lists<f64, L>;
    /// The time derivative of each measure.
    type Rates: Lists<f64, L>;
    /// The second time derivative of each measure.
    type Accelerations: Lists<f64, L>;
    /// A number for each value that only measures need.
    type OfJoined: Lists<f64, L>;
    /// A number for each block that has the sign of its determinant.
    type Signs: Lists<u64, L>;

    /// True if conditions beside the equations exist.
    const HAS_CHECKS: bool;

    /// Selects the coordinates that Newton solves for.
    fn tears_of(q: &Self::Coordinates) -> Self::Guesses;

    /// Solves for position, velocity and acceleration in every lane.
    fn solve_each(
        guess: &Self::Guesses,
        t: &[f64; L],
        models: &[Self; L],
        sides: &[Self::Sides; L],
        at: &mut Solutions<Self, L>,
    );
}

/// Solutions of the equations in every lane.
#[derive(Clone, Debug)]
pub struct Solutions<M: Laned<L>, const L: usize> {
    /// Times (s).
    pub t: [f64; L],
    /// Coordinates.
    pub q: M::Coordinates,
    /// Velocities.
    pub qd: M::Coordinates,
    /// Accelerations.
    pub qdd: M::Coordinates,
    /// Measures.
    pub values: M::Values,
    /// Rates of the measures.
    pub rates: M::Rates,
    /// Accelerations of the measures.
    pub accelerations: M::Accelerations,
    /// Values that only measures need.
    #[allow(dead_code)] // mostly they need nothing
    pub joined: M::OfJoined,
    /// A number for each block that has the sign of its determinant.
    pub signs: M::Signs,
    /// Largest ratio of multipliers, residuals, angles and corrections to their bounds: at most 1 in a valid lane.
    pub strain: [f64; L],
    /// Largest first correction of Newton's iteration, scaled.
    pub first: [f64; L],
    /// Reciprocal of the smallest pivot, scaled.
    pub steepest: [f64; L],
}

impl<M: Laned<L>, const L: usize> Solutions<M, L> {
    /// Solutions before the first solve.
    pub const ZERO: Self = Self {
        t: [0.0; L],
        q: M::Coordinates::ZERO,
        qd: M::Coordinates::ZERO,
        qdd: M::Coordinates::ZERO,
        values: M::Values::ZERO,
        rates: M::Rates::ZERO,
        accelerations: M::Accelerations::ZERO,
        joined: M::OfJoined::ZERO,
        signs: M::Signs::ZERO,
        strain: [0.0; L],
        first: [0.0; L],
        steepest: [0.0; L],
    };

    /// Resets the records before a solve.
    pub fn begin(&mut self, t: &[f64; L]) {
        self.t = *t;
        let zero = [0.0; L];
        (self.strain, self.first, self.steepest) = (zero, zero, zero);
        for (signs, is_negative) in self.signs.as_mut().iter_mut().zip(M::turned().as_ref()) {
            *signs = [u64::from(*is_negative) << 63; L];
        }
    }

    /// Returns the coordinates that Newton solves for, with their velocities and accelerations.
    pub fn tears(&self) -> [M::Guesses; 3] {
        [M::tears_of(&self.q), M::tears_of(&self.qd), M::tears_of(&self.qdd)]
    }

    /// Returns for each lane whether all its numbers are finite.
    pub fn are_finite(&self) -> [bool; L] {
        let mut sum = [0.0; L];
        for list in [&self.q, &self.qd, &self.qdd] {
            for each in list.as_ref() {
                for k in 0..L {
                    sum[k] += 0.0 * each[k];
                }
            }
        }
        sum.map(|sum| sum == 0.0)
    }

    /// Returns the solution of one lane.
    pub fn lane(&self, lane: usize) -> Solution<M> {
        let mut at = Solution::<M>::ZERO;
        at.t = of(&self.t, lane);
        get(self.q.as_ref(), lane, at.q.as_mut());
        get(self.qd.as_ref(), lane, at.qd.as_mut());
        get(self.qdd.as_ref(), lane, at.qdd.as_mut());
        let [values, rates, accelerations] = at.measures.lists_mut();
        get(self.values.as_ref(), lane, values);
        get(self.rates.as_ref(), lane, rates);
        get(self.accelerations.as_ref(), lane, accelerations);
        at.measures.leave_out();
        for (is_negative, signs) in at.is_negative.as_mut().iter_mut().zip(self.signs.as_ref()) {
            *is_negative = signs.get(lane).is_some_and(|sign| sign >> 63 == 1);
        }
        at.steepest = of(&self.steepest, lane);
        at
    }

    /// Sets the solution of one lane.
    pub fn set_lane(&mut self, lane: usize, at: &Solution<M>) {
        set([at.t].as_slice(), lane, core::slice::from_mut(&mut self.t));
        set([at.steepest].as_slice(), lane, core::slice::from_mut(&mut self.steepest));
        set(at.q.as_ref(), lane, self.q.as_mut());
        set(at.qd.as_ref(), lane, self.qd.as_mut());
        set(at.qdd.as_ref(), lane, self.qdd.as_mut());
        let [values, rates, accelerations] = at.measures.lists();
        set(values, lane, self.values.as_mut());
        set(rates, lane, self.rates.as_mut());
        set(accelerations, lane, self.accelerations.as_mut());
        for (signs, is_negative) in self.signs.as_mut().iter_mut().zip(at.is_negative.as_ref()) {
            if let Some(sign) = signs.get_mut(lane) {
                *sign = u64::from(*is_negative) << 63;
            }
        }
    }
}

/// Returns the number of a lane.
fn of<const L: usize>(each: &[f64; L], lane: usize) -> f64 {
    each.get(lane).copied().unwrap_or(f64::NAN)
}

/// Reads the numbers of a lane.
fn get<const L: usize>(each: &[[f64; L]], lane: usize, to: &mut [f64]) {
    to.iter_mut().zip(each).for_each(|(to, each)| *to = of(each, lane));
}

/// Writes the numbers of a lane.
fn set<const L: usize>(values: &[f64], lane: usize, to: &mut [[f64; L]]) {
    for (each, value) in to.iter_mut().zip(values) {
        if let Some(place) = each.get_mut(lane) {
            *place = *value;
        }
    }
}
}

pub mod lane_residuals {
//! Record of bounded quantities in a lane.

use super::lane_solutions::{Laned, Solutions};
use super::running_max::running_max;

impl<M: Laned<L>, const L: usize> Solutions<M, L> {
    /// Records a value that times `factor` must not exceed 1.
    #[inline]
    pub fn watch(&mut self, lane: usize, value: f64, factor: f64) {
        if let Some(strain) = self.strain.get_mut(lane) {
            *strain = running_max(*strain, value.abs() * factor);
        }
    }
}
}

pub mod lane_pivots {
//! Record of pivots in a lane.

use super::lane_solutions::{Laned, Solutions};
use super::running_max::running_max;

impl<M: Laned<L>, const L: usize> Solutions<M, L> {
    /// Records the reciprocal of a pivot; `weight` makes it dimensionless.
    #[inline]
    pub fn pivot(&mut self, lane: usize, turn: usize, inverse: f64, weight: f64) {
        let signs = self.signs.as_mut().get_mut(turn).and_then(|signs| signs.get_mut(lane));
        if let (Some(sign), Some(steepest)) = (signs, self.steepest.get_mut(lane)) {
            *sign ^= inverse.to_bits();
            *steepest = running_max(*steepest, inverse.abs() * weight);
        }
    }
}
}

pub mod lane_newton {
//! Newton's iteration in lanes.

// loops by lane number read best and vectorise best
#![allow(clippy::needless_range_loop)]

use super::grid::{bound_at_first, going_on, next_point};
use super::lane_solutions::{Laned, Solutions};
use super::limits::{BORDER, LARGEST_CORRECTION};
use super::running_max::running_max;

/// A Newton iteration in every lane, until each has settled or is lost. A lane that has settled stays where it is.
pub struct LaneNewton<const L: usize> {
    is_first: bool,
    first: [f64; L],
    /// Largest correction, scaled.
    far: [f64; L],
    /// Largest correction of this iteration, and the bound below which it ends, both in cells of the grid.
    largest: [f64; L],
    bound: [f64; L],
    /// Spacing, in cells, of the points to which coordinates next to a border continue; 0 in lanes that stay.
    cells: [f64; L],
}

impl<const L: usize> LaneNewton<L> {
    /// Creates an iteration before its first step.
    pub fn new() -> Self {
        let zero = [0.0; L];
        let bound = [bound_at_first(BORDER); L];
        Self { is_first: true, first: zero, far: zero, largest: zero, bound, cells: zero }
    }

    /// Records the correction of a coordinate, whose grid has cells of width `cell`, and whose scale is `scale`.
    #[inline]
    pub fn record(&mut self, lane: usize, delta: f64, cell: f64, scale: f64) {
        let size = delta.abs();
        if let (Some(far), Some(largest)) = (self.far.get_mut(lane), self.largest.get_mut(lane)) {
            *far = running_max(*far, size / scale);
            *largest = running_max(*largest, size / cell);
        }
    }

    /// Returns whether the iteration is done in every lane: it has settled or is lost.
    pub fn is_done(&mut self) -> bool {
        if self.is_first {
            self.first = self.far;
            self.is_first = false;
        }
        let mut open = 0.0;
        for k in 0..L {
            let is_lost = self.far[k].is_nan() || self.far[k] > LARGEST_CORRECTION;
            let stays = is_lost || self.largest[k] <= self.bound[k];
            let (bound, cells) = going_on(self.largest[k], self.bound[k], BORDER);
            // the lane stays from now on
            self.bound[k] = if stays { f64::INFINITY } else { bound };
            self.cells[k] = if stays { 0.0 } else { cells };
            open += self.cells[k];
            self.largest[k] = 0.0;
        }
        open == 0.0
    }

    /// Returns the grid point to which a coordinate continues.
    #[inline]
    pub fn next(&self, lane: usize, x: f64, delta: f64, cell: f64) -> f64 {
        let cells = self.cells.get(lane).copied().unwrap_or(0.0);
        let next = next_point(x, delta, cell, cells, BORDER);
        if cells > 0.0 { next } else { x }
    }

    /// Records the outcome. Values that are NaN appear in the coordinates, too.
    pub fn note<M: Laned<L>>(&self, at: &mut Solutions<M, L>) {
        for k in 0..L {
            at.first[k] = running_max(at.first[k], self.first[k]);
            let lost = self.far[k] * (1.0 / LARGEST_CORRECTION);
            let strain = if self.cells[k] > 0.0 { f64::INFINITY } else { lost };
            at.strain[k] = running_max(at.strain[k], strain);
        }
    }
}
}

pub mod lanes {
//! Several variants of the mechanism, or several times, at once: in loops over the lanes that a compiler turns into vector
//! instructions. Each lane has the bits that it would have alone.

// loops by lane number read best and vectorise best
#![allow(clippy::needless_range_loop)]

use super::assemble::assemble;
use super::branches::{sides_ahead, sides_at, with_time};
use super::error::Error;
use super::hermite::bend_ahead;
use super::lane_solutions::{Laned, Lists, Solutions};
use super::limits::{
    CALM_BETWEEN, CALM_CORRECTION, FARTHEST_BEND, LARGEST_CORRECTION, LARGEST_GAP, LARGEST_MOTION, MOST_STEPS, STEEP,
};
use super::numbers::Numbers;
use super::running_max::running_max;
use super::state::{Assembly, Continuation, State};
use super::step::step;
use super::track::Track;
use super::work::Work;

/// A mechanism in every lane, with parameters and a time of its own.
#[derive(Clone, Debug)]
pub struct States<M: Laned<L>, const L: usize> {
    pub(super) models: [M; L],
    /// The present solutions, and the previous ones or the next ones in progress.
    pub(super) solutions: [Solutions<M, L>; 2],
    /// True if the present solutions are the second.
    pub(super) is_second: bool,
    pub(super) is_smooth: [bool; L],
    pub(super) steepness: [f64; L],
    pub(super) step: [f64; L],
    pub(super) assembly: [Assembly; L],
    pub(super) sides: [M::Sides; L],
    pub(super) monitors: [M::Monitors; L],
    /// Continuation of each lane along inputs.
    pub(super) continuation: [M::Continuation; L],
}

impl<M: Laned<L>, const L: usize> States<M, L> {
    /// Returns the present solutions.
    fn now(&self) -> &Solutions<M, L> {
        let [first, second] = &self.solutions;
        if self.is_second { second } else { first }
    }

    /// Returns the previous solutions, or the next ones in progress.
    fn other(&self) -> &Solutions<M, L> {
        let [first, second] = &self.solutions;
        if self.is_second { first } else { second }
    }

    /// Returns the present solutions and the others for modification.
    pub(super) fn both(&mut self) -> (&mut Solutions<M, L>, &mut Solutions<M, L>) {
        let [first, second] = &mut self.solutions;
        if self.is_second { (second, first) } else { (first, second) }
    }

    /// Returns the times (s).
    #[must_use]
    pub fn t(&self) -> &[f64; L] {
        &self.now().t
    }

    /// Returns the coordinates (m, rad), by their indices.
    #[must_use]
    pub fn q(&self) -> &M::Coordinates {
        &self.now().q
    }

    /// Returns the velocities of the coordinates (m/s, rad/s).
    #[must_use]
    pub fn qd(&self) -> &M::Coordinates {
        &self.now().qd
    }

    /// Returns the accelerations of the coordinates (m/s^2, rad/s^2).
    #[must_use]
    pub fn qdd(&self) -> &M::Coordinates {
        &self.now().qdd
    }

    /// Returns the state of one lane; `None` if the lane does not exist.
    #[must_use]
    pub fn get(&self, lane: usize) -> Option<State<M>> {
        let (model, lead) = (*self.models.get(lane)?, *self.continuation.get(lane)?);
        let mut solutions = [self.now().lane(lane), self.other().lane(lane)];
        for at in &mut solutions {
            at.sides = *self.sides.get(lane)?;
            at.monitors = *self.monitors.get(lane)?;
        }
        let mut passed = M::Passed::ZERO;
        passed.as_mut().fill(f64::NEG_INFINITY);
        Some(State {
            model,
            track: Track {
                solutions,
                is_second: false,
                is_smooth: *self.is_smooth.get(lane)?,
                stride: *self.step.get(lane)?,
            },
            steepness: *self.steepness.get(lane)?,
            assembly: *self.assembly.get(lane)?,
            continuation: lead,
            passed,
        })
    }

    /// Sets the state of one lane.
    fn set(&mut self, lane: usize, state: &State<M>) {
        put(&mut self.step, lane, &state.track.stride);
        put(&mut self.sides, lane, &state.at().sides);
        put(&mut self.monitors, lane, &state.at().monitors);
        put(&mut self.continuation, lane, &state.continuation);
        put(&mut self.is_smooth, lane, &false);
    }

    /// Moves one lane alone, and leaves its solution among the other ones.
    fn alone(&mut self, lane: usize, t: f64) -> Result<(), Error> {
        let Some(mut state) = self.get(lane) else {
            return Ok(());
        };
        // the rejected trial has replaced the previous solution
        state.track.is_smooth = false;
        let result = step(t, &mut state, MOST_STEPS, &mut Work::default());
        self.both().1.set_lane(lane, state.at());
        self.set(lane, &state);
        result
    }

    /// Tries one step of every lane. Returns for each lane whether it has arrived.
    fn advance(&mut self, t: &[f64; L]) -> [bool; L] {
        let is_smooth = self.is_smooth;
        let [first, second] = &mut self.solutions;
        let (from, at) = if self.is_second { (second, first) } else { (first, second) };
        let from = &*from;
        let mut h = [0.0; L];
        for k in 0..L {
            h[k] = t[k] - from.t[k];
        }
        let (guess, motion) = guess(from, at, &h, &is_smooth);
        M::solve_each(&guess, t, &self.models, &self.sides, at);
        let gap = gap(from, at, &h);
        let is_finite = at.are_finite();
        let mut is_done = [false; L];
        for k in 0..L {
            let is_short = h[k].abs() <= self.step[k] && h[k] != 0.0;
            let is_solved = at.strain[k] <= 1.0 && at.steepest[k] <= STEEP * self.steepness[k];
            is_done[k] = is_solved && is_finite[k] && is_short;
        }
        for k in 0..L {
            let is_near = motion[k] <= LARGEST_MOTION && at.first[k] <= LARGEST_CORRECTION;
            is_done[k] &= is_near && gap[k] <= LARGEST_GAP;
        }
        for (now, before) in at.signs.as_ref().iter().zip(from.signs.as_ref()) {
            for k in 0..L {
                is_done[k] &= (now[k] ^ before[k]) >> 63 == 0;
            }
        }
        for k in 0..L {
            is_done[k] = is_done[k] && self.keeps_branch(k);
            if is_done[k] {
                let first = self.other().first[k];
                let is_calm = first < LARGEST_CORRECTION / CALM_CORRECTION && gap[k] < LARGEST_GAP / CALM_BETWEEN;
                let size = h[k].abs();
                let longest = if is_calm { 2.0 * size } else { 0.0 };
                let shortest = if is_calm { self.step[k] } else { size };
                self.step[k] = f64::max(longest, shortest).min(M::LONGEST_STEP);
                self.is_smooth[k] = true;
            }
        }
        is_done
    }

    /// Returns whether the next solution of a lane keeps the branches of formulas. A lane that inputs have moved has to
    /// return to time alone.
    fn keeps_branch(&self, lane: usize) -> bool {
        if self.continuation.get(lane).is_none_or(Continuation::is_active) {
            return false;
        }
        if !M::HAS_CHECKS {
            return true;
        }
        let (Some(model), Some(sides), Some(monitors)) =
            (self.models.get(lane), self.sides.get(lane), self.monitors.get(lane))
        else {
            return false;
        };
        let (from, mut at) = (self.now().t.get(lane).copied().unwrap_or(f64::NAN), self.other().lane(lane));
        let work = &mut Work::default();
        let (t, of_time) = (at.t, sides_at(at.t, model, work));
        let mut passed = M::Passed::ZERO;
        passed.as_mut().fill(f64::NEG_INFINITY);
        if model.first_boundary(from, t, &passed, work).is_some() {
            return false;
        }
        at.sides = of_time;
        if M::OF_MOTION {
            at.sides = with_time::<M>(sides, &of_time);
            at.sides = sides_ahead(&at, model);
        }
        at.sides == *sides
            && model.conditions_hold(&at.q, t, sides)
            && model.redundant_rows_hold(&at.q, t, sides)
            && model.monitors(&at.q, t, sides) == *monitors
    }
}

/// Assembles a mechanism for each set of parameters. Returns for each lane the reason if it cannot be assembled; such a
/// lane has the parameters of the file.
#[allow(clippy::type_complexity)] // the states, and an answer for each
pub fn assemble_each<M: Laned<L>, const L: usize>(
    params: &[M::Params; L],
) -> Result<(States<M, L>, [Result<(), Error>; L]), Error> {
    let work = &mut Work::default();
    let one = assemble::<M>(&M::Params::default(), work)?;
    let mut states = States {
        models: [one.model; L],
        solutions: [Solutions::ZERO, Solutions::ZERO],
        is_second: false,
        is_smooth: [false; L],
        steepness: [one.steepness; L],
        step: [M::LONGEST_STEP; L],
        assembly: [one.assembly; L],
        sides: [one.at().sides; L],
        monitors: [one.at().monitors; L],
        continuation: [one.continuation; L],
    };
    let mut results = [Ok(()); L];
    for (k, (params, result)) in params.iter().zip(&mut results).enumerate() {
        let found = assemble(params, work);
        *result = found.as_ref().map(|_| ()).map_err(|error| *error);
        let state = found.unwrap_or_else(|_| one.clone());
        states.both().0.set_lane(k, state.at());
        states.set(k, &state);
        put(&mut states.models, k, &state.model);
        put(&mut states.steepness, k, &state.steepness);
        put(&mut states.assembly, k, &state.assembly);
    }
    Ok((states, results))
}

/// Moves every lane to its time (s); a lane that needs more than one step moves alone. Returns for each lane the reason if
/// it has not arrived; it stays at the last time that it could reach.
pub fn step_each<M: Laned<L>, const L: usize>(t: &[f64; L], states: &mut States<M, L>) -> [Result<(), Error>; L] {
    let is_done = states.advance(t);
    let mut results = [Ok(()); L];
    for k in 0..L {
        if !is_done[k] {
            results[k] = states.alone(k, t[k]);
        }
    }
    states.is_second = !states.is_second;
    results
}

/// Returns the start of Newton's iteration in every lane, and its distance from the present position, scaled.
fn guess<M: Laned<L>, const L: usize>(
    from: &Solutions<M, L>,
    before: &Solutions<M, L>,
    h: &[f64; L],
    is_smooth: &[bool; L],
) -> (M::Guesses, [f64; L]) {
    let (mut back, mut u) = ([0.0; L], [0.0; L]);
    for k in 0..L {
        back[k] = from.t[k] - before.t[k];
        let ratio = h[k] / back[k];
        let is_known = is_smooth[k] && ratio.abs() <= FARTHEST_BEND;
        u[k] = if is_known { ratio } else { 0.0 };
    }
    let [x, v, a] = from.tears();
    let [y, w, b] = before.tears();
    let (mut guess, mut motion) = (M::Guesses::ZERO, [0.0; L]);
    let now = x.as_ref().iter().zip(v.as_ref()).zip(a.as_ref());
    let then = y.as_ref().iter().zip(w.as_ref()).zip(b.as_ref());
    let places = guess.as_mut().iter_mut().zip(M::tear_scales().as_ref());
    for ((guess, scale), (((x, v), a), ((y, w), b))) in places.zip(now.zip(then)) {
        for k in 0..L {
            let (h, x, v, a) = (h[k], x[k], v[k], a[k]);
            let bend = bend_ahead([x, v, a], [y[k], w[k], b[k]], back[k], u[k]);
            let step = h * (v + 0.5 * h * a) + bend;
            guess[k] = x + step;
            motion[k] = running_max(motion[k], step.abs() / scale);
        }
    }
    (guess, motion)
}

/// Returns the distance of positions from those that velocities and accelerations at both ends predict (Hermite), scaled.
fn gap<M: Laned<L>, const L: usize>(from: &Solutions<M, L>, at: &Solutions<M, L>, h: &[f64; L]) -> [f64; L] {
    let [x, v, a] = from.tears();
    let [y, w, b] = at.tears();
    let mut gap = [0.0; L];
    let then = x.as_ref().iter().zip(v.as_ref()).zip(a.as_ref());
    let now = y.as_ref().iter().zip(w.as_ref()).zip(b.as_ref());
    for ((((x, v), a), ((y, w), b)), scale) in then.zip(now).zip(M::tear_scales().as_ref()) {
        for k in 0..L {
            let rates = 0.5 * h[k] * (v[k] + w[k]);
            let bends = h[k] * h[k] * (1.0 / 12.0) * (a[k] - b[k]);
            let gap_here = y[k] - x[k] - rates - bends;
            gap[k] = running_max(gap[k], gap_here.abs() / scale);
        }
    }
    gap
}

/// Sets the value of a lane.
pub fn put<T: Clone>(each: &mut [T], lane: usize, value: &T) {
    if let Some(place) = each.get_mut(lane) {
        place.clone_from(value);
    }
}
}

pub mod sine_and_cosine {
// Sine and cosine of one angle (rad), together: the same bits on every platform, within 1 ulp, for arguments of any size.
//
// The angle is reduced to |r + tail| <= pi/4 with `angle = n pi/2 + r + tail`: up to a million by subtracting n times
// pi/2 in pieces of 33 bits, whose products are exact (W. Cody and W. Waite, Software Manual for the Elementary
// Functions, 1980); above by as many bits of 2/pi as the angle asks for (M. Payne and R. Hanek, Radian Reduction for
// Trigonometric Functions, 1983). The coefficients of the two polynomials are those of Sun's fdlibm.

/// Below it an angle (rad) is small: it is reduced in pieces whose products are exact.
pub const A_MILLION: f64 = 1e6;

/// Sine and cosine of an angle in radians; not a number for an angle that is not finite.
#[must_use]
#[inline]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    if !angle.is_finite() {
        return (f64::NAN, f64::NAN);
    }
    let (quarter, r, tail) = if angle.abs() < A_MILLION { reduce_small(angle) } else { reduce_large(angle) };
    let (sin, cos) = (sin_near_zero(r, tail), cos_near_zero(r, tail));
    match quarter & 3 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// `sin(r + tail)` for `|r| <= pi/4`, the tail below an ulp of r.
#[inline]
pub(super) fn sin_near_zero(r: f64, tail: f64) -> f64 {
    let z = r * r;
    let (cube, square) = (z * r, z * z);
    // in halves that do not wait for each other (G. Estrin, 1960)
    let lower = 8.333_333_333_322_49e-3 - z * 1.984_126_982_985_795e-4;
    let upper = (2.755_731_370_707_006_8e-6 - z * 2.505_076_025_340_686_3e-8) + square * 1.589_690_995_211_55e-10;
    let higher = lower + square * upper;
    r - ((z * (0.5 * tail - cube * higher) - tail) + cube * 1.666_666_666_666_663_2e-1)
}

/// `cos(r + tail)` for `|r| <= pi/4`, the tail below an ulp of r.
#[inline]
pub(super) fn cos_near_zero(r: f64, tail: f64) -> f64 {
    let z = r * r;
    let square = z * z;
    let lower = 4.166_666_666_666_66e-2 - z * 1.388_888_888_887_411e-3;
    let middle = 2.480_158_728_947_673e-5 - z * 2.755_731_435_139_066_3e-7;
    let upper = 2.087_572_321_298_175e-9 - z * 1.135_964_755_778_819_5e-11;
    let higher = z * (lower + square * (middle + square * upper));
    let half = 0.5 * z;
    let most = 1.0 - half;
    most + (((1.0 - most) - half) + (z * higher - r * tail))
}

/// `a + b` as its rounded value and what the rounding lost.
#[inline]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

/// The nearest whole number of quarter turns, by its last bits, and what is left of an angle below a million.
#[inline]
pub(super) fn reduce_small(angle: f64) -> (u64, f64, f64) {
    // pi/2 in three pieces of 33 bits and a rest
    const PIECES: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_711_166_5e-21];
    const REST: f64 = 8.478_427_660_368_9e-32;
    // adding and taking away 1.5 * 2^52 rounds to a whole number, which the last bits of the sum are
    const ROUNDING: f64 = 6_755_399_441_055_744.0;
    let sum = angle * core::f64::consts::FRAC_2_PI + ROUNDING;
    let quarters = sum - ROUNDING;
    let first = angle - quarters * PIECES[0];
    let (second, lost_second) = two_sum(first, -(quarters * PIECES[1]));
    let (third, lost_third) = two_sum(second, -(quarters * PIECES[2]));
    let lost = (lost_second + lost_third) - quarters * REST;
    let r = third + lost;
    (sum.to_bits(), r, (third - r) + lost)
}

/// The bits of 2/pi after the binary point.
const TWO_OVER_PI: [u64; 20] = [
    0xa2f9_836e_4e44_1529,
    0xfc27_57d1_f534_ddc0,
    0xdb62_9599_3c43_9041,
    0xfe51_63ab_debb_c561,
    0xb724_6e3a_424d_d2e0,
    0x0649_2eea_09d1_921c,
    0xfe1d_eb1c_b129_a73e,
    0xe882_35f5_2ebb_4484,
    0xe99c_7026_b45f_7e41,
    0x3991_d639_8353_39f4,
    0x9c84_5f8b_bdf9_283b,
    0x1ff8_97ff_de05_980f,
    0xef2f_118b_5a0a_6d1f,
    0x6d36_7ecf_27cb_09b7,
    0x4f46_3f66_9e5f_ea2d,
    0x7527_bac7_ebe5_f17b,
    0x3d07_39f7_8a52_92ea,
    0x6bfb_5fb1_1f8d_5d08,
    0x5603_3046_fc7b_6bab,
    0xf0cf_bc20_9af4_361d,
];

/// 64 bits of 2/pi from a bit on, the first bit after the point being bit 1.
fn bits_from(bit: i64) -> u64 {
    let word = |k: i64| usize::try_from(k).ok().and_then(|k| TWO_OVER_PI.get(k)).copied().unwrap_or(0);
    let (at, shift) = ((bit - 1).div_euclid(64), (bit - 1).rem_euclid(64));
    if shift == 0 { word(at) } else { (word(at) << shift) | (word(at + 1) >> (64 - shift)) }
}

/// The whole number of quarter turns modulo 4, and what is left of an angle of a million or more.
#[allow(clippy::cast_possible_truncation, clippy::cast_possible_wrap, clippy::cast_sign_loss)] // bits are cut on purpose
#[allow(clippy::cast_precision_loss)] // what is lost is taken up by the next part
fn reduce_large(angle: f64) -> (u64, f64, f64) {
    let bits = angle.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i64 - 1075;
    let mantissa = u128::from((bits & ((1 << 52) - 1)) | (1 << 52));
    // bits of 2/pi before these make whole turns; of the product only what is below four quarters counts
    let start = exponent - 1;
    let [high, middle, low] = [bits_from(start), bits_from(start + 64), bits_from(start + 128)];
    let low = mantissa * u128::from(low);
    let middle = mantissa * u128::from(middle) + (low >> 64);
    let high = (mantissa * u128::from(high) + (middle >> 64)) as u64;
    // two bits of quarters, then the fraction of a quarter
    let mut quarter = (high >> 62) as i64;
    let fraction = (u128::from(high) << 66) | (u128::from(middle as u64) << 2) | u128::from((low as u64) >> 62);
    // to the nearest quarter: a fraction above a half counts back from the next one
    let back = fraction >> 127 == 1;
    let size = if back { fraction.wrapping_neg() } else { fraction };
    quarter += i64::from(back);
    // 53 bits from the first that is set, and the 53 after those
    let leading = size.leading_zeros();
    let digits = size.checked_shl(leading).unwrap_or(0);
    let power_of_two = |power: i64| f64::from_bits(((1023 + power) as u64) << 52);
    let upper = (digits >> 75) as f64 * power_of_two(-53 - i64::from(leading));
    let lower = ((digits >> 22) as u64 & ((1 << 53) - 1)) as f64 * power_of_two(-106 - i64::from(leading));
    let (r, tail) = times_half_pi(upper, lower);
    let sign = if back == (angle < 0.0) { 1.0 } else { -1.0 };
    ((if angle < 0.0 { -quarter } else { quarter }) as u64, sign * r, sign * tail)
}

/// `(a + b) pi/2` as a value and its tail.
fn times_half_pi(a: f64, b: f64) -> (f64, f64) {
    // 2^27 + 1 splits a number into two halves whose products are exact (T. Dekker, 1971)
    let split = |x: f64| {
        let shifted = x * 134_217_729.0;
        let high = shifted - (shifted - x);
        (high, x - high)
    };
    let (half_pi, rest) = (core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17);
    let product = a * half_pi;
    let ((a_high, a_low), (p_high, p_low)) = (split(a), split(half_pi));
    let lost = ((a_high * p_high - product) + a_high * p_low + a_low * p_high) + a_low * p_low;
    let tail = lost + (a * rest + b * half_pi);
    let r = product + tail;
    (r, (product - r) + tail)
}
}

pub mod without_branches {
// Sine and cosine without a branch, so that a loop over many angles does several at once.

use super::sine_and_cosine::{cos_near_zero, reduce_small, sin_near_zero};

/// Sine and cosine of an angle (rad) whose size is below a million: the bits of `sin_cos`.
#[must_use]
#[inline]
pub fn sin_cos_below_a_million(angle: f64) -> (f64, f64) {
    let (quarter, r, tail) = reduce_small(angle);
    let (sin, cos) = (sin_near_zero(r, tail).to_bits(), cos_near_zero(r, tail).to_bits());
    // an odd quarter exchanges them, the second and third turn the sine's sign, the first and second the cosine's
    let odd = (quarter & 1).wrapping_neg();
    let (first, second) = ((sin & !odd) | (cos & odd), (cos & !odd) | (sin & odd));
    let turned = |quarter: u64| (quarter & 2) << 62;
    (f64::from_bits(first ^ turned(quarter)), f64::from_bits(second ^ turned(quarter.wrapping_add(1))))
}
}

/// Where to stop, and what counts as large.
pub mod limits {
/// Rounding may make so much of velocities and accelerations that are given out.
pub const ACCURACY: f64 = 1e-9;
/// How far the motion is looked ahead to tell on which side of an edge it goes on, as a part of the span.
pub const AHEAD: f64 = 1e-9;
/// A correction that is no farther from half a cell of the grid than this, in cells, leads to the border of two.
pub const BORDER: f64 = 0.000244140625;
/// A step is calm, so that a longer one would do as well, if its gap is so many times less than the largest.
pub const CALM_BETWEEN: f64 = 100.0;
/// And if its first correction is so many times less.
pub const CALM_CORRECTION: f64 = 12.0;
/// A step that makes this part of what is left makes all of it.
pub const CRUMB: f64 = 0.999;
/// Nothing may move farther than this meanwhile, scaled.
pub const FARTHEST_AHEAD: f64 = 1e-7;
/// The step before tells of one that is so many times as long at most.
pub const FARTHEST_BEND: f64 = 4.0;
/// Trials on the way from the file's parameters to others before its poses are tried.
pub const FIRST_PARTS: usize = 4;
/// Iterations of Newton at most.
pub const ITERATIONS: usize = 8;
/// Newton's first correction at most, beside the size of a body or 1 rad.
pub const LARGEST_CORRECTION: f64 = 0.05;
/// How far velocities may lead elsewhere than positions, likewise: more is another branch.
pub const LARGEST_GAP: f64 = 0.001;
/// The largest motion of a step, beside the size of a body or 1 rad.
pub const LARGEST_MOTION: f64 = 0.5;
/// How far before a rim its sides are looked at, as a part of the span.
pub const LEAD: f64 = 0.001;
/// And at most (s).
pub const LONGEST_AHEAD: f64 = 1e-9;
/// How often the branches of formulas are chosen anew at one time.
pub const MOST_BRANCHES: usize = 8;
/// Halvings until two times are neighbours.
pub const MOST_HALVINGS: usize = 100;
/// Trials on it at most where these have not helped either.
pub const MOST_PARTS: usize = 200;
/// How often a correction is made half as long before it is taken as it is.
pub const MOST_SHORTER: usize = 6;
/// Steps that `step` takes at most.
pub const MOST_STEPS: usize = 10_000;
/// Corrections at most from far away.
pub const MOST_TRIALS: usize = 30;
/// A correction that is so small, scaled, is the last one from far away.
pub const NEAR: f64 = 0.02;
/// A dead point is no further off than this part of the span.
pub const NEAR_FOLD: f64 = 1e-5;
/// A position that changes by more than this at an edge jumps, scaled.
pub const POSITION_JUMP: f64 = 1e-9;
/// A speed below this part of one per span is rest, scaled.
pub const REST: f64 = 0.001;
/// Where steps become too small, this is steep enough for a singular position to be the reason.
pub const SINGULAR: f64 = 100.0;
/// So many units in the last place of a time it may be off from what is meant to happen then.
pub const SLACK: f64 = 4.0;
/// The smallest part of the way to other parameters.
pub const SMALLEST_PART: f64 = 1e-6;
/// One over a pivot, scaled: beyond this the position is looked at more closely.
pub const STEEP: f64 = 1000.0;
/// One over a pivot, scaled: beyond this it is too near to a singular one.
pub const STEEPEST: f64 = 1000000.0;
/// A velocity that changes by more than this part of the fastest at an edge jumps.
pub const VELOCITY_JUMP: f64 = 1e-7;
}
}
