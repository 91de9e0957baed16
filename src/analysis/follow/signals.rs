//! Between the ends of a step a driver may ask for more than the ends show: a pulse that is shorter than the step. Its right
//! side is enclosed over the step by intervals; where that reaches beyond the values at the ends the step is looked into.

use super::march::Motion;
use crate::analysis::state::{Fault, Kinematics, State};
use crate::program::{Enclosure, Signal};
use crate::tolerances::steps::signals::{FINEST, MOST_PARTS, NUDGE, UNSEEN};

/// What time alone decides about the equations, and what is known of it.
pub struct Signals {
    all: Vec<Signal>,
    enclosure: Enclosure,
    /// By how much each may leave the values at the ends of a part unseen.
    bounds: Vec<f64>,
    /// Values at the ends of a part.
    left: Vec<f64>,
    right: Vec<f64>,
}

impl Signals {
    /// With what the signals do to the equations of a state.
    pub fn new(kinematics: &mut Kinematics, state: &State) -> Signals {
        let all = kinematics.signals();
        kinematics.restore(state);
        // what follows without iteration has no branches: there only a formula may end
        let unseen = if kinematics.linear().is_explicit() { f64::MAX } else { UNSEEN };
        let bounds: Vec<f64> =
            kinematics.effects(&all, &state.q, NUDGE).iter().map(|effect| (unseen / effect).min(f64::MAX)).collect();
        let enclosure = kinematics.enclosure_of(&all);
        let n = all.len();
        Signals { all, enclosure, bounds, left: vec![0.0; n], right: vec![0.0; n] }
    }
}

impl Motion {
    /// Looks for what signals do between the ends of a step of length `h`, whose curve must have been drawn.
    pub fn look_at_signals(&mut self, h: f64) -> Result<(), Fault> {
        if self.signals.all.is_empty() {
            return Ok(());
        }
        let from = self.state.t;
        let mut open = [[0.0; 2]; 32];
        let (mut count, mut looked_at) = (1, 0);
        open[0] = [0.0, 1.0];
        self.kinematics.set_time(from);
        self.kinematics.read_signals(&self.signals.all, &mut self.signals.left);
        while count > 0 {
            count -= 1;
            looked_at += 1;
            let part @ [a, b] = open[count];
            self.kinematics.set_time(from + b * h);
            self.kinematics.read_signals(&self.signals.all, &mut self.signals.right);
            if !self.may_leave_ends(h, part) {
                std::mem::swap(&mut self.signals.left, &mut self.signals.right);
                continue;
            }
            let middle = 0.5 * (a + b);
            self.holds_within(h, middle)?;
            if b - a > FINEST && looked_at < MOST_PARTS && count + 2 <= open.len() {
                open[count] = [middle, b];
                open[count + 1] = [a, middle];
                count += 2;
            } else {
                std::mem::swap(&mut self.signals.left, &mut self.signals.right);
            }
        }
        Ok(())
    }

    /// Whether a signal may leave the values that it has at the ends of a part.
    fn may_leave_ends(&mut self, h: f64, [a, b]: [f64; 2]) -> bool {
        let Signals { all, enclosure, bounds, left, right } = &mut self.signals;
        self.kinematics.enclose(enclosure, [self.state.t + a * h, self.state.t + b * h]);
        (0..all.len()).any(|k| {
            let [low, high] = enclosure.range(all[k].register);
            let beyond = f64::max(high - f64::max(left[k], right[k]), f64::min(left[k], right[k]) - low);
            beyond.is_nan() || beyond > bounds[k]
        })
    }

    /// Whether the equations hold nearly at a place of the curve, given as a part of the step.
    fn holds_within(&mut self, h: f64, x: f64) -> Result<(), Fault> {
        self.correction_at(h, x)?;
        match self.kinematics.broken_check() {
            Some(index) => Err(Fault::Check { index }),
            None => Ok(()),
        }
    }
}
