//! Running a solver in several lanes at once: at several times of one mechanism, or for several variants of it (`variants.rs`). Allocates
//! nothing but the registers, once.

use super::curve::Bend;
use super::{Instruction, LARGEST_MULTIPLIER, Solver, Tear, from_bits};
use crate::math::grid::{bound_at_first, going_on, next_point, on_grid};
use crate::math::{self, Vectors};
use crate::program::{LaneMachine, LaneValues, Machine, Op, Program, Register, Registers};
use crate::tolerances::solving::lanes::{BORDER, ITERATIONS, LARGEST_CORRECTION};
use std::array::from_fn;
use std::ops::Range;

/// Registers for `W` times.
#[derive(Clone, Debug)]
pub struct Lanes<const W: usize> {
    vectors: Vectors,
    values: Vec<LaneValues<W>>,
    /// The largest multiplier of each lane, and the largest part of its bound that a residual takes.
    multiplier: [f64; W],
    residual: [f64; W],
    /// The largest correction of each lane, scaled.
    farthest: [f64; W],
    /// With which largest correction Newton ends in each lane, in cells.
    bound: [f64; W],
    /// The largest first correction of each lane, scaled.
    first_correction: [f64; W],
    /// By lane: 0 if all that was stored is finite, else not a number.
    finite: [f64; W],
}

/// What a run reads beside its registers, and where it leaves its results.
pub(super) trait Around<const W: usize> {
    /// The value of one of the program's registers.
    fn loaded(&self, from: Register) -> [f64; W];
    /// The times (s).
    fn times(&self) -> [f64; W];
    /// Where Newton begins with a tear.
    fn guess(&self, tear: u32) -> [f64; W];
    /// What has been left in a column.
    fn stored(&self, column: u32) -> [f64; W];
    /// Leaves a result in a column.
    fn store(&mut self, column: u32, values: &[f64; W]);
    /// One over what may be left of a row of `Φ`.
    fn bound(&self, row: u32) -> f64;
    /// Takes note of one over a pivot.
    fn note(&mut self, pivot: u32, inverse: &[f64; W]);
    /// With corrections of up to so many cells Newton ends, where nobody asks for bits; 0 where only the grid point next to the solution will do.
    fn nearly(&self) -> f64;
}

/// Times to solve at, and what is known there.
#[derive(Clone, Copy, Debug)]
pub struct Batch<'b, const W: usize> {
    /// The times (s), ascending; all within a step.
    pub times: [f64; W],
    /// Where the step begins (s).
    pub from: f64,
    /// The length of the step (s).
    pub length: f64,
    /// Each coordinate as a polynomial of the part of the step.
    pub curve: &'b [[f64; 6]],
    /// How the curve of each tear goes on from the step before, where there was one.
    pub bends: &'b [Bend],
    /// By row of `Φ`: one over what may be left of it.
    pub bounds: &'b [f64],
}

impl<const W: usize> Lanes<W> {
    /// Registers for a solver, which is run with some vector instructions.
    #[must_use]
    pub fn new(solver: &Solver, vectors: Vectors) -> Lanes<W> {
        let values = vec![LaneValues([0.0; W]); solver.registers];
        let zero = [0.0; W];
        Lanes {
            vectors,
            values,
            multiplier: zero,
            residual: zero,
            farthest: zero,
            bound: zero,
            first_correction: zero,
            finite: zero,
        }
    }

    /// How far the curve was from the solution in the last run: the largest first correction, scaled; not a number if one is not.
    #[must_use]
    pub fn first_correction(&self) -> f64 {
        self.first_correction.iter().copied().fold(0.0, math::max)
    }

    /// Whether all numbers of a lane's row are finite.
    #[must_use]
    pub fn is_finite(&self, lane: usize) -> bool {
        self.finite[lane] == 0.0
    }

    /// Solves at the times of a batch and writes a row for each, one behind the other; says which of them hold: their Newton
    /// has settled, every equation is met, and no pivot was too small.
    ///
    /// `scalars` are the program's registers, whose switches stand as they are in this step.
    pub fn run(
        &mut self,
        solver: &Solver,
        program: &Program,
        scalars: &Registers,
        batch: &Batch<'_, W>,
        rows: &mut [f64],
    ) -> [bool; W] {
        for (row, t) in rows.chunks_exact_mut(solver.layout.stride).zip(batch.times) {
            row[0] = t;
        }
        self.solve(solver, (program, scalars), OfTimes { solver, scalars, batch, rows });
        from_fn(|k| !is_lost(self.farthest[k]) && self.multiplier[k] <= LARGEST_MULTIPLIER && self.residual[k] <= 1.0)
    }

    /// Solves in all lanes.
    pub(super) fn solve(&mut self, solver: &Solver, of: (&Program, &Registers), around: impl Around<W>) {
        (self.multiplier, self.residual, self.farthest) = ([0.0; W], [0.0; W], [0.0; W]);
        (self.first_correction, self.finite) = ([0.0; W], [0.0; W]);
        // one lane has nothing to do at once
        let vectors = if W == 1 { Vectors::BASE } else { self.vectors };
        let (program, scalars) = of;
        let mut run = Run { lanes: self, solver, program, scalars, around };
        vectors.run(
            #[inline(always)]
            || run.segments(),
        );
    }

    /// Adds to each lane in which Newton has not settled, an equation is not met, a multiplier is above a part of the largest, or what was
    /// stored is not finite.
    #[inline(always)]
    #[allow(clippy::inline_always, clippy::needless_range_loop)] // compiled for several kinds of processors; by lane it vectorises best
    pub(super) fn write_doubts(&self, part: f64, doubts: &mut [f64; W]) {
        let largest = part * LARGEST_MULTIPLIER;
        for k in 0..W {
            let is_settled = self.farthest[k] <= LARGEST_CORRECTION && self.residual[k] <= 1.0;
            let is_certain = self.multiplier[k] <= largest && self.finite[k] == 0.0;
            doubts[k] += if is_settled & is_certain { 0.0 } else { 1.0 };
        }
    }

    /// How far the guess of each lane was from its solution, scaled.
    pub(super) fn first_corrections(&self) -> &[f64; W] {
        &self.first_correction
    }
}

/// Several times of one mechanism, and a row for each.
struct OfTimes<'r, const W: usize> {
    solver: &'r Solver,
    scalars: &'r Registers,
    batch: &'r Batch<'r, W>,
    rows: &'r mut [f64],
}

#[allow(clippy::inline_always)] // as all that `Lanes::solve` does
impl<const W: usize> Around<W> for OfTimes<'_, W> {
    #[inline(always)]
    fn loaded(&self, from: Register) -> [f64; W] {
        [self.scalars.get(from); W]
    }

    #[inline(always)]
    fn times(&self) -> [f64; W] {
        self.batch.times
    }

    #[inline(always)]
    fn guess(&self, tear: u32) -> [f64; W] {
        self.batch.on_curve(self.solver, tear)
    }

    #[inline(always)]
    fn stored(&self, column: u32) -> [f64; W] {
        let (mut at, stride, mut values) = (column as usize, self.solver.layout.stride, [0.0; W]);
        for value in &mut values {
            *value = self.rows[at];
            at += stride;
        }
        values
    }

    #[inline(always)]
    fn store(&mut self, column: u32, values: &[f64; W]) {
        let (mut at, stride) = (column as usize, self.solver.layout.stride);
        for value in values {
            self.rows[at] = *value;
            at += stride;
        }
    }

    #[inline(always)]
    fn bound(&self, row: u32) -> f64 {
        self.batch.bounds[row as usize]
    }

    #[inline(always)]
    fn note(&mut self, _: u32, _: &[f64; W]) {}

    #[inline(always)]
    fn nearly(&self) -> f64 {
        0.0
    }
}

struct Run<'r, A, const W: usize> {
    lanes: &'r mut Lanes<W>,
    solver: &'r Solver,
    program: &'r Program,
    scalars: &'r Registers,
    around: A,
}

// All of it becomes part of `Lanes::solve`, once for each kind of vector instructions.
#[allow(clippy::inline_always)]
impl<A: Around<W>, const W: usize> Run<'_, A, W> {
    #[inline(always)]
    fn segments(&mut self) {
        for segment in &self.solver.segments {
            let tears = segment.tears();
            self.begin(tears);
            for iteration in 0..ITERATIONS {
                self.instructions(segment.range());
                // what is run once is done then
                if tears.is_empty() || self.go_on(tears, iteration) {
                    break;
                }
            }
            self.end(tears);
        }
    }

    /// Newton begins at the grid points next to its guesses.
    #[inline(always)]
    fn begin(&mut self, tears: &[Tear]) {
        let nearly = self.around.nearly();
        self.lanes.bound = [if nearly > 0.0 { nearly } else { bound_at_first(BORDER) }; W];
        for tear in tears {
            self.lanes.values[tear.x as usize].0.iter_mut().for_each(|x| *x = on_grid(*x, tear.cell));
        }
    }

    /// Goes on to the next grid points in the lanes that have not settled (`math/grid.rs`); says whether there are none. A lane that has
    /// settled stays where it is, whatever the others do.
    #[inline(always)]
    fn go_on(&mut self, tears: &[Tear], iteration: usize) -> bool {
        let nearly = self.around.nearly();
        let Lanes { values, bound, farthest, first_correction, .. } = &mut *self.lanes;
        let (mut largest, mut far) = ([0.0; W], [0.0; W]);
        for tear in tears {
            let delta = &values[tear.delta as usize].0;
            keep_largest(&mut largest, delta, 1.0 / tear.cell);
            keep_largest(&mut far, delta, 1.0 / tear.scale);
        }
        keep_largest(farthest, &far, 1.0);
        if iteration == 0 {
            keep_largest(first_correction, &far, 1.0);
        }
        // by lane: the cells, in cells, among whose points coordinates next to a border go on; 0 where all stay
        let (mut cells, mut open) = ([0.0; W], 0.0);
        for k in 0..W {
            let stays = largest[k] <= bound[k] || is_lost(farthest[k]);
            let (next, width) = going_on(largest[k], bound[k], BORDER);
            let next = if nearly > 0.0 { nearly } else { next };
            bound[k] = if stays { f64::INFINITY } else { next };
            cells[k] = if stays { 0.0 } else { width };
            open += cells[k];
        }
        if open == 0.0 {
            return true;
        }
        for tear in tears {
            let delta = values[tear.delta as usize].0;
            let x = &mut values[tear.x as usize].0;
            for k in 0..W {
                let next = next_point(x[k], delta[k], tear.cell, cells[k], BORDER);
                x[k] = if cells[k] > 0.0 { next } else { x[k] };
            }
        }
        if iteration + 1 == ITERATIONS {
            // lanes that have not settled never will
            for (farthest, cells) in farthest.iter_mut().zip(cells) {
                *farthest = if cells > 0.0 { f64::INFINITY } else { *farthest };
            }
        }
        false
    }

    /// From the last grid points the corrections lead to the solution.
    #[inline(always)]
    fn end(&mut self, tears: &[Tear]) {
        for tear in tears {
            let delta = self.lanes.values[tear.delta as usize].0;
            for (x, delta) in self.lanes.values[tear.x as usize].0.iter_mut().zip(delta) {
                *x += delta;
            }
        }
    }

    #[inline(always)]
    fn instructions(&mut self, range: Range<usize>) {
        let Lanes { values, multiplier, residual, finite, .. } = &mut *self.lanes;
        let around = &mut self.around;
        let mut machine = LaneMachine { v: values.as_mut_slice(), program: self.program, scalars: self.scalars };
        for instruction in &self.solver.instructions[range] {
            // most are operations: one choice of many, and not two
            if let Instruction::Compute(op) = instruction {
                op.run(&mut machine);
                continue;
            }
            match *instruction {
                Instruction::Compute(_) => {}
                Instruction::Pivot { a, pivot } => around.note(pivot, &machine.v[a as usize].0),
                Instruction::Number { to, bits } => machine.write(to, [from_bits(bits); W]),
                Instruction::Load { to, from } => machine.write(to, around.loaded(from)),
                Instruction::Time { to } => machine.write(to, around.times()),
                Instruction::Column { to, column } => machine.write(to, around.stored(column)),
                Instruction::Store { column, a } => {
                    // −0 would surprise a reader; lanes together first, then one by one to their rows
                    let values = machine.v[a as usize].0.map(|value| value + 0.0);
                    for (finite, value) in finite.iter_mut().zip(values) {
                        *finite += 0.0 * value;
                    }
                    around.store(column, &values);
                }
                Instruction::Curve { to, tear } => machine.write(to, around.guess(tear)),
                Instruction::Multiplier { to, a, b, weight } => {
                    Op::Mul { to, a, b }.run(&mut machine);
                    keep_largest(multiplier, &machine.v[to as usize].0, self.solver.weights[weight as usize]);
                }
                Instruction::Residual { a, row } => {
                    keep_largest(residual, &machine.v[a as usize].0, around.bound(row));
                }
            }
        }
    }
}

impl<const W: usize> Batch<'_, W> {
    /// Where Newton begins with a tear: on the curve of the step.
    #[inline(always)]
    #[allow(clippy::inline_always)] // as all that `Lanes::solve` does
    fn on_curve(&self, solver: &Solver, tear: u32) -> [f64; W] {
        let curve = &self.curve[solver.tears[tear as usize] as usize];
        let bend = self.bends.get(tear as usize).unwrap_or(&Bend::NONE);
        let per_second = 1.0 / self.length;
        self.times.map(|t| bend.on_curve(curve, (t - self.from) * per_second))
    }
}

/// Whether an iteration has gone astray whose largest correction, scaled, is this.
#[inline(always)]
#[allow(clippy::inline_always)] // as all that `Lanes::solve` does
fn is_lost(farthest: f64) -> bool {
    farthest.is_nan() || farthest > LARGEST_CORRECTION
}

/// Keeps the larger of what is known and `|value| factor`; what is not a number stays.
#[inline(always)]
#[allow(clippy::inline_always)] // as all that `Lanes::solve` does
fn keep_largest<const W: usize>(largest: &mut [f64; W], values: &[f64; W], factor: f64) {
    for (largest, value) in largest.iter_mut().zip(values) {
        *largest = math::max(*largest, value.abs() * factor);
    }
}

#[cfg(test)]
mod tests {
    use super::keep_largest;

    #[test]
    fn what_is_not_a_number_stays_the_largest() {
        let mut largest = [0.0; 2];
        for values in [[1.0, f64::NAN], [f64::NAN, -3.0], [2.0, 2.0]] {
            keep_largest(&mut largest, &values, 0.5);
        }
        assert!(largest.iter().all(|size| size.is_nan()), "{largest:?}");
    }
}
