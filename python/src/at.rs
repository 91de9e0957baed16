//! A mechanism at given inputs, params and times, one or many: each from its own start, so that neither order nor company change a bit.

use crate::errors::Said;
use crate::mechanism::{Mechanism, Stages};
use crate::waiting::interruptible;
use mechc::{Adjustable, Adjusting, AskedTimes, Cancel, Choice, ColumnUnit, Diagnostic, Formula, Signal, Sources, seconds};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArrayDyn};
use pyo3::exceptions::{PyKeyError, PyMemoryError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

/// What was compiled for questions of a kind; so many kinds are remembered.
const KINDS: usize = 16;

/// More elements than this are computed on another thread, while Ctrl-C is looked for.
const AT_ONCE: usize = 32;

/// What is asked for, but for the values: it is compiled once for all of these.
#[derive(Clone, PartialEq)]
pub struct Kind {
    inputs: Vec<String>,
    params: Vec<String>,
    by: Vec<String>,
    reactions: bool,
    tolerance: Option<u64>,
    pass_bifurcations: bool,
}

/// What was compiled for one.
pub struct Compiled {
    adjustable: Adjustable,
    columns: Arc<Columns>,
    /// The units that columns are printed in, where any is not SI.
    units: Option<Vec<ColumnUnit>>,
}

/// The columns of what is found.
pub struct Columns {
    names: Vec<String>,
    units: Vec<String>,
    places: HashMap<String, usize>,
    /// By derivative by time: the places of the coordinates.
    coordinates: [Vec<usize>; 3],
}

impl Columns {
    fn new(names: Vec<String>, units: Vec<String>, coordinates: [Vec<usize>; 3]) -> Arc<Columns> {
        let places = names.iter().cloned().zip(0..).collect();
        Arc::new(Columns { names, units, places, coordinates })
    }
}

/// What was compiled of a mechanism by now, the last first.
#[derive(Default)]
pub struct Known(Mutex<Vec<(Kind, Arc<Compiled>)>>);

impl Known {
    /// What is known of a kind. Who cannot look, because another process was forked while somebody did, does without.
    fn find(&self, kind: &Kind) -> Option<Arc<Compiled>> {
        let known = self.0.try_lock().ok()?;
        known.iter().find(|(other, _)| other == kind).map(|(_, compiled)| Arc::clone(compiled))
    }

    fn add(&self, kind: Kind, compiled: &Arc<Compiled>) {
        if let Ok(mut known) = self.0.try_lock() {
            known.insert(0, (kind, Arc::clone(compiled)));
            known.truncate(KINDS);
        }
    }
}

impl Compiled {
    fn of(stages: &Stages, kind: &Kind, cancel: &Cancel) -> Result<Compiled, Said> {
        let asked = Choice { by: kind.by.clone(), reactions: kind.reactions, ..stages.choice.clone() };
        let is_plain = kind.by.is_empty() && !kind.reactions;
        let checked = if is_plain {
            stages.checked.clone()
        } else {
            stages.with(&asked, &*stages.files, stages.redundant, cancel)?.0.0
        };
        let usual = Adjusting::default();
        let adjusting = Adjusting {
            inputs: kind.inputs.clone(),
            params: kind.params.clone(),
            redundant: stages.redundant,
            tolerance: kind.tolerance.map_or(usual.tolerance, f64::from_bits),
            pass_bifurcations: kind.pass_bifurcations,
        };
        let adjustable =
            checked.adjustable(&adjusting, cancel).map_err(|(sources, said)| Said::of(&said, &sources))?;
        let compiled = adjustable.compiled();
        let (names, units) = (compiled.columns(), compiled.units());
        let place = |name: String| names.iter().position(|column| *column == name);
        let of_order =
            |ending: &str| compiled.coordinates().iter().filter_map(|name| place(format!("{name}{ending}"))).collect();
        let coordinates = ["", ".d", ".dd"].map(of_order);
        let columns = Columns::new(names, units.iter().map(|unit| unit.text.clone()).collect(), coordinates);
        let units = units.iter().any(|unit| unit.scale() != [1.0; 3]).then_some(units);
        Ok(Compiled { adjustable, columns, units })
    }
}

/// A question, as it was put.
pub struct Question {
    kind: Kind,
    /// The time (s), if it is told, then inputs with their rates and accelerations, then params.
    t: Option<Operand>,
    inputs: Vec<[Operand; 3]>,
    params: Vec<Operand>,
    /// By how many elements.
    shape: Option<Vec<usize>>,
}

/// A number, or one for each element.
enum Operand {
    One(f64),
    Each(Vec<f64>),
}

impl Operand {
    fn at(&self, element: usize) -> f64 {
        match self {
            Operand::One(value) => *value,
            Operand::Each(values) => values[element],
        }
    }
}

/// What became of an element.
enum Became {
    Row,
    Not(Box<Diagnostic>),
}

/// Where the mechanism is, by its columns; of many elements each column is an array of their shape.
#[pyclass(frozen, mapping, module = "mechc._mechc")]
pub struct At {
    columns: Arc<Columns>,
    rows: Vec<f64>,
    shape: Option<Vec<usize>>,
    statuses: Vec<String>,
    /// Why the first element that did not get there did not.
    error: Option<Said>,
}

impl Question {
    fn elements(&self) -> usize {
        self.shape.as_ref().map_or(1, |shape| shape.iter().product())
    }

    /// Its answer.
    fn answer(&self, py: Python<'_>, mechanism: &Mechanism) -> PyResult<At> {
        let compiled = match mechanism.known.find(&self.kind) {
            Some(compiled) => compiled,
            None => {
                let made = interruptible(py, |cancel| Compiled::of(&mechanism.stages, &self.kind, cancel))?;
                let compiled = Arc::new(made.map_err(|said| said.raised(py))?);
                mechanism.known.add(self.kind.clone(), &compiled);
                compiled
            }
        };
        let (elements, width) = (self.elements(), compiled.columns.names.len());
        let too_many = |_| PyMemoryError::new_err("so many elements do not fit into memory; ask for fewer at once");
        let mut rows = Vec::new();
        rows.try_reserve_exact(elements.saturating_mul(width)).map_err(too_many)?;
        let became = if elements <= AT_ONCE {
            py.detach(|| self.all(&compiled, &mut rows, &Cancel::default()))
        } else {
            interruptible(py, |cancel| self.all(&compiled, &mut rows, cancel))?
        };
        let mut statuses = Vec::with_capacity(elements);
        let mut error = None;
        for became in became {
            statuses.push(match became {
                Became::Row => "ok".to_owned(),
                Became::Not(why) => {
                    let code = why.code.as_str().to_owned();
                    error.get_or_insert_with(|| Said::of_one(*why, compiled.adjustable.compiled().sources()));
                    code
                }
            });
        }
        Ok(At { columns: Arc::clone(&compiled.columns), rows, shape: self.shape.clone(), statuses, error })
    }

    fn all(&self, compiled: &Compiled, rows: &mut Vec<f64>, cancel: &Cancel) -> Vec<Became> {
        let names = &compiled.columns.names;
        let mut became = Vec::with_capacity(self.elements());
        for element in 0..self.elements() {
            let before = rows.len();
            let found = self.one(element, &compiled.adjustable, cancel, |row| {
                // of several rows the last one is that of the time
                rows.truncate(before);
                rows.extend_from_slice(&row[..names.len()]);
            });
            became.push(match found {
                Ok(()) => {
                    let units = compiled.units.iter().flatten();
                    rows[before..].iter_mut().zip(units).for_each(|(value, unit)| *value = unit.printed(*value));
                    Became::Row
                }
                Err(why) => {
                    rows.truncate(before);
                    rows.resize(before + names.len(), f64::NAN);
                    Became::Not(why)
                }
            });
            if cancel.is_cancelled() {
                break;
            }
        }
        became
    }

    fn one(
        &self,
        element: usize,
        adjustable: &Adjustable,
        cancel: &Cancel,
        row: impl FnMut(&[f64]),
    ) -> Result<(), Box<Diagnostic>> {
        let signal = |[value, rate, acceleration]: &[Operand; 3]| Signal {
            value: value.at(element),
            rate: rate.at(element),
            acceleration: acceleration.at(element),
        };
        let inputs: Vec<Signal> = self.inputs.iter().map(signal).collect();
        let params: Vec<f64> = self.params.iter().map(|param| param.at(element)).collect();
        let t = self.t.as_ref().map(|t| t.at(element));
        let first = || adjustable.compiled().analysis().map_or(0.0, |[from, ..]| from);
        let at = t.unwrap_or_else(first);
        // inputs are what they are at that time, and not before
        let from = (!inputs.is_empty()).then_some(at);
        let times = AskedTimes { from, at: vec![at], ..AskedTimes::default() };
        adjustable.follow(&inputs, &params, &times, cancel, row).map(|_| ())
    }
}

#[pymethods]
impl At {
    /// A column by its name: a number, or an array of the elements' shape.
    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let Some(&place) = self.columns.places.get(name) else {
            return Err(PyKeyError::new_err(format!("there is no column `{name}`")));
        };
        self.picked(py, &[place], true)
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
        self.picked(py, &[0], true)
    }

    /// The coordinates [m, rad]: an array of shape (coordinates,), of many elements of shape (…, coordinates).
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.picked(py, &self.columns.coordinates[0], false)
    }

    /// Their first derivatives by time.
    #[getter]
    fn qd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.picked(py, &self.columns.coordinates[1], false)
    }

    /// Their second derivatives by time.
    #[getter]
    fn qdd<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.picked(py, &self.columns.coordinates[2], false)
    }

    /// Columns of some names side by side: an array of shape (columns,), of many elements of shape (…, columns).
    fn stacked<'py>(&self, py: Python<'py>, names: Vec<String>) -> PyResult<Bound<'py, PyAny>> {
        let place = |name: &String| {
            let known = self.columns.places.get(name).copied();
            known.ok_or_else(|| PyKeyError::new_err(format!("there is no column `{name}`")))
        };
        let places = names.iter().map(place).collect::<PyResult<Vec<usize>>>()?;
        self.picked(py, &places, false)
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
        self.error.as_ref().map(|said| said.raised(py).into_value(py).into_any())
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

    /// As what it is packed: its columns by their names, with shape and statuses.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let again = py.import("mechc._mechc")?.getattr("_at_again")?;
        let rows = PyArray1::from_slice(py, &self.rows);
        let Columns { names, units, coordinates, .. } = &*self.columns;
        let packed = (names, units, coordinates.to_vec(), rows, &self.shape, &self.statuses);
        Ok((again, packed.into_pyobject(py)?))
    }
}

impl At {
    /// Some columns of all elements, one behind the other; a single column of a single element as a number.
    fn picked<'py>(&self, py: Python<'py>, places: &[usize], is_alone: bool) -> PyResult<Bound<'py, PyAny>> {
        let width = self.columns.names.len();
        match &self.shape {
            None if is_alone => Ok(PyFloat::new(py, self.rows[places[0]]).into_any()),
            None => {
                let picked = places.iter().map(|&place| self.rows[place]).collect();
                Ok(PyArray1::from_vec(py, picked).into_any())
            }
            Some(shape) => {
                let mut picked = Vec::with_capacity(self.statuses.len() * places.len());
                self.rows.chunks_exact(width).for_each(|row| picked.extend(places.iter().map(|&place| row[place])));
                let mut shape = shape.clone();
                if !is_alone {
                    shape.push(places.len());
                }
                Ok(PyArray1::from_vec(py, picked).reshape(shape)?.into_any())
            }
        }
    }
}
/// An answer once more, as it was packed.
#[pyfunction]
pub fn _at_again(
    names: Vec<String>,
    units: Vec<String>,
    coordinates: Vec<Vec<usize>>,
    rows: PyReadonlyArray1<'_, f64>,
    shape: Option<Vec<usize>>,
    statuses: Vec<String>,
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
    Ok(At { columns: Columns::new(names, units, coordinates), rows, shape, statuses, error: None })
}

/// Options beside values, as they are called in Python.
pub struct Options<'py> {
    pub set: Option<Bound<'py, PyDict>>,
    pub inputs: Option<Bound<'py, PyDict>>,
    pub rates: Option<Bound<'py, PyDict>>,
    pub accelerations: Option<Bound<'py, PyDict>>,
    pub by: Vec<String>,
    pub reactions: bool,
    pub tolerance: Option<f64>,
    pub pass_bifurcations: bool,
}

/// A value that was read, and not yet laid out by elements.
enum Value<'py> {
    One(f64),
    Each(Bound<'py, PyAny>),
}

/// Answers what is asked by keywords.
pub fn at<'py>(
    py: Python<'py>,
    mechanism: &Mechanism,
    t: Option<&Bound<'py, PyAny>>,
    options: Options<'py>,
    values: Option<&Bound<'py, PyDict>>,
) -> PyResult<At> {
    let (mut inputs, mut params) = (Vec::new(), Vec::new());
    for given in [options.set.as_ref(), options.inputs.as_ref(), values].into_iter().flatten() {
        for (name, value) in given.iter() {
            let name: String = name.extract()?;
            let (of, is_input) = mechanism.settable(py, &name, &value)?;
            let read = read(py, &name, &value, &of.unit)?;
            let into = if is_input { &mut inputs } else { &mut params };
            into.push((name, read));
        }
    }
    for named in [&mut inputs, &mut params] {
        named.sort_by(|(a, _), (b, _)| a.cmp(b));
        if let Some(twice) = named.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(usage(py, &format!("`{}` is given twice", twice[0].0), "say it once")?);
        }
    }
    let mut all: Vec<Value<'py>> = Vec::with_capacity(1 + 3 * inputs.len() + params.len());
    all.push(t.map_or(Ok(Value::One(0.0)), |t| read(py, "t", t, "s"))?);
    let mut names = Vec::with_capacity(inputs.len());
    for (name, value) in inputs {
        all.push(value);
        for (motion, order) in [(&options.rates, 1), (&options.accelerations, 2)] {
            all.push(match motion.as_ref().map(|of| of.get_item(&name)).transpose()?.flatten() {
                None => Value::One(0.0),
                Some(value) => read(py, &name, &value, &mechanism.unit_of_rate(&name, order))?,
            });
        }
        names.push(name);
    }
    refuse_rates_of_others(py, &options, &names)?;
    let (param_names, values): (Vec<String>, Vec<Value<'py>>) = params.into_iter().unzip();
    all.extend(values);
    let (shape, laid_out) = laid_out(py, all)?;
    let mut operands = laid_out.into_iter();
    let first = operands.next().filter(|_| t.is_some());
    let mut next = || operands.next().unwrap_or(Operand::One(0.0));
    let question = Question {
        t: first,
        inputs: names.iter().map(|_| [next(), next(), next()]).collect(),
        params: param_names.iter().map(|_| next()).collect(),
        kind: Kind {
            inputs: names,
            params: param_names,
            by: options.by,
            reactions: options.reactions,
            tolerance: options.tolerance.map(f64::to_bits),
            pass_bifurcations: options.pass_bifurcations,
        },
        shape,
    };
    question.answer(py, mechanism)
}

/// Rates are of inputs that are given.
fn refuse_rates_of_others(py: Python<'_>, options: &Options<'_>, inputs: &[String]) -> PyResult<()> {
    for (motion, what) in [(&options.rates, "rates"), (&options.accelerations, "accelerations")] {
        for name in motion.iter().flat_map(|of| of.keys().iter().collect::<Vec<_>>()) {
            let name: String = name.extract()?;
            if !inputs.contains(&name) {
                let said = format!("`{what}` has `{name}`, which is no input that is given");
                return Err(usage(py, &said, "give its value too, as in `m.at(turn=0.3, rates={'turn': 2.0})`")?);
            }
        }
    }
    Ok(())
}

/// A value that was handed over: a number, a text with its unit, or an array of numbers.
fn read<'py>(py: Python<'py>, name: &str, value: &Bound<'py, PyAny>, unit: &str) -> PyResult<Value<'py>> {
    if value.is_exact_instance_of::<PyFloat>() || (value.is_instance_of::<PyInt>() && !value.is_instance_of::<PyBool>()) {
        if let Some(number) = value.extract::<f64>().ok().filter(|number| number.is_finite()) {
            return Ok(Value::One(number));
        }
    }
    if let Ok(text) = value.cast::<PyString>() {
        return formula(py, name, text.to_str()?, unit).map(Value::One);
    }
    static ELEMENTS: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let read = ELEMENTS.import(py, "mechc.values", "elements")?.call1((name, value))?;
    Ok(match read.extract::<f64>() {
        Ok(number) if read.is_exact_instance_of::<PyFloat>() => Value::One(number),
        _ => Value::Each(read),
    })
}

/// The value of a formula in SI; it must be of a unit, as an addend of that unit is.
fn formula(py: Python<'_>, name: &str, text: &str, unit: &str) -> PyResult<f64> {
    let mut sources = Sources::default();
    if name == "t" {
        return seconds("t", text, &mut sources).map_err(|why| Said::of(&why, &sources).raised(py));
    }
    let sum = match unit {
        "" => format!("({text})"),
        unit if unit.starts_with('/') => format!("0{unit} + ({text})"),
        unit => format!("0 {unit} + ({text})"),
    };
    let formula = Formula::of(&sum, &mut sources).map_err(|why| Said::of(&why, &sources).raised(py))?;
    let [value, ..] = formula.values(0.0).map_err(|why| Said::of_one(*why, &sources).raised(py))?;
    Ok(value)
}

/// Values by elements, and the shape of these; none where all are single numbers.
fn laid_out(py: Python<'_>, values: Vec<Value<'_>>) -> PyResult<(Option<Vec<usize>>, Vec<Operand>)> {
    let arrays: Vec<&Bound<'_, PyAny>> = values
        .iter()
        .filter_map(|value| match value {
            Value::One(_) => None,
            Value::Each(array) => Some(array),
        })
        .collect();
    if arrays.is_empty() {
        let one = |value| if let Value::One(number) = value { Operand::One(number) } else { Operand::One(0.0) };
        return Ok((None, values.into_iter().map(one).collect()));
    }
    static ALIKE: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let alike: Vec<PyReadonlyArrayDyn<'_, f64>> =
        ALIKE.import(py, "mechc.values", "alike")?.call1((arrays,))?.extract()?;
    let shape = alike.first().map(|array| array.as_array().shape().to_vec()).unwrap_or_default();
    let mut alike = alike.into_iter();
    let mut operands = Vec::with_capacity(values.len());
    for value in values {
        operands.push(match value {
            Value::One(number) => Operand::One(number),
            Value::Each(_) => Operand::Each(alike.next().map_or(Vec::new(), |of| of.as_array().iter().copied().collect())),
        });
    }
    Ok((Some(shape), operands))
}

fn usage(py: Python<'_>, message: &str, help: &str) -> PyResult<PyErr> {
    Ok(PyErr::from_value(py.import("mechc.values")?.getattr("usage")?.call1((message, help))?))
}
