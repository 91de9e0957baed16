//! Variants of a sweep that share a batch: those whose params a [`ParamTable`] binds, lane by lane.

use crate::RequestedTimes;
use crate::options::RunOptions;
use crate::param_table::ParamTable;
use crate::sweep::TopologyGroup;
use mechc_engine::sweep::{BatchContext, BatchRequest, BatchRunner, LANES, PerLane, RowBuffer};
use mechc_ir::program::LaneValues;
use mechc_text::cancel::Cancel;
use std::array::from_fn;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The data that variants of a sweep share in lanes.
pub(crate) struct BatchPlan {
    batch: Arc<BatchContext>,
    table: Arc<ParamTable>,
}

/// The rows and results that a sweep computes of each variant.
pub(crate) struct Requested<'r> {
    pub times: &'r RequestedTimes,
    /// The columns of the rows, if rows are requested.
    pub columns: Option<&'r [usize]>,
    pub results: bool,
}

/// Lanes of variants, with the registers of the guards.
pub(crate) struct BatchLanes {
    pub runner: BatchRunner,
    params: Vec<PerLane>,
    registers: Vec<PerLane>,
}

impl BatchPlan {
    /// Makes the plan for variants whose params a table binds; `None` if they have to be computed alone.
    pub fn new(
        table: Arc<ParamTable>,
        group: &TopologyGroup,
        requested: &Requested<'_>,
        options: &RunOptions,
    ) -> Option<BatchPlan> {
        let times = requested.times.over(table.checked().analysis).and_then(|times| times.times()).ok()?;
        let params: BTreeSet<u32> = table.targets().flatten().map(|&at| at as u32).collect();
        let params: Vec<u32> = params.into_iter().collect();
        let rows = (&times, requested.columns);
        let wanted = BatchRequest { rows, results: requested.results, params: &params, rates: &[] };
        let batch = Arc::new(group.continuation.batch(&wanted, options)?);
        Some(BatchPlan { batch, table })
    }

    /// Returns lanes for variants to follow.
    pub fn lanes(&self) -> BatchLanes {
        let params = self.table.checked().values.iter().map(|&value| LaneValues([value; LANES])).collect();
        BatchLanes { runner: BatchRunner::new(&self.batch), params, registers: self.table.lane_registers() }
    }

    /// Returns the number of rows of each variant.
    pub fn rows(&self) -> usize {
        self.batch.rows()
    }

    /// Follows up to `LANES` variants, given by the values of the varying params, variant by variant, and writes their rows. Returns which of
    /// them have all rows, or all results if no rows are requested. Variants whose params the table does not bind are not followed.
    pub fn follow(
        &self,
        lanes: &mut BatchLanes,
        varying: &[f64],
        room: RowBuffer<'_>,
        cancel: &Cancel,
    ) -> [bool; LANES] {
        let width = self.table.targets().count();
        let count = varying.len() / width.max(1);
        for (k, targets) in self.table.targets().enumerate() {
            // lanes without a variant repeat the last one
            let values: [f64; LANES] = from_fn(|lane| varying[lane.min(count - 1) * width + k]);
            for &at in targets {
                lanes.params[at].0 = values;
            }
        }
        let eligible = self.table.admits_lanes(&mut lanes.registers, &lanes.params, varying);
        lanes.runner.follow(&lanes.params, eligible, room, cancel)
    }
}
