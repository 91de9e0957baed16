//! Sweeps: many variants of a mechanism as an Arrow stream, which is computed while it is read.

use crate::errors::Said;
use crate::files::WithLists;
use crate::mechanism::Stages;
use crate::memory::{self, Of};
use crate::run::Asked;
use crate::stream;
use crate::sweep::reader::{InTurns, Reader, Source};
use crate::table::{Head, Kind, Table, schema};
use crate::waiting::interruptible;
use arrow_schema::SchemaRef;
use mechc::{
    Cancel, Checked, Choice, ColumnUnit, Compiled, Method, RequestedTimes, SweepOptions, Variants, VaryOptions,
};
use pyo3::prelude::*;
use pyo3::types::PyCapsule;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

mod block;
mod reader;

/// What of a sweep goes beyond what is asked of a run.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct AskedOfSweep {
    /// What varies, in order.
    vary: Vec<Axis>,
    samples: Option<u64>,
    method: Option<String>,
    seed: Option<u64>,
    rows: bool,
    until: Option<String>,
    jobs: Option<usize>,
    skip: u64,
    take: Option<u64>,
}

/// What varies with others, or alone.
#[derive(FromPyObject)]
enum Axis {
    /// `NAME=A..B:N`, `NAME=A,B,C`, `@FILE.csv`, as the command has it.
    Written(String),
    /// A table of variants as CSV, by the name that messages have for it.
    Listed(PathBuf, Vec<u8>),
}

/// So many variants are computed side by side.
const SIDE_BY_SIDE: u64 = 16;

/// How many variants came to each end, and the first of them.
pub type Summary = BTreeMap<&'static str, (u64, u64)>;

/// A sweep that can be read, again and again.
#[pyclass(frozen, module = "mechc._mechc")]
pub struct Sweep {
    whole: Arc<Whole>,
    /// What became of the variants of the stream that was begun last.
    summary: Mutex<Arc<Mutex<Summary>>>,
}

/// All that a sweep is made of.
pub struct Whole {
    pub checked: Checked,
    pub compiled: Compiled,
    pub variants: Variants,
    pub options: SweepOptions,
    pub heads: Vec<Head>,
    pub schema: SchemaRef,
    /// The units of the columns of a run that it has; none where results alone are wanted.
    pub units: Option<Vec<ColumnUnit>>,
    /// Whether it ends behind a variant that is looked for.
    pub has_until: bool,
    /// The first variant, and the one behind the last.
    pub range: [u64; 2],
    /// How many rows a variant has at the most.
    rows: u64,
}

impl Whole {
    fn of(stages: &Stages, asked: &Asked, more: &AskedOfSweep, cancel: &Cancel) -> Result<(Whole, Said), Said> {
        let world = WithLists::new(&stages.files, more.lists());
        let choice = Choice { lead: true, until: more.until.clone(), ..asked.choice(stages) };
        let redundant = asked.redundant(stages);
        let ((checked, compiled), said) = stages.with(&choice, &world, redundant, cancel)?;
        let variants = checked.variants(&more.vary_options(), &choice, &world)?;
        let compiled = checked.widest(&variants, redundant).unwrap_or(compiled);
        let mut sources = variants.sources().clone();
        let ends = [&asked.from, &asked.to, &asked.every];
        let times = RequestedTimes::from_options(ends, &asked.at, &mut sources)?;
        let rows = times.over(compiled.analysis()).and_then(|times| times.times())?.len();
        let wanted = if more.rows { Some(compiled.select_columns(&asked.columns)?) } else { None };
        let (heads, units) = heads(&compiled, &variants, wanted.as_deref());
        let run = asked.options(cancel);
        let options = SweepOptions {
            times,
            columns: wanted,
            redundant,
            tolerance: run.tolerance,
            pass_bifurcations: run.pass_bifurcations,
            jobs: more.jobs,
            digits: false,
            skip: more.skip,
            take: more.take,
            vectors: run.vectors,
            cancel: Cancel::default(),
        };
        let count = variants.points().count();
        let first = more.skip.min(count);
        let range = [first, more.take.map_or(count, |take| first.saturating_add(take).min(count))];
        let (schema, has_until) = (schema(&heads), more.until.is_some());
        let rows = if units.is_some() { rows } else { 1 };
        Ok((Whole { checked, compiled, variants, options, heads, schema, units, has_until, range, rows }, said))
    }

    /// Refuses variants of which not even those fit into memory that are computed side by side: their rows, and those of the threads.
    pub fn refuse_beyond(&self, py: Python<'_>) -> PyResult<()> {
        let threads = self.options.jobs.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
        let columns = self.units.as_ref().map_or(0, Vec::len);
        let rows = self.rows.saturating_mul(2 * SIDE_BY_SIDE).saturating_mul(threads.max(1) as u64);
        memory::refuse_beyond(py, (rows, columns), Of::Block)
    }

    /// How many rows it has at the most, and columns.
    pub fn size(&self) -> (u64, usize) {
        let [first, last] = self.range;
        ((last - first).saturating_mul(self.rows), self.heads.len())
    }
}

impl AskedOfSweep {
    fn lists(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let listed = |axis: &Axis| match axis {
            Axis::Listed(name, table) => Some((name.clone(), table.clone())),
            Axis::Written(_) => None,
        };
        self.vary.iter().filter_map(listed).collect()
    }

    fn vary_options(&self) -> VaryOptions {
        let option = |axis: &Axis| match axis {
            Axis::Written(option) => option.clone(),
            Axis::Listed(name, _) => format!("@{}", name.to_string_lossy()),
        };
        let params = self.vary.iter().map(option).collect();
        let method = self.method.as_deref().map(|name| if name == "random" { Method::Random } else { Method::Sobol });
        VaryOptions { params, sample: self.samples, method, seed: self.seed }
    }
}

/// The columns of a sweep, and the units of those of a run among them.
fn heads(compiled: &Compiled, variants: &Variants, wanted: Option<&[usize]>) -> (Vec<Head>, Option<Vec<ColumnUnit>>) {
    let head = |name: &str, unit: &str, kind| Head { name: name.to_owned(), unit: unit.to_owned(), kind };
    let mut heads = vec![head("variant", "", Kind::Whole)];
    let params = variants.points().params().iter().zip(variants.units());
    heads.extend(params.map(|(name, unit)| head(name, unit, Kind::Numbers)));
    let Some(wanted) = wanted else {
        heads.extend(compiled.variant_results().iter().map(|(name, unit)| head(name, unit, Kind::Numbers)));
        heads.push(head("status", "", Kind::Words));
        heads.push(head("stopped", "s", Kind::Numbers));
        return (heads, None);
    };
    let (names, all) = (compiled.columns(), compiled.units());
    let units: Vec<ColumnUnit> = wanted.iter().map(|&k| all[k].clone()).collect();
    heads.extend(wanted.iter().map(|&k| head(&names[k], &all[k].text, Kind::Numbers)));
    (heads, Some(units))
}

impl Sweep {
    /// A sweep of a mechanism.
    pub fn of(py: Python<'_>, stages: Arc<Stages>, asked: Asked, more: AskedOfSweep) -> PyResult<Sweep> {
        let made = interruptible(py, move |cancel| Whole::of(&stages, &asked, &more, cancel))?;
        let (whole, said) = made.map_err(|said| said.raised(py))?;
        said.warned(py)?;
        Ok(Sweep { whole: Arc::new(whole), summary: Mutex::default() })
    }

    fn reader(&self, py: Python<'_>, progress: Option<Py<PyAny>>) -> PyResult<Reader> {
        self.whole.refuse_beyond(py)?;
        // one that is still read goes on telling what becomes of it, to nobody
        let summary = Arc::default();
        *self.summary.lock().unwrap_or_else(PoisonError::into_inner) = Arc::clone(&summary);
        Ok(Reader::new(Source { whole: Arc::clone(&self.whole), summary }, progress))
    }
}

#[pymethods]
impl Sweep {
    #[getter]
    fn names(&self) -> Vec<&str> {
        self.whole.heads.iter().map(|head| head.name.as_str()).collect()
    }

    #[getter]
    fn units(&self) -> Vec<&str> {
        self.whole.heads.iter().map(|head| head.unit.as_str()).collect()
    }

    /// How many variants it computes.
    #[getter]
    fn taken(&self) -> u64 {
        let [first, last] = self.whole.range;
        last - first
    }

    /// The same as far as Python can count by `len`.
    fn __len__(&self) -> usize {
        usize::try_from(self.taken()).unwrap_or(usize::MAX)
    }

    /// How many rows a variant has at the most.
    #[getter]
    fn rows_of_a_variant(&self) -> u64 {
        self.whole.rows
    }

    /// How many variants there are, taken or not.
    #[getter]
    fn count(&self) -> u64 {
        self.whole.variants.points().count()
    }

    /// By status: how many variants of the stream that was begun last, and the first of them.
    #[getter]
    fn summary(&self) -> Summary {
        let summary = Arc::clone(&self.summary.lock().unwrap_or_else(PoisonError::into_inner));
        summary.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// What sets the params of a variant, as `set` takes it.
    fn settings(&self, variant: u64) -> PyResult<Vec<String>> {
        let count = self.whole.variants.points().count();
        if variant >= count {
            let said = format!("there are {count} variants, and no variant {variant}");
            return Err(pyo3::exceptions::PyIndexError::new_err(said));
        }
        Ok(self.whole.variants.settings(variant))
    }

    /// All of it as a table.
    #[pyo3(signature = (progress = None))]
    fn _table(&self, py: Python<'_>, progress: Option<Py<PyAny>>) -> PyResult<Table> {
        let mut reader = self.reader(py, progress)?;
        let columns = reader.all(py)?;
        Ok(Table::new(self.whole.heads.clone(), columns))
    }

    #[pyo3(signature = (progress = None))]
    fn _stream<'py>(&self, py: Python<'py>, progress: Option<Py<PyAny>>) -> PyResult<Bound<'py, PyCapsule>> {
        stream::capsule(py, Box::new(InTurns::new(self.reader(py, progress)?)))
    }

    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        stream::schema_capsule(py, &self.whole.schema)
    }
}
