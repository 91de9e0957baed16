//! Instructions being laid out, and arithmetic on values of which some are numbers already.

use super::Instruction;
use super::age::Age;
use mechc_expr::math;
use mechc_ir::program::{Op, Register};
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::Range;

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

/// The instructions of a component so far.
///
/// Those whose values change from one iteration of Newton to the next are put aside until the loop is closed; all others are
/// done once, before it.
pub(super) struct Tape {
    pub instructions: Vec<Instruction>,
    /// Those of the loop that is being written.
    in_loop: Vec<Instruction>,
    /// By register.
    ages: Vec<Age>,
    /// The age of what depends on no unknown of this component.
    first: Age,
    numbers: FxHashMap<u64, Register>,
    /// What formulas give that may be no finite number: of that even nothing, times it, is not known to be nothing.
    doubtful: FxHashSet<Register>,
}

impl Tape {
    pub fn new(first: Age) -> Tape {
        let (numbers, doubtful) = (FxHashMap::default(), FxHashSet::default());
        Tape { instructions: Vec::new(), in_loop: Vec::new(), ages: Vec::new(), first, numbers, doubtful }
    }

    /// The age of what depends on no unknown of this component.
    pub fn first(&self) -> Age {
        self.first
    }

    /// How many registers are in use.
    pub fn registers(&self) -> usize {
        self.ages.len()
    }

    /// A register that is written otherwise than by an instruction of its own.
    pub fn fresh(&mut self, age: Age) -> Register {
        self.ages.push(age);
        (self.ages.len() - 1) as Register
    }

    pub fn set_age(&mut self, register: Register, age: Age) {
        self.ages[register as usize] = age;
    }

    pub fn age(&self, value: Value) -> Age {
        match value {
            Value::Number(_) => self.first,
            Value::Of { at, .. } => self.ages[at as usize],
        }
    }

    /// Puts the loop behind what is done before it, and gives its instructions' places.
    pub fn close_loop(&mut self) -> Range<usize> {
        let from = self.instructions.len();
        self.instructions.append(&mut self.in_loop);
        from..self.instructions.len()
    }

    /// Adds an instruction without a result.
    pub fn act(&mut self, instruction: Instruction) {
        let age = self.age_of(instruction);
        self.place(instruction, age);
    }

    /// Leaves a result in a column.
    pub fn store(&mut self, column: u32, value: Value) {
        let a = self.register(value);
        self.act(Instruction::Store { column, a });
    }

    fn age_of(&self, instruction: Instruction) -> Age {
        instruction.reads().iter().map(|&register| self.ages[register as usize]).fold(self.first, Age::max)
    }

    fn place(&mut self, instruction: Instruction, age: Age) {
        if age.is_in_loop() {
            self.in_loop.push(instruction);
        } else {
            self.instructions.push(instruction);
        }
    }

    /// Adds an instruction that writes a register of its own.
    pub fn push(&mut self, instruction: impl FnOnce(Register) -> Instruction) -> Value {
        let to = self.ages.len() as Register;
        let instruction = instruction(to);
        let age = self.age_of(instruction);
        self.ages.push(age);
        self.place(instruction, age);
        Value::Of { at: to, negative: false }
    }

    /// Adds an operation that writes a register of its own.
    pub fn compute(&mut self, op: impl FnOnce(Register) -> Op) -> Value {
        self.push(|to| Instruction::Compute(op(to)))
    }

    /// Adds an operation that writes two registers of its own.
    pub fn compute_two(&mut self, op: impl FnOnce([Register; 2]) -> Op) -> [Value; 2] {
        let first = self.ages.len() as Register;
        let to = [first, first + 1];
        let instruction = Instruction::Compute(op(to));
        let age = self.age_of(instruction);
        self.ages.extend([age, age]);
        self.place(instruction, age);
        to.map(|at| Value::Of { at, negative: false })
    }

    pub fn sin_cos(&mut self, a: Value) -> [Value; 2] {
        if let Value::Number(x) = a {
            let (sin, cos) = math::sin_cos(x);
            return [Value::Number(sin), Value::Number(cos)];
        }
        let a = self.register(a);
        self.compute_two(|[sin, cos]| Op::SinCos { sin, cos, a })
    }

    /// The register of a value, its sign being made right.
    pub fn register(&mut self, value: Value) -> Register {
        match value {
            Value::Number(x) => {
                if let Some(&known) = self.numbers.get(&x.to_bits()) {
                    return known;
                }
                let to = self.fresh(self.first);
                self.instructions.push(Instruction::number(to, x));
                self.numbers.insert(x.to_bits(), to);
                to
            }
            Value::Of { at, negative: false } => at,
            Value::Of { at, negative: true } => {
                let turned = self.compute(|to| Op::Neg { to, a: at });
                self.register(turned)
            }
        }
    }

    /// Whether a value may be no finite number, though no unknown that it comes from is none.
    pub fn is_doubtful(&self, value: Value) -> bool {
        match value {
            Value::Number(x) => !x.is_finite(),
            Value::Of { at, .. } => self.doubtful.contains(&at),
        }
    }

    /// Notes that a value may be no finite number.
    pub fn doubt(&mut self, value: Value) {
        if let Value::Of { at, .. } = value {
            self.doubtful.insert(at);
        }
    }

    /// Notes that a value is an unknown: where it is no finite number, there is no row.
    pub fn trust(&mut self, value: Value) {
        if let Value::Of { at, .. } = value {
            self.doubtful.remove(&at);
        }
    }

    pub fn add(&mut self, a: Value, b: Value) -> Value {
        match (a, b) {
            (Value::Number(x), Value::Number(y)) => Value::Number(x + y),
            (zero, other) | (other, zero) if zero.is_zero() => other,
            _ => {
                let ((a, minus_a), (b, minus_b)) = (self.unsigned(a), self.unsigned(b));
                match (minus_a, minus_b) {
                    (false, false) => self.compute(|to| Op::Add { to, a, b }),
                    (false, true) => self.compute(|to| Op::Sub { to, a, b }),
                    (true, false) => self.compute(|to| Op::Sub { to, a: b, b: a }),
                    (true, true) => self.compute(|to| Op::Add { to, a, b }).negated(),
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
                let product = self.compute(|to| Op::Mul { to, a, b });
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
                let quotient = self.compute(|to| Op::Div { to, a, b });
                if minus_a == minus_b { quotient } else { quotient.negated() }
            }
        }
    }

    pub fn recip(&mut self, a: Value) -> Value {
        if let Value::Number(x) = a {
            return Value::Number(1.0 / x);
        }
        let (a, minus) = self.unsigned(a);
        let inverse = self.compute(|to| Op::Recip { to, a });
        if minus { inverse.negated() } else { inverse }
    }

    /// `a b`, watched where it may grow.
    pub fn multiplier(&mut self, a: Value, inverse: Value, weight: impl FnOnce() -> u32) -> Value {
        let (Value::Of { .. }, false) = (inverse, a.is_zero()) else {
            return self.mul(a, inverse);
        };
        let ((a, minus_a), (b, minus_b)) = (self.unsigned(a), self.unsigned(inverse));
        let weight = weight();
        let product = self.push(|to| Instruction::Multiplier { to, a, b, weight });
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
