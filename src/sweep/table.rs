//! The rows of variants that go side by side, column by column.

use super::each::LANES;
use super::numbers::Numbers;
use super::together::{Rows, Together};
use crate::math::{Vectors, WIDE};
use crate::program::LaneValues;
use crate::solver::Abreast;

/// Rows that are put into columns together: a line of the processor's memory for each column of each variant.
const TILE: usize = WIDE;

/// Rows that are wanted, and what solves for them.
pub(super) struct Table {
    pub abreast: Abreast<LANES>,
    vectors: Vectors,
}

/// Where rows of variants go, which stand one behind the other at the end of columns.
pub struct Room<'c> {
    /// The columns that are wanted.
    pub columns: &'c mut [Numbers],
    /// How many numbers they hold before.
    pub before: usize,
    /// How many rows each has.
    pub rows: usize,
}

impl Table {
    /// For rows that are wanted.
    pub fn new(together: &Together, of: &Rows) -> Table {
        // of what steps alone are judged by the last row is enough
        let rows = |column| if of.wanted.contains(&column) { TILE as u32 } else { 1 };
        Table { abreast: together.abreast(&of.solver, rows), vectors: together.vectors }
    }

    /// Goes to the row of an output time, by its number.
    pub fn turn_to(&mut self, number: u64) {
        self.abreast.turn_to(number as usize % TILE);
    }

    /// Puts the last rows into columns, once there are enough of them: up to that of an output time, by its number.
    pub fn put(&self, of: &Rows, number: u64, room: &mut Room<'_>) {
        let (last, count) = (number as usize, number as usize % TILE + 1);
        if count < TILE && last + 1 < room.rows {
            return;
        }
        let first = last + 1 - count;
        for (to, &column) in room.columns.iter_mut().zip(&of.wanted) {
            let to = &mut to[room.before..];
            if column == 0 {
                for to in to.chunks_exact_mut(room.rows) {
                    (first..=last).for_each(|row| to[row] = of.times.at(row as u64));
                }
                continue;
            }
            let from = &self.abreast.rows(column)[..count];
            if let Ok(tile) = <&[LaneValues<LANES>; TILE]>::try_from(from) {
                self.vectors.turn(tile.each_ref().map(|row| &row.0), to, (first, room.rows));
            } else {
                for (lane, to) in to.chunks_exact_mut(room.rows).enumerate() {
                    to[first..].iter_mut().zip(from).for_each(|(to, row)| *to = row.0[lane]);
                }
            }
        }
    }
}
