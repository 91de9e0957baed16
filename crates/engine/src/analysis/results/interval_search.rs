//! Evaluation of a formula between the ends of the motion's steps: the tools that the searches for extrema and integrals share.

use super::curve::{Cell, Curve, Estimate, Point, Shift, Verdict};
use super::state_sampler::StateSampler;
use crate::analysis::follow::SmoothSegment;
use crate::analysis::state::State;
use crate::limits::extremum::{APART, TIMES};
use crate::limits::interval_search::{FACTOR, ROUNDING, SHORTEST};
use mechc_expr::math::{enclose_root, power_of_two_below};
use mechc_ir::program::Range;
use std::cmp::Ordering;
use std::rc::Rc;

/// Maximum number of cells that are divided for one formula; a cell whose middle has to be solved for counts as several.
const MOST_CELLS: usize = 400_000;
/// Additional cells for each step of the motion.
const MOST_OF_A_STEP: usize = 4_000;
/// Number of cells that a cell counts as if its middle has to be solved for.
const SOLVED: usize = 20;
/// Longest short cell, as a part of the span.
const SHORT: f64 = 1e-3;
/// Longest interval without solution, or with values hidden by rounding, as a part of the span.
const OPAQUE: f64 = 1e-6;
/// A value is reliable if rounding changes it by at most this part of itself or of the range.
const RELIABLE: f64 = 1e-3;
/// Largest distance from a time at which the growth of a formula is examined, as a part of the span.
const FARTHEST: f64 = 1e-5;
/// Values that differ by at most this part of the range are equal.
const ALIKE: f64 = 1e-9;
/// Smaller values are zero: rounding of the root of the smallest square is as large.
const NOTHING: f64 = 1e-150;

/// The scale of a formula, which decides what counts as a difference.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Scale {
    /// The range of the values, or their median distance from the extremum that is searched for.
    pub range: f64,
    /// The magnitude of the terms that the values are sums of, which determines rounding.
    pub weight: f64,
    /// The duration of the analysis (s).
    pub span: f64,
}

impl Scale {
    /// Returns the difference up to which values count as equal: rounding of a constant value is no change.
    pub fn tolerance(self) -> f64 {
        self.gap(ALIKE)
    }

    /// Returns a part of the range, but no less than the rounding of a value.
    pub fn gap(self, part: f64) -> f64 {
        f64::max(part * self.range, ROUNDING * self.weight).max(NOTHING)
    }
}

/// The reason why a reduction has no value.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum NoValueCause {
    /// The formula has no value at a requested time (s).
    Missing(f64),
    /// The formula has no value at any time from this one (s) on.
    Nowhere(f64),
    /// The formula grows without bound towards a time (s).
    Unbounded(f64),
    /// No digit of the value is certain, because of the formula around a time (s).
    Unknown(f64),
    /// The value depends on a time (s) so close to a singular position that a row would be refused.
    Uncertain(f64),
    /// A bound of the window (s) lies outside the analysis, or the window ends before it begins.
    Window(f64),
}

impl NoValueCause {
    /// Returns the time (s) of the cause.
    pub fn t(self) -> f64 {
        match self {
            NoValueCause::Missing(t)
            | NoValueCause::Nowhere(t)
            | NoValueCause::Unbounded(t)
            | NoValueCause::Unknown(t)
            | NoValueCause::Uncertain(t)
            | NoValueCause::Window(t) => t,
        }
    }
}

/// The findings of a search: causes of missing values, and the work done.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Notes {
    pub cause: Option<NoValueCause>,
    /// The first time (s) at which the formula has no value.
    pub missing: Option<f64>,
    /// The number of cells that were evaluated, and its limit.
    cells: usize,
    limit: usize,
}

impl Notes {
    /// Records a cause of a missing value; the earliest one is kept.
    pub fn fail(&mut self, cause: NoValueCause) {
        if self.cause.is_none_or(|earlier| cause.t() < earlier.t()) {
            self.cause = Some(cause);
        }
    }

    /// Returns whether the limit of evaluated cells is exceeded.
    pub fn are_exhausted(&self) -> bool {
        self.cells > self.limit
    }

    /// Records a time (s) at which the formula has no value.
    pub fn miss(&mut self, t: f64) {
        if self.missing.is_none_or(|earlier| t < earlier) {
            self.missing = Some(t);
        }
    }
}

/// A part of a search that takes the largest rank first, and of equal ranks the earliest time.
pub(super) struct Ranked<T> {
    pub rank: f64,
    /// The time (s).
    pub t: f64,
    pub item: T,
}

impl<T> PartialEq for Ranked<T> {
    fn eq(&self, other: &Ranked<T>) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<T> Eq for Ranked<T> {}

impl<T> PartialOrd for Ranked<T> {
    fn partial_cmp(&self, other: &Ranked<T>) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> Ord for Ranked<T> {
    fn cmp(&self, other: &Ranked<T>) -> Ordering {
        self.rank.total_cmp(&other.rank).then(other.t.total_cmp(&self.t))
    }
}

/// A search in a formula over some steps of the motion.
pub(super) struct IntervalSearch<'r> {
    pub curve: &'r mut Curve,
    sampler: &'r mut StateSampler,
    pub steps: &'r [SmoothSegment],
    /// The first and the last time (s) at which the formula is evaluated.
    pub window: [f64; 2],
    /// The step that the sampler has entered.
    entered: Option<usize>,
    pub notes: &'r mut Notes,
    /// The length (s) up to which cells are not divided.
    pub shortest: f64,
    /// The usual difference of values.
    pub range: f64,
    /// The length (s) up to which rounding may dominate the differences in a cell.
    pub short: f64,
    /// True if the times at which guards cross their thresholds matter.
    pub is_timed: bool,
    last_crossing: Option<LocatedCrossing>,
}

/// A located crossing of a guard: its time (s) and the error bound (s) of that.
#[derive(Clone, Copy)]
struct LocatedCrossing {
    guard: usize,
    t: f64,
    error: f64,
}

impl<'r> IntervalSearch<'r> {
    /// Starts a search in a window (s) of an analysis of duration `span` (s).
    pub fn new(
        curve: &'r mut Curve,
        notes: &'r mut Notes,
        sampler: &'r mut StateSampler,
        steps: &'r [SmoothSegment],
        window: [f64; 2],
        span: f64,
    ) -> IntervalSearch<'r> {
        curve.short = SHORT * span;
        notes.limit = notes.limit.max(MOST_CELLS) + MOST_OF_A_STEP * steps.len();
        IntervalSearch {
            curve,
            sampler,
            steps,
            window,
            entered: None,
            notes,
            shortest: SHORTEST * span,
            range: 0.0,
            short: SHORT * span,
            is_timed: false,
            last_crossing: None,
        }
    }

    fn enter(&mut self, step: usize) {
        if self.entered != Some(step) {
            self.sampler.enter(&self.steps[step]);
            self.entered = Some(step);
        }
    }

    /// Records a time (s) of a step at which the formula has no value. Next to a singular position forces and derivatives by parameters may have
    /// any size, so that the time must not be left out there.
    pub fn miss(&mut self, step: usize, t: f64) {
        if let Some(bridge) = &self.steps[step].bridge
            && self.curve.may_be_singular()
        {
            self.notes.fail(NoValueCause::Uncertain(bridge.at));
        }
        self.notes.miss(t);
    }

    /// Evaluates the formula at a state of a step.
    pub fn at(&mut self, step: usize, state: State) -> Rc<Point> {
        self.enter(step);
        self.curve.at(state, self.sampler)
    }

    /// Evaluates the formula at a time (s) within a cell. Returns `None` if the motion cannot be solved for.
    pub fn point(&mut self, cell: &Cell, t: f64) -> Option<Rc<Point>> {
        self.between(cell.step, [&cell.a.state, &cell.b.state], t)
    }

    /// Evaluates the formula at a time (s) within a cell, with exactly the bits of a row. Returns `None` if the solver of rows fails there.
    pub fn exact_point(&mut self, cell: &Cell, t: f64) -> Option<Rc<Point>> {
        self.enter(cell.step);
        let state = self.sampler.solve_exactly(&self.steps[cell.step], [&cell.a.state, &cell.b.state], t)?;
        Some(self.curve.at(state, self.sampler))
    }

    /// Evaluates the formula at a time (s) of a step. Returns `None` if the motion cannot be solved for.
    pub fn point_of_step(&mut self, step: usize, t: f64) -> Option<Rc<Point>> {
        let ends @ [from, to] = [&self.steps[step].from, &self.steps[step].to];
        match [from, to].into_iter().find(|end| end.t.total_cmp(&t).is_eq()) {
            Some(end) => Some(self.at(step, end.clone())),
            None => self.between(step, ends, t),
        }
    }

    /// Evaluates the formula at a time (s) in a step or its neighbors. Returns `None` beyond an edge or the window, or if the motion cannot be
    /// solved for.
    pub fn point_near(&mut self, mut step: usize, t: f64) -> Option<Rc<Point>> {
        let steps = self.steps;
        while step > 0 && t < steps[step].from.t && !steps[step].begins_at_edge {
            step -= 1;
        }
        while step + 1 < steps.len() && t > steps[step].to.t && !steps[step].ends_at_edge {
            step += 1;
        }
        let ([from, to], SmoothSegment { from: a, to: b, .. }) = (self.window, &steps[step]);
        let is_within = from.max(a.t) <= t && t <= to.min(b.t);
        if is_within { self.point_of_step(step, t) } else { None }
    }

    /// Evaluates the formula at three times before (−1) or behind (1) a point, each [`FACTOR`] times as far away as the previous one. The first is
    /// at least `width` (s) away, and so far that its value is reliable. Returns `None` if there are no such times nearby.
    pub fn samples_near(
        &mut self,
        step: usize,
        point: &Point,
        direction: f64,
        width: f64,
        scale: Scale,
    ) -> Option<[Estimate; 3]> {
        let mut far = FACTOR * self.shortest.max(width).max(point.shift.time);
        loop {
            let mut samples = [Estimate::NOTHING; 3];
            let mut distance = far;
            for sample in &mut samples {
                let there = self.point_near(step, point.state.t + direction * distance)?;
                *sample = self.curve.estimate(&there);
                distance *= FACTOR;
            }
            if samples[0].error <= scale.gap(RELIABLE).max(RELIABLE * samples[0].value.abs()) {
                return Some(samples);
            }
            far *= FACTOR;
            if far > FARTHEST * scale.span {
                return None;
            }
        }
    }

    fn between(&mut self, step: usize, [a, b]: [&State; 2], t: f64) -> Option<Rc<Point>> {
        self.enter(step);
        let state = if self.curve.moves() {
            self.notes.cells += SOLVED;
            let solved = self.sampler.solve(&self.steps[step], [a, b], t);
            if solved.is_none() && b.t - a.t > self.shortest * OPAQUE / SHORTEST {
                self.notes.fail(NoValueCause::Unknown(t));
            }
            solved?
        } else {
            self.notes.cells += 1;
            State { t, ..a.clone() }
        };
        Some(self.curve.at(state, self.sampler))
    }

    /// Returns [`StateSampler::settled`] in a step.
    pub fn settled(&mut self, step: usize, near: &State, t: f64) -> Option<State> {
        self.enter(step);
        self.sampler.settled(&self.steps[step], near, t)
    }

    /// Returns the classification and the range of the formula in a cell: open and unbounded if the states at its ends do not determine the motion
    /// between them.
    pub fn enclose(&mut self, cell: &mut Cell) -> (Verdict, Range) {
        self.enter(cell.step);
        self.notes.cells += 1;
        // the ends of a cell do not reveal a pole at a singular position between them
        let is_within = |t: f64| cell.a.state.t <= t && t <= cell.b.state.t;
        let bridge = self.steps[cell.step].bridge.as_ref().filter(|_| self.curve.may_be_singular());
        let may_be_singular = bridge.is_some_and(|bridge| is_within(bridge.at) || bridge.again.is_some_and(is_within));
        let is_determined = !self.curve.moves()
            || !may_be_singular
                && self.sampler.signals_are_resolved([cell.a.state.t, cell.b.state.t])
                && !self.curve.turns_far(cell);
        if is_determined {
            let mut ignored = Vec::new();
            loop {
                let (verdict, range) = self.curve.enclose(cell, &ignored);
                if matches!(verdict, Verdict::Open(_)) && self.is_hole(cell) {
                    return (Verdict::Missing, range);
                }
                let has_no_bound = range.high - range.low == f64::INFINITY;
                let guard = match verdict {
                    Verdict::Crosses(guard) => guard,
                    // a quotient that is continuous although both its terms vanish
                    Verdict::Open(Some(guard)) if has_no_bound => guard,
                    _ => return (verdict, range),
                };
                let Some(values) = self.values_of_rounding(cell, guard) else { return (verdict, range) };
                let differ = |value: &f64| (value - values[0]).abs() > APART * self.range;
                let are_alike = !values.iter().any(differ);
                match verdict {
                    Verdict::Crosses(_) if are_alike => ignored.push(guard),
                    Verdict::Crosses(_) => return (Verdict::Rounding, range),
                    _ if are_alike => {
                        let [low, high] = [f64::min, f64::max].map(|of| values.into_iter().fold(f64::NAN, of));
                        return (Verdict::Alike, Range { low, high, ..range });
                    }
                    _ => return (verdict, range),
                }
            }
        }
        let [low, high] = [f64::NEG_INFINITY, f64::INFINITY];
        (Verdict::Open(None), Range { low, high, may_switch: true, is_resolved: false, crosses_knots: true })
    }

    /// Returns the values at both ends and in the middle of a short cell if rounding alone decides at each of them on which side of its threshold a
    /// guard is, or else `None`.
    fn values_of_rounding(&mut self, cell: &Cell, guard: usize) -> Option<[f64; 3]> {
        if cell.length() > self.short || self.is_shortest(cell) {
            return None;
        }
        let is_rounding = |curve: &mut Curve, point: &Point| curve.is_rounding(guard, point);
        if !is_rounding(self.curve, &cell.a) || !is_rounding(self.curve, &cell.b) {
            return None;
        }
        let middle = self.point(cell, cell.middle())?;
        is_rounding(self.curve, &middle).then(|| [&cell.a, &middle, &cell.b].map(|point| point.sample.value))
    }

    /// Returns whether the formula has no value at the ends and in the middle of a short cell because of a guard that only rounding decides, such as
    /// a quotient of two constant zeros, which ranges do not reveal.
    fn is_hole(&mut self, cell: &Cell) -> bool {
        let is_short = cell.length() <= self.short && !self.is_shortest(cell);
        let mut is_missing = |point: &Point| !point.exists() && self.curve.is_undecided(point);
        let are_missing = is_short && is_missing(&cell.a) && is_missing(&cell.b);
        are_missing && self.point(cell, cell.middle()).is_none_or(|middle| !middle.exists())
    }

    /// Returns whether a cell is too short to be divided.
    pub fn is_shortest(&self, cell: &Cell) -> bool {
        cell.length() <= self.shortest || cell.is_empty()
    }

    /// Divides a cell in its middle. Returns `None` if the motion cannot be solved for there.
    pub fn halve(&mut self, cell: &Cell) -> Option<[Cell; 2]> {
        let middle = match &cell.middle {
            Some(middle) => Rc::clone(middle),
            None => self.point(cell, cell.middle())?,
        };
        Some(cell.cut(self.curve, &middle))
    }

    /// Divides a cell where a guard crosses its threshold, into the part before, the shortest cell around the crossing, and the part behind. A part
    /// is missing if the crossing is at that end of the cell. Returns `None` if the motion cannot be solved for.
    pub fn cut_at_crossing(&mut self, cell: &Cell, guard: usize) -> Option<[Option<Cell>; 3]> {
        let side = cell.a.side(guard);
        let (mut before, mut behind) = (Rc::clone(&cell.a), Rc::clone(&cell.b));
        let offs = self.curve.distances(guard, [&before, &behind]);
        let ends = [[before.state.t, offs[0].abs()], [behind.state.t, offs[1].abs()]];
        // on a grid, so that formulas that share a guard share the solved states
        enclose_root(ends, power_of_two_below(self.shortest), |t| {
            let point = self.between(cell.step, [&before.state, &behind.state], t)?;
            let is_behind = point.side(guard).total_cmp(&side).is_ne();
            *if is_behind { &mut behind } else { &mut before } = point;
            let offs = self.curve.distances(guard, [&before, &behind]);
            Some((is_behind, offs[usize::from(is_behind)].abs()))
        })?;
        if self.is_timed {
            let crossing_error = match self.last_crossing {
                // rounding makes a guard cross several times at one crossing
                Some(last) if last.guard == guard && (before.state.t - last.t).abs() <= last.error => last.error,
                _ => {
                    let of =
                        |(end, direction): (&Rc<Point>, f64)| self.crossing_error(cell.step, guard, end, direction);
                    let errors = [(&before, -1.0), (&behind, 1.0)].map(of);
                    f64::min(errors[0], errors[1])
                }
            };
            self.last_crossing = Some(LocatedCrossing { guard, t: before.state.t, error: crossing_error });
            for end in [&mut before, &mut behind] {
                Rc::make_mut(end).crossing_error = crossing_error;
            }
        }
        let jump = (before.sample.value - behind.sample.value).abs();
        if self.curve.holds_forces && jump > APART * self.range {
            // the time of a load's jump is less accurate than the crossing
            let error = TIMES / SHORTEST * self.shortest;
            self.shift(cell.step, &mut before, -error);
            self.shift(cell.step, &mut behind, error);
        }
        self.record_hole(cell.step, [&mut before, &mut behind]);
        let part = |a: &Rc<Point>, b: &Rc<Point>| (b.state.t > a.state.t).then(|| cell.between(a, b));
        Some([part(&cell.a, &before), part(&before, &behind), part(&behind, &cell.b)])
    }

    /// Returns the error bound (s) of a crossing at a point: the rounding of the guard's argument divided by its rate before (−1) or behind (1)
    /// the point.
    fn crossing_error(&mut self, step: usize, guard: usize, end: &Point, direction: f64) -> f64 {
        let error = self.curve.rounding_of_argument(guard, end);
        let mut width = FACTOR * FACTOR * self.shortest;
        while width <= self.short {
            let Some(there) = self.point_near(step, end.state.t + direction * width) else { break };
            let change = (there.argument(guard) - end.argument(guard)).abs();
            if change >= FACTOR * error {
                return width * error / change;
            }
            width *= FACTOR;
        }
        f64::INFINITY
    }

    /// Widens the error bound of a crossing at which the formula has a value on one side only, but has one farther on the other side as well:
    /// rounding may hide the values between, so that the time of the crossing is uncertain by that distance.
    fn record_hole(&mut self, step: usize, [before, behind]: [&mut Rc<Point>; 2]) {
        let (valid, missing) = match [before.exists(), behind.exists()] {
            [true, false] => (before, &*behind),
            [false, true] => (behind, &*before),
            _ => return,
        };
        let direction = (missing.state.t - valid.state.t).signum();
        let mut width = self.shortest;
        while width <= self.shortest * OPAQUE / SHORTEST {
            let t = missing.state.t + direction * width;
            let is_end = t <= self.window[0] || t >= self.window[1];
            let there = self.point_near(step, t);
            if there.is_none() && !is_end {
                return;
            }
            if is_end || there.is_some_and(|there| there.exists()) {
                self.shift(step, valid, -direction * width);
                return;
            }
            width *= 4.0;
        }
    }

    /// Records that the intended time of a point may differ from its time by `offset` (s), and the change of the value over that.
    pub fn shift(&mut self, step: usize, point: &mut Rc<Point>, offset: f64) {
        let there = self.point_near(step, point.state.t + offset);
        let value = there.map_or(f64::INFINITY, |there| (there.sample.value - point.sample.value).abs());
        Rc::make_mut(point).shift = Shift { time: offset.abs(), value };
    }
}
