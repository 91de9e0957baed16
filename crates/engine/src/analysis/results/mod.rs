//! Results: numbers for the whole analysis, which do not depend on the rows that are asked for.
//!
//! ```text
//! Started ──▶ its own Motion ──▶ segments ──▶ extremes, integrals, values ──▶ reductions ──▶ results
//! ```
//!
//! The motion is followed once more, in the steps that it allows, and looked at between their ends as closely as each
//! formula needs. No bit of a row depends on it.

mod batch_evaluation;
pub mod course;
mod curve;
mod errors;
mod extremum;
mod extremum_refinement;
mod guards;
mod interval_search;
mod loads;
mod magnitudes;
mod quadrature;
mod reductions;
mod sensitivities;
mod smooth_formulas;
mod smooth_parts;
mod spectral;
mod state_sampler;
mod validity;

use crate::analysis::assemble::Started;
use crate::analysis::explain::Stop;
use crate::analysis::follow::{Follower, SmoothSegment};
use crate::analysis::state::{Kinematics, State, Times};
use crate::solver::Solver;
pub use batch_evaluation::{Computed, SmoothFormula, moved};
use curve::{Curve, Estimate};
pub use extremum_refinement::{MOST_LOOKS, Sampled, Settling, Turning};
use interval_search::NoValueCause;
use magnitudes::Largest;
use mechc_expr::{ExprId, Graph, Node, Symbol};
use mechc_ir::structure::Determined;
use mechc_ir::{ConstraintSystem, Outcome, Reduction, ReductionKind};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Diagnostic, Diagnostics};
use reductions::FormulaReductions;
use rustc_hash::FxHashMap;
pub use smooth_formulas::SmoothFormulas;
pub use spectral::{Settled, SpectralIntegral};
use state_sampler::StateSampler;
use std::sync::Arc;
use validity::SingularIntervals;

/// Parts of a step shorter than this part of it are not divided.
const SHORTEST: f64 = 1e-2;
/// Number of steps in a chunk.
const CHUNK: usize = 4096;
/// Maximum number of coordinates of all steps in a chunk.
const NUMBERS: usize = 4_000_000;
/// Number of certain digits below which the accuracy is reported.
const FEW: u32 = 6;

/// Returns the faults of the results for an analysis from one time to another (s).
#[must_use]
pub fn refused_results(system: &ConstraintSystem, interval @ [from, to]: [f64; 2]) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    for reduction in &system.results().reductions {
        // one at the time of another reduction is within
        for at in times(reduction).filter(|at| needed(system.graph(), *at).is_empty()) {
            let t = system.value_at(at, &[]);
            if !(from <= t && t <= to) {
                diagnostics.push(errors::at_outside(reduction, t, interval));
            }
        }
    }
    diagnostics
}

/// The input of results: an assembled mechanism and the times of its analysis.
pub struct ResultQuery {
    kinematics: Kinematics,
    state: State,
    solver: Option<Arc<Solver>>,
    interval: [f64; 2],
    pass: bool,
    cancel: Cancel,
}

/// The values of the results, in their order.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Answers {
    /// The values by result, in SI.
    pub values: Vec<Option<f64>>,
    /// The number of certain significant digits by result, 17 at most; 0 if it has no value or cannot be told from zero.
    pub digits: Vec<u32>,
    /// Notes on results without a value, with gaps or with few certain digits.
    pub notes: Vec<Diagnostic>,
    /// True if the motion was followed to its end, nowhere near a singular position, and holds no forces: so it has a row at any time.
    pub has_all_rows: bool,
}

impl Answers {
    /// Returns the least number of certain digits of all results with a value; 0 if no result has one.
    #[must_use]
    pub fn certain_digits(&self) -> u32 {
        let known = self.values.iter().zip(&self.digits).filter(|(value, _)| value.is_some());
        known.map(|(_, digits)| *digits).min().unwrap_or(0)
    }
}

impl Started {
    /// Returns the query of results over an interval (s), at the start of which the mechanism is assembled; `pass` continues beyond
    /// bifurcations. `cancel` ends the work.
    #[must_use]
    pub fn asked(&self, interval: [f64; 2], pass: bool, cancel: &Cancel) -> ResultQuery {
        let (kinematics, state, solver) = self.parts();
        ResultQuery { kinematics, state, solver, interval, pass, cancel: cancel.clone() }
    }
}

/// The motion in some chunks of its segments, and what follows from it.
struct Analysis {
    query: ResultQuery,
    determined: Arc<Determined>,
    /// The estimate of each reduction, or why it has no value.
    estimates: Vec<Option<Result<Estimate, NoValueCause>>>,
    /// The first time (s) that each reduction leaves out because its formula has no value.
    missing: Vec<Option<f64>>,
    /// The steps of the motion, once they are known and are not too many to be kept.
    steps: Option<Vec<SmoothSegment>>,
    /// The solver of states between the ends of steps.
    sampler: Option<StateSampler>,
    singular: SingularIntervals,
    /// The magnitudes of the coordinates in the motion so far.
    largest: Largest,
}

impl ResultQuery {
    /// Computes the results by following the motion once more. Returns `None` if that is cancelled.
    #[must_use]
    pub fn answer(self) -> Option<Answers> {
        let determined = self.kinematics.determined();
        let count = determined.system().results().reductions.len();
        let cancel = self.cancel.clone();
        let mut analysis = Analysis {
            query: self,
            determined,
            estimates: vec![None; count],
            missing: vec![None; count],
            steps: None,
            sampler: None,
            singular: SingularIntervals::new(),
            largest: Largest::default(),
        };
        while let Some(level) = analysis.next_level() {
            let followed = analysis.follow(&level);
            if cancel.is_cancelled() {
                return None;
            }
            if let Err(why) = followed {
                return Some(analysis.without_motion(&why));
            }
        }
        Some(analysis.answers())
    }

    /// Returns a follower of its own to some times.
    fn motion(&self, times: Times) -> Follower {
        let mut motion = Follower::new((self.kinematics.clone(), self.state.clone(), self.solver.clone()), times);
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

    /// Returns the reductions that can be computed now, because those in their formulas are resolved, or `None` if no reduction is left.
    fn next_level(&mut self) -> Option<Vec<usize>> {
        let determined = Arc::clone(&self.determined);
        let system = determined.system();
        let mut level = Vec::new();
        let open: Vec<usize> = (0..self.estimates.len()).filter(|&k| self.estimates[k].is_none()).collect();
        for k in open {
            let reduction = &system.results().reductions[k];
            let mut needed = needed(system.graph(), reduction.of);
            needed.extend(times(reduction).flat_map(|time| self::needed(system.graph(), time)));
            if let Some(cause) = needed.iter().find_map(|&other| self.estimates[other].and_then(Result::err)) {
                self.estimates[k] = Some(Err(cause));
            } else if needed.iter().all(|&other| self.estimates[other].is_some()) {
                level.push(k);
            }
        }
        (!level.is_empty()).then_some(level)
    }

    /// Follows the motion for some reductions.
    fn follow(&mut self, level: &[usize]) -> Result<(), Box<Stop>> {
        let determined = Arc::clone(&self.determined);
        let system = determined.system();
        let mut requests: Vec<(usize, Reduction, [f64; 2])> = Vec::with_capacity(level.len());
        for &k in level {
            let reduction = system.results().reductions[k];
            match self.window(&reduction) {
                Ok(window) => requests.push((k, reduction, window)),
                Err(cause) => self.estimates[k] = Some(Err(cause)),
            }
        }
        let of: Vec<(ExprId, [u64; 2])> =
            requests.iter().map(|(_, reduction, window)| (reduction.of, window.map(f64::to_bits))).collect();
        let known = |k: usize| self.estimates[k].and_then(Result::ok).map_or(0.0, |found| found.value);
        let new_places = || StateSampler::new(self.query.kinematics.clone(), self.query.solver.clone());
        let mut sampler = self.sampler.take().unwrap_or_else(new_places);
        let (all, curve_of) = curves(system, &of, known, sampler.variations());
        let mut all: Vec<FormulaReductions> =
            all.into_iter().map(|(curve, window)| FormulaReductions::new(curve, window.map(f64::from_bits))).collect();
        let at = |reduction: &Reduction| match reduction.kind {
            ReductionKind::At(at) => self.value(at, false),
            _ => f64::NAN,
        };
        let at: Vec<f64> = requests.iter().map(|(_, reduction, _)| at(reduction)).collect();
        for (((_, reduction, _), &of), &at) in requests.iter().zip(&curve_of).zip(&at) {
            all[of].request(reduction.kind, at);
        }
        self.look(&mut all, &mut sampler)?;
        self.sampler = Some(sampler);
        for (((k, reduction, _), &of), &at) in requests.iter().zip(&curve_of).zip(&at) {
            self.estimates[*k] = Some(self.query.certain(&all[of], (reduction.kind, at), &self.singular));
            self.missing[*k] = all[of].missing(reduction.kind);
        }
        Ok(())
    }

    /// Returns the window (s) of a reduction.
    fn window(&self, reduction: &Reduction) -> Result<[f64; 2], NoValueCause> {
        let [from, to] = self.query.interval;
        let bound = |bound: Option<ExprId>, end: f64| bound.map_or(end, |bound| self.value(bound, false));
        let window = [bound(reduction.window[0], from), bound(reduction.window[1], to)];
        match window.into_iter().find(|t| !(from <= *t && *t <= to)) {
            Some(t) => Err(NoValueCause::Window(t)),
            None if window[1] < window[0] => Err(NoValueCause::Window(window[1])),
            None => Ok(window),
        }
    }

    /// Evaluates formulas along the whole motion, which is followed once if its steps can be kept.
    fn look(&mut self, all: &mut [FormulaReductions], sampler: &mut StateSampler) -> Result<(), Box<Stop>> {
        let [from, to] = self.query.interval;
        let span = to - from;
        if let Some(steps) = &self.steps {
            for reduced in all.iter_mut() {
                reduced.look((steps, self.largest), sampler, span);
            }
            return Ok(());
        }
        let mut motion = self.query.motion(Times::listed(from, vec![to]));
        let (mut steps, mut is_whole) = (Vec::new(), true);
        self.singular = SingularIntervals::new();
        let determined = Arc::clone(&self.determined);
        while !self.query.cancel.is_cancelled() {
            let next = motion.next_segment()?;
            let is_end = next.is_none();
            if let Some(step) = next {
                self.singular.take_note(&step, &motion);
                for state in [&step.from, &step.to] {
                    self.largest
                        .note(state, determined.system().coordinates().iter().map(|coordinate| coordinate.kind));
                }
                push_step(&mut steps, step);
            }
            if is_end && span <= 0.0 {
                sampler.enter_where(&motion.switches());
                for reduced in all.iter_mut() {
                    reduced.look_at_start(motion.here(), sampler);
                }
                return Ok(());
            }
            // steps towards a singular position are replaced once the way over it is known
            let is_full = steps.len() >= CHUNK.min(1 + NUMBERS / (1 + motion.here().q.len()));
            if is_end || (is_full && motion.was_clear_here()) {
                steps = cut_where_unlike(steps, sampler);
                for reduced in all.iter_mut() {
                    reduced.look((&steps, self.largest), sampler, span);
                }
                if is_end {
                    self.steps = is_whole.then_some(steps);
                    return Ok(());
                }
                (is_whole, steps) = (false, Vec::new());
            }
        }
        Ok(())
    }

    /// Returns answers without values, because the motion ends before the analysis does.
    fn without_motion(&self, stop: &Stop) -> Answers {
        let outcomes = &self.system().results().outcomes;
        let notes = outcomes
            .first()
            .map(|first| errors::results_without_motion(first, outcomes.len(), &stop.explain(self.system())));
        Answers {
            values: vec![None; outcomes.len()],
            digits: vec![0; outcomes.len()],
            notes: notes.into_iter().collect(),
            has_all_rows: false,
        }
    }

    /// Returns the value of a formula of parameters and resolved reductions; NaN if one of them has none.
    fn value(&self, formula: ExprId, unknown_is_false: bool) -> f64 {
        self.value_with(formula, unknown_is_false, (usize::MAX, 0.0))
    }

    /// Returns the value of a formula with the reduction `varied` moved by `times` times its error bound.
    fn value_with(&self, formula: ExprId, unknown_is_false: bool, (varied, times): (usize, f64)) -> f64 {
        let system = self.system();
        let found = |k: usize| {
            let found = self.estimates[k].and_then(Result::ok).unwrap_or(Estimate::NOTHING);
            found.value + if k == varied { times * found.error } else { 0.0 }
        };
        value_of(system.graph(), (formula, unknown_is_false), |k| system.params()[k as usize].value, found)
    }

    /// Returns the estimate of an outcome, with an error bound from those of its reductions; no value if it divides by a reduction that cannot be
    /// told from zero.
    fn estimate(&self, outcome: &Outcome, needed: &[usize]) -> Estimate {
        let (formula, is_false) = (outcome.value, outcome.unknown_is_false);
        let value = self.value(formula, is_false);
        let mut error = 0.0;
        for &k in needed {
            let [more, less] = [1.0, -1.0].map(|times| self.value_with(formula, is_false, (k, times)) - value);
            error += f64::max(more.abs(), less.abs());
            let is_of_time = matches!(self.system().results().reductions[k].kind, ReductionKind::At(_));
            let is_bent = (more + less).abs() > 0.5 * (more - less).abs();
            // whichever way it is off: what goes to one side alone is another branch
            if is_of_time && f64::min(more.abs(), less.abs()) >= 0.5 * value.abs() && is_bent {
                return Estimate::NOTHING;
            }
        }
        Estimate { value, error }
    }

    fn answers(&self) -> Answers {
        let system = self.system();
        let was_followed = self.sampler.is_some();
        let has_all_rows = was_followed && self.singular.is_clear() && system.forces().is_none();
        let mut answers = Answers { has_all_rows, ..Answers::default() };
        for outcome in &system.results().outcomes {
            let needed = needed(system.graph(), outcome.value);
            let found = self.estimate(outcome, &needed);
            let value = found.value;
            if !value.is_finite() {
                let cause = needed.into_iter().find_map(|k| self.estimates[k].and_then(Result::err));
                answers.values.push(None);
                answers.digits.push(0);
                answers.notes.push(errors::result_without_value(outcome, cause));
                continue;
            }
            let digits = found.certain_digits();
            // −0 would surprise a reader
            answers.values.push(Some(value + 0.0));
            answers.digits.push(digits);
            if let Some(t) = needed.iter().find_map(|&k| self.missing[k]) {
                answers.notes.push(errors::result_with_gaps(outcome, t));
            }
            if 0 < digits && digits < FEW {
                answers.notes.push(errors::result_with_few_digits(outcome, digits));
            }
        }
        answers
    }
}

/// Adds a step to others. One over a singular position stands for those too that have come near to that: it begins where the motion was clear.
fn push_step(steps: &mut Vec<SmoothSegment>, mut step: SmoothSegment) {
    if let Some(bridge) = &step.bridge {
        let clear = &bridge.from;
        while let Some(last) = steps.pop_if(|last| last.from.t >= clear.t) {
            step.begins_at_edge = last.begins_at_edge && last.from.t <= clear.t;
        }
        if let Some(last) = steps.last_mut()
            && last.to.t > clear.t
        {
            last.to.copy_from(clear);
            last.middle = None;
        }
        step.from.copy_from(clear);
    }
    steps.push(step);
}

/// Cuts steps in which the states at both ends do not determine the motion: a driver may start and stop within one.
fn cut_where_unlike(steps: Vec<SmoothSegment>, sampler: &mut StateSampler) -> Vec<SmoothSegment> {
    if !sampler.has_signals() {
        return steps;
    }
    let mut found = Vec::with_capacity(steps.len());
    for step in steps {
        let shortest = SHORTEST * (step.to.t - step.from.t);
        let mut open = vec![step];
        while let Some(step) = open.pop() {
            match sampler.unlike(&step).filter(|_| step.to.t - step.from.t > shortest) {
                Some(within) => open.extend(step.cut_at(within).into_iter().rev()),
                None => found.push(step),
            }
        }
    }
    found
}

/// Returns the distinct formulas of some reductions with their windows, and the index of each reduction's formula. Reductions that a formula
/// contains are replaced by their values as far as these are known.
fn curves<W: Copy + PartialEq>(
    system: &ConstraintSystem,
    requests: &[(ExprId, W)],
    found: impl Fn(usize) -> f64,
    variations: usize,
) -> (Vec<(Curve, W)>, Vec<usize>) {
    let (mut graph, mut known) = (Graph::new(), FxHashMap::default());
    graph.import_tables(system.graph(), &mut known, Graph::symbol);
    let mut curve_of: Vec<usize> = Vec::new();
    let mut ids: Vec<(ExprId, W)> = Vec::new();
    for (of, window) in requests {
        graph.import(system.graph(), &[*of], &mut known, |graph, symbol| match symbol {
            Symbol::Named(k) => graph.constant(found(k as usize)),
            other => graph.symbol(other),
        });
        let id = (known[of], *window);
        let at = ids.iter().position(|&other| other == id).unwrap_or_else(|| {
            ids.push(id);
            ids.len() - 1
        });
        curve_of.push(at);
    }
    let given: Vec<ExprId> = system.loads().iter().map(|load| load.force).collect();
    graph.import(system.graph(), &given, &mut known, Graph::symbol);
    let loads: Vec<ExprId> = given.iter().map(|load| known[load]).collect();
    let curve = |(id, window)| (Curve::new(&mut graph, id, &loads, system, variations), window);
    (ids.into_iter().map(curve).collect(), curve_of)
}

/// Returns the value of a formula of parameters and reductions; NaN if one of them has none.
fn value_of(
    graph: &Graph,
    (formula, unknown_is_false): (ExprId, bool),
    params: impl Fn(u32) -> f64,
    found: impl Fn(usize) -> f64,
) -> f64 {
    let value = |symbol| match symbol {
        Symbol::Param(k) => params(k),
        Symbol::Shift(_) => 0.0,
        Symbol::Named(k) => found(k as usize),
        _ => f64::NAN,
    };
    match graph.node(formula) {
        // most results are a reduction and nothing else
        Node::Symbol(symbol) => value(symbol),
        _ if unknown_is_false => graph.value(formula, value),
        _ => graph.value_if_known(formula, value),
    }
}

/// Returns the formulas of the times (s) in a reduction: that of a value, those of a window.
fn times(reduction: &Reduction) -> impl Iterator<Item = ExprId> {
    let at = if let ReductionKind::At(at) = reduction.kind { Some(at) } else { None };
    at.into_iter().chain(reduction.window.into_iter().flatten())
}

/// Returns the reductions that a formula contains.
fn needed(graph: &Graph, formula: ExprId) -> Vec<usize> {
    let of = |symbol: Symbol| match symbol {
        Symbol::Named(k) => Some(k as usize),
        _ => None,
    };
    graph.symbols(formula).into_iter().filter_map(of).collect()
}
