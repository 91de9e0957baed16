//! The one set of derivative rules of the project, and the two ways of applying it.
//!
//! Piecewise functions are differentiated by branch: at a switch the derivative is that of the branch which counts
//! there.

use super::table_derivatives::VariedTables;
use super::{Binary, Comparison, Dependence, ExprId, Graph, Node, Symbol, Unary};
use rustc_hash::{FxBuildHasher, FxHashMap};

/// A sum of numbers is what rounding leaves of them where it is no more than this part of the larger.
const CANCELLED: f64 = 4.0 * f64::EPSILON;

impl Graph {
    /// Forward: the derivatives of the roots along a direction that gives each symbol its own derivative
    /// (`None` for a symbol that does not change).
    ///
    /// With `Time ↦ 1`, `q ↦ q̇`, `q̇ ↦ q̈` this is the total time derivative.
    pub fn derivatives(
        &mut self,
        roots: &[ExprId],
        mut direction: impl FnMut(&mut Graph, Symbol) -> Option<ExprId>,
    ) -> Vec<ExprId> {
        self.along(roots, &mut direction, &mut None)
    }

    /// As [`Graph::derivatives`]; what tables are made of changes too, where `varied` holds those that are known.
    pub(super) fn along(
        &mut self,
        roots: &[ExprId],
        direction: &mut impl FnMut(&mut Graph, Symbol) -> Option<ExprId>,
        varied: &mut Option<VariedTables>,
    ) -> Vec<ExprId> {
        let reachable = self.reachable(roots);
        let mut known: FxHashMap<ExprId, ExprId> = FxHashMap::with_capacity_and_hasher(reachable.len(), FxBuildHasher);
        for id in reachable {
            let node = self.node(id);
            let derivative = match node {
                Node::Symbol(symbol) => direction(self, symbol),
                Node::Select(condition, a, b) => {
                    let (da, db) = (known.get(&a).copied(), known.get(&b).copied());
                    self.select_derivative(condition, da, db)
                }
                Node::Table(table, order, x) if varied.is_some() => {
                    let by_argument = self.chain_rule(id, &known);
                    let by_cells = self.derivative_by_cells((table, order, x), direction, varied);
                    match (by_argument, by_cells) {
                        (Some(a), Some(b)) => Some(self.add(a, b)),
                        (one, other) => one.or(other),
                    }
                }
                _ => self.chain_rule(id, &known),
            };
            if let Some(derivative) = derivative
                && !self.is_zero(derivative)
            {
                known.insert(id, derivative);
            }
        }
        let zero = self.constant(0.0);
        roots.iter().map(|root| known.get(root).copied().unwrap_or(zero)).collect()
    }

    /// The partial derivatives of one root by the coordinates, or by their time derivatives of an order, that do not vanish: each with
    /// the number of its coordinate.
    pub fn slopes(&mut self, root: ExprId, order: u8) -> impl Iterator<Item = (u32, ExprId)> + use<> {
        let gradient = self.gradient(root, Dependence::coordinates(order));
        gradient.into_iter().filter_map(move |(symbol, slope)| match symbol {
            Symbol::Coordinate { index, order: own } if own == order => Some((index, slope)),
            _ => None,
        })
    }

    /// Backward: the partial derivatives of one root by every symbol that `wanted` holds, in the symbols' order;
    /// those that vanish identically are left out.
    pub fn gradient(&mut self, root: ExprId, wanted: Dependence) -> Vec<(Symbol, ExprId)> {
        let reachable = self.reachable(&[root]);
        if reachable.iter().any(|&id| self.is_piecewise(id) && self.dependence(id).on(wanted)) {
            return self.gradient_by_branches(root, wanted);
        }
        let mut adjoints: FxHashMap<ExprId, ExprId> = FxHashMap::default();
        let one = self.constant(1.0);
        adjoints.insert(root, one);
        let mut gradient = Vec::new();
        for id in reachable.into_iter().rev() {
            if !self.dependence(id).on(wanted) {
                continue;
            }
            let Some(&adjoint) = adjoints.get(&id) else {
                continue;
            };
            let node = self.node(id);
            if let Node::Symbol(symbol) = node {
                gradient.push((symbol, adjoint));
                continue;
            }
            for (place, &child) in node.children().as_slice().iter().enumerate() {
                if !self.dependence(child).on(wanted) {
                    continue;
                }
                let Some(share) = self.share(id, place, adjoint) else {
                    continue;
                };
                let sum = match adjoints.get(&child) {
                    Some(&already) => self.sum_of_slopes(already, share),
                    None => share,
                };
                adjoints.insert(child, sum);
            }
        }
        gradient.retain(|&(_, derivative)| !self.is_zero(derivative));
        gradient.sort_unstable_by_key(|&(symbol, _)| symbol);
        gradient
    }

    /// The sum of two slopes. What rounding leaves of numbers that cancel is no slope: `0.1 x + 0.2 x - 0.3 x` has none.
    fn sum_of_slopes(&mut self, a: ExprId, b: ExprId) -> ExprId {
        let sum = self.add(a, b);
        let values = [a, b, sum].map(|id| self.as_const(id));
        match values {
            [Some(a), Some(b), Some(sum)] if sum.abs() <= CANCELLED * f64::max(a.abs(), b.abs()) => self.constant(0.0),
            _ => sum,
        }
    }

    fn is_piecewise(&self, id: ExprId) -> bool {
        matches!(self.node(id), Node::Select(..) | Node::Binary(Binary::Min | Binary::Max, ..))
    }

    /// The gradient of a formula with branches, symbol by symbol: forward, the branch that counts is chosen after it has
    /// been differentiated. Backward, it would be a zero times the slope of the other branch, which need not be finite.
    fn gradient_by_branches(&mut self, root: ExprId, wanted: Dependence) -> Vec<(Symbol, ExprId)> {
        let symbols = self.symbols(root);
        let wanted = symbols.into_iter().filter(|&symbol| Dependence::of(symbol).on(wanted));
        let slopes: Vec<(Symbol, ExprId)> = wanted
            .map(|symbol| {
                let slope = self.derivatives(&[root], |graph, other| (other == symbol).then(|| graph.constant(1.0)));
                (symbol, slope[0])
            })
            .collect();
        slopes.into_iter().filter(|&(_, slope)| !self.is_zero(slope)).collect()
    }

    /// Whether an expression is the constant nothing.
    #[must_use]
    pub fn is_zero(&self, id: ExprId) -> bool {
        self.as_const(id) == Some(0.0)
    }

    /// Σ ∂node/∂childₖ · childₖ'
    fn chain_rule(&mut self, id: ExprId, known: &FxHashMap<ExprId, ExprId>) -> Option<ExprId> {
        let mut sum = None;
        for (place, child) in self.node(id).children().as_slice().iter().enumerate() {
            let Some(&inner) = known.get(child) else {
                continue;
            };
            let Some(term) = self.share(id, place, inner) else {
                continue;
            };
            sum = Some(match sum {
                Some(sum) => self.add(sum, term),
                None => term,
            });
        }
        sum
    }

    fn select_derivative(&mut self, condition: ExprId, a: Option<ExprId>, b: Option<ExprId>) -> Option<ExprId> {
        if a.is_none() && b.is_none() {
            return None;
        }
        let zero = self.constant(0.0);
        Some(self.select(condition, a.unwrap_or(zero), b.unwrap_or(zero)))
    }

    /// `factor` times the partial derivative of a node by one of its operands; `None` where that is zero.
    fn share(&mut self, id: ExprId, place: usize, factor: ExprId) -> Option<ExprId> {
        let node = self.node(id);
        Some(match (node, place) {
            (Node::Add(..), _) | (Node::Sub(..), 0) => factor,
            (Node::Sub(..) | Node::Neg(_), _) => self.neg(factor),
            (Node::Mul(a, b), _) => {
                let other = if place == 0 { b } else { a };
                self.mul(factor, other)
            }
            (Node::Div(_, b), 0) => self.div(factor, b),
            (Node::Div(_, b), _) => {
                let slope = self.div(id, b);
                let share = self.mul(factor, slope);
                self.neg(share)
            }
            (Node::Power(a, n), _) => {
                let degree = self.constant(f64::from(n));
                let lower = self.power(a, n - 1);
                let slope = self.mul(degree, lower);
                self.mul(factor, slope)
            }
            (Node::Unary(function, a), _) => return self.unary_share(function, id, a, factor),
            (Node::Binary(function, a, b), _) => self.binary_share(function, id, [a, b], place, factor),
            (Node::Table(table, order, a), _) if order < 3 => {
                let slope = self.table(table, order + 1, a);
                self.mul(factor, slope)
            }
            // conditions are constant between their switches, third derivatives of tables between their knots
            (
                Node::Select(..)
                | Node::Compare(..)
                | Node::And(..)
                | Node::Or(..)
                | Node::Not(_)
                | Node::Table(..)
                | Node::Const(_)
                | Node::Symbol(_),
                _,
            ) => return None,
        })
    }

    fn unary_share(&mut self, function: Unary, id: ExprId, a: ExprId, factor: ExprId) -> Option<ExprId> {
        let one = self.constant(1.0);
        Some(match function {
            Unary::Sin => {
                let slope = self.unary(Unary::Cos, a);
                self.mul(factor, slope)
            }
            Unary::Cos => {
                let slope = self.unary(Unary::Sin, a);
                let share = self.mul(factor, slope);
                self.neg(share)
            }
            Unary::Tan => {
                let square = self.power(id, 2);
                let slope = self.add(one, square);
                self.mul(factor, slope)
            }
            Unary::Asin | Unary::Acos => {
                let square = self.power(a, 2);
                let rest = self.sub(one, square);
                let root = self.unary(Unary::Sqrt, rest);
                let share = self.div(factor, root);
                if function == Unary::Asin { share } else { self.neg(share) }
            }
            Unary::Atan => {
                let square = self.power(a, 2);
                let sum = self.add(one, square);
                self.div(factor, sum)
            }
            Unary::Sinh => {
                let slope = self.unary(Unary::Cosh, a);
                self.mul(factor, slope)
            }
            Unary::Cosh => {
                let slope = self.unary(Unary::Sinh, a);
                self.mul(factor, slope)
            }
            Unary::Tanh => {
                let square = self.power(id, 2);
                let slope = self.sub(one, square);
                self.mul(factor, slope)
            }
            Unary::Exp => self.mul(factor, id),
            Unary::Ln => self.div(factor, a),
            Unary::Log10 => {
                let ln10 = self.constant(std::f64::consts::LN_10);
                let scaled = self.mul(ln10, a);
                self.div(factor, scaled)
            }
            Unary::Sqrt => {
                let two = self.constant(2.0);
                let double = self.mul(two, id);
                self.div(factor, double)
            }
            Unary::Abs => {
                let zero = self.constant(0.0);
                let negative = self.compare(Comparison::Less, a, zero);
                let turned = self.neg(factor);
                self.select(negative, turned, factor)
            }
            Unary::Sign | Unary::Floor => return None,
        })
    }

    fn binary_share(
        &mut self,
        function: Binary,
        id: ExprId,
        [a, b]: [ExprId; 2],
        place: usize,
        factor: ExprId,
    ) -> ExprId {
        let zero = self.constant(0.0);
        match (function, place) {
            (Binary::Atan2, _) => {
                let (aa, bb) = (self.power(a, 2), self.power(b, 2));
                let square = self.add(aa, bb);
                let other = if place == 0 { b } else { self.neg(a) };
                let slope = self.div(other, square);
                self.mul(factor, slope)
            }
            (Binary::Hypot, _) => {
                let slope = self.div(if place == 0 { a } else { b }, id);
                self.mul(factor, slope)
            }
            (Binary::Min | Binary::Max, _) => {
                let first = match function {
                    Binary::Min => self.compare(Comparison::Less, a, b),
                    _ => self.compare(Comparison::Less, b, a),
                };
                match place {
                    0 => self.select(first, factor, zero),
                    _ => self.select(first, zero, factor),
                }
            }
            (Binary::Pow, 0) => {
                let one = self.constant(1.0);
                let lower_exponent = self.sub(b, one);
                let lower = self.pow(a, lower_exponent);
                let slope = self.mul(b, lower);
                self.mul(factor, slope)
            }
            (Binary::Mod, 0) => factor,
            (Binary::Mod, _) => {
                let quotient = self.div(a, b);
                let whole = self.unary(Unary::Floor, quotient);
                let share = self.mul(factor, whole);
                self.neg(share)
            }
            // 0 to any power stays 0, and has no logarithm
            (Binary::Pow, _) if self.is_zero(a) => zero,
            (Binary::Pow, _) => {
                let logarithm = self.unary(Unary::Ln, a);
                let slope = self.mul(id, logarithm);
                self.mul(factor, slope)
            }
        }
    }
}
