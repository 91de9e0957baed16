//! Values of constant formulas, the lengths among them, and the graph's named symbols.

use super::Formulas;
use crate::check::errors::PlainLength;
use crate::model::{GuardKind, Named};
use mechc_expr::{Dependence, ExprId, Symbol};

/// The constant lengths of a mechanism, recorded as formulas are read.
#[derive(Default)]
pub(in crate::check) struct RecordedLengths<'a> {
    /// The smallest and the largest length with a unit (m).
    pub with_unit: Option<[f64; 2]>,
    pub plain: Vec<PlainLength<'a>>,
}

impl Formulas<'_> {
    /// Returns whether a formula depends on parameters.
    pub(in crate::check) fn follows(&self, id: ExprId) -> bool {
        self.model.graph.dependence(id).on(Dependence::PARAMS)
    }

    /// Returns the named symbol with a meaning. Equal meanings share one symbol.
    pub(in crate::check) fn name_symbol(&mut self, meaning: Named, derivative_order: u8) -> ExprId {
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

    /// Returns the value of a constant formula on which a decision depends.
    pub(in crate::check) fn constant_value(&mut self, id: ExprId) -> Option<f64> {
        self.decided(id, GuardKind::Value)
    }

    /// Returns the value of a constant formula of which one property decides.
    pub(in crate::check) fn decided(&mut self, id: ExprId, by: GuardKind) -> Option<f64> {
        let value = self.number_of(id);
        if value.is_some() {
            self.model.guards.push((id, by));
        }
        value
    }

    /// Returns the value of a constant formula on which no decision depends.
    pub(in crate::check) fn number_of(&mut self, id: ExprId) -> Option<f64> {
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
