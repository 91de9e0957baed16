//! The units of the language.

use crate::model::Dimension;
use std::f64::consts::{PI, TAU};

/// A unit: `numerator / denominator · factor` in SI, so that `50 mm` is 50/1000 m rounded once, and `90 deg` half of π.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Unit {
    pub name: &'static str,
    numerator: f64,
    denominator: f64,
    factor: f64,
    pub dimension: Dimension,
}

const fn unit(name: &'static str, numerator: f64, denominator: f64, dimension: Dimension) -> Unit {
    Unit { name, numerator, denominator, factor: 1.0, dimension }
}

/// A unit of angle or rate: so many of `factor` in each `denominator`.
const fn turning(name: &'static str, factor: f64, denominator: f64, dimension: Dimension) -> Unit {
    Unit { name, numerator: 1.0, denominator, factor, dimension }
}

const UNITS: &[Unit] = &[
    unit("m", 1.0, 1.0, Dimension::LENGTH),
    unit("mm", 1.0, 1e3, Dimension::LENGTH),
    unit("cm", 1.0, 1e2, Dimension::LENGTH),
    unit("um", 1.0, 1e6, Dimension::LENGTH),
    unit("µm", 1.0, 1e6, Dimension::LENGTH),
    unit("km", 1e3, 1.0, Dimension::LENGTH),
    unit("in", 254.0, 1e4, Dimension::LENGTH),
    unit("ft", 3048.0, 1e4, Dimension::LENGTH),
    unit("rad", 1.0, 1.0, Dimension::PURE),
    turning("deg", PI, 180.0, Dimension::PURE),
    turning("rev", TAU, 1.0, Dimension::PURE),
    unit("s", 1.0, 1.0, Dimension::TIME),
    unit("ms", 1.0, 1e3, Dimension::TIME),
    unit("us", 1.0, 1e6, Dimension::TIME),
    unit("µs", 1.0, 1e6, Dimension::TIME),
    turning("rpm", TAU, 60.0, Dimension::RATE),
];

impl Unit {
    /// The unit of a name; the Greek letter mu serves for the micro sign.
    pub fn named(name: &str) -> Option<&'static Unit> {
        let name = name.replace('μ', "µ");
        UNITS.iter().find(|unit| unit.name == name)
    }

    /// All names.
    pub fn names() -> impl Iterator<Item = &'static str> {
        UNITS.iter().map(|unit| unit.name)
    }

    /// `value` in this unit to a power, in SI.
    pub fn to_si(self, value: f64, power: i32) -> f64 {
        (0..power.abs()).fold(value, |v, _| {
            if power > 0 {
                v * self.numerator / self.denominator * self.factor
            } else {
                v * self.denominator / self.numerator / self.factor
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Unit;

    #[test]
    #[allow(clippy::float_cmp)] // to the bit
    fn conversions_round_once() {
        let si = |value, unit: &str, power| Unit::named(unit).unwrap().to_si(value, power);
        assert_eq!(si(50.0, "mm", 1), 0.05);
        assert_eq!(si(50.0, "mm", 2), 50e-6);
        assert_eq!(si(1.0, "in", 1), 0.0254);
        assert_eq!(si(180.0, "deg", 1), std::f64::consts::PI);
        assert_eq!(si(60.0, "rpm", 1), std::f64::consts::TAU);
        assert_eq!(si(30.0, "s", -1), 30.0);
        assert_eq!(si(7.0, "μm", 1), 7e-6, "the Greek letter serves too");
    }
}
