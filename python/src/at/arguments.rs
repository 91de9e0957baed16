//! The arguments of `Mechanism.at`: numbers, texts with units, and arrays, which are broadcast against each other.

use super::{At, EvaluatorKey, Operand, Query};
use crate::errors::Report;
use crate::mechanism::{Mechanism, SetValue};
use mechc::{Error, SettableParam, Sources, seconds};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};

/// The names of the options in Python; all other keywords are params and inputs.
pub const OPTIONS: [&str; 10] =
    ["t", "set", "inputs", "rates", "accelerations", "by", "reactions", "tolerance", "pass_bifurcations", "strict"];

/// The options, in the order of [`OPTIONS`]; `None` for each that is not given.
pub struct Options<'py>(pub [Option<Bound<'py, PyAny>>; 10]);

/// The options after their types were checked.
#[derive(Default)]
struct ParsedOptions<'py> {
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
    fn are_empty(&self) -> bool {
        self.0.iter().all(Option::is_none)
    }

    /// Returns the given options with their names.
    fn given(&self) -> impl Iterator<Item = (&'static str, &Bound<'py, PyAny>)> {
        OPTIONS.iter().zip(&self.0).filter_map(|(name, given)| Some((*name, given.as_ref()?)))
    }

    fn read(&self, py: Python<'py>) -> PyResult<ParsedOptions<'py>> {
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
        let bound = |given| py.import("mechc.requests")?.getattr("bound")?.call1((given,))?.extract();
        Ok(ParsedOptions {
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

    /// Returns whether an element that fails raises an exception.
    pub fn is_strict(&self, py: Python<'py>) -> PyResult<bool> {
        let [.., strict] = &self.0;
        strict.as_ref().map_or(Ok(true), |given| read_flag(py, "strict", given))
    }
}

/// Reads an option that is true or false.
fn read_flag(py: Python<'_>, name: &str, given: &Bound<'_, PyAny>) -> PyResult<bool> {
    py.import("mechc.requests")?.getattr("flag")?.call1((name, given))?.extract()
}

/// A value before it is broadcast.
enum Value<'py> {
    One(f64),
    Each(Bound<'py, PyAny>),
}

/// Evaluates a mechanism by the arguments of `Mechanism.at`.
pub fn at<'py>(
    py: Python<'py>,
    mechanism: &Mechanism,
    options: &Options<'py>,
    values: Option<&Bound<'py, PyDict>>,
) -> PyResult<At> {
    if let (Some(values), true) = (values, options.are_empty())
        && let Some((compiled, inputs)) = mechanism.evaluators.find_inputs_only(values)
    {
        let query = Query { key: EvaluatorKey::default(), t: None, inputs, params: Vec::new(), shape: None };
        return query.answer(py, compiled);
    }
    mechanism.warn_of_options(py, options.given().collect())?;
    let (parsed, t) = (options.read(py)?, options.0[0].as_ref());
    let [inputs, params] = inputs_and_params(py, mechanism, &parsed, values)?;
    let mut all = vec![t.map_or(Ok(Value::One(0.0)), |t| read(py, t, &Target::Time))?];
    let names = add_motions(py, mechanism, &parsed, inputs, &mut all)?;
    let (param_names, values): (Vec<String>, Vec<Value<'py>>) = params.into_iter().unzip();
    all.extend(values);
    let (shape, operands) = broadcast(py, all)?;
    let mut operands = operands.into_iter();
    let first = operands.next().filter(|_| t.is_some());
    let mut next = || operands.next().unwrap_or(Operand::One(0.0));
    let query = Query {
        t: first,
        inputs: names.iter().map(|_| [next(), next(), next()]).collect(),
        params: param_names.iter().map(|_| next()).collect(),
        key: EvaluatorKey {
            inputs: names,
            has_accelerations: parsed.accelerations.is_some(),
            params: param_names,
            by: parsed.by,
            reactions: parsed.reactions,
            tolerance: parsed.tolerance.map(f64::to_bits),
            pass_bifurcations: parsed.pass_bifurcations,
        },
        shape,
    };
    let compiled = query.compiled(py, mechanism)?;
    query.answer(py, compiled)
}

/// Adds inputs with their rates and accelerations to `all`. Returns the names of the inputs.
fn add_motions<'py>(
    py: Python<'py>,
    mechanism: &Mechanism,
    options: &ParsedOptions<'py>,
    inputs: Vec<(String, Value<'py>)>,
    all: &mut Vec<Value<'py>>,
) -> PyResult<Vec<String>> {
    let mut names = Vec::with_capacity(inputs.len());
    for (name, value) in inputs {
        all.push(value);
        for (motion, order) in [(&options.rates, 1), (&options.accelerations, 2)] {
            all.push(match motion.as_ref().map(|of| of.get_item(&name)).transpose()?.flatten() {
                None => Value::One(0.0),
                Some(value) => read(py, &value, &Target::Rate(&mechanism.rate(&name, order)?, order))?,
            });
        }
        names.push(name);
    }
    refuse_rates_without_input(py, options, &names)?;
    Ok(names)
}

/// Returns the inputs and the params that are given, each in the order of their names.
fn inputs_and_params<'py>(
    py: Python<'py>,
    mechanism: &Mechanism,
    options: &ParsedOptions<'py>,
    values: Option<&Bound<'py, PyDict>>,
) -> PyResult<[Vec<(String, Value<'py>)>; 2]> {
    let mut found = [Vec::new(), Vec::new()];
    for (given, option) in [(&options.set, "set"), (&options.inputs, "inputs"), (&values.cloned(), "")] {
        for (name, value) in given.iter().flat_map(PyDictMethods::iter) {
            let name: String = name.extract()?;
            for (of, is_input, value) in mechanism.resolve(py, &name, value, option)? {
                let target = if is_input { Target::Input(of) } else { Target::Param(of) };
                let read = match value {
                    SetValue::Given(value) => read(py, &value, &target)?,
                    SetValue::Number(value) => Value::One(value),
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

/// Refuses rates and accelerations of inputs whose value is not given.
fn refuse_rates_without_input(py: Python<'_>, options: &ParsedOptions<'_>, inputs: &[String]) -> PyResult<()> {
    for (motion, what) in [(&options.rates, "rates"), (&options.accelerations, "accelerations")] {
        for name in motion.iter().flat_map(|of| of.keys().iter().collect::<Vec<_>>()) {
            let name: String = name.extract()?;
            if !inputs.contains(&name) {
                let message = format!("`{what}` has `{name}`, which is no input that is given");
                return Err(usage(py, &message, "give its value too, as in `m.at(turn=0.3, rates={'turn': 2.0})`")?);
            }
        }
    }
    Ok(())
}

/// The quantity that a value is given for.
enum Target<'s> {
    Time,
    Input(&'s SettableParam),
    Param(&'s SettableParam),
    /// The rate of an input, or its acceleration.
    Rate(&'s SettableParam, u32),
}

impl Target<'_> {
    fn name(&self) -> &str {
        match self {
            Target::Time => "t",
            Target::Input(of) | Target::Param(of) | Target::Rate(of, _) => &of.name,
        }
    }

    /// Evaluates a text with its unit (SI).
    fn read(&self, text: &str, sources: &mut Sources) -> Result<f64, Error> {
        let (of, option, what) = match self {
            Target::Time => return seconds("t", text, sources),
            Target::Input(of) => (of, "--input", "the input"),
            Target::Param(of) => (of, "--set", "the parameter"),
            Target::Rate(of, 1) => (of, "--rates", "the rate of"),
            Target::Rate(of, _) => (of, "--accelerations", "the acceleration of"),
        };
        of.read(&format!("{option} {}", of.name), what, text, sources)
    }
}

/// Reads a number, a text with its unit, or an array of these.
fn read<'py>(py: Python<'py>, value: &Bound<'py, PyAny>, target: &Target<'_>) -> PyResult<Value<'py>> {
    let is_whole = || value.is_instance_of::<PyInt>() && !value.is_instance_of::<PyBool>();
    if (value.is_exact_instance_of::<PyFloat>() || is_whole())
        && let Some(number) = value.extract::<f64>().ok().filter(|number| number.is_finite())
    {
        return Ok(Value::One(number));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return formula(py, text.to_str()?, target).map(Value::One);
    }
    static TEXT_ARRAY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    if let Some((texts, shape)) = TEXT_ARRAY
        .import(py, "mechc.values", "text_array")?
        .call1((value,))?
        .extract::<Option<(Vec<String>, Vec<usize>)>>()?
    {
        let values = texts.iter().map(|text| formula(py, text, target)).collect::<PyResult<Vec<f64>>>()?;
        return Ok(Value::Each(PyArray1::from_vec(py, values).reshape(shape)?.into_any()));
    }
    static ELEMENTS: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let read = ELEMENTS.import(py, "mechc.values", "elements")?.call1((target.name(), value))?;
    Ok(match read.extract::<f64>() {
        Ok(number) if read.is_exact_instance_of::<PyFloat>() => Value::One(number),
        _ => Value::Each(read),
    })
}

/// Evaluates a formula (SI); one that depends on time is refused.
fn formula(py: Python<'_>, text: &str, target: &Target<'_>) -> PyResult<f64> {
    let is_of_time = |word: &str| word == "t";
    let name = target.name();
    if name != "t" && text.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(is_of_time) {
        let message = format!("`{name}` is a formula of time, and `at` takes values");
        let help = "an array has one for each element; what is not given follows its formula: `m.at(t=0.1)`";
        return Err(usage(py, &message, help)?);
    }
    let mut sources = Sources::default();
    target.read(text, &mut sources).map_err(|why| Report::from(why).to_exception(py))
}

/// Broadcasts values against each other. Returns their common shape, `None` if all are single numbers, and the operands.
fn broadcast(py: Python<'_>, values: Vec<Value<'_>>) -> PyResult<(Option<Vec<usize>>, Vec<Operand>)> {
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
    static BROADCAST: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let arrays_of_one_shape: Vec<PyReadonlyArrayDyn<'_, f64>> =
        BROADCAST.import(py, "mechc.values", "broadcast")?.call1((arrays,))?.extract()?;
    let shape = arrays_of_one_shape.first().map(|array| array.as_array().shape().to_vec()).unwrap_or_default();
    let mut arrays_of_one_shape = arrays_of_one_shape.into_iter();
    let mut operands = Vec::with_capacity(values.len());
    for value in values {
        operands.push(match value {
            Value::One(number) => Operand::One(number),
            Value::Each(_) => Operand::Each(
                arrays_of_one_shape.next().map_or(Vec::new(), |of| of.as_array().iter().copied().collect()),
            ),
        });
    }
    Ok((Some(shape), operands))
}

fn usage(py: Python<'_>, message: &str, help: &str) -> PyResult<PyErr> {
    Ok(PyErr::from_value(py.import("mechc.values")?.getattr("usage")?.call1((message, help))?))
}
