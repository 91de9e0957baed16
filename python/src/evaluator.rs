//! Results and rows as functions of params, for optimisers: compiled once, evaluated many times.

use crate::errors::Report;
use crate::interrupts::interruptible;
use crate::mechanism::Stages;
use crate::memory::{self, Computation};
use crate::run::RunRequest;
use mechc::{Answers, Cancel, ColumnUnit, EvaluatorOptions, MechanismEvaluator, RequestedTimes, RunOptions};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;

/// A mechanism of which some params are arguments.
#[pyclass(frozen, module = "mechc._mechc")]
pub struct Evaluator(Arc<Function>);

struct Function {
    evaluator: MechanismEvaluator,
    params: usize,
    times: RequestedTimes,
    selected: Vec<usize>,
    units: Vec<ColumnUnit>,
}

/// Results (SI), and rows one behind the other.
type Evaluated<'py> = (Vec<Option<f64>>, Bound<'py, PyAny>);

impl Evaluator {
    /// Compiles a mechanism with these params as arguments.
    pub fn new(py: Python<'_>, stages: Arc<Stages>, request: RunRequest, params: Vec<String>) -> PyResult<Evaluator> {
        let made = interruptible(py, move |cancel| Function::new(&stages, &request, params, cancel))?;
        let function = made.map_err(|report| report.to_exception(py))?;
        memory::refuse_beyond(py, (function.rows(), function.selected.len()), Computation::Run)?;
        Ok(Evaluator(Arc::new(function)))
    }
}

impl Function {
    fn new(stages: &Stages, request: &RunRequest, params: Vec<String>, cancel: &Cancel) -> Result<Function, Report> {
        let ((checked, _), _) = request.stages(stages, cancel)?;
        let RunOptions { tolerance, pass_bifurcations, .. } = request.options(cancel);
        let (count, inputs, redundant) = (params.len(), Vec::new(), request.redundant(stages));
        let options =
            EvaluatorOptions { inputs, params, redundant, tolerance, pass_bifurcations, ..EvaluatorOptions::default() };
        let evaluator = checked.evaluator(&options, cancel)?;
        let compiled = evaluator.compiled();
        let mut sources = compiled.sources().clone();
        let times =
            RequestedTimes::from_options([&request.from, &request.to, &request.every], &request.at, &mut sources);
        let (times, selected) = (times?, compiled.select_columns(&request.columns)?);
        let all = compiled.units();
        let units = selected.iter().map(|&k| all[k].clone()).collect();
        Ok(Function { evaluator, params: count, times, selected, units })
    }

    /// Returns the number of rows with the text's params; 0 if the times have an error, which an evaluation reports.
    fn rows(&self) -> u64 {
        let times = self.times.over(self.evaluator.compiled().analysis()).and_then(|times| times.times());
        times.map_or(0, |times| times.len())
    }

    /// Returns the results, and the selected columns of all rows, row by row.
    fn at(&self, x: &[f64], cancel: &Cancel) -> Result<(Answers, Vec<f64>), Report> {
        let mut rows = Vec::new();
        let answers = self.evaluator.follow(&[], x, &self.times, cancel, |row| {
            rows.extend(self.units.iter().zip(&self.selected).map(|(unit, &k)| unit.printed(row[k])));
        });
        Ok((answers?, rows))
    }
}

#[pymethods]
impl Evaluator {
    /// The names of the columns.
    #[getter]
    fn columns(&self) -> Vec<String> {
        let all = self.0.evaluator.compiled().columns();
        self.0.selected.iter().map(|&k| all[k].clone()).collect()
    }

    /// The names of the results, and their units.
    #[getter]
    fn results(&self) -> Vec<(String, String)> {
        self.0.evaluator.compiled().variant_results()
    }

    /// The results (SI), and rows of shape (times, columns), for values of the params (SI).
    fn evaluate<'py>(&self, py: Python<'py>, x: PyReadonlyArray1<'py, f64>) -> PyResult<Evaluated<'py>> {
        let x = x.as_array().to_vec();
        if x.len() != self.0.params {
            let message = format!("{} values are given for {} params", x.len(), self.0.params);
            return Err(PyValueError::new_err(message));
        }
        let function = Arc::clone(&self.0);
        let found = interruptible(py, move |cancel| function.at(&x, cancel))?;
        let (answers, rows) = found.map_err(|report| report.to_exception(py))?;
        let width = self.0.selected.len();
        let shape = [rows.len() / width, width];
        Ok((answers.values, PyArray1::from_vec(py, rows).reshape(shape)?.into_any()))
    }
}
