//! Inputs as signals: what their place in the equations asks for beside what a system of time alone has.

use super::{ConstraintSystem, Measure};
use crate::expr::{Dependence, ExprId, Graph, Symbol};

/// Nobody gives more of a signal than its value, rate and acceleration.
const HIGHEST: u8 = 2;

/// How equations that were left out change with the coordinates, with each signal and with each parameter. What is varied in a way in which
/// one would cease to hold has no derivative: the mechanism cannot be assembled beside where it is.
#[derive(Clone, Debug, Default)]
pub struct CheckSlopes {
    /// The check and the coordinate of each slope that does not vanish.
    pub pattern: Vec<(u32, u32)>,
    /// These slopes.
    pub by_q: Vec<ExprId>,
    /// By signal: a slope for each check.
    pub by_signal: Vec<Vec<ExprId>>,
    /// By parameter: a slope for each check.
    pub by_param: Vec<Vec<ExprId>>,
}

impl ConstraintSystem {
    /// The right sides of the equations for the derivatives of `q` by each signal.
    pub fn derive_by_signals(&mut self) {
        let signals: Vec<u32> = self.inputs.iter().map(|input| input.index).collect();
        self.by_signal = signals.into_iter().map(|index| self.rights_by(Symbol::Signal { index, order: 0 })).collect();
    }

    /// The right sides of the equations for the derivatives of `q` by each parameter, those by which tables change too.
    pub fn derive_by_params(&mut self) {
        self.by_param = (0..self.params.len() as u32).map(|k| self.rights_by(Symbol::Param(k))).collect();
        self.derive_checks();
    }

    /// The slopes of equations that were left out, where coordinates are differentiated by signals or parameters.
    pub(super) fn derive_checks(&mut self) {
        let (has_signals, has_params) = (!self.by_signal.is_empty(), !self.by_param.is_empty());
        if self.checks.is_empty() || !(has_signals || has_params) {
            return;
        }
        let phi: Vec<ExprId> = self.checks.iter().map(|check| check.phi).collect();
        let mut slopes = CheckSlopes::default();
        for (check, &phi) in phi.iter().enumerate() {
            for (symbol, slope) in self.graph.gradient(phi, Dependence::coordinates(0)) {
                if let Symbol::Coordinate { index, order: 0 } = symbol {
                    slopes.pattern.push((check as u32, index));
                    slopes.by_q.push(slope);
                }
            }
        }
        let signals: Vec<u32> = self.inputs.iter().map(|input| input.index).filter(|_| has_signals).collect();
        let params = if has_params { self.params.len() as u32 } else { 0 };
        let mut slopes_by =
            |own: Symbol| self.graph.variations(&phi, |graph, symbol| (symbol == own).then(|| graph.constant(1.0)));
        slopes.by_signal = signals.into_iter().map(|index| slopes_by(Symbol::Signal { index, order: 0 })).collect();
        slopes.by_param = (0..params).map(|k| slopes_by(Symbol::Param(k))).collect();
        self.check_slopes = slopes;
    }

    /// The partial derivatives of `Φ` by a symbol, negated.
    fn rights_by(&mut self, own: Symbol) -> Vec<ExprId> {
        let phi: Vec<ExprId> = self.rows.iter().map(|row| row.phi).collect();
        let graph = &mut self.graph;
        let slopes = graph.variations(&phi, |graph, symbol| (symbol == own).then(|| graph.constant(1.0)));
        slopes.into_iter().map(|id| graph.neg(id)).collect()
    }

    /// Gives measures the derivatives that those of another system of the same text have; what would need more of a signal than its
    /// acceleration has no value.
    pub fn align_measures(&mut self, others: &[Measure]) {
        let none = nothing(&mut self.graph);
        for (measure, other) in self.measures.iter_mut().zip(others) {
            let mut needs_more = false;
            let mut known = |id: Option<ExprId>| {
                needs_more |= id.is_none_or(|id| self.graph.symbols(id).into_iter().any(is_beyond));
                id.filter(|_| !needs_more).unwrap_or(none)
            };
            measure.value = known(Some(measure.value));
            let [first, second] = [known(measure.first), known(measure.second)];
            measure.first = other.first.map(|_| first);
            measure.second = other.second.map(|_| second);
        }
    }
}

/// Whether a symbol is of more than the accelerations of signals.
fn is_beyond(symbol: Symbol) -> bool {
    matches!(symbol, Symbol::Signal { order, .. } | Symbol::Coordinate { order, .. } if order > HIGHEST)
}

/// What is never finite.
fn nothing(graph: &mut Graph) -> ExprId {
    let (one, zero) = (graph.constant(1.0), graph.constant(0.0));
    graph.div(one, zero)
}
