//! What formulas are measured in, found by walking them: what rows say of themselves is held against it.

use super::{ConstraintSystem, CoordinateKind};
use crate::expr::{Binary, ExprId, Node, Symbol, Unary};
use crate::vocabulary::Dimension;
use rustc_hash::FxHashMap;

/// None where it may be any: a number may stand for a length, and so may a parameter that was given without a unit.
type Known = Option<Dimension>;

impl ConstraintSystem {
    /// The dimension of a formula, as far as its coordinates, and the parameters that have units, tell it.
    #[must_use]
    pub fn dimension_of(&self, formula: ExprId) -> Option<Dimension> {
        let mut known: FxHashMap<ExprId, Known> = FxHashMap::default();
        // children come before their parents
        for id in self.graph.reachable(&[formula]) {
            let found = self.dimension_of_node(self.graph.node(id), &|child| known[&child]);
            known.insert(id, found);
        }
        known[&formula]
    }

    fn dimension_of_node(&self, node: Node, of: &dyn Fn(ExprId) -> Known) -> Known {
        match node {
            Node::Symbol(symbol) => self.dimension_of_symbol(symbol),
            Node::Const(_) | Node::Table(..) => None,
            Node::Neg(a) | Node::Unary(Unary::Abs, a) | Node::Binary(Binary::Mod, a, _) => of(a),
            Node::Add(a, b)
            | Node::Sub(a, b)
            | Node::Binary(Binary::Hypot | Binary::Min | Binary::Max, a, b)
            | Node::Select(_, a, b) => alike(of(a), of(b)),
            Node::Mul(a, b) => Some(of(a)?.times(of(b)?)),
            Node::Div(a, b) => Some(of(a)?.over(of(b)?)),
            Node::Power(a, n) => Some(of(a)?.to_the(f64::from(n))),
            Node::Unary(Unary::Sqrt, a) => Some(of(a)?.to_the(0.5)),
            Node::Binary(Binary::Pow, a, b) => Some(of(a)?.to_the(self.graph.as_const(b)?)),
            // other functions, comparisons and what is made of these
            Node::Unary(Unary::Floor, _) => None,
            Node::Unary(..)
            | Node::Binary(Binary::Atan2, ..)
            | Node::Compare(..)
            | Node::And(..)
            | Node::Or(..)
            | Node::Not(_) => Some(Dimension::PURE),
        }
    }

    fn dimension_of_symbol(&self, symbol: Symbol) -> Known {
        match symbol {
            Symbol::Coordinate { index, order } => {
                let own = match self.coordinates[index as usize].kind {
                    CoordinateKind::Length => Dimension::LENGTH,
                    CoordinateKind::Angle | CoordinateKind::Argument => Dimension::PURE,
                };
                Some(own.over(Dimension::TIME.to_the(f64::from(order))))
            }
            Symbol::Time => Some(Dimension::TIME),
            Symbol::Param(k) => {
                let own = self.params[k as usize].dimension;
                (!own.is(Dimension::PURE)).then_some(own)
            }
            // what is added to anything, and what is not looked at here
            Symbol::Shift(_) | Symbol::Signal { .. } | Symbol::Named(_) | Symbol::Varied { .. } => None,
        }
    }
}

/// Of a sum: what one term does not tell another one does.
fn alike(a: Known, b: Known) -> Known {
    match (a, b) {
        (Some(a), Some(b)) => a.is(b).then_some(a),
        (one, other) => one.or(other),
    }
}

#[cfg(test)]
mod tests {
    use super::Dimension;
    use crate::expr::{Symbol, Unary};
    use crate::ir::ConstraintSystem;
    use crate::{Cancel, Choice, Memory, Parsed, Redundant};

    fn disc() -> ConstraintSystem {
        let text = "mechanism disc {
            param radius = 3 cm
            ground { point O = (0, 0) }
            body wheel { point O = (0, 0) }
            joint axle: revolute(ground.O, wheel.O)
            driver motor: rotation(axle) = 90 deg/s * t
        }";
        let checked = Parsed::of("disc.mech", text).check(&Choice::default(), &Memory::default());
        let (compiled, _) = checked.compile(Redundant::Refused, &Cancel::default());
        compiled.expect("it is determined").system().clone()
    }

    #[test]
    fn sums_and_products_of_coordinates_have_dimensions() {
        let mut system = disc();
        let graph = &mut system.graph;
        let [x, y, phi] = [0, 1, 2].map(|index| graph.symbol(Symbol::Coordinate { index, order: 0 }));
        let radius = graph.symbol(Symbol::Param(0));
        let half = graph.constant(0.5);
        let (area, halved, sine) = (graph.mul(x, y), graph.mul(half, x), graph.unary(Unary::Sin, phi));
        let (arm, moved, beside) = (graph.mul(radius, sine), graph.add(half, x), graph.add(x, phi));
        let root = graph.unary(Unary::Sqrt, area);
        let found = [area, halved, sine, arm, moved, beside, root].map(|id| system.dimension_of(id));
        let (length, pure) = (Some(Dimension::LENGTH), Some(Dimension::PURE));
        assert_eq!(found, [Some(Dimension::AREA), None, pure, length, length, None, length]);
    }
}
