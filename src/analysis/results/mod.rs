//! Results: numbers for the whole analysis, which do not depend on the rows that are asked for.
//!
//! ```text
//! Started ──▶ its own Motion ──▶ stretches ──▶ extremes, integrals, values ──▶ reductions ──▶ results
//! ```
//!
//! The motion is followed once more, in the steps that it allows, and looked at between their ends as closely as each
//! formula needs. No bit of a row depends on it.

mod formulas;
mod places;
mod quadrature;
mod search;

use super::Started;
use super::edges::shortly_after;
use super::errors;
use super::kinematics::{Kinematics, State};
use super::march::Motion;
use super::stretches::Stretch;
use super::times::Times;
use crate::diag::Diagnostic;
use crate::expr::{ExprId, Graph, Symbol};
use crate::ir::{ConstraintSystem, Reduction, ReductionKind};
use crate::program::Range;
use crate::solver::Solver;
use crate::structure::Determined;
use formulas::{Cell, Formula, Point};
use places::Places;
use rustc_hash::FxHashMap;
use search::Extreme;
use std::rc::Rc;
use std::sync::Arc;

/// So many stretches are looked at together.
const CHUNK: usize = 4096;
/// Looking at one formula, so many cells are cut at most: what needs more is not meant.
const MOST_CELLS: usize = 4_000_000;
/// No cell is shorter than this part of the span.
const SHORTEST: f64 = 4.0 * f64::EPSILON;
/// A stretch in which nothing can be solved for may be so long, as a part of the span.
const OPAQUE: f64 = 1e-6;

/// A formula may go beyond what has been seen of it by this part of that before it is compared with its size; and so many cells are
/// looked at for that.
const SEEN: f64 = 0.25;
const MOST_LOOKS: usize = 1000;

/// Where nothing is known.
const ANYTHING: Range = Range { low: f64::NEG_INFINITY, high: f64::INFINITY, may_switch: true, is_resolved: false };

/// What results are computed from: an assembled mechanism and the times of its analysis.
pub struct Asked {
    kinematics: Kinematics,
    state: State,
    solver: Option<Arc<Solver>>,
    interval: [f64; 2],
    pass: bool,
}

/// Results in their order, in SI; those that have no value are none.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Answers {
    /// By result.
    pub values: Vec<Option<f64>>,
    /// Why some have none.
    pub notes: Vec<Diagnostic>,
}

impl Started {
    /// What is needed to compute the results of an analysis from one time to another (s), the first of which it is assembled
    /// at; `pass` goes on beyond bifurcations.
    #[must_use]
    pub fn asked(&self, interval: [f64; 2], pass: bool) -> Asked {
        let Started { kinematics, state, solver, .. } = self;
        Asked { kinematics: kinematics.clone(), state: state.clone(), solver: solver.clone(), interval, pass }
    }
}

/// How large a formula is over the analysis so far.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(in crate::analysis) struct Scale {
    /// The largest value less the least.
    range: f64,
    /// The largest magnitude.
    largest: f64,
    /// The time of the analysis (s).
    span: f64,
}

/// A formula that is looked at along the motion, and what is found of it.
struct Reduced {
    formula: Formula,
    extremes: [Option<Extreme>; 2],
    integral: Option<f64>,
    /// Times (s) at which its value is asked for, and the values.
    times: Vec<(f64, f64)>,
    /// The least and the largest value so far.
    seen: [f64; 2],
    trouble: Option<Trouble>,
    cells: usize,
}

/// Why there is no number.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(in crate::analysis) enum Trouble {
    /// The formula has no value at a time (s).
    Missing(f64),
    /// It could not be found out around a time (s).
    Unknown(f64),
}

impl Trouble {
    fn t(self) -> f64 {
        match self {
            Trouble::Missing(t) | Trouble::Unknown(t) => t,
        }
    }
}

/// A look at one formula in one stretch.
struct Survey<'r> {
    formula: &'r mut Formula,
    places: &'r mut Places,
    stretch: &'r Stretch,
    trouble: &'r mut Option<Trouble>,
    cells: &'r mut usize,
    seen: &'r mut [f64; 2],
    shortest: f64,
}

/// A stretch as a formula sees it.
struct Root {
    whole: Cell,
    /// Its halves with what the formula can be in them; none where its middle cannot be had.
    parts: Vec<(Cell, Range)>,
}

impl Survey<'_> {
    /// The formula in the middle of a cell; none where it cannot be had.
    fn middle(&mut self, cell: &Cell) -> Option<Rc<Point>> {
        if cell.is_empty() {
            return None;
        }
        self.point(&[&cell.a, &cell.b], cell.middle())
    }

    /// The formula at a time (s) between two points.
    fn point(&mut self, ends: &[&Rc<Point>; 2], t: f64) -> Option<Rc<Point>> {
        *self.cells += 1;
        let [a, b] = ends.map(|point| &point.state);
        let state = if self.formula.moves() {
            let solved = self.places.solve(self.stretch, [a, b], t);
            if solved.is_none() && b.t - a.t > self.shortest * OPAQUE / SHORTEST {
                self.meet(Trouble::Unknown(t));
            }
            solved?
        } else {
            State { t, ..a.clone() }
        };
        let point = self.formula.at(state);
        self.see(&point).then_some(point)
    }

    /// Takes note of a value; says whether there is one.
    fn see(&mut self, point: &Point) -> bool {
        let value = point.sample.value;
        if !value.is_finite() {
            self.meet(Trouble::Missing(point.state.t));
            return false;
        }
        *self.seen = [self.seen[0].min(value), self.seen[1].max(value)];
        true
    }

    /// What the formula can be in a cell; anything where the states at its ends do not tell the motion between.
    fn range(&mut self, cell: &Cell) -> Range {
        self.formula.look_at(cell);
        let range = self.formula.range(0);
        let is_known = !self.formula.moves() || self.places.signals_are_resolved([cell.a.state.t, cell.b.state.t]);
        if is_known { range } else { ANYTHING }
    }

    /// Whether a cell may be cut in two. One that is too short for that, and in which the formula may be anything, has no value.
    fn goes_on(&mut self, cell: &Cell, widest: f64) -> bool {
        if *self.cells > MOST_CELLS {
            self.meet(Trouble::Unknown(cell.a.state.t));
        }
        if self.trouble.is_some() {
            return false;
        }
        let goes_on = cell.length() > self.shortest && !cell.is_empty();
        if !goes_on && !widest.is_finite() {
            self.formula.look_at(cell);
            let range = self.formula.range(0);
            if !(range.low.is_finite() && range.high.is_finite()) {
                self.meet(Trouble::Missing(cell.a.state.t));
            }
        }
        goes_on
    }

    fn meet(&mut self, trouble: Trouble) {
        if self.trouble.is_none_or(|known| trouble.t() < known.t()) {
            *self.trouble = Some(trouble);
        }
    }
}

impl Reduced {
    fn new(formula: Formula) -> Reduced {
        let seen = [f64::INFINITY, f64::NEG_INFINITY];
        Reduced { formula, extremes: [None, None], integral: None, times: Vec::new(), seen, trouble: None, cells: 0 }
    }

    /// Takes note of what is asked for.
    fn ask(&mut self, kind: ReductionKind, at: f64, [from, to]: [f64; 2]) {
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
    fn outcome(&self, kind: ReductionKind, at: f64, interval: [f64; 2]) -> Result<f64, Trouble> {
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
        if value.is_finite() { Ok(value) } else { Err(Trouble::Missing(t)) }
    }

    /// Of an analysis of a single time.
    fn look_at_start(&mut self, state: &State, span: f64) {
        let point = self.formula.at(state.clone());
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

    fn scale(&self, span: f64) -> Scale {
        let [low, high] = self.seen;
        Scale { range: f64::max(high - low, 0.0), largest: f64::max(low.abs(), high.abs()), span }
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
                extreme.map_or(f64::NAN, |extreme| if when { extreme.time(scale) } else { extreme.value() })
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
                Some(stretch.from.clone())
            } else if t >= stretch.to.t {
                Some(stretch.to.clone())
            } else {
                places.solve(stretch, [&stretch.from, &stretch.to], t)
            };
            // of an edge the later side counts, which comes later
            self.times[k].1 = state.map_or(f64::NAN, |state| self.formula.at(state).sample.value);
        }
    }

    /// Looks at some stretches.
    fn look(&mut self, stretches: &[Stretch], places: &mut Places, span: f64) {
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
        if self.extremes.iter().all(Option::is_none) && self.integral.is_none() {
            return None;
        }
        let [from, to] = [&stretch.from, &stretch.to].map(|state| self.formula.at(state.clone()));
        let mut survey = self.survey(stretch, places, span);
        for point in [&from, &to] {
            survey.see(point);
        }
        let whole = Cell::unknown(survey.formula, &from, &to);
        let middle = match &stretch.middle {
            Some(state) => {
                let point = survey.formula.at(state.clone());
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
            let range = survey.range(&cell);
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
        let Reduced { formula, trouble, cells, seen, .. } = self;
        Survey { formula, places, stretch, trouble, cells, seen, shortest: SHORTEST * span }
    }
}

/// The motion in some chunks of its stretches, and what follows from it.
struct Analysis {
    asked: Asked,
    determined: Arc<Determined>,
    /// By reduction: its number, or why there is none.
    found: Vec<Option<Result<f64, Trouble>>>,
}

impl Asked {
    /// The results, by following the motion once more.
    #[must_use]
    pub fn answer(self) -> Answers {
        let determined = self.kinematics.determined();
        let count = determined.system().results.reductions.len();
        let mut analysis = Analysis { asked: self, determined, found: vec![None; count] };
        while let Some(level) = analysis.next_level() {
            if let Err(why) = analysis.follow(&level) {
                return analysis.without_motion(&why);
            }
        }
        analysis.answers()
    }

    /// A motion of its own.
    fn motion(&self) -> Motion {
        let [from, to] = self.interval;
        let times = Times::listed(from, vec![to]);
        let mut motion = Motion::new(self.kinematics.clone(), self.state.clone(), self.solver.clone(), times);
        if self.pass {
            motion.pass_bifurcations();
        }
        motion
    }
}

impl Analysis {
    fn system(&self) -> &ConstraintSystem {
        self.determined.system()
    }

    /// The reductions that can be found now: those in their formulas are known. None where all are.
    fn next_level(&mut self) -> Option<Vec<usize>> {
        let determined = Arc::clone(&self.determined);
        let system = determined.system();
        let mut level = Vec::new();
        let open: Vec<usize> = (0..self.found.len()).filter(|&k| self.found[k].is_none()).collect();
        for k in open {
            let needed = needed(&system.graph, system.results.reductions[k].of);
            if let Some(trouble) = needed.iter().find_map(|&other| self.found[other].and_then(Result::err)) {
                self.found[k] = Some(Err(trouble));
            } else if needed.iter().all(|&other| self.found[other].is_some()) {
                level.push(k);
            }
        }
        (!level.is_empty()).then_some(level)
    }

    /// Follows the motion for some reductions.
    fn follow(&mut self, level: &[usize]) -> Result<(), Box<Diagnostic>> {
        let determined = Arc::clone(&self.determined);
        let system = determined.system();
        let asked: Vec<(usize, Reduction)> = level.iter().map(|&k| (k, system.results.reductions[k])).collect();
        let (mut all, formula_of) = self.formulas(&asked);
        let at = |reduction: &Reduction| match reduction.kind {
            ReductionKind::At(at) => system.value_at(at, &[]),
            _ => f64::NAN,
        };
        let interval @ [from, to] = self.asked.interval;
        for ((_, reduction), &of) in asked.iter().zip(&formula_of) {
            all[of].ask(reduction.kind, at(reduction), interval);
        }
        self.run(&mut all, to - from)?;
        for ((k, reduction), &of) in asked.iter().zip(&formula_of) {
            self.found[*k] = Some(all[of].outcome(reduction.kind, at(reduction), interval));
        }
        Ok(())
    }

    /// The formulas of some reductions, each once, and which is whose.
    fn formulas(&self, asked: &[(usize, Reduction)]) -> (Vec<Reduced>, Vec<usize>) {
        let system = self.system();
        let (mut graph, mut known) = (Graph::new(), FxHashMap::default());
        graph.import_tables(&system.graph, &mut known, Graph::symbol);
        let mut formula_of: Vec<usize> = Vec::new();
        let mut ids: Vec<ExprId> = Vec::new();
        for (_, reduction) in asked {
            graph.import(&system.graph, &[reduction.of], &mut known, |graph, symbol| match symbol {
                Symbol::Named(k) => graph.constant(self.found[k as usize].and_then(Result::ok).unwrap_or(0.0)),
                other => graph.symbol(other),
            });
            let id = known[&reduction.of];
            let at = ids.iter().position(|&other| other == id).unwrap_or_else(|| {
                ids.push(id);
                ids.len() - 1
            });
            formula_of.push(at);
        }
        let all = ids.into_iter().map(|id| Reduced::new(Formula::new(&mut graph, id, system))).collect();
        (all, formula_of)
    }

    /// Looks at formulas along the whole motion.
    fn run(&self, all: &mut [Reduced], span: f64) -> Result<(), Box<Diagnostic>> {
        let mut motion = self.asked.motion();
        let mut places = Places::new(self.asked.kinematics.clone(), self.asked.solver.clone());
        let mut stretches = Vec::new();
        loop {
            let next = motion.next_stretch()?;
            let is_end = next.is_none();
            stretches.extend(next);
            if is_end && span <= 0.0 {
                all.iter_mut().for_each(|reduced| reduced.look_at_start(motion.here(), span));
                return Ok(());
            }
            if is_end || stretches.len() >= CHUNK {
                all.iter_mut().for_each(|reduced| reduced.look(&stretches, &mut places, span));
                stretches.clear();
            }
            if is_end {
                return Ok(());
            }
        }
    }

    /// No results: the motion ends before the analysis does.
    fn without_motion(&self, why: &Diagnostic) -> Answers {
        let outcomes = &self.system().results.outcomes;
        let notes = outcomes.first().map(|first| errors::results_without_motion(first, outcomes.len(), why));
        Answers { values: vec![None; outcomes.len()], notes: notes.into_iter().collect() }
    }

    fn answers(&self) -> Answers {
        let system = self.system();
        let mut answers = Answers::default();
        for outcome in &system.results.outcomes {
            let value = system.graph.value(outcome.value, |symbol| match symbol {
                Symbol::Param(k) => system.params[k as usize].value,
                Symbol::Named(k) => self.found[k as usize].and_then(Result::ok).unwrap_or(f64::NAN),
                _ => f64::NAN,
            });
            if value.is_finite() {
                // −0 would surprise a reader
                answers.values.push(Some(value + 0.0));
                continue;
            }
            let needed = needed(&system.graph, outcome.value);
            let trouble = needed.into_iter().find_map(|k| self.found[k].and_then(Result::err));
            answers.values.push(None);
            answers.notes.push(errors::result_without_value(outcome, trouble));
        }
        answers
    }
}

/// The reductions that a formula holds.
fn needed(graph: &Graph, formula: ExprId) -> Vec<usize> {
    let of = |symbol: Symbol| match symbol {
        Symbol::Named(k) => Some(k as usize),
        _ => None,
    };
    graph.symbols(formula).into_iter().filter_map(of).collect()
}
