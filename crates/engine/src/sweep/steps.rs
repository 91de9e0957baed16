//! The motion of variants that go side by side, step by step, with the course of what results ask of it.

use super::asked::Asked;
use super::each::{Each, LANES, ZERO};
use super::together::Together;
use super::walk::Walk;
use crate::analysis::course::{Tower, find_bends};
use crate::solver::Abreast;
use mechc_expr::math::{along, quintic};
use mechc_ir::tolerances::solving::course::{EVERY, WAYS};
use std::array::from_fn;

/// The motion, step by step.
#[derive(Default)]
pub(super) struct Steps {
    /// Their times (s).
    pub times: Vec<f64>,
    /// Tear by tear, at each step.
    tears: Vec<[Each; 3]>,
    /// Formula by formula, at each step.
    towers: Vec<[Each; 3]>,
    /// By formula: the size of the largest numbers that a value was a sum of.
    weights: Vec<Each>,
    /// How near to a singular position each came.
    nearest: [f64; LANES],
}

impl Steps {
    /// Forgets all.
    pub fn clear(&mut self, quantities: usize) {
        self.times.clear();
        self.tears.clear();
        self.towers.clear();
        self.weights.clear();
        self.weights.resize(quantities, ZERO);
        self.nearest = [f64::INFINITY; LANES];
    }

    /// Takes note of where variants are.
    pub fn take(
        &mut self,
        (of, asked): (&Together, &Asked),
        walk: &Walk,
        from: &Abreast<LANES>,
        registers: &mut [Vec<Vec<Each>>],
    ) {
        let number = self.times.len();
        self.times.push(walk.now.t);
        self.tears.extend(of.tears.iter().map(|&tear| walk.now.tracked[tear]));
        for (least, near) in self.nearest.iter_mut().zip(walk.now.nearness.0) {
            *least = least.min(near);
        }
        for (quantity, registers) in registers.iter_mut().enumerate() {
            asked.look(quantity, registers, from);
            let tower = asked.tower(quantity, registers);
            let weight = &mut self.weights[quantity].0;
            weight.iter_mut().zip(tower[0].0).for_each(|(weight, value)| *weight = weight.max(value.abs()));
            if number.is_multiple_of(EVERY) {
                let more = asked.weight((quantity, &tower[0]), registers, from, number / EVERY % WAYS);
                weight.iter_mut().zip(more.0).for_each(|(weight, more)| *weight = weight.max(more));
            }
            self.towers.push(tower);
        }
    }

    /// Where Newton begins at a time of each (s): on the quintics of its tears.
    pub fn write_guesses(&self, times: &[f64; LANES], guesses: &mut [Each]) {
        let count = guesses.len();
        if times.iter().all(|t| t.to_bits() == times[0].to_bits()) {
            self.write_guesses_at(times[0], guesses);
            return;
        }
        for (lane, &t) in times.iter().enumerate() {
            let step = self.before(t);
            let (from, h) = (self.times[step], self.times[step + 1] - self.times[step]);
            for (tear, guess) in guesses.iter_mut().enumerate() {
                let ends = [step, step + 1].map(|step| self.tears[step * count + tear].map(|each| each.0[lane]));
                guess.0[lane] = along(&quintic(ends[0], ends[1], h), (t - from) / h);
            }
        }
    }

    /// The same at one time of all (s): what value, slope and curvature at both ends of the step weigh there is found once.
    fn write_guesses_at(&self, t: f64, guesses: &mut [Each]) {
        let (count, step) = (guesses.len(), self.before(t));
        let (from, h) = (self.times[step], self.times[step + 1] - self.times[step]);
        let weights: [f64; 6] = from_fn(|k| {
            let mut ends = [[0.0; 3]; 2];
            ends[k / 3][k % 3] = 1.0;
            along(&quintic(ends[0], ends[1], h), (t - from) / h)
        });
        for (tear, guess) in guesses.iter_mut().enumerate() {
            let [a, b] = [step, step + 1].map(|step| &self.tears[step * count + tear]);
            for (lane, guess) in guess.0.iter_mut().enumerate() {
                let known = [a[0].0[lane], a[1].0[lane], a[2].0[lane], b[0].0[lane], b[1].0[lane], b[2].0[lane]];
                *guess = known.iter().zip(&weights).map(|(known, weight)| known * weight).sum();
            }
        }
    }

    /// The number of the last step that is not later than a time (s), but for the last of all.
    fn before(&self, t: f64) -> usize {
        self.times.partition_point(|&step| step <= t).clamp(1, self.times.len() - 1) - 1
    }

    /// The course of a quantity of one variant; gives the size of the numbers that its values are sums of, and how near to a singular position they
    /// come.
    pub fn write_course(&self, quantity: usize, lane: usize, knows_bends: bool, course: &mut Vec<Tower>) -> [f64; 2] {
        let of = |tower: &[Each; 3]| [tower[0].0[lane], tower[1].0[lane], tower[2].0[lane]];
        course.clear();
        course.extend(self.towers.iter().skip(quantity).step_by(self.weights.len()).map(of));
        if !knows_bends {
            find_bends(&self.times, course);
        }
        [self.weights[quantity].0[lane], self.nearest[lane]]
    }
}
