//! Running a mechanism: what is asked for, and all rows as a table.

use crate::ending;
use crate::errors::Said;
use crate::mechanism::Stages;
use crate::memory::{self, Of};
use crate::table::Table;
use crate::waiting::interruptible;
use mechc::{Cancel, Checked, Choice, ColumnUnit, Compiled, Error, Redundant, RequestedTimes, Run, RunOptions};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// What is asked of a run, as the options of the command are called.
#[derive(FromPyObject, Default)]
#[pyo3(from_item_all)]
pub struct Asked {
    pub set: Vec<String>,
    pub inputs: Vec<String>,
    pub samples: Option<PathBuf>,
    pub lead: bool,
    pub results: Vec<String>,
    pub by: Vec<String>,
    /// Whether results are differentiated by these too.
    pub slopes: bool,
    pub reactions: bool,
    pub from: Option<String>,
    pub to: Option<String>,
    pub every: Option<String>,
    pub at: Vec<String>,
    /// The columns that are wanted, by patterns of their names; all where there are none.
    pub columns: Vec<String>,
    pub tolerance: Option<f64>,
    pub pass_bifurcations: bool,
    pub allow_redundant: bool,
}

/// What a run gave.
struct Ran {
    table: Table,
    results: Vec<(String, Option<f64>, String)>,
    /// Why the motion stopped, if it did.
    stopped: Option<Said>,
    /// Whether no way led to what is set or told, and it was assembled from the estimates.
    is_reassembled: bool,
    /// What is to be said beside.
    said: Vec<Said>,
}

/// What a run is that was assembled from the estimates because no way led where it should, as sweeps call it; and the code that says so.
const REASSEMBLED: &str = "reassembled";
const NO_WAY: &str = "E0612";

/// Why there is no run.
enum Failed {
    Said(Said),
    /// So many rows and columns do not fit.
    Memory(u64, usize),
    Raised(PyErr),
}

impl From<Said> for Failed {
    fn from(said: Said) -> Failed {
        Failed::Said(said)
    }
}

impl Asked {
    /// What it chooses of a mechanism, beside what is chosen already.
    pub fn choice(&self, stages: &Stages) -> Choice {
        let mut set = stages.choice.set.clone();
        set.extend(self.set.iter().cloned());
        Choice {
            set,
            lead: self.lead,
            inputs: self.inputs.clone(),
            samples: self.samples.clone(),
            results: self.results.clone(),
            by: self.by.clone(),
            slopes: self.slopes.then_some([self.from.is_none(), self.to.is_none()]),
            reactions: self.reactions,
            ..stages.choice.clone()
        }
    }

    pub fn redundant(&self, stages: &Stages) -> Redundant {
        if self.allow_redundant { Redundant::LeftOut } else { stages.redundant }
    }

    /// Whether the mechanism is asked for as it stands.
    fn is_plain(&self) -> bool {
        let Asked { set, inputs, samples, lead, results, by, reactions, allow_redundant, .. } = self;
        let are_empty = [set, inputs, results, by].iter().all(|list| list.is_empty());
        are_empty && samples.is_none() && ![*lead, *reactions, *allow_redundant].contains(&true)
    }

    pub fn stages(&self, stages: &Stages, cancel: &Cancel) -> Result<((Checked, Compiled), Said), Said> {
        if self.is_plain() {
            return Ok(((stages.checked.clone(), stages.compiled.clone()), Said::default()));
        }
        stages.with(&self.choice(stages), &*stages.files, self.redundant(stages), cancel)
    }

    pub fn options(&self, cancel: &Cancel) -> RunOptions {
        let usual = RunOptions::default();
        RunOptions {
            tolerance: self.tolerance.unwrap_or(usual.tolerance),
            pass_bifurcations: self.pass_bifurcations,
            cancel: cancel.clone(),
            ..usual
        }
    }

    /// Runs it, and gives `table`, `results`, `status`, `stopped` and `error`.
    pub fn run(self, py: Python<'_>, stages: Arc<Stages>) -> PyResult<Py<PyDict>> {
        let ran = interruptible(py, move |cancel| self.ran(&stages, cancel))?.map_err(|why| match why {
            Failed::Said(said) => said.raised(py),
            Failed::Memory(rows, columns) => memory::too_large(py, (rows, columns), Of::Run),
            Failed::Raised(why) => why,
        })?;
        let told = PyDict::new(py);
        told.set_item("table", Bound::new(py, ran.table)?)?;
        told.set_item("results", ran.results)?;
        let status = if ran.is_reassembled { REASSEMBLED } else { "ok" };
        told.set_item("status", ran.stopped.as_ref().and_then(|said| said.code.as_deref()).unwrap_or(status))?;
        told.set_item("stopped", ran.stopped.as_ref().and_then(|said| said.stopped))?;
        told.set_item("error", ran.stopped.as_ref().map(|said| said.raised(py).into_value(py)))?;
        for said in ran.said {
            said.warned(py)?;
        }
        Ok(told.unbind())
    }

    fn ran(&self, stages: &Stages, cancel: &Cancel) -> Result<Ran, Failed> {
        let ((_, compiled), said) = self.stages(stages, cancel)?;
        let mut sources = compiled.sources().clone();
        let ends = [&self.from, &self.to, &self.every];
        let times = RequestedTimes::from_options(ends, &self.at, &mut sources)
            .and_then(|asked| asked.over(compiled.analysis())?.times());
        let (times, wanted) = (times.map_err(Said::from)?, compiled.select_columns(&self.columns).map_err(Said::from)?);
        let (run, more) = compiled.run(&times, &self.options(cancel));
        let Some(run) = run else { return Err(Said::of(&more, &sources).into()) };
        let mut said = vec![said];
        let is_reassembled = more.iter().any(|of| of.code.as_str() == NO_WAY);
        said.push(Said::of(&more, &sources));
        let mut rows = Rows::of(&run, wanted)?;
        let mut run = run;
        let stopped = rows.take_all(&mut run).map(Said::from);
        let answers = run.results().unwrap_or_default();
        let mut remarks = run.take_warnings();
        remarks.extend(answers.notes);
        said.push(Said::of(&remarks, &sources));
        let si = compiled.variant_results().into_iter();
        let results = si.zip(answers.values).map(|((name, unit), value)| (name, value, unit)).collect();
        Ok(Ran { table: rows.table(), results, stopped, is_reassembled, said })
    }
}

/// The rows of a run by columns, as they are printed.
struct Rows {
    names: Vec<String>,
    units: Vec<ColumnUnit>,
    wanted: Vec<usize>,
    columns: Vec<Vec<f64>>,
}

impl Rows {
    fn of(run: &Run, wanted: Vec<usize>) -> Result<Rows, Failed> {
        let names = wanted.iter().filter_map(|&k| run.columns().get(k).cloned()).collect();
        let units = wanted.iter().filter_map(|&k| run.units().get(k).cloned()).collect();
        let size = (run.times().len(), wanted.len());
        let fits = |py: Python<'_>| memory::refuse_beyond(py, size, Of::Run);
        // at the end of the interpreter nobody is asked, and who waits may be the one that ends it
        let fits = if ending::has_begun() { None } else { Python::try_attach(fits) };
        fits.unwrap_or(Ok(())).map_err(Failed::Raised)?;
        let beyond = || Failed::Memory(size.0, size.1);
        let rows = usize::try_from(size.0).map_err(|_| beyond())?;
        let mut columns = vec![Vec::new(); wanted.len()];
        for column in &mut columns {
            column.try_reserve_exact(rows).map_err(|_| beyond())?;
        }
        Ok(Rows { names, units, wanted, columns })
    }

    /// All rows up to the end, or to where the motion cannot go on, and why.
    fn take_all(&mut self, run: &mut Run) -> Option<Error> {
        while let Some(row) = run.next_row() {
            match row {
                Ok(row) => {
                    let places = self.columns.iter_mut().zip(&self.units).zip(&self.wanted);
                    for ((column, unit), &k) in places {
                        column.push(unit.printed(row[k]));
                    }
                }
                Err(why) => return Some(why),
            }
        }
        None
    }

    fn table(self) -> Table {
        let units = self.units.into_iter().map(|unit| unit.text).collect();
        Table::of_numbers(self.names, units, self.columns)
    }
}
