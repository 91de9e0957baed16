//! What is asked of the motion to tell a slope: each once, whoever asks.

use super::{ENDS, Slopes};
use crate::expr::{ExprId, Symbol, Unary};
use crate::ir::{Reduction, ReductionKind};
use crate::model::{Dimension, Variable};

impl Slopes<'_, '_> {
    /// How large the variable is, or usually is.
    pub(super) fn size_of_the_variable(&mut self) -> ExprId {
        let Variable { symbol, dimension, .. } = self.lowering.model.variables[self.variable as usize];
        let largest_size = self.lowering.largest_size;
        let own = match symbol {
            Symbol::Param(_) => self.lowering.graph.symbol(symbol),
            _ => self.lowering.graph.constant(0.0),
        };
        let usual = if dimension == Dimension::TIME {
            self.span()
        } else if dimension == Dimension::RATE {
            let (span, one) = (self.span(), self.lowering.graph.constant(1.0));
            self.lowering.graph.div(one, span)
        } else {
            let usual = [(Dimension::LENGTH, largest_size), (Dimension::PURE, 1.0)];
            let usual = usual.into_iter().find(|(of, _)| *of == dimension).map_or(0.0, |(_, size)| size);
            self.lowering.graph.constant(usual)
        };
        let graph = &mut self.lowering.graph;
        let own = graph.unary(Unary::Abs, own);
        graph.add(own, usual)
    }

    /// The largest value less the least.
    pub(super) fn range(&mut self, of: ExprId) -> ExprId {
        let [low, high] = self.extremes(of);
        self.lowering.graph.sub(high, low)
    }

    /// The least and the largest value.
    pub(super) fn extremes(&mut self, of: ExprId) -> [ExprId; 2] {
        [false, true].map(|largest| self.asked(ReductionKind::Extreme { largest, when: false }, of))
    }

    /// The time of the analysis.
    pub(super) fn span(&mut self) -> ExprId {
        let [from, to] = ENDS.map(|end| self.time(end));
        self.lowering.graph.sub(to, from)
    }

    pub(super) fn time(&mut self, end: ReductionKind) -> ExprId {
        let time = self.lowering.graph.symbol(Symbol::Time);
        self.asked(end, time)
    }

    /// The ends of the analysis, and how they go with the variable.
    pub(super) fn of_ends(&mut self) -> [(ReductionKind, ExprId); 2] {
        [0, 1].map(|end| (ENDS[end], self.of_time(self.ends[end])))
    }

    /// How a time that has a formula of parameters goes with the variable; others stay.
    pub(super) fn of_time(&mut self, time: Option<ExprId>) -> ExprId {
        match time {
            Some(time) => self.lowering.derivative_by(time, self.variable),
            None => self.lowering.graph.constant(0.0),
        }
    }

    /// What is asked of a formula where it holds.
    pub(super) fn reduce(&mut self, kind: ReductionKind, formula: ExprId, holds: Option<ExprId>) -> ExprId {
        if self.is_zero(formula) {
            return formula;
        }
        let of = self.lowering.only_where(holds, formula);
        self.asked(kind, of)
    }

    /// The symbol of what is asked, once.
    pub(super) fn asked(&mut self, kind: ReductionKind, of: ExprId) -> ExprId {
        let known = self.reductions.iter().position(|known| known.kind == kind && known.of == of);
        let k = known.unwrap_or_else(|| {
            let span = self.reductions[0].span;
            self.reductions.push(Reduction { of, kind, span });
            self.reductions.len() - 1
        });
        self.lowering.graph.symbol(Symbol::Named(k as u32))
    }

    pub(super) fn is_zero(&self, formula: ExprId) -> bool {
        self.lowering.graph.is_zero(formula)
    }

    pub(super) fn no_value(&mut self) -> ExprId {
        self.lowering.no_value()
    }
}
