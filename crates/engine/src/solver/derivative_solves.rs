//! Linear solves `Φ_q x = right` with a block's factors: derivatives with respect to time, signals and parameters, and variations.

use super::Values;
use super::build::Builder;
use super::elimination::Factors;
use super::tape::Value;
use mechc_ir::With;
use mechc_ir::program::{Register, RightSideRegisters};
use mechc_ir::structure::Block;

impl<V: Values> Builder<'_, V> {
    /// Solves for all derivatives of a block whose position is solved.
    pub fn solve_derivatives(&mut self, block: &Block, factors: &Factors) {
        let program = self.program;
        let (outputs, inputs) = (&program.outputs, &program.inputs);
        let mut others = 0;
        for RightSideRegisters { with, entries } in &outputs.right_sides {
            // code needs third derivatives in its measures only
            let is_of_measures = *with == With::Time(3) && self.is_for_code();
            let stored = if is_of_measures { Stored::Shared } else { Stored::All };
            let (unknown, column) = if let With::Time(order) = with {
                let order = usize::from(*order);
                (inputs.coordinates[order], self.layout.coordinates[order])
            } else {
                let first = others * inputs.n;
                others += 1;
                (inputs.slopes + first, self.layout.slopes + first)
            };
            self.solve(block, factors, entries, unknown, column, stored);
        }
        for (variation, rights) in (0..).zip(&outputs.variations) {
            for (order, right) in (0..).zip(rights) {
                let first = inputs.varied(variation, order);
                let column = self.layout.varied + first - inputs.varied;
                self.solve(block, factors, right, first, column, Stored::Shared);
            }
        }
    }

    /// Solves a block of `Φ_q x = right`. `right` holds a register of the program for each row; `unknown` and `column` are the program's register and
    /// the stored column of the first unknown of the system.
    fn solve(
        &mut self,
        block: &Block,
        factors: &Factors,
        right: &[Register],
        unknown: Register,
        column: u32,
        stored: Stored,
    ) {
        let phi_q = &self.program.outputs.phi_q;
        let mut sums = Vec::with_capacity(block.rows.len());
        for &row in &block.rows {
            let mut sum = self.symbolic.value(right[row as usize]);
            for (at, other) in self.entries_outside(block, row) {
                sum = self.symbolic.minus_product(sum, phi_q[at], unknown + other);
            }
            sums.push(sum);
        }
        let solution: Vec<Value> = factors.solve(&mut self.symbolic.tape, sums);
        for (&coordinate, &value) in block.columns.iter().zip(&solution) {
            self.symbolic.define(unknown + coordinate, value);
            if stored == Stored::All || self.is_shared(column + coordinate) {
                self.symbolic.tape.store(column + coordinate, value);
            }
        }
    }
}

/// The part of a solution that is stored in columns.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stored {
    All,
    /// The columns that shared outputs read.
    Shared,
}
