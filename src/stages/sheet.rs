//! Variants of a sweep as columns of a table, as all who write or hand out such tables have them.

use crate::layout::ColumnUnit;
use crate::sweep::{Status, Swept};

/// A column of variants, or of their rows.
#[derive(Clone, PartialEq, Debug)]
pub enum SweptColumn {
    /// The numbers of the variants.
    Whole(Vec<u64>),
    /// Numbers; what is missing is not a number.
    Numbers(Vec<f64>),
    /// What became of them.
    Words(Vec<&'static str>),
}

impl Swept {
    /// Their table: of each variant its number, its params, its results (SI), what became of it and when it stopped. With the units of the
    /// wanted columns a line for each row instead: number, params, and these columns in their units.
    #[must_use]
    pub fn tabulated(self, units: Option<&[ColumnUnit]>) -> Vec<SweptColumn> {
        let numbers = self.first..self.first + self.len() as u64;
        let Swept { statuses, stopped, params, results, lengths, columns: rows, .. } = self;
        let mut columns = Vec::with_capacity(params.len() + results.len() + rows.len() + 3);
        let Some(units) = units else {
            columns.push(SweptColumn::Whole(numbers.collect()));
            columns.extend(params.into_iter().chain(results).map(SweptColumn::Numbers));
            columns.push(SweptColumn::Words(statuses.into_iter().map(Status::as_str).collect()));
            columns.push(SweptColumn::Numbers(stopped));
            return columns;
        };
        columns.push(SweptColumn::Whole(repeated(numbers, &lengths)));
        columns.extend(params.into_iter().map(|values| SweptColumn::Numbers(repeated(values, &lengths))));
        columns.extend(rows.into_iter().zip(units).map(|(mut values, unit)| {
            for value in &mut values {
                *value = unit.printed(*value);
            }
            SweptColumn::Numbers(values)
        }));
        columns
    }
}

/// What is said once of a variant, for each of its rows.
fn repeated<T: Copy>(values: impl IntoIterator<Item = T>, lengths: &[usize]) -> Vec<T> {
    values.into_iter().zip(lengths).flat_map(|(value, &rows)| std::iter::repeat_n(value, rows)).collect()
}
