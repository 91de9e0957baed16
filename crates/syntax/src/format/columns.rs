//! Columns of neighbouring declarations, and of the comments behind them.

use super::groups::BEFORE_COMMENT;
use super::layout::WIDTH;
use super::rows::{Group, Kind, Row};
use super::words::Word;
use crate::lexer::Token;
use std::ops::Range;

/// Cells wider than this stick out of their column instead of pushing the others away.
const WIDEST_CELL: usize = 40;

/// Lines longer than this do not push the comments behind others away.
const WIDEST_BEFORE_COMMENT: usize = 60;

/// Runs of rows with a column in common: what is joined has no blank line between, stands at one indentation, and `are_alike`.
/// Comments in between are passed over.
pub(super) fn runs(rows: &[Row], are_alike: impl Fn(Kind, Kind) -> bool) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    // last row of the open run
    let mut last: Option<&Row> = None;
    for (k, row) in rows.iter().enumerate() {
        let goes_on = last.is_some_and(|last| {
            !row.is_apart && last.indent == row.indent && (row.kind == Kind::Comment || are_alike(last.kind, row.kind))
        });
        match (runs.last_mut(), row.kind) {
            (Some(run), _) if goes_on => run.end = k + 1,
            (_, Kind::Comment) => last = None,
            _ => runs.push(k..k + 1),
        }
        if row.kind != Kind::Comment {
            last = Some(row);
        }
    }
    runs
}

/// The cells of a declaration: the token (from its first) at which each begins, and its width. The last one goes on to its end.
pub(super) struct Cells(Vec<(usize, usize)>);

impl Cells {
    /// Returns the cells of a row; none if a comment inside hides its columns.
    pub fn of(words: &[Word], tokens: &[Token<'_>]) -> Cells {
        let starts = std::iter::once(0).chain((0..words.len()).filter(|&k| words[k].begins_cell));
        let starts: Vec<usize> = starts.collect();
        let columns = starts.last().copied().unwrap_or(0);
        if tokens[..columns].iter().any(Token::is_comment) {
            return Cells(Vec::new());
        }
        let ends = starts.iter().skip(1).copied().chain([words.len()]);
        let cell =
            |(&start, end): (&usize, usize)| (start, super::words::width(&words[start..end], &tokens[start..end]));
        Cells(starts.iter().zip(ends).map(cell).collect())
    }

    /// Returns all cells but the last.
    fn padded(&self) -> &[(usize, usize)] {
        self.0.split_last().map_or(&[], |(_, padded)| padded)
    }
}

/// Returns whether one-line bodies can be aligned: they have the same columns, and fit.
fn have_room(rows: &[Row], cells: &[Option<Cells>]) -> bool {
    // the ground has none
    let of_bodies = || cells.iter().flatten().map(|cells| &cells.0).filter(|cells| cells.len() > 1);
    let count = of_bodies().next().map_or(0, Vec::len);
    let width = |columns: &[usize]| columns.iter().sum::<usize>() + columns.len().saturating_sub(1);
    let indent = rows.first().map_or(0, |row| row.indent);
    let widest = |column: usize| of_bodies().filter_map(|cells| cells.get(column)).map(|&(_, width)| width).max();
    let columns: Vec<usize> = (0..count).filter_map(widest).collect();
    of_bodies().all(|cells| cells.len() == count) && indent + width(&columns) <= WIDTH
}

/// Adds the spaces that bring the cells of a run into columns, to those before each token of the text.
pub(super) fn align(rows: &[Row], cells: &[Option<Cells>], spaces: &mut [usize]) {
    if rows.iter().any(|row| row.kind == Kind::Declaration(Group::Blocks)) && !have_room(rows, cells) {
        return;
    }
    let count = cells.iter().flatten().map(|cells| cells.padded().len()).max().unwrap_or(0);
    for column in 0..count {
        let of_column = |cells: &Cells| cells.padded().get(column).map(|&(_, width)| width);
        let widths = cells.iter().flatten().filter_map(of_column);
        let widest = widths.filter(|&width| width <= WIDEST_CELL).max().unwrap_or(0);
        for (row, cells) in rows.iter().zip(cells) {
            let Some(cells) = cells else { continue };
            if let (Some(width), Some(&(next, _))) = (of_column(cells), cells.0.get(column + 1)) {
                spaces[row.tokens.start + next] += widest.saturating_sub(width);
            }
        }
    }
}

/// Returns the spaces before the comments of a run, by the end columns of its rows, which are `None` for rows of several lines.
pub(super) fn before_comments(rows: &[Row], ends: &[Option<usize>]) -> Vec<usize> {
    let commented = rows.iter().zip(ends).filter(|(row, _)| row.behind.is_some());
    let columns = commented.filter_map(|(_, end)| *end).filter(|&end| end <= WIDEST_BEFORE_COMMENT);
    let widest = columns.max().unwrap_or(0);
    ends.iter().map(|end| BEFORE_COMMENT + end.map_or(0, |end| widest.saturating_sub(end))).collect()
}
