//! Exports a mechanism as Rust, LaTeX, JSON, a page or a picture.

use crate::errors::Report;
use crate::interrupts::interruptible;
use crate::mechanism::Stages;
use crate::run::RunRequest;
use mechc::{Cancel, MARK, RequestedTimes, RustOptions, page, picture};
use pyo3::prelude::*;
use std::sync::Arc;

/// Largest number of rows of a page or picture; of a longer motion it has every n-th row, and the last.
const MOST_ROWS: usize = 2000;

/// Options of Rust code, by the names of the command's options.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct RustRequest {
    sensitivities: bool,
    lanes: Option<usize>,
    ffi: bool,
}

/// The files of a crate by their paths, and the mark that each begins with.
pub type Crate = (Vec<(String, String)>, &'static str);

impl RustRequest {
    fn options(&self, stages: &Stages) -> RustOptions {
        RustOptions {
            with_sensitivities: self.sensitivities,
            lanes: self.lanes,
            for_c: self.ffi,
            ..RustOptions::new(file_name(stages))
        }
    }

    /// Returns a Rust module.
    pub fn module(&self, py: Python<'_>, stages: Arc<Stages>) -> PyResult<String> {
        let options = self.options(&stages);
        let (text, report) = interruptible(py, move |_| {
            let (text, report) = stages.compiled.rust(&options);
            (text, Report::new(&report, stages.compiled.sources()))
        })?;
        warn_or_raise(py, text, report)
    }

    /// Returns a crate of the given name.
    pub fn package(&self, py: Python<'_>, stages: Arc<Stages>, name: &str) -> PyResult<Crate> {
        let (options, name) = (self.options(&stages), name.to_owned());
        let (files, report) = interruptible(py, move |_| {
            let (files, report) = stages.compiled.package(&name, &options);
            (files, Report::new(&report, stages.compiled.sources()))
        })?;
        let files = warn_or_raise(py, files, report)?;
        Ok((files.into_iter().map(|file| (file.path, file.text)).collect(), MARK))
    }
}

/// Returns a result, with its report as a warning; without a result the report is the exception.
fn warn_or_raise<T>(py: Python<'_>, made: Option<T>, report: Report) -> PyResult<T> {
    match made {
        Some(made) => report.warn(py).map(|()| made),
        None => Err(report.to_exception(py)),
    }
}

/// Returns the equations as a LaTeX document.
pub fn latex(py: Python<'_>, stages: Arc<Stages>) -> PyResult<String> {
    interruptible(py, move |_| stages.compiled.latex(&file_name(&stages)))
}

/// Returns the constraint system as JSON.
pub fn json(py: Python<'_>, stages: Arc<Stages>) -> PyResult<String> {
    interruptible(py, move |_| stages.compiled.json(&file_name(&stages)))
}

fn file_name(stages: &Stages) -> String {
    stages.path.file_name().map_or("-".into(), |name| name.to_string_lossy()).into_owned()
}

/// A page, a picture, and the exception if the motion stops early.
pub type Visualized = (String, String, Option<Py<PyAny>>);

/// Returns an animated page, and a picture that is animated without a script, with at most `most` rows.
pub fn visualize(
    py: Python<'_>,
    stages: Arc<Stages>,
    request: RunRequest,
    most: Option<usize>,
) -> PyResult<Visualized> {
    let most = most.unwrap_or(MOST_ROWS);
    let made = interruptible(py, move |cancel| Drawn::new(&stages, &request, most, cancel))?;
    let Drawn { page, picture, stopped, report } = made.map_err(|report| report.to_exception(py))?;
    report.warn(py)?;
    Ok((page, picture, stopped.map(|report| report.to_exception(py).into_value(py).into_any())))
}

struct Drawn {
    page: String,
    picture: String,
    /// The error that stopped the motion.
    stopped: Option<Report>,
    /// The warnings.
    report: Report,
}

impl Drawn {
    /// Draws the motion up to where it stops; a mechanism that cannot be assembled is drawn in its nearest position.
    fn new(stages: &Stages, request: &RunRequest, most: usize, cancel: &Cancel) -> Result<Drawn, Report> {
        let choice = mechc::Choice { pictures_forces: true, ..request.choice(stages) };
        let ((checked, compiled), _) = stages.compile(&choice, &*stages.files, request.redundant(stages), cancel)?;
        let mut sources = compiled.sources().clone();
        let times =
            RequestedTimes::from_options([&request.from, &request.to, &request.every], &request.at, &mut sources)
                .and_then(|request| request.over(compiled.analysis())?.whole())?;
        let options = request.options(cancel);
        let (visualization, report) = match checked.visualize(&compiled, &times, &options, most) {
            (None, report) => {
                (checked.static_visualization(Some(&compiled), (times.from(), &options), &report), report)
            }
            visualization => visualization,
        };
        let rendered = Report::new(&report, &sources);
        let visualization = visualization.ok_or_else(|| rendered.clone())?;
        let (page, picture) = (page(&visualization, &sources), picture(&visualization));
        let why = visualization.stopped.map(|why| Report::from_diagnostic(why, &sources));
        let (stopped, report) = if report.has_errors() { (Some(rendered), Report::default()) } else { (why, rendered) };
        Ok(Drawn { page, picture, stopped, report })
    }
}
