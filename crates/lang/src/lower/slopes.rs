//! Derivatives of results by the variables of columns: further results, behind all others.
//!
//! With `e_p` the derivative of a formula by `p` at fixed time, `ė` its time derivative, and `T_p` the derivative of a time `T` by `p`,
//!
//! - a value at a time has the derivative `e_p(T) + ė(T) T_p`;
//! - an extremum at its time `T` too; within the analysis `ė(T) = 0` (the envelope theorem), or `T` is a switch that stays. Its time has
//!   the derivative `−ė_p/ë`;
//! - an integral has `∫ e_p dt + e(to) to_p − e(from) from_p` (Leibniz), if `e` does not jump at a switch that moves with `p`;
//! - in a window the bounds replace the ends of the analysis, and may depend on `p` as other results do;
//! - a formula of such numbers is differentiated by the chain rule.

mod requests;
mod validity;

use super::Lowering;
use crate::model::quotient;
use mechc_expr::{Comparison, ExprId, Symbol, Unary};
use mechc_ir::{Outcome, Reduction, ReductionKind, Units};
use rustc_hash::FxHashMap;

/// A formula has the value of an extremum at its time if it differs by at most this part of its range.
const SAME: f64 = 1e-6;
/// A parameter does not affect a formula if doubling it would change the formula by at most this part of its range.
const NOTHING: f64 = 1e-12;

/// The first and the last time of the analysis or of a window.
const ENDS: [ReductionKind; 2] = [ReductionKind::First, ReductionKind::Last];

/// A formula that is reduced.
#[derive(Clone, Copy)]
pub(super) struct Reduced {
    /// The value, also where it is undefined.
    pub value: ExprId,
    /// A formula that is true where the value is defined; `None` if it is everywhere.
    pub holds: Option<ExprId>,
}

/// A formula, as it is reduced, with the kind of its extremum.
#[derive(Clone, Copy)]
pub(super) struct Extremum {
    pub of: ExprId,
    pub largest: bool,
}

/// Derivatives of results by one variable.
pub(super) struct Slopes<'s, 'm> {
    pub lowering: &'s mut Lowering<'m>,
    /// The reductions of the motion; those that derivatives need are appended.
    pub reductions: &'s mut Vec<Reduction>,
    /// The formulas of the reductions in the text.
    pub formulas: &'s [Reduced],
    /// The formulas of the analysis' start and end, if they depend on parameters.
    pub ends: [Option<ExprId>; 2],
    /// The window of the reduction that is being differentiated.
    pub window: [Option<ExprId>; 2],
    /// The number of the variable.
    pub variable: u32,
    /// The derivatives of reductions by their number; `None` if one has no derivative.
    pub cached: &'s mut FxHashMap<u32, Option<ExprId>>,
}

impl Slopes<'_, '_> {
    /// Returns the derivative of a result, which has no value if the derivative is not available.
    pub fn outcome_slope(&mut self, outcome: &Outcome) -> Outcome {
        let value = match self.partial(outcome.value) {
            Some(slope) => self.if_two_sided(outcome.value, slope),
            None => self.no_value(),
        };
        let by =
            self.lowering.variations.as_ref().map(|variations| variations.variables[self.variable as usize].clone());
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

    /// Returns the derivative of a formula by the variable at fixed time, including that of all reductions in it.
    fn partial(&mut self, formula: ExprId) -> Option<ExprId> {
        if !self.lowering.can_be_varied(formula) {
            return None;
        }
        let mut sum = self.lowering.derivative_by(formula, self.variable);
        for symbol in self.lowering.graph.symbols(formula) {
            let Symbol::Named(k) = symbol else { continue };
            let slope = self.reduction_slope(k)?;
            let graph = &mut self.lowering.graph;
            let by = graph.derivatives(&[formula], |graph, of| (of == symbol).then(|| graph.constant(1.0)))[0];
            let part = graph.mul(by, slope);
            sum = graph.add(sum, part);
        }
        Some(sum)
    }

    fn reduction_slope(&mut self, k: u32) -> Option<ExprId> {
        if let Some(cached) = self.cached.get(&k) {
            return *cached;
        }
        let Reduction { kind, window, .. } = self.reductions[k as usize];
        let outer = std::mem::replace(&mut self.window, window);
        let slope = match kind {
            ReductionKind::Extreme { largest, when } => self.extremum_slope(k, largest, when),
            ReductionKind::Mean => self.mean_slope(k),
            ReductionKind::Integral => self.integral_slope(k),
            ReductionKind::First => self.value_slope(k, ReductionKind::First, window[0].or(self.ends[0])),
            ReductionKind::Last => self.value_slope(k, ReductionKind::Last, window[1].or(self.ends[1])),
            ReductionKind::At(at) => self.value_slope(k, ReductionKind::At(at), Some(at)),
        };
        self.window = outer;
        self.cached.insert(k, slope);
        slope
    }

    /// Returns the derivative of a value at a time, which has a formula or does not depend on the variable.
    fn value_slope(&mut self, k: u32, kind: ReductionKind, time: Option<ExprId>) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let by = self.partial(value)?;
        let time_slope = self.time_slope(time)?;
        let switches = self.lowering.moving_kinks(value, self.variable);
        if self.is_zero(time_slope) {
            let slope = self.reduce(kind, by, holds);
            return Some(self.unless_at_switch(kind, &switches, holds, slope));
        }
        let rate = self.lowering.time_derivative(value)?;
        let [by, rate] = [by, rate].map(|formula| self.reduce(kind, formula, holds));
        let moved = self.lowering.graph.mul(rate, time_slope);
        let slope = self.lowering.graph.add(by, moved);
        let switches = [switches, self.switches_at_moving_time(value, time_slope, true)].concat();
        Some(self.unless_at_switch(kind, &switches, holds, slope))
    }

    fn integral_slope(&mut self, k: u32) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let by = self.partial(value)?;
        let inside = self.reduce(ReductionKind::Integral, by, holds);
        let [from, to] = self.end_slopes()?.map(|(kind, time_slope)| {
            let at = self.reduce(kind, value, holds);
            self.lowering.graph.mul(at, time_slope)
        });
        let graph = &mut self.lowering.graph;
        let more = graph.sub(to, from);
        let slope = graph.add(inside, more);
        let slope = self.unless_jump_at_ends(k, slope)?;
        let slope = self.if_defined_throughout(k, slope);
        Some(self.unless_moving_jumps(k, slope))
    }

    fn mean_slope(&mut self, k: u32) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let by = self.partial(value)?;
        let inside = self.reduce(ReductionKind::Mean, by, holds);
        let mean = self.lowering.graph.symbol(Symbol::Named(k));
        let [from, to] = self.end_slopes()?.map(|(kind, time_slope)| {
            let at = self.reduce(kind, value, holds);
            let graph = &mut self.lowering.graph;
            let beyond = graph.sub(at, mean);
            graph.mul(beyond, time_slope)
        });
        let span = self.span();
        let graph = &mut self.lowering.graph;
        let more = graph.sub(to, from);
        let more = graph.div(more, span);
        let slope = graph.add(inside, more);
        let slope = self.unless_jump_at_ends(k, slope)?;
        let slope = self.if_defined_throughout(k, slope);
        Some(self.unless_moving_jumps(k, slope))
    }

    /// Returns the derivative of an extremum, or of its time if `when`. It has none if the extremum is at a kink or jump within the
    /// analysis whose time depends on the variable, as this dependence is not available.
    fn extremum_slope(&mut self, k: u32, largest: bool, when: bool) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let by = self.partial(value)?;
        let rate = self.lowering.time_derivative(value);
        let switches = self.lowering.moving_kinks(value, self.variable);
        let kinks = !switches.is_empty();
        let ends = self.end_slopes()?;
        let stays = ends.iter().all(|(_, time_slope)| self.is_zero(*time_slope));
        if self.is_zero(by) && stays && !kinks {
            return Some(by);
        }
        let of = self.reductions[k as usize].of;
        let time = self.request(ReductionKind::Extreme { largest, when: true }, of);
        let at = ReductionKind::At(time);
        let at_switch = if when { self.switch_time_slope(at, Reduced { value, holds }) } else { self.no_value() };
        let inside = if when {
            self.interior_time_slope(at, of, Reduced { value, holds }, by, at_switch)?
        } else {
            self.reduce(at, by, holds)
        };
        let rate_there = rate.map(|rate| self.reduce(at, rate, holds));
        let mut slope = inside;
        if when || kinks {
            slope = match rate_there {
                Some(rate) => self.select_if_stationary(of, rate, inside, at_switch),
                None if when => return None,
                None => self.if_smooth_at_extremum(Extremum { of, largest }, time, inside),
            };
        }
        for (kind, time_slope) in ends {
            let at_end = if when {
                self.unless_stationary_at_end(of, rate_there?, inside, time_slope)
            } else {
                let still = self.reduce(at, by, holds);
                self.with_moving_time(at, still, rate, holds, time_slope)?
            };
            let all_switches = [switches.clone(), self.switches_at_moving_time(value, time_slope, true)].concat();
            let at_end = self.unless_at_switch(at, &all_switches, holds, at_end);
            let end = self.time(kind);
            let graph = &mut self.lowering.graph;
            let between = if kind == ReductionKind::First { [time, end] } else { [end, time] };
            let is_there = graph.compare(Comparison::LessEqual, between[0], between[1]);
            slope = graph.select(is_there, at_end, slope);
        }
        // A jump at an end of the analysis may move into it.
        let jumping = self.lowering.moving_jumps(value, self.variable);
        let slope = ENDS.into_iter().fold(slope, |slope, end| self.unless_at_switch(end, &jumping, holds, slope));
        let met = self.reduce(at, value, holds);
        let slope = self.if_attained(Extremum { of, largest }, met, slope);
        Some(self.if_unique(Extremum { of, largest }, Reduced { value, holds }, by, &switches, slope))
    }

    /// Returns a derivative at fixed time plus the part of a time that depends on the variable.
    fn with_moving_time(
        &mut self,
        at: ReductionKind,
        still: ExprId,
        rate: Option<ExprId>,
        holds: Option<ExprId>,
        time_slope: ExprId,
    ) -> Option<ExprId> {
        if self.is_zero(time_slope) {
            return Some(still);
        }
        let rate = self.reduce(at, rate?, holds);
        let graph = &mut self.lowering.graph;
        let more = graph.mul(rate, time_slope);
        Some(graph.add(still, more))
    }

    /// Returns `−ė_p/ë`, and `at_switch` where `ë` is zero: a value that rests there does so from a switch on.
    fn interior_time_slope(
        &mut self,
        at: ReductionKind,
        of: ExprId,
        Reduced { value, holds }: Reduced,
        by: ExprId,
        at_switch: ExprId,
    ) -> Option<ExprId> {
        let rate = self.lowering.time_derivative(value)?;
        let second = self.lowering.time_derivative(rate)?;
        let rate_by = self.lowering.time_derivative(by)?;
        let [second, rate_by] = [second, rate_by].map(|formula| self.reduce(at, formula, holds));
        let (range, span) = (self.range(of), self.span());
        let graph = &mut self.lowering.graph;
        let quotient = graph.div(rate_by, second);
        let slope = graph.neg(quotient);
        let (bend, part, square) = (graph.unary(Unary::Abs, second), graph.constant(SAME), graph.mul(span, span));
        let [bend, flat] = [graph.mul(bend, square), graph.mul(part, range)];
        let turns = graph.compare(Comparison::Less, flat, bend);
        Some(graph.select(turns, slope, at_switch))
    }

    /// Returns `−g_p/ġ`, the derivative of the time of a zero of a switching function `g` of a formula. It has no value without such a
    /// zero, or if several zeros differ in their derivatives.
    fn switch_time_slope(&mut self, at: ReductionKind, Reduced { value, holds }: Reduced) -> ExprId {
        let (span, size, undefined) = (self.span(), self.variable_scale(), self.no_value());
        let edges = self.lowering.switching_functions(value, true).into_iter();
        let edges = edges.filter_map(|of| {
            let [by, rate] = [self.partial(of)?, self.lowering.time_derivative(of)?];
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
        let chosen = edges.iter().fold(undefined, |chosen, &(is_there, slope)| graph.select(is_there, slope, chosen));
        edges.iter().fold(chosen, |agreed, &(is_there, slope)| {
            let off = graph.sub(slope, chosen);
            let off = graph.unary(Unary::Abs, off);
            let (off, part) = (graph.mul(off, size), graph.constant(NOTHING));
            let limit = graph.mul(part, span);
            let agrees = graph.compare(Comparison::LessEqual, off, limit);
            let otherwise = graph.select(is_there, undefined, agreed);
            graph.select(agrees, agreed, otherwise)
        })
    }
}
