//! What a solver does, one after the other: operations, as a program has them, and what joins these to the world.

use mechc_ir::program::{Column, Few, Op, Register};

/// One instruction, on lanes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs)] // operands and results say themselves
pub enum Instruction {
    /// Registers to registers.
    Compute(Op),
    /// A number, by its bits.
    Number { to: Register, bits: [u32; 2] },
    /// What stands in a register of the program: it depends on parameters alone, or is a switch.
    Load { to: Register, from: Register },
    /// The time (s).
    Time { to: Register },
    /// What has been stored in a column of the row.
    Column { to: Register, column: u32 },
    /// A tear, by its number, on the curve of the step: where Newton begins.
    Curve { to: Register, tear: u32 },
    /// `a b`, a multiplier that is watched, by the number of its weight.
    Multiplier { to: Register, a: Register, b: Register, weight: u32 },
    /// One over a pivot, by the pivot's number; the sign of all pivots of a block tells its branches apart.
    Pivot { a: Register, pivot: u32 },
    /// What is left of a row of `Φ`, which must be next to nothing.
    Residual { a: Register, row: u32 },
    /// A result, by its column.
    Store { column: u32, a: Register },
}

impl Instruction {
    /// A number.
    #[must_use]
    pub fn number(to: Register, value: f64) -> Instruction {
        let bits = value.to_bits();
        Instruction::Number { to, bits: [bits as u32, (bits >> 32) as u32] }
    }

    /// The same with other registers: `read` for those it reads, then `write` for those it writes.
    #[must_use]
    pub fn renumbered(
        mut self,
        mut read: impl FnMut(Register) -> Register,
        mut write: impl FnMut(Register) -> Register,
    ) -> Instruction {
        match &mut self {
            Instruction::Compute(op) => *op = op.renumbered(read, write),
            Instruction::Number { to, .. }
            | Instruction::Load { to, .. }
            | Instruction::Time { to }
            | Instruction::Column { to, .. }
            | Instruction::Curve { to, .. } => *to = write(*to),
            Instruction::Multiplier { to, a, b, .. } => {
                (*a, *b) = (read(*a), read(*b));
                *to = write(*to);
            }
            Instruction::Residual { a, .. } | Instruction::Pivot { a, .. } | Instruction::Store { a, .. } => {
                *a = read(*a);
            }
        }
        self
    }

    /// The column of a table that it looks into.
    #[must_use]
    pub fn column(self) -> Option<(u32, Column)> {
        match self {
            Instruction::Compute(op) => op.column(),
            _ => None,
        }
    }

    /// The registers that it reads.
    #[must_use]
    pub fn reads(self) -> Few<5> {
        let mut reads = Few::default();
        let _ = self.renumbered(|register| reads.note(register), |register| register);
        reads
    }

    /// The registers that it writes.
    #[must_use]
    pub fn writes(self) -> Few<2> {
        let mut writes = Few::default();
        let _ = self.renumbered(|register| register, |register| writes.note(register));
        writes
    }
}

/// The number that bits are of.
#[must_use]
pub fn from_bits([low, high]: [u32; 2]) -> f64 {
    f64::from_bits(u64::from(low) | (u64::from(high) << 32))
}
