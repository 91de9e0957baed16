//! Sweeps: many variants of one mechanism, each continued from the nominal mechanism along its branch. Blocks of variants are computed on
//! several threads and delivered in order.

mod spec;
mod topology_groups;

pub(crate) use topology_groups::TopologyGroup;

pub use spec::{Variants, VaryOptions};

use crate::batch::{BatchLanes, BatchPlan, Requested};
use crate::continuation::Outcome;
use crate::param_table::{Binder, Bindings};
use crate::{Checked, Compiled, Redundant, RequestedTimes, RunOptions, Vectors};
use mechc_engine::analysis::{Answers, ResultQuery, Started, Stop, Times};
use mechc_engine::sweep::{BatchRunner, BufferPool, CHUNK, LANES, Status, Swept, VariantOutcome};
use mechc_ir::ConstraintSystem;
use mechc_lang::check::UNTIL;
use mechc_parallel::{ParallelMap, default_jobs};
use mechc_text::cancel::Cancel;
use mechc_text::diag::{Code, Diagnostic, Diagnostics, Error};
use std::ops::Range;
use std::sync::{Arc, OnceLock};
use topology_groups::{OutputMapping, OutputNames, TopologyGroups};

/// Target size of a block in numbers: half a megabyte, which fits into the cache of a core.
const NUMBERS: u64 = 1 << 16;
/// The fixed work for each column of a block costs as much as this many rows; wide blocks may therefore hold up to 4 MB.
const ROWS: u64 = 1 << 14;
const NUMBERS_OF_MANY_COLUMNS: u64 = 1 << 19;
/// Upper bounds of the variants of a block, so that the first results come soon; with all rows, a variant has less fixed work.
const MAX_VARIANTS: u64 = 256;
const MAX_VARIANTS_WITH_ROWS: u64 = 512;
/// A sweep has at least this many blocks if it can, so that each of many threads gets some.
const MIN_BLOCKS: u64 = 32;
/// The rows of one variant are in memory until it is done: at most 2 GiB.
const MAX_NUMBERS_OF_VARIANT: u64 = 1 << 28;
/// Blocks whose memory a thread keeps: the receiver reads one while the next is computed.
const SPARE_BLOCKS: usize = 2;
/// All lanes are used as long as a block has at most this many numbers: 32 MB.
const MAX_NUMBERS: u64 = 1 << 22;

/// Options of a sweep.
#[derive(Clone, Debug)]
pub struct SweepOptions {
    /// The times that are requested.
    pub times: RequestedTimes,
    /// Indices of the columns whose rows are requested; `None` for results alone.
    pub columns: Option<Vec<usize>>,
    /// The treatment of redundant equations.
    pub redundant: Redundant,
    /// See [`RunOptions::tolerance`].
    pub tolerance: f64,
    /// See [`RunOptions::pass_bifurcations`].
    pub pass_bifurcations: bool,
    /// Number of threads, the one that takes the blocks included; `None` for as many as the machine runs at once.
    pub jobs: Option<usize>,
    /// True if the certain digits of results are counted; such variants are computed alone.
    pub digits: bool,
    /// Number of variants to skip.
    pub skip: u64,
    /// Number of variants to compute at most.
    pub take: Option<u64>,
    /// See [`RunOptions::vectors`].
    pub vectors: Vectors,
    /// Cancels the sweep.
    pub cancel: Cancel,
}

impl Default for SweepOptions {
    fn default() -> SweepOptions {
        let RunOptions { tolerance, pass_bifurcations, vectors, cancel, .. } = RunOptions::default();
        let (times, redundant) = (RequestedTimes::default(), Redundant::default());
        let (columns, jobs, digits, skip, take) = (None, None, false, 0, None);
        SweepOptions {
            times,
            columns,
            redundant,
            tolerance,
            pass_bifurcations,
            jobs,
            digits,
            skip,
            take,
            vectors,
            cancel,
        }
    }
}

/// The size of a variant in a block.
#[derive(Clone, Copy, Debug)]
struct VariantSize {
    /// At least 1.
    numbers: u64,
    columns: u64,
}

/// Returns the number of variants in a block of a sweep of `count` variants, at most `most`.
fn block_size(size: VariantSize, count: u64, most: u64) -> u64 {
    let lanes = LANES as u64;
    let numbers = ROWS.saturating_mul(size.columns).clamp(NUMBERS, NUMBERS_OF_MANY_COLUMNS);
    let all = (numbers / size.numbers).min(count / MIN_BLOCKS).min(most) / lanes * lanes;
    let all = all.max(lanes);
    let fewer = [all, CHUNK as u64].into_iter().find(|variants| variants * size.numbers <= MAX_NUMBERS);
    fewer.unwrap_or(1)
}

/// The variants of a sweep, in blocks.
#[derive(Clone, Copy)]
struct Blocks {
    first: u64,
    /// One past the last variant.
    end: u64,
    /// Variants of a block; the last one may have fewer.
    size: u64,
}

impl Blocks {
    /// Returns the blocks of those of `count` variants that are requested.
    fn new(options: &SweepOptions, count: u64, size: VariantSize, most: u64) -> Blocks {
        let first = options.skip.min(count);
        let end = options.take.map_or(count, |take| first.saturating_add(take).min(count));
        Blocks { first, end, size: block_size(size, end - first, most) }
    }

    fn count(&self) -> u64 {
        (self.end - self.first).div_ceil(self.size)
    }

    fn variants(&self, block: u64) -> Range<u64> {
        let begin = self.first + block * self.size;
        begin..begin.saturating_add(self.size).min(self.end)
    }
}

/// A sweep in progress: an iterator over what is made of its blocks, in the order of the variants.
pub struct Sweep<T> {
    blocks: ParallelMap<(T, Option<EndReason>)>,
    end: Option<EndReason>,
}

/// Why a sweep ends before its last variant.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum EndReason {
    /// The last variant that was computed is the one that is searched for.
    Found,
    Cancelled,
}

impl<T> Sweep<T> {
    /// Returns whether the last variant that was delivered is the one that is searched for.
    #[must_use]
    pub fn found_match(&self) -> bool {
        self.end == Some(EndReason::Found)
    }
}

impl Compiled {
    /// Returns the names of the results that a sweep tabulates, with their SI units.
    #[must_use]
    pub fn variant_results(&self) -> Vec<(String, String)> {
        let outcomes = self.system().results().outcomes.iter().filter(|outcome| outcome.name != UNTIL);
        outcomes.map(|outcome| (outcome.name.clone(), outcome.units.si.clone())).collect()
    }
}

impl Checked {
    /// Computes variants, and delivers what `make` makes of each block on the computing threads. The sweep ends after the variant that is
    /// searched for, if there is one.
    ///
    /// The mechanism must be sound, with the values of its text; `compiled` is made of it.
    ///
    /// # Errors
    /// The times are not given, or a variant would have more rows than fit into memory.
    pub fn sweep<T: Send + 'static>(
        &self,
        compiled: &Compiled,
        variants: &Variants,
        options: &SweepOptions,
        make: impl Fn(Swept) -> T + Send + Sync + 'static,
    ) -> Result<Sweep<T>, Error> {
        let times = options.times.over(compiled.analysis())?.times()?;
        let (rows, width, most) = match &options.columns {
            Some(columns) => (times.len(), columns.len() as u64, MAX_VARIANTS_WITH_ROWS),
            None => (1, compiled.results().len() as u64 + 1, MAX_VARIANTS),
        };
        let numbers = rows.saturating_mul(width);
        if numbers > MAX_NUMBERS_OF_VARIANT {
            return Err(too_many_rows(rows, width).into());
        }
        let size = VariantSize { numbers: numbers.max(1), columns: width };
        let blocks = Blocks::new(options, variants.points().count(), size, most);
        let first = blocks.first;
        let results: Vec<String> = compiled.results().into_iter().map(|(name, _)| name).collect();
        let until = results.iter().position(|name| name == UNTIL);
        let jobs = options.jobs.unwrap_or_else(default_jobs).max(1);
        let names = compiled.columns();
        let columns = options.columns.iter().flatten().map(|&column| names[column].clone()).collect();
        let result_count = results.len();
        let output_names = OutputNames { columns, results };
        let groups = TopologyGroups::new(self, variants, options.redundant, output_names, first);
        let context = SweepContext {
            checked: self.clone(),
            groups,
            variants: variants.clone(),
            binder: Binder::new(self, variants),
            options: options.clone(),
            result_count,
            until,
            first,
            plan: OnceLock::new(),
            without_until: OnceLock::new(),
        };
        let (context, make) = (Arc::new(context), Arc::new(make));
        let start = move || {
            let (mut worker, make) = (Worker::new(&context), Arc::clone(&make));
            move |block: u64| {
                let (swept, end) = worker.block(blocks.variants(block))?;
                Some((make(swept), end))
            }
        };
        Ok(Sweep { blocks: ParallelMap::new(jobs, 0..blocks.count(), start), end: None })
    }
}

impl<T: Send + 'static> Iterator for Sweep<T> {
    type Item = T;

    /// Returns what is made of the next block; `None` after the last block, and after the one with the variant that is searched for. A
    /// cancelled sweep ends with a block of the variants that were done.
    fn next(&mut self) -> Option<T> {
        let (made, end) = self.blocks.next()?;
        self.end = end;
        if end.is_some() {
            self.blocks.end();
        }
        Some(made)
    }
}

/// The data that all variants of a sweep share.
struct SweepContext {
    checked: Checked,
    groups: TopologyGroups,
    variants: Variants,
    /// Binds the params of variants.
    binder: Binder,
    options: SweepOptions,
    /// Number of results, that of the search condition included.
    result_count: usize,
    /// Index of the result that is 1 for the variant that is searched for.
    until: Option<usize>,
    /// Index of the first variant.
    first: u64,
    /// `None` inside if variants are computed alone.
    plan: OnceLock<Option<BatchPlan>>,
    /// The sweep without the search condition, made once the condition has stopped a variant.
    without_until: OnceLock<Box<SweepContext>>,
}

/// Computes blocks on one thread, in memory of its own that is used again.
struct Worker {
    context: Arc<SweepContext>,
    lanes: Option<BatchLanes>,
    /// Memory of columns that were delivered and read.
    spare: Arc<BufferPool>,
}

/// Variants that a batch has followed.
struct BatchOutput<'d> {
    runner: &'d BatchRunner,
    /// For each lane, true if the variant has all its rows, or all its results if no rows are requested.
    accepted: [bool; LANES],
    /// Rows of each variant.
    rows: usize,
    /// For each column, the rows of all variants, variant by variant; `None` if every variant is complete and its rows are in the block.
    pending: Option<Vec<Vec<f64>>>,
}

impl<'d> BatchOutput<'d> {
    /// Follows variants, given by their params.
    fn new(
        plan: &BatchPlan,
        lanes: &'d mut BatchLanes,
        block: &mut Swept,
        params: &[f64],
        context: &SweepContext,
    ) -> BatchOutput<'d> {
        let (count, rows) = (params.len() / context.width(), plan.rows());
        let before = block.columns.first().map_or(0, |column| column.len());
        let accepted = plan.follow(lanes, params, block.room(count, rows), &context.options.cancel);
        let runner = &lanes.runner;
        let is_whole = (0..count).all(|lane| accepted[lane] && context.has_all_results(runner, lane));
        BatchOutput { runner, accepted, rows, pending: (!is_whole).then(|| block.take_rows_from(before)) }
    }
}

impl Worker {
    fn new(context: &Arc<SweepContext>) -> Worker {
        Worker { context: Arc::clone(context), lanes: None, spare: Arc::new(BufferPool::new(SPARE_BLOCKS)) }
    }

    /// Computes variants up to the one that is searched for, or until it is cancelled, and says why the sweep ends there, if it does; `None`
    /// if it is cancelled before the first variant is done.
    fn block(&mut self, variants: Range<u64>) -> Option<(Swept, Option<EndReason>)> {
        let Worker { context, lanes, spare } = self;
        let (points, plan, width) = (context.variants.points(), context.plan(), context.width());
        let mut batch = plan.map(|plan| (plan, lanes.get_or_insert_with(|| plan.lanes())));
        let mut block = context.empty_block(variants.start);
        let rows = (variants.end - variants.start) as usize * plan.map_or(0, BatchPlan::rows);
        block.reserve(rows, spare);
        let mut params = vec![0.0; width * LANES];
        let mut end = None;
        for first in variants.clone().step_by(LANES) {
            let count = (variants.end - first).min(LANES as u64) as usize;
            for (number, params) in (first..variants.end).zip(params.chunks_exact_mut(width)) {
                points.values(number, params);
            }
            let params = &params[..count * width];
            let output = batch.as_mut().map(|(plan, lanes)| BatchOutput::new(plan, lanes, &mut block, params, context));
            end = context.push_all(&mut block, params, output.as_ref());
            if end.is_some() {
                break;
            }
        }
        let is_empty = end == Some(EndReason::Cancelled) && block.is_empty();
        (!is_empty).then_some((block, end))
    }
}

/// The results of a variant, and how many of their digits are certain.
struct ResultValues {
    values: Vec<f64>,
    digits: u32,
}

impl SweepContext {
    fn empty_block(&self, first: u64) -> Swept {
        let results = self.result_count - usize::from(self.until.is_some());
        let columns = self.options.columns.as_ref().map_or(0, Vec::len);
        let params = self.variants.points().params().len();
        Swept { digits: self.options.digits.then(Vec::new), ..Swept::new(first, params, results, columns) }
    }

    /// Returns the number of values of a variant, at least 1.
    fn width(&self) -> usize {
        self.variants.points().params().len().max(1)
    }

    /// Adds variants to a block, given by their params, with what a batch has computed of them; up to the one that is searched for, or until
    /// it is cancelled.
    fn push_all(&self, block: &mut Swept, params: &[f64], output: Option<&BatchOutput<'_>>) -> Option<EndReason> {
        let width = self.width();
        let count = params.len() / width;
        if let Some(output) = output.filter(|output| output.pending.is_none()) {
            block.push_batch((count, output.rows), params);
            let results = (0..count).filter_map(|lane| output.runner.results(lane));
            results.for_each(|results| block.push_batch_results(results));
            return None;
        }
        for (lane, params) in params.chunks_exact(width).enumerate() {
            if self.options.cancel.is_cancelled() {
                return Some(EndReason::Cancelled);
            }
            let before = block.len();
            let of_batch = output.filter(|output| output.accepted[lane]).map(|output| (output, lane));
            let condition = self.push_one(block, params, of_batch);
            if self.options.cancel.is_cancelled() {
                // this variant may be incomplete
                block.truncate(before);
                return Some(EndReason::Cancelled);
            }
            if condition == Some(1.0) {
                return Some(EndReason::Found);
            }
        }
        None
    }

    /// Returns whether a batch has computed all that is requested of a variant, and none is searched for.
    fn has_all_results(&self, runner: &BatchRunner, lane: usize) -> bool {
        self.result_count == 0 || self.until.is_none() && runner.results(lane).is_some()
    }

    /// Adds a variant to a block, given by its params, and the lane of a batch that has its rows. Returns the result of the search condition.
    fn push_one(&self, block: &mut Swept, params: &[f64], of_batch: Option<(&BatchOutput<'_>, usize)>) -> Option<f64> {
        let of_batch = of_batch.and_then(|(output, lane)| match output.runner.results(lane) {
            Some(results) => Some((output, lane, ResultValues { values: results.to_vec(), digits: 0 }, true)),
            None => Some((output, lane, self.results_of(params)?, false)),
        });
        let Some((output, lane, mut results, has_batch_results)) = of_batch else {
            let mut variant = self.variant(params);
            let condition = self.until.map(|until| variant.results.remove(until));
            block.push(params, &variant);
            return condition;
        };
        let condition = self.until.map(|until| results.values.remove(until));
        for (column, from) in block.columns.iter_mut().zip(output.pending.iter().flatten()) {
            column.extend(from[lane * output.rows..(lane + 1) * output.rows].iter().copied());
        }
        block.push_batch((1, output.rows), params);
        if has_batch_results {
            block.push_batch_results(&results.values);
        } else {
            block.push_results(&results.values);
            block.push_digits(results.digits);
        }
        condition
    }

    /// Computes the results of a variant that has all its rows; `None` if they need the rows again.
    fn results_of(&self, params: &[f64]) -> Option<ResultValues> {
        let options = self.run_options();
        let group = self.groups.group_of(params, &self.checked, &self.variants);
        let Bindings { values, analysis } = self.binder.bind(params).ok()?;
        let times = self.options.times.over(analysis).and_then(|times| times.times()).ok()?;
        let Outcome::Started(mut started) = group.continuation.start_values(&values, &times, &options) else {
            return None;
        };
        let query = self.result_query(&mut started, &times, &options);
        let mut results = vec![f64::NAN; self.result_count];
        let answers = query.and_then(ResultQuery::answer).unwrap_or_default();
        write_results(&answers.values, &group.outputs, &mut results);
        Some(ResultValues { values: results, digits: answers.certain_digits() })
    }

    /// Returns what results are computed from, if there are any.
    fn result_query(&self, started: &mut Started, times: &Times, options: &RunOptions) -> Option<ResultQuery> {
        // a run reports the conditioning of its start, which restores the factors there; do the same for the same bits
        let _ = started.conditioning();
        started.use_vectors(options.vectors);
        let interval = times.interval().filter(|_| self.result_count > 0);
        interval.map(|interval| started.asked(interval, options.pass_bifurcations, &options.cancel))
    }

    /// Returns the plan of batches; `None` if variants are computed alone.
    fn plan(&self) -> Option<&BatchPlan> {
        let new = || {
            let columns = self.options.columns.as_deref();
            let results = self.result_count > 0 && !self.options.digits;
            if columns.is_none() && !results {
                return None;
            }
            let requested = Requested { times: &self.options.times, columns, results };
            let options = self.run_options();
            let group = self.groups.only().filter(|_| !self.checked.has_given_inputs())?;
            let table = self.binder.table(&self.variants.values(self.first))?;
            BatchPlan::new(table, group, &requested, &options)
        };
        self.plan.get_or_init(new).as_ref()
    }

    /// Computes a variant as `run --lead --set` does. The search condition must not decide anything of it: if it stops the variant, as it
    /// may name a place that this variant lacks, the variant is computed without it, and the condition does not hold.
    fn variant(&self, params: &[f64]) -> VariantOutcome {
        let variant = self.variant_with_condition(params);
        let Some(until) = self.until.filter(|_| matches!(variant.status, Status::Stopped(_))) else { return variant };
        let without = self.without_until.get_or_init(|| Box::new(self.new_without_until(until)));
        let mut variant = without.variant_with_condition(params);
        variant.results.insert(until, f64::NAN);
        variant
    }

    /// Returns the sweep without its search condition, given by the index of its result.
    fn new_without_until(&self, until: usize) -> SweepContext {
        let checked = self.checked.without_until();
        let groups = self.groups.without_result(until, &checked, &self.variants, self.first);
        let binder = Binder::new(&checked, &self.variants);
        SweepContext {
            checked,
            groups,
            variants: self.variants.clone(),
            binder,
            options: self.options.clone(),
            result_count: self.result_count - 1,
            until: None,
            first: self.first,
            plan: OnceLock::new(),
            without_until: OnceLock::new(),
        }
    }

    fn variant_with_condition(&self, params: &[f64]) -> VariantOutcome {
        let mut variant = VariantOutcome {
            status: Status::Ok,
            stopped: f64::NAN,
            results: vec![f64::NAN; self.result_count],
            digits: 0,
            rows: Vec::new(),
        };
        if let Err(VariantStop { code, t }) = self.run(params, &mut variant) {
            variant.status = Status::Stopped(code);
            variant.stopped = t.unwrap_or(f64::NAN);
        }
        variant
    }

    fn run(&self, params: &[f64], variant: &mut VariantOutcome) -> Result<(), VariantStop> {
        let options = self.run_options();
        if self.checked.has_given_inputs() {
            return self.run_by_all_stages(params, variant);
        }
        let group = self.groups.group_of(params, &self.checked, &self.variants);
        let Bindings { values, analysis } = self.binder.bind(params)?;
        let times = self.options.times.over(analysis)?.times()?;
        match group.continuation.start_values(&values, &times, &options) {
            Outcome::Started(started) => self.follow(*started, &times, &options, &group.outputs, variant),
            Outcome::CannotStart(stop, system) => Err(VariantStop::new(&stop, system.system())),
            Outcome::Refused(diagnostics) => Err(VariantStop::of(&diagnostics)),
            Outcome::NoPath(_) => {
                variant.status = Status::Reassembled;
                self.run_by_all_stages(params, variant)
            }
        }
    }

    /// Follows a variant from the start that its continuation has reached.
    fn follow(
        &self,
        mut started: Started,
        times: &Times,
        options: &RunOptions,
        outputs: &OutputMapping,
        variant: &mut VariantOutcome,
    ) -> Result<(), VariantStop> {
        let mut query = self.result_query(&mut started, times, options);
        // if no rows are requested, it only matters whether all of them exist
        let early = query.take_if(|_| self.options.columns.is_none()).and_then(ResultQuery::answer);
        if !early.as_ref().is_some_and(|answers| answers.has_all_rows) {
            let mut motion = started.into_motion(times);
            if options.pass_bifurcations {
                motion.pass_bifurcations();
            }
            while let Some(row) = motion.next_row() {
                match row {
                    Ok(row) => self.push_row(row, outputs, variant),
                    Err(stop) => return Err(VariantStop::new(&stop, motion.system())),
                }
            }
        }
        let answers = early.or_else(|| query.and_then(ResultQuery::answer)).unwrap_or_default();
        set_results(&answers, outputs, variant);
        Ok(())
    }

    /// Checks, compiles and runs a variant anew; only the nominal mechanism that it is continued from is shared.
    fn run_by_all_stages(&self, params: &[f64], variant: &mut VariantOutcome) -> Result<(), VariantStop> {
        let options = self.run_options();
        let checked = self.checked.continued_to(self.variants.read_settings(params), self.variants.sources());
        if !checked.is_sound() {
            return Err(VariantStop::of(checked.diagnostics()));
        }
        let (compiled, diagnostics) = checked.compile(self.options.redundant, &options.cancel);
        let group = self.groups.group_of(params, &self.checked, &self.variants);
        let compiled = compiled.ok_or_else(|| VariantStop::of(&diagnostics))?;
        let compiled = compiled.with_continuation(Some(Arc::clone(&group.continuation)));
        let outputs = self.groups.outputs_of(&compiled);
        let times = self.options.times.over(compiled.analysis())?.times()?;
        let (run, report) = compiled.run_with_report(&times, &options);
        let Some(mut run) = run else {
            let t = report.stop.map(|stop| stop.t);
            return Err(VariantStop { t, ..VariantStop::of(&report.diagnostics) });
        };
        if report.stopped_path.is_some() {
            variant.status = Status::Reassembled;
        }
        while let Some(row) = run.next_row() {
            match row {
                Ok(row) => self.push_row(row, &outputs, variant),
                Err(why) => return Err(VariantStop { t: run.stopped_at(), ..VariantStop::of(&why.diagnostics) }),
            }
        }
        set_results(&run.results().unwrap_or_default(), &outputs, variant);
        Ok(())
    }

    fn run_options(&self) -> RunOptions {
        let SweepOptions { tolerance, pass_bifurcations, vectors, ref cancel, .. } = self.options;
        RunOptions { tolerance, pass_bifurcations, vectors, cancel: cancel.clone() }
    }

    fn push_row(&self, row: &[f64], outputs: &OutputMapping, variant: &mut VariantOutcome) {
        let Some(columns) = &self.options.columns else { return };
        match outputs {
            OutputMapping::Identity => variant.rows.extend(columns.iter().map(|&column| row[column])),
            OutputMapping::ByName { columns, .. } => {
                variant.rows.extend(columns.iter().map(|column| column.map_or(f64::NAN, |column| row[column])));
            }
        }
    }
}

/// Why a variant is not computed to its end.
struct VariantStop {
    code: Code,
    /// Time (s), if its motion stops.
    t: Option<f64>,
}

impl VariantStop {
    fn new(stop: &Stop, system: &ConstraintSystem) -> VariantStop {
        VariantStop { code: stop.explain(system).code, t: Some(stop.t) }
    }

    /// Returns the stop at the first error other than a path that stops. Cancelled work has no error, and its code is never shown.
    fn of(diagnostics: &Diagnostics) -> VariantStop {
        let is_cause = |diagnostic: &&Diagnostic| diagnostic.is_error() && diagnostic.code != Code::E0612;
        let code = diagnostics.iter().find(is_cause).map_or(Code::E0601, |diagnostic| diagnostic.code);
        VariantStop { code, t: None }
    }
}

impl From<Error> for VariantStop {
    fn from(error: Error) -> VariantStop {
        VariantStop::of(&error.diagnostics)
    }
}

fn set_results(answers: &Answers, outputs: &OutputMapping, variant: &mut VariantOutcome) {
    write_results(&answers.values, outputs, &mut variant.results);
    variant.digits = answers.certain_digits();
}

fn write_results(values: &[Option<f64>], outputs: &OutputMapping, results: &mut [f64]) {
    for (k, into) in results.iter_mut().enumerate() {
        let index = match outputs {
            OutputMapping::Identity => Some(k),
            OutputMapping::ByName { results, .. } => results[k],
        };
        *into = index.and_then(|index| values.get(index).copied().flatten()).unwrap_or(f64::NAN);
    }
}

fn too_many_rows(rows: u64, width: u64) -> Diagnostic {
    let message = format!("a variant would have {rows} rows of {width} numbers, more than are held at once");
    let help = "take a larger step with `--every`, or fewer columns;\n`mechc run --lead --set …` writes the rows of one variant as they come";
    Diagnostic::new(Code::E0706, message).help(help)
}

#[cfg(test)]
mod tests {
    use super::{LANES, MAX_NUMBERS, MAX_VARIANTS, MAX_VARIANTS_WITH_ROWS, MIN_BLOCKS, VariantSize, block_size};

    #[test]
    fn blocks_fill_lanes_and_little_memory() {
        let all = [1, 2, 400, 9_720, 131_072, 131_073, 500_000, 600_000, 1 << 40];
        let all = all.into_iter().flat_map(|numbers| [(numbers, 1), (numbers, 40), (numbers, numbers)]);
        let counts = [0, 1, 33, 1_000, 8_000, 100_000, u64::MAX];
        let cases = all.flat_map(|size| counts.map(|count| (size, count)));
        for (((numbers, columns), count), most) in cases.zip([MAX_VARIANTS, MAX_VARIANTS_WITH_ROWS].into_iter().cycle())
        {
            let size = VariantSize { numbers, columns };
            let variants = block_size(size, count, most);
            let case = format!("{variants} of {count} with {size:?}");
            assert!(variants == 1 || variants * numbers <= MAX_NUMBERS, "{case}");
            assert!((1..=most).contains(&variants), "{case}");
            let has_full_lanes = LANES as u64 * numbers <= MAX_NUMBERS;
            assert!(!has_full_lanes || variants.is_multiple_of(LANES as u64), "{case}");
            // no thread waits while another one has all the work
            assert!(variants <= LANES as u64 || count / variants >= MIN_BLOCKS, "{case}");
        }
    }

    #[test]
    fn many_variants_with_few_numbers_make_large_blocks() {
        let size = |numbers, columns| VariantSize { numbers, columns };
        assert_eq!(block_size(size(1, 1), 1_000_000, MAX_VARIANTS), MAX_VARIANTS);
        assert_eq!(block_size(size(3, 3), 1_000_000, MAX_VARIANTS_WITH_ROWS), MAX_VARIANTS_WITH_ROWS);
        assert_eq!(block_size(size(3, 3), 3_200, MAX_VARIANTS_WITH_ROWS), 96);
    }
}
