//! Too many equations: which of them say nothing that the others do not, and which cannot hold beside the others.
//!
//! All equations of a part are assembled together, by least squares; there each one is taken in turn, joints first and
//! drivers last, and depends on those before it or not. Whether one that does is redundant or conflicts with them is seen at
//! nearby times too: two drivers may agree at the start and part at once.

use super::evaluator::Evaluator;
use crate::structure::Part;

/// Equations that are this nearly dependent are so: an assembled position is known to the root of rounding.
const DEPENDENT: f64 = 1e-6;
/// An equation takes part in a dependency if its share is above this.
const TAKES_PART: f64 = 1e-6;
/// What is open by more than this, scaled, does not hold.
const OPEN: f64 = 1e-8;
/// Times at which the equations are looked at beside the first one, as parts of the span.
const NEARBY: [f64; 3] = [1.3e-3, 3.1e-3, 7.7e-3];

/// An equation that depends on others.
#[derive(Clone, Debug)]
pub(super) struct Dependent {
    /// Its row.
    pub row: usize,
    /// The rows it depends on.
    pub on: Vec<usize>,
    /// How far it is open with the others met (m or rad, by its coordinates), and when first (s); none if it holds.
    pub open: Option<(f64, f64)>,
}

/// The equations of a part that depend on those before them, from the start at `t` on over a span of time (s); none where
/// they have no values.
pub(super) fn dependents(evaluator: &mut Evaluator<'_>, part: &Part, [t, span]: [f64; 2]) -> Option<Vec<Dependent>> {
    evaluator.assemble(&part.rows, &part.columns, None, t)?;
    let jacobian = evaluator.linear(&part.rows, &part.columns, None, t)?.jacobian;
    let basis = Basis::of(&jacobian, part.columns.len());
    let row = |k: usize| part.rows[k] as usize;
    let mut dependents: Vec<Dependent> = basis
        .dependent
        .iter()
        .map(|(k, on)| Dependent { row: row(*k), on: on.iter().map(|&k| row(k)).collect(), open: None })
        .collect();
    let kept: Vec<u32> = basis.kept.iter().map(|&k| part.rows[k]).collect();
    for t in std::iter::once(t).chain(NEARBY.map(|part| t + part * span)) {
        evaluator.assemble(&kept, &part.columns, None, t)?;
        for dependent in &mut dependents {
            let open = evaluator.linear(&[dependent.row as u32], &part.columns, None, t)?.residual[0].abs();
            if open > OPEN && dependent.open.is_none() {
                dependent.open = Some((evaluator.gap(dependent.row), t));
            }
        }
    }
    if dependents.iter().any(|dependent| dependent.open.is_some()) {
        add_hidden(evaluator, part, t, &mut dependents);
    }
    Some(dependents)
}

/// What conflicts may do so with equations that have no part in it where they are looked at: a driven crank that is just in
/// line has none in the place of its tip. Beside that position they have.
fn add_hidden(evaluator: &mut Evaluator<'_>, part: &Part, t: f64, dependents: &mut [Dependent]) {
    evaluator.nudge(&part.columns);
    let Some(linear) = evaluator.linear(&part.rows, &part.columns, None, t) else {
        return;
    };
    let beside = Basis::of(&linear.jacobian, part.columns.len()).dependent;
    for dependent in dependents.iter_mut().filter(|dependent| dependent.open.is_some()) {
        let found = beside.iter().find(|(k, _)| part.rows[*k] as usize == dependent.row);
        let on = found.into_iter().flat_map(|(_, on)| on).map(|&k| part.rows[k] as usize);
        dependent.on.extend(on);
        dependent.on.sort_unstable();
        dependent.on.dedup();
    }
}

/// Vectors as far as they are independent of those before them.
pub(super) struct Basis {
    /// Orthonormal.
    pub vectors: Vec<Vec<f64>>,
    /// Which of the vectors given are independent.
    pub kept: Vec<usize>,
    /// The others, and which of the kept ones each depends on.
    dependent: Vec<(usize, Vec<usize>)>,
}

impl Basis {
    /// Of vectors of length `n`, each of about unit norm, one after another.
    pub fn of(vectors: &[f64], n: usize) -> Basis {
        let mut basis = Basis { vectors: Vec::new(), kept: Vec::new(), dependent: Vec::new() };
        // each kept vector by the basis vectors up to its own
        let mut factors: Vec<Vec<f64>> = Vec::new();
        for (k, vector) in vectors.chunks_exact(n.max(1)).enumerate() {
            let (rest, shares) = orthogonal(vector, &basis.vectors);
            let norm = rest.iter().map(|x| x * x).sum::<f64>().sqrt();
            if norm > DEPENDENT && basis.vectors.len() < n {
                basis.vectors.push(rest.iter().map(|x| x / norm).collect());
                factors.push([shares, vec![norm]].concat());
                basis.kept.push(k);
                continue;
            }
            let weights = back_substituted(&factors, shares);
            let on = basis.kept.iter().zip(weights).filter(|(_, weight)| weight.abs() > TAKES_PART);
            basis.dependent.push((k, on.map(|(&k, _)| k).collect()));
        }
        basis
    }
}

/// What is left of a vector beside a basis, and its shares along it; twice, so that rounding does not add up.
pub(super) fn orthogonal(vector: &[f64], basis: &[Vec<f64>]) -> (Vec<f64>, Vec<f64>) {
    let (mut rest, mut shares) = (vector.to_vec(), vec![0.0; basis.len()]);
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

/// The weights of the kept vectors from shares along the basis.
fn back_substituted(factors: &[Vec<f64>], mut shares: Vec<f64>) -> Vec<f64> {
    for k in (0..shares.len()).rev() {
        shares[k] /= factors[k][k];
        for j in 0..k {
            shares[j] -= factors[k][j] * shares[k];
        }
    }
    shares
}
