//! Warnings of a motion, and the times at which accelerations jump.

use crate::analysis::explain::{Warning, WarningCause};
use mechc_ir::{ConstraintSystem, DeclarationId, IdVec};

/// Warnings of a motion so far.
pub struct Warnings {
    reported: Reported,
    /// Times at which accelerations have jumped (s), if they are requested.
    jumps: Option<Vec<f64>>,
}

/// Warnings so far, which may have to be taken back.
#[derive(Clone)]
pub struct Reported {
    warnings: Vec<Warning>,
    /// Declarations that have been reported to make an acceleration jump.
    warned: IdVec<DeclarationId, bool>,
}

impl Warnings {
    pub fn new(system: &ConstraintSystem) -> Warnings {
        let warned = system.declarations().map(|_| false);
        Warnings { reported: Reported { warnings: Vec::new(), warned }, jumps: None }
    }

    pub fn push(&mut self, warning: Warning) {
        self.reported.warnings.push(warning);
    }

    /// Takes the warnings since the last call.
    pub fn take(&mut self) -> Vec<Warning> {
        std::mem::take(&mut self.reported.warnings)
    }

    /// Returns the warnings so far.
    pub fn reported(&self) -> Reported {
        self.reported.clone()
    }

    /// Restores the warnings of an earlier [`Warnings::reported`].
    pub fn restore(&mut self, reported: Reported) {
        self.reported = reported;
    }

    /// Records from now on the times at which accelerations jump.
    pub fn keep_jumps(&mut self) {
        self.jumps.get_or_insert_default();
    }

    /// Returns the recorded times (s), ascending, each once.
    pub fn jumps(&self) -> Vec<f64> {
        let mut jumps = self.jumps.clone().unwrap_or_default();
        jumps.sort_by(f64::total_cmp);
        jumps.dedup();
        jumps
    }

    /// Records that an acceleration jumps at an edge (s).
    pub fn take_jump(&mut self, t: f64) {
        if let Some(jumps) = &mut self.jumps {
            jumps.push(t);
        }
    }

    /// Warns of declarations that make an acceleration jump at a time (s), once of each.
    pub fn warn_of_jump(&mut self, behind: &[DeclarationId], columns: impl FnOnce() -> Vec<String>, t: f64) {
        if behind.iter().all(|&declaration| self.reported.warned[declaration]) {
            return;
        }
        for &declaration in behind {
            self.reported.warned[declaration] = true;
        }
        self.push(Warning {
            t,
            cause: WarningCause::AccelerationJump { declarations: behind.to_vec(), columns: columns() },
        });
    }
}
