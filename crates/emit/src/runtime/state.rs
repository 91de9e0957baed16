//! A mechanism that moves with time, and its state.

use super::error::Error;
use super::limits::{AHEAD, FARTHEST_AHEAD, LONGEST_AHEAD};
use super::measured::Measured;
use super::numbers::{Numbers, largest, predicted};
use super::solution::{Along, Solution, Solved};
use super::track::Track;
use super::work::Work;
use core::fmt::Debug;

/// Parameters of a mechanism.
pub trait Parameters: Copy + Debug + Default {
    /// Interpolates between these parameters and others.
    #[must_use]
    fn towards(&self, other: &Self, part: f64) -> Self;

    /// Returns whether all parameters are finite.
    fn is_finite(&self) -> bool;
}

/// A mechanism whose motion follows time.
pub trait Timed: Solved<Along = Time> {
    /// Parameters of the mechanism.
    type Params: Parameters;
    /// Continuation along inputs; `()` if the mechanism has none.
    type Continuation: Continuation<Self>;
    /// Time of the last check of each domain boundary of a formula of time (s).
    type Passed: Numbers;
    /// A number for each result.
    type Row: Numbers;

    /// First time of the file's analysis (s), at which the mechanism is assembled.
    const START_TIME: f64;
    /// Duration of the file's analysis (s).
    const SPAN: f64;
    /// Longest step (s).
    const LONGEST_STEP: f64;
    /// Shortest step (s).
    const SMALLEST_STEP: f64;
    /// Largest number of evaluations for the domain boundaries of a step.
    const WORK_OF_BOUNDARIES: usize = 0;

    /// Creates the mechanism with the given parameters.
    fn new(params: &Self::Params) -> Self;

    /// Parameters of the mechanism.
    fn params(&self) -> &Self::Params;

    /// Returns the assembled position with the parameters of the file.
    fn start() -> &'static Self::Q;

    /// Returns the coordinates by the poses of the file, with the present parameters; the loops are not closed yet.
    fn drawn(&self) -> Self::Q;

    /// Solves at a position from far away. Returns `None` if that does not converge, or if blocks are too large for it.
    fn closed(&self, _q: &Self::Q, _t: f64, _work: &mut Work) -> Option<Self::Q> {
        None
    }

    /// Returns the first unchecked domain boundary in a step, with its time.
    fn first_boundary(&self, _from: f64, _to: f64, _passed: &Self::Passed, _work: &mut Work) -> Option<(usize, f64)> {
        None
    }

    /// Checks both sides of a domain boundary near the state.
    fn check_boundary(_state: &mut State<Self>, _rim: usize, _t: f64, _work: &mut Work) -> Result<(), Error> {
        Ok(())
    }
}

/// Continuation of a mechanism along its inputs.
pub trait Continuation<M: Timed>: Copy + Debug {
    /// Largest number of evaluations for the return to time: without steps, and for each step.
    const WORK: [usize; 2];

    /// Creates an inactive continuation.
    fn new(params: &M::Params) -> Self;

    /// Returns whether inputs, rather than time, have moved the mechanism to its position.
    fn is_active(&self) -> bool;

    /// Moves a mechanism back to the inputs that its formulas give at its time, in at most `most` steps. Returns the number
    /// of steps that are left, or `None` if it has not arrived yet.
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

/// Motion along time.
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

/// How a mechanism was assembled for its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Assembly {
    /// By continuation from the assembled position of the file's own parameters, along its branch.
    Led,
    /// From the poses that the file draws with these parameters, as `mechc run --set` does, because the continuation did
    /// not arrive. This may be another branch.
    Drawn,
}

/// A mechanism at a time.
#[derive(Clone, Debug)]
pub struct State<M: Timed> {
    pub(super) model: M,
    /// Position along time.
    pub(super) track: Track<M>,
    /// Steepness of the equations relative to that with the parameters of the file.
    pub(super) steepness: f64,
    /// The kind of assembly.
    pub(super) assembly: Assembly,
    /// Continuation along inputs.
    pub(super) continuation: M::Continuation,
    /// Time of the last check of each domain boundary (s).
    pub(super) passed: M::Passed,
}

impl<M: Timed> State<M> {
    /// Returns the present solution.
    pub(super) fn at(&self) -> &Solution<M> {
        self.track.at()
    }

    /// Returns how the mechanism was assembled for its parameters.
    #[must_use]
    pub fn assembly(&self) -> Assembly {
        self.assembly
    }

    /// Returns the time (s).
    #[must_use]
    pub fn t(&self) -> f64 {
        self.at().t
    }

    /// Returns the parameters.
    #[must_use]
    pub fn params(&self) -> &M::Params {
        self.model.params()
    }

    /// Returns the coordinates (m, rad), by their indices.
    #[must_use]
    pub fn q(&self) -> &M::Q {
        &self.at().q
    }

    /// Returns the velocities of the coordinates (m/s, rad/s).
    #[must_use]
    pub fn qd(&self) -> &M::Q {
        &self.at().qd
    }

    /// Returns the accelerations of the coordinates (m/s^2, rad/s^2).
    #[must_use]
    pub fn qdd(&self) -> &M::Q {
        &self.at().qdd
    }

    /// Returns the measures, by their indices, with their first and second time derivatives; `NAN` where a measure has no
    /// value, which fails no step.
    #[must_use]
    pub fn measures(&self) -> &M::Measures {
        &self.at().measures
    }

    /// Returns whether inputs, rather than time, have moved the mechanism here.
    pub(super) fn is_input_driven(&self) -> bool {
        self.continuation.is_active()
    }

    /// Returns all results in the order of the columns of `mechc run`: the time, coordinates and measures, then their first
    /// and second derivatives.
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
