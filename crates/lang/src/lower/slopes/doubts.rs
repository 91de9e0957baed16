//! Where a slope of a result is none: at kinks and jumps that go with the variable, and where several extrema are alike. Each of these takes a
//! slope and leaves it where it holds; elsewhere there is no value.

use super::{ENDS, Reduced, Slopes};
use crate::lower::edges::Going;
use mechc_expr::{Binary, Comparison, ExprId, Graph, Node, Symbol, Unary};
use mechc_ir::ReductionKind;
use mechc_ir::tolerances::results::slopes::{
    ALONE, BESIDE, DEVIATIONS, DIGITS, FLAT, LAST_DIGITS, LEAST_STEP, LEFT_OF_HALF, MOVED, NOTHING, SAME,
};
use rustc_hash::FxHashMap;

impl Slopes<'_, '_> {
    /// A slope of a formula of results where it is that to both sides. A small step to one side and to the other end off the straight line through
    /// where it is, by so much that half the step leaves a quarter of it; at a kink it leaves half, at a jump all.
    pub(super) fn where_it_goes_on(&mut self, formula: ExprId, slope: ExprId) -> ExprId {
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
    pub(super) fn moved_by_the_variable(&mut self, formula: ExprId) -> Vec<(Symbol, ExprId)> {
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
    pub(super) fn off_the_line(&mut self, of: (ExprId, &[(Symbol, ExprId)]), step: ExprId) -> ExprId {
        let (formula, graph) = (of.0, &mut self.lowering.graph);
        let back = graph.neg(step);
        let [there, here] = [step, back].map(|step| stepped(graph, of, step));
        let (sum, twice) = (graph.add(there, here), graph.add(formula, formula));
        let off = graph.sub(sum, twice);
        graph.unary(Unary::Abs, off)
    }

    /// A slope where no edge is that goes with the variable: at one there is a slope to either side, if any.
    pub(super) fn where_clear(
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

    /// What a formula breaks at where a time goes over it that goes with the variable: at such an edge there is another slope to either side.
    pub(super) fn edges_in_the_way(&mut self, value: ExprId, goes: ExprId, bends: bool) -> Vec<Going> {
        if self.is_zero(goes) {
            return Vec::new();
        }
        let edges = self.lowering.edges_of(value, bends).into_iter();
        let going = edges.map(|of| {
            let rate = self.lowering.along_the_motion(of);
            let graph = &mut self.lowering.graph;
            let rate = rate.unwrap_or_else(|| graph.constant(1.0));
            Going { of, by: graph.mul(rate, goes) }
        });
        let mut going: Vec<Going> = going.collect();
        going.retain(|going| !self.is_zero(going.by));
        going
    }

    /// A slope of an integral where its formula does not jump at an end that goes with the variable.
    pub(super) fn where_its_ends_are_clear(&mut self, k: u32, slope: ExprId) -> Option<ExprId> {
        let Reduced { value, holds } = self.formulas[k as usize];
        let ends = self.of_ends()?;
        Some(ends.into_iter().fold(slope, |slope, (kind, goes)| {
            let edges = self.edges_in_the_way(value, goes, false);
            self.where_clear(kind, (&edges, holds), slope)
        }))
    }

    /// A slope of an integral or a mean whose formula has a value all over its window: how long that is may go with the variable elsewhere.
    pub(super) fn where_it_is_all_over(&mut self, k: u32, slope: ExprId) -> ExprId {
        let Reduced { value, holds } = self.formulas[k as usize];
        if !may_be_missing(&self.lowering.graph, value) {
            return slope;
        }
        let [mean, integral] =
            [ReductionKind::Mean, ReductionKind::Integral].map(|kind| self.reduce(kind, value, holds));
        let (of, span) = (self.reductions[k as usize].of, self.span());
        let graph = &mut self.lowering.graph;
        let over = graph.div(integral, span);
        let off = graph.sub(over, mean);
        self.where_as_near(of, off, slope)
    }

    /// A slope of an integral, which a jump of its formula adds to where its time goes with the variable, as nobody knows how. With a weight `w`
    /// that no two times have, `∫ d(w e)/dt dt` lacks the jumps of `w e` from end to end.
    pub(super) fn where_it_does_not_jump(&mut self, k: u32, slope: ExprId) -> ExprId {
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
    pub(super) fn weight(&mut self) -> ExprId {
        let (from, span) = (self.time(ENDS[0]), self.span());
        let graph = &mut self.lowering.graph;
        let time = graph.symbol(Symbol::Time);
        let gone = graph.sub(time, from);
        let part = graph.div(gone, span);
        graph.unary(Unary::Exp, part)
    }

    /// The slope of the time of an extremum that is at an end of the analysis: a turn that is there just now goes to one side on within the
    /// analysis, to the other it leaves the extremum at the end.
    pub(super) fn where_it_ends(&mut self, (of, rate): (ExprId, ExprId), within: ExprId, goes: ExprId) -> ExprId {
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

    /// A slope where the formula does not change with time, and another one elsewhere.
    pub(super) fn where_flat(&mut self, (of, rate): (ExprId, ExprId), slope: ExprId, elsewhere: ExprId) -> ExprId {
        let (range, span) = (self.range(of), self.span());
        let graph = &mut self.lowering.graph;
        let (steep, part) = (graph.unary(Unary::Abs, rate), graph.constant(FLAT));
        let [steep, range] = [graph.mul(steep, span), graph.mul(part, range)];
        let is_flat = graph.compare(Comparison::LessEqual, steep, range);
        graph.select(is_flat, slope, elsewhere)
    }

    /// The same of what has no rate: beside the time of its extremum a formula that is flat there is off it by a quarter at half the distance; at a
    /// kink by half, at a jump by all.
    pub(super) fn where_rounded(&mut self, (of, largest): (ExprId, bool), time: ExprId, slope: ExprId) -> ExprId {
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
    pub(super) fn where_it_is_met(&mut self, (of, largest): (ExprId, bool), met: ExprId, slope: ExprId) -> ExprId {
        let found = self.asked(ReductionKind::Extreme { largest, when: false }, of);
        let off = self.lowering.graph.sub(met, found);
        self.where_as_near(of, off, slope)
    }

    /// A slope where something of a formula's kind is as good as nothing.
    pub(super) fn where_as_near(&mut self, of: ExprId, off: ExprId, slope: ExprId) -> ExprId {
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
    pub(super) fn where_alone(
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
        let range = self.range_where_it_goes(of, square);
        let square = self.asked(ReductionKind::Mean, square);
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
        let (slope, range) = (self.lowering.graph.select(is_alone, slope, nothing), self.range(of));
        self.where_it_goes((usual, range), going, slope)
    }

    /// The range of a formula where the variable changes it, by the squares of that: what never changes may be as far away as it likes.
    fn range_where_it_goes(&mut self, of: ExprId, square: ExprId) -> ExprId {
        let graph = &mut self.lowering.graph;
        let once = graph.mul(square, of);
        let twice = graph.mul(once, of);
        let [all, once, twice] = [square, once, twice].map(|formula| self.asked(ReductionKind::Mean, formula));
        let range = self.range(of);
        let graph = &mut self.lowering.graph;
        let [once, twice] = [once, twice].map(|sum| graph.div(sum, all));
        let mean_squared = graph.mul(once, once);
        let variance = graph.sub(twice, mean_squared);
        let variance = graph.unary(Unary::Abs, variance);
        let (deviation, part) = (graph.unary(Unary::Sqrt, variance), graph.constant(DEVIATIONS));
        let spread = graph.mul(part, deviation);
        // that is no number where nothing changes, and then nobody asks
        let is_less = graph.compare(Comparison::Less, spread, range);
        graph.select(is_less, spread, range)
    }

    /// A slope where the variable changes the formula at all, by more than rounding does: if it were so much as it is large; or what it bends
    /// at.
    pub(super) fn where_it_goes(&mut self, (usual, range): (ExprId, ExprId), going: &[Going], slope: ExprId) -> ExprId {
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
    pub(super) fn rests(&mut self, going: &[Going]) -> ExprId {
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

/// Whether a formula may have no value over some time: a root, a logarithm or the like of what moves, or a quotient of two that rest.
fn may_be_missing(graph: &Graph, formula: ExprId) -> bool {
    let moves = |id: ExprId| !graph.dependence(id).is_constant();
    graph.reachable(&[formula]).into_iter().any(|id| match graph.node(id) {
        Node::Unary(Unary::Sqrt | Unary::Ln | Unary::Log10 | Unary::Asin | Unary::Acos, a)
        | Node::Binary(Binary::Pow, a, _)
        | Node::Div(_, a) => moves(a),
        Node::Power(a, n) => n < 0 && moves(a),
        _ => false,
    })
}
