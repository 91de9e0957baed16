//! Branches of `if`, and the conditions under which formulas in them count.

use super::Formulas;
use super::value::{Context, Value};
use crate::check::errors;
use mechc_expr::{Comparison, ExprId};
use mechc_syntax::ast::{ComparisonSign, Expr, ExprKind};

/// The branch of the current formula.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(super) struct Branch {
    /// True if it is never taken, so that values give no diagnostics.
    pub is_untaken: bool,
    /// The condition under which it counts.
    pub guard: Option<ExprId>,
}

impl Formulas<'_> {
    pub(super) fn choice(&mut self, arms: &[(Expr, Expr)], otherwise: &Expr, context: &Context<'_>) -> Option<Value> {
        let values = arms.iter().map(|(_, value)| value).chain(std::iter::once(otherwise));
        self.warn_of_numbers_as_radians(values, context);
        let outer = self.branch;
        let mut decided = false;
        let mut parts = Vec::new();
        for (condition, value) in arms {
            let condition = self.condition(condition, context);
            if condition.is_none() && self.is_deferred() {
                // The branch that counts is not determined yet.
                self.branch = outer;
                return None;
            }
            let truth = condition.and_then(|id| self.constant_value(id));
            self.branch.is_untaken = outer.is_untaken || decided || truth == Some(0.0);
            let before = self.branch.guard;
            self.guard_with(before, condition);
            parts.push((condition, value.span, self.number(value, context)));
            let opposite = condition.map(|id| self.model.graph.not(id));
            self.guard_with(before, opposite);
            decided |= truth == Some(1.0);
        }
        self.branch.is_untaken = outer.is_untaken || decided;
        let last = self.number(otherwise, context);
        self.branch = outer;
        let mut choice = last?;
        let mut span = otherwise.span;
        for (condition, value_span, value) in parts.into_iter().rev() {
            let (condition, value) = (condition?, value?);
            let dim = self.unify("the branches of this `if` are", (value_span, value), (span, choice), context)?;
            choice = Value { id: self.model.graph.select(condition, value.id, choice.id), dim };
            span = value_span;
        }
        Some(Value { dim: choice.dim.of_term(), ..choice })
    }

    /// Adds a condition to those of the outer branches.
    fn guard_with(&mut self, outer: Option<ExprId>, condition: Option<ExprId>) {
        self.branch.guard = match (outer, condition) {
            (Some(outer), Some(condition)) => Some(self.model.graph.and(outer, condition)),
            (one, other) => one.or(other),
        };
    }

    fn condition(&mut self, e: &Expr, context: &Context<'_>) -> Option<ExprId> {
        self.level(context, |formulas| formulas.condition_here(e, context))
    }

    fn condition_here(&mut self, e: &Expr, context: &Context<'_>) -> Option<ExprId> {
        match &e.kind {
            ExprKind::Paren(inner) => self.condition(inner, context),
            ExprKind::Not(inner) => {
                let inner = self.condition(inner, context)?;
                Some(self.model.graph.not(inner))
            }
            ExprKind::And(list) | ExprKind::Or(list) => {
                let ids: Vec<Option<ExprId>> = list.iter().map(|part| self.condition(part, context)).collect();
                let mut ids = ids.into_iter();
                let mut all = ids.next()??;
                for id in ids {
                    all = match e.kind {
                        ExprKind::And(_) => self.model.graph.and(all, id?),
                        _ => self.model.graph.or(all, id?),
                    };
                }
                Some(all)
            }
            ExprKind::Compare(a, comparison, b) => {
                self.warn_of_numbers_as_radians([&**a, &**b].into_iter(), context);
                let (left, right) = (self.number(a, context), self.number(b, context));
                let (left, right) = (left?, right?);
                self.unify("this compares", (a.span, left), (b.span, right), context)?;
                self.record_compared_lengths([(a, left), (b, right)], context);
                let (x, y, graph) = (left.id, right.id, &mut self.model.graph);
                Some(match comparison {
                    ComparisonSign::Less => graph.compare(Comparison::Less, x, y),
                    ComparisonSign::LessEqual => graph.compare(Comparison::LessEqual, x, y),
                    ComparisonSign::Greater => graph.compare(Comparison::Less, y, x),
                    ComparisonSign::GreaterEqual => graph.compare(Comparison::LessEqual, y, x),
                    ComparisonSign::Equal => graph.compare(Comparison::Equal, x, y),
                    ComparisonSign::NotEqual => {
                        let equal = graph.compare(Comparison::Equal, x, y);
                        graph.not(equal)
                    }
                })
            }
            _ => {
                self.reporter.report(errors::number_as_condition(e.span));
                None
            }
        }
    }
}
