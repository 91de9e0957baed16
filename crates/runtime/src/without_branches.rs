// Sine and cosine without a branch, so that a loop over many angles does several at once.

use super::sine_and_cosine::{cos_near_zero, reduce_small, sin_near_zero};

/// Sine and cosine of an angle (rad) whose size is below a million: the bits of `sin_cos`.
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
