//! Constant formulas as numbers, and the graph's named symbols.

use super::Checker;
use crate::model::{DecidedBy, Named};
use mechc_expr::{Dependence, ExprId, Symbol};

impl Checker<'_> {
    /// Whether a formula follows from parameters.
    pub(super) fn follows(&self, id: ExprId) -> bool {
        self.model.graph.dependence(id).on(Dependence::PARAMS)
    }

    /// A named symbol of the graph; the same meaning is the same symbol.
    pub(super) fn name_symbol(&mut self, meaning: Named, derivative_order: u8) -> ExprId {
        let id = if let Some(&id) = self.common.named.get(&meaning) {
            id
        } else {
            let id = self.model.add_named(meaning);
            self.common.named.insert(meaning, id);
            self.common.derivative_orders.push(derivative_order);
            id
        };
        self.model.graph.symbol(Symbol::Named(id.index() as u32))
    }

    /// The value of a constant formula, under the params' values, by which something is decided.
    pub(super) fn constant_value(&mut self, id: ExprId) -> Option<f64> {
        self.decided(id, DecidedBy::Value)
    }

    /// The same, where only what it is decides, and not how large.
    pub(super) fn decided(&mut self, id: ExprId, by: DecidedBy) -> Option<f64> {
        let value = self.number_of(id);
        if value.is_some() {
            self.model.decided.push((id, by));
        }
        value
    }

    /// The value of a constant formula by which nothing is decided.
    pub(super) fn number_of(&mut self, id: ExprId) -> Option<f64> {
        if !self.model.graph.dependence(id).is_constant() {
            return None;
        }
        let params = &self.model.params;
        self.model.graph.extend_values(&mut self.common.values, |symbol| match symbol {
            Symbol::Param(k) => params[k as usize].value,
            Symbol::Shift(_) => 0.0,
            _ => f64::NAN,
        });
        self.common.values.get(id.index()).copied()
    }
}
