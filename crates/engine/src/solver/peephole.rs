//! Peephole pass: fuses an operation with the one that computes its operand, if that has no other use. This saves dispatch, a store and a load. Each
//! product and each sum is rounded as before, so no bit changes.

use super::{Component, Instruction, Segment};
use mechc_ir::program::{Op, Register};

/// Fuses products with the factors, sums and differences around them; returns which instructions are left.
pub(super) fn fuse_products(component: &mut Component) -> Vec<bool> {
    let use_counts = use_counts(component);
    let mut keep = vec![true; component.instructions.len()];
    let mut written_by = vec![usize::MAX; component.registers];
    for segment in &component.segments {
        let range = segment.range();
        for at in range.clone() {
            let single_use = |register: Register| {
                let by = written_by[register as usize];
                match component.instructions.get(by) {
                    Some(&Instruction::Compute(op)) if use_counts[register as usize] == 1 && range.contains(&by) => {
                        Some((by, op))
                    }
                    _ => None,
                }
            };
            if let Instruction::Compute(op) = component.instructions[at]
                && let Some((op, by)) = fused_op(op, single_use)
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

/// Returns by register the number of instructions and tears that read it.
fn use_counts(component: &Component) -> Vec<u32> {
    let mut use_counts = vec![0; component.registers];
    let of_tears = component.segments.iter().flat_map(Segment::tears).flat_map(|tear| [tear.x, tear.delta]);
    let of_instructions = component.instructions.iter().flat_map(|instruction| instruction.reads());
    for register in of_instructions.chain(of_tears) {
        use_counts[register as usize] += 1;
    }
    use_counts
}

/// Returns an operation fused with one that computes an operand, and the index of the latter. `single_use` returns the instruction that computes a
/// register without another use.
fn fused_op(op: Op, single_use: impl Fn(Register) -> Option<(usize, Op)>) -> Option<(Op, usize)> {
    let product = |register| match single_use(register)? {
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
        Op::Mul { to, a, b } => product_with(to, single_use(a), b).or_else(|| product_with(to, single_use(b), a)),
        _ => None,
    }
}

/// Returns the product of an operation's result and a register as one operation, and the index of the former.
fn product_with(to: Register, factor: Option<(usize, Op)>, by: Register) -> Option<(Op, usize)> {
    let (at, factor) = factor?;
    let product = match factor {
        Op::Mul { a, b, .. } => Op::ProductOfThree { to, a, b, c: by },
        Op::SumOfProducts { a, b, c, d, .. } => Op::SumOfProductsTimes { to, a, b, c, d, e: by },
        Op::DifferenceOfProducts { a, b, c, d, .. } => Op::DifferenceOfProductsTimes { to, a, b, c, d, e: by },
        _ => return None,
    };
    Some((product, at))
}
