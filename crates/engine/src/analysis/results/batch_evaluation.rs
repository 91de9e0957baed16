//! A formula of results that follows from the coordinates by operations alone.

use mechc_ir::program::{Op, Program, Register, Registers, Stage};
use mechc_ir::tolerances::results::curve::MOVED;

/// A formula along the motion, and its time derivatives.
pub struct SmoothFormula {
    /// What is computed one after the other: what of it is smooth, and what follows from that.
    stages: Vec<Computed>,
    /// Where the last of these leaves its value and time derivatives, as many as there are: two at least.
    roots: Vec<Register>,
    is_length: bool,
}

/// Something that is computed from coordinates, and from what was computed before.
pub struct Computed {
    program: Program,
    registers: Registers,
    /// The operations that what is wanted follows from.
    operations: Vec<Op>,
    /// Where a coordinate, differentiated so many times by time, is to stand.
    inputs: Vec<(Register, u32, usize)>,
    /// Where that is to stand which was left in a register of what was computed before.
    taken: Vec<(Register, Register)>,
}

impl Computed {
    /// By a program over so many coordinates, and perhaps more, which leaves what is wanted in some registers.
    pub(super) fn new(program: Program, registers: Registers, coordinates: usize, requested: &[Register]) -> Computed {
        let mut inputs = Vec::new();
        for (order, first) in program.inputs.coordinates.into_iter().enumerate() {
            inputs.extend((0..coordinates as Register).map(|k| (first + k, k, order)));
        }
        let operations = program.operations_behind(requested, Stage::Measures);
        Computed { program, registers, operations, inputs, taken: Vec::new() }
    }

    /// The same with what was computed before as further coordinates, by where that is left with its time derivatives; none where one is missing.
    pub(super) fn behind(
        mut self,
        before: &[[Option<Register>; 4]],
        (coordinates, requested): (usize, &[Register]),
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

    /// By register: whether its operations read it, or somebody wants it.
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

    /// Leaves out the inputs that nothing reads.
    fn need(&mut self, requested: &[Register]) {
        let is_read = self.is_read(requested);
        self.inputs.retain(|(register, ..)| is_read[*register as usize]);
    }

    /// The program that it is computed by, and the program's registers.
    #[must_use]
    pub fn program(&self) -> (&Program, &Registers) {
        (&self.program, &self.registers)
    }

    /// The operations that follow from parameters alone, and those that follow from coordinates.
    #[must_use]
    pub fn operations(&self) -> [&[Op]; 2] {
        [self.program.stage(Stage::Prologue), &self.operations]
    }

    /// Where a coordinate is to stand, by its number, differentiated so many times by time.
    #[must_use]
    pub fn inputs(&self) -> &[(Register, u32, usize)] {
        &self.inputs
    }

    /// Where that is to stand which was left in a register of what was computed before.
    #[must_use]
    pub fn taken(&self) -> &[(Register, Register)] {
        &self.taken
    }
}

impl SmoothFormula {
    /// Of what is computed one after the other, the last of which leaves a value and its derivatives in some registers.
    pub(super) fn new(mut stages: Vec<Computed>, roots: Vec<Register>, is_length: bool) -> SmoothFormula {
        let count = stages.len();
        for k in 0..count {
            let requested = match stages.get(k + 1) {
                Some(next) => next.taken.iter().map(|&(_, from)| from).collect(),
                None => roots.clone(),
            };
            stages[k].need(&requested);
        }
        SmoothFormula { stages, roots, is_length }
    }

    /// What is computed one after the other.
    #[must_use]
    pub fn stages(&self) -> &[Computed] {
        &self.stages
    }

    /// Where the last of these leaves its value and its time derivatives, as many as there are.
    #[must_use]
    pub fn roots(&self) -> &[Register] {
        &self.roots
    }

    /// Returns whether it is a length, which has a kink where it is zero.
    #[must_use]
    pub fn is_length(&self) -> bool {
        self.is_length
    }
}

/// What a coordinate, by its number, is taken times to see how much a formula makes of rounding, in one of some ways.
#[must_use]
pub fn moved(k: usize, way: u32) -> f64 {
    // up and down without a pattern that a formula could have
    let is_up = (k as u32 + 1).wrapping_mul(0x9E37_79B9 ^ way.wrapping_mul(0x85EB_CA6B)) >> 31 == 0;
    if is_up { 1.0 + MOVED } else { 1.0 - MOVED }
}
