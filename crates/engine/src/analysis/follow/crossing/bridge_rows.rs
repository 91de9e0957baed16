//! Rows on a bridge: from its curve where the equations hold on it, or else solved for from there where the solution can be trusted.

use super::bridge::Bridge;
use super::{CERTAIN, Crossing};
use crate::analysis::explain::{Stop, StopCause};
use crate::analysis::follow::step::Step;
use crate::analysis::state::{Kinematics, State, Trust};
use crate::limits::error_bound::SLOW;

/// Largest correction of a position on the curve that is solved for, as a part of its distance from the singular position, scaled: another
/// branch may be that near.
const NEAREST_BRANCH: f64 = 0.05;
/// Largest residuals of velocities and accelerations on the curve, scaled, relative to 1 or a part of the fastest motion.
const OPEN: [f64; 2] = [1e-8, 1e-6];

impl Crossing {
    /// Returns the bridge that a time (s) is on; where it is not passed, on its way up to the singular position.
    fn bridge_over(&self, t: f64) -> Option<&Bridge> {
        self.bridge.as_ref().filter(|bridge| {
            let end = if self.passes { bridge.to.t } else { bridge.at - CERTAIN * bridge.length() };
            t > bridge.from.t && t < end
        })
    }

    /// Returns whether a time (s) is on a bridge.
    pub fn is_on_bridge(&self, t: f64) -> bool {
        self.bridge_over(t).is_some()
    }

    /// Writes the row of a time on a bridge, if it is on one.
    pub fn write_row(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        t: f64,
        row: &mut [f64],
    ) -> Option<Result<(), Box<Stop>>> {
        let state = self.bridge_over(t)?.state_at(t);
        if write_given_row(kinematics, &state, row) || write_solved_row(kinematics, step, &state, row) {
            return Some(Ok(()));
        }
        // steps may reach the row from before
        self.passes.then(|| Err(StopCause::Uncertain { declarations: Vec::new() }.at(t)))
    }
}

/// Writes the row that is solved for from a state on a curve, if all its numbers have the promised digits.
fn write_solved_row(kinematics: &mut Kinematics, step: &mut Step, state: &State, row: &mut [f64]) -> bool {
    step.try_state(state);
    let Ok(correction) = step.correct(kinematics) else {
        return false;
    };
    if correction > NEAREST_BRANCH * kinematics.nearness(1.0) || step.derive_trial(kinematics).is_err() {
        return false;
    }
    let solved = step.trial().clone();
    let trust = Trust::of(kinematics, &solved);
    let is_certain = step.confirms(kinematics, &solved, trust);
    if is_certain {
        kinematics.write_row(&solved, row);
    }
    is_certain
}

/// Writes the row of a state on a curve, if the equations hold there, and those of velocity and acceleration with them.
fn write_given_row(kinematics: &mut Kinematics, state: &State, row: &mut [f64]) -> bool {
    kinematics.restore(state);
    if kinematics.violated().is_some() {
        return false;
    }
    kinematics.write_given_row(state, row);
    let linear = kinematics.linear();
    let (speed, bend) = (linear.largest(&state.qd), linear.largest(&state.qdd));
    let fastest = f64::max(SLOW * bend.max(speed * speed), 1.0);
    (0..state.q.len()).all(|row| {
        let (velocity, acceleration) = kinematics.left_open(row, state);
        velocity <= OPEN[0] * f64::max(SLOW * speed, 1.0) && acceleration <= OPEN[1] * fastest
    })
}
