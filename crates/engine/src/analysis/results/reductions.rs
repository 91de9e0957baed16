//! A formula along the whole motion, and its requested reductions.

use super::Request;
use super::curve::{Cell, Curve, Estimate, Point};
use super::extremum::Extremum;
use super::interval_search::{IntervalSearch, NoValueCause, Notes, Scale};
use super::magnitudes::Largest;
use super::quadrature::Integral;
use super::state_sampler::StateSampler;
use crate::analysis::follow::SmoothSegment;
use crate::analysis::state::{State, shortly_after};
use crate::limits::curve::ROUNDING;
use crate::limits::extremum::{APART, TIMES};
use crate::limits::interval_search::{FACTOR, SHORTEST};
use mechc_expr::math::median;
use mechc_ir::ReductionKind;
use std::rc::Rc;

/// Larger values overflow.
const LARGEST: f64 = 1e300;

/// A formula in a window of the motion, and its reductions.
pub(super) struct FormulaReductions {
    pub curve: Curve,
    /// The first and the last time (s).
    pub window: [f64; 2],
    extrema: [Option<Extremum>; 2],
    integral: Option<Integral>,
    /// The findings of the two extrema and of the integral, in this order.
    notes: [Notes; 3],
    /// The values that are requested at single times.
    times: Vec<RequestedValue>,
    /// The values at the ends of steps.
    samples: Vec<Estimate>,
    /// The scales that the searches for the extrema ended with.
    scales: [Option<Scale>; 2],
}

/// A value that is requested at a time (s).
struct RequestedValue {
    t: f64,
    /// The formula at the time, once the motion has reached it.
    point: Option<Rc<Point>>,
    estimate: Estimate,
}

impl FormulaReductions {
    pub fn new(curve: Curve, window: [f64; 2]) -> FormulaReductions {
        FormulaReductions {
            curve,
            window,
            extrema: [None, None],
            integral: None,
            times: Vec::new(),
            samples: Vec::new(),
            scales: [None, None],
            notes: [Notes::default(); 3],
        }
    }

    /// Adds a reduction.
    pub fn request(&mut self, request: &Request) {
        let ([from, to], is_moment) = (self.window, self.is_moment());
        let mut time = |t: f64| {
            if self.times.iter().all(|other| other.t.total_cmp(&t).is_ne()) {
                self.times.push(RequestedValue { t, point: None, estimate: Estimate::NOTHING });
            }
        };
        match request.kind {
            // in a window of a single time these reductions are the value
            ReductionKind::Extreme { .. } | ReductionKind::Mean if is_moment => time(from),
            ReductionKind::Extreme { largest, when } => {
                let extremum = self.extrema[usize::from(largest)].get_or_insert_with(|| Extremum::new(largest));
                extremum.is_timed |= when;
            }
            ReductionKind::Integral if is_moment => {}
            ReductionKind::Mean | ReductionKind::Integral => self.integral = Some(Integral::default()),
            ReductionKind::First => time(from),
            ReductionKind::Last => time(to),
            ReductionKind::At(_) => time(request.at),
        }
    }

    /// Returns whether the window is a single time.
    fn is_moment(&self) -> bool {
        self.window[1] <= self.window[0]
    }

    /// Returns the estimate of a reduction, or why it has no value.
    pub fn outcome(&self, &Request { kind, at, .. }: &Request) -> Result<Estimate, NoValueCause> {
        let [from, to] = self.window;
        if let Some(cause) = self.notes_of(kind).and_then(|notes| notes.cause) {
            return Err(cause);
        }
        let of_time = |t: f64| {
            let estimate =
                self.times.iter().find(|request| request.t.total_cmp(&t).is_eq()).map(|request| request.estimate);
            let estimate = estimate.filter(|estimate| estimate.value.is_finite() && estimate.error < f64::INFINITY);
            let estimate = estimate.ok_or(NoValueCause::Missing(t))?;
            let scale = self.scale(0.0);
            // an exact zero is certain
            let is_uncertain = estimate.value != 0.0 && self.is_uncertain(estimate, scale.range, scale);
            if is_uncertain { Err(NoValueCause::Unknown(t)) } else { Ok(estimate) }
        };
        match kind {
            ReductionKind::Extreme { when: true, .. } if self.is_moment() => {
                of_time(from).map(|_| Estimate { value: from, error: 0.0 })
            }
            ReductionKind::Extreme { .. } | ReductionKind::Mean if self.is_moment() => of_time(from),
            ReductionKind::Integral if self.is_moment() => Ok(Estimate { value: 0.0, error: 0.0 }),
            ReductionKind::Extreme { largest, when } => {
                let which = usize::from(largest);
                let (Some(extremum), Some(scale)) = (&self.extrema[which], self.scales[which]) else {
                    return Err(NoValueCause::Nowhere(from));
                };
                if let Some(t) = extremum.unbounded {
                    return Err(NoValueCause::Unbounded(t));
                }
                let value = extremum.value(scale);
                if !value.value.is_finite() {
                    return Err(NoValueCause::Nowhere(from));
                }
                if value.value.abs() > LARGEST || self.is_uncertain(value, scale.range, scale) {
                    // growth without bound may be hidden by rounding
                    let why = if extremum.is_bounded { NoValueCause::Unknown } else { NoValueCause::Unbounded };
                    return Err(why(extremum.time(scale).value));
                }
                let estimate = if when { extremum.time(scale) } else { value };
                // rounding alone may decide at which of several times the extremum is
                let is_certain = !when || estimate.error < f64::INFINITY;
                if is_certain { Ok(estimate) } else { Err(NoValueCause::Unknown(estimate.value)) }
            }
            ReductionKind::Mean | ReductionKind::Integral => {
                let integral = self.integral.as_ref().filter(|integral| integral.time > 0.0);
                let Some(integral) = integral else { return Err(NoValueCause::Nowhere(from)) };
                if let Some(t) = integral.unbounded() {
                    return Err(NoValueCause::Unbounded(t));
                }
                let divisor = if kind == ReductionKind::Mean { integral.time } else { 1.0 };
                let estimate = integral.estimate();
                let mean = Estimate { value: estimate.value / integral.time, error: estimate.error / integral.time };
                if self.is_uncertain(mean, integral.deviation(), self.scale(0.0)) {
                    return Err(integral.grows_at().map_or(NoValueCause::Unknown(from), NoValueCause::Unbounded));
                }
                let estimate = Estimate { value: estimate.value / divisor, error: estimate.error / divisor };
                if estimate.value.is_finite() { Ok(estimate) } else { Err(NoValueCause::Unknown(from)) }
            }
            ReductionKind::First => of_time(from),
            ReductionKind::Last => of_time(to),
            ReductionKind::At(_) => of_time(at),
        }
    }

    /// Returns the first time (s) that a reduction left out because the formula has no value there.
    pub fn missing(&self, kind: ReductionKind) -> Option<f64> {
        self.notes_of(kind).and_then(|notes| notes.missing)
    }

    /// Returns the findings of a reduction, or `None` for a value at one time.
    fn notes_of(&self, kind: ReductionKind) -> Option<&Notes> {
        match kind {
            ReductionKind::Extreme { largest, .. } => Some(&self.notes[usize::from(largest)]),
            ReductionKind::Mean | ReductionKind::Integral => Some(&self.notes[2]),
            ReductionKind::First | ReductionKind::Last | ReductionKind::At(_) => None,
        }
    }

    /// Evaluates the formula at the only state of an analysis of a single time.
    pub fn evaluate_start(&mut self, state: &State, sampler: &mut StateSampler) {
        let point = self.curve.at(state.clone(), sampler);
        let estimate = self.curve.estimate(&point);
        self.times.iter_mut().for_each(|request| request.estimate = estimate);
    }

    /// Returns whether only values at single times are requested.
    fn has_only_times(&self) -> bool {
        self.extrema.iter().all(Option::is_none) && self.integral.is_none()
    }

    /// Returns the first time (s) of the largest or least value.
    pub fn time_of_extreme(&self, largest: bool) -> f64 {
        let which = usize::from(largest);
        match (&self.extrema[which], self.scales[which]) {
            (Some(extremum), Some(scale)) => extremum.time(scale).value,
            _ => self.window[0],
        }
    }

    /// Returns the scale of the formula, from its values at the ends of steps.
    fn scale(&self, span: f64) -> Scale {
        let low = self.samples.iter().map(|estimate| estimate.value).fold(f64::INFINITY, f64::min);
        let high = self.samples.iter().map(|estimate| estimate.value).fold(f64::NEG_INFINITY, f64::max);
        // neither the few values near a pole nor zeros are typical of the rounding of the others, hence the median
        let weights = self.samples.iter().map(|estimate| f64::max(estimate.error / ROUNDING, estimate.value.abs()));
        let weight = median(weights.filter(|weight| *weight > 0.0 && weight.is_finite()).collect());
        Scale { range: f64::max(high - low, 0.0), weight, span }
    }

    /// Returns whether no digit of an estimate is certain although its error is not small, relative to the samples, to their terms, and to
    /// `deviation`, the usual difference of values.
    fn is_uncertain(&self, estimate: Estimate, deviation: f64, scale: Scale) -> bool {
        let usual = median(self.samples.iter().map(|estimate| estimate.value.abs()).collect());
        estimate.certain_digits() == 0 && estimate.error > APART * usual.max(scale.weight).max(deviation)
    }

    /// Evaluates the formula at the requested times that lie in a step.
    fn evaluate_times(&mut self, segment: &SmoothSegment, sampler: &mut StateSampler) {
        for k in 0..self.times.len() {
            let t = self.times[k].t;
            let behind = shortly_after(t);
            if behind < segment.from.t || t > segment.to.t {
                continue;
            }
            let state = if t <= segment.from.t {
                Some(self.end(&segment.from, t, segment, sampler))
            } else if t >= segment.to.t {
                Some(self.end(&segment.to, t, segment, sampler))
            } else {
                sampler.solve(segment, [&segment.from, &segment.to], t)
            };
            // at an edge the next step overwrites the value: the later side counts
            self.times[k].point = state.map(|state| self.edge(state, t, segment, sampler));
        }
    }

    /// Returns the state at an end of a step, or at a time (s) that practically coincides with it, with the bits of a row if the formula settles.
    fn end(&self, state: &State, t: f64, segment: &SmoothSegment, sampler: &mut StateSampler) -> State {
        let settled = self.curve.settles().then(|| sampler.settled(segment, state, t));
        settled.flatten().unwrap_or_else(|| state.clone())
    }

    /// Evaluates the formula at a state of a step, for the time `t` (s). If rounding alone decides on which side of a jump an end of the window is,
    /// the side within the window counts.
    fn edge(&mut self, state: State, t: f64, segment: &SmoothSegment, sampler: &mut StateSampler) -> Rc<Point> {
        let point = self.curve.at(state, sampler);
        let [from, to] = self.window;
        let inward = [(t <= from, 1.0), (t >= to, -1.0)].into_iter().find(|(is_end, _)| *is_end);
        let Some((_, direction)) = inward.filter(|_| self.curve.is_undecided(&point)) else { return point };
        let [near, far] = [FACTOR, FACTOR * FACTOR].map(|distance| {
            let t = point.state.t + direction * distance * SHORTEST * (to - from);
            let is_within = segment.from.t <= t && t <= segment.to.t;
            let state = if is_within { sampler.solve(segment, [&segment.from, &segment.to], t) } else { None };
            state.map(|state| self.curve.at(state, sampler))
        });
        let (Some(near), Some(far)) = (near, far) else { return point };
        let [step, change] = [(&point, &near), (&near, &far)].map(|(a, b)| (a.sample.value - b.sample.value).abs());
        if !near.exists() {
            return near;
        }
        // without a jump the first difference is about as large as the second; near a pole the errors are infinite
        let error = self.curve.uncertainty(&point) + self.curve.uncertainty(&near);
        if step <= 2.0 * change + error {
            return point;
        }
        // the value is taken slightly within the window, and is uncertain by its change over that distance
        let mut within = (*near).clone();
        within.shift.value += change;
        Rc::new(within)
    }

    /// Evaluates the reductions in some steps of an analysis of duration `span` (s); `largest` holds the magnitudes of the coordinates.
    pub fn evaluate(&mut self, steps: &[SmoothSegment], largest: Largest, sampler: &mut StateSampler, span: f64) {
        self.curve.note_all(largest);
        let mut cells: Vec<Cell> = (0..steps.len()).filter_map(|step| self.cell(step, steps, sampler)).collect();
        // rounding depends on the largest magnitudes so far
        for RequestedValue { point, estimate, .. } in &mut self.times {
            if let Some(point) = point {
                *estimate = self.curve.estimate(point);
            }
        }
        if cells.is_empty() {
            return;
        }
        self.take_samples(&cells, steps);
        let scale = self.scale(span);
        let window = self.window;
        let FormulaReductions { curve, notes, extrema, integral, samples, scales, .. } = self;
        let [of_least, of_largest, of_integral] = notes;
        if curve.needs_middles() {
            let mut search = IntervalSearch::new(curve, of_integral, sampler, steps, window, span);
            for cell in &mut cells {
                if let Some(middle) = search.point(cell, cell.middle()) {
                    cell.take_middle(search.curve, middle);
                }
                if search.curve.holds_forces {
                    // the time of a load's jump at an edge of the motion is accurate to rounding only
                    let step = &steps[cell.step];
                    if step.begins_at_edge && cell.a.state.t > window[0] {
                        search.shift(cell.step, &mut cell.a, TIMES * span);
                    }
                    if step.ends_at_edge && cell.b.state.t < window[1] {
                        search.shift(cell.step, &mut cell.b, -TIMES * span);
                    }
                }
            }
        }
        for ((extremum, kept), notes) in extrema.iter_mut().zip(scales).zip([of_least, of_largest]) {
            let Some(extremum) = extremum else { continue };
            let mut search = IntervalSearch::new(curve, notes, sampler, steps, window, span);
            for cell in &cells {
                let [is_begin, is_end] = edges(&steps[cell.step], [cell.a.state.t, cell.b.state.t], window);
                for (_, point) in [(is_begin, &cell.a), (is_end, &cell.b)].into_iter().filter(|(is_edge, _)| *is_edge) {
                    let estimate = search.curve.estimate(point);
                    extremum.note_edge(Estimate { value: point.state.t, error: point.shift.time }, estimate, scale);
                }
            }
            *kept = Some(search.search(&cells, samples, extremum, scale));
        }
        if let Some(integral) = integral {
            let is_smooth = curve.settles() && sampler.is_plain && steps.iter().all(|step| step.bridge.is_none());
            let is_whole = cells[0].a.state.t <= window[0] && cells[cells.len() - 1].b.state.t >= window[1];
            let has_edges = cells[1..].iter().any(|cell| steps[cell.step].begins_at_edge);
            let mut search = IntervalSearch::new(curve, of_integral, sampler, steps, window, span);
            let spectral = if is_smooth && is_whole && !has_edges { search.integrate_whole(&cells) } else { None };
            if let Some(spectral) = spectral {
                *integral = Integral::from_estimate(spectral, window[1] - window[0]);
            } else {
                let usual = median(samples.iter().map(|estimate| estimate.value).collect());
                search.integrate(&cells, usual, scale, integral);
            }
        }
    }

    /// Returns the part of a step within the window, with the formula at both ends, or `None` if it is empty or unsolvable, or if only values at
    /// single times are requested.
    fn cell(&mut self, number: usize, steps: &[SmoothSegment], sampler: &mut StateSampler) -> Option<Cell> {
        let step = &steps[number];
        sampler.enter(step);
        self.evaluate_times(step, sampler);
        if self.has_only_times() {
            // the scale of the formula needs samples
            let point = self.curve.at(step.to.clone(), sampler);
            if point.exists() {
                self.samples.push(Estimate { value: point.sample.value, error: 0.0 });
            }
            return None;
        }
        let [from, to] = [step.from.t.max(self.window[0]), step.to.t.min(self.window[1])];
        if to <= from {
            return None;
        }
        let [is_begin, is_end] = edges(step, [from, to], self.window);
        let ends = [(&step.from, from, is_begin), (&step.to, to, is_end)];
        let mut points = ends.into_iter().map(|(state, t, is_edge)| {
            let state = if state.t.total_cmp(&t).is_ne() {
                sampler.solve(step, [&step.from, &step.to], t)?
            } else if is_edge {
                self.end(state, state.t, step, sampler)
            } else {
                state.clone()
            };
            Some(if is_edge { self.edge(state, t, step, sampler) } else { self.curve.at(state, sampler) })
        });
        let (Some(Some(from)), Some(Some(to))) = (points.next(), points.next()) else {
            self.notes.iter_mut().for_each(|notes| notes.fail(NoValueCause::Unknown(from)));
            return None;
        };
        Some(Cell::new(number, &from, &to))
    }

    /// Records the values at the ends of steps.
    fn take_samples(&mut self, cells: &[Cell], steps: &[SmoothSegment]) {
        for cell in cells {
            // except at edges, a step begins with the last point of the previous one
            let [is_begin, _] = edges(&steps[cell.step], [cell.a.state.t, cell.b.state.t], self.window);
            for point in is_begin.then_some(&cell.a).into_iter().chain([&cell.b]) {
                if point.exists() {
                    self.curve.note_arguments(point);
                    let estimate = self.curve.estimate(point);
                    self.samples.push(estimate);
                } else {
                    self.notes.iter_mut().for_each(|notes| notes.miss(point.state.t));
                }
            }
        }
    }
}

/// Returns whether the part of a step between two times (s) begins and ends at an edge of the motion or at an end of the window.
fn edges(step: &SmoothSegment, [from, to]: [f64; 2], window: [f64; 2]) -> [bool; 2] {
    [
        step.begins_at_edge && from <= step.from.t || from <= window[0],
        step.ends_at_edge && to >= step.to.t || to >= window[1],
    ]
}
