//! A choice of which both sides are numbers.

/// As `select`, but not a number if either is not.
pub fn either(condition: f64, a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else if condition == 0.0 {
        b
    } else {
        a
    }
}
