//! Lowering of a model to equations, with estimates of contacts.

use mechc_ir::ConstraintSystem;
use mechc_lang::estimates;
use mechc_lang::lower::{self, LowerOptions};
use mechc_lang::model::Mechanism;

/// Lowers a model to its equations, with estimates of all contacts. Cannot fail: `check` has refused what cannot be lowered.
#[must_use]
pub fn lower_model(model: &Mechanism, options: &LowerOptions) -> ConstraintSystem {
    let mut system = lower::lower(model, options);
    estimates::complete(&mut system);
    debug_assert_eq!(system.validate(), Ok(()));
    system
}
