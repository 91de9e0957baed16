//! Derivative rules of the expression graph: the only ones of the project, applied forward and backward.
//!
//! Piecewise functions are differentiated by branch: at a switch the derivative is that of the branch that is taken there.

use super::table_derivatives::VariedTables;
use super::{Binary, Comparison, Dependence, ExprId, Graph, Node, Symbol, Unary};
use rustc_hash::{FxBuildHasher, FxHashMap};

/// A sum of slopes is rounding if its size is no more than this part of the larger slope.
const CANCELLED: f64 = 4.0 * f64::EPSILON;

impl Graph {
    /// Returns the derivatives of the roots along a direction (forward mode). `direction` gives the derivative of each symbol, or `None`
    /// for a constant one.
    ///
    /// With `Time ↦ 1`, `q ↦ q̇`, `q̇ ↦ q̈` this is the total time derivative.
    pub fn derivatives(
        &mut self,
        roots: &[ExprId],
        mut direction: impl FnMut(&mut Graph, Symbol) -> Option<ExprId>,
    ) -> Vec<ExprId> {
        self.along(roots, &mut direction, &mut None)
    }

    /// Returns the derivatives as [`Graph::derivatives`] does; with `varied` also through the cells of tables, whose derivatives it caches.
    pub(super) fn along(
        &mut self,
        roots: &[ExprId],
        direction: &mut impl FnMut(&mut Graph, Symbol) -> Option<ExprId>,
        varied: &mut Option<VariedTables>,
    ) -> Vec<ExprId> {
        let reachable = self.reachable(roots);
        let mut derivatives: FxHashMap<ExprId, ExprId> =
            FxHashMap::with_capacity_and_hasher(reachable.len(), FxBuildHasher);
        for id in reachable {
            let node = self.node(id);
            let derivative = match node {
                Node::Symbol(symbol) => direction(self, symbol),
                Node::Select(..) if self.guarded_product(id).is_some() => {
                    self.guarded_product_derivative(id, &derivatives)
                }
                Node::Select(condition, a, b) => {
                    let (da, db) = (derivatives.get(&a).copied(), derivatives.get(&b).copied());
                    self.select_derivative(condition, da, db)
                }
                Node::Table(table, order, x) if varied.is_some() => {
                    let by_argument = self.chain_rule(id, &derivatives);
                    let by_cells = self.derivative_by_cells(table, order, x, direction, varied);
                    match (by_argument, by_cells) {
                        (Some(a), Some(b)) => Some(self.add(a, b)),
                        (one, other) => one.or(other),
                    }
                }
                _ => self.chain_rule(id, &derivatives),
            };
            if let Some(derivative) = derivative
                && !self.is_zero(derivative)
            {
                derivatives.insert(id, derivative);
            }
        }
        let zero = self.constant(0.0);
        roots.iter().map(|root| derivatives.get(root).copied().unwrap_or(zero)).collect()
    }

    /// Returns the nonzero partial derivatives of a root with respect to the coordinates, or to their time derivatives of an order, each
    /// with the number of its coordinate.
    pub fn slopes(&mut self, root: ExprId, order: u8) -> impl Iterator<Item = (u32, ExprId)> + use<> {
        let gradient = self.gradient(root, Dependence::coordinates(order));
        gradient.into_iter().filter_map(move |(symbol, slope)| match symbol {
            Symbol::Coordinate { index, order: other } if other == order => Some((index, slope)),
            _ => None,
        })
    }

    /// Returns the partial derivatives of a root with respect to every symbol of some kinds, in the order of symbols (backward
    /// mode). Derivatives that vanish identically are left out.
    pub fn gradient(&mut self, root: ExprId, kinds: Dependence) -> Vec<(Symbol, ExprId)> {
        let reachable = self.reachable(&[root]);
        if reachable.iter().any(|&id| self.is_piecewise(id) && self.dependence(id).on(kinds)) {
            return self.gradient_by_branches(root, kinds);
        }
        let mut adjoints: FxHashMap<ExprId, ExprId> = FxHashMap::default();
        let one = self.constant(1.0);
        adjoints.insert(root, one);
        let mut gradient = Vec::new();
        for id in reachable.into_iter().rev() {
            if !self.dependence(id).on(kinds) {
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
            for (operand, &child) in node.children().as_slice().iter().enumerate() {
                if !self.dependence(child).on(kinds) {
                    continue;
                }
                let Some(share) = self.partial(id, operand, adjoint) else {
                    continue;
                };
                let sum = match adjoints.get(&child) {
                    Some(&sum) => self.sum_of_slopes(sum, share),
                    None => share,
                };
                adjoints.insert(child, sum);
            }
        }
        gradient.retain(|&(_, derivative)| !self.is_zero(derivative));
        gradient.sort_unstable_by_key(|&(symbol, _)| symbol);
        gradient
    }

    /// Adds two slopes. A sum that is only rounding is zero: `0.1 x + 0.2 x - 0.3 x` has no slope.
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

    /// Returns the gradient of a formula with branches, symbol by symbol in forward mode, so that the branch is selected after
    /// differentiation. Backward mode would multiply the slope of the other branch, which need not be finite, by zero.
    fn gradient_by_branches(&mut self, root: ExprId, kinds: Dependence) -> Vec<(Symbol, ExprId)> {
        let symbols = self.symbols(root);
        let varying = symbols.into_iter().filter(|&symbol| Dependence::of(symbol).on(kinds));
        let slopes: Vec<(Symbol, ExprId)> = varying
            .map(|symbol| {
                let slope = self.derivatives(&[root], |graph, other| (other == symbol).then(|| graph.constant(1.0)));
                (symbol, slope[0])
            })
            .collect();
        slopes.into_iter().filter(|&(_, slope)| !self.is_zero(slope)).collect()
    }

    /// Returns whether an expression is the constant 0.
    #[must_use]
    pub fn is_zero(&self, id: ExprId) -> bool {
        self.as_const(id) == Some(0.0)
    }

    /// Returns Σ ∂node/∂childₖ · childₖ′; `None` if it vanishes.
    fn chain_rule(&mut self, id: ExprId, derivatives: &FxHashMap<ExprId, ExprId>) -> Option<ExprId> {
        let mut sum = None;
        for (operand, child) in self.node(id).children().as_slice().iter().enumerate() {
            let Some(&inner) = derivatives.get(child) else {
                continue;
            };
            let Some(term) = self.partial(id, operand, inner) else {
                continue;
            };
            sum = Some(match sum {
                Some(sum) => self.add(sum, term),
                None => term,
            });
        }
        sum
    }

    /// Returns `c · a`, which is 0 where `c` is 0 even if `a` has a pole there: `n · xⁿ⁻¹` for `n = 0` at `x = 0`. The test is needed only
    /// for a factor that is not a number and stays the same along the motion.
    fn multiply_guarded(&mut self, c: ExprId, a: ExprId) -> ExprId {
        let product = self.mul(c, a);
        if self.as_const(c).is_some() || !self.dependence(c).is_constant() {
            return product;
        }
        let zero = self.constant(0.0);
        let is_zero = self.compare(Comparison::Equal, c, zero);
        self.select(is_zero, zero, product)
    }

    /// Returns the factors of a product that [`Graph::multiply_guarded`] has made.
    fn guarded_product(&self, id: ExprId) -> Option<[ExprId; 2]> {
        let Node::Select(condition, zero, product) = self.node(id) else { return None };
        let Node::Compare(Comparison::Equal, c, other) = self.node(condition) else { return None };
        let Node::Mul(a, b) = self.node(product) else { return None };
        let is_guarded = self.is_zero(zero) && self.is_zero(other) && self.dependence(c).is_constant();
        match c {
            _ if !is_guarded => None,
            c if c == a => Some([c, b]),
            c if c == b => Some([c, a]),
            _ => None,
        }
    }

    /// Returns the derivative of a guarded product, whose branches are those of one product.
    fn guarded_product_derivative(&mut self, id: ExprId, derivatives: &FxHashMap<ExprId, ExprId>) -> Option<ExprId> {
        let [c, a] = self.guarded_product(id)?;
        let by_factor = derivatives.get(&c).map(|&slope| self.mul(slope, a));
        let by_other = derivatives.get(&a).map(|&slope| self.multiply_guarded(c, slope));
        match (by_factor, by_other) {
            (Some(one), Some(other)) => Some(self.add(one, other)),
            (one, other) => one.or(other),
        }
    }

    fn select_derivative(&mut self, condition: ExprId, a: Option<ExprId>, b: Option<ExprId>) -> Option<ExprId> {
        if a.is_none() && b.is_none() {
            return None;
        }
        let zero = self.constant(0.0);
        Some(self.select(condition, a.unwrap_or(zero), b.unwrap_or(zero)))
    }

    /// Returns `factor` times the partial derivative of a node with respect to one of its operands; `None` if it vanishes.
    fn partial(&mut self, id: ExprId, operand: usize, factor: ExprId) -> Option<ExprId> {
        let node = self.node(id);
        Some(match (node, operand) {
            (Node::Add(..), _) | (Node::Sub(..), 0) => factor,
            (Node::Sub(..) | Node::Neg(_), _) => self.neg(factor),
            (Node::Mul(a, b), _) => {
                let other = if operand == 0 { b } else { a };
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
            (Node::Unary(function, a), _) => return self.unary_partial(function, id, a, factor),
            (Node::Binary(function, a, b), _) => self.binary_partial(function, id, [a, b], operand, factor),
            (Node::Table(table, order, a), _) if order < 3 => {
                let slope = self.table(table, order + 1, a);
                self.mul(factor, slope)
            }
            // conditions are constant between their switches, and third derivatives of tables between their knots
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

    fn unary_partial(&mut self, function: Unary, id: ExprId, a: ExprId, factor: ExprId) -> Option<ExprId> {
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
                let negated = self.neg(factor);
                self.select(negative, negated, factor)
            }
            Unary::Sign | Unary::Floor => return None,
        })
    }

    fn binary_partial(
        &mut self,
        function: Binary,
        id: ExprId,
        [a, b]: [ExprId; 2],
        operand: usize,
        factor: ExprId,
    ) -> ExprId {
        let zero = self.constant(0.0);
        match (function, operand) {
            (Binary::Atan2, _) => {
                let (aa, bb) = (self.power(a, 2), self.power(b, 2));
                let square = self.add(aa, bb);
                let other = if operand == 0 { b } else { self.neg(a) };
                let slope = self.div(other, square);
                self.mul(factor, slope)
            }
            (Binary::Hypot, _) => {
                let slope = self.div(if operand == 0 { a } else { b }, id);
                self.mul(factor, slope)
            }
            (Binary::Min | Binary::Max, _) => {
                let first = match function {
                    Binary::Min => self.compare(Comparison::Less, a, b),
                    _ => self.compare(Comparison::Less, b, a),
                };
                match operand {
                    0 => self.select(first, factor, zero),
                    _ => self.select(first, zero, factor),
                }
            }
            (Binary::Pow, 0) => {
                let one = self.constant(1.0);
                let lower_exponent = self.sub(b, one);
                let lower = self.pow(a, lower_exponent);
                let slope = self.multiply_guarded(b, lower);
                self.mul(factor, slope)
            }
            (Binary::Mod, 0) => factor,
            (Binary::Mod, _) => {
                let quotient = self.div(a, b);
                let whole = self.unary(Unary::Floor, quotient);
                let share = self.mul(factor, whole);
                self.neg(share)
            }
            // 0 to any power stays 0, and ln 0 does not exist
            (Binary::Pow, _) if self.is_zero(a) => zero,
            (Binary::Pow, _) => {
                let logarithm = self.unary(Unary::Ln, a);
                let slope = self.mul(id, logarithm);
                self.mul(factor, slope)
            }
        }
    }
}
