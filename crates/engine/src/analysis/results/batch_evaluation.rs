//! Smooth formulas as operations on the coordinates, for evaluation in batches.

use crate::limits::curve::MOVED;
use mechc_ir::program::{Op, Program, Register, Registers, Stage};

/// A formula along the motion, and its time derivatives.
pub struct SmoothFormula {
    /// The computations in order: first the smooth parts, then what depends on them.
    stages: Vec<Computed>,
    /// The registers of the last stage with the value and its time derivatives: two at least.
    roots: Vec<Register>,
    is_length: bool,
}

/// A computation from coordinates and from results of the previous stage.
pub struct Computed {
    program: Program,
    registers: Registers,
    /// The operations behind the requested registers.
    operations: Vec<Op>,
    /// The register, order of time derivative and number of each coordinate that is read.
    inputs: Vec<(Register, u32, usize)>,
    /// The register in this stage and in the previous one, for each value that is copied.
    taken: Vec<(Register, Register)>,
}

impl Computed {
    /// Returns the computation by a program over `coordinates` coordinates that leaves the requested results in some registers.
    pub(super) fn new(program: Program, registers: Registers, coordinates: usize, requested: &[Register]) -> Computed {
        let mut inputs = Vec::new();
        for (order, first) in program.inputs.coordinates.into_iter().enumerate() {
            inputs.extend((0..coordinates as Register).map(|k| (first + k, k, order)));
        }
        let operations = program.operations_behind(requested, Stage::Measures);
        Computed { program, registers, operations, inputs, taken: Vec::new() }
    }

    /// Adds results of the previous stage as coordinates from number `coordinates` on, given by the registers of each value and its time
    /// derivatives. Returns `None` if one that is read is missing.
    pub(super) fn behind(
        mut self,
        before: &[[Option<Register>; 4]],
        coordinates: usize,
        requested: &[Register],
    ) -> Option<Computed> {
        let is_read = self.is_read(requested);
        for (order, first) in self.program.inputs.coordinates.into_iter().enumerate() {
            for (k, tower) in before.iter().enumerate() {
                let register = first + (coordinates + k) as Register;
                if is_read[register as usize] {
                    self.taken.push((register, tower[order]?));
                }
            }
        }
        Some(self)
    }

    /// Returns, by register, whether an operation reads it or it is requested.
    fn is_read(&self, requested: &[Register]) -> Vec<bool> {
        let mut is_read = vec![false; self.program.registers()];
        for &register in requested {
            is_read[register as usize] = true;
        }
        for &op in &self.operations {
            self.program.reads(op).for_each(|register| is_read[register as usize] = true);
        }
        is_read
    }

    /// Removes the inputs that no operation reads and that are not requested.
    fn retain_inputs(&mut self, requested: &[Register]) {
        let is_read = self.is_read(requested);
        self.inputs.retain(|(register, ..)| is_read[*register as usize]);
    }

    /// Returns the program and its registers.
    #[must_use]
    pub fn program(&self) -> (&Program, &Registers) {
        (&self.program, &self.registers)
    }

    /// Returns the operations that depend on parameters only, and those that depend on coordinates.
    #[must_use]
    pub fn operations(&self) -> [&[Op]; 2] {
        [self.program.stage(Stage::Prologue), &self.operations]
    }

    /// Returns the register, order of time derivative and number of each coordinate that is read.
    #[must_use]
    pub fn inputs(&self) -> &[(Register, u32, usize)] {
        &self.inputs
    }

    /// Returns the register in this stage and in the previous one, for each value that is copied.
    #[must_use]
    pub fn taken(&self) -> &[(Register, Register)] {
        &self.taken
    }
}

impl SmoothFormula {
    /// Returns the formula that is computed in stages, the last of which leaves the value and its derivatives in `roots`.
    pub(super) fn new(mut stages: Vec<Computed>, roots: Vec<Register>, is_length: bool) -> SmoothFormula {
        let count = stages.len();
        for k in 0..count {
            let requested = match stages.get(k + 1) {
                Some(next) => next.taken.iter().map(|&(_, from)| from).collect(),
                None => roots.clone(),
            };
            stages[k].retain_inputs(&requested);
        }
        SmoothFormula { stages, roots, is_length }
    }

    /// Returns the computations in order.
    #[must_use]
    pub fn stages(&self) -> &[Computed] {
        &self.stages
    }

    /// Returns the registers of the last stage with the value and its time derivatives.
    #[must_use]
    pub fn roots(&self) -> &[Register] {
        &self.roots
    }

    /// Returns whether the formula is a length, which has a kink at zero.
    #[must_use]
    pub fn is_length(&self) -> bool {
        self.is_length
    }
}

/// Returns the factor by which a coordinate is perturbed to measure how a formula amplifies rounding, for one of several perturbations.
#[must_use]
pub fn moved(k: usize, perturbation: u32) -> f64 {
    // a pseudorandom direction, so that no formula cancels the perturbations systematically
    let is_up = (k as u32 + 1).wrapping_mul(0x9E37_79B9 ^ perturbation.wrapping_mul(0x85EB_CA6B)) >> 31 == 0;
    if is_up { 1.0 + MOVED } else { 1.0 - MOVED }
}
