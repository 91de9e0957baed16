//! Variants in a row as columns of a table.

use super::Whole;
use crate::table::{Kind, Values};
use arrow_array::StringArray;
use arrow_buffer::{Buffer, OffsetBuffer};
use mechc::{ColumnUnit, Status, Swept, SweptColumn};
use std::collections::TryReserveError;

/// A block of variants, as it comes from the threads that compute.
pub struct Block {
    pub first: u64,
    pub statuses: Vec<Status>,
    /// The columns of the table, each with whether a number of it is missing.
    pub columns: Vec<(SweptColumn, bool)>,
    pub rows: usize,
}

impl Block {
    /// What a sweep has of them, in its order of columns.
    pub fn of(swept: Swept, units: Option<&[ColumnUnit]>) -> Block {
        let (first, statuses) = (swept.first, swept.statuses.clone());
        let rows = if units.is_some() { swept.lengths.iter().sum() } else { swept.len() };
        // on the threads that compute, where the numbers are at hand
        let columns = swept.tabulated(units).into_iter().map(|column| {
            let has_gaps =
                matches!(&column, SweptColumn::Numbers(values) if !values.iter().all(|value| value.is_finite()));
            (column, has_gaps)
        });
        Block { first, statuses, columns: columns.collect(), rows }
    }
}

/// Blocks that are put together.
pub struct Gathered {
    columns: Vec<Gathering>,
    /// By column: whether a number of it is missing.
    pub gaps: Vec<bool>,
    pub rows: usize,
}

enum Gathering {
    Real(Vec<f64>),
    Whole(Vec<u64>),
    Words(Words),
}

/// Words one behind the other, and where each begins.
#[derive(Default)]
struct Words {
    begins: Vec<i32>,
    text: Vec<u8>,
}

/// There is no memory for more.
pub struct Full;

impl From<TryReserveError> for Full {
    fn from(_: TryReserveError) -> Full {
        Full
    }
}

impl Gathered {
    pub fn new(whole: &Whole) -> Gathered {
        let columns = whole.heads.iter().map(|head| match head.kind {
            Kind::Numbers => Gathering::Real(Vec::new()),
            Kind::Whole => Gathering::Whole(Vec::new()),
            Kind::Words => Gathering::Words(Words::default()),
        });
        Gathered { columns: columns.collect(), gaps: vec![false; whole.heads.len()], rows: 0 }
    }

    /// Makes room for so many rows.
    pub fn reserve(&mut self, rows: u64) -> Result<(), Full> {
        let rows = usize::try_from(rows).map_err(|_| Full)?;
        for column in &mut self.columns {
            match column {
                Gathering::Real(values) => values.try_reserve_exact(rows)?,
                Gathering::Whole(values) => values.try_reserve_exact(rows)?,
                Gathering::Words(words) => words.begins.try_reserve_exact(rows + 1)?,
            }
        }
        Ok(())
    }

    /// Adds a block behind the others.
    pub fn add(&mut self, block: Block) -> Result<(), Full> {
        self.rows += block.rows;
        for ((into, gaps), (column, has_gaps)) in self.columns.iter_mut().zip(&mut self.gaps).zip(block.columns) {
            *gaps |= has_gaps;
            match (into, column) {
                (Gathering::Real(into), SweptColumn::Numbers(values)) => append(into, values)?,
                (Gathering::Whole(into), SweptColumn::Whole(values)) => append(into, values)?,
                (Gathering::Words(into), SweptColumn::Words(words)) => into.append(&words)?,
                _ => {}
            }
        }
        Ok(())
    }

    /// The columns.
    pub fn values(self) -> Vec<Values> {
        let values = self.columns.into_iter().map(|column| match column {
            Gathering::Real(values) => Values::Numbers(values.into()),
            Gathering::Whole(values) => Values::Whole(values.into()),
            Gathering::Words(words) => Values::Words(words.array()),
        });
        values.collect()
    }
}

/// Adds values behind others; what is alone needs no copy.
fn append<T: Copy>(into: &mut Vec<T>, values: Vec<T>) -> Result<(), Full> {
    if into.capacity() == 0 {
        *into = values;
    } else {
        into.try_reserve(values.len())?;
        into.extend_from_slice(&values);
    }
    Ok(())
}

impl Words {
    fn append(&mut self, words: &[&str]) -> Result<(), Full> {
        self.begins.try_reserve(words.len() + 1)?;
        self.text.try_reserve(words.iter().map(|word| word.len()).sum())?;
        for word in words {
            self.begins.push(self.end()?);
            self.text.extend_from_slice(word.as_bytes());
        }
        self.end().map(|_| ())
    }

    /// Where they end; Arrow counts in 32 bits.
    fn end(&self) -> Result<i32, Full> {
        i32::try_from(self.text.len()).map_err(|_| Full)
    }

    fn array(mut self) -> StringArray {
        self.begins.push(self.end().unwrap_or(i32::MAX));
        StringArray::new(OffsetBuffer::new(self.begins.into()), Buffer::from_vec(self.text), None)
    }
}
