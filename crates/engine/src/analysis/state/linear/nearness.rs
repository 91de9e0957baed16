//! Nearness of the blocks to a singular position, and the dependency there.

use super::factors::{Factors, normalize};
use super::{BlockLu, Part};

/// A block has no singular value below a limit if its smallest pivot is this many times the limit: pivots of rows of unit norm
/// overestimate it by little.
const PIVOT_MARGIN: f64 = 100.0;

/// A smallest singular value with its vectors.
pub struct Singular {
    pub sigma: f64,
    /// By rows of Φ.
    pub left: Vec<f64>,
    /// By coordinates, scaled.
    pub right: Vec<f64>,
}

impl BlockLu {
    /// Returns the nearness to a singular position: the smallest singular value of any block, as far as it is below `limit`.
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
            let vectors = [&mut left[..part.size], &mut right[..part.size]];
            nearest = nearest.min(factors.nearness(k, part, vectors, work) * part.length_of_chain());
        }
        nearest
    }

    /// Writes the weight of each row in the dependency of its block, for blocks that are nearer to a singular position than a limit, and 0
    /// for others. Returns whether there are such blocks.
    pub fn write_weights(&mut self, limit: f64, weights: &mut [f64]) -> bool {
        let (left, rest) = self.work.split_at_mut(self.rows.len());
        let (right, work) = rest.split_at_mut(self.rows.len());
        let factors = factors!(self);
        let mut is_any_near = false;
        for (k, part) in self.parts.iter().enumerate() {
            let (left, right) = (&mut left[..part.size], &mut right[..part.size]);
            let is_near = part.smallest_pivot < PIVOT_MARGIN * limit
                && factors.nearness(k, part, [&mut *left, &mut *right], work) * part.length_of_chain() < limit;
            is_any_near |= is_near;
            for (&row, weight) in self.rows[part.at..part.at + part.size].iter().zip(left.iter()) {
                weights[row as usize] = if is_near { *weight } else { 0.0 };
            }
        }
        is_any_near
    }

    /// Returns the smallest singular value of all blocks, with its vectors over the whole of the scaled `Φ_q`: the rows on which that
    /// block's rows depend, and the coordinates that move with its own. Allocates.
    pub fn worst(&mut self) -> Singular {
        let n = self.rows.len();
        let mut worst: Option<(usize, Singular)> = None;
        let mut work = vec![0.0; n];
        for (k, part) in self.parts.iter().enumerate() {
            let (mut left, mut right) = (vec![0.0; part.size], vec![0.0; part.size]);
            let sigma = self.factors().nearness(k, part, [&mut left, &mut right], &mut work);
            let found = Singular { sigma, left, right };
            if worst.as_ref().is_none_or(|(_, worst)| found.sigma < worst.sigma) {
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
        self.solve_transposed(|column, _| v[column], &mut left);
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

    /// Returns the vectors of a block's smallest singular value as right sides that its factors turn into dependency and motion. If the
    /// scales that are solved with are confirmed, they give the vectors: of several, those that weigh most in them.
    fn as_solved(&self, k: usize, mut judged: Singular) -> Singular {
        let (part, factors) = (&self.parts[k], self.factors());
        let (mut left, mut right) = (vec![0.0; part.size], vec![0.0; part.size]);
        let mut work = vec![0.0; self.rows.len()];
        let sigma = factors.as_solved().singular(k, part, [&mut left, &mut right], &mut work);
        if sigma.total_cmp(&judged.sigma).is_eq() {
            return Singular { sigma, left, right };
        }
        factors.judge_by_columns(k, part, &mut judged.right);
        factors.judge_by_rows(part, &mut judged.left);
        judged
    }
}
