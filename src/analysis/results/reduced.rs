//! A formula along the whole motion, and the numbers that are asked of it.

use super::curve::{Cell, Curve, Point};
use super::extremum::Extremum;
use super::places::Places;
use super::probe::{Notes, Probe, Scale, Trouble};
use super::quadrature::Integral;
use crate::analysis::follow::Stretch;
use crate::analysis::state::{State, shortly_after};
use crate::ir::ReductionKind;
use std::rc::Rc;

/// A formula that is looked at along the motion, and what is found of it.
pub(super) struct Reduced {
    curve: Curve,
    extrema: [Option<Extremum>; 2],
    integral: Option<Integral>,
    /// What came up while these were looked for, in this order.
    notes: [Notes; 3],
    /// Times (s) at which its value is asked for, and the values.
    times: Vec<(f64, f64)>,
    /// Its values, and the magnitudes of the numbers that these are sums of, at the ends of steps.
    samples: Vec<f64>,
    weights: Vec<f64>,
    /// As the extremum's search has left it, by which one.
    scales: [Option<Scale>; 2],
}

impl Reduced {
    pub fn new(curve: Curve) -> Reduced {
        Reduced {
            curve,
            extrema: [None, None],
            integral: None,
            times: Vec::new(),
            samples: Vec::new(),
            weights: Vec::new(),
            scales: [None, None],
            notes: [Notes::default(); 3],
        }
    }

    /// Takes note of what is asked for.
    pub fn ask(&mut self, kind: ReductionKind, at: f64, [from, to]: [f64; 2]) {
        let mut time = |t: f64| {
            if self.times.iter().all(|(known, _)| known.total_cmp(&t).is_ne()) {
                self.times.push((t, f64::NAN));
            }
        };
        match kind {
            ReductionKind::Extreme { largest, when } => {
                let extremum = self.extrema[usize::from(largest)].get_or_insert_with(|| Extremum::new(largest));
                if when {
                    extremum.ask_for_time();
                }
            }
            ReductionKind::Mean | ReductionKind::Integral if to > from => self.integral = Some(Integral::default()),
            ReductionKind::Integral => self.integral = Some(Integral::default()),
            ReductionKind::Mean | ReductionKind::First => time(from),
            ReductionKind::Last => time(to),
            ReductionKind::At(_) => time(at),
        }
    }

    /// What a reduction is, or why it is nothing.
    pub fn outcome(&self, kind: ReductionKind, at: f64, interval @ [from, to]: [f64; 2]) -> Result<f64, Trouble> {
        if let Some(trouble) = self.notes_of(kind).and_then(|notes| notes.trouble) {
            return Err(trouble);
        }
        if let ReductionKind::Extreme { largest, .. } = kind
            && let Some(t) = self.extrema[usize::from(largest)].as_ref().and_then(Extremum::unbounded)
        {
            return Err(Trouble::Unbounded(t));
        }
        if let Some(integral) = self.integral.filter(|_| matches!(kind, ReductionKind::Mean | ReductionKind::Integral))
            && let Some(t) = integral.unbounded()
        {
            return Err(Trouble::Unbounded(t));
        }
        let value = self.value(kind, at, interval);
        let t = match kind {
            ReductionKind::Last => to,
            ReductionKind::At(_) => at,
            _ => from,
        };
        if value.is_finite() { Ok(value) } else { Err(Trouble::Missing(t)) }
    }

    /// The first time (s) at which the formula has no value, which was left out.
    pub fn missing(&self, kind: ReductionKind) -> Option<f64> {
        self.notes_of(kind).and_then(|notes| notes.missing)
    }

    /// What came up while a reduction was looked for; none where that is a value at one time.
    fn notes_of(&self, kind: ReductionKind) -> Option<&Notes> {
        match kind {
            ReductionKind::Extreme { largest, .. } => Some(&self.notes[usize::from(largest)]),
            ReductionKind::Mean | ReductionKind::Integral => Some(&self.notes[2]),
            ReductionKind::First | ReductionKind::Last | ReductionKind::At(_) => None,
        }
    }

    /// Of an analysis of a single time.
    pub fn look_at_start(&mut self, state: &State, places: &mut Places, span: f64) {
        let point = self.curve.at(state.clone(), places);
        let value = point.sample.value;
        self.times.iter_mut().for_each(|(_, known)| *known = value);
        if !value.is_finite() {
            self.notes.iter_mut().for_each(|notes| notes.meet(Trouble::Missing(state.t)));
            return;
        }
        self.samples.push(value);
        let scale = self.scale(span);
        self.extrema.iter_mut().flatten().for_each(|extremum| extremum.note_edge(state.t, value, scale));
        self.scales = [Some(scale); 2];
    }

    /// Whether it changes with the motion, and not with time alone.
    pub fn moves(&self) -> bool {
        self.curve.moves()
    }

    /// Whether nothing is asked but values at some times.
    fn is_of_times_alone(&self) -> bool {
        self.extrema.iter().all(Option::is_none) && self.integral.is_none()
    }

    /// Whether it holds derivatives of the coordinates.
    pub fn holds_rates(&self) -> bool {
        self.curve.holds_rates()
    }

    /// The first time (s) of the largest or least value.
    pub fn time_of_extreme(&self, largest: bool) -> f64 {
        let which = usize::from(largest);
        match (&self.extrema[which], self.scales[which]) {
            (Some(extremum), Some(scale)) => extremum.time(scale),
            _ => f64::NAN,
        }
    }

    /// How large the formula is, by what was seen at the ends of steps.
    fn scale(&self, span: f64) -> Scale {
        let finite = || self.samples.iter().filter(|value| value.is_finite());
        let low = finite().copied().fold(f64::INFINITY, f64::min);
        let high = finite().copied().fold(f64::NEG_INFINITY, f64::max);
        // what a pole makes of a few values says nothing of the others' rounding
        let mut weights: Vec<f64> = self.weights.iter().chain(finite()).map(|weight| weight.abs()).collect();
        let middle = weights.len() / 2;
        let weight =
            if weights.is_empty() { 0.0 } else { *weights.select_nth_unstable_by(middle, f64::total_cmp).1 };
        Scale { range: f64::max(high - low, 0.0), weight, span }
    }

    /// What a reduction is, once all has been seen.
    fn value(&self, kind: ReductionKind, at: f64, [from, to]: [f64; 2]) -> f64 {
        let of_time = |wanted: f64| {
            let found = self.times.iter().find(|(t, _)| t.total_cmp(&wanted).is_eq());
            found.map_or(f64::NAN, |(_, value)| *value)
        };
        match kind {
            ReductionKind::Extreme { largest, when: true } => self.time_of_extreme(largest),
            ReductionKind::Extreme { largest, when: false } => {
                let which = usize::from(largest);
                match (&self.extrema[which], self.scales[which]) {
                    (Some(extremum), Some(scale)) => extremum.value(scale),
                    _ => f64::NAN,
                }
            }
            ReductionKind::Integral => self.integral.map_or(f64::NAN, |integral| integral.sum),
            ReductionKind::Mean if to > from => {
                self.integral.map_or(f64::NAN, |integral| integral.sum / integral.time)
            }
            ReductionKind::Mean | ReductionKind::First => of_time(from),
            ReductionKind::Last => of_time(to),
            ReductionKind::At(_) => of_time(at),
        }
    }

    /// Takes in the values at times that lie in a step.
    fn take_times(&mut self, stretch: &Stretch, places: &mut Places) {
        for k in 0..self.times.len() {
            let t = self.times[k].0;
            let behind = shortly_after(t);
            if behind < stretch.from.t || t > stretch.to.t {
                continue;
            }
            let state = if t <= stretch.from.t {
                Some(self.end(&stretch.from, t, stretch, places))
            } else if t >= stretch.to.t {
                Some(self.end(&stretch.to, t, stretch, places))
            } else {
                places.solve(stretch, [&stretch.from, &stretch.to], t)
            };
            // of an edge the later side counts, which comes later
            self.times[k].1 = state.map_or(f64::NAN, |state| self.curve.at(state, places).sample.value);
        }
    }

    /// An end of a step, or a time (s) that is as good as that, with the bits that rows have there where nothing is in doubt.
    fn end(&self, state: &State, t: f64, stretch: &Stretch, places: &mut Places) -> State {
        let settled = self.curve.settles().then(|| places.settled(stretch, state, t));
        settled.flatten().unwrap_or_else(|| state.clone())
    }

    /// Looks at some steps.
    pub fn look(&mut self, steps: &[Stretch], places: &mut Places, span: f64) {
        let cells: Vec<Cell> = (0..steps.len()).filter_map(|step| self.cell(step, steps, places)).collect();
        if cells.is_empty() {
            return;
        }
        let scale = self.scale(span);
        let Reduced { curve, notes, extrema, integral, samples, scales, .. } = self;
        let [of_least, of_largest, of_integral] = notes;
        for ((extremum, kept), notes) in extrema.iter_mut().zip(scales).zip([of_least, of_largest]) {
            let Some(extremum) = extremum else { continue };
            let mut probe = Probe::new((&mut *curve, notes), &mut *places, steps, span);
            for cell in &cells {
                let step = &steps[cell.step];
                let ends = [(step.begins_at_edge, &cell.a, &cell.b), (step.ends_at_edge, &cell.b, &cell.a)];
                let is_edge = |(is_edge, point, other): &(bool, &Rc<Point>, &Rc<Point>)| {
                    *is_edge && !probe.curve.is_at_threshold(point, other)
                };
                for (_, point, _) in ends.into_iter().filter(is_edge) {
                    extremum.note_edge(point.state.t, point.sample.value, scale);
                }
            }
            *kept = Some(probe.search(&cells, samples, extremum, scale));
        }
        if let Some(integral) = integral {
            let mut probe = Probe::new((curve, of_integral), places, steps, span);
            let middle = samples.len() / 2;
            let usual = if samples.is_empty() { 0.0 } else { *samples.clone().select_nth_unstable_by(middle, f64::total_cmp).1 };
            probe.integrate(&cells, usual, scale, integral);
        }
    }

    /// A step, with the formula at both ends; none where only values at some times are asked for.
    fn cell(&mut self, number: usize, steps: &[Stretch], places: &mut Places) -> Option<Cell> {
        let step = &steps[number];
        if std::env::var("DBS").is_ok() { eprintln!("step {:?} {:?} bridge {:?} edges {} {}", step.from.t, step.to.t, step.bridge.as_ref().map(|b| (b.from.t, b.at, b.again, b.to.t)), step.begins_at_edge, step.ends_at_edge); }
        places.enter(step);
        self.take_times(step, places);
        if self.is_of_times_alone() {
            return None;
        }
        let ends = [(&step.from, step.begins_at_edge), (&step.to, step.ends_at_edge)];
        let [from, to] = ends.map(|(state, is_edge)| {
            let state = if is_edge { self.end(state, state.t, step, places) } else { state.clone() };
            self.curve.at(state, places)
        });
        // but for edges, a step begins where the one before has ended
        for point in step.begins_at_edge.then_some(&from).into_iter().chain([&to]) {
            if point.exists() {
                self.samples.push(point.sample.value);
                let weight = self.curve.weight(point);
                self.weights.push(weight);
            } else {
                self.notes.iter_mut().for_each(|notes| notes.miss(point.state.t));
            }
        }
        Some(Cell::new(number, &from, &to))
    }
}
