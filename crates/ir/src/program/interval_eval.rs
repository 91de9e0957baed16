//! Interval evaluation: proves that nothing happens within a stretch of time, by running a program's operations on intervals.
//!
//! An enclosure holds every value of an operation while time, and optionally the coordinates, vary in their intervals. It may be wider than
//! these values; the excess vanishes with the width of the intervals.

use super::{Column, Machine, Op, Program, Register, Registers, Stage};
use mechc_expr::{Binary, Comparison, Unary, binary_value, compare, piece, unary_value};
use std::f64::consts::{FRAC_PI_2, PI};

/// Maximum number of table pieces that an interval may span; beyond it the enclosure of a column is the whole line.
const MOST_PIECES: f64 = 64.0;
/// Distance from a pole (rad) within which a tangent may be on either side of it.
const POLE_MARGIN: f64 = 1e-9;

/// A closed interval.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Interval {
    pub(super) low: f64,
    pub(super) high: f64,
}

pub(super) const WHOLE: Interval = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };
const UNDECIDED: Interval = Interval { low: 0.0, high: 1.0 };

/// Enclosures of switches, conditions and monitors, to prove that no switch changes, no condition fails and no monitor changes its sign.
#[derive(Clone, Debug)]
pub struct Enclosure {
    /// Operations that these depend on, in order.
    operations: Vec<Op>,
    /// Results of switches that must not change.
    switches: Vec<Register>,
    /// Registers that must stay above zero.
    conditions: Vec<Register>,
    /// Registers that must keep their sign.
    watches: Vec<Register>,
    /// First coordinate; `None` if time alone varies.
    coordinates: Option<Register>,
    time: Register,
    values: Vec<Interval>,
}

impl Enclosure {
    /// Creates the enclosure of what depends on time alone; the prologue must have been run. Later calls do not allocate.
    #[must_use]
    pub fn of_time(program: &Program, registers: &Registers) -> Enclosure {
        Enclosure::new(program, registers, true)
    }

    /// Creates the enclosure of what depends on the motion.
    #[must_use]
    pub fn of_motion(program: &Program, registers: &Registers) -> Enclosure {
        Enclosure::new(program, registers, false)
    }

    /// Creates the enclosure of registers that depend on time alone.
    #[must_use]
    pub fn for_registers(program: &Program, registers: &Registers, roots: &[Register]) -> Enclosure {
        Enclosure {
            operations: backward_slice(program, roots, &[Stage::Time]),
            switches: Vec::new(),
            conditions: Vec::new(),
            watches: Vec::new(),
            coordinates: None,
            time: program.inputs.time,
            values: (0..program.registers()).map(|k| point(registers.get(k as u32))).collect(),
        }
    }

    /// Creates the enclosure of domain boundaries: those that depend on time alone, or all others.
    #[must_use]
    pub fn of_domain_boundaries(program: &Program, registers: &Registers, on_time: bool) -> Enclosure {
        let boundaries = program.outputs.domain_boundaries.iter().filter(|boundary| boundary.is_of_time() == on_time);
        let roots: Vec<Register> =
            boundaries.flat_map(|boundary| [boundary.gauge].into_iter().chain(boundary.slope)).collect();
        let stages: &[Stage] = if on_time {
            &[Stage::DomainBoundaries, Stage::Time]
        } else {
            &[Stage::DomainBoundaries, Stage::Position, Stage::Time]
        };
        Enclosure {
            operations: backward_slice(program, &roots, stages),
            ..Enclosure::for_registers(program, registers, &[])
        }
    }

    fn new(program: &Program, registers: &Registers, on_time: bool) -> Enclosure {
        let mut in_motion = vec![false; program.registers()];
        for &op in program.stage(Stage::Position) {
            for register in op.writes() {
                in_motion[register as usize] = true;
            }
        }
        let is_selected = |register: &Register| in_motion[*register as usize] != on_time;
        let switches: Vec<Register> =
            program.switches().iter().filter(|switch| switch.on_time == on_time).map(|switch| switch.to).collect();
        let of = |list: &[Register]| list.iter().copied().filter(is_selected).collect::<Vec<Register>>();
        let (conditions, watches) = (of(&program.outputs.conditions), of(&program.outputs.watches));
        let roots: Vec<Register> = switches.iter().chain(&conditions).chain(&watches).copied().collect();
        Enclosure {
            operations: backward_slice(
                program,
                &roots,
                if on_time { &[Stage::Time] } else { &[Stage::Position, Stage::Time] },
            ),
            switches,
            conditions,
            watches,
            coordinates: (!on_time).then_some(program.inputs.coordinates[0]),
            time: program.inputs.time,
            // computed registers are overwritten in each run
            values: (0..program.registers()).map(|k| point(registers.get(k as u32))).collect(),
        }
    }

    /// Returns whether there is nothing to prove.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.switches.is_empty() && self.conditions.is_empty() && self.watches.is_empty()
    }

    /// Returns whether all conditions hold for the given register values.
    pub fn conditions_hold(&self, value: impl Fn(Register) -> f64) -> bool {
        self.conditions.iter().all(|&register| value(register) > 0.0)
    }

    /// Returns whether nothing happens between two times (s), while coordinates stay in their intervals (center and radius). Frozen
    /// switches and signs of monitors are those in `registers`; a switch for which `may_change` returns true is ignored.
    pub fn is_steady(
        &mut self,
        program: &Program,
        registers: &Registers,
        [from, to]: [f64; 2],
        coordinates: &[[f64; 2]],
        may_change: impl Fn(Register) -> bool,
    ) -> bool {
        if let Some(first) = self.coordinates {
            self.set_all(first, coordinates);
        }
        if !self.run(program, registers, [from, to], may_change) {
            return false;
        }
        let v = &self.values;
        let has_sign = |register: &Register| {
            let (now, value) = (registers.get(*register), v[*register as usize]);
            if now > 0.0 { value.low > 0.0 } else { value.high <= 0.0 }
        };
        self.conditions.iter().all(|&register| v[register as usize].low > 0.0) && self.watches.iter().all(has_sign)
    }

    /// Encloses all values between two times (s), with switches frozen as in `registers`.
    pub fn enclose(&mut self, program: &Program, registers: &Registers, times: [f64; 2]) {
        self.run(program, registers, times, |_| true);
    }

    /// Sets intervals (center and radius) for a run of registers.
    pub fn set_all(&mut self, first: Register, boxes: &[[f64; 2]]) {
        for (k, [middle, reach]) in boxes.iter().enumerate() {
            self.values[first as usize + k] =
                if *reach > 0.0 { wider(middle - reach, middle + reach) } else { point(*middle) };
        }
    }

    /// Returns the registers that its operations read and do not compute, but for the time; each may be read more than once.
    #[must_use]
    pub fn operands(&self, program: &Program) -> Vec<Register> {
        let is_computed = |register: &Register| self.operations.iter().any(|op| op.writes().contains(register));
        let read = self.operations.iter().flat_map(|&op| program.reads(op));
        read.filter(|register| *register != self.time && !is_computed(register)).collect()
    }

    /// Returns the enclosure `[low, high]` of a register.
    #[must_use]
    pub fn range(&self, register: Register) -> [f64; 2] {
        let Interval { low, high } = self.values[register as usize];
        [low, high]
    }

    /// Runs the operations; returns false as soon as a switch may change that must not.
    fn run(
        &mut self,
        program: &Program,
        registers: &Registers,
        [from, to]: [f64; 2],
        may_change: impl Fn(Register) -> bool,
    ) -> bool {
        let v = &mut self.values;
        v[self.time as usize] = Interval { low: from, high: to };
        for &op in &self.operations {
            enclose(program, op, v);
            let Some(to) = op.switched() else {
                continue;
            };
            let value = v[to as usize];
            let frozen = point(registers.get(to));
            let is_same = [value.low, value.high].iter().all(|end| end.to_bits() == frozen.low.to_bits());
            if !is_same && self.switches.contains(&to) && !may_change(to) {
                return false;
            }
            v[to as usize] = frozen;
        }
        true
    }
}

/// Returns the operations of some stages that registers depend on, in order of evaluation. `stages` starts with the last one.
pub(super) fn backward_slice(program: &Program, roots: &[Register], stages: &[Stage]) -> Vec<Op> {
    let mut needed = vec![false; program.registers()];
    for &root in roots {
        needed[root as usize] = true;
    }
    let mut operations = Vec::new();
    for &op in stages.iter().flat_map(|&stage| program.stage(stage).iter().rev()) {
        if op.writes().iter().any(|&register| needed[register as usize]) {
            operations.push(op);
            for register in program.reads(op) {
                needed[register as usize] = true;
            }
        }
    }
    operations.reverse();
    operations
}

/// Encloses the result of an operation.
pub(super) fn enclose(program: &Program, op: Op, v: &mut [Interval]) {
    match op {
        // equal operands are correlated, which interval arithmetic ignores
        Op::Mul { to, a, b } if a == b => v[to as usize] = square(v[a as usize]),
        Op::Compare { comparison, to, a, b } if a == b => v[to as usize] = point(compare(comparison, 0.0, 0.0)),
        _ => op.run(&mut Intervals { program, v }),
    }
}

/// Machine on registers that hold intervals.
struct Intervals<'i> {
    program: &'i Program,
    v: &'i mut [Interval],
}

impl Machine for Intervals<'_> {
    type Value = Interval;

    fn read(&mut self, register: Register) -> Interval {
        self.v[register as usize]
    }

    fn write(&mut self, register: Register, value: Interval) {
        self.v[register as usize] = value;
    }

    fn add(&mut self, a: Interval, b: Interval) -> Interval {
        rounded([a, b], a.low + b.low, a.high + b.high)
    }

    fn sub(&mut self, a: Interval, b: Interval) -> Interval {
        rounded([a, b], a.low - b.high, a.high - b.low)
    }

    fn mul(&mut self, a: Interval, b: Interval) -> Interval {
        let is_zero = |of: Interval| of.low == 0.0 && of.high == 0.0;
        if is_zero(a) || is_zero(b) {
            return point(0.0);
        }
        corners(a, b, |x, y| if x == 0.0 || y == 0.0 { 0.0 } else { x * y })
    }

    fn div(&mut self, a: Interval, b: Interval) -> Interval {
        quotient(a, b)
    }

    fn neg(&mut self, a: Interval) -> Interval {
        Interval { low: -a.high, high: -a.low }
    }

    fn recip(&mut self, a: Interval) -> Interval {
        quotient(point(1.0), a)
    }

    fn sin_cos(&mut self, a: Interval) -> [Interval; 2] {
        sin_cos_range(a)
    }

    fn unary(&mut self, function: Unary, a: Interval) -> Interval {
        unary_range(function, a)
    }

    fn binary(&mut self, function: Binary, a: Interval, b: Interval) -> Interval {
        binary_range(function, a, b)
    }

    fn compare(&mut self, comparison: Comparison, a: Interval, b: Interval) -> Interval {
        comparison_range(comparison, a, b)
    }

    // switches that have been examined are points

    fn and(&mut self, a: Interval, b: Interval) -> Interval {
        exact(a.low.min(b.low), a.high.min(b.high))
    }

    fn or(&mut self, a: Interval, b: Interval) -> Interval {
        exact(a.low.max(b.low), a.high.max(b.high))
    }

    fn not(&mut self, a: Interval) -> Interval {
        exact(1.0 - a.high, 1.0 - a.low)
    }

    fn select(&mut self, condition: Interval, a: Interval, b: Interval) -> Interval {
        match condition {
            Interval { low: 0.0, high: 0.0 } => b,
            Interval { low, high } if low <= 0.0 && high >= 0.0 => hull(a, b),
            _ => a,
        }
    }

    fn either(&mut self, condition: Interval, a: Interval, b: Interval) -> Interval {
        self.select(condition, a, b)
    }

    fn piece(&mut self, table: u32, a: Interval) -> Interval {
        let layout = &self.program.tables()[table as usize];
        let knot = |k: usize| self.v[layout.knots as usize + k].low;
        let number = |x: f64| piece(layout.pieces as usize, knot, x) as f64;
        Interval { low: number(a.low), high: number(a.high) }
    }

    fn pick(&mut self, table: u32, column: Column, piece: Interval) -> Interval {
        let (first, last) = (piece.low, piece.high);
        // several pieces if the argument crosses a knot: all of them
        if first.total_cmp(&last).is_eq() {
            column_entry(self.program, table, column, first, self.v)
        } else {
            column_hull(self.program, table, column, [first, last], self.v)
        }
    }
}

fn point(value: f64) -> Interval {
    if value.is_nan() { WHOLE } else { Interval { low: value + 0.0, high: value + 0.0 } }
}

/// Creates an interval with exact ends.
fn exact(low: f64, high: f64) -> Interval {
    if low.is_nan() || high.is_nan() { WHOLE } else { Interval { low: low + 0.0, high: high + 0.0 } }
}

/// Returns the smallest interval that contains both.
pub(super) fn hull(a: Interval, b: Interval) -> Interval {
    Interval { low: a.low.min(b.low), high: a.high.max(b.high) }
}

/// Widens an interval by one rounding on either side.
fn wider(low: f64, high: f64) -> Interval {
    if low.is_nan() || high.is_nan() { WHOLE } else { Interval { low: low.next_down(), high: high.next_up() } }
}

/// Widens a result for rounding, unless the operands are points: then the program computes this very number.
fn rounded<const N: usize>(of: [Interval; N], low: f64, high: f64) -> Interval {
    let is_point = |of: &Interval| of.low.total_cmp(&of.high).is_eq();
    if of.iter().all(is_point) && low.is_finite() && low.total_cmp(&high).is_eq() {
        point(low)
    } else {
        wider(low, high)
    }
}

/// Encloses sine and cosine, by the Lipschitz constant 1 and by the slope in the middle with half the squared radius.
fn sin_cos_range(a: Interval) -> [Interval; 2] {
    let middle = 0.5 * a.low + 0.5 * a.high;
    let reach = (a.high - middle).max(middle - a.low).next_up();
    let values = [Unary::Sin, Unary::Cos].map(|function| unary_value(function, middle));
    [[values[0], values[1]], [values[1], values[0]]].map(|[value, slope]| {
        if value.is_nan() || !reach.is_finite() {
            return Interval { low: -1.0, high: 1.0 };
        }
        let off = reach * (slope.abs() + 0.5 * reach).min(1.0) + 2.0 * f64::EPSILON;
        let reached = wider(value - off, value + off);
        Interval { low: reached.low.max(-1.0), high: reached.high.min(1.0) }
    })
}

/// Encloses a square, which is never negative.
fn square(a: Interval) -> Interval {
    let a = unary_range(Unary::Abs, a);
    let squared = rounded([a], a.low * a.low, a.high * a.high);
    Interval { low: squared.low.max(0.0), high: squared.high }
}

/// Encloses a function that is monotone in each operand by its values at the corners.
fn corners(a: Interval, b: Interval, f: impl Fn(f64, f64) -> f64) -> Interval {
    let all = [f(a.low, b.low), f(a.low, b.high), f(a.high, b.low), f(a.high, b.high)];
    if all.iter().any(|x| x.is_nan()) {
        return WHOLE;
    }
    let [low, high] = [f64::min, f64::max].map(|of| all.into_iter().fold(f64::NAN, of));
    rounded([a, b], low, high)
}

fn quotient(a: Interval, b: Interval) -> Interval {
    if b.low <= 0.0 && b.high >= 0.0 { WHOLE } else { corners(a, b, |x, y| x / y) }
}

pub(super) fn unary_range(function: Unary, a: Interval) -> Interval {
    let (low, high) = (unary_value(function, a.low), unary_value(function, a.high));
    match function {
        Unary::Sin => sin_cos_range(a)[0],
        Unary::Cos => sin_cos_range(a)[1],
        // exact and monotone
        Unary::Sign | Unary::Floor if !low.is_nan() && !high.is_nan() => Interval { low: low + 0.0, high: high + 0.0 },
        Unary::Acos => loose(high, low),
        Unary::Abs if a.low >= 0.0 => a,
        Unary::Abs if a.high <= 0.0 => Interval { low: -a.high, high: -a.low },
        Unary::Abs => Interval { low: 0.0, high: a.high.max(-a.low) },
        Unary::Cosh if a.low < 0.0 && a.high > 0.0 => loose(1.0, low.max(high)),
        Unary::Cosh => loose(low.min(high), low.max(high)),
        Unary::Tan => {
            // the poles are as uncertain as the argument
            let slack = POLE_MARGIN + 4.0 * f64::EPSILON * a.low.abs().max(a.high.abs());
            let branch = |x: f64| mechc_expr::math::floor((x + FRAC_PI_2) / PI);
            let one_branch = branch(a.low - slack).to_bits() == branch(a.high + slack).to_bits();
            if one_branch && low <= high { loose(low, high) } else { WHOLE }
        }
        // all other functions are increasing
        _ => loose(low, high),
    }
}

pub(super) fn binary_range(function: Binary, a: Interval, b: Interval) -> Interval {
    let value = |x: f64, y: f64| binary_value(function, x, y);
    let loosened = |i: Interval| loose(i.low, i.high);
    match function {
        // a whole power of a negative number exists
        Binary::Pow if a.low < 0.0 && b.low.total_cmp(&b.high).is_eq() && b.low.fract() == 0.0 => {
            let size = unary_range(Unary::Abs, a);
            let powers = [size.low, size.high].map(|x| value(x, b.low));
            match b.low % 2.0 {
                _ if size.low == 0.0 && b.low < 0.0 => WHOLE,
                0.0 => loose(powers[0].min(powers[1]), powers[0].max(powers[1])),
                _ if b.low > 0.0 => loose(value(a.low, b.low), value(a.high, b.low)),
                _ => loose(value(a.high, b.low), value(a.low, b.low)),
            }
        }
        Binary::Min | Binary::Max => Interval { low: value(a.low, b.low), high: value(a.high, b.high) },
        Binary::Hypot => loosened(corners(unary_range(Unary::Abs, a), unary_range(Unary::Abs, b), value)),
        Binary::Pow if a.low > 0.0 || (a.low >= 0.0 && b.low > 0.0) => loosened(corners(a, b, value)),
        // away from its cut it is monotone in each operand
        Binary::Atan2 if b.low > 0.0 || a.low > 0.0 || a.high < 0.0 => loosened(corners(a, b, value)),
        Binary::Atan2 => Interval { low: -PI, high: PI },
        // `mod` is compiled to other operations
        Binary::Pow | Binary::Mod => WHOLE,
    }
}

/// Widens an interval by the few units in the last place that an elementary function may be off.
fn loose(low: f64, high: f64) -> Interval {
    let slack = |x: f64| 4.0 * f64::EPSILON * x.abs() + f64::MIN_POSITIVE;
    wider(low - slack(low), high + slack(high))
}

fn comparison_range(comparison: Comparison, a: Interval, b: Interval) -> Interval {
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

fn column_entry(program: &Program, table: u32, column: Column, piece: f64, v: &[Interval]) -> Interval {
    let range = program.tables()[table as usize].column(column);
    if piece.is_nan() || piece < 0.0 {
        return WHOLE;
    }
    // pieces are small nonnegative integers
    #[allow(clippy::cast_sign_loss)]
    let at = range.start + piece as u32;
    v[at.min(range.end - 1) as usize]
}

/// Encloses the column entries of all pieces from `first` to `last`.
fn column_hull(program: &Program, table: u32, column: Column, [first, last]: [f64; 2], v: &[Interval]) -> Interval {
    let count = last - first;
    if count.is_nan() || count > MOST_PIECES {
        return WHOLE;
    }
    let mut all = column_entry(program, table, column, first, v);
    let mut piece = first;
    while piece < last {
        piece += 1.0;
        all = hull(all, column_entry(program, table, column, piece, v));
    }
    all
}
