//! Batches: variants of a sweep, or query points of an evaluator, that the engine follows in lanes. What a batch rejects is computed alone.

mod plan;
mod points;

pub(crate) use plan::{BatchLanes, BatchPlan, Requested};
pub(crate) use points::{BatchEvaluator, Query, QueryResult};
