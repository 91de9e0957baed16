//! Measures.

use core::fmt::Debug;

/// Measures with their first and second time derivatives.
pub trait Measured: Copy + Debug {
    /// Measures before the first solution.
    const ZERO: Self;

    /// Flags in the order of [`lists`](Measured::lists): true for derivatives by inputs or parameters, and for forces.
    const IS_VARIED: &'static [bool] = &[];

    /// Returns values, rates and accelerations.
    fn lists(&self) -> [&[f64]; 3];

    /// Returns values, rates and accelerations for modification.
    fn lists_mut(&mut self) -> [&mut [f64]; 3];

    /// Replaces values that are not finite by NaN.
    fn leave_out(&mut self) {
        for list in self.lists_mut() {
            for value in list.iter_mut().filter(|value| !value.is_finite()) {
                *value = f64::NAN;
            }
        }
    }

    /// Replaces derivatives by inputs and parameters, and forces, by NaN, since they have no value close to a singular
    /// position.
    fn leave_varied_out(&mut self) {
        let mut rest = Self::IS_VARIED.iter();
        for list in self.lists_mut() {
            for (value, _) in list.iter_mut().zip(&mut rest).filter(|(_, is_varied)| **is_varied) {
                *value = f64::NAN;
            }
        }
    }
}

/// A mechanism without measures.
impl Measured for () {
    const ZERO: Self = ();

    fn lists(&self) -> [&[f64]; 3] {
        [&[]; 3]
    }

    fn lists_mut(&mut self) -> [&mut [f64]; 3] {
        [&mut [], &mut [], &mut []]
    }
}
