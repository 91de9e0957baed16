//! Where a number lies in a table.

/// The piece of a table that `x` lies in, counted from 0.
pub fn piece(x: f64, knots: &[f64]) -> f64 {
    if x.is_nan() {
        return x;
    }
    let (mut low, mut high) = (0, knots.len().saturating_sub(1));
    for _ in 0..usize::BITS {
        if high - low <= 1 {
            break;
        }
        let middle = low + (high - low) / 2;
        if knots.get(middle).is_some_and(|knot| *knot <= x) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low as f64
}
