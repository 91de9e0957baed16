//! What is asked of the motion to tell a slope: each once, whoever asks.

use super::{ENDS, Slopes};
use crate::model::{Dimension, Variable};
use mechc_expr::{ExprId, Symbol, Unary};
use mechc_ir::{Reduction, ReductionKind};

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

    /// The length of the analysis, or of the window.
    pub(super) fn span(&mut self) -> ExprId {
        let [from, to] = ENDS.map(|end| self.time(end));
        self.lowering.graph.sub(to, from)
    }

    /// An end of the analysis, or of the window (s).
    pub(super) fn time(&mut self, end: ReductionKind) -> ExprId {
        let time = self.lowering.graph.symbol(Symbol::Time);
        self.asked(end, time)
    }

    /// The ends of the analysis, or of the window, and how they go with the variable; `None` where that is not known.
    pub(super) fn of_ends(&mut self) -> Option<[(ReductionKind, ExprId); 2]> {
        let times = [0, 1].map(|end| self.window[end].or(self.ends[end]));
        let [from, to] = times.map(|time| self.of_time(time));
        Some([(ENDS[0], from?), (ENDS[1], to?)])
    }

    /// How a time that has a formula of parameters and reductions goes with the variable, if that is known; others stay.
    pub(super) fn of_time(&mut self, time: Option<ExprId>) -> Option<ExprId> {
        match time {
            Some(time) => self.partial(time),
            None => Some(self.lowering.graph.constant(0.0)),
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
        let (kind, window) = self.within_the_window(kind);
        let is_known = |known: &Reduction| known.kind == kind && known.of == of && known.window == window;
        let known = self.reductions.iter().position(is_known);
        let k = known.unwrap_or_else(|| {
            let span = self.reductions[0].span;
            self.reductions.push(Reduction { of, kind, window, span });
            self.reductions.len() - 1
        });
        self.lowering.graph.symbol(Symbol::Named(k as u32))
    }

    /// What is asked of the window, rather than of the analysis.
    fn within_the_window(&self, kind: ReductionKind) -> (ReductionKind, [Option<ExprId>; 2]) {
        let [from, to] = self.window;
        let at = |time: ExprId| (ReductionKind::At(time), [None; 2]);
        match kind {
            ReductionKind::First => from.map_or((kind, [None; 2]), at),
            ReductionKind::Last => to.map_or((kind, [None; 2]), at),
            ReductionKind::At(_) => (kind, [None; 2]),
            ReductionKind::Extreme { .. } | ReductionKind::Mean | ReductionKind::Integral => (kind, self.window),
        }
    }

    pub(super) fn is_zero(&self, formula: ExprId) -> bool {
        self.lowering.graph.is_zero(formula)
    }

    pub(super) fn no_value(&mut self) -> ExprId {
        self.lowering.no_value()
    }
}
