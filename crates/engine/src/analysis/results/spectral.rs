//! Integrals of formulas that are smooth over the whole analysis, by the rule of Clenshaw and Curtis: the sample times depend on the analysis
//! alone, so that a variant has the same bits in the lanes of a sweep and outside a sweep.
//!
//! Source: C. W. Clenshaw, A. R. Curtis, *A method for numerical integration on an automatic computer*, Numerische Mathematik 2, 1960.

use super::curve::{Cell, Estimate};
use super::interval_search::IntervalSearch;
use crate::limits::quadrature::{ACCURACY, ROUNDING};
use mechc_expr::math::cos;
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Smallest number of intervals of the rule, as a power of two.
const FIRST: usize = 6;
/// Largest number of intervals of the rule, as a power of two.
const LAST: usize = 12;
/// The rule converges if doubling the intervals changes it by at most this part of the previous change.
const LESS: f64 = 0.1;
/// Largest difference from the integral of the dense output, as a part of it: beyond it something narrow has been missed.
const ALIKE: f64 = 1e-2;

/// An integral with a growing number of sample times.
#[derive(Clone, Debug)]
pub struct SpectralIntegral {
    /// The first and the last time (s).
    interval: [f64; 2],
    /// The binary logarithm of the number of intervals between sample times.
    level: usize,
    /// The formula at the sample times; NaN where it has not been evaluated yet.
    values: Vec<f64>,
}

/// The outcome of a refinement with the formula at all sample times.
#[derive(Clone, Copy, Debug)]
pub enum Settled {
    /// The integral needs twice as many samples.
    On,
    /// The integral and its error bound.
    Known([f64; 2]),
    /// The largest number of samples is not enough, or the steps of the motion contradict the integral.
    Lost,
}

impl SpectralIntegral {
    /// Returns an integral over an analysis from one time to another (s), without samples.
    #[must_use]
    pub fn new(interval: [f64; 2]) -> SpectralIntegral {
        SpectralIntegral { interval, level: FIRST, values: vec![f64::NAN; (1 << FIRST) + 1] }
    }

    /// Returns the numbers and times (s) of the samples that have to be evaluated next, in order.
    pub fn times(&self) -> impl Iterator<Item = (usize, f64)> + use<> {
        let ([from, to], level) = (self.interval, self.level);
        let count = 1_usize << level;
        let is_new = move |k: &usize| level == FIRST || k % 2 == 1;
        (0..=count).filter(is_new).map(move |k| {
            let node = cos(PI * (k as f64 / count as f64));
            let t = if k == 0 {
                from
            } else if k == count {
                to
            } else {
                0.5 * (from + to) - 0.5 * (to - from) * node
            };
            (k, t)
        })
    }

    /// Records the value of a sample, by its number.
    pub fn take(&mut self, k: usize, value: f64) {
        self.values[k] = value;
    }

    /// Estimates the integral once all samples are evaluated. `by_steps` returns the integral from the ends of the motion's steps, which may differ
    /// by `part` of the size.
    pub fn go_on(&mut self, part: f64, by_steps: impl FnOnce() -> f64) -> Settled {
        let half = 0.5 * (self.interval[1] - self.interval[0]);
        let sum = |level: usize, of: &dyn Fn(f64) -> f64| {
            let values = self.values.iter().step_by(1 << (self.level - level));
            half * weights(level).iter().zip(values).map(|(weight, value)| weight * of(*value)).sum::<f64>()
        };
        let [finest, coarse, coarser] = [0, 1, 2].map(|less| sum(self.level - less, &|value| value));
        let mean = finest / (2.0 * half);
        let size = sum(self.level, &|value| (value - mean).abs());
        let largest = self.values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let ([change, before], rounding) =
            ([finest - coarse, coarse - coarser].map(f64::abs), ROUNDING * 2.0 * half * largest);
        // the number of certain digits grows in proportion to the number of samples
        let error = if change < LESS * before { change * (change / before) } else { change };
        if error <= (ACCURACY * size).max(rounding) {
            let is_alike = (finest - by_steps()).abs() <= (part * size).max(part * part * 2.0 * half * largest);
            return if is_alike { Settled::Known([finest, error + rounding]) } else { Settled::Lost };
        }
        if self.level == LAST || error.is_nan() {
            return Settled::Lost;
        }
        self.level += 1;
        let values = std::mem::take(&mut self.values);
        self.values = values.into_iter().flat_map(|value| [value, f64::NAN]).collect();
        self.values.pop();
        Settled::On
    }
}

/// Returns the weights of 2^`level` + 1 samples for the integral from −1 to 1.
fn weights(level: usize) -> &'static [f64] {
    static WEIGHTS: [OnceLock<Box<[f64]>>; LAST + 1] = [const { OnceLock::new() }; LAST + 1];
    WEIGHTS[level].get_or_init(|| {
        let count = 1_usize << level;
        let cosines: Vec<f64> = (0..count).map(|k| cos(2.0 * PI * (k as f64 / count as f64))).collect();
        let of = |k: usize| {
            let term = |j: usize| {
                let twice = if 2 * j == count { 1.0 } else { 2.0 };
                twice / (4.0 * (j * j) as f64 - 1.0) * cosines[j * k % count]
            };
            let sum: f64 = (1..=count / 2).map(term).sum();
            let is_end = k == 0 || k == count;
            if is_end { (1.0 - sum) / count as f64 } else { 2.0 * (1.0 - sum) / count as f64 }
        };
        (0..=count).map(of).collect()
    })
}

impl IntervalSearch<'_> {
    /// Returns the integral of a formula that settles over adjacent cells without edges between them, or `None` if the rule does not converge.
    pub(super) fn integrate_whole(&mut self, cells: &[Cell]) -> Option<Estimate> {
        let (first, last) = (cells.first()?, cells.last()?);
        let mut integral = SpectralIntegral::new([first.a.state.t, last.b.state.t]);
        loop {
            let mut step = 0;
            for (k, t) in integral.times() {
                while t > cells[step].b.state.t {
                    step += 1;
                }
                let cell = &cells[step];
                let value = if t <= first.a.state.t {
                    first.a.sample.value
                } else if t >= last.b.state.t {
                    last.b.sample.value
                } else {
                    self.exact_point(cell, t)?.sample.value
                };
                integral.take(k, value);
            }
            let by_steps = || cells.iter().map(|cell| self.rule_of_ends(&cell.a, &cell.b)).sum();
            match integral.go_on(ALIKE, by_steps) {
                Settled::On => {}
                Settled::Known([value, error]) => return Some(Estimate { value, error }),
                Settled::Lost => return None,
            }
        }
    }
}
