//! Rows on a bridge: from its curve where that is exact, or else solved for from there.

use super::bridge::Bridge;
use super::{CERTAIN, Crossing, EXACT, SOLVABLE};
use crate::analysis::explain::{Stop, StopCause};
use crate::analysis::follow::step::Step;
use crate::analysis::state::{Kinematics, State};
use crate::limits::error_bound::SLOW;

/// Largest residuals of velocities and accelerations on the curve, scaled, relative to 1 or a part of the fastest motion.
const OPEN: [f64; 2] = [1e-8, 1e-6];

impl Crossing {
    /// Writes the row of a time on a bridge, if it is on one; where the bridge is not passed, on its way up to the singular position.
    pub fn write_row(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        t: f64,
        row: &mut [f64],
    ) -> Option<Result<(), Box<Stop>>> {
        let is_on = |bridge: &&mut Bridge| {
            let end = if self.passes { bridge.to.t } else { bridge.at - CERTAIN * bridge.length() };
            t > bridge.from.t && t < end
        };
        let bridge = self.bridge.as_mut().filter(is_on)?;
        let state = bridge.state_at(t);
        let mut by_finer_curve = |kinematics: &mut Kinematics, step: &mut Step, row: &mut [f64]| {
            let finer = bridge.finer_state_at(kinematics, step, t);
            finer.is_some_and(|state| write_given_row(kinematics, &state, row))
        };
        if write_given_row(kinematics, &state, row)
            || write_solved_row(kinematics, step, &state, EXACT, row)
            || by_finer_curve(kinematics, step, row)
            || write_solved_row(kinematics, step, &state, SOLVABLE, row)
        {
            return Some(Ok(()));
        }
        // the row may be certain without the bridge
        self.passes.then(|| Err(StopCause::Uncertain { declarations: Vec::new() }.at(t)))
    }

    /// Returns the state at a time by the curve over the last singular position.
    pub fn state_at(&self, t: f64) -> Option<State> {
        self.bridge.as_ref().map(|bridge| bridge.state_at(t))
    }

    /// Writes the row of a time on a bridge by a curve over a shorter way, if that is exact there.
    pub fn write_narrow_row(&mut self, kinematics: &mut Kinematics, step: &mut Step, t: f64, row: &mut [f64]) -> bool {
        let Some(bridge) = &mut self.bridge else {
            return false;
        };
        let state = bridge.narrow_state_at(kinematics, step, t);
        state.is_some_and(|state| write_given_row(kinematics, &state, row))
    }
}

/// Writes the row of a time on a bridge whose curve is not exact enough, by solving from it, if it is at least so far from
/// the singular position.
fn write_solved_row(
    kinematics: &mut Kinematics,
    step: &mut Step,
    state: &State,
    nearest: f64,
    row: &mut [f64],
) -> bool {
    step.try_state(state);
    let is_solved = step.correct(kinematics).is_ok()
        && kinematics.nearness(nearest) >= nearest
        && step.derive_trial(kinematics).is_ok();
    if is_solved {
        kinematics.write_row(step.trial(), row);
    }
    is_solved
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
