//! Signals as one list.

use super::state::Parameters;
use super::way::Way;

impl<P: Parameters, const K: usize> Way<P, K> {
    /// Value, rate and acceleration of each signal at a place of the way, one behind the other.
    pub fn list<const L: usize>(&self, t: f64) -> [f64; L] {
        let of = |all: &[f64; K], k: usize| all.get(k).copied().unwrap_or(f64::NAN);
        core::array::from_fn(|place| match (place / 3, place % 3) {
            (k, 0) => self.value(k, t),
            (k, 1) => of(&self.rates, k),
            (k, _) => of(&self.accelerations, k),
        })
    }
}
