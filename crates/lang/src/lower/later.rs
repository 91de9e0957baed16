//! What a formula is right behind a state of the motion: at a jump of it the later side counts.
//!
//! A comparison of what is as large, a sign of nothing and a floor at a whole number are decided by how what they ask of changes with time;
//! where that rests as well, by how its rate does. What is off by no more than it changes in no time at all is as large: no output time
//! and no state is exacter than rounding. What is no more than rounding of the motion around it rests: a dwell is no slow motion.

use super::Lowering;
use mechc_expr::{Binary, Comparison, ExprId, Graph, Node, Symbol, Unary};
use mechc_ir::tolerances::UNTOLD_SPAN;
use mechc_ir::tolerances::jumps::{LATER_AT_ONCE, LATER_AT_REST, LATER_ROUNDING};
use mechc_ir::{ConstraintSystem, Coordinate};

impl Lowering<'_> {
    /// A formula of the motion, its jumps as they are right behind the state.
    pub(super) fn later_side(&mut self, formula: ExprId) -> ExprId {
        let span = self.model.analysis.map_or(UNTOLD_SPAN, |analysis| analysis.to - analysis.from);
        let highest = if self.model.has_signals { 2 } else { 3 };
        let span = if span > 0.0 { span } else { UNTOLD_SPAN };
        let mut behind = Behind { span, highest, coordinates: &self.coordinates, pace: &mut self.pace };
        self.graph.rewritten(formula, |graph, node, plain| behind.of(graph, node, plain))
    }
}

/// How fast everything moves, by order of the derivative: 1, and the sums of all rates, second and third ones that coordinates have or
/// could have in proportion (1/s, 1/s², 1/s³).
pub(super) type Pace = [ExprId; 4];

/// How formulas are looked at right behind a state.
struct Behind<'l> {
    /// For how long the motion is looked at (s).
    span: f64,
    /// The highest derivatives of coordinates that are known.
    highest: u8,
    coordinates: &'l [Coordinate],
    pace: &'l mut Option<Pace>,
}

/// A number that may be nothing, to rounding.
struct Nothing {
    /// Whether it is.
    is_so: ExprId,
    /// What has its sign right behind, where it is.
    behind: ExprId,
}

impl Behind<'_> {
    /// What an operation is right behind the state, where that may be something else than what it is there.
    fn of(&mut self, graph: &mut Graph, node: Node, plain: ExprId) -> Option<ExprId> {
        let zero = graph.constant(0.0);
        match node {
            Node::Compare(comparison @ (Comparison::Less | Comparison::LessEqual), a, b) => {
                let difference = graph.sub(a, b);
                let nothing = self.nothing(graph, difference, difference)?;
                let behind = graph.compare(comparison, nothing.behind, zero);
                Some(graph.select(nothing.is_so, behind, plain))
            }
            Node::Unary(Unary::Sign, a) => {
                let nothing = self.nothing(graph, a, a)?;
                let behind = graph.unary(Unary::Sign, nothing.behind);
                Some(graph.select(nothing.is_so, behind, plain))
            }
            Node::Unary(Unary::Floor, a) => {
                let (whole, past) = past_whole(graph, a);
                let nothing = self.nothing(graph, past, a)?;
                let one = graph.constant(1.0);
                let below = graph.sub(whole, one);
                let falls = graph.compare(Comparison::Less, nothing.behind, zero);
                let behind = graph.select(falls, below, whole);
                Some(graph.select(nothing.is_so, behind, plain))
            }
            Node::Binary(Binary::Mod, a, b) => {
                let turns = graph.div(a, b);
                let (_, past) = past_whole(graph, turns);
                let nothing = self.nothing(graph, past, turns)?;
                let falls = graph.compare(Comparison::Less, nothing.behind, zero);
                let behind = graph.select(falls, b, zero);
                Some(graph.select(nothing.is_so, behind, plain))
            }
            _ => None,
        }
    }

    /// A number that changes as another one does: whether it is nothing, and which sign it has right behind. None where it does not change,
    /// or where nobody knows how.
    fn nothing(&mut self, graph: &mut Graph, number: ExprId, as_this: ExprId) -> Option<Nothing> {
        let rate = self.rate(graph, as_this)?;
        let by_rate = is_within(graph, number, rate, LATER_AT_ONCE * self.span);
        let is_rounding = self.is_rounding(graph, number, as_this);
        let is_so = graph.or(by_rate, is_rounding);
        let (zero, rate_is_rounding) = (graph.constant(0.0), self.is_rounding(graph, rate, rate));
        let Some(bend) = self.rate(graph, rate) else {
            let behind = graph.select(rate_is_rounding, zero, rate);
            return Some(Nothing { is_so, behind });
        };
        let little = LATER_AT_REST * self.span;
        let (touches, rests) =
            (is_within(graph, number, bend, 0.5 * little * little), is_within(graph, rate, bend, little));
        let by_bend = graph.and(touches, rests);
        let is_calm = graph.and(is_so, rate_is_rounding);
        let by_bend = graph.or(by_bend, is_calm);
        let bend_is_rounding = self.is_rounding(graph, bend, bend);
        let bend = graph.select(bend_is_rounding, zero, bend);
        let behind = graph.select(by_bend, bend, rate);
        Some(Nothing { is_so: graph.or(by_bend, is_so), behind })
    }

    /// Whether a number that changes with the coordinates and their rates as another one does is no more than the rounding that these have
    /// beside each other. Nothing but a zero is, of what time alone decides.
    fn is_rounding(&mut self, graph: &mut Graph, number: ExprId, as_this: ExprId) -> ExprId {
        let mut most = graph.constant(0.0);
        for order in 0..=self.highest {
            for (k, slope) in graph.slopes(as_this, order) {
                let scale = graph.constant(self.coordinates[k as usize].scale);
                let slope = graph.unary(Unary::Abs, slope);
                let (share, pace) = (graph.mul(slope, scale), self.pace(graph)[usize::from(order)]);
                let share = graph.mul(share, pace);
                most = graph.add(most, share);
            }
        }
        is_within(graph, number, most, LATER_ROUNDING)
    }

    /// How fast everything moves.
    fn pace(&mut self, graph: &mut Graph) -> Pace {
        let (coordinates, highest) = (self.coordinates, self.highest);
        *self.pace.get_or_insert_with(|| {
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

    /// How something changes with time; none where it does not, or where nobody knows.
    fn rate(&self, graph: &mut Graph, of: ExprId) -> Option<ExprId> {
        let is_last = |symbol: &Symbol| matches!(symbol, Symbol::Signal { order: 2.., .. });
        if graph.dependence(of).highest_order() >= Some(self.highest) || graph.symbols(of).iter().any(is_last) {
            return None;
        }
        let rate = ConstraintSystem::time_derivatives(graph, &[of], self.highest)[0];
        (!graph.is_zero(rate)).then_some(rate)
    }
}

/// The whole number that is next to a number, and how far past that it is.
fn past_whole(graph: &mut Graph, number: ExprId) -> (ExprId, ExprId) {
    let half = graph.constant(0.5);
    let above = graph.add(number, half);
    let whole = graph.unary(Unary::Floor, above);
    (whole, graph.sub(number, whole))
}

/// Whether a number is no larger than so many times another one.
fn is_within(graph: &mut Graph, number: ExprId, other: ExprId, times: f64) -> ExprId {
    let times = graph.constant(times);
    let most = graph.mul(times, other);
    let [number, most] = [number, most].map(|of| graph.unary(Unary::Abs, of));
    graph.compare(Comparison::LessEqual, number, most)
}
