//! The equations of a mechanism, with estimates of all that the search for contacts can find.

use mechc_ir::ConstraintSystem;
use mechc_lang::estimates;
use mechc_lang::lower::{self, Clock};
use mechc_lang::model::Mechanism;

/// The one way to them: what a motion begins from. Cannot fail: what could make it fail has been refused by `check`.
#[must_use]
pub fn lowered(model: &Mechanism) -> ConstraintSystem {
    let mut system = lower::lower(model);
    estimates::complete(&mut system);
    debug_assert_eq!(system.validate(), Ok(()));
    system
}

/// The same of a mechanism on its way from its own values to others.
#[must_use]
pub(super) fn lowered_on_its_way(model: &Mechanism, clock: Clock) -> ConstraintSystem {
    let mut system = lower::lower_on_its_way(model, clock);
    estimates::complete(&mut system);
    debug_assert_eq!(system.validate(), Ok(()));
    system
}
