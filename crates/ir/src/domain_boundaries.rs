//! Boundaries of the domains of functions in the equations, such as the zero of a radicand, each as an event function.

use super::{ConstraintSystem, DeclarationId};
use mechc_expr::{Binary, ExprId, Graph, Node, Unary};
use rustc_hash::FxHashMap;

/// A boundary of the domain of a function in the equations, at which a formula may end or have an edge.
#[derive(Clone, Debug)]
pub struct DomainBoundary {
    /// Event function, zero at the boundary: the radicand of a root, `1 − a²` for an arc sine, a denominator.
    pub gauge: ExprId,
    /// Time derivative of `gauge` along the motion; it changes sign where `gauge` only touches zero.
    pub slope: ExprId,
    /// Declarations whose equations contain the formula, ascending.
    pub declarations: Vec<DeclarationId>,
}

impl ConstraintSystem {
    /// Finds the domain boundaries of all equations.
    pub(super) fn find_domain_boundaries(&mut self) {
        let mut gauges: FxHashMap<ExprId, ExprId> = FxHashMap::default();
        let nodes: Vec<(ExprId, Node)> = self.graph.nodes().collect();
        for (id, node) in nodes {
            // formulas of parameters alone have no edge in time
            if self.graph.dependence(id).is_constant() {
                continue;
            }
            if let Some(gauge) = gauge(&mut self.graph, id, node) {
                gauges.insert(id, gauge);
            }
        }
        self.domain_boundaries = Vec::new();
        if gauges.is_empty() {
            return;
        }
        let mut index_of: FxHashMap<ExprId, usize> = FxHashMap::default();
        for row in 0..self.rows.len() {
            let declaration = self.rows[row].declaration;
            for id in self.graph.reachable(&[self.rows[row].phi]) {
                let Some(&gauge) = gauges.get(&id) else {
                    continue;
                };
                let index = *index_of.entry(gauge).or_insert_with(|| {
                    let slope = Self::time_derivatives(&mut self.graph, &[gauge], 1)[0];
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

/// Returns the quantity whose zero is the end of the domain of a node's function, or a pole of it.
fn gauge(graph: &mut Graph, id: ExprId, node: Node) -> Option<ExprId> {
    let gauge = match node {
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
