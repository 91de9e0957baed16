//! The derivatives of the coordinates by parameters.

use super::error::{Error, Fault};
use super::numbers::Numbers;
use super::solution::{Solution, Solved};
use super::state::{Parameters, State, Timed};

/// Equations with the operations that give the derivatives of the coordinates by their parameters too.
pub trait Sensitive<const K: usize>: Solved {
    /// As [`solve`](Solved::solve), with the derivatives of the coordinates by parameters.
    fn solve_by_params(
        &self,
        guess: &Self::Tears,
        t: f64,
        sides: &Self::Sides,
        at: &mut Solution<Self>,
        by: &mut [Self::Q; K],
    );

    /// The same by elimination with partial pivoting, next to where that has failed with `at`; a fault where blocks are too large for
    /// that.
    fn pivoted_by_params(
        &self,
        _from: &Solution<Self>,
        at: &mut Solution<Self>,
        _by: &mut [Self::Q; K],
    ) -> Result<(), Fault> {
        Err(at.fault())
    }

    /// Derivatives in whose direction an equation that was left out would cease to hold have no value.
    fn hold_apart_by_params(&self, _by: &mut [Self::Q; K], _at: &Solution<Self>, _sides: &Self::Sides) {}
}

/// The derivatives of the coordinates by each parameter, next to a solution.
pub fn by_params<M: Sensitive<K>, const K: usize>(m: &M, from: &Solution<M>) -> Result<[M::Q; K], Error> {
    let (mut at, mut by) = (*from, [M::Q::ZERO; K]);
    m.solve_by_params(&M::tears(&from.q), from.t, &from.sides, &mut at, &mut by);
    if !at.is_settled || !at.holds {
        m.pivoted_by_params(from, &mut at, &mut by).map_err(Fault::at_start)?;
    }
    if by.iter().flat_map(|by| by.as_ref()).all(|value| value.is_finite()) {
        m.hold_apart_by_params(&mut by, &at, &from.sides);
        Ok(by)
    } else {
        Err(Error::NotANumber)
    }
}

/// The same at the position that some parameters have next to that of a state.
pub fn sensitivity<M: Timed + Sensitive<K>, const K: usize>(
    params: &M::Params,
    state: &State<M>,
) -> Result<[M::Q; K], Error> {
    if !params.is_finite() {
        return Err(Error::NotANumber);
    }
    by_params(&M::new(params), state.at())
}
