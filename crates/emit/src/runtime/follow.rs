//! What follows inputs.

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
use super::step::tried;
use super::track::{Checkpoint, Track};
use super::work::{Progress, Work, of_reaching, of_sides, of_step};

/// What leads a mechanism by its inputs.
#[derive(Clone, Copy, Debug)]
pub struct InputContinuation<E: InputDriven<K>, const K: usize> {
    pub(super) model: E,
    /// Where it is; times are places of the way, and steps are changes of a signal.
    pub(super) track: Track<E>,
    /// The largest change of each signal that a call takes.
    largest_change: [f64; K],
    /// Where a way leads that was left before its end, and the change that goes well on it.
    unfinished: ([f64; K], f64),
    /// Whether inputs have led to where the mechanism is, rather than the time.
    is_active: bool,
}

/// A mechanism with what leads it: they have the same coordinates, measures and parameters.
pub trait Follows<E: InputDriven<K>, const K: usize>:
    Timed<Q = E::Q, Measures = E::Measures, Params = E::Params, Continuation = InputContinuation<E, K>>
{
    /// Whether time is the last of the signals.
    const HAS_TIME: bool;
}

impl<E: InputDriven<K>, M: Follows<E, K>, const K: usize> Continuation<M> for InputContinuation<E, K> {
    // beside the way, the solution of the time
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
        let come = state.continuation.go(&wanted, &mut left, false, state.steepness, work);
        state.take_over();
        if !come?.is_reached() {
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

/// Evaluations that a call of so many steps takes at most.
pub const fn most_work<E: InputDriven<K>, const K: usize>(most: usize) -> usize {
    // that of the turn where a step is refused
    most.saturating_mul(of_step::<E>() + 1)
        .saturating_add(of_beginning::<E>() + of_regular::<E>() + of_reaching::<E>() + 2)
}

/// Evaluations that it takes to begin where the time has led, or to go on from there.
const fn of_beginning<E: Branches>() -> usize {
    1 + of_sides::<E>() + of_reaching::<E>()
}

/// Leads a state from its inputs to others in so many steps at most, along the straight line between them. After an error the state is
/// as it was; what so many steps do not reach is one.
pub fn follow<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(
    signals: &Signals<K>,
    state: &mut State<M>,
    most: usize,
    work: &mut Work,
) -> Result<(), Error> {
    lead(signals, state, most, true, work).map(|_| ())
}

/// The same, but what so many steps do not reach is on its way.
pub fn follow_within<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(
    signals: &Signals<K>,
    state: &mut State<M>,
    most: usize,
    work: &mut Work,
) -> Result<Progress, Error> {
    lead(signals, state, most, false, work)
}

fn lead<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(
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
        state.continuation.takes(&state.continuation.at().along.signals, signals)?;
        let come = state.continuation.go(signals, &mut { most }, is_whole, state.steepness, work)?;
        state.take_over();
        return Ok(come);
    }
    begin(signals, state, most, is_whole, work)
}

/// Leads a state that inputs have not led yet.
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
    state.continuation.takes(&now, signals)?;
    let lead = &mut state.continuation;
    let come = lead.begin(&q, t, work).and_then(|()| lead.go(signals, &mut { most }, is_whole, state.steepness, work));
    match come {
        Ok(come) if come.fraction > 0.0 => {
            state.continuation.is_active = true;
            state.take_over();
        }
        Ok(_) => state.continuation = InputContinuation { unfinished: state.continuation.unfinished, ..before },
        Err(_) => state.continuation = before,
    }
    come
}

impl<M: Timed> State<M> {
    /// Takes over where its inputs have led.
    fn take_over<E: InputDriven<K>, const K: usize>(&mut self)
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

/// By signal: the largest change that a call takes.
pub fn largest_change<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(state: &State<M>) -> &[f64; K] {
    &state.continuation.largest_change
}

/// The same, to be written.
pub fn largest_change_mut<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(state: &mut State<M>) -> &mut [f64; K] {
    &mut state.continuation.largest_change
}

/// The signals at a state: what they were followed to, or what their formulas say at its time.
pub fn signals<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(state: &State<M>) -> Signals<K> {
    if state.is_input_driven() {
        let way = state.continuation.model.path();
        [state.continuation.at().along.signals, way.rates, way.accelerations]
    } else {
        E::by_formulas(state.params(), state.t())
    }
}

/// The derivatives of the coordinates by each signal: for a constant shift of it, along the branch that the state is on.
pub fn influence<E: InputDriven<K>, M: Follows<E, K>, const K: usize>(state: &State<M>) -> Result<[M::Q; K], Error> {
    let at = |continuation: &InputContinuation<E, K>| {
        let at = lead.at();
        let mut by_signal = at.along.by_signal;
        lead.model.reject_drift(&mut by_signal, at);
        by_signal
    };
    if state.is_input_driven() {
        return Ok(at(&state.continuation));
    }
    let mut lead = InputContinuation::with(state.params());
    lead.begin(state.q(), state.t(), &mut Work::default())?;
    Ok(at(&lead))
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

    /// The solution of now.
    pub(super) fn at(&self) -> &Solution<E> {
        self.track.at()
    }

    /// Whether no signal changes by more than is taken.
    fn takes(&self, from: &[f64; K], [to, ..]: &Signals<K>) -> Result<(), Error> {
        let mut changes = from.iter().zip(to).zip(&self.largest_change);
        if changes.all(|((from, to), largest)| (to - from).abs() <= *largest) { Ok(()) } else { Err(Error::TooFar) }
    }

    /// Begins at a position that the text's formulas give at a time (s).
    fn begin(&mut self, q: &E::Q, t: f64, work: &mut Work) -> Result<(), Error> {
        let way = self.model.path_mut();
        let signals = E::by_formulas(&way.params, t);
        way.turn(&signals[0], &signals);
        let mut near = Solution::near(q, 1.0);
        near.sides = sides_near(q, 1.0, &self.model, work);
        self.track.is_smooth = false;
        let now = self.track.at_mut();
        reach(&E::tears(q), &near, 1.0, &self.model, now, work).map_err(Fault::at_start)?;
        if now.first <= LARGEST_CORRECTION { Ok(()) } else { Err(Error::Divergence) }
    }

    /// Goes from the signals of now to others in so many steps at most, of which it leaves what it does not take. After an error, all
    /// is as it was.
    fn go(
        &mut self,
        signals: &Signals<K>,
        left: &mut usize,
        is_whole: bool,
        steepness: f64,
        work: &mut Work,
    ) -> Result<Progress, Error> {
        let from = self.at().along.signals;
        let (mut before, way) = (Checkpoint::of(&self.track), *self.model.path());
        self.model.path_mut().turn(&from, signals);
        self.track.at_mut().t = 0.0;
        let ((goal, stride), usual) = (self.unfinished, self.track.stride);
        let goes_on = goal == signals[0];
        if goes_on {
            self.track.stride = stride;
        }
        let mut why = self.march(left, &mut before, steepness, work);
        if why.is_none() {
            if goes_on {
                self.unfinished = ([f64::NAN; K], f64::INFINITY);
            }
            return Ok(Progress::REACHED);
        }
        if why == Some(Error::TooFar) && !is_whole {
            self.unfinished = (signals[0], self.track.stride);
            if self.at().t > 0.0 {
                // what goes well elsewhere is not what goes well here
                self.track.stride = usual;
                return Ok(Progress::part(self.at().t, 1.0));
            }
            why = None;
        }
        before.restore(&mut self.track);
        *self.model.path_mut() = way;
        why.map_or(Ok(Progress { fraction: 0.0 }), Err)
    }

    /// Steps from place to place to the end of the way; why it ends before, if it does.
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
        // the branch asks for steps of the same change on any way
        let smallest = SHORTEST_STEP / larger(length, 1.0);
        let mut refused = None;
        while *left > 0 {
            *left -= 1;
            let now = self.at().t;
            let step = f64::max(self.track.stride / length, smallest);
            // a way without length is one step
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

    /// One step to a place of the way; says whether a longer one would do as well.
    fn advance(&mut self, t: f64, is_wanted: bool, steepness: f64, work: &mut Work) -> Result<bool, Fault> {
        let is_smooth = self.track.is_smooth;
        let (from, at) = self.track.both();
        let m = &self.model;
        let h = t - from.t;
        let change = m.path().direction().map(|rate| h * rate);
        let v = tears_along(from, &change);
        let mut way = if is_smooth { bend(from, at, &v, &change) } else { E::Tears::ZERO };
        for (way, v) in way.as_mut().iter_mut().zip(v.as_ref()) {
            *way += v;
        }
        let is_calm = tried(&way, from, t, m, at, |at| gap(from, at, &v, &change), work)?;
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

    /// Why even the shortest step towards a place of the way is refused.
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

    /// Whether the position jumps on the way to a place, without a branch of a formula: it is found there, but much farther away than the
    /// slopes on this side lead.
    fn jumps(&self, t: f64, work: &mut Work) -> bool {
        let (at, m) = (self.at(), &self.model);
        let mut beyond = *at;
        if reach(&E::tears(&at.q), at, t, m, &mut beyond, work).is_err() {
            return false;
        }
        let change = m.path().direction().map(|rate| (t - at.t) * rate);
        let led = largest(&at.along.along(&change), E::scales());
        largest(&difference(&beyond.q, &at.q), E::scales()) > larger(POSITION_JUMP, JUMP * led)
    }

    /// The change of a signal that is left to a dead point, where a step was refused so near to a singular position that this can be
    /// told; infinite otherwise.
    fn turn(&self, fault: Fault, steepness: f64, work: &mut Work) -> f64 {
        let is_near = self.at().steepest >= NEAR_TURN * steepness && matches!(fault, Fault::TooFar | Fault::Singular);
        let left = if is_near { self.until_turn(work) } else { f64::INFINITY };
        if left > 0.0 { left } else { f64::INFINITY }
    }

    /// The change of the signal that changes most, all others with it, to a dead point.
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

/// How those coordinates change that Newton solves for, along a direction of the signals.
fn tears_along<E: InputDriven<K>, const K: usize>(at: &Solution<E>, direction: &[f64; K]) -> E::Tears {
    sum(at.along.by_signal.each_ref().map(E::tears), direction)
}

/// How far positions are from what the slopes at both ends make of the way between, scaled.
fn gap<E: InputDriven<K>, const K: usize>(
    from: &Solution<E>,
    at: &Solution<E>,
    v: &E::Tears,
    change: &[f64; K],
) -> f64 {
    let (x, y, w) = (E::tears(&from.q), E::tears(&at.q), tears_along(at, change));
    let mut gaps = E::Tears::ZERO;
    let ways = y.as_ref().iter().zip(x.as_ref());
    let rates = v.as_ref().iter().zip(w.as_ref());
    for ((gap, (y, x)), (v, w)) in gaps.as_mut().iter_mut().zip(ways).zip(rates) {
        *gap = y - x - 0.5 * (v + w);
    }
    largest(&gaps, E::tear_scales())
}

/// What the motion since the solution before adds to the way `v` that the slopes of now make of a change of the signals: values and
/// slopes at two places make a cubic (Hermite). Where the signals turn elsewhere, the change of the slopes counts alone.
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
        let ways = x.as_ref().iter().zip(y.as_ref());
        let slopes = v.as_ref().iter().zip(w.as_ref());
        for ((bend, (x, y)), (v, w)) in bend.as_mut().iter_mut().zip(ways).zip(slopes) {
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

/// Whether a position differs on the two sides of a place at which formulas change their branches: `at` is the later side, and `from`
/// has the branches of the earlier one.
fn jumps<M: Solved>(from: &Solution<M>, at: &Solution<M>, m: &M, work: &mut Work) -> bool {
    let mut before = *at;
    if find(&M::tears(&at.q), at, at.t, m, &from.sides, &mut before, work).is_err() {
        return true;
    }
    largest(&difference(&at.q, &before.q), M::scales()) > POSITION_JUMP
}
