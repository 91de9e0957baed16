//! The reason why a motion cannot go on.

use super::branches::sides_at;
use super::equations::{Branches, Checks};
use super::error::{Error, Fault};
use super::limits::{NEAR_FOLD, SINGULAR};
use super::solution::{Solution, Solved};
use super::state::{State, Timed};
use super::work::{Work, of_sides};

/// Returns the reason why even the shortest step from a state towards a time is refused.
pub fn explain<M: Timed>(state: &State<M>, fault: Fault, t: f64, work: &mut Work) -> Error {
    let at = state.at();
    if let Some(error) = regular(at, fault, t, &state.model, work) {
        return error;
    }
    if at.steepest < SINGULAR * state.steepness {
        return if fault == Fault::LeftOut { Error::Inconsistent } else { Error::Divergence };
    }
    let left = until_turn(at);
    meeting::<M>(if t < at.t { -left } else { left }, M::SPAN)
}

/// Largest number of evaluations that [`regular`] takes.
pub const fn of_regular<M: Branches>() -> usize {
    1 + 2 * of_sides::<M>()
}

/// Returns the reason, if it does not depend on how near the position is to a singular one.
pub fn regular<M: Solved>(at: &Solution<M>, fault: Fault, t: f64, m: &M, work: &mut Work) -> Option<Error> {
    work.add(1);
    let values = m.phi(&at.q, t, &at.sides);
    if fault == Fault::NotANumber || values.as_ref().iter().any(|value| !value.is_finite()) {
        return Some(Error::NotANumber);
    }
    // a position that jumps far is not found on the other side
    let mut is_at_edge = || sides_at(at.t, m, work) != sides_at(t, m, work);
    let jumps = fault == Fault::NotSmooth || (fault == Fault::TooFar && is_at_edge());
    jumps.then_some(Error::NotSmooth)
}

/// Returns the time until a dead point, from the fastest coordinate: a time u before a dead point a motion behaves like the
/// root of u, whose slope over twice its curvature is u.
pub fn until_turn<M: Solved>(at: &Solution<M>) -> f64 {
    let rates = at.qd.as_ref().iter().zip(at.qdd.as_ref()).zip(M::scales().as_ref());
    let sooner = |(speed, left): (f64, f64), ((v, a), scale): ((&f64, &f64), &f64)| {
        if v.abs() / scale > speed { (v.abs() / scale, 0.5 * v / a) } else { (speed, left) }
    };
    rates.fold((0.0, 0.0), sooner).1
}

/// Returns what the motion meets at a singular position: a dead point if it is at most a small part of the span ahead.
/// Otherwise redundant equations may decide how the motion continues.
pub fn meeting<M: Checks>(left: f64, span: f64) -> Error {
    if left > 0.0 && left < NEAR_FOLD * span {
        Error::LockUp
    } else if M::HAS_REDUNDANT_ROWS {
        Error::Inconsistent
    } else {
        Error::Bifurcation
    }
}
