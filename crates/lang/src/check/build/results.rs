//! Results, which follow all that rows need.

use super::Builder;
use crate::check::formulas::Value;
use crate::model::{Outcome, Units};
use mechc_syntax::ast::ItemKind;

impl Builder<'_, '_> {
    /// Evaluates and lists the results. They follow all that rows need.
    pub(in crate::check) fn results(&mut self) {
        self.formulas.model.named_before_results = self.formulas.model.named.len();
        self.formulas.result_values();
        self.list_results();
    }

    /// Lists the results in the order of the text, those of a part where it is declared.
    fn list_results(&mut self) {
        let (mut numbers, mut parts) = (0..self.formulas.results.len(), 0..self.formulas.parts.len());
        for item in self.formulas.scope.items() {
            match &item.kind {
                ItemKind::Result { name, .. } => {
                    let Some(k) = numbers.next() else { continue };
                    let Some(value) = self.formulas.results[k].value else { continue };
                    if let Some(units) = self.units_of_result(k, value) {
                        let declared = self.formulas.scope.declared(name);
                        self.formulas.model.outcomes.push(Outcome { declared, value: value.id, units });
                    }
                }
                ItemKind::Part(_) => {
                    if let Some(part) = parts.next() {
                        self.in_part(part, |part| part.list_results());
                    }
                }
                _ => {}
            }
        }
    }

    fn units_of_result(&mut self, k: usize, value: Value) -> Option<Units> {
        let (formula, unit) = (self.formulas.results[k].formula, self.formulas.results[k].unit);
        self.formulas.units(formula, value.dim, unit)
    }
}
