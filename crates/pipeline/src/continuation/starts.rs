//! Starting positions of mechanisms that have parts, or are given other inputs than the nominal ones. Each part is assembled alone and
//! continued to the inputs that the whole gives it. The whole is continued from its nominal inputs to those that are given.

use super::messages::{ContinuationTarget, passed_bifurcation, stopped_path};
use super::shared_paths::{PartTarget, SharedPath, shared_paths};
use crate::lowering::lower_model;
use crate::options::RunOptions;
use mechc_engine::analysis::{self, ContinuationOptions, Horizon, Request, Solving, Unassembled, Warning};
use mechc_engine::sweep::CompiledSystem;
use mechc_ir::{ConstraintSystem, PartStart};
use mechc_lang::check::{self, CheckOptions, ParamOverride};
use mechc_lang::lower::{InputPath, Inputs, LowerOptions};
use mechc_lang::model::{ContinuedParam, Input, Mechanism};
use mechc_text::diag::{Diagnostic, Diagnostics};
use mechc_text::source::{Sources, Span};
use rustc_hash::{FxHashMap, FxHashSet};
use std::rc::Rc;
use std::sync::Arc;

/// Finds the starting position of a mechanism that has parts or is given inputs.
#[derive(Debug)]
pub(crate) struct StartSolver {
    pub model: Arc<Mechanism>,
    /// The options of its check.
    pub check_options: Arc<CheckOptions>,
    pub sources: Sources,
    pub has_given_inputs: bool,
}

/// The beginning of a continuation to given inputs.
pub(crate) enum ContinuationOrigin {
    /// At the position that the nominal inputs give at a time (s).
    Nominal(f64),
    /// At a time (s) and coordinates [m, rad].
    Configuration(f64, Vec<f64>),
    /// There is no such position, and the estimates of the text are assembled instead.
    Estimates,
}

/// The coordinates that a mechanism is assembled from [m, rad].
pub(crate) enum InitialGuess {
    /// The position at the end of a continuation.
    Position(Vec<f64>),
    /// Estimates with the starting positions of the parts; `None` for the estimates of the text.
    Estimates(Option<Vec<f64>>),
}

/// Returns whether a mechanism has parts.
fn has_parts(system: &CompiledSystem) -> bool {
    !system.determined.system().parts().is_empty()
}

impl StartSolver {
    /// Returns what the mechanism is assembled from at the first time of a horizon, with diagnostics of the continuations and the
    /// fraction of the first path that stopped.
    pub fn initial_guess(
        &self,
        system: &CompiledSystem,
        horizon: Horizon,
        origin: &ContinuationOrigin,
        leave_out_redundant: bool,
        options: &RunOptions,
    ) -> (InitialGuess, Diagnostics, Option<f64>) {
        let RunOptions { tolerance, pass_bifurcations, ref cancel, .. } = *options;
        let (t, configuration) = match origin {
            ContinuationOrigin::Nominal(t) => (*t, None),
            ContinuationOrigin::Configuration(t, q) => (*t, Some(q.as_slice())),
            ContinuationOrigin::Estimates => (horizon.from, None),
        };
        let options = &ContinuationOptions { tolerance, pass_bifurcations, t, cancel: cancel.clone() };
        let mut search = StartSearch {
            check_options: &self.check_options,
            sources: &self.sources,
            configuration,
            leave_out_redundant,
            options,
            standalone: FxHashMap::default(),
            continued: FxHashMap::default(),
            diagnostics: Diagnostics::default(),
            stopped_path: None,
        };
        let position = if self.has_given_inputs && !matches!(origin, ContinuationOrigin::Estimates) {
            search.continue_to_given_inputs(&self.model, horizon.from)
        } else {
            None
        };
        let guess = position.map_or_else(
            || {
                let settings = &self.check_options.settings;
                let estimates = has_parts(system).then(|| search.estimates_with_parts(system, horizon, settings));
                InitialGuess::Estimates(estimates)
            },
            InitialGuess::Position,
        );
        (guess, search.diagnostics, search.stopped_path)
    }
}

/// A mechanism at the first time of its own analysis, with its nominal inputs.
struct Standalone {
    model: Mechanism,
    /// The settings of its params.
    settings: Vec<ParamOverride>,
    /// The first time (s).
    t: f64,
    /// The values of its inputs then (SI), by their names.
    inputs: FxHashMap<String, f64>,
    /// Its coordinates [m, rad]; the estimates if it cannot be assembled.
    q: Vec<f64>,
    is_assembled: bool,
    /// Diagnostics of its start.
    remarks: Diagnostics,
}

/// A part that has to be continued to other inputs.
struct PendingPart<'p> {
    start: &'p PartStart,
    standalone: Rc<Standalone>,
    /// Target values (SI).
    inputs: &'p [f64],
    target: TargetKey,
}

impl PendingPart<'_> {
    /// Returns the values of its inputs (SI) where it is standalone; `None` if one of them is unknown.
    fn nominal_inputs(&self) -> Option<Vec<f64>> {
        self.start.inputs.iter().map(|(name, _)| self.standalone.inputs.get(name).copied()).collect()
    }
}

/// Identifies a standalone part, and the inputs and time that it is continued to.
#[derive(Clone, PartialEq, Eq, Hash)]
struct TargetKey {
    standalone: StandaloneKey,
    /// Bits of the inputs and of the time.
    values: Vec<u64>,
}

/// Identifies a part by all that decides its standalone position.
#[derive(Clone, PartialEq, Eq, Hash)]
struct StandaloneKey {
    text: Span,
    /// Bits of its params.
    params: Vec<u64>,
    /// Its path if an option sets something in it, else empty.
    path: String,
}

/// A standalone part, with the key of its target if it is continued.
struct ResolvedPart {
    target: Option<TargetKey>,
    standalone: Rc<Standalone>,
}

/// A mechanism whose equations hold a path parameter from 0 to 1 in place of time.
struct PathModel {
    system: CompiledSystem,
    /// The inputs that change along the path.
    inputs: Vec<ContinuedParam>,
    span: Span,
}

struct StartSearch<'s> {
    check_options: &'s CheckOptions,
    sources: &'s Sources,
    /// The position [m, rad] at which the continuation of the whole begins, if it is known.
    configuration: Option<&'s [f64]>,
    leave_out_redundant: bool,
    options: &'s ContinuationOptions,
    standalone: FxHashMap<StandaloneKey, Option<Rc<Standalone>>>,
    /// Coordinates [m, rad] at the targets that were reached.
    continued: FxHashMap<TargetKey, Vec<f64>>,
    diagnostics: Diagnostics,
    /// The fraction of the first path that stopped.
    stopped_path: Option<f64>,
}

impl StartSearch<'_> {
    /// Continues the whole to the inputs that are given, at a time (s); `None` if no path leads there.
    fn continue_to_given_inputs(&mut self, model: &Mechanism, t: f64) -> Option<Vec<f64>> {
        let times = [self.options.t, t];
        // fails if an input has no value at an end of the path
        let PathModel { system, inputs, span } = self.path_model(model, times, &[])?;
        let from = if let Some(configuration) = self.configuration {
            Some(configuration.to_vec())
        } else if has_parts(&system) {
            let mut nominal = model.clone();
            nominal.inputs.iter_mut().for_each(|input| input.formula = input.nominal.clone());
            Some(self.assembled(nominal, self.check_options.settings.clone()).q)
        } else {
            None
        };
        // without a position at the beginning there is no path
        let path = analysis::lead(&system.determined, &system.program, from.as_deref(), &[1.0], self.options).ok()?;
        match path.stopped {
            None => {
                self.diagnostics.extend(path.warnings);
                let report = |warning: &Warning| {
                    let along = (warning, system.determined.system());
                    passed_bifurcation(None, &ContinuationTarget::from_params(&inputs), times, warning.t, along)
                };
                let passed: Vec<Diagnostic> = path.passed.iter().map(report).collect();
                self.diagnostics.extend(passed);
            }
            Some(_) if self.options.cancel.is_cancelled() => {}
            Some(stop) => {
                let along = (&*stop, system.determined.system());
                self.diagnostics.push(stopped_path(
                    None,
                    &ContinuationTarget::from_params(&inputs),
                    times,
                    span,
                    stop.t,
                    along,
                ));
                self.stopped_path.get_or_insert(stop.t);
            }
        }
        path.reached.into_iter().next()
    }

    fn path_model(&self, model: &Mechanism, times: [f64; 2], targets: &[(String, f64)]) -> Option<PathModel> {
        let path = InputPath::new(model, times, targets)?;
        let inputs = path.continued(model);
        let on_path = LowerOptions { inputs: Inputs::AlongPath(path), ..LowerOptions::default() };
        let system = lower_model(model, &on_path);
        let horizon = Horizon::of_analysis(system.analysis());
        let (determined, _) = analysis::determine(system, self.leave_out_redundant, horizon).ok()?;
        Some(PathModel { system: CompiledSystem::new(determined), inputs, span: model.declared.span })
    }

    /// Returns the estimates of a mechanism [m, rad], its parts at their starting positions.
    fn estimates_with_parts(
        &mut self,
        system: &CompiledSystem,
        horizon: Horizon,
        settings: &[ParamOverride],
    ) -> Vec<f64> {
        let CompiledSystem { determined, program } = system;
        let estimates = estimates(determined.system());
        let cancel = self.options.cancel.clone();
        let mut solve = |requests: &[Request]| self.parts(determined.system(), requests, horizon.from, settings);
        analysis::with_parts(determined, program, horizon, estimates, &mut solve, &cancel)
    }

    /// Returns the coordinates of parts [m, rad], continued to the inputs that are requested.
    fn parts(
        &mut self,
        system: &ConstraintSystem,
        requests: &[Request],
        t: f64,
        settings: &[ParamOverride],
    ) -> Vec<Option<Vec<f64>>> {
        let mut pending: Vec<PendingPart<'_>> = Vec::new();
        let mut resolved: Vec<Option<ResolvedPart>> = Vec::with_capacity(requests.len());
        let mut is_requested: FxHashSet<TargetKey> = FxHashSet::default();
        for Request { part, inputs } in requests {
            let start = &system.parts()[*part];
            let Some((key, standalone)) = self.standalone_part(system, start, settings) else {
                resolved.push(None);
                continue;
            };
            let inputs = inputs.as_ref().filter(|_| standalone.is_assembled);
            let target = inputs.map(|inputs| {
                let values = inputs.iter().chain([&t]).map(|value| value.to_bits()).collect();
                TargetKey { standalone: key, values }
            });
            if let (Some(inputs), Some(target)) = (inputs, &target)
                && !self.continued.contains_key(target)
                && is_requested.insert(target.clone())
            {
                let standalone = Rc::clone(&standalone);
                pending.push(PendingPart { start, standalone, inputs, target: target.clone() });
            }
            resolved.push(Some(ResolvedPart { target, standalone }));
        }
        self.continue_parts(&pending, t);
        let position = |ResolvedPart { target, standalone }: ResolvedPart| {
            let continued = target.and_then(|target| self.continued.get(&target).cloned());
            continued.unwrap_or_else(|| standalone.q.clone())
        };
        resolved.into_iter().map(|part| part.map(position)).collect()
    }

    /// Returns the standalone position of a part, with its key.
    fn standalone_part(
        &mut self,
        system: &ConstraintSystem,
        start: &PartStart,
        settings: &[ParamOverride],
    ) -> Option<(StandaloneKey, Rc<Standalone>)> {
        let params: Vec<(String, f64)> =
            start.params.iter().map(|(name, id)| (name.clone(), system.value_at(*id, &[]))).collect();
        let settings = settings_in_part(settings, &start.name);
        let path = if settings.is_empty() { String::new() } else { start.name.clone() };
        let bits = params.iter().map(|(_, value)| value.to_bits()).collect();
        let key = StandaloneKey { text: start.text, params: bits, path };
        let standalone = self.standalone(start, &key, params, settings)?;
        Some((key, standalone))
    }

    /// Continues parts to their targets; reports in their order which of them do not arrive.
    fn continue_parts(&mut self, parts: &[PendingPart<'_>], t: f64) {
        let nominal: Vec<Option<Vec<f64>>> = parts.iter().map(PendingPart::nominal_inputs).collect();
        let targets: Vec<PartTarget<'_, StandaloneKey>> = parts
            .iter()
            .zip(&nominal)
            .map(|(part, nominal)| {
                let has_other_time = part.standalone.t.total_cmp(&t).is_ne();
                let (key, inputs) = (&part.target.standalone, part.inputs);
                PartTarget { key, nominal: nominal.as_deref(), inputs, has_other_time }
            })
            .collect();
        let mut diagnostics: Vec<(usize, Diagnostic)> = Vec::new();
        for path in shared_paths(&targets) {
            self.continue_along(&path, parts, t, &mut diagnostics);
        }
        diagnostics.sort_by_key(|(part, _)| *part);
        self.diagnostics.extend(diagnostics.into_iter().map(|(_, diagnostic)| diagnostic));
    }

    /// Continues the parts that share a path.
    fn continue_along(
        &mut self,
        shared: &SharedPath,
        parts: &[PendingPart<'_>],
        t: f64,
        diagnostics: &mut Vec<(usize, Diagnostic)>,
    ) {
        let PendingPart { start, ref standalone, inputs, .. } = parts[shared.farthest];
        let times = [standalone.t, t];
        let targets = start.inputs.iter().zip(inputs).map(|((name, _), value)| (name.clone(), *value));
        let targets: Vec<(String, f64)> = targets.collect();
        let Some(PathModel { system, inputs, span }) = self.path_model(&standalone.model, times, &targets) else {
            return;
        };
        let stops: Vec<f64> = shared.stops.iter().map(|(fraction, _)| *fraction).collect();
        let from = Some(standalone.q.as_slice());
        let Ok(path) = analysis::lead(&system.determined, &system.program, from, &stops, self.options) else { return };
        let mut reached = path.reached.into_iter();
        for (end, members) in &shared.stops {
            let q = reached.next();
            for &part in members {
                let PendingPart { start, target, .. } = &parts[part];
                match (&q, &path.stopped) {
                    (Some(q), _) => {
                        self.continued.insert(target.clone(), q.clone());
                        let inputs = shortened(&inputs, *end);
                        let before = path.passed.iter().filter(|warning| warning.t <= *end);
                        diagnostics.extend(before.map(|warning| {
                            let (inputs, along) =
                                (ContinuationTarget::from_params(&inputs), (warning, system.determined.system()));
                            (part, passed_bifurcation(Some(start), &inputs, times, warning.t / end, along))
                        }));
                    }
                    (None, Some(stop)) if !self.options.cancel.is_cancelled() => {
                        let inputs = ContinuationTarget::from_params(&shortened(&inputs, *end));
                        let (fraction, along) = (stop.t / end, (&**stop, system.determined.system()));
                        diagnostics.push((part, stopped_path(Some(start), &inputs, times, span, fraction, along)));
                        self.stopped_path.get_or_insert(fraction);
                    }
                    (None, _) => {}
                }
            }
        }
    }

    fn standalone(
        &mut self,
        start: &PartStart,
        key: &StandaloneKey,
        params: Vec<(String, f64)>,
        settings: Vec<ParamOverride>,
    ) -> Option<Rc<Standalone>> {
        if let Some(cached) = self.standalone.get(key) {
            return cached.clone();
        }
        let CheckOptions { library, files, .. } = self.check_options.clone();
        let check_options = CheckOptions { settings, library, files, bound: params, ..CheckOptions::default() };
        let tree = self.check_options.library.mechanism_at(start.text);
        let model = tree.and_then(|tree| check::check(tree, &check_options, self.sources).0);
        let standalone = model.map(|model| Rc::new(self.assembled(model, check_options.settings)));
        if let Some(standalone) = &standalone {
            self.diagnostics.extend(standalone.remarks.clone());
        }
        self.standalone.insert(key.clone(), standalone.clone());
        standalone
    }

    /// Assembles a mechanism at the first time of its own analysis, with its nominal inputs.
    fn assembled(&mut self, mut model: Mechanism, settings: Vec<ParamOverride>) -> Standalone {
        model.by.clear();
        let t = model.first_time();
        let inputs = nominal_inputs(&model, t);
        let system = lower_model(&model, &LowerOptions::default());
        let (q, remarks) = (estimates(&system), Diagnostics::default());
        let mut standalone = Standalone { model, settings, t, inputs, q, is_assembled: false, remarks };
        let horizon = Horizon::of_analysis(system.analysis()).beginning(t);
        let Ok((determined, _)) = analysis::determine(system, self.leave_out_redundant, horizon) else {
            return standalone;
        };
        let system = CompiledSystem::new(determined);
        if has_parts(&system) {
            standalone.q = self.estimates_with_parts(&system, horizon, &standalone.settings);
        }
        let ContinuationOptions { tolerance, pass_bifurcations, ref cancel, .. } = *self.options;
        let (CompiledSystem { determined, program }, cancel) = (system, cancel.clone());
        let unassembled = Unassembled { determined, program, horizon, tolerance, pass_bifurcations, cancel };
        if let Ok(started) = analysis::start_from(&unassembled, Some(&standalone.q), Solving::With(None)) {
            standalone.remarks = started.remarks();
            standalone.q = started.q().to_vec();
            standalone.is_assembled = true;
        }
        standalone
    }
}

/// Returns the estimates of all coordinates [m, rad].
fn estimates(system: &ConstraintSystem) -> Vec<f64> {
    system.coordinates().iter().map(|coordinate| system.value_at(coordinate.estimate, &[])).collect()
}

/// Returns the values (SI) of the inputs of a mechanism at a time (s), by their names.
fn nominal_inputs(model: &Mechanism, t: f64) -> FxHashMap<String, f64> {
    let value = |input: &Input| (input.declared.name.clone(), model.value_at(input.formula.value, t));
    model.inputs.iter().map(value).collect()
}

/// Returns inputs whose paths end at a fraction of theirs.
fn shortened(inputs: &[ContinuedParam], fraction: f64) -> Vec<ContinuedParam> {
    let shorter = |input: &ContinuedParam| {
        let [from, to] = input.line;
        ContinuedParam { line: [from, from + (to - from) * fraction], ..input.clone() }
    };
    inputs.iter().map(shorter).collect()
}

/// Returns the settings of params in a part, by their names there.
fn settings_in_part(settings: &[ParamOverride], part: &str) -> Vec<ParamOverride> {
    let is_part = |owner: &str| owner == part || part.split_once('[').is_some_and(|(base, _)| base == owner);
    let inner = |setting: &ParamOverride| {
        let (owner, path) = setting.path.split_once('.')?;
        is_part(owner.trim()).then(|| ParamOverride { path: path.trim().to_owned(), value: setting.value.clone() })
    };
    settings.iter().filter_map(inner).collect()
}
