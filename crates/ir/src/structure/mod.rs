//! Proof that a mechanism is determined: by the count, and by the structure of `Φ_q`.
//!
//! The proof uses the sparsity pattern alone and computes no values. Its result is a [`Determined`] system, whose equations are matched to
//! coordinates and ordered in blocks; each block can be solved after those before it.

mod count;
mod errors;
mod matching;
mod order;
mod part_derivatives;

pub use count::table;
pub use order::{Step, order_of_solution, steps};

use crate::{ConstraintSystem, Homotopy};
use mechc_expr::Symbol;
use mechc_text::diag::Diagnostic;
use std::sync::Arc;

/// Equations and coordinates that are solved together; each row stands at the index of its matched coordinate.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Block {
    /// Rows of `Φ`.
    pub rows: Vec<u32>,
    /// Coordinates, as many as rows.
    pub columns: Vec<u32>,
    /// True if the block is one equation that is linear in its coordinate, so that it is solved without iteration.
    pub explicit: bool,
}

/// A constraint system that is determined by count and structure.
#[derive(Clone, Debug)]
pub struct Determined {
    system: ConstraintSystem,
    blocks: Vec<Block>,
    /// The full system, if rows have been left out.
    full: Option<Arc<FullSystem>>,
}

/// A redundant but consistent system.
#[derive(Clone, Debug)]
struct FullSystem {
    system: ConstraintSystem,
    /// The rows that are left out, ascending.
    left_out: Vec<usize>,
    /// Coordinates [m, rad] at which all equations hold when the motion begins, if known.
    start: Option<Vec<f64>>,
}

impl Determined {
    /// Proves a system after some of its rows, given ascending, have been left out; these are checked instead.
    ///
    /// # Errors
    /// The reason why the other rows do not determine it.
    pub fn without(full: ConstraintSystem, left_out: Vec<usize>) -> Result<Determined, Box<Refused>> {
        let mut system = full.clone();
        system.leave_out(&left_out);
        let determined = prove(system)?;
        Ok(Determined { full: Some(Arc::new(FullSystem { system: full, left_out, start: None })), ..determined })
    }

    /// Sets coordinates [m, rad] at which all equations hold when the motion begins. Without left-out rows it has no effect.
    #[must_use]
    pub fn with_start(self, start: Option<Vec<f64>>) -> Determined {
        let full = self.full.map(|full| Arc::new(FullSystem { start, ..Arc::unwrap_or_clone(full) }));
        Determined { full, ..self }
    }

    /// Returns coordinates [m, rad] at which all equations hold when the motion begins, if known from elsewhere than the estimates.
    #[must_use]
    pub fn start(&self) -> Option<&[f64]> {
        self.full.as_ref()?.start.as_deref()
    }

    /// Returns the same mechanism with other rows of the full system left out; `None` if the remaining rows do not determine it.
    #[must_use]
    pub fn with_rows_dropped(&self, left_out: &[usize]) -> Option<Determined> {
        Determined::without(self.whole().clone(), left_out.to_vec()).ok()
    }

    /// Returns the mechanism along a homotopy of all its equations, with the same rows left out.
    ///
    /// # Errors
    /// The reason why the other rows do not determine it.
    pub fn along(&self, homotopy: &Homotopy) -> Result<Determined, Box<Refused>> {
        let along = self.whole().along(homotopy);
        if self.full.is_none() { prove(along) } else { Determined::without(along, self.left_out().to_vec()) }
    }

    /// Returns the full system, with all equations.
    #[must_use]
    pub fn whole(&self) -> &ConstraintSystem {
        self.full.as_ref().map_or(&self.system, |full| &full.system)
    }

    /// Returns the left-out rows of the full system, ascending.
    #[must_use]
    pub fn left_out(&self) -> &[usize] {
        self.full.as_ref().map_or(&[], |full| &full.left_out)
    }

    /// Returns the rows of the full system that are solved, ascending.
    #[must_use]
    pub fn kept(&self) -> Vec<usize> {
        (0..self.whole().rows().len()).filter(|row| self.left_out().binary_search(row).is_err()).collect()
    }

    /// Returns the solved equations.
    #[must_use]
    pub fn system(&self) -> &ConstraintSystem {
        &self.system
    }

    /// Returns the same system with the variations that results need; `None` if results need no variations.
    #[must_use]
    pub fn with_result_variations(&self) -> Option<Determined> {
        let system = self.system.with_result_variations()?;
        Some(Determined { system, blocks: self.blocks.clone(), full: None })
    }

    /// Returns the same system with other parameter values; count and structure do not depend on them.
    #[must_use]
    pub fn with_values(&self, values: &[f64]) -> Determined {
        let full = self.full.as_deref().map(|FullSystem { system, left_out, .. }| {
            Arc::new(FullSystem { system: system.with_values(values), left_out: left_out.clone(), start: None })
        });
        Determined { system: self.system.with_values(values), blocks: self.blocks.clone(), full }
    }

    /// Returns the blocks, in an order of solution.
    #[must_use]
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// Returns the number of the block of each coordinate.
    #[must_use]
    pub fn block_of_columns(&self) -> Vec<usize> {
        let mut block_of = vec![0; self.system.coordinates().len()];
        for (number, block) in self.blocks.iter().enumerate() {
            block.columns.iter().for_each(|&column| block_of[column as usize] = number);
        }
        block_of
    }

    /// Returns the numbers of the blocks that a block depends on, itself included, in order of solution.
    #[must_use]
    pub fn needed_by(&self, block: usize) -> Vec<usize> {
        let block_of = self.block_of_columns();
        let mut is_needed = vec![false; self.blocks.len()];
        let mut open = vec![block];
        while let Some(number) = open.pop() {
            if !std::mem::replace(&mut is_needed[number], true) {
                let read = self.blocks[number].rows.iter().flat_map(|&row| self.system.phi_q().row(row as usize));
                open.extend(read.map(|&(column, _)| block_of[column as usize]));
            }
        }
        (0..self.blocks.len()).filter(|&number| is_needed[number]).collect()
    }
}

fn is_explicit(system: &ConstraintSystem, block: &Block) -> bool {
    let ([row], &[column]) = (block.rows.as_slice(), block.columns.as_slice()) else {
        return false;
    };
    let variable = Symbol::Coordinate { index: column, order: 0 };
    let slope = system.phi_q().row(*row as usize).iter().find(|&&(used, _)| used == column);
    slope.is_some_and(|&(_, slope)| !system.graph().symbols(slope).contains(&variable))
}

/// The reason why a system is not determined.
#[derive(Clone, Debug)]
pub struct Refused {
    /// The system.
    pub system: ConstraintSystem,
    /// Diagnostic of the count or of the structure.
    pub diagnostic: Diagnostic,
    /// Overdetermined part: its equations contain no coordinates of other parts.
    pub too_many: Subsystem,
    /// Underdetermined part: its equations may contain coordinates of other parts.
    pub too_few: Subsystem,
}

/// Equations and coordinates of a system.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Subsystem {
    /// Rows of `Φ`, ascending.
    pub rows: Vec<u32>,
    /// Coordinates, ascending.
    pub columns: Vec<u32>,
}

/// Proves that a system is determined.
///
/// # Errors
/// The reason why it is not.
pub fn prove(system: ConstraintSystem) -> Result<Determined, Box<Refused>> {
    let matching = matching::maximum(system.phi_q(), system.rows().len(), system.coordinates().len());
    if !matching.is_perfect() {
        let [too_many, too_few] = matching.unequal_parts(system.phi_q());
        let diagnostic = if system.ndof() == 0 {
            errors::structure(&system, &too_many, &too_few)
        } else {
            errors::count(&system, &too_many, &too_few)
        };
        return Err(Box::new(Refused { system, diagnostic, too_many, too_few }));
    }
    let mut blocks = matching.blocks(system.phi_q());
    for block in &mut blocks {
        block.explicit = is_explicit(&system, block);
    }
    Ok(Determined { system, blocks, full: None })
}
