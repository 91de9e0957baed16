//! The smooth formulas of results, whose extrema, integrals and values at single times are computed for variants in a batch.

use super::batch_evaluation::SmoothFormula;
use super::curve::Curve;
use super::{curves, needed, value_of};
use mechc_expr::ExprId;
use mechc_ir::{ConstraintSystem, ReductionKind};

/// The smooth formulas of all results of a mechanism.
pub struct SmoothFormulas {
    each: Vec<SmoothFormula>,
    /// The number of the formula and the kind of each reduction.
    reductions: Vec<(usize, ReductionKind)>,
}

impl SmoothFormulas {
    /// Returns the formulas of a system with smooth equations, or `None` if its results need other formulas, windows or variations.
    #[must_use]
    pub fn of(system: &ConstraintSystem) -> Option<SmoothFormulas> {
        let results = system.results();
        let is_plain = |kind: ReductionKind, of: ExprId| {
            let at = match kind {
                ReductionKind::At(at) => needed(system.graph(), at),
                _ => Vec::new(),
            };
            at.is_empty() && needed(system.graph(), of).is_empty()
        };
        let all = &results.reductions;
        let is_whole = |window: [Option<ExprId>; 2]| window == [None; 2];
        let is_smooth = all.iter().all(|it| is_whole(it.window) && is_plain(it.kind, it.of));
        if results.variations.is_some() || all.is_empty() || !is_smooth {
            return None;
        }
        let of: Vec<(ExprId, ())> = all.iter().map(|reduction| (reduction.of, ())).collect();
        let (curves, curve_of) = curves(system, &of, |_| f64::NAN, 0);
        let each: Option<Vec<SmoothFormula>> =
            curves.into_iter().map(|(curve, ())| Curve::into_smooth_formula(curve)).collect();
        let reductions = curve_of.into_iter().zip(all).map(|(of, reduction)| (of, reduction.kind)).collect();
        Some(SmoothFormulas { each: each?, reductions })
    }

    /// Returns the formulas.
    #[must_use]
    pub fn each(&self) -> &[SmoothFormula] {
        &self.each
    }

    /// Returns the number of the formula and the kind of each reduction.
    #[must_use]
    pub fn reductions(&self) -> &[(usize, ReductionKind)] {
        &self.reductions
    }

    /// Returns the value of a formula of parameters (SI) and reductions; `reductions` holds the values of these by number, a missing one is NaN.
    /// `unknown_is_false` makes conditions over unknown values false.
    #[must_use]
    pub fn value(
        system: &ConstraintSystem,
        (formula, unknown_is_false): (ExprId, bool),
        params: impl Fn(u32) -> f64,
        reductions: &[f64],
    ) -> f64 {
        value_of(system.graph(), formula, unknown_is_false, params, |k| reductions.get(k).copied().unwrap_or(f64::NAN))
    }
}
