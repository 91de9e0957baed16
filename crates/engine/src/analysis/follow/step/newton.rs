//! Newton's method: brings the trial state, or the state itself, to where all equations hold.

use super::Step;
use crate::analysis::state::{Fault, Kinematics};
use crate::limits::singular::CLEAR_PIVOT;
use crate::limits::step_control::LARGEST_CORRECTION;

/// Largest later correction, as a part of the largest first one.
const LATER_CORRECTION: f64 = 0.25;
/// Maximum number of corrections of a step.
const ITERATIONS: usize = 4;
/// A smaller correction needs no further one, since convergence is quadratic.
const SETTLED: f64 = 1e-7;
/// Closer to a singular position than this, more digits are required.
const ILL: f64 = 0.01;

impl Step {
    /// Corrects the state that is tried, and finds its derivatives.
    pub fn solve(&mut self, kinematics: &mut Kinematics) -> Result<(), Fault> {
        self.correct(kinematics)?;
        self.derive_trial(kinematics)
    }

    /// Iterates Newton's method until the full Φ is below the tolerance; returns the size of the first correction.
    pub fn correct(&mut self, kinematics: &mut Kinematics) -> Result<f64, Fault> {
        kinematics.set_time(self.trial.t);
        kinematics.set_position(&self.trial.q)?;
        let mut first = None;
        for _ in 0..ITERATIONS {
            kinematics.factor()?;
            kinematics.correction(&mut self.delta);
            let size = kinematics.linear().largest_judged(&self.delta);
            let bound = if first.is_none() { LARGEST_CORRECTION } else { LATER_CORRECTION * LARGEST_CORRECTION };
            if size.is_nan() || size > bound {
                return Err(Fault::TooFar);
            }
            first.get_or_insert(size);
            for (q, delta) in self.trial.q.iter_mut().zip(&self.delta) {
                *q += delta;
            }
            kinematics.set_position(&self.trial.q)?;
            if size <= SETTLED && size <= settled(kinematics) && kinematics.violated().is_none() {
                let broken = kinematics.broken_check();
                kinematics.factor()?;
                if let Some(index) = broken {
                    // near a singular position the position is uncertain, rather than the equation broken
                    let is_near = kinematics.nearness(ILL) < ILL;
                    return Err(if is_near { Fault::Singular } else { Fault::Check { index } });
                }
                return Ok(first.unwrap_or(size));
            }
        }
        Err(Fault::TooFar)
    }

    /// Solves for the state anew where it is, with the present branches of the formulas, in at most `corrections` corrections. Returns
    /// false if its position would have to move farther than a limit, scaled.
    pub fn correct_state(
        &mut self,
        kinematics: &mut Kinematics,
        corrections: usize,
        farthest: f64,
    ) -> Result<bool, Fault> {
        kinematics.set_time(self.state.t);
        kinematics.set_position(&self.state.q)?;
        kinematics.factor()?;
        for iteration in 0..corrections {
            let size = kinematics.correction(&mut self.delta);
            if iteration == 0 && (size.is_nan() || size > farthest) {
                return Ok(false);
            }
            for (q, delta) in self.state.q.iter_mut().zip(&self.delta) {
                *q += delta;
            }
            kinematics.set_position(&self.state.q)?;
            if kinematics.violated().is_none() {
                break;
            }
        }
        if kinematics.violated().is_some() {
            return Err(Fault::TooFar);
        }
        kinematics.factor()?;
        self.same_branch(kinematics)?;
        self.begin_branch(kinematics);
        self.derive_state(kinematics)?;
        Ok(true)
    }

    /// Tries the state a moment later (s), by its velocities alone.
    pub fn try_moment_later(&mut self, kinematics: &mut Kinematics, moment: f64) -> Result<(), Fault> {
        self.trial.copy_from(&self.state);
        self.trial.t += moment;
        for (q, qd) in self.trial.q.iter_mut().zip(&self.state.qd) {
            *q += moment * qd;
        }
        kinematics.set_time(self.trial.t);
        kinematics.set_position(&self.trial.q)?;
        kinematics.factor()?;
        self.derive_trial(kinematics)
    }
}

/// Returns the size of a correction that leaves nothing to the next one: near a singular position what it leaves is larger by the inverse
/// of the nearness, and no correction is smaller than rounding.
fn settled(kinematics: &mut Kinematics) -> f64 {
    if kinematics.linear().smallest_pivot() > CLEAR_PIVOT * ILL {
        return SETTLED;
    }
    let sigma = kinematics.nearness(ILL);
    if sigma < ILL { f64::max(SETTLED * sigma, 10.0 * f64::EPSILON / sigma) } else { SETTLED }
}
