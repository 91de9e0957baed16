//! A row for each output time.
//!
//! Where the motion is calm a step goes over as many output times as it may, and when it is accepted their rows are solved
//! for on its curve, several at once (`solver`). Near a singular position, and where such a row does not hold, steps go to each
//! time on its own.

use super::determinant::Determinant;
use super::edges::{Edge, behind_start, shortly_after};
use super::errors;
use super::kinematics::{Fault, Kinematics, State};
use super::march::{Accepted, Motion, along};
use super::singular;
use super::times::Times;
use super::trust::Trust;
use crate::diag::Diagnostic;
use crate::layout::RowLayout;
use crate::solver::{Batch, Bend, Lanes, Pivoting, Solver};
use crate::tolerances::solving::rows::{ENOUGH, LANES, REFINED, SHORT, STEPS_AHEAD};
#[cfg(feature = "threads")]
use crate::tolerances::solving::rows::{MOST_THREADS, WORTH_A_THREAD};
use crate::tolerances::steps::march::{FEWEST_STEPS_NEAR, LARGEST_BETWEEN, LARGEST_CORRECTION, MOST_STEPS};
use std::sync::Arc;

/// The output times, and the rows that are ready.
pub(super) struct Output {
    times: Times,
    /// The number of the time that comes next.
    next: u64,
    /// Whether the motion could not go on.
    has_stopped: bool,
    /// Steps since the last row.
    steps: u64,
    /// Up to this time (s) steps go to each output time on their own.
    careful_until: f64,
    /// Whether a step may go over several output times.
    may_leap: bool,
    rows: Option<Rows>,
    /// By measure, and then by variable that derivatives are taken by.
    missing: Vec<Missing>,
    /// The edge that the last step ended at, if its later side has not been taken yet.
    edge: Option<Edge>,
}

/// The rows in which a measure has no value.
#[derive(Clone, Copy)]
struct Missing {
    /// Times of the first and the last of them (s).
    first: f64,
    last: f64,
    rows: u64,
    is_told: bool,
}

impl Missing {
    const NEVER: Missing = Missing { first: 0.0, last: f64::NAN, rows: 0, is_told: false };

    /// A cell of a row at a time; several of one row count once.
    fn take_note(&mut self, t: f64) {
        if self.rows == 0 {
            self.first = t;
        }
        if self.last.total_cmp(&t).is_ne() {
            (self.last, self.rows) = (t, self.rows + 1);
        }
    }
}

/// Rows within a step, a few at a time.
struct Rows {
    solver: Arc<Solver>,
    /// The registers of each thread.
    lanes: Vec<Lanes<LANES>>,
    values: Vec<f64>,
    holds: Vec<[bool; LANES]>,
    /// For the end of a step.
    alone: Lanes<1>,
    alone_row: Vec<f64>,
    /// A position as a curve that stays there.
    rest: Vec<[f64; 6]>,
    /// Where the solver's order of elimination loses digits; none where a block is too large.
    pivoting: Option<Pivoting>,
    /// The numbers of the times whose rows are there, and of the last one in the step.
    first: u64,
    end: u64,
    last: u64,
    /// What may be left of each row of Φ, as its inverse.
    bounds: Vec<f64>,
    has_bounds: bool,
    /// Where the step begins.
    origin: Bookmark,
    length: f64,
    /// Where the step before began, if it led smoothly to this one.
    before: State,
    is_smooth: bool,
    /// How the curve of each tear goes on from the step before.
    bends: Vec<Bend>,
}

impl Rows {
    /// Solves at one time, of a step from a time and of a length; says whether it holds.
    fn solve_alone(&mut self, kinematics: &Kinematics, curve: &[[f64; 6]], [from, length, t]: [f64; 3]) -> bool {
        let batch = Batch { times: [t], from, length, curve, bends: &[], bounds: &self.bounds };
        let (program, registers) = kinematics.program();
        let [holds] = self.alone.run(&self.solver, program, registers, &batch, &mut self.alone_row);
        holds
    }

    /// Whether the coordinates of a lane's row and their derivatives are numbers.
    fn is_finite(&self, lane: usize) -> bool {
        let layout = self.solver.layout();
        let row = &self.values[lane * layout.stride..][..layout.stride];
        let n = self.bounds.len();
        let mut parts = layout.coordinates[..3].iter().map(|&first| &row[first as usize..][..n]);
        parts.all(|part| part.iter().all(|value| value.is_finite()))
    }

    /// Forgets the step.
    fn close(&mut self) {
        (self.first, self.end, self.last) = (0, 0, 0);
        (self.length, self.is_smooth) = (0.0, false);
    }
}

/// Where a row is.
enum Place {
    /// In the motion.
    Own,
    /// Among those that were solved for at once.
    Lane(usize),
}

/// What a motion goes back to where it was only looked ahead.
#[derive(Clone)]
pub(super) struct Bookmark {
    pub state: State,
    clear: State,
    determinants: Vec<Determinant>,
    sides: Vec<bool>,
    met: Option<Edge>,
    h: f64,
}

impl Output {
    /// The edge that the last step has ended at, whose later side is to be taken.
    pub fn take_edge(&mut self) -> Option<Edge> {
        self.edge.take()
    }

    /// Whether the last step has ended at an edge.
    pub fn is_at_edge(&self) -> bool {
        self.edge.is_some()
    }

    /// The last step has ended at an edge, or at none.
    pub fn end_at(&mut self, edge: Option<Edge>) {
        self.edge = edge;
    }

    /// Begins to count the steps anew.
    pub fn forget_steps(&mut self) {
        self.steps = 0;
    }

    pub fn new(kinematics: &Kinematics, state: &State, solver: Option<Arc<Solver>>, times: Times) -> Output {
        // what was left out of the equations is looked at wherever a row is printed
        let may_leap = kinematics.system().checks.is_empty();
        let rows = solver.map(|solver| Rows::new(kinematics, state, solver));
        let careful_until = f64::NEG_INFINITY;
        let system = kinematics.system();
        let variables = system.variations.as_ref().map_or(0, |variations| variations.variables.len());
        let missing = vec![Missing::NEVER; system.measures.len() + variables];
        Output { times, next: 0, has_stopped: false, steps: 0, careful_until, may_leap, rows, missing, edge: None }
    }
}

/// How many threads a solver is worth.
#[cfg(feature = "threads")]
fn threads(solver: &Solver) -> usize {
    if solver.instructions().len() < WORTH_A_THREAD {
        // asking for the processors takes as long as a hundred steps of a four-bar
        return 1;
    }
    std::thread::available_parallelism().map_or(1, |n| n.get().min(MOST_THREADS))
}

#[cfg(not(feature = "threads"))]
fn threads(_: &Solver) -> usize {
    1
}

impl Rows {
    fn new(kinematics: &Kinematics, state: &State, solver: Arc<Solver>) -> Rows {
        let threads = threads(&solver);
        Rows {
            lanes: vec![Lanes::new(&solver); threads],
            values: vec![0.0; threads * LANES * solver.layout().stride],
            holds: vec![[false; LANES]; threads],
            alone: Lanes::new(&solver),
            alone_row: vec![0.0; solver.layout().stride],
            rest: vec![[0.0; 6]; kinematics.system().coordinates.len()],
            pivoting: Pivoting::new(&kinematics.determined()),
            first: 0,
            end: 0,
            last: 0,
            has_bounds: false,
            bounds: vec![0.0; kinematics.system().rows.len()],
            origin: Bookmark {
                state: state.clone(),
                clear: state.clone(),
                determinants: vec![Determinant::ONE; kinematics.linear().blocks()],
                sides: vec![true; kinematics.system().watches.len()],
                met: None,
                h: 0.0,
            },
            length: 0.0,
            before: state.clone(),
            is_smooth: false,
            bends: vec![Bend::NONE; solver.tears().len()],
            solver,
        }
    }
}

/// The state at a time that a solver's row holds, like another state.
pub(super) fn state_of_row(layout: &RowLayout, row: &[f64], like: &State, t: f64) -> State {
    let n = like.q.len();
    let part = |order: usize| row[layout.coordinates[order] as usize..][..n].to_vec();
    let qddd = if layout.stride > layout.printed { part(3) } else { like.qddd.clone() };
    State { t, q: part(0), qd: part(1), qdd: part(2), qddd }
}

impl Motion {
    /// The row of the next output time, in the order of `Started::columns`; none behind the last one, and where the motion
    /// could not go on.
    ///
    /// # Errors
    /// Why and where the motion cannot go on.
    pub fn next_row(&mut self) -> Option<Result<&[f64], Box<Diagnostic>>> {
        if self.output.has_stopped || self.output.next >= self.output.times.len() {
            return None;
        }
        let t = self.output.times.at(self.output.next);
        let place = match self.reach(t) {
            Ok(place) => place,
            // who cancelled does not wait for a reason
            Err(_) if self.kinematics.is_cancelled() => {
                self.output.has_stopped = true;
                return None;
            }
            Err(diagnostic) => {
                self.output.has_stopped = true;
                return Some(Err(diagnostic));
            }
        };
        self.output.next += 1;
        self.output.steps = 0;
        if self.row(&place).iter().any(|value| !value.is_finite()) {
            self.leave_out_measures(&place, t);
        }
        Some(Ok(self.row(&place)))
    }

    fn row(&self, place: &Place) -> &[f64] {
        match (place, &self.output.rows) {
            (Place::Lane(lane), Some(rows)) => {
                let layout = rows.solver.layout();
                &rows.values[lane * layout.stride..][..layout.printed]
            }
            _ => &self.row,
        }
    }

    fn row_mut(&mut self, place: &Place) -> &mut [f64] {
        match (place, &mut self.output.rows) {
            (Place::Lane(lane), Some(rows)) => {
                let layout = rows.solver.layout();
                &mut rows.values[lane * layout.stride..][..layout.printed]
            }
            _ => &mut self.row,
        }
    }

    /// A row has been computed that holds something which is not finite: a measure, since the coordinates are. Its cells hold no
    /// number.
    fn leave_out_measures(&mut self, place: &Place, t: f64) {
        for column in 0..self.row.len() {
            let cell = &mut self.row_mut(place)[column];
            if !cell.is_finite() {
                *cell = f64::NAN;
                let measure = self.kinematics.measure_of_column(column);
                self.output.missing[measure].take_note(t);
            }
        }
    }

    /// A warning for each measure that had no value, with what else there is to say.
    pub(super) fn say_what_is_missing(&mut self) {
        let system = self.kinematics.system();
        for (index, missing) in self.output.missing.iter_mut().enumerate() {
            if missing.rows > 0 && !missing.is_told {
                missing.is_told = true;
                self.remarks.push(match index.checked_sub(system.measures.len()) {
                    None => errors::measure_without_value(system, index, missing.first, missing.rows),
                    Some(variable) => errors::derivatives_without_value(system, variable, missing.first, missing.rows),
                });
            }
        }
    }

    /// Goes on until the row of the next output time `t` (s) is there.
    fn reach(&mut self, t: f64) -> Result<Place, Box<Diagnostic>> {
        if !self.begun {
            self.begin()?;
        }
        loop {
            if let Some(place) = self.row_in_step(t) {
                return Ok(place);
            }
            if let Some(edge) = self.output.edge.take() {
                self.cross(edge)?;
            }
            if let Some(row) = self.row_on_bridge(t) {
                if row.is_err() && self.plain_row(t) {
                    return Ok(Place::Own);
                }
                return self.or_trusted(t, row).map(|()| Place::Own);
            }
            if t <= self.state.t {
                self.row_at_rest()?;
                self.refine(t);
                return Ok(Place::Own);
            }
            if !self.may_leap() {
                // beside a bifurcation that is passed every digit counts
                if self.go_to(t)? && !self.is_near {
                    self.refine(t);
                }
                return Ok(Place::Own);
            }
            self.count_step(t)?;
            self.leap()?;
        }
    }

    pub(super) fn count_step(&mut self, t: f64) -> Result<(), Box<Diagnostic>> {
        self.output.steps += 1;
        // who cancelled does not read why
        if self.output.steps > MOST_STEPS || self.kinematics.is_cancelled() {
            return Err(Box::new(singular::explain_haste(&mut self.kinematics, &self.state, MOST_STEPS, t)));
        }
        Ok(())
    }

    /// Steps to an output time on its own; says whether its row was solved for there, and not taken from the way over a singular
    /// position.
    fn go_to(&mut self, t: f64) -> Result<bool, Box<Diagnostic>> {
        while self.state.t < t {
            self.count_step(t)?;
            if let Err(why) = self.step_towards(t) {
                // so near to a bifurcation no step leads, but the way over it may
                return self.row_on_bridge(t).unwrap_or(Err(why)).map(|()| false);
            }
        }
        if let Some(row) = self.row_on_bridge(t) {
            return self.or_trusted(t, row).map(|()| false);
        }
        if self.trust == Trust::Doubtful && !self.pass {
            return self.row_in_doubt(t).map(|()| false);
        }
        if !self.trust.is_certain() || self.is_near {
            return self.look_ahead(t);
        }
        Ok(true)
    }

    /// Whether a step may go over several output times: the state is clear of singular positions.
    pub(super) fn may_leap(&self) -> bool {
        let is_clear = self.clear.t.total_cmp(&self.state.t).is_eq();
        self.output.rows.is_some() && self.output.may_leap && is_clear && self.state.t >= self.output.careful_until
    }

    /// Tries a step over as many output times as the error allows.
    pub(super) fn leap(&mut self) -> Result<(), Box<Diagnostic>> {
        let Output { times, next: number, .. } = &self.output;
        let (upcoming, farthest) = (times.at(*number), self.state.t + self.h);
        let behind = times.first_after(farthest, *number);
        // what does not change the time is no step
        let farthest = if farthest > self.state.t { farthest } else { upcoming };
        // no crumb at the end
        let target = if self.h >= 0.999 * (upcoming - self.state.t) {
            times.at(behind.saturating_sub(1).max(*number))
        } else {
            farthest
        };
        let is_output = target >= upcoming;
        let edge = self.next_edge(target, is_output)?.map(|edge| self.at_output(edge));
        let next = edge.map_or(target, |edge| edge.t);
        let h = next - self.state.t;
        if h <= 0.0 {
            if let Some(rows) = &mut self.output.rows {
                rows.close();
            }
            return edge.map_or(Ok(()), |edge| self.cross(edge));
        }
        match self.try_leap(h, next, edge.is_some(), self.met.is_some_and(|met| met.t <= next)) {
            Ok(Some(accepted)) => {
                self.accept(h, &accepted);
                self.output.edge = edge;
                Ok(())
            }
            Ok(None) => {
                self.output.careful_until = upcoming;
                Ok(())
            }
            Err(fault) => {
                if let Some(rows) = &mut self.output.rows {
                    rows.close();
                }
                self.give_way(h, fault, upcoming)
            }
        }
    }

    /// A step of length `h` to time `t`, solved for like a row, which says more of the way between than one place of it does;
    /// none where steps had better go to each output time on their own.
    fn try_leap(&mut self, h: f64, t: f64, to_edge: bool, to_edge_of_motion: bool) -> Result<Option<Accepted>, Fault> {
        let motion = self.predict(h, t)?;
        let Some(first_correction) = self.solve_ahead(h, t) else {
            return Ok(None);
        };
        if first_correction.is_nan() || first_correction > LARGEST_CORRECTION {
            return Err(Fault::TooFar);
        }
        self.kinematics.set_time(t);
        self.kinematics.set_position(&self.trial.q)?;
        if !to_edge_of_motion && let Some(switch) = self.edge_met() {
            return Err(Fault::Edge { t, switch });
        }
        self.kinematics.factor()?;
        self.same_branch()?;
        self.keep_away()?;
        if !self.is_clear() {
            return Ok(None);
        }
        self.draw_curve(h);
        self.open_step(h, t, to_edge);
        let between = self.corrections_between(h);
        if between.is_nan() || (between > LARGEST_BETWEEN && self.is_short(h)) {
            self.output.rows.iter_mut().for_each(Rows::close);
            return Ok(None);
        }
        if between > LARGEST_BETWEEN {
            return Err(Fault::TooFar);
        }
        self.look_at_signals(h)?;
        if !to_edge_of_motion {
            self.look_between(h, between)?;
        }
        self.look_for_rims(h)?;
        self.look_for_touch(h, motion)?;
        Ok(Some(Accepted { first_correction, between, motion }))
    }

    /// Whether a step is so short that a correction which is not small shows pivots that do not suit the position, and no bend
    /// of the way.
    fn is_short(&self, h: f64) -> bool {
        h <= SHORT * self.span
    }

    /// Solves at the end of a step from Taylor's prediction, and gives the correction; none where that does not hold.
    fn solve_ahead(&mut self, h: f64, t: f64) -> Option<f64> {
        let Output { rows: Some(rows), .. } = &mut self.output else {
            return None;
        };
        if !rows.has_bounds {
            self.kinematics.write_bounds(&mut rows.bounds);
            rows.has_bounds = true;
        }
        for &tear in rows.solver.tears() {
            let k = tear as usize;
            let (slope, bend) = (h * self.state.qd[k], 0.5 * h * h * self.state.qdd[k]);
            self.curve[k] = [self.state.q[k], slope, bend, 0.0, 0.0, 0.0];
        }
        if !rows.solve_alone(&self.kinematics, &self.curve, [self.state.t, h, t]) {
            // one that is far off wants a shorter step, and not more care
            let size = rows.alone.first_correction();
            return Some(size).filter(|size| *size > LARGEST_CORRECTION && !self.is_short(h));
        }
        let (layout, n) = (rows.solver.layout(), self.trial.q.len());
        let part = |order: usize| &rows.alone_row[layout.coordinates[order] as usize..][..n];
        for (k, q) in part(0).iter().enumerate() {
            self.middle[k] = q - self.trial.q[k];
        }
        self.trial.q.copy_from_slice(part(0));
        self.trial.qd.copy_from_slice(part(1));
        self.trial.qdd.copy_from_slice(part(2));
        if layout.has_jerk {
            self.trial.qddd.copy_from_slice(part(3));
        }
        Some(self.kinematics.linear().largest_judged(&self.middle))
    }

    /// The state in the middle of the step that was accepted last, if that was a leap and can be solved for there.
    pub(super) fn middle_of_leap(&mut self) -> Option<State> {
        let Output { rows: Some(rows), .. } = &mut self.output else {
            return None;
        };
        let (from, length) = (rows.origin.state.t, rows.length);
        let is_of_it = length > 0.0 && (from + length - self.state.t).abs() <= 1e-9 * length;
        let t = 0.5 * from + 0.5 * self.state.t;
        if !is_of_it || !rows.solve_alone(&self.kinematics, &self.curve, [from, length, t]) {
            return None;
        }
        Some(state_of_row(rows.solver.layout(), &rows.alone_row, &self.state, t))
    }

    /// How far the curve of a step is from the motion: at the first rows within it, or where there are few, at some place.
    fn corrections_between(&mut self, h: f64) -> f64 {
        let probe = self.next_probe();
        let Some(rows) = &mut self.output.rows else {
            return f64::NAN;
        };
        if rows.last - rows.first < ENOUGH {
            rows.solve_alone(&self.kinematics, &self.curve, [self.state.t, h, self.state.t + probe * h]);
            return rows.alone.first_correction();
        }
        self.solve_batch();
        // whichever threads there are, the first lanes are the same
        self.output.rows.as_ref().map_or(f64::NAN, |rows| rows.lanes[0].first_correction())
    }

    /// An edge that is meant to be at an output time is there.
    fn at_output(&self, edge: Edge) -> Edge {
        let Output { times, next, .. } = &self.output;
        let behind = times.first_after(edge.t, *next);
        let before = if behind > *next { times.at(behind - 1) } else { edge.t };
        let is_meant = before > self.state.t && shortly_after(before) >= edge.t;
        if is_meant { Edge { t: before, ..edge } } else { edge }
    }

    /// Takes note of a step of length `h` to `next`, which was tried and is to be accepted. The row at an edge is one of its
    /// later side.
    fn open_step(&mut self, h: f64, next: f64, to_edge: bool) {
        let Output { times, next: number, rows, .. } = &mut self.output;
        let Some(rows) = rows else {
            return;
        };
        let behind = times.first_after(next, *number);
        let at_end = to_edge && behind > *number && times.at(behind - 1) >= next;
        (rows.first, rows.end) = (*number, *number);
        rows.last = if at_end { behind - 1 } else { behind };
        let origin = &mut rows.origin;
        std::mem::swap(&mut rows.before, &mut origin.state);
        let was_next_to_it = (rows.before.t + rows.length - self.state.t).abs() <= 1e-9 * h;
        let comes_from = |smooth: bool| smooth && was_next_to_it && rows.length > 0.0;
        let (before, bent) = (&rows.before, comes_from(rows.is_smooth));
        for (bend, &tear) in rows.bends.iter_mut().zip(rows.solver.tears()) {
            let k = tear as usize;
            *bend = if bent {
                let back = (self.state.t - before.t) / h;
                Bend::new(&self.curve[k], [before.q[k], h * before.qd[k], h * h * before.qdd[k]], back)
            } else {
                Bend::NONE
            };
        }
        (rows.length, rows.is_smooth) = (h, !to_edge);
        self.kinematics.write_bounds(&mut rows.bounds);
        origin.state.copy_from(&self.state);
        origin.clear.copy_from(&self.clear);
        origin.determinants.copy_from_slice(&self.determinants);
        origin.sides.copy_from_slice(&self.sides);
        (origin.met, origin.h) = (self.met, self.h);
    }

    /// The row of the next output time `t`, if that lies within the step that was accepted last.
    fn row_in_step(&mut self, t: f64) -> Option<Place> {
        let number = self.output.next;
        let rows = self.output.rows.as_mut().filter(|rows| number < rows.last)?;
        if number >= rows.end {
            self.solve_batch();
        }
        let rows = self.output.rows.as_ref()?;
        let lane = (number - rows.first) as usize;
        if rows.holds[lane / LANES][lane % LANES] && rows.is_finite(lane) {
            return Some(Place::Lane(lane));
        }
        if self.row_on_curve(t) {
            self.refine(t);
            return Some(Place::Own);
        }
        self.take_step_back();
        None
    }

    /// Solves for the next rows of a step, in threads where there is enough to do: each has times of its own, so that the bits
    /// are the same.
    fn solve_batch(&mut self) {
        let Output { times, next, rows, .. } = &mut self.output;
        let Some(rows) = rows else {
            return;
        };
        let Rows { solver, lanes, values, holds, bounds, bends, .. } = rows;
        let (first, last) = (*next, rows.last.min(*next + (LANES * lanes.len()) as u64));
        (rows.first, rows.end) = (first, last);
        let batch = |part: usize| Batch {
            // the lanes that are left over do the last time again
            times: std::array::from_fn(|lane| times.at((first + (part * LANES + lane) as u64).min(last - 1))),
            from: rows.origin.state.t,
            length: rows.length,
            curve: &self.curve,
            bends,
            bounds,
        };
        let (program, registers) = self.kinematics.program();
        let parts = (last - first).div_ceil(LANES as u64) as usize;
        let solve = |part: usize, lanes: &mut Lanes<LANES>, values: &mut [f64], holds: &mut [bool; LANES]| {
            *holds = lanes.run(solver, program, registers, &batch(part), values);
        };
        let rows = values.chunks_exact_mut(LANES * solver.layout().stride);
        let all = lanes.iter_mut().zip(rows).zip(holds).enumerate().take(parts);
        #[cfg(feature = "threads")]
        if parts > 1 {
            let solve = &solve;
            std::thread::scope(|scope| {
                for (part, ((lanes, values), holds)) in all {
                    scope.spawn(move || solve(part, lanes, values, holds));
                }
            });
            return;
        }
        all.for_each(|(part, ((lanes, values), holds))| solve(part, lanes, values, holds));
    }

    /// Writes the row of a time within the last step by solving from its curve, with pivots that suit it; whether it holds.
    fn row_on_curve(&mut self, t: f64) -> bool {
        let Some(rows) = &self.output.rows else {
            return false;
        };
        let x = (t - rows.origin.state.t) / rows.length;
        self.trial.t = t;
        for (q, curve) in self.trial.q.iter_mut().zip(&self.curve) {
            *q = along(curve, x);
        }
        let is_solved = self.correct().is_ok()
            && self.edge_met().is_none()
            && self.same_branch().is_ok()
            && self.kinematics.derivatives(&mut self.trial).is_ok()
            && self.is_clear()
            && Trust::of(&mut self.kinematics, &self.trial).is_certain();
        if is_solved {
            self.kinematics.write_row(&self.trial, &mut self.row);
        }
        is_solved
    }

    /// Solves again for a row that was found otherwise, by the operations that all other rows come from: whichever way it was
    /// found, its bits are the same.
    pub(super) fn refine(&mut self, t: f64) {
        let Some(rows) = &mut self.output.rows else {
            return;
        };
        self.kinematics.write_bounds(&mut rows.bounds);
        for (rest, q) in rows.rest.iter_mut().zip(&self.row[1..]) {
            rest[0] = *q;
        }
        let batch = Batch { times: [t], from: t, length: 1.0, curve: &rows.rest, bends: &[], bounds: &rows.bounds };
        let (program, registers) = self.kinematics.program();
        let [holds] = rows.alone.run(&rows.solver, program, registers, &batch, &mut rows.alone_row);
        let printed = self.row.len();
        let mut is_solved = holds;
        if !holds && let Some(pivoting) = &mut rows.pivoting {
            self.trial.t = t;
            let n = self.trial.q.len();
            self.trial.q.copy_from_slice(&self.row[1..=n]);
            is_solved = self.kinematics.pivoted_row(pivoting, &mut self.trial, &mut rows.alone_row[..printed]);
            self.kinematics.restore(&self.state);
        }
        let refined = &rows.alone_row[..printed];
        let kinematics = &self.kinematics;
        // where both do not agree the position is too near to a singular one for the grid
        // a measure may have no value, and what is varied does not decide about the row
        let agrees = |(column, (a, b)): (usize, (&f64, &f64))| {
            !a.is_finite() || kinematics.is_varied(column) || (a - b).abs() <= REFINED * (1.0 + a.abs())
        };
        if is_solved && self.row.iter().zip(refined).enumerate().all(agrees) {
            for (column, (cell, refined)) in self.row.iter_mut().zip(refined).enumerate() {
                // what could not be trusted before cannot be now
                if cell.is_finite() || !kinematics.is_varied(column) {
                    *cell = *refined;
                }
            }
        }
    }

    /// Goes back to where the last step began, to go over it time by time.
    fn take_step_back(&mut self) {
        self.output.careful_until = self.state.t;
        self.output.edge = None;
        if let Some(mut rows) = self.output.rows.take() {
            rows.close();
            self.go_back(&rows.origin);
            self.output.rows = Some(rows);
        }
    }

    /// A row whose derivatives would be more rounding than digits: mostly a lock-up comes right behind it, or a bifurcation,
    /// and then the row may lie on the way over it. Says whether it does not.
    fn look_ahead(&mut self, t: f64) -> Result<bool, Box<Diagnostic>> {
        let (trust, row, here) = (self.trust, self.row.clone(), self.bookmark());
        let is_certain = self.is_certain(&here.state);
        // a run that passes nothing prints it too, if nothing has been passed before
        let is_plain = is_certain && self.bridge.as_ref().is_none_or(|bridge| bridge.at > t);
        let (mut ahead, farthest) = (t + self.span / FEWEST_STEPS_NEAR, self.time_ahead(t));
        for _ in 0..STEPS_AHEAD {
            if let Err(why) = self.step_towards(ahead) {
                // what comes behind the row does not concern it
                if is_certain {
                    break;
                }
                return self.row_before(t, &here, why).map(|()| false);
            }
            match self.row_on_bridge(t) {
                // the curve over the bridge is not exact enough, but the row is
                Some(Err(_)) if is_plain => return Ok(self.keep_plain(here, row)),
                Some(on_bridge) => {
                    self.plain = is_plain.then_some(here);
                    return self.or_trusted(t, on_bridge).map(|()| false);
                }
                None => {}
            }
            // a step that failed leaves the factors of where it failed
            self.kinematics.restore(&self.state);
            if trust != Trust::Uncertain && self.state.t > t && self.is_clear() {
                break;
            }
            if self.state.t >= ahead {
                if is_certain || ahead >= farthest {
                    break;
                }
                ahead = farthest;
            }
        }
        // the next row lies before what was looked at
        self.go_back(&here);
        if is_certain {
            self.row = row;
            return Ok(true);
        }
        Err(self.explain_uncertain(t))
    }

    /// The row of a time `t`, which is not certain as it was found, where the motion behind it cannot go on.
    fn row_before(&mut self, t: f64, here: &Bookmark, why: Box<Diagnostic>) -> Result<(), Box<Diagnostic>> {
        let on_bridge = self.row_on_bridge(t);
        self.go_back(here);
        on_bridge.unwrap_or_else(|| Err(self.explain_refused(t, Some(why))))
    }

    /// Why the row of a time `t` is not printed: what ends the motion, unless that comes behind the last row, for which nobody
    /// asked, or its own nearness to a singular position.
    pub(super) fn explain_refused(&mut self, t: f64, why: Option<Box<Diagnostic>>) -> Box<Diagnostic> {
        let at = |why: &Diagnostic| why.data.get("t").and_then(serde_json::Value::as_f64);
        let is_behind = |why: &Diagnostic| at(why).is_some_and(|at| at > self.last);
        why.filter(|why| !is_behind(why)).unwrap_or_else(|| self.explain_uncertain(t))
    }

    /// Keeps a row that was found without a bridge, so that the next one on that bridge may be found in the same way.
    fn keep_plain(&mut self, here: Bookmark, row: Vec<f64>) -> bool {
        self.row = row;
        self.kinematics.restore(&here.state);
        self.refine(here.state.t);
        self.kinematics.restore(&self.state);
        self.plain = Some(here);
        false
    }

    /// Finds the row of a time on a bridge by steps from the row before, as if the bridge were not there; says whether that
    /// is certain.
    fn plain_row(&mut self, t: f64) -> bool {
        let Some(plain) = self.plain.take().filter(|plain| plain.state.t < t) else {
            return false;
        };
        let (beyond, bridge, pass) = (self.bookmark(), self.bridge.take(), self.pass);
        self.pass = false;
        self.go_back(&plain);
        let is_found = self.steps_to(t) && self.is_certain(&self.state.clone());
        let here = self.bookmark();
        (self.pass, self.bridge) = (pass, bridge);
        self.go_back(&beyond);
        is_found && {
            let row = self.row.clone();
            self.keep_plain(here, row);
            true
        }
    }

    /// Steps to the time of the next row by way of all output times before; says whether it comes there.
    fn steps_to(&mut self, t: f64) -> bool {
        while self.state.t < t {
            let upcoming = self.output.times.first_after(self.state.t, 0).min(self.output.next);
            if self.count_step(t).is_err() || self.step_towards(self.output.times.at(upcoming)).is_err() {
                return false;
            }
        }
        true
    }

    pub(super) fn explain_uncertain(&mut self, t: f64) -> Box<Diagnostic> {
        let singular = self.kinematics.worst();
        Box::new(singular::name_uncertain(self.kinematics.system(), &singular.left, t))
    }

    /// What the next step begins from.
    pub(super) fn bookmark(&self) -> Bookmark {
        Bookmark {
            state: self.state.clone(),
            clear: self.clear.clone(),
            determinants: self.determinants.clone(),
            sides: self.sides.clone(),
            met: self.met,
            h: self.h,
        }
    }

    pub(super) fn go_back(&mut self, to: &Bookmark) {
        self.state.copy_from(&to.state);
        self.clear.copy_from(&to.clear);
        self.sides.copy_from_slice(&to.sides);
        (self.met, self.h) = (to.met, to.h);
        if !self.kinematics.switches().is_empty() {
            self.settle(Some(behind_start(self.state.t, self.span)));
        }
        self.kinematics.restore(&self.state);
        self.begin_determinants();
        // as they were accepted, should the position be so near to a singular one that they are rounding
        self.determinants.copy_from_slice(&to.determinants);
    }

    /// The row of the state that has been reached already: the start.
    fn row_at_rest(&mut self) -> Result<(), Box<Diagnostic>> {
        self.kinematics.restore(&self.state);
        let mut trust = self.trust_at_rest();
        if trust == Ok(Trust::Doubtful) {
            trust = if self.stands_up(&self.state.clone()) { self.trust_at_rest() } else { Err(Fault::Uncertain) };
        }
        if let Err(fault) = trust {
            return Err(Box::new(self.explain_start(fault)));
        }
        self.kinematics.write_row(&self.state, &mut self.row);
        Ok(())
    }

    fn trust_at_rest(&mut self) -> Result<Trust, Fault> {
        self.kinematics.derivatives(&mut self.state)?;
        match Trust::of(&mut self.kinematics, &self.state) {
            Trust::Uncertain => Err(Fault::Uncertain),
            trust => Ok(trust),
        }
    }
}
