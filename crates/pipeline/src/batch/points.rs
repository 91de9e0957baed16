//! Query points of an evaluator in lanes: inputs and params differ, and the time is the same. As in a sweep (`plan.rs`), points that
//! the batch rejects are computed alone.

use crate::continuation::Continuation;
use crate::options::RunOptions;
use mechc_engine::analysis::Times;
use mechc_engine::sweep::{BatchContext, BatchRequest, BatchRunner, LANES, Numbers, PerLane, RowBuffer};
use mechc_ir::program::LaneValues;
use mechc_text::diag::Error;
use std::array::from_fn;
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

/// A query point: values of all params of the model (SI), and the times to follow.
pub(crate) struct Query {
    pub values: Vec<f64>,
    pub times: Times,
}

/// A query point, or why it cannot be evaluated.
pub(crate) type QueryResult = Result<Query, Error>;

/// A new time is worth a new batch if this many points ask for it.
const MIN_FOR_NEW_TIME: usize = LANES / 2;

/// Evaluates query points in lanes; what a time needs is cached for the last time.
pub(crate) struct BatchEvaluator {
    /// Indices of the params that may differ between points, and of the rates of inputs.
    params: Vec<u32>,
    rates: Vec<u32>,
    cache: Mutex<Option<Cache>>,
}

struct Cache {
    times: Times,
    /// `None` if points at this time have to be computed alone.
    batch: Option<Arc<BatchContext>>,
    /// Lanes that can be used again.
    idle: Vec<PointLanes>,
}

/// Query points in lanes.
pub(crate) struct PointLanes {
    batch: Arc<BatchContext>,
    runner: BatchRunner,
    params: Vec<PerLane>,
    /// For each column, a number for each point.
    columns: Vec<Numbers>,
    /// Points that the batch has not rejected.
    accepted: [bool; LANES],
}

impl BatchEvaluator {
    pub fn new(params: Vec<u32>, rates: Vec<u32>) -> BatchEvaluator {
        BatchEvaluator { params, rates, cache: Mutex::default() }
    }

    /// Evaluates the first `LANES` points, with `columns` columns each; `None` if they have to be computed alone.
    pub fn follow(
        &self,
        queries: &[QueryResult],
        continuation: &Continuation,
        columns: usize,
        options: &RunOptions,
    ) -> Option<PointLanes> {
        let first = queries.iter().flatten().next()?;
        let has_times = |query: &Query| are_equal(&query.times, &first.times);
        // lanes without a point repeat the first one
        let points: [Option<&Query>; LANES] =
            from_fn(|lane| queries.get(lane)?.as_ref().ok().filter(|query| has_times(query)));
        let count = points.iter().flatten().count();
        let mut lanes = self.lanes(&first.times, count, continuation, columns, options)?;
        lanes.params.resize(first.values.len(), LaneValues([0.0; LANES]));
        for (k, param) in lanes.params.iter_mut().enumerate() {
            param.0 = points.map(|point| point.unwrap_or(first).values[k]);
        }
        for column in &mut lanes.columns {
            column.truncate(0);
            column.make_room(queries.len().min(LANES));
        }
        let room = RowBuffer { columns: &mut lanes.columns, before: 0, rows: 1 };
        lanes.accepted = lanes.runner.follow(&lanes.params, points.map(|point| point.is_some()), room, &options.cancel);
        Some(lanes)
    }

    /// Returns lanes for `count` points at a time; `None` if few points ask for another time than the cached one.
    fn lanes(
        &self,
        times: &Times,
        count: usize,
        continuation: &Continuation,
        columns: usize,
        options: &RunOptions,
    ) -> Option<PointLanes> {
        let mut cache = self.cache()?;
        let has_other_times = |cache: &Cache| !are_equal(&cache.times, times);
        if cache.as_ref().is_none_or(has_other_times) {
            if cache.is_some() && count < MIN_FOR_NEW_TIME {
                return None;
            }
            let all: Vec<usize> = (0..columns).collect();
            let BatchEvaluator { params, rates, .. } = self;
            let wanted = BatchRequest { rows: (times, Some(&all)), results: false, params, rates };
            let batch = continuation.batch(&wanted, options).map(Arc::new);
            // the outcome of cancelled work must not be kept
            if options.cancel.is_cancelled() {
                return None;
            }
            *cache = Some(Cache { times: times.clone(), batch, idle: Vec::new() });
        }
        let cache = cache.as_mut()?;
        let batch = Arc::clone(cache.batch.as_ref()?);
        let new = || PointLanes {
            runner: BatchRunner::new(&batch),
            batch,
            params: Vec::new(),
            columns: vec![Numbers::default(); columns],
            accepted: [false; LANES],
        };
        Some(cache.idle.pop().unwrap_or_else(new))
    }

    /// Takes lanes back for later points.
    pub fn give_back(&self, lanes: PointLanes) {
        let Some(mut cache) = self.cache() else { return };
        let has_batch = |cache: &&mut Cache| cache.batch.as_ref().is_some_and(|batch| Arc::ptr_eq(batch, &lanes.batch));
        if let Some(cache) = cache.as_mut().filter(has_batch) {
            cache.idle.push(lanes);
        }
    }

    /// Returns the cache unless it is locked: after a fork the lock may never be released, and points can be computed without it.
    fn cache(&self) -> Option<MutexGuard<'_, Option<Cache>>> {
        match self.cache.try_lock() {
            Ok(cache) => Some(cache),
            Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }
}

impl PointLanes {
    /// Writes the row of a point unless the batch has rejected it; returns whether it is written.
    pub fn write_row(&self, lane: usize, row: &mut Vec<f64>) -> bool {
        if self.accepted[lane] {
            row.clear();
            row.extend(self.columns.iter().map(|column| column[lane]));
        }
        self.accepted[lane]
    }
}

/// Returns whether times of one row each are equal, bit by bit.
fn are_equal(times: &Times, others: &Times) -> bool {
    let bits = |times: &Times| (times.len(), times.from().to_bits(), times.at(0).to_bits());
    bits(times) == bits(others)
}
