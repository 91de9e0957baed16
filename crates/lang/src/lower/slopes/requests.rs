//! The reductions that derivatives need. Each is requested once.

use super::{ENDS, Slopes};
use crate::model::{Dimension, Variable};
use mechc_expr::{ExprId, Symbol, Unary};
use mechc_ir::{Reduction, ReductionKind};

impl Slopes<'_, '_> {
    /// Returns the magnitude of the variable plus its usual magnitude.
    pub(super) fn variable_scale(&mut self) -> ExprId {
        let Variable { symbol, dimension, .. } = self.lowering.model.variables[self.variable as usize];
        let largest_size = self.lowering.largest_size;
        let magnitude = match symbol {
            Symbol::Param(_) => self.lowering.graph.symbol(symbol),
            _ => self.lowering.graph.constant(0.0),
        };
        let usual = if dimension.is(Dimension::TIME) {
            self.span()
        } else if dimension.is(Dimension::RATE) {
            let (span, one) = (self.span(), self.lowering.graph.constant(1.0));
            self.lowering.graph.div(one, span)
        } else {
            let usual = [(Dimension::LENGTH, largest_size), (Dimension::PURE, 1.0)];
            let usual = usual.into_iter().find(|(of, _)| of.is(dimension)).map_or(0.0, |(_, size)| size);
            self.lowering.graph.constant(usual)
        };
        let graph = &mut self.lowering.graph;
        let magnitude = graph.unary(Unary::Abs, magnitude);
        graph.add(magnitude, usual)
    }

    /// Returns the largest value minus the least.
    pub(super) fn range(&mut self, of: ExprId) -> ExprId {
        let [low, high] = self.extremes(of);
        self.lowering.graph.sub(high, low)
    }

    /// Returns the least and the largest value.
    pub(super) fn extremes(&mut self, of: ExprId) -> [ExprId; 2] {
        [false, true].map(|largest| self.request(ReductionKind::Extreme { largest, when: false }, of))
    }

    /// Returns the duration of the analysis or of the window (s).
    pub(super) fn span(&mut self) -> ExprId {
        let [from, to] = ENDS.map(|end| self.time(end));
        self.lowering.graph.sub(to, from)
    }

    /// Returns the start or end of the analysis or of the window (s).
    pub(super) fn time(&mut self, end: ReductionKind) -> ExprId {
        let time = self.lowering.graph.symbol(Symbol::Time);
        self.request(end, time)
    }

    /// Returns the ends of the analysis or of the window with their derivatives by the variable; `None` if these are not available.
    pub(super) fn end_slopes(&mut self) -> Option<[(ReductionKind, ExprId); 2]> {
        let times = [0, 1].map(|end| self.window[end].or(self.ends[end]));
        let [from, to] = times.map(|time| self.time_slope(time));
        Some([(ENDS[0], from?), (ENDS[1], to?)])
    }

    /// Returns the derivative by the variable of a time with a formula of parameters and reductions; zero without a formula.
    pub(super) fn time_slope(&mut self, time: Option<ExprId>) -> Option<ExprId> {
        match time {
            Some(time) => self.partial(time),
            None => Some(self.lowering.graph.constant(0.0)),
        }
    }

    /// Requests a reduction of a formula where it is defined.
    pub(super) fn reduce(&mut self, kind: ReductionKind, formula: ExprId, holds: Option<ExprId>) -> ExprId {
        if self.is_zero(formula) {
            return formula;
        }
        let of = self.lowering.only_where(holds, formula);
        self.request(kind, of)
    }

    /// Returns the symbol of a reduction, and requests the reduction if it is new.
    pub(super) fn request(&mut self, kind: ReductionKind, of: ExprId) -> ExprId {
        let (kind, window) = self.restrict_to_window(kind);
        let is_requested = |other: &Reduction| other.kind == kind && other.of == of && other.window == window;
        let requested = self.reductions.iter().position(is_requested);
        let k = requested.unwrap_or_else(|| {
            let span = self.reductions[0].span;
            self.reductions.push(Reduction { of, kind, window, span });
            self.reductions.len() - 1
        });
        self.lowering.graph.symbol(Symbol::Named(k as u32))
    }

    /// Returns the kind and window of a reduction that replace one over the window in place of the analysis.
    fn restrict_to_window(&self, kind: ReductionKind) -> (ReductionKind, [Option<ExprId>; 2]) {
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
