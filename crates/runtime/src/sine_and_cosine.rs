// Sine and cosine of one angle (rad), together: the same bits on every platform, within 1 ulp, for arguments of any size.
//
// The angle is reduced to |r + tail| <= pi/4 with `angle = n pi/2 + r + tail`: up to a million by subtracting n times
// pi/2 in pieces of 33 bits, whose products are exact (W. Cody and W. Waite, Software Manual for the Elementary
// Functions, 1980); above by as many bits of 2/pi as the angle asks for (M. Payne and R. Hanek, Radian Reduction for
// Trigonometric Functions, 1983). The coefficients of the two polynomials are those of Sun's fdlibm.

/// Below it an angle (rad) is small: it is reduced in pieces whose products are exact.
pub const A_MILLION: f64 = 1e6;

/// Sine and cosine of an angle in radians; not a number for an angle that is not finite.
#[must_use]
#[inline]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    if !angle.is_finite() {
        return (f64::NAN, f64::NAN);
    }
    let (quarter, r, tail) = if angle.abs() < A_MILLION { reduce_small(angle) } else { reduce_large(angle) };
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
