//! Deviations of measures and results that tolerances of params cause: estimates by derivatives, and what corner variants find.

use mechc_engine::sweep::round_to_15_digits;
use mechc_ir::layout::ColumnUnit;
use mechc_lang::model::quotient;

/// Derivatives agree with variants if the worst case differs by this fraction of it, or by this fraction of the value, whose last digits no
/// tolerance moves.
const LINEAR: f64 = 0.05;
const DIGITS: f64 = 1e-9;
/// Or by this fraction of the largest value of the same SI unit: a difference of such numbers has their rounding error.
const ROUNDING: f64 = 1e-12;

/// A param with a tolerance.
#[derive(Clone, PartialEq, Debug)]
pub struct Tolerance {
    /// Name.
    pub name: String,
    /// Nominal value (SI).
    pub nominal: f64,
    /// Least and largest deviation (SI).
    pub range: [f64; 2],
    /// SI unit; `1` for a pure number.
    pub si: String,
    /// Unit of the option, and its value in SI.
    pub unit: (String, f64),
}

impl Tolerance {
    /// Returns the least and the largest value (SI).
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        self.range.map(|off| round_to_15_digits(self.nominal + off))
    }

    /// Returns half of the range (SI).
    fn half(&self) -> f64 {
        0.5 * (self.range[1] - self.range[0])
    }

    /// Returns the least and the largest deviation of a value with this slope.
    #[must_use]
    pub fn times(&self, slope: f64) -> [f64; 2] {
        let [a, b] = self.range.map(|off| slope * off + 0.0);
        if a <= b { [a, b] } else { [b, a] }
    }
}

/// A measure or result, with its derivatives by the params that have tolerances.
#[derive(Clone, PartialEq, Debug)]
pub struct OutputSensitivity {
    /// Name.
    pub name: String,
    /// Time (s) at which a measure deviates most; `None` for results.
    pub at: Option<f64>,
    /// Value (SI); NaN if it has none.
    pub nominal: f64,
    /// Unit in which it is printed.
    pub unit: ColumnUnit,
    /// SI unit.
    pub si: String,
    /// For each tolerance, the derivative (SI), if it is known.
    pub slopes: Vec<Option<f64>>,
    /// Number of times at which a measure has a value and no derivatives, and number of all times. The first is 0 if a jump is the reason.
    pub unknown: [u64; 2],
    /// False if variants measure something else: it is differentiated by what a param follows, and they give that param a value of its own.
    pub is_verifiable: bool,
}

/// Deviations of a measure or result, least and largest each (SI).
#[derive(Clone, PartialEq, Debug)]
pub struct Deviation {
    /// Contribution of each tolerance.
    pub contributions: Vec<[f64; 2]>,
    /// Share of each tolerance in the variance, from 0 to 1.
    pub shares: Vec<f64>,
    /// All tolerances at their worst.
    pub worst: [f64; 2],
    /// Root of the sum of squares, around the middle.
    pub statistical: [f64; 2],
    /// Standard deviation.
    pub sigma: f64,
}

impl OutputSensitivity {
    /// Returns the deviations that tolerances cause; `None` if a derivative is unknown. A `normal` distribution has its range at 3 σ, otherwise it is
    /// uniform.
    #[must_use]
    pub fn deviation(&self, tolerances: &[Tolerance], normal: bool) -> Option<Deviation> {
        let slopes: Vec<f64> = self.slopes.iter().copied().collect::<Option<_>>()?;
        let of_each = || tolerances.iter().zip(&slopes);
        let contributions: Vec<[f64; 2]> = of_each().map(|(tolerance, &slope)| tolerance.times(slope)).collect();
        let square = |(tolerance, slope): (&Tolerance, &f64)| (slope * tolerance.half()) * (slope * tolerance.half());
        let squares: Vec<f64> = of_each().map(square).collect();
        let sum: f64 = squares.iter().sum();
        let worst = [0, 1].map(|end| contributions.iter().map(|range| range[end]).sum());
        let (middle, half) = (0.5 * (worst[0] + worst[1]), sum.sqrt());
        Some(Deviation {
            contributions,
            shares: squares.iter().map(|square| if sum > 0.0 { square / sum } else { 0.0 }).collect(),
            worst,
            statistical: [middle - half, middle + half],
            // a range of ±3 σ, or a uniform distribution
            sigma: if normal { half / 3.0 } else { half / 3.0_f64.sqrt() },
        })
    }

    /// Returns the unit for readers: its own, or, if that is SI, that of a tolerance with the same SI unit.
    #[must_use]
    pub fn display_unit(&self, tolerances: &[Tolerance]) -> DisplayUnit {
        let is_alike = |by: &&Tolerance| self.unit.text == self.si && by.si == self.si && self.si != "1";
        match tolerances.iter().find(is_alike) {
            Some(Tolerance { unit: (text, size), .. }) => DisplayUnit { text: text.clone(), size: *size },
            None => DisplayUnit::from_column(&self.unit),
        }
    }
}

/// A unit for readers.
#[derive(Clone, PartialEq, Debug)]
pub struct DisplayUnit {
    /// `mm`; `1` for a pure number.
    pub text: String,
    /// Value of the unit in SI.
    pub size: f64,
}

impl DisplayUnit {
    /// Returns the unit of a column.
    #[must_use]
    pub fn from_column(unit: &ColumnUnit) -> DisplayUnit {
        DisplayUnit { text: unit.text.clone(), size: 1.0 / unit.printed(1.0) }
    }

    /// Converts a derivative (SI) to this unit per unit of a tolerance; returns it with its unit.
    #[must_use]
    pub fn slope(&self, slope: f64, by: &Tolerance) -> (f64, String) {
        let (unit, size) = &by.unit;
        (slope * size / self.size, quotient(&self.text, unit))
    }
}

/// Deviations that variants have shown.
#[derive(Clone, PartialEq, Debug)]
pub struct CornerReport {
    /// Number of variants.
    pub variants: u64,
    /// True if they are all corners; if not, they are the worst corners by derivatives and a sample.
    pub are_all_corners: bool,
    /// For each measure or result, the largest nominal value of its SI unit among all and among the params (SI).
    pub largest: Vec<f64>,
    /// For each measure or result, its least and largest deviation (SI); `None` if no variant has a value.
    pub found: Vec<Option<[f64; 2]>>,
    /// For each measure or result, the number of complete variants without a value, and the settings of the first of them.
    pub missing: Vec<Option<(u64, Vec<String>)>>,
    /// Number of variants that did not complete on the nominal branch; settings and status of the first of them.
    pub lost: Option<(u64, Vec<String>, &'static str)>,
}

impl CornerReport {
    /// Returns the number of complete variants in which a measure or result has no value.
    #[must_use]
    pub fn missing(&self, k: usize) -> u64 {
        self.missing[k].as_ref().map_or(0, |(count, _)| *count)
    }

    /// Returns whether derivatives and variants agree on a measure or result.
    #[must_use]
    pub fn is_linear(&self, k: usize, output: &OutputSensitivity, deviation: &Deviation) -> bool {
        let [low, high] = deviation.worst;
        if self.missing(k) > 0 {
            return false;
        }
        let limit =
            LINEAR * f64::max(low.abs(), high.abs()) + DIGITS * output.nominal.abs() + ROUNDING * self.largest[k];
        self.found[k].is_some_and(|found| (found[0] - low).abs() <= limit && (found[1] - high).abs() <= limit)
    }
}
