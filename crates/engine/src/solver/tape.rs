//! Instructions being laid out, and arithmetic on values of which some are numbers already.

use super::Instruction;
use super::schedule::EvalTime;
use mechc_expr::math;
use mechc_ir::program::{Op, Register};
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::Range;

/// A number that is known already, or what an operation gives.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Value {
    Number(f64),
    Register { at: Register, negative: bool },
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
    fn times_sign_of(self, number: Value) -> Value {
        if matches!(number, Value::Number(x) if x < 0.0) { self.negated() } else { self }
    }

    pub fn negated(self) -> Value {
        match self {
            Value::Number(x) => Value::Number(-x),
            Value::Register { at, negative } => Value::Register { at, negative: !negative },
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
    eval_times: Vec<EvalTime>,
    /// The age of what depends on no unknown of this component.
    start: EvalTime,
    numbers: FxHashMap<u64, Register>,
    /// What formulas give that may be no finite number: of that even nothing, times it, is not known to be nothing.
    nonfinite: FxHashSet<Register>,
}

impl Tape {
    pub fn new(start: EvalTime) -> Tape {
        let (numbers, nonfinite) = (FxHashMap::default(), FxHashSet::default());
        Tape { instructions: Vec::new(), in_loop: Vec::new(), eval_times: Vec::new(), start, numbers, nonfinite }
    }

    /// The age of what depends on no unknown of this component.
    pub fn start(&self) -> EvalTime {
        self.start
    }

    /// How many registers are in use.
    pub fn registers(&self) -> usize {
        self.eval_times.len()
    }

    /// A register that is written otherwise than by an instruction of its own.
    pub fn new_register(&mut self, eval_time: EvalTime) -> Register {
        self.eval_times.push(eval_time);
        (self.eval_times.len() - 1) as Register
    }

    pub fn set_time(&mut self, register: Register, eval_time: EvalTime) {
        self.eval_times[register as usize] = eval_time;
    }

    pub fn eval_time(&self, value: Value) -> EvalTime {
        match value {
            Value::Number(_) => self.start,
            Value::Register { at, .. } => self.eval_times[at as usize],
        }
    }

    /// Puts the loop behind what is done before it, and gives its instructions' places.
    pub fn close_loop(&mut self) -> Range<usize> {
        let from = self.instructions.len();
        self.instructions.append(&mut self.in_loop);
        from..self.instructions.len()
    }

    /// Adds an instruction without a result.
    pub fn emit(&mut self, instruction: Instruction) {
        let eval_time = self.time_of(instruction);
        self.emit_at(instruction, eval_time);
    }

    /// Leaves a result in a column.
    pub fn store(&mut self, column: u32, value: Value) {
        let a = self.register(value);
        self.emit(Instruction::Store { column, a });
    }

    fn time_of(&self, instruction: Instruction) -> EvalTime {
        instruction.reads().iter().map(|&register| self.eval_times[register as usize]).fold(self.start, EvalTime::max)
    }

    fn emit_at(&mut self, instruction: Instruction, eval_time: EvalTime) {
        if eval_time.is_in_loop() {
            self.in_loop.push(instruction);
        } else {
            self.instructions.push(instruction);
        }
    }

    /// Adds an instruction that writes a register of its own.
    pub fn push(&mut self, instruction: impl FnOnce(Register) -> Instruction) -> Value {
        let to = self.eval_times.len() as Register;
        let instruction = instruction(to);
        let eval_time = self.time_of(instruction);
        self.eval_times.push(eval_time);
        self.emit_at(instruction, eval_time);
        Value::Register { at: to, negative: false }
    }

    /// Adds an operation that writes a register of its own.
    pub fn compute(&mut self, op: impl FnOnce(Register) -> Op) -> Value {
        self.push(|to| Instruction::Compute(op(to)))
    }

    /// Adds an operation that writes two registers of its own.
    pub fn compute_two(&mut self, op: impl FnOnce([Register; 2]) -> Op) -> [Value; 2] {
        let first = self.eval_times.len() as Register;
        let to = [first, first + 1];
        let instruction = Instruction::Compute(op(to));
        let eval_time = self.time_of(instruction);
        self.eval_times.extend([eval_time, eval_time]);
        self.emit_at(instruction, eval_time);
        to.map(|at| Value::Register { at, negative: false })
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
                if let Some(&existing) = self.numbers.get(&x.to_bits()) {
                    return existing;
                }
                let to = self.new_register(self.start);
                self.instructions.push(Instruction::number(to, x));
                self.numbers.insert(x.to_bits(), to);
                to
            }
            Value::Register { at, negative: false } => at,
            Value::Register { at, negative: true } => {
                let negated = self.compute(|to| Op::Neg { to, a: at });
                self.register(negated)
            }
        }
    }

    /// Whether a value may be no finite number, though no unknown that it comes from is none.
    pub fn may_be_nonfinite(&self, value: Value) -> bool {
        match value {
            Value::Number(x) => !x.is_finite(),
            Value::Register { at, .. } => self.nonfinite.contains(&at),
        }
    }

    /// Notes that a value may be no finite number.
    pub fn mark_nonfinite(&mut self, value: Value) {
        if let Value::Register { at, .. } = value {
            self.nonfinite.insert(at);
        }
    }

    /// Notes that a value is an unknown: where it is no finite number, there is no row.
    pub fn mark_finite(&mut self, value: Value) {
        if let Value::Register { at, .. } = value {
            self.nonfinite.remove(&at);
        }
    }

    pub fn add(&mut self, a: Value, b: Value) -> Value {
        match (a, b) {
            (Value::Number(x), Value::Number(y)) => Value::Number(x + y),
            (zero, other) | (other, zero) if zero.is_zero() => other,
            _ => {
                let ((a, minus_a), (b, minus_b)) = (self.register_and_sign(a), self.register_and_sign(b));
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
            (unit, other) | (other, unit) if unit.is_unit() => other.times_sign_of(unit),
            _ => {
                let ((a, minus_a), (b, minus_b)) = (self.register_and_sign(a), self.register_and_sign(b));
                let product = self.compute(|to| Op::Mul { to, a, b });
                if minus_a == minus_b { product } else { product.negated() }
            }
        }
    }

    pub fn div(&mut self, a: Value, b: Value) -> Value {
        match (a, b) {
            (Value::Number(x), Value::Number(y)) => Value::Number(x / y),
            (zero, _) if zero.is_zero() => Value::ZERO,
            (other, unit) if unit.is_unit() => other.times_sign_of(unit),
            _ => {
                let ((a, minus_a), (b, minus_b)) = (self.register_and_sign(a), self.register_and_sign(b));
                let quotient = self.compute(|to| Op::Div { to, a, b });
                if minus_a == minus_b { quotient } else { quotient.negated() }
            }
        }
    }

    pub fn recip(&mut self, a: Value) -> Value {
        if let Value::Number(x) = a {
            return Value::Number(1.0 / x);
        }
        let (a, minus) = self.register_and_sign(a);
        let inverse = self.compute(|to| Op::Recip { to, a });
        if minus { inverse.negated() } else { inverse }
    }

    /// `a b`, watched where it may grow.
    pub fn multiplier(&mut self, a: Value, inverse: Value, weight: impl FnOnce() -> u32) -> Value {
        let (Value::Register { .. }, false) = (inverse, a.is_zero()) else {
            return self.mul(a, inverse);
        };
        let ((a, minus_a), (b, minus_b)) = (self.register_and_sign(a), self.register_and_sign(inverse));
        let weight = weight();
        let product = self.push(|to| Instruction::Multiplier { to, a, b, weight });
        if minus_a == minus_b { product } else { product.negated() }
    }

    /// A value's register, and whether its sign is still to be turned.
    fn register_and_sign(&mut self, value: Value) -> (Register, bool) {
        match value {
            Value::Register { at, negative } => (at, negative),
            Value::Number(_) => (self.register(value), false),
        }
    }
}
