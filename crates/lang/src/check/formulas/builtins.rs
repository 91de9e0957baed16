//! Calls of the language's functions.

use super::Formulas;
use super::dimensions::require_dimension;
use super::value::{Context, Dim, Value};
use crate::check::errors;
use crate::model::{Condition, ConditionKind, Dimension};
use mechc_expr::{Binary, ExprId, MotionLaw, Unary};
use mechc_syntax::ast::{Expr, Name};
use mechc_text::source::Span;
use mechc_text::vocabulary::{Function, Group};

/// An argument with its location.
type Argument = (Span, Value);

impl Formulas<'_> {
    /// Evaluates a call of a function or kinematic quantity of the language.
    pub(super) fn builtin(
        &mut self,
        e: &Expr,
        name: &Name,
        arguments: &[Expr],
        context: &Context<'_>,
    ) -> Option<Value> {
        let Some(function) = Function::named(&name.text) else {
            return self.quantity(e, name, arguments, context);
        };
        if arguments.len() < function.least || arguments.len() > function.most {
            self.report_count_of(e, name, function, arguments);
            return None;
        }
        // A function's formula is checked on its own.
        if let ("sin" | "cos" | "tan", [argument], true) =
            (name.text.as_str(), arguments, self.reporter.caller.is_none())
        {
            self.warn_of_degrees(argument);
        }
        if let (Group::Derivative, [argument]) = (function.group, arguments) {
            return self.derivative(e, argument, context);
        }
        if let (Group::Derivative, [of, by]) = (function.group, arguments) {
            return self.derivative_by(e, [of, by], context);
        }
        if function.group == Group::Points {
            return self.number_of_points(e, name, arguments, context);
        }
        match function.group {
            Group::Alike => self.warn_of_numbers_as_radians(arguments.iter(), context),
            Group::Motion => {
                self.warn_of_numbers_as_radians([0, 1, 3].into_iter().filter_map(|k| arguments.get(k)), context);
                self.warn_of_numbers_as_radians([2, 4].into_iter().filter_map(|k| arguments.get(k)), context);
            }
            _ => {}
        }
        let values: Vec<Option<Value>> = arguments.iter().map(|argument| self.number(argument, context)).collect();
        let values: Vec<Argument> = arguments
            .iter()
            .zip(values)
            .map(|(argument, value)| value.map(|value| (argument.span, value)))
            .collect::<Option<_>>()?;
        self.apply(function, &values, context)
    }

    fn report_count_of(&mut self, e: &Expr, name: &Name, function: &Function, arguments: &[Expr]) {
        let (expected, found) = (function.takes(), arguments.len());
        let diagnostic = errors::argument_count(&name.text, Some(&function.word), e.span, &expected, found);
        let reduces = self.scope.reduction_word(name, found).is_some();
        let diagnostic = if reduces { diagnostic.help(errors::REDUCES) } else { diagnostic };
        self.report_argument_count(name, diagnostic, arguments, function.most);
    }

    fn apply(&mut self, function: &Function, arguments: &[Argument], context: &Context<'_>) -> Option<Value> {
        let name = function.word.name;
        match function.group {
            Group::Pure => {
                let (span, value) = arguments[0];
                require_dimension(
                    &mut self.reporter,
                    &format!("the argument of `{name}`"),
                    Dimension::PURE,
                    span,
                    value.dim,
                    context,
                )?;
                let id = self.model.graph.unary(Unary::named(name)?, value.id);
                if ["asin", "acos"].contains(&name) && self.report_no_such_angle(span, name, value) {
                    return None;
                }
                let dim = if value.dim.is_pure() { self.pure_number_dim(arguments) } else { Dim::UNFIT };
                let dim = if ["asin", "acos", "atan"].contains(&name) { dim.of_angle() } else { dim };
                Some(Value { id, dim })
            }
            Group::Motion => self.motion(name, MotionLaw::named(name)?, arguments, context),
            Group::Polynomial => self.polynomial(arguments, context),
            // A derivative is taken of a formula, not of its value; points are not numbers.
            Group::Alike | Group::Derivative | Group::Points => self.apply_to_alike(name, arguments, context),
        }
    }

    /// Reports a constant argument of `asin` or `acos` whose magnitude exceeds 1.
    fn report_no_such_angle(&mut self, span: Span, function: &str, argument: Value) -> bool {
        let number = self.number_of(argument.id).filter(|number| number.is_finite() && number.abs() > 1.0);
        let Some(number) = number.filter(|_| !self.branch.is_untaken) else { return false };
        self.reporter.report(errors::no_such_angle(span, function, number));
        true
    }

    fn apply_to_alike(&mut self, function: &str, arguments: &[Argument], context: &Context<'_>) -> Option<Value> {
        let dim = self.all_alike(function, arguments, context)?;
        let ids: Vec<ExprId> = arguments.iter().map(|(_, value)| value.id).collect();
        let made = self.pure_number_dim(arguments);
        let graph = &mut self.model.graph;
        let (id, dim) = match function {
            "sqrt" => (graph.unary(Unary::Sqrt, ids[0]), dim.map(|dimension| dimension.to_the(0.5))),
            "abs" => (graph.unary(Unary::Abs, ids[0]), dim),
            "sign" => (graph.unary(Unary::Sign, ids[0]), made),
            "atan2" => (graph.binary(Binary::Atan2, ids[0], ids[1]), made.of_angle()),
            "hypot" => (graph.binary(Binary::Hypot, ids[0], ids[1]), dim),
            "mod" => (graph.modulo(ids[0], ids[1]), dim),
            _ => {
                let binary = if function == "min" { Binary::Min } else { Binary::Max };
                let id = ids[1..].iter().fold(ids[0], |all, &next| graph.binary(binary, all, next));
                (id, dim)
            }
        };
        Some(Value { id, dim: dim.of_term() })
    }

    fn all_alike(&mut self, function: &str, arguments: &[Argument], context: &Context<'_>) -> Option<Dim> {
        self.terms_alike(&format!("the arguments of `{function}` are"), arguments, context)
    }

    fn terms_alike(&mut self, what: &str, arguments: &[Argument], context: &Context<'_>) -> Option<Dim> {
        let (mut span, mut all) = arguments[0];
        for &(next, value) in &arguments[1..] {
            let dim = self.unify(what, (span, all), (next, value), context)?;
            // The next mismatch is reported relative to the argument that has the dimension.
            if !matches!(all.dim, Dim::Of(_)) {
                (span, all) = (next, value);
            }
            all.dim = dim;
        }
        Some(all.dim)
    }

    fn motion(
        &mut self,
        name: &str,
        motion: MotionLaw,
        arguments: &[Argument],
        context: &Context<'_>,
    ) -> Option<Value> {
        let &[u, u0, v0, u1, v1] = arguments else {
            return None;
        };
        let argument = self.all_alike(name, &[u, u0, u1], context)?;
        let dim = self.all_alike(name, &[v0, v1], context)?;
        let (start, end) = (self.constant_value(u0.1.id), self.constant_value(u1.1.id));
        match (start, end) {
            (Some(start), Some(end)) if end <= start && !self.branch.is_untaken => {
                self.reporter.report(errors::empty_interval(name, u1.0, [start, end], argument.settled()));
                return None;
            }
            (Some(_), Some(_)) => {}
            // The number is only known along the motion.
            _ => {
                let length = self.model.graph.sub(u1.1.id, u0.1.id);
                let one = self.model.graph.constant(1.0);
                let positive = self.branch.guard.map_or(length, |guard| self.model.graph.select(guard, length, one));
                let owner = context.place.to_owned();
                self.model.conditions.push(Condition { positive, kind: ConditionKind::Interval, span: u1.0, owner });
            }
        }
        let id = self.model.graph.motion(motion, u.1.id, [u0.1.id, v0.1.id], [u1.1.id, v1.1.id]);
        Some(Value { id, dim: dim.of_term() })
    }

    /// Evaluates `poly(u, u0, c0, c1, …)`: cₖ has the dimension of the result over that of uᵏ.
    fn polynomial(&mut self, arguments: &[Argument], context: &Context<'_>) -> Option<Value> {
        let (u, u0, coefficients) = (arguments[0], arguments[1], &arguments[2..]);
        let step = self.all_alike("poly", &[u, u0], context)?.settled();
        let terms: Vec<Argument> = coefficients
            .iter()
            .enumerate()
            .map(|(power, &(span, c))| {
                let whole = |dimension: Dimension| dimension.times(step.to_the(power as f64));
                (span, if c.dim == Dim::Any { c } else { Value { dim: c.dim.map(whole), ..c } })
            })
            .collect();
        let dim = self.terms_alike("the terms of `poly` are", &terms, context)?;
        let offset = self.model.graph.sub(u.1.id, u0.1.id);
        let ids: Vec<ExprId> = coefficients.iter().map(|(_, c)| c.id).collect();
        Some(Value { id: self.model.graph.polynomial_of(offset, &ids), dim: dim.of_term() })
    }
}
