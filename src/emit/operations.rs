//! The operations that some outputs of a program need, and the words for the functions among them.

use crate::expr::{Binary, Unary};
use crate::program::{self, Program, Register, STAGES};
use crate::solver::Op;
use rustc_hash::FxHashSet;

/// The operations behind some registers, in the order in which the interpreter runs them; `given` registers are not computed.
/// Each output is left in the column of its number.
pub(super) fn slice(program: &Program, outputs: &[Register], given: &FxHashSet<Register>) -> Vec<Op> {
    let mut is_read = vec![false; program.registers()];
    for &output in outputs {
        is_read[output as usize] = true;
    }
    let mut needed = Vec::new();
    for stage in STAGES.iter().rev() {
        for &op in program.stage(*stage).iter().rev() {
            let (reads, writes) = program.operands(op);
            if writes.iter().any(|register| is_read[*register as usize] && !given.contains(register)) {
                needed.push(plain(op));
                for register in reads {
                    is_read[register as usize] = true;
                }
            }
        }
    }
    needed.reverse();
    needed.extend(outputs.iter().enumerate().map(|(k, &a)| Op::Store { column: k as u32, a }));
    needed
}

/// An operation of a program as one of the solver.
fn plain(op: program::Op) -> Op {
    use program::Op as P;
    match op {
        P::Add { to, a, b } => Op::Add { to, a, b },
        P::Sub { to, a, b } => Op::Sub { to, a, b },
        P::Mul { to, a, b } => Op::Mul { to, a, b },
        P::Div { to, a, b } => Op::Div { to, a, b },
        P::Neg { to, a } => Op::Neg { to, a },
        P::Recip { to, a } => Op::Recip { to, a },
        P::SinCos { sin, cos, a } => Op::SinCos { sin, cos, a },
        _ => Op::Other(op),
    }
}

/// What a function of numbers is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Callee {
    /// The first and the second of the pair.
    Sine,
    Cosine,
    /// A function that goes along.
    Own(&'static str),
    /// A method of numbers.
    Core(&'static str),
    /// A function of the crate `libm`.
    Libm(&'static str),
}

/// What a function of one argument is called.
pub(super) fn callee(function: Unary) -> Callee {
    match function {
        Unary::Sin => Callee::Sine,
        Unary::Cos => Callee::Cosine,
        Unary::Abs => Callee::Core("abs"),
        Unary::Sign => Callee::Own("sign"),
        Unary::Ln => Callee::Libm("log"),
        _ => Callee::Libm(function.word()),
    }
}

/// What a function of two arguments is called.
pub(super) fn callee_of_two(function: Binary) -> Callee {
    match function {
        Binary::Min => Callee::Own("lesser"),
        Binary::Max => Callee::Own("greater"),
        _ => Callee::Libm(function.word()),
    }
}

/// A call with some arguments.
fn call(callee: Callee, arguments: &str) -> String {
    match callee {
        Callee::Sine => format!("sin_cos({arguments}).0"),
        Callee::Cosine => format!("sin_cos({arguments}).1"),
        Callee::Own(name) => format!("{name}({arguments})"),
        Callee::Core(name) => format!("f64::{name}({arguments})"),
        Callee::Libm(name) => format!("libm::{name}({arguments})"),
    }
}

/// A function of one argument as Rust.
pub(super) fn unary(function: Unary, a: &str) -> String {
    call(callee(function), a)
}

/// A function of two arguments as Rust.
pub(super) fn binary(function: Binary, a: &str, b: &str) -> String {
    call(callee_of_two(function), &format!("{a}, {b}"))
}
