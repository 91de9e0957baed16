//! Diagnostics as exceptions and warnings: their data, and the text that the command prints. The classes are in `mechc/errors.py`.

use crate::option_spelling::{in_python, with_keywords};
use mechc::{Color, Diagnostic, Diagnostics, Error, ErrorKind, Format, Severity, Sources, render};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyList;
use serde_json::Value;
use std::borrow::Cow;

/// Rendered diagnostics, which become an exception or a warning.
#[derive(Clone, Default)]
pub struct Report {
    /// Each diagnostic as the JSON object of `--message-format json`.
    json: Vec<String>,
    /// All diagnostics as the command prints them.
    text: String,
    /// The kind of error: `input`, `usage`, `analysis`, `files`, `cancelled`; empty without errors.
    kind: Cow<'static, str>,
    /// The time of the first error (s), if it has one.
    pub stopped: Option<f64>,
    /// The code of the first error.
    pub code: Option<Cow<'static, str>>,
}

/// A report as it is pickled: its lines of JSON, text, kind, time (s) and code.
pub type PickledReport = (Vec<String>, String, String, Option<f64>, Option<String>);

impl From<Error> for Report {
    fn from(error: Error) -> Report {
        Report::new(&error.diagnostics, &error.sources)
    }
}

impl Report {
    /// Renders diagnostics of source texts.
    pub fn new(diagnostics: &Diagnostics, sources: &Sources) -> Report {
        let (keywords, mut json, mut texts) = (with_keywords(sources), Vec::new(), Vec::new());
        for diagnostic in diagnostics.iter() {
            let diagnostic = in_python(diagnostic);
            let text = |format| render(&diagnostic, &keywords, format, Color::Never).trim_end_matches('\n').to_owned();
            json.push(text(Format::Json));
            texts.push(text(Format::Human));
        }
        let first = diagnostics.iter().find(|of| of.severity() == Severity::Error);
        let kind = match ErrorKind::of(diagnostics, sources) {
            None => "",
            Some(ErrorKind::Input) => "input",
            Some(ErrorKind::Usage) => "usage",
            Some(ErrorKind::Analysis) => "analysis",
            Some(ErrorKind::Files) => "files",
            Some(ErrorKind::Cancelled) => "cancelled",
        };
        Report {
            json,
            text: texts.join("\n"),
            kind: kind.into(),
            stopped: first.and_then(|of| of.data.get("t")).and_then(Value::as_f64),
            code: first.map(|of| of.code.as_str().into()),
        }
    }

    /// Renders one diagnostic.
    pub fn from_diagnostic(diagnostic: Diagnostic, sources: &Sources) -> Report {
        Report::new(&diagnostic.into(), sources)
    }

    /// Returns what is pickled.
    pub fn to_pickled(&self) -> PickledReport {
        let code = self.code.as_deref().map(str::to_owned);
        (self.json.clone(), self.text.clone(), self.kind.to_string(), self.stopped, code)
    }

    /// Restores a report that was pickled.
    pub fn from_pickled((json, text, kind, stopped, code): PickledReport) -> Report {
        Report { json, text, kind: kind.into(), stopped, code: code.map(Cow::Owned) }
    }

    /// Returns whether there are no diagnostics.
    pub fn is_empty(&self) -> bool {
        self.json.is_empty()
    }

    /// Returns the exception.
    pub fn to_exception(&self, py: Python<'_>) -> PyErr {
        static TO_EXCEPTION: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        let made = TO_EXCEPTION.import(py, "mechc.errors", "_exception_from").and_then(|to_exception| {
            to_exception.call1((
                self.json_lines(py)?,
                &self.text,
                &*self.kind,
                self.code.as_deref().unwrap_or_default(),
            ))
        });
        match made {
            Ok(exception) => PyErr::from_value(exception),
            Err(why) => why,
        }
    }

    /// Issues a warning, unless there are no diagnostics.
    pub fn warn(&self, py: Python<'_>) -> PyResult<()> {
        if self.is_empty() {
            return Ok(());
        }
        static WARN: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        WARN.import(py, "mechc.errors", "_warn")?.call1((self.json_lines(py)?, &self.text))?;
        Ok(())
    }

    /// Returns the diagnostics as lines of JSON.
    pub fn json_lines<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        PyList::new(py, &self.json)
    }
}
