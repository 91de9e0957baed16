//! Models of a continuation: the inputs and the time move on straight lines from the text's values to a target, and parameters from their
//! nominal values (see `lower`).
//!
//! Such a model has no time of its own. Its time is the path parameter, which is 0 at the text's values and 1 at the target. Its motion
//! leads from one start to another, and is not a motion of the mechanism.

use super::formula::Value;
use super::overrides::override_matches;
use super::{Checker, errors};
use crate::model::{Condition, ContinuedParam, Declared, Dimension};
use mechc_expr::{ExprId, Symbol};
use mechc_syntax::ast::Name;

/// The target of a continuation.
#[derive(Clone, Debug, Default)]
pub struct ContinuationPath {
    /// The first and the last time (s).
    pub times: [f64; 2],
    /// The inputs with a numeric target (SI), by their names. The target of other inputs is their value at the last time.
    pub inputs: Vec<(String, f64)>,
}

/// Marks in the list of conditions: those of an input's own formula, and those of its override.
pub(super) struct ConditionMarks {
    /// The number of conditions before the input's own formula.
    pub before: usize,
    /// The number of conditions after it.
    pub after_nominal: usize,
}

impl Checker<'_> {
    /// Returns time as formulas use it (s).
    pub(super) fn time(&mut self) -> ExprId {
        let time = self.model.graph.symbol(Symbol::Time);
        let Some(ContinuationPath { times, .. }) = &self.options.continuation else { return time };
        self.path_line(*times)
    }

    /// Returns the value of an input: during a continuation its line, otherwise the given value.
    pub(super) fn continued_input(
        &mut self,
        name: &Name,
        nominal: Value,
        given: Option<Value>,
        needs: &ConditionMarks,
    ) -> Option<Value> {
        let Some(target) = &self.options.continuation else { return given };
        // The conditions are checked at both ends and do not apply in between.
        let of_given = self.model.conditions.split_off(needs.after_nominal);
        let of_nominal = self.model.conditions.split_off(needs.before);
        let given = given?;
        let declared = self.declared(name);
        let target = target.inputs.iter().find(|(input, _)| *input == declared.name).map(|(_, value)| *value);
        let is_unchanged = given.id == nominal.id;
        let holds = self.hold_at(&of_nominal, 0.0)
            && (target.is_some() || self.hold_at(if is_unchanged { &of_nominal } else { &of_given }, 1.0));
        let line = [self.value_on_path(nominal.id, 0.0), target.unwrap_or_else(|| self.value_on_path(given.id, 1.0))];
        if let Some(value) = line.into_iter().find(|value| !value.is_finite() || !holds) {
            self.report(errors::not_finite(name.span, value));
            return None;
        }
        let dimension = given.dim.settled();
        self.model.continued.push(ContinuedParam { declared, param: None, line, dimension });
        Some(Value { id: self.path_line(line), ..given })
    }

    /// Returns whether a parameter, or a coordinate of one that is a point, may change after the check, so that it is independent.
    pub(super) fn is_open(&self, declared: &Declared, name: &str) -> bool {
        if self.options.open.is_empty() {
            return false;
        }
        let full = format!("{}{name}", self.address.path);
        self.options.open.iter().any(|path| override_matches(&full, path) || override_matches(&declared.name, path))
    }

    /// Records the next parameter of the model as one that may change after the check; `nominal` is its value (SI).
    pub(super) fn record_open_param(&mut self, declared: &Declared, nominal: f64, dimension: Dimension) {
        let param = Some(self.model.params.len() as u32);
        self.model.continued.push(ContinuedParam { declared: declared.clone(), param, line: [nominal; 2], dimension });
    }

    /// Removes the outputs and forces from a model of a continuation.
    pub(super) fn strip_outputs(&mut self) {
        if self.options.continuation.is_some() {
            self.model.strip_outputs();
        }
    }

    fn path_line(&mut self, ends: [f64; 2]) -> ExprId {
        let graph = &mut self.model.graph;
        let (ends, time) = (ends.map(|end| graph.constant(end)), graph.symbol(Symbol::Time));
        graph.line(ends, time)
    }

    /// Returns the value of a formula of time at a path parameter.
    fn value_on_path(&self, id: ExprId, part: f64) -> f64 {
        let params = &self.model.params;
        self.model.graph.value(id, |symbol| match symbol {
            Symbol::Param(k) => params[k as usize].value,
            Symbol::Time => part,
            _ => f64::NAN,
        })
    }

    fn hold_at(&self, conditions: &[Condition], part: f64) -> bool {
        conditions.iter().all(|condition| self.value_on_path(condition.positive, part) > 0.0)
    }
}
