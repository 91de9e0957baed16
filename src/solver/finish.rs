//! What nothing needs is left out, products are joined with their sums, and registers are used again.

use super::tape::Op;
use super::{Component, Segment};
use crate::program::Register;
use std::ops::Range;

const NONE: u32 = u32::MAX;

/// A component from its operations and segments, with `registers` registers, each written once; and how many registers are left,
/// which may be used several times if they are shared.
pub(super) fn finish(
    mut operations: Vec<Op>,
    segments: Vec<Segment>,
    registers: usize,
    are_shared: bool,
) -> (Component, usize) {
    let is_needed = needed(&operations, &segments, registers);
    let is_joined = join(&mut operations, &segments, &is_needed, registers);
    let keep: Vec<bool> = is_needed.iter().zip(&is_joined).map(|(needed, joined)| *needed && !joined).collect();
    let mut component = compact(&operations, segments, &keep);
    let registers = if are_shared { share_registers(&mut component, registers) } else { registers };
    (component, registers)
}

fn range_of(segment: &Segment) -> Range<usize> {
    match segment {
        Segment::Once(range) | Segment::Newton { operations: range, .. } => range.clone(),
    }
}

/// Which operations lead to a result.
fn needed(operations: &[Op], segments: &[Segment], registers: usize) -> Vec<bool> {
    let mut is_read = vec![false; registers];
    for segment in segments {
        if let Segment::Newton { tears, .. } = segment {
            for tear in tears {
                (is_read[tear.x as usize], is_read[tear.delta as usize]) = (true, true);
            }
        }
    }
    let mut is_needed = vec![false; operations.len()];
    // what a loop reads of itself it has written before, in the same iteration
    for (at, op) in operations.iter().enumerate().rev() {
        let (writes, count) = op.writes();
        is_needed[at] = count == 0 || writes[..count].iter().any(|&register| is_read[register as usize]);
        if is_needed[at] {
            let (reads, count) = op.reads();
            for &register in &reads[..count] {
                is_read[register as usize] = true;
            }
        }
    }
    is_needed
}

/// Joins products that only one sum uses with that sum; says which products are in it now.
fn join(operations: &mut [Op], segments: &[Segment], is_needed: &[bool], registers: usize) -> Vec<bool> {
    let (mut uses, mut written_by) = (vec![0_u32; registers], vec![NONE; registers]);
    for (at, op) in operations.iter().enumerate().filter(|(at, _)| is_needed[*at]) {
        let (reads, count) = op.reads();
        reads[..count].iter().for_each(|&register| uses[register as usize] += 1);
        let (writes, count) = op.writes();
        writes[..count].iter().for_each(|&register| written_by[register as usize] = at as u32);
    }
    let mut is_joined = vec![false; operations.len()];
    for segment in segments {
        let range = range_of(segment);
        if let Segment::Newton { tears, .. } = segment {
            for tear in tears {
                uses[tear.delta as usize] += 1;
            }
        }
        for at in range.clone() {
            let product = |register: Register| {
                let by = written_by[register as usize] as usize;
                match (uses[register as usize], operations.get(by)) {
                    (1, Some(&Op::Mul { a, b, .. })) if range.contains(&by) => Some((by, a, b)),
                    _ => None,
                }
            };
            let joined = match operations[at] {
                Op::Add { to, a, b } => match (product(a), product(b)) {
                    (_, Some((by, x, y))) => Some((by, Op::MulAdd { to, a: x, b: y, c: a })),
                    (Some((by, x, y)), None) => Some((by, Op::MulAdd { to, a: x, b: y, c: b })),
                    (None, None) => None,
                },
                Op::Sub { to, a, b } => match (product(a), product(b)) {
                    (_, Some((by, x, y))) => Some((by, Op::LessMul { to, a: x, b: y, c: a })),
                    (Some((by, x, y)), None) => Some((by, Op::MulLess { to, a: x, b: y, c: b })),
                    (None, None) => None,
                },
                _ => None,
            };
            if let Some((by, op)) = joined.filter(|_| is_needed[at]) {
                operations[at] = op;
                is_joined[by] = true;
            }
        }
    }
    is_joined
}

fn compact(operations: &[Op], segments: Vec<Segment>, keep: &[bool]) -> Component {
    let mut component = Component::default();
    for segment in segments {
        let from = component.operations.len();
        let kept = range_of(&segment).filter(|&at| keep[at]).map(|at| operations[at]);
        component.operations.extend(kept);
        let range = from..component.operations.len();
        match segment {
            Segment::Newton { tears, .. } => component.segments.push(Segment::Newton { operations: range, tears }),
            Segment::Once(_) if range.is_empty() => {}
            Segment::Once(_) => component.segments.push(Segment::Once(range)),
        }
    }
    component
}

/// Gives registers out anew, each to several values one after the other; says how many there are.
fn share_registers(component: &mut Component, registers: usize) -> usize {
    let Life { last_use, outlives } = Life::new(component, registers);
    let mut place = vec![NONE; registers];
    let (mut free, mut next): (Vec<Register>, Register) = (Vec::new(), 0);
    // those that live to the end of a loop, by where it ends
    let mut ends: Vec<Vec<Register>> = Vec::new();
    let loops: Vec<Range<usize>> = component
        .segments
        .iter()
        .filter(|segment| matches!(segment, Segment::Newton { .. }))
        .map(range_of)
        .inspect(|_| ends.push(Vec::new()))
        .collect();
    for register in 0..registers {
        if outlives[register] != NONE && last_use[register] < loops[outlives[register] as usize].end as u32 {
            ends[outlives[register] as usize].push(register as Register);
        }
    }
    let mut open = loops.iter().zip(ends).peekable();
    for at in 0..=component.operations.len() {
        while let Some((_, ended)) = open.next_if(|(range, _)| range.end == at) {
            free.extend(ended.into_iter().map(|register| place[register as usize]).filter(|&place| place != NONE));
        }
        let Some(op) = component.operations.get(at).copied() else {
            break;
        };
        let (reads, count) = op.reads();
        let dies = |register: Register| {
            let k = register as usize;
            let in_loop = outlives[k] != NONE && last_use[k] < loops[outlives[k] as usize].end as u32;
            last_use[k] == at as u32 && !in_loop
        };
        for (k, &register) in reads[..count].iter().enumerate() {
            if dies(register) && !reads[..k].contains(&register) {
                free.push(place[register as usize]);
            }
        }
        let (writes, count) = op.writes();
        for &register in &writes[..count] {
            place[register as usize] = free.pop().unwrap_or_else(|| {
                next += 1;
                next - 1
            });
        }
        component.operations[at] =
            op.renumbered(|register| place[register as usize], |register| place[register as usize]);
        for &register in &writes[..count] {
            // nobody reads it
            if last_use[register as usize] == NONE {
                free.push(place[register as usize]);
            }
        }
    }
    for segment in &mut component.segments {
        if let Segment::Newton { tears, .. } = segment {
            for tear in tears {
                (tear.x, tear.delta) = (place[tear.x as usize], place[tear.delta as usize]);
            }
        }
    }
    next as usize
}

/// How long registers are needed.
struct Life {
    /// The last operation that reads each; none if none does.
    last_use: Vec<u32>,
    /// The last loop to whose end each is needed, be it that no operation reads it so late.
    outlives: Vec<u32>,
}

impl Life {
    fn new(component: &Component, registers: usize) -> Life {
        let mut written_at = vec![0_u32; registers];
        let mut life = Life { last_use: vec![NONE; registers], outlives: vec![NONE; registers] };
        let mut number = 0;
        for segment in &component.segments {
            let range = range_of(segment);
            let is_loop = matches!(segment, Segment::Newton { .. });
            for at in range.clone() {
                let (reads, count) = component.operations[at].reads();
                for &register in &reads[..count] {
                    life.last_use[register as usize] = at as u32;
                    if is_loop && (written_at[register as usize] as usize) < range.start {
                        life.outlives[register as usize] = number;
                    }
                }
                let (writes, count) = component.operations[at].writes();
                for &register in &writes[..count] {
                    written_at[register as usize] = at as u32;
                }
            }
            if let Segment::Newton { tears, .. } = segment {
                for register in tears.iter().flat_map(|tear| [tear.x, tear.delta]) {
                    life.outlives[register as usize] = number;
                    if life.last_use[register as usize] == NONE {
                        life.last_use[register as usize] = range.start as u32;
                    }
                }
                number += 1;
            }
        }
        life
    }
}
