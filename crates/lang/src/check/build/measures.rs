//! Measures and traces.

use super::Builder;
use crate::check::errors;
use crate::check::formulas::{Context, Dim, Value, measure_context, require_dimension};
use crate::model::{Declared, Dimension, Measure, Named, Quantity, Trace, Units};
use mechc_expr::ExprId;
use mechc_syntax::ast::{Expr, ExprKind, ItemKind, Name, WrittenUnit};

impl Builder<'_, '_> {
    /// Lists the measures and traces in the order of the text, those of a part where it is declared.
    pub(super) fn list_measures(&mut self) {
        let mut measures = 0..self.formulas.measures.len();
        let mut parts = 0..self.formulas.parts.len();
        for item in self.formulas.scope.items() {
            match &item.kind {
                ItemKind::Measure { name, .. } => {
                    let Some(k) = measures.next() else { continue };
                    let Some((value, conditions)) = self.formulas.measures[k].made.take() else { continue };
                    if let Some(units) = self.units_of_measure(k, value) {
                        let declared = self.formulas.scope.declared(name);
                        self.formulas.model.measures.push(Measure { declared, value: value.id, conditions, units });
                    }
                }
                ItemKind::Trace { name, point, unit } => self.trace(name, point, unit.as_ref()),
                ItemKind::Part(_) => {
                    if let Some(part) = parts.next() {
                        self.in_part(part, |part| part.list_measures());
                    }
                }
                _ => {}
            }
        }
    }

    fn units_of_measure(&mut self, k: usize, value: Value) -> Option<Units> {
        let (formula, unit) = (self.formulas.measures[k].value, self.formulas.measures[k].unit);
        self.formulas.units(formula, value.dim, unit)
    }

    /// Evaluates the path of a point as two measures.
    fn trace(&mut self, name: &Name, point: &Expr, unit: Option<&WrittenUnit>) {
        let conditions = self.formulas.model.conditions.len();
        let mut fixed = None;
        let coordinates = match &point.bare().kind {
            ExprKind::Tuple(parts) => self.coordinates_of_trace(point, parts),
            _ => self.formulas.point(point).map(|point| {
                fixed = Some(point);
                [Quantity::X(None, point), Quantity::Y(None, point)]
                    .map(|quantity| self.formulas.name_symbol(Named::Quantity(self.formulas.address.part, quantity), 0))
            }),
        };
        let coordinates = coordinates.filter(|pair: &[ExprId; 2]| {
            let is_of_forces = pair.iter().any(|&id| self.formulas.holds_force(id));
            if is_of_forces {
                self.formulas.reporter.report(errors::force_in("a trace", "a force", point.span));
            }
            !is_of_forces
        });
        let conditions_of_both = self.formulas.conditions_in_time(conditions, &name.text);
        let units = self.formulas.units(point, Dim::LENGTH, unit);
        if let (Some(coordinates), Some(units)) = (coordinates, units) {
            let (declared, measure) = (self.formulas.scope.declared(name), self.formulas.model.measures.len());
            self.formulas.model.traces.push(Trace {
                declared,
                part: self.formulas.address.part,
                point: fixed,
                measure,
            });
            for (part, value) in ["x", "y"].into_iter().zip(coordinates) {
                let declared =
                    Declared { name: format!("{}{}.{part}", self.formulas.scope.path, name.text), span: name.span };
                let (conditions, units) = (conditions_of_both.clone(), units.clone());
                self.formulas.model.measures.push(Measure { declared, value, conditions, units });
            }
        }
    }

    /// Evaluates `(pole_x(b), pole_y(b))`, two formulas as in measures.
    fn coordinates_of_trace(&mut self, point: &Expr, parts: &[Expr]) -> Option<[ExprId; 2]> {
        let [x, y] = parts else {
            self.formulas.reporter.report(errors::wrong_kind(
                point.span,
                "a point `(x, y)`",
                &format!("a list of {}", parts.len()),
            ));
            return None;
        };
        let judged = self.formulas.is_dimensional(x) || self.formulas.is_dimensional(y);
        let context = Context { place: "a trace", ..measure_context(judged) };
        let coordinates = [x, y].map(|part| {
            let value = self.formulas.formula(part, &context)?;
            let context = Context { judged: self.formulas.counts(value, &context), ..context };
            require_dimension(
                &mut self.formulas.reporter,
                "a coordinate of a trace",
                Dimension::LENGTH,
                part.span,
                value.dim,
                &context,
            )?;
            Some(value.id)
        });
        Some([coordinates[0]?, coordinates[1]?])
    }
}
