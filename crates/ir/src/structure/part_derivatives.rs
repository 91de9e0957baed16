//! Derivatives in the texts of parts: by a part's own equations, so that the part must be determined alone, with its inputs held. Then they
//! equal the derivatives by all equations.

use super::{Block, Determined, errors};
use crate::PartWithDerivatives;
use mechc_expr::Symbol;
use mechc_text::diag::Diagnostics;

impl Determined {
    /// Checks that the parts whose texts differentiate are determined alone.
    ///
    /// # Errors
    /// Such parts that are not; a fault that all copies of a part share is reported once.
    pub fn check_part_derivatives(&self) -> Result<(), Diagnostics> {
        let (mut diagnostics, mut reported) = (Diagnostics::default(), Vec::new());
        for part in self.system.parts_with_derivatives() {
            if !reported.contains(&part.places.as_slice()) && !self.is_determined_alone(part) {
                diagnostics.push(errors::not_determined_alone(part));
                reported.push(part.places.as_slice());
            }
        }
        if diagnostics.is_empty() { Ok(()) } else { Err(diagnostics) }
    }

    /// Returns whether a part is solved by its own equations, and its inputs do not follow from its motion.
    fn is_determined_alone(&self, part: &PartWithDerivatives) -> bool {
        let is_own_row =
            |row: &u32| part.declarations.binary_search(&self.system.rows()[*row as usize].declaration).is_ok();
        let is_own = |column: &u32| part.columns.binary_search(column).is_ok();
        let is_own_coordinate = |symbol: Symbol| match symbol {
            Symbol::Coordinate { index, .. } => is_own(&index),
            _ => false,
        };
        let is_fed_back = self.system.graph().symbols_of_all(&part.inputs).into_iter().any(is_own_coordinate);
        let is_split = |block: &Block| {
            let mut are_own = block.columns.iter().map(is_own).chain(block.rows.iter().map(is_own_row));
            let first = are_own.next();
            are_own.any(|own| Some(own) != first)
        };
        !is_fed_back && !self.blocks.iter().any(is_split)
    }
}
