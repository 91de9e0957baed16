//! Running a solver at several times at once. Allocates nothing but the registers, once.

use super::curve::Bend;
use super::{Instruction, LARGEST_MULTIPLIER, Solver, Tear, from_bits};
use crate::math::{self, Vectors};
use crate::program::{LaneMachine, Machine, Op, Program, Registers, Vector};
use crate::tolerances::solving::lanes::{HALF_A_CELL, ITERATIONS, LARGEST_CORRECTION};
use std::array::from_fn;
use std::ops::Range;

/// The grid point next to a value, cells being so wide.
#[inline(always)]
#[allow(clippy::inline_always)] // as all that `Lanes::run` does
pub(super) fn on_grid(x: f64, cell: f64) -> f64 {
    // adding and taking away 1.5 · 2⁵² cells rounds to a whole number of them
    let rounding = 6_755_399_441_055_744.0 * cell;
    (x + rounding) - rounding
}

/// Registers for `W` times.
#[derive(Clone, Debug)]
pub struct Lanes<const W: usize> {
    vectors: Vectors,
    values: Vec<Vector<W>>,
    /// The largest multiplier of each lane, and the largest part of its bound that a residual takes.
    multiplier: [f64; W],
    residual: [f64; W],
    /// Lanes whose iteration has gone astray.
    is_lost: [bool; W],
    /// The largest first correction of each lane, scaled.
    first_correction: [f64; W],
    /// By lane: 0 if all that was stored is finite, else not a number.
    finite: [f64; W],
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
        let values = vec![Vector([0.0; W]); solver.registers];
        let zero = [0.0; W];
        Lanes {
            vectors,
            values,
            multiplier: zero,
            residual: zero,
            is_lost: [false; W],
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
        (self.multiplier, self.residual, self.is_lost) = ([0.0; W], [0.0; W], [false; W]);
        (self.first_correction, self.finite) = ([0.0; W], [0.0; W]);
        for (row, t) in rows.chunks_exact_mut(solver.layout.stride).zip(batch.times) {
            row[0] = t;
        }
        // one lane has nothing to do at once
        let vectors = if W == 1 { Vectors::BASE } else { self.vectors };
        let mut run = Run { lanes: self, solver, program, scalars, batch, rows };
        vectors.run(
            #[inline(always)]
            || run.segments(),
        );
        from_fn(|k| !self.is_lost[k] && self.multiplier[k] <= LARGEST_MULTIPLIER && self.residual[k] <= 1.0)
    }
}

struct Run<'r, const W: usize> {
    lanes: &'r mut Lanes<W>,
    solver: &'r Solver,
    program: &'r Program,
    scalars: &'r Registers,
    batch: &'r Batch<'r, W>,
    rows: &'r mut [f64],
}

// All of it becomes part of `Lanes::run`, once for each kind of vector instructions.
#[allow(clippy::inline_always)]
impl<const W: usize> Run<'_, W> {
    #[inline(always)]
    fn segments(&mut self) {
        for segment in &self.solver.segments {
            let tears = segment.tears();
            for iteration in 0..ITERATIONS {
                self.put_on_grid(tears);
                self.instructions(segment.range());
                // what is run once is settled by that
                if self.take_corrections(tears, iteration) {
                    break;
                }
            }
        }
    }

    /// Newton goes from grid point to grid point.
    #[inline(always)]
    fn put_on_grid(&mut self, tears: &[Tear]) {
        for tear in tears {
            self.lanes.values[tear.x as usize].0.iter_mut().for_each(|x| *x = on_grid(*x, tear.cell));
        }
    }

    /// Adds the corrections to the tears; says whether every lane's stay in the cell.
    #[inline(always)]
    fn take_corrections(&mut self, tears: &[Tear], iteration: usize) -> bool {
        let mut is_settled = true;
        for tear in tears {
            let delta = self.lanes.values[tear.delta as usize].0;
            if iteration == 0 {
                keep_largest(&mut self.lanes.first_correction, &delta, 1.0 / tear.scale);
            }
            let is_lost = &mut self.lanes.is_lost;
            for k in 0..W {
                is_lost[k] |= delta[k].is_nan() || delta[k].abs() > LARGEST_CORRECTION * tear.scale;
                is_settled &= is_lost[k] || delta[k].abs() <= HALF_A_CELL * tear.cell;
            }
            let x = &mut self.lanes.values[tear.x as usize].0;
            for k in 0..W {
                x[k] += delta[k];
            }
        }
        if !is_settled && iteration + 1 == ITERATIONS {
            self.give_up(tears);
        }
        is_settled
    }

    /// Lanes that have not settled never will.
    #[inline(always)]
    fn give_up(&mut self, tears: &[Tear]) {
        for tear in tears {
            let delta = self.lanes.values[tear.delta as usize].0;
            for (lost, delta) in self.lanes.is_lost.iter_mut().zip(delta) {
                *lost |= delta.abs() > HALF_A_CELL * tear.cell;
            }
        }
    }

    #[inline(always)]
    fn instructions(&mut self, range: Range<usize>) {
        let Lanes { values, multiplier, residual, finite, .. } = &mut *self.lanes;
        let (batch, stride) = (self.batch, self.solver.layout.stride);
        let mut machine = LaneMachine { v: values.as_mut_slice(), program: self.program, scalars: self.scalars };
        for instruction in &self.solver.instructions[range] {
            // most are operations: one choice of many, and not two
            if let Instruction::Compute(op) = instruction {
                op.run(&mut machine);
                continue;
            }
            match *instruction {
                Instruction::Compute(_) | Instruction::Pivot { .. } => {}
                Instruction::Number { to, bits } => machine.write(to, [from_bits(bits); W]),
                Instruction::Load { to, from } => machine.write(to, [self.scalars.get(from); W]),
                Instruction::Time { to } => machine.write(to, batch.times),
                Instruction::Column { to, column } => {
                    let mut at = column as usize;
                    for value in &mut machine.v[to as usize].0 {
                        *value = self.rows[at];
                        at += stride;
                    }
                }
                Instruction::Store { column, a } => {
                    let mut at = column as usize;
                    for (value, finite) in machine.v[a as usize].0.iter().zip(finite.iter_mut()) {
                        // −0 would surprise a reader
                        self.rows[at] = value + 0.0;
                        *finite += 0.0 * value;
                        at += stride;
                    }
                }
                Instruction::Curve { to, tear } => machine.write(to, batch.on_curve(self.solver, tear)),
                Instruction::Multiplier { to, a, b, weight } => {
                    Op::Mul { to, a, b }.run(&mut machine);
                    keep_largest(multiplier, &machine.v[to as usize].0, self.solver.weights[weight as usize]);
                }
                Instruction::Residual { a, row } => {
                    keep_largest(residual, &machine.v[a as usize].0, batch.bounds[row as usize]);
                }
            }
        }
    }
}

impl<const W: usize> Batch<'_, W> {
    /// Where Newton begins with a tear: on the curve of the step.
    #[inline(always)]
    #[allow(clippy::inline_always)] // as all that `Lanes::run` does
    fn on_curve(&self, solver: &Solver, tear: u32) -> [f64; W] {
        let curve = &self.curve[solver.tears[tear as usize] as usize];
        let bend = self.bends.get(tear as usize).unwrap_or(&Bend::NONE);
        let per_second = 1.0 / self.length;
        self.times.map(|t| bend.on_curve(curve, (t - self.from) * per_second))
    }
}

/// Keeps the larger of what is known and `|value| factor`; what is not a number stays.
#[inline(always)]
#[allow(clippy::inline_always)] // as all that `Lanes::run` does
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
