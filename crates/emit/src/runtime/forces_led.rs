//! What joints exert and drivers supply, where inputs may have led.

use super::follow::Follows;
use super::forces::{Forced, forces, forces_at};
use super::state::State;
use super::way::Led;

/// The forces of a state.
pub fn forces_led<E, M, const K: usize>(state: &State<M>) -> M::Forces
where
    M: Follows<E, K> + Forced,
    E: Led<K> + Forced<Forces = M::Forces>,
{
    if state.is_led() { forces_at(&state.lead.model, state.lead.at(), state.steepness) } else { forces(state) }
}
