//! Integrals over time, by formulas that take value and derivatives of both ends of a cell (Euler and Maclaurin); of what has no
//! derivatives by values within (Lobatto).

use super::curve::{Cell, Point, Verdict};
use super::probe::{Probe, Scale};
use super::reduced::Found;
use crate::tolerances::results::quadrature::{ACCURACY, DIVERGES, LOOKS, NOTHING, ROUNDING, SAFETY};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::rc::Rc;

/// Places within a cell from −1 to 1, with their weights and that of its ends: Lobatto's rule of five points, exact for polynomials of
/// degree 7. Source: M. Abramowitz, I. Stegun, *Handbook of Mathematical Functions*, 1964, 25.4.32.
const LOBATTO: [[f64; 2]; 3] =
    [[-0.654_653_670_707_977_1, 49.0 / 90.0], [0.0, 32.0 / 45.0], [0.654_653_670_707_977_1, 49.0 / 90.0]];
const LOBATTO_ENDS: f64 = 0.1;

/// An integral over time.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Integral {
    sum: f64,
    /// How far off it may be.
    off: f64,
    /// For how long (s) the formula has a value.
    time: f64,
    /// The integral of the magnitude.
    size: f64,
    /// What the cell too short to be cut that holds the most may hold, and its time (s).
    shortest: [f64; 2],
}

/// What a rule finds of a cell, and the values in it allow: where the formula bends at an end of the cell its derivatives there may be those of the
/// other side.
fn within(found: f64, [least, most]: [f64; 2]) -> f64 {
    if found.is_finite() && least <= most { found.max(least).min(most) } else { found }
}

impl Integral {
    /// The integral, and how far off it may be.
    pub fn found(&self) -> Found {
        Found { value: self.sum, off: self.off + ROUNDING * self.size }
    }

    /// For how long (s) the formula has a value.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// A time (s) at which a cell too short to be cut holds much of the integral, if there is one: the formula goes to infinity there, and the
    /// integral too.
    pub fn unbounded(&self) -> Option<f64> {
        let [most, t] = self.shortest;
        (most > DIVERGES * self.size).then_some(t)
    }

    fn add(&mut self, sum: f64, off: f64, time: f64) {
        self.sum += sum;
        self.size += sum.abs();
        self.off += off;
        self.time += time;
    }
}

/// A cell with what is known of the integral over it.
struct Part {
    halves: [Cell; 2],
    /// The cell's first time (s), and its length (s).
    from: f64,
    length: f64,
    found: f64,
    off: f64,
}

impl PartialEq for Part {
    fn eq(&self, other: &Part) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Part) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    /// By how far off they may be; what is earlier comes first.
    fn cmp(&self, other: &Part) -> Ordering {
        self.off.total_cmp(&other.off).then(other.from.total_cmp(&self.from))
    }
}

impl Probe<'_> {
    /// Adds the integral of the formula over some cells. What may be farthest off is made better first, until all together is good enough beside the
    /// integral of how far the formula is from a value that is usual.
    pub(super) fn integrate(&mut self, cells: &[Cell], usual: f64, scale: Scale, integral: &mut Integral) {
        let mut parts = BinaryHeap::new();
        for cell in cells {
            self.take(cell.clone(), &mut parts, integral);
        }
        let is_open = |parts: &BinaryHeap<Part>| {
            let (mut off, mut size) = (0.0, 0.0);
            for part in parts {
                off += part.off;
                size += if part.off.is_finite() { (part.found - usual * part.length).abs() } else { 0.0 };
            }
            off > f64::max(ACCURACY * size, ROUNDING * scale.weight * scale.span).max(NOTHING)
        };
        // all together is looked at no more often than some have been cut
        let mut left = 0;
        loop {
            if left == 0 {
                if self.notes.trouble.is_some() || !is_open(&parts) {
                    break;
                }
                left = parts.len().div_ceil(LOOKS);
            }
            left -= 1;
            let Some(part) = parts.pop() else { break };
            for cell in part.halves {
                self.take(cell, &mut parts, integral);
            }
        }
        let mut parts = parts.into_vec();
        parts.sort_unstable_by(|a, b| a.from.total_cmp(&b.from));
        parts.into_iter().for_each(|part| integral.add(part.found, part.off, part.length));
    }

    /// Takes in a cell: what is known of the integral over it, or over its parts where a guard crosses its threshold in it.
    fn take(&mut self, cell: Cell, parts: &mut BinaryHeap<Part>, integral: &mut Integral) {
        let mut open = vec![cell];
        while let Some(mut cell) = open.pop() {
            let h = cell.length();
            if self.is_shortest(&cell) {
                self.integrate_shortest(&cell, integral);
                continue;
            }
            let (verdict, range) = self.enclose(&mut cell);
            match verdict {
                Verdict::Crosses(guard) => {
                    let Some(cells) = self.cut_at_crossing(&cell, guard) else { return };
                    open.extend(cells.into_iter().flatten().rev());
                    continue;
                }
                Verdict::Missing => {
                    self.miss(cell.step, cell.a.state.t);
                    continue;
                }
                Verdict::Smooth | Verdict::Open => {}
            }
            let is_smooth = verdict == Verdict::Smooth && range.is_resolved;
            let is_smooth = is_smooth && (self.curve.derivatives() == 0 || !self.curve.derivative(1).may_switch);
            let Some(halves) = self.halve(&cell) else { return };
            let values = [&cell.a, &halves[0].b, &cell.b].map(|point| point.sample.value);
            let (mut found, mut off) = (0.0, f64::INFINITY);
            if values.iter().all(|value| value.is_finite()) {
                let (sum, error) = self.both_rules(&cell, &halves);
                found = within(sum, [range.low * h, range.high * h]);
                let largest = values.iter().fold(0.0, |largest, value| f64::max(largest, value.abs()));
                let rounding = ROUNDING * largest * h;
                let by_rule = if is_smooth { error - rounding } else { f64::INFINITY };
                off = by_rule.min((range.high - range.low) * h).max(0.0);
            }
            parts.push(Part { halves, from: cell.a.state.t, length: h, found, off });
        }
    }

    /// As [`Probe::integrate`], over a cell too short to be cut.
    fn integrate_shortest(&mut self, cell: &Cell, integral: &mut Integral) {
        let h = cell.length();
        let values = [&cell.a, &cell.b].map(|point| point.sample.value);
        let known: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        if known.len() < 2 {
            self.miss(cell.step, cell.a.state.t);
        }
        if !known.is_empty() {
            let largest = known.iter().fold(0.0, |largest, value| f64::max(largest, value.abs()));
            if h * largest > integral.shortest[0] {
                integral.shortest = [h * largest, cell.a.state.t];
            }
            integral.add(h * known.iter().sum::<f64>() / known.len() as f64, 2.0 * h * largest, h);
        }
    }

    /// The integral over a cell by its halves, made better by what the whole says, and how far off it may be.
    fn both_rules(&mut self, cell: &Cell, halves: &[Cell; 2]) -> (f64, f64) {
        let whole = self.rule(cell, &cell.a, &cell.b);
        let parts = self.rule(cell, &halves[0].a, &halves[0].b) + self.rule(cell, &halves[1].a, &halves[1].b);
        let gained = [255.0, 15.0, 63.0][self.curve.derivatives()];
        let better = (parts - whole) / gained;
        if better.is_finite() {
            return (parts + better, SAFETY * better.abs());
        }
        let h = cell.length();
        let middle = halves[0].b.sample.value;
        (0.25 * h * (cell.a.sample.value + 2.0 * middle + cell.b.sample.value), f64::INFINITY)
    }

    /// The integral of the polynomial that has the values and derivatives of two points of a cell.
    fn rule(&mut self, cell: &Cell, a: &Rc<Point>, b: &Rc<Point>) -> f64 {
        if self.curve.derivatives() == 0 {
            return self.rule_of_values(cell, a, b);
        }
        let (h, [a, b]) = (b.state.t - a.state.t, [a.sample, b.sample]);
        let values = 0.5 * h * (a.value + b.value);
        match self.curve.derivatives() {
            1 => values + h * h / 12.0 * (a.first - b.first),
            _ => values + h * h / 10.0 * (a.first - b.first) + h * h * h / 120.0 * (a.second + b.second),
        }
    }

    /// As [`Probe::rule`], by values alone; not a number where one cannot be had.
    fn rule_of_values(&mut self, cell: &Cell, a: &Rc<Point>, b: &Rc<Point>) -> f64 {
        let (from, to) = (a.state.t, b.state.t);
        let mut sum = LOBATTO_ENDS * (a.sample.value + b.sample.value);
        for [place, weight] in LOBATTO {
            let t = from + 0.5 * (1.0 + place) * (to - from);
            sum += weight * self.point(cell, t).map_or(f64::NAN, |point| point.sample.value);
        }
        0.5 * (to - from) * sum
    }
}
