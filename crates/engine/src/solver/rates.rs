//! What a block's factors give beside its position: derivatives by time, by signals and parameters, and variations. All solve
//! `Φ_q x = right`.

use super::Values;
use super::build::Builder;
use super::elimination::Factors;
use super::tape::Value;
use mechc_ir::With;
use mechc_ir::program::{PlacedSide, Register};
use mechc_ir::structure::Block;

impl<V: Values> Builder<'_, V> {
    /// All that is asked of a block whose position is known.
    pub fn rates(&mut self, block: &Block, factors: &Factors) {
        let program = self.program;
        let (outputs, inputs) = (&program.outputs, &program.inputs);
        let mut others = 0;
        for PlacedSide { with, entries } in &outputs.right_sides {
            // code has no use for third derivatives but in its measures
            let is_of_measures = *with == With::Time(3) && self.is_for_code();
            let kept = if is_of_measures { Kept::Joined } else { Kept::All };
            let (unknown, column) = if let With::Time(order) = with {
                let order = usize::from(*order);
                (inputs.coordinates[order], self.layout.coordinates[order])
            } else {
                let first = others * inputs.n;
                others += 1;
                (inputs.slopes + first, self.layout.slopes + first)
            };
            self.solve(block, factors, entries, unknown, column, kept);
        }
        for (variation, rights) in (0..).zip(&outputs.variations) {
            for (order, right) in (0..).zip(rights) {
                let first = inputs.varied(variation, order);
                let column = self.layout.varied + first - inputs.varied;
                self.solve(block, factors, right, first, column, Kept::Joined);
            }
        }
    }

    /// Solves with a block's factors for unknowns of which the program has the first in a register, and the row in a column.
    fn solve(
        &mut self,
        block: &Block,
        factors: &Factors,
        right: &[Register],
        unknown: Register,
        column: u32,
        kept: Kept,
    ) {
        let phi_q = &self.program.outputs.phi_q;
        let mut sums = Vec::with_capacity(block.rows.len());
        for &row in &block.rows {
            let mut sum = self.terms.value(right[row as usize]);
            for (at, other) in self.entries_outside(block, row) {
                sum = self.terms.less_product(sum, phi_q[at], unknown + other);
            }
            sums.push(sum);
        }
        let solution: Vec<Value> = factors.solve(&mut self.terms.tape, sums);
        for (&place, &value) in block.columns.iter().zip(&solution) {
            self.terms.know(unknown + place, value);
            if kept == Kept::All || self.is_joined(column + place) {
                self.terms.tape.store(column + place, value);
            }
        }
    }
}

/// What of a solution is left in its columns.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kept {
    All,
    /// What joins components.
    Joined,
}
