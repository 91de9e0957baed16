//! Results of the whole analysis, in addition to its rows.

use super::{ConstraintSystem, Units, Variations};
use mechc_expr::ExprId;
use mechc_text::source::Span;

/// Results of the whole analysis.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// Reductions that the results need, by the number of their named symbol.
    pub reductions: Vec<Reduction>,
    /// The results.
    pub outcomes: Vec<Outcome>,
    /// The requirements that are judged.
    pub requirements: Vec<Requirement>,
    /// Variations in the formulas, those of the rows first; `None` if there are none.
    pub variations: Option<Box<Variations>>,
    /// Numbers of variations, each with the condition that the left-out equations keep holding along it.
    pub variation_conditions: Vec<(u32, ExprId)>,
}

/// A result: one number for the whole analysis.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Name.
    pub name: String,
    /// Span of the name.
    pub span: Span,
    /// Formula over parameters and reductions; these are named symbols.
    pub value: ExprId,
    /// Units for printing.
    pub units: Units,
    /// True if a condition over unknown values counts as false; otherwise the result is unknown.
    pub unknown_is_false: bool,
}

/// A requirement: bounds of a number of the whole analysis, or of a quantity at all times of it.
#[derive(Clone, Debug)]
pub struct Requirement {
    /// Name, or else what it compares.
    pub name: String,
    /// Span of the declaration.
    pub span: Span,
    /// The bounded formula, as written.
    pub formula: String,
    /// The bounds.
    pub bounds: Vec<Bound>,
    /// Units in which values are reported.
    pub units: Units,
}

/// A bound of a requirement; all formulas are over parameters and reductions.
#[derive(Clone, Debug)]
pub struct Bound {
    /// True for an upper bound.
    pub is_upper: bool,
    /// The excess of the value over the bound (SI): at most 0 if the bound holds.
    pub excess: ExprId,
    /// The bounded value, where it exceeds the bound most.
    pub value: ExprId,
    /// The bound there.
    pub bound: ExprId,
    /// The times at which a quantity exceeds it; `None` for one number of the whole analysis.
    pub times: Option<RequirementTimes>,
}

/// The times (s) at which a quantity exceeds a bound, as formulas of reductions.
#[derive(Clone, Copy, Debug)]
pub struct RequirementTimes {
    /// The first such time.
    pub first: ExprId,
    /// The first time at which it exceeds the bound most.
    pub worst: ExprId,
}

/// A formula reduced to one number over the analysis, or over a window of it.
#[derive(Clone, Copy, Debug)]
pub struct Reduction {
    /// The formula, over parameters, time, coordinates with their derivatives and variations, and other reductions.
    pub of: ExprId,
    /// The kind of number.
    pub kind: ReductionKind,
    /// First and last time (s), as formulas of parameters and other reductions; `None` is the respective end of the analysis. `At` has no window.
    pub window: [Option<ExprId>; 2],
    /// Span of its first occurrence.
    pub span: Span,
}

/// Kinds of reductions.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ReductionKind {
    /// The largest or the least value.
    Extreme {
        /// True for the largest value, false for the least.
        largest: bool,
        /// True for the first time of the extremum (s) rather than the value.
        when: bool,
    },
    /// The mean over time.
    Mean,
    /// The integral over time.
    Integral,
    /// The value at the first time.
    First,
    /// The value at the last time.
    Last,
    /// The value at a time (s): a formula of parameters, or the time of an extremum.
    At(ExprId),
}

impl ConstraintSystem {
    /// Returns the same equations with the variations that results need, and without measures and results; `None` if results need no variations.
    #[must_use]
    pub fn with_result_variations(&self) -> Option<ConstraintSystem> {
        let variations = self.results.variations.clone()?;
        let (measures, results) = (Vec::new(), Results::default());
        let system = ConstraintSystem { variations: Some(variations), measures, results, ..self.clone() };
        debug_assert_eq!(system.validate(), Ok(()));
        Some(system)
    }
}
