//! Edges: the times where a formula goes over to another of its branches.
//!
//! Within a step every switch is frozen, so that the equations are smooth there. An edge of time is looked for before a
//! step, one of the motion after it; both are located to neighbouring doubles, and the step ends there. Then both sides
//! are evaluated at that same time, and compared: a position or velocity that jumps has no acceleration, an acceleration
//! that jumps has two.

use super::errors;
use super::kinematics::Fault;
use super::march::Motion;
use super::singular;
use crate::diag::Diagnostic;
use crate::ir::CoordinateKind;

/// So many units in the last place of an output time it may be off from the edge that it is meant to be.
const SLACK: f64 = 4.0;
/// The span is looked through for edges of time in parts no smaller than this one of it.
const FINEST: f64 = 1e-8;
/// Parts that are looked at in one step at most: where a formula stands on its edge all the time nothing is ever decided.
const MOST_PARTS: usize = 2000;
/// How far, as a part of the span, the motion is looked ahead to tell on which side of an edge it goes on.
const AHEAD: f64 = 1e-9;
/// A position that changes by more than this at an edge, scaled, jumps.
const POSITION_JUMP: f64 = 1e-9;
/// A velocity that changes by more than this part of the fastest, scaled, jumps.
const VELOCITY_JUMP: f64 = 1e-7;
/// An acceleration likewise.
const ACCELERATION_JUMP: f64 = 1e-6;
/// A speed below this part of one per span, scaled, is rest.
const REST: f64 = 1e-3;
/// The rounding of an edge's time may show so many times in what is computed there.
const UNCERTAIN: f64 = 16.0;
/// An equation takes part in a jump if it is left open by this part of the widest.
const TAKES_PART: f64 = 1e-2;
/// Corrections of a position at an edge at most.
const ITERATIONS: usize = 4;

/// A time on the later side of whatever happens at `t` (s).
pub(super) fn shortly_after(t: f64) -> f64 {
    t + SLACK * f64::EPSILON * t.abs() + f64::MIN_POSITIVE
}

/// Where a switch changes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// Where both sides are evaluated (s).
    pub t: f64,
    /// A time (s) at which every switch of time is on the later side; none for an edge of the motion.
    after: Option<f64>,
}

impl Motion<'_, '_> {
    /// Whether a time is the last one, where the earlier side counts.
    fn is_last(&self, t: f64) -> bool {
        shortly_after(t) >= self.last
    }

    /// The first edge that a step to `next` meets, before the last time. An edge that is meant to be at the output time
    /// `next` is there.
    pub(super) fn next_edge(&mut self, next: f64, is_output: bool) -> Option<Edge> {
        let reach = if is_output { shortly_after(next) } else { next };
        let of_time = if self.has_time_switches { self.edge_of_time(self.state.t, reach) } else { None };
        let edge = match (of_time, self.met.filter(|edge| edge.t <= reach)) {
            (Some(a), Some(b)) => Some(if b.t < a.t { b } else { a }),
            (one, other) => one.or(other),
        }?;
        let edge = Edge { t: edge.t.min(next).max(self.state.t), ..edge };
        (!self.is_last(edge.t)).then_some(edge)
    }

    /// The first edge of time from `from` on, where all switches are known, up to `to`.
    fn edge_of_time(&mut self, from: f64, to: f64) -> Option<Edge> {
        let finest = FINEST * self.span;
        // parts that are still to be looked at, the first one last
        let mut open = [(0.0, 0.0); 64];
        let mut count = 1;
        open[0] = (from, to);
        let mut looked_at = 0;
        while count > 0 {
            count -= 1;
            looked_at += 1;
            let (a, b) = open[count];
            if self.kinematics.is_steady(&mut self.enclosure, a, b) {
                continue;
            }
            let middle = 0.5 * (a + b);
            if b - a > finest && looked_at < MOST_PARTS && count + 2 <= open.len() && middle > a && middle < b {
                open[count] = (middle, b);
                open[count + 1] = (a, middle);
                count += 2;
            } else if let Some(edge) = self.bisect(a, b) {
                return Some(edge);
            }
        }
        None
    }

    /// The edge of time between two times, the switches being known at the first; none if they are the same shortly after
    /// the second.
    fn bisect(&mut self, a: f64, b: f64) -> Option<Edge> {
        let (mut low, mut high) = (a, b);
        if !self.switches_at(high) {
            return None;
        }
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if self.switches_at(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        let after = high.next_up();
        // what differs at a single time is no edge: `t == 1 s`
        if !self.switches_at(after) {
            return None;
        }
        self.kinematics.set_time(low);
        let on_edge = |switch| self.kinematics.is_on_edge(switch);
        let t = if self.kinematics.switches().iter().filter(|switch| switch.on_time).any(on_edge) { low } else { high };
        Some(Edge { t, after: Some(after) })
    }

    fn switches_at(&mut self, t: f64) -> bool {
        self.kinematics.set_time(t);
        let mut of_time = self.kinematics.switches().iter().filter(|switch| switch.on_time);
        of_time.any(|switch| self.kinematics.would_switch(switch))
    }

    /// Whether the step that was just corrected goes over an edge of the motion.
    pub(super) fn meets_edge(&self) -> bool {
        let mut of_motion = self.kinematics.switches().iter().filter(|switch| !switch.on_time);
        of_motion.any(|switch| self.kinematics.would_switch(switch))
    }

    /// Finds the edge that a step to `next` goes over; says whether it could.
    pub(super) fn locate(&mut self, next: f64) -> bool {
        let (mut low, mut high) = (self.state.t, next);
        // the step goes over it
        let mut found = true;
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            match self.solve_at(middle) {
                Ok(()) if !self.meets_edge() => low = middle,
                Ok(()) => (high, found) = (middle, true),
                // beyond the edge a formula need not go on
                Err(_) => (high, found) = (middle, false),
            }
        }
        if found {
            self.met = Some(Edge { t: high, after: None });
        }
        found
    }

    fn solve_at(&mut self, t: f64) -> Result<(), Fault> {
        self.predict(t - self.state.t, t)?;
        self.correct().map(|_| ())
    }

    /// Goes over to the later side of an edge, which the state has reached on the earlier one.
    pub(super) fn cross(&mut self, edge: Edge) -> Result<(), Box<Diagnostic>> {
        if self.met.is_some_and(|known| known.t <= edge.t) {
            self.met = None;
        }
        self.remember();
        self.settle(edge.after);
        match self.later_side() {
            Ok(None) => Ok(()),
            Ok(Some(jump)) => self.say(jump),
            Err(fault) => {
                let t = self.state.t;
                Err(Box::new(singular::explain(self.kinematics, &self.before, fault, 0.0, t)))
            }
        }
    }

    /// Keeps the earlier side: the state and its row.
    fn remember(&mut self) {
        self.before.copy_from(self.state);
        self.kinematics.restore(&self.before);
        // the state was computed once, so that this cannot fail now
        let _ = self.kinematics.derivatives(&mut self.before);
        self.kinematics.write_row(&self.before, &mut self.row_before);
    }

    /// Sets every switch to what it is on the later side of the state.
    pub(super) fn settle(&mut self, after: Option<f64>) {
        if let Some(after) = after {
            self.kinematics.settle_time(after);
        }
        self.kinematics.set_time(self.state.t);
        let ahead = AHEAD * self.span;
        for k in 0..self.middle.len() {
            self.middle[k] = self.state.q[k] + ahead * (self.state.qd[k] + 0.5 * ahead * self.state.qdd[k]);
        }
        self.kinematics.settle_motion(&self.middle);
    }

    /// Computes the state anew where it is, with the switches as they are now, and compares.
    fn later_side(&mut self) -> Result<Option<Jump>, Fault> {
        self.kinematics.set_time(self.state.t);
        self.kinematics.set_position(&self.state.q)?;
        self.kinematics.factor()?;
        for iteration in 0..ITERATIONS {
            let size = self.kinematics.correction(&mut self.delta);
            if iteration == 0 && (size.is_nan() || size > POSITION_JUMP) {
                return Ok(Some(Jump::Position));
            }
            for (q, delta) in self.state.q.iter_mut().zip(&self.delta) {
                *q += delta;
            }
            self.kinematics.set_position(&self.state.q)?;
            if self.kinematics.violated().is_none() {
                break;
            }
        }
        self.kinematics.factor()?;
        self.same_branch()?;
        self.kinematics.derivatives(self.state)?;
        self.kinematics.write_row(self.state, &mut self.row);
        if self.compare(0.0, 0.0).is_none() {
            return Ok(None);
        }
        // what differs may be the rounding of the edge's time alone
        let (velocity, acceleration) = self.change_of_a_moment()?;
        Ok(self.compare(velocity, acceleration))
    }

    /// How much velocities and accelerations change within the rounding of the edge's time, on either side, scaled.
    fn change_of_a_moment(&mut self) -> Result<(f64, f64), Fault> {
        let moment = shortly_after(self.state.t) - self.state.t;
        self.trial.copy_from(self.state);
        self.trial.t += moment;
        for (q, qd) in self.trial.q.iter_mut().zip(&self.state.qd) {
            *q += moment * qd;
        }
        self.kinematics.set_time(self.trial.t);
        self.kinematics.set_position(&self.trial.q)?;
        self.kinematics.factor()?;
        self.kinematics.derivatives(&mut self.trial)?;
        let change = |a: &[f64], b: &[f64]| {
            let scaled = |k: usize| (a[k] - b[k]).abs() / self.kinematics.linear().column_scale(k);
            (0..a.len()).map(scaled).fold(0.0, f64::max)
        };
        let velocity = change(&self.trial.qd, &self.state.qd).max(moment * self.pace);
        let acceleration = change(&self.trial.qdd, &self.state.qdd).max(moment * self.jerk);
        Ok((UNCERTAIN * velocity, UNCERTAIN * acceleration))
    }

    /// What jumps by more than `velocity` and `acceleration`, scaled, and more than rounding.
    fn compare(&self, velocity: f64, acceleration: f64) -> Option<Jump> {
        let (before, now, system) = (&self.before, &*self.state, self.kinematics.system());
        let scaled = |k: usize, value: f64| value.abs() / self.kinematics.linear().column_scale(k);
        let largest =
            |a: &[f64], b: &[f64]| (0..a.len()).map(|k| f64::max(scaled(k, a[k]), scaled(k, b[k]))).fold(0.0, f64::max);
        let speed = largest(&before.qd, &now.qd).max(REST / self.span);
        let pace = largest(&before.qdd, &now.qdd).max(REST * speed / self.span);
        let jumps = |k: &usize| scaled(*k, now.qd[*k] - before.qd[*k]) > velocity.max(VELOCITY_JUMP * speed);
        let bends = |k: &usize| scaled(*k, now.qdd[*k] - before.qdd[*k]) > acceleration.max(ACCELERATION_JUMP * pace);
        let mut all = 0..now.qd.len();
        // a contact may run along its curve as it likes: what counts is how bodies move
        match all.clone().filter(jumps).find(|&k| system.coordinates[k].kind != CoordinateKind::Argument) {
            Some(column) => Some(Jump::Velocity { column }),
            None => all.any(|k| jumps(&k) || bends(&k)).then_some(Jump::Acceleration),
        }
    }

    /// Says that something jumps: an error, or a warning once for each declaration.
    fn say(&mut self, jump: Jump) -> Result<(), Box<Diagnostic>> {
        let system = self.kinematics.system();
        let behind = self.declarations_behind(jump);
        let t = self.state.t;
        match jump {
            Jump::Position => {
                let far = |k: &usize| self.delta[*k].abs() / self.kinematics.linear().column_scale(*k);
                let column = (0..self.delta.len()).max_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0);
                Err(Box::new(errors::position_jump(system, &behind, column, self.delta[column], t)))
            }
            Jump::Velocity { column } => {
                let velocities = [self.before.qd[column], self.state.qd[column]];
                Err(Box::new(errors::velocity_jump(system, &behind, column, velocities, t)))
            }
            Jump::Acceleration => {
                if behind.iter().any(|&declaration| !self.warned[declaration]) {
                    for &declaration in &behind {
                        self.warned[declaration] = true;
                    }
                    let columns = self.columns_that_jump();
                    self.remarks.push(errors::acceleration_jump(system, &behind, &columns, t));
                }
                Ok(())
            }
        }
    }

    /// The declarations whose own equations the earlier side does not satisfy, with the branches of the later one.
    fn declarations_behind(&self, jump: Jump) -> Vec<usize> {
        let system = self.kinematics.system();
        let open = |row: usize| {
            let (velocity, acceleration) = self.kinematics.left_open(row, &self.before);
            match jump {
                Jump::Position => self.kinematics.residual(row),
                Jump::Velocity { .. } => velocity,
                // a contact that runs on at another speed leaves its velocity open
                Jump::Acceleration => acceleration.max(velocity / self.span),
            }
        };
        let open: Vec<f64> = (0..system.rows.len()).map(open).collect();
        let widest = open.iter().copied().fold(0.0, f64::max);
        let mut behind: Vec<usize> = (0..open.len())
            .filter(|&row| open[row] > TAKES_PART * widest)
            .map(|row| system.rows[row].declaration)
            .collect();
        behind.dedup();
        behind
    }

    /// Names of the result's columns that differ on the two sides of the edge.
    fn columns_that_jump(&self) -> Vec<String> {
        let jumps = |a: f64, b: f64| {
            (a - b).abs() > ACCELERATION_JUMP * a.abs().max(b.abs()).max(REST / (self.span * self.span))
        };
        let names = super::columns(self.kinematics.system());
        let sides = self.row_before.iter().zip(&self.row);
        names.into_iter().zip(sides).filter(|(_, (a, b))| jumps(**a, **b)).map(|(name, _)| name).collect()
    }
}

/// What jumps at an edge, the lowest derivative first.
#[derive(Clone, Copy, Debug)]
enum Jump {
    Position,
    Velocity { column: usize },
    Acceleration,
}
