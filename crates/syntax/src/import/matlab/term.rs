//! Terms of a MATLAB formula as formulas of the language.

use crate::ast::{ComparisonSign, Expr, ExprKind};
use crate::import::build;

/// A formula that is a number or, in MATLAB's way, true or false; a truth value is a condition in the language.
pub(super) struct Term {
    expression: Expr,
    is_truth: bool,
}

impl Term {
    pub fn number(expression: Expr) -> Term {
        Term { expression, is_truth: false }
    }

    pub fn truth(expression: Expr) -> Term {
        Term { expression, is_truth: true }
    }

    /// Returns the number or condition as it is.
    pub fn expression(&self) -> &Expr {
        &self.expression
    }

    /// True is 1, false is 0.
    pub fn into_number(self) -> Expr {
        if !self.is_truth {
            return self.expression;
        }
        let span = self.expression.span;
        let otherwise = Box::new(build::number(0.0, span));
        Expr { kind: ExprKind::If { arms: vec![(self.expression, build::number(1.0, span))], otherwise }, span }
    }

    /// Converts to a condition: nonzero is true.
    pub fn into_condition(self) -> Expr {
        if self.is_truth { self.expression } else { against_zero(self.expression, ComparisonSign::NotEqual) }
    }

    /// True where it was false.
    pub fn not(self) -> Term {
        let span = self.expression.span;
        Term::truth(if self.is_truth {
            Expr { kind: ExprKind::Not(Box::new(self.expression)), span }
        } else {
            against_zero(self.expression, ComparisonSign::Equal)
        })
    }
}

fn against_zero(e: Expr, comparison: ComparisonSign) -> Expr {
    let span = e.span;
    Expr { kind: ExprKind::Compare(Box::new(e), comparison, Box::new(build::number(0.0, span))), span }
}
