//! Dimensions: powers of length and time. Angles are pure numbers.

/// `lengthᵃ · timeᵇ`; the powers may be fractions, as under a root.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Dimension {
    /// Power of length.
    pub length: f64,
    /// Power of time.
    pub time: f64,
}

impl Dimension {
    /// No dimension.
    pub const PURE: Dimension = Dimension { length: 0.0, time: 0.0 };
    /// A length.
    pub const LENGTH: Dimension = Dimension { length: 1.0, time: 0.0 };
    /// An area.
    pub const AREA: Dimension = Dimension { length: 2.0, time: 0.0 };
    /// A time.
    pub const TIME: Dimension = Dimension { length: 0.0, time: 1.0 };
    /// One over a time.
    pub const RATE: Dimension = Dimension { length: 0.0, time: -1.0 };

    /// Whether two are the same, fractions being only nearly equal.
    #[must_use]
    pub fn is(self, other: Dimension) -> bool {
        (self.length - other.length).abs() < 1e-9 && (self.time - other.time).abs() < 1e-9
    }

    /// Whether it is one.
    #[must_use]
    pub fn is_finite(self) -> bool {
        self.length.is_finite() && self.time.is_finite()
    }

    /// Of a product.
    #[must_use]
    pub fn times(self, other: Dimension) -> Dimension {
        Dimension { length: self.length + other.length, time: self.time + other.time }
    }

    /// Of a quotient.
    #[must_use]
    pub fn over(self, other: Dimension) -> Dimension {
        self.times(other.to_the(-1.0))
    }

    /// Of a power.
    #[must_use]
    pub fn to_the(self, power: f64) -> Dimension {
        Dimension { length: self.length * power, time: self.time * power }
    }

    /// In words: `a length`, `a speed`, or the unit.
    #[must_use]
    pub fn in_words(self) -> String {
        const WORDS: &[(f64, f64, &str)] = &[
            (0.0, 0.0, "a pure number"),
            (1.0, 0.0, "a length"),
            (0.0, 1.0, "a time"),
            (0.0, -1.0, "a rate (1/s)"),
            (0.0, -2.0, "an angular acceleration (1/s^2)"),
            (1.0, -1.0, "a speed (m/s)"),
            (1.0, -2.0, "an acceleration (m/s^2)"),
            (2.0, 0.0, "an area (m^2)"),
        ];
        WORDS
            .iter()
            .find(|&&(length, time, _)| self.is(Dimension { length, time }))
            .map_or_else(|| format!("a quantity in {}", self.unit()), |(.., words)| (*words).to_owned())
    }

    /// As [`Dimension::unit`], angles told from other pure numbers: `rad/s` for a turning speed.
    #[must_use]
    pub fn unit_of(self, is_angle: bool) -> String {
        let unit = self.unit();
        match unit.strip_prefix('1') {
            Some(rest) if is_angle => format!("rad{rest}"),
            _ => unit,
        }
    }

    /// As a product of SI units: `m^2/s`; `1` for a pure number.
    #[must_use]
    pub fn unit(self) -> String {
        let part = |unit: &str, power: f64| match power {
            p if (p - 1.0).abs() < 1e-9 => unit.to_owned(),
            p if (p - p.round()).abs() < 1e-9 => format!("{unit}^{}", p.round()),
            p => format!("{unit}^{p:.3}"),
        };
        let (mut above, mut below) = (Vec::new(), Vec::new());
        for (unit, power) in [("m", self.length), ("s", self.time)] {
            if power > 1e-9 {
                above.push(part(unit, power));
            } else if power < -1e-9 {
                below.push(part(unit, -power));
            }
        }
        let above = if above.is_empty() { "1".to_owned() } else { above.join("*") };
        match below.len() {
            0 => above,
            1 => format!("{above}/{}", below[0]),
            _ => format!("{above}/({})", below.join("*")),
        }
    }
}
