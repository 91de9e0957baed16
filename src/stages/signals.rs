//! A mechanism once more, with its inputs as signals: made from its text when somebody asks for it.

use super::Parsed;
use super::lowered::lowered;
use crate::check::{self, Surroundings};
use crate::diag::Diagnostics;
use crate::ir::ConstraintSystem;
use std::sync::Arc;

/// What it takes to have a mechanism once more, with its inputs as signals.
#[derive(Clone)]
pub(super) struct WithSignals {
    parsed: Parsed,
    /// Its number in the file.
    number: usize,
    surroundings: Arc<Surroundings>,
}

impl WithSignals {
    pub fn new(parsed: Parsed, number: usize, surroundings: Surroundings) -> WithSignals {
        WithSignals { parsed, number, surroundings: Arc::new(surroundings) }
    }

    /// Its equations.
    pub fn system(&self) -> Result<ConstraintSystem, Diagnostics> {
        let tree = &self.parsed.tree().mechanisms[self.number];
        let (model, said) = check::check(tree, &self.surroundings, self.parsed.sources());
        model.as_ref().map(lowered).ok_or(said)
    }
}
