//! The largest value of a formula and its first time, by branch and bound.
//!
//! The cell with the largest upper bound comes first: it is divided where a guard crosses its threshold, or in halves, until the formula is
//! monotone in it, or until its slope has a single zero there, which is then solved for. Cells that cannot improve the best value are never
//! divided, so that a pole in the other direction costs nothing and hides nothing.

use super::curve::{Cell, Estimate, Point, Verdict};
use super::extremum_refinement::{CELL, MOST_LOOKS, Sampled, Settling, Turning};
use super::interval_search::{IntervalSearch, NoValueCause, Ranked, Scale};
use crate::analysis::state::State;
use crate::limits::curve::KNOWN;
use crate::limits::extremum::{APART, TIMES};
use crate::limits::interval_search::{FACTOR, LEAST_GROWTH, SHORTEST};
use mechc_expr::math::{between, enclose_root, median, power_of_two_below};
use mechc_ir::program::Range;
use std::collections::BinaryHeap;
use std::rc::Rc;

/// A cell that can improve the extremum by at most this part of the range is not divided.
const GAP: f64 = 1e-11;
/// The vertex of a parabola through three points is accepted up to this many point distances from the middle point.
const FARTHEST: f64 = 2.0;
/// Factor by which the three points approach each other in each step.
const CLOSER: f64 = 0.1;
/// Smallest distance of the three points, as a part of the span.
const FINEST: f64 = 1e-4;
/// Bound like `TIMES` for a formula whose slope is unknown.
const TIMES_OF_VALUES: f64 = 1e-6;

/// The search for the largest value of a formula or, by its negative, for the least.
#[derive(Clone, Debug)]
pub(super) struct Extremum {
    /// 1, or −1 for the least value.
    sign: f64,
    /// True if the time of the extremum is requested.
    pub is_timed: bool,
    /// A lower bound of the largest value, times the sign.
    best: f64,
    /// The estimate that this bound comes from.
    best_estimate: Estimate,
    /// The time (s) of this estimate.
    best_at: f64,
    /// The candidates: extrema, edges and ends, with their values times the sign.
    candidates: Vec<Candidate>,
    /// The largest lower bound of a candidate that is not a sample, times the sign.
    largest: f64,
    /// A time (s) towards which the formula grows without bound.
    pub unbounded: Option<f64>,
    /// False if the range of a shortest cell is infinite, or one of its ends has no value.
    pub is_bounded: bool,
    /// A bound of how far the extremum may exceed the best value, if the search was not finished.
    excess: f64,
}

#[derive(Clone, Copy, Debug)]
struct Candidate {
    t: f64,
    /// A bound of the error of the time (s) of an edge.
    time_error: f64,
    value: f64,
    /// A bound of the error of the value.
    error: f64,
    /// A lower bound of the value.
    lower: f64,
    kind: CandidateKind,
}

impl Candidate {
    /// Returns whether the error is small, relative to the range of the formula.
    fn is_accurate(&self, scale: Scale) -> bool {
        self.error <= scale.gap(APART)
    }

    /// Returns an upper bound of the value; its lower bound if the value is inaccurate.
    fn upper(&self, scale: Scale) -> f64 {
        if self.is_accurate(scale) { self.value + self.error } else { self.lower }
    }
}

/// The kind of a candidate, which decides how accurate its time is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum CandidateKind {
    Edge,
    /// A zero of the slope.
    Turn,
    /// The largest sample of a formula without an available slope.
    Sample,
}

/// A cell that has not been searched yet, with the bounds of the formula in it.
struct OpenCell {
    cell: Cell,
    verdict: Verdict,
    range: Range,
    /// The ranges of the first and second derivative, if the cell is smooth and they matter.
    derivatives: [Option<Range>; 2],
    /// The largest value that the cell may hold, times the sign.
    upper: f64,
}

impl OpenCell {
    /// Ranks the cell by the largest value that it may hold.
    fn ranked(self) -> Ranked<OpenCell> {
        Ranked { rank: self.upper, t: self.cell.a.state.t, item: self }
    }
}

impl Extremum {
    pub fn new(largest: bool) -> Extremum {
        let sign = if largest { 1.0 } else { -1.0 };
        Extremum {
            sign,
            is_timed: false,
            best: f64::NEG_INFINITY,
            best_estimate: Estimate::NOTHING,
            best_at: f64::NAN,
            candidates: Vec::new(),
            largest: f64::NEG_INFINITY,
            unbounded: None,
            is_bounded: true,
            excess: 0.0,
        }
    }

    /// Records a value at a time (s).
    fn record(&mut self, t: f64, estimate: Estimate) {
        if self.sign * estimate.value - estimate.error > self.best {
            (self.best, self.best_estimate, self.best_at) = (self.sign * estimate.value - estimate.error, estimate, t);
        }
    }

    /// Adds an edge or an end of the window as a candidate, with the estimates of its time (s) and its value.
    pub fn note_edge(&mut self, at: Estimate, Estimate { value, error }: Estimate, scale: Scale) {
        let (value, t, time_error) = (self.sign * value, at.value, at.error);
        self.add(Candidate { t, time_error, value, error, lower: value - error, kind: CandidateKind::Edge }, scale);
    }

    fn add(&mut self, candidate: Candidate, scale: Scale) {
        if !candidate.value.is_finite() {
            return;
        }
        self.record(
            candidate.t,
            Estimate { value: self.sign * candidate.value, error: candidate.value - candidate.lower },
        );
        if candidate.upper(scale) < self.best - scale.tolerance() {
            return;
        }
        // a sample does not displace others: a better candidate may be found near it
        if candidate.kind != CandidateKind::Sample && candidate.lower > self.largest {
            self.largest = candidate.lower;
            let least = candidate.value - scale.tolerance();
            self.candidates.retain(|other| other.upper(scale) >= least);
        }
        self.candidates.push(candidate);
    }

    /// Returns whether no value up to `upper` can improve the extremum noticeably.
    fn is_above(&self, upper: f64, scale: Scale) -> bool {
        let gap = scale.gap(GAP);
        upper < self.best - scale.tolerance() - gap || upper <= self.largest + gap
    }

    /// Returns whether no value up to `upper` can be the extremum, or agree with it if its time is requested.
    fn is_irrelevant(&self, upper: f64, scale: Scale) -> bool {
        upper < self.best - scale.tolerance() || (!self.is_timed && upper <= self.largest + scale.gap(GAP))
    }

    /// Returns the ends of a range times the sign, in ascending order.
    fn oriented(&self, Range { low, high, .. }: Range) -> [f64; 2] {
        if self.sign > 0.0 { [low, high] } else { [-high, -low] }
    }

    /// Returns the values at both ends of a cell, times the sign.
    fn values(&self, cell: &Cell) -> [f64; 2] {
        [&cell.a, &cell.b].map(|point| self.sign * point.sample.value)
    }

    /// Returns the largest value: that of a turn, an edge or an end, unless a sample exceeds it by more than its error. NaN if the formula has
    /// no value.
    pub fn value(&self, scale: Scale) -> Estimate {
        let reliable = self.candidates.iter().filter(|candidate| {
            let is_accurate = candidate.lower >= self.largest || candidate.is_accurate(scale);
            candidate.kind != CandidateKind::Sample && is_accurate && candidate.value >= self.largest
        });
        let candidate = reliable.max_by(|a, b| a.value.total_cmp(&b.value));
        match candidate {
            Some(candidate) if self.best <= candidate.upper(scale) + scale.gap(GAP) => {
                Estimate { value: self.sign * candidate.value, error: candidate.error.max(self.excess) }
            }
            _ => Estimate {
                error: self.best_estimate.error.max(scale.tolerance()).max(self.excess),
                ..self.best_estimate
            },
        }
    }

    /// Returns the first time (s) of the largest value.
    pub fn time(&self, scale: Scale) -> Estimate {
        let estimate = |t: f64, part: f64| Estimate { value: t, error: part * scale.span };
        let Some(first) = self.first(scale) else { return estimate(self.best_at, TIMES_OF_VALUES) };
        let is_it = |next: &&Candidate| {
            // the refinement of a turn does not tell it from an edge that is closer than a cell of its grid
            let distance = if first.kind == CandidateKind::Turn { CELL } else { FACTOR * SHORTEST };
            let is_behind = next.t > first.t && next.t - first.t <= distance * scale.span;
            next.kind == CandidateKind::Edge && is_behind && next.upper(scale) >= first.lower
        };
        let candidate = self.tied(scale).find(is_it).unwrap_or(&first);
        match candidate.kind {
            CandidateKind::Edge => {
                Estimate { value: candidate.t, error: f64::max(SHORTEST * scale.span, candidate.time_error) }
            }
            CandidateKind::Turn => estimate(candidate.t, TIMES),
            CandidateKind::Sample => estimate(candidate.t, TIMES_OF_VALUES),
        }
    }

    /// Returns the candidates with the largest value.
    fn tied(&self, scale: Scale) -> impl Iterator<Item = &Candidate> {
        let least = self.best - scale.tolerance();
        self.candidates.iter().filter(move |candidate| candidate.upper(scale) >= least)
    }

    /// Returns the earliest candidate with the largest value, which is a sample only if no other candidate has that value.
    fn first(&self, scale: Scale) -> Option<Candidate> {
        let earliest = |is_sample: bool| {
            let those =
                self.tied(scale).filter(move |candidate| (candidate.kind == CandidateKind::Sample) == is_sample);
            those.min_by(|a, b| a.t.total_cmp(&b.t)).copied()
        };
        earliest(false).or_else(|| earliest(true))
    }

    /// Returns the median distance of samples from the largest value, which a pole in the other direction does not distort.
    fn spread(&self, samples: &[Estimate], rounding: f64) -> f64 {
        let distance = |sample: &Estimate| ((self.best - self.sign * sample.value).abs(), sample.error.max(rounding));
        let different =
            samples.iter().map(distance).filter(|(distance, rounding)| distance > rounding && distance.is_finite());
        median(different.map(|(distance, _)| distance).collect())
    }
}

impl IntervalSearch<'_> {
    /// Searches cells for the extremum of a formula with some samples and a scale. Returns the scale that the search ended with.
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
            heap.push(self.open(cell.clone(), extremum, scale).ranked());
        }
        let (mut scale, mut best) = (scale, f64::NAN);
        let mut parts = Vec::new();
        while let Some(Ranked { item: open, .. }) = heap.pop() {
            self.range = scale.range;
            // the scale follows the best value so far
            if extremum.best.total_cmp(&best).is_ne() {
                best = extremum.best;
                scale = Scale { range: extremum.spread(samples, scale.gap(0.0)), ..scale };
            }
            if extremum.is_above(open.upper, scale) {
                heap.push(open.ranked());
                break;
            }
            if self.notes.are_exhausted() {
                extremum.excess = f64::max(open.upper - extremum.best, 0.0);
                if extremum.is_timed || extremum.excess == f64::INFINITY {
                    self.notes.fail(NoValueCause::Unknown(open.cell.a.state.t));
                }
                return scale;
            }
            if self.curve.holds_forces {
                // the magnitudes of loads may have grown since the cell was opened, which narrows its bounds
                let reopened = self.open(open.cell.clone(), extremum, scale);
                if reopened.upper < open.upper {
                    heap.push(reopened.ranked());
                    continue;
                }
            }
            self.search_cell(&open, extremum, scale, &mut parts);
            if self.notes.cause.is_some() || extremum.unbounded.is_some() {
                return scale;
            }
            heap.extend(parts.drain(..).map(OpenCell::ranked));
        }
        if extremum.is_timed {
            self.search_earlier(heap.into_iter().map(|open| open.item).collect(), extremum, scale);
        }
        scale
    }

    /// Searches the remaining cells for earlier times with the same value.
    fn search_earlier(&mut self, mut open: Vec<OpenCell>, extremum: &mut Extremum, scale: Scale) {
        open.retain(|open| open.upper >= extremum.best - scale.tolerance());
        open.sort_by(|a, b| b.cell.a.state.t.total_cmp(&a.cell.a.state.t));
        let mut parts = Vec::new();
        while let Some(next) = open.pop() {
            let first = extremum.first(scale).filter(|first| first.kind != CandidateKind::Sample);
            if self.notes.are_exhausted() {
                self.notes.fail(NoValueCause::Unknown(next.cell.a.state.t));
            }
            if first.is_some_and(|first| first.t <= next.cell.a.state.t) || self.notes.cause.is_some() {
                return;
            }
            if next.upper >= extremum.best - scale.tolerance() {
                self.search_cell(&next, extremum, scale, &mut parts);
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

    /// Bounds the formula in a cell, and records the values at its ends.
    fn open(&mut self, mut cell: Cell, extremum: &mut Extremum, scale: Scale) -> OpenCell {
        let (verdict, range) = self.enclose(&mut cell);
        let is_nothing = matches!(verdict, Verdict::Missing | Verdict::Rounding);
        let mut upper = if is_nothing { f64::NEG_INFINITY } else { extremum.oriented(range)[1] };
        let mut derivatives = [None; 2];
        let is_smooth = verdict == Verdict::Smooth && cell.a.exists() && cell.b.exists();
        if is_smooth && self.curve.derivatives() > 0 && !extremum.is_irrelevant(upper, scale) {
            let first = self.curve.derivative(1);
            let [a, b] = extremum.values(&cell);
            upper = upper.min(between(a, b, extremum.oriented(first), cell.length())[1]);
            let is_open = !first.may_switch && !extremum.is_irrelevant(upper, scale);
            let has_second = is_open && self.curve.derivatives() == 2;
            derivatives = [Some(first), has_second.then(|| self.curve.derivative(2))];
        }
        // the errors of the ends overwrite the ranges, which are no longer needed here
        if verdict != Verdict::Rounding {
            self.record_ends(&cell, extremum);
        } else if extremum.oriented(range)[1] == f64::INFINITY {
            self.record_growth(&cell, extremum, scale);
        }
        OpenCell { cell, verdict, range, derivatives, upper }
    }

    /// Searches a cell: records the extremum in it, or adds its parts to `parts`.
    fn search_cell(&mut self, open: &OpenCell, extremum: &mut Extremum, scale: Scale, parts: &mut Vec<OpenCell>) {
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
            // rounding alone selects a side, whose values occur in other cells
            Verdict::Rounding => return,
            Verdict::Missing => {
                self.miss(cell.step, cell.a.state.t);
                return;
            }
            Verdict::Smooth if cell.a.exists() && cell.b.exists() && self.is_done(open, extremum, scale) => return,
            _ => {
                let Some(halves) = self.halve(cell) else { return };
                if cell.length() <= self.short && halves[0].b.exists() {
                    // if rounding alone makes the upper bound as large, smaller cells do not lower it
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

    /// Records the contents of a cell that is too short to be divided: an edge, a cusp, or a pole.
    fn close(&mut self, cell: &Cell, range: Range, extremum: &mut Extremum, scale: Scale) {
        let ends = [&cell.a, &cell.b];
        let sign = extremum.sign;
        for point in ends {
            if !point.exists() {
                self.miss(cell.step, point.state.t);
            }
        }
        let slopes = ends.map(|point| sign * point.sample.first);
        let is_monotone = (slopes[0] > 0.0 && slopes[1] > 0.0) || (slopes[0] < 0.0 && slopes[1] < 0.0);
        let step = (ends[0].sample.value - ends[1].sample.value).abs();
        for (point, other, outward) in [(&cell.a, &cell.b, -1.0), (&cell.b, &cell.a, 1.0)] {
            // a value at the threshold that belongs to neither side does not count
            let is_apart = self.curve.is_at_threshold(point, other) && step > scale.gap(APART) && {
                let t = point.state.t + outward * FACTOR * self.shortest;
                let adjacent = self.point_near(cell.step, t);
                adjacent.is_none_or(|adjacent| (adjacent.sample.value - point.sample.value).abs() > scale.gap(APART))
            };
            if !point.exists() || is_apart {
                continue;
            }
            let estimate = self.curve.estimate(point);
            if is_monotone && step <= scale.gap(GAP) {
                extremum.record(point.state.t, estimate);
            } else {
                let error = cell.length().max(point.shift.time).max(point.crossing_error);
                extremum.note_edge(Estimate { value: point.state.t, error }, estimate, scale);
            }
        }
        for value in self.curve.between_points(&cell.a, &cell.b) {
            if sign * value >= extremum.best - scale.tolerance() && self.converges_to(value, cell, scale) {
                let error = cell.length().max(cell.b.shift.time).max(cell.b.crossing_error);
                let at = Estimate { value: cell.b.state.t, error };
                extremum.note_edge(at, Estimate { value, error: KNOWN * value.abs() }, scale);
            }
        }
        // the values may end where they overflow
        let is_at_hole = cell.a.exists() != cell.b.exists();
        if is_at_hole || extremum.oriented(range)[1] == f64::INFINITY {
            extremum.is_bounded = false;
            self.record_growth(cell, extremum, scale);
        }
    }

    /// Returns whether the formula converges to a value towards a cell, from before or from behind.
    fn converges_to(&mut self, value: f64, cell: &Cell, scale: Scale) -> bool {
        [(&cell.a, -1.0), (&cell.b, 1.0)].into_iter().any(|(point, direction)| {
            self.samples_near(cell.step, point, direction, cell.length(), scale).is_some_and(|[near, far, _]| {
                let [remaining, before] = [near, far].map(|sample| (sample.value - value).abs());
                remaining <= before / LEAST_GROWTH + near.error + far.error
            })
        })
    }

    /// Records a cell with an infinite range if the formula grows towards it without bound, from before or from behind: its gain from one sample
    /// to the next does not shrink, while their distances from the cell shrink by equal factors.
    fn record_growth(&mut self, cell: &Cell, extremum: &mut Extremum, scale: Scale) {
        for (point, direction) in [(&cell.a, -1.0), (&cell.b, 1.0)] {
            let samples = self.samples_near(cell.step, point, direction, cell.length(), scale);
            let Some([near, middle, far]) = samples else { continue };
            let gain =
                |near: Estimate, far: Estimate| (extremum.sign * (near.value - far.value), near.error + far.error);
            let ((last, error), (before, error_before)) = (gain(near, middle), gain(middle, far));
            if before > error_before && error <= before && last + error >= before / LEAST_GROWTH {
                extremum.unbounded = Some(cell.b.state.t);
            }
        }
    }

    /// Returns whether a smooth cell need not be divided; its extremum has then been recorded.
    fn is_done(&mut self, open: &OpenCell, extremum: &mut Extremum, scale: Scale) -> bool {
        match open.derivatives {
            [Some(first), second] => self.is_done_by_slopes(open, [Some(first), second], extremum, scale),
            [None, _] if self.curve.derivatives() == 0 => {
                self.is_done_by_values(&open.cell, open.upper, extremum, scale)
            }
            _ => false,
        }
    }

    /// Returns [`IntervalSearch::is_done`] by the ranges of the formula's derivatives in the cell.
    fn is_done_by_slopes(
        &mut self,
        OpenCell { cell, upper, .. }: &OpenCell,
        derivatives: [Option<Range>; 2],
        extremum: &mut Extremum,
        scale: Scale,
    ) -> bool {
        let sign = extremum.sign;
        let [[slope_low, slope_high], [second_low, second_high]] =
            derivatives.map(|range| range.map_or([f64::NEG_INFINITY, f64::INFINITY], |range| extremum.oriented(range)));
        let [a, b] = extremum.values(cell);
        let turns = sign * cell.a.sample.first > 0.0 && sign * cell.b.sample.first <= 0.0;
        if slope_low >= 0.0 || slope_high <= 0.0 {
            if turns {
                // the turn is at the end of the cell
                self.note_turn(cell, &cell.b, cell.b.state.t, extremum, scale);
            }
            // an end that exceeds the best lower bound may be close to a pole
            return f64::max(a, b) <= extremum.best + scale.gap(GAP);
        }
        // an end that exceeds the best lower bound may do so by rounding
        let is_small = *upper <= f64::max(a, b).min(extremum.best) + scale.gap(GAP);
        if extremum.is_irrelevant(*upper, scale) || (is_small && !turns) {
            return true;
        }
        let turns_once = second_high < 0.0;
        if turns && (is_small || turns_once) {
            self.solve_for_turn(cell, extremum, scale);
        }
        is_small || turns_once || second_low > 0.0
    }

    /// Finds and records the time at which the slope times the sign falls through zero in a cell.
    fn solve_for_turn(&mut self, cell: &Cell, extremum: &mut Extremum, scale: Scale) {
        let sign = extremum.sign;
        let mut within = cell.clone();
        let ends = [&cell.a, &cell.b].map(|end| [end.state.t, end.sample.first.abs()]);
        // a peak may be narrower than any part of the span; where the motion cannot be solved for, the narrowest cell so far counts
        let _ = enclose_root(ends, power_of_two_below(self.shortest), |t| {
            let point = self.point(&within, t)?;
            let (is_behind, slope) = (sign * point.sample.first <= 0.0, point.sample.first.abs());
            *if is_behind { &mut within.b } else { &mut within.a } = point;
            Some((is_behind, slope))
        });
        let [a, b] = extremum.values(&within);
        // the slope defines the time: values near the top differ by rounding only
        let turn = chord(&within, sign).max(within.a.state.t).min(within.b.state.t);
        self.note_turn(cell, if a > b { &within.a } else { &within.b }, turn, extremum, scale);
    }

    /// Adds a turn at a time (s) near a point as a candidate.
    fn note_turn(&mut self, cell: &Cell, near: &Point, t: f64, extremum: &mut Extremum, scale: Scale) {
        let error = self.curve.uncertainty(near);
        let refined = self.refined_turn(cell.step, &near.state, t, scale.span);
        let [t, value] = refined.unwrap_or([t, near.sample.value]);
        let (value, kind) = (extremum.sign * value, CandidateKind::Turn);
        extremum.add(Candidate { t, time_error: 0.0, value, error, lower: value - error, kind }, scale);
    }

    /// Returns the time (s) and the value of a turn near a state and a time, refined on a grid so that they do not depend on the start; `None` if
    /// the refinement does not converge or leaves the step beyond an edge.
    fn refined_turn(&mut self, step: usize, near: &State, t: f64, span: f64) -> Option<[f64; 2]> {
        if !self.curve.settles() {
            return None;
        }
        let mut turn = Settling::near(t, span, self.curve.derivatives() == 2)?;
        let mut samples = [Sampled::NOTHING; MOST_LOOKS];
        loop {
            for (look, sample) in samples.iter_mut().enumerate().take(turn.looks()) {
                let (t, segment) = (turn.time(look), &self.steps[step]);
                let is_before = segment.begins_at_edge && t < segment.from.t;
                let is_behind = segment.ends_at_edge && t > segment.to.t;
                if is_before || is_behind {
                    return None;
                }
                let state = self.settled(step, near, t)?;
                *sample = self.at(step, state).sample;
            }
            match turn.go_on(&samples[..turn.looks()]) {
                Turning::On => {}
                Turning::Settled(extremum @ [t, _]) => {
                    let [from, to] = self.window;
                    return (from <= t && t <= to).then_some(extremum);
                }
                Turning::Lost => return None,
            }
        }
    }

    /// Returns whether a formula without derivatives exceeds the larger end of a cell by no more than the gap. If that end may be the extremum,
    /// records it and the top near it.
    fn is_done_by_values(&mut self, cell: &Cell, upper: f64, extremum: &mut Extremum, scale: Scale) -> bool {
        let [a, b] = extremum.values(cell);
        let is_small = upper <= f64::max(a, b).min(extremum.best) + scale.tolerance();
        if is_small && f64::max(a, b) >= extremum.best - scale.tolerance() {
            let (point, value) = if b > a { (&cell.b, b) } else { (&cell.a, a) };
            let (t, error, kind) = (point.state.t, scale.tolerance(), CandidateKind::Sample);
            extremum.add(Candidate { t, time_error: 0.0, value, error, lower: value, kind }, scale);
            if let Some(top) = self.top_near(cell, point, extremum.sign, scale) {
                extremum.add(top, scale);
            }
        }
        is_small
    }

    /// Returns the top near one of the ends of a cell, or `None` if it is farther away, in another cell. It is the vertex of a parabola through
    /// three points, whose distance is the length of the cell at first and then decreases.
    fn top_near(&mut self, cell: &Cell, near: &Rc<Point>, sign: f64, scale: Scale) -> Option<Candidate> {
        let [from, to] = [&self.steps[cell.step].from, &self.steps[cell.step].to].map(|state| state.t);
        let (mut t, mut distance) = (near.state.t, cell.length());
        let (rounding, finest) = (scale.gap(0.0), FINEST * scale.span);
        for fit in 0.. {
            let h = distance.min(0.5 * (to - from));
            let center = t.clamp(from + h, (to - h).max(from + h));
            let [before, middle, behind] = self.values_at(cell.step, [center - h, center, center + h], sign)?;
            let (rise, curvature) = (0.5 * (behind - before), behind - 2.0 * middle + before);
            if curvature >= -rounding {
                // the values are constant or on a straight line
                if fit == 0 && rise.abs() > rounding {
                    return None;
                }
                break;
            }
            let offset = -rise / curvature;
            if offset.abs() > FARTHEST {
                return None;
            }
            t = (center + offset * h).clamp(from, to);
            if distance <= finest {
                break;
            }
            distance = finest.max(CLOSER * distance);
        }
        let [value] = self.values_at(cell.step, [t], sign)?;
        let error = scale.tolerance();
        Some(Candidate { t, time_error: 0.0, value, error, lower: value, kind: CandidateKind::Turn })
    }

    /// Returns the values at some times (s) of a step, times the sign, or `None` if a state cannot be solved for.
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
