//! Collects the rows of a batch column by column.

use super::LANES;
use super::context::{BatchContext, RowPlan};
use crate::solver::VariantLanes;
use crate::sweep::column_buffer::Numbers;
use mechc_expr::math::{Vectors, WIDE};

/// Rows that are written to columns at once: two cache lines, which a processor fetches as a pair, for each column of each variant.
const TILE: usize = 2 * WIDE;
/// The numbers of a variant, 8 MB, above which only the times are cached.
const MAX_CACHED_NUMBERS: u64 = 1 << 20;

/// The requested rows of a batch, with the registers of their solver.
pub(super) struct RowCollector {
    pub lanes: VariantLanes<LANES>,
    /// The requested columns, with their places in a buffer: those with one number in all rows of a variant, those that depend on time alone
    /// and are equal for all variants, and the others.
    constant: Vec<(usize, u32)>,
    common: Vec<CommonColumn>,
    varying: Vec<(usize, u32)>,
    vectors: Vectors,
}

/// A column that is the same for all variants.
struct CommonColumn {
    place: usize,
    column: u32,
    /// Its numbers, one for each row so far.
    numbers: Vec<f64>,
}

/// A destination for the rows of variants, which are appended to columns, variant after variant.
pub struct RowBuffer<'c> {
    /// The requested columns.
    pub columns: &'c mut [Numbers],
    /// The number of rows of earlier variants that they hold.
    pub before: usize,
    /// The number of rows of each variant.
    pub rows: usize,
}

impl RowCollector {
    /// Creates a collector for the requested rows.
    pub fn new(context: &BatchContext, plan: &RowPlan) -> RowCollector {
        let is_constant = plan.solver.is_prologue_column();
        let columns = plan.columns.iter().copied().enumerate();
        let has_few = plan.times.len().saturating_mul(plan.columns.len() as u64) <= MAX_CACHED_NUMBERS;
        let is_common = |column: u32| column == 0 || has_few && plan.is_common[column as usize];
        let (constant, others): (Vec<_>, Vec<_>) = columns.partition(|&(_, column)| is_constant(column));
        let (common, varying): (Vec<_>, Vec<_>) = others.into_iter().partition(|&(_, column)| is_common(column));
        // one row is enough for columns that only the acceptance test reads or that are not collected row by row
        let rows = |column| if varying.iter().any(|&(_, collected)| collected == column) { TILE as u32 } else { 1 };
        let lanes = context.new_lanes(&plan.solver, rows);
        let new =
            |(place, column)| CommonColumn { place, column, numbers: Vec::with_capacity(plan.times.len() as usize) };
        let common = common.into_iter().map(new).collect();
        RowCollector { lanes, constant, common, varying, vectors: context.vectors }
    }

    /// Selects the row that the solver writes, for an output time by its number.
    pub fn select_row(&mut self, number: u64) {
        self.lanes.select_row(number as usize % TILE);
    }

    /// Writes the columns whose numbers are available before the first row: constant ones, and common ones of an earlier batch.
    pub fn write_cached(&self, buffer: &mut RowBuffer<'_>) {
        for &(place, column) in &self.constant {
            let (to, values) = (&mut buffer.columns[place], &self.lanes.column(column).0);
            if values.iter().all(|value| value.to_bits() == values[0].to_bits()) {
                to.repeat_from(buffer.before, &values[..1]);
            } else {
                let variants = to[buffer.before..].chunks_exact_mut(buffer.rows);
                variants.zip(values).for_each(|(to, value)| to.fill(*value));
            }
        }
        let is_complete = |common: &&CommonColumn| common.numbers.len() == buffer.rows;
        for CommonColumn { place, numbers, .. } in self.common.iter().filter(is_complete) {
            buffer.columns[*place].repeat_from(buffer.before, numbers);
        }
    }

    /// Writes the last rows to the varying columns, once a tile of them is complete or the last row is reached. `number` is that of the
    /// latest output time.
    pub fn write_rows(&self, number: u64, buffer: &mut RowBuffer<'_>) {
        let (last, count) = (number as usize, number as usize % TILE + 1);
        if count < TILE && last + 1 < buffer.rows {
            return;
        }
        let first = last + 1 - count;
        for &(place, column) in &self.varying {
            let to = &mut buffer.columns[place][buffer.before..];
            let (lines, rest) = self.lanes.rows(column)[..count].as_chunks::<WIDE>();
            for (line, tile) in lines.iter().enumerate() {
                self.vectors.turn(tile.each_ref().map(|row| &row.0), to, (first + line * WIDE, buffer.rows));
            }
            // rows behind the last whole line are copied one by one
            if !rest.is_empty() {
                let behind = first + lines.len() * WIDE;
                for (lane, to) in to.chunks_exact_mut(buffer.rows).enumerate() {
                    to[behind..].iter_mut().zip(rest).for_each(|(to, row)| *to = row.0[lane]);
                }
            }
        }
    }

    /// Caches the numbers of common columns in the row of an output time; writes the columns with the last row.
    pub fn cache_common(&mut self, plan: &RowPlan, number: u64, buffer: &mut RowBuffer<'_>) {
        let is_open = |common: &&mut CommonColumn| common.numbers.len() as u64 == number;
        for CommonColumn { place, column, numbers } in self.common.iter_mut().filter(is_open) {
            numbers.push(if *column == 0 { plan.times.at(number) } else { self.lanes.column(*column).0[0] });
            if numbers.len() == buffer.rows {
                buffer.columns[*place].repeat_from(buffer.before, numbers);
            }
        }
    }
}
