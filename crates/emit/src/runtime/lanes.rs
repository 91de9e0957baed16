//! Several variants of the mechanism, or several times, at once: in loops over the lanes that a compiler turns into vector
//! instructions. Each lane has the bits that it would have alone.

// loops by lane number read best and vectorise best
#![allow(clippy::needless_range_loop)]

use super::assemble::assemble;
use super::branches::{sides_ahead, sides_at, with_time};
use super::error::Error;
use super::hermite::bend_ahead;
use super::lane_solutions::{Laned, Lists, Solutions};
use super::limits::{
    CALM_BETWEEN, CALM_CORRECTION, FARTHEST_BEND, LARGEST_CORRECTION, LARGEST_GAP, LARGEST_MOTION, MOST_STEPS, STEEP,
};
use super::numbers::Numbers;
use super::running_max::running_max;
use super::state::{Assembly, Continuation, State};
use super::step::step;
use super::track::Track;
use super::work::Work;

/// A mechanism in every lane, with parameters and a time of its own.
#[derive(Clone, Debug)]
pub struct States<M: Laned<L>, const L: usize> {
    pub(super) models: [M; L],
    /// The present solutions, and the previous ones or the next ones in progress.
    pub(super) solutions: [Solutions<M, L>; 2],
    /// True if the present solutions are the second.
    pub(super) is_second: bool,
    pub(super) is_smooth: [bool; L],
    pub(super) steepness: [f64; L],
    pub(super) step: [f64; L],
    pub(super) assembly: [Assembly; L],
    pub(super) sides: [M::Sides; L],
    pub(super) monitors: [M::Monitors; L],
    /// Continuation of each lane along inputs.
    pub(super) continuation: [M::Continuation; L],
}

impl<M: Laned<L>, const L: usize> States<M, L> {
    /// Returns the present solutions.
    fn now(&self) -> &Solutions<M, L> {
        let [first, second] = &self.solutions;
        if self.is_second { second } else { first }
    }

    /// Returns the previous solutions, or the next ones in progress.
    fn other(&self) -> &Solutions<M, L> {
        let [first, second] = &self.solutions;
        if self.is_second { first } else { second }
    }

    /// Returns the present solutions and the others for modification.
    pub(super) fn both(&mut self) -> (&mut Solutions<M, L>, &mut Solutions<M, L>) {
        let [first, second] = &mut self.solutions;
        if self.is_second { (second, first) } else { (first, second) }
    }

    /// Returns the times (s).
    #[must_use]
    pub fn t(&self) -> &[f64; L] {
        &self.now().t
    }

    /// Returns the coordinates (m, rad), by their indices.
    #[must_use]
    pub fn q(&self) -> &M::Coordinates {
        &self.now().q
    }

    /// Returns the velocities of the coordinates (m/s, rad/s).
    #[must_use]
    pub fn qd(&self) -> &M::Coordinates {
        &self.now().qd
    }

    /// Returns the accelerations of the coordinates (m/s^2, rad/s^2).
    #[must_use]
    pub fn qdd(&self) -> &M::Coordinates {
        &self.now().qdd
    }

    /// Returns the state of one lane; `None` if the lane does not exist.
    #[must_use]
    pub fn get(&self, lane: usize) -> Option<State<M>> {
        let (model, lead) = (*self.models.get(lane)?, *self.continuation.get(lane)?);
        let mut solutions = [self.now().lane(lane), self.other().lane(lane)];
        for at in &mut solutions {
            at.sides = *self.sides.get(lane)?;
            at.monitors = *self.monitors.get(lane)?;
        }
        let mut passed = M::Passed::ZERO;
        passed.as_mut().fill(f64::NEG_INFINITY);
        Some(State {
            model,
            track: Track {
                solutions,
                is_second: false,
                is_smooth: *self.is_smooth.get(lane)?,
                stride: *self.step.get(lane)?,
            },
            steepness: *self.steepness.get(lane)?,
            assembly: *self.assembly.get(lane)?,
            continuation: lead,
            passed,
        })
    }

    /// Sets the state of one lane.
    fn set(&mut self, lane: usize, state: &State<M>) {
        put(&mut self.step, lane, &state.track.stride);
        put(&mut self.sides, lane, &state.at().sides);
        put(&mut self.monitors, lane, &state.at().monitors);
        put(&mut self.continuation, lane, &state.continuation);
        put(&mut self.is_smooth, lane, &false);
    }

    /// Moves one lane alone, and leaves its solution among the other ones.
    fn alone(&mut self, lane: usize, t: f64) -> Result<(), Error> {
        let Some(mut state) = self.get(lane) else {
            return Ok(());
        };
        // the rejected trial has replaced the previous solution
        state.track.is_smooth = false;
        let result = step(t, &mut state, MOST_STEPS, &mut Work::default());
        self.both().1.set_lane(lane, state.at());
        self.set(lane, &state);
        result
    }

    /// Tries one step of every lane. Returns for each lane whether it has arrived.
    fn advance(&mut self, t: &[f64; L]) -> [bool; L] {
        let is_smooth = self.is_smooth;
        let [first, second] = &mut self.solutions;
        let (from, at) = if self.is_second { (second, first) } else { (first, second) };
        let from = &*from;
        let mut h = [0.0; L];
        for k in 0..L {
            h[k] = t[k] - from.t[k];
        }
        let (guess, motion) = guess(from, at, &h, &is_smooth);
        M::solve_each(&guess, t, &self.models, &self.sides, at);
        let gap = gap(from, at, &h);
        let is_finite = at.are_finite();
        let mut is_done = [false; L];
        for k in 0..L {
            let is_short = h[k].abs() <= self.step[k] && h[k] != 0.0;
            let is_solved = at.strain[k] <= 1.0 && at.steepest[k] <= STEEP * self.steepness[k];
            is_done[k] = is_solved && is_finite[k] && is_short;
        }
        for k in 0..L {
            let is_near = motion[k] <= LARGEST_MOTION && at.first[k] <= LARGEST_CORRECTION;
            is_done[k] &= is_near && gap[k] <= LARGEST_GAP;
        }
        for (now, before) in at.signs.as_ref().iter().zip(from.signs.as_ref()) {
            for k in 0..L {
                is_done[k] &= (now[k] ^ before[k]) >> 63 == 0;
            }
        }
        for k in 0..L {
            is_done[k] = is_done[k] && self.keeps_branch(k);
            if is_done[k] {
                let first = self.other().first[k];
                let is_calm = first < LARGEST_CORRECTION / CALM_CORRECTION && gap[k] < LARGEST_GAP / CALM_BETWEEN;
                let size = h[k].abs();
                let longest = if is_calm { 2.0 * size } else { 0.0 };
                let shortest = if is_calm { self.step[k] } else { size };
                self.step[k] = f64::max(longest, shortest).min(M::LONGEST_STEP);
                self.is_smooth[k] = true;
            }
        }
        is_done
    }

    /// Returns whether the next solution of a lane keeps the branches of formulas. A lane that inputs have moved has to
    /// return to time alone.
    fn keeps_branch(&self, lane: usize) -> bool {
        if self.continuation.get(lane).is_none_or(Continuation::is_active) {
            return false;
        }
        if !M::HAS_CHECKS {
            return true;
        }
        let (Some(model), Some(sides), Some(monitors)) =
            (self.models.get(lane), self.sides.get(lane), self.monitors.get(lane))
        else {
            return false;
        };
        let (from, mut at) = (self.now().t.get(lane).copied().unwrap_or(f64::NAN), self.other().lane(lane));
        let work = &mut Work::default();
        let (t, of_time) = (at.t, sides_at(at.t, model, work));
        let mut passed = M::Passed::ZERO;
        passed.as_mut().fill(f64::NEG_INFINITY);
        if model.first_boundary(from, t, &passed, work).is_some() {
            return false;
        }
        at.sides = of_time;
        if M::OF_MOTION {
            at.sides = with_time::<M>(sides, &of_time);
            at.sides = sides_ahead(&at, model);
        }
        at.sides == *sides
            && model.conditions_hold(&at.q, t, sides)
            && model.redundant_rows_hold(&at.q, t, sides)
            && model.monitors(&at.q, t, sides) == *monitors
    }
}

/// Assembles a mechanism for each set of parameters. Returns for each lane the reason if it cannot be assembled; such a
/// lane has the parameters of the file.
#[allow(clippy::type_complexity)] // the states, and an answer for each
pub fn assemble_each<M: Laned<L>, const L: usize>(
    params: &[M::Params; L],
) -> Result<(States<M, L>, [Result<(), Error>; L]), Error> {
    let work = &mut Work::default();
    let one = assemble::<M>(&M::Params::default(), work)?;
    let mut states = States {
        models: [one.model; L],
        solutions: [Solutions::ZERO, Solutions::ZERO],
        is_second: false,
        is_smooth: [false; L],
        steepness: [one.steepness; L],
        step: [M::LONGEST_STEP; L],
        assembly: [one.assembly; L],
        sides: [one.at().sides; L],
        monitors: [one.at().monitors; L],
        continuation: [one.continuation; L],
    };
    let mut results = [Ok(()); L];
    for (k, (params, result)) in params.iter().zip(&mut results).enumerate() {
        let found = assemble(params, work);
        *result = found.as_ref().map(|_| ()).map_err(|error| *error);
        let state = found.unwrap_or_else(|_| one.clone());
        states.both().0.set_lane(k, state.at());
        states.set(k, &state);
        put(&mut states.models, k, &state.model);
        put(&mut states.steepness, k, &state.steepness);
        put(&mut states.assembly, k, &state.assembly);
    }
    Ok((states, results))
}

/// Moves every lane to its time (s); a lane that needs more than one step moves alone. Returns for each lane the reason if
/// it has not arrived; it stays at the last time that it could reach.
pub fn step_each<M: Laned<L>, const L: usize>(t: &[f64; L], states: &mut States<M, L>) -> [Result<(), Error>; L] {
    let is_done = states.advance(t);
    let mut results = [Ok(()); L];
    for k in 0..L {
        if !is_done[k] {
            results[k] = states.alone(k, t[k]);
        }
    }
    states.is_second = !states.is_second;
    results
}

/// Returns the start of Newton's iteration in every lane, and its distance from the present position, scaled.
fn guess<M: Laned<L>, const L: usize>(
    from: &Solutions<M, L>,
    before: &Solutions<M, L>,
    h: &[f64; L],
    is_smooth: &[bool; L],
) -> (M::Guesses, [f64; L]) {
    let (mut back, mut u) = ([0.0; L], [0.0; L]);
    for k in 0..L {
        back[k] = from.t[k] - before.t[k];
        let ratio = h[k] / back[k];
        let is_known = is_smooth[k] && ratio.abs() <= FARTHEST_BEND;
        u[k] = if is_known { ratio } else { 0.0 };
    }
    let [x, v, a] = from.tears();
    let [y, w, b] = before.tears();
    let (mut guess, mut motion) = (M::Guesses::ZERO, [0.0; L]);
    let now = x.as_ref().iter().zip(v.as_ref()).zip(a.as_ref());
    let then = y.as_ref().iter().zip(w.as_ref()).zip(b.as_ref());
    let places = guess.as_mut().iter_mut().zip(M::tear_scales().as_ref());
    for ((guess, scale), (((x, v), a), ((y, w), b))) in places.zip(now.zip(then)) {
        for k in 0..L {
            let (h, x, v, a) = (h[k], x[k], v[k], a[k]);
            let bend = bend_ahead([x, v, a], [y[k], w[k], b[k]], back[k], u[k]);
            let step = h * (v + 0.5 * h * a) + bend;
            guess[k] = x + step;
            motion[k] = running_max(motion[k], step.abs() / scale);
        }
    }
    (guess, motion)
}

/// Returns the distance of positions from those that velocities and accelerations at both ends predict (Hermite), scaled.
fn gap<M: Laned<L>, const L: usize>(from: &Solutions<M, L>, at: &Solutions<M, L>, h: &[f64; L]) -> [f64; L] {
    let [x, v, a] = from.tears();
    let [y, w, b] = at.tears();
    let mut gap = [0.0; L];
    let then = x.as_ref().iter().zip(v.as_ref()).zip(a.as_ref());
    let now = y.as_ref().iter().zip(w.as_ref()).zip(b.as_ref());
    for ((((x, v), a), ((y, w), b)), scale) in then.zip(now).zip(M::tear_scales().as_ref()) {
        for k in 0..L {
            let rates = 0.5 * h[k] * (v[k] + w[k]);
            let bends = h[k] * h[k] * (1.0 / 12.0) * (a[k] - b[k]);
            let gap_here = y[k] - x[k] - rates - bends;
            gap[k] = running_max(gap[k], gap_here.abs() / scale);
        }
    }
    gap
}

/// Sets the value of a lane.
pub fn put<T: Clone>(each: &mut [T], lane: usize, value: &T) {
    if let Some(place) = each.get_mut(lane) {
        place.clone_from(value);
    }
}
