//! Follower: goes from one output time to the next, and decides what is done in which order. The data belong to the parts: the step, the
//! edges, the crossing of singular positions, the rows.
//!
//! Where the motion is calm a step covers as many output times as it may, and when it is accepted their rows are solved for on its curve,
//! several at once. Near a singular position, and where such a row does not hold, steps go to each time on its own.

mod dense_steps;
mod ill_conditioned_rows;
mod lookahead;
mod segments;

use super::checkpoint::Checkpoint;
use super::crossing::{Crossing, is_clear};
use super::edges::{Edge, Edges};
use super::near_misses::NearMisses;
use super::row_selection::RowSelection;
use super::rows::{ForceMonitor, Place, RowBatch, Rows, SpacingMonitor};
use super::step::{Accepted, Step, reject_near_singular};
use super::warnings::Warnings;
use crate::analysis::assemble::Started;
use crate::analysis::explain::{Stop, Warning, singular};
use crate::analysis::state::{Fault, Kinematics, State, Times, Trust, behind_start};
use crate::limits::step_control::{FEWEST_STEPS_NEAR, MOST_STEPS};
use crate::solver::Solver;
use mechc_ir::ConstraintSystem;
use mechc_ir::limits::DEFAULT_SPAN;
pub use segments::SmoothSegment;
use std::sync::Arc;

/// Number of steps behind a row that cannot be printed, to explain why.
const STEPS_AHEAD: usize = 1_000;

/// A motion in progress: rows at ascending times, computed without allocating.
pub struct Follower {
    kinematics: Kinematics,
    step: Step,
    edges: Edges,
    crossing: Crossing,
    rows: Rows,
    /// `None` where all equations are needed.
    choice: Option<RowSelection>,
    /// `None` where there are no contacts and loads, or no forces are requested.
    forces: Option<ForceMonitor>,
    /// `None` without belts.
    spacings: Option<SpacingMonitor>,
    misses: NearMisses,
    warnings: Warnings,
    /// True if derivatives at the start have been computed.
    begun: bool,
    /// The edge that the last step ended at, if its later side has not been taken yet.
    edge: Option<Edge>,
    /// The time that the steps are measured against, and the last time (s).
    span: f64,
    last: f64,
    /// Time up to which edges are sought (s).
    edges_end: f64,
}

impl Started {
    /// Returns the motion from the start on, with a row for each of some times, which do not come before the start.
    #[must_use]
    pub fn into_motion(self, times: &Times) -> Follower {
        Follower::new(self.into_parts(), times.clone())
    }
}

impl Follower {
    /// Returns the motion of a mechanism in a state, with the solver for its rows.
    #[must_use]
    pub fn new((mut kinematics, state, solver): (Kinematics, State, Option<Arc<Solver>>), times: Times) -> Follower {
        let last = times.last();
        let span = if times.span() > 0.0 { times.span() } else { DEFAULT_SPAN };
        let edges_end = times.end();
        let edges = Edges::new(&mut kinematics, &state, span, edges_end);
        let crossing = Crossing::new(&state, span, last);
        let forces = ForceMonitor::new(&kinematics, &state);
        let spacings = SpacingMonitor::new(kinematics.system(), &state);
        let misses = NearMisses::new(&state);
        let step = Step::new(&kinematics, state, times.span());
        let origin = || Checkpoint::new(&step, &edges, &crossing);
        let batch = solver.map(|solver| RowBatch::new(&kinematics, solver, origin(), span));
        let rows = Rows::new(&kinematics, batch, times);
        let warnings = Warnings::new(kinematics.system());
        let choice = RowSelection::new(&kinematics);
        let (begun, edge) = (false, None);
        Follower {
            kinematics,
            step,
            edges,
            crossing,
            rows,
            choice,
            forces,
            spacings,
            misses,
            warnings,
            begun,
            edge,
            span,
            last,
            edges_end,
        }
    }

    /// Goes on beyond bifurcations, along the branch that continues smoothly, with a warning each time.
    pub fn pass_bifurcations(&mut self) {
        self.crossing.pass_bifurcations();
    }

    /// Records from now on the times at which accelerations jump.
    pub fn keep_edges(&mut self) {
        self.warnings.keep_jumps();
    }

    /// Returns the times at which accelerations jumped (s), ascending, each once.
    #[must_use]
    pub fn edges(&self) -> Vec<f64> {
        self.warnings.jumps()
    }

    /// Takes the warnings so far, each once.
    pub fn take_warnings(&mut self) -> Vec<Warning> {
        self.rows.report_missing(&mut self.warnings);
        if let Some(spacings) = &mut self.spacings {
            spacings.report(&mut self.warnings);
        }
        let Follower { kinematics, step, rows, misses, warnings, .. } = self;
        if let Some(missed) = rows.last_time().and_then(|t| misses.take_warning(kinematics, step.state(), t)) {
            warnings.push(missed);
        }
        self.warnings.take()
    }

    /// Returns the row of the next output time, in the order of `Started::columns`; `None` behind the last one, and where the motion could not go on.
    ///
    /// # Errors
    /// Why and where the motion cannot go on.
    pub fn next_row(&mut self) -> Option<Result<&[f64], Box<Stop>>> {
        if self.forces.is_none()
            && let Some(place) = self.rows.hand_out_ready()
        {
            return Some(Ok(self.checked_row(place)));
        }
        let t = self.rows.next_time()?;
        self.misses.watch();
        let place = match self.reach(t) {
            Ok(place) => place,
            Err(why) => {
                self.rows.stop();
                // cancelled: the caller discards the reason
                return if self.kinematics.is_cancelled() { None } else { Some(Err(why)) };
            }
        };
        let Follower { kinematics, forces, rows, warnings, .. } = self;
        if let Some(Err(why)) = forces.as_mut().map(|forces| forces.look(kinematics, rows.row(place), warnings)) {
            rows.stop();
            return Some(Err(why));
        }
        self.rows.count_row();
        if !self.rows.is_whole(place) {
            self.rows.leave_out_measures(&self.kinematics, place, t);
        }
        Some(Ok(self.checked_row(place)))
    }

    /// Returns a row, whose distances have been checked.
    fn checked_row(&mut self, place: Place) -> &[f64] {
        let row = self.rows.row(place);
        if let Some(spacings) = &mut self.spacings {
            spacings.look(row);
        }
        row
    }

    /// Goes on until the row of the next output time `t` (s) is there.
    fn reach(&mut self, t: f64) -> Result<Place, Box<Stop>> {
        self.begin()?;
        loop {
            if let Some(place) = self.row_in_dense_step(t) {
                return Ok(place);
            }
            self.cross_edge()?;
            if let Some(row) = self.row_on_bridge(t) {
                if row.is_err() && self.plain_row(t) {
                    return Ok(Place::Single);
                }
                return self.or_solve_directly(t, row).map(|()| Place::Single);
            }
            if t <= self.step.t() {
                self.row_at_rest()?;
                self.refine(t);
                return Ok(Place::Single);
            }
            if !self.may_step_densely() {
                // near a bifurcation that is passed every digit counts
                if self.go_to(t)? && !self.rows.is_near() {
                    self.refine(t);
                }
                return Ok(Place::Single);
            }
            self.count_step(t)?;
            self.step_densely()?;
        }
    }

    /// Computes the derivatives at the start, if that has not been done; returns whether it had been.
    fn begin(&mut self) -> Result<bool, Box<Stop>> {
        if std::mem::replace(&mut self.begun, true) {
            return Ok(true);
        }
        self.choose_equations();
        let Follower { kinematics, step, .. } = self;
        kinematics.restore(step.state());
        if !kinematics.switches().is_empty() {
            // the direction of motion decides on which side of an edge it begins
            let _ = step.derive_state(kinematics);
            self.settle();
            self.kinematics.restore(self.step.state());
        }
        self.step.begin_branch(&self.kinematics);
        self.step.record_monitor_signs(&self.kinematics);
        match self.step.derive_state(&mut self.kinematics) {
            Ok(()) => Ok(false),
            Err(fault) => Err(self.explain_state(fault)),
        }
    }

    /// Sets the switches to what they are where the motion is.
    fn settle(&mut self) {
        let after = behind_start(self.step.t(), self.span);
        self.edges.settle(&mut self.kinematics, self.step.state(), Some(after));
    }

    /// Selects anew the equations that are solved where the motion is, if not all are needed; returns whether they changed.
    fn choose_equations(&mut self) -> bool {
        let Follower { kinematics, step, edges, rows, choice, forces, .. } = self;
        let Some(choice) = choice else {
            return false;
        };
        if !choice.choose(kinematics, step.state()) {
            return false;
        }
        let met = edges.met();
        *edges = Edges::new(kinematics, step.state(), self.span, self.edges_end);
        edges.go_back(met);
        if let Some(forces) = forces {
            forces.change_equations(kinematics);
        }
        let origin = Checkpoint::new(step, edges, &self.crossing);
        rows.change_solver(choice.batch(kinematics, origin, self.span));
        if !self.kinematics.switches().is_empty() {
            self.settle();
        }
        self.kinematics.restore(self.step.state());
        self.step.change_equations(&mut self.kinematics, self.span / FEWEST_STEPS_NEAR).is_ok()
    }

    /// Returns why the state where the motion is has no row.
    fn explain_state(&mut self, fault: Fault) -> Box<Stop> {
        let state = self.step.state();
        singular::find_stop(&mut self.kinematics, state, fault, [0.0, state.t])
    }

    fn count_step(&mut self, t: f64) -> Result<(), Box<Stop>> {
        // cancelled: the caller discards the reason
        if self.rows.count_step() || self.kinematics.is_cancelled() {
            let state = self.step.state();
            return Err(singular::find_stop_of_haste(&mut self.kinematics, state, MOST_STEPS, t));
        }
        Ok(())
    }

    /// Steps to an output time on its own; returns whether its row was solved for there, and not taken from the bridge over a singular position.
    fn go_to(&mut self, t: f64) -> Result<bool, Box<Stop>> {
        while self.step.t() < t {
            self.count_step(t)?;
            if let Err(why) = self.step_towards(t) {
                // no step may lead so near to a bifurcation, but the bridge over it may
                return self.row_on_bridge(t).unwrap_or(Err(why)).map(|()| false);
            }
        }
        if let Some(row) = self.row_on_bridge(t) {
            return self.or_solve_directly(t, row).map(|()| false);
        }
        if self.rows.trust() == Trust::Doubtful && !self.crossing.passes() {
            return self.row_in_doubt(t).map(|()| false);
        }
        if !self.rows.trust().is_certain() || self.rows.is_near() {
            return self.look_ahead(t);
        }
        Ok(true)
    }

    /// Steps as far as the error and the next edge allow, and crosses that edge.
    fn step_towards(&mut self, t: f64) -> Result<(), Box<Stop>> {
        let edge = self.step_to_edge(t)?;
        edge.map_or(Ok(()), |edge| self.cross(edge))
    }

    /// Steps as far as the error and the next edge allow; returns the edge.
    fn step_to_edge(&mut self, t: f64) -> Result<Option<Edge>, Box<Stop>> {
        let next = self.step.end_towards(t);
        let edge = self.edges.next(&mut self.kinematics, &mut self.step, next, next >= t)?;
        let next = edge.map_or(next, |edge| edge.t);
        let h = next - self.step.t();
        if h <= 0.0 {
            return Ok(edge);
        }
        match self.try_step(h, next, next >= t) {
            Ok(accepted) => {
                self.accept(h, &accepted);
                Ok(edge)
            }
            Err(fault) => self.handle_rejection(h, fault, t).map(|()| None),
        }
    }

    /// Tries a step of length `h` to time `t`, and writes its row if `writes_row`.
    fn try_step(&mut self, h: f64, t: f64, writes_row: bool) -> Result<Accepted, Fault> {
        let Follower { kinematics, step, edges, crossing, rows, choice, .. } = self;
        let to_edge_of_motion = edges.is_met_by(t);
        let motion = step.predict(kinematics, h, t)?;
        let first_correction = step.correct(kinematics)?;
        if !to_edge_of_motion {
            edges.before_switch(kinematics, step.t(), t)?;
        }
        step.same_branch(kinematics)?;
        reject_near_singular(kinematics)?;
        if choice.as_mut().is_some_and(|choice| !choice.is_good(kinematics, step.trial())) {
            return Err(Fault::Choice);
        }
        step.derive_trial(kinematics)?;
        if writes_row {
            rows.take(kinematics, step.trial(), |kinematics| crossing.passes() && !is_clear(kinematics));
        }
        let between = step.correction_between(kinematics, h)?;
        edges.check_interior(kinematics, step, h, (!to_edge_of_motion).then_some(between))?;
        step.look_for_touch(kinematics, h, motion)?;
        Ok(Accepted { first_correction, between, motion })
    }

    fn accept(&mut self, h: f64, accepted: &Accepted) {
        let Follower { kinematics, step, edges, crossing, forces, misses, .. } = self;
        if crossing.has_bridge_to(step.t()) {
            misses.forget();
        }
        if let Some(forces) = forces {
            forces.check_interior(kinematics, [step.t(), h], step.curve());
        }
        edges.record_rates(kinematics, step, h);
        step.accept(kinematics);
        crossing.keep_if_clear(kinematics, step.state());
        step.commit(kinematics, h, accepted);
        misses.take(kinematics, step.state());
    }

    /// Handles the refusal of a step of length `h` on the way to `target`.
    fn handle_rejection(&mut self, h: f64, fault: Fault, target: f64) -> Result<(), Box<Stop>> {
        if fault == Fault::Choice && self.choose_equations() {
            return Ok(());
        }
        let Follower { kinematics, step, edges, warnings, .. } = self;
        match fault {
            Fault::Edge { t, switch } if edges.rests(kinematics, step, switch) => {
                // a step of a few units in the last place may have been refused at its very beginning
                edges.suspend_until(switch, t.max(step.t().next_up()));
                return Ok(());
            }
            Fault::Edge { t, .. } if edges.locate(kinematics, step, t) => return Ok(()),
            Fault::DomainBoundary => return edges.cross_domain_boundary(kinematics, step, warnings),
            _ => {}
        }
        if !step.halve(h) {
            return Ok(());
        }
        let Follower { kinematics, step, edges, crossing, warnings, .. } = self;
        match edges.end_at_domain_boundary(kinematics, step, h, warnings) {
            Some(why) => Err(why),
            None => crossing.pass_or_explain(kinematics, step, fault, [h, target], warnings),
        }
    }

    /// Goes over to the later side of the edge that the last step ended at, if it did.
    fn cross_edge(&mut self) -> Result<bool, Box<Stop>> {
        match self.edge.take() {
            Some(edge) => self.cross(edge).map(|()| true),
            None => Ok(false),
        }
    }

    fn cross(&mut self, edge: Edge) -> Result<(), Box<Stop>> {
        let Follower { kinematics, step, edges, rows, warnings, .. } = self;
        if edges.cross(kinematics, step, edge, warnings)? {
            // the row at an edge is one of its later side
            rows.single_mut().copy_from_slice(edges.later_row());
        }
        Ok(())
    }

    /// Writes the row of the state that has been reached already: the start.
    fn row_at_rest(&mut self) -> Result<(), Box<Stop>> {
        self.kinematics.restore(self.step.state());
        let mut trust = self.trust_at_rest();
        if trust == Ok(Trust::Doubtful) {
            let state = self.step.state().clone();
            trust = if self.is_reproducible(&state) { self.trust_at_rest() } else { Err(Fault::Uncertain) };
        }
        if let Err(fault) = trust {
            return Err(self.explain_state(fault));
        }
        self.kinematics.write_row(self.step.state(), self.rows.single_mut());
        Ok(())
    }

    fn trust_at_rest(&mut self) -> Result<Trust, Fault> {
        self.step.derive_state(&mut self.kinematics)?;
        match Trust::of(&mut self.kinematics, self.step.state()) {
            Trust::Uncertain => Err(Fault::Uncertain),
            trust => Ok(trust),
        }
    }

    /// Writes the row of a time on the way over a singular position, if it is on one.
    fn row_on_bridge(&mut self, t: f64) -> Option<Result<(), Box<Stop>>> {
        let Follower { kinematics, step, crossing, rows, .. } = self;
        crossing.write_row(kinematics, step, t, rows.single_mut())
    }

    /// Solves for the row of a time once more, by the operations that all other rows come from.
    fn refine(&mut self, t: f64) {
        self.rows.refine(&mut self.kinematics, self.step.state(), t);
    }

    /// Returns the checkpoint of the present state.
    fn checkpoint(&self) -> Checkpoint {
        Checkpoint::new(&self.step, &self.edges, &self.crossing)
    }

    fn go_back(&mut self, to: &Checkpoint) {
        self.step.go_back(&to.mark);
        self.crossing.go_back(&to.clear);
        self.edges.go_back(to.met);
        if !self.kinematics.switches().is_empty() {
            self.settle();
        }
        self.step.restore_branch(&mut self.kinematics, &to.mark);
    }

    /// Returns whether the step to where the motion is has ended clear of singular positions.
    #[must_use]
    pub fn was_clear_here(&self) -> bool {
        self.crossing.was_clear_at(self.step.t())
    }

    /// Returns the equations of the motion, whose stops and warnings speak of them.
    #[must_use]
    pub fn system(&self) -> &ConstraintSystem {
        self.kinematics.system()
    }

    /// Returns the state where the motion is.
    #[must_use]
    pub fn here(&self) -> &State {
        self.step.state()
    }
}
