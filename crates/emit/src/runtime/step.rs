//! Steps from time to time.

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

/// Evaluations that a call of so many steps takes at most.
pub const fn most_work<M: Timed>(most: usize) -> usize {
    let [of_lead, of_its_step] = M::Continuation::WORK;
    let of_step = of_step::<M>() + M::WORK_OF_BOUNDARIES;
    let of_step = if of_its_step > of_step { of_its_step } else { of_step };
    most.saturating_mul(of_step).saturating_add(of_lead + of_regular::<M>())
}

/// Moves a state to time `t` (s), in so many steps at most, each as short as the motion asks for: position, velocity and acceleration
/// are those of the branch that it is on, whichever way `t` lies. After an error the state is as it was; what so many steps do not
/// reach is one.
pub fn step<M: Timed>(t: f64, state: &mut State<M>, most: usize, work: &mut Work) -> Result<(), Error> {
    let is_beyond = (t - state.at().t).abs() > M::LONGEST_STEP * most as f64;
    if is_beyond && t.is_finite() {
        return Err(Error::TooFar);
    }
    go(t, state, most, true, work).map(|_| ())
}

/// The same, but what so many steps do not reach is on its way.
pub fn step_within<M: Timed>(t: f64, state: &mut State<M>, most: usize, work: &mut Work) -> Result<Progress, Error> {
    go(t, state, most, false, work)
}

fn go<M: Timed>(t: f64, state: &mut State<M>, most: usize, is_whole: bool, work: &mut Work) -> Result<Progress, Error> {
    if !(t - state.at().t).is_finite() {
        return Err(Error::NotANumber);
    }
    if state.is_input_driven() {
        take_up(t, state, most, is_whole, work)
    } else {
        march(t, state, most, is_whole, work)
    }
}

/// Goes on by the time from where inputs have led.
#[cold]
#[inline(never)]
fn take_up<M: Timed>(
    t: f64,
    state: &mut State<M>,
    most: usize,
    is_whole: bool,
    work: &mut Work,
) -> Result<Progress, Error> {
    let (lead, track) = (state.continuation, state.track);
    let result = match M::Continuation::resume_time(state, most, work) {
        Ok(Some(left)) => march(t, state, left, is_whole, work),
        Ok(None) if is_whole => Err(Error::TooFar),
        Ok(None) => Ok(Progress { fraction: 0.0 }),
        Err(error) => Err(error),
    };
    if result.is_err() {
        (state.continuation, state.track) = (lead, track);
    }
    result
}

/// Steps from time to time.
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
        // what is fast may be over before the step's end
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

/// One step to a time; says whether a longer one would do as well.
fn advance<M: Timed>(state: &mut State<M>, t: f64, is_wanted: bool, work: &mut Work) -> Result<bool, Fault> {
    let is_smooth = state.track.is_smooth;
    let (from, at) = state.track.both();
    let m = &state.model;
    let h = t - from.t;
    let (v, a) = (M::tears(&from.qd), M::tears(&from.qdd));
    let mut way = if is_smooth { bend(from, at, h) } else { M::Tears::ZERO };
    for (way, (v, a)) in way.as_mut().iter_mut().zip(v.as_ref().iter().zip(a.as_ref())) {
        // Taylor
        *way += h * (v + 0.5 * h * a);
    }
    let is_calm = tried(&way, from, t, m, at, |at| gap(from, at, h), work)?;
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

/// Solves at a time, or a place of a way, to which the tears are expected to go so far, if that is near enough for a step; says whether
/// a longer step would do as well. A gap is how far a solution is from what the slopes at both ends make of the way between, scaled.
pub fn tried<M: Solved>(
    way: &M::Tears,
    from: &Solution<M>,
    t: f64,
    m: &M,
    at: &mut Solution<M>,
    gap: impl FnOnce(&Solution<M>) -> f64,
    work: &mut Work,
) -> Result<bool, Fault> {
    // what is not a number is not small either
    let is_short = largest(way, M::tear_scales()) <= LARGEST_MOTION;
    if !is_short {
        return Err(Fault::TooFar);
    }
    let mut guess = M::tears(&from.q);
    for (guess, way) in guess.as_mut().iter_mut().zip(way.as_ref()) {
        *guess += *way;
    }
    reach(&guess, from, t, m, at, work)?;
    let gap = gap(at);
    let is_near = at.first <= LARGEST_CORRECTION && gap <= LARGEST_GAP;
    if !is_near {
        return Err(Fault::TooFar);
    }
    Ok(at.first < LARGEST_CORRECTION / CALM_CORRECTION && gap < LARGEST_GAP / CALM_BETWEEN)
}

/// How far positions are from what both ends' velocities and accelerations make of the way between (Hermite), scaled.
fn gap<M: Solved>(from: &Solution<M>, at: &Solution<M>, h: f64) -> f64 {
    let (x, v, a) = (M::tears(&from.q), M::tears(&from.qd), M::tears(&from.qdd));
    let (y, w, b) = (M::tears(&at.q), M::tears(&at.qd), M::tears(&at.qdd));
    let mut gaps = M::Tears::ZERO;
    let ways = y.as_ref().iter().zip(x.as_ref());
    let rates = v.as_ref().iter().zip(w.as_ref());
    let bends = a.as_ref().iter().zip(b.as_ref());
    for ((gap, (y, x)), ((v, w), (a, b))) in gaps.as_mut().iter_mut().zip(ways).zip(rates.zip(bends)) {
        *gap = y - x - 0.5 * h * (v + w) - h * h * (1.0 / 12.0) * (a - b);
    }
    largest(&gaps, M::tear_scales())
}

/// What the motion since the solution before adds to Taylor's way over a time `h` (s).
fn bend<M: Solved>(now: &Solution<M>, before: &Solution<M>, h: f64) -> M::Tears {
    let back = now.t - before.t;
    let u = h / back;
    if u.is_nan() || u.abs() > FARTHEST_BEND {
        return M::Tears::ZERO;
    }
    let (x, v, a) = (M::tears(&now.q), M::tears(&now.qd), M::tears(&now.qdd));
    let (y, w, b) = (M::tears(&before.q), M::tears(&before.qd), M::tears(&before.qdd));
    let mut bend = M::Tears::ZERO;
    let ways = x.as_ref().iter().zip(y.as_ref());
    let rates = v.as_ref().iter().zip(w.as_ref());
    let bends = a.as_ref().iter().zip(b.as_ref());
    for ((bend, (x, y)), ((v, w), (a, b))) in bend.as_mut().iter_mut().zip(ways).zip(rates.zip(bends)) {
        *bend = bend_ahead([*x, *v, *a], [*y, *w, *b], back, u);
    }
    bend
}

/// Whether position or velocity differ on the two sides of a time at which formulas change their branches: `at` is the later side, and
/// `from` has the branches of the earlier one.
fn jumps<M: Timed>(from: &Solution<M>, at: &Solution<M>, m: &M, work: &mut Work) -> bool {
    let mut before = *at;
    if find(&M::tears(&at.q), at, at.t, m, &from.sides, &mut before, work).is_err() {
        return true;
    }
    let (way, change) = (difference(&at.q, &before.q), difference(&at.qd, &before.qd));
    let scales = M::scales();
    let fastest = largest(&at.qd, scales) + largest(&before.qd, scales) + REST / M::SPAN;
    largest(&way, scales) > POSITION_JUMP || largest(&change, scales) > VELOCITY_JUMP * fastest
}
