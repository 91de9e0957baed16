//! Places that are no special ones.

use mechc_expr::math::GOLDEN;

/// How far a coordinate goes where all are moved at once, from 0.5 to 1.5: another way for each, so that nothing cancels.
pub fn aslant(column: usize) -> f64 {
    0.5 + (GOLDEN * column as f64).fract()
}
