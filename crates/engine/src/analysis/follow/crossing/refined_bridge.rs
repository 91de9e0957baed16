//! Refined curve over a long bridge, more exact than the quintic through its ends: it goes through two more states, one before and one behind.
//!
//! Its error shows between the outer states and the ends of the bridge, where the motion can be solved for: it is as large there as on the bridge.

use crate::analysis::follow::step::Step;
use crate::analysis::state::{Kinematics, State};

/// Distance of the outer states from the ends of the bridge, as a part of its length.
const OUTWARD: f64 = 0.7;
/// Number of steps to an outer state.
const STEPS: usize = 8;
/// Accuracy of the velocities and accelerations of the curve where they can be solved for, relative to their size or 1, scaled.
const EXACT: f64 = 2e-9;

/// Conditions: value, slope and curvature at four times.
const CONDITIONS: usize = 12;

/// Each coordinate by Newton's polynomial over times with three conditions each.
#[derive(Clone, Debug)]
pub struct RefinedBridge {
    /// Start and length of the bridge (s).
    from: f64,
    length: f64,
    coefficients: Vec<[f64; CONDITIONS]>,
}

impl RefinedBridge {
    /// Times in parts of the bridge.
    const NODES: [f64; 4] = [-OUTWARD, 0.0, 1.0, 1.0 + OUTWARD];

    /// Returns the curve through four states, in order of time.
    fn through(states: [&State; 4]) -> RefinedBridge {
        let (from, length) = (states[1].t, states[2].t - states[1].t);
        let coefficients = (0..states[0].q.len()).map(|k| {
            let at = |place: usize| {
                let state = states[place / 3];
                [state.q[k], length * state.qd[k], 0.5 * length * length * state.qdd[k]]
            };
            divided_differences(at)
        });
        RefinedBridge { from, length, coefficients: coefficients.collect() }
    }

    /// Returns the state at a time (s).
    pub fn state_at(&self, t: f64) -> State {
        let x = (t - self.from) / self.length;
        let mut state = State::new(t, vec![0.0; self.coefficients.len()]);
        for (k, coefficients) in self.coefficients.iter().enumerate() {
            // Taylor's coefficients at x, by Horner's rule
            let mut taylor = [0.0; 4];
            for (place, coefficient) in coefficients.iter().enumerate().rev() {
                let way = x - RefinedBridge::NODES[place / 3];
                for order in (1..taylor.len()).rev() {
                    taylor[order] = taylor[order] * way + taylor[order - 1];
                }
                taylor[0] = taylor[0] * way + coefficient;
            }
            let h = self.length;
            state.q[k] = taylor[0];
            state.qd[k] = taylor[1] / h;
            state.qdd[k] = 2.0 * taylor[2] / (h * h);
            state.qddd[k] = 6.0 * taylor[3] / (h * h * h);
        }
        state
    }
}

/// Newton's coefficients for value, slope and half the curvature at each node, three places a node.
fn divided_differences(at: impl Fn(usize) -> [f64; 3]) -> [f64; CONDITIONS] {
    let mut column: [f64; CONDITIONS] = std::array::from_fn(|place| at(place)[0]);
    let mut coefficients = [column[0]; CONDITIONS];
    for (order, coefficient) in coefficients.iter_mut().enumerate().skip(1) {
        for place in 0..CONDITIONS - order {
            let (first, last) = (place / 3, (place + order) / 3);
            column[place] = if first == last {
                at(place)[order]
            } else {
                (column[place + 1] - column[place]) / (RefinedBridge::NODES[last] - RefinedBridge::NODES[first])
            };
        }
        *coefficient = column[0];
    }
    coefficients
}

impl RefinedBridge {
    /// Returns a finer curve than the quintic between two states, if one is exact.
    pub fn between(kinematics: &mut Kinematics, step: &mut Step, [from, to]: [&State; 2]) -> Option<RefinedBridge> {
        let way = OUTWARD * (to.t - from.t);
        let before = walk(kinematics, step, from, -way)?;
        let behind = walk(kinematics, step, to, way)?;
        let finer = RefinedBridge::through([&before, from, to, &behind]);
        let places = [0.5 * (before.t + from.t), 0.5 * (to.t + behind.t)];
        places.into_iter().all(|t| finer.is_exact(kinematics, step, t)).then_some(finer)
    }

    /// Returns whether it has the velocities and accelerations that are solved for at a time.
    fn is_exact(&self, kinematics: &mut Kinematics, step: &mut Step, t: f64) -> bool {
        let state = self.state_at(t);
        step.try_state(&state);
        if step.solve(kinematics).is_err() {
            return false;
        }
        let (linear, solved) = (kinematics.linear(), step.trial());
        let agree = |a: &[f64], b: &[f64]| {
            let off = (0..a.len()).map(|k| (a[k] - b[k]).abs() / linear.column_scale(k)).fold(0.0, f64::max);
            off <= EXACT * (1.0 + linear.largest(b))
        };
        agree(&state.q, &solved.q) && agree(&state.qd, &solved.qd) && agree(&state.qdd, &solved.qdd)
    }
}

/// Returns the state to which a motion without edges leads from another one in a time, forward or backward.
fn walk(kinematics: &mut Kinematics, step: &mut Step, from: &State, way: f64) -> Option<State> {
    let mut state = from.clone();
    let h = way / STEPS as f64;
    for number in 1..=STEPS {
        step.predict_from(&state, h, from.t + h * number as f64);
        step.solve(kinematics).ok()?;
        state.copy_from(step.trial());
    }
    Some(state)
}
