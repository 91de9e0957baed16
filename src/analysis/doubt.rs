//! A row whose derivatives are in doubt, so near to a singular position that rounding may have spoiled them: held against the way
//! over that position, or against itself.

use super::GOLDEN;
use super::kinematics::State;
use super::march::Motion;
use crate::tolerances::solving::doubt::{CELL, NEAREST_BRANCH, PLACES, RIGHT};
use crate::tolerances::solving::rows::STEPS_AHEAD;
use crate::tolerances::steps::march::FEWEST_STEPS_NEAR;

use super::trust::{Trust, are_small};
use crate::diag::Diagnostic;
use crate::layout::RowLayout;

/// The range of no values.
const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

impl Motion {
    /// How far the motion is looked ahead from a time `t` (s): a singular position that a row is so near to that its derivatives
    /// are in doubt may be twice as far off as the last clear state.
    pub(super) fn time_ahead(&self, t: f64) -> f64 {
        let usual = self.span / FEWEST_STEPS_NEAR;
        t + if self.trust == Trust::Doubtful { usual.max(2.0 * (t - self.clear.t)) } else { usual }
    }

    /// A row of a time `t` whose derivatives are in doubt. If it lies on the way up to a bifurcation that way shows whether they
    /// are right, and what they are if not. The motion is left as it was, so that the rows behind it are the same.
    pub(super) fn row_in_doubt(&mut self, t: f64) -> Result<(), Box<Diagnostic>> {
        let (row, here, probe) = (self.row.clone(), self.bookmark(), self.probe);
        let said = (self.remarks.clone(), self.warned.clone());
        let kept = std::mem::replace(&mut self.bridge, self.spare_bridge.take());
        let mut on_bridge = self.row_on_bridge(t);
        let mut why = None;
        if on_bridge.is_none() && t >= self.clear_ahead {
            why = self.step_ahead(t);
            on_bridge = self.row_on_bridge(t);
        }
        self.spare_bridge = std::mem::replace(&mut self.bridge, kept);
        let better = on_bridge.is_some().then(|| self.row.clone());
        self.go_back(&here);
        (self.probe, self.fold, (self.remarks, self.warned)) = (probe, None, said);
        if better.is_none() && !self.stands_up(&here.state) {
            return Err(self.explain_refused(t, why));
        }
        self.row = row;
        self.refine(t);
        self.kinematics.restore(&self.state);
        if let Some(better) = better.filter(|better| !self.agrees(better)) {
            self.row = better;
        }
        Ok(())
    }

    /// Steps from a row of a time `t` on until the motion is clear again, or cannot go on; gives why.
    fn step_ahead(&mut self, t: f64) -> Option<Box<Diagnostic>> {
        let ahead = self.time_ahead(t);
        for _ in 0..STEPS_AHEAD {
            if let Err(why) = self.step_towards(ahead) {
                return Some(why);
            }
            // a step that failed leaves the factors of where it failed
            self.kinematics.restore(&self.state);
            if self.state.t > t && self.is_clear() {
                self.clear_ahead = self.state.t;
                break;
            }
            if self.state.t >= ahead {
                break;
            }
        }
        None
    }

    /// Whether the row is right, beside one that is.
    fn agrees(&self, other: &[f64]) -> bool {
        let [_, first, second, _] = RowLayout::new(self.kinematics.system()).coordinates;
        let right =
            |column: usize| RIGHT[usize::from(column >= first as usize) + usize::from(column >= second as usize)];
        // a measure may have no value
        let is_near = |(column, (a, b)): (usize, (&f64, &f64))| {
            !a.is_finite() || self.kinematics.is_varied(column) || (a - b).abs() <= right(column) * (1.0 + b.abs())
        };
        self.row.iter().zip(other).enumerate().all(is_near)
    }

    /// Whether a row that has been found is certain, be it that it was in doubt.
    pub(super) fn is_certain(&mut self, state: &State) -> bool {
        self.trust.is_certain() || (self.trust == Trust::Doubtful && self.stands_up(state))
    }

    /// Whether velocities and accelerations of a state stay what they are where its position is solved for again, from places
    /// beside it: then rounding does not add up as it might. These places lie about a point of a grid, whichever way led to the
    /// state.
    pub(super) fn stands_up(&mut self, state: &State) -> bool {
        let n = state.q.len();
        let mut ranges = [vec![NOTHING; n], vec![NOTHING; n]];
        let is_solved = (0..PLACES).all(|place| {
            self.solve_beside(state, place) && {
                for (range, values) in ranges.iter_mut().zip([&self.trial.qd, &self.trial.qdd]) {
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

    /// The row of a time on a bridge, or else the same solved for, be it as near to the singular position as it likes, if it can
    /// be trusted.
    pub(super) fn or_trusted(&mut self, t: f64, row: Result<(), Box<Diagnostic>>) -> Result<(), Box<Diagnostic>> {
        row.or_else(|why| if self.trusted_row(t) || self.narrow_row(t) { Ok(()) } else { Err(why) })
    }

    fn trusted_row(&mut self, t: f64) -> bool {
        let Some(state) = self.bridge.as_ref().map(|bridge| bridge.state_at(t)) else {
            return false;
        };
        self.trial.copy_from(&state);
        let Ok(correction) = self.correct() else {
            return false;
        };
        // another branch may not be far
        let is_near = correction <= NEAREST_BRANCH * self.kinematics.nearness(1.0);
        if !is_near || self.kinematics.derivatives(&mut self.trial).is_err() {
            return false;
        }
        let solved = self.trial.clone();
        let is_trusted = match Trust::of(&mut self.kinematics, &solved) {
            Trust::Certain => true,
            Trust::Doubtful => self.stands_up(&solved),
            Trust::Uncertain => false,
        };
        if is_trusted {
            self.kinematics.restore(&solved);
            self.kinematics.write_given_row(&solved, &mut self.row);
        }
        is_trusted
    }

    /// Solves for a state once more, from one of the places beside it.
    fn solve_beside(&mut self, state: &State, place: usize) -> bool {
        let n = state.q.len();
        self.trial.t = state.t;
        for k in 0..n {
            let cell = CELL * self.kinematics.linear().column_scale(k);
            let aside = (GOLDEN * (place * n + k + 1) as f64).fract() - 0.5;
            self.trial.q[k] = ((state.q[k] / cell).round() + aside) * cell;
        }
        self.correct().is_ok() && self.kinematics.derivatives(&mut self.trial).is_ok()
    }
}
