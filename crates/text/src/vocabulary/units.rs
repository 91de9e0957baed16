//! Units of the language.

use super::{Category, Dimension, Example, Word};
use std::f64::consts::{PI, TAU};

/// A unit, whose value in SI is `numerator / denominator · factor`: `50 mm` is 50/1000 m rounded once, and `90 deg` is half of π.
#[derive(Debug)]
pub struct Unit {
    /// Documentation.
    pub word: Word,
    numerator: f64,
    denominator: f64,
    factor: f64,
    /// Dimension of quantities in this unit.
    pub dimension: Dimension,
}

const fn word(name: &'static str, form: &'static [&'static str], meaning: &'static str, example: &'static str) -> Word {
    Word { name, category: Category::Unit, forms: form, letters: "", meaning, more: "", example: Example::Arm(example) }
}

const fn length(
    name: &'static str,
    form: &'static [&'static str],
    meaning: &'static str,
    numerator: f64,
    denominator: f64,
    example: &'static str,
) -> Unit {
    let dimension = Dimension::LENGTH;
    Unit { word: word(name, form, meaning, example), numerator, denominator, factor: 1.0, dimension }
}

const fn time(
    name: &'static str,
    form: &'static [&'static str],
    meaning: &'static str,
    denominator: f64,
    example: &'static str,
) -> Unit {
    let dimension = Dimension::TIME;
    Unit { word: word(name, form, meaning, example), numerator: 1.0, denominator, factor: 1.0, dimension }
}

/// Creates a unit of angle or rate, `factor / denominator` in SI.
const fn angular(word: Word, factor: f64, denominator: f64, dimension: Dimension) -> Unit {
    Unit { word, numerator: 1.0, denominator, factor, dimension }
}

/// Creates a unit of a quantity with mass.
const fn dynamic(
    name: &'static str,
    form: &'static [&'static str],
    meaning: &'static str,
    [numerator, denominator]: [f64; 2],
    dimension: Dimension,
    example: &'static str,
) -> Unit {
    let word = Word { example: Example::Whole(example), ..word(name, form, meaning, "") };
    Unit { word, numerator, denominator, factor: 1.0, dimension }
}

/// Example of an arm with a mass, and a measure.
macro_rules! weighing {
    ($mass:literal, $measure:literal) => {
        concat!(
            "\
ground { point O = (0, 0) }
body arm {
    point O   = (0, 0)
    point tip = (80 mm, 0)
    mass ",
            $mass,
            " at (40 mm, 0)
}
gravity (0, -9.81 m/s^2)
joint main: revolute(ground.O, arm.O)
driver motor: rotation(main) = 60 rpm * t
measure ",
            $measure
        )
    };
}

/// Example of a piston under pressure.
macro_rules! pressed {
    ($pressure:literal) => {
        concat!(
            "\
ground { axis way = (0, 0) along (1, 0) }
body piston {
    axis way = (0, 0) along (1, 0)
    mass 0.5 kg
}
joint guide: translational(ground.way, piston.way)
driver move: displacement(guide) = 50 mm + 20 mm/s * t
load gas: -20 cm^2 * ",
            $pressure,
            " on displacement(guide)
measure push = effort(move) in N"
        )
    };
}

/// All units.
pub static UNITS: &[Unit] = &[
    length("m", &["1.5 m"], "the metre", 1.0, 1.0, "measure beyond = x(arm.tip) - 0.05 m"),
    length("mm", &["50 mm"], "the millimetre", 1.0, 1e3, "measure beyond = x(arm.tip) - 50 mm"),
    length("cm", &["5 cm"], "the centimetre", 1.0, 1e2, "measure beyond = x(arm.tip) - 5 cm"),
    length("um", &["20 um"], "the micrometre", 1.0, 1e6, "measure beyond = x(arm.tip) - 500 um"),
    length(
        "µm",
        &["20 µm"],
        "the micrometre; with the Greek letter or the micro sign, and also `um`",
        1.0,
        1e6,
        "measure beyond = x(arm.tip) - 500 µm",
    ),
    length("km", &["2 km"], "the kilometre", 1e3, 1.0, "measure beyond = x(arm.tip) - 0.001 km"),
    length("in", &["2 in"], "the inch, 25.4 mm", 254.0, 1e4, "measure beyond = x(arm.tip) - 2 in"),
    length("ft", &["3 ft"], "the foot, 12 inches", 3048.0, 1e4, "measure beyond = x(arm.tip) - 0.1 ft"),
    angular(
        word("rad", &["2 rad"], "the radian, which is the pure number 1", "driver motor: rotation(main) = 2 rad/s * t"),
        1.0,
        1.0,
        Dimension::ANGLE,
    ),
    angular(
        word(
            "mrad",
            &["5 mrad"],
            "the milliradian, which is the pure number 0.001",
            "driver motor: rotation(main) = 5 mrad * sin(2 rad/s * t)",
        ),
        1.0,
        1e3,
        Dimension::ANGLE,
    ),
    angular(
        word(
            "deg",
            &["30 deg"],
            "the degree, π/180: an angle is a pure number",
            "driver motor: rotation(main) = 30 deg + 90 deg/s * t",
        ),
        PI,
        180.0,
        Dimension::ANGLE,
    ),
    angular(
        word(
            "rev",
            &["0.5 rev"],
            "the revolution, 2π: an angle is a pure number",
            "driver motor: rotation(main) = 0.5 rev/s * t",
        ),
        TAU,
        1.0,
        Dimension::ANGLE,
    ),
    time("s", &["2 s"], "the second", 1.0, "analysis from 0 s to 2 s every 0.01 s"),
    time("ms", &["10 ms"], "the millisecond", 1e3, "analysis from 0 s to 2 s every 10 ms"),
    time("us", &["200 us"], "the microsecond", 1e6, "analysis from 0 s to 2 s every 200 us"),
    time(
        "µs",
        &["200 µs"],
        "the microsecond; with the Greek letter or the micro sign, and also `us`",
        1e6,
        "analysis from 0 s to 2 s every 200 µs",
    ),
    angular(
        word(
            "Hz",
            &["5 Hz"],
            "the hertz, 1 per second; a turning speed is in `rpm` or `rev/s`",
            "driver motor: rotation(main) = 30 deg * sin(2 * pi * 5 Hz * t)",
        ),
        1.0,
        1.0,
        Dimension::RATE,
    ),
    angular(
        word(
            "rpm",
            &["60 rpm"],
            "the revolution per minute, 2π/60 per second",
            "driver motor: rotation(main) = 60 rpm * t",
        ),
        TAU,
        60.0,
        Dimension::ANGULAR_VELOCITY,
    ),
    dynamic(
        "kg",
        &["5 kg"],
        "the kilogram",
        [1.0, 1.0],
        Dimension::MASS,
        weighing!("0.8 kg", "torque = effort(motor)"),
    ),
    dynamic(
        "lbm",
        &["2 lbm"],
        "the pound, 0.45359237 kg",
        [45_359_237.0, 1e8],
        Dimension::MASS,
        weighing!("2 lbm", "torque = effort(motor)"),
    ),
    dynamic(
        "N",
        &["20 N"],
        "the newton, 1 kg·m/s²; a torque is in `N*m`",
        [1.0, 1.0],
        Dimension::FORCE,
        weighing!("0.8 kg", "bearing = hypot(force_x(main), force_y(main)) in N"),
    ),
    dynamic(
        "kN",
        &["2 kN"],
        "the kilonewton",
        [1e3, 1.0],
        Dimension::FORCE,
        weighing!("800 kg", "bearing = force_y(main) in kN"),
    ),
    dynamic(
        "lbf",
        &["5 lbf"],
        "the pound-force, 4.4482216152605 N",
        [44_482_216_152_605.0, 1e13],
        Dimension::FORCE,
        weighing!("2 lbm", "bearing = force_y(main) in lbf"),
    ),
    dynamic(
        "J",
        &["5 J"],
        "the joule, 1 N·m of work; a torque is in `N*m`",
        [1.0, 1.0],
        Dimension::ENERGY,
        weighing!("0.8 kg", "work = effort(motor) * rotation(main) in J"),
    ),
    dynamic(
        "W",
        &["60 W"],
        "the watt, 1 J/s",
        [1.0, 1.0],
        Dimension::POWER,
        weighing!("0.8 kg", "power = effort(motor) * der(rotation(main)) in W"),
    ),
    dynamic(
        "kW",
        &["2 kW"],
        "the kilowatt",
        [1e3, 1.0],
        Dimension::POWER,
        weighing!("80 kg", "power = effort(motor) * der(rotation(main)) in kW"),
    ),
    dynamic("Pa", &["500 Pa"], "the pascal, 1 N/m²", [1.0, 1.0], Dimension::PRESSURE, pressed!("500 Pa")),
    dynamic("kPa", &["100 kPa"], "the kilopascal", [1e3, 1.0], Dimension::PRESSURE, pressed!("100 kPa")),
    dynamic("MPa", &["1.6 MPa"], "the megapascal, 1 N/mm²", [1e6, 1.0], Dimension::PRESSURE, pressed!("1.6 MPa")),
    dynamic("bar", &["2 bar"], "the bar, 100 kPa", [1e5, 1.0], Dimension::PRESSURE, pressed!("2 bar")),
];

/// Prefixes of decimal multiples, with their factors.
const PREFIXES: [(&str, &str); 8] = [
    ("n", "1e-9"),
    ("u", "1e-6"),
    ("µ", "1e-6"),
    ("m", "0.001"),
    ("da", "10"),
    ("k", "1000"),
    ("M", "1e6"),
    ("G", "1e9"),
];

/// Units that take prefixes elsewhere.
const DIVIDED: [&str; 6] = ["s", "N", "J", "W", "Pa", "Hz"];

impl Unit {
    /// Returns the unit of a name. The Greek letter mu counts as the micro sign.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Unit> {
        let name = name.replace('μ', "µ");
        UNITS.iter().find(|unit| unit.word.name == name)
    }

    /// Returns the value of a prefixed unit that is not in the language, in its base unit: `0.001 N` for `mN`.
    #[must_use]
    pub fn prefixed_value(name: &str) -> Option<String> {
        PREFIXES.iter().find_map(|(prefix, factor)| {
            let unit = Unit::named(name.strip_prefix(prefix)?)?;
            DIVIDED.contains(&unit.word.name).then(|| format!("{factor} {}", unit.word.name))
        })
    }

    /// Returns all names.
    pub fn names() -> impl Iterator<Item = &'static str> {
        UNITS.iter().map(|unit| unit.word.name)
    }

    /// Converts a value in a power of this unit to SI.
    #[must_use]
    pub fn to_si(&self, value: f64, power: i32) -> f64 {
        (0..power.abs()).fold(value, |v, _| {
            if power > 0 {
                v * self.numerator / self.denominator * self.factor
            } else {
                v * self.denominator / self.numerator / self.factor
            }
        })
    }
}

/// Units with powers, joined by `*` and `/`: `mm/s^2`.
#[derive(Clone, Debug)]
pub struct CompoundUnit {
    /// Factors as written; those after a `/` have negative powers.
    factors: Vec<(&'static Unit, i32)>,
}

impl CompoundUnit {
    /// Creates a product of units with powers.
    #[must_use]
    pub fn new(factors: Vec<(&'static Unit, i32)>) -> CompoundUnit {
        CompoundUnit { factors }
    }

    /// Returns the units with their powers, in order.
    pub fn factors(&self) -> impl Iterator<Item = (&'static Unit, i32)> {
        self.factors.iter().copied()
    }

    /// Returns the dimension of quantities in this unit.
    #[must_use]
    pub fn dimension(&self) -> Dimension {
        let powers = self.factors.iter().map(|(unit, power)| unit.dimension.to_the(f64::from(*power)));
        powers.fold(Dimension::PURE, Dimension::times)
    }

    /// Converts a value to SI.
    #[must_use]
    pub fn to_si(&self, value: f64) -> f64 {
        self.factors.iter().fold(value, |value, (unit, power)| unit.to_si(value, *power))
    }

    /// Returns the conversion from SI to this unit: a divisor, a factor and a divisor, in this order. So 2π per second is exactly 60 rpm,
    /// and 25.4 mm is one inch.
    #[must_use]
    pub fn scale(&self) -> [f64; 3] {
        let mut scale = [1.0; 3];
        for (unit, power) in &self.factors {
            let numerator = unit.numerator * unit.factor;
            // a factor that is not an integer is divided first
            let divisor = if numerator.fract() == 0.0 { 2 } else { 0 };
            for _ in 0..power.abs() {
                if *power > 0 {
                    scale[divisor] *= numerator;
                    scale[1] *= unit.denominator;
                } else {
                    scale[1] *= numerator;
                    scale[2] *= unit.denominator;
                }
            }
        }
        scale
    }

    /// Returns this unit per second to the power `times`: `mm/s^2` for `mm/s`.
    #[must_use]
    pub fn per_second(&self, times: i32) -> String {
        let mut factors: Vec<(&str, i32)> = self.factors.iter().map(|(unit, power)| (unit.word.name, *power)).collect();
        match factors.iter_mut().find(|(unit, _)| *unit == "s") {
            Some((_, power)) => *power -= times,
            None => factors.push(("s", -times)),
        }
        factors.retain(|(_, power)| *power != 0);
        product(&factors)
    }
}

/// Formats a product as `mm/s^2`, or `1` without factors.
fn product(factors: &[(&str, i32)]) -> String {
    let to_the = |(unit, power): (&str, i32)| if power == 1 { unit.to_owned() } else { format!("{unit}^{power}") };
    let above: Vec<String> = factors.iter().filter(|(_, power)| *power > 0).map(|factor| to_the(*factor)).collect();
    let below = factors.iter().filter(|(_, power)| *power < 0);
    let above = if above.is_empty() { "1".to_owned() } else { above.join("*") };
    below.fold(above, |text, (unit, power)| text + "/" + &to_the((unit, -power)))
}

#[cfg(test)]
mod tests {
    use super::{CompoundUnit, Unit};

    fn compound(factors: &[(&str, i32)]) -> CompoundUnit {
        CompoundUnit::new(factors.iter().map(|(name, power)| (Unit::named(name).unwrap(), *power)).collect())
    }

    #[test]
    #[allow(clippy::float_cmp)] // to the bit
    fn unit_values_are_rounded_once() {
        let printed = |si: f64, factors: &[(&str, i32)]| {
            let [first, multiply, last] = compound(factors).scale();
            si / first * multiply / last
        };
        assert_eq!(printed(0.05, &[("mm", 1)]), 50.0);
        assert_eq!(printed(0.05, &[("mm", 1), ("s", -1)]), 50.0);
        assert_eq!(printed(std::f64::consts::PI, &[("deg", 1)]), 180.0);
        assert_eq!(printed(std::f64::consts::TAU, &[("rpm", 1)]), 60.0);
        assert_eq!(printed(50e-6, &[("mm", 2)]), 50.0);
        assert_eq!(printed(20.0, &[("m", -1)]), 20.0);
        assert_eq!(printed(20.0, &[("mm", -1)]), 0.02);
        assert_eq!(printed(0.0254, &[("in", 1)]), 1.0);
    }

    #[test]
    fn the_unit_of_a_derivative_is_per_second() {
        let texts = |factors: &[(&str, i32)]| [0, 1, 2].map(|times| compound(factors).per_second(times));
        assert_eq!(texts(&[("mm", 1)]), ["mm", "mm/s", "mm/s^2"]);
        assert_eq!(texts(&[("mm", 1), ("s", -1)]), ["mm/s", "mm/s^2", "mm/s^3"]);
        assert_eq!(texts(&[("ms", 1)]), ["ms", "ms/s", "ms/s^2"]);
        assert_eq!(texts(&[("s", 1)]), ["s", "1", "1/s"]);
        assert_eq!(texts(&[("rpm", 1)]), ["rpm", "rpm/s", "rpm/s^2"]);
        assert_eq!(texts(&[("s", -2), ("m", 2)]), ["m^2/s^2", "m^2/s^3", "m^2/s^4"]);
    }

    #[test]
    #[allow(clippy::float_cmp)] // to the bit
    fn conversions_round_once() {
        let si = |value, unit: &str, power| Unit::named(unit).unwrap().to_si(value, power);
        assert_eq!(si(50.0, "mm", 1), 0.05);
        assert_eq!(si(50.0, "mm", 2), 50e-6);
        assert_eq!(si(1.0, "in", 1), 0.0254);
        assert_eq!(si(180.0, "deg", 1), std::f64::consts::PI);
        assert_eq!(si(60.0, "rpm", 1), std::f64::consts::TAU);
        assert_eq!(si(50.0, "Hz", 1), 50.0);
        assert_eq!(si(5.0, "mrad", 1), 0.005);
        assert_eq!(si(30.0, "s", -1), 30.0);
        assert_eq!(si(2.0, "lbm", 1), 0.907_184_74);
        assert_eq!(si(1.0, "lbf", 1), 4.448_221_615_260_5);
        assert_eq!(si(1.6, "MPa", 1), 1.6e6);
        assert_eq!(si(2.0, "bar", 1), 2e5);
        assert_eq!(si(7.0, "μm", 1), 7e-6, "the Greek letter serves too");
    }
}
