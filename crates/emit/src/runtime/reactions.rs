//! Forces of joints and drivers. Each inner module is emitted by itself, where a mechanism needs it.

use super::{error, follow, input_path, limits, numbers, pivoting, solution, state};

pub mod forces {
    //! Forces that joints exert and drivers supply.

    use super::error::Fault;
    use super::limits::STEEP;
    use super::numbers::Numbers;
    use super::solution::{Solution, Solved};
    use super::state::{State, Timed};

    /// Equations whose operations also give the forces.
    pub trait Forced: Solved {
        /// A number for each force.
        type Forces: Numbers;

        /// Solves as [`solve`](Solved::solve) does and computes the forces.
        fn solve_with_forces(
            &self,
            guess: &Self::Tears,
            t: f64,
            sides: &Self::Sides,
            at: &mut Solution<Self>,
            forces: &mut Self::Forces,
        );

        /// Does the same by elimination with partial pivoting next to `from`, after the operations have failed with `at`.
        /// Returns a fault if blocks are too large for that.
        fn pivoted_forces(
            &self,
            _from: &Solution<Self>,
            at: &mut Solution<Self>,
            _forces: &mut Self::Forces,
        ) -> Result<(), Fault> {
            Err(at.fault())
        }
    }

    /// Returns the forces next to a solution; NaN close to a singular position. `steepness` is how much steeper the
    /// parameters make the equations than those of the file.
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

    /// Returns the forces of a state.
    pub fn forces<M: Timed + Forced>(state: &State<M>) -> M::Forces {
        forces_at(&state.model, state.at(), state.steepness)
    }
}

pub mod input_driven_forces {
    //! Forces of a mechanism with inputs.

    use super::follow::Follows;
    use super::forces::{Forced, forces, forces_at};
    use super::input_path::InputDriven;
    use super::state::State;

    /// Returns the forces of a state.
    pub fn input_driven_forces<E, M, const K: usize>(state: &State<M>) -> M::Forces
    where
        M: Follows<E, K> + Forced,
        E: InputDriven<K> + Forced<Forces = M::Forces>,
    {
        if state.is_input_driven() {
            forces_at(&state.continuation.model, state.continuation.at(), state.steepness)
        } else {
            forces(state)
        }
    }
}

pub mod pivoted_forces {
    //! Forces by elimination with partial pivoting.

    use super::error::Fault;
    use super::forces::Forced;
    use super::pivoting::{Elimination, Pivoting, solve_with_pivoting, without_signs_of_zero};
    use super::solution::Solution;

    /// Solves next to a solution, then for the multipliers, which exert the forces.
    pub fn forces_with_pivoting<M: Pivoting + Forced>(
        m: &M,
        from: &Solution<M>,
        at: &mut Solution<M>,
        forces: &mut M::Forces,
        exerted: impl Fn(&M::Q, &M::Q) -> M::Forces,
    ) -> Result<(), Fault> {
        *at = solve_with_pivoting(m, &from.q, from.t, &from.sides)?;
        let slopes = m.phi_q(&at.q, from.t, &from.sides);
        let (mut elimination, orders) = (Elimination::<M>::new(), [&at.q, &at.qd, &at.qdd]);
        let qddd = elimination.third_derivatives(m, &slopes, orders, from.t, &from.sides);
        let multipliers = elimination.multipliers(m, &slopes, [&at.q, &at.qd, &at.qdd, &qddd], from.t, &from.sides);
        *forces = without_signs_of_zero(exerted(&at.q, &multipliers));
        Ok(())
    }
}
