//! What is measured.

use core::fmt::Debug;

/// Measures with their first and second time derivatives.
pub trait Measured: Copy + Debug {
    /// Nothing is measured yet.
    const ZERO: Self;

    /// Which of them, in the order of [`lists`](Measured::lists), are derivatives by inputs or parameters, or forces.
    const IS_VARIED: &'static [bool] = &[];

    /// Values, rates and accelerations.
    fn lists(&self) -> [&[f64]; 3];

    /// The same, to be written.
    fn lists_mut(&mut self) -> [&mut [f64]; 3];

    /// What is not finite is no number.
    fn leave_out(&mut self) {
        for list in self.lists_mut() {
            for value in list.iter_mut().filter(|value| !value.is_finite()) {
                *value = f64::NAN;
            }
        }
    }

    /// Close to a singular position derivatives by inputs and parameters, and forces, have no value.
    fn leave_varied_out(&mut self) {
        let mut rest = Self::IS_VARIED.iter();
        for list in self.lists_mut() {
            for (value, _) in list.iter_mut().zip(&mut rest).filter(|(_, is_varied)| **is_varied) {
                *value = f64::NAN;
            }
        }
    }
}

/// Where nothing is measured.
impl Measured for () {
    const ZERO: Self = ();

    fn lists(&self) -> [&[f64]; 3] {
        [&[]; 3]
    }

    fn lists_mut(&mut self) -> [&mut [f64]; 3] {
        [&mut [], &mut [], &mut []]
    }
}
