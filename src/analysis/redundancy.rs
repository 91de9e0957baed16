//! Too many equations: which of them say nothing that the others do not, and which cannot hold beside the others.
//!
//! Works on the part of the system that has more equations than coordinates, which stands for itself. All its equations
//! are assembled together, by least squares; there each one is taken in turn, joints first and drivers last, and left out if
//! it depends on those before it. Whether it is redundant or conflicts with them is seen at nearby times too: two drivers
//! may agree at the start and part at once.

use super::assembly::damped_solution;
use super::errors;
use crate::diag::Diagnostics;
use crate::ir::{Check, ConstraintSystem, CoordinateKind};
use crate::program::{Program, Registers, Stage};
use crate::structure::{self, Determined, Overdetermined, Refused};

/// Equations that are this nearly dependent are so: an assembled position is known to the root of rounding.
const DEPENDENT: f64 = 1e-6;
/// An equation takes part in a dependency if its share is above this.
const TAKES_PART: f64 = 1e-6;
/// What is open by more than this, scaled, does not hold.
const OPEN: f64 = 1e-8;
/// Steps of the least-squares method at most.
const STEPS: usize = 300;
/// Larger parts are not looked at: their equations would be a dense matrix.
const LARGEST: usize = 600;
/// Times at which the equations are looked at beside the first one, as parts of the span.
const NEARBY: [f64; 3] = [1.3e-3, 3.1e-3, 7.7e-3];

/// An equation that depends on others.
#[derive(Clone, Debug)]
pub(super) struct Dependent {
    /// Its row.
    pub row: usize,
    /// The rows it depends on, with their weights in unscaled equations.
    pub on: Vec<(usize, f64)>,
    /// How far it is open at most with the others met (m or rad, by its coordinates), and when (s); none if it holds.
    pub open: Option<(f64, f64)>,
}

/// Shows that a system is determined, where need be without the equations that are redundant.
///
/// # Errors
/// Why it is not: too few equations, too many, or some that conflict. Redundant ones are refused unless they are allowed.
pub fn determine(system: ConstraintSystem, allow_redundant: bool) -> Result<(Determined, Diagnostics), Diagnostics> {
    let refused = match structure::prove(system) {
        Ok(determined) => return Ok((determined, Diagnostics::default())),
        Err(refused) => *refused,
    };
    let Refused { diagnostic, too_many: Some(part) } = refused else {
        return Err(refused.diagnostic.into());
    };
    let Some(dependents) = Part::new(&part).and_then(|mut part| part.examine()) else {
        return Err(diagnostic.into());
    };
    let is_enough = dependents.len() + part.system.coordinates.len() == part.system.rows.len();
    let holds = dependents.iter().all(|dependent| dependent.open.is_none());
    if !(allow_redundant && holds && is_enough) {
        return Err(errors::too_many(&part.system, &dependents));
    }
    let said = errors::left_out(&part.system, &dependents);
    let mut system = part.system;
    leave_out(&mut system, &dependents);
    match structure::prove(system) {
        Ok(determined) => Ok((determined, said)),
        Err(refused) => Err(refused.diagnostic.into()),
    }
}

/// Makes checks of the equations that are left out.
fn leave_out(system: &mut ConstraintSystem, dependents: &[Dependent]) {
    let q: Vec<f64> = system.coordinates.iter().map(|coordinate| system.value_at(coordinate.estimate, &[])).collect();
    let mut rows: Vec<usize> = dependents.iter().map(|dependent| dependent.row).collect();
    rows.sort_unstable();
    let checks = rows
        .iter()
        .map(|&row| {
            let slopes = system
                .phi_q
                .row(row)
                .iter()
                .map(|&(column, slope)| system.value_at(slope, &q) * system.coordinates[column as usize].scale);
            let norm = slopes.filter(|slope| slope.is_finite()).map(|slope| slope * slope).sum::<f64>().sqrt();
            let scale = if norm > 0.0 { norm } else { 1.0 };
            Check { phi: system.rows[row].phi, declaration: system.rows[row].declaration, scale }
        })
        .collect();
    system.leave_out(&rows, checks);
}

/// The equations and coordinates of the part that has too many equations, with what evaluates them.
struct Part<'s> {
    system: &'s ConstraintSystem,
    rows: &'s [u32],
    columns: &'s [u32],
    program: Program,
    registers: Registers,
    q: Vec<f64>,
}

/// Scaled equations at a position: rows of unit norm.
struct Linear {
    residual: Vec<f64>,
    /// Row by row.
    jacobian: Vec<f64>,
    norms: Vec<f64>,
}

impl<'s> Part<'s> {
    fn new(part: &'s Overdetermined) -> Option<Part<'s>> {
        let system = &part.system;
        if part.rows.len() > LARGEST {
            return None;
        }
        let program = Program::new(system);
        let params: Vec<f64> = system.params.iter().map(|param| param.value).collect();
        let registers = program.start(&params);
        let q = program.outputs.estimates.iter().map(|&register| registers.get(register)).collect();
        Some(Part { system, rows: &part.rows, columns: &part.columns, program, registers, q })
    }

    fn linearize(&mut self, chosen: &[usize], t: f64) -> Option<Linear> {
        self.registers.set(self.program.inputs.time, t);
        self.registers.set_all(self.program.inputs.coordinates[0], &self.q);
        self.program.run(Stage::Time, &mut self.registers);
        self.program.run(Stage::Position, &mut self.registers);
        let n = self.columns.len();
        let mut place = vec![usize::MAX; self.q.len()];
        for (k, &column) in self.columns.iter().enumerate() {
            place[column as usize] = k;
        }
        let mut linear = Linear { residual: Vec::new(), jacobian: vec![0.0; chosen.len() * n], norms: Vec::new() };
        for (k, &at) in chosen.iter().enumerate() {
            let row = self.rows[at] as usize;
            let line = &mut linear.jacobian[k * n..(k + 1) * n];
            for (position, &(column, _)) in self.system.phi_q.range(row).zip(self.system.phi_q.row(row)) {
                let value = self.registers.get(self.program.outputs.phi_q[position]);
                line[place[column as usize]] = value * self.system.coordinates[column as usize].scale;
            }
            let norm = line.iter().map(|x| x * x).sum::<f64>().sqrt();
            let norm = if norm > 0.0 { norm } else { 1.0 };
            for x in line {
                *x /= norm;
            }
            linear.residual.push(self.registers.get(self.program.outputs.phi[row]) / norm);
            linear.norms.push(norm);
        }
        let finite = |list: &[f64]| list.iter().all(|x| x.is_finite());
        (finite(&linear.jacobian) && finite(&linear.residual)).then_some(linear)
    }

    /// Brings chosen equations as near to zero as can be (Levenberg–Marquardt).
    fn assemble(&mut self, chosen: &[usize], t: f64) -> Option<Linear> {
        let square = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>();
        let (m, n) = (chosen.len(), self.columns.len());
        let mut linear = self.linearize(chosen, t)?;
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let size = square(&linear.residual);
            if size.sqrt() < 1e-15 || damping > 1e12 {
                break;
            }
            let step = damped_solution(&linear.jacobian, &linear.residual, damping, [m, n]);
            let before = self.q.clone();
            let longest = step.iter().fold(0.0, |l: f64, x| l.max(x.abs()));
            let cut = if longest > 0.3 { 0.3 / longest } else { 1.0 };
            for (&column, step) in self.columns.iter().zip(step) {
                self.q[column as usize] += cut * step * self.system.coordinates[column as usize].scale;
            }
            match self.linearize(chosen, t) {
                Some(next) if square(&next.residual) < size => {
                    linear = next;
                    damping = f64::max(0.3 * damping, 1e-12);
                }
                _ => {
                    self.q = before;
                    damping *= 4.0;
                }
            }
        }
        self.linearize(chosen, t)
    }

    /// The equations that depend on those before them.
    fn examine(&mut self) -> Option<Vec<Dependent>> {
        let all: Vec<usize> = (0..self.rows.len()).collect();
        let (start, span) = self.system.analysis.map_or((0.0, 1.0), |[from, to, _]| (from, to - from));
        let linear = self.assemble(&all, start)?;
        let n = self.columns.len();
        let mut basis: Vec<Vec<f64>> = Vec::new();
        // each kept row by the basis vectors up to its own
        let (mut kept, mut factors): (Vec<usize>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
        let mut dependents = Vec::new();
        for at in all {
            let line = &linear.jacobian[at * n..(at + 1) * n];
            let (rest, shares) = orthogonal(line, &basis);
            let norm = rest.iter().map(|x| x * x).sum::<f64>().sqrt();
            if norm > DEPENDENT && basis.len() < n {
                basis.push(rest.iter().map(|x| x / norm).collect());
                factors.push([shares, vec![norm]].concat());
                kept.push(at);
                continue;
            }
            let weights = back_substituted(&factors, shares);
            let on = kept.iter().zip(weights).filter(|(_, weight)| weight.abs() > TAKES_PART);
            let on = on.map(|(&k, weight)| (self.rows[k] as usize, weight * linear.norms[at] / linear.norms[k]));
            dependents.push((at, Dependent { row: self.rows[at] as usize, on: on.collect(), open: None }));
        }
        for t in std::iter::once(start).chain(NEARBY.map(|part| start + part * span)) {
            self.assemble(&kept, t)?;
            for (at, dependent) in &mut dependents {
                let linear = self.linearize(&[*at], t)?;
                let open = linear.residual[0].abs();
                if open > OPEN {
                    let by = self.gap(dependent.row);
                    if dependent.open.is_none_or(|(known, _)| by > known) {
                        dependent.open = Some((by, t));
                    }
                }
            }
        }
        Some(dependents.into_iter().map(|(_, dependent)| dependent).collect())
    }

    /// How far a row is open: in metres if it is about places, else in radians.
    fn gap(&self, row: usize) -> f64 {
        let kind = self.gap_kind(row);
        let slopes = self.system.phi_q.range(row).zip(self.system.phi_q.row(row));
        let square: f64 = slopes
            .filter(|(_, (column, _))| self.system.coordinates[*column as usize].kind == kind)
            .map(|(position, _)| self.registers.get(self.program.outputs.phi_q[position]))
            .map(|slope| slope * slope)
            .sum();
        self.registers.get(self.program.outputs.phi[row]).abs() / square.sqrt()
    }

    fn gap_kind(&self, row: usize) -> CoordinateKind {
        errors::gap_kind(self.system, row)
    }
}

/// What is left of a vector beside a basis, and its shares along it; twice, so that rounding does not add up.
fn orthogonal(line: &[f64], basis: &[Vec<f64>]) -> (Vec<f64>, Vec<f64>) {
    let (mut rest, mut shares) = (line.to_vec(), vec![0.0; basis.len()]);
    for _ in 0..2 {
        for (share, vector) in shares.iter_mut().zip(basis) {
            let along: f64 = rest.iter().zip(vector).map(|(a, b)| a * b).sum();
            for (x, v) in rest.iter_mut().zip(vector) {
                *x -= along * v;
            }
            *share += along;
        }
    }
    (rest, shares)
}

/// The weights of the kept rows from shares along the basis.
fn back_substituted(factors: &[Vec<f64>], mut shares: Vec<f64>) -> Vec<f64> {
    for k in (0..shares.len()).rev() {
        shares[k] /= factors[k][k];
        for j in 0..k {
            shares[j] -= factors[k][j] * shares[k];
        }
    }
    shares
}
