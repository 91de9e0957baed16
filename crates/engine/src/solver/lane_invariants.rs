//! Lane invariants: columns that are equal in all lanes of a batch of variants.

use super::{Instruction, Solver};
use mechc_ir::program::Register;

impl Solver {
    /// Returns by column whether it is equal for all variants at a time, if the program's registers for which `varies` holds differ between variants.
    /// Tears and what is looked up in tables count as different.
    #[must_use]
    pub(crate) fn lane_invariant_columns(&self, varies: impl Fn(Register) -> bool) -> Vec<bool> {
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
                | Instruction::Monitor { .. }
                | Instruction::Residual { .. } => {}
            }
            for &register in instruction.writes().iter() {
                registers[register as usize] = is_invariant;
            }
        }
        columns
    }
}
