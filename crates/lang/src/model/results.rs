//! What is asked of a whole analysis: results, as formulas over reductions.

use super::{Condition, Declared, Units};
use mechc_expr::ExprId;
use mechc_text::source::Span;

/// One number for the whole analysis.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Its name.
    pub declared: Declared,
    /// Its formula, over parameters and reductions.
    pub value: ExprId,
    /// In what it is told.
    pub units: Units,
}

/// What becomes of a formula over the whole analysis.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// Which number of it is asked for.
    pub kind: ReductionKind,
    /// Where it is written first.
    pub span: Span,
    /// The formula: that of a measure, which may hold other reductions.
    pub of: ExprId,
    /// From when to when it is taken (s): formulas of parameters and other reductions; an end of the analysis where there is none.
    pub window: [Option<ExprId>; 2],
    /// How many time derivatives of the coordinates it holds.
    pub order: u8,
    /// What must be positive for it to have a value.
    pub conditions: Vec<Condition>,
}

/// The reductions.
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
    /// How it is written, with the text of its times.
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
