//! Steps along time.

use super::branches::first_edge;
use super::error::{Error, Fault};
use super::explain::{explain, of_regular};
use super::hermite::bend_ahead;
use super::limits::{
    CALM_BETWEEN, CALM_CORRECTION, CRUMB, FARTHEST_BEND, LARGEST_CORRECTION, LARGEST_GAP, LARGEST_MOTION, LEAD,
    POSITION_JUMP, REST, VELOCITY_JUMP,
};
use super::numbers::{Numbers, difference, largest};
use super::reach::{find, reach, stays_on_branch};
use super::solution::{Solution, Solved};
use super::state::{Continuation, State, Timed};
use super::track::Checkpoint;
use super::work::{Progress, Work, of_step};

/// Largest number of evaluations of a call with at most `most` steps.
pub const fn most_work<M: Timed>(most: usize) -> usize {
    let [of_return, of_return_step] = M::Continuation::WORK;
    let of_step = of_step::<M>() + M::WORK_OF_BOUNDARIES;
    let of_step = if of_return_step > of_step { of_return_step } else { of_step };
    most.saturating_mul(of_step).saturating_add(of_return + of_regular::<M>())
}

/// Moves a state to time `t` (s) in at most `most` steps, whose length is controlled by the motion. Position, velocity and
/// acceleration are those of the branch of the state, whichever direction `t` lies in. After an error the state is
/// unchanged; not arriving within the steps is an error.
pub fn step<M: Timed>(t: f64, state: &mut State<M>, most: usize, work: &mut Work) -> Result<(), Error> {
    let is_beyond = (t - state.at().t).abs() > M::LONGEST_STEP * most as f64;
    if is_beyond && t.is_finite() {
        return Err(Error::TooFar);
    }
    go(t, state, most, true, work).map(|_| ())
}

/// Moves a state towards time `t` (s) as [`step`] does, but returns the progress if the steps do not suffice.
pub fn step_within<M: Timed>(t: f64, state: &mut State<M>, most: usize, work: &mut Work) -> Result<Progress, Error> {
    go(t, state, most, false, work)
}

fn go<M: Timed>(t: f64, state: &mut State<M>, most: usize, is_whole: bool, work: &mut Work) -> Result<Progress, Error> {
    if !(t - state.at().t).is_finite() {
        return Err(Error::NotANumber);
    }
    if state.is_input_driven() { resume(t, state, most, is_whole, work) } else { march(t, state, most, is_whole, work) }
}

/// Returns to the inputs that the formulas give, then moves along time.
#[cold]
#[inline(never)]
fn resume<M: Timed>(
    t: f64,
    state: &mut State<M>,
    most: usize,
    is_whole: bool,
    work: &mut Work,
) -> Result<Progress, Error> {
    let (continuation, track) = (state.continuation, state.track);
    let result = match M::Continuation::resume_time(state, most, work) {
        Ok(Some(left)) => march(t, state, left, is_whole, work),
        Ok(None) if is_whole => Err(Error::TooFar),
        Ok(None) => Ok(Progress { fraction: 0.0 }),
        Err(error) => Err(error),
    };
    if result.is_err() {
        (state.continuation, state.track) = (continuation, track);
    }
    result
}

/// Steps along time.
fn march<M: Timed>(
    t: f64,
    state: &mut State<M>,
    most: usize,
    is_whole: bool,
    work: &mut Work,
) -> Result<Progress, Error> {
    let (mut before, passed, from) = (Checkpoint::of(&state.track), state.passed, state.at().t);
    let mut why = Error::TooFar;
    for _ in 0..most {
        let now = state.at().t;
        let left = t - now;
        if left == 0.0 {
            return Ok(Progress::REACHED);
        }
        let stride = state.track.stride;
        let wanted = if stride >= CRUMB * left.abs() { t } else { now + stride.copysign(left) };
        // a branch that holds only briefly may be over before the end of the step
        let edge = first_edge(now, wanted, &state.model, work);
        let next = match state.model.first_boundary(now, edge, &state.passed, work) {
            None => edge,
            Some((boundary, at)) => {
                let before = at - (LEAD * M::SPAN).copysign(left);
                if (before - now) * left <= 0.0 {
                    if let Err(error) = M::check_boundary(state, boundary, at, work) {
                        why = error;
                        break;
                    }
                    continue;
                }
                before
            }
        };
        let (is_last, size) = (next == t, (next - now).abs());
        match advance(state, next, is_last, work) {
            Ok(is_calm) => {
                let longest = if is_calm { stride.max(2.0 * size) } else { stride.min(size) };
                state.track.stride = longest.min(M::LONGEST_STEP);
                if is_last {
                    return Ok(Progress::REACHED);
                }
                before.keep(&state.track);
            }
            Err(fault) => {
                let half = 0.5 * size;
                (state.track.stride, state.track.is_smooth) = (half, false);
                if half < M::SMALLEST_STEP || now + half == now {
                    why = explain(state, fault, next, work);
                    break;
                }
            }
        }
    }
    let now = state.at().t;
    if now == t {
        return Ok(Progress::REACHED);
    }
    if why == Error::TooFar && !is_whole {
        return Ok(Progress::part(now - from, t - from));
    }
    before.restore(&mut state.track);
    state.passed = passed;
    Err(why)
}

/// Takes one step to a time. Returns whether a longer step would do as well.
fn advance<M: Timed>(state: &mut State<M>, t: f64, is_wanted: bool, work: &mut Work) -> Result<bool, Fault> {
    let is_smooth = state.track.is_smooth;
    let (from, at) = state.track.both();
    let m = &state.model;
    let h = t - from.t;
    let (v, a) = (M::tears(&from.qd), M::tears(&from.qdd));
    let mut motion = if is_smooth { bend(from, at, h) } else { M::Tears::ZERO };
    for (motion, (v, a)) in motion.as_mut().iter_mut().zip(v.as_ref().iter().zip(a.as_ref())) {
        // Taylor
        *motion += h * (v + 0.5 * h * a);
    }
    let is_calm = try_step(&motion, from, t, m, at, |at| gap(from, at, h), work)?;
    if !stays_on_branch(from, at, m, is_wanted, state.steepness, work) {
        return Err(Fault::Singular);
    }
    if M::OF_TIME && at.sides != from.sides && jumps(from, at, m, work) {
        return Err(Fault::NotSmooth);
    }
    let is_smooth = at.sides == from.sides;
    state.track.is_smooth = is_smooth;
    state.track.is_second = !state.track.is_second;
    Ok(is_calm)
}

/// Solves at a time, or at a position of a path, if the expected motion of the Newton coordinates and the gap are small
/// enough for a step. Returns whether a longer step would do as well. The gap is the distance of a solution from the
/// position that the slopes at both ends predict, scaled.
pub fn try_step<M: Solved>(
    motion: &M::Tears,
    from: &Solution<M>,
    t: f64,
    m: &M,
    at: &mut Solution<M>,
    gap: impl FnOnce(&Solution<M>) -> f64,
    work: &mut Work,
) -> Result<bool, Fault> {
    // NaN is not small either
    let is_short = largest(motion, M::tear_scales()) <= LARGEST_MOTION;
    if !is_short {
        return Err(Fault::TooFar);
    }
    let mut guess = M::tears(&from.q);
    for (guess, motion) in guess.as_mut().iter_mut().zip(motion.as_ref()) {
        *guess += *motion;
    }
    reach(&guess, from, t, m, at, work)?;
    let gap = gap(at);
    let is_near = at.first <= LARGEST_CORRECTION && gap <= LARGEST_GAP;
    if !is_near {
        return Err(Fault::TooFar);
    }
    Ok(at.first < LARGEST_CORRECTION / CALM_CORRECTION && gap < LARGEST_GAP / CALM_BETWEEN)
}

/// Returns the distance of positions from those that velocities and accelerations at both ends predict (Hermite), scaled.
fn gap<M: Solved>(from: &Solution<M>, at: &Solution<M>, h: f64) -> f64 {
    let (x, v, a) = (M::tears(&from.q), M::tears(&from.qd), M::tears(&from.qdd));
    let (y, w, b) = (M::tears(&at.q), M::tears(&at.qd), M::tears(&at.qdd));
    let mut gaps = M::Tears::ZERO;
    let positions = y.as_ref().iter().zip(x.as_ref());
    let rates = v.as_ref().iter().zip(w.as_ref());
    let bends = a.as_ref().iter().zip(b.as_ref());
    for ((gap, (y, x)), ((v, w), (a, b))) in gaps.as_mut().iter_mut().zip(positions).zip(rates.zip(bends)) {
        *gap = y - x - 0.5 * h * (v + w) - h * h * (1.0 / 12.0) * (a - b);
    }
    largest(&gaps, M::tear_scales())
}

/// Returns the correction of Taylor's prediction over a time `h` (s) by the previous solution.
fn bend<M: Solved>(now: &Solution<M>, before: &Solution<M>, h: f64) -> M::Tears {
    let back = now.t - before.t;
    let u = h / back;
    if u.is_nan() || u.abs() > FARTHEST_BEND {
        return M::Tears::ZERO;
    }
    let (x, v, a) = (M::tears(&now.q), M::tears(&now.qd), M::tears(&now.qdd));
    let (y, w, b) = (M::tears(&before.q), M::tears(&before.qd), M::tears(&before.qdd));
    let mut bend = M::Tears::ZERO;
    let positions = x.as_ref().iter().zip(y.as_ref());
    let rates = v.as_ref().iter().zip(w.as_ref());
    let bends = a.as_ref().iter().zip(b.as_ref());
    for ((bend, (x, y)), ((v, w), (a, b))) in bend.as_mut().iter_mut().zip(positions).zip(rates.zip(bends)) {
        *bend = bend_ahead([*x, *v, *a], [*y, *w, *b], back, u);
    }
    bend
}

/// Returns whether position or velocity differ on the two sides of a time at which formulas change their branches: `at` is
/// the later side, and `from` has the branches of the earlier one.
fn jumps<M: Timed>(from: &Solution<M>, at: &Solution<M>, m: &M, work: &mut Work) -> bool {
    let mut before = *at;
    if find(&M::tears(&at.q), at, at.t, m, &from.sides, &mut before, work).is_err() {
        return true;
    }
    let (motion, change) = (difference(&at.q, &before.q), difference(&at.qd, &before.qd));
    let scales = M::scales();
    let fastest = largest(&at.qd, scales) + largest(&before.qd, scales) + REST / M::SPAN;
    largest(&motion, scales) > POSITION_JUMP || largest(&change, scales) > VELOCITY_JUMP * fastest
}
