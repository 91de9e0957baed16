//! Edges: the times where a formula goes over to another of its branches.
//!
//! Within a step every switch is frozen, so that the equations are smooth there. An edge of time is looked for before a
//! step, one of the motion after it; both are located to neighbouring doubles, and the step ends there. Then both sides
//! are evaluated at that same time, and compared: a position or velocity that jumps has no acceleration, an acceleration
//! that jumps has two.

use super::aslant;
use super::errors;
use super::kinematics::Fault;
use super::march::Motion;
use super::singular;
use crate::diag::Diagnostic;
use crate::ir::{CoordinateKind, DeclarationId};
use crate::layout::{self, ColumnKind};
use crate::tolerances::jumps::{ACCELERATION_JUMP, POSITION_JUMP, REST, VELOCITY_JUMP};
use crate::tolerances::steps::edges::{
    AHEAD, AT_REST, FARTHEST_AHEAD, FINEST, FINEST_BETWEEN, ITERATIONS, LAST_DIGITS, LONGEST_AHEAD, LONGEST_REST,
    MOST_PARTS, MOST_PARTS_BETWEEN, NUDGE, ROUNDING, SLACK, TAKES_PART, UNCERTAIN,
};

/// A time on the later side of whatever is meant to happen at `t` (s).
pub(super) fn shortly_after(t: f64) -> f64 {
    t + SLACK * f64::EPSILON * t.abs() + f64::MIN_POSITIVE
}

/// A time just behind a start at `t`, for a motion over a span (s): what happens up to there happens at the start.
pub(super) fn behind_start(t: f64, span: f64) -> f64 {
    shortly_after(t) + f64::min(AHEAD * span, LONGEST_AHEAD)
}

/// Where a switch changes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// Where both sides are evaluated (s).
    pub t: f64,
    /// A time (s) at which every switch of time is on the later side; none for an edge of the motion.
    pub after: Option<f64>,
    /// Whether it is the place from which a rim is judged.
    pub is_rim: bool,
}

/// A switch that has gone back and forth without anything to show for it: two branches that agree to rounding. It is left
/// alone for a while, and for longer each time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Restless {
    last: f64,
    length: f64,
    until: f64,
}

impl Restless {
    /// One that has never been so.
    pub(super) const NEVER: Restless = Restless { last: f64::NEG_INFINITY, length: 0.0, until: f64::NEG_INFINITY };
}

impl Motion {
    /// Whether a time is the last one, where the earlier side counts.
    fn is_last(&self, t: f64) -> bool {
        shortly_after(t) >= self.last
    }

    /// The first edge that a step to `next` meets, before the last time. An edge that is meant to be at the output time
    /// `next` is there.
    ///
    /// # Errors
    /// A formula of time ends on the way.
    pub(super) fn next_edge(&mut self, next: f64, is_output: bool) -> Result<Option<Edge>, Box<Diagnostic>> {
        let reach = if is_output { shortly_after(next) } else { next };
        let of_time = if self.in_time.is_empty() { None } else { self.edge_of_time(self.state.t, reach)? };
        let edge = match (of_time, self.met.filter(|edge| edge.t <= reach)) {
            (Some(a), Some(b)) => Some(if b.t < a.t { b } else { a }),
            (one, other) => one.or(other),
        };
        let rim = if self.kinematics.rims().is_empty() { None } else { self.next_rim(reach) };
        let rim = rim.map(|t| Edge { t, after: None, is_rim: true });
        let edge = match (edge, rim) {
            (Some(a), Some(b)) => Some(if b.t < a.t { b } else { a }),
            (one, other) => one.or(other),
        };
        let edge = edge.map(|edge| Edge { t: edge.t.min(next).max(self.state.t), ..edge });
        Ok(edge.filter(|edge| !self.is_last(edge.t)))
    }

    /// The first edge of time from `from` on, where all switches are known, up to `to`.
    fn edge_of_time(&mut self, from: f64, to: f64) -> Result<Option<Edge>, Box<Diagnostic>> {
        let finest = FINEST * self.span;
        // parts that are still to be looked at, the first one last
        let mut open = [[0.0; 2]; 64];
        let (mut count, mut looked_at) = (1, 0);
        open[0] = [from, to];
        while count > 0 {
            count -= 1;
            looked_at += 1;
            let part @ [a, b] = open[count];
            let (switches, restless) = (self.kinematics.switches(), &self.restless);
            let may_change = |register| {
                switches.iter().zip(restless).any(|(switch, restless)| switch.to == register && restless.until > a)
            };
            if self.kinematics.is_steady(&mut self.in_time, part, &[], may_change) {
                continue;
            }
            let middle = 0.5 * (a + b);
            if b - a > finest && looked_at < MOST_PARTS && count + 2 <= open.len() && middle > a && middle < b {
                open[count] = [middle, b];
                open[count + 1] = [a, middle];
                count += 2;
            } else if let Some(edge) = self.bisect(a, b)? {
                return Ok(Some(edge));
            }
        }
        Ok(None)
    }

    /// The edge of time between two times, the switches being known at the first; none if nothing has changed at the second
    /// and shortly after it.
    fn bisect(&mut self, a: f64, b: f64) -> Result<Option<Edge>, Box<Diagnostic>> {
        if !self.happens_at(b) {
            return Ok(None);
        }
        let mut low = a;
        loop {
            let mut high = b;
            loop {
                let middle = 0.5 * (low + high);
                if middle <= low || middle >= high {
                    break;
                }
                if self.happens_at(middle) {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            self.kinematics.set_time(high);
            if let Some(index) = self.kinematics.broken_condition().filter(|_| high <= self.last) {
                return Err(Box::new(errors::no_value(self.kinematics.system(), Fault::Condition { index }, high)));
            }
            let after = high.next_up();
            if self.happens_at(after) {
                self.kinematics.set_time(low);
                let on_edge = |switch| self.kinematics.is_on_edge(switch);
                let is_low = self.kinematics.switches().iter().filter(|switch| switch.on_time).any(on_edge);
                return Ok(Some(Edge { t: if is_low { low } else { high }, after: Some(after), is_rim: false }));
            }
            // what differs at a single time is no edge, `t == 1 s`; or rounding goes back and forth around one
            if after >= b {
                return Ok(None);
            }
            low = after;
        }
    }

    /// Whether a switch of time would change at a time, or a formula of time ends.
    fn happens_at(&mut self, t: f64) -> bool {
        self.kinematics.set_time(t);
        let switches = self.kinematics.switches().iter().zip(&self.restless);
        let mut of_time = switches.filter(|(switch, restless)| switch.on_time && restless.until <= t);
        of_time.any(|(switch, _)| self.kinematics.would_switch(switch)) || self.breaks_in_time()
    }

    /// Whether a condition on time alone is broken where time was set: those on the motion have not been evaluated.
    fn breaks_in_time(&self) -> bool {
        !self.in_time.conditions_hold(|register| self.kinematics.value(register))
    }

    /// The switch of the motion beyond whose edge the position is that was just set.
    pub(super) fn edge_met(&self) -> Option<usize> {
        let mut switches = self.kinematics.switches().iter().zip(&self.restless);
        switches.position(|(switch, restless)| {
            !switch.on_time && restless.until <= self.state.t && self.kinematics.would_switch(switch)
        })
    }

    /// Finds the edge of the motion that lies before a time; says whether it could.
    pub(super) fn locate(&mut self, next: f64) -> bool {
        let (mut low, mut high) = (self.state.t, next);
        let mut found = self.solve_at(next).is_ok() && self.edge_met().is_some();
        while found || high < next {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            match self.solve_at(middle) {
                Ok(()) if self.edge_met().is_none() => low = middle,
                Ok(()) => (high, found) = (middle, true),
                // beyond the edge a formula need not go on
                Err(_) => (high, found) = (middle, false),
            }
        }
        if found {
            self.met = Some(Edge { t: high, after: None, is_rim: false });
        }
        found
    }

    fn solve_at(&mut self, t: f64) -> Result<(), Fault> {
        self.predict(t - self.state.t, t)?;
        self.correct().map(|_| ())
    }

    /// Looks at what a step that was tried goes over between its ends, on the curve through both: an edge of the motion, a
    /// formula that ends, a branch that is left and taken again.
    pub(super) fn look_between(&mut self, h: f64, between: f64) -> Result<(), Fault> {
        if self.along.is_empty() {
            return Ok(());
        }
        let mut open = [[0.0; 2]; 32];
        let (mut count, mut looked_at) = (1, 0);
        open[0] = [0.0, 1.0];
        while count > 0 {
            count -= 1;
            looked_at += 1;
            let part @ [a, b] = open[count];
            if self.is_steady_between(h, part, between) {
                continue;
            }
            if b - a > FINEST_BETWEEN && looked_at < MOST_PARTS_BETWEEN && count + 2 <= open.len() {
                let middle = 0.5 * (a + b);
                open[count] = [middle, b];
                open[count + 1] = [a, middle];
                count += 2;
            } else {
                self.look_at(h, b)?;
            }
        }
        Ok(())
    }

    fn is_steady_between(&mut self, h: f64, [a, b]: [f64; 2], between: f64) -> bool {
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
            let slack = 2.0 * between * self.kinematics.linear().column_scale(k);
            self.boxes[k] = [taylor[0], rest + slack];
        }
        let (switches, restless) = (self.kinematics.switches(), &self.restless);
        let t = self.state.t;
        let may_change = |register| {
            switches.iter().zip(restless).any(|(switch, restless)| switch.to == register && restless.until > t)
        };
        let times = [t + a * h, t + b * h];
        self.kinematics.is_steady(&mut self.along, times, &self.boxes, may_change)
    }

    /// Looks at one place of the curve through both ends of a step.
    fn look_at(&mut self, h: f64, x: f64) -> Result<(), Fault> {
        self.set_on_curve(h, x)?;
        if let Some(switch) = self.edge_met() {
            return Err(Fault::Edge { t: self.state.t + x * h, switch });
        }
        self.kinematics.sides(&mut self.trial_sides);
        match (0..self.sides.len()).find(|&k| self.sides[k] != self.trial_sides[k]) {
            Some(index) => Err(Fault::Watch { index }),
            None => Ok(()),
        }
    }

    /// Goes over to the later side of an edge, which the state has reached on the earlier one.
    pub(super) fn cross(&mut self, edge: Edge) -> Result<(), Box<Diagnostic>> {
        if edge.is_rim {
            return self.cross_rim();
        }
        if self.met.is_some_and(|known| known.t <= edge.t) {
            self.met = None;
        }
        self.remember();
        self.settle(edge.after);
        match self.later_side() {
            Ok(None) => {
                self.note_restless();
                Ok(())
            }
            Ok(Some(jump)) => self.say(jump),
            Err(fault) => {
                let t = self.state.t;
                Err(Box::new(singular::explain(&mut self.kinematics, &self.before, fault, 0.0, t)))
            }
        }
    }

    /// Nothing jumps at an edge: if it is one of many in no time at all, its switch is left alone for a while.
    fn note_restless(&mut self) {
        let t = self.state.t;
        let switches = self.kinematics.switches().iter().zip(&self.switches_before);
        for (restless, (switch, before)) in self.restless.iter_mut().zip(switches) {
            if self.kinematics.switch(switch).to_bits() == before.to_bits() {
                continue;
            }
            let at_once = t - restless.last <= f64::max(4.0 * restless.length, FINEST * self.span);
            restless.length = if at_once { f64::max(2.0 * restless.length, FINEST * self.span) } else { 0.0 };
            restless.length = restless.length.min(LONGEST_REST * self.span);
            (restless.last, restless.until) = (t + restless.length, t + restless.length);
        }
    }

    /// Whether a switch that changes where the position was set stands on its edge all the time, so that rounding decides:
    /// what it is decided by neither is off the edge nor has it moved since the state.
    pub(super) fn rests_on_edge(&mut self, switch: usize) -> bool {
        let switch = self.kinematics.switches()[switch];
        let (there, off) = self.kinematics.edge(&switch);
        self.kinematics.set_time(self.state.t);
        let at = |motion: &mut Self, nudge: f64| {
            let linear = motion.kinematics.linear();
            for (k, (middle, q)) in motion.middle.iter_mut().zip(&motion.state.q).enumerate() {
                *middle = q + nudge * linear.column_scale(k) * aslant(k);
            }
            // what is wrong with a position shows where it is solved for
            let _ = motion.kinematics.set_position(&motion.middle);
            motion.kinematics.edge(&switch).0
        };
        let (nudged, here) = (at(self, NUDGE), at(self, 0.0));
        let linear = self.kinematics.linear();
        let nothing =
            f64::max(AT_REST, ROUNDING * f64::EPSILON * linear.largest(&self.state.q)) * (nudged - here).abs() / NUDGE;
        off <= nothing && (there - here).abs() <= nothing
    }

    /// Leaves a switch alone up to a time (s).
    pub(super) fn leave_alone(&mut self, switch: usize, t: f64) {
        self.restless[switch].until = t;
    }

    /// Keeps the earlier side: the state, its row, the switches.
    fn remember(&mut self) {
        self.before.copy_from(&self.state);
        for (old, switch) in self.switches_before.iter_mut().zip(self.kinematics.switches()) {
            *old = self.kinematics.switch(switch);
        }
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
        let ahead = self.way_ahead();
        for k in 0..self.middle.len() {
            self.middle[k] = self.state.q[k] + ahead * (self.state.qd[k] + 0.5 * ahead * self.state.qdd[k]);
        }
        // a guard may speak of the motion and of time
        self.kinematics.set_time(self.state.t + ahead);
        self.kinematics.settle_motion(&self.middle);
        self.kinematics.set_time(self.state.t);
    }

    /// How long the motion is looked ahead (s).
    fn way_ahead(&self) -> f64 {
        let linear = self.kinematics.linear();
        let (speed, acceleration) = (linear.largest(&self.state.qd), linear.largest(&self.state.qdd));
        (AHEAD * self.span).min(FARTHEST_AHEAD / speed).min((FARTHEST_AHEAD / acceleration).sqrt())
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
        if self.kinematics.violated().is_some() {
            return Err(Fault::TooFar);
        }
        self.kinematics.factor()?;
        self.same_branch()?;
        self.begin_determinants();
        self.kinematics.derivatives(&mut self.state)?;
        self.kinematics.write_row(&self.state, &mut self.row);
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
        self.trial.copy_from(&self.state);
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
        let velocity = change(&self.trial.qd, &self.state.qd).max(moment * self.velocity_change);
        let acceleration = change(&self.trial.qdd, &self.state.qdd).max(moment * self.acceleration_change);
        Ok((UNCERTAIN * velocity, UNCERTAIN * acceleration))
    }

    /// What jumps by more than `velocity` and `acceleration`, scaled, and more than rounding.
    fn compare(&self, velocity: f64, acceleration: f64) -> Option<Jump> {
        let (before, now, system) = (&self.before, &self.state, self.kinematics.system());
        let scaled = |k: usize, value: f64| value.abs() / self.kinematics.linear().column_scale(k);
        let largest =
            |a: &[f64], b: &[f64]| (0..a.len()).map(|k| f64::max(scaled(k, a[k]), scaled(k, b[k]))).fold(0.0, f64::max);
        let fastest = largest(&before.qd, &now.qd).max(REST / self.span);
        let hardest = largest(&before.qdd, &now.qdd).max(REST * fastest / self.span);
        // beside what has been met before, the last digits of a formula are nothing
        let velocity = velocity.max(VELOCITY_JUMP * fastest).max(LAST_DIGITS * self.fastest);
        let acceleration = acceleration.max(ACCELERATION_JUMP * hardest).max(LAST_DIGITS * self.hardest);
        let jumps = |k: &usize| scaled(*k, now.qd[*k] - before.qd[*k]) > velocity;
        let bends = |k: &usize| scaled(*k, now.qdd[*k] - before.qdd[*k]) > acceleration;
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
                let far = (column, self.delta[column]);
                Err(Box::new(errors::position_jump(system, &behind, self.is_corner(), far, t)))
            }
            Jump::Velocity { column } => {
                let velocities = [self.before.qd[column], self.state.qd[column]];
                Err(Box::new(errors::velocity_jump(system, &behind, column, velocities, t)))
            }
            Jump::Acceleration => {
                if let Some(edges) = &mut self.edges {
                    edges.push(t);
                }
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
    fn declarations_behind(&self, jump: Jump) -> Vec<DeclarationId> {
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
        let mut behind: Vec<DeclarationId> = (0..open.len())
            .filter(|&row| open[row] > TAKES_PART * widest)
            .map(|row| system.rows[row].declaration)
            .collect();
        behind.dedup();
        behind
    }

    /// Whether the position stays, and only the tangents of a contact do not agree: the last row of its joint.
    fn is_corner(&self) -> bool {
        let system = self.kinematics.system();
        let widest = (0..system.rows.len())
            .max_by(|&a, &b| self.kinematics.residual(a).total_cmp(&self.kinematics.residual(b)))
            .unwrap_or(0);
        let declaration = system.rows[widest].declaration;
        let is_last = system.rows.get(widest + 1).is_none_or(|next| next.declaration != declaration);
        let others = (0..widest).rev().take_while(|&row| system.rows[row].declaration == declaration);
        is_last && others.map(|row| self.kinematics.residual(row)).all(|open| open < POSITION_JUMP)
    }

    /// Names of the result's columns that differ on the two sides of the edge.
    pub(super) fn columns_that_jump(&self) -> Vec<String> {
        let jumps = |a: f64, b: f64| {
            (a - b).abs() > ACCELERATION_JUMP * a.abs().max(b.abs()).max(REST / (self.span * self.span))
        };
        // what is varied jumps with what it is a derivative of
        let columns = layout::columns(self.kinematics.system());
        let own = columns.into_iter().filter(|column| column.kind != ColumnKind::Variation);
        let sides = self.row_before.iter().zip(&self.row);
        own.zip(sides).filter(|(_, (a, b))| jumps(**a, **b)).map(|(column, _)| column.name).collect()
    }
}

/// What jumps at an edge, the lowest derivative first.
#[derive(Clone, Copy, Debug)]
enum Jump {
    Position,
    Velocity { column: usize },
    Acceleration,
}
