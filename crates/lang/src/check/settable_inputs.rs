//! Inputs that become settable numbers instead of formulas of time, for callers that know from elsewhere where an input is and how it
//! moves.
//!
//! Such an input is a parabola or a straight line in time around a moment. Its value, that moment, its rate and for a parabola its
//! acceleration are parameters of the model, in this order, so that one compilation serves for all their values. The first two can be
//! continued from the text's values.

use super::formula::Value;
use super::{Checker, errors};
use crate::model::{ContinuedParam, Declared, Dimension, Param};
use mechc_expr::{ExprId, Symbol};
use mechc_syntax::ast::Name;

/// The inputs that become settable.
#[derive(Clone, Debug, Default)]
pub struct SettableInputs {
    /// The time at which they start with the text's values (s).
    pub t: f64,
    /// Their names, prefixed with those of their parts.
    pub names: Vec<String>,
    /// True if they have accelerations. Straight lines keep the equations simpler.
    pub bend: bool,
}

impl Checker<'_> {
    /// Returns the settable line of an input, or its value if it is not settable. The conditions of its own formula, after the first
    /// `before`, are dropped.
    pub(super) fn set_input(&mut self, name: &Name, nominal: Value, before: usize) -> Option<Value> {
        let declared = self.declared(name);
        let Some(SettableInputs { t, bend, .. }) =
            self.options.set_inputs.as_ref().filter(|set| set.names.contains(&declared.name))
        else {
            return Some(nominal);
        };
        let (t, bends, params) = (*t, *bend, &self.model.params);
        let value = self.model.graph.value(nominal.id, |symbol| match symbol {
            Symbol::Param(k) => params[k as usize].value,
            Symbol::Time => t,
            _ => f64::NAN,
        });
        if !value.is_finite() {
            self.report(errors::not_finite(name.span, value));
            return None;
        }
        self.model.conditions.truncate(before);
        let dimension = nominal.dim.settled();
        let id = self.line(&declared, [value, t], dimension, bends);
        Some(Value { id, ..nominal })
    }

    /// Returns the formula of a settable input, and adds its parameters, which start at a value and a time (s).
    fn line(&mut self, declared: &Declared, [value, t]: [f64; 2], dimension: Dimension, bends: bool) -> ExprId {
        let first = self.model.params.len() as u32;
        let per = |order: i32| dimension.over(Dimension::TIME.to_the(f64::from(order)));
        for (param, value, dimension) in [(first, value, dimension), (first + 1, t, Dimension::TIME)] {
            self.model.continued.push(ContinuedParam {
                declared: declared.clone(),
                param: Some(param),
                line: [value; 2],
                dimension,
            });
        }
        let params = [(value, dimension), (t, Dimension::TIME), (0.0, per(1)), (0.0, per(2))];
        for (value, dimension) in params.into_iter().take(if bends { 4 } else { 3 }) {
            self.model.params.push(Param { declared: declared.clone(), docs: Vec::new(), value, dimension });
        }
        let graph = &mut self.model.graph;
        let [value, moment, rate] = [0, 1, 2].map(|k| graph.symbol(Symbol::Param(first + k)));
        let time = graph.symbol(Symbol::Time);
        let since = graph.sub(time, moment);
        let gone = graph.mul(rate, since);
        let moved = graph.add(value, gone);
        if !bends {
            return moved;
        }
        let acceleration = graph.symbol(Symbol::Param(first + 3));
        let (squared, half) = (graph.mul(since, since), graph.constant(0.5));
        let halved = graph.mul(half, acceleration);
        let bent = graph.mul(halved, squared);
        graph.add(moved, bent)
    }
}
