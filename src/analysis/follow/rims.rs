//! Rims: the times where a formula comes to the end of what one of its functions takes, as `sqrt((t - 1 s)^2)` does.
//!
//! No switch tells of such an edge, and at its very time the formula mostly has no derivative. What is known is a quantity,
//! the gauge, that is zero there, and its slope along the motion. A step is proven by intervals to hold none: the gauge
//! keeps away from zero, or it goes one way only and has the same sign at both ends. Else its zero is located to
//! neighbouring doubles, the step ends before it, and both sides are judged by states ever nearer to it
//! (`analysis/follow/limits.rs`). What agrees on both sides is no edge, and the motion goes on as if nothing had been.

use super::limits::{Limits, Nearer, Verdict};
use super::march::{Motion, along};
use crate::analysis::explain::errors;
use crate::analysis::state::{Fault, Kinematics, State, shortly_after};
use crate::diag::Diagnostic;
use crate::program::{Enclosure, Rim};
use crate::tolerances::steps::rims::{
    BEHIND, FARTHEST, FINEST, FINEST_BETWEEN, LAST_MOMENT, MOMENT, MOMENT_OF_MOTION, MOST_HALVINGS, MOST_PARTS,
    MOST_PARTS_BETWEEN, MOST_WIDER, ROUNDING,
};

/// Where a gauge is looked at.
#[derive(Clone, Copy)]
enum Way {
    /// In time (s).
    Time,
    /// On the curve of a step of a length (s), by the part of the step.
    Curve(f64),
}

/// A rim that a step comes to.
#[derive(Clone, Copy, Debug)]
struct Met {
    rim: usize,
    t: f64,
}

/// What is known of the rims.
pub struct Rims {
    all: Vec<Rim>,
    of_time: Vec<usize>,
    of_motion: Vec<usize>,
    in_time: Enclosure,
    along: Enclosure,
    /// By rim: up to this time (s) it has been judged.
    passed: Vec<f64>,
    met: Option<Met>,
    /// Where the motion ends, and why.
    end: Option<(f64, Box<Diagnostic>)>,
    /// Each velocity's middle and reach in a part of a step.
    boxes: Vec<[f64; 2]>,
    velocity: Vec<f64>,
    switches: Vec<f64>,
    limits: Limits,
}

impl Rims {
    pub fn new(kinematics: &Kinematics, state: &State) -> Rims {
        let all = kinematics.rims().to_vec();
        let of = |on_time: bool| (0..all.len()).filter(|&k| all[k].on_time == on_time).collect();
        let (of_time, of_motion) = (of(true), of(false));
        let [in_time, along] = kinematics.enclosures_of_rims();
        Rims {
            passed: vec![state.t; all.len()],
            all,
            of_time,
            of_motion,
            in_time,
            along,
            met: None,
            end: None,
            boxes: vec![[0.0; 2]; state.q.len()],
            velocity: vec![0.0; state.q.len()],
            switches: vec![0.0; kinematics.switches().len()],
            limits: Limits::new(state),
        }
    }
}

impl Motion {
    /// When the next step has to end for a rim of time, or for the end of the motion, if it comes to one before `reach` (s).
    pub fn next_rim(&mut self, reach: f64) -> Option<f64> {
        let end = self.rims.end.as_ref().map(|(t, _)| t - (shortly_after(*t) - t) * (LAST_MOMENT / 4.0));
        let reach = end.map_or(reach, |end| end.min(reach));
        let met = self.rims.met.take().filter(|met| !self.rims.all[met.rim].on_time);
        self.rims.met = met;
        let from = self.state.t;
        if met.is_none() && !self.rims.of_time.is_empty() && reach > from {
            let found = self.first_rim(Way::Time, [from, reach], FINEST * self.span, MOST_PARTS);
            self.rims.met = found.filter(|met| shortly_after(met.t) < self.last);
        }
        let stop = self.rims.met.map(|met| (met.t - FARTHEST * self.span).max(from));
        match (stop, end.filter(|end| *end <= reach)) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (one, other) => one.or(other),
        }
    }

    /// Judges the rim that the state has come to.
    pub fn cross_rim(&mut self) -> Result<(), Box<Diagnostic>> {
        if let Some(Met { rim, t }) = self.rims.met.take() {
            self.judge(rim, t);
            return Ok(());
        }
        match self.rims.end.take() {
            Some((_, why)) => Err(why),
            None => Ok(()),
        }
    }

    /// Why the motion ends just ahead, if a rim is what ends it: even a step as small as `h` (s) failed.
    pub fn end_at_rim(&mut self, h: f64) -> Option<Box<Diagnostic>> {
        if self.rims.end.is_none() && !self.rims.of_motion.is_empty() {
            // the way that the state leads to, as far as a rim may be that keeps steps from coming nearer
            let h = h.max(FARTHEST * self.span);
            for (k, curve) in self.curve.iter_mut().enumerate() {
                *curve = [self.state.q[k], h * self.state.qd[k], 0.5 * h * h * self.state.qdd[k], 0.0, 0.0, 0.0];
            }
            if let Some(met) = self.first_rim(Way::Curve(h), [0.0, 1.0], FINEST_BETWEEN, MOST_PARTS_BETWEEN) {
                self.judge(met.rim, self.state.t + met.t * h);
            }
        }
        self.rims.end.take().map(|(_, why)| why)
    }

    /// Looks for rims that a step of length `h` goes over, on the curve through both its ends, which must have been drawn.
    pub fn look_for_rims(&mut self, h: f64) -> Result<(), Fault> {
        if self.rims.of_motion.is_empty() {
            return Ok(());
        }
        let Some(met) = self.first_rim(Way::Curve(h), [0.0, 1.0], FINEST_BETWEEN, MOST_PARTS_BETWEEN) else {
            return Ok(());
        };
        let t = self.state.t + met.t * h;
        if shortly_after(t) >= self.last {
            return Ok(());
        }
        // over a rim the curve is not exact: a short step knows better where it is
        if h > 4.0 * FARTHEST * self.span {
            return Err(Fault::TooFar);
        }
        self.rims.met = Some(Met { rim: met.rim, t });
        Err(Fault::Rim)
    }

    /// The first zero of a gauge, in time or on a curve.
    fn first_rim(&mut self, way: Way, [from, to]: [f64; 2], finest: f64, most: usize) -> Option<Met> {
        let mut open = [[0.0; 2]; 64];
        let (mut count, mut looked_at) = (1, 0);
        open[0] = [from, to];
        while count > 0 {
            count -= 1;
            looked_at += 1;
            let part @ [a, b] = open[count];
            self.enclose_gauges(way, part);
            let Some(first) = self.may_be_zero(way, part, 0) else {
                continue;
            };
            let middle = 0.5 * (a + b);
            if b - a > finest && looked_at < most && count + 2 <= open.len() && middle > a && middle < b {
                open[count] = [middle, b];
                open[count + 1] = [a, middle];
                count += 2;
                continue;
            }
            let mut next = Some(first);
            let mut earliest: Option<Met> = None;
            while let Some(k) = next {
                let rim = self.rims_on(way)[k];
                if let Some(t) = self.zero_within(way, rim, part).filter(|t| earliest.is_none_or(|met| *t < met.t)) {
                    earliest = Some(Met { rim, t });
                }
                next = self.may_be_zero(way, part, k + 1);
            }
            if earliest.is_some() {
                return earliest;
            }
        }
        None
    }

    fn rims_on(&self, way: Way) -> &[usize] {
        match way {
            Way::Time => &self.rims.of_time,
            Way::Curve(_) => &self.rims.of_motion,
        }
    }

    /// The rim, by its place from `first` on among those of a way, whose gauge is not proven to keep its sign in a part that has
    /// been enclosed.
    fn may_be_zero(&mut self, way: Way, part: [f64; 2], first: usize) -> Option<usize> {
        (first..self.rims_on(way).len()).find(|&k| {
            let rim = self.rims_on(way)[k];
            let layout = &self.rims.all[rim];
            let enclosure = if let Way::Time = way { &self.rims.in_time } else { &self.rims.along };
            let ([low, high], [least, most]) = (enclosure.range(layout.gauge), enclosure.range(layout.slope));
            if low > 0.0 || high < 0.0 {
                return false;
            }
            let Some([a, b]) = self.not_passed(way, rim, part) else {
                return false;
            };
            if least > 0.0 || most < 0.0 {
                let (at_a, at_b) = (self.gauge_at(way, rim, a)[0], self.gauge_at(way, rim, b)[0]);
                return !(at_a > 0.0 && at_b > 0.0 || at_a < 0.0 && at_b < 0.0);
            }
            true
        })
    }

    /// What of a part lies behind the last zero of a rim; none if nothing does.
    fn not_passed(&self, way: Way, rim: usize, [a, b]: [f64; 2]) -> Option<[f64; 2]> {
        let passed = shortly_after(self.rims.passed[rim]) + BEHIND * self.span;
        let passed = match way {
            Way::Time => passed,
            Way::Curve(h) => (passed - self.state.t) / h,
        };
        (passed < b).then(|| [a.max(passed), b])
    }

    fn enclose_gauges(&mut self, way: Way, [a, b]: [f64; 2]) {
        match way {
            Way::Time => self.kinematics.enclose(&mut self.rims.in_time, [a, b]),
            Way::Curve(h) => {
                let (middle, reach) = (0.5 * (a + b), 0.5 * (b - a));
                for (k, curve) in self.curve.iter().enumerate() {
                    // Taylor's polynomial about the middle: what its higher terms can reach
                    let mut taylor = *curve;
                    for order in 0..taylor.len() {
                        for j in (order..taylor.len() - 1).rev() {
                            taylor[j] += middle * taylor[j + 1];
                        }
                    }
                    let rest = taylor[1..].iter().rev().fold(0.0, |sum, c| (sum + c.abs()) * reach);
                    self.boxes[k] = [taylor[0], rest];
                    let slopes: [f64; 5] = std::array::from_fn(|j| (j + 1) as f64 * taylor[j + 1] / h);
                    let rest = slopes[1..].iter().rev().fold(0.0, |sum, c| (sum + c.abs()) * reach);
                    self.rims.boxes[k] = [slopes[0], rest];
                }
                let times = [self.state.t + a * h, self.state.t + b * h];
                self.kinematics.enclose_motion(&mut self.rims.along, times, [&self.boxes, &self.rims.boxes]);
            }
        }
    }

    /// A gauge and its slope at a time, or at a place of a curve.
    fn gauge_at(&mut self, way: Way, rim: usize, x: f64) -> [f64; 2] {
        match way {
            Way::Time => self.kinematics.set_time(x),
            Way::Curve(h) => {
                for (velocity, curve) in self.rims.velocity.iter_mut().zip(&self.curve) {
                    let [_, a, b, c, d, e] = *curve;
                    *velocity = along(&[a, 2.0 * b, 3.0 * c, 4.0 * d, 5.0 * e, 0.0], x) / h;
                }
                // a formula without a value has no gauge either
                let _ = self.set_on_curve(h, x);
                self.kinematics.set_velocity(&self.rims.velocity);
            }
        }
        self.kinematics.gauge(&self.rims.all[rim])
    }

    /// The zero of a gauge in a small part, be it that it only touches zero, or comes near to it.
    fn zero_within(&mut self, way: Way, rim: usize, part: [f64; 2]) -> Option<f64> {
        let [a, b] = self.not_passed(way, rim, part)?;
        let [at_a, slope_a] = self.gauge_at(way, rim, a);
        let (mut end, [mut at_b, mut slope_b]) = (b, self.gauge_at(way, rim, b));
        // rounding says nothing of a sign
        for wider in 0..MOST_WIDER {
            if !self.is_rounding(rim, at_b) {
                break;
            }
            end = b + f64::from(1 << wider) * (b - a);
            [at_b, slope_b] = self.gauge_at(way, rim, end);
        }
        let sign = if at_a < 0.0 { -1.0 } else { 1.0 };
        if sign * at_b < 0.0 {
            return Some(bisect([a, end], |x| sign * self.gauge_at(way, rim, x)[0] > 0.0));
        }
        let comes_and_goes = sign * slope_a < 0.0 && sign * slope_b > 0.0;
        comes_and_goes.then(|| bisect([a, end], |x| sign * self.gauge_at(way, rim, x)[1] < 0.0))
    }

    /// Whether a gauge that was just asked for is rounding.
    fn is_rounding(&self, rim: usize, gauge: f64) -> bool {
        let terms = self.kinematics.largest_term(&self.rims.all[rim]);
        gauge.abs() <= ROUNDING * f64::EPSILON * terms && (terms > gauge.abs() || gauge == 0.0)
    }

    /// Looks at both sides of a rim near a time `t` (s), which the state is next to, and takes note of where the motion ends if
    /// it does not go on smoothly.
    fn judge(&mut self, rim: usize, t: f64) {
        self.keep_switches();
        let t = if self.rims.all[rim].on_time { t } else { self.locate_rim(rim, t) };
        self.rims.passed[rim] = t;
        let verdict = if self.is_reached(rim, t) { self.look_at_sides(rim, t) } else { Verdict::Smooth };
        self.restore_switches();
        self.kinematics.restore(&self.state);
        // the state was computed once, so that this cannot fail now
        let _ = self.kinematics.derivatives(&mut self.state);
        let (system, behind) = (self.kinematics.system(), &self.kinematics.system().rims[rim].declarations);
        let limits = &self.rims.limits;
        let why = match verdict {
            Verdict::Smooth => return,
            Verdict::Acceleration => {
                if behind.iter().any(|&declaration| !self.warned[declaration]) {
                    for &declaration in behind {
                        self.warned[declaration] = true;
                    }
                    let columns = self.columns_that_jump();
                    self.remarks.push(errors::acceleration_jump(system, behind, &columns, t));
                }
                return;
            }
            Verdict::Position { column, by } => errors::position_jump(system, behind, false, (column, by), t),
            Verdict::Corner => errors::position_jump(system, behind, true, (0, 0.0), t),
            Verdict::Velocity { column } => {
                let velocities = [limits.before.qd[column], limits.after.qd[column]];
                errors::velocity_jump(system, behind, column, velocities, t)
            }
            Verdict::NotFinite => errors::formula_not_finite(system, behind, t),
        };
        if self.rims.end.as_ref().is_none_or(|(known, _)| t < *known) {
            self.rims.end = Some((t, Box::new(why)));
        }
    }

    fn look_at_sides(&mut self, rim: usize, t: f64) -> Verdict {
        self.rims.limits.begin(self.kinematics.system(), self.span);
        let mut distance = FARTHEST * self.span;
        while let Nearer::Wanted = self.rims.limits.wants(distance, t) {
            let before = self.state_at(rim, t - distance, false);
            if before.is_some() {
                self.rims.limits.before.copy_from(&self.trial);
                self.kinematics.write_row(&self.trial, &mut self.row_before);
            }
            let after = self.state_at(rim, t + distance, true);
            if after.is_some() {
                self.rims.limits.after.copy_from(&self.trial);
                self.kinematics.write_row(&self.trial, &mut self.row);
            } else if before.is_some() {
                let gap = self.gap_at(t + distance, distance);
                self.rims.limits.take_gap(gap);
            }
            let linear = self.kinematics.linear();
            self.rims.limits.take(distance, [before, after], |k| linear.column_scale(k));
            distance *= 0.25;
        }
        let system = self.kinematics.system();
        let is_contact = system.rims[rim].declarations.iter().any(|&k| errors::has_tangent(system, k));
        let passes = self.gauge_beyond(rim, t);
        self.rims.limits.verdict(is_contact && passes)
    }

    /// How far the way that the state leads to is off from what the equations ask for: the largest correction, scaled, its
    /// coordinate, and that coordinate's [m, rad].
    fn gap_at(&mut self, t: f64, distance: f64) -> (f64, usize, f64) {
        let (before, h) = (&self.rims.limits.before, 2.0 * distance);
        for (k, middle) in self.middle.iter_mut().enumerate() {
            *middle = before.q[k] + h * before.qd[k];
        }
        self.kinematics.set_time(t);
        if self.kinematics.set_position(&self.middle).is_err() || self.kinematics.factor().is_err() {
            return (f64::NAN, 0, 0.0);
        }
        self.kinematics.correction(&mut self.delta);
        let linear = self.kinematics.linear();
        let sizes = self.delta.iter().enumerate().map(|(k, delta)| (delta.abs() / linear.column_scale(k), k, *delta));
        sizes.fold((0.0, 0, 0.0), |best, one| if one.0 > best.0 { one } else { best })
    }

    /// Whether a gauge only touches zero at a time, by the way that the state leads to.
    fn gauge_beyond(&mut self, rim: usize, t: f64) -> bool {
        let at = |motion: &mut Self, t: f64| {
            let h = t - motion.state.t;
            for (k, middle) in motion.middle.iter_mut().enumerate() {
                *middle = motion.state.q[k] + h * (motion.state.qd[k] + 0.5 * h * motion.state.qdd[k]);
            }
            motion.kinematics.set_time(t);
            let is_set = motion.kinematics.set_position(&motion.middle).is_ok();
            is_set.then(|| motion.kinematics.gauge(&motion.rims.all[rim])[0])
        };
        let far = FARTHEST * self.span;
        matches!((at(self, t - far), at(self, t + far)), (Some(a), Some(b)) if a != 0.0 && b != 0.0)
    }

    /// Solves for the state at a time next to a rim, with the branches that formulas have there; gives the rounding of what the
    /// rim's formula computes there, as a part of it. None if there is no such state.
    fn state_at(&mut self, rim: usize, t: f64, is_after: bool) -> Option<f64> {
        self.restore_switches();
        self.kinematics.settle_time(t);
        let near = self.rims.limits.nearest(is_after).unwrap_or(&self.state);
        let h = t - near.t;
        self.trial.t = t;
        for (k, q) in self.trial.q.iter_mut().enumerate() {
            *q = near.q[k] + h * (near.qd[k] + 0.5 * h * near.qdd[k]);
        }
        if !self.kinematics.switches().is_empty() {
            self.kinematics.set_time(t);
            self.kinematics.settle_motion(&self.trial.q);
        }
        self.correct().ok()?;
        self.kinematics.derivatives(&mut self.trial).ok()?;
        let layout = &self.rims.all[rim];
        let [gauge, _] = self.kinematics.gauge(layout);
        let rounding = f64::EPSILON * self.kinematics.largest_term(layout) / gauge.abs();
        (rounding < 1e-6).then_some(rounding)
    }

    /// The gauge and its slope at a time next to the state, solved for.
    fn solved_gauge(&mut self, rim: usize, t: f64) -> Option<[f64; 2]> {
        self.predict(t - self.state.t, t).ok()?;
        self.correct().ok()?;
        let _ = self.kinematics.derivatives(&mut self.trial);
        let found = self.kinematics.gauge(&self.rims.all[rim]);
        found.iter().all(|value| !value.is_nan()).then_some(found)
    }

    /// The zero of a gauge of the motion near a time, by states that are solved for.
    fn locate_rim(&mut self, rim: usize, t: f64) -> f64 {
        let far = FARTHEST * self.span;
        let (a, b) = ((t - far).max(self.rims.passed[rim]), t + far);
        let (Some([at_a, slope_a]), Some([at_b, slope_b])) = (self.solved_gauge(rim, a), self.solved_gauge(rim, b))
        else {
            return t;
        };
        let sign = if at_a < 0.0 { -1.0 } else { 1.0 };
        let crosses = sign * at_b < 0.0;
        let touches = sign * slope_a < 0.0 && sign * slope_b > 0.0;
        if !crosses && !touches {
            return t;
        }
        // where rounding leaves the formula no value its argument is known all the same, on the curve through both sides
        let (from, h) = (self.state.t, b - self.state.t);
        self.draw_curve(h);
        bisect([a, b], |t| {
            let [gauge, slope] =
                self.solved_gauge(rim, t).unwrap_or_else(|| self.gauge_at(Way::Curve(h), rim, (t - from) / h));
            if crosses { sign * gauge > 0.0 } else { sign * slope < 0.0 }
        })
    }

    /// Whether a gauge is zero at a time, as far as numbers can tell.
    fn is_reached(&mut self, rim: usize, t: f64) -> bool {
        let on_time = self.rims.all[rim].on_time;
        let moment =
            if on_time { MOMENT * f64::EPSILON * t.abs() + f64::MIN_POSITIVE } else { MOMENT_OF_MOTION * self.span };
        let mut at = |t: f64| {
            if on_time {
                self.kinematics.set_time(t);
                Some((self.kinematics.gauge(&self.rims.all[rim])[0], self.kinematics.largest_term(&self.rims.all[rim])))
            } else {
                let [gauge, _] = self.solved_gauge(rim, t)?;
                Some((gauge, self.kinematics.largest_term(&self.rims.all[rim])))
            }
        };
        let Some((here, terms)) = at(t) else {
            return true;
        };
        let is_rounding = here.abs() <= ROUNDING * f64::EPSILON * terms && terms > here.abs();
        let mut changes =
            |t: f64| at(t).is_none_or(|(there, _)| here == 0.0 || !(there / here < 2.0 && there / here > 0.5));
        here.is_nan() || is_rounding || changes(t - moment) || changes(t + moment)
    }

    fn keep_switches(&mut self) {
        for (kept, switch) in self.rims.switches.iter_mut().zip(self.kinematics.switches()) {
            *kept = self.kinematics.switch(switch);
        }
    }

    fn restore_switches(&mut self) {
        self.kinematics.set_switches(&self.rims.switches);
    }
}

/// Where something ceases to hold between two places, the later one of two neighbouring doubles.
fn bisect([mut low, mut high]: [f64; 2], mut holds: impl FnMut(f64) -> bool) -> f64 {
    for _ in 0..MOST_HALVINGS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
