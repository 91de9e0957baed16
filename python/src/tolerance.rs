//! What small errors of params make of measures and results.

use crate::errors::Said;
use crate::mechanism::Stages;
use crate::run::Asked;
use crate::waiting::interruptible;
use mechc::{Cancel, OutputSensitivity, RequestedTimes, RunOptions, SweepOptions, Tolerance};
use pyo3::prelude::*;
use std::sync::Arc;

/// Each tolerance: its name, its value, from and to (SI), its unit.
type OfParam = (String, f64, [f64; 2], String);

/// Each measure or result.
#[derive(IntoPyObject)]
pub struct OfQuantity {
    name: String,
    /// The time (s) at which a measure deviates the most.
    at: Option<f64>,
    nominal: f64,
    unit: String,
    /// By param, its derivative.
    slopes: Vec<Option<f64>>,
    /// By param, from the least to the largest.
    contributions: Option<Vec<[f64; 2]>>,
    shares: Option<Vec<f64>>,
    worst: Option<[f64; 2]>,
    statistical: Option<[f64; 2]>,
    sigma: Option<f64>,
    /// How far it was off when it was run, in how many variants it had no value, and whether derivatives are enough.
    found: Option<[f64; 2]>,
    missing: Option<u64>,
    is_linear: Option<bool>,
}

/// How many variants were run, whether these were all corners, and how many of them did not come to their end.
type Tried = Option<(u64, bool, u64)>;

/// All of it.
pub type Told = (Vec<OfParam>, Vec<OfQuantity>, Tried);

/// What tolerances make of a mechanism.
pub fn tolerance(
    py: Python<'_>,
    stages: Arc<Stages>,
    asked: Asked,
    tol: Vec<String>,
    are: (bool, bool),
) -> PyResult<Told> {
    let told = interruptible(py, move |cancel| found(&stages, &asked, &tol, are, cancel))?;
    told.map_err(|said| said.raised(py))
}

fn found(
    stages: &Stages,
    asked: &Asked,
    tol: &[String],
    (normal, verify): (bool, bool),
    cancel: &Cancel,
) -> Result<Told, Said> {
    let choice = mechc::Choice { lead: true, ..asked.choice(stages) };
    let ((checked, compiled), _) = stages.with(&choice, &*stages.files, asked.redundant(stages), cancel)?;
    let tolerancing = checked.tolerancing(tol, &choice, &*stages.files)?;
    let mut sources = compiled.sources().clone();
    let times = RequestedTimes::from_options([&asked.from, &asked.to, &asked.every], &[], &mut sources);
    let RunOptions { tolerance, pass_bifurcations, .. } = asked.options(cancel);
    let options = SweepOptions {
        times: times?,
        redundant: asked.redundant(stages),
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
        let tried = verified.as_ref().zip(deviation.as_ref());
        let is_linear = tried.map(|(verified, deviation)| verified.is_linear(k, of, deviation));
        OfQuantity {
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
