//! The proof that a mechanism is determined: by count, and by the structure of `Φ_q`.
//!
//! Works on the pattern alone and assembles nothing. What comes out is a [`Determined`] system, whose equations are
//! matched to coordinates and ordered in blocks: each block can be solved when those before it are.

mod count;
mod coupled_parts;
mod errors;
mod matching;
mod order;

pub use count::table;
pub use order::{Step, order_of_solution, steps};

use crate::{ConstraintSystem, Homotopy};
use mechc_expr::Symbol;
use mechc_text::diag::Diagnostic;
use std::sync::Arc;

/// Equations and coordinates that are solved together, each row beside the coordinate it is matched to.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Block {
    /// Rows of `Φ`.
    pub rows: Vec<u32>,
    /// Coordinates, as many.
    pub columns: Vec<u32>,
    /// Whether it is one equation that is linear in its coordinate, so that this follows without iteration.
    pub explicit: bool,
}

/// A constraint system of which count and structure have been shown.
#[derive(Clone, Debug)]
pub struct Determined {
    system: ConstraintSystem,
    blocks: Vec<Block>,
    /// All equations, where some are left out.
    whole: Option<Arc<Whole>>,
}

/// More equations than are needed, which do not contradict each other.
#[derive(Clone, Debug)]
struct Whole {
    system: ConstraintSystem,
    /// The rows that are left out, ascending.
    left_out: Vec<usize>,
    /// Coordinates [m, rad] at which all hold when the motion begins, where these are known.
    start: Option<Vec<f64>>,
}

impl Determined {
    /// A system without some of its rows, given ascending, which are checked instead.
    ///
    /// # Errors
    /// Why the others do not determine it.
    pub fn without(whole: ConstraintSystem, left_out: Vec<usize>) -> Result<Determined, Box<Refused>> {
        let mut system = whole.clone();
        system.leave_out(&left_out);
        let determined = prove(system)?;
        Ok(Determined { whole: Some(Arc::new(Whole { system: whole, left_out, start: None })), ..determined })
    }

    /// The same mechanism with coordinates [m, rad] at which all equations hold when the motion begins.
    #[must_use]
    pub fn with_start(self, start: Option<Vec<f64>>) -> Determined {
        let whole = self.whole.map(|whole| Arc::new(Whole { start, ..Arc::unwrap_or_clone(whole) }));
        Determined { whole, ..self }
    }

    /// Coordinates [m, rad] at which all equations hold when the motion begins, where these are known beside the estimates.
    #[must_use]
    pub fn start(&self) -> Option<&[f64]> {
        self.whole.as_ref()?.start.as_deref()
    }

    /// The same mechanism where other rows of the whole are left out; none where the others do not determine it.
    #[must_use]
    pub fn leaving_out(&self, left_out: &[usize]) -> Option<Determined> {
        Determined::without(self.whole().clone(), left_out.to_vec()).ok()
    }

    /// The same mechanism along a homotopy of all its equations; the same rows are left out.
    ///
    /// # Errors
    /// Why the others do not determine it.
    pub fn along(&self, homotopy: &Homotopy) -> Result<Determined, Box<Refused>> {
        let along = self.whole().along(homotopy);
        if self.whole.is_none() { prove(along) } else { Determined::without(along, self.left_out().to_vec()) }
    }

    /// All equations, those that are left out among them.
    #[must_use]
    pub fn whole(&self) -> &ConstraintSystem {
        self.whole.as_ref().map_or(&self.system, |whole| &whole.system)
    }

    /// The rows of the whole that are left out, ascending.
    #[must_use]
    pub fn left_out(&self) -> &[usize] {
        self.whole.as_ref().map_or(&[], |whole| &whole.left_out)
    }

    /// The rows of the whole that are solved, in order.
    #[must_use]
    pub fn kept(&self) -> Vec<usize> {
        (0..self.whole().rows().len()).filter(|row| self.left_out().binary_search(row).is_err()).collect()
    }

    /// The equations.
    #[must_use]
    pub fn system(&self) -> &ConstraintSystem {
        &self.system
    }

    /// The same with the variations that results need; none where they need none.
    #[must_use]
    pub fn for_variations_of_results(&self) -> Option<Determined> {
        let system = self.system.for_variations_of_results()?;
        Some(Determined { system, blocks: self.blocks.clone(), whole: None })
    }

    /// The same with other values of its parameters, of which neither count nor structure knows.
    #[must_use]
    pub fn with_values(&self, values: &[f64]) -> Determined {
        let whole = self.whole.as_deref().map(|Whole { system, left_out, .. }| {
            Arc::new(Whole { system: system.with_values(values), left_out: left_out.clone(), start: None })
        });
        Determined { system: self.system.with_values(values), blocks: self.blocks.clone(), whole }
    }

    /// The blocks, in an order of solution.
    #[must_use]
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// By coordinate: the number of its block.
    #[must_use]
    pub fn block_of_columns(&self) -> Vec<usize> {
        let mut block_of = vec![0; self.system.coordinates().len()];
        for (number, block) in self.blocks.iter().enumerate() {
            block.columns.iter().for_each(|&column| block_of[column as usize] = number);
        }
        block_of
    }

    /// The blocks that one of them cannot be solved without, by their numbers, in that order: itself, and what its equations read.
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
    let own = Symbol::Coordinate { index: column, order: 0 };
    let slope = system.phi_q().row(*row as usize).iter().find(|&&(used, _)| used == column);
    slope.is_some_and(|&(_, slope)| !system.graph().symbols(slope).contains(&own))
}

/// Why a system is not determined.
#[derive(Clone, Debug)]
pub struct Refused {
    /// The system.
    pub system: ConstraintSystem,
    /// The count's or the structure's diagnostic.
    pub diagnostic: Diagnostic,
    /// The part that has more equations than coordinates: these stand for themselves, and hold no other coordinates.
    pub too_many: Subsystem,
    /// The part that has fewer equations than coordinates; these may hold coordinates of other parts too.
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

/// Shows that a system is determined.
///
/// # Errors
/// Why it is not.
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
    Ok(Determined { system, blocks, whole: None })
}
