//! Variants in a row as columns of a table.

use super::Whole;
use crate::table::{Kind, Values};
use arrow_array::builder::StringBuilder;
use mechc::{ColumnUnit, Status, Swept, SweptColumn};

/// A block of variants, as it comes from the threads that compute.
pub struct Block {
    pub first: u64,
    pub statuses: Vec<Status>,
    /// The columns of the table.
    pub columns: Vec<SweptColumn>,
    pub rows: usize,
}

impl Block {
    /// What a sweep has of them, in its order of columns.
    pub fn of(swept: Swept, units: Option<&[ColumnUnit]>) -> Block {
        let (first, statuses) = (swept.first, swept.statuses.clone());
        let rows = if units.is_some() { swept.lengths.iter().sum() } else { swept.len() };
        Block { first, statuses, columns: swept.tabulated(units), rows }
    }
}

/// Blocks that are put together.
pub struct Gathered {
    columns: Vec<Gathering>,
    pub rows: usize,
}

enum Gathering {
    Real(Vec<f64>),
    Whole(Vec<u64>),
    Words(StringBuilder),
}

impl Gathered {
    pub fn new(whole: &Whole) -> Gathered {
        let columns = whole.heads.iter().map(|head| match head.kind {
            Kind::Numbers => Gathering::Real(Vec::new()),
            Kind::Whole => Gathering::Whole(Vec::new()),
            Kind::Words => Gathering::Words(StringBuilder::new()),
        });
        Gathered { columns: columns.collect(), rows: 0 }
    }

    /// Adds a block behind the others.
    pub fn add(&mut self, block: Block) {
        let is_first = self.rows == 0;
        self.rows += block.rows;
        for (into, column) in self.columns.iter_mut().zip(block.columns) {
            match (into, column) {
                // what is alone needs no copy
                (Gathering::Real(into), SweptColumn::Numbers(values)) if is_first => *into = values,
                (Gathering::Whole(into), SweptColumn::Whole(values)) if is_first => *into = values,
                (Gathering::Real(into), SweptColumn::Numbers(values)) => into.extend_from_slice(&values),
                (Gathering::Whole(into), SweptColumn::Whole(values)) => into.extend_from_slice(&values),
                (Gathering::Words(into), SweptColumn::Words(words)) => {
                    for word in words {
                        into.append_value(word);
                    }
                }
                _ => {}
            }
        }
    }

    /// The columns.
    pub fn values(self) -> Vec<Values> {
        let values = self.columns.into_iter().map(|column| match column {
            Gathering::Real(values) => Values::Numbers(values.into()),
            Gathering::Whole(values) => Values::Whole(values.into()),
            Gathering::Words(mut words) => Values::Words(words.finish()),
        });
        values.collect()
    }
}
