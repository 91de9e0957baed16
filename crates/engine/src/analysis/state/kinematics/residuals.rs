//! Residuals of the equations at a position.

use super::{Kinematics, State};
use crate::limits::redundancy::LARGEST_OPENING;
use mechc_ir::program::{Program, Register, Registers};
use mechc_ir::{MonitorKind, Owner};

/// Rounding of a term, as a part of it.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

impl Kinematics {
    /// Returns the residual of a row's velocity and acceleration equation with the derivatives of another state, scaled; the
    /// derivatives at the current position must just have been computed.
    pub fn left_open(&self, row: usize, state: &State) -> (f64, f64) {
        let outputs = &self.program.outputs;
        let open = |x: &[f64], right: Register| {
            (self.left(row, x) - self.registers.get(right)).abs() / self.linear.row_norm(row)
        };
        (open(&state.qd, outputs.nu()[row]), open(&state.qdd, outputs.gamma()[row]))
    }

    /// Returns the number of the first equation that was left out and does not hold at the current position.
    pub fn broken_check(&self) -> Option<usize> {
        let mut open = self.system().checks().iter().enumerate().map(|(k, check)| self.check(k).abs() / check.scale);
        open.position(|open| open.is_nan() || open > LARGEST_OPENING)
    }

    /// Returns `Φ` of an equation that was left out, by its number among the checks at the current position.
    pub fn check(&self, index: usize) -> f64 {
        self.registers.get(self.program.outputs.checks[index])
    }

    /// Returns a monitored quantity relative to its scale at the current position.
    pub fn monitored(&self, index: usize) -> f64 {
        self.registers.get(self.program.outputs.watches[index]) / self.system().monitors()[index].scale
    }

    /// Writes the sign of each monitored quantity.
    pub fn sides(&self, sides: &mut [bool]) {
        for (k, side) in sides.iter_mut().enumerate() {
            *side = self.monitored(k) > 0.0;
        }
    }

    /// Returns the coordinates `θ` of lines of centres that point away from the other centre at the current position.
    pub fn turned_lines(&self) -> Vec<usize> {
        let system = self.system();
        let is_turned =
            |k: &usize| system.monitors()[*k].kind == MonitorKind::LineOfCenters && self.monitored(*k) < 0.0;
        let joints =
            (0..system.monitors().len()).filter(is_turned).map(|k| Owner::Joint(system.monitors()[k].declaration));
        joints.filter_map(|owner| system.coordinates().iter().position(|c| c.owner == owner)).collect()
    }

    /// By row, one over what may be left of it: its tolerance and what the coordinates' rounding makes, where the position was
    /// set and factored.
    pub fn write_bounds(&self, bounds: &mut [f64]) {
        for (row, bound) in bounds.iter_mut().enumerate() {
            let rounding = ROUNDING * self.steps(row).fold(0.0, f64::max);
            *bound = 1.0 / (self.tolerance * self.linear.row_norm(row) + rounding);
        }
    }

    /// Returns whether some rows hold, to the tolerance.
    pub fn hold(&self, rows: &[u32]) -> bool {
        rows.iter().all(|&row| self.is_met(row as usize))
    }

    /// Returns whether some rows are open by no more than `limit`, scaled.
    pub fn hold_nearly(&self, rows: &[u32], limit: f64) -> bool {
        rows.iter().all(|&row| self.residual(row as usize) <= limit)
    }

    /// Returns the row that violates its tolerance most, with its scaled residual; `None` if all hold.
    ///
    /// A row's tolerance is `--tolerance` times its norm, plus what rounding alone makes of its terms and of the
    /// coordinates that it depends on.
    pub fn violated(&self) -> Option<(usize, f64)> {
        let n = self.system().rows().len();
        let mut worst: Option<(usize, f64)> = None;
        for row in (0..n).filter(|&row| !self.is_met(row)) {
            let residual = self.residual(row);
            if worst.is_none_or(|(_, largest)| residual > largest) {
                worst = Some((row, residual));
            }
        }
        worst
    }

    /// Returns whether a row holds, to the tolerance and rounding; one that is not a number does not.
    fn is_met(&self, row: usize) -> bool {
        let (off, bound) = (self.phi(row).abs(), self.tolerance * self.linear.row_norm(row));
        off <= bound || off <= bound + self.rounding(row)
    }

    /// Returns the scaled residual of a row of Φ.
    pub fn residual(&self, row: usize) -> f64 {
        self.phi(row).abs() / self.linear.row_norm(row)
    }

    /// Returns the largest scaled residual of all rows of Φ.
    pub fn largest_residual(&self) -> f64 {
        (0..self.system().rows().len()).map(|row| self.residual(row)).fold(0.0, f64::max)
    }

    /// Returns 8 eps times the largest term of a row, including the steps of its coordinates.
    fn rounding(&self, row: usize) -> f64 {
        ROUNDING * self.largest_part(row)
    }

    pub(super) fn largest_part(&self, row: usize) -> f64 {
        self.steps(row).fold(self.largest_term_of(row), f64::max)
    }

    /// Returns the largest term of a row at the current position.
    pub(super) fn largest_term_of(&self, row: usize) -> f64 {
        largest_term(&self.program, &self.registers, row)
    }

    /// Returns the contribution of each coordinate to a row by its slope.
    fn steps(&self, row: usize) -> impl Iterator<Item = f64> {
        let pattern = self.system().phi_q();
        pattern.range(row).zip(pattern.row(row)).map(|(position, &(column, _))| {
            let q = self.registers.get(self.program.inputs.coordinates[0] + column);
            (self.phi_q(position) * q).abs()
        })
    }

    /// Returns the formula that must be positive and is not, where time or a position was set.
    pub fn broken_condition(&self) -> Option<usize> {
        // NaN violates the condition too
        self.program.outputs.conditions.iter().position(|&register| {
            let value = self.registers.get(register);
            value.is_nan() || value <= 0.0
        })
    }

    /// Returns, by row, the residual of `Φ_q x = b`.
    pub(super) fn write_open(&self, right: &[Register], x: &[f64], open: &mut [f64]) {
        for (row, open) in open.iter_mut().enumerate() {
            *open = self.left(row, x) - self.registers.get(right[row]);
        }
    }

    /// Returns a row of `Φ_q x`.
    pub(super) fn left(&self, row: usize, x: &[f64]) -> f64 {
        let pattern = self.system().phi_q();
        pattern.range(row).zip(pattern.row(row)).map(|(at, &(column, _))| self.phi_q(at) * x[column as usize]).sum()
    }
}

/// Returns the largest term of a row of a program that has been run.
pub(super) fn largest_term(program: &Program, registers: &Registers, row: usize) -> f64 {
    program.outputs.terms[row].iter().map(|&register| registers.get(register).abs()).fold(0.0, f64::max)
}
