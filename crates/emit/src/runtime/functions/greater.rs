//! The larger of two numbers.

/// The larger one; not a number if either is not.
pub fn greater(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}
