//! The validity of results near singular positions: a result is not reported if it depends on a time at which a row would be refused.

use super::curve::Estimate;
use super::interval_search::NoValueCause;
use super::reductions::FormulaReductions;
use super::{Request, ResultQuery};
use crate::analysis::follow::{Follower, SmoothSegment};
use crate::analysis::state::Times;
use mechc_ir::ReductionKind;

/// The time intervals (s), in order, in which the motion is not clear of singular positions.
pub(super) struct SingularIntervals {
    intervals: Vec<[f64; 2]>,
    /// True if the last segment ended clear of singular positions.
    was_clear: bool,
}

impl SingularIntervals {
    /// Returns an empty set of intervals.
    pub fn new() -> SingularIntervals {
        SingularIntervals { intervals: Vec::new(), was_clear: true }
    }

    /// Records the segment that the motion has followed last.
    pub fn record(&mut self, segment: &SmoothSegment, motion: &Follower) {
        let is_clear = motion.was_clear_here();
        if !(is_clear && self.was_clear && segment.bridge.is_none()) {
            self.intervals.push([segment.from.t, segment.to.t]);
        }
        self.was_clear = is_clear;
    }

    /// Returns whether the whole motion is clear of singular positions.
    pub fn is_clear(&self) -> bool {
        self.intervals.is_empty()
    }

    /// Returns whether a time (s) lies in an interval.
    fn contains(&self, t: f64) -> bool {
        let next = self.intervals.partition_point(|[_, to]| *to < t);
        self.intervals.get(next).is_some_and(|[from, _]| *from <= t)
    }

    /// Returns the ends of all intervals (s), in order.
    fn ends(&self) -> Vec<f64> {
        let mut ends = self.intervals.as_flattened().to_vec();
        ends.dedup_by(|a, b| a.total_cmp(b).is_eq());
        ends
    }
}

impl ResultQuery {
    /// Returns the estimate of a reduction if it is as reliable as the rows at its times, or why it has no value.
    pub(super) fn certain_estimate(
        &self,
        of: &FormulaReductions,
        request: &Request,
        singular: &SingularIntervals,
    ) -> Result<Estimate, NoValueCause> {
        let outcome = of.outcome(request);
        match outcome {
            Err(
                cause @ (NoValueCause::Missing(_)
                | NoValueCause::Nowhere(_)
                | NoValueCause::Unbounded(_)
                | NoValueCause::Uncertain(_)),
            ) => Err(cause),
            _ => self.check_rows(of, request, singular).and(outcome),
        }
    }

    /// Checks that an estimate is as reliable as the rows at its times.
    ///
    /// # Errors
    /// Fails if a row would be refused.
    fn check_rows(
        &self,
        of: &FormulaReductions,
        request: &Request,
        singular: &SingularIntervals,
    ) -> Result<(), NoValueCause> {
        if singular.is_clear() || !of.curve.moves() {
            return Ok(());
        }
        let [from, to] = of.window;
        let time = match request.kind {
            // integrals of positions are accurate near singular positions, those of rates may not be
            ReductionKind::Mean | ReductionKind::Integral if of.curve.holds_rates => {
                return self.check_rows_at(singular.ends().into_iter().filter(|t| from <= *t && *t <= to).collect());
            }
            ReductionKind::Mean | ReductionKind::Integral => return Ok(()),
            ReductionKind::Extreme { largest, .. } => of.time_of_extreme(largest),
            ReductionKind::First => from,
            ReductionKind::Last => to,
            ReductionKind::At(_) => request.at,
        };
        if singular.contains(time) { self.check_rows_at(vec![time]) } else { Ok(()) }
    }

    /// Checks that the motion has rows at some times (s), in ascending order.
    ///
    /// # Errors
    /// Fails at the first time without a row.
    fn check_rows_at(&self, times: Vec<f64>) -> Result<(), NoValueCause> {
        let mut motion = self.motion(Times::listed(self.interval[0], times.clone()));
        let refused = times.into_iter().find(|_| !matches!(motion.next_row(), Some(Ok(_))));
        refused.map_or(Ok(()), |t| Err(NoValueCause::Uncertain(t)))
    }
}
