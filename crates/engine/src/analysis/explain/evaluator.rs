//! Evaluation of `Φ` and `Φ_q` of a system that need not be determined, at any position and time. Explanations use it, since they cannot
//! use the solver.

use super::errors;
use crate::analysis::state::{Evaluated, Linear, aslant, minimize};
use crate::limits::assembly::NUDGE;
use mechc_expr::math;
use mechc_ir::program::{Program, Registers, Stage};
use mechc_ir::{ConstraintSystem, DeclarationId, DeclarationKind, PointId};

/// An equation whose residual over its slope exceeds this, scaled, has a vanishing slope.
const HOPELESS: f64 = 30.0;

/// A system with a program that evaluates it, and a position.
pub struct Evaluator<'s> {
    pub system: &'s ConstraintSystem,
    /// The coordinates [m, rad].
    pub q: Vec<f64>,
    program: Program,
    registers: Registers,
}

impl<'s> Evaluator<'s> {
    /// Returns an evaluator at the estimates.
    pub fn new(system: &'s ConstraintSystem) -> Evaluator<'s> {
        let program = Program::new(system);
        let params = system.param_values();
        let registers = program.start(&params);
        let q = program.outputs.estimates.iter().map(|&register| registers.get(register)).collect();
        Evaluator { system, q, program, registers }
    }

    /// Evaluates some rows by some columns at a time (s); `None` if they are not finite. Without weights rows are scaled to unit norm.
    pub fn linear(&mut self, rows: &[u32], columns: &[u32], weights: Option<&[f64]>, t: f64) -> Option<Linear> {
        self.evaluate(t);
        self.linear_there(rows, columns, weights)
    }

    /// Evaluates everything at a time (s).
    pub fn evaluate(&mut self, t: f64) {
        self.registers.set(self.program.inputs.time, t);
        self.registers.set_all(self.program.inputs.coordinates[0], &self.q);
        self.program.run(Stage::Time, &mut self.registers);
        self.program.run(Stage::Position, &mut self.registers);
    }

    /// Returns some rows by some columns of the last evaluation.
    pub fn linear_there(&self, rows: &[u32], columns: &[u32], weights: Option<&[f64]>) -> Option<Linear> {
        let (registers, outputs) = (&self.registers, &self.program.outputs);
        let phi = |row: usize| registers.get(outputs.phi[row]);
        let phi_q = |position: usize| registers.get(outputs.phi_q[position]);
        Evaluated { system: self.system, phi, phi_q }.linear(rows, columns, weights)
    }

    /// Brings some rows as near to zero as can be by moving some columns, and gives them there with the weights used.
    pub fn assemble(&mut self, rows: &[u32], columns: &[u32], weights: Option<&[f64]>, t: f64) -> Option<Linear> {
        let first = self.linear(rows, columns, None, t)?;
        let vanishes = |line: &[f64]| line.iter().all(|&slope| slope == 0.0);
        if first.residual.iter().any(|open| open.abs() > HOPELESS)
            || first.jacobian.chunks(columns.len().max(1)).any(vanishes)
        {
            // no small motion changes that row there, but near it one does
            self.nudge(columns);
        }
        let mut q = self.q.clone();
        let linear = minimize(self.system, columns, &mut q, weights, |q, weights| {
            self.q.copy_from_slice(q);
            self.linear(rows, columns, weights, t)
        })?;
        self.q = q;
        // the last step may have been taken back
        self.linear(rows, columns, Some(&linear.weights), t)
    }

    /// Moves some columns a little, each by another part of its scale.
    pub fn nudge(&mut self, columns: &[u32]) {
        for &column in columns {
            let column = column as usize;
            self.q[column] += NUDGE * aslant(column) * self.system.coordinates()[column].scale;
        }
    }

    /// Returns an entry of `Φ` where it was evaluated last.
    pub fn phi(&self, row: usize) -> f64 {
        self.registers.get(self.program.outputs.phi[row])
    }

    /// Returns the entries of a row of `Φ_q` where it was evaluated last: column and slope.
    pub fn slopes(&self, row: usize) -> impl Iterator<Item = (usize, f64)> {
        let pattern = self.system.phi_q();
        pattern
            .range(row)
            .zip(pattern.row(row))
            .map(|(position, &(column, _))| (column as usize, self.registers.get(self.program.outputs.phi_q[position])))
    }

    /// Returns the distance that a declaration prescribes between two points, if it does, and that between them (m).
    pub fn distance(&self, declaration: DeclarationId) -> Option<[f64; 2]> {
        let system = self.system;
        let is_distance = match system.declarations()[declaration].kind {
            DeclarationKind::Joint(joint) => joint.holds_distance(),
            _ => true,
        };
        let &[p, q] = system.declarations()[declaration].points.as_slice() else {
            return None;
        };
        let row = (0..system.rows().len()).find(|&row| system.rows()[row].declaration == declaration)?;
        let (from, to) = (self.place_of(p), self.place_of(q));
        let square = (to[0] - from[0]) * (to[0] - from[0]) + (to[1] - from[1]) * (to[1] - from[1]);
        // Φ = dᵀd − L²
        is_distance.then(|| [f64::max(square - self.phi(row), 0.0).sqrt(), square.sqrt()])
    }

    /// Returns how far a body would have to be moved (m) or turned (rad) for a row to hold: moved if the row is about locations.
    pub fn gap(&self, row: usize) -> f64 {
        // a prescribed distance is compared itself, not its square as in Φ
        if let Some([prescribed, found]) = self.distance(self.system.rows()[row].declaration) {
            return (found - prescribed).abs();
        }
        let kind = errors::gap_kind(self.system, row);
        let of_kind = self.slopes(row).filter(|&(column, _)| self.system.coordinates()[column].kind == kind);
        let mut steepest: f64 = 0.0;
        let (mut owner, mut along) = (None, 0.0);
        for (column, slope) in of_kind {
            if owner != Some(self.system.coordinates()[column].owner) {
                (owner, along) = (Some(self.system.coordinates()[column].owner), 0.0);
            }
            along += slope * slope;
            steepest = steepest.max(along);
        }
        self.phi(row).abs() / steepest.sqrt()
    }

    /// Returns the location of a point (m).
    pub fn place_of(&self, point: PointId) -> [f64; 2] {
        let point = &self.system.points()[point];
        let [x, y] = point.at.map(|id| self.system.value_at(id, &[]));
        let Some(body) = point.body else {
            return [x, y];
        };
        let [origin_x, origin_y, phi] = self.system.pose_of(body).map(|k| self.q[k]);
        let (sin, cos) = math::sin_cos(phi);
        [origin_x + x * cos - y * sin, origin_y + x * sin + y * cos]
    }
}
