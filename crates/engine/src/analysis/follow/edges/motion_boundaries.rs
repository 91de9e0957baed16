//! Domain boundaries that the motion decides, as that of `sqrt(x(P))`: no step passes one.
//!
//! The event function of each boundary is enclosed over a step; a step in which one may be zero is refused. If even the shortest step is
//! refused, the motion ends there: whether a formula goes on beyond a radicand or denominator that is zero, and how, is not examined.

use crate::analysis::explain::{Stop, StopCause, errors};
use crate::analysis::follow::step::Step;
use crate::analysis::state::{Fault, Kinematics};
use crate::limits::domain_boundaries::ROUNDING;
use mechc_expr::math::{Halving, about, farthest};
use mechc_ir::program::{BoundaryRegisters, Enclosure};

/// Length of a step that ends the motion if it may pass a boundary, as a part of the span.
const SHORTEST: f64 = 1e-9;
/// A boundary explains why steps fail if it is within this many of the last ones.
const STEPS_AHEAD: f64 = 32.0;
/// Smallest part of a step that is enclosed, as a part of the step.
const FINEST: f64 = 1e-5;
/// Maximum number of parts of a step.
const MOST_PARTS: usize = 500;

struct Boundary {
    index: usize,
    registers: BoundaryRegisters,
    /// True if its event function has differed from zero since the start, where it may be zero.
    has_left_zero: bool,
}

/// Watches that no step passes a domain boundary of the motion.
pub(super) struct MotionBoundaries {
    all: Vec<Boundary>,
    along: Enclosure,
    /// Each coordinate's middle and reach in a part of a step.
    boxes: Vec<[f64; 2]>,
    /// The time that the steps are measured against, and the last time (s).
    span: f64,
    last: f64,
}

impl MotionBoundaries {
    /// Returns the boundaries of a motion up to a time (s), measured against a span (s).
    pub fn new(kinematics: &Kinematics, [span, last]: [f64; 2]) -> MotionBoundaries {
        let boundaries = kinematics.boundaries().iter().cloned().enumerate();
        let of_motion = boundaries.filter(|(_, registers)| !registers.is_of_time());
        MotionBoundaries {
            all: of_motion.map(|(index, registers)| Boundary { index, registers, has_left_zero: false }).collect(),
            along: kinematics.enclosure_of_boundaries(false),
            boxes: vec![[0.0; 2]; kinematics.system().coordinates().len()],
            span,
            last,
        }
    }

    /// Refuses a step of length `h`, whose curve must have been drawn, within which a boundary may lie.
    pub fn look(&mut self, kinematics: &mut Kinematics, step: &mut Step, h: f64) -> Result<(), Fault> {
        match self.first_on_curve(kinematics, step, h) {
            None => Ok(()),
            Some(_) if h > SHORTEST * self.span => Err(Fault::TooFar),
            // at the last time the earlier side counts
            Some(_) if step.t() + h >= self.last => Ok(()),
            Some((index, _)) => Err(Fault::DomainBoundary { index, t: step.t() + h }),
        }
    }

    /// Returns the stop at a boundary just ahead of a motion of which even a step as small as `h` (s) failed.
    pub fn end(&mut self, kinematics: &mut Kinematics, step: &mut Step, h: f64) -> Option<Box<Stop>> {
        let h = STEPS_AHEAD * h;
        step.extrapolate_curve(h, 0..step.state().q.len());
        let (index, part) = self.first_on_curve(kinematics, step, h)?;
        Some(stop_at_boundary(kinematics, index, [step.t(), step.t() + part * h]))
    }

    /// Returns the first boundary that may lie on the curve of a step of length `h`, and the part of the step up to there.
    fn first_on_curve(&mut self, kinematics: &mut Kinematics, step: &mut Step, h: f64) -> Option<(usize, f64)> {
        if self.all.is_empty() {
            return None;
        }
        let mut parts = Halving::<64>::new([0.0, 1.0], FINEST, MOST_PARTS);
        while let Some(part) = parts.next_part() {
            self.enclose(kinematics, step, h, part);
            let boundary = (0..self.all.len()).find(|&k| self.may_be_zero(kinematics, step, h, k));
            if let Some(k) = boundary.filter(|_| !parts.halve(part)) {
                return Some((self.all[k].index, part[1]));
            }
        }
        None
    }

    fn enclose(&mut self, kinematics: &Kinematics, step: &Step, h: f64, [a, b]: [f64; 2]) {
        let (middle, reach) = (0.5 * (a + b), 0.5 * (b - a));
        for (place, curve) in self.boxes.iter_mut().zip(step.curve()) {
            let taylor = about(curve, middle);
            *place = [taylor[0], farthest(&taylor[1..], reach)];
        }
        kinematics.enclose_motion(&mut self.along, [step.t() + a * h, step.t() + b * h], &self.boxes);
    }

    /// Returns whether an event function may be zero in the part that has been enclosed. One that is zero where the motion starts does not
    /// count until it differs from zero.
    fn may_be_zero(&mut self, kinematics: &mut Kinematics, step: &mut Step, h: f64, k: usize) -> bool {
        let Boundary { registers, has_left_zero, .. } = &mut self.all[k];
        let [low, high] = self.along.range(registers.gauge);
        if low > 0.0 || high < 0.0 {
            return false;
        }
        if !*has_left_zero {
            // a formula without a value has no event function either
            let _ = step.set_on_curve(kinematics, h, 0.0);
            let gauge = kinematics.gauge(registers);
            *has_left_zero = gauge.abs() > ROUNDING * f64::EPSILON * kinematics.largest_term(registers);
        }
        *has_left_zero
    }
}

/// Returns the stop at a boundary between a time up to which its formula is finite, and one at which it may not be (s).
pub fn stop_at_boundary(kinematics: &Kinematics, index: usize, [last, t]: [f64; 2]) -> Box<Stop> {
    let system = kinematics.system();
    let declarations = system.domain_boundaries()[index].declarations.clone();
    let is_corner = declarations.iter().any(|&declaration| errors::has_tangent(system, declaration));
    let cause = if is_corner {
        StopCause::PositionJump { declarations, jump: None, is_corner }
    } else {
        StopCause::DomainEnd { declarations, last }
    };
    cause.at(t)
}
