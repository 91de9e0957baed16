//! The location of the extremum of a smooth formula for variants that are evaluated in a batch, as far as values, slopes and second derivatives at
//! steps determine it. A variant with a doubtful extremum is evaluated alone, by branch and bound (`extremum.rs`).
//!
//! In a cell between two steps the second derivative stays close to the straight line between its ends, as far as the quintic through both is
//! accurate; this bounds where the slope may pass zero.

use super::extremum_refinement::{CELL, FARTHEST};
use crate::limits::interval_search;
use mechc_expr::math::{along, between, integral_of_quintic, quintic, value_and_derivatives};

/// Factor by which a second derivative may deviate from the straight line between its ends, relative to the quintic in the middle of a
/// cell: as much as results of a single variant allow for half a cell.
const SAFETY: f64 = 6.0;
/// The largest extremum is unambiguous if all others are below it by this part of the range.
const MARGIN: f64 = 1e-5;
/// An end is an extremum if the slope there would change the formula over the analysis by this part of its range.
const STEEP: f64 = 1e-3;
/// Largest terms of a sum, in multiples of its range or of what the second derivative causes over the span: beyond it rounding shifts
/// the time of an extremum.
const CERTAIN: f64 = 250.0;
/// A formula is at rest if it deviates from its start by at most this part of the size of its terms: a quarter of the bound for a
/// single variant (`limits::interval_search::ROUNDING`).
const RESTS: f64 = 0.25 * interval_search::ROUNDING;
/// Number of corrections of a time on the curve between two steps.
const ITERATIONS: usize = 3;

/// Value, slope and second derivative at a time.
pub type Tower = [f64; 3];

/// The course of a formula of one variant.
pub struct Course<'c> {
    /// The times of steps (s), two at least.
    pub times: &'c [f64],
    /// The value, slope and second derivative at each of them.
    pub towers: &'c [Tower],
    /// True if the formula is a length, with a kink at zero.
    pub is_length: bool,
    /// The magnitude of the terms that values are sums of, which determines rounding.
    pub weight: f64,
    /// The nearness to a singular position: rounding is inversely proportional to it.
    pub nearness: f64,
}

/// The location of an extremum.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Place {
    /// The extremum is at the first or the last time (s).
    End(f64),
    /// The extremum is near a time (s) between these.
    Turn(f64),
    /// The formula is constant.
    Rest,
}

/// The contents of a cell.
enum Cell {
    /// No value exceeds both ends.
    Nothing,
    /// A single maximum near a time (s): its value, the error bound of that, and the second derivative.
    Turn { t: f64, value: f64, error: f64, second: f64 },
    /// Any values up to this bound.
    Bounded(f64),
}

/// The largest candidate so far.
struct Best {
    /// The location, or `None` if it is in doubt.
    place: Option<Place>,
    value: f64,
    /// The error bound of the value.
    error: f64,
    /// An upper bound of all other candidates.
    others: f64,
}

impl Best {
    fn add(&mut self, value: f64, error: f64, place: Option<Place>) {
        if value > self.value {
            self.others = self.others.max(self.value + self.error);
            (self.value, self.error, self.place) = (value, error, place);
        } else {
            self.others = self.others.max(value + error);
        }
    }
}

impl Course<'_> {
    /// Returns the location of the largest or least value, or `None` if it is in doubt.
    #[must_use]
    pub fn extreme(&self, largest: bool) -> Option<Place> {
        if self.is_constant() {
            return Some(Place::Rest);
        }
        let sign = if largest { 1.0 } else { -1.0 };
        let values = || self.towers.iter().map(|[value, ..]| sign * value);
        let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        let (range, last) = (high - low, self.times.len() - 1);
        let (span, weight) = (self.times[last] - self.times[0], self.weight / self.nearness);
        let mut best = Best { place: None, value: f64::NEG_INFINITY, error: 0.0, others: f64::NEG_INFINITY };
        for (end, inward) in [(0, -1.0), (last, 1.0)] {
            let [value, slope, _] = self.towers[end].map(|value| sign * value);
            let is_steep = inward * slope * span >= STEEP * range && weight <= CERTAIN * range;
            best.add(value, 0.0, is_steep.then_some(Place::End(self.times[end])));
        }
        for (ends, times) in self.cells() {
            let ends = ends.map(|tower| tower.map(|value| sign * value));
            let kink = if self.is_length { kink(ends, times) } else { None };
            match kink.unwrap_or_else(|| Cell::new(ends, times)) {
                Cell::Nothing => {}
                Cell::Bounded(most) => best.add(most, 0.0, None),
                Cell::Turn { t, value, error, second } => {
                    let is_within = f64::min(t - self.times[0], self.times[last] - t) >= FARTHEST * CELL * span;
                    let is_certain = weight <= CERTAIN * f64::min(range, -second * span * span);
                    best.add(value, error, (is_within && is_certain).then_some(Place::Turn(t)));
                }
            }
        }
        let is_unique = best.value - best.error - best.others >= MARGIN * range;
        let is_finite = self.towers.as_flattened().iter().all(|value| value.is_finite());
        best.place.filter(|_| range > 0.0 && is_unique && is_finite)
    }

    /// Returns the cells between steps: the towers at both ends, and their times (s).
    fn cells(&self) -> impl Iterator<Item = ([Tower; 2], [f64; 2])> {
        let times = self.times.windows(2).map(|pair| [pair[0], pair[1]]);
        self.towers.windows(2).map(|pair| [pair[0], pair[1]]).zip(times)
    }

    /// Returns whether the formula is constant up to rounding.
    fn is_constant(&self) -> bool {
        let (first, rounding) = (self.towers[0][0], RESTS * self.weight);
        let is_equal = |value: f64| (value - first).abs() <= rounding;
        self.cells().all(|(ends, times)| Limits::new(ends, times).values.into_iter().all(is_equal))
    }
}

/// Returns an upper bound in a cell in which a length comes too close to its kink at zero, or else `None`. The square of a length has no kink: its
/// second derivative shows the speed near zero.
fn kink([a, b]: [Tower; 2], [from, to]: [f64; 2]) -> Option<Cell> {
    let h = to - from;
    let fastest = (b[0] * b[1] - a[0] * a[1]) / h;
    let path = 2.0 * h * fastest.max(a[1] * a[1]).max(b[1] * b[1]).sqrt();
    let least = f64::min(a[0].abs(), b[0].abs());
    let is_far = path == 0.0 || path <= least;
    let most = a[0].max(b[0]) + path;
    (!is_far).then(|| Cell::Bounded(if most.is_finite() { most } else { f64::INFINITY }))
}

/// Bounds of a formula between two steps.
struct Limits {
    curvatures: [f64; 2],
    slopes: [f64; 2],
    values: [f64; 2],
}

impl Limits {
    fn new([[v, s, c], [w, r, d]]: [Tower; 2], [from, to]: [f64; 2]) -> Limits {
        let h = to - from;
        let deviation = SAFETY * ((r - s) / h - 0.5 * (c + d)).abs();
        let curvatures = [c.min(d) - deviation, c.max(d) + deviation];
        let slopes = between(s, r, curvatures, h);
        Limits { curvatures, slopes, values: between(v, w, slopes, h) }
    }
}

impl Cell {
    /// Classifies the cell between two steps by the values that exceed both ends.
    fn new([a, b]: [Tower; 2], [from, to]: [f64; 2]) -> Cell {
        let h = to - from;
        let ([v, s, c], [w, r, d]) = (a, b);
        let Limits { curvatures, slopes, values: [_, most] } = Limits::new([a, b], [from, to]);
        let is_monotone = slopes[0] > 0.0 || slopes[1] < 0.0;
        if is_monotone || curvatures[0] > 0.0 {
            return Cell::Nothing;
        }
        if curvatures[1] >= 0.0 || !most.is_finite() {
            return Cell::Bounded(most);
        }
        if !(s > 0.0 && r <= 0.0) {
            return Cell::Nothing;
        }
        // the difference of the slopes' integral from the change of the value: the quintic is much more accurate
        let error = (w - v - 0.5 * h * (s + r) - h * h / 12.0 * (c - d)).abs();
        let curve = quintic(a, b, h);
        let mut x = s / (s - r);
        for _ in 0..ITERATIONS {
            let [_, slope, second] = value_and_derivatives(&curve, x);
            x = (x - slope / second).clamp(0.0, 1.0);
        }
        let [_, _, second] = value_and_derivatives(&curve, x);
        Cell::Turn { t: from + x * h, value: along(&curve, x), error, second: second / (h * h) }
    }
}

/// Computes the second derivatives of a formula at steps from its values and slopes there: at each from the cubics of the adjacent cells, corrected
/// by their error term with the fourth derivative.
pub fn find_bends(times: &[f64], towers: &mut [Tower]) {
    let last = times.len() - 1;
    let h = |k: usize| times[k + 1] - times[k];
    for k in 0..=last {
        let third = |cell: usize, towers: &[Tower]| {
            let ([v, s, _], [w, r, _]) = (towers[cell], towers[cell + 1]);
            (12.0 * (v - w) / h(cell) + 6.0 * (s + r)) / (h(cell) * h(cell))
        };
        let behind = |towers: &[Tower]| {
            let ([v, s, _], [w, r, _]) = (towers[k], towers[k + 1]);
            6.0 * (w - v) / (h(k) * h(k)) - (4.0 * s + 2.0 * r) / h(k)
        };
        let before = |towers: &[Tower]| {
            let ([v, s, _], [w, r, _]) = (towers[k - 1], towers[k]);
            (2.0 * s + 4.0 * r) / h(k - 1) - 6.0 * (w - v) / (h(k - 1) * h(k - 1))
        };
        let fourth = |cell: usize, towers: &[Tower]| {
            2.0 * (third(cell + 1, towers) - third(cell, towers)) / (h(cell) + h(cell + 1))
        };
        towers[k][2] = match k {
            _ if last < 2 => f64::NAN,
            0 => behind(towers) + h(0) * h(0) / 12.0 * fourth(0, towers),
            _ if k == last => before(towers) + h(k - 1) * h(k - 1) / 12.0 * fourth(k - 2, towers),
            _ => {
                let correction = (h(k - 1) * h(k - 1) + h(k) * h(k)) / 24.0 * fourth(k - 1, towers);
                0.5 * (before(towers) + behind(towers)) + correction
            }
        };
    }
}

/// Returns the integral of a formula over its course, from its values and derivatives at steps.
#[must_use]
pub fn integral_by_steps(times: &[f64], towers: &[Tower]) -> f64 {
    let cell = |(times, towers): (&[f64], &[Tower])| integral_of_quintic(towers[0], towers[1], times[1] - times[0]);
    times.windows(2).zip(towers.windows(2)).map(cell).sum()
}
