//! A row for each output time: which one comes next, its contents, and its accuracy.

mod force_monitor;
mod missing_values;
mod row_batch;
mod single_row;
mod spacing_monitor;

use super::checkpoint::Checkpoint;
use super::edges::Edge;
use super::warnings::Warnings;
use crate::analysis::state::{Kinematics, State, Times, Trust, shortly_after};
use crate::limits::step_control::{CRUMB, MOST_STEPS};
pub use force_monitor::ForceMonitor;
use missing_values::MissingValues;
pub use row_batch::{RowBatch, state_of_row};
pub use single_row::SingleRow;
pub use spacing_monitor::SpacingMonitor;

/// Location of a row.
#[derive(Clone, Copy)]
pub enum Place {
    /// The row that was solved for on its own.
    Single,
    /// A lane of the batch.
    Lane(usize),
}

/// Output times from the next one on.
#[derive(Clone, Copy)]
pub struct Upcoming<'t> {
    pub times: &'t Times,
    /// Number of the next one.
    pub next: u64,
}

/// The output times, and the rows that are ready.
pub struct Rows {
    times: Times,
    /// Number of the next output time.
    next: u64,
    /// True if the motion could not go on.
    has_stopped: bool,
    /// Steps since the last row.
    steps: u64,
    /// Up to this time (s) steps go to each output time on their own.
    careful_until: f64,
    /// True if a step may go over several output times.
    may_step_densely: bool,
    /// Solver for the rows of such a step.
    batch: Option<RowBatch>,
    /// Row that was found last on its own, and how far it can be trusted.
    row: Vec<f64>,
    trust: Trust,
    /// True if it is near a position that may be a bifurcation to pass.
    is_near: bool,
    /// The last row on a bridge which was found without it.
    plain: Option<Checkpoint>,
    missing: MissingValues,
}

impl Rows {
    /// Returns the rows for some times; `batch` solves for several of them at once.
    pub fn new(kinematics: &Kinematics, batch: Option<RowBatch>, times: Times) -> Rows {
        Rows {
            times,
            next: 0,
            has_stopped: false,
            steps: 0,
            careful_until: f64::NEG_INFINITY,
            // equations that were left out are checked at every row
            may_step_densely: kinematics.system().checks().is_empty(),
            batch,
            row: vec![0.0; kinematics.row_length()],
            trust: Trust::Certain,
            is_near: false,
            plain: None,
            missing: MissingValues::new(kinematics.system()),
        }
    }

    /// Returns the next output time (s); `None` behind the last one, and where the motion could not go on.
    pub fn next_time(&self) -> Option<f64> {
        (!self.has_stopped && self.next < self.times.len()).then(|| self.upcoming())
    }

    /// Returns the time of the row that was handed out last (s).
    pub fn last_time(&self) -> Option<f64> {
        self.next.checked_sub(1).map(|number| self.times.at(number))
    }

    /// Returns the next output time (s), even if that is behind the last one.
    pub fn upcoming(&self) -> f64 {
        self.times.at(self.next)
    }

    /// Returns the first output time behind a time, or the next one, if that is earlier (s).
    pub fn upcoming_after(&self, t: f64) -> f64 {
        self.times.at(self.times.first_after(t, 0).min(self.next))
    }

    /// Records that the motion could not go on.
    pub fn stop(&mut self) {
        self.has_stopped = true;
    }

    /// Records that the next row has been handed out.
    pub fn count_row(&mut self) {
        self.next += 1;
        self.forget_steps();
    }

    /// Returns the next row if it has been solved for and needs no warning; it counts as handed out then.
    pub fn hand_out_ready(&mut self) -> Option<Place> {
        let lane = self.batch.as_ref()?.ready_lane(self.next)?;
        self.count_row();
        Some(Place::Lane(lane))
    }

    /// Begins to count the steps anew.
    pub fn forget_steps(&mut self) {
        self.steps = 0;
    }

    /// Counts a step; returns whether there are too many.
    pub fn count_step(&mut self) -> bool {
        self.steps += 1;
        self.steps > MOST_STEPS
    }

    /// Returns whether a step from a time (s) may go over several output times.
    pub fn may_step_densely(&self, t: f64) -> bool {
        self.batch.is_some() && self.may_step_densely && t >= self.careful_until
    }

    /// Makes steps go to each output time on their own up to a time (s).
    pub fn single_step_until(&mut self, t: f64) {
        self.careful_until = t;
    }

    /// Returns the end (s) of a dense step of length `h` from a time: an output time, if the step comes so far.
    pub fn target(&self, from: f64, h: f64) -> f64 {
        let (upcoming, farthest) = (self.upcoming(), from + h);
        let behind = self.times.first_after(farthest, self.next);
        // a step must change the time
        let farthest = if farthest > from { farthest } else { upcoming };
        if h >= CRUMB * (upcoming - from) { self.times.at(behind.saturating_sub(1).max(self.next)) } else { farthest }
    }

    /// Returns an edge ahead of a time (s), moved to an output time if it is within rounding of it.
    pub fn at_output(&self, edge: Edge, from: f64) -> Edge {
        let behind = self.times.first_after(edge.t, self.next);
        let before = if behind > self.next { self.times.at(behind - 1) } else { edge.t };
        let is_at_output = before > from && shortly_after(before) >= edge.t;
        if is_at_output { edge.at(before) } else { edge }
    }

    /// Returns the batch, and the output times from the next one on.
    pub fn batch(&mut self) -> Option<(&mut RowBatch, Upcoming<'_>)> {
        let Rows { batch, times, next, .. } = self;
        batch.as_mut().map(|batch| (batch, Upcoming { times, next: *next }))
    }

    /// Replaces the solver of several rows at once.
    pub fn change_solver(&mut self, batch: Option<RowBatch>) {
        self.batch = batch;
    }

    /// Discards the rows of the last dense step.
    pub fn close_batch(&mut self) {
        self.batch.iter_mut().for_each(RowBatch::close);
    }

    /// Solves once more for the row that was found on its own (`RowBatch::refine`).
    pub fn refine(&mut self, kinematics: &mut Kinematics, here: &State, t: f64) {
        if let Some(batch) = &mut self.batch {
            batch.refine(kinematics, here, t, &mut self.row);
        }
    }

    /// Returns the row that was found on its own.
    pub fn single(&self) -> &[f64] {
        &self.row
    }

    /// Returns the row that was found on its own, to be written.
    pub fn single_mut(&mut self) -> &mut [f64] {
        &mut self.row
    }

    /// Returns whether all numbers of a row are finite.
    pub fn is_whole(&self, place: Place) -> bool {
        match (place, &self.batch) {
            // the solver has checked all columns
            (Place::Lane(lane), Some(batch)) if batch.is_whole(lane) => true,
            _ => self.row(place).iter().all(|value| value.is_finite()),
        }
    }

    /// Returns the row at a place.
    pub fn row(&self, place: Place) -> &[f64] {
        match (place, &self.batch) {
            (Place::Lane(lane), Some(batch)) => batch.row(lane),
            _ => &self.row,
        }
    }

    fn row_mut(&mut self, place: Place) -> &mut [f64] {
        match (place, &mut self.batch) {
            (Place::Lane(lane), Some(batch)) => batch.row_mut(lane),
            _ => &mut self.row,
        }
    }

    /// Takes the row of a state that was just computed; `is_near` decides whether it is near a bifurcation to pass.
    pub fn take(&mut self, kinematics: &mut Kinematics, state: &State, is_near: impl FnOnce(&mut Kinematics) -> bool) {
        self.trust = Trust::of(kinematics, state);
        self.is_near = is_near(kinematics);
        kinematics.write_row(state, &mut self.row);
    }

    /// Returns how far the row that was taken last can be trusted.
    pub fn trust(&self) -> Trust {
        self.trust
    }

    /// Returns whether that row is near a position that may be a bifurcation to pass.
    pub fn is_near(&self) -> bool {
        self.is_near
    }

    /// Keeps where a row on a bridge was found without it.
    pub fn keep_plain(&mut self, here: Option<Checkpoint>) {
        self.plain = here;
    }

    /// Takes the checkpoint of the last such row, if it is before a time (s).
    pub fn take_plain(&mut self, t: f64) -> Option<Checkpoint> {
        self.plain.take().filter(|plain| plain.state().t < t)
    }

    /// Marks the cells of a row at a time (s) that are not finite as missing. They are cells of measures, since coordinates are finite.
    pub fn leave_out_measures(&mut self, kinematics: &Kinematics, place: Place, t: f64) {
        for column in 0..self.row.len() {
            let cell = &mut self.row_mut(place)[column];
            if !cell.is_finite() {
                *cell = f64::NAN;
                self.missing.take_note(kinematics.unknown_in(column), t);
            }
        }
    }

    /// Warns of each quantity that had no value, once.
    pub fn report_missing(&mut self, warnings: &mut Warnings) {
        self.missing.report(warnings);
    }
}
