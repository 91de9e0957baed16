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
