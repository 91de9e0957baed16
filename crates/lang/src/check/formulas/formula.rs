//! Formulas: from the tree to the graph, with their dimensions.
//!
//! A formula that holds a unit is *judged*: its dimensions are computed and compared. Any other formula is *plain*, and is in the SI unit
//! of the expected dimension (`language.md`, "Units"): its numbers have whatever dimension they need. But its quantities keep their
//! dimensions, so that terms without a number as factor must agree too.

use super::Formulas;
use super::dimensions::require_dimension;
use crate::check::errors;
use crate::check::scope::{BareName, Entity, Expected, resolve_bare_name};
use crate::check::suggest::lost_rate::Part;
use crate::model::{Dimension, GuardKind, Named};
use mechc_expr::{Dependence, ExprId, Symbol};
use mechc_syntax::ast::{Expr, ExprKind, Factor, Name, PathSegment, Sign};
use mechc_text::source::Span;
use mechc_text::vocabulary::{Constant, NamedConstant, QuantityWord, Unit, is_called};

/// The identity of a dimension in a cache.
pub(in crate::check) type DimKey = (bool, bool, [u64; 4]);

/// The dimension of a formula.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(in crate::check) enum Dim {
    /// A literal zero, which fits any dimension.
    Any,
    /// A known dimension.
    Of(Dimension),
    /// An open dimension: a number without a unit is a factor in a plain formula. Judged formulas do not have it.
    Plain {
        /// The dimension if numbers are pure.
        read: Dimension,
        /// True if its terms agree if numbers are pure.
        fits: bool,
    },
}

impl Dim {
    pub const PURE: Dim = Dim::Of(Dimension::PURE);
    pub const LENGTH: Dim = Dim::Of(Dimension::LENGTH);
    /// The dimension of a number without a unit.
    pub const PLAIN: Dim = Dim::Plain { read: Dimension::PURE, fits: true };
    /// The dimension of a formula whose numbers must have dimensions for its terms to agree.
    pub const UNFIT: Dim = Dim::Plain { read: Dimension::PURE, fits: false };

    /// Returns the dimension if numbers without units are pure.
    pub fn settled(self) -> Dimension {
        match self {
            Dim::Any => Dimension::PURE,
            Dim::Of(dimension) | Dim::Plain { read: dimension, .. } => dimension,
        }
    }

    /// Returns the dimension of a term. A zero fits any dimension only as a whole formula.
    pub fn of_term(self) -> Dim {
        if self == Dim::Any { Dim::PLAIN } else { self }
    }

    /// Returns the dimension in a judged formula, where numbers are pure.
    pub fn when_judged(self, judged: bool) -> Dim {
        match self {
            Dim::Plain { read, .. } if judged => Dim::Of(read),
            _ => self,
        }
    }

    /// Returns the dimension of a function of one value, such as a root or derivative.
    pub fn map(self, f: impl FnOnce(Dimension) -> Dimension) -> Dim {
        match self.of_term() {
            Dim::Plain { read, fits } => Dim::Plain { read: f(read), fits },
            other => Dim::Of(f(other.settled())),
        }
    }

    /// Returns it marked as an angle.
    pub fn of_angle(self) -> Dim {
        self.map(|dimension| dimension.marked_by(Dimension::ANGLE))
    }

    /// Returns the dimension of a product or quotient.
    pub fn with(self, other: Dim, f: impl Fn(Dimension, Dimension) -> Dimension) -> Dim {
        let read = f(self.settled(), other.settled());
        match (self, other) {
            (Dim::Of(_), Dim::Of(_)) => Dim::Of(read),
            _ => Dim::Plain { read, fits: self.fits() && other.fits() },
        }
    }

    /// Returns whether its terms agree if numbers are pure.
    pub fn fits(self) -> bool {
        !matches!(self, Dim::Plain { fits: false, .. })
    }

    /// Returns its identity in a cache.
    pub fn key(self) -> DimKey {
        let read = self.settled();
        let powers = [read.length, read.time, read.mass, read.angle].map(|power| (power + 0.0).to_bits());
        (matches!(self, Dim::Of(_)), self.fits() && self != Dim::Any, powers)
    }

    /// Returns the expected and the found dimension if they differ. A zero fits any dimension.
    pub fn other_than(self, found: Dim) -> Option<[Dimension; 2]> {
        let both = [self.settled(), found.settled()];
        (self != Dim::Any && found != Dim::Any && !both[0].is(both[1])).then_some(both)
    }

    /// Returns whether it is known to be a pure number.
    pub fn is_a_pure_number(self) -> bool {
        matches!(self, Dim::Of(dimension) if dimension.is(Dimension::PURE))
    }

    /// Returns whether it fits a pure number, if numbers without units are pure.
    pub fn is_pure(self) -> bool {
        self.fits() && self.settled().is(Dimension::PURE)
    }
}

/// A formula in the graph with its dimension.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(in crate::check) struct Value {
    pub id: ExprId,
    pub dim: Dim,
}

impl Value {
    pub fn has_a_dimension(self) -> bool {
        matches!(self.dim, Dim::Of(dimension) if !dimension.is(Dimension::PURE))
    }
}

/// The permissions of a formula, and the way in which it is read.
#[derive(Clone, Copy)]
#[allow(clippy::struct_excessive_bools)] // permissions that depend on nothing but the place
pub(in crate::check) struct Context<'c> {
    /// The place in messages, such as `a constraint`.
    pub place: &'c str,
    /// True if dimensions are compared.
    pub judged: bool,
    /// True if `t` is allowed.
    pub time: bool,
    /// True if inputs are allowed.
    pub inputs: bool,
    /// True if kinematic quantities are allowed.
    pub quantities: bool,
    /// True if `der` and quantities with rates are allowed.
    pub rates: bool,
    /// True if measures and computed forces are allowed.
    pub measures: bool,
    /// True if reductions and results are allowed.
    pub results: bool,
    /// True if names of the file are allowed.
    pub names: bool,
    /// True if functions are expanded. A function that is checked on its own is not, as those that it calls are checked themselves.
    pub expands: bool,
    /// The argument of the function that is being expanded.
    pub argument: Option<(&'c str, Value)>,
    /// The unit in which the argument is printed, if it is a unit of angle other than the radian.
    pub printed: Option<Span>,
}

impl<'c> Context<'c> {
    /// Returns the context of a constant over params and functions.
    pub fn constant(place: &'c str) -> Context<'c> {
        Context {
            place,
            judged: false,
            time: false,
            inputs: false,
            quantities: false,
            rates: false,
            measures: false,
            results: false,
            names: true,
            expands: true,
            argument: None,
            printed: None,
        }
    }

    /// Returns this context for another place and argument.
    pub fn at<'p>(&self, place: &'p str, argument: Option<(&'p str, Value)>) -> Context<'p> {
        let &Context { judged, time, inputs, quantities, rates, measures, results, names, expands, printed, .. } = self;
        Context { place, judged, time, inputs, quantities, rates, measures, results, names, expands, argument, printed }
    }
}

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
    pub(in crate::check) fn finite(&mut self, span: Span, value: Value) -> Option<Value> {
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
                // A multiple of π is an angle.
                NamedConstant::Number(number) => {
                    let id = self.model.graph.constant(number);
                    return Some(Value { id, dim: Dim::Of(Dimension::ANGLE) });
                }
                NamedConstant::Ground => {}
            },
            // `10 mm/s` in a text with `param s`.
            BareName::Declared(_) if self.scope.is_reserved_but_declared(name) => return None,
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
    pub(in crate::check) fn derivative_order(&self, id: ExprId) -> u8 {
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
    pub(in crate::check) fn judged_constant(
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
