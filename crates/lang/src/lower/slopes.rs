//! Derivatives of results by what a mechanism is differentiated by: further results, behind all others.
//!
//! With `e_p` the derivative of a formula by `p` at fixed time, `ė` that by time, and `T_p` how a time goes with `p`,
//!
//! - a value is differentiated to `e_p(T) + ė(T) T_p`;
//! - an extremum at its time `T` likewise, and within the analysis `ė(T) = 0` (the envelope theorem), or `T` is an edge that stays; its time
//!   goes with `−ė_p/ë`;
//! - an integral to `∫ e_p dt + e(to) to_p − e(from) from_p` (Leibniz), where `e` does not jump at an edge that goes with `p`;
//! - over a window likewise: its bounds stand in the place of the ends of the analysis, and may go with `p` as other results do;
//! - a formula of such numbers by the chain rule.

mod asked;
mod doubts;

use super::Lowering;
use crate::model::quotient;
use mechc_expr::{Comparison, ExprId, Symbol, Unary};
use mechc_ir::tolerances::results::slopes::{NOTHING, SAME};
use mechc_ir::{Outcome, Reduction, ReductionKind, Units};
use rustc_hash::FxHashMap;

/// The first and the last time of the analysis, or of a window.
const ENDS: [ReductionKind; 2] = [ReductionKind::First, ReductionKind::Last];

/// A formula that is reduced.
#[derive(Clone, Copy)]
pub(super) struct Reduced {
    /// Its value, be there one or not.
    pub value: ExprId,
    /// Where there is one; everywhere if this is nothing.
    pub holds: Option<ExprId>,
}

/// Of one variable.
pub(super) struct Slopes<'s, 'm> {
    pub lowering: &'s mut Lowering<'m>,
    /// All that is asked of the motion, to which more is added.
    pub reductions: &'s mut Vec<Reduction>,
    /// The formulas of those that the text asks for.
    pub formulas: &'s [Reduced],
    /// The formulas of those ends of the analysis that go with parameters.
    pub ends: [Option<ExprId>; 2],
    /// The window of the reduction that is being differentiated.
    pub window: [Option<ExprId>; 2],
    /// By what is differentiated.
    pub variable: u32,
    /// By reduction: its derivative, or nothing where none is known.
    pub known: &'s mut FxHashMap<u32, Option<ExprId>>,
}

impl Slopes<'_, '_> {
    /// The derivative of a result, which has no value where no derivative is known.
    pub fn of_outcome(&mut self, outcome: &Outcome) -> Outcome {
        let value = match self.partial(outcome.value) {
            Some(slope) => self.where_it_goes_on(outcome.value, slope),
            None => self.no_value(),
        };
        let by = self.lowering.variations.as_ref().map(|known| known.variables[self.variable as usize].clone());
        let (by, unit) = by.map(|by| (by.name, by.unit)).unwrap_or_default();
        let Units { si, printed, scale } = &outcome.units;
        let units =
            Units { si: quotient(si, &unit), printed: printed.clone().map(|of| quotient(&of, &unit)), scale: *scale };
        Outcome {
            name: format!("der({}, {by})", outcome.name),
            span: outcome.span,
            value,
            units,
            unknown_is_false: true,
        }
    }

    /// How a formula changes with the variable at fixed time, through all reductions in it too.
    fn partial(&mut self, formula: ExprId) -> Option<ExprId> {
        if !self.lowering.can_be_varied(formula) {
            return None;
        }
        let mut sum = self.lowering.derivative_by(formula, self.variable);
        for symbol in self.lowering.graph.symbols(formula) {
            let Symbol::Named(k) = symbol else { continue };
            let slope = self.of_reduction(k)?;
            let graph = &mut self.lowering.graph;
            let by = graph.derivatives(&[formula], |graph, of| (of == symbol).then(|| graph.constant(1.0)))[0];
            let part = graph.mul(by, slope);
            sum = graph.add(sum, part);
        }
        Some(sum)
    }

    fn of_reduction(&mut self, k: u32) -> Option<ExprId> {
        if let Some(known) = self.known.get(&k) {
            return *known;
        }
        let Reduction { kind, window, .. } = self.reductions[k as usize];
        let outer = std::mem::replace(&mut self.window, window);
        let found = match kind {
            ReductionKind::Extreme { largest, when } => self.of_extreme(k, largest, when),
            ReductionKind::Mean => self.of_mean(k),
            ReductionKind::Integral => self.of_integral(k),
            ReductionKind::First => self.of_value(k, ReductionKind::First, window[0].or(self.ends[0])),
            ReductionKind::Last => self.of_value(k, ReductionKind::Last, window[1].or(self.ends[1])),
            ReductionKind::At(at) => self.of_value(k, ReductionKind::At(at), Some(at)),
        };
        self.window = outer;
        self.known.insert(k, found);
        found
    }

    /// Of a value at a time that has a formula, or stays.
    fn of_value(&mut self, k: u32, kind: ReductionKind, time: Option<ExprId>) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let by = self.partial(value)?;
        let goes = self.of_time(time)?;
        let going = self.lowering.bending_elsewhere(value, self.variable);
        if self.is_zero(goes) {
            let slope = self.reduce(kind, by, holds);
            return Some(self.where_clear(kind, (&going, holds), slope));
        }
        let rate = self.lowering.along_the_motion(value)?;
        let [by, rate] = [by, rate].map(|formula| self.reduce(kind, formula, holds));
        let moved = self.lowering.graph.mul(rate, goes);
        let slope = self.lowering.graph.add(by, moved);
        let going = [going, self.edges_in_the_way(value, goes, true)].concat();
        Some(self.where_clear(kind, (&going, holds), slope))
    }

    fn of_integral(&mut self, k: u32) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let by = self.partial(value)?;
        let inside = self.reduce(ReductionKind::Integral, by, holds);
        let [from, to] = self.of_ends()?.map(|(kind, goes)| {
            let at = self.reduce(kind, value, holds);
            self.lowering.graph.mul(at, goes)
        });
        let graph = &mut self.lowering.graph;
        let more = graph.sub(to, from);
        let slope = graph.add(inside, more);
        let slope = self.where_its_ends_are_clear(k, slope)?;
        let slope = self.where_it_is_all_over(k, slope);
        Some(self.where_it_does_not_jump(k, slope))
    }

    fn of_mean(&mut self, k: u32) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let by = self.partial(value)?;
        let inside = self.reduce(ReductionKind::Mean, by, holds);
        let mean = self.lowering.graph.symbol(Symbol::Named(k));
        let [from, to] = self.of_ends()?.map(|(kind, goes)| {
            let at = self.reduce(kind, value, holds);
            let graph = &mut self.lowering.graph;
            let beyond = graph.sub(at, mean);
            graph.mul(beyond, goes)
        });
        let span = self.span();
        let graph = &mut self.lowering.graph;
        let more = graph.sub(to, from);
        let more = graph.div(more, span);
        let slope = graph.add(inside, more);
        let slope = self.where_its_ends_are_clear(k, slope)?;
        let slope = self.where_it_is_all_over(k, slope);
        Some(self.where_it_does_not_jump(k, slope))
    }

    /// Of the largest or least value, or of its time. It has none where the extremum is at a kink or jump within the analysis whose time goes with
    /// the variable, as nobody knows how.
    fn of_extreme(&mut self, k: u32, largest: bool, when: bool) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let by = self.partial(value)?;
        let rate = self.lowering.along_the_motion(value);
        let going = self.lowering.bending_elsewhere(value, self.variable);
        let bends = !going.is_empty();
        let ends = self.of_ends()?;
        let stays = ends.iter().all(|(_, goes)| self.is_zero(*goes));
        if self.is_zero(by) && stays && !bends {
            return Some(by);
        }
        let of = self.reductions[k as usize].of;
        let time = self.asked(ReductionKind::Extreme { largest, when: true }, of);
        let at = ReductionKind::At(time);
        let at_edge = if when { self.of_edge(at, (value, holds)) } else { self.no_value() };
        let inside =
            if when { self.of_time_within((at, of), (value, holds), by, at_edge)? } else { self.reduce(at, by, holds) };
        let rate_there = rate.map(|rate| self.reduce(at, rate, holds));
        let mut slope = inside;
        if when || bends {
            slope = match rate_there {
                Some(rate) => self.where_flat((of, rate), inside, at_edge),
                None if when => return None,
                None => self.where_rounded((of, largest), time, inside),
            };
        }
        for (kind, goes) in ends {
            let at_end = if when {
                self.where_it_ends((of, rate_there?), inside, goes)
            } else {
                let still = self.reduce(at, by, holds);
                self.moved((at, still), (rate, holds), goes)?
            };
            let edges = [going.clone(), self.edges_in_the_way(value, goes, true)].concat();
            let at_end = self.where_clear(at, (&edges, holds), at_end);
            let end = self.time(kind);
            let graph = &mut self.lowering.graph;
            let between = if kind == ReductionKind::First { [time, end] } else { [end, time] };
            let is_there = graph.compare(Comparison::LessEqual, between[0], between[1]);
            slope = graph.select(is_there, at_end, slope);
        }
        // a jump that is at an end may come in
        let jumping = self.lowering.jumping_elsewhere(value, self.variable);
        let slope = ENDS.into_iter().fold(slope, |slope, end| self.where_clear(end, (&jumping, holds), slope));
        let met = self.reduce(at, value, holds);
        let slope = self.where_it_is_met((of, largest), met, slope);
        Some(self.where_alone((of, largest), (value, holds), (by, &going), slope))
    }

    /// What changes at fixed time, and with a time that goes.
    fn moved(
        &mut self,
        (at, still): (ReductionKind, ExprId),
        (rate, holds): (Option<ExprId>, Option<ExprId>),
        goes: ExprId,
    ) -> Option<ExprId> {
        if self.is_zero(goes) {
            return Some(still);
        }
        let rate = self.reduce(at, rate?, holds);
        let graph = &mut self.lowering.graph;
        let more = graph.mul(rate, goes);
        Some(graph.add(still, more))
    }

    /// `−ė_p/ë`, and something else where `ë` is nothing: what rests there has begun to do so at an edge.
    fn of_time_within(
        &mut self,
        (at, of): (ReductionKind, ExprId),
        (value, holds): (ExprId, Option<ExprId>),
        by: ExprId,
        at_edge: ExprId,
    ) -> Option<ExprId> {
        let rate = self.lowering.along_the_motion(value)?;
        let second = self.lowering.along_the_motion(rate)?;
        let rate_by = self.lowering.along_the_motion(by)?;
        let [second, rate_by] = [second, rate_by].map(|formula| self.reduce(at, formula, holds));
        let (range, span) = (self.range(of), self.span());
        let graph = &mut self.lowering.graph;
        let quotient = graph.div(rate_by, second);
        let slope = graph.neg(quotient);
        let (bend, part, square) = (graph.unary(Unary::Abs, second), graph.constant(SAME), graph.mul(span, span));
        let [bend, flat] = [graph.mul(bend, square), graph.mul(part, range)];
        let turns = graph.compare(Comparison::Less, flat, bend);
        Some(graph.select(turns, slope, at_edge))
    }

    /// `−g_p/ġ`: the slope of the time of the edge `g = 0` of a formula that is at a time. There is none where no edge is, or several that go
    /// differently.
    fn of_edge(&mut self, at: ReductionKind, (value, holds): (ExprId, Option<ExprId>)) -> ExprId {
        let (span, size, nothing) = (self.span(), self.size_of_the_variable(), self.no_value());
        let edges = self.lowering.edges_of(value, true).into_iter();
        let edges = edges.filter_map(|of| {
            let [by, rate] = [self.partial(of)?, self.lowering.along_the_motion(of)?];
            let [of, by, rate] = [of, by, rate].map(|formula| self.reduce(at, formula, holds));
            let graph = &mut self.lowering.graph;
            let [off, steep] = [of, rate].map(|of| graph.unary(Unary::Abs, of));
            let (part, quotient) = (graph.constant(NOTHING), graph.div(by, rate));
            let reach = graph.mul(steep, span);
            let reach = graph.mul(part, reach);
            Some((graph.compare(Comparison::LessEqual, off, reach), graph.neg(quotient)))
        });
        let edges: Vec<(ExprId, ExprId)> = edges.collect();
        let graph = &mut self.lowering.graph;
        let found = edges.iter().fold(nothing, |found, &(is_there, slope)| graph.select(is_there, slope, found));
        edges.iter().fold(found, |found_there, &(is_there, slope)| {
            let off = graph.sub(slope, found);
            let off = graph.unary(Unary::Abs, off);
            let (off, part) = (graph.mul(off, size), graph.constant(NOTHING));
            let limit = graph.mul(part, span);
            let agrees = graph.compare(Comparison::LessEqual, off, limit);
            let otherwise = graph.select(is_there, nothing, found_there);
            graph.select(agrees, found_there, otherwise)
        })
    }
}
