//! A determinant that touches zero within a step, without changing its sign: a singular position of even order.
//!
//! Such zeros arise where two zeros of one block coincide, or a driver turns back at its dead point. Before them the determinant falls at a
//! decreasing rate, so the line through its last two values predicts a zero too early; only steps with such a prediction are searched.

use super::{Step, reject_near_singular};
use crate::analysis::state::{Fault, Kinematics};
use mechc_expr::math::GoldenSection;

/// A determinant that falls within a step to this part of the lesser value at the ends may touch zero there. Shorter steps distinguish:
/// near a zero they find it, and over a mere minimum their ends approach it.
const DEEP: f64 = 0.01;
/// Largest part of the greater value at the ends to which a determinant falls if it may touch zero: a parabola falls to a fifth if
/// golden section takes its zero for the minimum.
const SHALLOW: f64 = 0.5;
/// Maximum number of sections of a step.
const SECTIONS: usize = 60;

impl Step {
    /// Rejects a step of length `h` (s) within which a determinant comes so near to zero that it may touch it; `motion` is the largest motion
    /// of the step, scaled. Requires the curve between the ends.
    pub fn look_for_touch(&mut self, kinematics: &mut Kinematics, h: f64, motion: f64) -> Result<(), Fault> {
        if !self.branch.may_touch(kinematics, h, motion) {
            return Ok(());
        }
        self.factor_within(kinematics, h, 0.5)?;
        for block in 0..kinematics.linear().blocks() {
            let (a, b) = self.branch.at_ends(block);
            // a parabola that touches zero has half of its value at one of the ends or less in the middle
            if self.branch.within(kinematics, block) <= SHALLOW * f64::max(a, b) {
                self.search(kinematics, block, h)?;
                self.factor_within(kinematics, h, 0.5)?;
            }
        }
        kinematics.restore(&self.trial);
        Ok(())
    }

    /// Searches the curve for the least determinant of a block by golden section; fails if it comes close enough to zero.
    fn search(&mut self, kinematics: &mut Kinematics, block: usize, h: f64) -> Result<(), Fault> {
        let (at_low, at_high) = self.branch.at_ends(block);
        let deep = DEEP * f64::min(at_low, at_high);
        let mut sample = |x: f64| {
            self.factor_within(kinematics, h, x)?;
            Ok(self.branch.within(kinematics, block))
        };
        let mut section = GoldenSection::new([0.0, at_low], [1.0, at_high], &mut sample)?;
        for _ in 0..SECTIONS {
            if section.least() <= deep {
                return Err(Fault::Singular);
            }
            if section.least() > SHALLOW * f64::max(section.low[1], section.high[1]) {
                return Ok(());
            }
            section.narrow(&mut sample)?;
        }
        Ok(())
    }

    /// Factors at a point of the curve, at the fraction `x` of the step.
    fn factor_within(&mut self, kinematics: &mut Kinematics, h: f64, x: f64) -> Result<(), Fault> {
        self.set_on_curve(kinematics, h, x)?;
        kinematics.factor()?;
        reject_near_singular(kinematics)
    }
}
