//! Operations on batches: several numbers at once, one per lane.

use super::{Column, Machine, Program, Register, Registers, truth};
use mechc_expr::math;
use mechc_expr::{Binary, Comparison, Unary, binary_value, compare, unary_value};
use std::array::from_fn;

/// Values of one register, one per lane.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct LaneValues<const W: usize>(pub [f64; W]);

#[allow(clippy::inline_always)] // loops over lanes are compiled for several kinds of processors
impl<const W: usize> LaneValues<W> {
    /// Returns `P` adjacent lanes.
    #[inline(always)]
    #[must_use]
    pub fn part<const P: usize>(&self, part: usize) -> &[f64; P] {
        &self.0.as_chunks().0[part]
    }

    /// Returns `P` adjacent lanes for writing.
    #[inline(always)]
    #[must_use]
    pub fn part_mut<const P: usize>(&mut self, part: usize) -> &mut [f64; P] {
        &mut self.0.as_chunks_mut().0[part]
    }
}

/// Machine on registers with one number per lane. It processes `P` lanes at a time, a small multiple of the width of vector registers, so
/// that operands stay in these. With `ALL` the number of parts is a compile-time constant.
pub struct LaneMachine<'n, const W: usize, const P: usize, const ALL: bool = false> {
    /// Lane values by register.
    v: &'n mut [LaneValues<W>],
    /// Number of parts to process, and the current part.
    parts: usize,
    part: usize,
    /// Program with the tables.
    program: &'n Program,
    /// Scalar registers, which hold the table columns.
    scalars: &'n Registers,
}

impl<'n, const W: usize, const P: usize, const ALL: bool> LaneMachine<'n, W, P, ALL> {
    /// Creates a machine that processes the first `parts` parts of the registers.
    #[inline]
    #[must_use]
    pub fn new(v: &'n mut [LaneValues<W>], parts: usize, (program, scalars): (&'n Program, &'n Registers)) -> Self {
        LaneMachine { v, parts, part: 0, program, scalars }
    }

    /// Returns whether all lanes of a register hold the same bits.
    #[inline(always)]
    #[allow(clippy::inline_always)] // loops over lanes are compiled for several kinds of processors
    fn is_uniform(&self, register: Register) -> bool {
        let values = &self.v[register as usize];
        let first = values.0[0].to_bits();
        let differs =
            |part: usize| values.part::<P>(part).iter().fold(0, |other, value| other | (value.to_bits() ^ first));
        (0..self.parts()).all(|part| differs(part) == 0)
    }
}

#[allow(clippy::inline_always)] // each method becomes part of a loop that is compiled for several kinds of processors
impl<const W: usize, const P: usize, const ALL: bool> Machine for LaneMachine<'_, W, P, ALL> {
    type Value = [f64; P];

    #[inline(always)]
    fn parts(&self) -> usize {
        if ALL { W / P } else { self.parts }
    }

    #[inline(always)]
    fn go_to(&mut self, part: usize) {
        self.part = part;
    }

    #[inline(always)]
    fn read(&mut self, register: Register) -> [f64; P] {
        *self.v[register as usize].part(self.part)
    }

    #[inline(always)]
    fn write(&mut self, register: Register, value: [f64; P]) {
        *self.v[register as usize].part_mut(self.part) = value;
    }

    #[inline(always)]
    fn add(&mut self, a: [f64; P], b: [f64; P]) -> [f64; P] {
        from_fn(|k| a[k] + b[k])
    }

    #[inline(always)]
    fn sub(&mut self, a: [f64; P], b: [f64; P]) -> [f64; P] {
        from_fn(|k| a[k] - b[k])
    }

    #[inline(always)]
    fn mul(&mut self, a: [f64; P], b: [f64; P]) -> [f64; P] {
        from_fn(|k| a[k] * b[k])
    }

    #[inline(always)]
    fn div(&mut self, a: [f64; P], b: [f64; P]) -> [f64; P] {
        from_fn(|k| a[k] / b[k])
    }

    // in one loop, so that no product is spilled

    #[inline(always)]
    fn mul_add(&mut self, a: [f64; P], b: [f64; P], c: [f64; P]) -> [f64; P] {
        from_fn(|k| a[k] * b[k] + c[k])
    }

    #[inline(always)]
    fn mul_less(&mut self, a: [f64; P], b: [f64; P], c: [f64; P]) -> [f64; P] {
        from_fn(|k| a[k] * b[k] - c[k])
    }

    #[inline(always)]
    fn less_mul(&mut self, a: [f64; P], b: [f64; P], c: [f64; P]) -> [f64; P] {
        from_fn(|k| c[k] - a[k] * b[k])
    }

    #[inline(always)]
    fn product_of_three(&mut self, a: [f64; P], b: [f64; P], c: [f64; P]) -> [f64; P] {
        from_fn(|k| a[k] * b[k] * c[k])
    }

    #[inline(always)]
    fn sum_of_products(&mut self, [a, b]: [[f64; P]; 2], [c, d]: [[f64; P]; 2]) -> [f64; P] {
        from_fn(|k| a[k] * b[k] + c[k] * d[k])
    }

    #[inline(always)]
    fn difference_of_products(&mut self, [a, b]: [[f64; P]; 2], [c, d]: [[f64; P]; 2]) -> [f64; P] {
        from_fn(|k| a[k] * b[k] - c[k] * d[k])
    }

    #[inline(always)]
    fn turn(&mut self, [sin, cos]: [[f64; P]; 2], half: [f64; P], delta: [f64; P]) -> [[f64; P]; 2] {
        let to_sin = from_fn(|k| sin[k] + delta[k] * (cos[k] - half[k] * sin[k]));
        [to_sin, from_fn(|k| cos[k] - delta[k] * (sin[k] + half[k] * cos[k]))]
    }

    #[inline(always)]
    fn neg(&mut self, a: [f64; P]) -> [f64; P] {
        a.map(|a| -a)
    }

    #[inline(always)]
    fn recip(&mut self, a: [f64; P]) -> [f64; P] {
        a.map(|a| 1.0 / a)
    }

    #[inline(always)]
    fn sin_cos(&mut self, a: [f64; P]) -> [[f64; P]; 2] {
        math::sin_cos_lanes(&a).into()
    }

    /// Evaluates one part if all lanes are equal: variants in a batch share the time.
    #[inline(always)]
    fn sin_cos_in(&mut self, [sin, cos]: [Register; 2], a: Register) {
        let evaluated = if self.parts() > 1 && self.is_uniform(a) { 1 } else { self.parts() };
        for part in 0..self.parts() {
            self.go_to(part);
            if part < evaluated {
                let angle = self.read(a);
                let [sine, cosine] = self.sin_cos(angle);
                self.write(sin, sine);
                self.write(cos, cosine);
            } else {
                for to in [sin, cos] {
                    let first = *self.v[to as usize].part(0);
                    self.write(to, first);
                }
            }
        }
    }

    #[inline(always)]
    fn unary(&mut self, function: Unary, a: [f64; P]) -> [f64; P] {
        a.map(|a| unary_value(function, a))
    }

    #[inline(always)]
    fn binary(&mut self, function: Binary, a: [f64; P], b: [f64; P]) -> [f64; P] {
        from_fn(|k| binary_value(function, a[k], b[k]))
    }

    #[inline(always)]
    fn compare(&mut self, comparison: Comparison, a: [f64; P], b: [f64; P]) -> [f64; P] {
        from_fn(|k| compare(comparison, a[k], b[k]))
    }

    #[inline(always)]
    fn and(&mut self, a: [f64; P], b: [f64; P]) -> [f64; P] {
        from_fn(|k| truth::and(a[k], b[k]))
    }

    #[inline(always)]
    fn or(&mut self, a: [f64; P], b: [f64; P]) -> [f64; P] {
        from_fn(|k| truth::or(a[k], b[k]))
    }

    #[inline(always)]
    fn not(&mut self, a: [f64; P]) -> [f64; P] {
        a.map(truth::not)
    }

    #[inline(always)]
    fn select(&mut self, condition: [f64; P], a: [f64; P], b: [f64; P]) -> [f64; P] {
        from_fn(|k| truth::select(condition[k], a[k], b[k]))
    }

    #[inline(always)]
    fn either(&mut self, condition: [f64; P], a: [f64; P], b: [f64; P]) -> [f64; P] {
        from_fn(|k| truth::either(condition[k], a[k], b[k]))
    }

    #[inline(always)]
    fn piece(&mut self, table: u32, a: [f64; P]) -> [f64; P] {
        a.map(|a| self.program.piece(table, a, self.scalars))
    }

    #[inline(always)]
    fn pick(&mut self, table: u32, column: Column, piece: [f64; P]) -> [f64; P] {
        piece.map(|piece| self.program.pick(table, column, piece, self.scalars))
    }
}
