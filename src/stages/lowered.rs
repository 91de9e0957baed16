//! The equations of a mechanism, with estimates of all that the search for contacts can find.

use crate::estimates;
use crate::ir::ConstraintSystem;
use crate::lower;
use crate::model::Mechanism;

/// Cannot fail: what could make it fail has been refused by `check`.
pub(super) fn lowered(model: &Mechanism) -> ConstraintSystem {
    let mut system = lower::lower(model);
    estimates::complete(&mut system);
    system
}
