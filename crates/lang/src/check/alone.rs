//! Formulas that name nothing of any file: those of the command line.

use super::formula::Context;
use super::{Checker, Surroundings};
use crate::model::{Condition, DecidedBy, Dimension};
use mechc_expr::{ExprId, Graph};
use mechc_syntax::ast::{self, Expr, Name};
use mechc_text::diag::Diagnostics;
use mechc_text::source::{Sources, Span};

/// The value in SI of a formula that names nothing of any file: a time of the command line.
///
/// # Errors
/// What is wrong with it.
pub fn constant(formula: &Expr, place: &str, wanted: Dimension, sources: &Sources) -> Result<f64, Diagnostics> {
    alone(formula, sources, |checker| checker.constant(formula, place, wanted))
}

/// The same of one that has a unit, unless it is nothing or a pure number.
///
/// # Errors
/// What is wrong with it.
pub fn amount(formula: &Expr, place: &str, wanted: Dimension, sources: &Sources) -> Result<f64, Diagnostics> {
    alone(formula, sources, |checker| checker.judged_constant(formula, place, wanted, (DecidedBy::Value, true)))
}

fn alone(
    formula: &Expr,
    sources: &Sources,
    read: impl FnOnce(&mut Checker<'_>) -> Option<(ExprId, f64)>,
) -> Result<f64, Diagnostics> {
    let tree = nothing(formula.span);
    let surroundings = Surroundings::default();
    let mut checker = Checker::new(&tree, &surroundings, sources);
    match read(&mut checker) {
        Some((_, value)) if !checker.diagnostics.has_errors() => Ok(value),
        _ => Err(checker.diagnostics),
    }
}

/// A formula of time that names nothing of any file.
#[derive(Clone, Debug)]
pub struct FormulaOfTime {
    /// Holds the formula; its only symbol is time.
    pub graph: Graph,
    /// The formula, in SI.
    pub value: ExprId,
    /// Of its value; `None` for a plain formula, whose dimension says nothing.
    pub dimension: Option<Dimension>,
    /// What must be positive at a time, for the formula to have a meaning there.
    pub conditions: Vec<Condition>,
    /// What is to be said of it all the same.
    pub remarks: Diagnostics,
}

/// A formula alone, over time and the constants and functions of the language.
///
/// # Errors
/// What is wrong with it.
pub fn formula_of_time(formula: &Expr, sources: &Sources) -> Result<FormulaOfTime, Diagnostics> {
    let tree = nothing(formula.span);
    let surroundings = Surroundings::default();
    let mut checker = Checker::new(&tree, &surroundings, sources);
    let judged = checker.is_dimensional(formula);
    let context = Context { judged, time: true, names: false, ..Context::constant("a formula of time") };
    let value = checker.formula(formula, &context);
    let Checker { mut diagnostics, model, .. } = checker;
    diagnostics.sort_by_place();
    match value {
        Some(value) if !diagnostics.has_errors() => Ok(FormulaOfTime {
            graph: model.graph,
            value: value.id,
            dimension: judged.then(|| value.dim.settled()),
            conditions: model.conditions,
            remarks: diagnostics,
        }),
        _ => Err(diagnostics),
    }
}

/// A mechanism without any declaration, as the surroundings of a formula of the command line.
fn nothing(span: Span) -> ast::Mechanism {
    let name = Name { text: String::new(), span };
    ast::Mechanism { docs: Vec::new(), name, span, items: Vec::new() }
}
