//! Conditions beside the equations. Each inner module is emitted by itself, where a mechanism needs it.

use super::{equations, limits, numbers};

pub mod redundant_rows {
    //! Equations that were left out, since they follow from the others.

    use super::limits::LARGEST_OPENING;

    /// Whether what is left of them is nothing, beside their scales.
    pub fn redundant_rows_hold(left: &[f64], scales: &[f64]) -> bool {
        let mut pairs = left.iter().zip(scales);
        pairs.all(|(value, scale)| value.abs() / scale <= LARGEST_OPENING)
    }
}

pub mod monitors {
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
}

pub mod constraint_drift {
    //! Where equations that were left out would cease to hold.

    use super::equations::Equations;
    use super::limits::MISSES;
    use super::numbers::Numbers;

    /// Derivatives of the coordinates in whose direction an equation that was left out would cease to hold have no value, for the
    /// mechanism cannot be assembled beside where it is: `|D Φ| ≤ ε ‖Φ_q‖ Σ |D q|`, scaled.
    ///
    /// `slopes` are how these equations change with coordinates, by `entries`, and then with what each of the derivatives is by.
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
