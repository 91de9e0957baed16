//! The state of measures, and how their formulas are read.

use super::Formulas;
use super::value::{Context, Value};
use crate::model::Condition;
use mechc_syntax::ast::{Expr, Name, WrittenUnit};

/// The state of a measure.
pub(in crate::check) struct MeasureState<'a> {
    pub name: &'a Name,
    pub value: &'a Expr,
    /// The unit in which it is printed, if there is one.
    pub unit: Option<&'a WrittenUnit>,
    pub dimensional: bool,
    pub sound: bool,
    /// The value with its conditions, from its evaluation until it is listed.
    pub made: Option<(Value, Vec<Condition>)>,
}

impl<'a> MeasureState<'a> {
    pub fn new(name: &'a Name, value: &'a Expr, unit: Option<&'a WrittenUnit>) -> MeasureState<'a> {
        MeasureState { name, value, unit, dimensional: false, sound: false, made: None }
    }
}

impl Formulas<'_> {
    /// Evaluates measures: those of parts first, then in order of dependence.
    pub(in crate::check) fn measure_values(&mut self) {
        self.in_parts(Formulas::measure_values);
        for k in std::mem::take(&mut self.measure_order) {
            let conditions = self.model.conditions.len();
            let formula = self.measures[k].value;
            let value = self.formula(formula, &measure_context(self.measures[k].dimensional));
            let owner = self.scope.declared(self.measures[k].name).name;
            let conditions = self.conditions_in_time(conditions, &owner);
            self.measures[k].made = value.map(|value| (value, conditions));
            self.measures[k].sound = value.is_some();
        }
    }

    /// Returns the conditions from index `from` on, which belong to a measure or trace. Those of parameters alone hold always or never, and
    /// are checked at once.
    pub(in crate::check) fn conditions_in_time(&mut self, from: usize, owner: &str) -> Vec<Condition> {
        let mut conditions = self.model.conditions.split_off(from);
        for condition in &mut conditions {
            owner.clone_into(&mut condition.owner);
        }
        let graph = &self.model.graph;
        let (always, at_times) = conditions.into_iter().partition(|c| graph.dependence(c.positive).is_constant());
        self.model.conditions.append(&mut { always });
        at_times
    }
}

/// Returns the context in which the formula of a measure is read.
pub(in crate::check) fn measure_context(judged: bool) -> Context<'static> {
    let context = Context::constant("a measure");
    Context { judged, time: true, inputs: true, quantities: true, rates: true, measures: true, ..context }
}
