//! Tables as they travel: each number exact to the last bit, in far fewer bytes.
//!
//! A number is taken for a whole number in the order of the reals. What is stored is how far it is from what the rows before it foretell,
//! the polynomial through the last K of them; near a smooth curve that is small. The differences are written zigzag (0, -1, 1, -2, …) and
//! in planes: of each column first all highest bytes, then all second ones, and so on. All of it is deflated. First comes K for each column.
//!
//! What is foretold is computed with nothing but sums and products, in an order that `page/src/data/inflate.ts` keeps, so that it has the
//! same bits there.

/// The greatest order of prediction.
const GREATEST_ORDER: usize = 8;
/// (-1)^(j+1) · (K over j), by K and j - 1: what the last value, the one before it, and so on, are multiplied with.
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
/// How hard the compressor tries, of 10.
const EFFORT: u8 = 9;

/// A table, all of whose columns are as long, as Base64 of what is deflated.
pub(super) fn written(columns: &[Vec<f64>]) -> String {
    super::base64::written(&miniz_oxide::deflate::compress_to_vec(&planes(columns), EFFORT))
}

/// The bytes before they are deflated.
fn planes(columns: &[Vec<f64>]) -> Vec<u8> {
    let rows = columns.first().map_or(0, Vec::len);
    let mut bytes = vec![0; columns.len()];
    bytes.reserve(8 * rows * columns.len());
    let (mut best, mut tried) = (Vec::with_capacity(rows), Vec::with_capacity(rows));
    for (k, column) in columns.iter().enumerate() {
        let mut least = u64::MAX;
        for order in 0..=GREATEST_ORDER {
            let cost = differ(column, order, &mut tried);
            if cost < least {
                least = cost;
                bytes[k] = order as u8;
                std::mem::swap(&mut best, &mut tried);
            }
        }
        for plane in (0..8).rev() {
            bytes.extend(best.iter().map(|zigzag| (zigzag >> (8 * plane)) as u8));
        }
    }
    bytes
}

/// How far each number is from what is foretold, zigzag; and how many bits that takes.
fn differ(column: &[f64], order: usize, zigzags: &mut Vec<u64>) -> u64 {
    zigzags.clear();
    let mut bits = 0;
    for (row, &value) in column.iter().enumerate() {
        let apart = ordered(value).wrapping_sub(ordered(foretold(&column[..row], order))).cast_signed();
        let zigzag = (apart << 1 ^ apart >> 63).cast_unsigned();
        bits += u64::from(64 - zigzag.leading_zeros());
        zigzags.push(zigzag);
    }
    bits
}

/// The value of the polynomial through the last rows: through all of them, where they are fewer; 0 where that is no number.
fn foretold(before: &[f64], order: usize) -> f64 {
    let order = order.min(before.len());
    let mut sum = 0.0;
    for (weight, value) in WEIGHTS[order][..order].iter().zip(before.iter().rev()) {
        sum += weight * value;
    }
    if sum.is_finite() { sum } else { 0.0 }
}

/// A number as a whole number; these have the order of the reals.
fn ordered(value: f64) -> u64 {
    // of what is no number there is one alone: which one it was has no meaning
    let bits = if value.is_nan() { f64::NAN.to_bits() & !(1 << 63) } else { value.to_bits() };
    if bits >> 63 == 1 { !bits } else { bits | 1 << 63 }
}

#[cfg(test)]
mod tests {
    use super::{WEIGHTS, foretold, planes};
    use proptest::prelude::*;

    /// The columns behind the planes, slowly and plainly.
    fn read(bytes: &[u8], rows: usize, columns: usize) -> Vec<Vec<f64>> {
        let column = |k: usize| {
            let planes = &bytes[columns + 8 * rows * k..];
            let mut values: Vec<f64> = Vec::new();
            for row in 0..rows {
                let zigzag = (0..8).fold(0, |bits: u64, plane| bits << 8 | u64::from(planes[plane * rows + row]));
                let apart = if zigzag & 1 == 1 { !(zigzag >> 1) } else { zigzag >> 1 };
                let from = foretold(&values, usize::from(bytes[k])).to_bits();
                let from = if from >> 63 == 1 { !from } else { from | 1 << 63 };
                let ordered = from.wrapping_add(apart);
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
        assert!((foretold(&cubic, 4) - (1000.0 - 40.0)).abs() < 1e-9);
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
        let text = super::written(&columns);
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
