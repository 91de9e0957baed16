//! Results and their reductions. They are lowered last, so that they do not change the equations.

use super::slopes::{Reduced, Slopes};
use super::{Lowering, units};
use crate::model::ReductionKind;
use mechc_expr::{ExprId, Symbol, Unary};
use mechc_ir::{self as ir, Outcome, Results};
use rustc_hash::FxHashMap;

impl Lowering<'_> {
    pub(super) fn results(&mut self) -> Results {
        let model = self.model;
        self.resolve_symbols_up_to(model.named.len());
        let formulas: Vec<Reduced> = model.reductions.iter().map(|reduction| self.reduced_formula(reduction)).collect();
        let mut reductions: Vec<ir::Reduction> = Vec::with_capacity(formulas.len());
        for (reduction, &formula) in model.reductions.iter().zip(&formulas) {
            reductions.push(self.reduction(reduction, formula));
        }
        let outcomes = model.outcomes.iter().map(|outcome| Outcome {
            name: outcome.declared.name.clone(),
            span: outcome.declared.span,
            value: self.formula(outcome.value),
            units: units(&outcome.units),
            unknown_is_false: false,
        });
        let mut outcomes: Vec<Outcome> = outcomes.collect();
        if let Some(ends) = model.slopes {
            let ends = ends.map(|end| end.map(|formula| self.formula(formula)));
            let formulas = self.with_squares(&formulas);
            let slopes = self.slopes(&outcomes, &mut reductions, &formulas, ends);
            outcomes.extend(slopes);
        }
        let holds_variations = reductions.iter().any(|reduction| self.graph.dependence(reduction.of).is_varied());
        let variations = self.variations.take().filter(|_| holds_variations).map(Box::new);
        let requirements = model.requirements.iter().map(|requirement| self.requirement(requirement)).collect();
        Results { reductions, outcomes, requirements, variations, variation_conditions: Vec::new() }
    }

    fn requirement(&mut self, requirement: &crate::model::Requirement) -> ir::Requirement {
        let bounds = requirement.bounds.iter().map(|bound| ir::Bound {
            is_upper: bound.is_upper,
            excess: self.formula(bound.excess),
            value: self.formula(bound.value),
            bound: self.formula(bound.bound),
            times: bound.times.map(|times| ir::RequirementTimes {
                first: self.formula(times.first),
                worst: self.formula(times.worst),
            }),
        });
        ir::Requirement {
            name: requirement.declared.name.clone(),
            span: requirement.declared.span,
            formula: requirement.formula.clone(),
            bounds: bounds.collect(),
            units: units(&requirement.units),
        }
    }

    /// Returns the derivatives of results by the variables of columns: those of the first result, then those of the second, and so on.
    fn slopes(
        &mut self,
        outcomes: &[Outcome],
        reductions: &mut Vec<ir::Reduction>,
        formulas: &[Reduced],
        ends: [Option<ExprId>; 2],
    ) -> Vec<Outcome> {
        let mut cached: Vec<_> = self.model.by.iter().map(|_| FxHashMap::default()).collect();
        let mut slopes = Vec::with_capacity(outcomes.len() * cached.len());
        for outcome in outcomes {
            for (&variable, cached) in self.model.by.iter().zip(&mut cached) {
                let window = [None; 2];
                let mut context = Slopes { lowering: self, reductions, formulas, ends, window, variable, cached };
                slopes.push(context.outcome_slope(outcome));
            }
        }
        slopes
    }

    /// Returns the formulas of reductions; for a root mean square the square of its formula.
    fn with_squares(&mut self, formulas: &[Reduced]) -> Vec<Reduced> {
        let is_squared = self.model.reductions.iter().map(|reduction| reduction.kind == ReductionKind::Rms);
        let square = |(&of, is_squared): (&Reduced, bool)| {
            let value = if is_squared { self.graph.mul(of.value, of.value) } else { of.value };
            Reduced { value, ..of }
        };
        formulas.iter().zip(is_squared).map(square).collect()
    }

    /// Returns the formula of a reduction.
    fn reduced_formula(&mut self, reduction: &crate::model::Reduction) -> Reduced {
        let value = self.formula(reduction.of);
        let holds = self.all_hold(&reduction.conditions);
        Reduced { value, holds }
    }

    fn reduction(&mut self, reduction: &crate::model::Reduction, Reduced { value, holds }: Reduced) -> ir::Reduction {
        let value = self.only_where(holds, value);
        let extreme = |largest, when| ir::ReductionKind::Extreme { largest, when };
        let kind = match reduction.kind {
            ReductionKind::Max => extreme(true, false),
            ReductionKind::Min => extreme(false, false),
            ReductionKind::ArgMax => extreme(true, true),
            ReductionKind::ArgMin => extreme(false, true),
            ReductionKind::Mean | ReductionKind::Rms => ir::ReductionKind::Mean,
            ReductionKind::Integral => ir::ReductionKind::Integral,
            ReductionKind::First => ir::ReductionKind::First,
            ReductionKind::Last => ir::ReductionKind::Last,
            ReductionKind::At(at) => ir::ReductionKind::At(self.formula(at)),
        };
        let of = if reduction.kind == ReductionKind::Rms { self.graph.mul(value, value) } else { value };
        let window = reduction.window.map(|bound| bound.map(|bound| self.formula(bound)));
        ir::Reduction { of, kind, window, span: reduction.span }
    }

    /// Returns the expression of a reduction's number in formulas.
    pub(super) fn reduction_number(&mut self, k: u32) -> ExprId {
        let symbol = self.graph.symbol(Symbol::Named(k));
        if self.model.reductions[k as usize].kind == ReductionKind::Rms {
            return self.graph.unary(Unary::Sqrt, symbol);
        }
        symbol
    }
}
