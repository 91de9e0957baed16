//! The last stage: a motion in progress, row by row. Knows where a mechanism starts; the steps are the engine's.

use crate::Compiled;
use crate::continuation::{ContinuationOrigin, ContinuedStart, InitialGuess};
use crate::options::{Configuration, RunOptions};
use crate::part_backtrace::PartBacktrace;
use mechc_engine::analysis::{
    self, Answers, Follower, Horizon, ResultQuery, Solving, Started, Stop, Times, Unassembled,
};
use mechc_engine::sweep::CompiledSystem;
use mechc_ir::layout::{ColumnUnit, RowLayout};
use mechc_ir::structure::Determined;
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Diagnostic, Diagnostics, Error, readable};
use mechc_text::source::Sources;
use std::sync::Arc;

/// The position in which a mechanism was assembled.
#[derive(Clone, PartialEq, Debug)]
pub struct Assembly {
    /// Time (s).
    pub t: f64,
    /// For each coordinate: name, value (SI), unit.
    pub coordinates: Vec<(String, f64, &'static str)>,
    /// Distances by which the bodies moved from their estimates, in words.
    pub moved: String,
    /// Distance to a singular position: 1 is far, 0 is singular.
    pub conditioning: f64,
}

/// A motion in progress: an iterator over its rows, which owns all it needs.
///
/// ```
/// # use mechc::{Cancel, Choice, Memory, Parsed, Redundant, RunOptions, Times};
/// # let text = "mechanism disc {
/// #     ground { point O = (0, 0) }
/// #     body wheel { point O = (0, 0) }
/// #     joint axle: revolute(ground.O, wheel.O)
/// #     driver motor: rotation(axle) = 90 deg/s * t
/// # }";
/// # let checked = Parsed::new("disc.mech", text).check(&Choice::default(), &Memory::default());
/// # let (compiled, _) = checked.compile(Redundant::Refused, &Cancel::default());
/// # let compiled = compiled.expect("it is determined");
/// let times = Times::grid(0.0, 2.0, 0.5).expect("a grid");
/// let (run, _) = compiled.run(&times, &RunOptions::default());
/// let run = run.expect("it assembles");
/// assert_eq!(run.columns()[..4], ["t", "wheel.x", "wheel.y", "wheel.phi"]);
/// let turned: Vec<f64> = run.map(|row| row.expect("it moves")[3]).collect();
/// assert_eq!(turned.len(), 5);
/// assert!((turned[4] - std::f64::consts::PI).abs() < 1e-12);
/// ```
pub struct Run {
    motion: Follower,
    determined: Arc<Determined>,
    columns: Arc<[String]>,
    units: Arc<[ColumnUnit]>,
    assembly: Assembly,
    times: Times,
    cancel: Cancel,
    has_ended: bool,
    stopped_at: Option<f64>,
    /// The query that results are computed from; `None` if there are none.
    result_query: Option<ResultQuery>,
    results: usize,
    backtrace: PartBacktrace,
    /// The texts that diagnostics point into.
    sources: Sources,
}

/// Report on the start of a motion.
#[derive(Clone, Debug, Default)]
pub struct StartReport {
    /// Diagnostics of the start.
    pub diagnostics: Diagnostics,
    /// Why the mechanism does not start.
    pub stop: Option<Box<Stop>>,
    /// The fraction, from 0 to 1, at which a path to the values that are set or given stopped: the mechanism is assembled from the estimates
    /// of the text alone (E0612).
    pub stopped_path: Option<f64>,
}

impl Compiled {
    /// Assembles the mechanism at the first of some times, and returns the motion, with diagnostics of the start. `None` if it cannot be assembled,
    /// starts in a singular position, a formula has no value there, or the work is cancelled.
    ///
    /// If inputs are given, the start is continued to them. There may be an error together with a run: no path leads to the given values
    /// (E0612), and the mechanism was assembled from the estimates of the text alone.
    #[must_use]
    pub fn run(&self, times: &Times, options: &RunOptions) -> (Option<Run>, Diagnostics) {
        let (run, report) = self.run_with_report(times, options);
        (run, report.diagnostics)
    }

    /// Assembles the mechanism as [`Compiled::run`] does, and reports on the start as data.
    #[must_use]
    pub fn run_with_report(&self, times: &Times, options: &RunOptions) -> (Option<Run>, StartReport) {
        Run::new(self, times, options)
    }

    /// Returns the position at a time (s) at which [`Compiled::run`] would begin, with diagnostics of the start. Takes less time than a run.
    ///
    /// ```
    /// # use mechc::{Cancel, Choice, Memory, Parsed, Redundant, RunOptions};
    /// # let text = "mechanism disc {
    /// #     ground { point O = (0, 0) }
    /// #     body wheel { point O = (0, 0) }
    /// #     joint axle: revolute(ground.O, wheel.O)
    /// #     driver motor: rotation(axle) = 90 deg/s * t
    /// # }";
    /// # let checked = Parsed::new("disc.mech", text).check(&Choice::default(), &Memory::default());
    /// # let (compiled, _) = checked.compile(Redundant::Refused, &Cancel::default());
    /// # let compiled = compiled.expect("it is determined");
    /// let (assembly, diagnostics) = compiled.assemble_at(1.0, &RunOptions::default());
    /// assert!(diagnostics.is_empty());
    /// assert_eq!(assembly.expect("it assembles").coordinates[2].1, std::f64::consts::FRAC_PI_2);
    /// ```
    #[must_use]
    pub fn assemble_at(&self, t: f64, options: &RunOptions) -> (Option<Assembly>, Diagnostics) {
        let horizon = Horizon::of_analysis(self.analysis()).beginning(t);
        let (started, report) = self.started(horizon, options, Solving::With(None));
        let mut diagnostics = report.diagnostics;
        match started {
            _ if options.cancel.is_cancelled() => (None, Diagnostics::default()),
            Ok(mut started) => {
                diagnostics.extend(self.backtrace().annotate_all(started.remarks()));
                (Some(assembly(self, &mut started, t)), diagnostics)
            }
            Err(stop) => {
                diagnostics.push(self.explain_start(&stop, horizon));
                (None, diagnostics)
            }
        }
    }

    /// Returns the single time `t` (s), followed from the time `from`.
    pub(crate) fn one_time(&self, from: f64, t: f64) -> Times {
        Times::listed(from, vec![t]).within_analysis_to(self.analysis().map(|[_, to, _]| to))
    }

    /// Returns the configuration at a time (s), followed from the first time of the analysis.
    ///
    /// # Errors
    /// The motion does not get there.
    pub fn configuration_at(&self, t: f64, options: &RunOptions) -> Result<Configuration, Error> {
        let from = self.analysis().map_or(t, |[from, ..]| from.min(t));
        let (run, diagnostics) = self.run(&self.one_time(from, t), options);
        let layout = RowLayout::new(self.system());
        match run.and_then(|mut run| run.next()) {
            Some(Ok(row)) => Ok(Configuration { t, q: layout.position(&row).to_vec() }),
            Some(Err(why)) => Err(why),
            None => Err(Error::new(diagnostics, self.sources())),
        }
    }

    /// Assembles the mechanism at the first time of a horizon, from the estimates of the text or from the end of a continuation; returns the
    /// diagnostics of that, too.
    pub(crate) fn start(&self, horizon: Horizon, options: &RunOptions) -> (Result<Started, Box<Stop>>, StartReport) {
        self.started(horizon, options, Solving::New)
    }

    fn started(
        &self,
        horizon: Horizon,
        options: &RunOptions,
        solving: Solving,
    ) -> (Result<Started, Box<Stop>>, StartReport) {
        let (beginning, mut report) = self.initial_guess(horizon, options);
        // the estimates that follow a path that stops are those of the text with the values that are set
        if let Some(fresh) = report.stopped_path.and_then(|_| self.unbound(&options.cancel)) {
            return fresh.started(horizon, options, solving);
        }
        let started = match beginning {
            StartStage::Started(started) => return (*started, report),
            StartStage::At(InitialGuess::Position(q), at) => self.unassembled(at, options).assemble_at(&q, solving),
            StartStage::At(InitialGuess::Estimates(drawn), at) => {
                let whole = self.unassembled(at, options);
                // if no path leads to what is given or set, the estimates alone are tried
                let started = if report.stopped_path.is_some() {
                    whole.close(drawn.as_deref(), solving)
                } else {
                    analysis::start_from(&whole, drawn.as_deref(), solving)
                };
                // starting positions of parts are no estimates of the text, and moving from them is not reported
                let started = started.map(|started| match drawn {
                    Some(_) => started.moved_from(&whole.kinematics(None).estimates()),
                    None => started,
                });
                started.and_then(|started| {
                    if at.from.total_cmp(&horizon.from).is_eq() {
                        return Ok(started);
                    }
                    let whole = self.unassembled(horizon, options);
                    report.diagnostics.extend(started.far_estimates_at(at.from));
                    let (started, passed) = analysis::follow_to(&whole, (started, at.from))?;
                    report.diagnostics.extend(passed.iter().map(|warning| warning.explain(self.system())));
                    Ok(started)
                })
            }
        };
        (started, report)
    }

    /// Returns the coordinates [m, rad] that come nearest to being assembled at a time (s), for a mechanism that cannot be assembled there.
    pub(crate) fn nearest(&self, t: f64, options: &RunOptions) -> Option<Vec<f64>> {
        let horizon = Horizon::of_analysis(self.analysis()).beginning(t);
        let (from, at) = match self.initial_guess(horizon, options).0 {
            StartStage::Started(started) => (started.ok().map(|started| started.q().to_vec()), horizon),
            StartStage::At(InitialGuess::Position(q), at) => (Some(q), at),
            StartStage::At(InitialGuess::Estimates(drawn), at) => (drawn, at),
        };
        self.unassembled(at, options).nearest(from.as_deref())
    }

    /// Returns the first time of the text's analysis (s), or 0. The estimates select the branch at that time.
    #[must_use]
    pub fn first_time(&self) -> f64 {
        self.analysis().map_or(0.0, |[from, ..]| from)
    }

    /// Returns the mechanism with all that its assembly at the first time of a horizon needs.
    pub(crate) fn unassembled(&self, horizon: Horizon, options: &RunOptions) -> Unassembled {
        let RunOptions { tolerance, pass_bifurcations, ref cancel, .. } = *options;
        let (determined, program) = (Arc::clone(self.determined()), Arc::clone(self.program()));
        Unassembled { determined, program, horizon, tolerance, pass_bifurcations, cancel: cancel.clone() }
    }

    /// Returns the start, as far as continuations decide it, with their diagnostics: to params that are set, to given inputs, and of parts.
    fn initial_guess(&self, horizon: Horizon, options: &RunOptions) -> (StartStage, StartReport) {
        let has_given_inputs = self.start_solver().is_some_and(|(start_solver, _)| start_solver.has_given_inputs);
        let (origin, mut report) = match self.continuation() {
            None => (ContinuationOrigin::Nominal(self.first_time()), StartReport::default()),
            Some(continuation) => {
                let continued = continuation.start_system(self.system(), horizon, options);
                let ContinuedStart { started, diagnostics, stopped_path } = continued;
                let report = StartReport { diagnostics, stop: None, stopped_path };
                match started {
                    Some(Ok(started)) if has_given_inputs => {
                        (ContinuationOrigin::Configuration(horizon.from, started.q().to_vec()), report)
                    }
                    Some(started) => return (StartStage::Started(Box::new(started)), report),
                    None => (ContinuationOrigin::Estimates, report),
                }
            }
        };
        // given inputs may have no value at the first time of the text's analysis
        let is_there = has_given_inputs || self.first_time().total_cmp(&horizon.from).is_eq();
        let at = if is_there { horizon } else { Horizon::of_analysis(self.analysis()).beginning(self.first_time()) };
        let Some((start_solver, leave_out)) = self.start_solver() else {
            return (StartStage::At(InitialGuess::Estimates(None), at), report);
        };
        let system = CompiledSystem { determined: Arc::clone(self.determined()), program: Arc::clone(self.program()) };
        let (guess, more, stopped_path) = start_solver.initial_guess(&system, at, &origin, leave_out, options);
        report.diagnostics.extend(more);
        report.stopped_path = report.stopped_path.or(stopped_path);
        (StartStage::At(guess, at), report)
    }

    /// Describes why the mechanism does not start at the first time of a horizon; proposes an analysis if the text has none, and no values
    /// at 0 s.
    pub(crate) fn explain_start(&self, stop: &Stop, horizon: Horizon) -> Diagnostic {
        let diagnostic = self.backtrace().annotate(stop.explain(self.system()));
        if self.analysis().is_some() || horizon.from.total_cmp(&0.0).is_eq() || !stop.is_without_value() {
            return diagnostic;
        }
        let [from, to] = [horizon.from, horizon.from + horizon.span].map(readable);
        let mend = format!(
            "without an analysis the motion begins at 0 s;\nadd `analysis from {from} s to {to} s every 10 ms` to the file"
        );
        diagnostic.help(mend)
    }
}

/// A start, as far as continuations decide it.
enum StartStage {
    /// Assembled, or why that fails.
    Started(Box<Result<Started, Box<Stop>>>),
    /// To be assembled from a guess, at the first time of a horizon.
    At(InitialGuess, Horizon),
}

impl Run {
    fn new(compiled: &Compiled, times: &Times, options: &RunOptions) -> (Option<Run>, StartReport) {
        let refused = times.interval().map(|interval| analysis::refused_results(compiled.system(), interval));
        if let Some(refused) = refused.filter(Diagnostics::has_errors) {
            return (None, StartReport { diagnostics: refused, ..StartReport::default() });
        }
        let horizon = Horizon::of(times);
        let (started, mut report) = compiled.start(horizon, options);
        let mut started = match started {
            _ if options.cancel.is_cancelled() => return (None, StartReport::default()),
            Ok(started) => started,
            Err(stop) => {
                report.diagnostics.push(compiled.explain_start(&stop, horizon));
                report.stop = Some(stop);
                return (None, report);
            }
        };
        report.diagnostics.extend(compiled.backtrace().annotate_all(started.remarks()));
        started.use_vectors(options.vectors);
        let assembly = assembly(compiled, &mut started, times.from());
        let results = compiled.system().results().outcomes.len();
        let has_queries = results > 0 || !compiled.system().results().requirements.is_empty();
        let interval = times.interval().filter(|_| has_queries);
        let result_query = interval.map(|interval| started.asked(interval, options.pass_bifurcations, &options.cancel));
        let mut motion = started.into_motion(times);
        if options.pass_bifurcations {
            motion.pass_bifurcations();
        }
        let (columns, units) = (compiled.columns().into(), compiled.units().into());
        let (times, cancel) = (times.clone(), options.cancel.clone());
        let run = Run {
            determined: Arc::clone(compiled.determined()),
            motion,
            columns,
            units,
            assembly,
            times,
            cancel,
            has_ended: false,
            stopped_at: None,
            result_query,
            results,
            backtrace: compiled.backtrace().clone(),
            sources: compiled.sources().clone(),
        };
        (Some(run), report)
    }

    /// Returns the names of the columns.
    #[must_use]
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Returns the units in which the columns are printed; rows themselves are in SI.
    #[must_use]
    pub fn units(&self) -> &[ColumnUnit] {
        &self.units
    }

    /// Returns the position at the first time.
    #[must_use]
    pub fn assembly(&self) -> &Assembly {
        &self.assembly
    }

    /// Returns the time (s) at which the motion stopped; `None` if it goes on or has come to its end.
    #[must_use]
    pub fn stopped_at(&self) -> Option<f64> {
        self.stopped_at
    }

    /// Returns the output times.
    #[must_use]
    pub fn times(&self) -> &Times {
        &self.times
    }

    /// Returns the next row, in SI and the order of [`Run::columns`], without a copy; `None` after the last one, and when it is cancelled.
    ///
    /// # Errors
    /// The motion cannot continue, and this is why; no rows follow.
    pub fn next_row(&mut self) -> Option<Result<&[f64], Error>> {
        if self.has_ended || self.cancel.is_cancelled() {
            return None;
        }
        match self.motion.next_row() {
            Some(Ok(row)) => Some(Ok(row)),
            None => {
                self.has_ended = true;
                None
            }
            Some(Err(stop)) => {
                (self.has_ended, self.stopped_at) = (true, Some(stop.t));
                let why = self.backtrace.annotate(stop.explain(self.determined.system()));
                Some(Err(Error::new(why, &self.sources)))
            }
        }
    }

    /// Returns the results, in the order of [`Compiled::results`], and the requirements that do not hold. `None` if only some times were requested or the work is cancelled; results have
    /// no values if the motion has stopped. The first call follows the motion once more, later ones return `None`.
    pub fn results(&mut self) -> Option<Answers> {
        let result_query = self.result_query.take()?;
        if self.stopped_at.is_some() {
            let count = self.results;
            return Some(Answers { values: vec![None; count], digits: vec![0; count], ..Answers::default() });
        }
        let mut answers = result_query.answer()?;
        for list in [&mut answers.notes, &mut answers.failures] {
            let mut diagnostics = Diagnostics::default();
            diagnostics.extend(std::mem::take(list));
            *list = self.backtrace.annotate_all(diagnostics).into_iter().collect();
        }
        Some(answers)
    }

    /// Records from now on the times at which accelerations jump.
    pub fn keep_edges(&mut self) {
        self.motion.keep_edges();
    }

    /// Returns the times (s) at which accelerations jumped, rising; some may be after the last row.
    #[must_use]
    pub fn edges(&self) -> Vec<f64> {
        self.motion.edges()
    }

    /// Returns the warnings and notes of the rows so far, and forgets them.
    pub fn take_warnings(&mut self) -> Diagnostics {
        let warnings = self.motion.take_warnings();
        let mut diagnostics = Diagnostics::default();
        diagnostics.extend(warnings.iter().map(|warning| warning.explain(self.determined.system())));
        self.backtrace.annotate_all(diagnostics)
    }
}

impl Iterator for Run {
    type Item = Result<Vec<f64>, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        self.next_row().map(|row| row.map(<[f64]>::to_vec))
    }
}

fn assembly(compiled: &Compiled, started: &mut analysis::Started, t: f64) -> Assembly {
    let system = compiled.system();
    let conditioning = started.conditioning();
    let coordinates = system.coordinates().iter().zip(started.q());
    let coordinates = coordinates.map(|(c, &q)| (c.name.clone(), q, c.kind.unit())).collect();
    Assembly { t, coordinates, moved: started.moved().in_words(system), conditioning }
}

#[cfg(test)]
mod tests {
    use crate::{Choice, Compiled, Parsed, Redundant, RunOptions};
    use mechc_engine::analysis::Times;
    use mechc_text::cancel::Cancel;
    use mechc_text::world::Memory;

    fn compiled(cancel: &Cancel) -> Option<Compiled> {
        let text = include_str!("../../../examples/hoeken.mech");
        let checked = Parsed::new("hoeken.mech", text).check(&Choice::default(), &Memory::default());
        checked.compile(Redundant::Refused, cancel).0
    }

    #[test]
    fn cancelled_work_gives_nothing_and_reports_nothing() {
        let cancel = Cancel::default();
        let determined = compiled(&cancel).expect("it is determined");
        let options = RunOptions { cancel: cancel.clone(), ..RunOptions::default() };
        let times = Times::grid(0.0, 1e9, 1.0).expect("a grid");
        let mut run = determined.run(&times, &options).0.expect("it assembles");
        assert!(run.next_row().is_some_and(|row| row.is_ok()));
        cancel.cancel();
        assert!(run.next_row().is_none(), "it went on, or was told why");
        let (run, diagnostics) = determined.run(&times, &options);
        assert!(run.is_none() && diagnostics.is_empty());
        assert!(compiled(&cancel).is_none());
    }

    #[test]
    fn stages_go_to_other_threads() {
        fn is_shared<T: Send + Sync + Clone>() {}
        fn is_sent<T: Send>() {}
        is_shared::<Parsed>();
        is_shared::<crate::Checked>();
        is_shared::<Compiled>();
        is_sent::<crate::Run>();
    }
}
