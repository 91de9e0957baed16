//! Scaling and factoring of the blocks.

use super::factors::{Factors, borne_out};
use super::{BlockLu, Factored, Form, LARGEST_BLOCK, Part};
use crate::analysis::state::dense::factor_dense;
use crate::analysis::state::sparse::Plan;
use crate::limits::solver::LARGEST_MULTIPLIER;
use crate::solver::BlockEntry;
use mechc_expr::math::GOLDEN;

/// A block with a smaller pivot, scaled, is singular.
const SMALLEST_PIVOT: f64 = 1e-14;
/// Number of stored orders of elimination, so that one suits most of a motion.
const PLANS: u32 = 4;

impl BlockLu {
    /// Chooses orders of elimination by the values that were factored last. Allocates.
    pub fn choose_orders(&mut self) {
        for k in 0..self.parts.len() {
            let part = &self.parts[k];
            if part.size == 1 {
                continue;
            }
            let entries = self.entries_of(part);
            let mut plans = vec![Plan::new(part.size, &entries)];
            // the same pattern with other values
            for seed in 1..if part.is_small() { PLANS } else { 1 } {
                let other = entries.iter().enumerate().map(|(k, &entry)| {
                    let value = (GOLDEN * f64::from(seed) * (k + 1) as f64).fract() - 0.5;
                    BlockEntry { value, ..entry }
                });
                plans.push(Plan::new(part.size, &other.collect::<Vec<BlockEntry>>()));
            }
            let slots = plans.iter().map(Plan::slots).max().unwrap_or(0);
            let part = &mut self.parts[k];
            (part.plans, part.slots) = (plans, vec![0.0; slots]);
            self.factor_part(k);
        }
    }

    /// Returns a block's entries where it was loaded.
    fn entries_of(&self, part: &Part) -> Vec<BlockEntry> {
        let entry = |index: &u32| {
            let (row, column) = self.entries[*index as usize].place?;
            Some(BlockEntry { row, column, value: self.values[*index as usize], is_number: false })
        };
        self.inside[part.inside.clone()].iter().filter_map(entry).collect()
    }

    /// Scales and factors; `value` gives the entries of `Φ_q` by their position in the pattern.
    pub fn factor(&mut self, value: impl Fn(usize) -> f64) -> Factored {
        let mut regular = true;
        for k in 0..self.parts.len() {
            for row in self.parts[k].at..self.parts[k].at + self.parts[k].size {
                regular &= self.load_row(row, &value);
            }
            self.factor_part(k);
            // also refuses a pivot that is not a number
            regular &= self.parts[k].smallest_pivot > SMALLEST_PIVOT;
        }
        if regular { Factored::Regular } else { Factored::Singular }
    }

    fn factor_part(&mut self, k: usize) {
        self.factor_as_it_is(k);
        if self.equilibration.is_measured() {
            self.parts[k].smallest_pivot = borne_out(self.parts[k].smallest_pivot, self.judged_pivot(k));
        }
    }

    /// Returns the smallest pivot as nearness is judged: the factors of a scaled matrix are the scaled factors. If bodies turn about their
    /// centroids, which pivots do not represent, it is the smallest singular value.
    fn judged_pivot(&mut self, k: usize) -> f64 {
        let (work, part) = (&mut self.work, &self.parts[k]);
        let factors = factors!(self);
        if !self.equilibration.centroids(k).is_empty() {
            let (left, rest) = work.split_at_mut(self.rows.len());
            let (right, work) = rest.split_at_mut(self.rows.len());
            let vectors = [&mut left[..part.size], &mut right[..part.size]];
            return factors.nearness(k, part, vectors, work) * part.length_of_chain();
        }
        // NaN must win
        let smaller = |least: f64, pivot: f64| if pivot.abs() >= least { least } else { pivot.abs() };
        let judged = |row: usize, column: usize, pivot: f64| {
            pivot * factors.row_scale(part, row) * factors.column_scale(part, column)
        };
        match part.form {
            Form::Single => judged(0, 0, self.values[self.inside[part.inside.start] as usize]).abs(),
            Form::Planned(plan) => {
                let pivots = part.plans[plan].placed_pivots(&part.slots);
                pivots.map(|(row, column, pivot)| judged(row, column, pivot)).fold(f64::INFINITY, smaller)
            }
            Form::Dense => {
                let mut rows: [usize; LARGEST_BLOCK] = std::array::from_fn(|row| row);
                let mut least = f64::INFINITY;
                for (place, &other) in self.pivots[part.at..part.at + part.size].iter().enumerate() {
                    rows.swap(place, other as usize);
                    let pivot = self.dense[part.matrix + place * (part.size + 1)];
                    least = smaller(least, judged(rows[place], place, pivot));
                }
                least
            }
        }
    }

    fn factor_as_it_is(&mut self, k: usize) {
        if self.parts[k].form == Form::Single {
            let value = self.values[self.inside[self.parts[k].inside.start] as usize];
            self.parts[k].smallest_pivot = value.abs();
        } else if !self.factor_planned(k) {
            if self.parts[k].is_small() {
                self.factor_densely(k);
            } else {
                self.factor_in_another_order(k);
            }
        }
    }

    /// Factors by one of the existing orders, beginning with the one in use; returns whether one was good.
    fn factor_planned(&mut self, k: usize) -> bool {
        let part = &mut self.parts[k];
        let first = if let Form::Planned(plan) = part.form { plan } else { 0 };
        let inside = &self.inside[part.inside.clone()];
        for step in 0..part.plans.len() {
            let index = (first + step) % part.plans.len();
            let plan = &part.plans[index];
            plan.load(&mut part.slots, inside.iter().map(|&index| self.values[index as usize]));
            let (smallest, largest) = plan.factor(&mut part.slots);
            if largest <= LARGEST_MULTIPLIER {
                (part.form, part.smallest_pivot) = (Form::Planned(index), smallest);
                return true;
            }
        }
        false
    }

    fn factor_densely(&mut self, k: usize) {
        let part = &mut self.parts[k];
        let dense = &mut self.dense[part.matrix..part.matrix + part.size * part.size];
        dense.fill(0.0);
        for &index in &self.inside[part.inside.clone()] {
            if let Some((row, column)) = self.entries[index as usize].place {
                dense[row as usize * part.size + column as usize] = self.values[index as usize];
            }
        }
        part.smallest_pivot = factor_dense(dense, &mut self.pivots[part.at..part.at + part.size], part.size);
        part.form = Form::Dense;
    }

    /// Factors a large block in a new order where its present one has lost digits. Allocates.
    fn factor_in_another_order(&mut self, k: usize) {
        let plan = Plan::new(self.parts[k].size, &self.entries_of(&self.parts[k]));
        let part = &mut self.parts[k];
        part.slots = vec![0.0; plan.slots()];
        let inside = &self.inside[part.inside.clone()];
        plan.load(&mut part.slots, inside.iter().map(|&index| self.values[index as usize]));
        (part.smallest_pivot, _) = plan.factor(&mut part.slots);
        (part.plans, part.form) = (vec![plan], Form::Planned(0));
    }

    fn load_row(&mut self, k: usize, value: impl Fn(usize) -> f64) -> bool {
        let range = self.starts[k]..self.starts[k + 1];
        let mut square = 0.0;
        for index in range.clone() {
            let entry = self.entries[index];
            let scaled = value(entry.position as usize) * self.column_scale[entry.column as usize];
            self.values[index] = scaled;
            square += scaled * scaled;
        }
        let row = self.rows[k] as usize;
        let norm = f64::max(square.sqrt(), self.least_norm[row]);
        self.row_norm[row] = norm;
        if !(norm > 0.0 && norm.is_finite()) {
            return false;
        }
        let inverse = 1.0 / norm;
        for value in &mut self.values[range] {
            *value *= inverse;
        }
        true
    }
}
