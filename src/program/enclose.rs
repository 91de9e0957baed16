//! Proof that no switch of time changes within an interval: the operations of [`Stage::Time`], run on intervals.
//!
//! An enclosure holds every value that an operation takes while time goes through the interval; it may hold more, and the
//! narrower the interval, the less more it holds.

use super::{Column, Op, Program, Registers, Stage};
use crate::expr::{Binary, Comparison, Unary, binary_value, compare, piece, unary_value};
use std::f64::consts::{FRAC_PI_2, PI};

/// From a lowest to a highest value.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Interval {
    low: f64,
    high: f64,
}

const WHOLE: Interval = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };
const UNDECIDED: Interval = Interval { low: 0.0, high: 1.0 };

/// Room for the enclosures of a program's registers.
#[derive(Clone, Debug)]
pub struct Enclosure {
    values: Vec<Interval>,
}

impl Enclosure {
    /// Room for a program whose prologue has been run; allocates nothing later.
    #[must_use]
    pub fn new(program: &Program, registers: &Registers) -> Enclosure {
        // what time decides is written anew each time
        Enclosure { values: (0..program.registers()).map(|k| point(registers.get(k as u32))).collect() }
    }

    /// Whether every switch of time keeps its frozen result from one time (s) to another.
    pub fn is_steady(&mut self, program: &Program, registers: &Registers, from: f64, to: f64) -> bool {
        let v = &mut self.values;
        v[program.inputs.time as usize] = Interval { low: from, high: to };
        for &op in program.stage(Stage::Time) {
            let (to, value) = match op {
                Op::SinCos { sin, cos, a } => {
                    v[sin as usize] = wave(v[a as usize], unary_value(Unary::Sin, middle(v[a as usize])));
                    (cos, wave(v[a as usize], unary_value(Unary::Cos, middle(v[a as usize]))))
                }
                _ => enclosed(program, op, v),
            };
            if op.switched().is_some() {
                let frozen = registers.get(to);
                if value.low.to_bits() != value.high.to_bits() || value.low.to_bits() != (frozen + 0.0).to_bits() {
                    return false;
                }
            }
            v[to as usize] = value;
        }
        true
    }
}

/// An operation's register and the enclosure of its result.
fn enclosed(program: &Program, op: Op, v: &[Interval]) -> (u32, Interval) {
    let at = |register: u32| v[register as usize];
    match op {
        Op::Add { to, a, b } => (to, wider(at(a).low + at(b).low, at(a).high + at(b).high)),
        Op::Sub { to, a, b } => (to, wider(at(a).low - at(b).high, at(a).high - at(b).low)),
        Op::Mul { to, a, b } => (to, corners(at(a), at(b), |x, y| if x == 0.0 || y == 0.0 { 0.0 } else { x * y })),
        Op::Div { to, a, b } => (to, quotient(at(a), at(b))),
        Op::Recip { to, a } => (to, quotient(point(1.0), at(a))),
        Op::Neg { to, a } => (to, Interval { low: -at(a).high, high: -at(a).low }),
        Op::Unary { function, to, a } => (to, of_one(function, at(a))),
        Op::Binary { function, to, a, b } => (to, of_two(function, at(a), at(b))),
        // a number is what it is
        Op::Compare { comparison, to, a, b } if a == b => (to, point(compare(comparison, 0.0, 0.0))),
        Op::Compare { comparison, to, a, b } => (to, compared(comparison, at(a), at(b))),
        Op::And { to, a, b } => (to, Interval { low: at(a).low.min(at(b).low), high: at(a).high.min(at(b).high) }),
        Op::Or { to, a, b } => (to, Interval { low: at(a).low.max(at(b).low), high: at(a).high.max(at(b).high) }),
        Op::Not { to, a } => (to, Interval { low: 1.0 - at(a).high, high: 1.0 - at(a).low }),
        Op::Select { to, condition, a, b } | Op::Either { to, condition, a, b } => {
            (to, chosen(at(condition), at(a), at(b)))
        }
        Op::Copy { to, a } => (to, at(a)),
        Op::Piece { to, table, a } => {
            let layout = &program.tables()[table as usize];
            let knot = |k: usize| at(layout.knots + k as u32).low;
            let number = |x: f64| piece(layout.pieces as usize, knot, x) as f64;
            (to, Interval { low: number(at(a).low), high: number(at(a).high) })
        }
        Op::Pick { to, table, column, piece } => (to, picked(program, table, column, at(piece), v)),
        // both results are written where it is met
        Op::SinCos { sin, .. } => (sin, WHOLE),
    }
}

fn point(value: f64) -> Interval {
    if value.is_nan() { WHOLE } else { Interval { low: value + 0.0, high: value + 0.0 } }
}

/// Rounding may have gone either way.
fn wider(low: f64, high: f64) -> Interval {
    if low.is_nan() || high.is_nan() { WHOLE } else { Interval { low: low.next_down(), high: high.next_up() } }
}

fn middle(a: Interval) -> f64 {
    0.5 * a.low + 0.5 * a.high
}

fn hull(a: Interval, b: Interval) -> Interval {
    Interval { low: a.low.min(b.low), high: a.high.max(b.high) }
}

/// A sine or cosine changes by no more than its argument.
fn wave(a: Interval, at_middle: f64) -> Interval {
    let reach = 0.5 * (a.high - a.low);
    if at_middle.is_nan() || !reach.is_finite() {
        return Interval { low: -1.0, high: 1.0 };
    }
    let reached = wider(at_middle - reach - 1e-15, at_middle + reach + 1e-15);
    Interval { low: reached.low.max(-1.0), high: reached.high.min(1.0) }
}

/// Of a function that is monotone in each operand: its values at the corners hold all others between them.
fn corners(a: Interval, b: Interval, f: impl Fn(f64, f64) -> f64) -> Interval {
    let all = [f(a.low, b.low), f(a.low, b.high), f(a.high, b.low), f(a.high, b.high)];
    if all.iter().any(|x| x.is_nan()) {
        return WHOLE;
    }
    wider(all.iter().copied().fold(f64::INFINITY, f64::min), all.iter().copied().fold(f64::NEG_INFINITY, f64::max))
}

fn quotient(a: Interval, b: Interval) -> Interval {
    if b.low <= 0.0 && b.high >= 0.0 { WHOLE } else { corners(a, b, |x, y| x / y) }
}

fn of_one(function: Unary, a: Interval) -> Interval {
    let (low, high) = (unary_value(function, a.low), unary_value(function, a.high));
    match function {
        Unary::Sin | Unary::Cos => wave(a, unary_value(function, middle(a))),
        // exact, and they never fall
        Unary::Sign | Unary::Floor if !low.is_nan() && !high.is_nan() => Interval { low: low + 0.0, high: high + 0.0 },
        Unary::Acos => loose(high, low),
        Unary::Abs if a.low >= 0.0 => a,
        Unary::Abs if a.high <= 0.0 => Interval { low: -a.high, high: -a.low },
        Unary::Abs => Interval { low: 0.0, high: a.high.max(-a.low) },
        Unary::Cosh if a.low < 0.0 && a.high > 0.0 => loose(1.0, low.max(high)),
        Unary::Cosh => loose(low.min(high), low.max(high)),
        Unary::Tan => {
            let branch = |x: f64| crate::math::floor((x + FRAC_PI_2) / PI);
            let one_branch = branch(a.low - 1e-9).to_bits() == branch(a.high + 1e-9).to_bits();
            if one_branch { loose(low, high) } else { WHOLE }
        }
        // all others rise
        _ => loose(low, high),
    }
}

fn of_two(function: Binary, a: Interval, b: Interval) -> Interval {
    let value = |x: f64, y: f64| binary_value(function, x, y);
    let loosened = |i: Interval| loose(i.low, i.high);
    match function {
        Binary::Min | Binary::Max => Interval { low: value(a.low, b.low), high: value(a.high, b.high) },
        Binary::Hypot => loosened(corners(of_one(Unary::Abs, a), of_one(Unary::Abs, b), value)),
        Binary::Pow if a.low > 0.0 => loosened(corners(a, b, value)),
        Binary::Pow => WHOLE,
        Binary::Atan2 if b.low > 0.0 => loosened(corners(a, b, value)),
        Binary::Atan2 => Interval { low: -PI, high: PI },
    }
}

/// As [`wider`], by the few units in the last place that an elementary function may be off.
fn loose(low: f64, high: f64) -> Interval {
    let slack = |x: f64| 4.0 * f64::EPSILON * x.abs() + f64::MIN_POSITIVE;
    wider(low - slack(low), high + slack(high))
}

fn compared(comparison: Comparison, a: Interval, b: Interval) -> Interval {
    let (surely, never) = match comparison {
        Comparison::Less => (a.high < b.low, a.low >= b.high),
        Comparison::LessEqual => (a.high <= b.low, a.low > b.high),
        Comparison::Equal => (false, a.high < b.low || a.low > b.high),
    };
    match (surely, never) {
        (true, _) => point(1.0),
        (_, true) => point(0.0),
        _ => UNDECIDED,
    }
}

fn chosen(condition: Interval, a: Interval, b: Interval) -> Interval {
    match (condition.low > 0.0, condition.high <= 0.0) {
        (true, _) => a,
        (_, true) => b,
        _ => hull(a, b),
    }
}

fn picked(program: &Program, table: u32, column: Column, piece: Interval, v: &[Interval]) -> Interval {
    let range = program.tables()[table as usize].column(column);
    if piece.low.is_nan() || piece.high.is_nan() || piece.low < 0.0 {
        return WHOLE;
    }
    // pieces are small whole numbers
    #[allow(clippy::cast_sign_loss)]
    let (first, last) = (range.start + piece.low as u32, range.start + piece.high as u32);
    let last = last.min(range.end - 1);
    (first.min(last)..=last).map(|k| v[k as usize]).reduce(hull).unwrap_or(WHOLE)
}
