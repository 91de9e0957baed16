//! Sweeps: many variants of a mechanism as an Arrow stream, computed while it is read.

use crate::errors::Report;
use crate::files::FilesWithTables;
use crate::interrupts::interruptible;
use crate::mechanism::Stages;
use crate::memory::{self, Computation};
use crate::run::RunRequest;
use crate::stream;
use crate::sweep::reader::{Reader, SharedReader, Source};
use crate::table::{Header, Kind, Table, schema};
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

/// The options of a sweep, in addition to those of a run.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct SweepRequest {
    /// The axes of variation, in order.
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

/// An axis of variation: a param, or a table of several.
#[derive(FromPyObject)]
enum Axis {
    /// The text of the command's option: `NAME=A..B:N`, `NAME=A,B,C`, `@FILE.csv`.
    Option(String),
    /// A table of variants as CSV, with its name in messages.
    Table(PathBuf, Vec<u8>),
}

/// Number of variants that a thread computes at once.
const VARIANTS_PER_THREAD: u64 = 16;

/// By status, the number of variants and the first of them.
pub type Summary = BTreeMap<&'static str, (u64, u64)>;

/// A sweep; each reader computes it anew.
#[pyclass(frozen, module = "mechc._mechc")]
pub struct Sweep {
    plan: Arc<SweepPlan>,
    /// The statuses of the variants of the newest stream.
    summary: Mutex<Arc<Mutex<Summary>>>,
}

/// The compiled mechanism, variants, options and columns of a sweep.
pub struct SweepPlan {
    pub checked: Checked,
    pub compiled: Compiled,
    pub variants: Variants,
    pub options: SweepOptions,
    pub headers: Vec<Header>,
    pub schema: SchemaRef,
    /// The units of the columns of rows; `None` for a table of results.
    pub units: Option<Vec<ColumnUnit>>,
    /// True if the sweep ends behind the first variant that meets a condition.
    pub has_until: bool,
    /// The first variant, and the one behind the last.
    pub range: [u64; 2],
    /// Largest number of rows of a variant.
    rows: u64,
}

impl SweepPlan {
    fn new(
        stages: &Stages,
        request: &RunRequest,
        variation: &SweepRequest,
        cancel: &Cancel,
    ) -> Result<(SweepPlan, Report), Report> {
        let world = FilesWithTables::new(&stages.files, variation.tables());
        let choice = Choice { lead: true, until: variation.until.clone(), ..request.choice(stages) };
        let redundant = request.redundant(stages);
        let ((checked, compiled), report) = stages.compile(&choice, &world, redundant, cancel)?;
        let variants = checked.variants(&variation.vary_options(), &choice, &world)?;
        let compiled = checked.widest(&variants, redundant).unwrap_or(compiled);
        let mut sources = variants.sources().clone();
        let ends = [&request.from, &request.to, &request.every];
        let times = RequestedTimes::from_options(ends, &request.at, &mut sources)?;
        let rows = times.over(compiled.analysis()).and_then(|times| times.times())?.len();
        let selected = if variation.rows { Some(compiled.select_columns(&request.columns)?) } else { None };
        let (headers, units) = headers(&compiled, &variants, selected.as_deref());
        let run = request.options(cancel);
        let options = SweepOptions {
            times,
            columns: selected,
            redundant,
            tolerance: run.tolerance,
            pass_bifurcations: run.pass_bifurcations,
            jobs: variation.jobs,
            digits: false,
            skip: variation.skip,
            take: variation.take,
            vectors: run.vectors,
            cancel: Cancel::default(),
        };
        let count = variants.points().count();
        let first = variation.skip.min(count);
        let range = [first, variation.take.map_or(count, |take| first.saturating_add(take).min(count))];
        let (schema, has_until) = (schema(&headers), variation.until.is_some());
        let rows = if units.is_some() { rows } else { 1 };
        Ok((SweepPlan { checked, compiled, variants, options, headers, schema, units, has_until, range, rows }, report))
    }

    /// Refuses a sweep if the rows of the variants that all threads compute at once do not fit into memory.
    pub fn refuse_beyond(&self, py: Python<'_>) -> PyResult<()> {
        let threads = self.options.jobs.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
        let columns = self.units.as_ref().map_or(0, Vec::len);
        let rows = self.rows.saturating_mul(2 * VARIANTS_PER_THREAD).saturating_mul(threads.max(1) as u64);
        memory::refuse_beyond(py, (rows, columns), Computation::Block)
    }

    /// Returns the largest number of rows, and the number of columns.
    pub fn size(&self) -> (u64, usize) {
        let [first, last] = self.range;
        ((last - first).saturating_mul(self.rows), self.headers.len())
    }
}

impl SweepRequest {
    fn tables(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let table_of = |axis: &Axis| match axis {
            Axis::Table(name, table) => Some((name.clone(), table.clone())),
            Axis::Option(_) => None,
        };
        self.vary.iter().filter_map(table_of).collect()
    }

    fn vary_options(&self) -> VaryOptions {
        let option = |axis: &Axis| match axis {
            Axis::Option(option) => option.clone(),
            Axis::Table(name, _) => format!("@{}", name.to_string_lossy()),
        };
        let params = self.vary.iter().map(option).collect();
        let method = self.method.as_deref().map(|name| if name == "random" { Method::Random } else { Method::Sobol });
        VaryOptions { params, sample: self.samples, method, seed: self.seed }
    }
}

/// Returns the columns of a sweep, and the units of those of rows among them.
fn headers(
    compiled: &Compiled,
    variants: &Variants,
    selected: Option<&[usize]>,
) -> (Vec<Header>, Option<Vec<ColumnUnit>>) {
    let header = |name: &str, unit: &str, kind| Header { name: name.to_owned(), unit: unit.to_owned(), kind };
    let mut headers = vec![header("variant", "", Kind::Integers)];
    let params = variants.points().params().iter().zip(variants.units());
    headers.extend(params.map(|(name, unit)| header(name, unit, Kind::Numbers)));
    let Some(selected) = selected else {
        headers.extend(compiled.variant_results().iter().map(|(name, unit)| header(name, unit, Kind::Numbers)));
        headers.push(header("status", "", Kind::Words));
        headers.push(header("stopped", "s", Kind::Numbers));
        return (headers, None);
    };
    let (names, all) = (compiled.columns(), compiled.units());
    let units: Vec<ColumnUnit> = selected.iter().map(|&k| all[k].clone()).collect();
    headers.extend(selected.iter().map(|&k| header(&names[k], &all[k].text, Kind::Numbers)));
    (headers, Some(units))
}

impl Sweep {
    /// Prepares a sweep of a mechanism, and issues its warnings.
    pub fn new(py: Python<'_>, stages: Arc<Stages>, request: RunRequest, variation: SweepRequest) -> PyResult<Sweep> {
        let made = interruptible(py, move |cancel| SweepPlan::new(&stages, &request, &variation, cancel))?;
        let (plan, report) = made.map_err(|report| report.to_exception(py))?;
        report.warn(py)?;
        Ok(Sweep { plan: Arc::new(plan), summary: Mutex::default() })
    }

    fn reader(&self, py: Python<'_>, progress: Option<Py<PyAny>>) -> PyResult<Reader> {
        self.plan.refuse_beyond(py)?;
        // an older stream keeps its own summary, which is no longer shown
        let summary = Arc::default();
        *self.summary.lock().unwrap_or_else(PoisonError::into_inner) = Arc::clone(&summary);
        Ok(Reader::new(Source { plan: Arc::clone(&self.plan), summary }, progress))
    }
}

#[pymethods]
impl Sweep {
    #[getter]
    fn names(&self) -> Vec<&str> {
        self.plan.headers.iter().map(|header| header.name.as_str()).collect()
    }

    #[getter]
    fn units(&self) -> Vec<&str> {
        self.plan.headers.iter().map(|header| header.unit.as_str()).collect()
    }

    /// Returns the number of variants that are computed.
    #[getter]
    fn taken(&self) -> u64 {
        let [first, last] = self.plan.range;
        last - first
    }

    /// Returns the number of computed variants, at most the largest value of `len`.
    fn __len__(&self) -> usize {
        usize::try_from(self.taken()).unwrap_or(usize::MAX)
    }

    /// Returns the largest number of rows of a variant.
    #[getter]
    fn rows_of_a_variant(&self) -> u64 {
        self.plan.rows
    }

    /// Returns the number of all variants, whatever `skip` and `take`.
    #[getter]
    fn count(&self) -> u64 {
        self.plan.variants.points().count()
    }

    /// Returns by status the number of variants of the newest stream, and the first of them.
    #[getter]
    fn summary(&self) -> Summary {
        let summary = Arc::clone(&self.summary.lock().unwrap_or_else(PoisonError::into_inner));
        summary.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Returns the settings of a variant's params, as `set` takes them.
    fn settings(&self, variant: u64) -> PyResult<Vec<String>> {
        let count = self.plan.variants.points().count();
        if variant >= count {
            let message = format!("there are {count} variants, and no variant {variant}");
            return Err(pyo3::exceptions::PyIndexError::new_err(message));
        }
        Ok(self.plan.variants.settings(variant))
    }

    /// Computes the whole sweep as a table.
    #[pyo3(signature = (progress = None))]
    fn _table(&self, py: Python<'_>, progress: Option<Py<PyAny>>) -> PyResult<Table> {
        let mut reader = self.reader(py, progress)?;
        let columns = reader.all(py)?;
        Ok(Table::new(self.plan.headers.clone(), columns))
    }

    #[pyo3(signature = (progress = None))]
    fn _stream<'py>(&self, py: Python<'py>, progress: Option<Py<PyAny>>) -> PyResult<Bound<'py, PyCapsule>> {
        stream::capsule(py, Box::new(SharedReader::new(self.reader(py, progress)?)))
    }

    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        stream::schema_capsule(py, &self.plan.schema)
    }
}
