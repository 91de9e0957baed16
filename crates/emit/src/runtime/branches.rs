//! Branches of formulas along the motion.

use super::equations::Branches;
use super::limits::{MOST_HALVINGS, SLACK};
use super::neighbours::{bisect, shortly_after};
use super::solution::{Along, Solution, Solved};
use super::work::{Work, of_sides};

/// Returns the branches of formulas of time at a time: the later ones if they change at that time, but the earlier ones at
/// the end of the file's analysis.
pub fn sides_at<M: Branches>(t: f64, m: &M, work: &mut Work) -> M::Sides {
    work.add(of_sides::<M>());
    match M::END {
        Some(end) if is_end::<M>(t) => m.sides_of_time(end - 2.0 * (shortly_after(end, SLACK) - end)),
        _ => m.sides_of_time(shortly_after(t, SLACK)),
    }
}

/// Returns whether a time is the end of the file's analysis.
fn is_end<M: Branches>(t: f64) -> bool {
    M::END.is_some_and(|end| t <= end && shortly_after(t, SLACK) >= end)
}

/// Returns the first time in a step at which formulas of time change their branches; the end of the step if they do not.
pub fn first_edge<M: Branches>(from: f64, to: f64, m: &M, work: &mut Work) -> f64 {
    let here = sides_at(from, m, work);
    if sides_at(to, m, work) == here {
        return to;
    }
    let [_, edge] = bisect([from, to], MOST_HALVINGS, |t| sides_at(t, m, work) == here);
    edge
}

/// Returns the branches at a position next to the one that is solved for.
pub fn sides_near<M: Branches>(q: &M::Q, t: f64, m: &M, work: &mut Work) -> M::Sides {
    m.sides_of_motion(q, t, &sides_at(t, m, work))
}

/// Replaces the branches of time.
pub fn with_time<M: Branches>(sides: &M::Sides, of_time: &M::Sides) -> M::Sides {
    let mut all = *sides;
    let pairs = of_time.as_ref().iter().zip(M::is_of_time());
    for (side, (of_time, is_of_time)) in all.as_mut().iter_mut().zip(pairs) {
        if *is_of_time {
            *side = *of_time;
        }
    }
    all
}

/// Returns the branches of formulas of the motion just ahead of a position; at the end of the file's analysis those just
/// behind it.
pub fn sides_ahead<M: Solved>(at: &Solution<M>, m: &M) -> M::Sides {
    let (mut q, t) = M::Along::ahead(m, at);
    if !is_end::<M>(at.t) {
        return m.sides_of_motion(&q, t, &at.sides);
    }
    for (q, now) in q.as_mut().iter_mut().zip(at.q.as_ref()) {
        *q = now - (*q - now);
    }
    m.sides_of_motion(&q, at.t - (t - at.t), &at.sides)
}
