//! Operations on several numbers at once, a lane for each.

use super::{Column, Machine, Program, Register, Registers, truth};
use crate::expr::{Binary, Comparison, Unary, binary_value, compare, unary_value};
use crate::math;
use std::array::from_fn;

/// The values of one register, a lane for each.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct LaneValues<const W: usize>(pub [f64; W]);

/// Registers that hold a number for each lane.
pub struct LaneMachine<'n, const W: usize> {
    /// What stands in them.
    pub v: &'n mut [LaneValues<W>],
    /// Tables, and what they hold.
    pub program: &'n Program,
    /// The program's own registers.
    pub scalars: &'n Registers,
}

#[allow(clippy::inline_always)] // each is an arm of a loop that is compiled for several kinds of processors
impl<const W: usize> Machine for LaneMachine<'_, W> {
    type Value = [f64; W];

    #[inline(always)]
    fn read(&mut self, register: Register) -> [f64; W] {
        self.v[register as usize].0
    }

    #[inline(always)]
    fn write(&mut self, register: Register, value: [f64; W]) {
        self.v[register as usize].0 = value;
    }

    #[inline(always)]
    fn add(&mut self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| a[k] + b[k])
    }

    #[inline(always)]
    fn sub(&mut self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| a[k] - b[k])
    }

    #[inline(always)]
    fn mul(&mut self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| a[k] * b[k])
    }

    #[inline(always)]
    fn div(&mut self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| a[k] / b[k])
    }

    // in one go, so that no lane's product is put away

    #[inline(always)]
    fn mul_add(&mut self, a: [f64; W], b: [f64; W], c: [f64; W]) -> [f64; W] {
        from_fn(|k| a[k] * b[k] + c[k])
    }

    #[inline(always)]
    fn mul_less(&mut self, a: [f64; W], b: [f64; W], c: [f64; W]) -> [f64; W] {
        from_fn(|k| a[k] * b[k] - c[k])
    }

    #[inline(always)]
    fn less_mul(&mut self, a: [f64; W], b: [f64; W], c: [f64; W]) -> [f64; W] {
        from_fn(|k| c[k] - a[k] * b[k])
    }

    #[inline(always)]
    fn neg(&mut self, a: [f64; W]) -> [f64; W] {
        a.map(|a| -a)
    }

    #[inline(always)]
    fn recip(&mut self, a: [f64; W]) -> [f64; W] {
        a.map(|a| 1.0 / a)
    }

    #[inline(always)]
    fn sin_cos(&mut self, a: [f64; W]) -> [[f64; W]; 2] {
        math::sin_cos_of_each(&a).into()
    }

    #[inline(always)]
    fn unary(&mut self, function: Unary, a: [f64; W]) -> [f64; W] {
        a.map(|a| unary_value(function, a))
    }

    #[inline(always)]
    fn binary(&mut self, function: Binary, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| binary_value(function, a[k], b[k]))
    }

    #[inline(always)]
    fn compare(&mut self, comparison: Comparison, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| compare(comparison, a[k], b[k]))
    }

    #[inline(always)]
    fn and(&mut self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| truth::and(a[k], b[k]))
    }

    #[inline(always)]
    fn or(&mut self, a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| truth::or(a[k], b[k]))
    }

    #[inline(always)]
    fn not(&mut self, a: [f64; W]) -> [f64; W] {
        a.map(truth::not)
    }

    #[inline(always)]
    fn select(&mut self, condition: [f64; W], a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| truth::select(condition[k], a[k], b[k]))
    }

    #[inline(always)]
    fn either(&mut self, condition: [f64; W], a: [f64; W], b: [f64; W]) -> [f64; W] {
        from_fn(|k| truth::either(condition[k], a[k], b[k]))
    }

    #[inline(always)]
    fn piece(&mut self, table: u32, a: [f64; W]) -> [f64; W] {
        a.map(|a| self.program.piece(table, a, self.scalars))
    }

    #[inline(always)]
    fn pick(&mut self, table: u32, column: Column, piece: [f64; W]) -> [f64; W] {
        piece.map(|piece| self.program.pick(table, column, piece, self.scalars))
    }
}
