//! Size of letters and width of texts.

use unicode_width::UnicodeWidthChar;

/// Size of letters of the smallest and the largest pictures (px).
const SIZES: [f64; 2] = [13.0, 18.0];
/// Size of letters as a part of the picture's shorter side.
const SIZE: f64 = 1.0 / 42.0;
/// Width of a column as a part of the size of letters: on average, wide fonts are no wider.
pub(super) const COLUMN: f64 = 0.66;

/// Returns the size of letters (px) for a picture of a size (px).
pub(super) fn letters(size: [f64; 2]) -> f64 {
    (SIZE * size[0].min(size[1])).clamp(SIZES[0], SIZES[1])
}

/// Returns the number of columns of a text on a screen.
pub(super) fn columns(text: &str) -> usize {
    text.chars().map(|c| c.width().unwrap_or(0)).sum()
}
