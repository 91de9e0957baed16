//! From expressions to straight-line operations, and their evaluation.
//!
//! A program is one file of registers and a list of operations per [`Stage`]. Registers live through all stages, so
//! that what the position needed is not computed again for the acceleration. Common subexpressions are computed once
//! (the graph has them once), sine and cosine of an angle together.
//!
//! What depends on parameters alone is computed once, in the prologue; what depends on time alone, once per time and
//! not once per iteration.

mod compile;
mod evaluate;

pub use evaluate::Registers;

use crate::expr::{Binary, Comparison, Unary};

/// A place for one number.
pub type Register = u32;

/// When operations are run.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Stage {
    /// Once: what depends on parameters alone, the estimates too.
    Prologue,
    /// Once per time: what depends on time alone.
    Time,
    /// Once per iteration: `Φ`, `Φ_q`, the conditions.
    Position,
    /// `ν`.
    Velocity,
    /// `γ`; needs `q̇`.
    Acceleration,
    /// The right side of the jerk equation; needs `q̈`.
    Jerk,
    /// The measures; needs all derivatives of `q`.
    Measures,
}

/// All stages, in the order in which they may be run.
pub const STAGES: [Stage; 7] =
    [Stage::Prologue, Stage::Time, Stage::Position, Stage::Velocity, Stage::Acceleration, Stage::Jerk, Stage::Measures];

/// One operation: reads registers, writes `to`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs)] // operands and results say themselves
pub enum Op {
    Add {
        to: Register,
        a: Register,
        b: Register,
    },
    Sub {
        to: Register,
        a: Register,
        b: Register,
    },
    Mul {
        to: Register,
        a: Register,
        b: Register,
    },
    Div {
        to: Register,
        a: Register,
        b: Register,
    },
    Neg {
        to: Register,
        a: Register,
    },
    /// `1 / a`
    Recip {
        to: Register,
        a: Register,
    },
    SinCos {
        sin: Register,
        cos: Register,
        a: Register,
    },
    Unary {
        function: Unary,
        to: Register,
        a: Register,
    },
    Binary {
        function: Binary,
        to: Register,
        a: Register,
        b: Register,
    },
    Compare {
        comparison: Comparison,
        to: Register,
        a: Register,
        b: Register,
    },
    And {
        to: Register,
        a: Register,
        b: Register,
    },
    Or {
        to: Register,
        a: Register,
        b: Register,
    },
    Not {
        to: Register,
        a: Register,
    },
    Select {
        to: Register,
        condition: Register,
        a: Register,
        b: Register,
    },
}

/// Where a program finds its inputs; each is a run of registers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Inputs {
    /// First parameter.
    pub params: Register,
    /// Time (s).
    pub time: Register,
    /// First of `q`, `q̇`, `q̈`, `q⃛`.
    pub coordinates: [Register; 4],
    /// Number of coordinates.
    pub n: u32,
}

/// Where a program leaves its results.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Outputs {
    /// Where assembly starts, `n`.
    pub estimates: Vec<Register>,
    /// `Φ`, `n`.
    pub phi: Vec<Register>,
    /// `Φ_q`, in the order of its pattern's entries.
    pub phi_q: Vec<Register>,
    /// `ν`, `n`.
    pub nu: Vec<Register>,
    /// `γ`, `n`.
    pub gamma: Vec<Register>,
    /// Right side of the jerk equation, `n`, or none.
    pub jerk: Vec<Register>,
    /// Measures' values.
    pub measures: Vec<Register>,
    /// Measures' first derivatives, where they have one.
    pub measures_d: Vec<Register>,
    /// Measures' second derivatives, where they have one.
    pub measures_dd: Vec<Register>,
    /// Formulas that must be positive.
    pub conditions: Vec<Register>,
    /// For each row, the terms of its sum, against whose size its rounding is judged.
    pub terms: Vec<Vec<Register>>,
}

/// Operations that evaluate a constraint system.
#[derive(Clone, Debug)]
pub struct Program {
    operations: Vec<Vec<Op>>,
    constants: Vec<(Register, f64)>,
    registers: usize,
    /// Where the inputs go.
    pub inputs: Inputs,
    /// Where the results are.
    pub outputs: Outputs,
}

impl Program {
    /// The operations of a stage.
    #[must_use]
    pub fn stage(&self, stage: Stage) -> &[Op] {
        &self.operations[stage as usize]
    }

    /// The numbers that stand in registers from the start.
    #[must_use]
    pub fn constants(&self) -> &[(Register, f64)] {
        &self.constants
    }

    /// How many registers it needs.
    #[must_use]
    pub fn registers(&self) -> usize {
        self.registers
    }
}
