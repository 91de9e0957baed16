//! The tape that instructions are emitted to, with arithmetic on values of which some are numbers.

use super::Instruction;
use super::schedule::EvalTime;
use mechc_expr::math;
use mechc_ir::program::{Op, Register};
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::Range;

/// A number, or the result of an instruction with a sign.
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

    /// Returns whether it is 1 or −1.
    #[allow(clippy::float_cmp)] // exactly
    fn is_unit(self) -> bool {
        matches!(self, Value::Number(x) if x.abs() == 1.0)
    }

    /// Returns the value, negated if `number` is negative.
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
/// Instructions that depend on tears are collected until the Newton loop is closed; all others run once, before it.
pub(super) struct Tape {
    pub instructions: Vec<Instruction>,
    /// The instructions of the loop under construction.
    in_loop: Vec<Instruction>,
    /// By register: the time at which its value is available.
    eval_times: Vec<EvalTime>,
    /// The time of values that depend on no unknown of this component.
    start: EvalTime,
    numbers: FxHashMap<u64, Register>,
    /// Registers that may not be finite, so that their product with 0 must not be folded to 0.
    nonfinite: FxHashSet<Register>,
}

impl Tape {
    pub fn new(start: EvalTime) -> Tape {
        let (numbers, nonfinite) = (FxHashMap::default(), FxHashSet::default());
        Tape { instructions: Vec::new(), in_loop: Vec::new(), eval_times: Vec::new(), start, numbers, nonfinite }
    }

    /// Returns the time of values that depend on no unknown of this component.
    pub fn start(&self) -> EvalTime {
        self.start
    }

    /// Returns the number of registers.
    pub fn registers(&self) -> usize {
        self.eval_times.len()
    }

    /// Returns a new register, which a special instruction or the Newton loop writes.
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

    /// Appends the loop to the instructions before it, and returns its range.
    pub fn close_loop(&mut self) -> Range<usize> {
        let from = self.instructions.len();
        self.instructions.append(&mut self.in_loop);
        from..self.instructions.len()
    }

    /// Emits an instruction without a result.
    pub fn emit(&mut self, instruction: Instruction) {
        let eval_time = self.time_of(instruction);
        self.emit_at(instruction, eval_time);
    }

    /// Stores a result in a column.
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

    /// Emits an instruction that writes a new register.
    pub fn push(&mut self, instruction: impl FnOnce(Register) -> Instruction) -> Value {
        let to = self.eval_times.len() as Register;
        let instruction = instruction(to);
        let eval_time = self.time_of(instruction);
        self.eval_times.push(eval_time);
        self.emit_at(instruction, eval_time);
        Value::Register { at: to, negative: false }
    }

    /// Emits an operation that writes a new register.
    pub fn compute(&mut self, op: impl FnOnce(Register) -> Op) -> Value {
        self.push(|to| Instruction::Compute(op(to)))
    }

    /// Emits an operation that writes two new registers.
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

    /// Returns a register that holds a value, negated if necessary.
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

    /// Returns whether a value may be infinite or NaN although all unknowns are finite.
    pub fn may_be_nonfinite(&self, value: Value) -> bool {
        match value {
            Value::Number(x) => !x.is_finite(),
            Value::Register { at, .. } => self.nonfinite.contains(&at),
        }
    }

    /// Marks a value that may be infinite or NaN.
    pub fn mark_nonfinite(&mut self, value: Value) {
        if let Value::Register { at, .. } = value {
            self.nonfinite.insert(at);
        }
    }

    /// Marks the value of an unknown as finite: a row with an unknown that is not finite is rejected anyway.
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

    /// Returns `a inverse`, a multiplier of an elimination; checks it unless it is constant.
    pub fn multiplier(&mut self, a: Value, inverse: Value, weight: impl FnOnce() -> u32) -> Value {
        let (Value::Register { .. }, false) = (inverse, a.is_zero()) else {
            return self.mul(a, inverse);
        };
        let ((a, minus_a), (b, minus_b)) = (self.register_and_sign(a), self.register_and_sign(inverse));
        let weight = weight();
        let product = self.push(|to| Instruction::Multiplier { to, a, b, weight });
        if minus_a == minus_b { product } else { product.negated() }
    }

    /// Returns a value's register, and whether its sign is still to be changed.
    fn register_and_sign(&mut self, value: Value) -> (Register, bool) {
        match value {
            Value::Register { at, negative } => (at, negative),
            Value::Number(_) => (self.register(value), false),
        }
    }
}
