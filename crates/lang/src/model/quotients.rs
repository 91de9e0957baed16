//! The units of derivatives by inputs and parameters, as they are written.

/// Powers of units are mostly whole numbers, to rounding.
const WHOLE: f64 = 1e-9;

/// The unit of a quotient: `mm/m`; `1` for no unit at all. An angle counts as a unit only where it cancels one.
#[must_use]
pub fn quotient(unit: &str, other: &str) -> String {
    let mut powers = factors(unit);
    for (name, power) in factors(other) {
        match powers.iter_mut().find(|(known, _)| *known == name) {
            Some((_, known)) => *known -= power,
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

/// The factors of a unit, as units are written: `m*rad/s^2`, `1/(m*s)`.
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
            match powers.iter_mut().find(|(known, _)| *known == name) {
                Some((_, known)) => *known += sign * power,
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
    fn what_is_alike_cancels() {
        for (unit, other, wanted) in [
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
            assert_eq!(quotient(unit, other), wanted, "{unit} by {other}");
        }
    }
}
