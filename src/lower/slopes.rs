//! Derivatives of results by what a mechanism is differentiated by: further results, behind all others.
//!
//! With `e_p` the derivative of a formula by `p` at fixed time, `ė` that by time, and `T_p` how a time goes with `p`,
//!
//! - a value is differentiated to `e_p(T) + ė(T) T_p`;
//! - an extremum at its time `T` likewise, and within the analysis `ė(T) = 0` (the envelope theorem), or `T` is an edge that stays; its time
//!   goes with `−ė_p/ë`;
//! - an integral to `∫ e_p dt + e(to) to_p − e(from) from_p` (Leibniz), where `e` does not jump at an edge that goes with `p`;
//! - a formula of such numbers by the chain rule.

use super::Lowering;
use super::edges::Going;
use crate::expr::{Binary, Comparison, ExprId, Graph, Symbol, Unary};
use crate::ir::{Outcome, Reduction, ReductionKind, Units};
use crate::model::{Dimension, Variable, quotient};
use crate::tolerances::results::slopes::{
    ALONE, BESIDE, DIGITS, FLAT, LAST_DIGITS, LEAST_STEP, LEFT_OF_HALF, MOVED, NOTHING, SAME,
};
use rustc_hash::FxHashMap;

/// The first and the last time of the analysis.
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

    /// A slope of a formula of results where it is that to both sides. A small step to one side and to the other end off the straight line through
    /// where it is, by so much that half the step leaves a quarter of it; at a kink it leaves half, at a jump all.
    fn where_it_goes_on(&mut self, formula: ExprId, slope: ExprId) -> ExprId {
        let moved = self.moved_by_the_variable(formula);
        if moved.is_empty() || !self.lowering.may_break_by_results(formula) {
            return slope;
        }
        let size = self.size_of_the_variable();
        let [whole, half] = [MOVED, 0.5 * MOVED].map(|part| {
            let graph = &mut self.lowering.graph;
            let part = graph.constant(part);
            let step = graph.mul(part, size);
            self.off_the_line((formula, &moved), step)
        });
        let graph = &mut self.lowering.graph;
        let [part, alone, digits] = [LEFT_OF_HALF, ALONE * MOVED, LAST_DIGITS].map(|part| graph.constant(part));
        let left = graph.mul(part, whole);
        let is_smooth = graph.compare(Comparison::LessEqual, half, left);
        // a kink that counts for nothing is none, nor is what rounding makes
        let change = graph.unary(Unary::Abs, slope);
        let change = graph.mul(change, size);
        let value = graph.unary(Unary::Abs, formula);
        let value = graph.add(value, change);
        let [alone, digits] = [graph.mul(alone, change), graph.mul(digits, value)];
        let limit = graph.add(alone, digits);
        let is_straight = graph.compare(Comparison::LessEqual, whole, limit);
        let nothing = self.no_value();
        let graph = &mut self.lowering.graph;
        let curved = graph.select(is_smooth, slope, nothing);
        graph.select(is_straight, slope, curved)
    }

    /// What a formula of results is made of that goes with the variable, and how.
    fn moved_by_the_variable(&mut self, formula: ExprId) -> Vec<(Symbol, ExprId)> {
        let own = self.lowering.model.variables[self.variable as usize].symbol;
        let mut moved = Vec::new();
        for symbol in self.lowering.graph.symbols(formula) {
            let slope = match symbol {
                Symbol::Named(k) => self.known.get(&k).copied().flatten(),
                _ => (symbol == own).then(|| self.lowering.graph.constant(1.0)),
            };
            moved.extend(slope.filter(|slope| !self.is_zero(*slope)).map(|slope| (symbol, slope)));
        }
        moved
    }

    /// `|f(p + h) + f(p − h) − 2 f(p)|` of a formula of results, which go with `p` as their slopes say.
    fn off_the_line(&mut self, of: (ExprId, &[(Symbol, ExprId)]), step: ExprId) -> ExprId {
        let (formula, graph) = (of.0, &mut self.lowering.graph);
        let back = graph.neg(step);
        let [there, here] = [step, back].map(|step| stepped(graph, of, step));
        let (sum, twice) = (graph.add(there, here), graph.add(formula, formula));
        let off = graph.sub(sum, twice);
        graph.unary(Unary::Abs, off)
    }

    fn of_reduction(&mut self, k: u32) -> Option<ExprId> {
        if let Some(known) = self.known.get(&k) {
            return *known;
        }
        let found = match self.reductions[k as usize].kind {
            ReductionKind::Extreme { largest, when } => self.of_extreme(k, largest, when),
            ReductionKind::Mean => self.of_mean(k),
            ReductionKind::Integral => self.of_integral(k),
            ReductionKind::First => self.of_value(k, ReductionKind::First, self.ends[0]),
            ReductionKind::Last => self.of_value(k, ReductionKind::Last, self.ends[1]),
            ReductionKind::At(at) => self.of_value(k, ReductionKind::At(at), Some(at)),
        };
        self.known.insert(k, found);
        found
    }

    /// Of a value at a time that has a formula, or stays.
    fn of_value(&mut self, k: u32, kind: ReductionKind, time: Option<ExprId>) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let by = self.partial(value)?;
        let goes = self.of_time(time);
        let going = self.lowering.bending_elsewhere(value, self.variable);
        if self.is_zero(goes) {
            let slope = self.reduce(kind, by, holds);
            return Some(self.where_clear(kind, (&going, holds), slope));
        }
        let rate = self.lowering.along_the_motion(value)?;
        let [by, rate] = [by, rate].map(|formula| self.reduce(kind, formula, holds));
        let moved = self.lowering.graph.mul(rate, goes);
        let slope = self.lowering.graph.add(by, moved);
        Some(self.where_clear(kind, (&going, holds), slope))
    }

    /// A slope where no edge is that goes with the variable: at one there is a slope to either side, if any.
    fn where_clear(
        &mut self,
        kind: ReductionKind,
        (going, holds): (&[Going], Option<ExprId>),
        slope: ExprId,
    ) -> ExprId {
        if going.is_empty() {
            return slope;
        }
        let size = self.size_of_the_variable();
        let nothing = self.no_value();
        going.iter().fold(slope, |slope, &Going { of, by }| {
            let [of, by] = [of, by].map(|formula| self.reduce(kind, formula, holds));
            let graph = &mut self.lowering.graph;
            let [off, goes] = [of, by].map(|of| graph.unary(Unary::Abs, of));
            let part = graph.constant(SAME);
            let reach = graph.mul(part, size);
            let reached = graph.mul(goes, reach);
            let is_clear = graph.compare(Comparison::LessEqual, reached, off);
            graph.select(is_clear, slope, nothing)
        })
    }

    fn of_integral(&mut self, k: u32) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let by = self.partial(value)?;
        let inside = self.reduce(ReductionKind::Integral, by, holds);
        let [from, to] = self.of_ends().map(|(kind, goes)| {
            let at = self.reduce(kind, value, holds);
            self.lowering.graph.mul(at, goes)
        });
        let graph = &mut self.lowering.graph;
        let more = graph.sub(to, from);
        let slope = graph.add(inside, more);
        Some(self.where_it_does_not_jump(k, slope))
    }

    fn of_mean(&mut self, k: u32) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let by = self.partial(value)?;
        let inside = self.reduce(ReductionKind::Mean, by, holds);
        let mean = self.lowering.graph.symbol(Symbol::Named(k));
        let [from, to] = self.of_ends().map(|(kind, goes)| {
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
        Some(self.where_it_does_not_jump(k, slope))
    }

    /// A slope of an integral, which a jump of its formula adds to where its time goes with the variable, as nobody knows how. With a weight `w`
    /// that no two times have, `∫ d(w e)/dt dt` lacks the jumps of `w e` from end to end.
    fn where_it_does_not_jump(&mut self, k: u32, slope: ExprId) -> ExprId {
        let Reduced { value, holds } = self.formulas[k as usize];
        let going = self.lowering.jumping_elsewhere(value, self.variable);
        if going.is_empty() {
            return slope;
        }
        let (of, weight) = (self.reductions[k as usize].of, self.weight());
        let weighed = self.lowering.graph.mul(weight, value);
        let Some(rate) = self.lowering.along_the_motion(weighed) else {
            let (rests, nothing) = (self.rests(&going), self.no_value());
            return self.lowering.graph.select(rests, slope, nothing);
        };
        let inside = self.reduce(ReductionKind::Integral, rate, holds);
        let [from, to] = ENDS.map(|end| self.reduce(end, weighed, holds));
        let graph = &mut self.lowering.graph;
        let whole = graph.sub(to, from);
        let jumps = graph.sub(whole, inside);
        self.where_as_near(of, jumps, slope)
    }

    /// `exp((t − from)/(to − from))`
    fn weight(&mut self) -> ExprId {
        let (from, span) = (self.time(ENDS[0]), self.span());
        let graph = &mut self.lowering.graph;
        let time = graph.symbol(Symbol::Time);
        let gone = graph.sub(time, from);
        let part = graph.div(gone, span);
        graph.unary(Unary::Exp, part)
    }

    /// Of the largest or least value, or of its time. It has none where the extremum is at a kink or jump within the analysis whose time goes with
    /// the variable, as nobody knows how.
    fn of_extreme(&mut self, k: u32, largest: bool, when: bool) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let by = self.partial(value)?;
        let rate = self.lowering.along_the_motion(value);
        let going = self.lowering.bending_elsewhere(value, self.variable);
        let bends = !going.is_empty();
        let ends = self.of_ends();
        let stays = ends.iter().all(|(_, goes)| self.is_zero(*goes));
        if self.is_zero(by) && stays && !bends {
            return Some(by);
        }
        let of = self.reductions[k as usize].of;
        let time = self.asked(ReductionKind::Extreme { largest, when: true }, of);
        let at = ReductionKind::At(time);
        let inside = if when { self.of_time_within(at, (value, holds), by)? } else { self.reduce(at, by, holds) };
        let rate_there = rate.map(|rate| self.reduce(at, rate, holds));
        let mut slope = inside;
        if when || bends {
            slope = match rate_there {
                Some(rate) => self.where_flat((of, rate), inside),
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
            let at_end = self.where_clear(at, (&going, holds), at_end);
            let end = self.time(kind);
            let graph = &mut self.lowering.graph;
            let between = if kind == ReductionKind::First { [time, end] } else { [end, time] };
            let is_there = graph.compare(Comparison::LessEqual, between[0], between[1]);
            slope = graph.select(is_there, at_end, slope);
        }
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

    /// `−ė_p/ë`
    fn of_time_within(
        &mut self,
        at: ReductionKind,
        (value, holds): (ExprId, Option<ExprId>),
        by: ExprId,
    ) -> Option<ExprId> {
        let rate = self.lowering.along_the_motion(value)?;
        let second = self.lowering.along_the_motion(rate)?;
        let rate_by = self.lowering.along_the_motion(by)?;
        let [second, rate_by] = [second, rate_by].map(|formula| self.reduce(at, formula, holds));
        let nothing = self.no_value();
        let graph = &mut self.lowering.graph;
        let quotient = graph.div(rate_by, second);
        let slope = graph.neg(quotient);
        // what rests there has begun to do so at an edge
        let (bend, zero) = (graph.unary(Unary::Abs, second), graph.constant(0.0));
        let turns = graph.compare(Comparison::Less, zero, bend);
        Some(graph.select(turns, slope, nothing))
    }

    /// The slope of the time of an extremum that is at an end of the analysis: a turn that is there just now goes to one side on within the
    /// analysis, to the other it leaves the extremum at the end.
    fn where_it_ends(&mut self, (of, rate): (ExprId, ExprId), within: ExprId, goes: ExprId) -> ExprId {
        let (range, span, size) = (self.range(of), self.span(), self.size_of_the_variable());
        let nothing = self.no_value();
        let graph = &mut self.lowering.graph;
        let (part, digits) = (graph.constant(SAME), graph.constant(NOTHING));
        let steep = graph.unary(Unary::Abs, rate);
        let [steep, flat, short] = [graph.mul(steep, span), graph.mul(part, range), graph.mul(digits, span)];
        let is_steep = graph.compare(Comparison::Less, flat, steep);
        let way = graph.unary(Unary::Abs, within);
        let way = graph.mul(way, size);
        let stays = graph.compare(Comparison::LessEqual, way, short);
        let stands = graph.or(is_steep, stays);
        graph.select(stands, goes, nothing)
    }

    /// A slope where the formula does not change with time.
    fn where_flat(&mut self, (of, rate): (ExprId, ExprId), slope: ExprId) -> ExprId {
        let (range, span) = (self.range(of), self.span());
        let graph = &mut self.lowering.graph;
        let (steep, part) = (graph.unary(Unary::Abs, rate), graph.constant(FLAT));
        let [steep, range] = [graph.mul(steep, span), graph.mul(part, range)];
        let is_flat = graph.compare(Comparison::LessEqual, steep, range);
        let nothing = self.no_value();
        self.lowering.graph.select(is_flat, slope, nothing)
    }

    /// The same of what has no rate: beside the time of its extremum a formula that is flat there is off it by a quarter at half the distance; at a
    /// kink by half, at a jump by all.
    fn where_rounded(&mut self, (of, largest): (ExprId, bool), time: ExprId, slope: ExprId) -> ExprId {
        let found = self.asked(ReductionKind::Extreme { largest, when: false }, of);
        let (range, span, [from, to]) = (self.range(of), self.span(), ENDS.map(|end| self.time(end)));
        let off = [BESIDE, 0.5 * BESIDE, -BESIDE, -0.5 * BESIDE].map(|part| {
            let graph = &mut self.lowering.graph;
            let part = graph.constant(part);
            let way = graph.mul(part, span);
            let there = graph.add(time, way);
            let there = graph.binary(Binary::Max, there, from);
            let there = graph.binary(Binary::Min, there, to);
            let value = self.asked(ReductionKind::At(there), of);
            let graph = &mut self.lowering.graph;
            let off = graph.sub(value, found);
            graph.unary(Unary::Abs, off)
        });
        let graph = &mut self.lowering.graph;
        let (left, digits, nothing) = (graph.constant(LEFT_OF_HALF), graph.constant(DIGITS), self.no_value());
        let graph = &mut self.lowering.graph;
        let digits = graph.mul(digits, range);
        [[off[0], off[1]], [off[2], off[3]]].into_iter().fold(slope, |slope, [whole, half]| {
            let left = graph.mul(left, whole);
            let limit = graph.add(left, digits);
            let is_rounded = graph.compare(Comparison::LessEqual, half, limit);
            graph.select(is_rounded, slope, nothing)
        })
    }

    /// A slope where the formula has the extremum's value at its time, as rows have it: at a jump it may be that of the side that they are not of.
    fn where_it_is_met(&mut self, (of, largest): (ExprId, bool), met: ExprId, slope: ExprId) -> ExprId {
        let found = self.asked(ReductionKind::Extreme { largest, when: false }, of);
        let off = self.lowering.graph.sub(met, found);
        self.where_as_near(of, off, slope)
    }

    /// A slope where something of a formula's kind is as good as nothing.
    fn where_as_near(&mut self, of: ExprId, off: ExprId, slope: ExprId) -> ExprId {
        let ends = self.extremes(of);
        let graph = &mut self.lowering.graph;
        let range = graph.sub(ends[1], ends[0]);
        let [part, digits] = [SAME, DIGITS].map(|part| graph.constant(part));
        let [low, high] = ends.map(|end| graph.unary(Unary::Abs, end));
        let size = graph.binary(Binary::Max, low, high);
        let [part, digits] = [graph.mul(part, range), graph.mul(digits, size)];
        let limit = graph.add(part, digits);
        let off = graph.unary(Unary::Abs, off);
        let is_near = graph.compare(Comparison::LessEqual, off, limit);
        let nothing = self.no_value();
        self.lowering.graph.select(is_near, slope, nothing)
    }

    /// A slope where no other extremum is alike: the value of that may go with the variable otherwise. Then it goes to one side as to the other,
    /// `max(e + h e_p) + max(e − h e_p) = 2 max(e)` for a small `h`.
    fn where_alone(
        &mut self,
        (of, largest): (ExprId, bool),
        (value, holds): (ExprId, Option<ExprId>),
        (by, going): (ExprId, &[Going]),
        slope: ExprId,
    ) -> ExprId {
        if self.is_zero(by) {
            return slope;
        }
        let kind = ReductionKind::Extreme { largest, when: false };
        let by_of = self.lowering.only_where(holds, by);
        // how much it goes at the most is often not known to as many digits as are asked of results
        let square = self.lowering.graph.mul(by_of, by_of);
        let (square, range) = (self.asked(ReductionKind::Mean, square), self.range(of));
        let found = self.asked(kind, of);
        let graph = &mut self.lowering.graph;
        let usual = graph.unary(Unary::Sqrt, square);
        let (part, zero) = (graph.constant(MOVED), graph.constant(0.0));
        let moved = graph.mul(part, range);
        // of what has no mean nothing is known, not even that it rests
        let (step, rests) = (graph.div(moved, usual), graph.compare(Comparison::LessEqual, usual, zero));
        // all values of what rests are alike, and yet the variable may move each of them by as much as it likes
        let size = self.size_of_the_variable();
        let graph = &mut self.lowering.graph;
        let least = graph.constant(LEAST_STEP);
        let least = graph.mul(least, size);
        let step = graph.binary(Binary::Max, step, least);
        let step = graph.select(rests, zero, step);
        let moved = graph.mul(step, usual);
        let change = graph.mul(step, by);
        let both =
            [graph.add(value, change), graph.sub(value, change)].map(|formula| self.reduce(kind, formula, holds));
        let graph = &mut self.lowering.graph;
        let (sum, twice) = (graph.add(both[0], both[1]), graph.add(found, found));
        let off = graph.sub(sum, twice);
        let off = graph.unary(Unary::Abs, off);
        let [part, digits] = [ALONE, LAST_DIGITS].map(|part| graph.constant(part));
        let size = graph.unary(Unary::Abs, found);
        let [part, digits] = [graph.mul(part, moved), graph.mul(digits, size)];
        let limit = graph.add(part, digits);
        let is_alone = graph.compare(Comparison::LessEqual, off, limit);
        let nothing = self.no_value();
        let slope = self.lowering.graph.select(is_alone, slope, nothing);
        self.where_it_goes((usual, range), going, slope)
    }

    /// A slope where the variable changes the formula at all, by more than rounding does: if it were so much as it is large; or what it bends
    /// at.
    fn where_it_goes(&mut self, (usual, range): (ExprId, ExprId), going: &[Going], slope: ExprId) -> ExprId {
        let size = self.size_of_the_variable();
        let graph = &mut self.lowering.graph;
        let (part, zero) = (graph.constant(NOTHING), graph.constant(0.0));
        let (change, limit) = (graph.mul(usual, size), graph.mul(part, range));
        let mut rests = graph.compare(Comparison::LessEqual, change, limit);
        if !going.is_empty() {
            let stays = self.rests(going);
            rests = self.lowering.graph.and(rests, stays);
        }
        self.lowering.graph.select(rests, zero, slope)
    }

    /// Whether what goes with the variable does so by no more than rounding, if that were so much as it is large.
    fn rests(&mut self, going: &[Going]) -> ExprId {
        let size = self.size_of_the_variable();
        let graph = &mut self.lowering.graph;
        let (part, yes) = (graph.constant(NOTHING * NOTHING), graph.constant(1.0));
        let size = graph.mul(size, size);
        going.iter().fold(yes, |all, &Going { of, by }| {
            let [of, by] = [of, by].map(|of| {
                let square = self.lowering.graph.mul(of, of);
                self.reduce(ReductionKind::Mean, square, None)
            });
            let graph = &mut self.lowering.graph;
            let (change, limit) = (graph.mul(by, size), graph.mul(part, of));
            let rests = graph.compare(Comparison::LessEqual, change, limit);
            graph.and(all, rests)
        })
    }

    /// How large the variable is, or usually is.
    fn size_of_the_variable(&mut self) -> ExprId {
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
    fn range(&mut self, of: ExprId) -> ExprId {
        let [low, high] = self.extremes(of);
        self.lowering.graph.sub(high, low)
    }

    /// The least and the largest value.
    fn extremes(&mut self, of: ExprId) -> [ExprId; 2] {
        [false, true].map(|largest| self.asked(ReductionKind::Extreme { largest, when: false }, of))
    }

    /// The time of the analysis.
    fn span(&mut self) -> ExprId {
        let [from, to] = ENDS.map(|end| self.time(end));
        self.lowering.graph.sub(to, from)
    }

    fn time(&mut self, end: ReductionKind) -> ExprId {
        let time = self.lowering.graph.symbol(Symbol::Time);
        self.asked(end, time)
    }

    /// The ends of the analysis, and how they go with the variable.
    fn of_ends(&mut self) -> [(ReductionKind, ExprId); 2] {
        [0, 1].map(|end| (ENDS[end], self.of_time(self.ends[end])))
    }

    /// How a time that has a formula of parameters goes with the variable; others stay.
    fn of_time(&mut self, time: Option<ExprId>) -> ExprId {
        match time {
            Some(time) => self.lowering.derivative_by(time, self.variable),
            None => self.lowering.graph.constant(0.0),
        }
    }

    /// What is asked of a formula where it holds.
    fn reduce(&mut self, kind: ReductionKind, formula: ExprId, holds: Option<ExprId>) -> ExprId {
        if self.is_zero(formula) {
            return formula;
        }
        let of = self.lowering.only_where(holds, formula);
        self.asked(kind, of)
    }

    /// The symbol of what is asked, once.
    fn asked(&mut self, kind: ReductionKind, of: ExprId) -> ExprId {
        let known = self.reductions.iter().position(|known| known.kind == kind && known.of == of);
        let k = known.unwrap_or_else(|| {
            let span = self.reductions[0].span;
            self.reductions.push(Reduction { of, kind, span });
            self.reductions.len() - 1
        });
        self.lowering.graph.symbol(Symbol::Named(k as u32))
    }

    fn is_zero(&self, formula: ExprId) -> bool {
        self.lowering.graph.is_zero(formula)
    }

    fn no_value(&mut self) -> ExprId {
        self.lowering.no_value()
    }
}

/// A formula where the variable has gone on by a step, with what goes with it, and how.
fn stepped(graph: &mut Graph, (formula, moved): (ExprId, &[(Symbol, ExprId)]), step: ExprId) -> ExprId {
    let mut with = FxHashMap::default();
    for &(symbol, slope) in moved {
        let (from, way) = (graph.symbol(symbol), graph.mul(slope, step));
        with.insert(symbol, graph.add(from, way));
    }
    graph.substituted(&[formula], |symbol| with.get(&symbol).copied())[0]
}
