//! The equations of a mechanism, with estimates of all that the search for contacts can find.

use crate::estimates;
use crate::ir::ConstraintSystem;
use crate::lower;
use crate::model::Mechanism;

/// The one way to them: what a motion begins from. Cannot fail: what could make it fail has been refused by `check`.
#[must_use]
pub fn lowered(model: &Mechanism) -> ConstraintSystem {
    let mut system = lower::lower(model);
    estimates::complete(&mut system);
    system
}
