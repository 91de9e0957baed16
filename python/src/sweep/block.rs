//! Blocks of consecutive variants as columns of a table.

use super::SweepPlan;
use crate::table::{Kind, Values};
use arrow_array::StringArray;
use arrow_buffer::{Buffer, OffsetBuffer, ScalarBuffer};
use bytes::Bytes;
use mechc::{ColumnUnit, Numbers, Status, Swept, SweptColumn};
use std::collections::TryReserveError;

/// A block of variants, as the computing threads return it.
pub struct Block {
    pub first: u64,
    pub statuses: Vec<Status>,
    /// The columns of the table, each with whether numbers are missing in it.
    pub columns: Vec<(SweptColumn, bool)>,
    pub rows: usize,
}

impl Block {
    /// Converts variants to the columns of a sweep.
    pub fn new(swept: Swept, units: Option<&[ColumnUnit]>) -> Block {
        let (first, statuses) = (swept.first, swept.statuses.clone());
        let rows = if units.is_some() { swept.lengths.iter().sum() } else { swept.len() };
        // columns that are known to be finite are not searched
        let (params, went_abreast) = (swept.params.len(), swept.went_abreast());
        let is_known = |column: usize| {
            let unit = column.checked_sub(params + 1).and_then(|column| units?.get(column));
            units.is_some() && unit.is_none_or(|unit| went_abreast && unit.is_si())
        };
        // runs on the computing threads, while the numbers are in the cache; without an early exit, so that it vectorises: gaps are rare
        let is_whole = |values: &[f64]| values.iter().fold(true, |all, value| all & value.is_finite());
        let columns = swept.tabulated(units).into_iter().enumerate().map(|(number, column)| {
            let has_gaps = matches!(&column, SweptColumn::Numbers(values) if !is_known(number) && !is_whole(values));
            (column, has_gaps)
        });
        Block { first, statuses, columns: columns.collect(), rows }
    }
}

/// The columns of several blocks, joined.
pub struct JoinedBlocks {
    columns: Vec<JoinedColumn>,
    /// For each column, whether numbers are missing in it.
    pub gaps: Vec<bool>,
    pub rows: usize,
}

enum JoinedColumn {
    Real(Reals),
    Integers(Vec<u64>),
    Words(Words),
}

/// Numbers one behind the other; those of the first block are not copied until a second one follows.
#[derive(Default)]
struct Reals {
    first: Option<Numbers>,
    all: Vec<f64>,
}

/// Words one behind the other, and the offset of each.
#[derive(Default)]
struct Words {
    begins: Vec<i32>,
    text: Vec<u8>,
}

/// Error: an allocation failed, or offsets exceed 32 bits.
pub struct OutOfMemory;

impl From<TryReserveError> for OutOfMemory {
    fn from(_: TryReserveError) -> OutOfMemory {
        OutOfMemory
    }
}

impl JoinedBlocks {
    pub fn new(plan: &SweepPlan) -> JoinedBlocks {
        let columns = plan.headers.iter().map(|header| match header.kind {
            Kind::Numbers => JoinedColumn::Real(Reals::default()),
            Kind::Integers => JoinedColumn::Integers(Vec::new()),
            Kind::Words => JoinedColumn::Words(Words::default()),
        });
        JoinedBlocks { columns: columns.collect(), gaps: vec![false; plan.headers.len()], rows: 0 }
    }

    /// Reserves memory for a number of rows.
    pub fn reserve(&mut self, rows: u64) -> Result<(), OutOfMemory> {
        let rows = usize::try_from(rows).map_err(|_| OutOfMemory)?;
        for column in &mut self.columns {
            match column {
                JoinedColumn::Real(values) => values.all.try_reserve_exact(rows)?,
                JoinedColumn::Integers(values) => values.try_reserve_exact(rows)?,
                JoinedColumn::Words(words) => words.begins.try_reserve_exact(rows + 1)?,
            }
        }
        Ok(())
    }

    /// Adds a block behind the others.
    pub fn add(&mut self, block: Block) -> Result<(), OutOfMemory> {
        self.rows += block.rows;
        for ((into, gaps), (column, has_gaps)) in self.columns.iter_mut().zip(&mut self.gaps).zip(block.columns) {
            *gaps |= has_gaps;
            match (into, column) {
                (JoinedColumn::Real(into), SweptColumn::Numbers(values)) => into.append(values)?,
                (JoinedColumn::Integers(into), SweptColumn::Whole(values)) => append(into, values)?,
                (JoinedColumn::Words(into), SweptColumn::Words(words)) => into.append(&words)?,
                _ => {}
            }
        }
        Ok(())
    }

    /// Returns the columns.
    pub fn values(self) -> Vec<Values> {
        let values = self.columns.into_iter().map(|column| match column {
            JoinedColumn::Real(values) => Values::Numbers(values.buffer()),
            JoinedColumn::Integers(values) => Values::Integers(values.into()),
            JoinedColumn::Words(words) => Values::Words(words.array()),
        });
        values.collect()
    }
}

/// Appends values; the first ones are moved without a copy.
fn append<T: Copy>(into: &mut Vec<T>, values: Vec<T>) -> Result<(), OutOfMemory> {
    if into.capacity() == 0 {
        *into = values;
    } else {
        into.try_reserve(values.len())?;
        into.extend_from_slice(&values);
    }
    Ok(())
}

impl Reals {
    fn append(&mut self, values: Numbers) -> Result<(), OutOfMemory> {
        if self.first.is_none() && self.all.capacity() == 0 {
            self.first = Some(values);
            return Ok(());
        }
        let first = self.first.take();
        self.all.try_reserve(values.len() + first.as_deref().map_or(0, <[f64]>::len))?;
        for values in first.iter().chain([&values]) {
            self.all.extend_from_slice(values);
        }
        Ok(())
    }

    fn buffer(self) -> ScalarBuffer<f64> {
        let Some(first) = self.first else { return self.all.into() };
        let count = first.len();
        ScalarBuffer::new(Bytes::from_owner(Owner(first)).into(), 0, count)
    }
}

/// Owner of the memory of an Arrow array, which is reused once the array is dropped.
struct Owner(Numbers);

impl AsRef<[u8]> for Owner {
    fn as_ref(&self) -> &[u8] {
        bytemuck::cast_slice(&self.0)
    }
}

impl Words {
    fn append(&mut self, words: &[&str]) -> Result<(), OutOfMemory> {
        self.begins.try_reserve(words.len() + 1)?;
        self.text.try_reserve(words.iter().map(|word| word.len()).sum())?;
        for word in words {
            self.begins.push(self.end()?);
            self.text.extend_from_slice(word.as_bytes());
        }
        self.end().map(|_| ())
    }

    /// Returns the offset of the end; Arrow's offsets have 32 bits.
    fn end(&self) -> Result<i32, OutOfMemory> {
        i32::try_from(self.text.len()).map_err(|_| OutOfMemory)
    }

    fn array(mut self) -> StringArray {
        self.begins.push(self.end().unwrap_or(i32::MAX));
        StringArray::new(OffsetBuffer::new(self.begins.into()), Buffer::from_vec(self.text), None)
    }
}
