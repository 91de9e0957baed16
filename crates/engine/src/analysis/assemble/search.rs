//! Searches of assembly: the position that is nearest to satisfying some equations, and starts at random.

use crate::analysis::state::{Evaluated, Kinematics, minimize};

/// Moves some coordinates to where some rows are as near to zero as they come from `q`.
pub fn levenberg_marquardt(kinematics: &mut Kinematics, q: &mut [f64], rows: &[u32], columns: &[u32]) {
    let determined = kinematics.determined();
    let system = determined.system();
    // if the equations have no value there, the position stays as it is
    let _ = minimize(system, columns, q, None, |q, weights| {
        kinematics.set_position(q).ok()?;
        let (phi, phi_q) = (|row| kinematics.phi(row), |position| kinematics.phi_q(position));
        Evaluated { system, phi, phi_q }.linear(rows, columns, weights)
    });
}

/// Numbers in [−1, 1] that are the same on every run (G. Steele et al., *SplitMix*, 2014).
pub struct Noise(u64);

impl Noise {
    pub fn new() -> Noise {
        Noise(0x9e37_79b9_7f4a_7c15)
    }

    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}
