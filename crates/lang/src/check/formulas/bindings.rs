//! Bindings of the params and inputs of a part.

use super::Formulas;
use super::dimensions::require_dimension;
use super::formula_scope::{FormulaSite, InitialPoint};
use super::value::{Context, Dim, Value};
use crate::check::errors;
use crate::check::scope::{Entity, point_kinds};
use crate::check::suggest::lost_rate;
use crate::model::Dimension;
use mechc_expr::ExprId;
use mechc_syntax::ast::{Binding, Name};
use mechc_text::diag::nearest;
use mechc_text::source::Span;

/// The bound value of a param.
#[derive(Clone, Copy, Debug)]
pub(in crate::check) enum BoundValue {
    /// A number, and whether its dimension is checked.
    Number(Value, bool),
    /// A point.
    Point(InitialPoint),
    /// A coordinate of a point, and whether its dimension is checked.
    Coordinate(usize, Value, bool),
}

/// The binding of a param, with its location.
#[derive(Clone, Copy, Debug)]
pub(in crate::check) struct BoundParam<'a> {
    pub name: &'a str,
    pub bound: BoundValue,
    pub span: Option<Span>,
}

/// The bindings of a text's params and inputs by the mechanism that uses it.
#[derive(Default)]
pub(in crate::check) struct ExternalBindings<'a> {
    pub params: Vec<BoundParam<'a>>,
    pub inputs: Vec<&'a str>,
}

impl<'a> Formulas<'a> {
    /// Evaluates the definitions of a part with its bindings.
    pub(super) fn definitions_of_part(&mut self, part: usize) {
        let bound = self.params_bound(part);
        let samples = self.samples.clone();
        self.in_part(part, |child| {
            child.bound.params = bound;
            child.samples = samples;
            child.definitions();
        });
        self.import_params_of(part);
    }

    /// Evaluates the definitions of a part without bindings, as these form a cycle, which is reported.
    pub(super) fn definitions_of_unbound_part(&mut self, part: usize) {
        let samples = self.samples.clone();
        self.in_part(part, |child| {
            child.samples = samples;
            child.definitions();
        });
    }

    /// Returns whether a binding is one of a param, which must be evaluated before the part. Others follow after all parts.
    pub(super) fn binds_definition(&self, part: usize, binding: &Binding) -> bool {
        let bound = self.parts.get(part).and_then(|child| child.scope.get(&binding.name.text));
        !matches!(bound, Some(Entity::Input(_)))
    }

    /// Evaluates the bindings of a part's params.
    fn params_bound(&mut self, part: usize) -> Vec<BoundParam<'a>> {
        let of_part = self.part_declarations[part];
        let mut bound: Vec<BoundParam<'a>> = Vec::new();
        for binding in &of_part.bindings {
            let entity = self.parts[part].scope.get(&binding.name.text);
            let before = of_part.bindings.iter().take_while(|other| other.span != binding.span);
            if let Some(first) = before.into_iter().find(|other| is_twice(other, binding)) {
                self.reporter.report(errors::bound_twice(binding, first.span));
                continue;
            }
            match entity {
                Some(Entity::Param(_)) => {
                    let is_point = self.parts[part].scope.is_point_name(&binding.name.text);
                    if let Some(value) = self.param_bound(binding, is_point) {
                        bound.push(BoundParam { name: &binding.name.text, bound: value, span: Some(binding.span) });
                    }
                }
                Some(Entity::Input(_)) if binding.coordinate.is_none() => {}
                Some(Entity::Broken) => {}
                other => self.no_name_to_bind(part, binding, other),
            }
        }
        bound
    }

    fn no_name_to_bind(&mut self, part: usize, binding: &Binding, found: Option<Entity>) {
        let child = &self.parts[part];
        let candidates: Vec<&str> = child.scope.names(|e| matches!(e, Entity::Param(_) | Entity::Input(_))).collect();
        let suggestion = nearest(&binding.name.text, candidates.iter().copied());
        let mechanism = &child.scope.tree.name.text;
        let diagnostic = errors::no_name_to_bind(mechanism, binding, found.map(Entity::noun), &candidates, suggestion);
        self.reporter.report(diagnostic);
    }

    fn param_bound(&mut self, binding: &'a Binding, is_point: bool) -> Option<BoundValue> {
        let value = &binding.value;
        let context = Context::constant("a binding of a param");
        if let Some(coordinate) = &binding.coordinate {
            let Some(k) = point_kinds::coordinate(coordinate).filter(|_| is_point) else {
                self.reporter.report(errors::no_coordinate_to_bind(binding, coordinate, is_point));
                return None;
            };
            let judged = self.is_dimensional(value);
            let number = self.formula(value, &Context { judged, ..context })?;
            return Some(BoundValue::Coordinate(k, number, judged));
        }
        if is_point {
            if !self.is_point(value) {
                self.reporter.report(errors::number_for_point(binding));
                return None;
            }
            return self
                .at_site(FormulaSite::Mechanism, None, |c| c.point_formula(value, &context))
                .map(BoundValue::Point);
        }
        let judged = self.is_dimensional(value);
        let number = self.formula(value, &Context { judged, ..context })?;
        self.constant_value(number.id);
        Some(BoundValue::Number(if self.is_zero(value) { Value { dim: Dim::Any, ..number } } else { number }, judged))
    }

    /// Returns a known number as a bound value.
    pub(in crate::check) fn number_bound(&mut self, value: f64) -> BoundValue {
        BoundValue::Number(Value { id: self.model.graph.constant(value), dim: Dim::Any }, false)
    }

    /// Returns the value of a param with its binding. The outer `None` stands for no binding, the inner one for a broken one.
    #[allow(clippy::option_option)] // not bound, or broken
    pub(super) fn value_with_binding(&mut self, name: &Name, in_file: Value) -> Option<Option<Value>> {
        let BoundParam { bound: BoundValue::Number(value, judged), span, .. } = *self.bound_param(name)? else {
            return None;
        };
        // A number without a unit is a pure number, as in an override.
        let unlike = in_file.dim.other_than(value.dim).filter(|[expected, _]| judged || !expected.is(Dimension::PURE));
        if let (Some([expected, found]), Some(span)) = (unlike, span) {
            let place = format!("the parameter `{}`", name.text);
            let part = lost_rate::Part { span, dimension: found };
            self.reporter.report(errors::wrong_dimension(&place, expected, part, self.reporter.text(span)));
            return Some(None);
        }
        let dim = if in_file.dim == Dim::Any { value.dim } else { in_file.dim };
        if self.scope.deciding.contains(&name.text)
            && let Some(number) = self.constant_value(value.id)
        {
            return Some(Some(Value { id: self.model.graph.constant(number), dim }));
        }
        let declared = self.scope.declared(name);
        Some(Some(self.with_shift(&declared, Value { id: value.id, dim })))
    }

    /// Returns the binding of a param.
    pub(super) fn bound_param(&self, name: &Name) -> Option<&BoundParam<'a>> {
        self.bound.params.iter().find(|bound| bound.name == name.text)
    }

    /// Returns a point with the bindings of it or of its coordinates.
    pub(super) fn point_with_binding(&mut self, name: &Name, mut point: InitialPoint) -> Option<InitialPoint> {
        for k in 0..self.bound.params.len() {
            let BoundParam { name: bound_name, bound, span } = self.bound.params[k];
            if bound_name != name.text {
                continue;
            }
            match bound {
                BoundValue::Point(bound) => {
                    let is_zero = bound.at.iter().all(|&id| self.constant_value(id) == Some(0.0));
                    if let Some(span) = span.filter(|_| point.dimensional && !bound.dimensional && !is_zero) {
                        let plain = lost_rate::Part { span, dimension: Dimension::PURE };
                        let place = format!("the point `{}`", name.text);
                        let text = self.reporter.text(span);
                        self.reporter.report(errors::wrong_dimension(&place, Dimension::LENGTH, plain, text));
                        return None;
                    }
                    point = bound;
                }
                BoundValue::Coordinate(axis, value, judged) => {
                    let place = format!("the coordinate `{}.{}`", name.text, ["x", "y"][axis]);
                    let judged = judged || point.dimensional;
                    let context = Context { judged, ..Context::constant("a binding of a param") };
                    let span = span.unwrap_or(name.span);
                    require_dimension(&mut self.reporter, &place, Dimension::LENGTH, span, value.dim, &context)?;
                    point.at[axis] = value.id;
                    point.dimensional |= judged;
                }
                BoundValue::Number(..) => {}
            }
        }
        Some(point)
    }

    /// Returns the bound params with the expressions of their numbers.
    pub(in crate::check) fn bound_numbers(&self) -> Vec<(String, ExprId)> {
        let numbers = |bound: &BoundParam<'_>| match bound.bound {
            BoundValue::Number(value, _) => vec![(bound.name.to_owned(), value.id)],
            BoundValue::Point(InitialPoint { at: [x, y], .. }) => {
                vec![(format!("{}.x", bound.name), x), (format!("{}.y", bound.name), y)]
            }
            BoundValue::Coordinate(axis, value, _) => vec![(format!("{}.{}", bound.name, ["x", "y"][axis]), value.id)],
        };
        self.bound.params.iter().flat_map(numbers).collect()
    }

    /// Binds params to known numbers (SI), for a part that is checked on its own.
    pub(in crate::check) fn bind_numbers(&mut self, numbers: &'a [(String, f64)]) {
        for (name, value) in numbers {
            let bound = self.number_bound(*value);
            let coordinate = name.rsplit_once('.').zip(match bound {
                BoundValue::Number(value, _) => Some(value),
                _ => None,
            });
            let param = match coordinate {
                Some(((owner, axis), value)) => BoundParam {
                    name: owner,
                    bound: BoundValue::Coordinate(usize::from(axis == "y"), value, false),
                    span: None,
                },
                None => BoundParam { name, bound, span: None },
            };
            self.bound.params.push(param);
        }
    }
}

fn is_twice(a: &Binding, b: &Binding) -> bool {
    let coordinates = [a, b].map(|binding| binding.coordinate.as_ref().map(|name| name.text.as_str()));
    a.name.text == b.name.text && (coordinates[0] == coordinates[1] || coordinates.contains(&None))
}
