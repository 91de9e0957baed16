//! Calls of functions and measures, expanded in place. Each expansion is made once.
//!
//! An expansion recurses into the called formula, and a chain of functions can be deeper than any stack. A call at too great a depth is
//! therefore deferred: the formulas around it are abandoned, the call is expanded on its own from the lowest level, and the formulas are
//! read again with its expansion in the cache. Thus the result does not depend on the size of the stack.

use super::Formulas;
use super::branches::Branch;
use super::reductions::reject_window;
use super::value::{Context, DimKey, Value};
use crate::check::errors;
use crate::check::scope::Entity;
use crate::model::Condition;
use mechc_expr::ExprId;
use mechc_syntax::ast::{Expr, Name, Window};
use mechc_text::source::Span;
use rustc_hash::{FxHashMap, FxHashSet};

/// The largest size of one formula with its expansions, in nodes.
const LARGEST: usize = 1_000_000;

/// The depth of formulas, including those of callers, from which calls are deferred.
const DEEPEST_CALL: usize = 64;

/// The limit of repeated reading because of deferred calls, as a multiple of the largest size.
const MOST_READ: usize = 16;

/// The key of an expansion: the function or measure, its argument, and how it is read.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(in crate::check) struct Call {
    entity: Entity,
    argument: Option<(ExprId, DimKey)>,
    judged: bool,
    /// The unit in which the argument is printed, if there is one.
    printed: Option<Span>,
    /// A branch that is never taken gives fewer diagnostics, and conditions only apply in their branch.
    branch: Branch,
}

/// A call at too great a depth, with all that its expansion needs.
struct DeferredCall<'a> {
    call: Call,
    formula: &'a Expr,
    context: Context<'a>,
    caller: Option<Span>,
}

/// The cached expansions, and the state of the current formula.
#[derive(Default)]
pub(super) struct Calls<'a> {
    /// The expansions.
    pub expansions: FxHashMap<Call, Option<Value>>,
    /// The conditions of expansions that have any.
    pub conditions: FxHashMap<Call, Vec<Condition>>,
    /// The number of visited parts of the formula.
    visited: usize,
    /// The number of open levels of formulas.
    levels: usize,
    /// The deferred calls; the next one is last.
    deferred: Vec<DeferredCall<'a>>,
    /// The expansions abandoned in this reading, as they hold a deferred call.
    abandoned: FxHashSet<Call>,
    /// True if the current formula holds a deferred call.
    is_abandoned: bool,
    /// The number of parts of completed expansions.
    complete: usize,
    /// The number of parts read, including repeated reading.
    read: usize,
    /// True if the formula is rejected for its size.
    is_too_large: bool,
}

impl<'a> Formulas<'a> {
    /// Evaluates a call of a function of the language or of the file.
    pub(in crate::check) fn call(
        &mut self,
        e: &Expr,
        (name, window): (&Name, Option<&Window>),
        arguments: &[Expr],
        context: &Context<'_>,
    ) -> Option<Value> {
        if let Ok(reduced) = self.call_of_reduction(e, (name, window), arguments, context) {
            return reduced;
        }
        reject_window(&mut self.reporter, name, window)?;
        if self.scope.is_of_language(&name.text) {
            if self.scope.is_reserved_but_declared(name) {
                return None;
            }
            return self.builtin(e, name, arguments, context);
        }
        if matches!(self.scope.get(&name.text), Some(Entity::Broken)) {
            return None;
        }
        // A parameter of that name is intended if quantities are not allowed.
        let is_quantity = context.rates || self.scope.get(&name.text).is_none();
        if is_quantity && self.scope.quantity_word(name).is_some() {
            return self.quantity(e, name, arguments, context);
        }
        match self.scope.resolve(name).ok()?.filter(|_| context.names) {
            Some(Entity::Function(k)) => {
                let [argument] = arguments else {
                    self.reporter.report(errors::argument_count(
                        &name.text,
                        None,
                        e.span,
                        "one argument",
                        arguments.len(),
                    ));
                    return None;
                };
                let printed = self.unit_of_argument(argument, context);
                let argument = self.number(argument, context)?;
                if let Some(at) = self.functions[k].time.filter(|_| !context.time) {
                    self.reporter.report(errors::time_in(context.place, e.span, Some((&name.text, at))));
                    return None;
                }
                self.function_value(k, argument, e.span, &Context { printed, ..*context })
            }
            Some(Entity::Table(k)) => self.table_call(k, e, arguments, context),
            Some(entity) => {
                self.reporter.report(errors::not_callable(name, entity.noun()));
                None
            }
            None => {
                let rate = self.suggest_joint_rate(e, name, arguments, context);
                if let Some(fix) = rate.or_else(|| self.suggest_effort(e, name, arguments)) {
                    self.reporter.report(errors::unknown_function(name, &[], &[]).instead(fix));
                    return None;
                }
                let candidates = self
                    .scope
                    .suggestions(&self.reporter, |entity| matches!(entity, Entity::Function(_) | Entity::Table(_)));
                let texts: Vec<&str> = arguments.iter().map(|e| self.reporter.text(e.span)).collect();
                let diagnostic = errors::unknown_function(name, &candidates, &texts);
                self.reporter.report(diagnostic);
                None
            }
        }
    }

    /// Expands a function's formula in the place of its call.
    fn function_value(&mut self, at: usize, argument: Value, span: Span, context: &Context<'_>) -> Option<Value> {
        let function = &self.functions[at];
        if !function.sound {
            return None;
        }
        if !context.expands {
            return Some(argument);
        }
        let (formula, name) = (function.value, function.argument);
        let call = Call {
            entity: Entity::Function(at),
            argument: Some((argument.id, argument.dim.key())),
            judged: context.judged,
            printed: context.printed,
            branch: self.branch,
        };
        let inner = Context {
            time: true,
            quantities: false,
            rates: false,
            measures: false,
            results: false,
            names: true,
            ..*context
        };
        self.expand(call, formula, Some((&name.text, argument)), span, &inner)
    }

    /// Expands the formula of another measure in its place.
    pub(super) fn measure_value(&mut self, at: usize, span: Span, context: &Context<'_>) -> Option<Value> {
        if let Some((part, Entity::Measure(inside))) = self.scope.origin(Entity::Measure(at)) {
            let (branch, caller) = (self.branch, self.reporter.caller.or(Some(span)));
            return self.in_part(part, |child| {
                (child.branch, child.reporter.caller) = (branch, caller);
                let value = child.measure_value(inside, span, context);
                (child.branch, child.reporter.caller) = (Branch::default(), None);
                value
            });
        }
        if !self.measures[at].sound {
            return None;
        }
        let formula = self.measures[at].value;
        let (judged, branch) = (context.judged, self.branch);
        let call = Call { entity: Entity::Measure(at), argument: None, judged, printed: None, branch };
        self.expand(call, formula, None, span, context)
    }

    fn expand(
        &mut self,
        call: Call,
        formula: &'a Expr,
        argument: Option<(&'a str, Value)>,
        span: Span,
        context: &Context<'_>,
    ) -> Option<Value> {
        if let Some(&cached) = self.calls.expansions.get(&call) {
            // The conditions of a formula apply where it is called.
            if let Some(conditions) = self.calls.conditions.get(&call) {
                self.model.conditions.extend_from_slice(conditions);
            }
            return cached;
        }
        let caller = self.reporter.caller.or(Some(span));
        if self.calls.abandoned.contains(&call) {
            self.calls.is_abandoned = true;
            return None;
        }
        if self.calls.levels > DEEPEST_CALL {
            let context = context.at("", argument);
            self.calls.deferred.push(DeferredCall { call, formula, context, caller });
            self.calls.abandoned.insert(call);
            self.calls.is_abandoned = true;
            return None;
        }
        let outer = std::mem::replace(&mut self.reporter.caller, caller);
        let value = self.expansion(call, formula, &context.at(context.place, argument));
        self.reporter.caller = outer;
        value
    }

    /// Expands a call and caches the value, unless it is abandoned.
    fn expansion(&mut self, call: Call, formula: &Expr, context: &Context<'_>) -> Option<Value> {
        let outer = std::mem::replace(&mut self.calls.is_abandoned, false);
        // The called formula does not belong to the body in which it is called.
        let scope = std::mem::take(&mut self.current);
        let (complete, visited) = (self.calls.complete, self.calls.visited);
        let first = self.model.conditions.len();
        let value = self.number(formula, context);
        self.current = scope;
        if self.calls.is_abandoned {
            self.calls.abandoned.insert(call);
        } else {
            self.calls.complete = complete + (self.calls.visited - visited);
            self.cache_conditions(call, first);
            self.calls.expansions.insert(call, value);
        }
        self.calls.is_abandoned |= outer;
        value
    }

    /// Caches the conditions of an expansion from `first` on, without duplicates.
    fn cache_conditions(&mut self, call: Call, first: usize) {
        let mut conditions = self.model.conditions.split_off(first);
        let mut unique = FxHashSet::default();
        conditions.retain(|condition| unique.insert(condition.positive));
        self.model.conditions.extend_from_slice(&conditions);
        if !conditions.is_empty() {
            self.calls.conditions.insert(call, conditions);
        }
    }

    /// Reads one level of a formula. At the lowest level, deferred calls are expanded and the formula is read again.
    pub(super) fn level<T>(
        &mut self,
        context: &Context<'_>,
        mut read: impl FnMut(&mut Self) -> Option<T>,
    ) -> Option<T> {
        if self.calls.levels > 0 {
            self.calls.levels += 1;
            let value = read(self);
            self.calls.levels -= 1;
            return value;
        }
        let (before, conditions) = (self.calls.visited, self.model.conditions.len());
        (self.calls.complete, self.calls.read, self.calls.is_too_large) = (0, 0, false);
        let mut value = self.reading(before, &mut read);
        while self.calls.is_abandoned && !self.calls.is_too_large {
            self.expand_deferred(before, context.place);
            value = self.reading(before, &mut read);
        }
        if !self.calls.is_abandoned {
            self.remove_repeated_conditions(conditions);
        }
        self.calls.deferred.clear();
        value
    }

    /// Counts the parts of a formula from zero, unless another formula is open, whose count goes on.
    pub(super) fn start_count(&mut self) {
        if self.calls.levels == 0 {
            self.calls.visited = 0;
        }
    }

    /// Counts a part of a formula, and rejects the formula if it has too many.
    pub(super) fn count_part(&mut self, span: Span) -> Option<()> {
        self.calls.visited += 1;
        if self.calls.is_too_large || self.calls.visited <= LARGEST && self.calls.read <= MOST_READ * LARGEST {
            return (!self.calls.is_too_large).then_some(());
        }
        self.calls.is_too_large = true;
        self.reporter.diagnostics.push(errors::too_large(self.reporter.caller.unwrap_or(span)));
        None
    }

    /// Returns whether a deferred call makes the value of the current formula unavailable.
    pub(super) fn is_deferred(&self) -> bool {
        self.calls.is_abandoned
    }

    /// Reads a formula from the lowest level.
    fn reading<T>(&mut self, before: usize, read: impl FnOnce(&mut Self) -> Option<T>) -> Option<T> {
        self.calls.visited = before + self.calls.complete;
        self.calls.abandoned.clear();
        self.calls.is_abandoned = false;
        self.calls.levels = 1;
        let value = read(self);
        self.calls.levels = 0;
        self.calls.read += self.calls.visited - before - self.calls.complete;
        value
    }

    /// Expands all deferred calls, including those that they defer.
    fn expand_deferred(&mut self, before: usize, place: &str) {
        let outer = (self.branch, self.reporter.caller);
        while let Some(DeferredCall { call, formula, context, caller }) = self.calls.deferred.pop() {
            if self.calls.expansions.contains_key(&call) {
                continue;
            }
            if self.calls.is_too_large {
                break;
            }
            (self.branch, self.reporter.caller) = (call.branch, caller);
            let at = self.calls.deferred.len();
            self.reading(before, |formulas| formulas.expansion(call, formula, &context.at(place, context.argument)));
            if self.calls.is_abandoned {
                self.calls.deferred.insert(at, DeferredCall { call, formula, context, caller });
            }
        }
        (self.branch, self.reporter.caller) = outer;
    }

    /// Removes duplicate conditions, which repeated readings and calls add.
    fn remove_repeated_conditions(&mut self, from: usize) {
        if self.model.conditions.len() <= from + 1 {
            return;
        }
        let mut unique = FxHashSet::default();
        let conditions = self.model.conditions.split_off(from);
        let new = conditions.into_iter().filter(|condition| unique.insert((condition.positive, condition.span)));
        self.model.conditions.extend(new);
    }
}
