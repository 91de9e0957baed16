//! What follows inputs.

use super::branches::{first_edge, sides_near};
use super::error::{Error, Fault};
use super::explain::{meeting, regular, until_turn};
use super::limits::{CRUMB, FARTHEST_BEND, LARGEST_CORRECTION, LARGEST_TURN, POSITION_JUMP, SHORTEST_STEP, SINGULAR};
use super::numbers::{Numbers, difference, larger, largest};
use super::reach::{find, reach, stays_on_branch};
use super::solution::{Solution, Solved};
use super::state::{Lead, State, Timed};
use super::step::tried;
use super::way::{Led, Signals, Way, sum};

/// What leads a mechanism by its inputs.
#[derive(Clone, Debug)]
pub struct Leading<E: Led<K>, const K: usize> {
    pub(super) model: E,
    /// The solution of now and the one before, or the next one in the making; their times are places of the way.
    solutions: [Solution<E>; 2],
    /// Whether that of now is the second.
    is_second: bool,
    /// Whether the one before lies on the same smooth motion.
    is_smooth: bool,
    /// The change of a signal that goes well in a step.
    stride: f64,
    /// Whether inputs have led to where the mechanism is, rather than the time.
    is_leading: bool,
}

/// A mechanism with what leads it: they have the same coordinates, measures and parameters.
pub trait Follows<E: Led<K>, const K: usize>:
    Timed<Q = E::Q, Measures = E::Measures, Params = E::Params, Lead = Leading<E, K>>
{
    /// Whether time is the last of the signals.
    const HAS_TIME: bool;
}

impl<E: Led<K>, M: Follows<E, K>, const K: usize> Lead<M> for Leading<E, K> {
    fn new(params: &M::Params) -> Self {
        Self::with(params)
    }

    fn is_leading(&self) -> bool {
        self.is_leading
    }

    fn take_up_time(state: &mut State<M>, most: usize) -> Result<(), Error> {
        let t = state.at().t;
        follow_within(&E::by_text(state.params(), t), state, most)?;
        let q = state.at().q;
        let mut near = Solution::near(&q, t);
        near.sides = sides_near(&q, t, &state.model);
        let [first, second] = &mut state.solutions;
        let at = if state.is_second { second } else { first };
        reach(&M::tears(&q), &near, t, &state.model, at).map_err(Fault::at_start)?;
        (state.lead.is_leading, state.is_smooth) = (false, false);
        Ok(())
    }
}

/// Leads a state from its inputs to others in so many steps at most, along the straight line between them.
pub fn follow_within<E: Led<K>, M: Follows<E, K>, const K: usize>(
    signals: &Signals<K>,
    state: &mut State<M>,
    most: usize,
) -> Result<(), Error> {
    if !signals.iter().flatten().all(|value| value.is_finite()) {
        return Err(Error::NotANumber);
    }
    if !state.is_led() {
        let at = state.at();
        let (q, t) = (at.q, at.t);
        state.lead.begin(&q, t)?;
    }
    let result = state.lead.go(signals, most, state.steepness);
    if matches!(result, Ok(()) | Err(Error::TooFar)) {
        state.lead.is_leading = true;
        let State { lead, solutions: [first, second], is_second, .. } = state;
        let (at, to) = (lead.at(), if *is_second { second } else { first });
        (to.q, to.qd, to.qdd, to.measures) = (at.q, at.qd, at.qdd, at.measures);
        if let (true, [.., t]) = (M::HAS_TIME, at.along.signals.as_slice()) {
            to.t = *t;
        }
    }
    result
}

/// The signals at a state: what they were followed to, or what their formulas say at its time.
pub fn signals<E: Led<K>, M: Follows<E, K>, const K: usize>(state: &State<M>) -> Signals<K> {
    if state.is_led() {
        let way = state.lead.model.way();
        [state.lead.at().along.signals, way.rates, way.accelerations]
    } else {
        E::by_text(state.params(), state.t())
    }
}

/// The derivatives of the coordinates by each signal: for a constant shift of it, along the branch that the state is on.
pub fn influence<E: Led<K>, M: Follows<E, K>, const K: usize>(state: &State<M>) -> Result<[M::Q; K], Error> {
    let at = |lead: &Leading<E, K>| {
        let at = lead.at();
        let mut by_signal = at.along.by_signal;
        lead.model.hold_apart(&mut by_signal, at);
        by_signal
    };
    if state.is_led() {
        return Ok(at(&state.lead));
    }
    let mut lead = Leading::with(state.params());
    lead.begin(state.q(), state.t())?;
    Ok(at(&lead))
}

impl<E: Led<K>, const K: usize> Leading<E, K> {
    fn with(params: &E::Params) -> Self {
        Self {
            model: E::new(&Way::new(params)),
            solutions: [Solution::ZERO, Solution::ZERO],
            is_second: false,
            is_smooth: false,
            stride: f64::INFINITY,
            is_leading: false,
        }
    }

    /// The solution of now.
    pub(super) fn at(&self) -> &Solution<E> {
        let [first, second] = &self.solutions;
        if self.is_second { second } else { first }
    }

    /// The same, to be written; with the mechanism.
    fn at_mut(&mut self) -> (&E, &mut Solution<E>) {
        let [first, second] = &mut self.solutions;
        (&self.model, if self.is_second { second } else { first })
    }

    /// The one before, or the next one in the making.
    fn other(&self) -> &Solution<E> {
        let [first, second] = &self.solutions;
        if self.is_second { first } else { second }
    }

    /// Begins at a position that the text's formulas give at a time (s).
    fn begin(&mut self, q: &E::Q, t: f64) -> Result<(), Error> {
        let way = self.model.way_mut();
        let signals = E::by_text(&way.params, t);
        way.turn(&signals[0], &signals);
        let mut near = Solution::near(q, 1.0);
        near.sides = sides_near(q, 1.0, &self.model);
        self.is_smooth = false;
        let (model, now) = self.at_mut();
        reach(&E::tears(q), &near, 1.0, model, now).map_err(Fault::at_start)?;
        if now.first <= LARGEST_CORRECTION { Ok(()) } else { Err(Error::Divergence) }
    }

    /// Goes from the signals of now to others.
    fn go(&mut self, signals: &Signals<K>, most: usize, steepness: f64) -> Result<(), Error> {
        let from = self.at().along.signals;
        let before = self.model.way().clone();
        self.model.way_mut().turn(&from, signals);
        self.at_mut().1.t = 0.0;
        let length = self.model.way().length();
        // the branch asks for steps of the same change on any way
        let smallest = SHORTEST_STEP / larger(length, 1.0);
        let stride = self.stride;
        // the solution at the beginning, once it is behind the one before
        let mut home = None;
        for _ in 0..most {
            let now = self.at().t;
            let step = f64::max(self.stride / length, smallest);
            // a way without length is one step
            let wanted = if step < CRUMB * (1.0 - now) { now + step } else { 1.0 };
            let next = first_edge(now, wanted, &self.model);
            let (is_last, size) = (next >= 1.0, next - now);
            match self.advance(next, is_last, steepness) {
                Ok(is_calm) => {
                    if is_calm {
                        self.stride = f64::max(self.stride, 2.0 * size * length);
                    } else if length > 0.0 {
                        self.stride = f64::min(self.stride, size * length);
                    }
                    if is_last {
                        return Ok(());
                    }
                    if home.is_none() {
                        home = Some(self.other().clone());
                    }
                }
                Err(fault) => {
                    let half = 0.5 * size;
                    self.stride = half * length;
                    self.is_smooth = false;
                    if half < smallest || now + half == now {
                        let why = self.explain(fault, next, steepness);
                        self.stride = stride;
                        *self.model.way_mut() = before;
                        if let Some(home) = home {
                            *self.at_mut().1 = home;
                        }
                        return Err(why);
                    }
                }
            }
        }
        Err(Error::TooFar)
    }

    /// One step to a place of the way; says whether a longer one would do as well.
    fn advance(&mut self, t: f64, is_wanted: bool, steepness: f64) -> Result<bool, Fault> {
        let [first, second] = &mut self.solutions;
        let (from, at) = if self.is_second { (second, first) } else { (first, second) };
        let (from, m) = (&*from, &self.model);
        let h = t - from.t;
        let change = m.way().direction().map(|rate| h * rate);
        let v = tears_along(from, &change);
        let mut way = if self.is_smooth { bend(from, at, &v, &change) } else { E::Tears::ZERO };
        for (way, v) in way.as_mut().iter_mut().zip(v.as_ref()) {
            *way += v;
        }
        let is_calm = tried(&way, from, t, m, at, |at| gap(from, at, &v, &change))?;
        if !stays_on_branch(from, at, m, is_wanted, steepness) {
            return Err(Fault::Singular);
        }
        if E::OF_TIME && at.sides != from.sides && jumps(from, at, m) {
            return Err(Fault::NotSmooth);
        }
        self.is_smooth = at.sides == from.sides;
        self.is_second = !self.is_second;
        Ok(is_calm)
    }

    /// Why even the shortest step towards a place of the way is refused.
    fn explain(&self, fault: Fault, t: f64, steepness: f64) -> Error {
        let (at, m) = (self.at(), &self.model);
        if let Some(error) = regular(at, fault, t, m) {
            return error;
        }
        if at.steepest < SINGULAR * steepness {
            if fault == Fault::LeftOut {
                return Error::Inconsistent;
            }
            // a formula may jump without a branch of its own
            let mut beyond = at.clone();
            let is_there = fault == Fault::TooFar && reach(&E::tears(&at.q), at, t, m, &mut beyond).is_ok();
            return if is_there { Error::NotSmooth } else { Error::Divergence };
        }
        // all by the signal that changes most; a way may be short itself
        let longest = m.way().length();
        let mut along = m.clone();
        along.way_mut().rates = m.way().direction().map(|change| change / longest);
        along.way_mut().accelerations = [0.0; K];
        let mut moving = at.clone();
        along.solve(&E::tears(&at.q), at.t, &at.sides, &mut moving);
        meeting(until_turn(&moving), 1.0 + longest)
    }
}

/// How those coordinates change that Newton solves for, along a direction of the signals.
fn tears_along<E: Led<K>, const K: usize>(at: &Solution<E>, direction: &[f64; K]) -> E::Tears {
    sum(at.along.by_signal.each_ref().map(E::tears), direction)
}

/// How far positions are from what the slopes at both ends make of the way between, scaled.
fn gap<E: Led<K>, const K: usize>(from: &Solution<E>, at: &Solution<E>, v: &E::Tears, change: &[f64; K]) -> f64 {
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
fn bend<E: Led<K>, const K: usize>(
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
fn jumps<M: Solved>(from: &Solution<M>, at: &Solution<M>, m: &M) -> bool {
    let mut before = at.clone();
    if find(&M::tears(&at.q), at, at.t, m, &from.sides, &mut before).is_err() {
        return true;
    }
    largest(&difference(&at.q, &before.q), M::scales()) > POSITION_JUMP
}
