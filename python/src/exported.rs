//! A mechanism as Rust, LaTeX, JSON, a page, a picture.

use crate::errors::Said;
use crate::mechanism::Stages;
use crate::run::Asked;
use crate::waiting::interruptible;
use mechc::{Cancel, MARK, RequestedTimes, RustOptions, page, picture};
use pyo3::prelude::*;
use std::sync::Arc;

/// Of a longer motion a page and a picture have some rows, and the last.
const MOST_ROWS: usize = 2000;

/// What Rust code is to hold, as the options of the command are called.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct AskedOfRust {
    sensitivities: bool,
    lanes: Option<usize>,
    ffi: bool,
}

/// Files by their paths, the mark that each begins with, and what is said of them.
pub type Crate = (Vec<(String, String)>, &'static str);

impl AskedOfRust {
    fn options(&self, stages: &Stages) -> RustOptions {
        RustOptions {
            with_sensitivities: self.sensitivities,
            lanes: self.lanes,
            for_c: self.ffi,
            ..RustOptions::new(file_name(stages))
        }
    }

    /// A module.
    pub fn module(&self, py: Python<'_>, stages: Arc<Stages>) -> PyResult<String> {
        let options = self.options(&stages);
        let (text, said) = interruptible(py, move |_| {
            let (text, said) = stages.compiled.rust(&options);
            (text, Said::of(&said, stages.compiled.sources()))
        })?;
        told(py, text, said)
    }

    /// A crate of a name.
    pub fn package(&self, py: Python<'_>, stages: Arc<Stages>, name: &str) -> PyResult<Crate> {
        let (options, name) = (self.options(&stages), name.to_owned());
        let (files, said) = interruptible(py, move |_| {
            let (files, said) = stages.compiled.package(&name, &options);
            (files, Said::of(&said, stages.compiled.sources()))
        })?;
        let files = told(py, files, said)?;
        Ok((files.into_iter().map(|file| (file.path, file.text)).collect(), MARK))
    }
}

/// What was made; what is said of it is a warning, or why it was not made.
fn told<T>(py: Python<'_>, made: Option<T>, said: Said) -> PyResult<T> {
    match made {
        Some(made) => said.warned(py).map(|()| made),
        None => Err(said.raised(py)),
    }
}

/// The equations typeset.
pub fn latex(py: Python<'_>, stages: Arc<Stages>) -> PyResult<String> {
    interruptible(py, move |_| stages.compiled.latex(&file_name(&stages)))
}

/// The constraint system as data.
pub fn json(py: Python<'_>, stages: Arc<Stages>) -> PyResult<String> {
    interruptible(py, move |_| stages.compiled.json(&file_name(&stages)))
}

fn file_name(stages: &Stages) -> String {
    stages.path.file_name().map_or("-".into(), |name| name.to_string_lossy()).into_owned()
}

/// A page, a picture, and why the motion ends before its time, if it does.
pub type Shown = (String, String, Option<Py<PyAny>>);

/// A page that moves, and a picture that does so without a script.
pub fn seen(py: Python<'_>, stages: Arc<Stages>, asked: Asked, most: Option<usize>) -> PyResult<Shown> {
    let most = most.unwrap_or(MOST_ROWS);
    let made = interruptible(py, move |cancel| Both::of(&stages, &asked, most, cancel))?;
    let Both { page, picture, stopped, said } = made.map_err(|said| said.raised(py))?;
    said.warned(py)?;
    Ok((page, picture, stopped.map(|said| said.raised(py).into_value(py).into_any())))
}

struct Both {
    page: String,
    picture: String,
    /// Why the motion ends before its time.
    stopped: Option<Said>,
    /// What is to be said beside.
    said: Said,
}

impl Both {
    /// Of the motion up to its end; of what cannot be assembled as it comes nearest to that.
    fn of(stages: &Stages, asked: &Asked, most: usize, cancel: &Cancel) -> Result<Both, Said> {
        let choice = mechc::Choice { pictures_forces: true, ..asked.choice(stages) };
        let ((checked, compiled), _) = stages.with(&choice, &*stages.files, asked.redundant(stages), cancel)?;
        let mut sources = compiled.sources().clone();
        let times = RequestedTimes::from_options([&asked.from, &asked.to, &asked.every], &asked.at, &mut sources)
            .and_then(|asked| asked.over(compiled.analysis())?.whole())?;
        let options = asked.options(cancel);
        let (seen, said) = match checked.visualize(&compiled, &times, &options, most) {
            (None, said) => (checked.static_visualization(Some(&compiled), (times.from(), &options), &said), said),
            seen => seen,
        };
        let told = Said::of(&said, &sources);
        let seen = seen.ok_or_else(|| told.clone())?;
        let (page, picture) = (page(&seen, &sources), picture(&seen));
        let why = seen.stopped.map(|why| Said::of_one(why, &sources));
        let (stopped, said) = if said.has_errors() { (Some(told), Said::default()) } else { (why, told) };
        Ok(Both { page, picture, stopped, said })
    }
}
