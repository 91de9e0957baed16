//! Running a solver at several times at once. Allocates nothing but the registers, once.

use super::curve::Bend;
use super::tape::Op;
use super::{LARGEST_MULTIPLIER, Segment, Solver, Tear};
use crate::expr::{binary_value, compare, unary_value};
use crate::math;
use crate::program::{self, Program, Register, Registers};
use crate::tolerances::solving::lanes::{HALF_A_CELL, ITERATIONS, LARGEST_CORRECTION};

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
        self.first_correction.iter().fold(0.0, |largest, &size| if size <= largest { largest } else { size })
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
                Segment::Once(range) => self.operations(range.clone()),
                Segment::Newton { operations, tears } => self.newton(operations.clone(), tears),
            }
        }
    }

    /// Newton from grid point to grid point, until every lane's correction stays in the cell.
    fn newton(&mut self, operations: Range<usize>, tears: &[Tear]) {
        for iteration in 0..ITERATIONS {
            for tear in tears {
                self.lanes.values[tear.x as usize].0.iter_mut().for_each(|x| *x = on_grid(*x, tear.cell));
            }
            self.operations(operations.clone());
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

    fn operations(&mut self, range: Range<usize>) {
        let lanes = &mut *self.lanes;
        let v = lanes.values.as_mut_slice();
        for op in &self.solver.operations[range] {
            match *op {
                Op::Add { to, a, b } => combine(v, to, a, b, |a, b| a + b),
                Op::Sub { to, a, b } => combine(v, to, a, b, |a, b| a - b),
                Op::Mul { to, a, b } => combine(v, to, a, b, |a, b| a * b),
                Op::MulAdd { to, a, b, c } => combine_three(v, to, a, b, c, |a, b, c| a * b + c),
                Op::MulLess { to, a, b, c } => combine_three(v, to, a, b, c, |a, b, c| a * b - c),
                Op::LessMul { to, a, b, c } => combine_three(v, to, a, b, c, |a, b, c| c - a * b),
                Op::Div { to, a, b } => combine(v, to, a, b, |a, b| a / b),
                Op::Neg { to, a } => apply(v, to, a, |a| -a),
                Op::Recip { to, a } => apply(v, to, a, |a| 1.0 / a),
                Op::SinCos { sin, cos, a } => {
                    (v[sin as usize].0, v[cos as usize].0) = math::sin_cos_of_each(&v[a as usize].0);
                }
                Op::Multiplier { to, a, b, weight } => {
                    combine(v, to, a, b, |a, b| a * b);
                    let weight = self.solver.weights[weight as usize];
                    keep_largest(&mut lanes.multiplier, &v[to as usize].0, weight);
                }
                Op::Residual { a, row } => {
                    keep_largest(&mut lanes.residual, &v[a as usize].0, self.batch.bounds[row as usize]);
                }
                Op::Pivot { .. } => {}
                Op::Number { to, bits: [low, high] } => {
                    v[to as usize] = Vector([f64::from_bits(u64::from(low) | (u64::from(high) << 32)); W]);
                }
                Op::Load { to, from } => v[to as usize] = Vector([self.scalars.get(from); W]),
                Op::Time { to } => v[to as usize] = Vector(self.batch.times),
                Op::Column { to, column } => {
                    let rows = self.rows.chunks_exact(self.solver.layout.stride);
                    for (value, row) in v[to as usize].0.iter_mut().zip(rows) {
                        *value = row[column as usize];
                    }
                }
                Op::Store { column, a } => {
                    let rows = self.rows.chunks_exact_mut(self.solver.layout.stride);
                    for (value, row) in v[a as usize].0.iter().zip(rows) {
                        // −0 would surprise a reader
                        row[column as usize] = value + 0.0;
                    }
                }
                Op::Curve { to, tear } => {
                    let column = self.solver.tears[tear as usize] as usize;
                    let curve = &self.batch.curve[column];
                    let bend = self.batch.bends.get(tear as usize).unwrap_or(&Bend::NONE);
                    let (from, per_second) = (self.batch.from, 1.0 / self.batch.length);
                    v[to as usize] = Vector(self.batch.times.map(|t| bend.on_curve(curve, (t - from) * per_second)));
                }
                Op::Other(op) => other(v, op, self.program, self.scalars),
            }
        }
    }
}

fn apply<const W: usize>(v: &mut [Vector<W>], to: Register, a: Register, f: impl Fn(f64) -> f64) {
    let a = &v[a as usize].0;
    let result = std::array::from_fn(|k| f(a[k]));
    v[to as usize].0 = result;
}

fn combine<const W: usize>(v: &mut [Vector<W>], to: Register, a: Register, b: Register, f: impl Fn(f64, f64) -> f64) {
    let (a, b) = (&v[a as usize].0, &v[b as usize].0);
    let result = std::array::from_fn(|k| f(a[k], b[k]));
    v[to as usize].0 = result;
}

fn combine_three<const W: usize>(
    v: &mut [Vector<W>],
    to: Register,
    a: Register,
    b: Register,
    c: Register,
    f: impl Fn(f64, f64, f64) -> f64,
) {
    let (a, b, c) = (&v[a as usize].0, &v[b as usize].0, &v[c as usize].0);
    let result = std::array::from_fn(|k| f(a[k], b[k], c[k]));
    v[to as usize].0 = result;
}

/// Keeps the larger of what is known and `|value| factor`; what is not a number wins.
fn keep_largest<const W: usize>(largest: &mut [f64; W], values: &[f64; W], factor: f64) {
    for (largest, value) in largest.iter_mut().zip(values) {
        let size = value.abs() * factor;
        *largest = if size <= *largest { *largest } else { size };
    }
}

/// An operation that has no lanes of its own.
fn other<const W: usize>(v: &mut [Vector<W>], op: program::Op, program: &Program, scalars: &Registers) {
    use program::Op as P;
    let truth = |is_true: bool| f64::from(is_true);
    match op {
        P::Unary { function, to, a } => apply(v, to, a, |a| unary_value(function, a)),
        P::Binary { function, to, a, b } => combine(v, to, a, b, |a, b| binary_value(function, a, b)),
        P::Compare { comparison, to, a, b } => combine(v, to, a, b, |a, b| compare(comparison, a, b)),
        P::And { to, a, b } => combine(v, to, a, b, |a, b| truth(a != 0.0 && b != 0.0)),
        P::Or { to, a, b } => combine(v, to, a, b, |a, b| truth(a != 0.0 || b != 0.0)),
        P::Not { to, a } => apply(v, to, a, |a| truth(a == 0.0)),
        P::Select { to, condition, a, b } => {
            combine_three(v, to, condition, a, b, |condition, a, b| if condition == 0.0 { b } else { a });
        }
        P::Either { to, condition, a, b } => combine_three(v, to, condition, a, b, program::either),
        P::Piece { to, table, a } => apply(v, to, a, |a| program.piece(table, a, scalars)),
        P::Pick { to, table, column, piece } => {
            apply(v, to, piece, |piece| program.pick(table, column, piece, scalars));
        }
        // these are laid out as operations of lanes
        P::Add { .. }
        | P::Sub { .. }
        | P::Mul { .. }
        | P::Div { .. }
        | P::Neg { .. }
        | P::Recip { .. }
        | P::SinCos { .. }
        | P::Copy { .. } => unreachable!("{op:?} is laid out otherwise"),
    }
}
