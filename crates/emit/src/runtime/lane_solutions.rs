//! Solutions of the equations in every lane.

// loops by lane number read best and vectorise best
#![allow(clippy::needless_range_loop)]

use super::measured::Measured;
use super::solution::Solution;
use super::state::Timed;
use core::fmt::Debug;

/// A list of numbers for every lane.
pub trait Lists<T, const L: usize>: Copy + Debug + AsRef<[[T; L]]> + AsMut<[[T; L]]> {
    /// All numbers 0.
    const ZERO: Self;
}

impl<const K: usize, const L: usize> Lists<f64, L> for [[f64; L]; K] {
    const ZERO: Self = [[0.0; L]; K];
}

impl<const K: usize, const L: usize> Lists<u64, L> for [[u64; L]; K] {
    const ZERO: Self = [[0; L]; K];
}

/// A mechanism that is solved in several lanes at once.
pub trait Laned<const L: usize>: Timed {
    /// A number for each coordinate.
    type Coordinates: Lists<f64, L>;
    /// A number for each coordinate that Newton solves for.
    type Guesses: Lists<f64, L>;
    /// A number for each measure.
    type Values: Lists<f64, L>;
    /// The time derivative of each measure.
    type Rates: Lists<f64, L>;
    /// The second time derivative of each measure.
    type Accelerations: Lists<f64, L>;
    /// A number for each value that only measures need.
    type OfJoined: Lists<f64, L>;
    /// A number for each block that has the sign of its determinant.
    type Signs: Lists<u64, L>;

    /// True if conditions beside the equations exist.
    const HAS_CHECKS: bool;

    /// Selects the coordinates that Newton solves for.
    fn tears_of(q: &Self::Coordinates) -> Self::Guesses;

    /// Solves for position, velocity and acceleration in every lane.
    fn solve_each(
        guess: &Self::Guesses,
        t: &[f64; L],
        models: &[Self; L],
        sides: &[Self::Sides; L],
        at: &mut Solutions<Self, L>,
    );
}

/// Solutions of the equations in every lane.
#[derive(Clone, Debug)]
pub struct Solutions<M: Laned<L>, const L: usize> {
    /// Times (s).
    pub t: [f64; L],
    /// Coordinates.
    pub q: M::Coordinates,
    /// Velocities.
    pub qd: M::Coordinates,
    /// Accelerations.
    pub qdd: M::Coordinates,
    /// Measures.
    pub values: M::Values,
    /// Rates of the measures.
    pub rates: M::Rates,
    /// Accelerations of the measures.
    pub accelerations: M::Accelerations,
    /// Values that only measures need.
    #[allow(dead_code)] // mostly they need nothing
    pub joined: M::OfJoined,
    /// A number for each block that has the sign of its determinant.
    pub signs: M::Signs,
    /// Largest ratio of multipliers, residuals, angles and corrections to their bounds: at most 1 in a valid lane.
    pub strain: [f64; L],
    /// Largest first correction of Newton's iteration, scaled.
    pub first: [f64; L],
    /// Reciprocal of the smallest pivot, scaled.
    pub steepest: [f64; L],
}

impl<M: Laned<L>, const L: usize> Solutions<M, L> {
    /// Solutions before the first solve.
    pub const ZERO: Self = Self {
        t: [0.0; L],
        q: M::Coordinates::ZERO,
        qd: M::Coordinates::ZERO,
        qdd: M::Coordinates::ZERO,
        values: M::Values::ZERO,
        rates: M::Rates::ZERO,
        accelerations: M::Accelerations::ZERO,
        joined: M::OfJoined::ZERO,
        signs: M::Signs::ZERO,
        strain: [0.0; L],
        first: [0.0; L],
        steepest: [0.0; L],
    };

    /// Resets the records before a solve.
    pub fn begin(&mut self, t: &[f64; L]) {
        self.t = *t;
        let zero = [0.0; L];
        (self.strain, self.first, self.steepest) = (zero, zero, zero);
        for (signs, is_negative) in self.signs.as_mut().iter_mut().zip(M::turned().as_ref()) {
            *signs = [u64::from(*is_negative) << 63; L];
        }
    }

    /// Returns the coordinates that Newton solves for, with their velocities and accelerations.
    pub fn tears(&self) -> [M::Guesses; 3] {
        [M::tears_of(&self.q), M::tears_of(&self.qd), M::tears_of(&self.qdd)]
    }

    /// Returns for each lane whether all its numbers are finite.
    pub fn are_finite(&self) -> [bool; L] {
        let mut sum = [0.0; L];
        for list in [&self.q, &self.qd, &self.qdd] {
            for each in list.as_ref() {
                for k in 0..L {
                    sum[k] += 0.0 * each[k];
                }
            }
        }
        sum.map(|sum| sum == 0.0)
    }

    /// Returns the solution of one lane.
    pub fn lane(&self, lane: usize) -> Solution<M> {
        let mut at = Solution::<M>::ZERO;
        at.t = of(&self.t, lane);
        get(self.q.as_ref(), lane, at.q.as_mut());
        get(self.qd.as_ref(), lane, at.qd.as_mut());
        get(self.qdd.as_ref(), lane, at.qdd.as_mut());
        let [values, rates, accelerations] = at.measures.lists_mut();
        get(self.values.as_ref(), lane, values);
        get(self.rates.as_ref(), lane, rates);
        get(self.accelerations.as_ref(), lane, accelerations);
        at.measures.leave_out();
        for (is_negative, signs) in at.is_negative.as_mut().iter_mut().zip(self.signs.as_ref()) {
            *is_negative = signs.get(lane).is_some_and(|sign| sign >> 63 == 1);
        }
        at.steepest = of(&self.steepest, lane);
        at
    }

    /// Sets the solution of one lane.
    pub fn set_lane(&mut self, lane: usize, at: &Solution<M>) {
        set([at.t].as_slice(), lane, core::slice::from_mut(&mut self.t));
        set([at.steepest].as_slice(), lane, core::slice::from_mut(&mut self.steepest));
        set(at.q.as_ref(), lane, self.q.as_mut());
        set(at.qd.as_ref(), lane, self.qd.as_mut());
        set(at.qdd.as_ref(), lane, self.qdd.as_mut());
        let [values, rates, accelerations] = at.measures.lists();
        set(values, lane, self.values.as_mut());
        set(rates, lane, self.rates.as_mut());
        set(accelerations, lane, self.accelerations.as_mut());
        for (signs, is_negative) in self.signs.as_mut().iter_mut().zip(at.is_negative.as_ref()) {
            if let Some(sign) = signs.get_mut(lane) {
                *sign = u64::from(*is_negative) << 63;
            }
        }
    }
}

/// Returns the number of a lane.
fn of<const L: usize>(each: &[f64; L], lane: usize) -> f64 {
    each.get(lane).copied().unwrap_or(f64::NAN)
}

/// Reads the numbers of a lane.
fn get<const L: usize>(each: &[[f64; L]], lane: usize, to: &mut [f64]) {
    to.iter_mut().zip(each).for_each(|(to, each)| *to = of(each, lane));
}

/// Writes the numbers of a lane.
fn set<const L: usize>(values: &[f64], lane: usize, to: &mut [[f64; L]]) {
    for (each, value) in to.iter_mut().zip(values) {
        if let Some(place) = each.get_mut(lane) {
            *place = *value;
        }
    }
}
