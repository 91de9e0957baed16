//! Kinematics of mechanism `odd`, written by mechc 0.1.0 from `names.mech`.
//!
//! - coordinates `q`: 6 (m, rad), equations `phi = 0`: 6
//! - `phi_q`: 11 entries that do not vanish, see [`PHI_Q_PATTERN`]
//! - parameters: 5; those that follow from others are worked out
//! - needs no other crate
//! - needs no heap and no standard library; nothing in it panics
//!
//! This code carries no licence of mechc's: use, change and pass it on as you like.

#![allow(clippy::approx_constant, clippy::eq_op, clippy::neg_multiply)]
#![allow(clippy::excessive_precision, clippy::large_const_arrays)]

use runtime::sine_and_cosine::sin_cos;

/// The parameters, in SI; those of the file by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// `fn_` (1), line 2
    pub fn_: f64,
    /// `Self` (1/s), line 3
    pub self_: f64,
    /// `é` (1), line 4
    pub u00e9: f64,
    /// `R` (m), line 5
    pub r: f64,
    /// `r` (m), line 6
    pub r_2: f64,
}

impl Default for Params {
    #[rustfmt::skip]
    fn default() -> Self {
        Self {
            fn_: 2.0,
            self_: 1.0,
            u00e9: 0.5235987755982988,
            r: 1.0,
            r_2: 2.0,
        }
    }
}

/// Number of coordinates, and of equations.
pub const N: usize = 6;

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
    /// `loop.x` (m), line 8
    pub const LOOP_X: usize = 0;
    /// `loop.y` (m), line 8
    pub const LOOP_Y: usize = 1;
    /// `loop.phi` (rad), line 8
    pub const LOOP_PHI: usize = 2;
    /// `Loop.x` (m), line 9
    pub const LOOP_X_2: usize = 3;
    /// `Loop.y` (m), line 9
    pub const LOOP_Y_2: usize = 4;
    /// `Loop.phi` (rad), line 9
    pub const LOOP_PHI_2: usize = 5;
}

/// Which equation each joint, constraint or driver wrote, and its unit.
pub mod row {
    /// joint `LOOP 1` (m), line 10
    pub const LOOP_1: usize = 0;
    /// joint `LOOP 2` (m), line 10
    pub const LOOP_2: usize = 1;
    /// joint `self 1` (m), line 11
    pub const SELF_1: usize = 2;
    /// joint `self 2` (m), line 11
    pub const SELF_2: usize = 3;
    /// driver `match` (rad), line 12
    pub const MATCH: usize = 4;
    /// driver `impl` (rad), line 13
    pub const IMPL: usize = 5;
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
    (4, 2),
    (5, 2),
    (5, 5),
];

/// The bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// `loop`, line 8
    Loop,
    /// `Loop`, line 9
    Loop2,
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
            Body::Loop => Self { x: q[0], y: q[1], phi: q[2] },
            Body::Loop2 => Self { x: q[3], y: q[4], phi: q[5] },
        }
    }
}

/// The residual of the equations, each in its unit: see [`row`].
///
/// 17 operations.
pub fn phi(q: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let self_ = p.self_;
    let u00e9 = p.u00e9;
    let loop_phi_2 = q[5];
    let loop_phi = q[2];
    let loop_x = q[0];
    let loop_y = q[1];
    let r = p.r;
    let loop_x_2 = q[3];
    let loop_y_2 = q[4];
    let fn_ = p.fn_;
    let r_2 = p.r_2;

    let v1 = t * self_;
    let v2 = u00e9 + v1;
    let v3 = loop_phi_2 - loop_phi;
    let (s4, c4) = sin_cos(loop_phi);
    let v5 = -loop_x;
    let v6 = -loop_y;
    let v7 = c4 * r;
    let v8 = s4 * r;
    let v9 = loop_x + v7;
    let v10 = loop_y + v8;
    let v11 = v9 - loop_x_2;
    let v12 = v10 - loop_y_2;
    let v13 = loop_phi - v2;
    let v14 = loop_phi * fn_;
    let v15 = v14 * r_2;
    let v16 = v15 / r;
    let v17 = v3 - v16;

    out[0] = v5;
    out[1] = v6;
    out[2] = v11;
    out[3] = v12;
    out[4] = v13;
    out[5] = v17;
    out
}

/// The Jacobian: the values of its entries, in the order of [`PHI_Q_PATTERN`] (the equation's unit per m or
/// rad).
///
/// 8 operations.
pub fn phi_q(q: &[f64; N], _t: f64, p: &Params) -> [f64; ENTRIES] {
    let mut out = [0.0; ENTRIES];
    let r = p.r;
    let r_2 = p.r_2;
    let fn_ = p.fn_;
    let loop_phi = q[2];

    let v1 = -1.0 / r;
    let v2 = r_2 * v1;
    let v3 = fn_ * v2;
    let v4 = -1.0 + v3;
    let (s5, c5) = sin_cos(loop_phi);
    let v6 = c5 * r;
    let v7 = s5 * r;
    let v8 = -v7;

    out[0] = -1.0;
    out[1] = -1.0;
    out[2] = 1.0;
    out[3] = v8;
    out[4] = -1.0;
    out[5] = 1.0;
    out[6] = v6;
    out[7] = -1.0;
    out[8] = 1.0;
    out[9] = v4;
    out[10] = 1.0;
    out
}

/// The partial derivative of `phi` by time (the equation's unit per s).
///
/// 0 operations.
pub fn phi_t(_q: &[f64; N], _t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let self_ = p.self_;

    out[4] = -self_;
    out
}

/// Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).
///
/// 0 operations.
pub fn nu(_q: &[f64; N], _t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let self_ = p.self_;

    out[4] = self_;
    out
}

/// Right side of the acceleration equation `phi_q qdd = gamma` (the equation's unit per s^2).
///
/// 7 operations.
pub fn gamma(q: &[f64; N], qd: &[f64; N], _t: f64, p: &Params) -> [f64; N] {
    let mut out = [0.0; N];
    let loop_phi = q[2];
    let loop_phi_d = qd[2];
    let r = p.r;

    let (s1, c1) = sin_cos(loop_phi);
    let v2 = s1 * loop_phi_d;
    let v3 = c1 * loop_phi_d;
    let v4 = loop_phi_d * v3;
    let v5 = loop_phi_d * v2;
    let v6 = r * v4;
    let v7 = r * v5;

    out[2] = v6;
    out[3] = v7;
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
