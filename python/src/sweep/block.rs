//! Variants in a row as columns of a table.

use super::Whole;
use crate::table::{Kind, Values};
use arrow_array::StringArray;
use arrow_buffer::{Buffer, OffsetBuffer, ScalarBuffer};
use bytes::Bytes;
use mechc::{ColumnUnit, Numbers, Status, Swept, SweptColumn};
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
        // what is known to be there is not looked at again
        let (params, went_abreast) = (swept.params.len(), swept.went_abreast());
        let is_known = |column: usize| {
            let unit = column.checked_sub(params + 1).and_then(|column| units?.get(column));
            units.is_some() && unit.is_none_or(|unit| went_abreast && unit.is_si())
        };
        // on the threads that compute, where the numbers are at hand; all of them, several at once: mostly none is missing
        let is_whole = |values: &[f64]| values.iter().fold(true, |all, value| all & value.is_finite());
        let columns = swept.tabulated(units).into_iter().enumerate().map(|(number, column)| {
            let has_gaps = matches!(&column, SweptColumn::Numbers(values) if !is_known(number) && !is_whole(values));
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
    Real(Reals),
    Whole(Vec<u64>),
    Words(Words),
}

/// Numbers one behind the other; those of the first block stay where they are until there are more.
#[derive(Default)]
struct Reals {
    first: Option<Numbers>,
    all: Vec<f64>,
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
            Kind::Numbers => Gathering::Real(Reals::default()),
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
                Gathering::Real(values) => values.all.try_reserve_exact(rows)?,
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
                (Gathering::Real(into), SweptColumn::Numbers(values)) => into.append(values)?,
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
            Gathering::Real(values) => Values::Numbers(values.buffer()),
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

impl Reals {
    fn append(&mut self, values: Numbers) -> Result<(), Full> {
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

/// Who has the memory of an array of Arrow: it is used again once the array is gone.
struct Owner(Numbers);

impl AsRef<[u8]> for Owner {
    fn as_ref(&self) -> &[u8] {
        bytemuck::cast_slice(&self.0)
    }
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
