//! A determinant that touches zero within a step, without changing its sign: a singular position of even order.
//!
//! Two zeros of one block that coincide, or a driver that turns back in its dead point ever so gently. Both ends of the step
//! show nothing. But before such a place a determinant falls, ever more slowly, so that the line through its last two values
//! meets zero before it does. Only a step on which that happens is looked into.

use super::march::Motion;
use crate::analysis::state::{Determinant, Fault};
use crate::math::GOLDEN;
use crate::tolerances::steps::march::NEAREST;
use crate::tolerances::steps::touch::{DEEP, SECTIONS, SHALLOW};

/// What is known of the way up to a state.
#[derive(Clone, Copy, Debug)]
pub struct Before {
    /// The length of the last step (s); 0 where there was none on this branch of the formulas.
    h: f64,
    /// The smallest pivot of all blocks at the state.
    smallest_pivot: f64,
}

impl Before {
    /// Nothing is known, at a start.
    pub const UNKNOWN: Before = Before { h: 0.0, smallest_pivot: 0.0 };
}

impl Motion {
    /// Takes the determinants where the state was factored, there being none before to compare with.
    pub fn begin_determinants(&mut self) {
        self.kinematics.linear().determinants(&mut self.determinants);
        self.way_before = Before::UNKNOWN;
    }

    /// Takes the determinants of the state that was just accepted, after a step of length `h`.
    pub fn keep_determinants(&mut self, h: f64) {
        std::mem::swap(&mut self.determinants_before, &mut self.determinants);
        std::mem::swap(&mut self.determinants, &mut self.trial_determinants);
        self.way_before = Before { h, smallest_pivot: self.kinematics.linear().smallest_pivot() };
    }

    /// Refuses a step of length `h` within which a determinant comes so near to zero that it may touch it. The curve between
    /// the ends must have been drawn; the factors of its end are left as they are.
    pub fn look_for_touch(&mut self, h: f64, motion: f64) -> Result<(), Fault> {
        if !self.may_touch(h, motion) {
            return Ok(());
        }
        self.factor_within(h, 0.5)?;
        for block in 0..self.determinants.len() {
            let (a, b) = self.determinants_at_ends(block);
            // a parabola that touches zero has half of its value at one of the ends or less in the middle
            if self.within(block) <= SHALLOW * f64::max(a, b) {
                self.search(block, h)?;
                self.factor_within(h, 0.5)?;
            }
        }
        self.kinematics.restore(&self.trial);
        Ok(())
    }

    /// Whether a determinant may touch zero within a step of length `h`, by what is known without looking.
    fn may_touch(&self, h: f64, motion: f64) -> bool {
        let before = self.way_before;
        if before.h <= 0.0 {
            return true;
        }
        // a singular value changes by no more than the motion, or little more
        if before.smallest_pivot < motion && self.kinematics.linear().smallest_pivot() < motion {
            return true;
        }
        let meets_zero = |(now, then): (&Determinant, &Determinant)| {
            let (then, now) = (then.beside(*now).abs(), now.beside(*now).abs());
            (then - now) * h > now * before.h
        };
        self.determinants.iter().zip(&self.determinants_before).any(meets_zero)
    }

    /// Golden section for the least determinant of a block, on the curve.
    fn search(&mut self, block: usize, h: f64) -> Result<(), Fault> {
        let (mut low, mut high) = (0.0, 1.0);
        let (mut at_low, mut at_high) = self.determinants_at_ends(block);
        let deep = DEEP * f64::min(at_low, at_high);
        let (mut left, mut right) = (1.0 - GOLDEN, GOLDEN);
        let (mut at_left, mut at_right) = (self.sample(block, h, left)?, self.sample(block, h, right)?);
        for _ in 0..SECTIONS {
            let least = f64::min(at_left, at_right);
            if least <= deep {
                return Err(Fault::Singular);
            }
            if least > SHALLOW * f64::max(at_low, at_high) {
                return Ok(());
            }
            if at_left < at_right {
                (high, at_high, right, at_right) = (right, at_right, left, at_left);
                left = high - GOLDEN * (high - low);
                at_left = self.sample(block, h, left)?;
            } else {
                (low, at_low, left, at_left) = (left, at_left, right, at_right);
                right = low + GOLDEN * (high - low);
                at_right = self.sample(block, h, right)?;
            }
        }
        Ok(())
    }

    /// The determinants of a block at the ends of the step, both positive where it is singular at neither.
    fn determinants_at_ends(&self, block: usize) -> (f64, f64) {
        let (a, b) = (self.determinants[block], self.trial_determinants[block]);
        (a.beside(a).abs(), b.beside(a).abs())
    }

    /// The determinant of a block where a position within the step was factored, negative beyond a singular position.
    fn within(&self, block: usize) -> f64 {
        let (end, within) = (self.determinants[block], self.kinematics.linear().determinant(block));
        let value = within.beside(end);
        if end.is_positive() { value } else { -value }
    }

    fn sample(&mut self, block: usize, h: f64, x: f64) -> Result<f64, Fault> {
        self.factor_within(h, x)?;
        Ok(self.within(block))
    }

    /// Factors at a place of the curve, given as a part of the step.
    fn factor_within(&mut self, h: f64, x: f64) -> Result<(), Fault> {
        self.set_on_curve(h, x)?;
        self.kinematics.factor()?;
        if self.kinematics.nearness(NEAREST) < NEAREST { Err(Fault::Singular) } else { Ok(()) }
    }
}
