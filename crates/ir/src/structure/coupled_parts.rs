//! Parts that request derivatives by their own equations: whether these determine the part alone, and whether the part moves together with
//! its surroundings.

use super::{Determined, errors, matching};
use crate::{PartWithDerivatives, SparseRows};
use mechc_expr::Symbol;
use mechc_text::diag::Diagnostics;

impl Determined {
    /// Returns the names of the parts that request derivatives and are coupled: their equations cannot be solved separately.
    ///
    /// # Errors
    /// Parts that are not determined alone with their inputs scope, and requests that coupled parts do not support.
    pub fn coupled_parts(&self) -> Result<Vec<String>, Diagnostics> {
        let mut diagnostics = Diagnostics::default();
        let (mut coupled, mut reported) = (Vec::new(), Vec::new());
        for part in self.system.parts_with_derivatives() {
            // a fault that all copies of a part share is reported once
            if reported.contains(&part.places.as_slice()) {
                continue;
            }
            let before = diagnostics.len();
            let is_coupled = self.is_coupled(part);
            match self.counts_alone(part) {
                Some([rows, columns]) => diagnostics.push(errors::not_determined_alone(part, rows, columns)),
                None if is_coupled && !self.system.checks().is_empty() => {
                    diagnostics.push(errors::coupled_without_equations(part));
                }
                None if is_coupled && part.of_force.is_some() => diagnostics.push(errors::force_of_coupled(part)),
                None if is_coupled => coupled.push(part.name.clone()),
                None => {}
            }
            if diagnostics.len() > before {
                reported.push(part.places.as_slice());
            }
        }
        if diagnostics.has_errors() { Err(diagnostics) } else { Ok(coupled) }
    }

    /// Returns the numbers of equations and coordinates of a part, if it is not determined alone. A left-out equation counts where the
    /// others suffice.
    fn counts_alone(&self, part: &PartWithDerivatives) -> Option<[usize; 2]> {
        let rows = self.rows_of(part);
        // if the part's inputs are held, its scope has the coordinates that the rows then contain
        let scope = self.system.scopes().iter().find(|scope| scope.name == part.name);
        let mut pattern = SparseRows::new();
        for (k, &row) in rows.iter().enumerate() {
            let entries =
                scope.map_or_else(|| self.system.phi_q().row(row as usize), |scope| scope.phi_q.row(k)).iter();
            let position = |column: &u32| part.columns.binary_search(column).ok();
            pattern.push(entries.filter_map(|&(column, slope)| Some((position(&column)? as u32, slope))));
        }
        let is_alone = matching::maximum(&pattern, rows.len(), part.columns.len()).is_perfect();
        (!is_alone).then_some([rows.len(), part.columns.len()])
    }

    fn is_coupled(&self, part: &PartWithDerivatives) -> bool {
        let is_local_row =
            |row: &u32| part.declarations.binary_search(&self.system.rows()[*row as usize].declaration).is_ok();
        let is_local = |column: &u32| part.columns.binary_search(column).is_ok();
        let depends_on_part = |symbol: Symbol| match symbol {
            Symbol::Coordinate { index, .. } => is_local(&index),
            _ => false,
        };
        if self.system.graph().symbols_of_all(&part.inputs).into_iter().any(depends_on_part) {
            return true;
        }
        self.blocks
            .iter()
            .filter(|block| block.columns.iter().any(is_local))
            .any(|block| !(block.columns.iter().all(is_local) && block.rows.iter().all(is_local_row)))
    }

    fn rows_of(&self, part: &PartWithDerivatives) -> Vec<u32> {
        let is_local = |row: &usize| part.declarations.binary_search(&self.system.rows()[*row].declaration).is_ok();
        (0..self.system.rows().len()).filter(is_local).map(|row| row as u32).collect()
    }
}
