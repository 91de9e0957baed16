//! Variants of a sweep as columns of a table, as all who write or hand out such tables have them.

use super::{Numbers, Status, Swept};
use mechc_ir::layout::ColumnUnit;

/// A column of variants, or of their rows.
#[derive(Clone, PartialEq, Debug)]
pub enum SweptColumn {
    /// The numbers of the variants.
    Whole(Vec<u64>),
    /// Numbers; what is missing is not a number.
    Numbers(Numbers),
    /// What became of them.
    Words(Vec<&'static str>),
}

impl Swept {
    /// Their table: of each variant its number, its params, its results (SI), what became of it and when it stopped. With the units of the
    /// wanted columns a line for each row instead: number, params, and these columns in their units.
    #[must_use]
    pub fn tabulated(self, units: Option<&[ColumnUnit]>) -> Vec<SweptColumn> {
        let numbers = self.first..self.first + self.len() as u64;
        let Swept { statuses, stopped, params, results, digits, lengths, columns: rows, .. } = self;
        let mut columns = Vec::with_capacity(params.len() + results.len() + rows.len() + 3);
        let Some(units) = units else {
            columns.push(SweptColumn::Whole(numbers.collect()));
            columns.extend(params.into_iter().chain(results).map(|values| SweptColumn::Numbers(values.into())));
            columns.extend(digits.map(SweptColumn::Whole));
            columns.push(SweptColumn::Words(statuses.into_iter().map(Status::as_str).collect()));
            columns.push(SweptColumn::Numbers(stopped.into()));
            return columns;
        };
        // what is said once of a variant, for each of its rows
        let mut whole = Vec::with_capacity(lengths.iter().sum());
        numbers.zip(&lengths).for_each(|(number, &rows)| whole.resize(whole.len() + rows, number));
        columns.push(SweptColumn::Whole(whole));
        columns.extend(params.into_iter().zip(rows.len()..).map(|(values, column)| {
            let mut numbers = rows.first().map_or_else(Numbers::default, |row| row.another(row.len(), column));
            let of_rows = values.into_iter().zip(&lengths);
            of_rows.for_each(|(value, &rows)| numbers.extend(std::iter::repeat_n(value, rows)));
            SweptColumn::Numbers(numbers)
        }));
        columns.extend(rows.into_iter().zip(units).map(|(mut values, unit)| {
            // numbers that nobody has changed may stand where they are for the next variants
            if !unit.is_si() {
                unit.print_all(&mut values);
            }
            SweptColumn::Numbers(values)
        }));
        columns
    }
}
