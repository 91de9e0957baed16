//! Kinematics of mechanism `arm`, written by mechc 0.1.0 from `derivatives_asked_for.mech`.
//!
//! - coordinates `q`: 3 (m, rad), equations `phi = 0`: 3
//! - `phi_q`: 3 entries that do not vanish, see [`PHI_Q_PATTERN`]
//! - parameters: 1; those that follow from others are worked out
//! - needs no other crate
//! - needs no heap and no standard library; nothing in it panics
//!
//! This code carries no licence of mechc's: use, change and pass it on as you like.

#![allow(clippy::approx_constant, clippy::eq_op, clippy::neg_multiply)]
#![allow(clippy::excessive_precision, clippy::large_const_arrays)]
#![allow(clippy::too_many_arguments)]

use runtime::sine_and_cosine::sin_cos;

/// The parameters, in SI; those of the file by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// `reach` (m), line 5
    pub reach: f64,
}

impl Default for Params {
    #[rustfmt::skip]
    fn default() -> Self {
        Self {
            reach: 0.5,
        }
    }
}

/// Number of coordinates, and of equations.
pub const N: usize = 3;

/// Number of entries of `phi_q` that do not vanish.
pub const ENTRIES: usize = 3;

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
}

/// Which equation each joint, constraint or driver wrote, and its unit.
pub mod row {
    /// joint `main 1` (m), line 4
    pub const MAIN_1: usize = 0;
    /// joint `main 2` (m), line 4
    pub const MAIN_2: usize = 1;
    /// driver `motor` (rad), line 6
    pub const MOTOR: usize = 2;
}

/// Row and column of each value that [`phi_q`] gives.
#[rustfmt::skip]
pub static PHI_Q_PATTERN: [(usize, usize); ENTRIES] = [
    (0, 0),
    (1, 1),
    (2, 2),
];

/// The bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// `arm`, line 3
    Arm,
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
        }
    }
}

/// Where each measure stands among the values, all in SI.
pub mod measure {
    /// `how`, line 7
    pub const HOW: usize = 0;
}

/// How many they are.
pub const MEASURES: usize = 1;

/// Where the first time derivative of each measure that has one stands among the rates.
pub mod measure_rate {
    /// `how`, line 7
    pub const HOW: usize = 0;
}

/// How many they are.
pub const RATES: usize = 1;

/// Where the second time derivative of each measure that has one stands among the accelerations.
pub mod measure_acceleration {
    /// `how`, line 7
    pub const HOW: usize = 0;
}

/// How many they are.
pub const ACCELERATIONS: usize = 1;

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
/// 4 operations.
pub fn phi(q: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let reach = p.reach;
    let arm_x = q[0];
    let arm_y = q[1];
    let arm_phi = q[2];

    let v1 = t * reach;
    let v2 = -arm_x;
    let v3 = -arm_y;
    let v4 = arm_phi - v1;

    out[0] = v2;
    out[1] = v3;
    out[2] = v4;
    out
}

/// The Jacobian: the values of its entries, in the order of [`PHI_Q_PATTERN`] (the equation's unit per m or
/// rad).
///
/// 0 operations.
pub fn phi_q(_q: &[f64; N], _t: f64, _p: &Params) -> [f64; ENTRIES] {
    let mut out = [0.0; ENTRIES];
    out[0] = -1.0;
    out[1] = -1.0;
    out[2] = 1.0;
    out
}

/// The partial derivative of `phi` by time (the equation's unit per s).
///
/// 0 operations.
pub fn phi_t(_q: &[f64; N], _t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let reach = p.reach;

    out[2] = -reach;
    out
}

/// Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).
///
/// 0 operations.
pub fn nu(_q: &[f64; N], _t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let reach = p.reach;

    out[2] = reach;
    out
}

/// Right side of the acceleration equation `phi_q qdd = gamma` (the equation's unit per s^2).
///
/// 0 operations.
pub fn gamma(_q: &[f64; N], _qd: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    [0.0; N]
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

/// Number of derivatives of the coordinates by inputs and parameters that measures hold. For each of the
/// following one behind the other: those of `q`, of `qd` and of `qdd`. By
/// - reach
pub const VARIED: usize = 9;

/// Right sides of the equations `phi_q x = varied_right` for each list of `N` of [`VARIED`]. Those by one are found
/// before those by two, those of `q` before those of `qd` and these before those of `qdd`: what is not found yet
/// may be anything.
///
/// 0 operations.
pub fn varied_right(
    _q: &[f64; N],
    _qd: &[f64; N],
    _qdd: &[f64; N],
    _varied: &[f64; VARIED],
    t: f64,
    _p: &Params,
) -> [f64; VARIED] {
    let mut out = [0.0; VARIED];
    out[2] = t;
    out[5] = 1.0;
    out
}

/// The measures with their time derivatives, from the coordinates, their velocities and
/// accelerations,
/// and the derivatives of [`VARIED`].
pub fn measures(q: &Q, qd: &Qd, qdd: &Qdd, varied: &[f64; VARIED], t: f64, p: &Params) -> Measures {
    let mut all = all_measures(q, qd, qdd, varied, t, p).into_iter();
    let mut next = || all.next().unwrap_or(f64::NAN) + 0.0;
    Measures {
        values: core::array::from_fn(|_| next()),
        rates: core::array::from_fn(|_| next()),
        accelerations: core::array::from_fn(|_| next()),
    }
}

/// The measures, their rates and their accelerations, one behind the other.
///
/// 19 operations.
fn all_measures(
    q: &[f64; N],
    qd: &[f64; N],
    qdd: &[f64; N],
    varied: &[f64; VARIED],
    _t: f64,
    _p: &Params,
) -> [f64; 3] {
    let mut out = [0.0; 3];
    let arm_phi = q[2];
    let arm_phi_d = qd[2];
    let arm_phi_dd = qdd[2];

    let (s1, c1) = sin_cos(arm_phi);
    let v2 = c1 * varied[2];
    let v3 = v2 + varied[1];
    let v4 = s1 * arm_phi_d;
    let v5 = varied[2] * v4;
    let v6 = c1 * varied[5];
    let v7 = v6 - v5;
    let v8 = v7 + varied[4];
    let v9 = c1 * arm_phi_d;
    let v10 = arm_phi_d * v9;
    let v11 = s1 * arm_phi_dd;
    let v12 = v10 + v11;
    let v13 = v4 * varied[5];
    let v14 = varied[2] * v12;
    let v15 = v13 + v14;
    let v16 = c1 * varied[8];
    let v17 = v16 - v13;
    let v18 = v17 - v15;
    let v19 = v18 + varied[7];

    out[0] = v3;
    out[1] = v8;
    out[2] = v19;
    out
}
