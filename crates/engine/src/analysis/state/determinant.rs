//! Determinants of blocks, of any size without underflow: their signs tell the branches of a motion apart.

/// 2^-256: a determinant below it is stored in units of it, since that of a large block would underflow.
const UNIT: f64 = 1.0 / UNITS;
/// 2^256.
const UNITS: f64 = (1_u128 << 127) as f64 * (1_u128 << 127) as f64 * 4.0;

/// The determinant of a block whose rows have unit norm: at most 1, and smooth along a motion.
#[derive(Clone, Copy, Debug)]
pub struct Determinant {
    /// In units of `UNIT` to the power of `units`.
    value: f64,
    units: u32,
}

impl Determinant {
    pub const ONE: Determinant = Determinant { value: 1.0, units: 0 };

    pub fn is_positive(self) -> bool {
        self.value.is_sign_positive()
    }

    /// Returns the value in such units that the value of `other` neither overflows nor underflows in them.
    pub fn relative_to(self, other: Determinant) -> f64 {
        match i64::from(self.units) - i64::from(other.units) {
            0 => self.value,
            1 => self.value * UNIT,
            -1 => self.value * UNITS,
            smaller if smaller > 0 => 0.0,
            _ => f64::INFINITY.copysign(self.value),
        }
    }

    pub fn multiply(&mut self, pivot: f64) {
        self.value *= pivot;
        if self.value.abs() < UNIT {
            self.value *= UNITS;
            self.units += 1;
        }
    }
}
