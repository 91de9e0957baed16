//! The largest value of a formula and its first time, by branch and bound.
//!
//! The cell that may hold the largest value is looked at first: it is cut where a guard crosses its threshold, or in two, until the formula rises
//! or falls all the way through it, or until its slope passes zero in it just once, at a time that is then solved for. Cells that cannot hold
//! more than what is known are never looked into, and so a pole in the other direction costs nothing and hides nothing.

use super::curve::{Cell, Estimate, Point, Verdict};
use super::extremum_refinement::{MOST_LOOKS, Sampled, Settling, Turning};
use super::interval_search::{IntervalSearch, NoValueCause, Scale};
use crate::analysis::state::State;
use crate::limits::curve::KNOWN;
use crate::limits::extremum::TIMES;
use crate::limits::interval_search::{FACTOR, SHORTEST};
use mechc_expr::math::{between, median};
use mechc_ir::program::Range;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::rc::Rc;

/// A cell that can improve the extremum by at most this part of the range is not divided.
const GAP: f64 = 1e-11;
/// Bound like `GAP` for formulas without derivative.
const GAP_OF_VALUES: f64 = 1e-9;
/// Accuracy of a time, as a part of the span.
const CERTAIN: f64 = 1e-13;
/// The vertex of a parabola through three points is accepted up to this many point distances from the middle point.
const FARTHEST: f64 = 2.0;
/// Factor by which the three points approach each other in each step.
const CLOSER: f64 = 0.1;
/// Smallest distance of the three points, as a part of the span.
const FINEST: f64 = 1e-4;
/// Maximum number of corrections of a time.
const ITERATIONS: usize = 100;
/// Bound like `TIMES` for a formula whose slope is unknown.
const TIMES_OF_VALUES: f64 = 1e-6;
/// A value at a threshold differs from the limit of one side if the difference exceeds this part of the range.
const APART: f64 = 1e-6;
/// A formula is unbounded if its gain between successive positions, whose distances shrink by equal factors, does not shrink by this
/// factor; it converges if its distance from the limit does.
const CONVERGES: f64 = 0.97;
/// An edge this close behind an extremum with the same value, as a part of the span, is the extremum.
const BESIDE: f64 = 1e-7;

/// The largest value of a formula, or the largest of its opposite.
#[derive(Clone, Debug)]
pub(super) struct Extremum {
    /// 1, or −1 for the least value.
    sign: f64,
    /// True if its time is asked for.
    is_timed: bool,
    /// A lower bound of the largest value, times the sign.
    best: f64,
    /// The estimate behind this bound, and its time (s).
    best_estimate: Estimate,
    best_at: f64,
    /// The candidates: extrema, edges and ends, with their values times the sign.
    candidates: Vec<Candidate>,
    /// The largest of these.
    largest: f64,
    /// A time (s) towards which the formula grows without bound.
    unbounded: Option<f64>,
    /// True if it is bounded as far as ranges tell.
    is_bounded: bool,
    /// A bound of how far the extremum may exceed the best value, if the search was not finished.
    unknown: f64,
}

#[derive(Clone, Copy, Debug)]
struct Candidate {
    t: f64,
    /// A bound of the error of the time (s), beyond that of the kind.
    time_error: f64,
    value: f64,
    /// A bound of the error of the value.
    error: f64,
    /// A lower bound of the value.
    least: f64,
    kind: CandidateKind,
}

impl Candidate {
    /// Returns whether the value is more than rounding.
    fn is_known(&self, scale: Scale) -> bool {
        self.error <= scale.gap(APART)
    }

    /// Returns an upper bound of the value; if the value may be rounding, its lower bound.
    fn most(&self, scale: Scale) -> f64 {
        if self.is_known(scale) { self.value + self.error } else { self.least }
    }
}

/// The kind of a candidate, which decides how accurate its time is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum CandidateKind {
    Edge,
    /// A zero of the slope.
    Turn,
    /// The largest that was seen of a formula whose slope is not known.
    Sample,
}

/// A cell that waits to be looked into, with what is known of the formula in it.
struct OpenCell {
    cell: Cell,
    verdict: Verdict,
    range: Range,
    /// The ranges of its derivatives, of a smooth cell in which they matter.
    derivatives: [Option<Range>; 2],
    /// The largest value that the cell may hold, times the sign.
    upper: f64,
}

impl PartialEq for OpenCell {
    fn eq(&self, other: &OpenCell) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for OpenCell {}

impl PartialOrd for OpenCell {
    fn partial_cmp(&self, other: &OpenCell) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for OpenCell {
    /// Orders cells by the largest value that they may hold; of equal ones the earlier is greater.
    fn cmp(&self, other: &OpenCell) -> Ordering {
        let t = |open: &OpenCell| open.cell.a.state.t;
        self.upper.total_cmp(&other.upper).then(t(other).total_cmp(&t(self)))
    }
}

impl Extremum {
    pub fn new(largest: bool) -> Extremum {
        let sign = if largest { 1.0 } else { -1.0 };
        let nothing = f64::NEG_INFINITY;
        let (candidates, unbounded) = (Vec::new(), None);
        let (best_estimate, best_at) = (Estimate::NOTHING, f64::NAN);
        Extremum {
            sign,
            is_timed: false,
            best: nothing,
            best_estimate,
            best_at,
            candidates,
            largest: nothing,
            unbounded,
            is_bounded: true,
            unknown: 0.0,
        }
    }

    /// Requests its time too.
    pub fn request_time(&mut self) {
        self.is_timed = true;
    }

    /// Records a value at a time (s).
    fn record(&mut self, t: f64, found: Estimate) {
        if self.sign * found.value - found.error > self.best {
            (self.best, self.best_estimate, self.best_at) = (self.sign * found.value - found.error, found, t);
        }
    }

    /// Records an edge or an end, at a time (s).
    pub fn note_edge(&mut self, at: Estimate, Estimate { value, error }: Estimate, scale: Scale) {
        let (value, t, time_error) = (self.sign * value, at.value, at.error);
        self.add(Candidate { t, time_error, value, error, least: value - error, kind: CandidateKind::Edge }, scale);
    }

    fn add(&mut self, found: Candidate, scale: Scale) {
        if !found.value.is_finite() {
            return;
        }
        self.record(found.t, Estimate { value: self.sign * found.value, error: found.value - found.least });
        if found.most(scale) < self.best - scale.alike() {
            return;
        }
        // what was only seen is not as good as what may be found beside it
        if found.kind != CandidateKind::Sample && found.least > self.largest {
            self.largest = found.least;
            let least = found.value - scale.alike();
            self.candidates.retain(|known| known.most(scale) >= least);
        }
        self.candidates.push(found);
    }

    /// Returns whether values that are no larger than this are of no interest any more.
    fn is_above(&self, upper: f64, scale: Scale) -> bool {
        let gap = scale.gap(GAP);
        upper < self.best - scale.alike() - gap || upper <= self.largest + gap
    }

    /// Returns whether values that are no larger than this cannot be the extremum, nor, where its time is asked for, agree with it.
    fn is_out_of_question(&self, upper: f64, scale: Scale) -> bool {
        upper < self.best - scale.alike() || (!self.is_timed && upper <= self.largest + scale.gap(GAP))
    }

    /// Returns the ends of a range, times the sign, in order.
    fn oriented(&self, Range { low, high, .. }: Range) -> [f64; 2] {
        if self.sign > 0.0 { [low, high] } else { [-high, -low] }
    }

    /// Returns the values at both ends of a cell, times the sign.
    fn values(&self, cell: &Cell) -> [f64; 2] {
        [&cell.a, &cell.b].map(|point| self.sign * point.sample.value)
    }

    /// Returns a time (s) towards which the formula grows without bound, if there is one.
    pub fn unbounded(&self) -> Option<f64> {
        self.unbounded
    }

    /// Returns whether it is bounded as far as ranges tell.
    pub fn is_bounded(&self) -> bool {
        self.is_bounded
    }

    /// The largest value: that of an extremum, an edge or an end, unless more was seen than can be of it. Not a number where there is none.
    pub fn value(&self, scale: Scale) -> Estimate {
        let known = self.candidates.iter().filter(|candidate| {
            let is_known = candidate.least >= self.largest || candidate.is_known(scale);
            candidate.kind != CandidateKind::Sample && is_known && candidate.value >= self.largest
        });
        let candidate = known.max_by(|a, b| a.value.total_cmp(&b.value));
        match candidate {
            Some(candidate) if self.best <= candidate.most(scale) + scale.gap(GAP) => {
                Estimate { value: self.sign * candidate.value, error: candidate.error.max(self.unknown) }
            }
            _ => Estimate {
                error: self.best_estimate.error.max(scale.gap(GAP_OF_VALUES)).max(self.unknown),
                ..self.best_estimate
            },
        }
    }

    /// Returns its first time (s).
    pub fn time(&self, scale: Scale) -> Estimate {
        let found = |t: f64, part: f64| Estimate { value: t, error: part * scale.span };
        let Some(first) = self.first(scale) else { return found(self.best_at, TIMES_OF_VALUES) };
        let is_it = |next: &&Candidate| {
            let beside = if first.kind == CandidateKind::Turn { BESIDE } else { FACTOR * SHORTEST };
            let is_behind = next.t > first.t && next.t - first.t <= beside * scale.span;
            next.kind == CandidateKind::Edge && is_behind && next.most(scale) >= first.least
        };
        let candidate = self.alike(scale).find(is_it).unwrap_or(&first);
        match candidate.kind {
            CandidateKind::Edge => {
                Estimate { value: candidate.t, error: f64::max(SHORTEST * scale.span, candidate.time_error) }
            }
            CandidateKind::Turn => found(candidate.t, TIMES),
            CandidateKind::Sample => found(candidate.t, TIMES_OF_VALUES),
        }
    }

    /// Returns the candidates with the largest value.
    fn alike(&self, scale: Scale) -> impl Iterator<Item = &Candidate> {
        let least = self.best - scale.alike();
        self.candidates.iter().filter(move |candidate| candidate.most(scale) >= least)
    }

    /// Returns the first of these.
    fn first(&self, scale: Scale) -> Option<Candidate> {
        let earliest = |known: bool| {
            let those = self.alike(scale).filter(move |candidate| (candidate.kind != CandidateKind::Sample) == known);
            those.min_by(|a, b| a.t.total_cmp(&b.t)).copied()
        };
        earliest(true).or_else(|| earliest(false))
    }

    /// Returns the median distance of values from the largest one, which a pole in the other direction does not distort.
    fn spread(&self, samples: &[Estimate], rounding: f64) -> f64 {
        let distance = |found: &Estimate| ((self.best - self.sign * found.value).abs(), found.error.max(rounding));
        let different =
            samples.iter().map(distance).filter(|(distance, rounding)| distance > rounding && distance.is_finite());
        median(different.map(|(distance, _)| distance).collect())
    }
}

impl IntervalSearch<'_> {
    /// Looks for the extremum in some cells, where some values are known and the formula has a scale.
    pub(super) fn search(
        &mut self,
        cells: &[Cell],
        samples: &[Estimate],
        extremum: &mut Extremum,
        scale: Scale,
    ) -> Scale {
        self.is_timed = extremum.is_timed;
        let mut heap = BinaryHeap::new();
        for cell in cells {
            let open = self.open(cell.clone(), extremum, scale);
            heap.push(open);
        }
        let (mut scale, mut best) = (scale, f64::NAN);
        let mut parts = Vec::new();
        while let Some(open) = heap.pop() {
            self.range = scale.range;
            // the scale follows the best value that is known
            if extremum.best.total_cmp(&best).is_ne() {
                best = extremum.best;
                scale = Scale { range: extremum.spread(samples, scale.gap(0.0)), ..scale };
            }
            if extremum.is_above(open.upper, scale) {
                heap.push(open);
                break;
            }
            if self.notes.are_exhausted() {
                extremum.unknown = f64::max(open.upper - extremum.best, 0.0);
                if extremum.is_timed || extremum.unknown == f64::INFINITY {
                    self.notes.meet(NoValueCause::Unknown(open.cell.a.state.t));
                }
                return scale;
            }
            if self.curve.holds_forces() {
                // more is known of the size of loads by now
                let again = self.open(open.cell.clone(), extremum, scale);
                if again.upper < open.upper {
                    heap.push(again);
                    continue;
                }
            }
            self.look_into(&open, extremum, scale, &mut parts);
            if self.notes.cause.is_some() || extremum.unbounded.is_some() {
                return scale;
            }
            heap.extend(parts.drain(..));
        }
        if extremum.is_timed {
            self.search_in_time(heap.into_vec(), extremum, scale);
        }
        scale
    }

    /// Looks for earlier times with the same value.
    fn search_in_time(&mut self, mut open: Vec<OpenCell>, extremum: &mut Extremum, scale: Scale) {
        open.retain(|open| open.upper >= extremum.best - scale.alike());
        open.sort_by(|a, b| b.cell.a.state.t.total_cmp(&a.cell.a.state.t));
        let mut parts = Vec::new();
        while let Some(next) = open.pop() {
            let first = extremum.first(scale).filter(|first| first.kind != CandidateKind::Sample);
            if self.notes.are_exhausted() {
                self.notes.meet(NoValueCause::Unknown(next.cell.a.state.t));
            }
            if first.is_some_and(|first| first.t <= next.cell.a.state.t) || self.notes.cause.is_some() {
                return;
            }
            if next.upper >= extremum.best - scale.alike() {
                self.look_into(&next, extremum, scale, &mut parts);
                parts.reverse();
                open.append(&mut parts);
            }
        }
    }

    /// Records the values at both ends of a cell.
    fn record_ends(&mut self, cell: &Cell, extremum: &mut Extremum) {
        for (point, other) in [(&cell.a, &cell.b), (&cell.b, &cell.a)] {
            if !point.exists() {
                self.miss(cell.step, point.state.t);
            } else if extremum.sign * point.sample.value > extremum.best && !self.curve.is_at_threshold(point, other) {
                extremum.record(point.state.t, self.curve.estimate(point));
            }
        }
    }

    /// Finds out what is known of the formula in a cell.
    fn open(&mut self, mut cell: Cell, extremum: &mut Extremum, scale: Scale) -> OpenCell {
        let (verdict, range) = self.enclose(&mut cell);
        let is_nothing = matches!(verdict, Verdict::Missing | Verdict::Rounding);
        let mut upper = if is_nothing { f64::NEG_INFINITY } else { extremum.oriented(range)[1] };
        let mut derivatives = [None; 2];
        let is_smooth = verdict == Verdict::Smooth && cell.a.exists() && cell.b.exists();
        if is_smooth && self.curve.derivatives() > 0 && !extremum.is_out_of_question(upper, scale) {
            let first = self.curve.derivative(1);
            let [a, b] = extremum.values(&cell);
            upper = upper.min(between(a, b, extremum.oriented(first), cell.length())[1]);
            let is_open = !first.may_switch && !extremum.is_out_of_question(upper, scale);
            let tells_bends = is_open && self.curve.derivatives() == 2;
            derivatives = [Some(first), tells_bends.then(|| self.curve.derivative(2))];
        }
        // how far off values may be is found with what the ranges were found with
        if verdict != Verdict::Rounding {
            self.record_ends(&cell, extremum);
        } else if extremum.oriented(range)[1] == f64::INFINITY {
            self.record_growth(&cell, extremum, scale);
        }
        OpenCell { cell, verdict, range, derivatives, upper }
    }

    /// Looks into a cell: takes note of the extremum in it, or leaves its parts.
    fn look_into(&mut self, open: &OpenCell, extremum: &mut Extremum, scale: Scale, parts: &mut Vec<OpenCell>) {
        let cell = &open.cell;
        if self.is_shortest(cell) || open.verdict == Verdict::Alike {
            self.close(cell, open.range, extremum, scale);
            return;
        }
        let cells = match open.verdict {
            Verdict::Crosses(guard) => {
                let Some([before, at, behind]) = self.cut_at_crossing(cell, guard) else { return };
                if let Some(mut at) = at {
                    let range = self.enclose(&mut at).1;
                    self.close(&at, range, extremum, scale);
                }
                [before, behind]
            }
            // whatever side it is on, it was on before
            Verdict::Rounding => return,
            Verdict::Missing => {
                self.miss(cell.step, cell.a.state.t);
                return;
            }
            Verdict::Smooth if cell.a.exists() && cell.b.exists() && self.is_done(open, extremum, scale) => return,
            _ => {
                let Some(halves) = self.halve(cell) else { return };
                if cell.length() <= self.short && halves[0].b.exists() {
                    // where rounding alone makes it as large, nothing is found by cutting on
                    let error = self.curve.uncertainty(&halves[0].b);
                    if error >= 0.5 * (open.upper - extremum.best) {
                        self.close(cell, open.range, extremum, scale);
                        return;
                    }
                }
                halves.map(Some)
            }
        };
        for cell in cells.into_iter().flatten() {
            parts.push(self.open(cell, extremum, scale));
        }
    }

    /// Records what is in a cell too short to be cut: an edge to neighbouring times, a cusp, or a pole.
    fn close(&mut self, cell: &Cell, range: Range, extremum: &mut Extremum, scale: Scale) {
        let ends = [&cell.a, &cell.b];
        let sign = extremum.sign;
        for point in ends {
            if !point.exists() {
                self.miss(cell.step, point.state.t);
            }
        }
        let rises = ends.map(|point| sign * point.sample.first);
        let goes_on = (rises[0] > 0.0 && rises[1] > 0.0) || (rises[0] < 0.0 && rises[1] < 0.0);
        let step = (ends[0].sample.value - ends[1].sample.value).abs();
        for (point, other, outward) in [(&cell.a, &cell.b, -1.0), (&cell.b, &cell.a, 1.0)] {
            // a value of its own is that of no side
            let is_apart = self.curve.is_at_threshold(point, other) && step > scale.gap(APART) && {
                let t = point.state.t + outward * FACTOR * self.shortest;
                let beside = self.point_near(cell.step, t);
                beside.is_none_or(|beside| (beside.sample.value - point.sample.value).abs() > scale.gap(APART))
            };
            if !point.exists() || is_apart {
                continue;
            }
            let found = self.curve.estimate(point);
            if goes_on && step <= scale.gap(GAP) {
                extremum.record(point.state.t, found);
            } else {
                let error = cell.length().max(point.shift.time).max(point.crossing_error);
                extremum.note_edge(Estimate { value: point.state.t, error }, found, scale);
            }
        }
        for value in self.curve.between_points(&cell.a, &cell.b) {
            if sign * value >= extremum.best - scale.alike() && self.goes_to(value, cell, scale) {
                let error = cell.length().max(cell.b.shift.time).max(cell.b.crossing_error);
                let at = Estimate { value: cell.b.state.t, error };
                extremum.note_edge(at, Estimate { value, error: KNOWN * value.abs() }, scale);
            }
        }
        // it may end where it has become too large
        let is_beside_hole = cell.a.exists() != cell.b.exists();
        if is_beside_hole || extremum.oriented(range)[1] == f64::INFINITY {
            extremum.is_bounded = false;
            self.record_growth(cell, extremum, scale);
        }
    }

    /// Returns whether a value is what the formula goes to towards a cell, from before or from behind: it comes nearer to that.
    fn goes_to(&mut self, value: f64, cell: &Cell, scale: Scale) -> bool {
        [(&cell.a, -1.0), (&cell.b, 1.0)].into_iter().any(|(point, direction)| {
            self.samples_near(cell.step, point, (direction, cell.length()), scale).is_some_and(|[near, far, _]| {
                let [left, before] = [near, far].map(|found| (found.value - value).abs());
                left <= CONVERGES * before + near.error + far.error
            })
        })
    }

    /// Records a cell of which no range is known, if the formula grows towards it without bound, from before or from behind: it gains no less
    /// from one sample to the next, which come near by equal factors.
    fn record_growth(&mut self, cell: &Cell, extremum: &mut Extremum, scale: Scale) {
        for (point, direction) in [(&cell.a, -1.0), (&cell.b, 1.0)] {
            let Some(candidates) = self.samples_near(cell.step, point, (direction, cell.length()), scale) else {
                continue;
            };
            let gain =
                |near: Estimate, far: Estimate| (extremum.sign * (near.value - far.value), near.error + far.error);
            let ((last, error), (before, error_before)) =
                (gain(candidates[0], candidates[1]), gain(candidates[1], candidates[2]));
            if before > error_before && error <= before && last + error >= CONVERGES * before {
                extremum.unbounded = Some(cell.b.state.t);
            }
        }
    }

    /// Returns whether a smooth cell holds nothing more of interest; what it holds has been noted.
    fn is_done(&mut self, open: &OpenCell, extremum: &mut Extremum, scale: Scale) -> bool {
        match open.derivatives {
            [Some(first), second] => self.is_done_by_slopes(open, [Some(first), second], extremum, scale),
            [None, _] if self.curve.derivatives() == 0 => {
                self.is_done_by_values(&open.cell, open.upper, extremum, scale)
            }
            _ => false,
        }
    }

    /// As [`IntervalSearch::is_done`], by what the formula's derivatives can be in the cell.
    fn is_done_by_slopes(
        &mut self,
        OpenCell { cell, upper, .. }: &OpenCell,
        derivatives: [Option<Range>; 2],
        extremum: &mut Extremum,
        scale: Scale,
    ) -> bool {
        let sign = extremum.sign;
        let [[falls, rises], [bends_down, bends_up]] =
            derivatives.map(|range| range.map_or([f64::NEG_INFINITY, f64::INFINITY], |range| extremum.oriented(range)));
        let [a, b] = extremum.values(cell);
        let turns = sign * cell.a.sample.first > 0.0 && sign * cell.b.sample.first <= 0.0;
        if falls >= 0.0 || rises <= 0.0 {
            if turns {
                // it turns where the cell ends, and falls from there on
                self.note_turn(cell, &cell.b, cell.b.state.t, extremum, scale);
            }
            // an end that is larger than what is certain may be beside a pole
            return f64::max(a, b) <= extremum.best + scale.gap(GAP);
        }
        // what is larger than what is certain may be rounding
        let is_small = *upper <= f64::max(a, b).min(extremum.best) + scale.gap(GAP);
        if extremum.is_out_of_question(*upper, scale) || (is_small && !turns) {
            return true;
        }
        let turns_once = bends_up < 0.0;
        if turns && (is_small || turns_once) {
            self.solve_for_turn(cell, extremum, scale);
        }
        is_small || turns_once || bends_down > 0.0
    }

    /// Returns a zero of the slope, at which the slope times the sign passes from above zero to zero or below, by Newton between bounds.
    fn solve_for_turn(&mut self, cell: &Cell, extremum: &mut Extremum, scale: Scale) {
        let sign = extremum.sign;
        let slope = |point: &Point| sign * point.sample.first;
        let mut within = cell.clone();
        let mut guess = chord(&within, sign);
        let mut top = if sign * cell.a.sample.value > sign * cell.b.sample.value {
            Rc::clone(&cell.a)
        } else {
            Rc::clone(&cell.b)
        };
        for iteration in 0..ITERATIONS {
            let (from, to) = (within.a.state.t, within.b.state.t);
            // where the guesses do not close in the middle does
            let t = if iteration % 3 == 2 || !(guess > from && guess < to) { 0.5 * from + 0.5 * to } else { guess };
            if t <= from || t >= to {
                break;
            }
            let Some(point) = self.point(&within, t) else { break };
            if sign * point.sample.value >= sign * top.sample.value {
                top = Rc::clone(&point);
            }
            let next = t - point.sample.first / point.sample.second;
            guess = if next.is_finite() { next } else { f64::NAN };
            let is_rising = slope(&point) > 0.0;
            let ends = if is_rising { [&point, &within.b] } else { [&within.a, &point] };
            within = within.between(ends[0], ends[1]);
            if !guess.is_finite() {
                guess = chord(&within, sign);
            }
            let is_inside = guess > within.a.state.t && guess < within.b.state.t;
            let is_close = is_inside && (guess - t).abs() <= CERTAIN * scale.span;
            if is_close || within.length() <= CERTAIN * scale.span {
                break;
            }
        }
        // its time is where the slope turns, whatever the last digits of the values say
        let is_inside = guess > within.a.state.t && guess < within.b.state.t;
        let turn = if is_inside { guess } else { within.b.state.t };
        self.note_turn(cell, &top, turn, extremum, scale);
    }

    /// Records a turn at a time (s), near a point.
    fn note_turn(&mut self, cell: &Cell, near: &Point, t: f64, extremum: &mut Extremum, scale: Scale) {
        let error = self.curve.uncertainty(near);
        let settled = self.settled_turn(cell.step, &near.state, t, scale.span);
        let [t, value] = settled.unwrap_or([t, near.sample.value]);
        let value = extremum.sign * value;
        extremum.add(
            Candidate { t, time_error: 0.0, value, error, least: value - error, kind: CandidateKind::Turn },
            scale,
        );
    }

    /// The time (s) and the value of a turn that is near a state and a time, as they are whichever path led there; `None` where it does not settle, or
    /// beyond an edge.
    fn settled_turn(&mut self, step: usize, near: &State, t: f64, span: f64) -> Option<[f64; 2]> {
        if !self.curve.settles() {
            return None;
        }
        let mut turn = Settling::near(t, span, self.curve.derivatives() == 2)?;
        let mut samples = [Sampled::NOTHING; MOST_LOOKS];
        loop {
            for (look, sample) in samples.iter_mut().enumerate().take(turn.looks()) {
                let (t, step_here) = (turn.time(look), &self.steps[step]);
                let is_before = step_here.begins_at_edge && t < step_here.from.t;
                let is_behind = step_here.ends_at_edge && t > step_here.to.t;
                if is_before || is_behind {
                    return None;
                }
                let state = self.settled(step, near, t)?;
                *sample = self.at(step, state).sample;
            }
            match turn.go_on(&samples[..turn.looks()]) {
                Turning::On => {}
                Turning::Settled(found @ [t, _]) => {
                    let [from, to] = self.window;
                    return (from <= t && t <= to).then_some(found);
                }
                Turning::Lost => return None,
            }
        }
    }

    /// Returns whether a cell whose values are no larger than `upper` holds hardly more than the larger of its ends, which is noted then with the
    /// top beside it: all that is known of a formula without derivatives.
    fn is_done_by_values(&mut self, cell: &Cell, upper: f64, extremum: &mut Extremum, scale: Scale) -> bool {
        let [a, b] = extremum.values(cell);
        let is_small = upper <= f64::max(a, b).min(extremum.best) + scale.gap(GAP_OF_VALUES);
        if is_small && f64::max(a, b) >= extremum.best - scale.alike() {
            let (point, value) = if b > a { (&cell.b, b) } else { (&cell.a, a) };
            let error = scale.gap(GAP_OF_VALUES);
            let t = point.state.t;
            extremum
                .add(Candidate { t, time_error: 0.0, value, error, least: value, kind: CandidateKind::Sample }, scale);
            if let Some(top) = self.top_beside(cell, point, extremum.sign, scale) {
                extremum.add(top, scale);
            }
        }
        is_small
    }

    /// The top beside one of the ends of a cell; `None` where it lies farther away, where another cell has it. It is that of a parabola through
    /// three points, as far apart as these ends at first, and then ever closer.
    fn top_beside(&mut self, cell: &Cell, near: &Rc<Point>, sign: f64, scale: Scale) -> Option<Candidate> {
        let [from, to] = [&self.steps[cell.step].from, &self.steps[cell.step].to].map(|state| state.t);
        let (mut t, mut apart) = (near.state.t, cell.length());
        let (rounding, finest) = (scale.gap(0.0), FINEST * scale.span);
        for fit in 0.. {
            let h = apart.min(0.5 * (to - from));
            let center = t.clamp(from + h, (to - h).max(from + h));
            let [before, middle, behind] = self.values_at(cell.step, [center - h, center, center + h], sign)?;
            let (rise, bend) = (0.5 * (behind - before), behind - 2.0 * middle + before);
            if bend >= -rounding {
                // it rests, or goes on as it comes
                if fit == 0 && rise.abs() > rounding {
                    return None;
                }
                break;
            }
            let offset = -rise / bend;
            if offset.abs() > FARTHEST {
                return None;
            }
            t = (center + offset * h).clamp(from, to);
            if apart <= finest {
                break;
            }
            apart = finest.max(CLOSER * apart);
        }
        let [value] = self.values_at(cell.step, [t], sign)?;
        let error = scale.gap(GAP_OF_VALUES);
        Some(Candidate { t, time_error: 0.0, value, error, least: value, kind: CandidateKind::Turn })
    }

    /// The formula at some times (s) of a step, times the sign.
    fn values_at<const N: usize>(&mut self, step: usize, times: [f64; N], sign: f64) -> Option<[f64; N]> {
        let [from, to] = [&self.steps[step].from, &self.steps[step].to].map(|state| state.t);
        let mut values = [0.0; N];
        for (value, t) in values.iter_mut().zip(times) {
            *value = sign * self.point_of_step(step, t.clamp(from, to))?.sample.value;
        }
        Some(values)
    }
}

/// Returns the time (s) at which the straight line through the slopes at both ends of a cell is zero.
fn chord(cell: &Cell, sign: f64) -> f64 {
    let [a, b] = [&cell.a, &cell.b].map(|point| sign * point.sample.first);
    cell.a.state.t + cell.length() * a / (a - b)
}
