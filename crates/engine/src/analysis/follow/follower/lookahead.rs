//! Rows that are compared with the motion behind them.

use super::{Follower, STEPS_AHEAD};
use crate::analysis::explain::{Stop, singular};
use crate::analysis::follow::checkpoint::Checkpoint;
use crate::analysis::follow::crossing::is_clear;
use crate::analysis::state::Trust;
use crate::limits::step_control::FEWEST_STEPS_NEAR;

impl Follower {
    /// Returns the time (s) up to which the motion is looked ahead from a time `t`: a singular position so near to a row that its
    /// derivatives are in doubt may be twice as far off as the last clear state.
    pub(super) fn time_ahead(&self, t: f64) -> f64 {
        let usual = self.span / FEWEST_STEPS_NEAR;
        let is_in_doubt = self.rows.trust() == Trust::Doubtful;
        t + if is_in_doubt { usual.max(2.0 * (t - self.crossing.clear().t)) } else { usual }
    }

    /// Checks a row whose derivatives would be more rounding than digits: mostly a lock-up comes right behind it, or a bifurcation, and
    /// then the row may lie on the bridge over it. Returns true if no bridge was found and the row is certain as it was solved.
    pub(super) fn look_ahead(&mut self, t: f64) -> Result<bool, Box<Stop>> {
        let (trust, row, here) = (self.rows.trust(), self.rows.single().to_vec(), self.checkpoint());
        let is_certain = self.is_certain(here.state());
        // a run that passes no bifurcation prints it too, if none has been passed before
        let is_plain = is_certain && !self.crossing.has_passed(t);
        let (mut ahead, farthest) = (t + self.span / FEWEST_STEPS_NEAR, self.time_ahead(t));
        for _ in 0..STEPS_AHEAD {
            if let Err(why) = self.step_towards(ahead) {
                // a stop behind the row does not concern it
                if is_certain {
                    break;
                }
                return self.row_before(t, &here, why).map(|()| false);
            }
            match self.row_on_bridge(t) {
                // the curve over the bridge is not exact enough, but the row is
                Some(Err(_)) if is_plain => return Ok(self.keep_plain(here, &row)),
                Some(on_bridge) => {
                    self.rows.keep_plain(is_plain.then_some(here));
                    return self.or_solve_directly(t, on_bridge).map(|()| false);
                }
                None => {}
            }
            // a step that failed leaves the factors of where it failed
            self.kinematics.restore(self.step.state());
            if trust != Trust::Uncertain && self.step.t() > t && is_clear(&mut self.kinematics) {
                break;
            }
            if self.step.t() >= ahead {
                if is_certain || ahead >= farthest {
                    break;
                }
                ahead = farthest;
            }
        }
        // the next row lies before the states ahead
        self.go_back(&here);
        if is_certain {
            self.rows.single_mut().copy_from_slice(&row);
            return Ok(true);
        }
        Err(self.explain_uncertain(t))
    }

    /// Settles the row of a time `t` that is not certain as it was found, where the motion behind it cannot go on: it may lie on a bridge.
    fn row_before(&mut self, t: f64, here: &Checkpoint, why: Box<Stop>) -> Result<(), Box<Stop>> {
        let on_bridge = self.row_on_bridge(t);
        self.go_back(here);
        on_bridge.unwrap_or_else(|| Err(self.explain_refused(t, Some(why))))
    }

    /// Returns why the row of a time `t` is not printed: the stop that ends the motion, unless it comes behind the last row, or else the
    /// nearness of the row to a singular position.
    pub(super) fn explain_refused(&mut self, t: f64, why: Option<Box<Stop>>) -> Box<Stop> {
        why.filter(|stop| stop.t <= self.last).unwrap_or_else(|| self.explain_uncertain(t))
    }

    fn explain_uncertain(&mut self, t: f64) -> Box<Stop> {
        let singular = self.kinematics.worst();
        singular::uncertain(self.kinematics.system(), &singular.left, t)
    }

    /// Keeps a row that was found without a bridge, so that the next one on that bridge may be found in the same way.
    fn keep_plain(&mut self, here: Checkpoint, row: &[f64]) -> bool {
        self.rows.single_mut().copy_from_slice(row);
        self.kinematics.restore(here.state());
        self.refine(here.state().t);
        self.kinematics.restore(self.step.state());
        self.rows.keep_plain(Some(here));
        false
    }

    /// Finds the row of a time on a bridge by steps from the row before, as if the bridge were not there; returns whether that row is certain.
    pub(super) fn plain_row(&mut self, t: f64) -> bool {
        let Some(plain) = self.rows.take_plain(t) else {
            return false;
        };
        let (beyond, suspended) = (self.checkpoint(), self.crossing.forget());
        self.go_back(&plain);
        let is_found = self.steps_to(t) && self.is_certain(&self.step.state().clone());
        let here = self.checkpoint();
        self.crossing.remember(suspended);
        self.go_back(&beyond);
        if is_found {
            let row = self.rows.single().to_vec();
            self.keep_plain(here, &row);
        }
        is_found
    }

    /// Steps to the time of the next row by way of all output times before; returns whether it gets there.
    fn steps_to(&mut self, t: f64) -> bool {
        while self.step.t() < t {
            let upcoming = self.rows.upcoming_after(self.step.t());
            if self.count_step(t).is_err() || self.step_towards(upcoming).is_err() {
                return false;
            }
        }
        true
    }
}
