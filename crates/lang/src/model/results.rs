//! Results of a whole analysis, as formulas of reductions.

use super::{Condition, Declared, Units};
use mechc_expr::ExprId;
use mechc_text::source::Span;

/// A result: one number for the whole analysis.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The result's name.
    pub declared: Declared,
    /// The formula, over parameters and reductions.
    pub value: ExprId,
    /// The units in which it is printed.
    pub units: Units,
}

/// The reduction of a formula over the whole analysis to one number.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// The kind of reduction.
    pub kind: ReductionKind,
    /// The location of its first occurrence.
    pub span: Span,
    /// The formula: as in a measure, and it may hold other reductions.
    pub of: ExprId,
    /// The start and end of the window (s), formulas of parameters and other reductions; `None` for the start or end of the analysis.
    pub window: [Option<ExprId>; 2],
    /// The highest order of time derivatives of the coordinates in the formula.
    pub order: u8,
    /// Formulas that must be positive for the formula to have a value.
    pub conditions: Vec<Condition>,
}

/// A requirement: bounds of a number of the whole analysis, or of a quantity at all times of it.
#[derive(Clone, Debug)]
pub struct Requirement {
    /// The name, or else what it compares, and the location of the declaration.
    pub declared: Declared,
    /// The bounded formula, as written.
    pub formula: String,
    /// The bounds.
    pub bounds: Vec<Bound>,
    /// The units in which values are reported.
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

/// The kinds of reductions.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ReductionKind {
    /// The largest value.
    Max,
    /// The least value.
    Min,
    /// The first time of the largest value (s).
    ArgMax,
    /// The first time of the least value (s).
    ArgMin,
    /// The mean over time.
    Mean,
    /// The root of the mean square.
    Rms,
    /// The integral over time.
    Integral,
    /// The value at the first time.
    First,
    /// The value at the last time.
    Last,
    /// The value at a time (s), a formula of parameters.
    At(ExprId),
}

impl ReductionKind {
    /// Returns the reduction as source text; `time` writes a time.
    #[must_use]
    pub fn written(self, formula: &str, window: [Option<ExprId>; 2], time: impl Fn(ExprId) -> String) -> String {
        let word = match self {
            ReductionKind::Max => "max",
            ReductionKind::Min => "min",
            ReductionKind::ArgMax => "argmax",
            ReductionKind::ArgMin => "argmin",
            ReductionKind::Mean => "mean",
            ReductionKind::Rms => "rms",
            ReductionKind::Integral => "integral",
            ReductionKind::First => "first",
            ReductionKind::Last => "last",
            ReductionKind::At(at) => return format!("at({formula}, {})", time(at)),
        };
        let bounds = ["from", "to"].into_iter().zip(window);
        let bounds = bounds.filter_map(|(word, bound)| bound.map(|bound| format!(" {word} {}", time(bound))));
        let bounds: String = bounds.collect();
        let comma = if bounds.is_empty() { "" } else { "," };
        format!("{word}({formula}{comma}{bounds})")
    }
}
