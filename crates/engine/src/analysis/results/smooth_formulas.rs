//! Smooth formulas that results ask of the motion, for variants that are evaluated in a batch: extrema of them, integrals, and values at some times.

use super::batch_evaluation::SmoothFormula;
use super::curve::Curve;
use super::{curves, needed, value_of};
use mechc_expr::ExprId;
use mechc_ir::{ConstraintSystem, ReductionKind};

/// The smooth formulas of all results of a mechanism.
pub struct SmoothFormulas {
    each: Vec<SmoothFormula>,
    /// The formula of each reduction, by its number, and the kind of the reduction.
    reductions: Vec<(usize, ReductionKind)>,
}

impl SmoothFormulas {
    /// Returns the formulas of a system with smooth equations, or `None` if its results need anything else.
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
            curves.into_iter().map(|(curve, ())| Curve::into_quantity(curve)).collect();
        let reductions = curve_of.into_iter().zip(all).map(|(of, reduction)| (of, reduction.kind)).collect();
        Some(SmoothFormulas { each: each?, reductions })
    }

    /// Returns the formulas.
    #[must_use]
    pub fn each(&self) -> &[SmoothFormula] {
        &self.each
    }

    /// Returns the formula of each reduction, by its number, and the kind of the reduction.
    #[must_use]
    pub fn reductions(&self) -> &[(usize, ReductionKind)] {
        &self.reductions
    }

    /// A formula of parameters (SI), and of the reductions, by their numbers, where they are known; with whether a condition over what is not
    /// known does not hold.
    #[must_use]
    pub fn value(
        system: &ConstraintSystem,
        formula: (ExprId, bool),
        params: impl Fn(u32) -> f64,
        found: &[f64],
    ) -> f64 {
        value_of(system.graph(), formula, params, |k| found.get(k).copied().unwrap_or(f64::NAN))
    }
}
