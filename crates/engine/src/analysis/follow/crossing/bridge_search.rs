//! Search for a bridge over the singular position that the steps have come up to.

use super::bridge::Bridge;
use super::end_of_reach::end_of_reach;
use super::singular_times::{settle_times, singular_time};
use super::{CLEAR, Crossing, is_clear};
use crate::analysis::explain::singular;
use crate::analysis::follow::step::Step;
use crate::analysis::state::Kinematics;

/// The first state beyond is accepted if it is no closer to a singular position than this part of the limit.
const NEARLY_CLEAR: f64 = 0.3;
/// Maximum number of steps back from a start near a singular position.
const STEPS_BACK: usize = 64;
/// Length of a step back, scaled.
const STEP_BACK: f64 = 2e-3;
/// Distances beyond the singular position at which the first state is searched for, as parts of the path up to it.
const BEYOND: [f64; 4] = [0.7, 1.0, 2.0, 4.0];
/// Largest correction of the prediction beyond, as a part of the path: other branches are farther away.
const LARGEST_CORRECTION: f64 = 0.05;
/// Largest correction of the curve over the bridge at positions between, as a part of the path. A curve that joins two branches has
/// larger ones, even if the branches touch.
const LARGEST_BETWEEN: f64 = 1e-4;
/// Positions at which the curve over the bridge is verified, as parts of the path.
const PLACES: [f64; 3] = [0.25, 0.5, 0.75];

impl Crossing {
    /// Returns a bridge over the singular position that the steps have come up to, if the motion goes on there. A motion that begins next
    /// to it is followed from before its start.
    pub(super) fn bridge_ahead(&mut self, kinematics: &mut Kinematics, step: &mut Step) -> Option<Bridge> {
        let bridge = self.bridge_from_clear(kinematics, step);
        if bridge.is_none() && self.fold.is_none() && self.go_before_start(kinematics, step) {
            return self.bridge_from_clear(kinematics, step);
        }
        bridge
    }

    /// Looks for a clear state before the first time, if the motion is not clear of singular positions there; returns whether one exists.
    fn go_before_start(&mut self, kinematics: &mut Kinematics, step: &mut Step) -> bool {
        kinematics.restore(&self.clear);
        let mut state = self.clear.clone();
        // the start was kept without its derivatives
        let is_start = state.qd.iter().all(|speed| *speed == 0.0);
        if !is_start || kinematics.derivatives(&mut state).is_err() {
            return false;
        }
        if is_clear(kinematics) {
            self.clear = state;
            return true;
        }
        for _ in 0..STEPS_BACK {
            // the other branch is at most twice that far
            let way = kinematics.nearness(STEP_BACK).min(STEP_BACK);
            let linear = kinematics.linear();
            let (speed, bend) = (linear.largest(&state.qd), linear.largest(&state.qdd));
            let h = f64::min(way / speed, (way / bend).sqrt());
            step.predict_from(&state, -h, state.t - h);
            let is_found = step.correct(kinematics).is_ok()
                && step.same_branch(kinematics).is_ok()
                && step.derive_trial(kinematics).is_ok();
            if !is_found {
                return false;
            }
            state.copy_from(step.trial());
            if is_clear(kinematics) {
                self.clear = state;
                return true;
            }
        }
        false
    }

    /// Returns the bridge to a state beyond the singular position, to which the prediction from the last clear one leads.
    fn bridge_from_clear(&mut self, kinematics: &mut Kinematics, step: &mut Step) -> Option<Bridge> {
        kinematics.restore(step.state());
        // the motion ends where a line of centres vanishes
        if step.t() <= self.clear.t || singular::centers_that_meet(kinematics).is_some() {
            return None;
        }
        self.come_closer(kinematics, step);
        let (near, way) = (step.t(), step.t() - self.clear.t);
        for part in BEYOND {
            let bridge = self.bridge_until(kinematics, step, near + part * way);
            // a longer bridge does not lead beyond the end of reach
            if bridge.is_some() || self.fold.is_some() {
                return bridge;
            }
        }
        None
    }

    /// Brings the clear state as near to the singular position as it may be: the shorter the bridge, the better its middle.
    fn come_closer(&mut self, kinematics: &mut Kinematics, step: &mut Step) {
        let way = step.t() - self.clear.t;
        kinematics.restore(&self.clear);
        let enough = way * CLEAR / kinematics.nearness(1.0);
        if enough >= way {
            return;
        }
        let h = way - enough;
        step.predict_from(&self.clear, h, self.clear.t + h);
        if step.solve(kinematics).is_ok() {
            self.clear.copy_from(step.trial());
        }
    }

    /// Returns the bridge from the clear state to one at a time (s), if its curve holds and does not come to the end of reach.
    fn bridge_until(&mut self, kinematics: &mut Kinematics, step: &mut Step, t: f64) -> Option<Bridge> {
        let (h, clear) = (t - self.clear.t, &self.clear);
        let mut way: f64 = 0.0;
        let ahead = (0..clear.q.len()).map(|k| {
            let (first, second) = (h * clear.qd[k], 0.5 * h * h * clear.qdd[k]);
            // counts the way of a motion that turns back, too
            way = way.max((first.abs() + second.abs()) / kinematics.linear().column_scale(k));
            clear.q[k] + first + second
        });
        step.try_position(t, ahead);
        let correction = step.correct(kinematics).ok()?;
        step.derive_trial(kinematics).ok()?;
        let is_clear = kinematics.nearness(CLEAR) >= NEARLY_CLEAR * CLEAR;
        let mut bridge = Bridge::new(clear, step.trial());
        let is_small = correction <= LARGEST_CORRECTION * way && is_clear;
        if !is_small || !holds(kinematics, &bridge, LARGEST_BETWEEN * way) {
            return None;
        }
        bridge.at = singular_time(kinematics, step, &bridge);
        if let Some(fold) = end_of_reach(kinematics, &bridge) {
            self.fold = Some(fold);
            return None;
        }
        settle_times(kinematics, step, &mut bridge);
        Some(bridge)
    }
}

/// Returns whether the curve over a bridge leaves corrections of at most `limit`, scaled, with the factors of its end.
fn holds(kinematics: &mut Kinematics, bridge: &Bridge, limit: f64) -> bool {
    let mut delta = vec![0.0; bridge.to.q.len()];
    PLACES.into_iter().all(|place| {
        let state = bridge.state_at(bridge.from.t + place * bridge.length());
        kinematics.set_time(state.t);
        kinematics.set_position(&state.q).is_ok() && kinematics.correction(&mut delta) <= limit
    })
}
