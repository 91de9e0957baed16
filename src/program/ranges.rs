//! Ranges of formulas over a stretch of the motion: a program's operations, run on intervals.
//!
//! Unlike an [`Enclosure`](super::Enclosure), which proves that no switch changes, a range is one of all branches that may count: it
//! holds every value, and tells whether there may be jumps among them.

use super::enclose::{Interval, behind, enclose};
use super::{Op, Program, Register, Registers, Stage};
use crate::expr::{Binary, Unary};
use crate::tolerances::results::ranges::{WIDEST, WIDEST_RATIO, WIDEST_VALUE};

/// What a formula is enclosed in.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Range {
    /// No value is below.
    pub low: f64,
    /// No value is above.
    pub high: f64,
    /// Whether the formula may change its branch, so that it or what is derived from it may jump.
    pub may_switch: bool,
    /// Whether every function in it changes so little that a few terms of its series tell all.
    pub is_resolved: bool,
    /// Whether a table in it may go on from one piece to the next.
    pub crosses_knots: bool,
}

/// As in [`Range`].
#[derive(Clone, Copy, Debug)]
struct Found {
    may_switch: bool,
    is_resolved: bool,
    crosses_knots: bool,
}

const NOTHING: Found = Found { may_switch: false, is_resolved: true, crosses_knots: false };

/// Room for the ranges of some formulas, each of which may use what those before it have.
#[derive(Clone, Debug)]
pub struct Ranges {
    /// By formula: the operations that those before it have not run.
    operations: Vec<Vec<Op>>,
    /// What each formula has found out beside its values.
    found: Vec<Found>,
    roots: Vec<Register>,
    /// Whether switches stay as the registers have them.
    is_frozen: bool,
    values: Vec<Interval>,
    time: Register,
}

impl Ranges {
    /// For formulas that a stage leaves in some registers; the prologue must have been run.
    #[must_use]
    pub fn new(program: &Program, registers: &Registers, roots: &[Register], stage: Stage, is_frozen: bool) -> Ranges {
        let mut is_known = vec![false; program.registers()];
        let mut operations = Vec::new();
        for k in 0..roots.len() {
            let mut own = behind(program, &roots[..=k], &[stage]);
            own.retain(|&op| {
                let is_new = op.writes().iter().any(|&register| !is_known[register as usize]);
                op.writes().iter().for_each(|&register| is_known[register as usize] = true);
                is_new
            });
            operations.push(own);
        }
        let point = |value: f64| Interval { low: value, high: value };
        Ranges {
            operations,
            found: vec![NOTHING; roots.len()],
            roots: roots.to_vec(),
            is_frozen,
            values: (0..program.registers()).map(|k| point(registers.get(k as u32))).collect(),
            time: program.inputs.time,
        }
    }

    /// Lets time be anywhere between two times (s).
    pub fn set_times(&mut self, [from, to]: [f64; 2]) {
        self.values[self.time as usize] = Interval { low: from, high: to };
    }

    /// Lets an input be anywhere between two values.
    pub fn set(&mut self, register: Register, [low, high]: [f64; 2]) {
        self.values[register as usize] = Interval { low, high };
    }

    /// The range of a formula; those before it must have been asked for since time and coordinates were set.
    pub fn range(&mut self, program: &Program, registers: &Registers, k: usize) -> Range {
        let before = if k == 0 { NOTHING } else { self.found[k - 1] };
        let Found { mut may_switch, mut is_resolved, mut crosses_knots } = before;
        for at in 0..self.operations[k].len() {
            let op = self.operations[k][at];
            is_resolved &= is_resolved_in(op, &self.values);
            enclose(program, op, &mut self.values);
            if let Some(to) = op.switched() {
                let value = &mut self.values[to as usize];
                if self.is_frozen {
                    let frozen = registers.get(to);
                    *value = Interval { low: frozen, high: frozen };
                    continue;
                }
                let changes = value.low.total_cmp(&value.high).is_ne();
                // a spline goes on over its knots
                let is_piece = matches!(op, Op::Piece { .. });
                may_switch |= changes && !is_piece;
                crosses_knots |= changes && is_piece;
            }
            if let Some(to) = bounded(op) {
                let value = self.values[to as usize];
                is_resolved &= value.high - value.low <= WIDEST_VALUE;
            }
        }
        self.found[k] = Found { may_switch, is_resolved, crosses_knots };
        let Interval { low, high } = self.values[self.roots[k] as usize];
        Range { low, high, may_switch, is_resolved: is_resolved && !may_switch, crosses_knots }
    }
}

/// Where a function leaves its value that stays within bounds, so that it is resolved where it changes little, however its argument
/// does.
fn bounded(op: Op) -> Option<Register> {
    match op {
        Op::Unary { function: Unary::Tanh | Unary::Asin | Unary::Acos, to, .. }
        | Op::Binary { function: Binary::Atan2, to, .. } => Some(to),
        _ => None,
    }
}

/// Whether the argument of an operation changes so little that a few terms of its series tell all.
fn is_resolved_in(op: Op, v: &[Interval]) -> bool {
    let width = |register: Register| v[register as usize].high - v[register as usize].low;
    let ratio = |register: Register| {
        let Interval { low, high } = v[register as usize];
        let (least, largest) = if low > 0.0 { (low, high) } else { (-high, -low) };
        least > 0.0 && largest <= WIDEST_RATIO * least
    };
    match op {
        Op::SinCos { a, .. }
        | Op::Unary {
            function: Unary::Sin | Unary::Cos | Unary::Tan | Unary::Exp | Unary::Sinh | Unary::Cosh,
            a,
            ..
        } => width(a) <= WIDEST,
        Op::Unary { function: Unary::Sqrt | Unary::Ln | Unary::Log10, a, .. }
        | Op::Recip { a, .. }
        | Op::Div { b: a, .. }
        | Op::Binary { function: Binary::Pow, a, .. } => width(a) == 0.0 || ratio(a),
        Op::Binary { function: Binary::Hypot, a, b, .. } => {
            (width(a) == 0.0 && width(b) == 0.0) || ratio(a) || ratio(b)
        }
        _ => true,
    }
}
