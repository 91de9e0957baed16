//! What results ask of the motion. It is lowered last, so that the equations are the same whatever is asked.

use super::{Lowering, units};
use crate::expr::{ExprId, Symbol, Unary};
use crate::ir::{self, Outcome, Results};
use crate::model::ReductionKind;

impl Lowering<'_> {
    pub(super) fn results(&mut self) -> Results {
        let model = self.model;
        self.named_up_to(model.named.len());
        let reductions: Vec<ir::Reduction> =
            model.reductions.iter().map(|reduction| self.reduction(reduction)).collect();
        let outcomes = model.outcomes.iter().map(|outcome| Outcome {
            name: outcome.declared.name.clone(),
            span: outcome.declared.span,
            value: self.formula(outcome.value),
            units: units(&outcome.units),
        });
        let outcomes = outcomes.collect();
        let holds_variations = reductions.iter().any(|reduction| self.graph.dependence(reduction.of).is_varied());
        let variations = self.variations.take().filter(|_| holds_variations).map(Box::new);
        Results { reductions, outcomes, variations, varied_where: Vec::new() }
    }

    fn reduction(&mut self, reduction: &crate::model::Reduction) -> ir::Reduction {
        let value = self.formula(reduction.of);
        let holds = self.all_hold(&reduction.conditions);
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
        ir::Reduction { of, kind, span: reduction.span }
    }

    /// What stands for a reduction in formulas.
    pub(super) fn reduced(&mut self, k: u32) -> ExprId {
        let symbol = self.graph.symbol(Symbol::Named(k));
        if self.model.reductions[k as usize].kind == ReductionKind::Rms {
            return self.graph.unary(Unary::Sqrt, symbol);
        }
        symbol
    }
}
