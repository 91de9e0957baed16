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

#![allow(clippy::approx_constant, clippy::eq_op)]
#![allow(clippy::excessive_precision, clippy::large_const_arrays)]

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

impl Params {
    /// Part of the way from these to others.
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

/// Which equation each joint, constraint or driver wrote.
pub mod row {
    /// joint `main 1`, line 30
    pub const MAIN_1: usize = 0;
    /// joint `main 2`, line 30
    pub const MAIN_2: usize = 1;
    /// joint `big 1`, line 31
    pub const BIG_1: usize = 2;
    /// joint `big 2`, line 31
    pub const BIG_2: usize = 3;
    /// joint `small 1`, line 32
    pub const SMALL_1: usize = 4;
    /// joint `small 2`, line 32
    pub const SMALL_2: usize = 5;
    /// joint `barrel 1`, line 33
    pub const BARREL_1: usize = 6;
    /// joint `barrel 2`, line 33
    pub const BARREL_2: usize = 7;
    /// driver `motor`, line 36
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

/// The residual of the equations (m, m^2 or rad).
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

/// Number of results at a time.
pub const COLUMNS: usize = 34;

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

    /// The measures, by the indices in [`measure`], and their first and second time derivatives; `NAN` where
    /// one has no value, and no step fails for that.
    #[must_use]
    pub fn measures(&self) -> &Measures {
        &self.at().measures
    }

    /// All results, in the order of the columns of `mechc run`: the time, coordinates and measures,
    /// then their first and their second derivatives.
    #[must_use]
    pub fn row(&self) -> [f64; COLUMNS] {
        let at = self.at();
        let [values, rates, accelerations] = at.measures.lists();
        let zeroth = at.q.iter().chain(values);
        let first = at.qd.iter().chain(rates);
        let second = at.qdd.iter().chain(accelerations);
        let all = zeroth.chain(first).chain(second);
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
const SPAN: f64 = 0.04;

/// The longest step (s).
pub const LONGEST_STEP: f64 = 0.00125;

/// The shortest step (s).
const SMALLEST_STEP: f64 = 4e-14;

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

/// Number of blocks of equations whose determinants change with the position.
const TURNS: usize = 2;

/// Whether they are negative where all pivots are positive.
#[rustfmt::skip]
static TURNED: [bool; TURNS] = [
    false, false,
];

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
const WORK: usize = blocks::work_of(1);

/// What may be left of an equation, beside the norm of its row.
const TOLERANCE: f64 = 1e-12;

/// How the equations fall apart into blocks.
#[rustfmt::skip]
static EQUATIONS: blocks::Blocks<'static> = blocks::Blocks {
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

impl Measures {
    const ZERO: Self = Self {
        values: [0.0; MEASURES],
        rates: [0.0; RATES],
        accelerations: [0.0; ACCELERATIONS],
    };

    fn lists(&self) -> [&[f64]; 3] {
        [&self.values, &self.rates, &self.accelerations]
    }

    /// What is not finite is no number.
    fn leave_out(&mut self) {
        let rest = self.rates.iter_mut().chain(&mut self.accelerations);
        for value in self.values.iter_mut().chain(rest) {
            if !value.is_finite() {
                *value = f64::NAN;
            }
        }
    }
}

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
    let file = Params::default();
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
    at.measures.leave_out();
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
    measures: Measures,
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
        measures: Measures::ZERO,
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
    at.measures = measures(&at.q, &qd, &qdd, t, p);
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
        q[5], q[8],
    ]
}

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
    let mut newton = Newton::new();
    for _ in 0..ITERATIONS {
        x1 = on_grid(x1, 7.450580596923828e-9);
        (s17, c17) = sin_cos(x1);
        let v18 = c17 * m.params.rod_length;
        let v19 = 1.0 / v18;
        let v20 = s17 * m.params.rod_length + rod_y;
        let v21 = v20 * v19;
        v22 = -v21;
        x1 = newton.corrected(x1, v22, 7.450580596923828e-9, 1.0);
        if newton.is_done() {
            break;
        }
    }
    at.note(&newton);
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
    let mut newton = Newton::new();
    for _ in 0..ITERATIONS {
        x2 = on_grid(x2, 7.450580596923828e-9);
        (s52, c52) = sin_cos(x2);
        let v53 = 1.0 / c52;
        let v54 = s52 * v53;
        v55 = -v54;
        x2 = newton.corrected(x2, v55, 7.450580596923828e-9, 1.0);
        if newton.is_done() {
            break;
        }
    }
    at.note(&newton);
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
    pub const LANES: usize = 4;

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
        let one = super::assemble(&Params::default())?;
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
        values: [Each; MEASURES],
        rates: [Each; RATES],
        accelerations: [Each; ACCELERATIONS],
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
            values: [[0.0; LANES]; MEASURES],
            rates: [[0.0; LANES]; RATES],
            accelerations: [[0.0; LANES]; ACCELERATIONS],
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
            at.measures.values = self.values.map(|each| of(&each, k));
            at.measures.rates = self.rates.map(|each| of(&each, k));
            at.measures.accelerations = self.accelerations.map(|each| of(&each, k));
            at.measures.leave_out();
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
            for (each, value) in self.values.iter_mut().zip(at.measures.values) {
                put(each, value);
            }
            for (each, rate) in self.rates.iter_mut().zip(at.measures.rates) {
                put(each, rate);
            }
            for (each, value) in self.accelerations.iter_mut().zip(at.measures.accelerations) {
                put(each, value);
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
        [q[5], q[8]]
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
            at.watch(k, crank_phi, 1e-6);
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
        let mut newton = Settling::new();
        for _ in 0..ITERATIONS {
            newton.begin();
            for k in 0..LANES {
                let mut x1 = on_grid(w[0][k], 7.450580596923828e-9);
                at.watch(k, x1, 1e-6);
                (w[4][k], w[5][k]) = sin_cos_below_a_million(x1);
                let v19 = w[5][k] * w[1][k];
                let v20 = 1.0 / v19;
                let v21 = w[4][k] * w[1][k] + w[2][k];
                let v22 = v21 * v20;
                w[3][k] = -v22;
                newton.correct(k, &mut x1, w[3][k], TEAR_CELLS[0], TEAR_SCALES[0]);
                w[0][k] = x1;
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
        let mut newton = Settling::new();
        for _ in 0..ITERATIONS {
            newton.begin();
            for k in 0..LANES {
                let mut x1 = on_grid(w[11][k], 7.450580596923828e-9);
                at.watch(k, x1, 1e-6);
                (w[13][k], w[14][k]) = sin_cos_below_a_million(x1);
                let v54 = 1.0 / w[14][k];
                let v55 = w[13][k] * v54;
                w[12][k] = -v55;
                newton.correct(k, &mut x1, w[12][k], TEAR_CELLS[1], TEAR_SCALES[1]);
                w[11][k] = x1;
            }
            if newton.is_done() {
                break;
            }
        }
        newton.note(at);
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
