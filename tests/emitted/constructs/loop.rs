//! Kinematics of mechanism `four_bar`, written by mechc 0.1.0 from `loop.mech`.
//!
//! - coordinates `q`: 9 (m, rad), equations `phi = 0`: 9
//! - `phi_q`: 21 entries that do not vanish, see [`PHI_Q_PATTERN`]
//! - parameters: 0; those that follow from others are worked out
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
use runtime::newton::Newton;
use runtime::pivoting::Pivoting;
use runtime::pivoting::close;
use runtime::pivoting::solve_with_pivoting;
use runtime::sine_and_cosine::sin_cos;
use runtime::solution::Solved;
use runtime::state::Parameters;
use runtime::state::Time;
use runtime::state::Timed;

/// The mechanism has no parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Params;

impl Parameters for Params {
    fn towards(&self, _: &Self, _: f64) -> Self {
        Self
    }

    fn is_finite(&self) -> bool {
        true
    }
}

/// Number of coordinates, and of equations.
pub const N: usize = 9;

/// Number of entries of `phi_q` that do not vanish.
pub const ENTRIES: usize = 21;

/// Coordinates (m, rad).
pub type Q = [f64; N];

/// Velocities (m/s, rad/s).
pub type Qd = [f64; N];

/// Accelerations (m/s^2, rad/s^2).
pub type Qdd = [f64; N];

/// Where each coordinate stands in `q`.
pub mod coordinate {
    /// `crank.x` (m), line 3
    pub const CRANK_X: usize = 0;
    /// `crank.y` (m), line 3
    pub const CRANK_Y: usize = 1;
    /// `crank.phi` (rad), line 3
    pub const CRANK_PHI: usize = 2;
    /// `coupler.x` (m), line 4
    pub const COUPLER_X: usize = 3;
    /// `coupler.y` (m), line 4
    pub const COUPLER_Y: usize = 4;
    /// `coupler.phi` (rad), line 4
    pub const COUPLER_PHI: usize = 5;
    /// `rocker.x` (m), line 5
    pub const ROCKER_X: usize = 6;
    /// `rocker.y` (m), line 5
    pub const ROCKER_Y: usize = 7;
    /// `rocker.phi` (rad), line 5
    pub const ROCKER_PHI: usize = 8;
}

/// Which equation each joint, constraint or driver wrote, and its unit.
pub mod row {
    /// joint `main 1` (m), line 6
    pub const MAIN_1: usize = 0;
    /// joint `main 2` (m), line 6
    pub const MAIN_2: usize = 1;
    /// joint `pin 1` (m), line 7
    pub const PIN_1: usize = 2;
    /// joint `pin 2` (m), line 7
    pub const PIN_2: usize = 3;
    /// joint `knee 1` (m), line 8
    pub const KNEE_1: usize = 4;
    /// joint `knee 2` (m), line 8
    pub const KNEE_2: usize = 5;
    /// joint `pivot 1` (m), line 9
    pub const PIVOT_1: usize = 6;
    /// joint `pivot 2` (m), line 9
    pub const PIVOT_2: usize = 7;
    /// driver `motor` (rad), line 10
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
    (4, 8),
    (5, 4),
    (5, 5),
    (5, 7),
    (5, 8),
    (6, 6),
    (6, 8),
    (7, 7),
    (7, 8),
    (8, 2),
];

/// The bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// `crank`, line 3
    Crank,
    /// `coupler`, line 4
    Coupler,
    /// `rocker`, line 5
    Rocker,
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
            Body::Coupler => Self { x: q[3], y: q[4], phi: q[5] },
            Body::Rocker => Self { x: q[6], y: q[7], phi: q[8] },
        }
    }
}

/// The residual of the equations, each in its unit: see [`row`].
///
/// 27 operations.
pub fn phi(q: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let crank_phi = q[2];
    let crank_x = q[0];
    let crank_y = q[1];
    let coupler_phi = q[5];
    let coupler_x = q[3];
    let coupler_y = q[4];
    let rocker_phi = q[8];
    let rocker_x = q[6];
    let rocker_y = q[7];

    let v1 = 0.5235987755982988 + t;
    let (s2, c2) = sin_cos(crank_phi);
    let v3 = -crank_x;
    let v4 = -crank_y;
    let v5 = c2 + crank_x;
    let v6 = s2 + crank_y;
    let (s7, c7) = sin_cos(coupler_phi);
    let v8 = v5 - coupler_x;
    let v9 = v6 - coupler_y;
    let v10 = 3.5 * c7;
    let v11 = 3.5 * s7;
    let v12 = coupler_x + v10;
    let v13 = coupler_y + v11;
    let (s14, c14) = sin_cos(rocker_phi);
    let v15 = 1.5 * c14;
    let v16 = 1.5 * s14;
    let v17 = v15 + rocker_x;
    let v18 = v16 + rocker_y;
    let v19 = v12 - v17;
    let v20 = v13 - v18;
    let v21 = -1.5 * c14;
    let v22 = -1.5 * s14;
    let v23 = rocker_x + v21;
    let v24 = rocker_y + v22;
    let v25 = 4.0 - v23;
    let v26 = -v24;
    let v27 = crank_phi - v1;

    out[0] = v3;
    out[1] = v4;
    out[2] = v8;
    out[3] = v9;
    out[4] = v19;
    out[5] = v20;
    out[6] = v25;
    out[7] = v26;
    out[8] = v27;
    out
}

/// The Jacobian: the values of its entries, in the order of [`PHI_Q_PATTERN`] (the equation's unit per m or
/// rad).
///
/// 10 operations.
pub fn phi_q(q: &[f64; N], _t: f64, _p: &Params) -> [f64; ENTRIES] {
    let mut out = [0.0; ENTRIES];
    let crank_phi = q[2];
    let coupler_phi = q[5];
    let rocker_phi = q[8];

    let (s1, c1) = sin_cos(crank_phi);
    let (s2, c2) = sin_cos(coupler_phi);
    let v3 = 3.5 * c2;
    let (s4, c4) = sin_cos(rocker_phi);
    let v5 = 1.5 * c4;
    let v6 = 1.5 * s4;
    let v7 = -1.5 * c4;
    let v8 = -1.5 * s4;
    let v9 = -s1;
    let v10 = -3.5 * s2;

    out[0] = -1.0;
    out[1] = -1.0;
    out[2] = 1.0;
    out[3] = v9;
    out[4] = -1.0;
    out[5] = 1.0;
    out[6] = c1;
    out[7] = -1.0;
    out[8] = 1.0;
    out[9] = v10;
    out[10] = -1.0;
    out[11] = v6;
    out[12] = 1.0;
    out[13] = v3;
    out[14] = -1.0;
    out[15] = v7;
    out[16] = -1.0;
    out[17] = v8;
    out[18] = -1.0;
    out[19] = v5;
    out[20] = 1.0;
    out
}

/// The partial derivative of `phi` by time (the equation's unit per s).
///
/// 0 operations.
pub fn phi_t(_q: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    out[8] = -1.0;
    out
}

/// Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).
///
/// 0 operations.
pub fn nu(_q: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    out[8] = 1.0;
    out
}

/// Right side of the acceleration equation `phi_q qdd = gamma` (the equation's unit per s^2).
///
/// 23 operations.
pub fn gamma(q: &[f64; N], qd: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let crank_phi = q[2];
    let coupler_phi = q[5];
    let rocker_phi = q[8];
    let crank_phi_d = qd[2];
    let coupler_phi_d = qd[5];
    let rocker_phi_d = qd[8];

    let (s1, c1) = sin_cos(crank_phi);
    let (s2, c2) = sin_cos(coupler_phi);
    let (s3, c3) = sin_cos(rocker_phi);
    let v4 = s1 * crank_phi_d;
    let v5 = c1 * crank_phi_d;
    let v6 = s2 * coupler_phi_d;
    let v7 = c2 * coupler_phi_d;
    let v8 = s3 * rocker_phi_d;
    let v9 = c3 * rocker_phi_d;
    let v10 = crank_phi_d * v5;
    let v11 = crank_phi_d * v4;
    let v12 = coupler_phi_d * v7;
    let v13 = coupler_phi_d * v6;
    let v14 = -3.5 * v12;
    let v15 = -3.5 * v13;
    let v16 = rocker_phi_d * v9;
    let v17 = rocker_phi_d * v8;
    let v18 = 1.5 * v16;
    let v19 = v14 + v18;
    let v20 = 1.5 * v17;
    let v21 = v15 + v20;
    let v22 = -v19;
    let v23 = -v21;

    out[2] = v10;
    out[3] = v11;
    out[4] = v22;
    out[5] = v23;
    out[6] = v18;
    out[7] = v20;
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
pub const COLUMNS: usize = 28;

/// The first time of the file's analysis (s), at which the mechanism is assembled.
pub const START_TIME: f64 = 0.0;

/// How long the file's analysis takes (s).
const SPAN: f64 = 1.0;

/// The longest step (s).
pub const LONGEST_STEP: f64 = 0.03125;

/// The shortest step (s).
const SMALLEST_STEP: f64 = 1e-12;

/// What a change of each coordinate is judged against.
#[rustfmt::skip]
static SCALES: [f64; N] = [
    1.0, 1.0, 1.0, 3.5,
    3.5, 1.0, 3.0, 3.0,
    1.0,
];

/// The assembled position (m, rad).
#[rustfmt::skip]
static START: [f64; N] = [
    0.0, 0.0, 0.5235987755982988, 0.8660254037844387,
    0.49999999999999994, 0.7695009577260922, 3.6899641688409766, 1.4676095473243331,
    1.7789875846735397,
];

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
const TURNS: usize = 1;

/// Whether they are negative where all pivots are positive.
#[rustfmt::skip]
static TURNED: [bool; TURNS] = [
    false,
];

/// Number of places where formulas have branches.
const SIDES: usize = 0;

/// Which branch is taken at each: what a comparison gives, the number of a piece.
type Sides = [f64; SIDES];

/// What solves the equations at a time.
type Solution = runtime::solution::Solution<Model>;

/// Position, velocity and acceleration at a time. Newton begins with a guess of `rocker.phi`,
/// `coupler.phi`; all else follows.
///
/// 95 operations.
fn solve(guess: &[f64; TEARS], t: f64, _m: &Model, at: &mut Solution) {
    at.begin(t);
    let crank_phi = 0.5235987755982988 + t;
    at.q[2] = crank_phi + 0.0;
    at.qd[2] = 1.0;
    let (coupler_y, coupler_x) = sin_cos(crank_phi);
    at.q[3] = coupler_x + 0.0;
    let coupler_x_d = -coupler_y;
    at.qd[3] = coupler_x_d + 0.0;
    let coupler_x_dd = -coupler_x;
    at.qdd[3] = coupler_x_dd + 0.0;
    at.q[4] = coupler_y + 0.0;
    at.qd[4] = coupler_x + 0.0;
    let coupler_y_dd = -coupler_y;
    at.qdd[4] = coupler_y_dd + 0.0;
    let mut x1 = guess[0];
    let mut x2 = guess[1];
    let mut s6 = 0.0;
    let mut c6 = 0.0;
    let mut s10 = 0.0;
    let mut c10 = 0.0;
    let mut v28 = 0.0;
    let mut v31 = 0.0;
    x1 = on_grid(x1, 7.450580596923828e-9);
    x2 = on_grid(x2, 7.450580596923828e-9);
    let mut newton = Newton::new();
    for _ in 0..ITERATIONS {
        (s6, c6) = sin_cos(x1);
        let v7 = -1.5 * c6;
        let v8 = 4.0 - v7;
        let v9 = -1.5 * s6;
        (s10, c10) = sin_cos(x2);
        let v11 = -3.5 * s10;
        let v12 = 1.5 * s6;
        let v13 = 3.5 * c10;
        let v14 = 1.5 * c6;
        let v15 = v7 - v14;
        let v16 = v12 - v9;
        let v17 = v16 * v13;
        let v18 = v17 - v11 * v15;
        let v19 = 1.0 / v18;
        let v20 = v14 + v8;
        let v21 = coupler_x + v13;
        let v22 = v21 - v20;
        let v23 = v12 - v9;
        let v24 = 3.5 * s10 + coupler_y;
        let v25 = v24 - v23;
        let v26 = v11 * v25;
        let v27 = v26 - v13 * v22;
        v28 = v27 * v19;
        let v29 = v15 * v22;
        let v30 = v29 - v16 * v25;
        v31 = v30 * v19;
        newton.record(v28, 7.450580596923828e-9, 1.0);
        newton.record(v31, 7.450580596923828e-9, 1.0);
        if newton.is_done() {
            break;
        }
        x1 = newton.next(x1, v28, 7.450580596923828e-9);
        x2 = newton.next(x2, v31, 7.450580596923828e-9);
    }
    at.note(&newton);
    x1 += v28;
    x2 += v31;
    let v32 = 0.5 * v28;
    let v33 = c6 - v32 * s6;
    let v34 = v28 * v33 + s6;
    let v35 = v32 * c6 + s6;
    let v36 = c6 - v28 * v35;
    let v37 = -1.5 * v36;
    let rocker_x = 4.0 - v37;
    let v39 = -1.5 * v34;
    let v40 = 1.5 * v36;
    let v41 = v40 + rocker_x;
    let v42 = 0.5 * v31;
    let v43 = c10 - v42 * s10;
    let v44 = v31 * v43 + s10;
    let v45 = v42 * c10 + s10;
    let v46 = c10 - v31 * v45;
    let v47 = 3.5 * v46;
    let v48 = coupler_x + v47;
    let v49 = v48 - v41;
    at.holds &= v49.abs() <= 5.4226575191377436e-12;
    let v50 = 1.5 * v34;
    let v51 = v50 - v39;
    let v52 = 3.5 * v44 + coupler_y;
    let v53 = v52 - v51;
    at.holds &= v53.abs() <= 5.263268038005443e-12;
    let v54 = -3.5 * v44;
    let v55 = v37 - v40;
    let v56 = v50 - v39;
    let v57 = v56 * v47;
    let v58 = v57 - v54 * v55;
    let v59 = 1.0 / v58;
    at.q[5] = x2 + 0.0;
    let rocker_y = -v39;
    at.q[7] = rocker_y + 0.0;
    at.q[6] = rocker_x + 0.0;
    at.q[8] = x1 + 0.0;
    at.pivot(0, v59, 28.487789677465305);
    let v61 = v47 * coupler_y;
    let v62 = v54 * coupler_x + v61;
    let rocker_phi_d = v62 * v59;
    let v64 = v56 * coupler_x;
    let v65 = v55 * coupler_y + v64;
    let v66 = v65 * v59;
    let rocker_x_d = v39 * rocker_phi_d;
    let rocker_y_d = v40 * rocker_phi_d;
    let coupler_phi_d = -v66;
    at.qd[5] = coupler_phi_d + 0.0;
    at.qd[7] = rocker_y_d + 0.0;
    at.qd[6] = rocker_x_d + 0.0;
    at.qd[8] = rocker_phi_d + 0.0;
    let v70 = v36 * rocker_phi_d;
    let v71 = rocker_phi_d * v70;
    let v72 = 1.5 * v71;
    let v73 = v46 * v66;
    let v74 = v66 * v73;
    let v75 = -3.5 * v74 + v72;
    let v76 = coupler_x - v75;
    let v77 = v34 * rocker_phi_d;
    let v78 = rocker_phi_d * v77;
    let v79 = 1.5 * v78;
    let v80 = v44 * v66;
    let v81 = v66 * v80;
    let v82 = -3.5 * v81 + v79;
    let v83 = coupler_y - v82;
    let v84 = v83 - v79;
    let v85 = v76 - v72;
    let v86 = v47 * v85;
    let v87 = v86 - v54 * v84;
    let rocker_phi_dd = v87 * v59;
    let v89 = v56 * v84;
    let v90 = v89 - v55 * v85;
    let coupler_phi_dd = v90 * v59;
    let v92 = v72 - v39 * rocker_phi_dd;
    let v93 = v79 - v40 * rocker_phi_dd;
    at.qdd[5] = coupler_phi_dd + 0.0;
    let rocker_y_dd = -v93;
    at.qdd[7] = rocker_y_dd + 0.0;
    let rocker_x_dd = -v92;
    at.qdd[6] = rocker_x_dd + 0.0;
    at.qdd[8] = rocker_phi_dd + 0.0;
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
    type Measures = ();
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
            q[8], q[5],
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
    7.450580596923828e-9, 7.450580596923828e-9, 7.450580596923828e-9, 1.4901161193847656e-8,
    1.4901161193847656e-8, 7.450580596923828e-9, 1.4901161193847656e-8, 1.4901161193847656e-8,
    7.450580596923828e-9,
];

/// Number of blocks of equations that can be solved one after the other.
const BLOCKS: usize = 6;

/// The blocks whose determinants change.
#[rustfmt::skip]
static TURNING: [usize; TURNS] = [
    5,
];

/// Numbers that the elimination of the largest block works on.
const WORK: usize = work_of(4);

/// How the equations fall apart into blocks.
#[rustfmt::skip]
static EQUATIONS: Blocks<'static> = Blocks {
    sizes: &[
        1, 1, 1, 1,
        1, 4,
    ],
    rows: &[
        0, 1, 8, 2,
        3, 4, 5, 6,
        7,
    ],
    columns: &[
        0, 1, 2, 3,
        4, 5, 7, 6,
        8,
    ],
    starts: &[
        0, 1, 2, 5,
        8, 12, 16, 18,
        20, 21,
    ],
    entries: &[
        0, 1, 0, 2,
        3, 1, 2, 4,
        3, 5, 6, 8,
        4, 5, 7, 8,
        6, 8, 7, 8,
        2,
    ],
    places: &[
        0, 1, 2, 3,
        4, 5, 7, 6,
        8,
    ],
    units: &[
        1.0, 1.0, 1.0, 2.0,
        2.0, 1.0, 2.0, 2.0,
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

    fn measured(&self, _orders: [&Q; 4], _varied: &[f64; 0], _multipliers: &Q, _t: f64) {}
}

/// Where the file's poses put the coordinates, roughly: what is not closed yet.
///
/// 0 operations.
fn drawn(_p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    out[2] = 0.5235987755982988;
    out[3] = 0.88;
    out[4] = 0.48;
    out[5] = 0.78;
    out[6] = 3.7;
    out[7] = 1.5;
    out[8] = 1.8;
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
