//! What joints exert and drivers supply by elimination with partial pivoting.

use super::error::Fault;
use super::forces::Forced;
use super::pivoting::{Elimination, Pivoting, solve_with_pivoting, without_signs_of_zero};
use super::solution::Solution;

/// Solves next to a solution, and then for the multipliers, which exert the forces.
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
