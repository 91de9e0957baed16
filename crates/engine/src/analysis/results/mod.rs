//! Results: numbers for the whole analysis, which do not depend on the requested rows.
//!
//! ```text
//! Started ──▶ separate Follower ──▶ segments ──▶ extrema, integrals, values ──▶ reductions ──▶ results
//! ```
//!
//! The motion is followed a second time, in steps as long as it allows, and sampled between their ends as densely as each formula needs. No bit of
//! a row depends on this.

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
use mechc_ir::{ConstraintSystem, Reduction, ReductionKind, Requirement};
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

/// Returns a diagnostic for each requested time outside the interval (s) of the analysis.
#[must_use]
pub fn refused_results(system: &ConstraintSystem, interval @ [from, to]: [f64; 2]) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    for reduction in &system.results().reductions {
        // the time of another reduction lies within the analysis
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
    /// The number of certain significant digits by result, 17 at most; 0 if it has no value or cannot be distinguished from zero.
    pub digits: Vec<u32>,
    /// Notes on results without a value, with gaps or with few certain digits.
    pub notes: Vec<Diagnostic>,
    /// Requirements that do not hold.
    pub failures: Vec<Diagnostic>,
    /// True if the motion has a row at any time: it was followed to its end, never close to a singular position, and has no forces.
    pub has_all_rows: bool,
}

impl Answers {
    /// Returns the least number of certain digits of all results with a value; 0 if no result has one.
    #[must_use]
    pub fn certain_digits(&self) -> u32 {
        let valid = self.values.iter().zip(&self.digits).filter(|(value, _)| value.is_some());
        valid.map(|(_, digits)| *digits).min().unwrap_or(0)
    }
}

impl Started {
    /// Returns the query for results over an interval (s), at the start of which the mechanism is assembled. `pass` continues beyond bifurcations;
    /// `cancel` stops the computation.
    #[must_use]
    pub fn asked(&self, interval: [f64; 2], pass: bool, cancel: &Cancel) -> ResultQuery {
        let (kinematics, state, solver) = self.parts();
        ResultQuery { kinematics, state, solver, interval, pass, cancel: cancel.clone() }
    }
}

/// A reduction with a valid window.
struct Request {
    /// The number of the reduction.
    k: usize,
    kind: ReductionKind,
    /// The time (s) of [`ReductionKind::At`]; NaN for other kinds.
    at: f64,
}

/// The motion in chunks of segments, and the estimates of the reductions.
struct Analysis {
    query: ResultQuery,
    determined: Arc<Determined>,
    /// The estimate of each reduction, or why it has no value.
    estimates: Vec<Option<Result<Estimate, NoValueCause>>>,
    /// The first time (s) that each reduction leaves out because its formula has no value there.
    missing: Vec<Option<f64>>,
    /// The steps of the motion, once it has been followed, unless there are too many to keep.
    steps: Option<Vec<SmoothSegment>>,
    /// The solver of states between the ends of steps.
    sampler: Option<StateSampler>,
    singular: SingularIntervals,
    /// The magnitudes of the coordinates in the motion so far.
    largest: Largest,
}

impl ResultQuery {
    /// Computes the results by following the motion a second time. Returns `None` if cancelled.
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

    /// Returns a separate follower of the motion to some times.
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

    /// Returns the reductions that can be computed next, because those in their formulas have estimates, or `None` if no reduction is left.
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

    /// Follows the motion to estimate some reductions.
    fn follow(&mut self, level: &[usize]) -> Result<(), Box<Stop>> {
        let determined = Arc::clone(&self.determined);
        let system = determined.system();
        let (mut requests, mut of) = (Vec::with_capacity(level.len()), Vec::with_capacity(level.len()));
        for &k in level {
            let reduction = system.results().reductions[k];
            match self.window(&reduction) {
                Ok(window) => {
                    let at = if let ReductionKind::At(at) = reduction.kind { self.value(at, false) } else { f64::NAN };
                    requests.push(Request { k, kind: reduction.kind, at });
                    of.push((reduction.of, window.map(f64::to_bits)));
                }
                Err(cause) => self.estimates[k] = Some(Err(cause)),
            }
        }
        let resolved = |k: usize| self.estimates[k].and_then(Result::ok).map_or(0.0, |estimate| estimate.value);
        let new_sampler = || StateSampler::new(self.query.kinematics.clone(), self.query.solver.clone());
        let mut sampler = self.sampler.take().unwrap_or_else(new_sampler);
        let (all, curve_of) = curves(system, &of, resolved, sampler.variations());
        let mut all: Vec<FormulaReductions> =
            all.into_iter().map(|(curve, window)| FormulaReductions::new(curve, window.map(f64::from_bits))).collect();
        for (request, &of) in requests.iter().zip(&curve_of) {
            all[of].request(request);
        }
        self.evaluate(&mut all, &mut sampler)?;
        self.sampler = Some(sampler);
        for (request, of) in requests.iter().zip(curve_of) {
            self.estimates[request.k] = Some(self.query.certain_estimate(&all[of], request, &self.singular));
            self.missing[request.k] = all[of].missing(request.kind);
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

    /// Evaluates formulas along the whole motion, which is followed only once if its steps can be kept.
    fn evaluate(&mut self, all: &mut [FormulaReductions], sampler: &mut StateSampler) -> Result<(), Box<Stop>> {
        let [from, to] = self.query.interval;
        let span = to - from;
        if let Some(steps) = &self.steps {
            for reduced in all.iter_mut() {
                reduced.evaluate(steps, self.largest, sampler, span);
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
                self.singular.record(&step, &motion);
                for state in [&step.from, &step.to] {
                    self.largest
                        .note(state, determined.system().coordinates().iter().map(|coordinate| coordinate.kind));
                }
                push_step(&mut steps, step);
            }
            if is_end && span <= 0.0 {
                sampler.set_variation_switches(&motion.switches());
                for reduced in all.iter_mut() {
                    reduced.evaluate_start(motion.here(), sampler);
                }
                return Ok(());
            }
            // steps towards a singular position are replaced when the bridge over it is found
            let is_full = steps.len() >= CHUNK.min(1 + NUMBERS / (1 + motion.here().q.len()));
            if is_end || (is_full && motion.was_clear_here()) {
                steps = divide_unresolved(steps, sampler);
                for reduced in all.iter_mut() {
                    reduced.evaluate(&steps, self.largest, sampler, span);
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
            ..Answers::default()
        }
    }

    /// Returns the value of a formula of parameters and estimated reductions; NaN if one of them has no value.
    fn value(&self, formula: ExprId, unknown_is_false: bool) -> f64 {
        self.value_with(formula, unknown_is_false, usize::MAX, 0.0)
    }

    /// Returns the value of a formula with the reduction `varied` moved by `times` times its error bound.
    fn value_with(&self, formula: ExprId, unknown_is_false: bool, varied: usize, times: f64) -> f64 {
        let system = self.system();
        let reduction = |k: usize| {
            let estimate = self.estimates[k].and_then(Result::ok).unwrap_or(Estimate::NOTHING);
            estimate.value + if k == varied { times * estimate.error } else { 0.0 }
        };
        value_of(system.graph(), formula, unknown_is_false, |k| system.params()[k as usize].value, reduction)
    }

    /// Returns the estimate of a formula of reductions, with an error bound from theirs. It has no value if it divides by a value at a time that
    /// cannot be distinguished from zero: the error of that changes it by half or more, and out of proportion.
    fn estimate(&self, formula: ExprId, is_false: bool, needed: &[usize]) -> Estimate {
        let value = self.value(formula, is_false);
        let mut error = 0.0;
        for &k in needed {
            let [more, less] = [1.0, -1.0].map(|times| self.value_with(formula, is_false, k, times) - value);
            error += f64::max(more.abs(), less.abs());
            let is_of_time = matches!(self.system().results().reductions[k].kind, ReductionKind::At(_));
            let is_bent = (more + less).abs() > 0.5 * (more - less).abs();
            // the change has to occur in both directions: one in a single direction comes from another branch of the formula
            if is_of_time && f64::min(more.abs(), less.abs()) >= 0.5 * value.abs() && is_bent {
                return Estimate::NOTHING;
            }
        }
        Estimate { value, error }
    }

    /// Returns the values of all results, with notes.
    fn answers(&self) -> Answers {
        let system = self.system();
        let was_followed = self.sampler.is_some();
        let has_all_rows = was_followed && self.singular.is_clear() && system.forces().is_none();
        let mut answers = Answers { has_all_rows, ..Answers::default() };
        for outcome in &system.results().outcomes {
            let needed = needed(system.graph(), outcome.value);
            let estimate = self.estimate(outcome.value, outcome.unknown_is_false, &needed);
            let value = estimate.value;
            if !value.is_finite() {
                let cause = needed.into_iter().find_map(|k| self.estimates[k].and_then(Result::err));
                answers.values.push(None);
                answers.digits.push(0);
                answers.notes.push(errors::result_without_value(outcome, cause));
                continue;
            }
            let digits = estimate.certain_digits();
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
        answers.failures =
            system.results().requirements.iter().filter_map(|requirement| self.failure(requirement)).collect();
        answers
    }

    /// Returns the error for a requirement if one of its bounds is exceeded by more than the error of the values, or has no value.
    fn failure(&self, requirement: &Requirement) -> Option<Diagnostic> {
        let system = self.system();
        let value = |formula: ExprId| self.value(formula, false);
        requirement.bounds.iter().find_map(|bound| {
            let needed = needed(system.graph(), bound.excess);
            let excess = self.estimate(bound.excess, false, &needed);
            if !excess.value.is_finite() {
                let cause = needed.into_iter().find_map(|k| self.estimates[k].and_then(Result::err));
                // moments without a value do not count, and there are no others
                let is_without_moments = matches!(cause, Some(NoValueCause::Nowhere(_))) && bound.times.is_some();
                return (!is_without_moments).then(|| errors::requirement_without_value(requirement, cause));
            }
            (excess.value > excess.error).then(|| {
                let times = bound.times.map(|times| [value(times.first), value(times.worst)]);
                errors::requirement_fails(requirement, bound, [value(bound.value), value(bound.bound)], times)
            })
        })
    }
}

/// Appends a step. A step over a singular position replaces those that approached it: it begins where the motion was still clear.
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

/// Divides steps in which the states at both ends do not determine the motion: a driver may start and stop within one.
fn divide_unresolved(steps: Vec<SmoothSegment>, sampler: &mut StateSampler) -> Vec<SmoothSegment> {
    if !sampler.has_signals() {
        return steps;
    }
    let mut parts = Vec::with_capacity(steps.len());
    for step in steps {
        let shortest = SHORTEST * (step.to.t - step.from.t);
        let mut open = vec![step];
        while let Some(step) = open.pop() {
            match sampler.deviating_state(&step).filter(|_| step.to.t - step.from.t > shortest) {
                Some(within) => open.extend(step.cut_at(within).into_iter().rev()),
                None => parts.push(step),
            }
        }
    }
    parts
}

/// Returns the distinct formulas of some reductions with their windows, and the index of each reduction's formula. `reduction` returns the value that
/// replaces a reduction within a formula.
fn curves<W: Copy + PartialEq>(
    system: &ConstraintSystem,
    requests: &[(ExprId, W)],
    reduction: impl Fn(usize) -> f64,
    variations: usize,
) -> (Vec<(Curve, W)>, Vec<usize>) {
    let (mut graph, mut imported) = (Graph::new(), FxHashMap::default());
    graph.import_tables(system.graph(), &mut imported, Graph::symbol);
    let mut curve_of: Vec<usize> = Vec::new();
    let mut ids: Vec<(ExprId, W)> = Vec::new();
    for (of, window) in requests {
        graph.import(system.graph(), &[*of], &mut imported, |graph, symbol| match symbol {
            Symbol::Named(k) => graph.constant(reduction(k as usize)),
            other => graph.symbol(other),
        });
        let id = (imported[of], *window);
        let at = ids.iter().position(|&other| other == id).unwrap_or_else(|| {
            ids.push(id);
            ids.len() - 1
        });
        curve_of.push(at);
    }
    let given: Vec<ExprId> = system.loads().iter().map(|load| load.force).collect();
    graph.import(system.graph(), &given, &mut imported, Graph::symbol);
    let loads: Vec<ExprId> = given.iter().map(|load| imported[load]).collect();
    let curve = |(id, window)| (Curve::new(&mut graph, id, &loads, system, variations), window);
    (ids.into_iter().map(curve).collect(), curve_of)
}

/// Returns the value of a formula of parameters and reductions; NaN if one of them has no value.
fn value_of(
    graph: &Graph,
    formula: ExprId,
    unknown_is_false: bool,
    params: impl Fn(u32) -> f64,
    reduction: impl Fn(usize) -> f64,
) -> f64 {
    let value = |symbol| match symbol {
        Symbol::Param(k) => params(k),
        Symbol::Shift(_) => 0.0,
        Symbol::Named(k) => reduction(k as usize),
        _ => f64::NAN,
    };
    match graph.node(formula) {
        // most results are a single reduction
        Node::Symbol(symbol) => value(symbol),
        _ if unknown_is_false => graph.value(formula, value),
        _ => graph.value_if_known(formula, value),
    }
}

/// Returns the formulas of the times (s) in a reduction: that of [`ReductionKind::At`], and those of the window.
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
