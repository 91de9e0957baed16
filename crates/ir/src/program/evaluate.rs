//! Evaluation of a program on numbers. Allocates only the registers, once.

use super::{Column, Machine, Op, Program, Register, Stage, Switch, TableLayout};
use mechc_expr::math;
use mechc_expr::{Binary, Comparison, Unary, binary_value, compare, piece, unary_value};

/// Register file of a program.
#[derive(Clone, Debug)]
pub struct Registers {
    values: Vec<f64>,
    /// Switches that keep their results.
    frozen: FrozenSwitches,
}

/// Selection of the switches that keep their results instead of following their formulas.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct FrozenSwitches {
    /// True for the switches that depend on time alone.
    pub time: bool,
    /// True for all other switches.
    pub motion: bool,
}

impl Registers {
    /// Returns the value of a register.
    #[must_use]
    pub fn get(&self, register: Register) -> f64 {
        self.values[register as usize]
    }

    /// Freezes the selected switches from now on; all others follow their formulas.
    pub fn freeze(&mut self, frozen: FrozenSwitches) {
        self.frozen = frozen;
    }

    /// Sets an input.
    pub fn set(&mut self, register: Register, value: f64) {
        self.values[register as usize] = value;
    }

    /// Sets a run of registers.
    pub fn set_all(&mut self, first: Register, values: &[f64]) {
        self.values[first as usize..first as usize + values.len()].copy_from_slice(values);
    }
}

impl Program {
    /// Creates the registers with constants and parameters, and runs the prologue.
    #[must_use]
    pub fn start(&self, params: &[f64]) -> Registers {
        let mut registers = Registers { values: vec![0.0; self.registers()], frozen: FrozenSwitches::default() };
        for &(register, value) in &self.constants {
            registers.set(register, value);
        }
        registers.set_all(self.inputs.params, params);
        self.run(Stage::Prologue, &mut registers);
        registers
    }

    /// Returns the current result of a switch, whether it is frozen or not.
    #[must_use]
    pub fn live(&self, switch: &Switch, registers: &Registers) -> f64 {
        let v = registers.values.as_slice();
        match switch.op {
            Op::Compare { comparison, a, b, .. } => compare(comparison, v[a as usize], v[b as usize]),
            Op::Unary { function, a, .. } => unary_value(function, v[a as usize]),
            Op::Piece { table, a, .. } => piece_in(&self.tables[table as usize], v[a as usize], v),
            _ => v[switch.to as usize],
        }
    }

    /// Returns the quantity that decides a switch, and its distance to the nearest edge.
    #[must_use]
    pub fn edge(&self, switch: &Switch, registers: &Registers) -> (f64, f64) {
        let v = registers.values.as_slice();
        match switch.op {
            Op::Compare { a, b, .. } => (v[a as usize] - v[b as usize], (v[a as usize] - v[b as usize]).abs()),
            Op::Unary { function: Unary::Floor, a, .. } => {
                (v[a as usize], (v[a as usize] - v[a as usize].round()).abs())
            }
            Op::Unary { a, .. } => (v[a as usize], v[a as usize].abs()),
            Op::Piece { table, a, .. } => {
                let layout = &self.tables[table as usize];
                let knots = layout.knots as usize..=(layout.knots + layout.pieces) as usize;
                let distances = v[knots].iter().map(|knot| (v[a as usize] - knot).abs());
                (v[a as usize], distances.fold(f64::INFINITY, f64::min))
            }
            _ => (v[switch.to as usize], f64::INFINITY),
        }
    }

    /// Returns the index of the table piece that contains an argument; NaN for NaN.
    #[must_use]
    pub fn piece(&self, table: u32, x: f64, registers: &Registers) -> f64 {
        piece_in(&self.tables[table as usize], x, &registers.values)
    }

    /// Returns the entry of a table's column for a piece.
    #[must_use]
    pub fn pick(&self, table: u32, column: Column, piece: f64, registers: &Registers) -> f64 {
        pick_in(&self.tables[table as usize], column, piece, &registers.values)
    }

    /// Runs the operations of a stage, except frozen switches.
    pub fn run(&self, stage: Stage, registers: &mut Registers) {
        let frozen = match stage {
            Stage::Time => registers.frozen.time,
            _ => stage.can_switch() && registers.frozen.motion,
        };
        let mut numbers = Numbers { tables: &self.tables, v: registers.values.as_mut_slice() };
        if frozen {
            let moving = self.stage(stage).iter().filter(|op| op.switched().is_none());
            moving.for_each(|op| op.run(&mut numbers));
        } else {
            self.stage(stage).iter().for_each(|op| op.run(&mut numbers));
        }
    }
}

impl Program {
    /// Runs some operations of a stage whose switches are never frozen.
    pub fn run_operations(&self, operations: &[Op], registers: &mut Registers) {
        let mut numbers = Numbers { tables: &self.tables, v: registers.values.as_mut_slice() };
        for op in operations {
            op.run(&mut numbers);
        }
    }
}

/// Machine on registers that hold numbers.
struct Numbers<'n> {
    tables: &'n [TableLayout],
    v: &'n mut [f64],
}

#[allow(clippy::inline_always)] // each is an arm of the loop over operations
impl Machine for Numbers<'_> {
    type Value = f64;

    #[inline(always)]
    fn read(&mut self, register: Register) -> f64 {
        self.v[register as usize]
    }

    #[inline(always)]
    fn write(&mut self, register: Register, value: f64) {
        self.v[register as usize] = value;
    }

    #[inline(always)]
    fn add(&mut self, a: f64, b: f64) -> f64 {
        a + b
    }

    #[inline(always)]
    fn sub(&mut self, a: f64, b: f64) -> f64 {
        a - b
    }

    #[inline(always)]
    fn mul(&mut self, a: f64, b: f64) -> f64 {
        a * b
    }

    #[inline(always)]
    fn div(&mut self, a: f64, b: f64) -> f64 {
        a / b
    }

    #[inline(always)]
    fn neg(&mut self, a: f64) -> f64 {
        -a
    }

    #[inline(always)]
    fn recip(&mut self, a: f64) -> f64 {
        1.0 / a
    }

    #[inline(always)]
    fn sin_cos(&mut self, a: f64) -> [f64; 2] {
        math::sin_cos(a).into()
    }

    #[inline(always)]
    fn unary(&mut self, function: Unary, a: f64) -> f64 {
        unary_value(function, a)
    }

    #[inline(always)]
    fn binary(&mut self, function: Binary, a: f64, b: f64) -> f64 {
        binary_value(function, a, b)
    }

    #[inline(always)]
    fn compare(&mut self, comparison: Comparison, a: f64, b: f64) -> f64 {
        compare(comparison, a, b)
    }

    #[inline(always)]
    fn and(&mut self, a: f64, b: f64) -> f64 {
        truth::and(a, b)
    }

    #[inline(always)]
    fn or(&mut self, a: f64, b: f64) -> f64 {
        truth::or(a, b)
    }

    #[inline(always)]
    fn not(&mut self, a: f64) -> f64 {
        truth::not(a)
    }

    #[inline(always)]
    fn select(&mut self, condition: f64, a: f64, b: f64) -> f64 {
        truth::select(condition, a, b)
    }

    #[inline(always)]
    fn either(&mut self, condition: f64, a: f64, b: f64) -> f64 {
        truth::either(condition, a, b)
    }

    #[inline(always)]
    fn piece(&mut self, table: u32, a: f64) -> f64 {
        piece_in(&self.tables[table as usize], a, self.v)
    }

    #[inline(always)]
    fn pick(&mut self, table: u32, column: Column, piece: f64) -> f64 {
        pick_in(&self.tables[table as usize], column, piece, self.v)
    }
}

/// Returns the index of the table piece that contains an argument; NaN for NaN.
fn piece_in(layout: &TableLayout, x: f64, v: &[f64]) -> f64 {
    if x.is_nan() {
        return x;
    }
    piece(layout.pieces as usize, |k| v[layout.knots as usize + k], x) as f64
}

/// Returns the entry of a table's column for a piece; NaN for NaN.
fn pick_in(layout: &TableLayout, column: Column, piece: f64, v: &[f64]) -> f64 {
    if piece.is_nan() {
        return piece;
    }
    let range = layout.column(column);
    // a piece is a small nonnegative integer
    #[allow(clippy::cast_sign_loss)]
    let at = range.start as usize + piece as usize;
    v[at.min(range.end as usize - 1)]
}

/// Truth values as numbers: 0 is false, 1 is true.
pub mod truth {
    /// Returns 1 if both are true.
    #[must_use]
    pub fn and(a: f64, b: f64) -> f64 {
        f64::from(a != 0.0 && b != 0.0)
    }

    /// Returns 1 if either is true.
    #[must_use]
    pub fn or(a: f64, b: f64) -> f64 {
        f64::from(a != 0.0 || b != 0.0)
    }

    /// Returns 1 if `a` is false.
    #[must_use]
    pub fn not(a: f64) -> f64 {
        f64::from(a == 0.0)
    }

    /// Returns `a` if the condition is true, else `b`.
    #[must_use]
    pub fn select(condition: f64, a: f64, b: f64) -> f64 {
        if condition == 0.0 { b } else { a }
    }

    /// Returns the result of [`select`], or NaN if either operand is NaN.
    #[must_use]
    pub fn either(condition: f64, a: f64, b: f64) -> f64 {
        if a.is_nan() || b.is_nan() { f64::NAN } else { select(condition, a, b) }
    }
}
