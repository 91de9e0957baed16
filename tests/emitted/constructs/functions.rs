//! Kinematics of mechanism `arm`, written by mechc 0.1.0 from `functions.mech`.
//!
//! - coordinates `q`: 3 (m, rad), equations `phi = 0`: 3
//! - `phi_q`: 3 entries that do not vanish, see [`PHI_Q_PATTERN`]
//! - parameters: 0; those that follow from others are worked out
//! - needs the crate `libm`, for elementary functions with the same bits on every platform
//! - needs no heap and no standard library; nothing in it panics
//!
//! This code carries no licence of mechc's: use, change and pass it on as you like.

#![allow(clippy::approx_constant, clippy::eq_op, clippy::neg_multiply)]
#![allow(clippy::excessive_precision, clippy::large_const_arrays)]

use runtime::either::either;
use runtime::select::select;
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

/// The residual of the equations, each in its unit: see [`row`].
///
/// 19 operations.
pub fn phi(q: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let arm_x = q[0];
    let arm_y = q[1];
    let arm_phi = q[2];

    let v1 = t + 1.0;
    let v2 = libm::sqrt(v1);
    let v3 = v2 * v2;
    let v4 = v3 * v2;
    let v5 = f64::from(0.5 < t);
    let v6 = either(v5, t, 0.5);
    let v7 = -t;
    let v8 = libm::exp(v7);
    let v9 = libm::hypot(t, v8);
    let v10 = 2.0 * t;
    let (_, c11) = sin_cos(v10);
    let (s12, _) = sin_cos(t);
    let v13 = c11 * s12;
    let v14 = v9 + v13;
    let v15 = v6 + v14;
    let v16 = v4 + v15;
    let v17 = -arm_x;
    let v18 = -arm_y;
    let v19 = arm_phi - v16;

    out[0] = v17;
    out[1] = v18;
    out[2] = v19;
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
/// 26 operations.
pub fn phi_t(_q: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let v1 = t + 1.0;
    let v2 = libm::sqrt(v1);
    let v3 = f64::from(0.5 < t);
    let v4 = -t;
    let v5 = libm::exp(v4);
    let v6 = libm::hypot(t, v5);
    let v7 = 2.0 * t;
    let (s8, c8) = sin_cos(v7);
    let (s9, c9) = sin_cos(t);
    let v10 = 2.0 * v2;
    let v11 = 1.0 / v10;
    let v12 = v2 * v2;
    let v13 = v11 * v12;
    let v14 = 3.0 * v13;
    let v15 = select(v3, 1.0, 0.0);
    let v16 = t / v6;
    let v17 = v5 / v6;
    let v18 = v5 * v17;
    let v19 = v16 - v18;
    let v20 = s9 * s8;
    let v21 = -2.0 * v20;
    let v22 = c8 * c9;
    let v23 = v21 + v22;
    let v24 = v19 + v23;
    let v25 = v15 + v24;
    let v26 = v14 + v25;

    out[2] = -v26;
    out
}

/// Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).
///
/// 26 operations.
pub fn nu(_q: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let v1 = t + 1.0;
    let v2 = libm::sqrt(v1);
    let v3 = f64::from(0.5 < t);
    let v4 = -t;
    let v5 = libm::exp(v4);
    let v6 = libm::hypot(t, v5);
    let v7 = 2.0 * t;
    let (s8, c8) = sin_cos(v7);
    let (s9, c9) = sin_cos(t);
    let v10 = 2.0 * v2;
    let v11 = 1.0 / v10;
    let v12 = v2 * v2;
    let v13 = v11 * v12;
    let v14 = 3.0 * v13;
    let v15 = select(v3, 1.0, 0.0);
    let v16 = t / v6;
    let v17 = v5 / v6;
    let v18 = v5 * v17;
    let v19 = v16 - v18;
    let v20 = s9 * s8;
    let v21 = -2.0 * v20;
    let v22 = c8 * c9;
    let v23 = v21 + v22;
    let v24 = v19 + v23;
    let v25 = v15 + v24;
    let v26 = v14 + v25;

    out[2] = v26;
    out
}

/// Right side of the acceleration equation `phi_q qdd = gamma` (the equation's unit per s^2).
///
/// 44 operations.
pub fn gamma(_q: &[f64; N], _qd: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let v1 = t + 1.0;
    let v2 = libm::sqrt(v1);
    let v3 = -t;
    let v4 = libm::exp(v3);
    let v5 = libm::hypot(t, v4);
    let v6 = 2.0 * t;
    let (s7, c7) = sin_cos(v6);
    let (s8, c8) = sin_cos(t);
    let v9 = c7 * s8;
    let v10 = 2.0 * v2;
    let v11 = 1.0 / v10;
    let v12 = v2 * v2;
    let v13 = t / v5;
    let v14 = v4 / v5;
    let v15 = v4 * v14;
    let v16 = v13 - v15;
    let v17 = v11 / v10;
    let v18 = v11 * v17;
    let v19 = v2 * v11;
    let v20 = v12 * v18;
    let v21 = -2.0 * v20;
    let v22 = v11 * v19;
    let v23 = 2.0 * v22;
    let v24 = v21 + v23;
    let v25 = 3.0 * v24;
    let v26 = 1.0 / v5;
    let v27 = v13 / v5;
    let v28 = v16 * v27;
    let v29 = v26 - v28;
    let v30 = v14 / v5;
    let v31 = v16 * v30;
    let v32 = v14 + v31;
    let v33 = v4 * v32;
    let v34 = v15 + v33;
    let v35 = v29 + v34;
    let v36 = s7 * c8;
    let v37 = 2.0 * v9;
    let v38 = v36 + v37;
    let v39 = -2.0 * v38;
    let v40 = -2.0 * v36;
    let v41 = v40 - v9;
    let v42 = v39 + v41;
    let v43 = v35 + v42;
    let v44 = v25 + v43;

    out[2] = v44;
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
