//! Orthonormal vectors, which show which equations depend on others and which motions are free.
//!
//! Vectors and matrices are those of nalgebra, of which only column-wise operations are used: these have one order of operations on every
//! processor, and no printed number depends on them.

use nalgebra::{DMatrix, DMatrixView, DVector};

/// Some orthonormal vectors of a space.
#[derive(Clone, Debug)]
pub struct Orthonormal {
    /// The vectors, and room for as many as the space has dimensions.
    columns: DMatrix<f64>,
    count: usize,
}

impl Orthonormal {
    /// Returns an empty set of vectors of a space of `n` dimensions.
    pub fn of_dimension(n: usize) -> Orthonormal {
        Orthonormal { columns: DMatrix::zeros(n, n), count: 0 }
    }

    /// Returns whether the vectors span the whole space.
    pub fn is_whole(&self) -> bool {
        self.count == self.columns.ncols()
    }

    fn vectors(&self) -> DMatrixView<'_, f64> {
        self.columns.columns(0, self.count)
    }

    /// Splits a vector into its rest, orthogonal to all, and its shares along them; projects twice, so that rounding does not add up.
    pub fn split(&self, vector: DVector<f64>) -> (DVector<f64>, DVector<f64>) {
        let (vectors, mut rest) = (self.vectors(), vector);
        let mut shares = DVector::zeros(self.count);
        for _ in 0..2 {
            let along = vectors.tr_mul(&rest);
            rest.gemv(-1.0, &vectors, &along, 1.0);
            shares += along;
        }
        (rest, shares)
    }

    /// Adds the normalized rest of a vector if it is longer than a limit and there is room; returns whether it did.
    pub fn take(&mut self, rest: &DVector<f64>, least: f64) -> bool {
        let norm = rest.norm();
        let is_taken = norm > least && !self.is_whole();
        if is_taken {
            self.columns.set_column(self.count, &(rest / norm));
            self.count += 1;
        }
        is_taken
    }

    /// Returns the vector that was taken in last.
    pub fn last(&self) -> Option<DVector<f64>> {
        self.vectors().column_iter().next_back().map(nalgebra::Matrix::into_owned)
    }

    /// Returns the share of each axis that is orthogonal to all vectors.
    pub fn shares_left(&self) -> DVector<f64> {
        DVector::from_iterator(self.columns.nrows(), self.vectors().row_iter().map(|row| 1.0 - row.norm_squared()))
    }
}

/// A maximal independent subset of some vectors, and how the others depend on it.
#[derive(Clone)]
pub struct Basis {
    /// The span of the kept vectors.
    pub span: Orthonormal,
    /// Numbers of the independent vectors.
    pub kept: Vec<usize>,
    /// Number of each other vector, with the kept ones that it depends on and their weights.
    pub dependent: Vec<(usize, Vec<(usize, f64)>)>,
}

impl Basis {
    /// Takes vectors of length `n`, each of about unit norm, in order. A vector is dependent if its rest orthogonal to those before it is
    /// shorter than `nothing`; it depends on those that have a larger weight in it.
    pub fn new(vectors: &[f64], n: usize, nothing: f64) -> Basis {
        let mut basis = Basis { span: Orthonormal::of_dimension(n), kept: Vec::new(), dependent: Vec::new() };
        // each kept vector by the span up to its own
        let mut factors = DMatrix::zeros(n, n);
        for (k, vector) in vectors.chunks_exact(n.max(1)).enumerate() {
            let (rest, shares) = basis.span.split(DVector::from_column_slice(vector));
            let rank = basis.kept.len();
            if basis.span.take(&rest, nothing) {
                factors.view_mut((0, rank), (rank, 1)).copy_from(&shares);
                factors[(rank, rank)] = rest.norm();
                basis.kept.push(k);
                continue;
            }
            let weights = factors.view((0, 0), (rank, rank)).solve_upper_triangular(&shares).unwrap_or(shares);
            let on = basis.kept.iter().zip(&weights).filter(|(_, weight)| weight.abs() > nothing);
            basis.dependent.push((k, on.map(|(&k, &weight)| (k, weight)).collect()));
        }
        basis
    }

    /// Keeps a dependent vector, by its index in `dependent`, in place of a kept one on which it depends. Weights up to `weighs` are dropped.
    pub fn exchange(&mut self, index: usize, kept: usize, weighs: f64) {
        let (vector, on) = self.dependent[index].clone();
        let Some(&(_, pivot)) = on.iter().find(|(k, _)| *k == kept) else {
            return;
        };
        // vector = pivot · kept + the others
        let mut replaced: Vec<(usize, f64)> =
            on.iter().filter(|(k, _)| *k != kept).map(|&(k, weight)| (k, -weight / pivot)).collect();
        replaced.push((vector, 1.0 / pivot));
        for (_, other) in &mut self.dependent {
            let Some(place) = other.iter().position(|(k, _)| *k == kept) else {
                continue;
            };
            let (_, share) = other.remove(place);
            for &(k, weight) in &replaced {
                match other.iter_mut().find(|(index, _)| *index == k) {
                    Some((_, sum)) => *sum += share * weight,
                    None => other.push((k, share * weight)),
                }
            }
            other.retain(|(_, weight)| weight.abs() > weighs);
            other.sort_unstable_by_key(|&(k, _)| k);
        }
        replaced.retain(|(_, weight)| weight.abs() > weighs);
        replaced.sort_unstable_by_key(|&(k, _)| k);
        self.dependent[index] = (kept, replaced);
        self.kept.iter_mut().filter(|k| **k == kept).for_each(|k| *k = vector);
        self.kept.sort_unstable();
    }
}

#[cfg(test)]
mod tests {
    use super::{Basis, Orthonormal};
    use nalgebra::DVector;

    #[test]
    fn dependent_vectors_name_what_they_depend_on() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let rows = [
            [1.0, 0.0, 0.0, 0.0],
            [half, half, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, -1.0, 0.0],
        ];
        let basis = Basis::new(rows.as_flattened(), 4, 1e-6);
        assert_eq!(basis.kept, [0, 1, 2]);
        let on = |k: usize| basis.dependent[k].1.iter().map(|&(k, _)| k).collect::<Vec<usize>>();
        assert_eq!([(basis.dependent[0].0, on(0)), (basis.dependent[1].0, on(1))], [(3, vec![0, 1]), (4, vec![2])]);
        // (0, 1, 0, 0) = (1/half) (half, half, 0, 0) − (1, 0, 0, 0)
        let weights: Vec<f64> = basis.dependent[0].1.iter().map(|&(_, weight)| weight).collect();
        assert!((weights[0] + 1.0).abs() < 1e-15 && (weights[1] * half - 1.0).abs() < 1e-15);
        let left = basis.span.shares_left();
        assert!((left - DVector::from_column_slice(&[0.0, 0.0, 0.0, 1.0])).norm() < 1e-15);
    }

    #[test]
    fn a_dependent_vector_takes_the_place_of_one_that_it_depends_on() {
        let rows = [[1.0, 0.0], [0.8, 0.6], [0.6, 0.8], [0.0, 1.0]];
        let mut basis = Basis::new(rows.as_flattened(), 2, 1e-6);
        assert_eq!(basis.kept, [0, 1]);
        basis.exchange(1, 0, 1e-6);
        assert_eq!(basis.kept, [1, 3]);
        for (k, on) in &basis.dependent {
            for (axis, expected) in rows[*k].iter().enumerate() {
                let sum: f64 = on.iter().map(|&(index, weight)| weight * rows[index][axis]).sum();
                assert!((sum - expected).abs() < 1e-12, "{k} {on:?}");
            }
        }
    }

    #[test]
    fn the_rest_of_a_vector_is_orthogonal_to_all_others() {
        let mut all = Orthonormal::of_dimension(3);
        let first = DVector::from_column_slice(&[0.6, 0.8, 0.0]);
        assert!(all.take(&first, 0.0));
        let (rest, shares) = all.split(DVector::from_column_slice(&[1.0, 1.0, 1.0]));
        assert!(rest.dot(&first).abs() < 1e-15 && (shares[0] - 1.4).abs() < 1e-15);
        assert!(all.take(&rest, 1e-6) && all.count == 2 && !all.is_whole());
        // a vector in the span of the others adds nothing
        let (rest, _) = all.split(&first + all.last().expect("a vector"));
        assert!(!all.take(&rest, 1e-6));
    }

    #[test]
    fn without_coordinates_no_vector_is_kept() {
        let basis = Basis::new(&[], 0, 1e-6);
        assert!(basis.kept.is_empty() && basis.dependent.is_empty() && basis.span.is_whole());
    }
}
