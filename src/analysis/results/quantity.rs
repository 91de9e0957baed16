//! A formula of results that follows from the coordinates by operations alone.

use crate::program::{Op, Program, Register, Registers, Stage};
use crate::tolerances::results::formulas::MOVED;

/// A formula along the motion, and its time derivatives.
pub struct SmoothFormula {
    program: Program,
    registers: Registers,
    /// Its value and time derivatives, as many as there are: two at least.
    roots: Vec<Register>,
    /// What it is computed from: where a coordinate, differentiated so many times by time, is to stand.
    inputs: Vec<(Register, u32, usize)>,
}

impl SmoothFormula {
    /// Of a program that leaves a value and its derivatives in some registers.
    pub(super) fn new(
        (program, registers): (Program, Registers),
        roots: Vec<Register>,
        coordinates: usize,
    ) -> SmoothFormula {
        let operations = program.stage(Stage::Measures);
        let read: Vec<Register> = operations.iter().flat_map(|&op| program.reads(op)).chain(roots.clone()).collect();
        let mut inputs = Vec::new();
        for (order, first) in program.inputs.coordinates.into_iter().enumerate() {
            let own = (0..coordinates as Register).map(|k| (first + k, k, order));
            inputs.extend(own.filter(|(register, ..)| read.contains(register)));
        }
        SmoothFormula { program, registers, roots, inputs }
    }

    /// The program that it is computed by, and the program's registers.
    #[must_use]
    pub fn program(&self) -> (&Program, &Registers) {
        (&self.program, &self.registers)
    }

    /// The operations that follow from parameters alone, and those that follow from coordinates.
    #[must_use]
    pub fn operations(&self) -> [&[Op]; 2] {
        [Stage::Prologue, Stage::Measures].map(|stage| self.program.stage(stage))
    }

    /// Where its value and its time derivatives are left, as many as there are.
    #[must_use]
    pub fn roots(&self) -> &[Register] {
        &self.roots
    }

    /// Where what it is computed from is to stand: a coordinate, by its number, differentiated so many times by time.
    #[must_use]
    pub fn inputs(&self) -> &[(Register, u32, usize)] {
        &self.inputs
    }
}

/// What a coordinate, by its number, is taken times to see how much a formula makes of rounding, in one of some ways.
#[must_use]
pub fn moved(k: usize, way: u32) -> f64 {
    // up and down without a pattern that a formula could have
    let is_up = (k as u32 + 1).wrapping_mul(0x9E37_79B9 ^ way.wrapping_mul(0x85EB_CA6B)) >> 31 == 0;
    if is_up { 1.0 + MOVED } else { 1.0 - MOVED }
}
