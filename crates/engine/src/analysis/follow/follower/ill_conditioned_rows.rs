//! Rows whose derivatives are in doubt, so near to a singular position that rounding may have spoiled them: compared with the path over
//! that position, or with themselves.

use super::{Follower, STEPS_AHEAD};
use crate::analysis::explain::Stop;
use crate::analysis::follow::crossing::is_clear;
use crate::analysis::state::{Kinematics, State, Trust, are_small};
use crate::limits::solver::CELL;
use mechc_expr::math::GOLDEN;
use mechc_ir::layout::RowLayout;

/// Largest deviation of a row from an exact one, relative to its size or 1: in position, velocity and acceleration.
const RIGHT: [f64; 3] = [1e-9, 1e-8, 1e-6];
/// Number of starts from which a row is solved again.
const PLACES: usize = 16;
/// Largest correction of a position on a bridge, as a part of its distance from the singular position, scaled.
const NEAREST_BRANCH: f64 = 0.05;

/// The range of no values.
const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

impl Follower {
    /// Settles a row of a time `t` whose derivatives are in doubt. If it lies on the way up to a bifurcation, the bridge over that shows
    /// whether they are right, and corrects them if not. The motion is left as it was, so that the rows behind it are the same.
    pub(super) fn row_in_doubt(&mut self, t: f64) -> Result<(), Box<Stop>> {
        let (row, here, probe) = (self.rows.single().to_vec(), self.checkpoint(), self.step.probe());
        let (reported, suspended) = (self.warnings.reported(), self.crossing.suspend());
        let mut on_bridge = self.row_on_bridge(t);
        let mut why = None;
        if on_bridge.is_none() && !self.crossing.is_clear_ahead(t) {
            why = self.step_ahead(t);
            on_bridge = self.row_on_bridge(t);
        }
        self.crossing.resume(suspended);
        let better = on_bridge.is_some().then(|| self.rows.single().to_vec());
        self.go_back(&here);
        self.step.set_probe(probe);
        self.warnings.restore(reported);
        if better.is_none() && !self.is_reproducible(here.state()) {
            return Err(self.explain_refused(t, why));
        }
        self.rows.single_mut().copy_from_slice(&row);
        self.refine(t);
        self.kinematics.restore(self.step.state());
        if let Some(better) = better.filter(|better| !agree(&self.kinematics, self.rows.single(), better)) {
            self.rows.single_mut().copy_from_slice(&better);
        }
        Ok(())
    }

    /// Steps from a row of a time `t` on until the motion is clear again, or cannot go on; gives why.
    fn step_ahead(&mut self, t: f64) -> Option<Box<Stop>> {
        let ahead = self.time_ahead(t);
        for _ in 0..STEPS_AHEAD {
            if let Err(why) = self.step_towards(ahead) {
                return Some(why);
            }
            // a step that failed leaves the factors of where it failed
            self.kinematics.restore(self.step.state());
            if self.step.t() > t && is_clear(&mut self.kinematics) {
                self.crossing.take_clear_ahead(self.step.t());
                break;
            }
            if self.step.t() >= ahead {
                break;
            }
        }
        None
    }

    /// Returns whether the row of a state is certain, even if it was in doubt at first.
    pub(super) fn is_certain(&mut self, state: &State) -> bool {
        let trust = self.rows.trust();
        trust.is_certain() || (trust == Trust::Doubtful && self.is_reproducible(state))
    }

    /// Returns whether velocities and accelerations of a state stay the same when its position is solved for from several places nearby: then
    /// rounding does not add up as it might. These places lie about a point of a grid, so they do not depend on how the state was reached.
    pub(super) fn is_reproducible(&mut self, state: &State) -> bool {
        let n = state.q.len();
        let mut ranges = [vec![NOTHING; n], vec![NOTHING; n]];
        let is_solved = (0..PLACES).all(|place| {
            self.solve_near(state, place) && {
                let solved = self.step.trial();
                for (range, values) in ranges.iter_mut().zip([&solved.qd, &solved.qdd]) {
                    for ([low, high], value) in range.iter_mut().zip(values) {
                        (*low, *high) = (low.min(*value), high.max(*value));
                    }
                }
                true
            }
        });
        self.kinematics.restore(state);
        let wide = ranges.map(|range| range.iter().map(|[low, high]| high - low).collect::<Vec<f64>>());
        is_solved && are_small(&self.kinematics, state, [&wide[0], &wide[1]], [RIGHT[1], RIGHT[2]])
    }

    /// Solves for a state once more, from one of the places near it.
    fn solve_near(&mut self, state: &State, place: usize) -> bool {
        let n = state.q.len();
        let linear = self.kinematics.linear();
        let positions = state.q.iter().enumerate().map(|(k, q)| {
            let cell = CELL * linear.column_scale(k);
            let offset = (GOLDEN * (place * n + k + 1) as f64).fract() - 0.5;
            ((q / cell).round() + offset) * cell
        });
        self.step.try_position(state.t, positions);
        self.step.solve(&mut self.kinematics).is_ok()
    }

    /// Accepts the row of a time on a bridge, or else solves for it directly, however near to the singular position, if the solution can be trusted.
    pub(super) fn or_solve_directly(&mut self, t: f64, row: Result<(), Box<Stop>>) -> Result<(), Box<Stop>> {
        row.or_else(|why| if self.trusted_row(t) || self.narrow_row(t) { Ok(()) } else { Err(why) })
    }

    fn narrow_row(&mut self, t: f64) -> bool {
        let Follower { kinematics, step, crossing, rows, .. } = self;
        crossing.write_narrow_row(kinematics, step, t, rows.single_mut())
    }

    fn trusted_row(&mut self, t: f64) -> bool {
        let Follower { kinematics, step, crossing, .. } = self;
        let Some(state) = crossing.state_at(t) else {
            return false;
        };
        step.try_state(&state);
        let Ok(correction) = step.correct(kinematics) else {
            return false;
        };
        // another branch may not be far
        let is_near = correction <= NEAREST_BRANCH * kinematics.nearness(1.0);
        if !is_near || step.derive_trial(kinematics).is_err() {
            return false;
        }
        let solved = step.trial().clone();
        let is_trusted = match Trust::of(kinematics, &solved) {
            Trust::Certain => true,
            Trust::Doubtful => self.is_reproducible(&solved),
            Trust::Uncertain => false,
        };
        if is_trusted {
            self.kinematics.restore(&solved);
            self.kinematics.write_given_row(&solved, self.rows.single_mut());
        }
        is_trusted
    }
}

/// Returns whether a row agrees with another one.
fn agree(kinematics: &Kinematics, row: &[f64], other: &[f64]) -> bool {
    let layout = RowLayout::new(kinematics.system());
    let right = |column: usize| RIGHT[layout.order_of(column)];
    // a measure may have no value
    let is_near = |(column, (a, b)): (usize, (&f64, &f64))| {
        !a.is_finite() || kinematics.may_be_missing(column) || (a - b).abs() <= right(column) * (1.0 + b.abs())
    };
    row.iter().zip(other).enumerate().all(is_near)
}
