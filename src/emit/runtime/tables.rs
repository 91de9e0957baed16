//! Operations as numbers: what runs them, and what they leave behind.

use super::either::either;
use super::pick::pick;
use super::piece::piece;
use super::select::select;
use super::sine_and_cosine::sin_cos;

/// Arrays that operations read: by number, parameters, what follows from these, the branches of formulas, the time or signals, the
/// coordinates with their derivatives, and derivatives by inputs and parameters.
pub type Arrays<'a> = [&'a [f64]; 9];

/// What operations name by numbers.
pub trait Book {
    /// A number.
    fn number(number: usize) -> f64;

    /// A function of one argument.
    fn unary(number: usize, a: f64) -> f64;

    /// A function of two arguments.
    fn binary(number: usize, a: f64, b: f64) -> f64;

    /// A column of a table.
    fn column(number: usize) -> &'static [f64];
}

/// What operations leave behind.
pub trait Results {
    /// A result, by its column.
    fn store(&mut self, column: usize, value: f64);

    /// A result that has been stored.
    fn stored(&self, column: usize) -> f64;

    /// A value that must not be above its bound.
    fn bounded(&mut self, _size: f64, _bound: f64) {}

    /// One over a pivot, the turn that it counts for, and what makes it a pure number.
    fn pivoted(&mut self, _turn: usize, _inverse: f64, _weight: f64) {}
}

/// Results in a list.
impl<const K: usize> Results for [f64; K] {
    fn store(&mut self, column: usize, value: f64) {
        if let Some(place) = self.get_mut(column) {
            *place = value;
        }
    }

    fn stored(&self, column: usize) -> f64 {
        self.get(column).copied().unwrap_or(f64::NAN)
    }
}

/// Runs operations on registers: what to do, where the result goes, and what it is done with.
pub fn run<B: Book>(code: &[u32], guess: &[f64], inputs: &Arrays<'_>, v: &mut [f64], out: &mut impl Results) {
    let mut rest = code;
    // every operation takes a word at least
    for _ in 0..code.len() {
        let Some((&what, operands)) = rest.split_first() else {
            return;
        };
        let word = |k: usize| operands.get(k).map_or(0, |word| *word as usize);
        let of = |v: &[f64], k: usize| v.get(word(k)).copied().unwrap_or(f64::NAN);
        let number = |k: usize| B::number(word(k));
        let truth = f64::from;
        let (value, length) = match what {
            0 => (number(1), 2),
            1 => {
                let array = inputs.get(word(1)).copied().unwrap_or(&[]);
                (array.get(word(2)).copied().unwrap_or(f64::NAN), 3)
            }
            2 => (out.stored(word(1)), 2),
            3 => (guess.get(word(1)).copied().unwrap_or(f64::NAN), 2),
            5 => (of(v, 1) + of(v, 2), 3),
            6 => (of(v, 1) - of(v, 2), 3),
            7 => (of(v, 1) * of(v, 2), 3),
            8 => (of(v, 1) / of(v, 2), 3),
            9 => (of(v, 1) * of(v, 2) + of(v, 3), 4),
            10 => (of(v, 1) * of(v, 2) - of(v, 3), 4),
            11 => (of(v, 3) - of(v, 1) * of(v, 2), 4),
            12 => (-of(v, 1), 2),
            13 => (1.0 / of(v, 1), 2),
            14 => {
                let (sin, cos) = sin_cos(of(v, 2));
                if let Some(place) = v.get_mut(word(1)) {
                    *place = cos;
                }
                (sin, 3)
            }
            18 => (B::unary(word(2), of(v, 1)), 3),
            19 => (B::binary(word(3), of(v, 1), of(v, 2)), 4),
            20 => (truth(of(v, 1) < of(v, 2)), 3),
            21 => (truth(of(v, 1) <= of(v, 2)), 3),
            22 => (truth(of(v, 1) == of(v, 2)), 3),
            23 => (truth(of(v, 1) != 0.0 && of(v, 2) != 0.0), 3),
            24 => (truth(of(v, 1) != 0.0 || of(v, 2) != 0.0), 3),
            25 => (truth(of(v, 1) == 0.0), 2),
            26 => (select(of(v, 1), of(v, 2), of(v, 3)), 4),
            27 => (either(of(v, 1), of(v, 2), of(v, 3)), 4),
            28 => (of(v, 1), 2),
            29 => (piece(of(v, 1), B::column(word(2))), 3),
            30 => (pick(B::column(word(2)), of(v, 1)), 3),
            _ => {
                let length = match what {
                    4 => {
                        out.store(word(0), of(v, 1));
                        2
                    }
                    15 => {
                        out.bounded(of(v, 0).abs() * number(1), 1.0);
                        2
                    }
                    16 => {
                        out.bounded(of(v, 0).abs(), number(1));
                        2
                    }
                    _ => {
                        out.pivoted(word(1), of(v, 0), number(2));
                        3
                    }
                };
                rest = operands.get(length..).unwrap_or(&[]);
                continue;
            }
        };
        if let Some(place) = v.get_mut(word(0)) {
            *place = value;
        }
        rest = operands.get(length..).unwrap_or(&[]);
    }
}
