// Places that are neighbours, to the last bits.

/// Where something ceases to hold that holds at the first of two places and not at the second: two neighbouring doubles, or what
/// so many halvings leave of the interval.
#[must_use]
pub fn bisect([mut near, mut far]: [f64; 2], most: usize, mut holds: impl FnMut(f64) -> bool) -> [f64; 2] {
    for _ in 0..most {
        let middle = 0.5 * (near + far);
        let is_between = f64::min(near, far) < middle && middle < f64::max(near, far);
        if !is_between {
            break;
        }
        if holds(middle) {
            near = middle;
        } else {
            far = middle;
        }
    }
    [near, far]
}

/// A time on the later side of whatever is meant to happen at `t` (s), off by so many units in its last place.
#[must_use]
pub fn shortly_after(t: f64, slack: f64) -> f64 {
    t + slack * f64::EPSILON * t.abs() + f64::MIN_POSITIVE
}
