//! The units of derivatives by inputs and parameters.

/// Tolerance for rounding in the exponents of units, which are mostly whole numbers.
const WHOLE: f64 = 1e-9;

/// Returns the unit of a quotient, such as `mm/m`, or `1` if all units cancel. An angle counts as a unit only where it cancels one.
#[must_use]
pub fn quotient(unit: &str, other: &str) -> String {
    let mut powers = factors(unit);
    for (name, power) in factors(other) {
        match powers.iter_mut().find(|(factor, _)| *factor == name) {
            Some((_, exponent)) => *exponent -= power,
            None if name == "rad" => {}
            None => powers.push((name, -power)),
        }
    }
    let text =
        |name: &str, power: f64| if (power - 1.0).abs() < WHOLE { name.to_owned() } else { format!("{name}^{power}") };
    let above: Vec<String> =
        powers.iter().filter(|(_, power)| *power > WHOLE).map(|&(name, p)| text(name, p)).collect();
    let above = if above.is_empty() { "1".to_owned() } else { above.join("*") };
    powers.iter().filter(|(_, power)| *power < -WHOLE).fold(above, |all, &(name, p)| all + "/" + &text(name, -p))
}

/// Returns the factors of a unit, such as `m*rad/s^2` or `1/(m*s)`, with their exponents.
fn factors(unit: &str) -> Vec<(&str, f64)> {
    let mut powers: Vec<(&str, f64)> = Vec::new();
    let (mut sign, mut is_group) = (1.0, false);
    for factor in unit.split_inclusive(['*', '/']) {
        let name = factor.trim_end_matches(['*', '/']);
        is_group |= name.starts_with('(');
        let closes = name.ends_with(')');
        let (name, power) = match name.trim_matches(['(', ')']).split_once('^') {
            Some((name, power)) => (name, power.parse().unwrap_or(1.0)),
            None => (name.trim_matches(['(', ')']), 1.0),
        };
        if !matches!(name, "" | "1") {
            match powers.iter_mut().find(|(factor, _)| *factor == name) {
                Some((_, exponent)) => *exponent += sign * power,
                None => powers.push((name, sign * power)),
            }
        }
        is_group &= !closes;
        if !is_group {
            sign = if factor.ends_with('/') { -1.0 } else { 1.0 };
        }
    }
    powers
}

#[cfg(test)]
mod tests {
    use super::quotient;

    #[test]
    fn equal_units_cancel() {
        for (unit, other, expected) in [
            ("m", "m", "1"),
            ("mm", "m", "mm/m"),
            ("m/s", "m", "1/s"),
            ("1", "m", "1/m"),
            ("m", "1", "m"),
            ("rad/s^2", "rad", "1/s^2"),
            ("m/s", "rad/s", "m"),
            ("m*s", "m^2/(m*s)", "s^2"),
            ("1/(m*s)", "1/m", "1/s"),
            ("m^0.5", "m", "1/m^0.5"),
            ("mm", "/s", "mm*s"),
        ] {
            assert_eq!(quotient(unit, other), expected, "{unit} by {other}");
        }
    }
}
