//! Continuation of lanes along inputs.

use super::error::Error;
use super::follow::{Follows, follow};
use super::input_path::{InputDriven, Signals};
use super::lane_solutions::Laned;
use super::lanes::{States, put};
use super::limits::MOST_STEPS_TO_FOLLOW;
use super::work::Work;

/// Moves every lane to its signals, one after the other, each with the bits that it would have alone. Returns for each lane
/// the reason if it has not arrived; such a lane is unchanged.
pub fn follow_each<E: InputDriven<K>, M: Follows<E, K> + Laned<L>, const K: usize, const L: usize>(
    signals: &[Signals<K>; L],
    states: &mut States<M, L>,
) -> [Result<(), Error>; L] {
    let mut results = [Ok(()); L];
    for (lane, (signals, result)) in signals.iter().zip(&mut results).enumerate() {
        let Some(mut state) = states.get(lane) else {
            continue;
        };
        *result = follow(signals, &mut state, MOST_STEPS_TO_FOLLOW, &mut Work::default());
        states.both().0.set_lane(lane, state.at());
        put(&mut states.continuation, lane, &state.continuation);
        put(&mut states.is_smooth, lane, &false);
    }
    results
}
