//! The way of the signals that lead a mechanism.

use super::equations::Equations;
use super::limits::FARTHEST_AHEAD;
use super::numbers::{Numbers, largest};
use super::solution::{Along, Solution, Solved};
use super::state::Parameters;

/// Values, rates and accelerations of signals.
pub type Signals<const K: usize> = [[f64; K]; 3];

/// A way of the signals: a straight line from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct Way<P, const K: usize> {
    /// The parameters of the mechanism.
    pub params: P,
    /// The values at its beginning.
    pub from: [f64; K],
    /// The values at its end.
    pub to: [f64; K],
    /// The rates all along.
    pub rates: [f64; K],
    /// The accelerations all along.
    pub accelerations: [f64; K],
}

impl<P: Parameters, const K: usize> Way<P, K> {
    /// A way that leads nowhere.
    pub fn new(params: &P) -> Self {
        let zero = [0.0; K];
        Self { params: *params, from: zero, to: zero, rates: zero, accelerations: zero }
    }

    /// Goes on from some values to signals.
    pub fn turn(&mut self, from: &[f64; K], to: &Signals<K>) {
        self.from = *from;
        [self.to, self.rates, self.accelerations] = *to;
    }

    /// The value of a signal at a place of the way.
    #[inline]
    pub fn value(&self, k: usize, t: f64) -> f64 {
        match (self.from.get(k), self.to.get(k)) {
            (Some(_), Some(to)) if t >= 1.0 => *to,
            (Some(from), Some(to)) => from + t * (to - from),
            _ => f64::NAN,
        }
    }

    /// Those of all.
    pub fn values(&self, t: f64) -> [f64; K] {
        core::array::from_fn(|k| self.value(k, t))
    }

    /// How the signals change along the whole way.
    pub fn direction(&self) -> [f64; K] {
        core::array::from_fn(|k| self.value(k, 1.0) - self.value(k, 0.0))
    }

    /// How much the one changes that changes most.
    pub fn length(&self) -> f64 {
        largest(&self.direction(), &[1.0; K])
    }
}

/// A mechanism whose motion goes along signals.
pub trait Led<const K: usize>: Solved<Along = Slopes<<Self as Equations>::Q, K>> {
    /// Its parameters.
    type Params: Parameters;

    /// By signal: the largest change that a call takes, if nobody says otherwise.
    const LARGEST_CHANGE: [f64; K];

    /// The mechanism on a way.
    fn new(way: &Way<Self::Params, K>) -> Self;

    /// The way that it is on.
    fn way(&self) -> &Way<Self::Params, K>;

    /// The same, to be written.
    fn way_mut(&mut self) -> &mut Way<Self::Params, K>;

    /// What the text's formulas say of the signals at a time (s).
    fn by_text(params: &Self::Params, t: f64) -> Signals<K>;

    /// Derivatives in whose direction an equation that was left out would cease to hold have no value.
    fn hold_apart(&self, _by: &mut [Self::Q; K], _at: &Solution<Self>) {}
}

/// The motion goes along signals: the derivatives of the coordinates by each, and what these are.
#[derive(Clone, Copy, Debug)]
pub struct Slopes<Q, const K: usize> {
    /// By signal: how the coordinates change with it.
    pub by_signal: [Q; K],
    /// The values of the signals.
    pub signals: [f64; K],
}

impl<Q: Numbers, const K: usize> Slopes<Q, K> {
    /// How the coordinates change along a direction of the signals.
    pub fn along(&self, direction: &[f64; K]) -> Q {
        sum(self.by_signal, direction)
    }
}

/// The sum of some lists of numbers, each with its factor.
pub fn sum<N: Numbers, const K: usize>(lists: [N; K], factors: &[f64; K]) -> N {
    let mut sum = N::ZERO;
    for (list, factor) in lists.iter().zip(factors) {
        let pairs = sum.as_mut().iter_mut().zip(list.as_ref());
        pairs.for_each(|(sum, value)| *sum += value * factor);
    }
    sum
}

impl<M: Led<K>, const K: usize> Along<M> for Slopes<M::Q, K> {
    const ZERO: Self = Self { by_signal: [M::Q::ZERO; K], signals: [0.0; K] };

    fn predicted(m: &M, from: &Solution<M>, h: f64) -> M::Q {
        moved(&from.q, &from.along.along(&m.way().direction()), h)
    }

    fn ahead(m: &M, at: &Solution<M>) -> (M::Q, f64) {
        let rates = at.along.along(&m.way().direction());
        let ahead = f64::min(FARTHEST_AHEAD, FARTHEST_AHEAD / largest(&rates, M::scales()));
        (moved(&at.q, &rates, ahead), at.t)
    }

    fn note(&mut self, m: &M, t: f64) {
        self.signals = m.way().values(t);
    }

    fn slopes(&self) -> &[M::Q] {
        &self.by_signal
    }

    fn slopes_mut(&mut self) -> &mut [M::Q] {
        &mut self.by_signal
    }
}

/// Coordinates a distance on, with their rates.
fn moved<N: Numbers>(q: &N, rates: &N, distance: f64) -> N {
    let mut moved = *q;
    let pairs = moved.as_mut().iter_mut().zip(rates.as_ref());
    pairs.for_each(|(q, rate)| *q += distance * rate);
    moved
}
