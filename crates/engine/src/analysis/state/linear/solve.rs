//! Solving with the factors of the blocks, one after the other.

use super::factors::Factors;
use super::{BlockLu, Part};
use mechc_expr::math;

impl BlockLu {
    /// Solves `Φ_q x = b`, `b` by rows of Φ and `x` by coordinates, both unscaled; returns the largest scaled `|x|`.
    pub fn solve(&mut self, right: impl Fn(usize) -> f64, x: &mut [f64]) -> f64 {
        self.solve_parts(right, x, |_| true)
    }

    /// Solves `Φ_q x = b` in the explicit blocks like [`BlockLu::solve`], and keeps all other coordinates.
    pub fn solve_explicit(&mut self, right: impl Fn(usize) -> f64, x: &mut [f64]) -> f64 {
        self.solve_parts(right, x, |part| part.explicit)
    }

    /// Returns the largest scaled `|x|` of all coordinates.
    pub fn largest(&self, x: &[f64]) -> f64 {
        x.iter().zip(&self.column_scale).map(|(x, scale)| x.abs() / scale).fold(0.0, f64::max)
    }

    /// Returns the largest scaled `|x|` of the coordinates that a step is judged by.
    pub fn largest_judged(&self, x: &[f64]) -> f64 {
        self.largest_of(&self.judged, x)
    }

    /// Returns the largest scaled `|x|` like [`BlockLu::largest_judged`], but only of coordinates that need iteration: the others have no branches.
    pub fn largest_judged_implicit(&self, x: &[f64]) -> f64 {
        self.largest_of(&self.judged_implicit, x)
    }

    /// Returns the largest scaled `|x|` of some coordinates; NaN if one is NaN.
    fn largest_of(&self, columns: &[u32], x: &[f64]) -> f64 {
        let scaled = columns.iter().map(|&column| x[column as usize].abs() / self.column_scale[column as usize]);
        scaled.fold(0.0, math::max)
    }

    /// Returns the largest scaled `|x|` of the coordinates that need iteration.
    pub fn largest_implicit(&self, x: &[f64]) -> f64 {
        let implicit = self.parts.iter().filter(|part| !part.explicit);
        let columns = implicit.flat_map(|part| &self.columns[part.at..part.at + part.size]);
        columns.map(|&column| x[column as usize].abs() / self.column_scale[column as usize]).fold(0.0, f64::max)
    }

    fn solve_parts(&mut self, right: impl Fn(usize) -> f64, x: &mut [f64], is_included: impl Fn(&Part) -> bool) -> f64 {
        let mut largest: f64 = 0.0;
        let n = self.rows.len();
        let (scaled, rest) = self.work.split_at_mut(n);
        let (block, work) = rest.split_at_mut(n);
        let factors = factors!(self);
        for part in &self.parts {
            if !is_included(part) {
                for &column in &self.columns[part.at..part.at + part.size] {
                    scaled[column as usize] = 0.0;
                    x[column as usize] = 0.0;
                }
                continue;
            }
            let b = &mut block[..part.size];
            for (place, b) in b.iter_mut().enumerate() {
                let k = part.at + place;
                let row = self.rows[k] as usize;
                let mut sum = right(row) / self.row_norm[row];
                for index in self.starts[k]..self.starts[k + 1] {
                    let entry = self.entries[index];
                    if entry.place.is_none() {
                        sum -= self.values[index] * scaled[entry.column as usize];
                    }
                }
                *b = sum;
            }
            factors.solve(part, b, work);
            for (place, &value) in b.iter().enumerate() {
                let column = self.columns[part.at + place] as usize;
                scaled[column] = value;
                x[column] = value * self.column_scale[column];
                largest = math::max(largest, value.abs());
            }
        }
        largest
    }

    /// Solves `Φ_qᵀ λ = p`, `p` by coordinates and `λ` by rows of Φ, both unscaled.
    pub fn solve_for_multipliers(&mut self, needed: impl Fn(usize) -> f64, multipliers: &mut [f64]) {
        self.solve_transposed(|column, scale| scale * needed(column), multipliers);
        for (multiplier, norm) in multipliers.iter_mut().zip(&self.row_norm) {
            *multiplier /= norm;
        }
    }

    /// Solves the transposed scaled system, `w` by rows; `right` returns the right side of a coordinate for its index and scale.
    pub(super) fn solve_transposed(&mut self, right: impl Fn(usize, f64) -> f64, w: &mut [f64]) {
        let n = self.rows.len();
        let (rest, work) = self.work.split_at_mut(n);
        let (block, work) = work.split_at_mut(n);
        for (column, (open, &scale)) in rest.iter_mut().zip(&self.column_scale).enumerate() {
            *open = right(column, scale);
        }
        let factors = factors!(self);
        for part in self.parts.iter().rev() {
            let b = &mut block[..part.size];
            for (place, b) in b.iter_mut().enumerate() {
                *b = rest[self.columns[part.at + place] as usize];
            }
            factors.solve_transposed(part, b, work);
            for (place, &value) in b.iter().enumerate() {
                let k = part.at + place;
                w[self.rows[k] as usize] = value;
                for index in self.starts[k]..self.starts[k + 1] {
                    let entry = self.entries[index];
                    if entry.place.is_none() {
                        rest[entry.column as usize] -= self.values[index] * value;
                    }
                }
            }
        }
        debug_assert_eq!(w.len(), n);
    }
}
