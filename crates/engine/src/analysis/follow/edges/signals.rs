//! Signals: between the ends of a step a driver may move more than the ends show, as by a pulse that is shorter than the step. Its right
//! side is enclosed over the step by intervals; where that reaches beyond the values at the ends the step is examined within.

use crate::analysis::follow::step::Step;
use crate::analysis::state::{Fault, Kinematics, SignalBounds, State};
use mechc_expr::math::Halving;

/// Smallest part that is examined, as a part of the step.
const FINEST: f64 = 1e-6;
/// Maximum number of parts.
const MOST_PARTS: usize = 100;
/// The signals of a motion, with their values at the ends of a part.
pub(super) struct Signals {
    bounds: SignalBounds,
    left: Vec<f64>,
    right: Vec<f64>,
}

impl Signals {
    /// Returns the signals, with bounds from their effect on the equations of a state.
    pub fn new(kinematics: &mut Kinematics, state: &State) -> Signals {
        let bounds = SignalBounds::new(kinematics, state);
        let n = bounds.all.len();
        Signals { bounds, left: vec![0.0; n], right: vec![0.0; n] }
    }

    /// Looks for what signals do between the ends of a step of length `h`, whose curve must have been drawn.
    pub fn look(&mut self, kinematics: &mut Kinematics, step: &mut Step, h: f64) -> Result<(), Fault> {
        if self.bounds.all.is_empty() {
            return Ok(());
        }
        let from = step.t();
        let mut parts = Halving::<32>::new([0.0, 1.0], FINEST, MOST_PARTS);
        kinematics.set_time(from);
        kinematics.read_signals(&self.bounds.all, &mut self.left);
        while let Some(part @ [a, b]) = parts.next_part() {
            kinematics.set_time(from + b * h);
            kinematics.read_signals(&self.bounds.all, &mut self.right);
            if self.may_leave_ends(kinematics, [from + a * h, from + b * h]) {
                holds_within(kinematics, step, h, 0.5 * (a + b))?;
                if parts.halve(part) {
                    continue;
                }
            }
            std::mem::swap(&mut self.left, &mut self.right);
        }
        Ok(())
    }

    /// Returns whether a signal may leave the values that it has at the ends of a part (s).
    fn may_leave_ends(&mut self, kinematics: &Kinematics, times: [f64; 2]) -> bool {
        let Signals { bounds, left, right } = self;
        kinematics.enclose(&mut bounds.enclosure, times);
        let leaves = |k: usize| {
            let range = bounds.enclosure.range(bounds.all[k].register);
            bounds.may_leave_ends(k, range, [left[k], right[k]])
        };
        (0..bounds.all.len()).any(leaves)
    }
}

/// Returns whether the equations hold nearly at a place of the curve, given as a part of the step.
fn holds_within(kinematics: &mut Kinematics, step: &mut Step, h: f64, x: f64) -> Result<(), Fault> {
    step.correction_at(kinematics, h, x)?;
    match kinematics.broken_check() {
        Some(index) => Err(Fault::Check { index }),
        None => Ok(()),
    }
}
