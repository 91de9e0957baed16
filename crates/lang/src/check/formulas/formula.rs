//! Formulas: from the tree to the graph, with their dimensions.
//!
//! A formula that holds a unit is *judged*: its dimensions are computed and compared. Any other formula is *plain*, and is in the SI unit
//! of the expected dimension (`language.md`, "Units"): its numbers have whatever dimension they need. But its quantities keep their
//! dimensions, so that terms without a number as factor must agree too.

use super::Formulas;
use super::dimensions::require_dimension;
use super::value::{Context, Dim, Value};
use crate::check::errors;
use crate::check::scope::{BareName, Entity, Expected, resolve_bare_name};
use crate::check::suggest::lost_rate::Part;
use crate::model::{Dimension, GuardKind, Named};
use mechc_expr::{Dependence, ExprId, Symbol};
use mechc_syntax::ast::{Expr, ExprKind, Factor, Name, PathSegment, Sign};
use mechc_text::source::Span;
use mechc_text::vocabulary::{Constant, NamedConstant, QuantityWord, Unit, is_called};

impl Formulas<'_> {
    /// Evaluates a whole formula, whose parts are counted from zero unless it is a literal point's within another formula.
    pub(in crate::check) fn formula(&mut self, e: &Expr, context: &Context<'_>) -> Option<Value> {
        self.start_count();
        self.number(e, context)
    }

    /// Evaluates a formula within another one; `None` if it is broken, which has been reported.
    pub(in crate::check) fn number(&mut self, e: &Expr, context: &Context<'_>) -> Option<Value> {
        self.level(context, |formulas| formulas.number_here(e, context))
    }

    fn number_here(&mut self, e: &Expr, context: &Context<'_>) -> Option<Value> {
        self.count_part(e.span)?;
        let value = match &e.kind {
            ExprKind::Paren(inner) => return self.number(inner, context),
            ExprKind::Literal { value, unit } => self.literal(e, *value, unit.as_ref(), context),
            ExprKind::Name(name) => self.name(name, context),
            ExprKind::Call { name, arguments, window } => self.call(e, (name, window.as_deref()), arguments, context),
            ExprKind::Negate(inner) => {
                let inner = self.number(inner, context)?;
                Some(Value { id: self.model.graph.neg(inner.id), dim: inner.dim })
            }
            ExprKind::Sum(first, rest) => self.sum(first, rest, context),
            ExprKind::Product(first, rest) => self.product(first, rest, context),
            ExprKind::Power(base, exponent) => self.power(base, exponent, context),
            ExprKind::If { arms, otherwise } => self.choice(arms, otherwise, context),
            ExprKind::Member { owner, feature } => {
                if let Ok(coordinate) = self.coordinate_of(e, context) {
                    return coordinate;
                }
                self.member_as_number(e.span, owner, feature);
                None
            }
            ExprKind::Tuple(_) => {
                self.reporter.report(errors::wrong_kind(e.span, "a number", "a point"));
                None
            }
            ExprKind::Path(segments) => {
                self.path_as_number(e.span, segments);
                None
            }
            ExprKind::Not(_) | ExprKind::Compare(..) | ExprKind::And(_) | ExprKind::Or(_) => {
                self.reporter.report(errors::condition_as_number(e.span));
                None
            }
        }?;
        let value = Value { dim: value.dim.when_judged(context.judged), ..value };
        self.finite(e.span, value)
    }

    /// Reports a constant that is not finite, where it arises.
    pub(super) fn finite(&mut self, span: Span, value: Value) -> Option<Value> {
        match self.decided(value.id, GuardKind::Finite) {
            Some(number) if !number.is_finite() && !self.branch.is_untaken => {
                self.reporter.report(errors::not_finite(span, number));
                None
            }
            _ => Some(value),
        }
    }

    fn literal(&mut self, e: &Expr, value: f64, unit: Option<&(Name, i32)>, context: &Context<'_>) -> Option<Value> {
        if !value.is_finite() {
            self.reporter.report(errors::not_finite(e.span, value));
            return None;
        }
        let Some((name, power)) = unit else {
            let dim = if value == 0.0 { Dim::Any } else { Dim::PLAIN };
            return Some(Value { id: self.model.graph.constant(value), dim });
        };
        let Some(unit) = Unit::named(&name.text) else {
            let is_argument = context.argument.is_some_and(|(argument, _)| argument == name.text);
            // `1 t` is not a time if time is not allowed.
            let is_time = name.text == "t" && !context.time;
            let is_number = matches!(
                self.scope.entity(name),
                Some(Entity::Param(_) | Entity::Input(_) | Entity::Measure(_) | Entity::Result(_))
            );
            let is_a_name = is_argument || !is_time && Constant::named(&name.text).is_some() || is_number;
            let until_the_name = Span { end: name.span.start, ..e.span };
            let behind_it = Span { start: name.span.end, ..e.span };
            let [number, power] = [until_the_name, behind_it].map(|span| self.reporter.text(span).trim_end());
            self.reporter.report(errors::not_a_unit(name, [number, power], is_a_name));
            return None;
        };
        let si = unit.to_si(value, *power);
        if !si.is_finite() {
            self.reporter.report(errors::not_finite(e.span, si));
            return None;
        }
        Some(Value { id: self.model.graph.constant(si), dim: Dim::Of(unit.dimension.to_the(f64::from(*power))) })
    }

    fn name(&mut self, name: &Name, context: &Context<'_>) -> Option<Value> {
        let argument = context.argument.map(|(argument, _)| argument);
        match resolve_bare_name(&name.text, argument, self.scope.get(&name.text)) {
            BareName::Argument => return context.argument.map(|(_, value)| value),
            BareName::Constant(constant) => match constant.stands_for {
                NamedConstant::Time => return self.time_named(name, context),
                // A declaration of its name has been reported.
                NamedConstant::Number(_) if self.scope.is_reserved_but_declared(name) => return None,
                // A multiple of π is an angle.
                NamedConstant::Number(number) => {
                    let id = self.model.graph.constant(number);
                    return Some(Value { id, dim: Dim::Of(Dimension::ANGLE) });
                }
                NamedConstant::Ground => {}
            },

            BareName::Unit(unit) => {
                let id = self.model.graph.constant(unit.to_si(1.0, 1));
                return Some(Value { id, dim: Dim::Of(unit.dimension) });
            }
            BareName::Declared(_) | BareName::Unknown => {}
        }
        self.declared_number(name, context)
    }

    /// Evaluates `t`.
    fn time_named(&mut self, name: &Name, context: &Context<'_>) -> Option<Value> {
        if context.time {
            let id = self.model.graph.symbol(Symbol::Time);
            // In a plain formula it is a number of seconds.
            return Some(Value { id, dim: Dim::Plain { read: Dimension::TIME, fits: true } });
        }
        // Otherwise a parameter was intended.
        if !self.scope.is_reserved_but_declared(name) {
            self.reporter.report(if context.results {
                errors::outside_reduction("time `t`", name.span, "t")
            } else {
                errors::time_in(context.place, name.span, None)
            });
        }
        None
    }

    /// Returns the value of a declared name, if it is a number.
    fn declared_number(&mut self, name: &Name, context: &Context<'_>) -> Option<Value> {
        match self.scope.resolve(name).ok()?.filter(|_| context.names) {
            Some(Entity::Param(_)) if self.scope.point_param(name).is_some() => {
                self.reporter.report(errors::point_as_number(name));
                None
            }
            Some(Entity::Param(k)) => self.params[k].value,
            Some(Entity::Input(k)) if context.inputs => self.value_of_input(k),
            Some(Entity::Input(_)) if context.results => {
                self.reporter.report(errors::outside_reduction(
                    &format!("the input `{}`", name.text),
                    name.span,
                    &name.text,
                ));
                None
            }
            Some(Entity::Input(_)) => {
                self.reporter.report(errors::input_in(context.place, name, context.time));
                None
            }
            Some(Entity::Measure(k)) if context.measures => self.measure_value(k, name.span, context),
            Some(Entity::Measure(_)) if context.results => {
                self.reporter.report(errors::outside_reduction(
                    &format!("the measure `{}`", name.text),
                    name.span,
                    &name.text,
                ));
                None
            }
            Some(Entity::Result(k)) if context.results => self.result_state(k)?.value,
            Some(Entity::Result(_)) => {
                self.reporter.report(errors::result_in(context.place, name));
                None
            }
            Some(Entity::Measure(_)) => {
                self.reporter.report(
                    errors::wrong_kind(name.span, "a number", "a measure")
                        .help(format!("measures stand in other measures only, not in {}", context.place)),
                );
                None
            }
            Some(Entity::Trace) => {
                self.scope.trace_in_a_formula(&mut self.reporter, name.span, "a number", name);
                None
            }
            Some(entity @ (Entity::Function(_) | Entity::Table(_))) => {
                let help = format!("call it: `{}(…)`", name.text);
                self.reporter.report(errors::wrong_kind(name.span, "a number", entity.noun()).help(help));
                None
            }
            Some(entity) => {
                let diagnostic = errors::wrong_kind(name.span, "a number", entity.noun());
                self.reporter.report(self.suggest_quantity(name, diagnostic));
                None
            }
            None => {
                self.unknown_number(name, context);
                None
            }
        }
    }

    // Diagnostics are made in functions of their own, so that their locals do not enlarge the stack frame of every level.

    /// Reports a feature, or another meaning of `owner.feature`, where a number is expected.
    fn member_as_number(&mut self, span: Span, owner: &Name, feature: &Name) {
        if let Some(Entity::Trace) = self.scope.entity(owner) {
            self.scope.trace_in_a_formula(&mut self.reporter, span, "a number", owner);
            return;
        }
        let what = self.describe_member(owner, feature);
        let diagnostic = errors::wrong_kind(span, "a number", &what);
        self.reporter.report(diagnostic.fix_if(self.suggest_number(span, owner, feature)));
    }

    /// Reports a longer path where a number is expected.
    fn path_as_number(&mut self, span: Span, segments: &[PathSegment]) {
        let text: String = self.reporter.text(span).chars().filter(|c| !c.is_whitespace()).collect();
        // Paths of the text have been expanded; this one comes from outside.
        let owner = text.split_once("].").map_or(text.clone(), |(owner, _)| format!("{owner}]"));
        let unknown = segments.first().filter(|first| matches!(self.scope.resolve(&first.name), Ok(None)));
        let unknown = unknown.filter(|first| first.name.text != "ground" && segments.len() > 2);
        self.reporter.report(match (self.scope.get(&owner), unknown) {
            (Some(entity), _) => errors::path_from_outside(span, &owner, entity.noun(), owner == text),
            (None, Some(first)) => errors::unknown_owner(&first.name, self.scope.tree),
            (None, None) => {
                let is_declared = segments.first().is_some_and(|first| self.scope.entity(&first.name).is_some());
                errors::invalid_path(span, segments, is_declared)
            }
        });
    }

    fn unknown_number(&mut self, name: &Name, context: &Context<'_>) {
        if self.body_point(name, Expected::Point).is_some() {
            self.reporter.report(errors::point_as_number(name));
            return;
        }
        if name.text == "min" {
            self.reporter.report(errors::not_a_unit(name, ["", ""], false));
            return;
        }
        let is_quantity = QuantityWord::named(&name.text).is_some();
        if !context.names && (is_quantity || !is_called(&name.text)) {
            self.reporter.report(if context.time {
                errors::names_in_formula(name)
            } else {
                errors::names_in_option(name)
            });
            return;
        }
        if is_called(&name.text) {
            let help = format!("call it: `{}(…)`", name.text);
            self.reporter.report(errors::wrong_kind(name.span, "a number", "a function").help(help));
            return;
        }
        let mut candidates = self.scope.suggestions(&self.reporter, |entity| match entity {
            Entity::Param(_) => true,
            Entity::Input(_) => context.inputs,
            Entity::Measure(_) => context.measures,
            Entity::Result(_) => context.results,
            _ => false,
        });
        candidates.extend(context.argument.map(|(argument, _)| argument));
        for constant in Constant::in_formulas() {
            candidates.push(constant);
        }
        let what = if context.measures { "parameter or measure" } else { "parameter" };
        let diagnostic = errors::unknown_number(what, name, &candidates);
        let is_bound = matches!(name.text.as_str(), "from" | "to") && context.results && diagnostic.help.is_empty();
        let diagnostic = diagnostic.help_if(is_bound.then(|| errors::signed_bound(&name.text)));
        let argument = context.argument.filter(|_| diagnostic.help.is_empty());
        self.reporter
            .report(diagnostic.help_if(argument.map(|(argument, _)| format!("the argument here is `{argument}`"))));
    }

    fn sum(&mut self, first: &Expr, rest: &[(Sign, Expr)], context: &Context<'_>) -> Option<Value> {
        self.warn_of_numbers_as_radians(std::iter::once(first).chain(rest.iter().map(|(_, term)| term)), context);
        let mut sum = self.number(first, context);
        let mut span = first.span;
        for (sign, term) in rest {
            let (Some(left), Some(right)) = (sum, self.number(term, context)) else {
                sum = None;
                continue;
            };
            let what = if *sign == Sign::Plus { "this adds" } else { "this subtracts" };
            sum = self.unify(what, (span, left), (term.span, right), context).map(|dim| {
                let id = match sign {
                    Sign::Plus => self.model.graph.add(left.id, right.id),
                    Sign::Minus => self.model.graph.sub(left.id, right.id),
                };
                Value { id, dim: dim.of_term() }
            });
            span = span.to(term.span);
            sum = sum.and_then(|value| self.finite(span, value));
        }
        sum
    }

    fn product(&mut self, first: &Expr, rest: &[(Factor, Expr)], context: &Context<'_>) -> Option<Value> {
        self.reject_names_of_units(first, rest, context)?;
        let mut product = self.number(first, context);
        let mut span = first.span;
        for (factor, term) in rest {
            let (Some(left), Some(right)) = (product, self.number(term, context)) else {
                product = None;
                continue;
            };
            let graph = &mut self.model.graph;
            let value = match factor {
                Factor::Times => {
                    Value { id: graph.mul(left.id, right.id), dim: left.dim.with(right.dim, Dimension::times) }
                }
                Factor::Divide => {
                    Value { id: graph.div(left.id, right.id), dim: left.dim.with(right.dim, Dimension::over) }
                }
            };
            span = span.to(term.span);
            product = self.finite(span, value);
        }
        product
    }

    /// Reports factors behind a number and its unit that are units and names too: `2 rad/s` beside `param s`.
    fn reject_names_of_units(&mut self, first: &Expr, rest: &[(Factor, Expr)], context: &Context<'_>) -> Option<()> {
        let number = match &first.kind {
            ExprKind::Negate(inner) => inner,
            _ => first,
        };
        let ExprKind::Literal { unit: Some(_), .. } = &number.kind else { return Some(()) };
        let mut is_clear = true;
        for (_, factor) in rest {
            let base = match &factor.kind {
                ExprKind::Power(base, _) => base,
                _ => factor,
            };
            let ExprKind::Name(name) = &base.kind else { continue };
            if Unit::named(&name.text).is_none() {
                continue;
            }
            let (declared, is_number) = match self.scope.get(&name.text) {
                _ if context.argument.is_some_and(|(argument, _)| argument == name.text) => ("an argument", true),
                Some(entity) => (entity.noun(), entity.is_number() && !self.scope.is_point_name(&name.text)),
                None => continue,
            };
            let product = self.reporter.text(first.span.to(factor.span));
            let number = (number.span, self.reporter.text(number.span));
            self.reporter.report(errors::name_or_unit(name, number, product, declared, is_number));
            is_clear = false;
        }
        is_clear.then_some(())
    }

    fn power(&mut self, base: &Expr, exponent: &Expr, context: &Context<'_>) -> Option<Value> {
        let (a, b) = (self.number(base, context), self.number(exponent, context));
        let (a, b) = (a?, b?);
        require_dimension(&mut self.reporter, "an exponent", Dimension::PURE, exponent.span, b.dim, context)?;
        let id = self.model.graph.pow(a.id, b.id);
        let dimension = a.dim.settled();
        let dim = if dimension.is(Dimension::PURE) {
            let power = exponent.bare_number().unwrap_or(0.0);
            a.dim.map(|dimension| Dimension { angle: dimension.angle * power, ..dimension })
        } else {
            match self.constant_value(b.id) {
                Some(power) => a.dim.map(|dimension| dimension.to_the(power)),
                None if context.judged => {
                    self.reporter.report(errors::exponent(exponent.span, Part { span: base.span, dimension }));
                    return None;
                }
                None => Dim::UNFIT,
            }
        };
        let dim = if b.dim.is_pure() { dim } else { Dim::UNFIT };
        Some(Value { id, dim })
    }

    /// Returns the highest order of time derivatives in a formula.
    pub(super) fn derivative_order(&self, id: ExprId) -> u8 {
        if !self.model.graph.dependence(id).on(Dependence::NAMED) {
            return 0;
        }
        self.model
            .graph
            .symbols(id)
            .into_iter()
            .filter_map(|symbol| match symbol {
                Symbol::Named(k) => self.common.derivative_orders.get(k as usize).copied(),
                _ => None,
            })
            .max()
            .unwrap_or(0)
    }

    /// Evaluates `der(e)`.
    pub(in crate::check) fn derivative(&mut self, e: &Expr, argument: &Expr, context: &Context<'_>) -> Option<Value> {
        if context.results && !context.measures {
            self.reporter.report(errors::derivative_of_result(e.span));
            return None;
        }
        if !context.rates {
            self.reporter.report(errors::derivative_in(context.place, e.span));
            return None;
        }
        let inner = self.number(argument, context)?;
        if self.holds_force(inner.id) {
            self.reporter.report(errors::derivative_of_force(e.span));
            return None;
        }
        let order = self.derivative_order(inner.id) + 1;
        if order > 3 {
            self.reporter.report(errors::derivative_too_high(e.span));
            return None;
        }
        let dim = inner.dim.map(|dimension| dimension.over(Dimension::TIME));
        if self.model.graph.dependence(inner.id).is_constant() {
            return Some(Value { id: self.model.graph.constant(0.0), dim });
        }
        if self.is_of_whole_analysis(inner.id) {
            self.reporter.report(errors::derivative_of_result(e.span));
            return None;
        }
        let id = self.name_symbol(Named::Derivative(inner.id), order);
        if !self.register_rate(inner.id, id) {
            self.reporter.report(errors::derivative_of_jerk(e.span));
            return None;
        }
        Some(Value { id, dim })
    }

    /// Returns the value of a constant formula of any dimension.
    pub(in crate::check) fn any_constant(&mut self, e: &Expr) -> Option<f64> {
        let judged = self.is_dimensional(e);
        let value = self.formula(e, &Context { judged, ..Context::constant("a binding of a param") })?;
        self.constant_value(value.id)
    }

    /// Evaluates a constant of a given dimension. Returns its expression and value.
    pub(in crate::check) fn constant(&mut self, e: &Expr, place: &str, expected: Dimension) -> Option<(ExprId, f64)> {
        self.constant_by(e, place, expected, GuardKind::Value)
    }

    /// Evaluates a constant of which one property decides.
    pub(in crate::check) fn constant_by(
        &mut self,
        e: &Expr,
        place: &str,
        expected: Dimension,
        by: GuardKind,
    ) -> Option<(ExprId, f64)> {
        let judged = self.is_dimensional(e);
        self.judged_constant(e, place, expected, by, judged)
    }

    /// Evaluates a constant that may require a unit.
    pub(super) fn judged_constant(
        &mut self,
        e: &Expr,
        place: &str,
        expected: Dimension,
        by: GuardKind,
        judged: bool,
    ) -> Option<(ExprId, f64)> {
        let context = Context { judged, ..Context::constant(place) };
        let value = self.formula(e, &context)?;
        if !judged && expected.is(Dimension::LENGTH) && self.reject_angle(place, e) {
            return None;
        }
        require_dimension(&mut self.reporter, place, expected, e.span, value.dim, &context)?;
        if expected.is(Dimension::LENGTH) {
            self.record_length_term(e, value.id, judged);
        }
        let number = self.decided(value.id, by)?;
        Some((value.id, number))
    }
}
