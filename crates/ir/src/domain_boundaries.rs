//! Boundaries of the domains of functions in the equations, such as the zero of a radicand, each as an event function.

use super::{ConstraintSystem, DeclarationId, Row};
use mechc_expr::{Binary, ExprId, Graph, Node, Unary};
use rustc_hash::FxHashMap;

/// A boundary of the domain of a function in the equations, at which a formula may end or have an edge.
#[derive(Clone, Debug)]
pub struct DomainBoundary {
    /// Event function, zero at the boundary: the radicand of a root, `1 − a²` for an arc sine, a denominator. Where the motion decides, it is 1
    /// while the formula is in a branch that is not taken.
    pub gauge: ExprId,
    /// Time derivative of `gauge`, which changes sign where `gauge` only touches zero; `None` where the motion decides.
    pub slope: Option<ExprId>,
    /// Declarations whose equations contain the formula, ascending.
    pub declarations: Vec<DeclarationId>,
}

impl ConstraintSystem {
    /// Finds the domain boundaries of all equations.
    pub(super) fn find_domain_boundaries(&mut self) {
        self.domain_boundaries = Vec::new();
        let mut index_of: FxHashMap<ExprId, usize> = FxHashMap::default();
        for row in 0..self.rows.len() {
            let Row { declaration, phi, .. } = self.rows[row];
            for gauge in gauges(&mut self.graph, phi) {
                let index = *index_of.entry(gauge).or_insert_with(|| {
                    let graph = &mut self.graph;
                    let is_of_time = graph.dependence(gauge).highest_order().is_none();
                    let slope = is_of_time.then(|| Self::time_derivatives(graph, &[gauge], 1)[0]);
                    self.domain_boundaries.push(DomainBoundary { gauge, slope, declarations: Vec::new() });
                    self.domain_boundaries.len() - 1
                });
                let declarations = &mut self.domain_boundaries[index].declarations;
                if declarations.last() != Some(&declaration) {
                    declarations.push(declaration);
                }
            }
        }
    }
}

/// Returns the event functions of a formula.
fn gauges(graph: &mut Graph, formula: ExprId) -> Vec<ExprId> {
    let nodes = graph.reachable(&[formula]);
    let gauge_of = |&id: &ExprId| {
        // formulas of parameters alone have no edge in time
        let is_constant = graph.dependence(id).is_constant();
        if is_constant { None } else { gauge(graph, id).map(|gauge| (id, gauge)) }
    };
    let mut found: Vec<(ExprId, ExprId)> = nodes.iter().filter_map(gauge_of).collect();
    let is_of_motion = |graph: &Graph, gauge: ExprId| graph.dependence(gauge).highest_order().is_some();
    if found.iter().any(|(_, gauge)| is_of_motion(graph, *gauge)) {
        let (taken, one) = (conditions_to_be_taken(graph, &nodes, formula), graph.constant(1.0));
        for (id, gauge) in &mut found {
            if let (true, Some(&Some(condition))) = (is_of_motion(graph, *gauge), taken.get(id)) {
                *gauge = graph.select(condition, *gauge, one);
            }
        }
    }
    found.into_iter().map(|(_, gauge)| gauge).collect()
}

/// Returns the condition under which the branches of a formula lead to each of its nodes; `None` for one that is always evaluated.
fn conditions_to_be_taken(graph: &mut Graph, nodes: &[ExprId], formula: ExprId) -> FxHashMap<ExprId, Option<ExprId>> {
    let mut taken: FxHashMap<ExprId, Option<ExprId>> = FxHashMap::default();
    taken.insert(formula, None);
    let mut descending = nodes.to_vec();
    // a node stands behind its operands
    descending.sort_unstable_by(|a, b| b.cmp(a));
    for id in descending {
        let outer = taken.get(&id).copied().flatten();
        let node = graph.node(id);
        for (number, &child) in node.children().as_slice().iter().enumerate() {
            let condition = match node {
                Node::Select(condition, ..) if number > 0 => {
                    let own = if number == 1 { condition } else { graph.not(condition) };
                    Some(outer.map_or(own, |outer| graph.and(outer, own)))
                }
                _ => outer,
            };
            let either = match (taken.get(&child), condition) {
                (Some(None), _) | (_, None) => None,
                (Some(Some(before)), Some(condition)) => Some(graph.or(*before, condition)),
                (None, condition) => condition,
            };
            taken.insert(child, either);
        }
    }
    taken
}

/// Returns the quantity whose zero is the end of the domain of a node's function, or a pole of it.
fn gauge(graph: &mut Graph, id: ExprId) -> Option<ExprId> {
    let gauge = match graph.node(id) {
        Node::Unary(Unary::Sqrt | Unary::Ln | Unary::Log10, a) | Node::Binary(Binary::Pow, a, _) => a,
        Node::Power(a, n) if n < 0 => a,
        Node::Div(_, b) => b,
        Node::Unary(Unary::Asin | Unary::Acos, a) => {
            let (one, square) = (graph.constant(1.0), graph.power(a, 2));
            graph.sub(one, square)
        }
        // cos², computed from the tangent
        Node::Unary(Unary::Tan, _) => {
            let (one, square) = (graph.constant(1.0), graph.power(id, 2));
            let steepness = graph.add(one, square);
            graph.div(one, steepness)
        }
        Node::Binary(Binary::Hypot, a, b) => square_of_hypot(graph, a, b),
        // zero on the branch cut, where the angle jumps by a turn, and at the origin
        Node::Binary(Binary::Atan2, y, x) => {
            let distance = graph.binary(Binary::Hypot, x, y);
            graph.add(x, distance)
        }
        _ => return None,
    };
    let gauge = smoothed(graph, gauge);
    (!graph.dependence(gauge).is_constant()).then_some(gauge)
}

/// Returns a quantity with the same zeros that is smooth there: without constant factors and roots.
fn smoothed(graph: &mut Graph, mut gauge: ExprId) -> ExprId {
    loop {
        gauge = match graph.node(gauge) {
            Node::Neg(a) | Node::Unary(Unary::Sqrt, a) => a,
            Node::Mul(a, b) if graph.dependence(a).is_constant() => b,
            Node::Binary(Binary::Hypot, a, b) => square_of_hypot(graph, a, b),
            _ => return gauge,
        }
    }
}

fn square_of_hypot(graph: &mut Graph, a: ExprId, b: ExprId) -> ExprId {
    let (a, b) = (graph.power(a, 2), graph.power(b, 2));
    graph.add(a, b)
}
