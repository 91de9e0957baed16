//! The factors of all blocks, for solving and for judging nearness to a singular position.

use super::{Form, Part};
use crate::analysis::state::dense::{solve_dense, solve_dense_transposed};
use crate::analysis::state::equilibration::{Centroid, Equilibration};
use crate::limits::solver::LEAST_PIVOT;

/// Largest ratio between the distances to a singular position in the scales of the solver and in those of the equilibration for which
/// the former are used.
const ALIKE: f64 = 10.0;

/// The factors of all blocks.
#[derive(Clone, Copy)]
pub(super) struct Factors<'l> {
    pub values: &'l [f64],
    pub inside: &'l [u32],
    pub dense: &'l [f64],
    pub pivots: &'l [u32],
    pub rows: &'l [u32],
    pub columns: &'l [u32],
    pub row_norm: &'l [f64],
    pub size: &'l [f64],
    pub equilibration: &'l Equilibration,
    /// True if nearness is measured by the equilibration scales, or by the scales that are solved with.
    pub is_judging: bool,
}

impl Factors<'_> {
    /// Returns the factor that turns an entry of the scaled `Φ_q` into that by which nearness is judged, for its row, given by its place in
    /// the block.
    pub fn row_scale(&self, part: &Part, place: usize) -> f64 {
        let row = self.rows[part.at + place] as usize;
        if self.is_judging { self.row_norm[row] / self.equilibration.row(row) } else { 1.0 }
    }

    /// Returns the factor of [`Factors::row_scale`] for the column of the entry.
    pub fn column_scale(&self, part: &Part, place: usize) -> f64 {
        let column = self.columns[part.at + place] as usize;
        if self.is_judging { self.equilibration.column(column) / self.size[column] } else { 1.0 }
    }

    /// With A the scaled block and P A K that by which nearness is judged: multiplies by P⁻¹.
    pub fn judge_by_rows(&self, part: &Part, b: &mut [f64]) {
        for (place, b) in b.iter_mut().enumerate() {
            *b /= self.row_scale(part, place);
        }
    }

    /// Multiplies by K⁻ᵀ: what belongs to a body's turn about its centroid goes to that about its origin.
    pub fn judge_by_columns(&self, k: usize, part: &Part, b: &mut [f64]) {
        for (place, b) in b.iter_mut().enumerate() {
            *b /= self.column_scale(part, place);
        }
        for centroid in self.centroids(k) {
            let [right, up] = centroid.from_origin;
            let ([column, turn], arms) = (centroid.turn, [-up, right]);
            for ([moved, place], arm) in centroid.moves.into_iter().zip(arms).filter_map(|(at, arm)| Some((at?, arm))) {
                let share = arm * b[place as usize] / self.size[moved as usize];
                b[turn as usize] += share * self.size[column as usize];
            }
        }
    }

    /// Multiplies by K⁻¹: motions of origins become those of centroids.
    pub fn judge_motion(&self, k: usize, part: &Part, x: &mut [f64]) {
        for centroid in self.centroids(k) {
            let [right, up] = centroid.from_origin;
            let ([column, turn], arms) = (centroid.turn, [-up, right]);
            let turn = x[turn as usize] * self.size[column as usize];
            for ([moved, place], arm) in centroid.moves.into_iter().zip(arms).filter_map(|(at, arm)| Some((at?, arm))) {
                x[place as usize] += arm * turn / self.size[moved as usize];
            }
        }
        for (place, x) in x.iter_mut().enumerate() {
            *x /= self.column_scale(part, place);
        }
    }

    pub fn centroids(&self, k: usize) -> &[Centroid] {
        if self.is_judging { self.equilibration.centroids(k) } else { &[] }
    }

    /// Solves within a block: `b` by its rows becomes the solution by its columns.
    pub fn solve(self, part: &Part, b: &mut [f64], work: &mut [f64]) {
        match part.form {
            Form::Single => b[0] /= self.single(part),
            Form::Planned(plan) => part.plans[plan].solve(&part.slots, b, work),
            Form::Dense => solve_dense(self.matrix(part), &self.pivots[part.at..part.at + part.size], b),
        }
    }

    pub fn solve_transposed(self, part: &Part, b: &mut [f64], work: &mut [f64]) {
        match part.form {
            Form::Single => b[0] /= self.single(part),
            Form::Planned(plan) => part.plans[plan].solve_transposed(&part.slots, b, work),
            Form::Dense => solve_dense_transposed(self.matrix(part), &self.pivots[part.at..part.at + part.size], b),
        }
    }

    /// Returns the entry of a block of one equation, with the least allowed magnitude if it vanishes.
    pub fn single(&self, part: &Part) -> f64 {
        let value = self.values[self.inside[part.inside.start] as usize];
        if value.abs() < LEAST_PIVOT { LEAST_PIVOT.copysign(value) } else { value }
    }

    pub fn matrix(&self, part: &Part) -> &[f64] {
        &self.dense[part.matrix..part.matrix + part.size * part.size]
    }

    /// Returns the factors with the scales that are solved with.
    pub fn as_solved(self) -> Self {
        Factors { is_judging: false, ..self }
    }

    /// Returns how near a block is to a singular position, with the vectors of its smallest singular value in the equilibration scales.
    pub fn nearness(self, k: usize, part: &Part, [left, right]: [&mut [f64]; 2], work: &mut [f64]) -> f64 {
        let sigma = self.as_solved().singular(k, part, [&mut *left, &mut *right], work);
        if self.is_judging { borne_out(sigma, self.singular(k, part, [left, right], work)) } else { sigma }
    }

    /// Returns the smallest singular value of a block as nearness is judged, and writes its left and right vectors; by inverse iteration.
    pub fn singular(self, k: usize, part: &Part, [left, right]: [&mut [f64]; 2], work: &mut [f64]) -> f64 {
        if part.form == Form::Single {
            (left[0], right[0]) = (self.single(part).signum(), 1.0);
            return self.single(part).abs() * self.row_scale(part, 0) * self.column_scale(part, 0);
        }
        for (k, x) in right.iter_mut().enumerate() {
            *x = 1.0 + 0.1 * (k % 7) as f64;
        }
        let mut sigma = 1.0;
        for _ in 0..4 {
            normalize(right);
            left.copy_from_slice(right);
            self.judge_by_columns(k, part, left);
            self.solve_transposed(part, left, work);
            self.judge_by_rows(part, left);
            normalize(left);
            right.copy_from_slice(left);
            self.judge_by_rows(part, right);
            self.solve(part, right, work);
            self.judge_motion(k, part, right);
            sigma = 1.0 / normalize(right);
        }
        sigma
    }
}

/// Returns the nearness by the scales that are solved with, if the equilibration confirms it, or else the nearness by the latter: they serve where
/// bodies are of a size, and frames near them.
pub(super) fn borne_out(solved: f64, judged: f64) -> f64 {
    let is_borne_out = solved <= ALIKE * judged && judged <= ALIKE * solved;
    if is_borne_out { solved } else { judged }
}

pub(super) fn normalize(v: &mut [f64]) -> f64 {
    let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    if norm > 0.0 && norm.is_finite() {
        for x in v {
            *x /= norm;
        }
    }
    norm
}
