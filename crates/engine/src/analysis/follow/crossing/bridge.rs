//! Path over a singular position: curves between states on both sides of it.

use crate::analysis::follow::step::quintic_between;
use crate::analysis::state::State;

/// Path over a singular position.
#[derive(Clone, Debug)]
pub struct Bridge {
    pub from: State,
    pub to: State,
    /// Time at which the singular position is reached (s).
    pub at: f64,
    /// Time at which another one is reached, or the same one once more by a motion that turns back just beyond it (s).
    pub again: Option<f64>,
}

impl Bridge {
    /// Creates a bridge between two states. It clones them, since bridges are rare.
    pub fn new(from: &State, to: &State) -> Bridge {
        let (from, to) = (from.clone(), to.clone());
        Bridge { at: from.t, from, to, again: None }
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
