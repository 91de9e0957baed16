/// So many units in the last place of a time it may be off from what is meant to happen then.
const SLACK: f64 = 4.0;

/// A time on the later side of whatever is meant to happen at `t` (s).
fn shortly_after(t: f64) -> f64 {
    t + SLACK * f64::EPSILON * t.abs() + f64::MIN_POSITIVE
}

/// The branches of formulas of time at a time: the later ones where they change
//# if end
/// just then, but at the end of the file's analysis the earlier ones.
//# end
//# if !end
/// just then.
//# end
fn sides_at(t: f64, m: &Model) -> Sides {
//# if end
    if t <= END && shortly_after(t) >= END {
        return sides_of_time(END - 2.0 * (shortly_after(END) - END), &m.params);
    }
//# end
    sides_of_time(shortly_after(t), &m.params)
}

/// Halvings until two times are neighbours.
const MOST_HALVINGS: usize = 100;

/// The first time of a step at which formulas of time take other branches than at its beginning;
/// its end if they do not.
fn first_edge(from: f64, to: f64, m: &Model) -> f64 {
    let here = sides_at(from, m);
    if sides_at(to, m) == here {
        return to;
    }
    let (mut near, mut far) = (from, to);
    for _ in 0..MOST_HALVINGS {
        let middle = 0.5 * (near + far);
        if middle == near || middle == far {
            break;
        }
        if sides_at(middle, m) == here {
            near = middle;
        } else {
            far = middle;
        }
    }
    far
}
