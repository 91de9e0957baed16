//! The rows of variants that go side by side, column by column.

use super::each::{LANES, PART};
use super::together::{Rows, Together};
use crate::math::Vectors;
use crate::program::LaneValues;
use crate::solver::Abreast;
use std::array::from_fn;

/// Rows that are put into columns together: as many as are a line of memory, and as many as lanes are a part.
const TILE: usize = PART;

/// Rows that are wanted, and what solves for them.
pub(super) struct Table {
    pub abreast: Abreast<LANES>,
    vectors: Vectors,
}

/// Where rows of variants go, which stand one behind the other at the end of columns.
pub struct Room<'c> {
    /// The columns that are wanted.
    pub columns: &'c mut [Vec<f64>],
    /// How many numbers they hold before.
    pub before: usize,
    /// How many rows each has.
    pub rows: usize,
}

impl Table {
    /// For rows that are wanted.
    pub fn new(together: &Together, of: &Rows) -> Table {
        Table { abreast: together.abreast(&of.solver, TILE), vectors: together.vectors }
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
            self.vectors.run(
                #[inline(always)]
                || put_column(from, to, (first, room.rows)),
            );
        }
    }
}

/// Puts rows of a column where they belong of each variant, from one of them on.
#[inline(always)]
#[allow(clippy::inline_always, clippy::needless_range_loop)] // it is compiled for several kinds of processors, and vectorises best so
fn put_column(from: &[LaneValues<LANES>], to: &mut [f64], (first, rows): (usize, usize)) {
    for (part, to) in to.chunks_mut(rows * PART).enumerate() {
        let variants = to.chunks_exact_mut(rows).enumerate();
        if let Ok(tile) = <&[LaneValues<LANES>; TILE]>::try_from(from) {
            let tile: [&[f64; PART]; TILE] = from_fn(|row| tile[row].part(part));
            for (lane, to) in variants {
                let to = &mut to[first..first + TILE];
                for row in 0..TILE {
                    to[row] = tile[row][lane];
                }
            }
        } else {
            for (lane, to) in variants {
                to[first..].iter_mut().zip(from).for_each(|(to, row)| *to = row.0[part * PART + lane]);
            }
        }
    }
}
