//! Calls of the language's own functions.

use super::formula::{Context, Dim, Value};
use super::{Checker, errors};
use crate::expr::{Binary, ExprId, MotionLaw, Unary};
use crate::model::{Condition, ConditionKind, Dimension};
use crate::source::Span;
use crate::syntax::ast::{Expr, Name};
use crate::vocabulary::{Function, Group};

/// An argument with its place.
type Argument = (Span, Value);

impl Checker<'_> {
    /// A call of a function or kinematic quantity of the language.
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
        // a function's formula is looked over on its own
        if let ("sin" | "cos" | "tan", [argument], true) = (name.text.as_str(), arguments, self.calls.caller.is_none())
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
        let values: Vec<Option<Value>> = arguments.iter().map(|argument| self.number(argument, context)).collect();
        let values: Vec<Argument> = arguments
            .iter()
            .zip(values)
            .map(|(argument, value)| value.map(|value| (argument.span, value)))
            .collect::<Option<_>>()?;
        self.apply(function, &values, context)
    }

    fn report_count_of(&mut self, e: &Expr, name: &Name, function: &Function, arguments: &[Expr]) {
        let (wanted, found) = (function.takes(), arguments.len());
        let diagnostic = errors::argument_count(&name.text, Some(&function.word), e.span, &wanted, found);
        let reduces = self.reduction_word(name, found).is_some();
        let diagnostic = if reduces { diagnostic.help(errors::REDUCES) } else { diagnostic };
        self.report_count(name, diagnostic, arguments, function.most);
    }

    fn apply(&mut self, function: &Function, arguments: &[Argument], context: &Context<'_>) -> Option<Value> {
        let name = function.word.name;
        match function.group {
            Group::Pure => {
                let (span, value) = arguments[0];
                self.demand(&format!("the argument of `{name}`"), Dimension::PURE, span, value.dim, context)?;
                let id = self.model.graph.unary(Unary::named(name)?, value.id);
                Some(Value { id, dim: Dim::PURE })
            }
            Group::Motion => self.motion(name, MotionLaw::named(name)?, arguments, context),
            Group::Polynomial => self.polynomial(arguments, context),
            // a derivative is taken of a formula, not of its value; points are no numbers
            Group::Alike | Group::Derivative | Group::Points => self.apply_to_alike(name, arguments, context),
        }
    }

    fn apply_to_alike(&mut self, function: &str, arguments: &[Argument], context: &Context<'_>) -> Option<Value> {
        let dim = self.all_alike(function, arguments, context)?;
        let ids: Vec<ExprId> = arguments.iter().map(|(_, value)| value.id).collect();
        let graph = &mut self.model.graph;
        let (id, dim) = match function {
            "sqrt" => (graph.unary(Unary::Sqrt, ids[0]), Dim::Of(dim.settled().to_the(0.5))),
            "abs" => (graph.unary(Unary::Abs, ids[0]), dim),
            "sign" => (graph.unary(Unary::Sign, ids[0]), Dim::PURE),
            "atan2" => (graph.binary(Binary::Atan2, ids[0], ids[1]), Dim::PURE),
            "hypot" => (graph.binary(Binary::Hypot, ids[0], ids[1]), dim),
            "mod" => (graph.modulo(ids[0], ids[1]), dim),
            _ => {
                let binary = if function == "min" { Binary::Min } else { Binary::Max };
                let id = ids[1..].iter().fold(ids[0], |all, &next| graph.binary(binary, all, next));
                (id, dim)
            }
        };
        Some(Value { id, dim: Dim::Of(dim.settled()) })
    }

    fn all_alike(&mut self, function: &str, arguments: &[Argument], context: &Context<'_>) -> Option<Dim> {
        let what = format!("the arguments of `{function}` are");
        let (mut span, first) = arguments[0];
        let mut dim = first.dim;
        for &(next, value) in &arguments[1..] {
            let joint = self.alike(&what, (span, dim), (next, value.dim), context)?;
            if dim == Dim::Any {
                span = next;
            }
            dim = joint;
        }
        Some(dim)
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
                self.report(errors::empty_interval(name, u1.0, [start, end], argument.settled()));
                return None;
            }
            (Some(_), Some(_)) => {}
            // it can only be known on the way
            _ => {
                let length = self.model.graph.sub(u1.1.id, u0.1.id);
                let one = self.model.graph.constant(1.0);
                let positive = self.branch.guard.map_or(length, |guard| self.model.graph.select(guard, length, one));
                let owner = context.place.to_owned();
                self.model.conditions.push(Condition { positive, kind: ConditionKind::Interval, span: u1.0, owner });
            }
        }
        let id = self.model.graph.motion(motion, u.1.id, [u0.1.id, v0.1.id], [u1.1.id, v1.1.id]);
        Some(Value { id, dim: Dim::Of(dim.settled()) })
    }

    /// `poly(u, u0, c0, c1, …)`: cₖ has the dimension of the result over that of uᵏ.
    fn polynomial(&mut self, arguments: &[Argument], context: &Context<'_>) -> Option<Value> {
        let (u, u0, coefficients) = (arguments[0], arguments[1], &arguments[2..]);
        let step = self.all_alike("poly", &[u, u0], context)?;
        let mut dim = Dim::Any;
        let mut first = coefficients[0].0;
        for (power, &(span, c)) in coefficients.iter().enumerate() {
            let term = match c.dim {
                Dim::Any => Dim::Any,
                Dim::Of(c) => Dim::Of(c.times(step.settled().to_the(power as f64))),
            };
            let joint = self.alike("the terms of `poly` are", (first, dim), (span, term), context)?;
            if dim == Dim::Any {
                first = span;
            }
            dim = joint;
        }
        let way = self.model.graph.sub(u.1.id, u0.1.id);
        let ids: Vec<ExprId> = coefficients.iter().map(|(_, c)| c.id).collect();
        Some(Value { id: self.model.graph.polynomial_of(way, &ids), dim: Dim::Of(dim.settled()) })
    }
}
