//! Derivatives by inputs and parameters: those in measures, and the columns appended for them.

use super::Lowering;
use crate::model::{Mechanism, quotient};
use mechc_expr::{Dependence, ExprId};
use mechc_ir::{Coordinate, DerivativeColumn, Measure, Reaction, Variable, Variations};

/// Returns the variables of derivatives; `None` if there are no variables.
pub(super) fn variables(model: &Mechanism) -> Option<Variations> {
    let variable = |of: &crate::model::Variable| Variable {
        name: of.declared.name.clone(),
        symbol: of.symbol,
        unit: of.dimension.display_unit(),
        span: of.declared.span,
    };
    let variables: Vec<Variable> = model.variables.iter().map(variable).collect();
    (!variables.is_empty()).then(|| Variations::of(variables))
}

/// The endings of columns by the order of their time derivative.
const ENDINGS: [&str; 3] = ["", ".d", ".dd"];

impl Lowering<'_> {
    /// Returns the derivative of an expression by a variable.
    pub(super) fn derivative_by(&mut self, id: ExprId, variable: u32) -> ExprId {
        match &mut self.variations {
            Some(variations) => variations.derivatives(&mut self.graph, &[id], variable)[0],
            None => self.graph.constant(0.0),
        }
    }

    /// Returns whether a formula has derivatives by a variable: it has none if it holds third derivatives of the coordinates, also through
    /// loads, or if it is a second such derivative already.
    pub(super) fn can_be_varied(&mut self, formula: ExprId) -> bool {
        let times = self.variations.as_ref().map_or(0, |variations| variations.times(&self.graph, formula));
        let dependence = self.graph.dependence(formula);
        times < 2 && !is_third(dependence) && (!dependence.on(Dependence::FORCES) || !self.loads_hold_jerks())
    }

    /// Returns whether a load holds a third derivative of the coordinates. The answer is cached.
    fn loads_hold_jerks(&mut self) -> bool {
        if let Some(cached) = self.loads_hold_jerks {
            return cached;
        }
        let model = self.model;
        let holds_jerks = model.loads.iter().any(|load| {
            let force = self.formula(load.force);
            is_third(self.graph.dependence(force))
        });
        *self.loads_hold_jerks.insert(holds_jerks)
    }

    /// Appends the derivatives of all columns that can be differentiated, by each variable of `by`.
    pub(super) fn append_derivatives(&mut self, reactions: &[Reaction], measures: &[Measure]) {
        for &variable in &self.model.by {
            for order in 0..ENDINGS.len() {
                for k in 0..self.coordinates.len() {
                    self.append_coordinate_derivative(k, order, variable);
                }
                if order == 0 {
                    for of in reactions {
                        self.append_reaction_derivative(of, variable);
                    }
                }
                for (k, measure) in measures.iter().enumerate() {
                    let value = [Some(measure.value), measure.first, measure.second][order];
                    if let Some(value) = value {
                        self.append_measure_derivative(k, measure, order, value, variable);
                    }
                }
            }
        }
    }

    fn append_coordinate_derivative(&mut self, k: usize, order: usize, variable: u32) {
        let id = self.graph.symbol(mechc_expr::Symbol::Coordinate { index: k as u32, order: order as u8 });
        let value = self.derivative_by(id, variable);
        let Coordinate { name, kind, .. } = &self.coordinates[k];
        let unit = per_second(kind.unit(), order);
        self.append(&(name.clone() + ENDINGS[order]), value, variable, &unit, [1.0; 3]);
    }

    /// Forces have no time derivatives.
    fn append_reaction_derivative(&mut self, of: &Reaction, variable: u32) {
        if !self.can_be_varied(of.value) {
            return;
        }
        let value = self.derivative_by(of.value, variable);
        self.append(&of.name, value, variable, &of.unit, [1.0; 3]);
    }

    /// Measures that need too high derivatives have no column.
    fn append_measure_derivative(&mut self, k: usize, measure: &Measure, order: usize, value: ExprId, variable: u32) {
        if !self.can_be_varied(value) {
            return;
        }
        let holds = self.all_hold(&self.model.measures[k].conditions);
        let value = self.derivative_by(value, variable);
        let value = self.only_where(holds, value);
        let (unit, scale) = (&measure.units.printed[order], measure.units.scale);
        self.append(&format!("{}{}", measure.name, ENDINGS[order]), value, variable, unit, scale);
    }

    fn append(&mut self, of: &str, value: ExprId, variable: u32, unit: &str, scale: [f64; 3]) {
        if let Some(variations) = &mut self.variations {
            let by = &variations.variables[variable as usize];
            let (name, unit) = (format!("{of}.by.{}", by.name), quotient(unit, &by.unit));
            variations.appended.push(DerivativeColumn { name, value, variable, unit, scale });
        }
    }
}

fn is_third(dependence: Dependence) -> bool {
    dependence.highest_order() == Some(3)
}

fn per_second(unit: &str, order: usize) -> String {
    let unit = if unit.is_empty() { "1" } else { unit };
    unit.to_owned() + ["", "/s", "/s^2"][order]
}
