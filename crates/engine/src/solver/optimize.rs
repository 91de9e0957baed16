//! Optimizes the instructions of a component: dead-code elimination, fused products and sums, hoisting of the prologue, register allocation.

use super::peephole::fuse_products;
use super::{Component, Instruction, PROLOGUE, Purpose, Segment};
use mechc_ir::program::{Op, Register};
use std::ops::Range;

/// No register, instruction or loop.
const NONE: u32 = u32::MAX;

/// Optimizes a component in single-assignment form: keeps the instructions for which `is_result` holds and those that they depend on, and allocates
/// registers unless the purpose is code.
pub(super) fn optimize(
    mut component: Component,
    is_result: impl Fn(&Instruction) -> bool,
    purpose: Purpose,
) -> Component {
    let is_live = live_instructions(&component, is_result);
    let is_fused = fuse_multiply_adds(&mut component, &is_live);
    let keep: Vec<bool> = is_live.iter().zip(&is_fused).map(|(live, fused)| *live && !fused).collect();
    let mut component = compact(component, &keep);
    match purpose {
        Purpose::Code => {}
        Purpose::Lanes => {
            component = with_peephole(component);
            let unallocated = vec![NONE; component.registers];
            allocate_registers(&mut component, unallocated);
        }
        Purpose::Variants => {
            let (rest, allocated) = hoist_prologue(component);
            component = rest;
            allocate_registers(&mut component, allocated);
        }
    }
    component
}

/// Applies the peephole pass.
fn with_peephole(mut component: Component) -> Component {
    let keep = fuse_products(&mut component);
    compact(component, &keep)
}

/// Hoists the instructions that depend on numbers and parameters alone into the prologue, which runs once for these; the peephole pass treats the
/// others alone, so that no fusion crosses. Returns the registers of the prologue, with [`NONE`] for all others.
fn hoist_prologue(component: Component) -> (Component, Vec<Register>) {
    let mut allocated = vec![NONE; component.registers];
    let (mut prologue, mut count) = (Vec::new(), 0);
    let mut keep = vec![true; component.instructions.len()];
    for at in component.segments.iter().filter(|segment| !segment.is_loop()).flat_map(Segment::range) {
        let instruction = component.instructions[at];
        let is_prologue = match instruction {
            Instruction::Number { .. } | Instruction::Load { .. } => true,
            Instruction::Compute(_) | Instruction::Store { .. } => {
                instruction.reads().iter().all(|&register| allocated[register as usize] != NONE)
            }
            _ => false,
        };
        if is_prologue {
            keep[at] = false;
            for &register in instruction.writes().iter() {
                allocated[register as usize] = PROLOGUE | count;
                count += 1;
            }
            prologue.push(
                instruction
                    .renumbered(|register| allocated[register as usize], |register| allocated[register as usize]),
            );
        }
    }
    let rest = with_peephole(compact(component, &keep));
    (Component { prologue, prologue_registers: count as usize, ..rest }, allocated)
}

/// Returns the instructions that are results, or that a result depends on.
fn live_instructions(component: &Component, is_result: impl Fn(&Instruction) -> bool) -> Vec<bool> {
    let mut is_read = vec![false; component.registers];
    for tear in component.segments.iter().flat_map(Segment::tears) {
        (is_read[tear.x as usize], is_read[tear.delta as usize]) = (true, true);
    }
    let mut is_live = vec![false; component.instructions.len()];
    // one backward pass is enough, since a loop reads only values written earlier in the same iteration
    for (at, instruction) in component.instructions.iter().enumerate().rev() {
        let writes = instruction.writes();
        is_live[at] = is_result(instruction) || writes.iter().any(|&register| is_read[register as usize]);
        if is_live[at] {
            for register in instruction.reads() {
                is_read[register as usize] = true;
            }
        }
    }
    is_live
}

/// Fuses products that are used once with the sum that uses them; returns which products are gone.
fn fuse_multiply_adds(component: &mut Component, is_live: &[bool]) -> Vec<bool> {
    let instructions = &mut component.instructions;
    let (mut uses, mut written_by) = (vec![0_u32; component.registers], vec![NONE; component.registers]);
    for (at, instruction) in instructions.iter().enumerate().filter(|(at, _)| is_live[*at]) {
        instruction.reads().iter().for_each(|&register| uses[register as usize] += 1);
        instruction.writes().iter().for_each(|&register| written_by[register as usize] = at as u32);
    }
    let mut is_fused = vec![false; instructions.len()];
    for segment in &component.segments {
        let range = segment.range();
        for tear in segment.tears() {
            uses[tear.delta as usize] += 1;
        }
        for at in range.clone().filter(|at| is_live[*at]) {
            let product = |register: Register| {
                let by = written_by[register as usize] as usize;
                match (uses[register as usize], instructions.get(by)) {
                    (1, Some(&Instruction::Compute(Op::Mul { a, b, .. }))) if range.contains(&by) => Some((by, [a, b])),
                    _ => None,
                }
            };
            if let Instruction::Compute(op) = instructions[at]
                && let Some((by, op)) = multiply_add(op, product)
            {
                instructions[at] = Instruction::Compute(op);
                is_fused[by] = true;
            }
        }
    }
    is_fused
}

/// Returns a sum or difference fused with the product of one operand, and the index of that product.
fn multiply_add(op: Op, product: impl Fn(Register) -> Option<(usize, [Register; 2])>) -> Option<(usize, Op)> {
    match op {
        Op::Add { to, a, b } => {
            let (by, [x, y], c) = match product(b) {
                Some((by, factors)) => (by, factors, a),
                None => product(a).map(|(by, factors)| (by, factors, b))?,
            };
            Some((by, Op::MulAdd { to, a: x, b: y, c }))
        }
        Op::Sub { to, a, b } => match product(b) {
            Some((by, [x, y])) => Some((by, Op::LessMul { to, a: x, b: y, c: a })),
            None => product(a).map(|(by, [x, y])| (by, Op::MulLess { to, a: x, b: y, c: b })),
        },
        _ => None,
    }
}

/// Removes the instructions that are not kept.
fn compact(component: Component, keep: &[bool]) -> Component {
    let Component { instructions, segments, registers, .. } = component;
    let mut component = Component { registers, ..Component::default() };
    for segment in segments {
        let from = component.instructions.len();
        component.instructions.extend(segment.range().filter(|&at| keep[at]).map(|at| instructions[at]));
        let range = from..component.instructions.len();
        match segment {
            Segment::Newton { tears, .. } => component.segments.push(Segment::Newton { instructions: range, tears }),
            Segment::Once(_) if range.is_empty() => {}
            Segment::Once(_) => component.segments.push(Segment::Once(range)),
        }
    }
    component
}

/// Allocates registers by live range. Registers of the prologue, which are allocated already, are not shared.
fn allocate_registers(component: &mut Component, mut allocated: Vec<Register>) {
    let registers = component.registers;
    let LiveRanges { last_use, last_loop } = LiveRanges::new(component);
    let is_prologue: Vec<bool> = allocated.iter().map(|&register| register != NONE).collect();
    let (mut free, mut next): (Vec<Register>, Register) = (Vec::new(), 0);
    // by loop: registers that are live to its end
    let mut ends: Vec<Vec<Register>> = Vec::new();
    let loops: Vec<Range<usize>> = component
        .segments
        .iter()
        .filter(|segment| segment.is_loop())
        .map(Segment::range)
        .inspect(|_| ends.push(Vec::new()))
        .collect();
    for register in 0..registers {
        if !is_prologue[register]
            && last_loop[register] != NONE
            && last_use[register] < loops[last_loop[register] as usize].end as u32
        {
            ends[last_loop[register] as usize].push(register as Register);
        }
    }
    let mut open = loops.iter().zip(ends).peekable();
    for at in 0..=component.instructions.len() {
        while let Some((_, ended)) = open.next_if(|(range, _)| range.end == at) {
            free.extend(
                ended.into_iter().map(|register| allocated[register as usize]).filter(|&register| register != NONE),
            );
        }
        let Some(instruction) = component.instructions.get(at).copied() else {
            break;
        };
        let reads = instruction.reads();
        let dies = |register: Register| {
            let k = register as usize;
            let in_loop = last_loop[k] != NONE && last_use[k] < loops[last_loop[k] as usize].end as u32;
            last_use[k] == at as u32 && !in_loop && !is_prologue[k]
        };
        for (k, &register) in reads.iter().enumerate() {
            if dies(register) && !reads[..k].contains(&register) {
                free.push(allocated[register as usize]);
            }
        }
        for register in instruction.writes() {
            allocated[register as usize] = free.pop().unwrap_or_else(|| {
                next += 1;
                next - 1
            });
        }
        component.instructions[at] =
            instruction.renumbered(|register| allocated[register as usize], |register| allocated[register as usize]);
        for register in instruction.writes() {
            // an unused result
            if last_use[register as usize] == NONE {
                free.push(allocated[register as usize]);
            }
        }
    }
    let segments = std::mem::take(&mut component.segments).into_iter();
    component.segments = segments.map(|segment| segment.renumbered(|register| allocated[register as usize])).collect();
    component.registers = next as usize;
}

/// The live ranges of registers.
struct LiveRanges {
    /// By register: the last instruction that reads it, or [`NONE`].
    last_use: Vec<u32>,
    /// By register: the last loop through whose end it is live, or [`NONE`].
    last_loop: Vec<u32>,
}

impl LiveRanges {
    fn new(component: &Component) -> LiveRanges {
        let registers = component.registers;
        let mut written_at = vec![0_u32; registers];
        let mut ranges = LiveRanges { last_use: vec![NONE; registers], last_loop: vec![NONE; registers] };
        let mut number = 0;
        for segment in &component.segments {
            let range = segment.range();
            for at in range.clone() {
                for register in component.instructions[at].reads() {
                    ranges.last_use[register as usize] = at as u32;
                    if segment.is_loop() && (written_at[register as usize] as usize) < range.start {
                        ranges.last_loop[register as usize] = number;
                    }
                }
                for register in component.instructions[at].writes() {
                    written_at[register as usize] = at as u32;
                }
            }
            if let Segment::Newton { tears, .. } = segment {
                for register in tears.iter().flat_map(|tear| [tear.x, tear.delta]) {
                    ranges.last_loop[register as usize] = number;
                    if ranges.last_use[register as usize] == NONE {
                        ranges.last_use[register as usize] = range.start as u32;
                    }
                }
                number += 1;
            }
        }
        ranges
    }
}
