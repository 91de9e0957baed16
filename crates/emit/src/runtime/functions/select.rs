//! A choice.

/// The second if the first is not 0, else the third.
pub fn select(condition: f64, a: f64, b: f64) -> f64 {
    if condition == 0.0 { b } else { a }
}
