//! Calls: functions and measures expanded where they stand, each expansion made once.

use super::formula::{Context, Dim, Value};
use super::names::Entity;
use super::{Checker, errors};
use crate::expr::ExprId;
use crate::source::Span;
use crate::syntax::ast::{Expr, Name};
use crate::vocabulary::is_called;
use rustc_hash::FxHashSet;

/// One expansion of a function or measure: which, of what argument, and how it is read.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Call {
    entity: Entity,
    argument: Option<(ExprId, Option<(u64, u64)>)>,
    judged: bool,
    /// Less is said in a branch that is never taken.
    untaken: bool,
    /// What must be positive must be so only where its branch counts.
    guard: Option<ExprId>,
}

impl Checker<'_> {
    /// A call of a function of the language or of the file.
    pub(super) fn call(&mut self, e: &Expr, name: &Name, arguments: &[Expr], context: &Context<'_>) -> Option<Value> {
        if is_called(&name.text) {
            if self.is_declared_though_taken(name) {
                return None;
            }
            return self.builtin(e, name, arguments, context);
        }
        match self.resolve(name).ok()?.filter(|_| context.names) {
            Some(Entity::Function(k)) => {
                let [argument] = arguments else {
                    self.report(errors::argument_count(&name.text, None, e.span, "one argument", arguments.len()));
                    return None;
                };
                let argument = self.number(argument, context)?;
                if let Some(at) = self.functions[k].time.filter(|_| !context.time) {
                    self.report(errors::time_in(context.place, e.span, Some((&name.text, at))));
                    return None;
                }
                self.function_value(k, argument, e.span, context)
            }
            Some(Entity::Table(k)) => self.table_call(k, e, arguments, context),
            Some(entity) => {
                self.report(errors::not_callable(name, entity));
                None
            }
            None => {
                let own = self.suggestions(|entity| matches!(entity, Entity::Function(_) | Entity::Table(_)));
                let texts: Vec<&str> = arguments.iter().map(|e| self.sources.text(e.span)).collect();
                let diagnostic = errors::unknown_function(name, &own, &texts);
                self.report(diagnostic);
                None
            }
        }
    }

    /// A function's formula where it is called, as if it stood there.
    fn function_value(&mut self, at: usize, argument: Value, span: Span, context: &Context<'_>) -> Option<Value> {
        let function = &self.functions[at];
        if !function.sound {
            return None;
        }
        if !context.expands {
            return Some(argument);
        }
        let (formula, name) = (function.value, function.argument);
        let bits = match argument.dim {
            Dim::Of(d) if context.judged => Some(((d.length + 0.0).to_bits(), (d.time + 0.0).to_bits())),
            Dim::Any | Dim::Of(_) => None,
        };
        let key = Call {
            entity: Entity::Function(at),
            argument: Some((argument.id, bits)),
            judged: context.judged,
            untaken: self.untaken,
            guard: self.guard,
        };
        let inner = Context {
            time: true,
            argument: Some((&name.text, argument)),
            quantities: false,
            measures: false,
            names: true,
            ..*context
        };
        self.expand(key, formula, span, &inner)
    }

    /// Another measure's formula, as if it stood there.
    pub(super) fn measure_value(&mut self, at: usize, span: Span, context: &Context<'_>) -> Option<Value> {
        if !self.measures[at].sound {
            return None;
        }
        let formula = self.measures[at].value;
        let key = Call {
            entity: Entity::Measure(at),
            argument: None,
            judged: context.judged,
            untaken: self.untaken,
            guard: self.guard,
        };
        self.expand(key, formula, span, &Context { argument: None, ..*context })
    }

    fn expand(&mut self, key: Call, formula: &Expr, span: Span, context: &Context<'_>) -> Option<Value> {
        if let Some(&known) = self.calls.get(&key) {
            // who calls it asks for what it asks for
            if let Some(conditions) = self.conditions_of_calls.get(&key) {
                self.model.conditions.extend_from_slice(conditions);
            }
            return known;
        }
        self.callers.push(span);
        let first = self.model.conditions.len();
        // functions may call each other in a long chain
        let value = stacker::maybe_grow(256 << 10, 4 << 20, || self.number(formula, context));
        self.callers.pop();
        let mut conditions = self.model.conditions.split_off(first);
        let mut seen = FxHashSet::default();
        conditions.retain(|condition| seen.insert(condition.positive));
        self.model.conditions.extend_from_slice(&conditions);
        if !conditions.is_empty() {
            self.conditions_of_calls.insert(key, conditions);
        }
        self.calls.insert(key, value);
        value
    }
}
