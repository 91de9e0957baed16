//! Edges: the times where a formula changes to another of its branches.
//!
//! Within a step every switch is frozen, so that the equations are smooth there. An edge of time is sought before a step, one of the motion after it;
//! both are located to neighbouring doubles, and the step ends there. Then both sides are evaluated at that same time, and compared: a position or
//! velocity that jumps has no acceleration, an acceleration that jumps has two.

mod chattering;
mod domain_boundaries;
mod event_functions;
mod motion_boundaries;
mod motion_switches;
mod one_sided_limits;
mod one_sided_states;
mod signals;
mod time_switches;

use super::step::Step;
use super::warnings::Warnings;
use crate::analysis::explain::{Stop, singular};
use crate::analysis::state::{Fault, Kinematics, State, shortly_after};
use chattering::Chattering;
use domain_boundaries::DomainBoundaries;
use mechc_ir::program::Enclosure;
use motion_boundaries::MotionBoundaries;
pub use motion_boundaries::stop_at_boundary;
use one_sided_states::OneSidedStates;
use signals::Signals;

/// Smallest part that is searched for edges in time, as a part of the span.
const FINEST: f64 = 1e-8;

/// A change of a switch.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Time at which both sides are evaluated (s).
    pub t: f64,
    /// Time (s) at which every switch of time is on the later side; `None` for an edge of the motion.
    after: Option<f64>,
    /// True if it is the place from which a domain boundary is judged.
    is_domain_boundary: bool,
}

impl Edge {
    /// Returns the edge moved to another time (s).
    pub fn at(self, t: f64) -> Edge {
        Edge { t, ..self }
    }

    /// Returns the earlier edge of two.
    fn earlier(a: Option<Edge>, b: Option<Edge>) -> Option<Edge> {
        match (a, b) {
            (Some(a), Some(b)) => Some(if b.t < a.t { b } else { a }),
            (one, other) => one.or(other),
        }
    }
}

/// Events between the ends of steps: edges of time and of the motion, domain boundaries and signals.
pub struct Edges {
    /// The time that the steps are measured against, and the last time (s).
    span: f64,
    last: f64,
    /// Enclosures of the switches in time, and along the motion.
    in_time: Enclosure,
    along: Enclosure,
    /// Each coordinate's middle and reach in a part of a step.
    boxes: Vec<[f64; 2]>,
    /// By switch.
    chattering: Vec<Chattering>,
    /// An edge of the motion that a longer step has met.
    met: Option<Edge>,
    sides: OneSidedStates,
    domain_boundaries: DomainBoundaries,
    motion_boundaries: MotionBoundaries,
    signals: Signals,
    /// Position near the state.
    place: Vec<f64>,
}

impl Edges {
    /// Returns the edges of a motion from a state to the last time (s), measured against a span (s).
    pub fn new(kinematics: &mut Kinematics, state: &State, span: f64, last: f64) -> Edges {
        let n = state.q.len();
        let signals = Signals::new(kinematics, state);
        let domain_boundaries = DomainBoundaries::new(kinematics, state, span, last);
        let [in_time, along] = kinematics.enclosures();
        Edges {
            span,
            last,
            in_time,
            along,
            boxes: vec![[0.0; 2]; n],
            chattering: vec![Chattering::NEVER; kinematics.switches().len()],
            met: None,
            sides: OneSidedStates::new(kinematics, state, span),
            domain_boundaries,
            motion_boundaries: MotionBoundaries::new(kinematics, [span, last]),
            signals,
            place: vec![0.0; n],
        }
    }

    /// Returns the edge of the motion that a longer step has met.
    pub fn met(&self) -> Option<Edge> {
        self.met
    }

    /// Restores the edge that had been met at a checkpoint.
    pub fn go_back(&mut self, met: Option<Edge>) {
        self.met = met;
    }

    /// Returns whether a step to a time (s) comes to the edge that a longer step has met.
    pub fn is_met_by(&self, t: f64) -> bool {
        self.met.is_some_and(|met| met.t <= t)
    }

    /// Returns the row of the later side of the edge that was crossed last.
    pub fn later_row(&self) -> &[f64] {
        self.sides.later_row()
    }

    /// Sets every switch to what it is on the later side of the state; `after` is a time by which those of time have changed (s).
    pub fn settle(&mut self, kinematics: &mut Kinematics, state: &State, after: Option<f64>) {
        one_sided_states::settle(kinematics, state, self.span, after, &mut self.place);
    }

    /// Takes note of how fast velocities and accelerations change over a step of length `h` that is to be accepted.
    pub fn record_rates(&mut self, kinematics: &Kinematics, step: &Step, h: f64) {
        if !kinematics.switches().is_empty() {
            self.sides.record_rates(kinematics, [step.state(), step.trial()], h);
        }
    }

    /// Returns the first edge that a step to `next` meets before the last time. An edge within rounding of the output time `next` is put there.
    ///
    /// # Errors
    /// A formula of time ends on the way.
    pub fn next(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        next: f64,
        is_output: bool,
    ) -> Result<Option<Edge>, Box<Stop>> {
        let reach = if is_output { shortly_after(next) } else { next };
        let of_time = if self.in_time.is_empty() { None } else { self.edge_of_time(kinematics, [step.t(), reach])? };
        let edge = Edge::earlier(of_time, self.met.filter(|edge| edge.t <= reach));
        let boundary = self.domain_boundaries.next(kinematics, step, reach).map(|t| Edge {
            t,
            after: None,
            is_domain_boundary: true,
        });
        let edge = Edge::earlier(edge, boundary).map(|edge| edge.at(edge.t.min(next).max(step.t())));
        // at the last time the earlier side counts
        Ok(edge.filter(|edge| shortly_after(edge.t) < self.last))
    }

    /// Crosses to the later side of an edge, which the state has reached on the earlier one. Returns whether the edge has a row.
    pub fn cross(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        edge: Edge,
        warnings: &mut Warnings,
    ) -> Result<bool, Box<Stop>> {
        if edge.is_domain_boundary {
            return self.domain_boundaries.cross(kinematics, step, warnings).map(|()| false);
        }
        if self.met.is_some_and(|met| met.t <= edge.t) {
            self.met = None;
        }
        self.sides.remember(kinematics, step.state());
        self.settle(kinematics, step.state(), edge.after);
        match self.sides.take_later(kinematics, step) {
            Ok(None) => self.note_chattering(kinematics, step.t()),
            Ok(Some(jump)) => self.sides.report(kinematics, step, jump, warnings)?,
            Err(fault) => {
                return Err(singular::find_stop(kinematics, self.sides.before(), fault, [0.0, step.t()]));
            }
        }
        Ok(true)
    }

    /// Returns the stop of a motion that a domain boundary ends just ahead: even a step as small as `h` (s) failed.
    pub fn end_at_domain_boundary(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        h: f64,
        fault: Fault,
    ) -> Option<Box<Stop>> {
        self.domain_boundaries.end().or_else(|| match fault {
            // a formula without a value is the reason itself
            Fault::NotFinite { .. } | Fault::Condition { .. } => None,
            _ => self.motion_boundaries.end(kinematics, step, h),
        })
    }

    /// Refuses a step of length `h`, whose curve must have been drawn, between whose ends something happens: a signal leaves its values at
    /// the ends, or the step passes an edge of the motion or a domain boundary. `between` is how far the curve is off, scaled; `None` for a
    /// step to an edge of the motion, beyond which switches are not checked.
    pub fn check_interior(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        h: f64,
        between: Option<f64>,
    ) -> Result<(), Fault> {
        self.signals.look(kinematics, step, h)?;
        if let Some(between) = between {
            self.look_for_switches(kinematics, step, h, between)?;
        }
        self.motion_boundaries.look(kinematics, step, h)
    }
}
