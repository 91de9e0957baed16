//! Variants in a row as columns of a table.

use super::Whole;
use crate::table::{Kind, Values};
use arrow_array::builder::StringBuilder;
use mechc::{Status, Swept};

/// A block of variants, as it comes from the threads that compute.
pub struct Block {
    pub first: u64,
    pub statuses: Vec<Status>,
    /// The columns of the table; of the words nothing, for they are the statuses.
    pub columns: Vec<Numbers>,
    pub rows: usize,
}

/// A column of a block.
pub enum Numbers {
    Real(Vec<f64>),
    Whole(Vec<u64>),
    Words,
}

impl Block {
    /// What a sweep has of them, in its order of columns.
    pub fn of(swept: Swept, units: Option<&[mechc::ColumnUnit]>) -> Block {
        let numbers = swept.first..swept.first + swept.len() as u64;
        let Swept { first, statuses, stopped, params, results, lengths, columns: rows, abreast: _ } = swept;
        let mut columns = Vec::with_capacity(params.len() + results.len() + rows.len() + 3);
        let Some(units) = units else {
            columns.push(Numbers::Whole(numbers.collect()));
            columns.extend(params.into_iter().chain(results).map(Numbers::Real));
            columns.extend([Numbers::Words, Numbers::Real(stopped)]);
            let rows = statuses.len();
            return Block { first, statuses, columns, rows };
        };
        columns.push(Numbers::Whole(repeated(numbers, &lengths)));
        columns.extend(params.into_iter().map(|values| Numbers::Real(repeated(values, &lengths))));
        columns.extend(rows.into_iter().zip(units).map(|(mut values, unit)| {
            if unit.scale() != [1.0; 3] {
                for value in &mut values {
                    *value = unit.printed(*value);
                }
            }
            Numbers::Real(values)
        }));
        Block { first, statuses, columns, rows: lengths.iter().sum() }
    }
}

/// What is said once of a variant, for each of its rows.
fn repeated<T: Copy>(values: impl IntoIterator<Item = T>, lengths: &[usize]) -> Vec<T> {
    values.into_iter().zip(lengths).flat_map(|(value, &rows)| std::iter::repeat_n(value, rows)).collect()
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
                (Gathering::Real(into), Numbers::Real(values)) if is_first => *into = values,
                (Gathering::Whole(into), Numbers::Whole(values)) if is_first => *into = values,
                (Gathering::Real(into), Numbers::Real(values)) => into.extend_from_slice(&values),
                (Gathering::Whole(into), Numbers::Whole(values)) => into.extend_from_slice(&values),
                (Gathering::Words(into), _) => {
                    block.statuses.iter().for_each(|status| into.append_value(status.as_str()));
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
