//! A mechanism: its text, checked, proven and compiled once.

use crate::at::{self, At, EvaluatorCache, Options};
use crate::errors::Report;
use crate::evaluator::Evaluator;
use crate::export::{self, RustRequest};
use crate::files::Files;
use crate::interrupts::interruptible;
use crate::run::RunRequest;
use crate::sweep::{Sweep, SweepRequest};
use crate::tolerance::{self, ToleranceReport};
use mechc::{Cancel, Checked, Choice, Compiled, Error, Parsed, Redundant, SettableParam, Sources, World};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyString};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A result with its warnings, or the errors.
pub type Reported<T> = Result<(T, Report), Report>;

/// A mechanism with its settings.
#[pyclass(frozen, subclass, module = "mechc._mechc")]
pub struct Mechanism {
    pub stages: Arc<Stages>,
    params: Vec<SettableParam>,
    inputs: Vec<SettableParam>,
    /// The evaluators of `at`.
    pub evaluators: EvaluatorCache,
}

impl Mechanism {
    /// Returns the params or inputs that a name refers to, each with whether it is an input, and its value: one of that name, all copies of
    /// one, both coordinates of a point. `option` is the option that has the name; empty for a keyword.
    pub fn resolve<'m, 'py>(
        &'m self,
        py: Python<'py>,
        name: &str,
        value: Bound<'py, PyAny>,
        option: &str,
    ) -> PyResult<Vec<(&'m SettableParam, bool, SetValue<'py>)>> {
        if let (Some((of, is_input)), "") = (self.settable(name), option) {
            return Ok(vec![(of, is_input, SetValue::Given(value))]);
        }
        let resolve = py.import("mechc.requests")?.getattr("resolve_name")?;
        let names: Vec<String> =
            resolve.call1((name, option, units(&self.params), units(&self.inputs), at::OPTIONS))?.extract()?;
        let all = names.iter().filter_map(|name| self.settable(name));
        let [x, y] = match names.as_slice() {
            [x, y] if is_point(x, y) => [x, y],
            _ => return Ok(all.map(|(of, is_input)| (of, is_input, SetValue::Given(value.clone()))).collect()),
        };
        let Ok(text) = value.cast::<PyString>() else {
            let usage = py.import("mechc.values")?.getattr("usage")?;
            let help = format!("set `{x}` and `{y}`, or give a text as in `'(90 mm, 0)'`");
            return Err(PyErr::from_value(usage.call1((format!("`{name}` is a point"), help))?));
        };
        let values = self.coordinates(py, [x, y], text.to_str()?)?;
        Ok(all.zip(values).map(|((of, is_input), value)| (of, is_input, SetValue::Number(value))).collect())
    }

    /// Returns a param or input by its name, and whether it is an input.
    fn settable(&self, name: &str) -> Option<(&SettableParam, bool)> {
        let found = |list: &'_ [SettableParam]| list.iter().position(|of| of.name == name);
        let input = found(&self.inputs).map(|place| (&self.inputs[place], true));
        input.or_else(|| found(&self.params).map(|place| (&self.params[place], false)))
    }

    /// Evaluates a text such as `(90 mm, 0)` as the coordinates of a point (m).
    fn coordinates(&self, py: Python<'_>, [x, y]: [&String; 2], text: &str) -> PyResult<[f64; 2]> {
        let Stages { parsed, choice, files, .. } = &*self.stages;
        let mut choice = choice.clone();
        choice.set.push(format!("{}={text}", x.trim_end_matches(".x")));
        let checked = parsed.check(&choice, &**files);
        let params = checked.settable_params();
        let of = |name: &String| params.iter().find(|of| of.name == *name).map(|of| of.value);
        match (checked.is_sound(), of(x), of(y)) {
            (true, Some(x), Some(y)) => Ok([x, y]),
            _ => Err(Report::new(checked.diagnostics(), checked.sources()).to_exception(py)),
        }
    }

    /// Warns of given options whose names hide params or inputs.
    pub fn warn_of_options(&self, py: Python<'_>, given: BTreeMap<&str, &Bound<'_, PyAny>>) -> PyResult<()> {
        let is_taken = |name: &&str| self.params.iter().chain(&self.inputs).any(|of| of.name == *name);
        if given.keys().any(is_taken) {
            let warn = py.import("mechc.requests")?.getattr("warn_of_options")?;
            warn.call1((units(&self.params), units(&self.inputs), given))?;
        }
        Ok(())
    }

    /// Returns the rate (`order` 1) or acceleration (2) of an input.
    pub fn rate(&self, name: &str, order: u32) -> PyResult<SettableParam> {
        let input = self.inputs.iter().find(|of| of.name == name).map(|of| of.by_time(order));
        input.ok_or_else(|| pyo3::exceptions::PyKeyError::new_err(name.to_owned()))
    }
}

/// The value that a param or input is set to.
pub enum SetValue<'py> {
    /// The given object.
    Given(Bound<'py, PyAny>),
    /// A number (SI).
    Number(f64),
}

/// Returns whether two params are the coordinates of one point.
fn is_point(x: &str, y: &str) -> bool {
    x.strip_suffix(".x").is_some_and(|point| y.strip_suffix(".y") == Some(point))
}

/// A mechanism at each stage of its compilation, with the options of these.
#[derive(Clone)]
pub struct Stages {
    pub parsed: Parsed,
    pub path: PathBuf,
    pub files: Arc<Files>,
    /// The selected mechanism, and the values that are set.
    pub choice: Choice,
    pub redundant: Redundant,
    pub checked: Checked,
    pub compiled: Compiled,
}

impl Stages {
    fn new(
        parsed: Parsed,
        path: PathBuf,
        files: Arc<Files>,
        settings: (Choice, Redundant),
        cancel: &Cancel,
    ) -> Reported<Stages> {
        let (choice, redundant) = settings;
        let ((checked, compiled), report) = compile(&parsed, &choice, &*files, redundant, cancel)?;
        compiled.prepare();
        Ok((Stages { parsed, path, files, choice, redundant, checked, compiled }, report))
    }

    /// Compiles the mechanism with other options.
    pub fn compile(
        &self,
        choice: &Choice,
        world: &dyn World,
        redundant: Redundant,
        cancel: &Cancel,
    ) -> Reported<(Checked, Compiled)> {
        compile(&self.parsed, choice, world, redundant, cancel)
    }
}

fn compile(
    parsed: &Parsed,
    choice: &Choice,
    world: &dyn World,
    redundant: Redundant,
    cancel: &Cancel,
) -> Reported<(Checked, Compiled)> {
    let checked = parsed.check(choice, world);
    let (sources, mut report) = (checked.sources().clone(), checked.diagnostics().clone());
    if !checked.is_sound() {
        return Err(Report::new(&report, &sources));
    }
    let (compiled, more) = checked.compile(redundant, cancel);
    match compiled {
        Some(compiled) => {
            report.extend(more);
            let report = Report::new(&report, &sources);
            Ok(((checked, compiled), report))
        }
        None => Err(Report::new(&more, &sources)),
    }
}

#[pymethods]
impl Mechanism {
    /// Reads, checks and proves a mechanism; without a text the file at `path` is read.
    #[new]
    #[pyo3(signature = (text, path, files, from_disk, mechanism, set, allow_redundant))]
    fn new(
        py: Python<'_>,
        text: Option<String>,
        path: PathBuf,
        files: BTreeMap<PathBuf, Vec<u8>>,
        from_disk: bool,
        mechanism: Option<String>,
        set: Vec<String>,
        allow_redundant: bool,
    ) -> PyResult<Mechanism> {
        let files = Arc::new(Files::new(files, from_disk));
        let choice = Choice { mechanism, set, ..Choice::default() };
        let redundant = if allow_redundant { Redundant::LeftOut } else { Redundant::Refused };
        let made = interruptible(py, move |cancel| {
            let parsed = read(text.as_deref(), &path, &files)?;
            Stages::new(parsed, path, files, (choice, redundant), cancel)
        })?;
        let (stages, report) = made.map_err(|report| report.to_exception(py))?;
        report.warn(py)?;
        let (params, inputs) = (stages.checked.settable_params(), stages.checked.settable_inputs(&stages.compiled));
        Ok(Mechanism { stages: Arc::new(stages), params, inputs, evaluators: EvaluatorCache::default() })
    }

    /// Returns what is pickled: text, path, files, mechanism, settings, and whether redundant equations are left out.
    fn _pickled<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Stages { parsed, path, files, choice, redundant, .. } = &*self.stages;
        let contents = PyDict::new(py);
        for (path, bytes) in files.contents() {
            contents.set_item(path, PyBytes::new(py, &bytes))?;
        }
        let text = &parsed.sources().get(parsed.file()).text;
        let leaves_out = *redundant == Redundant::LeftOut;
        let pickled = (text, path, contents, choice.mechanism.as_ref(), &choice.set, leaves_out);
        Ok(pickled.into_pyobject(py)?.into_any())
    }

    #[getter]
    fn _name(&self) -> &str {
        self.stages.compiled.name()
    }

    /// Coordinates less equations: 0 of what is determined, less where redundant equations are left out.
    #[getter]
    fn ndof(&self) -> isize {
        self.stages.compiled.ndof()
    }

    /// The text.
    #[getter]
    fn text(&self) -> &str {
        &self.stages.parsed.sources().get(self.stages.parsed.file()).text
    }

    /// Each param: its name, its value (SI), its unit.
    #[getter]
    fn _params(&self) -> Vec<(&str, f64, &str)> {
        self.params.iter().map(|of| (of.name.as_str(), of.value, of.unit.as_str())).collect()
    }

    #[getter]
    fn _inputs(&self) -> Vec<(&str, f64, &str)> {
        self.inputs.iter().map(|of| (of.name.as_str(), of.value, of.unit.as_str())).collect()
    }

    fn _columns(&self) -> Vec<String> {
        self.stages.compiled.columns()
    }

    #[getter]
    fn _units(&self) -> Vec<String> {
        self.stages.compiled.units().into_iter().map(|unit| unit.text).collect()
    }

    #[getter]
    fn _results(&self) -> Vec<(String, String)> {
        self.stages.compiled.variant_results()
    }

    /// First time, last time and step of the text's analysis (s), if it has one.
    #[getter]
    fn analysis(&self) -> Option<(f64, f64, f64)> {
        self.stages.compiled.analysis().map(|[from, to, every]| (from, to, every))
    }

    /// Each driver with its equation as it is written.
    #[getter]
    fn drivers(&self) -> Vec<(String, String)> {
        self.stages.compiled.drivers()
    }

    /// How many coordinates and equations there are, by body and declaration, as a table.
    #[getter]
    fn counts(&self) -> String {
        self.stages.compiled.counts()
    }

    /// Runs the mechanism; `request` has the options by their names.
    fn _run(&self, py: Python<'_>, request: RunRequest) -> PyResult<Py<PyDict>> {
        request.run(py, Arc::clone(&self.stages))
    }

    /// Where it is at given inputs, params and times: coordinates, velocities, accelerations, measures and forces at one place.
    ///
    /// Inputs are given by their names, `m.at(theta=0.3)`: numbers in SI, texts with units, or arrays, which are broadcast against
    /// each other. `rates` and `accelerations` say how they move there: `m.at(theta=0.3, rates={"theta": 5.0})`; they stand still where
    /// nothing is report. A mechanism without inputs is request for times, `m.at(t=0.02)`, and `t` may be an array too. Params may be
    /// given beside, to which it is led along the branch: `m.at(t=0.02, rod_length=0.18)`.
    ///
    /// The answer has a column for each that a run has: `x["piston.x"]`, a number or an array of the elements' shape; `x.q`, `x.qd`, `x.qdd`
    /// of shape (…, coordinates). `by` adds the derivatives of all columns by inputs and params (`x["piston.x.by.theta"]`, `x.columns`
    /// has their names); `reactions` what joints exert and drivers supply.
    ///
    /// Each element starts from the assembled start, so that neither order nor company change a bit: with inputs it is what
    /// `mechc run --input 'theta=0.3 rad' --at 0` gives. Where one does not get there an error is raised, with the answer as
    /// `partial` and its index as `element`; with `strict=False` its values are `nan`, and `x.status` says why. A sweep, and `run`, assemble
    /// where no way leads from the text's estimates instead (`reassembled`).
    #[pyo3(
        signature = (t=None, *, set=None, inputs=None, rates=None, accelerations=None, by=None, reactions=None, tolerance=None,
                     pass_bifurcations=None, strict=None, **values),
        text_signature = "($self, t=None, *, set=None, inputs=None, rates=None, accelerations=None, by=None, reactions=False, \
                          tolerance=None, pass_bifurcations=False, strict=True, **values)"
    )]
    fn at<'py>(
        &self,
        py: Python<'py>,
        t: Option<Bound<'py, PyAny>>,
        set: Option<Bound<'py, PyAny>>,
        inputs: Option<Bound<'py, PyAny>>,
        rates: Option<Bound<'py, PyAny>>,
        accelerations: Option<Bound<'py, PyAny>>,
        by: Option<Bound<'py, PyAny>>,
        reactions: Option<Bound<'py, PyAny>>,
        tolerance: Option<Bound<'py, PyAny>>,
        pass_bifurcations: Option<Bound<'py, PyAny>>,
        strict: Option<Bound<'py, PyAny>>,
        values: Option<Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, At>> {
        let given = [t, set, inputs, rates, accelerations, by, reactions, tolerance, pass_bifurcations, strict];
        let options = Options(given);
        let is_strict = options.is_strict(py)?;
        let found = Bound::new(py, at::at(py, self, &options, values.as_ref())?)?;
        match found.get().error(py).filter(|_| is_strict) {
            None => Ok(found),
            Some(error) => {
                error.setattr(py, "partial", &found)?;
                Err(PyErr::from_value(error.into_bound(py)))
            }
        }
    }

    /// Compiles results and rows as functions of some params.
    fn _evaluator(&self, py: Python<'_>, request: RunRequest, params: Vec<String>) -> PyResult<Evaluator> {
        Evaluator::new(py, Arc::clone(&self.stages), request, params)
    }

    /// Returns the deviations that tolerances cause.
    fn _tolerance(
        &self,
        py: Python<'_>,
        request: RunRequest,
        tol: Vec<String>,
        normal: bool,
        verify: bool,
    ) -> PyResult<ToleranceReport> {
        tolerance::tolerance(py, Arc::clone(&self.stages), request, tol, (normal, verify))
    }

    /// Returns a Rust module.
    fn _rust(&self, py: Python<'_>, request: RustRequest) -> PyResult<String> {
        request.module(py, Arc::clone(&self.stages))
    }

    /// Returns the files of a crate, and the mark that each begins with.
    fn _crate(&self, py: Python<'_>, request: RustRequest, name: &str) -> PyResult<export::Crate> {
        request.package(py, Arc::clone(&self.stages), name)
    }

    fn _latex(&self, py: Python<'_>) -> PyResult<String> {
        export::latex(py, Arc::clone(&self.stages))
    }

    fn _json(&self, py: Python<'_>) -> PyResult<String> {
        export::json(py, Arc::clone(&self.stages))
    }

    /// Returns a page and a picture of the motion, with at most `most` rows, and the exception if the motion stops early.
    #[pyo3(signature = (request, most = None))]
    fn _visualize(&self, py: Python<'_>, request: RunRequest, most: Option<usize>) -> PyResult<export::Visualized> {
        export::visualize(py, Arc::clone(&self.stages), request, most)
    }

    /// Prepares a sweep; `request` has the options of a run, `variation` those of the sweep.
    fn _sweep(&self, py: Python<'_>, request: RunRequest, variation: SweepRequest) -> PyResult<Sweep> {
        Sweep::new(py, Arc::clone(&self.stages), request, variation)
    }
}

fn read(text: Option<&str>, path: &Path, files: &Files) -> Result<Parsed, Error> {
    match text {
        None => Parsed::read(path, files),
        Some(text) => {
            let mut sources = Sources::default();
            let file = sources.add(path.to_string_lossy(), text);
            Ok(Parsed::from_source(sources, file, path))
        }
    }
}

/// Returns names with their units.
fn units(list: &[SettableParam]) -> BTreeMap<String, String> {
    list.iter().map(|of| (of.name.clone(), of.unit.clone())).collect()
}
