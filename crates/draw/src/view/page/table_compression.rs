//! Lossless compression of tables for pages.
//!
//! Each number is mapped to an integer in the order of the reals. Stored is its difference from a prediction, the polynomial through the
//! last K values, which is small near a smooth curve. Differences are written zigzag (0, -1, 1, -2, …) and in planes: for each column first
//! all highest bytes, then all second ones, and so on. K of each column comes first, and everything is deflated.
//!
//! Predictions use nothing but sums and products, in an order that `page/src/data/inflate.ts` repeats, which gives the same bits there.

/// Greatest order of prediction.
const GREATEST_ORDER: usize = 8;
/// (-1)^(j+1) · (K over j), by K and j - 1: factors of the last value, the one before it, and so on.
const WEIGHTS: [[f64; GREATEST_ORDER]; GREATEST_ORDER + 1] = [
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [2.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0, -3.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [4.0, -6.0, 4.0, -1.0, 0.0, 0.0, 0.0, 0.0],
    [5.0, -10.0, 10.0, -5.0, 1.0, 0.0, 0.0, 0.0],
    [6.0, -15.0, 20.0, -15.0, 6.0, -1.0, 0.0, 0.0],
    [7.0, -21.0, 35.0, -35.0, 21.0, -7.0, 1.0, 0.0],
    [8.0, -28.0, 56.0, -70.0, 56.0, -28.0, 8.0, -1.0],
];
/// Compression level of deflate, of 10.
const EFFORT: u8 = 9;

/// Compresses a table with columns of equal length and returns it as Base64.
pub(super) fn compress(columns: &[Vec<f64>]) -> String {
    super::base64::encode(&miniz_oxide::deflate::compress_to_vec(&planes(columns), EFFORT))
}

/// Returns the bytes before compression.
fn planes(columns: &[Vec<f64>]) -> Vec<u8> {
    let rows = columns.first().map_or(0, Vec::len);
    let mut bytes = vec![0; columns.len()];
    bytes.reserve(8 * rows * columns.len());
    let (mut smallest, mut candidate) = (Vec::with_capacity(rows), Vec::with_capacity(rows));
    for (k, column) in columns.iter().enumerate() {
        let mut least = u64::MAX;
        for order in 0..=GREATEST_ORDER {
            let cost = differences(column, order, &mut candidate);
            if cost < least {
                least = cost;
                bytes[k] = order as u8;
                std::mem::swap(&mut smallest, &mut candidate);
            }
        }
        for plane in (0..8).rev() {
            bytes.extend(smallest.iter().map(|zigzag| (zigzag >> (8 * plane)) as u8));
        }
    }
    bytes
}

/// Computes the zigzag differences from the predictions, and returns the number of bits that they take.
fn differences(column: &[f64], order: usize, zigzags: &mut Vec<u64>) -> u64 {
    zigzags.clear();
    let mut bits = 0;
    for (row, &value) in column.iter().enumerate() {
        let difference = ordered(value).wrapping_sub(ordered(predict(&column[..row], order))).cast_signed();
        let zigzag = (difference << 1 ^ difference >> 63).cast_unsigned();
        bits += u64::from(64 - zigzag.leading_zeros());
        zigzags.push(zigzag);
    }
    bits
}

/// Returns the value of the polynomial through the last `order` values, or through all of them if there are fewer; 0 if it is not finite.
fn predict(before: &[f64], order: usize) -> f64 {
    let order = order.min(before.len());
    let mut sum = 0.0;
    for (weight, value) in WEIGHTS[order][..order].iter().zip(before.iter().rev()) {
        sum += weight * value;
    }
    if sum.is_finite() { sum } else { 0.0 }
}

/// Maps a number to an integer; the order of the integers is that of the reals.
fn ordered(value: f64) -> u64 {
    // all NaNs become one: their payloads have no meaning
    let bits = if value.is_nan() { f64::NAN.to_bits() & !(1 << 63) } else { value.to_bits() };
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

#[cfg(test)]
mod tests {
    use super::{WEIGHTS, planes, predict};
    use proptest::prelude::*;

    /// Reads the columns from the planes, slowly and plainly.
    fn read(bytes: &[u8], rows: usize, columns: usize) -> Vec<Vec<f64>> {
        let column = |k: usize| {
            let planes = &bytes[columns + 8 * rows * k..];
            let mut values: Vec<f64> = Vec::new();
            for row in 0..rows {
                let zigzag = (0..8).fold(0, |bits: u64, plane| bits << 8 | u64::from(planes[plane * rows + row]));
                let difference = if zigzag & 1 == 1 { !(zigzag >> 1) } else { zigzag >> 1 };
                let from = predict(&values, usize::from(bytes[k])).to_bits();
                let from = if from >> 63 == 1 { !from } else { from | 1 << 63 };
                let ordered = from.wrapping_add(difference);
                values.push(f64::from_bits(if ordered >> 63 == 1 { ordered & !(1 << 63) } else { !ordered }));
            }
            values
        };
        (0..columns).map(column).collect()
    }

    fn bits(columns: &[Vec<f64>]) -> Vec<Vec<u64>> {
        columns.iter().map(|column| column.iter().map(|value| value.to_bits()).collect()).collect()
    }

    fn check(columns: &[Vec<f64>]) {
        let rows = columns[0].len();
        assert_eq!(bits(&read(&planes(columns), rows, columns.len())), bits(columns));
    }

    #[test]
    fn weights_are_alternating_binomials() {
        for (order, weights) in WEIGHTS.iter().enumerate() {
            let mut binomial = 1.0;
            for j in 1..=order {
                binomial = binomial * (order - j + 1) as f64 / j as f64;
                let sign = if j % 2 == 1 { 1.0 } else { -1.0 };
                assert!((weights[j - 1] - sign * binomial).abs() < 0.5, "{order} {j}");
            }
        }
    }

    #[test]
    fn polynomials_are_foretold() {
        let cubic: Vec<f64> = (0..10).map(|k| f64::from(k * k * k - 4 * k)).collect();
        assert!((predict(&cubic, 4) - (1000.0 - 40.0)).abs() < 1e-9);
    }

    #[test]
    fn numbers_at_the_ends_of_their_range_come_back() {
        let nan = f64::from_bits(0x7ff8_0000_0000_0000);
        let odd = vec![
            0.0,
            -0.0,
            f64::MIN_POSITIVE,
            -5e-324,
            f64::MAX,
            f64::MIN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            nan,
            1.0,
            nan,
        ];
        check(&[odd.clone(), odd.into_iter().rev().collect()]);
        check(&[vec![]]);
        check(&[vec![1.5]]);
    }

    #[test]
    fn a_motion_takes_far_fewer_bytes() {
        let rows = 1000;
        let smooth = |k: u32, t: f64| f64::from(k) + 1.0 / (1.0 + t * t * f64::from(k + 1));
        let column = |k: u32| (0..rows).map(|row| smooth(k, f64::from(row) * 0.004)).collect();
        let columns: Vec<Vec<f64>> = (0..8).map(column).collect();
        let text = super::compress(&columns);
        assert!(text.len() < 8 * 8 * 1000 * 2 / 3, "{} bytes", text.len());
    }

    proptest! {
        #[test]
        fn any_bits_come_back(columns in proptest::collection::vec(proptest::collection::vec(any::<f64>(), 17), 1..4)) {
            let columns: Vec<Vec<f64>> = columns
                .into_iter()
                .map(|column| column.into_iter().map(|value| if value.is_nan() { 0.5 } else { value }).collect())
                .collect();
            check(&columns);
        }
    }
}
