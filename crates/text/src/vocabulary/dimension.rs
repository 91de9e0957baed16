//! Dimensions: powers of length, time and mass. Angles are pure numbers, and are marked as angles.

/// Dimension `lengthᵃ · timeᵇ · massᶜ`, with the power of angles as a mark. Powers may be fractions, as under a root.
///
/// An angle is a pure number, and may be added to one. The mark decides units that are shown, and never whether dimensions agree.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Dimension {
    /// Power of length.
    pub length: f64,
    /// Power of time.
    pub time: f64,
    /// Power of mass.
    pub mass: f64,
    /// Power of angles: 1 for an angle or an angular velocity.
    pub angle: f64,
}

impl Dimension {
    /// Pure number.
    pub const PURE: Dimension = Dimension::new(0.0, 0.0, 0.0);
    /// Angle, which is a pure number.
    pub const ANGLE: Dimension = Dimension { angle: 1.0, ..Dimension::PURE };
    /// Length.
    pub const LENGTH: Dimension = Dimension::new(1.0, 0.0, 0.0);
    /// Curvature.
    pub const CURVATURE: Dimension = Dimension::new(-1.0, 0.0, 0.0);
    /// Area.
    pub const AREA: Dimension = Dimension::new(2.0, 0.0, 0.0);
    /// Time.
    pub const TIME: Dimension = Dimension::new(0.0, 1.0, 0.0);
    /// Inverse time.
    pub const RATE: Dimension = Dimension::new(0.0, -1.0, 0.0);
    /// Angular velocity, which is a rate.
    pub const ANGULAR_VELOCITY: Dimension = Dimension { angle: 1.0, ..Dimension::RATE };
    /// Speed.
    pub const SPEED: Dimension = Dimension::new(1.0, -1.0, 0.0);
    /// Acceleration.
    pub const ACCELERATION: Dimension = Dimension::new(1.0, -2.0, 0.0);
    /// Angular acceleration.
    pub const ANGULAR_ACCELERATION: Dimension = Dimension { angle: 1.0, ..Dimension::new(0.0, -2.0, 0.0) };
    /// Mass.
    pub const MASS: Dimension = Dimension::new(0.0, 0.0, 1.0);
    /// Moment of inertia.
    pub const INERTIA: Dimension = Dimension::new(2.0, 0.0, 1.0);
    /// Force.
    pub const FORCE: Dimension = Dimension::new(1.0, -2.0, 1.0);
    /// Energy or torque: a torque is an energy per radian, and a radian is the number 1.
    pub const ENERGY: Dimension = Dimension::new(2.0, -2.0, 1.0);
    /// Power.
    pub const POWER: Dimension = Dimension::new(2.0, -3.0, 1.0);
    /// Pressure.
    pub const PRESSURE: Dimension = Dimension::new(-1.0, -2.0, 1.0);

    const fn new(length: f64, time: f64, mass: f64) -> Dimension {
        Dimension { length, time, mass, angle: 0.0 }
    }

    /// Returns whether two dimensions are equal, fractions up to rounding. The powers of angles may differ.
    #[must_use]
    pub fn is(self, other: Dimension) -> bool {
        near(self.length, other.length) && near(self.time, other.time) && near(self.mass, other.mass)
    }

    /// Returns whether angles have the power 1, as in an angle and an angular velocity.
    #[must_use]
    pub fn is_angular(self) -> bool {
        near(self.angle, 1.0)
    }

    /// Returns whether it is that of an angle.
    #[must_use]
    pub fn is_angle(self) -> bool {
        self.is_angular() && self.is(Dimension::PURE)
    }

    /// Returns whether angles have the power 0.
    #[must_use]
    pub fn is_without_angles(self) -> bool {
        near(self.angle, 0.0)
    }

    /// Returns the dimension with the power of angles that a sum with a term of another dimension has: the greater one.
    #[must_use]
    pub fn marked_by(self, other: Dimension) -> Dimension {
        Dimension { angle: self.angle.max(other.angle), ..self }
    }

    /// Returns whether all powers are finite.
    #[must_use]
    pub fn is_finite(self) -> bool {
        [self.length, self.time, self.mass, self.angle].into_iter().all(f64::is_finite)
    }

    /// Returns the dimension of a product.
    #[must_use]
    pub fn times(self, other: Dimension) -> Dimension {
        Dimension {
            length: self.length + other.length,
            time: self.time + other.time,
            mass: self.mass + other.mass,
            angle: self.angle + other.angle,
        }
    }

    /// Returns the dimension of a quotient.
    #[must_use]
    pub fn over(self, other: Dimension) -> Dimension {
        self.times(other.to_the(-1.0))
    }

    /// Returns the dimension of a power.
    #[must_use]
    pub fn to_the(self, power: f64) -> Dimension {
        Dimension {
            length: self.length * power,
            time: self.time * power,
            mass: self.mass * power,
            angle: self.angle * power,
        }
    }

    /// Returns the dimension in words: `a length`, `a speed`, or else the unit.
    #[must_use]
    pub fn in_words(self) -> String {
        const WORDS: &[(Dimension, &str)] = &[
            (Dimension::PURE, "a pure number"),
            (Dimension::ANGLE, "an angle"),
            (Dimension::LENGTH, "a length"),
            (Dimension::TIME, "a time"),
            (Dimension::RATE, "a rate (1/s)"),
            (Dimension::ANGULAR_VELOCITY, "an angular velocity (rad/s)"),
            (Dimension::ANGULAR_ACCELERATION, "an angular acceleration (rad/s^2)"),
            (Dimension::SPEED, "a speed (m/s)"),
            (Dimension::ACCELERATION, "an acceleration (m/s^2)"),
            (Dimension::AREA, "an area (m^2)"),
            (Dimension::MASS, "a mass"),
            (Dimension::INERTIA, "a moment of inertia (kg*m^2)"),
            (Dimension::FORCE, "a force (N)"),
            (Dimension::ENERGY, "a torque or an energy (N*m)"),
            (Dimension::POWER, "a power (W)"),
            (Dimension::PRESSURE, "a pressure (Pa)"),
        ];
        let word = |same_mark: bool| {
            let fits = |other: Dimension| self.is(other) && (!same_mark || self.is_angular() == other.is_angular());
            WORDS.iter().find(|(dimension, _)| fits(*dimension)).map(|(_, word)| (*word).to_owned())
        };
        // an angle times a time is called a time
        word(true).or_else(|| word(false)).unwrap_or_else(|| format!("a quantity in {}", self.unit()))
    }

    /// Returns the unit as a product of SI units: `m^2/s`, or `1` for a pure number. Dimensions with mass and time use the newton, so that
    /// a torque is `N*m` and a stiffness `N/m`; a power is `W`, a mass and a moment of inertia use the kilogram.
    #[must_use]
    pub fn unit(self) -> String {
        if self.is(Dimension::POWER) {
            return "W".to_owned();
        }
        let newtons = self.over(Dimension::FORCE.to_the(self.mass));
        let has_force = self.mass.abs() > 1e-9 && self.time.abs() > 1e-9;
        if has_force {
            product(&[("N", self.mass), ("m", newtons.length), ("s", newtons.time)])
        } else {
            product(&[("kg", self.mass), ("m", self.length), ("s", self.time)])
        }
    }

    /// Returns [`Dimension::unit`] with `rad` for angles: `rad/s` for an angular velocity.
    #[must_use]
    pub fn display_unit(self) -> String {
        let unit = self.unit();
        match unit.strip_prefix('1') {
            Some(rest) if self.is_angular() => format!("rad{rest}"),
            _ => unit,
        }
    }
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

/// Formats a product of units with powers as `m^2/s`, or `1` if all powers are zero.
fn product(factors: &[(&str, f64)]) -> String {
    let part = |unit: &str, power: f64| match power {
        p if (p - 1.0).abs() < 1e-9 => unit.to_owned(),
        p if (p - p.round()).abs() < 1e-9 => format!("{unit}^{}", p.round()),
        // a power that only looks whole has all its digits
        p if (p - p.round()).abs() < 5e-4 => format!("{unit}^{p}"),
        p => format!("{unit}^{p:.3}"),
    };
    let (mut above, mut below) = (Vec::new(), Vec::new());
    for &(unit, power) in factors {
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
