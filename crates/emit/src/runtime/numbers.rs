//! Lists of numbers and their norms.

use core::fmt::Debug;

/// A list of numbers.
pub trait Numbers: Copy + Debug + 'static + AsRef<[f64]> + AsMut<[f64]> {
    /// All numbers 0.
    const ZERO: Self;
}

impl<const K: usize> Numbers for [f64; K] {
    const ZERO: Self = [0.0; K];
}

/// A list of flags.
pub trait Flags: Copy + Debug + PartialEq + 'static + AsRef<[bool]> + AsMut<[bool]> {
    /// All flags false.
    const NONE: Self;
}

impl<const K: usize> Flags for [bool; K] {
    const NONE: Self = [false; K];
}

/// Returns the largest absolute value relative to its scale; NaN if any is NaN.
pub fn largest<N: Numbers>(values: &N, scales: &N) -> f64 {
    let pairs = values.as_ref().iter().zip(scales.as_ref());
    let sizes = pairs.map(|(value, scale)| value.abs() / scale);
    sizes.fold(0.0, larger)
}

/// Returns the larger number; NaN if either is NaN.
pub fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Adds 0 for each finite value and NaN for each other one, so that a single comparison checks all without branches.
#[inline(always)]
#[allow(clippy::inline_always)] // a call would cost more than it does
pub fn add_zeros<N: Numbers>(values: &N, sums: &mut [f64; 4]) {
    let chunks = values.as_ref().chunks_exact(4);
    for value in chunks.remainder() {
        sums[0] += 0.0 * value;
    }
    for chunk in chunks {
        if let [a, b, c, d] = chunk {
            sums[0] += 0.0 * a;
            sums[1] += 0.0 * b;
            sums[2] += 0.0 * c;
            sums[3] += 0.0 * d;
        }
    }
}

/// Returns the differences `to - from`.
pub fn difference<N: Numbers>(to: &N, from: &N) -> N {
    let mut difference = *to;
    difference.as_mut().iter_mut().zip(from.as_ref()).for_each(|(difference, from)| *difference -= from);
    difference
}

/// Returns the coordinates after a time `h` (s), from the present velocities and accelerations.
pub fn predicted<N: Numbers>(q: &N, qd: &N, qdd: &N, h: f64) -> N {
    let mut later = *q;
    let rates = qd.as_ref().iter().zip(qdd.as_ref());
    for (q, (qd, qdd)) in later.as_mut().iter_mut().zip(rates) {
        *q += h * (qd + 0.5 * h * qdd);
    }
    later
}
