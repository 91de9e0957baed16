//! Zeros of event functions: proven by intervals, in time or on the curve of a step, and located.

use crate::analysis::follow::step::Step;
use crate::analysis::state::{Kinematics, shortly_after};
use crate::limits::domain_boundaries::{MOST_HALVINGS, ROUNDING};
use mechc_expr::math::{Halving, about, along, bisect, farthest};
use mechc_ir::program::{BoundaryRegisters, Enclosure};

/// Distance behind a boundary at which its event function is examined, as a part of the span.
const BEHIND: f64 = 1e-9;
/// Maximum number of doublings of a part whose end cannot be distinguished from a zero.
const MOST_WIDER: u32 = 12;

/// Path along which event functions are evaluated.
#[derive(Clone, Copy)]
pub(super) enum SearchPath {
    /// In time (s).
    Time,
    /// On the curve of a step of a length (s), by the part of the step.
    Curve(f64),
}

/// A domain boundary that a step comes to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Zero {
    pub boundary: usize,
    /// A time (s), or a part of a step.
    pub t: f64,
}

/// The event functions of all domain boundaries, with room to look at them.
pub(super) struct EventFunctions {
    all: Vec<BoundaryRegisters>,
    of_time: Vec<usize>,
    of_motion: Vec<usize>,
    in_time: Enclosure,
    along: Enclosure,
    /// By domain boundary: up to this time (s) it has been judged.
    passed: Vec<f64>,
    /// Each coordinate's, and each velocity's, middle and reach in a part of a step.
    boxes: [Vec<[f64; 2]>; 2],
    velocity: Vec<f64>,
    span: f64,
}

impl EventFunctions {
    /// Returns the event functions of a motion that begins at a time and is measured against a span (s).
    pub fn new(kinematics: &Kinematics, t: f64, span: f64) -> EventFunctions {
        let all = kinematics.boundaries().to_vec();
        let of = |on_time: bool| (0..all.len()).filter(|&k| all[k].on_time == on_time).collect();
        let [in_time, along] = kinematics.enclosures_of_boundaries();
        let n = kinematics.system().coordinates().len();
        EventFunctions {
            of_time: of(true),
            of_motion: of(false),
            in_time,
            along,
            passed: vec![t; all.len()],
            boxes: [vec![[0.0; 2]; n], vec![[0.0; 2]; n]],
            velocity: vec![0.0; n],
            span,
            all,
        }
    }

    /// Returns whether there are no domain boundaries.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    pub fn boundary(&self, boundary: usize) -> &BoundaryRegisters {
        &self.all[boundary]
    }

    /// Returns the time at which a domain boundary was judged last (s).
    pub fn passed(&self, boundary: usize) -> f64 {
        self.passed[boundary]
    }

    /// Records that a domain boundary has been judged at a time (s).
    pub fn pass(&mut self, boundary: usize, t: f64) {
        self.passed[boundary] = t;
    }

    /// Returns whether there are domain boundaries on a way.
    pub fn has_any(&self, way: SearchPath) -> bool {
        !self.on(way).is_empty()
    }

    fn on(&self, way: SearchPath) -> &[usize] {
        match way {
            SearchPath::Time => &self.of_time,
            SearchPath::Curve(_) => &self.of_motion,
        }
    }

    /// Returns the first zero of an event function, in time or on a curve.
    pub fn first_zero(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        way: SearchPath,
        mut parts: Halving<64>,
    ) -> Option<Zero> {
        while let Some(part) = parts.next_part() {
            self.enclose(kinematics, step, way, part);
            let Some(first) = self.may_be_zero(kinematics, step, way, part, 0) else {
                continue;
            };
            if parts.halve(part) {
                continue;
            }
            let mut next = Some(first);
            let mut earliest: Option<Zero> = None;
            while let Some(k) = next {
                let boundary = self.on(way)[k];
                let zero = self.zero_within(kinematics, step, way, boundary, part);
                if let Some(t) = zero.filter(|t| earliest.is_none_or(|met| *t < met.t)) {
                    earliest = Some(Zero { boundary, t });
                }
                next = self.may_be_zero(kinematics, step, way, part, k + 1);
            }
            if earliest.is_some() {
                return earliest;
            }
        }
        None
    }

    /// Returns the index, from `first` on, among the domain boundaries of a path, of one whose event function is not proven to keep its
    /// sign in a part that has been enclosed.
    fn may_be_zero(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        way: SearchPath,
        part: [f64; 2],
        first: usize,
    ) -> Option<usize> {
        (first..self.on(way).len()).find(|&k| {
            let boundary = self.on(way)[k];
            let layout = &self.all[boundary];
            let enclosure = if let SearchPath::Time = way { &self.in_time } else { &self.along };
            let ([low, high], [least, most]) = (enclosure.range(layout.gauge), enclosure.range(layout.slope));
            if low > 0.0 || high < 0.0 {
                return false;
            }
            let Some([a, b]) = self.not_passed(step, way, boundary, part) else {
                return false;
            };
            if least > 0.0 || most < 0.0 {
                let [at_a, at_b] = [a, b].map(|x| self.at(kinematics, step, way, boundary, x)[0]);
                return !(at_a > 0.0 && at_b > 0.0 || at_a < 0.0 && at_b < 0.0);
            }
            true
        })
    }

    /// Returns the rest of a part behind the last zero of a domain boundary, if any.
    fn not_passed(&self, step: &Step, way: SearchPath, boundary: usize, [a, b]: [f64; 2]) -> Option<[f64; 2]> {
        let passed = shortly_after(self.passed[boundary]) + BEHIND * self.span;
        let passed = match way {
            SearchPath::Time => passed,
            SearchPath::Curve(h) => (passed - step.t()) / h,
        };
        (passed < b).then(|| [a.max(passed), b])
    }

    fn enclose(&mut self, kinematics: &Kinematics, step: &Step, way: SearchPath, [a, b]: [f64; 2]) {
        match way {
            SearchPath::Time => kinematics.enclose(&mut self.in_time, [a, b]),
            SearchPath::Curve(h) => {
                let (middle, reach) = (0.5 * (a + b), 0.5 * (b - a));
                let [places, velocities] = &mut self.boxes;
                for ((place, velocity), curve) in places.iter_mut().zip(velocities.iter_mut()).zip(step.curve()) {
                    let taylor = about(curve, middle);
                    *place = [taylor[0], farthest(&taylor[1..], reach)];
                    let slopes: [f64; 5] = std::array::from_fn(|j| (j + 1) as f64 * taylor[j + 1] / h);
                    *velocity = [slopes[0], farthest(&slopes[1..], reach)];
                }
                let times = [step.t() + a * h, step.t() + b * h];
                kinematics.enclose_motion(&mut self.along, times, [places, velocities]);
            }
        }
    }

    /// Returns an event function and its slope at a time, or at a place of a curve.
    pub fn at(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        way: SearchPath,
        boundary: usize,
        x: f64,
    ) -> [f64; 2] {
        match way {
            SearchPath::Time => kinematics.set_time(x),
            SearchPath::Curve(h) => {
                for (velocity, curve) in self.velocity.iter_mut().zip(step.curve()) {
                    let [_, a, b, c, d, e] = *curve;
                    *velocity = along(&[a, 2.0 * b, 3.0 * c, 4.0 * d, 5.0 * e, 0.0], x) / h;
                }
                // a formula without a value has no event function either
                let _ = step.set_on_curve(kinematics, h, x);
                kinematics.set_velocity(&self.velocity);
            }
        }
        kinematics.gauge(&self.all[boundary])
    }

    /// Returns the zero of an event function in a small part, also if the function only touches zero or comes near to it.
    fn zero_within(
        &mut self,
        kinematics: &mut Kinematics,
        step: &mut Step,
        way: SearchPath,
        boundary: usize,
        part: [f64; 2],
    ) -> Option<f64> {
        let [a, b] = self.not_passed(step, way, boundary, part)?;
        let [at_a, slope_a] = self.at(kinematics, step, way, boundary, a);
        let (mut end, [mut at_b, mut slope_b]) = (b, self.at(kinematics, step, way, boundary, b));
        // the sign of a rounding error means nothing
        for wider in 0..MOST_WIDER {
            if !self.is_rounding(kinematics, boundary, at_b) {
                break;
            }
            end = b + f64::from(1 << wider) * (b - a);
            [at_b, slope_b] = self.at(kinematics, step, way, boundary, end);
        }
        let sign = if at_a < 0.0 { -1.0 } else { 1.0 };
        let crosses = sign * at_b < 0.0;
        let comes_and_goes = sign * slope_a < 0.0 && sign * slope_b > 0.0;
        if !crosses && !comes_and_goes {
            return None;
        }
        let [_, zero] = bisect([a, end], MOST_HALVINGS, |x| {
            let [gauge, slope] = self.at(kinematics, step, way, boundary, x);
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
