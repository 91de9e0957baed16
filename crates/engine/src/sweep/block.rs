//! A block of consecutive variants of a sweep, column by column, and its table.

use super::batch::RowBuffer;
use super::column_buffer::{BufferPool, Numbers};
use mechc_ir::layout::ColumnUnit;
use mechc_text::diag::Code;
use std::sync::Arc;

/// The outcome of a variant.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Status {
    /// The variant was continued to its params along the branch, and ran.
    Ok,
    /// No continuation reached its params: the variant was assembled from the text with them, and ran.
    Reassembled,
    /// The variant could not start, or stopped, with this code.
    Stopped(Code),
}

impl Status {
    /// Returns the text in tables: `ok`, `reassembled`, `E0602`.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Status::Ok => "ok",
            Status::Reassembled => "reassembled",
            Status::Stopped(code) => code.as_str(),
        }
    }

    /// Returns whether the variant ran to its end.
    #[must_use]
    pub fn is_complete(self) -> bool {
        !matches!(self, Status::Stopped(_))
    }
}

/// Outcome of a variant that was computed alone.
#[derive(Clone, PartialEq, Debug)]
pub struct VariantOutcome {
    /// Its outcome.
    pub status: Status,
    /// The time at which it stopped (s); NaN if it did not stop or has no such time.
    pub stopped: f64,
    /// Its results (SI); NaN for a result without a value.
    pub results: Vec<f64>,
    /// The number of digits that are certain in all its results with a value; 0 without such a result.
    pub digits: u32,
    /// The requested columns (SI), row after row; empty without requested rows.
    pub rows: Vec<f64>,
}

/// Consecutive variants of a sweep, column by column.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Swept {
    /// The number of the first variant.
    pub first: u64,
    /// By variant: its outcome.
    pub statuses: Vec<Status>,
    /// By variant: the time at which it stopped (s), or NaN.
    pub stopped: Vec<f64>,
    /// By varying param, then by variant (SI).
    pub params: Vec<Vec<f64>>,
    /// By result, then by variant (SI); NaN without a value.
    pub results: Vec<Vec<f64>>,
    /// By variant: the number of digits that are certain in all its results; `None` if digits are not requested.
    pub digits: Option<Vec<u64>>,
    /// By variant: its number of rows.
    pub lengths: Vec<usize>,
    /// By requested column, the rows of all variants (SI).
    pub columns: Vec<Numbers>,
    /// The number of variants computed in batches. Computed alone, they have the same bits.
    pub abreast: usize,
    /// The number of variants whose results were found in batches.
    pub answered: usize,
}

impl Swept {
    /// Creates an empty block that begins with variant `first`, for the given numbers of params, results and columns.
    #[must_use]
    pub fn new(first: u64, params: usize, results: usize, columns: usize) -> Swept {
        let empty = |count| vec![Vec::new(); count];
        let columns = vec![Numbers::default(); columns];
        Swept { first, params: empty(params), results: empty(results), columns, ..Swept::default() }
    }

    /// Makes room for the rows of the next `variants`, computed in a batch with `rows` rows each.
    pub fn room(&mut self, variants: usize, rows: usize) -> RowBuffer<'_> {
        let before = self.columns.first().map_or(0, |column| column.len());
        self.columns.iter_mut().for_each(|column| column.make_room(variants * rows));
        RowBuffer { columns: &mut self.columns, before, rows }
    }

    /// Removes the rows behind the first `before` ones, and returns them by column.
    pub fn take_rows_from(&mut self, before: usize) -> Vec<Vec<f64>> {
        let take = |column: &mut Numbers| {
            let taken = column[before..].to_vec();
            column.truncate(before);
            taken
        };
        self.columns.iter_mut().map(take).collect()
    }

    /// Adds the next `count` variants of a batch, whose `rows` rows each are in the columns already. `params` holds their params, variant after
    /// variant.
    pub fn push_batch(&mut self, (count, rows): (usize, usize), params: &[f64]) {
        self.statuses.resize(self.statuses.len() + count, Status::Ok);
        self.stopped.resize(self.stopped.len() + count, f64::NAN);
        self.lengths.resize(self.lengths.len() + count, if self.columns.is_empty() { 0 } else { rows });
        let width = self.params.len();
        for (k, column) in self.params.iter_mut().enumerate() {
            column.extend(params.iter().skip(k).step_by(width));
        }
        self.abreast += count;
    }

    /// Adds the results of the next variant of a batch.
    pub fn push_batch_results(&mut self, results: &[f64]) {
        self.push_results(results);
        self.answered += 1;
    }

    /// Adds the number of certain digits in the results of the last variant.
    pub fn push_digits(&mut self, digits: u32) {
        self.digits.iter_mut().for_each(|column| column.push(u64::from(digits)));
    }

    /// Adds the results of the last variant.
    pub fn push_results(&mut self, results: &[f64]) {
        self.results.iter_mut().zip(results).for_each(|(column, value)| column.push(*value));
    }

    /// Takes memory for `rows` rows in all from a pool.
    pub fn reserve(&mut self, rows: usize, pool: &Arc<BufferPool>) {
        for (number, column) in self.columns.iter_mut().enumerate() {
            *column = Numbers::with_capacity(rows, pool, number);
        }
    }

    /// Adds the next variant, computed alone.
    pub fn push(&mut self, params: &[f64], variant: &VariantOutcome) {
        self.statuses.push(variant.status);
        self.stopped.push(variant.stopped);
        self.params.iter_mut().zip(params).for_each(|(column, value)| column.push(*value));
        self.push_results(&variant.results);
        self.push_digits(variant.digits);
        let width = self.columns.len();
        self.lengths.push(variant.rows.len().checked_div(width).unwrap_or(0));
        for (k, column) in self.columns.iter_mut().enumerate() {
            column.extend(variant.rows.iter().copied().skip(k).step_by(width));
        }
    }

    /// Returns by result the numbers of the variants that ran to their end and have no value of it.
    pub fn without_value(&self) -> impl Iterator<Item = impl Iterator<Item = u64>> {
        self.results.iter().map(|values| {
            let all = values.iter().zip(&self.statuses).zip(self.first..);
            all.filter(|((value, status), _)| value.is_nan() && status.is_complete()).map(|(_, variant)| variant)
        })
    }

    /// Keeps the first `variants` ones.
    pub fn truncate(&mut self, variants: usize) {
        let removed = self.len().saturating_sub(variants);
        self.statuses.truncate(variants);
        self.stopped.truncate(variants);
        self.lengths.truncate(variants);
        let rows = self.lengths.iter().sum();
        self.params.iter_mut().chain(&mut self.results).for_each(|column| column.truncate(variants));
        self.columns.iter_mut().for_each(|column| column.truncate(rows));
        self.digits.iter_mut().for_each(|column| column.truncate(variants));
        // a lower bound: it is not recorded which of the removed variants were in batches
        self.abreast = self.abreast.saturating_sub(removed);
        self.answered = self.answered.min(variants);
    }

    /// Returns whether all variants were computed in batches; then each has all its rows, and every number there is finite (SI).
    #[must_use]
    pub fn went_abreast(&self) -> bool {
        self.abreast == self.len()
    }

    /// Returns the number of variants.
    #[must_use]
    pub fn len(&self) -> usize {
        self.statuses.len()
    }

    /// Returns whether the block has no variants.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.statuses.is_empty()
    }

    /// Returns the columns of a table with a line for each variant: number, params, results (SI), certain digits, status and time of its stop.
    /// With the units of the requested columns a line for each row instead: number, params, and these columns in their units.
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
        // number and params of a variant are repeated for each of its rows
        let mut whole = Vec::with_capacity(lengths.iter().sum());
        numbers.zip(&lengths).for_each(|(number, &rows)| whole.resize(whole.len() + rows, number));
        columns.push(SweptColumn::Whole(whole));
        columns.extend(params.into_iter().zip(rows.len()..).map(|(values, column)| {
            let mut numbers = rows.first().map_or_else(Numbers::default, |row| row.new_in_pool(row.len(), column));
            let by_variant = values.into_iter().zip(&lengths);
            by_variant.for_each(|(value, &rows)| numbers.extend(std::iter::repeat_n(value, rows)));
            SweptColumn::Numbers(numbers)
        }));
        columns.extend(rows.into_iter().zip(units).map(|(mut values, unit)| {
            // unchanged numbers keep their period, so that the next block may reuse them
            if !unit.is_si() {
                unit.print_all(&mut values);
            }
            SweptColumn::Numbers(values)
        }));
        columns
    }
}

/// A column in a table of variants or of their rows.
#[derive(Clone, PartialEq, Debug)]
pub enum SweptColumn {
    /// The numbers of variants, or certain digits.
    Whole(Vec<u64>),
    /// Numbers; NaN if missing.
    Numbers(Numbers),
    /// The outcomes of variants.
    Words(Vec<&'static str>),
}
