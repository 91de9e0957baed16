//! The rows of variants that go side by side, column by column.

use super::each::LANES;
use super::numbers::Numbers;
use super::together::{Rows, Together};
use crate::math::{Vectors, WIDE};
use crate::solver::Abreast;

/// Rows that are put into columns together: two lines of the processor's memory, which it fetches as a pair, for each column of each variant.
const TILE: usize = 2 * WIDE;

/// Rows that are wanted, and what solves for them.
pub(super) struct Table {
    pub abreast: Abreast<LANES>,
    /// Columns that are wanted, by their places in a room: those with one number in all rows of a variant, and the others.
    fixed: Vec<(usize, u32)>,
    varying: Vec<(usize, u32)>,
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
        let is_fixed = of.solver.is_fixed();
        let (fixed, varying): (Vec<_>, Vec<_>) =
            of.wanted.iter().copied().enumerate().partition(|&(_, column)| is_fixed(column));
        // of what steps alone are judged by the last row is enough, and one of what all rows have
        let rows = |column| if varying.iter().any(|&(_, wanted)| wanted == column) { TILE as u32 } else { 1 };
        Table { abreast: together.abreast(&of.solver, rows), fixed, varying, vectors: together.vectors }
    }

    /// Goes to the row of an output time, by its number.
    pub fn turn_to(&mut self, number: u64) {
        self.abreast.turn_to(number as usize % TILE);
    }

    /// Puts what all rows have into columns, of variants that are loaded.
    pub fn put_fixed(&self, room: &mut Room<'_>) {
        for &(place, column) in &self.fixed {
            let (to, values) = (&mut room.columns[place], &self.abreast.column(column).0);
            if values.iter().all(|value| value.to_bits() == values[0].to_bits()) {
                to.fill_from(room.before, values[0]);
            } else {
                let stretches = to[room.before..].chunks_exact_mut(room.rows);
                stretches.zip(values).for_each(|(to, value)| to.fill(*value));
            }
        }
    }

    /// Puts the last rows into columns, once there are enough of them: up to that of an output time, by its number.
    pub fn put(&self, of: &Rows, number: u64, room: &mut Room<'_>) {
        let (last, count) = (number as usize, number as usize % TILE + 1);
        if count < TILE && last + 1 < room.rows {
            return;
        }
        let first = last + 1 - count;
        for &(place, column) in &self.varying {
            let to = &mut room.columns[place][room.before..];
            if column == 0 {
                for to in to.chunks_exact_mut(room.rows) {
                    (first..=last).for_each(|row| to[row] = of.times.at(row as u64));
                }
                continue;
            }
            let (lines, rest) = self.abreast.rows(column)[..count].as_chunks::<WIDE>();
            for (line, tile) in lines.iter().enumerate() {
                self.vectors.turn(tile.each_ref().map(|row| &row.0), to, (first + line * WIDE, room.rows));
            }
            // only behind the last whole line
            if !rest.is_empty() {
                let behind = first + lines.len() * WIDE;
                for (lane, to) in to.chunks_exact_mut(room.rows).enumerate() {
                    to[behind..].iter_mut().zip(rest).for_each(|(to, row)| *to = row.0[lane]);
                }
            }
        }
    }
}
