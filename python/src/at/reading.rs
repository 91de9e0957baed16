//! What is asked, from keywords: numbers, texts with units, arrays that are broadcast against each other.

use super::{At, Kind, Operand, Question};
use crate::errors::Said;
use crate::mechanism::Mechanism;
use mechc::{Formula, Sources, seconds};
use numpy::PyReadonlyArrayDyn;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};

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

impl Options<'_> {
    fn are_usual(&self) -> bool {
        let Options { set, inputs, rates, accelerations, by, reactions, tolerance, pass_bifurcations } = self;
        let is_nothing_given = [set, inputs, rates, accelerations].iter().all(|given| given.is_none());
        is_nothing_given && by.is_empty() && !reactions && tolerance.is_none() && !pass_bifurcations
    }
}

impl<'py> Options<'py> {
    /// Those that are given, by their names.
    fn given(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let given = PyDict::new(py);
        let Options { set, inputs, rates, accelerations, by, reactions, tolerance, pass_bifurcations } = self;
        let are_given = [
            ("set", set.is_some()),
            ("inputs", inputs.is_some()),
            ("rates", rates.is_some()),
            ("accelerations", accelerations.is_some()),
            ("by", !by.is_empty()),
            ("reactions", *reactions),
            ("tolerance", tolerance.is_some()),
            ("pass_bifurcations", *pass_bifurcations),
        ];
        for (name, _) in are_given.into_iter().filter(|(_, is_given)| *is_given) {
            given.set_item(name, true)?;
        }
        Ok(given)
    }
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
    if let (None, Some(values), true) = (t, values, options.are_usual())
        && let Some((compiled, inputs)) = mechanism.known.find_plain(values)
    {
        let question = Question { kind: Kind::default(), t: None, inputs, params: Vec::new(), shape: None };
        return question.answer(py, &compiled);
    }
    if !options.are_usual() {
        mechanism.warn_of_options(py, &options.given(py)?)?;
    }
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
    question.answer(py, &*question.compiled(py, mechanism)?)
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
    let is_whole = || value.is_instance_of::<PyInt>() && !value.is_instance_of::<PyBool>();
    if (value.is_exact_instance_of::<PyFloat>() || is_whole())
        && let Some(number) = value.extract::<f64>().ok().filter(|number| number.is_finite())
    {
        return Ok(Value::One(number));
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
    let is_of_time = |word: &str| word == "t";
    if name != "t" && text.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(is_of_time) {
        let message = format!("`{name}` is a formula of time, and `at` takes values");
        let help = "an array has one for each element; what is not given follows its formula: `m.at(t=0.1)`";
        return Err(usage(py, &message, help)?);
    }
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
            Value::Each(_) => {
                Operand::Each(alike.next().map_or(Vec::new(), |of| of.as_array().iter().copied().collect()))
            }
        });
    }
    Ok((Some(shape), operands))
}

fn usage(py: Python<'_>, message: &str, help: &str) -> PyResult<PyErr> {
    Ok(PyErr::from_value(py.import("mechc.values")?.getattr("usage")?.call1((message, help))?))
}
