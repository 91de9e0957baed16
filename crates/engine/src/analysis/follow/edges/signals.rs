//! Signals: between the ends of a step a driver may move more than the ends show, as by a pulse that is shorter than the step. Its right
//! side is enclosed over the step by intervals; where that reaches beyond the values at the ends the step is examined within.

use crate::analysis::follow::step::Step;
use crate::analysis::state::{Fault, Kinematics, State};
use mechc_expr::math::Halving;
use mechc_ir::program::{Enclosure, Signal};

/// Largest effect on the mechanism, scaled, by which a signal may leave its values at the ends of a part of a step.
const NEGLIGIBLE_MOTION: f64 = 0.03;
/// Smallest part that is examined, as a part of the step.
const FINEST: f64 = 1e-6;
/// Maximum number of parts.
const MOST_PARTS: usize = 100;
/// Relative change of a signal for its difference quotient.
const NUDGE: f64 = 1e-6;

/// Terms of the equations that time alone decides, with bounds on what may go unnoticed.
pub(super) struct Signals {
    all: Vec<Signal>,
    enclosure: Enclosure,
    /// Bound on how far each may leave its values at the ends of a part.
    bounds: Vec<f64>,
    /// Values at the ends of a part.
    left: Vec<f64>,
    right: Vec<f64>,
}

impl Signals {
    /// Returns the signals, with bounds from their effect on the equations of a state.
    pub fn new(kinematics: &mut Kinematics, state: &State) -> Signals {
        let all = kinematics.signals();
        kinematics.restore(state);
        // explicit equations have no branches: only a formula may end there
        let unseen = if kinematics.linear().is_explicit() { f64::MAX } else { NEGLIGIBLE_MOTION };
        let bounds: Vec<f64> =
            kinematics.effects(&all, &state.q, NUDGE).iter().map(|effect| (unseen / effect).min(f64::MAX)).collect();
        let enclosure = kinematics.enclosure_of(&all);
        let n = all.len();
        Signals { all, enclosure, bounds, left: vec![0.0; n], right: vec![0.0; n] }
    }

    /// Looks for what signals do between the ends of a step of length `h`, whose curve must have been drawn.
    pub fn look(&mut self, kinematics: &mut Kinematics, step: &mut Step, h: f64) -> Result<(), Fault> {
        if self.all.is_empty() {
            return Ok(());
        }
        let from = step.t();
        let mut parts = Halving::<32>::new([0.0, 1.0], FINEST, MOST_PARTS);
        kinematics.set_time(from);
        kinematics.read_signals(&self.all, &mut self.left);
        while let Some(part @ [a, b]) = parts.next_part() {
            kinematics.set_time(from + b * h);
            kinematics.read_signals(&self.all, &mut self.right);
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
        let Signals { all, enclosure, bounds, left, right } = self;
        kinematics.enclose(enclosure, times);
        (0..all.len()).any(|k| {
            let [low, high] = enclosure.range(all[k].register);
            let beyond = f64::max(high - f64::max(left[k], right[k]), f64::min(left[k], right[k]) - low);
            beyond.is_nan() || beyond > bounds[k]
        })
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
