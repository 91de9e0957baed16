//! Derivatives by parameters. Each inner module is emitted by itself, where a mechanism needs it.

use super::{error, follow, input_path, numbers, pivoting, solution, state};

pub mod sensitivity {
    //! The derivatives of the coordinates by parameters.

    use super::error::{Error, Fault};
    use super::numbers::Numbers;
    use super::solution::{Solution, Solved};
    use super::state::{Parameters, State, Timed};

    /// Equations with the operations that give the derivatives of the coordinates by their parameters too.
    pub trait Sensitive<const K: usize>: Solved {
        /// Solves as [`solve`](Solved::solve) does and computes the derivatives of the coordinates by parameters.
        fn solve_by_params(
            &self,
            guess: &Self::Tears,
            t: f64,
            sides: &Self::Sides,
            at: &mut Solution<Self>,
            by: &mut [Self::Q; K],
        );

        /// Does the same by elimination with partial pivoting next to `from`, after the operations have failed with `at`.
        /// Returns a fault if blocks are too large for that.
        fn pivoted_by_params(
            &self,
            _from: &Solution<Self>,
            at: &mut Solution<Self>,
            _by: &mut [Self::Q; K],
        ) -> Result<(), Fault> {
            Err(at.fault())
        }

        /// Sets derivatives to NaN in whose direction a redundant equation ceases to hold.
        fn reject_drift_by_params(&self, _by: &mut [Self::Q; K], _at: &Solution<Self>, _sides: &Self::Sides) {}
    }

    /// Returns the derivatives of the coordinates by each parameter next to a solution.
    pub fn by_params<M: Sensitive<K>, const K: usize>(m: &M, from: &Solution<M>) -> Result<[M::Q; K], Error> {
        let (mut at, mut by) = (*from, [M::Q::ZERO; K]);
        m.solve_by_params(&M::tears(&from.q), from.t, &from.sides, &mut at, &mut by);
        if !at.is_settled || !at.holds {
            m.pivoted_by_params(from, &mut at, &mut by).map_err(Fault::at_start)?;
        }
        if by.iter().flat_map(|by| by.as_ref()).all(|value| value.is_finite()) {
            m.reject_drift_by_params(&mut by, &at, &from.sides);
            Ok(by)
        } else {
            Err(Error::NotANumber)
        }
    }

    /// Returns the derivatives of the coordinates by each parameter at the position next to that of a state, for the given
    /// parameters.
    pub fn sensitivity<M: Timed + Sensitive<K>, const K: usize>(
        params: &M::Params,
        state: &State<M>,
    ) -> Result<[M::Q; K], Error> {
        if !params.is_finite() {
            return Err(Error::NotANumber);
        }
        by_params(&M::new(params), state.at())
    }
}

pub mod input_driven_sensitivity {
    //! Derivatives of the coordinates by parameters of a mechanism with inputs.

    use super::error::Error;
    use super::follow::Follows;
    use super::input_path::{InputDriven, InputPath};
    use super::sensitivity::{Sensitive, by_params, sensitivity};
    use super::state::{Parameters, State};

    /// Returns the derivatives of the coordinates by each parameter next to a state. Inputs that the state was moved to
    /// stay constant.
    pub fn input_driven_sensitivity<E, M, const K: usize, const P: usize>(
        params: &M::Params,
        state: &State<M>,
    ) -> Result<[M::Q; P], Error>
    where
        E: InputDriven<K> + Sensitive<P>,
        M: Follows<E, K> + Sensitive<P>,
    {
        if !state.is_input_driven() {
            return sensitivity(params, state);
        }
        if !params.is_finite() {
            return Err(Error::NotANumber);
        }
        let path = InputPath { params: *params, ..*state.continuation.model.path() };
        by_params(&E::new(&path), state.continuation.at())
    }
}

pub mod pivoted_derivatives {
    //! Derivatives of the coordinates by elimination with partial pivoting.

    use super::error::Fault;
    use super::pivoting::{Elimination, Pivoting, solve_with_pivoting, without_signs_of_zero};
    use super::solution::Solution;

    /// Solves next to a solution, then for the derivatives with the given right sides.
    pub fn derivatives_with_pivoting<M: Pivoting, const K: usize>(
        m: &M,
        from: &Solution<M>,
        at: &mut Solution<M>,
        by: &mut [M::Q; K],
        rights: impl Fn(&M::Q) -> [M::Q; K],
    ) -> Result<(), Fault> {
        *at = solve_with_pivoting(m, &from.q, from.t, &from.sides)?;
        let mut elimination = Elimination::<M>::new();
        let slopes = m.phi_q(&at.q, from.t, &from.sides);
        for (by, right) in by.iter_mut().zip(&rights(&at.q)) {
            *by = without_signs_of_zero(elimination.solve(&slopes, right).0);
        }
        Ok(())
    }
}
