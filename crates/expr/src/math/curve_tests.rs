//! Tests of the curves between the ends of a step. They stand apart from code that may be emitted.

use super::curve::{about, along, farthest, parabola, predicted, quintic, value_and_derivatives};

#[test]
fn a_quintic_has_value_slope_and_curvature_of_both_ends() {
    // t⁵ from 1 to 3
    let end = |t: f64| [t * t * t * t * t, 5.0 * t * t * t * t, 20.0 * t * t * t];
    let curve = quintic(end(1.0), end(3.0), 2.0);
    for x in [0.0, 0.25, 0.5, 1.0] {
        let expected = end(1.0 + 2.0 * x)[0];
        assert!((along(&curve, x) - expected).abs() < 1e-11 * expected, "{x}");
        let [value, slope, curvature] = value_and_derivatives(&curve, x);
        // derivatives by the fraction of a step of length 2
        let found = [value, slope / 2.0, curvature / 4.0];
        let is_met =
            found.iter().zip(end(1.0 + 2.0 * x)).all(|(found, expected)| (found - expected).abs() < 1e-11 * expected);
        assert!(is_met, "{found:?} at {x}");
    }
}

#[test]
fn a_taylor_shift_keeps_the_curve() {
    let curve = [0.3, -1.2, 0.7, 0.4, -0.9, 1.1];
    let moved = about(&curve, 0.4);
    for x in [-0.3, 0.0, 0.2] {
        assert!((along(&moved, x) - along(&curve, 0.4 + x)).abs() < 1e-14);
        assert!((along(&moved, x) - moved[0]).abs() <= farthest(&moved[1..], 0.3) + 1e-15);
    }
}

#[test]
fn a_parabola_ends_at_the_extrapolated_value() {
    let start = [1.0, 2.0, 3.0];
    assert!((along(&parabola(start, 0.5), 1.0) - predicted(start, 0.5)).abs() < 1e-15);
}
