//! Sparse matrices of expressions.

use mechc_expr::ExprId;
use std::ops::Range;

/// A sparse matrix of expressions, row by row.
#[derive(Clone, Debug, Default)]
pub struct SparseRows {
    starts: Vec<usize>,
    entries: Vec<(u32, ExprId)>,
}

impl SparseRows {
    /// Creates a matrix without rows.
    #[must_use]
    pub fn new() -> SparseRows {
        SparseRows { starts: vec![0], entries: Vec::new() }
    }

    /// Appends a row; columns must be in ascending order.
    pub fn push(&mut self, row: impl IntoIterator<Item = (u32, ExprId)>) {
        self.entries.extend(row);
        self.starts.push(self.entries.len());
    }

    /// Returns the entries of a row: column and expression.
    #[must_use]
    pub fn row(&self, row: usize) -> &[(u32, ExprId)] {
        &self.entries[self.range(row)]
    }

    /// Returns the positions of a row's entries in [`SparseRows::entries`].
    #[must_use]
    pub fn range(&self, row: usize) -> Range<usize> {
        self.starts[row]..self.starts[row + 1]
    }

    /// Returns the matrix of some of its rows.
    #[must_use]
    pub fn of_rows(&self, rows: &[usize]) -> SparseRows {
        let mut kept = SparseRows::new();
        for &row in rows {
            kept.push(self.row(row).iter().copied());
        }
        kept
    }

    /// Returns the row that a position in [`SparseRows::entries`] belongs to.
    #[must_use]
    pub fn row_of(&self, position: usize) -> usize {
        self.starts.partition_point(|&start| start <= position) - 1
    }

    /// Returns the number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Returns all entries, row by row.
    #[must_use]
    pub fn entries(&self) -> &[(u32, ExprId)] {
        &self.entries
    }
}
