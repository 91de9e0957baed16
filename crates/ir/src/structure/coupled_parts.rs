//! Parts whose texts ask for derivatives by their own equations: whether these determine a part alone, and whether the part moves together
//! with what is around it.

use super::{Determined, errors, matching};
use crate::{AskingPart, SparseRows};
use mechc_expr::Symbol;
use mechc_text::diag::Diagnostics;

impl Determined {
    /// The parts that ask for derivatives and move together with what is around them: their own equations are not solved on their own.
    ///
    /// # Errors
    /// Those that are not determined alone, with their inputs held.
    pub fn coupled_parts(&self) -> Result<Vec<String>, Diagnostics> {
        let mut said = Diagnostics::default();
        let (mut coupled, mut told) = (Vec::new(), Vec::new());
        for part in self.system.asking_parts() {
            // a fault of every copy is told once
            if told.contains(&part.places.as_slice()) {
                continue;
            }
            let before = said.len();
            let is_coupled = self.is_coupled(part);
            match self.counts_alone(part) {
                Some([rows, columns]) => said.push(errors::not_determined_alone(part, rows, columns)),
                None if is_coupled && !self.system.checks().is_empty() => {
                    said.push(errors::coupled_without_equations(part));
                }
                None if is_coupled && part.of_force.is_some() => said.push(errors::force_of_coupled(part)),
                None if is_coupled => coupled.push(part.name.clone()),
                None => {}
            }
            if said.len() > before {
                told.push(part.places.as_slice());
            }
        }
        if said.has_errors() { Err(said) } else { Ok(coupled) }
    }

    /// The numbers of a part's own equations and coordinates, if it is not determined alone; an equation that was left out counts where the
    /// others are enough.
    fn counts_alone(&self, part: &AskingPart) -> Option<[usize; 2]> {
        let rows = self.rows_of(part);
        // where inputs are held it is known which coordinates the rows hold then
        let held = self.system.scopes().iter().find(|scope| scope.name == part.name);
        let mut pattern = SparseRows::new();
        for (k, &row) in rows.iter().enumerate() {
            let own = held.map_or_else(|| self.system.phi_q().row(row as usize), |scope| scope.phi_q.row(k)).iter();
            let place = |column: &u32| part.columns.binary_search(column).ok();
            pattern.push(own.filter_map(|&(column, slope)| Some((place(&column)? as u32, slope))));
        }
        let is_alone = matching::maximum(&pattern, rows.len(), part.columns.len()).is_perfect();
        (!is_alone).then_some([rows.len(), part.columns.len()])
    }

    fn is_coupled(&self, part: &AskingPart) -> bool {
        let is_own_row =
            |row: &u32| part.declarations.binary_search(&self.system.rows()[*row as usize].declaration).is_ok();
        let is_own = |column: &u32| part.columns.binary_search(column).is_ok();
        let follows_itself = |symbol: Symbol| match symbol {
            Symbol::Coordinate { index, .. } => is_own(&index),
            _ => false,
        };
        if self.system.graph().symbols_of_all(&part.inputs).into_iter().any(follows_itself) {
            return true;
        }
        self.blocks
            .iter()
            .filter(|block| block.columns.iter().any(is_own))
            .any(|block| !(block.columns.iter().all(is_own) && block.rows.iter().all(is_own_row)))
    }

    fn rows_of(&self, part: &AskingPart) -> Vec<u32> {
        let is_own = |row: &usize| part.declarations.binary_search(&self.system.rows()[*row].declaration).is_ok();
        (0..self.system.rows().len()).filter(is_own).map(|row| row as u32).collect()
    }
}
