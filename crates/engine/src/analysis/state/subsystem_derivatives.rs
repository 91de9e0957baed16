//! Derivatives by the equations of one subsystem: each subsystem has a dense matrix of its rows and coordinates.

use super::dense::{factor_dense, solve_dense};
use mechc_ir::program::{Program, Register, Registers};
use mechc_ir::{ConstraintSystem, Scope};

/// Factors of the matrix of each subsystem.
#[derive(Clone)]
pub struct SubsystemFactors {
    scopes: Vec<SubsystemLu>,
}

#[derive(Clone)]
struct SubsystemLu {
    columns: Vec<u32>,
    /// Scale of each column.
    scales: Vec<f64>,
    /// By row: the places of its entries among the columns.
    pattern: Vec<Vec<usize>>,
    /// By row, one over its norm.
    inverse_norms: Vec<f64>,
    a: Vec<f64>,
    pivots: Vec<u32>,
    right: Vec<f64>,
    /// True if the position is far enough from a singular position.
    is_trusted: bool,
}

impl SubsystemFactors {
    pub fn new(system: &ConstraintSystem) -> SubsystemFactors {
        SubsystemFactors { scopes: system.scopes().iter().map(|scope| SubsystemLu::new(scope, system)).collect() }
    }

    /// Factors the matrices of all parts, where the right sides of the first variations have been computed; what is nearer to a singular
    /// position than a limit is not trusted.
    pub fn factor(&mut self, program: &Program, registers: &Registers, limit: f64) {
        for (subsystem, entries) in self.scopes.iter_mut().zip(&program.outputs.scopes) {
            subsystem.factor(entries, registers, limit);
        }
    }

    /// Solves the equations of a part for a right side; `x` has all coordinates, of which the others are 0.
    pub fn solve(&mut self, scope: u32, registers: &Registers, right: &[Register], x: &mut [f64]) {
        x.fill(0.0);
        let subsystem = &mut self.scopes[scope as usize];
        for ((b, register), inverse) in subsystem.right.iter_mut().zip(right).zip(&subsystem.inverse_norms) {
            *b = registers.get(*register) * inverse;
        }
        solve_dense(&subsystem.a, &subsystem.pivots, &mut subsystem.right);
        for ((column, b), scale) in subsystem.columns.iter().zip(&subsystem.right).zip(&subsystem.scales) {
            x[*column as usize] = if subsystem.is_trusted { b * scale } else { f64::NAN };
        }
    }
}

impl SubsystemLu {
    fn new(scope: &Scope, system: &ConstraintSystem) -> SubsystemLu {
        let n = scope.columns.len();
        let place = |&(column, _): &(u32, _)| scope.columns.binary_search(&column).unwrap_or(0);
        SubsystemLu {
            columns: scope.columns.clone(),
            scales: scope.columns.iter().map(|&column| system.coordinates()[column as usize].scale).collect(),
            pattern: (0..scope.phi.len()).map(|row| scope.phi_q.row(row).iter().map(place).collect()).collect(),
            inverse_norms: vec![0.0; n],
            a: vec![0.0; n * n],
            pivots: vec![0; n],
            right: vec![0.0; n],
            is_trusted: false,
        }
    }

    fn factor(&mut self, entries: &[Register], registers: &Registers, limit: f64) {
        let n = self.columns.len();
        self.a.fill(0.0);
        let mut entries = entries.iter();
        for (row, pattern) in self.pattern.iter().enumerate() {
            let line = &mut self.a[row * n..][..n];
            for (&place, &register) in pattern.iter().zip(&mut entries) {
                line[place] = registers.get(register) * self.scales[place];
            }
            let norm = line.iter().map(|x| x * x).sum::<f64>().sqrt();
            self.inverse_norms[row] = 1.0 / norm;
            for x in line {
                *x /= norm;
            }
        }
        factor_dense(&mut self.a, &mut self.pivots, n);
        self.is_trusted = 1.0 / self.norm_of_inverse() >= limit;
    }

    /// Returns the Frobenius norm of the scaled inverse, which is no less than one over the smallest singular value.
    fn norm_of_inverse(&mut self) -> f64 {
        let mut sum = 0.0;
        for k in 0..self.columns.len() {
            self.right.fill(0.0);
            self.right[k] = 1.0;
            solve_dense(&self.a, &self.pivots, &mut self.right);
            sum += self.right.iter().map(|x| x * x).sum::<f64>();
        }
        sum.sqrt()
    }
}
