//! Constraint system of mechanism `slider_crank`, written by mechc 0.1.0 from `slider_crank.mech`.
//!
//! - coordinates `q`: 9 (m, rad), equations `phi = 0`: 9
//! - `phi_q`: 17 entries that do not vanish, see [`PHI_Q_PATTERN`]
//! - parameters: 3; those that follow from others are worked out
//! - needs no other crate

#![allow(clippy::approx_constant, clippy::eq_op)]
#![allow(clippy::excessive_precision, clippy::large_const_arrays)]

/// The parameters, in SI; those of the file by default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// `crank_length` (m)
    pub crank_length: f64,
    /// `rod_length` (m)
    pub rod_length: f64,
    /// `speed` (1/s)
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

/// Number of coordinates, and of equations.
pub const N: usize = 9;

/// Number of entries of `phi_q` that do not vanish.
pub const ENTRIES: usize = 17;

/// Where each coordinate stands in `q`.
pub mod coordinate {
    /// `crank.x` (m)
    pub const CRANK_X: usize = 0;
    /// `crank.y` (m)
    pub const CRANK_Y: usize = 1;
    /// `crank.phi` (rad)
    pub const CRANK_PHI: usize = 2;
    /// `rod.x` (m)
    pub const ROD_X: usize = 3;
    /// `rod.y` (m)
    pub const ROD_Y: usize = 4;
    /// `rod.phi` (rad)
    pub const ROD_PHI: usize = 5;
    /// `piston.x` (m)
    pub const PISTON_X: usize = 6;
    /// `piston.y` (m)
    pub const PISTON_Y: usize = 7;
    /// `piston.phi` (rad)
    pub const PISTON_PHI: usize = 8;
}

/// Which equation each joint, constraint or driver wrote.
pub mod row {
    /// joint `main 1`
    pub const MAIN_1: usize = 0;
    /// joint `main 2`
    pub const MAIN_2: usize = 1;
    /// joint `big 1`
    pub const BIG_1: usize = 2;
    /// joint `big 2`
    pub const BIG_2: usize = 3;
    /// joint `small 1`
    pub const SMALL_1: usize = 4;
    /// joint `small 2`
    pub const SMALL_2: usize = 5;
    /// joint `barrel 1`
    pub const BARREL_1: usize = 6;
    /// joint `barrel 2`
    pub const BARREL_2: usize = 7;
    /// driver `motor`
    pub const MOTOR: usize = 8;
}

/// Row and column of each value that [`phi_q`] gives.
#[rustfmt::skip]
pub const PHI_Q_PATTERN: [(usize, usize); ENTRIES] = [
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

/// The residual of the equations (m, m^2 or rad).
///
/// 20 operations.
pub fn phi(q: &[f64; N], t: f64, p: &Params) -> [f64; N] {
    let p0 = p.crank_length;
    let rod_length = p.rod_length;
    let p2 = p.speed;
    let q0 = q[0];
    let q1 = q[1];
    let q2 = q[2];
    let rod_x = q[3];
    let rod_y = q[4];
    let rod_phi = q[5];
    let piston_x = q[6];
    let piston_y = q[7];
    let piston_phi = q[8];
    let v1 = t * p2;
    let v2 = 0.5235987755982988 + v1;
    let (s3, _) = sin_cos(piston_phi);
    let (s4, c4) = sin_cos(q2);
    let v5 = -q0;
    let v6 = -q1;
    let v7 = c4 * p0;
    let v8 = s4 * p0;
    let v9 = q0 + v7;
    let v10 = q1 + v8;
    let (s11, c11) = sin_cos(rod_phi);
    let v12 = v9 - rod_x;
    let v13 = v10 - rod_y;
    let v14 = c11 * rod_length;
    let v15 = s11 * rod_length;
    let v16 = rod_x + v14;
    let v17 = rod_y + v15;
    let v18 = v16 - piston_x;
    let v19 = v17 - piston_y;
    let v20 = q2 - v2;
    let mut out = [0.0; N];
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

/// The Jacobian: the values of its entries, in the order of [`PHI_Q_PATTERN`].
///
/// 9 operations.
pub fn phi_q(q: &[f64; N], _t: f64, p: &Params) -> [f64; ENTRIES] {
    let p0 = p.crank_length;
    let rod_length = p.rod_length;
    let q2 = q[2];
    let rod_phi = q[5];
    let piston_phi = q[8];
    let (_, c1) = sin_cos(piston_phi);
    let (s2, c2) = sin_cos(q2);
    let v3 = c2 * p0;
    let v4 = s2 * p0;
    let (s5, c5) = sin_cos(rod_phi);
    let v6 = c5 * rod_length;
    let v7 = s5 * rod_length;
    let v8 = -v4;
    let v9 = -v7;
    let mut out = [0.0; ENTRIES];
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

/// The partial derivative of `phi` by time.
///
/// 0 operations.
pub fn phi_t(_q: &[f64; N], _t: f64, p: &Params) -> [f64; N] {
    let p2 = p.speed;
    let mut out = [0.0; N];
    out[8] = -p2;
    out
}

/// Right side of the velocity equation `phi_q qd = nu`.
///
/// 0 operations.
pub fn nu(_q: &[f64; N], _t: f64, p: &Params) -> [f64; N] {
    let p2 = p.speed;
    let mut out = [0.0; N];
    out[8] = p2;
    out
}

/// Right side of the acceleration equation `phi_q qdd = gamma`.
///
/// 17 operations.
pub fn gamma(q: &[f64; N], qd: &[f64; N], _t: f64, p: &Params) -> [f64; N] {
    let p0 = p.crank_length;
    let rod_length = p.rod_length;
    let q2 = q[2];
    let rod_phi = q[5];
    let piston_phi = q[8];
    let qd2 = qd[2];
    let rod_phi_d = qd[5];
    let piston_phi_d = qd[8];
    let (s1, _) = sin_cos(piston_phi);
    let (s2, c2) = sin_cos(q2);
    let (s3, c3) = sin_cos(rod_phi);
    let v4 = s2 * qd2;
    let v5 = c2 * qd2;
    let v6 = s3 * rod_phi_d;
    let v7 = c3 * rod_phi_d;
    let v8 = s1 * piston_phi_d;
    let v9 = piston_phi_d * v8;
    let v10 = qd2 * v5;
    let v11 = qd2 * v4;
    let v12 = p0 * v10;
    let v13 = p0 * v11;
    let v14 = rod_phi_d * v7;
    let v15 = rod_phi_d * v6;
    let v16 = rod_length * v14;
    let v17 = rod_length * v15;
    let mut out = [0.0; N];
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
    for ((row, column), value) in PHI_Q_PATTERN.into_iter().zip(phi_q(q, t, p)) {
        full[row][column] = value;
    }
    full
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
    let cube = z * r;
    let higher = 8.333_333_333_322_49e-3
        + z * (-1.984_126_982_985_795e-4
            + z * (2.755_731_370_707_006_8e-6 + z * (-2.505_076_025_340_686_3e-8 + z * 1.589_690_995_211_55e-10)));
    r - ((z * (0.5 * tail - cube * higher) - tail) + cube * 1.666_666_666_666_663_2e-1)
}

/// `cos(r + tail)` for `|r| <= pi/4`, the tail below an ulp of r.
#[inline]
pub(super) fn cos_near_zero(r: f64, tail: f64) -> f64 {
    let z = r * r;
    let higher = z
        * (4.166_666_666_666_66e-2
            + z * (-1.388_888_888_887_411e-3
                + z * (2.480_158_728_947_673e-5
                    + z * (-2.755_731_435_139_066_3e-7
                        + z * (2.087_572_321_298_175e-9 - z * 1.135_964_755_778_819_5e-11)))));
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
