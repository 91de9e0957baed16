//! Kinematics of mechanism `arm`, written by mechc 0.1.0 from `table.mech`.
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

use runtime::pick::pick;
use runtime::piece::piece;

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

/// Table `lift`: where its pieces begin, and where the last one ends.
#[rustfmt::skip]
static LIFT_KNOTS: [f64; 4] = [
    0.0, 0.5, 1.0, 2.0,
];

/// Table `lift`: coefficient 0 of each piece.
#[rustfmt::skip]
static LIFT_C0: [f64; 3] = [
    0.0, 0.2, 1.0,
];

/// Table `lift`: coefficient 1 of each piece.
#[rustfmt::skip]
static LIFT_C1: [f64; 3] = [
    -0.004347826086956552, 1.2086956521739132, 1.1695652173913045,
];

/// Table `lift`: coefficient 2 of each piece.
#[rustfmt::skip]
static LIFT_C2: [f64; 3] = [
    0.0, 2.4260869565217393, -2.5043478260869567,
];

/// Table `lift`: coefficient 3 of each piece.
#[rustfmt::skip]
static LIFT_C3: [f64; 3] = [
    1.6173913043478263, -3.2869565217391306, 0.8347826086956522,
];

/// The residual of the equations, each in its unit: see [`row`].
///
/// 16 operations.
pub fn phi(q: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let arm_x = q[0];
    let arm_y = q[1];
    let arm_phi = q[2];

    let v1 = piece(t, &LIFT_KNOTS);
    let v2 = pick(&LIFT_KNOTS, v1);
    let v3 = t - v2;
    let v4 = pick(&LIFT_C3, v1);
    let v5 = pick(&LIFT_C2, v1);
    let v6 = v3 * v4;
    let v7 = v5 + v6;
    let v8 = pick(&LIFT_C1, v1);
    let v9 = v3 * v7;
    let v10 = v8 + v9;
    let v11 = pick(&LIFT_C0, v1);
    let v12 = v3 * v10;
    let v13 = v11 + v12;
    let v14 = -arm_x;
    let v15 = -arm_y;
    let v16 = arm_phi - v13;

    out[0] = v14;
    out[1] = v15;
    out[2] = v16;
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
/// 12 operations.
pub fn phi_t(_q: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let v1 = piece(t, &LIFT_KNOTS);
    let v2 = pick(&LIFT_KNOTS, v1);
    let v3 = t - v2;
    let v4 = pick(&LIFT_C3, v1);
    let v5 = v4 * 3.0;
    let v6 = pick(&LIFT_C2, v1);
    let v7 = v6 * 2.0;
    let v8 = v3 * v5;
    let v9 = v7 + v8;
    let v10 = pick(&LIFT_C1, v1);
    let v11 = v3 * v9;
    let v12 = v10 + v11;

    out[2] = -v12;
    out
}

/// Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).
///
/// 12 operations.
pub fn nu(_q: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let v1 = piece(t, &LIFT_KNOTS);
    let v2 = pick(&LIFT_KNOTS, v1);
    let v3 = t - v2;
    let v4 = pick(&LIFT_C3, v1);
    let v5 = v4 * 3.0;
    let v6 = pick(&LIFT_C2, v1);
    let v7 = v6 * 2.0;
    let v8 = v3 * v5;
    let v9 = v7 + v8;
    let v10 = pick(&LIFT_C1, v1);
    let v11 = v3 * v9;
    let v12 = v10 + v11;

    out[2] = v12;
    out
}

/// Right side of the acceleration equation `phi_q qdd = gamma` (the equation's unit per s^2).
///
/// 9 operations.
pub fn gamma(_q: &[f64; N], _qd: &[f64; N], t: f64, _p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let v1 = piece(t, &LIFT_KNOTS);
    let v2 = pick(&LIFT_KNOTS, v1);
    let v3 = t - v2;
    let v4 = pick(&LIFT_C3, v1);
    let v5 = v4 * 6.0;
    let v6 = pick(&LIFT_C2, v1);
    let v7 = v6 * 2.0;
    let v8 = v3 * v5;
    let v9 = v7 + v8;

    out[2] = v9;
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
