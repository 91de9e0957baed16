//! Operations of a program, laid out for operands of which some are numbers already.

use super::tape::{Tape, Value};
use crate::expr::{Binary, Comparison, Unary};
use crate::program::{Column, Machine, Op, Register};

/// The registers of the program that an operation writes, and what they are worth then.
pub(super) type Results = [Option<(Register, Value)>; 2];

/// A machine on which an operation becomes instructions, or numbers.
pub(super) struct Folding<'f, R> {
    pub tape: &'f mut Tape,
    /// What a register of the program is worth.
    pub read: R,
    pub results: Results,
}

impl<R: Fn(Register) -> Value> Folding<'_, R> {
    /// An operation that goes for any operands.
    fn any<const N: usize>(&mut self, operands: [Value; N], op: impl FnOnce(Register, [Register; N]) -> Op) -> Value {
        let operands = operands.map(|value| self.tape.register(value));
        self.tape.compute(|to| op(to, operands))
    }
}

impl<R: Fn(Register) -> Value> Machine for Folding<'_, R> {
    type Value = Value;

    fn read(&mut self, register: Register) -> Value {
        (self.read)(register)
    }

    fn write(&mut self, register: Register, value: Value) {
        let written = self.results.iter().flatten().count();
        self.results[written] = Some((register, value));
    }

    fn add(&mut self, a: Value, b: Value) -> Value {
        self.tape.add(a, b)
    }

    fn sub(&mut self, a: Value, b: Value) -> Value {
        self.tape.sub(a, b)
    }

    fn mul(&mut self, a: Value, b: Value) -> Value {
        self.tape.mul(a, b)
    }

    fn div(&mut self, a: Value, b: Value) -> Value {
        self.tape.div(a, b)
    }

    fn neg(&mut self, a: Value) -> Value {
        a.negated()
    }

    fn recip(&mut self, a: Value) -> Value {
        self.tape.recip(a)
    }

    fn sin_cos(&mut self, a: Value) -> [Value; 2] {
        self.tape.sin_cos(a)
    }

    fn unary(&mut self, function: Unary, a: Value) -> Value {
        self.any([a], |to, [a]| Op::Unary { function, to, a })
    }

    fn binary(&mut self, function: Binary, a: Value, b: Value) -> Value {
        self.any([a, b], |to, [a, b]| Op::Binary { function, to, a, b })
    }

    fn compare(&mut self, comparison: Comparison, a: Value, b: Value) -> Value {
        self.any([a, b], |to, [a, b]| Op::Compare { comparison, to, a, b })
    }

    fn and(&mut self, a: Value, b: Value) -> Value {
        self.any([a, b], |to, [a, b]| Op::And { to, a, b })
    }

    fn or(&mut self, a: Value, b: Value) -> Value {
        self.any([a, b], |to, [a, b]| Op::Or { to, a, b })
    }

    fn not(&mut self, a: Value) -> Value {
        self.any([a], |to, [a]| Op::Not { to, a })
    }

    fn select(&mut self, condition: Value, a: Value, b: Value) -> Value {
        self.any([condition, a, b], |to, [condition, a, b]| Op::Select { to, condition, a, b })
    }

    fn either(&mut self, condition: Value, a: Value, b: Value) -> Value {
        self.any([condition, a, b], |to, [condition, a, b]| Op::Either { to, condition, a, b })
    }

    fn piece(&mut self, table: u32, a: Value) -> Value {
        self.any([a], |to, [a]| Op::Piece { to, table, a })
    }

    fn pick(&mut self, table: u32, column: Column, piece: Value) -> Value {
        self.any([piece], |to, [piece]| Op::Pick { to, table, column, piece })
    }
}
