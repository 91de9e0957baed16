//! A step over several output times, whose rows are solved for on its curve, several at once (`solver`).

use super::Upcoming;
use super::single_row::SingleRow;
use crate::analysis::follow::checkpoint::Checkpoint;
use crate::analysis::follow::step::Step;
use crate::analysis::state::{Kinematics, State, are_alike};
use crate::limits::step_control::LARGEST_CORRECTION;
use crate::solver::{Batch, Bend, Lanes, Pivoting, Solver};
use mechc_expr::math::{WIDE, numbers_to_cache_line};
use mechc_ir::layout::RowLayout;
use std::sync::Arc;
#[cfg(feature = "threads")]
use std::sync::{Mutex, PoisonError};
#[cfg(feature = "threads")]
use std::thread::Builder;

/// Number of times in a batch.
const LANES: usize = 16;
/// Smallest number of operations of a solver that is worth a thread.
#[cfg(feature = "threads")]
const WORTH_A_THREAD: usize = 20_000;
/// Maximum number of threads.
#[cfg(feature = "threads")]
const MOST_THREADS: usize = 8;
/// A step below this part of the span is short.
const SHORT: f64 = 1e-4;
/// Times that differ by at most this part of the step are equal.
const SAME_TIME: f64 = 1e-9;
/// Number of rows within a step that show the accuracy of its dense output.
const ENOUGH: u64 = 4;
/// Largest change of a row that is solved again, relative to its size or 1.
const REFINED: f64 = 1e-8;

/// Rows within a step, a few at a time.
pub struct RowBatch {
    solver: Arc<Solver>,
    /// The registers of each thread.
    lanes: Vec<Lanes<LANES>>,
    /// Their rows, from where a line of the processor's memory begins.
    values: Vec<f64>,
    begin: usize,
    holds: Vec<[bool; LANES]>,
    /// Row at the end of a step.
    alone: SingleRow,
    /// A position as a curve that stays there.
    rest: Vec<[f64; 6]>,
    /// Elimination with pivoting, for positions at which the solver's fixed order loses digits; `None` if a block is too large.
    pivoting: Option<Pivoting>,
    /// A state to be solved for with partial pivoting.
    pivoted: State,
    /// The numbers of the times whose rows are there, and of the last one in the step.
    first: u64,
    end: u64,
    last: u64,
    /// Up to this number they hold, with all their columns.
    ready: u64,
    /// Inverse bound of each row of Φ.
    bounds: Vec<f64>,
    has_bounds: bool,
    /// Start of the step.
    origin: Checkpoint,
    length: f64,
    /// Start of the step before, if that led smoothly to this one.
    before: State,
    is_smooth: bool,
    /// Continuation of each tear's curve from the step before.
    bends: Vec<Bend>,
    /// The time that the steps are measured against (s).
    span: f64,
}

/// Returns the number of threads that a solver is worth.
#[cfg(feature = "threads")]
fn threads(solver: &Solver) -> usize {
    if solver.instructions().len() < WORTH_A_THREAD {
        // querying the processors takes as long as a hundred steps of a four-bar
        return 1;
    }
    std::thread::available_parallelism().map_or(1, |n| n.get().min(MOST_THREADS))
}

#[cfg(not(feature = "threads"))]
fn threads(_: &Solver) -> usize {
    1
}

/// Returns the state at a time from a solver's row; it takes what the row does not hold from another state.
pub fn state_of_row(layout: &RowLayout, row: &[f64], like: &State, t: f64) -> State {
    let n = like.q.len();
    let part = |order: usize| row[layout.coordinates[order] as usize..][..n].to_vec();
    let qddd = if layout.has_jerk { part(3) } else { like.qddd.clone() };
    State { t, q: part(0), qd: part(1), qdd: part(2), qddd }
}

impl RowBatch {
    /// Returns a batch with the operations of a solver, for a motion that is at a checkpoint and is measured against a span (s).
    pub fn new(kinematics: &Kinematics, solver: Arc<Solver>, origin: Checkpoint, span: f64) -> RowBatch {
        let threads = threads(&solver);
        let n = kinematics.system().coordinates().len();
        let values = vec![0.0; threads * LANES * solver.layout().stride + WIDE];
        RowBatch {
            lanes: vec![Lanes::for_rows(&solver, kinematics.vectors()); threads],
            begin: numbers_to_cache_line(values.as_ptr()),
            values,
            holds: vec![[false; LANES]; threads],
            alone: SingleRow::new(kinematics, &solver),
            rest: vec![[0.0; 6]; n],
            pivoting: Pivoting::new(&kinematics.determined()),
            pivoted: origin.state().clone(),
            first: 0,
            end: 0,
            last: 0,
            ready: 0,
            bounds: vec![0.0; kinematics.system().rows().len()],
            has_bounds: false,
            before: origin.state().clone(),
            origin,
            length: 0.0,
            is_smooth: false,
            bends: vec![Bend::NONE; solver.tears().len()],
            span,
            solver,
        }
    }

    /// Returns the row of a lane.
    pub fn row(&self, lane: usize) -> &[f64] {
        let layout = self.solver.layout();
        &self.values[self.begin + lane * layout.stride..][..layout.printed]
    }

    /// Returns the row of a lane, to be written.
    pub fn row_mut(&mut self, lane: usize) -> &mut [f64] {
        let layout = self.solver.layout();
        &mut self.values[self.begin + lane * layout.stride..][..layout.printed]
    }

    /// Returns the start of the last dense step.
    pub fn origin(&self) -> &Checkpoint {
        &self.origin
    }

    /// Returns the start time and the length of the last dense step (s).
    pub fn way(&self) -> [f64; 2] {
        [self.origin.state().t, self.length]
    }

    /// Returns whether an output time, by its number, lies within the last dense step.
    pub fn holds_time(&self, number: u64) -> bool {
        number < self.last
    }

    /// Forgets the last dense step.
    pub fn close(&mut self) {
        (self.first, self.end, self.last, self.ready) = (0, 0, 0, 0);
        (self.length, self.is_smooth) = (0.0, false);
    }

    /// Returns whether a step is so short that a correction which is not small shows pivots that do not suit the position, and no bend
    /// of the way.
    pub fn is_short(&self, h: f64) -> bool {
        h <= SHORT * self.span
    }

    /// Solves at the end of a step of length `h` to a time (s), after Taylor's prediction has been made. Returns the distance from that
    /// prediction, scaled, or `None` if the solution does not hold.
    pub fn solve_ahead(&mut self, kinematics: &Kinematics, step: &mut Step, h: f64, t: f64) -> Option<f64> {
        if !self.has_bounds {
            kinematics.write_bounds(&mut self.bounds);
            self.has_bounds = true;
        }
        if !self.solve_beyond(kinematics, step, t) && !self.solve_on_parabola(kinematics, step, h, t) {
            // a solution that is far off needs a shorter step
            let size = self.alone.first_correction();
            return Some(size).filter(|size| *size > LARGEST_CORRECTION && !self.is_short(h));
        }
        let (layout, n) = (self.solver.layout(), step.state().q.len());
        let part = |order: usize| &self.alone.row()[layout.coordinates[order] as usize..][..n];
        let orders = if layout.has_jerk { 0..4 } else { 0..3 };
        Some(step.take_solved(kinematics, orders.map(part)))
    }

    /// Solves at a time from the extrapolated curve of the last step, if that led smoothly to where the motion is: the start is so near to
    /// the solution that it saves an iteration. Returns whether the solution holds.
    fn solve_beyond(&mut self, kinematics: &Kinematics, step: &mut Step, t: f64) -> bool {
        if !self.is_smooth || !self.leads_to(step.t()) {
            return false;
        }
        let [from, length] = self.way();
        let columns = self.solver.tears().iter().map(|&tear| tear as usize);
        step.draw_way_since(self.origin.state(), length, columns);
        let way = Batch { times: [t], from, length, curve: step.curve(), bends: &self.bends, bounds: &self.bounds };
        self.alone.solve(kinematics, &self.solver, &way)
    }

    /// Solves at a time from the parabola of the state's derivatives, for a step of length `h`. Returns whether the solution holds.
    fn solve_on_parabola(&mut self, kinematics: &Kinematics, step: &mut Step, h: f64, t: f64) -> bool {
        step.extrapolate_curve(h, self.solver.tears().iter().map(|&tear| tear as usize));
        self.solve_within(kinematics, step.curve(), [step.t(), h, t])
    }

    /// Returns whether the last step, which was a dense step, ended at a time (s).
    fn leads_to(&self, t: f64) -> bool {
        let [from, length] = self.way();
        length > 0.0 && (from + length - t).abs() <= SAME_TIME * length
    }

    /// Solves at one time of a step from a time and of a length; returns whether the solution holds.
    fn solve_within(&mut self, kinematics: &Kinematics, curve: &[[f64; 6]], [from, length, t]: [f64; 3]) -> bool {
        let way = Batch { times: [t], from, length, curve, bends: &[], bounds: &self.bounds };
        self.alone.solve(kinematics, &self.solver, &way)
    }

    /// Returns the state in the middle of the step that was accepted last, if that was a dense step to where the motion is and can be
    /// solved for there.
    pub fn middle(&mut self, kinematics: &Kinematics, step: &Step) -> Option<State> {
        let [from, length] = self.way();
        let t = 0.5 * from + 0.5 * step.t();
        if !self.leads_to(step.t()) || !self.solve_within(kinematics, step.curve(), [from, length, t]) {
            return None;
        }
        Some(state_of_row(self.solver.layout(), self.alone.row(), step.state(), t))
    }

    /// Returns how far the curve of a step is from the motion: at the first rows within it, or at one probe where there are few.
    pub fn correction_between(
        &mut self,
        kinematics: &Kinematics,
        step: &mut Step,
        upcoming: Upcoming<'_>,
        h: f64,
    ) -> f64 {
        let probe = step.next_probe();
        if self.last - self.first < ENOUGH {
            self.solve_within(kinematics, step.curve(), [step.t(), h, step.t() + probe * h]);
            return self.alone.first_correction();
        }
        self.solve_batch(kinematics, step, upcoming);
        // the first lanes do not depend on the number of threads
        self.lanes[0].first_correction()
    }

    /// Takes note of a step of length `h` to `end`, which was tried and is to be accepted; `take_origin` writes where it begins.
    /// The row at an edge is one of its later side.
    pub fn open(
        &mut self,
        kinematics: &Kinematics,
        step: &Step,
        upcoming: Upcoming<'_>,
        [h, end]: [f64; 2],
        to_edge: bool,
        take_origin: impl FnOnce(&mut Checkpoint),
    ) {
        let Upcoming { times, next } = upcoming;
        let behind = times.first_after(end, next);
        let at_end = to_edge && behind > next && times.at(behind - 1) >= end;
        (self.first, self.end, self.ready) = (next, next, next);
        self.last = if at_end { behind - 1 } else { behind };
        let is_bent = self.is_smooth && self.leads_to(step.t());
        std::mem::swap(&mut self.before, &mut self.origin.mark.state);
        let before = &self.before;
        for (bend, &tear) in self.bends.iter_mut().zip(self.solver.tears()) {
            let k = tear as usize;
            *bend = if is_bent {
                let back = (step.t() - before.t) / h;
                Bend::new(&step.curve()[k], [before.q[k], h * before.qd[k], h * h * before.qdd[k]], back)
            } else {
                Bend::NONE
            };
        }
        (self.length, self.is_smooth) = (h, !to_edge);
        kinematics.write_bounds(&mut self.bounds);
        take_origin(&mut self.origin);
    }

    /// Returns the lane with the row of the next output time, which is within the step; `None` if the row does not hold.
    pub fn lane_of(&mut self, kinematics: &Kinematics, step: &Step, upcoming: Upcoming<'_>) -> Option<usize> {
        let next = upcoming.next;
        if let Some(lane) = self.ready_lane(next) {
            return Some(lane);
        }
        if next >= self.end {
            self.solve_batch(kinematics, step, upcoming);
        }
        let lane = (next - self.first) as usize;
        let is_ready = |lane: &usize| self.is_solved(*lane) && self.is_whole(*lane);
        let behind = (lane..(self.end - self.first) as usize).find(|lane| !is_ready(lane));
        self.ready = behind.map_or(self.end, |lane| self.first + lane as u64);
        (self.is_solved(lane) && (self.is_whole(lane) || self.is_finite(lane))).then_some(lane)
    }

    /// Returns the lane with the row of an output time, by its number, if that row holds with all its columns as far as
    /// [`RowBatch::lane_of`] has looked.
    pub fn ready_lane(&self, number: u64) -> Option<usize> {
        (number < self.ready).then(|| (number - self.first) as usize)
    }

    fn is_solved(&self, lane: usize) -> bool {
        self.holds[lane / LANES][lane % LANES]
    }

    /// Returns whether all numbers of a lane's row are finite, including its measures.
    pub fn is_whole(&self, lane: usize) -> bool {
        self.lanes[lane / LANES].is_finite(lane % LANES)
    }

    /// Returns whether the coordinates of a lane's row and their derivatives are numbers.
    fn is_finite(&self, lane: usize) -> bool {
        let layout = self.solver.layout();
        let row = &self.values[self.begin + lane * layout.stride..][..layout.stride];
        let n = self.bounds.len();
        let mut parts = layout.coordinates[..3].iter().map(|&first| &row[first as usize..][..n]);
        parts.all(|part| part.iter().all(|value| value.is_finite()))
    }

    /// Solves for the next rows of a step, in threads where there is enough to do. Each thread has its times, so the bits do not depend on
    /// their number.
    fn solve_batch(&mut self, kinematics: &Kinematics, step: &Step, Upcoming { times, next }: Upcoming<'_>) {
        let RowBatch { solver, lanes, values, holds, bounds, bends, .. } = self;
        let (first, last) = (next, self.last.min(next + (LANES * lanes.len()) as u64));
        (self.first, self.end) = (first, last);
        let batch = |part: usize| Batch {
            // surplus lanes solve at the last time
            times: std::array::from_fn(|lane| times.at((first + (part * LANES + lane) as u64).min(last - 1))),
            from: self.origin.mark.state.t,
            length: self.length,
            curve: step.curve(),
            bends,
            bounds,
        };
        let (program, registers) = kinematics.program();
        let parts = (last - first).div_ceil(LANES as u64) as usize;
        let solve = |part: usize, lanes: &mut Lanes<LANES>, values: &mut [f64], holds: &mut [bool; LANES]| {
            *holds = lanes.run(solver, program, registers, &batch(part), values);
        };
        let rows = values[self.begin..].chunks_exact_mut(LANES * solver.layout().stride);
        let all = lanes.iter_mut().zip(rows).zip(holds).enumerate().take(parts);
        #[cfg(feature = "threads")]
        if parts > 1 {
            let left = Mutex::new(all);
            let next = || left.lock().unwrap_or_else(PoisonError::into_inner).next();
            let work = || {
                while let Some((part, ((lanes, values), holds))) = next() {
                    solve(part, lanes, values, holds);
                }
            };
            std::thread::scope(|scope| {
                // if the system gives fewer threads, they do all the work
                let _others: Vec<_> = (1..parts).map(|_| Builder::new().spawn_scoped(scope, work)).collect();
                work();
            });
            return;
        }
        all.for_each(|(part, ((lanes, values), holds))| solve(part, lanes, values, holds));
    }

    /// Solves once more for a row that was found otherwise, by the operations that all other rows come from, so that its bits do not depend
    /// on how it was found. The motion stays where it is, `here`.
    pub fn refine(&mut self, kinematics: &mut Kinematics, here: &State, t: f64, row: &mut [f64]) {
        let is_solved = self.solve_at_rest(kinematics, t, row) || self.solve_pivoted(kinematics, here, t, row);
        let (layout, refined) = (self.solver.layout(), self.alone.row());
        let n = here.q.len();
        let part = |order: usize| layout.coordinates[order] as usize..layout.coordinates[order] as usize + n;
        let [found, solved] = [&*row, refined].map(|row| [0, 1, 2].map(|order| &row[part(order)]));
        // if both disagree, the position is too near to a singular one for the grid
        if is_solved && are_alike(kinematics, found, solved, REFINED) {
            for (column, (cell, refined)) in row.iter_mut().zip(refined).enumerate() {
                // a cell that could not be trusted before cannot be now
                if cell.is_finite() || !kinematics.may_be_missing(column) {
                    *cell = *refined;
                }
            }
        }
    }

    /// Solves from the position of a row; returns whether the solution holds.
    fn solve_at_rest(&mut self, kinematics: &Kinematics, t: f64, row: &[f64]) -> bool {
        kinematics.write_bounds(&mut self.bounds);
        for (rest, q) in self.rest.iter_mut().zip(self.solver.layout().position(row)) {
            rest[0] = *q;
        }
        let rest = Batch { times: [t], from: t, length: 1.0, curve: &self.rest, bends: &[], bounds: &self.bounds };
        self.alone.solve(kinematics, &self.solver, &rest)
    }

    /// Solves from the position of a row with partial pivoting; returns whether it holds.
    fn solve_pivoted(&mut self, kinematics: &mut Kinematics, here: &State, t: f64, row: &[f64]) -> bool {
        let Some(pivoting) = &mut self.pivoting else {
            return false;
        };
        self.pivoted.t = t;
        self.pivoted.q.copy_from_slice(self.solver.layout().position(row));
        let is_solved = kinematics.pivoted_row(pivoting, &mut self.pivoted, &mut self.alone.row_mut()[..row.len()]);
        kinematics.restore(here);
        is_solved
    }
}
