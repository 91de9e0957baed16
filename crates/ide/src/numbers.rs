//! Short formats of values with units, for display next to a text.

use mechc_text::diag::readable;
use mechc_text::vocabulary::CompoundUnit;

/// Formats a number to six digits.
pub(super) fn short(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    // −0 would surprise a reader
    readable(rounded + 0.0)
}

/// Formats a number with a unit; `1` stands for no unit.
pub(super) fn with_unit(value: f64, unit: &str) -> String {
    match unit {
        "" | "1" => short(value),
        // as in `60/s`
        unit if unit.starts_with("1/") => format!("{}{}", short(value), &unit[1..]),
        unit => format!("{} {unit}", short(value)),
    }
}

/// Formats an SI value in another unit; `None` if that unit is SI too.
pub(super) fn in_unit(si: f64, unit: &CompoundUnit) -> Option<String> {
    let scale = unit.scale();
    let is_si = scale.iter().all(|part| part.to_bits() == 1.0_f64.to_bits());
    (!is_si).then(|| with_unit(si / scale[0] * scale[1] / scale[2], &unit.per_second(0)))
}

/// Formats an angle (rad) in degrees.
pub(super) fn degrees(angle: f64) -> String {
    format!("{}°", short(angle.to_degrees()))
}

/// Formats a number with its sign: `+3`, `−2`, `±0`.
pub(super) fn signed(number: i64) -> String {
    let sign = match number {
        0 => "±",
        1.. => "+",
        _ => "−",
    };
    format!("{sign}{}", number.unsigned_abs())
}

#[cfg(test)]
mod tests {
    use super::{degrees, short, signed, with_unit};

    #[test]
    fn values_are_short() {
        assert_eq!(short(0.1 + 0.2), "0.3");
        assert_eq!(short(-0.0), "0");
        assert_eq!(short(1.0 / 3.0), "0.333333");
        assert_eq!(with_unit(0.05, "m"), "0.05 m");
        assert_eq!(with_unit(2.0, "1/s"), "2/s");
        assert_eq!(degrees(std::f64::consts::FRAC_PI_3), "60°");
        assert_eq!([3, -2, 0].map(signed), ["+3", "−2", "±0"]);
    }
}
