//! The motion of a batch, step by step: its tears, and the quantities that results are computed from.

use super::context::BatchContext;
use super::result_queries::ResultQueries;
use super::stepper::BatchStepper;
use super::{LANES, PerLane, ZERO};
use crate::analysis::course::{Tower, find_bends};
use crate::solver::VariantLanes;
use mechc_expr::math::{along, quintic};

/// Number of ways in which the size of terms is estimated.
const WAYS: usize = 3;

/// The states of a batch at all its steps.
#[derive(Default)]
pub(super) struct StepHistory {
    /// The times of the steps (s).
    pub times: Vec<f64>,
    /// By step, then by tear: value, velocity, acceleration.
    tears: Vec<[PerLane; 3]>,
    /// By step, then by quantity: value and two derivatives.
    towers: Vec<[PerLane; 3]>,
    /// By quantity: the magnitude of the largest terms that its values are sums of.
    term_magnitudes: Vec<PerLane>,
    /// The smallest distance of each lane to a singular position.
    min_singular_distance: [f64; LANES],
}

impl StepHistory {
    /// Removes all steps.
    pub fn clear(&mut self, quantities: usize) {
        self.times.clear();
        self.tears.clear();
        self.towers.clear();
        self.term_magnitudes.clear();
        self.term_magnitudes.resize(quantities, ZERO);
        self.min_singular_distance = [f64::INFINITY; LANES];
    }

    /// Appends the present state of a batch. `registers` are those of the quantities, by quantity and stage.
    pub fn record(
        &mut self,
        context: &BatchContext,
        queries: &ResultQueries,
        stepper: &BatchStepper,
        solution: &VariantLanes<LANES>,
        registers: &mut [Vec<Vec<PerLane>>],
    ) {
        let number = self.times.len();
        self.times.push(stepper.now.t);
        self.tears.extend(context.tears.iter().map(|&tear| stepper.now.tracked[tear]));
        for (least, distance) in self.min_singular_distance.iter_mut().zip(stepper.now.singular_distance.0) {
            *least = least.min(distance);
        }
        for (quantity, registers) in registers.iter_mut().enumerate() {
            queries.evaluate(quantity, registers, solution);
            let tower = queries.tower(quantity, registers);
            let magnitude = &mut self.term_magnitudes[quantity].0;
            magnitude.iter_mut().zip(tower[0].0).for_each(|(largest, value)| *largest = largest.max(value.abs()));
            let terms = queries.term_magnitude(quantity, &tower[0], registers, solution, number % WAYS);
            magnitude.iter_mut().zip(terms.0).for_each(|(largest, term)| *largest = largest.max(term));
            self.towers.push(tower);
        }
    }

    /// Writes the guesses for Newton at a time of each lane (s): the quintics of the tears over their steps.
    pub fn write_guesses(&self, times: &[f64; LANES], guesses: &mut [PerLane]) {
        let count = guesses.len();
        for (lane, &t) in times.iter().enumerate() {
            let step = self.step_at(t);
            let (from, h) = (self.times[step], self.times[step + 1] - self.times[step]);
            for (tear, guess) in guesses.iter_mut().enumerate() {
                let ends = [step, step + 1].map(|step| self.tears[step * count + tear].map(|values| values.0[lane]));
                guess.0[lane] = along(&quintic(ends[0], ends[1], h), (t - from) / h);
            }
        }
    }

    /// Returns the index of the step that contains a time (s).
    fn step_at(&self, t: f64) -> usize {
        self.times.partition_point(|&step| step <= t).clamp(1, self.times.len() - 1) - 1
    }

    /// Writes the values and derivatives of a quantity of one lane, by step. Returns the magnitude of the terms that the values are sums of,
    /// and the smallest distance to a singular position.
    pub fn write_course(
        &self,
        quantity: usize,
        lane: usize,
        has_second_derivative: bool,
        course: &mut Vec<Tower>,
    ) -> [f64; 2] {
        let of_lane = |tower: &[PerLane; 3]| [tower[0].0[lane], tower[1].0[lane], tower[2].0[lane]];
        course.clear();
        course.extend(self.towers.iter().skip(quantity).step_by(self.term_magnitudes.len()).map(of_lane));
        if !has_second_derivative {
            find_bends(&self.times, course);
        }
        [self.term_magnitudes[quantity].0[lane], self.min_singular_distance[lane]]
    }
}
