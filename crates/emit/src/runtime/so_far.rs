//! What is the largest, found one by one.

/// What is the largest so far, in the loops that solve, which have time for one comparison: a value that is not a number wins, but only
/// until the next. What it comes from is not a number either, and is asked for that.
pub fn larger_so_far(largest: f64, value: f64) -> f64 {
    if value <= largest { largest } else { value }
}
