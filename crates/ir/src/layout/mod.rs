//! What the columns of a row hold, in which order, by which names, in which units.
//!
//! Here alone stands the order: of the table that is printed, and behind it of what a row holds for the solver. Whoever looks for a column
//! asks a [`RowLayout`] for its place; whoever shows columns takes them as [`columns`]. The first columns are time and the coordinates.

mod columns;
mod rows;

pub use columns::{Column, ColumnKind, ColumnUnit, columns, results};
pub use rows::{Holds, RowLayout, holds, row_holds};
