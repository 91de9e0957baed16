//! Sine and cosine of several angles at once.

use mechc_runtime::sine_and_cosine::{A_MILLION, sin_cos};
use mechc_runtime::without_branches::sin_cos_below_a_million;

/// Returns the sines and cosines of several angles (rad), with the same bits as for each alone.
#[must_use]
#[inline(always)]
#[allow(clippy::inline_always)] // it is inlined into loops that are compiled for several kinds of processors
pub fn sin_cos_lanes<const W: usize>(angles: &[f64; W]) -> ([f64; W], [f64; W]) {
    let (mut sines, mut cosines) = ([0.0; W], [0.0; W]);
    // one comparison for all lanes
    if angles.iter().fold(true, |all, angle| all & (angle.abs() < A_MILLION)) {
        for k in 0..W {
            (sines[k], cosines[k]) = sin_cos_below_a_million(angles[k]);
        }
    } else {
        for k in 0..W {
            (sines[k], cosines[k]) = sin_cos(angles[k]);
        }
    }
    (sines, cosines)
}

#[cfg(test)]
mod tests {
    use super::{sin_cos, sin_cos_lanes};

    #[test]
    fn lanes_have_the_bits_of_single_angles() {
        let mut angle = -9.7e5;
        while angle < 1.1e6 {
            let angles: [f64; 8] = std::array::from_fn(|k| angle + 0.7 * k as f64);
            let (sines, cosines) = sin_cos_lanes(&angles);
            for (k, angle) in angles.into_iter().enumerate() {
                let (sin, cos) = sin_cos(angle);
                assert_eq!((sines[k].to_bits(), cosines[k].to_bits()), (sin.to_bits(), cos.to_bits()), "of {angle}");
            }
            angle += 97.3;
        }
        let odd = [0.0, -0.0, f64::NAN, f64::INFINITY, 1e300, -1e-300, 0.5 * std::f64::consts::PI, -3.0];
        let (sines, cosines) = sin_cos_lanes(&odd);
        for (k, angle) in odd.into_iter().enumerate() {
            let (sin, cos) = sin_cos(angle);
            assert!(sines[k].to_bits() == sin.to_bits() && cosines[k].to_bits() == cos.to_bits(), "of {angle}");
        }
        let tiny = odd.map(|angle| if angle.abs() < 1e6 { angle } else { 1e-310 });
        let (sines, cosines) = sin_cos_lanes(&tiny);
        for (k, angle) in tiny.into_iter().enumerate() {
            assert_eq!(
                (sines[k].to_bits(), cosines[k].to_bits()),
                (sin_cos(angle).0.to_bits(), sin_cos(angle).1.to_bits())
            );
        }
    }
}
