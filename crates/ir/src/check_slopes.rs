//! Slopes of the redundant equations that are checked instead of solved, and measures of systems with input signals.

use super::right_sides::slopes_by;
use super::{ConstraintSystem, Measure, With};
use mechc_expr::{ExprId, Graph, Symbol};

/// Highest time derivative that is given for a signal.
const HIGHEST: u8 = 2;

/// Slopes of the left-out equations with respect to coordinates, inputs and parameters. A variation along which one of them would cease to
/// hold does not exist, since the mechanism cannot be assembled nearby.
#[derive(Clone, Debug, Default)]
pub struct CheckSlopes {
    /// Check and coordinate of each slope that does not vanish identically.
    pub pattern: Vec<(u32, u32)>,
    /// Slopes with respect to coordinates, in the order of `pattern`.
    pub by_q: Vec<ExprId>,
    /// Slopes with respect to inputs and parameters, one for each check.
    pub with: Vec<(With, Vec<ExprId>)>,
}

impl CheckSlopes {
    /// Returns the slopes with respect to each input, in order.
    pub fn by_inputs(&self) -> impl Iterator<Item = &[ExprId]> {
        self.with.iter().filter(|(with, _)| matches!(with, With::Input(_))).map(|(_, slopes)| slopes.as_slice())
    }

    /// Returns the slopes with respect to each parameter, in order.
    pub fn by_params(&self) -> impl Iterator<Item = &[ExprId]> {
        self.with.iter().filter(|(with, _)| matches!(with, With::Param(_))).map(|(_, slopes)| slopes.as_slice())
    }
}

impl ConstraintSystem {
    /// Derives the slopes of the left-out equations, if coordinates are differentiated with respect to inputs or parameters.
    pub(super) fn derive_checks(&mut self) {
        let with = self.slopes();
        if self.checks.is_empty() || with.is_empty() {
            return;
        }
        let phi: Vec<ExprId> = self.checks.iter().map(|check| check.phi).collect();
        let mut slopes = CheckSlopes::default();
        for (check, &phi) in phi.iter().enumerate() {
            for (column, slope) in self.graph.slopes(phi, 0) {
                slopes.pattern.push((check as u32, column));
                slopes.by_q.push(slope);
            }
        }
        for with in with {
            let symbol = match with {
                With::Input(k) => self.inputs[k].symbol(),
                With::Param(k) => Symbol::Param(k as u32),
                With::Time(_) => Symbol::Time,
            };
            slopes.with.push((with, slopes_by(&mut self.graph, &phi, symbol)));
        }
        self.check_slopes = slopes;
    }

    /// Gives each measure the derivatives that the corresponding one of another system of the same text has. Those that would need more than
    /// the acceleration of a signal are not finite.
    pub fn align_measures(&mut self, others: &[Measure]) {
        let undefined = non_finite(&mut self.graph);
        for (measure, other) in self.measures.iter_mut().zip(others) {
            let mut needs_more = false;
            let mut available = |id: Option<ExprId>| {
                needs_more |= id.is_none_or(|id| self.graph.symbols(id).into_iter().any(is_beyond));
                id.filter(|_| !needs_more).unwrap_or(undefined)
            };
            measure.value = available(Some(measure.value));
            let [first, second] = [available(measure.first), available(measure.second)];
            measure.first = other.first.map(|_| first);
            measure.second = other.second.map(|_| second);
        }
    }
}

/// Returns whether a symbol is a higher derivative than signals are given with.
fn is_beyond(symbol: Symbol) -> bool {
    matches!(symbol, Symbol::Signal { order, .. } | Symbol::Coordinate { order, .. } if order > HIGHEST)
}

/// Returns a formula that is never finite.
fn non_finite(graph: &mut Graph) -> ExprId {
    let (one, zero) = (graph.constant(1.0), graph.constant(0.0));
    graph.div(one, zero)
}
