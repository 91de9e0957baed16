//! Deviations of measures and results that tolerances of params cause.

use crate::errors::Report;
use crate::interrupts::interruptible;
use crate::mechanism::Stages;
use crate::run::RunRequest;
use mechc::{Cancel, OutputSensitivity, RequestedTimes, RunOptions, SweepOptions, Tolerance};
use pyo3::prelude::*;
use std::sync::Arc;

/// The tolerance of a param: name, nominal value and range (SI), unit.
type ParamTolerance = (String, f64, [f64; 2], String);

/// The deviation of a measure or result (SI).
#[derive(IntoPyObject)]
pub struct Deviation {
    name: String,
    /// The time (s) at which a measure deviates the most.
    at: Option<f64>,
    nominal: f64,
    unit: String,
    /// The derivative by each param.
    slopes: Vec<Option<f64>>,
    /// The least and the largest contribution of each param.
    contributions: Option<Vec<[f64; 2]>>,
    shares: Option<Vec<f64>>,
    worst: Option<[f64; 2]>,
    statistical: Option<[f64; 2]>,
    sigma: Option<f64>,
    /// The least and the largest deviation of all variants that were run.
    found: Option<[f64; 2]>,
    /// Number of these variants without a value.
    missing: Option<u64>,
    /// Whether first derivatives predict the deviation well enough.
    is_linear: Option<bool>,
}

/// Number of variants that were run, whether these are all corners, and number of those that stopped early.
type Verification = Option<(u64, bool, u64)>;

/// The tolerances, the deviations, and the verification, if requested.
pub type ToleranceReport = (Vec<ParamTolerance>, Vec<Deviation>, Verification);

/// Computes the deviations that tolerances cause; `are` is whether errors are normal, and whether variants verify them.
pub fn tolerance(
    py: Python<'_>,
    stages: Arc<Stages>,
    request: RunRequest,
    tol: Vec<String>,
    are: (bool, bool),
) -> PyResult<ToleranceReport> {
    let result = interruptible(py, move |cancel| compute(&stages, &request, &tol, are, cancel))?;
    result.map_err(|report| report.to_exception(py))
}

fn compute(
    stages: &Stages,
    request: &RunRequest,
    tol: &[String],
    (normal, verify): (bool, bool),
    cancel: &Cancel,
) -> Result<ToleranceReport, Report> {
    let choice = mechc::Choice { lead: true, ..request.choice(stages) };
    let ((checked, compiled), _) = stages.compile(&choice, &*stages.files, request.redundant(stages), cancel)?;
    let tolerancing = checked.tolerancing(tol, &choice, &*stages.files)?;
    let mut sources = compiled.sources().clone();
    let times = RequestedTimes::from_options([&request.from, &request.to, &request.every], &[], &mut sources);
    let RunOptions { tolerance, pass_bifurcations, .. } = request.options(cancel);
    let options = SweepOptions {
        times: times?,
        redundant: request.redundant(stages),
        tolerance,
        pass_bifurcations,
        cancel: cancel.clone(),
        ..SweepOptions::default()
    };
    let affected = tolerancing.sensitivities(&compiled, &options)?;
    let verified = if verify { Some(tolerancing.verify(&compiled, &affected, &options, |_| ())?) } else { None };
    let tolerances = tolerancing.tolerances();
    let quantity = |(k, of): (usize, &OutputSensitivity)| {
        let deviation = of.deviation(tolerances, normal);
        let tried = verified.as_ref().filter(|_| of.is_verifiable).zip(deviation.as_ref());
        let is_linear = tried.map(|(verified, deviation)| verified.is_linear(k, of, deviation));
        Deviation {
            name: of.name.clone(),
            at: of.at,
            nominal: of.nominal,
            unit: of.si.clone(),
            slopes: of.slopes.clone(),
            contributions: deviation.as_ref().map(|of| of.contributions.clone()),
            shares: deviation.as_ref().map(|of| of.shares.clone()),
            worst: deviation.as_ref().map(|of| of.worst),
            statistical: deviation.as_ref().map(|of| of.statistical),
            sigma: deviation.as_ref().map(|of| of.sigma),
            found: verified.as_ref().and_then(|verified| verified.found[k]),
            missing: verified.as_ref().map(|verified| verified.missing(k)),
            is_linear,
        }
    };
    let quantities = affected.iter().enumerate().map(quantity).collect();
    let param = |of: &Tolerance| (of.name.clone(), of.nominal, of.range, of.si.clone());
    let lost = |verified: &mechc::CornerReport| verified.lost.as_ref().map_or(0, |(count, ..)| *count);
    let tried = verified.as_ref().map(|verified| (verified.variants, verified.are_all_corners, lost(verified)));
    Ok((tolerances.iter().map(param).collect(), quantities, tried))
}
