//! Running a solver at several times at once. Allocates nothing but the registers, once.

use super::curve::Bend;
use super::{Instruction, LARGEST_MULTIPLIER, Segment, Solver, Tear, from_bits};
use crate::expr::{Binary, Comparison, Unary, binary_value, compare, unary_value};
use crate::math;
use crate::program::{Column, Machine, Op, Program, Register, Registers, truth};
use crate::tolerances::solving::lanes::{HALF_A_CELL, ITERATIONS, LARGEST_CORRECTION};

use std::array::from_fn;
use std::ops::Range;

/// The grid point next to a value, cells being so wide.
pub(super) fn on_grid(x: f64, cell: f64) -> f64 {
    // adding and taking away 1.5 · 2⁵² cells rounds to a whole number of them
    let rounding = 6_755_399_441_055_744.0 * cell;
    (x + rounding) - rounding
}

/// The values of one register, a lane for each time.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Vector<const W: usize>([f64; W]);

/// Registers for `W` times.
#[derive(Clone, Debug)]
pub struct Lanes<const W: usize> {
    values: Vec<Vector<W>>,
    /// The largest multiplier of each lane, and the largest part of its bound that a residual takes.
    multiplier: [f64; W],
    residual: [f64; W],
    /// Lanes whose iteration has gone astray.
    is_lost: [bool; W],
    /// The largest first correction of each lane, scaled.
    first_correction: [f64; W],
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
    /// Registers for a solver.
    #[must_use]
    pub fn new(solver: &Solver) -> Lanes<W> {
        let values = vec![Vector([0.0; W]); solver.registers];
        Lanes { values, multiplier: [0.0; W], residual: [0.0; W], is_lost: [false; W], first_correction: [0.0; W] }
    }

    /// How far the curve was from the solution in the last run: the largest first correction, scaled; not a number if one is not.
    #[must_use]
    pub fn first_correction(&self) -> f64 {
        self.first_correction.iter().copied().fold(0.0, math::max)
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
        self.first_correction = [0.0; W];
        for (row, t) in rows.chunks_exact_mut(solver.layout.stride).zip(batch.times) {
            row[0] = t;
        }
        let mut run = Run { lanes: self, solver, program, scalars, batch, rows };
        run.segments(&solver.segments);
        std::array::from_fn(|k| !self.is_lost[k] && self.multiplier[k] <= LARGEST_MULTIPLIER && self.residual[k] <= 1.0)
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

impl<const W: usize> Run<'_, W> {
    fn segments(&mut self, segments: &[Segment]) {
        for segment in segments {
            match segment {
                Segment::Once(range) => self.instructions(range.clone()),
                Segment::Newton { instructions, tears } => self.newton(instructions.clone(), tears),
            }
        }
    }

    /// Newton from grid point to grid point, until every lane's correction stays in the cell.
    fn newton(&mut self, instructions: Range<usize>, tears: &[Tear]) {
        for iteration in 0..ITERATIONS {
            for tear in tears {
                self.lanes.values[tear.x as usize].0.iter_mut().for_each(|x| *x = on_grid(*x, tear.cell));
            }
            self.instructions(instructions.clone());
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
            if is_settled {
                return;
            }
            if iteration + 1 == ITERATIONS {
                self.give_up(tears);
            }
        }
    }

    /// Lanes that have not settled never will.
    fn give_up(&mut self, tears: &[Tear]) {
        for tear in tears {
            let delta = self.lanes.values[tear.delta as usize].0;
            for (lost, delta) in self.lanes.is_lost.iter_mut().zip(delta) {
                *lost |= delta.abs() > HALF_A_CELL * tear.cell;
            }
        }
    }

    fn instructions(&mut self, range: Range<usize>) {
        let Lanes { values, multiplier, residual, .. } = &mut *self.lanes;
        let (batch, stride) = (self.batch, self.solver.layout.stride);
        let mut numbers = Numbers { v: values.as_mut_slice(), program: self.program, scalars: self.scalars };
        for instruction in &self.solver.instructions[range] {
            // most are operations: one choice of many, and not two
            if let Instruction::Compute(op) = instruction {
                op.run(&mut numbers);
                continue;
            }
            match *instruction {
                Instruction::Compute(_) | Instruction::Pivot { .. } => {}
                Instruction::Number { to, bits } => numbers.write(to, [from_bits(bits); W]),
                Instruction::Load { to, from } => numbers.write(to, [self.scalars.get(from); W]),
                Instruction::Time { to } => numbers.write(to, batch.times),
                Instruction::Column { to, column } => {
                    let rows = self.rows.chunks_exact(stride);
                    for (value, row) in numbers.v[to as usize].0.iter_mut().zip(rows) {
                        *value = row[column as usize];
                    }
                }
                Instruction::Store { column, a } => {
                    let rows = self.rows.chunks_exact_mut(stride);
                    for (value, row) in numbers.v[a as usize].0.iter().zip(rows) {
                        // −0 would surprise a reader
                        row[column as usize] = value + 0.0;
                    }
                }
                Instruction::Curve { to, tear } => numbers.write(to, batch.on_curve(self.solver, tear)),
                Instruction::Multiplier { to, a, b, weight } => {
                    Op::Mul { to, a, b }.run(&mut numbers);
                    keep_largest(multiplier, &numbers.v[to as usize].0, self.solver.weights[weight as usize]);
                }
                Instruction::Residual { a, row } => {
                    keep_largest(residual, &numbers.v[a as usize].0, batch.bounds[row as usize]);
                }
            }
        }
    }
}

impl<const W: usize> Batch<'_, W> {
    /// Where Newton begins with a tear: on the curve of the step.
    fn on_curve(&self, solver: &Solver, tear: u32) -> [f64; W] {
        let curve = &self.curve[solver.tears[tear as usize] as usize];
        let bend = self.bends.get(tear as usize).unwrap_or(&Bend::NONE);
        let per_second = 1.0 / self.length;
        self.times.map(|t| bend.on_curve(curve, (t - self.from) * per_second))
    }
}

/// Registers that hold a number for each lane.
struct Numbers<'n, const W: usize> {
    v: &'n mut [Vector<W>],
    program: &'n Program,
    scalars: &'n Registers,
}

#[allow(clippy::inline_always)] // each is an arm of the loop over instructions
impl<const W: usize> Machine for Numbers<'_, W> {
    type Value = [f64; W];

    #[inline(always)]
    fn read(&mut self, register: Register) -> [f64; W] {
        self.v[register as usize].0
    }

    #[inline(always)]
    fn write(&mut self, register: Register, value: [f64; W]) {
        self.v[register as usize].0 = value;
    }

    #[inline(always)]
    fn add(&mut self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| a[k] + b[k])
    }

    #[inline(always)]
    fn sub(&mut self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| a[k] - b[k])
    }

    #[inline(always)]
    fn mul(&mut self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| a[k] * b[k])
    }

    #[inline(always)]
    fn div(&mut self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| a[k] / b[k])
    }

    // in one go, so that no lane's product is put away

    #[inline(always)]
    fn mul_add(&mut self, a: [f64; W], b: [f64; W], c: [f64; W]) -> [f64; W] {
        from_fn(|k| a[k] * b[k] + c[k])
    }

    #[inline(always)]
    fn mul_less(&mut self, a: [f64; W], b: [f64; W], c: [f64; W]) -> [f64; W] {
        from_fn(|k| a[k] * b[k] - c[k])
    }

    #[inline(always)]
    fn less_mul(&mut self, a: [f64; W], b: [f64; W], c: [f64; W]) -> [f64; W] {
        from_fn(|k| c[k] - a[k] * b[k])
    }

    #[inline(always)]
    fn neg(&mut self, a: [f64; W]) -> [f64; W] {
        a.map(|a| -a)
    }

    #[inline(always)]
    fn recip(&mut self, a: [f64; W]) -> [f64; W] {
        a.map(|a| 1.0 / a)
    }

    #[inline(always)]
    fn sin_cos(&mut self, a: [f64; W]) -> [[f64; W]; 2] {
        math::sin_cos_of_each(&a).into()
    }

    #[inline(always)]
    fn unary(&mut self, function: Unary, a: [f64; W]) -> [f64; W] {
        a.map(|a| unary_value(function, a))
    }

    #[inline(always)]
    fn binary(&mut self, function: Binary, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| binary_value(function, a[k], b[k]))
    }

    #[inline(always)]
    fn compare(&mut self, comparison: Comparison, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| compare(comparison, a[k], b[k]))
    }

    #[inline(always)]
    fn and(&mut self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| truth::and(a[k], b[k]))
    }

    #[inline(always)]
    fn or(&mut self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| truth::or(a[k], b[k]))
    }

    #[inline(always)]
    fn not(&mut self, a: [f64; W]) -> [f64; W] {
        a.map(truth::not)
    }

    #[inline(always)]
    fn select(&mut self, condition: [f64; W], a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| truth::select(condition[k], a[k], b[k]))
    }

    #[inline(always)]
    fn either(&mut self, condition: [f64; W], a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| truth::either(condition[k], a[k], b[k]))
    }

    #[inline(always)]
    fn piece(&mut self, table: u32, a: [f64; W]) -> [f64; W] {
        a.map(|a| self.program.piece(table, a, self.scalars))
    }

    #[inline(always)]
    fn pick(&mut self, table: u32, column: Column, piece: [f64; W]) -> [f64; W] {
        piece.map(|piece| self.program.pick(table, column, piece, self.scalars))
    }
}

/// Keeps the larger of what is known and `|value| factor`; what is not a number stays.
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
