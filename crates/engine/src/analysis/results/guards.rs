//! Guards: the thresholds within a formula at which it may jump, have a kink, grow without bound or cease to exist.
//!
//! A formula is smooth except at its conditions, `sign`, `floor` and `mod`, the knots of tables, and where the argument of `abs`, `sqrt`, `ln`, a
//! power, a quotient or `atan2` passes zero. Each of these is a guard: an argument that changes with the motion, and a threshold. Between crossings
//! of its guards a formula is as smooth as the motion.

use crate::limits::guards::NEAR;
use mechc_expr::{Binary, Comparison, ExprId, Graph, Node, Unary};
use mechc_ir::ConstraintSystem;
use mechc_ir::program::{Op, Program, Ranges, Register, Registers, Restriction, Stage};
use rustc_hash::FxHashMap;
use std::f64::consts::PI;

/// An argument may be on either side of its threshold within this many times its rounding.
const NOISE: f64 = 8.0;

/// A threshold in a formula.
#[derive(Clone, Debug)]
pub(super) struct Guard {
    kind: Kind,
    /// The comparisons of the two registers of a choice, which its derivatives contain, and the side on which each is true.
    comparisons: Vec<(Register, f64)>,
    /// True if a function has no value on one side: below zero, or beyond −1 and 1.
    ends: bool,
    /// The indices in [`Ranges`] of the argument and its time derivative, if that is available.
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
    /// The argument of a function that is not smooth at zero.
    Zero { a: Register },
    /// The argument of `asin` or `acos`, whose slopes are infinite at −1 and 1.
    Unit { a: Register },
    /// The argument of a tangent, which has a pole at every odd multiple of π/2.
    Tangent { a: Register },
}

/// Returns the number of the branch of the tangent that an argument lies on.
fn branch_of_tangent(a: f64) -> f64 {
    (a / PI + 0.5).floor()
}

/// The state of a guard: the side of its threshold, and its argument.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct GuardState {
    /// The side of the threshold, or the number of the step or piece.
    pub side: f64,
    /// The argument, less the threshold if there is only one.
    pub argument: f64,
    /// The sign of the argument.
    sign: f64,
}

impl GuardState {
    /// Returns whether the two states are on different sides.
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

    /// Returns the state of the guard from the registers of a program that has been run.
    pub fn state(&self, registers: &Registers) -> GuardState {
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

    /// Returns whether the guard is exactly at its threshold, where the formula may have the value of neither side.
    pub fn is_at_threshold(&self, state: GuardState) -> bool {
        match self.kind {
            Kind::Zero { .. } | Kind::Step { is_whole: false, .. } => state.side == 0.0,
            _ => false,
        }
    }

    /// Returns whether the guard is on the side where its function has no value.
    pub fn is_beyond_end(&self, state: GuardState) -> bool {
        let is_beyond = if matches!(self.kind, Kind::Unit { .. }) { state.side == 0.0 } else { state.side < 0.0 };
        self.ends && is_beyond
    }

    /// Returns the distances of the arguments of two states from the threshold between them; NaN if several thresholds lie between.
    pub fn distances(&self, states: [GuardState; 2], registers: &Registers) -> [f64; 2] {
        let later = states[0].side.max(states[1].side);
        let is_next = (states[0].side - states[1].side).abs() <= 1.0;
        let threshold = match self.kind {
            Kind::Step { is_whole: true, .. } if is_next => later,
            Kind::Tangent { .. } if is_next => (later - 0.5) * PI,
            // pieces are small whole numbers
            #[allow(clippy::cast_sign_loss)]
            Kind::Piece { knots, .. } if is_next => registers.get(knots + later as Register),
            Kind::Step { is_whole: true, .. } | Kind::Piece { .. } | Kind::Tangent { .. } => f64::NAN,
            _ => 0.0,
        };
        states.map(|state| state.argument - threshold)
    }

    /// Returns whether the formula of the last [`Ranges::find_live`] depends on the guard.
    pub fn is_live(&self, ranges: &Ranges) -> bool {
        match self.kind {
            Kind::Comparison { to, .. } | Kind::Step { to, .. } | Kind::Piece { to, .. } => ranges.is_live(to),
            Kind::Choice { a, b } => ranges.is_live(a) && ranges.is_live(b),
            Kind::Zero { a } | Kind::Unit { a } | Kind::Tangent { a } => ranges.is_live(a),
        }
    }

    /// Classifies the guard between two states by the ranges there.
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
            // NaN on one side has no threshold
            difference if difference > 0.0 => Crossing::Sure,
            _ => Crossing::Possible,
        }
    }

    /// Returns whether rounding alone decides on which side the guard is at a state, by the ranges around that.
    pub fn is_within_rounding(&self, ranges: &Ranges, state: GuardState) -> bool {
        let side: fn(f64) -> f64 = match self.kind {
            Kind::Step { is_whole: true, .. } => f64::floor,
            Kind::Tangent { .. } => branch_of_tangent,
            Kind::Piece { .. } => return self.crossing(ranges, [state; 2]) != Crossing::Never,
            _ => |x| if x == 0.0 { 0.0 } else { x.signum() },
        };
        let [low, high] = self.argument(ranges);
        let ends = [low, high].map(|end| side(state.argument + NOISE * (end - state.argument)));
        ends[0].total_cmp(&ends[1]).is_ne()
    }

    /// Returns the interval of the argument, less the threshold if there is only one.
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

    /// Restricts ranges to a side of the guard.
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
            // the ends of `asin` and `acos` are not excluded: their slopes are infinite there
            Kind::Choice { .. } | Kind::Zero { .. } | Kind::Unit { .. } | Kind::Tangent { .. } => {}
        }
    }

    /// Returns a value of the argument at which the function is not smooth, if it lies between two adjacent states. `usual`, the usual magnitude of
    /// the argument, decides whether the argument is continuous there or jumps.
    pub fn value_between(&self, [a, b]: [GuardState; 2], usual: f64) -> Option<f64> {
        let is_between = match self.kind {
            Kind::Zero { .. } => a.differs_from(&b),
            Kind::Unit { .. } => a.side.max(b.side) > 0.0,
            _ => false,
        };
        let value = self.value_near(a, usual).filter(|_| self.value_near(b, usual).is_some());
        value.filter(|_| is_between)
    }

    /// Returns a value at which the function is not smooth, if the argument is close to it, relative to its `usual` magnitude.
    pub fn value_near(&self, state: GuardState, usual: f64) -> Option<f64> {
        let is_near = state.argument.abs() <= NEAR * usual;
        match self.kind {
            Kind::Zero { .. } if is_near => Some(0.0),
            Kind::Unit { .. } if is_near => Some(state.sign),
            _ => None,
        }
    }

    /// Restricts ranges to one value of the argument.
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

/// Returns the arguments of guards, such as compared differences: their time derivatives show whether guards cross their thresholds at most once.
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

/// Returns the guards of some formulas of a program, inner ones first. `nodes` holds the node in each register; `witnesses` holds
/// [`Guard::witness`] by argument.
pub(super) fn guards(
    graph: &mut Graph,
    program: &Program,
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
    // the node of a register, up to a constant factor and a shift by periods, which have no nodes
    let node_of = |graph: &Graph, mut register: Register| loop {
        if let Some(id) = nodes.get(&register) {
            return Some(*id);
        }
        register = match written.get(&register)? {
            Op::Div { a, b, .. } if is_constant(graph, *b) => *a,
            // another guard determines how many periods are subtracted
            Op::Sub { a, .. } => *a,
            _ => return None,
        };
    };
    let mut all: Vec<Guard> = Vec::new();
    for op in program.operations_behind(roots, Stage::Measures) {
        let Some(kind) = Guard::kind_of(op, program) else { continue };
        let argument = match kind {
            Kind::Comparison { a, b, .. } | Kind::Choice { a, b } => match (node_of(graph, a), node_of(graph, b)) {
                (Some(a), Some(b)) => Some(graph.sub(a, b)),
                // a constant zero may have a register without a node
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
                if let Some(same) = all.iter_mut().find(|guard| is_same(guard)) {
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
        all.push(Guard {
            kind,
            comparisons,
            ends: ends(op),
            witness: argument.and_then(|id| witnesses.get(&id).copied()),
        });
    }
    all
}

/// Returns the time derivatives of some formulas, if both the formula and its derivative are available.
pub(super) fn slopes(
    graph: &mut Graph,
    formulas: &[ExprId],
    is_available: impl Fn(&Graph, ExprId) -> bool,
) -> Vec<Option<ExprId>> {
    let all = ConstraintSystem::time_derivatives(graph, formulas, 3);
    formulas
        .iter()
        .zip(all)
        .map(|(&of, slope)| (is_available(graph, of) && is_available(graph, slope)).then_some(slope))
        .collect()
}

/// Returns the result register of a comparison of `a` and `b`, and the sign of `a` − `b` for which it is true; `None` for another operation.
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
