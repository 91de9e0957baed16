// Searches that end at neighbouring doubles.

/// Returns neighbouring doubles of which `holds` is true at the first and false at the second, as at the two given places; or
/// the interval that `most` halvings leave.
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

/// Returns a time (s) after any event that is meant to happen at `t`, later by about `slack` units in its last place.
#[must_use]
pub fn shortly_after(t: f64, slack: f64) -> f64 {
    t + slack * f64::EPSILON * t.abs() + f64::MIN_POSITIVE
}
