//! Diagnostics as exceptions: the data, the text that the command prints, and the kind that says who is to mend it. The classes are
//! in `mechc/errors.py`.

use crate::words::{in_python, with_keywords};
use mechc::{Color, Diagnostic, Diagnostics, Error, ErrorKind, Format, Severity, Sources, render};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyList;
use serde_json::Value;
use std::borrow::Cow;

/// What is said of something, ready to be told.
#[derive(Clone, Default)]
pub struct Said {
    /// Each as the JSON object of `--message-format json`.
    json: Vec<String>,
    /// All of it, as the command prints it.
    text: String,
    /// Who is to mend it: `input`, `usage`, `analysis`, `files`; empty where nothing is wrong.
    blame: Cow<'static, str>,
    /// When the first error happens (s), and its code.
    pub stopped: Option<f64>,
    /// The code of the first error.
    pub code: Option<Cow<'static, str>>,
}

/// What is packed of it: its lines of JSON, its text, the blame, the time, the code.
pub type Packed = (Vec<String>, String, String, Option<f64>, Option<String>);

impl From<Error> for Said {
    fn from(error: Error) -> Said {
        Said::of(&error.diagnostics, &error.sources)
    }
}

impl Said {
    /// Diagnostics of some texts.
    pub fn of(diagnostics: &Diagnostics, sources: &Sources) -> Said {
        let (keywords, mut json, mut texts) = (with_keywords(sources), Vec::new(), Vec::new());
        for diagnostic in diagnostics.iter() {
            let diagnostic = in_python(diagnostic);
            let text = |format| render(&diagnostic, &keywords, format, Color::Never).trim_end_matches('\n').to_owned();
            json.push(text(Format::Json));
            texts.push(text(Format::Human));
        }
        let first = diagnostics.iter().find(|of| of.severity() == Severity::Error);
        let blame = match ErrorKind::of(diagnostics, sources) {
            None => "",
            Some(ErrorKind::Input) => "input",
            Some(ErrorKind::Usage) => "usage",
            Some(ErrorKind::Analysis) => "analysis",
            Some(ErrorKind::Files) => "files",
            Some(ErrorKind::Cancelled) => "cancelled",
        };
        Said {
            json,
            text: texts.join("\n"),
            blame: blame.into(),
            stopped: first.and_then(|of| of.data.get("t")).and_then(Value::as_f64),
            code: first.map(|of| of.code.as_str().into()),
        }
    }

    /// The same of one.
    pub fn of_one(diagnostic: Diagnostic, sources: &Sources) -> Said {
        Said::of(&diagnostic.into(), sources)
    }

    /// What it takes to have it again.
    pub fn packed(&self) -> Packed {
        let code = self.code.as_deref().map(str::to_owned);
        (self.json.clone(), self.text.clone(), self.blame.to_string(), self.stopped, code)
    }

    /// It once more, as it was packed.
    pub fn again((json, text, blame, stopped, code): Packed) -> Said {
        Said { json, text, blame: blame.into(), stopped, code: code.map(Cow::Owned) }
    }

    /// Whether nothing is said.
    pub fn is_empty(&self) -> bool {
        self.json.is_empty()
    }

    /// The exception that tells it.
    pub fn raised(&self, py: Python<'_>) -> PyErr {
        static RAISED: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        let made = RAISED.import(py, "mechc.errors", "_raised").and_then(|raised| {
            raised.call1((self.list(py)?, &self.text, &*self.blame, self.code.as_deref().unwrap_or_default()))
        });
        match made {
            Ok(exception) => PyErr::from_value(exception),
            Err(why) => why,
        }
    }

    /// Tells what is not wrong, but worth knowing, as a warning.
    pub fn warned(&self, py: Python<'_>) -> PyResult<()> {
        if self.is_empty() {
            return Ok(());
        }
        static WARNED: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
        WARNED.import(py, "mechc.errors", "_warned")?.call1((self.list(py)?, &self.text))?;
        Ok(())
    }

    /// The diagnostics as lines of JSON.
    pub fn list<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        PyList::new(py, &self.json)
    }
}
