//! Points of Sobol's sequence, each computed from its index alone.
//!
//! No maintained crate computes a point from its index in double precision; the sequence is a table and ten lines.
//!
//! Source: I. M. Sobol, *USSR Computational Mathematics and Mathematical Physics* 7 (1967) 86–112; direction numbers of S. Joe and F. Y. Kuo, *SIAM
//! Journal on Scientific Computing* 30 (2008) 2635–2654, the set `new-joe-kuo-6`.

/// The largest number of coordinates of a point.
pub(super) const MAX_DIMENSIONS: usize = DIRECTIONS.len() + 1;

/// The number of binary digits of a coordinate, which a double holds exactly; the sequence repeats after 2^52 points.
const BITS: u32 = 52;

/// Sobol's sequence in some coordinates, digitally shifted.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Sobol {
    /// By coordinate and binary digit of the index: the direction number, as a binary fraction of 52 digits.
    directions: Vec<[u64; BITS as usize]>,
    /// By coordinate: the shift, added digit by digit without carry.
    shift: Vec<u64>,
}

impl Sobol {
    /// Creates the sequence in as many coordinates as there are shifts, at most [`MAX_DIMENSIONS`]. Each coordinate is shifted by the leading digits
    /// of its number; 0 leaves it as it is.
    pub fn new(shift: impl Iterator<Item = u64>) -> Sobol {
        let shift: Vec<u64> = shift.map(|shift| shift >> (u64::BITS - BITS)).collect();
        Sobol { directions: (0..shift.len()).map(directions).collect(), shift }
    }

    /// Returns coordinate `k` of a point, in [0, 1).
    pub fn coordinate(&self, index: u64, k: usize) -> f64 {
        // in the order of the Gray code, as the sequence is usually given, neighbours differ by one direction number
        let gray = index ^ (index >> 1);
        let digits = self.directions[k].iter().enumerate().filter(|(digit, _)| gray >> digit & 1 == 1);
        let point = digits.fold(self.shift[k], |point, (_, direction)| point ^ direction);
        point as f64 / (1_u64 << BITS) as f64
    }
}

/// Returns the direction numbers of coordinate `k`, counted from 0.
fn directions(k: usize) -> [u64; BITS as usize] {
    let shifted = |m: u64, digit: usize| m << (BITS as usize - 1 - digit);
    let Some((a, first)) = k.checked_sub(1).map(|k| DIRECTIONS[k]) else {
        return std::array::from_fn(|digit| shifted(1, digit));
    };
    let degree = first.len();
    let mut numbers = [0; BITS as usize];
    for digit in 0..numbers.len() {
        numbers[digit] = if let Some(&m) = first.get(digit) {
            shifted(m, digit)
        } else {
            let before = numbers[digit - degree];
            // the first and the last coefficient of the primitive polynomial are 1
            let inner = (1..degree).filter(|j| a >> (degree - 1 - j) & 1 == 1);
            inner.fold(before ^ (before >> degree), |direction, j| direction ^ numbers[digit - j])
        };
    }
    numbers
}

/// For each coordinate from the second on: the inner coefficients of its primitive polynomial as binary digits, and the first direction numbers, as
/// many as its degree.
#[rustfmt::skip]
const DIRECTIONS: [(u32, &[u64]); 63] = [
    (0, &[1]),
    (1, &[1, 3]),
    (1, &[1, 3, 1]),
    (2, &[1, 1, 1]),
    (1, &[1, 1, 3, 3]),
    (4, &[1, 3, 5, 13]),
    (2, &[1, 1, 5, 5, 17]),
    (4, &[1, 1, 5, 5, 5]),
    (7, &[1, 1, 7, 11, 19]),
    (11, &[1, 1, 5, 1, 1]),
    (13, &[1, 1, 1, 3, 11]),
    (14, &[1, 3, 5, 5, 31]),
    (1, &[1, 3, 3, 9, 7, 49]),
    (13, &[1, 1, 1, 15, 21, 21]),
    (16, &[1, 3, 1, 13, 27, 49]),
    (19, &[1, 1, 1, 15, 7, 5]),
    (22, &[1, 3, 1, 15, 13, 25]),
    (25, &[1, 1, 5, 5, 19, 61]),
    (1, &[1, 3, 7, 11, 23, 15, 103]),
    (4, &[1, 3, 7, 13, 13, 15, 69]),
    (7, &[1, 1, 3, 13, 7, 35, 63]),
    (8, &[1, 3, 5, 9, 1, 25, 53]),
    (14, &[1, 3, 1, 13, 9, 35, 107]),
    (19, &[1, 3, 1, 5, 27, 61, 31]),
    (21, &[1, 1, 5, 11, 19, 41, 61]),
    (28, &[1, 3, 5, 3, 3, 13, 69]),
    (31, &[1, 1, 7, 13, 1, 19, 1]),
    (32, &[1, 3, 7, 5, 13, 19, 59]),
    (37, &[1, 1, 3, 9, 25, 29, 41]),
    (41, &[1, 3, 5, 13, 23, 1, 55]),
    (42, &[1, 3, 7, 3, 13, 59, 17]),
    (50, &[1, 3, 1, 3, 5, 53, 69]),
    (55, &[1, 1, 5, 5, 23, 33, 13]),
    (56, &[1, 1, 7, 7, 1, 61, 123]),
    (59, &[1, 1, 7, 9, 13, 61, 49]),
    (62, &[1, 3, 3, 5, 3, 55, 33]),
    (14, &[1, 3, 1, 15, 31, 13, 49, 245]),
    (21, &[1, 3, 5, 15, 31, 59, 63, 97]),
    (22, &[1, 3, 1, 11, 11, 11, 77, 249]),
    (38, &[1, 3, 1, 11, 27, 43, 71, 9]),
    (47, &[1, 1, 7, 15, 21, 11, 81, 45]),
    (49, &[1, 3, 7, 3, 25, 31, 65, 79]),
    (50, &[1, 3, 1, 1, 19, 11, 3, 205]),
    (52, &[1, 1, 5, 9, 19, 21, 29, 157]),
    (56, &[1, 3, 7, 11, 1, 33, 89, 185]),
    (67, &[1, 3, 3, 3, 15, 9, 79, 71]),
    (70, &[1, 3, 7, 11, 15, 39, 119, 27]),
    (84, &[1, 1, 3, 1, 11, 31, 97, 225]),
    (97, &[1, 1, 1, 3, 23, 43, 57, 177]),
    (103, &[1, 3, 7, 7, 17, 17, 37, 71]),
    (115, &[1, 3, 1, 5, 27, 63, 123, 213]),
    (122, &[1, 1, 3, 5, 11, 43, 53, 133]),
    (8, &[1, 3, 5, 5, 29, 17, 47, 173, 479]),
    (13, &[1, 3, 3, 11, 3, 1, 109, 9, 69]),
    (16, &[1, 1, 1, 5, 17, 39, 23, 5, 343]),
    (22, &[1, 3, 1, 5, 25, 15, 31, 103, 499]),
    (25, &[1, 1, 1, 11, 11, 17, 63, 105, 183]),
    (44, &[1, 1, 5, 11, 9, 29, 97, 231, 363]),
    (47, &[1, 1, 5, 15, 19, 45, 41, 7, 383]),
    (52, &[1, 3, 7, 7, 31, 19, 83, 137, 221]),
    (55, &[1, 1, 1, 3, 23, 15, 111, 223, 83]),
    (59, &[1, 1, 5, 13, 31, 15, 55, 25, 161]),
    (62, &[1, 1, 3, 13, 25, 47, 39, 87, 257]),
];

#[cfg(test)]
mod tests {
    use super::{MAX_DIMENSIONS, Sobol};

    #[test]
    fn the_first_points_are_those_of_the_sequence() {
        let sobol = Sobol::new([0; 4].into_iter());
        let point = |index| [0, 1, 2, 3].map(|k| sobol.coordinate(index, k));
        // reference: scipy.stats.qmc.Sobol(4, scramble=False)
        let expected = [
            [0.0, 0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5, 0.5],
            [0.75, 0.25, 0.25, 0.25],
            [0.25, 0.75, 0.75, 0.75],
            [0.375, 0.375, 0.625, 0.875],
            [0.875, 0.875, 0.125, 0.375],
            [0.625, 0.125, 0.875, 0.625],
            [0.125, 0.625, 0.375, 0.125],
        ];
        for (index, expected) in expected.into_iter().enumerate() {
            assert_eq!(point(index as u64).map(f64::to_bits), expected.map(f64::to_bits), "{index}");
        }
    }

    /// Returns the index of the interval that holds a coordinate, out of `count` equal ones.
    #[allow(clippy::cast_sign_loss)] // none is negative
    fn cell(coordinate: f64, count: usize) -> usize {
        (coordinate * count as f64) as usize
    }

    /// Checks that of 2^k consecutive points, from a multiple of 2^k on, each interval of length 2^-k holds one in every coordinate, shifted or not.
    #[test]
    fn points_are_spread_evenly_in_every_coordinate() {
        let sobol = Sobol::new((0..MAX_DIMENSIONS as u64).map(|k| k.wrapping_mul(0x9e37_79b9_7f4a_7c15)));
        for k in 0..MAX_DIMENSIONS {
            for first in [0, 1024, 1 << 40] {
                let mut is_hit = [false; 1024];
                for index in first..first + 1024 {
                    let coordinate = sobol.coordinate(index, k);
                    assert!((0.0..1.0).contains(&coordinate));
                    let hit = &mut is_hit[cell(coordinate, 1024)];
                    assert!(!std::mem::replace(hit, true), "coordinate {k} of {index}");
                }
            }
        }
    }

    /// Checks that in the first two coordinates, and in later pairs, boxes of equal size hold about one point each (a net in base 2).
    #[test]
    fn pairs_of_coordinates_fill_the_square() {
        let sobol = Sobol::new([0; 40].into_iter());
        for pair in [[0, 1], [0, 2], [17, 18], [38, 39]] {
            let mut count = [0; 256];
            for index in 0..4096 {
                let [x, y] = pair.map(|k| cell(sobol.coordinate(index, k), 16));
                count[16 * x + y] += 1;
            }
            let [least, most] = [count.iter().min(), count.iter().max()];
            assert!(least >= Some(&8) && most <= Some(&24), "{pair:?}: {least:?} to {most:?}");
        }
    }
}
