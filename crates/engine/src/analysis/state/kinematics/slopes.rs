//! Slopes at and near a position, by which nearness to a singular position is judged.

use super::Kinematics;
use super::residuals::largest_term;
use crate::analysis::state::aslant;
use mechc_ir::program::Stage;

/// The slope of a row, times the size of a coordinate, is rounding up to this part of the row's largest term: the terms of the slope
/// may be larger than those.
const NO_SLOPE: f64 = 256.0 * f64::EPSILON;
/// Distance from a position at which the slope of a curved row is evaluated, scaled.
const BESIDE: f64 = 0.1;

impl Kinematics {
    /// Measures the slopes at a position, at the time that was set, by which nearness to a singular position is judged. Slopes of some rows are also
    /// evaluated on both sides of it: a slope counts for no less than the lesser of these, so a slope that vanishes in between makes a singular
    /// position, and one that grows near a pole does not. Rows that are bent are scaled by that as well. The position must be set anew.
    pub fn measure_slopes(&mut self, q: &[f64]) {
        if self.linear.equilibration().is_measured() && !self.linear.equilibration().changes() {
            return;
        }
        if !self.with_nearby_slopes.is_empty() {
            self.evaluate_nearby(q);
        }
        self.evaluate(q);
        let (registers, program) = (&self.registers, &*self.program);
        let coordinate = |column: usize| registers.get(program.inputs.coordinates[0] + column as u32);
        let equilibration = self.linear.equilibration();
        equilibration.turn(coordinate);
        let rounding = |row: usize| NO_SLOPE * f64::max(largest_term(program, registers, row), self.nearby_terms[row]);
        equilibration.measure(|position| registers.get(program.outputs.phi_q[position]), rounding);
    }

    /// Returns a factored row without a slope: its scaled slope is less than `least`, or changes it by no more than rounding does.
    pub fn row_without_slope(&self, least: f64) -> Option<usize> {
        let term = |row: usize| f64::max(self.largest_term_of(row), self.nearby_terms[row]);
        let is_rounding = |&row: &usize| self.slope(row) <= NO_SLOPE * term(row);
        self.linear.row_without_slope(least).or_else(|| (0..self.system().rows().len()).find(is_rounding))
    }

    fn evaluate_nearby(&mut self, q: &[f64]) {
        let determined = self.determined();
        let pattern = determined.system().phi_q();
        // a formula without a value has no slope
        let lesser = |least: f64, found: f64| if found.is_finite() { f64::min(least, found) } else { least };
        let or_none = |least: f64| if least.is_finite() { least } else { 0.0 };
        for way in [BESIDE, -BESIDE] {
            for (column, nearby) in self.nearby.iter_mut().enumerate() {
                *nearby = q[column] + way * aslant(column) * self.linear.column_scale(column);
            }
            self.registers.set_all(self.program.inputs.coordinates[0], &self.nearby);
            self.program.run(Stage::Position, &mut self.registers);
            let is_first = way > 0.0;
            for index in 0..self.with_nearby_slopes.len() {
                let row = self.with_nearby_slopes[index];
                let largest = if is_first { 0.0 } else { self.nearby_terms[row] };
                let term = self.largest_term_of(row);
                self.nearby_terms[row] = if term.is_finite() { f64::max(largest, term) } else { largest };
                for position in pattern.range(row) {
                    let found = self.phi_q(position).abs();
                    let slope = self.linear.equilibration().nearby_slope(position);
                    *slope = lesser(if is_first { f64::INFINITY } else { *slope }, found);
                    *slope = if is_first { *slope } else { or_none(*slope) };
                }
            }
            for index in 0..self.bent.len() {
                let row = self.bent[index];
                let before = if is_first { f64::INFINITY } else { self.linear.least_norm(row) };
                let least = lesser(before, self.slope(row));
                self.linear.set_least_norm(row, if is_first { least } else { or_none(least) });
            }
        }
    }

    fn evaluate(&mut self, q: &[f64]) {
        self.registers.set_all(self.program.inputs.coordinates[0], q);
        self.program.run(Stage::Position, &mut self.registers);
    }

    /// Returns the norm of a row of the scaled Φ_q at the current position.
    fn slope(&self, row: usize) -> f64 {
        let pattern = self.system().phi_q();
        let scaled = pattern
            .range(row)
            .zip(pattern.row(row))
            .map(|(position, &(column, _))| self.phi_q(position) * self.linear.column_scale(column as usize));
        scaled.map(|x| x * x).sum::<f64>().sqrt()
    }
}
