//! The way over a singular position, as curves between states on both sides of it.

use super::refined_bridge::RefinedBridge;
use super::{EXACT, SOLVABLE};
use crate::analysis::follow::step::{Step, quintic_between};
use crate::analysis::state::{Kinematics, State};
use mechc_expr::math::boundary;

/// A curve that is looked for once.
#[derive(Clone, Debug, Default)]
enum Sought {
    #[default]
    Unknown,
    Known(Option<RefinedBridge>),
}

impl Sought {
    fn curve(&self) -> Option<&RefinedBridge> {
        match self {
            Sought::Known(Some(finer)) => Some(finer),
            _ => None,
        }
    }
}

/// The way over a singular position.
#[derive(Clone, Debug)]
pub struct Bridge {
    pub from: State,
    pub to: State,
    /// When the singular position is reached (s).
    pub at: f64,
    /// When another one is, or the same again by a motion that turns back just beyond it (s).
    pub again: Option<f64>,
    /// A curve for rows that the quintic is not exact enough for.
    finer: Sought,
    /// The same for what nothing else serves, over a shorter way.
    narrow: Sought,
}

impl Bridge {
    /// A row of its own: bridges are rare.
    pub fn new(from: &State, to: &State) -> Bridge {
        let (from, to) = (from.clone(), to.clone());
        Bridge { at: from.t, from, to, again: None, finer: Sought::Unknown, narrow: Sought::Unknown }
    }

    /// How long it is (s).
    pub fn length(&self) -> f64 {
        self.to.t - self.from.t
    }

    /// The state at a time between, by the quintic with value, slope and curvature of both ends.
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
            state.qddd[k] = (derivative(3) + third_beside(h, [a.qddd[k], b.qddd[k]], c, x)) / (h * h * h);
        }
        state
    }

    /// The same by a finer curve, if one has been found.
    pub fn best_state_at(&self, t: f64) -> State {
        let finer = self.finer.curve().or(self.narrow.curve());
        finer.map_or_else(|| self.state_at(t), |finer| finer.state_at(t))
    }

    /// The same by the finer curve over all of it, if that is exact.
    pub fn finer_state_at(&mut self, kinematics: &mut Kinematics, step: &mut Step, t: f64) -> Option<State> {
        self.look_for_finer(kinematics, step);
        self.finer.curve().map(|finer| finer.state_at(t))
    }

    /// The same by a curve over its narrowest part, if only that is exact.
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
        if let Sought::Unknown = self.finer {
            self.finer = Sought::Known(RefinedBridge::between(kinematics, step, [&self.from, &self.to]));
        }
    }

    /// Looks for a curve over a shorter way, if there is none over the whole bridge that is exact: a motion that turns back beside
    /// the singular position is there for long.
    fn look_for_narrow(&mut self, kinematics: &mut Kinematics, step: &mut Step) {
        if self.finer.curve().is_none()
            && let Sought::Unknown = self.narrow
        {
            let mut narrow = [EXACT, SOLVABLE].into_iter();
            self.narrow = Sought::Known(narrow.find_map(|nearest| self.narrow_curve(kinematics, step, nearest)));
        }
    }

    /// A curve between the states that are so near to the singular position.
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

/// What the third derivative gains over that of a quintic, `c`, where it is known at both ends too: the quintic leaves only a
/// few digits of it. What is added is x³ (1 − x)³ (α + β x), which changes neither value, slope nor curvature there.
fn third_beside(h: f64, third: [f64; 2], c: [f64; 6], x: f64) -> f64 {
    let cube = h * h * h;
    let at_start = (cube * third[0] - 6.0 * c[3]) / 6.0;
    let at_end = -(cube * third[1] - 6.0 * c[3] - 24.0 * c[4] - 60.0 * c[5]) / 6.0;
    let constant = 6.0 - x * (72.0 - x * (180.0 - x * 120.0));
    let linear = x * (24.0 - x * (180.0 - x * (360.0 - x * 210.0)));
    at_start * constant + (at_end - at_start) * linear
}
