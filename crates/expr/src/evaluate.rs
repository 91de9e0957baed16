//! Evaluation of single operations, and of whole formulas where speed does not matter.

use super::{Binary, Comparison, ExprId, Graph, Node, Symbol, Unary};
use crate::math;

/// Returns the value of a function of one argument.
#[must_use]
pub fn unary_value(function: Unary, x: f64) -> f64 {
    match function {
        Unary::Sin => math::sin(x),
        Unary::Cos => math::cos(x),
        Unary::Tan => math::tan(x),
        Unary::Asin => math::asin(x),
        Unary::Acos => math::acos(x),
        Unary::Atan => math::atan(x),
        Unary::Sinh => math::sinh(x),
        Unary::Cosh => math::cosh(x),
        Unary::Tanh => math::tanh(x),
        Unary::Exp => math::exp(x),
        Unary::Ln => math::ln(x),
        Unary::Log10 => math::log10(x),
        Unary::Sqrt => math::sqrt(x),
        Unary::Abs => x.abs(),
        Unary::Sign => math::sign(x),
        Unary::Floor => math::floor(x),
    }
}

/// Returns the value of a function of two arguments.
#[must_use]
pub fn binary_value(function: Binary, x: f64, y: f64) -> f64 {
    match function {
        Binary::Atan2 => math::atan2(x, y),
        Binary::Hypot => math::hypot(x, y),
        Binary::Min => math::min(x, y),
        Binary::Max => math::max(x, y),
        Binary::Pow => math::pow(x, y),
        Binary::Mod => math::modulo(x, y),
    }
}

/// Returns 1 if the comparison holds, else 0.
#[must_use]
pub fn compare(comparison: Comparison, x: f64, y: f64) -> f64 {
    f64::from(match comparison {
        Comparison::Less => x < y,
        Comparison::LessEqual => x <= y,
        // exact, as the text states it
        #[allow(clippy::float_cmp)]
        Comparison::Equal => x == y,
    })
}

impl Graph {
    /// Returns the value of a node from the values of its operands.
    #[must_use]
    pub fn node_value(&self, node: Node, operand: impl Fn(ExprId) -> f64, symbol: impl Fn(Symbol) -> f64) -> f64 {
        match node {
            Node::Const(bits) => f64::from_bits(bits),
            Node::Symbol(s) => symbol(s),
            Node::Add(a, b) => operand(a) + operand(b),
            Node::Sub(a, b) => operand(a) - operand(b),
            Node::Mul(a, b) => operand(a) * operand(b),
            Node::Div(a, b) => operand(a) / operand(b),
            Node::Neg(a) => -operand(a),
            Node::Power(a, n) => {
                let value = math::whole_power(operand(a), n.unsigned_abs());
                if n < 0 { 1.0 / value } else { value }
            }
            Node::Unary(f, a) => unary_value(f, operand(a)),
            Node::Binary(f, a, b) => binary_value(f, operand(a), operand(b)),
            Node::Compare(c, a, b) => compare(c, operand(a), operand(b)),
            Node::And(a, b) => f64::from(operand(a) != 0.0 && operand(b) != 0.0),
            Node::Or(a, b) => f64::from(operand(a) != 0.0 || operand(b) != 0.0),
            Node::Not(a) => f64::from(operand(a) == 0.0),
            Node::Select(c, a, b) => {
                if operand(c) == 0.0 {
                    operand(b)
                } else {
                    operand(a)
                }
            }
            Node::Table(table, order, a) => self.table_value(table, order, operand(a), operand),
        }
    }

    /// Extends `values`, which holds the values of the first nodes, to all nodes.
    pub fn extend_values(&self, values: &mut Vec<f64>, symbol: impl Fn(Symbol) -> f64) {
        for k in values.len()..self.len() {
            let value = self.node_value(self.nodes[k], |id| values[id.index()], &symbol);
            values.push(value);
        }
    }

    /// Returns the value of a formula. For tests and set-up; the time loop runs programs.
    #[must_use]
    pub fn value(&self, root: ExprId, symbol: impl Fn(Symbol) -> f64) -> f64 {
        self.value_by(root, |node, operand| self.node_value(node, operand, &symbol))
    }

    /// Returns the value of a formula whose symbols may be unknown (NaN); NaN if it depends on an unknown. Conditions are three-valued: a
    /// comparison with an operand that is unknown or not finite is unknown.
    #[must_use]
    pub fn value_if_known(&self, root: ExprId, symbol: impl Fn(Symbol) -> f64) -> f64 {
        self.value_by(root, |node, operand| {
            let holds = |id| match operand(id) {
                value if value.is_nan() => None,
                value => Some(value != 0.0),
            };
            let is_unknown = match node {
                Node::Compare(_, a, b) => !operand(a).is_finite() || !operand(b).is_finite(),
                Node::And(a, b) => {
                    let both = [holds(a), holds(b)];
                    both.contains(&None) && !both.contains(&Some(false))
                }
                Node::Or(a, b) => {
                    let both = [holds(a), holds(b)];
                    both.contains(&None) && !both.contains(&Some(true))
                }
                Node::Select(condition, ..) => operand(condition).is_nan(),
                _ => node.children().as_slice().iter().any(|&child| operand(child).is_nan()),
            };
            if is_unknown { f64::NAN } else { self.node_value(node, operand, &symbol) }
        })
    }

    /// Returns the value of a formula, with a rule for the value of each node.
    fn value_by(&self, root: ExprId, rule: impl Fn(Node, &dyn Fn(ExprId) -> f64) -> f64) -> f64 {
        let mut values: rustc_hash::FxHashMap<ExprId, f64> = rustc_hash::FxHashMap::default();
        for id in self.reachable_with_tables(&[root]) {
            let value = rule(self.node(id), &|child| values[&child]);
            values.insert(id, value);
        }
        values[&root]
    }
}
