//! Inputs that become settable numbers instead of formulas of time, for callers that know from elsewhere where an input is and how it
//! moves.
//!
//! Such an input is a parabola or a straight line in time around a moment. Its value, that moment, its rate and for a parabola its
//! acceleration are parameters of the model, in this order, so that one compilation serves for all their values. The first two can be
//! continued from the text's values.

use crate::check::not_finite;
use crate::model::{ContinuedParam, Declared, Dimension, Mechanism, Param, TimeFormula};
use mechc_expr::{ExprId, Symbol};
use mechc_text::diag::Diagnostic;

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

impl SettableInputs {
    /// Makes these inputs of a model settable. Names that are of no input are ignored.
    ///
    /// # Errors
    /// An input is not finite at the time.
    pub fn add_to(&self, model: &mut Mechanism) -> Result<(), Box<Diagnostic>> {
        for k in 0..model.inputs.len() {
            let input = model.inputs[k].clone();
            if !self.names.contains(&input.declared.name) {
                continue;
            }
            let value = model.value_at(input.formula.value, self.t);
            if !value.is_finite() {
                return Err(not_finite(input.declared.span, value).into());
            }
            let value = self.line(model, &input.declared, value, input.dimension);
            model.inputs[k].formula = TimeFormula { value, conditions: Vec::new() };
        }
        Ok(())
    }

    /// Returns the formula of a settable input, and adds its parameters, which start at a value and at the time.
    fn line(&self, model: &mut Mechanism, declared: &Declared, value: f64, dimension: Dimension) -> ExprId {
        let first = model.params.len() as u32;
        let per = |order: i32| dimension.over(Dimension::TIME.to_the(f64::from(order)));
        for (param, value, dimension) in [(first, value, dimension), (first + 1, self.t, Dimension::TIME)] {
            model.continued.push(ContinuedParam {
                declared: declared.clone(),
                param: Some(param),
                line: [value; 2],
                dimension,
            });
        }
        let params = [(value, dimension), (self.t, Dimension::TIME), (0.0, per(1)), (0.0, per(2))];
        for (value, dimension) in params.into_iter().take(if self.bend { 4 } else { 3 }) {
            model.params.push(Param { declared: declared.clone(), docs: Vec::new(), value, dimension });
        }
        let graph = &mut model.graph;
        let [value, moment, rate] = [0, 1, 2].map(|k| graph.symbol(Symbol::Param(first + k)));
        let time = graph.symbol(Symbol::Time);
        let since = graph.sub(time, moment);
        let gone = graph.mul(rate, since);
        let moved = graph.add(value, gone);
        if !self.bend {
            return moved;
        }
        let acceleration = graph.symbol(Symbol::Param(first + 3));
        let (squared, half) = (graph.mul(since, since), graph.constant(0.5));
        let halved = graph.mul(half, acceleration);
        let bent = graph.mul(halved, squared);
        graph.add(moved, bent)
    }
}
