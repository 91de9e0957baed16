//! Simplifying constructors of the expression graph.
//!
//! They fold numbers, drop zeros and ones, gather signs and equal factors, and order the operands of sums and products. No rule looks at
//! the value of a parameter, and none changes a value beyond rounding where it exists: zero times anything is zero, and so is `a − a`, even
//! where `a` has a pole. Results that are not finite are not folded, so that evaluation reports them.

use super::{Binary, Comparison, ExprId, Graph, Node, Symbol, Unary, binary_value, compare, unary_value};
use crate::math;

/// Larger whole exponents become general powers instead of products.
const LARGEST_WHOLE_POWER: i32 = 64;

impl Graph {
    /// Returns the node of a finite number.
    pub fn constant(&mut self, value: f64) -> ExprId {
        // −0 would make equal formulas differ
        self.intern(Node::Const((value + 0.0).to_bits()))
    }

    /// Returns the node of a symbol.
    pub fn symbol(&mut self, symbol: Symbol) -> ExprId {
        self.intern(Node::Symbol(symbol))
    }

    /// Returns `from + (to − from) s`.
    pub fn line(&mut self, [from, to]: [ExprId; 2], s: ExprId) -> ExprId {
        let length = self.sub(to, from);
        let progress = self.mul(length, s);
        self.add(from, progress)
    }

    pub(super) fn folded(&mut self, value: f64, node: Node) -> ExprId {
        if value.is_finite() { self.constant(value) } else { self.intern(node) }
    }

    fn is(&self, id: ExprId, value: f64) -> bool {
        // exact: a simplification must not act on a number nearby
        self.as_const(id).is_some_and(|c| c.to_bits() == value.to_bits())
    }

    /// Returns `a + b`.
    pub fn add(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if let (Some(x), Some(y)) = (self.as_const(a), self.as_const(b)) {
            return self.folded(x + y, Node::Add(a, b));
        }
        match (self.node(a), self.node(b)) {
            _ if self.is(a, 0.0) => b,
            _ if self.is(b, 0.0) => a,
            (_, Node::Neg(inner)) => self.sub(a, inner),
            (Node::Neg(inner), _) => self.sub(b, inner),
            _ if a == b => {
                let two = self.constant(2.0);
                self.mul(two, a)
            }
            _ => self.intern(Node::Add(a.min(b), a.max(b))),
        }
    }

    /// Returns `a − b`.
    pub fn sub(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if let (Some(x), Some(y)) = (self.as_const(a), self.as_const(b)) {
            return self.folded(x - y, Node::Sub(a, b));
        }
        match (self.node(a), self.node(b)) {
            _ if a == b => self.constant(0.0),
            _ if self.is(a, 0.0) => self.neg(b),
            (_, Node::Const(bits)) => {
                let opposite = self.constant(-f64::from_bits(bits));
                self.add(a, opposite)
            }
            // a number minus its fraction
            (_, Node::Binary(Binary::Mod, x, one)) if x == a && self.is(one, 1.0) => self.unary(Unary::Floor, a),
            (_, Node::Neg(inner)) => self.add(a, inner),
            (Node::Neg(inner), _) => {
                let sum = self.add(inner, b);
                self.neg(sum)
            }
            _ => self.intern(Node::Sub(a, b)),
        }
    }

    /// Returns `−a`.
    pub fn neg(&mut self, a: ExprId) -> ExprId {
        match self.node(a) {
            Node::Const(bits) => self.constant(-f64::from_bits(bits)),
            Node::Neg(inner) => inner,
            Node::Sub(x, y) => self.sub(y, x),
            Node::Mul(x, y) => match self.as_const(x) {
                Some(c) => {
                    let c = self.constant(-c);
                    self.mul(c, y)
                }
                None => self.intern(Node::Neg(a)),
            },
            _ => self.intern(Node::Neg(a)),
        }
    }

    /// Returns `a · b`; a number becomes the first operand.
    pub fn mul(&mut self, a: ExprId, b: ExprId) -> ExprId {
        match (self.as_const(a), self.as_const(b)) {
            (Some(x), Some(y)) => self.folded(x * y, Node::Mul(a, b)),
            (Some(c), None) => self.scaled(c, a, b),
            (None, Some(c)) => self.scaled(c, b, a),
            (None, None) => self.product(a, b),
        }
    }

    /// Returns a number times a formula that is not a number.
    fn scaled(&mut self, c: f64, c_id: ExprId, b: ExprId) -> ExprId {
        if c == 0.0 {
            return c_id;
        }
        if self.is(c_id, 1.0) {
            return b;
        }
        if self.is(c_id, -1.0) {
            return self.neg(b);
        }
        match self.node(b) {
            Node::Neg(inner) => {
                let c = self.constant(-c);
                self.mul(c, inner)
            }
            Node::Mul(x, y) => match self.as_const(x) {
                Some(d) if (c * d).is_finite() && c * d != 0.0 => {
                    let c = self.constant(c * d);
                    self.mul(c, y)
                }
                _ => self.intern(Node::Mul(c_id, b)),
            },
            _ => self.intern(Node::Mul(c_id, b)),
        }
    }

    /// Returns a product of formulas that are not numbers.
    fn product(&mut self, a: ExprId, b: ExprId) -> ExprId {
        match (self.node(a), self.node(b)) {
            (Node::Neg(x), Node::Neg(y)) => self.mul(x, y),
            (Node::Neg(x), _) => {
                let product = self.mul(x, b);
                self.neg(product)
            }
            (_, Node::Neg(y)) => {
                let product = self.mul(a, y);
                self.neg(product)
            }
            (Node::Mul(x, y), _) if self.as_const(x).is_some() => {
                let product = self.mul(y, b);
                self.mul(x, product)
            }
            (_, Node::Mul(x, y)) if self.as_const(x).is_some() => {
                let product = self.mul(a, y);
                self.mul(x, product)
            }
            _ if a == b => self.power(a, 2),
            (Node::Power(x, n), Node::Power(y, m)) if x == y && n > 0 && m > 0 => self.power(x, n + m),
            (Node::Power(x, n), _) if x == b && n > 0 => self.power(x, n + 1),
            (_, Node::Power(y, m)) if y == a && m > 0 => self.power(y, m + 1),
            _ => self.intern(Node::Mul(a.min(b), a.max(b))),
        }
    }

    /// Returns `a / b`.
    pub fn div(&mut self, a: ExprId, b: ExprId) -> ExprId {
        if let (Some(x), Some(y)) = (self.as_const(a), self.as_const(b)) {
            return self.folded(x / y, Node::Div(a, b));
        }
        match (self.node(a), self.node(b)) {
            _ if self.is(b, 1.0) => a,
            _ if self.is(b, -1.0) => self.neg(a),
            _ if self.is(a, 0.0) => a,
            (Node::Neg(x), Node::Neg(y)) => self.div(x, y),
            (Node::Neg(x), _) => {
                let quotient = self.div(x, b);
                self.neg(quotient)
            }
            (_, Node::Neg(y)) => {
                let quotient = self.div(a, y);
                self.neg(quotient)
            }
            _ => self.intern(Node::Div(a, b)),
        }
    }

    /// Returns `aⁿ` for a whole n.
    pub fn power(&mut self, a: ExprId, n: i32) -> ExprId {
        match (self.node(a), n) {
            (_, 0) => self.constant(1.0),
            (_, 1) => a,
            _ if n.abs() > LARGEST_WHOLE_POWER => {
                let exponent = self.constant(f64::from(n));
                self.intern(Node::Binary(Binary::Pow, a, exponent))
            }
            (Node::Const(bits), _) => {
                let value = math::whole_power(f64::from_bits(bits), n.unsigned_abs());
                let value = if n < 0 { 1.0 / value } else { value };
                self.folded(value, Node::Power(a, n))
            }
            (Node::Neg(x), _) if n % 2 == 0 => self.power(x, n),
            (Node::Power(x, m), _) if n > 0 && m > 0 && n * m <= LARGEST_WHOLE_POWER => self.power(x, n * m),
            _ => self.intern(Node::Power(a, n)),
        }
    }

    /// Returns `a` to any power; small whole exponents become products.
    pub fn pow(&mut self, a: ExprId, b: ExprId) -> ExprId {
        match self.as_const(b) {
            Some(n) if n.fract() == 0.0 && n.abs() <= f64::from(LARGEST_WHOLE_POWER) => self.power(a, n as i32),
            Some(n) if n.to_bits() == 0.5_f64.to_bits() => self.unary(Unary::Sqrt, a),
            _ => self.binary(Binary::Pow, a, b),
        }
    }

    /// Returns a function of one argument.
    pub fn unary(&mut self, function: Unary, a: ExprId) -> ExprId {
        let node = Node::Unary(function, a);
        if let Some(x) = self.as_const(a) {
            return self.folded(unary_value(function, x), node);
        }
        match (function, self.node(a)) {
            (Unary::Cos | Unary::Cosh | Unary::Abs, Node::Neg(x)) => self.unary(function, x),
            (
                Unary::Sin | Unary::Tan | Unary::Asin | Unary::Atan | Unary::Sinh | Unary::Tanh | Unary::Sign,
                Node::Neg(x),
            ) => {
                let positive = self.unary(function, x);
                self.neg(positive)
            }
            (Unary::Abs, Node::Unary(Unary::Abs | Unary::Sqrt, _)) => a,
            _ => self.intern(node),
        }
    }

    /// Returns a function of two arguments.
    pub fn binary(&mut self, function: Binary, a: ExprId, b: ExprId) -> ExprId {
        if let (Some(x), Some(y)) = (self.as_const(a), self.as_const(b)) {
            return self.folded(binary_value(function, x, y), Node::Binary(function, a, b));
        }
        match function {
            Binary::Min | Binary::Max if a == b => a,
            Binary::Hypot => self.intern(Node::Binary(function, a.min(b), a.max(b))),
            _ => self.intern(Node::Binary(function, a, b)),
        }
    }

    /// Returns 1 if the comparison holds, else 0.
    pub fn compare(&mut self, comparison: Comparison, a: ExprId, b: ExprId) -> ExprId {
        match (self.as_const(a), self.as_const(b)) {
            (Some(x), Some(y)) => self.constant(compare(comparison, x, y)),
            _ => self.intern(Node::Compare(comparison, a, b)),
        }
    }

    /// Returns 1 if both hold, else 0.
    pub fn and(&mut self, a: ExprId, b: ExprId) -> ExprId {
        match (self.as_const(a), self.as_const(b)) {
            (Some(x), _) => {
                if x == 0.0 {
                    a
                } else {
                    b
                }
            }
            (_, Some(y)) => {
                if y == 0.0 {
                    b
                } else {
                    a
                }
            }
            _ if a == b => a,
            _ => self.intern(Node::And(a.min(b), a.max(b))),
        }
    }

    /// Returns 1 if at least one holds, else 0.
    pub fn or(&mut self, a: ExprId, b: ExprId) -> ExprId {
        match (self.as_const(a), self.as_const(b)) {
            (Some(x), _) => {
                if x == 0.0 {
                    b
                } else {
                    a
                }
            }
            (_, Some(y)) => {
                if y == 0.0 {
                    a
                } else {
                    b
                }
            }
            _ if a == b => a,
            _ => self.intern(Node::Or(a.min(b), a.max(b))),
        }
    }

    /// Returns 1 if `a` does not hold, else 0.
    pub fn not(&mut self, a: ExprId) -> ExprId {
        match self.node(a) {
            Node::Const(bits) => self.constant(f64::from(f64::from_bits(bits) == 0.0)),
            Node::Not(inner) => inner,
            _ => self.intern(Node::Not(a)),
        }
    }

    /// Returns `a` if the condition holds, else `b`.
    pub fn select(&mut self, condition: ExprId, a: ExprId, b: ExprId) -> ExprId {
        match self.node(condition) {
            _ if a == b => a,
            Node::Const(bits) => {
                if f64::from_bits(bits) == 0.0 {
                    b
                } else {
                    a
                }
            }
            Node::Not(inner) => self.select(inner, b, a),
            _ => self.intern(Node::Select(condition, a, b)),
        }
    }

    /// Returns `a − b·⌊a/b⌋`.
    pub fn modulo(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.binary(Binary::Mod, a, b)
    }

    /// Returns the operation of a node on other operands.
    pub(super) fn rebuild(&mut self, node: Node, mut operand: impl FnMut(ExprId) -> ExprId) -> ExprId {
        match node {
            Node::Const(_) | Node::Symbol(_) => self.intern(node),
            Node::Add(a, b) => self.add(operand(a), operand(b)),
            Node::Sub(a, b) => self.sub(operand(a), operand(b)),
            Node::Mul(a, b) => self.mul(operand(a), operand(b)),
            Node::Div(a, b) => self.div(operand(a), operand(b)),
            Node::Neg(a) => self.neg(operand(a)),
            Node::Power(a, n) => self.power(operand(a), n),
            Node::Unary(f, a) => self.unary(f, operand(a)),
            Node::Binary(Binary::Pow, a, b) => self.pow(operand(a), operand(b)),
            Node::Binary(f, a, b) => self.binary(f, operand(a), operand(b)),
            Node::Compare(c, a, b) => self.compare(c, operand(a), operand(b)),
            Node::And(a, b) => self.and(operand(a), operand(b)),
            Node::Or(a, b) => self.or(operand(a), operand(b)),
            Node::Not(a) => self.not(operand(a)),
            Node::Select(c, a, b) => self.select(operand(c), operand(a), operand(b)),
            Node::Table(table, order, a) => self.table(table, order, operand(a)),
        }
    }
}
