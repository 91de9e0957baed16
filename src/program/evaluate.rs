//! Running a program. Allocates nothing but the registers, once.

use super::{Op, Program, Stage};
use crate::expr::{binary_value, compare, unary_value};
use crate::math;

/// A program's registers.
#[derive(Clone, Debug)]
pub struct Registers {
    values: Vec<f64>,
}

impl Registers {
    /// The value of one.
    #[must_use]
    pub fn get(&self, register: super::Register) -> f64 {
        self.values[register as usize]
    }

    /// Sets an input.
    pub fn set(&mut self, register: super::Register, value: f64) {
        self.values[register as usize] = value;
    }

    /// Sets a run of inputs.
    pub fn set_all(&mut self, first: super::Register, values: &[f64]) {
        self.values[first as usize..first as usize + values.len()].copy_from_slice(values);
    }
}

impl Program {
    /// Registers with the constants and parameters in place, and the prologue run.
    #[must_use]
    pub fn start(&self, params: &[f64]) -> Registers {
        let mut registers = Registers { values: vec![0.0; self.registers()] };
        for &(register, value) in &self.constants {
            registers.set(register, value);
        }
        registers.set_all(self.inputs.params, params);
        self.run(Stage::Prologue, &mut registers);
        registers
    }

    /// Runs the operations of one stage.
    pub fn run(&self, stage: Stage, registers: &mut Registers) {
        let v = registers.values.as_mut_slice();
        for op in self.stage(stage) {
            match *op {
                Op::Add { to, a, b } => v[to as usize] = v[a as usize] + v[b as usize],
                Op::Sub { to, a, b } => v[to as usize] = v[a as usize] - v[b as usize],
                Op::Mul { to, a, b } => v[to as usize] = v[a as usize] * v[b as usize],
                Op::Div { to, a, b } => v[to as usize] = v[a as usize] / v[b as usize],
                Op::Neg { to, a } => v[to as usize] = -v[a as usize],
                Op::Recip { to, a } => v[to as usize] = 1.0 / v[a as usize],
                Op::SinCos { sin, cos, a } => (v[sin as usize], v[cos as usize]) = math::sin_cos(v[a as usize]),
                Op::Unary { function, to, a } => v[to as usize] = unary_value(function, v[a as usize]),
                Op::Binary { function, to, a, b } => {
                    v[to as usize] = binary_value(function, v[a as usize], v[b as usize]);
                }
                Op::Compare { comparison, to, a, b } => {
                    v[to as usize] = compare(comparison, v[a as usize], v[b as usize]);
                }
                Op::And { to, a, b } => v[to as usize] = f64::from(v[a as usize] != 0.0 && v[b as usize] != 0.0),
                Op::Or { to, a, b } => v[to as usize] = f64::from(v[a as usize] != 0.0 || v[b as usize] != 0.0),
                Op::Not { to, a } => v[to as usize] = f64::from(v[a as usize] == 0.0),
                Op::Select { to, condition, a, b } => {
                    v[to as usize] = if v[condition as usize] == 0.0 { v[b as usize] } else { v[a as usize] };
                }
            }
        }
    }
}
