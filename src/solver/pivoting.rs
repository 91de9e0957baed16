//! Solving where the order of elimination that was laid out loses digits: all coordinates at once, block by block, with partial
//! pivoting.

use super::build::cell;
use super::lanes::on_grid;
use crate::math::blocks::{Blocks, solve, work_of};
use crate::structure::Determined;
use crate::tolerances::solving::build::CELL;
use crate::tolerances::solving::lanes::{HALF_A_CELL, ITERATIONS};
use crate::tolerances::solving::pivoting::LARGEST_BLOCK;

/// The blocks of a system, ready to be solved with partial pivoting. Iterates lie on a grid as those of the
/// [`Solver`](super::Solver) do, but of all coordinates.
#[derive(Clone, Debug)]
pub struct Pivoting {
    tables: BlockTables,
    work: Vec<f64>,
    is_negative: Vec<bool>,
    right: Vec<f64>,
    slopes: Vec<f64>,
    delta: Vec<f64>,
}

/// The lists that [`Blocks`] borrows.
#[derive(Clone, Debug)]
#[allow(missing_docs)] // they are those of `Blocks`
pub struct BlockTables {
    pub sizes: Vec<usize>,
    pub rows: Vec<usize>,
    pub columns: Vec<usize>,
    pub starts: Vec<usize>,
    pub entries: Vec<usize>,
    pub places: Vec<usize>,
    pub units: Vec<f64>,
    /// By coordinate: the width of a cell of its grid.
    pub cells: Vec<f64>,
}

impl BlockTables {
    /// Those of a system; none if a block is too large.
    #[must_use]
    pub fn new(determined: &Determined) -> Option<BlockTables> {
        let (system, blocks) = (determined.system(), determined.blocks());
        if blocks.iter().any(|block| block.rows.len() > LARGEST_BLOCK) {
            return None;
        }
        let columns: Vec<usize> = blocks.iter().flat_map(|block| &block.columns).map(|&c| c as usize).collect();
        let mut places = vec![0; columns.len()];
        for (place, &column) in columns.iter().enumerate() {
            places[column] = place;
        }
        let rows = 0..system.rows.len();
        let starts = rows.clone().map(|row| system.phi_q.range(row).start).chain([system.phi_q.entries().len()]);
        let cells = system.coordinates.iter().map(|coordinate| cell(coordinate.scale));
        Some(BlockTables {
            sizes: blocks.iter().map(|block| block.rows.len()).collect(),
            rows: blocks.iter().flat_map(|block| &block.rows).map(|&row| row as usize).collect(),
            starts: starts.collect(),
            entries: system.phi_q.entries().iter().map(|&(column, _)| column as usize).collect(),
            units: cells.clone().map(|cell| cell / CELL).collect(),
            cells: cells.collect(),
            columns,
            places,
        })
    }

    /// The size of the largest block.
    #[must_use]
    pub fn largest(&self) -> usize {
        self.sizes.iter().copied().max().unwrap_or(0)
    }

    /// What is borrowed for [`solve`].
    #[must_use]
    pub fn blocks(&self) -> Blocks<'_> {
        Blocks {
            sizes: &self.sizes,
            rows: &self.rows,
            columns: &self.columns,
            starts: &self.starts,
            entries: &self.entries,
            places: &self.places,
            units: &self.units,
        }
    }
}

/// What equations say at a position.
pub trait Equations {
    /// Evaluates `Φ` and `Φ_q` at a position [m, rad]; false where a formula has no value.
    fn set_position(&mut self, q: &[f64]) -> bool;
    /// An entry of `Φ`.
    fn phi(&self, row: usize) -> f64;
    /// An entry of `Φ_q`, by its position in the pattern.
    fn slope(&self, position: usize) -> f64;
}

impl Pivoting {
    /// For a system; none if a block is too large.
    #[must_use]
    pub fn new(determined: &Determined) -> Option<Pivoting> {
        let tables = BlockTables::new(determined)?;
        let n = tables.rows.len();
        Some(Pivoting {
            work: vec![0.0; work_of(tables.largest())],
            is_negative: vec![false; tables.sizes.len()],
            right: vec![0.0; n],
            slopes: vec![0.0; tables.entries.len()],
            delta: vec![0.0; n],
            tables,
        })
    }

    /// Newton from grid point to grid point; the position (m, rad) is set when it has settled. Says whether it has.
    pub fn position(&mut self, equations: &mut impl Equations, q: &mut [f64]) -> bool {
        for _ in 0..ITERATIONS {
            for (q, &cell) in q.iter_mut().zip(&self.tables.cells) {
                *q = on_grid(*q, cell);
            }
            if !equations.set_position(q) {
                return false;
            }
            self.load(equations);
            let mut delta = std::mem::take(&mut self.delta);
            self.solve(|row| -equations.phi(row), &mut delta);
            let steps = || delta.iter().zip(&self.tables.cells);
            let is_settled = steps().all(|(delta, cell)| delta.abs() <= HALF_A_CELL * cell);
            q.iter_mut().zip(&delta).for_each(|(q, delta)| *q += delta);
            self.delta = delta;
            if is_settled {
                let is_set = equations.set_position(q);
                self.load(equations);
                return is_set;
            }
        }
        false
    }

    fn load(&mut self, equations: &impl Equations) {
        for (position, slope) in self.slopes.iter_mut().enumerate() {
            *slope = equations.slope(position);
        }
    }

    /// Solves `Φ_q x = b` where the position has settled.
    pub fn solve(&mut self, right: impl Fn(usize) -> f64, x: &mut [f64]) {
        for (row, value) in self.right.iter_mut().enumerate() {
            *value = right(row);
        }
        let Pivoting { tables, work, is_negative, right, slopes, .. } = self;
        solve(&tables.blocks(), slopes, right, x, work, is_negative);
    }
}
