//! The derivatives of the coordinates by parameters, where inputs may have led.

use super::error::Error;
use super::follow::Follows;
use super::sensitivity::{Sensitive, by_params, sensitivity};
use super::state::{Parameters, State};
use super::way::{Led, Way};

/// The derivatives of the coordinates by each parameter, next to a state: inputs that have led stay what they are.
pub fn sensitivity_led<E, M, const K: usize, const P: usize>(
    params: &M::Params,
    state: &State<M>,
) -> Result<[M::Q; P], Error>
where
    E: Led<K> + Sensitive<P>,
    M: Follows<E, K> + Sensitive<P>,
{
    if !state.is_led() {
        return sensitivity(params, state);
    }
    if !params.is_finite() {
        return Err(Error::NotANumber);
    }
    let way = Way { params: *params, ..*state.lead.model.way() };
    by_params(&E::new(&way), state.lead.at())
}
