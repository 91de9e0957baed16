//! The range of a formula between two states, and whether its guards cross their thresholds there.

use super::{Curve, Moving, Point};
use crate::analysis::results::guards::Crossing;
use crate::analysis::results::loads::Hidden;
use mechc_expr::math::between;
use mechc_ir::program::Range;
use std::rc::Rc;

/// Largest amplification of the uncertainty of a load by a formula.
const MAX_AMPLIFICATION: f64 = 1e200;
/// Factor by which a second or third derivative may deviate from a straight line between two states, relative to the deviation that
/// follows from the lower derivative at both; a parabola has 1.5. In a part of a cell the deviation falls with the square of the part, up to this factor.
const SAFETY: f64 = 2.0;

/// The interval between two points of one step of the motion.
#[derive(Clone)]
pub struct Cell {
    /// The number of the step.
    pub step: usize,
    pub a: Rc<Point>,
    pub b: Rc<Point>,
    /// Deviations from a straight line in the cell: those of the second and third derivative of each moving quantity, or of its only available
    /// order; then those of the values of the formula and of the loads. `None` if they have not been computed yet.
    deviations: Option<Rc<[[f64; 2]]>>,
    /// The length (s) of the cell that `deviations` belongs to; this cell may be a part of it.
    measured_length: f64,
    /// The point in the middle, if it has been evaluated.
    pub middle: Option<Rc<Point>>,
}

impl Cell {
    /// Returns the cell between two points, without bounds of the formula between them.
    pub fn new(step: usize, a: &Rc<Point>, b: &Rc<Point>) -> Cell {
        let (a, b) = (Rc::clone(a), Rc::clone(b));
        Cell { step, a, b, deviations: None, measured_length: f64::INFINITY, middle: None }
    }

    /// Returns the length (s).
    pub fn length(&self) -> f64 {
        self.b.state.t - self.a.state.t
    }

    /// Returns the time (s) in the middle.
    pub fn middle(&self) -> f64 {
        0.5 * self.a.state.t + 0.5 * self.b.state.t
    }

    /// Returns whether no representable time lies strictly between the ends.
    pub fn is_empty(&self) -> bool {
        let middle = self.middle();
        middle <= self.a.state.t || middle >= self.b.state.t
    }

    /// Returns the cell between two points of this one, with the bounds of this one.
    pub fn between(&self, a: &Rc<Point>, b: &Rc<Point>) -> Cell {
        let (deviations, measured_length) = (self.deviations.clone(), self.measured_length);
        Cell { deviations, measured_length, ..Cell::new(self.step, a, b) }
    }

    /// Stores the point in the middle, and measures there the deviations of quantities that have no derivatives.
    pub fn take_middle(&mut self, curve: &Curve, middle: Rc<Point>) {
        self.deviations = Some(curve.deviations_at(self, &middle));
        self.middle = Some(middle);
    }

    /// Divides the cell at a point.
    pub fn cut(&self, curve: &Curve, at: &Rc<Point>) -> [Cell; 2] {
        let deviations = Some(curve.deviations_at(self, at));
        [(&self.a, at), (at, &self.b)].map(|(a, b)| Cell { deviations: deviations.clone(), ..self.between(a, b) })
    }
}

/// The classification of a formula in a cell.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Verdict {
    /// No guard crosses its threshold.
    Smooth,
    /// A guard, by its number, is on different sides at both ends.
    Crosses(usize),
    /// The formula has no value.
    Missing,
    /// Rounding alone decides on which side of its threshold a guard is.
    Rounding,
    /// Rounding alone decides on which side a guard is, but the formula has the same value on both sides.
    Alike,
    /// The bounds are too wide to decide, in particular whether a guard, by its number, crosses its threshold.
    Open(Option<usize>),
}

impl Curve {
    /// Returns whether a body turns too far in a cell for the states at its ends to bound the motion between.
    pub fn turns_far(&self, cell: &Cell) -> bool {
        self.smooth.turns_far([&cell.a.state, &cell.b.state])
    }

    /// Returns the classification and the range of the formula in a cell; crossings of the `ignored` guards do not count.
    pub fn enclose(&mut self, cell: &mut Cell, ignored: &[usize]) -> (Verdict, Range) {
        (cell.deviations, cell.measured_length) = (Some(self.deviations_of(cell)), cell.length());
        self.set_cell(cell);
        let mut held = vec![false; self.guards.len()];
        for &guard in ignored {
            held[guard] = true;
        }
        loop {
            let range = self.value(cell, false);
            if range.low == f64::INFINITY {
                return (Verdict::Missing, range);
            }
            if !self.guards.is_empty() {
                self.ranges.find_live(&self.program, 0);
            }
            let exists = cell.a.exists() || cell.b.exists();
            let (mut verdict, mut monotone) = (Verdict::Smooth, Vec::new());
            for (k, held) in held.iter_mut().enumerate() {
                // a load determines a force, although the formula does not contain the load
                if *held || !(self.holds_forces || self.guards[k].is_live(&self.ranges)) {
                    continue;
                }
                let states = [&cell.a, &cell.b].map(|point| point.guard_states[k]);
                match self.guards[k].crossing(&self.ranges, states) {
                    // the function has no value on this side, and so neither has the formula
                    Crossing::Never if !exists && self.guards[k].is_beyond_end(states[0]) => {
                        return (Verdict::Missing, range);
                    }
                    Crossing::Never => {}
                    Crossing::Sure => return (Verdict::Crosses(k), range),
                    Crossing::Possible if self.is_monotone(k) => {
                        *held = true;
                        monotone.push((k, states[0].side));
                    }
                    Crossing::Possible => verdict = Verdict::Open(Some(k)),
                }
            }
            if monotone.is_empty() {
                return match verdict {
                    Verdict::Smooth if exists => (verdict, self.value(cell, true)),
                    Verdict::Smooth => (Verdict::Missing, range),
                    _ => (verdict, range),
                };
            }
            // guards that depend on these are decided again
            for (k, side) in monotone {
                self.guards[k].hold(side, &mut self.ranges);
            }
        }
    }

    /// Returns whether the argument of a guard is monotone in the cell.
    fn is_monotone(&mut self, guard: usize) -> bool {
        let Some([argument, slope]) = self.guards[guard].witness else { return false };
        let argument = self.ranges.range(&self.program, &self.registers, argument);
        let slope = self.ranges.range(&self.program, &self.registers, slope);
        !argument.may_switch && !slope.may_switch && (slope.low >= 0.0 || slope.high <= 0.0)
    }

    /// Returns the range of the value in the cell of the last [`Curve::set_cell`]. Forces have no derivatives, so that the range of a formula
    /// with forces narrows no faster than the cell; if it is resolved and no guard crosses (`is_smooth`), its sampled values bound it instead.
    fn value(&mut self, cell: &Cell, is_smooth: bool) -> Range {
        let Curve { ranges, program, registers, loads, .. } = self;
        let range = ranges.range(program, registers, 0);
        let is_resolved = range.is_resolved && is_smooth;
        let Some(deviations) = cell.deviations.as_ref().map(|deviations| &deviations[self.moving.len()..]) else {
            return range;
        };
        let by_values = || {
            let [low, high] = around(cell.a.sample.value, cell.b.sample.value, deviations[0][0]);
            Range { low: range.low.max(low), high: range.high.min(high), ..range }
        };
        if !self.holds_forces {
            // in short cells terms that cancel each other leave intervals that are much too wide
            let is_short = cell.length() <= self.short && cell.a.exists() && cell.b.exists();
            return if is_short && is_resolved { by_values() } else { range };
        }
        let bounds = |k: usize| around(cell.a.loads[k], cell.b.loads[k], deviations[1 + k][0]);
        let up_to = |most: f64| Range { low: -most, high: most, is_resolved: false, ..range };
        match loads.hidden(program, registers, ranges, bounds) {
            Hidden::Unbounded => up_to(f64::INFINITY),
            Hidden::AtMost(beyond) => up_to(f64::min(MAX_AMPLIFICATION * beyond, f64::MAX)),
            Hidden::Nothing if is_resolved => by_values(),
            Hidden::Nothing => range,
        }
    }

    /// Returns the range of a time derivative (1 or 2) in the cell that was enclosed last.
    pub fn derivative(&mut self, order: usize) -> Range {
        self.ranges.range(&self.program, &self.registers, self.first + order - 1)
    }

    /// Sets the ranges of time and of the moving quantities to those in a cell.
    fn set_cell(&mut self, cell: &Cell) {
        let h = cell.length();
        self.ranges.release();
        self.ranges.set_times([cell.a.state.t, cell.b.state.t]);
        let Some(deviations) = &cell.deviations else { return };
        let ends = cell.a.moving.iter().zip(&cell.b.moving);
        for ((of, (a, b)), deviations) in self.moving.iter().zip(ends).zip(deviations.iter()) {
            let registers = of.registers(&self.program.inputs);
            if of.is_of_forces() {
                registers.for_each(|(_, at)| self.ranges.set(at, around(a[0], b[0], deviations[0])));
                continue;
            }
            let third = around(a[3], b[3], deviations[1]);
            let second = around(a[2], b[2], deviations[0]);
            let first = between(a[1], b[1], second, h);
            let mut ranges = [between(a[0], b[0], first, h), first, second, third];
            if let Some(order) = self.order_of_square(*of) {
                ranges[order][0] = ranges[order][0].max(0.0);
            }
            registers.for_each(|(order, register)| self.ranges.set(register, ranges[order]));
        }
    }

    /// Returns the order at which a square stands, which is never negative; `None` for any other quantity.
    fn order_of_square(&self, of: Moving) -> Option<usize> {
        match of {
            Moving::Coordinate(k) if k >= self.coordinates => self.smooth.square(k - self.coordinates),
            _ => None,
        }
    }

    /// Returns [`Cell::deviations`] of a cell: the deviations of second and third derivatives follow from the lower derivatives at both ends.
    fn deviations_of(&self, cell: &Cell) -> Rc<[[f64; 2]]> {
        let h = cell.length();
        let previous = |k: usize| cell.deviations.as_ref().map_or([f64::INFINITY; 2], |deviations| deviations[k]);
        // in very short cells differences are rounding; the deviation in a part of a cell falls with the square of its length
        let part = h / cell.measured_length;
        let less = f64::min(SAFETY * part * part, 1.0);
        let of = |(k, of): (usize, &Moving)| {
            let (a, b) = (&cell.a.moving[k], &cell.b.moving[k]);
            let error = |order: usize| ((b[order - 1] - a[order - 1]) / h - 0.5 * (a[order] + b[order])).abs();
            let deviations = match self.orders(*of) {
                [from, to] if from == to => return previous(k),
                [2, _] => [h * (0.125 * (b[3] - a[3]).abs() + error(3)), 2.0 * error(3)],
                [_, 3] => [error(2) + h * (0.125 * (b[3] - a[3]).abs() + error(3)), 2.0 * error(3)],
                _ => [2.0 * error(2), 0.0],
            };
            [0, 1].map(|order| {
                f64::min(deviations[order], if less > 0.0 { less * previous(k)[order] } else { f64::INFINITY })
            })
        };
        let values = (self.moving.len()..self.moving.len() + 1 + self.loads.count()).map(previous);
        self.moving.iter().enumerate().map(of).chain(values).collect()
    }

    /// Returns [`Cell::deviations`] of both parts of a cell divided at a point, where quantities with a single available order are measured.
    fn deviations_at(&self, cell: &Cell, at: &Point) -> Rc<[[f64; 2]]> {
        let (a, b) = (&*cell.a, &*cell.b);
        let x = (at.state.t - a.state.t) / (b.state.t - a.state.t);
        let error = |of: &dyn Fn(&Point) -> f64| (of(at) - (1.0 - x) * of(a) - x * of(b)).abs();
        let of_moving = |(k, of): (usize, &Moving)| match self.orders(*of) {
            [order, to] if order == to => [error(&|point: &Point| point.moving[k][order]); 2],
            _ => cell.deviations.as_ref().map_or([f64::INFINITY; 2], |deviations| deviations[k]),
        };
        let local = [error(&|point: &Point| point.sample.value); 2];
        let of_loads = (0..self.loads.count()).map(|k| [error(&|point: &Point| point.loads[k]); 2]);
        self.moving.iter().enumerate().map(of_moving).chain([local]).chain(of_loads).collect()
    }
}

/// Returns the interval between two values, widened by [`SAFETY`] times `deviation` on both sides.
fn around(a: f64, b: f64, deviation: f64) -> [f64; 2] {
    let beyond = SAFETY * deviation;
    [a.min(b) - beyond, a.max(b) + beyond]
}
