//! Kinematics of mechanism `arm`, written by mechc 0.1.0 from `measures.mech`.
//!
//! - coordinates `q`: 3 (m, rad), equations `phi = 0`: 3
//! - `phi_q`: 3 entries that do not vanish, see [`PHI_Q_PATTERN`]
//! - parameters: 0; those that follow from others are worked out
//! - needs no other crate
//! - needs no heap and no standard library; nothing in it panics
//!
//! This code carries no licence of mechc's: use, change and pass it on as you like.

#![allow(clippy::approx_constant, clippy::eq_op, clippy::neg_multiply)]
#![allow(clippy::excessive_precision, clippy::large_const_arrays)]

use runtime::sine_and_cosine::sin_cos;

/// The mechanism has no parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Params;

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
    /// driver `motor` (rad), line 5
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
    /// `height`, in m; tables have it in mm, line 6
    pub const HEIGHT: usize = 0;
    /// `pull`, line 7
    pub const PULL: usize = 1;
}

/// How many they are.
pub const MEASURES: usize = 2;

/// Where the first time derivative of each measure that has one stands among the rates.
pub mod measure_rate {
    /// `height`, in m; tables have it in mm, line 6
    pub const HEIGHT: usize = 0;
    /// `pull`, line 7
    pub const PULL: usize = 1;
}

/// How many they are.
pub const RATES: usize = 2;

/// Where the second time derivative of each measure that has one stands among the accelerations.
pub mod measure_acceleration {
    /// `height`, in m; tables have it in mm, line 6
    pub const HEIGHT: usize = 0;
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
/// 3 operations.
pub fn phi(q: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let arm_x = q[0];
    let arm_y = q[1];
    let arm_phi = q[2];

    let v1 = -arm_x;
    let v2 = -arm_y;
    let v3 = arm_phi - t;

    out[0] = v1;
    out[1] = v2;
    out[2] = v3;
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
pub fn phi_t(_q: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    out[2] = -1.0;
    out
}

/// Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).
///
/// 0 operations.
pub fn nu(_q: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    out[2] = 1.0;
    out
}

/// Right side of the acceleration equation `phi_q qdd = gamma` (the equation's unit per s^2).
///
/// 0 operations.
pub fn gamma(_q: &[f64; N], _qd: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
    [0.0; N]
}

/// Right side of the jerk equation `phi_q qddd = jerk`.
///
/// 0 operations.
pub fn jerk(_q: &[f64; N], _qd: &[f64; N], _qdd: &[f64; N], _t: f64, _p: &Params) -> [f64; N] {
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
/// 20 operations.
fn all_measures(
    q: &[f64; N],
    qd: &[f64; N],
    qdd: &[f64; N],
    qddd: &[f64; N],
    _t: f64,
    _p: &Params,
) -> [f64; 5] {
    let mut out = [0.0; 5];
    let arm_phi = q[2];
    let arm_y = q[1];
    let arm_phi_d = qd[2];
    let arm_phi_dd = qdd[2];
    let arm_x_dd = qdd[0];
    let arm_y_d = qd[1];
    let qddd2 = qddd[2];
    let qddd0 = qddd[0];
    let arm_y_dd = qdd[1];

    let (s1, c1) = sin_cos(arm_phi);
    let v2 = s1 + arm_y;
    let v3 = c1 * arm_phi_d;
    let v4 = arm_phi_d * v3;
    let v5 = s1 * arm_phi_dd;
    let v6 = v4 + v5;
    let v7 = arm_x_dd - v6;
    let v8 = s1 * arm_phi_d;
    let v9 = v3 + arm_y_d;
    let v10 = arm_phi_d * v8;
    let v11 = c1 * arm_phi_dd;
    let v12 = v11 - v10;
    let v13 = v3 * arm_phi_dd;
    let v14 = arm_phi_d * v12;
    let v15 = v13 + v14;
    let v16 = s1 * qddd2;
    let v17 = v13 + v16;
    let v18 = v15 + v17;
    let v19 = qddd0 - v18;
    let v20 = v12 + arm_y_dd;

    out[0] = v2;
    out[1] = v7;
    out[2] = v9;
    out[3] = v19;
    out[4] = v20;
    out
}
