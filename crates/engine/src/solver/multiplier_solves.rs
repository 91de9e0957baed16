//! Linear solves `Φ_qᵀ λ = p` for the multipliers of a component, with the factors of its blocks from the last to the first.

use super::Values;
use super::build::Builder;
use super::elimination::Factors;
use super::tape::Value;
use mechc_ir::program::Register;
use mechc_ir::structure::Block;
use rustc_hash::FxHashMap;

impl<V: Values> Builder<'_, V> {
    /// Solves for the multipliers, and their variations, of a component whose motion is solved.
    pub fn solve_multipliers(&mut self, blocks: &[(&Block, Factors)]) {
        let program = self.program;
        let (outputs, inputs) = (&program.outputs, &program.inputs);
        if outputs.forces.is_empty() {
            return;
        }
        self.solve_transposed(blocks, &outputs.forces, inputs.multipliers);
        for (variation, right) in (0..).zip(&outputs.varied_forces).filter(|(_, right)| !right.is_empty()) {
            self.solve_transposed(blocks, right, inputs.varied_multipliers(variation));
        }
    }

    /// Solves for one unknown for each equation; `unknown` is the program's register of the first. The right side, in registers of the program, is by
    /// coordinate.
    fn solve_transposed(&mut self, blocks: &[(&Block, Factors)], right: &[Register], unknown: Register) {
        let program = self.program;
        let column = self.layout.multipliers + (unknown - program.inputs.multipliers);
        // by coordinate: entries of the equations of later blocks, as positions in the pattern with rows
        let mut transferred: FxHashMap<u32, Vec<(usize, u32)>> = FxHashMap::default();
        for (block, factors) in blocks.iter().rev() {
            let mut sums = Vec::with_capacity(block.columns.len());
            for &column in &block.columns {
                let mut sum = self.symbolic.value(right[column as usize]);
                for (at, row) in transferred.remove(&column).into_iter().flatten() {
                    sum = self.symbolic.minus_product(sum, program.outputs.phi_q[at], unknown + row);
                }
                sums.push(sum);
            }
            let solution: Vec<Value> = factors.solve_transposed(&mut self.symbolic.tape, sums);
            for (&row, &value) in block.rows.iter().zip(&solution) {
                self.symbolic.define(unknown + row, value);
                if self.is_shared(column + row) || self.is_for_variants() {
                    self.symbolic.tape.store(column + row, value);
                }
                for (at, other) in self.entries_outside(block, row) {
                    transferred.entry(other).or_default().push((at, row));
                }
            }
        }
    }
}
