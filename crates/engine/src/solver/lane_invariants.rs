//! What is alike in all variants that go side by side: what numbers, time and parameters lead to that are the same for all of them.

use super::{Instruction, Solver};
use mechc_ir::program::Register;

impl Solver {
    /// By column: whether it is the same for all variants at a time, where some of the program's registers may differ between them. What Newton
    /// solves for may, and what a table leads to.
    #[must_use]
    pub fn lane_invariant_columns(&self, varies: impl Fn(Register) -> bool) -> Vec<bool> {
        let (mut registers, mut columns) = (vec![false; self.registers], vec![false; self.layout.stride]);
        for instruction in &self.instructions {
            let mut is_invariant = instruction.reads().iter().all(|&register| registers[register as usize]);
            match *instruction {
                Instruction::Load { from, .. } => is_invariant = !varies(from),
                Instruction::Column { column, .. } => is_invariant = columns[column as usize],
                Instruction::Curve { .. } => is_invariant = false,
                Instruction::Compute(op) => is_invariant &= op.column().is_none(),
                Instruction::Store { column, .. } => columns[column as usize] = is_invariant,
                Instruction::Number { .. }
                | Instruction::Time { .. }
                | Instruction::Multiplier { .. }
                | Instruction::Pivot { .. }
                | Instruction::Residual { .. } => {}
            }
            for &register in instruction.writes().iter() {
                registers[register as usize] = is_invariant;
            }
        }
        columns
    }
}
