//! Layout of a row: contents, order, names and units of its columns.
//!
//! This module alone defines the order of the printed table, and of the values that a row holds for the solver after it. [`RowLayout`]
//! gives the positions of columns, [`columns`] the columns for display. The first columns are time and the coordinates.

mod columns;
mod rows;

pub use columns::{Column, ColumnKind, ColumnUnit, columns, results};
pub use rows::{ColumnContent, RowLayout, holds, row_contents};
