//! Switches that go back and forth without effect.

use super::{Edges, FINEST};
use crate::analysis::follow::step::Step;
use crate::analysis::state::{Kinematics, aslant};
use mechc_ir::program::Register;

/// Longest time for which a chattering switch is ignored, as a part of the span.
const LONGEST_REST: f64 = 1e-2;
/// A motion of at most this size, scaled, is rest.
const AT_REST: f64 = 1e-12;
/// A motion of at most this many units in the last place is rest.
const ROUNDING: f64 = 64.0;
/// Change of coordinates for the difference quotient of a switch, scaled.
const NUDGE: f64 = 1e-6;

/// A switch that has gone back and forth without anything to show for it: two branches that agree to rounding. It is left
/// alone for a while, and for longer each time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chattering {
    last: f64,
    length: f64,
    until: f64,
}

impl Chattering {
    /// A switch that has never chattered.
    pub const NEVER: Chattering = Chattering { last: f64::NEG_INFINITY, length: 0.0, until: f64::NEG_INFINITY };

    /// Returns whether the switch is ignored after a time (s).
    pub fn is_suspended(&self, t: f64) -> bool {
        self.until > t
    }

    /// Ignores the switch up to a time (s).
    pub fn suspend_until(&mut self, until: f64) {
        self.until = until;
    }

    /// Records a change at a time (s) without a jump; times are measured against a span (s).
    fn take_change(&mut self, t: f64, span: f64) {
        let at_once = t - self.last <= f64::max(4.0 * self.length, FINEST * span);
        self.length = if at_once { f64::max(2.0 * self.length, FINEST * span) } else { 0.0 };
        self.length = self.length.min(LONGEST_REST * span);
        (self.last, self.until) = (t + self.length, t + self.length);
    }
}

/// Returns whether the switch that is computed in a register is left alone behind a time (s), so that it may change.
pub(super) fn may_change(kinematics: &Kinematics, chattering: &[Chattering], register: Register, t: f64) -> bool {
    let mut switches = kinematics.switches().iter().zip(chattering);
    switches.any(|(switch, chattering)| switch.to == register && chattering.is_suspended(t))
}

impl Edges {
    /// Records an edge without a jump: if it is one of many in no time at all, its switch is left alone for a while.
    pub(super) fn note_chattering(&mut self, kinematics: &Kinematics, t: f64) {
        let switches = kinematics.switches().iter().zip(self.sides.switches());
        for (chattering, (switch, before)) in self.chattering.iter_mut().zip(switches) {
            if kinematics.switch(switch).to_bits() != before.to_bits() {
                chattering.take_change(t, self.span);
            }
        }
    }

    /// Returns whether a switch that changes at the current position stands on its edge all the time, so that rounding decides:
    /// what it is decided by neither is off the edge nor has it moved since the state.
    pub fn rests(&mut self, kinematics: &mut Kinematics, step: &Step, switch: usize) -> bool {
        let switch = kinematics.switches()[switch];
        let (there, off) = kinematics.edge(&switch);
        kinematics.set_time(step.t());
        let mut at = |nudge: f64| {
            let linear = kinematics.linear();
            for (k, (place, q)) in self.place.iter_mut().zip(&step.state().q).enumerate() {
                *place = q + nudge * linear.column_scale(k) * aslant(k);
            }
            // a fault of the position shows when it is solved for
            let _ = kinematics.set_position(&self.place);
            kinematics.edge(&switch).0
        };
        let (nudged, here) = (at(NUDGE), at(0.0));
        let largest = kinematics.linear().largest(&step.state().q);
        let nothing = f64::max(AT_REST, ROUNDING * f64::EPSILON * largest) * (nudged - here).abs() / NUDGE;
        off <= nothing && (there - here).abs() <= nothing
    }

    /// Leaves a switch alone up to a time (s).
    pub fn suspend_until(&mut self, switch: usize, t: f64) {
        self.chattering[switch].suspend_until(t);
    }
}
