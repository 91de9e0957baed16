//! Checks, compiles and runs a mechanism with the settings of a page.

use super::file_snapshot::FileSnapshot;
use super::host::Host;
use mechc_engine::analysis::Times;
use mechc_pipeline::{
    Checked, Choice, Compiled, DragHandle, EvaluatorOptions, InputControl, InputMotion, MechanismEvaluator, NotReached,
    ParamControl, ParametricMechanism, Parsed, Redundant, RunOptions, Visualization,
};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Color, Diagnostic, Diagnostics, Error, Format, render};
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
    /// Moves the inputs that were last moved by hand.
    mover: Mutex<Option<Arc<InputMover>>>,
}

/// The motion of a mechanism, or its picture at rest if it does not move.
pub(super) struct Motion {
    pub visualization: Option<Visualization>,
    /// The diagnostics of the mechanism and its motion.
    diagnostics: Diagnostics,
}

impl Solution {
    fn unreadable(sources: Sources, diagnostics: Diagnostics) -> Solution {
        let (checked, compiled, times, motion, mover) = Default::default();
        Solution { sources, checked, compiled, times, diagnostics, motion, mover }
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

    /// Solves the mechanism with params set; `None` if it is cancelled. `parametric` is the mechanism with these params as numbers.
    pub fn with_params(
        &self,
        baseline: &Solution,
        parametric: Option<&ParametricMechanism>,
        set: &[(String, String)],
        cancel: &Cancel,
    ) -> Option<Solution> {
        let formulas: Vec<&str> = set.iter().map(|(_, formula)| formula.as_str()).collect();
        let bound = parametric.and_then(|parametric| parametric.with(&formulas));
        let solution = match bound {
            Some((checked, compiled, diagnostics)) => self.solution(checked, Some(compiled), diagnostics),
            None => self.solve(&self.choice(baseline, set), cancel),
        };
        (!cancel.is_cancelled()).then_some(solution)
    }

    /// Returns the mechanism with params as numbers that take other values; `None` if one of them cannot, or if it is cancelled.
    pub fn parametric(&self, baseline: &Solution, names: &[String], cancel: &Cancel) -> Option<ParametricMechanism> {
        baseline.checked.as_ref()?.parametric(names, self.redundant, cancel)
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

    fn options(&self, cancel: &Cancel) -> RunOptions {
        let pass_bifurcations = self.pass_bifurcations;
        RunOptions { pass_bifurcations, cancel: cancel.clone(), ..RunOptions::default() }
    }

    fn solve(&self, choice: &Choice, cancel: &Cancel) -> Solution {
        let parsed = match self.parsed {
            Ok(parsed) => parsed,
            Err(Error { sources, diagnostics, .. }) => {
                return Solution::unreadable(sources.clone(), diagnostics.clone());
            }
        };
        let checked = parsed.check(choice, self.files);
        let mut diagnostics = checked.diagnostics().clone();
        let (compiled, more) = checked.compile(self.redundant, cancel);
        diagnostics.extend(more);
        self.solution(checked, compiled, diagnostics)
    }

    fn solution(&self, checked: Checked, compiled: Option<Compiled>, mut diagnostics: Diagnostics) -> Solution {
        let mut sources = checked.sources().clone();
        let times = compiled.as_ref().map(|compiled| self.host.times(compiled, &mut sources));
        let times = times.and_then(|times| times.map_err(|why| diagnostics.extend(why)).ok());
        let (motion, mover) = Default::default();
        Solution { sources, checked: Some(checked), compiled, times, diagnostics, motion, mover }
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
        let options = self.options(cancel);
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
        checked.visualize_at(compiled, [from, t], &self.options(cancel), baseline).filter(|_| !cancel.is_cancelled())
    }

    /// Moves inputs (by name, to SI values) by hand while time stands still, as far as they get; `None` if it is cancelled.
    pub fn move_inputs(
        &self,
        solution: &Solution,
        t: f64,
        inputs: &[(String, f64)],
        cancel: &Cancel,
    ) -> Option<MoveOutcome> {
        let failure = |text: String| Some(MoveOutcome { reached: json!([]), message: Some(text), columns: Vec::new() });
        let mover = match self.mover(solution, t, inputs, cancel) {
            Ok(Some(mover)) => mover,
            Ok(None) => return failure(solution.rendered()),
            Err(_) if cancel.is_cancelled() => return None,
            Err(why) => return failure(rendered(&why.diagnostics, &why.sources)),
        };
        let ends: Vec<f64> = mover
            .names
            .iter()
            .map(|name| inputs.iter().find(|(input, _)| input == name).map_or(f64::NAN, |(_, to)| *to))
            .collect();
        let (mut message, mut limit) = (None, 1.0);
        for shortened in std::iter::once(1.0).chain(FRACTIONS_BEFORE_DEAD_POINT) {
            let fraction = limit * if limit < 1.0 { shortened } else { 1.0 };
            let values = mover.values(&ends, fraction);
            let motions: Vec<InputMotion> =
                values.iter().map(|&value| InputMotion { value, ..InputMotion::default() }).collect();
            let outcome = mover.evaluator.reach(&motions, t, cancel);
            if cancel.is_cancelled() {
                return None;
            }
            match outcome {
                Ok(row) => {
                    let reached: Vec<Value> =
                        mover.names.iter().zip(values).map(|(name, value)| json!([name, value])).collect();
                    let columns = row.into_iter().map(|value| vec![value]).collect();
                    return Some(MoveOutcome { reached: json!(reached), message, columns });
                }
                Err(NotReached { error, fraction: stop }) => {
                    message = message.or_else(|| Some(without_help(error)));
                    limit = stop.map_or(limit, |stop| fraction * stop).min(1.0 - f64::EPSILON);
                }
            }
        }
        failure(message.unwrap_or_default())
    }

    /// Returns what moves inputs from where the motion is at a time (s); `None` if the mechanism does not move.
    fn mover(
        &self,
        solution: &Solution,
        t: f64,
        inputs: &[(String, f64)],
        cancel: &Cancel,
    ) -> Result<Option<Arc<InputMover>>, Error> {
        let Some((checked, compiled)) = solution.checked.as_ref().zip(solution.compiled.as_ref()) else {
            return Ok(None);
        };
        let available = solution.inputs(&[t]);
        let moved: Vec<&InputControl> =
            available.iter().filter(|input| inputs.iter().any(|(name, _)| *name == input.name)).collect();
        let mut cached = lock(&solution.mover);
        let is_current = |mover: &&Arc<InputMover>| {
            mover.t.to_bits() == t.to_bits() && mover.names.iter().eq(moved.iter().map(|input| &input.name))
        };
        if let Some(mover) = cached.as_ref().filter(is_current) {
            return Ok(Some(Arc::clone(mover)));
        }
        let start = compiled.configuration_at(t, &self.options(cancel))?;
        let names: Vec<String> = moved.iter().map(|input| input.name.clone()).collect();
        let (redundant, pass_bifurcations) = (self.redundant, self.pass_bifurcations);
        let (inputs, start) = (names.clone(), Some(start));
        let options = EvaluatorOptions { inputs, start, redundant, pass_bifurcations, ..EvaluatorOptions::default() };
        let evaluator = checked.evaluator(&options, cancel)?;
        let starts = moved.iter().filter_map(|input| input.values.first().copied()).collect();
        let mover = Arc::new(InputMover { t, names, starts, evaluator });
        Ok(Some(Arc::clone(cached.insert(mover))))
    }
}

/// Moves inputs from where they are at a time.
struct InputMover {
    /// The time (s).
    t: f64,
    names: Vec<String>,
    /// The values of the inputs then (SI).
    starts: Vec<f64>,
    evaluator: MechanismEvaluator,
}

impl InputMover {
    /// Returns the values (SI) at a fraction of the way to others.
    fn values(&self, ends: &[f64], fraction: f64) -> Vec<f64> {
        let value = |(&from, &to): (&f64, &f64)| if fraction < 1.0 { from + (to - from) * fraction } else { to };
        self.starts.iter().zip(ends).map(value).collect()
    }
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

/// Renders errors without their help: the page keeps the position that was reached, so it does not apply.
fn without_help(error: Error) -> String {
    let shortened = |diagnostic: Diagnostic| Diagnostic { help: Vec::new(), ..diagnostic };
    let mut diagnostics = Diagnostics::default();
    diagnostics.extend(error.diagnostics.into_iter().map(shortened));
    rendered(&diagnostics, &error.sources)
}

fn rendered(diagnostics: &Diagnostics, sources: &Sources) -> String {
    let text = |diagnostic| render(diagnostic, sources, Format::Human, Color::Never);
    diagnostics.iter().map(text).collect()
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
