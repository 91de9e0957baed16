//! Kinematics of mechanism `four_bar`, written by mechc 0.1.0 from `four_bar.mech`.
//!
//! - coordinates `q`: 9 (m, rad), equations `phi = 0`: 9
//! - `phi_q`: 21 entries that do not vanish, see [`PHI_Q_PATTERN`]
//! - parameters: 0; those that follow from others are worked out
//! - the motion: [`assemble`], then [`step`] from time to time
//! - needs no other crate
//! - needs no heap and no standard library; nothing in it panics
//!
//! This code carries no licence of mechc's: use, change and pass it on as you like.

#![allow(clippy::approx_constant, clippy::eq_op)]
#![allow(clippy::excessive_precision, clippy::large_const_arrays)]

/// The mechanism has no parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Params;

impl Params {
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
    /// `crank.x` (m), line 7
    pub const CRANK_X: usize = 0;
    /// `crank.y` (m), line 7
    pub const CRANK_Y: usize = 1;
    /// `crank.phi` (rad), line 7
    pub const CRANK_PHI: usize = 2;
    /// `coupler.x` (m), line 11
    pub const COUPLER_X: usize = 3;
    /// `coupler.y` (m), line 11
    pub const COUPLER_Y: usize = 4;
    /// `coupler.phi` (rad), line 11
    pub const COUPLER_PHI: usize = 5;
    /// `rocker.x` (m), line 17
    pub const ROCKER_X: usize = 6;
    /// `rocker.y` (m), line 17
    pub const ROCKER_Y: usize = 7;
    /// `rocker.phi` (rad), line 17
    pub const ROCKER_PHI: usize = 8;
}

/// Which equation each joint, constraint or driver wrote.
pub mod row {
    /// joint `main 1`, line 22
    pub const MAIN_1: usize = 0;
    /// joint `main 2`, line 22
    pub const MAIN_2: usize = 1;
    /// joint `pin 1`, line 23
    pub const PIN_1: usize = 2;
    /// joint `pin 2`, line 23
    pub const PIN_2: usize = 3;
    /// joint `knee 1`, line 24
    pub const KNEE_1: usize = 4;
    /// joint `knee 2`, line 24
    pub const KNEE_2: usize = 5;
    /// joint `pivot 1`, line 25
    pub const PIVOT_1: usize = 6;
    /// joint `pivot 2`, line 25
    pub const PIVOT_2: usize = 7;
    /// driver `motor`, line 27
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
    /// `crank`, line 7
    Crank,
    /// `coupler`, line 11
    Coupler,
    /// `rocker`, line 17
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

/// The residual of the equations (m, m^2 or rad).
///
/// 28 operations.
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

    let v1 = 2.0 * t;
    let v2 = 0.5 + v1;
    let (s3, c3) = sin_cos(crank_phi);
    let v4 = -crank_x;
    let v5 = -crank_y;
    let v6 = c3 + crank_x;
    let v7 = s3 + crank_y;
    let (s8, c8) = sin_cos(coupler_phi);
    let v9 = v6 - coupler_x;
    let v10 = v7 - coupler_y;
    let v11 = 3.5 * c8;
    let v12 = 3.5 * s8;
    let v13 = coupler_x + v11;
    let v14 = coupler_y + v12;
    let (s15, c15) = sin_cos(rocker_phi);
    let v16 = 1.5 * c15;
    let v17 = 1.5 * s15;
    let v18 = v16 + rocker_x;
    let v19 = v17 + rocker_y;
    let v20 = v13 - v18;
    let v21 = v14 - v19;
    let v22 = -1.5 * c15;
    let v23 = -1.5 * s15;
    let v24 = rocker_x + v22;
    let v25 = rocker_y + v23;
    let v26 = 4.0 - v24;
    let v27 = -v25;
    let v28 = crank_phi - v2;

    out[0] = v4;
    out[1] = v5;
    out[2] = v9;
    out[3] = v10;
    out[4] = v20;
    out[5] = v21;
    out[6] = v26;
    out[7] = v27;
    out[8] = v28;
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
    out[8] = -2.0;
    out
}

/// Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).
///
/// 0 operations.
pub fn nu(_q: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    out[8] = 2.0;
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

/// Number of results at a time.
pub const COLUMNS: usize = 28;

/// Why a mechanism could not be brought to a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Error {
    /// The time, a parameter or a formula is not a number.
    NotANumber,
    /// A driver has come to a position beyond which the mechanism cannot follow it: a dead point.
    LockUp,
    /// Two branches of the motion meet: which one goes on is not determined.
    Bifurcation,
    /// Newton's iteration does not arrive, however short the step.
    Divergence,
    /// The steps that were allowed do not lead so far; nothing is wrong with the motion up to here.
    TooFar,
    /// At a time where a formula of time goes over to another branch, a position or velocity jumps.
    NotSmooth,
    /// An equation that was left out as redundant does not hold beside the others.
    Inconsistent,
}

impl core::fmt::Display for Error {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Error::NotANumber => "the time, a parameter or a formula is not a number",
            Error::LockUp => "the mechanism locks up: its driver cannot go on",
            Error::Bifurcation => "two branches of the motion meet",
            Error::Divergence => "the motion cannot be followed",
            Error::TooFar => "the time is too far away for so few steps",
            Error::NotSmooth => "a position or velocity jumps",
            Error::Inconsistent => "an equation that was left out as redundant does not hold",
        })
    }
}

impl core::error::Error for Error {}

/// The mechanism at a time.
#[derive(Clone, Debug)]
pub struct State {
    model: Model,
    /// The solution of now and the one before, or the next one in the making.
    solutions: [Solution; 2],
    /// Whether that of now is the second.
    is_second: bool,
    /// Whether the one before lies on the same smooth motion.
    is_smooth: bool,
    /// How much steeper these parameters make the equations than the file's.
    steepness: f64,
    /// The step that goes well (s).
    step: f64,
}

impl State {
    /// The solution of now.
    fn at(&self) -> &Solution {
        let [first, second] = &self.solutions;
        if self.is_second { second } else { first }
    }

    /// The time (s).
    #[must_use]
    pub fn t(&self) -> f64 {
        self.at().t
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &Params {
        &self.model.params
    }

    /// The coordinates (m, rad), by the indices in [`coordinate`].
    #[must_use]
    pub fn q(&self) -> &Q {
        &self.at().q
    }

    /// Their velocities (m/s, rad/s).
    #[must_use]
    pub fn qd(&self) -> &Qd {
        &self.at().qd
    }

    /// Their accelerations (m/s^2, rad/s^2).
    #[must_use]
    pub fn qdd(&self) -> &Qdd {
        &self.at().qdd
    }

    /// Where a body is (m, m, rad).
    #[must_use]
    pub fn pose(&self, body: Body) -> Pose {
        Pose::of(&self.at().q, body)
    }

    /// How fast a body moves (m/s, m/s, rad/s).
    #[must_use]
    pub fn velocity(&self, body: Body) -> Pose {
        Pose::of(&self.at().qd, body)
    }

    /// How a body's velocity changes (m/s^2, m/s^2, rad/s^2).
    #[must_use]
    pub fn acceleration(&self, body: Body) -> Pose {
        Pose::of(&self.at().qdd, body)
    }

    /// All results, in the order of the columns of `mechc run`: the time, coordinates and measures,
    /// then their first and their second derivatives.
    #[must_use]
    pub fn row(&self) -> [f64; COLUMNS] {
        let at = self.at();
        let all = at.q.iter().chain(&at.qd).chain(&at.qdd);
        let mut row = [at.t; COLUMNS];
        for (cell, value) in row.iter_mut().skip(1).zip(all) {
            *cell = *value;
        }
        row
    }
}

/// The first time of the file's analysis (s), at which the mechanism is assembled.
pub const START_TIME: f64 = 0.0;

/// How long the file's analysis takes (s).
const SPAN: f64 = 3.2;

/// The longest step (s).
pub const LONGEST_STEP: f64 = 0.1;

/// The shortest step (s).
const SMALLEST_STEP: f64 = 3.2e-12;

/// Iterations of Newton at most.
const ITERATIONS: usize = 6;

/// Newton's first correction at most, beside the size of a body or 1 rad.
const LARGEST_CORRECTION: f64 = 0.05;

/// A correction of just half a cell of the grid, to rounding, stays in it.
const HALF_A_CELL: f64 = 0.500001;

/// Number of coordinates that Newton solves for; the others follow.
const TEARS: usize = 2;

/// What a change of each of them is judged against (m, or 1 rad).
#[rustfmt::skip]
static TEAR_SCALES: [f64; TEARS] = [
    1.0, 1.0,
];

/// The width of a cell of the grid of each of them.
#[rustfmt::skip]
static TEAR_CELLS: [f64; TEARS] = [
    7.450580596923828e-9, 7.450580596923828e-9,
];

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
    0.0, 0.0, 0.5, 0.8775825618903728,
    0.479425538604203, 0.7771164948091609, 3.68643363770732, 1.466859276290175,
    1.7813938323744904,
];

/// Number of blocks of equations whose determinants change with the position.
const TURNS: usize = 1;

/// Whether they are negative where all pivots are positive.
#[rustfmt::skip]
static TURNED: [bool; TURNS] = [
    false,
];

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
const WORK: usize = blocks::work_of(4);

/// What may be left of an equation, beside the norm of its row.
const TOLERANCE: f64 = 1e-12;

/// How the equations fall apart into blocks.
#[rustfmt::skip]
static EQUATIONS: blocks::Blocks<'static> = blocks::Blocks {
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

/// The mechanism with its parameters.
#[derive(Clone, Debug)]
struct Model {
    params: Params,
}

impl Model {
    fn new(params: &Params) -> Self {
        Self { params: *params }
    }
}

/// Steps that one call of [`step`] takes at most.
pub const MOST_STEPS: usize = 1_000_000;

/// Trials on the way from the file's parameters to others at most, and the smallest part of it.
const MOST_PARTS: usize = 10_000;
const SMALLEST_PART: f64 = 1e-6;

/// The largest motion of a step, beside the size of a body or 1 rad.
const LARGEST_MOTION: f64 = 0.5;

/// The step before tells of one that is so many times as long at most.
const FARTHEST_BEND: f64 = 4.0;

/// How far velocities may lead elsewhere than positions, likewise: more is another branch.
const LARGEST_GAP: f64 = 1e-3;

/// One over a pivot, scaled: beyond the first the position is looked at more closely, beyond the
/// second it is too near to a singular one.
const STEEP: f64 = 1e3;
const STEEPEST: f64 = 1e6;

/// Rounding may make so much of velocities and accelerations that are given out.
const ACCURACY: f64 = 1e-9;

/// Where steps become too small, this is steep enough for a singular position to be the reason.
const SINGULAR: f64 = 1e2;

/// A dead point is no further off than this part of the span.
const NEAR_FOLD: f64 = 1e-5;

/// Brings the mechanism to its first time with some parameters, along the branch that the file's
/// parameters give.
///
/// # Errors
/// It cannot be assembled with these, or not on that branch.
pub fn assemble(params: &Params) -> Result<State, Error> {
    if !params.is_finite() {
        return Err(Error::NotANumber);
    }
    let file = Params;
    let mut at = Solution::ZERO;
    start(&START, &Model::new(&file), &mut at).map_err(Fault::at_start)?;
    let mut found = at.clone();
    let usual = at.steepest;
    let mut why = Error::Divergence;
    // the part of the way from the file's parameters to those that are wanted
    let (mut done, mut part) = (0.0, 1.0);
    for _ in 0..MOST_PARTS {
        let next = f64::min(done + part, 1.0);
        let params = if next < 1.0 {
            file.towards(params, next)
        } else {
            *params
        };
        let model = Model::new(&params);
        let result = start(&at.q, &model, &mut found);
        if result.is_ok() && found.is_negative == at.is_negative {
            if next >= 1.0 {
                let ratio = found.steepest / usual;
                let steepness = if ratio > 0.0 { ratio } else { 1.0 };
                return Ok(State {
                    steepness,
                    model,
                    solutions: [found, at],
                    is_second: false,
                    is_smooth: false,
                    step: LONGEST_STEP,
                });
            }
            at.clone_from(&found);
            (done, part) = (next, 2.0 * part);
        } else {
            why = result.err().map_or(Error::Divergence, Fault::at_start);
            part *= 0.5;
        }
        if part < SMALLEST_PART {
            break;
        }
    }
    Err(why)
}

/// Solves at the first time, from a position nearby.
fn start(q: &Q, m: &Model, at: &mut Solution) -> Result<(), Fault> {
    let mut near = Solution::ZERO;
    (near.t, near.q) = (START_TIME, *q);
    reach(&tears(q), &near, START_TIME, m, at)?;
    if at.first <= LARGEST_CORRECTION {
        Ok(())
    } else {
        Err(Fault::TooFar)
    }
}

/// Moves a state to time `t` (s), in steps as short as the motion asks for: position, velocity
/// and acceleration are those of the branch that it is on, whichever way `t` lies.
///
/// It takes [`MOST_STEPS`] steps at most, and mostly one; [`step_within`] takes as many as it is
/// allowed. What a driver does and undoes within a
/// step, by formulas without branches, is not seen: no step is longer than [`LONGEST_STEP`].
///
/// # Errors
/// Why it cannot get there; the state stays at the last time that it could reach.
pub fn step(t: f64, state: &mut State) -> Result<(), Error> {
    step_within(t, state, MOST_STEPS)
}

/// As [`step`], in so many steps at most, for those who have a deadline: each solves the equations
/// about once, and one that has to be made shorter counts as well.
///
/// # Errors
/// Why it cannot get there; the state stays at the last time that it could reach. Where that is
/// [`Error::TooFar`] the same call goes on from there.
pub fn step_within(t: f64, state: &mut State, most: usize) -> Result<(), Error> {
    if !(t - state.at().t).is_finite() {
        return Err(Error::NotANumber);
    }
    for _ in 0..most {
        let now = state.at().t;
        let left = t - now;
        if left == 0.0 {
            return Ok(());
        }
        // no crumb at the end
        let next = if state.step >= 0.999 * left.abs() {
            t
        } else {
            now + state.step.copysign(left)
        };
        let (is_last, size) = (next == t, (next - now).abs());
        match advance(state, next, is_last) {
            Ok(is_calm) => {
                let longest = if is_calm {
                    state.step.max(2.0 * size)
                } else {
                    state.step.min(size)
                };
                state.step = longest.min(LONGEST_STEP);
                if is_last {
                    return Ok(());
                }
            }
            Err(fault) => {
                state.step = 0.5 * size;
                state.is_smooth = false;
                if state.step < SMALLEST_STEP || now + state.step == now {
                    state.step = SMALLEST_STEP;
                    return Err(explain(state, fault, next));
                }
            }
        }
    }
    if state.at().t == t {
        Ok(())
    } else {
        Err(Error::TooFar)
    }
}

/// Why a step is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    /// Something is not a number.
    NotANumber,
    /// The step is too long for the motion.
    TooFar,
    /// The position is on another branch, or too near to one.
    Singular,
}

impl Fault {
    /// Why a mechanism cannot be assembled.
    fn at_start(self) -> Error {
        match self {
            Self::NotANumber => Error::NotANumber,
            _ => Error::Divergence,
        }
    }
}

/// One step to a time; says whether a longer one would do as well.
fn advance(state: &mut State, t: f64, is_wanted: bool) -> Result<bool, Fault> {
    let [first, second] = &mut state.solutions;
    let (from, at) = if state.is_second {
        (second, first)
    } else {
        (first, second)
    };
    let from = &*from;
    let h = t - from.t;
    let (x, v, a) = (tears(&from.q), tears(&from.qd), tears(&from.qdd));
    let mut way = if state.is_smooth {
        bend(from, at, h)
    } else {
        [0.0; TEARS]
    };
    let mut guess = x;
    let rates = v.iter().zip(&a);
    for ((way, guess), (v, a)) in way.iter_mut().zip(&mut guess).zip(rates) {
        // Taylor
        *way += h * (v + 0.5 * h * a);
        *guess += *way;
    }
    // what is not a number is not small either
    let is_short = largest(&way, &TEAR_SCALES) <= LARGEST_MOTION;
    if !is_short {
        return Err(Fault::TooFar);
    }
    reach(&guess, from, t, &state.model, at)?;
    // what both ends' velocities and accelerations make of the way between (Hermite)
    let (y, w, b) = (tears(&at.q), tears(&at.qd), tears(&at.qdd));
    let mut gaps = [0.0; TEARS];
    let (ways, rates, bends) = (y.iter().zip(&x), v.iter().zip(&w), a.iter().zip(&b));
    for ((gap, (y, x)), ((v, w), (a, b))) in gaps.iter_mut().zip(ways).zip(rates.zip(bends)) {
        *gap = y - x - 0.5 * h * (v + w) - h * h * (1.0 / 12.0) * (a - b);
    }
    let gap = largest(&gaps, &TEAR_SCALES);
    let is_near = at.first <= LARGEST_CORRECTION && gap <= LARGEST_GAP;
    if !is_near {
        return Err(Fault::TooFar);
    }
    let steepest = at.steepest / state.steepness;
    if at.is_negative != from.is_negative || steepest > STEEPEST {
        return Err(Fault::Singular);
    }
    if is_wanted && steepest > STEEP && steepest * rounding(at, &state.model) > ACCURACY {
        return Err(Fault::Singular);
    }
    state.is_smooth = true;
    state.is_second = !state.is_second;
    Ok(at.first < LARGEST_CORRECTION / 12.0 && gap < LARGEST_GAP / 100.0)
}

/// What the motion since the solution before adds to Taylor's way over a time `h` (s): value,
/// velocity and acceleration at two times make a polynomial of degree 5 (Hermite).
fn bend(now: &Solution, before: &Solution, h: f64) -> [f64; TEARS] {
    let back = now.t - before.t;
    let u = h / back;
    if u.is_nan() || u.abs() > FARTHEST_BEND {
        return [0.0; TEARS];
    }
    let (x, v, a) = (tears(&now.q), tears(&now.qd), tears(&now.qdd));
    let (y, w, b) = (tears(&before.q), tears(&before.qd), tears(&before.qdd));
    let mut bend = [0.0; TEARS];
    let (ways, rates, bends) = (x.iter().zip(&y), v.iter().zip(&w), a.iter().zip(&b));
    for ((bend, (x, y)), ((v, w), (a, b))) in bend.iter_mut().zip(ways).zip(rates.zip(bends)) {
        let value = y - x + back * (v - 0.5 * back * a);
        let slope = back * (v - back * a - w);
        let curvature = 0.5 * back * back * (b - a);
        let cubic = 4.0 * slope - 10.0 * value - curvature;
        let quartic = 7.0 * slope - 15.0 * value - 2.0 * curvature;
        let quintic = 3.0 * slope - 6.0 * value - curvature;
        *bend = u * u * u * (cubic + u * (quartic + u * quintic));
    }
    bend
}

/// The largest value beside its scale; what is not a number wins.
fn largest<const K: usize>(values: &[f64; K], scales: &[f64; K]) -> f64 {
    let pairs = values.iter().zip(scales);
    let sizes = pairs.map(|(value, scale)| value.abs() / scale);
    sizes.fold(0.0, larger)
}

/// The larger one; what is not a number wins.
fn larger(a: f64, b: f64) -> f64 {
    if b <= a { a } else { b }
}

/// Solves at a time, from a guess; `from` is where the motion comes from.
fn reach(
    guess: &[f64; TEARS],
    from: &Solution,
    t: f64,
    m: &Model,
    at: &mut Solution,
) -> Result<(), Fault> {
    solve(guess, t, m, at);
    if !at.is_settled || !at.holds {
        // once more from a position that is known, and if that does not help either, that
        let h = t - from.t;
        let mut q = from.q;
        for ((q, qd), qdd) in q.iter_mut().zip(&from.qd).zip(&from.qdd) {
            *q += h * (qd + 0.5 * h * qdd);
        }
        let pivoted = solve_with_pivoting(&q, t, m)?;
        solve(&tears(&pivoted.q), t, m, at);
        let first = pivoted.first;
        if !at.is_settled || !at.holds {
            *at = pivoted;
        }
        at.first = first;
    }
    if at.is_finite() {
        Ok(())
    } else {
        Err(Fault::NotANumber)
    }
}

/// What rounding makes of the velocities and accelerations, for every unit of steepness: they are
/// amplified by as much as the position is near to a singular one.
fn rounding(at: &Solution, m: &Model) -> f64 {
    let p = &m.params;
    let slopes = phi_q(&at.q, at.t, p);
    let mut norms = [f64::MIN_POSITIVE; N];
    for (&(row, column), slope) in PHI_Q_PATTERN.iter().zip(slopes) {
        if let (Some(norm), Some(scale)) = (norms.get_mut(row), SCALES.get(column)) {
            *norm = larger(*norm, slope.abs() * scale);
        }
    }
    let ratio = |left: f64, right: f64| if right > 0.0 { left / right } else { 1.0 };
    let nu = nu(&at.q, at.t, p);
    let velocity = ratio(largest(&at.qd, &SCALES), largest(&nu, &norms));
    let gamma = gamma(&at.q, &at.qd, at.t, p);
    let acceleration = ratio(largest(&at.qdd, &SCALES), largest(&gamma, &norms));
    let amplified = larger(larger(velocity, acceleration), 1.0);
    f64::EPSILON * amplified
}

/// Why even the shortest step from a state towards a time is refused.
fn explain(state: &State, fault: Fault, t: f64) -> Error {
    let (at, p) = (state.at(), &state.model.params);
    let values = phi(&at.q, t, p);
    if fault == Fault::NotANumber || values.iter().any(|value| !value.is_finite()) {
        return Error::NotANumber;
    }
    if at.steepest < SINGULAR * state.steepness {
        return Error::Divergence;
    }
    // a motion that comes to a dead point after a time u is as the root of u, whose slope over
    // twice its curvature is u
    let rates = at.qd.iter().zip(&at.qdd).zip(&SCALES);
    let sooner = |(speed, left): (f64, f64), ((v, a), scale): ((&f64, &f64), &f64)| {
        if v.abs() / scale > speed {
            (v.abs() / scale, 0.5 * v / a)
        } else {
            (speed, left)
        }
    };
    let (_, left) = rates.fold((0.0, 0.0), sooner);
    let left = if t < at.t { -left } else { left };
    if left > 0.0 && left < NEAR_FOLD * SPAN {
        Error::LockUp
    } else {
        Error::Bifurcation
    }
}

/// What solves the equations at a time.
#[derive(Clone, Debug)]
struct Solution {
    t: f64,
    q: Q,
    qd: Qd,
    qdd: Qdd,
    /// By block of equations: whether its determinant is negative.
    is_negative: [bool; TURNS],
    /// Whether Newton has arrived.
    is_settled: bool,
    /// Whether no digits were lost, and the equations hold.
    holds: bool,
    /// Newton's largest first correction, scaled.
    first: f64,
    /// One over the smallest pivot, scaled.
    steepest: f64,
}

impl Solution {
    const ZERO: Self = Self {
        t: 0.0,
        q: [0.0; N],
        qd: [0.0; N],
        qdd: [0.0; N],
        is_negative: [false; TURNS],
        is_settled: true,
        holds: true,
        first: 0.0,
        steepest: 0.0,
    };

    /// Makes ready for being solved for.
    fn begin(&mut self, t: f64) {
        self.t = t;
        self.is_negative = TURNED;
        (self.is_settled, self.holds) = (true, true);
        (self.first, self.steepest) = (0.0, 0.0);
    }

    /// Takes over how an iteration went.
    fn note(&mut self, newton: &Newton) {
        self.is_settled &= newton.has_settled;
        self.first = larger(self.first, newton.first);
    }

    /// Takes note of one over a pivot, and of what makes that a pure number.
    fn pivot(&mut self, turn: usize, inverse: f64, weight: f64) {
        if let Some(is_negative) = self.is_negative.get_mut(turn) {
            *is_negative ^= inverse < 0.0;
        }
        self.steepest = larger(self.steepest, inverse.abs() * weight);
    }

    /// Why it cannot be used.
    fn fault(&self) -> Fault {
        if self.is_finite() {
            Fault::TooFar
        } else {
            Fault::NotANumber
        }
    }

    fn is_finite(&self) -> bool {
        let mut all = self.q.iter().chain(&self.qd).chain(&self.qdd);
        all.all(|value| value.is_finite())
    }
}

/// An iteration of Newton from grid point to grid point, so that where it begins leaves no trace
/// in where it ends.
struct Newton {
    is_first: bool,
    is_open: bool,
    is_lost: bool,
    has_settled: bool,
    first: f64,
}

impl Newton {
    fn new() -> Self {
        Self {
            is_first: true,
            is_open: false,
            is_lost: false,
            has_settled: false,
            first: 0.0,
        }
    }

    /// A coordinate with its correction; its grid has cells so wide, and it is judged against `scale`.
    fn corrected(&mut self, x: f64, delta: f64, cell: f64, scale: f64) -> f64 {
        let size = delta.abs();
        if self.is_first {
            self.first = larger(self.first, size / scale);
        }
        self.is_open |= size > HALF_A_CELL * cell;
        self.is_lost |= size.is_nan() || size > LARGEST_CORRECTION * scale;
        x + delta
    }

    /// Whether no further iteration is needed, or none helps.
    fn is_done(&mut self) -> bool {
        self.has_settled = !self.is_open && !self.is_lost;
        let is_done = self.has_settled || self.is_lost;
        (self.is_first, self.is_open) = (false, false);
        is_done
    }
}

/// The grid point next to a value.
fn on_grid(x: f64, cell: f64) -> f64 {
    // adding and taking away 1.5 * 2^52 cells rounds to a whole number of them
    let rounding = 6_755_399_441_055_744.0 * cell;
    (x + rounding) - rounding
}

/// The solution by elimination with partial pivoting, where the order that [`solve`] has loses
/// digits. All coordinates lie on a grid while Newton goes on.
fn solve_with_pivoting(q: &Q, t: f64, m: &Model) -> Result<Solution, Fault> {
    let p = &m.params;
    let mut at = Solution::ZERO;
    (at.t, at.q) = (t, *q);
    let mut elimination = Elimination::new();
    let mut is_settled = false;
    for iteration in 0..ITERATIONS {
        for (q, cell) in at.q.iter_mut().zip(&CELLS) {
            *q = on_grid(*q, *cell);
        }
        let slopes = phi_q(&at.q, t, p);
        let right = phi(&at.q, t, p).map(|value| -value);
        let (x, _) = elimination.solve(&slopes, &right);
        if iteration == 0 {
            at.first = largest(&x, &SCALES);
        }
        is_settled = largest(&x, &CELLS) <= HALF_A_CELL;
        at.q.iter_mut().zip(&x).for_each(|(q, x)| *q += x);
        if is_settled {
            break;
        }
    }
    if !is_settled {
        return Err(at.fault());
    }
    let slopes = phi_q(&at.q, t, p);
    let (qd, pivot) = elimination.solve(&slopes, &nu(&at.q, t, p));
    let (qdd, _) = elimination.solve(&slopes, &gamma(&at.q, &qd, t, p));
    (at.qd, at.qdd) = (qd.map(|x| x + 0.0), qdd.map(|x| x + 0.0));
    let values = phi(&at.q, t, p);
    at.holds = is_next_to_nothing(&values, &slopes, &at.q);
    at.q = at.q.map(|x| x + 0.0);
    at.steepest = 1.0 / pivot;
    let negative = &elimination.is_negative;
    for (turned, block) in at.is_negative.iter_mut().zip(&TURNING) {
        *turned = negative.get(*block).copied().unwrap_or(false);
    }
    if at.holds { Ok(at) } else { Err(Fault::TooFar) }
}

/// The work of solving linear equations in blocks.
struct Elimination {
    work: [f64; WORK],
    is_negative: [bool; BLOCKS],
}

impl Elimination {
    fn new() -> Self {
        Self {
            work: [0.0; WORK],
            is_negative: [false; BLOCKS],
        }
    }

    /// The solution for a right side, and the smallest pivot.
    fn solve(&mut self, slopes: &[f64; ENTRIES], right: &[f64; N]) -> ([f64; N], f64) {
        let mut x = [0.0; N];
        let (work, is_negative) = (&mut self.work, &mut self.is_negative);
        let pivot = blocks::solve(&EQUATIONS, slopes, right, &mut x, work, is_negative);
        (x, pivot)
    }
}

/// Whether what is left of the equations is within their tolerance, and what rounding makes of
/// the coordinates.
fn is_next_to_nothing(values: &[f64; N], slopes: &[f64; ENTRIES], q: &Q) -> bool {
    let mut bounds = [0.0; N];
    for (&(row, column), slope) in PHI_Q_PATTERN.iter().zip(slopes) {
        let sizes = (SCALES.get(column), q.get(column), bounds.get_mut(row));
        if let (Some(scale), Some(q), Some(bound)) = sizes {
            *bound += TOLERANCE * (slope * scale).abs() + 8.0 * f64::EPSILON * (slope * q).abs();
        }
    }
    let mut pairs = values.iter().zip(&bounds);
    pairs.all(|(value, bound)| value.abs() <= *bound)
}

/// Of all coordinates those that Newton solves for.
#[rustfmt::skip]
fn tears(q: &[f64; N]) -> [f64; TEARS] {
    [
        q[8], q[5],
    ]
}

/// Position, velocity and acceleration at a time. Newton begins with a guess of `rocker.phi`,
/// `coupler.phi`; all else follows.
///
/// 101 operations.
fn solve(guess: &[f64; TEARS], t: f64, _m: &Model, at: &mut Solution) {
    at.begin(t);
    let crank_phi = 2.0 * t + 0.5;
    at.q[2] = crank_phi + 0.0;
    at.qd[2] = 2.0;
    let (coupler_y, coupler_x) = sin_cos(crank_phi);
    at.q[3] = coupler_x + 0.0;
    let v3 = coupler_y * 2.0;
    let coupler_x_d = -v3;
    at.qd[3] = coupler_x_d + 0.0;
    let v5 = coupler_x * 2.0;
    let v6 = 2.0 * v5;
    let coupler_x_dd = -v6;
    at.qdd[3] = coupler_x_dd + 0.0;
    at.q[4] = coupler_y + 0.0;
    let coupler_y_d = coupler_x * 2.0;
    at.qd[4] = coupler_y_d + 0.0;
    let v9 = coupler_y * 2.0;
    let v10 = 2.0 * v9;
    let coupler_y_dd = -v10;
    at.qdd[4] = coupler_y_dd + 0.0;
    let mut x1 = guess[0];
    let mut x2 = guess[1];
    let mut s12 = 0.0;
    let mut c12 = 0.0;
    let mut s16 = 0.0;
    let mut c16 = 0.0;
    let mut v34 = 0.0;
    let mut v37 = 0.0;
    let mut newton = Newton::new();
    for _ in 0..ITERATIONS {
        x1 = on_grid(x1, 7.450580596923828e-9);
        x2 = on_grid(x2, 7.450580596923828e-9);
        (s12, c12) = sin_cos(x1);
        let v13 = -1.5 * c12;
        let v14 = 4.0 - v13;
        let v15 = -1.5 * s12;
        (s16, c16) = sin_cos(x2);
        let v17 = -3.5 * s16;
        let v18 = 1.5 * s12;
        let v19 = 3.5 * c16;
        let v20 = 1.5 * c12;
        let v21 = v13 - v20;
        let v22 = v18 - v15;
        let v23 = v22 * v19;
        let v24 = v23 - v17 * v21;
        let v25 = 1.0 / v24;
        let v26 = v20 + v14;
        let v27 = coupler_x + v19;
        let v28 = v27 - v26;
        let v29 = v18 - v15;
        let v30 = 3.5 * s16 + coupler_y;
        let v31 = v30 - v29;
        let v32 = v17 * v31;
        let v33 = v32 - v19 * v28;
        v34 = v33 * v25;
        let v35 = v21 * v28;
        let v36 = v35 - v22 * v31;
        v37 = v36 * v25;
        x1 = newton.corrected(x1, v34, 7.450580596923828e-9, 1.0);
        x2 = newton.corrected(x2, v37, 7.450580596923828e-9, 1.0);
        if newton.is_done() {
            break;
        }
    }
    at.note(&newton);
    let v38 = 0.5 * v34;
    let v39 = c12 - v38 * s12;
    let v40 = v34 * v39 + s12;
    let v41 = v38 * c12 + s12;
    let v42 = c12 - v34 * v41;
    let v43 = -1.5 * v42;
    let rocker_x = 4.0 - v43;
    let v45 = -1.5 * v40;
    let v46 = 1.5 * v42;
    let v47 = v46 + rocker_x;
    let v48 = 0.5 * v37;
    let v49 = c16 - v48 * s16;
    let v50 = v37 * v49 + s16;
    let v51 = v48 * c16 + s16;
    let v52 = c16 - v37 * v51;
    let v53 = 3.5 * v52;
    let v54 = coupler_x + v53;
    let v55 = v54 - v47;
    at.holds &= v55.abs() <= 5.431051194661191e-12;
    let v56 = 1.5 * v40;
    let v57 = v56 - v45;
    let v58 = 3.5 * v50 + coupler_y;
    let v59 = v58 - v57;
    at.holds &= v59.abs() <= 5.254612990866269e-12;
    let v60 = -3.5 * v50;
    let v61 = v43 - v46;
    let v62 = v56 - v45;
    let v63 = v62 * v53;
    let v64 = v63 - v60 * v61;
    let v65 = 1.0 / v64;
    at.q[5] = x2 + 0.0;
    let rocker_y = -v45;
    at.q[7] = rocker_y + 0.0;
    at.q[6] = rocker_x + 0.0;
    at.q[8] = x1 + 0.0;
    at.pivot(0, v65, 28.48497759920829);
    let v67 = v53 * v3;
    let v68 = v60 * coupler_y_d + v67;
    let rocker_phi_d = v68 * v65;
    let v70 = v62 * coupler_y_d;
    let v71 = v61 * v3 + v70;
    let v72 = v71 * v65;
    let rocker_x_d = v45 * rocker_phi_d;
    let rocker_y_d = v46 * rocker_phi_d;
    let coupler_phi_d = -v72;
    at.qd[5] = coupler_phi_d + 0.0;
    at.qd[7] = rocker_y_d + 0.0;
    at.qd[6] = rocker_x_d + 0.0;
    at.qd[8] = rocker_phi_d + 0.0;
    let v76 = v42 * rocker_phi_d;
    let v77 = rocker_phi_d * v76;
    let v78 = 1.5 * v77;
    let v79 = v52 * v72;
    let v80 = v72 * v79;
    let v81 = -3.5 * v80 + v78;
    let v82 = v6 - v81;
    let v83 = v40 * rocker_phi_d;
    let v84 = rocker_phi_d * v83;
    let v85 = 1.5 * v84;
    let v86 = v50 * v72;
    let v87 = v72 * v86;
    let v88 = -3.5 * v87 + v85;
    let v89 = v10 - v88;
    let v90 = v89 - v85;
    let v91 = v82 - v78;
    let v92 = v53 * v91;
    let v93 = v92 - v60 * v90;
    let rocker_phi_dd = v93 * v65;
    let v95 = v62 * v90;
    let v96 = v95 - v61 * v91;
    let coupler_phi_dd = v96 * v65;
    let v98 = v78 - v45 * rocker_phi_dd;
    let v99 = v85 - v46 * rocker_phi_dd;
    at.qdd[5] = coupler_phi_dd + 0.0;
    let rocker_y_dd = -v99;
    at.qdd[7] = rocker_y_dd + 0.0;
    let rocker_x_dd = -v98;
    at.qdd[6] = rocker_x_dd + 0.0;
    at.qdd[8] = rocker_phi_dd + 0.0;
}

#[rustfmt::skip]
mod blocks {

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

/// The same for several variants of the mechanism, or several times, at once: in loops over the
/// lanes that a compiler turns into vector instructions. Each lane has the bits that it would have
/// alone.
pub mod lanes {
    // what is done in every lane reads best, and vectorises best, with the lane's number
    #![allow(clippy::needless_range_loop)]

    use super::*;

    /// Lanes that are worked on together.
    pub const LANES: usize = 16;

    /// A number in each lane.
    pub type Each = [f64; LANES];

    /// As many mechanisms, each with its own parameters, at a time of its own.
    #[derive(Clone, Debug)]
    pub struct States {
        models: [Model; LANES],
        /// The solutions of now and the ones before, or the next ones in the making.
        solutions: [Solutions; 2],
        /// Whether those of now are the second.
        is_second: bool,
        is_smooth: [bool; LANES],
        steepness: Each,
        step: Each,
    }

    impl States {
        /// The solutions of now.
        fn now(&self) -> &Solutions {
            let [first, second] = &self.solutions;
            if self.is_second { second } else { first }
        }

        /// The ones before, or the next ones in the making.
        fn other(&self) -> &Solutions {
            let [first, second] = &self.solutions;
            if self.is_second { first } else { second }
        }

        /// Both, to be changed: those of now, and the others.
        fn both(&mut self) -> (&mut Solutions, &mut Solutions) {
            let [first, second] = &mut self.solutions;
            if self.is_second {
                (second, first)
            } else {
                (first, second)
            }
        }

        /// The times (s).
        #[must_use]
        pub fn t(&self) -> &Each {
            &self.now().t
        }

        /// The coordinates (m, rad), by the indices in [`coordinate`].
        #[must_use]
        pub fn q(&self) -> &[Each; N] {
            &self.now().q
        }

        /// Their velocities (m/s, rad/s).
        #[must_use]
        pub fn qd(&self) -> &[Each; N] {
            &self.now().qd
        }

        /// Their accelerations (m/s^2, rad/s^2).
        #[must_use]
        pub fn qdd(&self) -> &[Each; N] {
            &self.now().qdd
        }

        /// A lane on its own; none where there is no such lane.
        #[must_use]
        pub fn get(&self, lane: usize) -> Option<State> {
            (lane < LANES).then(|| self.lane(lane))
        }

        /// A lane, which is below [`LANES`], on its own.
        fn lane(&self, k: usize) -> State {
            let [first, ..] = &self.models;
            let model = self.models.get(k).unwrap_or(first).clone();
            let mut solutions = [self.now().lane(k), self.other().lane(k)];
            for at in &mut solutions {
                at.is_settled = true;
            }
            State {
                model,
                solutions,
                is_second: false,
                is_smooth: self.is_smooth.get(k).copied().unwrap_or(false),
                steepness: of(&self.steepness, k),
                step: of(&self.step, k),
            }
        }

        /// Moves a lane on its own, and leaves it among the other solutions.
        fn alone(&mut self, k: usize, t: f64) -> Result<(), Error> {
            let mut state = self.lane(k);
            // where the solution before was, the one that has been tried is now
            state.is_smooth = false;
            let result = step(t, &mut state);
            self.both().1.set_lane(k, state.at());
            if let Some(is_smooth) = self.is_smooth.get_mut(k) {
                *is_smooth = false;
            }
            if let Some(step) = self.step.get_mut(k) {
                *step = state.step;
            }
            result
        }
    }

    /// Brings the mechanisms to the first time, each with its own parameters; says of each lane why
    /// it cannot be assembled, if it cannot. Such a lane has the parameters of the file.
    ///
    /// # Errors
    /// Not even the file's own mechanism can be assembled.
    #[rustfmt::skip]
    pub fn assemble(params: &[Params; LANES]) -> Result<(States, [Result<(), Error>; LANES]), Error> {
        let one = super::assemble(&Params)?;
        let mut states = States {
            models: core::array::from_fn(|_| one.model.clone()),
            solutions: [Solutions::ZERO, Solutions::ZERO],
            is_second: false,
            is_smooth: [false; LANES],
            steepness: [one.steepness; LANES],
            step: [LONGEST_STEP; LANES],
        };
        let mut results = [Ok(()); LANES];
        for (k, (params, result)) in params.iter().zip(&mut results).enumerate() {
            let found = super::assemble(params);
            *result = found.as_ref().map(|_| ()).map_err(|error| *error);
            let state = found.unwrap_or_else(|_| one.clone());
            states.both().0.set_lane(k, state.at());
            if let Some(model) = states.models.get_mut(k) {
                *model = state.model.clone();
            }
            if let Some(steepness) = states.steepness.get_mut(k) {
                *steepness = state.steepness;
            }
        }
        Ok((states, results))
    }

    /// Moves every lane to a time of its own (s). A lane that asks for more than one step, as any
    /// does that has further to go than [`LONGEST_STEP`], goes its way alone.
    ///
    /// What comes back says of each lane whether it has got there, and if not, why; it stays at the
    /// last time that it could reach.
    pub fn step_each(t: &Each, states: &mut States) -> [Result<(), Error>; LANES] {
        let is_done = advance(t, states);
        let mut results = [Ok(()); LANES];
        for k in 0..LANES {
            if !is_done[k] {
                results[k] = states.alone(k, t[k]);
            }
        }
        states.is_second = !states.is_second;
        results
    }

    /// Tries one step of every lane; says which ones have got there.
    fn advance(t: &Each, states: &mut States) -> [bool; LANES] {
        let [first, second] = &mut states.solutions;
        let (from, at) = if states.is_second {
            (second, first)
        } else {
            (first, second)
        };
        let from = &*from;
        let mut h = [0.0; LANES];
        for k in 0..LANES {
            h[k] = t[k] - from.t[k];
        }
        let mut back = [0.0; LANES];
        let mut u = [0.0; LANES];
        for k in 0..LANES {
            back[k] = from.t[k] - at.t[k];
            let ratio = h[k] / back[k];
            let is_known = states.is_smooth[k] && ratio.abs() <= FARTHEST_BEND;
            u[k] = if is_known { ratio } else { 0.0 };
        }
        let (x, v, a) = (tears(&from.q), tears(&from.qd), tears(&from.qdd));
        let (y, w, b) = (tears(&at.q), tears(&at.qd), tears(&at.qdd));
        let mut guess = [[0.0; LANES]; TEARS];
        let mut motion = [0.0; LANES];
        for i in 0..TEARS {
            for k in 0..LANES {
                // as `bend` has it
                let (h, back, u) = (h[k], back[k], u[k]);
                let (x, v, a) = (x[i][k], v[i][k], a[i][k]);
                let value = y[i][k] - x + back * (v - 0.5 * back * a);
                let slope = back * (v - back * a - w[i][k]);
                let curvature = 0.5 * back * back * (b[i][k] - a);
                let cubic = 4.0 * slope - 10.0 * value - curvature;
                let quartic = 7.0 * slope - 15.0 * value - 2.0 * curvature;
                let quintic = 3.0 * slope - 6.0 * value - curvature;
                let bend = u * u * u * (cubic + u * (quartic + u * quintic));
                let way = h * (v + 0.5 * h * a) + bend;
                guess[i][k] = x + way;
                motion[k] = larger(motion[k], way.abs() / TEAR_SCALES[i]);
            }
        }
        solve(&guess, t, &states.models, at);
        let mut gap = [0.0; LANES];
        let (y, w, b) = (tears(&at.q), tears(&at.qd), tears(&at.qdd));
        for i in 0..TEARS {
            for k in 0..LANES {
                let rates = 0.5 * h[k] * (v[i][k] + w[i][k]);
                let bends = h[k] * h[k] * (1.0 / 12.0) * (a[i][k] - b[i][k]);
                let gap_here = y[i][k] - x[i][k] - rates - bends;
                gap[k] = larger(gap[k], gap_here.abs() / TEAR_SCALES[i]);
            }
        }
        let is_finite = at.are_finite();
        let mut is_done = [false; LANES];
        for k in 0..LANES {
            let is_short = h[k].abs() <= states.step[k] && h[k] != 0.0;
            let is_solved = at.strain[k] <= 1.0 && at.steepest[k] <= STEEP * states.steepness[k];
            let is_solved = is_solved && is_finite[k];
            is_done[k] = is_solved && is_short;
        }
        for k in 0..LANES {
            let is_near = motion[k] <= LARGEST_MOTION && at.first[k] <= LARGEST_CORRECTION;
            is_done[k] &= is_near && at.open[k] <= HALF_A_CELL && gap[k] <= LARGEST_GAP;
        }
        for i in 0..TURNS {
            for k in 0..LANES {
                is_done[k] &= (at.signs[i][k] ^ from.signs[i][k]) >> 63 == 0;
            }
        }
        for k in 0..LANES {
            if is_done[k] {
                let first = states.other().first[k];
                let is_calm = first < LARGEST_CORRECTION / 12.0 && gap[k] < LARGEST_GAP / 100.0;
                let size = h[k].abs();
                let longest = if is_calm { 2.0 * size } else { 0.0 };
                let shortest = if is_calm { states.step[k] } else { size };
                states.step[k] = f64::max(longest, shortest).min(LONGEST_STEP);
                states.is_smooth[k] = true;
            }
        }
        is_done
    }

    /// What solves the equations in every lane.
    #[derive(Clone, Debug)]
    struct Solutions {
        t: Each,
        q: [Each; N],
        qd: [Each; N],
        qdd: [Each; N],
        /// By block: what has the sign of its determinant.
        signs: [[u64; LANES]; TURNS],
        /// Multipliers, residuals and angles beside what is bearable: 1 at most.
        strain: Each,
        /// Newton's largest first correction, scaled.
        first: Each,
        /// Its largest last correction, in cells of the grid.
        open: Each,
        /// One over the smallest pivot, scaled.
        steepest: Each,
    }

    impl Solutions {
        const ZERO: Self = Self {
            t: [0.0; LANES],
            q: [[0.0; LANES]; N],
            qd: [[0.0; LANES]; N],
            qdd: [[0.0; LANES]; N],
            signs: [[0; LANES]; TURNS],
            strain: [0.0; LANES],
            first: [0.0; LANES],
            open: [0.0; LANES],
            steepest: [0.0; LANES],
        };

        /// Makes ready for being solved for.
        fn begin(&mut self, t: &Each) {
            self.t = *t;
            let zero = [0.0; LANES];
            (self.strain, self.first, self.open, self.steepest) = (zero, zero, zero, zero);
            for (signs, is_negative) in self.signs.iter_mut().zip(&TURNED) {
                *signs = [u64::from(*is_negative) << 63; LANES];
            }
        }

        fn are_finite(&self) -> [bool; LANES] {
            let mut sum = [0.0; LANES];
            for each in self.q.iter().chain(&self.qd).chain(&self.qdd) {
                for k in 0..LANES {
                    sum[k] += 0.0 * each[k];
                }
            }
            sum.map(|sum| sum == 0.0)
        }

        /// A lane on its own.
        fn lane(&self, k: usize) -> Solution {
            let mut at = Solution::ZERO;
            at.t = of(&self.t, k);
            at.q = self.q.map(|each| of(&each, k));
            at.qd = self.qd.map(|each| of(&each, k));
            at.qdd = self.qdd.map(|each| of(&each, k));
            for (is_negative, signs) in at.is_negative.iter_mut().zip(&self.signs) {
                *is_negative = signs.get(k).is_some_and(|sign| sign >> 63 == 1);
            }
            at.steepest = of(&self.steepest, k);
            at
        }

        fn set_lane(&mut self, k: usize, at: &Solution) {
            let put = |each: &mut Each, value: f64| {
                if let Some(place) = each.get_mut(k) {
                    *place = value;
                }
            };
            put(&mut self.t, at.t);
            put(&mut self.steepest, at.steepest);
            let all = self.q.iter_mut().chain(&mut self.qd).chain(&mut self.qdd);
            let values = at.q.iter().chain(&at.qd).chain(&at.qdd);
            for (each, value) in all.zip(values) {
                put(each, *value);
            }
            for (signs, is_negative) in self.signs.iter_mut().zip(at.is_negative) {
                if let Some(sign) = signs.get_mut(k) {
                    *sign = u64::from(is_negative) << 63;
                }
            }
        }

        /// Takes note of a value that must not be above 1 when it is multiplied by a factor.
        #[inline]
        fn watch(&mut self, k: usize, value: f64, factor: f64) {
            self.strain[k] = larger(self.strain[k], value.abs() * factor);
        }

        /// Takes note of one over a pivot, and of what makes that a pure number.
        #[inline]
        fn pivot(&mut self, k: usize, turn: usize, inverse: f64, weight: f64) {
            self.signs[turn][k] ^= inverse.to_bits();
            self.steepest[k] = larger(self.steepest[k], inverse.abs() * weight);
        }
    }

    /// The number of a lane.
    fn of(each: &Each, k: usize) -> f64 {
        each.get(k).copied().unwrap_or(f64::NAN)
    }

    /// An iteration of Newton in every lane, until all have settled or are lost.
    struct Settling {
        is_first: bool,
        first: Each,
        far: Each,
        open: Each,
    }

    impl Settling {
        fn new() -> Self {
            let zero = [0.0; LANES];
            Self {
                is_first: true,
                first: zero,
                far: zero,
                open: zero,
            }
        }

        fn begin(&mut self) {
            self.open = [0.0; LANES];
        }

        /// Corrects a coordinate whose grid has cells so wide, and which is judged against `scale`.
        #[inline]
        fn correct(&mut self, k: usize, x: &mut f64, delta: f64, cell: f64, scale: f64) {
            let size = delta.abs();
            self.far[k] = larger(self.far[k], size / scale);
            self.open[k] = larger(self.open[k], size / cell);
            *x += delta;
        }

        /// Whether no further iteration is needed, or none helps.
        fn is_done(&mut self) -> bool {
            if self.is_first {
                self.first = self.far;
                self.is_first = false;
            }
            let mut pairs = self.open.iter().zip(&self.far);
            let is_lost = |far: f64| far.is_nan() || far > LARGEST_CORRECTION;
            pairs.all(|(open, far)| *open <= HALF_A_CELL || is_lost(*far))
        }

        /// Leaves word of how it went.
        fn note(&self, at: &mut Solutions) {
            for k in 0..LANES {
                at.first[k] = larger(at.first[k], self.first[k]);
                at.open[k] = larger(at.open[k], self.open[k]);
                let lost = self.far[k] * (1.0 / LARGEST_CORRECTION);
                at.strain[k] = larger(at.strain[k], lost);
            }
        }
    }

    /// Out of all coordinates those that Newton solves for.
    #[rustfmt::skip]
    fn tears(q: &[Each; N]) -> [Each; TEARS] {
        [q[8], q[5]]
    }

    /// Position, velocity and acceleration in every lane. Newton begins with a guess of
    /// `rocker.phi`, `coupler.phi`; all else follows.
    ///
    /// 101 operations a lane.
    fn solve(guess: &[Each; TEARS], t: &Each, m: &[Model; LANES], at: &mut Solutions) {
        at.begin(t);
        let mut w = [[0.0; LANES]; 20];
        solve_1(guess, t, m, at, &mut w);
        solve_2(guess, t, m, at, &mut w);
        solve_3(guess, t, m, at, &mut w);
    }

    /// Part 1 of [`solve`].
    #[inline(never)]
    fn solve_1(
        guess: &[Each; TEARS],
        t: &Each,
        _m: &[Model; LANES],
        at: &mut Solutions,
        w: &mut [Each; 20],
    ) {
        for k in 0..LANES {
            let crank_phi = 2.0 * t[k] + 0.5;
            at.q[2][k] = crank_phi + 0.0;
            at.qd[2][k] = 2.0;
            at.watch(k, crank_phi, 1e-6);
            (w[8][k], w[7][k]) = sin_cos_below_a_million(crank_phi);
            at.q[3][k] = w[7][k] + 0.0;
            w[16][k] = w[8][k] * 2.0;
            let coupler_x_d = -w[16][k];
            at.qd[3][k] = coupler_x_d + 0.0;
            let v5 = w[7][k] * 2.0;
            w[18][k] = 2.0 * v5;
            let coupler_x_dd = -w[18][k];
            at.qdd[3][k] = coupler_x_dd + 0.0;
            at.q[4][k] = w[8][k] + 0.0;
            w[17][k] = w[7][k] * 2.0;
            at.qd[4][k] = w[17][k] + 0.0;
            let v9 = w[8][k] * 2.0;
            w[19][k] = 2.0 * v9;
            let coupler_y_dd = -w[19][k];
            at.qdd[4][k] = coupler_y_dd + 0.0;
            w[0][k] = guess[0][k];
            w[3][k] = guess[1][k];
        }
    }

    /// Part 2 of [`solve`].
    #[inline(never)]
    fn solve_2(
        _guess: &[Each; TEARS],
        _t: &Each,
        _m: &[Model; LANES],
        at: &mut Solutions,
        w: &mut [Each; 20],
    ) {
        let mut newton = Settling::new();
        for _ in 0..ITERATIONS {
            newton.begin();
            for k in 0..LANES {
                let mut x1 = on_grid(w[0][k], 7.450580596923828e-9);
                let mut x2 = on_grid(w[3][k], 7.450580596923828e-9);
                at.watch(k, x1, 1e-6);
                (w[11][k], w[12][k]) = sin_cos_below_a_million(x1);
                let v13 = -1.5 * w[12][k];
                let v14 = 4.0 - v13;
                let v15 = -1.5 * w[11][k];
                at.watch(k, x2, 1e-6);
                (w[14][k], w[15][k]) = sin_cos_below_a_million(x2);
                let v17 = -3.5 * w[14][k];
                let v18 = 1.5 * w[11][k];
                let v19 = 3.5 * w[15][k];
                let v20 = 1.5 * w[12][k];
                let v21 = v13 - v20;
                let v22 = v18 - v15;
                let v23 = v22 * v19;
                let v24 = v23 - v17 * v21;
                let v25 = 1.0 / v24;
                let v26 = v20 + v14;
                let v27 = w[7][k] + v19;
                let v28 = v27 - v26;
                let v29 = v18 - v15;
                let v30 = 3.5 * w[14][k] + w[8][k];
                let v31 = v30 - v29;
                let v32 = v17 * v31;
                let v33 = v32 - v19 * v28;
                w[10][k] = v33 * v25;
                let v35 = v21 * v28;
                let v36 = v35 - v22 * v31;
                w[13][k] = v36 * v25;
                newton.correct(k, &mut x1, w[10][k], TEAR_CELLS[0], TEAR_SCALES[0]);
                w[0][k] = x1;
                newton.correct(k, &mut x2, w[13][k], TEAR_CELLS[1], TEAR_SCALES[1]);
                w[3][k] = x2;
            }
            if newton.is_done() {
                break;
            }
        }
        newton.note(at);
    }

    /// Part 3 of [`solve`].
    #[inline(never)]
    fn solve_3(
        _guess: &[Each; TEARS],
        _t: &Each,
        _m: &[Model; LANES],
        at: &mut Solutions,
        w: &mut [Each; 20],
    ) {
        for k in 0..LANES {
            let v38 = 0.5 * w[10][k];
            let v39 = w[12][k] - v38 * w[11][k];
            let v40 = w[10][k] * v39 + w[11][k];
            let v41 = v38 * w[12][k] + w[11][k];
            let v42 = w[12][k] - w[10][k] * v41;
            let v43 = -1.5 * v42;
            let rocker_x = 4.0 - v43;
            let v45 = -1.5 * v40;
            let v46 = 1.5 * v42;
            let v47 = v46 + rocker_x;
            let v48 = 0.5 * w[13][k];
            let v49 = w[15][k] - v48 * w[14][k];
            let v50 = w[13][k] * v49 + w[14][k];
            let v51 = v48 * w[15][k] + w[14][k];
            let v52 = w[15][k] - w[13][k] * v51;
            let v53 = 3.5 * v52;
            let v54 = w[7][k] + v53;
            let v55 = v54 - v47;
            at.watch(k, v55, 184126417549.3348);
            let v56 = 1.5 * v40;
            let v57 = v56 - v45;
            let v58 = 3.5 * v50 + w[8][k];
            let v59 = v58 - v57;
            at.watch(k, v59, 190308972656.6411);
            let v60 = -3.5 * v50;
            let v61 = v43 - v46;
            let v62 = v56 - v45;
            let v63 = v62 * v53;
            let v64 = v63 - v60 * v61;
            let v65 = 1.0 / v64;
            at.q[5][k] = w[3][k] + 0.0;
            let rocker_y = -v45;
            at.q[7][k] = rocker_y + 0.0;
            at.q[6][k] = rocker_x + 0.0;
            at.q[8][k] = w[0][k] + 0.0;
            at.pivot(k, 0, v65, 28.48497759920829);
            let v67 = v53 * w[16][k];
            let v68 = v60 * w[17][k] + v67;
            let rocker_phi_d = v68 * v65;
            let v70 = v62 * w[17][k];
            let v71 = v61 * w[16][k] + v70;
            let v72 = v71 * v65;
            let rocker_x_d = v45 * rocker_phi_d;
            let rocker_y_d = v46 * rocker_phi_d;
            let coupler_phi_d = -v72;
            at.qd[5][k] = coupler_phi_d + 0.0;
            at.qd[7][k] = rocker_y_d + 0.0;
            at.qd[6][k] = rocker_x_d + 0.0;
            at.qd[8][k] = rocker_phi_d + 0.0;
            let v76 = v42 * rocker_phi_d;
            let v77 = rocker_phi_d * v76;
            let v78 = 1.5 * v77;
            let v79 = v52 * v72;
            let v80 = v72 * v79;
            let v81 = -3.5 * v80 + v78;
            let v82 = w[18][k] - v81;
            let v83 = v40 * rocker_phi_d;
            let v84 = rocker_phi_d * v83;
            let v85 = 1.5 * v84;
            let v86 = v50 * v72;
            let v87 = v72 * v86;
            let v88 = -3.5 * v87 + v85;
            let v89 = w[19][k] - v88;
            let v90 = v89 - v85;
            let v91 = v82 - v78;
            let v92 = v53 * v91;
            let v93 = v92 - v60 * v90;
            let rocker_phi_dd = v93 * v65;
            let v95 = v62 * v90;
            let v96 = v95 - v61 * v91;
            let coupler_phi_dd = v96 * v65;
            let v98 = v78 - v45 * rocker_phi_dd;
            let v99 = v85 - v46 * rocker_phi_dd;
            at.qdd[5][k] = coupler_phi_dd + 0.0;
            let rocker_y_dd = -v99;
            at.qdd[7][k] = rocker_y_dd + 0.0;
            let rocker_x_dd = -v98;
            at.qdd[6][k] = rocker_x_dd + 0.0;
            at.qdd[8][k] = rocker_phi_dd + 0.0;
        }
    }
}

use sine_and_cosine::sin_cos;

#[rustfmt::skip]
mod sine_and_cosine {

// Sine and cosine of one angle (rad), together: the same bits on every platform, within 1 ulp, for arguments of any size.
//
// The angle is reduced to |r + tail| <= pi/4 with `angle = n pi/2 + r + tail`: up to a million by subtracting n times
// pi/2 in pieces of 33 bits, whose products are exact (W. Cody and W. Waite, Software Manual for the Elementary
// Functions, 1980); above by as many bits of 2/pi as the angle asks for (M. Payne and R. Hanek, Radian Reduction for
// Trigonometric Functions, 1983). The coefficients of the two polynomials are those of Sun's fdlibm.

/// Sine and cosine of an angle in radians; not a number for an angle that is not finite.
#[must_use]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    if !angle.is_finite() {
        return (f64::NAN, f64::NAN);
    }
    let (quarter, r, tail) = if angle.abs() < 1e6 { reduce_small(angle) } else { reduce_large(angle) };
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

use without_branches::sin_cos_below_a_million;

#[rustfmt::skip]
mod without_branches {
use super::sine_and_cosine::{cos_near_zero, reduce_small, sin_near_zero};

// Sine and cosine without a branch, so that a loop over many angles does several at once.

/// Sine and cosine of an angle (rad) whose size is below a million: the bits of [`sin_cos`](super::sin_cos).
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
