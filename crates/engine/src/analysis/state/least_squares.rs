//! Least squares: brings equations as near to zero as possible; they may be more or fewer than their unknowns, or contradict each other (K.
//! Levenberg, 1944; D. Marquardt, 1963). Dense: for parts of a mechanism, and never in the time loop.

use crate::limits::assembly::{LARGEST_STEP, MOST_STEPS};
use mechc_expr::math;
use mechc_ir::ConstraintSystem;

/// Initial damping.
const DAMPING: f64 = 1e-3;
/// Largest damping; beyond it no step helps.
const MOST_DAMPING: f64 = 1e12;
/// Smallest damping.
const LEAST_DAMPING: f64 = 1e-12;
/// Equations with smaller residuals, scaled, are satisfied.
const CLOSED: f64 = 1e-15;
/// The iteration ends when a step reduces the residual by less than this part.
const LEAST_GAIN: f64 = 1e-10;

/// Some equations by some coordinates at a position, both scaled.
#[derive(Clone, Debug)]
pub struct Linear {
    /// Residual of each equation.
    pub residual: Vec<f64>,
    /// Equation by equation.
    pub jacobian: Vec<f64>,
    /// Divisor of each equation.
    pub weights: Vec<f64>,
}

/// Evaluators of `Φ` and `Φ_q`.
pub struct Evaluated<'s, P, J> {
    pub system: &'s ConstraintSystem,
    /// An entry of `Φ` by its row.
    pub phi: P,
    /// An entry of `Φ_q` by its position in the pattern.
    pub phi_q: J,
}

impl<P: Fn(usize) -> f64, J: Fn(usize) -> f64> Evaluated<'_, P, J> {
    /// Returns some rows by some columns; `None` if they are not finite. Without weights the rows' norms become the weights.
    pub fn linear(&self, rows: &[u32], columns: &[u32], weights: Option<&[f64]>) -> Option<Linear> {
        let system = self.system;
        let n = columns.len();
        let mut place = vec![usize::MAX; system.coordinates().len()];
        for (k, &column) in columns.iter().enumerate() {
            place[column as usize] = k;
        }
        let mut linear = Linear {
            residual: Vec::with_capacity(rows.len()),
            jacobian: vec![0.0; rows.len() * n],
            weights: Vec::with_capacity(rows.len()),
        };
        for (k, &row) in rows.iter().enumerate() {
            let row = row as usize;
            let line = &mut linear.jacobian[k * n..(k + 1) * n];
            for (position, &(column, _)) in system.phi_q().range(row).zip(system.phi_q().row(row)) {
                if let Some(entry) = line.get_mut(place[column as usize]) {
                    *entry = (self.phi_q)(position) * system.coordinates()[column as usize].scale;
                }
            }
            let norm = square(line).sqrt();
            let weight = weights.map_or(if norm > 0.0 { norm } else { 1.0 }, |weights| weights[k]);
            for x in line {
                *x /= weight;
            }
            linear.residual.push((self.phi)(row) / weight);
            linear.weights.push(weight);
        }
        let finite = |list: &[f64]| list.iter().all(|x| x.is_finite());
        (finite(&linear.jacobian) && finite(&linear.residual)).then_some(linear)
    }
}

/// Moves some coordinates of `q` to where the equations are nearest to zero, and returns the equations there; `linear` evaluates them with
/// given weights. `None` if they are not finite at the beginning.
pub fn minimize(
    system: &ConstraintSystem,
    columns: &[u32],
    q: &mut [f64],
    weights: Option<&[f64]>,
    mut linear: impl FnMut(&[f64], Option<&[f64]>) -> Option<Linear>,
) -> Option<Linear> {
    let mut now = linear(q, weights)?;
    let weights = now.weights.clone();
    let mut damping = DAMPING;
    for _ in 0..MOST_STEPS {
        let size = square(&now.residual);
        if size.sqrt() < CLOSED {
            break;
        }
        let step = damped_solution(&now.jacobian, &now.residual, damping, columns.len());
        let before = q.to_vec();
        let longest = step.iter().fold(0.0, |l: f64, x| l.max(x.abs()));
        let cut = if longest > LARGEST_STEP { LARGEST_STEP / longest } else { 1.0 };
        for (&column, step) in columns.iter().zip(step) {
            q[column as usize] += cut * step * system.coordinates()[column as usize].scale;
        }
        match linear(q, Some(&weights)) {
            Some(next) if square(&next.residual) < size => {
                let gain = 1.0 - square(&next.residual) / size;
                now = next;
                damping = f64::max(0.3 * damping, LEAST_DAMPING);
                if gain < LEAST_GAIN {
                    break;
                }
            }
            _ => {
                q.copy_from_slice(&before);
                damping *= 4.0;
                if damping > MOST_DAMPING {
                    break;
                }
            }
        }
    }
    Some(now)
}

pub fn square(v: &[f64]) -> f64 {
    v.iter().map(|x| x * x).sum()
}

/// Returns the x of least |J x + r|² + λ|x|²: the rows of J are rotated one by one into √λ I, of which each row is held up to its
/// last entry, so that what is sparse costs little (J. A. George, M. T. Heath, 1980).
fn damped_solution(jacobian: &[f64], residual: &[f64], damping: f64, n: usize) -> Vec<f64> {
    let mut triangle = vec![0.0; n * n];
    let mut ends: Vec<usize> = (1..=n).collect();
    for k in 0..n {
        triangle[k * n + k] = damping.sqrt();
    }
    let mut x = vec![0.0; n];
    // equations of no coordinate at all have no lines
    for (line, open) in jacobian.chunks_exact(n.max(1)).zip(residual) {
        let (mut line, mut right) = (line.to_vec(), -open);
        let Some(last) = line.iter().rposition(|&entry| entry != 0.0) else {
            continue;
        };
        let mut end = last + 1;
        for k in 0..n {
            if k >= end {
                break;
            }
            if line[k] == 0.0 {
                continue;
            }
            end = usize::max(end, ends[k]);
            ends[k] = end;
            let row = &mut triangle[k * n..(k + 1) * n];
            let norm = math::hypot(row[k], line[k]);
            let (cos, sin) = (row[k] / norm, line[k] / norm);
            let rotate = |a: &mut f64, b: &mut f64| (*a, *b) = (cos * *a + sin * *b, cos * *b - sin * *a);
            for (a, b) in row[k..end].iter_mut().zip(&mut line[k..end]) {
                rotate(a, b);
            }
            rotate(&mut x[k], &mut right);
        }
    }
    for k in (0..n).rev() {
        let row = &triangle[k * n..(k + 1) * n];
        let resolved: f64 = (k + 1..ends[k]).map(|j| row[j] * x[j]).sum();
        x[k] = (x[k] - resolved) / row[k];
    }
    x
}
