//! Running a mechanism: what is asked for, and all rows as a table.

use crate::errors::Said;
use crate::mechanism::Stages;
use crate::table::Table;
use crate::waiting::interruptible;
use mechc::{AskedTimes, Cancel, Checked, Choice, ColumnUnit, Compiled, Diagnostics, Redundant, Run, RunOptions};
use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

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
    /// What is to be said beside.
    said: Vec<Said>,
}

/// Why there is no run.
enum Failed {
    Said(Said),
    Memory,
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

    /// Runs it, and gives `table`, `results`, `stopped` and `messages`.
    pub fn run(&self, py: Python<'_>, stages: &Stages) -> PyResult<Py<PyDict>> {
        let ran = interruptible(py, |cancel| self.ran(stages, cancel))?.map_err(|why| match why {
            Failed::Said(said) => said.raised(py),
            Failed::Memory => {
                PyMemoryError::new_err("the rows of this run do not fit into memory; ask for fewer columns or times")
            }
        })?;
        let told = PyDict::new(py);
        told.set_item("table", Bound::new(py, ran.table)?)?;
        told.set_item("results", ran.results)?;
        told.set_item("code", ran.stopped.as_ref().and_then(|said| said.code).unwrap_or("ok"))?;
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
        let times = AskedTimes::of(ends, &self.at, &mut sources)
            .and_then(|asked| Ok(asked.over(compiled.analysis()).map_err(|why| *why)?.times().map_err(|why| *why)?));
        let times = times.map_err(|why| Said::of(&why, &sources))?;
        let wanted = compiled.chosen_columns(&self.columns).map_err(|why| Said::of_one(*why, &sources))?;
        let (run, more) = compiled.run(&times, &self.options(cancel));
        let Some(run) = run else { return Err(Said::of(&more, &sources).into()) };
        let mut said = vec![said];
        said.push(Said::of(&more, &sources));
        let mut rows = Rows::of(&run, wanted)?;
        let mut run = run;
        let stopped = rows.take_all(&mut run).map(|why| Said::of(&why, &sources));
        let answers = run.results().unwrap_or_default();
        let mut remarks = run.take_remarks();
        remarks.extend(answers.notes);
        said.push(Said::of(&remarks, &sources));
        let si = compiled.results_of_variants().into_iter();
        let results = si.zip(answers.values).map(|((name, unit), value)| (name, value, unit)).collect();
        Ok(Ran { table: rows.table(), results, stopped, said })
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
        let rows = usize::try_from(run.times().len()).map_err(|_| Failed::Memory)?;
        let mut columns = vec![Vec::new(); wanted.len()];
        for column in &mut columns {
            column.try_reserve_exact(rows).map_err(|_| Failed::Memory)?;
        }
        Ok(Rows { names, units, wanted, columns })
    }

    /// All rows up to the end, or to where the motion cannot go on, and why.
    fn take_all(&mut self, run: &mut Run) -> Option<Diagnostics> {
        while let Some(row) = run.next_row() {
            match row {
                Ok(row) => {
                    let places = self.columns.iter_mut().zip(&self.units).zip(&self.wanted);
                    for ((column, unit), &k) in places {
                        column.push(unit.printed(row[k]));
                    }
                }
                Err(why) => return Some((*why).into()),
            }
        }
        None
    }

    fn table(self) -> Table {
        let units = self.units.into_iter().map(|unit| unit.text).collect();
        Table::of_numbers(self.names, units, self.columns)
    }
}
