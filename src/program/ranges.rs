//! Ranges of formulas over a stretch of the motion: a program's operations, run on intervals.
//!
//! Unlike an [`Enclosure`](super::Enclosure), which proves that no switch changes, a range is one of all branches that may count: it
//! holds every value, and tells whether there may be jumps among them.
//!
//! Where a formula may change its branch, or the argument of a table goes over a knot, each branch and each piece is looked at by itself: what
//! is put together of two says little of either.

use super::enclose::{Interval, behind, enclose, hull};
use super::ways::{Ways, stay_in_piece};
use super::{Op, Program, Register, Registers, Stage};
use crate::expr::{Binary, Unary};
use crate::tolerances::results::ranges::{MOST_WAYS, WIDEST, WIDEST_RATIO, WIDEST_VALUE};

/// What a formula is enclosed in.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Range {
    /// No value is below.
    pub low: f64,
    /// No value is above.
    pub high: f64,
    /// Whether the formula may change its branch, so that it or what is derived from it may jump.
    pub may_switch: bool,
    /// Whether every function in it changes so little that a few terms of its series tell all.
    pub is_resolved: bool,
    /// Whether a table in it may go on from one piece to the next.
    pub crosses_knots: bool,
}

/// As in [`Range`].
#[derive(Clone, Copy, Debug)]
struct Found {
    may_switch: bool,
    is_resolved: bool,
    crosses_knots: bool,
}

const NOTHING: Found = Found { may_switch: false, is_resolved: true, crosses_knots: false };

impl Found {
    fn of_both(self, other: Found) -> Found {
        Found {
            may_switch: self.may_switch || other.may_switch,
            is_resolved: self.is_resolved && other.is_resolved,
            crosses_knots: self.crosses_knots || other.crosses_knots,
        }
    }
}

/// Room for the ranges of some formulas, each of which may use what those before it have.
#[derive(Clone, Debug)]
pub struct Ranges {
    /// By formula: the operations that those before it have not run.
    operations: Vec<Vec<Op>>,
    /// What each formula has found out beside its values.
    found: Vec<Found>,
    roots: Vec<Register>,
    /// Whether switches stay as the registers have them.
    is_frozen: bool,
    values: Vec<Interval>,
    time: Register,
    /// Where an argument of a periodic table goes from period to period.
    periods: Vec<Register>,
    /// Where third derivatives of tables stand.
    thirds: Vec<Register>,
    ways: Ways,
    /// The values on one of the ways.
    on_way: Vec<Interval>,
}

impl Ranges {
    /// For formulas that a stage leaves in some registers; the prologue must have been run.
    #[must_use]
    pub fn new(program: &Program, registers: &Registers, roots: &[Register], stage: Stage, is_frozen: bool) -> Ranges {
        let mut is_known = vec![false; program.registers()];
        let mut operations = Vec::new();
        for k in 0..roots.len() {
            let mut own = behind(program, &roots[..=k], &[stage]);
            own.retain(|&op| {
                let is_new = op.writes().iter().any(|&register| !is_known[register as usize]);
                op.writes().iter().for_each(|&register| is_known[register as usize] = true);
                is_new
            });
            operations.push(own);
        }
        let point = |value: f64| Interval { low: value, high: value };
        Ranges {
            operations,
            found: vec![NOTHING; roots.len()],
            roots: roots.to_vec(),
            is_frozen,
            values: (0..program.registers()).map(|k| point(registers.get(k as u32))).collect(),
            time: program.inputs.time,
            periods: program.tables().iter().flat_map(|table| table.periods.iter().copied()).collect(),
            thirds: program.tables().iter().flat_map(|table| table.thirds.iter().copied()).collect(),
            ways: Ways::default(),
            on_way: Vec::new(),
        }
    }

    /// Lets time be anywhere between two times (s).
    pub fn set_times(&mut self, [from, to]: [f64; 2]) {
        self.values[self.time as usize] = Interval { low: from, high: to };
    }

    /// Lets an input be anywhere between two values.
    pub fn set(&mut self, register: Register, [low, high]: [f64; 2]) {
        self.values[register as usize] = Interval { low, high };
    }

    /// The range of a formula; those before it must have been asked for since time and coordinates were set.
    pub fn range(&mut self, program: &Program, registers: &Registers, k: usize) -> Range {
        let mut found = if k == 0 { NOTHING } else { self.found[k - 1] };
        let mut jumps = found.may_switch;
        for at in 0..self.operations[k].len() {
            let op = self.operations[k][at];
            found.is_resolved &= is_resolved_in(op, &self.values);
            enclose(program, op, &mut self.values);
            if let (true, Some(to)) = (self.is_frozen, op.switched()) {
                let frozen = registers.get(to);
                self.values[to as usize] = Interval { low: frozen, high: frozen };
            }
            found = found.of_both(self.found_of(op, &self.values));
            jumps |= self.is_third_of_several(op);
        }
        let mut all = self.values[self.roots[k] as usize];
        if found.crosses_knots || found.may_switch {
            if let Some((one_by_one, found_so)) = self.range_by_ways(program, k) {
                all = Interval { low: all.low.max(one_by_one.low), high: all.high.min(one_by_one.high) };
                found = found_so;
            } else {
                found.is_resolved = false;
            }
        }
        found.may_switch |= jumps;
        self.found[k] = found;
        let Found { may_switch, is_resolved, crosses_knots } = found;
        Range { low: all.low, high: all.high, may_switch, is_resolved: is_resolved && !may_switch, crosses_knots }
    }

    /// What the result of an operation says, which has just been enclosed.
    fn found_of(&self, op: Op, v: &[Interval]) -> Found {
        let width = |register: Register| v[register as usize].high - v[register as usize].low;
        let changes = op.switched().is_some_and(|to| {
            let Interval { low, high } = v[to as usize];
            low.total_cmp(&high).is_ne()
        });
        let crosses_knots = changes && self.is_of_table(op);
        Found {
            // a spline goes on over its knots
            may_switch: changes && !crosses_knots,
            is_resolved: bounded(op).is_none_or(|to| width(to) <= WIDEST_VALUE),
            crosses_knots,
        }
    }

    /// Whether an operation leaves the third derivative of a table, of more pieces than one.
    fn is_third_of_several(&self, op: Op) -> bool {
        let is_third = |&to: &Register| {
            let Interval { low, high } = self.values[to as usize];
            self.thirds.contains(&to) && low.total_cmp(&high).is_ne()
        };
        op.writes().iter().any(is_third)
    }

    /// Whether an operation tells where a table is entered.
    fn is_of_table(&self, op: Op) -> bool {
        matches!(op, Op::Piece { .. }) || op.switched().is_some_and(|to| self.periods.contains(&to))
    }

    /// The range of a formula, each branch and each piece of each table taken by itself; none where that would be too many ways.
    fn range_by_ways(&mut self, program: &Program, k: usize) -> Option<(Interval, Found)> {
        let (mut on_way, mut ways) = (std::mem::take(&mut self.on_way), std::mem::take(&mut self.ways));
        let mut all: Option<(Interval, Found)> = None;
        ways.begin();
        let mut is_last = false;
        for _ in 0..MOST_WAYS {
            on_way.clone_from(&self.values);
            let Some(found) = self.go(program, k, (&mut ways, &mut on_way)) else { break };
            let value = on_way[self.roots[k] as usize];
            all = Some(all.map_or((value, found), |(hull_so_far, found_so_far)| {
                (hull(hull_so_far, value), found_so_far.of_both(found))
            }));
            is_last = !ways.go_on();
            if is_last {
                break;
            }
        }
        (self.on_way, self.ways) = (on_way, ways);
        all.filter(|_| is_last)
    }

    /// Runs all operations of a formula on one of the ways; none where there are too many.
    fn go(&self, program: &Program, k: usize, (ways, v): (&mut Ways, &mut [Interval])) -> Option<Found> {
        let mut found = NOTHING;
        for &op in self.operations[..=k].iter().flatten() {
            found.is_resolved &= is_resolved_in(op, v);
            enclose(program, op, v);
            found = found.of_both(self.found_of(op, v));
            if let Some(to) = op.switched() {
                let Interval { low, high } = v[to as usize];
                // over two knots there is no telling what lies between from what is at the ends
                found.is_resolved &= high - low <= 1.0;
                let taken = ways.take(v[to as usize])?;
                v[to as usize] = Interval { low: taken, high: taken };
                stay_in_piece(program, op, taken, v);
            }
        }
        Some(found)
    }
}

/// Where a function leaves its value that stays within bounds, so that it is resolved where it changes little, however its argument
/// does.
fn bounded(op: Op) -> Option<Register> {
    match op {
        Op::Unary { function: Unary::Tanh | Unary::Asin | Unary::Acos, to, .. }
        | Op::Binary { function: Binary::Atan2, to, .. } => Some(to),
        _ => None,
    }
}

/// Whether the argument of an operation changes so little that a few terms of its series tell all.
fn is_resolved_in(op: Op, v: &[Interval]) -> bool {
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
