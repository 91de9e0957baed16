//! Solves with partial pivoting where the fixed order of elimination loses digits: all coordinates at once, block by block.

use super::build::cell;
use crate::limits::lanes::{BORDER, ITERATIONS};
use crate::limits::solver::{CELL, LARGEST_BLOCK};
use mechc_expr::math::blocks::{Blocks, solve, work_of};
use mechc_expr::math::grid::{bound_at_first, going_on, next_point, on_grid};
use mechc_expr::math::max;
use mechc_ir::structure::Determined;

/// The blocks of a system with memory to solve them with partial pivoting. Iterates lie on a grid, like those of the [`Solver`](super::Solver), but
/// in all coordinates.
#[derive(Clone, Debug)]
pub struct Pivoting {
    tables: BlockTables,
    work: Vec<f64>,
    is_negative: Vec<bool>,
    right: Vec<f64>,
    slopes: Vec<f64>,
    delta: Vec<f64>,
    /// The transposed system for the multipliers, if there are forces.
    transposed: Option<Transposed>,
}

/// The transposed matrix: an equation for each coordinate, with an unknown for each row of `Φ`. Its blocks are those of the matrix in reverse order.
#[derive(Clone, Debug)]
struct Transposed {
    tables: BlockTables,
    /// By entry: its position in the pattern of `Φ_q`.
    positions: Vec<usize>,
    /// By entry: its value.
    slopes: Vec<f64>,
}

/// The lists that [`Blocks`] borrows.
#[derive(Clone, Debug)]
#[allow(missing_docs)] // documented at `Blocks`
pub struct BlockTables {
    pub sizes: Vec<usize>,
    pub rows: Vec<usize>,
    pub columns: Vec<usize>,
    pub starts: Vec<usize>,
    pub entries: Vec<usize>,
    pub places: Vec<usize>,
    pub units: Vec<f64>,
    /// By coordinate: the width of a grid cell (m or rad).
    pub cells: Vec<f64>,
}

impl BlockTables {
    /// Creates the tables of a system; returns `None` if a block has more than `LARGEST_BLOCK` rows.
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
        let rows = 0..system.rows().len();
        let starts = rows.clone().map(|row| system.phi_q().range(row).start).chain([system.phi_q().entries().len()]);
        let cells = system.coordinates().iter().map(|coordinate| cell(coordinate.scale));
        Some(BlockTables {
            sizes: blocks.iter().map(|block| block.rows.len()).collect(),
            rows: blocks.iter().flat_map(|block| &block.rows).map(|&row| row as usize).collect(),
            starts: starts.collect(),
            entries: system.phi_q().entries().iter().map(|&(column, _)| column as usize).collect(),
            units: cells.clone().map(|cell| cell / CELL).collect(),
            cells: cells.collect(),
            columns,
            places,
        })
    }

    /// Returns the tables of the transposed matrix, and by entry its position in the pattern.
    #[must_use]
    pub fn transposed(&self) -> (BlockTables, Vec<usize>) {
        let n = self.rows.len();
        let mut blocks = Vec::with_capacity(self.sizes.len());
        let mut at = 0;
        for size in &self.sizes {
            blocks.push(at..at + size);
            at += size;
        }
        let backwards = |list: &[usize]| -> Vec<usize> {
            blocks.iter().rev().flat_map(|block| list[block.clone()].iter().copied()).collect()
        };
        let unknowns = backwards(&self.rows);
        let mut places = vec![0; n];
        for (place, &row) in unknowns.iter().enumerate() {
            places[row] = place;
        }
        let mut of_column: Vec<Vec<(usize, usize)>> = vec![Vec::new(); n];
        for row in 0..n {
            for position in self.starts[row]..self.starts[row + 1] {
                of_column[self.entries[position]].push((row, position));
            }
        }
        let mut starts = vec![0];
        for entries in &of_column {
            starts.push(starts[starts.len() - 1] + entries.len());
        }
        let transposed = BlockTables {
            sizes: self.sizes.iter().rev().copied().collect(),
            rows: backwards(&self.columns),
            columns: unknowns,
            starts,
            entries: of_column.iter().flatten().map(|&(row, _)| row).collect(),
            places,
            units: vec![1.0; n],
            cells: Vec::new(),
        };
        (transposed, of_column.into_iter().flatten().map(|(_, position)| position).collect())
    }

    /// Returns the size of the largest block.
    #[must_use]
    pub fn largest(&self) -> usize {
        self.sizes.iter().copied().max().unwrap_or(0)
    }

    /// Borrows the tables for [`solve`].
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

/// Equations that are evaluated at a position.
pub trait Equations {
    /// Evaluates `Φ` and `Φ_q` at a position [m, rad]; returns `false` if a formula has no value.
    fn set_position(&mut self, q: &[f64]) -> bool;
    /// Returns an entry of `Φ`.
    fn phi(&self, row: usize) -> f64;
    /// Returns an entry of `Φ_q`, by its position in the pattern.
    fn slope(&self, position: usize) -> f64;
}

impl Pivoting {
    /// Allocates memory for a system; returns `None` if a block has more than [`LARGEST_BLOCK`] rows.
    #[must_use]
    pub fn new(determined: &Determined) -> Option<Pivoting> {
        let tables = BlockTables::new(determined)?;
        let n = tables.rows.len();
        let transposed = determined.system().forces().as_ref().map(|_| {
            let (tables, positions) = tables.transposed();
            Transposed { slopes: vec![0.0; positions.len()], tables, positions }
        });
        Some(Pivoting {
            work: vec![0.0; work_of(tables.largest())],
            is_negative: vec![false; tables.sizes.len()],
            right: vec![0.0; n],
            slopes: vec![0.0; tables.entries.len()],
            delta: vec![0.0; n],
            transposed,
            tables,
        })
    }

    /// Solves for a position [m, rad] by Newton on the grid, from the initial guess in `q`; returns whether it has converged. The equations are then
    /// evaluated at the solution.
    pub fn position(&mut self, equations: &mut impl Equations, q: &mut [f64]) -> bool {
        let mut bound = bound_at_first(BORDER);
        for (q, &cell) in q.iter_mut().zip(&self.tables.cells) {
            *q = on_grid(*q, cell);
        }
        for _ in 0..ITERATIONS {
            if !equations.set_position(q) {
                return false;
            }
            self.load(equations);
            let mut delta = std::mem::take(&mut self.delta);
            self.solve(|row| -equations.phi(row), &mut delta);
            let sizes = delta.iter().zip(&self.tables.cells).map(|(delta, cell)| delta.abs() / cell);
            let size = sizes.fold(0.0, max);
            let corrected = q.iter_mut().zip(&delta);
            if size <= bound {
                corrected.for_each(|(q, delta)| *q += delta);
                self.delta = delta;
                let is_set = equations.set_position(q);
                self.load(equations);
                return is_set;
            }
            let (next, cells) = going_on(size, bound, BORDER);
            let places = corrected.zip(&self.tables.cells);
            places.for_each(|((q, delta), cell)| *q = next_point(*q, *delta, *cell, cells, BORDER));
            bound = next;
            self.delta = delta;
        }
        false
    }

    fn load(&mut self, equations: &impl Equations) {
        for (position, slope) in self.slopes.iter_mut().enumerate() {
            *slope = equations.slope(position);
        }
    }

    /// Solves `Φ_q x = b` at the last position.
    pub fn solve(&mut self, right: impl Fn(usize) -> f64, x: &mut [f64]) {
        for (row, value) in self.right.iter_mut().enumerate() {
            *value = right(row);
        }
        let Pivoting { tables, work, is_negative, right, slopes, .. } = self;
        solve(&tables.blocks(), slopes, right, x, work, is_negative);
    }

    /// Solves `Φ_qᵀ λ = p` at the last position; does nothing without forces.
    pub fn solve_for_multipliers(&mut self, needed: impl Fn(usize) -> f64, multipliers: &mut [f64]) {
        let Pivoting { transposed, work, is_negative, right, slopes, .. } = self;
        let Some(Transposed { tables, positions, slopes: across }) = transposed else { return };
        for (column, value) in right.iter_mut().enumerate() {
            *value = needed(column);
        }
        for (slope, &position) in across.iter_mut().zip(&*positions) {
            *slope = slopes[position];
        }
        solve(&tables.blocks(), across, right, multipliers, work, is_negative);
    }
}
