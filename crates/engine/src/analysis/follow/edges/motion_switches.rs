//! Edges of the motion, which are sought behind a step, on its curve.

use super::chattering::may_change;
use super::{Edge, Edges};
use crate::analysis::follow::step::Step;
use crate::analysis::state::{Fault, Kinematics};
use mechc_expr::math::{Halving, about, enclose_root, farthest};
use std::cell::Cell;

/// Smallest part of a step that is examined, as a part of the step.
const FINEST_BETWEEN: f64 = 2e-4;
/// Maximum number of parts of a step.
const MOST_PARTS_BETWEEN: usize = 500;

impl Edges {
    /// Returns the switch of the motion whose edge the position that was just set has passed, on the way from a time (s).
    pub fn switch_met(&self, kinematics: &Kinematics, from: f64) -> Option<usize> {
        let mut switches = kinematics.switches().iter().zip(&self.chattering);
        switches.position(|(switch, chattering)| {
            !switch.on_time && !chattering.is_suspended(from) && kinematics.would_switch(switch)
        })
    }

    /// Refuses a step to a time (s), whose position was just set, if that is beyond an edge of the motion.
    pub fn before_switch(&self, kinematics: &Kinematics, from: f64, t: f64) -> Result<(), Fault> {
        self.switch_met(kinematics, from).map_or(Ok(()), |switch| Err(Fault::Edge { t, switch }))
    }

    /// Finds the edge of the motion that lies before a time; returns whether it could.
    pub fn locate(&mut self, kinematics: &mut Kinematics, step: &mut Step, next: f64) -> bool {
        let from = step.t();
        // the switch that changes, and whether formulas go on beyond the edge as far as it is known
        let (mut switch, goes_on) = (None, Cell::new(false));
        let mut look = |t: f64| {
            let solved = step.predict(kinematics, t - from, t).and_then(|_| step.correct(kinematics));
            let met = solved.map(|_| self.switch_met(kinematics, from));
            let is_behind = !matches!(met, Ok(None));
            if is_behind {
                goes_on.set(met.is_ok());
            }
            switch = met.unwrap_or(None).or(switch);
            let off =
                switch.filter(|_| goes_on.get() || !is_behind).map(|k| kinematics.edge(&kinematics.switches()[k]).1);
            (is_behind, off.unwrap_or(f64::NAN))
        };
        let [(is_behind, off_behind), (_, off)] = [next, from].map(&mut look);
        if !is_behind || !goes_on.get() {
            return false;
        }
        let closed_in = enclose_root([[from, off], [next, off_behind]], 0.0, |t| Some(look(t)));
        let edge = closed_in.filter(|_| goes_on.get());
        if let Some([_, t]) = edge {
            self.met = Some(Edge { t, after: None, is_domain_boundary: false });
        }
        edge.is_some()
    }

    /// Checks a step that was tried for events between its ends, on the curve through both: an edge of the motion, a formula that ends, a
    /// branch that is left and taken again.
    pub(super) fn look_for_switches(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        h: f64,
        between: f64,
    ) -> Result<(), Fault> {
        if self.along.is_empty() {
            return Ok(());
        }
        let mut parts = Halving::<32>::new([0.0, 1.0], FINEST_BETWEEN, MOST_PARTS_BETWEEN);
        while let Some(part) = parts.next_part() {
            if !self.is_steady_between(kinematics, step, h, part, between) && !parts.halve(part) {
                self.look_at(kinematics, step, h, part[1])?;
            }
        }
        Ok(())
    }

    fn is_steady_between(
        &mut self,
        kinematics: &Kinematics,
        step: &Step,
        h: f64,
        [a, b]: [f64; 2],
        between: f64,
    ) -> bool {
        let (middle, reach) = (0.5 * (a + b), 0.5 * (b - a));
        for (k, (of, curve)) in self.boxes.iter_mut().zip(step.curve()).enumerate() {
            let taylor = about(curve, middle);
            let slack = 2.0 * between * kinematics.linear().column_scale(k);
            *of = [taylor[0], farthest(&taylor[1..], reach) + slack];
        }
        let t = step.t();
        let Edges { along, boxes, chattering, .. } = self;
        let may_change = |register| may_change(kinematics, chattering, register, t);
        kinematics.is_steady(along, [t + a * h, t + b * h], boxes, may_change)
    }

    /// Looks at one place of the curve through both ends of a step.
    fn look_at(&self, kinematics: &mut Kinematics, step: &mut Step, h: f64, x: f64) -> Result<(), Fault> {
        step.set_on_curve(kinematics, h, x)?;
        self.before_switch(kinematics, step.t(), step.t() + x * h)?;
        step.check_monitors(kinematics)
    }
}
