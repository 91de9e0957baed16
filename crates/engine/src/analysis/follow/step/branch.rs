//! The branch of a motion: the signs of determinants and of monitors.

use crate::analysis::state::{Determinant, Fault, Kinematics};

/// Signs that tell a branch from others.
#[derive(Clone)]
pub struct Signs {
    /// Each block's determinant.
    determinants: Vec<Determinant>,
    /// Sign of each monitor.
    sides: Vec<bool>,
    /// The equations that are left out: determinants are of the others.
    left_out: Vec<usize>,
}

impl Signs {
    fn new(kinematics: &Kinematics) -> Signs {
        let determinants = vec![Determinant::ONE; kinematics.linear().blocks()];
        let left_out = kinematics.determined().left_out().to_vec();
        Signs { determinants, sides: vec![true; kinematics.system().monitors().len()], left_out }
    }

    pub fn copy_from(&mut self, other: &Signs) {
        self.determinants.clone_from(&other.determinants);
        self.sides.clone_from(&other.sides);
        self.left_out.clone_from(&other.left_out);
    }

    /// Returns the determinant of each block.
    pub fn determinants(&self) -> &[Determinant] {
        &self.determinants
    }

    /// Returns the first block whose determinant has another sign where a position was factored.
    pub fn block_that_turned(&self, kinematics: &Kinematics) -> Option<usize> {
        (0..self.determinants.len()).find(|&block| self.has_turned(kinematics, block))
    }

    /// Returns whether a block's determinant has another sign where a position was factored.
    pub fn has_turned(&self, kinematics: &Kinematics, block: usize) -> bool {
        kinematics.linear().determinant(block).is_positive() != self.determinants[block].is_positive()
    }
}

/// Branch of the state and of the trial state, and the approach to the state.
pub(super) struct Branch {
    now: Signs,
    trial: Signs,
    /// Each block's determinant one state before.
    before: Vec<Determinant>,
    approach: Approach,
}

/// The last step before a state.
#[derive(Clone, Copy, Debug)]
struct Approach {
    /// The length of the last step (s); 0 where there was none on this branch of the formulas.
    h: f64,
    /// The smallest pivot of all blocks at the state.
    smallest_pivot: f64,
}

impl Approach {
    /// The approach of a start, which has no step before it.
    const UNKNOWN: Approach = Approach { h: 0.0, smallest_pivot: 0.0 };
}

impl Branch {
    pub fn new(kinematics: &Kinematics) -> Branch {
        let signs = Signs::new(kinematics);
        let before = signs.determinants.clone();
        Branch { now: signs.clone(), trial: signs, before, approach: Approach::UNKNOWN }
    }

    pub fn signs(&self) -> &Signs {
        &self.now
    }

    /// Takes signs that are of the same equations.
    pub fn take_signs(&mut self, signs: &Signs) {
        if self.now.left_out == signs.left_out {
            self.now.copy_from(signs);
        }
    }

    /// Takes the determinants where the state was factored; there are none before to compare with.
    pub fn begin(&mut self, kinematics: &Kinematics) {
        kinematics.linear().determinants(&mut self.now.determinants);
        self.approach = Approach::UNKNOWN;
    }

    /// Takes the determinants of the state that was just accepted, after a step of length `h`.
    pub fn keep(&mut self, kinematics: &Kinematics, h: f64) {
        std::mem::swap(&mut self.before, &mut self.now.determinants);
        std::mem::swap(&mut self.now.determinants, &mut self.trial.determinants);
        self.approach = Approach { h, smallest_pivot: kinematics.linear().smallest_pivot() };
    }

    pub fn record_monitor_signs(&mut self, kinematics: &Kinematics) {
        kinematics.sides(&mut self.now.sides);
    }

    /// Checks that a position that was factored is on the branch.
    pub fn compare(&mut self, kinematics: &Kinematics) -> Result<(), Fault> {
        kinematics.linear().determinants(&mut self.trial.determinants);
        self.compare_sides(kinematics)?;
        let mut pairs = self.trial.determinants.iter().zip(&self.now.determinants);
        if pairs.all(|(trial, now)| trial.is_positive() == now.is_positive()) { Ok(()) } else { Err(Fault::Singular) }
    }

    /// Checks that the monitors have kept their signs where a position was set.
    pub fn compare_sides(&mut self, kinematics: &Kinematics) -> Result<(), Fault> {
        kinematics.sides(&mut self.trial.sides);
        match self.now.sides.iter().zip(&self.trial.sides).position(|(now, trial)| now != trial) {
            Some(index) => Err(Fault::Monitor { index }),
            None => Ok(()),
        }
    }

    /// Returns whether a determinant may touch zero within a step of length `h`, by what is known without looking; `motion` is the step's
    /// largest one, scaled.
    pub fn may_touch(&self, kinematics: &Kinematics, h: f64, motion: f64) -> bool {
        if self.approach.h <= 0.0 {
            return true;
        }
        // a singular value changes by no more than the motion, or little more
        if self.approach.smallest_pivot < motion && kinematics.linear().smallest_pivot() < motion {
            return true;
        }
        let meets_zero = |(now, then): (&Determinant, &Determinant)| {
            let (then, now) = (then.relative_to(*now).abs(), now.relative_to(*now).abs());
            (then - now) * h > now * self.approach.h
        };
        self.now.determinants.iter().zip(&self.before).any(meets_zero)
    }

    /// Returns the determinants of a block at the ends of the step, both positive where it is singular at neither.
    pub fn at_ends(&self, block: usize) -> (f64, f64) {
        let (a, b) = (self.now.determinants[block], self.trial.determinants[block]);
        (a.relative_to(a).abs(), b.relative_to(a).abs())
    }

    /// Returns the determinant of a block where a position within the step was factored, negative beyond a singular position.
    pub fn within(&self, kinematics: &Kinematics, block: usize) -> f64 {
        let (end, within) = (self.now.determinants[block], kinematics.linear().determinant(block));
        let value = within.relative_to(end);
        if end.is_positive() { value } else { -value }
    }
}
