//! The rows of variants that go side by side, column by column.

use super::each::LANES;
use super::numbers::Numbers;
use super::together::{Rows, Together};
use crate::solver::Abreast;
use mechc_expr::math::{Vectors, WIDE};

/// Rows that are put into columns together: two lines of the processor's memory, which it fetches as a pair, for each column of each variant.
const TILE: usize = 2 * WIDE;
/// Of a variant with more numbers than this, 8 MB, only the times are kept beside its rows.
const MOST_LEARNED: u64 = 1 << 20;

/// Rows that are wanted, and what solves for them.
pub(super) struct Table {
    pub abreast: Abreast<LANES>,
    /// Columns that are wanted, by their places in a room: those with one number in all rows of a variant, those that go with time alone, which all
    /// variants have alike, and the others.
    fixed: Vec<(usize, u32)>,
    alike: Vec<Alike>,
    varying: Vec<(usize, u32)>,
    vectors: Vectors,
}

/// A column that is the same for all variants.
struct Alike {
    place: usize,
    column: u32,
    /// Its numbers, as far as they are known: one by row.
    numbers: Vec<f64>,
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
        let wanted = of.wanted.iter().copied().enumerate();
        let has_few = of.times.len().saturating_mul(of.wanted.len() as u64) <= MOST_LEARNED;
        let is_alike = |column: u32| column == 0 || has_few && of.is_alike[column as usize];
        let (fixed, others): (Vec<_>, Vec<_>) = wanted.partition(|&(_, column)| is_fixed(column));
        let (alike, varying): (Vec<_>, Vec<_>) = others.into_iter().partition(|&(_, column)| is_alike(column));
        // of what steps alone are judged by the last row is enough, and one of what is not collected row by row
        let rows = |column| if varying.iter().any(|&(_, wanted)| wanted == column) { TILE as u32 } else { 1 };
        let abreast = together.abreast(&of.solver, rows);
        let new = |(place, column)| Alike { place, column, numbers: Vec::with_capacity(of.times.len() as usize) };
        let alike = alike.into_iter().map(new).collect();
        Table { abreast, fixed, alike, varying, vectors: together.vectors }
    }

    /// Goes to the row of an output time, by its number.
    pub fn turn_to(&mut self, number: u64) {
        self.abreast.turn_to(number as usize % TILE);
    }

    /// Puts into columns what is known of all rows, of variants that are loaded.
    pub fn put_known(&self, room: &mut Room<'_>) {
        for &(place, column) in &self.fixed {
            let (to, values) = (&mut room.columns[place], &self.abreast.column(column).0);
            if values.iter().all(|value| value.to_bits() == values[0].to_bits()) {
                to.repeat_from(room.before, &values[..1]);
            } else {
                let stretches = to[room.before..].chunks_exact_mut(room.rows);
                stretches.zip(values).for_each(|(to, value)| to.fill(*value));
            }
        }
        let is_known = |alike: &&Alike| alike.numbers.len() == room.rows;
        for Alike { place, numbers, .. } in self.alike.iter().filter(is_known) {
            room.columns[*place].repeat_from(room.before, numbers);
        }
    }

    /// Puts the last rows into columns, once there are enough of them: up to that of an output time, by its number.
    pub fn put(&self, number: u64, room: &mut Room<'_>) {
        let (last, count) = (number as usize, number as usize % TILE + 1);
        if count < TILE && last + 1 < room.rows {
            return;
        }
        let first = last + 1 - count;
        for &(place, column) in &self.varying {
            let to = &mut room.columns[place][room.before..];
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

    /// Learns what all variants have alike in the row of an output time, by its number, if that is not known; with the last row it is put into the
    /// columns.
    pub fn learn(&mut self, of: &Rows, number: u64, room: &mut Room<'_>) {
        for Alike { place, column, numbers } in self.alike.iter_mut().filter(|of| of.numbers.len() as u64 == number) {
            numbers.push(if *column == 0 { of.times.at(number) } else { self.abreast.column(*column).0[0] });
            if numbers.len() == room.rows {
                room.columns[*place].repeat_from(room.before, numbers);
            }
        }
    }
}
