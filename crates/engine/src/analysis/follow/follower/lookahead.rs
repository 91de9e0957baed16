//! Rows that are found on a bridge over a singular position behind them.

use super::{Follower, STEPS_AHEAD};
use crate::analysis::explain::{Stop, singular};
use crate::analysis::follow::crossing::is_clear;
use crate::limits::step_control::FEWEST_STEPS_NEAR;

impl Follower {
    /// Settles the row of a time `t` that is so near to a singular position that rounding may have spoiled it: mostly a lock-up comes right
    /// behind it, or a bifurcation, and then the row lies on the bridge over that. A row that lies on none is printed as it was solved for, if
    /// it is confirmed.
    pub(super) fn look_ahead(&mut self, t: f64) -> Result<(), Box<Stop>> {
        let (trust, row, here) = (self.rows.trust(), self.rows.single().to_vec(), self.checkpoint());
        let why = self.step_ahead(t);
        let on_bridge = self.row_on_bridge(t);
        if let Some(Ok(())) = on_bridge {
            // a bridge that is passed leads on from its end
            if !self.crossing.passes() {
                self.go_back(&here);
            }
            return Ok(());
        }
        self.go_back(&here);
        let Follower { kinematics, step, .. } = self;
        if !step.confirms(kinematics, here.state(), trust) {
            return on_bridge.unwrap_or_else(|| Err(self.explain_refused(t, why)));
        }
        self.rows.single_mut().copy_from_slice(&row);
        if !self.rows.is_near() {
            self.refine(t);
        }
        self.kinematics.restore(self.step.state());
        Ok(())
    }

    /// Steps from a row of a time `t` on until it lies on a bridge, or the motion is clear again, or cannot go on; returns why. The singular
    /// position may be twice as far off as the last clear state.
    fn step_ahead(&mut self, t: f64) -> Option<Box<Stop>> {
        let ahead = t + f64::max(self.span / FEWEST_STEPS_NEAR, 2.0 * (t - self.crossing.clear().t));
        for _ in 0..STEPS_AHEAD {
            if let Err(why) = self.step_towards(ahead) {
                return Some(why);
            }
            // a step that failed leaves the factors of where it failed
            self.kinematics.restore(self.step.state());
            let is_clear = self.step.t() > t && is_clear(&mut self.kinematics);
            if is_clear || self.step.t() >= ahead || self.crossing.is_on_bridge(t) {
                break;
            }
        }
        None
    }

    /// Returns why the row of a time `t` is not printed: the stop that ends the motion, unless it comes behind the last row, or else the
    /// nearness of the row to a singular position.
    fn explain_refused(&mut self, t: f64, why: Option<Box<Stop>>) -> Box<Stop> {
        why.filter(|stop| stop.t <= self.last).unwrap_or_else(|| {
            let singular = self.kinematics.worst();
            singular::uncertain(self.kinematics.system(), &singular.left, t)
        })
    }
}
