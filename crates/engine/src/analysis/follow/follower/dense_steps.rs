//! Steps over several output times.

use super::Follower;
use crate::analysis::explain::Stop;
use crate::analysis::follow::crossing::is_clear;
use crate::analysis::follow::rows::Place;
use crate::analysis::follow::step::{Accepted, reject_near_singular};
use crate::analysis::state::{Fault, Trust};
use crate::limits::step_control::{LARGEST_BETWEEN, LARGEST_CORRECTION};

impl Follower {
    /// Returns whether a step may go over several output times: the state is clear of singular positions.
    pub(super) fn may_step_densely(&self) -> bool {
        let t = self.step.t();
        self.rows.may_step_densely(t) && self.crossing.was_clear_at(t)
    }

    /// Tries a step over as many output times as the error allows.
    pub(super) fn step_densely(&mut self) -> Result<(), Box<Stop>> {
        let (from, upcoming) = (self.step.t(), self.rows.upcoming());
        let target = self.rows.target(from, self.step.h());
        let edge = self.edges.next(&mut self.kinematics, &mut self.step, target, target >= upcoming)?;
        let edge = edge.map(|edge| self.rows.at_output(edge, from));
        let next = edge.map_or(target, |edge| edge.t);
        let h = next - from;
        if h <= 0.0 {
            self.rows.close_batch();
            return edge.map_or(Ok(()), |edge| self.cross(edge));
        }
        match self.try_dense_step(h, next, edge.is_some()) {
            Ok(Some(accepted)) => {
                self.accept(h, &accepted);
                self.edge = edge;
                Ok(())
            }
            Ok(None) => {
                self.rows.single_step_until(upcoming);
                Ok(())
            }
            Err(fault) => {
                self.rows.close_batch();
                self.handle_rejection(h, fault, upcoming)
            }
        }
    }

    /// Tries a step of length `h` to time `t`, which is solved for like a row, so that several places check the way between. Returns `None`
    /// where single steps to each output time are better.
    fn try_dense_step(&mut self, h: f64, t: f64, to_edge: bool) -> Result<Option<Accepted>, Fault> {
        let Follower { kinematics, step, edges, crossing, rows, .. } = self;
        let to_edge_of_motion = edges.is_met_by(t);
        let Some((batch, upcoming)) = rows.batch() else {
            return Ok(None);
        };
        let motion = step.predict(kinematics, h, t)?;
        let Some(first_correction) = batch.solve_ahead(kinematics, step, h, t) else {
            return Ok(None);
        };
        if first_correction.is_nan() || first_correction > LARGEST_CORRECTION {
            return Err(Fault::TooFar);
        }
        kinematics.set_time(t);
        kinematics.set_position(&step.trial().q)?;
        if !to_edge_of_motion {
            edges.before_switch(kinematics, step.t(), t)?;
        }
        kinematics.factor()?;
        step.same_branch(kinematics)?;
        reject_near_singular(kinematics)?;
        if !is_clear(kinematics) {
            return Ok(None);
        }
        step.draw_curve(h);
        batch.open(kinematics, step, upcoming, [h, t], to_edge, |origin| origin.write(step, edges, crossing));
        let between = batch.correction_between(kinematics, step, upcoming, h);
        if between.is_nan() || (between > LARGEST_BETWEEN && batch.is_short(h)) {
            batch.close();
            return Ok(None);
        }
        if between > LARGEST_BETWEEN {
            return Err(Fault::TooFar);
        }
        edges.check_interior(kinematics, step, h, (!to_edge_of_motion).then_some(between))?;
        step.look_for_touch(kinematics, h, motion)?;
        Ok(Some(Accepted { first_correction, between, motion }))
    }

    /// Returns the row of the next output time `t`, if that lies within the step that was accepted last.
    pub(super) fn row_in_dense_step(&mut self, t: f64) -> Option<Place> {
        let (batch, upcoming) = self.rows.batch().filter(|(batch, upcoming)| batch.holds_time(upcoming.next))?;
        if let Some(lane) = batch.lane_of(&self.kinematics, &self.step, upcoming) {
            return Some(Place::Lane(lane));
        }
        let way = batch.way();
        if self.row_on_curve(way, t) {
            self.refine(t);
            return Some(Place::Single);
        }
        self.redo_last_step();
        None
    }

    /// Writes the row of a time within a step from a time and of a length (s), by solving from the step's curve with factors of that
    /// position; returns whether the row holds.
    fn row_on_curve(&mut self, way: [f64; 2], t: f64) -> bool {
        let Follower { kinematics, step, edges, rows, .. } = self;
        step.try_on_curve(way, t);
        let is_solved = step.correct(kinematics).is_ok()
            && edges.switch_met(kinematics, step.t()).is_none()
            && step.same_branch(kinematics).is_ok()
            && step.derive_trial(kinematics).is_ok()
            && is_clear(kinematics)
            && Trust::of(kinematics, step.trial()).is_certain();
        if is_solved {
            kinematics.write_row(step.trial(), rows.single_mut());
        }
        is_solved
    }

    /// Goes back to where the last step began, to go over it time by time.
    fn redo_last_step(&mut self) {
        let origin = self.rows.batch().map(|(batch, _)| batch.origin().clone());
        self.rows.single_step_until(self.step.t());
        self.edge = None;
        self.rows.close_batch();
        if let Some(origin) = origin {
            self.go_back(&origin);
        }
    }
}
