//! The answer of `Mechanism.at`: columns by their names, as numbers or as arrays of the elements' shape.

use crate::errors::{PickledReport, Report};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyList, PyString, PyTuple};
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

/// The columns of an answer.
pub struct Columns {
    pub(super) names: Vec<String>,
    units: Vec<String>,
    places: HashMap<String, usize>,
    /// The places of `q`, of `qd` and of `qdd` among the columns.
    coordinates: [Vec<usize>; 3],
}

impl Columns {
    pub(super) fn new(names: Vec<String>, units: Vec<String>, coordinates: [Vec<usize>; 3]) -> Arc<Columns> {
        let places = names.iter().cloned().zip(0..).collect();
        Arc::new(Columns { names, units, places, coordinates })
    }
}

/// Where the mechanism is, by its columns; of many elements each column is an array of their shape.
#[pyclass(frozen, mapping, module = "mechc._mechc")]
pub struct At {
    pub(super) columns: Arc<Columns>,
    pub(super) rows: Vec<f64>,
    pub(super) shape: Option<Vec<usize>>,
    pub(super) statuses: Vec<Cow<'static, str>>,
    /// The error of the first element that failed.
    pub(super) error: Option<Report>,
}

#[pymethods]
impl At {
    /// A column by its name: a number, or an array of the elements' shape.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let Some(&place) = self.columns.places.get(name) else {
            return Err(self.no_column(py, name));
        };
        self.select(py, &[place], true)
    }

    fn __len__(&self) -> usize {
        self.columns.names.len()
    }

    fn __contains__(&self, name: &Bound<'_, PyAny>) -> bool {
        name.extract::<String>().is_ok_and(|name| self.columns.places.contains_key(&name))
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        PyTuple::new(py, &self.columns.names)?.into_any().try_iter().map(Bound::into_any)
    }

    /// The names of the columns.
    fn keys(&self) -> Vec<String> {
        self.columns.names.clone()
    }

    /// The columns in order.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        (0..self.columns.names.len()).map(|place| self.select(py, &[place], true)).collect()
    }

    /// The columns with their names.
    fn items<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        Ok(self.columns.names.iter().cloned().zip(self.values(py)?).collect())
    }

    /// A column by its name, or what stands for one that is not there.
    #[pyo3(signature = (key, default=None, /))]
    fn get<'py>(
        &self,
        py: Python<'py>,
        key: &Bound<'py, PyAny>,
        default: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let place = key.extract::<String>().ok().and_then(|name| self.columns.places.get(&name).copied());
        place.map_or(Ok(default), |place| self.select(py, &[place], true).map(Some))
    }

    /// The names of the columns.
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.columns.names.clone()
    }

    /// The units of the columns.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let units = PyDict::new(py);
        for (name, unit) in self.columns.names.iter().zip(&self.columns.units) {
            units.set_item(name, unit)?;
        }
        Ok(units)
    }

    /// The time (s).
    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.select(py, &[0], true)
    }

    /// The coordinates [m, rad]: an array of shape (coordinates,), of many elements of shape (…, coordinates).
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.select(py, &self.columns.coordinates[0], false)
    }

    /// Their first derivatives by time.
    #[getter]
    fn qd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.select(py, &self.columns.coordinates[1], false)
    }

    /// Their second derivatives by time.
    #[getter]
    fn qdd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.select(py, &self.columns.coordinates[2], false)
    }

    /// Columns of some names side by side: an array of shape (columns,), of many elements of shape (…, columns).
    fn stacked<'py>(&self, py: Python<'py>, names: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let names: Vec<String> = py.import("mechc.values")?.getattr("texts")?.call1(("names", names))?.extract()?;
        let place = |name: &String| {
            let known = self.columns.places.get(name).copied();
            known.ok_or_else(|| self.no_column(py, name))
        };
        let places = names.iter().map(place).collect::<PyResult<Vec<usize>>>()?;
        self.select(py, &places, false)
    }

    /// The names of the coordinates.
    #[getter]
    fn coordinates(&self) -> Vec<&str> {
        self.columns.coordinates[0].iter().map(|&place| self.columns.names[place].as_str()).collect()
    }

    /// `"ok"`, or the code of why it does not get there; of many elements a list.
    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match (&self.shape, self.statuses.first()) {
            (None, Some(status)) => Ok(PyString::new(py, status).into_any()),
            _ => Ok(PyList::new(py, &self.statuses)?.into_any()),
        }
    }

    /// Why the first element that does not get there does not; nothing where all do.
    #[getter]
    pub fn error(&self, py: Python<'_>) -> Option<Py<PyAny>> {
        self.error.as_ref().map(|report| report.to_exception(py).into_value(py).into_any())
    }

    /// The shape of the elements; `()` of one alone.
    #[getter]
    fn shape<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.shape.as_deref().unwrap_or_default())
    }

    fn __repr__(&self) -> String {
        let elements = self.statuses.len();
        let lost = self.statuses.iter().filter(|status| **status != "ok").count();
        let lost = if lost == 0 { String::new() } else { format!(", {lost} did not get there") };
        format!("<At: {elements} of {} columns{lost}>", self.columns.names.len())
    }

    /// Returns what is pickled: names, units, places of coordinates, rows, shape, statuses and the error.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let unpickle = py.import("mechc._mechc")?.getattr("_unpickle_at")?;
        let rows = PyArray1::from_slice(py, &self.rows);
        let Columns { names, units, coordinates, .. } = &*self.columns;
        let error = self.error.as_ref().map(Report::to_pickled);
        let pickled = (names, units, coordinates.to_vec(), rows, &self.shape, &self.statuses, error);
        Ok((unpickle, pickled.into_pyobject(py)?))
    }
}

impl At {
    /// Returns the error for an unknown column, with a suggestion.
    fn no_column(&self, py: Python<'_>, name: &str) -> PyErr {
        let hint = || -> PyResult<Option<String>> {
            py.import("mechc.values")?.getattr("suggestion")?.call1((name, &self.columns.names))?.extract()
        };
        let hint = hint().ok().flatten().map_or(String::new(), |hint| format!("; {hint}"));
        PyKeyError::new_err(format!("there is no column '{name}'{hint}"))
    }

    /// Returns columns of all elements, of shape (…, columns); with `is_alone` one column, of shape (…), or as a number for a single element.
    fn select<'py>(&self, py: Python<'py>, places: &[usize], is_alone: bool) -> PyResult<Bound<'py, PyAny>> {
        let width = self.columns.names.len();
        match &self.shape {
            None if is_alone => Ok(PyFloat::new(py, self.rows[places[0]]).into_any()),
            None => {
                let selected = places.iter().map(|&place| self.rows[place]).collect();
                Ok(PyArray1::from_vec(py, selected).into_any())
            }
            Some(shape) => {
                let mut selected = Vec::with_capacity(self.statuses.len() * places.len());
                self.rows.chunks_exact(width).for_each(|row| selected.extend(places.iter().map(|&place| row[place])));
                let mut shape = shape.clone();
                if !is_alone {
                    shape.push(places.len());
                }
                Ok(PyArray1::from_vec(py, selected).reshape(shape)?.into_any())
            }
        }
    }
}

/// Restores an answer that was pickled.
#[pyfunction]
#[pyo3(signature = (names, units, coordinates, rows, shape, statuses, error = None))]
pub fn _unpickle_at(
    names: Vec<String>,
    units: Vec<String>,
    coordinates: Vec<Vec<usize>>,
    rows: PyReadonlyArray1<'_, f64>,
    shape: Option<Vec<usize>>,
    statuses: Vec<String>,
    error: Option<PickledReport>,
) -> PyResult<At> {
    let refused = || PyValueError::new_err("this is no packed answer of `at`");
    let coordinates: [Vec<usize>; 3] = coordinates.try_into().map_err(|_| refused())?;
    let rows = rows.as_array().to_vec();
    let elements = shape.as_ref().map_or(Some(1), |shape| shape.iter().try_fold(1_usize, |a, &b| a.checked_mul(b)));
    let is_whole = elements == Some(statuses.len())
        && units.len() == names.len()
        && elements.and_then(|elements| elements.checked_mul(names.len())) == Some(rows.len())
        && !names.is_empty()
        && coordinates.iter().flatten().all(|&place| place < names.len());
    if !is_whole {
        return Err(refused());
    }
    let statuses = statuses.into_iter().map(Cow::Owned).collect();
    Ok(At {
        columns: Columns::new(names, units, coordinates),
        rows,
        shape,
        statuses,
        error: error.map(Report::from_pickled),
    })
}
