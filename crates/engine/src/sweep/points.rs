//! The variants of a sweep: the values of their params, each computed from the variant's number alone.

use super::sobol::{self, Sobol};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// The method by which a sample fills its ranges.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Method {
    /// Sobol's sequence: any leading part fills the ranges evenly.
    #[default]
    Sobol,
    /// Independent pseudo-random points.
    Random,
}

/// The largest number of params in a sample by Sobol's sequence.
pub const MAX_SOBOL_DIMENSIONS: usize = sobol::MAX_DIMENSIONS;

/// An axis of a sweep: values that some params take together (SI).
#[derive(Clone, PartialEq, Debug)]
pub struct Varying {
    /// The params, as indices.
    pub params: Vec<usize>,
    /// Their values.
    pub values: Levels,
}

/// The values of the params of an axis (SI).
#[derive(Clone, PartialEq, Debug)]
pub enum Levels {
    /// Values of a single param: `count` equidistant values from first to last, both included.
    Even {
        /// First and last value.
        ends: [f64; 2],
        /// At least one; a single value is the first.
        count: u64,
    },
    /// The rows of a list or table, one after the other, with a value for each param.
    Listed(Vec<f64>),
    /// A sample of ranges.
    Sampled(Box<Sampling>),
}

/// A sample: a number of points within ranges.
#[derive(Clone, PartialEq, Debug)]
pub struct Sampling {
    /// By param: first and last value (SI).
    ends: Vec<[f64; 2]>,
    count: u64,
    generator: Generator,
}

#[derive(Clone, PartialEq, Debug)]
enum Generator {
    Sobol(Sobol),
    Random(Box<ChaCha8Rng>),
}

impl Sampling {
    /// Creates a sample of `count` points within ranges (SI). Sobol's sequence without a seed is the sequence itself; with a seed each coordinate is
    /// shifted, digit by digit.
    #[must_use]
    pub fn of(ends: Vec<[f64; 2]>, count: u64, method: Method, seed: Option<u64>) -> Sampling {
        let mut random = ChaCha8Rng::seed_from_u64(seed.unwrap_or(0));
        let generator = match method {
            Method::Random => Generator::Random(Box::new(random)),
            Method::Sobol => Generator::Sobol(Sobol::new(ends.iter().map(|_| seed.map_or(0, |_| random.next_u64())))),
        };
        Sampling { ends, count, generator }
    }

    fn values(&self, index: u64, mut set: impl FnMut(usize, f64)) {
        let mut set_fraction = |k: usize, fraction: f64| set(k, between(self.ends[k][0], self.ends[k][1], fraction));
        match &self.generator {
            Generator::Sobol(sobol) => (0..self.ends.len()).for_each(|k| set_fraction(k, sobol.coordinate(index, k))),
            Generator::Random(random) => {
                let mut random = ChaCha8Rng::clone(random);
                // a number takes two words of the generator
                random.set_word_pos(u128::from(index) * self.ends.len() as u128 * 2);
                (0..self.ends.len()).for_each(|k| set_fraction(k, unit(random.next_u64())));
            }
        }
    }
}

/// Returns value `index` of `count` equidistant ones from first to last, both included; with few digits, 0.3 rather than 0.30000000000000004.
#[must_use]
pub fn linspace_value([first, last]: [f64; 2], index: u64, count: u64) -> f64 {
    let (steps, k) = ((count - 1) as f64, index as f64);
    match index {
        0 => first,
        _ if index + 1 == count => last,
        _ => {
            let value = (first * (steps - k) + last * k) / steps;
            // the sum of large ends may be infinite
            round_to_15_digits(if value.is_finite() {
                value
            } else {
                first * ((steps - k) / steps) + last * (k / steps)
            })
        }
    }
}

/// Returns a number rounded to fifteen significant digits.
#[must_use]
pub fn round_to_15_digits(value: f64) -> f64 {
    format!("{value:.14e}").parse().unwrap_or(value)
}

/// Returns a number in [0, 1) from the leading digits.
fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

/// Returns the value at a fraction of the way from `from` to `to`; rounding does not lead out of the range.
fn between(from: f64, to: f64, fraction: f64) -> f64 {
    let (least, most) = if from <= to { (from, to) } else { (to, from) };
    let length = to - from;
    let value = if length.is_finite() { from + length * fraction } else { from * (1.0 - fraction) + to * fraction };
    value.clamp(least, most)
}

impl Varying {
    /// Returns the number of values.
    #[must_use]
    pub fn count(&self) -> u64 {
        match &self.values {
            Levels::Even { count, .. } => *count,
            Levels::Listed(rows) => (rows.len() / self.params.len()) as u64,
            Levels::Sampled(sample) => sample.count,
        }
    }

    fn values(&self, index: u64, into: &mut [f64]) {
        match &self.values {
            Levels::Even { ends, count } => into[self.params[0]] = linspace_value(*ends, index, *count),
            Levels::Listed(rows) => {
                let row = &rows[index as usize * self.params.len()..];
                self.params.iter().zip(row).for_each(|(&param, &value)| into[param] = value);
            }
            Levels::Sampled(sample) => sample.values(index, |k, value| into[self.params[k]] = value),
        }
    }
}

/// All variants of a sweep: the Cartesian product of its axes, the last axis fastest.
#[derive(Clone, PartialEq, Debug)]
pub struct Points {
    params: Vec<String>,
    axes: Vec<Varying>,
    count: u64,
}

impl Points {
    /// Creates the variants of some params, or returns `None` if their number exceeds `u64`.
    #[must_use]
    pub fn new(params: Vec<String>, axes: Vec<Varying>) -> Option<Points> {
        let count = axes.iter().try_fold(1_u64, |count, axis| count.checked_mul(axis.count()))?;
        Some(Points { params, axes, count })
    }

    /// Returns the names of the params that vary.
    #[must_use]
    pub fn params(&self) -> &[String] {
        &self.params
    }

    /// Returns the number of variants.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Returns the smallest and the largest value of a param (SI); for a sample the ends of its range.
    #[must_use]
    pub fn ends(&self, param: usize) -> [f64; 2] {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut take = |value: f64| (least, most) = (least.min(value), most.max(value));
        for axis in &self.axes {
            let Some(position) = axis.params.iter().position(|&other| other == param) else { continue };
            match &axis.values {
                // a single value is the first
                Levels::Even { ends: [first, last], count } => {
                    [*first, if *count > 1 { *last } else { *first }].map(&mut take)
                }
                Levels::Listed(rows) => {
                    rows.iter().skip(position).step_by(axis.params.len()).copied().for_each(&mut take);
                    continue;
                }
                Levels::Sampled(sample) => sample.ends[position].map(&mut take),
            };
        }
        [least, most]
    }

    /// Writes the values of a variant's params (SI), in the order of [`Points::params`].
    pub fn values(&self, variant: u64, into: &mut [f64]) {
        let mut rest = variant;
        for axis in self.axes.iter().rev() {
            axis.values(rest % axis.count(), into);
            rest /= axis.count();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Levels, Method, Points, Sampling, Varying};

    fn points(axes: Vec<Varying>) -> Points {
        let params = axes.iter().flat_map(|axis| &axis.params).count();
        Points::new((0..params).map(|k| format!("p{k}")).collect(), axes).expect("they can be counted")
    }

    fn all(points: &Points) -> Vec<Vec<f64>> {
        let point = |variant| {
            let mut values = vec![f64::NAN; points.params().len()];
            points.values(variant, &mut values);
            values
        };
        (0..points.count()).map(point).collect()
    }

    #[test]
    fn even_values_have_both_ends() {
        let even = |ends, count| {
            all(&points(vec![Varying { params: vec![0], values: Levels::Even { ends, count } }])).concat()
        };
        assert_eq!(even([0.1, 0.2], 3), [0.1, 0.15, 0.2]);
        assert_eq!(even([0.3, 0.1], 2), [0.3, 0.1], "descending");
        assert_eq!(even([0.1, 0.2], 1), [0.1], "one is the first");
        assert_eq!(even([0.1, 0.1], 3), [0.1; 3]);
        let many = even([0.1, 0.7], 1001);
        assert_eq!((many[0], many[1000]), (0.1, 0.7));
        assert!(many.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn axes_are_crossed() {
        let list = Levels::Listed(vec![1.0, 2.0, 3.0, 4.0]);
        let crossed = all(&points(vec![
            Varying { params: vec![1], values: Levels::Even { ends: [0.0, 1.0], count: 2 } },
            Varying { params: vec![0, 2], values: list },
        ]));
        assert_eq!(crossed, [[1.0, 0.0, 2.0], [3.0, 0.0, 4.0], [1.0, 1.0, 2.0], [3.0, 1.0, 4.0]]);
    }

    #[test]
    fn ends_are_the_extreme_values() {
        let sample = Sampling::of(vec![[1.0, 2.0], [-3.0, -5.0]], 9, Method::Sobol, None);
        let variants = points(vec![
            Varying { params: vec![0], values: Levels::Even { ends: [2.0, 1.0], count: 3 } },
            Varying { params: vec![1], values: Levels::Even { ends: [2.0, 1.0], count: 1 } },
            Varying { params: vec![3, 2], values: Levels::Listed(vec![1.0, 7.0, 4.0, 5.0, -2.0, 6.0]) },
            Varying { params: vec![4, 5], values: Levels::Sampled(Box::new(sample)) },
        ]);
        let ends: Vec<[f64; 2]> = (0..6).map(|param| variants.ends(param)).collect();
        assert_eq!(ends, [[1.0, 2.0], [2.0, 2.0], [5.0, 7.0], [-2.0, 4.0], [1.0, 2.0], [-5.0, -3.0]]);
    }

    #[test]
    fn more_than_u64_are_rejected() {
        let axis = |k| Varying { params: vec![k], values: Levels::Even { ends: [0.0, 1.0], count: 1 << 40 } };
        assert_eq!(Points::new(vec!["a".to_owned(), "b".to_owned()], vec![axis(0), axis(1)]), None);
    }

    fn sampled(method: Method, seed: Option<u64>) -> Vec<Vec<f64>> {
        let sample = Sampling::of(vec![[1.0, 2.0], [-3.0, -5.0]], 512, method, seed);
        all(&points(vec![Varying { params: vec![0, 1], values: Levels::Sampled(Box::new(sample)) }]))
    }

    #[test]
    fn samples_lie_within_their_ranges_and_seeds_differ() {
        for method in [Method::Sobol, Method::Random] {
            let seeded = |seed| sampled(method, Some(seed));
            assert_eq!(seeded(7), seeded(7));
            assert_ne!(seeded(7), seeded(8));
            for point in seeded(7) {
                assert!((1.0..2.0).contains(&point[0]) && (-5.0..=-3.0).contains(&point[1]), "{point:?}");
            }
            // each half of a range has about half of the points
            let below = seeded(7).iter().filter(|point| point[0] < 1.5).count();
            assert!((200..=312).contains(&below), "{below} of 512");
        }
        assert_eq!(sampled(Method::Sobol, None)[..3], [[1.0, -3.0], [1.5, -4.0], [1.75, -3.5]]);
    }

    /// Published results stay reproducible on every platform.
    #[test]
    fn random_points_are_stable() {
        let sample = sampled(Method::Random, None);
        assert_eq!(sample[0], [1.709_075_415_426_562, -3.931_843_444_579_220_3]);
        assert_eq!(sample[511], [1.158_953_054_000_719_4, -4.944_080_692_901_279]);
    }
}
