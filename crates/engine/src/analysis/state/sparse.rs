//! LU of a block in an order that is fixed once: which entries arise, and which operations make them, is decided before any value is computed. The
//! pivots are chosen for few entries and for size (H. M. Markowitz, 1957); every factorisation checks that they still are large enough.

use crate::limits::solver::LEAST_PIVOT;
use crate::solver::{BlockEntry, Order};
use rustc_hash::FxHashMap;

/// An order of elimination with its operations. Positions count pivots in their order.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Row and column of each pivot.
    rows: Vec<u32>,
    columns: Vec<u32>,
    /// True if the permutation from rows to columns is odd.
    is_odd: bool,
    slots: usize,
    /// Slot of each entry of the block, in the order of `entries`.
    scatter: Vec<u32>,
    /// By position: slots of the multipliers.
    multipliers: Vec<u32>,
    multiplier_starts: Vec<u32>,
    /// For each multiplier and each entry right of its pivot: the slot that changes.
    updates: Vec<u32>,
    /// For each multiplier: positions of its row and of its pivot, and its slot.
    lower: Vec<[u32; 3]>,
    /// By position: slot and position of the entries right of the pivot.
    upper: Vec<[u32; 2]>,
    upper_starts: Vec<u32>,
    /// Slots of the pivots.
    pivots: Vec<u32>,
}

impl Plan {
    /// Chooses an order for a block of size `n` with these values, whose pattern must not be singular.
    pub fn new(n: usize, entries: &[BlockEntry]) -> Plan {
        let order = Order::new(n, entries);
        let (mut row_position, mut column_position) = (vec![0_u32; n], vec![0_u32; n]);
        for (k, &(row, column)) in order.pivots.iter().enumerate() {
            (row_position[row as usize], column_position[column as usize]) = (k as u32, k as u32);
        }
        let mut slot_of: FxHashMap<(u32, u32), u32> = FxHashMap::default();
        let mut slot = |row: u32, column: u32| {
            let next = slot_of.len() as u32;
            *slot_of.entry((row, column)).or_insert(next)
        };
        let mut plan = Plan {
            rows: order.pivots.iter().map(|&(row, _)| row).collect(),
            columns: order.pivots.iter().map(|&(_, column)| column).collect(),
            is_odd: false,
            slots: 0,
            scatter: Vec::new(),
            multipliers: Vec::new(),
            multiplier_starts: vec![0],
            updates: Vec::new(),
            lower: Vec::new(),
            upper: Vec::new(),
            upper_starts: vec![0],
            pivots: Vec::new(),
        };
        plan.is_odd = is_odd(&plan.rows) != is_odd(&plan.columns);
        for (k, &(row, column)) in order.pivots.iter().enumerate() {
            plan.pivots.push(slot(row, column));
            for &right in &order.right[k] {
                plan.upper.push([slot(row, right), column_position[right as usize]]);
            }
            plan.upper_starts.push(plan.upper.len() as u32);
            for &below in &order.below[k] {
                let multiplier = slot(below, column);
                plan.multipliers.push(multiplier);
                plan.lower.push([row_position[below as usize], k as u32, multiplier]);
                plan.updates.extend(order.right[k].iter().map(|&right| slot(below, right)));
            }
            plan.multiplier_starts.push(plan.multipliers.len() as u32);
        }
        plan.scatter = entries.iter().map(|entry| slot(entry.row, entry.column)).collect();
        plan.slots = slot_of.len();
        plan
    }

    /// Returns the number of slots that the values need.
    pub fn slots(&self) -> usize {
        self.slots
    }

    /// Puts the values of the entries, in the order in which they were given, to their slots.
    pub fn load(&self, values: &mut [f64], entries: impl Iterator<Item = f64>) {
        values[..self.slots].fill(0.0);
        for (&slot, value) in self.scatter.iter().zip(entries) {
            values[slot as usize] = value;
        }
    }

    /// Factors; returns the smallest pivot and the largest multiplier.
    pub fn factor(&self, values: &mut [f64]) -> (f64, f64) {
        let v = &mut values[..self.slots];
        let (mut smallest, mut largest) = (f64::INFINITY, 0.0);
        let mut updates = self.updates.iter();
        for (k, &at) in self.pivots.iter().enumerate() {
            let pivot = v[at as usize];
            // NaN must win
            smallest = if pivot.abs() >= smallest { smallest } else { pivot.abs() };
            if pivot.abs() < LEAST_PIVOT {
                v[at as usize] = LEAST_PIVOT.copysign(pivot);
            }
            let inverse = 1.0 / v[at as usize];
            let right = self.upper_of(k);
            let range = self.multiplier_starts[k] as usize..self.multiplier_starts[k + 1] as usize;
            for &slot in &self.multipliers[range] {
                let multiplier = v[slot as usize] * inverse;
                v[slot as usize] = multiplier;
                largest = if multiplier.abs() <= largest { largest } else { multiplier.abs() };
                for (&[from, _], &to) in right.iter().zip(&mut updates) {
                    v[to as usize] -= multiplier * v[from as usize];
                }
            }
        }
        (smallest, largest)
    }

    /// Returns the pivots, the first negated if the permutation is odd: their product is the determinant.
    pub fn signed_pivots<'v>(&'v self, values: &'v [f64]) -> impl Iterator<Item = f64> + 'v {
        let sign = |k: usize| if k == 0 && self.is_odd { -1.0 } else { 1.0 };
        self.pivots.iter().enumerate().map(move |(k, &slot)| sign(k) * values[slot as usize])
    }

    /// Returns the pivots, each with its row and column.
    pub fn placed_pivots<'v>(&'v self, values: &'v [f64]) -> impl Iterator<Item = (usize, usize, f64)> + 'v {
        let places = self.rows.iter().zip(&self.columns);
        self.pivots
            .iter()
            .zip(places)
            .map(|(&slot, (&row, &column))| (row as usize, column as usize, values[slot as usize]))
    }

    /// Solves for the right side `b`, by rows, which becomes the solution, by columns.
    pub fn solve(&self, values: &[f64], b: &mut [f64], work: &mut [f64]) {
        for (x, &row) in work.iter_mut().zip(&self.rows) {
            *x = b[row as usize];
        }
        for &[row, pivot, slot] in &self.lower {
            work[row as usize] -= values[slot as usize] * work[pivot as usize];
        }
        for k in (0..self.pivots.len()).rev() {
            let mut sum = work[k];
            for &[slot, position] in self.upper_of(k) {
                sum -= values[slot as usize] * work[position as usize];
            }
            work[k] = sum / values[self.pivots[k] as usize];
        }
        for (x, &column) in work.iter().zip(&self.columns) {
            b[column as usize] = *x;
        }
    }

    /// Solves like [`Plan::solve`], for the transposed block: `b` by columns becomes the solution by rows.
    pub fn solve_transposed(&self, values: &[f64], b: &mut [f64], work: &mut [f64]) {
        for (x, &column) in work.iter_mut().zip(&self.columns) {
            *x = b[column as usize];
        }
        for k in 0..self.pivots.len() {
            let x = work[k] / values[self.pivots[k] as usize];
            work[k] = x;
            for &[slot, position] in self.upper_of(k) {
                work[position as usize] -= values[slot as usize] * x;
            }
        }
        for &[row, pivot, slot] in self.lower.iter().rev() {
            work[pivot as usize] -= values[slot as usize] * work[row as usize];
        }
        for (x, &row) in work.iter().zip(&self.rows) {
            b[row as usize] = *x;
        }
    }

    fn upper_of(&self, k: usize) -> &[[u32; 2]] {
        &self.upper[self.upper_starts[k] as usize..self.upper_starts[k + 1] as usize]
    }
}

/// Returns whether a permutation is odd: if it has an odd number of cycles of even length.
fn is_odd(permutation: &[u32]) -> bool {
    let mut visited = vec![false; permutation.len()];
    let mut odd = false;
    for start in 0..permutation.len() {
        let (mut k, mut length) = (start, 0);
        while !visited[k] {
            visited[k] = true;
            length += 1;
            k = permutation[k] as usize;
        }
        odd ^= length > 0 && length % 2 == 0;
    }
    odd
}

#[cfg(test)]
mod tests {
    use super::Plan;
    use crate::limits::solver::LARGEST_MULTIPLIER;
    use crate::solver::BlockEntry;
    use nalgebra::{DMatrix, DVector};

    /// Reproducible numbers in [−1, 1].
    fn noise(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    #[test]
    fn factors_solve_and_have_the_determinant_of_a_dense_lu() {
        let mut seed = 1;
        for n in 1..30_usize {
            let mut dense = DMatrix::<f64>::zeros(n, n);
            let mut entries = Vec::new();
            for row in 0..n {
                for column in 0..n {
                    // a band, some entries elsewhere, and a diagonal that leaves it regular
                    if row.abs_diff(column) <= 1 || noise(&mut seed) > 0.8 {
                        let value = noise(&mut seed) + if row == (column + 1) % n { 2.0 } else { 0.0 };
                        dense[(row, column)] = value;
                        entries.push(BlockEntry { row: row as u32, column: column as u32, value, is_number: false });
                    }
                }
            }
            let plan = Plan::new(n, &entries);
            let mut values = vec![0.0; plan.slots()];
            plan.load(&mut values, entries.iter().map(|entry| entry.value));
            let (smallest, largest) = plan.factor(&mut values);
            assert!(smallest > 0.0 && largest <= LARGEST_MULTIPLIER);
            let determinant: f64 = plan.signed_pivots(&values).product();
            assert!((determinant / dense.determinant() - 1.0).abs() < 1e-9, "n = {n}");
            let b: Vec<f64> = (0..n).map(|_| noise(&mut seed)).collect();
            let (mut x, mut w, mut work) = (b.clone(), b.clone(), vec![0.0; n]);
            plan.solve(&values, &mut x, &mut work);
            plan.solve_transposed(&values, &mut w, &mut work);
            let (x, w, b) = (DVector::from_vec(x), DVector::from_vec(w), DVector::from_vec(b));
            assert!((&dense * x - &b).norm() < 1e-9 && (dense.transpose() * w - &b).norm() < 1e-9, "n = {n}");
        }
    }
}
