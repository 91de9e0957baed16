//! What is said of the params and inputs of a part where it is used.

use super::entity::Entity;
use super::formula::{Context, Dim, Value};
use super::rates;
use super::sites::{Drawn, Site};
use super::{Checker, errors, kinds};
use crate::model::Dimension;
use mechc_expr::ExprId;
use mechc_syntax::ast::{Binding, Name};
use mechc_text::diag::nearest;
use mechc_text::source::Span;

/// What is said of a param where its mechanism is used.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bound {
    /// It is a number; whether its dimension was worked out.
    Number(Value, bool),
    /// It is a point.
    Point(Drawn),
    /// So is one of its coordinates.
    Coordinate(usize, Value, bool),
}

/// A param with what is said of it, and where.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoundParam<'a> {
    pub name: &'a str,
    pub bound: Bound,
    pub span: Option<Span>,
}

/// What is said of the params and inputs of a text where it is used.
#[derive(Default)]
pub(super) struct BoundOutside<'a> {
    pub params: Vec<BoundParam<'a>>,
    pub inputs: Vec<&'a str>,
}

impl<'a> Checker<'a> {
    /// Params, functions, tables and inputs of a part, with what is said of its params.
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

    /// The same of a part whose params go in a circle, which has been said: what they are in its text.
    pub(super) fn definitions_of_part_alone(&mut self, part: usize) {
        let samples = self.samples.clone();
        self.in_part(part, |child| {
            child.samples = samples;
            child.definitions();
        });
    }

    /// The bindings of a part that must be known before it is, those of params; others wait until all parts are.
    pub(super) fn binds_definition(&self, part: usize, binding: &Binding) -> bool {
        let bound = self.parts.get(part).and_then(|child| child.space.get(&binding.name.text));
        !matches!(bound, Some(Entity::Input(_)))
    }

    /// What is said of the params of a part.
    fn params_bound(&mut self, part: usize) -> Vec<BoundParam<'a>> {
        let of_part = self.bindings[part];
        let mut bound: Vec<BoundParam<'a>> = Vec::new();
        for binding in &of_part.bindings {
            let known = self.parts[part].space.get(&binding.name.text);
            let before = of_part.bindings.iter().take_while(|other| other.span != binding.span);
            if let Some(first) = before.into_iter().find(|other| is_twice(other, binding)) {
                self.report(errors::bound_twice(binding, first.span));
                continue;
            }
            match known {
                Some(Entity::Param(_)) => {
                    let is_point = self.parts[part].point_params.contains(binding.name.text.as_str());
                    if let Some(value) = self.param_bound(binding, is_point) {
                        bound.push(BoundParam { name: &binding.name.text, bound: value, span: Some(binding.span) });
                    }
                }
                Some(Entity::Input(_)) if binding.coordinate.is_none() => {}
                Some(Entity::Broken) => {}
                other => self.nothing_to_bind(part, binding, other),
            }
        }
        bound
    }

    fn nothing_to_bind(&mut self, part: usize, binding: &Binding, found: Option<Entity>) {
        let child = &self.parts[part];
        let known: Vec<&str> = child.space.names(|e| matches!(e, Entity::Param(_) | Entity::Input(_))).collect();
        let meant = nearest(&binding.name.text, known.iter().copied());
        let mechanism = &child.tree.name.text;
        let diagnostic = errors::nothing_to_bind(mechanism, binding, found.map(Entity::noun), &known, meant);
        self.report(diagnostic);
    }

    fn param_bound(&mut self, binding: &'a Binding, is_point: bool) -> Option<Bound> {
        let value = &binding.value;
        let context = Context::constant("a binding of a param");
        if let Some(coordinate) = &binding.coordinate {
            let Some(k) = kinds::coordinate(coordinate).filter(|_| is_point) else {
                self.report(errors::no_coordinate_to_bind(binding, coordinate, is_point));
                return None;
            };
            let judged = self.is_dimensional(value);
            let number = self.formula(value, &Context { judged, ..context })?;
            return Some(Bound::Coordinate(k, number, judged));
        }
        if is_point {
            if !self.is_point(value) {
                self.report(errors::number_for_point(binding));
                return None;
            }
            return self.at_site(Site::Mechanism, None, |c| c.point_formula(value, &context)).map(Bound::Point);
        }
        let judged = self.is_dimensional(value);
        let number = self.formula(value, &Context { judged, ..context })?;
        self.constant_value(number.id);
        Some(Bound::Number(if self.is_zero(value) { Value { dim: Dim::Any, ..number } } else { number }, judged))
    }

    /// A constant that is known as a number.
    pub(super) fn number_bound(&mut self, value: f64) -> Bound {
        Bound::Number(Value { id: self.model.graph.constant(value), dim: Dim::Any }, false)
    }

    /// A param with what is said of it where its mechanism is used.
    #[allow(clippy::option_option)] // not bound, or broken
    pub(super) fn as_bound(&mut self, name: &Name, in_file: Value) -> Option<Option<Value>> {
        let BoundParam { bound: Bound::Number(value, judged), span, .. } = *self.bound_param(name)? else {
            return None;
        };
        // a number without a unit is a pure number, as one that is set from outside
        let unlike = in_file.dim.other_than(value.dim).filter(|[wanted, _]| judged || !wanted.is(Dimension::PURE));
        if let (Some([wanted, found]), Some(span)) = (unlike, span) {
            let place = format!("the parameter `{}`", name.text);
            let part = rates::Part { span, dimension: found };
            self.report(errors::wrong_dimension(&place, wanted, part, self.sources.text(span)));
            return Some(None);
        }
        let dim = if in_file.dim == Dim::Any { value.dim } else { in_file.dim };
        if self.deciding.contains(&name.text)
            && let Some(number) = self.constant_value(value.id)
        {
            return Some(Some(Value { id: self.model.graph.constant(number), dim }));
        }
        let declared = self.declared(name);
        Some(Some(self.with_shift(&declared, Value { id: value.id, dim })))
    }

    /// What is said of a param where its mechanism is used.
    pub(super) fn bound_param(&self, name: &Name) -> Option<&BoundParam<'a>> {
        self.bound.params.iter().find(|bound| bound.name == name.text)
    }

    /// A point with what is said of it, or of its coordinates, where its mechanism is used.
    pub(super) fn point_as_bound(&mut self, name: &Name, mut point: Drawn) -> Option<Drawn> {
        for k in 0..self.bound.params.len() {
            let BoundParam { name: bound_name, bound, span } = self.bound.params[k];
            if bound_name != name.text {
                continue;
            }
            match bound {
                Bound::Point(bound) => {
                    let is_zero = bound.at.iter().all(|&id| self.constant_value(id) == Some(0.0));
                    if let Some(span) = span.filter(|_| point.dimensional && !bound.dimensional && !is_zero) {
                        let plain = rates::Part { span, dimension: Dimension::PURE };
                        let place = format!("the point `{}`", name.text);
                        let text = self.sources.text(span);
                        self.report(errors::wrong_dimension(&place, Dimension::LENGTH, plain, text));
                        return None;
                    }
                    point = bound;
                }
                Bound::Coordinate(axis, value, judged) => {
                    let place = format!("the coordinate `{}.{}`", name.text, ["x", "y"][axis]);
                    let judged = judged || point.dimensional;
                    let context = Context { judged, ..Context::constant("a binding of a param") };
                    let span = span.unwrap_or(name.span);
                    self.demand(&place, Dimension::LENGTH, span, value.dim, &context)?;
                    point.at[axis] = value.id;
                    point.dimensional |= judged;
                }
                Bound::Number(..) => {}
            }
        }
        Some(point)
    }

    /// What is bound of its params, as far as it could be read.
    pub(super) fn bound_numbers(&self) -> Vec<(String, ExprId)> {
        let numbers = |bound: &BoundParam<'_>| match bound.bound {
            Bound::Number(value, _) => vec![(bound.name.to_owned(), value.id)],
            Bound::Point(Drawn { at: [x, y], .. }) => {
                vec![(format!("{}.x", bound.name), x), (format!("{}.y", bound.name), y)]
            }
            Bound::Coordinate(axis, value, _) => vec![(format!("{}.{}", bound.name, ["x", "y"][axis]), value.id)],
        };
        self.bound.params.iter().flat_map(numbers).collect()
    }

    /// Params that are known as numbers (SI), as if they were bound: those of a part that stands alone.
    pub(super) fn bind_numbers(&mut self, numbers: &'a [(String, f64)]) {
        for (name, value) in numbers {
            let bound = self.number_bound(*value);
            let coordinate = name.rsplit_once('.').zip(match bound {
                Bound::Number(value, _) => Some(value),
                _ => None,
            });
            let param = match coordinate {
                Some(((owner, axis), value)) => BoundParam {
                    name: owner,
                    bound: Bound::Coordinate(usize::from(axis == "y"), value, false),
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
