//! Continuation along inputs.

use super::branches::{first_edge, sides_near};
use super::equations::Branches;
use super::error::{Error, Fault};
use super::explain::{meeting, of_regular, regular, until_turn};
use super::input_path::{InputDriven, InputPath, Signals, sum};
use super::limits::{
    CRUMB, FARTHEST_BEND, JUMP, LARGEST_CORRECTION, LARGEST_TURN, NEAR_TURN, NEAREST_TURN, POSITION_JUMP,
    SHORTEST_STEP, SINGULAR,
};
use super::numbers::{Numbers, add_zeros, difference, larger, largest};
use super::reach::{find, reach, stays_on_branch};
use super::solution::{Solution, Solved};
use super::state::{Continuation, State, Timed};
use super::step::try_step;
use super::track::{Checkpoint, Track};
use super::work::{Progress, Work, of_reaching, of_sides, of_step};

/// Continuation of a mechanism along its inputs.
#[derive(Clone, Copy, Debug)]
pub struct InputContinuation<E: InputDriven<K>, const K: usize> {
    pub(super) model: E,
    /// Present position: times are positions on the path, and steps are changes of a signal.
    pub(super) track: Track<E>,
    /// Largest change of each signal in a call.
    largest_change: [f64; K],
    /// Target of a path that was left before its end, and the step size that works well on it.
    unfinished: ([f64; K], f64),
    /// True if inputs, rather than time, have moved the mechanism to its position.
    is_active: bool,
}

/// A mechanism with its continuation along inputs, which has the same coordinates, measures and parameters.
pub trait Follows<E: InputDriven<K>, const K: usize>:
    Timed<Q = E::Q, Measures = E::Measures, Params = E::Params, Continuation = InputContinuation<E, K>>
{
    /// True if time is the last of the signals.
    const HAS_TIME: bool;
}

impl<E: InputDriven<K>, M: Follows<E, K>, const K: usize> Continuation<M> for InputContinuation<E, K> {
    // beside the path, the solution at the time
    const WORK: [usize; 2] = [most_work::<E, K>(0) + of_beginning::<M>(), of_step::<E>() + 1];

    fn new(params: &M::Params) -> Self {
        Self::with(params)
    }

    fn is_active(&self) -> bool {
        self.is_active
    }

    fn resume_time(state: &mut State<M>, most: usize, work: &mut Work) -> Result<Option<usize>, Error> {
        let t = state.at().t;
        work.add(1);
        let wanted = E::by_formulas(state.params(), t);
        let mut left = most;
        let progress = state.continuation.go(&wanted, &mut left, false, state.steepness, work);
        state.take_input_solution();
        if !progress?.is_reached() {
            return Ok(None);
        }
        let q = state.at().q;
        let mut near = Solution::near(&q, t);
        near.sides = sides_near(&q, t, &state.model, work);
        reach(&M::tears(&q), &near, t, &state.model, state.track.at_mut(), work).map_err(Fault::at_start)?;
        (state.continuation.is_active, state.track.is_smooth) = (false, false);
        Ok(Some(left))
    }
}

/// Largest number of evaluations of a call with at most `most` steps.
pub const fn most_work<E: InputDriven<K>, const K: usize>(most: usize) -> usize {
    // one more for the distance to a dead point where a step is refused
    most.saturating_mul(of_step::<E>() + 1)
        .saturating_add(of_beginning::<E>() + of_regular::<E>() + of_reaching::<E>() + 2)
}

/// Largest number of evaluations at the beginning of a continuation from a time, or at the return to time.
const fn of_beginning<E: Branches>() -> usize {
    1 + of_sides::<E>() + of_reaching::<E>()
}

/// Moves a state from its inputs to others in at most `most` steps, along the straight line between them. After an error
/// the state is unchanged; not arriving within the steps is an error.
pub fn follow<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(
    signals: &Signals<K>,
    state: &mut State<M>,
    most: usize,
    work: &mut Work,
) -> Result<(), Error> {
    continue_to(signals, state, most, true, work).map(|_| ())
}

/// Moves a state as [`follow`] does, but returns the progress if the steps do not suffice.
pub fn follow_within<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(
    signals: &Signals<K>,
    state: &mut State<M>,
    most: usize,
    work: &mut Work,
) -> Result<Progress, Error> {
    continue_to(signals, state, most, false, work)
}

fn continue_to<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(
    signals: &Signals<K>,
    state: &mut State<M>,
    most: usize,
    is_whole: bool,
    work: &mut Work,
) -> Result<Progress, Error> {
    let mut sums = [0.0; 4];
    signals.iter().for_each(|of| add_zeros(of, &mut sums));
    if sums != [0.0; 4] {
        return Err(Error::NotANumber);
    }
    if state.is_input_driven() {
        state.continuation.check_change(&state.continuation.at().along.signals, signals)?;
        let progress = state.continuation.go(signals, &mut { most }, is_whole, state.steepness, work)?;
        state.take_input_solution();
        return Ok(progress);
    }
    begin(signals, state, most, is_whole, work)
}

/// Moves a state whose inputs have not been moved yet.
#[cold]
#[inline(never)]
fn begin<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(
    signals: &Signals<K>,
    state: &mut State<M>,
    most: usize,
    is_whole: bool,
    work: &mut Work,
) -> Result<Progress, Error> {
    let (before, q, t) = (state.continuation, state.at().q, state.at().t);
    let [now, ..] = E::by_formulas(state.params(), t);
    work.add(1);
    state.continuation.check_change(&now, signals)?;
    let continuation = &mut state.continuation;
    let progress = continuation
        .begin(&q, t, work)
        .and_then(|()| continuation.go(signals, &mut { most }, is_whole, state.steepness, work));
    match progress {
        Ok(progress) if progress.fraction > 0.0 => {
            state.continuation.is_active = true;
            state.take_input_solution();
        }
        Ok(_) => state.continuation = InputContinuation { unfinished: state.continuation.unfinished, ..before },
        Err(_) => state.continuation = before,
    }
    progress
}

impl<M: Timed> State<M> {
    /// Copies the solution to which the inputs have moved.
    fn take_input_solution<E: InputDriven<K>, const K: usize>(&mut self)
    where
        M: Follows<E, K>,
    {
        let (at, to) = (self.continuation.at(), self.track.at_mut());
        (to.q, to.qd, to.qdd, to.measures) = (at.q, at.qd, at.qdd, at.measures);
        if let (true, [.., t]) = (M::HAS_TIME, at.along.signals.as_slice()) {
            to.t = *t;
        }
    }
}

/// Returns the largest change of each signal in a call.
pub fn largest_change<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(state: &State<M>) -> &[f64; K] {
    &state.continuation.largest_change
}

/// Returns the largest change of each signal for modification.
pub fn largest_change_mut<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(state: &mut State<M>) -> &mut [f64; K] {
    &mut state.continuation.largest_change
}

/// Returns the signals of a state: those that it was moved to, or those that the formulas give at its time.
pub fn signals<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(state: &State<M>) -> Signals<K> {
    if state.is_input_driven() {
        let path = state.continuation.model.path();
        [state.continuation.at().along.signals, path.rates, path.accelerations]
    } else {
        E::by_formulas(state.params(), state.t())
    }
}

/// Returns the derivatives of the coordinates by each signal: for a constant shift of it, along the branch of the state.
pub fn influence<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(state: &State<M>) -> Result<[M::Q; K], Error> {
    let at = |continuation: &InputContinuation<E, K>| {
        let at = continuation.at();
        let mut by_signal = at.along.by_signal;
        continuation.model.reject_drift(&mut by_signal, at);
        by_signal
    };
    if state.is_input_driven() {
        return Ok(at(&state.continuation));
    }
    let mut continuation = InputContinuation::with(state.params());
    continuation.begin(state.q(), state.t(), &mut Work::default())?;
    Ok(at(&continuation))
}

impl<E: InputDriven<K>, const K: usize> InputContinuation<E, K> {
    fn with(params: &E::Params) -> Self {
        let solutions = [Solution::ZERO, Solution::ZERO];
        Self {
            model: E::new(&InputPath::new(params)),
            track: Track { solutions, is_second: false, is_smooth: false, stride: f64::INFINITY },
            largest_change: E::LARGEST_CHANGE,
            unfinished: ([f64::NAN; K], f64::INFINITY),
            is_active: false,
        }
    }

    /// Returns the present solution.
    pub(super) fn at(&self) -> &Solution<E> {
        self.track.at()
    }

    /// Checks that no signal changes by more than is allowed.
    fn check_change(&self, from: &[f64; K], [to, ..]: &Signals<K>) -> Result<(), Error> {
        let mut changes = from.iter().zip(to).zip(&self.largest_change);
        if changes.all(|((from, to), largest)| (to - from).abs() <= *largest) { Ok(()) } else { Err(Error::TooFar) }
    }

    /// Begins at the position that the text's formulas give at a time (s).
    fn begin(&mut self, q: &E::Q, t: f64, work: &mut Work) -> Result<(), Error> {
        let path = self.model.path_mut();
        let signals = E::by_formulas(&path.params, t);
        path.restart(&signals[0], &signals);
        let mut near = Solution::near(q, 1.0);
        near.sides = sides_near(q, 1.0, &self.model, work);
        self.track.is_smooth = false;
        let now = self.track.at_mut();
        reach(&E::tears(q), &near, 1.0, &self.model, now, work).map_err(Fault::at_start)?;
        if now.first <= LARGEST_CORRECTION { Ok(()) } else { Err(Error::Divergence) }
    }

    /// Moves from the present signals to others in at most `left` steps, and leaves the number of unused steps there. After
    /// an error everything is unchanged.
    fn go(
        &mut self,
        signals: &Signals<K>,
        left: &mut usize,
        is_whole: bool,
        steepness: f64,
        work: &mut Work,
    ) -> Result<Progress, Error> {
        let from = self.at().along.signals;
        let (mut before, path) = (Checkpoint::of(&self.track), *self.model.path());
        self.model.path_mut().restart(&from, signals);
        self.track.at_mut().t = 0.0;
        let ((goal, stride), usual) = (self.unfinished, self.track.stride);
        let continues = goal == signals[0];
        if continues {
            self.track.stride = stride;
        }
        let mut why = self.march(left, &mut before, steepness, work);
        if why.is_none() {
            if continues {
                self.unfinished = ([f64::NAN; K], f64::INFINITY);
            }
            return Ok(Progress::REACHED);
        }
        if why == Some(Error::TooFar) && !is_whole {
            self.unfinished = (signals[0], self.track.stride);
            if self.at().t > 0.0 {
                // the step size of another path may not suit this one
                self.track.stride = usual;
                return Ok(Progress::part(self.at().t, 1.0));
            }
            why = None;
        }
        before.restore(&mut self.track);
        *self.model.path_mut() = path;
        why.map_or(Ok(Progress { fraction: 0.0 }), Err)
    }

    /// Steps along the path to its end. Returns the reason if it stops before.
    #[inline(always)]
    #[allow(clippy::inline_always)] // a call would keep everything in memory
    fn march(
        &mut self,
        left: &mut usize,
        before: &mut Checkpoint<E>,
        steepness: f64,
        work: &mut Work,
    ) -> Option<Error> {
        let length = self.model.path().length();
        // the branch needs steps of the same change on any path
        let smallest = SHORTEST_STEP / larger(length, 1.0);
        let mut refused = None;
        while *left > 0 {
            *left -= 1;
            let now = self.at().t;
            let step = f64::max(self.track.stride / length, smallest);
            // a path without length is one step
            let wanted = if step < CRUMB * (1.0 - now) { now + step } else { 1.0 };
            let next = first_edge(now, wanted, &self.model, work);
            let (is_last, size) = (next >= 1.0, next - now);
            match self.advance(next, is_last, steepness, work) {
                Ok(is_calm) => {
                    let stride = self.track.stride;
                    if is_calm {
                        self.track.stride = f64::max(stride, 2.0 * size * length);
                    } else if length > 0.0 {
                        self.track.stride = f64::min(stride, size * length);
                    }
                    if is_last {
                        return None;
                    }
                    before.keep(&self.track);
                }
                Err(Fault::NotSmooth) => return Some(Error::NotSmooth),
                Err(fault) => {
                    let half = 0.5 * size;
                    self.track.is_smooth = false;
                    if half < smallest || now + half == now {
                        return Some(self.explain(fault, next, steepness, work));
                    }
                    refused = Some((fault, next));
                    let turn = self.turn(fault, steepness, work);
                    if turn < size * length {
                        if turn < NEAREST_TURN && self.at().steepest >= SINGULAR * steepness {
                            return Some(Error::LockUp);
                        }
                        self.track.stride = 0.9 * turn;
                    } else {
                        self.track.stride = half * length;
                    }
                }
            }
        }
        work.add(1);
        let at = self.at();
        if self.model.phi(&at.q, 1.0, &at.sides).as_ref().iter().any(|value| !value.is_finite()) {
            return Some(Error::NotANumber);
        }
        match refused {
            Some((Fault::TooFar, next)) if self.jumps(next, work) => Some(Error::NotSmooth),
            _ => Some(Error::TooFar),
        }
    }

    /// Takes one step to a position of the path. Returns whether a longer step would do as well.
    fn advance(&mut self, t: f64, is_wanted: bool, steepness: f64, work: &mut Work) -> Result<bool, Fault> {
        let is_smooth = self.track.is_smooth;
        let (from, at) = self.track.both();
        let m = &self.model;
        let h = t - from.t;
        let change = m.path().direction().map(|rate| h * rate);
        let v = tears_along(from, &change);
        let mut motion = if is_smooth { bend(from, at, &v, &change) } else { E::Tears::ZERO };
        for (motion, v) in motion.as_mut().iter_mut().zip(v.as_ref()) {
            *motion += v;
        }
        let is_calm = try_step(&motion, from, t, m, at, |at| gap(from, at, &v, &change), work)?;
        if !stays_on_branch(from, at, m, is_wanted, steepness, work) {
            return Err(Fault::Singular);
        }
        if E::OF_TIME && at.sides != from.sides && jumps(from, at, m, work) {
            return Err(Fault::NotSmooth);
        }
        let is_smooth = at.sides == from.sides;
        self.track.is_smooth = is_smooth;
        self.track.is_second = !self.track.is_second;
        Ok(is_calm)
    }

    /// Returns the reason why even the shortest step towards a position of the path is refused.
    fn explain(&self, fault: Fault, t: f64, steepness: f64, work: &mut Work) -> Error {
        let (at, m) = (self.at(), &self.model);
        if let Some(error) = regular(at, fault, t, m, work) {
            return error;
        }
        if at.steepest < SINGULAR * steepness {
            if fault == Fault::LeftOut {
                return Error::Inconsistent;
            }
            let jumps = fault == Fault::TooFar && self.jumps(t, work);
            return if jumps { Error::NotSmooth } else { Error::Divergence };
        }
        meeting::<E>(self.until_turn(work), 1.0 + m.path().length())
    }

    /// Returns whether the position jumps before `t`, without a change of branches: it is found there, but much farther
    /// away than the slopes on this side predict.
    fn jumps(&self, t: f64, work: &mut Work) -> bool {
        let (at, m) = (self.at(), &self.model);
        let mut beyond = *at;
        if reach(&E::tears(&at.q), at, t, m, &mut beyond, work).is_err() {
            return false;
        }
        let change = m.path().direction().map(|rate| (t - at.t) * rate);
        let predicted = largest(&at.along.along(&change), E::scales());
        largest(&difference(&beyond.q, &at.q), E::scales()) > larger(POSITION_JUMP, JUMP * predicted)
    }

    /// Returns the change of a signal until a dead point, if a step was refused close enough to a singular position to
    /// estimate it; infinity otherwise.
    fn turn(&self, fault: Fault, steepness: f64, work: &mut Work) -> f64 {
        let is_near = self.at().steepest >= NEAR_TURN * steepness && matches!(fault, Fault::TooFar | Fault::Singular);
        let left = if is_near { self.until_turn(work) } else { f64::INFINITY };
        if left > 0.0 { left } else { f64::INFINITY }
    }

    /// Returns the change of the fastest-changing signal until a dead point, while all others change with it.
    fn until_turn(&self, work: &mut Work) -> f64 {
        let (at, m) = (self.at(), &self.model);
        let longest = m.path().length();
        let mut along = *m;
        along.path_mut().rates = m.path().direction().map(|change| change / longest);
        along.path_mut().accelerations = [0.0; K];
        let mut moving = *at;
        work.add(1);
        along.solve(&E::tears(&at.q), at.t, &at.sides, &mut moving);
        until_turn(&moving)
    }
}

/// Returns the change of the Newton coordinates along a direction of the signals.
fn tears_along<E: InputDriven<K>, const K: usize>(at: &Solution<E>, direction: &[f64; K]) -> E::Tears {
    sum(at.along.by_signal.each_ref().map(E::tears), direction)
}

/// Returns the distance of positions from those that the slopes at both ends predict, scaled.
fn gap<E: InputDriven<K>, const K: usize>(
    from: &Solution<E>,
    at: &Solution<E>,
    v: &E::Tears,
    change: &[f64; K],
) -> f64 {
    let (x, y, w) = (E::tears(&from.q), E::tears(&at.q), tears_along(at, change));
    let mut gaps = E::Tears::ZERO;
    let positions = y.as_ref().iter().zip(x.as_ref());
    let rates = v.as_ref().iter().zip(w.as_ref());
    for ((gap, (y, x)), (v, w)) in gaps.as_mut().iter_mut().zip(positions).zip(rates) {
        *gap = y - x - 0.5 * (v + w);
    }
    largest(&gaps, E::tear_scales())
}

/// Returns the correction, by the previous solution, of the change `v` that the present slopes predict for a change of the
/// signals: values and slopes at two positions define a cubic (Hermite). If the signals change direction, only the change
/// of the slopes counts.
fn bend<E: InputDriven<K>, const K: usize>(
    now: &Solution<E>,
    before: &Solution<E>,
    v: &E::Tears,
    change: &[f64; K],
) -> E::Tears {
    let (mut product, mut square, mut size) = (0.0, 0.0, 0.0);
    let behind = difference(&now.along.signals, &before.along.signals);
    for (behind, change) in behind.iter().zip(change) {
        product += behind * change;
        square += behind * behind;
        size += change * change;
    }
    let u = product / square;
    if u.is_nan() || u.abs() > FARTHEST_BEND {
        return E::Tears::ZERO;
    }
    let (x, y) = (E::tears(&now.q), E::tears(&before.q));
    let is_straight = size - u * product <= LARGEST_TURN * size;
    let mut bend = E::Tears::ZERO;
    if is_straight {
        let (v, w) = (tears_along(now, &behind), tears_along(before, &behind));
        let positions = x.as_ref().iter().zip(y.as_ref());
        let slopes = v.as_ref().iter().zip(w.as_ref());
        for ((bend, (x, y)), (v, w)) in bend.as_mut().iter_mut().zip(positions).zip(slopes) {
            let (value, slope) = (y - x + v, v - w);
            *bend = u * u * (3.0 * value - slope + u * (2.0 * value - slope));
        }
    } else {
        let w = tears_along(before, change);
        let slopes = v.as_ref().iter().zip(w.as_ref());
        for (bend, (v, w)) in bend.as_mut().iter_mut().zip(slopes) {
            *bend = 0.5 * u * (v - w);
        }
    }
    bend
}

/// Returns whether a position differs on the two sides of a point at which formulas change their branches: `at` is the
/// later side, and `from` has the branches of the earlier one.
fn jumps<M: Solved>(from: &Solution<M>, at: &Solution<M>, m: &M, work: &mut Work) -> bool {
    let mut before = *at;
    if find(&M::tears(&at.q), at, at.t, m, &from.sides, &mut before, work).is_err() {
        return true;
    }
    largest(&difference(&at.q, &before.q), M::scales()) > POSITION_JUMP
}
