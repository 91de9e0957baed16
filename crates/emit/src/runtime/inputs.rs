//! The path of inputs. Each inner module is emitted by itself, where a mechanism needs it.

use super::{equations, limits, numbers, solution, state};

pub mod input_path {
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
    pub struct InputPath<P, const K: usize> {
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

    impl<P: Parameters, const K: usize> InputPath<P, K> {
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
    pub trait InputDriven<const K: usize>: Solved<Along = Slopes<<Self as Equations>::Q, K>> {
        /// Its parameters.
        type Params: Parameters;

        /// By signal: the largest change that a call takes, if nobody says otherwise.
        const LARGEST_CHANGE: [f64; K];

        /// The mechanism on a way.
        fn new(way: &InputPath<Self::Params, K>) -> Self;

        /// The way that it is on.
        fn path(&self) -> &InputPath<Self::Params, K>;

        /// The same, to be written.
        fn path_mut(&mut self) -> &mut InputPath<Self::Params, K>;

        /// What the text's formulas say of the signals at a time (s).
        fn by_formulas(params: &Self::Params, t: f64) -> Signals<K>;

        /// Derivatives in whose direction an equation that was left out would cease to hold have no value.
        fn reject_drift(&self, _by: &mut [Self::Q; K], _at: &Solution<Self>) {}
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

    /// Coordinates a distance on, with their rates.
    fn moved<N: Numbers>(q: &N, rates: &N, distance: f64) -> N {
        let mut moved = *q;
        let pairs = moved.as_mut().iter_mut().zip(rates.as_ref());
        pairs.for_each(|(q, rate)| *q += distance * rate);
        moved
    }
}

pub mod input_list {
    //! Signals as one list.

    use super::input_path::InputPath;
    use super::state::Parameters;

    impl<P: Parameters, const K: usize> InputPath<P, K> {
        /// Value, rate and acceleration of each signal at a place of the way, one behind the other.
        pub fn list<const L: usize>(&self, t: f64) -> [f64; L] {
            let of = |all: &[f64; K], k: usize| all.get(k).copied().unwrap_or(f64::NAN);
            core::array::from_fn(|place| match (place / 3, place % 3) {
                (k, 0) => self.value(k, t),
                (k, 1) => of(&self.rates, k),
                (k, _) => of(&self.accelerations, k),
            })
        }
    }
}
