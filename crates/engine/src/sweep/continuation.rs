//! Continuation from the nominal parameters of a mechanism, those of its text, to those of a variant, along the branch. A variant's start
//! depends on its own parameters alone, not on the other variants of a sweep.

use crate::analysis::{self, ContinuationOptions, Horizon, SignalBounds, Solving, Started, Stop, Unassembled, Warning};
use crate::solver::Solver;
use mechc_ir::ConstraintSystem;
use mechc_ir::program::Program;
use mechc_ir::structure::Determined;
use mechc_text::cancel::Cancel;
use std::sync::Arc;

/// A constraint system that is proved determined, with its operations.
#[derive(Clone)]
pub struct CompiledSystem {
    /// The system.
    pub determined: Arc<Determined>,
    /// Its operations.
    pub program: Arc<Program>,
}

impl CompiledSystem {
    /// Returns a system with its operations.
    #[must_use]
    pub fn new(determined: Determined) -> CompiledSystem {
        let program = Arc::new(Program::new(determined.system()));
        CompiledSystem { determined: Arc::new(determined), program }
    }
}

/// A position, with the solver for rows from there on.
#[derive(Clone)]
struct Configuration {
    /// The coordinates [m, rad].
    q: Vec<f64>,
    solver: Option<Arc<Solver>>,
}

impl Configuration {
    fn from_started(started: &Started) -> Configuration {
        Configuration { q: started.q().to_vec(), solver: started.shared_solver() }
    }

    fn to_shared(&self) -> (&[f64], Option<Arc<Solver>>) {
        (&self.q, self.solver.clone())
    }
}

/// The starting point of all continuations of a mechanism, shared by its variants.
pub struct ContinuationBase {
    compiled: CompiledSystem,
    nominal_params: Vec<f64>,
    /// The position with the nominal parameters, at the nominal first time.
    nominal: Configuration,
    /// The system on a path, with further parameters for the path's end (`lower::Inputs::ParamsAlongPath`), and where all paths begin.
    path_system: CompiledSystem,
    path_start: Configuration,
    /// The parameters that a path may change, as indices.
    continued_params: Vec<u32>,
    /// True if time changes along a path.
    time_varies: bool,
    /// The terms of the equations that the fraction of a path alone decides, not linearly; `None` if the equations are not smooth along every
    /// path.
    signals: Option<SignalBounds>,
    options: ContinuationOptions,
}

/// A variant at the end of its continuation.
pub struct ContinuedVariant {
    /// The variant, ready to be followed.
    pub started: Started,
    /// The bifurcations on the path, at fractions of it from 0 to 1.
    pub passed: Vec<Warning>,
    /// The bifurcations on the way from the nominal first time to the requested one.
    pub passed_before_start: Vec<Warning>,
}

/// The reason why a continuation gives no start.
pub enum ContinuationError {
    /// The path ends at a fraction of it, from 0 to 1.
    OnPath(Box<Stop>),
    /// The variant was reached and cannot start.
    AtTarget(Box<Stop>),
}

impl ContinuationBase {
    /// Prepares continuations from `started`, the mechanism with its nominal parameters. `path_system` is the system on a path, which changes
    /// `continued_params` (indices), and time if `time_varies`.
    ///
    /// # Errors
    /// No path can begin at the nominal position.
    pub fn new(
        compiled: CompiledSystem,
        started: &Started,
        path_system: CompiledSystem,
        (continued_params, time_varies): (Vec<u32>, bool),
        options: ContinuationOptions,
    ) -> Result<ContinuationBase, Box<Stop>> {
        let (nominal_params, nominal) =
            (compiled.determined.system().param_values(), Configuration::from_started(started));
        let mut path_start =
            analysis::start_of_paths(&path_system.determined, &path_system.program, &nominal.q, &options)?;
        let signals = path_start.is_smooth().then(|| path_start.signal_bounds());
        let path_start = Configuration::from_started(&path_start);
        Ok(ContinuationBase {
            compiled,
            nominal_params,
            nominal,
            path_system,
            path_start,
            continued_params,
            time_varies,
            signals,
            options,
        })
    }

    /// Returns the compiled system and the nominal parameters (SI).
    pub(super) fn nominal(&self) -> (&CompiledSystem, &[f64]) {
        (&self.compiled, &self.nominal_params)
    }

    /// Returns the first time of the nominal configuration (s).
    pub(super) fn nominal_time(&self) -> f64 {
        self.options.t
    }

    /// Returns whether paths change all of `params` (indices) and are free of events, so that batches may follow them.
    pub(super) fn is_smooth_in(&self, params: &[u32]) -> bool {
        self.signals.is_some() && params.iter().all(|param| self.continued_params.contains(param))
    }

    /// Returns the terms of the equations that the fraction of a path alone decides, not linearly; `None` if these are not smooth along every
    /// path.
    pub(super) fn signals_on_path(&self) -> Option<&SignalBounds> {
        self.signals.as_ref()
    }

    /// Returns the system along a path, with its operations.
    pub(super) fn compiled_path(&self) -> &CompiledSystem {
        &self.path_system
    }

    /// Returns the parameters that a path may change, as indices.
    pub(super) fn continued_params(&self) -> &[u32] {
        &self.continued_params
    }

    /// Returns the parameters of the system along the path to other parameters (SI) and a first time `t` (s).
    pub(super) fn path_params(&self, values: &[f64], t: f64) -> Vec<f64> {
        let ends = self.continued_params.iter().map(|&k| values[k as usize]);
        let times = self.time_varies.then_some([self.options.t, t]).into_iter().flatten();
        self.nominal_params.iter().copied().chain(ends).chain(times).collect()
    }

    /// Returns the equations along a path, whose stops and warnings speak of them.
    #[must_use]
    pub fn path_system(&self) -> &ConstraintSystem {
        self.path_system.determined.system()
    }

    /// Returns the system with other parameters (SI, all of them).
    #[must_use]
    pub fn variant(&self, values: &[f64]) -> Arc<Determined> {
        Arc::new(self.compiled.determined.with_values(values))
    }

    /// Continues to a variant and starts it for `horizon`.
    ///
    /// # Errors
    /// The path ends before the variant, or the variant cannot start.
    pub fn alone(
        &self,
        variant: Arc<Determined>,
        horizon: Horizon,
        cancel: &Cancel,
    ) -> Result<ContinuedVariant, ContinuationError> {
        let ContinuationOptions { tolerance, t: nominal_time, pass_bifurcations, .. } = self.options;
        let (q, passed) = self.continue_to(&variant.system().param_values(), horizon.from, cancel)?;
        let is_at_start_time = self.time_varies || horizon.from.total_cmp(&nominal_time).is_eq();
        let program = Arc::clone(&self.compiled.program);
        let cancel = cancel.clone();
        let unassembled = Unassembled { determined: variant, program, horizon, tolerance, pass_bifurcations, cancel };
        let solving = Solving::With(self.nominal.solver.clone());
        if is_at_start_time {
            let started = unassembled.assemble_at(&q, solving).map_err(ContinuationError::AtTarget)?;
            return Ok(ContinuedVariant { started, passed, passed_before_start: Vec::new() });
        }
        let begun = Unassembled { horizon: horizon.beginning(nominal_time), ..unassembled.clone() };
        let begun = begun.assemble_at(&q, solving);
        let followed = begun.and_then(|begun| analysis::follow_to(&unassembled, (begun, nominal_time)));
        let (started, passed_before_start) = followed.map_err(ContinuationError::AtTarget)?;
        Ok(ContinuedVariant { started, passed, passed_before_start })
    }

    /// Follows the path to other parameters (SI) and a first time `t` (s); returns the coordinates at its end and the bifurcations on it.
    fn continue_to(
        &self,
        values: &[f64],
        t: f64,
        cancel: &Cancel,
    ) -> Result<(Vec<f64>, Vec<Warning>), ContinuationError> {
        let is_nominal = |&k: &u32| values[k as usize].to_bits() == self.nominal_params[k as usize].to_bits();
        if !self.time_varies && self.continued_params.iter().all(is_nominal) {
            return Ok((self.nominal.q.clone(), Vec::new()));
        }
        let determined = Arc::new(self.path_system.determined.with_values(&self.path_params(values, t)));
        let options = ContinuationOptions { cancel: cancel.clone(), ..self.options.clone() };
        let (start, solver) = self.path_start.to_shared();
        let path = analysis::continue_from(&determined, &self.path_system.program, start, solver, &options);
        let mut path = path.map_err(|stop| ContinuationError::OnPath(Box::new(Stop { t: 0.0, ..*stop })))?;
        match (path.reached.pop(), path.stopped) {
            (Some(q), _) => Ok((q, path.passed)),
            (None, Some(stop)) => Err(ContinuationError::OnPath(stop)),
            // cancelled: the caller discards the result
            (None, None) => Ok((self.nominal.q.clone(), Vec::new())),
        }
    }
}
