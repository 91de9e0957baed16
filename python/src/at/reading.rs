//! What is asked, from keywords: numbers, texts with units, arrays that are broadcast against each other.

use super::{At, Kind, Operand, Question};
use crate::errors::Said;
use crate::mechanism::{Meant, Mechanism};
use mechc::{Error, SettableParam, Sources, seconds};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};

/// What is no value, as it is called in Python.
pub const OPTIONS: [&str; 10] =
    ["t", "set", "inputs", "rates", "accelerations", "by", "reactions", "tolerance", "pass_bifurcations", "strict"];

/// Options beside values, in the order of [`OPTIONS`]: nothing where one is not given.
pub struct Options<'py>(pub [Option<Bound<'py, PyAny>>; 10]);

/// What they say.
#[derive(Default)]
struct Read<'py> {
    set: Option<Bound<'py, PyDict>>,
    inputs: Option<Bound<'py, PyDict>>,
    rates: Option<Bound<'py, PyDict>>,
    accelerations: Option<Bound<'py, PyDict>>,
    by: Vec<String>,
    reactions: bool,
    tolerance: Option<f64>,
    pass_bifurcations: bool,
}

impl<'py> Options<'py> {
    fn are_usual(&self) -> bool {
        self.0.iter().all(Option::is_none)
    }

    /// Those that are given, by their names.
    fn given(&self) -> impl Iterator<Item = (&'static str, &Bound<'py, PyAny>)> {
        OPTIONS.iter().zip(&self.0).filter_map(|(name, given)| Some((*name, given.as_ref()?)))
    }

    fn read(&self, py: Python<'py>) -> PyResult<Read<'py>> {
        let [_, set, inputs, rates, accelerations, by, reactions, tolerance, pass_bifurcations, _] = &self.0;
        let values = py.import("mechc.values")?;
        let mapping = |name: &str, given: &Option<Bound<'py, PyAny>>| {
            let read =
                |given| -> PyResult<_> { Ok(values.getattr("mapping")?.call1((name, given))?.cast_into::<PyDict>()?) };
            given.as_ref().map(read).transpose()
        };
        let flag = |name: &str, given: &Option<Bound<'py, PyAny>>| match given {
            Some(given) => read_flag(py, name, given),
            None => Ok(false),
        };
        let by = by.as_ref().map(|by| values.getattr("texts")?.call1(("by", by))?.extract());
        let bound = |given| py.import("mechc.asking")?.getattr("bound")?.call1((given,))?.extract();
        Ok(Read {
            set: mapping("set", set)?,
            inputs: mapping("inputs", inputs)?,
            rates: mapping("rates", rates)?,
            accelerations: mapping("accelerations", accelerations)?,
            by: by.transpose()?.unwrap_or_default(),
            reactions: flag("reactions", reactions)?,
            tolerance: tolerance.as_ref().map(bound).transpose()?,
            pass_bifurcations: flag("pass_bifurcations", pass_bifurcations)?,
        })
    }

    /// Whether who does not get there is an error.
    pub fn are_strict(&self, py: Python<'py>) -> PyResult<bool> {
        let [.., strict] = &self.0;
        strict.as_ref().map_or(Ok(true), |given| read_flag(py, "strict", given))
    }
}

/// An option that is there or not.
fn read_flag(py: Python<'_>, name: &str, given: &Bound<'_, PyAny>) -> PyResult<bool> {
    py.import("mechc.asking")?.getattr("flag")?.call1((name, given))?.extract()
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
    options: &Options<'py>,
    values: Option<&Bound<'py, PyDict>>,
) -> PyResult<At> {
    if let (Some(values), true) = (values, options.are_usual())
        && let Some((compiled, inputs)) = mechanism.known.find_plain(values)
    {
        let question = Question { kind: Kind::default(), t: None, inputs, params: Vec::new(), shape: None };
        return question.answer(py, compiled);
    }
    mechanism.warn_of_options(py, options.given().collect())?;
    let (read_options, t) = (options.read(py)?, options.0[0].as_ref());
    let [inputs, params] = named(py, mechanism, &read_options, values)?;
    let mut all = vec![t.map_or(Ok(Value::One(0.0)), |t| read(py, t, &Told::Time))?];
    let names = add_motions(py, mechanism, &read_options, inputs, &mut all)?;
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
            bend: read_options.accelerations.is_some(),
            params: param_names,
            by: read_options.by,
            reactions: read_options.reactions,
            tolerance: read_options.tolerance.map(f64::to_bits),
            pass_bifurcations: read_options.pass_bifurcations,
        },
        shape,
    };
    let compiled = question.compiled(py, mechanism)?;
    question.answer(py, compiled)
}

/// Adds inputs with their rates and accelerations, and gives their names.
fn add_motions<'py>(
    py: Python<'py>,
    mechanism: &Mechanism,
    options: &Read<'py>,
    inputs: Vec<(String, Value<'py>)>,
    all: &mut Vec<Value<'py>>,
) -> PyResult<Vec<String>> {
    let mut names = Vec::with_capacity(inputs.len());
    for (name, value) in inputs {
        all.push(value);
        for (motion, order) in [(&options.rates, 1), (&options.accelerations, 2)] {
            all.push(match motion.as_ref().map(|of| of.get_item(&name)).transpose()?.flatten() {
                None => Value::One(0.0),
                Some(value) => read(py, &value, &Told::Rate(&mechanism.rate(&name, order)?, order))?,
            });
        }
        names.push(name);
    }
    refuse_rates_of_others(py, options, &names)?;
    Ok(names)
}

/// Inputs and params that are given, in the order of their names.
fn named<'py>(
    py: Python<'py>,
    mechanism: &Mechanism,
    options: &Read<'py>,
    values: Option<&Bound<'py, PyDict>>,
) -> PyResult<[Vec<(String, Value<'py>)>; 2]> {
    let mut found = [Vec::new(), Vec::new()];
    for (given, option) in [(&options.set, "set"), (&options.inputs, "inputs"), (&values.cloned(), "")] {
        for (name, value) in given.iter().flat_map(PyDictMethods::iter) {
            let name: String = name.extract()?;
            for (of, is_input, value) in mechanism.meant(py, &name, value, option)? {
                let told = if is_input { Told::Input(of) } else { Told::Param(of) };
                let read = match value {
                    Meant::Given(value) => read(py, &value, &told)?,
                    Meant::Known(value) => Value::One(value),
                };
                found[usize::from(!is_input)].push((of.name.clone(), read));
            }
        }
    }
    for named in &mut found {
        named.sort_by(|(a, _), (b, _)| a.cmp(b));
        if let Some(twice) = named.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return Err(usage(py, &format!("`{}` is given twice", twice[0].0), "say it once")?);
        }
    }
    Ok(found)
}

/// Rates are of inputs that are given.
fn refuse_rates_of_others(py: Python<'_>, options: &Read<'_>, inputs: &[String]) -> PyResult<()> {
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

/// What a value is of.
enum Told<'s> {
    Time,
    Input(&'s SettableParam),
    Param(&'s SettableParam),
    /// The rate of an input, or its acceleration.
    Rate(&'s SettableParam, u32),
}

impl Told<'_> {
    fn name(&self) -> &str {
        match self {
            Told::Time => "t",
            Told::Input(of) | Told::Param(of) | Told::Rate(of, _) => &of.name,
        }
    }

    /// The value of a text (SI).
    fn read(&self, text: &str, sources: &mut Sources) -> Result<f64, Error> {
        let (of, option, what) = match self {
            Told::Time => return seconds("t", text, sources),
            Told::Input(of) => (of, "--input", "the input"),
            Told::Param(of) => (of, "--set", "the parameter"),
            Told::Rate(of, 1) => (of, "--rates", "the rate of"),
            Told::Rate(of, _) => (of, "--accelerations", "the acceleration of"),
        };
        of.read(&format!("{option} {}", of.name), what, text, sources)
    }
}

/// A value that was handed over: a number, a text with its unit, or an array of such.
fn read<'py>(py: Python<'py>, value: &Bound<'py, PyAny>, told: &Told<'_>) -> PyResult<Value<'py>> {
    let is_whole = || value.is_instance_of::<PyInt>() && !value.is_instance_of::<PyBool>();
    if (value.is_exact_instance_of::<PyFloat>() || is_whole())
        && let Some(number) = value.extract::<f64>().ok().filter(|number| number.is_finite())
    {
        return Ok(Value::One(number));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return formula(py, text.to_str()?, told).map(Value::One);
    }
    static SPELLED: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    if let Some((texts, shape)) = SPELLED
        .import(py, "mechc.values", "spelled")?
        .call1((value,))?
        .extract::<Option<(Vec<String>, Vec<usize>)>>()?
    {
        let values = texts.iter().map(|text| formula(py, text, told)).collect::<PyResult<Vec<f64>>>()?;
        return Ok(Value::Each(PyArray1::from_vec(py, values).reshape(shape)?.into_any()));
    }
    static ELEMENTS: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let read = ELEMENTS.import(py, "mechc.values", "elements")?.call1((told.name(), value))?;
    Ok(match read.extract::<f64>() {
        Ok(number) if read.is_exact_instance_of::<PyFloat>() => Value::One(number),
        _ => Value::Each(read),
    })
}

/// The value of a formula (SI), which is to be none of time.
fn formula(py: Python<'_>, text: &str, told: &Told<'_>) -> PyResult<f64> {
    let is_of_time = |word: &str| word == "t";
    let name = told.name();
    if name != "t" && text.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(is_of_time) {
        let message = format!("`{name}` is a formula of time, and `at` takes values");
        let help = "an array has one for each element; what is not given follows its formula: `m.at(t=0.1)`";
        return Err(usage(py, &message, help)?);
    }
    let mut sources = Sources::default();
    told.read(text, &mut sources).map_err(|why| Said::from(why).raised(py))
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
