//! Path over a singular position: curves between states on both sides of it.

use super::refined_bridge::RefinedBridge;
use super::{EXACT, SOLVABLE};
use crate::analysis::follow::step::{Step, quintic_between};
use crate::analysis::state::{Kinematics, State};
use mechc_expr::math::boundary;

/// A refined curve, for which a single search is made.
#[derive(Clone, Debug, Default)]
enum Sought {
    #[default]
    Pending,
    Done(Option<RefinedBridge>),
}

impl Sought {
    fn curve(&self) -> Option<&RefinedBridge> {
        match self {
            Sought::Done(Some(finer)) => Some(finer),
            _ => None,
        }
    }
}

/// Path over a singular position.
#[derive(Clone, Debug)]
pub struct Bridge {
    pub from: State,
    pub to: State,
    /// Time at which the singular position is reached (s).
    pub at: f64,
    /// Time at which another one is reached, or the same one once more by a motion that turns back just beyond it (s).
    pub again: Option<f64>,
    /// Refined curve over the whole bridge, for rows for which the quintic is not exact enough.
    finer: Sought,
    /// Refined curve over the part nearest to the singular position, for rows that `finer` cannot give.
    narrow: Sought,
}

impl Bridge {
    /// Creates a bridge between two states. It clones them, since bridges are rare.
    pub fn new(from: &State, to: &State) -> Bridge {
        let (from, to) = (from.clone(), to.clone());
        Bridge { at: from.t, from, to, again: None, finer: Sought::Pending, narrow: Sought::Pending }
    }

    /// Returns the duration (s).
    pub fn length(&self) -> f64 {
        self.to.t - self.from.t
    }

    /// Returns the state at a time (s) between the ends, by the quintic with value, slope and curvature of both.
    pub fn state_at(&self, t: f64) -> State {
        let h = self.length();
        let x = (t - self.from.t) / h;
        let mut state = self.from.clone();
        state.t = t;
        for k in 0..state.q.len() {
            let (a, b) = (&self.from, &self.to);
            let c = quintic_between(a, b, k, h);
            let derivative = |order: usize| -> f64 {
                let factor = |j: usize| (j + 1 - order..=j).map(|i| i as f64).product::<f64>();
                (order..c.len()).rev().fold(0.0, |sum, j| sum * x + c[j] * factor(j))
            };
            state.q[k] = derivative(0);
            state.qd[k] = derivative(1) / h;
            state.qdd[k] = derivative(2) / (h * h);
            state.qddd[k] = (derivative(3) + third_gain(h, [a.qddd[k], b.qddd[k]], c, x)) / (h * h * h);
        }
        state
    }

    /// Returns the state at a time (s) by the best curve found so far, else by the quintic.
    pub fn best_state_at(&self, t: f64) -> State {
        let finer = self.finer.curve().or(self.narrow.curve());
        finer.map_or_else(|| self.state_at(t), |finer| finer.state_at(t))
    }

    /// Returns the state at a time (s) by the refined curve over the whole bridge; `None` if it is not exact.
    pub fn finer_state_at(&mut self, kinematics: &mut Kinematics, step: &mut Step, t: f64) -> Option<State> {
        self.look_for_finer(kinematics, step);
        self.finer.curve().map(|finer| finer.state_at(t))
    }

    /// Returns the state at a time (s) by the refined curve over the nearest part; `None` unless that curve alone is exact.
    pub fn narrow_state_at(&mut self, kinematics: &mut Kinematics, step: &mut Step, t: f64) -> Option<State> {
        self.look_for_narrow(kinematics, step);
        self.narrow.curve().map(|narrow| narrow.state_at(t))
    }

    /// Looks for a curve that is more exact than the quintic.
    pub fn look_for_exact(&mut self, kinematics: &mut Kinematics, step: &mut Step) {
        self.look_for_finer(kinematics, step);
        self.look_for_narrow(kinematics, step);
    }

    fn look_for_finer(&mut self, kinematics: &mut Kinematics, step: &mut Step) {
        if let Sought::Pending = self.finer {
            self.finer = Sought::Done(RefinedBridge::between(kinematics, step, [&self.from, &self.to]));
        }
    }

    /// Looks for a refined curve over the part of the bridge that is nearest to the singular position, if none over the whole bridge is
    /// exact: a motion that turns back there stays near it for a long time.
    fn look_for_narrow(&mut self, kinematics: &mut Kinematics, step: &mut Step) {
        if self.finer.curve().is_none()
            && let Sought::Pending = self.narrow
        {
            let mut narrow = [EXACT, SOLVABLE].into_iter();
            self.narrow = Sought::Done(narrow.find_map(|nearest| self.narrow_curve(kinematics, step, nearest)));
        }
    }

    /// Returns a refined curve between the two states whose nearness to the singular position is `nearest`; `None` if it is not exact.
    fn narrow_curve(&self, kinematics: &mut Kinematics, step: &mut Step, nearest: f64) -> Option<RefinedBridge> {
        let mut is_near = |t: f64| {
            kinematics.restore(&self.state_at(t));
            kinematics.nearness(nearest) < nearest
        };
        let last = self.again.unwrap_or(self.at);
        let from = boundary(self.from.t, self.at, &mut is_near);
        let to = boundary(last, self.to.t, |t| !is_near(t));
        let [from, to] = [from, to].map(|t| {
            step.try_state(&self.state_at(t));
            step.solve(kinematics).ok()?;
            Some(step.trial().clone())
        });
        RefinedBridge::between(kinematics, step, [&from?, &to?])
    }
}

/// Returns the correction to the third derivative of the quintic `c`, which has only a few digits, from its given values at both ends. It is
/// that of the polynomial x³ (1 − x)³ (α + β x), which changes neither value, slope nor curvature at the ends.
fn third_gain(h: f64, third: [f64; 2], c: [f64; 6], x: f64) -> f64 {
    let cube = h * h * h;
    let at_start = (cube * third[0] - 6.0 * c[3]) / 6.0;
    let at_end = -(cube * third[1] - 6.0 * c[3] - 24.0 * c[4] - 60.0 * c[5]) / 6.0;
    let constant = 6.0 - x * (72.0 - x * (180.0 - x * 120.0));
    let linear = x * (24.0 - x * (180.0 - x * (360.0 - x * 210.0)));
    at_start * constant + (at_end - at_start) * linear
}
