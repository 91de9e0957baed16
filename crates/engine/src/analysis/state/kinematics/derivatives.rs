//! Velocity, acceleration and jerk of a state, with bounds on their rounding errors.

use super::{Fault, Kinematics, State};
use mechc_ir::program::{Program, Register, Registers, Stage};
use std::sync::Arc;

/// Rounding errors of a state, by coordinate: of its position, velocity and acceleration.
#[derive(Clone, Default)]
pub(super) struct Spread {
    position: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    /// By row.
    right: Vec<f64>,
}

impl Spread {
    pub fn new(n: usize) -> Spread {
        let zero = vec![0.0; n];
        Spread { position: zero.clone(), velocity: zero.clone(), acceleration: zero.clone(), right: zero }
    }
}

impl Kinematics {
    /// Computes velocity, acceleration and, where needed, jerk of a state whose position was set and factored.
    pub fn derivatives(&mut self, state: &mut State) -> Result<(), Fault> {
        let linear = &mut self.linear;
        rates(&self.program, &mut self.registers, state, |registers, right, x| {
            linear.solve(|row| registers.get(right[row]), x);
        });
        self.all_finite(state)
    }

    /// Returns the speed that a row prescribes, scaled (1/s); the derivatives at the current position must have been computed.
    pub fn prescribed_speed(&self, row: usize) -> f64 {
        self.registers.get(self.program.outputs.nu()[row]).abs() / self.linear.row_norm(row)
    }

    /// Returns how much larger the velocities and accelerations of a state are than the right sides they answer to, scaled; at
    /// least 1. Its derivatives must just have been computed.
    pub fn amplification(&self, state: &State) -> f64 {
        let outputs = &self.program.outputs;
        let largest_right = |right: &[Register]| {
            let scaled =
                |(row, &register): (usize, &Register)| self.registers.get(register).abs() / self.linear.row_norm(row);
            right.iter().enumerate().map(scaled).fold(0.0, f64::max)
        };
        let ratio = |left: f64, right: f64| if right > 0.0 { left / right } else { 1.0 };
        let velocity = ratio(self.linear.largest(&state.qd), largest_right(outputs.nu()));
        let acceleration = ratio(self.linear.largest(&state.qdd), largest_right(outputs.gamma()));
        velocity.max(acceleration).max(1.0)
    }

    /// Computes bounds on the errors of velocity and acceleration of a state, if it is nearer to a singular position than a limit; returns
    /// whether it is. Equations hold but for their rounding: the nearer the state is, the more its position moves to make up for that, and
    /// derivatives move with it. The state must just have been computed.
    pub fn compute_error_bounds(&mut self, state: &State, limit: f64) -> bool {
        let mut doubt = std::mem::take(&mut self.doubt);
        let is_near = self.linear.write_weights(limit, &mut doubt.right);
        if is_near {
            self.carry_rounding(state, &mut doubt);
            self.set_state(state);
        }
        self.doubt = doubt;
        is_near
    }

    /// Returns bounds on the errors of velocity and acceleration, by coordinate [m/s, rad/s; m/s², rad/s²]. They must have been computed.
    pub fn doubt(&self) -> [&[f64]; 2] {
        [&self.doubt.velocity, &self.doubt.acceleration]
    }

    /// Propagates the rounding of the rows, weighted by their dependency and all adding up, to the errors of a state.
    fn carry_rounding(&mut self, state: &State, doubt: &mut Spread) {
        for (row, weight) in doubt.right.iter_mut().enumerate() {
            *weight = f64::EPSILON * self.largest_part(row).copysign(*weight) * f64::from(u8::from(*weight != 0.0));
        }
        self.solve(&doubt.right, &mut doubt.position);
        for ((nearby, q), off) in self.nearby.iter_mut().zip(&state.q).zip(&doubt.position) {
            *nearby = q + off;
        }
        let program = Arc::clone(&self.program);
        let ([coordinates, qd, ..], outputs) = (program.inputs.coordinates, &program.outputs);
        self.registers.set_all(coordinates, &self.nearby);
        program.run(Stage::Position, &mut self.registers);
        program.run(Stage::Velocity, &mut self.registers);
        self.write_open(outputs.nu(), &state.qd, &mut doubt.right);
        self.solve(&doubt.right, &mut doubt.velocity);
        for ((nearby, speed), off) in self.nearby.iter_mut().zip(&state.qd).zip(&doubt.velocity) {
            *nearby = speed - off;
        }
        self.registers.set_all(qd, &self.nearby);
        program.run(Stage::Acceleration, &mut self.registers);
        self.write_open(outputs.gamma(), &state.qdd, &mut doubt.right);
        self.solve(&doubt.right, &mut doubt.acceleration);
    }

    /// Rejects a state whose velocity or acceleration is not finite. Without a jerk only measures of it have no value.
    pub(super) fn all_finite(&self, state: &State) -> Result<(), Fault> {
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        if finite(&state.qd) && finite(&state.qdd) {
            return Ok(());
        }
        let outputs = &self.program.outputs;
        let row = [outputs.nu(), outputs.gamma()]
            .into_iter()
            .find_map(|list| list.iter().position(|&register| !self.registers.get(register).is_finite()));
        Err(row.map_or(Fault::Singular, |row| Fault::NotFinite { row }))
    }

    /// Sets a state that was computed before.
    pub(super) fn set_state(&mut self, state: &State) {
        self.registers.set_all(self.program.inputs.coordinates[0], &state.q);
        self.program.run(Stage::Position, &mut self.registers);
        self.set_derivatives(state);
    }

    pub(super) fn set_derivatives(&mut self, state: &State) {
        let (program, registers) = (&*self.program, &mut self.registers);
        let [_, qd, qdd, qddd] = program.inputs.coordinates;
        // measures share subexpressions with the right sides, which have to be of these derivatives
        program.run(Stage::Velocity, registers);
        registers.set_all(qd, &state.qd);
        program.run(Stage::Acceleration, registers);
        registers.set_all(qdd, &state.qdd);
        program.run(Stage::Jerk, registers);
        registers.set_all(qddd, &state.qddd);
    }
}

/// Computes velocity, acceleration and, where needed, jerk of a state whose position was set, by a closure that solves `Φ_q x = b` for a right side.
pub(super) fn rates(
    program: &Program,
    registers: &mut Registers,
    state: &mut State,
    mut solve: impl FnMut(&Registers, &[Register], &mut [f64]),
) {
    let [_, qd, qdd, qddd] = program.inputs.coordinates;
    let outputs = &program.outputs;
    program.run(Stage::Velocity, registers);
    solve(registers, outputs.nu(), &mut state.qd);
    registers.set_all(qd, &state.qd);
    program.run(Stage::Acceleration, registers);
    solve(registers, outputs.gamma(), &mut state.qdd);
    if !outputs.jerk().is_empty() {
        registers.set_all(qdd, &state.qdd);
        program.run(Stage::Jerk, registers);
        solve(registers, outputs.jerk(), &mut state.qddd);
        registers.set_all(qddd, &state.qddd);
    }
}
