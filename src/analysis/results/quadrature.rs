//! Integrals over time, by formulas that take value and derivatives of both ends of a cell (Euler and Maclaurin), or by values
//! alone where there are none (Simpson).

use super::formulas::{Cell, Point};
use super::survey::{Root, Scale, Survey};
use crate::program::Range;

/// An integral may be off by this part of range times time.
const ACCURACY: f64 = 1e-11;
/// A cell in which no value matters more than this part of range times span is as good as it need be.
const NEGLIGIBLE: f64 = 1e-13;
/// As little as that is nothing.
const NOTHING: f64 = 1e-290;
/// What rounding makes of a value.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

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
            let widest = f64::max(first.1.high, second.1.high) - f64::min(first.1.low, second.1.low);
            let halves = [first.0, second.0];
            let (found, error) = self.both_rules(&cell, &halves);
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
        if self.formula.derivatives() == 0
            && let Some(found) = self.by_values(cell, halves)
        {
            return found;
        }
        let whole = self.rule(&cell.a, &cell.b);
        let parts = self.rule(&halves[0].a, &halves[0].b) + self.rule(&halves[1].a, &halves[1].b);
        let gained = [3.0, 15.0, 63.0][self.formula.derivatives()];
        let better = (parts - whole) / gained;
        if better.is_finite() {
            return (parts + better, better.abs());
        }
        let h = cell.length();
        let middle = halves[0].b.sample.value;
        (0.25 * h * (cell.a.sample.value + 2.0 * middle + cell.b.sample.value), f64::INFINITY)
    }

    /// The integral of a formula without derivatives: by Simpson's rule over the halves, made better by what it says over the whole. None
    /// where a value is missing.
    fn by_values(&mut self, cell: &Cell, halves: &[Cell; 2]) -> Option<(f64, f64)> {
        let [first, third] = halves.each_ref().map(|half| self.middle(half));
        let values = [&cell.a, &first?, &halves[0].b, &third?, &cell.b].map(|point| point.sample.value);
        let h = cell.length();
        let whole = h / 6.0 * (values[0] + 4.0 * values[2] + values[4]);
        let parts = h / 12.0 * (values[0] + 4.0 * values[1] + 2.0 * values[2] + 4.0 * values[3] + values[4]);
        let better = (parts - whole) / 15.0;
        better.is_finite().then_some((parts + better, better.abs()))
    }

    /// The integral of the polynomial that has the values and derivatives of two points.
    fn rule(&self, a: &Point, b: &Point) -> f64 {
        let (h, [a, b]) = (b.state.t - a.state.t, [a.sample, b.sample]);
        let values = 0.5 * h * (a.value + b.value);
        match self.formula.derivatives() {
            0 => values,
            1 => values + h * h / 12.0 * (a.first - b.first),
            _ => values + h * h / 10.0 * (a.first - b.first) + h * h * h / 120.0 * (a.second + b.second),
        }
    }
}
