//! Running a solver in several lanes at once: at several times of one mechanism, or for several variants of it (`variants.rs`). Allocates
//! nothing but the registers, once.

use super::predictor::Bend;
use super::{Instruction, LARGEST_MULTIPLIER, Solver, Tear, from_bits};
use mechc_expr::math::grid::{bound_at_first, going_on, next_point, on_grid};
use mechc_expr::math::{self, Vectors, WIDE};
use mechc_ir::program::{LaneMachine, LaneValues, Machine, Program, Register, Registers};
use mechc_ir::tolerances::solving::lanes::{BORDER, ITERATIONS, LARGEST_CORRECTION, MOST_TURNED};
use std::array::from_fn;
use std::ops::Range;

/// Lanes that are gone through together: as many as the widest vector registers hold.
pub const CHUNK: usize = WIDE;

/// Registers for `W` times.
#[derive(Clone, Debug)]
pub struct Lanes<const W: usize> {
    vectors: Vectors,
    values: Vec<LaneValues<W>>,
    /// The columns of rows, to be turned to these; none where that does not pay.
    columns: Vec<LaneValues<W>>,
    checks: RunChecks<W>,
    /// What is seen of what depends on numbers and parameters alone.
    prologue_checks: RunChecks<W>,
}

/// What is seen of each lane in a run.
#[derive(Clone, Debug)]
struct RunChecks<const W: usize> {
    /// The largest multiplier, and the largest part of its bound that a residual takes.
    multiplier: LaneValues<W>,
    residual: LaneValues<W>,
    /// The largest correction, and the largest first one, scaled.
    max_correction: LaneValues<W>,
    first_correction: LaneValues<W>,
    /// With which largest correction Newton ends, in cells.
    bound: LaneValues<W>,
    /// 0 if all that was stored is finite, else not a number.
    finite: LaneValues<W>,
}

impl<const W: usize> RunChecks<W> {
    const CLEAR: RunChecks<W> = {
        let zero = LaneValues([0.0; W]);
        RunChecks {
            multiplier: zero,
            residual: zero,
            max_correction: zero,
            first_correction: zero,
            bound: zero,
            finite: zero,
        }
    };

    /// Goes on from what has been seen of what stays, before there is any correction; bounds are set where Newton begins.
    fn reset_to(&mut self, prologue: &RunChecks<W>) {
        let zero = LaneValues([0.0; W]);
        (self.max_correction, self.first_correction) = (zero, zero);
        (self.multiplier, self.residual, self.finite) = (prologue.multiplier, prologue.residual, prologue.finite);
    }
}

/// What a run reads beside its registers, and where it leaves its results: part by part of its lanes, `P` in each.
pub(super) trait LaneEnvironment<const P: usize> {
    /// How many parts there are.
    fn chunks(&self) -> usize;
    /// The value of one of the program's registers.
    fn loaded(&self, from: Register, chunk: usize) -> [f64; P];
    /// The times (s).
    fn times(&self, chunk: usize) -> [f64; P];
    /// Where Newton begins with a tear.
    fn guess(&self, tear: u32, chunk: usize) -> [f64; P];
    /// What has been left in a column.
    fn stored(&self, column: u32, chunk: usize) -> [f64; P];
    /// Leaves a result in a column, told part by part.
    fn store(&mut self, column: u32, values: impl FnMut(usize) -> [f64; P]);
    /// One over what may be left of a row of `Φ`.
    fn inverse_bound(&self, row: u32) -> f64;
    /// Takes note of one over a pivot.
    fn note_pivot(&mut self, pivot: u32, chunk: usize, inverse: &[f64; P]);
    /// With corrections of up to so many cells Newton ends, where nobody asks for bits; 0 where only the grid point next to the solution will do.
    fn loose_bound(&self) -> f64;
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
        Lanes {
            vectors,
            values: vec![LaneValues([0.0; W]); solver.registers],
            columns: Vec::new(),
            checks: RunChecks::CLEAR,
            prologue_checks: RunChecks::CLEAR,
        }
    }

    /// The same, for rows of which each has its numbers one behind the other ([`Lanes::run`]).
    #[must_use]
    pub fn for_rows(solver: &Solver, vectors: Vectors) -> Lanes<W> {
        let stride = solver.layout.stride;
        let are_transposed = W.is_multiple_of(WIDE) && stride <= MOST_TURNED;
        let columns = vec![LaneValues([0.0; W]); if are_transposed { stride } else { 0 }];
        Lanes { columns, ..Lanes::new(solver, vectors) }
    }

    /// How far the curve was from the solution in the last run: the largest first correction, scaled; not a number if one is not.
    #[must_use]
    pub fn first_correction(&self) -> f64 {
        self.first_corrections().0.iter().copied().fold(0.0, math::max)
    }

    /// Whether all numbers of a lane's row are finite.
    #[must_use]
    pub fn is_finite(&self, lane: usize) -> bool {
        self.checks.finite.0[lane] == 0.0
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
        // all at once: there is work for all of them
        let mut columns = std::mem::take(&mut self.columns);
        self.solve::<W>(
            solver,
            (program, scalars),
            TimesEnvironment { solver, scalars, batch, rows, columns: &mut columns },
        );
        let stride = solver.layout.stride;
        for (group, columns) in columns.chunks_exact(WIDE).enumerate() {
            self.vectors.turn(from_fn(|column| &columns[column].0), rows, (group * WIDE, stride));
        }
        self.columns = columns;
        for (row, t) in rows.chunks_exact_mut(stride).zip(batch.times) {
            row[0] = t;
        }
        let RunChecks { max_correction, multiplier, residual, .. } = &self.checks;
        from_fn(|k| !has_diverged(max_correction.0[k]) && multiplier.0[k] <= LARGEST_MULTIPLIER && residual.0[k] <= 1.0)
    }

    /// Computes what depends on numbers and parameters alone, and leaves what results of it: it stays until they are others.
    pub(super) fn run_prologue<const P: usize>(
        &mut self,
        solver: &Solver,
        program: (&Program, &Registers),
        env: impl LaneEnvironment<P>,
    ) {
        self.checks = RunChecks::CLEAR;
        let vectors = self.vectors;
        let mut run = Run { lanes: self, solver, program, env };
        vectors.run(
            #[inline(always)]
            || run.instructions::<false>(0..solver.prologue_len),
        );
        self.prologue_checks = self.checks.clone();
    }

    /// Solves in the lanes of the parts that there are, of `P` lanes each.
    pub(super) fn solve<const P: usize>(
        &mut self,
        solver: &Solver,
        program: (&Program, &Registers),
        env: impl LaneEnvironment<P>,
    ) {
        self.checks.reset_to(&self.prologue_checks);
        // one lane has nothing to do at once
        let vectors = if W == 1 { Vectors::BASE } else { self.vectors };
        let is_all = env.chunks() == W / P;
        let mut run = Run { lanes: self, solver, program, env };
        if is_all {
            vectors.run(
                #[inline(always)]
                || run.segments::<true>(),
            );
        } else {
            vectors.run(
                #[inline(always)]
                || run.segments::<false>(),
            );
        }
    }

    /// Adds to each lane in which Newton has not settled, an equation is not met, a multiplier is above a part of the largest, or what was
    /// stored is not finite.
    #[inline(always)]
    #[allow(clippy::inline_always, clippy::needless_range_loop)] // compiled for several kinds of processors; by lane it vectorises best
    pub(super) fn add_rejections(&self, fraction: f64, rejections: &mut LaneValues<W>) {
        let limit = fraction * LARGEST_MULTIPLIER;
        let RunChecks { max_correction, residual, multiplier, finite, .. } = &self.checks;
        for chunk in 0..W / CHUNK {
            let (corrections, residuals) = (*max_correction.part::<CHUNK>(chunk), *residual.part::<CHUNK>(chunk));
            let (multipliers, finite) = (*multiplier.part::<CHUNK>(chunk), *finite.part::<CHUNK>(chunk));
            let mut counts = *rejections.part::<CHUNK>(chunk);
            for k in 0..CHUNK {
                let is_settled = corrections[k] <= LARGEST_CORRECTION && residuals[k] <= 1.0;
                let is_certain = multipliers[k] <= limit && finite[k] == 0.0;
                counts[k] += if is_settled & is_certain { 0.0 } else { 1.0 };
            }
            *rejections.part_mut(chunk) = counts;
        }
    }

    /// How far the guess of each lane was from its solution, scaled.
    pub(super) fn first_corrections(&self) -> &LaneValues<W> {
        &self.checks.first_correction
    }
}

/// Several times of one mechanism, and a row for each.
struct TimesEnvironment<'r, const W: usize> {
    solver: &'r Solver,
    scalars: &'r Registers,
    batch: &'r Batch<'r, W>,
    rows: &'r mut [f64],
    /// What is turned to rows when all is there; none where it goes there at once.
    columns: &'r mut [LaneValues<W>],
}

#[allow(clippy::inline_always)] // as all that `Lanes::solve` does
impl<const W: usize, const P: usize> LaneEnvironment<P> for TimesEnvironment<'_, W> {
    #[inline(always)]
    fn chunks(&self) -> usize {
        W / P
    }

    #[inline(always)]
    fn loaded(&self, from: Register, _: usize) -> [f64; P] {
        [self.scalars.get(from); P]
    }

    #[inline(always)]
    fn times(&self, chunk: usize) -> [f64; P] {
        self.batch.times.as_chunks().0[chunk]
    }

    #[inline(always)]
    fn guess(&self, tear: u32, chunk: usize) -> [f64; P] {
        self.batch.on_curve(self.solver, tear, chunk)
    }

    #[inline(always)]
    fn stored(&self, column: u32, chunk: usize) -> [f64; P] {
        if let Some(column) = self.columns.get(column as usize) {
            return *column.part(chunk);
        }
        let stride = self.solver.layout.stride;
        let (mut at, mut values) = (column as usize + chunk * P * stride, [0.0; P]);
        for value in &mut values {
            *value = self.rows[at];
            at += stride;
        }
        values
    }

    #[inline(always)]
    fn store(&mut self, column: u32, mut values: impl FnMut(usize) -> [f64; P]) {
        if let Some(column) = self.columns.get_mut(column as usize) {
            for chunk in 0..W / P {
                *column.part_mut(chunk) = values(chunk);
            }
            return;
        }
        let (mut at, stride) = (column as usize, self.solver.layout.stride);
        for chunk in 0..W / P {
            for value in values(chunk) {
                self.rows[at] = value;
                at += stride;
            }
        }
    }

    #[inline(always)]
    fn inverse_bound(&self, row: u32) -> f64 {
        self.batch.bounds[row as usize]
    }

    #[inline(always)]
    fn note_pivot(&mut self, _: u32, _: usize, _: &[f64; P]) {}

    #[inline(always)]
    fn loose_bound(&self) -> f64 {
        0.0
    }
}

struct Run<'r, A, const W: usize, const P: usize> {
    lanes: &'r mut Lanes<W>,
    solver: &'r Solver,
    program: (&'r Program, &'r Registers),
    env: A,
}

// All of it becomes part of `Lanes::solve`, once for each kind of vector instructions.
#[allow(clippy::inline_always)]
impl<A: LaneEnvironment<P>, const W: usize, const P: usize> Run<'_, A, W, P> {
    #[inline(always)]
    fn segments<const ALL: bool>(&mut self) {
        for segment in &self.solver.segments {
            let tears = segment.tears();
            self.snap_guesses(tears);
            for iteration in 0..ITERATIONS {
                self.instructions::<ALL>(segment.range());
                // what is run once is done then
                if tears.is_empty() || self.newton_step(tears, iteration) {
                    break;
                }
            }
            self.apply_corrections(tears);
        }
    }

    /// Newton begins at the grid points next to its guesses.
    #[inline(always)]
    fn snap_guesses(&mut self, tears: &[Tear]) {
        let loose_bound = self.env.loose_bound();
        self.lanes.checks.bound = LaneValues([if loose_bound > 0.0 { loose_bound } else { bound_at_first(BORDER) }; W]);
        for tear in tears {
            let x = &mut self.lanes.values[tear.x as usize];
            for chunk in 0..self.env.chunks() {
                x.part_mut::<P>(chunk).iter_mut().for_each(|x| *x = on_grid(*x, tear.cell));
            }
        }
    }

    /// Goes on to the next grid points in the lanes that have not settled; says whether there are none.
    #[inline(always)]
    fn newton_step(&mut self, tears: &[Tear], iteration: usize) -> bool {
        let mut has_settled = true;
        for chunk in 0..self.env.chunks() {
            has_settled &= self.newton_step_in(chunk, tears, iteration);
        }
        has_settled
    }

    /// The same in a part of the lanes (`math/grid.rs`). A lane that has settled stays where it is, whatever the others do.
    #[inline(always)]
    fn newton_step_in(&mut self, chunk: usize, tears: &[Tear], iteration: usize) -> bool {
        let loose_bound = self.env.loose_bound();
        let Lanes { values, checks, .. } = &mut *self.lanes;
        let (mut in_cells, mut scaled) = ([0.0; P], [0.0; P]);
        for tear in tears {
            let delta = values[tear.delta as usize].part(chunk);
            keep_max(&mut in_cells, delta, tear.per_cell);
            keep_max(&mut scaled, delta, tear.per_scale);
        }
        let mut max_correction = *checks.max_correction.part(chunk);
        keep_max(&mut max_correction, &scaled, 1.0);
        *checks.max_correction.part_mut(chunk) = max_correction;
        if iteration == 0 {
            keep_max(checks.first_correction.part_mut(chunk), &scaled, 1.0);
        }
        let (mut bound, mut moves) = (*checks.bound.part::<P>(chunk), [0.0_f64; P]);
        for k in 0..P {
            // those that are lost stay where they are
            let (is_beyond, is_near) = (in_cells[k] > bound[k], max_correction[k] <= LARGEST_CORRECTION);
            moves[k] = if is_beyond & is_near { 1.0 } else { 0.0 };
        }
        // mostly none does, which is seen in all lanes at once
        if moves.iter().fold(0, |open, moves| open | moves.to_bits()) == 0 {
            *checks.bound.part_mut(chunk) = [f64::INFINITY; P];
            return true;
        }
        // by lane: the cells, in cells, among whose points coordinates next to a border go on; 0 where all stay
        let mut cells = [0.0; P];
        for k in 0..P {
            let (next, width) = going_on(in_cells[k], bound[k], BORDER);
            let next = if loose_bound > 0.0 { loose_bound } else { next };
            bound[k] = if moves[k] == 0.0 { f64::INFINITY } else { next };
            cells[k] = if moves[k] == 0.0 { 0.0 } else { width };
        }
        *checks.bound.part_mut(chunk) = bound;
        for tear in tears {
            let delta = *values[tear.delta as usize].part::<P>(chunk);
            let x = values[tear.x as usize].part_mut::<P>(chunk);
            for k in 0..P {
                let next = next_point(x[k], delta[k], tear.cell, cells[k], BORDER);
                x[k] = if cells[k] > 0.0 { next } else { x[k] };
            }
        }
        if iteration + 1 == ITERATIONS {
            // lanes that have not settled never will
            for (max_correction, cells) in checks.max_correction.part_mut::<P>(chunk).iter_mut().zip(cells) {
                *max_correction = if cells > 0.0 { f64::INFINITY } else { *max_correction };
            }
        }
        false
    }

    /// From the last grid points the corrections lead to the solution.
    #[inline(always)]
    fn apply_corrections(&mut self, tears: &[Tear]) {
        for tear in tears {
            for chunk in 0..self.env.chunks() {
                let delta = *self.lanes.values[tear.delta as usize].part::<P>(chunk);
                let x = self.lanes.values[tear.x as usize].part_mut::<P>(chunk);
                x.iter_mut().zip(delta).for_each(|(x, delta)| *x += delta);
            }
        }
    }

    #[inline(always)]
    fn instructions<const ALL: bool>(&mut self, range: Range<usize>) {
        let Lanes { values, checks, .. } = &mut *self.lanes;
        let env = &mut self.env;
        let mut machine = LaneMachine::<W, P, ALL>::new(values, env.chunks(), self.program);
        let chunks = machine.parts();
        for instruction in &self.solver.instructions[range] {
            // most are operations: one choice of many, and not two
            if let Instruction::Compute(op) = instruction {
                op.run(&mut machine);
                continue;
            }
            macro_rules! by_chunk {
                ($chunk:ident, $does:expr) => {
                    for $chunk in 0..chunks {
                        machine.go_to($chunk);
                        $does;
                    }
                };
            }
            match *instruction {
                Instruction::Compute(_) => {}
                Instruction::Pivot { a, pivot } => by_chunk!(chunk, env.note_pivot(pivot, chunk, &machine.read(a))),
                Instruction::Number { to, bits } => by_chunk!(chunk, machine.write(to, [from_bits(bits); P])),
                Instruction::Load { to, from } => by_chunk!(chunk, machine.write(to, env.loaded(from, chunk))),
                Instruction::Time { to } => by_chunk!(chunk, machine.write(to, env.times(chunk))),
                Instruction::Column { to, column } => by_chunk!(chunk, machine.write(to, env.stored(column, chunk))),
                Instruction::Store { column, a } => env.store(column, |chunk| {
                    machine.go_to(chunk);
                    // −0 would surprise a reader
                    let values = machine.read(a).map(|value| value + 0.0);
                    for (finite, value) in checks.finite.part_mut::<P>(chunk).iter_mut().zip(values) {
                        *finite += 0.0 * value;
                    }
                    values
                }),
                Instruction::Curve { to, tear } => by_chunk!(chunk, machine.write(to, env.guess(tear, chunk))),
                Instruction::Multiplier { to, a, b, weight } => by_chunk!(chunk, {
                    let (a, b) = (machine.read(a), machine.read(b));
                    let product = machine.mul(a, b);
                    machine.write(to, product);
                    keep_max(checks.multiplier.part_mut(chunk), &product, self.solver.weights[weight as usize]);
                }),
                Instruction::Residual { a, row } => by_chunk!(chunk, {
                    keep_max(checks.residual.part_mut(chunk), &machine.read(a), env.inverse_bound(row));
                }),
            }
        }
    }
}

impl<const W: usize> Batch<'_, W> {
    /// Where Newton begins with a tear: on the curve of the step.
    #[inline(always)]
    #[allow(clippy::inline_always)] // as all that `Lanes::solve` does
    fn on_curve<const P: usize>(&self, solver: &Solver, tear: u32, chunk: usize) -> [f64; P] {
        let curve = &self.curve[solver.tears[tear as usize] as usize];
        let bend = self.bends.get(tear as usize).unwrap_or(&Bend::NONE);
        let per_second = 1.0 / self.length;
        let mut values = self.times.as_chunks().0[chunk];
        // no closure, which would be compiled for every processor
        for value in &mut values {
            *value = bend.on_curve(curve, (*value - self.from) * per_second);
        }
        values
    }
}

/// Whether an iteration has gone astray whose largest correction, scaled, is this.
#[inline(always)]
#[allow(clippy::inline_always)] // as all that `Lanes::solve` does
fn has_diverged(max_correction: f64) -> bool {
    max_correction.is_nan() || max_correction > LARGEST_CORRECTION
}

/// Keeps the larger of what is known and `|value| factor`; what is not a number stays.
#[inline(always)]
#[allow(clippy::inline_always)] // as all that `Lanes::solve` does
fn keep_max<const W: usize>(largest: &mut [f64; W], values: &[f64; W], factor: f64) {
    for (largest, value) in largest.iter_mut().zip(values) {
        *largest = math::max(*largest, value.abs() * factor);
    }
}

#[cfg(test)]
mod tests {
    use super::keep_max;

    #[test]
    fn nan_stays_the_maximum() {
        let mut largest = [0.0; 2];
        for values in [[1.0, f64::NAN], [f64::NAN, -3.0], [2.0, 2.0]] {
            keep_max(&mut largest, &values, 0.5);
        }
        assert!(largest.iter().all(|size| size.is_nan()), "{largest:?}");
    }
}
