//! Lowering of a model to equations, with estimates of contacts; and rebuilding of a mechanism from its text, with inputs as signals or with
//! reactions.

use crate::Parsed;
use mechc_ir::ConstraintSystem;
use mechc_lang::check::{self, CheckOptions};
use mechc_lang::estimates;
use mechc_lang::lower::{self, TimeOnPath};
use mechc_lang::model::Mechanism;
use mechc_text::diag::Diagnostics;
use std::sync::Arc;

/// Lowers a model to its equations, with estimates of all contacts. Cannot fail: `check` has refused what cannot be lowered.
#[must_use]
pub fn lower_model(model: &Mechanism) -> ConstraintSystem {
    let mut system = lower::lower(model);
    estimates::complete(&mut system);
    debug_assert_eq!(system.validate(), Ok(()));
    system
}

/// Lowers a model to equations on a path from its nominal values to others.
#[must_use]
pub(crate) fn lower_on_path(model: &Mechanism, clock: TimeOnPath) -> ConstraintSystem {
    let mut system = lower::lower_continuation(model, clock);
    estimates::complete(&mut system);
    debug_assert_eq!(system.validate(), Ok(()));
    system
}

/// All that a mechanism is checked from, to check it again with other options.
#[derive(Clone)]
pub(crate) struct Rebuild {
    parsed: Parsed,
    /// Index of the mechanism in its file.
    index: usize,
    check_options: Arc<CheckOptions>,
}

impl Rebuild {
    pub fn new(parsed: Parsed, index: usize, check_options: Arc<CheckOptions>) -> Rebuild {
        Rebuild { parsed, index, check_options }
    }

    /// Returns the equations with inputs as signals.
    pub fn with_signals(&self) -> Result<ConstraintSystem, Diagnostics> {
        let check_options = CheckOptions { has_signals: true, ..(*self.check_options).clone() };
        let (model, diagnostics) = self.checked(&check_options);
        model.as_ref().map(lower_model).ok_or(diagnostics)
    }

    /// Returns the equations with all reactions of joints and efforts of drivers, and what rebuilds such a mechanism; `None` if it has no masses
    /// and loads.
    pub fn with_reactions(&self) -> Option<(ConstraintSystem, Rebuild)> {
        let check_options = CheckOptions { reactions: true, ..(*self.check_options).clone() };
        let model = self.checked(&check_options).0.filter(Mechanism::has_forces)?;
        Some((lower_model(&model), Rebuild { check_options: Arc::new(check_options), ..self.clone() }))
    }

    fn checked(&self, check_options: &CheckOptions) -> (Option<Mechanism>, Diagnostics) {
        check::check(&self.parsed.tree().mechanisms[self.index], check_options, self.parsed.sources())
    }
}
