//! Operations being laid out, and arithmetic on values of which some are numbers already.

use crate::program::{self, Register};
use rustc_hash::FxHashMap;

/// One operation on lanes: reads registers, writes `to`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs)] // operands and results say themselves
pub enum Op {
    /// A number, by its bits.
    Number {
        to: Register,
        bits: [u32; 2],
    },
    /// What stands in a register of the program: it depends on parameters alone, or is a switch.
    Load {
        to: Register,
        from: Register,
    },
    /// The time (s).
    Time {
        to: Register,
    },
    /// What has been stored in a column of the row.
    Column {
        to: Register,
        column: u32,
    },
    /// A tear, by its number, on the curve of the step: where Newton begins.
    Curve {
        to: Register,
        tear: u32,
    },
    Add {
        to: Register,
        a: Register,
        b: Register,
    },
    Sub {
        to: Register,
        a: Register,
        b: Register,
    },
    Mul {
        to: Register,
        a: Register,
        b: Register,
    },
    Div {
        to: Register,
        a: Register,
        b: Register,
    },
    /// `a b + c`, each rounded.
    MulAdd {
        to: Register,
        a: Register,
        b: Register,
        c: Register,
    },
    /// `a b − c`, each rounded.
    MulLess {
        to: Register,
        a: Register,
        b: Register,
        c: Register,
    },
    /// `c − a b`, each rounded.
    LessMul {
        to: Register,
        a: Register,
        b: Register,
        c: Register,
    },
    Neg {
        to: Register,
        a: Register,
    },
    /// `1 / a`
    Recip {
        to: Register,
        a: Register,
    },
    SinCos {
        sin: Register,
        cos: Register,
        a: Register,
    },
    /// Any other operation of a program.
    Other(program::Op),
    /// `a b`, a multiplier that is watched, by the number of its weight.
    Multiplier {
        to: Register,
        a: Register,
        b: Register,
        weight: u32,
    },
    /// One over a pivot, by the pivot's number; the sign of all pivots of a block tells its branches apart.
    Pivot {
        a: Register,
        pivot: u32,
    },
    /// What is left of a row of `Φ`, which must be next to nothing.
    Residual {
        a: Register,
        row: u32,
    },
    /// A result, by its column.
    Store {
        column: u32,
        a: Register,
    },
}

impl Op {
    /// The registers that it reads, and how many they are.
    #[must_use]
    pub fn reads(self) -> ([Register; 3], usize) {
        let (mut reads, mut count) = ([0; 3], 0);
        let read = |register| {
            reads[count] = register;
            count += 1;
            register
        };
        let _ = self.renumbered(read, |register| register);
        (reads, count)
    }

    /// The registers that it writes, and how many they are.
    #[must_use]
    pub fn writes(self) -> ([Register; 2], usize) {
        let (mut writes, mut count) = ([0; 2], 0);
        let write = |register| {
            writes[count] = register;
            count += 1;
            register
        };
        let _ = self.renumbered(|register| register, write);
        (writes, count)
    }

    /// The same with other registers: `read` for those it reads, then `write` for those it writes.
    #[must_use]
    pub fn renumbered(
        mut self,
        mut read: impl FnMut(Register) -> Register,
        mut write: impl FnMut(Register) -> Register,
    ) -> Op {
        match &mut self {
            Op::Number { to, .. }
            | Op::Load { to, .. }
            | Op::Time { to }
            | Op::Column { to, .. }
            | Op::Curve { to, .. } => {
                *to = write(*to);
            }
            Op::Add { to, a, b }
            | Op::Sub { to, a, b }
            | Op::Mul { to, a, b }
            | Op::Div { to, a, b }
            | Op::Multiplier { to, a, b, .. } => {
                (*a, *b) = (read(*a), read(*b));
                *to = write(*to);
            }
            Op::MulAdd { to, a, b, c } | Op::MulLess { to, a, b, c } | Op::LessMul { to, a, b, c } => {
                (*a, *b, *c) = (read(*a), read(*b), read(*c));
                *to = write(*to);
            }
            Op::Neg { to, a } | Op::Recip { to, a } => {
                *a = read(*a);
                *to = write(*to);
            }
            Op::SinCos { sin, cos, a } => {
                *a = read(*a);
                (*sin, *cos) = (write(*sin), write(*cos));
            }
            Op::Residual { a, .. } | Op::Pivot { a, .. } | Op::Store { a, .. } => *a = read(*a),
            Op::Other(op) => *op = op.renumbered(read, write),
        }
        self
    }
}

/// A number that is known already, or what an operation gives.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Value {
    Number(f64),
    Of { at: Register, negative: bool },
}

impl Value {
    pub const ZERO: Value = Value::Number(0.0);

    pub fn is_zero(self) -> bool {
        matches!(self, Value::Number(x) if x == 0.0)
    }

    /// Whether it is 1 or −1.
    #[allow(clippy::float_cmp)] // exactly
    fn is_unit(self) -> bool {
        matches!(self, Value::Number(x) if x.abs() == 1.0)
    }

    /// Itself, or turned where a number is negative.
    fn signed_as(self, number: Value) -> Value {
        if matches!(number, Value::Number(x) if x < 0.0) { self.negated() } else { self }
    }

    pub fn negated(self) -> Value {
        match self {
            Value::Number(x) => Value::Number(-x),
            Value::Of { at, negative } => Value::Of { at, negative: !negative },
        }
    }
}

/// The operations of a component so far.
///
/// Each value has an *age*: what changes from one iteration of Newton to the next has an odd one, and its operations are put
/// aside until the loop is closed; all others are done once, before it.
pub(super) struct Tape {
    pub operations: Vec<Op>,
    /// Those of the loop that is being written.
    pub inner: Vec<Op>,
    /// By register.
    ages: Vec<u32>,
    /// The age of what depends on no unknown of this component.
    pub least_age: u32,
    numbers: FxHashMap<u64, Register>,
}

impl Tape {
    pub fn new(least_age: u32) -> Tape {
        Tape { operations: Vec::new(), inner: Vec::new(), ages: Vec::new(), least_age, numbers: FxHashMap::default() }
    }

    /// How many registers are in use.
    pub fn registers(&self) -> usize {
        self.ages.len()
    }

    /// A register that is written otherwise than by an operation of its own.
    pub fn fresh(&mut self, age: u32) -> Register {
        self.ages.push(age);
        (self.ages.len() - 1) as Register
    }

    pub fn set_age(&mut self, register: Register, age: u32) {
        self.ages[register as usize] = age;
    }

    pub fn age(&self, value: Value) -> u32 {
        match value {
            Value::Number(_) => self.least_age,
            Value::Of { at, .. } => self.ages[at as usize],
        }
    }

    /// Adds an operation without a result.
    pub fn act(&mut self, op: Op) {
        let age = self.age_of(op);
        self.place(op, age);
    }

    fn age_of(&self, op: Op) -> u32 {
        let (reads, count) = op.reads();
        reads[..count].iter().map(|&register| self.ages[register as usize]).fold(self.least_age, u32::max)
    }

    fn place(&mut self, op: Op, age: u32) {
        if age % 2 == 1 { self.inner.push(op) } else { self.operations.push(op) }
    }

    /// Adds an operation that writes a register of its own.
    pub fn push(&mut self, op: impl FnOnce(Register) -> Op) -> Value {
        let to = self.ages.len() as Register;
        let op = op(to);
        let age = self.age_of(op);
        self.ages.push(age);
        self.place(op, age);
        Value::Of { at: to, negative: false }
    }

    /// Adds an operation that writes two registers of its own.
    pub fn push_pair(&mut self, op: impl FnOnce(Register, Register) -> Op) -> [Value; 2] {
        let first = self.ages.len() as Register;
        let op = op(first, first + 1);
        let age = self.age_of(op);
        self.ages.extend([age, age]);
        self.place(op, age);
        [first, first + 1].map(|at| Value::Of { at, negative: false })
    }

    /// The register of a value, its sign being made right.
    pub fn register(&mut self, value: Value) -> Register {
        match value {
            Value::Number(x) => {
                if let Some(&known) = self.numbers.get(&x.to_bits()) {
                    return known;
                }
                let bits = x.to_bits();
                let to = self.fresh(self.least_age);
                self.operations.push(Op::Number { to, bits: [bits as u32, (bits >> 32) as u32] });
                self.numbers.insert(bits, to);
                to
            }
            Value::Of { at, negative: false } => at,
            Value::Of { at, negative: true } => {
                let turned = self.push(|to| Op::Neg { to, a: at });
                self.register(turned)
            }
        }
    }

    pub fn add(&mut self, a: Value, b: Value) -> Value {
        match (a, b) {
            (Value::Number(x), Value::Number(y)) => Value::Number(x + y),
            (zero, other) | (other, zero) if zero.is_zero() => other,
            _ => {
                let ((a, minus_a), (b, minus_b)) = (self.unsigned(a), self.unsigned(b));
                match (minus_a, minus_b) {
                    (false, false) => self.push(|to| Op::Add { to, a, b }),
                    (false, true) => self.push(|to| Op::Sub { to, a, b }),
                    (true, false) => self.push(|to| Op::Sub { to, a: b, b: a }),
                    (true, true) => self.push(|to| Op::Add { to, a, b }).negated(),
                }
            }
        }
    }

    pub fn sub(&mut self, a: Value, b: Value) -> Value {
        self.add(a, b.negated())
    }

    pub fn mul(&mut self, a: Value, b: Value) -> Value {
        match (a, b) {
            (Value::Number(x), Value::Number(y)) => Value::Number(x * y),
            (zero, _) | (_, zero) if zero.is_zero() => Value::ZERO,
            (unit, other) | (other, unit) if unit.is_unit() => other.signed_as(unit),
            _ => {
                let ((a, minus_a), (b, minus_b)) = (self.unsigned(a), self.unsigned(b));
                let product = self.push(|to| Op::Mul { to, a, b });
                if minus_a == minus_b { product } else { product.negated() }
            }
        }
    }

    pub fn div(&mut self, a: Value, b: Value) -> Value {
        match (a, b) {
            (Value::Number(x), Value::Number(y)) => Value::Number(x / y),
            (zero, _) if zero.is_zero() => Value::ZERO,
            (other, unit) if unit.is_unit() => other.signed_as(unit),
            _ => {
                let ((a, minus_a), (b, minus_b)) = (self.unsigned(a), self.unsigned(b));
                let quotient = self.push(|to| Op::Div { to, a, b });
                if minus_a == minus_b { quotient } else { quotient.negated() }
            }
        }
    }

    pub fn recip(&mut self, a: Value) -> Value {
        if let Value::Number(x) = a {
            return Value::Number(1.0 / x);
        }
        let (a, minus) = self.unsigned(a);
        let inverse = self.push(|to| Op::Recip { to, a });
        if minus { inverse.negated() } else { inverse }
    }

    /// `a b`, watched where it may grow.
    pub fn multiplier(&mut self, a: Value, inverse: Value, weight: impl FnOnce() -> u32) -> Value {
        let (Value::Of { .. }, false) = (inverse, a.is_zero()) else {
            return self.mul(a, inverse);
        };
        let ((a, minus_a), (b, minus_b)) = (self.unsigned(a), self.unsigned(inverse));
        let weight = weight();
        let product = self.push(|to| Op::Multiplier { to, a, b, weight });
        if minus_a == minus_b { product } else { product.negated() }
    }

    /// A value's register, and whether its sign is still to be turned.
    fn unsigned(&mut self, value: Value) -> (Register, bool) {
        match value {
            Value::Of { at, negative } => (at, negative),
            Value::Number(_) => (self.register(value), false),
        }
    }
}
