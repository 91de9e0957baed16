//! What keeps its sign along a branch of the motion.

use super::numbers::Flags;

/// Which of some quantities are positive.
pub fn positive<F: Flags>(values: &[f64]) -> F {
    let mut flags = F::NONE;
    for (flag, value) in flags.as_mut().iter_mut().zip(values) {
        *flag = *value > 0.0;
    }
    flags
}
