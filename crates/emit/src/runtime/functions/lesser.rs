//! The smaller of two numbers.

/// The smaller one; not a number if either is not.
pub fn lesser(a: f64, b: f64) -> f64 {
    if a.is_nan() || a < b { a } else { b }
}
