//! The operations that some outputs of a program need, in order.

use crate::program::{Op, Program, Register, STAGES};

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
            let (reads, writes) = program.operands(op);
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
