//! Runs a solver in several lanes: at several times of one mechanism, or for several variants of it (`variants.rs`). Allocates only the registers,
//! once.

use super::predictor::Bend;
use super::{Instruction, LARGEST_MULTIPLIER, Solver, Tear, from_bits};
use crate::limits::lanes::{BORDER, ITERATIONS};
use crate::limits::step_control::LARGEST_CORRECTION;
use mechc_expr::math::grid::{bound_at_first, going_on, next_point, on_grid};
use mechc_expr::math::{self, Vectors, WIDE};
use mechc_ir::program::{LaneMachine, LaneValues, Machine, Program, Register, Registers};
use std::array::from_fn;
use std::ops::Range;

/// Largest number of values per row that is transposed from columns: more would not stay in the cache.
const MOST_TURNED: usize = 2_048;

/// The number of lanes in a chunk, which are executed together: that of the widest vector registers.
pub const CHUNK: usize = WIDE;

/// The registers of a solver in `W` lanes.
#[derive(Clone, Debug)]
pub struct Lanes<const W: usize> {
    vectors: Vectors,
    values: Vec<LaneValues<W>>,
    /// The columns of rows, to be transposed into these; empty if that does not pay.
    columns: Vec<LaneValues<W>>,
    checks: RunChecks<W>,
    /// The checks of the prologue, which stay valid until its next run.
    prologue_checks: RunChecks<W>,
}

/// The checks of a run, by lane.
#[derive(Clone, Debug)]
struct RunChecks<const W: usize> {
    /// The largest scaled multiplier, and the largest ratio of a residual to its bound.
    multiplier: LaneValues<W>,
    residual: LaneValues<W>,
    /// The largest correction, and the largest first one, scaled.
    max_correction: LaneValues<W>,
    first_correction: LaneValues<W>,
    /// The largest correction with which Newton ends, in cells.
    bound: LaneValues<W>,
    /// 0 if all stored values are finite, else NaN.
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

    /// Resets to the checks of the prologue, without corrections. Bounds are set when Newton begins.
    fn reset_to(&mut self, prologue: &RunChecks<W>) {
        let zero = LaneValues([0.0; W]);
        (self.max_correction, self.first_correction) = (zero, zero);
        (self.multiplier, self.residual, self.finite) = (prologue.multiplier, prologue.residual, prologue.finite);
    }
}

/// The inputs and outputs of a run other than its registers, by chunk of `P` lanes.
pub(super) trait LaneEnvironment<const P: usize> {
    /// Returns the number of chunks to execute.
    fn chunks(&self) -> usize;
    /// Returns the value of a register of the program.
    fn loaded(&self, from: Register, chunk: usize) -> [f64; P];
    /// Returns the times (s).
    fn times(&self, chunk: usize) -> [f64; P];
    /// Returns the initial guess for a tear.
    fn guess(&self, tear: u32, chunk: usize) -> [f64; P];
    /// Returns the stored value of a column.
    fn stored(&self, column: u32, chunk: usize) -> [f64; P];
    /// Stores a column; `values` returns its values by chunk.
    fn store(&mut self, column: u32, values: impl FnMut(usize) -> [f64; P]);
    /// Returns the inverse of the bound on the residual of a row of `Φ`.
    fn inverse_bound(&self, row: u32) -> f64;
    /// Records the inverse of a pivot.
    fn note_pivot(&mut self, pivot: u32, chunk: usize, inverse: &[f64; P]);
    /// Records the value of a monitor.
    fn note_monitor(&mut self, monitor: u32, chunk: usize, value: &[f64; P]);
    /// Returns the largest correction, in cells, with which Newton ends if bits do not matter; 0 if only the grid point next to the solution will do.
    fn loose_bound(&self) -> f64;
}

/// The times to solve at, with the step that contains them.
#[derive(Clone, Copy, Debug)]
pub struct Batch<'b, const W: usize> {
    /// The times (s), ascending, all within the step.
    pub times: [f64; W],
    /// The start of the step (s).
    pub from: f64,
    /// The length of the step (s).
    pub length: f64,
    /// By coordinate: a polynomial in the fraction of the step, its coefficients.
    pub curve: &'b [[f64; 6]],
    /// By tear: the correction of its curve from the step before; empty without one.
    pub bends: &'b [Bend],
    /// By row of `Φ`: the inverse of the bound on its residual.
    pub bounds: &'b [f64],
}

impl<const W: usize> Lanes<W> {
    /// Allocates the registers for a solver, which runs with the given vector instructions.
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

    /// Allocates the registers for a solver that writes contiguous rows ([`Lanes::run`]).
    #[must_use]
    pub fn for_rows(solver: &Solver, vectors: Vectors) -> Lanes<W> {
        let stride = solver.layout.stride;
        let is_transposed = W.is_multiple_of(WIDE) && stride <= MOST_TURNED;
        let columns = vec![LaneValues([0.0; W]); if is_transposed { stride } else { 0 }];
        Lanes { columns, ..Lanes::new(solver, vectors) }
    }

    /// Returns the largest first correction of the last run, scaled: the error of the initial guess; NaN if a correction is NaN.
    #[must_use]
    pub fn first_correction(&self) -> f64 {
        self.first_corrections().0.iter().copied().fold(0.0, math::max)
    }

    /// Returns whether all numbers in the row of a lane are finite.
    #[must_use]
    pub fn is_finite(&self, lane: usize) -> bool {
        self.checks.finite.0[lane] == 0.0
    }

    /// Solves at the times of a batch and writes their rows, one after the other. Returns the lanes that are accepted: Newton has converged, every
    /// residual is within its bound, and no multiplier is too large.
    ///
    /// `scalars` are the program's registers, with the switches of this step.
    pub fn run(
        &mut self,
        solver: &Solver,
        program: &Program,
        scalars: &Registers,
        batch: &Batch<'_, W>,
        rows: &mut [f64],
    ) -> [bool; W] {
        // all lanes in one chunk
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

    /// Runs the prologue, the instructions that depend on numbers and parameters alone. Its results stay until its next run.
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

    /// Runs the solver in the chunks of `env`, of `P` lanes each.
    pub(super) fn solve<const P: usize>(
        &mut self,
        solver: &Solver,
        program: (&Program, &Registers),
        env: impl LaneEnvironment<P>,
    ) {
        self.checks.reset_to(&self.prologue_checks);
        // vector instructions do not pay for one lane
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

    /// Increments the count of each lane that is rejected: Newton has not converged, a residual exceeds its bound, a multiplier exceeds a fraction of
    /// its limit, or a stored value is not finite.
    #[inline(always)]
    #[allow(clippy::inline_always, clippy::needless_range_loop)] // compiled for several vector instruction sets; lane indices vectorise best
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

    /// Returns by lane the error of the initial guess, scaled.
    pub(super) fn first_corrections(&self) -> &LaneValues<W> {
        &self.checks.first_correction
    }
}

/// Several times of one mechanism, with a row for each.
struct TimesEnvironment<'r, const W: usize> {
    solver: &'r Solver,
    scalars: &'r Registers,
    batch: &'r Batch<'r, W>,
    rows: &'r mut [f64],
    /// The columns that are transposed into rows at the end; empty if results are stored in the rows at once.
    columns: &'r mut [LaneValues<W>],
}

#[allow(clippy::inline_always)] // inlined into `Lanes::solve`
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
    fn note_monitor(&mut self, _: u32, _: usize, _: &[f64; P]) {}

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

// All of it is inlined into `Lanes::solve`, once for each set of vector instructions.
#[allow(clippy::inline_always)]
impl<A: LaneEnvironment<P>, const W: usize, const P: usize> Run<'_, A, W, P> {
    #[inline(always)]
    fn segments<const ALL: bool>(&mut self) {
        for segment in &self.solver.segments {
            let tears = segment.tears();
            self.snap_guesses(tears);
            for iteration in 0..ITERATIONS {
                self.instructions::<ALL>(segment.range());
                // a segment without tears runs once
                if tears.is_empty() || self.newton_step(tears, iteration) {
                    break;
                }
            }
            self.apply_corrections(tears);
        }
    }

    /// Moves the initial guesses to the nearest grid points.
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

    /// Moves to the next grid points in the lanes that have not converged; returns whether all have.
    #[inline(always)]
    fn newton_step(&mut self, tears: &[Tear], iteration: usize) -> bool {
        let mut has_settled = true;
        for chunk in 0..self.env.chunks() {
            has_settled &= self.newton_step_in(chunk, tears, iteration);
        }
        has_settled
    }

    /// Does a Newton step in a chunk of lanes (`crates/runtime/src/grid.rs`). A converged lane no longer moves, whatever the others do.
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
            // diverged lanes do not move either
            let (is_beyond, is_near) = (in_cells[k] > bound[k], max_correction[k] <= LARGEST_CORRECTION);
            moves[k] = if is_beyond & is_near { 1.0 } else { 0.0 };
        }
        // mostly no lane moves, which one test for all lanes shows
        if moves.iter().fold(0, |open, moves| open | moves.to_bits()) == 0 {
            *checks.bound.part_mut(chunk) = [f64::INFINITY; P];
            return true;
        }
        // by lane: the spacing, in cells, of the points to which coordinates next to a border move; 0 for lanes that do not move
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
            // lanes that still move have not converged
            for (max_correction, cells) in checks.max_correction.part_mut::<P>(chunk).iter_mut().zip(cells) {
                *max_correction = if cells > 0.0 { f64::INFINITY } else { *max_correction };
            }
        }
        false
    }

    /// Adds the last corrections to the last grid points, which gives the solution.
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
            // most instructions are operations, which are dispatched once and not twice
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
                Instruction::Monitor { a, monitor } => {
                    by_chunk!(chunk, env.note_monitor(monitor, chunk, &machine.read(a)));
                }
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
    /// Returns the initial guess for a tear, on the curve of the step.
    #[inline(always)]
    #[allow(clippy::inline_always)] // inlined into `Lanes::solve`
    fn on_curve<const P: usize>(&self, solver: &Solver, tear: u32, chunk: usize) -> [f64; P] {
        let curve = &self.curve[solver.tears[tear as usize] as usize];
        let bend = self.bends.get(tear as usize).unwrap_or(&Bend::NONE);
        let per_second = 1.0 / self.length;
        let mut values = self.times.as_chunks().0[chunk];
        // no closure, which would be compiled without the vector instructions
        for value in &mut values {
            *value = bend.on_curve(curve, (*value - self.from) * per_second);
        }
        values
    }
}

/// Returns whether an iteration with this largest scaled correction has diverged.
#[inline(always)]
#[allow(clippy::inline_always)] // inlined into `Lanes::solve`
fn has_diverged(max_correction: f64) -> bool {
    max_correction.is_nan() || max_correction > LARGEST_CORRECTION
}

/// Updates a maximum with `|value| factor`; NaN stays.
#[inline(always)]
#[allow(clippy::inline_always)] // inlined into `Lanes::solve`
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
