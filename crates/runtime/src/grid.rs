// The grid on which Newton's iteration moves from point to point.
//
// The iteration ends at the point nearest to the solution, where all corrections stay within their cells, so its start leaves no
// trace. If a coordinate is on the border of two cells, rounding may make either point the nearer one, seen from itself or from the
// other. Therefore such a border is judged from one side alone: all coordinates whose corrections end next to a border go to the
// even one of the two points, the others stay; from there each goes where its correction leads, and stays there.

/// Returns the grid point nearest to a value.
#[must_use]
#[inline]
pub fn on_grid(x: f64, cell: f64) -> f64 {
    // adding and taking away 1.5 * 2^52 cells rounds to a whole number of them
    let rounding = 6_755_399_441_055_744.0 * cell;
    (x + rounding) - rounding
}

/// Returns the largest correction, in cells, with which an iteration that has met no border ends. A correction within `border` of half
/// a cell is at a border.
#[must_use]
#[inline]
pub fn bound_at_first(border: f64) -> f64 {
    0.5 - border
}

/// Returns, for an iteration whose largest correction exceeds `bound` (both in cells), its next bound; and the spacing, in cells, of the
/// points to which coordinates next to a border go.
#[must_use]
#[inline]
pub fn going_on(largest: f64, bound: f64, border: f64) -> (f64, f64) {
    let is_free = bound < 0.5;
    let is_at_border = is_free && largest <= 0.5 + border;
    // at the even points only what is beyond the border goes on; behind that nothing does that is no stray
    let next = if is_free { bound } else { 1.0 };
    (if is_at_border { 0.5 } else { next }, if is_at_border { 2.0 } else { 1.0 })
}

/// Returns the next grid point of a coordinate, from the current one and the correction there.
#[must_use]
#[inline]
pub fn next_point(x: f64, delta: f64, cell: f64, cells: f64, border: f64) -> f64 {
    // from an odd point the even one in the direction of the correction, from an even one none
    let is_at_border = delta.abs() > (0.5 - border) * cell;
    on_grid(x + delta, if is_at_border { cells * cell } else { cell })
}
