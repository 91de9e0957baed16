//! Checkpoints, to which a motion returns after it only looked ahead.

use super::crossing::Crossing;
use super::edges::{Edge, Edges};
use super::step::{Mark, Step};
use crate::analysis::state::State;

/// Start of the next step, with what a motion restores to return there.
#[derive(Clone)]
pub struct Checkpoint {
    pub mark: Mark,
    /// The last state that was clear of singular positions.
    pub clear: State,
    /// The edge of the motion that a longer step has met.
    pub met: Option<Edge>,
}

impl Checkpoint {
    pub fn new(step: &Step, edges: &Edges, crossing: &Crossing) -> Checkpoint {
        Checkpoint { mark: step.mark(), clear: crossing.clear().clone(), met: edges.met() }
    }

    /// Writes the current checkpoint into this one.
    pub fn write(&mut self, step: &Step, edges: &Edges, crossing: &Crossing) {
        step.write_mark(&mut self.mark);
        self.clear.copy_from(crossing.clear());
        self.met = edges.met();
    }

    /// Returns the state of the checkpoint.
    pub fn state(&self) -> &State {
        &self.mark.state
    }
}
