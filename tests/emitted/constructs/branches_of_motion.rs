//! Kinematics of mechanism `arm`, written by mechc 0.1.0 from `branches_of_motion.mech`.
//!
//! - coordinates `q`: 6 (m, rad), equations `phi = 0`: 6
//! - `phi_q`: 7 entries that do not vanish, see [`PHI_Q_PATTERN`]
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
use runtime::pivoting::Pivoting;
use runtime::pivoting::close;
use runtime::pivoting::solve_with_pivoting;
use runtime::select::select;
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
pub const N: usize = 6;

/// Number of entries of `phi_q` that do not vanish.
pub const ENTRIES: usize = 7;

/// Coordinates (m, rad).
pub type Q = [f64; N];

/// Velocities (m/s, rad/s).
pub type Qd = [f64; N];

/// Accelerations (m/s^2, rad/s^2).
pub type Qdd = [f64; N];

/// Where each coordinate stands in `q`.
pub mod coordinate {
    /// `arm.x` (m), line 3
    pub const ARM_X: usize = 0;
    /// `arm.y` (m), line 3
    pub const ARM_Y: usize = 1;
    /// `arm.phi` (rad), line 3
    pub const ARM_PHI: usize = 2;
    /// `wheel.x` (m), line 5
    pub const WHEEL_X: usize = 3;
    /// `wheel.y` (m), line 5
    pub const WHEEL_Y: usize = 4;
    /// `wheel.phi` (rad), line 5
    pub const WHEEL_PHI: usize = 5;
}

/// Which equation each joint, constraint or driver wrote, and its unit.
pub mod row {
    /// joint `main 1` (m), line 4
    pub const MAIN_1: usize = 0;
    /// joint `main 2` (m), line 4
    pub const MAIN_2: usize = 1;
    /// joint `hub 1` (m), line 6
    pub const HUB_1: usize = 2;
    /// joint `hub 2` (m), line 6
    pub const HUB_2: usize = 3;
    /// constraint `follow` (a pure number), line 8
    pub const FOLLOW: usize = 4;
    /// driver `motor` (rad), line 7
    pub const MOTOR: usize = 5;
}

/// Row and column of each value that [`phi_q`] gives.
#[rustfmt::skip]
pub static PHI_Q_PATTERN: [(usize, usize); ENTRIES] = [
    (0, 0),
    (1, 1),
    (2, 3),
    (3, 4),
    (4, 2),
    (4, 5),
    (5, 2),
];

/// The bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// `arm`, line 3
    Arm,
    /// `wheel`, line 5
    Wheel,
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
            Body::Arm => Self { x: q[0], y: q[1], phi: q[2] },
            Body::Wheel => Self { x: q[3], y: q[4], phi: q[5] },
        }
    }
}

/// The residual of the equations, each in its unit: see [`row`].
///
/// 11 operations.
pub fn phi(q: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let arm_x = q[0];
    let arm_y = q[1];
    let wheel_x = q[3];
    let wheel_y = q[4];
    let arm_phi = q[2];
    let wheel_phi = q[5];

    let v1 = -arm_x;
    let v2 = -arm_y;
    let v3 = -wheel_x;
    let v4 = -wheel_y;
    let v5 = 2.0 * arm_phi;
    let v6 = -1.0 + v5;
    let v7 = arm_phi * arm_phi;
    let v8 = f64::from(arm_phi < 1.0);
    let v9 = select(v8, v7, v6);
    let v10 = wheel_phi - v9;
    let v11 = arm_phi - t;

    out[0] = v1;
    out[1] = v2;
    out[2] = v3;
    out[3] = v4;
    out[4] = v10;
    out[5] = v11;
    out
}

/// The Jacobian: the values of its entries, in the order of [`PHI_Q_PATTERN`] (the equation's unit per m or
/// rad).
///
/// 4 operations.
pub fn phi_q(q: &[f64; N], _t: f64, _p: &Params) -> [f64; ENTRIES] {
    let mut out = [0.0; ENTRIES];
    let arm_phi = q[2];

    let v1 = 2.0 * arm_phi;
    let v2 = f64::from(arm_phi < 1.0);
    let v3 = select(v2, v1, 2.0);
    let v4 = -v3;

    out[0] = -1.0;
    out[1] = -1.0;
    out[2] = -1.0;
    out[3] = -1.0;
    out[4] = v4;
    out[5] = 1.0;
    out[6] = 1.0;
    out
}

/// The partial derivative of `phi` by time (the equation's unit per s).
///
/// 0 operations.
pub fn phi_t(_q: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    out[5] = -1.0;
    out
}

/// Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).
///
/// 0 operations.
pub fn nu(_q: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    out[5] = 1.0;
    out
}

/// Right side of the acceleration equation `phi_q qdd = gamma` (the equation's unit per s^2).
///
/// 4 operations.
pub fn gamma(q: &[f64; N], qd: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let arm_phi = q[2];
    let arm_phi_d = qd[2];

    let v1 = f64::from(arm_phi < 1.0);
    let v2 = arm_phi_d * arm_phi_d;
    let v3 = 2.0 * v2;
    let v4 = select(v1, v3, 0.0);

    out[4] = v4;
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
pub const COLUMNS: usize = 19;

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
    1.0, 1.0, 1.0, 1.0,
    1.0, 1.0,
];

/// The assembled position (m, rad).
#[rustfmt::skip]
static START: [f64; N] = [
    0.0, 0.0, 0.0, 0.0,
    0.0, 0.0,
];

/// The mechanism with its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    params: Params,
}

/// Number of coordinates that Newton solves for; the others follow.
const TEARS: usize = 0;

/// What a change of each of them is judged against (m, or 1 rad).
static TEAR_SCALES: [f64; TEARS] = [];

/// Number of blocks of equations whose determinants change with the position.
const TURNS: usize = 0;

/// Whether they are negative where all pivots are positive.
static TURNED: [bool; TURNS] = [];

/// Number of places where formulas have branches.
const SIDES: usize = 1;

/// Which branch is taken at each: what a comparison gives, the number of a piece.
type Sides = [f64; SIDES];

/// Which of them time alone decides.
#[rustfmt::skip]
static IS_OF_TIME: [bool; SIDES] = [
    false,
];

/// The branches at a position, those of time being known.
///
/// 1 operations.
fn sides_of_motion(q: &[f64; N], _t: f64, _p: &Params, _sides: &Sides) -> [f64; SIDES] {
    let mut out = [0.0; SIDES];
    let arm_phi = q[2];

    let v1 = f64::from(arm_phi < 1.0);

    out[0] = v1;
    out
}

/// What solves the equations at a time.
type Solution = runtime::solution::Solution<Model>;

/// Position, velocity and acceleration at a time. Every coordinate follows from those before it.
///
/// 6 operations.
fn solve(_guess: &[f64; TEARS], t: f64, _m: &Model, sides: &Sides, at: &mut Solution) {
    at.begin(t);
    at.q[2] = t + 0.0;
    at.qd[2] = 1.0;
    let v1 = 2.0 * t;
    let v2 = -1.0 + v1;
    let v3 = t * t;
    let wheel_phi = select(sides[0], v3, v2);
    at.q[5] = wheel_phi + 0.0;
    let wheel_phi_d = select(sides[0], v1, 2.0);
    at.qd[5] = wheel_phi_d + 0.0;
    let wheel_phi_dd = select(sides[0], 2.0, 0.0);
    at.qdd[5] = wheel_phi_dd + 0.0;
}

/// As [`phi`], on branches of formulas that are given.
///
/// 10 operations.
fn phi_with(q: &[f64; N], t: f64, _p: &Params, sides: &Sides) -> [f64; N] {
    let mut out = [0.0; N];
    let arm_x = q[0];
    let arm_y = q[1];
    let wheel_x = q[3];
    let wheel_y = q[4];
    let arm_phi = q[2];
    let wheel_phi = q[5];

    let v1 = -arm_x;
    let v2 = -arm_y;
    let v3 = -wheel_x;
    let v4 = -wheel_y;
    let v5 = 2.0 * arm_phi;
    let v6 = -1.0 + v5;
    let v7 = arm_phi * arm_phi;
    let v8 = select(sides[0], v7, v6);
    let v9 = wheel_phi - v8;
    let v10 = arm_phi - t;

    out[0] = v1;
    out[1] = v2;
    out[2] = v3;
    out[3] = v4;
    out[4] = v9;
    out[5] = v10;
    out
}

/// As [`phi_q`], on branches of formulas that are given.
///
/// 3 operations.
fn phi_q_with(q: &[f64; N], _t: f64, _p: &Params, sides: &Sides) -> [f64; ENTRIES] {
    let mut out = [0.0; ENTRIES];
    let arm_phi = q[2];

    let v1 = 2.0 * arm_phi;
    let v2 = select(sides[0], v1, 2.0);
    let v3 = -v2;

    out[0] = -1.0;
    out[1] = -1.0;
    out[2] = -1.0;
    out[3] = -1.0;
    out[4] = v3;
    out[5] = 1.0;
    out[6] = 1.0;
    out
}

/// As [`nu`], on branches of formulas that are given.
///
/// 0 operations.
fn nu_with(_q: &[f64; N], _t: f64, _p: &Params, _sides: &Sides) -> [f64; N] {
    let mut out = [0.0; N];
    out[5] = 1.0;
    out
}

/// As [`gamma`], on branches of formulas that are given.
///
/// 3 operations.
fn gamma_with(_q: &[f64; N], qd: &[f64; N], _t: f64, _p: &Params, sides: &Sides) -> [f64; N] {
    let mut out = [0.0; N];
    let arm_phi_d = qd[2];

    let v1 = arm_phi_d * arm_phi_d;
    let v2 = 2.0 * v1;
    let v3 = select(sides[0], v2, 0.0);

    out[4] = v3;
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

    fn phi(&self, q: &Q, t: f64, sides: &Sides) -> Q {
        phi_with(q, t, &self.params, sides)
    }

    fn phi_q(&self, q: &Q, t: f64, sides: &Sides) -> Self::Entries {
        phi_q_with(q, t, &self.params, sides)
    }

    fn nu(&self, q: &Q, t: f64, sides: &Sides) -> Q {
        nu_with(q, t, &self.params, sides)
    }

    fn gamma(&self, q: &Q, qd: &Qd, t: f64, sides: &Sides) -> Qdd {
        gamma_with(q, qd, t, &self.params, sides)
    }
}

impl Branches for Model {
    const OF_MOTION: bool = true;

    fn is_of_time() -> &'static [bool] {
        &IS_OF_TIME
    }

    fn sides_of_motion(&self, q: &Q, t: f64, sides: &Sides) -> Sides {
        sides_of_motion(q, t, &self.params, sides)
    }
}

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
    fn tears(_q: &Q) -> Self::Tears {
        []
    }

    fn solve(&self, guess: &Self::Tears, t: f64, sides: &Sides, at: &mut Solution) {
        solve(guess, t, self, sides, at);
    }

    fn pivoted(&self, q: &Q, t: f64, sides: &Sides, _at: &Solution) -> Result<Solution, Fault> {
        solve_with_pivoting(self, q, t, sides)
    }
}

/// The width of a cell of each coordinate's grid.
#[rustfmt::skip]
static CELLS: [f64; N] = [
    7.450580596923828e-9, 7.450580596923828e-9, 7.450580596923828e-9, 7.450580596923828e-9,
    7.450580596923828e-9, 7.450580596923828e-9,
];

/// Number of blocks of equations that can be solved one after the other.
const BLOCKS: usize = 6;

/// The blocks whose determinants change.
static TURNING: [usize; TURNS] = [];

/// Numbers that the elimination of the largest block works on.
const WORK: usize = work_of(1);

/// How the equations fall apart into blocks.
#[rustfmt::skip]
static EQUATIONS: Blocks<'static> = Blocks {
    sizes: &[
        1, 1, 1, 1,
        1, 1,
    ],
    rows: &[
        0, 1, 2, 3,
        5, 4,
    ],
    columns: &[
        0, 1, 3, 4,
        2, 5,
    ],
    starts: &[
        0, 1, 2, 3,
        4, 6, 7,
    ],
    entries: &[
        0, 1, 3, 4,
        2, 5, 2,
    ],
    places: &[
        0, 1, 4, 2,
        3, 5,
    ],
    units: &[
        1.0, 1.0, 1.0, 1.0,
        1.0, 1.0,
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
    [0.0; N]
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
