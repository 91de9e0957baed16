//! Thresholds within a formula: where it may jump, bend, grow without bound or cease to exist.
//!
//! A formula is smooth but for its conditions, `sign`, `floor` and `mod`, the knots of tables, and the places at which the argument of
//! `abs`, `sqrt`, `ln`, a power, a quotient or `atan2` passes zero. Each of these is a guard: an argument that goes with the motion, and a
//! threshold. Between crossings of its guards a formula is as smooth as the motion.

use crate::limits::guards::NEAR;
use mechc_expr::{Binary, Comparison, ExprId, Graph, Node, Unary};
use mechc_ir::ConstraintSystem;
use mechc_ir::program::{Op, Program, Ranges, Register, Registers, Restriction, Stage};
use rustc_hash::FxHashMap;
use std::f64::consts::PI;

/// An argument may be on either side of its threshold within this many times its rounding.
const NOISE: f64 = 8.0;

/// One threshold of a formula.
#[derive(Clone, Debug)]
pub(super) struct Guard {
    kind: Kind,
    /// The comparisons of the registers of a choice that derivatives contain, and the side on which each is true.
    comparisons: Vec<(Register, f64)>,
    /// True if a function has no value on one side: below zero, or beyond −1 and 1.
    ends: bool,
    /// Among the formulas whose ranges are known: the argument, and its time derivative where it has one.
    pub witness: Option<[usize; 2]>,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    /// A comparison of two registers.
    Comparison { to: Register, a: Register, b: Register },
    /// The result of `sign` or `floor`.
    Step { to: Register, a: Register, is_whole: bool },
    /// The piece of a table whose knots begin at a register.
    Piece { to: Register, a: Register, knots: Register },
    /// The larger or the smaller one of two registers.
    Choice { a: Register, b: Register },
    /// An argument of a function that is not smooth at zero.
    Zero { a: Register },
    /// An argument of `asin` or `acos`, whose slopes have no end at −1 and 1.
    Unit { a: Register },
    /// The argument of a tangent, which has a pole at every odd multiple of π/2.
    Tangent { a: Register },
}

/// Returns the number of the pole of a tangent before an argument.
fn branch_of_tangent(a: f64) -> f64 {
    (a / PI + 0.5).floor()
}

/// The state of a guard: the side of its threshold, and its argument.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct GuardState {
    /// The side of the threshold, or the number of the step or piece.
    pub side: f64,
    /// The argument, less the threshold where there is but one.
    pub argument: f64,
    /// The argument's sign.
    sign: f64,
}

impl GuardState {
    /// Returns whether another one is on another side.
    pub fn differs_from(&self, other: &GuardState) -> bool {
        self.side.total_cmp(&other.side).is_ne()
    }
}

/// The behavior of a guard in a cell.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Crossing {
    /// The guard stays on its side.
    Never,
    /// The guard is on different sides at both ends.
    Sure,
    /// The guard may cross its threshold and come back.
    Possible,
}

impl Guard {
    fn kind_of(op: Op, program: &Program) -> Option<Kind> {
        Some(match op {
            Op::Compare { to, a, b, .. } => Kind::Comparison { to, a, b },
            Op::Unary { function: Unary::Sign, to, a } => Kind::Step { to, a, is_whole: false },
            Op::Unary { function: Unary::Floor, to, a } => Kind::Step { to, a, is_whole: true },
            Op::Piece { to, table, a } => Kind::Piece { to, a, knots: program.tables()[table as usize].knots },
            Op::Binary { function: Binary::Min | Binary::Max, a, b, .. } => Kind::Choice { a, b },
            Op::Unary { function: Unary::Abs | Unary::Sqrt | Unary::Ln | Unary::Log10, a, .. }
            | Op::Binary { function: Binary::Pow | Binary::Atan2, a, .. }
            | Op::Recip { a, .. }
            | Op::Div { b: a, .. } => Kind::Zero { a },
            Op::Unary { function: Unary::Asin | Unary::Acos, a, .. } => Kind::Unit { a },
            Op::Unary { function: Unary::Tan, a, .. } => Kind::Tangent { a },
            _ => return None,
        })
    }

    /// Returns the guard's state, from the registers of a program that has been run.
    pub fn mark(&self, registers: &Registers) -> GuardState {
        let get = |register: Register| registers.get(register);
        let sign = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
        let (side, argument) = match self.kind {
            Kind::Comparison { to, a, b } => (get(to), get(a) - get(b)),
            Kind::Step { to, a, .. } | Kind::Piece { to, a, .. } => (get(to), get(a)),
            Kind::Choice { a, b } => (sign(get(a) - get(b)), get(a) - get(b)),
            Kind::Zero { a } => (sign(get(a)), get(a)),
            Kind::Tangent { a } => (branch_of_tangent(get(a)), get(a)),
            Kind::Unit { a } => {
                let side = f64::from(u8::from(get(a).abs() <= 1.0));
                return GuardState { side, argument: get(a).abs() - 1.0, sign: sign(get(a)) };
            }
        };
        GuardState { side, argument, sign: sign(argument) }
    }

    /// Returns whether the formula may have a value of its own where the guard is: neither that of before nor that of behind.
    pub fn is_at_threshold(&self, mark: GuardState) -> bool {
        match self.kind {
            Kind::Zero { .. } | Kind::Step { is_whole: false, .. } => mark.side == 0.0,
            _ => false,
        }
    }

    /// Returns whether the formula may have no value where the guard is.
    pub fn is_beyond_end(&self, mark: GuardState) -> bool {
        let is_beyond = if matches!(self.kind, Kind::Unit { .. }) { mark.side == 0.0 } else { mark.side < 0.0 };
        self.ends && is_beyond
    }

    /// Returns the distances of both arguments from the threshold between two sides; NaN if several thresholds lie between.
    pub fn distances(&self, marks: [GuardState; 2], registers: &Registers) -> [f64; 2] {
        let later = marks[0].side.max(marks[1].side);
        let is_next = (marks[0].side - marks[1].side).abs() <= 1.0;
        let threshold = match self.kind {
            Kind::Step { is_whole: true, .. } if is_next => later,
            Kind::Tangent { .. } if is_next => (later - 0.5) * PI,
            // pieces are small whole numbers
            #[allow(clippy::cast_sign_loss)]
            Kind::Piece { knots, .. } if is_next => registers.get(knots + later as Register),
            Kind::Step { is_whole: true, .. } | Kind::Piece { .. } | Kind::Tangent { .. } => f64::NAN,
            _ => 0.0,
        };
        marks.map(|mark| mark.argument - threshold)
    }

    /// Returns whether a formula depends on the guard, in ranges.
    pub fn is_live(&self, ranges: &Ranges) -> bool {
        match self.kind {
            Kind::Comparison { to, .. } | Kind::Step { to, .. } | Kind::Piece { to, .. } => ranges.is_live(to),
            Kind::Choice { a, b } => ranges.is_live(a) && ranges.is_live(b),
            Kind::Zero { a } | Kind::Unit { a } | Kind::Tangent { a } => ranges.is_live(a),
        }
    }

    /// Classifies the guard between two states, by the ranges there.
    pub fn crossing(&self, ranges: &Ranges, [a, b]: [GuardState; 2]) -> Crossing {
        let is_decided = match self.kind {
            Kind::Comparison { to, .. } | Kind::Step { to, .. } | Kind::Piece { to, .. } => {
                let [low, high] = ranges.interval(to);
                low.total_cmp(&high).is_eq()
            }
            Kind::Choice { a, b } => {
                let ([low, high], [other_low, other_high]) = (ranges.interval(a), ranges.interval(b));
                low > other_high || high < other_low
            }
            Kind::Zero { a } => {
                let [low, high] = ranges.interval(a);
                low > 0.0 || high < 0.0 || (low == 0.0 && high == 0.0)
            }
            Kind::Tangent { a } => {
                let branches = ranges.interval(a).map(branch_of_tangent);
                branches[0].total_cmp(&branches[1]).is_eq()
            }
            Kind::Unit { a } => {
                let [low, high] = ranges.interval(a);
                (low > -1.0 && high < 1.0) || low > 1.0 || high < -1.0
            }
        };
        match (a.side - b.side).abs() {
            _ if is_decided => Crossing::Never,
            0.0 => Crossing::Possible,
            // what is not a number on one side has no threshold
            difference if difference > 0.0 => Crossing::Sure,
            _ => Crossing::Possible,
        }
    }

    /// Returns whether rounding alone decides on which side the guard is at a state, by the ranges of what it is made of there.
    pub fn is_within_rounding(&self, ranges: &Ranges, mark: GuardState) -> bool {
        let side: fn(f64) -> f64 = match self.kind {
            Kind::Step { is_whole: true, .. } => f64::floor,
            Kind::Tangent { .. } => branch_of_tangent,
            Kind::Piece { .. } => return self.crossing(ranges, [mark; 2]) != Crossing::Never,
            _ => |x| if x == 0.0 { 0.0 } else { x.signum() },
        };
        let [low, high] = self.argument(ranges);
        let ends = [low, high].map(|end| side(mark.argument + NOISE * (end - mark.argument)));
        ends[0].total_cmp(&ends[1]).is_ne()
    }

    /// Returns the range of the argument, less the threshold if there is only one.
    pub fn argument(&self, ranges: &Ranges) -> [f64; 2] {
        match self.kind {
            Kind::Comparison { a, b, .. } | Kind::Choice { a, b } => {
                let ([low, high], [other_low, other_high]) = (ranges.interval(a), ranges.interval(b));
                [low - other_high, high - other_low]
            }
            Kind::Unit { a } => {
                let [low, high] = ranges.interval(a);
                let least = if low <= 0.0 && high >= 0.0 { 0.0 } else { low.abs().min(high.abs()) };
                [least - 1.0, low.abs().max(high.abs()) - 1.0]
            }
            Kind::Step { a, .. } | Kind::Piece { a, .. } | Kind::Zero { a } | Kind::Tangent { a } => ranges.interval(a),
        }
    }

    /// Keeps the guard on a side, in ranges.
    pub fn hold(&self, side: f64, ranges: &mut Ranges) {
        match self.kind {
            Kind::Comparison { to, .. } | Kind::Step { to, .. } | Kind::Piece { to, .. } => {
                ranges.hold(to, Restriction::At(side));
            }
            Kind::Zero { a } if side != 0.0 => {
                ranges.hold(a, if side > 0.0 { Restriction::Above } else { Restriction::Below });
            }
            Kind::Choice { .. } if side != 0.0 => {
                for &(to, true_on) in &self.comparisons {
                    ranges.hold(to, Restriction::At(f64::from(u8::from(true_on * side > 0.0))));
                }
            }
            // at its ends it is not held: a slope without an end is one
            Kind::Choice { .. } | Kind::Zero { .. } | Kind::Unit { .. } | Kind::Tangent { .. } => {}
        }
    }

    /// A value of the argument at which the formula is not smooth, if it lies between two states beside each other. How large the argument usually
    /// is tells whether it goes there, or jumps.
    pub fn value_between(&self, [a, b]: [GuardState; 2], usual: f64) -> Option<f64> {
        let is_between = match self.kind {
            Kind::Zero { .. } => a.differs_from(&b),
            Kind::Unit { .. } => a.side.max(b.side) > 0.0,
            _ => false,
        };
        let value = self.value_near(a, usual).filter(|_| self.value_near(b, usual).is_some());
        value.filter(|_| is_between)
    }

    /// A value of the argument at which the formula is not smooth, and which the argument is near to.
    pub fn value_near(&self, mark: GuardState, usual: f64) -> Option<f64> {
        let is_near = mark.argument.abs() <= NEAR * usual;
        match self.kind {
            Kind::Zero { .. } if is_near => Some(0.0),
            Kind::Unit { .. } if is_near => Some(mark.sign),
            _ => None,
        }
    }

    /// Keeps the argument at a value, in ranges.
    pub fn hold_at(&self, value: f64, ranges: &mut Ranges) {
        if let Kind::Zero { a } | Kind::Unit { a } = self.kind {
            ranges.hold(a, Restriction::At(value));
        }
    }
}

/// Returns whether an operation has no value on one side of a threshold.
fn ends(op: Op) -> bool {
    matches!(
        op,
        Op::Unary { function: Unary::Sqrt | Unary::Ln | Unary::Log10 | Unary::Asin | Unary::Acos, .. }
            | Op::Binary { function: Binary::Pow, .. }
    )
}

/// Returns the formulas whose time derivatives show whether guards cross their thresholds at most once, such as differences that are compared.
pub(super) fn arguments(graph: &mut Graph, formulas: &[ExprId]) -> Vec<ExprId> {
    let mut arguments = Vec::new();
    for id in graph.reachable(formulas) {
        if graph.dependence(id).is_constant() {
            continue;
        }
        arguments.push(match graph.node(id) {
            Node::Compare(_, a, b) | Node::Binary(Binary::Min | Binary::Max, a, b) => graph.sub(a, b),
            Node::Unary(
                Unary::Abs
                | Unary::Sign
                | Unary::Floor
                | Unary::Sqrt
                | Unary::Ln
                | Unary::Log10
                | Unary::Asin
                | Unary::Acos
                | Unary::Tan,
                a,
            )
            | Node::Binary(Binary::Pow | Binary::Atan2 | Binary::Mod, a, _)
            | Node::Table(_, _, a)
            | Node::Div(_, a) => a,
            Node::Power(a, n) if n < 0 => a,
            _ => continue,
        });
    }
    arguments.retain(|&argument| !graph.dependence(argument).is_constant());
    arguments.sort_unstable();
    arguments.dedup();
    arguments
}

/// The guards of some formulas of a program, the inner ones first, by the nodes that stand in its registers and by what is known of some of
/// these.
pub(super) fn guards(
    (graph, program): (&mut Graph, &Program),
    roots: &[Register],
    nodes: &FxHashMap<Register, ExprId>,
    witnesses: &FxHashMap<ExprId, [usize; 2]>,
) -> Vec<Guard> {
    let operations = program.stage(Stage::Measures);
    let written: FxHashMap<Register, Op> =
        operations.iter().flat_map(|&op| op.writes().into_iter().map(move |to| (to, op))).collect();
    let is_constant = |graph: &Graph, register: Register| match nodes.get(&register) {
        Some(&id) => graph.dependence(id).is_constant(),
        None => !written.contains_key(&register),
    };
    // what a register is of, but for a shift and a factor that rest: those of periods stand for no node
    let node_of = |graph: &Graph, mut register: Register| loop {
        if let Some(id) = nodes.get(&register) {
            return Some(*id);
        }
        register = match written.get(&register)? {
            Op::Div { a, b, .. } if is_constant(graph, *b) => *a,
            // a period is taken off where its own guard says how often
            Op::Sub { a, .. } => *a,
            _ => return None,
        };
    };
    let mut found: Vec<Guard> = Vec::new();
    for op in program.operations_behind(roots, Stage::Measures) {
        let Some(kind) = Guard::kind_of(op, program) else { continue };
        let argument = match kind {
            Kind::Comparison { a, b, .. } | Kind::Choice { a, b } => match (node_of(graph, a), node_of(graph, b)) {
                (Some(a), Some(b)) => Some(graph.sub(a, b)),
                // a zero may be one of its own
                (Some(a), None) => Some(a),
                _ => None,
            },
            Kind::Step { a, .. } | Kind::Piece { a, .. } | Kind::Tangent { a } => node_of(graph, a),
            Kind::Zero { a } | Kind::Unit { a } => {
                let is_same = |guard: &Guard| match (guard.kind, kind) {
                    (Kind::Zero { a: b }, Kind::Zero { .. }) | (Kind::Unit { a: b }, Kind::Unit { .. }) => a == b,
                    _ => false,
                };
                if is_constant(graph, a) {
                    continue;
                }
                if let Some(same) = found.iter_mut().find(|guard| is_same(guard)) {
                    same.ends |= ends(op);
                    continue;
                }
                nodes.get(&a).copied()
            }
        };
        let comparisons = match kind {
            Kind::Choice { a, b } => operations.iter().filter_map(|op| compared(op, a, b)).collect(),
            _ => Vec::new(),
        };
        found.push(Guard {
            kind,
            comparisons,
            ends: ends(op),
            witness: argument.and_then(|id| witnesses.get(&id).copied()),
        });
    }
    found
}

/// Returns the time derivatives of some formulas, as far as they are known.
pub(super) fn slopes(
    graph: &mut Graph,
    formulas: &[ExprId],
    is_known: impl Fn(&Graph, ExprId) -> bool,
) -> Vec<Option<ExprId>> {
    let all = ConstraintSystem::time_derivatives(graph, formulas, 3);
    formulas
        .iter()
        .zip(all)
        .map(|(&of, slope)| (is_known(graph, of) && is_known(graph, slope)).then_some(slope))
        .collect()
}

/// Returns the result of a comparison of two registers, and the sign of their difference with which it is true.
fn compared(op: &Op, a: Register, b: Register) -> Option<(Register, f64)> {
    match *op {
        Op::Compare { comparison: Comparison::Less | Comparison::LessEqual, to, a: x, b: y } => match (x, y) {
            _ if (x, y) == (a, b) => Some((to, -1.0)),
            _ if (x, y) == (b, a) => Some((to, 1.0)),
            _ => None,
        },
        _ => None,
    }
}
