//! Ranges of formulas over a stretch of the motion: a program's operations, run on intervals.
//!
//! Unlike an [`Enclosure`](super::Enclosure), which proves that no switch changes, a range holds the values of all branches that may be taken, and
//! says whether the formula may jump among them. A caller that knows on which side of its threshold a switch stays can hold it there.

use super::interval_eval::{Interval, backward_slice, binary_range, enclose, unary_range};
use super::{Op, Program, Register, Registers, Stage};
use mechc_expr::{Binary, Unary};

/// Largest change of the argument of a resolved function (rad or a pure number): its series converges with the first few terms.
const WIDEST: f64 = 1.0;
/// Largest change of a resolved bounded function.
const WIDEST_VALUE: f64 = 0.5;
/// Largest factor of change of a divisor or radicand.
const WIDEST_RATIO: f64 = 2.0;
/// Largest factor of change of a resolved power.
const WIDEST_POWER: f64 = 256.0;
/// An exponential or a high power that is at most this is resolved, whatever its argument does.
const VANISHES: f64 = 1e-40;
/// Lowest high power.
const HIGH_POWER: u32 = 8;

/// An interval that holds all values of a formula.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Range {
    /// Lower bound of the values.
    pub low: f64,
    /// Upper bound of the values.
    pub high: f64,
    /// True if the formula may jump or take another branch.
    pub may_switch: bool,
    /// True if every function in the formula changes so little that its values at both ends and its derivatives there describe it.
    pub is_resolved: bool,
    /// True if a table in the formula may cross from one piece to the next.
    pub crosses_knots: bool,
}

/// A restriction of a register's interval that the caller has proved.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Restriction {
    /// The register keeps one value: the result of a switch.
    At(f64),
    /// The register stays above zero.
    Above,
    /// The register stays below zero.
    Below,
}

impl Restriction {
    fn restrict(self, interval: Interval) -> Interval {
        match self {
            Restriction::At(value) => Interval { low: value, high: value },
            Restriction::Above => {
                Interval { low: interval.low.max(f64::MIN_POSITIVE), high: interval.high.max(f64::MIN_POSITIVE) }
            }
            Restriction::Below => {
                Interval { low: interval.low.min(-f64::MIN_POSITIVE), high: interval.high.min(-f64::MIN_POSITIVE) }
            }
        }
    }
}

/// Properties of an operation on the current intervals, as bits.
mod flags {
    pub const SWITCHES: u8 = 1;
    pub const IS_UNRESOLVED: u8 = 2;
    pub const CROSSES_KNOTS: u8 = 4;
}

/// An operation with the registers that are examined after it.
#[derive(Clone, Copy, Debug)]
struct Step {
    op: Op,
    /// Result that changes in jumps.
    switched: Option<Register>,
    /// True if `switched` is the piece of a table, or the period of a periodic one.
    is_of_table: bool,
    /// Result that is bounded for any arguments.
    bounded: Option<Register>,
    /// Third derivative of a table.
    third: Option<Register>,
    /// Result that may be negligible except in a narrow peak: of an exponential or a high power.
    peak: Option<Register>,
}

/// Working memory for the ranges of several formulas.
#[derive(Clone, Debug)]
pub struct Ranges {
    /// Operations that the formulas depend on, with their properties.
    steps: Vec<Step>,
    findings: Vec<u8>,
    /// Operations of each formula that earlier formulas do not run, and all operations that it depends on.
    additional: Vec<Vec<u32>>,
    dependencies: Vec<Vec<u32>>,
    roots: Vec<Register>,
    /// Number of formulas that have been evaluated since an input was set.
    evaluated: usize,
    /// True if switches keep the results that the registers hold.
    is_frozen: bool,
    values: Vec<Interval>,
    /// Restrictions by register, and the restricted registers.
    holds: Vec<Option<Restriction>>,
    held: Vec<Register>,
    /// True for registers on which the formula of the last [`Ranges::find_live`] depends.
    is_live: Vec<bool>,
    time: Register,
}

impl Ranges {
    /// Creates the memory for formulas that a stage leaves in `roots`; the prologue must have been run.
    #[must_use]
    pub fn new(program: &Program, registers: &Registers, roots: &[Register], stage: Stage, is_frozen: bool) -> Ranges {
        let of_tables = |list: fn(&super::TableLayout) -> &Vec<Register>| -> Vec<Register> {
            program.tables().iter().flat_map(|table| list(table).iter().copied()).collect()
        };
        let (periods, thirds) = (of_tables(|table| &table.periods), of_tables(|table| &table.thirds));
        let mut degrees = vec![1_u32; program.registers()];
        let step = |&op: &Op| {
            let peak = peak(op, &mut degrees);
            let switched = op.switched();
            let is_of_table = matches!(op, Op::Piece { .. }) || switched.is_some_and(|to| periods.contains(&to));
            let third = op.writes().iter().copied().find(|to| thirds.contains(to));
            Step { op, switched, is_of_table, bounded: bounded(op), third, peak }
        };
        let operations = backward_slice(program, roots, &[stage]);
        let mut number_of = vec![u32::MAX; program.registers()];
        for (number, op) in operations.iter().enumerate() {
            op.writes().iter().for_each(|&to| number_of[to as usize] = number as u32);
        }
        let mut is_assigned = vec![false; operations.len()];
        let (mut additional, mut dependencies) = (Vec::new(), Vec::new());
        for root in roots {
            let mut needed: Vec<u32> = Vec::new();
            let mut is_needed = vec![false; operations.len()];
            let mut open = vec![*root];
            while let Some(register) = open.pop() {
                let number = number_of[register as usize];
                if number != u32::MAX && !std::mem::replace(&mut is_needed[number as usize], true) {
                    needed.push(number);
                    open.extend(program.reads(operations[number as usize]));
                }
            }
            needed.sort_unstable();
            additional.push(needed.iter().copied().filter(|&number| !is_assigned[number as usize]).collect());
            for &number in &needed {
                is_assigned[number as usize] = true;
            }
            dependencies.push(needed);
        }
        let point = |value: f64| Interval { low: value, high: value };
        Ranges {
            steps: operations.iter().map(step).collect(),
            findings: vec![0; operations.len()],
            additional,
            dependencies,
            roots: roots.to_vec(),
            evaluated: 0,
            is_frozen,
            values: (0..program.registers()).map(|k| point(registers.get(k as u32))).collect(),
            holds: vec![None; program.registers()],
            held: Vec::new(),
            is_live: vec![false; program.registers()],
            time: program.inputs.time,
        }
    }

    /// Sets the interval of time (s).
    pub fn set_times(&mut self, times: [f64; 2]) {
        self.set(self.time, times);
    }

    /// Sets the interval of an input.
    pub fn set(&mut self, register: Register, [low, high]: [f64; 2]) {
        self.values[register as usize] = Interval { low, high };
        self.evaluated = 0;
    }

    /// Restricts a register until [`Ranges::release`].
    pub fn hold(&mut self, register: Register, hold: Restriction) {
        let at = register as usize;
        // an input is not computed, so it is restricted at once
        self.values[at] = hold.restrict(self.values[at]);
        if self.holds[at].replace(hold).is_none() {
            self.held.push(register);
        }
        self.evaluated = 0;
    }

    /// Lifts all restrictions; inputs have to be set again.
    pub fn release(&mut self) {
        for register in self.held.drain(..) {
            self.holds[register as usize] = None;
        }
        self.evaluated = 0;
    }

    /// Evaluates the ranges of all formulas.
    pub fn run_all(&mut self, program: &Program, registers: &Registers) {
        self.run_up_to(program, registers, self.roots.len());
    }

    fn run_up_to(&mut self, program: &Program, registers: &Registers, count: usize) {
        while self.evaluated < count {
            self.run(program, registers, self.evaluated);
            self.evaluated += 1;
        }
    }

    /// Returns the range of formula `k`.
    pub fn range(&mut self, program: &Program, registers: &Registers, k: usize) -> Range {
        self.run_up_to(program, registers, k + 1);
        let findings =
            self.dependencies[k].iter().fold(0, |findings, &number| findings | self.findings[number as usize]);
        let Interval { low, high } = self.values[self.roots[k] as usize];
        Range {
            low,
            high,
            may_switch: findings & flags::SWITCHES != 0,
            is_resolved: findings == 0,
            crosses_knots: findings & flags::CROSSES_KNOTS != 0,
        }
    }

    /// Runs the operations of a formula that earlier formulas have not run.
    fn run(&mut self, program: &Program, registers: &Registers, k: usize) {
        let v = &mut self.values;
        for &number in &self.additional[k] {
            let Step { op, switched, is_of_table, bounded, third, peak } = self.steps[number as usize];
            let mut findings = if is_resolved_in(op, peak, v) { 0 } else { flags::IS_UNRESOLVED };
            if may_jump(op, v) {
                findings |= flags::SWITCHES;
            }
            enclose(program, op, v);
            if let Some((to, value)) = within_domain(op, v) {
                v[to as usize] = value;
            }
            if self.is_frozen
                && let Some(to) = switched
            {
                let frozen = registers.get(to);
                v[to as usize] = Interval { low: frozen, high: frozen };
            }
            if !self.held.is_empty() {
                for &to in op.writes().iter() {
                    if let Some(hold) = self.holds[to as usize] {
                        v[to as usize] = hold.restrict(v[to as usize]);
                    }
                }
            }
            let changes = |to: Register| v[to as usize].low.total_cmp(&v[to as usize].high).is_ne();
            if switched.is_some_and(changes) {
                // a spline continues across its knots
                findings |= if is_of_table { flags::CROSSES_KNOTS } else { flags::SWITCHES };
            }
            if third.is_some_and(changes) {
                findings |= flags::SWITCHES;
            }
            if let Op::Binary { function: Binary::Pow, to, .. } = op
                && v[to as usize].high > WIDEST_POWER * v[to as usize].low
            {
                findings |= flags::IS_UNRESOLVED;
            }
            if peak.is_some_and(|to| v[to as usize].high <= VANISHES) {
                // however it changes, it is negligible
                findings &= !flags::IS_UNRESOLVED;
            }
            if bounded.is_some_and(|to| v[to as usize].high - v[to as usize].low > WIDEST_VALUE) {
                findings |= flags::IS_UNRESOLVED;
            }
            self.findings[number as usize] = findings;
        }
    }

    /// Finds the registers that a formula depends on under the decided branches; its range must have been evaluated.
    pub fn find_live(&mut self, program: &Program, k: usize) {
        self.is_live.fill(false);
        self.is_live[self.roots[k] as usize] = true;
        for &number in self.dependencies[k].iter().rev() {
            let op = self.steps[number as usize].op;
            if !op.writes().iter().any(|&to| self.is_live[to as usize]) {
                continue;
            }
            let is_decided = |register: Register| {
                let Interval { low, high } = self.values[register as usize];
                low.total_cmp(&high).is_eq()
            };
            match op {
                // a decided condition depends on nothing
                Op::And { to, .. } | Op::Or { to, .. } | Op::Not { to, .. } if is_decided(to) => {}
                Op::Select { condition, a, b, .. } if is_decided(condition) => {
                    let taken = if self.values[condition as usize].low == 0.0 { b } else { a };
                    self.is_live[taken as usize] = true;
                }
                _ => program.reads(op).for_each(|register| self.is_live[register as usize] = true),
            }
        }
    }

    /// Returns whether the formula depends on a register, as found by [`Ranges::find_live`].
    #[must_use]
    pub fn is_live(&self, register: Register) -> bool {
        self.is_live[register as usize]
    }

    /// Returns the interval `[low, high]` of a register after the last evaluation.
    #[must_use]
    pub fn interval(&self, register: Register) -> [f64; 2] {
        let Interval { low, high } = self.values[register as usize];
        [low, high]
    }
}

/// Returns the result of an operation with bounded values, which is resolved if it changes little, whatever its argument does.
fn bounded(op: Op) -> Option<Register> {
    match op {
        Op::Unary { function: Unary::Tanh | Unary::Asin | Unary::Acos, to, .. }
        | Op::Binary { function: Binary::Atan2, to, .. } => Some(to),
        _ => None,
    }
}

/// Returns the result of an operation that may peak: an exponential, a power, or a repeated square, by the degree of the factor.
fn peak(op: Op, degrees: &mut [u32]) -> Option<Register> {
    match op {
        Op::Unary { function: Unary::Exp, to, .. } | Op::Binary { function: Binary::Pow, to, .. } => Some(to),
        Op::Mul { to, a, b } if a == b => {
            let degree = degrees[a as usize].saturating_mul(2);
            degrees[to as usize] = degree;
            (degree >= HIGH_POWER).then_some(to)
        }
        _ => None,
    }
}

/// Returns the range of a function over the part of its argument that is in its domain, with its register, if only a part is.
fn within_domain(op: Op, v: &[Interval]) -> Option<(Register, Interval)> {
    if let Op::Binary { function: function @ Binary::Pow, to, a, b } = op {
        let (base, power) = (v[a as usize], v[b as usize]);
        let is_partly = base.low < 0.0 && base.high >= 0.0 && power.low > 0.0 && power.low.fract() != 0.0;
        let base = Interval { low: 0.0, ..base };
        return is_partly.then(|| (to, binary_range(function, base, power)));
    }
    let Op::Unary { function, to, a } = op else { return None };
    let [least, most] = match function {
        Unary::Sqrt => [0.0, f64::INFINITY],
        Unary::Asin | Unary::Acos => [-1.0, 1.0],
        _ => return None,
    };
    let Interval { low, high } = v[a as usize];
    let is_partly = (low < least || high > most) && low <= most && high >= least;
    is_partly.then(|| (to, unary_range(function, Interval { low: low.max(least), high: high.min(most) })))
}

/// Returns whether a function without a switch may jump: across the cut of `atan2`, or at a pole of `tan`.
fn may_jump(op: Op, v: &[Interval]) -> bool {
    match op {
        Op::Binary { function: Binary::Atan2, a: y, b: x, .. } => {
            let (y, x) = (v[y as usize], v[x as usize]);
            x.low <= 0.0 && y.low <= 0.0 && y.high >= 0.0
        }
        Op::Unary { function: Unary::Tan, a, .. } => {
            let tangent = unary_range(Unary::Tan, v[a as usize]);
            tangent.high - tangent.low == f64::INFINITY
        }
        _ => false,
    }
}

/// Returns whether the argument of an operation changes so little that a few terms of its series describe the result.
fn is_resolved_in(op: Op, peak: Option<Register>, v: &[Interval]) -> bool {
    let width = |register: Register| v[register as usize].high - v[register as usize].low;
    let ratio = |register: Register| {
        let Interval { low, high } = v[register as usize];
        let (least, largest) = if low > 0.0 { (low, high) } else { (-high, -low) };
        least > 0.0 && largest <= WIDEST_RATIO * least
    };
    match op {
        Op::SinCos { a, .. }
        | Op::Unary {
            function: Unary::Sin | Unary::Cos | Unary::Tan | Unary::Exp | Unary::Sinh | Unary::Cosh,
            a,
            ..
        } => width(a) <= WIDEST,
        Op::Mul { a, .. } if peak.is_some() => width(a) == 0.0 || ratio(a),
        Op::Unary { function: Unary::Sqrt | Unary::Ln | Unary::Log10, a, .. }
        | Op::Recip { a, .. }
        | Op::Div { b: a, .. }
        | Op::Binary { function: Binary::Pow, a, .. } => width(a) == 0.0 || ratio(a),
        Op::Binary { function: Binary::Hypot, a, b, .. } => {
            (width(a) == 0.0 && width(b) == 0.0) || ratio(a) || ratio(b)
        }
        _ => true,
    }
}
