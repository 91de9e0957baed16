//! What follows each other is done in one go where nobody else asks for what is between: a choice, a result to be put away and an operand to be
//! fetched are saved. Each product and each sum is rounded as before, so no bit changes.

use super::{Component, Instruction, Segment};
use mechc_ir::program::{Op, Register};

/// Joins products with what they are multiplied with, added to or taken from; says which instructions are left.
pub(super) fn fuse(component: &mut Component) -> Vec<bool> {
    let uses = uses(component);
    let mut keep = vec![true; component.instructions.len()];
    let mut written_by = vec![usize::MAX; component.registers];
    for segment in &component.segments {
        let range = segment.range();
        for at in range.clone() {
            let only_here = |register: Register| {
                let by = written_by[register as usize];
                match component.instructions.get(by) {
                    Some(&Instruction::Compute(op)) if uses[register as usize] == 1 && range.contains(&by) => {
                        Some((by, op))
                    }
                    _ => None,
                }
            };
            if let Instruction::Compute(op) = component.instructions[at]
                && let Some((op, by)) = fused(op, only_here)
            {
                component.instructions[at] = Instruction::Compute(op);
                keep[by] = false;
            }
            for register in component.instructions[at].writes() {
                written_by[register as usize] = at;
            }
        }
    }
    keep
}

/// By register: how many ask for what it holds.
fn uses(component: &Component) -> Vec<u32> {
    let mut uses = vec![0; component.registers];
    let of_tears = component.segments.iter().flat_map(Segment::tears).flat_map(|tear| [tear.x, tear.delta]);
    let of_instructions = component.instructions.iter().flat_map(|instruction| instruction.reads());
    for register in of_instructions.chain(of_tears) {
        uses[register as usize] += 1;
    }
    uses
}

/// An operation with one that leads to it, and where that was: `only_here` tells what leads to nothing else.
fn fused(op: Op, only_here: impl Fn(Register) -> Option<(usize, Op)>) -> Option<(Op, usize)> {
    let product = |register| match only_here(register)? {
        (by, Op::Mul { a, b, .. }) => Some((by, [a, b])),
        _ => None,
    };
    match op {
        Op::MulAdd { to, a, b, c } => {
            let (by, [c, d]) = product(c)?;
            Some((Op::SumOfProducts { to, a, b, c, d }, by))
        }
        Op::MulLess { to, a, b, c } => {
            let (by, [c, d]) = product(c)?;
            Some((Op::DifferenceOfProducts { to, a, b, c, d }, by))
        }
        Op::LessMul { to, a: c, b: d, c: less } => {
            let (by, [a, b]) = product(less)?;
            Some((Op::DifferenceOfProducts { to, a, b, c, d }, by))
        }
        Op::Mul { to, a, b } => times(to, only_here(a), b).or_else(|| times(to, only_here(b), a)),
        _ => None,
    }
}

/// What is found in one place, times what stands in a register.
fn times(to: Register, found: Option<(usize, Op)>, by: Register) -> Option<(Op, usize)> {
    let (at, factor) = found?;
    let product = match factor {
        Op::Mul { a, b, .. } => Op::ProductOfThree { to, a, b, c: by },
        Op::SumOfProducts { a, b, c, d, .. } => Op::SumOfProductsTimes { to, a, b, c, d, e: by },
        Op::DifferenceOfProducts { a, b, c, d, .. } => Op::DifferenceOfProductsTimes { to, a, b, c, d, e: by },
        _ => return None,
    };
    Some((product, at))
}
