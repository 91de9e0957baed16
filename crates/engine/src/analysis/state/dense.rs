//! LU of a small dense matrix, where the fixed order of a block would lose digits. The factors are kept in place, for any number of
//! right sides and for the transposed matrix (`crates/runtime/src/blocks.rs` keeps none).

use crate::limits::solver::LEAST_PIVOT;

/// Factors a matrix in place by LU with partial pivoting, row by row; returns the smallest pivot.
pub fn factor_dense(a: &mut [f64], pivots: &mut [u32], n: usize) -> f64 {
    let mut smallest = f64::INFINITY;
    for k in 0..n {
        let mut best = k;
        for i in k + 1..n {
            if a[i * n + k].abs() > a[best * n + k].abs() {
                best = i;
            }
        }
        pivots[k] = best as u32;
        if best != k {
            let (upper, lower) = a.split_at_mut(best * n);
            upper[k * n..k * n + n].swap_with_slice(&mut lower[..n]);
        }
        let (upper, lower) = a.split_at_mut((k + 1) * n);
        let pivot_row = &mut upper[k * n..];
        let pivot = pivot_row[k];
        // a pivot that is not a number must win
        smallest = if pivot.abs() >= smallest { smallest } else { pivot.abs() };
        if pivot.abs() < LEAST_PIVOT {
            pivot_row[k] = LEAST_PIVOT.copysign(pivot);
        }
        let pivot = pivot_row[k];
        for row in lower.chunks_exact_mut(n) {
            let factor = row[k] / pivot;
            row[k] = factor;
            if factor != 0.0 {
                for (x, p) in row[k + 1..].iter_mut().zip(&pivot_row[k + 1..]) {
                    *x -= factor * p;
                }
            }
        }
    }
    smallest
}

/// Solves `A x = b` with the factors and pivots of [`factor_dense`]; `b` becomes `x`.
pub fn solve_dense(a: &[f64], pivots: &[u32], b: &mut [f64]) {
    let n = b.len();
    for (k, &pivot) in pivots.iter().enumerate() {
        b.swap(k, pivot as usize);
    }
    for i in 0..n {
        let mut sum = b[i];
        for k in 0..i {
            sum -= a[i * n + k] * b[k];
        }
        b[i] = sum;
    }
    for i in (0..n).rev() {
        let mut sum = b[i];
        for k in i + 1..n {
            sum -= a[i * n + k] * b[k];
        }
        b[i] = sum / a[i * n + i];
    }
}

/// Solves like [`solve_dense`], for the transposed matrix.
pub fn solve_dense_transposed(a: &[f64], pivots: &[u32], b: &mut [f64]) {
    let n = b.len();
    for i in 0..n {
        let mut sum = b[i];
        for k in 0..i {
            sum -= a[k * n + i] * b[k];
        }
        b[i] = sum / a[i * n + i];
    }
    for i in (0..n).rev() {
        let mut sum = b[i];
        for k in i + 1..n {
            sum -= a[k * n + i] * b[k];
        }
        b[i] = sum;
    }
    for k in (0..n).rev() {
        b.swap(k, pivots[k] as usize);
    }
}
