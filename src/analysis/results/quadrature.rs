//! Integrals over time, by formulas that take value and derivatives of both ends of a cell (Euler and Maclaurin); of what has no
//! derivatives by values within (Lobatto).

use super::formulas::{Cell, Point};
use super::survey::{Root, Scale, Survey};
use crate::program::Range;
use crate::tolerances::results::quadrature::{ACCURACY, NEGLIGIBLE, NOTHING, ROUNDING};
use std::rc::Rc;

/// Places within a cell from −1 to 1, with their weights and that of its ends: Lobatto's rule of five points, exact for polynomials of
/// degree 7. Source: M. Abramowitz, I. Stegun, *Handbook of Mathematical Functions*, 1964, 25.4.32.
const LOBATTO: [[f64; 2]; 3] =
    [[-0.654_653_670_707_977_1, 49.0 / 90.0], [0.0, 32.0 / 45.0], [0.654_653_670_707_977_1, 49.0 / 90.0]];
const LOBATTO_ENDS: f64 = 0.1;

/// What a rule finds of a cell, and the values in it allow: where the formula bends at an end of the cell its derivatives there may be those of the
/// other side.
fn within(found: f64, [least, most]: [f64; 2]) -> f64 {
    if found.is_finite() && least <= most { found.max(least).min(most) } else { found }
}

impl Survey<'_> {
    /// The integral of the formula over a stretch.
    pub(super) fn integral(&mut self, root: &Root, scale: Scale) -> f64 {
        let mut sum = 0.0;
        let known = <[(Cell, Range); 2]>::try_from(root.parts.clone()).ok();
        let mut open = vec![(root.whole.clone(), known)];
        while let Some((cell, parts)) = open.pop() {
            let Some([first, second]) = parts.or_else(|| self.parts(&cell)) else {
                sum += self.rule(&cell.a, &cell.b);
                continue;
            };
            let h = cell.length();
            let is_resolved = first.1.is_resolved && second.1.is_resolved;
            let [low, high] = [f64::min(first.1.low, second.1.low), f64::max(first.1.high, second.1.high)];
            let widest = high - low;
            let halves = [first.0, second.0];
            let (found, error) = self.both_rules(&cell, &halves);
            let found = if self.formula.derivatives() > 0 { within(found, [low * h, high * h]) } else { found };
            let rounding = ROUNDING * scale.weight * h;
            let is_exact = is_resolved && error <= f64::max(ACCURACY * scale.range * h, rounding);
            let is_negligible = widest * h <= f64::max(NEGLIGIBLE * scale.range * scale.span, NOTHING);
            if is_exact || is_negligible || !self.goes_on(&cell, widest) {
                sum += found;
                continue;
            }
            let [left, right] = halves;
            open.push((right, None));
            open.push((left, None));
        }
        sum
    }

    /// The halves of a cell with what the formula can be in them.
    fn parts(&mut self, cell: &Cell) -> Option<[(Cell, Range); 2]> {
        let middle = self.middle(cell)?;
        let halves = cell.halves(self.formula, &middle);
        Some(halves.map(|half| {
            let range = self.smooth_range(&half);
            (half, range)
        }))
    }

    /// The integral over a cell by its halves, made better by what the whole says, and how far off it may be.
    fn both_rules(&mut self, cell: &Cell, halves: &[Cell; 2]) -> (f64, f64) {
        let whole = self.rule(&cell.a, &cell.b);
        let parts = self.rule(&halves[0].a, &halves[0].b) + self.rule(&halves[1].a, &halves[1].b);
        let gained = [255.0, 15.0, 63.0][self.formula.derivatives()];
        let better = (parts - whole) / gained;
        if better.is_finite() {
            return (parts + better, better.abs());
        }
        let h = cell.length();
        let middle = halves[0].b.sample.value;
        (0.25 * h * (cell.a.sample.value + 2.0 * middle + cell.b.sample.value), f64::INFINITY)
    }

    /// The integral of the polynomial that has the values and derivatives of two points.
    fn rule(&mut self, a: &Rc<Point>, b: &Rc<Point>) -> f64 {
        if self.formula.derivatives() == 0 {
            return self.rule_of_values(a, b);
        }
        let (h, [a, b]) = (b.state.t - a.state.t, [a.sample, b.sample]);
        let values = 0.5 * h * (a.value + b.value);
        match self.formula.derivatives() {
            1 => values + h * h / 12.0 * (a.first - b.first),
            _ => values + h * h / 10.0 * (a.first - b.first) + h * h * h / 120.0 * (a.second + b.second),
        }
    }

    /// The same by values alone; no number where one cannot be had.
    fn rule_of_values(&mut self, a: &Rc<Point>, b: &Rc<Point>) -> f64 {
        let (from, to) = (a.state.t, b.state.t);
        let mut sum = LOBATTO_ENDS * (a.sample.value + b.sample.value);
        for [place, weight] in LOBATTO {
            let t = from + 0.5 * (1.0 + place) * (to - from);
            sum += weight * self.point(&[a, b], t).map_or(f64::NAN, |point| point.sample.value);
        }
        0.5 * (to - from) * sum
    }
}
