//! The motion as the stretches that its steps go over: in each the equations are smooth, and both its ends are solved for.
//!
//! They do not depend on which rows are asked for, and end at the edges of the equations.

use super::bridge::Bridge;
use super::march::Motion;
use crate::analysis::state::State;
use crate::diag::Diagnostic;
use std::rc::Rc;

/// A part of the motion between two states.
pub struct Stretch {
    pub from: State,
    /// Halfway in time, if it has been solved for.
    pub middle: Option<State>,
    pub to: State,
    /// The results of the equations' switches.
    pub switches: Rc<[f64]>,
    /// The way over a singular position, if it is one.
    pub bridge: Option<Bridge>,
    /// Whether it begins behind an edge, or at the start.
    pub begins_at_edge: bool,
    /// Whether it ends at one, or at the last time.
    pub ends_at_edge: bool,
}

impl Motion {
    /// Goes on to the end of the next stretch; none behind the last time.
    ///
    /// # Errors
    /// Why and where the motion cannot go on.
    pub fn next_stretch(&mut self) -> Result<Option<Stretch>, Box<Diagnostic>> {
        let mut begins_at_edge = !self.begun;
        if !self.begun {
            self.begin()?;
        }
        let last = self.last;
        let mut from = self.state.clone();
        self.output.forget_steps();
        loop {
            if let Some(edge) = self.output.take_edge() {
                self.cross(edge)?;
                begins_at_edge = true;
                from.copy_from(&self.state);
            }
            if self.state.t >= last {
                return Ok(None);
            }
            self.count_step(last)?;
            if self.may_leap() {
                self.leap()?;
            } else {
                let edge = self.step_to_edge(last)?;
                self.output.end_at(edge);
            }
            if self.state.t > from.t {
                return Ok(Some(self.stretch(from, begins_at_edge)));
            }
        }
    }

    fn stretch(&mut self, from: State, begins_at_edge: bool) -> Stretch {
        let bridge = self.bridge.clone().filter(|bridge| bridge.to.t.total_cmp(&self.state.t).is_eq());
        let middle = if bridge.is_some() { None } else { self.middle_of_leap() };
        let switches = self.switches();
        let ends_at_edge = self.output.is_at_edge() || self.state.t >= self.last;
        Stretch { from, middle, to: self.state.clone(), switches, bridge, begins_at_edge, ends_at_edge }
    }

    /// The results that the equations' switches have now.
    pub fn switches(&self) -> Rc<[f64]> {
        self.kinematics.switches().iter().map(|switch| self.kinematics.switch(switch)).collect()
    }

    /// Whether the step to where the motion is has ended clear of singular positions.
    pub fn was_clear_here(&self) -> bool {
        self.clear.t.total_cmp(&self.state.t).is_eq()
    }

    /// Where the motion is.
    pub fn here(&self) -> &State {
        &self.state
    }
}
