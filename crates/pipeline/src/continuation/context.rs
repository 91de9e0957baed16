//! Continuation of one mechanism from its nominal params to others. Keeps what all its variants share, and follows the path of one.

use super::messages::{ContinuationTarget, passed_bifurcation, stopped_path};
use crate::lowering::lower_model;
use crate::options::RunOptions;
use mechc_engine::analysis::{self, ContinuationOptions, Horizon, Started, Stop, Times, Warning};
use mechc_engine::sweep::{CompiledSystem, ContinuationBase, ContinuationError, ContinuedVariant};
use mechc_ir::ConstraintSystem;
use mechc_ir::structure::Determined;
use mechc_lang::lower::{Inputs, LowerOptions, TimeOnPath};
use mechc_lang::model;
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Diagnostic, Diagnostics};
use std::sync::{Arc, OnceLock};

/// The start that a continuation reaches.
#[derive(Default)]
pub(crate) struct ContinuedStart {
    /// The start, or why the mechanism cannot start at its target; `None` if no path leads there.
    pub started: Option<Result<Started, Box<Stop>>>,
    /// Diagnostics of the path.
    pub diagnostics: Diagnostics,
    /// The fraction of the path, from 0 to 1, at which it stopped.
    pub stopped_path: Option<f64>,
}

/// The outcome of a continuation to given values of params.
pub(crate) enum Outcome {
    /// The path reaches its target, where the mechanism starts.
    Started(Box<Started>),
    /// The path reaches its target, where the mechanism of these equations cannot start.
    CannotStart(Box<Stop>, Arc<Determined>),
    /// Results refuse the times, before any path is followed.
    Refused(Diagnostics),
    /// No path reaches the target; with the reason, if a path began.
    NoPath(Option<PathStop>),
}

/// Why a path stopped.
pub(crate) struct PathStop {
    pub diagnostic: Box<Diagnostic>,
    /// The fraction of the path, from 0 to 1.
    pub fraction: f64,
}

/// A mechanism with its nominal values, compiled and assembled at its first time.
pub(crate) struct Nominal {
    pub compiled: CompiledSystem,
    /// Lists the params that a path may change.
    pub model: Arc<model::Mechanism>,
    pub started: Started,
    /// First time (s).
    pub t: f64,
    /// True if it has inputs whose values are set at a time.
    pub sets_inputs: bool,
    pub leave_out_redundant: bool,
}

/// The data that all continuations of one mechanism share.
pub(super) struct ContinuationContext {
    pub nominal: Nominal,
    /// Nominal values of all params (SI).
    pub values: Vec<f64>,
    pub options: ContinuationOptions,
    /// One for variants that begin at the nominal first time, and one for those whose time moves along the path.
    bases: [OnceLock<Option<ContinuationBase>>; 2],
}

impl ContinuationContext {
    pub fn new(nominal: Nominal, options: &RunOptions) -> ContinuationContext {
        let RunOptions { tolerance, pass_bifurcations, ref cancel, .. } = *options;
        let options = ContinuationOptions { tolerance, pass_bifurcations, t: nominal.t, cancel: cancel.clone() };
        let (values, bases) = (nominal.compiled.determined.system().param_values(), [OnceLock::new(), OnceLock::new()]);
        ContinuationContext { nominal, values, options, bases }
    }

    /// Returns whether the options that decide its paths are the given ones.
    pub fn has_options(&self, options: &RunOptions) -> bool {
        self.options.tolerance.to_bits() == options.tolerance.to_bits()
            && self.options.pass_bifurcations == options.pass_bifurcations
    }

    /// Continues to the param values of a system of the same text.
    pub fn start_system(&self, system: &ConstraintSystem, horizon: Horizon, cancel: &Cancel) -> ContinuedStart {
        let mut diagnostics = Diagnostics::default();
        let values = system.param_values();
        let Some(base) = self.base(&values, horizon.from, cancel) else { return ContinuedStart::default() };
        let (times, targets) = ([self.options.t, self.end_time(horizon.from)], || self.targets(system, &values));
        match base.alone(base.variant(&values), horizon, cancel) {
            Ok(ContinuedVariant { started, passed, passed_before_start }) => {
                diagnostics.extend(self.nominal.started.far_estimates_at(self.nominal.t));
                let path_system = base.path_system();
                let report =
                    |warning: &Warning| passed_bifurcation(None, &targets(), times, warning.t, (warning, path_system));
                diagnostics.extend(passed.iter().map(report));
                diagnostics.extend(passed_before_start.iter().map(|warning| warning.explain(system)));
                ContinuedStart { started: Some(Ok(started)), diagnostics, stopped_path: None }
            }
            Err(ContinuationError::AtTarget(stop)) => {
                ContinuedStart { started: Some(Err(stop)), ..ContinuedStart::default() }
            }
            Err(ContinuationError::OnPath(_)) if cancel.is_cancelled() => ContinuedStart::default(),
            Err(ContinuationError::OnPath(stop)) => {
                let span = self.nominal.model.declared.span;
                diagnostics.push(stopped_path(None, &targets(), times, span, stop.t, (&stop, base.path_system())));
                ContinuedStart { started: None, diagnostics, stopped_path: Some(stop.t) }
            }
        }
    }

    /// Continues to values of all params (SI); a path that reaches them leaves no diagnostics.
    pub fn start_values(&self, values: &[f64], times: &Times, cancel: &Cancel) -> Outcome {
        let Some(base) = self.base(values, times.from(), cancel) else { return Outcome::NoPath(None) };
        let variant = base.variant(values);
        let refused = times.interval().map(|interval| analysis::refused_results(variant.system(), interval));
        if let Some(refused) = refused.filter(Diagnostics::has_errors) {
            return Outcome::Refused(refused);
        }
        match base.alone(Arc::clone(&variant), Horizon::of(times), cancel) {
            Ok(arrived) => Outcome::Started(Box::new(arrived.started)),
            Err(ContinuationError::AtTarget(stop)) => Outcome::CannotStart(stop, variant),
            Err(ContinuationError::OnPath(_)) if cancel.is_cancelled() => Outcome::NoPath(None),
            Err(ContinuationError::OnPath(stop)) => {
                let targets = self.targets(variant.system(), values);
                let (ends, span) = ([self.options.t, self.end_time(times.from())], self.nominal.model.declared.span);
                let along = (&*stop, base.path_system());
                let diagnostic = Box::new(stopped_path(None, &targets, ends, span, stop.t, along));
                Outcome::NoPath(Some(PathStop { diagnostic, fraction: stop.t }))
            }
        }
    }

    /// Returns the time (s) at the end of the path of a variant that begins at `from`.
    fn end_time(&self, from: f64) -> f64 {
        if self.nominal.sets_inputs { from } else { self.options.t }
    }

    /// Returns the params with the intervals of their values, for messages.
    fn targets(&self, system: &ConstraintSystem, values: &[f64]) -> Vec<ContinuationTarget> {
        let with_line = |param: &model::ContinuedParam| {
            let k = param.param? as usize;
            Some(model::ContinuedParam {
                line: [self.values[k], values[k]],
                dimension: system.params()[k].dimension,
                ..param.clone()
            })
        };
        let params: Vec<model::ContinuedParam> = self.nominal.model.continued.iter().filter_map(with_line).collect();
        ContinuationTarget::from_params(&params)
    }

    /// Returns what variants share that begin at `from` (s); `None` if the number of values differs.
    pub fn base(&self, values: &[f64], from: f64, cancel: &Cancel) -> Option<&ContinuationBase> {
        // inputs that are set have their values at `from` only, so time has to move along the path
        let time_moves = self.nominal.sets_inputs && from.to_bits() != self.options.t.to_bits();
        let slot = &self.bases[usize::from(time_moves)];
        if slot.get().is_none() {
            let base = self.new_base(time_moves, cancel);
            // the outcome of cancelled work must not be kept
            if cancel.is_cancelled() {
                return None;
            }
            let _ = slot.set(base);
        }
        slot.get()?.as_ref().filter(|_| values.len() == self.values.len())
    }

    fn new_base(&self, time_moves: bool, cancel: &Cancel) -> Option<ContinuationBase> {
        let clock = if time_moves { TimeOnPath::Moving } else { TimeOnPath::Still(self.options.t) };
        let on_path = LowerOptions { inputs: Inputs::ParamsAlongPath(clock), ..LowerOptions::default() };
        let system = lower_model(&self.nominal.model, &on_path);
        let leave_out = self.nominal.leave_out_redundant;
        let (determined, _) = analysis::determine(system, leave_out, Horizon::of_analysis(None)).ok()?;
        let on_path = CompiledSystem::new(determined);
        let params = self.nominal.model.continued.iter().filter_map(|param| param.param).collect();
        let options = ContinuationOptions { cancel: cancel.clone(), ..self.options.clone() };
        ContinuationBase::new(
            self.nominal.compiled.clone(),
            &self.nominal.started,
            on_path,
            (params, time_moves),
            options,
        )
        .ok()
    }
}
