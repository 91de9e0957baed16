//! The linear systems of one state: `Φ_q x = b`, block by block.
//!
//! Everything is scaled: lengths by the size of their body, rows to unit norm; what nearness to a singular position is judged
//! by are scales of their own (`yardstick`). Within a block the order of elimination is
//! fixed (`sparse`); where that loses digits a small block is factored densely with partial pivoting, and a large one gets
//! another order. Between blocks the solution is substituted forward, so that cost grows with the number of blocks.

use super::dense::{factor_dense, solve_dense, solve_dense_transposed};
use super::determinant::Determinant;
use super::sparse::Plan;
use super::yardstick::{Centroid, Yardstick};
use crate::expr::{Dependence, ExprId, Symbol};
use crate::ir::{ConstraintSystem, CoordinateKind};
use crate::math::GOLDEN;
use crate::solver::BlockEntry;
use crate::structure::Block;
use crate::tolerances::scales::linear::{A_FEW, ALIKE, LARGEST_DENSE, PIVOT_MARGIN, PLANS};
use crate::tolerances::solving::order::LEAST_PIVOT;
use crate::tolerances::solving::solver::LARGEST_MULTIPLIER;
use std::ops::Range;

/// The factors, beside which the workspace may be borrowed.
macro_rules! factors {
    ($lu:expr) => {
        Factors {
            values: &$lu.values,
            inside: &$lu.inside,
            dense: &$lu.dense,
            pivots: &$lu.pivots,
            rows: &$lu.rows,
            columns: &$lu.columns,
            row_norm: &$lu.row_norm,
            size: &$lu.column_scale,
            yardstick: &$lu.yardstick,
            is_judging: $lu.yardstick.is_measured(),
        }
    };
}

/// One irreducible block with its place in the common storage.
#[derive(Clone)]
struct Part {
    /// Offset of its rows and columns in the lists below.
    at: usize,
    size: usize,
    explicit: bool,
    /// Offset of its dense matrix, which a large block does not have.
    matrix: usize,
    /// Its entries in `inside`.
    inside: Range<usize>,
    /// Smallest pivot as nearness is judged.
    smallest_pivot: f64,
    /// Orders of elimination.
    plans: Vec<Plan>,
    /// The values of the order that is in use.
    slots: Vec<f64>,
    form: Form,
}

/// How a block is factored.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Form {
    /// One equation.
    Single,
    /// By one of its orders.
    Planned(usize),
    Dense,
}

impl Part {
    /// How much smaller the singular values of a chain of so many coordinates are than those of a few bodies.
    fn length_of_chain(&self) -> f64 {
        let length = self.size as f64 / A_FEW;
        f64::max(length * length, 1.0)
    }

    fn is_small(&self) -> bool {
        self.size <= LARGEST_DENSE
    }
}

/// An entry of `Φ_q`: its position in the pattern, and where it goes.
#[derive(Clone, Copy)]
struct Entry {
    position: u32,
    column: u32,
    /// Row and column within its block; none if it is outside.
    place: Option<(u32, u32)>,
}

/// The factors of `Φ_q`, and the workspace to compute and use them.
#[derive(Clone)]
pub struct BlockLu {
    parts: Vec<Part>,
    /// Rows of Φ in block order.
    rows: Vec<u32>,
    /// Coordinates in block order.
    columns: Vec<u32>,
    /// Entries by row in block order: `starts[k]..starts[k + 1]`.
    starts: Vec<usize>,
    entries: Vec<Entry>,
    /// Scale of each coordinate: the size of its body, or 1 rad.
    column_scale: Vec<f64>,
    /// Coordinates that a step is judged by, and those of them that need iteration.
    judged: Vec<u32>,
    judged_implicit: Vec<u32>,
    /// What each scaled row is divided by: its norm, or the least norm where that is larger.
    row_norm: Vec<f64>,
    /// By row; 0 where the norm itself is meant.
    least_norm: Vec<f64>,
    /// Scaled values of the entries.
    values: Vec<f64>,
    /// Indices of the entries within their blocks, block by block.
    inside: Vec<u32>,
    dense: Vec<f64>,
    pivots: Vec<u32>,
    work: Vec<f64>,
    /// What nearness to a singular position is judged by.
    yardstick: Yardstick,
}

/// What a factorisation shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Factored {
    Regular,
    /// A pivot or a whole row vanishes.
    Singular,
}

impl BlockLu {
    pub fn new(system: &ConstraintSystem, blocks: &[Block]) -> BlockLu {
        let n = system.coordinates.len();
        let mut place_of_column = vec![0_u32; n];
        let mut part_of_column = vec![0_u32; n];
        let (mut parts, mut rows, mut columns) = (Vec::new(), Vec::new(), Vec::new());
        let mut matrix = 0;
        for (k, block) in blocks.iter().enumerate() {
            let size = block.rows.len();
            let form = if size == 1 { Form::Single } else { Form::Dense };
            let (plans, slots) = (Vec::new(), Vec::new());
            parts.push(Part {
                at: rows.len(),
                size,
                explicit: block.explicit,
                matrix,
                inside: 0..0,
                smallest_pivot: 0.0,
                plans,
                slots,
                form,
            });
            for (place, &column) in block.columns.iter().enumerate() {
                place_of_column[column as usize] = place as u32;
                part_of_column[column as usize] = k as u32;
            }
            rows.extend_from_slice(&block.rows);
            columns.extend_from_slice(&block.columns);
            matrix += if size <= LARGEST_DENSE { size * size } else { 0 };
        }
        let (mut starts, mut entries, mut inside_blocks) = (vec![0], Vec::new(), Vec::new());
        for (k, part) in parts.iter_mut().enumerate() {
            part.inside.start = inside_blocks.len();
            for place in 0..part.size {
                let row = rows[part.at + place] as usize;
                for (position, &(column, _)) in system.phi_q.range(row).zip(system.phi_q.row(row)) {
                    let is_inside = part_of_column[column as usize] == k as u32;
                    if is_inside {
                        inside_blocks.push(entries.len() as u32);
                    }
                    let place = is_inside.then_some((place as u32, place_of_column[column as usize]));
                    entries.push(Entry { position: position as u32, column, place });
                }
                starts.push(entries.len());
            }
            part.inside.end = inside_blocks.len();
        }
        let column_scale = system.coordinates.iter().map(|coordinate| coordinate.scale).collect();
        let judged = judged_coordinates(system);
        let is_implicit = |column: &u32| !parts[part_of_column[*column as usize] as usize].explicit;
        let judged_implicit = judged.iter().copied().filter(is_implicit).collect();
        BlockLu {
            parts,
            rows,
            columns,
            starts,
            values: vec![0.0; entries.len()],
            inside: inside_blocks,
            entries,
            column_scale,
            judged,
            judged_implicit,
            row_norm: vec![1.0; n],
            least_norm: vec![0.0; n],
            dense: vec![0.0; matrix],
            pivots: vec![0; n],
            work: vec![0.0; 3 * n],
            yardstick: Yardstick::new(system, blocks),
        }
    }

    /// What nearness to a singular position is judged by.
    pub fn yardstick(&mut self) -> &mut Yardstick {
        &mut self.yardstick
    }

    pub fn column_scale(&self, column: usize) -> f64 {
        self.column_scale[column]
    }

    /// From now on a row is divided by no less than this: a formula whose slope vanishes is to be seen.
    pub fn set_least_norm(&mut self, row: usize, norm: f64) {
        self.least_norm[row] = norm;
    }

    /// What was set so; 0 where nothing was.
    pub fn least_norm(&self, row: usize) -> f64 {
        self.least_norm[row]
    }

    /// A row whose slope, scaled, was less than this where `Φ_q` was factored.
    pub fn row_without_slope(&self, least: f64) -> Option<usize> {
        let slope =
            |k: usize| self.values[self.starts[k]..self.starts[k + 1]].iter().map(|x| x * x).sum::<f64>().sqrt();
        (0..self.rows.len()).find(|&k| slope(k) < least).map(|k| self.rows[k] as usize)
    }

    /// What a row of the scaled `Φ_q` is divided by, mostly its norm.
    pub fn row_norm(&self, row: usize) -> f64 {
        self.row_norm[row]
    }

    /// Writes each block's determinant.
    pub fn determinants(&self, determinants: &mut [Determinant]) {
        for (block, determinant) in determinants.iter_mut().enumerate() {
            *determinant = self.determinant(block);
        }
    }

    /// The determinant of a block. The matching fixes the order of columns, so that a sign means the same at every state.
    pub fn determinant(&self, block: usize) -> Determinant {
        let part = &self.parts[block];
        let mut determinant = Determinant::ONE;
        match part.form {
            Form::Single => determinant.multiply(self.values[self.inside[part.inside.start] as usize]),
            Form::Planned(plan) => {
                part.plans[plan].signed_pivots(&part.slots).for_each(|pivot| determinant.multiply(pivot));
            }
            Form::Dense => {
                for (k, &swapped) in self.pivots[part.at..part.at + part.size].iter().enumerate() {
                    let pivot = self.dense[part.matrix + k * (part.size + 1)];
                    determinant.multiply(if swapped as usize == k { pivot } else { -pivot });
                }
            }
        }
        determinant
    }

    /// The smallest pivot of all blocks: little more than the nearness to a singular position, and for nothing.
    pub fn smallest_pivot(&self) -> f64 {
        self.parts.iter().map(|part| part.smallest_pivot).fold(1.0, f64::min)
    }

    /// The block with the smallest pivot.
    pub fn worst_block(&self) -> Option<usize> {
        let pivot = |k: usize| self.parts[k].smallest_pivot;
        (0..self.parts.len()).min_by(|&a, &b| pivot(a).total_cmp(&pivot(b)))
    }

    /// Whether all coordinates follow without iteration.
    pub fn is_explicit(&self) -> bool {
        self.parts.iter().all(|part| part.explicit)
    }

    pub fn blocks(&self) -> usize {
        self.parts.len()
    }

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

    /// A block's entries where it was loaded.
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
            regular &= self.parts[k].smallest_pivot > 1e-14;
        }
        if regular { Factored::Regular } else { Factored::Singular }
    }

    fn factor_part(&mut self, k: usize) {
        self.factor_as_it_is(k);
        if self.yardstick.is_measured() {
            self.parts[k].smallest_pivot = borne_out(self.parts[k].smallest_pivot, self.judged_pivot(k));
        }
    }

    /// The smallest pivot as nearness is judged: the factors of a scaled matrix are the scaled factors. Where bodies are taken by
    /// their centroids, which pivots know nothing of, it is the smallest singular value.
    fn judged_pivot(&mut self, k: usize) -> f64 {
        let (work, part) = (&mut self.work, &self.parts[k]);
        let factors = factors!(self);
        if !self.yardstick.centroids(k).is_empty() {
            let (left, rest) = work.split_at_mut(self.rows.len());
            let (right, work) = rest.split_at_mut(self.rows.len());
            let vectors = (&mut left[..part.size], &mut right[..part.size]);
            return factors.nearness(k, part, vectors, work) * part.length_of_chain();
        }
        // what is not a number must win
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
                let mut rows: [usize; LARGEST_DENSE] = std::array::from_fn(|row| row);
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

    /// Factors by one of the orders there are, the one in use first; whether one was good.
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

    /// A large block whose order has lost digits. Allocates.
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

    /// Solves `Φ_q x = b`, `b` by rows of Φ and `x` by coordinates, both unscaled; returns the largest scaled `|x|`.
    pub fn solve(&mut self, right: impl Fn(usize) -> f64, x: &mut [f64]) -> f64 {
        self.solve_parts(right, x, |_| true)
    }

    /// As [`BlockLu::solve`] for the explicit blocks, all other coordinates being kept.
    pub fn solve_explicit(&mut self, right: impl Fn(usize) -> f64, x: &mut [f64]) -> f64 {
        self.solve_parts(right, x, |part| part.explicit)
    }

    /// The largest scaled `|x|` of all coordinates.
    pub fn largest(&self, x: &[f64]) -> f64 {
        x.iter().zip(&self.column_scale).map(|(x, scale)| x.abs() / scale).fold(0.0, f64::max)
    }

    /// The largest scaled `|x|` of the coordinates that a step is judged by.
    pub fn largest_judged(&self, x: &[f64]) -> f64 {
        self.largest_of(&self.judged, x)
    }

    /// As [`BlockLu::largest_judged`] without those that follow without iteration: they have no branches.
    pub fn largest_judged_implicit(&self, x: &[f64]) -> f64 {
        self.largest_of(&self.judged_implicit, x)
    }

    /// The largest scaled `|x|` of some coordinates; not a number if one is not.
    fn largest_of(&self, columns: &[u32], x: &[f64]) -> f64 {
        let scaled = columns.iter().map(|&column| x[column as usize].abs() / self.column_scale[column as usize]);
        scaled.fold(0.0, |largest, size| if size <= largest { largest } else { size })
    }

    /// The largest scaled `|x|` of the coordinates that need iteration.
    pub fn largest_implicit(&self, x: &[f64]) -> f64 {
        let implicit = self.parts.iter().filter(|part| !part.explicit);
        let columns = implicit.flat_map(|part| &self.columns[part.at..part.at + part.size]);
        columns.map(|&column| x[column as usize].abs() / self.column_scale[column as usize]).fold(0.0, f64::max)
    }

    fn solve_parts(&mut self, right: impl Fn(usize) -> f64, x: &mut [f64], wanted: impl Fn(&Part) -> bool) -> f64 {
        let mut largest: f64 = 0.0;
        let n = self.rows.len();
        let (scaled, rest) = self.work.split_at_mut(n);
        let (block, work) = rest.split_at_mut(n);
        let factors = factors!(self);
        for part in &self.parts {
            if !wanted(part) {
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
                // a value that is not a number must win
                largest = if value.abs() > largest || value.is_nan() { value.abs() } else { largest };
            }
        }
        largest
    }

    /// Solves the transposed scaled system: `b` by coordinates, `w` by rows.
    fn solve_transposed(&self, b: &[f64], w: &mut [f64]) {
        let n = self.rows.len();
        let (mut rest, mut work) = (b.to_vec(), vec![0.0; n]);
        for part in self.parts.iter().rev() {
            let mut block: Vec<f64> =
                (0..part.size).map(|place| rest[self.columns[part.at + place] as usize]).collect();
            self.factors().solve_transposed(part, &mut block, &mut work);
            for (place, &value) in block.iter().enumerate() {
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

    /// The nearness to a singular position: the smallest singular value of any block, as far as it is below `limit`.
    ///
    /// Taken by blocks, because a long chain of blocks is badly conditioned without being near to anything; and so is a long
    /// chain within a block, whose singular values fall with the square of its length. A block whose pivots are all well
    /// above the limit is not looked at.
    pub fn nearness(&mut self, limit: f64) -> f64 {
        let mut nearest = f64::INFINITY;
        let (left, rest) = self.work.split_at_mut(self.rows.len());
        let (right, work) = rest.split_at_mut(self.rows.len());
        let factors = factors!(self);
        let is_near = |part: &Part| part.smallest_pivot < PIVOT_MARGIN * limit;
        for (k, part) in self.parts.iter().enumerate().filter(|(_, part)| is_near(part)) {
            let vectors = (&mut left[..part.size], &mut right[..part.size]);
            nearest = nearest.min(factors.nearness(k, part, vectors, work) * part.length_of_chain());
        }
        nearest
    }

    /// Writes by row how it weighs in the dependency of its block, of those blocks that are nearer to a singular position than a
    /// limit; 0 in all others. Says whether there are such blocks.
    pub fn write_weights(&mut self, limit: f64, weights: &mut [f64]) -> bool {
        let (left, rest) = self.work.split_at_mut(self.rows.len());
        let (right, work) = rest.split_at_mut(self.rows.len());
        let factors = factors!(self);
        let mut is_any_near = false;
        for (k, part) in self.parts.iter().enumerate() {
            let (left, right) = (&mut left[..part.size], &mut right[..part.size]);
            let is_near = part.smallest_pivot < PIVOT_MARGIN * limit
                && factors.nearness(k, part, (left, right), work) * part.length_of_chain() < limit;
            is_any_near |= is_near;
            for (&row, weight) in self.rows[part.at..part.at + part.size].iter().zip(left.iter()) {
                weights[row as usize] = if is_near { *weight } else { 0.0 };
            }
        }
        is_any_near
    }

    /// The smallest singular value of all blocks, with its vectors over the whole of the scaled `Φ_q`: the rows on which
    /// that block's rows depend, and the coordinates that move with its own. Allocates.
    pub fn worst(&mut self) -> Singular {
        let n = self.rows.len();
        let mut worst: Option<(usize, Singular)> = None;
        let mut work = vec![0.0; n];
        for (k, part) in self.parts.iter().enumerate() {
            let (mut left, mut right) = (vec![0.0; part.size], vec![0.0; part.size]);
            let sigma = self.factors().nearness(k, part, (&mut left, &mut right), &mut work);
            let found = Singular { sigma, left, right };
            if worst.as_ref().is_none_or(|(_, known)| found.sigma < known.sigma) {
                worst = Some((k, found));
            }
        }
        let Some((k, block)) = worst else {
            return Singular { sigma: 1.0, left: Vec::new(), right: Vec::new() };
        };
        let block = self.as_solved(k, block);
        let (at, size) = (self.parts[k].at, self.parts[k].size);
        let (mut left, mut right) = (vec![0.0; n], vec![0.0; n]);
        for place in 0..size {
            left[self.rows[at + place] as usize] = block.left[place];
            right[self.columns[at + place] as usize] = block.right[place];
        }
        let (u, v) = (left.clone(), right.clone());
        self.solve_transposed(&v, &mut left);
        let norms = self.row_norm.clone();
        let mut x = vec![0.0; n];
        self.solve(|row| u[row] * norms[row], &mut x);
        for (column, value) in x.iter().enumerate() {
            right[column] = value / self.column_scale[column];
        }
        normalize(&mut left);
        normalize(&mut right);
        Singular { sigma: block.sigma, left, right }
    }
}

impl BlockLu {
    /// The vectors of a block's smallest singular value as right sides that its factors turn into dependency and motion. Where
    /// the scales that are solved with are borne out they give the vectors: of several, these are told that weigh most in them.
    fn as_solved(&self, k: usize, mut judged: Singular) -> Singular {
        let (part, factors) = (&self.parts[k], self.factors());
        let (mut left, mut right) = (vec![0.0; part.size], vec![0.0; part.size]);
        let mut work = vec![0.0; self.rows.len()];
        let sigma = factors.as_solved().singular(k, part, (&mut left, &mut right), &mut work);
        if sigma.total_cmp(&judged.sigma).is_eq() {
            return Singular { sigma, left, right };
        }
        factors.judge_by_columns(k, part, &mut judged.right);
        factors.judge_by_rows(part, &mut judged.left);
        judged
    }

    fn factors(&self) -> Factors<'_> {
        factors!(self)
    }
}

/// The coordinates that a step is judged by: those that `Φ_q` depends on, those that an equation of time speaks of, and all
/// angles. The places that are left follow from these, however far they go.
fn judged_coordinates(system: &ConstraintSystem) -> Vec<u32> {
    let slopes: Vec<ExprId> = system.phi_q.entries().iter().map(|&(_, slope)| slope).collect();
    let mut is_judged: Vec<bool> = system.coordinates.iter().map(|c| c.kind != CoordinateKind::Length).collect();
    for symbol in system.graph.symbols_of_all(&slopes) {
        if let Symbol::Coordinate { index, .. } = symbol {
            is_judged[index as usize] = true;
        }
    }
    for (k, row) in system.rows.iter().enumerate() {
        if system.graph.dependence(row.phi).on(Dependence::TIME) {
            system.phi_q.row(k).iter().for_each(|&(column, _)| is_judged[column as usize] = true);
        }
    }
    (0..is_judged.len() as u32).filter(|&column| is_judged[column as usize]).collect()
}

/// The factors of all blocks.
#[derive(Clone, Copy)]
struct Factors<'l> {
    values: &'l [f64],
    inside: &'l [u32],
    dense: &'l [f64],
    pivots: &'l [u32],
    rows: &'l [u32],
    columns: &'l [u32],
    row_norm: &'l [f64],
    size: &'l [f64],
    yardstick: &'l Yardstick,
    /// Whether nearness is measured by the yardstick, or by the scales that are solved with.
    is_judging: bool,
}

impl Factors<'_> {
    /// What an entry of the scaled `Φ_q` is multiplied by for its row as nearness is judged; a row by its place in the block.
    fn row_scale(&self, part: &Part, place: usize) -> f64 {
        let row = self.rows[part.at + place] as usize;
        if self.is_judging { self.row_norm[row] / self.yardstick.row(row) } else { 1.0 }
    }

    /// As [`Factors::row_scale`] for its column.
    fn column_scale(&self, part: &Part, place: usize) -> f64 {
        let column = self.columns[part.at + place] as usize;
        if self.is_judging { self.yardstick.column(column) / self.size[column] } else { 1.0 }
    }

    /// With A the scaled block and P A K that by which nearness is judged: multiplies by P⁻¹.
    fn judge_by_rows(&self, part: &Part, b: &mut [f64]) {
        for (place, b) in b.iter_mut().enumerate() {
            *b /= self.row_scale(part, place);
        }
    }

    /// Multiplies by K⁻ᵀ: what belongs to a body's turn about its centroid goes to that about its origin.
    fn judge_by_columns(&self, k: usize, part: &Part, b: &mut [f64]) {
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
    fn judge_motion(&self, k: usize, part: &Part, x: &mut [f64]) {
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

    fn centroids(&self, k: usize) -> &[Centroid] {
        if self.is_judging { self.yardstick.centroids(k) } else { &[] }
    }

    /// Solves within a block: `b` by its rows becomes the solution by its columns.
    fn solve(self, part: &Part, b: &mut [f64], work: &mut [f64]) {
        match part.form {
            Form::Single => b[0] /= self.single(part),
            Form::Planned(plan) => part.plans[plan].solve(&part.slots, b, work),
            Form::Dense => solve_dense(self.matrix(part), &self.pivots[part.at..part.at + part.size], b),
        }
    }

    fn solve_transposed(self, part: &Part, b: &mut [f64], work: &mut [f64]) {
        match part.form {
            Form::Single => b[0] /= self.single(part),
            Form::Planned(plan) => part.plans[plan].solve_transposed(&part.slots, b, work),
            Form::Dense => solve_dense_transposed(self.matrix(part), &self.pivots[part.at..part.at + part.size], b),
        }
    }

    /// The entry of a block of one equation, which stands for one that vanishes too.
    fn single(&self, part: &Part) -> f64 {
        let value = self.values[self.inside[part.inside.start] as usize];
        if value.abs() < LEAST_PIVOT { LEAST_PIVOT.copysign(value) } else { value }
    }

    fn matrix(&self, part: &Part) -> &[f64] {
        &self.dense[part.matrix..part.matrix + part.size * part.size]
    }

    /// As the scales that are solved with have it.
    fn as_solved(self) -> Self {
        Factors { is_judging: false, ..self }
    }

    /// How near a block is to a singular position, with the vectors of its smallest singular value by the yardstick.
    fn nearness(self, k: usize, part: &Part, (left, right): (&mut [f64], &mut [f64]), work: &mut [f64]) -> f64 {
        let sigma = self.as_solved().singular(k, part, (left, right), work);
        if self.is_judging { borne_out(sigma, self.singular(k, part, (left, right), work)) } else { sigma }
    }

    /// The smallest singular value of a block as nearness is judged, with its left and right vectors, by inverse iteration.
    fn singular(self, k: usize, part: &Part, (left, right): (&mut [f64], &mut [f64]), work: &mut [f64]) -> f64 {
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

/// A smallest singular value with its vectors.
pub struct Singular {
    pub sigma: f64,
    /// By rows of Φ.
    pub left: Vec<f64>,
    /// By coordinates, scaled.
    pub right: Vec<f64>,
}

/// What the scales that are solved with say of nearness, if the yardstick bears it out, or else what that says: they serve where
/// bodies are of a size, and frames near them.
fn borne_out(solved: f64, judged: f64) -> f64 {
    let is_borne_out = solved <= ALIKE * judged && judged <= ALIKE * solved;
    if is_borne_out { solved } else { judged }
}

fn normalize(v: &mut [f64]) -> f64 {
    let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    if norm > 0.0 && norm.is_finite() {
        for x in v {
            *x /= norm;
        }
    }
    norm
}
