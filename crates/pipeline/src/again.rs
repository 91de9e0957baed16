//! A mechanism once more, made from its text when somebody asks for it: with its inputs as signals, with all that joints exert.

use super::Parsed;
use super::lowered::lowered;
use mechc_ir::ConstraintSystem;
use mechc_lang::check::{self, Surroundings};
use mechc_lang::model::Mechanism;
use mechc_text::diag::Diagnostics;
use std::sync::Arc;

/// What it takes to have a mechanism once more.
#[derive(Clone)]
pub(super) struct Again {
    parsed: Parsed,
    /// Its number in the file.
    number: usize,
    surroundings: Arc<Surroundings>,
}

impl Again {
    pub fn new(parsed: Parsed, number: usize, surroundings: Arc<Surroundings>) -> Again {
        Again { parsed, number, surroundings }
    }

    /// Its equations, with its inputs as signals.
    pub fn with_signals(&self) -> Result<ConstraintSystem, Diagnostics> {
        let surroundings = Surroundings { has_signals: true, ..(*self.surroundings).clone() };
        let (model, said) = self.checked(&surroundings);
        model.as_ref().map(lowered).ok_or(said)
    }

    /// What it takes to have it with all that joints exert and drivers supply; nothing where it has no masses and loads.
    pub fn with_reactions(&self) -> Option<(ConstraintSystem, Again)> {
        let surroundings = Surroundings { reactions: true, ..(*self.surroundings).clone() };
        let model = self.checked(&surroundings).0.filter(Mechanism::has_forces)?;
        Some((lowered(&model), Again { surroundings: Arc::new(surroundings), ..self.clone() }))
    }

    fn checked(&self, surroundings: &Surroundings) -> (Option<Mechanism>, Diagnostics) {
        check::check(&self.parsed.tree().mechanisms[self.number], surroundings, self.parsed.sources())
    }
}
