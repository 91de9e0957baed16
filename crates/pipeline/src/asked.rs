//! What is made of a mechanism that was checked when an editor first asks for it.

use mechc_ir::ConstraintSystem;
use mechc_lang::check::Known;
use std::sync::OnceLock;

/// A place for each.
#[derive(Debug, Default)]
pub(super) struct Asked {
    /// What its declarations say by themselves.
    pub known: OnceLock<Known>,
    /// Its equations; nothing where there is no model.
    pub lowered: OnceLock<Option<ConstraintSystem>>,
}
