//! What joints exert and drivers supply.

use super::error::Fault;
use super::limits::STEEP;
use super::numbers::Numbers;
use super::solution::{Solution, Solved};
use super::state::{State, Timed};

/// Equations with the operations that give what joints exert and drivers supply too.
pub trait Forced: Solved {
    /// A number for each of them.
    type Forces: Numbers;

    /// As [`solve`](Solved::solve), with the forces.
    fn solve_with_forces(
        &self,
        guess: &Self::Tears,
        t: f64,
        sides: &Self::Sides,
        at: &mut Solution<Self>,
        forces: &mut Self::Forces,
    );

    /// The same by elimination with partial pivoting, next to where that has failed with `at`; a fault where blocks are too large for
    /// that.
    fn pivoted_forces(
        &self,
        _from: &Solution<Self>,
        at: &mut Solution<Self>,
        _forces: &mut Self::Forces,
    ) -> Result<(), Fault> {
        Err(at.fault())
    }
}

/// The forces next to a solution, where these parameters make the equations so much steeper than the file's. Close to a singular
/// position there are none.
pub fn forces_at<M: Forced>(m: &M, from: &Solution<M>, steepness: f64) -> M::Forces {
    let (mut at, mut forces) = (*from, M::Forces::ZERO);
    m.solve_with_forces(&M::tears(&from.q), from.t, &from.sides, &mut at, &mut forces);
    let is_solved = at.is_settled && at.holds;
    let is_known = is_solved || m.pivoted_forces(from, &mut at, &mut forces).is_ok();
    if !is_known || at.steepest / steepness > STEEP {
        forces.as_mut().fill(f64::NAN);
    }
    forces.as_mut().iter_mut().filter(|force| !force.is_finite()).for_each(|force| *force = f64::NAN);
    forces
}

/// The forces of a state.
pub fn forces<M: Timed + Forced>(state: &State<M>) -> M::Forces {
    forces_at(&state.model, state.at(), state.steepness)
}
