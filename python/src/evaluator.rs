//! Results and rows as functions of params, for optimisers: compiled once, and evaluated again and again.

use crate::errors::Said;
use crate::mechanism::Stages;
use crate::memory::{self, Of};
use crate::run::Asked;
use crate::waiting::interruptible;
use mechc::{Answers, Cancel, ColumnUnit, EvaluatorOptions, MechanismEvaluator, RequestedTimes, RunOptions};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;

/// A mechanism of which some params are arguments.
#[pyclass(frozen, module = "mechc._mechc")]
pub struct Evaluator(Arc<Function>);

struct Function {
    adjustable: MechanismEvaluator,
    params: usize,
    times: RequestedTimes,
    wanted: Vec<usize>,
    units: Vec<ColumnUnit>,
}

/// Results (SI), and rows one behind the other.
type Evaluated<'py> = (Vec<Option<f64>>, Bound<'py, PyAny>);

impl Evaluator {
    /// Of a mechanism whose params of some names are arguments.
    pub fn of(py: Python<'_>, stages: Arc<Stages>, asked: Asked, params: Vec<String>) -> PyResult<Evaluator> {
        let made = interruptible(py, move |cancel| Function::of(&stages, &asked, params, cancel))?;
        let function = made.map_err(|said| said.raised(py))?;
        memory::refuse_beyond(py, (function.rows(), function.wanted.len()), Of::Run)?;
        Ok(Evaluator(Arc::new(function)))
    }
}

impl Function {
    fn of(stages: &Stages, asked: &Asked, params: Vec<String>, cancel: &Cancel) -> Result<Function, Said> {
        let ((checked, _), _) = asked.stages(stages, cancel)?;
        let RunOptions { tolerance, pass_bifurcations, .. } = asked.options(cancel);
        let (count, inputs, redundant) = (params.len(), Vec::new(), asked.redundant(stages));
        let adjusting =
            EvaluatorOptions { inputs, has_accelerations: false, params, redundant, tolerance, pass_bifurcations };
        let adjustable = checked.evaluator(&adjusting, cancel)?;
        let compiled = adjustable.compiled();
        let mut sources = compiled.sources().clone();
        let times = RequestedTimes::from_options([&asked.from, &asked.to, &asked.every], &asked.at, &mut sources);
        let (times, wanted) = (times?, compiled.select_columns(&asked.columns)?);
        let all = compiled.units();
        let units = wanted.iter().map(|&k| all[k].clone()).collect();
        Ok(Function { adjustable, params: count, times, wanted, units })
    }

    /// How many rows there are for its own params; none where that cannot be said, which is told when it is evaluated.
    fn rows(&self) -> u64 {
        let times = self.times.over(self.adjustable.compiled().analysis()).and_then(|times| times.times());
        times.map_or(0, |times| times.len())
    }

    /// Results, and the wanted columns of all rows, row by row.
    fn at(&self, x: &[f64], cancel: &Cancel) -> Result<(Answers, Vec<f64>), Said> {
        let mut rows = Vec::new();
        let answers = self.adjustable.follow(&[], x, &self.times, cancel, |row| {
            rows.extend(self.units.iter().zip(&self.wanted).map(|(unit, &k)| unit.printed(row[k])));
        });
        Ok((answers?, rows))
    }
}

#[pymethods]
impl Evaluator {
    /// The names of the columns.
    #[getter]
    fn columns(&self) -> Vec<String> {
        let all = self.0.adjustable.compiled().columns();
        self.0.wanted.iter().map(|&k| all[k].clone()).collect()
    }

    /// The names of the results, and their units.
    #[getter]
    fn results(&self) -> Vec<(String, String)> {
        self.0.adjustable.compiled().variant_results()
    }

    /// The results (SI), and rows of shape (times, columns), for values of the params (SI).
    fn evaluate<'py>(&self, py: Python<'py>, x: PyReadonlyArray1<'py, f64>) -> PyResult<Evaluated<'py>> {
        let x = x.as_array().to_vec();
        if x.len() != self.0.params {
            let said = format!("{} values are given for {} params", x.len(), self.0.params);
            return Err(PyValueError::new_err(said));
        }
        let function = Arc::clone(&self.0);
        let found = interruptible(py, move |cancel| function.at(&x, cancel))?;
        let (answers, rows) = found.map_err(|said| said.raised(py))?;
        let width = self.0.wanted.len();
        let shape = [rows.len() / width, width];
        Ok((answers.values, PyArray1::from_vec(py, rows).reshape(shape)?.into_any()))
    }
}
