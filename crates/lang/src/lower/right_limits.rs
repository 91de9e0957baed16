//! Right limits: the value of a formula just after a state of the motion, which at a jump is that of the later side.
//!
//! A comparison of equal values, the sign of zero and the floor of an integer follow the rate of their operands or, if that is zero, its
//! derivative. Values are equal if their difference is within the change during a negligible time, as output times and states are rounded.
//! A rate is zero if it is within the rounding of the motion's rates, so that a dwell does not count as slow motion.

use super::Lowering;
use mechc_expr::{Binary, Comparison, ExprId, Graph, Node, Symbol, Unary};
use mechc_ir::limits::DEFAULT_SPAN;
use mechc_ir::{ConstraintSystem, Coordinate};

/// The condition of a load is zero if its change over this part of the span exceeds its value: the load jumps here.
const LATER_AT_ONCE: f64 = 1e-12;
/// The condition of a load is zero where it comes to rest if the change of its rate over this part of the span exceeds the rate.
const LATER_AT_REST: f64 = 1e-8;
/// A value is rounding if it is below this part of what it would be with all coordinates and rates at their largest.
const LATER_ROUNDING: f64 = 1e-12;

impl Lowering<'_> {
    /// Returns a formula of the motion with its jumps decided for the time just after the state.
    pub(super) fn right_limit(&mut self, formula: ExprId) -> ExprId {
        let span = self.model.analysis.map_or(DEFAULT_SPAN, |analysis| analysis.to - analysis.from);
        let highest = if self.has_signals() { 2 } else { 3 };
        let span = if span > 0.0 { span } else { DEFAULT_SPAN };
        let mut limits = RightLimits { span, highest, coordinates: &self.coordinates, rate_sums: &mut self.rate_sums };
        self.graph.rewritten(formula, |graph, node, plain| limits.rewrite(graph, node, plain))
    }
}

/// Sums by order of the derivative that measure how fast the mechanism moves: 1, and the sums of the scaled first, second and third
/// derivatives of all coordinates, including those that proportional coordinates could have (1/s, 1/s², 1/s³).
pub(super) type RateSums = [ExprId; 4];

/// The context in which formulas are replaced by their right limits.
struct RightLimits<'l> {
    /// The duration of the analysis (s).
    span: f64,
    /// The highest available order of the coordinates' derivatives.
    highest: u8,
    coordinates: &'l [Coordinate],
    rate_sums: &'l mut Option<RateSums>,
}

/// The test whether a number is zero, to rounding.
struct ZeroTest {
    /// True if it is.
    is_zero: ExprId,
    /// A number with the sign of the right limit, where the number is zero.
    sign: ExprId,
}

impl RightLimits<'_> {
    /// Returns the right limit of a node; `None` if it equals the node.
    fn rewrite(&mut self, graph: &mut Graph, node: Node, plain: ExprId) -> Option<ExprId> {
        let zero = graph.constant(0.0);
        match node {
            Node::Compare(comparison @ (Comparison::Less | Comparison::LessEqual), a, b) => {
                let difference = graph.sub(a, b);
                let test = self.zero_test(graph, difference, difference)?;
                let limit = graph.compare(comparison, test.sign, zero);
                Some(graph.select(test.is_zero, limit, plain))
            }
            Node::Unary(Unary::Sign, a) => {
                let test = self.zero_test(graph, a, a)?;
                let limit = graph.unary(Unary::Sign, test.sign);
                Some(graph.select(test.is_zero, limit, plain))
            }
            Node::Unary(Unary::Floor, a) => {
                let (whole, past) = split_at_nearest_integer(graph, a);
                let test = self.zero_test(graph, past, a)?;
                let one = graph.constant(1.0);
                let below = graph.sub(whole, one);
                let falls = graph.compare(Comparison::Less, test.sign, zero);
                let limit = graph.select(falls, below, whole);
                Some(graph.select(test.is_zero, limit, plain))
            }
            Node::Binary(Binary::Mod, a, b) => {
                let turns = graph.div(a, b);
                let (_, past) = split_at_nearest_integer(graph, turns);
                let test = self.zero_test(graph, past, turns)?;
                let falls = graph.compare(Comparison::Less, test.sign, zero);
                let limit = graph.select(falls, b, zero);
                Some(graph.select(test.is_zero, limit, plain))
            }
            _ => None,
        }
    }

    /// Tests a number that changes at the rate of `rate_of`. Returns `None` if it does not change or its rate is not available.
    fn zero_test(&mut self, graph: &mut Graph, number: ExprId, rate_of: ExprId) -> Option<ZeroTest> {
        let rate = self.rate(graph, rate_of)?;
        let by_rate = is_within(graph, number, rate, LATER_AT_ONCE * self.span);
        let is_rounding = self.is_rounding(graph, number, rate_of);
        let is_zero = graph.or(by_rate, is_rounding);
        let (zero, rate_is_rounding) = (graph.constant(0.0), self.is_rounding(graph, rate, rate));
        let Some(bend) = self.rate(graph, rate) else {
            let sign = graph.select(rate_is_rounding, zero, rate);
            return Some(ZeroTest { is_zero, sign });
        };
        let little = LATER_AT_REST * self.span;
        let (touches, rests) =
            (is_within(graph, number, bend, 0.5 * little * little), is_within(graph, rate, bend, little));
        let by_bend = graph.and(touches, rests);
        let is_calm = graph.and(is_zero, rate_is_rounding);
        let by_bend = graph.or(by_bend, is_calm);
        let bend_is_rounding = self.is_rounding(graph, bend, bend);
        let bend = graph.select(bend_is_rounding, zero, bend);
        let sign = graph.select(by_bend, bend, rate);
        Some(ZeroTest { is_zero: graph.or(by_bend, is_zero), sign })
    }

    /// Returns whether a number that changes at the rate of `rate_of` is within the rounding of the coordinates and their rates. If it
    /// depends on time alone, only zero is.
    fn is_rounding(&mut self, graph: &mut Graph, number: ExprId, rate_of: ExprId) -> ExprId {
        let mut most = graph.constant(0.0);
        for order in 0..=self.highest {
            for (k, slope) in graph.slopes(rate_of, order) {
                let scale = graph.constant(self.coordinates[k as usize].scale);
                let slope = graph.unary(Unary::Abs, slope);
                let (share, rate_sums) = (graph.mul(slope, scale), self.rate_sums(graph)[usize::from(order)]);
                let share = graph.mul(share, rate_sums);
                most = graph.add(most, share);
            }
        }
        is_within(graph, number, most, LATER_ROUNDING)
    }

    /// Returns the sums of rates of all coordinates.
    fn rate_sums(&mut self, graph: &mut Graph) -> RateSums {
        let (coordinates, highest) = (self.coordinates, self.highest);
        *self.rate_sums.get_or_insert_with(|| {
            let sum = |graph: &mut Graph, order: u8| {
                let mut sum = graph.constant(0.0);
                for (index, coordinate) in (0..).zip(coordinates).filter(|_| order <= highest) {
                    let rate = graph.symbol(Symbol::Coordinate { index, order });
                    let (rate, share) = (graph.unary(Unary::Abs, rate), graph.constant(1.0 / coordinate.scale));
                    let rate = graph.mul(share, rate);
                    sum = graph.add(sum, rate);
                }
                sum
            };
            let [first, second, third] = [1, 2, 3].map(|order| sum(graph, order));
            let bent = graph.mul(first, first);
            let second = graph.add(second, bent);
            let bent = graph.mul(first, second);
            [graph.constant(1.0), first, second, graph.add(third, bent)]
        })
    }

    /// Returns the time derivative of an expression; `None` if it is zero or not available.
    fn rate(&self, graph: &mut Graph, of: ExprId) -> Option<ExprId> {
        let is_last = |symbol: &Symbol| matches!(symbol, Symbol::Signal { order: 2.., .. });
        if graph.dependence(of).highest_order() >= Some(self.highest) || graph.symbols(of).iter().any(is_last) {
            return None;
        }
        let rate = ConstraintSystem::time_derivatives(graph, &[of], self.highest)[0];
        (!graph.is_zero(rate)).then_some(rate)
    }
}

/// Returns the integer nearest to a number, and the number minus that.
fn split_at_nearest_integer(graph: &mut Graph, number: ExprId) -> (ExprId, ExprId) {
    let half = graph.constant(0.5);
    let above = graph.add(number, half);
    let whole = graph.unary(Unary::Floor, above);
    (whole, graph.sub(number, whole))
}

/// Returns whether `|number| ≤ |times · other|`.
fn is_within(graph: &mut Graph, number: ExprId, other: ExprId, times: f64) -> ExprId {
    let times = graph.constant(times);
    let most = graph.mul(times, other);
    let [number, most] = [number, most].map(|of| graph.unary(Unary::Abs, of));
    graph.compare(Comparison::LessEqual, number, most)
}
