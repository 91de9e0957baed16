//! Derivatives of the coordinates by elimination with partial pivoting.

use super::error::Fault;
use super::pivoting::{Elimination, Pivoting, solve_with_pivoting, without_signs_of_zero};
use super::solution::Solution;

/// Solves next to a solution, and then for the derivatives with some right sides.
pub fn slopes_with_pivoting<M: Pivoting, const K: usize>(
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
