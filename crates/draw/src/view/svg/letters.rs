//! How large letters are, and how wide a text is.

use unicode_width::UnicodeWidthChar;

/// In pixels; for the smallest and largest pictures.
const SIZES: [f64; 2] = [13.0, 18.0];
/// As a part of the picture's shorter side.
const SIZE: f64 = 1.0 / 42.0;
/// How wide a column is as a part of the size of letters: wide letters of most fonts are no wider on the average.
pub(super) const COLUMN: f64 = 0.66;

/// The size of letters (px) of a picture of a size (px).
pub(super) fn letters(size: [f64; 2]) -> f64 {
    (SIZE * size[0].min(size[1])).clamp(SIZES[0], SIZES[1])
}

/// The columns that a text takes on a screen.
pub(super) fn columns(text: &str) -> usize {
    text.chars().map(|c| c.width().unwrap_or(0)).sum()
}
