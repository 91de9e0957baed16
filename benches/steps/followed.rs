//! Kinematics of mechanism `four_bar`, written by mechc 0.1.0 from `four_bar.mech`.
//!
//! - coordinates `q`: 9 (m, rad), equations `phi = 0`: 9
//! - `phi_q`: 21 entries that do not vanish, see [`PHI_Q_PATTERN`]
//! - parameters: 1; those that follow from others are worked out
//! - the motion: [`assemble`], then [`step`] from time to time
//! - the motion by its inputs: [`follow`] from [`Inputs`] to others
//! - needs no other crate
//! - needs no heap and no standard library; nothing in it panics
//!
//! This code carries no licence of mechc's: use, change and pass it on as you like.

#![allow(clippy::approx_constant, clippy::eq_op)]
#![allow(clippy::excessive_precision, clippy::large_const_arrays)]

use runtime::blocks::Blocks;
use runtime::blocks::work_of;
use runtime::equations::Branches;
use runtime::equations::Checks;
use runtime::equations::Equations;
use runtime::error::Fault;
use runtime::follow::Leading;
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
    /// `crank_length` (m), line 3
    pub crank_length: f64,
}

impl Default for Params {
    #[rustfmt::skip]
    fn default() -> Self {
        Self {
            crank_length: 1.0,
        }
    }
}

impl Parameters for Params {
    #[rustfmt::skip]
    fn towards(&self, other: &Self, part: f64) -> Self {
        Self {
            crank_length: self.crank_length + part * (other.crank_length - self.crank_length),
        }
    }

    #[rustfmt::skip]
    fn is_finite(&self) -> bool {
        let all = [
            self.crank_length,
        ];
        all.into_iter().all(f64::is_finite)
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
    /// `crank.x` (m), line 6
    pub const CRANK_X: usize = 0;
    /// `crank.y` (m), line 6
    pub const CRANK_Y: usize = 1;
    /// `crank.phi` (rad), line 6
    pub const CRANK_PHI: usize = 2;
    /// `coupler.x` (m), line 7
    pub const COUPLER_X: usize = 3;
    /// `coupler.y` (m), line 7
    pub const COUPLER_Y: usize = 4;
    /// `coupler.phi` (rad), line 7
    pub const COUPLER_PHI: usize = 5;
    /// `rocker.x` (m), line 8
    pub const ROCKER_X: usize = 6;
    /// `rocker.y` (m), line 8
    pub const ROCKER_Y: usize = 7;
    /// `rocker.phi` (rad), line 8
    pub const ROCKER_PHI: usize = 8;
}

/// Which equation each joint, constraint or driver wrote, and its unit.
pub mod row {
    /// joint `main 1` (m), line 9
    pub const MAIN_1: usize = 0;
    /// joint `main 2` (m), line 9
    pub const MAIN_2: usize = 1;
    /// joint `pin 1` (m), line 10
    pub const PIN_1: usize = 2;
    /// joint `pin 2` (m), line 10
    pub const PIN_2: usize = 3;
    /// joint `knee 1` (m), line 11
    pub const KNEE_1: usize = 4;
    /// joint `knee 2` (m), line 11
    pub const KNEE_2: usize = 5;
    /// joint `pivot 1` (m), line 12
    pub const PIVOT_1: usize = 6;
    /// joint `pivot 2` (m), line 12
    pub const PIVOT_2: usize = 7;
    /// driver `motor` (rad), line 13
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
    /// `crank`, line 6
    Crank,
    /// `coupler`, line 7
    Coupler,
    /// `rocker`, line 8
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

/// Where each measure stands among the values, all in SI.
pub mod measure {
    /// `tip`, line 14
    pub const TIP: usize = 0;
    /// `push`, line 15
    pub const PUSH: usize = 1;
    /// `asked`, line 16
    pub const ASKED: usize = 2;
}

/// How many they are.
pub const MEASURES: usize = 3;

/// Where the first time derivative of each measure that has one stands among the rates.
pub mod measure_rate {
    /// `tip`, line 14
    pub const TIP: usize = 0;
    /// `push`, line 15
    pub const PUSH: usize = 1;
    /// `asked`, line 16
    pub const ASKED: usize = 2;
}

/// How many they are.
pub const RATES: usize = 3;

/// Where the second time derivative of each measure that has one stands among the accelerations.
pub mod measure_acceleration {
    /// `tip`, line 14
    pub const TIP: usize = 0;
    /// `asked`, line 16
    pub const ASKED: usize = 1;
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
/// 32 operations.
pub fn phi(q: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let coupler_phi = q[5];
    let coupler_x = q[3];
    let coupler_y = q[4];
    let crank_phi = q[2];
    let crank_x = q[0];
    let crank_y = q[1];
    let crank_length = p.crank_length;
    let rocker_phi = q[8];
    let rocker_x = q[6];
    let rocker_y = q[7];

    let v1 = 2.0 * t;
    let (s2, _) = sin_cos(v1);
    let v3 = 1.5 * s2;
    let v4 = 0.5235987755982988 + v3;
    let (s5, c5) = sin_cos(coupler_phi);
    let v6 = 3.5 * c5;
    let v7 = 3.5 * s5;
    let v8 = v6 + coupler_x;
    let v9 = v7 + coupler_y;
    let (s10, c10) = sin_cos(crank_phi);
    let v11 = -crank_x;
    let v12 = -crank_y;
    let v13 = c10 * crank_length;
    let v14 = s10 * crank_length;
    let v15 = crank_x + v13;
    let v16 = crank_y + v14;
    let v17 = v15 - coupler_x;
    let v18 = v16 - coupler_y;
    let (s19, c19) = sin_cos(rocker_phi);
    let v20 = 1.5 * c19;
    let v21 = 1.5 * s19;
    let v22 = v20 + rocker_x;
    let v23 = v21 + rocker_y;
    let v24 = v8 - v22;
    let v25 = v9 - v23;
    let v26 = -1.5 * c19;
    let v27 = -1.5 * s19;
    let v28 = rocker_x + v26;
    let v29 = rocker_y + v27;
    let v30 = 4.0 - v28;
    let v31 = -v29;
    let v32 = crank_phi - v4;

    out[0] = v11;
    out[1] = v12;
    out[2] = v17;
    out[3] = v18;
    out[4] = v24;
    out[5] = v25;
    out[6] = v30;
    out[7] = v31;
    out[8] = v32;
    out
}

/// The Jacobian: the values of its entries, in the order of [`PHI_Q_PATTERN`] (the equation's unit per m or
/// rad).
///
/// 12 operations.
pub fn phi_q(q: &[f64; N], _t: f64, p: &Params) -> [f64; ENTRIES] {
    let mut out = [0.0; ENTRIES];
    let coupler_phi = q[5];
    let crank_phi = q[2];
    let crank_length = p.crank_length;
    let rocker_phi = q[8];

    let (s1, c1) = sin_cos(coupler_phi);
    let v2 = 3.5 * c1;
    let (s3, c3) = sin_cos(crank_phi);
    let v4 = c3 * crank_length;
    let v5 = s3 * crank_length;
    let (s6, c6) = sin_cos(rocker_phi);
    let v7 = 1.5 * c6;
    let v8 = 1.5 * s6;
    let v9 = -1.5 * c6;
    let v10 = -1.5 * s6;
    let v11 = -v5;
    let v12 = -3.5 * s1;

    out[0] = -1.0;
    out[1] = -1.0;
    out[2] = 1.0;
    out[3] = v11;
    out[4] = -1.0;
    out[5] = 1.0;
    out[6] = v4;
    out[7] = -1.0;
    out[8] = 1.0;
    out[9] = v12;
    out[10] = -1.0;
    out[11] = v8;
    out[12] = 1.0;
    out[13] = v2;
    out[14] = -1.0;
    out[15] = v9;
    out[16] = -1.0;
    out[17] = v10;
    out[18] = -1.0;
    out[19] = v7;
    out[20] = 1.0;
    out
}

/// The partial derivative of `phi` by time (the equation's unit per s).
///
/// 3 operations.
pub fn phi_t(_q: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let v1 = 2.0 * t;
    let (_, c2) = sin_cos(v1);
    let v3 = 3.0 * c2;

    out[8] = -v3;
    out
}

/// Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).
///
/// 3 operations.
pub fn nu(_q: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let v1 = 2.0 * t;
    let (_, c2) = sin_cos(v1);
    let v3 = 3.0 * c2;

    out[8] = v3;
    out
}

/// Right side of the acceleration equation `phi_q qdd = gamma` (the equation's unit per s^2).
///
/// 28 operations.
pub fn gamma(q: &[f64; N], qd: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let coupler_phi = q[5];
    let crank_phi = q[2];
    let rocker_phi = q[8];
    let coupler_phi_d = qd[5];
    let crank_phi_d = qd[2];
    let rocker_phi_d = qd[8];
    let crank_length = p.crank_length;

    let v1 = 2.0 * t;
    let (s2, _) = sin_cos(v1);
    let (s3, c3) = sin_cos(coupler_phi);
    let (s4, c4) = sin_cos(crank_phi);
    let (s5, c5) = sin_cos(rocker_phi);
    let v6 = s3 * coupler_phi_d;
    let v7 = c3 * coupler_phi_d;
    let v8 = coupler_phi_d * v7;
    let v9 = coupler_phi_d * v6;
    let v10 = -6.0 * s2;
    let v11 = s4 * crank_phi_d;
    let v12 = c4 * crank_phi_d;
    let v13 = s5 * rocker_phi_d;
    let v14 = c5 * rocker_phi_d;
    let v15 = -3.5 * v8;
    let v16 = -3.5 * v9;
    let v17 = crank_phi_d * v12;
    let v18 = crank_phi_d * v11;
    let v19 = crank_length * v17;
    let v20 = crank_length * v18;
    let v21 = rocker_phi_d * v14;
    let v22 = rocker_phi_d * v13;
    let v23 = 1.5 * v21;
    let v24 = v15 + v23;
    let v25 = 1.5 * v22;
    let v26 = v16 + v25;
    let v27 = -v24;
    let v28 = -v26;

    out[2] = v19;
    out[3] = v20;
    out[4] = v27;
    out[5] = v28;
    out[6] = v23;
    out[7] = v25;
    out[8] = v10;
    out
}

/// Right side of the jerk equation `phi_q qddd = jerk`.
///
/// 64 operations.
pub fn jerk(q: &[f64; N], qd: &[f64; N], qdd: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let coupler_phi = q[5];
    let crank_phi = q[2];
    let rocker_phi = q[8];
    let coupler_phi_d = qd[5];
    let crank_phi_d = qd[2];
    let rocker_phi_d = qd[8];
    let coupler_phi_dd = qdd[5];
    let crank_phi_dd = qdd[2];
    let rocker_phi_dd = qdd[8];
    let crank_length = p.crank_length;

    let v1 = 2.0 * t;
    let (_, c2) = sin_cos(v1);
    let (s3, c3) = sin_cos(coupler_phi);
    let (s4, c4) = sin_cos(crank_phi);
    let (s5, c5) = sin_cos(rocker_phi);
    let v6 = s3 * coupler_phi_d;
    let v7 = c3 * coupler_phi_d;
    let v8 = coupler_phi_d * v7;
    let v9 = coupler_phi_d * v6;
    let v10 = s4 * crank_phi_d;
    let v11 = c4 * crank_phi_d;
    let v12 = s5 * rocker_phi_d;
    let v13 = c5 * rocker_phi_d;
    let v14 = crank_phi_d * v11;
    let v15 = crank_phi_d * v10;
    let v16 = rocker_phi_d * v13;
    let v17 = rocker_phi_d * v12;
    let v18 = s3 * coupler_phi_dd;
    let v19 = v8 + v18;
    let v20 = c3 * coupler_phi_dd;
    let v21 = v20 - v9;
    let v22 = v7 * coupler_phi_dd;
    let v23 = coupler_phi_d * v21;
    let v24 = v22 + v23;
    let v25 = s4 * crank_phi_dd;
    let v26 = v14 + v25;
    let v27 = c4 * crank_phi_dd;
    let v28 = v27 - v15;
    let v29 = s5 * rocker_phi_dd;
    let v30 = v16 + v29;
    let v31 = c5 * rocker_phi_dd;
    let v32 = v31 - v17;
    let v33 = v22 + v24;
    let v34 = -3.5 * v33;
    let v35 = v6 * coupler_phi_dd;
    let v36 = coupler_phi_d * v19;
    let v37 = v35 + v36;
    let v38 = v35 + v37;
    let v39 = v11 * crank_phi_dd;
    let v40 = crank_phi_d * v28;
    let v41 = v39 + v40;
    let v42 = v10 * crank_phi_dd;
    let v43 = crank_phi_d * v26;
    let v44 = v42 + v43;
    let v45 = v13 * rocker_phi_dd;
    let v46 = rocker_phi_d * v32;
    let v47 = v45 + v46;
    let v48 = v12 * rocker_phi_dd;
    let v49 = rocker_phi_d * v30;
    let v50 = v48 + v49;
    let v51 = -3.5 * v38;
    let v52 = v39 + v41;
    let v53 = v42 + v44;
    let v54 = crank_length * v52;
    let v55 = crank_length * v53;
    let v56 = v45 + v47;
    let v57 = v48 + v50;
    let v58 = 1.5 * v56;
    let v59 = v34 + v58;
    let v60 = 1.5 * v57;
    let v61 = v51 + v60;
    let v62 = -v59;
    let v63 = -v61;
    let v64 = -12.0 * c2;

    out[2] = v54;
    out[3] = v55;
    out[4] = v62;
    out[5] = v63;
    out[6] = v58;
    out[7] = v60;
    out[8] = v64;
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
/// accelerations, and their third derivatives.
pub fn measures(q: &Q, qd: &Qd, qdd: &Qdd, qddd: &[f64; N], t: f64, p: &Params) -> Measures {
    let mut all = all_measures(q, qd, qdd, qddd, t, p).into_iter();
    let mut next = || all.next().unwrap_or(f64::NAN) + 0.0;
    Measures {
        values: core::array::from_fn(|_| next()),
        rates: core::array::from_fn(|_| next()),
        accelerations: core::array::from_fn(|_| next()),
    }
}

/// The measures, their rates and their accelerations, one behind the other.
///
/// 29 operations.
fn all_measures(
    q: &[f64; N],
    qd: &[f64; N],
    qdd: &[f64; N],
    qddd: &[f64; N],
    t: f64,
    _p: &Params,
) -> [f64; 8] {
    let mut out = [0.0; 8];
    let coupler_phi = q[5];
    let coupler_x = q[3];
    let coupler_phi_d = qd[5];
    let coupler_phi_dd = qdd[5];
    let coupler_x_dd = qdd[3];
    let coupler_x_d = qd[3];
    let qddd5 = qddd[5];
    let qddd3 = qddd[3];

    let v1 = 2.0 * t;
    let (s2, c2) = sin_cos(v1);
    let v3 = 1.5 * s2;
    let v4 = 0.5235987755982988 + v3;
    let (s5, c5) = sin_cos(coupler_phi);
    let v6 = 3.5 * c5;
    let v7 = v6 + coupler_x;
    let v8 = 3.0 * c2;
    let v9 = s5 * coupler_phi_d;
    let v10 = c5 * coupler_phi_d;
    let v11 = coupler_phi_d * v10;
    let v12 = coupler_phi_d * v9;
    let v13 = -6.0 * s2;
    let v14 = s5 * coupler_phi_dd;
    let v15 = v11 + v14;
    let v16 = c5 * coupler_phi_dd;
    let v17 = v16 - v12;
    let v18 = v10 * coupler_phi_dd;
    let v19 = coupler_phi_d * v17;
    let v20 = v18 + v19;
    let v21 = -3.5 * v15;
    let v22 = v21 + coupler_x_dd;
    let v23 = -3.5 * v9;
    let v24 = v23 + coupler_x_d;
    let v25 = s5 * qddd5;
    let v26 = v18 + v25;
    let v27 = v20 + v26;
    let v28 = -3.5 * v27;
    let v29 = v28 + qddd3;

    out[0] = v7;
    out[1] = v22;
    out[2] = v4;
    out[3] = v24;
    out[4] = v29;
    out[5] = v8;
    out[6] = v22;
    out[7] = v13;
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

    /// The inputs: what they were followed to, or what their formulas say at this time.
    #[must_use]
    pub fn inputs(&self) -> Inputs {
        Inputs::of(&runtime::follow::signals(self))
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

    /// The same, counted.
    pub fn follow(inputs: &Inputs, state: &mut State, work: &mut Work) -> Result<(), Error> {
        runtime::follow::follow(&inputs.signals(), state, MOST_STEPS_TO_FOLLOW, work)
    }

    /// The same, counted.
    pub fn follow_within(
        inputs: &Inputs,
        state: &mut State,
        most: usize,
        work: &mut Work,
    ) -> Result<Progress, Error> {
        runtime::follow::follow_within(&inputs.signals(), state, most, work)
    }
}

/// Number of results at a time.
pub const COLUMNS: usize = 36;

/// The first time of the file's analysis (s), at which the mechanism is assembled.
pub const START_TIME: f64 = 0.0;

/// How long the file's analysis takes (s).
const SPAN: f64 = 3.0;

/// The longest step (s).
pub const LONGEST_STEP: f64 = 0.09375;

/// The shortest step (s).
const SMALLEST_STEP: f64 = 3e-12;

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
/// 162 operations.
fn solve(guess: &[f64; TEARS], t: f64, m: &Model, at: &mut Solution) {
    at.begin(t);
    let v1 = 2.0 * t;
    let (s2, c2) = sin_cos(v1);
    let crank_phi = 1.5 * s2 + 0.5235987755982988;
    at.q[2] = crank_phi + 0.0;
    let crank_phi_d = 3.0 * c2;
    at.qd[2] = crank_phi_d + 0.0;
    let crank_phi_dd = -6.0 * s2;
    at.qdd[2] = crank_phi_dd + 0.0;
    let v6 = -12.0 * c2;
    let v7 = m.params.crank_length;
    let (s8, c8) = sin_cos(crank_phi);
    let coupler_x = c8 * v7;
    at.q[3] = coupler_x + 0.0;
    let coupler_y = s8 * v7;
    let v11 = coupler_y * crank_phi_d;
    let coupler_x_d = -v11;
    at.qd[3] = coupler_x_d + 0.0;
    let v13 = c8 * crank_phi_d;
    let v14 = crank_phi_d * v13;
    let v15 = v7 * v14;
    let v16 = coupler_y * crank_phi_dd + v15;
    let coupler_x_dd = -v16;
    at.qdd[3] = coupler_x_dd + 0.0;
    let v18 = s8 * crank_phi_d;
    let v19 = crank_phi_d * v18;
    let v20 = c8 * crank_phi_dd - v19;
    let v21 = v13 * crank_phi_dd;
    let v22 = crank_phi_d * v20 + v21;
    let v23 = v21 + v22;
    let v24 = v7 * v23;
    let v25 = coupler_y * v6 + v24;
    at.q[4] = coupler_y + 0.0;
    let coupler_y_d = coupler_x * crank_phi_d;
    at.qd[4] = coupler_y_d + 0.0;
    let v27 = v7 * v19;
    let v28 = v27 - coupler_x * crank_phi_dd;
    let coupler_y_dd = -v28;
    at.qdd[4] = coupler_y_dd + 0.0;
    let v30 = s8 * crank_phi_dd + v14;
    let v31 = v18 * crank_phi_dd;
    let v32 = crank_phi_d * v30 + v31;
    let v33 = v31 + v32;
    let v34 = v7 * v33;
    let v35 = v34 - coupler_x * v6;
    let mut x1 = guess[0];
    let mut x2 = guess[1];
    let mut s36 = 0.0;
    let mut c36 = 0.0;
    let mut s40 = 0.0;
    let mut c40 = 0.0;
    let mut v58 = 0.0;
    let mut v61 = 0.0;
    x1 = on_grid(x1, 7.450580596923828e-9);
    x2 = on_grid(x2, 7.450580596923828e-9);
    let mut newton = Newton::new();
    for _ in 0..ITERATIONS {
        (s36, c36) = sin_cos(x1);
        let v37 = -1.5 * c36;
        let v38 = 4.0 - v37;
        let v39 = -1.5 * s36;
        (s40, c40) = sin_cos(x2);
        let v41 = -3.5 * s40;
        let v42 = 1.5 * s36;
        let v43 = 3.5 * c40;
        let v44 = 1.5 * c36;
        let v45 = v37 - v44;
        let v46 = v42 - v39;
        let v47 = v46 * v43;
        let v48 = v47 - v41 * v45;
        let v49 = 1.0 / v48;
        let v50 = v44 + v38;
        let v51 = v43 + coupler_x;
        let v52 = v51 - v50;
        let v53 = v42 - v39;
        let v54 = 3.5 * s40 + coupler_y;
        let v55 = v54 - v53;
        let v56 = v41 * v55;
        let v57 = v56 - v43 * v52;
        v58 = v57 * v49;
        let v59 = v45 * v52;
        let v60 = v59 - v46 * v55;
        v61 = v60 * v49;
        newton.see(v58, 7.450580596923828e-9, 1.0);
        newton.see(v61, 7.450580596923828e-9, 1.0);
        if newton.is_done() {
            break;
        }
        x1 = newton.next(x1, v58, 7.450580596923828e-9);
        x2 = newton.next(x2, v61, 7.450580596923828e-9);
    }
    at.note(&newton);
    x1 += v58;
    x2 += v61;
    let v62 = 0.5 * v58;
    let v63 = c36 - v62 * s36;
    let v64 = v58 * v63 + s36;
    let v65 = v62 * c36 + s36;
    let v66 = c36 - v58 * v65;
    let v67 = -1.5 * v66;
    let rocker_x = 4.0 - v67;
    let v69 = -1.5 * v64;
    let v70 = 1.5 * v66;
    let v71 = v70 + rocker_x;
    let v72 = 0.5 * v61;
    let v73 = c40 - v72 * s40;
    let v74 = v61 * v73 + s40;
    let v75 = v72 * c40 + s40;
    let v76 = c40 - v61 * v75;
    let v77 = 3.5 * v76;
    let v78 = v77 + coupler_x;
    let v79 = v78 - v71;
    at.holds &= v79.abs() <= 5.4226575191377436e-12;
    let v80 = 1.5 * v64;
    let v81 = v80 - v69;
    let v82 = 3.5 * v74 + coupler_y;
    let v83 = v82 - v81;
    at.holds &= v83.abs() <= 5.263268038005443e-12;
    let v84 = -3.5 * v74;
    let v85 = v67 - v70;
    let v86 = v80 - v69;
    let v87 = v86 * v77;
    let v88 = v87 - v84 * v85;
    let v89 = 1.0 / v88;
    at.q[5] = x2 + 0.0;
    let rocker_y = -v69;
    at.q[7] = rocker_y + 0.0;
    at.q[6] = rocker_x + 0.0;
    at.q[8] = x1 + 0.0;
    at.pivot(0, v89, 28.487789677465305);
    let v91 = v77 * v11;
    let v92 = v84 * coupler_y_d + v91;
    let rocker_phi_d = v92 * v89;
    let v94 = v86 * coupler_y_d;
    let v95 = v85 * v11 + v94;
    let v96 = v95 * v89;
    let rocker_x_d = v69 * rocker_phi_d;
    let rocker_y_d = v70 * rocker_phi_d;
    let coupler_phi_d = -v96;
    at.qd[5] = coupler_phi_d + 0.0;
    at.qd[7] = rocker_y_d + 0.0;
    at.qd[6] = rocker_x_d + 0.0;
    at.qd[8] = rocker_phi_d + 0.0;
    let v100 = v66 * rocker_phi_d;
    let v101 = rocker_phi_d * v100;
    let v102 = 1.5 * v101;
    let v103 = v76 * v96;
    let v104 = v96 * v103;
    let v105 = -3.5 * v104 + v102;
    let v106 = v16 - v105;
    let v107 = v64 * rocker_phi_d;
    let v108 = rocker_phi_d * v107;
    let v109 = 1.5 * v108;
    let v110 = v74 * v96;
    let v111 = v96 * v110;
    let v112 = -3.5 * v111 + v109;
    let v113 = v28 - v112;
    let v114 = v113 - v109;
    let v115 = v106 - v102;
    let v116 = v77 * v115;
    let v117 = v116 - v84 * v114;
    let rocker_phi_dd = v117 * v89;
    let v119 = v86 * v114;
    let v120 = v119 - v85 * v115;
    let coupler_phi_dd = v120 * v89;
    let v122 = v102 - v69 * rocker_phi_dd;
    let v123 = v109 - v70 * rocker_phi_dd;
    at.qdd[5] = coupler_phi_dd + 0.0;
    let rocker_y_dd = -v123;
    at.qdd[7] = rocker_y_dd + 0.0;
    let rocker_x_dd = -v122;
    at.qdd[6] = rocker_x_dd + 0.0;
    at.qdd[8] = rocker_phi_dd + 0.0;
    let v126 = v66 * rocker_phi_dd - v108;
    let v127 = v100 * rocker_phi_dd;
    let v128 = rocker_phi_d * v126 + v127;
    let v129 = v127 + v128;
    let v130 = 1.5 * v129;
    let v131 = v76 * coupler_phi_dd - v111;
    let v132 = v103 * coupler_phi_dd;
    let v133 = v96 * v131 + v132;
    let v134 = v132 + v133;
    let v135 = v130 - -3.5 * v134;
    let v136 = v25 - v135;
    let v137 = v64 * rocker_phi_dd + v101;
    let v138 = v107 * rocker_phi_dd;
    let v139 = rocker_phi_d * v137 + v138;
    let v140 = v138 + v139;
    let v141 = 1.5 * v140;
    let v142 = v74 * coupler_phi_dd + v104;
    let v143 = v110 * coupler_phi_dd;
    let v144 = v96 * v142 + v143;
    let v145 = v143 + v144;
    let v146 = v141 - -3.5 * v145;
    let v147 = v35 - v146;
    let v148 = v147 - v141;
    let v149 = v136 - v130;
    let v150 = v86 * v148;
    let v151 = v150 - v85 * v149;
    let v152 = v151 * v89;
    at.measures.values[0] = v78 + 0.0;
    let v153 = -3.5 * v110 + v11;
    let v154 = -v153;
    at.measures.rates[0] = v154 + 0.0;
    let v155 = -3.5 * v142 - v16;
    at.measures.accelerations[0] = v155 + 0.0;
    at.measures.values[1] = v155 + 0.0;
    let v156 = v74 * v152 - v132;
    let v157 = v156 - v133;
    let v158 = -3.5 * v157 - v25;
    at.measures.rates[1] = v158 + 0.0;
    let v159 = 2.0 * t;
    let (s160, c160) = sin_cos(v159);
    let v161 = 1.5 * s160 + 0.5235987755982988;
    at.measures.values[2] = v161 + 0.0;
    let v162 = 3.0 * c160;
    at.measures.rates[2] = v162 + 0.0;
    let v163 = -6.0 * s160;
    at.measures.accelerations[1] = v163 + 0.0;
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
    type Watched = [bool; 0];
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
    const HAS_JERK: bool = true;

    fn blocks() -> &'static Blocks<'static> {
        &EQUATIONS
    }

    fn turning() -> &'static [usize] {
        &TURNING
    }

    fn cells() -> &'static Q {
        &CELLS
    }

    fn jerk(&self, [q, qd, qdd]: [&Q; 3], t: f64, _sides: &Sides) -> Q {
        jerk(q, qd, qdd, t, &self.params)
    }

    fn rights(&self, _q: &Q, _t: f64, _sides: &Sides) -> [Q; 0] {
        []
    }

    fn measured(
        &self,
        [q, qd, qdd, qddd]: [&Q; 4],
        _varied: &[f64; 0],
        _multipliers: &Q,
        t: f64,
    ) -> Measures {
        measures(q, qd, qdd, qddd, t, &self.params)
    }
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
    type Lead = Leading<following::Model, SIGNALS>;
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

/// What is given of an input, in SI: its value, and how that changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Signal {
    /// The value.
    pub value: f64,
    /// Its first time derivative.
    pub rate: f64,
    /// Its second time derivative.
    pub acceleration: f64,
}

/// Number of inputs.
pub const INPUTS: usize = 1;

/// Number of signals: time is one where formulas hold it beside inputs.
const SIGNALS: usize = 1;

/// Where each input stands in what [`influence`] gives.
pub mod input {
    /// `turn` (a pure number)
    pub const TURN: usize = 0;
}

/// What comes from outside.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inputs {
    /// `turn` (a pure number)
    pub turn: Signal,
}

impl Inputs {
    /// What the text's formulas say at a time (s).
    #[must_use]
    pub fn at(t: f64, params: &Params) -> Self {
        use runtime::way::Led;

        Self::of(&following::Model::by_text(params, t))
    }

    #[rustfmt::skip]
    fn of([values, rates, accelerations]: &[[f64; SIGNALS]; 3]) -> Self {
        Self {
            turn: Signal { value: values[0], rate: rates[0], acceleration: accelerations[0] },
        }
    }

    /// Values, rates and accelerations.
    #[rustfmt::skip]
    fn signals(&self) -> [[f64; SIGNALS]; 3] {
        let all = [self.turn];
        [all.map(|of| of.value), all.map(|of| of.rate), all.map(|of| of.acceleration)]
    }
}

impl runtime::follow::Follows<following::Model, SIGNALS> for Model {
    const HAS_TIME: bool = false;
}

pub use runtime::limits::MOST_STEPS_TO_FOLLOW;

/// Evaluations that [`follow`] takes at most.
#[rustfmt::skip]
pub const MOST_WORK_TO_FOLLOW: usize = runtime::follow::most_work::<following::Model, SIGNALS>(MOST_STEPS_TO_FOLLOW);

/// Leads a state from its inputs to others, along the straight line between them, in as many steps
/// as the branch asks for; their rates and accelerations there decide velocities and accelerations.
///
/// It takes [`MOST_STEPS_TO_FOLLOW`] steps at most, and mostly one: [`MOST_WORK_TO_FOLLOW`]
/// evaluations, whatever it is given. A kink of a formula on the way is passed. What a measure makes
/// of more than the accelerations of inputs has no value. [`step`] goes on by the text's formulas: it
/// first leads back to what these say of the inputs at the state's time.
///
/// # Errors
/// Why it cannot get there; the state is then bit for bit as it was. [`Error::TooFar`] is told at
/// once of an input that changes by more than `State::largest_change`.
pub fn follow(inputs: &Inputs, state: &mut State) -> Result<(), Error> {
    counted::follow(inputs, state, &mut Work::default())
}

/// As [`follow`], in so many steps at most, for those who have a deadline: [`most_work`] says how
/// many evaluations that are. A step that has to be made shorter counts as well. What these steps do
/// not reach is on its way: the same call goes on from there, and inputs, coordinates and measures of
/// the state are those of the place that it has come to.
///
/// # Errors
/// Why it cannot get there; the state is then bit for bit as it was.
pub fn follow_within(inputs: &Inputs, state: &mut State, most: usize) -> Result<Progress, Error> {
    counted::follow_within(inputs, state, most, &mut Work::default())
}

impl State {
    /// By input: the largest change that a call takes, by the numbers in [`input`]. One that asks for
    /// more is refused at once, as a value that an encoder never had. At first half a turn of an angle,
    /// and of a length twice the largest body; infinite where an input is neither.
    #[must_use]
    pub fn largest_change(&self) -> [f64; INPUTS] {
        let all = runtime::follow::largest_change(self);
        *all
    }

    /// Sets it; a state keeps that, and its clones do.
    pub fn set_largest_change(&mut self, largest: [f64; INPUTS]) {
        let all = runtime::follow::largest_change_mut(self);
        *all = largest;
    }
}

/// The derivatives of the coordinates by each input, by the numbers in [`input`]: for a constant
/// shift of it, along the branch that the state is on.
///
/// # Errors
/// The equations cannot be solved with the inputs as signals.
pub fn influence(state: &State) -> Result<[Q; INPUTS], Error> {
    runtime::follow::influence(state)
}

/// What follows inputs: along a way from 0 to 1, on which `t` is a place.
#[rustfmt::skip]
mod following {
    use super::*;

    use super::runtime::blocks::Blocks;
    use super::runtime::blocks::work_of;
    use super::runtime::equations::Branches;
    use super::runtime::equations::Checks;
    use super::runtime::equations::Equations;
    use super::runtime::error::Fault;
    use super::runtime::grid::on_grid;
    use super::runtime::limits::ITERATIONS;
    use super::runtime::newton::Newton;
    use super::runtime::pivoting::Pivoting;
    use super::runtime::pivoting::solve_with_pivoting;
    use super::runtime::sine_and_cosine::sin_cos;
    use super::runtime::solution::Solved;
    use super::runtime::way::Led;
    use super::runtime::way::Signals;
    use super::runtime::way::Slopes;

    /// Value, rate and acceleration of each signal by the text's formulas.
    ///
    /// 6 operations.
    fn by_text(t: f64, _p: &Params) -> [f64; 3 * SIGNALS] {
        let mut out = [0.0; 3 * SIGNALS];
        let v1 = 2.0 * t;
        let (s2, c2) = sin_cos(v1);
        let v3 = 1.5 * s2;
        let v4 = 0.5235987755982988 + v3;
        let v5 = 3.0 * c2;
        let v6 = -6.0 * s2;

        out[0] = v4;
        out[1] = v5;
        out[2] = v6;
        out
    }

    /// A way of the signals.
    type Way = super::runtime::way::Way<Params, SIGNALS>;

    const ENTRIES: usize = 21;

    /// Row and column of each value that `phi_q` gives.
    #[rustfmt::skip]
    static PHI_Q_PATTERN: [(usize, usize); ENTRIES] = [
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

    /// Number of values that follow from the parameters alone.
    const KNOWN: usize = 1;

    /// What follows from the parameters alone.
    ///
    /// 1 operations.
    fn known(_p: &Way) -> [f64; KNOWN] {
        let mut out = [0.0; KNOWN];
        let v1 = 1.0 / 0.0;

        out[0] = v1;
        out
    }

    /// The mechanism with its way, and what follows from these alone.
    #[derive(Clone, Copy, Debug)]
    pub struct Model {
        way: Way,
        known: [f64; KNOWN],
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
    type Solution = super::runtime::solution::Solution<Model>;

    /// Position, velocity and acceleration at a time. Newton begins with a guess of `rocker.phi`,
    /// `coupler.phi`; all else follows.
    ///
    /// 120 operations.
    fn solve(guess: &[f64; TEARS], t: f64, m: &Model, at: &mut Solution) {
        at.begin(t);
        at.q[2] = m.way.value(0, t) + 0.0;
        at.qd[2] = m.way.rates[0] + 0.0;
        let crank_phi_dd = m.way.accelerations[0];
        at.qdd[2] = crank_phi_dd + 0.0;
        at.along.by_signal[0][2] = 1.0;
        let v2 = m.way.params.crank_length;
        let (s3, c3) = sin_cos(m.way.value(0, t));
        let coupler_x = c3 * v2;
        at.q[3] = coupler_x + 0.0;
        let coupler_y = s3 * v2;
        let v6 = coupler_y * m.way.rates[0];
        let coupler_x_d = -v6;
        at.qd[3] = coupler_x_d + 0.0;
        let v8 = c3 * m.way.rates[0];
        let v9 = m.way.rates[0] * v8;
        let v10 = v2 * v9;
        let v11 = coupler_y * crank_phi_dd + v10;
        let coupler_x_dd = -v11;
        at.qdd[3] = coupler_x_dd + 0.0;
        let v13 = -coupler_y;
        at.along.by_signal[0][3] = v13 + 0.0;
        at.q[4] = coupler_y + 0.0;
        let coupler_y_d = coupler_x * m.way.rates[0];
        at.qd[4] = coupler_y_d + 0.0;
        let v15 = s3 * m.way.rates[0];
        let v16 = m.way.rates[0] * v15;
        let v17 = v2 * v16;
        let v18 = v17 - coupler_x * crank_phi_dd;
        let coupler_y_dd = -v18;
        at.qdd[4] = coupler_y_dd + 0.0;
        at.along.by_signal[0][4] = coupler_x + 0.0;
        let mut x1 = guess[0];
        let mut x2 = guess[1];
        let mut s20 = 0.0;
        let mut c20 = 0.0;
        let mut s24 = 0.0;
        let mut c24 = 0.0;
        let mut v42 = 0.0;
        let mut v45 = 0.0;
        x1 = on_grid(x1, 7.450580596923828e-9);
        x2 = on_grid(x2, 7.450580596923828e-9);
        let mut newton = Newton::new();
        for _ in 0..ITERATIONS {
            (s20, c20) = sin_cos(x1);
            let v21 = -1.5 * c20;
            let v22 = 4.0 - v21;
            let v23 = -1.5 * s20;
            (s24, c24) = sin_cos(x2);
            let v25 = -3.5 * s24;
            let v26 = 1.5 * s20;
            let v27 = 3.5 * c24;
            let v28 = 1.5 * c20;
            let v29 = v21 - v28;
            let v30 = v26 - v23;
            let v31 = v30 * v27;
            let v32 = v31 - v25 * v29;
            let v33 = 1.0 / v32;
            let v34 = v28 + v22;
            let v35 = v27 + coupler_x;
            let v36 = v35 - v34;
            let v37 = v26 - v23;
            let v38 = 3.5 * s24 + coupler_y;
            let v39 = v38 - v37;
            let v40 = v25 * v39;
            let v41 = v40 - v27 * v36;
            v42 = v41 * v33;
            let v43 = v29 * v36;
            let v44 = v43 - v30 * v39;
            v45 = v44 * v33;
            newton.see(v42, 7.450580596923828e-9, 1.0);
            newton.see(v45, 7.450580596923828e-9, 1.0);
            if newton.is_done() {
                break;
            }
            x1 = newton.next(x1, v42, 7.450580596923828e-9);
            x2 = newton.next(x2, v45, 7.450580596923828e-9);
        }
        at.note(&newton);
        x1 += v42;
        x2 += v45;
        let v46 = 0.5 * v42;
        let v47 = c20 - v46 * s20;
        let v48 = v42 * v47 + s20;
        let v49 = v46 * c20 + s20;
        let v50 = c20 - v42 * v49;
        let v51 = -1.5 * v50;
        let rocker_x = 4.0 - v51;
        let v53 = -1.5 * v48;
        let v54 = 1.5 * v50;
        let v55 = v54 + rocker_x;
        let v56 = 0.5 * v45;
        let v57 = c24 - v56 * s24;
        let v58 = v45 * v57 + s24;
        let v59 = v56 * c24 + s24;
        let v60 = c24 - v45 * v59;
        let v61 = 3.5 * v60;
        let v62 = v61 + coupler_x;
        let v63 = v62 - v55;
        at.holds &= v63.abs() <= 5.422657519137743e-12;
        let v64 = 1.5 * v48;
        let v65 = v64 - v53;
        let v66 = 3.5 * v58 + coupler_y;
        let v67 = v66 - v65;
        at.holds &= v67.abs() <= 5.2632680380054434e-12;
        let v68 = -3.5 * v58;
        let v69 = v51 - v54;
        let v70 = v64 - v53;
        let v71 = v70 * v61;
        let v72 = v71 - v68 * v69;
        let v73 = 1.0 / v72;
        at.q[5] = x2 + 0.0;
        let rocker_y = -v53;
        at.q[7] = rocker_y + 0.0;
        at.q[6] = rocker_x + 0.0;
        at.q[8] = x1 + 0.0;
        at.pivot(0, v73, 28.487789677465305);
        let v75 = v61 * v6;
        let v76 = v68 * coupler_y_d + v75;
        let rocker_phi_d = v76 * v73;
        let v78 = v70 * coupler_y_d;
        let v79 = v69 * v6 + v78;
        let v80 = v79 * v73;
        let rocker_x_d = v53 * rocker_phi_d;
        let rocker_y_d = v54 * rocker_phi_d;
        let coupler_phi_d = -v80;
        at.qd[5] = coupler_phi_d + 0.0;
        at.qd[7] = rocker_y_d + 0.0;
        at.qd[6] = rocker_x_d + 0.0;
        at.qd[8] = rocker_phi_d + 0.0;
        let v84 = v50 * rocker_phi_d;
        let v85 = rocker_phi_d * v84;
        let v86 = 1.5 * v85;
        let v87 = v60 * v80;
        let v88 = v80 * v87;
        let v89 = -3.5 * v88 + v86;
        let v90 = v11 - v89;
        let v91 = v48 * rocker_phi_d;
        let v92 = rocker_phi_d * v91;
        let v93 = 1.5 * v92;
        let v94 = v58 * v80;
        let v95 = v80 * v94;
        let v96 = -3.5 * v95 + v93;
        let v97 = v18 - v96;
        let v98 = v97 - v93;
        let v99 = v90 - v86;
        let v100 = v61 * v99;
        let v101 = v100 - v68 * v98;
        let rocker_phi_dd = v101 * v73;
        let v103 = v70 * v98;
        let v104 = v103 - v69 * v99;
        let coupler_phi_dd = v104 * v73;
        let v106 = v86 - v53 * rocker_phi_dd;
        let v107 = v93 - v54 * rocker_phi_dd;
        at.qdd[5] = coupler_phi_dd + 0.0;
        let rocker_y_dd = -v107;
        at.qdd[7] = rocker_y_dd + 0.0;
        let rocker_x_dd = -v106;
        at.qdd[6] = rocker_x_dd + 0.0;
        at.qdd[8] = rocker_phi_dd + 0.0;
        let v110 = v61 * coupler_y;
        let v111 = v68 * coupler_x + v110;
        let v112 = v111 * v73;
        let v113 = v70 * coupler_x;
        let v114 = v69 * coupler_y + v113;
        let v115 = v114 * v73;
        let v116 = v53 * v112;
        let v117 = v54 * v112;
        let v118 = -v115;
        at.along.by_signal[0][5] = v118 + 0.0;
        at.along.by_signal[0][7] = v117 + 0.0;
        at.along.by_signal[0][6] = v116 + 0.0;
        at.along.by_signal[0][8] = v112 + 0.0;
        at.measures.values[0] = v62 + 0.0;
        let v119 = -3.5 * v94 + v6;
        let v120 = -v119;
        at.measures.rates[0] = v120 + 0.0;
        let v121 = v58 * coupler_phi_dd + v88;
        let v122 = -3.5 * v121 - v11;
        at.measures.accelerations[0] = v122 + 0.0;
        at.measures.values[1] = v122 + 0.0;
        at.measures.rates[1] = m.known[0] + 0.0;
        at.measures.values[2] = m.way.value(0, t) + 0.0;
        at.measures.rates[2] = m.way.rates[0] + 0.0;
        let v123 = m.way.accelerations[0];
        at.measures.accelerations[1] = v123 + 0.0;
    }

    /// As [`super::phi`], with the signals of a way.
    ///
    /// 28 operations.
    fn phi(q: &[f64; N], t: f64, p: &Way) -> [f64; N] {
        let mut out = [0.0; N];
        let coupler_phi = q[5];
        let coupler_x = q[3];
        let coupler_y = q[4];
        let crank_phi = q[2];
        let crank_x = q[0];
        let crank_y = q[1];
        let crank_length = p.params.crank_length;
        let rocker_phi = q[8];
        let rocker_x = q[6];
        let rocker_y = q[7];
        let turn = p.value(0, t);

        let (s1, c1) = sin_cos(coupler_phi);
        let v2 = 3.5 * c1;
        let v3 = 3.5 * s1;
        let v4 = v2 + coupler_x;
        let v5 = v3 + coupler_y;
        let (s6, c6) = sin_cos(crank_phi);
        let v7 = -crank_x;
        let v8 = -crank_y;
        let v9 = c6 * crank_length;
        let v10 = s6 * crank_length;
        let v11 = crank_x + v9;
        let v12 = crank_y + v10;
        let v13 = v11 - coupler_x;
        let v14 = v12 - coupler_y;
        let (s15, c15) = sin_cos(rocker_phi);
        let v16 = 1.5 * c15;
        let v17 = 1.5 * s15;
        let v18 = v16 + rocker_x;
        let v19 = v17 + rocker_y;
        let v20 = v4 - v18;
        let v21 = v5 - v19;
        let v22 = -1.5 * c15;
        let v23 = -1.5 * s15;
        let v24 = rocker_x + v22;
        let v25 = rocker_y + v23;
        let v26 = 4.0 - v24;
        let v27 = -v25;
        let v28 = crank_phi - turn;

        out[0] = v7;
        out[1] = v8;
        out[2] = v13;
        out[3] = v14;
        out[4] = v20;
        out[5] = v21;
        out[6] = v26;
        out[7] = v27;
        out[8] = v28;
        out
    }

    /// As [`super::phi_q`], with the signals of a way.
    ///
    /// 12 operations.
    fn phi_q(q: &[f64; N], _t: f64, p: &Way) -> [f64; ENTRIES] {
        let mut out = [0.0; ENTRIES];
        let coupler_phi = q[5];
        let crank_phi = q[2];
        let crank_length = p.params.crank_length;
        let rocker_phi = q[8];

        let (s1, c1) = sin_cos(coupler_phi);
        let v2 = 3.5 * c1;
        let (s3, c3) = sin_cos(crank_phi);
        let v4 = c3 * crank_length;
        let v5 = s3 * crank_length;
        let (s6, c6) = sin_cos(rocker_phi);
        let v7 = 1.5 * c6;
        let v8 = 1.5 * s6;
        let v9 = -1.5 * c6;
        let v10 = -1.5 * s6;
        let v11 = -v5;
        let v12 = -3.5 * s1;

        out[0] = -1.0;
        out[1] = -1.0;
        out[2] = 1.0;
        out[3] = v11;
        out[4] = -1.0;
        out[5] = 1.0;
        out[6] = v4;
        out[7] = -1.0;
        out[8] = 1.0;
        out[9] = v12;
        out[10] = -1.0;
        out[11] = v8;
        out[12] = 1.0;
        out[13] = v2;
        out[14] = -1.0;
        out[15] = v9;
        out[16] = -1.0;
        out[17] = v10;
        out[18] = -1.0;
        out[19] = v7;
        out[20] = 1.0;
        out
    }

    /// As [`super::nu`], with the signals of a way.
    ///
    /// 0 operations.
    fn nu(_q: &[f64; N], _t: f64, p: &Way) -> [f64; N] {
        let mut out = [0.0; N];
        let turn_d = p.rates[0];

        out[8] = turn_d;
        out
    }

    /// As [`super::gamma`], with the signals of a way.
    ///
    /// 25 operations.
    fn gamma(q: &[f64; N], qd: &[f64; N], _t: f64, p: &Way) -> [f64; N] {
        let mut out = [0.0; N];
        let coupler_phi = q[5];
        let crank_phi = q[2];
        let rocker_phi = q[8];
        let coupler_phi_d = qd[5];
        let crank_phi_d = qd[2];
        let rocker_phi_d = qd[8];
        let crank_length = p.params.crank_length;
        let turn_dd = p.accelerations[0];

        let (s1, c1) = sin_cos(coupler_phi);
        let (s2, c2) = sin_cos(crank_phi);
        let (s3, c3) = sin_cos(rocker_phi);
        let v4 = s1 * coupler_phi_d;
        let v5 = c1 * coupler_phi_d;
        let v6 = coupler_phi_d * v5;
        let v7 = coupler_phi_d * v4;
        let v8 = s2 * crank_phi_d;
        let v9 = c2 * crank_phi_d;
        let v10 = s3 * rocker_phi_d;
        let v11 = c3 * rocker_phi_d;
        let v12 = -3.5 * v6;
        let v13 = -3.5 * v7;
        let v14 = crank_phi_d * v9;
        let v15 = crank_phi_d * v8;
        let v16 = crank_length * v14;
        let v17 = crank_length * v15;
        let v18 = rocker_phi_d * v11;
        let v19 = rocker_phi_d * v10;
        let v20 = 1.5 * v18;
        let v21 = v12 + v20;
        let v22 = 1.5 * v19;
        let v23 = v13 + v22;
        let v24 = -v21;
        let v25 = -v23;

        out[2] = v16;
        out[3] = v17;
        out[4] = v24;
        out[5] = v25;
        out[6] = v20;
        out[7] = v22;
        out[8] = turn_dd;
        out
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
            phi(q, t, &self.way)
        }

        fn phi_q(&self, q: &Q, t: f64, _sides: &Sides) -> Self::Entries {
            phi_q(q, t, &self.way)
        }

        fn nu(&self, q: &Q, t: f64, _sides: &Sides) -> Q {
            nu(q, t, &self.way)
        }

        fn gamma(&self, q: &Q, qd: &Qd, t: f64, _sides: &Sides) -> Qdd {
            gamma(q, qd, t, &self.way)
        }
    }

    impl Branches for Model {}

    impl Checks for Model {
        type Watched = [bool; 0];
    }

    impl Solved for Model {
        type Tears = [f64; TEARS];
        type Turns = [bool; TURNS];
        type Measures = Measures;
        type Joined = [f64; 0];
        type Along = Slopes<Q, SIGNALS>;

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

    /// The measures with their time derivatives, from the coordinates, their velocities and
    /// accelerations.
    fn measures(q: &Q, qd: &Qd, qdd: &Qdd, t: f64, p: &Way) -> Measures {
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
    /// 13 operations.
    fn all_measures(q: &[f64; N], qd: &[f64; N], qdd: &[f64; N], t: f64, p: &Way) -> [f64; 8] {
        let mut out = [0.0; 8];
        let coupler_phi = q[5];
        let coupler_x = q[3];
        let coupler_phi_d = qd[5];
        let coupler_phi_dd = qdd[5];
        let coupler_x_dd = qdd[3];
        let coupler_x_d = qd[3];
        let turn = p.value(0, t);
        let turn_d = p.rates[0];
        let turn_dd = p.accelerations[0];

        let v1 = 1.0 / 0.0;
        let (s2, c2) = sin_cos(coupler_phi);
        let v3 = 3.5 * c2;
        let v4 = v3 + coupler_x;
        let v5 = s2 * coupler_phi_d;
        let v6 = c2 * coupler_phi_d;
        let v7 = coupler_phi_d * v6;
        let v8 = s2 * coupler_phi_dd;
        let v9 = v7 + v8;
        let v10 = -3.5 * v9;
        let v11 = v10 + coupler_x_dd;
        let v12 = -3.5 * v5;
        let v13 = v12 + coupler_x_d;

        out[0] = v4;
        out[1] = v11;
        out[2] = turn;
        out[3] = v13;
        out[4] = v1;
        out[5] = turn_d;
        out[6] = v11;
        out[7] = turn_dd;
        out
    }

    /// The right sides of the equations for the derivatives of the coordinates by each signal.
    fn rights_by_signal(q: &Q, t: f64, p: &Way) -> [Q; SIGNALS] {
        let mut all = all_rights_by_signal(q, t, p).into_iter();
        let mut next = || all.next().unwrap_or(f64::NAN);
        core::array::from_fn(|_| core::array::from_fn(|_| next()))
    }

    /// The partial derivatives of the equations by each signal, negated, one behind the other.
    ///
    /// 0 operations.
    fn all_rights_by_signal(_q: &[f64; N], _t: f64, _p: &Way) -> [f64; N * SIGNALS] {
        let mut out = [0.0; N * SIGNALS];
        out[8] = 1.0;
        out
    }

    impl Pivoting for Model {
        type Work = [f64; WORK];
        type Blocks = [bool; BLOCKS];
        type Varied = [f64; 0];
        type Rights = [Q; SIGNALS];

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

        fn rights(&self, q: &Q, t: f64, _sides: &Sides) -> [Q; SIGNALS] {
            rights_by_signal(q, t, &self.way)
        }

        fn measured(
            &self,
            [q, qd, qdd, _]: [&Q; 4],
            _varied: &[f64; 0],
            _multipliers: &Q,
            t: f64,
        ) -> Measures {
            measures(q, qd, qdd, t, &self.way)
        }
    }

    impl Led<SIGNALS> for Model {
        type Params = Params;

        const LARGEST_CHANGE: [f64; SIGNALS] = [3.141592653589793];

        fn new(way: &Way) -> Self {
            Self {
                way: *way,
                known: known(way),
            }
        }

        fn way(&self) -> &Way {
            &self.way
        }

        fn way_mut(&mut self) -> &mut Way {
            &mut self.way
        }

        fn by_text(params: &Params, t: f64) -> Signals<SIGNALS> {
            let all = by_text(t, params);
            let get = |k: usize| all.get(k).copied().unwrap_or(f64::NAN);
            core::array::from_fn(|order| core::array::from_fn(|k| get(3 * k + order)))
        }
    }
}

/// What solves the equations and follows the motion, the same for all mechanisms.
#[rustfmt::skip]
mod runtime {
pub mod numbers {
//! Numbers by place, and how large they are.

use core::fmt::Debug;

/// So many numbers.
pub trait Numbers: Copy + Debug + 'static + AsRef<[f64]> + AsMut<[f64]> {
    /// All of them 0.
    const ZERO: Self;
}

impl<const K: usize> Numbers for [f64; K] {
    const ZERO: Self = [0.0; K];
}

/// So many answers.
pub trait Flags: Copy + Debug + PartialEq + 'static + AsRef<[bool]> + AsMut<[bool]> {
    /// All of them no.
    const NONE: Self;
}

impl<const K: usize> Flags for [bool; K] {
    const NONE: Self = [false; K];
}

/// The largest value beside its scale; not a number if one is not.
pub fn largest<N: Numbers>(values: &N, scales: &N) -> f64 {
    let pairs = values.as_ref().iter().zip(scales.as_ref());
    let sizes = pairs.map(|(value, scale)| value.abs() / scale);
    sizes.fold(0.0, larger)
}

/// The larger one; not a number if one is not.
pub fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Adds a zero for each value, which one that is not finite turns into no number: all are looked at without a branch for each.
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

/// What leads from some numbers to others.
pub fn difference<N: Numbers>(to: &N, from: &N) -> N {
    let mut way = *to;
    way.as_mut().iter_mut().zip(from.as_ref()).for_each(|(way, from)| *way -= from);
    way
}

/// Coordinates after a time `h` (s), by their velocities and accelerations now.
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
//! Why something cannot be done.

/// Why a mechanism could not be brought to a time.
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

/// Why a step is refused.
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
    /// Why a mechanism cannot be assembled.
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
//! What is asked of a mechanism with its parameters: its equations, their branches, and what must hold beside them.

use super::numbers::{Flags, Numbers};
use core::fmt::Debug;

/// The equations `phi = 0` and what follows from them.
pub trait Equations: Copy + Debug {
    /// A number for each coordinate, and for each equation.
    type Q: Numbers;
    /// One for each entry of `phi_q` that does not vanish.
    type Entries: Numbers;
    /// Which branch formulas take, by place: what a comparison gives, the number of a piece.
    type Sides: Numbers + PartialEq;

    /// Row and column of each entry of `phi_q`.
    fn pattern() -> &'static [(usize, usize)];

    /// What a change of each coordinate is judged against.
    fn scales() -> &'static Self::Q;

    /// What is left of the equations.
    fn phi(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;

    /// The entries of their Jacobian.
    fn phi_q(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Entries;

    /// The right side of the velocity equation.
    fn nu(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;

    /// The right side of the acceleration equation.
    fn gamma(&self, q: &Self::Q, qd: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Q;
}

/// What decides the branches of formulas. Where formulas have none, all of this is nothing.
pub trait Branches: Equations {
    /// Whether time alone decides some.
    const OF_TIME: bool = false;

    /// Whether the motion decides some.
    const OF_MOTION: bool = false;

    /// The last time of the file's analysis (s), at which formulas of time take their earlier branches.
    const END: Option<f64> = None;

    /// Which of them time alone decides.
    fn is_of_time() -> &'static [bool] {
        &[]
    }

    /// The branches that time alone decides, the others as 0.
    fn sides_of_time(&self, _t: f64) -> Self::Sides {
        Self::Sides::ZERO
    }

    /// The branches at a position, those of time being known.
    fn sides_of_motion(&self, _q: &Self::Q, _t: f64, sides: &Self::Sides) -> Self::Sides {
        *sides
    }
}

/// What must hold beside the equations; of most mechanisms nothing.
pub trait Checks: Equations {
    /// Which quantities that keep their signs along a branch are positive.
    type Watched: Flags;

    /// Whether equations were left out as redundant.
    const LEAVES_OUT: bool = false;

    /// Whether distances are positive, and places within their intervals and tables.
    fn conditions_hold(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> bool {
        true
    }

    /// Whether the equations that were left out hold.
    fn left_out_holds(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> bool {
        true
    }

    /// What keeps its sign along a branch of the motion.
    fn watched(&self, _q: &Self::Q, _t: f64, _sides: &Self::Sides) -> Self::Watched {
        Self::Watched::NONE
    }
}
}

pub mod measured {
//! What is measured.

use core::fmt::Debug;

/// Measures with their first and second time derivatives.
pub trait Measured: Copy + Debug {
    /// Nothing is measured yet.
    const ZERO: Self;

    /// Which of them, in the order of [`lists`](Measured::lists), are derivatives by inputs or parameters, or forces.
    const IS_VARIED: &'static [bool] = &[];

    /// Values, rates and accelerations.
    fn lists(&self) -> [&[f64]; 3];

    /// The same, to be written.
    fn lists_mut(&mut self) -> [&mut [f64]; 3];

    /// What is not finite is no number.
    fn leave_out(&mut self) {
        for list in self.lists_mut() {
            for value in list.iter_mut().filter(|value| !value.is_finite()) {
                *value = f64::NAN;
            }
        }
    }

    /// Close to a singular position derivatives by inputs and parameters, and forces, have no value.
    fn leave_varied_out(&mut self) {
        let mut rest = Self::IS_VARIED.iter();
        for list in self.lists_mut() {
            for (value, _) in list.iter_mut().zip(&mut rest).filter(|(_, is_varied)| **is_varied) {
                *value = f64::NAN;
            }
        }
    }
}

/// Where nothing is measured.
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
//! How much work a call does, and how far it comes.

use super::equations::Branches;
use super::limits::{MOST_BRANCHES, MOST_HALVINGS};

/// Evaluations that a call has done. One is a solution of the equations at a place, with all that is checked there: by the operations
/// that were written for that, or by elimination with partial pivoting where these lose digits. A look at formulas of time that decide a
/// branch, or at whether they end, is one too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// How many there were.
    pub evaluations: usize,
}

impl Work {
    /// Counts some more.
    pub fn add(&mut self, evaluations: usize) {
        self.evaluations = self.evaluations.wrapping_add(evaluations);
    }
}

/// How far a call has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The part of the way that is done: 1 at its end, and only there; 0 if the state has not moved along it yet.
    pub fraction: f64,
}

impl Progress {
    /// The end is reached.
    pub const REACHED: Self = Self { fraction: 1.0 };

    /// A part of the way, which is not all of it.
    pub fn part(done: f64, all: f64) -> Self {
        Self { fraction: f64::min(done / all, 1.0 - f64::EPSILON) }
    }

    /// Whether the end is reached; if not, the same call goes on from here.
    #[must_use]
    pub fn is_reached(self) -> bool {
        self.fraction >= 1.0
    }
}

/// Evaluations that a solution takes at most whose branches of formulas are known: by the operations, by pivoting, and by the operations
/// once more.
pub const OF_FINDING: usize = 3;

/// Evaluations that the branches of formulas of time take.
pub const fn of_sides<M: Branches>() -> usize {
    if M::OF_TIME { 1 } else { 0 }
}

/// Evaluations that a solution takes at most.
pub const fn of_reaching<M: Branches>() -> usize {
    let branches = if M::OF_MOTION { MOST_BRANCHES } else { 1 };
    of_sides::<M>() + branches * OF_FINDING
}

/// Evaluations that the search for the first edge of a step takes at most.
pub const fn of_edge<M: Branches>() -> usize {
    (2 + MOST_HALVINGS) * of_sides::<M>()
}

/// Evaluations that one step takes at most, from the search for its end to the look at both sides of an edge.
pub const fn of_step<M: Branches>() -> usize {
    let rounding = 1;
    of_edge::<M>() + of_reaching::<M>() + rounding + OF_FINDING * of_sides::<M>()
}
}

pub mod solution {
//! What solves the equations at a time, and what that is found by.

use super::equations::{Branches, Checks};
use super::error::Fault;
use super::measured::Measured;
use super::numbers::{Flags, Numbers, add_zeros};
use core::fmt::Debug;

/// Equations with the operations that solve them.
pub trait Solved: Branches + Checks {
    /// A number for each coordinate that Newton solves for; the others follow.
    type Tears: Numbers;
    /// An answer for each block of equations whose determinant changes with the position.
    type Turns: Flags;
    /// What is measured.
    type Measures: Measured;
    /// Values that only measures need.
    type Joined: Numbers;
    /// What the motion goes along: time, or signals.
    type Along: Along<Self>;

    /// What a change of each coordinate that Newton solves for is judged against.
    fn tear_scales() -> &'static Self::Tears;

    /// Whether determinants are negative where all pivots are positive.
    fn turned() -> &'static Self::Turns;

    /// Of all coordinates those that Newton solves for.
    fn tears(q: &Self::Q) -> Self::Tears;

    /// Position, velocity and acceleration at a time.
    fn solve(&self, guess: &Self::Tears, t: f64, sides: &Self::Sides, at: &mut Solution<Self>);

    /// The same by elimination with partial pivoting from a position nearby, where [`solve`](Solved::solve) has failed with `at`;
    /// a fault where blocks are too large for that.
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

/// What a motion goes along, with what a solution holds of that.
pub trait Along<M: Solved>: Copy + Debug {
    /// Nothing is known yet.
    const ZERO: Self;

    /// Coordinates at a distance `h` from a solution.
    fn predicted(m: &M, from: &Solution<M>, h: f64) -> M::Q;

    /// A place a little ahead, at which the branches of formulas tell those on which the motion goes on.
    fn ahead(m: &M, at: &Solution<M>) -> (M::Q, f64);

    /// Takes down what a solution has been found for.
    fn note(&mut self, _m: &M, _t: f64) {}

    /// The derivatives of the coordinates, by what the motion goes along.
    fn slopes(&self) -> &[M::Q] {
        &[]
    }

    /// The same, to be written.
    #[allow(dead_code)] // what is neither pivoted nor listed knows them by their names
    fn slopes_mut(&mut self) -> &mut [M::Q] {
        &mut []
    }
}

/// What solves the equations at a time.
#[derive(Debug)]
pub struct Solution<M: Solved> {
    /// The time (s), or the place on a way.
    pub t: f64,
    /// Coordinates.
    pub q: M::Q,
    /// Velocities.
    pub qd: M::Q,
    /// Accelerations.
    pub qdd: M::Q,
    /// Measures.
    pub measures: M::Measures,
    /// What only measures need.
    #[allow(dead_code)] // mostly they need nothing
    pub joined: M::Joined,
    /// What it holds of what the motion goes along.
    pub along: M::Along,
    /// The branches of formulas.
    pub sides: M::Sides,
    /// Which quantities that must keep their signs are positive.
    pub watched: M::Watched,
    /// By block of equations: whether its determinant is negative.
    pub is_negative: M::Turns,
    /// Whether Newton has arrived.
    pub is_settled: bool,
    /// Whether no digits were lost, and the equations hold.
    pub holds: bool,
    /// Newton's largest first correction, scaled.
    pub first: f64,
    /// One over the smallest pivot, scaled.
    pub steepest: f64,
}

impl<M: Solved> Clone for Solution<M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<M: Solved> Copy for Solution<M> {}

impl<M: Solved> Solution<M> {
    /// Nothing is solved yet.
    pub const ZERO: Self = Self {
        t: 0.0,
        q: M::Q::ZERO,
        qd: M::Q::ZERO,
        qdd: M::Q::ZERO,
        measures: M::Measures::ZERO,
        joined: M::Joined::ZERO,
        along: M::Along::ZERO,
        sides: M::Sides::ZERO,
        watched: M::Watched::NONE,
        is_negative: M::Turns::NONE,
        is_settled: true,
        holds: true,
        first: 0.0,
        steepest: 0.0,
    };

    /// Nothing but a position and its time.
    pub fn near(q: &M::Q, t: f64) -> Self {
        let mut near = Self::ZERO;
        (near.t, near.q) = (t, *q);
        near
    }

    /// Makes ready for being solved for.
    pub fn begin(&mut self, t: f64) {
        self.t = t;
        self.is_negative = *M::turned();
        (self.is_settled, self.holds) = (true, true);
        (self.first, self.steepest) = (0.0, 0.0);
    }

    /// Why it cannot be used.
    pub fn fault(&self) -> Fault {
        if self.is_finite() { Fault::TooFar } else { Fault::NotANumber }
    }

    /// Whether all of it is numbers; measures may be none.
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
//! Where something is on its way.

use super::solution::{Solution, Solved};

/// The solution of now, and the one before it or the next one in the making.
#[derive(Clone, Copy, Debug)]
pub struct Track<M: Solved> {
    pub(super) solutions: [Solution<M>; 2],
    /// Whether that of now is the second.
    pub(super) is_second: bool,
    /// Whether the one before lies on the same smooth motion.
    pub(super) is_smooth: bool,
    /// The step that goes well: a time (s), or a change of a signal.
    pub(super) stride: f64,
}

impl<M: Solved> Track<M> {
    /// The solution of now.
    #[inline]
    pub fn at(&self) -> &Solution<M> {
        let [first, second] = &self.solutions;
        if self.is_second { second } else { first }
    }

    /// The same, to be written.
    #[inline]
    pub fn at_mut(&mut self) -> &mut Solution<M> {
        let [first, second] = &mut self.solutions;
        if self.is_second { second } else { first }
    }

    /// The one before, or the next one in the making.
    #[inline]
    pub fn other(&self) -> &Solution<M> {
        let [first, second] = &self.solutions;
        if self.is_second { first } else { second }
    }

    /// Both: that of now, and the other one, to be written.
    #[inline]
    pub fn both(&mut self) -> (&Solution<M>, &mut Solution<M>) {
        let [first, second] = &mut self.solutions;
        if self.is_second { (second, first) } else { (first, second) }
    }
}

/// What a track was before a call, which an error gives back bit for bit.
pub struct Checkpoint<M: Solved> {
    /// The time or place of the solution of then.
    t: f64,
    is_second: bool,
    is_smooth: bool,
    stride: f64,
    other: Solution<M>,
    /// The solution of then, once a second step is about to write over it.
    now: Option<Solution<M>>,
}

impl<M: Solved> Checkpoint<M> {
    /// What a track is now.
    #[inline]
    pub fn of(track: &Track<M>) -> Self {
        let Track { is_second, is_smooth, stride, .. } = *track;
        Self { t: track.at().t, is_second, is_smooth, stride, other: *track.other(), now: None }
    }

    /// Keeps the solution of then, which stands beside that of now after the first step.
    #[inline]
    pub fn keep(&mut self, track: &Track<M>) {
        if self.now.is_none() {
            self.now = Some(*track.other());
        }
    }

    /// Gives back what was.
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

pub mod so_far {
//! What is the largest, found one by one.

/// What is the largest so far, in the loops that solve, which have time for one comparison: a value that is not a number wins, but only
/// until the next. What it comes from is not a number either, and is asked for that.
pub fn larger_so_far(largest: f64, value: f64) -> f64 {
    if value <= largest { largest } else { value }
}
}

pub mod pivots {
//! What pivots tell of a position.

use super::so_far::larger_so_far;
use super::solution::{Solution, Solved};

impl<M: Solved> Solution<M> {
    /// Takes note of one over a pivot, and of what makes that a pure number.
    pub fn pivot(&mut self, turn: usize, inverse: f64, weight: f64) {
        if let Some(is_negative) = self.is_negative.as_mut().get_mut(turn) {
            *is_negative ^= inverse < 0.0;
        }
        self.steepest = larger_so_far(self.steepest, inverse.abs() * weight);
    }
}
}

pub mod grid {
// The grid on which Newton's iteration goes from point to point.
//
// It goes to the point next to the solution, as often as that takes, and ends where all corrections stay in their cells: so where it began
// leaves no trace. Of a coordinate on the border of two cells, to rounding, either point may say that the other one is nearer, or that
// it is so itself. Therefore such a border is judged from one side alone. All coordinates whose corrections end next to a border
// go to the even one of the two points, the others stay; and from there each goes to where its correction leads, for good.

/// The grid point next to a value.
#[must_use]
#[inline]
pub fn on_grid(x: f64, cell: f64) -> f64 {
    // adding and taking away 1.5 * 2^52 cells rounds to a whole number of them
    let rounding = 6_755_399_441_055_744.0 * cell;
    (x + rounding) - rounding
}

/// The largest correction, in cells, with which an iteration ends that has met no border; one that is no farther from half a cell than
/// `border` leads to one.
#[must_use]
#[inline]
pub fn bound_at_first(border: f64) -> f64 {
    0.5 - border
}

/// How an iteration goes on whose largest correction, in cells, is beyond its bound: the bound that it has then; and the cells, in cells,
/// among whose points those coordinates go on that are next to a border.
#[must_use]
#[inline]
pub fn going_on(largest: f64, bound: f64, border: f64) -> (f64, f64) {
    let is_free = bound < 0.5;
    let is_at_border = is_free && largest <= 0.5 + border;
    // at the even points only what is beyond the border goes on; behind that nothing does that is no stray
    let next = if is_free { bound } else { 1.0 };
    (if is_at_border { 0.5 } else { next }, if is_at_border { 2.0 } else { 1.0 })
}

/// The grid point that a coordinate goes on to, from one and its correction there.
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

/// The coefficients of the third, fourth and fifth power of a curve in the part of its step, by what its parabola at the beginning
/// leaves at the end of value, slope and half the curvature, all by the part of the step.
#[must_use]
#[inline]
pub fn higher_terms([value, slope, bend]: [f64; 3]) -> [f64; 3] {
    let cubic = 10.0 * value - 4.0 * slope + bend;
    let quartic = -15.0 * value + 7.0 * slope - 2.0 * bend;
    let quintic = 6.0 * value - 3.0 * slope + bend;
    [cubic, quartic, quintic]
}

/// What the motion since a state that lies a time `back` before adds to the parabola of now, `u` times as long ahead as that is back. A
/// state is value, velocity and acceleration.
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
// Places that are neighbours, to the last bits.

/// Where something ceases to hold that holds at the first of two places and not at the second: two neighbouring doubles, or what
/// so many halvings leave of the interval.
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

/// A time on the later side of whatever is meant to happen at `t` (s), off by so many units in its last place.
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
use super::so_far::larger_so_far;
use super::solution::{Solution, Solved};

/// An iteration of Newton from grid point to grid point, so that where it begins leaves no trace in where it ends.
pub struct Newton {
    is_first: bool,
    is_lost: bool,
    has_settled: bool,
    first: f64,
    /// The largest correction, and with which one it ends, both in cells of the grid.
    largest: f64,
    bound: f64,
    /// The cells, in cells, among whose points coordinates next to a border go on.
    cells: f64,
}

impl Newton {
    /// It has not begun.
    pub fn new() -> Self {
        let bound = bound_at_first(BORDER);
        Self { is_first: true, is_lost: false, has_settled: false, first: 0.0, largest: 0.0, bound, cells: 1.0 }
    }

    /// The correction of a coordinate; its grid has cells so wide, and it is judged against `scale`.
    pub fn see(&mut self, delta: f64, cell: f64, scale: f64) {
        let size = delta.abs();
        if self.is_first {
            self.first = larger_so_far(self.first, size / scale);
        }
        self.largest = larger_so_far(self.largest, size / cell);
        self.is_lost |= size.is_nan() || size > LARGEST_CORRECTION * scale;
    }

    /// Whether no further iteration is needed, or none helps.
    pub fn is_done(&mut self) -> bool {
        self.has_settled = !self.is_lost && self.largest <= self.bound;
        let is_done = self.has_settled || self.is_lost;
        if !is_done {
            (self.bound, self.cells) = going_on(self.largest, self.bound, BORDER);
        }
        (self.is_first, self.largest) = (false, 0.0);
        is_done
    }

    /// The grid point that a coordinate goes on to.
    pub fn next(&self, x: f64, delta: f64, cell: f64) -> f64 {
        next_point(x, delta, cell, self.cells, BORDER)
    }
}

impl<M: Solved> Solution<M> {
    /// Takes over how an iteration went.
    pub fn note(&mut self, newton: &Newton) {
        self.is_settled &= newton.has_settled;
        self.first = larger(self.first, newton.first);
    }
}
}

pub mod branches {
//! The branches of formulas along the motion.

use super::equations::Branches;
use super::limits::{MOST_HALVINGS, SLACK};
use super::neighbours::{bisect, shortly_after};
use super::solution::{Along, Solution, Solved};
use super::work::{Work, of_sides};

/// The branches of formulas of time at a time: the later ones where they change just then, but at the end of the file's analysis
/// the earlier ones.
pub fn sides_at<M: Branches>(t: f64, m: &M, work: &mut Work) -> M::Sides {
    work.add(of_sides::<M>());
    match M::END {
        Some(end) if is_end::<M>(t) => m.sides_of_time(end - 2.0 * (shortly_after(end, SLACK) - end)),
        _ => m.sides_of_time(shortly_after(t, SLACK)),
    }
}

/// Whether a time is the end of the file's analysis.
fn is_end<M: Branches>(t: f64) -> bool {
    M::END.is_some_and(|end| t <= end && shortly_after(t, SLACK) >= end)
}

/// The first time of a step at which formulas of time take other branches than at its beginning; its end if they do not.
pub fn first_edge<M: Branches>(from: f64, to: f64, m: &M, work: &mut Work) -> f64 {
    let here = sides_at(from, m, work);
    if sides_at(to, m, work) == here {
        return to;
    }
    let [_, edge] = bisect([from, to], MOST_HALVINGS, |t| sides_at(t, m, work) == here);
    edge
}

/// The branches at a position that is next to one that is looked for.
pub fn sides_near<M: Branches>(q: &M::Q, t: f64, m: &M, work: &mut Work) -> M::Sides {
    m.sides_of_motion(q, t, &sides_at(t, m, work))
}

/// The branches with those of time exchanged.
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

/// The branches of formulas of the motion that lie ahead of a position; at the end of the file's analysis those that lie behind it.
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
//! Solving at a time, on the branches that are there.

use super::branches::{sides_ahead, sides_at, with_time};
use super::error::Fault;
use super::limits::{ACCURACY, MOST_BRANCHES, STEEP, STEEPEST};
use super::measured::Measured;
use super::numbers::{larger, largest};
use super::solution::{Along, Solution, Solved};
use super::work::Work;

/// Solves at a time, from a guess; `from` is where the motion comes from.
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

/// Solves with branches of formulas that are known.
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
    if !m.left_out_holds(&at.q, t, sides) {
        return Err(Fault::LeftOut);
    }
    at.watched = m.watched(&at.q, t, sides);
    at.sides = *sides;
    at.along.note(m, t);
    at.measures.leave_out();
    if at.is_finite() { Ok(()) } else { Err(Fault::NotANumber) }
}

/// Solves once more from a position that is known, and if that does not help either, takes that.
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

/// What rounding makes of the velocities and accelerations, for every unit of steepness: they are amplified by as much as the
/// position is near to a singular one.
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

/// Whether a position that is reached lies on the branch of the motion that it comes from, whose equations are so steep.
pub fn stays_on_branch<M: Solved>(
    from: &Solution<M>,
    at: &mut Solution<M>,
    m: &M,
    is_wanted: bool,
    steepness: f64,
    work: &mut Work,
) -> bool {
    let steepest = at.steepest / steepness;
    if at.watched != from.watched || at.is_negative != from.is_negative || steepest > STEEPEST {
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
//! A mechanism that moves with time, and where it is.

use super::error::Error;
use super::limits::{AHEAD, FARTHEST_AHEAD, LONGEST_AHEAD};
use super::measured::Measured;
use super::numbers::{Numbers, largest, predicted};
use super::solution::{Along, Solution, Solved};
use super::track::Track;
use super::work::Work;
use core::fmt::Debug;

/// What can be set of a mechanism.
pub trait Parameters: Copy + Debug + Default {
    /// Part of the way from these to others.
    #[must_use]
    fn towards(&self, other: &Self, part: f64) -> Self;

    /// Whether all are numbers.
    fn is_finite(&self) -> bool;
}

/// A mechanism whose motion goes along time.
pub trait Timed: Solved<Along = Time> {
    /// Its parameters.
    type Params: Parameters;
    /// What leads it by its inputs; `()` where it has none.
    type Lead: Lead<Self>;
    /// By rim, where formulas of time may end: the time at which it was looked at last (s).
    type Passed: Numbers;
    /// A number for each result.
    type Row: Numbers;

    /// The first time of the file's analysis (s), at which the mechanism is assembled.
    const START_TIME: f64;
    /// How long the file's analysis takes (s).
    const SPAN: f64;
    /// The longest step (s).
    const LONGEST_STEP: f64;
    /// The shortest step (s).
    const SMALLEST_STEP: f64;
    /// Evaluations that the rims of a step take at most.
    const WORK_OF_RIMS: usize = 0;

    /// The mechanism with some parameters.
    fn new(params: &Self::Params) -> Self;

    /// Its parameters.
    fn params(&self) -> &Self::Params;

    /// The assembled position with the file's parameters.
    fn start() -> &'static Self::Q;

    /// Where the file's poses put the coordinates with its parameters, roughly: what is not closed yet.
    fn drawn(&self) -> Self::Q;

    /// Solves at a place from far away; nothing where that does not arrive, or blocks are too large for it.
    fn closed(&self, _q: &Self::Q, _t: f64, _work: &mut Work) -> Option<Self::Q> {
        None
    }

    /// The first rim of a step that was not looked at yet, with its time.
    fn first_rim(&self, _from: f64, _to: f64, _passed: &Self::Passed, _work: &mut Work) -> Option<(usize, f64)> {
        None
    }

    /// Looks at both sides of a rim next to the state.
    fn look_at_rim(_state: &mut State<Self>, _rim: usize, _t: f64, _work: &mut Work) -> Result<(), Error> {
        Ok(())
    }
}

/// What leads a mechanism by its inputs.
pub trait Lead<M: Timed>: Copy + Debug {
    /// Evaluations that taking up the time takes at most beside its steps, and each of these.
    const WORK: [usize; 2];

    /// Nothing is led yet.
    fn new(params: &M::Params) -> Self;

    /// Whether inputs have led to where the mechanism is, rather than the time.
    fn is_leading(&self) -> bool;

    /// Brings a mechanism that inputs have led back to what the formulas of its inputs say at its time, in so many steps at most;
    /// gives how many of them are left, or nothing where it is still on its way.
    fn take_up_time(state: &mut State<M>, most: usize, work: &mut Work) -> Result<Option<usize>, Error>;
}

impl<M: Timed> Lead<M> for () {
    const WORK: [usize; 2] = [0, 0];

    fn new(_: &M::Params) -> Self {}

    fn is_leading(&self) -> bool {
        false
    }

    fn take_up_time(_: &mut State<M>, most: usize, _: &mut Work) -> Result<Option<usize>, Error> {
        Ok(Some(most))
    }
}

/// The motion goes along time.
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

/// How a mechanism was assembled with its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Assembly {
    /// It was led from the assembled position of the file's own parameters, along its branch.
    Led,
    /// No way led there: the equations were solved from the poses that the file draws with these parameters, as `mechc run --set` does.
    /// It may be another branch.
    Drawn,
}

/// A mechanism at a time.
#[derive(Clone, Debug)]
pub struct State<M: Timed> {
    pub(super) model: M,
    /// Where it is along the time.
    pub(super) track: Track<M>,
    /// How much steeper these parameters make the equations than the file's.
    pub(super) steepness: f64,
    /// How it was assembled.
    pub(super) assembly: Assembly,
    /// What leads by inputs.
    pub(super) lead: M::Lead,
    /// By rim: the time at which it was looked at last (s).
    pub(super) passed: M::Passed,
}

impl<M: Timed> State<M> {
    /// The solution of now.
    pub(super) fn at(&self) -> &Solution<M> {
        self.track.at()
    }

    /// How it was assembled with its parameters.
    #[must_use]
    pub fn assembly(&self) -> Assembly {
        self.assembly
    }

    /// The time (s).
    #[must_use]
    pub fn t(&self) -> f64 {
        self.at().t
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &M::Params {
        self.model.params()
    }

    /// The coordinates (m, rad), by their indices.
    #[must_use]
    pub fn q(&self) -> &M::Q {
        &self.at().q
    }

    /// Their velocities (m/s, rad/s).
    #[must_use]
    pub fn qd(&self) -> &M::Q {
        &self.at().qd
    }

    /// Their accelerations (m/s^2, rad/s^2).
    #[must_use]
    pub fn qdd(&self) -> &M::Q {
        &self.at().qdd
    }

    /// The measures, by their indices, and their first and second time derivatives; `NAN` where one has no value, and no step fails
    /// for that.
    #[must_use]
    pub fn measures(&self) -> &M::Measures {
        &self.at().measures
    }

    /// Whether inputs have led here, rather than the time.
    pub(super) fn is_led(&self) -> bool {
        self.lead.is_leading()
    }

    /// All results, in the order of the columns of `mechc run`: the time, coordinates and measures, then their first and their second
    /// derivatives.
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
//! The start of a motion.

use super::branches::sides_near;
use super::error::{Error, Fault};
use super::limits::{FIRST_PARTS, LARGEST_CORRECTION, MOST_PARTS, MOST_SHORTER, MOST_TRIALS, SMALLEST_PART};
use super::numbers::Numbers;
use super::reach::reach;
use super::solution::Solution;
use super::state::{Assembly, Lead, Parameters, State, Timed};
use super::track::Track;
use super::work::{Work, of_reaching, of_sides};

/// Evaluations that it takes at most.
pub const fn most_work<M: Timed>() -> usize {
    let of_start = of_sides::<M>() + of_reaching::<M>();
    (2 + FIRST_PARTS + MOST_PARTS) * (of_start + of_sides::<M>() + 1)
        + of_sides::<M>()
        + (1 + MOST_SHORTER) * MOST_TRIALS
}

/// Brings the mechanism to its first time with some parameters: along the branch that the file's parameters give where a short way
/// leads there, else from the poses that the file draws with these parameters, and only then along a long way.
pub fn assemble<M: Timed>(params: &M::Params, work: &mut Work) -> Result<State<M>, Error> {
    if !params.is_finite() {
        return Err(Error::NotANumber);
    }
    let mut way = Way::<M>::new(work)?;
    let model = M::new(params);
    match way.lead(params, FIRST_PARTS, work) {
        Ok(at) => return Ok(way.state(model, at, Assembly::Led)),
        Err(Error::NotANumber) => return Err(Error::NotANumber),
        Err(_) => {}
    }
    let mut at = way.at;
    let drawn = model.closed(&model.drawn(), M::START_TIME, work);
    if drawn.is_some_and(|q| start(&q, &model, &mut at, work).is_ok()) {
        return Ok(way.state(model, at, Assembly::Drawn));
    }
    let at = way.lead(params, MOST_PARTS, work)?;
    Ok(way.state(model, at, Assembly::Led))
}

/// The way from the file's parameters to others.
struct Way<M: Timed> {
    /// How steep the equations are with the file's.
    usual: f64,
    /// The solution where it has come to.
    at: Solution<M>,
    /// The part that is done, and the next one that is tried.
    done: f64,
    part: f64,
}

impl<M: Timed> Way<M> {
    /// Its beginning.
    fn new(work: &mut Work) -> Result<Self, Error> {
        let mut at = Solution::ZERO;
        start(M::start(), &M::new(&M::Params::default()), &mut at, work).map_err(Fault::at_start)?;
        Ok(Self { usual: at.steepest, at, done: 0.0, part: 1.0 })
    }

    /// Goes on to the end, in so many trials at most.
    fn lead(&mut self, params: &M::Params, most: usize, work: &mut Work) -> Result<Solution<M>, Error> {
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

    /// The state at a solution.
    fn state(&self, model: M, at: Solution<M>, assembly: Assembly) -> State<M> {
        let ratio = at.steepest / self.usual;
        let mut passed = M::Passed::ZERO;
        passed.as_mut().fill(f64::NEG_INFINITY);
        State {
            steepness: if ratio > 0.0 { ratio } else { 1.0 },
            lead: M::Lead::new(model.params()),
            model,
            track: Track { solutions: [at, self.at], is_second: false, is_smooth: false, stride: M::LONGEST_STEP },
            assembly,
            passed,
        }
    }
}

/// Whether a position is too far away to solve from, by the operations alone: to try harder costs many times as much.
fn is_far<M: Timed>(q: &M::Q, m: &M, at: &mut Solution<M>, work: &mut Work) -> bool {
    let sides = sides_near(q, M::START_TIME, m, work);
    work.add(1);
    m.solve(&M::tears(q), M::START_TIME, &sides, at);
    !at.is_settled && at.first > LARGEST_CORRECTION
}

/// Solves at the first time, from a position nearby.
fn start<M: Timed>(q: &M::Q, m: &M, at: &mut Solution<M>, work: &mut Work) -> Result<(), Fault> {
    let mut near = Solution::near(q, M::START_TIME);
    near.sides = sides_near(q, M::START_TIME, m, work);
    reach(&M::tears(q), &near, M::START_TIME, m, at, work)?;
    if at.first <= LARGEST_CORRECTION { Ok(()) } else { Err(Fault::TooFar) }
}
}

pub mod explain {
//! Why a motion cannot go on.

use super::branches::sides_at;
use super::equations::{Branches, Checks};
use super::error::{Error, Fault};
use super::limits::{NEAR_FOLD, SINGULAR};
use super::solution::{Solution, Solved};
use super::state::{State, Timed};
use super::work::{Work, of_sides};

/// Why even the shortest step from a state towards a time is refused.
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

/// Evaluations that it takes to tell why, at most.
pub const fn of_regular<M: Branches>() -> usize {
    1 + 2 * of_sides::<M>()
}

/// Why it is, if that has nothing to do with how near the position is to a singular one.
pub fn regular<M: Solved>(at: &Solution<M>, fault: Fault, t: f64, m: &M, work: &mut Work) -> Option<Error> {
    work.add(1);
    let values = m.phi(&at.q, t, &at.sides);
    if fault == Fault::NotANumber || values.as_ref().iter().any(|value| !value.is_finite()) {
        return Some(Error::NotANumber);
    }
    // a position that jumps far is not even found on the other side
    let mut is_at_edge = || sides_at(at.t, m, work) != sides_at(t, m, work);
    let jumps = fault == Fault::NotSmooth || (fault == Fault::TooFar && is_at_edge());
    jumps.then_some(Error::NotSmooth)
}

/// How long it takes to a dead point: a motion that comes to one after a time u is as the root of u, whose slope over twice its
/// curvature is u. That of the fastest coordinate counts.
pub fn until_turn<M: Solved>(at: &Solution<M>) -> f64 {
    let rates = at.qd.as_ref().iter().zip(at.qdd.as_ref()).zip(M::scales().as_ref());
    let sooner = |(speed, left): (f64, f64), ((v, a), scale): ((&f64, &f64), &f64)| {
        if v.abs() / scale > speed { (v.abs() / scale, 0.5 * v / a) } else { (speed, left) }
    };
    rates.fold((0.0, 0.0), sooner).1
}

/// What the motion meets at a singular position: a dead point if that is so little of a span ahead. Else equations that were left out may
/// decide how it goes on.
pub fn meeting<M: Checks>(left: f64, span: f64) -> Error {
    if left > 0.0 && left < NEAR_FOLD * span {
        Error::LockUp
    } else if M::LEAVES_OUT {
        Error::Inconsistent
    } else {
        Error::Bifurcation
    }
}
}

pub mod step {
//! Steps from time to time.

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
use super::state::{Lead, State, Timed};
use super::track::Checkpoint;
use super::work::{Progress, Work, of_step};

/// Evaluations that a call of so many steps takes at most.
pub const fn most_work<M: Timed>(most: usize) -> usize {
    let [of_lead, of_its_step] = M::Lead::WORK;
    let of_step = of_step::<M>() + M::WORK_OF_RIMS;
    let of_step = if of_its_step > of_step { of_its_step } else { of_step };
    most.saturating_mul(of_step).saturating_add(of_lead + of_regular::<M>())
}

/// Moves a state to time `t` (s), in so many steps at most, each as short as the motion asks for: position, velocity and acceleration
/// are those of the branch that it is on, whichever way `t` lies. After an error the state is as it was; what so many steps do not
/// reach is one.
pub fn step<M: Timed>(t: f64, state: &mut State<M>, most: usize, work: &mut Work) -> Result<(), Error> {
    let is_beyond = (t - state.at().t).abs() > M::LONGEST_STEP * most as f64;
    if is_beyond && t.is_finite() {
        return Err(Error::TooFar);
    }
    go(t, state, most, true, work).map(|_| ())
}

/// The same, but what so many steps do not reach is on its way.
pub fn step_within<M: Timed>(t: f64, state: &mut State<M>, most: usize, work: &mut Work) -> Result<Progress, Error> {
    go(t, state, most, false, work)
}

fn go<M: Timed>(t: f64, state: &mut State<M>, most: usize, is_whole: bool, work: &mut Work) -> Result<Progress, Error> {
    if !(t - state.at().t).is_finite() {
        return Err(Error::NotANumber);
    }
    if state.is_led() { take_up(t, state, most, is_whole, work) } else { march(t, state, most, is_whole, work) }
}

/// Goes on by the time from where inputs have led.
#[cold]
#[inline(never)]
fn take_up<M: Timed>(
    t: f64,
    state: &mut State<M>,
    most: usize,
    is_whole: bool,
    work: &mut Work,
) -> Result<Progress, Error> {
    let (lead, track) = (state.lead, state.track);
    let result = match M::Lead::take_up_time(state, most, work) {
        Ok(Some(left)) => march(t, state, left, is_whole, work),
        Ok(None) if is_whole => Err(Error::TooFar),
        Ok(None) => Ok(Progress { fraction: 0.0 }),
        Err(error) => Err(error),
    };
    if result.is_err() {
        (state.lead, state.track) = (lead, track);
    }
    result
}

/// Steps from time to time.
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
        // what is fast may be over before the step's end
        let edge = first_edge(now, wanted, &state.model, work);
        let next = match state.model.first_rim(now, edge, &state.passed, work) {
            None => edge,
            Some((rim, at)) => {
                let before = at - (LEAD * M::SPAN).copysign(left);
                if (before - now) * left <= 0.0 {
                    if let Err(error) = M::look_at_rim(state, rim, at, work) {
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

/// One step to a time; says whether a longer one would do as well.
fn advance<M: Timed>(state: &mut State<M>, t: f64, is_wanted: bool, work: &mut Work) -> Result<bool, Fault> {
    let is_smooth = state.track.is_smooth;
    let (from, at) = state.track.both();
    let m = &state.model;
    let h = t - from.t;
    let (v, a) = (M::tears(&from.qd), M::tears(&from.qdd));
    let mut way = if is_smooth { bend(from, at, h) } else { M::Tears::ZERO };
    for (way, (v, a)) in way.as_mut().iter_mut().zip(v.as_ref().iter().zip(a.as_ref())) {
        // Taylor
        *way += h * (v + 0.5 * h * a);
    }
    let is_calm = tried(&way, from, t, m, at, |at| gap(from, at, h), work)?;
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

/// Solves at a time, or a place of a way, to which the tears are expected to go so far, if that is near enough for a step; says whether
/// a longer step would do as well. A gap is how far a solution is from what the slopes at both ends make of the way between, scaled.
pub fn tried<M: Solved>(
    way: &M::Tears,
    from: &Solution<M>,
    t: f64,
    m: &M,
    at: &mut Solution<M>,
    gap: impl FnOnce(&Solution<M>) -> f64,
    work: &mut Work,
) -> Result<bool, Fault> {
    // what is not a number is not small either
    let is_short = largest(way, M::tear_scales()) <= LARGEST_MOTION;
    if !is_short {
        return Err(Fault::TooFar);
    }
    let mut guess = M::tears(&from.q);
    for (guess, way) in guess.as_mut().iter_mut().zip(way.as_ref()) {
        *guess += *way;
    }
    reach(&guess, from, t, m, at, work)?;
    let gap = gap(at);
    let is_near = at.first <= LARGEST_CORRECTION && gap <= LARGEST_GAP;
    if !is_near {
        return Err(Fault::TooFar);
    }
    Ok(at.first < LARGEST_CORRECTION / CALM_CORRECTION && gap < LARGEST_GAP / CALM_BETWEEN)
}

/// How far positions are from what both ends' velocities and accelerations make of the way between (Hermite), scaled.
fn gap<M: Solved>(from: &Solution<M>, at: &Solution<M>, h: f64) -> f64 {
    let (x, v, a) = (M::tears(&from.q), M::tears(&from.qd), M::tears(&from.qdd));
    let (y, w, b) = (M::tears(&at.q), M::tears(&at.qd), M::tears(&at.qdd));
    let mut gaps = M::Tears::ZERO;
    let ways = y.as_ref().iter().zip(x.as_ref());
    let rates = v.as_ref().iter().zip(w.as_ref());
    let bends = a.as_ref().iter().zip(b.as_ref());
    for ((gap, (y, x)), ((v, w), (a, b))) in gaps.as_mut().iter_mut().zip(ways).zip(rates.zip(bends)) {
        *gap = y - x - 0.5 * h * (v + w) - h * h * (1.0 / 12.0) * (a - b);
    }
    largest(&gaps, M::tear_scales())
}

/// What the motion since the solution before adds to Taylor's way over a time `h` (s).
fn bend<M: Solved>(now: &Solution<M>, before: &Solution<M>, h: f64) -> M::Tears {
    let back = now.t - before.t;
    let u = h / back;
    if u.is_nan() || u.abs() > FARTHEST_BEND {
        return M::Tears::ZERO;
    }
    let (x, v, a) = (M::tears(&now.q), M::tears(&now.qd), M::tears(&now.qdd));
    let (y, w, b) = (M::tears(&before.q), M::tears(&before.qd), M::tears(&before.qdd));
    let mut bend = M::Tears::ZERO;
    let ways = x.as_ref().iter().zip(y.as_ref());
    let rates = v.as_ref().iter().zip(w.as_ref());
    let bends = a.as_ref().iter().zip(b.as_ref());
    for ((bend, (x, y)), ((v, w), (a, b))) in bend.as_mut().iter_mut().zip(ways).zip(rates.zip(bends)) {
        *bend = bend_ahead([*x, *v, *a], [*y, *w, *b], back, u);
    }
    bend
}

/// Whether position or velocity differ on the two sides of a time at which formulas change their branches: `at` is the later side, and
/// `from` has the branches of the earlier one.
fn jumps<M: Timed>(from: &Solution<M>, at: &Solution<M>, m: &M, work: &mut Work) -> bool {
    let mut before = *at;
    if find(&M::tears(&at.q), at, at.t, m, &from.sides, &mut before, work).is_err() {
        return true;
    }
    let (way, change) = (difference(&at.q, &before.q), difference(&at.qd, &before.qd));
    let scales = M::scales();
    let fastest = largest(&at.qd, scales) + largest(&before.qd, scales) + REST / M::SPAN;
    largest(&way, scales) > POSITION_JUMP || largest(&change, scales) > VELOCITY_JUMP * fastest
}
}

pub mod blocks {
// Sparse linear equations that fall apart into blocks, each solved by elimination with partial pivoting.
//
// For places where an order of elimination that was fixed beforehand loses digits. All scaling is by powers of two, which
// round nothing.

/// Equations for as many unknowns, and how they fall apart: a block's equations hold its own unknowns and those of the blocks
/// before it.
#[derive(Clone, Copy, Debug)]
pub struct Blocks<'b> {
    /// How many equations each block has.
    pub sizes: &'b [usize],
    /// The equations, block by block.
    pub rows: &'b [usize],
    /// The unknowns, block by block.
    pub columns: &'b [usize],
    /// Where the entries of each equation begin, and where those of the last one end.
    pub starts: &'b [usize],
    /// The unknown of each entry.
    pub entries: &'b [usize],
    /// By unknown: its place in `columns`.
    pub places: &'b [usize],
    /// By unknown: the power of two that it is measured by.
    pub units: &'b [f64],
}

/// Solves for `x`: the values of the entries times `x` are `right`, which is given by equation.
///
/// `work` holds as many numbers as the largest block has entries, and one more for each of its equations. Writes for each block
/// whether its determinant is negative, and gives the smallest pivot, beside rows whose largest entry is about 1; what is not a
/// number wins.
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

/// How many numbers the work for a block of a size takes.
#[must_use]
pub const fn work_of(size: usize) -> usize {
    size * (size + 2)
}

/// A matrix row by row.
fn lines(matrix: &mut [f64], width: usize) -> impl Iterator<Item = &mut [f64]> {
    let mut left = matrix;
    core::iter::from_fn(move || {
        let (line, rest) = core::mem::take(&mut left).split_at_mut_checked(width)?;
        left = rest;
        Some(line)
    })
}

/// One equation of the block whose unknowns begin at a place, scaled, with what is known brought to the right.
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
        // two over the power of two that is not above it
        let factor = 1.0 / f64::from_bits(largest.to_bits() & 0x7ff0_0000_0000_0000);
        for entry in line {
            *entry *= factor;
        }
    }
}

/// Elimination with partial pivoting of rows that end with their right sides; gives the smallest pivot, and whether the
/// determinant is negative.
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
//! Solving by elimination with partial pivoting, where the order that `solve` has loses digits.

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
    /// Numbers that the elimination of the largest block works on.
    type Work: Numbers;
    /// An answer for each block of equations.
    type Blocks: Flags;
    /// The derivatives of coordinates, velocities and accelerations by inputs and parameters that measures hold.
    type Varied: Numbers;
    /// A right side for each derivative by what the motion goes along.
    type Rights: AsRef<[Self::Q]>;

    /// What may be left of an equation, beside the norm of its row.
    const TOLERANCE: f64;
    /// Whether measures hold third derivatives of the coordinates.
    const HAS_JERK: bool = false;
    /// By derivative by inputs and parameters: whether it is one by two.
    const IS_BY_TWO: &'static [bool] = &[];

    /// How the equations fall apart into blocks.
    fn blocks() -> &'static Blocks<'static>;

    /// The blocks whose determinants change.
    fn turning() -> &'static [usize];

    /// The width of a cell of each coordinate's grid.
    fn cells() -> &'static Self::Q;

    /// The right side of the jerk equation.
    fn jerk(&self, _orders: [&Self::Q; 3], _t: f64, _sides: &Self::Sides) -> Self::Q {
        Self::Q::ZERO
    }

    /// The right sides for the derivatives by inputs and parameters, as far as those before them are found.
    fn varied_right(
        &self,
        _orders: [&Self::Q; 3],
        _varied: &Self::Varied,
        _t: f64,
        _sides: &Self::Sides,
    ) -> Self::Varied {
        Self::Varied::ZERO
    }

    /// The transposed matrix, where somebody asks for forces.
    fn transposed() -> Option<&'static Transposed> {
        None
    }

    /// What the multipliers have to hold, by coordinate.
    fn needed(&self, _orders: [&Self::Q; 4], _t: f64, _sides: &Self::Sides) -> Self::Q {
        Self::Q::ZERO
    }

    /// The right sides for the derivatives by what the motion goes along.
    fn rights(&self, q: &Self::Q, t: f64, sides: &Self::Sides) -> Self::Rights;

    /// What is measured, from the coordinates with their first three derivatives, what these vary by, and the multipliers.
    fn measured(&self, orders: [&Self::Q; 4], varied: &Self::Varied, multipliers: &Self::Q, t: f64) -> Self::Measures;
}

/// The transposed matrix, an equation for each coordinate.
pub struct Transposed {
    /// How its equations fall apart into blocks.
    pub blocks: &'static Blocks<'static>,
    /// The place of each of its entries among those of the matrix.
    pub places: &'static [usize],
}

/// The solution from a position nearby. All coordinates lie on a grid while Newton goes on.
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

/// Newton's iteration from far away, for which an equation counts by what a change of its coordinates makes of it: each correction is
/// so short that nothing moves by more than its scale, and that the equations come nearer to holding. Nothing where it does not arrive.
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

/// What a change of the coordinates by their scales makes of each equation at most.
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

/// Newton's iteration; whether it has arrived.
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

/// The derivatives of the coordinates, their velocities and accelerations by inputs and parameters: those by one before those by two,
/// each order from those before.
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

/// The work of solving linear equations in blocks.
pub struct Elimination<M: Pivoting> {
    work: M::Work,
    is_negative: M::Blocks,
}

impl<M: Pivoting> Elimination<M> {
    /// Room for the work.
    pub fn new() -> Self {
        Self { work: M::Work::ZERO, is_negative: M::Blocks::NONE }
    }

    /// The solution for a right side, and the smallest pivot.
    pub fn solve(&mut self, slopes: &M::Entries, right: &M::Q) -> (M::Q, f64) {
        let mut x = M::Q::ZERO;
        let (work, is_negative) = (self.work.as_mut(), self.is_negative.as_mut());
        let pivot = blocks::solve(M::blocks(), slopes.as_ref(), right.as_ref(), x.as_mut(), work, is_negative);
        (x, pivot)
    }

    /// The third derivatives of the coordinates; 0 where nobody asks for them.
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

    /// The multipliers of a state; 0 where nobody asks for forces.
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

/// Whether what is left of the equations is within their tolerance, and what rounding makes of the coordinates.
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

/// No number is -0.
pub fn without_signs_of_zero<N: Numbers>(mut values: N) -> N {
    values.as_mut().iter_mut().for_each(|value| *value += 0.0);
    values
}
}

pub mod way {
//! The way of the signals that lead a mechanism.

use super::equations::Equations;
use super::limits::FARTHEST_AHEAD;
use super::numbers::{Numbers, largest};
use super::solution::{Along, Solution, Solved};
use super::state::Parameters;

/// Values, rates and accelerations of signals.
pub type Signals<const K: usize> = [[f64; K]; 3];

/// A way of the signals: a straight line from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct Way<P, const K: usize> {
    /// The parameters of the mechanism.
    pub params: P,
    /// The values at its beginning.
    pub from: [f64; K],
    /// The values at its end.
    pub to: [f64; K],
    /// The rates all along.
    pub rates: [f64; K],
    /// The accelerations all along.
    pub accelerations: [f64; K],
}

impl<P: Parameters, const K: usize> Way<P, K> {
    /// A way that leads nowhere.
    pub fn new(params: &P) -> Self {
        let zero = [0.0; K];
        Self { params: *params, from: zero, to: zero, rates: zero, accelerations: zero }
    }

    /// Goes on from some values to signals.
    pub fn turn(&mut self, from: &[f64; K], to: &Signals<K>) {
        self.from = *from;
        [self.to, self.rates, self.accelerations] = *to;
    }

    /// The value of a signal at a place of the way.
    #[inline]
    pub fn value(&self, k: usize, t: f64) -> f64 {
        match (self.from.get(k), self.to.get(k)) {
            (Some(_), Some(to)) if t >= 1.0 => *to,
            (Some(from), Some(to)) => from + t * (to - from),
            _ => f64::NAN,
        }
    }

    /// Those of all.
    pub fn values(&self, t: f64) -> [f64; K] {
        core::array::from_fn(|k| self.value(k, t))
    }

    /// How the signals change along the whole way.
    pub fn direction(&self) -> [f64; K] {
        core::array::from_fn(|k| self.value(k, 1.0) - self.value(k, 0.0))
    }

    /// How much the one changes that changes most.
    pub fn length(&self) -> f64 {
        largest(&self.direction(), &[1.0; K])
    }
}

/// A mechanism whose motion goes along signals.
pub trait Led<const K: usize>: Solved<Along = Slopes<<Self as Equations>::Q, K>> {
    /// Its parameters.
    type Params: Parameters;

    /// By signal: the largest change that a call takes, if nobody says otherwise.
    const LARGEST_CHANGE: [f64; K];

    /// The mechanism on a way.
    fn new(way: &Way<Self::Params, K>) -> Self;

    /// The way that it is on.
    fn way(&self) -> &Way<Self::Params, K>;

    /// The same, to be written.
    fn way_mut(&mut self) -> &mut Way<Self::Params, K>;

    /// What the text's formulas say of the signals at a time (s).
    fn by_text(params: &Self::Params, t: f64) -> Signals<K>;

    /// Derivatives in whose direction an equation that was left out would cease to hold have no value.
    fn hold_apart(&self, _by: &mut [Self::Q; K], _at: &Solution<Self>) {}
}

/// The motion goes along signals: the derivatives of the coordinates by each, and what these are.
#[derive(Clone, Copy, Debug)]
pub struct Slopes<Q, const K: usize> {
    /// By signal: how the coordinates change with it.
    pub by_signal: [Q; K],
    /// The values of the signals.
    pub signals: [f64; K],
}

impl<Q: Numbers, const K: usize> Slopes<Q, K> {
    /// How the coordinates change along a direction of the signals.
    pub fn along(&self, direction: &[f64; K]) -> Q {
        sum(self.by_signal, direction)
    }
}

/// The sum of some lists of numbers, each with its factor.
pub fn sum<N: Numbers, const K: usize>(lists: [N; K], factors: &[f64; K]) -> N {
    let mut sum = N::ZERO;
    for (list, factor) in lists.iter().zip(factors) {
        let pairs = sum.as_mut().iter_mut().zip(list.as_ref());
        pairs.for_each(|(sum, value)| *sum += value * factor);
    }
    sum
}

impl<M: Led<K>, const K: usize> Along<M> for Slopes<M::Q, K> {
    const ZERO: Self = Self { by_signal: [M::Q::ZERO; K], signals: [0.0; K] };

    fn predicted(m: &M, from: &Solution<M>, h: f64) -> M::Q {
        moved(&from.q, &from.along.along(&m.way().direction()), h)
    }

    fn ahead(m: &M, at: &Solution<M>) -> (M::Q, f64) {
        let rates = at.along.along(&m.way().direction());
        let ahead = f64::min(FARTHEST_AHEAD, FARTHEST_AHEAD / largest(&rates, M::scales()));
        (moved(&at.q, &rates, ahead), at.t)
    }

    fn note(&mut self, m: &M, t: f64) {
        self.signals = m.way().values(t);
    }

    fn slopes(&self) -> &[M::Q] {
        &self.by_signal
    }

    fn slopes_mut(&mut self) -> &mut [M::Q] {
        &mut self.by_signal
    }
}

/// Coordinates a distance on, with their rates.
fn moved<N: Numbers>(q: &N, rates: &N, distance: f64) -> N {
    let mut moved = *q;
    let pairs = moved.as_mut().iter_mut().zip(rates.as_ref());
    pairs.for_each(|(q, rate)| *q += distance * rate);
    moved
}
}

pub mod follow {
//! What follows inputs.

use super::branches::{first_edge, sides_near};
use super::equations::Branches;
use super::error::{Error, Fault};
use super::explain::{meeting, of_regular, regular, until_turn};
use super::limits::{
    CRUMB, FARTHEST_BEND, JUMP, LARGEST_CORRECTION, LARGEST_TURN, NEAR_TURN, NEAREST_TURN, POSITION_JUMP,
    SHORTEST_STEP, SINGULAR,
};
use super::numbers::{Numbers, add_zeros, difference, larger, largest};
use super::reach::{find, reach, stays_on_branch};
use super::solution::{Solution, Solved};
use super::state::{Lead, State, Timed};
use super::step::tried;
use super::track::{Checkpoint, Track};
use super::way::{Led, Signals, Way, sum};
use super::work::{Progress, Work, of_reaching, of_sides, of_step};

/// What leads a mechanism by its inputs.
#[derive(Clone, Copy, Debug)]
pub struct Leading<E: Led<K>, const K: usize> {
    pub(super) model: E,
    /// Where it is; times are places of the way, and steps are changes of a signal.
    pub(super) track: Track<E>,
    /// The largest change of each signal that a call takes.
    largest_change: [f64; K],
    /// Where a way leads that was left before its end, and the change that goes well on it.
    unfinished: ([f64; K], f64),
    /// Whether inputs have led to where the mechanism is, rather than the time.
    is_leading: bool,
}

/// A mechanism with what leads it: they have the same coordinates, measures and parameters.
pub trait Follows<E: Led<K>, const K: usize>:
    Timed<Q = E::Q, Measures = E::Measures, Params = E::Params, Lead = Leading<E, K>>
{
    /// Whether time is the last of the signals.
    const HAS_TIME: bool;
}

impl<E: Led<K>, M: Follows<E, K>, const K: usize> Lead<M> for Leading<E, K> {
    // beside the way, the solution of the time
    const WORK: [usize; 2] = [most_work::<E, K>(0) + of_beginning::<M>(), of_step::<E>() + 1];

    fn new(params: &M::Params) -> Self {
        Self::with(params)
    }

    fn is_leading(&self) -> bool {
        self.is_leading
    }

    fn take_up_time(state: &mut State<M>, most: usize, work: &mut Work) -> Result<Option<usize>, Error> {
        let t = state.at().t;
        work.add(1);
        let wanted = E::by_text(state.params(), t);
        let mut left = most;
        let come = state.lead.go(&wanted, &mut left, false, state.steepness, work);
        state.take_over();
        if !come?.is_reached() {
            return Ok(None);
        }
        let q = state.at().q;
        let mut near = Solution::near(&q, t);
        near.sides = sides_near(&q, t, &state.model, work);
        reach(&M::tears(&q), &near, t, &state.model, state.track.at_mut(), work).map_err(Fault::at_start)?;
        (state.lead.is_leading, state.track.is_smooth) = (false, false);
        Ok(Some(left))
    }
}

/// Evaluations that a call of so many steps takes at most.
pub const fn most_work<E: Led<K>, const K: usize>(most: usize) -> usize {
    // that of the turn where a step is refused
    most.saturating_mul(of_step::<E>() + 1)
        .saturating_add(of_beginning::<E>() + of_regular::<E>() + of_reaching::<E>() + 2)
}

/// Evaluations that it takes to begin where the time has led, or to go on from there.
const fn of_beginning<E: Branches>() -> usize {
    1 + of_sides::<E>() + of_reaching::<E>()
}

/// Leads a state from its inputs to others in so many steps at most, along the straight line between them. After an error the state is
/// as it was; what so many steps do not reach is one.
pub fn follow<E: Led<K>, M: Follows<E, K>, const K: usize>(
    signals: &Signals<K>,
    state: &mut State<M>,
    most: usize,
    work: &mut Work,
) -> Result<(), Error> {
    lead(signals, state, most, true, work).map(|_| ())
}

/// The same, but what so many steps do not reach is on its way.
pub fn follow_within<E: Led<K>, M: Follows<E, K>, const K: usize>(
    signals: &Signals<K>,
    state: &mut State<M>,
    most: usize,
    work: &mut Work,
) -> Result<Progress, Error> {
    lead(signals, state, most, false, work)
}

fn lead<E: Led<K>, M: Follows<E, K>, const K: usize>(
    signals: &Signals<K>,
    state: &mut State<M>,
    most: usize,
    is_whole: bool,
    work: &mut Work,
) -> Result<Progress, Error> {
    let mut sums = [0.0; 4];
    signals.iter().for_each(|of| add_zeros(of, &mut sums));
    if sums != [0.0; 4] {
        return Err(Error::NotANumber);
    }
    if state.is_led() {
        state.lead.takes(&state.lead.at().along.signals, signals)?;
        let come = state.lead.go(signals, &mut { most }, is_whole, state.steepness, work)?;
        state.take_over();
        return Ok(come);
    }
    begin(signals, state, most, is_whole, work)
}

/// Leads a state that inputs have not led yet.
#[cold]
#[inline(never)]
fn begin<E: Led<K>, M: Follows<E, K>, const K: usize>(
    signals: &Signals<K>,
    state: &mut State<M>,
    most: usize,
    is_whole: bool,
    work: &mut Work,
) -> Result<Progress, Error> {
    let (before, q, t) = (state.lead, state.at().q, state.at().t);
    let [now, ..] = E::by_text(state.params(), t);
    work.add(1);
    state.lead.takes(&now, signals)?;
    let lead = &mut state.lead;
    let come = lead.begin(&q, t, work).and_then(|()| lead.go(signals, &mut { most }, is_whole, state.steepness, work));
    match come {
        Ok(come) if come.fraction > 0.0 => {
            state.lead.is_leading = true;
            state.take_over();
        }
        Ok(_) => state.lead = Leading { unfinished: state.lead.unfinished, ..before },
        Err(_) => state.lead = before,
    }
    come
}

impl<M: Timed> State<M> {
    /// Takes over where its inputs have led.
    fn take_over<E: Led<K>, const K: usize>(&mut self)
    where
        M: Follows<E, K>,
    {
        let (at, to) = (self.lead.at(), self.track.at_mut());
        (to.q, to.qd, to.qdd, to.measures) = (at.q, at.qd, at.qdd, at.measures);
        if let (true, [.., t]) = (M::HAS_TIME, at.along.signals.as_slice()) {
            to.t = *t;
        }
    }
}

/// By signal: the largest change that a call takes.
pub fn largest_change<E: Led<K>, M: Follows<E, K>, const K: usize>(state: &State<M>) -> &[f64; K] {
    &state.lead.largest_change
}

/// The same, to be written.
pub fn largest_change_mut<E: Led<K>, M: Follows<E, K>, const K: usize>(state: &mut State<M>) -> &mut [f64; K] {
    &mut state.lead.largest_change
}

/// The signals at a state: what they were followed to, or what their formulas say at its time.
pub fn signals<E: Led<K>, M: Follows<E, K>, const K: usize>(state: &State<M>) -> Signals<K> {
    if state.is_led() {
        let way = state.lead.model.way();
        [state.lead.at().along.signals, way.rates, way.accelerations]
    } else {
        E::by_text(state.params(), state.t())
    }
}

/// The derivatives of the coordinates by each signal: for a constant shift of it, along the branch that the state is on.
pub fn influence<E: Led<K>, M: Follows<E, K>, const K: usize>(state: &State<M>) -> Result<[M::Q; K], Error> {
    let at = |lead: &Leading<E, K>| {
        let at = lead.at();
        let mut by_signal = at.along.by_signal;
        lead.model.hold_apart(&mut by_signal, at);
        by_signal
    };
    if state.is_led() {
        return Ok(at(&state.lead));
    }
    let mut lead = Leading::with(state.params());
    lead.begin(state.q(), state.t(), &mut Work::default())?;
    Ok(at(&lead))
}

impl<E: Led<K>, const K: usize> Leading<E, K> {
    fn with(params: &E::Params) -> Self {
        let solutions = [Solution::ZERO, Solution::ZERO];
        Self {
            model: E::new(&Way::new(params)),
            track: Track { solutions, is_second: false, is_smooth: false, stride: f64::INFINITY },
            largest_change: E::LARGEST_CHANGE,
            unfinished: ([f64::NAN; K], f64::INFINITY),
            is_leading: false,
        }
    }

    /// The solution of now.
    pub(super) fn at(&self) -> &Solution<E> {
        self.track.at()
    }

    /// Whether no signal changes by more than is taken.
    fn takes(&self, from: &[f64; K], [to, ..]: &Signals<K>) -> Result<(), Error> {
        let mut changes = from.iter().zip(to).zip(&self.largest_change);
        if changes.all(|((from, to), largest)| (to - from).abs() <= *largest) { Ok(()) } else { Err(Error::TooFar) }
    }

    /// Begins at a position that the text's formulas give at a time (s).
    fn begin(&mut self, q: &E::Q, t: f64, work: &mut Work) -> Result<(), Error> {
        let way = self.model.way_mut();
        let signals = E::by_text(&way.params, t);
        way.turn(&signals[0], &signals);
        let mut near = Solution::near(q, 1.0);
        near.sides = sides_near(q, 1.0, &self.model, work);
        self.track.is_smooth = false;
        let now = self.track.at_mut();
        reach(&E::tears(q), &near, 1.0, &self.model, now, work).map_err(Fault::at_start)?;
        if now.first <= LARGEST_CORRECTION { Ok(()) } else { Err(Error::Divergence) }
    }

    /// Goes from the signals of now to others in so many steps at most, of which it leaves what it does not take. After an error, all
    /// is as it was.
    fn go(
        &mut self,
        signals: &Signals<K>,
        left: &mut usize,
        is_whole: bool,
        steepness: f64,
        work: &mut Work,
    ) -> Result<Progress, Error> {
        let from = self.at().along.signals;
        let (mut before, way) = (Checkpoint::of(&self.track), *self.model.way());
        self.model.way_mut().turn(&from, signals);
        self.track.at_mut().t = 0.0;
        let ((goal, stride), usual) = (self.unfinished, self.track.stride);
        let goes_on = goal == signals[0];
        if goes_on {
            self.track.stride = stride;
        }
        let mut why = self.march(left, &mut before, steepness, work);
        if why.is_none() {
            if goes_on {
                self.unfinished = ([f64::NAN; K], f64::INFINITY);
            }
            return Ok(Progress::REACHED);
        }
        if why == Some(Error::TooFar) && !is_whole {
            self.unfinished = (signals[0], self.track.stride);
            if self.at().t > 0.0 {
                // what goes well elsewhere is not what goes well here
                self.track.stride = usual;
                return Ok(Progress::part(self.at().t, 1.0));
            }
            why = None;
        }
        before.restore(&mut self.track);
        *self.model.way_mut() = way;
        why.map_or(Ok(Progress { fraction: 0.0 }), Err)
    }

    /// Steps from place to place to the end of the way; why it ends before, if it does.
    #[inline(always)]
    #[allow(clippy::inline_always)] // a call would keep everything in memory
    fn march(
        &mut self,
        left: &mut usize,
        before: &mut Checkpoint<E>,
        steepness: f64,
        work: &mut Work,
    ) -> Option<Error> {
        let length = self.model.way().length();
        // the branch asks for steps of the same change on any way
        let smallest = SHORTEST_STEP / larger(length, 1.0);
        let mut refused = None;
        while *left > 0 {
            *left -= 1;
            let now = self.at().t;
            let step = f64::max(self.track.stride / length, smallest);
            // a way without length is one step
            let wanted = if step < CRUMB * (1.0 - now) { now + step } else { 1.0 };
            let next = first_edge(now, wanted, &self.model, work);
            let (is_last, size) = (next >= 1.0, next - now);
            match self.advance(next, is_last, steepness, work) {
                Ok(is_calm) => {
                    let stride = self.track.stride;
                    if is_calm {
                        self.track.stride = f64::max(stride, 2.0 * size * length);
                    } else if length > 0.0 {
                        self.track.stride = f64::min(stride, size * length);
                    }
                    if is_last {
                        return None;
                    }
                    before.keep(&self.track);
                }
                Err(Fault::NotSmooth) => return Some(Error::NotSmooth),
                Err(fault) => {
                    let half = 0.5 * size;
                    self.track.is_smooth = false;
                    if half < smallest || now + half == now {
                        return Some(self.explain(fault, next, steepness, work));
                    }
                    refused = Some((fault, next));
                    let turn = self.turn(fault, steepness, work);
                    if turn < size * length {
                        if turn < NEAREST_TURN && self.at().steepest >= SINGULAR * steepness {
                            return Some(Error::LockUp);
                        }
                        self.track.stride = 0.9 * turn;
                    } else {
                        self.track.stride = half * length;
                    }
                }
            }
        }
        work.add(1);
        let at = self.at();
        if self.model.phi(&at.q, 1.0, &at.sides).as_ref().iter().any(|value| !value.is_finite()) {
            return Some(Error::NotANumber);
        }
        match refused {
            Some((Fault::TooFar, next)) if self.jumps(next, work) => Some(Error::NotSmooth),
            _ => Some(Error::TooFar),
        }
    }

    /// One step to a place of the way; says whether a longer one would do as well.
    fn advance(&mut self, t: f64, is_wanted: bool, steepness: f64, work: &mut Work) -> Result<bool, Fault> {
        let is_smooth = self.track.is_smooth;
        let (from, at) = self.track.both();
        let m = &self.model;
        let h = t - from.t;
        let change = m.way().direction().map(|rate| h * rate);
        let v = tears_along(from, &change);
        let mut way = if is_smooth { bend(from, at, &v, &change) } else { E::Tears::ZERO };
        for (way, v) in way.as_mut().iter_mut().zip(v.as_ref()) {
            *way += v;
        }
        let is_calm = tried(&way, from, t, m, at, |at| gap(from, at, &v, &change), work)?;
        if !stays_on_branch(from, at, m, is_wanted, steepness, work) {
            return Err(Fault::Singular);
        }
        if E::OF_TIME && at.sides != from.sides && jumps(from, at, m, work) {
            return Err(Fault::NotSmooth);
        }
        let is_smooth = at.sides == from.sides;
        self.track.is_smooth = is_smooth;
        self.track.is_second = !self.track.is_second;
        Ok(is_calm)
    }

    /// Why even the shortest step towards a place of the way is refused.
    fn explain(&self, fault: Fault, t: f64, steepness: f64, work: &mut Work) -> Error {
        let (at, m) = (self.at(), &self.model);
        if let Some(error) = regular(at, fault, t, m, work) {
            return error;
        }
        if at.steepest < SINGULAR * steepness {
            if fault == Fault::LeftOut {
                return Error::Inconsistent;
            }
            let jumps = fault == Fault::TooFar && self.jumps(t, work);
            return if jumps { Error::NotSmooth } else { Error::Divergence };
        }
        meeting::<E>(self.until_turn(work), 1.0 + m.way().length())
    }

    /// Whether the position jumps on the way to a place, without a branch of a formula: it is found there, but much farther away than the
    /// slopes on this side lead.
    fn jumps(&self, t: f64, work: &mut Work) -> bool {
        let (at, m) = (self.at(), &self.model);
        let mut beyond = *at;
        if reach(&E::tears(&at.q), at, t, m, &mut beyond, work).is_err() {
            return false;
        }
        let change = m.way().direction().map(|rate| (t - at.t) * rate);
        let led = largest(&at.along.along(&change), E::scales());
        largest(&difference(&beyond.q, &at.q), E::scales()) > larger(POSITION_JUMP, JUMP * led)
    }

    /// The change of a signal that is left to a dead point, where a step was refused so near to a singular position that this can be
    /// told; infinite otherwise.
    fn turn(&self, fault: Fault, steepness: f64, work: &mut Work) -> f64 {
        let is_near = self.at().steepest >= NEAR_TURN * steepness && matches!(fault, Fault::TooFar | Fault::Singular);
        let left = if is_near { self.until_turn(work) } else { f64::INFINITY };
        if left > 0.0 { left } else { f64::INFINITY }
    }

    /// The change of the signal that changes most, all others with it, to a dead point.
    fn until_turn(&self, work: &mut Work) -> f64 {
        let (at, m) = (self.at(), &self.model);
        let longest = m.way().length();
        let mut along = *m;
        along.way_mut().rates = m.way().direction().map(|change| change / longest);
        along.way_mut().accelerations = [0.0; K];
        let mut moving = *at;
        work.add(1);
        along.solve(&E::tears(&at.q), at.t, &at.sides, &mut moving);
        until_turn(&moving)
    }
}

/// How those coordinates change that Newton solves for, along a direction of the signals.
fn tears_along<E: Led<K>, const K: usize>(at: &Solution<E>, direction: &[f64; K]) -> E::Tears {
    sum(at.along.by_signal.each_ref().map(E::tears), direction)
}

/// How far positions are from what the slopes at both ends make of the way between, scaled.
fn gap<E: Led<K>, const K: usize>(from: &Solution<E>, at: &Solution<E>, v: &E::Tears, change: &[f64; K]) -> f64 {
    let (x, y, w) = (E::tears(&from.q), E::tears(&at.q), tears_along(at, change));
    let mut gaps = E::Tears::ZERO;
    let ways = y.as_ref().iter().zip(x.as_ref());
    let rates = v.as_ref().iter().zip(w.as_ref());
    for ((gap, (y, x)), (v, w)) in gaps.as_mut().iter_mut().zip(ways).zip(rates) {
        *gap = y - x - 0.5 * (v + w);
    }
    largest(&gaps, E::tear_scales())
}

/// What the motion since the solution before adds to the way `v` that the slopes of now make of a change of the signals: values and
/// slopes at two places make a cubic (Hermite). Where the signals turn elsewhere, the change of the slopes counts alone.
fn bend<E: Led<K>, const K: usize>(
    now: &Solution<E>,
    before: &Solution<E>,
    v: &E::Tears,
    change: &[f64; K],
) -> E::Tears {
    let (mut product, mut square, mut size) = (0.0, 0.0, 0.0);
    let behind = difference(&now.along.signals, &before.along.signals);
    for (behind, change) in behind.iter().zip(change) {
        product += behind * change;
        square += behind * behind;
        size += change * change;
    }
    let u = product / square;
    if u.is_nan() || u.abs() > FARTHEST_BEND {
        return E::Tears::ZERO;
    }
    let (x, y) = (E::tears(&now.q), E::tears(&before.q));
    let is_straight = size - u * product <= LARGEST_TURN * size;
    let mut bend = E::Tears::ZERO;
    if is_straight {
        let (v, w) = (tears_along(now, &behind), tears_along(before, &behind));
        let ways = x.as_ref().iter().zip(y.as_ref());
        let slopes = v.as_ref().iter().zip(w.as_ref());
        for ((bend, (x, y)), (v, w)) in bend.as_mut().iter_mut().zip(ways).zip(slopes) {
            let (value, slope) = (y - x + v, v - w);
            *bend = u * u * (3.0 * value - slope + u * (2.0 * value - slope));
        }
    } else {
        let w = tears_along(before, change);
        let slopes = v.as_ref().iter().zip(w.as_ref());
        for (bend, (v, w)) in bend.as_mut().iter_mut().zip(slopes) {
            *bend = 0.5 * u * (v - w);
        }
    }
    bend
}

/// Whether a position differs on the two sides of a place at which formulas change their branches: `at` is the later side, and `from`
/// has the branches of the earlier one.
fn jumps<M: Solved>(from: &Solution<M>, at: &Solution<M>, m: &M, work: &mut Work) -> bool {
    let mut before = *at;
    if find(&M::tears(&at.q), at, at.t, m, &from.sides, &mut before, work).is_err() {
        return true;
    }
    largest(&difference(&at.q, &before.q), M::scales()) > POSITION_JUMP
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
/// A position jumps that is so many times farther away than slopes lead.
pub const JUMP: f64 = 100.0;
/// Newton's first correction at most, beside the size of a body or 1 rad.
pub const LARGEST_CORRECTION: f64 = 0.05;
/// How far velocities may lead elsewhere than positions, likewise: more is another branch.
pub const LARGEST_GAP: f64 = 0.001;
/// The largest motion of a step, beside the size of a body or 1 rad.
pub const LARGEST_MOTION: f64 = 0.5;
/// Signals go straight on if the square of what leads aside is no larger part of that of the whole.
pub const LARGEST_TURN: f64 = 0.01;
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
/// Steps that `follow` takes at most.
pub const MOST_STEPS_TO_FOLLOW: usize = 64;
/// Corrections at most from far away.
pub const MOST_TRIALS: usize = 30;
/// A correction that is so small, scaled, is the last one from far away.
pub const NEAR: f64 = 0.02;
/// A dead point that is so near by a signal's change, while a longer step is refused, is not passed.
pub const NEAREST_TURN: f64 = 1e-6;
/// A dead point is no further off than this part of the span.
pub const NEAR_FOLD: f64 = 1e-5;
/// Where a step is refused, this is steep enough for a dead point to be looked for.
pub const NEAR_TURN: f64 = 10.0;
/// A position that changes by more than this at an edge jumps, scaled.
pub const POSITION_JUMP: f64 = 1e-9;
/// A speed below this part of one per span is rest, scaled.
pub const REST: f64 = 0.001;
/// The shortest step, as a part of the way of signals; of a long one, as a change of a signal.
pub const SHORTEST_STEP: f64 = 1e-12;
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
