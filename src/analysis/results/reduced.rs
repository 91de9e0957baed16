//! A formula along the whole motion, stretch by stretch, and the numbers that are asked of it.

use super::formulas::{Cell, Formula};
use super::places::Places;
use super::search::Extreme;
use super::survey::{Root, Scale, Survey, Trouble};
use crate::analysis::follow::Stretch;
use crate::analysis::state::{State, shortly_after};
use crate::ir::ReductionKind;
use crate::program::Range;
use crate::tolerances::results::reduced::{MOST_LOOKS, SEEN};
use crate::tolerances::results::survey::{OPAQUE, SHORTEST};

/// A formula that is looked at along the motion, and what is found of it.
pub(super) struct Reduced {
    formula: Formula,
    extremes: [Option<Extreme>; 2],
    integral: Option<f64>,
    /// Times (s) at which its value is asked for, and the values.
    times: Vec<(f64, f64)>,
    /// The least and the largest value so far.
    seen: [f64; 2],
    /// The size of the largest numbers that a value was a sum of.
    weight: f64,
    /// When these were seen first (s).
    seen_at: [f64; 2],
    trouble: Option<Trouble>,
    cells: usize,
}

impl Reduced {
    pub fn new(formula: Formula) -> Reduced {
        let seen = [f64::INFINITY, f64::NEG_INFINITY];
        Reduced {
            formula,
            extremes: [None, None],
            integral: None,
            times: Vec::new(),
            seen,
            weight: 0.0,
            seen_at: [f64::NAN; 2],
            trouble: None,
            cells: 0,
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
            ReductionKind::Extreme { largest, .. } => {
                self.extremes[usize::from(largest)].get_or_insert_with(|| Extreme::new(largest));
            }
            ReductionKind::Mean | ReductionKind::Integral if to > from => self.integral = Some(0.0),
            ReductionKind::Integral => self.integral = Some(0.0),
            ReductionKind::Mean | ReductionKind::First => time(from),
            ReductionKind::Last => time(to),
            ReductionKind::At(_) => time(at),
        }
    }

    /// What a reduction is, or why it is nothing.
    pub fn outcome(&self, kind: ReductionKind, at: f64, interval: [f64; 2]) -> Result<f64, Trouble> {
        let is_of_time = matches!(kind, ReductionKind::First | ReductionKind::Last | ReductionKind::At(_));
        if let Some(trouble) = self.trouble.filter(|_| !is_of_time) {
            return Err(trouble);
        }
        let value = self.value(kind, at, interval);
        let t = match kind {
            ReductionKind::Last => interval[1],
            ReductionKind::At(_) => at,
            _ => interval[0],
        };
        match kind {
            _ if value.is_finite() => Ok(value),
            // rounding may show values that no extremum has
            ReductionKind::Extreme { largest, .. } if self.seen_at[0].is_finite() => {
                Err(Trouble::Unknown(self.seen_at[usize::from(largest)]))
            }
            _ => Err(Trouble::Missing(t)),
        }
    }

    /// Of an analysis of a single time.
    pub fn look_at_start(&mut self, state: &State, places: &mut Places, span: f64) {
        let point = self.formula.at(state.clone(), places);
        let value = point.sample.value;
        self.times.iter_mut().for_each(|(_, known)| *known = value);
        if !value.is_finite() {
            self.trouble = Some(Trouble::Missing(state.t));
            return;
        }
        self.seen = [value; 2];
        let scale = self.scale(span);
        self.extremes.iter_mut().flatten().for_each(|extreme| extreme.note_edge(state.t, value, scale));
    }

    /// Whether it changes with the motion, and not with time alone.
    pub fn moves(&self) -> bool {
        self.formula.moves()
    }

    /// Whether what lies between the ends of stretches matters.
    pub fn needs_middles(&self) -> bool {
        self.moves() && !self.is_of_times_alone()
    }

    /// Whether nothing is asked but values at some times.
    fn is_of_times_alone(&self) -> bool {
        self.extremes.iter().all(Option::is_none) && self.integral.is_none()
    }

    /// Whether it holds derivatives of the coordinates.
    pub fn holds_rates(&self) -> bool {
        self.formula.holds_rates()
    }

    /// The first time (s) of the largest or least value, be it just one that was seen.
    pub fn time_of_extreme(&self, largest: bool, span: f64) -> f64 {
        let extreme = self.extremes[usize::from(largest)].as_ref();
        let time = extreme.map_or(f64::NAN, |extreme| extreme.time(self.scale(span)));
        if time.is_finite() { time } else { self.seen_at[usize::from(largest)] }
    }

    fn scale(&self, span: f64) -> Scale {
        let [low, high] = self.seen;
        Scale { range: f64::max(high - low, 0.0), weight: self.weight.max(low.abs()).max(high.abs()), span }
    }

    /// What a reduction is, once all has been seen.
    fn value(&self, kind: ReductionKind, at: f64, [from, to]: [f64; 2]) -> f64 {
        let (span, scale) = (to - from, self.scale(to - from));
        let of_time = |wanted: f64| {
            let found = self.times.iter().find(|(t, _)| t.total_cmp(&wanted).is_eq());
            found.map_or(f64::NAN, |(_, value)| *value)
        };
        match kind {
            ReductionKind::Extreme { largest, when } => {
                let extreme = self.extremes[usize::from(largest)].as_ref();
                extreme.map_or(f64::NAN, |extreme| if when { extreme.time(scale) } else { extreme.value(scale) })
            }
            ReductionKind::Integral => self.integral.unwrap_or(f64::NAN),
            ReductionKind::Mean if span > 0.0 => self.integral.map_or(f64::NAN, |integral| integral / span),
            ReductionKind::Mean | ReductionKind::First => of_time(from),
            ReductionKind::Last => of_time(to),
            ReductionKind::At(_) => of_time(at),
        }
    }

    /// Takes in the values at times that lie in a stretch.
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
            self.times[k].1 = state.map_or(f64::NAN, |state| self.formula.at(state, places).sample.value);
        }
    }

    /// An end of a stretch, or a time (s) that is as good as that, with the bits that rows have there where nothing is in doubt.
    fn end(&self, state: &State, t: f64, stretch: &Stretch, places: &mut Places) -> State {
        let settled = self.formula.settles().then(|| places.settled(stretch, state, t));
        settled.flatten().unwrap_or_else(|| state.clone())
    }

    /// Looks at some stretches.
    pub fn look(&mut self, stretches: &[Stretch], places: &mut Places, span: f64) {
        let mut roots: Vec<Option<Root>> = stretches.iter().map(|stretch| self.root(stretch, places, span)).collect();
        self.explore(stretches, &roots, places, span);
        for (stretch, root) in stretches.iter().zip(&mut roots) {
            if self.trouble.is_some() {
                return;
            }
            if let Some(root) = root {
                places.enter(stretch);
                self.look_into(stretch, root, places, span);
            }
        }
    }

    /// The formula at the ends and in the middle of a stretch, and what it can be between; none where nobody asks.
    fn root(&mut self, stretch: &Stretch, places: &mut Places, span: f64) -> Option<Root> {
        places.enter(stretch);
        self.take_times(stretch, places);
        if self.is_of_times_alone() {
            return None;
        }
        let is_integrated = self.integral.is_some();
        let is_edge = [stretch.begins_at_edge, stretch.ends_at_edge];
        let ends = [(&stretch.from, is_edge[0]), (&stretch.to, is_edge[1])];
        let [from, to] = ends.map(|(state, is_edge)| {
            let state = if is_edge { self.end(state, state.t, stretch, places) } else { state.clone() };
            self.formula.at(state, places)
        });
        // but for edges, a stretch begins where the one before has ended
        for point in stretch.begins_at_edge.then_some(&from).into_iter().chain([&to]) {
            self.weight = self.weight.max(self.formula.weight(point));
        }
        let mut survey = self.survey(stretch, places, span);
        for point in [&from, &to] {
            survey.see(point);
        }
        let whole = Cell::unknown(survey.formula, &from, &to);
        let middle = match &stretch.middle {
            Some(state) => {
                let point = survey.formula.at(state.clone(), survey.places);
                survey.see(&point);
                Some(point)
            }
            None => survey.middle(&whole),
        };
        let Some(middle) = middle else {
            if whole.length() > OPAQUE * span {
                survey.meet(Trouble::Unknown(from.state.t));
            }
            return Some(Root { whole, parts: Vec::new() });
        };
        let halves = whole.halves(survey.formula, &middle);
        let parts = halves.map(|cell| {
            let range = if is_integrated { survey.smooth_range(&cell) } else { survey.range(&cell) };
            (cell, range)
        });
        Some(Root { whole, parts: parts.into() })
    }

    /// Looks for values where the ranges allow much more than has been seen: what is a peak in no time has to be known before
    /// anything is compared with its size.
    fn explore(&mut self, stretches: &[Stretch], roots: &[Option<Root>], places: &mut Places, span: f64) {
        for sign in [1.0, -1.0] {
            let top = |range: &Range| if sign > 0.0 { range.high } else { -range.low };
            let parts = roots.iter().enumerate().filter_map(|(k, root)| Some((k, root.as_ref()?)));
            let mut open: Vec<(f64, usize, Cell)> = parts
                .flat_map(|(k, root)| root.parts.iter().map(move |(cell, range)| (top(range), k, cell.clone())))
                .collect();
            for _ in 0..MOST_LOOKS {
                let best = (0..open.len()).max_by(|&a, &b| open[a].0.total_cmp(&open[b].0));
                let Some((upper, k, cell)) = best.map(|best| open.swap_remove(best)) else { break };
                let seen = if sign > 0.0 { self.seen[1] } else { -self.seen[0] };
                if upper - seen <= SEEN * (self.seen[1] - self.seen[0]) || self.trouble.is_some() {
                    break;
                }
                places.enter(&stretches[k]);
                let mut survey = self.survey(&stretches[k], places, span);
                let Some(middle) = survey.middle(&cell) else { continue };
                for half in cell.halves(survey.formula, &middle) {
                    let range = survey.range(&half);
                    open.push((top(&range), k, half));
                }
            }
        }
    }

    fn look_into(&mut self, stretch: &Stretch, root: &Root, places: &mut Places, span: f64) {
        let scale = self.scale(span);
        let [from, to] = [&root.whole.a, &root.whole.b];
        let mut extremes = self.extremes.clone();
        for extreme in extremes.iter_mut().flatten() {
            if stretch.begins_at_edge {
                extreme.note_edge(from.state.t, from.sample.value, scale);
            }
            self.survey(stretch, places, span).search(&root.parts, extreme, scale);
            if stretch.ends_at_edge {
                extreme.note_edge(to.state.t, to.sample.value, scale);
            }
        }
        self.extremes = extremes;
        if let Some(integral) = self.integral {
            let more = self.survey(stretch, places, span).integral(root, scale);
            self.integral = Some(integral + more);
        }
    }

    fn survey<'r>(&'r mut self, stretch: &'r Stretch, places: &'r mut Places, span: f64) -> Survey<'r> {
        let Reduced { formula, trouble, cells, seen, seen_at, .. } = self;
        Survey { formula, places, stretch, trouble, cells, seen, seen_at, shortest: SHORTEST * span }
    }
}
