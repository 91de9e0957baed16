//! Zeros of event functions of time: proven by intervals, and located.

use crate::analysis::state::{Kinematics, shortly_after};
use crate::limits::domain_boundaries::{MOST_HALVINGS, ROUNDING};
use mechc_expr::math::{Halving, bisect};
use mechc_ir::program::{BoundaryRegisters, Enclosure};

/// Distance behind a boundary at which its event function is examined, as a part of the span.
const BEHIND: f64 = 1e-9;
/// Maximum number of doublings of a part whose end cannot be distinguished from a zero.
const MOST_WIDER: u32 = 12;

/// A domain boundary that a step comes to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Zero {
    pub boundary: usize,
    /// Its time (s).
    pub t: f64,
}

/// The event functions of all domain boundaries of time, with room to look at them.
pub(super) struct EventFunctions {
    all: Vec<BoundaryRegisters>,
    of_time: Vec<usize>,
    in_time: Enclosure,
    /// By domain boundary: up to this time (s) it has been judged.
    passed: Vec<f64>,
    span: f64,
}

impl EventFunctions {
    /// Returns the event functions of a motion that begins at a time and is measured against a span (s).
    pub fn new(kinematics: &Kinematics, t: f64, span: f64) -> EventFunctions {
        let all = kinematics.boundaries().to_vec();
        EventFunctions {
            of_time: (0..all.len()).filter(|&k| all[k].is_of_time()).collect(),
            in_time: kinematics.enclosure_of_boundaries(true),
            passed: vec![t; all.len()],
            span,
            all,
        }
    }

    /// Returns whether there are no domain boundaries of time.
    pub fn is_empty(&self) -> bool {
        self.of_time.is_empty()
    }

    pub fn boundary(&self, boundary: usize) -> &BoundaryRegisters {
        &self.all[boundary]
    }

    /// Records that a domain boundary has been judged at a time (s).
    pub fn pass(&mut self, boundary: usize, t: f64) {
        self.passed[boundary] = t;
    }

    /// Returns the first zero of an event function.
    pub fn first_zero(&mut self, kinematics: &mut Kinematics, mut parts: Halving<64>) -> Option<Zero> {
        while let Some(part) = parts.next_part() {
            kinematics.enclose(&mut self.in_time, part);
            let Some(first) = self.may_be_zero(kinematics, part, 0) else {
                continue;
            };
            if parts.halve(part) {
                continue;
            }
            let mut next = Some(first);
            let mut earliest: Option<Zero> = None;
            while let Some(k) = next {
                let boundary = self.of_time[k];
                let zero = self.zero_within(kinematics, boundary, part);
                if let Some(t) = zero.filter(|t| earliest.is_none_or(|met| *t < met.t)) {
                    earliest = Some(Zero { boundary, t });
                }
                next = self.may_be_zero(kinematics, part, k + 1);
            }
            if earliest.is_some() {
                return earliest;
            }
        }
        None
    }

    /// Returns the index, from `first` on, among the domain boundaries of time, of one whose event function is not proven to keep its sign in
    /// a part that has been enclosed.
    fn may_be_zero(&self, kinematics: &mut Kinematics, part: [f64; 2], first: usize) -> Option<usize> {
        (first..self.of_time.len()).find(|&k| {
            let boundary = self.of_time[k];
            let BoundaryRegisters { gauge, slope, .. } = &self.all[boundary];
            let [low, high] = self.in_time.range(*gauge);
            if low > 0.0 || high < 0.0 {
                return false;
            }
            let Some([a, b]) = self.not_passed(boundary, part) else {
                return false;
            };
            let [least, most] = slope.map_or([f64::NAN; 2], |slope| self.in_time.range(slope));
            if least > 0.0 || most < 0.0 {
                let [at_a, at_b] = [a, b].map(|t| self.at(kinematics, boundary, t)[0]);
                return !(at_a > 0.0 && at_b > 0.0 || at_a < 0.0 && at_b < 0.0);
            }
            true
        })
    }

    /// Returns the rest of a part behind the last zero of a domain boundary, if any.
    fn not_passed(&self, boundary: usize, [a, b]: [f64; 2]) -> Option<[f64; 2]> {
        let passed = shortly_after(self.passed[boundary]) + BEHIND * self.span;
        (passed < b).then(|| [a.max(passed), b])
    }

    /// Returns an event function and its slope at a time.
    fn at(&self, kinematics: &mut Kinematics, boundary: usize, t: f64) -> [f64; 2] {
        kinematics.set_time(t);
        kinematics.gauge_and_slope(&self.all[boundary])
    }

    /// Returns the zero of an event function in a small part, also if the function only touches zero or comes near to it.
    fn zero_within(&self, kinematics: &mut Kinematics, boundary: usize, part: [f64; 2]) -> Option<f64> {
        let [a, b] = self.not_passed(boundary, part)?;
        let [at_a, slope_a] = self.at(kinematics, boundary, a);
        let (mut end, [mut at_b, mut slope_b]) = (b, self.at(kinematics, boundary, b));
        // the sign of a rounding error means nothing
        for wider in 0..MOST_WIDER {
            if !self.is_rounding(kinematics, boundary, at_b) {
                break;
            }
            end = b + f64::from(1 << wider) * (b - a);
            [at_b, slope_b] = self.at(kinematics, boundary, end);
        }
        let sign = if at_a < 0.0 { -1.0 } else { 1.0 };
        let crosses = sign * at_b < 0.0;
        let comes_and_goes = sign * slope_a < 0.0 && sign * slope_b > 0.0;
        if !crosses && !comes_and_goes {
            return None;
        }
        let [_, zero] = bisect([a, end], MOST_HALVINGS, |t| {
            let [gauge, slope] = self.at(kinematics, boundary, t);
            if crosses { sign * gauge > 0.0 } else { sign * slope < 0.0 }
        });
        Some(zero)
    }

    /// Returns whether the value of an event function that was just evaluated is rounding.
    fn is_rounding(&self, kinematics: &Kinematics, boundary: usize, gauge: f64) -> bool {
        let terms = kinematics.largest_term(&self.all[boundary]);
        gauge.abs() <= ROUNDING * f64::EPSILON * terms && (terms > gauge.abs() || gauge == 0.0)
    }
}
