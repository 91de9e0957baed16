//! Curves between the ends of a step, by their coefficients in the part of the step.

use super::hermite::higher_terms;

/// The quintic with value, slope and curvature of both ends of a step of length `h`, by its coefficients in the part of the step. An
/// end is value, first and second derivative.
#[must_use]
pub fn quintic([q, qd, qdd]: [f64; 3], [q_end, qd_end, qdd_end]: [f64; 3], h: f64) -> [f64; 6] {
    let (way, slope, bend) = (q_end - q, h * qd, 0.5 * h * h * qdd);
    // what is left of value, slope and half the curvature at the end
    let left = [way - slope - bend, h * qd_end - slope - 2.0 * bend, 0.5 * h * h * qdd_end - bend];
    let [cubic, quartic, quintic] = higher_terms(left);
    [q, slope, bend, cubic, quartic, quintic]
}

/// The integral of the quintic with value, slope and curvature of both ends of a step of length `h`.
#[must_use]
pub fn integral_of_quintic([q, qd, qdd]: [f64; 3], [q_end, qd_end, qdd_end]: [f64; 3], h: f64) -> f64 {
    0.5 * h * (q + q_end) + h * h / 10.0 * (qd - qd_end) + h * h * h / 120.0 * (qdd + qdd_end)
}

/// The cubic with value and slope of both ends of a step of length `h` (Hermite), as such a curve.
#[must_use]
pub fn cubic([q, qd]: [f64; 2], [q_end, qd_end]: [f64; 2], h: f64) -> [f64; 6] {
    let (way, slope, end_slope) = (q_end - q, h * qd, h * qd_end);
    [q, slope, 3.0 * way - 2.0 * slope - end_slope, slope + end_slope - 2.0 * way, 0.0, 0.0]
}

/// The parabola that value, slope and curvature at the start of a step of length `h` lead along, as such a curve.
#[must_use]
pub fn parabola([q, qd, qdd]: [f64; 3], h: f64) -> [f64; 6] {
    [q, h * qd, 0.5 * h * h * qdd, 0.0, 0.0, 0.0]
}

/// A curve's value at a part of its step.
#[must_use]
#[inline(always)]
#[allow(clippy::inline_always)] // for several lanes at once
pub fn along(curve: &[f64; 6], x: f64) -> f64 {
    curve.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// Value, slope and curvature of a curve at a part of its step.
#[must_use]
pub fn value_and_slopes(curve: &[f64; 6], x: f64) -> [f64; 3] {
    let [_, c1, c2, c3, c4, c5] = *curve;
    let slope = c1 + x * (2.0 * c2 + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)));
    let curvature = 2.0 * c2 + x * (6.0 * c3 + x * (12.0 * c4 + x * 20.0 * c5));
    [along(curve, x), slope, curvature]
}

/// Where value, first and second derivative lead in a time `h`.
#[must_use]
pub fn predicted([q, qd, qdd]: [f64; 3], h: f64) -> f64 {
    q + h * (qd + 0.5 * h * qdd)
}

/// The coefficients of a curve about another place.
#[must_use]
pub fn about(curve: &[f64; 6], place: f64) -> [f64; 6] {
    let mut taylor = *curve;
    for order in 0..taylor.len() {
        for j in (order..taylor.len() - 1).rev() {
            taylor[j] += place * taylor[j + 1];
        }
    }
    taylor
}

/// How far a polynomial without its constant, by its coefficients, comes within `reach` of 0 at most.
#[must_use]
pub fn farthest(higher: &[f64], reach: f64) -> f64 {
    higher.iter().rev().fold(0.0, |sum, c| (sum + c.abs()) * reach)
}

/// What a quantity can be between two values that are `h` apart, its slope being in a range; in order.
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
