//! Integrals over time by adaptive quadrature: from the values and derivatives at both ends of a cell (Euler and Maclaurin) or, of a formula
//! without derivatives, from values within (Lobatto and Kronrod).

use super::curve::{Cell, Estimate, Point, Verdict};
use super::interval_search::{IntervalSearch, NoValueCause, Ranked, Scale};
use crate::limits::curve::NOTHING;
use crate::limits::interval_search::LEAST_GROWTH;
use crate::limits::quadrature::{ACCURACY, ROUNDING};
use mechc_expr::math::{integral_of_quintic, log10, pow};
use std::collections::BinaryHeap;

/// Safety factor of the error of a cell, relative to the improvement by halving it.
const SAFETY: f64 = 8.0;
/// The error of the finer of two rules is smaller than that of the coarser by the square root of this many times their difference,
/// relative to the variation in the cell.
const SURER: f64 = 1e4;
/// The total error is computed each time this many cells have been divided.
const LOOKS: usize = 16;
/// An integral diverges if the shortest cells hold this part of it, and the formula grows fast enough towards them.
const DIVERGES: f64 = 1e-9;
/// Distances from a shortest cell at which the growth of a formula is examined, in lengths of the cell.
const FARTHER: [f64; 2] = [64.0, 256.0];
/// An integral diverges if the formula grows like a power of the distance from a pole with at least this exponent.
const STEEPEST: f64 = 0.95;
/// Largest distance from a pole, as a part of the span, at which a formula is a single power of the distance: halving the distance
/// changes the growth factor, which is at least `LEAST_GROWTH`, by at most `ALIKE`. At smaller distances the rounding of times shows.
const POLE_DISTANCE: f64 = 1e-8;
/// Two growth factors that differ by at most this belong to one power.
const ALIKE: f64 = 1e-5;
/// Uncertainty of an integral near a pole, as a part of what the shortest cell may hold.
const PART_OF_POLE: f64 = 0.02;

/// Inner nodes of Lobatto's rule of four points, exact for polynomials of degree 5, and of Kronrod's extension to seven, of degree 9, in a cell
/// from −1 to 1, with the weights of both. Source: W. Gander, W. Gautschi, *Adaptive Quadrature – Revisited*, BIT 40, 2000.
const WITHIN: [[f64; 3]; 4] = [
    [-0.816_496_580_927_726, 0.0, 72.0 / 245.0],
    [-0.447_213_595_499_957_9, 5.0 / 6.0, 125.0 / 294.0],
    [0.447_213_595_499_957_9, 5.0 / 6.0, 125.0 / 294.0],
    [0.816_496_580_927_726, 0.0, 72.0 / 245.0],
];
/// Weights of the ends in both rules.
const ENDS: [f64; 2] = [1.0 / 6.0, 11.0 / 210.0];
/// Weight of the middle in Kronrod's rule.
const MIDDLE: f64 = 16.0 / 35.0;

/// An integral over time.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Integral {
    sum: f64,
    /// A bound of the error of `sum`.
    error: f64,
    /// The time (s) during which the formula has a value.
    pub time: f64,
    /// The time (s) without a value that rounding may have hidden.
    hidden: f64,
    /// The duration of the analysis (s).
    span: f64,
    /// A usual value of the formula.
    usual: f64,
    /// The integral of the distance of the formula from its usual value.
    size: f64,
    /// The largest contribution of a shortest cell towards which the formula grows so fast that the integral may diverge, and its time (s).
    steepest: [f64; 2],
}

/// Clamps the result of a rule to the bounds that the values in the cell allow: at a kink the derivatives may be those of the other side.
fn clamped(value: f64, [least, most]: [f64; 2]) -> f64 {
    if value.is_finite() && least <= most { value.max(least).min(most) } else { value }
}

impl Integral {
    /// Returns the integral with its error bound.
    pub fn estimate(&self) -> Estimate {
        let hidden = if self.hidden > 0.0 { self.hidden / self.time } else { 0.0 };
        Estimate {
            value: self.sum,
            error: self.error + (ROUNDING + hidden) * (self.size + (self.usual * self.time).abs()),
        }
    }

    /// Returns the average distance of the formula from a usual value.
    pub fn deviation(&self) -> f64 {
        self.size / self.time
    }

    /// Returns a time (s) towards which the formula grows so fast that the integral diverges.
    pub fn unbounded(&self) -> Option<f64> {
        self.unbounded_with(0.0)
    }

    /// Returns a time (s) towards which the formula grows fast enough for divergence, even if its contribution is small.
    pub fn grows_at(&self) -> Option<f64> {
        Some(self.steepest[1]).filter(|_| self.steepest[0] > 0.0)
    }

    /// Returns [`Integral::unbounded`] for an integral whose size is larger by `size`.
    fn unbounded_with(&self, size: f64) -> Option<f64> {
        let [most, t] = self.steepest;
        (most > DIVERGES * (self.size + size)).then_some(t)
    }

    /// Returns the integral over a duration (s) that was computed elsewhere.
    pub fn from_estimate(estimate: Estimate, time: f64) -> Integral {
        Integral { sum: estimate.value, error: estimate.error, time, ..Integral::default() }
    }

    fn add(&mut self, sum: f64, error: f64, time: f64) {
        self.sum += sum;
        self.size += (sum - self.usual * time).abs();
        self.error += error;
        self.time += time;
    }
}

/// A divided cell with the estimate of the integral over it; its rank is the error bound of that.
struct Part {
    halves: [Cell; 2],
    /// The length (s) of the cell.
    length: f64,
    sum: f64,
}

impl IntervalSearch<'_> {
    /// Adds the integral of the formula over some cells. The part with the largest error is refined first, until the total error is small,
    /// relative to the integral of the distance of the formula from its usual value.
    pub(super) fn integrate(&mut self, cells: &[Cell], usual: f64, scale: Scale, integral: &mut Integral) {
        (integral.usual, integral.span, self.range, self.is_timed) = (usual, scale.span, scale.range, true);
        let mut parts = BinaryHeap::new();
        for cell in cells {
            self.take(cell.clone(), &mut parts, integral);
        }
        for pair in cells.windows(2) {
            // the time of a load's jump between two cells is uncertain
            let [before, behind] = [&pair[0].b, &pair[1].a];
            let jump = (before.sample.value - behind.sample.value).abs();
            if behind.shift.time > 0.0 && jump.is_finite() {
                integral.error += jump * behind.shift.time;
            }
        }
        let is_open = |parts: &BinaryHeap<Ranked<Part>>, integral: &Integral| {
            let (mut error, mut size) = (0.0, 0.0);
            for Ranked { rank, item: part, .. } in parts {
                error += rank;
                size += if rank.is_finite() { (part.sum - usual * part.length).abs() } else { 0.0 };
            }
            let is_inaccurate = error > f64::max(ACCURACY * size, ROUNDING * scale.weight * scale.span).max(NOTHING);
            is_inaccurate && integral.unbounded_with(size).is_none()
        };
        // the total error is computed only after several parts have been refined
        let mut left = 0;
        loop {
            if left == 0 {
                if self.notes.cause.is_some() || self.notes.are_exhausted() || !is_open(&parts, integral) {
                    break;
                }
                left = parts.len().div_ceil(LOOKS);
            }
            left -= 1;
            let Some(part) = parts.pop() else { break };
            for cell in part.item.halves {
                self.take(cell, &mut parts, integral);
            }
        }
        let mut parts = parts.into_vec();
        parts.sort_unstable_by(|a, b| a.t.total_cmp(&b.t));
        for Ranked { rank: error, t, item: part } in parts {
            if self.notes.are_exhausted() && error == f64::INFINITY {
                self.notes.fail(NoValueCause::Unknown(t));
            }
            integral.add(part.sum, error, part.length);
        }
    }

    /// Integrates over a cell, which is divided where guards cross their thresholds. What may need refinement is added to `parts`, the rest to
    /// `integral`.
    fn take(&mut self, cell: Cell, parts: &mut BinaryHeap<Ranked<Part>>, integral: &mut Integral) {
        let mut open = vec![cell];
        while let Some(mut cell) = open.pop() {
            let h = cell.length();
            if self.is_shortest(&cell) {
                self.integrate_shortest(&cell, integral);
                continue;
            }
            if h <= POLE_DISTANCE * integral.span
                && let Some(estimate) = self.integrate_near_pole(&cell)
            {
                integral.add(estimate.value, estimate.error, h);
                continue;
            }
            let (verdict, range) = self.enclose(&mut cell);
            match verdict {
                Verdict::Crosses(guard) => {
                    let Some(cells) = self.cut_at_crossing(&cell, guard) else { return };
                    open.extend(cells.into_iter().flatten().rev());
                    continue;
                }
                Verdict::Rounding | Verdict::Alike => {
                    let [a, b] = [&cell.a, &cell.b].map(|point| point.sample.value);
                    integral.add(0.5 * h * (a + b), h * (a - b).abs(), h);
                    continue;
                }
                Verdict::Missing => {
                    self.miss(cell.step, cell.a.state.t);
                    continue;
                }
                Verdict::Smooth | Verdict::Open(_) => {}
            }
            let is_smooth = verdict == Verdict::Smooth && range.is_resolved;
            let is_smooth = is_smooth && (self.curve.derivatives() == 0 || !self.curve.derivative(1).may_switch);
            let Some(halves) = self.halve(&cell) else { return };
            let points = [&cell.a, &halves[0].b, &cell.b];
            let is_unbounded = h <= self.short && range.high - range.low == f64::INFINITY;
            let exists = points.iter().any(|point| point.exists());
            if is_unbounded && exists && points.into_iter().all(|point| self.is_noise(point)) {
                // so close to a pole that every value is rounding
                self.integrate_shortest(&cell, integral);
                continue;
            }
            let values = points.map(|point| point.sample.value);
            let (mut sum, mut error) = (0.0, f64::INFINITY);
            if values.iter().all(|value| value.is_finite()) {
                let rule = self.rule(&cell, &halves);
                sum = clamped(rule.value, [range.low * h, range.high * h]);
                let largest = values.iter().fold(0.0, |largest, value| f64::max(largest, value.abs()));
                let rounding = ROUNDING * largest * h;
                let by_rule = if is_smooth { rule.error - rounding } else { f64::INFINITY };
                error = by_rule.min((range.high - range.low) * h).max(0.0);
            }
            parts.push(Ranked { rank: error, t: cell.a.state.t, item: Part { halves, length: h, sum } });
        }
    }

    /// Returns whether a point has no value, or one without a certain digit.
    fn is_noise(&mut self, point: &Point) -> bool {
        if !point.exists() {
            return true;
        }
        let estimate = self.curve.estimate(point);
        estimate.certain_digits() == 0 && estimate.error > NOTHING
    }

    /// Adds the integral over a cell that is too short to be divided. The contribution of a pole in it is bounded from the values on both sides.
    fn integrate_shortest(&mut self, cell: &Cell, integral: &mut Integral) {
        let h = cell.length();
        let values = [&cell.a, &cell.b].map(|point| point.sample.value);
        let finite: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        let hidden = cell.a.shift.time.max(cell.b.shift.time);
        if finite.len() < 2 {
            self.miss(cell.step, cell.a.state.t);
            // both ends of a hole count it, half each
            integral.hidden += 0.5 * (cell.a.shift.time + cell.b.shift.time);
        }
        let largest = finite.iter().fold(0.0, |largest, value| f64::max(largest, (value - integral.usual).abs()));
        if let [a, b] = finite[..] {
            // the time of a jump is uncertain
            let offset = hidden.max(cell.a.crossing_error).max(cell.b.crossing_error);
            integral.error += (a - b).abs() * offset.min(self.short);
        }
        let growth = self.growth_into(cell, integral.usual);
        if growth > LEAST_GROWTH && !finite.is_empty() {
            let contribution = largest * h.max(hidden);
            if growth >= pow(2.0, STEEPEST) && contribution > integral.steepest[0] {
                integral.steepest = [contribution, cell.a.state.t];
            }
            // a longer cell comes here because all its values may be rounding
            let part = if self.is_shortest(cell) { PART_OF_POLE } else { 1.0 };
            // values hidden by rounding grow by the same power
            let hidden_part =
                if hidden > h { contribution / (1.0 - log10(growth) / log10(2.0)).max(1.0 - STEEPEST) } else { 0.0 };
            integral.add(0.0, f64::max(part * h * largest, hidden_part), h);
        } else if !finite.is_empty() {
            integral.add(h * finite.iter().sum::<f64>() / finite.len() as f64, 2.0 * h * largest, h);
        }
    }

    /// Returns the factor by which the distance of the formula from a usual value grows when the distance from a shortest cell is halved; 1 if it
    /// does not grow on into the cell, as at a jump.
    fn growth_into(&mut self, cell: &Cell, usual: f64) -> f64 {
        let error = |point: &Point| (point.sample.value - usual).abs();
        let sides = [(&cell.a, -1.0), (&cell.b, 1.0)].map(|(end, direction)| {
            let offset = direction * cell.length().max(end.shift.time);
            let mut error_at = |far: f64| {
                let there = self.point_near(cell.step, end.state.t + far * offset);
                there.map_or(f64::NAN, |there| error(&there))
            };
            let near = error_at(FARTHER[0]);
            if end.exists() && error(end) <= LEAST_GROWTH * near {
                return 1.0;
            }
            let far = error_at(FARTHER[1]);
            // `far` is at four times the distance of `near`: two halvings
            if near > far { (near / far).sqrt() } else { 1.0 }
        });
        f64::max(sides[0], sides[1])
    }

    /// Returns the integral over a short cell with a pole at one end, and its error bound. The formula is a power of the distance from the pole, by
    /// its values at three distances. Returns `None` if it is not.
    fn integrate_near_pole(&mut self, cell: &Cell) -> Option<Estimate> {
        let size = |point: &Point| if point.exists() { point.sample.value.abs() } else { f64::INFINITY };
        let (pole, far) = if size(&cell.a) > size(&cell.b) { (&cell.a, &cell.b) } else { (&cell.b, &cell.a) };
        if size(pole) < LEAST_GROWTH * size(far) {
            return None;
        }
        let (t, distance) = (pole.state.t, far.state.t - pole.state.t);
        let mut at = |part: f64| Some(self.point(cell, t + part * distance)?.sample.value);
        let [quarter, half, whole] = [at(0.25)?, at(0.5)?, far.sample.value];
        let [closer, farther] = [quarter / half, half / whole];
        let differs = (closer - farther).abs();
        // the deviation from a power grows with the distance: extrapolate to the pole
        let power = log10(closer + (closer - farther)) / log10(2.0);
        if !(LEAST_GROWTH..pow(2.0, STEEPEST)).contains(&farther) || differs > ALIKE || power.is_nan() {
            return None;
        }
        let value = distance.abs() * whole / (1.0 - power);
        let error = value.abs() * (differs + f64::EPSILON * t.abs() / distance.abs()) / (1.0 - power);
        Some(Estimate { value, error })
    }

    /// Returns the integral over a cell from its halves, with an error bound.
    fn rule(&mut self, cell: &Cell, halves: &[Cell; 2]) -> Estimate {
        if self.curve.derivatives() == 0 {
            return self.rule_of_values(cell, &halves[0].b);
        }
        let whole = self.rule_of_ends(&cell.a, &cell.b);
        let parts = self.rule_of_ends(&halves[0].a, &halves[0].b) + self.rule_of_ends(&halves[1].a, &halves[1].b);
        // Richardson extrapolation from the whole cell and its halves
        let factor = if self.curve.derivatives() == 1 { 15.0 } else { 63.0 };
        let correction = (parts - whole) / factor;
        if correction.is_finite() {
            return Estimate { value: parts + correction, error: SAFETY * correction.abs() };
        }
        let middle = halves[0].b.sample.value;
        let value = 0.25 * cell.length() * (cell.a.sample.value + 2.0 * middle + cell.b.sample.value);
        Estimate { value, error: f64::INFINITY }
    }

    /// Returns the integral of the polynomial with the values and derivatives of two points.
    pub(super) fn rule_of_ends(&self, a: &Point, b: &Point) -> f64 {
        let (h, [a, b]) = (b.state.t - a.state.t, [a.sample, b.sample]);
        match self.curve.derivatives() {
            1 => 0.5 * h * (a.value + b.value) + h * h / 12.0 * (a.first - b.first),
            _ => integral_of_quintic([a.value, a.first, a.second], [b.value, b.first, b.second], h),
        }
    }

    /// Returns the integral over a cell from values alone, with an error bound, which is infinite if one of the values is missing.
    fn rule_of_values(&mut self, cell: &Cell, middle: &Point) -> Estimate {
        let half = 0.5 * cell.length();
        let ends = cell.a.sample.value + cell.b.sample.value;
        let (mut rough, mut fine) = (ENDS[0] * ends, ENDS[1] * ends + MIDDLE * middle.sample.value);
        for [node, of_rough, of_fine] in WITHIN {
            let t = middle.state.t + node * half;
            let value = self.point(cell, t).map_or(f64::NAN, |point| point.sample.value);
            rough += of_rough * value;
            fine += of_fine * value;
        }
        if fine.is_finite() {
            let size = (ends - 2.0 * fine).abs()
                + (2.0 * middle.sample.value - ends).abs()
                + (middle.sample.value - 0.5 * fine).abs();
            let error = (fine - rough).abs();
            // the order of the finer rule is higher by half
            let part = (SURER * error / size).sqrt();
            return Estimate { value: half * fine, error: half * error * if part < 1.0 { part } else { 1.0 } };
        }
        Estimate { value: 0.5 * half * (ends + 2.0 * middle.sample.value), error: f64::INFINITY }
    }
}
