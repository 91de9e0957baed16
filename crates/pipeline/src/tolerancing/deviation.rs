//! How far measures and results are off where params are: what tolerances make of derivatives, and what was found by trying.

use mechc_engine::sweep::rounded;
use mechc_ir::layout::ColumnUnit;
use mechc_lang::model::quotient;

/// What derivatives say is enough, if the worst case is off by no more than this part of it; or this part of the value, whose last digits no
/// tolerance moves.
const LINEAR: f64 = 0.05;
const DIGITS: f64 = 1e-9;
/// Or of the largest that is of its SI unit: what is a difference of such numbers is off by their rounding.
const ROUNDING: f64 = 1e-12;

/// A param that may be off.
#[derive(Clone, PartialEq, Debug)]
pub struct Tolerance {
    /// Its name.
    pub name: String,
    /// Its value (SI).
    pub nominal: f64,
    /// How far it may be off, from and to (SI).
    pub range: [f64; 2],
    /// The SI unit; `1` for a pure number.
    pub si: String,
    /// The unit of the option, and how much of SI that is.
    pub unit: (String, f64),
}

impl Tolerance {
    /// Its least and its largest value (SI).
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        self.range.map(|off| rounded(self.nominal + off))
    }

    /// Half of the range (SI).
    fn half(&self) -> f64 {
        0.5 * (self.range[1] - self.range[0])
    }

    /// What a slope makes of it, from the least to the largest.
    #[must_use]
    pub fn times(&self, slope: f64) -> [f64; 2] {
        let [a, b] = self.range.map(|off| slope * off + 0.0);
        if a <= b { [a, b] } else { [b, a] }
    }
}

/// A measure or result, and how it goes with what may be off.
#[derive(Clone, PartialEq, Debug)]
pub struct Affected {
    /// Its name.
    pub name: String,
    /// The time (s) at which a measure deviates the most; results are of the whole analysis.
    pub at: Option<f64>,
    /// Its value (SI); no number where it has none.
    pub nominal: f64,
    /// The unit that it is told in.
    pub unit: ColumnUnit,
    /// The SI unit of its value.
    pub si: String,
    /// By tolerance: its derivative (SI); nothing where none is known.
    pub slopes: Vec<Option<f64>>,
    /// At so many of so many times it has a value and no derivatives; none of them where one is not known because of a jump.
    pub unknown: [u64; 2],
}

/// What tolerances make of a measure or result, each from the least to the largest (SI).
#[derive(Clone, PartialEq, Debug)]
pub struct Deviation {
    /// By tolerance.
    pub contributions: Vec<[f64; 2]>,
    /// By tolerance: its part of the variance, from 0 to 1.
    pub shares: Vec<f64>,
    /// All at their worst.
    pub worst: [f64; 2],
    /// The root of the sum of squares, around the middle.
    pub statistical: [f64; 2],
    /// The standard deviation.
    pub sigma: f64,
}

impl Affected {
    /// What the tolerances make of it; nothing where a derivative is not known.
    #[must_use]
    pub fn deviation(&self, tolerances: &[Tolerance], normal: bool) -> Option<Deviation> {
        let slopes: Vec<f64> = self.slopes.iter().copied().collect::<Option<_>>()?;
        let of_each = || tolerances.iter().zip(&slopes);
        let contributions: Vec<[f64; 2]> = of_each().map(|(of, &slope)| of.times(slope)).collect();
        let square = |(of, slope): (&Tolerance, &f64)| (slope * of.half()) * (slope * of.half());
        let squares: Vec<f64> = of_each().map(square).collect();
        let sum: f64 = squares.iter().sum();
        let worst = [0, 1].map(|end| contributions.iter().map(|of| of[end]).sum());
        let (middle, half) = (0.5 * (worst[0] + worst[1]), sum.sqrt());
        Some(Deviation {
            contributions,
            shares: squares.iter().map(|square| if sum > 0.0 { square / sum } else { 0.0 }).collect(),
            worst,
            statistical: [middle - half, middle + half],
            // a third of the way to the end, or that of what is anywhere within alike
            sigma: if normal { half / 3.0 } else { half / 3.0_f64.sqrt() },
        })
    }

    /// The unit in which it is told to a reader: its own, or, where that is SI, that of a tolerance of the same kind.
    #[must_use]
    pub fn to_be_read(&self, tolerances: &[Tolerance]) -> Shown {
        let is_alike = |by: &&Tolerance| self.unit.text == self.si && by.si == self.si && self.si != "1";
        match tolerances.iter().find(is_alike) {
            Some(Tolerance { unit: (text, size), .. }) => Shown { text: text.clone(), size: *size },
            None => Shown::of(&self.unit),
        }
    }
}

/// A unit that something is told in.
#[derive(Clone, PartialEq, Debug)]
pub struct Shown {
    /// `mm`; `1` for a pure number.
    pub text: String,
    /// How much of SI it is.
    pub size: f64,
}

impl Shown {
    /// The unit of a column.
    #[must_use]
    pub fn of(unit: &ColumnUnit) -> Shown {
        Shown { text: unit.text.clone(), size: 1.0 / unit.printed(1.0) }
    }

    /// A derivative (SI) by a tolerance in that unit and the tolerance's, and what that makes.
    #[must_use]
    pub fn slope(&self, slope: f64, by: &Tolerance) -> (f64, String) {
        let (unit, size) = &by.unit;
        (slope * size / self.size, quotient(&self.text, unit))
    }
}

/// What was found by running it with params that are off.
#[derive(Clone, PartialEq, Debug)]
pub struct Verified {
    /// So many variants were run.
    pub variants: u64,
    /// So many of them are all corners; if not, they are a sample with some of these.
    pub are_all_corners: bool,
    /// By measure or result: the largest nominal value of its SI unit among all, and among what may be off (SI).
    pub largest: Vec<f64>,
    /// By measure or result: how far it was off, from the least to the largest (SI); nothing where no variant has a value.
    pub found: Vec<Option<[f64; 2]>>,
    /// By measure or result: so many that came to their end have no value of it, if there are any; and what sets the first of them.
    pub missing: Vec<Option<(u64, Vec<String>)>>,
    /// So many did not come to their end on the branch of the nominal one; and what sets the first of them, with its status.
    pub lost: Option<(u64, Vec<String>, &'static str)>,
}

impl Verified {
    /// In how many variants that came to their end a measure or result has no value.
    #[must_use]
    pub fn missing(&self, k: usize) -> u64 {
        self.missing[k].as_ref().map_or(0, |(count, _)| *count)
    }

    /// Whether what derivatives say of a measure or result is near enough to what was found.
    #[must_use]
    pub fn is_linear(&self, k: usize, of: &Affected, deviation: &Deviation) -> bool {
        let [low, high] = deviation.worst;
        if self.missing(k) > 0 {
            return false;
        }
        let limit = LINEAR * f64::max(low.abs(), high.abs()) + DIGITS * of.nominal.abs() + ROUNDING * self.largest[k];
        self.found[k].is_some_and(|found| (found[0] - low).abs() <= limit && (found[1] - high).abs() <= limit)
    }
}
