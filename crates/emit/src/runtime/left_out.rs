//! Equations that were left out, since they follow from the others.

use super::limits::LARGEST_OPENING;

/// Whether what is left of them is nothing, beside their scales.
pub fn left_out_holds(left: &[f64], scales: &[f64]) -> bool {
    let mut pairs = left.iter().zip(scales);
    pairs.all(|(value, scale)| value.abs() / scale <= LARGEST_OPENING)
}
