//! Batches: variants of a sweep, or query points of an evaluator, that the engine follows in lanes. What a batch rejects is computed alone.

mod eligibility;
mod points;

pub(crate) use eligibility::{BatchLanes, BatchPlan, Requested};
pub(crate) use points::{BatchEvaluator, Query, QueryResult};
