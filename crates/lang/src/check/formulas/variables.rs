//! The variables of derivatives: the second argument of `der(e, NAME)`, and the names of `--by`.
//!
//! The variable of an independent number is its symbol. A value with a formula gets a shift of 0 added to it, but only if a derivative by
//! it is requested, so that nothing else changes.

use super::Formulas;
use super::overrides::override_matches;
use super::value::{Context, Dim, Value};
use crate::check::errors;
use crate::check::scope::Entity;
use crate::model::{Declared, Dimension, Load, Named, PartDerivative, Variable};
use mechc_expr::{ExprId, Symbol};
use mechc_syntax::ast::{Expr, ExprKind, Item, Mechanism, Name};
use mechc_text::source::Span;
use rustc_hash::{FxHashMap, FxHashSet};

/// The largest numbers of variables, and of time derivatives besides, of one derivative.
const MOST_VARIABLES: u8 = 2;
const MOST_RATES: u8 = 2;

/// The variables of a mechanism.
#[derive(Default)]
pub(in crate::check) struct Variables {
    /// The requested names. Those of points and of repeated inputs stand for all their variables.
    requested: FxHashSet<String>,
    /// The numbers of the variables that have been created.
    pub numbers: FxHashMap<String, u32>,
    /// The dimensions by number.
    dims: Vec<Dim>,
    /// For the named symbols of such derivatives: the numbers of variables and of time derivatives.
    orders: FxHashMap<ExprId, (u8, u8)>,
    /// The locations of derivatives of formulas with forces.
    of_forces: Vec<Span>,
}

impl Variables {
    /// Returns the variables that the command line requests.
    pub fn new(by: &[String]) -> Variables {
        Variables { requested: by.iter().cloned().collect(), ..Variables::default() }
    }

    /// Adds the variables that a text requests; `path` is the prefix of its names.
    pub fn add(&mut self, tree: &Mechanism, path: &str) {
        for e in tree.items.iter().flat_map(Item::formulas).flat_map(Expr::parts) {
            if let Some((_, by)) = as_derivative(e) {
                self.requested.extend(named(by).map(|name| format!("{path}{name}")));
            }
        }
    }

    fn is_requested(&self, name: &str) -> bool {
        if self.requested.is_empty() {
            return false;
        }
        let whole = name.rsplit_once('.').map(|(point, _)| point);
        self.requested.contains(name)
            || self.requested.iter().any(|requested| {
                override_matches(name, requested) || whole.is_some_and(|whole| override_matches(whole, requested))
            })
    }
}

/// Returns the arguments of `der(e, NAME)`.
pub(super) fn as_derivative(e: &Expr) -> Option<(&Expr, &Expr)> {
    match &e.kind {
        ExprKind::Call { name, arguments, window: None } if name.text == "der" => match arguments.as_slice() {
            [of, by] => Some((of, by)),
            _ => None,
        },
        _ => None,
    }
}

/// Returns a name or `A.x` as text.
fn named(e: &Expr) -> Option<String> {
    match &e.bare().kind {
        ExprKind::Name(name) => Some(name.text.clone()),
        ExprKind::Member { owner, feature } => Some(format!("{}.{}", owner.text, feature.text)),
        _ => None,
    }
}

impl Formulas<'_> {
    /// Registers an independent number, if it is a requested variable.
    pub(super) fn register_param(&mut self, declared: &Declared, symbol: Symbol, dim: Dim) {
        if self.common.variables.is_requested(&declared.name) {
            let id = self.model.graph.symbol(symbol);
            self.add_variable(declared.clone(), symbol, Value { id, dim });
        }
    }

    /// Returns a value with a formula, with a shift if it is a requested variable.
    pub(super) fn with_shift(&mut self, declared: &Declared, value: Value) -> Value {
        if !self.common.variables.is_requested(&declared.name) {
            return value;
        }
        let symbol = Symbol::Shift(self.model.variables.len() as u32);
        let shift = self.model.graph.symbol(symbol);
        let value = Value { id: self.model.graph.add(value.id, shift), ..value };
        self.add_variable(declared.clone(), symbol, value);
        value
    }

    fn add_variable(&mut self, declared: Declared, symbol: Symbol, Value { id, dim }: Value) {
        let number = self.model.variables.len() as u32;
        self.common.variables.numbers.insert(declared.name.clone(), number);
        self.common.variables.dims.push(dim);
        self.model.variables.push(Variable { declared, symbol, value: id, dimension: dim.settled() });
    }

    /// Evaluates `der(e, NAME)`.
    pub(super) fn derivative_by(&mut self, e: &Expr, [of, by]: [&Expr; 2], context: &Context<'_>) -> Option<Value> {
        if context.results && !context.measures {
            self.reporter.report(errors::variation_of_result(e.span));
            return None;
        }
        if !context.measures {
            self.reporter.report(errors::derivative_by_in(context.place, e.span));
            return None;
        }
        let (inner, variable) = (self.number(of, context), self.variable(by));
        let (inner, variable) = (inner?, variable?);
        if self.holds_reduction(inner.id) {
            self.reporter.report(errors::variation_of_result(e.span));
            return None;
        }
        let (times, _) = self.variation_orders(inner.id);
        let rates = self.derivative_order(inner.id);
        if times + 1 > MOST_VARIABLES {
            self.reporter.report(errors::derivative_by_too_many(e.span));
            return None;
        }
        if rates > MOST_RATES {
            self.reporter.report(errors::derivative_of_jerk(e.span));
            return None;
        }
        let by = self.common.variables.dims[variable as usize];
        let dim = inner.dim.with(by, Dimension::over);
        if self.holds_force(inner.id) {
            self.common.variables.of_forces.push(e.span);
        }
        if let Some(part) = self.address.part {
            let derivative = PartDerivative { part, span: e.span, from_outside: self.text_from_outside(e) };
            self.model.part_derivatives.push(derivative);
        }
        let id = self.name_symbol(Named::By(inner.id, variable), rates);
        self.common.variables.orders.insert(id, (times + 1, rates));
        Some(Value { id, dim })
    }

    /// Returns a formula of calls and names of this text as the outermost mechanism writes it; `None` for other formulas, and if a name is
    /// bound, so that nothing outside can be differentiated by it.
    fn text_from_outside(&self, e: &Expr) -> Option<String> {
        let path = &self.scope.path;
        match &e.kind {
            ExprKind::Call { name, arguments, window: None } if self.scope.entity(name).is_none() => {
                let arguments: Option<Vec<String>> = arguments.iter().map(|e| self.text_from_outside(e)).collect();
                Some(format!("{}({})", name.text, arguments?.join(", ")))
            }
            ExprKind::Name(name) if self.scope.entity(name).is_none() => Some(name.text.clone()),
            _ => named(e).filter(|name| !self.is_bound(name)).map(|name| format!("{path}{name}")),
        }
    }

    fn is_bound(&self, name: &str) -> bool {
        self.bound.inputs.contains(&name) || self.bound.params.iter().any(|param| param.name == name)
    }

    /// Registers a formula as the time derivative of another one. Returns whether its order is allowed.
    pub(super) fn register_rate(&mut self, of: ExprId, rate: ExprId) -> bool {
        let (times, rates) = self.variation_orders(of);
        if times > 0 {
            self.common.variables.orders.insert(rate, (times, rates + 1));
        }
        times == 0 || rates < MOST_RATES
    }

    /// Returns the numbers of variables and of time derivatives in a formula.
    fn variation_orders(&self, id: ExprId) -> (u8, u8) {
        if self.common.variables.orders.is_empty() {
            return (0, 0);
        }
        let parts =
            self.model.graph.reachable(&[id]).into_iter().filter_map(|part| self.common.variables.orders.get(&part));
        parts.fold((0, 0), |all, part| (all.0.max(part.0), all.1.max(part.1)))
    }

    /// Reports derivatives of forces if a load holds third time derivatives.
    pub(in crate::check) fn reject_derivatives_of_forces(&mut self) {
        let is_jerk = |&symbol: &Symbol| match symbol {
            Symbol::Named(k) => match self.model.named[k as usize] {
                Named::Derivative(inner) => {
                    let is_third =
                        self.common.derivative_orders.get(k as usize).is_some_and(|&order| order > MOST_RATES);
                    is_third && self.holds_named(inner, |named| matches!(named, Named::Quantity(..)))
                }
                _ => false,
            },
            _ => false,
        };
        let holds_jerk = |load: &&Load| self.model.graph.symbols(load.force).iter().any(is_jerk);
        let Some(load) = self.model.loads.iter().find(holds_jerk).map(|load| load.declared.clone()) else { return };
        for span in std::mem::take(&mut self.common.variables.of_forces) {
            self.reporter.report(errors::derivative_through_a_jerk(span, &load));
        }
    }

    /// Returns the number of a derivative's variable.
    fn variable(&mut self, by: &Expr) -> Option<u32> {
        let full = named(by).map(|name| format!("{}{name}", self.scope.path));
        let path = named(by).unwrap_or_default();
        if let Some(bound) = self.binding_of(&format!("{}{path}", self.scope.path)) {
            let local = |name: &String| name.strip_prefix(self.scope.path.as_str()).unwrap_or(name).to_owned();
            let made_of: Vec<String> = bound.made_of.iter().map(local).collect();
            self.reporter.report(errors::by_bound(by.span, &path, bound.span, &made_of));
            return None;
        }
        let number = full.and_then(|name| self.common.variables.numbers.get(&name).copied());
        if number.is_some() {
            return number;
        }
        let diagnostic = match &by.bare().kind {
            ExprKind::Name(name) => self.non_variable_diagnostic(name)?,
            ExprKind::Member { owner, feature } if self.scope.point_param(owner).is_some() => {
                // A broken one has been reported.
                if matches!(feature.text.as_str(), "x" | "y") {
                    return None;
                }
                errors::by_point(owner, by.span)
            }
            ExprKind::Member { owner, feature } => {
                let what = self.describe_member(owner, feature);
                errors::not_a_variable(by.span, &what)
            }
            _ => errors::not_a_variable(by.span, "a formula"),
        };
        self.reporter.report(diagnostic);
        None
    }

    /// Returns the diagnostic of a name that is not a variable; `None` if it is broken, which has been reported.
    fn non_variable_diagnostic(&self, name: &Name) -> Option<mechc_text::diag::Diagnostic> {
        match self.scope.resolve(name).ok()? {
            Some(Entity::Param(_)) if self.scope.point_param(name).is_some() => Some(errors::by_point(name, name.span)),
            Some(Entity::Param(_)) if self.scope.deciding.contains(&name.text) => Some(errors::by_deciding(name)),
            Some(Entity::Param(_) | Entity::Input(_)) => None,
            Some(entity) => Some(errors::not_a_variable(name.span, entity.noun())),
            None if name.text == "t" => Some(errors::by_time(name)),
            None => {
                let candidates = self
                    .scope
                    .suggestions(&self.reporter, |entity| matches!(entity, Entity::Param(_) | Entity::Input(_)));
                Some(errors::unknown("input or parameter", name, &candidates))
            }
        }
    }
}
