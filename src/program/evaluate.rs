//! Running a program. Allocates nothing but the registers, once.

use super::{Column, Op, Program, Stage, Switch};
use crate::expr::{Unary, binary_value, compare, piece, unary_value};
use crate::math;

/// A program's registers.
#[derive(Clone, Debug)]
pub struct Registers {
    values: Vec<f64>,
    /// Which switches stay as they are.
    frozen: Frozen,
}

/// Which switches stay as they are, instead of following their formulas.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Frozen {
    /// Those that depend on time alone.
    pub time: bool,
    /// All others.
    pub motion: bool,
}

impl Registers {
    /// The value of one.
    #[must_use]
    pub fn get(&self, register: super::Register) -> f64 {
        self.values[register as usize]
    }

    /// From now on these switches stay as they are, and the others follow their formulas.
    pub fn freeze(&mut self, frozen: Frozen) {
        self.frozen = frozen;
    }

    /// Sets an input.
    pub fn set(&mut self, register: super::Register, value: f64) {
        self.values[register as usize] = value;
    }

    /// Sets a run of inputs.
    pub fn set_all(&mut self, first: super::Register, values: &[f64]) {
        self.values[first as usize..first as usize + values.len()].copy_from_slice(values);
    }
}

impl Program {
    /// Registers with the constants and parameters in place, and the prologue run.
    #[must_use]
    pub fn start(&self, params: &[f64]) -> Registers {
        let mut registers = Registers { values: vec![0.0; self.registers()], frozen: Frozen::default() };
        for &(register, value) in &self.constants {
            registers.set(register, value);
        }
        registers.set_all(self.inputs.params, params);
        self.run(Stage::Prologue, &mut registers);
        registers
    }

    /// The result that a switch would have now, frozen or not.
    #[must_use]
    pub fn live(&self, switch: &Switch, registers: &Registers) -> f64 {
        let v = registers.values.as_slice();
        match switch.op {
            Op::Compare { comparison, a, b, .. } => compare(comparison, v[a as usize], v[b as usize]),
            Op::Unary { function, a, .. } => unary_value(function, v[a as usize]),
            Op::Piece { table, a, .. } => self.piece_in(table, v[a as usize], v),
            _ => v[switch.to as usize],
        }
    }

    /// What a switch is decided by, and how far that is from the nearest edge.
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

    /// The number of the piece that an argument lies in; what is no number lies nowhere.
    #[must_use]
    pub fn piece(&self, table: u32, x: f64, registers: &Registers) -> f64 {
        self.piece_in(table, x, &registers.values)
    }

    /// The entry of a table's column for a piece.
    #[must_use]
    pub fn pick(&self, table: u32, column: Column, piece: f64, registers: &Registers) -> f64 {
        self.pick_in(table, column, piece, &registers.values)
    }

    fn piece_in(&self, table: u32, x: f64, v: &[f64]) -> f64 {
        let layout = &self.tables[table as usize];
        if x.is_nan() {
            return x;
        }
        piece(layout.pieces as usize, |k| v[layout.knots as usize + k], x) as f64
    }

    fn pick_in(&self, table: u32, column: Column, piece: f64, v: &[f64]) -> f64 {
        if piece.is_nan() {
            return piece;
        }
        let range = self.tables[table as usize].column(column);
        // a piece is a small whole number
        #[allow(clippy::cast_sign_loss)]
        let at = range.start as usize + piece as usize;
        v[at.min(range.end as usize - 1)]
    }

    /// Runs the operations of one stage; where registers are frozen, all but the switches.
    pub fn run(&self, stage: Stage, registers: &mut Registers) {
        let frozen = match stage {
            Stage::Prologue | Stage::Variation | Stage::Measures | Stage::Rims => false,
            Stage::Time => registers.frozen.time,
            _ => registers.frozen.motion,
        };
        let v = registers.values.as_mut_slice();
        for op in self.stage(stage) {
            match *op {
                Op::Add { to, a, b } => v[to as usize] = v[a as usize] + v[b as usize],
                Op::Sub { to, a, b } => v[to as usize] = v[a as usize] - v[b as usize],
                Op::Mul { to, a, b } => v[to as usize] = v[a as usize] * v[b as usize],
                Op::Div { to, a, b } => v[to as usize] = v[a as usize] / v[b as usize],
                Op::Neg { to, a } => v[to as usize] = -v[a as usize],
                Op::Recip { to, a } => v[to as usize] = 1.0 / v[a as usize],
                Op::SinCos { sin, cos, a } => (v[sin as usize], v[cos as usize]) = math::sin_cos(v[a as usize]),
                Op::Compare { .. } | Op::Piece { .. } | Op::Unary { function: Unary::Sign | Unary::Floor, .. }
                    if frozen => {}
                Op::Unary { function, to, a } => v[to as usize] = unary_value(function, v[a as usize]),
                Op::Binary { function, to, a, b } => {
                    v[to as usize] = binary_value(function, v[a as usize], v[b as usize]);
                }
                Op::Compare { comparison, to, a, b } => {
                    v[to as usize] = compare(comparison, v[a as usize], v[b as usize]);
                }
                Op::And { to, a, b } => v[to as usize] = f64::from(v[a as usize] != 0.0 && v[b as usize] != 0.0),
                Op::Or { to, a, b } => v[to as usize] = f64::from(v[a as usize] != 0.0 || v[b as usize] != 0.0),
                Op::Not { to, a } => v[to as usize] = f64::from(v[a as usize] == 0.0),
                Op::Select { to, condition, a, b } => {
                    v[to as usize] = if v[condition as usize] == 0.0 { v[b as usize] } else { v[a as usize] };
                }
                Op::Either { to, condition, a, b } => {
                    v[to as usize] = either(v[condition as usize], v[a as usize], v[b as usize]);
                }
                Op::Copy { to, a } => v[to as usize] = v[a as usize],
                Op::Piece { to, table, a } => v[to as usize] = self.piece_in(table, v[a as usize], v),
                Op::Pick { to, table, column, piece } => {
                    v[to as usize] = self.pick_in(table, column, v[piece as usize], v);
                }
            }
        }
    }
}

/// `a` if the condition holds, else `b`; not a number if either is not.
#[must_use]
pub fn either(condition: f64, a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() {
        f64::NAN
    } else if condition == 0.0 {
        b
    } else {
        a
    }
}
