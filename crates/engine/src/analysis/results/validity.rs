//! Whether numbers found near a singular position are worth as much as rows are: where a row would be refused, no result is reported.

use super::ResultQuery;
use super::curve::Estimate;
use super::interval_search::NoValueCause;
use super::reductions::FormulaReductions;
use crate::analysis::follow::{Follower, SmoothSegment};
use crate::analysis::state::Times;
use mechc_ir::ReductionKind;

/// The time intervals (s), in order, in which the motion is not clear of singular positions.
pub(super) struct SingularIntervals {
    intervals: Vec<[f64; 2]>,
    was_clear: bool,
}

impl SingularIntervals {
    /// No intervals yet.
    pub fn new() -> SingularIntervals {
        SingularIntervals { intervals: Vec::new(), was_clear: true }
    }

    /// Records a segment that the motion has just gone over.
    pub fn take_note(&mut self, segment: &SmoothSegment, motion: &Follower) {
        let is_clear = motion.was_clear_here();
        if !(is_clear && self.was_clear && segment.bridge.is_none()) {
            self.intervals.push([segment.from.t, segment.to.t]);
        }
        self.was_clear = is_clear;
    }

    /// Returns whether the motion is clear of singular positions all over.
    pub fn is_clear(&self) -> bool {
        self.intervals.is_empty()
    }

    fn holds(&self, t: f64) -> bool {
        let behind = self.intervals.partition_point(|[_, to]| *to < t);
        self.intervals.get(behind).is_some_and(|[from, _]| *from <= t)
    }

    /// Returns the ends of these intervals (s), in order.
    fn ends(&self) -> Vec<f64> {
        let mut ends = self.intervals.as_flattened().to_vec();
        ends.dedup_by(|a, b| a.total_cmp(b).is_eq());
        ends
    }
}

impl ResultQuery {
    /// Returns the estimate of a reduction, or why it has no value, if it is as reliable as the rows at its times.
    pub(super) fn certain(
        &self,
        of: &FormulaReductions,
        (kind, at): (ReductionKind, f64),
        near: &SingularIntervals,
    ) -> Result<Estimate, NoValueCause> {
        let found = of.outcome(kind, at);
        match found {
            Err(
                cause @ (NoValueCause::Missing(_)
                | NoValueCause::Nowhere(_)
                | NoValueCause::Unbounded(_)
                | NoValueCause::Uncertain(_)),
            ) => Err(cause),
            _ => self.is_certain(of, (kind, at), near).and(found),
        }
    }

    /// Checks that an estimate is as reliable as the rows at its times.
    ///
    /// # Errors
    /// Fails where a row would be refused.
    fn is_certain(
        &self,
        of: &FormulaReductions,
        (kind, at): (ReductionKind, f64),
        near: &SingularIntervals,
    ) -> Result<(), NoValueCause> {
        if near.is_clear() || !of.moves() {
            return Ok(());
        }
        let [from, to] = of.window();
        let time = match kind {
            // of places an integral is as good as they are
            ReductionKind::Mean | ReductionKind::Integral if of.holds_rates() => {
                return self.has_rows_at(near.ends().into_iter().filter(|t| from <= *t && *t <= to).collect());
            }
            ReductionKind::Mean | ReductionKind::Integral => return Ok(()),
            ReductionKind::Extreme { largest, .. } => of.time_of_extreme(largest),
            ReductionKind::First => from,
            ReductionKind::Last => to,
            ReductionKind::At(_) => at,
        };
        if near.holds(time) { self.has_rows_at(vec![time]) } else { Ok(()) }
    }

    /// Returns whether the motion has rows at some times (s), which rise.
    fn has_rows_at(&self, times: Vec<f64>) -> Result<(), NoValueCause> {
        let mut motion = self.motion(Times::listed(self.interval[0], times.clone()));
        let refused = times.into_iter().find(|_| !matches!(motion.next_row(), Some(Ok(_))));
        refused.map_or(Ok(()), |t| Err(NoValueCause::Uncertain(t)))
    }
}
