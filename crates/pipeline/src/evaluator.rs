//! Evaluates a mechanism for many values of some inputs and params, as optimisers and controllers need it; it is compiled once. A result
//! depends on its query alone, not on queries before it.

use crate::batch::{BatchEvaluator, Query, QueryResult};
use crate::continuation::{Continuation, Outcome, PathStop};
use crate::option_reader::unusable;
use crate::param_table::{Binder, Bindings};
use crate::{Checked, Compiled, Configuration, Redundant, RequestedTimes, RunOptions, Variants};
use mechc_engine::analysis::{Answers, ResultQuery, Started, Times};
use mechc_engine::sweep::{LANES, Levels, Points, Varying};
use mechc_lang::model::Mechanism;
use mechc_lang::settable_inputs::SettableInputs;
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Code, Diagnostic, Diagnostics, Error, readable};
use std::sync::Arc;

/// Options of an evaluator.
#[derive(Clone, Debug)]
pub struct EvaluatorOptions {
    /// Names of the inputs that queries set.
    pub inputs: Vec<String>,
    /// True if inputs may have accelerations; if not, accelerations of queries are ignored.
    pub has_accelerations: bool,
    /// Names of the params that queries set.
    pub params: Vec<String>,
    /// The configuration in which inputs have the values of the text; `None` for the start of the mechanism.
    pub start: Option<Configuration>,
    /// The treatment of redundant equations.
    pub redundant: Redundant,
    /// See [`RunOptions::tolerance`].
    pub tolerance: f64,
    /// See [`RunOptions::pass_bifurcations`].
    pub pass_bifurcations: bool,
}

impl Default for EvaluatorOptions {
    fn default() -> EvaluatorOptions {
        let RunOptions { tolerance, pass_bifurcations, .. } = RunOptions::default();
        let (inputs, has_accelerations, params, start, redundant) = Default::default();
        EvaluatorOptions { inputs, has_accelerations, params, start, redundant, tolerance, pass_bifurcations }
    }
}

/// The motion of an input at a time (SI).
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct InputMotion {
    /// Value.
    pub value: f64,
    /// First time derivative.
    pub rate: f64,
    /// Second time derivative.
    pub acceleration: f64,
}

/// A point to evaluate.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct EvaluationPoint {
    /// Time (s); `None` for the first time of the analysis.
    pub t: Option<f64>,
    /// Motions of the inputs at that time.
    pub inputs: Vec<InputMotion>,
    /// Values of the params (SI).
    pub params: Vec<f64>,
}

/// A mechanism that can be evaluated for many values of its inputs and params.
///
/// ```
/// use mechc::{EvaluatorOptions, RequestedTimes, Cancel, Choice, Memory, Parsed, InputMotion};
///
/// let text = "mechanism disc {
///      input turn = 90 deg/s * t
///      ground { point O = (0, 0) }
///      body wheel { point O = (0, 0) }
///      joint axle: revolute(ground.O, wheel.O)
///      driver motor: rotation(axle) = turn
///  }";
/// let checked = Parsed::new("disc.mech", text).check(&Choice::default(), &Memory::default());
/// let adjusting = EvaluatorOptions { inputs: vec!["turn".to_owned()], ..EvaluatorOptions::default() };
/// let disc = checked.evaluator(&adjusting, &Cancel::default()).expect("it is determined");
/// let turn = InputMotion { value: 0.3, rate: 2.0, acceleration: 0.0 };
/// let (once, mut row) = (RequestedTimes { at: vec![0.0], ..RequestedTimes::default() }, Vec::new());
/// let results = disc.follow(&[turn], &[], &once, &Cancel::default(), |values| row.extend_from_slice(values));
/// assert!(results.is_ok());
/// assert_eq!((row[3], row[6]), (0.3, 2.0));
/// ```
#[derive(Clone)]
pub struct MechanismEvaluator(Arc<Shared>);

/// Why values of inputs are not reached.
#[derive(Debug)]
pub struct NotReached {
    /// Why.
    pub error: Error,
    /// The fraction, from 0 to 1, at which the path to them stopped, if that is why.
    pub fraction: Option<f64>,
}

impl From<Error> for NotReached {
    fn from(error: Error) -> NotReached {
        NotReached { error, fraction: None }
    }
}

struct Shared {
    checked: Checked,
    compiled: Compiled,
    continuation: Continuation,
    /// Nominal values of all params.
    nominal: Bindings,
    /// For each input, the index of the first of its params.
    inputs: Vec<usize>,
    /// The params that queries set, if there are any.
    params: Option<Binder>,
    adjusting: EvaluatorOptions,
    /// Number of columns.
    columns: usize,
    /// Evaluates points in lanes.
    batch: BatchEvaluator,
}

/// The last params of a query, with the values of all params that they lead to.
type LastParams = Option<(Vec<f64>, Bindings)>;

impl Checked {
    /// Makes an evaluator of a sound mechanism.
    ///
    /// # Errors
    /// An input or param does not exist, or the mechanism is not determined; with the texts that the diagnostics point into.
    pub fn evaluator(&self, adjusting: &EvaluatorOptions, cancel: &Cancel) -> Result<MechanismEvaluator, Error> {
        let refused = |why: Diagnostic| Error::new(why, self.sources());
        let from = || self.model().map_or(0.0, Mechanism::first_time);
        let t = adjusting.start.as_ref().map_or_else(from, |start| start.t);
        let set_inputs = SettableInputs { t, names: adjusting.inputs.clone(), bend: adjusting.has_accelerations };
        let checked = if adjusting.params.is_empty() {
            Some(self.not_continued())
        } else {
            self.with_symbolic_params(adjusting.params.clone())
        };
        let checked = checked.ok_or_else(|| Error::new(self.diagnostics().clone(), self.sources()))?;
        let checked = checked.with_settable_inputs(set_inputs).map_err(|why| refused(*why))?;
        let (compiled, diagnostics) = checked.compile(adjusting.redundant, cancel);
        let Some((compiled, model)) = compiled.zip(checked.model()) else {
            let why = if checked.is_sound() { &diagnostics } else { checked.diagnostics() };
            return Err(Error::new(why.clone(), checked.sources()));
        };
        let first_param = |name: &String| {
            let is_named = |param: &&mechc_lang::model::ContinuedParam| param.declared.name == *name;
            model.continued.iter().find(is_named).and_then(|param| param.param).map(|k| k as usize)
        };
        let unknown = |name: &String, what: &str| {
            let message = format!("there is no {what} `{name}` that could be adjusted");
            refused(Diagnostic::new(Code::E0703, message))
        };
        let inputs = adjusting.inputs.iter().map(|name| first_param(name).ok_or_else(|| unknown(name, "input")));
        let inputs = inputs.collect::<Result<Vec<usize>, _>>()?;
        if let Some(name) = adjusting.params.iter().find(|name| first_param(name).is_none()) {
            return Err(if self.settable_params().iter().any(|param| param.name == *name) {
                let message = format!(
                    "`{name}` decides what is repeated, and nothing leads from one number of bodies to another"
                );
                refused(unusable(message).help("set it when the mechanism is loaded"))
            } else {
                unknown(name, "param")
            });
        }
        let nominal = Bindings::new(model);
        let rates_of = |&first: &usize| (first as u32 + 2..).take(if adjusting.has_accelerations { 2 } else { 1 });
        let continued = model.continued.iter().filter_map(|param| param.param).collect();
        let batch = BatchEvaluator::new(continued, inputs.iter().flat_map(rates_of).collect());
        let params = self.params_to_adjust(&adjusting.params)?.map(|params| Binder::new(&checked, &params));
        let (source, redundant) = (checked.clone(), adjusting.redundant);
        let start = adjusting.start.clone();
        let continuation = Continuation::new(move |options| source.nominal(redundant, start.as_ref(), options));
        let (adjusting, columns) = (adjusting.clone(), compiled.columns().len());
        let shared = Shared { checked, compiled, continuation, nominal, inputs, params, adjusting, columns, batch };
        Ok(MechanismEvaluator(Arc::new(shared)))
    }

    /// Returns the params of the given names, each of which takes a number in SI.
    fn params_to_adjust(&self, names: &[String]) -> Result<Option<Variants>, Error> {
        if names.is_empty() {
            return Ok(None);
        }
        let params = self.settable_params();
        let param = |name: &String| params.iter().find(|param| param.name == *name);
        let values: Vec<f64> = names.iter().filter_map(|name| Some(param(name)?.value)).collect();
        let units = names.iter().map(|name| param(name).map_or(String::new(), |param| param.unit.clone())).collect();
        let nominal = Varying { params: (0..names.len()).collect(), values: Levels::Listed(values) };
        let Some(points) = Points::new(names.to_vec(), vec![nominal]) else { return Ok(None) };
        Variants::new(points, units, self.sources().clone(), "--set").map(Some)
    }
}

impl MechanismEvaluator {
    /// Returns the compiled mechanism: its columns, their units, the names of its results.
    #[must_use]
    pub fn compiled(&self) -> &Compiled {
        &self.0.compiled
    }

    /// Follows the motion at the requested times, with inputs set at the first of them and params (SI) to which the mechanism is continued along its
    /// branch. `row` receives each row, in SI and the order of the columns. Returns the results, as [`crate::Run::results`] does.
    ///
    /// Inputs and params are in the order of the evaluator's options.
    ///
    /// # Errors
    /// No path leads to the values (E0612), or the motion stops.
    pub fn follow(
        &self,
        inputs: &[InputMotion],
        params: &[f64],
        times: &RequestedTimes,
        cancel: &Cancel,
        row: impl FnMut(&[f64]),
    ) -> Result<Answers, Error> {
        let Bindings { values, analysis } = self.0.bind(params)?;
        let query = self.0.query(values, times.over(analysis)?.times()?, inputs);
        self.0.follow(&query, cancel, row)
    }

    /// Evaluates the mechanism at a time (s) at which inputs are set, with its params as the text has them. Returns the row, as
    /// [`MechanismEvaluator::follow`] does.
    ///
    /// # Errors
    /// No path leads to the values, or the motion stops.
    pub fn reach(&self, inputs: &[InputMotion], t: f64, cancel: &Cancel) -> Result<Vec<f64>, NotReached> {
        let query = self.0.query(self.0.nominal.values.clone(), Times::listed(t, vec![t]), inputs);
        let started = self.0.start(&query, cancel)?;
        let mut row = Vec::new();
        let followed = self.0.follow_from(started, &query.times, cancel, |values| row = values.to_vec());
        followed.map(|_| row).map_err(NotReached::from)
    }

    /// Evaluates `count` points, which `ask` writes. `receive` receives the row of each in their order, in SI and the order of the columns, with the
    /// bits that [`MechanismEvaluator::follow`] gives; or why a point cannot be reached. Cancelling ends it.
    pub fn evaluate_each(
        &self,
        count: usize,
        mut ask: impl FnMut(usize, &mut EvaluationPoint),
        cancel: &Cancel,
        mut receive: impl FnMut(Result<&[f64], Error>),
    ) {
        let (mut point, mut last, mut row) = (EvaluationPoint::default(), None, Vec::new());
        let (shared, options) = (&*self.0, self.0.options(cancel));
        for first in (0..count).step_by(LANES) {
            let mut query = |index| {
                ask(index, &mut point);
                shared.query_at(&point, &mut last)
            };
            let queries: Vec<QueryResult> = (first..count.min(first + LANES)).map(&mut query).collect();
            let lanes = shared.batch.follow(&queries, &shared.continuation, shared.columns, &options);
            for (lane, query) in queries.into_iter().enumerate() {
                let is_in_batch = lanes.as_ref().is_some_and(|lanes| lanes.write_row(lane, &mut row));
                let alone = |query: Query| if is_in_batch { Ok(()) } else { shared.last_row(&query, cancel, &mut row) };
                let outcome = query.and_then(alone);
                if cancel.is_cancelled() {
                    return;
                }
                receive(outcome.map(|()| &row[..shared.columns]));
            }
            if let Some(lanes) = lanes {
                shared.batch.give_back(lanes);
            }
        }
    }
}

impl Shared {
    fn error(&self, why: Diagnostic) -> Error {
        Error::new(why, self.checked.sources())
    }

    fn options(&self, cancel: &Cancel) -> RunOptions {
        let EvaluatorOptions { tolerance, pass_bifurcations, .. } = self.adjusting;
        RunOptions { tolerance, pass_bifurcations, cancel: cancel.clone(), ..RunOptions::default() }
    }

    /// Returns a query with inputs that are set at the first of its times.
    fn query(&self, mut values: Vec<f64>, times: Times, inputs: &[InputMotion]) -> Query {
        for (&first, &InputMotion { value, rate, acceleration }) in self.inputs.iter().zip(inputs) {
            let motion = [value, times.from(), rate, acceleration];
            let count = if self.adjusting.has_accelerations { 4 } else { 3 };
            values[first..first + count].copy_from_slice(&motion[..count]);
        }
        Query { values, times }
    }

    /// Returns the query of a point.
    fn query_at(&self, point: &EvaluationPoint, last: &mut LastParams) -> QueryResult {
        let is_equal = |params: &[f64]| {
            params.iter().map(|value| value.to_bits()).eq(point.params.iter().map(|value| value.to_bits()))
        };
        let current = match last.take().filter(|(params, _)| is_equal(params)) {
            Some(current) => current,
            None => (point.params.clone(), self.bind(&point.params)?),
        };
        let Bindings { values, analysis } = &last.insert(current).1;
        let at = point.t.unwrap_or_else(|| analysis.map_or(0.0, |[from, ..]| from));
        if let Some([from, ..]) = analysis.filter(|[from, ..]| point.inputs.is_empty() && at < *from) {
            let message =
                format!("`t` is {} s, before the first time of the analysis at {} s", readable(at), readable(from));
            let help = "the motion begins there: ask for later times";
            return Err(Diagnostic::new(Code::E0706, message).help(help).into());
        }
        // inputs have their values at that time only
        let from = (!point.inputs.is_empty()).then_some(at);
        let times = RequestedTimes { from, at: vec![at], ..RequestedTimes::default() }.over(*analysis)?.times()?;
        Ok(self.query(values.clone(), times, &point.inputs))
    }

    /// Writes the last row that is followed, which is that of the time.
    fn last_row(&self, query: &Query, cancel: &Cancel, row: &mut Vec<f64>) -> Result<(), Error> {
        row.resize(self.columns, f64::NAN);
        let keep = |followed: &[f64]| {
            row.clear();
            row.extend_from_slice(followed);
        };
        self.follow(query, cancel, keep).map(|_| ())
    }

    fn follow(&self, query: &Query, cancel: &Cancel, row: impl FnMut(&[f64])) -> Result<Answers, Error> {
        let started = self.start(query, cancel).map_err(|why| why.error)?;
        self.follow_from(started, &query.times, cancel, row)
    }

    /// Continues to the values of a query.
    fn start(&self, query: &Query, cancel: &Cancel) -> Result<Started, NotReached> {
        let why = match self.continuation.start_values(&query.values, &query.times, &self.options(cancel)) {
            Outcome::Started(started) => return Ok(*started),
            Outcome::CannotStart(stop, variant) => stop.explain(variant.system()),
            Outcome::Refused(diagnostics) => first_error(diagnostics),
            Outcome::NoPath(Some(PathStop { diagnostic, fraction })) => {
                // nothing else is tried
                let why = Diagnostic { notes: Vec::new(), ..*diagnostic };
                return Err(NotReached { error: self.error(why), fraction: Some(fraction) });
            }
            Outcome::NoPath(None) => {
                let message = "it does not stand with its own values, and so no way leads to others";
                Diagnostic::new(Code::E0612, message)
            }
        };
        Err(self.error(why).into())
    }

    fn follow_from(
        &self,
        mut started: Started,
        times: &Times,
        cancel: &Cancel,
        mut row: impl FnMut(&[f64]),
    ) -> Result<Answers, Error> {
        let options = self.options(cancel);
        // a run reports the conditioning of its start, which restores the factors there; do the same for the same bits
        let _ = started.conditioning();
        let has_results = !self.compiled.system().results().outcomes.is_empty();
        let interval = times.interval().filter(|_| has_results);
        let results = interval.map(|interval| started.asked(interval, options.pass_bifurcations, cancel));
        let mut motion = started.into_motion(times);
        if options.pass_bifurcations {
            motion.pass_bifurcations();
        }
        while let Some(found) = motion.next_row() {
            match found {
                Ok(found) => row(found),
                Err(stop) => return Err(self.error(stop.explain(motion.system()))),
            }
        }
        Ok(results.and_then(ResultQuery::answer).unwrap_or_default())
    }

    /// Binds params (SI), inputs at their nominal values.
    fn bind(&self, params: &[f64]) -> Result<Bindings, Error> {
        self.params.as_ref().map_or_else(|| Ok(self.nominal.clone()), |binder| binder.bind(params))
    }
}

/// Returns the first error; where something could not be made, there is one.
fn first_error(diagnostics: Diagnostics) -> Diagnostic {
    let error = diagnostics.into_iter().find(Diagnostic::is_error);
    // cancelled work has no error, and its diagnostic is never shown
    error.unwrap_or_else(|| Diagnostic::new(Code::E0601, "it was not made"))
}
