//! A mechanism that moves with time, and where it is.

use super::error::Error;
use super::limits::{AHEAD, FARTHEST_AHEAD, LONGEST_AHEAD};
use super::measured::Measured;
use super::numbers::{Numbers, largest, predicted};
use super::solution::{Along, Solution, Solved};
use super::track::Track;
use super::work::Work;
use core::fmt::Debug;

/// What can be set of a mechanism.
pub trait Parameters: Copy + Debug + Default {
    /// Part of the way from these to others.
    #[must_use]
    fn towards(&self, other: &Self, part: f64) -> Self;

    /// Whether all are numbers.
    fn is_finite(&self) -> bool;
}

/// A mechanism whose motion goes along time.
pub trait Timed: Solved<Along = Time> {
    /// Its parameters.
    type Params: Parameters;
    /// What leads it by its inputs; `()` where it has none.
    type Continuation: Continuation<Self>;
    /// By boundary, where formulas of time may end: the time at which it was looked at last (s).
    type Passed: Numbers;
    /// A number for each result.
    type Row: Numbers;

    /// The first time of the file's analysis (s), at which the mechanism is assembled.
    const START_TIME: f64;
    /// How long the file's analysis takes (s).
    const SPAN: f64;
    /// The longest step (s).
    const LONGEST_STEP: f64;
    /// The shortest step (s).
    const SMALLEST_STEP: f64;
    /// Evaluations that the boundaries of a step take at most.
    const WORK_OF_BOUNDARIES: usize = 0;

    /// The mechanism with some parameters.
    fn new(params: &Self::Params) -> Self;

    /// Its parameters.
    fn params(&self) -> &Self::Params;

    /// The assembled position with the file's parameters.
    fn start() -> &'static Self::Q;

    /// Where the file's poses put the coordinates with its parameters, roughly: what is not closed yet.
    fn drawn(&self) -> Self::Q;

    /// Solves at a place from far away; nothing where that does not arrive, or blocks are too large for it.
    fn closed(&self, _q: &Self::Q, _t: f64, _work: &mut Work) -> Option<Self::Q> {
        None
    }

    /// The first boundary of a step that was not looked at yet, with its time.
    fn first_boundary(&self, _from: f64, _to: f64, _passed: &Self::Passed, _work: &mut Work) -> Option<(usize, f64)> {
        None
    }

    /// Looks at both sides of a boundary next to the state.
    fn check_boundary(_state: &mut State<Self>, _rim: usize, _t: f64, _work: &mut Work) -> Result<(), Error> {
        Ok(())
    }
}

/// What leads a mechanism by its inputs.
pub trait Continuation<M: Timed>: Copy + Debug {
    /// Evaluations that taking up the time takes at most beside its steps, and each of these.
    const WORK: [usize; 2];

    /// Nothing is led yet.
    fn new(params: &M::Params) -> Self;

    /// Whether inputs have led to where the mechanism is, rather than the time.
    fn is_active(&self) -> bool;

    /// Brings a mechanism that inputs have led back to what the formulas of its inputs say at its time, in so many steps at most;
    /// gives how many of them are left, or nothing where it is still on its way.
    fn resume_time(state: &mut State<M>, most: usize, work: &mut Work) -> Result<Option<usize>, Error>;
}

impl<M: Timed> Continuation<M> for () {
    const WORK: [usize; 2] = [0, 0];

    fn new(_: &M::Params) -> Self {}

    fn is_active(&self) -> bool {
        false
    }

    fn resume_time(_: &mut State<M>, most: usize, _: &mut Work) -> Result<Option<usize>, Error> {
        Ok(Some(most))
    }
}

/// The motion goes along time.
#[derive(Clone, Copy, Debug)]
pub struct Time;

impl<M: Timed> Along<M> for Time {
    const ZERO: Self = Self;

    fn predicted(_: &M, from: &Solution<M>, h: f64) -> M::Q {
        predicted(&from.q, &from.qd, &from.qdd, h)
    }

    fn ahead(_: &M, at: &Solution<M>) -> (M::Q, f64) {
        let (speed, acceleration) = (largest(&at.qd, M::scales()), largest(&at.qdd, M::scales()));
        let mut ahead = f64::min(f64::min(AHEAD * M::SPAN, LONGEST_AHEAD), FARTHEST_AHEAD / speed);
        ahead = f64::min(ahead, FARTHEST_AHEAD / (acceleration * ahead));
        (predicted(&at.q, &at.qd, &at.qdd, ahead), at.t + ahead)
    }
}

/// How a mechanism was assembled with its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Assembly {
    /// It was led from the assembled position of the file's own parameters, along its branch.
    Led,
    /// No way led there: the equations were solved from the poses that the file draws with these parameters, as `mechc run --set` does.
    /// It may be another branch.
    Drawn,
}

/// A mechanism at a time.
#[derive(Clone, Debug)]
pub struct State<M: Timed> {
    pub(super) model: M,
    /// Where it is along the time.
    pub(super) track: Track<M>,
    /// How much steeper these parameters make the equations than the file's.
    pub(super) steepness: f64,
    /// How it was assembled.
    pub(super) assembly: Assembly,
    /// What leads by inputs.
    pub(super) continuation: M::Continuation,
    /// By boundary: the time at which it was looked at last (s).
    pub(super) passed: M::Passed,
}

impl<M: Timed> State<M> {
    /// The solution of now.
    pub(super) fn at(&self) -> &Solution<M> {
        self.track.at()
    }

    /// How it was assembled with its parameters.
    #[must_use]
    pub fn assembly(&self) -> Assembly {
        self.assembly
    }

    /// The time (s).
    #[must_use]
    pub fn t(&self) -> f64 {
        self.at().t
    }

    /// The parameters.
    #[must_use]
    pub fn params(&self) -> &M::Params {
        self.model.params()
    }

    /// The coordinates (m, rad), by their indices.
    #[must_use]
    pub fn q(&self) -> &M::Q {
        &self.at().q
    }

    /// Their velocities (m/s, rad/s).
    #[must_use]
    pub fn qd(&self) -> &M::Q {
        &self.at().qd
    }

    /// Their accelerations (m/s^2, rad/s^2).
    #[must_use]
    pub fn qdd(&self) -> &M::Q {
        &self.at().qdd
    }

    /// The measures, by their indices, and their first and second time derivatives; `NAN` where one has no value, and no step fails
    /// for that.
    #[must_use]
    pub fn measures(&self) -> &M::Measures {
        &self.at().measures
    }

    /// Whether inputs have led here, rather than the time.
    pub(super) fn is_input_driven(&self) -> bool {
        self.continuation.is_active()
    }

    /// All results, in the order of the columns of `mechc run`: the time, coordinates and measures, then their first and their second
    /// derivatives.
    #[must_use]
    pub fn row(&self) -> M::Row {
        let at = self.at();
        let [values, rates, accelerations] = at.measures.lists();
        let zeroth = at.q.as_ref().iter().chain(values);
        let first = at.qd.as_ref().iter().chain(rates);
        let second = at.qdd.as_ref().iter().chain(accelerations);
        let all = [at.t].into_iter().chain(zeroth.chain(first).chain(second).copied());
        let mut row = M::Row::ZERO;
        row.as_mut().iter_mut().zip(all).for_each(|(cell, value)| *cell = value);
        row
    }
}
