//! The operations, each declared once: its operands and results, and its meaning.
//!
//! The meaning of an operation is expressed in terms of a [`Machine`]. Numbers, lanes, intervals, folding expressions and emitted text are
//! machines; none of them needs to know the list of operations.

use super::{Column, Register};
use mechc_expr::{Binary, Comparison, Unary};

/// One operation: reads registers and writes `to`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[allow(missing_docs)] // operands and results are named after their roles
pub enum Op {
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
    /// `a b c`, from left to right, each product rounded.
    ProductOfThree {
        to: Register,
        a: Register,
        b: Register,
        c: Register,
    },
    /// `a b + c d`, each rounded.
    SumOfProducts {
        to: Register,
        a: Register,
        b: Register,
        c: Register,
        d: Register,
    },
    /// `a b − c d`, each rounded.
    DifferenceOfProducts {
        to: Register,
        a: Register,
        b: Register,
        c: Register,
        d: Register,
    },
    /// `(a b + c d) e`, each rounded.
    SumOfProductsTimes {
        to: Register,
        a: Register,
        b: Register,
        c: Register,
        d: Register,
        e: Register,
    },
    /// `(a b − c d) e`, each rounded.
    DifferenceOfProductsTimes {
        to: Register,
        a: Register,
        b: Register,
        c: Register,
        d: Register,
        e: Register,
    },
    /// Sine and cosine of an angle after a small rotation by `delta`, from those before and half of `delta`: three terms of the Taylor series.
    Turn {
        to_sin: Register,
        to_cos: Register,
        sin: Register,
        cos: Register,
        half: Register,
        delta: Register,
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
    Unary {
        function: Unary,
        to: Register,
        a: Register,
    },
    Binary {
        function: Binary,
        to: Register,
        a: Register,
        b: Register,
    },
    Compare {
        comparison: Comparison,
        to: Register,
        a: Register,
        b: Register,
    },
    And {
        to: Register,
        a: Register,
        b: Register,
    },
    Or {
        to: Register,
        a: Register,
        b: Register,
    },
    Not {
        to: Register,
        a: Register,
    },
    Select {
        to: Register,
        condition: Register,
        a: Register,
        b: Register,
    },
    /// `Select`, but NaN if either operand is NaN.
    Either {
        to: Register,
        condition: Register,
        a: Register,
        b: Register,
    },
    Copy {
        to: Register,
        a: Register,
    },
    /// Index of the table piece that contains `a`, from 0.
    Piece {
        to: Register,
        table: u32,
        a: Register,
    },
    /// Entry of a table's column for a piece.
    Pick {
        to: Register,
        table: u32,
        column: Column,
        piece: Register,
    },
}

/// A domain of values that operations run on.
#[allow(missing_docs)] // each method is the operation of its name
pub trait Machine {
    /// Value of a register, or of a part of it.
    type Value: Clone;

    /// Number of parts that registers are processed in.
    #[inline]
    fn parts(&self) -> usize {
        1
    }
    /// Selects the part that is read and written from now on.
    #[inline]
    fn go_to(&mut self, _part: usize) {}
    fn read(&mut self, register: Register) -> Self::Value;
    fn write(&mut self, register: Register, value: Self::Value);

    fn add(&mut self, a: Self::Value, b: Self::Value) -> Self::Value;
    fn sub(&mut self, a: Self::Value, b: Self::Value) -> Self::Value;
    fn mul(&mut self, a: Self::Value, b: Self::Value) -> Self::Value;
    fn div(&mut self, a: Self::Value, b: Self::Value) -> Self::Value;
    /// `a b + c`, each rounded.
    #[inline]
    fn mul_add(&mut self, a: Self::Value, b: Self::Value, c: Self::Value) -> Self::Value {
        let product = self.mul(a, b);
        self.add(product, c)
    }
    /// `a b − c`, each rounded.
    #[inline]
    fn mul_less(&mut self, a: Self::Value, b: Self::Value, c: Self::Value) -> Self::Value {
        let product = self.mul(a, b);
        self.sub(product, c)
    }
    /// `c − a b`, each rounded.
    #[inline]
    fn less_mul(&mut self, a: Self::Value, b: Self::Value, c: Self::Value) -> Self::Value {
        let product = self.mul(a, b);
        self.sub(c, product)
    }
    /// `a b c`, each product rounded.
    #[inline]
    fn product_of_three(&mut self, a: Self::Value, b: Self::Value, c: Self::Value) -> Self::Value {
        let product = self.mul(a, b);
        self.mul(product, c)
    }
    /// `a b + c d`, each rounded.
    #[inline]
    fn sum_of_products(&mut self, [a, b]: [Self::Value; 2], [c, d]: [Self::Value; 2]) -> Self::Value {
        let product = self.mul(c, d);
        self.mul_add(a, b, product)
    }
    /// `a b − c d`, each rounded.
    #[inline]
    fn difference_of_products(&mut self, [a, b]: [Self::Value; 2], [c, d]: [Self::Value; 2]) -> Self::Value {
        let product = self.mul(c, d);
        self.mul_less(a, b, product)
    }
    /// Sine and cosine of an angle after a rotation by `delta`, from those before and half of `delta`.
    #[inline]
    fn turn(&mut self, [sin, cos]: [Self::Value; 2], half: Self::Value, delta: Self::Value) -> [Self::Value; 2] {
        let slope = self.less_mul(half.clone(), sin.clone(), cos.clone());
        let to_sin = self.mul_add(delta.clone(), slope, sin.clone());
        let slope = self.mul_add(half, cos.clone(), sin);
        [to_sin, self.less_mul(delta, slope, cos)]
    }
    fn neg(&mut self, a: Self::Value) -> Self::Value;
    fn recip(&mut self, a: Self::Value) -> Self::Value;
    /// Sine and cosine of an angle.
    fn sin_cos(&mut self, a: Self::Value) -> [Self::Value; 2];
    /// Writes sine and cosine of a register to two others, in all parts.
    #[inline(always)]
    #[allow(clippy::inline_always)] // so that the loop is compiled with the caller's vector instructions
    fn sin_cos_in(&mut self, [sin, cos]: [Register; 2], a: Register) {
        for part in 0..self.parts() {
            self.go_to(part);
            let a = self.read(a);
            let [sine, cosine] = self.sin_cos(a);
            self.write(sin, sine);
            self.write(cos, cosine);
        }
    }
    fn unary(&mut self, function: Unary, a: Self::Value) -> Self::Value;
    fn binary(&mut self, function: Binary, a: Self::Value, b: Self::Value) -> Self::Value;
    /// 1 if the comparison holds, else 0.
    fn compare(&mut self, comparison: Comparison, a: Self::Value, b: Self::Value) -> Self::Value;
    fn and(&mut self, a: Self::Value, b: Self::Value) -> Self::Value;
    fn or(&mut self, a: Self::Value, b: Self::Value) -> Self::Value;
    fn not(&mut self, a: Self::Value) -> Self::Value;
    /// `a` if the condition is not 0, else `b`.
    fn select(&mut self, condition: Self::Value, a: Self::Value, b: Self::Value) -> Self::Value;
    /// `select`, but NaN if either operand is NaN.
    fn either(&mut self, condition: Self::Value, a: Self::Value, b: Self::Value) -> Self::Value;
    /// Index of the table piece that contains `a`.
    fn piece(&mut self, table: u32, a: Self::Value) -> Self::Value;
    /// Entry of a table's column for a piece.
    fn pick(&mut self, table: u32, column: Column, piece: Self::Value) -> Self::Value;
}

impl Op {
    /// Runs the operation on a machine.
    #[inline(always)]
    #[allow(clippy::inline_always)] // so that the methods of the machine are inlined into the dispatch
    pub fn run<M: Machine>(&self, m: &mut M) {
        // one dispatch for all parts
        macro_rules! apply {
            ($to:ident = |$($operand:ident),+| $expression:expr) => {
                for part in 0..m.parts() {
                    m.go_to(part);
                    $(let $operand = m.read($operand);)+
                    let value = $expression;
                    m.write($to, value);
                }
            };
            ($to:ident = $method:ident($($immediate:ident),*; $($operand:ident),+)) => {
                apply!($to = |$($operand),+| m.$method($($immediate,)* $($operand),+))
            };
            ($to:ident = $method:ident($($operand:ident),+)) => { apply!($to = $method(; $($operand),+)) };
        }
        match *self {
            Op::Add { to, a, b } => apply!(to = add(a, b)),
            Op::Sub { to, a, b } => apply!(to = sub(a, b)),
            Op::Mul { to, a, b } => apply!(to = mul(a, b)),
            Op::Div { to, a, b } => apply!(to = div(a, b)),
            Op::MulAdd { to, a, b, c } => apply!(to = mul_add(a, b, c)),
            Op::MulLess { to, a, b, c } => apply!(to = mul_less(a, b, c)),
            Op::LessMul { to, a, b, c } => apply!(to = less_mul(a, b, c)),
            Op::ProductOfThree { to, a, b, c } => apply!(to = product_of_three(a, b, c)),
            Op::SumOfProducts { to, a, b, c, d } => {
                apply!(to = |a, b, c, d| m.sum_of_products([a, b], [c, d]));
            }
            Op::DifferenceOfProducts { to, a, b, c, d } => {
                apply!(to = |a, b, c, d| m.difference_of_products([a, b], [c, d]));
            }
            Op::SumOfProductsTimes { to, a, b, c, d, e } => apply!(
                to = |a, b, c, d, e| {
                    let sum = m.sum_of_products([a, b], [c, d]);
                    m.mul(sum, e)
                }
            ),
            Op::DifferenceOfProductsTimes { to, a, b, c, d, e } => apply!(
                to = |a, b, c, d, e| {
                    let difference = m.difference_of_products([a, b], [c, d]);
                    m.mul(difference, e)
                }
            ),
            Op::Turn { to_sin, to_cos, sin, cos, half, delta } => {
                for part in 0..m.parts() {
                    m.go_to(part);
                    let [sin, cos, half, delta] = [sin, cos, half, delta].map(|register| m.read(register));
                    let [sin, cos] = m.turn([sin, cos], half, delta);
                    m.write(to_sin, sin);
                    m.write(to_cos, cos);
                }
            }
            Op::Neg { to, a } => apply!(to = neg(a)),
            Op::Recip { to, a } => apply!(to = recip(a)),
            Op::SinCos { sin, cos, a } => m.sin_cos_in([sin, cos], a),
            Op::Unary { function, to, a } => apply!(to = unary(function; a)),
            Op::Binary { function, to, a, b } => apply!(to = binary(function; a, b)),
            Op::Compare { comparison, to, a, b } => apply!(to = compare(comparison; a, b)),
            Op::And { to, a, b } => apply!(to = and(a, b)),
            Op::Or { to, a, b } => apply!(to = or(a, b)),
            Op::Not { to, a } => apply!(to = not(a)),
            Op::Select { to, condition, a, b } => apply!(to = select(condition, a, b)),
            Op::Either { to, condition, a, b } => apply!(to = either(condition, a, b)),
            Op::Copy { to, a } => {
                for part in 0..m.parts() {
                    m.go_to(part);
                    let a = m.read(a);
                    m.write(to, a);
                }
            }
            Op::Piece { to, table, a } => apply!(to = piece(table; a)),
            Op::Pick { to, table, column, piece } => apply!(to = pick(table, column; piece)),
        }
    }

    /// Returns the operation with other registers: calls `read` for those it reads, then `write` for those it writes.
    #[must_use]
    pub fn renumbered(
        mut self,
        mut read: impl FnMut(Register) -> Register,
        mut write: impl FnMut(Register) -> Register,
    ) -> Op {
        match &mut self {
            Op::Neg { to, a }
            | Op::Recip { to, a }
            | Op::Not { to, a }
            | Op::Copy { to, a }
            | Op::Unary { to, a, .. }
            | Op::Piece { to, a, .. }
            | Op::Pick { to, piece: a, .. } => {
                *a = read(*a);
                *to = write(*to);
            }
            Op::Add { to, a, b }
            | Op::Sub { to, a, b }
            | Op::Mul { to, a, b }
            | Op::Div { to, a, b }
            | Op::Binary { to, a, b, .. }
            | Op::Compare { to, a, b, .. }
            | Op::And { to, a, b }
            | Op::Or { to, a, b } => {
                (*a, *b) = (read(*a), read(*b));
                *to = write(*to);
            }
            Op::MulAdd { to, a, b, c }
            | Op::MulLess { to, a, b, c }
            | Op::LessMul { to, a, b, c }
            | Op::ProductOfThree { to, a, b, c }
            | Op::Select { to, condition: a, a: b, b: c }
            | Op::Either { to, condition: a, a: b, b: c } => {
                (*a, *b, *c) = (read(*a), read(*b), read(*c));
                *to = write(*to);
            }
            Op::SumOfProducts { to, a, b, c, d } | Op::DifferenceOfProducts { to, a, b, c, d } => {
                (*a, *b, *c, *d) = (read(*a), read(*b), read(*c), read(*d));
                *to = write(*to);
            }
            Op::SumOfProductsTimes { to, a, b, c, d, e } | Op::DifferenceOfProductsTimes { to, a, b, c, d, e } => {
                (*a, *b, *c, *d, *e) = (read(*a), read(*b), read(*c), read(*d), read(*e));
                *to = write(*to);
            }
            Op::Turn { to_sin, to_cos, sin, cos, half, delta } => {
                (*sin, *cos, *half, *delta) = (read(*sin), read(*cos), read(*half), read(*delta));
                (*to_sin, *to_cos) = (write(*to_sin), write(*to_cos));
            }
            Op::SinCos { sin, cos, a } => {
                *a = read(*a);
                (*sin, *cos) = (write(*sin), write(*cos));
            }
        }
        self
    }

    /// Returns the registers that it reads, without table columns.
    #[must_use]
    pub fn reads(self) -> RegisterList<5> {
        let mut reads = RegisterList::default();
        let _ = self.renumbered(|register| reads.note(register), |register| register);
        reads
    }

    /// Returns the registers that it writes.
    #[must_use]
    pub fn writes(self) -> RegisterList<2> {
        let mut writes = RegisterList::default();
        let _ = self.renumbered(|register| register, |register| writes.note(register));
        writes
    }

    /// Returns the register of a result that jumps.
    #[must_use]
    pub fn switched(self) -> Option<Register> {
        match self {
            Op::Compare { to, .. }
            | Op::Piece { to, .. }
            | Op::Unary { function: Unary::Sign | Unary::Floor, to, .. } => Some(to),
            _ => None,
        }
    }

    /// Returns the table and the column that it looks into.
    #[must_use]
    pub fn column(self) -> Option<(u32, Column)> {
        match self {
            Op::Piece { table, .. } => Some((table, Column::Knots)),
            Op::Pick { table, column, .. } => Some((table, column)),
            _ => None,
        }
    }
}

/// Up to `N` registers.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct RegisterList<const N: usize> {
    registers: [Register; N],
    count: usize,
}

impl<const N: usize> Default for RegisterList<N> {
    fn default() -> RegisterList<N> {
        RegisterList { registers: [0; N], count: 0 }
    }
}

impl<const N: usize> RegisterList<N> {
    /// Adds a register and returns it.
    pub fn note(&mut self, register: Register) -> Register {
        self.registers[self.count] = register;
        self.count += 1;
        register
    }
}

impl<const N: usize> std::ops::Deref for RegisterList<N> {
    type Target = [Register];

    fn deref(&self) -> &[Register] {
        &self.registers[..self.count]
    }
}

impl<const N: usize> IntoIterator for RegisterList<N> {
    type Item = Register;
    type IntoIter = std::iter::Take<std::array::IntoIter<Register, N>>;

    fn into_iter(self) -> Self::IntoIter {
        self.registers.into_iter().take(self.count)
    }
}
