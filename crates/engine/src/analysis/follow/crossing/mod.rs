//! Crossing of a singular position: from the last state that is well clear of it to one as far beyond, never solving at it.
//!
//! Beyond a lock-up there is no such state. Beyond a bifurcation the prediction from before leads to the branch that goes on smoothly,
//! since the other ones are far from it there. Between the two states the motion is the quintic through both, from which the time of the
//! singular position follows.

mod bridge;
mod bridge_rows;
mod bridge_search;
mod end_of_reach;
mod refined_bridge;
mod singular_times;

use super::step::Step;
use super::warnings::Warnings;
use crate::analysis::explain::{Stop, singular};
use crate::analysis::state::{Fault, Kinematics, State};
use crate::limits::singular::CLEAR_PIVOT;
pub use bridge::Bridge;

/// A state closer than this to a singular position is not clear of it.
///
/// Rounding in Φ is multiplied by 1/σ in q, and by 1/σ again in each derivative: 8e-3 leaves nine digits.
const CLEAR: f64 = 8e-3;
/// A state closer than this to a singular position cannot be solved for: rounding by 1/σ² exceeds the promised accuracy.
const SOLVABLE: f64 = 1e-3;
/// Closest distance to a singular position at which solving leaves more than eight digits of accelerations.
const EXACT: f64 = 4e-3;
/// Accuracy of the time of a singular position, as a part of the bridge.
const CERTAIN: f64 = 1e-6;

/// Returns whether the position that was factored is clear of every singular one.
pub fn is_clear(kinematics: &mut Kinematics) -> bool {
    kinematics.linear().smallest_pivot() > CLEAR_PIVOT * CLEAR || kinematics.nearness(CLEAR) >= CLEAR
}

/// Singular positions on the path: the last clear state, and the bridges.
pub struct Crossing {
    /// True if the motion goes on beyond bifurcations.
    passes: bool,
    /// The last state that was clear of singular positions.
    clear: State,
    /// Bridge over the last singular position.
    bridge: Option<Bridge>,
    /// Bridge that was only sought to compare a row with.
    spare: Option<Bridge>,
    /// Time (s) up to which no singular position lies ahead: the motion is clear again then.
    clear_ahead: f64,
    /// Time at which the mechanism comes to the end of its reach, where that nearly suffices (s).
    fold: Option<f64>,
    /// The time that the steps are measured against, and the last time (s).
    span: f64,
    last: f64,
}

/// Bridge that is set aside.
pub struct SuspendedBridge {
    bridge: Option<Bridge>,
    passes: bool,
}

impl Crossing {
    pub fn new(state: &State, span: f64, last: f64) -> Crossing {
        Crossing {
            passes: false,
            clear: state.clone(),
            bridge: None,
            spare: None,
            clear_ahead: f64::NEG_INFINITY,
            fold: None,
            span,
            last,
        }
    }

    /// Makes the motion go on beyond bifurcations from now on.
    pub fn pass_bifurcations(&mut self) {
        self.passes = true;
    }

    /// Returns whether the motion goes on beyond bifurcations.
    pub fn passes(&self) -> bool {
        self.passes
    }

    /// Returns the last state that was clear of singular positions.
    pub fn clear(&self) -> &State {
        &self.clear
    }

    /// Returns whether a state of a time (s) that was come to was clear.
    pub fn was_clear_at(&self, t: f64) -> bool {
        self.clear.t.total_cmp(&t).is_eq()
    }

    /// Keeps the state that was just accepted if it is clear of every singular position.
    pub fn keep_if_clear(&mut self, kinematics: &mut Kinematics, state: &State) {
        if is_clear(kinematics) {
            self.clear.copy_from(state);
        }
    }

    /// Goes back to where another state was the last clear one.
    pub fn go_back(&mut self, clear: &State) {
        self.clear.copy_from(clear);
    }

    /// Returns whether the motion is clear again at some time after `t` (s), as far as it was looked ahead.
    pub fn is_clear_ahead(&self, t: f64) -> bool {
        t < self.clear_ahead
    }

    /// Records that the motion is clear again at a time (s).
    pub fn take_clear_ahead(&mut self, t: f64) {
        self.clear_ahead = t;
    }

    /// Returns whether a bridge ends at a time (s).
    pub fn has_bridge_to(&self, t: f64) -> bool {
        self.bridge.as_ref().is_some_and(|bridge| bridge.to.t.total_cmp(&t).is_eq())
    }

    /// Returns the bridge that ends at a time (s), with the most exact curve over it.
    pub fn bridge_to(&mut self, kinematics: &mut Kinematics, step: &mut Step, t: f64) -> Option<&Bridge> {
        let bridge = self.bridge.as_mut().filter(|bridge| bridge.to.t.total_cmp(&t).is_eq())?;
        bridge.look_for_exact(kinematics, step);
        Some(bridge)
    }

    /// Returns whether a singular position has been passed by a time (s).
    pub fn has_passed(&self, t: f64) -> bool {
        self.bridge.as_ref().is_some_and(|bridge| bridge.at <= t)
    }

    /// Sets the bridge aside while another one is sought for a single row.
    pub fn suspend(&mut self) -> SuspendedBridge {
        let bridge = std::mem::replace(&mut self.bridge, self.spare.take());
        SuspendedBridge { bridge, passes: self.passes }
    }

    /// Restores the suspended bridge, and keeps the one that was found for the next row.
    pub fn resume(&mut self, suspended: SuspendedBridge) {
        self.spare = std::mem::replace(&mut self.bridge, suspended.bridge);
        (self.passes, self.fold) = (suspended.passes, None);
    }

    /// Sets the bridge aside and passes no bifurcations, until [`Crossing::remember`].
    pub fn forget(&mut self) -> SuspendedBridge {
        let suspended = SuspendedBridge { bridge: self.bridge.take(), passes: self.passes };
        self.passes = false;
        suspended
    }

    /// Restores the bridge that [`Crossing::forget`] set aside.
    pub fn remember(&mut self, suspended: SuspendedBridge) {
        (self.bridge, self.passes) = (suspended.bridge, suspended.passes);
    }

    /// Handles the fault of a last step of length `h` (s) on the way to `target` (s): goes on beyond a bifurcation if that is wanted.
    ///
    /// # Errors
    /// Why and where the motion cannot go on.
    pub fn pass_or_explain(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        fault: Fault,
        [h, target]: [f64; 2],
        warnings: &mut Warnings,
    ) -> Result<(), Box<Stop>> {
        let is_singular = matches!(fault, Fault::Singular | Fault::Choice | Fault::TooFar | Fault::Monitor { .. });
        self.fold = None;
        let bridge = if is_singular { self.bridge_ahead(kinematics, step) } else { None };
        let Some(bridge) = bridge else {
            return Err(singular::find_stop_near_fold(kinematics, step.state(), fault, [h, target], self.fold));
        };
        kinematics.restore(&bridge.to);
        if let Err(Fault::Monitor { index }) = step.check_monitors(kinematics) {
            // beyond it two bodies would go through each other: no branch goes on there, however smooth the equations are
            kinematics.restore(&bridge.state_at(bridge.at));
            let stop = singular::end_of_contact(kinematics, index, bridge.at);
            self.bridge = Some(bridge);
            return Err(stop);
        }
        if !self.passes {
            let stop = singular::stop_at_bifurcation(kinematics, &bridge.state_at(bridge.at));
            // rows before the singular position may lie on the bridge
            self.bridge = Some(bridge);
            return Err(stop);
        }
        for at in [Some(bridge.at), bridge.again].into_iter().flatten() {
            // a bifurcation behind the last row is not reported
            if at <= self.last + CERTAIN * bridge.length() {
                warnings.push(singular::warn_of_passage(kinematics, &bridge.state_at(at)));
            }
        }
        self.clear.copy_from(&bridge.to);
        step.go_to(kinematics, &bridge.to, bridge.length().min(self.span));
        self.bridge = Some(bridge);
        Ok(())
    }
}
