//! Running a solver for several variants of a mechanism at once, each with parameters and a time of its own.

use super::lanes::{Around, Lanes, PART};
use super::{Pivot, Solver};
use mechc_expr::math::{Vectors, max};
use mechc_ir::program::{LaneValues, Program, Register, Registers};
use mechc_ir::tolerances::solving::variants::CERTAIN_MULTIPLIER;
use std::ops::Range;

/// No column is left there.
const NOWHERE: u32 = u32::MAX;

/// Registers for `W` variants, and what a run leaves of each.
#[derive(Clone, Debug)]
pub struct Abreast<const W: usize> {
    lanes: Lanes<W>,
    out: Out<W>,
}

/// What a run leaves.
#[derive(Clone, Debug)]
struct Out<const W: usize> {
    /// By column of a row: where it is among the numbers that are kept.
    places: Vec<Place>,
    /// By column that is kept, by row of those that are kept of it.
    kept: Vec<LaneValues<W>>,
    /// Which of the rows is written and read.
    row: usize,
    /// By turn of the solver: one over the block's determinant, but for its sign where pivots are positive.
    determinants: Vec<LaneValues<W>>,
    /// One over the smallest pivot, scaled.
    steepest: LaneValues<W>,
}

/// Where a column is among the numbers that are kept, and of how many rows.
#[derive(Clone, Copy, Debug)]
struct Place {
    first: u32,
    rows: u32,
}

impl Place {
    /// Of a column that is not kept.
    const NOWHERE: Place = Place { first: NOWHERE, rows: 0 };
}

/// What variants are solved with.
#[derive(Clone, Copy, Debug)]
pub struct Guesses<'g, const W: usize> {
    /// The times (s).
    pub times: [f64; W],
    /// By tear: where Newton begins.
    pub tears: &'g [LaneValues<W>],
    /// The program's registers, as far as they depend on parameters alone.
    pub loaded: &'g [LaneValues<W>],
    /// By row of `Φ`: one over what may be left of it.
    pub bounds: &'g [f64],
    /// In so many parts of the lanes somebody goes, the first ones.
    pub parts: usize,
    /// With corrections of up to so many cells Newton ends; 0 where rows are wanted, whose bits must not depend on the guesses.
    pub nearly: f64,
}

impl<const W: usize> Abreast<W> {
    /// For a solver that is laid out for variants, which keeps so many rows of each column: of none, of the last one, or of as many as of others.
    #[must_use]
    pub fn new(solver: &Solver, rows: impl Fn(u32) -> u32, vectors: Vectors) -> Abreast<W> {
        let (mut places, mut count) = (vec![Place::NOWHERE; solver.layout.stride], 0);
        for (column, place) in places.iter_mut().enumerate() {
            let rows = rows(column as u32);
            if rows > 0 {
                *place = Place { first: count, rows };
                // an odd number of rows apart: else all columns of a row would want the same few places of the processor's memory
                count += rows | 1;
            }
        }
        let zero = LaneValues([0.0; W]);
        let (kept, determinants) = (vec![zero; count as usize], vec![zero; solver.turns.len()]);
        Abreast { lanes: Lanes::new(solver, vectors), out: Out { places, kept, row: 0, determinants, steepest: zero } }
    }

    /// Takes over what depends on parameters alone, of the program's registers, in so many parts of the lanes, and leaves in all rows that are kept
    /// what is so itself: it stays until this is called again.
    pub fn load(&mut self, solver: &Solver, of: (&Program, &Registers), loaded: &[LaneValues<W>], parts: usize) {
        let guesses = Guesses { times: [0.0; W], tears: &[], loaded, bounds: &[], parts, nearly: 0.0 };
        let around = OfVariants { guesses: &guesses, pivots: &solver.pivots, out: &mut self.out };
        self.lanes.prepare::<PART>(solver, of, around);
        for column in solver.fixed_columns() {
            let (value, all) = (*self.column(column), self.out.all(column));
            self.out.kept[all].fill(value);
        }
    }

    /// Solves for all variants, once what depends on their parameters is loaded.
    pub fn run(&mut self, solver: &Solver, of: (&Program, &Registers), guesses: &Guesses<'_, W>) {
        let out = &mut self.out;
        out.determinants.fill(LaneValues([1.0; W]));
        out.steepest = LaneValues([0.0; W]);
        self.lanes.solve::<PART>(solver, of, OfVariants { guesses, pivots: &solver.pivots, out });
    }

    /// Adds to each lane that does not hold beyond doubt: its Newton has settled, every equation is met, no pivot was too small, and all that
    /// was kept is finite.
    #[inline(always)]
    #[allow(clippy::inline_always)] // it is compiled for several kinds of processors
    pub fn write_doubts(&self, doubts: &mut LaneValues<W>) {
        self.lanes.write_doubts(CERTAIN_MULTIPLIER, doubts);
    }

    /// How far the guess of each lane was from its solution, scaled.
    #[must_use]
    pub fn first_corrections(&self) -> &LaneValues<W> {
        self.lanes.first_corrections()
    }

    /// One over the smallest pivot of a lane, scaled.
    #[must_use]
    pub fn steepest(&self) -> &LaneValues<W> {
        &self.out.steepest
    }

    /// By turn of the solver: one over the block's determinant, but for a sign that stays.
    #[must_use]
    pub fn determinants(&self) -> &[LaneValues<W>] {
        &self.out.determinants
    }

    /// Goes to one of the rows that are kept: that is written and read from then on.
    pub fn turn_to(&mut self, row: usize) {
        self.out.row = row;
    }

    /// What is in a column that is kept.
    #[must_use]
    #[inline]
    pub fn column(&self, column: u32) -> &LaneValues<W> {
        &self.out.kept[self.out.place(column)]
    }

    /// What is in a column of all rows that are kept.
    #[must_use]
    pub fn rows(&self, column: u32) -> &[LaneValues<W>] {
        &self.out.kept[self.out.all(column)]
    }
}

impl<const W: usize> Out<W> {
    #[inline]
    fn place(&self, column: u32) -> usize {
        let Place { first, rows } = self.places[column as usize];
        first as usize + if rows > 1 { self.row } else { 0 }
    }

    /// The places of all rows.
    #[inline]
    fn all(&self, column: u32) -> Range<usize> {
        let Place { first, rows } = self.places[column as usize];
        first as usize..first as usize + rows as usize
    }
}

/// Several variants.
struct OfVariants<'r, const W: usize> {
    guesses: &'r Guesses<'r, W>,
    pivots: &'r [Pivot],
    out: &'r mut Out<W>,
}

#[allow(clippy::inline_always)] // as all that `Lanes::solve` does
impl<const W: usize> Around<PART> for OfVariants<'_, W> {
    #[inline(always)]
    fn parts(&self) -> usize {
        self.guesses.parts
    }

    #[inline(always)]
    fn loaded(&self, from: Register, part: usize) -> [f64; PART] {
        *self.guesses.loaded[from as usize].part(part)
    }

    #[inline(always)]
    fn times(&self, part: usize) -> [f64; PART] {
        self.guesses.times.as_chunks().0[part]
    }

    #[inline(always)]
    fn guess(&self, tear: u32, part: usize) -> [f64; PART] {
        *self.guesses.tears[tear as usize].part(part)
    }

    #[inline(always)]
    fn stored(&self, column: u32, part: usize) -> [f64; PART] {
        *self.out.kept[self.out.place(column)].part(part)
    }

    #[inline(always)]
    fn store(&mut self, column: u32, mut values: impl FnMut(usize) -> [f64; PART]) {
        let (place, parts) = (self.out.place(column), self.guesses.parts);
        let kept = &mut self.out.kept[place];
        for part in 0..parts {
            *kept.part_mut(part) = values(part);
        }
    }

    #[inline(always)]
    fn bound(&self, row: u32) -> f64 {
        self.guesses.bounds[row as usize]
    }

    #[inline(always)]
    fn nearly(&self) -> f64 {
        self.guesses.nearly
    }

    #[inline(always)]
    fn note(&mut self, pivot: u32, part: usize, inverse: &[f64; PART]) {
        let Pivot { turn, weight } = self.pivots[pivot as usize];
        let of_turn = &mut self.out.determinants[turn as usize];
        let mut determinants = *of_turn.part::<PART>(part);
        let mut steepest = *self.out.steepest.part::<PART>(part);
        for k in 0..PART {
            determinants[k] *= inverse[k];
            steepest[k] = max(steepest[k], inverse[k].abs() * weight);
        }
        *of_turn.part_mut(part) = determinants;
        *self.out.steepest.part_mut(part) = steepest;
    }
}
