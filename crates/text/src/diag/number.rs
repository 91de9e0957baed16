//! Numbers in a form for readers.

/// Formats a number as the shortest decimal that reads back to the same value, with an exponent if it is very large or small.
#[must_use]
pub fn readable(value: f64) -> String {
    let size = value.abs();
    let is_plain = size == 0.0 || (1e-4..1e10).contains(&size) || !value.is_finite();
    if is_plain { format!("{value}") } else { format!("{value:e}") }
}

#[cfg(test)]
mod tests {
    use super::readable;
    use proptest::prelude::*;

    #[test]
    fn zeros_are_not_written_out() {
        let cases = [
            (0.0, "0"),
            (-2.5, "-2.5"),
            (1e-300, "1e-300"),
            (-1.5e300, "-1.5e300"),
            (1e-4, "0.0001"),
            (1e9, "1000000000"),
        ];
        for (value, text) in cases {
            assert_eq!(readable(value), text);
        }
    }

    proptest! {
        #[test]
        fn every_number_reads_back_and_is_short(value in prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL) {
            let text = readable(value);
            prop_assert_eq!(text.parse::<f64>().unwrap().to_bits(), value.to_bits());
            prop_assert!(text.len() <= 25, "{}", text);
        }
    }
}
