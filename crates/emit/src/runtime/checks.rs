//! Conditions beside the equations. Each inner module is emitted by itself, where a mechanism needs it.

use super::{equations, limits, numbers};

pub mod redundant_rows {
    //! Equations that were left out because they follow from the others.

    use super::limits::LARGEST_OPENING;

    /// Returns whether all residuals are negligible relative to their scales.
    pub fn redundant_rows_hold(left: &[f64], scales: &[f64]) -> bool {
        let mut pairs = left.iter().zip(scales);
        pairs.all(|(value, scale)| value.abs() / scale <= LARGEST_OPENING)
    }
}

pub mod monitors {
    //! Quantities that keep their signs along a branch of the motion.

    use super::numbers::Flags;

    /// Returns a flag for each value: whether it is positive.
    pub fn positive<F: Flags>(values: &[f64]) -> F {
        let mut flags = F::NONE;
        for (flag, value) in flags.as_mut().iter_mut().zip(values) {
            *flag = *value > 0.0;
        }
        flags
    }
}

pub mod constraint_drift {
    //! Directions in which redundant equations cease to hold.

    use super::equations::Equations;
    use super::limits::MISSES;
    use super::numbers::Numbers;

    /// Sets derivatives of the coordinates to NaN in whose direction a redundant equation ceases to hold, since the
    /// mechanism cannot be assembled next to its position: `|D Φ| > ε ‖Φ_q‖ Σ |D q|`, scaled.
    ///
    /// `slopes` are the derivatives of these equations by coordinates, one for each of `entries`, followed by those by the
    /// variable of each derivative.
    pub fn reject_drift<M: Equations, const K: usize, const LEFT_OUT: usize>(
        by: &mut [M::Q; K],
        entries: &[(usize, usize)],
        slopes: &[f64],
        scales: &[f64; LEFT_OUT],
    ) {
        for (number, by) in by.iter_mut().enumerate() {
            let sizes = by.as_ref().iter().zip(M::scales().as_ref());
            let size: f64 = sizes.map(|(x, scale)| x.abs() / scale).sum();
            let mut off = [0.0; LEFT_OUT];
            let own = slopes.iter().skip(entries.len() + number * LEFT_OUT);
            off.iter_mut().zip(own).for_each(|(off, own)| *off = *own);
            for (&(check, column), slope) in entries.iter().zip(slopes) {
                if let (Some(off), Some(x)) = (off.get_mut(check), by.as_ref().get(column)) {
                    *off += slope * x;
                }
            }
            if !off.iter().zip(scales).all(|(off, scale)| off.abs() <= MISSES * scale * size) {
                let mut none = M::Q::ZERO;
                none.as_mut().fill(f64::NAN);
                *by = none;
            }
        }
    }
}
