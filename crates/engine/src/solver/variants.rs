//! Runs a solver for several variants of a mechanism, each with its own parameters and time.

use super::lanes::{CHUNK, LaneEnvironment, Lanes};
use super::{Pivot, Solver};
use mechc_expr::math::{Vectors, max};
use mechc_ir::program::{LaneValues, Program, Register, Registers};
use std::ops::Range;

/// A multiplier up to this part of the largest one is accepted for any start of Newton's method.
const CERTAIN_MULTIPLIER: f64 = 0.99;

/// The index of a column that is not kept.
const NOT_KEPT: u32 = u32::MAX;

/// The registers and outputs of a solver for `W` variants.
#[derive(Clone, Debug)]
pub struct VariantLanes<const W: usize> {
    lanes: Lanes<W>,
    outputs: VariantOutputs<W>,
}

/// The outputs of a run.
#[derive(Clone, Debug)]
struct VariantOutputs<const W: usize> {
    /// By column of a row: its location in `kept`.
    slots: Vec<Slot>,
    /// The kept values: by kept column, then by row.
    kept: Vec<LaneValues<W>>,
    /// The row that is written and read.
    row: usize,
    /// By turn of the solver: the product of the inverse pivots, which is the inverse of the determinant up to a constant sign; then by
    /// monitor: its value.
    branch_values: Vec<LaneValues<W>>,
    /// The largest scaled inverse of a pivot.
    max_inverse_pivots: LaneValues<W>,
}

/// The location of a column in the kept values: its first index, and its number of rows.
#[derive(Clone, Copy, Debug)]
struct Slot {
    first: u32,
    rows: u32,
}

impl Slot {
    /// The slot of a column that is not kept.
    const NOT_KEPT: Slot = Slot { first: NOT_KEPT, rows: 0 };
}

/// The inputs of a run.
#[derive(Clone, Copy, Debug)]
pub struct VariantBatch<'g, const W: usize> {
    /// The times (s).
    pub times: [f64; W],
    /// By tear: the initial guess.
    pub tears: &'g [LaneValues<W>],
    /// By register of the program: its values, as far as they depend on parameters alone.
    pub loaded: &'g [LaneValues<W>],
    /// By row of `Φ`: the inverse of the bound on its residual.
    pub bounds: &'g [f64],
    /// The number of leading chunks of lanes to execute.
    pub chunks: usize,
    /// The largest correction with which Newton ends, in cells; 0 for rows, whose bits must not depend on the guesses.
    pub loose_bound: f64,
}

impl<const W: usize> VariantLanes<W> {
    /// Allocates the registers for a solver for variants. `rows` returns the number of rows that are kept of a column: 0, 1 for the last row, or a
    /// number common to the other columns.
    #[must_use]
    pub fn new(solver: &Solver, rows: impl Fn(u32) -> u32, vectors: Vectors) -> VariantLanes<W> {
        let (mut slots, mut count) = (vec![Slot::NOT_KEPT; solver.layout.stride], 0);
        for (column, slot) in slots.iter_mut().enumerate() {
            let rows = rows(column as u32);
            if rows > 0 {
                *slot = Slot { first: count, rows };
                // an odd distance, for otherwise all columns of a row would map to the same few cache sets
                count += rows | 1;
            }
        }
        let zero = LaneValues([0.0; W]);
        let (kept, branch_values) = (vec![zero; count as usize], vec![zero; solver.turns.len() + solver.monitors]);
        VariantLanes {
            lanes: Lanes::new(solver, vectors),
            outputs: VariantOutputs { slots, kept, row: 0, branch_values, max_inverse_pivots: zero },
        }
    }

    /// Runs the prologue in the leading chunks, from registers of the program that depend on parameters alone, and stores its results in all kept
    /// rows, where they stay until the next call.
    pub fn load(&mut self, solver: &Solver, program: (&Program, &Registers), loaded: &[LaneValues<W>], chunks: usize) {
        let batch = VariantBatch { times: [0.0; W], tears: &[], loaded, bounds: &[], chunks, loose_bound: 0.0 };
        let env = VariantsEnvironment { batch: &batch, solver, outputs: &mut self.outputs };
        self.lanes.run_prologue::<CHUNK>(solver, program, env);
        for column in solver.prologue_columns() {
            let (value, rows) = (*self.column(column), self.outputs.rows_of(column));
            self.outputs.kept[rows].fill(value);
        }
    }

    /// Solves for all variants; their parameters must have been loaded.
    pub fn run(&mut self, solver: &Solver, program: (&Program, &Registers), batch: &VariantBatch<'_, W>) {
        let outputs = &mut self.outputs;
        outputs.branch_values.fill(LaneValues([1.0; W]));
        outputs.max_inverse_pivots = LaneValues([0.0; W]);
        self.lanes.solve::<CHUNK>(solver, program, VariantsEnvironment { batch, solver, outputs });
    }

    /// Increments the count of each lane that is rejected: Newton has not converged, a residual exceeds its bound, a multiplier is too close to its
    /// limit, or a kept value is not finite.
    #[inline(always)]
    #[allow(clippy::inline_always)] // compiled for several vector instruction sets
    pub fn add_rejections(&self, rejections: &mut LaneValues<W>) {
        self.lanes.add_rejections(CERTAIN_MULTIPLIER, rejections);
    }

    /// Returns by lane the error of the initial guess, scaled.
    #[must_use]
    pub fn first_corrections(&self) -> &LaneValues<W> {
        self.lanes.first_corrections()
    }

    /// Returns by lane the largest scaled inverse of a pivot.
    #[must_use]
    pub fn max_inverse_pivots(&self) -> &LaneValues<W> {
        &self.outputs.max_inverse_pivots
    }

    /// Returns the values whose signs distinguish branches: by turn of the solver the inverse of the block's determinant, up to a constant
    /// sign; then by monitor its value.
    #[must_use]
    pub fn branch_values(&self) -> &[LaneValues<W>] {
        &self.outputs.branch_values
    }

    /// Selects the kept row that is written and read from now on.
    pub fn select_row(&mut self, row: usize) {
        self.outputs.row = row;
    }

    /// Returns the selected row of a kept column.
    #[must_use]
    #[inline]
    pub fn column(&self, column: u32) -> &LaneValues<W> {
        &self.outputs.kept[self.outputs.slot(column)]
    }

    /// Returns all kept rows of a column.
    #[must_use]
    pub fn rows(&self, column: u32) -> &[LaneValues<W>] {
        &self.outputs.kept[self.outputs.rows_of(column)]
    }
}

impl<const W: usize> VariantOutputs<W> {
    #[inline]
    fn slot(&self, column: u32) -> usize {
        let Slot { first, rows } = self.slots[column as usize];
        first as usize + if rows > 1 { self.row } else { 0 }
    }

    /// Returns the indices of all kept rows of a column.
    #[inline]
    fn rows_of(&self, column: u32) -> Range<usize> {
        let Slot { first, rows } = self.slots[column as usize];
        first as usize..first as usize + rows as usize
    }
}

/// Several variants, with the inputs and outputs of a run.
struct VariantsEnvironment<'r, const W: usize> {
    batch: &'r VariantBatch<'r, W>,
    solver: &'r Solver,
    outputs: &'r mut VariantOutputs<W>,
}

#[allow(clippy::inline_always)] // inlined into `Lanes::solve`
impl<const W: usize> LaneEnvironment<CHUNK> for VariantsEnvironment<'_, W> {
    #[inline(always)]
    fn chunks(&self) -> usize {
        self.batch.chunks
    }

    #[inline(always)]
    fn loaded(&self, from: Register, chunk: usize) -> [f64; CHUNK] {
        *self.batch.loaded[from as usize].part(chunk)
    }

    #[inline(always)]
    fn times(&self, chunk: usize) -> [f64; CHUNK] {
        self.batch.times.as_chunks().0[chunk]
    }

    #[inline(always)]
    fn guess(&self, tear: u32, chunk: usize) -> [f64; CHUNK] {
        *self.batch.tears[tear as usize].part(chunk)
    }

    #[inline(always)]
    fn stored(&self, column: u32, chunk: usize) -> [f64; CHUNK] {
        *self.outputs.kept[self.outputs.slot(column)].part(chunk)
    }

    #[inline(always)]
    fn store(&mut self, column: u32, mut values: impl FnMut(usize) -> [f64; CHUNK]) {
        let (slot, chunks) = (self.outputs.slot(column), self.batch.chunks);
        let kept = &mut self.outputs.kept[slot];
        for chunk in 0..chunks {
            *kept.part_mut(chunk) = values(chunk);
        }
    }

    #[inline(always)]
    fn inverse_bound(&self, row: u32) -> f64 {
        self.batch.bounds[row as usize]
    }

    #[inline(always)]
    fn loose_bound(&self) -> f64 {
        self.batch.loose_bound
    }

    #[inline(always)]
    fn note_pivot(&mut self, pivot: u32, chunk: usize, inverse: &[f64; CHUNK]) {
        let Pivot { turn, weight } = self.solver.pivots[pivot as usize];
        let of_block = &mut self.outputs.branch_values[turn as usize];
        let mut determinants = *of_block.part::<CHUNK>(chunk);
        let mut max_inverse_pivots = *self.outputs.max_inverse_pivots.part::<CHUNK>(chunk);
        for k in 0..CHUNK {
            determinants[k] *= inverse[k];
            max_inverse_pivots[k] = max(max_inverse_pivots[k], inverse[k].abs() * weight);
        }
        *of_block.part_mut(chunk) = determinants;
        *self.outputs.max_inverse_pivots.part_mut(chunk) = max_inverse_pivots;
    }

    #[inline(always)]
    fn note_monitor(&mut self, monitor: u32, chunk: usize, value: &[f64; CHUNK]) {
        *self.outputs.branch_values[self.solver.turns.len() + monitor as usize].part_mut(chunk) = *value;
    }
}
