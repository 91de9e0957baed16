//! Constant folding: emits an operation of a program for operands of which some are numbers.

use super::tape::{Tape, Value};
use mechc_expr::{Binary, Comparison, Unary};
use mechc_ir::program::{Column, Machine, Op, Register};

/// The registers of the program that an operation writes, with their values.
pub(super) type Results = [Option<(Register, Value)>; 2];

/// A machine that emits instructions for operations, or folds them to numbers.
pub(super) struct ConstantFolder<'f, R> {
    pub tape: &'f mut Tape,
    /// Returns the value of a register of the program.
    pub read: R,
    pub results: Results,
}

impl<R: Fn(Register) -> Value> ConstantFolder<'_, R> {
    /// Emits an operation without folding.
    fn emit_op<const N: usize>(
        &mut self,
        operands: [Value; N],
        op: impl FnOnce(Register, [Register; N]) -> Op,
    ) -> Value {
        let registers = operands.map(|value| self.tape.register(value));
        let value = self.tape.compute(|to| op(to, registers));
        self.propagate_nonfinite(value, &operands)
    }

    /// Marks a value that may not be finite because an operand may not be.
    fn propagate_nonfinite(&mut self, value: Value, operands: &[Value]) -> Value {
        if operands.iter().any(|&operand| self.tape.may_be_nonfinite(operand)) {
            self.tape.mark_nonfinite(value);
        }
        value
    }

    /// Marks a value that may not be finite even for finite operands.
    fn marked_nonfinite(&mut self, value: Value) -> Value {
        self.tape.mark_nonfinite(value);
        value
    }
}

impl<R: Fn(Register) -> Value> Machine for ConstantFolder<'_, R> {
    type Value = Value;

    fn read(&mut self, register: Register) -> Value {
        (self.read)(register)
    }

    fn write(&mut self, register: Register, value: Value) {
        let written = self.results.iter().flatten().count();
        self.results[written] = Some((register, value));
    }

    fn add(&mut self, a: Value, b: Value) -> Value {
        let sum = self.tape.add(a, b);
        self.propagate_nonfinite(sum, &[a, b])
    }

    fn sub(&mut self, a: Value, b: Value) -> Value {
        let difference = self.tape.sub(a, b);
        self.propagate_nonfinite(difference, &[a, b])
    }

    fn mul(&mut self, a: Value, b: Value) -> Value {
        // 0 times an infinite value is NaN, so the product must not be folded to 0
        let may_be_nan =
            (a.is_zero() && self.tape.may_be_nonfinite(b)) || (b.is_zero() && self.tape.may_be_nonfinite(a));
        if may_be_nan {
            return self.emit_op([a, b], |to, [a, b]| Op::Mul { to, a, b });
        }
        let product = self.tape.mul(a, b);
        self.propagate_nonfinite(product, &[a, b])
    }

    fn div(&mut self, a: Value, b: Value) -> Value {
        // 0 divided by 0 is NaN too
        let may_be_nan = a.is_zero() && matches!(b, Value::Register { .. });
        let quotient =
            if may_be_nan { self.emit_op([a, b], |to, [a, b]| Op::Div { to, a, b }) } else { self.tape.div(a, b) };
        if matches!(b, Value::Number(_)) {
            self.propagate_nonfinite(quotient, &[a])
        } else {
            self.marked_nonfinite(quotient)
        }
    }

    fn neg(&mut self, a: Value) -> Value {
        a.negated()
    }

    fn recip(&mut self, a: Value) -> Value {
        let inverse = self.tape.recip(a);
        self.marked_nonfinite(inverse)
    }

    fn sin_cos(&mut self, a: Value) -> [Value; 2] {
        self.tape.sin_cos(a).map(|value| self.propagate_nonfinite(value, &[a]))
    }

    fn unary(&mut self, function: Unary, a: Value) -> Value {
        let value = self.emit_op([a], |to, [a]| Op::Unary { function, to, a });
        match function {
            Unary::Abs | Unary::Sign | Unary::Floor | Unary::Sin | Unary::Cos | Unary::Atan | Unary::Tanh => value,
            Unary::Tan
            | Unary::Asin
            | Unary::Acos
            | Unary::Sinh
            | Unary::Cosh
            | Unary::Exp
            | Unary::Ln
            | Unary::Log10
            | Unary::Sqrt => self.marked_nonfinite(value),
        }
    }

    fn binary(&mut self, function: Binary, a: Value, b: Value) -> Value {
        let value = self.emit_op([a, b], |to, [a, b]| Op::Binary { function, to, a, b });
        if matches!(function, Binary::Pow | Binary::Mod) { self.marked_nonfinite(value) } else { value }
    }

    fn compare(&mut self, comparison: Comparison, a: Value, b: Value) -> Value {
        self.emit_op([a, b], |to, [a, b]| Op::Compare { comparison, to, a, b })
    }

    fn and(&mut self, a: Value, b: Value) -> Value {
        self.emit_op([a, b], |to, [a, b]| Op::And { to, a, b })
    }

    fn or(&mut self, a: Value, b: Value) -> Value {
        self.emit_op([a, b], |to, [a, b]| Op::Or { to, a, b })
    }

    fn not(&mut self, a: Value) -> Value {
        self.emit_op([a], |to, [a]| Op::Not { to, a })
    }

    fn select(&mut self, condition: Value, a: Value, b: Value) -> Value {
        self.emit_op([condition, a, b], |to, [condition, a, b]| Op::Select { to, condition, a, b })
    }

    fn either(&mut self, condition: Value, a: Value, b: Value) -> Value {
        self.emit_op([condition, a, b], |to, [condition, a, b]| Op::Either { to, condition, a, b })
    }

    fn piece(&mut self, table: u32, a: Value) -> Value {
        self.emit_op([a], |to, [a]| Op::Piece { to, table, a })
    }

    fn pick(&mut self, table: u32, column: Column, piece: Value) -> Value {
        self.emit_op([piece], |to, [piece]| Op::Pick { to, table, column, piece })
    }
}
