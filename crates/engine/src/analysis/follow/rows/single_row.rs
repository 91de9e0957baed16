//! A row that is solved for on its own, by the operations that all other rows come from.

use crate::analysis::state::Kinematics;
use crate::solver::{Batch, Lanes, Solver};

/// A lane and its row.
pub struct SingleRow {
    lane: Lanes<1>,
    row: Vec<f64>,
}

impl SingleRow {
    pub fn new(kinematics: &Kinematics, solver: &Solver) -> SingleRow {
        SingleRow { lane: Lanes::new(solver, kinematics.vectors()), row: vec![0.0; solver.layout().stride] }
    }

    /// Solves at one time; returns whether the solution holds.
    pub fn solve(&mut self, kinematics: &Kinematics, solver: &Solver, at: &Batch<'_, 1>) -> bool {
        let (program, registers) = kinematics.program();
        let [holds] = self.lane.run(solver, program, registers, at, &mut self.row);
        holds
    }

    /// Returns the first correction of the last solution, scaled.
    pub fn first_correction(&self) -> f64 {
        self.lane.first_correction()
    }

    /// Returns the row of the last solution, with the columns that are not printed.
    pub fn row(&self) -> &[f64] {
        &self.row
    }

    /// Returns that row, to be written.
    pub fn row_mut(&mut self) -> &mut [f64] {
        &mut self.row
    }
}
