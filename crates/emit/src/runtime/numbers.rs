//! Numbers by place, and how large they are.

use core::fmt::Debug;

/// So many numbers.
pub trait Numbers: Copy + Debug + 'static + AsRef<[f64]> + AsMut<[f64]> {
    /// All of them 0.
    const ZERO: Self;
}

impl<const K: usize> Numbers for [f64; K] {
    const ZERO: Self = [0.0; K];
}

/// So many answers.
pub trait Flags: Copy + Debug + PartialEq + 'static + AsRef<[bool]> + AsMut<[bool]> {
    /// All of them no.
    const NONE: Self;
}

impl<const K: usize> Flags for [bool; K] {
    const NONE: Self = [false; K];
}

/// The largest value beside its scale; not a number if one is not.
pub fn largest<N: Numbers>(values: &N, scales: &N) -> f64 {
    let pairs = values.as_ref().iter().zip(scales.as_ref());
    let sizes = pairs.map(|(value, scale)| value.abs() / scale);
    sizes.fold(0.0, larger)
}

/// The larger one; not a number if one is not.
pub fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Adds a zero for each value, which one that is not finite turns into no number: all are looked at without a branch for each.
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

/// What leads from some numbers to others.
pub fn difference<N: Numbers>(to: &N, from: &N) -> N {
    let mut way = *to;
    way.as_mut().iter_mut().zip(from.as_ref()).for_each(|(way, from)| *way -= from);
    way
}

/// Coordinates after a time `h` (s), by their velocities and accelerations now.
pub fn predicted<N: Numbers>(q: &N, qd: &N, qdd: &N, h: f64) -> N {
    let mut later = *q;
    let rates = qd.as_ref().iter().zip(qdd.as_ref());
    for (q, (qd, qdd)) in later.as_mut().iter_mut().zip(rates) {
        *q += h * (qd + 0.5 * h * qdd);
    }
    later
}
