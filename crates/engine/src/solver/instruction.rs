//! Instructions of a solver: the operations of a program, with inputs, outputs and checks.

use mechc_ir::program::{Column, Op, Register, RegisterList};

/// An instruction, executed in every lane.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs)] // operands and results explain themselves
pub enum Instruction {
    /// An operation on registers.
    Compute(Op),
    /// A number, by its bits.
    Number { to: Register, bits: [u32; 2] },
    /// A register of the program that depends on parameters alone or is a switch.
    Load { to: Register, from: Register },
    /// The time (s).
    Time { to: Register },
    /// The stored value of a column of the row.
    Column { to: Register, column: u32 },
    /// The initial guess for a tear, given by its number.
    Curve { to: Register, tear: u32 },
    /// The product `a b`, an elimination multiplier that is checked with the weight of this number.
    Multiplier { to: Register, a: Register, b: Register, weight: u32 },
    /// The inverse of a pivot, given by its number. The sign of the product of a block's pivots distinguishes its branches.
    Pivot { a: Register, pivot: u32 },
    /// A monitor, given by its number, whose sign distinguishes branches; only in lanes of variants.
    Monitor { a: Register, monitor: u32 },
    /// The residual of a row of `Φ`, which is checked.
    Residual { a: Register, row: u32 },
    /// Stores a result in a column.
    Store { column: u32, a: Register },
}

impl Instruction {
    /// Creates an instruction for a number.
    #[must_use]
    pub fn number(to: Register, value: f64) -> Instruction {
        let bits = value.to_bits();
        Instruction::Number { to, bits: [bits as u32, (bits >> 32) as u32] }
    }

    /// Replaces the registers: first those that are read, by `read`, then those that are written, by `write`.
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
            Instruction::Residual { a, .. }
            | Instruction::Pivot { a, .. }
            | Instruction::Monitor { a, .. }
            | Instruction::Store { a, .. } => *a = read(*a),
        }
        self
    }

    /// Returns the table and column that the instruction looks up, if any.
    #[must_use]
    pub fn column(self) -> Option<(u32, Column)> {
        match self {
            Instruction::Compute(op) => op.column(),
            _ => None,
        }
    }

    /// Returns the registers that the instruction reads.
    #[must_use]
    pub fn reads(self) -> RegisterList<5> {
        let mut reads = RegisterList::default();
        let _ = self.renumbered(|register| reads.note(register), |register| register);
        reads
    }

    /// Returns the registers that the instruction writes.
    #[must_use]
    pub fn writes(self) -> RegisterList<2> {
        let mut writes = RegisterList::default();
        let _ = self.renumbered(|register| register, |register| writes.note(register));
        writes
    }
}

/// Returns the number with these bits.
#[must_use]
pub fn from_bits([low, high]: [u32; 2]) -> f64 {
    f64::from_bits(u64::from(low) | (u64::from(high) << 32))
}
