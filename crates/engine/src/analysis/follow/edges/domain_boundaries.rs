//! Domain boundaries of time: the times where a formula of time comes to the end of what one of its functions takes, as `sqrt((t - 1 s)^2)` does.
//!
//! No switch marks such an edge, and at its very time the formula mostly has no derivative. It is found by a quantity,
//! the event function, that is zero there, and by its slope. A step is proven by intervals to hold none: the event function
//! keeps away from zero, or it is monotonic and has the same sign at both ends. Else its zero is located to
//! neighbouring doubles, the step ends before it, and both sides are judged by states ever nearer to it
//! (`crates/engine/src/analysis/follow/edges/one_sided_limits.rs`). If both sides agree there is no edge, and the motion goes on.
//!
//! Boundaries that the motion decides end it (`crates/engine/src/analysis/follow/edges/motion_boundaries.rs`).

use super::event_functions::{EventFunctions, Zero};
use super::one_sided_limits::{Gap, OneSidedLimits, Verdict};
use super::one_sided_states::columns_that_jump;
use crate::analysis::explain::{Stop, StopCause};
use crate::analysis::follow::step::Step;
use crate::analysis::follow::warnings::Warnings;
use crate::analysis::state::{Kinematics, State, shortly_after};
use crate::limits::domain_boundaries::{FARTHEST, MOMENT, ROUNDING};
use mechc_expr::math::Halving;

/// Smallest part that is searched, as a part of the span.
const FINEST: f64 = 1e-8;
/// Maximum number of parts in one step.
const MOST_PARTS: usize = 2000;
/// Distance of the last step from a boundary that ends the motion, in units in the last place of the time.
const LAST_MOMENT: f64 = 16.0;
/// An event function is resolved if rounding is below this part of it.
const KNOWN: f64 = 1e-6;

/// Finds the domain boundaries of time that a motion comes to, and judges whether it goes on there.
pub(super) struct DomainBoundaries {
    event_functions: EventFunctions,
    /// Domain boundary that a step has come to, at a time (s).
    met: Option<Zero>,
    /// Stop that the motion comes to.
    end: Option<Box<Stop>>,
    limits: OneSidedLimits,
    /// The rows of both sides.
    rows: [Vec<f64>; 2],
    /// Results of the switches where the motion is.
    switches: Vec<f64>,
    /// Position near the state, and Newton's correction of it.
    place: Vec<f64>,
    delta: Vec<f64>,
    /// The time that the steps are measured against, and the last time (s).
    span: f64,
    last: f64,
}

impl DomainBoundaries {
    pub fn new(kinematics: &Kinematics, state: &State, span: f64, last: f64) -> DomainBoundaries {
        let (n, row) = (state.q.len(), vec![0.0; kinematics.row_length()]);
        DomainBoundaries {
            event_functions: EventFunctions::new(kinematics, state.t, span),
            met: None,
            end: None,
            limits: OneSidedLimits::new(state),
            rows: [row.clone(), row],
            switches: vec![0.0; kinematics.switches().len()],
            place: vec![0.0; n],
            delta: vec![0.0; n],
            span,
            last,
        }
    }

    /// Returns the time at which the next step has to end for a domain boundary, or for the end of the motion, if that comes before
    /// `reach` (s).
    pub fn next(&mut self, kinematics: &mut Kinematics, step: &Step, reach: f64) -> Option<f64> {
        if self.event_functions.is_empty() {
            return None;
        }
        let end = self.end.as_ref().map(|end| end.t - (shortly_after(end.t) - end.t) * (LAST_MOMENT / 4.0));
        let reach = end.map_or(reach, |end| end.min(reach));
        let from = step.t();
        self.met = None;
        if reach > from {
            let parts = Halving::new([from, reach], FINEST * self.span, MOST_PARTS);
            let found = self.event_functions.first_zero(kinematics, parts);
            self.met = found.filter(|met| shortly_after(met.t) < self.last);
        }
        let stop = self.met.map(|met| (met.t - FARTHEST * self.span).max(from));
        match (stop, end.filter(|end| *end <= reach)) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (one, other) => one.or(other),
        }
    }

    /// Judges the domain boundary that the state has come to.
    pub fn cross(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        warnings: &mut Warnings,
    ) -> Result<(), Box<Stop>> {
        if let Some(Zero { boundary, t }) = self.met.take() {
            self.judge(kinematics, step, boundary, t, warnings);
            return Ok(());
        }
        match self.end.take() {
            Some(stop) => Err(stop),
            None => Ok(()),
        }
    }

    /// Returns the stop of a motion that a domain boundary ends just ahead.
    pub fn end(&mut self) -> Option<Box<Stop>> {
        self.end.take()
    }

    /// Looks at both sides of a domain boundary at a time (s), which the state is next to, and takes note of where the motion ends if
    /// it does not go on smoothly.
    fn judge(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        boundary: usize,
        t: f64,
        warnings: &mut Warnings,
    ) {
        self.keep_switches(kinematics);
        self.event_functions.pass(boundary, t);
        let is_reached = self.is_reached(kinematics, boundary, t);
        let verdict = if is_reached { self.look_at_sides(kinematics, step, boundary, t) } else { Verdict::Smooth };
        self.restore_switches(kinematics);
        kinematics.restore(step.state());
        // the state was computed once, so that this cannot fail now
        let _ = step.derive_state(kinematics);
        let (system, behind) = (kinematics.system(), &kinematics.system().domain_boundaries()[boundary].declarations);
        let [before, after] = self.limits.sides();
        let declarations = behind.clone();
        let cause = match verdict {
            Verdict::Smooth => return,
            Verdict::Acceleration => {
                let [before, after] = &self.rows;
                warnings.warn_of_jump(behind, || columns_that_jump(system, self.span, [before, after]), t);
                return;
            }
            Verdict::Position { column, by } => {
                StopCause::PositionJump { declarations, jump: Some((column, by)), is_corner: false }
            }
            Verdict::Velocity { column } => {
                StopCause::VelocityJump { declarations, column, velocities: [before.qd[column], after.qd[column]] }
            }
            Verdict::NotFinite => StopCause::NotFinite { declarations },
        };
        if self.end.as_ref().is_none_or(|end| t < end.t) {
            self.end = Some(cause.at(t));
        }
    }

    fn look_at_sides(&mut self, kinematics: &mut Kinematics, step: &mut Step, boundary: usize, t: f64) -> Verdict {
        self.limits.begin(kinematics.system(), self.span);
        let mut distance = FARTHEST * self.span;
        while self.limits.needs_nearer(distance, t) {
            let before = self.solve_near(kinematics, step, boundary, t - distance, false);
            if before.is_some() {
                self.limits.take_before(step.trial());
                kinematics.write_row(step.trial(), &mut self.rows[0]);
            }
            let after = self.solve_near(kinematics, step, boundary, t + distance, true);
            if after.is_some() {
                self.limits.take_after(step.trial());
                kinematics.write_row(step.trial(), &mut self.rows[1]);
            } else if before.is_some() {
                let gap = self.gap_at(kinematics, t + distance, distance);
                self.limits.take_gap(gap);
            }
            let linear = kinematics.linear();
            self.limits.take(distance, [before, after], |k| linear.column_scale(k));
            distance *= 0.25;
        }
        self.limits.verdict()
    }

    /// Returns the largest correction that the equations require of the path to which the state before leads.
    fn gap_at(&mut self, kinematics: &mut Kinematics, t: f64, distance: f64) -> Gap {
        let ([before, _], h) = (self.limits.sides(), 2.0 * distance);
        for (k, place) in self.place.iter_mut().enumerate() {
            *place = before.q[k] + h * before.qd[k];
        }
        kinematics.set_time(t);
        if kinematics.set_position(&self.place).is_err() || kinematics.factor().is_err() {
            return Gap { size: f64::NAN, column: 0, by: 0.0 };
        }
        kinematics.correction(&mut self.delta);
        let linear = kinematics.linear();
        let gap = |(k, by): (usize, &f64)| Gap { size: by.abs() / linear.column_scale(k), column: k, by: *by };
        let gaps = self.delta.iter().enumerate().map(gap);
        gaps.fold(Gap { size: 0.0, column: 0, by: 0.0 }, |best, one| if one.size > best.size { one } else { best })
    }

    /// Solves for the state at a time next to a domain boundary, on one side of it, with the branches that formulas have there. Returns the
    /// relative rounding of the value of the event function there, or `None` if there is no such state.
    fn solve_near(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        boundary: usize,
        t: f64,
        is_after: bool,
    ) -> Option<f64> {
        self.restore_switches(kinematics);
        kinematics.settle_time(t);
        match self.limits.nearest(is_after) {
            Some(near) => step.predict_from(near, t - near.t, t),
            None => step.predict_freely(t - step.t(), t),
        }
        if !kinematics.switches().is_empty() {
            kinematics.set_time(t);
            kinematics.settle_motion(&step.trial().q);
        }
        step.solve(kinematics).ok()?;
        let layout = self.event_functions.boundary(boundary);
        let gauge = kinematics.gauge(layout);
        let rounding = f64::EPSILON * kinematics.largest_term(layout) / gauge.abs();
        (rounding < KNOWN).then_some(rounding)
    }

    /// Returns whether an event function is zero at a time, as far as numbers can tell.
    fn is_reached(&self, kinematics: &mut Kinematics, boundary: usize, t: f64) -> bool {
        let layout = self.event_functions.boundary(boundary);
        let mut at = |t: f64| {
            kinematics.set_time(t);
            (kinematics.gauge(layout), kinematics.largest_term(layout))
        };
        let (here, terms) = at(t);
        let is_rounding = here.abs() <= ROUNDING * f64::EPSILON * terms && terms > here.abs();
        let mut changes = |t: f64| {
            let (there, _) = at(t);
            here == 0.0 || !(there / here < 2.0 && there / here > 0.5)
        };
        let moment = MOMENT * f64::EPSILON * t.abs() + f64::MIN_POSITIVE;
        here.is_nan() || is_rounding || changes(t - moment) || changes(t + moment)
    }

    fn keep_switches(&mut self, kinematics: &Kinematics) {
        for (kept, switch) in self.switches.iter_mut().zip(kinematics.switches()) {
            *kept = kinematics.switch(switch);
        }
    }

    fn restore_switches(&self, kinematics: &mut Kinematics) {
        kinematics.set_switches(&self.switches);
    }
}
