//! Kinematics of mechanism `arm`, written by mechc 0.1.0 from `params.mech`.
//!
//! - coordinates `q`: 9 (m, rad), equations `phi = 0`: 9
//! - `phi_q`: 11 entries that do not vanish, see [`PHI_Q_PATTERN`]
//! - parameters: 3; those that follow from others are worked out
//! - needs no other crate
//! - needs no heap and no standard library; nothing in it panics
//!
//! This code carries no licence of mechc's: use, change and pass it on as you like.

#![allow(clippy::approx_constant, clippy::eq_op, clippy::neg_multiply)]
#![allow(clippy::excessive_precision, clippy::large_const_arrays)]

/// The parameters, in SI; those of the file by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// `reach` (m), line 5
    pub reach: f64,
    /// Those of `other`, by its numbers.
    pub other: [OtherParams; 2],
}

/// The parameters of a part, as `other[0]`, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherParams {
    /// `length` (m), line 10
    pub length: f64,
}

impl Default for Params {
    #[rustfmt::skip]
    fn default() -> Self {
        Self {
            reach: 0.5,
            other: [
                OtherParams {
                    length: 0.3,
                },
                OtherParams {
                    length: 0.3,
                },
            ],
        }
    }
}

/// Number of coordinates, and of equations.
pub const N: usize = 9;

/// Number of entries of `phi_q` that do not vanish.
pub const ENTRIES: usize = 11;

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
    /// `other[0].bar.x` (m), line 13
    pub const OTHER_0_BAR_X: usize = 3;
    /// `other[0].bar.y` (m), line 13
    pub const OTHER_0_BAR_Y: usize = 4;
    /// `other[0].bar.phi` (rad), line 13
    pub const OTHER_0_BAR_PHI: usize = 5;
    /// `other[1].bar.x` (m), line 13
    pub const OTHER_1_BAR_X: usize = 6;
    /// `other[1].bar.y` (m), line 13
    pub const OTHER_1_BAR_Y: usize = 7;
    /// `other[1].bar.phi` (rad), line 13
    pub const OTHER_1_BAR_PHI: usize = 8;
}

/// Which equation each joint, constraint or driver wrote, and its unit.
pub mod row {
    /// joint `main 1` (m), line 4
    pub const MAIN_1: usize = 0;
    /// joint `main 2` (m), line 4
    pub const MAIN_2: usize = 1;
    /// joint `other[0].pin 1` (m), line 14
    pub const OTHER_0_PIN_1: usize = 2;
    /// joint `other[0].pin 2` (m), line 14
    pub const OTHER_0_PIN_2: usize = 3;
    /// joint `other[1].pin 1` (m), line 14
    pub const OTHER_1_PIN_1: usize = 4;
    /// joint `other[1].pin 2` (m), line 14
    pub const OTHER_1_PIN_2: usize = 5;
    /// constraint `other[0].motor` (rad), line 15
    pub const OTHER_0_MOTOR: usize = 6;
    /// constraint `other[1].motor` (rad), line 15
    pub const OTHER_1_MOTOR: usize = 7;
    /// driver `motor` (rad), line 7
    pub const MOTOR: usize = 8;
}

/// Row and column of each value that [`phi_q`] gives.
#[rustfmt::skip]
pub static PHI_Q_PATTERN: [(usize, usize); ENTRIES] = [
    (0, 0),
    (1, 1),
    (2, 3),
    (3, 4),
    (4, 6),
    (5, 7),
    (6, 2),
    (6, 5),
    (7, 2),
    (7, 8),
    (8, 2),
];

/// The bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// `arm`, line 3
    Arm,
    /// `other[0].bar`, line 13
    Other0Bar,
    /// `other[1].bar`, line 13
    Other1Bar,
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
            Body::Other0Bar => Self { x: q[3], y: q[4], phi: q[5] },
            Body::Other1Bar => Self { x: q[6], y: q[7], phi: q[8] },
        }
    }
}

/// The residual of the equations, each in its unit: see [`row`].
///
/// 9 operations.
pub fn phi(q: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let arm_x = q[0];
    let arm_y = q[1];
    let other_0_bar_x = q[3];
    let other_0_bar_y = q[4];
    let reach = p.reach;
    let other_1_bar_x = q[6];
    let other_1_bar_y = q[7];
    let other_0_bar_phi = q[5];
    let arm_phi = q[2];
    let other_1_bar_phi = q[8];

    let v1 = -arm_x;
    let v2 = -arm_y;
    let v3 = -other_0_bar_x;
    let v4 = -other_0_bar_y;
    let v5 = reach - other_1_bar_x;
    let v6 = -other_1_bar_y;
    let v7 = other_0_bar_phi - arm_phi;
    let v8 = other_1_bar_phi - arm_phi;
    let v9 = arm_phi - t;

    out[0] = v1;
    out[1] = v2;
    out[2] = v3;
    out[3] = v4;
    out[4] = v5;
    out[5] = v6;
    out[6] = v7;
    out[7] = v8;
    out[8] = v9;
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
    out[2] = -1.0;
    out[3] = -1.0;
    out[4] = -1.0;
    out[5] = -1.0;
    out[6] = -1.0;
    out[7] = 1.0;
    out[8] = -1.0;
    out[9] = 1.0;
    out[10] = 1.0;
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
