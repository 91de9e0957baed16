//! Signals: terms of the equations that time alone decides. Between the ends of a step they may move more than the ends show, as by a pulse
//! that is shorter than the step; intervals enclose them.

use super::{Kinematics, State};
use mechc_ir::program::{Enclosure, Register, Signal};

/// Largest effect on the mechanism, scaled, by which a signal may leave its values at the ends of a part of a step.
const NEGLIGIBLE_MOTION: f64 = 0.03;
/// Relative change of a signal for its difference quotient.
const NUDGE: f64 = 1e-6;

/// The signals of a mechanism, with bounds on the motion that may go unnoticed.
#[derive(Clone, Debug)]
pub struct SignalBounds {
    /// The signals.
    pub all: Vec<Signal>,
    /// The registers of formulas of time alone that must stay above zero.
    pub conditions: Vec<Register>,
    /// Encloses the signals and the conditions over time.
    pub enclosure: Enclosure,
    /// By signal: how far it may leave its values at the ends of a part.
    bounds: Vec<f64>,
}

impl SignalBounds {
    /// Returns the signals without conditions, with bounds from their effect on the equations of a state.
    pub fn new(kinematics: &mut Kinematics, state: &State) -> SignalBounds {
        SignalBounds::build(kinematics, state, Vec::new())
    }

    /// Returns the signals with the conditions that time alone decides.
    pub fn with_conditions(kinematics: &mut Kinematics, state: &State) -> SignalBounds {
        let conditions = kinematics.conditions_of_time();
        SignalBounds::build(kinematics, state, conditions)
    }

    fn build(kinematics: &mut Kinematics, state: &State, conditions: Vec<Register>) -> SignalBounds {
        let all = kinematics.signals();
        kinematics.restore(state);
        // explicit equations have no branches: only a formula may end there
        let unseen = if kinematics.linear().is_explicit() { f64::MAX } else { NEGLIGIBLE_MOTION };
        let bounds =
            kinematics.effects(&all, &state.q, NUDGE).iter().map(|effect| (unseen / effect).min(f64::MAX)).collect();
        let registers: Vec<Register> = all.iter().map(|signal| signal.register).chain(conditions.clone()).collect();
        SignalBounds { all, enclosure: kinematics.enclosure_of(&registers), conditions, bounds }
    }

    /// Returns whether the signal at an index, which is enclosed by `range`, may leave the values that it has at the ends by more than its
    /// bound.
    #[must_use]
    pub fn may_leave_ends(&self, index: usize, [low, high]: [f64; 2], [left, right]: [f64; 2]) -> bool {
        let beyond = f64::max(high - f64::max(left, right), f64::min(left, right) - low);
        beyond.is_nan() || beyond > self.bounds[index]
    }

    /// By signal: how far it may leave its values at the ends of a part.
    #[must_use]
    pub fn bounds(&self) -> &[f64] {
        &self.bounds
    }
}
