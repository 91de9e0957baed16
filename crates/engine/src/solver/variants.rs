//! Running a solver for several variants of a mechanism at once, each with parameters and a time of its own.

use super::lanes::{CHUNK, LaneEnvironment, Lanes};
use super::{Pivot, Solver};
use mechc_expr::math::{Vectors, max};
use mechc_ir::program::{LaneValues, Program, Register, Registers};
use mechc_ir::tolerances::solving::variants::CERTAIN_MULTIPLIER;
use std::ops::Range;

/// No column is left there.
const NOT_KEPT: u32 = u32::MAX;

/// Registers for `W` variants, and what a run leaves of each.
#[derive(Clone, Debug)]
pub struct VariantLanes<const W: usize> {
    lanes: Lanes<W>,
    outputs: VariantOutputs<W>,
}

/// What a run leaves.
#[derive(Clone, Debug)]
struct VariantOutputs<const W: usize> {
    /// By column of a row: where it is among the numbers that are kept.
    slots: Vec<Slot>,
    /// By column that is kept, by row of those that are kept of it.
    kept: Vec<LaneValues<W>>,
    /// Which of the rows is written and read.
    row: usize,
    /// By turn of the solver: one over the block's determinant, but for its sign where pivots are positive.
    determinants: Vec<LaneValues<W>>,
    /// One over the smallest pivot, scaled.
    max_inverse_pivots: LaneValues<W>,
}

/// Where a column is among the numbers that are kept, and of how many rows.
#[derive(Clone, Copy, Debug)]
struct Slot {
    first: u32,
    rows: u32,
}

impl Slot {
    /// Of a column that is not kept.
    const NOT_KEPT: Slot = Slot { first: NOT_KEPT, rows: 0 };
}

/// What variants are solved with.
#[derive(Clone, Copy, Debug)]
pub struct VariantBatch<'g, const W: usize> {
    /// The times (s).
    pub times: [f64; W],
    /// By tear: where Newton begins.
    pub tears: &'g [LaneValues<W>],
    /// The program's registers, as far as they depend on parameters alone.
    pub loaded: &'g [LaneValues<W>],
    /// By row of `Φ`: one over what may be left of it.
    pub bounds: &'g [f64],
    /// In so many parts of the lanes somebody goes, the first ones.
    pub chunks: usize,
    /// With corrections of up to so many cells Newton ends; 0 where rows are wanted, whose bits must not depend on the guesses.
    pub loose_bound: f64,
}

impl<const W: usize> VariantLanes<W> {
    /// For a solver that is laid out for variants, which keeps so many rows of each column: of none, of the last one, or of as many as of others.
    #[must_use]
    pub fn new(solver: &Solver, rows: impl Fn(u32) -> u32, vectors: Vectors) -> VariantLanes<W> {
        let (mut slots, mut count) = (vec![Slot::NOT_KEPT; solver.layout.stride], 0);
        for (column, slot) in slots.iter_mut().enumerate() {
            let rows = rows(column as u32);
            if rows > 0 {
                *slot = Slot { first: count, rows };
                // an odd number of rows apart: else all columns of a row would want the same few places of the processor's memory
                count += rows | 1;
            }
        }
        let zero = LaneValues([0.0; W]);
        let (kept, determinants) = (vec![zero; count as usize], vec![zero; solver.turns.len()]);
        VariantLanes {
            lanes: Lanes::new(solver, vectors),
            outputs: VariantOutputs { slots, kept, row: 0, determinants, max_inverse_pivots: zero },
        }
    }

    /// Takes over what depends on parameters alone, of the program's registers, in so many parts of the lanes, and leaves in all rows that are kept
    /// what is so itself: it stays until this is called again.
    pub fn load(&mut self, solver: &Solver, program: (&Program, &Registers), loaded: &[LaneValues<W>], chunks: usize) {
        let batch = VariantBatch { times: [0.0; W], tears: &[], loaded, bounds: &[], chunks, loose_bound: 0.0 };
        let env = VariantsEnvironment { batch: &batch, pivots: &solver.pivots, outputs: &mut self.outputs };
        self.lanes.run_prologue::<CHUNK>(solver, program, env);
        for column in solver.prologue_columns() {
            let (value, rows) = (*self.column(column), self.outputs.rows_of(column));
            self.outputs.kept[rows].fill(value);
        }
    }

    /// Solves for all variants, once what depends on their parameters is loaded.
    pub fn run(&mut self, solver: &Solver, program: (&Program, &Registers), batch: &VariantBatch<'_, W>) {
        let outputs = &mut self.outputs;
        outputs.determinants.fill(LaneValues([1.0; W]));
        outputs.max_inverse_pivots = LaneValues([0.0; W]);
        self.lanes.solve::<CHUNK>(solver, program, VariantsEnvironment { batch, pivots: &solver.pivots, outputs });
    }

    /// Adds to each lane that does not hold beyond doubt: its Newton has settled, every equation is met, no pivot was too small, and all that
    /// was kept is finite.
    #[inline(always)]
    #[allow(clippy::inline_always)] // it is compiled for several kinds of processors
    pub fn add_rejections(&self, rejections: &mut LaneValues<W>) {
        self.lanes.add_rejections(CERTAIN_MULTIPLIER, rejections);
    }

    /// How far the guess of each lane was from its solution, scaled.
    #[must_use]
    pub fn first_corrections(&self) -> &LaneValues<W> {
        self.lanes.first_corrections()
    }

    /// One over the smallest pivot of a lane, scaled.
    #[must_use]
    pub fn max_inverse_pivots(&self) -> &LaneValues<W> {
        &self.outputs.max_inverse_pivots
    }

    /// By turn of the solver: one over the block's determinant, but for a sign that stays.
    #[must_use]
    pub fn determinants(&self) -> &[LaneValues<W>] {
        &self.outputs.determinants
    }

    /// Goes to one of the rows that are kept: that is written and read from then on.
    pub fn select_row(&mut self, row: usize) {
        self.outputs.row = row;
    }

    /// What is in a column that is kept.
    #[must_use]
    #[inline]
    pub fn column(&self, column: u32) -> &LaneValues<W> {
        &self.outputs.kept[self.outputs.slot(column)]
    }

    /// What is in a column of all rows that are kept.
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

    /// The places of all rows.
    #[inline]
    fn rows_of(&self, column: u32) -> Range<usize> {
        let Slot { first, rows } = self.slots[column as usize];
        first as usize..first as usize + rows as usize
    }
}

/// Several variants.
struct VariantsEnvironment<'r, const W: usize> {
    batch: &'r VariantBatch<'r, W>,
    pivots: &'r [Pivot],
    outputs: &'r mut VariantOutputs<W>,
}

#[allow(clippy::inline_always)] // as all that `Lanes::solve` does
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
        let Pivot { turn, weight } = self.pivots[pivot as usize];
        let of_block = &mut self.outputs.determinants[turn as usize];
        let mut determinants = *of_block.part::<CHUNK>(chunk);
        let mut max_inverse_pivots = *self.outputs.max_inverse_pivots.part::<CHUNK>(chunk);
        for k in 0..CHUNK {
            determinants[k] *= inverse[k];
            max_inverse_pivots[k] = max(max_inverse_pivots[k], inverse[k].abs() * weight);
        }
        *of_block.part_mut(chunk) = determinants;
        *self.outputs.max_inverse_pivots.part_mut(chunk) = max_inverse_pivots;
    }
}
