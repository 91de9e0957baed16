//! Edges of time, which are sought before a step.

use super::chattering::may_change;
use super::{Edge, Edges, FINEST};
use crate::analysis::explain::{Stop, StopCause};
use crate::analysis::state::Kinematics;
use mechc_expr::math::{Halving, bisect};

/// Maximum number of parts in one step: a formula that stays on its edge is never decided.
const MOST_PARTS: usize = 2000;

impl Edges {
    /// Returns the first edge of time from a time on, at which all switches have been evaluated, up to another.
    pub(super) fn edge_of_time(
        &mut self,
        kinematics: &mut Kinematics,
        whole: [f64; 2],
    ) -> Result<Option<Edge>, Box<Stop>> {
        let mut parts = Halving::<64>::new(whole, FINEST * self.span, MOST_PARTS);
        while let Some(part) = parts.next_part() {
            if self.is_steady_in_time(kinematics, part) || parts.halve(part) {
                continue;
            }
            if let Some(edge) = self.edge_within(kinematics, part)? {
                return Ok(Some(edge));
            }
        }
        Ok(None)
    }

    fn is_steady_in_time(&mut self, kinematics: &Kinematics, part: [f64; 2]) -> bool {
        let Edges { in_time, chattering, .. } = self;
        kinematics.is_steady(in_time, part, &[], |register| may_change(kinematics, chattering, register, part[0]))
    }

    /// Returns the edge of time between two times, with the switches evaluated at the first; `None` if nothing has changed at the second
    /// and shortly after it.
    fn edge_within(&mut self, kinematics: &mut Kinematics, [mut low, b]: [f64; 2]) -> Result<Option<Edge>, Box<Stop>> {
        if !self.happens_at(kinematics, b) {
            return Ok(None);
        }
        loop {
            let high;
            [low, high] = bisect([low, b], usize::MAX, |t| !self.happens_at(kinematics, t));
            kinematics.set_time(high);
            if let Some(index) = kinematics.broken_condition().filter(|_| high <= self.last) {
                return Err(StopCause::Condition { index }.at(high));
            }
            let after = high.next_up();
            if self.happens_at(kinematics, after) {
                kinematics.set_time(low);
                let on_edge = |switch| kinematics.is_on_edge(switch);
                let is_low = kinematics.switches().iter().filter(|switch| switch.on_time).any(on_edge);
                return Ok(Some(Edge {
                    t: if is_low { low } else { high },
                    after: Some(after),
                    is_domain_boundary: false,
                }));
            }
            // a change at a single time is no edge, as of `t == 1 s`; or rounding goes back and forth around one
            if after >= b {
                return Ok(None);
            }
            low = after;
        }
    }

    /// Returns whether a switch of time would change at a time, or a formula of time ends.
    fn happens_at(&self, kinematics: &mut Kinematics, t: f64) -> bool {
        kinematics.set_time(t);
        let switches = kinematics.switches().iter().zip(&self.chattering);
        let mut of_time = switches.filter(|(switch, chattering)| switch.on_time && !chattering.is_suspended(t));
        of_time.any(|(switch, _)| kinematics.would_switch(switch)) || self.breaks_in_time(kinematics)
    }

    /// Returns whether a condition on time alone is broken where time was set: those on the motion have not been evaluated.
    fn breaks_in_time(&self, kinematics: &Kinematics) -> bool {
        !self.in_time.conditions_hold(|register| kinematics.value(register))
    }
}
