//! Validity of the derivatives of results, which do not exist at kinks and jumps that depend on the variable and where several extrema are
//! equal. Each method takes a derivative and returns it where it is valid; elsewhere the result has no value.

use super::{ENDS, Extremum, NOTHING, Reduced, SAME, Slopes};
use crate::lower::switching::SwitchingFunction;
use mechc_expr::{Binary, Comparison, ExprId, Graph, Node, Symbol, Unary};
use mechc_ir::ReductionKind;
use rustc_hash::FxHashMap;

/// Bound like `SAME` for a formula at rest, as a part of its size.
const DIGITS: f64 = 1e-9;
/// An extremum is flat if its rate would change it over the analysis by at most this part of its range.
const FLAT: f64 = 1e-3;
/// Distance from its extremum at which a formula without rate is examined, as a part of the analysis.
const BESIDE: f64 = 3e-4;
/// An extremum is isolated if a move by this part of its range changes it alike on both sides.
const MOVED: f64 = 1e-6;
/// Largest difference between both sides of an isolated extremum, as a part of the change.
const ALONE: f64 = 0.01;
/// Range of a formula, in standard deviations.
const DEVIATIONS: f64 = 4.0;
/// A formula of results is smooth if halving the step reduces its deviation from a straight line to at most this part: a quarter for a
/// smooth one, half at a kink.
const LEFT_OF_HALF: f64 = 0.35;
/// Smallest change of a parameter, as the change of the formula that this part of the parameter's size causes.
const LEAST_STEP: f64 = 1e-9;
/// Changes below this part of a value are rounding.
const LAST_DIGITS: f64 = 1e-13;

impl Slopes<'_, '_> {
    /// Keeps the derivative of a formula of results if it is the derivative to both sides. The second difference of a smooth formula falls
    /// to a quarter for half the step; at a kink it falls to half, at a jump it stays.
    pub(super) fn if_two_sided(&mut self, formula: ExprId, slope: ExprId) -> ExprId {
        let moved = self.dependences(formula);
        if moved.is_empty() || !self.lowering.switches_by_results(formula) {
            return slope;
        }
        let size = self.variable_scale();
        let [whole, half] = [MOVED, 0.5 * MOVED].map(|part| {
            let graph = &mut self.lowering.graph;
            let part = graph.constant(part);
            let step = graph.mul(part, size);
            self.second_difference(formula, &moved, step)
        });
        let graph = &mut self.lowering.graph;
        let [part, alone, digits] = [LEFT_OF_HALF, ALONE * MOVED, LAST_DIGITS].map(|part| graph.constant(part));
        let left = graph.mul(part, whole);
        let is_smooth = graph.compare(Comparison::LessEqual, half, left);
        // A negligible kink is ignored, and so is rounding.
        let change = graph.unary(Unary::Abs, slope);
        let change = graph.mul(change, size);
        let value = graph.unary(Unary::Abs, formula);
        let value = graph.add(value, change);
        let [alone, digits] = [graph.mul(alone, change), graph.mul(digits, value)];
        let limit = graph.add(alone, digits);
        let is_straight = graph.compare(Comparison::LessEqual, whole, limit);
        let undefined = self.no_value();
        let graph = &mut self.lowering.graph;
        let curved = graph.select(is_smooth, slope, undefined);
        graph.select(is_straight, slope, curved)
    }

    /// Returns the symbols of a formula of results that depend on the variable, with their derivatives.
    pub(super) fn dependences(&mut self, formula: ExprId) -> Vec<(Symbol, ExprId)> {
        let variable = self.lowering.model.variables[self.variable as usize].symbol;
        let mut moved = Vec::new();
        for symbol in self.lowering.graph.symbols(formula) {
            let slope = match symbol {
                Symbol::Named(k) => self.cached.get(&k).copied().flatten(),
                _ => (symbol == variable).then(|| self.lowering.graph.constant(1.0)),
            };
            moved.extend(slope.filter(|slope| !self.is_zero(*slope)).map(|slope| (symbol, slope)));
        }
        moved
    }

    /// Returns `|f(p + h) + f(p − h) − 2 f(p)|` of a formula of results, whose symbols are linear in `p` by their derivatives.
    pub(super) fn second_difference(&mut self, formula: ExprId, moved: &[(Symbol, ExprId)], step: ExprId) -> ExprId {
        let graph = &mut self.lowering.graph;
        let back = graph.neg(step);
        let [there, here] = [step, back].map(|step| shifted(graph, formula, moved, step));
        let (sum, twice) = (graph.add(there, here), graph.add(formula, formula));
        let off = graph.sub(sum, twice);
        graph.unary(Unary::Abs, off)
    }

    /// Keeps a derivative unless a moving switch is at the reduced time, where the derivatives to both sides may differ.
    pub(super) fn unless_at_switch(
        &mut self,
        kind: ReductionKind,
        switches: &[SwitchingFunction],
        holds: Option<ExprId>,
        slope: ExprId,
    ) -> ExprId {
        if switches.is_empty() {
            return slope;
        }
        let size = self.variable_scale();
        let undefined = self.no_value();
        switches.iter().fold(slope, |slope, &SwitchingFunction { value: of, derivative: by }| {
            let [of, by] = [of, by].map(|formula| self.reduce(kind, formula, holds));
            let graph = &mut self.lowering.graph;
            let [off, change] = [of, by].map(|of| graph.unary(Unary::Abs, of));
            let part = graph.constant(SAME);
            let reach = graph.mul(part, size);
            let reached = graph.mul(change, reach);
            let is_clear = graph.compare(Comparison::LessEqual, reached, off);
            graph.select(is_clear, slope, undefined)
        })
    }

    /// Returns the switching functions of a formula with their derivatives through a time that depends on the variable.
    pub(super) fn switches_at_moving_time(
        &mut self,
        value: ExprId,
        time_slope: ExprId,
        kinks: bool,
    ) -> Vec<SwitchingFunction> {
        if self.is_zero(time_slope) {
            return Vec::new();
        }
        let functions = self.lowering.switching_functions(value, kinks).into_iter();
        let switches = functions.map(|of| {
            let rate = self.lowering.time_derivative(of);
            let graph = &mut self.lowering.graph;
            let rate = rate.unwrap_or_else(|| graph.constant(1.0));
            SwitchingFunction { value: of, derivative: graph.mul(rate, time_slope) }
        });
        let mut switches: Vec<SwitchingFunction> = switches.collect();
        switches.retain(|switch| !self.is_zero(switch.derivative));
        switches
    }

    /// Keeps the derivative of an integral unless its formula jumps at an end that depends on the variable.
    pub(super) fn unless_jump_at_ends(&mut self, k: u32, slope: ExprId) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let ends = self.end_slopes()?;
        Some(ends.into_iter().fold(slope, |slope, (kind, time_slope)| {
            let switches = self.switches_at_moving_time(value, time_slope, false);
            self.unless_at_switch(kind, &switches, holds, slope)
        }))
    }

    /// Keeps the derivative of an integral or mean if its formula is defined over the whole window: else that duration may depend on the
    /// variable.
    pub(super) fn if_defined_throughout(&mut self, k: u32, slope: ExprId) -> ExprId {
        let Reduced { value, holds } = self.formulas[k as usize];
        if !may_be_undefined(&self.lowering.graph, value) {
            return slope;
        }
        let [mean, integral] =
            [ReductionKind::Mean, ReductionKind::Integral].map(|kind| self.reduce(kind, value, holds));
        let (of, span) = (self.reductions[k as usize].of, self.span());
        let graph = &mut self.lowering.graph;
        let over = graph.div(integral, span);
        let off = graph.sub(over, mean);
        self.if_negligible(of, off, slope)
    }

    /// Keeps the derivative of an integral unless its formula jumps at times that depend on the variable, whose dependence is not
    /// available. With a strictly monotonic weight `w`, `∫ d(w e)/dt dt` differs from the change of `w e` by the jumps.
    pub(super) fn unless_moving_jumps(&mut self, k: u32, slope: ExprId) -> ExprId {
        let Reduced { value, holds } = self.formulas[k as usize];
        let switches = self.lowering.moving_jumps(value, self.variable);
        if switches.is_empty() {
            return slope;
        }
        let (of, weight) = (self.reductions[k as usize].of, self.weight());
        let weighed = self.lowering.graph.mul(weight, value);
        let Some(rate) = self.lowering.time_derivative(weighed) else {
            let (rests, undefined) = (self.are_unaffected(&switches), self.no_value());
            return self.lowering.graph.select(rests, slope, undefined);
        };
        let inside = self.reduce(ReductionKind::Integral, rate, holds);
        let [from, to] = ENDS.map(|end| self.reduce(end, weighed, holds));
        let graph = &mut self.lowering.graph;
        let whole = graph.sub(to, from);
        let jumps = graph.sub(whole, inside);
        self.if_negligible(of, jumps, slope)
    }

    /// Returns `exp((t − from)/(to − from))`.
    pub(super) fn weight(&mut self) -> ExprId {
        let (from, span) = (self.time(ENDS[0]), self.span());
        let graph = &mut self.lowering.graph;
        let time = graph.symbol(Symbol::Time);
        let gone = graph.sub(time, from);
        let part = graph.div(gone, span);
        graph.unary(Unary::Exp, part)
    }

    /// Keeps the derivative of the time of an extremum at an end of the analysis. If the extremum is stationary there, its time moves into
    /// the analysis to one side and stays at the end to the other.
    pub(super) fn unless_stationary_at_end(
        &mut self,
        of: ExprId,
        rate: ExprId,
        within: ExprId,
        time_slope: ExprId,
    ) -> ExprId {
        let (range, span, size) = (self.range(of), self.span(), self.variable_scale());
        let undefined = self.no_value();
        let graph = &mut self.lowering.graph;
        let (part, digits) = (graph.constant(SAME), graph.constant(NOTHING));
        let steep = graph.unary(Unary::Abs, rate);
        let [steep, flat, short] = [graph.mul(steep, span), graph.mul(part, range), graph.mul(digits, span)];
        let is_steep = graph.compare(Comparison::Less, flat, steep);
        let change = graph.unary(Unary::Abs, within);
        let change = graph.mul(change, size);
        let stays = graph.compare(Comparison::LessEqual, change, short);
        let stands = graph.or(is_steep, stays);
        graph.select(stands, time_slope, undefined)
    }

    /// Selects a derivative where the formula is stationary in time, and another one elsewhere.
    pub(super) fn select_if_stationary(
        &mut self,
        of: ExprId,
        rate: ExprId,
        slope: ExprId,
        elsewhere: ExprId,
    ) -> ExprId {
        let (range, span) = (self.range(of), self.span());
        let graph = &mut self.lowering.graph;
        let (steep, part) = (graph.unary(Unary::Abs, rate), graph.constant(FLAT));
        let [steep, range] = [graph.mul(steep, span), graph.mul(part, range)];
        let is_flat = graph.compare(Comparison::LessEqual, steep, range);
        graph.select(is_flat, slope, elsewhere)
    }

    /// Keeps a derivative where a formula without rate is stationary at its extremum. At half the distance in time a smooth formula is off
    /// the extremum by a quarter; at a kink by half, at a jump by all.
    pub(super) fn if_smooth_at_extremum(
        &mut self,
        Extremum { of, largest }: Extremum,
        time: ExprId,
        slope: ExprId,
    ) -> ExprId {
        let extremum = self.request(ReductionKind::Extreme { largest, when: false }, of);
        let (range, span, [from, to]) = (self.range(of), self.span(), ENDS.map(|end| self.time(end)));
        let off = [BESIDE, 0.5 * BESIDE, -BESIDE, -0.5 * BESIDE].map(|part| {
            let graph = &mut self.lowering.graph;
            let part = graph.constant(part);
            let distance = graph.mul(part, span);
            let there = graph.add(time, distance);
            let there = graph.binary(Binary::Max, there, from);
            let there = graph.binary(Binary::Min, there, to);
            let value = self.request(ReductionKind::At(there), of);
            let graph = &mut self.lowering.graph;
            let off = graph.sub(value, extremum);
            graph.unary(Unary::Abs, off)
        });
        let graph = &mut self.lowering.graph;
        let (left, digits, undefined) = (graph.constant(LEFT_OF_HALF), graph.constant(DIGITS), self.no_value());
        let graph = &mut self.lowering.graph;
        let digits = graph.mul(digits, range);
        [[off[0], off[1]], [off[2], off[3]]].into_iter().fold(slope, |slope, [whole, half]| {
            let left = graph.mul(left, whole);
            let limit = graph.add(left, digits);
            let is_rounded = graph.compare(Comparison::LessEqual, half, limit);
            graph.select(is_rounded, slope, undefined)
        })
    }

    /// Keeps a derivative where the formula at the extremum's time has the extremum's value. At a jump it may have that of the other side.
    pub(super) fn if_attained(&mut self, Extremum { of, largest }: Extremum, met: ExprId, slope: ExprId) -> ExprId {
        let extremum = self.request(ReductionKind::Extreme { largest, when: false }, of);
        let off = self.lowering.graph.sub(met, extremum);
        self.if_negligible(of, off, slope)
    }

    /// Keeps a derivative where `off` is negligible relative to the values of a formula.
    pub(super) fn if_negligible(&mut self, of: ExprId, off: ExprId, slope: ExprId) -> ExprId {
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
        let undefined = self.no_value();
        self.lowering.graph.select(is_near, slope, undefined)
    }

    /// Keeps a derivative where the extremum is unique. An equal one may have another derivative; then
    /// `max(e + h e_p) + max(e − h e_p) > 2 max(e)` for a small `h`.
    pub(super) fn if_unique(
        &mut self,
        Extremum { of, largest }: Extremum,
        Reduced { value, holds }: Reduced,
        by: ExprId,
        switches: &[SwitchingFunction],
        slope: ExprId,
    ) -> ExprId {
        if self.is_zero(by) {
            return slope;
        }
        let kind = ReductionKind::Extreme { largest, when: false };
        let by_of = self.lowering.only_where(holds, by);
        // The largest derivative is often less accurate than results must be.
        let square = self.lowering.graph.mul(by_of, by_of);
        let range = self.range_where_affected(of, square);
        let square = self.request(ReductionKind::Mean, square);
        let extremum = self.request(kind, of);
        let graph = &mut self.lowering.graph;
        let usual = graph.unary(Unary::Sqrt, square);
        let (part, zero) = (graph.constant(MOVED), graph.constant(0.0));
        let moved = graph.mul(part, range);
        // Without a mean nothing is known of the derivative, not even that it is zero.
        let (step, rests) = (graph.div(moved, usual), graph.compare(Comparison::LessEqual, usual, zero));
        // A formula that rests has equal values everywhere, and yet the variable may change each of them differently.
        let size = self.variable_scale();
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
        let (sum, twice) = (graph.add(both[0], both[1]), graph.add(extremum, extremum));
        let off = graph.sub(sum, twice);
        let off = graph.unary(Unary::Abs, off);
        let [part, digits] = [ALONE, LAST_DIGITS].map(|part| graph.constant(part));
        let size = graph.unary(Unary::Abs, extremum);
        let [part, digits] = [graph.mul(part, moved), graph.mul(digits, size)];
        let limit = graph.add(part, digits);
        let is_alone = graph.compare(Comparison::LessEqual, off, limit);
        let undefined = self.no_value();
        let (slope, range) = (self.lowering.graph.select(is_alone, slope, undefined), self.range(of));
        self.zero_if_unaffected(usual, range, switches, slope)
    }

    /// Returns the range of a formula weighted by `square`, so that values which the variable does not change do not count.
    fn range_where_affected(&mut self, of: ExprId, square: ExprId) -> ExprId {
        let graph = &mut self.lowering.graph;
        let once = graph.mul(square, of);
        let twice = graph.mul(once, of);
        let [all, once, twice] = [square, once, twice].map(|formula| self.request(ReductionKind::Mean, formula));
        let range = self.range(of);
        let graph = &mut self.lowering.graph;
        let [once, twice] = [once, twice].map(|sum| graph.div(sum, all));
        let mean_squared = graph.mul(once, once);
        let variance = graph.sub(twice, mean_squared);
        let variance = graph.unary(Unary::Abs, variance);
        let (deviation, part) = (graph.unary(Unary::Sqrt, variance), graph.constant(DEVIATIONS));
        let spread = graph.mul(part, deviation);
        // Not a number if nothing changes; then nothing uses it.
        let is_less = graph.compare(Comparison::Less, spread, range);
        graph.select(is_less, spread, range)
    }

    /// Replaces a derivative by zero where the variable changes neither the formula nor its switching functions by more than rounding, even
    /// if it changed by its magnitude.
    pub(super) fn zero_if_unaffected(
        &mut self,
        usual: ExprId,
        range: ExprId,
        switches: &[SwitchingFunction],
        slope: ExprId,
    ) -> ExprId {
        let size = self.variable_scale();
        let graph = &mut self.lowering.graph;
        let (part, zero) = (graph.constant(NOTHING), graph.constant(0.0));
        let (change, limit) = (graph.mul(usual, size), graph.mul(part, range));
        let mut rests = graph.compare(Comparison::LessEqual, change, limit);
        if !switches.is_empty() {
            let stays = self.are_unaffected(switches);
            rests = self.lowering.graph.and(rests, stays);
        }
        self.lowering.graph.select(rests, zero, slope)
    }

    /// Returns whether switching functions change by no more than rounding if the variable changes by its magnitude.
    pub(super) fn are_unaffected(&mut self, switches: &[SwitchingFunction]) -> ExprId {
        let size = self.variable_scale();
        let graph = &mut self.lowering.graph;
        let (part, yes) = (graph.constant(NOTHING * NOTHING), graph.constant(1.0));
        let size = graph.mul(size, size);
        switches.iter().fold(yes, |all, &SwitchingFunction { value: of, derivative: by }| {
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
}

/// Returns a formula after a step of the variable, with its symbols and their derivatives in `moved`.
fn shifted(graph: &mut Graph, formula: ExprId, moved: &[(Symbol, ExprId)], step: ExprId) -> ExprId {
    let mut with = FxHashMap::default();
    for &(symbol, slope) in moved {
        let (from, change) = (graph.symbol(symbol), graph.mul(slope, step));
        with.insert(symbol, graph.add(from, change));
    }
    graph.substituted(&[formula], |symbol| with.get(&symbol).copied())[0]
}

/// Returns whether a formula may be undefined over some time, by a root, logarithm or the like of varying operands, or by a quotient.
fn may_be_undefined(graph: &Graph, formula: ExprId) -> bool {
    let moves = |id: ExprId| !graph.dependence(id).is_constant();
    graph.reachable(&[formula]).into_iter().any(|id| match graph.node(id) {
        Node::Unary(Unary::Sqrt | Unary::Ln | Unary::Log10 | Unary::Asin | Unary::Acos, a)
        | Node::Binary(Binary::Pow, a, _)
        | Node::Div(_, a) => moves(a),
        Node::Power(a, n) => n < 0 && moves(a),
        _ => false,
    })
}
