//! Runs a batch of variants: collects their rows and finds their results.

use super::context::BatchContext;
use super::result_finder::ResultFinder;
use super::row_collector::{RowBuffer, RowCollector};
use super::stepper::{BatchStepper, LaneSolver};
use super::{FEWEST_STEPS, LANES, PerLane};
use mechc_text::cancel::Cancel;
use std::sync::Arc;

/// Runs batches of variants; its memory is reused from batch to batch.
pub struct BatchRunner {
    context: Arc<BatchContext>,
    stepper: BatchStepper,
    collector: Option<RowCollector>,
    finder: Option<ResultFinder>,
}

impl BatchRunner {
    /// Creates a runner for batches that share a context.
    #[must_use]
    pub fn new(context: &Arc<BatchContext>) -> BatchRunner {
        BatchRunner {
            stepper: BatchStepper::new(context),
            collector: context.rows.as_ref().map(|rows| RowCollector::new(context, rows)),
            finder: context.queries.as_ref().map(|queries| ResultFinder::new(context, queries)),
            context: Arc::clone(context),
        }
    }

    /// Follows the motion of the `active` lanes and writes the requested rows into `buffer`. `params` holds all parameters (SI), a lane for
    /// each variant.
    ///
    /// Returns the lanes that are complete: with all their rows or, if no rows are requested, with all their results.
    pub fn follow(
        &mut self,
        params: &[PerLane],
        active: [bool; LANES],
        mut buffer: RowBuffer<'_>,
        cancel: &Cancel,
    ) -> [bool; LANES] {
        let mut done = active;
        if let (Some(rows), Some(collector)) = (&self.context.rows, &mut self.collector) {
            let (context, stepper) = (&*self.context, &mut self.stepper);
            collector.select_row(0);
            let max_step = rows.times.span() / FEWEST_STEPS;
            stepper.begin(context, params, active, max_step, &mut LaneSolver::for_rows(rows, collector));
            collector.write_cached(&mut buffer);
            for number in 0..rows.times.len() {
                collector.select_row(number);
                let t = rows.times.at(number);
                stepper.advance_to(context, t, &mut LaneSolver::for_rows(rows, collector), false, |_, _| {});
                // without active lanes the collector holds no row of this time
                if !stepper.active.contains(&true) || cancel.is_cancelled() {
                    return [false; LANES];
                }
                collector.cache_common(rows, number, &mut buffer);
                collector.write_rows(number, &mut buffer);
            }
            done = stepper.active;
        }
        if let (Some(queries), Some(finder)) = (&self.context.queries, &mut self.finder) {
            finder.find_all(&self.context, queries, &mut self.stepper, params, done, cancel);
            if self.collector.is_none() {
                done = finder.is_complete;
            }
        }
        done
    }

    /// Returns the results (SI) of the variant in a lane, or `None` if the batch did not find all of them.
    #[must_use]
    pub fn results(&self, lane: usize) -> Option<&[f64]> {
        self.finder.as_ref()?.results(lane)
    }
}
