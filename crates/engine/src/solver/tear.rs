//! Tearing: chooses the coordinates of a block that Newton solves for, so that all others follow by assignment (compare H. Elmqvist, M. Otter,
//! *Methods for tearing systems of equations*, 1994).

use std::collections::BTreeSet;

/// Number of rows among which a tear is chosen.
const CANDIDATES: usize = 64;

/// The result of tearing a block. Rows and columns are counted within the block.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(super) struct Tearing {
    /// Equations with the coordinate that each is solved for, in an order of solution.
    pub assigned: Vec<(u32, u32)>,
    /// The coordinates that Newton solves for.
    pub tears: Vec<u32>,
    /// The equations that Newton solves, as many as tears.
    pub residuals: Vec<u32>,
}

/// An entry of a block: its column, and whether it is a number, so that its row can be solved for the column.
pub(super) type Entry = (u32, bool);

/// Tears a block with as many rows as columns.
pub(super) fn tear(rows: &[Vec<Entry>]) -> Tearing {
    let mut search = Search::new(rows);
    while search.resolved < rows.len() {
        match search.next_row() {
            Some((row, Some(column))) => {
                search.tearing.assigned.push((row, column));
                search.consume(row);
                search.resolve(column);
            }
            // all its coordinates are resolved, or it cannot be solved for the last of them
            Some((row, None)) => search.consume(row),
            None => {
                let column = search.best_tear();
                search.tearing.tears.push(column);
                search.resolve(column);
            }
        }
    }
    search.finish()
}

struct Search<'r> {
    rows: &'r [Vec<Entry>],
    /// By column: the rows that contain it, and whether one of them can be solved for it.
    users: Vec<Vec<u32>>,
    is_assignable: Vec<bool>,
    is_resolved: Vec<bool>,
    is_consumed: Vec<bool>,
    unknowns: Vec<usize>,
    /// The remaining rows with their numbers of unknowns, fewest first.
    open_rows: BTreeSet<(usize, u32)>,
    resolved: usize,
    tearing: Tearing,
}

impl<'r> Search<'r> {
    fn new(rows: &'r [Vec<Entry>]) -> Search<'r> {
        let n = rows.len();
        let (mut users, mut is_assignable) = (vec![Vec::new(); n], vec![false; n]);
        for (row, entries) in rows.iter().enumerate() {
            for &(column, is_number) in entries {
                users[column as usize].push(row as u32);
                is_assignable[column as usize] |= is_number;
            }
        }
        Search {
            rows,
            users,
            is_assignable,
            is_resolved: vec![false; n],
            is_consumed: vec![false; n],
            unknowns: rows.iter().map(Vec::len).collect(),
            open_rows: rows.iter().enumerate().map(|(row, entries)| (entries.len(), row as u32)).collect(),
            resolved: 0,
            tearing: Tearing::default(),
        }
    }

    /// Returns a row with at most one unknown, and that unknown if the row can be solved for it.
    fn next_row(&self) -> Option<(u32, Option<u32>)> {
        let &(unknowns, row) = self.open_rows.first().filter(|(unknowns, _)| *unknowns <= 1)?;
        let unknown = self.rows[row as usize].iter().find(|(column, _)| !self.is_resolved[*column as usize]);
        let column = unknown.filter(|(_, is_number)| unknowns == 1 && *is_number).map(|(column, _)| *column);
        Some((row, column))
    }

    fn consume(&mut self, row: u32) {
        self.is_consumed[row as usize] = true;
        self.open_rows.remove(&(self.unknowns[row as usize], row));
    }

    fn resolve(&mut self, column: u32) {
        self.is_resolved[column as usize] = true;
        self.resolved += 1;
        for k in 0..self.users[column as usize].len() {
            let row = self.users[column as usize][k] as usize;
            if !self.is_consumed[row] {
                self.open_rows.remove(&(self.unknowns[row], row as u32));
                self.open_rows.insert((self.unknowns[row] - 1, row as u32));
            }
            self.unknowns[row] -= 1;
        }
    }

    /// Returns the next tear: among the unknowns of the shortest rows one that no equation can be solved for, used by the most rows; or else the
    /// unknown of the shortest row that the most rows use.
    fn best_tear(&self) -> u32 {
        let users = |column: u32| self.users[column as usize].len();
        let rows = || self.open_rows.iter().take(CANDIDATES).map(|&(_, row)| self.rows[row as usize].as_slice());
        let unknowns =
            |row: &'r [Entry]| row.iter().map(|&(column, _)| column).filter(|&c| !self.is_resolved[c as usize]);
        let unassignable = |row: &'r [Entry]| {
            unknowns(row).filter(|&column| !self.is_assignable[column as usize]).max_by_key(|&column| users(column))
        };
        let any = || rows().next().and_then(|row| unknowns(row).max_by_key(|&column| users(column)));
        // rows that cannot be solved for their last unknown leave it unresolved
        let unresolved = || self.is_resolved.iter().position(|resolved| !resolved).unwrap_or(0) as u32;
        rows().find_map(unassignable).or_else(any).unwrap_or_else(unresolved)
    }

    fn finish(mut self) -> Tearing {
        let mut is_used = vec![false; self.rows.len()];
        for &(row, _) in &self.tearing.assigned {
            is_used[row as usize] = true;
        }
        self.tearing.residuals = (0..self.rows.len() as u32).filter(|&row| !is_used[row as usize]).collect();
        self.tearing
    }
}

#[cfg(test)]
mod tests {
    use super::tear;

    #[test]
    fn a_four_bar_is_torn_at_two_angles() {
        // coupler x, y, phi and rocker x, y, phi; a pin to the crank, one between them, one to the ground
        let rows = [
            vec![(0, true), (2, false)],
            vec![(1, true), (2, false)],
            vec![(0, true), (2, false), (3, true), (5, false)],
            vec![(1, true), (2, false), (4, true), (5, false)],
            vec![(3, true), (5, false)],
            vec![(4, true), (5, false)],
        ];
        let tearing = tear(&rows);
        assert_eq!(tearing.tears.len(), 2);
        assert!(tearing.tears.contains(&2) && tearing.tears.contains(&5));
        assert_eq!(tearing.residuals.len(), 2);
        let mut resolved = tearing.tears.clone();
        for &(row, column) in &tearing.assigned {
            assert!(rows[row as usize].iter().all(|&(c, _)| c == column || resolved.contains(&c)), "out of order");
            resolved.push(column);
        }
    }

    #[test]
    fn angles_are_torn_rather_than_places() {
        // two crossed bars, each with an end on a fixed point, joined in their middles
        let rows = [
            vec![(0, true), (3, true)],
            vec![(1, true), (4, true)],
            vec![(0, true), (2, false)],
            vec![(1, true), (2, false)],
            vec![(3, true), (5, false)],
            vec![(4, true), (5, false)],
        ];
        let mut tears = tear(&rows).tears;
        tears.sort_unstable();
        assert_eq!(tears, [2, 5]);
    }

    #[test]
    fn what_no_equation_gives_is_torn() {
        let tearing = tear(&[vec![(0, false)]]);
        assert_eq!((tearing.tears, tearing.residuals), (vec![0], vec![0]));
    }
}
