//! The motion as segments, one for each of its steps: in each the equations are smooth, and both its ends are solved for.
//!
//! They do not depend on which rows are requested, and end at the edges of the equations.

use super::Follower;
use crate::analysis::explain::Stop;
use crate::analysis::follow::crossing::Bridge;
use crate::analysis::follow::row_selection::{RowSelection, SelectedRows};
use crate::analysis::state::State;
use std::rc::Rc;
use std::sync::Arc;

/// A part of the motion between two states.
pub struct SmoothSegment {
    pub from: State,
    /// State halfway in time, if it has been solved for.
    pub middle: Option<State>,
    pub to: State,
    /// The results of the equations' switches.
    pub switches: Rc<[f64]>,
    /// The equations that are solved there, if they are others than those at the start.
    pub chosen: Option<Arc<SelectedRows>>,
    /// The way over a singular position, if it is one.
    pub bridge: Option<Bridge>,
    /// True if it begins behind an edge, or at the start.
    pub begins_at_edge: bool,
    /// True if it ends at one, or at the last time.
    pub ends_at_edge: bool,
}

impl SmoothSegment {
    /// Its parts before and behind a state within.
    #[must_use]
    pub fn cut_at(self, within: State) -> [SmoothSegment; 2] {
        let (switches, chosen) = (Rc::clone(&self.switches), self.chosen.clone());
        let before = SmoothSegment {
            from: self.from,
            middle: None,
            to: within.clone(),
            switches,
            chosen,
            bridge: self.bridge.clone(),
            begins_at_edge: self.begins_at_edge,
            ends_at_edge: false,
        };
        [before, SmoothSegment { from: within, middle: None, begins_at_edge: false, ..self }]
    }
}

impl Follower {
    /// Goes on to the end of the next segment; `None` behind the last time.
    ///
    /// # Errors
    /// Why and where the motion cannot go on.
    pub fn next_segment(&mut self) -> Result<Option<SmoothSegment>, Box<Stop>> {
        let mut begins_at_edge = !self.begin()?;
        let last = self.last;
        let mut from = self.step.state().clone();
        self.rows.forget_steps();
        loop {
            if self.cross_edge()? {
                begins_at_edge = true;
                from.copy_from(self.step.state());
            }
            if self.step.t() >= last {
                return Ok(None);
            }
            self.count_step(last)?;
            if self.may_step_densely() {
                self.step_densely()?;
            } else {
                self.edge = self.step_to_edge(last)?;
            }
            if self.step.t() > from.t {
                return Ok(Some(self.stretch(from, begins_at_edge)));
            }
        }
    }

    fn stretch(&mut self, from: State, begins_at_edge: bool) -> SmoothSegment {
        let to = self.step.state().clone();
        let Follower { crossing, kinematics, step, .. } = self;
        let bridge = crossing.bridge_to(kinematics, step, to.t).cloned();
        let middle = if bridge.is_some() { None } else { self.middle_of_batch() };
        let ends_at_edge = self.edge.is_some() || to.t >= self.last;
        let chosen = self.choice.as_ref().and_then(RowSelection::current).cloned();
        SmoothSegment { from, middle, to, switches: self.switches(), chosen, bridge, begins_at_edge, ends_at_edge }
    }

    /// Returns the state in the middle of the step that was accepted last, if that was a dense step and can be solved for there.
    fn middle_of_batch(&mut self) -> Option<State> {
        let (batch, _) = self.rows.batch()?;
        batch.middle(&self.kinematics, &self.step)
    }

    /// Returns the results that the equations' switches have now.
    #[must_use]
    pub fn switches(&self) -> Rc<[f64]> {
        self.kinematics.switches().iter().map(|switch| self.kinematics.switch(switch)).collect()
    }
}
