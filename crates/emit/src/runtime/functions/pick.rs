//! What a table has for a piece.

/// The entry of a column for a piece.
pub fn pick(column: &[f64], piece: f64) -> f64 {
    if piece.is_nan() {
        return piece;
    }
    column.get(piece as usize).copied().unwrap_or(f64::NAN)
}
