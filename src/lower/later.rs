//! What a formula is right behind a state of the motion: at a jump of it the later side counts.
//!
//! A comparison whose sides are equal, a sign of zero and a floor at a whole number are decided by how what they ask of changes with time.

use super::Lowering;
use crate::expr::{Binary, Comparison, ExprId, Graph, Node, Unary};
use crate::ir::ConstraintSystem;

impl Lowering<'_> {
    /// A formula of the motion, its jumps as they are right behind the state.
    pub(super) fn later_side(&mut self, formula: ExprId) -> ExprId {
        self.graph.rewritten(formula, later)
    }
}

/// What an operation is right behind the state, where that may be something else than what it is there.
fn later(graph: &mut Graph, node: Node, plain: ExprId) -> Option<ExprId> {
    let zero = graph.constant(0.0);
    match node {
        Node::Compare(comparison @ (Comparison::Less | Comparison::LessEqual), a, b) => {
            let difference = graph.sub(a, b);
            let rate = rate(graph, difference)?;
            let (is_even, behind) = (graph.compare(Comparison::Equal, a, b), graph.compare(comparison, rate, zero));
            Some(graph.select(is_even, behind, plain))
        }
        Node::Unary(Unary::Sign, a) => {
            let rate = rate(graph, a)?;
            let (is_zero, behind) = (graph.compare(Comparison::Equal, a, zero), graph.unary(Unary::Sign, rate));
            Some(graph.select(is_zero, behind, plain))
        }
        Node::Unary(Unary::Floor, a) => {
            let rate = rate(graph, a)?;
            let (is_whole, one) = (graph.compare(Comparison::Equal, a, plain), graph.constant(1.0));
            let (falls, below) = (graph.compare(Comparison::Less, rate, zero), graph.sub(plain, one));
            let is_below = graph.and(is_whole, falls);
            Some(graph.select(is_below, below, plain))
        }
        Node::Binary(Binary::Mod, a, b) => {
            let turns = graph.div(a, b);
            let rate = rate(graph, turns)?;
            let (is_whole, falls) =
                (graph.compare(Comparison::Equal, plain, zero), graph.compare(Comparison::Less, rate, zero));
            let is_below = graph.and(is_whole, falls);
            Some(graph.select(is_below, b, plain))
        }
        _ => None,
    }
}

/// How something changes with time; none where it does not, or where nobody knows.
fn rate(graph: &mut Graph, of: ExprId) -> Option<ExprId> {
    if graph.dependence(of).highest_order() > Some(1) {
        return None;
    }
    let rate = ConstraintSystem::time_derivatives(graph, &[of], 2)[0];
    (!graph.is_zero(rate)).then_some(rate)
}
