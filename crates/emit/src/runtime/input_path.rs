//! Path of the signals that drive a mechanism.

use super::equations::Equations;
use super::limits::FARTHEST_AHEAD;
use super::numbers::{Numbers, largest};
use super::solution::{Along, Solution, Solved};
use super::state::Parameters;

/// Values, rates and accelerations of signals.
pub type Signals<const K: usize> = [[f64; K]; 3];

/// A path of the signals: a straight line from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct InputPath<P, const K: usize> {
    /// The parameters of the mechanism.
    pub params: P,
    /// Values at the beginning.
    pub from: [f64; K],
    /// Values at the end.
    pub to: [f64; K],
    /// Rates on the whole path.
    pub rates: [f64; K],
    /// Accelerations on the whole path.
    pub accelerations: [f64; K],
}

impl<P: Parameters, const K: usize> InputPath<P, K> {
    /// Creates a path of length 0.
    pub fn new(params: &P) -> Self {
        let zero = [0.0; K];
        Self { params: *params, from: zero, to: zero, rates: zero, accelerations: zero }
    }

    /// Starts a new path from `from` to the signals `to`.
    pub fn restart(&mut self, from: &[f64; K], to: &Signals<K>) {
        self.from = *from;
        [self.to, self.rates, self.accelerations] = *to;
    }

    /// Returns the value of a signal at a position of the path.
    #[inline]
    pub fn value(&self, k: usize, t: f64) -> f64 {
        match (self.from.get(k), self.to.get(k)) {
            (Some(_), Some(to)) if t >= 1.0 => *to,
            (Some(from), Some(to)) => from + t * (to - from),
            _ => f64::NAN,
        }
    }

    /// Returns the values of all signals at a position of the path.
    pub fn values(&self, t: f64) -> [f64; K] {
        core::array::from_fn(|k| self.value(k, t))
    }

    /// Returns the change of each signal along the whole path.
    pub fn direction(&self) -> [f64; K] {
        core::array::from_fn(|k| self.value(k, 1.0) - self.value(k, 0.0))
    }

    /// Returns the largest change of a signal along the whole path.
    pub fn length(&self) -> f64 {
        largest(&self.direction(), &[1.0; K])
    }
}

/// A mechanism whose motion follows signals.
pub trait InputDriven<const K: usize>: Solved<Along = Slopes<<Self as Equations>::Q, K>> {
    /// Parameters of the mechanism.
    type Params: Parameters;

    /// Largest change of each signal in a call, by default.
    const LARGEST_CHANGE: [f64; K];

    /// Creates the mechanism on a path.
    fn new(path: &InputPath<Self::Params, K>) -> Self;

    /// Returns the path.
    fn path(&self) -> &InputPath<Self::Params, K>;

    /// Returns the path for modification.
    fn path_mut(&mut self) -> &mut InputPath<Self::Params, K>;

    /// Returns the signals that the text's formulas give at a time (s).
    fn by_formulas(params: &Self::Params, t: f64) -> Signals<K>;

    /// Sets derivatives to NaN in whose direction a redundant equation ceases to hold.
    fn reject_drift(&self, _by: &mut [Self::Q; K], _at: &Solution<Self>) {}
}

/// Motion along signals: their values and the derivatives of the coordinates by each.
#[derive(Clone, Copy, Debug)]
pub struct Slopes<Q, const K: usize> {
    /// Derivatives of the coordinates by each signal.
    pub by_signal: [Q; K],
    /// The values of the signals.
    pub signals: [f64; K],
}

impl<Q: Numbers, const K: usize> Slopes<Q, K> {
    /// Returns the change of the coordinates along a direction of the signals.
    pub fn along(&self, direction: &[f64; K]) -> Q {
        sum(self.by_signal, direction)
    }
}

/// Returns the sum of lists of numbers, each multiplied by its factor.
pub fn sum<N: Numbers, const K: usize>(lists: [N; K], factors: &[f64; K]) -> N {
    let mut sum = N::ZERO;
    for (list, factor) in lists.iter().zip(factors) {
        let pairs = sum.as_mut().iter_mut().zip(list.as_ref());
        pairs.for_each(|(sum, value)| *sum += value * factor);
    }
    sum
}

impl<M: InputDriven<K>, const K: usize> Along<M> for Slopes<M::Q, K> {
    const ZERO: Self = Self { by_signal: [M::Q::ZERO; K], signals: [0.0; K] };

    fn predicted(m: &M, from: &Solution<M>, h: f64) -> M::Q {
        moved(&from.q, &from.along.along(&m.path().direction()), h)
    }

    fn ahead(m: &M, at: &Solution<M>) -> (M::Q, f64) {
        let rates = at.along.along(&m.path().direction());
        let ahead = f64::min(FARTHEST_AHEAD, FARTHEST_AHEAD / largest(&rates, M::scales()));
        (moved(&at.q, &rates, ahead), at.t)
    }

    fn note(&mut self, m: &M, t: f64) {
        self.signals = m.path().values(t);
    }

    fn slopes(&self) -> &[M::Q] {
        &self.by_signal
    }

    fn slopes_mut(&mut self) -> &mut [M::Q] {
        &mut self.by_signal
    }
}

/// Extrapolates coordinates by a distance with constant rates.
fn moved<N: Numbers>(q: &N, rates: &N, distance: f64) -> N {
    let mut moved = *q;
    let pairs = moved.as_mut().iter_mut().zip(rates.as_ref());
    pairs.for_each(|(q, rate)| *q += distance * rate);
    moved
}
