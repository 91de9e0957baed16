//! Inputs that are numbers which may be set, instead of formulas of time: for who knows from elsewhere where an input is, and how it moves
//! on from there.
//!
//! Such an input is a parabola of time around a moment, or a straight line. Its value and that moment, its rate and, of a parabola, its
//! acceleration are parameters of the model, in this order, so that a mechanism is compiled once for all that they may be. The first two
//! can be led from what the text says.

use super::formula::Value;
use super::{Checker, errors};
use crate::model::{Declared, Dimension, Led, Param};
use mechc_expr::{ExprId, Symbol};
use mechc_syntax::ast::Name;

/// Which inputs may be set.
#[derive(Clone, Debug, Default)]
pub struct SetInputs {
    /// They begin with what the text says at this time (s).
    pub t: f64,
    /// Their names, with the parts before them.
    pub names: Vec<String>,
    /// Whether they may have accelerations; else they go straight on, which keeps the equations plain.
    pub bend: bool,
}

impl Checker<'_> {
    /// What an input is that may be set; what it is anyway, where it may not. Its own formula asks for nothing then: the conditions behind
    /// the first `before` are its own.
    pub(super) fn set_input(&mut self, name: &Name, own: Value, before: usize) -> Option<Value> {
        let declared = self.declared(name);
        let Some(SetInputs { t, bend, .. }) =
            self.around.set_inputs.as_ref().filter(|set| set.names.contains(&declared.name))
        else {
            return Some(own);
        };
        let (t, bends, params) = (*t, *bend, &self.model.params);
        let value = self.model.graph.value(own.id, |symbol| match symbol {
            Symbol::Param(k) => params[k as usize].value,
            Symbol::Time => t,
            _ => f64::NAN,
        });
        if !value.is_finite() {
            self.report(errors::not_finite(name.span, value));
            return None;
        }
        self.model.conditions.truncate(before);
        let dimension = own.dim.settled();
        let id = self.line(&declared, [value, t], (dimension, bends));
        Some(Value { id, ..own })
    }

    /// The formula of an input that is set, with its parameters, which begin with a value at a time (s).
    fn line(&mut self, declared: &Declared, [value, t]: [f64; 2], (dimension, bends): (Dimension, bool)) -> ExprId {
        let first = self.model.params.len() as u32;
        let per = |order: i32| dimension.over(Dimension::TIME.to_the(f64::from(order)));
        for (param, own, dimension) in [(first, value, dimension), (first + 1, t, Dimension::TIME)] {
            self.model.led.push(Led { declared: declared.clone(), param: Some(param), line: [own; 2], dimension });
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
