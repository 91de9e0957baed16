//! Curves between the ends of a step: polynomials in the fraction `x ∈ [0, 1]` of the step, by their coefficients in ascending order.

use super::hermite::higher_terms;

/// Returns the quintic Hermite curve over a step of length `h`. Each end is value, first and second derivative.
#[must_use]
pub fn quintic([q, qd, qdd]: [f64; 3], [q_end, qd_end, qdd_end]: [f64; 3], h: f64) -> [f64; 6] {
    let (rise, slope, bend) = (q_end - q, h * qd, 0.5 * h * h * qdd);
    // what the parabola from the start leaves of value, slope and half the curvature at the end
    let left = [rise - slope - bend, h * qd_end - slope - 2.0 * bend, 0.5 * h * h * qdd_end - bend];
    let [cubic, quartic, quintic] = higher_terms(left);
    [q, slope, bend, cubic, quartic, quintic]
}

/// Returns the integral over the step of the quintic Hermite curve with these ends.
#[must_use]
pub fn integral_of_quintic([q, qd, qdd]: [f64; 3], [q_end, qd_end, qdd_end]: [f64; 3], h: f64) -> f64 {
    0.5 * h * (q + q_end) + h * h / 10.0 * (qd - qd_end) + h * h * h / 120.0 * (qdd + qdd_end)
}

/// Returns the cubic Hermite curve over a step of length `h`. Each end is value and first derivative.
#[must_use]
pub fn cubic([q, qd]: [f64; 2], [q_end, qd_end]: [f64; 2], h: f64) -> [f64; 6] {
    let (rise, slope, end_slope) = (q_end - q, h * qd, h * qd_end);
    [q, slope, 3.0 * rise - 2.0 * slope - end_slope, slope + end_slope - 2.0 * rise, 0.0, 0.0]
}

/// Returns the parabola with value, first and second derivative at the start of a step of length `h`.
#[must_use]
pub fn parabola([q, qd, qdd]: [f64; 3], h: f64) -> [f64; 6] {
    [q, h * qd, 0.5 * h * h * qdd, 0.0, 0.0, 0.0]
}

/// Returns the value of a curve at `x`.
#[must_use]
#[inline(always)]
#[allow(clippy::inline_always)] // it is inlined into loops over lanes
pub fn along(curve: &[f64; 6], x: f64) -> f64 {
    curve.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// Returns value, first and second derivative of a curve with respect to `x`.
#[must_use]
pub fn value_and_derivatives(curve: &[f64; 6], x: f64) -> [f64; 3] {
    let [_, c1, c2, c3, c4, c5] = *curve;
    let slope = c1 + x * (2.0 * c2 + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)));
    let curvature = 2.0 * c2 + x * (6.0 * c3 + x * (12.0 * c4 + x * 20.0 * c5));
    [along(curve, x), slope, curvature]
}

/// Extrapolates value, first and second derivative over a time `h`.
#[must_use]
pub fn predicted([q, qd, qdd]: [f64; 3], h: f64) -> f64 {
    q + h * (qd + 0.5 * h * qdd)
}

/// Returns the coefficients of a curve in powers of `x − center` (Taylor shift).
#[must_use]
pub fn about(curve: &[f64; 6], center: f64) -> [f64; 6] {
    let mut taylor = *curve;
    for order in 0..taylor.len() {
        for j in (order..taylor.len() - 1).rev() {
            taylor[j] += center * taylor[j + 1];
        }
    }
    taylor
}

/// Returns a bound of the polynomial `Σ higher[k] xᵏ⁺¹`, which has no constant term, for `|x| ≤ reach`.
#[must_use]
pub fn farthest(higher: &[f64], reach: f64) -> f64 {
    higher.iter().rev().fold(0.0, |sum, c| (sum + c.abs()) * reach)
}

/// Returns the range `[low, high]` of a quantity between two values at the distance `h`, whose slope stays in `[least, most]`.
#[must_use]
pub fn between(a: f64, b: f64, [least, most]: [f64; 2], h: f64) -> [f64; 2] {
    let (low, high) = (a.min(b), a.max(b));
    if least >= 0.0 || most <= 0.0 {
        return [low, high];
    }
    if !(least.is_finite() && most.is_finite()) {
        return [f64::NEG_INFINITY, f64::INFINITY];
    }
    let up = ((b - a - least * h) / (most - least)).clamp(0.0, h);
    let down = ((b - a - most * h) / (least - most)).clamp(0.0, h);
    [low.min(a + least * down), high.max(a + most * up)]
}
