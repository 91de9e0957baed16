//! Runs a mechanism: the options, and all rows as a table.

use crate::errors::Report;
use crate::exit;
use crate::interrupts::interruptible;
use crate::mechanism::Stages;
use crate::memory::{self, Computation};
use crate::table::Table;
use mechc::{Cancel, Checked, Choice, ColumnUnit, Compiled, Error, Redundant, RequestedTimes, Run, RunOptions};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// The options of a run, by the names of the command's options.
#[derive(FromPyObject, Default)]
#[pyo3(from_item_all)]
pub struct RunRequest {
    pub set: Vec<String>,
    pub inputs: Vec<String>,
    pub samples: Option<PathBuf>,
    pub lead: bool,
    pub results: Vec<String>,
    pub by: Vec<String>,
    /// True if results are differentiated by `by` too.
    pub slopes: bool,
    pub reactions: bool,
    pub from: Option<String>,
    pub to: Option<String>,
    pub every: Option<String>,
    pub at: Vec<String>,
    /// Patterns of the names of columns; all columns if it is empty.
    pub columns: Vec<String>,
    pub tolerance: Option<f64>,
    pub pass_bifurcations: bool,
    pub allow_redundant: bool,
}

/// The output of a run.
struct RunOutput {
    table: Table,
    results: Vec<(String, Option<f64>, String)>,
    /// The error that stopped the motion.
    stopped: Option<Report>,
    /// True if the values that are set were not reached by continuation, and the mechanism was assembled from the estimates.
    is_reassembled: bool,
    /// The warnings.
    report: Vec<Report>,
}

/// Status of a run that was assembled from the estimates because the continuation failed, and the code of that warning.
const REASSEMBLED: &str = "reassembled";
const NOT_REACHED: &str = "E0612";

/// An error before the first row.
enum RunError {
    Report(Report),
    /// Rows and columns that do not fit into memory.
    Memory(u64, usize),
    Exception(PyErr),
}

impl From<Report> for RunError {
    fn from(report: Report) -> RunError {
        RunError::Report(report)
    }
}

impl RunRequest {
    /// Returns the options of the check, added to those of the mechanism.
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

    /// Returns whether the mechanism is run as it was compiled.
    fn is_plain(&self) -> bool {
        let RunRequest { set, inputs, samples, lead, results, by, reactions, allow_redundant, .. } = self;
        let are_empty = [set, inputs, results, by].iter().all(|list| list.is_empty());
        are_empty && samples.is_none() && ![*lead, *reactions, *allow_redundant].contains(&true)
    }

    /// Returns the mechanism, compiled anew if the options require it, with its warnings.
    pub fn stages(&self, stages: &Stages, cancel: &Cancel) -> Result<((Checked, Compiled), Report), Report> {
        if self.is_plain() {
            return Ok(((stages.checked.clone(), stages.compiled.clone()), Report::default()));
        }
        stages.compile(&self.choice(stages), &*stages.files, self.redundant(stages), cancel)
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

    /// Runs the mechanism. Returns a dictionary of `table`, `results`, `status`, `stopped` and `error`.
    pub fn run(self, py: Python<'_>, stages: Arc<Stages>) -> PyResult<Py<PyDict>> {
        let output = interruptible(py, move |cancel| self.compute(&stages, cancel))?.map_err(|why| match why {
            RunError::Report(report) => report.to_exception(py),
            RunError::Memory(rows, columns) => memory::too_large(py, (rows, columns), Computation::Run),
            RunError::Exception(why) => why,
        })?;
        let dict = PyDict::new(py);
        dict.set_item("table", Bound::new(py, output.table)?)?;
        dict.set_item("results", output.results)?;
        let status = if output.is_reassembled { REASSEMBLED } else { "ok" };
        dict.set_item("status", output.stopped.as_ref().and_then(|report| report.code.as_deref()).unwrap_or(status))?;
        dict.set_item("stopped", output.stopped.as_ref().and_then(|report| report.stopped))?;
        dict.set_item("error", output.stopped.as_ref().map(|report| report.to_exception(py).into_value(py)))?;
        for report in output.report {
            report.warn(py)?;
        }
        Ok(dict.unbind())
    }

    fn compute(&self, stages: &Stages, cancel: &Cancel) -> Result<RunOutput, RunError> {
        let ((_, compiled), report) = self.stages(stages, cancel)?;
        let mut sources = compiled.sources().clone();
        let ends = [&self.from, &self.to, &self.every];
        let times = RequestedTimes::from_options(ends, &self.at, &mut sources)
            .and_then(|request| request.over(compiled.analysis())?.times());
        let (times, selected) =
            (times.map_err(Report::from)?, compiled.select_columns(&self.columns).map_err(Report::from)?);
        let (run, more) = compiled.run(&times, &self.options(cancel));
        let Some(run) = run else { return Err(Report::new(&more, &sources).into()) };
        let mut report = vec![report];
        let is_reassembled = more.iter().any(|of| of.code.as_str() == NOT_REACHED);
        report.push(Report::new(&more, &sources));
        let mut rows = Rows::new(&run, selected)?;
        let mut run = run;
        let stopped = rows.read_all(&mut run).map(Report::from);
        let answers = run.results().unwrap_or_default();
        let mut remarks = run.take_warnings();
        remarks.extend(answers.notes);
        report.push(Report::new(&remarks, &sources));
        let si = compiled.variant_results().into_iter();
        let results = si.zip(answers.values).map(|((name, unit), value)| (name, value, unit)).collect();
        Ok(RunOutput { table: rows.table(), results, stopped, is_reassembled, report })
    }
}

/// The rows of a run by columns, in the units of these.
struct Rows {
    names: Vec<String>,
    units: Vec<ColumnUnit>,
    selected: Vec<usize>,
    columns: Vec<Vec<f64>>,
}

impl Rows {
    fn new(run: &Run, selected: Vec<usize>) -> Result<Rows, RunError> {
        let names = selected.iter().filter_map(|&k| run.columns().get(k).cloned()).collect();
        let units = selected.iter().filter_map(|&k| run.units().get(k).cloned()).collect();
        let size = (run.times().len(), selected.len());
        let fits = |py: Python<'_>| memory::refuse_beyond(py, size, Computation::Run);
        // the lock is not taken once the interpreter exits: the waiting thread may be the one that exits
        let fits = if exit::has_begun() { None } else { Python::try_attach(fits) };
        fits.unwrap_or(Ok(())).map_err(RunError::Exception)?;
        let beyond = || RunError::Memory(size.0, size.1);
        let rows = usize::try_from(size.0).map_err(|_| beyond())?;
        let mut columns = vec![Vec::new(); selected.len()];
        for column in &mut columns {
            column.try_reserve_exact(rows).map_err(|_| beyond())?;
        }
        Ok(Rows { names, units, selected, columns })
    }

    /// Reads all rows. Returns the error if the motion stops early.
    fn read_all(&mut self, run: &mut Run) -> Option<Error> {
        while let Some(row) = run.next_row() {
            match row {
                Ok(row) => {
                    let places = self.columns.iter_mut().zip(&self.units).zip(&self.selected);
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
