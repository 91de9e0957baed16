//! Step length control.

use super::Accepted;
use crate::analysis::state::Kinematics;
use crate::limits::step_control::{
    CALM_BETWEEN, CALM_CORRECTION, CRUMB, FEWEST_STEPS, FEWEST_STEPS_NEAR, LARGEST_BETWEEN, LARGEST_CORRECTION,
    SMALLEST_STEP,
};
use mechc_ir::limits::DEFAULT_SPAN;

/// The length of the next step, as far as the error is known.
pub struct Length {
    h: f64,
    smallest: f64,
    /// The time that the steps are measured against (s).
    span: f64,
}

impl Length {
    /// Returns the length control of a motion over a span (s).
    pub fn new(span: f64) -> Length {
        let measure = if span > 0.0 { span } else { DEFAULT_SPAN };
        Length { h: span / FEWEST_STEPS_NEAR, smallest: SMALLEST_STEP * span, span: measure }
    }

    pub fn h(&self) -> f64 {
        self.h
    }

    pub fn set(&mut self, h: f64) {
        self.h = h;
    }

    /// Returns the end (s) of a step from a time towards another one.
    pub fn end_towards(&self, from: f64, t: f64) -> f64 {
        if self.h >= CRUMB * (t - from) { t } else { from + self.h }
    }

    /// Adapts the length after an accepted step of length `h`.
    pub fn adapt(&mut self, kinematics: &Kinematics, h: f64, accepted: &Accepted) {
        // a singular value changes by no more than the motion, or little more
        let longest = self.span / FEWEST_STEPS;
        let is_near = 2.0 * accepted.motion * longest >= kinematics.linear().smallest_pivot() * h;
        let longest = if is_near { self.span / FEWEST_STEPS_NEAR } else { longest };
        let calm = accepted.first_correction < LARGEST_CORRECTION / CALM_CORRECTION
            && accepted.between < LARGEST_BETWEEN / CALM_BETWEEN;
        if calm {
            // a step cut short by an output time does not predict a longer one
            self.h = self.h.max(2.0 * h).min(longest);
        } else {
            self.h = self.h.min(h).min(longest);
        }
    }

    /// Halves the length after a step of length `h` from a time was refused; returns whether it has become too short.
    pub fn halve(&mut self, h: f64, from: f64) -> bool {
        self.h = 0.5 * h;
        let vanishes = from + self.h <= from;
        self.h < self.smallest || vanishes
    }
}
