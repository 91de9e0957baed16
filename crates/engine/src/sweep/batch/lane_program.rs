//! A program in lanes, whose parameters differ from variant to variant.

use super::{CHUNK, LANES, PerLane};
use mechc_ir::program::{LaneMachine, LaneValues, Op, Program, Register, Registers, Stage};
use std::sync::Arc;

/// A program with the operations that compute what depends on parameters alone.
#[derive(Clone)]
pub(super) struct LaneProgram {
    program: Arc<Program>,
    /// The program's registers with the nominal parameters.
    scalars: Registers,
    /// The operations on parameters alone whose results are used.
    prologue: Vec<Op>,
}

impl LaneProgram {
    /// Returns a program of which the registers `used` are used; `params` are the nominal parameters (SI).
    pub fn new(program: &Arc<Program>, params: &[f64], used: &[Register]) -> LaneProgram {
        let (scalars, prologue) = (program.start(params), prologue(program, used));
        LaneProgram { program: Arc::clone(program), scalars, prologue }
    }

    /// Returns the program, and its registers with the nominal parameters.
    pub fn parts(&self) -> (&Program, &Registers) {
        (&self.program, &self.scalars)
    }

    /// Returns new registers of the program, a lane for each variant.
    pub fn new_registers(&self) -> Vec<PerLane> {
        let mut registers = vec![LaneValues([0.0; LANES]); self.program.registers()];
        for &(register, value) in self.program.constants() {
            registers[register as usize].0 = [value; LANES];
        }
        registers
    }

    /// Computes the registers that depend on parameters alone, in the leading `chunks`.
    pub fn load(&self, registers: &mut [PerLane], params: &[PerLane], chunks: usize) {
        let first = self.program.inputs.params as usize;
        registers[first..first + params.len()].copy_from_slice(params);
        let mut machine = LaneMachine::<LANES, CHUNK>::new(registers, chunks, self.parts());
        self.prologue.iter().for_each(|op| op.run(&mut machine));
    }
}

/// Returns the operations of the prologue that the registers `live` depend on: dead-code elimination.
fn prologue(program: &Program, live: &[Register]) -> Vec<Op> {
    let mut is_read = vec![false; program.registers()];
    for &register in live {
        is_read[register as usize] = true;
    }
    let mut kept = Vec::new();
    for &op in program.stage(Stage::Prologue).iter().rev() {
        if op.writes().iter().any(|&to| is_read[to as usize]) {
            program.reads(op).for_each(|register| is_read[register as usize] = true);
            kept.push(op);
        }
    }
    kept.reverse();
    kept
}
