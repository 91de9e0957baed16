//! States on both sides of an edge, at its time, and the jumps between them.

use crate::analysis::explain::{Stop, StopCause};
use crate::analysis::follow::step::{Step, write_prediction};
use crate::analysis::follow::warnings::Warnings;
use crate::analysis::state::{Fault, Kinematics, State, shortly_after};
use crate::limits::edges::{AHEAD, FARTHEST_AHEAD};
use crate::limits::jumps::{ACCELERATION_JUMP, POSITION_JUMP, REST, VELOCITY_JUMP};
use mechc_ir::layout::{ColumnKind, columns};
use mechc_ir::{ConstraintSystem, CoordinateKind, DeclarationId};

/// Values below this part of the largest velocity or acceleration so far are rounding.
const LAST_DIGITS: f64 = 1e-9;
/// Amplification of the rounding of an edge's time in computed values.
const UNCERTAIN: f64 = 16.0;
/// An equation takes part in a jump if its residual is at least this part of the largest.
const TAKES_PART: f64 = 1e-2;
/// Maximum number of corrections of a position at an edge.
const ITERATIONS: usize = 4;

/// The lowest derivative that jumps at an edge.
#[derive(Clone, Copy, Debug)]
pub(super) enum Jump {
    Position,
    Velocity { column: usize },
    Acceleration,
}

/// Rates of change of a motion, scaled.
#[derive(Clone, Copy, Default)]
struct Pace {
    /// Rates of change of velocity and acceleration over the last step (1/s², 1/s³).
    velocity_change: f64,
    acceleration_change: f64,
    /// The largest velocity and acceleration so far (1/s, 1/s²).
    fastest: f64,
    hardest: f64,
}

/// The earlier side of the edge that is being crossed, and the data to compare the later one with.
pub(super) struct OneSidedStates {
    before: State,
    row_before: Vec<f64>,
    /// Row of the later side.
    row: Vec<f64>,
    /// Results of the switches on the earlier side.
    switches: Vec<f64>,
    pace: Pace,
    /// The time that all is measured against (s).
    span: f64,
}

impl OneSidedStates {
    pub fn new(kinematics: &Kinematics, state: &State, span: f64) -> OneSidedStates {
        let row = vec![0.0; kinematics.row_length()];
        let switches = vec![0.0; kinematics.switches().len()];
        OneSidedStates { before: state.clone(), row_before: row.clone(), row, switches, pace: Pace::default(), span }
    }

    /// Returns the earlier side.
    pub fn before(&self) -> &State {
        &self.before
    }

    /// Returns the row of the later side.
    pub fn later_row(&self) -> &[f64] {
        &self.row
    }

    /// Returns the results of the switches on the earlier side.
    pub fn switches(&self) -> &[f64] {
        &self.switches
    }

    /// Takes note of how fast a motion changes from one state to another, `h` (s) later.
    pub fn record_rates(&mut self, kinematics: &Kinematics, [a, b]: [&State; 2], h: f64) {
        let linear = kinematics.linear();
        let change = |a: &[f64], b: &[f64]| {
            let scaled = |k: usize| (b[k] - a[k]).abs() / linear.column_scale(k);
            (0..a.len()).map(scaled).fold(0.0, f64::max)
        };
        // a motion that begins and ends at rest within the step is fast between
        let swing = |k: usize| (b.q[k] - a.q[k] - 0.5 * h * (a.qd[k] + b.qd[k])).abs() / linear.column_scale(k);
        let swing = (0..a.q.len()).map(swing).fold(0.0, f64::max);
        let (faster, harder) = (2.0 * swing / h, 6.0 * swing / (h * h));
        let pace = &mut self.pace;
        pace.velocity_change = f64::max(change(&a.qd, &b.qd) / h, harder);
        pace.acceleration_change = f64::max(change(&a.qdd, &b.qdd) / h, 6.0 * harder / h);
        pace.fastest = pace.fastest.max(linear.largest(&b.qd)).max(faster);
        pace.hardest = pace.hardest.max(linear.largest(&b.qdd)).max(harder);
    }

    /// Keeps the earlier side: the state, its row, the switches.
    pub fn remember(&mut self, kinematics: &mut Kinematics, state: &State) {
        self.before.copy_from(state);
        for (old, switch) in self.switches.iter_mut().zip(kinematics.switches()) {
            *old = kinematics.switch(switch);
        }
        kinematics.restore(&self.before);
        // the state was computed once, so that this cannot fail now
        let _ = kinematics.derivatives(&mut self.before);
        kinematics.write_row(&self.before, &mut self.row_before);
    }

    /// Computes the state anew where it is, with the switches as they are now, and compares.
    pub fn take_later(&mut self, kinematics: &mut Kinematics, step: &mut Step) -> Result<Option<Jump>, Fault> {
        if !step.correct_state(kinematics, ITERATIONS, POSITION_JUMP)? {
            return Ok(Some(Jump::Position));
        }
        kinematics.write_row(step.state(), &mut self.row);
        if self.compare(kinematics, step.state(), [0.0; 2]).is_none() {
            return Ok(None);
        }
        // the difference may be the rounding of the edge's time alone
        let change = self.change_of_a_moment(kinematics, step)?;
        Ok(self.compare(kinematics, step.state(), change))
    }

    /// Returns how much velocities and accelerations change within the rounding of the edge's time, on either side, scaled.
    fn change_of_a_moment(&self, kinematics: &mut Kinematics, step: &mut Step) -> Result<[f64; 2], Fault> {
        let moment = shortly_after(step.t()) - step.t();
        step.try_moment_later(kinematics, moment)?;
        let change = |a: &[f64], b: &[f64]| {
            let scaled = |k: usize| (a[k] - b[k]).abs() / kinematics.linear().column_scale(k);
            (0..a.len()).map(scaled).fold(0.0, f64::max)
        };
        let (trial, state, pace) = (step.trial(), step.state(), self.pace);
        let velocity = change(&trial.qd, &state.qd).max(moment * pace.velocity_change);
        let acceleration = change(&trial.qdd, &state.qdd).max(moment * pace.acceleration_change);
        Ok([UNCERTAIN * velocity, UNCERTAIN * acceleration])
    }

    /// Returns the jumps that exceed rounding and some velocity and acceleration, scaled.
    fn compare(&self, kinematics: &Kinematics, now: &State, [velocity, acceleration]: [f64; 2]) -> Option<Jump> {
        let (before, system) = (&self.before, kinematics.system());
        let scaled = |k: usize, value: f64| value.abs() / kinematics.linear().column_scale(k);
        let largest =
            |a: &[f64], b: &[f64]| (0..a.len()).map(|k| f64::max(scaled(k, a[k]), scaled(k, b[k]))).fold(0.0, f64::max);
        let fastest = largest(&before.qd, &now.qd).max(REST / self.span);
        let hardest = largest(&before.qdd, &now.qdd).max(REST * fastest / self.span);
        // compared with earlier velocities, the last digits of a formula are rounding
        let velocity = velocity.max(VELOCITY_JUMP * fastest).max(LAST_DIGITS * self.pace.fastest);
        let acceleration = acceleration.max(ACCELERATION_JUMP * hardest).max(LAST_DIGITS * self.pace.hardest);
        let jumps = |k: &usize| scaled(*k, now.qd[*k] - before.qd[*k]) > velocity;
        let bends = |k: &usize| scaled(*k, now.qdd[*k] - before.qdd[*k]) > acceleration;
        let mut all = 0..now.qd.len();
        // only bodies count: a contact may move along its curve at any speed
        match all.clone().filter(jumps).find(|&k| system.coordinates()[k].kind != CoordinateKind::Argument) {
            Some(column) => Some(Jump::Velocity { column }),
            None => all.any(|k| jumps(&k) || bends(&k)).then_some(Jump::Acceleration),
        }
    }

    /// Reports a jump: as an error, or as a warning once for each declaration.
    pub fn report(
        &self,
        kinematics: &Kinematics,
        step: &Step,
        jump: Jump,
        warnings: &mut Warnings,
    ) -> Result<(), Box<Stop>> {
        let system = kinematics.system();
        let behind = self.declarations_behind(kinematics, jump);
        let t = step.t();
        match jump {
            Jump::Position => {
                let delta = step.delta();
                let far = |k: &usize| delta[*k].abs() / kinematics.linear().column_scale(*k);
                let column = (0..delta.len()).max_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(0);
                let (jump, is_corner) = (Some((column, delta[column])), is_corner(kinematics));
                Err(StopCause::PositionJump { declarations: behind, jump, is_corner }.at(t))
            }
            Jump::Velocity { column } => {
                let velocities = [self.before.qd[column], step.state().qd[column]];
                Err(StopCause::VelocityJump { declarations: behind, column, velocities }.at(t))
            }
            Jump::Acceleration => {
                warnings.take_jump(t);
                let columns = || columns_that_jump(system, self.span, [&self.row_before, &self.row]);
                warnings.warn_of_jump(&behind, columns, t);
                Ok(())
            }
        }
    }

    /// Returns the declarations whose own equations the earlier side does not satisfy, with the branches of the later one.
    fn declarations_behind(&self, kinematics: &Kinematics, jump: Jump) -> Vec<DeclarationId> {
        let system = kinematics.system();
        let open = |row: usize| {
            let (velocity, acceleration) = kinematics.left_open(row, &self.before);
            match jump {
                Jump::Position => kinematics.residual(row),
                Jump::Velocity { .. } => velocity,
                // a contact that moves on at another speed violates its velocity equation
                Jump::Acceleration => acceleration.max(velocity / self.span),
            }
        };
        let open: Vec<f64> = (0..system.rows().len()).map(open).collect();
        let widest = open.iter().copied().fold(0.0, f64::max);
        let mut behind: Vec<DeclarationId> = (0..open.len())
            .filter(|&row| open[row] > TAKES_PART * widest)
            .map(|row| system.rows()[row].declaration)
            .collect();
        behind.dedup();
        behind
    }
}

/// Sets every switch to what it is on the later side of a state; `after` is a time by which those of time have changed (s), and `place`
/// room for a position.
pub(super) fn settle(kinematics: &mut Kinematics, state: &State, span: f64, after: Option<f64>, place: &mut [f64]) {
    if let Some(after) = after {
        kinematics.settle_time(after);
    }
    let linear = kinematics.linear();
    let (speed, acceleration) = (linear.largest(&state.qd), linear.largest(&state.qdd));
    let ahead = (AHEAD * span).min(FARTHEST_AHEAD / speed).min((FARTHEST_AHEAD / acceleration).sqrt());
    write_prediction(state, ahead, place);
    // a guard may depend on the motion and on time
    kinematics.set_time(state.t + ahead);
    kinematics.settle_motion(place);
    kinematics.set_time(state.t);
}

/// Returns the names of the result's columns that differ on the two sides of an edge, by the rows of both.
pub(super) fn columns_that_jump(system: &ConstraintSystem, span: f64, [before, after]: [&[f64]; 2]) -> Vec<String> {
    let jumps = |a: f64, b: f64| (a - b).abs() > ACCELERATION_JUMP * a.abs().max(b.abs()).max(REST / (span * span));
    // a variation jumps with the quantity of which it is a derivative
    let given = columns(system).into_iter().filter(|column| column.kind != ColumnKind::Variation);
    let sides = before.iter().zip(after);
    given.zip(sides).filter(|(_, (a, b))| jumps(**a, **b)).map(|(column, _)| column.name).collect()
}

/// Returns whether the position stays, and only the tangents of a contact do not agree: the last row of its joint.
fn is_corner(kinematics: &Kinematics) -> bool {
    let system = kinematics.system();
    let widest = (0..system.rows().len())
        .max_by(|&a, &b| kinematics.residual(a).total_cmp(&kinematics.residual(b)))
        .unwrap_or(0);
    let declaration = system.rows()[widest].declaration;
    let is_last = system.rows().get(widest + 1).is_none_or(|next| next.declaration != declaration);
    let others = (0..widest).rev().take_while(|&row| system.rows()[row].declaration == declaration);
    is_last && others.map(|row| kinematics.residual(row)).all(|open| open < POSITION_JUMP)
}
