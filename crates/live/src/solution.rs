//! Checks, compiles and runs a mechanism with the settings of a page.

use super::file_snapshot::FileSnapshot;
use super::host::Host;
use mechc_engine::analysis::Times;
use mechc_pipeline::{
    Checked, Choice, Compiled, Configuration, DragHandle, InputControl, ParamControl, Parsed, Redundant, RunOptions,
    Visualization,
};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Code, Color, Diagnostics, Error, Format, render};
use mechc_text::source::Sources;
use serde_json::{Value, json};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The maximum number of rows of a motion; from a longer motion some rows are left out.
const MAX_ROWS: usize = 2000;
/// The fractions of the path to a dead point that are tried: at the point itself the position is singular.
const FRACTIONS_BEFORE_DEAD_POINT: [f64; 3] = [1.0 - 1e-6, 1.0 - 1e-4, 1.0 - 1e-2];

/// A mechanism as far as it can be checked and compiled, with its diagnostics.
pub(super) struct Solution {
    pub sources: Sources,
    pub checked: Option<Checked>,
    compiled: Option<Compiled>,
    times: Option<Times>,
    diagnostics: Diagnostics,
    /// The motion, once it was requested.
    motion: Mutex<Option<Arc<Motion>>>,
    /// The configuration at the time at which inputs were last moved by hand.
    configuration: Mutex<Option<Configuration>>,
}

/// The motion of a mechanism, or its picture at rest if it does not move.
pub(super) struct Motion {
    pub visualization: Option<Visualization>,
    /// The diagnostics of the mechanism and its motion.
    diagnostics: Diagnostics,
}

impl Solution {
    fn unreadable(sources: Sources, diagnostics: Diagnostics) -> Solution {
        let (motion, configuration) = Default::default();
        Solution { sources, checked: None, compiled: None, times: None, diagnostics, motion, configuration }
    }

    pub fn is_sound(&self) -> bool {
        self.checked.as_ref().is_some_and(Checked::is_sound)
    }

    /// Renders all diagnostics as `run` prints them.
    pub fn rendered(&self) -> String {
        let motion = lock(&self.motion).clone();
        rendered(motion.as_ref().map_or(&self.diagnostics, |motion| &motion.diagnostics), &self.sources)
    }

    pub fn params(&self) -> Vec<ParamControl> {
        self.checked.as_ref().map(Checked::param_controls).unwrap_or_default()
    }

    pub fn cranks(&self) -> Vec<DragHandle> {
        let from = self.times.as_ref().map_or(0.0, Times::from);
        self.compiled.as_ref().map(|compiled| compiled.drag_handles(from)).unwrap_or_default()
    }

    /// Returns the inputs with their values at some times (s).
    pub fn inputs(&self, times: &[f64]) -> Vec<InputControl> {
        let both = self.checked.as_ref().zip(self.compiled.as_ref());
        both.map(|(checked, compiled)| checked.input_controls(compiled, times)).unwrap_or_default()
    }
}

/// Computes solutions from one version of the texts.
pub(super) struct SolutionBuilder<'s> {
    /// The tree of the file, or why it could not be read.
    pub parsed: &'s Result<Parsed, Error>,
    pub files: &'s FileSnapshot,
    /// The options of the command: the mechanism and its settings.
    pub choice: &'s Choice,
    pub redundant: Redundant,
    pub pass_bifurcations: bool,
    /// The host, which decides the output times.
    pub host: &'s dyn Host,
}

impl SolutionBuilder<'_> {
    /// Solves the mechanism as it is written.
    pub fn baseline(&self, cancel: &Cancel) -> Solution {
        self.solve(self.choice, cancel)
    }

    /// Solves the mechanism with params set; `None` if it is cancelled.
    pub fn with_params(&self, baseline: &Solution, set: &[(String, String)], cancel: &Cancel) -> Option<Solution> {
        let solution = self.solve(&self.choice(baseline, set), cancel);
        (!cancel.is_cancelled()).then_some(solution)
    }

    /// Returns the options of `run --lead --set …`. A param that decides the number of bodies is set without continuation.
    fn choice(&self, baseline: &Solution, set: &[(String, String)]) -> Choice {
        let params = baseline.params();
        let can_be_continued =
            |(name, _): &(String, String)| params.iter().any(|param| param.name == *name && param.is_continuous);
        let is_continued = |param: &ParamControl| param.is_continuous || self.command_setting(&param.name).is_none();
        let lead = set.iter().all(can_be_continued) && params.iter().all(is_continued);
        let mut choice = Choice { lead, ..self.choice.clone() };
        choice.set.extend(set.iter().map(|(name, formula)| format!("{name}={formula}")));
        choice
    }

    /// Returns the `--set` of the command for a param, or for the point of which it is a coordinate.
    pub fn command_setting(&self, name: &str) -> Option<&str> {
        let names_it = |path: &str| {
            let path: String = path.chars().filter(|c| !c.is_whitespace()).collect();
            name.strip_prefix(path.as_str()).is_some_and(|axis| ["", ".x", ".y"].contains(&axis))
        };
        let sets_it = |set: &&String| set.split_once('=').is_some_and(|(path, _)| names_it(path));
        self.choice.set.iter().rev().find(sets_it).map(String::as_str)
    }

    fn options(&self, stand: Option<Configuration>, cancel: &Cancel) -> RunOptions {
        let pass_bifurcations = self.pass_bifurcations;
        RunOptions { pass_bifurcations, configuration: stand, cancel: cancel.clone(), ..RunOptions::default() }
    }

    fn solve(&self, choice: &Choice, cancel: &Cancel) -> Solution {
        let parsed = match self.parsed {
            Ok(parsed) => parsed,
            Err(Error { sources, diagnostics, .. }) => {
                return Solution::unreadable(sources.clone(), diagnostics.clone());
            }
        };
        let checked = parsed.check(choice, self.files);
        let (mut diagnostics, mut sources) = (checked.diagnostics().clone(), checked.sources().clone());
        let (compiled, more) = checked.compile(self.redundant, cancel);
        diagnostics.extend(more);
        let times = compiled.as_ref().map(|compiled| self.host.times(compiled, &mut sources));
        let times = times.and_then(|times| times.map_err(|why| diagnostics.extend(why)).ok());
        let (motion, configuration) = Default::default();
        Solution { sources, checked: Some(checked), compiled, times, diagnostics, motion, configuration }
    }

    /// Computes the motion of a solution; `None` if it is cancelled. Symbols and extent are those of the baseline, so that the picture
    /// does not jump while a param changes.
    pub fn motion(
        &self,
        solution: &Solution,
        baseline: Option<&Visualization>,
        cancel: &Cancel,
    ) -> Option<Arc<Motion>> {
        if let Some(motion) = &*lock(&solution.motion) {
            return Some(Arc::clone(motion));
        }
        let mut diagnostics = solution.diagnostics.clone();
        let options = self.options(None, cancel);
        let visualization = solution.checked.as_ref().and_then(|checked| {
            let (compiled, times) = (solution.compiled.as_ref(), solution.times.as_ref());
            let moving = compiled.zip(times).and_then(|(compiled, times)| {
                let (moving, more) = checked.visualization_like(compiled, times, &options, MAX_ROWS, baseline);
                diagnostics.extend(more);
                moving
            });
            let from = times.map_or(0.0, Times::from);
            let mut at_rest = || {
                let mut still = checked.static_visualization(compiled, (from, &options), &diagnostics)?;
                still.scene.extent = baseline.map_or(still.scene.extent, |baseline| baseline.scene.extent);
                Some(still)
            };
            moving.or_else(&mut at_rest)
        });
        let motion = Arc::new(Motion { visualization, diagnostics });
        (!cancel.is_cancelled()).then(|| Arc::clone(lock(&solution.motion).insert(motion)))
    }

    /// Computes the picture at one time, which is quicker than the motion; `None` if the time is not reached or the work is cancelled.
    pub fn preview(
        &self,
        solution: &Solution,
        baseline: &Visualization,
        t: f64,
        cancel: &Cancel,
    ) -> Option<Visualization> {
        let (checked, compiled) = solution.checked.as_ref().zip(solution.compiled.as_ref())?;
        let from = solution.times.as_ref().map(Times::from).filter(|from| *from <= t)?;
        checked
            .visualize_at(compiled, [from, t], &self.options(None, cancel), baseline)
            .filter(|_| !cancel.is_cancelled())
    }

    /// Moves inputs by hand while time stands still, as far as they get; `None` if it is cancelled.
    pub fn move_inputs(
        &self,
        solution: &Solution,
        set: &[(String, String)],
        t: f64,
        inputs: &[(String, f64)],
        cancel: &Cancel,
    ) -> Option<MoveOutcome> {
        let failure = |text: String| Some(MoveOutcome { reached: json!([]), message: Some(text), columns: Vec::new() });
        let Some(compiled) = &solution.compiled else { return failure(solution.rendered()) };
        let start = match self.configuration(solution, compiled, t, cancel) {
            Ok(start) => start,
            Err(_) if cancel.is_cancelled() => return None,
            Err(why) => return failure(rendered(&why.diagnostics, &solution.sources)),
        };
        let available = solution.inputs(&[t]);
        let moves = inputs.iter().filter_map(|(name, to)| InputMove::new(&available, name, *to));
        let moves: Vec<InputMove> = moves.collect();
        let (mut message, mut limit) = (None, 1.0);
        for shortened in std::iter::once(1.0).chain(FRACTIONS_BEFORE_DEAD_POINT) {
            let fraction = limit * if limit < 1.0 { shortened } else { 1.0 };
            let overrides: Vec<(&str, String)> =
                moves.iter().map(|input| (input.name.as_str(), input.override_at(fraction))).collect();
            let RowAttempt { row, diagnostics, sources, stopped_path } =
                self.row_with(self.choice(solution, set), &start, &overrides, cancel);
            if cancel.is_cancelled() {
                return None;
            }
            match (row, stopped_path) {
                (Some(row), None) => {
                    let reached: Vec<Value> =
                        moves.iter().map(|input| json!([input.name, input.at(fraction)])).collect();
                    let message =
                        message.or_else(|| (!diagnostics.is_empty()).then(|| rendered(&diagnostics, &sources)));
                    let columns = row.into_iter().map(|value| vec![value]).collect();
                    return Some(MoveOutcome { reached: json!(reached), message, columns });
                }
                (_, stop) => {
                    message = message.or_else(|| Some(rendered(&without_fallback(&diagnostics), &sources)));
                    limit = stop.map_or(limit, |stop| fraction * stop).min(1.0 - f64::EPSILON);
                }
            }
        }
        failure(message.unwrap_or_default())
    }

    /// Returns the configuration at a time, with the inputs as they are written.
    fn configuration(
        &self,
        solution: &Solution,
        compiled: &Compiled,
        t: f64,
        cancel: &Cancel,
    ) -> Result<Configuration, Error> {
        let mut cached = lock(&solution.configuration);
        if let Some(configuration) = cached.as_ref().filter(|cached| cached.t.to_bits() == t.to_bits()) {
            return Ok(configuration.clone());
        }
        let configuration = compiled.configuration_at(t, &self.options(None, cancel))?;
        *cached = Some(configuration.clone());
        Ok(configuration)
    }

    /// Computes the row with inputs overridden (by name, as `--input` takes them), if it is reached from a configuration.
    fn row_with(
        &self,
        mut choice: Choice,
        start: &Configuration,
        overrides: &[(&str, String)],
        cancel: &Cancel,
    ) -> RowAttempt {
        let Ok(parsed) = self.parsed else { return RowAttempt::default() };
        let is_replaced = |input: &String| {
            input.split_once('=').is_some_and(|(name, _)| overrides.iter().any(|(moved, _)| *moved == name.trim()))
        };
        choice.inputs.retain(|input| !is_replaced(input));
        choice.inputs.extend(overrides.iter().map(|(_, text)| text.clone()));
        let checked = parsed.check(&choice, self.files);
        let sources = checked.sources().clone();
        let mut diagnostics = checked.diagnostics().clone();
        let (compiled, more) = checked.compile(self.redundant, cancel);
        diagnostics.extend(more);
        let times = Times::listed(start.t, vec![start.t]);
        let mut stopped_path = None;
        let run = compiled.and_then(|compiled| {
            let (run, report) = compiled.run_with_report(&times, &self.options(Some(start.clone()), cancel));
            diagnostics.extend(report.diagnostics);
            stopped_path = report.stopped_path;
            run
        });
        let row = run.and_then(|mut run| match run.next()? {
            Ok(row) => Some(row),
            Err(why) => {
                diagnostics.extend(why.diagnostics);
                None
            }
        });
        RowAttempt { row, diagnostics, sources, stopped_path }
    }
}

/// A row, if it is reached, with the diagnostics and the texts that these refer to.
#[derive(Default)]
struct RowAttempt {
    row: Option<Vec<f64>>,
    diagnostics: Diagnostics,
    sources: Sources,
    /// The fraction of the inputs' path, from 0 to 1, at which it stopped.
    stopped_path: Option<f64>,
}

/// The outcome of moving inputs by hand.
pub(super) struct MoveOutcome {
    /// Names of inputs with the values that they reached (SI).
    pub reached: Value,
    /// The diagnostics for the user, rendered.
    pub message: Option<String>,
    /// The row that was reached, as columns of one value.
    pub columns: Vec<Vec<f64>>,
}

/// The path of an input that is moved by hand.
struct InputMove {
    name: String,
    unit: String,
    /// Its first and last value (SI).
    range: [f64; 2],
}

impl InputMove {
    fn new(available: &[InputControl], name: &str, to: f64) -> Option<InputMove> {
        let input = available.iter().find(|input| input.name == name)?;
        Some(InputMove { name: input.name.clone(), unit: input.unit.clone(), range: [*input.values.first()?, to] })
    }

    fn at(&self, fraction: f64) -> f64 {
        let [from, to] = self.range;
        if fraction < 1.0 { from + (to - from) * fraction } else { to }
    }

    /// Formats the value at a fraction of the path as `--input` takes it.
    fn override_at(&self, fraction: f64) -> String {
        let (name, value) = (&self.name, self.at(fraction));
        match self.unit.strip_prefix('1') {
            Some(per) => format!("{name}={value}{per}"),
            None if self.unit.is_empty() => format!("{name}={value}"),
            None => format!("{name}={value} {}", self.unit),
        }
    }
}

/// Returns the diagnostic that stopped a continuation, without the notes about what was tried instead.
fn without_fallback(diagnostics: &Diagnostics) -> Diagnostics {
    let stop = diagnostics.iter().find(|diagnostic| diagnostic.code == Code::E0612).cloned();
    match stop {
        None => diagnostics.clone(),
        Some(mut stop) => {
            // the page keeps the position that was reached, so neither notes nor help apply
            (stop.notes, stop.help) = (Vec::new(), Vec::new());
            stop.into()
        }
    }
}

fn rendered(diagnostics: &Diagnostics, sources: &Sources) -> String {
    let text = |diagnostic| render(diagnostic, sources, Format::Human, Color::Never);
    diagnostics.iter().map(text).collect()
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
