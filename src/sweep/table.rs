//! The rows of variants that go side by side, column by column.

use super::each::{Each, LANES, ZERO};
use super::together::{Rows, Together};
use crate::program::LaneValues;
use crate::solver::Abreast;

/// Rows that are put into columns together: as many as are a line of memory.
const TILE: usize = 8;

/// Rows, and what solves for them.
pub(super) struct Table {
    pub abreast: Abreast<LANES>,
    /// By wanted column: the last rows.
    tile: Vec<[Each; TILE]>,
    /// By wanted column, by variant: row after row.
    values: Vec<f64>,
    /// How many rows each variant has.
    pub rows: usize,
}

impl Table {
    /// For rows that are wanted.
    pub fn new(together: &Together, of: &Rows) -> Table {
        let (columns, rows) = (of.wanted.len(), of.times.len() as usize);
        let abreast = together.abreast(&of.solver);
        Table { abreast, tile: vec![[ZERO; TILE]; columns], values: vec![0.0; columns * LANES * rows], rows }
    }

    /// The rows of some variants, which stand next to each other, in a wanted column, by its place among these.
    pub fn column(&self, place: usize, variants: std::ops::Range<usize>) -> &[f64] {
        &self.values[(place * LANES + variants.start) * self.rows..(place * LANES + variants.end) * self.rows]
    }

    /// Takes the rows of an output time, by its number.
    pub fn take(&mut self, of: &Rows, number: u64) {
        let Table { abreast, tile, values, rows } = self;
        let at = number as usize % TILE;
        for (tile, &column) in tile.iter_mut().zip(&of.wanted) {
            tile[at] = if column == 0 { LaneValues([of.times.at(number); LANES]) } else { *abreast.column(column) };
        }
        if at + 1 == TILE || number as usize + 1 == *rows {
            let first = number as usize - at;
            for (columns, tile) in values.chunks_exact_mut(LANES * *rows).zip(tile) {
                for (lane, column) in columns.chunks_exact_mut(*rows).enumerate() {
                    for (value, each) in column[first..=first + at].iter_mut().zip(tile.iter()) {
                        *value = each.0[lane];
                    }
                }
            }
        }
    }
}
