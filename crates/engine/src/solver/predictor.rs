//! The predictor of Newton: the curve through the ends of a step, corrected by the step before.

use mechc_expr::math::{along, value_and_derivatives};

/// The difference between the curve through the ends of two steps and the one through the ends of the later step: `(x (1 − x))³` times a parabola,
/// with `x` the fraction of the later step.
///
/// Value, slope and curvature at three nodes make a Hermite polynomial of degree 8. It is closer to the motion by orders of magnitude, so that mostly
/// one iteration is enough.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Bend {
    /// The length of the step before, as a multiple of this one.
    back: f64,
    /// The coefficients of the parabola, in powers of `x + back`.
    parabola: [f64; 3],
}

impl Bend {
    /// No correction, for a motion without a step before.
    pub const NONE: Bend = Bend { back: 0.0, parabola: [0.0; 3] };

    /// Computes the correction of a step's curve from value, slope and curvature, with respect to the fraction of this step, at the start of the step
    /// before, `back` step lengths earlier.
    #[must_use]
    pub fn new(curve: &[f64; 6], [value, slope, curvature]: [f64; 3], back: f64) -> Bend {
        let x = -back;
        // the value that the curve misses there, and the factor (x (1 − x))³, each with two derivatives
        let on_curve = value_and_derivatives(curve, x);
        let missing = [value - on_curve[0], slope - on_curve[1], curvature - on_curve[2]];
        let (u, du) = (x * (1.0 - x), 1.0 - 2.0 * x);
        let factor = [u * u * u, 3.0 * u * u * du, 6.0 * u * (du * du - u)];
        let first = missing[0] / factor[0];
        let second = (missing[1] - factor[1] * first) / factor[0];
        let third = (missing[2] - 2.0 * factor[1] * second - factor[2] * first) / factor[0];
        Bend { back, parabola: [first, second, 0.5 * third] }
    }

    /// Evaluates the corrected curve at a fraction of the step.
    #[must_use]
    #[inline(always)]
    #[allow(clippy::inline_always)] // inlined into loops over lanes
    pub fn on_curve(&self, curve: &[f64; 6], x: f64) -> f64 {
        let u = x * (1.0 - x);
        let s = x + self.back;
        let bend = self.parabola[0] + s * (self.parabola[1] + s * self.parabola[2]);
        along(curve, x) + u * u * u * bend
    }
}

#[cfg(test)]
mod tests {
    use super::Bend;
    use mechc_expr::math::quintic;

    /// Returns a polynomial and its first two derivatives.
    fn polynomial(c: &[f64], x: f64) -> [f64; 3] {
        let power = |k: usize, order: usize| {
            let factor: f64 = (0..order).map(|i| k as f64 - i as f64).product();
            if k < order { 0.0 } else { factor * (0..k - order).map(|_| x).product::<f64>() }
        };
        [0, 1, 2].map(|order| c.iter().enumerate().map(|(k, c)| c * power(k, order)).sum())
    }

    #[test]
    fn polynomials_of_degree_eight_are_exact() {
        let c = [0.3, -1.2, 0.7, 0.4, -0.9, 1.1, -0.6, 0.2, 0.8];
        let (a, b) = (polynomial(&c, 0.0), polynomial(&c, 1.0));
        let curve = quintic(a, b, 1.0);
        for back in [0.5, 1.0, 2.0] {
            let bend = Bend::new(&curve, polynomial(&c, -back), back);
            for k in 0..=10 {
                let x = 0.1 * f64::from(k);
                let (value, expected) = (bend.on_curve(&curve, x), polynomial(&c, x)[0]);
                assert!((value - expected).abs() < 1e-13, "at {x} after {back}: {value} instead of {expected}");
            }
        }
    }
}
