//! What comes out of a sweep: variants in a row, by columns.

use super::numbers::{Numbers, Spare};
use super::table::Room;
use mechc_text::diag::Code;
use std::sync::Arc;

/// What became of a variant.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Status {
    /// It was led over to its params along the branch, and ran.
    Ok,
    /// No way led there: it was assembled from the text with its params, and ran.
    Reassembled,
    /// It cannot be, or stopped.
    Stopped(Code),
}

impl Status {
    /// As tables have it: `ok`, `reassembled`, `E0602`.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Status::Ok => "ok",
            Status::Reassembled => "reassembled",
            Status::Stopped(code) => code.as_str(),
        }
    }

    /// Whether it ran to its end.
    #[must_use]
    pub fn is_complete(self) -> bool {
        !matches!(self, Status::Stopped(_))
    }
}

/// One variant.
#[derive(Clone, PartialEq, Debug)]
pub struct OneVariant {
    /// What became of it.
    pub status: Status,
    /// The time at which it stopped (s); no number where it did not, or where that has no time.
    pub stopped: f64,
    /// Its results (SI); no number where one has no value.
    pub results: Vec<f64>,
    /// How many digits are certain of all its results that have a value; 0 where none has.
    pub digits: u32,
    /// Row after row, the columns that are wanted (SI); none where no rows are.
    pub rows: Vec<f64>,
}

/// Variants in a row, column by column.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Swept {
    /// The number of the first.
    pub first: u64,
    /// By variant.
    pub statuses: Vec<Status>,
    /// By variant: the time at which it stopped (s), or no number.
    pub stopped: Vec<f64>,
    /// By param that varies, by variant (SI).
    pub params: Vec<Vec<f64>>,
    /// By result, by variant (SI); no number where it has no value.
    pub results: Vec<Vec<f64>>,
    /// By variant: how many digits are certain of all its results; nothing where nobody asks.
    pub digits: Option<Vec<u64>>,
    /// By variant: how many rows it has.
    pub lengths: Vec<usize>,
    /// By wanted column, row after row (SI).
    pub columns: Vec<Numbers>,
    /// How many of them went side by side: which way a variant went changes no bit of it.
    pub abreast: usize,
    /// Of how many of them results were found so too.
    pub answered: usize,
}

impl Swept {
    /// One that is to begin with a variant, with so many params, results and columns.
    #[must_use]
    pub fn new(first: u64, params: usize, results: usize, columns: usize) -> Swept {
        let of = |count| vec![Vec::new(); count];
        let columns = vec![Numbers::default(); columns];
        Swept { first, params: of(params), results: of(results), columns, ..Swept::default() }
    }

    /// Makes room for the rows of the next variants, so many, which are to run side by side, each with so many rows.
    pub fn room(&mut self, variants: usize, rows: usize) -> Room<'_> {
        let before = self.columns.first().map_or(0, |column| column.len());
        self.columns.iter_mut().for_each(|column| column.make_room(variants * rows));
        Room { columns: &mut self.columns, before, rows }
    }

    /// Takes out what was written where room was made, by column; so many numbers were there before.
    pub fn take_room(&mut self, before: usize) -> Vec<Vec<f64>> {
        let take = |column: &mut Numbers| {
            let taken = column[before..].to_vec();
            column.truncate(before);
            taken
        };
        self.columns.iter_mut().map(take).collect()
    }

    /// Adds the next variants, so many, which have run side by side, each with so many rows, which are there already: what their params are, one
    /// variant behind the other.
    pub fn push_abreast(&mut self, (count, rows): (usize, usize), params: &[f64]) {
        self.statuses.resize(self.statuses.len() + count, Status::Ok);
        self.stopped.resize(self.stopped.len() + count, f64::NAN);
        self.lengths.resize(self.lengths.len() + count, if self.columns.is_empty() { 0 } else { rows });
        let width = self.params.len();
        for (k, column) in self.params.iter_mut().enumerate() {
            column.extend(params.iter().skip(k).step_by(width));
        }
        self.abreast += count;
    }

    /// Adds the results of the next one of the variants that have run side by side.
    pub fn push_results_abreast(&mut self, results: &[f64]) {
        self.push_results(results);
        self.answered += 1;
    }

    /// Adds how many digits are certain of the results of the variant that was added last.
    pub fn push_digits(&mut self, digits: u32) {
        self.digits.iter_mut().for_each(|column| column.push(u64::from(digits)));
    }

    /// Adds the results of the variant that was added last.
    pub fn push_results(&mut self, results: &[f64]) {
        self.results.iter_mut().zip(results).for_each(|(column, value)| column.push(*value));
    }

    /// Takes memory for so many rows in all.
    pub fn reserve(&mut self, rows: usize, spare: &Arc<Spare>) {
        for (number, column) in self.columns.iter_mut().enumerate() {
            *column = Numbers::with_capacity(rows, spare, number);
        }
    }

    /// Adds the next variant.
    pub fn push(&mut self, params: &[f64], variant: &OneVariant) {
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

    /// By result: the numbers of the variants that ran to their end and have no value of it.
    pub fn without_value(&self) -> impl Iterator<Item = impl Iterator<Item = u64>> {
        self.results.iter().map(|values| {
            let all = values.iter().zip(&self.statuses).zip(self.first..);
            all.filter(|((value, status), _)| value.is_nan() && status.is_complete()).map(|(_, variant)| variant)
        })
    }

    /// Keeps the first ones, so many.
    pub fn truncate(&mut self, variants: usize) {
        let left_out = self.len().saturating_sub(variants);
        self.statuses.truncate(variants);
        self.stopped.truncate(variants);
        self.lengths.truncate(variants);
        let rows = self.lengths.iter().sum();
        self.params.iter_mut().chain(&mut self.results).for_each(|column| column.truncate(variants));
        self.columns.iter_mut().for_each(|column| column.truncate(rows));
        self.digits.iter_mut().for_each(|column| column.truncate(variants));
        // which of those that are left out went side by side nobody knows: never too many are said to
        self.abreast = self.abreast.saturating_sub(left_out);
        self.answered = self.answered.min(variants);
    }

    /// Whether all of them went side by side: then all have all their rows, and every number there is finite (SI).
    #[must_use]
    pub fn went_abreast(&self) -> bool {
        self.abreast == self.len()
    }

    /// How many variants it holds.
    #[must_use]
    pub fn len(&self) -> usize {
        self.statuses.len()
    }

    /// Whether it holds none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.statuses.is_empty()
    }
}
