//! A curve over a long bridge that is more exact than the quintic through its ends: through two more states, one before and
//! one behind.
//!
//! What it is worth shows between the outer states and the ends of the bridge, where the motion can be solved for: it is as far
//! off there as on the bridge.

use super::bridge::Bridge;
use super::march::Motion;
use crate::analysis::state::State;
use crate::tolerances::singular::finer::{EXACT, OUTWARD, STEPS};

/// Conditions: value, slope and curvature at four times.
const CONDITIONS: usize = 12;

/// Each coordinate by Newton's polynomial over times with three conditions each.
#[derive(Clone, Debug)]
pub struct Finer {
    /// Where the bridge begins, and its length (s).
    from: f64,
    length: f64,
    coefficients: Vec<[f64; CONDITIONS]>,
}

impl Finer {
    /// Times in parts of the bridge.
    const NODES: [f64; 4] = [-OUTWARD, 0.0, 1.0, 1.0 + OUTWARD];

    /// Through four states, in their order.
    fn through(states: [&State; 4]) -> Finer {
        let (from, length) = (states[1].t, states[2].t - states[1].t);
        let coefficients = (0..states[0].q.len()).map(|k| {
            let at = |place: usize| {
                let state = states[place / 3];
                [state.q[k], length * state.qd[k], 0.5 * length * length * state.qdd[k]]
            };
            divided_differences(at)
        });
        Finer { from, length, coefficients: coefficients.collect() }
    }

    /// The state at a time (s).
    pub fn state_at(&self, t: f64) -> State {
        let x = (t - self.from) / self.length;
        let mut state = State::new(t, vec![0.0; self.coefficients.len()]);
        for (k, coefficients) in self.coefficients.iter().enumerate() {
            // Taylor's coefficients at x, by Horner's rule
            let mut taylor = [0.0; 4];
            for (place, coefficient) in coefficients.iter().enumerate().rev() {
                let way = x - Finer::NODES[place / 3];
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
                (column[place + 1] - column[place]) / (Finer::NODES[last] - Finer::NODES[first])
            };
        }
        *coefficient = column[0];
    }
    coefficients
}

impl Motion {
    /// A finer curve over a bridge, if there is one that is exact.
    pub fn finer_curve(&mut self, bridge: &Bridge) -> Option<Finer> {
        let way = OUTWARD * (bridge.to.t - bridge.from.t);
        let before = self.walk(&bridge.from, -way)?;
        let behind = self.walk(&bridge.to, way)?;
        let finer = Finer::through([&before, &bridge.from, &bridge.to, &behind]);
        let places = [0.5 * (before.t + bridge.from.t), 0.5 * (bridge.to.t + behind.t)];
        places.into_iter().all(|t| self.is_exact(&finer, t)).then_some(finer)
    }

    /// The state that a motion without edges leads to in a time from another one, either way.
    fn walk(&mut self, from: &State, way: f64) -> Option<State> {
        let mut state = from.clone();
        let h = way / STEPS as f64;
        for step in 1..=STEPS {
            self.trial.t = from.t + h * step as f64;
            for k in 0..state.q.len() {
                self.trial.q[k] = state.q[k] + h * (state.qd[k] + 0.5 * h * state.qdd[k]);
            }
            self.correct().ok()?;
            self.kinematics.derivatives(&mut self.trial).ok()?;
            state.copy_from(&self.trial);
        }
        Some(state)
    }

    /// Whether a curve has the velocities and accelerations that are solved for at a time.
    fn is_exact(&mut self, finer: &Finer, t: f64) -> bool {
        let state = finer.state_at(t);
        self.trial.copy_from(&state);
        if self.correct().is_err() || self.kinematics.derivatives(&mut self.trial).is_err() {
            return false;
        }
        let linear = self.kinematics.linear();
        let agree = |a: &[f64], b: &[f64]| {
            let off = (0..a.len()).map(|k| (a[k] - b[k]).abs() / linear.column_scale(k)).fold(0.0, f64::max);
            off <= EXACT * (1.0 + linear.largest(b))
        };
        agree(&state.q, &self.trial.q) && agree(&state.qd, &self.trial.qd) && agree(&state.qdd, &self.trial.qdd)
    }
}
