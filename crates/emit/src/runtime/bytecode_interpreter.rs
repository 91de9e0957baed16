//! Interpreter of bytecode.

use super::codes;
use super::either::either;
use super::pick::pick;
use super::piece::piece;
use super::select::select;
use super::sine_and_cosine::sin_cos;

/// Arrays that operations read: by number, parameters, values that follow from these, branches of formulas, time or
/// signals, coordinates with their derivatives, derivatives by inputs and parameters, and multipliers.
pub type Arrays<'a> = [&'a [f64]; 10];

/// Constants, functions and tables that operations name by number.
pub trait ConstantPool {
    /// Returns a constant.
    fn number(number: usize) -> f64;

    /// Evaluates a function of one argument.
    fn unary(number: usize, a: f64) -> f64;

    /// Evaluates a function of two arguments.
    fn binary(number: usize, a: f64, b: f64) -> f64;

    /// Returns a column of a table.
    fn column(number: usize) -> &'static [f64];
}

/// Destination of results.
pub trait Results {
    /// Stores a result by its column.
    fn store(&mut self, column: usize, value: f64);

    /// Returns a result that has been stored.
    fn stored(&self, column: usize) -> f64;

    /// Records a value that must not exceed its bound.
    fn bounded(&mut self, _size: f64, _bound: f64) {}

    /// Records the reciprocal of a pivot, the index of its block, and the weight that makes it dimensionless.
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

/// State of the interpreter.
struct Interpreter<'a, R> {
    guess: &'a [f64],
    inputs: &'a Arrays<'a>,
    v: &'a mut [f64],
    out: &'a mut R,
}

/// Runs operations on registers. Each operation is its code, the register of the result, and its operands.
pub fn run<B: ConstantPool>(code: &[u32], guess: &[f64], inputs: &Arrays<'_>, v: &mut [f64], out: &mut impl Results) {
    let mut interpreter = Interpreter { guess, inputs, v, out };
    let mut rest = code;
    // every operation takes a word at least
    for _ in 0..code.len() {
        let Some((&what, words)) = rest.split_first() else {
            return;
        };
        let length = match interpreter.value::<B>(what, words) {
            Some((value, length)) => {
                interpreter.put(words, 0, value);
                length
            }
            None => interpreter.act::<B>(what, words),
        };
        rest = words.get(length..).unwrap_or(&[]);
    }
}

/// Returns an operand.
#[inline]
fn word(words: &[u32], k: usize) -> usize {
    words.get(k).map_or(0, |word| *word as usize)
}

impl<R: Results> Interpreter<'_, R> {
    /// Returns the value in the register of an operand.
    #[inline]
    fn of(&self, words: &[u32], k: usize) -> f64 {
        self.v.get(word(words, k)).copied().unwrap_or(f64::NAN)
    }

    /// Writes a value to the register of an operand.
    #[inline]
    fn put(&mut self, words: &[u32], k: usize, value: f64) {
        if let Some(place) = self.v.get_mut(word(words, k)) {
            *place = value;
        }
    }

    /// Returns the result of an operation that has one, and the number of its words.
    #[inline]
    fn value<B: ConstantPool>(&mut self, what: u32, words: &[u32]) -> Option<(f64, usize)> {
        let of = |k: usize| self.of(words, k);
        let operand = |k: usize| word(words, k);
        let truth = f64::from;
        Some(match what {
            codes::NUMBER => (B::number(operand(1)), 2),
            codes::INPUT => {
                let array = self.inputs.get(operand(1)).copied().unwrap_or(&[]);
                (array.get(operand(2)).copied().unwrap_or(f64::NAN), 3)
            }
            codes::STORED => (self.out.stored(operand(1)), 2),
            codes::GUESS => (self.guess.get(operand(1)).copied().unwrap_or(f64::NAN), 2),
            codes::ADD => (of(1) + of(2), 3),
            codes::SUB => (of(1) - of(2), 3),
            codes::MUL => (of(1) * of(2), 3),
            codes::DIV => (of(1) / of(2), 3),
            codes::MUL_ADD => (of(1) * of(2) + of(3), 4),
            codes::MUL_LESS => (of(1) * of(2) - of(3), 4),
            codes::LESS_MUL => (of(3) - of(1) * of(2), 4),
            codes::PRODUCT_OF_THREE => (of(1) * of(2) * of(3), 4),
            codes::SUM_OF_PRODUCTS => (of(1) * of(2) + of(3) * of(4), 5),
            codes::DIFFERENCE_OF_PRODUCTS => (of(1) * of(2) - of(3) * of(4), 5),
            codes::SUM_OF_PRODUCTS_TIMES => ((of(1) * of(2) + of(3) * of(4)) * of(5), 6),
            codes::DIFFERENCE_OF_PRODUCTS_TIMES => ((of(1) * of(2) - of(3) * of(4)) * of(5), 6),
            codes::TURN => {
                let (sin, cos, half, delta) = (of(2), of(3), of(4), of(5));
                self.put(words, 1, cos - delta * (sin + half * cos));
                (sin + delta * (cos - half * sin), 6)
            }
            codes::NEG => (-of(1), 2),
            codes::RECIP => (1.0 / of(1), 2),
            codes::SIN_COS => {
                let (sin, cos) = sin_cos(of(2));
                self.put(words, 1, cos);
                (sin, 3)
            }
            codes::UNARY => (B::unary(operand(2), of(1)), 3),
            codes::BINARY => (B::binary(operand(3), of(1), of(2)), 4),
            codes::LESS => (truth(of(1) < of(2)), 3),
            codes::LESS_EQUAL => (truth(of(1) <= of(2)), 3),
            codes::EQUAL => (truth(of(1) == of(2)), 3),
            codes::AND => (truth(of(1) != 0.0 && of(2) != 0.0), 3),
            codes::OR => (truth(of(1) != 0.0 || of(2) != 0.0), 3),
            codes::NOT => (truth(of(1) == 0.0), 2),
            codes::SELECT => (select(of(1), of(2), of(3)), 4),
            codes::EITHER => (either(of(1), of(2), of(3)), 4),
            codes::COPY => (of(1), 2),
            codes::PIECE => (piece(of(1), B::column(operand(2))), 3),
            codes::PICK => (pick(B::column(operand(2)), of(1)), 3),
            _ => return None,
        })
    }

    /// Runs an operation without a result register. Returns the number of its words.
    #[inline]
    fn act<B: ConstantPool>(&mut self, what: u32, words: &[u32]) -> usize {
        match what {
            codes::STORE => {
                self.out.store(word(words, 0), self.of(words, 1));
                2
            }
            codes::MULTIPLIER => {
                self.out.bounded(self.of(words, 0).abs() * B::number(word(words, 1)), 1.0);
                2
            }
            codes::RESIDUAL => {
                self.out.bounded(self.of(words, 0).abs(), B::number(word(words, 1)));
                2
            }
            codes::PIVOT => {
                self.out.pivoted(word(words, 1), self.of(words, 0), B::number(word(words, 2)));
                3
            }
            // no other code exists
            _ => words.len(),
        }
    }
}
