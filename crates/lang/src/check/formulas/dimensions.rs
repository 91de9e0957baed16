//! Decides which formulas are judged by their dimensions, and compares these.

use super::Formulas;
use super::value::{Context, Dim, Value};
use crate::check::errors::{self, Reporter};
use crate::check::scope::{Entity, Expected, coordinate, point_kinds};
use crate::check::suggest::lost_rate::Part;
use crate::model::Dimension;
use mechc_expr::{Dependence, ExprId};
use mechc_syntax::ast::{Expr, ExprKind, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::Unit;

impl Formulas<'_> {
    /// Returns whether a formula holds a unit of length, time or rate, directly or through names.
    pub(in crate::check) fn is_dimensional(&self, formula: &Expr) -> bool {
        self.is_dimensional_with(None, formula)
    }

    /// Returns whether the formula of a function or curve holds such a unit.
    pub(super) fn is_dimensional_with(&self, argument: Option<&str>, formula: &Expr) -> bool {
        self.holds_dimension(argument, formula, Expected::Number)
    }

    /// Returns whether a formula of numbers or of points holds such a unit.
    pub(super) fn holds_dimension(&self, argument: Option<&str>, formula: &Expr, expected: Expected) -> bool {
        let mut open = vec![(formula, expected, expected != Expected::Number)];
        while let Some((e, expected, with_points)) = open.pop() {
            let holds = match &e.kind {
                ExprKind::Literal { unit: Some((name, _)), .. } => {
                    Unit::named(&name.text).is_some_and(|unit| !unit.dimension.is(Dimension::PURE))
                }
                ExprKind::Name(name) if argument == Some(name.text.as_str()) => false,
                ExprKind::Name(name) if self.body_point(name, expected).is_some() => {
                    self.is_dimensional_point(name, expected)
                }
                ExprKind::Name(name) => self.is_dimensional_name(name),
                ExprKind::Member { owner, feature } if coordinate(feature).is_some() => {
                    self.is_dimensional_point(owner, Expected::Point)
                }
                ExprKind::Call { name, arguments, .. }
                    if self.scope.reduction_word(name, arguments.len()).is_some() =>
                {
                    false
                }
                ExprKind::Call { name, .. }
                    if !self.scope.is_of_language(&name.text) && self.scope.quantity_word(name).is_none() =>
                {
                    self.is_dimensional_name(name)
                }
                // A literal point is independent of the formula of a number around it.
                ExprKind::Tuple(_) if !with_points => continue,
                _ => false,
            };
            if holds {
                return true;
            }
            // The dimension of points matters for `length`, and not for `direction`.
            let with_points = match &e.kind {
                ExprKind::Call { name, .. } if self.scope.is_of_language(&name.text) => match name.text.as_str() {
                    "length" => true,
                    "direction" => false,
                    _ => with_points,
                },
                _ => with_points,
            };
            let inside = point_kinds::inside(e, expected, |name| self.scope.hides(name));
            open.extend(inside.into_iter().map(|(e, expected)| (e, expected, with_points)));
        }
        false
    }

    fn is_dimensional_name(&self, name: &Name) -> bool {
        if let Some(unit) = self.scope.unit_alone(name) {
            return !unit.dimension.is(Dimension::PURE);
        }
        match self.scope.entity(name) {
            Some(Entity::Param(k)) => {
                self.params[k].value.is_some_and(Value::has_a_dimension)
                    || self.params[k].drawn.is_some_and(|drawn| drawn.dimensional)
            }
            Some(Entity::Function(k)) => self.functions[k].dimensional,
            Some(Entity::Table(k)) => self.tables[k].dimensional,
            Some(Entity::Input(k)) => self.value_of_input(k).is_some_and(Value::has_a_dimension),
            Some(Entity::Measure(k)) => self.measure_state(k).is_some_and(|measure| measure.dimensional),
            Some(Entity::Result(k)) => self.result_state(k).is_some_and(|result| result.dimensional),
            _ => false,
        }
    }

    /// Returns whether a formula is a literal zero with an optional sign, also through params.
    pub(in crate::check) fn is_zero(&self, formula: &Expr) -> bool {
        match &formula.bare().kind {
            ExprKind::Literal { value, unit: None } => *value == 0.0,
            ExprKind::Negate(e) => self.is_zero(e),
            ExprKind::Name(name) => match self.scope.entity(name) {
                Some(Entity::Param(k)) => {
                    matches!(self.params[k].value, Some(Value { dim: Dim::Any, .. }))
                }
                _ => false,
            },
            _ => false,
        }
    }

    /// Returns the common dimension of two terms, and reports a mismatch where dimensions count.
    pub(in crate::check) fn unify(
        &mut self,
        what: &str,
        a: (Span, Value),
        b: (Span, Value),
        context: &Context<'_>,
    ) -> Option<Dim> {
        let dims = [a, b].map(|(_, value)| value.dim.when_judged(context.judged));
        let (x, y) = match dims {
            [Dim::Any, other] | [other, Dim::Any] => return Some(other),
            [Dim::Of(x), Dim::Of(y)] => (x, y),
            // A number has the dimension of the other term.
            [Dim::Of(dimension), Dim::Plain { read, .. }] | [Dim::Plain { read, .. }, Dim::Of(dimension)] => {
                return Some(Dim::Of(dimension.marked_by(read)));
            }
            [one @ Dim::Plain { read, .. }, other @ Dim::Plain { .. }] => {
                let fits = one.fits() && other.fits() && read.is(other.settled());
                return Some(Dim::Plain { read: read.marked_by(other.settled()), fits });
            }
        };
        if x.is(y) {
            return Some(Dim::Of(x.marked_by(y)));
        }
        if !self.counts(a.1, context) && !self.counts(b.1, context) {
            return Some(Dim::Plain { read: x.marked_by(y), fits: false });
        }
        let [x, y] = [(a.0, x), (b.0, y)].map(|(span, dimension)| Part { span, dimension });
        let texts = [a.0, b.0].map(|span| self.reporter.text(span));
        let takes_factor = context.quantities && (self.is_of_quantities(b.1.id) || texts[1] == "t");
        self.reporter.report(errors::unlike(what, [x, y], texts, context.time, takes_factor));
        None
    }

    /// Returns whether a value's dimension counts. In a plain formula it does for quantities without a number as factor. (A function is
    /// judged where it is called.)
    pub(in crate::check) fn counts(&self, value: Value, context: &Context<'_>) -> bool {
        context.judged || context.expands && matches!(value.dim, Dim::Of(_)) && self.is_of_quantities(value.id)
    }

    /// Returns whether a formula depends on kinematic quantities or on other named symbols.
    pub(super) fn is_of_quantities(&self, id: ExprId) -> bool {
        self.model.graph.dependence(id).on(Dependence::NAMED)
    }

    /// Returns the dimension of a function whose value is a pure number: unfit if an argument is, plain if an argument depends on no
    /// quantities, else pure.
    pub(super) fn pure_number_dim(&self, arguments: &[(Span, Value)]) -> Dim {
        let is_plain = |value: &Value| !self.is_of_quantities(value.id);
        if arguments.iter().any(|(_, value)| !value.dim.fits()) {
            Dim::UNFIT
        } else if arguments.iter().any(|(_, value)| is_plain(value)) {
            Dim::PLAIN
        } else {
            Dim::PURE
        }
    }
}

/// Requires a dimension where dimensions count.
pub(in crate::check) fn require_dimension(
    reporter: &mut Reporter<'_>,
    place: &str,
    expected: Dimension,
    span: Span,
    found: Dim,
    context: &Context<'_>,
) -> Option<()> {
    match found.when_judged(context.judged) {
        Dim::Of(dimension) if context.judged && !dimension.is(expected) => {
            let text = reporter.text(span);
            reporter.report(errors::wrong_dimension(place, expected, Part { span, dimension }, text));
            None
        }
        _ => Some(()),
    }
}
