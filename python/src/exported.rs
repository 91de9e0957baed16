//! A mechanism as Rust, LaTeX, JSON, a page, a picture.

use crate::errors::Said;
use crate::mechanism::Stages;
use crate::run::Asked;
use crate::waiting::interruptible;
use mechc::{AskedTimes, Cancel, MARK, RustOptions, page, picture};
use pyo3::prelude::*;

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
            ..RustOptions::of(file_name(stages))
        }
    }

    /// A module.
    pub fn module(&self, py: Python<'_>, stages: &Stages) -> PyResult<String> {
        let options = self.options(stages);
        let (text, said) = interruptible(py, |_| stages.compiled.rust(&options))?;
        told(py, stages, text, Said::of(&said, stages.compiled.sources()))
    }

    /// A crate of a name.
    pub fn package(&self, py: Python<'_>, stages: &Stages, name: &str) -> PyResult<Crate> {
        let options = self.options(stages);
        let (files, said) = interruptible(py, |_| stages.compiled.package(name, &options))?;
        let files = told(py, stages, files, Said::of(&said, stages.compiled.sources()))?;
        Ok((files.into_iter().map(|file| (file.path, file.text)).collect(), MARK))
    }
}

/// What was made; what is said of it is a warning, or why it was not made.
fn told<T>(py: Python<'_>, _: &Stages, made: Option<T>, said: Said) -> PyResult<T> {
    match made {
        Some(made) => said.warned(py).map(|()| made),
        None => Err(said.raised(py)),
    }
}

/// The equations typeset.
pub fn latex(py: Python<'_>, stages: &Stages) -> PyResult<String> {
    has_no_variations(py, stages)?;
    interruptible(py, |_| stages.compiled.latex(&file_name(stages)))
}

/// The constraint system as data.
pub fn json(py: Python<'_>, stages: &Stages) -> PyResult<String> {
    has_no_variations(py, stages)?;
    interruptible(py, |_| stages.compiled.json(&file_name(stages)))
}

fn has_no_variations(py: Python<'_>, stages: &Stages) -> PyResult<()> {
    let compiled = &stages.compiled;
    compiled.has_no_variations().map_err(|why| Said::of_one(*why, compiled.sources()).raised(py))
}

fn file_name(stages: &Stages) -> String {
    stages.path.file_name().map_or("-".into(), |name| name.to_string_lossy()).into_owned()
}

/// A page that moves, and a picture that does so without a script.
pub fn seen(py: Python<'_>, stages: &Stages, asked: &Asked, most: Option<usize>) -> PyResult<(String, String)> {
    let made = interruptible(py, |cancel| both(stages, asked, most.unwrap_or(MOST_ROWS), cancel))?;
    made.map_err(|said| said.raised(py))
}

fn both(stages: &Stages, asked: &Asked, most: usize, cancel: &Cancel) -> Result<(String, String), Said> {
    let choice = mechc::Choice { pictures_forces: true, ..asked.choice(stages) };
    let ((checked, compiled), _) = stages.with(&choice, &*stages.files, asked.redundant(stages), cancel)?;
    let mut sources = compiled.sources().clone();
    let times = AskedTimes::of([&asked.from, &asked.to, &asked.every], &asked.at, &mut sources)
        .and_then(|asked| Ok(asked.over(compiled.analysis()).map_err(|why| *why)?.whole().map_err(|why| *why)?))
        .map_err(|why| Said::of(&why, &sources))?;
    let (seen, said) = checked.seen(&compiled, &times, &asked.options(cancel), most);
    let seen = seen.ok_or_else(|| Said::of(&said, &sources))?;
    Ok((page(&seen, &sources), picture(&seen)))
}
