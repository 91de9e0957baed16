//! The operations that some outputs of a program need, in order.

use crate::program::{Op, Program, Register, STAGES};

/// The registers that an operation reads and writes.
pub(super) fn operands(op: Op) -> (Vec<Register>, Vec<Register>) {
    match op {
        Op::Neg { to, a } | Op::Recip { to, a } | Op::Not { to, a } | Op::Unary { to, a, .. } => (vec![a], vec![to]),
        Op::SinCos { sin, cos, a } => (vec![a], vec![sin, cos]),
        Op::Add { to, a, b }
        | Op::Sub { to, a, b }
        | Op::Mul { to, a, b }
        | Op::Div { to, a, b }
        | Op::Binary { to, a, b, .. }
        | Op::Compare { to, a, b, .. }
        | Op::And { to, a, b }
        | Op::Or { to, a, b } => (vec![a, b], vec![to]),
        Op::Select { to, condition, a, b } => (vec![condition, a, b], vec![to]),
    }
}

/// The operations behind some registers, in the order in which the interpreter runs them, and the registers that they and
/// the outputs read.
pub(super) fn slice(program: &Program, outputs: &[Register]) -> (Vec<Op>, Vec<bool>) {
    let mut read = vec![false; program.registers()];
    for &output in outputs {
        read[output as usize] = true;
    }
    let mut needed = Vec::new();
    for stage in STAGES.iter().rev() {
        for &op in program.stage(*stage).iter().rev() {
            let (reads, writes) = operands(op);
            if writes.iter().any(|&register| read[register as usize]) {
                needed.push(op);
                for register in reads {
                    read[register as usize] = true;
                }
            }
        }
    }
    needed.reverse();
    (needed, read)
}
