//! Properties of every formula and every mechanism: random ones, the same on every run.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::{Outcome, Span, analyse, compile_number, files, run, stem};
use mechc::{Compiled, Sources};
use mechc_expr::math;
use mechc_expr::{Binary, Comparison, Dependence, ExprId, Graph, MotionLaw, Node, Symbol, Unary};
use mechc_syntax::{self as syntax, ast};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use rustc_hash::FxHashMap;
use std::f64::consts::{PI, TAU};
use std::fs;

/// Returns a configuration with `cases` cases, the same on every run, and no files.
fn config(cases: u32) -> Config {
    Config { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(20), ..Config::default() }
}

const X: Symbol = Symbol::Coordinate { index: 0, order: 0 };
const Y: Symbol = Symbol::Coordinate { index: 1, order: 0 };

/// A formula as written, without simplification.
#[derive(Clone, Debug)]
enum Tree {
    Constant(f64),
    Leaf(Symbol),
    Add(Box<[Tree; 2]>),
    Sub(Box<[Tree; 2]>),
    Mul(Box<[Tree; 2]>),
    Div(Box<[Tree; 2]>),
    Mod(Box<[Tree; 2]>),
    Pow(Box<[Tree; 2]>),
    Neg(Box<Tree>),
    Power(Box<Tree>, i32),
    Unary(Unary, Box<Tree>),
    Binary(Binary, Box<[Tree; 2]>),
    Select(Box<Condition>, Box<[Tree; 2]>),
    /// From `u0` on, over a length; from `v0` to `v1`.
    MotionLaw(MotionLaw, Box<Tree>, [f64; 4]),
}

#[derive(Clone, Debug)]
enum Condition {
    Compare(Comparison, Tree, Tree),
    And(Box<[Condition; 2]>),
    Or(Box<[Condition; 2]>),
    Not(Box<Condition>),
}

/// A value with a bound of its error, to first order: what rounding, or an uncertain argument, makes of it. Infinite
/// where a jump or a pole is within reach.
#[derive(Clone, Copy, Debug)]
struct Bounded {
    value: f64,
    error: f64,
}

impl Bounded {
    /// A number with the error that its operands give it, and what rounding adds.
    fn new(value: f64, error: f64) -> Bounded {
        let error = error + 4.0 * f64::EPSILON * value.abs();
        Bounded { value, error: if error.is_nan() { f64::INFINITY } else { error } }
    }

    fn exact(value: f64) -> Bounded {
        Bounded { value, error: 0.0 }
    }

    fn add(self, other: Bounded) -> Bounded {
        Bounded::new(self.value + other.value, self.error + other.error)
    }

    fn neg(self) -> Bounded {
        Bounded { value: -self.value, error: self.error }
    }

    fn sub(self, other: Bounded) -> Bounded {
        Bounded::new(self.value - other.value, self.error + other.error)
    }

    fn mul(self, other: Bounded) -> Bounded {
        let error = self.value.abs() * other.error + other.value.abs() * self.error + self.error * other.error;
        Bounded::new(self.value * other.value, error)
    }

    fn div(self, other: Bounded) -> Bounded {
        let (value, clear) = (self.value / other.value, other.value.abs() - other.error);
        let error = if clear > 0.0 { (self.error + value.abs() * other.error) / clear } else { f64::INFINITY };
        Bounded::new(value, error)
    }

    fn power(self, n: i32) -> Bounded {
        let m = n.unsigned_abs();
        let value = math::whole_power(self.value, m);
        let far = math::whole_power(self.value.abs() + self.error, m);
        let rounding = f64::from(m) * f64::EPSILON * value.abs();
        let power = Bounded::new(value, far - value.abs() + rounding);
        if n < 0 { Bounded::exact(1.0).div(power) } else { power }
    }

    fn unary(self, function: Unary) -> Bounded {
        let Bounded { value: x, error: e } = self;
        let (low, high) = (x - e, x + e);
        // the largest slope within reach
        let steepest = |slope: fn(f64) -> f64| slope(low).abs().max(slope(high).abs());
        let positive = |slope: f64| if low > 0.0 { slope } else { f64::INFINITY };
        let jumps = |jumps: bool| if jumps { f64::INFINITY } else { 0.0 };
        let (value, slope) = match function {
            Unary::Sin => (math::sin(x), 1.0),
            Unary::Cos => (math::cos(x), 1.0),
            Unary::Tan => {
                let clear = math::cos(x).abs() - e;
                (math::tan(x), if clear > 0.0 { 1.0 / (clear * clear) } else { f64::INFINITY })
            }
            Unary::Asin | Unary::Acos => {
                let slope = steepest(|x| 1.0 / math::sqrt(1.0 - x * x));
                (if function == Unary::Asin { math::asin(x) } else { math::acos(x) }, slope)
            }
            Unary::Atan => (math::atan(x), 1.0),
            Unary::Sinh => (math::sinh(x), steepest(math::cosh)),
            Unary::Cosh => (math::cosh(x), steepest(math::sinh)),
            Unary::Tanh => (math::tanh(x), 1.0),
            Unary::Exp => (math::exp(x), steepest(math::exp)),
            Unary::Ln => (math::ln(x), positive(1.0 / low)),
            Unary::Log10 => (math::log10(x), positive(1.0 / low)),
            Unary::Sqrt => (math::sqrt(x), positive(0.5 / math::sqrt(low))),
            Unary::Abs => (x.abs(), 1.0),
            Unary::Sign => (math::sign(x), jumps(low <= 0.0 && high >= 0.0)),
            Unary::Floor => (math::floor(x), jumps(math::floor(low) != math::floor(high) || low == math::floor(x))),
        };
        // an exact argument has an exact value, whatever the slope
        Bounded::new(value, if e == 0.0 { 0.0 } else { slope * e })
    }

    fn binary(self, function: Binary, other: Bounded) -> Bounded {
        let (a, b) = (self, other);
        let both = a.error + b.error;
        match function {
            Binary::Atan2 => {
                let clear = math::hypot(a.value, b.value) - both;
                // the cut along the negative axis
                let near_cut = b.value - b.error <= 0.0 && a.value.abs() <= a.error;
                let error = if clear > 0.0 && !near_cut { both / clear } else { f64::INFINITY };
                Bounded::new(math::atan2(a.value, b.value), error)
            }
            Binary::Hypot => Bounded::new(math::hypot(a.value, b.value), both),
            Binary::Min => Bounded::new(math::min(a.value, b.value), a.error.max(b.error)),
            Binary::Max => Bounded::new(math::max(a.value, b.value), a.error.max(b.error)),
            Binary::Mod => a.modulo(b),
            Binary::Pow => {
                let value = math::pow(a.value, b.value);
                let exponent = a.unary(Unary::Ln).mul(b);
                // a whole power of what is not positive has no logarithm
                let error = if a.value > 0.0 { exponent.unary(Unary::Exp).error } else { f64::INFINITY };
                Bounded::new(value, error)
            }
        }
    }

    fn modulo(self, other: Bounded) -> Bounded {
        self.sub(other.mul(self.div(other).unary(Unary::Floor)))
    }

    fn compare(self, comparison: Comparison, other: Bounded) -> Bounded {
        let (a, b) = (self.value, other.value);
        let holds = match comparison {
            Comparison::Less => a < b,
            Comparison::LessEqual => a <= b,
            Comparison::Equal => a == b,
        };
        let reach = self.error + other.error;
        let open = reach > 0.0 && (a - b).abs() <= reach || !(a - b).is_finite();
        Bounded { value: f64::from(holds), error: if open { f64::INFINITY } else { 0.0 } }
    }

    fn select(self, a: Bounded, b: Bounded) -> Bounded {
        let chosen = if self.value == 0.0 { b } else { a };
        Bounded { value: chosen.value, error: chosen.error + self.error }
    }

    fn is_within(self, tolerance: f64) -> bool {
        self.value.is_finite() && self.error <= tolerance * (1.0 + self.value.abs())
    }
}

impl Condition {
    fn build(&self, g: &mut Graph) -> ExprId {
        match self {
            Condition::Compare(comparison, a, b) => {
                let (a, b) = (a.build(g), b.build(g));
                g.compare(*comparison, a, b)
            }
            Condition::And(pair) => {
                let (a, b) = (pair[0].build(g), pair[1].build(g));
                g.and(a, b)
            }
            Condition::Or(pair) => {
                let (a, b) = (pair[0].build(g), pair[1].build(g));
                g.or(a, b)
            }
            Condition::Not(inner) => {
                let inner = inner.build(g);
                g.not(inner)
            }
        }
    }

    fn value(&self, point: [Bounded; 2]) -> Bounded {
        let either = |pair: &[Condition; 2], op: fn(bool, bool) -> bool| {
            let (a, b) = (pair[0].value(point), pair[1].value(point));
            Bounded { value: f64::from(op(a.value != 0.0, b.value != 0.0)), error: a.error + b.error }
        };
        match self {
            Condition::Compare(comparison, a, b) => a.value(point).compare(*comparison, b.value(point)),
            Condition::And(pair) => either(pair, |a, b| a && b),
            Condition::Or(pair) => either(pair, |a, b| a || b),
            Condition::Not(inner) => {
                let inner = inner.value(point);
                Bounded { value: 1.0 - inner.value, error: inner.error }
            }
        }
    }
}

impl Tree {
    /// Through the simplifying constructors.
    fn build(&self, g: &mut Graph) -> ExprId {
        let mut both = |pair: &[Tree; 2]| (pair[0].build(g), pair[1].build(g));
        match self {
            Tree::Constant(c) => g.constant(*c),
            Tree::Leaf(symbol) => g.symbol(*symbol),
            Tree::Add(pair) => {
                let (a, b) = both(pair);
                g.add(a, b)
            }
            Tree::Sub(pair) => {
                let (a, b) = both(pair);
                g.sub(a, b)
            }
            Tree::Mul(pair) => {
                let (a, b) = both(pair);
                g.mul(a, b)
            }
            Tree::Div(pair) => {
                let (a, b) = both(pair);
                g.div(a, b)
            }
            Tree::Mod(pair) => {
                let (a, b) = both(pair);
                g.modulo(a, b)
            }
            Tree::Pow(pair) => {
                let (a, b) = both(pair);
                g.pow(a, b)
            }
            Tree::Binary(function, pair) => {
                let (a, b) = both(pair);
                g.binary(*function, a, b)
            }
            Tree::Neg(inner) => {
                let inner = inner.build(g);
                g.neg(inner)
            }
            Tree::Power(inner, n) => {
                let inner = inner.build(g);
                g.power(inner, *n)
            }
            Tree::Unary(function, inner) => {
                let inner = inner.build(g);
                g.unary(*function, inner)
            }
            Tree::Select(condition, pair) => {
                let (a, b) = both(pair);
                let condition = condition.build(g);
                g.select(condition, a, b)
            }
            Tree::MotionLaw(motion, u, [u0, length, v0, v1]) => {
                let u = u.build(g);
                let [u0, v0, u1, v1] = [*u0, *v0, u0 + length, *v1].map(|c| g.constant(c));
                g.motion(*motion, u, [u0, v0], [u1, v1])
            }
        }
    }

    /// As it stands.
    fn value(&self, point: [Bounded; 2]) -> Bounded {
        let both = |pair: &[Tree; 2]| (pair[0].value(point), pair[1].value(point));
        match self {
            Tree::Constant(c) => Bounded::exact(*c),
            Tree::Leaf(symbol) => point[usize::from(*symbol == Y)],
            Tree::Add(pair) => both(pair).0.add(pair[1].value(point)),
            Tree::Sub(pair) => both(pair).0.sub(pair[1].value(point)),
            Tree::Mul(pair) => both(pair).0.mul(pair[1].value(point)),
            Tree::Div(pair) => both(pair).0.div(pair[1].value(point)),
            Tree::Mod(pair) => both(pair).0.modulo(pair[1].value(point)),
            Tree::Pow(pair) => both(pair).0.binary(Binary::Pow, pair[1].value(point)),
            Tree::Binary(function, pair) => both(pair).0.binary(*function, pair[1].value(point)),
            Tree::Neg(inner) => inner.value(point).neg(),
            Tree::Power(inner, n) => inner.value(point).power(*n),
            Tree::Unary(function, inner) => inner.value(point).unary(*function),
            Tree::Select(condition, pair) => {
                let (a, b) = both(pair);
                condition.value(point).select(a, b)
            }
            Tree::MotionLaw(motion, u, [u0, length, v0, v1]) => {
                let (u, start, end) = (u.value(point), Bounded::exact(*u0), Bounded::exact(u0 + length));
                let s = u.sub(start).div(end.sub(start));
                let between = Bounded::exact(*v0).add(Bounded::exact(v1 - v0).mul(law(*motion, s)));
                let later = u.compare(Comparison::Less, end).select(between, Bounded::exact(*v1));
                u.compare(Comparison::Less, start).select(Bounded::exact(*v0), later)
            }
        }
    }
}

/// The motions as the language's page gives them.
fn law(motion: MotionLaw, s: Bounded) -> Bounded {
    let constant = Bounded::exact;
    let polynomial =
        |terms: &[(f64, i32)]| terms.iter().fold(constant(0.0), |sum, &(c, n)| sum.add(constant(c).mul(s.power(n))));
    let sine = |angle: Bounded| angle.unary(Unary::Sin);
    match motion {
        MotionLaw::Step => polynomial(&[(3.0, 2), (-2.0, 3)]),
        MotionLaw::Step5 => polynomial(&[(10.0, 3), (-15.0, 4), (6.0, 5)]),
        MotionLaw::Step7 => polynomial(&[(35.0, 4), (-84.0, 5), (70.0, 6), (-20.0, 7)]),
        MotionLaw::Harmonic => constant(0.5).mul(constant(1.0).sub(constant(PI).mul(s).unary(Unary::Cos))),
        MotionLaw::Cycloidal => s.sub(sine(constant(TAU).mul(s)).div(constant(TAU))),
        MotionLaw::ModifiedSine => {
            let k = constant(1.0 / (4.0 + PI));
            let angle = constant(PI).mul(s);
            let ripple = constant(0.25).mul(sine(constant(4.0).mul(angle)));
            let slow = constant(PI).add(constant(4.0).mul(angle)).div(constant(3.0));
            let start = angle.sub(ripple);
            let middle = constant(2.0).add(angle).sub(constant(2.25).mul(sine(slow)));
            let end = constant(4.0).add(angle).sub(ripple);
            let later = s.compare(Comparison::Less, constant(0.875)).select(middle, end);
            k.mul(s.compare(Comparison::Less, constant(0.125)).select(start, later))
        }
    }
}

/// The value of a formula of the graph, with its bound.
fn value(graph: &Graph, root: ExprId, point: [Bounded; 2]) -> Bounded {
    let mut known: FxHashMap<ExprId, Bounded> = FxHashMap::default();
    for id in graph.reachable(&[root]) {
        let of = |id: ExprId| known[&id];
        let value = match graph.node(id) {
            Node::Const(bits) => Bounded::exact(f64::from_bits(bits)),
            Node::Symbol(symbol) => point[usize::from(symbol == Y)],
            Node::Add(a, b) => of(a).add(of(b)),
            Node::Sub(a, b) => of(a).sub(of(b)),
            Node::Mul(a, b) | Node::And(a, b) => of(a).mul(of(b)),
            Node::Div(a, b) => of(a).div(of(b)),
            Node::Neg(a) => of(a).neg(),
            Node::Power(a, n) => of(a).power(n),
            Node::Unary(function, a) => of(a).unary(function),
            Node::Binary(function, a, b) => of(a).binary(function, of(b)),
            Node::Compare(comparison, a, b) => of(a).compare(comparison, of(b)),
            Node::Or(a, b) => of(a).binary(Binary::Max, of(b)),
            Node::Not(a) => Bounded::exact(1.0).sub(of(a)),
            Node::Select(c, a, b) => of(c).select(of(a), of(b)),
            Node::Table(..) => unreachable!("no tree holds a table"),
        };
        known.insert(id, value);
    }
    known[&root]
}

/// Formulas with every operator and function; most arguments where the functions have values.
fn trees() -> impl Strategy<Value = Tree> {
    let special = prop::sample::select(vec![0.0, 1.0, -1.0, 2.0, 0.5, -3.0]).prop_map(Tree::Constant);
    let leaf = prop_oneof![
        4 => prop::sample::select(vec![X, Y]).prop_map(Tree::Leaf),
        1 => special,
        1 => (-3.0..3.0).prop_map(Tree::Constant),
    ];
    leaf.prop_recursive(5, 40, 2, |inner| {
        let inner = inner.boxed();
        // some with equal operands, which are gathered
        let pair = prop_oneof![
            4 => (inner.clone(), inner.clone()).prop_map(|(a, b)| Box::new([a, b])),
            1 => inner.clone().prop_map(|a| Box::new([a.clone(), a])),
            1 => (inner.clone(), 1..4_i32)
                .prop_map(|(a, n)| Box::new([a.clone(), Tree::Power(Box::new(a), n)])),
            1 => (inner.clone(), 1..4_i32)
                .prop_map(|(a, n)| Box::new([Tree::Power(Box::new(a.clone()), n), a])),
        ]
        .boxed();
        let one = inner.clone().prop_map(Box::new).boxed();
        // in (−1, 1), and above 0
        let small = one.clone().prop_map(|u| Box::new(Tree::Unary(Unary::Sin, u)));
        let small = small.prop_map(|u| Box::new(Tree::Mul(Box::new([Tree::Constant(0.9), *u])))).boxed();
        let positive =
            one.clone().prop_map(|u| Box::new(Tree::Add(Box::new([Tree::Constant(0.3), Tree::Power(u, 2)])))).boxed();
        let total = prop::sample::select(vec![
            Unary::Sin,
            Unary::Cos,
            Unary::Atan,
            Unary::Tanh,
            Unary::Abs,
            Unary::Sign,
            Unary::Floor,
        ]);
        let bounded =
            prop::sample::select(vec![Unary::Tan, Unary::Asin, Unary::Acos, Unary::Sinh, Unary::Cosh, Unary::Exp]);
        let upper = prop::sample::select(vec![Unary::Ln, Unary::Log10, Unary::Sqrt]);
        let any_unary = prop_oneof![total.clone(), bounded.clone(), upper.clone()];
        let binary = prop::sample::select(vec![Binary::Atan2, Binary::Hypot, Binary::Min, Binary::Max]);
        let motion = prop::sample::select(vec![
            MotionLaw::Step,
            MotionLaw::Step5,
            MotionLaw::Step7,
            MotionLaw::Harmonic,
            MotionLaw::Cycloidal,
            MotionLaw::ModifiedSine,
        ]);
        prop_oneof![
            3 => pair.clone().prop_map(Tree::Add),
            3 => pair.clone().prop_map(Tree::Sub),
            4 => pair.clone().prop_map(Tree::Mul),
            1 => pair.clone().prop_map(Tree::Div),
            2 => (inner.clone(), positive.clone()).prop_map(|(a, b)| Tree::Div(Box::new([a, *b]))),
            1 => (inner.clone(), positive.clone()).prop_map(|(a, b)| Tree::Mod(Box::new([a, *b]))),
            1 => (positive.clone(), small.clone()).prop_map(|(a, b)| Tree::Pow(Box::new([*a, *b]))),
            1 => (positive.clone(), prop::sample::select(vec![0.5, 2.0, 3.0, -1.0, 1.7]))
                .prop_map(|(a, b)| Tree::Pow(Box::new([*a, Tree::Constant(b)]))),
            3 => one.clone().prop_map(Tree::Neg),
            2 => (one.clone(), 0..5_i32).prop_map(|(a, n)| Tree::Power(a, n)),
            1 => (positive.clone(), -4..0_i32).prop_map(|(a, n)| Tree::Power(a, n)),
            3 => (total, one.clone()).prop_map(|(f, a)| Tree::Unary(f, a)),
            2 => (bounded, small).prop_map(|(f, a)| Tree::Unary(f, a)),
            2 => (upper, positive).prop_map(|(f, a)| Tree::Unary(f, a)),
            1 => (any_unary, one.clone()).prop_map(|(f, a)| Tree::Unary(f, a)),
            2 => (binary, pair.clone()).prop_map(|(f, p)| Tree::Binary(f, p)),
            1 => (conditions(inner.clone()), pair).prop_map(|(c, p)| Tree::Select(Box::new(c), p)),
            1 => (motion, one, -2.0..1.0, 0.5..3.0, -2.0..2.0, -2.0..2.0)
                .prop_map(|(m, u, u0, length, v0, v1)| Tree::MotionLaw(m, u, [u0, length, v0, v1])),
        ]
    })
}

fn conditions(side: BoxedStrategy<Tree>) -> impl Strategy<Value = Condition> {
    let comparison = prop::sample::select(vec![Comparison::Less, Comparison::LessEqual, Comparison::Equal]);
    let leaf = (comparison, side.clone(), side).prop_map(|(c, a, b)| Condition::Compare(c, a, b));
    leaf.prop_recursive(2, 4, 2, |inner| {
        let pair = (inner.clone(), inner.clone()).prop_map(|(a, b)| Box::new([a, b]));
        prop_oneof![
            pair.clone().prop_map(Condition::And),
            pair.prop_map(Condition::Or),
            inner.prop_map(|c| Condition::Not(Box::new(c))),
        ]
    })
}

/// Skips cases without a value, or with rounding alone; most must have one.
fn mostly_valued(config: Config) -> Config {
    Config { max_global_rejects: config.cases, ..config }
}

proptest! {
    #![proptest_config(mostly_valued(config(2000)))]

    #[test]
    fn simplification_keeps_the_value(tree in trees(), x in -2.0..2.0, y in -2.0..2.0) {
        let want = tree.value([x, y].map(Bounded::exact));
        prop_assume!(want.is_within(1e-9));
        let want = want.value;
        let near = |got: f64| (got - want).abs() <= 1e-9 * (1.0 + want.abs());

        let mut graph = Graph::new();
        let root = tree.build(&mut graph);
        let symbol = |symbol| if symbol == X { x } else { y };
        let got = graph.value(root, symbol);
        prop_assert!(near(got), "{got} instead of {want}");

        // and so it does where the symbols become numbers
        let (mut folded, mut known) = (Graph::new(), FxHashMap::default());
        folded.import(&graph, &[root], &mut known, |graph, s| graph.constant(symbol(s)));
        let got = folded.value(known[&root], |_| unreachable!("no symbol is left"));
        prop_assert!(near(got), "folded: {got} instead of {want}");
    }

    #[test]
    fn derivatives_are_slopes_forward_and_backward(tree in trees(), x in -2.0..2.0, y in -2.0..2.0) {
        let mut graph = Graph::new();
        let root = tree.build(&mut graph);
        let gradient = graph.gradient(root, Dependence::coordinates(0));
        let mut visited = false;
        for by in [X, Y] {
            let slope = graph.derivatives(&[root], |graph, s| (s == by).then(|| graph.constant(1.0)))[0];
            let forward = value(&graph, slope, [x, y].map(Bounded::exact));
            let backward = gradient.iter().find(|(symbol, _)| *symbol == by);
            let backward =
                backward.map_or(Bounded::exact(0.0), |&(_, id)| value(&graph, id, [x, y].map(Bounded::exact)));
            if forward.is_within(1e-9) && backward.is_within(1e-9) {
                let (a, b) = (forward.value, backward.value);
                prop_assert!((a - b).abs() <= 1e-9 * (1.0 + a.abs()), "by {by:?}: forward {a}, backward {b}");
            }

            // no jump or kink where the differences reach
            let h = 1e-4;
            let reach = |symbol: Symbol, at: f64| Bounded {
                value: at,
                error: if symbol == by { 2.0 * h } else { 0.0 },
            };
            let around = [reach(X, x), reach(Y, y)];
            let smooth = [root, slope].iter().all(|&id| value(&graph, id, around).error.is_finite());
            let at = |step: f64| {
                graph.value(root, |symbol| {
                    (if symbol == X { x } else { y }) + if symbol == by { step } else { 0.0 }
                })
            };
            let difference =
                |h: f64| (at(-2.0 * h) - 8.0 * at(-h) + 8.0 * at(h) - at(2.0 * h)) / (12.0 * h);
            let (wide, narrow) = (difference(h), difference(0.5 * h));
            let size = 1.0 + narrow.abs() + at(0.0).abs();
            if smooth && (wide - narrow).abs() <= 1e-7 * size {
                visited = true;
                let exact = forward.value;
                prop_assert!((exact - narrow).abs() <= 1e-6 * size, "by {by:?}: {exact} and {narrow}");
            }
        }
        prop_assume!(visited);
    }
}

/// Cases whose coordinates leave fewer digits: 1e6 m is known to 1e-10 m.
fn tolerance(name: &str) -> f64 {
    if name == "far_away" { 2e-8 } else { 1e-9 }
}

/// Every column of one is in the other, by its name, to `tolerance` times one plus the column's largest value.
fn same(got: &Outcome, want: &Outcome, tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert!(got.succeeded(), "{}", got.text());
    prop_assert_eq!(got.columns.len(), want.columns.len());
    for column in &want.columns {
        near(column, &got.column(column), &want.column(column), tolerance)?;
    }
    Ok(())
}

fn near(what: &str, got: &[f64], want: &[f64], tolerance: f64) -> Result<(), TestCaseError> {
    prop_assert_eq!(got.len(), want.len());
    let size = want.iter().fold(1.0, |size: f64, v| size.max(1.0 + v.abs()));
    for (k, (a, b)) in got.iter().zip(want).enumerate() {
        prop_assert!((a - b).abs() <= tolerance * size, "{what}, row {k}: {a} instead of {b}");
    }
    Ok(())
}

/// Declarations, and the features in them, in any order.
fn shuffled(mechanism: ast::Mechanism) -> impl Strategy<Value = ast::Mechanism> {
    (Just(mechanism.items).prop_shuffle(), Just((mechanism.docs, mechanism.name, mechanism.span))).prop_perturb(
        |(mut items, (docs, name, span)), mut random| {
            for item in &mut items {
                if let ast::ItemKind::Ground { features } | ast::ItemKind::Body { features, .. } = &mut item.kind {
                    features.sort_by_cached_key(|_| random.next_u32());
                }
            }
            ast::Mechanism { docs, name, span, items }
        },
    )
}

#[test]
fn order_of_declarations_has_no_effect() {
    let mut tried = 0;
    for path in [files("examples", "mech"), files("tests/cases", "mech")].concat() {
        let (name, text) = (stem(&path), fs::read_to_string(&path).expect("a text"));
        let mut sources = Sources::default();
        let file = sources.add(name.as_str(), text);
        let tree = syntax::parse(&sources, file).tree;
        let mechanism = &tree.mechanisms[0];
        let follow = |mechanism: &ast::Mechanism| {
            // its parts may be mechanisms of the same file, or of others
            let mechanisms = std::iter::once(mechanism).chain(&tree.mechanisms[1..]).cloned().collect();
            let file = ast::File { uses: tree.uses.clone(), mechanisms };
            let (compiled, outcome) = compile_number(&path, &syntax::format(&file), 0);
            let span = compiled
                .as_ref()
                .and_then(Compiled::analysis)
                .map(|[from, to, _]| Span { to: None, every: Some((to - from) / 20.0) });
            analyse((compiled, outcome), span.unwrap_or_default())
        };
        // what this version only reads, and what has no analysis of its own
        let want = follow(mechanism);
        if !want.succeeded() || want.rows.is_empty() {
            continue;
        }
        tried += 1;
        let holds = TestRunner::new(config(4))
            .run(&shuffled(mechanism.clone()), |mechanism| same(&follow(&mechanism), &want, tolerance(&name)));
        if let Err(fault) = holds {
            panic!("{name}: {fault}");
        }
    }
    assert!(tried >= 30, "only {tried} files were tried");
}

/// Where a mechanism is built, and which way it is turned there.
#[derive(Clone, Copy, Debug)]
struct Place {
    x: f64,
    y: f64,
    angle: f64,
}

const HOME: Place = Place { x: 0.0, y: 0.0, angle: 0.0 };

impl Place {
    fn turned(self, x: f64, y: f64) -> [f64; 2] {
        let (sin, cos) = math::sin_cos(self.angle);
        [cos * x - sin * y, sin * x + cos * y]
    }

    fn point(self, x: f64, y: f64) -> String {
        let [a, b] = self.turned(x, y);
        format!("({}, {})", self.x + a, self.y + b)
    }

    fn direction(self, x: f64, y: f64) -> String {
        let [a, b] = self.turned(x, y);
        format!("({a}, {b})")
    }

    fn pose(self, [x, y, phi]: [f64; 3]) -> String {
        let [a, b] = self.turned(x, y);
        format!("({}, {}, {})", self.x + a, self.y + b, self.angle + phi)
    }
}

fn places() -> impl Strategy<Value = Place> {
    (-5.0..5.0, -5.0..5.0, -3.0..3.0).prop_map(|(x, y, angle)| Place { x, y, angle })
}

/// A crank's motion: `start + speed t + gain t²/2`.
#[derive(Clone, Copy, Debug)]
struct Drive {
    start: f64,
    speed: f64,
    gain: f64,
}

fn drives() -> impl Strategy<Value = Drive> {
    (-3.0..3.0, prop_oneof![-4.0..-1.0, 1.0..4.0], -2.0..2.0).prop_map(|(start, speed, gain)| Drive {
        start,
        speed,
        gain,
    })
}

impl Drive {
    fn formula(self, place: Place) -> String {
        let Drive { start, speed, gain } = self;
        format!("{} + {speed} * t + {} * t^2", place.angle + start, 0.5 * gain)
    }
}

/// A sketch is a little off.
const OFF: f64 = 0.02;

#[derive(Clone, Copy, Debug)]
struct FourBar {
    ground: f64,
    crank: f64,
    coupler: f64,
    rocker: f64,
    /// To the left of the line from the crank's pin to the rocker's pivot.
    left: bool,
    drive: Drive,
}

/// Crank-rockers by Grashof's rule, well within it.
fn four_bars() -> impl Strategy<Value = FourBar> {
    let link = 1.2..4.0_f64;
    (0.3..1.5, [link.clone(), link.clone(), link], any::<bool>(), drives()).prop_filter_map(
        "no crank-rocker",
        |(crank, [ground, coupler, rocker], left, drive): (f64, [f64; 3], _, _)| {
            let longest = ground.max(coupler).max(rocker);
            let rest = ground + coupler + rocker - longest;
            let shortest = ground.min(coupler).min(rocker);
            (crank < 0.9 * shortest && crank + longest < rest - 0.2 * crank).then_some(FourBar {
                ground,
                crank,
                coupler,
                rocker,
                left,
                drive,
            })
        },
    )
}

impl FourBar {
    fn text(&self, place: Place) -> String {
        let FourBar { ground, crank, coupler, rocker, left, drive } = *self;
        let (sin, cos) = math::sin_cos(drive.start);
        let [cx, cy] = [crank * cos, crank * sin];
        let [dx, dy] = [ground - cx, -cy];
        let square = dx * dx + dy * dy;
        let along = (coupler * coupler - rocker * rocker + square) / (2.0 * square);
        let aside = math::sqrt(coupler * coupler / square - along * along) * if left { 1.0 } else { -1.0 };
        let [ux, uy] = [along * dx - aside * dy, along * dy + aside * dx];
        let [wx, wy] = [ux - dx, uy - dy];
        format!(
            "mechanism four_bar {{
                ground {{ point A = {} point B = {} }}
                body crank at {} {{ point A = (0, 0) point C = ({crank}, 0) }}
                body coupler at {} {{ point C = (0, 0) point D = ({coupler}, 0) point P = (0.7, 0.4) }}
                body rocker at {} {{ point B = (0, 0) point D = ({rocker}, 0) }}
                joint main: revolute(ground.A, crank.A)
                joint pin: revolute(crank.C, coupler.C)
                joint knee: revolute(coupler.D, rocker.D)
                joint pivot: revolute(ground.B, rocker.B)
                driver motor: rotation(main) = {}
                measure swing = angle(crank, rocker)
                measure reach = distance(ground.A, coupler.P)
                analysis from 0 to 2 every 0.1
            }}",
            place.point(0.0, 0.0),
            place.point(ground, 0.0),
            place.pose([0.0, OFF, drive.start]),
            place.pose([cx + OFF, cy, math::atan2(uy, ux) - OFF]),
            place.pose([ground, -OFF, math::atan2(wy, wx) + OFF]),
            drive.formula(place),
        )
    }
}

#[derive(Clone, Copy, Debug)]
struct SliderCrank {
    crank: f64,
    rod: f64,
    /// Offset of the guide to the left of the crank's axis.
    offset: f64,
    /// The slider is before the crank's axis, or behind it.
    before: bool,
    drive: Drive,
}

fn slider_cranks() -> impl Strategy<Value = SliderCrank> {
    (0.3..1.5, 0.1..3.0, -0.8..0.8, any::<bool>(), drives()).prop_map(|(crank, more, offset, before, drive)| {
        SliderCrank { crank, rod: crank + f64::abs(offset) + more, offset, before, drive }
    })
}

/// A quantity with its first and second time derivative.
type Jet = [f64; 3];

impl SliderCrank {
    /// In the columns' order: crank, rod, slider, each x, y, phi.
    fn closed_form(&self, t: f64) -> [Jet; 9] {
        let SliderCrank { crank, rod, offset, before, drive } = *self;
        let side = if before { 1.0 } else { -1.0 };
        let theta = drive.start + t * (drive.speed + 0.5 * t * drive.gain);
        let (d, dd) = (drive.speed + t * drive.gain, drive.gain);
        let (sin, cos) = math::sin_cos(theta);
        let x = [crank * cos, -crank * sin * d, -crank * (cos * d * d + sin * dd)];
        let y = [crank * sin, crank * cos * d, crank * (cos * dd - sin * d * d)];
        // the rod's height and its way along the guide: h² + w² = rod²
        let h = [offset - y[0], -y[1], -y[2]];
        let w0 = side * math::sqrt(rod * rod - h[0] * h[0]);
        let w1 = -h[0] * h[1] / w0;
        let w2 = -(h[1] * h[1] + h[0] * h[2] + w1 * w1) / w0;
        // sin φ = h/rod, cos φ = w/rod
        let phi = [math::atan2(h[0], w0), h[1] / w0, (h[2] * w0 - h[1] * w1) / (w0 * w0)];
        let still = [0.0; 3];
        [still, still, [theta, d, dd], x, y, phi, [x[0] + w0, x[1] + w1, x[2] + w2], [offset, 0.0, 0.0], still]
    }

    fn text(&self, place: Place) -> String {
        let SliderCrank { crank, rod, offset, drive, .. } = *self;
        let start = self.closed_form(0.0).map(|[value, ..]| value);
        format!(
            "mechanism slider_crank {{
                ground {{ point O = {} axis way = {} along {} }}
                body crank at {} {{ point O = (0, 0) point pin = ({crank}, 0) }}
                body rod at {} {{ point pin = (0, 0) point wrist = ({rod}, 0) }}
                body slider at {} {{ point wrist = (0, 0) axis way = wrist along (1, 0) }}
                joint main: revolute(ground.O, crank.O)
                joint big: revolute(crank.pin, rod.pin)
                joint small: revolute(rod.wrist, slider.wrist)
                joint guide: translational(ground.way, slider.way)
                driver motor: rotation(main) = {}
                measure travel = displacement(guide)
                analysis from 0 to 2 every 0.1
            }}",
            place.point(0.0, 0.0),
            place.point(0.3, offset),
            place.direction(1.7, 0.0),
            place.pose([OFF, 0.0, start[2] - OFF]),
            place.pose([start[3], start[4] + OFF, start[5] + OFF]),
            place.pose([start[6] - OFF, start[7], OFF]),
            drive.formula(place),
        )
    }
}

/// The answer at a place is the answer at home, moved there.
fn moved(bodies: &[&str], text: impl Fn(Place) -> String, place: Place) -> Result<(), TestCaseError> {
    let home = run("home", &text(HOME), Span::default());
    prop_assert!(home.succeeded(), "{}", home.text());
    let away = run("away", &text(place), Span::default());
    prop_assert!(away.succeeded(), "{}", away.text());
    let back = Place { angle: -place.angle, ..HOME };
    for order in ["", ".d", ".dd"] {
        let shift = f64::from(order.is_empty());
        for body in bodies {
            let column = |of: &Outcome, name: &str| of.column(&format!("{body}.{name}{order}"));
            let points = column(&away, "x").into_iter().zip(column(&away, "y"));
            let (x, y): (Vec<f64>, Vec<f64>) =
                points.map(|(x, y)| back.turned(x - shift * place.x, y - shift * place.y).into()).unzip();
            let phi: Vec<f64> = column(&away, "phi").iter().map(|phi| phi - shift * place.angle).collect();
            for (name, values) in [("x", x), ("y", y), ("phi", phi)] {
                near(&format!("{body}.{name}{order}"), &values, &column(&home, name), 1e-9)?;
            }
        }
    }
    // what is measured within does not depend on the place
    for column in home.columns.iter().filter(|column| !bodies.iter().any(|body| column.starts_with(body))) {
        near(column, &away.column(column), &home.column(column), 1e-9)?;
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(64))]

    #[test]
    fn four_bar_motion_is_frame_invariant(four_bar in four_bars(), place in places()) {
        moved(&["crank", "coupler", "rocker"], |place| four_bar.text(place), place)?;
    }

    #[test]
    fn slider_crank_motion_is_frame_invariant(slider_crank in slider_cranks(), place in places()) {
        moved(&["crank", "rod", "slider"], |place| slider_crank.text(place), place)?;
    }

    #[test]
    fn a_slider_crank_has_a_closed_form(slider_crank in slider_cranks()) {
        let got = run("slider_crank", &slider_crank.text(HOME), Span::default());
        prop_assert!(got.succeeded(), "{}", got.text());
        let names = ["crank", "rod", "slider"].map(|body| ["x", "y", "phi"].map(|name| format!("{body}.{name}")));
        let jets: Vec<[Jet; 9]> = got.column("t").iter().map(|&t| slider_crank.closed_form(t)).collect();
        for (k, name) in names.as_flattened().iter().enumerate() {
            for (order, ending) in ["", ".d", ".dd"].into_iter().enumerate() {
                let want: Vec<f64> = jets.iter().map(|jet| jet[k][order]).collect();
                let mut values = got.column(&format!("{name}{ending}"));
                if name == "rod.phi" && order == 0 {
                    // the closed form is in (−π, π], the motion counts turns
                    for (value, want) in values.iter_mut().zip(&want) {
                        *value -= TAU * ((*value - want) / TAU).round();
                    }
                }
                near(&format!("{name}{ending}"), &values, &want, 1e-9)?;
            }
        }
    }
}
