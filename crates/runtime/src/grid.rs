// The grid on which Newton's iteration goes from point to point.
//
// It goes to the point next to the solution, as often as that takes, and ends where all corrections stay in their cells: so where it began
// leaves no trace. Of a coordinate on the border of two cells, to rounding, either point may say that the other one is nearer, or that
// it is so itself. Therefore such a border is judged from one side alone. All coordinates whose corrections end next to a border
// go to the even one of the two points, the others stay; and from there each goes to where its correction leads, for good.

/// The grid point next to a value.
#[must_use]
#[inline]
pub fn on_grid(x: f64, cell: f64) -> f64 {
    // adding and taking away 1.5 * 2^52 cells rounds to a whole number of them
    let rounding = 6_755_399_441_055_744.0 * cell;
    (x + rounding) - rounding
}

/// The largest correction, in cells, with which an iteration ends that has met no border; one that is no farther from half a cell than
/// `border` leads to one.
#[must_use]
#[inline]
pub fn bound_at_first(border: f64) -> f64 {
    0.5 - border
}

/// How an iteration goes on whose largest correction, in cells, is beyond its bound: the bound that it has then; and the cells, in cells,
/// among whose points those coordinates go on that are next to a border.
#[must_use]
#[inline]
pub fn going_on(largest: f64, bound: f64, border: f64) -> (f64, f64) {
    let is_free = bound < 0.5;
    let is_at_border = is_free && largest <= 0.5 + border;
    // at the even points only what is beyond the border goes on; behind that nothing does that is no stray
    let next = if is_free { bound } else { 1.0 };
    (if is_at_border { 0.5 } else { next }, if is_at_border { 2.0 } else { 1.0 })
}

/// The grid point that a coordinate goes on to, from one and its correction there.
#[must_use]
#[inline]
pub fn next_point(x: f64, delta: f64, cell: f64, cells: f64, border: f64) -> f64 {
    // from an odd point the even one in the direction of the correction, from an even one none
    let is_at_border = delta.abs() > (0.5 - border) * cell;
    on_grid(x + delta, if is_at_border { cells * cell } else { cell })
}
