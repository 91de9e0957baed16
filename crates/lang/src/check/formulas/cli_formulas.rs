//! Formulas of the command line, which name nothing of a file.

use super::Formulas;
use super::value::Context;
use crate::check::errors::Reporter;
use crate::check::options::CheckOptions;
use crate::model::{Condition, Dimension, GuardKind};
use mechc_expr::{ExprId, Graph};
use mechc_syntax::ast::{self, Expr, Name};
use mechc_text::diag::Diagnostics;
use mechc_text::source::{Sources, Span};

/// Returns the value (SI) of a formula that names nothing of a file, such as a time.
///
/// # Errors
/// The diagnostics of the formula.
pub fn constant(formula: &Expr, place: &str, expected: Dimension, sources: &Sources) -> Result<f64, Diagnostics> {
    evaluate(formula, sources, |formulas| formulas.constant(formula, place, expected))
}

/// Returns the value (SI) of such a formula, which must have a unit unless it is zero or a pure number.
///
/// # Errors
/// The diagnostics of the formula.
pub fn amount(formula: &Expr, place: &str, expected: Dimension, sources: &Sources) -> Result<f64, Diagnostics> {
    evaluate(formula, sources, |formulas| formulas.judged_constant(formula, place, expected, GuardKind::Value, true))
}

fn evaluate(
    formula: &Expr,
    sources: &Sources,
    read: impl FnOnce(&mut Formulas<'_>) -> Option<(ExprId, f64)>,
) -> Result<f64, Diagnostics> {
    let tree = empty_mechanism(formula.span);
    let options = CheckOptions::default();
    let mut formulas = Formulas::new(&tree, &options, sources);
    match read(&mut formulas) {
        Some((_, value)) if !formulas.reporter.diagnostics.has_errors() => Ok(value),
        _ => Err(formulas.reporter.diagnostics),
    }
}

/// A formula of time that names nothing of a file.
#[derive(Clone, Debug)]
pub struct FormulaOfTime {
    /// The graph of the formula. Its only symbol is time.
    pub graph: Graph,
    /// The formula, in SI units.
    pub value: ExprId,
    /// The dimension, if numbers without units are pure.
    pub dimension: Dimension,
    /// True if the formula holds a unit of a dimension; the dimension of a plain formula is open.
    pub is_dimensional: bool,
    /// Formulas that must be positive for the formula to be defined at a time.
    pub conditions: Vec<Condition>,
    /// Warnings.
    pub remarks: Diagnostics,
}

/// Checks a formula of time, constants and the functions of the language.
///
/// # Errors
/// The diagnostics of the formula.
pub fn formula_of_time(formula: &Expr, sources: &Sources) -> Result<FormulaOfTime, Diagnostics> {
    let tree = empty_mechanism(formula.span);
    let options = CheckOptions::default();
    let mut formulas = Formulas::new(&tree, &options, sources);
    let judged = formulas.is_dimensional(formula);
    let context = Context { judged, time: true, names: false, ..Context::constant("a formula of time") };
    let value = formulas.formula(formula, &context);
    let Formulas { reporter: Reporter { mut diagnostics, .. }, model, .. } = formulas;
    diagnostics.sort_by_span();
    match value {
        Some(value) if !diagnostics.has_errors() => Ok(FormulaOfTime {
            graph: model.graph,
            value: value.id,
            dimension: value.dim.settled(),
            is_dimensional: judged,
            conditions: model.conditions,
            remarks: diagnostics,
        }),
        _ => Err(diagnostics),
    }
}

/// Returns a mechanism without declarations as the context of a formula of the command line.
fn empty_mechanism(span: Span) -> ast::Mechanism {
    let name = Name { text: String::new(), span };
    ast::Mechanism { docs: Vec::new(), name, span, items: Vec::new() }
}
