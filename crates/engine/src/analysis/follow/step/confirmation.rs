//! Confirmation of states whose derivatives may be rounding: they are solved for once more, from places nearby.

use super::Step;
use crate::analysis::state::{Kinematics, State, Trust, are_small};
use crate::limits::solver::CELL;
use mechc_expr::math::GOLDEN;

/// Largest change of a velocity, relative to its size or 1.
const VELOCITY: f64 = 1e-8;
/// Largest change of an acceleration, relative to its size or 1.
const ACCELERATION: f64 = 1e-6;
/// Number of places from which a state is solved for again.
const PLACES: usize = 16;

impl Step {
    /// Returns whether all numbers of a state have the promised digits: it is certain, or in doubt and its velocities and accelerations stay
    /// the same when its position is solved for from several places nearby. These lie about a point of a grid, so they do not depend on how
    /// the state was reached. The state is set again.
    pub fn confirms(&mut self, kinematics: &mut Kinematics, state: &State, trust: Trust) -> bool {
        if trust != Trust::Doubtful {
            return trust.is_certain();
        }
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        let mut ranges = [vec![none; state.q.len()], vec![none; state.q.len()]];
        let is_solved = (0..PLACES).all(|place| {
            self.solve_near(kinematics, state, place) && {
                for (range, values) in ranges.iter_mut().zip([&self.trial.qd, &self.trial.qdd]) {
                    for ([low, high], value) in range.iter_mut().zip(values) {
                        (*low, *high) = (low.min(*value), high.max(*value));
                    }
                }
                true
            }
        });
        kinematics.restore(state);
        // the derivatives as they were: they exist
        let _ = kinematics.derivatives(&mut state.clone());
        let wide = ranges.map(|range| range.iter().map(|[low, high]| high - low).collect::<Vec<f64>>());
        is_solved && are_small(kinematics, state, [&wide[0], &wide[1]], [VELOCITY, ACCELERATION])
    }

    /// Solves for a state once more, from one of the places near it.
    fn solve_near(&mut self, kinematics: &mut Kinematics, state: &State, place: usize) -> bool {
        let n = state.q.len();
        let linear = kinematics.linear();
        let positions = state.q.iter().enumerate().map(|(k, q)| {
            let cell = CELL * linear.column_scale(k);
            let offset = (GOLDEN * (place * n + k + 1) as f64).fract() - 0.5;
            ((q / cell).round() + offset) * cell
        });
        self.try_position(state.t, positions);
        self.solve(kinematics).is_ok()
    }
}
