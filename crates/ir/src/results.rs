//! What is asked of a whole analysis, beside its rows.

use super::{ConstraintSystem, Units, Variations};
use mechc_expr::ExprId;
use mechc_text::source::Span;

/// Numbers for the whole analysis.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// What they ask of the motion, by the number of its named symbol.
    pub reductions: Vec<Reduction>,
    /// The numbers.
    pub outcomes: Vec<Outcome>,
    /// The variations that the formulas hold, those of the rows first; where they hold any.
    pub variations: Option<Box<Variations>>,
    /// By the number of a variation: what holds only where the equations that were left out go on to hold.
    pub varied_where: Vec<(u32, ExprId)>,
}

/// One number for the whole analysis.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Its name.
    pub name: String,
    /// The name's place.
    pub span: Span,
    /// Its formula, over parameters and reductions, which are named symbols.
    pub value: ExprId,
    /// In what it is told.
    pub units: Units,
    /// Whether a condition over what is not known does not hold: elsewhere such a result is not known.
    pub unknown_is_false: bool,
}

/// What becomes of a formula over the analysis, or over a part of it.
#[derive(Clone, Copy, Debug)]
pub struct Reduction {
    /// The formula, over parameters, time, coordinates with their derivatives and variations, and other reductions.
    pub of: ExprId,
    /// Which number of it.
    pub kind: ReductionKind,
    /// From when to when it is taken (s): formulas of parameters and other reductions; `None` is the analysis' own end. An `At` has none.
    pub window: [Option<ExprId>; 2],
    /// Where it is written first.
    pub span: Span,
}

/// The numbers that can be asked of a formula.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ReductionKind {
    /// The largest value, or the least one.
    Extreme {
        /// Which of the two.
        largest: bool,
        /// Its first time (s), rather than the value itself.
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
    /// The value at a time (s), a formula of parameters, or the time of an extremum.
    At(ExprId),
}

impl ConstraintSystem {
    /// The same equations, whose variations are those that results need, and nothing that rows show; none where they need none.
    #[must_use]
    pub fn for_variations_of_results(&self) -> Option<ConstraintSystem> {
        let variations = self.results.variations.clone()?;
        let (measures, results) = (Vec::new(), Results::default());
        let system = ConstraintSystem { variations: Some(variations), measures, results, ..self.clone() };
        debug_assert_eq!(system.validate(), Ok(()));
        Some(system)
    }
}
